//! `hair.fine`: paths across clumps, the same ones in every frame.

mod joint;

use effects::{Hair, HairStrand, Light, MadePaths, StrokeEffect};
use effects_builtin::Fine;
use glam::Vec3;
use joint::{One, lit_joint, stroke};
use proptest::prelude::*;

/// Strands that hang side by side from the top of a head at the origin, 20 mm apart.
fn hanging(count: usize) -> Vec<Vec<Vec3>> {
    let strand = |i: usize| {
        let x = 0.02 * i as f32;
        (0..9)
            .map(move |k| Vec3::new(x, 0.1 - 0.03 * k as f32, 0.1))
            .collect()
    };
    (0..count).map(strand).collect()
}

/// The paths that are made of strands (ids 0, 10, 20, ...) as they stand: parent, number and points.
fn made(
    rest: &[Vec<Vec3>],
    now: &[Vec<Vec3>],
    set: &[(&str, &str)],
    seed: u32,
) -> Vec<(usize, u32, Vec<Vec3>)> {
    let strands: Vec<HairStrand> = rest
        .iter()
        .zip(now)
        .zip(0..)
        .map(|((at_rest, particles), i)| HairStrand {
            id: 10 * i,
            particles,
            at_rest,
            size: 15.0,
            is_drawn: true,
        })
        .collect();
    let hair = Hair {
        strands: &strands,
        head_center: Vec3::ZERO,
        head_center_at_rest: Vec3::ZERO,
        head_height_m: 0.24,
        light: Light::Direction(Vec3::Z),
        eye: Vec3::Z,
    };
    let mut paths = MadePaths::default();
    Fine::make_paths(&One::<Fine>::params(set), &hair, seed, &mut paths);
    paths
        .iter()
        .map(|path| (path.strand, path.number, path.points.to_vec()))
        .collect()
}

#[test]
fn there_are_as_many_as_the_average_says() {
    let strands = hanging(400);
    for (per_strand, range) in [
        ("0", 0..=0),
        ("0.25", 70..=130),
        ("2.5", 960..=1040),
        ("8", 3200..=3200),
    ] {
        let number = made(&strands, &strands, &[("per_strand", per_strand)], 1).len();
        assert!(range.contains(&number), "{per_strand}: {number}");
    }
}

#[test]
fn they_move_as_the_hair_does() {
    let rest = hanging(30);
    let moved = Vec3::new(0.3, -0.2, 0.5);
    let now: Vec<Vec<Vec3>> = rest
        .iter()
        .map(|s| s.iter().map(|p| *p + moved).collect())
        .collect();
    let set = [("per_strand", "2"), ("lift", "0"), ("wave", "0")];
    let (before, after) = (made(&rest, &rest, &set, 1), made(&rest, &now, &set, 1));
    assert_eq!(before.len(), after.len());
    for (a, b) in before.iter().zip(&after) {
        assert_eq!((a.0, a.1), (b.0, b.1));
        // What is on top of the clumps turns with the way out of the head, by some millimetres.
        let far = a.2.iter().zip(&b.2).map(|(a, b)| (*a + moved).distance(*b));
        assert!(far.fold(0.0, f32::max) < 0.013);
    }
}

#[test]
fn choices_hang_on_seed_and_id() {
    let strands = hanging(30);
    let set = [("per_strand", "1")];
    let once = made(&strands, &strands, &set, 1);
    assert_eq!(once, made(&strands, &strands, &set, 1));
    assert_ne!(once, made(&strands, &strands, &set, 2));
    // Without the last strands, those far from them keep theirs.
    let fewer = made(&strands[..25], &strands[..25], &set, 1);
    let far = |paths: &[(usize, u32, Vec<Vec3>)]| -> Vec<_> {
        paths.iter().filter(|path| path.0 < 20).cloned().collect()
    };
    assert_eq!(far(&once), far(&fewer));
}

#[test]
fn they_cross_to_neighbours_and_stay_on_the_hair() {
    let strands = hanging(40);
    let set = [
        ("per_strand", "4"),
        ("wave", "0"),
        ("lift", "0"),
        ("neighbours", "2"),
    ];
    let paths = made(&strands, &strands, &set, 3);
    let (mut crossed, mut most) = (0, 0.0f32);
    for (strand, _, points) in &paths {
        let from_own = |p: &Vec3| (p.x - 0.02 * *strand as f32).abs();
        let widest = points.iter().map(from_own).fold(0.0, f32::max);
        crossed += usize::from(widest > 0.008);
        most = most.max(widest);
        for point in points {
            let off = point.z - 0.1;
            // On top of the clump of 12 mm, of which the spine is the middle.
            assert!((-1e-3..0.013).contains(&off), "{off}");
            assert!((0.1 - 0.26..=0.1 + 0.013).contains(&point.y));
        }
    }
    assert!(crossed > paths.len() / 2, "{crossed} of {}", paths.len());
    // At the ends of the row the second neighbour is 40 mm away.
    assert!(most < 0.041 + 0.013, "{most}");
}

#[test]
fn lines_are_points_at_their_ends() {
    let radius = |u: f32, taper: &str| {
        let mut joints = lit_joint(0.5, 20.0);
        joints.u = vec![u];
        let set = [("width", "2"), ("width_variation", "0"), ("taper", taper)];
        stroke::<Fine>(&joints, 0, 1, &set).radius
    };
    assert_eq!(
        [radius(0.0, "0.5"), radius(0.5, "0.5"), radius(1.0, "0.5")],
        [0.0, 1.0, 0.0]
    );
    assert_eq!(radius(0.125, "0.5"), 0.5);
    assert_eq!(
        [radius(0.0, "0"), radius(1.0, "0")],
        [1.0, 1.0],
        "a hard step is legal"
    );
}

proptest! {
    #[test]
    fn whatever_the_hair_paths_are_finite(
        shapes in prop::collection::vec(prop::collection::vec(prop::array::uniform3(-1e3f32..1e3), 1..6), 1..6),
        same in any::<bool>(),
        seed in any::<u32>(),
    ) {
        let strands: Vec<Vec<Vec3>> = shapes
            .into_iter()
            .map(|shape| shape.into_iter().map(|p| if same { Vec3::ZERO } else { p.into() }).collect())
            .collect();
        for (_, _, points) in made(&strands, &strands, &[("per_strand", "8")], seed) {
            prop_assert!(points.len() > 1 && points.iter().all(|p| p.is_finite()));
        }
    }
}
