//! The head on the screen: two flat tones and an outline.

use crate::hair::head_of;
use crate::painted::{MeshPicture, PaintedMesh};
use crate::preset::MeshSection;
use crate::scalp;
use glam::{Vec2, Vec3};
use groom::{Bust, Cloth, Figure, Ink, OrnamentMesh, Patch};
use hair_io::{HeadFrame, Mesh};
use rayon::prelude::*;
use render::{Coverage, Head, Light, Surface, SurfaceTexture, SurfaceVertex};
use std::iter::{once, repeat};
use stroke_path::Camera;

/// What is found in the bust's mesh, so that neither dress nor crop changes the size of hair.
const FIGURE_FRAME: Head = Head {
    center: Vec3::new(0.0, 1.4995, -0.0075),
    height_m: 0.241,
};

/// A head's shape, and what is drawn on it.
#[derive(Clone)]
pub struct HeadModel {
    pub(crate) mesh: Mesh,
    /// Which way light takes each position to face; empty where that is its normal.
    pub(crate) facing: Vec<Vec3>,
    /// The outline's width at each position, in parts of its whole width; empty is 1.
    pub(crate) outline: Vec<f32>,
    /// Triangles that are no skin, by what they are painted as; the rest.
    pub(crate) clothes: Vec<(Cloth, Vec<[u32; 3]>)>,
    pub(crate) skin: Vec<[u32; 3]>,
    /// Where the head is, and its height, where that is known and need not be found in the mesh.
    pub(crate) frame: Option<Head>,
    /// Shadow whatever the light, one a position, 0 to 1; empty is none.
    pub(crate) shade: Vec<f32>,
    pub(crate) patches: Vec<Patch>,
    /// Triangles that have hair, and those that have none; both empty where that is not told apart.
    pub(crate) scalp: [Vec<[u32; 3]>; 2],
    /// What the hair on it wears.
    pub(crate) ornaments: Mesh,
    /// Meshes in their own colours, of its file or beside it.
    pub(crate) painted: Vec<PaintedMesh>,
}

impl HeadModel {
    /// The head's middle and height, where `roots` grow on it.
    pub(crate) fn frame(&self, roots: &[Vec3]) -> Head {
        let find = || head_of(HeadFrame::find(Some(&self.mesh), roots));
        self.frame.unwrap_or_else(find)
    }

    /// Tells what of it has hair from what has none.
    pub(crate) fn find_scalp(&mut self, roots: &[Vec3], reach_m: f32) {
        let split = scalp::split(&self.mesh.positions, &self.skin, roots, reach_m);
        let Mesh {
            positions,
            normals,
            triangles,
        } = &mut self.mesh;
        for ([a, b], t) in split.between {
            let [a, b] = [a, b].map(|i| i as usize);
            let way = |ways: &[Vec3]| ways[a].lerp(ways[b], t).normalize_or(ways[a]);
            positions.push(positions[a].lerp(positions[b], t));
            normals.push(way(normals));
            if !self.facing.is_empty() {
                self.facing.push(way(&self.facing));
            }
            for list in [&mut self.shade, &mut self.outline] {
                if !list.is_empty() {
                    list.push(list[a] + (list[b] - list[a]) * t);
                }
            }
        }
        self.skin = split.triangles.concat();
        triangles.clone_from(&self.skin);
        triangles.extend(self.clothes.iter().flat_map(|(_, cloth)| cloth));
        self.scalp = split.triangles;
    }

    /// The same in its own file's colours, if there are any, with other meshes beside it.
    pub(crate) fn painted(mut self, own: Vec<PaintedMesh>, beside: Vec<PaintedMesh>) -> Self {
        self.painted = own;
        self.painted.extend(beside);
        self
    }

    /// Whether its own file's colours are in place of the preset's.
    fn is_painted(&self) -> bool {
        self.painted.iter().any(|mesh| mesh.section.is_none())
    }

    /// Puts ornaments into the hair on it.
    pub(crate) fn add_ornaments(&mut self, ornaments: &[OrnamentMesh]) {
        for ornament in ornaments {
            let first = self.ornaments.positions.len() as u32;
            self.ornaments.positions.extend(&ornament.positions);
            self.ornaments.normals.extend(&ornament.normals);
            let triangles = ornament.triangles.iter().map(|t| t.map(|i| first + i));
            self.ornaments.triangles.extend(triangles);
        }
    }

