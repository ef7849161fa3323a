//! The reference picture: what a [`Drawing`] should look like, in f64, slow and plain; and how far other
//! pictures are from it ([`compare`]).
//!
//! ```
//! use reference::{compare, picture};
//! use render::{Disc, Drawing, LayerStrokes, Run, Stretches, cpu::Rasterizer};
//!
//! // One white stroke from the left to the right, 6 pixels wide at first, then pointed.
//! let joint = |x: f32, radius: f32| Disc {
//!     center: glam::Vec2::new(x, 8.0),
//!     radius,
//!     inv_depth: 1.0,
//!     inv_depth_biased: 1.0,
//! };
//! let discs = vec![joint(4.0, 3.0), joint(28.0, 0.0)];
//! let drawing = Drawing {
//!     size: [32, 16],
//!     runs: vec![Run { strand: 0, joints: 0..2 }],
//!     clump: discs.clone(),
//!     layers: vec![LayerStrokes {
//!         name: "base".to_owned(),
//!         joints: 0..2,
//!         rank: 0,
//!         instances: 1,
//!         stretches: Stretches::Everywhere,
//!         discs,
//!         colors: vec![[1.0; 3]; 2],
//!     }],
//!     ..Drawing::default()
//! };
//!
//! let exact = picture(&drawing, 16);
//! let drawn = Rasterizer::new(16, Some(1))?.draw(&drawing)?;
//! let difference = compare::error(&drawn, &exact, &compare::mask(&exact))?;
//! assert!(difference.mean < 0.02 && (difference.ink_ratio - 1.0).abs() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Every sample asks every stroke near it the three questions of `segment`: does a disc of the
//! sweep cover me, how near is the nearest disc that does, and which axis point lends its colour.
//! `candidates` puts the answers in order. Nothing is shared with the rasterisers but the data types,
//! so that agreement means something.
//!
//! Pictures on surfaces are looked up in each sample by itself. What layers paint is not drawn: surfaces have their two tones.
//!
//! Where the conventions leave a choice among exact equals: of axis points equally near the first
//! along the strand lends its colour, of surfaces equally near the first triangle is seen, and a
//! stroke exactly as deep as a surface is in front of it.

mod candidates;
pub mod compare;
mod features;
mod segment;
mod texture;
mod triangle;

use candidates::Candidates;
pub use features::samples_at;
use glam::DVec2;
use rayon::prelude::*;
use render::{Drawing, Picture};

/// The reference picture with `grid` x `grid` samples in each pixel, at the centres of a regular
/// grid. 16 is the reference of every measured error; a transparent picture where `grid` is 0.
///
/// # Panics
///
/// As [`picture_at`].
pub fn picture(drawing: &Drawing, grid: u32) -> Picture {
    let center = |cell: u32| (f64::from(cell) + 0.5) / f64::from(grid);
    let positions: Vec<DVec2> = (0..grid)
        .flat_map(|row| (0..grid).map(move |column| DVec2::new(center(column), center(row))))
        .collect();
    picture_at(drawing, &positions)
}

/// The reference picture with samples at `positions` in each pixel, from 0 to 1 on both axes with y
/// down. All samples weigh the same, each with its light cut to 0..1. Premultiplied; what lies
/// outside every stroke and surface is transparent if the drawing has no background.
///
/// # Panics
///
/// If the drawing's lists are shorter than its runs and triangles say.
pub fn picture_at(drawing: &Drawing, positions: &[DVec2]) -> Picture {
    let [width, height] = drawing.size;
    let scene = Candidates::new(drawing);
    let pixels = (0..height)
        .into_par_iter()
        .flat_map_iter(|y| row(&scene, width, y, positions))
        .collect();
    Picture {
        width,
        height,
        pixels,
    }
}

/// The pixels of row `y`, from the left.
fn row(scene: &Candidates, width: u32, y: u32, positions: &[DVec2]) -> Vec<[f32; 4]> {
    let upper_left = DVec2::new(0.0, f64::from(y));
    let scene = scene.within(upper_left, DVec2::new(f64::from(width), f64::from(y) + 1.0));
    (0..width)
        .map(|x| pixel(&scene, DVec2::new(f64::from(x), f64::from(y)), positions))
        .collect()
}

/// The mean of the samples of the pixel whose upper left corner is `corner`.
fn pixel(scene: &Candidates, corner: DVec2, positions: &[DVec2]) -> [f32; 4] {
    let scene = scene.within(corner, corner + 1.0);
    let mut sum = [0.0; 4];
    for (sample, position) in positions.iter().enumerate() {
        let reach = render::shown_reach(sample as u32, positions.len() as u32);
        if let Some([red, green, blue]) = scene.color(corner + *position, reach) {
            for (total, value) in sum.iter_mut().zip([red, green, blue, 1.0]) {
                *total += value.clamp(0.0, 1.0);
            }
        }
    }
    sum.map(|total| (total / positions.len().max(1) as f64) as f32)
}
