//! Strands that are cut into pieces.

use super::*;
use crate::cuts::cuts;

/// A strand that winds around an upright line, towards the eye on one side and away from it on the other.
fn ringlet() -> Vec<Vec3> {
    let at = |i: i32| {
        let (sin, cos) = (0.5 * i as f32).sin_cos();
        Vec3::new(0.3 * cos, 0.5 - 0.015 * i as f32, 0.3 * sin)
    };
    (0..40).map(at).collect()
}

fn pushed(strands: &[(usize, &[Cut])], near_m: f32) -> Paths {
    let mut paths = Paths::new();
    for (strand, cuts) in strands {
        let pushed = paths.push_pieces(*strand, &ringlet(), cuts, None, SPLINE, &camera(near_m));
        pushed.unwrap();
    }
    paths
}

/// All that is known of a joint but for its depth.
fn joint(paths: &Paths, i: usize) -> impl PartialEq + std::fmt::Debug {
    (
        (paths.position[i], paths.u[i], paths.arc_length[i]),
        (paths.forward[i], paths.backward[i], paths.center[i]),
        (paths.px_per_metre[i], paths.across[i]),
    )
}

/// The joints of runs, but those that the run before has too.
fn own(paths: &Paths) -> Vec<usize> {
    let own = |run: &PathRun| run.joints.clone().skip(run.overlap);
    paths.runs.iter().flat_map(own).collect()
}

/// That pieces are the whole, with what they share twice and deeper once.
fn check_pieces(pieces: &Paths, whole: &Paths) {
    check_invariants(pieces, 0.5);
    for run in &pieces.runs {
        for i in run.joints.clone().take(run.overlap) {
            assert_eq!(joint(pieces, i), joint(pieces, i - run.overlap));
        }
    }
    for i in 0..whole.len() {
        let same = (0..pieces.len()).filter(|&j| pieces.u[j] == whole.u[i]);
        let depths = same.map(|j| {
            assert_eq!(joint(pieces, j), joint(whole, i));
            pieces.depth[j]
        });
        let nearest = depths.fold(f32::INFINITY, f32::min);
        assert_eq!(nearest, whole.depth[i], "one piece is where the strand is");
    }
}

#[test]
fn pieces_are_the_strand_and_overlap() {
    let cuts = cuts(&ringlet(), SPLINE, 0.2).unwrap();
    assert!(cuts.len() > 4);
    let (whole, pieces) = (pushed(&[(3, &[])], 0.5), pushed(&[(3, &cuts)], 0.5));
    assert_eq!(pieces.runs.len(), cuts.len() + 1);
    check_pieces(&pieces, &whole);
    assert_eq!(own(&pieces).len(), whole.len());
    for (number, run) in pieces.runs.iter().enumerate() {
        assert_eq!((run.strand, run.piece), (3, 3 + number));
        let shared = number.checked_sub(1).map(|i| &cuts[i].overlap);
        assert_eq!(
            run.overlap,
            shared.map_or(0, |shared| shared.clone().count())
        );
        let before = number.checked_sub(1).map(|i| whole.arc_length[cuts[i].at]);
        let after = cuts.get(number).map(|cut| whole.arc_length[cut.at]);
        for i in run.joints.clone() {
            let arc = pieces.arc_length[i];
            let beyond = before
                .map_or(0.0, |from| from - arc)
                .max(after.map_or(0.0, |to| arc - to));
            let first = (0..whole.len())
                .find(|&j| whole.u[j] == pieces.u[i])
                .unwrap();
            assert_eq!(pieces.depth[i], whole.depth[first] + beyond.max(0.0));
        }
    }
}

#[test]
fn pieces_are_numbered_through() {
    let cuts = cuts(&ringlet(), SPLINE, 0.2).unwrap();
    let paths = pushed(&[(0, &[]), (1, &cuts), (2, &[]), (5, &cuts)], 0.5);
    let numbers: Vec<_> = paths
        .runs
        .iter()
        .map(|run| (run.strand, run.piece))
        .collect();
    let mut expected = vec![(0, 0)];
    expected.extend((0..=cuts.len()).map(|i| (1, 1 + i)));
    expected.push((2, 2 + cuts.len()));
    expected.extend((0..=cuts.len()).map(|i| (5, 5 + cuts.len() + i)));
    assert_eq!(numbers, expected);
    // Neighbours that are not cut have nothing in common.
    assert!(paths.runs.iter().filter(|run| run.overlap == 0).count() == 4);
}

#[test]
fn the_near_plane_cuts_pieces_as_it_cuts_the_strand() {
    let cuts = cuts(&ringlet(), SPLINE, 0.3).unwrap();
    for near_m in [1.71, 1.8, 1.9, 2.0, 2.1, 2.25, 2.29] {
        let (whole, pieces) = (pushed(&[(0, &[])], near_m), pushed(&[(0, &cuts)], near_m));
        assert!(whole.runs.len() > 1);
        check_pieces(&pieces, &whole);
    }
}

#[test]
fn cuts_of_another_strand_are_refused() {
    let cuts = cuts(&ringlet(), SPLINE, 0.2).unwrap();
    let mut paths = Paths::new();
    let pushed = paths.push_pieces(0, &ringlet()[..30], &cuts, None, SPLINE, &camera(0.5));
    assert_eq!(pushed, Err(PathError::Cut));
    assert!(paths.is_empty());
}