    /// The bust that comes with inkstrand.
    #[must_use]
    pub fn bust() -> Self {
        groom::bust().into()
    }

    /// A figure. Its skull is the bust's, and hair that fits one fits the other.
    #[must_use]
    pub fn figure(figure: &Figure) -> Self {
        Self {
            frame: Some(FIGURE_FRAME),
            ..figure.build().into()
        }
    }
}

impl From<Bust> for HeadModel {
    fn from(bust: Bust) -> Self {
        let painted = |cloth: Cloth| {
            let all = bust.triangles.iter().zip(&bust.cloth);
            let own = all.filter(|(_, other)| **other == cloth);
            own.map(|(triangle, _)| *triangle).collect()
        };
        let clothes =
            [Cloth::Dress, Cloth::Accent, Cloth::Line].map(|cloth| (cloth, painted(cloth)));
        let skin = match bust.cloth.is_empty() {
            true => bust.triangles.clone(),
            false => painted(Cloth::Skin),
        };
        let clothes = clothes
            .into_iter()
            .filter(|(_, triangles)| !triangles.is_empty());
        Self {
            clothes: clothes.collect(),
            skin,
            facing: bust.facing,
            outline: bust.outline,
            frame: None,
            mesh: Mesh {
                positions: bust.positions,
                normals: bust.normals,
                triangles: bust.triangles,
            },
            shade: bust.shade,
            patches: bust.patches,
            scalp: Default::default(),
            ornaments: no_mesh(),
            painted: Vec::new(),
        }
    }
}

impl From<Mesh> for HeadModel {
    fn from(mesh: Mesh) -> Self {
        Self {
            skin: mesh.triangles.clone(),
            mesh,
            facing: Vec::new(),
            outline: Vec::new(),
            clothes: Vec::new(),
            frame: None,
            shade: Vec::new(),
            patches: Vec::new(),
            scalp: Default::default(),
            ornaments: no_mesh(),
            painted: Vec::new(),
        }
    }
}

fn no_mesh() -> Mesh {
    Mesh {
        positions: Vec::new(),
        normals: Vec::new(),
        triangles: Vec::new(),
    }
}

/// How a head is painted. Colours are linear.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeadPaint {
    pub light: [f32; 3],
    pub shadow: [f32; 3],
    pub line: [f32; 3],
    pub iris: [f32; 3],
    pub iris_shadow: [f32; 3],
    pub iris_light: [f32; 3],
    pub blush: [f32; 3],
    pub mouth: [f32; 3],
    pub dress: [f32; 3],
    pub dress_shadow: [f32; 3],
    pub dress_line: [f32; 3],
    pub accent: [f32; 3],
    pub accent_shadow: [f32; 3],
    pub tie: [f32; 3],
    pub tie_shadow: [f32; 3],
    /// Between clumps of hair.
    pub scalp: [f32; 3],
    /// 1/300 of the head's height, metres.
    pub unit_m: f32,
    /// Width of the outline in metres; 0 is none.
    pub width_m: f32,
    /// How much nearer than the head's inside hair must be to be seen through an opening, metres.
    pub inside_margin_m: f32,
    /// How much farther than the outline hair may be, metres: hair on the skin covers it, hair behind
    /// the head does not.
    pub outline_margin_m: f32,
    /// The cosine to the light at which light turns to shadow.
    pub threshold: f32,
}

impl HeadPaint {
    /// How much darker its shadow is than its light.
    fn shade(&self) -> [f32; 3] {
        [0, 1, 2].map(|i| (self.shadow[i] / self.light[i].max(1e-3)).min(1.0))
    }

    fn of(&self, ink: Ink) -> [f32; 3] {
        match ink {
            Ink::Line => self.line,
            Ink::White => [1.0; 3],
            Ink::Iris => self.iris,
            Ink::IrisShadow => self.iris_shadow,
            Ink::IrisLight => self.iris_light,
            // White in the shadow of the skin around it.
            Ink::WhiteShadow => self.shadow.map(|shadow| 0.45 + 0.55 * shadow),
            Ink::SkinShadow => self.shadow,
            Ink::Blush => self.blush,
            Ink::Mouth => self.mouth,
        }
    }

