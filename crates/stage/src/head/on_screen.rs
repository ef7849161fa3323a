//! Triangles of a mesh on the screen: those that face the eye and those that don't, cut at the near plane.

use crate::painted::MeshPicture;
use glam::{Vec2, Vec3};
use render::{Surface, SurfacePaint, SurfaceTexture, SurfaceVertex};
use stroke_path::Camera;

/// A corner before it is projected: in view space, with its tone.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub(super) view: Vec3,
    pub(super) tone: f32,
}

/// Some triangles of a mesh, and what they are painted as where they face the eye, and where they face away; nothing leaves them out.
pub(super) struct Part<'a> {
    pub(super) triangles: &'a [[u32; 3]],
    /// Of the whole mesh.
    pub(super) corners: &'a [Corner],
    pub(super) front: Option<Side>,
    pub(super) back: Option<Side>,
    /// As [`Surface`] has it.
    pub(super) mesh: u32,
    /// The picture on it, and each corner's place there.
    pub(super) picture: Option<(&'a MeshPicture, &'a [Vec2])>,
    /// Of each corner, for sides that a layer paints: its unit normal, and how much it lies in shadow whatever the light, nothing where
    /// none does.
    pub(super) normals: &'a [Vec3],
    pub(super) occlusion: &'a [f32],
}

/// What one side of a part is painted as; as [`Surface`] has them.
#[derive(Clone, Copy)]
pub(super) struct Side {
    pub(super) light: [f32; 3],
    pub(super) shadow: [f32; 3],
    pub(super) margin_m: f32,
    /// The layer that paints it, by its place among the frame's.
    pub(super) layer: Option<u32>,
}

impl Side {
    /// Of one colour, whatever the light.
    pub(super) fn flat(color: [f32; 3], margin_m: f32) -> Self {
        Self {
            light: color,
            shadow: color,
            margin_m,
            layer: None,
        }
    }
}

/// What a corner has beside its place and tone.
#[derive(Clone, Copy)]
pub(super) struct Extra {
    place: Vec2,
    normal: Vec3,
    occlusion: f32,
}

impl Extra {
    fn lerp(&self, other: &Self, t: f32) -> Self {
        Self {
            place: self.place.lerp(other.place, t),
            normal: self.normal.lerp(other.normal, t),
            occlusion: self.occlusion + (other.occlusion - self.occlusion) * t,
        }
    }
}

impl Part<'_> {
    /// Its triangles on the screen, cut at the near plane: a surface for each side that is painted, the front first.
    pub(super) fn seen_by(&self, camera: &Camera) -> impl Iterator<Item = Surface> + use<> {
        let near = camera.near_m();
        let on =
            |side: &Option<Side>, facing: f32| side.map(|side| OnScreen::new(side, facing, self));
        let (mut front, mut back) = (on(&self.front, 1.0), on(&self.back, -1.0));
        for triangle in self.triangles {
            let seen = triangle.map(|i| self.corners[i as usize]);
            let side = if is_front(&seen) {
                &mut front
            } else {
                &mut back
            };
            let Some(side) = side else {
                continue;
            };
            if seen.iter().all(|corner| corner.view.z >= near) {
                side.push(*triangle, &seen, self, camera);
            } else {
                let extras = triangle.map(|i| self.extra(i as usize));
                side.push_polygon(&cut(&seen, &extras, near), camera);
            }
        }
        front.into_iter().chain(back).map(OnScreen::finish)
    }

    /// What a corner has.
    #[inline]
    fn extra(&self, corner: usize) -> Extra {
        Extra {
            place: self
                .picture
                .map_or(Vec2::ZERO, |(_, places)| places[corner]),
            normal: self.normals.get(corner).copied().unwrap_or_default(),
            occlusion: self.occlusion.get(corner).copied().unwrap_or(0.0),
        }
    }
}

/// A side of a part on the screen, in the making.
struct OnScreen {
    surface: Surface,
    /// For each corner of the mesh its vertex: only those that are seen are projected.
    entered: Vec<u32>,
    /// What normals are multiplied by, so that they face the side that is seen.
    facing: f32,
}

