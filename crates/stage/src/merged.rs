//! Level of detail: of hair thinner than a pixel fewer strands are drawn, which are wider, with as much ink.
//!
//! Every strand has a rank, and where clumps are a part `t` of a pixel wide those of the least ranks are drawn, `t` of all, each as
//! much wider as there are fewer. Ranks above shrink to nothing one after the other as `t` falls, and those that are left grow: both
//! hang on where hair is now and on no frame before, so nothing pops. Neighbours have ranks far apart, and what is left of hair is
//! spread evenly wherever it is looked at.

use glam::Vec3;

/// Strands shrink to nothing over this share of the ranks that are drawn whole.
const RAMP: f32 = 0.5;

/// Cells along each side of the box around the roots by which neighbours are told: a power of two.
const CELLS: u32 = 1 << 10;

/// The ranks of hair's strands, by their roots at rest: those of a style's undercoat, and those of the rest.
pub(crate) struct Ranks {
    undercoat: Vec<f32>,
    above: Vec<f32>,
}

impl Ranks {
    /// Those of strands with these roots, metres, the first of which are the undercoat.
    pub fn of(roots: &[Vec3], undercoat: usize) -> Self {
        let (undercoat, above) = roots.split_at(undercoat);
        Self {
            undercoat: ranks(undercoat),
            above: ranks(above),
        }
    }

    /// The factor on the size of a strand whose clump is that part of the least width that is drawn as it is: 1 from 1 on, 0 where
    /// the strand is not drawn.
    pub fn factor(&self, strand: usize, width: f32) -> f32 {
        let (ranks, number) = match strand.checked_sub(self.undercoat.len()) {
            Some(number) => (&self.above, number),
            None => (&self.undercoat, strand),
        };
        // One strand at least is left of all, and has the ink of all.
        let whole = width.max(1.0 / ranks.len() as f32);
        if whole >= 1.0 {
            return 1.0;
        }
        let ramp = RAMP * whole;
        let share = 1.0 - ((ranks[number] - whole) / ramp).clamp(0.0, 1.0);
        // The mean of the shares of all ranks.
        let falling = ramp.min(1.0 - whole);
        let mean = whole + falling - falling * falling / (2.0 * ramp);
        share / mean
    }
}

/// Of each strand its rank, evenly spread from 0 to 1.
fn ranks(roots: &[Vec3]) -> Vec<f32> {
    let low = roots.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = roots.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    let side = (high - low).max_element().max(f32::MIN_POSITIVE);
    // Along a curve through the cells of the box, of which any stretch is a region of its own.
    let place = |root: Vec3| {
        let cell = (root - low) / side * (CELLS - 1) as f32;
        spread(cell.x as u32) | spread(cell.y as u32) << 1 | spread(cell.z as u32) << 2
    };
    let mut along: Vec<usize> = (0..roots.len()).collect();
    along.sort_by_key(|&strand| (place(roots[strand]), strand));
    // Numbers whose bits are turned around: of any that follow each other, those below any limit are spread evenly.
    let mut by_rank: Vec<(u32, usize)> = (0..).map(u32::reverse_bits).zip(along).collect();
    by_rank.sort_unstable();
    let mut ranks = vec![0.0; roots.len()];
    for (number, (_, strand)) in by_rank.into_iter().enumerate() {
        ranks[strand] = (number as f32 + 0.5) / roots.len() as f32;
    }
    ranks
}

/// The lowest ten bits, each two places apart from the next.
fn spread(bits: u32) -> u32 {
    (0..10).fold(0, |sum, i| sum | (bits >> i & 1) << (3 * i))
}

#[cfg(test)]
mod tests {
    use super::*;
    use effects::wgsl::random;

    fn roots(count: usize) -> Vec<Vec3> {
        let at = |i: u32| Vec3::new(random(i, 0), random(i, 1), random(i, 2));
        (0..count as u32).map(at).collect()
    }

    #[test]
    fn ink_is_the_same_at_any_width() {
        for count in [1, 2, 7, 300, 5000] {
            let ranks = Ranks::of(&roots(count), 0);
            for width in [0.999, 0.9, 0.5, 0.3, 0.1, 0.03, 0.004, 1e-6] {
                let factors: Vec<f32> = (0..count).map(|i| ranks.factor(i, width)).collect();
                let mean = factors.iter().sum::<f32>() / count as f32;
                let few = 1.0 / (count as f32 * width.max(1.0 / count as f32));
                assert!(
                    (mean - 1.0).abs() < 1e-4 + 0.6 * few * few,
                    "{count}, {width}: {mean}"
                );
                // As wide as what is drawn as it is, at most.
                let widest = factors.iter().copied().fold(0.0, f32::max);
                assert!(widest * width.max(1.0 / count as f32) <= 1.0 + 1e-5);
                let drawn = factors.iter().filter(|factor| **factor > 0.0).count();
                assert!(drawn as f32 <= (1.0 + RAMP) * width * count as f32 + 2.0);
            }
        }
    }

    #[test]
    fn hair_that_is_wide_enough_is_as_it_is() {
        let ranks = Ranks::of(&roots(50), 20);
        for width in [1.0, 1.5, f32::INFINITY] {
            assert!((0..50).all(|strand| ranks.factor(strand, width) == 1.0));
        }
    }

    #[test]
    fn strands_shrink_and_grow_without_a_jump() {
        let ranks = Ranks::of(&roots(400), 150);
        let mut width = 1.02_f32;
        while width > 0.02 {
            let next = 0.999 * width;
            for strand in 0..400 {
                // Drawn widths, in least ones.
                let [now, then] = [width, next].map(|width| width * ranks.factor(strand, width));
                assert!(
                    (now - then).abs() < 0.01,
                    "{strand} at {width}: {now} {then}"
                );
            }
            width = next;
        }
    }

    #[test]
    fn what_is_left_is_spread_evenly() {
        let roots = roots(4096);
        let ranks = Ranks::of(&roots, 0);
        for width in [0.5, 0.25, 0.1] {
            // In each eighth of the box there is as much ink as there was.
            let mut ink = [(0.0, 0); 8];
            for (strand, root) in roots.iter().enumerate() {
                let side = |place: f32| usize::from(place >= 0.5);
                let (sum, count) = &mut ink[side(root.x) | side(root.y) << 1 | side(root.z) << 2];
                *sum += ranks.factor(strand, width);
                *count += 1;
            }
            for (sum, count) in ink {
                let mean = sum / count as f32;
                assert!((mean - 1.0).abs() < 0.05, "{width}: {mean}");
            }
        }
        // Whatever number each has.
        let turned: Vec<Vec3> = roots.iter().rev().copied().collect();
        let of_turned = Ranks::of(&turned, 0);
        assert!((0..4096).all(|i| of_turned.above[4095 - i] == ranks.above[i]));
    }
}
