//! What samples tell beside their colour.

use crate::candidates::{Candidates, Hair, Shown};
use crate::triangle::Triangle;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use render::{Drawing, DrawnFeatures, Feature, NO_ID, Sample, object_of_hair, object_of_mesh};

/// What the sample at `position` in each pixel tells, row by row, from 0 to 1 on both axes with y down. All features that the drawing has
/// lists for are worked out, whatever is declared. `shown_reach` is the part of their reach in which it shows decals ([`render::shown_reach`]).
///
/// # Panics
///
/// As [`picture_at`](crate::picture_at), and where a run has no information.
pub fn samples_at(drawing: &Drawing, position: DVec2, shown_reach: f32) -> Vec<Sample> {
    let [width, height] = drawing.size;
    let scene = Candidates::new(drawing);
    let rows = (0..height).into_par_iter().flat_map_iter(|y| {
        let corner = DVec2::new(0.0, f64::from(y));
        let scene = scene.within(corner, corner + DVec2::new(f64::from(width), 1.0));
        let row: Vec<Sample> = (0..width)
            .map(|x| {
                sample(
                    drawing,
                    &scene,
                    position + DVec2::new(f64::from(x), corner.y),
                    shown_reach,
                )
            })
            .collect();
        row
    });
    rows.collect()
}

fn sample(drawing: &Drawing, scene: &Candidates, point: DVec2, shown_reach: f32) -> Sample {
    let color = scene
        .color(point, shown_reach)
        .map_or([0.0; 4], |[red, green, blue]| {
            [red, green, blue, 1.0].map(|value| value.clamp(0.0, 1.0) as f32)
        });
    match scene.shown(point) {
        Shown::Nothing => Sample {
            color,
            ..Sample::NOTHING
        },
        Shown::Mesh(hit, triangle) => Sample {
            object: object_of_mesh(triangle.mesh),
            inv_depth: hit.inv_depth as f32,
            normal: normal_of_mesh(drawing, triangle).as_vec3(),
            color,
            ..Sample::NOTHING
        },
        Shown::Hair(hair) => sample_of_hair(drawing, &hair, point, color),
    }
}

fn normal_of_mesh(drawing: &Drawing, triangle: &Triangle) -> DVec3 {
    let Some(camera) = &drawing.features.camera else {
        return DVec3::ZERO;
    };
    let [width, height] = drawing.size.map(f64::from);
    let normal = triangle.normal(DVec2::new(width, height) / 2.0, camera.focal_px().into());
    camera
        .world_from_view_direction(normal.as_vec3())
        .as_dvec3()
}

fn sample_of_hair(drawing: &Drawing, hair: &Hair, point: DVec2, color: [f32; 4]) -> Sample {
    let features = &drawing.features;
    let (joints, way, v) = hair.place(point);
    let w = hair.across_clump(point, v);
    let is_of_run = |run: &render::Run| run.joints.contains(&joints[0]);
    let run = drawing.runs.iter().position(is_of_run);
    let info = run.map(|run| features.runs[run]);
    let mixed = |list: &[f32]| match list.is_empty() {
        true => 0.0,
        false => {
            let [a, b] = joints.map(|joint| f64::from(list[joint]));
            (a + way * (b - a)) as f32
        }
    };
    Sample {
        object: info.map_or(0, |info| object_of_hair(info.object)),
        strand: info.map_or(NO_ID, |info| info.strand),
        piece: run.map_or(NO_ID, |run| drawing.runs[run].strand),
        layer: hair.layer() as u32,
        level: info.map_or(NO_ID, |info| info.level),
        inv_depth: hair.depth.inv_depth as f32,
        u: mixed(&features.u),
        s: mixed(&features.s),
        v: v as f32,
        w: w as f32,
        pixels: mixed(&features.pixels),
        normal: normal_of_hair(features, joints, way, w).as_vec3(),
        color,
    }
}

/// Between the clump's normal and that of a round tube.
fn normal_of_hair(features: &DrawnFeatures, joints: [usize; 2], way: f64, w: f64) -> DVec3 {
    let Some(camera) = &features.camera else {
        return DVec3::ZERO;
    };
    if !features.declared.has(Feature::Normal) {
        return DVec3::ZERO;
    }
    let mixed = |list: &[glam::Vec3]| {
        let [a, b] = joints.map(|joint| list[joint].as_dvec3());
        a.lerp(b, way)
    };
    let clump = mixed(&features.normal);
    let forward = mixed(&features.forward);
    let to_eye = camera.eye().as_dvec3() - mixed(&features.position);
    let across = forward.cross(to_eye).normalize_or_zero();
    let facing = across.cross(forward).normalize_or_zero();
    let tube = match across == DVec3::ZERO || facing == DVec3::ZERO {
        true => clump,
        false => w * across + (1.0 - w * w).max(0.0).sqrt() * facing,
    };
    let normal = clump.lerp(tube, features.roundness.into());
    normal.normalize_or(tube)
}
