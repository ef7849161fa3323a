//! Looks for the largest changes of an animation, and how they shrink with the time between pictures.
//!
//! All pictures 1/768 s apart are drawn with few samples a pixel. Then the tiles that change most in 1/384 s and
//! those that do in 1/768 s are drawn with many samples. Pixels that pop are counted with [`POP_SAMPLES`]: an edge that
//! moves by a quarter of a pixel in a tick changes sixteen of them, and does not count.

use super::animation::Tick;
use super::painter::Painter;
use super::places::Places;
use super::scenes::Subject;
use super::tiles::{HairTiles, TILE, corner, difference};
use crate::BenchError;
use glam::Vec2;
use render::{Order, Picture};
use std::collections::{BTreeMap, BTreeSet};

/// Times between pictures, in ticks: 1/384 s and its half, and a tick.
pub const STEPS: [Tick; 3] = [LONG, SHORT, 1];
const LONG: Tick = 4;
const SHORT: Tick = LONG / 2;
/// Samples a pixel while looking for what changes.
pub const FEW: u32 = 4;
/// Samples a pixel while counting pixels that pop.
pub const POP_SAMPLES: u32 = 64;
/// Samples a pixel of what is measured.
pub const MANY: u32 = 256;
/// Pixels around a tile that are drawn with it, to be looked at.
pub const AROUND: usize = TILE;

/// How much is drawn after the search.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Tiles with many samples that change most in 1/384 s, and as many that do in 1/768 s.
    pub tiles: usize,
    /// Intervals in which popped pixels are counted at every tick: at even distances of time, and as many where
    /// most have popped in 1/768 s.
    pub intervals: usize,
}

/// Draws for the search; kept from scene to scene.
pub struct Painters {
    hair: Painter,
    few: Painter,
    popped: Painter,
    many: Painter,
}

impl Painters {
    /// Painters with that many threads.
    ///
    /// # Errors
    ///
    /// When there is no such number of threads.
    pub fn new(threads: usize) -> Result<Self, BenchError> {
        Ok(Self {
            hair: Painter::new(1, threads)?,
            few: Painter::new(FEW, threads)?,
            popped: Painter::new(POP_SAMPLES, threads)?,
            many: Painter::new(MANY, threads)?,
        })
    }
}

/// What was found in an order's pictures of a scene.
#[derive(Clone, Debug, Default)]
pub struct Continuity {
    /// The largest change of a tile, for each of [`STEPS`].
    pub largest: [f64; 3],
    /// What 99.9 % of all tiles' changes don't exceed, for the first two of [`STEPS`]; with few samples.
    pub percentile: [f64; 2],
    /// The share of the hair's pixels that pop in a tick: the most, and the mean at even distances of time.
    pub popped: [f64; 2],
    /// Intervals of 1/384 s that were looked at.
    pub intervals: usize,
    /// Tiles, each in an interval, that were drawn with many samples.
    pub tiles: usize,
    /// Where a tile changes most in 1/768 s.
    pub worst: Option<Worst>,
    /// Where one does in 1/384 s: the first tick, and the tile.
    pub farthest: Option<(Tick, [usize; 2])>,
    /// What [`Self::ratio`] would be by the speed alone.
    pub pushed: Option<Pushed>,
}

/// A tile's strokes in one frame, moved as their strands move in 1/384 s, without any change of size, colour or order: what a picture that
/// never jumps would score. It is 2 for wide shapes, and less where thin ones move by a good part of their own width.
#[derive(Clone, Copy, Debug)]
pub struct Pushed {
    /// How far a joint moves at most, in pixels.
    pub moved_px: f64,
    /// The change over that of half the way.
    pub ratio: f64,
}

/// Where most changes.
#[derive(Clone, Debug)]
pub struct Worst {
    /// The moment before.
    pub tick: Tick,
    /// Column and row of the tile's upper left pixel.
    pub corner: [usize; 2],
    /// How much the tile changes.
    pub change: f64,
    /// The tile and [`AROUND`] pixels around it, before and after.
    pub pictures: [Picture; 2],
}

