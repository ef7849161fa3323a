//! The clump of a joint: sizes by 5.1 to 5.3, the normal of 5.4, colours.

use effects::wgsl::{Clump, hash, vec3};
use effects::{Joints, Parameters, Values, Varied, clump};
use proptest::prelude::*;

fn joint(position: [f32; 3], backward: [f32; 3], u: f32) -> Joints {
    Joints {
        position: vec![vec3(position)],
        forward: vec![vec3(backward.map(|x| -x))],
        backward: vec![vec3(backward)],
        // Across the strand.
        view_direction: vec![vec3([backward[1], -backward[0], 0.0])],
        u: vec![u],
        seed: vec![hash(3)],
        strand_mean: vec![vec3([0.0; 3])],
        head_center: vec![vec3([0.0; 3])],
        head_height: vec![2.0],
        strand_size: vec![20.0],
        light_direction: vec![vec3([0.0, 1.0, 0.0])],
        ..Joints::default()
    }
}

const NOTHING: Clump = Clump {
    normal: vec3([0.0; 3]),
    radius: 0.0,
    color: vec3([0.0; 3]),
    shift: vec3([0.0; 3]),
};

/// The clump with these parameters set, no variation unless they say so.
fn clump_with(joints: &Joints, set: &[(&str, &str)]) -> Clump {
    let mut values = Values::defaults(clump::Program::PARAMS);
    for (name, text) in [("size_variation", "0"), ("mix_variation", "0")]
        .iter()
        .chain(set)
    {
        values.set_text("clump", name, text).unwrap();
    }
    let mut clumps = [NOTHING];
    Varied::<clump::Program>::new(&values).clumps(joints, 0, 1, &mut clumps);
    clumps[0]
}

#[test]
fn sizes_mix_both_functions() {
    let at = |u: f32, mix: &str| {
        let set = [("mix", mix), ("shrink_start", "0.5"), ("swell_offset", "0")];
        clump_with(&joint([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], u), &set).radius
    };
    assert_eq!(
        at(0.75, "1"),
        10.0,
        "5.1 alone: half way from its start to the tip"
    );
    assert!(
        (at(0.5, "0") - 20.0).abs() < 1e-4,
        "5.2 alone: the sine's top"
    );
    let half = 20.0 * std::f32::consts::FRAC_1_SQRT_2;
    assert!((at(0.75, "0.5") - 0.5 * (10.0 + half)).abs() < 1e-4, "5.3");
    assert_eq!(at(1.0, "0.5"), 0.0);
}

#[test]
fn a_hard_step_is_legal() {
    let set = [("mix", "1"), ("shrink_start", "1")];
    let clump = clump_with(&joint([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], 1.0), &set);
    assert_eq!(clump.radius, 20.0, "x = num never shrinks");
}

#[test]
fn sizes_vary_by_strand_and_stay_in_their_range() {
    let radius = |strand: u32| {
        let mut joints = joint([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], 0.0);
        joints.seed = vec![hash(strand)];
        let set = [("size_variation", "0.3"), ("mix", "1")];
        clump_with(&joints, &set).radius
    };
    let radii: Vec<f32> = (0..100).map(radius).collect();
    assert!(radii.iter().all(|r| (14.0..=26.0).contains(r)));
    let mean = radii.iter().sum::<f32>() / 100.0;
    assert!((18.5..21.5).contains(&mean), "{mean}");
    assert!(radii.iter().any(|r| *r < 16.0) && radii.iter().any(|r| *r > 24.0));
    assert_eq!(radius(5), radius(5));
}

#[test]
fn diffuse_light_falls_from_above() {
    let set = [
        ("shading", "diffuse"),
        ("ambient", "0.25"),
        ("color", "FFFFFF"),
    ];
    let top = clump_with(&joint([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], 0.0), &set);
    assert!((top.color.x - 1.0).abs() < 1e-6);
    let below = clump_with(&joint([0.0, -1.0, 0.0], [1.0, 0.0, 0.0], 0.0), &set);
    assert!((below.color.x - 0.25).abs() < 1e-6);
    let pure = clump_with(
        &joint([0.0, -1.0, 0.0], [1.0, 0.0, 0.0], 0.0),
        &[("color", "FFFFFF")],
    );
    assert_eq!(pure.color.x, 1.0);
}

#[test]
fn where_the_strand_runs_outwards_the_normal_turns_steadily() {
    // Around the pole of 5.4, where O is parallel to B. (A field of perpendiculars must jump on some
    // way through the pole; this is any other way.)
    let normal = |angle: f32| {
        let backward = [0.0, -angle.cos(), angle.sin()];
        clump_with(&joint([0.0, 1.0, 0.0], backward, 0.0), &[]).normal
    };
    let steps: Vec<_> = (-200..=200).map(|i| normal(i as f32 * 1e-4)).collect();
    for pair in steps.windows(2) {
        assert!((pair[0] - pair[1]).length().0 < 0.1, "{pair:?}");
    }
    let pole = normal(0.0);
    assert!((pole.length().0 - 1.0).abs() < 1e-6);
    assert!(pole.y.abs() < 1e-6, "any perpendicular: {pole:?}");
}

