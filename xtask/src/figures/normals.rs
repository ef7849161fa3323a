//! Which way a strand faces: Figure 5.4.

use std::fmt::Write as _;
use std::ops::Range;

use super::measure::color;
use super::{Figure, Finding, Shot};
use crate::Outcome;
use crate::picture::Picture;

pub const FIGURES: &[Figure] = &[Figure {
    number: "5.4",
    title: "A normal for a strand",
    text: "The source draws vectors; here they are measured. A white lock in diffuse light is as bright as its normal \
           faces the light, so pictures lit from four sides give the normal of each pixel: the red needles. The lock \
           lies over the side of the head and then hangs straight. Left: away from the head's centre (the ring) normals \
           are level beside it, and lean down the more the farther the lock hangs. Middle (5.4a): the centre is shifted \
           towards the lock's own mean, and the level place moves down with it. Right (5.4b): corrected with K = 1 \
           they stand across the strand, all the way.",
    shots: &[
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=90,0",
                "--set=clump.center_shift=0",
                "--set=clump.normal_correction=0",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=-90,0",
                "--set=clump.center_shift=0",
                "--set=clump.normal_correction=0",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=0,90",
                "--set=clump.center_shift=0",
                "--set=clump.normal_correction=0",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=0,-90",
                "--set=clump.center_shift=0",
                "--set=clump.normal_correction=0",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=90,0",
                "--set=clump.center_shift=0.6",
                "--set=clump.normal_correction=0",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=-90,0",
                "--set=clump.center_shift=0.6",
                "--set=clump.normal_correction=0",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=0,90",
                "--set=clump.center_shift=0.6",
                "--set=clump.normal_correction=0",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=0,-90",
                "--set=clump.center_shift=0.6",
                "--set=clump.normal_correction=0",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=90,0",
                "--set=clump.center_shift=0.6",
                "--set=clump.normal_correction=1",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=-90,0",
                "--set=clump.center_shift=0.6",
                "--set=clump.normal_correction=1",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=0,90",
                "--set=clump.center_shift=0.6",
                "--set=clump.normal_correction=1",
            ],
        ),
        Shot::new(
            "",
            "profile.ron",
            &[
                "--light=0,-90",
                "--set=clump.center_shift=0.6",
                "--set=clump.normal_correction=1",
            ],
        ),
    ],
    measure,
}];

/// The panels: what their normals are, each of four pictures.
const PANELS: [&str; 3] = [
    "away from the head's centre",
    "away from the shifted centre",
    "corrected to be across the strand",
];
/// Between needles, and their length, pixels.
const SPACING_PX: u32 = 12;
const NEEDLE_PX: f64 = 34.0;
/// The head's centre, the lock beside it and below, and where that is quite straight, as parts of the
/// picture's height.
const CENTER: f64 = 0.315;
const HANGING: Range<f64> = 0.3..0.92;
const STRAIGHT: Range<f64> = 0.49..0.92;

/// A place in the picture, and the normal there: right and up.
struct Needle {
    at: (u32, u32),
    normal: (f64, f64),
}

/// The normals, from pictures lit from the right, the left, above and below.
fn needles(lit: &[Picture]) -> Vec<Needle> {
    let mut needles = Vec::new();
    let bright = |i: usize, x: u32, y: u32| color(lit[i].pixel(x, y))[0];
    for y in (SPACING_PX / 2..lit[0].height).step_by(SPACING_PX as usize) {
        let opaque = |x: &u32| lit[0].pixel(*x, y)[3] == u16::MAX;
        let inside: Vec<u32> = (0..lit[0].width).filter(opaque).collect();
        // One needle in the middle of each lock; where a row runs along it, one every few pixels.
        for run in inside.chunk_by(|a, b| b - a == 1) {
            let count = 1 + run.len() / (3 * SPACING_PX as usize);
            for k in 0..count {
                let x = run[run.len() * (2 * k + 1) / (2 * count)];
                let normal = (
                    bright(0, x, y) - bright(1, x, y),
                    bright(2, x, y) - bright(3, x, y),
                );
                needles.push(Needle { at: (x, y), normal });
            }
        }
    }
    needles
}

/// The needles between two parts of the picture's height.
fn between(needles: &[Needle], height: u32, rows: Range<f64>) -> impl Iterator<Item = &Needle> {
    let place = move |needle: &Needle| f64::from(needle.at.1) / f64::from(height);
    needles
        .iter()
        .filter(move |needle| rows.contains(&place(needle)))
}

/// The row where normals on the hanging part are level.
fn level_row(needles: &[Needle], height: u32) -> u32 {
    let tilt = |needle: &&Needle| needle.normal.1.abs();
    let level = between(needles, height, HANGING).min_by(|a, b| tilt(a).total_cmp(&tilt(b)));
    level.map_or(0, |needle| needle.at.1)
}

fn measure(pictures: &[Picture]) -> Outcome<Finding> {
    let panels: Vec<Vec<Needle>> = pictures.chunks(4).map(needles).collect();
    let (width, height) = (pictures[0].width, pictures[0].height);
    let [plain, shifted] = [0, 1].map(|i| level_row(&panels[i], height));
    let corrected = between(&panels[2], height, STRAIGHT).map(|needle| needle.normal.1.abs());
    let leaning = corrected.fold(0.0, f64::max);
    let sentence = format!(
        "of {height} rows, normals are level in row {plain} for the head's centre, in row {shifted} for the shifted \
         one; corrected, where the lock hangs straight, they lean up or down by {leaning:.3} at most"
    );
    if plain == 0 || shifted < plain + height / 20 || leaning > 0.03 {
        return Err(sentence.into());
    }
    let mut drawing = String::new();
    for (i, (panel, name)) in panels.iter().zip(PANELS).enumerate() {
        let picture = format!("5.4-{}.png", 4 * i + 1);
        drawing += &svg(&picture, (width, height), panel, name);
    }
    Ok(Finding {
        sentence,
        drawing: Some(drawing),
    })
}

fn svg(picture: &str, (width, height): (u32, u32), needles: &[Needle], name: &str) -> String {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         width=\"{width}\" height=\"{}\" font-family=\"sans-serif\" font-size=\"14\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#9fb0bd\"/>\n\
         <image xlink:href=\"{picture}\" href=\"{picture}\" width=\"{width}\" height=\"{height}\"/>\n\
         <circle cx=\"{:.0}\" cy=\"{:.0}\" r=\"5\" fill=\"none\" stroke=\"#203040\" stroke-width=\"2\"/>\n",
        height + 26,
        f64::from(width) / 2.0,
        f64::from(height) * CENTER,
    );
    for Needle { at, normal } in needles {
        let (x, y) = (f64::from(at.0) + 0.5, f64::from(at.1) + 0.5);
        // Writing to a String cannot fail.
        let _ = writeln!(
            svg,
            "<path d=\"M{x:.1} {y:.1} l{:.1} {:.1}\" stroke=\"#d02f2f\" stroke-width=\"2\"/>\
             <circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.5\" fill=\"#d02f2f\"/>",
            NEEDLE_PX * normal.0,
            -NEEDLE_PX * normal.1
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{:.0}\" y=\"{}\" text-anchor=\"middle\">{name}</text>\n</svg>",
        f64::from(width) / 2.0,
        height + 16
    );
    svg
}