impl Continuity {
    /// The largest change in 1/384 s over that in half the time: 2 where all change is continuous, 1
    /// where something jumps. Nothing where nothing changes.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        ratio(self.largest[0], self.largest[1])
    }

    /// The same of a finer step, in the same tiles.
    #[must_use]
    pub fn fine_ratio(&self) -> Option<f64> {
        ratio(self.largest[1], self.largest[2])
    }

    /// As [`Self::ratio`], of the percentile.
    #[must_use]
    pub fn percentile_ratio(&self) -> Option<f64> {
        ratio(self.percentile[0], self.percentile[1])
    }
}

fn ratio(long: f64, short: f64) -> Option<f64> {
    (short > 0.0).then(|| long / short)
}

/// How far a joint of a strand moves on the screen at most, in pixels: in 1/384 s, and in half of it. Were these not
/// about 2 to 1, it would not be the drawing that jumps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion(pub [f64; 2]);

/// Measures a scene in each of its orders. `done` is called after each interval.
///
/// # Errors
///
/// When a frame can't be made or drawn.
pub fn measure(
    scene: &mut Subject,
    painters: &mut Painters,
    effort: Effort,
    mut done: impl FnMut(),
) -> Result<(Vec<Continuity>, Motion), BenchError> {
    let starts = starts(scene);
    let (glances, motion) = glance(scene, painters, &mut done)?;
    let plans: Vec<Plan> = glances.iter().map(|of| of.plan(effort)).collect();
    let finished = glances.into_iter().map(Glance::finish);
    let mut found: Vec<Found> = finished.collect();
    for (interval, &start) in starts.iter().enumerate() {
        let wanted: Vec<Wanted> = plans.iter().map(|plan| plan.of(interval)).collect();
        if wanted.iter().any(Wanted::is_some) {
            refine(scene, painters, start, &wanted, &mut found)?;
        }
        done();
    }
    let mut found: Vec<Continuity> = found.into_iter().map(Found::finish).collect();
    for (of_order, (_, order)) in found.iter_mut().zip(scene.orders.clone()) {
        if let Some((start, corner)) = of_order.farthest {
            of_order.pushed = pushed(scene, &mut painters.many, order, start, corner)?;
        }
    }
    Ok((found, motion))
}

/// What the tile would score by the speed of its strands alone; nothing where none has a joint in it or around it, from where strokes reach
/// into it.
fn pushed(
    scene: &mut Subject,
    painter: &mut Painter,
    order: Order,
    start: Tick,
    corner: [usize; 2],
) -> Result<Option<Pushed>, BenchError> {
    let frame = scene.animation.at(start)?;
    let before = Places::new(&frame, frame.paths.center.clone());
    let mut frame = scene.animation.at(start + LONG)?;
    let after = Places::new(&frame, frame.paths.center.clone());
    let corner = Vec2::from(corner.map(|place| place as f32));
    let ways: Vec<Vec2> = (after.joints())
        .map(|joint| after.moved_since(&before, joint).unwrap_or_default())
        .collect();
    let (middle, reach) = (corner + 0.5 * TILE as f32, (TILE / 2 + AROUND) as f32);
    let is_near = |joint: &usize| (after.center(*joint) - middle).abs().max_element() < reach;
    let near = after.joints().filter(is_near);
    let moved_px = near.map(|joint| ways[joint].length()).reduce(f32::max);
    let half_back: Vec<Vec2> = ways.iter().map(|way| -0.5 * *way).collect();
    painter.strokes(&mut frame, order)?;
    let mut pictures = Vec::new();
    for _ in 0..3 {
        pictures.push(painter.part(corner, TILE as u32)?);
        painter.push(&half_back);
    }
    let change = |to: usize| difference(&pictures[0], &pictures[to], 0, [TILE; 2]);
    let pushed = ratio(change(2), change(1)).zip(moved_px);
    Ok(pushed.map(|(ratio, moved_px)| Pushed {
        moved_px: f64::from(moved_px),
        ratio,
    }))
}

/// How often [`measure`] calls `done`.
#[must_use]
pub fn length(scene: &Subject) -> usize {
    2 * starts(scene).len()
}

/// The first ticks of all intervals of 1/384 s.
fn starts(scene: &Subject) -> Vec<Tick> {
    let windows = scene.windows.iter().cloned();
    windows
        .flat_map(|window| window.step_by(LONG as usize))
        .collect()
}

/// What few samples show of an order's pictures.
#[derive(Default)]
struct Glance {
    /// Interval, tile and its change in 1/384 s.
    long: Vec<(usize, usize, f64)>,
    /// The same in its first or second 1/768 s.
    short: Vec<(usize, usize, f64)>,
    /// The share of pixels that pop in 1/768 s, the larger one of each interval.
    popped: Vec<f64>,
}

