//! Sections across an island.

use super::distance::{Surface, range};
use glam::DVec3;

/// How far from the ends the outermost sections are, as a share of the whole: there is no section at a point.
const INSET: f64 = 0.02;
/// Of a line not more than this share is left out at either end.
const MOST_TRIMMED: f64 = 0.35;
/// A section that is less than so much wider than thick is round, and has no width of its own.
const ROUND: f64 = 1.2;

/// A section across a lock.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub middle: DVec3,
    /// How far it is from the root along the middles, in metres.
    pub along: f64,
    /// The way in which it is widest, a unit vector.
    pub across: DVec3,
    /// Across that and the lock, a unit vector.
    pub out: DVec3,
    /// In metres.
    pub half_width: f64,
    pub half_thickness: f64,
    /// Its outline, from the middle: along `across`, along `out`, and how much of the outline is there.
    pub outline: Vec<[f64; 3]>,
}

/// A line through the middle of an island.
pub(super) struct Line {
    /// Two or more.
    pub points: Vec<DVec3>,
    /// The levels of its ends.
    pub span: [f64; 2],
    /// How far from it the island goes, in metres.
    pub radius: f64,
}

/// The levels from root to tip of links of one length.
fn levels(along: &[f64], links: usize) -> impl Iterator<Item = f64> {
    let (low, high) = range(along);
    let share = move |link: usize| (link as f64 / links as f64).clamp(INSET, 1.0 - INSET);
    (0..=links).map(move |link| low + (high - low) * share(link))
}

/// Where a level goes through the triangles.
fn cuts(surface: &Surface, along: &[f64], level: f64) -> Vec<[DVec3; 2]> {
    let mut cuts = Vec::new();
    for &[a, b, c] in &surface.triangles {
        let below = [a, b, c].map(|i| along[i] < level);
        if below[0] == below[1] && below[1] == below[2] {
            continue;
        }
        let at = |from: usize, to: usize| {
            let share = (level - along[from]) / (along[to] - along[from]);
            surface.places[from].lerp(surface.places[to], share)
        };
        // The level goes through the two sides of one corner.
        cuts.push(match below {
            [own, next, _] if own == next => [at(b, c), at(c, a)],
            [_, next, last] if next == last => [at(a, b), at(c, a)],
            _ => [at(a, b), at(b, c)],
        });
    }
    cuts
}

/// The middles of the levels of `along`, but for those nearer to an end than `trim` of what the island is wide there, as levels may not
/// stand straight at ends yet; nothing where fewer than two are left.
pub(super) fn middles(surface: &Surface, along: &[f64], links: usize, trim: f64) -> Option<Line> {
    let (low, high) = range(along);
    let (mut middles, mut wide, mut widest) = (Vec::new(), Vec::new(), 0.0_f64);
    for level in levels(along, links) {
        let cuts = cuts(surface, along, level);
        if let Some(middle) = middle(&cuts) {
            let far = cuts.iter().flatten().map(|place| place.distance(middle));
            let radius = far.fold(0.0, f64::max);
            let from_end = (level - low).min(high - level);
            widest = widest.max(radius);
            middles.push((level, middle));
            wide.push(from_end < trim * radius);
        }
    }
    let count = middles.len();
    let most = (count as f64 * MOST_TRIMMED) as usize;
    let trimmed =
        |wide: &mut dyn Iterator<Item = &bool>| wide.take_while(|w| **w).count().min(most);
    let (first, last) = (trimmed(&mut wide.iter()), trimmed(&mut wide.iter().rev()));
    let kept = middles.get(first..count - last)?;
    let (from, to) = (kept.first()?.0, kept.last()?.0);
    (kept.len() > 1).then(|| Line {
        points: kept.iter().map(|(_, middle)| *middle).collect(),
        span: [from, to],
        radius: widest,
    })
}

fn outline_length(cuts: &[[DVec3; 2]]) -> f64 {
    cuts.iter().map(|[a, b]| a.distance(*b)).sum()
}

fn middle(cuts: &[[DVec3; 2]]) -> Option<DVec3> {
    let length = outline_length(cuts);
    if length > 0.0 {
        let sum: DVec3 = cuts
            .iter()
            .map(|[a, b]| (*a + *b) * (0.5 * a.distance(*b)))
            .sum();
        return Some(sum / length);
    }
    // A point.
    cuts.first().map(|[a, _]| *a)
}

