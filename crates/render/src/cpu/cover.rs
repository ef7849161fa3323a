//! What hair hides of itself: which small parts of the picture clumps cover wholly, and how near. What lies behind a cover there is in no
//! picture, and dense hair is mostly that.
//!
//! Where it is known which samples a picture has, thin hair is looked at sample by sample (`samples`), and skin hides too; else
//! cells must be covered by one clump.

use super::tile::{greater, lesser};
use crate::drawing::{Brush, Disc};
use glam::Vec2;
use rayon::prelude::*;
use std::ops::Range;

mod samples;

pub(super) use samples::{Clump, Scene};

/// Sides of cells, pixels: a cell is the least part of the picture of which it is known whether it is covered.
const CELLS_PX: [f32; 2] = [0.5, 8.0];

/// The most first cells of all threads together: 256 MB. Larger cells hide less.
const MOST_CELLS: usize = 1 << 26;

/// Clumps count as so much thinner than they are, pixels, and what they hide as so much nearer, by its depth: that makes up for rounding.
const MARGIN_PX: f32 = 1.0 / 16.0;
const MARGIN: f32 = 1e-4;

/// Discs farther from the picture's corner than this (px) hide nothing: rounding would decide.
const FARTHEST_PX: f32 = 2e4;
/// Neither do longer links, px.
const LONGEST_PX: f32 = 2e3;

/// Most cells across a swath, and along it, that are looked at, of the size at which there are no more.
const MOST_ACROSS: f32 = 8.0;
const MOST_ALONG: f32 = 64.0;

/// How near the picture is covered.
///
/// A nearness is an inverse depth, 1/m: of a clump's two, the order among strands and that against surfaces, the lesser where it covers, and
/// the greater where it is covered. So what is behind a cover by its nearness is behind by both, and where a surface hides the
/// clump that covers, it hides what is behind too.
#[derive(Default)]
pub(super) struct Cover {
    /// By the size of their cells, each twice as large as the one before.
    levels: Vec<Level>,
    /// The picture's, pixels.
    size: Vec2,
}

/// Cells of one size.
#[derive(Clone, Default)]
struct Level {
    grid: Grid,
    /// Of each cell, row by row: what lies deeper isn't seen anywhere in it. 0 where nothing covers it.
    nearness: Vec<f32>,
}

/// Square cells of a part of the picture.
#[derive(Clone, Copy, Default)]
struct Grid {
    /// The upper left corner, pixels.
    origin: Vec2,
    cell_px: f32,
    across: usize,
    down: usize,
}

/// Two neighbouring discs of a clump that is seen wherever nothing is before it.
pub(super) type Link<'a> = [&'a Disc; 2];

/// A box on the screen, pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub(super) low: Vec2,
    pub(super) high: Vec2,
}

impl Area {
    /// Whether two have a point in common.
    pub(super) fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    /// The rows of a grid that it may reach.
    #[inline(always)]
    fn rows(&self, grid: &Grid) -> Range<usize> {
        let [low, high] =
            [self.low.y, self.high.y].map(|y| grid.cell(y - grid.origin.y, grid.down));
        low..high + 1
    }

    /// The columns of a grid that it may reach.
    #[inline(always)]
    fn columns(&self, grid: &Grid) -> Range<usize> {
        let [low, high] =
            [self.low.x, self.high.x].map(|x| grid.cell(x - grid.origin.x, grid.across));
        low..high + 1
    }
}

/// What lies between two joints, so far around the line between them at most.
pub(super) struct Swath {
    from: Vec2,
    low: Vec2,
    high: Vec2,
    reach_px: f32,
    /// On the line, for each pixel down: pixels to the right, and shares of the way; how far the sides are to the left and the right, in
    /// parts of the reach. Of a line that is nearly level the sides are infinitely far.
    right: f32,
    share: f32,
    sides: f32,
    /// How near it is at the line's beginning at most, 1/m, how much nearer at its end, and anywhere.
    nearness: f32,
    rise: f32,
    nearest: f32,
}

