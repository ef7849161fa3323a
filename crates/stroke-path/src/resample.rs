//! Joints between the particles of a strand.

use glam::Vec3;

/// The most joints per interval between two particles.
pub const MAX_SUBDIVISION: u32 = 64;

/// How a path runs between the particles of a strand, and how many joints it has.
///
/// Every path passes through every particle: joint `i * subdivision` is particle `i`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathKind {
    /// Straight from particle to particle (the reference system's own, thesis 4.2).
    Linear {
        /// Joints per interval between particles, 1 to 64; with 1 the joints are the particles.
        subdivision: u32,
    },
    /// A centripetal Catmull-Rom spline (Yuksel, Schaefer and Keyser, *Parameterization and
    /// applications of Catmull-Rom curves*, 2011; alpha = 1/2), which makes no loops or cusps
    /// within an interval. Beyond the ends stand the neighbours' reflections, 2 P0 - P1.
    ///
    /// Where particles coincide the spline is what it tends to as they approach each other: the
    /// intervals beside them meet in a corner, so nothing jumps in animation.
    CatmullRom {
        /// Joints per interval between particles, 1 to 64; with 1 the joints are the particles.
        subdivision: u32,
    },
}

/// Why a path was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PathError {
    /// The subdivision is 1 to 64.
    #[error("the subdivision {0} is not within 1 to {MAX_SUBDIVISION}")]
    Subdivision(u32),
    /// A strand's cuts are within its joints.
    #[error("a strand is to be cut beyond its end")]
    Cut,
    /// A detail is of the path that it is used for.
    #[error("the detail is of a path with another number of joints")]
    Detail,
}

impl PathKind {
    /// Joints per interval between particles.
    ///
    /// # Errors
    ///
    /// When the number is not within 1 to 64.
    pub fn subdivision(self) -> Result<u32, PathError> {
        match self {
            Self::Linear { subdivision } | Self::CatmullRom { subdivision } => {
                if (1..=MAX_SUBDIVISION).contains(&subdivision) {
                    Ok(subdivision)
                } else {
                    Err(PathError::Subdivision(subdivision))
                }
            }
        }
    }

    /// All joints of a path from its first particle to its last.
    ///
    /// # Errors
    ///
    /// When the subdivision is not within 1 to 64.
    pub fn joints(
        self,
        particles: &[Vec3],
    ) -> Result<impl ExactSizeIterator<Item = Vec3>, PathError> {
        let joint_at = self.joint_at(particles)?;
        Ok((0..self.count(particles)?).map(joint_at))
    }

    /// How many joints a path has.
    ///
    /// # Errors
    ///
    /// When the subdivision is not within 1 to 64.
    pub(crate) fn count(self, particles: &[Vec3]) -> Result<usize, PathError> {
        let subdivision = self.subdivision()? as usize;
        Ok(match particles.len() {
            0 => 0,
            len => (len - 1) * subdivision + 1,
        })
    }

    /// What gives the joint of each number. Quickest where those of one interval follow each other.
    ///
    /// # Errors
    ///
    /// When the subdivision is not within 1 to 64.
    pub(crate) fn joint_at(
        self,
        particles: &[Vec3],
    ) -> Result<impl FnMut(usize) -> Vec3, PathError> {
        let subdivision = self.subdivision()? as usize;
        let (mut curve, mut of) = (Curve::default(), usize::MAX);
        Ok(move |joint: usize| {
            let (interval, step) = (joint / subdivision, joint % subdivision);
            let s = step as f32 / subdivision as f32;
            match (step, self) {
                (0, _) => particles[interval],
                (_, Self::Linear { .. }) => particles[interval].lerp(particles[interval + 1], s),
                (_, Self::CatmullRom { .. }) => {
                    if of != interval {
                        (curve, of) = (Curve::catmull_rom(particles, interval), interval);
                    }
                    curve.at(s)
                }
            }
        })
    }
}

/// A cubic Hermite curve.
#[derive(Clone, Copy, Debug, Default)]
struct Curve {
    ends: [Vec3; 2],
    tangents: [Vec3; 2],
}

