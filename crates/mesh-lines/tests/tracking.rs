//! Contours keep their names, and patterns on them their places.

mod shapes;

use glam::{DVec3, Vec3};
use mesh_lines::{Frame, Path, Surface, Tracker, View, contours, facing, visible};
use shapes::{Shape, bumpy, grid, sphere, torus};
use std::collections::HashMap;

/// 720 lines of 30 degrees.
const PIXEL: f64 = 1.0 / 1344.0;
const PERIOD_PX: f64 = 100.0;

fn step(tracker: &mut Tracker, shape: &Shape, positions: &[Vec3], eye: DVec3) -> Vec<Path> {
    let surface = Surface::new(&shape.topology, positions).unwrap();
    let view = View::perspective(eye.as_vec3()).unwrap();
    let facing = facing(&surface, &view);
    let lines = contours(&surface, &view, &facing).unwrap();
    let bvh = mesh_lines::Bvh::new(&surface);
    let spans = visible(&surface, &bvh, &view, &lines, PIXEL).unwrap();
    let frame = Frame {
        surface: &surface,
        view: &view,
        facing: &facing,
        lines: &lines,
        spans: &spans,
        pixel: PIXEL,
        period_px: PERIOD_PX,
    };
    tracker.step(&frame).unwrap().to_vec()
}

fn orbit(degrees: f64, distance: f64, height: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin * distance, height, cos * distance)
}

fn slopes(path: &Path) -> impl Iterator<Item = f64> {
    path.joints.windows(2).filter_map(|pair| {
        let px = pair[1].length_px - pair[0].length_px;
        (px > 1e-3).then(|| (pair[1].t - pair[0].t) * PERIOD_PX / px)
    })
}

#[test]
fn nothing_moves_while_nothing_moves() {
    let shape = torus([96, 64], 1.0, 0.35);
    let mut tracker = Tracker::default();
    let eye = DVec3::new(0.5, -4.0, 2.0);
    let first = step(&mut tracker, &shape, &shape.positions, eye);
    assert!(first.iter().all(|path| path.is_new));
    for _ in 0..5 {
        let next = step(&mut tracker, &shape, &shape.positions, eye);
        assert_eq!(next.len(), first.len());
        for (a, b) in first.iter().zip(&next) {
            assert_eq!((a.id, a.span, false), (b.id, b.span, b.is_new));
            for (p, q) in [0.0, 0.3, 0.7, 1.0].map(|share| (t_at(a, share), t_at(b, share))) {
                assert!((p - q).abs() * PERIOD_PX < 0.05, "{p} {q}");
            }
        }
    }
}

/// T at a share of a path's length.
fn t_at(path: &Path, share: f64) -> f64 {
    let [first, last] = [path.joints[0], path.joints[path.joints.len() - 1]];
    let s = first.length_px + (last.length_px - first.length_px) * share;
    let after = path
        .joints
        .iter()
        .position(|j| j.length_px >= s)
        .unwrap_or(path.joints.len() - 1)
        .max(1);
    let [a, b] = [path.joints[after - 1], path.joints[after]];
    a.t + (b.t - a.t) * (s - a.length_px) / (b.length_px - a.length_px)
}

#[test]
fn a_spheres_outline_keeps_its_name_all_around() {
    let shape = sphere(24, DVec3::ZERO, 1.0);
    let mut tracker = Tracker::default();
    let mut ids = Vec::new();
    for frame in 0..120 {
        let paths = step(
            &mut tracker,
            &shape,
            &shape.positions,
            orbit(f64::from(frame) * 1.5, 5.0, 1.0),
        );
        assert_eq!(paths.len(), 1, "frame {frame}");
        ids.push(paths[0].id);
        assert!(slopes(&paths[0]).all(|slope| (slope - 1.0).abs() < 0.5));
    }
    assert!(ids.iter().all(|id| *id == ids[0]));
}

/// What a sequence of frames is judged by.
struct Coherence {
    /// abs(dT) in pixels between a joint and the nearest point of the same path a frame later.
    drift: Vec<f64>,
    /// abs(T' / rho - 1) of each piece of a path.
    stretch: Vec<f64>,
    /// Pixels of paths that get new names after the first frame, and of all.
    born_px: f64,
    all_px: f64,
}