    /// Light, shadow and outline of what a triangle is painted as.
    fn of_cloth(&self, cloth: Cloth) -> [[f32; 3]; 3] {
        match cloth {
            Cloth::Skin => [self.light, self.shadow, self.line],
            Cloth::Dress => [self.dress, self.dress_shadow, self.dress_line],
            Cloth::Accent => [self.accent, self.accent_shadow, self.dress_line],
            Cloth::Line => [self.dress_line; 3],
        }
    }
}

/// A corner before it is projected: in view space, with its tone.
#[derive(Clone, Copy)]
struct Corner {
    view: Vec3,
    tone: f32,
}

/// What of a head is told apart as a mesh of its own ([`Surface::mesh`]): itself, its clothes, ornaments, then painted meshes.
pub(crate) const MESHES: u32 = 256;
const CLOTHES: u32 = 1;
const ORNAMENTS: u32 = 2;
const PAINTED: u32 = 3;

/// How much nearer than a band hair must be to hide it, metres: next to nothing.
const BAND_MARGIN_M: f32 = 1e-5;

/// What the camera sees of the head: its outside, its inside through openings, its outline, what is drawn
/// on it.
pub(crate) fn surfaces(
    model: &HeadModel,
    paint: &HeadPaint,
    meshes: &[MeshSection],
    camera: &Camera,
    light: &Light,
) -> Vec<Surface> {
    let HeadModel {
        mesh,
        facing,
        outline: _,
        clothes,
        skin,
        frame: _,
        shade,
        patches,
        scalp: [scalp, bare],
        ornaments,
        painted: _,
    } = model;
    let facing = match facing.is_empty() {
        true => &mesh.normals,
        false => facing,
    };
    let shade = shade.iter().copied().chain(repeat(0.0));
    let corners: Vec<Corner> = mesh
        .positions
        .iter()
        .zip(facing)
        .zip(shade)
        .map(|((position, facing), shade)| Corner {
            view: camera.view_from_world(*position),
            tone: facing.dot(light.seen_from(*position).0) - paint.threshold - shade,
        })
        .collect();
    let bare = match scalp.is_empty() {
        true => skin,
        false => bare,
    };
    let hull = match !model.is_painted() && paint.width_m > 0.0 {
        true => hull(
            &mesh.positions,
            &mesh.normals,
            &model.outline,
            paint.width_m,
            camera,
        ),
        false => Vec::new(),
    };
    let inside = Side {
        light: paint.shadow,
        shadow: paint.shadow,
        margin_m: paint.inside_margin_m,
    };
    let part = |triangles, light, shadow, mesh| Part {
        triangles,
        corners: &corners,
        front: Some(Side {
            light,
            shadow,
            margin_m: 0.0,
        }),
        back: Some(inside),
        mesh,
        picture: None,
    };
    let is_flat = !model.is_painted();
    let mut parts = Vec::new();
    if is_flat {
        parts.push(part(bare, paint.light, paint.shadow, 0));
    }
    if is_flat && !scalp.is_empty() {
        parts.push(part(scalp, paint.scalp, paint.scalp, 0));
    }
    for (cloth, triangles) in clothes {
        let [light, shadow, _] = paint.of_cloth(*cloth);
        parts.push(Part {
            back: Some(Side {
                light: shadow,
                shadow,
                ..inside
            }),
            ..part(triangles, light, shadow, CLOTHES)
        });
    }
    if is_flat && paint.width_m > 0.0 {
        let skin = once((Cloth::Skin, skin));
        let clothes = clothes.iter().map(|(cloth, triangles)| (*cloth, triangles));
        for (cloth, triangles) in skin.chain(clothes) {
            let is_skin = cloth == Cloth::Skin;
            let [.., line] = paint.of_cloth(cloth);
            parts.push(Part {
                triangles,
                corners: &hull,
                front: None,
                back: Some(Side {
                    light: line,
                    shadow: line,
                    margin_m: -paint.outline_margin_m,
                }),
                mesh: if is_skin { 0 } else { CLOTHES },
                picture: None,
            });
        }
    }
    let surfaces = parts.par_iter().flat_map_iter(|part| part.seen_by(camera));
    let mut surfaces: Vec<Surface> = surfaces.collect();
    if !ornaments.triangles.is_empty() {
        surfaces.extend(worn(ornaments, paint, camera, light));
    }
    let center = model.frame.map_or(Vec3::ZERO, |head| head.center);
    let is_drawn = |patch: &&Patch| {
        let lit = |away: Vec3| away.dot(light.seen_from(center).0) >= paint.threshold;
        !patch.away_from.is_some_and(lit)
    };
    let painted = model.painted.par_iter().enumerate();
    let painted = painted.flat_map_iter(|(number, mesh)| {
        let number = PAINTED + number as u32;
        painted_mesh(mesh, number.min(MESHES - 1), paint, meshes, camera, light)
    });
    surfaces.par_extend(painted);
    surfaces.extend(patches.iter().filter(is_drawn).flat_map(|patch| {
        let corner = |position: &Vec3| Corner {
            view: camera.view_from_world(*position),
            tone: 0.0,
        };
        let corners: Vec<Corner> = patch.positions.iter().map(corner).collect();
        let color = paint.of(patch.ink);
        let part = Part {
            triangles: &patch.triangles,
            corners: &corners,
            front: Some(Side {
                light: color,
                shadow: color,
                margin_m: 0.0,
            }),
            back: None,
            mesh: 0,
            picture: None,
        };
        part.seen_by(camera)
    }));
    surfaces
}

