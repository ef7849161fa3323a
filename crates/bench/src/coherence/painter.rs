//! Frames to pictures, in each order, and to what colours say in place of how hair looks.

use crate::BenchError;
use glam::Vec2;
use render::cpu::{Evaluator, Rasterizer};
use render::{Disc, Drawing, Frame, Order, Painting, Picture, Stretches};
use std::ops::Range;

/// Pixels around a part of a picture that are drawn besides, where lines are drawn of the whole.
const AROUND: u32 = 8;

/// Turns frames into pictures.
pub struct Painter {
    evaluator: Evaluator,
    rasterizer: Rasterizer,
    drawing: Drawing,
    part: Drawing,
}

impl Painter {
    /// A painter of pictures with that many samples a pixel: the same places in every pixel and frame, so
    /// that a sample only ever changes because what it shows does.
    ///
    /// # Errors
    ///
    /// When there is no such number of samples or threads.
    pub fn new(samples: u32, threads: usize) -> Result<Self, BenchError> {
        let rasterizer = Rasterizer::new(samples, Some(threads));
        Ok(Self {
            evaluator: Evaluator::of_samples(samples),
            rasterizer: rasterizer.map_err(|error| error.to_string())?,
            drawing: Drawing::default(),
            part: Drawing::default(),
        })
    }

    /// The frame's strokes.
    ///
    /// # Errors
    ///
    /// When it makes none.
    pub fn strokes(&mut self, frame: &mut Frame, order: Order) -> Result<&mut Drawing, BenchError> {
        frame.order = order;
        let made = self.evaluator.evaluate(frame, &mut self.drawing);
        made.map_err(|error| error.to_string())?;
        Ok(&mut self.drawing)
    }

    /// The frame's picture.
    ///
    /// # Errors
    ///
    /// When it can't be drawn.
    pub fn picture(&mut self, frame: &mut Frame, order: Order) -> Result<Picture, BenchError> {
        self.strokes(frame, order)?;
        self.draw()
    }

    /// Moves [`Self::strokes`]' last strokes, each joint's by its way in pixels, without any other change of theirs.
    pub fn push(&mut self, ways: &[Vec2]) {
        let drawing = &mut self.drawing;
        let all = 0..drawing.clump.len();
        push(&mut drawing.clump, &Stretches::Everywhere, &all, ways);
        push(&mut drawing.sides, &drawing.side_stretches, &all, ways);
        for layer in &mut drawing.layers {
            push(&mut layer.discs, &layer.stretches, &layer.joints, ways);
        }
    }

    /// A part of the picture of [`Self::strokes`]' last frame: from column and row `corner` on, which may lie
    /// outside and between pixels, `size` pixels wide and high.
    ///
    /// # Errors
    ///
    /// When it can't be drawn.
    pub fn part(&mut self, corner: Vec2, size: u32) -> Result<Picture, BenchError> {
        let part = &mut self.part;
        part.clone_from(&self.drawing);
        // Lines of what lies around reach into it.
        let margin = if part.passes.is_empty() { 0 } else { AROUND };
        part.size = [size + 2 * margin; 2];
        let corner = corner - margin as f32;
        let layers = part.layers.iter_mut().flat_map(|layer| &mut layer.discs);
        let clumps = part.clump.iter_mut().chain(&mut part.sides);
        for disc in clumps.chain(layers) {
            disc.center -= corner;
        }
        let surfaces = part.surfaces.iter_mut();
        for vertex in surfaces.flat_map(|surface| &mut surface.vertices) {
            vertex.position -= corner;
        }
        let drawn = self.rasterizer.draw(part);
        let picture = drawn.map_err(|error| error.to_string())?;
        Ok(without_margin(&picture, margin as usize))
    }

    /// The frame with hair in the colours that `color` gives to joints, all else black.
    ///
    /// # Errors
    ///
    /// When it can't be drawn.
    pub fn recolored(
        &mut self,
        frame: &mut Frame,
        order: Order,
        color: impl Fn(usize) -> [f32; 3],
    ) -> Result<Picture, BenchError> {
        let drawing = self.strokes(frame, order)?;
        drawing.painting = Painting::default();
        drawing.passes.clear();
        for layer in &mut drawing.layers {
            let joints = layer.joints.clone();
            for (i, of_joint) in layer.colors.iter_mut().enumerate() {
                *of_joint = color(joints.start + i % joints.len());
            }
        }
        for surface in &mut drawing.surfaces {
            surface.light = [0.0; 3];
            surface.shadow = [0.0; 3];
        }
        drawing.background = Some([0.0; 3]);
        self.draw()
    }

    /// Which pixels show hair in their middle. With one sample a pixel.
    ///
    /// # Errors
    ///
    /// When the frame can't be drawn.
    pub fn hair(&mut self, frame: &mut Frame) -> Result<Vec<bool>, BenchError> {
        let picture = self.recolored(frame, Order::default(), |_| [1.0; 3])?;
        Ok(picture.pixels.iter().map(|pixel| pixel[0] > 0.0).collect())
    }

    fn draw(&mut self) -> Result<Picture, BenchError> {
        self.rasterizer
            .draw(&self.drawing)
            .map_err(|error| error.to_string().into())
    }
}

/// Moves the discs of strokes that are drawn so on these joints, each by its joint's way.
fn push(discs: &mut [Disc], stretches: &Stretches, joints: &Range<usize>, ways: &[Vec2]) {
    match stretches {
        Stretches::Everywhere => {
            for (i, disc) in discs.iter_mut().enumerate() {
                disc.center += ways[joints.start + i % joints.len()];
            }
        }
        Stretches::Within(strokes) => {
            for stretch in strokes.iter().flatten() {
                let of_stretch = &mut discs[stretch.first..][..stretch.joints.len()];
                for (disc, way) in of_stretch.iter_mut().zip(&ways[stretch.joints.clone()]) {
                    disc.center += *way;
                }
            }
        }
    }
}

/// A picture without so many pixels at each of its borders.
fn without_margin(picture: &Picture, margin: usize) -> Picture {
    let [width, height] = [picture.width, picture.height].map(|side| side as usize - 2 * margin);
    let rows = picture.pixels.chunks_exact(width + 2 * margin);
    let inner = rows.skip(margin).take(height);
    Picture {
        width: width as u32,
        height: height as u32,
        pixels: inner
            .flat_map(|row| &row[margin..][..width])
            .copied()
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_is_cut_off() {
        let pixel = |i: usize| [i as f32, 0.0, 0.0, 1.0];
        let picture = Picture {
            width: 4,
            height: 5,
            pixels: (0..20).map(pixel).collect(),
        };
        assert_eq!(without_margin(&picture, 0), picture);
        let inner = without_margin(&picture, 1);
        assert_eq!((inner.width, inner.height), (2, 3));
        assert_eq!(inner.pixels, [5, 6, 9, 10, 13, 14].map(pixel));
    }
}
