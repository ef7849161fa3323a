//! Lines of meshes, drawn as strokes: which there are, where they lie, what hides them, and mistakes.

#![allow(
    clippy::print_stdout,
    reason = "a test shows the figures that it holds"
)]

use effects::Registry;
use glam::{Vec2, Vec3};
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Frame, Picture};
use stage::{Files, Preset, Stage};
use std::fmt::Write as _;
use std::fs;
use std::ops::Range;
use stroke_path::{Camera, OrbitView};
use tempfile::TempDir;

const RADIUS_M: f32 = 0.05;
/// Before the bust's face, and beside it.
const BALL: Vec3 = Vec3::new(0.0, 1.52, 0.3);
const BOX: Vec3 = Vec3::new(0.2, 1.52, 0.1);

/// One strand of hair behind the head, a ball and a box.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write(
        "a.strands.ron",
        "(version: 1, strands: [(points: [(0, 1.63, -0.06), (0, 1.6, -0.13), (0, 1.5, -0.14)])])",
    );
    write(
        "curtain.strands.ron",
        "(version: 1, strands: [(points: [(0, 1.63, 0.06), (0, 1.6, 0.4), (0, 1.4, 0.4)])])",
    );
    write("ball.obj", &ball(24, 48));
    write("box.obj", &cube());
    folder
}

fn ball(rows: usize, columns: usize) -> String {
    let mut text = String::new();
    for row in 0..=rows {
        for column in 0..columns {
            let down = std::f32::consts::PI * row as f32 / rows as f32;
            // At both poles all is one point.
            let width = if row % rows == 0 { 0.0 } else { down.sin() };
            let around = std::f32::consts::TAU * column as f32 / columns as f32;
            let way = Vec3::new(width * around.sin(), down.cos(), width * around.cos());
            let Vec3 { x, y, z } = BALL + RADIUS_M * way;
            let _ = writeln!(text, "v {x} {y} {z}");
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let at = |row: usize, column: usize| row * columns + column % columns + 1;
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column + 1), at(row + 1, column)];
            let _ = writeln!(text, "f {d} {c} {b} {a}");
        }
    }
    text
}

fn cube() -> String {
    let mut text = String::new();
    for corner in 0..8 {
        let at = |bit: usize| if corner >> bit & 1 == 1 { 0.03 } else { -0.03 };
        let Vec3 { x, y, z } = BOX + Vec3::new(at(0), at(1), at(2));
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
}

fn text(hair: &str, lines: &str, layers: &str) -> String {
    format!(
        "(version: 1, hair: (file: \"{hair}.strands.ron\"), head: (shape: bust, width: 0, light: \"FFFFFF\", shadow: \"FFFFFF\"),\n \
         meshes: [(file: \"ball.obj\"), (file: \"box.obj\")],\n \
         scene: (size: (240, 240), samples: 4, background: \"FFFFFF\"), clump: (size: 0.5, color: \"C04020\"),\n \
         camera: (distance: 6), light: (yaw: 0, pitch: 10),\n lines: [{lines}],\n layers: [(effect: \"hair.base\"), {layers}])"
    )
}

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    registry
}

fn stage(hair: &str, lines: &str, layers: &str) -> Result<Stage, String> {
    let (folder, text, registry) = (folder(), text(hair, lines, layers), registry());
    let preset = Preset::parse("look.ron", &text, &registry).map_err(|error| error.to_string())?;
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    preset
        .check_scene("look.ron", &text, &files)
        .map_err(|error| error.to_string())?;
    Stage::new(&preset, &files).map_err(|error| error.to_string())
}

const INK: &str =
    "(effect: \"line.ink\", on: \"rim\", params: (wobble: 0, light_width: 1, color: \"000000\"))";

fn drawn(frame: &Frame) -> Picture {
    let mut drawing = Drawing::default();
    Evaluator::default().evaluate(frame, &mut drawing).unwrap();
    Rasterizer::new(4, Some(1)).unwrap().draw(&drawing).unwrap()
}

fn picture(hair: &str, lines: &str, layers: &str) -> Picture {
    drawn(&stage(hair, lines, layers).unwrap().frame().unwrap())
}

/// How many pixels are dark, all of a black one.
fn ink(picture: &Picture) -> f32 {
    picture.pixels.iter().map(|[red, ..]| 1.0 - red).sum()
}

