//! What a drawing must be before anything is drawn.

use crate::drawing::{
    Coverage, Disc, Drawing, LayerStrokes, Run, Stretch, Stretches, Surface, SurfaceTexture,
    SurfaceVertex,
};
use crate::edges::Edges;
use crate::features::{Feature, Features};
use crate::mesh_paint::{PaintedMeshes, SurfacePaint};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// Largest width and height of a picture, in pixels.
pub const MAX_SIZE: u32 = 16384;

/// Largest coordinate and radius on the screen, in pixels, either side of 0.
pub const MAX_COORDINATE: f32 = 1e9;

/// Largest place in a texture, either side of 0, in widths and heights of its picture.
pub const MAX_PLACE: f32 = 1e4;

/// Why a drawing can't be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawError {
    /// A picture has from 1 to [`MAX_SIZE`] pixels a side.
    #[error("the picture's size is {0} x {1}: each side must be 1 to {MAX_SIZE} pixels")]
    Size(u32, u32),
    /// The finished picture doesn't fit.
    #[error("not enough memory for a picture of {0} x {1}")]
    Memory(u32, u32),
    /// The background is not a colour.
    #[error("the background's colour is not finite")]
    Background,
    /// Edges lie a finite length deeper, 0 or more.
    #[error("edge_depth_m is {0}, not a finite number of 0 or more")]
    EdgeDepth(f32),
    /// A run has no joint, or some that the drawing doesn't have.
    #[error(
        "run {run}: its joints are {start}..{end}, which is not a piece of the drawing's {joints}"
    )]
    RunJoints {
        /// Index of the run.
        run: usize,
        /// Its first joint.
        start: usize,
        /// One beyond its last.
        end: usize,
        /// How many the drawing has.
        joints: usize,
    },
    /// Some runs share joints.
    #[error("the runs have {runs} joints in all, the drawing has {joints}: runs share joints")]
    SharedJoints {
        /// Sum of the runs' joints.
        runs: usize,
        /// How many the drawing has.
        joints: usize,
    },
    /// Runs are sorted by the ids of their strands.
    #[error("run {run} of strand {strand} comes after strand {before}: ids must not decrease")]
    RunOrder {
        /// Index of the run.
        run: usize,
        /// Its strand's id.
        strand: u32,
        /// The strand of the run before.
        before: u32,
    },
    /// A layer draws on joints that the drawing doesn't have, or on a part of a run.
    #[error(
        "layer \"{layer}\": it draws on the joints {start}..{end}, which are no whole runs of the drawing's {joints}"
    )]
    LayerJoints {
        /// The layer's name.
        layer: String,
        /// The first joint that it draws on.
        start: usize,
        /// One beyond the last.
        end: usize,
        /// How many the drawing has.
        joints: usize,
    },
    /// A layer's lists don't fit its joints and instances.
    #[error(
        "layer \"{layer}\": {discs} discs and {colors} colours for {instances} instances of {joints} joints"
    )]
    LayerLength {
        /// The layer's name.
        layer: String,
        /// Length of its list of discs.
        discs: usize,
        /// Length of its list of colours.
        colors: usize,
        /// Its strokes per run.
        instances: usize,
        /// The joints that it draws on.
        joints: usize,
    },
    /// A stretch lies on joints or discs that there aren't, or before the end of the one before.
    #[error(
        "{of}, stroke {instance}: the joints {start}..{end} with discs from {first} on are no stretch of joints {} to {} with {discs} discs, behind the one before",
        joints.start, joints.end
    )]
    Stretch {
        /// The layer, or the clump's sides.
        of: String,
        /// Which of its strokes.
        instance: usize,
        /// The first joint of the stretch.
        start: usize,
        /// One beyond the last.
        end: usize,
        /// Where its first disc lies.
        first: usize,
        /// The joints that the strokes may be on.
        joints: Range<usize>,
        /// How many discs there are.
        discs: usize,
    },
    /// A layer has stretches for other strokes than its own.
    #[error("{of}: there are stretches for {lists} strokes, of {instances}")]
    StretchLists {
        /// The layer, or the clump's sides.
        of: String,
        /// For how many strokes there are stretches.
        lists: usize,
        /// How many strokes there are.
        instances: usize,
    },
    /// There are sides of the clump for other joints than the drawing's.
    #[error(
        "there are {discs} discs at the clump's sides: there must be none, or two a joint ({joints} joints)"
    )]
    Sides {
        /// How many there are.
        discs: usize,
        /// The drawing's joints.
        joints: usize,
    },
    /// A disc of the clump is invalid.
    #[error("clump, joint {joint}: {disc:?} is invalid: {DISC_RULE}")]
    ClumpDisc {
        /// Index of the joint.
        joint: usize,
        /// As it was given.
        disc: Disc,
    },
    /// A disc of a layer is invalid.
    #[error(
        "layer \"{layer}\", instance {instance}, joint {joint}: {disc:?} is invalid: {DISC_RULE}"
    )]
    LayerDisc {
        /// The layer's name.
        layer: String,
        /// Which of its strokes.
        instance: usize,
        /// Index of the joint.
        joint: usize,
        /// As it was given.
        disc: Disc,
    },
    /// A colour of a layer is not finite.
    #[error("layer \"{layer}\", instance {instance}, joint {joint}: the colour is not finite")]
    LayerColor {
        /// The layer's name.
        layer: String,
        /// Which of its strokes.
        instance: usize,
        /// Index of the joint.
        joint: usize,
    },
    /// A margin is not finite.
    #[error("surface {surface}: margin_m is {margin_m}, not a finite number")]
    Margin {
        /// The surface's index.
        surface: usize,
        /// As it was given, metres.
        margin_m: f32,
    },
    /// A colour of a surface is not finite.
    #[error("surface {surface}: a colour is not finite")]
    SurfaceColor {
        /// Index of the surface.
        surface: usize,
    },
    /// A corner is not finite, or too far away.
    #[error(
        "surface {surface}, vertex {vertex}: its numbers must be finite, its position at most {MAX_COORDINATE} pixels away"
    )]
    Vertex {
        /// Index of the surface.
        surface: usize,
        /// Index of the vertex.
        vertex: usize,
    },
    /// A triangle's corner doesn't exist.
    #[error(
        "surface {surface}, triangle {triangle}: there is no vertex {vertex}, only {vertices} vertices"
    )]
    TriangleIndex {
        /// Index of the surface.
        surface: usize,
        /// Index of the triangle.
        triangle: usize,
        /// The index that is too large.
        vertex: u32,
        /// How many the surface has.
        vertices: usize,
    },
    /// A textured surface has a place for each vertex.
    #[error(
        "surface {surface}: its texture has {found} places, where there are {vertices} vertices"
    )]
    TexturePlaces {
        /// Index of the surface.
        surface: usize,
        /// How many there are.
        found: usize,
        /// How many there should be.
        vertices: usize,
    },
    /// A place in a texture is not finite, or too far away.
    #[error(
        "surface {surface}, vertex {vertex}: its place in the texture must be finite, at most {MAX_PLACE} pictures away"
    )]
    TexturePlace {
        /// Index of the surface.
        surface: usize,
        /// Index of the vertex.
        vertex: usize,
    },
    /// A share is from 0 to 1.
    #[error("surface {surface}: its texture is cut at a coverage of {share}, not 0 to 1")]
    Cut {
        /// Index of the surface.
        surface: usize,
        /// As it was given.
        share: f32,
    },
    /// A pass needs a feature that isn't declared.
    #[error("a pass needs the feature {0:?}, which is not declared")]
    Undeclared(Feature),
    /// A list that a declared feature needs has another length.
    #[error("features: the list `{list}` has {length} entries, where there are {needed}")]
    FeatureList {
        /// Which list.
        list: &'static str,
        /// Its length.
        length: usize,
        /// How many joints or runs there are.
        needed: usize,
    },
    /// A decal is of a layer that isn't there, not behind the one before or painted, or its reach is no length.
    #[error(
        "decals: layer {0} is not there, not behind the one before or painted, or its reach is not a finite number of 0 or more"
    )]
    Decal(usize),
    /// A layer is to be painted that isn't there, or not behind the one before.
    #[error("painting: layer {0} is not there, or not behind the one before")]
    PaintedLayer(usize),
    /// A list that painted layers need has another length.
    #[error("painting: the list `{list}` has {length} entries, where there are {needed} joints")]
    PaintingList {
        /// Which list.
        list: &'static str,
        /// Its length.
        length: usize,
        /// How many joints there are.
        needed: usize,
    },
    /// A layer has a brush that isn't there, or not behind the one before.
    #[error("brushwork: layer {0} is not there, or not behind the one before")]
    BrushedLayer(usize),
    /// Where joints are along their strands is said of too few or too many, or of one by a number that is none.
    #[error(
        "brushwork: {found} of the {joints} joints say where along their strands they are: s, whole and pixels must be finite numbers of 0 or more"
    )]
    AlongStrands {
        /// How many do.
        found: usize,
        /// How many joints there are.
        joints: usize,
    },
    /// A layer for meshes has no head, or is seen through hair by no share from 0 to 1, or nothing says what sees it.
    #[error("mesh painting: layer {0} needs a head, an eye, and a share from 0 to 1")]
    MeshLayer(usize),
    /// A surface is painted by a layer that isn't there.
    #[error("surface {surface} is painted by mesh layer {layer}, and there are {layers}")]
    SurfaceLayer {
        /// Index of the surface.
        surface: usize,
        /// Its layer.
        layer: u32,
        /// How many there are.
        layers: usize,
    },
    /// What paints a surface is told too much or too little of its vertices.
    #[error(
        "surface {surface}: for each of its {vertices} vertices there must be a unit normal to paint it, and a share of shadow from 0 to 1 or none at all"
    )]
    SurfacePaint {
        /// Index of the surface.
        surface: usize,
        /// How many vertices it has.
        vertices: usize,
    },
    /// Only so many triangles can be numbered.
    #[error("{0} triangles are more than can be drawn")]
    TriangleCount(usize),
}