/// A slightly larger mesh, whose inside is seen around the edges of the mesh itself; `widths` as in [`HeadModel`].
fn hull(
    positions: &[Vec3],
    normals: &[Vec3],
    widths: &[f32],
    width_m: f32,
    camera: &Camera,
) -> Vec<Corner> {
    let widths = widths.iter().copied().chain(repeat(1.0));
    positions
        .iter()
        .zip(normals)
        .zip(widths)
        .map(|((position, normal), width)| Corner {
            view: camera.view_from_world(*position + *normal * (width_m * width)),
            tone: 0.0,
        })
        .collect()
}

/// What is seen of a mesh in its own colours, whose number among the head's meshes that is.
fn painted_mesh(
    mesh: &PaintedMesh,
    number: u32,
    head: &HeadPaint,
    sections: &[MeshSection],
    camera: &Camera,
    light: &Light,
) -> Vec<Surface> {
    let own = &mesh.paint;
    let section = mesh.section.and_then(|index| sections.get(index));
    let times = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|i| a[i] * b[i]);
    // Light, how much darker shadow is, line, and its width.
    let (tint, shade, line, width_m) = match section {
        Some(section) => {
            let width_m = section.width * head.unit_m;
            (section.color, [section.shade; 3], section.line, width_m)
        }
        None => ([1.0; 3], head.shade(), head.line, head.width_m),
    };
    let lit = times(own.color, tint);
    let shadow = own.shade.map_or(times(lit, shade), |own| times(own, tint));
    let corner = |(position, normal): (&Vec3, &Vec3)| Corner {
        view: camera.view_from_world(*position),
        tone: normal.dot(light.seen_from(*position).0) - head.threshold,
    };
    let corners: Vec<Corner> = mesh
        .positions
        .iter()
        .zip(&mesh.normals)
        .map(corner)
        .collect();
    let front = Side {
        light: lit,
        shadow,
        margin_m: 0.0,
    };
    let back = match (own.both_sides, section) {
        (true, _) => Some(front),
        // Seen through openings, as other heads' insides.
        (false, None) => Some(Side {
            light: shadow,
            shadow,
            margin_m: head.inside_margin_m,
        }),
        (false, Some(_)) => None,
    };
    let part = Part {
        triangles: &mesh.triangles,
        corners: &corners,
        front: Some(front),
        back,
        mesh: number,
        picture: own
            .picture
            .as_ref()
            .map(|picture| (picture, &mesh.places[..])),
    };
    let mut surfaces: Vec<Surface> = part.seen_by(camera).collect();
    if width_m > 0.0 && own.has_outline() {
        let outline = Part {
            corners: &hull(&mesh.positions, &mesh.normals, &[], width_m, camera),
            front: None,
            back: Some(Side {
                light: line,
                shadow: line,
                margin_m: -head.outline_margin_m,
            }),
            picture: part
                .picture
                .filter(|(picture, _)| picture.coverage != Coverage::Ignored),
            ..part
        };
        surfaces.extend(outline.seen_by(camera));
    }
    surfaces
}

