//! The thread that draws: newer wishes don't wait for what nobody wants to see any more.

use crate::common::{LOOK, Looks, viewer, wait_for, wait_for_picture};
use stage::Hand;
use std::sync::Arc;
use std::time::{Duration, Instant};
use viewer::engine::{Answer, Backend, Drawn, Engine, Look, Thumbnail, Thumbnails, Wish};

/// Dynamics that are not at rest, and take steps for hours before their first picture.
const ENDLESS: &str = "dynamics: (gravity: 0.9, step: 0.00001, warm_up: 600),";

/// How long a picture may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// The look with another part.
fn with(part: &str) -> String {
    LOOK.replace("version: 1,", &format!("version: 1, {part}"))
}

fn wish(looks: &Looks, text: &str) -> Wish {
    Wish {
        looks: vec![Look {
            name: "look.ron".to_owned(),
            folder: looks.path(""),
            text: text.into(),
            ..Look::default()
        }],
        opened: 0,
        camera: None,
        size_px: [64, 48],
        is_moving: false,
        samples: None,
        time_s: 0.0,
        hand: Hand::new(),
        backend: Backend::Cpu,
    }
}

/// The next answer; nothing where there is none in a minute.
fn next_answer(engine: &mut Engine) -> Option<Answer> {
    let started = Instant::now();
    while started.elapsed() < PATIENCE {
        if let Some(answer) = engine.answer() {
            return Some(answer);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    None
}

/// The sharp answer to a wish for that text, or the first one that tells what is wrong with it.
fn last_answer(engine: &mut Engine, looks: &Looks, text: &str) -> Answer {
    engine.wish(wish(looks, text));
    loop {
        let answer = next_answer(engine).expect("the look is drawn, or its mistake told");
        if answer.is_final || !answer.problems.is_empty() {
            return answer;
        }
    }
}

/// The sharp picture of that text.
fn pixels(engine: &mut Engine, looks: &Looks, text: &str) -> Vec<u8> {
    let mut answer = last_answer(engine, looks, text);
    assert!(answer.problems.is_empty(), "{:?}", answer.problems);
    answer.pictures.remove(0).expect("a picture").pixels
}

/// The text with something else in place of what it has there.
fn edited(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    text.replace(from, to)
}

/// That each edit of a text changes its picture, to that of one who opens the edited text.
fn assert_edits_are_seen(text: &str, edits: &[[&str; 2]]) {
    let looks = Looks::new();
    let start = || Engine::start(Arc::new(inkstrand::builtin_effects()), || {});
    let mut engine = start();
    let mut before = pixels(&mut engine, &looks, text);
    for [from, to] in edits {
        let edited = edited(text, from, to);
        let after = pixels(&mut engine, &looks, &edited);
        assert!(after != before, "{to}");
        let opened = pixels(&mut start(), &looks, &edited);
        assert!(after == opened, "{to}");
        before = after;
    }
}

/// Two heads as other presets describe them.
const TWO: &str = r#"(
    version: 1,
    scene: (size: (160, 120), samples: 4),
    camera: (distance: 5),
    objects: [
        (preset: "look.ron", at: (-0.13, 0, 0), turn: 35),
        (preset: "look.ron", at: (0.15, 0.02, 0.08), turn: -40),
    ],
)
"#;

/// Two cubes without a head.
const CUBES: &str = r#"(
    version: 1,
    head: (shape: none),
    meshes: [
        (shape: cube, name: "left", color: "F2C14E", at: (-0.62, 0, 0.1), turn: (24, 0, 0), size: 0.9),
        (shape: cube, name: "right", color: "5FA8A0", at: (0.62, 0, -0.1), turn: (-14, 0, 0)),
    ],
    scene: (size: (160, 120), samples: 4),
    camera: (yaw: 8, pitch: 22, distance: 2.5),
    lines: [(name: "ink", of: "left", kind: "crease")],
    layers: [
        (effect: "mesh.toon", on: "*"),
        (effect: "line.ink", on: "ink", params: (width: 4.5)),
    ],
)
"#;

#[test]
fn objects_move_as_they_are_edited() {
    let edits = [
        ["turn: 35", "turn: 80"],
        ["at: (-0.13, 0, 0)", "at: (-0.2, 0.05, 0)"],
    ];
    assert_edits_are_seen(TWO, &edits);
}

