//! The head on the screen: two flat tones and an outline.

use crate::hair::head_of;
use crate::scalp;
use glam::{Vec2, Vec3};
use groom::{Bust, Cloth, Figure, Ink, OrnamentMesh, Patch};
use hair_io::{HeadFrame, Mesh};
use render::{Head, Light, Surface, SurfaceVertex};
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

/// What of a head is told apart as a mesh of its own ([`Surface::mesh`]): itself, its clothes, ornaments.
pub(crate) const MESHES: u32 = 3;
const CLOTHES: u32 = 1;
const ORNAMENTS: u32 = 2;

/// How much nearer than a band hair must be to hide it, metres: next to nothing.
const BAND_MARGIN_M: f32 = 1e-5;

/// Which way a triangle must face to be taken.
#[derive(Clone, Copy, PartialEq)]
enum Facing {
    Front,
    Back,
}

/// What the camera sees of the head: its outside, its inside through openings, its outline, what is drawn
/// on it.
pub(crate) fn surfaces(
    model: &HeadModel,
    paint: &HeadPaint,
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
    let mut surfaces = vec![
        surface(
            camera,
            bare,
            &corners,
            Facing::Front,
            paint.light,
            paint.shadow,
        ),
        Surface {
            margin_m: paint.inside_margin_m,
            ..surface(
                camera,
                skin,
                &corners,
                Facing::Back,
                paint.shadow,
                paint.shadow,
            )
        },
    ];
    if !scalp.is_empty() {
        let (front, color) = (Facing::Front, paint.scalp);
        surfaces.push(surface(camera, scalp, &corners, front, color, color));
    }
    for (cloth, triangles) in clothes {
        let [light, shadow, _] = paint.of_cloth(*cloth);
        let (front, back) = (Facing::Front, Facing::Back);
        surfaces.push(Surface {
            mesh: CLOTHES,
            ..surface(camera, triangles, &corners, front, light, shadow)
        });
        surfaces.push(Surface {
            mesh: CLOTHES,
            margin_m: paint.inside_margin_m,
            ..surface(camera, triangles, &corners, back, shadow, shadow)
        });
    }
    if paint.width_m > 0.0 {
        let hull = hull(mesh, &model.outline, paint, camera);
        let skin = once((Cloth::Skin, skin));
        let clothes = clothes.iter().map(|(cloth, triangles)| (*cloth, triangles));
        for (cloth, triangles) in skin.chain(clothes) {
            let is_skin = cloth == Cloth::Skin;
            let [.., line] = paint.of_cloth(cloth);
            surfaces.push(Surface {
                mesh: if is_skin { 0 } else { CLOTHES },
                margin_m: -paint.outline_margin_m,
                ..surface(camera, triangles, &hull, Facing::Back, line, line)
            });
        }
    }
    if !ornaments.triangles.is_empty() {
        surfaces.extend(worn(ornaments, paint, camera, light));
    }
    let center = model.frame.map_or(Vec3::ZERO, |head| head.center);
    let is_drawn = |patch: &&Patch| {
        let lit = |away: Vec3| away.dot(light.seen_from(center).0) >= paint.threshold;
        !patch.away_from.is_some_and(lit)
    };
    surfaces.extend(patches.iter().filter(is_drawn).map(|patch| {
        let corner = |position: &Vec3| Corner {
            view: camera.view_from_world(*position),
            tone: 0.0,
        };
        let corners: Vec<Corner> = patch.positions.iter().map(corner).collect();
        let color = paint.of(patch.ink);
        let triangles = &patch.triangles;
        surface(camera, triangles, &corners, Facing::Front, color, color)
    }));
    surfaces
}

/// A slightly larger mesh, whose inside is seen around the edges of the mesh itself; `widths` as in [`HeadModel`].
fn hull(mesh: &Mesh, widths: &[f32], paint: &HeadPaint, camera: &Camera) -> Vec<Corner> {
    let widths = widths.iter().copied().chain(repeat(1.0));
    mesh.positions
        .iter()
        .zip(&mesh.normals)
        .zip(widths)
        .map(|((position, normal), width)| Corner {
            view: camera.view_from_world(*position + *normal * (paint.width_m * width)),
            tone: 0.0,
        })
        .collect()
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
    let front = surface(
        camera,
        &ornaments.triangles,
        &corners,
        Facing::Front,
        paint.tie,
        paint.tie_shadow,
    );
    let mut worn = vec![front];
    if paint.width_m > 0.0 {
        let hull = hull(ornaments, &[], paint, camera);
        let (back, line) = (Facing::Back, paint.line);
        worn.push(surface(
            camera,
            &ornaments.triangles,
            &hull,
            back,
            line,
            line,
        ));
    }
    for surface in &mut worn {
        surface.margin_m = BAND_MARGIN_M;
        surface.mesh = ORNAMENTS;
    }
    worn
}

