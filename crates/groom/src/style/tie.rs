//! Bands that hold gathered hair.

use crate::trig::sin_cos_turns;
use glam::Vec3;

/// Corners around the band, and around its section.
const AROUND: u32 = 32;
const SECTION: u32 = 12;
/// Half the thickness of the band, in its radii.
const THICKNESS: f32 = 0.42;

/// A band around gathered hair: a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tie {
    /// Its middle, metres.
    pub center: Vec3,
    /// The way of the hair through it, a unit vector.
    pub axis: Vec3,
    /// Radius of the hair in it, metres.
    pub radius_m: f32,
}

/// A ring as a mesh: positions in metres, unit normals, triangles that face outwards.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ring {
    /// Corners, metres.
    pub positions: Vec<Vec3>,
    /// A unit normal for each corner.
    pub normals: Vec<Vec3>,
    /// Indices of corners.
    pub triangles: Vec<[u32; 3]>,
}

impl Tie {
    /// The band's surface, closed.
    #[must_use]
    pub fn ring(&self) -> Ring {
        let u = self.axis.any_orthonormal_vector();
        let v = self.axis.cross(u);
        let thickness_m = THICKNESS * self.radius_m;
        let mut ring = Ring::default();
        for around in 0..AROUND {
            let (sin, cos) = sin_cos_turns(around as f32 / AROUND as f32);
            let outwards = u * cos + v * sin;
            for section in 0..SECTION {
                let (sin, cos) = sin_cos_turns(section as f32 / SECTION as f32);
                let normal = outwards * cos + self.axis * sin;
                ring.normals.push(normal);
                ring.positions
                    .push(self.center + outwards * self.radius_m + normal * thickness_m);
                let corner = |i: u32, j: u32| (i % AROUND) * SECTION + j % SECTION;
                let (a, b) = (corner(around, section), corner(around + 1, section));
                let (c, d) = (corner(around, section + 1), corner(around + 1, section + 1));
                ring.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
        ring
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_is_closed_and_faces_outwards() {
        let tie = Tie {
            center: Vec3::new(0.1, 1.5, -0.1),
            axis: Vec3::new(0.6, 0.0, -0.8),
            radius_m: 0.01,
        };
        let ring = tie.ring();
        let mut volume = 0.0;
        for triangle in &ring.triangles {
            let [a, b, c] = triangle.map(|i| (ring.positions[i as usize] - tie.center).as_dvec3());
            volume += a.dot(b.cross(c)) / 6.0;
            let face = (b - a).cross(c - a).normalize().as_vec3();
            let normal: Vec3 = triangle.iter().map(|i| ring.normals[*i as usize]).sum();
            assert!(face.dot(normal.normalize()) > 0.9);
        }
        // 2 pi^2 R r^2, a little less since it has corners.
        let radius = f64::from(tie.radius_m);
        let exact = 2.0 * std::f64::consts::PI.powi(2) * radius.powi(3) * 0.42 * 0.42;
        assert!(
            (0.93..1.0).contains(&(volume / exact)),
            "{}",
            volume / exact
        );
        for p in &ring.positions {
            let way = *p - tie.center;
            assert!(way.dot(tie.axis).abs() <= 0.42 * tie.radius_m + 1e-6);
        }
    }
}
