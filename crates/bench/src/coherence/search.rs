//! Looks for the largest changes of an animation, and how they shrink with the time between pictures.
//!
//! Every interval of [`LONGEST`] ticks is looked at with few samples a pixel. Then those that change most, and
//! some at even distances, are drawn with many samples, at every tick.

use super::ORDERS;
use super::animation::{Scene, Tick};
use super::painter::Painter;
use super::tiles::{Change, HairTiles};
use render::Picture;
use std::collections::BTreeMap;

/// The longest time between two pictures that are compared, in ticks: 1/384 s.
pub const LONGEST: Tick = 4;
/// Times between pictures, in ticks.
pub const STEPS: [Tick; 3] = [LONGEST, LONGEST / 2, LONGEST / 4];
/// Samples a pixel while looking for what changes.
const FEW: u32 = 16;
/// Samples a pixel of what is measured.
pub const MANY: u32 = 256;

/// How many intervals are drawn with many samples.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// At even distances.
    pub even: usize,
    /// Those where a tile changes most, and those where most pixels pop; of each.
    pub suspicious: usize,
}

/// Draws for the search; kept from scene to scene.
pub struct Painters {
    hair: Painter,
    few: Painter,
    many: Painter,
}

impl Painters {
    /// Painters with that many threads.
    ///
    /// # Errors
    ///
    /// When there is no such number of threads.
    pub fn new(threads: usize) -> Result<Self, String> {
        Ok(Self {
            hair: Painter::new(1, threads)?,
            few: Painter::new(FEW, threads)?,
            many: Painter::new(MANY, threads)?,
        })
    }
}

/// What was found in an order's pictures of a scene; lists are parallel to [`STEPS`].
#[derive(Clone, Debug, Default)]
pub struct Continuity {
    /// The largest change of a tile.
    pub largest: [f64; 3],
    /// What 99.9 % of the tiles' changes don't exceed, at even distances of time.
    pub percentile: [f64; 3],
    /// The share of the hair's pixels that pop in a tick: the most, and the mean at even distances of time.
    pub popped: [f64; 2],
    /// Intervals that were looked at, and those drawn with many samples.
    pub looked_at: [usize; 2],
    /// Where a tile changes most in the second of the steps.
    pub worst: Option<Worst>,
}

/// Where most changes.
#[derive(Clone, Debug)]
pub struct Worst {
    /// The moment before.
    pub tick: Tick,
    /// The tile's number, row by row.
    pub tile: usize,
    /// How much the tile changes.
    pub change: f64,
    /// The pictures before and after.
    pub pictures: [Picture; 2],
}

impl Continuity {
    /// The largest change at 1/384 s over that at half the time: 2 where all change is continuous, 1
    /// where something jumps. Nothing where nothing changes.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        ratio(self.largest[0], self.largest[1])
    }

    /// The same a step finer.
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

/// What an order's picture changed by in an interval, as far as few samples show.
#[derive(Clone, Copy, Debug)]
struct Glance {
    largest: f64,
    popped: f64,
}

/// Measures a scene in every order of [`ORDERS`]. `done` is called after each interval.
///
/// # Errors
///
/// When a frame can't be made or drawn.
pub fn measure(
    scene: &mut Scene,
    painters: &mut Painters,
    effort: Effort,
    mut done: impl FnMut(),
) -> Result<Vec<Continuity>, String> {
    let starts = starts(scene);
    let glances = glance(scene, painters, &mut done)?;
    let chosen: Vec<Chosen> = glances.iter().map(|of| choose(of, effort)).collect();
    let mut found: Vec<Found> = ORDERS.iter().map(|_| Found::default()).collect();
    for (i, &start) in starts.iter().enumerate() {
        if chosen.iter().any(|chosen| chosen.contains_key(&i)) {
            let wanted: Vec<Option<bool>> = chosen.iter().map(|of| of.get(&i).copied()).collect();
            refine(scene, painters, start, &wanted, &mut found)?;
        }
        done();
    }
    let finished = found.into_iter().zip(&chosen);
    Ok(finished
        .map(|(found, chosen)| found.finish([starts.len(), chosen.len()]))
        .collect())
}

/// How often [`measure`] calls `done`.
#[must_use]
pub fn length(scene: &Scene) -> usize {
    2 * starts(scene).len()
}

/// The first ticks of all intervals.
fn starts(scene: &Scene) -> Vec<Tick> {
    let windows = scene.windows.iter().cloned();
    windows
        .flat_map(|window| window.step_by(LONGEST as usize))
        .collect()
}