#[test]
fn meshes_move_as_they_are_edited() {
    let edits = [
        ["at: (-0.62, 0, 0.1)", "at: (-0.62, 0.4, 0.1)"],
        ["turn: (24, 0, 0)", "turn: (60, 0, 0)"],
        ["size: 0.9", "size: 0.5"],
        [
            "(shape: cube, name: \"left\"",
            "(shape: gear, name: \"left\"",
        ],
        ["color: \"F2C14E\"", "color: \"30251C\""],
    ];
    assert_edits_are_seen(CUBES, &edits);
}

#[test]
fn hair_styled_in_a_body_lies_as_far_from_it_as_is_edited() {
    let ball = "bodies: [(at: (0.45, -0.2, 0.1), radius: 0.3)], dynamics: (distance: 0.5),";
    assert_edits_are_seen(&with(ball), &[["distance: 0.5", "distance: 2"]]);
}

#[test]
fn hair_is_not_loaded_again_for_a_colour() {
    let looks = Looks::new();
    let mut engine = Engine::start(Arc::new(inkstrand::builtin_effects()), || {});
    let text = with("meshes: [(shape: cube, color: \"F2C14E\", at: (0, 0, 0.9), size: 0.5)],");
    let before = pixels(&mut engine, &looks, &text);
    // Another style that looks untouched, and can't be read.
    let path = looks.path("bob.style.ron");
    let about = std::fs::metadata(&path).unwrap();
    std::fs::write(&path, " ".repeat(about.len() as usize)).unwrap();
    let file = std::fs::File::options().write(true).open(&path).unwrap();
    file.set_modified(about.modified().unwrap()).unwrap();
    drop(file);
    let of_layer = edited(
        &text,
        "(effect: \"hair.base\")",
        "(effect: \"hair.base\", params: (brightness: 0.5))",
    );
    let of_mesh = edited(&of_layer, "color: \"F2C14E\"", "color: \"30251C\"");
    let layer = pixels(&mut engine, &looks, &of_layer);
    assert!(layer != before);
    assert!(pixels(&mut engine, &looks, &of_mesh) != layer);
    // Another place needs all files.
    let moved = edited(&of_mesh, "size: 0.5", "size: 0.6");
    assert!(!last_answer(&mut engine, &looks, &moved).problems.is_empty());
}

#[test]
fn hair_far_behind_keeps_nobody_waiting() {
    let looks = Looks::new();
    let mut engine = Engine::start(Arc::new(inkstrand::builtin_effects()), || {});
    engine.wish(wish(&looks, &with(ENDLESS)));
    std::thread::sleep(Duration::from_millis(500));
    // It is not shown before hair is where it is wished, while nobody wishes for something else.
    assert!(engine.answer().is_none());
    engine.wish(wish(&looks, LOOK));
    loop {
        let answer = next_answer(&mut engine).expect("the newer wish is drawn");
        assert!(answer.problems.is_empty(), "{:?}", answer.problems);
        if answer.is_final {
            break;
        }
    }
    assert!(!engine.is_drawing());
}

#[test]
fn pictures_go_on_while_dynamics_are_dragged() {
    let looks = Looks::new();
    let mut engine = Engine::start(Arc::new(inkstrand::builtin_effects()), || {});
    let mut pictures = 0;
    let started = Instant::now();
    for drag in 0.. {
        let gravity = format!("gravity: {}", 0.5 + 0.001 * f64::from(drag));
        let dragged = with(ENDLESS).replace("gravity: 0.9", &gravity);
        engine.wish(wish(&looks, &dragged));
        std::thread::sleep(Duration::from_millis(20));
        if let Some(answer) = engine.answer() {
            assert!(!answer.is_final && answer.pictures[0].is_some());
            pictures += 1;
        }
        if pictures == 3 {
            break;
        }
        let waited = started.elapsed();
        assert!(waited < Duration::from_secs(60), "{pictures} pictures");
    }
}

