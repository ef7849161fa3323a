//! Other brushes: Figures 7.1 and 7.2.

use super::measure::{WHITE, count, rgb, way};
use super::{Figure, Finding, Shot, claim};
use crate::Outcome;
use crate::picture::Picture;

const BLUNT: &[&str] = &[
    "--set=clump.shrink_start=1",
    "--set=clump.mix=1",
    "--set=path.brush=circle",
];
const FLAT: &[&str] = &[
    "--set=clump.shrink_start=1",
    "--set=clump.mix=1",
    "--set=path.brush=semicircle",
];
const BLACK: &str = "presets/flat-tails-black.ron";
const RED: &str = "presets/flat-tails-red.ron";

pub const FIGURES: &[Figure] = &[
    Figure {
        number: "7.1",
        title: "Long hair with flat tails",
        text: "A brush need not be round. Half a circle, the half behind the brush's centre, ends a stroke flat. Above, \
               one stroke with each; below, the tails of long black hair with each, on the same strands.",
        shots: &[
            Shot::new("circle", "stroke.ron", BLUNT),
            Shot::new("semicircle", "stroke.ron", FLAT),
            Shot::new(
                "circle",
                BLACK,
                &[
                    "--size=420x400",
                    "--camera=150,5,3.4",
                    "--set=camera.target=(0, -1.9, 0)",
                    "--set=path.brush=circle",
                ],
            ),
            Shot::new(
                "semicircle",
                BLACK,
                &[
                    "--size=420x400",
                    "--camera=150,5,3.4",
                    "--set=camera.target=(0, -1.9, 0)",
                ],
            ),
            Shot::new("the whole look", BLACK, &["--size=300x400"]),
        ],
        measure: ends_flat,
    },
    Figure {
        number: "7.2",
        title: "Short hair with flat tails",
        text: "Short red hair, its tips round under the round brush and cut under the half one.",
        shots: &[
            Shot::new(
                "circle",
                RED,
                &[
                    "--size=480x420",
                    "--camera=-25,2,3",
                    "--set=path.brush=circle",
                ],
            ),
            Shot::new("semicircle", RED, &["--size=480x420", "--camera=-25,2,3"]),
            // In one colour, to be measured, whatever the look's are.
            Shot::new(
                "",
                RED,
                &[
                    "--size=480x420",
                    "--camera=-25,2,3",
                    "--only=hair.base",
                    "--set=clump.color=1C6FB0",
                    "--set=clump.shading=pure",
                    "--set=path.brush=circle",
                ],
            ),
            Shot::new(
                "",
                RED,
                &[
                    "--size=480x420",
                    "--camera=-25,2,3",
                    "--only=hair.base",
                    "--set=clump.color=1C6FB0",
                    "--set=clump.shading=pure",
                ],
            ),
        ],
        measure: cuts,
    },
];

/// How far the ends of a stroke's rows lie apart, pixels: 0 is a straight cut. Of the middle of its width, as
/// corners are antialiased.
fn spread_of_end(picture: &Picture) -> u32 {
    let color = rgb(0x3F_C1C0);
    let end = |y: u32| (0..picture.width).rfind(|x| way(picture.pixel(*x, y), WHITE, color) > 0.5);
    let ends: Vec<u32> = (0..picture.height).filter_map(end).collect();
    let middle = &ends[ends.len() / 20..ends.len() - ends.len() / 20];
    let (first, last) = (middle.iter().min(), middle.iter().max());
    first.zip(last).map_or(0, |(first, last)| last - first)
}

fn ends_flat(pictures: &[Picture]) -> Outcome<Finding> {
    let [round, flat] = [0, 1].map(|i| spread_of_end(&pictures[i]));
    claim(
        round > 10 && flat <= 1 && pictures[2] != pictures[3],
        format!(
            "where one stroke ends differs from row to row by up to {round} pixels with the circle, {flat} with the semicircle"
        ),
    )
}

fn cuts(pictures: &[Picture]) -> Outcome<Finding> {
    let [round, flat] = [2, 3].map(|i| count(&pictures[i], rgb(0x1C_6FB0)));
    claim(
        flat > 1000 && flat < round,
        format!(
            "{round} pixels of hair with the circle, {flat} with the semicircle: the round ends are cut away"
        ),
    )
}