fn glance(
    scene: &mut Subject,
    painters: &mut Painters,
    done: &mut impl FnMut(),
) -> Result<(Vec<Glance>, Motion), BenchError> {
    let mut glances: Vec<Glance> = scene.orders.iter().map(|_| Glance::default()).collect();
    let mut motion = Motion::default();
    for window in scene.windows.clone() {
        let mut before = Moment::new(scene, painters, window.start)?;
        for start in window.step_by(LONG as usize) {
            let half = Moment::new(scene, painters, start + SHORT)?;
            let after = Moment::new(scene, painters, start + LONG)?;
            let width = after.pictures[0].width as usize;
            let hair = HairTiles::new(width, [&before.hair, &after.hair]);
            for (i, glance) in glances.iter_mut().enumerate() {
                let pictures = [&before, &half, &after].map(|moment| &moment.pictures[i]);
                glance.add(&hair, pictures);
            }
            motion.add(&before, &half, &after);
            before = after;
            done();
        }
    }
    Ok((glances, motion))
}

/// A moment as few samples show it.
struct Moment {
    /// In each order.
    pictures: Vec<Picture>,
    /// Which pixels show hair.
    hair: Vec<bool>,
    places: Places,
}

impl Moment {
    fn new(scene: &mut Subject, painters: &mut Painters, tick: Tick) -> Result<Self, BenchError> {
        let mut frame = scene.animation.at(tick)?;
        let mut pictures = Vec::new();
        for (_, order) in &scene.orders {
            pictures.push(painters.few.picture(&mut frame, *order)?);
        }
        Ok(Self {
            pictures,
            hair: painters.hair.hair(&mut frame)?,
            places: Places::new(&frame, frame.paths.center.clone()),
        })
    }
}

impl Motion {
    fn add(&mut self, before: &Moment, half: &Moment, after: &Moment) {
        let pairs = [(0, before, after), (1, before, half), (1, half, after)];
        for (i, from, to) in pairs {
            let joints = to.places.joints();
            let moved = joints.filter_map(|joint| to.places.moved_since(&from.places, joint));
            let farthest = moved.map(Vec2::length).fold(0.0, f32::max);
            self.0[i] = self.0[i].max(f64::from(farthest));
        }
    }
}

impl Glance {
    /// Adds the next interval: its pictures at its ends and in its middle.
    fn add(&mut self, tiles: &HairTiles, [before, half, after]: [&Picture; 3]) {
        let interval = self.popped.len();
        let whole = tiles.change(before, after);
        let halves = [tiles.change(before, half), tiles.change(half, after)];
        let of = |tiles: &[(usize, f64)]| -> Vec<(usize, usize, f64)> {
            let tiles = tiles.iter();
            tiles
                .map(|&(tile, change)| (interval, tile, change))
                .collect()
        };
        self.long.extend(of(&whole.tiles));
        self.short
            .extend(halves.iter().flat_map(|half| of(&half.tiles)));
        self.popped.push(halves[0].popped.max(halves[1].popped));
    }

    /// What to draw again.
    fn plan(&self, effort: Effort) -> Plan {
        let mut plan = Plan::default();
        for changes in [&self.long, &self.short] {
            let mut by_size: Vec<_> = changes.iter().collect();
            by_size.sort_by(|a, b| b.2.total_cmp(&a.2));
            for (interval, tile, _) in by_size.into_iter().take(effort.tiles) {
                plan.tiles.entry(*interval).or_default().insert(*tile);
            }
        }
        let mut by_popped: Vec<usize> = (0..self.popped.len()).collect();
        by_popped.sort_by(|&a, &b| self.popped[b].total_cmp(&self.popped[a]));
        let most = by_popped.into_iter().take(effort.intervals);
        plan.popped.extend(most.map(|interval| (interval, false)));
        let count = effort.intervals.min(self.popped.len());
        let even = (0..count).map(|i| (2 * i + 1) * self.popped.len() / (2 * count));
        plan.popped.extend(even.map(|interval| (interval, true)));
        plan
    }

