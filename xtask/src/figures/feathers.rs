//! Shadow in feathers: Figures 5.9 to 5.11.

use super::measure::{WHITE, border, color, column_fill, rgb, runs_in_column};
use super::plot::{Curve, Plot};
use super::{Figure, Finding, Shot, claim};
use crate::Outcome;
use crate::picture::Picture;

/// The feathers' colour in `feathers.ron` and `lit.ron`.
const FEATHER: u32 = 0x1C_6FB0;

/// Specks at every eighth of the strand, in place of strokes.
const AT_PARTICLES: &str = "--set=hair.cel.fullness=(curve: [\
    (0.12109375, 0), (0.125, 0.8), (0.12890625, 0), (0.24609375, 0), (0.25, 0.8), (0.25390625, 0), \
    (0.37109375, 0), (0.375, 0.8), (0.37890625, 0), (0.49609375, 0), (0.5, 0.8), (0.50390625, 0), \
    (0.62109375, 0), (0.625, 0.8), (0.62890625, 0), (0.74609375, 0), (0.75, 0.8), (0.75390625, 0), \
    (0.87109375, 0), (0.875, 0.8), (0.87890625, 0)])";

pub const FIGURES: &[Figure] = &[
    Figure {
        number: "5.9",
        title: "Where feathers lie",
        text: "(a) A clump's stroke, with the strand's particles projected to the screen. (b) At each of them, feathers \
               are placed on a line across the way to the next particle, evenly over the clump's width. (c) Joined \
               along the strand they are strokes of their own; here a little thinner than full, so that one can tell \
               them apart. (d) Fewer of them.",
        shots: &[
            Shot::new(
                "(a) particles",
                "feathers.ron",
                &[
                    "--only=hair.silhouette",
                    "--only=hair.base",
                    "--only=particles",
                ],
            ),
            Shot::new("(b) places across", "feathers.ron", &[AT_PARTICLES]),
            Shot::new(
                "(c) five strokes",
                "feathers.ron",
                &[
                    "--only=hair.silhouette",
                    "--only=hair.base",
                    "--only=hair.cel",
                ],
            ),
            Shot::new(
                "(d) three strokes",
                "feathers.ron",
                &[
                    "--only=hair.silhouette",
                    "--only=hair.base",
                    "--only=hair.cel",
                    "--set=hair.cel.feathers=3",
                ],
            ),
        ],
        measure: places,
    },
    Figure {
        number: "5.10",
        title: "How large feathers are",
        text: "A lamp hangs over the stroke's left. Above, the gray that it gives the stroke; below, the feathers of a \
               shadow. Where the gray is under the full threshold they have their full size and close up; from there \
               they shrink, and at the shadow's own threshold they are points.",
        shots: &[
            Shot::new(
                "gray",
                "lit.ron",
                &["--only=hair.base", "--background=B9C7CF"],
            ),
            Shot::new(
                "feathers",
                "lit.ron",
                &["--only=hair.base", "--only=hair.cel", "--background=B9C7CF"],
            ),
            // On one colour, to be measured.
            Shot::new(
                "",
                "lit.ron",
                &[
                    "--only=hair.base",
                    "--only=hair.cel",
                    "--set=clump.shading=pure",
                ],
            ),
        ],
        measure: shrink,
    },
    Figure {
        number: "5.11",
        title: "Perturbed thresholds",
        text: "(a) Every clump and every feather has the same thresholds: the shadow ends in an even edge. (b) Thresholds \
               differ from strand to strand and from feather to feather: the edge is torn, as a hand would draw it.",
        shots: &[
            Shot::new(
                "(a) not perturbed",
                "hair.ron",
                &[
                    "--only=hair.base",
                    "--only=hair.cel",
                    "--set=hair.cel.strand_variation=0",
                    "--set=hair.cel.feather_variation=0",
                ],
            ),
            Shot::new(
                "(b) perturbed",
                "hair.ron",
                &[
                    "--only=hair.base",
                    "--only=hair.cel",
                    "--set=hair.cel.strand_variation=0.15",
                    "--set=hair.cel.feather_variation=0.25",
                ],
            ),
        ],
        measure: tears,
    },
];

fn places(pictures: &[Picture]) -> Outcome<Finding> {
    let middle = pictures[0].width / 2;
    let [five, three] = [2, 3].map(|i| runs_in_column(&pictures[i], middle, rgb(FEATHER)));
    claim(
        (five, three) == (5, 3),
        format!("a cut through the middle meets {five} strokes in (c) and {three} in (d)"),
    )
}

/// Thresholds of `lit.ron`.
const EDGE: f64 = 0.75;
const FULL: f64 = 0.4;

fn shrink(pictures: &[Picture]) -> Outcome<Finding> {
    let [gray, _, feathers] = pictures else {
        return Err("three pictures were expected".into());
    };
    let fills = column_fill(feathers, WHITE, rgb(FEATHER));
    let full = fills.iter().copied().fold(0.0, f64::max).max(1.0);
    let middle_row = gray.height / 2;
    let grays: Vec<f64> = (0..gray.width)
        .map(|x| color(gray.pixel(x, middle_row))[0])
        .collect();
    // Where the stroke has no round ends.
    let inner = |x: &usize| (100..540).contains(x);
    let wanted = |gray: f64| ((EDGE - gray) / (EDGE - FULL)).clamp(0.0, 1.0);
    let error = (0..grays.len())
        .filter(inner)
        .map(|x| (fills[x] / full - wanted(grays[x])).abs())
        .fold(0.0, f64::max);
    let beyond = (0..grays.len())
        .filter(inner)
        .filter(|x| grays[*x] > EDGE + 0.01);
    let largest_beyond = beyond.map(|x| fills[x]).fold(0.0, f64::max);
    let sentence = format!(
        "the feathers' share of the width follows 5.6 within {:.1} %, and is {largest_beyond:.2} pixels beyond the threshold",
        100.0 * error
    );
    if full < 50.0 || error > 0.06 || largest_beyond > 0.5 {
        return Err(sentence.into());
    }
    let curve = |name: &str, value: &dyn Fn(usize) -> f64| Curve {
        name: name.to_owned(),
        points: (0..grays.len())
            .filter(inner)
            .map(|x| ((x as f64 - 100.0) / 440.0, value(x)))
            .collect(),
    };
    let curves = [
        curve("gray", &|x| grays[x]),
        curve("feathers' share", &|x| fills[x] / full),
    ];
    let plot = Plot {
        x_axis: "along the stroke",
        y_axis: "",
        curves: &curves,
        levels: &[
            ("threshold of the shadow", EDGE),
            ("threshold of full size", FULL),
        ],
    };
    Ok(Finding {
        sentence,
        drawing: Some(plot.svg()),
    })
}

fn tears(pictures: &[Picture]) -> Outcome<Finding> {
    let [even, torn] = [0, 1].map(|i| border(&pictures[i], rgb(0x8F_D6D2), rgb(0x2A_8F9D)));
    claim(
        even > 100 && torn as f64 > 1.25 * even as f64,
        format!("the shadow's edge is {even} pixels long in (a), {torn} in (b)"),
    )
}
