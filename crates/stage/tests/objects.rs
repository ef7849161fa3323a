//! Several heads in one picture: each is what its own preset draws, in its place.

use effects::Registry;
use glam::{Quat, Vec3};
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Frame, Picture};
use stage::{Files, Preset, Stage, StageError};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const SCENE: &str =
    "scene: (size: (96, 72), samples: 4), camera: (distance: 7, pitch: 10), light: (yaw: 30),";

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    registry
}

fn files() -> Files {
    Files {
        preset_folder: Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets"),
        ..Files::default()
    }
}

/// The stage of a preset beside those that come with inkstrand.
fn stage(registry: &Registry, text: &str) -> Result<Stage, StageError> {
    let preset = Preset::parse("pair.ron", text, registry)?;
    preset.check_files(&files())?;
    Stage::new(&preset, &files())
}

fn of_objects(registry: &Registry, objects: &str) -> Result<Stage, StageError> {
    stage(
        registry,
        &format!("(version: 1, {SCENE} objects: [{objects}])"),
    )
}

/// A folder with a preset of hair in these winds on a head that nods: `own.ron`.
fn moving(winds: &str) -> (TempDir, Files) {
    let folder = tempfile::tempdir().unwrap();
    let presets = fs::canonicalize(files().preset_folder).unwrap();
    fs::write(
        folder.path().join("a.motion.ron"),
        format!("(version: 1, moves: [(move: lift, angle: -30)], winds: [{winds}])"),
    )
    .unwrap();
    let style = presets.join("styles/bob.style.ron");
    let own = format!(
        "(version: 1, hair: (file: {:?}), head: (shape: bust), motion: (file: \"a.motion.ron\"), \
         layers: [(effect: \"hair.base\")])",
        style.display().to_string()
    );
    fs::write(folder.path().join("own.ron"), own).unwrap();
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    (folder, files)
}

fn of(registry: &Registry, files: &Files, objects: &str) -> Stage {
    let text = format!("(version: 1, {SCENE} objects: [{objects}])");
    let preset = Preset::parse("pair.ron", &text, registry).unwrap();
    Stage::new(&preset, files).unwrap()
}

fn refused(objects: &str) -> String {
    match of_objects(&registry(), objects) {
        Ok(_) => panic!("{objects} is taken"),
        Err(error) => error.to_string(),
    }
}

/// A preset of inkstrand's own, seen as the scenes here are.
fn alone(registry: &Registry, name: &str) -> Stage {
    alone_with(registry, name, &[])
}

fn alone_with(registry: &Registry, name: &str, assignments: &[&str]) -> Stage {
    let text = fs::read_to_string(files().preset_folder.join(name)).unwrap();
    let mut preset = Preset::parse(name, &text, registry).unwrap();
    let as_here = [
        "scene.size=(96, 72)",
        "scene.samples=4",
        "scene.background=FFFFFF",
        "camera.distance=7",
        "camera.pitch=10",
        "camera.yaw=0",
        "camera.target=(0, 0, 0)",
        "camera.fov=30",
        "light.yaw=30",
        "light.pitch=40",
        "light.fixed_to=world",
    ];
    for assignment in as_here.iter().chain(assignments) {
        let (name, value) = assignment.split_once('=').unwrap();
        preset.set(name, value).unwrap();
    }
    Stage::new(&preset, &files()).unwrap()
}

fn picture(stage: &mut Stage) -> Picture {
    let mut drawing = Drawing::default();
    let frame = stage.frame().unwrap();
    Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
    Rasterizer::new(4, Some(1)).unwrap().draw(&drawing).unwrap()
}

#[test]
fn one_object_in_its_place_is_its_preset() {
    let registry = registry();
    for name in ["short-ash.ron", "manga-ink.ron"] {
        let mut own = alone(&registry, name);
        let mut object = of_objects(&registry, &format!("(preset: \"{name}\")")).unwrap();
        for time in [0.0, 0.4] {
            own.advance_to(time).unwrap();
            object.advance_to(time).unwrap();
            assert!(
                picture(&mut own) == picture(&mut object),
                "{name}, {time} s"
            );
        }
    }
}

