//! Suite `skip`: what a scene doesn't need, and what it costs all the same. Each row is beside the whole that it is a part of: times of
//! both, taken in turns, and counts, which machines can't blur.

use crate::BenchError;
use crate::frame::{YARDSTICKS, preset, registry};
use crate::ratios::{COUNTS, Ratio, TIMES};
use crate::results::{self, Row};
use crate::targets::{Found, Limit, Target};
use crate::timing::{Effort, medians};
use effects::preset::LayerSpec;
use glam::Vec3;
use hair_sim::Strands;
use indicatif::ProgressBar;
use render::Drawing;
use render::cpu::{Evaluator, Rasterizer};
use stage::{Figure, Files, FrameMaker, HairModel, HeadModel, Look, Motion, Object, Preset, Scene};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Samples a pixel: what a live picture has.
const SAMPLES: u32 = 4;
/// The look that is measured.
const LOOK: &str = "twin-tails";
/// Heads of the crowd to each side.
const CROWD: i32 = 10;
/// How far the middles of the crowd's heads are from each other, metres.
const APART_M: f32 = 1.2;

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The project's folder, for its yardsticks.
    pub root: PathBuf,
    /// Where the files go.
    pub out: PathBuf,
    /// Fewer rounds.
    pub quick: bool,
    /// Threads.
    pub threads: usize,
}

/// All that was measured.
pub struct Measured {
    /// Two rows a case: `whole` and `part`.
    pub rows: Vec<Row>,
    /// What a part costs of its whole.
    pub ratios: Vec<Ratio>,
}

/// A part beside its whole.
struct Case {
    name: &'static str,
    /// What is left out, in words.
    says: &'static str,
    whole: Scene,
    part: Scene,
    /// What the part may take of the whole's time, and of the discs of its strokes.
    time: f64,
    discs: f64,
}

/// Measures all cases and writes `skip.csv`.
///
/// # Errors
///
/// When the preset cannot be read, nothing can be drawn, or a file cannot be written.
pub fn run(options: &Options, progress: &ProgressBar) -> Result<Measured, BenchError> {
    let cases = cases(&options.root)?;
    let effort = Effort {
        rounds: if options.quick { 3 } else { 12 },
        each: Duration::from_secs(if options.quick { 1 } else { 10 }),
    };
    progress.set_length((cases.len() as u64 + 1) * effort.rounds as u64 * 2);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build();
    let pool = pool.map_err(|error| error.to_string())?;
    let mut measured = Measured {
        rows: Vec::new(),
        ratios: Vec::new(),
    };
    pool.install(|| -> Result<(), BenchError> {
        for case in &cases {
            progress.set_message(case.name);
            measure(case, effort, &mut measured, progress)?;
        }
        progress.set_message("unchanged");
        unchanged(&cases[0].whole, effort, &mut measured, progress)
    })?;
    let comments = [
        format!(
            "parts of whole frames, {SAMPLES} samples a pixel, the camera moving, medians of runs that take turns"
        ),
        "method: the whole, or what is left of it; knob: discs of its strokes".to_owned(),
    ];
    let comments = [&comments[..], &results::machine(options.threads, &[])].concat();
    results::save(
        &options.out,
        "skip.csv",
        &results::csv("skip", &comments, &measured.rows),
    )?;
    Ok(measured)
}

