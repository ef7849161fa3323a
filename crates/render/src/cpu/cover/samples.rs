//! The same sample by sample: of hair that is hardly wider than a pixel cells are seldom covered by one clump, and samples are all that a
//! picture shows. Clumps are put one behind the other from the nearest on, and those whose strokes are hidden already, which are most, change
//! nothing and need not be looked at again.

use super::{Area, Cover, FARTHEST_PX, Grid, LONGEST_PX, Level, MARGIN, Swath};
use crate::cpu::instructions::Instructions;
use crate::cpu::tile::{greater, lesser};
use crate::drawing::{Brush, Coverage, Disc, Surface};
use glam::{DVec2, Vec2};
use rayon::prelude::*;
use std::ops::Range;

/// Clumps count as so much thinner than they are, and triangles as so much smaller, pixels: that makes up for rounding.
const THINNER_PX: f32 = 1.0 / 128.0;
const SMALLER_PX: f64 = 1.0 / 4096.0;

/// Half discs end at the foot of a sample, or begin there: those so much farther along cover it for sure, px.
const BEYOND_PX: f32 = 1.0 / 16.0;

/// Most samples of a picture's part that are looked at: 64 MB.
const MOST: usize = 1 << 24;

/// Sides of larger cells, pixels: where all of one is covered, that is known at once.
const LARGE: usize = 4;

/// Links of a clump that are looked at together first: most hair is hidden, and so are its neighbours.
const GROUP: usize = 8;

/// The clump of a run of joints.
pub(in crate::cpu) struct Clump<'a> {
    /// The first of them.
    pub(in crate::cpu) first: usize,
    pub(in crate::cpu) discs: &'a [Disc],
    /// How many of its links, from the first on, are seen wherever nothing is before them.
    pub(in crate::cpu) covering: usize,
}

/// What may hide hair.
pub(in crate::cpu) struct Scene<'a> {
    /// The picture's size, and the part of it that is looked at, pixels.
    pub(in crate::cpu) size: [u32; 2],
    pub(in crate::cpu) part: [Range<usize>; 2],
    pub(in crate::cpu) surfaces: &'a [Surface],
    pub(in crate::cpu) brush: Brush,
    pub(in crate::cpu) edge_depth_m: f32,
    /// Best from the nearest on.
    pub(in crate::cpu) clumps: &'a [Clump<'a>],
}

impl Scene<'_> {
    /// Whether all of an area that is in the picture is in the part.
    #[inline(always)]
    fn holds(&self, area: &Area) -> bool {
        let [columns, rows] = &self.part;
        let size = self.size.map(|side| side as f32);
        let within = |low: f32, high: f32, part: &Range<usize>, size: f32| {
            lesser(greater(low, 0.0), size) >= part.start as f32
                && greater(lesser(high, size), 0.0) <= part.end as f32
        };
        within(area.low.x, area.high.x, columns, size[0])
            && within(area.low.y, area.high.y, rows, size[1])
    }
}

/// Samples of some rows of pixels, `N` in each.
struct Band<'a, const N: usize> {
    grid: Grid,
    /// Where in a pixel they lie.
    x: [f32; N],
    y: [f32; N],
    /// Of each sample of each pixel, row by row, what hides all that lies deeper, 1/m.
    nearness: &'a mut [[f32; N]],
    /// The least of each larger cell.
    large: Vec<f32>,
}

impl Cover {
    /// That of a picture with those samples in each pixel. `swath` is that of all strokes between a joint and the next one; of those that are
    /// known to be hidden `hidden` says so, by the first joint. Whether it is worth while to look at so many samples; else all is as it was.
    pub(in crate::cpu) fn fill_by_samples(
        &mut self,
        samples: &[Vec2],
        scene: &Scene,
        swath: &(impl Fn(usize) -> Swath + Sync),
        hidden: &mut [bool],
    ) -> bool {
        match samples.len() {
            1 => self.fill_by::<1>(samples, scene, swath, hidden),
            2 => self.fill_by::<2>(samples, scene, swath, hidden),
            4 => self.fill_by::<4>(samples, scene, swath, hidden),
            8 => self.fill_by::<8>(samples, scene, swath, hidden),
            16 => self.fill_by::<16>(samples, scene, swath, hidden),
            _ => false,
        }
    }

