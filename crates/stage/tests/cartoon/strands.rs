//! Strands as fine curves: what light there is on them, in double precision and without the renderer.

use super::shown::stage;
use glam::{DVec3, Vec2};
use render::Light;
use std::collections::BTreeMap;
use stroke_path::Camera;

/// A strand at places that are under a pixel apart.
#[derive(Default)]
pub struct Strand {
    /// Lengths up to there, head heights.
    pub s: Vec<f64>,
    /// In the picture, pixels.
    pub pixel: Vec<Vec2>,
    /// In the world, metres.
    pub position: Vec<DVec3>,
    /// The normals of C 5.4, of the strand's own direction there.
    pub normal: Vec<DVec3>,
    pub to_eye: Vec<DVec3>,
    pub to_light: Vec<DVec3>,
}

/// How many times as large the picture is of which strands are taken.
const FINER: u32 = 16;

/// The strands of a preset with these settings, by id, as they are in a picture of `camera`.
pub fn strands(text: &str, settings: &[(&str, &str)], camera: &Camera) -> BTreeMap<u32, Strand> {
    let [width, height] = camera.size_px().map(|side| side * FINER);
    let size = format!("({width}, {height})");
    let finer = [("path.subdivision", "64"), ("scene.size", &*size)];
    let mut stage = stage(text, &[settings, &finer].concat());
    let center_shift = 0.4;
    let frame = stage.frame().unwrap();
    let head = frame.objects[0].head;
    let center = head.center.as_dvec3();
    let eye = camera.eye().as_dvec3();
    let mut strands: BTreeMap<u32, Strand> = BTreeMap::new();
    for run in &frame.paths.runs {
        let info = &frame.strands[run.strand];
        let strand = strands.entry(info.id).or_default();
        let center = center.lerp(info.mean.as_dvec3(), center_shift);
        let place = |joint: usize| frame.paths.position[joint].as_dvec3();
        let last = run.joints.end - 1;
        for joint in run.joints.start + run.overlap..run.joints.end {
            let [before, after] = [joint.max(run.joints.start + 1) - 1, (joint + 1).min(last)];
            let tangent = (place(after) - place(before)).normalize();
            let outward = (place(joint) - center).normalize();
            let length = f64::from(frame.paths.arc_length[joint]);
            strand.s.push(length / f64::from(head.height_m));
            let view = camera.view_from_world(frame.paths.position[joint]);
            strand.pixel.push(camera.project(view));
            strand.position.push(place(joint));
            let normal = outward - outward.dot(tangent) * tangent;
            strand.normal.push(normal.normalize());
            strand.to_eye.push((eye - place(joint)).normalize());
            strand.to_light.push(match frame.light {
                Light::Direction(direction) => direction.as_dvec3().normalize(),
                Light::Point(lamp) => (lamp.as_dvec3() - place(joint)).normalize(),
            });
        }
    }
    strands
}

impl Strand {
    /// The number of the place at that length.
    pub fn at(&self, length: f32) -> usize {
        let before = self.s.partition_point(|other| *other < f64::from(length));
        before.min(self.s.len() - 1)
    }

    /// The place in the world at that length, metres.
    pub fn position_at(&self, length: f32) -> DVec3 {
        let after = self.at(length).max(1);
        let [from, to] = [self.s[after - 1], self.s[after]];
        let way = (f64::from(length) - from) / (to - from);
        self.position[after - 1].lerp(self.position[after], way)
    }

    /// How long the strand is in the picture from one place to another, pixels.
    pub fn pixels_between(&self, a: usize, b: usize) -> f32 {
        let links = self.pixel[a.min(b)..=a.max(b)].windows(2);
        links.map(|link| link[0].distance(link[1])).sum()
    }

    /// Blinn's highlight at a place: the cosine of the normal with the middle between light and eye.
    pub fn blinn(&self, place: usize) -> f64 {
        let half_way = (self.to_light[place] + self.to_eye[place]).normalize();
        self.normal[place].dot(half_way).max(0.0)
    }
}
