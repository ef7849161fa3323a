//! Lines of meshes from frame to frame: how far a pattern along them slides, how far it is stretched, and which lines come from nowhere.

use crate::BenchError;
use crate::lines::pixel;
use crate::lines::subjects::Subject;
use crate::results::Row;
use crate::targets::{Found, Limit, Target};
use glam::{DVec3, Quat, Vec3};
use mesh_lines::{
    Bvh, Frame, Line, MeshError, Path, Place, REACH_PX, Ray, Surface, Tracker, View, facing,
    visible, walk_to_zero,
};
use stage::{ThingChoice, thing_mesh};
use std::fmt::Write as _;

const FPS: f64 = 24.0;
const LINES: usize = 720;
/// Pixels a period.
const PERIOD_PX: f64 = 100.0;
/// What is drawn longer than this in its first frame is seen to come from nowhere, unless something uncovered it.
const BORN_PX: f64 = 4.0;
/// Of a line that something uncovered at least this share was there in the frame before, hidden.
const UNCOVERED_SHARE: f64 = 0.5;
/// Of all joints of a path one in so many is a sample.
const SOME: usize = 3;

/// What gives a place along a line its coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// `mesh_lines::Tracker`.
    Tracker,
    /// The length from where a line begins.
    ArcLength,
    /// What was there in the frame before, and nothing else.
    Votes,
}

/// What was found in a scene.
pub struct LineFigures {
    /// Its name.
    pub scene: &'static str,
    /// What gives the coordinate.
    pub method: Method,
    /// abs(dT) in pixels between a sample and where it comes to in 1/24 s: median, 99 %.
    pub drift: [f64; 2],
    /// abs(T' / rho - 1): mean, 99 %.
    pub stretch: [f64; 2],
    /// Lines that are born longer than 4 pixels, and those that are as long as what was before them has moved away; nothing where lines have no names.
    pub births: Option<[usize; 2]>,
    /// Samples that were matched.
    pub matched: usize,
}

/// A joint of a line with its coordinate.
#[derive(Clone, Copy)]
struct Sample {
    place: Place,
    position: DVec3,
    length_px: f64,
    t: f64,
}

/// A line of a frame.
struct Stroke {
    id: Option<u64>,
    samples: Vec<Sample>,
}

/// What an eye saw of a mesh in a frame.
struct Before<'f> {
    surface: Surface<'f>,
    bvh: &'f Bvh,
    view: View,
}

impl Before<'_> {
    /// Whether most of a path of the next frame was there, behind something: by a ray for each joint, from the contour that was nearest to it.
    fn hid(&self, path: &Path, line: &Line, now: &Surface) -> bool {
        let values = facing(&self.surface, &self.view);
        let triangles = self.surface.topology().triangles();
        let is_hidden = |joint: &&mesh_lines::PathJoint| {
            let place = line.place(now, joint.along);
            let reach = REACH_PX * pixel(LINES);
            let before = walk_to_zero(&self.surface, &values, &self.view, place, reach);
            before.is_some_and(|before| {
                let corners = triangles[before.triangle as usize];
                let is_around = |t: u32| triangles[t as usize].iter().any(|v| corners.contains(v));
                // From where the smooth surface is, before its triangles.
                let off = 2.0 * self.surface.sagitta(before.triangle);
                let start = self.surface.point(before) + self.surface.normal(before) * off;
                let ray = Ray::to_eye(start, &self.view);
                self.bvh.is_blocked(&self.surface, &ray, is_around)
            })
        };
        let hidden = path.joints.iter().filter(is_hidden).count();
        hidden as f64 >= UNCOVERED_SHARE * path.joints.len() as f64
    }
}

/// A mesh that moves, or an eye that does.
struct Scene {
    name: &'static str,
    subject: Subject,
    positions: fn(&Subject, f64) -> Vec<Vec3>,
    eye: fn(&Subject, f64) -> DVec3,
}

fn around(subject: &Subject, degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    subject.middle + 4.2 * subject.radius * DVec3::new(sin, 0.35, cos)
}

