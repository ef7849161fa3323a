//! `hair.ink`: widths of a line along a strand, against what a reader of its parameters would work out.

mod joint;

use effects::wgsl::{hash, vec3};
use effects::{Joints, StrokeEffect as _};
use effects_builtin::Ink;
use joint::{One, lit_joint, stroke};
use proptest::prelude::*;

/// An even line: only what a test sets makes it swell.
const EVEN: [(&str, &str); 6] = [
    ("width", "4"),
    ("ratio", "10"),
    ("light_width", "1"),
    ("root_fade", "0"),
    ("tip_fade", "0"),
    ("wobble", "0"),
];

const HEAD_M: f32 = 0.25;

/// A joint of a clump of 20, at a share of its strand and so many head heights from its root.
fn joint_at(u: f32, from_root: f32, strand: u32, gray: f32) -> Joints {
    Joints {
        u: vec![u],
        arc_length: vec![from_root * HEAD_M],
        head_height: vec![HEAD_M],
        seed: vec![hash(strand)],
        ..lit_joint(gray, 20.0)
    }
}

/// How far the line reaches past the clump.
fn width(joints: &Joints, set: &[(&str, &str)]) -> f32 {
    let set: Vec<_> = EVEN.iter().chain(set).copied().collect();
    stroke::<Ink>(joints, 0, 1, &set).radius - 20.0
}

#[test]
fn it_is_bold_in_shadow_and_thin_in_light() {
    for (gray, expected) in [(0.0, 4.0), (0.5, 2.5), (1.0, 1.0)] {
        let got = width(&joint_at(0.5, 1.0, 3, gray), &[("light_width", "0.25")]);
        assert!(
            (got - expected).abs() < 1e-4,
            "{gray}: {got}, not {expected}"
        );
    }
}

#[test]
fn it_tapers_at_both_ends() {
    let set = [("root_fade", "0.2"), ("tip_fade", "0.4")];
    let at = |u: f32| width(&joint_at(u, 1.0, 3, 0.5), &set);
    assert!(at(0.0).abs() < 1e-5 && at(1.0).abs() < 1e-5);
    assert!((at(0.1) - 2.0).abs() < 1e-4 && (at(0.8) - 2.0).abs() < 1e-4);
    assert!((at(0.2) - 4.0).abs() < 1e-4 && (at(0.6) - 4.0).abs() < 1e-4);
}

/// A hand's trembles are the strand's own, reach as far up as down, and are as far apart as is said.
#[test]
fn it_trembles_on_each_strand_in_its_own_way() {
    let set = [("wobble", "0.5"), ("wobble_length", "0.2")];
    let along = |strand: u32| -> Vec<f32> {
        let at = |i| width(&joint_at(0.5, 0.02 * i as f32, strand, 0.5), &set);
        (0..200).map(at).collect()
    };
    let (mut low, mut high, mut turns) = (f32::INFINITY, 0.0_f32, 0);
    for strand in 0..40 {
        let widths = along(strand);
        low = widths.iter().copied().fold(low, f32::min);
        high = widths.iter().copied().fold(high, f32::max);
        let rises = widths.windows(2).map(|pair| pair[1] > pair[0]);
        let rises: Vec<bool> = rises.collect();
        turns += rises.windows(2).filter(|pair| pair[0] != pair[1]).count();
    }
    assert!(
        (2.0..2.1).contains(&low) && (5.9..6.0).contains(&high),
        "{low} to {high}"
    );
    // Of four head heights twenty are whole places, between which it runs one way; two of three random numbers turn it.
    let turns = turns as f32 / 40.0;
    assert!((11.0..15.0).contains(&turns), "{turns} turns a strand");
    assert_ne!(along(1), along(2));
}

