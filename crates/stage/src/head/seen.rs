//! What the camera sees of a head: its outside, its inside through openings, its outline, what is drawn on it and worn.

use super::HeadModel;
use super::layers::{DRESS, MeshLayers, SKIN, TIES, name_of};
use super::on_screen::{Corner, Part, Side};
use super::paint::HeadPaint;
use crate::painted::PaintedMesh;
use crate::preset::MeshSection;
use glam::Vec3;
use groom::{Cloth, Patch};
use hair_io::Mesh;
use rayon::prelude::*;
use render::{Coverage, Light, Surface};
use std::iter::once;
use stroke_path::Camera;

/// What of a head is told apart as a mesh of its own ([`Surface::mesh`]): itself, its clothes, ornaments, then painted meshes.
pub(crate) const MESHES: u32 = 256;
const CLOTHES: u32 = 1;
const ORNAMENTS: u32 = 2;
const PAINTED: u32 = 3;

/// How much nearer than a band hair must be to hide it, metres: next to nothing.
const BAND_MARGIN_M: f32 = 1e-5;

/// What the camera sees of the head: its outside, its inside through openings, its outline, what is drawn
/// on it.
pub(crate) fn surfaces(
    model: &HeadModel,
    paint: &HeadPaint,
    meshes: &[MeshSection],
    layers: &MeshLayers,
    camera: &Camera,
    light: &Light,
) -> Vec<Surface> {
    let HeadModel {
        mesh,
        body: _,
        facing,
        outline: _,
        clothes,
        skin,
        frame: _,
        shade,
        patches,
        scalp: [scalp, bare],
        ornaments,
        painted: _,
        skeleton: _,
        is_things: _,
    } = model;
    let facing = match facing.is_empty() {
        true => &mesh.normals,
        false => facing,
    };
    let occlusion = &shade[..];
    let is_flat = !model.is_painted();
    let corner = |(i, (position, facing)): (usize, (&Vec3, &Vec3))| Corner {
        view: camera.view_from_world(*position),
        tone: facing.dot(light.seen_from(*position).0)
            - paint.threshold
            - shade.get(i).copied().unwrap_or(0.0),
    };
    let corners = || -> Vec<Corner> {
        let all = mesh.positions.iter().zip(facing).enumerate().map(corner);
        match model.shows_mesh() {
            true => all.collect(),
            false => Vec::new(),
        }
    };
    let hull = || match is_flat && paint.width_m > 0.0 {
        true => hull(
            &mesh.positions,
            &mesh.normals,
            &model.outline,
            paint.width_m,
            camera,
        ),
        false => Vec::new(),
    };
    let (corners, hull) = rayon::join(corners, hull);
    let bare = match scalp.is_empty() {
        true => skin,
        false => bare,
    };
    let inside = Side::flat(paint.shadow, paint.inside_margin_m);
    let part = |triangles, light, shadow, mesh, layer, marks| Part {
        triangles,
        corners: &corners,
        front: Some(Side {
            light,
            shadow,
            margin_m: 0.0,
            layer,
            marks,
        }),
        back: Some(inside),
        mesh,
        picture: None,
        normals: facing,
        occlusion,
    };
    let (skin_layer, skin_marks) = (layers.of(&[SKIN]), layers.marks(&[SKIN]));
    let mut parts = Vec::new();
    if is_flat {
        parts.push(part(
            bare,
            paint.light,
            paint.shadow,
            0,
            skin_layer,
            skin_marks,
        ));
    }
    if is_flat && !scalp.is_empty() {
        parts.push(part(scalp, paint.scalp, paint.scalp, 0, None, skin_marks));
    }
    let (dress_layer, dress_marks) = (layers.of(&[DRESS]), layers.marks(&[DRESS]));
    for (cloth, triangles) in clothes {
        let [light, shadow, _] = paint.of_cloth(*cloth);
        parts.push(Part {
            back: Some(Side::flat(shadow, inside.margin_m)),
            ..part(triangles, light, shadow, CLOTHES, dress_layer, dress_marks)
        });
    }
    if is_flat && paint.width_m > 0.0 {
        let skin = once((Cloth::Skin, skin));
        let clothes = clothes.iter().map(|(cloth, triangles)| (*cloth, triangles));
        for (cloth, triangles) in skin.chain(clothes) {
            let is_skin = cloth == Cloth::Skin;
            let [.., line] = paint.of_cloth(cloth);
            parts.push(Part {
                triangles,
                corners: &hull,
                front: None,
                back: Some(Side::flat(line, -paint.outline_margin_m)),
                mesh: if is_skin { 0 } else { CLOTHES },
                picture: None,
                normals: &[],
                occlusion: &[],
            });
        }
    }
    let surfaces = parts.par_iter().flat_map_iter(|part| part.seen_by(camera));
    let mut surfaces: Vec<Surface> = surfaces.collect();
    if !ornaments.triangles.is_empty() {
        surfaces.extend(worn(ornaments, paint, layers, camera, light));
    }
    let center = model.frame.map_or(Vec3::ZERO, |head| head.center);
    let is_drawn = |patch: &&Patch| {
        let lit = |away: Vec3| away.dot(light.seen_from(center).0) >= paint.threshold;
        !patch.away_from.is_some_and(lit)
    };
    let painted = model.painted.par_iter().enumerate();
    let painted = painted.flat_map_iter(|(number, mesh)| {
        let number = PAINTED + number as u32;
        let number = number.min(MESHES - 1);
        painted_mesh(mesh, number, paint, meshes, layers, camera, light)
    });
    surfaces.par_extend(painted);
    surfaces.extend(patches.iter().filter(is_drawn).flat_map(|patch| {
        let corner = |position: &Vec3| Corner {
            view: camera.view_from_world(*position),
            tone: 0.0,
        };
        let corners: Vec<Corner> = patch.positions.iter().map(corner).collect();
        let layer = layers.of(&[name_of(patch.part)]);
        let normals = match layer {
            Some(_) => vec![normal_of(patch); patch.positions.len()],
            None => Vec::new(),
        };
        let part = Part {
            triangles: &patch.triangles,
            corners: &corners,
            front: Some(Side {
                layer,
                marks: layers.marks(&[name_of(patch.part)]),
                ..Side::flat(paint.of(patch.ink), 0.0)
            }),
            back: None,
            mesh: 0,
            picture: None,
            normals: &normals,
            occlusion: &[],
        };
        part.seen_by(camera)
    }));
    surfaces
}