const DISC_RULE: &str =
    "its numbers must be finite, its radius 0 or more, its place and radius at most 1e9 pixels";

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

fn check_strokes(drawing: &Drawing) -> Result<(), DrawError> {
    check_runs(drawing)?;
    if let Some(joint) = first_that_is_not(&drawing.clump, is_disc) {
        let disc = drawing.clump[joint];
        return Err(DrawError::ClumpDisc { joint, disc });
    }
    check_sides(drawing)?;
    for layer in &drawing.layers {
        check_layer(layer, drawing)?;
    }
    Ok(())
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

fn check_runs(drawing: &Drawing) -> Result<(), DrawError> {
    let joints = drawing.clump.len();
    // Cannot overflow: no run is longer than a list, and one that would make the sum wrap stops it.
    let mut total = 0_usize;
    for (run, piece) in drawing.runs.iter().enumerate() {
        let (start, end) = (piece.joints.start, piece.joints.end);
        if start >= end || end > joints {
            return Err(DrawError::RunJoints {
                run,
                start,
                end,
                joints,
            });
        }
        total = total.saturating_add(end - start);
    }
    if total > joints {
        return Err(DrawError::SharedJoints {
            runs: total,
            joints,
        });
    }
    for (before, pair) in drawing.runs.windows(2).enumerate() {
        if pair[1].strand < pair[0].strand {
            return Err(DrawError::RunOrder {
                run: before + 1,
                strand: pair[1].strand,
                before: pair[0].strand,
            });
        }
    }
    Ok(())
}

fn check_sides(drawing: &Drawing) -> Result<(), DrawError> {
    let (discs, joints) = (drawing.sides.len(), drawing.clump.len());
    let sides = Strokes {
        stretches: &drawing.side_stretches,
        instances: 2,
        joints: 0..joints,
        discs,
    };
    match sides.stretches {
        Stretches::Everywhere if discs != 0 && discs != 2 * joints => {
            return Err(DrawError::Sides { discs, joints });
        }
        Stretches::Everywhere => {}
        Stretches::Within(_) => sides.check(|| "the clump's sides".to_owned())?,
    }
    if let Some(index) = first_that_is_not(&drawing.sides, is_disc) {
        let (_, joint) = sides.owner(index);
        let disc = drawing.sides[index];
        return Err(DrawError::ClumpDisc { joint, disc });
    }
    Ok(())
}

/// Strokes whose discs are listed.
struct Strokes<'a> {
    stretches: &'a Stretches,
    instances: usize,
    joints: Range<usize>,
    discs: usize,
}

