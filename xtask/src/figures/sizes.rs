//! How wide a stroke is from root to tip: Figures 5.2 and 5.3.

use super::measure::{WHITE, column_fill, rgb};
use super::plot::{Curve, Plot};
use super::{Figure, Finding, Shot};
use crate::Outcome;
use crate::picture::Picture;

pub const FIGURES: &[Figure] = &[
    Figure {
        number: "5.2",
        title: "A size that swells and tapers",
        text: "The second size function is half a turn of a sine, of which the offset cuts off the beginning: \
               without it the stroke leaves its root (left) as a point, with a half it begins at its widest. The \
               curves below are the widths of the strokes, measured on the pictures.",
        shots: &[
            Shot::new(
                "offset 0",
                "stroke.ron",
                &["--set=clump.mix=0", "--set=clump.swell_offset=0"],
            ),
            Shot::new(
                "offset 0.25",
                "stroke.ron",
                &["--set=clump.mix=0", "--set=clump.swell_offset=0.25"],
            ),
            Shot::new(
                "offset 0.5",
                "stroke.ron",
                &["--set=clump.mix=0", "--set=clump.swell_offset=0.5"],
            ),
        ],
        measure: swells,
    },
    Figure {
        number: "5.3",
        title: "Three size functions",
        text: "(a) The first function keeps its size up to a point, then shrinks in a straight line, with a corner \
               where it begins. (b) The second has no corner, and stays thick for long. (c) Their mix, by a weight that \
               may differ from strand to strand.",
        shots: &[
            Shot::new(
                "(a) the first alone, from 0.35 on",
                "stroke.ron",
                &["--set=clump.mix=1"],
            ),
            Shot::new(
                "(b) the second alone, offset 0.25",
                "stroke.ron",
                &["--set=clump.mix=0"],
            ),
            Shot::new("(c) weight 0.75", "stroke.ron", &["--set=clump.mix=0.75"]),
            Shot::new("(c) weight 0.5", "stroke.ron", &["--set=clump.mix=0.5"]),
            Shot::new("(c) weight 0.25", "stroke.ron", &["--set=clump.mix=0.25"]),
            Shot::new(
                "(a) from 0.7 on",
                "stroke.ron",
                &["--set=clump.mix=1", "--set=clump.shrink_start=0.7"],
            ),
        ],
        measure: mixes,
    },
];

/// Pixels in a head's height, which is the strand's length, in pictures of `stroke.ron`: 160 lines see
/// 2 tan(5 degrees) of the distance, 1.75 head heights.
const HEAD_PX: f64 = 160.0 / (2.0 * 0.087_488_66 * 1.75);
/// The stroke's full width in pixels: its size is 34 / 300.
const FULL_PX: f64 = 2.0 * 34.0 / 300.0 * HEAD_PX;
/// What a width may differ from its formula, of the full width.
const TOLERANCE: f64 = 0.015;

/// The width of a stroke of `stroke.ron` over the place along the strand: 1 is the full size.
fn widths(picture: &Picture) -> Vec<(f64, f64)> {
    let middle = f64::from(picture.width) / 2.0;
    column_fill(picture, WHITE, rgb(0x3FC1C0))
        .iter()
        .enumerate()
        .map(|(x, fill)| (0.5 + (x as f64 + 0.5 - middle) / HEAD_PX, fill / FULL_PX))
        .filter(|(u, _)| (0.0..=1.0).contains(u))
        .collect()
}

/// The largest difference of a measured curve to the union of discs of a formula's sizes.
fn largest_error(points: &[(f64, f64)], size: impl Fn(f64) -> f64) -> f64 {
    let errors = points
        .iter()
        .map(|(u, width)| (width - union_of_discs(*u, &size)).abs());
    errors.fold(0.0, f64::max)
}

/// The width at `u` of all discs along a strand: where sizes change it is a little above their own.
fn union_of_discs(u: f64, size: impl Fn(f64) -> f64) -> f64 {
    let length = 2.0 * HEAD_PX / FULL_PX;
    let discs = (0..=1000).map(|i| f64::from(i) / 1000.0);
    let widths = discs.map(|at| size(at).powi(2) - (length * (u - at)).powi(2));
    widths.fold(0.0, f64::max).sqrt()
}

fn finding(names: &[&str], measured: Vec<Vec<(f64, f64)>>, error: f64) -> Outcome<Finding> {
    if error > TOLERANCE {
        return Err(format!("widths are off their formula by {error:.3} of the full size").into());
    }
    let curves: Vec<Curve> = names
        .iter()
        .zip(measured)
        .map(|(name, points)| Curve {
            name: (*name).to_owned(),
            points,
        })
        .collect();
    let plot = Plot {
        x_axis: "place along the strand, from root to tip",
        y_axis: "width",
        curves: &curves,
        levels: &[],
    };
    Ok(Finding {
        sentence: format!(
            "the widths follow their formula within {:.1} % of the full size, as unions of discs",
            100.0 * error
        ),
        drawing: Some(plot.svg()),
    })
}

/// 5.2: sin((offset + u (1 - offset)) pi).
fn swells(pictures: &[Picture]) -> Outcome<Finding> {
    let measured: Vec<_> = pictures.iter().map(widths).collect();
    let formula = |offset: f64| move |u: f64| sine(u, offset);
    let errors = [0.0, 0.25, 0.5]
        .iter()
        .zip(&measured)
        .map(|(offset, points)| largest_error(points, formula(*offset)));
    let error = errors.fold(0.0, f64::max);
    finding(&["offset 0", "offset 0.25", "offset 0.5"], measured, error)
}

fn sine(u: f64, offset: f64) -> f64 {
    ((offset + u * (1.0 - offset)) * std::f64::consts::PI).sin()
}

fn shrinking(u: f64, start: f64) -> f64 {
    ((1.0 - u) / (1.0 - start)).min(1.0)
}

/// 5.1 and 5.3.
fn mixes(pictures: &[Picture]) -> Outcome<Finding> {
    let measured: Vec<_> = pictures.iter().map(widths).collect();
    let mix = |weight: f64, start: f64| {
        move |u: f64| weight * shrinking(u, start) + (1.0 - weight) * sine(u, 0.25)
    };
    let settings = [
        (1.0, 0.35),
        (0.0, 0.35),
        (0.75, 0.35),
        (0.5, 0.35),
        (0.25, 0.35),
        (1.0, 0.7),
    ];
    let errors = settings
        .iter()
        .zip(&measured)
        .map(|((weight, start), points)| largest_error(points, mix(*weight, *start)));
    let error = errors.fold(0.0, f64::max);
    let names = [
        "(a) first, from 0.35 on",
        "(b) second, offset 0.25",
        "(c) weight 0.75",
        "(c) weight 0.5",
        "(c) weight 0.25",
        "(a) first, from 0.7 on",
    ];
    finding(&names, measured, error)
}
