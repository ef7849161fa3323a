//! Triangles in one tile: both sides, edges included, the nearest first.

use super::bin::{Bounds, MARGIN, clip};
use super::instructions::Instructions;
use super::set_up::SetUp;
use super::square::{squares, steps};
use super::texels::{Pictures, Texels};
use super::tile::{
    CELL_WIDTH, CELLS_ACROSS, LANES, OneByOne, Slope, Stack, StoreMask, Target, WIDTH, any, bits,
    greater, least, lesser, select,
};
use crate::drawing::{Coverage, Drawing, Surface, SurfaceVertex};
use glam::{DVec2, Vec2};
use rayon::prelude::*;
use std::hint::black_box;
use std::ops::Range;

/// A triangle of a drawing. One that can't be seen lies in no bounds.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    /// The surface's number, and its own among that one's.
    pub(super) surface: u32,
    pub(super) number: u32,
    pub(super) bounds: Bounds,
    /// Of its nearest corner, 1/m.
    pub(super) nearest: f32,
}

/// What a surface is drawn in.
struct Colors {
    light: [f32; 3],
    shadow: [f32; 3],
    /// Whether both are the same.
    is_flat: bool,
}

/// Samples of a tile's pixels, as many of each as a stack holds.
pub(super) struct Tile<'a> {
    /// Its first pixel.
    pub(super) origin: [usize; 2],
    pub(super) stack: &'a Stack,
}

/// Draws those of a tile, in the drawing's order, into the target's samples, and notes which pictures these show. Gives the cells' samples
/// where each triangle shows.
#[inline(always)]
pub(super) fn draw_all<'a>(
    all: &[Triangle],
    of_tile: &[u32],
    drawing: &'a Drawing,
    tile: &Tile,
    (target, pictures): (&mut Target, &mut Pictures<'a, '_>),
    mut shows: impl FnMut(usize, u32, &StoreMask),
) {
    let mut set_up = SetUp::NOTHING;
    let mut left = of_tile;
    while let Some(&first) = left.first() {
        // They come surface by surface.
        let number = all[first as usize].surface;
        let surface = (number, &drawing.surfaces[number as usize]);
        let to = (&mut *target, &mut *pictures);
        match &surface.1.texture {
            Some(texture) if texture.coverage != Coverage::Ignored => {
                draw_some::<true>(all, &mut left, surface, tile, &mut set_up, to, &mut shows);
            }
            _ => draw_some::<false>(all, &mut left, surface, tile, &mut set_up, to, &mut shows),
        }
    }
}

/// Draws the first triangles of those that are left, which are of one surface, some at a time, and takes them away. Twice, for pictures that leave samples
/// free and for all else, so that this doesn't pay for them.
#[inline(always)]
fn draw_some<'a, const CUT: bool>(
    all: &[Triangle],
    left: &mut &[u32],
    (of_surface, surface): (u32, &'a Surface),
    tile: &Tile,
    set_up: &mut SetUp,
    (target, pictures): (&mut Target, &mut Pictures<'a, '_>),
    shows: &mut impl FnMut(usize, u32, &StoreMask),
) {
    // What all of the tile shows is as near as this: most of a head's inside and outline is hidden at once.
    let farthest = target.farthest_surface();
    let [light, shadow] = surface.drawn_colors();
    let colors = Colors {
        light,
        shadow,
        is_flat: light == shadow,
    };
    loop {
        set_up.clear();
        while !set_up.is_full()
            && let Some((&number, others)) = left.split_first()
        {
            let triangle = &all[number as usize];
            if triangle.surface != of_surface {
                break;
            }
            *left = others;
            if triangle.nearest > farthest && !triangle.is_hidden(tile, target) {
                set_up.push(number, triangle, surface);
            }
        }
        if set_up.numbers().is_empty() {
            return;
        }
        set_up.work_out(surface.texture.is_some(), !colors.is_flat, tile);
        target.has_margins |= surface.margin_m != 0.0;
        for k in 0..set_up.numbers().len() {
            let number = set_up.numbers()[k];
            let triangle = &all[number as usize];
            let shows = |cell, lanes: &StoreMask| shows(cell, number, lanes);
            let to = (&mut *target, &mut *pictures);
            triangle.draw::<CUT>((surface, &colors), (set_up, k), tile, to, shows);
        }
    }
}

