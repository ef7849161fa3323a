//! What is seen, held against rays through the exact surfaces and through triangles one by one.

mod shapes;

use glam::{DVec3, Vec3};
use mesh_lines::{Bvh, Cut, Kind, Line, Span, View, is_seen, visible, visible_of};
use shapes::{Shape, bumpy, cube, cup, eyes, sphere, torus};

/// Length in the image of what two answers disagree about, and of all.
#[derive(Default)]
struct Tally {
    wrong: f64,
    all: f64,
}

impl Tally {
    /// Asks `oracle` at `samples` places a segment.
    fn add(
        &mut self,
        shape: &Shape,
        bvh: &Bvh,
        view: &View,
        samples: usize,
        mut oracle: impl FnMut(&Line, f64) -> Option<bool>,
    ) {
        let lines = shape.lines(view);
        let spans = visible(&shape.surface(), bvh, view, &lines, 0.0).unwrap();
        for (number, line) in lines.iter().enumerate() {
            let count = line.segments.len() as f64;
            let spans: Vec<_> = spans.iter().filter(|span| span.line == number).collect();
            for (segment, length) in line.image_lengths(view).into_iter().enumerate() {
                for sample in 0..samples {
                    let along = segment as f64 + (sample as f64 + 0.5) / samples as f64;
                    let Some(expected) = oracle(line, along) else {
                        continue;
                    };
                    let inside = |at: f64| {
                        spans
                            .iter()
                            .any(|span| (span.start..span.end).contains(&at))
                    };
                    let seen = inside(along) || (line.closed && inside(along + count));
                    self.all += length / samples as f64;
                    if seen != expected {
                        self.wrong += length / samples as f64;
                    }
                }
            }
        }
    }

    fn share(&self) -> f64 {
        self.wrong / self.all
    }
}

/// A solid as a function that is negative inside.
type Solid = dyn Fn(DVec3) -> f64;

fn in_torus(large: f64, small: f64) -> impl Fn(DVec3) -> f64 {
    move |p: DVec3| (p.truncate().length() - large).hypot(p.z) - small
}

/// True if a dense walk from a point on the surface to the eye comes through the solid.
fn is_hidden(solid: &Solid, point: DVec3, eye: DVec3) -> bool {
    let way = eye - point;
    let mut at = 0.0;
    // Distances are exact, so steps may be as long as they: at least a thousandth, at most where a tangent is.
    while at < 1.0 {
        let off = solid(point + way * at);
        if off < -1e-4 {
            return true;
        }
        at += (off / way.length()).max(5e-4);
    }
    false
}

/// The point of the exact contour that is nearest to a point of a mesh's: Newton's steps to where the distance and the angle to the eye are 0.
fn on_exact_contour(solid: &Solid, mut point: DVec3, eye: DVec3) -> DVec3 {
    let h = 1e-4;
    let gradient = |f: &dyn Fn(DVec3) -> f64, p: DVec3| {
        DVec3::from(
            [DVec3::X, DVec3::Y, DVec3::Z].map(|e| (f(p + e * h) - f(p - e * h)) / (2.0 * h)),
        )
    };
    let facing = |p: DVec3| gradient(solid, p).normalize().dot(eye - p);
    for _ in 0..4 {
        point -= gradient(solid, point) * solid(point);
        let slope = gradient(&facing, point);
        point -= slope * (facing(point) / slope.length_squared());
    }
    point
}

fn against_solid(shape: &Shape, solid: &Solid, near: f64, far: f64) -> f64 {
    let bvh = shape.bvh();
    let mut tally = Tally::default();
    for eye in eyes(24, near, far) {
        let view = View::perspective(eye.as_vec3()).unwrap();
        tally.add(shape, &bvh, &view, 1, |line, along| {
            let point = on_exact_contour(solid, line.position(along), eye);
            // Beside a cusp Newton may go elsewhere.
            let is_there = point.distance(line.position(along)) < 0.05;
            is_there.then(|| !is_hidden(solid, point, eye))
        });
    }
    tally.share()
}