#[test]
fn the_brush_leaves_the_paper_where_it_is_told_to() {
    let shares = [0.0, 0.3, 0.5, 0.8, 1.0].map(|gaps: f32| {
        let text = gaps.to_string();
        let set = [("gaps", &*text)];
        let places = (0..100).flat_map(|strand| (0..100).map(move |i| (strand, 0.1 * i as f32)));
        let drawn =
            places.filter(|&(strand, at)| width(&joint_at(0.5, at, strand, 0.5), &set) > 0.1);
        drawn.count() as f32 / 1e4
    });
    assert_eq!((shares[0], shares[4]), (1.0, 0.0));
    assert!(shares.is_sorted_by(|a, b| a > b), "{shares:?}");
    assert!((shares[2] - 0.5).abs() < 0.06, "{shares:?}");
}

/// No line between two gaps, and no gap, is shorter than the author says, from root to tip; each line ends in points.
#[test]
fn no_line_between_gaps_is_shorter_than_said() {
    const LENGTH: f32 = 2.37;
    let set = [("gaps", "0.5"), ("shortest", "0.3")];
    let mut count = [0, 0];
    for strand in 0..60 {
        let along = |i: usize| 0.001 * i as f32;
        let widths = (0..2370).map(|i| {
            let at = along(i);
            width(&joint_at(at / LENGTH, at, strand, 0.5), &set)
        });
        let widths: Vec<f32> = widths.collect();
        let steps = widths.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        assert!(steps.fold(0.0, f32::max) < 0.05, "a blunt end");
        let stretches = widths.chunk_by(|a, b| (*a > 0.1) == (*b > 0.1));
        let mut stretches = stretches.peekable();
        while let Some(stretch) = stretches.next() {
            let is_line = stretch[0] > 0.1;
            count[usize::from(is_line)] += 1;
            let least = if stretches.peek().is_some() { 280 } else { 140 };
            assert!(stretch.len() > least, "{strand}: {} of 300", stretch.len());
        }
    }
    assert!(count[0] > 60 && count[1] > 60, "{count:?}");
}

#[test]
fn within_a_shadow_it_has_the_shadows_line() {
    let set = [("color", "000000"), ("shadow_color", "FFFFFF")];
    let set: Vec<_> = EVEN.iter().chain(&set).copied().collect();
    let color = |gray: f32| stroke::<Ink>(&joint_at(0.5, 1.0, 3, gray), 0, 1, &set).color;
    assert_eq!(color(0.1), vec3([1.0; 3]));
    assert_eq!(color(0.9), vec3([0.0; 3]));
    let between = color(0.4).x;
    assert!((between - 0.5).abs() < 1e-3, "{between}");
}

/// Ink can't fade from black to white: where the line changes its colour it has no width, and it gets its width back steadily on both sides. Shades of one
/// colour blend without that.
#[test]
fn a_line_is_no_gradient() {
    let at = |shadow: &'static str, gray: f32| {
        let set = [("color", "000000"), ("shadow_color", shadow)];
        let set: Vec<_> = EVEN.iter().chain(&set).copied().collect();
        let joint = joint_at(0.5, 1.0, 3, gray);
        (
            width(&joint, &set),
            stroke::<Ink>(&joint, 0, 1, &set).color.x,
        )
    };
    let whole = at("FFFFFF", 0.9).0;
    assert!(whole > 3.9, "{whole}");
    let (mut before, mut gray) = (at("FFFFFF", 0.2).0, 0.2);
    while gray < 0.6 {
        let (width, color) = at("FFFFFF", gray);
        assert!(
            (width - before).abs() < 0.05,
            "{gray}: {width} after {before}"
        );
        assert!(
            color == 0.0 || color == 1.0 || width < 0.1 * whole,
            "{gray}: {color}, {width} wide"
        );
        assert!((at("303030", gray).0 - whole).abs() < 1e-4);
        (before, gray) = (width, gray + 0.001);
    }
    assert!(at("FFFFFF", 0.4).0 < 0.01);
    assert!(
        [0.2, 0.6]
            .iter()
            .all(|gray| (at("FFFFFF", *gray).0 - whole).abs() < 1e-4)
    );
}

