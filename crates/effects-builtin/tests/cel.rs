//! `hair.cel` against a transcription of 5.3 in f64.

mod joint;

use effects::wgsl::{Stroke, hash, vec2, vec3};
use effects::{Joints, StrokeEffect};
use effects_builtin::Cel;
use joint::{One, lit_joint, stroke};
use proptest::prelude::*;

/// 5.5 and 5.6 with the erratum: the bracket closes after the quotient.
fn size(gray: f64, full: f64, edge: f64, size_base: f64, feathers: f64) -> f64 {
    let basic = size_base / feathers;
    if gray <= full {
        basic
    } else if gray <= edge {
        (1.0 - (gray - full).abs() / (edge - full).abs()) * basic
    } else {
        0.0
    }
}

/// The source's own stroke: no variation, no roundness, neighbours that just touch, hairlines and all.
const PLAIN: [(&str, &str); 5] = [
    ("strand_variation", "0"),
    ("feather_variation", "0"),
    ("roundness", "0"),
    ("fullness", "1"),
    ("thinnest", "0"),
];

fn cel(joints: &Joints, instance: u32, set: &[(&str, &str)]) -> Stroke {
    let set: Vec<_> = PLAIN.iter().chain(set).copied().collect();
    stroke::<Cel>(joints, instance, 1, &set)
}

#[test]
fn strokes_side_by_side_span_the_clump() {
    let joints = lit_joint(0.0, 20.0);
    let edges: Vec<[f32; 2]> = (0..4)
        .map(|i| {
            let stroke = cel(&joints, i, &[("feathers", "4")]);
            assert_eq!(stroke.offset.y, 0.0, "across is -x here");
            [
                stroke.offset.x - stroke.radius,
                stroke.offset.x + stroke.radius,
            ]
        })
        .collect();
    let from_right = [[10.0, 20.0], [0.0, 10.0], [-10.0, 0.0], [-20.0, -10.0]];
    assert_eq!(edges, from_right);
    assert_eq!(Cel::instances(&One::<Cel>::params(&[("feathers", "4")])), 4);
}

#[test]
fn a_hard_step_is_legal() {
    for (gray, radius) in [(0.3, 4.0), (0.399, 4.0), (0.401, 0.0), (1.0, 0.0)] {
        let set = [("full", "0.4"), ("threshold", "0.4")];
        assert_eq!(
            cel(&lit_joint(gray, 20.0), 2, &set).radius,
            radius,
            "{gray}"
        );
        let lighter = [set[0], set[1], ("region", "lighter")];
        let mirrored = cel(&lit_joint(gray, 20.0), 2, &lighter).radius;
        assert_eq!(mirrored, 4.0 - radius, "{gray}");
    }
}

/// Where the threshold is beyond the gray of full size, the step is where it is.
#[test]
fn a_region_ends_at_its_threshold() {
    for (threshold, region, gray, radius) in [
        ("0.2", "darker", 0.199, 4.0),
        ("0.2", "darker", 0.201, 0.0),
        ("0.6", "lighter", 0.599, 0.0),
        ("0.6", "lighter", 0.601, 4.0),
    ] {
        let set = [
            ("full", "0.4"),
            ("threshold", threshold),
            ("region", region),
        ];
        let got = cel(&lit_joint(gray, 20.0), 2, &set).radius;
        assert_eq!(got, radius, "{threshold} {region} {gray}");
    }
}

#[test]
fn strokes_grow_from_the_root() {
    let radius = |u: f32| {
        let mut joints = lit_joint(0.0, 20.0);
        joints.u = vec![u];
        cel(&joints, 1, &[("root_fade", "0.2")]).radius
    };
    assert_eq!(radius(0.0), 0.0);
    assert!((radius(0.1) - 2.0).abs() < 1e-6);
    assert_eq!(radius(0.2), 4.0);
}

#[test]
fn where_a_flat_clump_points_away_the_row_lies_along_its_outer_side() {
    let mut joints = lit_joint(0.0, 20.0);
    joints.forward = vec![vec3([0.0, 0.0, -1.0])];
    joints.view_direction = vec![vec3([0.0, 0.0, 1.0])];
    joints.clump_shift = vec![vec2([0.0, 15.0])];
    for instance in 0..5 {
        let stroke = cel(&joints, instance, &[]);
        let place = 0.4 * (instance as f32 - 2.0);
        assert!((stroke.offset.x.abs() - 20.0 * place.abs()).abs() < 1e-4);
        // The ellipse is 5 thick, about an axis 15 above the disc's middle.
        let outer = 15.0 + 5.0 * (1.0 - place * place).sqrt();
        let reach = stroke.radius - stroke.offset.y;
        assert!((reach - outer).abs() < 1e-4, "{instance}: {reach}, {outer}");
    }
}