/// An eye that goes around a shape, half a degree a frame: once in half a minute.
fn orbited(shape: &Shape, frames: u32) -> Coherence {
    let mut tracker = Tracker::default();
    let mut last: HashMap<u64, Vec<[(DVec3, f64); 2]>> = HashMap::new();
    let mut result = Coherence {
        drift: Vec::new(),
        stretch: Vec::new(),
        born_px: 0.0,
        all_px: 0.0,
    };
    for frame in 0..frames {
        let mut now: HashMap<u64, Vec<[(DVec3, f64); 2]>> = HashMap::new();
        for path in step(
            &mut tracker,
            shape,
            &shape.positions,
            orbit(f64::from(frame) * 0.5, 5.0, 1.2),
        ) {
            result
                .stretch
                .extend(slopes(&path).map(|slope| (slope - 1.0).abs()));
            let length = path.joints[path.joints.len() - 1].length_px;
            result.all_px += length;
            if path.is_new && frame > 0 {
                result.born_px += length;
            }
            let pieces = path
                .joints
                .windows(2)
                .map(|pair| [0, 1].map(|i| (pair[i].position, pair[i].t)));
            now.entry(path.id).or_default().extend(pieces);
        }
        for (id, pieces) in &now {
            for [(point, t), _] in pieces {
                let before = last
                    .get(id)
                    .into_iter()
                    .flatten()
                    .map(|piece| nearest(piece, *point));
                if let Some((_, before)) = before
                    .min_by(|a, b| a.0.total_cmp(&b.0))
                    .filter(|found| found.0 < 0.02)
                {
                    result.drift.push((t - before).abs() * PERIOD_PX);
                }
            }
        }
        last = now;
    }
    result.drift.sort_by(f64::total_cmp);
    result.stretch.sort_by(f64::total_cmp);
    result
}

/// How far the nearest point of a piece of a path is, and T there.
fn nearest([(a, t), (b, u)]: &[(DVec3, f64); 2], point: DVec3) -> (f64, f64) {
    let way = *b - *a;
    let share = ((point - *a).dot(way) / way.length_squared().max(1e-30)).clamp(0.0, 1.0);
    (a.lerp(*b, share).distance(point), t + (u - t) * share)
}

#[test]
fn patterns_neither_slide_nor_stretch_on_an_orbit() {
    let shapes = [
        ("torus", torus([96, 64], 1.0, 0.35)),
        ("bumpy", bumpy(32)),
        ("sphere", sphere(32, DVec3::ZERO, 1.0)),
    ];
    for (name, shape) in shapes {
        let Coherence {
            drift,
            stretch,
            born_px,
            all_px,
        } = orbited(&shape, 96);
        let at = |list: &[f64], share: f64| list[((list.len() - 1) as f64 * share) as usize];
        let mean = stretch.iter().sum::<f64>() / stretch.len() as f64;
        let [median, most] = [0.5, 0.99].map(|share| at(&drift, share));
        let worst = at(&stretch, 0.99);
        assert!(median < 0.3 && most < 3.0, "{name}: drift {median} {most}");
        assert!(mean < 0.15 && worst < 0.5, "{name}: stretch {mean} {worst}");
        assert!(born_px < 0.005 * all_px, "{name}: born {born_px}");
    }
}

#[test]
fn a_mesh_that_moves_takes_its_pattern_along() {
    // It bends like a worm, before an eye that stays.
    let shape = torus([96, 64], 1.0, 0.35);
    let mut tracker = Tracker::default();
    let mut first = Vec::new();
    for frame in 0..40 {
        let swing = (frame as f32 * 0.1).sin() * 0.2;
        let positions: Vec<Vec3> = shape
            .positions
            .iter()
            .map(|p| *p + Vec3::Y * (swing * p.x * p.x))
            .collect();
        let paths = step(&mut tracker, &shape, &positions, DVec3::new(0.3, 1.0, 5.0));
        let mut ids: Vec<u64> = paths.iter().map(|path| path.id).collect();
        ids.sort_unstable();
        ids.dedup();
        if frame == 0 {
            first = ids;
        } else {
            assert_eq!(ids, first, "frame {frame}");
        }
    }
}