/// What the hair wears. Hair goes by its depth alone here: what is in a band does not hide it.
fn worn(ornaments: &Mesh, paint: &HeadPaint, camera: &Camera, light: &Light) -> Vec<Surface> {
    let corners: Vec<Corner> = ornaments
        .positions
        .iter()
        .zip(&ornaments.normals)
        .map(|(position, normal)| Corner {
            view: camera.view_from_world(*position),
            tone: normal.dot(light.seen_from(*position).0) - paint.threshold,
        })
        .collect();
    let ties = Part {
        triangles: &ornaments.triangles,
        corners: &corners,
        front: Some(Side {
            light: paint.tie,
            shadow: paint.tie_shadow,
            margin_m: BAND_MARGIN_M,
        }),
        back: None,
        mesh: ORNAMENTS,
        picture: None,
    };
    let mut worn: Vec<Surface> = ties.seen_by(camera).collect();
    if paint.width_m > 0.0 {
        let outline = Part {
            corners: &hull(
                &ornaments.positions,
                &ornaments.normals,
                &[],
                paint.width_m,
                camera,
            ),
            front: None,
            back: Some(Side {
                light: paint.line,
                shadow: paint.line,
                margin_m: BAND_MARGIN_M,
            }),
            ..ties
        };
        worn.extend(outline.seen_by(camera));
    }
    worn
}

/// Some triangles of a mesh, and what they are painted as where they face the eye, and where they face away; nothing leaves them out.
struct Part<'a> {
    triangles: &'a [[u32; 3]],
    /// Of the whole mesh.
    corners: &'a [Corner],
    front: Option<Side>,
    back: Option<Side>,
    /// As [`Surface`] has it.
    mesh: u32,
    /// The picture on it, and each corner's place there.
    picture: Option<(&'a MeshPicture, &'a [Vec2])>,
}

/// What one side of a part is painted as; as [`Surface`] has them.
#[derive(Clone, Copy)]
struct Side {
    light: [f32; 3],
    shadow: [f32; 3],
    margin_m: f32,
}

impl Part<'_> {
    /// Its triangles on the screen, cut at the near plane: a surface for each side that is painted, the front first.
    fn seen_by(&self, camera: &Camera) -> impl Iterator<Item = Surface> + use<> {
        let near = camera.near_m();
        let places = self.picture.map_or(&[][..], |(_, places)| places);
        let on = |side: &Option<Side>| side.map(|side| OnScreen::new(side, self));
        let (mut front, mut back) = (on(&self.front), on(&self.back));
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
                side.push(*triangle, &seen, places, camera);
            } else {
                let places = match places {
                    [] => [Vec2::ZERO; 3],
                    places => triangle.map(|i| places[i as usize]),
                };
                side.push_polygon(&cut(&seen, &places, near), camera);
            }
        }
        front.into_iter().chain(back).map(OnScreen::finish)
    }
}

/// A side of a part on the screen, in the making.
struct OnScreen {
    surface: Surface,
    /// For each corner of the mesh its vertex: only those that are seen are projected.
    entered: Vec<u32>,
}