#[test]
fn a_torus_is_hidden_where_the_exact_one_is() {
    let shape = torus([120, 80], 1.0, 0.35);
    let wrong = against_solid(&shape, &in_torus(1.0, 0.35), 2.0, 6.0);
    assert!(wrong < 0.001, "{wrong}");
}

#[test]
fn of_two_spheres_the_nearer_hides_the_farther() {
    let [a, b] = [DVec3::new(0.4, 0.1, -0.9), DVec3::new(-0.3, 0.0, 1.1)];
    let shape = sphere(32, a, 0.8).and(sphere(32, b, 1.0));
    let solid = move |p: DVec3| (p.distance(a) - 0.8).min(p.distance(b) - 1.0);
    let wrong = against_solid(&shape, &solid, 4.0, 9.0);
    assert!(wrong < 0.001, "{wrong}");
}

#[test]
fn edges_of_boxes_are_hidden_where_the_exact_ones_are() {
    let boxes = [
        [Vec3::new(-1.0, -1.0, -1.0), Vec3::new(0.5, -0.2, 0.7)],
        [Vec3::new(-0.3, -0.1, -0.6), Vec3::new(1.0, 1.1, 0.3)],
    ];
    let shape = cube(boxes[0][0], boxes[0][1])
        .and(cube(boxes[1][0], boxes[1][1]))
        .sharp();
    let solid = move |p: DVec3| {
        let off = boxes.map(|[low, high]| (low.as_dvec3() - p).max(p - high.as_dvec3()));
        off.map(|off| off.max(DVec3::ZERO).length() + off.max_element().min(0.0))
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    };
    let bvh = shape.bvh();
    let mut tally = Tally::default();
    for eye in eyes(64, 3.0, 8.0) {
        let view = View::perspective(eye.as_vec3()).unwrap();
        tally.add(&shape, &bvh, &view, 40, |line, along| {
            Some(!is_hidden(&solid, line.position(along), eye))
        });
    }
    assert!(tally.share() < 0.001, "{}", tally.share());
}

/// A closed line that begins at another of its points.
fn begun_at(line: &Line, first: usize) -> Line {
    let mut line = line.clone();
    line.points.rotate_left(first);
    line.segments.rotate_left(first);
    line
}

#[test]
fn what_is_seen_of_a_closed_line_is_the_same_wherever_it_begins() {
    let linked = torus([64, 40], 0.8, 0.25)
        .and(torus([64, 40], 0.8, 0.25).moved(|p| Vec3::new(p.x + 0.8, p.z, p.y)));
    let mut ends = 0;
    for shape in [bumpy(24), linked] {
        let (surface, bvh) = (shape.surface(), shape.bvh());
        for eye in eyes(12, 3.0, 8.0) {
            let view = View::perspective(eye.as_vec3()).unwrap();
            let lines = shape.lines(&view);
            // Without and with joining short pieces, of a pixel and of many.
            for shortest in [0.0, 1e-3, 0.05, 0.2] {
                let reference = visible(&surface, &bvh, &view, &lines, shortest).unwrap();
                for share in [0.13, 0.5, 0.71] {
                    let firsts: Vec<usize> = lines
                        .iter()
                        .map(|line| match line.closed {
                            true => (line.segments.len() as f64 * share) as usize,
                            false => 0,
                        })
                        .collect();
                    let turned: Vec<Line> = lines
                        .iter()
                        .zip(&firsts)
                        .map(|(line, &first)| begun_at(line, first))
                        .collect();
                    let spans = visible(&surface, &bvh, &view, &turned, shortest).unwrap();
                    assert_eq!(spans.len(), reference.len(), "{eye} {shortest}");
                    for expected in &reference {
                        let count = lines[expected.line].segments.len() as f64;
                        let first = firsts[expected.line] as f64;
                        // All around it begins anywhere.
                        let is_it = |span: &&Span| {
                            let off = (span.start + first - expected.start).rem_euclid(count);
                            let is_there = off.min(count - off) < 1e-6
                                && (span.end - span.start - expected.end + expected.start).abs()
                                    < 1e-6;
                            span.line == expected.line
                                && span.cuts == expected.cuts
                                && (is_there || span.cuts == [Cut::None; 2])
                        };
                        let found = spans.iter().filter(is_it).count();
                        assert_eq!(found, 1, "{eye} {shortest} {expected:?} {spans:?}");
                        ends += usize::from(expected.cuts != [Cut::None; 2]);
                    }
                }
            }
        }
    }
    assert!(ends > 500, "{ends}");
}

