//! Strips: of light from lock to lock, Figure 14 of Shin, Haller and Mukundan, and of lines, Figures 4.15 to 4.19 of a dissertation that
//! builds on them.

use std::ops::Range;

use super::measure::{WHITE, border, count, is, rgb};
use super::shin::lines_along;
use super::{Figure, Finding, Shot, claim};
use crate::Outcome;
use crate::picture::Picture;

/// Colours of `strips.ron`.
const HAIR: u32 = 0x8F_D6D2;
const LINE: u32 = 0x12_4A57;

pub const FIGURES: &[Figure] = &[
    Figure {
        number: "S 14",
        title: "What shines is merged, linked and textured",
        text: "(a) Where each lock is brighter than a threshold. (b) What shines of a lock is one point, in its middle; the points of neighbours \
               are linked to a strip. (c) The strip is drawn with a brush that has teeth: whole ones, however long it is.",
        shots: &[
            Shot::new(
                "(a) what shines",
                "cartoon.ron",
                &[
                    r#"--set=hair.toon.tones=[(v: 0, stops: [(0, "8FD6D2")]), (v: 0.45, stops: [(0, "8FD6D2")]), (v: 0.45, stops: [(0, "FFFFFF")])]"#,
                    "--set=hair.toon.detail=weighted",
                    "--set=hair.toon.exponent=3",
                    "--set=hair.toon.weight=0.65",
                ],
            ),
            Shot::new("(b) merged and linked", "strips.ron", &[]),
            Shot::new("(c) textured", "strips-textured.ron", &[]),
        ],
        measure: shines,
    },
    Figure {
        number: "D 4.17",
        title: "A silhouette as a line, as a strip, and textured",
        text: "(a) The silhouette's points as a thin line (there Fig. 4.15). (b) The strip that they are widened to (4.16). (c) The strip with a texture.",
        shots: &[
            Shot::new(
                "(a) a line",
                "strips.ron",
                &[LINES[0], LINES[1], "--set=hair.silhouette.width=1.2"],
            ),
            Shot::new(
                "(b) a strip",
                "strips.ron",
                &[LINES[0], LINES[1], "--set=hair.silhouette.width=7"],
            ),
            Shot::new(
                "(c) textured",
                "strips-textured.ron",
                &[LINES[0], LINES[1], "--set=hair.silhouette.width=7"],
            ),
        ],
        measure: widens,
    },
    Figure {
        number: "D 4.19",
        title: "Silhouettes that fade towards the root",
        text: "(a) As wide at the root as elsewhere. (b) They grow from nothing over the first part of the lock.",
        shots: &[
            Shot::new(
                "(a) as they come",
                "strips.ron",
                &[
                    FROM_BEHIND,
                    WIDE,
                    LINES[0],
                    LINES[1],
                    "--set=hair.silhouette.root_fade=0",
                ],
            ),
            Shot::new(
                "(b) fading",
                "strips.ron",
                &[
                    FROM_BEHIND,
                    WIDE,
                    LINES[0],
                    LINES[1],
                    "--set=hair.silhouette.root_fade=0.7",
                ],
            ),
            // How far along its lock each pixel is, to be compared.
            Shot::new("", "strips.ron", &[FROM_BEHIND, "--pass=u", "--samples=1"]),
        ],
        measure: fades,
    },
];

const FROM_BEHIND: &str = "--camera=180,60";
const WIDE: &str = "--set=hair.silhouette.width=3";
const LINES: [&str; 2] = ["--only=hair.silhouette", "--only=hair.base"];

fn shines(pictures: &[Picture]) -> Outcome<Finding> {
    let [lit, strip, textured] = [0, 1, 2].map(|i| &pictures[i]);
    let area = count(strip, WHITE);
    let both = (lit.pixels.iter().zip(&strip.pixels))
        .filter(|(lit, strip)| is(**lit, WHITE) && is(**strip, WHITE))
        .count();
    let on_lit = both as f64 / area.max(1) as f64;
    let merged = area as f64 / count(lit, WHITE).max(1) as f64;
    let [plain, teeth] = [strip, textured].map(|picture| border(picture, rgb(HAIR), WHITE));
    let longer = teeth as f64 / plain.max(1) as f64;
    claim(
        area > 1000 && on_lit > 0.6 && merged < 0.7 && longer > 1.1,
        format!(
            "{:.0} % of the strip lie where locks shine, it is {:.0} % as large, and teeth make its border {longer:.2} times as long",
            100.0 * on_lit,
            100.0 * merged
        ),
    )
}

fn widens(pictures: &[Picture]) -> Outcome<Finding> {
    let [line, strip, textured] = [0, 1, 2].map(|i| count(&pictures[i], rgb(LINE)));
    claim(
        line > 200 && strip > 3 * line && textured > line && textured < strip,
        format!(
            "{line} pixels of line, {strip} of the strip, {textured} of them left by the texture"
        ),
    )
}

fn fades(pictures: &[Picture]) -> Outcome<Finding> {
    let lines = |i: usize, part: Range<f64>| lines_along(&pictures[i], LINE, &pictures[2], part);
    let [roots, tips] =
        [0.0..0.3, 0.8..1.1].map(|part| lines(1, part.clone()) / lines(0, part).max(1.0));
    claim(
        lines(0, 0.0..0.3) > 200.0 && roots < 0.4 && tips > 0.8,
        format!(
            "{:.0} % of the lines are left up to 0.3 of a lock, {:.0} % beyond 0.8",
            100.0 * roots,
            100.0 * tips
        ),
    )
}
