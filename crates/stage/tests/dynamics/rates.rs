//! How often hair is simulated: off screen, where it is small, at different frame rates, and once it rests.

use super::*;

/// Hair off screen is simulated a quarter as often, and comes back where it should be and as fast as it should.
#[test]
fn hair_off_screen_runs_at_a_lower_rate_and_does_not_pop() {
    let script = "(version: 1, moves: [(move: turn, start: 0.1, length: 0.3, angle: 60), \
                  (move: turn, start: 2.0, length: 0.3, angle: -60)], winds: [(speed: 3, gusts: 2, yaw: 90)])";
    let step = [("dynamics.step", "0.041666668")];
    let [mut full, mut live] = [0; 2].map(|_| scene("twin-tails.style.ron", Some(script), &step));
    let head = full.head();
    let view = |target| OrbitView {
        target,
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: 2.0,
        vertical_fov_degrees: 40.0,
    };
    // Near enough for its motion to be seen.
    let camera = |target| Camera::orbit(view(target), [640, 640], full.near_m()).unwrap();
    let (at_it, elsewhere) = (camera(head.center), camera(head.center + 50.0 * Vec3::X));
    let away = 14..37;
    let mut before: Option<[Vec<Vec3>; 2]> = None;
    let (mut fastest, mut fastest_live): (f32, f32) = (0.0, 0.0);
    let (mut most, mut farthest_off): (f32, f32) = (0.0, 0.0);
    for frame in 0..60 {
        let is_away = away.contains(&frame);
        let time = frame as f32 / 24.0;
        let taken = live.steps_taken();
        let seen_by = if is_away { &elsewhere } else { &at_it };
        live.advance_to_seen_by(time, seen_by).unwrap();
        full.advance_to(time).unwrap();
        let taken = live.steps_taken() - taken;
        let expected = if is_away {
            u64::from((frame - away.start) % 4 == 3)
        } else {
            u64::from(frame > 0)
        };
        // The first frame back has what is missing and its own.
        let expected = if frame == away.end { 2 } else { expected };
        assert_eq!(taken, expected, "frame {frame}");
        let now = [&mut full, &mut live].map(|stage| {
            let frame = stage.frame().unwrap();
            frame
                .strands
                .iter()
                .map(|strand| strand.mean)
                .collect::<Vec<Vec3>>()
        });
        if frame < away.start {
            assert!(now[0] == now[1], "frame {frame}");
        }
        if let Some([full, live]) = before.filter(|_| frame > away.end) {
            fastest = fastest.max(nine_of_ten(&full, &now[0])[0]);
            fastest_live = fastest_live.max(nine_of_ten(&live, &now[1])[0]);
        }
        if frame >= away.end {
            let [nine, all] = nine_of_ten(&now[0], &now[1]);
            most = most.max(nine / head.height_m);
            farthest_off = farthest_off.max(all / head.height_m);
        }
        before = Some(now);
    }
    let speed = fastest_live / fastest;
    println!(
        "back: of ten strands nine within {most:.3} head heights of a full rate, all within {farthest_off:.3}; \
         nine move {speed:.2} times as fast"
    );
    assert!(most < 0.1 && farthest_off < 0.6, "{most} {farthest_off}");
    assert!(speed < 1.3, "{speed}");
}

