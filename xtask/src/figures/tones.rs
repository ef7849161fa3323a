//! Tones by light, highlights and lines by filters: figures of the dissertation on hair in Ogre, 4.8 to 4.13.

use super::measure::{count, is, rgb};
use super::{Figure, Finding, Shot, claim};
use crate::Outcome;
use crate::picture::Picture;

/// The lines of `cartoon.ron`.
const LINE: u32 = 0x12_4A57;
const SHINE: u32 = 0xFF_FFFF;

const BLINN: &str = "--set=hair.toon.detail=blinn";

pub const FIGURES: &[Figure] = &[
    Figure {
        number: "D 4.8",
        title: "Back light",
        text: "The less a place faces the eye the more light it gets: each lock is bright at its rim.",
        shots: &[
            Shot::new("without", "cartoon.ron", &[]),
            Shot::new(
                "with back light",
                "cartoon.ron",
                &[
                    "--set=hair.toon.detail=facing",
                    "--set=hair.toon.roundness=1",
                    "--set=hair.toon.exponent=1",
                    r#"--set=hair.toon.tones=[(v: 0, stops: [(0, "FFFFFF")]), (v: 0.45, stops: [(0, "FFFFFF")]), (v: 0.45, steps: [(0, "2A8F9D"), (0.4, "8FD6D2")])]"#,
                ],
            ),
            // How far across its lock each pixel is, to be compared.
            Shot::new("", "cartoon.ron", &["--pass=w", "--samples=1"]),
        ],
        measure: rims,
    },
    Figure {
        number: "D 4.9",
        title: "Blinn's highlight, added",
        text: "Light that is added where the normal lies between light and eye; the larger the exponent the smaller it is.",
        shots: &[
            Shot::new(
                "exponent 10",
                "cartoon.ron",
                &[BLINN, ADDED, ADD, "--set=hair.toon.exponent=10"],
            ),
            Shot::new(
                "exponent 40",
                "cartoon.ron",
                &[BLINN, ADDED, ADD, "--set=hair.toon.exponent=40"],
            ),
            Shot::new(
                "exponent 160",
                "cartoon.ron",
                &[BLINN, ADDED, ADD, "--set=hair.toon.exponent=160"],
            ),
        ],
        measure: shrink,
    },
    Figure {
        number: "D 4.10",
        title: "A ramp of light by highlight",
        text: "Tones by light from left to right, by Blinn's highlight from bottom to top: where the ramp's upper step lies says how large \
               highlights are.",
        shots: &[
            Shot::new(
                "step at 0.3",
                "cartoon.ron",
                &[BLINN, "--set=hair.toon.exponent=30", STEP_3],
            ),
            Shot::new(
                "step at 0.6",
                "cartoon.ron",
                &[BLINN, "--set=hair.toon.exponent=30", STEP_6],
            ),
            Shot::new(
                "step at 0.9",
                "cartoon.ron",
                &[BLINN, "--set=hair.toon.exponent=30", STEP_9],
            ),
        ],
        measure: shrink,
    },
    Figure {
        number: "D 4.11",
        title: "Lines alone",
        text: "White hair, without tones: what lines tell of it, between locks and between levels.",
        shots: &[
            Shot::new(
                "(a) nothing",
                "cartoon.ron",
                &[WHITE, "--set=passes.1.edges=none"],
            ),
            Shot::new(
                "(b) between locks",
                "cartoon.ron",
                &[WHITE, "--set=passes.1.edges=strand"],
            ),
            Shot::new(
                "(c) between levels",
                "cartoon.ron",
                &[WHITE, "--set=passes.1.edges=level"],
            ),
        ],
        measure: found,
    },
    Figure {
        number: "D 4.12",
        title: "Edges of lit hair",
        text: "(a) Where hair is lit in steps, a filter of colours draws lines around the tones, too. (b) A filter of what a pixel shows \
               draws those of locks alone.",
        shots: &[
            Shot::new(
                "(a) of colours",
                "cartoon.ron",
                &["--set=passes.1.edges=color", "--set=passes.1.threshold=0.3"],
            ),
            Shot::new(
                "(b) of locks",
                "cartoon.ron",
                &["--set=passes.1.edges=strand"],
            ),
            // The same without light; then what is near the edges of locks, and what is hair.
            Shot::new(
                "",
                "cartoon.ron",
                &[
                    FLAT,
                    "--set=passes.1.edges=color",
                    "--set=passes.1.threshold=0.3",
                ],
            ),
            Shot::new(
                "",
                "cartoon.ron",
                &["--set=passes.1.edges=strand", "--set=passes.1.width=10"],
            ),
            Shot::new("", "cartoon.ron", &["--pass=strand"]),
        ],
        measure: tones_make_lines,
    },
    Figure {
        number: "D 4.13",
        title: "Wider lines",
        text: "Lines of one, four and twelve pixels of a picture 720 high, grown by discs: ends and corners are round.",
        shots: &[
            Shot::new(
                "1",
                "cartoon.ron",
                &["--set=passes.1.edges=level", "--set=passes.1.width=1.8"],
            ),
            Shot::new(
                "4",
                "cartoon.ron",
                &["--set=passes.1.edges=level", "--set=passes.1.width=7.2"],
            ),
            Shot::new(
                "12",
                "cartoon.ron",
                &["--set=passes.1.edges=level", "--set=passes.1.width=21.6"],
            ),
        ],
        measure: widen,
    },
];

