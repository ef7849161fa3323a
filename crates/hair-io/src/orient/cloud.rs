//! What a groom's roots and strands tell of its axes and unit.

use glam::{DVec3, Vec3};
use hair_sim::Strands;

use super::unit::scale_to;
use crate::head::bounds;
use crate::sphere::{self, Sphere, without_outliers};

/// The radius of a scalp, in metres.
const SCALP_RADIUS: f64 = 0.095;
/// Roots that are looked at; more do not make a guess better.
const SAMPLED: usize = 400;

/// The roots of a groom, in the file's coordinates.
pub(super) struct Cloud {
    pub roots: Vec<Vec3>,
    pub sphere: Option<Sphere>,
    /// The middle of the box of the roots, without outliers.
    pub middle: DVec3,
    /// The box's longest side.
    pub extent: f64,
    /// Whether the roots cover a scalp, not a parting, a mohawk or a fringe.
    pub is_scalp: bool,
}

impl Cloud {
    pub fn new(strands: &Strands) -> Self {
        let step = strands.len().div_ceil(SAMPLED).max(1);
        let roots: Vec<Vec3> = strands.roots().step_by(step).collect();
        let points: Vec<DVec3> = roots.iter().map(|r| r.as_dvec3()).collect();
        let (low, high) = bounds(without_outliers(&points).iter()).unwrap_or_default();
        let size = high - low;
        let sphere = sphere::fit(&roots);
        let extent = size.max_element();
        Self {
            sphere,
            middle: (low + high) * 0.5,
            extent,
            is_scalp: size.min_element() > 0.45 * extent,
            roots,
        }
    }

    /// Above 0 for Y up, below for Z up, within -1 to 1.
    pub fn likes_y(&self, strands: &Strands) -> f64 {
        let step = strands.len().div_ceil(SAMPLED).max(1);
        let spans = strands
            .iter()
            .step_by(step)
            .map(|points| points[points.len() - 1].as_dvec3() - points[0].as_dvec3());
        let (sum, lengths) = spans.fold((DVec3::ZERO, 0.0), |(sum, lengths), s| {
            (sum + s, lengths + s.length())
        });
        let hang = sum / lengths.max(f64::MIN_POSITIVE);

        let mut up = -hang;
        if let Some(sphere) = self.sphere.filter(|_| self.is_scalp) {
            let mean = self.roots.iter().map(|r| r.as_dvec3()).sum::<DVec3>();
            up += (mean / self.roots.len() as f64 - sphere.center) / sphere.radius;
        }
        // Seen from between the feet.
        up += self.middle / self.middle.length().max(self.extent).max(f64::MIN_POSITIVE);
        // 0.3: files of this kind are Y up more often.
        (up.y - up.z + 0.3).clamp(-1.0, 1.0)
    }

    /// Metres a unit, by the size of the roots alone.
    pub fn scale(&self) -> f32 {
        match self.sphere {
            Some(sphere) if self.is_scalp => scale_to(sphere.radius, SCALP_RADIUS, 1.0),
            // Part of a scalp, or more than that: the size says less.
            _ => scale_to(self.extent * 0.5, SCALP_RADIUS, 0.3),
        }
    }
}