/// Replaces `triangles` by those of a checked drawing, in its order. The pixels' samples are those of `stacks`.
pub(super) fn collect(
    drawing: &Drawing,
    stacks: &[Stack],
    instructions: Instructions,
    triangles: &mut Vec<Triangle>,
) {
    let count = drawing.surfaces.iter().map(|it| it.triangles.len()).sum();
    triangles.resize(count, Triangle::NOWHERE);
    let mut left = &mut triangles[..];
    for (surface, number) in drawing.surfaces.iter().zip(0..) {
        let (own, others) = left.split_at_mut(surface.triangles.len());
        left = others;
        let some = own.par_chunks_mut(SOME).enumerate();
        some.for_each(|(chunk, triangles)| {
            instructions.run(
                #[inline(always)]
                || {
                    let first = chunk * SOME;
                    let corners = &surface.triangles[first..];
                    for (i, (triangle, corners)) in triangles.iter_mut().zip(corners).enumerate() {
                        let [a, b, c] = [
                            &surface.vertices[corners[0] as usize],
                            &surface.vertices[corners[1] as usize],
                            &surface.vertices[corners[2] as usize],
                        ];
                        *triangle = Triangle {
                            surface: number,
                            number: (first + i) as u32,
                            bounds: bounds_of([a, b, c], drawing.size, stacks),
                            nearest: greater(greater(a.inv_depth, b.inv_depth), c.inv_depth),
                        };
                    }
                },
            );
        });
    }
}

/// Triangles that are collected by a thread at once.
const SOME: usize = 1024;

/// The pixels that a triangle reaches; none where no sample is there.
#[inline(always)]
fn bounds_of([a, b, c]: [&SurfaceVertex; 3], size: [u32; 2], stacks: &[Stack]) -> Bounds {
    let (a, b, c) = (a.position, b.position, c.position);
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    match Bounds::of_box(low, high, size) {
        Some(bounds) if may_hold_sample(low, high, stacks) => bounds,
        _ => Bounds::default(),
    }
}

/// Whether any sample may lie in a box. A mesh that is far away has many triangles between two samples.
#[inline(always)]
fn may_hold_sample(low: Vec2, high: Vec2, stacks: &[Stack]) -> bool {
    let size = high - low;
    if size.x * size.y > SMALL_PX2 || size.max_element() >= 1.0 {
        return true;
    }
    stacks.iter().any(|stack| {
        (0..stack.samples).any(|k| {
            let sample = Vec2::new(stack.x[k], stack.y[k]);
            let (low, high) = (low - MARGIN - sample, high + MARGIN - sample);
            up(low.x) <= high.x && up(low.y) <= high.y
        })
    })
}

/// The next whole number, up to some thousands of millions: what is not compiled for newer instructions has to call a function to round up.
#[inline(always)]
fn up(x: f32) -> f32 {
    let whole = x as i32 as f32;
    if whole < x { whole + 1.0 } else { whole }
}

/// Larger boxes are taken to hold a sample, square pixels.
const SMALL_PX2: f32 = 0.25;

#[inline(always)]
fn twice_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

impl Triangle {
    /// One that isn't known yet.
    const NOWHERE: Self = Self {
        surface: 0,
        number: 0,
        bounds: Bounds::NOWHERE,
        nearest: 0.0,
    };