/// The joints of each line of the last list.
fn strands(frame: &Frame) -> Vec<Range<usize>> {
    let own = frame.objects.last().unwrap().joints.clone();
    let runs = frame.paths.runs.iter().map(|run| run.joints.clone());
    runs.filter(|joints| joints.start >= own.start).collect()
}

#[test]
fn a_balls_contour_is_the_exact_circle() {
    let lines = "(name: \"rim\", of: \"ball\", kind: \"contour\")";
    let mut stage = stage("a", lines, INK).unwrap();
    let frame = stage.frame().unwrap();
    let strands = strands(&frame);
    assert_eq!(strands.len(), 1, "{strands:?}");
    // Seen from the eye, all points of it are as far from the line of sight to the middle as a tangent is.
    let eye = frame.camera.eye();
    let ahead = (BALL - eye).normalize();
    let sine = RADIUS_M / BALL.distance(eye);
    for joint in strands[0].clone() {
        let way = (frame.paths.position[joint] - eye).normalize();
        let off = way.cross(ahead).length() - sine;
        let off_px = off * frame.camera.focal_px();
        assert!(off_px.abs() < 0.15, "{off_px} px at joint {joint}");
    }
    // It goes on beyond its beginning, by half of itself at most, so that no taper shows.
    let centers = &frame.paths.center[strands[0].clone()];
    let length: f32 = centers
        .windows(2)
        .map(|pair| pair[0].distance(pair[1]))
        .sum();
    let whole = std::f32::consts::TAU * sine * frame.camera.focal_px();
    assert!(
        length > 1.3 * whole && length < 1.6 * whole,
        "{length} of {whole}"
    );
    let ends: Vec<Vec2> = frame.from_ends[strands[0].clone()].to_vec();
    assert!(ends[0].x == 0.0 && ends[ends.len() - 1].y == 0.0);
    let sum = ends[0].y;
    assert!(
        ends.iter()
            .all(|ends| (ends.x + ends.y - sum).abs() < 1e-4 * sum)
    );
}

#[test]
fn a_box_has_nine_creases_that_are_seen() {
    let count = |kind: &str| {
        let lines = format!("(name: \"rim\", of: \"box\", kind: \"{kind}\")");
        let mut stage = stage("a", &lines, INK).unwrap();
        let frame = stage.frame().unwrap();
        strands(&frame).len()
    };
    // The eye is to the left of it and not far above or below: two or three sides are seen.
    let creases = count("crease");
    assert!((7..=9).contains(&creases), "{creases}");
    assert_eq!(count("border"), 0);
}

#[test]
fn lines_are_black_where_they_are_seen_and_hair_hides_them() {
    let lines = "(name: \"rim\", of: \"ball\", kind: \"contour\")";
    let none = picture("a", "", "");
    let open = picture("a", lines, INK);
    // A circle of some width, drawn upon the ball and around it.
    let added = ink(&open) - ink(&none);
    assert!(added > 100.0, "{added}");
    let behind = picture("curtain", lines, INK);
    let hidden = ink(&behind) - ink(&picture("curtain", "", ""));
    assert!(
        hidden > 0.5 * added && hidden < 0.97 * added,
        "{hidden} of {added}"
    );
}

#[test]
fn what_no_layer_draws_costs_nothing() {
    let lines = "(name: \"rim\", of: \"ball\")";
    let mut with = stage("a", lines, "").unwrap();
    let mut without = stage("a", "", "").unwrap();
    let (with, without) = (with.frame().unwrap(), without.frame().unwrap());
    assert_eq!(with.objects.len(), 1);
    assert!(with.from_ends.is_empty() && with.rest_positions.is_empty());
    assert_eq!(drawn(&with).pixels, drawn(&without).pixels);
}

