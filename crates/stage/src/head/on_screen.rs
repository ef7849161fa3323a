//! Triangles of a mesh on the screen: those that face the eye and those that don't, cut at the near plane.

use crate::painted::MeshPicture;
use glam::{Vec2, Vec3, Vec3A};
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
    pub(super) marks: u32,
}

impl Side {
    /// Of one colour, whatever the light.
    pub(super) fn flat(color: [f32; 3], margin_m: f32) -> Self {
        Self {
            light: color,
            shadow: color,
            margin_m,
            layer: None,
            marks: 0,
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

/// Numbers of vertices from here on are corners that cuts have made, until it is known how many others there are.
const CUT: u32 = 1 << 31;

impl Part<'_> {
    /// Its triangles on the screen, cut at the near plane: a surface for each side that is painted, the front first.
    pub(super) fn seen_by(&self, camera: &Camera) -> impl Iterator<Item = Surface> + use<> {
        let near = camera.near_m();
        let is_whole = self.corners.iter().all(|corner| corner.view.z >= near);
        let near = (!is_whole).then_some(near);
        let [front, back] = self.by_side();
        let of = |side: &Option<Side>, facing: f32, triangles: Vec<[u32; 3]>| {
            side.map(|side| self.on_screen(&side, facing, triangles, near, camera))
        };
        let (front, back) = (of(&self.front, 1.0, front), of(&self.back, -1.0, back));
        front.into_iter().chain(back)
    }

    /// The triangles whose outer side the eye is on, and those of which it sees the other one: of sides that are painted.
    fn by_side(&self) -> [Vec<[u32; 3]>; 2] {
        let is_painted = [self.front.is_some(), self.back.is_some()];
        let mut sides = is_painted.map(|is_painted| match is_painted {
            // What isn't used isn't touched.
            true => Vec::with_capacity(self.triangles.len()),
            false => Vec::new(),
        });
        for triangle in self.triangles {
            let is_front = is_front(triangle.map(|i| &self.corners[i as usize]));
            let side = usize::from(!is_front);
            if is_painted[side] {
                sides[side].push(*triangle);
            }
        }
        sides
    }

    /// Triangles on the screen as a side is painted, cut at the near plane where any may reach over it; only corners that are seen are
    /// projected. Normals are multiplied by `facing`, so that they face the side that is seen.
    fn on_screen(
        &self,
        side: &Side,
        facing: f32,
        mut triangles: Vec<[u32; 3]>,
        near: Option<f32>,
        camera: &Camera,
    ) -> Surface {
        // Of each corner its vertex, and of each vertex its corner; those that cuts have made come behind them.
        let mut vertex_of = vec![u32::MAX; self.corners.len()];
        let mut seen = Vec::with_capacity(self.corners.len().min(3 * triangles.len()));
        let mut made = Vec::new();
        let mut enter = |triangle: &mut [u32; 3]| {
            for corner in triangle {
                let vertex = &mut vertex_of[*corner as usize];
                if *vertex == u32::MAX {
                    *vertex = seen.len() as u32;
                    seen.push(*corner);
                }
                *corner = *vertex;
            }
        };
        match near {
            None => triangles.iter_mut().for_each(enter),
            Some(near) => {
                let all = std::mem::take(&mut triangles);
                for mut triangle in all {
                    let corners = triangle.map(|i| self.corners[i as usize]);
                    if corners.iter().all(|corner| corner.view.z >= near) {
                        enter(&mut triangle);
                        triangles.push(triangle);
                        continue;
                    }
                    let extras = triangle.map(|i| self.extra(i as usize));
                    let first = CUT + made.len() as u32;
                    made.extend(cut(&corners, &extras, near));
                    let others = first + 1..CUT + made.len() as u32;
                    let fan = others.clone().zip(others.skip(1));
                    triangles.extend(fan.map(|(a, b)| [first, a, b]));
                }
                let behind = |vertex: u32| match vertex.checked_sub(CUT) {
                    Some(made) => seen.len() as u32 + made,
                    None => vertex,
                };
                for triangle in &mut triangles {
                    *triangle = triangle.map(behind);
                }
            }
        }
        // Copies of their own, of which nothing is worked out twice.
        let (camera, corners) = (*camera, self.corners);
        let vertices = seen.iter().map(|i| corners[*i as usize].project(&camera));
        let mut vertices: Vec<SurfaceVertex> = vertices.collect();
        vertices.extend(made.iter().map(|(corner, _)| corner.project(&camera)));
        let extras = || {
            let of_seen = seen.iter().map(|i| self.extra(*i as usize));
            let of_made = made.iter().map(|(_, extra)| *extra);
            of_seen.chain(of_made)
        };
        without_far(Surface {
            texture: self.picture.map(|(picture, _)| SurfaceTexture {
                image: picture.image.clone(),
                repeats: picture.repeats,
                places: extras().map(|extra| extra.place).collect(),
                coverage: picture.coverage,
            }),
            paint: side.layer.map(|layer| SurfacePaint {
                layer,
                normals: extras().map(|extra| facing * extra.normal).collect(),
                occlusion: extras().map(|extra| extra.occlusion).collect(),
            }),
            vertices,
            triangles,
            margin_m: side.margin_m,
            mesh: self.mesh,
            marks: side.marks,
            light: side.light,
            shadow: side.shadow,
        })
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

/// A surface without triangles that no picture can mean.
fn without_far(mut surface: Surface) -> Surface {
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
fn is_front([a, b, c]: [&Corner; 3]) -> bool {
    // View space is left-handed (z is depth), so outside triangles wind the other way around.
    let [a, b, c] = [a, b, c].map(|corner| Vec3A::from(corner.view));
    (b - a).cross(c - a).dot(a) > 0.0
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
