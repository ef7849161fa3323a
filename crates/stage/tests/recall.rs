//! Hair that is recalled from where it lies far from its style: `recall` of `dynamics`.

#![allow(
    clippy::print_stdout,
    reason = "a test shows the figures that it holds"
)]

use effects::Registry;
use glam::Vec3;
use stage::{Files, Motion, Preset, Scene};
use std::fs;
use std::path::{Path, PathBuf};

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

/// A look's hair as a script moves it.
struct Moved {
    scene: Scene,
    motion: Motion,
}

impl Moved {
    /// As the look has it itself but for some settings.
    fn new(look: &str, script: &Path, settings: &[(&str, &str)]) -> Self {
        let mut registry = Registry::new();
        effects_builtin::register(&mut registry).unwrap();
        effects_cartoon::register(&mut registry).unwrap();
        effects_surface::register(&mut registry).unwrap();
        let text = fs::read_to_string(presets().join(format!("{look}.ron"))).unwrap();
        let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
        for (name, value) in settings {
            preset.set(name, value).unwrap();
        }
        let files = Files {
            preset_folder: presets(),
            motion: Some(script.to_owned()),
            ..Files::default()
        };
        Self {
            scene: Scene::load(&preset, &files).unwrap(),
            motion: Motion::new(),
        }
    }

    fn points_at(&mut self, time_s: f32) -> Vec<Vec3> {
        self.motion.advance_to(&self.scene, time_s).unwrap();
        self.motion.points(&self.scene, 0).to_vec()
    }

    /// How far hair is at most from where it was styled at some times, in head heights.
    fn left_at<const N: usize>(&mut self, times_s: [f32; N]) -> [f32; N] {
        let rest = self.points_at(0.0);
        let height_m = self.scene.head().height_m;
        times_s.map(|time_s| farthest(&self.points_at(time_s), &rest) / height_m)
    }
}

fn farthest(a: &[Vec3], b: &[Vec3]) -> f32 {
    let apart = a.iter().zip(b).map(|(a, b)| a.distance(*b));
    apart.fold(0.0, f32::max)
}

/// A script in `folder` by which the head turns so far, in degrees, and back until 1.3 s.
fn there_and_back(folder: &Path, angle: i32) -> PathBuf {
    let path = folder.join(format!("{angle}.motion.ron"));
    let script = format!(
        "(version: 1, moves: [(move: turn, start: 0.1, length: 0.4, angle: {angle}), (move: turn, start: 0.9, length: 0.4, angle: {})])",
        -angle
    );
    fs::write(&path, script).unwrap();
    path
}

/// Hair that a quick turn has thrown over a shoulder stays there, unless it is recalled: then it is back on its own side a second after the head is.
#[test]
fn hair_that_is_thrown_over_a_shoulder_is_recalled() {
    let folder = tempfile::tempdir().unwrap();
    let turn = |angle| (there_and_back(folder.path(), angle), 1.3);
    let looks_back = presets().join("motions/head-turn.motion.ron");
    for (script, end_s) in [(looks_back, 3.1), turn(70), turn(-70), turn(90)] {
        // A second after the head is back, and once all is at rest: not recalled, as much as the look has itself, and by more.
        let times_s = [end_s + 1.0, end_s + 8.0];
        let with = |recall: &[(&str, &str)]| {
            let settings = [&[("scene.fps", "24")], recall].concat();
            Moved::new("long-pink", &script, &settings).left_at(times_s)
        };
        let free = with(&[("dynamics.recall", "0")]);
        let recalled = [with(&[]), with(&[("dynamics.recall", "4")])];
        println!(
            "{}: {free:.2?} head heights from where it was styled after 1 and 8 s; recalled {recalled:.2?}",
            script.display()
        );
        assert!(free[1] > 0.5, "{free:?}");
        for [soon, later] in recalled {
            assert!(soon < 0.2 && later < 0.01, "{recalled:?}");
        }
    }
}

/// Whether to try what takes minutes, too.
fn wants_all() -> bool {
    std::env::var("INKSTRAND_RECALL").is_ok_and(|wanted| wanted == "all")
}