proptest! {
    /// However it swells, it is no wider than its share of the clump, and never narrower than the clump.
    #[test]
    fn tips_stay_points(u in 0.0..1.0_f32, from_root in 0.0..8.0_f32, strand in 0..50_u32, gray in -1.0..1.0_f32) {
        let got = width(&joint_at(u, from_root, strand, gray), &[("width", "50"), ("ratio", "0.2"), ("wobble", "1"), ("light_width", "1.5")]);
        prop_assert!((-1e-4..=4.0001).contains(&got), "{got}");
    }
}

/// What lies so far behind the line (head heights) sees all strokes that are nearer than it: the widest of them is the line.
fn width_before(behind: f32, set: &[(&str, &str)]) -> f32 {
    let all: Vec<_> = EVEN.iter().chain(set).copied().collect();
    let params = One::<Ink>::params(&all);
    let strokes = (0..Ink::instances(&params))
        .map(|instance| stroke::<Ink>(&joint_at(0.5, 1.0, 3, 0.5), instance, 1, &all));
    let shown = strokes.filter(|stroke| stroke.depth_offset <= behind);
    shown.map(|stroke| stroke.radius - 20.0).fold(0.0, f32::max)
}

/// Line quality by depth: the widths at gaps of 0 and of 0.1 head heights differ by the set ratio, and between both the width grows steadily.
#[test]
fn it_is_bolder_before_what_is_far_behind() {
    for ratio in [1.5_f32, 2.0, 3.0, 3.5, 8.0] {
        let text = ratio.to_string();
        let set = [("gap_width", &*text)];
        let [close, far] = [0.0, 0.1].map(|behind| width_before(behind, &set));
        assert!((close - 4.0).abs() < 1e-4, "{close}");
        assert!((far / close / ratio - 1.0).abs() < 0.05, "{far} / {close}");
        let half_way = width_before(0.05, &set);
        assert!((half_way - 2.0 * (1.0 + ratio)).abs() < 1e-3, "{half_way}");
        assert!((width_before(5.0, &set) - far).abs() < 1e-6);
        let deeper = [("gap_width", &*text), ("gap", "0.2")];
        assert!(width_before(0.1, &deeper) < far && width_before(0.2, &deeper) == far);
    }
    // Without it there is one line, as before.
    let params = One::<Ink>::params(&EVEN);
    assert_eq!(Ink::instances(&params), effects::CLUMP_DISCS);
    assert_eq!(width_before(0.0, &[]), 4.0);
}

/// Within a strand strokes lie on each other in their order, whatever their depths: a wide one on a fine one would hide it, and lose against the clump beside
/// it, so that there would be no line between locks.
#[test]
fn its_finest_line_lies_on_top() {
    for (gap_width, steps) in [("2", 3), ("3", 3), ("8", 5)] {
        its_finest_line_lies_on_top_of(gap_width, steps);
    }
}

fn its_finest_line_lies_on_top_of(gap_width: &str, steps: usize) {
    let set: Vec<_> = EVEN
        .iter()
        .chain(&[("gap_width", gap_width)])
        .copied()
        .collect();
    let params = One::<Ink>::params(&set);
    let joint = joint_at(0.5, 1.0, 3, 0.5);
    let strokes = (0..Ink::instances(&params))
        .step_by(effects::CLUMP_DISCS as usize)
        .map(|instance| stroke::<Ink>(&joint, instance, 1, &set));
    let strokes: Vec<_> = strokes.collect();
    assert_eq!(strokes.len(), steps);
    for pair in strokes.windows(2) {
        assert!(pair[1].radius < pair[0].radius);
        assert!(pair[1].depth_offset < pair[0].depth_offset);
    }
    let top = strokes.last().unwrap();
    assert_eq!((top.radius, top.depth_offset), (24.0, 0.0));
}