    fn finish(self) -> Found {
        let percentile = |changes: Vec<(usize, usize, f64)>| {
            let mut changes: Vec<f64> = changes.into_iter().map(|change| change.2).collect();
            changes.sort_by(f64::total_cmp);
            let rank = (changes.len() * 999).div_ceil(1000);
            rank.checked_sub(1).map_or(0.0, |place| changes[place])
        };
        Found {
            continuity: Continuity {
                intervals: self.popped.len(),
                percentile: [percentile(self.long), percentile(self.short)],
                ..Continuity::default()
            },
            popped: Vec::new(),
        }
    }
}

/// What is to be drawn again of an order, by interval.
#[derive(Default)]
struct Plan {
    /// Tiles with many samples.
    tiles: BTreeMap<usize, BTreeSet<usize>>,
    /// Whole pictures at every tick; whether it is an interval at even distances.
    popped: BTreeMap<usize, bool>,
}

/// What is to be drawn again of an order in an interval.
struct Wanted {
    tiles: Vec<usize>,
    popped: Option<bool>,
}

impl Plan {
    fn of(&self, interval: usize) -> Wanted {
        let tiles = self.tiles.get(&interval).into_iter().flatten();
        Wanted {
            tiles: tiles.copied().collect(),
            popped: self.popped.get(&interval).copied(),
        }
    }
}

impl Wanted {
    fn is_some(&self) -> bool {
        !self.tiles.is_empty() || self.popped.is_some()
    }
}

/// An order's pictures of an interval, one each tick.
#[derive(Default)]
struct Pictures {
    /// For each tick the tiles that are wanted, with what is around them.
    tiles: Vec<Vec<Picture>>,
    whole: Vec<Picture>,
}

/// Draws what is wanted of an interval.
fn refine(
    scene: &mut Subject,
    painters: &mut Painters,
    start: Tick,
    wanted: &[Wanted],
    found: &mut [Found],
) -> Result<(), BenchError> {
    let mut pictures: Vec<Pictures> = scene.orders.iter().map(|_| Pictures::default()).collect();
    let mut size = [0; 2];
    let mut hair = Vec::new();
    for tick in start..=start + LONG {
        let mut frame = scene.animation.at(tick)?;
        size = frame.camera.size_px().map(|side| side as usize);
        let orders = scene.orders.iter().zip(wanted).zip(&mut pictures);
        for (((_, order), wanted), pictures) in orders {
            if wanted.popped.is_some() {
                pictures
                    .whole
                    .push(painters.popped.picture(&mut frame, *order)?);
            }
            if wanted.tiles.is_empty() {
                continue;
            }
            painters.many.strokes(&mut frame, *order)?;
            let mut tiles = Vec::new();
            for &tile in &wanted.tiles {
                let corner = Vec2::from(corner(tile, size[0]).map(|place| place as f32));
                let corner = corner - AROUND as f32;
                let side = (TILE + 2 * AROUND) as u32;
                tiles.push(painters.many.part(corner, side)?);
            }
            pictures.tiles.push(tiles);
        }
        if tick == start || tick == start + LONG {
            hair.push(painters.hair.hair(&mut frame)?);
        }
    }
    let hair = HairTiles::new(size[0], [&hair[0], &hair[1]]);
    for ((pictures, wanted), found) in pictures.iter().zip(wanted).zip(found) {
        if let Some(is_even) = wanted.popped {
            found.add_popped(&hair, &pictures.whole, is_even);
        }
        for (i, &tile) in wanted.tiles.iter().enumerate() {
            let of_tile: Vec<&Picture> = pictures.tiles.iter().map(|tiles| &tiles[i]).collect();
            found.add_tile(corner(tile, size[0]), size, &of_tile, start);
        }
    }
    Ok(())
}

/// What has been found so far in an order.
struct Found {
    continuity: Continuity,
    /// Shares of pixels that pop in a tick, at even distances of time.
    popped: Vec<f64>,
}

impl Found {
    fn add_popped(&mut self, hair: &HairTiles, pictures: &[Picture], is_even: bool) {
        for pair in pictures.windows(2) {
            let popped = hair.change(&pair[0], &pair[1]).popped;
            let worst = &mut self.continuity.popped[0];
            *worst = worst.max(popped);
            if is_even {
                self.popped.push(popped);
            }
        }
    }