#[test]
fn what_no_light_reaches_is_dark_whatever_varies() {
    for strand in 0..200 {
        let mut joints = lit_joint(0.0, 20.0);
        joints.seed = vec![hash(strand)];
        let set = [
            ("threshold", "0.1"),
            ("full", "0.05"),
            ("strand_variation", "1"),
        ];
        assert_eq!(cel(&joints, 0, &set).radius, 4.0);
    }
}

#[test]
fn a_given_colour_wins_over_the_factor() {
    let joints = lit_joint(0.0, 20.0);
    let factor = cel(&joints, 0, &[("factor", "0.5")]).color;
    assert_eq!(factor, vec3([0.1, 0.2, 0.4]));
    let given = cel(&joints, 0, &[("factor", "0.5"), ("color", "FF0000")]).color;
    assert_eq!(given, vec3([1.0, 0.0, 0.0]));
}

#[test]
fn variation_hangs_on_seed_strand_and_feather() {
    let radius = |seed: u32, strand: u32, feather: u32| {
        let mut joints = lit_joint(0.4, 20.0);
        joints.seed = vec![hash(strand)];
        let set = [("full", "0"), ("threshold", "1")];
        stroke::<Cel>(&joints, feather, seed, &set).radius
    };
    let once = radius(1, 1, 1);
    assert_eq!(once, radius(1, 1, 1));
    for other in [radius(2, 1, 1), radius(1, 2, 1), radius(1, 1, 2)] {
        assert_ne!(once, other);
    }
}

#[test]
fn the_dark_side_of_a_round_lock_is_darker() {
    // The light comes from the right of the screen, where the first stroke lies.
    let mut joints = lit_joint(0.0, 20.0);
    joints.light_direction = vec![vec3([0.8, 0.0, 0.6])];
    let set = [("roundness", "1"), ("full", "0.2"), ("threshold", "1")];
    let radii: Vec<f32> = (0..5).map(|i| cel(&joints, i, &set).radius).collect();
    assert!(radii.windows(2).all(|pair| pair[0] < pair[1]), "{radii:?}");
}

#[test]
fn no_hairlines_and_no_lost_tips() {
    let set = |gray: f32, clump: f32| {
        let set = [("thinnest", "2"), ("full", "0"), ("threshold", "1")];
        cel(&lit_joint(gray, clump), 0, &set).radius
    };
    // A stroke of radius 4 at most: below 1 there is none.
    assert_eq!(set(0.76, 20.0), 0.0);
    assert!(set(0.74, 20.0) > 0.0);
    assert_eq!(set(0.0, 20.0), 4.0);
    // At a tip the whole stroke is thinner than that.
    assert_eq!(set(0.0, 0.5), 0.1);
}

proptest! {
    #[test]
    fn sizes_are_those_of_the_source(
        gray in 0.0f32..=1.0,
        (full, edge) in (0.0f32..=1.0, 0.0f32..=1.0),
        clump in 0.0f32..50.0,
        feathers in 1u32..=32,
    ) {
        let joints = lit_joint(gray, clump);
        let gray = f64::from((joints.light_direction[0].dot(joints.normal[0]).0).max(0.0));
        let (low, high) = (full.min(edge), full.max(edge));
        let set = |low: f32, high: f32| {
            [("feathers", feathers.to_string()), ("full", low.to_string()), ("threshold", high.to_string())]
        };
        let owned = set(low, high);
        let darker: Vec<_> = owned.iter().map(|(n, v)| (*n, v.as_str())).collect();
        let got = f64::from(cel(&joints, 0, &darker).radius);
        let expected = size(gray, low.into(), high.into(), clump.into(), feathers.into());
        prop_assert!((got - expected).abs() <= 1e-4 * (1.0 + expected), "{got} {expected}");
        // Mirrored: the same with 1 - gray.
        let owned = set(high, low);
        let mut lighter: Vec<_> = owned.iter().map(|(n, v)| (*n, v.as_str())).collect();
        lighter.push(("region", "lighter"));
        let got = f64::from(cel(&joints, 0, &lighter).radius);
        let expected = size(-gray, f64::from(-high), f64::from(-low), clump.into(), feathers.into());
        prop_assert!((got - expected).abs() <= 1e-4 * (1.0 + expected), "{got} {expected}");
    }

    #[test]
    fn sizes_are_never_negative(
        gray in -1.0f32..=1.0,
        numbers in prop::array::uniform6(0.0f32..=1.0),
        clump in 0.0f32..50.0,
        instance in 0u32..5,
    ) {
        let names = ["threshold", "full", "strand_variation", "feather_variation", "roundness", "thinnest"];
        let values = numbers.map(|n| n.to_string());
        let set: Vec<_> = names.into_iter().zip(values.iter().map(String::as_str)).collect();
        let stroke = stroke::<Cel>(&lit_joint(gray, clump), instance, 1, &set);
        prop_assert!((0.0..=clump).contains(&stroke.radius), "{stroke:?}");
        prop_assert!(stroke.offset.x.abs() <= clump);
    }
}
