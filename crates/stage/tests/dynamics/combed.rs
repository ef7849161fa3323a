//! Hair that something goes through slowly, or presses.

use super::*;

/// A rod that goes into the hair from behind, and down through it at a third of a metre a second: how far to her left of her middle, how far below it, and its
/// radius, in head heights.
fn rod(x: f32, y: f32, radius: f32) -> String {
    format!(
        "(version: 1, bodies: [(name: \"rod\", shape: capsule, at: ({x}, {y}, -0.4), to: ({x}, {y}, -1.2), radius: {radius})], body_keys: [\
         (body: \"rod\", time: 0.2, at: (0, 0, -1)), (body: \"rod\", time: 1.2), (body: \"rod\", time: 1.4), \
         (body: \"rod\", time: 3, at: (0, -1.4, 0)), (body: \"rod\", time: 3.3, at: (0, -1.4, 0))])"
    )
}

/// Locks that it pressed against head, shoulders and each other shot off at up to 14 m/s.
#[test]
fn what_a_slow_rod_goes_through_is_not_thrown() {
    for (look, places) in [
        (
            "long-pink",
            &[
                (-0.07, -0.6, 0.06),
                (0.0, -0.8, 0.06),
                (0.15, -0.8, 0.06),
                (-0.15, -0.8, 0.06),
            ][..],
        ),
        ("low-tie", &[(-0.15, -0.8, 0.02)]),
    ] {
        for &(x, y, radius) in places {
            let ways = ways(look, &rod(x, y, radius), &[], 60.0, 3.5);
            let fastest = 60.0 * ways.into_iter().fold(0.0, f32::max);
            println!("{look}, a rod at {x}, {y}, of radius {radius}: {fastest:.1} m/s at most");
            assert!(fastest > 0.3 && fastest < 4.0, "{look}: {fastest}");
        }
    }
}

/// An arm that is laid on her back at a quarter of a metre a second: how far below her head's middle, in head heights, and how far behind it its axis is in the end.
fn arm(y: f32, z: f32) -> String {
    format!(
        "(version: 1, bodies: [(name: \"arm\", shape: capsule, at: (-1.5, {y}, {z}), to: (1.5, {y}, {z}), radius: 0.16)], body_keys: [\
         (body: \"arm\", time: 0.1, at: (0, 0, -1.2)), (body: \"arm\", time: 1.1), (body: \"arm\", time: 1.4)])"
    )
}

/// What lies under it has hardly room: pushed out of arm and back in turns it came out at their sides, by up to 320 mm from a frame to the next, for more than 15 s.
#[test]
fn what_an_arm_presses_against_a_back_stays_there() {
    for (look, y, z) in [
        ("long-pink", -1.05, -0.45),
        ("long-pink", -0.8, -0.45),
        ("blond-fantasy", -1.05, -0.5),
    ] {
        for fps in [24.0, 60.0] {
            let ways = ways(look, &arm(y, z), &[], fps, 4.0);
            let speed = |ways: &[f32]| ways.iter().copied().fold(0.0, f32::max) * fps;
            let (as_it_comes, after) = ways.split_at((1.5 * fps) as usize);
            let [as_it_comes, after] = [as_it_comes, after].map(speed);
            println!(
                "{look}, an arm at {y}, {z}, {fps} frames a second: {as_it_comes:.1} m/s at most as it comes, {after:.1} after"
            );
            assert!(
                as_it_comes > 0.3 && as_it_comes < 3.0,
                "{look}, {fps}: {as_it_comes}"
            );
            assert!(after < 2.0, "{look}, {fps}: {after}");
        }
    }
}

/// A tip between an arm of hers and her side bounced from one to the other, and shot off at 7.6 m/s, in a look as it comes with inkstrand.
#[test]
fn what_is_between_an_arm_and_a_side_is_not_thrown() {
    for (fps, script, most) in [
        (
            120.0,
            "(version: 1, moves: [(move: turn, start: 0.2, length: 0.4, angle: 60)])",
            3.0,
        ),
        (
            24.0,
            "(version: 1, moves: [(move: turn, start: 0.2, length: 0.4, angle: 60), (move: turn, start: 1.2, length: 0.4, angle: -60)], \
             winds: [(start: 0.5, length: 1, speed: 6, gusts: 0, yaw: 0)])",
            2.5,
        ),
    ] {
        let ways = ways("blond-fantasy", script, &[], fps, 1.5);
        let fastest = fps * ways.into_iter().fold(0.0, f32::max);
        println!("{fps} frames a second: {fastest:.1} m/s at most");
        assert!(fastest > 1.0 && fastest < most, "{fps}: {fastest}");
    }
}