/// What the camera sees of a mesh in its own colours that is no part of a head.
pub(crate) fn painted(
    mesh: &PaintedMesh,
    paint: &HeadPaint,
    layers: &MeshLayers,
    camera: &Camera,
    light: &Light,
) -> Vec<Surface> {
    painted_mesh(mesh, MESHES - 1, paint, &[], layers, camera, light)
}

/// The unit normal of a patch, which is nearly flat.
fn normal_of(patch: &Patch) -> Vec3 {
    let normals = patch.triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|i| patch.positions[i as usize]);
        (b - a).cross(c - a)
    });
    // Millimetres, or their squares would be too small.
    (normals.sum::<Vec3>() * 1e6).normalize_or(Vec3::Z)
}

/// A slightly larger mesh, whose inside is seen around the edges of the mesh itself; `widths` as in [`HeadModel`].
fn hull(
    positions: &[Vec3],
    normals: &[Vec3],
    widths: &[f32],
    width_m: f32,
    camera: &Camera,
) -> Vec<Corner> {
    let width = |i: usize| widths.get(i).copied().unwrap_or(1.0);
    positions
        .iter()
        .zip(normals)
        .enumerate()
        .map(|(i, (position, normal))| Corner {
            view: camera.view_from_world(*position + *normal * (width_m * width(i))),
            tone: 0.0,
        })
        .collect()
}