#[test]
fn a_flat_clump_seen_along_the_strand_lies_inside_of_its_outer_end() {
    // Its normal is +y; the strand runs towards -x.
    let seen_from = |view: [f32; 3], flatness: &str| {
        let mut joints = joint([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], 0.5);
        joints.view_direction = vec![vec3(view)];
        clump_with(
            &joints,
            &[("flatness", flatness), ("mix", "1"), ("shrink_start", "1")],
        )
    };
    for (view, flatness) in [
        ([0.0, 0.0, 1.0], "1"),
        ([0.0, 1.0, 0.0], "1"),
        ([1.0, 0.0, 0.0], "0"),
    ] {
        let round = seen_from(view, flatness);
        assert_eq!(round.radius, 20.0, "{view:?}");
        assert_eq!(round.shift.length().0, 0.0, "{view:?}");
    }
    for side in [1.0, -1.0] {
        let flat = seen_from([side, 0.0, 0.0], "0.8");
        assert_eq!(flat.radius, 20.0);
        let outer_end = flat.shift.y + flat.radius;
        assert!(
            (outer_end - 0.2 * 20.0).abs() < 1e-4,
            "a fifth as thick: {outer_end}"
        );
    }
}

#[test]
fn clumps_far_from_the_head_are_round() {
    let shift = |away: f32| {
        let mut joints = joint([0.0, away, 0.0], [1.0, 0.0, 0.0], 0.5);
        joints.view_direction = vec![vec3([1.0, 0.0, 0.0])];
        clump_with(&joints, &[]).shift.length().0
    };
    // The head is 2 high.
    assert!(shift(1.0) > 5.0 && shift(1.0) == shift(1.2));
    assert!(shift(1.4) > 0.0 && shift(1.4) < shift(1.2));
    assert_eq!(shift(1.6), 0.0);
}

proptest! {
    #[test]
    fn full_correction_is_exactly_across(
        position in prop::array::uniform3(-1.0f32..1.0),
        backward in prop::array::uniform3(-1.0f32..1.0),
    ) {
        let length = backward.iter().map(|x| x * x).sum::<f32>().sqrt();
        prop_assume!(length > 0.1);
        let backward = backward.map(|x| x / length);
        let clump = clump_with(&joint(position, backward, 0.3), &[]);
        prop_assert!((clump.normal.length().0 - 1.0).abs() < 1e-5);
        prop_assert!(clump.normal.dot(vec3(backward)).0.abs() < 1e-4);
    }

    #[test]
    fn nothing_is_ever_not_finite(
        position in prop::array::uniform3(-1e4f32..1e4),
        u in 0.0f32..=1.0,
        start in 0.0f32..=1.0,
        offset in 0.0f32..=1.0,
        mix in 0.0f32..=1.0,
    ) {
        let set = [
            ("shrink_start", start.to_string()),
            ("swell_offset", offset.to_string()),
            ("mix", mix.to_string()),
        ];
        let set: Vec<(&str, &str)> = set.iter().map(|(n, v)| (*n, v.as_str())).collect();
        let clump = clump_with(&joint(position, [0.0, 1.0, 0.0], u), &set);
        prop_assert!(clump.radius.is_finite() && clump.radius >= 0.0);
        prop_assert!(clump.normal.to_array().iter().all(|x| x.is_finite()));
    }
}

#[test]
fn clumps_of_a_block_are_those_of_each_joint() {
    const JOINTS: usize = 2 * effects::LANES + 3;
    let u = |i: usize| i as f32 / (JOINTS - 1) as f32;
    let all = JOINTS;
    let lists = Joints {
        position: (0..all)
            .map(|i| vec3([0.3 * u(i), 1.0 - u(i), 0.1]))
            .collect(),
        forward: vec![vec3([0.0, -1.0, 0.0]); all],
        backward: vec![vec3([0.0, 1.0, 0.0]); all],
        view_direction: vec![vec3([0.6, 0.8, 0.0]); all],
        u: (0..all).map(u).collect(),
        seed: (0..all).map(|i| hash(i as u32 / 10)).collect(),
        strand_mean: vec![vec3([0.0; 3]); all],
        head_center: vec![vec3([0.0; 3]); all],
        head_height: vec![2.0; all],
        strand_size: vec![20.0; all],
        light_direction: vec![vec3([0.0, 1.0, 0.0]); all],
        ..Joints::default()
    };
    for size in ["1.2", "(curve: [(0, 1), (0.7, 2), (1, 0.5)], vary: 0.5)"] {
        let mut values = Values::defaults(clump::Program::PARAMS);
        values.set_text("clump", "size", size).unwrap();
        values.set_text("clump", "size_variation", "0.4").unwrap();
        let program = Varied::<clump::Program>::new(&values);
        let mut clumps = vec![NOTHING; all];
        program.clumps(&lists, 0, 1, &mut clumps);
        for (i, clump) in clumps.iter().enumerate() {
            let mut alone = [NOTHING];
            program.clumps(&lists, i, 1, &mut alone);
            assert_eq!(*clump, alone[0], "size {size}, joint {i}");
        }
        assert!(clumps[3].radius != clumps[13].radius);
    }
}