/// The names of the presets that recall hair.
fn looks_that_recall() -> Vec<String> {
    let files = fs::read_dir(presets()).unwrap();
    let paths = files.map(|file| file.unwrap().path());
    let recalls = |path: &PathBuf| {
        let is_preset = path.extension().is_some_and(|ending| ending == "ron");
        is_preset && fs::read_to_string(path).unwrap().contains("recall: ")
    };
    let name = |path: PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
    let mut looks: Vec<String> = paths.filter(recalls).map(name).collect();
    looks.sort();
    assert!(looks.len() >= 7, "{looks:?}");
    looks
}

/// No look that recalls its hair leaves any of it on a shoulder for good, whatever the rate of frames, and also where locks keep out of each other: what is
/// recalled passes through them. Each look turns in all ways, at one rate each; with `INKSTRAND_RECALL=all` at all.
#[test]
fn all_looks_that_recall_get_their_hair_back() {
    let folder = tempfile::tempdir().unwrap();
    let looks = looks_that_recall();
    let turn = |angle: i32| (there_and_back(folder.path(), angle), 1.3);
    let looks_over = presets().join("motions/turn.motion.ron");
    let scripts = [turn(70), turn(-70), turn(90), turn(-90), (looks_over, 2.2)];
    for (i, (script, end_s)) in scripts.iter().enumerate() {
        let name = script.file_name().unwrap().to_str().unwrap();
        for (j, look) in looks.iter().enumerate() {
            let ways = [("24", "0"), ("60", "0"), ("60", "1")];
            for (way, (fps, locks)) in ways.into_iter().enumerate() {
                if way != (i + j) % 3 && !wants_all() {
                    continue;
                }
                let settings = [("scene.fps", fps), ("dynamics.locks", locks)];
                let mut moved = Moved::new(look, script, &settings);
                let [soon, later] = moved.left_at([end_s + 1.0, end_s + 8.0]);
                let what = format!("{look}, {name}, {fps} frames a second, locks: {locks}");
                println!("{what}: {soon:.2} and {later:.2} head heights after 1 and 8 s");
                assert!(later < 0.05, "{what}: {later}");
            }
        }
    }
}

/// What is recalled leaves a shoulder fast enough to get over it: held to 1.5 m/s these left a lock for good.
#[test]
fn what_is_recalled_gets_over_a_shoulder() {
    let folder = tempfile::tempdir().unwrap();
    let script = there_and_back(folder.path(), 93);
    for look in ["blond-fantasy", "xtoon-depth"] {
        let settings = [("scene.fps", "60"), ("dynamics.locks", "1")];
        let [later] = Moved::new(look, &script, &settings).left_at([9.3]);
        println!("{look}: {later:.2} head heights from its style after 8 s");
        assert!(later < 0.05, "{look}: {later}");
    }
}

/// What passed through locks on the way to a later moment changes nothing of an earlier one.
#[test]
fn a_recalled_moment_is_the_same_however_it_is_reached() {
    let folder = tempfile::tempdir().unwrap();
    let script = there_and_back(folder.path(), 90);
    let settings = [("scene.fps", "60"), ("dynamics.locks", "1")];
    let moved = || Moved::new("long-pink", &script, &settings);
    let (mut straight, mut back) = (moved(), moved());
    let later = back.points_at(1.4);
    assert!(back.points_at(0.6) == straight.points_at(0.6));
    assert!(later == straight.points_at(1.4));
}

/// A script in `folder` by which the head turns so far, in degrees, until 0.5 s, and stays there.
fn held(folder: &Path, angle: i32) -> PathBuf {
    let path = folder.join(format!("held{angle}.motion.ron"));
    let script =
        format!("(version: 1, moves: [(move: turn, start: 0.1, length: 0.4, angle: {angle})])");
    fs::write(&path, script).unwrap();
    path
}

