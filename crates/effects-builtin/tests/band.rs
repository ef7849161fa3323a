//! `hair.band` against a transcription in f64.

mod joint;

use effects::wgsl::{Stroke, hash, random, vec2, vec3};
use effects::{Joints, StrandJoints, StrokeEffect};
use effects_builtin::Band;
use joint::{One, lit_joint, stroke};
use proptest::prelude::*;

/// One tooth that fills the clump, without variation, in any light.
const PLAIN: [(&str, &str); 9] = [
    ("teeth", "1"),
    ("zigzag", "0"),
    ("tooth_variation", "0"),
    ("strand_variation", "0"),
    ("strand_share", "1"),
    ("start", "0"),
    ("shade", "-1"),
    ("spread", "1"),
    ("thinnest", "0"),
];

const HEAD_M: f32 = 0.25;

/// A joint at this height above the head's middle and so far from its root, head heights.
fn joint_at(height: f32, from_root: f32) -> Joints {
    Joints {
        rest_position: vec![vec3([0.1, height, 0.4])],
        rest_forward: vec![vec3([0.0, -1.0, 0.0])],
        arc_length: vec![from_root * HEAD_M],
        head_height: vec![HEAD_M],
        ..lit_joint(0.9, 20.0)
    }
}

fn band(joints: &Joints, instance: u32, set: &[(&str, &str)]) -> Stroke {
    let set: Vec<_> = PLAIN.iter().chain(set).copied().collect();
    stroke::<Band>(joints, instance, 1, &set)
}

/// The radius of a tooth `away` from the band's middle, in a clump of 20.
fn expected(away: f64, thickness: f64, taper: f64) -> f64 {
    let half = 0.5 * thickness;
    20.0 * ((half - away.abs()) / (taper * half)).clamp(0.0, 1.0)
}

#[test]
fn a_band_lies_at_one_height_of_the_head() {
    let set = [
        ("place", "0.3"),
        ("thickness", "0.1"),
        ("taper", "0.5"),
        ("slide", "0"),
        ("fullness", "1"),
    ];
    for step in 0..40 {
        let height = 0.2 + 0.005 * step as f32;
        let got = f64::from(band(&joint_at(height, 1.0), 0, &set).radius);
        let expected = expected(f64::from(height) - 0.3, 0.1, 0.5);
        assert!(
            (got - expected).abs() < 1e-3,
            "{height}: {got}, not {expected}"
        );
    }
}

#[test]
fn or_at_one_distance_from_the_roots_whatever_the_height() {
    let set = [
        ("along", "length"),
        ("place", "0.8"),
        ("thickness", "0.2"),
        ("taper", "1"),
        ("fullness", "1"),
    ];
    for step in 0..40 {
        let from_root = 0.6 + 0.01 * step as f32;
        let got = f64::from(band(&joint_at(-1.7, from_root), 0, &set).radius);
        let expected = expected(f64::from(from_root) - 0.8, 0.2, 1.0);
        assert!(
            (got - expected).abs() < 1e-3,
            "{from_root}: {got}, not {expected}"
        );
    }
}

/// Eye ahead (+z): a ball of half a head's height mirrors the light at half the light's angle.
#[test]
fn it_slides_a_part_of_the_way_to_where_a_ball_mirrors_the_light() {
    for degrees in [0.0_f64, 20.0, 50.0, 80.0] {
        let light = degrees.to_radians();
        let mirrored = 0.5 * (0.5 * light).sin();
        let middle = 0.3 + 0.25 * (mirrored - 0.3);
        let set = [
            ("place", "0.3"),
            ("thickness", "0.02"),
            ("taper", "1"),
            ("slide", "0.25"),
            ("fullness", "1"),
        ];
        let mut joint = joint_at(middle as f32, 1.0);
        joint.light_direction = vec![vec3([0.0, light.sin() as f32, light.cos() as f32])];
        let at_middle = band(&joint, 0, &set).radius;
        assert!((at_middle - 20.0).abs() < 0.02, "{degrees}: {at_middle}");
        joint.rest_position = vec![vec3([0.0, middle as f32 + 0.011, 0.0])];
        assert_eq!(band(&joint, 0, &set).radius, 0.0, "{degrees}");
    }
}