fn scenes() -> Result<Vec<Scene>, MeshError> {
    Ok(vec![
        Scene {
            name: "cup-orbit",
            subject: Subject::thing(ThingChoice::Cup)?,
            positions: |subject, _| subject.positions.clone(),
            // Once around in half a minute.
            eye: |subject, time| around(subject, 12.0 * time),
        },
        Scene {
            name: "wings",
            subject: Subject::thing(ThingChoice::Wings)?,
            positions: |_, time| thing_mesh(ThingChoice::Wings, time - time.floor()).0,
            eye: |subject, _| around(subject, 35.0),
        },
        Scene {
            name: "bust-walk",
            subject: Subject::bust()?,
            positions: |subject, time| {
                let (sway, _) = (std::f64::consts::TAU * 0.95 * time).sin_cos();
                let (bob, _) = (std::f64::consts::TAU * 1.9 * time).sin_cos();
                let turn = Quat::from_rotation_y(0.07 * sway as f32)
                    * Quat::from_rotation_z(0.03 * sway as f32);
                let middle = subject.middle.as_vec3();
                let up = Vec3::Y * (0.02 * subject.radius * bob) as f32;
                let moved = |p: &Vec3| turn * (*p - middle) + middle + up;
                subject.positions.iter().map(moved).collect()
            },
            eye: |subject, _| around(subject, 25.0),
        },
    ])
}

/// Measures each scene by each method.
///
/// # Errors
///
/// When a mesh isn't one.
pub fn measure(quick: bool, only: &str) -> Result<Vec<LineFigures>, BenchError> {
    let frames = if quick { 24 } else { 96 };
    let fault = |error: MeshError| error.to_string();
    let mut figures = Vec::new();
    for scene in scenes().map_err(fault)? {
        if !scene.name.contains(only) {
            continue;
        }
        for method in [Method::Tracker, Method::ArcLength, Method::Votes] {
            figures.push(scene.measure(method, frames).map_err(fault)?);
        }
    }
    Ok(figures)
}

impl Scene {
    fn measure(&self, method: Method, frames: u32) -> Result<LineFigures, MeshError> {
        let first = (self.positions)(&self.subject, 0.0);
        let mut bvh = Bvh::new(&self.subject.surface(&first)?);
        let mut bvh_before = bvh.clone();
        let mut places_before = first;
        let mut tracker = Tracker::default();
        let (mut drift, mut stretch) = (Vec::new(), Vec::new());
        let (mut births, mut before) = ([0; 2], Vec::<Stroke>::new());
        for frame in 0..frames {
            let time = f64::from(frame) / FPS;
            let positions = (self.positions)(&self.subject, time);
            let surface = self.subject.surface(&positions)?;
            std::mem::swap(&mut bvh, &mut bvh_before);
            bvh.refit(&surface);
            let view = View::perspective((self.eye)(&self.subject, time).as_vec3())?;
            // Creases and borders hide contours, and have places of their own.
            let (lines, facing) = self.subject.lines(&surface, &view)?;
            let spans = visible(&surface, &bvh, &view, &lines, pixel(LINES))?;
            let paths = tracker.step(&Frame {
                surface: &surface,
                view: &view,
                facing: &facing,
                lines: &lines,
                spans: &spans,
                pixel: pixel(LINES),
                period_px: PERIOD_PX,
            })?;
            let mut now: Vec<Stroke> = paths
                .iter()
                .map(|path| {
                    let line = &lines[spans[path.span].line];
                    stroke(path, |along| line.place(&surface, along))
                })
                .collect();
            if frame > 0 {
                let earlier = f64::from(frame - 1) / FPS;
                let seen = Before {
                    surface: self.subject.surface(&places_before)?,
                    bvh: &bvh_before,
                    view: View::perspective((self.eye)(&self.subject, earlier).as_vec3())?,
                };
                let is_long = |path: &&Path| path.is_new && path.shown_px() > BORN_PX;
                for path in paths.iter().filter(is_long) {
                    let line = &lines[spans[path.span].line];
                    births[usize::from(seen.hid(path, line, &surface))] += 1;
                }
            }
            match method {
                Method::Tracker => {}
                Method::ArcLength => now.iter_mut().for_each(by_length),
                Method::Votes => now.iter_mut().for_each(|stroke| {
                    by_length(stroke);
                    by_votes(stroke, &before, &surface, &view);
                }),
            }
            for (old, sample) in before
                .iter()
                .flat_map(|old| old.samples.iter().step_by(SOME).map(move |s| (old, s)))
            {
                let place = surface.point(sample.place);
                let own = now
                    .iter()
                    .filter(|stroke| method != Method::Tracker || stroke.id == old.id);
                if let Some((off, t)) = nearest(own, place)
                    && off * view.image_scale(place) / pixel(LINES) < REACH_PX
                {
                    drift.push((t - sample.t).abs() * PERIOD_PX);
                }
            }
            for pair in now.iter().flat_map(|stroke| stroke.samples.windows(2)) {
                let px = pair[1].length_px - pair[0].length_px;
                if px > 0.2 {
                    stretch.push(((pair[1].t - pair[0].t) * PERIOD_PX / px - 1.0).abs());
                }
            }
            before = now;
            places_before = positions;
        }
        drift.sort_by(f64::total_cmp);
        stretch.sort_by(f64::total_cmp);
        let at = |list: &[f64], share: f64| {
            let last = list.len().saturating_sub(1) as f64;
            list.get((last * share) as usize)
                .copied()
                .unwrap_or(f64::NAN)
        };
        Ok(LineFigures {
            scene: self.name,
            method,
            drift: [at(&drift, 0.5), at(&drift, 0.99)],
            stretch: [
                stretch.iter().sum::<f64>() / stretch.len().max(1) as f64,
                at(&stretch, 0.99),
            ],
            births: (method == Method::Tracker).then_some(births),
            matched: drift.len(),
        })
    }
}