impl Swath {
    /// That around the line between two places on the screen (px), no nearer at each than that, 1/m, and between them than what runs linearly.
    #[inline(always)]
    pub(super) fn new([from, to]: [Vec2; 2], reach_px: f32, nearness: [f32; 2]) -> Self {
        let way = to - from;
        let farthest = greater(from.abs().max_element(), to.abs().max_element());
        let is_level = way.y.abs() < 0.02 * way.x.abs()
            || way.y.abs() < 0.02
            || farthest.is_nan()
            || farthest > FARTHEST_PX;
        let [right, share, sides] = match is_level {
            true => [0.0, 0.0, f32::INFINITY],
            false => [way.x, 1.0, way.length()].map(|length| length / way.y),
        };
        Self {
            from,
            low: from.min(to) - reach_px,
            high: from.max(to) + reach_px,
            reach_px,
            right,
            share,
            sides: sides.abs(),
            nearness: nearness[0],
            rise: match is_level {
                true => 0.0,
                false => nearness[1] - nearness[0],
            },
            nearest: greater(nearness[0], nearness[1]),
        }
    }

    /// The box around it.
    #[inline(always)]
    fn area(&self) -> Area {
        Area {
            low: self.low,
            high: self.high,
        }
    }

    /// The columns that it may reach in a row, and how near it is there at most.
    #[inline(always)]
    fn in_row(&self, grid: &Grid, row: usize) -> (Range<usize>, f32) {
        let half = 0.5 * grid.cell_px;
        let y = grid.origin.y + row as f32 * grid.cell_px + half - self.from.y;
        let middle = self.from.x + y * self.right;
        let beside = self.reach_px * self.sides + half * self.right.abs();
        let low = greater(self.low.x, middle - beside);
        let high = lesser(self.high.x, middle + beside);
        if high < low {
            return (0..0, 0.0);
        }
        let [first, last] = [low, high].map(|x| grid.cell(x - grid.origin.x, grid.across));
        let nearness = match self.rise == 0.0 {
            true => self.nearest,
            false => {
                let over = (self.reach_px + half) * (self.share * self.rise).abs();
                lesser(
                    self.nearest,
                    self.nearness + y * self.share * self.rise + over,
                )
            }
        };
        (first..last + 1, nearness)
    }
}

impl Grid {
    /// The cell at so many pixels from the grid's beginning, of so many; the first or the last one beyond them.
    #[inline(always)]
    fn cell(&self, place: f32, count: usize) -> usize {
        // Also of what is farther than can be counted. In 32 bits, which a picture's side fits in: they turn into numbers faster.
        ((greater(place, 0.0) / self.cell_px) as i32 as usize).min(count - 1)
    }

    /// Where it ends, pixels.
    #[inline(always)]
    fn end(&self) -> Vec2 {
        self.origin + Vec2::new(self.across as f32, self.down as f32) * self.cell_px
    }
}

impl Cover {
    /// That of a picture of this size, pixels, by the links of clumps whose edges lie that much deeper than their middles (m); several
    /// lists of them are worked through beside each other. They are in no order. Cells are about as large as clumps of this
    /// radius (px) cover.
    pub(super) fn fill<'a, I>(
        &mut self,
        size: [u32; 2],
        brush: Brush,
        edge_depth_m: f32,
        radius_px: f32,
        links: Vec<I>,
    ) where
        I: Iterator<Item = Link<'a>> + Send,
    {
        let [least, most] = CELLS_PX;
        let mut cell_px = radius_px.log2().floor().exp2().clamp(least, most);
        let cells_across = |cell_px: f32| size.map(|side| (side as f32 / cell_px).ceil() as usize);
        let [mut across, mut down] = cells_across(cell_px);
        while across * down > MOST_CELLS / rayon::current_num_threads() {
            cell_px *= 2.0;
            [across, down] = cells_across(cell_px);
        }
        let nothing = || Level {
            grid: Grid {
                origin: Vec2::ZERO,
                cell_px,
                across,
                down,
            },
            nearness: vec![0.0; across * down],
        };
        // A level for each thread, not for each list: of a crowd there are many.
        let of_thread = links.len().div_ceil(rayon::current_num_threads()).max(1);
        let links = links.into_par_iter().with_min_len(of_thread);
        let covered = links.fold(nothing, |mut level, links| {
            links.for_each(|link| level.put(link, brush, edge_depth_m));
            level
        });
        let covered = covered.reduce_with(|mut all, one| {
            let pairs = all.nearness.iter_mut().zip(&one.nearness);
            pairs.for_each(|(all, one)| *all = greater(*all, *one));
            all
        });
        self.set(size, covered);
    }

    /// Takes the cells of a picture of this size, and works out those that are larger.
    fn set(&mut self, size: [u32; 2], first: Option<Level>) {
        self.size = Vec2::from(size.map(|side| side as f32));
        self.levels.clear();
        self.levels.extend(first);
        while let Some(last) = self.levels.last()
            && last.grid.across.max(last.grid.down) > MOST_ACROSS as usize
        {
            let next = last.halved();
            self.levels.push(next);
        }
    }

    /// Whether nothing can be seen of what lies in a swath and is no nearer than it.
    pub(super) fn hides(&self, swath: &Swath) -> bool {
        let Some(first) = self.levels.first() else {
            return false;
        };
        // Nobody sees what is off the picture.
        let low = swath.low.max(Vec2::ZERO).min(self.size);
        let high = swath.high.min(self.size).max(Vec2::ZERO);
        let is_within = low.cmpge(first.grid.origin).all() && high.cmple(first.grid.end()).all();
        if !is_within {
            return false;
        }
        let across = 2.0 * swath.reach_px / MOST_ACROSS;
        let along = (high - low).max_element() / MOST_ALONG;
        let cells = greater(across, along) / first.grid.cell_px;
        let level = match cells > 1.0 {
            true => (cells.log2().ceil() as usize).min(self.levels.len() - 1),
            false => 0,
        };
        let Level { grid, nearness: of } = &self.levels[level];
        swath.area().rows(grid).all(|row| {
            let (columns, nearness) = swath.in_row(grid, row);
            let cells = &of[row * grid.across..][columns];
            let least = nearness * (1.0 + MARGIN);
            cells
                .iter()
                .fold(true, |all, covered| all & (*covered > least))
        })
    }
}

