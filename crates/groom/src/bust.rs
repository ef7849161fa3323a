//! The bust: its skin as a mesh, and what is drawn on it.

use crate::Shell;
use crate::face::{self, Patch};
use crate::figure::{Cloth, above_hairline};
use crate::shape::{distance, jaw_shade, shading_normal};
use crate::surface_nets::{Grid, Net, planes, relax, surface_net, with_image};
use glam::Vec3;
use std::sync::LazyLock;

/// Middle of the head.
pub(crate) const CENTER: Vec3 = Vec3::new(0.0, 1.5, 0.0);

/// From the chin to the top, metres.
pub(crate) const HEIGHT: f32 = 0.24;

/// A head with neck and shoulders, and what is drawn on it.
#[derive(Clone, Debug)]
pub struct Bust {
    /// Positions in metres.
    pub positions: Vec<Vec3>,
    /// Unit normals, one a position. They shade: what is smaller than a nose does not turn them.
    pub normals: Vec<Vec3>,
    /// Which way light takes each position to face, unit vectors, where those aren't the normals; else empty.
    pub facing: Vec<Vec3>,
    /// The outline's width at each position, in parts of its whole width; empty where it is whole all over.
    pub outline: Vec<f32>,
    /// The shadow that the jaw casts on the neck wherever the light is, one a position: 0 is none,
    /// 1 is enough to be dark in full light.
    pub shade: Vec<f32>,
    /// Where hair grows: how far above the hairline of [`crate::Scalp::default`] each position lies, in
    /// degrees of latitude on its [`Shell`]; below 0 is bare skin, as the ears are.
    pub scalp: Vec<f32>,
    /// Indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// What each triangle is painted as; empty where all is skin.
    pub cloth: Vec<Cloth>,
    /// What is drawn on the skin: eyes, brows, nose, mouth, ears, collarbones; later ones over
    /// earlier ones.
    pub patches: Vec<Patch>,
}

/// The bust. It is made once in a program: later calls copy it.
#[must_use]
pub fn bust() -> Bust {
    static BUST: LazyLock<Bust> = LazyLock::new(made);
    BUST.clone()
}

fn made() -> Bust {
    let Net {
        positions,
        triangles,
    } = skin();
    let normals: Vec<Vec3> = positions.iter().map(|p| shading_normal(*p)).collect();
    let shell = Shell::new(&positions, &normals, &triangles, CENTER, HEIGHT);
    Bust {
        normals,
        facing: Vec::new(),
        outline: Vec::new(),
        cloth: Vec::new(),
        shade: positions.iter().map(|p| jaw_shade(*p)).collect(),
        scalp: positions
            .iter()
            .map(|p| above_hairline(&shell, *p))
            .collect(),
        positions,
        triangles,
        patches: face::patches(),
    }
}

