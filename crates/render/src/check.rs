//! What a drawing must be before anything is drawn.

mod error;
mod strokes;
mod surfaces;

pub use error::DrawError;
pub(crate) use surfaces::check_surfaces;

use self::strokes::check_strokes;
use crate::drawing::Drawing;
use crate::edges::Edges;
use crate::features::Features;
use crate::mesh_paint::PaintedMeshes;
use rayon::prelude::*;

/// Largest width and height of a picture, in pixels.
pub const MAX_SIZE: u32 = 16384;

/// Largest coordinate and radius on the screen, in pixels, either side of 0.
pub const MAX_COORDINATE: f32 = 1e9;

/// Largest place in a texture, either side of 0, in widths and heights of its picture.
pub const MAX_PLACE: f32 = 1e4;

/// Looks at every number of the drawing, so that drawing itself can't fail.
pub(crate) fn check(drawing: &Drawing) -> Result<(), DrawError> {
    check_picture(drawing.size, drawing.background, drawing.edge_depth_m)?;
    let mesh_layers = drawing.mesh_painting.layers.len();
    let (strokes, surfaces) = rayon::join(
        || check_strokes(drawing),
        || check_surfaces(&drawing.surfaces, mesh_layers),
    );
    strokes?;
    check_features(drawing)?;
    check_painting(drawing)?;
    check_decals(drawing)?;
    check_brushwork(drawing)?;
    check_mesh_painting(drawing)?;
    surfaces
}

fn check_features(drawing: &Drawing) -> Result<(), DrawError> {
    let features = &drawing.features;
    let of_passes = drawing.passes.iter().map(Edges::features);
    let missing = of_passes
        .flat_map(Features::iter)
        .find(|feature| !features.declared.has(*feature));
    if let Some(feature) = missing {
        return Err(DrawError::Undeclared(feature));
    }
    if features.declared.is_empty() {
        return Ok(());
    }
    let joints = drawing.clump.len();
    let of_joints = features
        .needed_lists()
        .map(|(list, length)| (list, length, joints));
    let runs = ("runs", features.runs.len(), drawing.runs.len());
    match of_joints
        .chain([runs])
        .find(|(_, length, needed)| length != needed)
    {
        None => Ok(()),
        Some((list, length, needed)) => Err(DrawError::FeatureList {
            list,
            length,
            needed,
        }),
    }
}

fn check_painting(drawing: &Drawing) -> Result<(), DrawError> {
    let painting = &drawing.painting;
    let mut after = 0;
    for painted in &painting.layers {
        if !(after..drawing.layers.len()).contains(&painted.layer) {
            return Err(DrawError::PaintedLayer(painted.layer));
        }
        after = painted.layer + 1;
    }
    let needed = drawing.clump.len();
    let lists = painting.needed_lists().into_iter();
    match lists.into_iter().find(|(_, length)| *length != needed) {
        None => Ok(()),
        Some((list, length)) => Err(DrawError::PaintingList {
            list,
            length,
            needed,
        }),
    }
}

fn check_mesh_painting(drawing: &Drawing) -> Result<(), DrawError> {
    let painting = &drawing.mesh_painting;
    let is_whole = |layer: &PaintedMeshes| {
        let is_head = layer.head_height_m > 0.0 && layer.head_height_m.is_finite();
        is_head && layer.head_depth.is_finite() && (0.0..=1.0).contains(&layer.through_hair)
    };
    let seen = painting.seen.is_some() || painting.layers.is_empty();
    match painting.layers.iter().position(|layer| !is_whole(layer)) {
        None if seen => Ok(()),
        index => Err(DrawError::MeshLayer(index.unwrap_or(0))),
    }
}

fn check_brushwork(drawing: &Drawing) -> Result<(), DrawError> {
    let (brushwork, joints) = (&drawing.brushwork, drawing.clump.len());
    let mut after = 0;
    for brushed in &brushwork.layers {
        if !(after..drawing.layers.len()).contains(&brushed.layer) {
            return Err(DrawError::BrushedLayer(brushed.layer));
        }
        after = brushed.layer + 1;
    }
    let found = brushwork.joints.iter().filter(|joint| joint.is_valid());
    match (brushwork.is_empty(), found.count()) {
        (false, found) if found != joints || brushwork.joints.len() != joints => {
            Err(DrawError::AlongStrands { found, joints })
        }
        _ => Ok(()),
    }
}

fn check_decals(drawing: &Drawing) -> Result<(), DrawError> {
    let mut after = 0;
    for decal in &drawing.decals {
        let is_layer = (after..drawing.layers.len()).contains(&decal.layer);
        if !is_layer || !(0.0..=f32::MAX).contains(&decal.reach_m) {
            return Err(DrawError::Decal(decal.layer));
        }
        after = decal.layer + 1;
    }
    let is_decal = |layer: usize| drawing.decal(layer).is_some();
    let mut painted = drawing.painting.layers.iter();
    match painted.find(|painted| is_decal(painted.layer)) {
        Some(painted) => Err(DrawError::Decal(painted.layer)),
        None => Ok(()),
    }
}

/// Looks at what a picture is, whatever is in it.
pub(crate) fn check_picture(
    [width, height]: [u32; 2],
    background: Option<[f32; 3]>,
    edge_depth_m: f32,
) -> Result<(), DrawError> {
    if !(1..=MAX_SIZE).contains(&width) || !(1..=MAX_SIZE).contains(&height) {
        return Err(DrawError::Size(width, height));
    }
    if background.is_some_and(|color| !is_finite(&color)) {
        return Err(DrawError::Background);
    }
    if !(0.0..=f32::MAX).contains(&edge_depth_m) {
        return Err(DrawError::EdgeDepth(edge_depth_m));
    }
    Ok(())
}

/// The index of the first item for which the rule doesn't hold. All of a chunk are looked at, as branches take more time.
fn first_that_is_not<T: Sync>(items: &[T], rule: impl Fn(&T) -> bool + Sync) -> Option<usize> {
    const CHUNK: usize = 4096;
    let is_wrong = |chunk: &[T]| !chunk.iter().fold(true, |right, item| right & rule(item));
    let chunk = items.par_chunks(CHUNK).position_first(is_wrong)?;
    let first = chunk * CHUNK;
    let place = items[first..].iter().position(|item| !rule(item))?;
    Some(first + place)
}

fn is_finite(color: &[f32; 3]) -> bool {
    color.iter().all(|channel| channel.is_finite())
}
