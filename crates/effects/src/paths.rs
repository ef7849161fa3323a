//! Paths that effects make: strokes that follow no strand of their own (thesis 5.5).

use crate::light::Light;
use glam::Vec3;
use rayon::prelude::*;
use std::any::Any;
use std::sync::Arc;

/// The hair as it stands, for effects that make paths.
#[derive(Clone, Copy, Debug)]
pub struct Hair<'a> {
    /// All strands, by rising id.
    pub strands: &'a [HairStrand<'a>],
    /// Centre of the head as it stands, metres.
    pub head_center: Vec3,
    /// Centre of the head at rest, metres: the one for [`HairStrand::at_rest`].
    pub head_center_at_rest: Vec3,
    /// Height of the head, metres.
    pub head_height_m: f32,
    /// The light, as the strands are.
    pub light: Light,
    /// The eye's place, metres. At rest, light and eye are before the face.
    pub eye: Vec3,
}

/// One strand of the hair.
#[derive(Clone, Copy, Debug)]
pub struct HairStrand<'a> {
    /// Its stable id, which choices may hang on.
    pub id: u32,
    /// Its particles from root to tip as they stand, metres; one or more.
    pub particles: &'a [Vec3],
    /// The particles at rest, as many: which strands are neighbours must not change as hair moves.
    pub at_rest: &'a [Vec3],
    /// Its full size, 1/300 of the head's height.
    pub size: f32,
    /// Whether the layer draws on its zone: paths that are made of others aren't drawn.
    pub is_drawn: bool,
}

impl HairStrand<'_> {
    /// The point at `u` of the way from root (0) to tip (1), by particles; straight between them and
    /// beyond both ends. Metres.
    #[must_use]
    pub fn point(&self, u: f32) -> Vec3 {
        point(self.particles, u)
    }

    /// [`Self::point`] at rest.
    #[must_use]
    pub fn point_at_rest(&self, u: f32) -> Vec3 {
        point(self.at_rest, u)
    }
}

fn point(particles: &[Vec3], u: f32) -> Vec3 {
    let last = particles.len().saturating_sub(1);
    if last == 0 {
        return particles.first().copied().unwrap_or_default();
    }
    let place = u * last as f32;
    let i = (place.max(0.0) as usize).min(last - 1);
    let (a, b) = (particles[i], particles[i + 1]);
    a + (b - a) * (place - i as f32)
}

/// Paths that an effect made for one frame, and what it keeps for the next ones.
#[derive(Clone, Debug, Default)]
pub struct MadePaths {
    points: Vec<Vec3>,
    /// As many as points.
    weights: Vec<f32>,
    paths: Vec<Part>,
    fault: Option<String>,
    kept: Option<Arc<dyn Any + Send + Sync>>,
}

/// Strands whose paths a thread makes at a time.
const SOME_STRANDS: usize = 32;

/// Where a path's points end, and whose it is.
#[derive(Clone, Copy, Debug)]
struct Part {
    strand: usize,
    number: u32,
    end: usize,
}

/// A path that an effect made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MadePath<'a> {
    /// The strand that it is of, an index of [`Hair::strands`].
    pub strand: usize,
    /// Which of the strand's it is, 0 to 7.
    pub number: u32,
    /// From root to tip, metres.
    pub points: &'a [Vec3],
    /// How much of it is there at each point: `joint.path_weight`.
    pub weights: &'a [f32],
}

impl MadePath<'_> {
    /// How much of it is there at `u` of the way, from 0 to 1, by points.
    #[must_use]
    pub fn weight(&self, u: f32) -> f32 {
        let last = self.weights.len().saturating_sub(1);
        let place = (u * last as f32).clamp(0.0, last as f32);
        let before = (place as usize).min(last.saturating_sub(1));
        let (Some(a), Some(b)) = (
            self.weights.get(before),
            self.weights.get((before + 1).min(last)),
        ) else {
            return 1.0;
        };
        a + (b - a) * (place - before as f32)
    }
}

/// Most paths that can be made of one strand.
pub const MOST_PATHS: u32 = 8;

impl MadePaths {
    /// Forgets all paths, but not what the effect keeps ([`Self::once`]): for the next frame of the same layer on the same hair.
    pub fn clear(&mut self) {
        self.points.clear();
        self.weights.clear();
        self.paths.clear();
        self.fault = None;
    }