/// For each order what each interval looks like with few samples.
fn glance(
    scene: &mut Scene,
    painters: &mut Painters,
    done: &mut impl FnMut(),
) -> Result<Vec<Vec<Glance>>, String> {
    let mut glances = vec![Vec::new(); ORDERS.len()];
    for window in &scene.windows {
        let mut before: Option<(Vec<bool>, Vec<Picture>)> = None;
        for tick in (window.start..=window.end).step_by(LONGEST as usize) {
            let mut frame = scene.animation.at(tick)?;
            let hair = painters.hair.hair(&mut frame)?;
            let mut pictures = Vec::new();
            for (_, order) in ORDERS {
                pictures.push(painters.few.picture(&mut frame, order)?);
            }
            if let Some((hair_before, pictures_before)) = before {
                let width = pictures[0].width as usize;
                let tiles = HairTiles::new(width, [&hair_before, &hair]);
                let pairs = pictures_before.iter().zip(&pictures);
                for (glances, (before, after)) in glances.iter_mut().zip(pairs) {
                    let change = tiles.change(before, after);
                    glances.push(Glance {
                        largest: change.largest().map_or(0.0, |largest| largest.1),
                        popped: change.popped,
                    });
                }
                done();
            }
            before = Some((hair, pictures));
        }
    }
    Ok(glances)
}

/// Numbers of intervals, and whether each is one of those at even distances.
type Chosen = BTreeMap<usize, bool>;

fn choose(glances: &[Glance], effort: Effort) -> Chosen {
    let mut chosen = Chosen::new();
    for by in [
        |glance: &Glance| glance.largest,
        |glance: &Glance| glance.popped,
    ] {
        let mut by_size: Vec<usize> = (0..glances.len()).collect();
        by_size.sort_by(|&a, &b| by(&glances[b]).total_cmp(&by(&glances[a])));
        chosen.extend(by_size.iter().take(effort.suspicious).map(|&i| (i, false)));
    }
    let count = effort.even.min(glances.len());
    chosen.extend((0..count).map(|i| ((2 * i + 1) * glances.len() / (2 * count), true)));
    chosen
}

/// What has been found so far.
#[derive(Default)]
struct Found {
    continuity: Continuity,
    /// Changes of all tiles at even distances of time, for each step.
    tiles: [Vec<f64>; 3],
    /// Shares of pixels that pop in a tick.
    popped: Vec<f64>,
}

/// Draws an interval with many samples, for each order that wants it (with whether it is one at even distances).
fn refine(
    scene: &mut Scene,
    painters: &mut Painters,
    start: Tick,
    wanted: &[Option<bool>],
    found: &mut [Found],
) -> Result<(), String> {
    let mut masks = Vec::new();
    let mut pictures = vec![Vec::new(); ORDERS.len()];
    for tick in start..=start + LONGEST {
        let mut frame = scene.animation.at(tick)?;
        if tick == start || tick == start + LONGEST {
            masks.push(painters.hair.hair(&mut frame)?);
        }
        let orders = ORDERS.iter().zip(wanted).zip(&mut pictures);
        for (((_, order), wanted), pictures) in orders {
            if wanted.is_some() {
                pictures.push(painters.many.picture(&mut frame, *order)?);
            }
        }
    }
    for ((pictures, wanted), found) in pictures.iter().zip(wanted).zip(found) {
        if let Some(is_even) = *wanted {
            let tiles = HairTiles::new(pictures[0].width as usize, [&masks[0], &masks[1]]);
            found.add(&tiles, pictures, start, is_even);
        }
    }
    Ok(())
}

impl Found {
    /// Adds an interval: its pictures at every tick from `start` on.
    fn add(&mut self, tiles: &HairTiles, pictures: &[Picture], start: Tick, is_even: bool) {
        for (i, step) in STEPS.iter().enumerate() {
            let step = *step as usize;
            for first in (0..LONGEST as usize).step_by(step) {
                let pair = [&pictures[first], &pictures[first + step]];
                let change = tiles.change(pair[0], pair[1]);
                if is_even {
                    self.tiles[i].extend(change.tiles.iter().map(|tile| tile.1));
                }
                if step == 1 {
                    self.add_popped(change.popped, is_even);
                }
                self.add_largest(i, &change, start + first as Tick, pair);
            }
        }
    }

    fn add_popped(&mut self, popped: f64, is_even: bool) {
        let worst = &mut self.continuity.popped[0];
        *worst = worst.max(popped);
        if is_even {
            self.popped.push(popped);
        }
    }

    fn add_largest(&mut self, step: usize, change: &Change, tick: Tick, pictures: [&Picture; 2]) {
        let Some((tile, change)) = change.largest() else {
            return;
        };
        let largest = &mut self.continuity.largest[step];
        if change <= *largest {
            return;
        }
        *largest = change;
        if STEPS[step] == LONGEST / 2 {
            self.continuity.worst = Some(Worst {
                tick,
                tile,
                change,
                pictures: pictures.map(Picture::clone),
            });
        }
    }

    fn finish(mut self, looked_at: [usize; 2]) -> Continuity {
        self.continuity.looked_at = looked_at;
        self.continuity.percentile = self.tiles.map(|mut changes| {
            changes.sort_by(f64::total_cmp);
            let rank = (changes.len() * 999).div_ceil(1000);
            rank.checked_sub(1).map_or(0.0, |place| changes[place])
        });
        let count = self.popped.len().max(1) as f64;
        self.continuity.popped[1] = self.popped.iter().sum::<f64>() / count;
        self.continuity
    }
}