/// Also where what is seen of a closed line begins or ends beside its first point: borders that are moved to where rays change go over it.
#[test]
fn what_is_seen_of_a_closed_line_begins_on_it() {
    let linked = torus([64, 40], 0.8, 0.25)
        .and(torus([64, 40], 0.8, 0.25).moved(|p| Vec3::new(p.x + 0.8, p.z, p.y)));
    let (surface, bvh) = (linked.surface(), linked.bvh());
    let mut borders = 0;
    for eye in eyes(24, 3.0, 8.0) {
        let view = View::perspective(eye.as_vec3()).unwrap();
        let lines = linked.lines(&view);
        for seen in visible(&surface, &bvh, &view, &lines, 0.0).unwrap() {
            let line = &lines[seen.line];
            let count = line.segments.len();
            if !line.closed || seen.cuts == [Cut::None; 2] {
                continue;
            }
            for border in [seen.start, seen.end] {
                borders += 1;
                for before in 0..4 {
                    let first = (border as usize + count - before + 2) % count;
                    let begun = [begun_at(line, first)];
                    let spans = visible(&surface, &bvh, &view, &begun, 0.0).unwrap();
                    let mut last = 0.0;
                    for span in spans {
                        assert!(span.start >= last && span.start <= count as f64, "{span:?}");
                        assert!(span.end <= span.start + count as f64, "{span:?} of {count}");
                        last = span.start;
                    }
                }
            }
        }
    }
    assert!(borders > 100, "{borders}");
}

#[test]
fn pieces_agree_with_a_ray_for_each_place() {
    let cubes = cube(Vec3::new(-1.0, -1.0, -1.0), Vec3::new(0.5, -0.2, 0.7))
        .and(cube(Vec3::new(-0.4, -0.1, -0.6), Vec3::new(1.0, 1.1, 0.3)).moved(turned));
    let linked = torus([64, 40], 0.8, 0.25)
        .and(torus([64, 40], 0.8, 0.25).moved(|p| Vec3::new(p.x + 0.8, p.z, p.y)));
    let shapes = [
        ("torus", torus([80, 48], 1.0, 0.4)),
        (
            "spheres",
            sphere(24, DVec3::X, 0.9).and(sphere(24, -DVec3::X, 0.8)),
        ),
        ("cup", cup(60, 30)),
        ("cubes", cubes.sharp()),
        ("bumpy", bumpy(32)),
        ("linked", linked),
        (
            "through each other",
            sphere(40, DVec3::ZERO, 1.0).and(torus([128, 80], 0.8, 0.35).moved(turned)),
        ),
        (
            "box in a ball",
            sphere(20, DVec3::ZERO, 1.0)
                .and(cube(Vec3::splat(-0.2), Vec3::splat(0.9)))
                .sharp(),
        ),
    ];
    for (name, shape) in shapes {
        let bvh = shape.bvh();
        let surface = shape.surface();
        let mut tally = Tally::default();
        for eye in eyes(64, 3.0, 8.0) {
            let view = View::perspective(eye.as_vec3()).unwrap();
            // Edges of a cube are one segment each.
            let samples = if name.contains("cube") || name.contains("box") {
                60
            } else {
                2
            };
            tally.add(&shape, &bvh, &view, samples, |line, along| {
                Some(is_seen(&surface, &bvh, &view, line, along))
            });
        }
        assert!(tally.share() < 0.001, "{name}: {}", tally.share());
    }
}

