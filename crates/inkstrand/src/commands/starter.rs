//! The starter: a short bob of a few broad strands, and a preset that explains itself.

use std::f64::consts::TAU;
use std::fmt::Write as _;

/// The middle of the head, metres.
const CENTER: [f64; 3] = [0.0, 1.6, 0.0];
/// Radius of the scalp, metres.
const SCALP: f64 = 0.096;

/// A row of strands around the head.
struct Row {
    count: u32,
    /// The first strand's angle around the head, in steps from one strand to the next.
    turn: f64,
    /// Where the roots are, in degrees from the top of the head.
    root: f64,
    /// Where the tips are, behind and at the sides.
    tip: f64,
    /// How far the tips stand off the head, in radii of the scalp.
    lift: f64,
    /// Size of the clumps, in 1/300 of the head's height.
    size: f64,
}

const ROWS: [Row; 2] = [
    Row {
        count: 10,
        turn: 0.5,
        root: 12.0,
        tip: 122.0,
        lift: 0.22,
        size: 34.0,
    },
    Row {
        count: 14,
        turn: 0.0,
        root: 34.0,
        tip: 140.0,
        lift: 0.14,
        size: 30.0,
    },
];

/// The strands file: 24 strands.
pub(super) fn strands() -> String {
    let mut text = "\
// A short bob on a head of 24 cm. Each strand runs from its root to its tip: (x, y, z) in metres,
// y up, the face towards +z. `size` is the clump's radius in 1/300 of the head's height.
(
    version: 1,
    strands: [
"
    .to_owned();
    for row in ROWS {
        for i in 0..row.count {
            let around = (f64::from(i) + row.turn) / f64::from(row.count) * TAU;
            let points: Vec<String> = strand(&row, around)
                .map(|[x, y, z]| format!("({x:.4}, {y:.4}, {z:.4})"))
                .collect();
            let size = row.size;
            let _ = writeln!(
                text,
                "        (size: {size:.1}, points: [{}]),",
                points.join(", ")
            );
        }
    }
    text + "    ],\n)\n"
}

/// A strand that follows the head down, and leaves it towards the tip. `around` is 0 at the face.
fn strand(row: &Row, around: f64) -> impl Iterator<Item = [f64; 3]> {
    // The fringe ends over the eyes.
    let front = ((around.cos() - 0.55) / 0.45).clamp(0.0, 1.0);
    let tip = row.tip - front * (row.tip - 98.0);
    let (root, lift) = (row.root, row.lift);
    const POINTS: u32 = 7;
    (0..POINTS).map(move |i| {
        let s = f64::from(i) / f64::from(POINTS - 1);
        let down = (root + s * (tip - root)).to_radians();
        let radius = SCALP * (1.0 + lift * s);
        [
            CENTER[0] + radius * down.sin() * around.sin(),
            CENTER[1] + radius * down.cos(),
            CENTER[2] + radius * down.sin() * around.cos(),
        ]
    })
}

/// The preset's text.
pub(super) fn preset(name: &str, strands: &str) -> String {
    include_str!("starter.ron")
        .replace("NAME", name)
        .replace("STRANDS", strands)
}
