//! The same sample by sample: of hair that is hardly wider than a pixel cells are seldom covered by one clump, and samples are all that a
//! picture shows. Clumps are put one behind the other from the nearest on, and those whose strokes are hidden already, which are most, change
//! nothing and need not be looked at again.

use super::{Cover, FARTHEST_PX, Grid, LONGEST_PX, Level, MARGIN, Swath};
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
    /// Whether all of a swath that is in the picture is in the part.
    fn holds(&self, swath: &Swath) -> bool {
        let [columns, rows] = &self.part;
        let size = self.size.map(|side| side as f32);
        let within = |low: f32, high: f32, part: &Range<usize>, size: f32| {
            lesser(greater(low, 0.0), size) >= part.start as f32
                && greater(lesser(high, size), 0.0) <= part.end as f32
        };
        within(swath.low.x, swath.high.x, columns, size[0])
            && within(swath.low.y, swath.high.y, rows, size[1])
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
            band.put_surfaces(scene.surfaces);
            band.fill_large(0..across, 0..down);
            let mut seen = vec![false; hidden.len()];
            for clump in scene.clumps {
                for (link, pair) in clump.discs.windows(2).enumerate() {
                    let joint = clump.first + link;
                    let swath = swath(joint);
                    let is_held = scene.holds(&swath);
                    seen[joint] |= !is_held;
                    if band.is_beside(&swath) || is_held && band.hides(&swath) {
                        continue;
                    }
                    seen[joint] = true;
                    if link < clump.covering {
                        band.put([&pair[0], &pair[1]], scene.brush, scene.edge_depth_m);
                    }
                }
            }
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

impl<const N: usize> Band<'_, N> {
    /// Adds what lies between two discs.
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
        if self.is_beside(&swath) {
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
        let (wider, rise) = (radii[1] - radii[0], nearness[1] - nearness[0]);
        let rows = swath.rows(&grid);
        for row in rows.clone() {
            let (columns, _) = swath.in_row(&grid, row);
            let top = grid.origin.y + row as f32 - from.y;
            let left = grid.origin.x + columns.start as f32 - from.x;
            let pixels = &mut self.nearness[row * grid.across..][columns];
            for (i, pixel) in pixels.iter_mut().enumerate() {
                for k in 0..N {
                    let (x, y) = (left + i as f32 + self.x[k], top + self.y[k]);
                    let foot = x * along.x + y * along.y;
                    // Of the disc there its middle is as far from the sample as this.
                    let u = lesser(greater(foot + beyond, 0.0), 1.0);
                    let (x, y) = (x - u * way.x, y - u * way.y);
                    let squared = x * x + y * y;
                    let radius = greater(radii[0] + u * wider, 0.0);
                    let near = nearness[0] + u * rise;
                    let ratio = squared / greater(radius * radius, 1e-12);
                    let covers = (ratio <= 1.0) & (foot >= ends[0]) & (foot <= ends[1]);
                    // An edge lies deeper by the square of its place, at most by this.
                    let edge = near - edge_depth_m * near * near * ratio;
                    pixel[k] = if covers & (edge > pixel[k]) {
                        edge
                    } else {
                        pixel[k]
                    };
                }
            }
        }
        let columns = swath.columns(&grid);
        self.fill_large(columns, rows);
    }

    /// Whether none of a swath is there.
    fn is_beside(&self, swath: &Swath) -> bool {
        swath.high.cmplt(self.grid.origin).any() || swath.low.cmpgt(self.grid.end()).any()
    }

    /// Whether all samples in a swath's pixels show what is nearer.
    fn hides(&self, swath: &Swath) -> bool {
        let grid = &self.grid;
        let mut rows = swath.rows(grid);
        let columns = swath.columns(grid);
        let least = swath.nearest * (1.0 + MARGIN);
        let large_across = grid.across.div_ceil(LARGE);
        let mut large = rows.start / LARGE..rows.end.div_ceil(LARGE);
        let is_covered = large.all(|row| {
            let cells = &self.large[row * large_across..][..large_across];
            let cells = &cells[columns.start / LARGE..columns.end.div_ceil(LARGE)];
            cells
                .iter()
                .fold(true, |all, covered| all & (*covered > least))
        });
        is_covered
            || rows.all(|row| {
                let (columns, nearness) = swath.in_row(grid, row);
                let pixels = &self.nearness[row * grid.across..][columns];
                let least = nearness * (1.0 + MARGIN);
                let samples = pixels.as_flattened().iter();
                samples.fold(true, |all, covered| all & (*covered > least))
            })
    }

    /// Works out the larger cells anew that hold some columns and rows.
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
                for k in 0..N {
                    let place = Vec2::new(column as f32 + self.x[k], row as f32 + self.y[k]);
                    let within = sides.map(|(slope, start, _)| slope.dot(place.as_dvec2()) - start);
                    if within.iter().any(|within| *within < SMALLER_PX) {
                        continue;
                    }
                    let shares = [0, 1, 2].map(|i| (within[i] * sides[i].2) as f32 * depths[i]);
                    let depth = greater(shares.iter().sum::<f32>(), least);
                    // Of two that are one beside the other the lesser counts.
                    let is_nearer = depth > nearest[pixel][k] * (1.0 + MARGIN);
                    let is_as_near = depth * (1.0 + MARGIN) >= nearest[pixel][k];
                    // What is beyond a margin behind it shows nowhere.
                    let hides = match margin_m < 0.0 {
                        true => depth / (1.0 - margin_m * depth),
                        false => depth,
                    };
                    let covered = &mut self.nearness[pixel][k];
                    if is_nearer {
                        *covered = hides;
                    } else if is_as_near {
                        *covered = lesser(*covered, hides);
                    }
                    nearest[pixel][k] = greater(nearest[pixel][k], depth);
                }
            }
        }
    }
}