impl Curve {
    /// The spline's interval as a cubic Hermite curve, whose end tangents are those of the parabolas
    /// through three particles each, knots being the square roots of the distances apart.
    fn catmull_rom(particles: &[Vec3], interval: usize) -> Self {
        let (p1, p2) = (particles[interval], particles[interval + 1]);
        let before = interval.checked_sub(1).map(|i| particles[i]);
        let p0 = before.unwrap_or(2.0 * p1 - p2);
        let after = particles.get(interval + 2).copied();
        let p3 = after.unwrap_or(2.0 * p2 - p1);
        let knots = |from: Vec3, to: Vec3| from.distance(to).sqrt();
        let (k0, k1, k2) = (knots(p0, p1), knots(p1, p2), knots(p2, p3));
        // A velocity is a distance over its square root: it tends to 0 with the distance.
        let velocity = |from: Vec3, to: Vec3, knots: f32| {
            if knots == 0.0 {
                Vec3::ZERO
            } else {
                (to - from) / knots
            }
        };
        let middle = velocity(p1, p2, k1);
        let tangent_1 = k1 * (velocity(p0, p1, k0) - velocity(p0, p2, k0 + k1) + middle);
        let tangent_2 = k1 * (middle - velocity(p1, p3, k1 + k2) + velocity(p2, p3, k2));
        Self {
            ends: [p1, p2],
            tangents: [tangent_1, tangent_2],
        }
    }

    /// The point at `s`, from 0 to 1.
    fn at(&self, s: f32) -> Vec3 {
        let ([p1, p2], [tangent_1, tangent_2]) = (self.ends, self.tangents);
        let (s2, s3) = (s * s, s * s * s);
        // The weights of p1 and p2 add up to 1: relative to p1 there is less to round.
        p1 + (p2 - p1) * (3.0 * s2 - 2.0 * s3)
            + tangent_1 * (s3 - 2.0 * s2 + s)
            + tangent_2 * (s3 - s2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    const SPLINE: PathKind = PathKind::CatmullRom { subdivision: 8 };

    /// Barry and Goldman's pyramid: the spline's definition by repeated interpolation.
    fn pyramid(points: [Vec3; 4], s: f64) -> DVec3 {
        let p = points.map(Vec3::as_dvec3);
        let mut t = [0.0; 4];
        for i in 1..4 {
            t[i] = t[i - 1] + p[i].distance(p[i - 1]).sqrt();
        }
        let at = t[1] + (t[2] - t[1]) * s;
        let mix = |a: DVec3, b: DVec3, from: f64, to: f64| a.lerp(b, (at - from) / (to - from));
        let a = [0, 1, 2].map(|i| mix(p[i], p[i + 1], t[i], t[i + 1]));
        let b = [0, 1].map(|i| mix(a[i], a[i + 1], t[i], t[i + 2]));
        mix(b[0], b[1], t[1], t[2])
    }

    #[test]
    fn subdivisions_have_a_range() {
        for bad in [0, 65, u32::MAX] {
            let kind = PathKind::Linear { subdivision: bad };
            assert_eq!(kind.subdivision(), Err(PathError::Subdivision(bad)));
        }
        assert_eq!(SPLINE.subdivision(), Ok(8));
    }

    #[test]
    fn two_particles_make_an_even_line() {
        let particles = [Vec3::ZERO, Vec3::new(0.0, -2.0, 1.0)];
        for s in [0.0, 0.25, 0.5, 0.75] {
            let point = Curve::catmull_rom(&particles, 0).at(s);
            assert!(point.distance(particles[1] * s) < 1e-6);
        }
    }

    #[test]
    fn coinciding_particles_are_the_limit_of_near_ones() {
        let with_gap = |gap: f32| {
            [
                Vec3::ZERO,
                Vec3::Y,
                Vec3::new(gap, 1.0, 0.0),
                Vec3::new(1.0, 1.5, 0.0),
                Vec3::new(1.0, 3.0, 0.0),
            ]
        };
        for interval in 0..4 {
            for s in [0.0, 0.3, 0.9] {
                let near = Curve::catmull_rom(&with_gap(1e-10), interval).at(s);
                let same = Curve::catmull_rom(&with_gap(0.0), interval).at(s);
                assert!(near.distance(same) < 1e-4, "{near} {same}");
            }
        }
    }

    proptest! {
        #[test]
        fn the_spline_is_barry_and_goldmans(
            points in prop::array::uniform4(prop::array::uniform3(-1.0..1.0_f32)),
            s in 0.0..1.0_f32,
        ) {
            let points = points.map(Vec3::from);
            prop_assume!(points.windows(2).all(|p| p[0].distance(p[1]) > 0.01));
            let expected = pyramid(points, f64::from(s)).as_vec3();
            let point = Curve::catmull_rom(&points, 1).at(s);
            prop_assert!(point.distance(expected) < 2e-5, "{point} {expected}");
            let reflected = [2.0 * points[0] - points[1], points[0], points[1], points[2]];
            let expected = pyramid(reflected, f64::from(s)).as_vec3();
            let point = Curve::catmull_rom(&points, 0).at(s);
            prop_assert!(point.distance(expected) < 2e-5, "{point} {expected}");
        }
    }
}