#[test]
fn frames_in_any_order_have_the_same_lines() {
    let lines = "(name: \"rim\", of: \"skin\"), (name: \"edges\", of: \"*\", kind: \"crease, contour\", halo: 3)";
    let layers = "(effect: \"line.ink\", on: \"*\", params: (wobble: 0))";
    // Nothing along them is followed.
    let make = || stage("a", lines, layers).unwrap();
    let (mut one, mut other) = (make(), make());
    let pixels = |stage: &mut Stage, yaw_degrees: f32| {
        let view = OrbitView {
            target: Vec3::new(0.05, 1.5, 0.05),
            yaw_degrees,
            pitch_degrees: 5.0,
            distance_m: 1.2,
            vertical_fov_degrees: 30.0,
        };
        let camera = Camera::orbit(view, [240, 240], 0.01).unwrap();
        drawn(&stage.frame_seen_by(camera).unwrap()).pixels
    };
    let forth: Vec<_> = [0.0, 40.0, 80.0].map(|yaw| pixels(&mut one, yaw)).into();
    let back: Vec<_> = [80.0, 40.0, 0.0].map(|yaw| pixels(&mut other, yaw)).into();
    assert!(forth.iter().eq(back.iter().rev()));
}

#[test]
fn halos_leave_room_before_what_hides_a_line() {
    // The ball hides part of the bust's own lines, if any: the box's edges behind nothing stay whole.
    let ink_of = |of: &str, halo: f32| {
        let lines =
            format!("(name: \"rim\", of: \"{of}\", kind: \"contour, crease\", halo: {halo})");
        ink(&picture("a", &lines, INK))
    };
    assert!(ink_of("skin", 12.0) < ink_of("skin", 0.0));
    assert_eq!(
        ink_of("ball", 12.0),
        ink_of("ball", 0.0),
        "nothing hides it"
    );
}

#[test]
fn mistakes_are_told_at_their_places() {
    let error = |lines: &str, layers: &str| stage("a", lines, layers).err().unwrap_or_default();
    let rim = "(name: \"rim\")";
    let checks: [(&str, &str, &str); 10] = [
        (
            "(name: \"rim\", of: \"bal\")",
            INK,
            "look.ron:5:28: of: there is no mesh `bal` that has lines",
        ),
        ("(name: \"rim\", of: \"bal\")", INK, "did you mean `ball`"),
        (
            "(name: \"rim\", kind: \"contur\")",
            INK,
            "look.ron:5:30: kind: there are no lines of the kind `contur`, did you mean `contour`",
        ),
        ("(of: \"ball\")", "", "look.ron:5:10: lines need `name:"),
        (
            "(name: \"rim\"), (name: \"rim\")",
            INK,
            "there are already lines called `rim`",
        ),
        ("(name: \"a, b\")", "", "name: one word"),
        (
            rim,
            "(effect: \"line.ink\", on: \"rin\")",
            "look.ron:6:59: on: the preset has no lines called `rin`, did you mean `rim`",
        ),
        (
            rim,
            "(effect: \"line.ink\")",
            "`line.ink` draws lines, and the layer doesn't say which",
        ),
        (
            rim,
            "(effect: \"line.ink\", on: \"rim\", zones: \"a\")",
            "`zones` is not of lines",
        ),
        ("(name: \"rim\", crease: 400)", INK, "1 to 179"),
    ];
    for (lines, layers, expected) in checks {
        let message = error(lines, layers);
        assert!(message.contains(expected), "{message}\n  lacks {expected}");
    }
    let one = text("a", "", "").replace("lines: []", "lines: (name: \"rim\")");
    let error = Preset::parse("look.ron", &one, &registry()).err().unwrap();
    assert!(error.to_string().contains("lines is a list"), "{error}");
}

#[test]
fn they_are_set_by_their_number() {
    let registry = registry();
    let text = text("a", "(name: \"rim\")", INK);
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    preset.set("lines.1.halo", "4").unwrap();
    preset.set("lines.1.kind", "border").unwrap();
    assert_eq!(preset.lines[0].section.halo, 4.0);
    let error = preset.set("lines.1.kind", "rim").unwrap_err();
    assert!(
        error.to_string().contains("no lines of the kind `rim`"),
        "{error}"
    );
    assert_eq!(preset.lines[0].section.kind.as_deref(), Some("border"));
    let error = preset.set("lines.2.halo", "4").unwrap_err();
    assert!(error.to_string().contains("lines.1"), "{error}");
}