fn stroke(path: &Path, place: impl Fn(f64) -> Place) -> Stroke {
    let sample = |joint: &mesh_lines::PathJoint| Sample {
        place: place(joint.along),
        position: joint.position,
        length_px: joint.length_px,
        t: joint.t,
    };
    Stroke {
        id: Some(path.id),
        samples: path.joints.iter().map(sample).collect(),
    }
}

/// T from the length along the whole piece that is seen.
fn by_length(stroke: &mut Stroke) {
    stroke
        .samples
        .iter_mut()
        .for_each(|sample| sample.t = sample.length_px / PERIOD_PX);
}

/// T from the nearest place of the frame before, where it has come to; what has none keeps its own.
fn by_votes(stroke: &mut Stroke, before: &[Stroke], surface: &Surface, view: &View) {
    let moved: Vec<Stroke> = before
        .iter()
        .map(|old| Stroke {
            id: old.id,
            samples: old
                .samples
                .iter()
                .map(|sample| Sample {
                    position: surface.point(sample.place),
                    ..*sample
                })
                .collect(),
        })
        .collect();
    for sample in &mut stroke.samples {
        if let Some((off, t)) = nearest(moved.iter(), sample.position)
            && off * view.image_scale(sample.position) / pixel(LINES) < REACH_PX
        {
            sample.t = t;
        }
    }
}