/// All but what doesn't change.
fn cases(root: &Path) -> Result<Vec<Case>, BenchError> {
    let registry = registry()?;
    let path = root.join(YARDSTICKS).join(LOOK).with_extension("ron");
    let read = || preset(&path, &registry);
    let all = read()?;
    let whole = load(&all, root)?;
    let mut cases = Vec::new();
    for (name, effect, param) in [
        ("dead-cel", "hair.cel", "fullness"),
        ("dead-highlight", "hair.highlight", "strand_share"),
    ] {
        let of_effect = |layer: &LayerSpec| layer.effect.id() == effect;
        let mut without = read()?;
        without.layers.retain(|layer| !of_effect(layer));
        let mut dead = read()?;
        let layer = dead.layers.iter_mut().find(|layer| of_effect(layer));
        let layer = layer.ok_or_else(|| format!("{LOOK} has no layer of {effect}"))?;
        layer.set(param, "0").map_err(|error| error.to_string())?;
        cases.push(Case {
            name,
            says: "an effect none of whose strokes has a size, of a preset without it",
            whole: load(&without, root)?,
            part: load(&dead, root)?,
            time: 1.05,
            discs: 1.0,
        });
    }
    let seen_by = |scene: &Scene, change: &dyn Fn(&mut Scene)| {
        let mut scene = scene.clone();
        change(&mut scene);
        scene
    };
    cases.push(Case {
        name: "off-screen",
        says: "hair and head off the picture",
        part: seen_by(&whole, &|scene| scene.camera.target[0] += 12.0),
        whole: whole.clone(),
        time: 0.02,
        discs: 0.02,
    });
    cases.push(Case {
        name: "half-off-screen",
        says: "one tail of two in the picture, from near",
        part: seen_by(&whole, &|scene| {
            scene.camera.target[0] += 0.6;
            scene.camera.distance *= 0.5;
        }),
        whole: whole.clone(),
        time: 1.25, // it fills more of the picture
        discs: 0.75,
    });
    let behind = back_of_a_head(&all)?;
    cases.push(Case {
        name: "behind-head",
        says: "hair at the back of a head seen from the front",
        whole: seen_by(&behind, &|scene| scene.camera.yaw = 180.0),
        part: seen_by(&behind, &|scene| scene.camera.yaw = 0.0),
        time: 0.5, // the head itself is drawn in both
        discs: 0.02,
    });
    cases.push(Case {
        name: "far",
        says: "a head that fills a tenth of the picture's height, of the look as it is",
        whole: whole.clone(),
        part: seen_by(&whole, &|scene| fill(scene, 0.1)),
        time: 0.1,
        discs: 1.1, // more of the hair is in the picture
    });
    let (crowd, seen) = crowd(&whole, &all)?;
    cases.push(Case {
        name: "crowd",
        says: "100 heads, of those of them that are seen",
        whole: seen,
        part: crowd,
        time: 1.1,
        discs: 1.001, // the camera's place is rounded otherwise
    });
    Ok(cases)
}

fn load(preset: &Preset, root: &Path) -> Result<Scene, BenchError> {
    let files = Files {
        preset_folder: root.join(YARDSTICKS),
        ..Files::default()
    };
    Scene::load(preset, &files).map_err(|error| error.to_string().into())
}

/// Puts the camera where a head fills this share of the picture's height.
fn fill(scene: &mut Scene, share: f32) {
    let half = (0.5 * scene.camera.fov).to_radians().tan();
    scene.camera.distance = 0.5 / (share * half);
}

/// Waves of the program's own that hang at the back of a head: straight strands would have few joints in a picture, and the head, which is drawn in
/// both, would be all that is measured.
fn back_of_a_head(preset: &Preset) -> Result<Scene, BenchError> {
    let hair =
        |roots: &mut dyn Iterator<Item = Vec3>, length_m: f32| -> Result<HairModel, BenchError> {
            let mut strands = Strands::new();
            for (id, root) in roots.enumerate() {
                let point = |i: usize| {
                    let wave = 0.04 * (2.0 * i as f32).sin() * Vec3::X;
                    root + length_m * (i as f32 / 11.0 * Vec3::NEG_Y + wave)
                };
                let points: Vec<Vec3> = (0..12).map(point).collect();
                let pushed = strands.push(id as u32, &points, Some(6.0));
                pushed.map_err(|error| error.to_string())?;
            }
            let figure = HeadModel::figure(&Figure::default());
            HairModel::new(strands, Some(&figure)).map_err(|error| error.to_string().into())
        };
    let look = Look::new(preset, &Files::default()).map_err(|error| error.to_string())?;
    let figure = HeadModel::figure(&Figure::default());
    let bald = Object::new(
        hair(&mut [Vec3::ZERO].into_iter(), 0.1)?,
        Some(figure),
        look,
    );
    let bald = bald.map_err(|error| error.to_string())?;
    let head = bald.head();
    let mut roots = (0..240).map(|i| {
        let (column, row) = (i % 24, i / 24);
        let place = Vec3::new(
            0.01 * (column as f32 - 11.5),
            0.15 - 0.01 * row as f32,
            -0.46,
        );
        head.center + head.height_m * place
    });
    let object = bald.with_hair(hair(&mut roots, 0.15 * head.height_m)?);
    let object = object.map_err(|error| error.to_string())?;
    let look = Look::new(preset, &Files::default()).map_err(|error| error.to_string())?;
    let mut scene = Scene::new(vec![object], look).map_err(|error| error.to_string())?;
    scene.camera.target = [0.0; 3];
    scene.camera.pitch = 0.0;
    Ok(scene)
}