#[test]
fn what_was_under_way_of_another_preset_is_not_shown() {
    let looks = Looks::new();
    std::fs::write(looks.path("endless.ron"), with(ENDLESS)).unwrap();
    // One whose hair has some way to go before it is shown, and another layer.
    let next = with("dynamics: (gravity: 0.9, step: 0.001, warm_up: 3),");
    let next = next.replace("effect: \"hair.base\"", "effect: \"hair.cel\"");
    std::fs::write(looks.path("next.ron"), next).unwrap();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    harness.state_mut().studio.open(&looks.path("endless.ron"));
    harness.run_steps(3);
    std::thread::sleep(Duration::from_millis(300));
    harness.state_mut().studio.open(&looks.path("next.ron"));
    wait_for(&mut harness, "the next one's picture", |app| {
        let shown = app.studio.shown[0].as_ref();
        shown.is_some_and(|shown| {
            let layers = &shown.drawn.facts.layers;
            assert_eq!(layers, &["hair.silhouette", "hair.cel"]);
            true
        })
    });
}

#[test]
fn a_still_scene_is_drawn_once_however_long_it_plays() {
    let looks = Looks::new();
    let mut engine = Engine::start(Arc::new(inkstrand::builtin_effects()), || {});
    let mut drawn_at = |time_s: f32, text: &str| {
        engine.wish(Wish {
            time_s,
            is_moving: true,
            ..wish(&looks, text)
        });
        let mut answer = next_answer(&mut engine).expect("the wish is drawn");
        answer.pictures.remove(0).expect("a picture")
    };
    // What it took is told with a picture: nothing takes as long twice, to the bit.
    let took = |drawn: &Drawn| {
        let times = &drawn.times;
        [times.paths, times.effects, times.raster].map(f64::to_bits)
    };
    let still = LOOK.replace("motion: (file: \"turn.motion.ron\"),", "");
    let pictures: Vec<Drawn> = (0..12).map(|i| drawn_at(i as f32, &still)).collect();
    // The first ones find out how large pictures of a moving scene may be.
    let alike =
        |pair: &&[Drawn]| (pair[0].size_px, pair[0].samples) == (pair[1].size_px, pair[1].samples);
    let pairs: Vec<&[Drawn]> = pictures.windows(2).filter(alike).collect();
    assert!(pairs.len() > 3, "{}", pairs.len());
    for pair in pairs {
        assert_eq!(took(&pair[0]), took(&pair[1]));
        assert!(pair[0].pixels == pair[1].pixels);
    }
    let other = drawn_at(12.0, &still.replace("yaw: 40", "yaw: 41"));
    assert_ne!(took(&pictures[11]), took(&other));
}

/// Hair and head stay loaded while layers are edited; but which zones there are is theirs to say.
#[test]
fn a_layer_of_nothing_is_told_while_it_is_edited() {
    let looks = Looks::new();
    let mut engine = Engine::start(Arc::new(inkstrand::builtin_effects()), || {});
    let mut told = |text: &str, from: &str, to: &str| {
        assert!(last_answer(&mut engine, &looks, text).problems.is_empty());
        let answer = last_answer(&mut engine, &looks, &edited(text, from, to));
        let first = answer.problems.first();
        first.expect("there is no such thing").to_string()
    };
    let of_zones = told(LOOK, "\"hair.base\"", "\"hair.base\", zones: \"nowhere\"");
    assert!(of_zones.contains("no zone `nowhere`"), "{of_zones}");
    let of_meshes = told(CUBES, "on: \"*\"", "on: \"nowhere\"");
    assert!(of_meshes.contains("`nowhere`"), "{of_meshes}");
}

/// A small picture that can't be drawn, as its base can't, is there once somebody has mended that.
#[test]
fn small_pictures_follow_bases_that_are_mended() {
    let looks = Looks::new();
    let based = looks.path("based.ron");
    std::fs::write(&based, "(version: 1, base: \"look.ron\")").unwrap();
    std::fs::write(
        looks.path("look.ron"),
        LOOK.replace("hair.base", "hair.bsae"),
    )
    .unwrap();
    let thumbnails = Thumbnails::start(Arc::new(inkstrand::builtin_effects()), || {});
    let wait_for = |is_so: fn(&Thumbnail) -> bool| {
        let started = Instant::now();
        while !is_so(&thumbnails.of(&based)) {
            assert!(started.elapsed() < PATIENCE, "{:?}", thumbnails.of(&based));
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    wait_for(|small| matches!(small, Thumbnail::Failed(_)));
    std::fs::write(looks.path("look.ron"), LOOK).unwrap();
    wait_for(|small| matches!(small, Thumbnail::Drawn(_)));
}
