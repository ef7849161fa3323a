use super::*;
use proptest::prelude::*;

const SPLINE: PathKind = PathKind::CatmullRom { subdivision: 5 };

/// A strand of 60 particles, by a function of the way along it from 0 to 1.
fn strand(at: impl Fn(f32) -> Vec3) -> Vec<Vec3> {
    (0..60).map(|i| at(i as f32 / 59.0)).collect()
}

/// Hair that winds around an upright line at a constant angle (degrees) to it, three times.
fn winding(angle: f32) -> Vec<Vec3> {
    let pitch = std::f32::consts::TAU / angle.to_radians().tan();
    strand(|t| {
        let (sin, cos) = (3.0 * std::f32::consts::TAU * t).sin_cos();
        0.02 * Vec3::new(cos, -3.0 * pitch * t, sin)
    })
}

/// Hair that turns in a plane by so many degrees in all.
fn bent(degrees: f32) -> Vec<Vec3> {
    strand(|t| {
        let (sin, cos) = (degrees.to_radians() * t).sin_cos();
        0.05 * Vec3::new(sin, cos, 0.0)
    })
}

fn count(strand: &[Vec3]) -> usize {
    cuts(strand, SPLINE, 0.01).unwrap().len()
}

#[test]
fn straight_and_wavy_hair_and_arches_stay_whole() {
    let straight = strand(|t| Vec3::new(0.1 * t, -t, 0.0));
    // Steepest 50 degrees off its way, and flat.
    let wave = strand(|t| {
        let height = 50_f32.to_radians().tan() / 25.0;
        Vec3::new(height * (25.0 * t).sin(), -t, 0.0)
    });
    for whole in [straight, wave, winding(50.0), bent(100.0), bent(200.0)] {
        assert_eq!(count(&whole), 0);
    }
}

#[test]
fn ringlets_and_loops_are_cut() {
    assert!(count(&bent(360.0)) >= 2);
    assert!(count(&bent(720.0)) >= 5);
    // Each turn at least twice.
    assert!(count(&winding(75.0)) >= 6);
    assert!(count(&winding(89.0)) >= 6);
}

/// Were all directions kept, this would take minutes.
#[test]
fn long_strands_take_no_longer_than_their_length() {
    let zigzag =
        (0..300_000).map(|i| Vec3::new(0.1 * (i % 7) as f32, -(i as f32), 0.1 * (i % 5) as f32));
    assert_eq!(count(&zigzag.collect::<Vec<_>>()), 0);
}

#[test]
fn what_has_no_shape_stays_whole() {
    for points in [
        vec![],
        vec![Vec3::ONE],
        vec![Vec3::ONE; 9],
        vec![Vec3::NAN; 9],
    ] {
        assert_eq!(count(&points), 0);
    }
    let bad = PathKind::Linear { subdivision: 0 };
    assert_eq!(cuts(&[], bad, 0.01), Err(PathError::Subdivision(0)));
}

proptest! {
    #[test]
    fn pieces_advance_and_overlap(
        turns in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f32), 3..40),
        overlap_m in 0.0..0.5_f32,
    ) {
        let mut particles = vec![Vec3::ZERO];
        for turn in turns {
            let last = particles[particles.len() - 1];
            particles.push(last + 0.1 * Vec3::from(turn));
        }
        let kind = PathKind::Linear { subdivision: 2 };
        let joints: Vec<Vec3> = kind.joints(&particles).unwrap().collect();
        let found = cuts(&particles, kind, overlap_m).unwrap();
        prop_assert!(found.len() != 1);
        let last = joints.len() - 1;
        let length = |from: usize, to: usize| -> f32 {
            joints[from..=to].windows(2).map(|link| link[0].distance(link[1])).sum()
        };
        for (i, cut) in found.iter().enumerate() {
            let low = if i > 0 { found[i - 1].at } else { 0 };
            let high = found.get(i + 1).map_or(last, |next| next.at);
            let (start, end) = (*cut.overlap.start(), *cut.overlap.end());
            prop_assert!(low < cut.at && cut.at < high);
            prop_assert!(low <= start && start <= cut.at && cut.at <= end && end <= high);
            prop_assert!(start == low || length(start, cut.at) >= 0.999 * overlap_m);
            prop_assert!(end == high || length(cut.at, end) >= 0.999 * overlap_m);
        }
        // Before the first cut, between two, and after the last no two directions are too far apart.
        if !found.is_empty() {
            let mut ends: Vec<usize> = found.iter().map(|cut| cut.at).collect();
            ends.push(last);
            let mut start = 0;
            for end in ends {
                let links = joints[start..=end].windows(2);
                let links = links.filter_map(|link| (link[1] - link[0]).try_normalize());
                let directions: Vec<Vec3> = links.collect();
                for a in &directions {
                    prop_assert!(directions.iter().all(|b| a.dot(*b) >= -0.5001));
                }
                start = end;
            }
        }
    }
}