impl Level {
    /// Adds what lies between two discs.
    fn put(&mut self, [a, b]: Link, brush: Brush, edge_depth_m: f32) {
        let Grid {
            cell_px,
            across: most_across,
            down: most_down,
            ..
        } = self.grid;
        let radius = lesser(a.radius, b.radius) - MARGIN_PX;
        let nearness = lesser(
            lesser(a.inv_depth, a.inv_depth_biased),
            lesser(b.inv_depth, b.inv_depth_biased),
        );
        let farthest = greater(a.center.abs().max_element(), b.center.abs().max_element());
        let is_cover = radius > 0.5 * cell_px && farthest < FARTHEST_PX && nearness > 0.0;
        if !is_cover {
            return;
        }
        let axis = b.center - a.center;
        let length = axis.length();
        if length > LONGEST_PX {
            return;
        }
        let along = if length > 1e-3 {
            axis / length
        } else {
            Vec2::X
        };
        // How far a cell's corners are from its middle, along the axis and across it.
        let corner = 0.5 * cell_px * (along.x.abs() + along.y.abs());
        // Where middles of cells may lie: so far along the axis, and so far beside it. Half discs cover nothing for sure beyond the ends.
        let (over, ends) = match brush {
            Brush::Circle => (corner, [0.0, length]),
            Brush::Semicircle => (0.0, [corner, length - corner]),
        };
        let room = radius * radius - over * over;
        if room <= corner * corner || ends[1] < ends[0] {
            return;
        }
        let beside = room.sqrt() - corner;
        // An edge lies deeper by the square of its place: no more than by this of a cell's nearness.
        let rounded = edge_depth_m * nearness * nearness / (radius * radius);
        let deepest = nearness - rounded * over * over;
        let [low, high] = [along.y.min(0.0), along.y.max(0.0)].map(|rise| {
            let [start, end] = ends;
            start * along.y + (end - start) * rise
        });
        let wide = beside * along.x.abs();
        let middle = |cell: usize| (cell as f32 + 0.5) * cell_px;
        let cells_between = |low: f32, high: f32, count: usize| {
            let [low, high] = [low, high].map(|end| end / cell_px - 0.5);
            let start = greater(low, 0.0) as usize;
            let start = start + usize::from((start as f32) < low);
            let end = if high < 0.0 { 0 } else { high as usize + 1 };
            start..end.min(count)
        };
        // Along a row or a column as if it were the least bit oblique: off by less than the margin.
        let per = |slope: f32| 1.0 / if slope.abs() < 1e-5 { 1e-5 } else { slope };
        let [per_side, per_place] = [per(along.y), per(along.x)];
        let ordered = |a: f32, b: f32| (lesser(a, b), greater(a, b));
        for row in cells_between(a.center.y + low - wide, a.center.y + high + wide, most_down) {
            let y = middle(row) - a.center.y;
            // What x the two sides allow, and the two ends.
            let across = y * along.x;
            let side = ordered((across - beside) * per_side, (across + beside) * per_side);
            let [start, end] = ends.map(|end| (end - y * along.y) * per_place);
            let place = ordered(start, end);
            let columns = cells_between(
                greater(side.0, place.0) + a.center.x,
                lesser(side.1, place.1) + a.center.x,
                most_across,
            );
            if columns.is_empty() {
                continue;
            }
            let first = (middle(columns.start) - a.center.x) * along.y - across;
            let step = cell_px * along.y;
            let cells = &mut self.nearness[row * most_across..][..most_across][columns];
            for (i, cell) in cells.iter_mut().enumerate() {
                let side = (first + i as f32 * step).abs() + corner;
                *cell = greater(*cell, deepest - rounded * side * side);
            }
        }
    }