    #[inline(always)]
    pub(super) fn corners<'a>(&self, drawing: &'a Drawing) -> [&'a SurfaceVertex; 3] {
        let surface = &drawing.surfaces[self.surface as usize];
        let [a, b, c] = surface.triangles[self.number as usize];
        // Without closures, which are not sure to be compiled for their caller's instruction set.
        [
            &surface.vertices[a as usize],
            &surface.vertices[b as usize],
            &surface.vertices[c as usize],
        ]
    }

    /// Values of the corners as they run over the tile at `origin`; none of a triangle without an inside.
    #[inline(always)]
    pub(super) fn interpolated<const N: usize>(
        &self,
        drawing: &Drawing,
        origin: [usize; 2],
        values: [[f32; 3]; N],
    ) -> Option<[Interpolated; N]> {
        let [a, b, c] = self.corners(drawing);
        let corner = DVec2::new(origin[0] as f64, origin[1] as f64);
        let seen = |vertex: &SurfaceVertex| vertex.position.as_dvec2() - corner;
        let points = [seen(a), seen(b), seen(c)];
        let area = twice_area(points);
        let edges = [
            Edge::new(points[1], points[2]),
            Edge::new(points[2], points[0]),
            Edge::new(points[0], points[1]),
        ];
        if area == 0.0 {
            return None;
        }
        Some(Interpolated::new(&values, &edges, area))
    }

    /// The rows of stacks and the cells of each row that it may reach in a tile.
    #[inline(always)]
    fn cells(&self, tile: &Tile) -> [Range<usize>; 2] {
        let rows = self.bounds.rows_in(tile.origin[1], tile.stack);
        let columns = clip(self.bounds.x(), tile.origin[0], WIDTH);
        let across = columns.start / CELL_WIDTH..columns.end.div_ceil(CELL_WIDTH);
        [rows, across]
    }

    /// Whether all of the cells that it may reach show a surface that is no farther.
    #[inline(always)]
    fn is_hidden(&self, tile: &Tile, target: &Target) -> bool {
        let [rows, across] = self.cells(tile);
        for row in rows {
            let cells = row * CELLS_ACROSS + across.start..row * CELLS_ACROSS + across.end;
            for farthest in &target.farthest_surface[cells] {
                if self.nearest > *farthest {
                    return false;
                }
            }
        }
        true
    }

    /// Draws the triangle's part of a tile into the target's samples, as it is set up. Gives the cells' samples where it shows.
    #[inline(always)]
    fn draw<'a, const CUT: bool>(
        &self,
        (surface, colors): (&'a Surface, &Colors),
        (set_up, own): (&SetUp, usize),
        tile: &Tile,
        (target, pictures): (&mut Target, &mut Pictures<'a, '_>),
        mut shows: impl FnMut(usize, &StoreMask),
    ) {
        let Colors {
            light,
            shadow,
            is_flat,
        } = *colors;
        if set_up.twice_area[own] == 0.0 {
            return; // it has no inside
        }
        let stack = tile.stack;
        let inside = set_up.inside(own);
        let most_inside = set_up.most_inside(own);
        let depths = set_up.depths(own);
        let [a, b, c] = &inside;
        let at = [
            a.at_samples(stack),
            b.at_samples(stack),
            c.at_samples(stack),
        ];
        let depth_at = depths.slope.at_samples(stack);
        // Between corners that are all in light, or all in shadow, nothing else is.
        let tones = set_up.tones(own);
        let is_dark = tones.greatest < 0.0;
        let is_one_color = (tones.least >= 0.0) | is_dark | is_flat;
        let one_color = if is_dark { shadow } else { light };
        // Of a picture that is cut its texels, of others their number once any sample shows it.
        let cut = match &surface.texture {
            Some(texture) if CUT => Some(Texels::new(texture, (set_up, own))),
            _ => None,
        };
        let mut picture = 0;
        for square in squares(self.cells(tile)) {
            let places = square.places();
            let steps = [
                steps(places, &inside[0], stack),
                steps(places, &inside[1], stack),
                steps(places, &inside[2], stack),
                steps(places, &depths.slope, stack),
            ];
            // By way of memory, where each of them is looked up: compilers would work out single ones.
            let steps = black_box(&steps);
            // Cells that may have a sample inside, as far as each edge by itself can tell, and don't all show what is nearer.
            let farthest = square.of(&target.farthest_surface);
            let mut open = [0; LANES];
            for k in 0..LANES {
                let [a, b, c] = [
                    most_inside[0] + steps[0][k],
                    most_inside[1] + steps[1][k],
                    most_inside[2] + steps[2][k],
                ];
                open[k] = select(lesser(lesser(a, b), c) >= 0.0, u32::MAX, 0)
                    & select(depths.greatest > farthest[k], u32::MAX, 0);
            }
            for number in OneByOne::of_bits(bits(black_box(&open)) & square.cells) {
                let cell = square.cell(number);
                let [a, b, c] = [
                    at[0].and(steps[0][number]),
                    at[1].and(steps[1][number]),
                    at[2].and(steps[2][number]),
                ];
                let mut wins = [0_u32; LANES];
                for k in 0..LANES {
                    let is_inside = lesser(lesser(a[k], b[k]), c[k]) >= 0.0;
                    wins[k] = select(is_inside, u32::MAX, 0);
                }
                if !any(&wins) {
                    continue;
                }
                let mut depth = depth_at.and(steps[3][number]);
                let nearest = &target.surface[cell.index];
                for k in 0..LANES {
                    depth[k] = depths.clamp(depth[k]);
                    wins[k] &= select(depth[k] > nearest[k], u32::MAX, 0);
                }
                if !any(&wins) {
                    continue;
                }
                let mut texel = [[1.0; LANES]; 3];
                if let Some(texels) = &cut {
                    texel = texels.cut(cell, stack, self.surface, &mut wins);
                    if !any(&wins) {
                        continue;
                    }
                }
                let wins = StoreMask::new(&wins);
                shows(cell.index, &wins);
                if !CUT
                    && picture == 0
                    && let Some(texture) = &surface.texture
                {
                    picture = pictures.push(Texels::new(texture, (set_up, own)));
                }
                if !pictures.is_empty() {
                    pictures.put(cell.index, picture, &wins);
                }
                let nearest = &mut target.surface[cell.index];
                wins.store(&depth, nearest);
                target.farthest_surface[cell.index] = least(nearest);
                if target.has_margins {
                    let margin = [surface.margin_m; LANES];
                    wins.store(&margin, &mut target.margin[cell.index]);
                }
                let mut is_light = [u32::MAX; LANES];
                if !is_one_color {
                    let tone = tones.slope.at_samples(stack).of(cell);
                    for k in 0..LANES {
                        is_light[k] = select(tones.clamp(tone[k]) >= 0.0, u32::MAX, 0);
                    }
                }
                for (channel, plane) in target.color.iter_mut().enumerate() {
                    let (light, shadow) = (light[channel], shadow[channel]);
                    let mut color = [one_color[channel]; LANES];
                    if !is_one_color {
                        for k in 0..LANES {
                            color[k] = select(is_light[k] != 0, light, shadow);
                        }
                    }
                    if CUT {
                        for k in 0..LANES {
                            color[k] *= texel[channel][k];
                        }
                    }
                    wins.store(&color, &mut plane[cell.index]);
                }
            }
        }
    }
}