/// A hundred heads in rows, and those of them that have anything in the picture.
fn crowd(scene: &Scene, preset: &Preset) -> Result<(Scene, Scene), BenchError> {
    let girl = &scene.objects()[0];
    let places = (0..CROWD * CROWD).map(|i| {
        let (row, column) = (i / CROWD, i % CROWD - CROWD / 2);
        Vec3::new(column as f32 * APART_M, 0.0, -row as f32 * APART_M)
    });
    let all: Vec<Object> = places.map(|place| girl.placed(0.0, place)).collect();
    let of = |objects: Vec<Object>| -> Result<Scene, BenchError> {
        let look = Look::new(preset, &Files::default()).map_err(|error| error.to_string())?;
        let mut scene = Scene::new(objects, look).map_err(|error| error.to_string())?;
        // Before the first row, close to its middle one.
        let girl = girl.head();
        scene.camera.distance = 4.0;
        let middle = scene.head().center;
        scene.camera.target = ((girl.center - middle) / girl.height_m).to_array();
        Ok(scene)
    };
    let crowd = of(all.clone())?;
    let (motion, mut frames) = (Motion::new(), FrameMaker::new());
    let frame = frames
        .frame(&crowd, &motion)
        .map_err(|error| error.to_string())?;
    let objects = frame.objects.iter();
    let seen: Vec<bool> = objects.map(|object| !object.joints.is_empty()).collect();
    let seen = all.into_iter().zip(seen).filter(|(_, is_seen)| *is_seen);
    let seen: Vec<Object> = seen.map(|(object, _)| object).collect();
    let mut visible = of(seen)?;
    // As the crowd is seen: the same place of the world.
    let (all_middle, middle) = (crowd.head().center, visible.head().center);
    let target = Vec3::from(crowd.camera.target) + (all_middle - middle) / girl.head().height_m;
    visible.camera.target = target.to_array();
    Ok((crowd, visible))
}

/// Draws a scene again and again, the camera moving.
struct Drawer {
    scene: Scene,
    motion: Motion,
    frames: FrameMaker,
    evaluator: Evaluator,
    rasterizer: Rasterizer,
    drawing: Drawing,
    yaw: f32,
    /// Those of the first picture: they don't hang on how many a machine has time for.
    discs: Option<usize>,
}

impl Drawer {
    fn new(scene: &Scene) -> Result<Self, BenchError> {
        Ok(Self {
            yaw: scene.camera.yaw,
            scene: scene.clone(),
            motion: Motion::new(),
            frames: FrameMaker::new(),
            evaluator: Evaluator::of_samples(SAMPLES),
            rasterizer: Rasterizer::new(SAMPLES, None).map_err(|error| error.to_string())?,
            drawing: Drawing::default(),
            discs: None,
        })
    }

    fn draw(&mut self) -> Result<(), BenchError> {
        let frame = self.frames.frame(&self.scene, &self.motion);
        let frame = frame.map_err(|error| error.to_string())?;
        let evaluated = self.evaluator.evaluate(&frame, &mut self.drawing);
        evaluated.map_err(|error| error.to_string())?;
        self.discs.get_or_insert(discs(&self.drawing));
        let picture = self.rasterizer.draw(&self.drawing);
        let picture = picture.map_err(|error| error.to_string())?;
        self.rasterizer.give_back(picture);
        // To and fro by half a degree, so that no picture is the one before.
        let turned = self.scene.camera.yaw > self.yaw;
        self.scene.camera.yaw = if turned { self.yaw } else { self.yaw + 0.5 };
        Ok(())
    }
}

/// How many discs the strokes of all layers have.
fn discs(drawing: &Drawing) -> usize {
    drawing.layers.iter().map(|layer| layer.discs.len()).sum()
}