/// The smooth surface of a coarse ring is far off its triangles: beyond the skin of the ball that it lies in.
#[test]
fn a_coarse_ring_in_a_ball_is_hidden_by_it() {
    let ball = 1.0;
    let shape = sphere(32, DVec3::ZERO, ball).and(torus([8, 4], 0.9, 0.08).moved(turned));
    let (surface, bvh) = (shape.surface(), shape.bvh());
    let (mut inside, mut outside) = (0, 0);
    for eye in eyes(64, 3.0, 8.0) {
        let view = View::perspective(eye.as_vec3()).unwrap();
        let lines = shape.lines(&view);
        for span in visible(&surface, &bvh, &view, &lines, 0.0).unwrap() {
            let point = lines[span.line].position(0.5 * (span.start + span.end));
            match point.length() < 0.985 * ball {
                true => inside += 1,
                false => outside += 1,
            }
        }
    }
    assert_eq!(inside, 0, "seen through the ball");
    // Its own outline is there.
    assert!(outside >= 64, "{outside}");
}

fn turned(p: Vec3) -> Vec3 {
    glam::Quat::from_rotation_y(0.7) * glam::Quat::from_rotation_x(0.3) * p
}

/// Where lines cross is where a coarse mesh's triangles hide only about: what is seen ends where rays change, to a quarter of a segment.
#[test]
fn what_is_seen_ends_where_rays_change() {
    let linked = torus([32, 20], 0.8, 0.25)
        .and(torus([32, 20], 0.8, 0.25).moved(|p| Vec3::new(p.x + 0.8, p.z, p.y)));
    for (name, shape) in [
        ("cup", cup(40, 20)),
        ("bumpy", bumpy(16)),
        ("linked", linked),
    ] {
        let (surface, bvh) = (shape.surface(), shape.bvh());
        let (mut ends, mut wrong) = (0, 0);
        for eye in eyes(64, 3.0, 8.0) {
            let view = View::perspective(eye.as_vec3()).unwrap();
            let lines = shape.lines(&view);
            for span in visible(&surface, &bvh, &view, &lines, 0.0).unwrap() {
                let line = &lines[span.line];
                let sees = |along: f64| is_seen(&surface, &bvh, &view, line, along);
                let sides = [(span.start, -0.25), (span.end, 0.25)];
                for ((end, out), cut) in sides.into_iter().zip(span.cuts) {
                    let is_within = line.closed || end + out < line.segments.len() as f64;
                    if cut == Cut::Hidden && is_within && span.end - span.start > 2.0 {
                        ends += 1;
                        let around = if line.closed {
                            line.segments.len() as f64
                        } else {
                            0.0
                        };
                        wrong += usize::from(!sees(end - out) || sees(end + out + around));
                    }
                }
            }
        }
        assert!(ends > 50, "{name}: {ends}");
        assert_eq!(wrong, 0, "{name}: of {ends}");
    }
}

/// Lines that nobody asks for go on to hide others.
#[test]
fn what_is_seen_of_some_lines_is_what_is_seen_of_them_among_all() {
    let linked = cube(Vec3::splat(-0.7), Vec3::splat(0.5)).and(bumpy(16));
    for shape in [cup(24, 12), linked] {
        let (surface, bvh) = (shape.surface(), shape.bvh());
        for eye in eyes(6, 3.0, 8.0) {
            let view = View::perspective(eye.as_vec3()).unwrap();
            let lines = shape.lines(&view);
            let all = visible(&surface, &bvh, &view, &lines, 1e-3).unwrap();
            for kind in [Kind::Contour, Kind::Crease, Kind::Border] {
                let is_it = |line: &Line| line.kind == kind;
                let some = visible_of(&surface, &bvh, &view, &lines, is_it, 1e-3).unwrap();
                let mut expected = all.clone();
                expected.retain(|span| is_it(&lines[span.line]));
                assert_eq!(some, expected, "{eye} {kind:?}");
            }
        }
    }
}
