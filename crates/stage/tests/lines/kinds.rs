//! Which lines there are on a ball and a box, where they lie, what hides them, and mistakes.

use super::*;

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
    let mut without = stage("a", "", "").unwrap();
    let without = drawn(&without.frame().unwrap()).pixels;
    let of_no_width = ["ink", "chalk"].map(|kind| {
        format!("(effect: \"line.{kind}\", on: \"rim\", params: (width: 0, wobble: 0.5))")
    });
    for layers in ["", &of_no_width[0], &of_no_width[1]] {
        let mut with = stage("a", lines, layers).unwrap();
        let with = with.frame().unwrap();
        assert_eq!(with.objects.len(), 1, "{layers}");
        assert!(with.from_ends.is_empty() && with.rest_positions.is_empty());
        assert_eq!(drawn(&with).pixels, without);
    }
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