/// W, row W1: on a ball a table over n . l has its edge, a circle and in the picture an ellipse, within 0.1 pixels of where it should be: of each row of
/// pixels as much is lit.
#[test]
fn a_tones_edge_on_a_ball_is_an_exact_circle() {
    const GRID: u32 = 16;
    let folder = folder();
    fs::write(folder.path().join("ball.obj"), ball(96, 192)).unwrap();
    let mut rows = 0;
    for threshold in [0.25, 0.625, 0.875] {
        let toon = format!(
            "(effect: \"mesh.toon\", on: \"ball\", params: (mode: replace, tones: (steps: [(0, \"000000\"), ({threshold}, \"FFFFFF\")])))"
        );
        let text = text("a", "", &toon)
            .replace("size: (240, 240)", "size: (480, 480)")
            .replace("light: (yaw: 0, pitch: 10)", "light: (yaw: 50, pitch: 10)");
        let registry = registry();
        let preset = Preset::parse("look.ron", &text, &registry).unwrap();
        let files = Files {
            preset_folder: folder.path().to_owned(),
            ..Files::default()
        };
        let mut stage = Stage::new(&preset, &files).unwrap();
        let frame = stage.frame().unwrap();
        let (camera, light) = (*frame.camera, frame.light);
        let mut drawing = Drawing::default();
        Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
        let picture = Rasterizer::new(64, Some(2))
            .unwrap()
            .draw(&drawing)
            .unwrap();
        // Whether light falls on the true ball where a place of the picture shows it, away from the outline, which is the mesh's.
        let (eye, focal) = (camera.eye().as_dvec3(), camera.focal_px());
        let (ball, radius) = (BALL.as_dvec3(), f64::from(RADIUS_M));
        let is_lit = |x: f64, y: f64| {
            let view = Vec3::new((x as f32 - 240.0) / focal, (240.0 - y as f32) / focal, 1.0);
            let ray = camera
                .world_from_view_direction(view)
                .as_dvec3()
                .normalize();
            let along = (ball - eye).dot(ray);
            let inside = radius * radius - (eye + along * ray - ball).length_squared();
            let point = eye + (along - inside.max(0.0).sqrt()) * ray;
            let normal = (point - ball) / radius;
            let (towards, _) = light.seen_from(point.as_vec3());
            let faces = inside > 0.0 && normal.dot(ray) < -0.3;
            faces.then(|| normal.dot(towards.as_dvec3()) >= threshold)
        };
        let middle = camera.project(camera.view_from_world(BALL));
        let reach = 1.2 * RADIUS_M * camera.px_per_metre(camera.depth(BALL));
        let [low, high] = [middle - reach, middle + reach].map(|at| [at.x as u32, at.y as u32]);
        let mut farthest: f64 = 0.0;
        for y in low[1]..high[1] {
            let (mut moved, mut edge) = (0.0, 0.0);
            for x in low[0]..high[0] {
                let at = |cell: u32| (f64::from(cell) + 0.5) / f64::from(GRID);
                let samples = (0..GRID * GRID)
                    .map(|i| is_lit(f64::from(x) + at(i % GRID), f64::from(y) + at(i / GRID)));
                let Some(lit) = samples.collect::<Option<Vec<bool>>>() else {
                    continue;
                };
                let count = lit.iter().filter(|lit| **lit).count() as f64;
                let exact = count / f64::from(GRID * GRID);
                let [drawn, ..] = picture.pixels[(y * 480 + x) as usize];
                moved += (f64::from(drawn) - exact).abs();
                edge += f64::from(u8::from(exact > 0.0 && exact < 1.0));
            }
            rows += u32::from(edge > 0.0);
            // An edge that crosses a row is seen in two of its pixels at most; one that runs along it moves as much area for each pixel of its length.
            farthest = farthest.max(moved / f64::max(0.5 * edge, 1.0));
        }
        println!(
            "W1: the edge of n . l = {threshold} is within {farthest:.3} pixels of the circle"
        );
        assert!(farthest < 0.1, "{threshold}: {farthest:.3} pixels");
    }
    assert!(rows > 100, "{rows}");
}

/// A preset of things alone, without a file.
fn things(meshes: &str, lines: &str, layers: &str) -> Result<Stage, String> {
    things_of(meshes, lines, layers, &Files::default())
}