#[test]
fn hair_in_shadow_has_none_and_it_narrows_towards_it() {
    let set = [
        ("place", "0.3"),
        ("shade", "0.4"),
        ("shade_fade", "0.4"),
        ("roundness", "0"),
        ("slide", "0"),
        ("fullness", "1"),
    ];
    for (gray, expected) in [(0.2, 0.0), (0.4, 0.0), (0.5, 5.0), (0.6, 10.0), (0.8, 20.0)] {
        let joints = Joints {
            light_direction: lit_joint(gray, 20.0).light_direction,
            ..joint_at(0.3, 1.0)
        };
        let got = band(&joints, 0, &set).radius;
        assert!(
            (got - expected).abs() < 1e-2,
            "{gray}: {got}, not {expected}"
        );
    }
}

/// As `hair.toon` paints a round lock: in its middle it faces the eye, wherever the clump's normal points.
#[test]
fn painted_locks_have_it_where_they_are_painted_light() {
    let joints = Joints {
        normal: vec![vec3([1.0, 0.0, 0.0])],
        light_direction: vec![vec3([0.0, 0.0, 1.0])],
        ..joint_at(0.3, 1.0)
    };
    let with = |shadow: &str, roundness: &str| {
        let set = [
            ("place", "0.3"),
            ("shade", "0.5"),
            ("shade_fade", "0.01"),
            ("slide", "0"),
            ("shadow", shadow),
            ("roundness", roundness),
        ];
        band(&joints, 0, &set).radius
    };
    assert_eq!(with("strokes", "1"), 0.0);
    assert_eq!(with("toon", "0"), 0.0);
    assert!(with("toon", "1") > 10.0);
    // Half way between both normals the gray is 0.7.
    assert!(with("toon", "0.5") > 10.0 && with("toon", "0.3") == 0.0);
}

#[test]
fn it_breaks_at_roots_and_on_some_strands() {
    let set = [
        ("place", "0.3"),
        ("slide", "0"),
        ("start", "0.2"),
        ("fullness", "1"),
    ];
    assert_eq!(band(&joint_at(0.3, 0.19), 0, &set).radius, 0.0);
    assert!(band(&joint_at(0.3, 0.25), 0, &set).radius > 19.0);

    let set = [("place", "0.3"), ("slide", "0"), ("strand_share", "0.6")];
    let has_band = |strand: u32| {
        let joints = Joints {
            seed: vec![hash(strand)],
            ..joint_at(0.3, 1.0)
        };
        band(&joints, 0, &set).radius > 0.0
    };
    let share = (0..1000).filter(|&strand| has_band(strand)).count();
    assert!((560..640).contains(&share), "{share} of 1000, not 0.6");
}

/// A tooth would go on and on along it; at one distance from the roots it ends all the same.
#[test]
fn level_hair_has_none_at_one_height() {
    let at_height = [("place", "0.3"), ("slide", "0"), ("fullness", "1")];
    let at_length = [("along", "length"), ("place", "1"), ("fullness", "1")];
    for (steep, expected) in [
        (0.0_f32, 0.0),
        (0.2, 0.0),
        (0.325, 10.0),
        (-0.325, 10.0),
        (0.45, 20.0),
        (-1.0, 20.0),
    ] {
        let joints = Joints {
            rest_forward: vec![vec3([(1.0 - steep * steep).sqrt(), steep, 0.0])],
            ..joint_at(0.3, 1.0)
        };
        let got = band(&joints, 0, &at_height).radius;
        assert!(
            (got - expected).abs() < 1e-3,
            "{steep}: {got}, not {expected}"
        );
        assert!((band(&joints, 0, &at_length).radius - 20.0).abs() < 1e-3);
    }
    // However it lies now: the head leans, or wind blows.
    let blown = Joints {
        forward: vec![vec3([1.0, 0.0, 0.0])],
        ..joint_at(0.3, 1.0)
    };
    assert!((band(&blown, 0, &at_height).radius - 20.0).abs() < 1e-3);
}

/// Teeth of no size have no rim either.
#[test]
fn a_band_of_no_teeth_is_nothing() {
    let set = [("place", "0.3"), ("slide", "0"), ("rim", "2")];
    assert!(band(&joint_at(0.3, 1.0), 0, &set).radius > 0.0);
    for none in [("fullness", "0"), ("spread", "0"), ("thickness", "0")] {
        let set = [&set[..], &[none]].concat();
        assert_eq!(band(&joint_at(0.3, 1.0), 0, &set).radius, 0.0, "{none:?}");
    }
}