const ADD: &str = "--set=hair.toon.mode=add";
const ADDED: &str = r#"--set=hair.toon.tones=[(v: 0, stops: [(0, "000000")]), (v: 0.6, stops: [(0, "000000")]), (v: 0.6, stops: [(0, "FFFFFF")])]"#;
const STEP_3: &str = r#"--set=hair.toon.tones=[(v: 0.3, steps: [(0, "2A8F9D"), (0.4, "8FD6D2")]), (v: 0.3, stops: [(0, "FFFFFF")])]"#;
const STEP_6: &str = r#"--set=hair.toon.tones=[(v: 0.6, steps: [(0, "2A8F9D"), (0.4, "8FD6D2")]), (v: 0.6, stops: [(0, "FFFFFF")])]"#;
const STEP_9: &str = r#"--set=hair.toon.tones=[(v: 0.9, steps: [(0, "2A8F9D"), (0.4, "8FD6D2")]), (v: 0.9, stops: [(0, "FFFFFF")])]"#;
const WHITE: &str = r#"--set=hair.toon.tones=[(0, "FFFFFF")]"#;
const FLAT: &str = r#"--set=hair.toon.tones=[(0, "8FD6D2")]"#;

fn rims(pictures: &[Picture]) -> Outcome<Finding> {
    // Half is the lock's middle.
    let off_middle = |pixel: [u16; 4]| {
        let place = 2.0 * f64::from(pixel[0]) / f64::from(u16::MAX) - 1.0;
        (pixel[3] > 0).then_some(place.abs())
    };
    let mean = |is_counted: &dyn Fn(usize) -> bool| {
        let places = pictures[2].pixels.iter().enumerate();
        let counted = places.filter(|(i, _)| is_counted(*i));
        let found: Vec<f64> = counted
            .filter_map(|(_, place)| off_middle(*place))
            .collect();
        found.iter().sum::<f64>() / found.len() as f64
    };
    let lit = |i: usize| is(pictures[1].pixels[i], rgb(SHINE));
    let (bright, dark) = (mean(&lit), mean(&|i| !lit(i)));
    claim(
        bright > dark + 0.25,
        format!(
            "what is bright lies at {bright:.2} of a lock's half width on average, the rest at {dark:.2}"
        ),
    )
}

/// Highlights get smaller from picture to picture.
fn shrink(pictures: &[Picture]) -> Outcome<Finding> {
    let sizes: Vec<usize> = pictures
        .iter()
        .map(|picture| count(picture, rgb(SHINE)))
        .collect();
    claim(
        sizes.windows(2).all(|pair| pair[1] * 4 < pair[0] * 3) && sizes[2] > 0,
        format!("highlights of {sizes:?} pixels"),
    )
}

/// Pixels of lines.
fn lines(picture: &Picture) -> usize {
    count(picture, rgb(LINE))
}

fn found(pictures: &[Picture]) -> Outcome<Finding> {
    let [none, strands, levels] = [0, 1, 2].map(|i| lines(&pictures[i]));
    claim(
        none == 0 && levels > 1000 && strands > levels,
        format!("{strands} pixels of lines between locks, {levels} between levels"),
    )
}

fn tones_make_lines(pictures: &[Picture]) -> Outcome<Finding> {
    let is_line = |picture: usize, i: usize| is(pictures[picture].pixels[i], rgb(LINE));
    let is_within = |i: &usize| pictures[4].pixels[*i][3] > 0 && !is_line(3, *i);
    let within: Vec<usize> = (0..pictures[4].pixels.len()).filter(is_within).collect();
    let [lit, locks, flat] =
        [0, 1, 2].map(|picture| within.iter().filter(|i| is_line(picture, **i)).count());
    claim(
        lit > 100 && lit > 4 * flat && locks == 0,
        format!(
            "within locks, away from their edges, {lit} pixels of lines by colours, {flat} where hair isn't lit, {locks} by locks"
        ),
    )
}

fn widen(pictures: &[Picture]) -> Outcome<Finding> {
    let areas: Vec<usize> = pictures.iter().map(lines).collect();
    claim(
        areas[1] > 2 * areas[0] && areas[2] > areas[1] * 3 / 2,
        format!("lines of {areas:?} pixels"),
    )
}