/// The same with files that are given.
fn things_of(meshes: &str, lines: &str, layers: &str, files: &Files) -> Result<Stage, String> {
    let text = format!(
        "(version: 1, head: (shape: none), meshes: [{meshes}],\n \
         scene: (size: (240, 240), samples: 4, background: \"FFFFFF\"), camera: (distance: 3, pitch: 20),\n \
         lines: [{lines}],\n layers: [{layers}])"
    );
    let registry = registry();
    let preset = Preset::parse("look.ron", &text, &registry).map_err(|error| error.to_string())?;
    let checked = preset.check_scene("look.ron", &text, files);
    checked.map_err(|error| error.to_string())?;
    Stage::new(&preset, files).map_err(|error| error.to_string())
}

#[test]
fn things_need_neither_file_nor_hair_nor_head() {
    let lines = "(name: \"rim\", of: \"*\", kind: \"contour, crease, border\")";
    for shape in ["cup", "cube", "gear", "wings"] {
        let mesh = format!("(shape: {shape}, color: \"FFFFFF\", shade: 1)");
        let mut stage = things(&mesh, lines, INK).unwrap();
        assert_eq!(stage.strand_count(), 0);
        stage.advance_to(0.5).unwrap();
        let frame = stage.frame().unwrap();
        assert!(strands(&frame).len() > 2, "{shape}");
        let ink = ink(&drawn(&frame));
        assert!(ink > 100.0 && ink < 12_000.0, "{shape}: {ink}");
    }
    let error =
        |meshes: &str, layers: &str| things(meshes, lines, layers).err().unwrap_or_default();
    let checks = [
        (
            "(color: \"FFFFFF\")",
            INK,
            "look.ron:1:44: a mesh needs `file:",
        ),
        ("(file: \"a.obj\", shape: cup)", INK, "not of both"),
        (
            "(shape: cup, texture: \"a.png\")",
            INK,
            "no places for a picture",
        ),
        ("(shape: cupp)", INK, "cup"),
        ("(shape: cup)", "(effect: \"hair.base\")", "names no hair"),
        (
            "(shape: cup)",
            "(effect: \"mesh.flat\", on: \"skin\")",
            "skin",
        ),
    ];
    for (meshes, layers, expected) in checks {
        let message = error(meshes, layers);
        assert!(message.contains(expected), "{message}\n  lacks {expected}");
    }
    assert!(error("(shape: cup, name: \"mine\")", INK).is_empty());
}

/// What effects and lamps are told of things is of their middle, about which they turn, and not of a neck.
#[test]
fn things_that_spin_stay_where_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("spin.motion.ron");
    let text = "(version: 1, moves: [(move: spin, length: 1, angle: 90), (move: lean, length: 1, angle: 40)])";
    fs::write(&script, text).unwrap();
    let files = Files {
        motion: Some(script),
        ..Files::default()
    };
    let mut stage = things_of("(shape: cup, at: (0.3, 0.2, 0))", "", "", &files).unwrap();
    let at_rest = stage.head();
    for time in [0.5, 1.0, 2.0] {
        stage.advance_to(time).unwrap();
        let head = stage.frame().unwrap().objects[0].head;
        let off = head.center.distance(at_rest.center);
        assert!(off < 1e-6 * at_rest.height_m, "{time}: {off}");
    }
}

#[test]
fn straight_edges_taper() {
    let lines = "(name: \"rim\", kind: \"crease\")";
    let ink_of = |taper: f32| {
        let layer = format!(
            "(effect: \"line.ink\", on: \"rim\", params: (width: 6, taper: {taper}, wobble: 0, light_width: 1, color: \"000000\"))"
        );
        let mut stage =
            things("(shape: cube, color: \"FFFFFF\", shade: 1)", lines, &layer).unwrap();
        ink(&drawn(&stage.frame().unwrap()))
    };
    let (blunt, pointed) = (ink_of(0.0), ink_of(300.0));
    // Half an ellipse at each end covers pi/4 of what it tapers.
    let share = pointed / blunt;
    assert!((share - 0.785).abs() < 0.06, "{share}");
}

