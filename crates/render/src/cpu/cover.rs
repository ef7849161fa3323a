//! What hair hides of itself: which small parts of the picture clumps cover wholly, and how near. What lies behind a cover there is in no
//! picture, and dense hair is mostly that.

use super::tile::{greater, lesser};
use crate::drawing::{Brush, Disc};
use glam::Vec2;
use rayon::prelude::*;

/// Sides of cells, pixels: a cell is the least part of the picture of which it is known whether it is covered.
const CELLS_PX: [f32; 2] = [0.5, 8.0];

/// Clumps count as so much thinner than they are, pixels, and what they hide as so much nearer, by its depth: that makes up for rounding.
const MARGIN_PX: f32 = 1.0 / 16.0;
const MARGIN: f32 = 1e-4;

/// Discs farther from the picture's corner than this (px) hide nothing: rounding would decide.
const FARTHEST_PX: f32 = 2e4;
/// Neither do longer links, px.
const LONGEST_PX: f32 = 2e3;

/// Most cells to each side that are looked at, of the size at which there are no more.
const MOST_CELLS: usize = 6;

/// How near the picture is covered.
///
/// A nearness is an inverse depth, 1/m: of a clump's two, the order among strands and that against surfaces, the lesser where it covers, and
/// the greater where it is covered. So what is behind a cover by its nearness is behind by both, and where a surface hides the
/// clump that covers, it hides what is behind too.
#[derive(Default)]
pub(super) struct Cover {
    /// By the size of their cells, each twice as large as the one before.
    levels: Vec<Level>,
    /// The side of the first level's cells, pixels.
    cell_px: f32,
}

/// Cells of one size.
#[derive(Clone, Default)]
struct Level {
    cell_px: f32,
    across: usize,
    down: usize,
    /// Of each cell, row by row: what lies deeper isn't seen anywhere in it. 0 where nothing covers it.
    nearness: Vec<f32>,
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
        let cell_px = radius_px.log2().floor().exp2().clamp(least, most);
        self.cell_px = cell_px;
        let [across, down] = size.map(|side| (side as f32 / cell_px).ceil() as usize);
        let nothing = || Level {
            cell_px,
            across,
            down,
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
        self.levels.clear();
        self.levels.extend(covered);
        while let Some(last) = self.levels.last()
            && last.across.max(last.down) > MOST_CELLS
        {
            let next = last.halved();
            self.levels.push(next);
        }
    }

    /// Whether nothing can be seen of what lies in an area and is no nearer than that, 1/m.
    pub(super) fn hides(&self, Area { low, high }: Area, nearness: f32) -> bool {
        let Some(first) = self.levels.first() else {
            return false;
        };
        let count = [first.across, first.down];
        let range = |low: f32, high: f32, count: usize| {
            // Of strokes of any size, also larger than what can be counted.
            let cell = |place: f32| ((greater(place, 0.0) / self.cell_px) as usize).min(count - 1);
            let start = cell(low);
            start..cell(high).max(start) + 1
        };
        let columns = range(low.x, high.x, count[0]);
        let rows = range(low.y, high.y, count[1]);
        let longest = columns.len().max(rows.len());
        let level = (longest.div_ceil(MOST_CELLS)).next_power_of_two().ilog2();
        let level = level.min(self.levels.len() as u32 - 1);
        let at = |cell: usize| cell >> level;
        let Level {
            across,
            nearness: of,
            ..
        } = &self.levels[level as usize];
        let least = nearness * (1.0 + MARGIN);
        (at(rows.start)..=at(rows.end - 1)).all(|row| {
            let row = &of[row * across..][..*across];
            let cells = &row[at(columns.start)..=at(columns.end - 1)];
            cells.iter().all(|covered| *covered > least)
        })
    }
}