/// How long all of a path is, and what is drawn of it, pixels.
fn lengths_px(path: &Path) -> [f64; 2] {
    let length_at = |along: f64| {
        let after = path.joints.partition_point(|joint| joint.along < along);
        let after = after.clamp(1, path.joints.len() - 1);
        let [a, b] = [path.joints[after - 1], path.joints[after]];
        a.length_px + (b.length_px - a.length_px) * (along - a.along) / (b.along - a.along)
    };
    let ends = [
        path.joints[0].along,
        path.joints[path.joints.len() - 1].along,
    ];
    [ends, path.shown].map(|[from, to]| length_at(to) - length_at(from))
}

/// A sheet that lies before the eye, with a hill of this height.
fn hill(sheet: &Shape, height: f32) -> Vec<Vec3> {
    let up = |p: &Vec3| Vec3::Y * (height * (-2.0 * (p.x * p.x + p.z * p.z)).exp());
    sheet.positions.iter().map(|p| *p + up(p)).collect()
}

#[test]
fn a_line_from_nowhere_grows_from_two_pixels() {
    let sheet = grid([80, 80], [false, false], |u, v| {
        DVec3::new(4.0 * u - 2.0, 0.0, 2.0 - 4.0 * v)
    });
    let eye = DVec3::new(0.0, 2.0, 5.5);
    let mut tracker = Tracker::default();
    assert!(step(&mut tracker, &sheet, &sheet.positions, eye).is_empty());
    // All at once the sheet turns away from the eye behind the hill.
    let risen = hill(&sheet, 0.6);
    let mut at_once = None;
    let mut grown = 0;
    for frame in 0..12 {
        let paths = step(&mut tracker, &sheet, &risen, eye);
        assert_eq!(paths.len(), 1);
        let [whole, shown] = lengths_px(&paths[0]);
        assert!(whole > 100.0, "{whole}");
        assert_eq!(paths[0].is_new, frame == 0);
        assert!(!paths[0].is_revealed);
        let expected = whole.min(2.0 * f64::from(1 << frame));
        assert!(
            (shown - expected).abs() < 1e-6,
            "frame {frame}: {shown} of {whole}"
        );
        assert_eq!(tracker.is_growing(), shown < whole, "frame {frame}");
        grown += usize::from(shown < whole);
        if frame == 0 {
            let mut live = tracker.clone();
            live.finish();
            at_once = live.paths().first().map(lengths_px);
            assert!(!live.is_growing());
        }
    }
    assert!(grown > 4, "{grown}");
    assert!(at_once.is_some_and(|[whole, shown]| (whole - shown).abs() < 1e-9));
}

#[test]
fn a_line_that_is_uncovered_is_whole() {
    // A ball before another one goes aside.
    let (far, near) = (DVec3::new(0.0, 0.0, -1.0), DVec3::new(0.0, 0.0, 1.0));
    let shape = sphere(24, far, 0.5).and(sphere(24, near, 0.8));
    let moved = |frame: u32| -> Vec<Vec3> {
        let is_near = |p: &Vec3| p.as_dvec3().distance(near) < 0.9;
        let aside = |p: &Vec3| *p + Vec3::X * if is_near(p) { 0.17 * frame as f32 } else { 0.0 };
        shape.positions.iter().map(aside).collect()
    };
    let mut tracker = Tracker::default();
    let mut uncovered = 0;
    for frame in 0..8 {
        let shape = Shape::new(moved(frame), shape.topology.triangles());
        let paths = step(&mut tracker, &shape, &shape.positions, DVec3::Z * 9.0);
        for path in paths.iter().filter(|path| frame > 0 && path.is_new) {
            let [whole, shown] = lengths_px(path);
            assert!(path.is_revealed && whole > 4.0, "frame {frame}: {whole}");
            assert!(
                (whole - shown).abs() < 1e-9,
                "frame {frame}: {shown} of {whole}"
            );
            uncovered += 1;
        }
    }
    assert_eq!(uncovered, 1);
}