/// Where the joint's tooth ends above the band's middle, head heights.
fn end(instance: u32, set: &[(&str, &str)]) -> f32 {
    let has_size =
        |i: &u32| band(&joint_at(0.3 + 1e-3 * *i as f32, 1.0), instance, set).radius > 0.0;
    1e-3 * (0..1000).take_while(has_size).count() as f32
}

#[test]
fn every_other_tooth_is_deeper_and_a_rim_goes_around_all() {
    let set = [
        ("place", "0.3"),
        ("thickness", "0.2"),
        ("slide", "0"),
        ("teeth", "4"),
        ("zigzag", "0.4"),
        ("rim", "3"),
    ];
    // The rim's strokes come first; it reaches 3/300 of the head's height farther.
    let ends: Vec<f32> = (0..8).map(|instance| end(instance, &set)).collect();
    for (tooth, expected) in [0.08, 0.12, 0.08, 0.12].into_iter().enumerate() {
        let (rim, core) = (ends[tooth], ends[tooth + 4]);
        assert!(
            (core - expected).abs() < 2e-3,
            "tooth {tooth} ends at {core}, not {expected}"
        );
        assert!(
            (rim - core - 0.01).abs() < 2e-3,
            "the rim of tooth {tooth} ends at {rim}, {core}"
        );
    }
    let joints = joint_at(0.3, 1.0);
    let (rim, core) = (band(&joints, 1, &set), band(&joints, 5, &set));
    assert!((rim.radius - core.radius - 3.0).abs() < 1e-3 && rim.offset == core.offset);
    // Without a colour of its own the rim has one between the clump's and the band's.
    assert_eq!(core.color, vec3([1.0; 3]));
    assert!((rim.color.x - 0.6).abs() < 1e-6 && (rim.color.z - 0.9).abs() < 1e-6);
}

proptest! {
    /// Teeth keep to the clump's width, in their places.
    #[test]
    fn teeth_lie_side_by_side(teeth in 1..9_u32, spread in 0.1..1.0_f32) {
        let (count, spread_text) = (teeth.to_string(), spread.to_string());
        let set = [("place", "0.3"), ("slide", "0"), ("teeth", &*count), ("spread", &*spread_text), ("fullness", "1")];
        for tooth in 0..teeth {
            let got = band(&joint_at(0.3, 1.0), tooth, &set);
            let place = spread * ((2 * tooth + 1) as f32 / teeth as f32 - 1.0);
            let expected = vec2([-20.0 * place, 0.0]);
            let off = got.offset - expected;
            prop_assert!(off.dot(off).0 < 1e-6, "{:?}, not {expected:?}", got.offset);
            prop_assert!((got.radius - spread * 20.0 / teeth as f32).abs() < 1e-3);
        }
    }

    /// However teeth and strands differ, the extent holds not many joints beyond the band; that it holds all of the band's is the testkit's to try.
    #[test]
    fn the_extent_is_no_wider_than_the_band_may_be(strand in 0..500_u32, place in -0.3..0.4_f32) {
        let heights: Vec<f32> = (0..60).map(|i| 0.5 - 0.02 * i as f32).collect();
        let count = heights.len();
        let one = joint_at(0.0, 1.0);
        let joints = Joints {
            rest_position: heights.iter().map(|h| vec3([0.0, *h, 0.3])).collect(),
            arc_length: vec![1.0; count],
            head_height: vec![HEAD_M; count],
            light_direction: vec![one.light_direction[0]; count],
            view_direction: vec![one.view_direction[0]; count],
            seed: vec![hash(strand); count],
            ..Joints::default()
        };
        let place_text = place.to_string();
        let params = One::<Band>::params(&[("place", &place_text), ("slide", "0.1")]);
        let seed = hash(1 ^ hash(strand));
        let extent = Band::extent(&params, &StrandJoints { joints: &joints, range: 0..count, instance: 0, seed });
        let thickness = extent.len() as f32 * 0.02;
        prop_assert!(thickness < 0.12 * 1.5 + 0.03 + 0.2 * (0.5 + place.abs()) + 0.05, "{thickness}");
        prop_assert!(random(seed, 0) < params.strand_share || extent.is_empty());
    }
}