    /// The same in cells of twice the size.
    fn halved(&self) -> Self {
        let Grid {
            origin,
            cell_px,
            across,
            down,
        } = self.grid;
        let grid = Grid {
            origin,
            cell_px: 2.0 * cell_px,
            across: across.div_ceil(2),
            down: down.div_ceil(2),
        };
        let mut nearness = Vec::with_capacity(grid.across * grid.down);
        for rows in self.nearness.chunks(2 * across) {
            let (upper, lower) = rows.split_at(across);
            let lower = if lower.is_empty() { upper } else { lower };
            let pairs = upper.chunks(2).zip(lower.chunks(2));
            nearness.extend(pairs.map(|(upper, lower)| {
                let all = upper.iter().chain(lower);
                all.copied().fold(f32::INFINITY, lesser)
            }));
        }
        Self { grid, nearness }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Surface, SurfaceVertex};
    use proptest::prelude::*;

    const SIZE: [u32; 2] = [61, 40];

    fn disc(center: Vec2, radius: f32, inv_depth: f32) -> Disc {
        Disc {
            center,
            radius,
            inv_depth,
            inv_depth_biased: inv_depth + 0.001,
        }
    }

    fn cover(links: &[[Disc; 2]], brush: Brush, edge_depth_m: f32, radius_px: f32) -> Cover {
        let mut cover = Cover::default();
        let links = links.iter().map(|[a, b]| [a, b]);
        cover.fill(SIZE, brush, edge_depth_m, radius_px, vec![links]);
        cover
    }

    /// The nearest that a point of a link may be, if it is there, and nothing of half discs beyond the ends: by its definition.
    fn nearness_at(point: Vec2, [a, b]: &[Disc; 2], edge_depth_m: f32) -> Option<f32> {
        // Of many discs between the two.
        let mut best: Option<f32> = None;
        let mut ratio = f32::INFINITY;
        for i in 0..=200 {
            let u = i as f32 / 200.0;
            let radius = a.radius + u * (b.radius - a.radius);
            let far = point.distance(a.center.lerp(b.center, u)) / radius;
            if far <= 1.0 {
                let nearness = a.inv_depth + u * (b.inv_depth - a.inv_depth);
                best = Some(best.map_or(nearness, |best| best.max(nearness)));
                ratio = ratio.min(far * far);
            }
        }
        best.map(|nearness| nearness / (1.0 + edge_depth_m * ratio * nearness))
    }

    #[test]
    fn what_lies_behind_a_broad_clump_is_hidden() {
        let link = [
            disc(Vec2::new(10.0, 20.0), 8.0, 2.0),
            disc(Vec2::new(50.0, 22.0), 8.0, 2.0),
        ];
        let area = |x: f32, y: f32, half: f32, nearness: f32| {
            Swath::new([Vec2::new(x, y); 2], half, [nearness; 2])
        };
        for brush in [Brush::Circle, Brush::Semicircle] {
            let cover = cover(&[link], brush, 0.0, 8.0);
            assert!(cover.hides(&area(30.0, 20.0, 2.0, 1.9)));
            assert!(!cover.hides(&area(30.0, 20.0, 2.0, 2.1)), "before it");
            assert!(!cover.hides(&area(30.0, 30.0, 3.0, 1.9)), "beside it");
            assert!(!cover.hides(&area(58.0, 21.0, 3.0, 1.9)), "beyond it");
        }
        // The edge of a round one lies deeper.
        let rounded = cover(&[link], Brush::Circle, 0.5, 1.0);
        assert!(rounded.hides(&area(30.0, 21.0, 0.5, 1.9)));
        assert!(!rounded.hides(&area(30.0, 26.0, 0.5, 1.9)));
    }