impl Strokes<'_> {
    /// Looks at all stretches; `of` says whose they are.
    fn check(&self, of: impl Fn() -> String) -> Result<(), DrawError> {
        let Stretches::Within(lists) = self.stretches else {
            return Ok(());
        };
        if lists.len() != self.instances {
            return Err(DrawError::StretchLists {
                of: of(),
                lists: lists.len(),
                instances: self.instances,
            });
        }
        for (instance, list) in lists.iter().enumerate() {
            let mut end = self.joints.start;
            for Stretch { joints, first } in list {
                let is_there = end <= joints.start && joints.end <= self.joints.end;
                let has_discs = joints.start < joints.end
                    && *first <= self.discs
                    && joints.end - joints.start <= self.discs - first;
                if !(is_there && has_discs) {
                    return Err(DrawError::Stretch {
                        of: of(),
                        instance,
                        start: joints.start,
                        end: joints.end,
                        first: *first,
                        joints: self.joints.clone(),
                        discs: self.discs,
                    });
                }
                end = joints.end;
            }
        }
        Ok(())
    }

    /// The stroke and the joint that have a place in the list of discs; the first ones where nobody has it.
    fn owner(&self, place: usize) -> (usize, usize) {
        let (start, joints) = (self.joints.start, self.joints.len().max(1));
        let Stretches::Within(lists) = self.stretches else {
            return (place / joints, start + place % joints);
        };
        let stretches = lists.iter().enumerate();
        let mut stretches = stretches.flat_map(|(i, list)| list.iter().map(move |s| (i, s)));
        let owner = stretches.find(|(_, stretch)| stretch.places().contains(&place));
        owner.map_or((0, start), |(instance, stretch)| {
            (instance, stretch.joints.start + place - stretch.first)
        })
    }
}