#[test]
fn a_halo_is_as_wide_as_it_says() {
    // A small cube before a large one: its outline cuts the large one's top edge in two.
    let meshes = "(shape: cube, name: \"far\", color: \"FFFFFF\", shade: 1), \
                  (shape: cube, name: \"near\", size: 0.3, at: (0, 0.4, 0.8), color: \"FFFFFF\", shade: 1)";
    let ends = |halo: f32| -> f32 {
        let lines =
            format!("(name: \"rim\", of: \"far\", kind: \"crease\", halo: {halo}, shortest: 0)");
        let mut stage = things(meshes, &lines, INK).unwrap();
        let frame = stage.frame().unwrap();
        let unit_px = frame.objects[0].head.unit_m();
        let lengths = strands(&frame).into_iter().map(|joints| {
            let path = &frame.paths.center[joints.clone()];
            let px: f32 = path.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            px / (frame.paths.px_per_metre[joints.start] * unit_px)
        });
        lengths.sum()
    };
    let (whole, cut) = (ends(0.0), ends(10.0));
    // Two ends are hidden by the near cube's top edge or its sides, and each is shorter by the halo.
    let gaps = (whole - cut) / 10.0;
    assert!(
        (gaps - gaps.round()).abs() < 0.1 && gaps.round() >= 2.0,
        "{gaps}"
    );
}

const CHALK: &str =
    "(effect: \"line.chalk\", on: \"rim\", brush: (kind: charcoal), params: (color: \"000000\"))";

#[test]
fn marks_are_those_of_the_sequence_whichever_frame_is_asked_for() {
    let lines = "(name: \"rim\", kind: \"contour, crease\")";
    let make = || things("(shape: wings)", lines, CHALK).unwrap();
    let at = |stage: &mut Stage, frame: u32| {
        stage.advance_to(frame as f32 / 24.0).unwrap();
        let frame = stage.frame().unwrap();
        assert_eq!(frame.marks.len(), frame.paths.len());
        (frame.marks.to_vec(), drawn(&frame).pixels)
    };
    let mut all = make();
    let sequence: Vec<_> = (0..6).map(|frame| at(&mut all, frame)).collect();
    assert!(at(&mut make(), 5) == sequence[5], "alone");
    assert!(at(&mut all, 2) == sequence[2], "back");
    assert!(at(&mut all, 5) == sequence[5], "and forth");
    assert!(at(&mut all, 5) == sequence[5], "again");
}

/// As `--time` asks for them, and as what is blurred by motion is made of.
#[test]
fn moments_between_frames_follow_the_one_before_and_are_not_followed() {
    let lines = "(name: \"rim\", kind: \"contour, crease\")";
    let make = || things("(shape: wings)", lines, CHALK).unwrap();
    let at = |stage: &mut Stage, frame: f32| {
        stage.advance_to(frame / 24.0).unwrap();
        let frame = stage.frame().unwrap();
        assert_eq!(frame.marks.len(), frame.paths.len());
        (frame.paths.center.to_vec(), frame.marks.to_vec())
    };
    let mut all = make();
    let sequence: Vec<_> = (0..6).map(|frame| at(&mut all, frame as f32)).collect();
    let moment = at(&mut make(), 3.5);
    let mut stage = make();
    for earlier in [0.0, 1.25, 3.0, 3.25, 3.75] {
        at(&mut stage, earlier);
    }
    assert!(at(&mut stage, 3.5) == moment, "after others");
    assert!(at(&mut stage, 4.0) == sequence[4], "the frame after it");
    assert!(at(&mut stage, 3.5) == moment, "back");
    assert!(at(&mut stage, 5.0) == sequence[5], "and forth");
    // On it is neither what the frame before it was nor the one after.
    assert!(moment != sequence[3] && moment != sequence[4]);
}

#[test]
fn what_leaves_no_marks_is_not_followed() {
    let lines = "(name: \"rim\", kind: \"contour, crease\")";
    let mut stage = things("(shape: wings)", lines, INK).unwrap();
    assert!(stage.frame().unwrap().marks.is_empty());
}