    /// What `find` finds, which is asked in the first frame alone: for what hangs on parameters, seed and what strands are in every frame ([`HairStrand::id`],
    /// [`HairStrand::at_rest`], [`HairStrand::size`], [`HairStrand::is_drawn`]), as which of them are neighbours. An effect keeps one such thing.
    pub fn once<T: Send + Sync + 'static>(&mut self, find: impl FnOnce() -> T) -> Arc<T> {
        let kept = self.kept.clone().and_then(|kept| kept.downcast().ok());
        kept.unwrap_or_else(|| {
            let found = Arc::new(find());
            self.kept = Some(found.clone());
            found
        })
    }

    /// Adds the paths of as many strands, which several threads make at once: `make` adds those of one, an index of [`Hair::strands`], as [`Self::push`] does.
    pub fn push_each(&mut self, strands: usize, make: impl Fn(usize, &mut Self) + Sync) {
        let of_some = |first: usize| {
            let mut own = Self::default();
            let last = (first + SOME_STRANDS).min(strands);
            (first..last).for_each(|strand| make(strand, &mut own));
            own
        };
        let some = (0..strands.div_ceil(SOME_STRANDS)).into_par_iter();
        let parts: Vec<Self> = some.map(|i| of_some(i * SOME_STRANDS)).collect();
        parts.iter().for_each(|part| self.append(part));
    }

    /// Adds paths that come after its own.
    fn append(&mut self, other: &Self) {
        for path in other.iter() {
            let points = path.points.iter().zip(path.weights);
            let points = points.map(|(point, weight)| (*point, *weight));
            self.push_weighted(path.strand, path.number, points);
        }
        if let Some(fault) = &other.fault {
            self.fault.get_or_insert_with(|| fault.clone());
        }
    }

    /// Adds path `number` (0 to 7) of strand `strand`, an index of [`Hair::strands`]: its points from root
    /// to tip, metres. In the order of strands, and of numbers in each.
    ///
    /// The strand lends the path its size and colour. Strand and number must name the same path in
    /// every frame: its variations hang on them.
    ///
    /// A path that is out of this order, or whose number is above 7, is left out, and the frame isn't drawn: [`Self::fault`].
    pub fn push(&mut self, strand: usize, number: u32, points: impl IntoIterator<Item = Vec3>) {
        let whole = points.into_iter().map(|point| (point, 1.0));
        self.push_weighted(strand, number, whole);
    }

    /// [`Self::push`] with how much of the path is there at each point, 0 or more, which `joint.path_weight` says: 0 where nothing of it is to
    /// be seen. A path that comes and goes is there in every frame, with weights that grow from 0.
    pub fn push_weighted(
        &mut self,
        strand: usize,
        number: u32,
        points: impl IntoIterator<Item = (Vec3, f32)>,
    ) {
        let before = self.paths.last().map(|path| (path.strand, path.number));
        let fault = if number >= MOST_PATHS {
            format!(
                "a strand has at most {MOST_PATHS} paths, 0 to 7, and strand {strand} has a path {number}"
            )
        } else if let Some((last, last_number)) = before.filter(|last| *last >= (strand, number)) {
            format!(
                "path {number} of strand {strand} comes after path {last_number} of strand {last}: \
                 they go by strand, then by number"
            )
        } else {
            String::new()
        };
        if !fault.is_empty() {
            self.fault.get_or_insert(fault);
            return;
        }
        let first = self.points.len();
        for (point, weight) in points {
            self.points.push(point);
            self.weights.push(weight);
        }
        let bad = |weight: &&f32| !(0.0..f32::INFINITY).contains(*weight);
        if let Some(weight) = self.weights[first..].iter().find(bad) {
            let fault = format!(
                "path {number} of strand {strand} has a weight of {weight}: weights are 0 or more"
            );
            self.fault.get_or_insert(fault);
            self.points.truncate(first);
            self.weights.truncate(first);
            return;
        }
        self.paths.push(Part {
            strand,
            number,
            end: self.points.len(),
        });
    }

    /// What is wrong with the first path that is none.
    #[must_use]
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// All paths.
    pub fn iter(&self) -> impl Iterator<Item = MadePath<'_>> {
        let starts = std::iter::once(0).chain(self.paths.iter().map(|path| path.end));
        self.paths.iter().zip(starts).map(|(path, start)| MadePath {
            strand: path.strand,
            number: path.number,
            points: &self.points[start..path.end],
            weights: &self.weights[start..path.end],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_between_particles_and_beyond() {
        let particles = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, -2.0, 0.0)];
        let strand = |particles| HairStrand {
            id: 0,
            particles,
            at_rest: &[Vec3::Z],
            size: 1.0,
            is_drawn: true,
        };
        let bent = strand(&particles);
        for (u, point) in [
            (0.0, Vec3::ZERO),
            (0.25, Vec3::new(0.5, 0.0, 0.0)),
            (0.75, Vec3::new(1.0, -1.0, 0.0)),
            (1.0, particles[2]),
            (1.5, Vec3::new(1.0, -4.0, 0.0)),
            (-0.5, Vec3::new(-1.0, 0.0, 0.0)),
        ] {
            assert_eq!(bent.point(u), point, "{u}");
        }
        assert_eq!(strand(&particles[1..2]).point(0.7), Vec3::X);
        assert_eq!(bent.point_at_rest(0.3), Vec3::Z);
    }

    #[test]
    fn paths_keep_their_points() {
        let mut paths = MadePaths::default();
        paths.push(0, 3, [Vec3::X]);
        paths.push(2, 0, [Vec3::Y, Vec3::Z]);
        paths.push(2, 1, []);
        let made: Vec<_> = (paths.iter())
            .map(|path| (path.strand, path.number, path.points.to_vec()))
            .collect();
        let expected = [
            (0, 3, vec![Vec3::X]),
            (2, 0, vec![Vec3::Y, Vec3::Z]),
            (2, 1, vec![]),
        ];
        assert_eq!(made, expected);
    }

    #[test]
    fn threads_make_the_paths_that_one_makes() {
        let make = |strand: usize, paths: &mut MadePaths| {
            for number in 0..(strand % 3) as u32 {
                let points = (0..strand % 5).map(|i| (Vec3::splat((strand + i) as f32), i as f32));
                paths.push_weighted(strand, number, points);
            }
        };
        let all = |paths: &MadePaths| -> Vec<_> {
            let own = |path: MadePath| {
                let (points, weights) = (path.points.to_vec(), path.weights.to_vec());
                (path.strand, path.number, points, weights)
            };
            paths.iter().map(own).collect()
        };
        for strands in [0, 1, SOME_STRANDS, 5 * SOME_STRANDS + 3] {
            let (mut one, mut many) = (MadePaths::default(), MadePaths::default());
            (0..strands).for_each(|strand| make(strand, &mut one));
            many.push_each(strands, make);
            assert_eq!(all(&many), all(&one));
            assert_eq!(many.fault(), None);
        }
        // What is wrong is found between those of different threads, too, and the first of it is said.
        let mut paths = MadePaths::default();
        paths.push_each(2 * SOME_STRANDS, |_, paths| paths.push(7, 0, [Vec3::X]));
        assert_eq!(paths.iter().count(), 1);
        let mut paths = MadePaths::default();
        paths.push_each(2 * SOME_STRANDS, |strand, paths| {
            paths.push(strand, strand as u32, [])
        });
        assert!(
            paths.fault().unwrap().contains("strand 8 has a path 8"),
            "{:?}",
            paths.fault()
        );
        let mut paths = MadePaths::default();
        let one_each = |strand: usize, paths: &mut MadePaths| {
            let place = if strand < SOME_STRANDS {
                strand
            } else {
                strand - 1
            };
            paths.push(place, 0, []);
        };
        paths.push_each(2 * SOME_STRANDS, one_each);
        let last = format!("of strand {}", SOME_STRANDS - 1);
        assert!(
            paths.fault().unwrap().contains(&last),
            "{:?}",
            paths.fault()
        );
    }

    #[test]
    fn what_is_kept_is_found_once() {
        let mut paths = MadePaths::default();
        assert_eq!(*paths.once(|| vec![1, 2]), [1, 2]);
        paths.clear();
        assert_eq!(*paths.once(|| -> Vec<i32> { unreachable!() }), [1, 2]);
        assert_eq!(*paths.once(|| "another kind"), "another kind");
    }

    #[test]
    fn weights_lie_between_those_of_points() {
        let mut paths = MadePaths::default();
        paths.push_weighted(0, 0, [(Vec3::X, 0.0), (Vec3::Y, 0.5), (Vec3::Z, 2.0)]);
        paths.push(1, 0, [Vec3::X]);
        let all: Vec<MadePath> = paths.iter().collect();
        for (u, weight) in [
            (-1.0, 0.0),
            (0.0, 0.0),
            (0.25, 0.25),
            (0.75, 1.25),
            (1.0, 2.0),
            (3.0, 2.0),
        ] {
            assert_eq!(all[0].weight(u), weight, "{u}");
        }
        assert_eq!(all[1].weight(0.5), 1.0);
        for bad in [f32::NAN, f32::INFINITY, -0.1] {
            paths.clear();
            paths.push_weighted(0, 0, [(Vec3::X, 1.0), (Vec3::Y, bad)]);
            assert!(paths.fault().unwrap().contains("weights are 0 or more"));
            assert_eq!(paths.iter().count(), 0);
        }
    }

    #[test]
    fn paths_have_an_order_and_an_end() {
        let mut paths = MadePaths::default();
        paths.push(1, 0, []);
        assert_eq!(paths.fault(), None);
        paths.push(1, 0, [Vec3::X]);
        paths.push(2, MOST_PATHS, [Vec3::X]);
        assert!(
            paths
                .fault()
                .unwrap()
                .starts_with("path 0 of strand 1 comes after")
        );
        assert_eq!(paths.iter().count(), 1);
        paths.clear();
        paths.push(2, MOST_PATHS, [Vec3::X]);
        assert!(paths.fault().unwrap().contains("at most 8 paths"));
    }
}
