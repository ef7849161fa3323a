//! Small drawings.

use glam::{DVec2, Vec2};
use render::{Disc, Drawing, LayerStrokes, Order, Picture, Run, Stretches, Surface, SurfaceVertex};

pub const WHITE: [f32; 3] = [1.0; 3];
pub const RED: [f32; 3] = [1.0, 0.0, 0.0];
pub const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
pub const BLUE: [f32; 3] = [0.0, 0.0, 1.0];

/// A disc whose biased depth is its depth.
pub fn disc(x: f32, y: f32, radius: f32, inv_depth: f32) -> Disc {
    Disc {
        center: Vec2::new(x, y),
        radius,
        inv_depth,
        inv_depth_biased: inv_depth,
    }
}

/// A 64 x 64 drawing of strands (ids 0, 1, ..., one run each) whose clumps are `strands`, and no
/// strokes yet.
pub fn clumps(strands: &[&[Disc]]) -> Drawing {
    let mut drawing = Drawing {
        size: [64, 64],
        ..Drawing::default()
    };
    for (strand, discs) in (0..).zip(strands) {
        let start = drawing.clump.len();
        drawing.clump.extend_from_slice(discs);
        drawing.runs.push(Run {
            strand,
            joints: start..drawing.clump.len(),
        });
    }
    drawing
}

/// Adds a layer of one colour. `instances` lists, for each instance, the discs of all joints.
pub fn add_layer(drawing: &mut Drawing, rank: i32, color: [f32; 3], instances: &[&[Disc]]) {
    let discs = instances.concat();
    drawing.layers.push(LayerStrokes {
        name: format!("layer {}", drawing.layers.len()),
        joints: 0..drawing.clump.len(),
        rank,
        instances: instances.len(),
        stretches: Stretches::Everywhere,
        colors: vec![color; discs.len()],
        discs,
    });
}

/// White base strokes that fill their clumps.
pub fn strokes(strands: &[&[Disc]]) -> Drawing {
    let mut drawing = clumps(strands);
    let discs = drawing.clump.clone();
    add_layer(&mut drawing, 0, WHITE, &[&discs]);
    drawing
}

/// Adds a surface that covers the whole screen at one depth, lit where `tone` says so.
pub fn add_wall(drawing: &mut Drawing, inv_depth: f32, tone: f32, [light, shadow]: [[f32; 3]; 2]) {
    let vertex = |x, y| SurfaceVertex {
        position: Vec2::new(x, y),
        inv_depth,
        tone,
    };
    drawing.surfaces.push(Surface {
        texture: None,
        margin_m: 0.0,
        mesh: 0,
        paint: None,
        marks: 0,
        vertices: vec![
            vertex(-10.0, -10.0),
            vertex(300.0, -10.0),
            vertex(-10.0, 300.0),
        ],
        triangles: vec![[0, 1, 2]],
        light,
        shadow,
    });
}

/// The colour and coverage of one sample at `x`, `y`.
pub fn sample(drawing: &Drawing, x: f64, y: f64) -> [f32; 4] {
    let point = DVec2::new(x, y);
    let picture = reference::picture_at(drawing, &[point - point.floor()]);
    picture.pixels[y as usize * picture.width as usize + x as usize]
}

/// As [`sample`], with the drawing in `order`.
pub fn sample_in(order: Order, drawing: &Drawing, x: f64, y: f64) -> [f32; 4] {
    let drawing = Drawing {
        order,
        ..drawing.clone()
    };
    sample(&drawing, x, y)
}

/// An opaque colour.
pub fn opaque([red, green, blue]: [f32; 3]) -> [f32; 4] {
    [red, green, blue, 1.0]
}

/// The sum of a channel over all pixels: for alpha the covered area in pixels.
pub fn sum(picture: &Picture, channel: usize) -> f64 {
    picture
        .pixels
        .iter()
        .map(|pixel| f64::from(pixel[channel]))
        .sum()
}
