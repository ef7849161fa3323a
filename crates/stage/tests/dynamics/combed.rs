//! Hair that something goes through slowly.

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

/// The fastest that a point of a look's hair gets as such a rod goes through it, in m/s, at 60 frames a second.
fn fastest(look: &str, rod: &str) -> f32 {
    const FPS: f32 = 60.0;
    let folder = tempfile::tempdir().unwrap();
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    let text = fs::read_to_string(presets().join(format!("{look}.ron"))).unwrap();
    let mut preset = Preset::parse(look, &text, &registry).unwrap();
    preset.set("scene.fps", "60").unwrap();
    let files = Files {
        preset_folder: presets(),
        motion: Some(written(folder.path(), "rod.motion.ron", rod)),
        ..Files::default()
    };
    let scene = Scene::load(&preset, &files).unwrap();
    let mut motion = Motion::new();
    let mut last: Vec<Vec3> = Vec::new();
    (0..=(3.5 * FPS) as u32).fold(0.0, |fastest, frame| {
        motion.advance_to(&scene, frame as f32 / FPS).unwrap();
        let now = motion.points(&scene, 0).to_vec();
        let ways = last.iter().zip(&now).map(|(a, b)| a.distance(*b) * FPS);
        let fastest = ways.fold(fastest, f32::max);
        last = now;
        fastest
    })
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
            let fastest = fastest(look, &rod(x, y, radius));
            println!("{look}, a rod at {x}, {y}, of radius {radius}: {fastest:.1} m/s at most");
            assert!(fastest > 0.3 && fastest < 4.0, "{look}: {fastest}");
        }
    }
}