fn check_layer(layer: &LayerStrokes, drawing: &Drawing) -> Result<(), DrawError> {
    let Range { start, end } = layer.joints;
    let all = drawing.clump.len();
    let is_whole = |run: &Run| {
        let Range {
            start: first,
            end: last,
        } = run.joints;
        last <= start || end <= first || (start <= first && last <= end)
    };
    let is_range = start <= end && end <= all;
    if !is_range || !(layer.joints == (0..all) || drawing.runs.iter().all(is_whole)) {
        return Err(DrawError::LayerJoints {
            layer: layer.name.clone(),
            start,
            end,
            joints: all,
        });
    }
    let joints = layer.joints.len();
    let (discs, colors) = (layer.discs.len(), layer.colors.len());
    let length = match layer.stretches {
        Stretches::Everywhere => layer.instances.checked_mul(joints),
        Stretches::Within(_) => Some(discs),
    };
    if length != Some(discs) || length != Some(colors) {
        return Err(DrawError::LayerLength {
            layer: layer.name.clone(),
            discs,
            colors,
            instances: layer.instances,
            joints,
        });
    }
    let strokes = Strokes {
        stretches: &layer.stretches,
        instances: layer.instances,
        joints: layer.joints.clone(),
        discs,
    };
    strokes.check(|| format!("layer \"{}\"", layer.name))?;
    if let Some(index) = first_that_is_not(&layer.discs, is_disc) {
        let (instance, joint) = strokes.owner(index);
        return Err(DrawError::LayerDisc {
            layer: layer.name.clone(),
            instance,
            joint,
            disc: layer.discs[index],
        });
    }
    if let Some(index) = first_that_is_not(&layer.colors, is_finite) {
        let (instance, joint) = strokes.owner(index);
        return Err(DrawError::LayerColor {
            layer: layer.name.clone(),
            instance,
            joint,
        });
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

fn is_disc(disc: &Disc) -> bool {
    let [x, y] = disc.center.to_array();
    // Each comparison is false for NaN.
    (x.abs() <= MAX_COORDINATE)
        & (y.abs() <= MAX_COORDINATE)
        & (0.0..=MAX_COORDINATE).contains(&disc.radius)
        & disc.inv_depth.is_finite()
        & disc.inv_depth_biased.is_finite()
}

fn is_finite(color: &[f32; 3]) -> bool {
    color.iter().all(|channel| channel.is_finite())
}