#[test]
fn marks_stay_on_edges_whatever_hides_them() {
    // The cube before it moves on the screen as the camera does; an edge's marks are those of the edge.
    let meshes = "(shape: cube, name: \"far\"), (shape: cube, name: \"near\", size: 0.5, at: (0.3, 0.2, 0.9))";
    let lines = "(name: \"rim\", of: \"far\", kind: \"crease\")";
    let mut stage = things(meshes, lines, CHALK).unwrap();
    let height_m = stage.head().height_m;
    let mut seen = |yaw: f32| -> Vec<(Vec3, f32)> {
        stage.scene.camera.yaw = yaw;
        let frame = stage.frame().unwrap();
        let positions = frame.paths.position.iter().copied();
        positions.zip(frame.marks.iter().copied()).collect()
    };
    let (before, after) = (seen(10.0), seen(16.0));
    let (mut compared, mut stayed) = (0, 0);
    for (place, mark) in &before {
        let near = after
            .iter()
            .filter(|(other, _)| other.distance(*place) < 0.012);
        let off = near.map(|(other, at)| (at - mark).abs() * height_m - other.distance(*place));
        if let Some(least) = off.reduce(f32::min) {
            compared += 1;
            stayed += usize::from(least < 1e-3);
        }
    }
    // But where edges meet, of which one may be seen in one picture alone.
    assert!(compared > 50, "{compared}");
    assert!(
        stayed as f32 > 0.95 * compared as f32,
        "{stayed} of {compared}"
    );
}

#[test]
fn eyes_in_things_and_beside_them_draw_what_there_is() {
    let lines = "(name: \"rim\", kind: \"contour, crease, border\", halo: 4)";
    for shape in ["cup", "cube", "gear", "wings"] {
        let layers = format!("{CHALK}, {}", INK.replace("on:", "name: \"ink\", on:"));
        let mut stage = things(&format!("(shape: {shape})"), lines, &layers).unwrap();
        let target = stage.head().center;
        // In the middle, within a wall, at a corner, beside it where the near plane cuts it.
        for distance_m in [1e-4, 0.06, 0.12, 0.1205, 0.15, 1e4] {
            let view = OrbitView {
                target,
                yaw_degrees: 45.0,
                pitch_degrees: 35.0,
                distance_m,
                vertical_fov_degrees: 30.0,
            };
            let camera = Camera::orbit(view, [120, 90], stage.near_m()).unwrap();
            let frame = stage.frame_seen_by(camera).unwrap();
            assert!(frame.marks.iter().all(|mark| mark.is_finite()));
            let picture = drawn(&frame);
            let is_color = |pixel: &[f32; 4]| pixel.iter().all(|channel| channel.is_finite());
            assert!(picture.pixels.iter().all(is_color), "{shape} {distance_m}");
        }
    }
}

#[test]
fn empty_and_flat_files_of_things_are_told_or_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("empty.obj", "v 0 0 0\n");
    write("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
    write(
        "sheet.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 1\nf 1 2 3\nf 3 2 1\nf 1 2 4\n",
    );
    let registry = registry();
    for (file, is_drawn) in [
        ("empty.obj", false),
        ("point.obj", false),
        ("sheet.obj", true),
    ] {
        let text = format!(
            "(version: 1, head: (shape: none), meshes: [(file: \"{file}\")], scene: (size: (60, 40), samples: 1),\n \
             lines: [(name: \"rim\")], layers: [{CHALK}])"
        );
        let preset = Preset::parse("look.ron", &text, &registry).unwrap();
        let files = Files {
            preset_folder: folder.path().to_owned(),
            ..Files::default()
        };
        let stage = Stage::new(&preset, &files);
        match stage {
            Ok(mut stage) => drop(drawn(&stage.frame().unwrap())),
            Err(error) => assert!(!is_drawn, "{file}: {error}"),
        }
    }
}

/// Numbered files of a ball that gets other triangles, becomes a box, and is a ball again.
fn numbered() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let forms = [
        ball(24, 48),
        ball(12, 24),
        cube(),
        ball(24, 48),
        ball(24, 48),
    ];
    for (number, form) in (7..).zip(forms) {
        fs::write(folder.path().join(format!("form.{number:04}.obj")), form).unwrap();
    }
    folder
}

fn of_folder(meshes: &str, lines: &str, layers: &str, folder: &TempDir) -> Result<Stage, String> {
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    things_of(meshes, lines, layers, &files)
}

