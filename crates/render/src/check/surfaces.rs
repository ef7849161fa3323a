//! What surfaces must be.

use super::{DrawError, MAX_COORDINATE, MAX_PLACE, first_that_is_not, is_finite};
use crate::drawing::{Coverage, Surface, SurfaceTexture, SurfaceVertex};
use crate::mesh_paint::SurfacePaint;
use glam::{Vec2, Vec3};

/// Looks at every number of the surfaces.
pub(crate) fn check_surfaces(surfaces: &[Surface], mesh_layers: usize) -> Result<(), DrawError> {
    for (index, surface) in surfaces.iter().enumerate() {
        if let Some(paint) = &surface.paint {
            check_paint(index, paint, surface.vertices.len(), mesh_layers)?;
        }
        check_surface(index, surface)?;
    }
    let triangles = surfaces.iter().map(|s| s.triangles.len()).sum();
    if u32::try_from(triangles).is_err() {
        return Err(DrawError::TriangleCount(triangles));
    }
    Ok(())
}

fn check_surface(index: usize, surface: &Surface) -> Result<(), DrawError> {
    if !is_finite(&surface.light) || !is_finite(&surface.shadow) {
        return Err(DrawError::SurfaceColor { surface: index });
    }
    if !surface.margin_m.is_finite() {
        return Err(DrawError::Margin {
            surface: index,
            margin_m: surface.margin_m,
        });
    }
    if let Some(vertex) = first_that_is_not(&surface.vertices, is_vertex) {
        return Err(DrawError::Vertex {
            surface: index,
            vertex,
        });
    }
    let vertices = surface.vertices.len();
    if let Some(texture) = &surface.texture {
        check_texture(index, texture, vertices)?;
    }
    let is_there = |corner: u32| (corner as usize) < vertices;
    let is_triangle = |&[a, b, c]: &[u32; 3]| is_there(a) & is_there(b) & is_there(c);
    if let Some(triangle) = first_that_is_not(&surface.triangles, is_triangle) {
        let corners = surface.triangles[triangle];
        let vertex = corners.into_iter().find(|corner| !is_there(*corner));
        return Err(DrawError::TriangleIndex {
            surface: index,
            triangle,
            vertex: vertex.unwrap_or_default(),
            vertices,
        });
    }
    Ok(())
}

fn check_paint(
    surface: usize,
    paint: &SurfacePaint,
    vertices: usize,
    layers: usize,
) -> Result<(), DrawError> {
    let SurfacePaint {
        layer,
        normals,
        occlusion,
    } = paint;
    if *layer as usize >= layers {
        return Err(DrawError::SurfaceLayer {
            surface,
            layer: *layer,
            layers,
        });
    }
    let is_list = normals.len() == vertices && [0, vertices].contains(&occlusion.len());
    let is_normal = |normal: &Vec3| normal.is_finite() & (normal.length_squared() < 2.0);
    let is_share = |share: &f32| (0.0..=1.0).contains(share);
    if !is_list
        || first_that_is_not(normals, is_normal).is_some()
        || first_that_is_not(occlusion, is_share).is_some()
    {
        return Err(DrawError::SurfacePaint { surface, vertices });
    }
    Ok(())
}

fn check_texture(
    surface: usize,
    texture: &SurfaceTexture,
    vertices: usize,
) -> Result<(), DrawError> {
    let found = texture.places.len();
    if found != vertices {
        return Err(DrawError::TexturePlaces {
            surface,
            found,
            vertices,
        });
    }
    // No number is in no range.
    let is_place = |place: &Vec2| place.abs().max_element() <= MAX_PLACE;
    if let Some(vertex) = first_that_is_not(&texture.places, is_place) {
        return Err(DrawError::TexturePlace { surface, vertex });
    }
    match texture.coverage {
        Coverage::Cut(share) if !(0.0..=1.0).contains(&share) => {
            Err(DrawError::Cut { surface, share })
        }
        _ => Ok(()),
    }
}

fn is_vertex(vertex: &SurfaceVertex) -> bool {
    let [x, y] = vertex.position.to_array();
    // Each comparison is false for NaN.
    (x.abs() <= MAX_COORDINATE)
        & (y.abs() <= MAX_COORDINATE)
        & vertex.inv_depth.is_finite()
        & vertex.tone.is_finite()
}