/// The sections of levels that stand on a line; the first and the last are at its ends.
pub(super) fn sections(surface: &Surface, along: &[f64], links: usize) -> Option<Vec<Section>> {
    let (low, high) = range(along);
    let mut found: Vec<Section> = Vec::new();
    let levels: Vec<(f64, Vec<[DVec3; 2]>)> = levels(along, links)
        .map(|level| (level, cuts(surface, along, level)))
        .collect();
    let middles: Vec<(DVec3, &[[DVec3; 2]])> = levels
        .iter()
        .filter_map(|(_, cuts)| Some((middle(cuts)?, &cuts[..])))
        .collect();
    for (index, (middle, cuts)) in middles.iter().enumerate() {
        let before = middles[index.saturating_sub(1)].0;
        let after = middles[(index + 1).min(middles.len() - 1)].0;
        let Some(way) = (after - before).try_normalize() else {
            continue;
        };
        let last = found.last().map(|last| last.across);
        found.push(section(*middle, way, cuts, last));
    }
    if found.len() < 2 {
        return None;
    }
    let inset = INSET * (high - low);
    let end = |of: &Section, inner: &Section| {
        of.middle + inset * (of.middle - inner.middle).normalize_or_zero()
    };
    let count = found.len();
    let [root, tip] = [
        end(&found[0], &found[1]),
        end(&found[count - 1], &found[count - 2]),
    ];
    found[0].middle = root;
    found[count - 1].middle = tip;
    measure(&mut found);
    (length(&found) > 0.0).then_some(found)
}

fn section(middle: DVec3, way: DVec3, cuts: &[[DVec3; 2]], last: Option<DVec3>) -> Section {
    let one = way.any_orthonormal_vector();
    let other = way.cross(one);
    // Second moments of the outline about its middle.
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for [a, b] in cuts {
        let weight = a.distance(*b);
        for place in [*a, *b, (*a + *b) * 0.5] {
            let [x, y] = [one, other].map(|axis| (place - middle).dot(axis));
            (xx, xy, yy) = (
                xx + weight * x * x,
                xy + weight * x * y,
                yy + weight * y * y,
            );
        }
    }
    let half = 0.5 * (xx - yy);
    let root = (half * half + xy * xy).sqrt();
    let axis = match half > 0.0 {
        true => one * (half + root) + other * xy,
        false => one * xy + other * (root - half),
    };
    let [wide, thin] = [0.5 * (xx + yy) + root, 0.5 * (xx + yy) - root].map(|m| m.max(0.0).sqrt());
    let turned = last.and_then(|last| (last - way * last.dot(way)).try_normalize());
    let across = match (axis.try_normalize(), turned) {
        (Some(axis), None) => axis,
        (Some(axis), Some(last)) if wide > ROUND * thin => axis * axis.dot(last).signum(),
        (_, Some(last)) => last,
        (None, None) => one,
    };
    let out = way.cross(across);
    let extent = |axis: DVec3| {
        let places: Vec<f64> = cuts
            .iter()
            .flatten()
            .map(|p| (*p - middle).dot(axis))
            .collect();
        range(&places)
    };
    let [[from_x, to_x], [from_y, to_y]] = [extent(across), extent(out)].map(|(a, b)| [a, b]);
    let middle_of = |from: f64, to: f64| 0.5 * (from + to);
    let (x, y) = (middle_of(from_x, to_x), middle_of(from_y, to_y));
    let outline = cuts.iter().flat_map(|[a, b]| {
        // Quarters of each cut, so that long ones are found everywhere.
        (0..4).map(move |part| {
            let place = a.lerp(*b, 0.125 + 0.25 * f64::from(part)) - middle;
            [
                place.dot(across) - x,
                place.dot(out) - y,
                0.25 * a.distance(*b),
            ]
        })
    });
    Section {
        outline: outline.collect(),
        along: 0.0,
        middle: middle + across * x + out * y,
        across,
        out,
        half_width: 0.5 * (to_x - from_x),
        half_thickness: 0.5 * (to_y - from_y),
    }
}

/// Tells each section how far it is from the first.
pub(super) fn measure(sections: &mut [Section]) {
    let mut along = 0.0;
    for index in 0..sections.len() {
        if index > 0 {
            along += sections[index].middle.distance(sections[index - 1].middle);
        }
        sections[index].along = along;
    }
}

impl Section {
    /// The same, before this one and nearer to `skull`, by `by_m` each.
    pub fn under(&self, skull: DVec3, by_m: f64) -> Self {
        let way = self.across.cross(self.out);
        let down = (skull - self.middle).normalize_or_zero();
        Self {
            middle: self.middle + by_m * (down - way),
            ..self.clone()
        }
    }
}

/// The length of the line through the middles, in metres.
pub(super) fn length(sections: &[Section]) -> f64 {
    sections.last().map_or(0.0, |tip| tip.along)
}