impl OnScreen {
    fn new(side: Side, part: &Part) -> Self {
        Self {
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
            },
            entered: vec![u32::MAX; part.corners.len()],
        }
    }

    /// Adds a triangle of the mesh, whose corners those are.
    #[inline]
    fn push(
        &mut self,
        mut triangle: [u32; 3],
        seen: &[Corner; 3],
        places: &[Vec2],
        camera: &Camera,
    ) {
        let Surface {
            vertices, texture, ..
        } = &mut self.surface;
        for (index, corner) in triangle.iter_mut().zip(seen) {
            let entered = &mut self.entered[*index as usize];
            if *entered == u32::MAX {
                *entered = vertices.len() as u32;
                vertices.push(corner.project(camera));
                if let Some(texture) = texture {
                    texture.places.push(places[*index as usize]);
                }
            }
            *index = *entered;
        }
        self.surface.triangles.push(triangle);
    }

    /// Adds what is left of a triangle that was cut.
    fn push_polygon(&mut self, corners: &[(Corner, Vec2)], camera: &Camera) {
        let Surface {
            vertices,
            triangles,
            texture,
            ..
        } = &mut self.surface;
        let first = vertices.len() as u32;
        vertices.extend(corners.iter().map(|(corner, _)| corner.project(camera)));
        if let Some(texture) = texture {
            texture
                .places
                .extend(corners.iter().map(|(_, place)| *place));
        }
        let others = first + 1..vertices.len() as u32;
        triangles.extend(
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

/// The part of a triangle at depth `near` or beyond: three or four corners with their places in the picture.
fn cut(triangle: &[Corner; 3], places: &[Vec2; 3], near: f32) -> Vec<(Corner, Vec2)> {
    let mut kept = Vec::with_capacity(4);
    for i in 0..3 {
        let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
        if a.view.z >= near {
            kept.push((a, places[i]));
        }
        if (a.view.z >= near) != (b.view.z >= near) {
            let t = (near - a.view.z) / (b.view.z - a.view.z);
            let corner = Corner {
                view: a.view.lerp(b.view, t).with_z(near),
                tone: a.tone + (b.tone - a.tone) * t,
            };
            kept.push((corner, places[i].lerp(places[(i + 1) % 3], t)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use stroke_path::OrbitView;

    fn camera(yaw_degrees: f32) -> Camera {
        let view = OrbitView {
            target: Vec3::ZERO,
            yaw_degrees,
            pitch_degrees: 0.0,
            distance_m: 2.0,
            vertical_fov_degrees: 30.0,
        };
        Camera::orbit(view, [100, 100], 0.01).unwrap()
    }

    /// One triangle that faces +Z, counter-clockwise from there.
    fn plate() -> Mesh {
        Mesh {
            positions: vec![
                Vec3::new(-1.0, -1.0, 0.0),
                Vec3::new(1.0, -1.0, 0.0),
                Vec3::Y,
            ],
            normals: vec![Vec3::Z; 3],
            triangles: vec![[0, 1, 2]],
        }
    }

    const PAINT: HeadPaint = HeadPaint {
        unit_m: 0.001,
        light: [1.0; 3],
        shadow: [0.5; 3],
        line: [0.0; 3],
        iris: [0.2; 3],
        iris_shadow: [0.1; 3],
        iris_light: [0.3; 3],
        blush: [0.9; 3],
        mouth: [0.3; 3],
        dress: [0.8; 3],
        dress_shadow: [0.6; 3],
        dress_line: [0.05; 3],
        accent: [0.7; 3],
        accent_shadow: [0.3; 3],
        tie: [0.2, 0.4, 0.6],
        tie_shadow: [0.1, 0.2, 0.3],
        scalp: [0.4, 0.2, 0.1],
        width_m: 0.01,
        inside_margin_m: 0.05,
        outline_margin_m: 0.01,
        threshold: 0.1,
    };

    #[test]
    fn the_outside_is_lit_and_the_inside_is_in_shadow() {
        let light = Light::Direction(Vec3::Z);
        let front = surfaces(&plate().into(), &PAINT, &[], &camera(0.0), &light);
        assert_eq!(front[0].triangles.len(), 1);
        assert_eq!(front[1].triangles.len(), 0);
        assert_eq!(
            front[2].triangles.len(),
            0,
            "the hull shows its inside only"
        );
        assert!(front[0].vertices.iter().all(|v| v.tone > 0.0));

        let behind = surfaces(&plate().into(), &PAINT, &[], &camera(180.0), &light);
        assert_eq!(behind[0].triangles.len(), 0);
        assert_eq!(behind[1].triangles.len(), 1);
        assert_eq!(behind[1].light, PAINT.shadow);
        assert_eq!(behind[2].triangles.len(), 1);
    }

    #[test]
    fn shade_is_dark_in_full_light() {
        let mut model = HeadModel::from(plate());
        model.shade = vec![0.0, 0.0, 1.0];
        let seen = surfaces(
            &model,
            &PAINT,
            &[],
            &camera(0.0),
            &Light::Direction(Vec3::Z),
        );
        let tones = seen[0].vertices.iter().map(|vertex| vertex.tone > 0.0);
        assert_eq!(tones.collect::<Vec<_>>(), [true, true, false]);
    }

    #[test]
    fn hair_is_of_one_size_on_the_bust_and_on_figures() {
        let found = HeadModel::bust().frame(&[]);
        let figure = HeadModel::figure(&Figure::default()).frame(&[]);
        assert!(
            found.center.distance(figure.center) < 1e-3,
            "{found:?} {figure:?}"
        );
        assert!((found.height_m - figure.height_m).abs() < 1e-3);
    }

    #[test]
    fn clothes_have_colours_of_their_own() {
        let sailor = HeadModel::figure(&Figure {
            dress: groom::Dress::Sailor,
            ..Figure::default()
        });
        let seen = surfaces(
            &sailor,
            &PAINT,
            &[],
            &bust_camera(),
            &Light::Direction(Vec3::Z),
        );
        let drawn = |color: [f32; 3]| -> usize {
            let own = seen.iter().filter(|surface| surface.light == color);
            own.map(|surface| surface.triangles.len()).sum()
        };
        assert!(drawn(PAINT.dress) > 500 && drawn(PAINT.accent) > 100);
        assert!(drawn(PAINT.light) > 1000 && drawn(PAINT.dress_line) > 100);
        let all: usize = sailor.clothes.iter().map(|(_, own)| own.len()).sum();
        assert_eq!(all + sailor.skin.len(), sailor.mesh.triangles.len());
        // Lines end at the cut.
        let low = sailor.mesh.positions.iter().zip(&sailor.outline);
        let (at_the_cut, above): (Vec<_>, Vec<_>) = low.partition(|(p, _)| p.y < 1.1301);
        assert!(at_the_cut.len() > 50 && at_the_cut.iter().all(|(_, width)| **width < 0.01));
        assert!(above.iter().all(|(p, width)| p.y < 1.19 || **width == 1.0));
    }

    #[test]
    fn the_side_of_the_nose_is_dark_where_light_is_away() {
        let figure = HeadModel::figure(&Figure::default());
        let dark = |light: Vec3| {
            let light = Light::Direction(light.normalize());
            let seen = surfaces(&figure, &PAINT, &[], &bust_camera(), &light);
            // Patches are flat in one tone; the skin has two.
            let flat = |surface: &&Surface| surface.light == surface.shadow;
            let own = seen.iter().filter(|surface| surface.light == PAINT.shadow);
            own.filter(flat)
                .filter(|surface| surface.triangles.len() < 1000 && !surface.triangles.is_empty())
                .count()
        };
        assert_eq!(dark(Vec3::new(0.0, 0.0, 1.0)), 0);
        assert_eq!(dark(Vec3::new(1.0, 0.0, 1.0)), 1, "the other side");
        assert_eq!(dark(Vec3::new(-1.0, 0.0, 1.0)), 1);
        assert_eq!(dark(Vec3::new(0.0, 1.2, 1.0)), 1, "under the lip");
    }

    /// Looks at the face of the bust or a figure.
    fn bust_camera() -> Camera {
        let view = OrbitView {
            target: Vec3::new(0.0, 1.4, 0.0),
            yaw_degrees: 0.0,
            pitch_degrees: 0.0,
            distance_m: 2.0,
            vertical_fov_degrees: 30.0,
        };
        Camera::orbit(view, [100, 100], 0.01).unwrap()
    }

    #[test]
    fn triangles_are_cut_at_the_near_plane() {
        let mut mesh = plate();
        mesh.positions[2].z = 5.0; // behind the eye
        let cut = &surfaces(
            &mesh.into(),
            &PAINT,
            &[],
            &camera(0.0),
            &Light::Direction(Vec3::Z),
        );
        let all: usize = cut[..2].iter().map(|s| s.triangles.len()).sum();
        assert_eq!(all, 2, "two corners in front leave a quadrilateral");
        for surface in cut {
            for index in surface.triangles.iter().flatten() {
                let vertex = surface.vertices[*index as usize];
                assert!(vertex.position.is_finite() && vertex.inv_depth <= 1.0 / 0.01 + 1e-3);
            }
        }
    }
}
