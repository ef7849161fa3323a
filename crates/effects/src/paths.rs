//! Paths that effects make: strokes that follow no strand of their own (thesis 5.5).

use glam::Vec3;

/// The hair as it stands, for effects that make paths.
#[derive(Clone, Copy, Debug)]
pub struct Hair<'a> {
    /// All strands, by rising id.
    pub strands: &'a [HairStrand<'a>],
    /// Centre of the head, metres.
    pub head_center: Vec3,
    /// Height of the head, metres.
    pub head_height_m: f32,
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

/// Paths that an effect made for one frame.
#[derive(Clone, Debug, Default)]
pub struct MadePaths {
    points: Vec<Vec3>,
    paths: Vec<MadePath>,
}

/// Where a path's points end, and whose it is.
#[derive(Clone, Copy, Debug)]
struct MadePath {
    strand: usize,
    number: u32,
    end: usize,
}

/// Most paths that can be made of one strand.
pub const MOST_PATHS: u32 = 8;

impl MadePaths {
    /// Forgets all paths.
    pub fn clear(&mut self) {
        self.points.clear();
        self.paths.clear();
    }

    /// Adds path `number` (0 to 7) of strand `strand`, an index of [`Hair::strands`]: its points from root
    /// to tip, metres. In the order of strands, and of numbers in each.
    ///
    /// The strand lends the path its size and colour. Strand and number must name the same path in
    /// every frame: its variations hang on them.
    ///
    /// # Panics
    ///
    /// When the path is out of this order, or its number is above 7.
    pub fn push(&mut self, strand: usize, number: u32, points: impl IntoIterator<Item = Vec3>) {
        assert!(number < MOST_PATHS, "path {number} of a strand");
        let before = self.paths.last().map(|path| (path.strand, path.number));
        assert!(before < Some((strand, number)), "paths out of order");
        self.points.extend(points);
        self.paths.push(MadePath {
            strand,
            number,
            end: self.points.len(),
        });
    }

    /// All paths: strand, number and points.
    pub fn iter(&self) -> impl Iterator<Item = (usize, u32, &[Vec3])> {
        let starts = std::iter::once(0).chain(self.paths.iter().map(|path| path.end));
        self.paths
            .iter()
            .zip(starts)
            .map(|(path, start)| (path.strand, path.number, &self.points[start..path.end]))
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
        let made: Vec<_> = paths.iter().map(|(s, n, p)| (s, n, p.to_vec())).collect();
        let expected = [
            (0, 3, vec![Vec3::X]),
            (2, 0, vec![Vec3::Y, Vec3::Z]),
            (2, 1, vec![]),
        ];
        assert_eq!(made, expected);
    }

    #[test]
    #[should_panic(expected = "out of order")]
    fn paths_have_an_order() {
        let mut paths = MadePaths::default();
        paths.push(1, 0, []);
        paths.push(1, 0, []);
    }
}