#[test]
fn an_object_stands_where_it_is_placed() {
    let registry = registry();
    // From here hair is thin, and how many strands of what size are drawn hangs on where each is seen: not so without `detail`.
    let mut own = alone_with(&registry, "short-ash.ron", &["scene.detail=0"]);
    let place = "(preset: \"short-ash.ron\", at: (0.3, 0.1, -0.2), turn: 90)";
    let scene = SCENE.replace("scene: (", "scene: (detail: 0, ");
    assert_ne!(scene, SCENE);
    let text = format!("(version: 1, {scene} objects: [{place}])");
    let mut placed = stage(&registry, &text).unwrap();
    let (own, placed) = (own.frame().unwrap(), placed.frame().unwrap());
    let quarter = Quat::from_rotation_y(90_f32.to_radians());
    let shift = Vec3::new(0.3, 0.1, -0.2);
    let moved = |point: Vec3| quarter * point + shift;
    let head = placed.objects[0].head;
    assert!(head.center.distance(moved(own.objects[0].head.center)) < 1e-6);
    for (own, placed) in own.strands.iter().zip(placed.strands) {
        assert_eq!((own.id, own.size), (placed.id, placed.size));
        assert!(placed.mean.distance(moved(own.mean)) < 1e-6);
    }
}

/// Two twins beside each other, and what they are alone: each half of the picture is that of one.
#[test]
fn each_half_shows_one_of_two() {
    let registry = registry();
    let [left, right] = ["at: (-0.25, 0, 0)", "at: (0.25, 0, 0), turn: 30, seed: 5"]
        .map(|place| format!("(preset: \"short-ash.ron\", {place})"));
    let mut pair = of_objects(&registry, &format!("{left}, {right}")).unwrap();
    assert_eq!(pair.strand_count() % 2, 0);
    let together = picture(&mut pair);
    for (object, half) in [(&left, 0..48), (&right, 48..96)] {
        let mut stage = of_objects(&registry, object).unwrap();
        // The camera looks at the middle of all heads.
        let own = stage.head();
        let target = (pair.head().center - own.center) / own.height_m;
        stage.scene.camera.target = target.to_array();
        let single = picture(&mut stage);
        let rows = 0..together.height as usize;
        let places = rows.flat_map(|y| half.clone().map(move |x| y * 96 + x));
        let differs = |i: &usize| {
            let (a, b) = (together.pixels[*i], single.pixels[*i]);
            (0..3).any(|c| (a[c] - b[c]).abs() > 0.05)
        };
        // The cameras are the same but for rounding.
        let wrong = places.filter(differs).count();
        assert!(wrong <= 12, "{wrong} pixels of {object}");
    }
}

/// What turns its object moves in its own way: a head that nods nods forwards, wherever that is; winds blow as in the world.
#[test]
fn placed_objects_move_as_they_did() {
    let registry = registry();
    let (_windy_folder, windy) = moving("(speed: 9, yaw: 90)");
    let (_calm_folder, calm) = moving("");
    let stage = |files: &Files, turn: f32| {
        let mut stage = of(
            &registry,
            files,
            &format!("(preset: \"own.ron\", turn: {turn})"),
        );
        stage.advance_to(1.0).unwrap();
        stage
    };
    let (mut front, mut side) = (stage(&windy, 0.0), stage(&windy, 90.0));
    let (front, side) = (front.frame().unwrap(), side.frame().unwrap());
    let (here, there) = (front.objects[0].head.center, side.objects[0].head.center);
    // The head has sunk forwards: towards +Z here, towards +X there.
    assert!(here.z - 0.02 > there.z && there.x - 0.02 > here.x);
    // And wind takes hair to the same side of the world, away from the viewer's right.
    let mean = |frame: &Frame| {
        let means = frame.strands.iter().map(|strand| strand.mean);
        means.sum::<Vec3>() / frame.strands.len() as f32
    };
    for (turn, blown) in [(0.0, mean(&front)), (90.0, mean(&side))] {
        let away = blown - mean(&stage(&calm, turn).frame().unwrap());
        assert!(
            away.x < -0.002 && away.z.abs() < -0.5 * away.x,
            "{turn}: {away}"
        );
    }
}