/// The triangles that face this way, cut at the near plane.
fn surface(
    camera: &Camera,
    triangles: &[[u32; 3]],
    corners: &[Corner],
    facing: Facing,
    light: [f32; 3],
    shadow: [f32; 3],
) -> Surface {
    let near = camera.near_m();
    let project = |corner: &Corner| {
        let inv_depth = 1.0 / corner.view.z;
        SurfaceVertex {
            position: camera.project(corner.view),
            inv_depth,
            tone: corner.tone * inv_depth,
        }
    };
    let mut surface = Surface {
        vertices: Vec::new(),
        triangles: Vec::new(),
        margin_m: 0.0,
        mesh: 0,
        light,
        shadow,
    };
    // Only corners that are seen are projected; this is where they went.
    let mut entered = vec![u32::MAX; corners.len()];
    for triangle in triangles {
        let seen = triangle.map(|i| corners[i as usize]);
        if faces(&seen) != facing {
            continue;
        }
        let first = surface.vertices.len();
        let polygon: Vec<u32> = if seen.iter().all(|corner| corner.view.z >= near) {
            let enter = |i: &u32| {
                let index = &mut entered[*i as usize];
                if *index == u32::MAX {
                    *index = surface.vertices.len() as u32;
                    surface.vertices.push(project(&corners[*i as usize]));
                }
                *index
            };
            triangle.iter().map(enter).collect()
        } else {
            surface
                .vertices
                .extend(cut(&seen, near).iter().map(project));
            (first as u32..surface.vertices.len() as u32).collect()
        };
        let is_at_hand = |i: &u32| {
            let position = surface.vertices[*i as usize].position;
            position.abs().max_element() <= FARTHEST_PX
        };
        // No picture can mean a corner that far away.
        if polygon.iter().all(is_at_hand) {
            for pair in polygon.windows(2).skip(1) {
                surface.triangles.push([polygon[0], pair[0], pair[1]]);
            }
        }
    }
    // What no triangle uses any more may lie anywhere.
    for vertex in &mut surface.vertices {
        if vertex.position.abs().max_element() > FARTHEST_PX || !vertex.position.is_finite() {
            vertex.position = Vec2::ZERO;
        }
    }
    surface
}

/// Triangles with a corner farther from the picture's corner are left out, px.
const FARTHEST_PX: f32 = 1e8;

/// Which side of the triangle the eye, at the origin of view space, is on.
fn faces([a, b, c]: &[Corner; 3]) -> Facing {
    // View space is left-handed (z is depth), so outside triangles wind the other way around.
    let normal = (b.view - a.view).cross(c.view - a.view);
    if normal.dot(a.view) > 0.0 {
        Facing::Front
    } else {
        Facing::Back
    }
}

/// The part of a triangle at depth `near` or beyond: three or four corners.
fn cut(triangle: &[Corner; 3], near: f32) -> Vec<Corner> {
    let mut kept = Vec::with_capacity(4);
    for i in 0..3 {
        let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
        if a.view.z >= near {
            kept.push(a);
        }
        if (a.view.z >= near) != (b.view.z >= near) {
            let t = (near - a.view.z) / (b.view.z - a.view.z);
            kept.push(Corner {
                view: a.view.lerp(b.view, t).with_z(near),
                tone: a.tone + (b.tone - a.tone) * t,
            });
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
        let front = surfaces(&plate().into(), &PAINT, &camera(0.0), &light);
        assert_eq!(front[0].triangles.len(), 1);
        assert_eq!(front[1].triangles.len(), 0);
        assert_eq!(
            front[2].triangles.len(),
            0,
            "the hull shows its inside only"
        );
        assert!(front[0].vertices.iter().all(|v| v.tone > 0.0));

        let behind = surfaces(&plate().into(), &PAINT, &camera(180.0), &light);
        assert_eq!(behind[0].triangles.len(), 0);
        assert_eq!(behind[1].triangles.len(), 1);
        assert_eq!(behind[1].light, PAINT.shadow);
        assert_eq!(behind[2].triangles.len(), 1);
    }

    #[test]
    fn shade_is_dark_in_full_light() {
        let mut model = HeadModel::from(plate());
        model.shade = vec![0.0, 0.0, 1.0];
        let seen = surfaces(&model, &PAINT, &camera(0.0), &Light::Direction(Vec3::Z));
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
        let seen = surfaces(&sailor, &PAINT, &bust_camera(), &Light::Direction(Vec3::Z));
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
            let seen = surfaces(&figure, &PAINT, &bust_camera(), &light);
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
