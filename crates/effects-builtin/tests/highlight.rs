//! `hair.highlight` against transcriptions in f64.

mod joint;

use effects::wgsl::{Stroke, hash, vec3};
use effects::{Joints, StrokeEffect};
use effects_builtin::Highlight;
use joint::{One, lit_joint, stroke};
use proptest::prelude::*;

/// One stroke that fills the clump, without variation.
const PLAIN: [(&str, &str); 8] = [
    ("feathers", "1"),
    ("strand_variation", "0"),
    ("feather_variation", "0"),
    ("spread", "1"),
    ("scatter", "0"),
    ("roundness", "0"),
    ("thinnest", "0"),
    ("start", "0"),
];

fn highlight(joints: &Joints, instance: u32, set: &[(&str, &str)]) -> Stroke {
    let set: Vec<_> = PLAIN.iter().chain(set).copied().collect();
    stroke::<Highlight>(joints, instance, 1, &set)
}

/// 1 from `full` on, 0 up to `edge`, linear between.
fn share(light: f64, full: f64, edge: f64) -> f64 {
    if light >= full {
        1.0
    } else if light <= edge {
        0.0
    } else {
        1.0 - (light - full).abs() / (edge - full).abs()
    }
}

#[test]
fn specular_is_phongs() {
    // Normal and eye are +z, so the mirrored light is as far from the eye as the light.
    for degrees in [0.0f64, 10.0, 20.0, 30.0, 40.0, 60.0, 89.0] {
        let gray = degrees.to_radians().cos();
        let expected = 20.0 * share(gray.powf(8.0), 0.9, 0.2);
        let set = [("exponent", "8"), ("full", "0.9"), ("threshold", "0.2")];
        let got = highlight(&lit_joint(gray as f32, 20.0), 0, &set).radius;
        assert!(
            (f64::from(got) - expected).abs() < 1e-3,
            "{degrees}: {got}, not {expected}"
        );
    }
}

#[test]
fn the_ring_lies_where_the_hair_is_across_the_half_way_vector() {
    for degrees in [0.0f64, 10.0, 20.0, 30.0, 40.0, 60.0] {
        // The hair hangs down; the light is that far above the eye.
        let light = degrees.to_radians();
        let cosine = (light / 2.0).sin();
        let expected = 20.0 * share((1.0 - cosine * cosine).sqrt().powf(4.0 * 12.0), 0.9, 0.2);
        let set = [
            ("kind", "ring"),
            ("exponent", "12"),
            ("full", "0.9"),
            ("threshold", "0.2"),
        ];
        let got = highlight(&lit_joint(light.cos() as f32, 20.0), 0, &set).radius;
        assert!(
            (f64::from(got) - expected).abs() < 1e-2,
            "{degrees}: {got}, not {expected}"
        );
    }
}

#[test]
fn a_light_with_a_place_has_a_reach() {
    let set = [("kind", "distance"), ("near", "2"), ("far", "4")];
    for (distance, radius) in [
        (1.0, 20.0),
        (2.0, 20.0),
        (3.0, 10.0),
        (3.5, 5.0),
        (4.0, 0.0),
        (1e6, 0.0),
    ] {
        let mut joints = lit_joint(0.0, 20.0);
        joints.light_distance = vec![distance];
        assert_eq!(highlight(&joints, 0, &set).radius, radius, "{distance}");
        let step = [set[0], ("near", "3"), ("far", "3")];
        let expected = if distance <= 3.0 { 20.0 } else { 0.0 };
        assert_eq!(
            highlight(&joints, 0, &step).radius,
            expected,
            "a hard step at {distance}"
        );
    }
    let params = One::<Highlight>::params;
    assert!(Highlight::needs_point_light(&params(&set)));
    assert!(!Highlight::needs_point_light(&params(&[])));
}

#[test]
fn lines_have_one_width() {
    let set = [("shape", "lines"), ("width", "3"), ("feathers", "4")];
    assert_eq!(highlight(&lit_joint(1.0, 20.0), 0, &set).radius, 1.5);
    // But where the clump has no room for them.
    assert_eq!(highlight(&lit_joint(1.0, 2.0), 0, &set).radius, 0.5);
}

#[test]
fn shares_leave_strands_and_strokes_out() {
    let count = |name: &str| {
        let drawn = |strand: u32| {
            let mut joints = lit_joint(1.0, 20.0);
            joints.seed = vec![hash(strand)];
            let set = [(name, "0.3"), ("feathers", "5")];
            let radii = (0..5).map(|i| highlight(&joints, i, &set).radius);
            radii.filter(|radius| *radius > 0.0).count()
        };
        (0..400).map(drawn).collect::<Vec<_>>()
    };
    let strands = count("strand_share");
    assert!(strands.iter().all(|n| *n == 0 || *n == 5));
    let strokes = count("feather_share");
    assert!(strokes.iter().any(|n| (1..5).contains(n)));
    for counts in [strands, strokes] {
        let drawn = counts.iter().sum::<usize>();
        assert!((500..700).contains(&drawn), "{drawn} of 2000");
    }
}

#[test]
fn roots_have_none() {
    let mut joints = lit_joint(1.0, 20.0);
    joints.u = vec![0.2];
    assert_eq!(highlight(&joints, 0, &[("start", "0.2")]).radius, 0.0);
    assert_eq!(highlight(&joints, 0, &[("start", "0.1")]).radius, 20.0);
}

proptest! {
    #[test]
    fn strokes_are_never_negative_and_stay_in_the_clump(
        normal in prop::array::uniform3(-1.0f32..1.0),
        light in prop::array::uniform3(-1.0f32..1.0),
        clump in 0.0f32..50.0,
        kind in prop::sample::select(vec!["specular", "distance", "ring"]),
        shape in prop::sample::select(vec!["feathers", "lines"]),
        numbers in prop::array::uniform6(0.0f32..=1.0),
        exponent in 1.0f32..=1000.0,
        instance in 0u32..4,
    ) {
        let unit = |v: [f32; 3]| {
            let length = v.iter().map(|x| x * x).sum::<f32>().sqrt().max(1e-3);
            vec3(v.map(|x| x / length))
        };
        let mut joints = lit_joint(0.5, clump);
        (joints.normal[0], joints.light_direction[0]) = (unit(normal), unit(light));
        let names = ["threshold", "full", "strand_variation", "feather_variation", "roundness", "spread"];
        let values = numbers.map(|n| n.to_string());
        let exponent = exponent.to_string();
        let mut set: Vec<_> = names.into_iter().zip(values.iter().map(String::as_str)).collect();
        set.extend([("kind", kind), ("shape", shape), ("exponent", &exponent)]);
        let stroke = stroke::<Highlight>(&joints, instance, 1, &set);
        prop_assert!((0.0..=clump).contains(&stroke.radius), "{stroke:?}");
        prop_assert!(stroke.offset.x.abs() <= 1.3 * clump && stroke.offset.y.abs() <= 1.3 * clump);
    }
}