/// What is seen of a mesh in its own colours, whose number among the head's meshes that is.
fn painted_mesh(
    mesh: &PaintedMesh,
    number: u32,
    head: &HeadPaint,
    sections: &[MeshSection],
    layers: &MeshLayers,
    camera: &Camera,
    light: &Light,
) -> Vec<Surface> {
    let own = &mesh.paint;
    let section = mesh.section.and_then(|index| sections.get(index));
    let times = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|i| a[i] * b[i]);
    // Light, how much darker shadow is, line, and its width.
    let (tint, shade, line, width_m) = match section {
        Some(section) => {
            let width_m = section.width * head.unit_m;
            (section.color, [section.shade; 3], section.line, width_m)
        }
        None => {
            // What has no colour of its own is skin.
            let tint = own.color.map_or(head.light, |_| [1.0; 3]);
            (tint, head.shade(), head.line, head.width_m)
        }
    };
    let lit = times(own.color.unwrap_or([1.0; 3]), tint);
    let shadow = own.shade.map_or(times(lit, shade), |own| times(own, tint));
    let corner = |(position, normal): (&Vec3, &Vec3)| Corner {
        view: camera.view_from_world(*position),
        tone: normal.dot(light.seen_from(*position).0) - head.threshold,
    };
    let corners: Vec<Corner> = mesh
        .positions
        .iter()
        .zip(&mesh.normals)
        .map(corner)
        .collect();
    let front = Side {
        light: lit,
        shadow,
        margin_m: match mesh.is_cap {
            true => -head.outline_margin_m,
            false => 0.0,
        },
        layer: layers.of(&mesh.names),
        marks: layers.marks(&mesh.names),
    };
    let back = match (own.both_sides, section) {
        (true, _) => Some(front),
        // The character's own outline: what lies around her is seen past her edges alone.
        (false, None) if mesh.is_shell => None,
        // Seen through openings, as other heads' insides.
        (false, None) => Some(Side::flat(shadow, head.inside_margin_m)),
        (false, Some(_)) => None,
    };
    let part = Part {
        triangles: &mesh.triangles,
        corners: &corners,
        front: Some(front),
        back,
        mesh: number,
        picture: own
            .picture
            .as_ref()
            .map(|picture| (picture, &mesh.places[..])),
        normals: &mesh.normals,
        occlusion: &[],
    };
    let fill = || part.seen_by(camera).collect();
    let outline = || {
        if width_m <= 0.0 || mesh.is_shell || !own.has_outline() {
            return None;
        }
        let outline = Part {
            corners: &hull(&mesh.positions, &mesh.normals, &[], width_m, camera),
            front: None,
            back: Some(Side::flat(line, -head.outline_margin_m)),
            picture: part
                .picture
                .filter(|(picture, _)| picture.coverage != Coverage::Ignored),
            ..part
        };
        outline.seen_by(camera).next()
    };
    let (mut surfaces, outline): (Vec<Surface>, _) = rayon::join(fill, outline);
    surfaces.extend(outline);
    surfaces
}

/// What the hair wears. Hair goes by its depth alone here: what is in a band does not hide it.
pub(crate) fn worn(
    ornaments: &Mesh,
    paint: &HeadPaint,
    layers: &MeshLayers,
    camera: &Camera,
    light: &Light,
) -> Vec<Surface> {
    let corners: Vec<Corner> = ornaments
        .positions
        .iter()
        .zip(&ornaments.normals)
        .map(|(position, normal)| Corner {
            view: camera.view_from_world(*position),
            tone: normal.dot(light.seen_from(*position).0) - paint.threshold,
        })
        .collect();
    let ties = Part {
        triangles: &ornaments.triangles,
        corners: &corners,
        front: Some(Side {
            light: paint.tie,
            shadow: paint.tie_shadow,
            margin_m: BAND_MARGIN_M,
            layer: layers.of(&[TIES]),
            marks: layers.marks(&[TIES]),
        }),
        back: None,
        mesh: ORNAMENTS,
        picture: None,
        normals: &ornaments.normals,
        occlusion: &[],
    };
    let mut worn: Vec<Surface> = ties.seen_by(camera).collect();
    if paint.width_m > 0.0 {
        let outline = Part {
            corners: &hull(
                &ornaments.positions,
                &ornaments.normals,
                &[],
                paint.width_m,
                camera,
            ),
            front: None,
            back: Some(Side::flat(paint.line, BAND_MARGIN_M)),
            ..ties
        };
        worn.extend(outline.seen_by(camera));
    }
    worn
}