/// How far the nearest place of strokes is, and T there.
fn nearest<'s>(strokes: impl Iterator<Item = &'s Stroke>, point: DVec3) -> Option<(f64, f64)> {
    let pieces = strokes.flat_map(|stroke| stroke.samples.windows(2));
    let found = pieces.map(|pair| {
        let [a, b] = [pair[0], pair[1]];
        let way = b.position - a.position;
        let share = (point - a.position).dot(way) / way.length_squared().max(1e-30);
        let share = share.clamp(0.0, 1.0);
        let there = a.position.lerp(b.position, share);
        (there.distance(point), a.t + (b.t - a.t) * share)
    });
    found.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// What the tracker is held to.
#[must_use]
pub fn targets(figures: &[LineFigures]) -> Vec<Target> {
    let own = figures.iter().filter(|of| of.method == Method::Tracker);
    let of_scene = |of: &LineFigures| {
        let at_most = |what: &str, found: f64, limit: f64| Target {
            text: format!("{}: {what}", of.scene),
            found: Some(Found::Is(found)),
            limit: Limit::AtMost(limit),
        };
        [
            at_most("drift of marks, median, px", of.drift[0], 0.3),
            at_most("drift of marks, 99 %, px", of.drift[1], 3.0),
            at_most("stretch of marks, mean", of.stretch[0], 0.15),
            at_most("stretch of marks, 99 %", of.stretch[1], 0.5),
            at_most(
                "lines born longer than 4 px",
                of.births.map_or(0, |[born, _]| born) as f64,
                0.0,
            ),
        ]
    };
    own.flat_map(of_scene).collect()
}

/// The rows of the suite's file.
#[must_use]
pub fn rows(figures: &[LineFigures]) -> Vec<Row> {
    let of_scene = |of: &LineFigures| {
        let row = |measure: &str, error: f64| Row {
            scene: of.scene.to_owned(),
            method: format!("{}-{measure}", of.method.name()),
            knob: LINES,
            seconds: 0.0,
            error: Some(error),
        };
        let mut rows = vec![
            row("drift-median", of.drift[0]),
            row("drift-99", of.drift[1]),
            row("stretch-mean", of.stretch[0]),
            row("stretch-99", of.stretch[1]),
        ];
        if let Some([born, uncovered]) = of.births {
            rows.push(row("births", born as f64));
            rows.push(row("uncovered", uncovered as f64));
        }
        rows
    };
    figures.iter().flat_map(of_scene).collect()
}

/// A table to read, in Markdown.
#[must_use]
pub fn summary(figures: &[LineFigures]) -> String {
    let mut text = String::from(
        "| lines | by | drift, median, px | 99 % | stretch, mean | 99 % | born > 4 px | uncovered | samples |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for of in figures {
        let births = of
            .births
            .map(|births| births.map(|count| count.to_string()));
        let [born, uncovered] = births.unwrap_or_default();
        let _ = writeln!(
            text,
            "| {} | {} | {:.3} | {:.2} | {:.3} | {:.2} | {born} | {uncovered} | {} |",
            of.scene,
            of.method.name(),
            of.drift[0],
            of.drift[1],
            of.stretch[0],
            of.stretch[1],
            of.matched
        );
    }
    text
}

impl Method {
    /// Its name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tracker => "tracker",
            Self::ArcLength => "arc-length",
            Self::Votes => "votes",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The measures are measured: what they are for is found in the controls.
    #[test]
    fn controls_slide_or_stretch() {
        let scenes = scenes().unwrap();
        let cup = &scenes[0];
        let [tracked, by_length, votes] = [Method::Tracker, Method::ArcLength, Method::Votes]
            .map(|method| cup.measure(method, 8).unwrap());
        assert!(tracked.matched > 100, "{}", tracked.matched);
        assert!(tracked.drift[0] < 0.3, "{:?}", tracked.drift);
        assert!(
            by_length.drift[1] > tracked.drift[1],
            "{:?} {:?}",
            by_length.drift,
            tracked.drift
        );
        assert!(by_length.stretch[1] < 1e-6, "{:?}", by_length.stretch);
        assert!(
            votes.drift[0] <= by_length.drift[0] + 1e-9,
            "{:?}",
            votes.drift
        );
        assert!(
            votes.stretch[1] > by_length.stretch[1],
            "{:?}",
            votes.stretch
        );
    }

    /// Wings' feathers get contours all at once: those grow. What a wing uncovers was there.
    #[test]
    fn lines_grow_or_are_uncovered() {
        let scenes = scenes().unwrap();
        let found = scenes[1].measure(Method::Tracker, 25).unwrap();
        let [born, uncovered] = found.births.unwrap();
        assert_eq!(born, 0);
        assert!(uncovered > 0);
    }
}
