//! The altitudes of a tetrahedron.

use glam::DVec3;

/// A line between weighted sums of a tetrahedron's corners.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Altitude {
    /// Of the corners; their sum is 0.
    pub weights: [f64; 4],
    /// In m.
    pub length: f64,
    /// A unit vector.
    pub direction: DVec3,
}

/// The altitudes of a tetrahedron: from each corner to the face of the others, and between each pair of opposite edges; where corners are
/// in a line, what has no direction is infinitely long.
pub(super) fn altitudes(corners: &[DVec3]) -> [Altitude; 7] {
    let never = Altitude {
        length: f64::INFINITY,
        ..Altitude::default()
    };
    let mut all = [never; 7];
    for (tip, altitude) in all.iter_mut().enumerate().take(4) {
        let [a, b, c] = [(tip + 1) % 4, (tip + 2) % 4, (tip + 3) % 4];
        let (u, v) = (corners[b] - corners[a], corners[c] - corners[a]);
        let w = corners[tip] - corners[a];
        let normal = u.cross(v);
        let area = normal.length_squared();
        if area > 0.0 {
            // The foot in coordinates of the face.
            let (s, t) = (w.cross(v).dot(normal) / area, u.cross(w).dot(normal) / area);
            let mut weights = [0.0; 4];
            weights[tip] = 1.0;
            weights[a] = s + t - 1.0;
            weights[b] = -s;
            weights[c] = -t;
            *altitude = line(weights, corners);
        }
    }
    for (altitude, [a, b, c, d]) in
        all[4..]
            .iter_mut()
            .zip([[0, 1, 2, 3], [0, 2, 1, 3], [0, 3, 1, 2]])
    {
        let (u, v, w) = (
            corners[b] - corners[a],
            corners[d] - corners[c],
            corners[c] - corners[a],
        );
        let normal = u.cross(v);
        let area = normal.length_squared();
        if area > 0.0 {
            let (s, t) = (w.cross(v).dot(normal) / area, w.cross(u).dot(normal) / area);
            let mut weights = [0.0; 4];
            weights[a] = s - 1.0;
            weights[b] = -s;
            weights[c] = 1.0 - t;
            weights[d] = t;
            *altitude = line(weights, corners);
        }
    }
    all
}

fn line(weights: [f64; 4], corners: &[DVec3]) -> Altitude {
    let way: DVec3 = weights.iter().zip(corners).map(|(w, c)| *c * *w).sum();
    let length = way.length();
    if length > 0.0 {
        Altitude {
            weights,
            length,
            direction: way / length,
        }
    } else {
        Altitude {
            length: f64::INFINITY,
            ..Altitude::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn altitudes_of_a_known_tetrahedron() {
        let corners = [DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 4.0, DVec3::Z * 5.0];
        let all = altitudes(&corners);
        // Of the corner at the origin: 1 / sqrt(1/9 + 1/16 + 1/25).
        let expected = 1.0 / (1.0 / 9.0 + 1.0 / 16.0 + 1.0 / 25.0_f64).sqrt();
        assert!((all[0].length - expected).abs() < 1e-12);
        assert!((all[1].length - 3.0).abs() < 1e-12);
        assert!((all[3].length - 5.0).abs() < 1e-12);
        // Of the edge along X and the one from Y to Z: 4 x 5 / sqrt(41).
        assert!((all[4].length - 20.0 / 41.0_f64.sqrt()).abs() < 1e-12);
        for altitude in all {
            assert!(altitude.weights.iter().sum::<f64>().abs() < 1e-12);
        }
    }
}