    fn link() -> impl Strategy<Value = [Disc; 2]> {
        let place = (-10.0..70.0_f32, -10.0..50.0_f32);
        let end = || (0.0..9.0_f32, 0.5..2.0_f32);
        let slopes = prop_oneof![
            Just([0.0, 1.0]),
            Just([1.0, 0.0]),
            prop::array::uniform2(-1.0..1.0_f32)
        ];
        (place, slopes, 0.0..30.0_f32, end(), end()).prop_map(|((x, y), way, length, a, b)| {
            let from = Vec2::new(x, y);
            let to = from + length * Vec2::from(way);
            [disc(from, a.0, a.1), disc(to, b.0, b.1)]
        })
    }

    /// Points of the picture in a swath.
    fn points(from: Vec2, to: Vec2, reach_px: f32) -> impl Iterator<Item = (Vec2, f32)> {
        let around = |i: usize| {
            let (sine, cosine) = (0.7 * i as f32).sin_cos();
            Vec2::new(cosine, sine)
        };
        let points = (0..400).map(move |i| {
            let u = (i % 20) as f32 / 19.0;
            let out = 0.999 * reach_px * ((i / 20) as f32 / 19.0).sqrt();
            (from.lerp(to, u) + out * around(i), u)
        });
        let size = Vec2::from(SIZE.map(|side| side as f32));
        points.filter(move |(point, _)| point.cmpge(Vec2::ZERO).all() && point.cmple(size).all())
    }

    /// Of a line's two ends the nearest that they may be and still be hidden, so far one before the other.
    fn hidden(cover: &Cover, line: [Vec2; 2], reach_px: f32, rise: f32) -> Option<[f32; 2]> {
        let ends = |i: i32| {
            let nearness = 2.0 - 0.025 * i as f32;
            [nearness, nearness + rise]
        };
        (1..80)
            .map(ends)
            .find(|ends| cover.hides(&Swath::new(line, reach_px, *ends)))
    }

    fn line() -> impl Strategy<Value = ([Vec2; 2], f32, f32)> {
        let place = || (0.0..61.0_f32, 0.0..40.0_f32);
        let way = (-14.0..14.0_f32, prop_oneof![Just(0.0_f32), -14.0..14.0_f32]);
        (place(), way, 0.1..4.0_f32, -0.4..0.4_f32).prop_map(|(from, way, reach_px, rise)| {
            let from = Vec2::from(from);
            ([from, from + Vec2::from(way)], reach_px, rise)
        })
    }