impl OnScreen {
    fn new(side: Side, facing: f32, part: &Part) -> Self {
        Self {
            facing,
            surface: Surface {
                texture: part.picture.map(|(picture, _)| SurfaceTexture {
                    image: picture.image.clone(),
                    repeats: picture.repeats,
                    places: Vec::new(),
                    coverage: picture.coverage,
                }),
                vertices: Vec::new(),
                triangles: Vec::new(),
                margin_m: side.margin_m,
                mesh: part.mesh,
                light: side.light,
                shadow: side.shadow,
                paint: side.layer.map(|layer| SurfacePaint {
                    layer,
                    normals: Vec::new(),
                    occlusion: Vec::new(),
                }),
            },
            entered: vec![u32::MAX; part.corners.len()],
        }
    }

    /// Adds a triangle of the mesh, whose corners those are.
    #[inline]
    fn push(&mut self, mut triangle: [u32; 3], seen: &[Corner; 3], part: &Part, camera: &Camera) {
        let has_extra = self.surface.texture.is_some() | self.surface.paint.is_some();
        for (index, corner) in triangle.iter_mut().zip(seen) {
            let entered = self.entered[*index as usize];
            *index = if entered == u32::MAX {
                let new = self.surface.vertices.len() as u32;
                self.entered[*index as usize] = new;
                self.surface.vertices.push(corner.project(camera));
                if has_extra {
                    self.push_extra(&part.extra(*index as usize));
                }
                new
            } else {
                entered
            };
        }
        self.surface.triangles.push(triangle);
    }

    /// Adds what the last vertex has beside its place and tone.
    fn push_extra(&mut self, extra: &Extra) {
        if let Some(texture) = &mut self.surface.texture {
            texture.places.push(extra.place);
        }
        if let Some(paint) = &mut self.surface.paint {
            paint.normals.push(self.facing * extra.normal);
            paint.occlusion.push(extra.occlusion);
        }
    }

    /// Adds what is left of a triangle that was cut.
    fn push_polygon(&mut self, corners: &[(Corner, Extra)], camera: &Camera) {
        let first = self.surface.vertices.len() as u32;
        for (corner, extra) in corners {
            self.surface.vertices.push(corner.project(camera));
            self.push_extra(extra);
        }
        let others = first + 1..self.surface.vertices.len() as u32;
        self.surface.triangles.extend(
            others
                .clone()
                .zip(others.skip(1))
                .map(|(a, b)| [first, a, b]),
        );
    }

    /// Without triangles that no picture can mean.
    fn finish(self) -> Surface {
        let mut surface = self.surface;
        if !surface.vertices.iter().all(is_at_hand) {
            let vertices = &surface.vertices;
            let is_meant = |triangle: &[u32; 3]| {
                let mut corners = triangle.iter().map(|i| &vertices[*i as usize]);
                corners.all(is_at_hand)
            };
            surface.triangles.retain(is_meant);
            // What no triangle uses any more may lie anywhere.
            for vertex in &mut surface.vertices {
                if !is_at_hand(vertex) {
                    vertex.position = Vec2::ZERO;
                }
            }
        }
        surface
    }
}

impl Corner {
    #[inline]
    fn project(&self, camera: &Camera) -> SurfaceVertex {
        let inv_depth = 1.0 / self.view.z;
        SurfaceVertex {
            position: camera.project(self.view),
            inv_depth,
            tone: self.tone * inv_depth,
        }
    }
}

#[inline]
fn is_at_hand(vertex: &SurfaceVertex) -> bool {
    vertex.position.abs().cmple(Vec2::splat(FARTHEST_PX)).all()
}

/// Triangles with a corner farther from the picture's corner are left out, px.
const FARTHEST_PX: f32 = 1e8;

/// Whether the eye, at the origin of view space, is on the triangle's outer side.
#[inline]
fn is_front([a, b, c]: &[Corner; 3]) -> bool {
    // View space is left-handed (z is depth), so outside triangles wind the other way around.
    let normal = (b.view - a.view).cross(c.view - a.view);
    normal.dot(a.view) > 0.0
}

/// The part of a triangle at depth `near` or beyond: three or four corners.
pub(super) fn cut(triangle: &[Corner; 3], extras: &[Extra; 3], near: f32) -> Vec<(Corner, Extra)> {
    let mut kept = Vec::with_capacity(4);
    for i in 0..3 {
        let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
        if a.view.z >= near {
            kept.push((a, extras[i]));
        }
        if (a.view.z >= near) != (b.view.z >= near) {
            let t = (near - a.view.z) / (b.view.z - a.view.z);
            let corner = Corner {
                view: a.view.lerp(b.view, t).with_z(near),
                tone: a.tone + (b.tone - a.tone) * t,
            };
            kept.push((corner, extras[i].lerp(&extras[(i + 1) % 3], t)));
        }
    }
    kept
}