/// The signed, doubled area between an edge and a point: above 0 on the edge's one side. Worked out
/// from the same end for both triangles at an edge, so that their values are exactly opposite, and no
/// sample between them is lost.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    pub(super) corner: f64,
    pub(super) per_x: f64,
    pub(super) per_y: f64,
}

impl Edge {
    /// Positions are seen from the tile's corner.
    #[inline(always)]
    pub(super) fn new(from: DVec2, to: DVec2) -> Self {
        let is_turned = (to.x, to.y) < (from.x, from.y);
        let (low, high) = if is_turned { (to, from) } else { (from, to) };
        let along = high - low;
        let sign = if is_turned { -1.0 } else { 1.0 };
        Self {
            corner: sign * -along.perp_dot(low),
            per_x: sign * -along.y,
            per_y: sign * along.x,
        }
    }
}

/// A value of the corners that runs linearly on the screen, and never beyond them: a needle's slope
/// is too steep for single precision.
#[derive(Clone, Copy)]
pub(super) struct Interpolated {
    pub(super) slope: Slope,
    pub(super) least: f32,
    pub(super) greatest: f32,
}

impl Interpolated {
    /// 0 everywhere.
    pub(super) const ZERO: Self = Self {
        slope: Slope {
            corner: 0.0,
            per_x: 0.0,
            per_y: 0.0,
        },
        least: 0.0,
        greatest: 0.0,
    };

    /// Of some values at once, which quotients in double precision are faster by.
    #[inline(always)]
    pub(super) fn new<const N: usize>(
        values: &[[f32; 3]; N],
        [e, f, g]: &[Edge; 3],
        area: f64,
    ) -> [Self; N] {
        let mut means = [[0.0; N]; 3];
        for (mean, [e, f, g]) in means.iter_mut().zip([
            [e.corner, f.corner, g.corner],
            [e.per_x, f.per_x, g.per_x],
            [e.per_y, f.per_y, g.per_y],
        ]) {
            for i in 0..N {
                let [v, w, x] = values[i];
                let sum = e * f64::from(v) + f * f64::from(w) + g * f64::from(x);
                mean[i] = (sum / area) as f32;
            }
        }
        let mut interpolated = [Self::ZERO; N];
        for i in 0..N {
            let [a, b, c] = values[i];
            interpolated[i] = Self {
                slope: Slope {
                    corner: means[0][i],
                    per_x: means[1][i],
                    per_y: means[2][i],
                },
                least: lesser(lesser(a, b), c),
                greatest: greater(greater(a, b), c),
            };
        }
        interpolated
    }

    #[inline(always)]
    pub(super) fn clamp(&self, value: f32) -> f32 {
        lesser(greater(value, self.least), self.greatest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::sample_positions;
    use proptest::prelude::*;

    proptest! {
        /// No triangle is left out that has a sample.
        #[test]
        fn a_box_around_a_sample_is_not_left_out(
            samples in prop::sample::select(vec![1_u32, 2, 3, 4, 8, 16]),
            (column, row) in (0..16384_u32, 0..16384_u32),
            (left, right, above, below) in (0.0..0.5_f32, 0.0..0.5_f32, 0.0..0.5_f32, 0.0..0.5_f32),
            number in 0..16_usize,
        ) {
            let positions = sample_positions(samples).unwrap();
            let stacks = Stack::of_pixel(&positions);
            let sample = positions[number % positions.len()] + Vec2::new(column as f32, row as f32);
            let (low, high) = (sample - Vec2::new(left, above), sample + Vec2::new(right, below));
            prop_assert!(may_hold_sample(low, high, &stacks));
        }
    }

    #[test]
    fn most_boxes_between_samples_are_left_out() {
        let stacks = Stack::of_pixel(&sample_positions(4).unwrap());
        let held = (0..100 * 100).filter(|i| {
            let low = Vec2::new((i % 100) as f32, (i / 100) as f32) / 100.0 + 7.0;
            may_hold_sample(low, low + 0.1, &stacks)
        });
        // Four samples, each in 0.12 x 0.12 of the places.
        let held = held.count();
        assert!((450..700).contains(&held), "{held} of 10,000");
    }
}