    fn fill_by<const N: usize>(
        &mut self,
        samples: &[Vec2],
        scene: &Scene,
        swath: &(impl Fn(usize) -> Swath + Sync),
        hidden: &mut [bool],
    ) -> bool {
        let [columns, rows] = &scene.part;
        let (across, down) = (columns.len(), rows.len());
        if across * down == 0 || across * down > MOST / N {
            return false;
        }
        let mut nearness = vec![[0.0; N]; across * down];
        let grid = |top: usize, down: usize| Grid {
            origin: Vec2::new(columns.start as f32, top as f32),
            cell_px: 1.0,
            across,
            down,
        };
        // What is hidden changes nothing, so that all is the same by any number of threads.
        let rows_of_band = down.div_ceil(rayon::current_num_threads());
        let bands = nearness.par_chunks_mut(across * rows_of_band).enumerate();
        let seen = bands.map(|(number, nearness)| {
            let down = nearness.len() / across;
            let top = rows.start + number * rows_of_band;
            let mut band = Band {
                grid: grid(top, down),
                x: std::array::from_fn(|k| samples[k].x),
                y: std::array::from_fn(|k| samples[k].y),
                nearness,
                large: vec![0.0; across.div_ceil(LARGE) * down.div_ceil(LARGE)],
            };
            let mut seen = vec![false; hidden.len()];
            Instructions::best().run(
                #[inline(always)]
                || band.put_all(scene, swath, &mut seen),
            );
            seen
        });
        let seen: Vec<Vec<bool>> = seen.collect();
        for clump in scene.clumps {
            for joint in clump.first..clump.first + clump.discs.len().saturating_sub(1) {
                hidden[joint] = !seen.iter().any(|seen| seen[joint]);
            }
        }
        let first = Level {
            grid: grid(rows.start, down),
            nearness: nearness
                .iter()
                .map(|samples| samples.iter().copied().fold(f32::INFINITY, lesser))
                .collect(),
        };
        self.set(scene.size, Some(first));
        true
    }
}

/// What lies between two discs, seen from the first one's middle.
struct Between {
    /// To the other's middle, px, and the same over the square of its length.
    way: Vec2,
    along: Vec2,
    /// Shares of the way: where what it covers begins and ends, and how much farther along the disc is that covers a place.
    ends: [f32; 2],
    beyond: f32,
    /// The radius there, px, and how much larger the other is.
    radius: f32,
    wider: f32,
    /// How near it is there, 1/m, and how much nearer the other.
    nearness: f32,
    rise: f32,
    edge_depth_m: f32,
}

impl Between {
    /// Covers those of some places (px) that it reaches and that show what is deeper. Whether there are any.
    #[inline(always)]
    fn cover<const N: usize>(&self, x: &[f32; N], y: &[f32; N], nearness: &mut [f32; N]) -> bool {
        let mut is_nearer = 0;
        for k in 0..N {
            let foot = x[k] * self.along.x + y[k] * self.along.y;
            // Of the disc there its middle is as far from the sample as this.
            let u = lesser(greater(foot + self.beyond, 0.0), 1.0);
            let (x, y) = (x[k] - u * self.way.x, y[k] - u * self.way.y);
            let squared = x * x + y * y;
            let radius = greater(self.radius + u * self.wider, 0.0);
            let near = self.nearness + u * self.rise;
            let ratio = squared / greater(radius * radius, 1e-12);
            let covers = (ratio <= 1.0) & (foot >= self.ends[0]) & (foot <= self.ends[1]);
            // An edge lies deeper by the square of its place, at most by this.
            let edge = near - self.edge_depth_m * near * near * ratio;
            let shows = covers & (edge > nearness[k]);
            nearness[k] = if shows { edge } else { nearness[k] };
            is_nearer |= u32::from(shows);
        }
        is_nearer != 0
    }
}