fn measure(
    case: &Case,
    effort: Effort,
    measured: &mut Measured,
    progress: &ProgressBar,
) -> Result<(), BenchError> {
    let mut drawers = [Drawer::new(&case.whole)?, Drawer::new(&case.part)?];
    let mut runs: Vec<_> = drawers.iter_mut().map(|drawer| || drawer.draw()).collect();
    let seconds = medians(&mut runs, effort, || progress.inc(1))?;
    drop(runs);
    let discs = drawers.map(|drawer| drawer.discs.unwrap_or_default());
    for ((method, seconds), discs) in ["whole", "part"].into_iter().zip(&seconds).zip(discs) {
        measured.rows.push(row(case.name, method, discs, *seconds));
    }
    let ratio = |what: &str, worse: f64, found: f64, most: f64| Ratio {
        scene: case.name.to_owned(),
        name: what.to_owned(),
        worse,
        target: Target {
            text: format!("{}: {}, {what}", case.name, case.says),
            found: Some(Found::Is(found)),
            limit: Limit::AtMost(most),
        },
    };
    let share = discs[1] as f64 / discs[0] as f64;
    measured.ratios.extend([
        ratio("time", TIMES, seconds[1] / seconds[0], case.time),
        ratio("discs", COUNTS, share, case.discs),
    ]);
    Ok(())
}

/// What it takes to see that nothing changed, of a whole frame.
fn unchanged(
    scene: &Scene,
    effort: Effort,
    measured: &mut Measured,
    progress: &ProgressBar,
) -> Result<(), BenchError> {
    let mut whole = Drawer::new(scene)?;
    let (mut motion, mut frames) = (Motion::new(), FrameMaker::new());
    motion
        .advance_to(scene, 0.0)
        .map_err(|error| error.to_string())?;
    frames
        .frame(scene, &motion)
        .map_err(|error| error.to_string())?;
    let mut time = 0.0;
    let mut look = || -> Result<(), BenchError> {
        time += 1.0 / 60.0;
        motion
            .advance_to(scene, time)
            .map_err(|error| error.to_string())?;
        let camera = scene.own_camera().map_err(|error| error.to_string())?;
        match frames.is_as_before(scene, &motion, &camera) {
            true => Ok(()),
            false => Err("a still scene changed".into()),
        }
    };
    let mut draw = || whole.draw();
    let mut runs: [&mut dyn FnMut() -> Result<(), BenchError>; 2] = [&mut draw, &mut look];
    let seconds = medians(&mut runs, effort, || progress.inc(1))?;
    measured.rows.push(row("unchanged", "whole", 0, seconds[0]));
    measured.rows.push(row("unchanged", "part", 0, seconds[1]));
    measured.ratios.push(Ratio {
        scene: "unchanged".to_owned(),
        name: "time".to_owned(),
        worse: TIMES,
        target: Target {
            text: "unchanged: a still camera on a still scene, time".to_owned(),
            found: Some(Found::Is(seconds[1] / seconds[0])),
            limit: Limit::AtMost(0.01),
        },
    });
    Ok(())
}

fn row(scene: &str, method: &str, discs: usize, seconds: f64) -> Row {
    Row {
        scene: scene.to_owned(),
        method: method.to_owned(),
        knob: discs,
        seconds,
        error: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What counts say holds on any machine, however slow.
    #[test]
    fn parts_have_their_share_of_discs() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for case in cases(&root).unwrap() {
            let [whole, part] = [&case.whole, &case.part].map(|scene| {
                let (motion, mut frames) = (Motion::new(), FrameMaker::new());
                let mut drawing = Drawing::default();
                let frame = frames.frame(scene, &motion).unwrap();
                Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
                discs(&drawing)
            });
            assert!(whole > 1000, "{}: {whole}", case.name);
            let share = part as f64 / whole as f64;
            assert!(share <= case.discs, "{}: {share}", case.name);
        }
    }

    #[test]
    fn counts_are_those_of_the_first_picture() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let case = cases(&root).unwrap().remove(0);
        let mut drawer = Drawer::new(&case.whole).unwrap();
        let mut counts = (0..2).map(|_| {
            drawer.draw().unwrap();
            (drawer.discs, discs(&drawer.drawing))
        });
        let [first, second] = [counts.next(), counts.next()].map(Option::unwrap);
        assert_eq!(first.0, Some(first.1));
        // Another picture has other discs.
        assert!(second.0 == first.0 && second.1 != first.1, "{second:?}");
    }
}