    /// Adds a tile of an interval, from its pictures at every tick.
    fn add_tile(
        &mut self,
        corner: [usize; 2],
        picture_size: [usize; 2],
        pictures: &[&Picture],
        start: Tick,
    ) {
        // Tiles at the right and lower edges may be smaller.
        let size = [0, 1].map(|axis| TILE.min(picture_size[axis] - corner[axis]));
        self.continuity.tiles += 1;
        for (i, &step) in STEPS.iter().enumerate() {
            for first in (0..LONG).step_by(step as usize) {
                let pair = [first, first + step].map(|tick| pictures[tick as usize]);
                let change = difference(pair[0], pair[1], AROUND, size);
                let largest = &mut self.continuity.largest[i];
                if change <= *largest {
                    continue;
                }
                *largest = change;
                if step == LONG {
                    self.continuity.farthest = Some((start, corner));
                }
                if step == SHORT {
                    self.continuity.worst = Some(Worst {
                        tick: start + first,
                        corner,
                        change,
                        pictures: pair.map(Picture::clone),
                    });
                }
            }
        }
    }

    fn finish(mut self) -> Continuity {
        let count = self.popped.len().max(1) as f64;
        self.continuity.popped[1] = self.popped.iter().sum::<f64>() / count;
        self.continuity
    }
}

#[cfg(test)]
mod tests {
    use super::super::animation::Kind;
    use super::super::scenes::ORDERS;
    use super::super::strands::Strands;
    use super::*;

    /// What an order's pictures of a scene of strands show in a time.
    fn measured(name: &str, window: std::ops::Range<Tick>, order: Order) -> Continuity {
        let (_, kind, open) = Strands::ALL.iter().find(|of| of.0 == name).unwrap();
        let mut scene = Subject {
            name: name.to_owned(),
            kind: *kind,
            windows: vec![window.clone()],
            animation: Box::new(open().unwrap()),
            look: None,
            orders: vec![("order", order)],
        };
        assert_ne!(kind, &Kind::Hair);
        let mut painters = Painters::new(2).unwrap();
        let effort = Effort {
            tiles: 3,
            intervals: 1,
        };
        let mut count = 0;
        let (found, motion) = measure(&mut scene, &mut painters, effort, || count += 1).unwrap();
        assert_eq!(count, length(&scene));
        let [long, short] = motion.0;
        assert!(
            long > 0.01 && (long / short - 2.0).abs() < 0.05,
            "{motion:?}"
        );
        assert_eq!(found[0].intervals as Tick, window.len() as Tick / LONG);
        found[0].clone()
    }

    #[test]
    fn what_moves_steadily_scores_two() {
        for (_, order) in ORDERS {
            let found = measured("control-continuous", 100..108, order);
            let ratio = found.ratio().unwrap();
            assert!((1.9..2.1).contains(&ratio), "{order:?}: {ratio}");
            // An edge that lies as a row of samples does may cross several of one pixel: what the measure can tell.
            assert!(found.popped[0] < 1e-3, "{order:?}: {:?}", found.popped);
            assert!((3..=6).contains(&found.tiles));
        }
    }

    /// A pixel in 1/384 s is too much for that time and for popped pixels, but not for half of it.
    #[test]
    fn what_moves_fast_scores_two_in_a_shorter_time() {
        let found = measured("control-fast", 100..108, Order::default());
        let [long, fine] = [found.ratio(), found.fine_ratio()].map(Option::unwrap);
        assert!(long < 1.9, "{long}");
        assert!(fine > 1.9, "{fine}");
        let pushed = found.pushed.unwrap();
        assert!((pushed.ratio - long).abs() < 0.05, "{pushed:?}, {long}");
        assert!(found.popped[0] > 1e-3, "{:?}", found.popped);
    }

    #[test]
    fn what_jumps_scores_one_and_is_found() {
        for (_, order) in ORDERS {
            // It jumps from tick 138 to 139.
            let found = measured("control-jumping", 132..144, order);
            let ratio = found.ratio().unwrap();
            assert!((0.95..1.05).contains(&ratio), "{order:?}: {ratio}");
            // Its speed is not to blame.
            let pushed = found.pushed.unwrap();
            assert!(pushed.ratio > 1.9, "{order:?}: {pushed:?}");
            assert!(found.popped[0] > 0.5, "{:?}", found.popped);
            let worst = found.worst.unwrap();
            assert_eq!(worst.tick, 138);
            assert_eq!(worst.pictures[0].width as usize, TILE + 2 * AROUND);
        }
    }
}