/// The area of some swaths, and how near they are at most, 1/m.
#[inline(always)]
fn around(swaths: &[Swath]) -> (Area, f32) {
    let mut area = swaths[0].area();
    let mut nearest = swaths[0].nearest;
    for swath in &swaths[1..] {
        area.low = area.low.min(swath.low);
        area.high = area.high.max(swath.high);
        nearest = greater(nearest, swath.nearest);
    }
    (area, nearest)
}

/// Whether all that hides lies before what is no nearer than this, 1/m.
#[inline(always)]
fn all_nearer<const N: usize>(hiding: &[[f32; N]], nearness: f32) -> bool {
    let least = nearness * (1.0 + MARGIN);
    let mut all = [u32::MAX; N];
    for hiding in hiding {
        for k in 0..N {
            all[k] &= if hiding[k] > least { u32::MAX } else { 0 };
        }
    }
    all == [u32::MAX; N]
}

/// The lesser of two numbers, neither NaN.
#[inline(always)]
fn lesser_f64(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

impl<const N: usize> Band<'_, N> {
    /// Adds surfaces and clumps, and tells of which joints something is seen.
    #[inline(always)]
    fn put_all(&mut self, scene: &Scene, swath: &impl Fn(usize) -> Swath, seen: &mut [bool]) {
        self.put_surfaces(scene.surfaces);
        self.fill_large(0..self.grid.across, 0..self.grid.down);
        let mut swaths = Vec::with_capacity(GROUP);
        for clump in scene.clumps {
            let count = clump.discs.len().saturating_sub(1);
            for start in (0..count).step_by(GROUP) {
                let links = start..count.min(start + GROUP);
                swaths.clear();
                for link in links.clone() {
                    swaths.push(swath(clump.first + link));
                }
                let (area, nearest) = around(&swaths);
                if scene.holds(&area) && (self.is_beside(&area) || self.hides_all(&area, nearest)) {
                    continue;
                }
                for (link, swath) in links.zip(&swaths) {
                    let area = swath.area();
                    let is_held = scene.holds(&area);
                    let joint = clump.first + link;
                    seen[joint] |= !is_held;
                    if self.is_beside(&area) || is_held && self.hides(swath) {
                        continue;
                    }
                    seen[joint] = true;
                    if link < clump.covering {
                        let pair = [&clump.discs[link], &clump.discs[link + 1]];
                        self.put(pair, scene.brush, scene.edge_depth_m);
                    }
                }
            }
        }
    }

    /// Adds what lies between two discs.
    #[inline(always)]
    fn put(&mut self, [a, b]: [&Disc; 2], brush: Brush, edge_depth_m: f32) {
        let grid = self.grid;
        let radii = [a, b].map(|disc| disc.radius - THINNER_PX);
        let reach_px = greater(radii[0], radii[1]);
        let (from, way) = (a.center, b.center - a.center);
        let nearness = [a, b].map(|disc| lesser(disc.inv_depth, disc.inv_depth_biased));
        let farthest = greater(a.center.abs().max_element(), b.center.abs().max_element());
        let length = way.length();
        let is_cover = farthest < FARTHEST_PX
            && length < LONGEST_PX
            && reach_px > 0.0
            && reach_px < LONGEST_PX
            && lesser(nearness[0], nearness[1]) > 0.0;
        if !is_cover {
            return;
        }
        let swath = Swath::new([a.center, b.center], reach_px, nearness);
        let area = swath.area();
        if self.is_beside(&area) {
            return;
        }
        let along = way / greater(length * length, f32::MIN_POSITIVE);
        // Shares of the way: half discs cover what is beside the link alone, a little farther along.
        let (ends, beyond) = match brush {
            Brush::Circle => ([f32::NEG_INFINITY, f32::INFINITY], 0.0),
            Brush::Semicircle => {
                let beyond = BEYOND_PX / greater(length, f32::MIN_POSITIVE);
                ([0.0, 1.0 - beyond], beyond)
            }
        };
        let between = Between {
            along,
            way,
            ends,
            beyond,
            radius: radii[0],
            wider: radii[1] - radii[0],
            nearness: nearness[0],
            rise: nearness[1] - nearness[0],
            edge_depth_m,
        };
        let (all_columns, rows) = (area.columns(&grid), area.rows(&grid));
        let mut is_nearer = false;
        for row in rows.clone() {
            let (columns, _) = swath.in_row(&grid, row);
            let top = grid.origin.y + row as f32 - from.y;
            let left = grid.origin.x + columns.start as f32 - from.x;
            let pixels = &mut self.nearness[row * grid.across..][columns];
            for (i, pixel) in pixels.iter_mut().enumerate() {
                let (mut x, mut y) = ([0.0; N], [0.0; N]);
                for k in 0..N {
                    (x[k], y[k]) = (left + i as f32 + self.x[k], top + self.y[k]);
                }
                is_nearer |= between.cover(&x, &y, pixel);
            }
        }
        if is_nearer {
            self.fill_large(all_columns, rows);
        }
    }

    /// Whether none of an area is there.
    #[inline(always)]
    fn is_beside(&self, area: &Area) -> bool {
        area.high.cmplt(self.grid.origin).any() || area.low.cmpgt(self.grid.end()).any()
    }

    /// Whether all larger cells that a part of the picture reaches show what is nearer than this, 1/m.
    #[inline(always)]
    fn hides_all(&self, area: &Area, nearest: f32) -> bool {
        let (rows, columns) = (area.rows(&self.grid), area.columns(&self.grid));
        let large_across = self.grid.across.div_ceil(LARGE);
        // Loops, because closures in iterators are not sure to be compiled for their caller's instruction set.
        for row in rows.start / LARGE..rows.end.div_ceil(LARGE) {
            let cells = &self.large[row * large_across..][..large_across];
            let cells = &cells[columns.start / LARGE..columns.end.div_ceil(LARGE)];
            if !all_nearer(cells.as_chunks::<1>().0, nearest) {
                return false;
            }
        }
        true
    }

    /// Whether all samples in a swath's pixels show what is nearer.
    #[inline(always)]
    fn hides(&self, swath: &Swath) -> bool {
        let (grid, area) = (&self.grid, swath.area());
        if self.hides_all(&area, swath.nearest) {
            return true;
        }
        let rows = area.rows(grid);
        for row in rows {
            let (columns, nearness) = swath.in_row(grid, row);
            let pixels = &self.nearness[row * grid.across..][columns];
            if !all_nearer(pixels, nearness) {
                return false;
            }
        }
        true
    }

    /// Works out the larger cells anew that hold some columns and rows.
    #[inline(always)]
    fn fill_large(&mut self, columns: Range<usize>, rows: Range<usize>) {
        let Grid { across, down, .. } = self.grid;
        let large_across = across.div_ceil(LARGE);
        for row in rows.start / LARGE..rows.end.div_ceil(LARGE) {
            for column in columns.start / LARGE..columns.end.div_ceil(LARGE) {
                let own = column * LARGE..((column + 1) * LARGE).min(across);
                let mut least = [f32::INFINITY; N];
                for row in row * LARGE..((row + 1) * LARGE).min(down) {
                    for pixel in &self.nearness[row * across..][own.clone()] {
                        for k in 0..N {
                            least[k] = lesser(least[k], pixel[k]);
                        }
                    }
                }
                self.large[row * large_across + column] =
                    least.into_iter().fold(f32::INFINITY, lesser);
            }
        }
    }

    /// Takes what the nearest surface hides at each sample; nothing where it may have holes, and hair may be behind it.
    #[inline(always)]
    fn put_surfaces(&mut self, surfaces: &[Surface]) {
        let has_holes = |surface: &Surface| {
            let texture = surface.texture.as_ref();
            texture.is_some_and(|texture| texture.coverage != Coverage::Ignored)
        };
        let is_unknown = |surface: &Surface| has_holes(surface) && surface.margin_m < 0.0;
        if surfaces.is_empty() || surfaces.iter().any(is_unknown) {
            return;
        }
        let mut nearest = vec![[0.0; N]; self.nearness.len()];
        for surface in surfaces.iter().filter(|surface| !has_holes(surface)) {
            for triangle in &surface.triangles {
                let corners = triangle.map(|i| &surface.vertices[i as usize]);
                let places = corners.map(|corner| corner.position);
                let depths = corners.map(|corner| corner.inv_depth);
                self.put_triangle(places, depths, surface.margin_m, &mut nearest);
            }
        }
    }

    #[inline(always)]
    fn put_triangle(
        &mut self,
        corners: [Vec2; 3],
        depths: [f32; 3],
        margin_m: f32,
        nearest: &mut [[f32; N]],
    ) {
        let Grid {
            origin,
            across,
            down,
            ..
        } = self.grid;
        let [a, b, c] = corners;
        let low = (a.min(b).min(c) - origin).floor();
        let high = (a.max(b).max(c) - origin).floor();
        let end = Vec2::new(across as f32, down as f32);
        let is_there = low.cmplt(end).all() && high.cmpge(Vec2::ZERO).all();
        let corner = origin.as_dvec2();
        let [a, b, c] = corners.map(|place| place.as_dvec2() - corner);
        let twice_area = (b - a).perp_dot(c - a);
        if !is_there || twice_area == 0.0 {
            return;
        }
        // Of each side: how far within it a place is, px, and its share of the corner across.
        let side = |from: DVec2, to: DVec2| {
            let way = (to - from) * twice_area.signum();
            let length = way.length();
            let slope = DVec2::new(-way.y, way.x) / length;
            (slope, slope.dot(from), length / twice_area.abs())
        };
        let sides = [side(b, c), side(c, a), side(a, b)];
        let range = |low: f32, high: f32, count: usize| {
            low.max(0.0) as usize..(high as usize + 1).min(count)
        };
        let (columns, rows) = (range(low.x, high.x, across), range(low.y, high.y, down));
        let least = depths.into_iter().fold(f32::INFINITY, lesser);
        for row in rows {
            for column in columns.clone() {
                let pixel = row * across + column;
                let mut within = [[0.0; N]; 3];
                for (within, (slope, start, _)) in within.iter_mut().zip(&sides) {
                    for k in 0..N {
                        let place = Vec2::new(column as f32 + self.x[k], row as f32 + self.y[k]);
                        within[k] = slope.dot(place.as_dvec2()) - start;
                    }
                }
                let mut is_within = [false; N];
                for k in 0..N {
                    let least = lesser_f64(lesser_f64(within[0][k], within[1][k]), within[2][k]);
                    is_within[k] = least >= SMALLER_PX;
                }
                if is_within == [false; N] {
                    continue;
                }
                let (nearest, covered) = (&mut nearest[pixel], &mut self.nearness[pixel]);
                for k in (0..N).filter(|&k| is_within[k]) {
                    let share = |i: usize| (within[i][k] * sides[i].2) as f32 * depths[i];
                    let depth = greater(share(0) + share(1) + share(2), least);
                    // Of two that are one beside the other the lesser counts.
                    let is_nearer = depth > nearest[k] * (1.0 + MARGIN);
                    let is_as_near = depth * (1.0 + MARGIN) >= nearest[k];
                    // What is beyond a margin behind it shows nowhere.
                    let hides = match margin_m < 0.0 {
                        true => depth / (1.0 - margin_m * depth),
                        false => depth,
                    };
                    if is_nearer {
                        covered[k] = hides;
                    } else if is_as_near {
                        covered[k] = lesser(covered[k], hides);
                    }
                    nearest[k] = greater(nearest[k], depth);
                }
            }
        }
    }
}
