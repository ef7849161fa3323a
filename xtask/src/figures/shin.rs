//! Levels, lines that fade, and highlights that move: Figures 8, 9 and 12 of Shin, Haller and Mukundan.

use std::collections::BTreeMap;
use std::ops::Range;

use super::measure::{count, is, rgb};
use super::{Figure, Finding, Shot, claim};
use crate::Outcome;
use crate::picture::Picture;

/// The lines of `cartoon.ron`.
const LINE: u32 = 0x12_4A57;
/// A highlight's tone.
const SHINE: u32 = 0xFF_FFFF;

pub const FIGURES: &[Figure] = &[
    Figure {
        number: "S 8",
        title: "Levels of locks, and lines between them",
        text: "(a), (b) Each lock is in one of three levels, which are chosen once: a lock of a higher one lies over its neighbours from wherever it \
               is seen. (c) A line is drawn where levels meet, on the one in front.",
        shots: &[
            Shot::new("(a) levels", "cartoon.ron", &["--pass=level"]),
            Shot::new(
                "(b) the same from the other side",
                "cartoon.ron",
                &["--pass=level", "--camera=30,8"],
            ),
            Shot::new(
                "(c) lines between them",
                "cartoon.ron",
                &["--set=passes.1.edges=level"],
            ),
        ],
        measure: levels,
    },
    Figure {
        number: "S 9",
        title: "Lines that fade towards the crown",
        text: "(a) All lines begin at the crown, where they run into each other. (b) They grow from nothing at the root, by half a cosine: \
               the crown is calm, and further out they are as they were.",
        shots: &[
            Shot::new(
                "(a) as they come",
                "cartoon.ron",
                &[FROM_BEHIND, FLAT, "--set=passes.1.edges=strand"],
            ),
            Shot::new(
                "(b) with fading",
                "cartoon.ron",
                &[
                    FROM_BEHIND,
                    FLAT,
                    "--set=passes.1.edges=strand",
                    "--set=passes.1.fade=0.7",
                ],
            ),
            // How far along its lock each pixel is, to be compared.
            Shot::new("", "cartoon.ron", &[FROM_BEHIND, "--pass=u", "--samples=1"]),
        ],
        measure: fades,
    },
    Figure {
        number: "S 12",
        title: "A highlight moves along the hair",
        text: "What is lit is a mean of the normal, by the weight w, and of the direction to the root: from w = 0 to w = 1 a highlight \
               moves. The light is above.",
        shots: &[
            Shot::new(
                "w = 0",
                "cartoon.ron",
                &[LIT, TONES, DETAIL, EXPONENT, "--set=hair.toon.weight=0"],
            ),
            Shot::new(
                "w = 0.5",
                "cartoon.ron",
                &[LIT, TONES, DETAIL, EXPONENT, "--set=hair.toon.weight=0.5"],
            ),
            Shot::new(
                "w = 1",
                "cartoon.ron",
                &[LIT, TONES, DETAIL, EXPONENT, "--set=hair.toon.weight=1"],
            ),
            // How far along its lock each pixel is, to be compared.
            Shot::new("", "cartoon.ron", &["--pass=u", "--samples=1"]),
        ],
        measure: moves,
    },
];

const FROM_BEHIND: &str = "--camera=180,60";
const FLAT: &str = r#"--set=hair.toon.tones=[(0, "8FD6D2")]"#;
const LIT: &str = "--set=light.pitch=80";
const TONES: &str = r#"--set=hair.toon.tones=[(v: 0, stops: [(0, "2A8F9D")]), (v: 0.7, stops: [(0, "2A8F9D")]), (v: 0.7, stops: [(0, "FFFFFF")])]"#;
const DETAIL: &str = "--set=hair.toon.detail=weighted";
const EXPONENT: &str = "--set=hair.toon.exponent=8";

/// How many pixels have each colour.
fn colors(picture: &Picture) -> BTreeMap<[u16; 4], usize> {
    let mut colors = BTreeMap::new();
    for pixel in picture.pixels.iter().filter(|pixel| pixel[3] > 0) {
        *colors.entry(*pixel).or_default() += 1;
    }
    colors
}

fn levels(pictures: &[Picture]) -> Outcome<Finding> {
    let shares = [&pictures[0], &pictures[1]].map(|picture| {
        let colors = colors(picture);
        let hair: usize = colors.values().sum();
        let of = |count: &usize| 100.0 * *count as f64 / hair.max(1) as f64;
        colors.values().map(of).collect::<Vec<f64>>()
    });
    let lines = count(&pictures[2], rgb(LINE));
    claim(
        shares
            .iter()
            .all(|of| of.len() == 3 && of.iter().all(|share| *share > 10.0))
            && lines > 1000,
        format!(
            "the levels are {:.0?} % of the hair from one side and {:.0?} % from the other; {lines} pixels of lines",
            shares[0], shares[1]
        ),
    )
}

/// The place along its lock that a pixel of `--pass u` shows, if it shows hair.
fn along(pixel: [u16; 4]) -> Option<f64> {
    (pixel[3] > 0).then(|| f64::from(pixel[0]) / f64::from(u16::MAX))
}

/// How many pixels of lines of that colour show hair from one part of its lock to another, 0 root to 1 tip, as a picture of `--pass u` has it.
pub(super) fn lines_along(picture: &Picture, line: u32, places: &Picture, part: Range<f64>) -> f64 {
    let pairs = picture.pixels.iter().zip(&places.pixels);
    let on = pairs.filter(|(color, place)| {
        along(**place).is_some_and(|u| part.contains(&u)) && is(**color, rgb(line))
    });
    on.count() as f64
}

fn fades(pictures: &[Picture]) -> Outcome<Finding> {
    let lines = |i: usize, part: Range<f64>| lines_along(&pictures[i], LINE, &pictures[2], part);
    let [roots, tips] =
        [0.0..0.3, 0.7..1.1].map(|part| lines(1, part.clone()) / lines(0, part).max(1.0));
    claim(
        lines(0, 0.0..0.3) > 300.0 && roots < 0.4 && tips > 0.95,
        format!(
            "{:.0} % of the lines are left up to 0.3 of a lock, {:.0} % beyond 0.7",
            100.0 * roots,
            100.0 * tips
        ),
    )
}

fn moves(pictures: &[Picture]) -> Outcome<Finding> {
    let means: Vec<f64> = (0..3)
        .map(|w| {
            let pairs = pictures[w].pixels.iter().zip(&pictures[3].pixels);
            let lit = pairs.filter(|(color, _)| is(**color, rgb(SHINE)));
            let places: Vec<f64> = lit.filter_map(|(_, place)| along(*place)).collect();
            places.iter().sum::<f64>() / places.len() as f64
        })
        .collect();
    claim(
        means.windows(2).all(|pair| pair[1] < pair[0]),
        format!(
            "the highlights' mean place along a lock, 0 at its root, is {means:.2?} for w = 0, 0.5 and 1"
        ),
    )
}