#[test]
fn numbered_files_have_lines_whatever_their_triangles() {
    let folder = numbered();
    let lines = "(name: \"rim\", of: \"form\", kind: \"contour, crease, border\")";
    let numbered = "(file: \"form.####.obj\", rate: 24)";
    let at = |stage: &mut Stage, frame: u32| {
        stage.advance_to(frame as f32 / 24.0).unwrap();
        drawn(&stage.frame().unwrap()).pixels
    };
    for layer in [
        CHALK,
        INK,
        "(effect: \"line.ink\", on: \"rim\", params: (wobble: 1))",
    ] {
        let make = || of_folder(numbered, lines, layer, &folder).unwrap();
        let mut stage = make();
        let sequence: Vec<_> = (0..6).map(|frame| at(&mut stage, frame)).collect();
        for (frame, pixels) in sequence.iter().enumerate() {
            let ink: f32 = pixels.iter().map(|[red, ..]| 1.0 - red).sum();
            // The box lies elsewhere, off the picture.
            assert!(ink > 100.0 || frame == 2, "{layer} {frame}: {ink}");
        }
        assert!(at(&mut make(), 3) == sequence[3], "{layer}: alone");
        assert!(at(&mut stage, 1) == sequence[1], "{layer}: back");
        assert!(sequence[5] == sequence[4], "{layer}: the last one stays");
        assert!(sequence[0] != sequence[1], "{layer}");
    }
    // As plain files have them.
    let mut one = of_folder(numbered, lines, INK, &folder).unwrap();
    at(&mut one, 1);
    let of_plain = lines.replace("form", "form.0007");
    let mut plain = of_folder("(file: \"form.0007.obj\")", &of_plain, INK, &folder).unwrap();
    assert!(at(&mut one, 0) == at(&mut plain, 0));
}

#[test]
fn numbered_files_of_the_same_triangles_are_mixed_between() {
    let folder = tempfile::tempdir().unwrap();
    let square = |x: f32| {
        format!(
            "v {x} 0 0\nv {} 0 0\nv {} 1 0\nv {x} 1 0\nf 1 2 3 4\n",
            x + 1.0,
            x + 1.0
        )
    };
    for (name, x) in [("a1.obj", 0.0), ("a2.obj", 0.4)] {
        fs::write(folder.path().join(name), square(x)).unwrap();
    }
    let lines = "(name: \"rim\", kind: \"border\")";
    // Where lines begin and end, metres, after so many seconds.
    let extent = |repeat: bool, seconds: f32| {
        let meshes = format!("(file: \"a#.obj\", rate: 1, repeat: {repeat})");
        let mut stage = of_folder(&meshes, lines, INK, &folder).unwrap();
        stage.advance_to(seconds).unwrap();
        let frame = stage.frame().unwrap();
        let xs = frame.paths.position.iter().map(|place| place.x);
        [f32::min, f32::max].map(|of| xs.clone().reduce(of).unwrap())
    };
    for (repeat, seconds, expected) in [
        (false, 0.0, [0.0, 1.0]),
        (false, 0.5, [0.2, 1.2]),
        (false, 9.0, [0.4, 1.4]),
        (true, 1.5, [0.2, 1.2]),
        (true, 2.0, [0.0, 1.0]),
    ] {
        let found = extent(repeat, seconds);
        let is_near = |i: usize| (found[i] - expected[i]).abs() < 0.02;
        assert!(is_near(0) && is_near(1), "{repeat} {seconds}: {found:?}");
    }
}

#[test]
fn mistakes_of_numbered_files_are_told_at_their_place() {
    let folder = numbered();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let one = "g a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let two = "g b\nv 2 0 0\nv 3 0 0\nv 2 1 0\nf 4 5 6\n";
    write("two.1.obj", one);
    write("two.2.obj", &format!("{one}{two}"));
    write("bad.1.obj", one);
    write("bad.2.obj", "v 0 0 0\nf 1 2 9\n");
    for (file, expected) in [
        (
            "none.##.obj",
            "there is no file of this name with a number in place of `#`",
        ),
        ("two.#.obj", "file 2 has 2 meshes, and the first one has 1"),
        ("bad.#.obj", "bad.2.obj"),
    ] {
        let meshes = format!("(file: \"{file}\")");
        let told = of_folder(&meshes, "(name: \"rim\")", INK, &folder);
        let told = told.err().expect("a mistake");
        assert!(told.contains(expected), "{file}: {told}");
        assert!(told.starts_with("look.ron:1:"), "{file}: {told}");
    }
}