/// A live program moves a character: its hair goes on, and isn't simulated from the start each time.
#[test]
fn another_place_is_no_other_motion() {
    let registry = registry();
    let (_folder, files) = moving("(speed: 9, yaw: 90)");
    let mut stage = of(&registry, &files, "(preset: \"own.ron\")");
    stage.advance_to(0.5).unwrap();
    let first = stage.steps_taken();
    let placed = stage.scene.objects()[0].placed(20.0, Vec3::X);
    stage.scene = stage.scene.with_object(0, placed).unwrap();
    stage.advance_to(0.55).unwrap();
    let then = stage.steps_taken();
    assert!(
        first > 5 && then > first && then <= first + 2,
        "{first}, {then}"
    );
}

/// What stood at an index before says nothing of what stands there now.
#[test]
fn another_object_begins_anew() {
    let registry = registry();
    let (_folder, files) = moving("(speed: 9, yaw: 90)");
    let mut stage = of(&registry, &files, "(preset: \"own.ron\")");
    stage.advance_to(1.0).unwrap();
    let mut still = of_objects(&registry, "(preset: \"manga-ink.ron\", at: (1, 0, 0))").unwrap();
    let at_rest = still.frame().unwrap().objects[0].head.center;
    let other = still.scene.objects()[0].clone();
    let nodding = stage.frame().unwrap().objects[0].head.center;
    assert!(nodding.distance(at_rest - Vec3::X) > 0.01, "{nodding}");
    stage.scene = stage.scene.with_object(0, other).unwrap();
    assert_eq!(stage.frame().unwrap().objects[0].head.center, at_rest);
}

#[test]
fn mistakes_have_their_place() {
    let nothing = "objects: the list is empty, so nothing would be drawn";
    assert!(refused("").contains(nothing));
    let error = refused("(at: (0, 0, 0))");
    assert!(error.contains("an object needs `preset:"), "{error}");
    let error = refused("(preset: \"shrot-ash.ron\")");
    assert!(error.contains("pair.ron:1:") && error.contains("did you mean `short-ash.ron`?"));
    let error = refused("(preset: \"short-ash.ron\", turn: 700)");
    assert!(
        error.contains("turn: expected a number from -360 to 360"),
        "{error}"
    );
    let error = refused("(preset: \"two-friends.ron\")");
    assert!(
        error.contains("`") && error.contains("names objects itself"),
        "{error}"
    );
    let error = refused("(preset: \"short-ash.ron\"), (preset: \"flat-tails-red.ron\")");
    assert!(error.contains("different brushes"), "{error}");
    let crowd = "(preset: \"short-ash.ron\"), ".repeat(1001);
    assert!(refused(&crowd).contains("there are 1001, and at most 1000 are drawn"));
    // A section that its objects' presets say.
    let text = "(version: 1, clump: (size: 3), layers: [], objects: [(preset: \"short-ash.ron\")])";
    let error = stage(&registry(), text).err().unwrap().to_string();
    assert!(
        error.contains("`clump` is said in their presets"),
        "{error}"
    );
    assert!(
        error.contains("`layers` is said in their presets"),
        "{error}"
    );
}

#[test]
fn options_for_one_head_are_refused() {
    let registry = registry();
    let text = "(version: 1, objects: [(preset: \"short-ash.ron\")])";
    let mut preset = Preset::parse("pair.ron", text, &registry).unwrap();
    let error = preset.set("clump.size", "2").unwrap_err().to_string();
    assert!(
        error.contains("`clump` is said in their presets"),
        "{error}"
    );
    preset.set("camera.yaw", "20").unwrap();
    let given = Files {
        hair: Some("x.tfx".into()),
        ..files()
    };
    let error = Stage::new(&preset, &given).err().unwrap();
    assert!(matches!(error, StageError::OfObjects));
    preset.sections.hair.guides = 5;
    let error = Stage::new(&preset, &files()).err().unwrap();
    assert!(matches!(error, StageError::OfObjects));
}

#[test]
fn a_bake_is_of_one_head() {
    let registry = registry();
    let two = "(preset: \"short-ash.ron\"), (preset: \"short-ash.ron\", at: (1, 0, 0))";
    let mut stage = of_objects(&registry, two).unwrap();
    stage.advance_to(0.0).unwrap();
    let mut bake = stage::Bake::default();
    stage.record(0.0, &mut bake);
    let error = stage.bake_text(bake).unwrap_err();
    assert!(matches!(error, StageError::BakeOfObjects(2)), "{error}");
}