/// Hair that is small in the picture is simulated half as often while its head is calm, no pixel tells, and it comes nearer without a jump. What is made
/// for sequences knows nothing of it.
#[test]
fn hair_that_is_seen_small_runs_at_a_lower_rate_and_does_not_pop() {
    let script = "(version: 1, moves: [(move: turn, start: 0.1, length: 0.3, angle: 60)], \
                  winds: [(speed: 3, gusts: 2, yaw: 90)])";
    let step = [("dynamics.step", "0.041666668")];
    let [mut full, mut live] = [0; 2].map(|_| scene("twin-tails.style.ron", Some(script), &step));
    let head = full.head();
    let camera = |size_px: u32| {
        let view = OrbitView {
            target: head.center,
            yaw_degrees: 0.0,
            pitch_degrees: 0.0,
            distance_m: 2.0,
            vertical_fov_degrees: 40.0,
        };
        Camera::orbit(view, [size_px; 2], full.near_m()).unwrap()
    };
    // 24 and 106 pixels from chin to crown.
    let (small, near) = (camera(145), camera(640));
    let comes_near = 48;
    let (mut steps, mut farthest_px, mut jump): (u64, f32, f32) = (0, 0.0, 0.0);
    for frame in 0..72 {
        let time = frame as f32 / 24.0;
        let seen_by = if frame < comes_near { &small } else { &near };
        let taken = live.steps_taken();
        live.advance_to_seen_by(time, seen_by).unwrap();
        full.advance_to(time).unwrap();
        let [whole, now] = [&mut full, &mut live].map(|stage| {
            let frame = stage.frame().unwrap();
            let means = frame.strands.iter().map(|strand| strand.mean);
            means.collect::<Vec<Vec3>>()
        });
        let [nine, _] = nine_of_ten(&whole, &now);
        if frame < comes_near {
            steps += live.steps_taken() - taken;
            farthest_px = farthest_px.max(nine * small.px_per_metre(2.0));
        } else {
            jump = jump.max(nine / head.height_m);
        }
    }
    println!(
        "seen small: {steps} steps in {comes_near} frames, nine of ten strands within {farthest_px:.2} pixels; then within {jump:.3} head heights"
    );
    assert!(steps <= 32, "{steps}");
    assert!(farthest_px < 2.0 && jump < 0.1, "{farthest_px} {jump}");
}

/// Few frames a second show the same motion as many: where a frame is too long for hair, it takes some steps in it.
#[test]
fn the_rate_of_frames_does_not_show() {
    let style = "twin-tails.style.ron";
    let at = |rate: &str, time: f32| {
        let mut stage = scene(style, Some(TURN), &[("scene.fps", rate)]);
        let shape = means(&mut stage, time);
        (shape, stage.steps_taken())
    };
    for time in [0.5, 1.0, 2.0] {
        let (wanted, steps) = at("24", time);
        assert_eq!(steps, (48.0 * time) as u64);
        for (rate, parts) in [("8", 6), ("12", 4)] {
            let (shape, taken) = at(rate, time);
            let frames = (time * rate.parse::<f32>().unwrap()) as u64;
            assert_eq!(taken, frames * parts, "{rate}");
            let apart = farthest(&shape, &wanted);
            println!("{rate} frames a second, {time} s: {apart:.1e} m from 24");
            assert!(apart < 1e-4, "{rate}, {time} s: {apart}");
        }
    }
    // Hair that swings long takes more of them than hair that doesn't.
    let settings = [
        ("dynamics.feel", "springy"),
        ("dynamics.damping", "0"),
        ("dynamics.hold", "0"),
        ("dynamics.drag", "0"),
    ];
    let mut free = scene(style, Some(TURN), &settings);
    means(&mut free, 1.0);
    println!("undamped: {} steps in 24 frames", free.steps_taken());
    assert!(free.steps_taken() > 48);
}

/// Once hair has come to rest nothing is simulated, with links and volume on.
#[test]
fn hair_that_has_come_to_rest_sleeps() {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let turn = folder.path().join("turn.motion.ron");
    fs::write(&turn, TURN).unwrap();
    let looks = "blond-fantasy curls flat-tails-black flat-tails-red long-pink low-tie manga-ink messy-bun outlined picture-book pixie shonen-spikes \
        short-ash side-braid twin-tails undercut windy-bob";
    let mut awake = Vec::new();
    for look in looks.split_whitespace() {
        let text = fs::read_to_string(presets().join(format!("{look}.ron"))).unwrap();
        let preset = Preset::parse("look.ron", &text, &registry).unwrap();
        let files = Files {
            preset_folder: presets(),
            motion: Some(turn.clone()),
            ..Files::default()
        };
        let mut stage = Stage::new(&preset, &files).unwrap();
        let asleep = (1..=40).find(|&second| {
            stage.advance_to(second as f32).unwrap();
            let stats = stage.simulated();
            stats.strands == 0 && stats.asleep > 0
        });
        println!("{look}: asleep after {asleep:?} s");
        if asleep.is_none_or(|second| second > 25) {
            awake.push(look);
        }
    }
    assert!(awake.is_empty(), "{awake:?}");
}