/// The skin, in triangles of 3 to 5 mm on face and ears, up to 10 mm elsewhere.
fn skin() -> Net {
    // Finest from `from` to `to`, coarser away from there.
    let near = |from: f32, to: f32| {
        move |at: f32| (0.0047 + 0.12 * (from - at).max(at - to).max(0.0)).min(0.0100)
    };
    let lips = |y: f32| {
        if (1.405..1.445).contains(&y) {
            0.0015
        } else {
            0.0
        }
    };
    let grid = Grid {
        // Half of it: the first cells lie across x = 0.
        x: planes(-0.00235, 0.20, near(-0.01, 0.095)),
        y: planes(1.11, 1.64, |y| near(1.335, 1.52)(y) - lips(y)),
        z: planes(-0.14, 0.12, near(-0.02, 0.11)),
    };
    let mut half = surface_net(distance, &grid);
    relax(&mut half, distance, 6);
    with_image(half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::distance_to_ear;
    use std::collections::HashMap;

    #[test]
    fn the_head_is_as_high_as_it_says_and_faces_forward() {
        let bust = bust();
        let top = bust.positions.iter().map(|p| p.y).fold(f32::MIN, f32::max);
        assert!((top - 1.62).abs() < 0.004, "{top}");
        let chin = (0..200).map(|i| 1.36 + i as f32 * 2e-4);
        let chin = chin
            .into_iter()
            .find(|y| distance(Vec3::new(0.0, *y, 0.062)) < 0.0)
            .unwrap();
        assert!((chin - 1.38).abs() < 0.006, "{chin}");
        let nose = bust
            .positions
            .iter()
            .max_by(|a, b| a.z.total_cmp(&b.z))
            .unwrap();
        assert!(
            nose.x.abs() < 0.01 && (1.44..1.47).contains(&nose.y),
            "{nose}"
        );
    }

    fn bits(p: Vec3) -> [u32; 3] {
        (p + 0.0).to_array().map(f32::to_bits) // one zero
    }

    /// For each position the one across x = 0.
    fn images(bust: &Bust) -> Vec<usize> {
        let index: HashMap<_, _> = bust.positions.iter().map(|p| bits(*p)).zip(0..).collect();
        assert_eq!(index.len(), bust.positions.len(), "no position twice");
        let image = |p: &Vec3| index[&bits(p.with_x(-p.x))];
        bust.positions.iter().map(image).collect()
    }

    #[test]
    fn it_is_closed() {
        let mut edges = HashMap::new();
        for [a, b, c] in bust().triangles {
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        for ((a, b), count) in &edges {
            let other = edges.get(&(*b, *a));
            assert_eq!((*count, other), (1, Some(&1)), "each edge has two sides");
        }
    }

    #[test]
    fn both_sides_are_the_same() {
        let bust = bust();
        for (i, image) in images(&bust).into_iter().enumerate() {
            let turned = bust.normals[image] * Vec3::new(-1.0, 1.0, 1.0);
            assert!(
                bust.normals[i].distance(turned) < 1e-3,
                "{}",
                bust.positions[i]
            );
            assert_eq!(bust.shade[i], bust.shade[image]);
            let difference = bust.scalp[i] - bust.scalp[image];
            assert!(
                difference.abs() < 0.5,
                "{}: {difference} degrees",
                bust.positions[i]
            );
        }
    }

    #[test]
    fn normals_are_units_and_agree_with_the_triangles() {
        let bust = bust();
        for normal in &bust.normals {
            assert!((normal.length() - 1.0).abs() < 1e-5, "{normal}");
        }
        let mut corners = 0;
        let mut astray = 0;
        for triangle in &bust.triangles {
            let [a, b, c] = triangle.map(|i| bust.positions[i as usize]);
            let facing = (b - a).cross(c - a).normalize();
            for i in triangle {
                let cosine = facing.dot(bust.normals[*i as usize]);
                assert!(cosine > 0.0, "{a} {b} {c}: {cosine}");
                corners += 1;
                astray += usize::from(cosine < 0.9);
            }
        }
        // At the nose and around the ears, whose details do not shade.
        assert!(astray * 50 < corners, "{astray} of {corners}");
    }

    #[test]
    fn hair_grows_on_the_crown_but_not_on_the_face() {
        let bust = bust();
        let mut hairy = 0;
        for (p, above) in bust.positions.iter().zip(&bust.scalp) {
            let is_hairy = *above >= 0.0;
            hairy += usize::from(is_hairy);
            let is_face = p.z > 0.03 && p.y < 1.56;
            let is_ear = distance_to_ear(*p) < 1e-3;
            if is_face || is_ear || p.y < 1.40 {
                assert!(!is_hairy, "{p}: {above}");
            }
            if p.y > 1.605 || (p.z < -0.06 && p.y > 1.49) {
                assert!(is_hairy, "{p}: {above}");
            }
        }
        assert!(hairy * 8 > bust.positions.len(), "{hairy}");
    }

    /// The triangles' largest z at (x, y), of those that face the front.
    fn front_at(bust: &Bust, at: Vec3) -> f32 {
        let at = at.truncate();
        let mut front = f32::MIN;
        for triangle in &bust.triangles {
            let corners = triangle.map(|i| bust.positions[i as usize]);
            let [a, b, c] = corners.map(|p| p.truncate() - at);
            if (a.length_squared()).max(b.length_squared()) > 0.03 * 0.03 {
                continue;
            }
            let shares = [b.perp_dot(c), c.perp_dot(a), a.perp_dot(b)];
            let area: f32 = shares.iter().sum();
            if area > 0.0 && shares.iter().all(|share| *share >= 0.0) {
                let z = corners.iter().zip(shares).map(|(p, share)| p.z * share);
                front = front.max(z.sum::<f32>() / area);
            }
        }
        front
    }

    #[test]
    fn no_triangle_of_the_skin_hides_what_is_drawn_on_the_face() {
        let bust = bust();
        let mut looked_at = 0;
        for patch in &bust.patches {
            for p in patch.positions.iter().filter(|p| p.z > 0.045).step_by(5) {
                let front = front_at(&bust, *p);
                assert!(
                    p.z > front,
                    "{:?} at {p}: the skin is at {front}",
                    patch.ink
                );
                assert!(p.z < front + 2e-3, "{:?} at {p} floats: {front}", patch.ink);
                looked_at += 1;
            }
        }
        assert!(looked_at > 400, "{looked_at}");
    }
}
