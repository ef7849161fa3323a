//! The head: its shape, what is drawn on it, and how it comes onto the screen.

pub(crate) mod layers;
mod on_screen;
mod paint;
mod seen;

pub(crate) use paint::HeadPaint;
pub(crate) use seen::{MESHES, painted, surfaces, worn};

use crate::dynamics::BodyMesh;
use crate::hair::head_of;
use crate::painted::{Moving, PaintedMesh};
use crate::scalp;
use crate::skeleton::Skeleton;
use glam::Vec3;
use groom::{Bust, Cloth, Figure, OrnamentMesh, Patch};
use hair_io::{HeadFrame, Mesh};
use render::Head;
use std::sync::Arc;

/// What is found in the bust's mesh, so that neither dress nor crop changes the size of hair.
const FIGURE_FRAME: Head = Head {
    center: Vec3::new(0.0, 1.4995, -0.0075),
    height_m: 0.241,
};

/// A head's shape, and what is drawn on it.
#[derive(Clone)]
pub struct HeadModel {
    pub(crate) mesh: Mesh,
    /// What hair is kept out of in its place: without limbs, which move by themselves, and without holes where hair was cut away.
    pub(crate) body: Option<Arc<Mesh>>,
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
    /// What moves those of its own file.
    pub(crate) skeleton: Option<Arc<Skeleton>>,
    /// Whether there is no head, and things stand in its place: they turn whole, about their middle.
    pub(crate) is_things: bool,
}

impl HeadModel {
    /// Its shape as it was given, however it is painted, which hair cannot enter: but for what a skeleton moves by itself.
    pub(crate) fn body_mesh(&self) -> BodyMesh<'_> {
        BodyMesh {
            mesh: self.body.as_deref().unwrap_or(&self.mesh),
            has_pieces: self.body.is_some(),
        }
    }

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

    /// None, beside which meshes lie.
    pub(crate) fn none() -> Self {
        no_mesh().into()
    }

    /// Things that stand where a head would: the box around them is as a head is, as high as its longest side.
    pub(crate) fn of_things(mut self) -> Self {
        let points = || {
            self.painted
                .iter()
                .flat_map(|mesh| &mesh.positions)
                .copied()
        };
        if let (Some(low), Some(high)) = (points().reduce(Vec3::min), points().reduce(Vec3::max)) {
            let height_m = (high - low).max_element();
            self.frame = (height_m > 0.0).then_some(Head {
                center: 0.5 * (low + high),
                height_m,
            });
        }
        self.is_things = true;
        self
    }

    /// Whether anything of it moves by itself.
    pub(crate) fn moves(&self) -> bool {
        self.painted.iter().any(|mesh| mesh.moving.is_some())
    }

    /// The same at rest, each mesh of numbered files in the form that it has in `posed`.
    pub(crate) fn in_forms_of(&self, posed: &Self) -> Self {
        let mut model = self.clone();
        for (mesh, posed) in model.painted.iter_mut().zip(&posed.painted) {
            if let (Some(Moving::Numbered(numbered)), true) =
                (mesh.moving.clone(), mesh.form != posed.form)
            {
                mesh.take_form(&numbered.of_kind(posed.form));
            }
        }
        model
    }

    /// Whether its own file's colours are in place of the preset's.
    pub(crate) fn is_painted(&self) -> bool {
        self.painted.iter().any(|mesh| mesh.section.is_none())
    }

    /// Whether anything of [`Self::mesh`] is drawn: a head in its own file's colours has other meshes.
    pub(crate) fn shows_mesh(&self) -> bool {
        !self.is_painted() || !self.clothes.is_empty()
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
            skeleton: None,
            body: None,
            is_things: false,
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
            skeleton: None,
            body: None,
            is_things: false,
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

#[cfg(test)]
mod tests;
