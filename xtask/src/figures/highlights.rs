//! Light on hair: Figures 5.12 and 5.13.

use super::measure::{WHITE, column_fill, count, rgb};
use super::plot::{Curve, Plot};
use super::{Figure, Finding, Shot, claim};
use crate::Outcome;
use crate::picture::Picture;

/// The hair's colour under white highlights.
const DARK: u32 = 0x12_4A57;

pub const FIGURES: &[Figure] = &[
    Figure {
        number: "5.12",
        title: "Highlights by the distance to the light",
        text: "The lamp hangs over the stroke's left, as in 5.10. Up to the near distance the highlight's feathers have \
               their full size; from there they shrink, and at the far distance they end.",
        shots: &[
            Shot::new(
                "near 0.2, far 0.5 head heights",
                "lit.ron",
                &[
                    "--only=hair.base",
                    "--only=hair.highlight",
                    "--set=clump.color=124A57",
                    "--set=clump.shading=pure",
                    "--background=B9C7CF",
                ],
            ),
            // On white, to be measured.
            Shot::new(
                "",
                "lit.ron",
                &[
                    "--only=hair.base",
                    "--only=hair.highlight",
                    "--set=clump.color=124A57",
                    "--set=clump.shading=pure",
                ],
            ),
        ],
        measure: fades,
    },
    Figure {
        number: "5.13",
        title: "Two kinds of highlight",
        text: "(a) Where the hair mirrors the light (Phong's specular term): small regions. (b) By the distance to the \
               light: long strokes that run down the hair.",
        shots: &[
            Shot::new(
                "(a) specular",
                "hair.ron",
                &[
                    "--only=hair.base",
                    "--only=hair.highlight",
                    "--set=clump.color=124A57",
                ],
            ),
            Shot::new(
                "(b) by distance",
                "hair.ron",
                &[
                    "--only=hair.base",
                    "--only=hair.highlight",
                    "--set=clump.color=124A57",
                    "--set=hair.highlight.kind=distance",
                    "--set=light.kind=point",
                    "--set=light.pitch=20",
                    "--set=light.distance=1.5",
                    "--set=hair.highlight.near=1.2",
                    "--set=hair.highlight.far=2.2",
                    "--set=hair.highlight.spread=0.6",
                ],
            ),
            // Without, to be compared.
            Shot::new(
                "",
                "hair.ron",
                &["--only=hair.base", "--set=clump.color=124A57"],
            ),
        ],
        measure: spreads,
    },
];

/// `lit.ron` in metres and pixels: the head's height and centre as its roots give them, where the lamp
/// hangs, and how many pixels a metre has.
const HEAD_M: f64 = 2.5 * 0.156_205;
const LAMP_M: (f64, f64) = (
    0.12 - 0.484 * HEAD_M * 0.529_919,
    -0.1 + 0.484 * HEAD_M * 0.848_048,
);
const PX_PER_M: f64 = 160.0 / (2.0 * 0.087_488_66 * 1.2 * HEAD_M);
const NEAR: f64 = 0.2;
const FAR: f64 = 0.5;

/// The distance from the lamp to the strand at a column, in head heights.
fn distance(column: usize, width: u32) -> f64 {
    let x = 0.12 + (column as f64 + 0.5 - f64::from(width) / 2.0) / PX_PER_M;
    (x - LAMP_M.0).hypot(LAMP_M.1) / HEAD_M
}

fn fades(pictures: &[Picture]) -> Outcome<Finding> {
    let picture = &pictures[1];
    let stroke = column_fill(picture, WHITE, rgb(DARK));
    let tallest = stroke.iter().copied().fold(0.0, f64::max).max(1.0);
    // The stroke is white or dark: what is not dark of its width is highlight.
    let inner: Vec<usize> = (110..530).collect();
    let share = |x: usize| 1.0 - stroke[x] / tallest;
    let wanted = |x: usize| ((FAR - distance(x, picture.width)) / (FAR - NEAR)).clamp(0.0, 1.0);
    let error = inner
        .iter()
        .map(|x| (share(*x) - wanted(*x)).abs())
        .fold(0.0, f64::max);
    let sentence = format!(
        "the highlight's share of the width follows its distances within {:.1} %",
        100.0 * error
    );
    if tallest < 50.0 || error > 0.06 {
        return Err(sentence.into());
    }
    let curve = |name: &str, value: &dyn Fn(usize) -> f64| Curve {
        name: name.to_owned(),
        points: inner
            .iter()
            .map(|&x| ((x as f64 - 110.0) / 420.0, value(x)))
            .collect(),
    };
    let curves = [
        curve("distance, head heights", &|x| distance(x, picture.width)),
        curve("highlight's share", &share),
    ];
    let plot = Plot {
        x_axis: "along the stroke",
        y_axis: "",
        curves: &curves,
        levels: &[("far", FAR), ("near", NEAR)],
    };
    Ok(Finding {
        sentence,
        drawing: Some(plot.svg()),
    })
}

/// White pixels, all and those in the lower half of the picture.
fn white(picture: &Picture) -> (usize, usize) {
    let lower = picture.cut((0, picture.height / 2), (picture.width, picture.height / 2));
    (count(picture, WHITE), count(&lower, WHITE))
}

fn spreads(pictures: &[Picture]) -> Outcome<Finding> {
    let [specular, distance, none] = [0, 1, 2].map(|i| white(&pictures[i]));
    // The eyes are white too.
    let highlight =
        |(all, low): (usize, usize)| (all.saturating_sub(none.0), low.saturating_sub(none.1));
    let ((small, small_low), (long, long_low)) = (highlight(specular), highlight(distance));
    claim(
        small > 100 && small_low * 10 < small && long_low > 4 * small_low + 100,
        format!(
            "highlight pixels: (a) {small}, of which {small_low} in the lower half; (b) {long}, of which {long_low}"
        ),
    )
}
