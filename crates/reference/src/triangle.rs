//! One triangle of a surface.

use crate::texture::Texture;
use glam::{DVec2, DVec3};
use render::{Surface, SurfaceVertex};
use std::sync::Arc;

/// A triangle in two tones, seen from both sides, its edges included.
#[derive(Clone, Debug)]
pub struct Triangle {
    /// A picture, and the corners' places there.
    texture: Option<(Arc<Texture>, [DVec2; 3])>,
    corners: [Corner; 3],
    margin_m: f64,
    light: [f64; 3],
    shadow: [f64; 3],
    /// [`Surface::mesh`].
    pub mesh: u32,
    /// [`Surface::marks`].
    pub marks: u32,
}

#[derive(Clone, Copy, Debug)]
struct Corner {
    position: DVec2,
    inv_depth: f64,
    tone: f64,
}

impl From<SurfaceVertex> for Corner {
    fn from(vertex: SurfaceVertex) -> Self {
        Self {
            position: vertex.position.as_dvec2(),
            inv_depth: vertex.inv_depth.into(),
            tone: vertex.tone.into(),
        }
    }
}

/// What a triangle shows at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// 1 / view depth (1/m).
    pub inv_depth: f64,
    /// How much nearer a stroke must be (m); 0 where its biased depth counts.
    pub margin_m: f64,
    /// Linear.
    pub color: [f64; 3],
    /// The same in shadow.
    pub shadow: [f64; 3],
}

impl Triangle {
    /// The triangles of a surface, in its order.
    pub fn of(surface: &Surface) -> impl Iterator<Item = Self> + use<'_> {
        let texture = surface.texture.as_ref();
        let texture = texture.map(|texture| (Arc::new(Texture::from(texture)), &texture.places));
        surface.triangles.iter().map(move |corners| Self {
            texture: texture.as_ref().map(|(texture, places)| {
                let places = corners.map(|index| places[index as usize].as_dvec2());
                (texture.clone(), places)
            }),
            corners: corners.map(|index| surface.vertices[index as usize].into()),
            margin_m: surface.margin_m.into(),
            light: surface.light.map(f64::from),
            shadow: surface.shadow.map(f64::from),
            mesh: surface.mesh,
            marks: surface.marks,
        })
    }

    /// The unit normal towards the eye, in view space (right, up, depth), of a picture with its middle there and an eye so many pixels
    /// before it.
    pub fn normal(&self, middle: DVec2, focal_px: f64) -> DVec3 {
        let [a, b, c] = self.corners.map(|corner| {
            let seen = (corner.position - middle) / focal_px;
            DVec3::new(seen.x, -seen.y, 1.0) / corner.inv_depth
        });
        let normal = (b - a).cross(c - a).normalize_or_zero();
        -normal * normal.dot(a).signum()
    }

    /// Whether the triangle may touch the box from `min` to `max`.
    pub fn touches(&self, min: DVec2, max: DVec2) -> bool {
        let [a, b, c] = self.corners.map(|corner| corner.position);
        a.min(b).min(c).cmple(max).all() && a.max(b).max(c).cmpge(min).all()
    }

    /// What is seen of it at `point`, or nothing outside the triangle.
    pub fn hit(&self, point: DVec2) -> Option<Hit> {
        let [a, b, c] = self.corners.map(|corner| corner.position);
        let area = (b - a).perp_dot(c - a);
        // Twice the signed area opposite each corner, over the triangle's own: barycentric weights.
        let weights =
            [(b, c), (c, a), (a, b)].map(|(from, to)| (from - point).perp_dot(to - point) / area);
        if area == 0.0 || !weights.iter().all(|weight| *weight >= 0.0) {
            return None;
        }
        let interpolate = |value: fn(&Corner) -> f64| -> f64 {
            let terms = self.corners.iter().zip(weights);
            terms.map(|(corner, weight)| weight * value(corner)).sum()
        };
        let lit = interpolate(|corner| corner.tone) >= 0.0;
        let mut shadow = self.shadow;
        let mut color = if lit { self.light } else { shadow };
        let inv_depth = interpolate(|corner| corner.inv_depth);
        if let Some((texture, places)) = &self.texture {
            // Places run linearly in the world.
            let corners = self.corners.iter().zip(weights).zip(places);
            let sum = corners.map(|((corner, weight), place)| weight * corner.inv_depth * *place);
            let [red, green, blue, alpha] = texture.at(sum.sum::<DVec2>() / inv_depth);
            if alpha < texture.cut {
                return None;
            }
            for tone in [&mut color, &mut shadow] {
                for (channel, texel) in tone.iter_mut().zip([red, green, blue]) {
                    *channel *= texel;
                }
            }
        }
        Some(Hit {
            inv_depth,
            margin_m: self.margin_m,
            color,
            shadow,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    const LIGHT: [f64; 3] = [1.0, 0.5, 0.25];
    const SHADOW: [f64; 3] = [0.0, 0.125, 0.0];

    /// (0, 0), (8, 0), (0, 8), with inverse depths 1, 2, 3 and tones -1, 1, 1.
    fn triangle(order: [u32; 3]) -> Triangle {
        let vertex = |x, y, inv_depth, tone| SurfaceVertex {
            position: Vec2::new(x, y),
            inv_depth,
            tone,
        };
        let surface = Surface {
            texture: None,
            margin_m: 0.0,
            mesh: 0,
            paint: None,
            marks: 0,
            vertices: vec![
                vertex(0.0, 0.0, 1.0, -1.0),
                vertex(8.0, 0.0, 2.0, 1.0),
                vertex(0.0, 8.0, 3.0, 1.0),
            ],
            triangles: vec![order],
            light: LIGHT.map(|v| v as f32),
            shadow: SHADOW.map(|v| v as f32),
        };
        Triangle::of(&surface).next().unwrap()
    }

    #[test]
    fn seen_from_both_sides_with_linear_depth() {
        for order in [[0, 1, 2], [0, 2, 1]] {
            let Hit {
                inv_depth, color, ..
            } = triangle(order).hit(DVec2::new(4.0, 2.0)).unwrap();
            assert!((inv_depth - 2.0).abs() < 1e-12);
            assert_eq!(color, LIGHT);
            assert!(triangle(order).hit(DVec2::new(5.0, 5.0)).is_none());
        }
    }

    #[test]
    fn tone_changes_at_zero_which_is_lit() {
        let triangle = triangle([0, 1, 2]);
        assert_eq!(triangle.hit(DVec2::new(1.9, 2.0)).unwrap().color, SHADOW);
        assert_eq!(triangle.hit(DVec2::new(2.0, 2.0)).unwrap().color, LIGHT);
    }

    #[test]
    fn edges_and_corners_belong_to_it() {
        for point in [
            [0.0, 0.0],
            [8.0, 0.0],
            [0.0, 8.0],
            [4.0, 4.0],
            [4.0, 0.0],
            [0.0, 4.0],
        ] {
            assert!(triangle([0, 1, 2]).hit(point.into()).is_some(), "{point:?}");
        }
    }

    #[test]
    fn no_area_covers_nothing() {
        assert!(triangle([0, 1, 1]).hit(DVec2::new(4.0, 0.0)).is_none());
        assert!(triangle([1, 1, 1]).hit(DVec2::new(8.0, 0.0)).is_none());
    }
}