    proptest! {
        #[test]
        fn only_what_is_covered_everywhere_is_hidden(
            links in prop::collection::vec(link(), 1..40),
            edge_depth_m in prop_oneof![Just(0.0_f32), 0.0..0.3_f32],
            radius_px in 0.3..6.0_f32,
            (line, reach_px, rise) in line(),
        ) {
            let cover = cover(&links, Brush::Circle, edge_depth_m, radius_px);
            let Some([start, end]) = hidden(&cover, line, reach_px, rise) else {
                return Ok(());
            };
            for (point, u) in points(line[0], line[1], reach_px) {
                let nearness = start + u * (end - start);
                let covers = |link| nearness_at(point, link, edge_depth_m);
                let nearest = links.iter().filter_map(covers).fold(0.0, f32::max);
                prop_assert!(nearest > nearness, "{point}: {nearest}, and {nearness} is hidden");
            }
        }

        /// The same of samples alone, and with triangles that hide what is behind the nearest of them. Clumps of many links are looked at some
        /// links at a time.
        #[test]
        fn samples_that_are_hidden_are_covered(
            ends in prop::collection::vec(link(), 1..30),
            ends_of_clump in prop::sample::select(vec![2_usize, 12, 40]),
            triangles in prop::collection::vec((prop::array::uniform6(0.0..1.0_f32), 0.5..2.0_f32, -0.2..0.2_f32), 0..6),
            edge_depth_m in prop_oneof![Just(0.0_f32), 0.0..0.3_f32],
            count in prop::sample::select(vec![1_u32, 2, 4, 8, 16]),
            (line, reach_px, rise) in line(),
        ) {
            let samples = crate::samples::sample_positions(count).unwrap();
            let surfaces: Vec<Surface> = triangles.iter().map(|(places, inv_depth, margin_m)| {
                let vertex = |i: usize| SurfaceVertex {
                    position: Vec2::new(120.0 * places[2 * i] - 30.0, 80.0 * places[2 * i + 1] - 20.0),
                    inv_depth: *inv_depth,
                    tone: 1.0,
                };
                Surface {
                    vertices: (0..3).map(vertex).collect(),
                    triangles: vec![[0, 1, 2]],
                    margin_m: if *margin_m > 0.1 { 0.0 } else { *margin_m },
                    ..Surface::default()
                }
            }).collect();
            let discs = ends.as_flattened();
            let clumps = discs.chunks(ends_of_clump).enumerate().map(|(i, discs)| Clump {
                first: i * ends_of_clump,
                discs,
                covering: discs.len() - 1,
            });
            let clumps: Vec<Clump> = clumps.collect();
            let links = clumps.iter().flat_map(|clump| {
                let links = clump.discs.array_windows::<2>();
                (clump.first..).zip(links)
            });
            let links: Vec<(usize, &[Disc; 2])> = links.collect();
            // Their own strokes are no wider than they are.
            let swath = |joint: usize| {
                let [a, b] = [&discs[joint], &discs[joint + 1]];
                let nearness = [a, b].map(|disc| disc.inv_depth_biased);
                Swath::new([a.center, b.center], a.radius.max(b.radius), nearness)
            };
            let mut hidden = vec![false; discs.len()];
            let mut cover = Cover::default();
            let scene = Scene {
                size: SIZE,
                part: [0..SIZE[0] as usize, 0..SIZE[1] as usize],
                surfaces: &surfaces,
                brush: Brush::Circle,
                edge_depth_m,
                clumps: &clumps,
            };
            prop_assert!(cover.fill_by_samples(&samples, &scene, &swath, &mut hidden));
            let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| Vec2::new(x as f32, y as f32)));
            let places: Vec<Vec2> = places.flat_map(|pixel| samples.iter().map(move |sample| pixel + *sample)).collect();
            let skin = |place: Vec2| {
                let holds = |surface: &&Surface| {
                    let [a, b, c] = [0, 1, 2].map(|i| surface.vertices[i].position);
                    let side = |(from, to): (Vec2, Vec2)| (to - from).perp_dot(place - from);
                    let sides = [(a, b), (b, c), (c, a)].map(side);
                    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
                };
                let inv_depth = |surface: &Surface| surface.vertices[0].inv_depth;
                let nearest = surfaces.iter().filter(holds).max_by(|a, b| inv_depth(a).total_cmp(&inv_depth(b)));
                nearest.map_or(0.0, |surface| 1.0 / (1.0 / inv_depth(surface) - surface.margin_m.min(0.0)))
            };
            let hair = |place: Vec2, without: Option<usize>| {
                let others = links.iter().filter(|(joint, _)| Some(*joint) != without);
                others.filter_map(|(_, link)| nearness_at(place, link, edge_depth_m)).fold(0.0, f32::max)
            };
            for (joint, link) in links.iter().filter(|(joint, _)| hidden[*joint]) {
                for place in &places {
                    if let Some(own) = nearness_at(*place, link, 0.0) {
                        let (hair, skin) = (hair(*place, Some(*joint)), skin(*place));
                        prop_assert!(hair.max(skin) > own, "{place}: {hair} and {skin}, and {own} is hidden");
                    }
                }
            }
            let Some([start, end]) = self::hidden(&cover, line, reach_px, rise) else {
                return Ok(());
            };
            for place in places {
                let way = line[1] - line[0];
                let u = (place - line[0]).dot(way) / way.length_squared().max(f32::MIN_POSITIVE);
                let u = u.clamp(0.0, 1.0);
                if place.distance(line[0] + u * way) <= reach_px {
                    let nearness = start + u * (end - start);
                    let (hair, skin) = (hair(place, None), skin(place));
                    prop_assert!(hair.max(skin) > nearness, "{place}: {hair} and {skin}, and {nearness} is hidden");
                }
            }
        }
    }
}