/// How far a point goes at most in a frame of the second before `second`, in m.
fn trembles_m(moved: &mut Moved, fps: u16, second: u16) -> f32 {
    let at = |frame: u16| moved.points_at(f32::from(frame) / f32::from(fps));
    let frames: Vec<_> = ((second - 1) * fps..=second * fps).map(at).collect();
    let steps = frames.windows(2).map(|pair| farthest(&pair[0], &pair[1]));
    steps.fold(0.0, f32::max)
}

/// What rests goes no farther than this in a frame, in m.
const RESTS_M: f32 = 1e-4;

/// Whether it sleeps in second 40: what does keeps its bits.
fn sleeps(moved: &mut Moved) -> bool {
    moved.points_at(39.5) == moved.points_at(40.0)
}

/// Where the head stays turned, a shoulder lies between hair and its place for good: what is recalled gives up and comes to rest there, by whatever it is
/// pulled.
#[test]
fn what_is_recalled_does_not_tremble() {
    let folder = tempfile::tempdir().unwrap();
    for recall in ["2", "3", "4", "6", "8"] {
        for (angle, second) in [(70, 10), (-70, 16), (90, 16), (-90, 16)] {
            let script = held(folder.path(), angle);
            let settings = [("scene.fps", "24"), ("dynamics.recall", recall)];
            let mut moved = Moved::new("long-pink", &script, &settings);
            let most_m = trembles_m(&mut moved, 24, second);
            println!(
                "{angle} degrees, recall {recall}: {:.2} mm a frame in second {second}",
                most_m * 1e3
            );
            assert!(
                most_m < RESTS_M,
                "{angle} degrees, recall {recall}: {most_m} m"
            );
            assert!(sleeps(&mut moved), "{angle} degrees, recall {recall}");
        }
    }
}

/// So it does in all looks that recall. Each turns one way at one rate and another way at the other; with `INKSTRAND_RECALL=all` all ways at both.
#[test]
fn all_looks_that_recall_rest_on_a_head_that_stays_turned() {
    let folder = tempfile::tempdir().unwrap();
    let angles = [70, -90, 90, -70];
    for (i, look) in looks_that_recall().iter().enumerate() {
        let some = [(angles[i % 4], 24), (angles[(i + 1) % 4], 60)];
        let all = angles
            .into_iter()
            .flat_map(|angle| [(angle, 24), (angle, 60)]);
        for (angle, fps) in all.filter(|turn| wants_all() || some.contains(turn)) {
            let script = held(folder.path(), angle);
            let mut moved = Moved::new(look, &script, &[("scene.fps", &fps.to_string())]);
            let most_m = trembles_m(&mut moved, fps, 16);
            let what = format!("{look}, {angle} degrees, {fps} frames a second");
            println!("{what}: {:.2} mm a frame in second 16", most_m * 1e3);
            assert!(most_m < RESTS_M, "{what}: {most_m} m");
            assert!(sleeps(&mut moved), "{what}");
        }
    }
}

/// Hair that streams in a gust lies far from its style, too, and yet is not held there: recalled or not, it goes the same way.
#[test]
fn what_streams_in_a_wind_is_hardly_recalled() {
    let gust = presets().join("motions/gust.motion.ron");
    let mut height_m = 0.0;
    let [free, recalled] = ["0", "4"].map(|recall| {
        let settings = [("scene.fps", "24"), ("dynamics.recall", recall)];
        let mut moved = Moved::new("long-pink", &gust, &settings);
        height_m = moved.scene.head().height_m;
        [0.0, 1.0, 1.3, 2.0].map(|time_s| moved.points_at(time_s))
    });
    let mean = |a: &[Vec3], b: &[Vec3]| {
        let apart = a.iter().zip(b).map(|(a, b)| a.distance(*b));
        apart.sum::<f32>() / (a.len() as f32 * height_m)
    };
    for i in 1..4 {
        let streams = mean(&free[i], &free[0]);
        let apart = mean(&free[i], &recalled[i]);
        println!(
            "{streams:.3} head heights from the style on average; recalled hair {apart:.3} from there"
        );
        assert!(i == 3 || apart < 0.2 * streams, "{apart} of {streams}");
    }
}
