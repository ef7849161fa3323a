//! The picture on one triangle in one tile.

use super::set_up::SetUp;
use super::surface::Interpolated;
use super::tile::{Cell, LANES, LaneMask, Lanes, Slope, Stack, bits, greater, lesser, select};
use crate::drawing::{Coverage, SurfaceTexture, scatter};
use effects::Blurred;
use std::hint::black_box;

/// A texture as a triangle shows it.
pub(super) struct Texels<'a> {
    texture: &'a SurfaceTexture,
    /// Places times inverse depth, which run linearly on the screen, and inverse depth.
    places: [Slope; 2],
    inv_depth: Slope,
    /// The least and the greatest places of the corners, across and down: the middle of some samples may lie outside of the triangle.
    ends: [[f32; 2]; 2],
    /// Blurred over what a pixel covers of it, in the mean over the triangle.
    image: Blurred<'a>,
}

impl<'a> Texels<'a> {
    /// That of a triangle which is set up.
    #[inline(always)]
    pub(super) fn new(texture: &'a SurfaceTexture, (set_up, own): (&SetUp, usize)) -> Self {
        // Texels are square, the picture need not be.
        let [width, height] = texture.image.size().map(|side| side as f32);
        let twice_area = set_up.twice_area_of_picture(own).abs() * (height / width);
        let twice_area_px = set_up.twice_area[own].abs() as f32;
        let [(across, across_ends), (down, down_ends)] = set_up.places(own);
        Self {
            texture,
            places: [across, down],
            inv_depth: set_up.depths(own).slope,
            ends: [across_ends, down_ends],
            image: texture.image.blurred((twice_area / twice_area_px).sqrt()),
        }
    }

    /// The picture's colours at some samples of a cell; takes those away that it leaves free, of the surface of that number.
    #[inline(always)]
    pub(super) fn look_up(
        &self,
        cell: Cell,
        stack: &Stack,
        depths: &Interpolated,
        surface: u32,
        samples: &mut LaneMask,
    ) -> [Lanes; 3] {
        // In the middle of each pixel's samples; from slopes, which take less room than lanes.
        let mut across = self.places[0].at_middles(stack).of(cell);
        let mut down = self.places[1].at_middles(stack).of(cell);
        let inv_depth = self.inv_depth.at_middles(stack).of(cell);
        let [[left, right], [top, bottom]] = self.ends;
        for k in 0..LANES {
            let depth_m = 1.0 / depths.clamp(inv_depth[k]);
            across[k] = lesser(greater(across[k] * depth_m, left), right);
            down[k] = lesser(greater(down[k] * depth_m, top), bottom);
        }
        // By way of memory: compilers would work them out once more for each way in which lanes are taken from them.
        let [across, down] = black_box([across, down]);
        let together = stack.lanes_of_pixel();
        let [red, green, blue, coverage] = match together {
            1 => self.texels::<1>(&across, &down, samples),
            2 => self.texels::<2>(&across, &down, samples),
            _ => self.texels::<4>(&across, &down, samples),
        };
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
        [red, green, blue]
    }

    /// Colours and coverage at these places, of which so many lanes one after the other have one; 0 where none of them is wanted.
    #[inline(always)]
    fn texels<const TOGETHER: usize>(
        &self,
        across: &Lanes,
        down: &Lanes,
        wanted: &LaneMask,
    ) -> [Lanes; 4] {
        let mut texels = [[0.0; LANES]; 4];
        let wanted = bits(wanted);
        let of_pixel = (1 << TOGETHER) - 1;
        for pair in 0..LANES / (2 * TOGETHER) {
            let first = 2 * TOGETHER * pair;
            let second = first + TOGETHER;
            let mut places = [0.0; LANES];
            for k in 0..LANES {
                // Twice across and twice down; of four lanes that have one place these two as any.
                let lane = first + k / 4 * TOGETHER + k % 4 % TOGETHER;
                places[k] = if k % 4 < 2 { across[lane] } else { down[lane] };
            }
            let is_wanted = |first: usize| u32::from(wanted >> first & of_pixel != 0);
            let is_wanted = is_wanted(first) + 2 * is_wanted(second);
            let (colors, coverage) = self.image.at_two(&places, is_wanted, self.texture.repeats);
            for k in 0..TOGETHER {
                for channel in 0..3 {
                    texels[channel][first + k] = colors[0][channel];
                    texels[channel][second + k] = colors[1][channel];
                }
                texels[3][first + k] = coverage[0];
                texels[3][second + k] = coverage[1];
            }
        }
        texels
    }
}