impl Level {
    /// Adds what lies between two discs.
    fn put(&mut self, [a, b]: Link, brush: Brush, edge_depth_m: f32) {
        let cell_px = self.cell_px;
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
        for row in cells_between(a.center.y + low - wide, a.center.y + high + wide, self.down) {
            let y = middle(row) - a.center.y;
            // What x the two sides allow, and the two ends.
            let across = y * along.x;
            let side = ordered((across - beside) * per_side, (across + beside) * per_side);
            let [start, end] = ends.map(|end| (end - y * along.y) * per_place);
            let place = ordered(start, end);
            let columns = cells_between(
                greater(side.0, place.0) + a.center.x,
                lesser(side.1, place.1) + a.center.x,
                self.across,
            );
            if columns.is_empty() {
                continue;
            }
            let first = (middle(columns.start) - a.center.x) * along.y - across;
            let step = cell_px * along.y;
            let cells = &mut self.nearness[row * self.across..][..self.across][columns];
            for (i, cell) in cells.iter_mut().enumerate() {
                let side = (first + i as f32 * step).abs() + corner;
                *cell = greater(*cell, deepest - rounded * side * side);
            }
        }
    }

    /// The same in cells of twice the size.
    fn halved(&self) -> Self {
        let (across, down) = (self.across.div_ceil(2), self.down.div_ceil(2));
        let mut nearness = Vec::with_capacity(across * down);
        for rows in self.nearness.chunks(2 * self.across) {
            let (upper, lower) = rows.split_at(self.across);
            let lower = if lower.is_empty() { upper } else { lower };
            let pairs = upper.chunks(2).zip(lower.chunks(2));
            nearness.extend(pairs.map(|(upper, lower)| {
                let all = upper.iter().chain(lower);
                all.copied().fold(f32::INFINITY, lesser)
            }));
        }
        Self {
            cell_px: 2.0 * self.cell_px,
            across,
            down,
            nearness,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
        let area = |x: f32, y: f32, half: f32| Area {
            low: Vec2::new(x - half, y - half),
            high: Vec2::new(x + half, y + half),
        };
        for brush in [Brush::Circle, Brush::Semicircle] {
            let cover = cover(&[link], brush, 0.0, 8.0);
            assert!(cover.hides(area(30.0, 20.0, 2.0), 1.9));
            assert!(!cover.hides(area(30.0, 20.0, 2.0), 2.1), "before it");
            assert!(!cover.hides(area(30.0, 30.0, 3.0), 1.9), "beside it");
            assert!(!cover.hides(area(58.0, 21.0, 3.0), 1.9), "beyond it");
        }
        // The edge of a round one lies deeper.
        let rounded = cover(&[link], Brush::Circle, 0.5, 1.0);
        assert!(rounded.hides(area(30.0, 21.0, 0.5), 1.9));
        assert!(!rounded.hides(area(30.0, 26.0, 0.5), 1.9));
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

    proptest! {
        #[test]
        fn only_what_is_covered_everywhere_is_hidden(
            links in prop::collection::vec(link(), 1..40),
            edge_depth_m in prop_oneof![Just(0.0_f32), 0.0..0.3_f32],
            radius_px in 0.3..6.0_f32,
            at in (0.0..1.0_f32, 0.0..1.0_f32),
            half in (0.1..6.0_f32, 0.1..6.0_f32),
        ) {
            let cover = cover(&links, Brush::Circle, edge_depth_m, radius_px);
            let middle = Vec2::new(at.0 * SIZE[0] as f32, at.1 * SIZE[1] as f32);
            let half = Vec2::new(half.0, half.1);
            let area = Area { low: middle - half, high: middle + half };
            // As near as it may be and still be hidden.
            let nearness = (1..80).map(|i| 2.0 - 0.025 * i as f32);
            let Some(nearness) = nearness.into_iter().find(|n| cover.hides(area, *n)) else {
                return Ok(());
            };
            for i in 0..100 {
                let way = Vec2::new((i % 10) as f32 / 9.0, (i / 10) as f32 / 9.0);
                let point = area.low + way * (area.high - area.low);
                let [width, height] = SIZE.map(|side| side as f32);
                if point.x < 0.0 || point.y < 0.0 || point.x > width || point.y > height {
                    continue;
                }
                let covers = |link| nearness_at(point, link, edge_depth_m);
                let nearest = links.iter().filter_map(covers).fold(0.0, f32::max);
                prop_assert!(nearest > nearness, "{point}: {nearest}, and {nearness} is hidden");
            }
        }
    }
}
