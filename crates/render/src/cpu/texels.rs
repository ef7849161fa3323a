//! The picture on one triangle in one tile.

use super::surface::{Edge, Interpolated};
use super::tile::{Cell, LANES, LaneMask, Lanes, Samples, Stack, select};
use crate::drawing::{Coverage, SurfaceTexture, SurfaceVertex, scatter};
use effects::Blurred;
use glam::Vec2;

/// A texture as a triangle shows it.
pub(super) struct Texels<'a> {
    texture: &'a SurfaceTexture,
    /// In the middle of each pixel's samples: places times inverse depth, which run linearly on the screen, and inverse depth.
    places: [Samples; 2],
    inv_depth: Samples,
    depths: &'a Interpolated,
    /// The least and the greatest places of the corners: the middle of some samples may lie outside of the triangle.
    low: Vec2,
    high: Vec2,
    /// Blurred over what a pixel covers of it, in the mean over the triangle.
    image: Blurred<'a>,
}

impl<'a> Texels<'a> {
    #[inline(always)]
    pub(super) fn new(
        texture: &'a SurfaceTexture,
        corners: &[u32; 3],
        depths: &'a Interpolated,
        edges: &[Edge; 3],
        seen: [&SurfaceVertex; 3],
        twice_area_px: f64,
        stack: &Stack,
    ) -> Self {
        let at = |i: usize| texture.places[corners[i] as usize];
        let [a, b, c] = [at(0), at(1), at(2)];
        let by_depth = |axis: usize| {
            let value = |place: Vec2, i: usize| place[axis] * seen[i].inv_depth;
            let values = [value(a, 0), value(b, 1), value(c, 2)];
            Interpolated::new(values, edges, twice_area_px)
                .slope
                .at_middles(stack)
        };
        // Texels are square, the picture need not be.
        let [width, height] = texture.image.size().map(|side| side as f32);
        let twice_area = (b - a).perp_dot(c - a).abs() * (height / width);
        Self {
            texture,
            places: [by_depth(0), by_depth(1)],
            inv_depth: depths.slope.at_middles(stack),
            depths,
            low: a.min(b).min(c),
            high: a.max(b).max(c),
            image: texture
                .image
                .blurred((twice_area / twice_area_px.abs() as f32).sqrt()),
        }
    }

    /// The picture's colours at some samples of a cell; takes those away that it leaves free, of the surface of that number.
    #[inline(always)]
    pub(super) fn look_up(
        &self,
        cell: Cell,
        stack: &Stack,
        surface: u32,
        samples: &mut LaneMask,
    ) -> [Lanes; 3] {
        let [across, down] = [self.places[0].of(cell), self.places[1].of(cell)];
        let inv_depth = self.inv_depth.of(cell);
        let mut colors = [[0.0; LANES]; 3];
        let mut coverage = [0.0; LANES];
        let together = stack.lanes_of_pixel();
        for first in (0..LANES).step_by(together) {
            let lanes = first..first + together;
            if samples[lanes.clone()].iter().all(|sample| *sample == 0) {
                continue;
            }
            let depth_m = 1.0 / self.depths.clamp(inv_depth[first]);
            let place = Vec2::new(across[first], down[first]) * depth_m;
            let place = place.clamp(self.low, self.high);
            let texel = self.image.at(place.to_array(), self.texture.repeats);
            for k in lanes {
                for channel in 0..3 {
                    colors[channel][k] = texel[channel];
                }
                coverage[k] = texel[3];
            }
        }
        match self.texture.coverage {
            Coverage::Ignored => {}
            Coverage::Cut(share) => {
                for k in 0..LANES {
                    samples[k] &= select(coverage[k] >= share, u32::MAX, 0);
                }
            }
            Coverage::Share => {
                for k in 0..LANES {
                    let part = match together {
                        1 => 0.5,
                        _ => scatter(surface, (stack.first + k % together) as u32),
                    };
                    samples[k] &= select(coverage[k] > part, u32::MAX, 0);
                }
            }
        }
        colors
    }
}
