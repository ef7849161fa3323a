//! What a file of meshes holds, as plain arrays.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::read::{MOST_OF_DATA, ReadError, read_bytes};
use crate::rig::Rig;
use crate::welded::Welded;

/// Meshes with their materials and, of a character, what moves them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The meshes, in the file's order: what has one name and one material is one. They lie as the file has them at rest.
    pub meshes: Vec<Mesh>,
    /// The materials that meshes name by their index.
    pub materials: Vec<Material>,
    /// The pictures that materials name by their index.
    pub images: Vec<Image>,
    /// Nodes, skins, morphs and animations; none of files that have only meshes.
    pub rig: Option<Rig>,
    /// Whether the format says that Y is up and a unit is a metre, as glTF does.
    pub is_metric: bool,
    /// Sentences to print: what was left out, and why.
    pub notes: Vec<String>,
}

/// Triangles of one name and one material. The lists beside `positions` are as long as it: a corner with another normal or place in
/// the texture is a vertex of its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Its name, as the file has it; may be empty, and need not be the only one of that name.
    pub name: String,
    /// Finite positions, each used by a triangle.
    pub positions: Vec<Vec3>,
    /// Unit normals: the file's, or else those of the triangles around each place.
    pub normals: Vec<Vec3>,
    /// Places in the material's textures, (0, 0) the upper left corner of the picture; empty where the file has none.
    pub uvs: Vec<Vec2>,
    /// What else the file says of vertices.
    pub attributes: Vec<Attribute>,
    /// Three indices into `positions`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Index of its material.
    pub material: Option<usize>,
}

/// Numbers that a file gives of each vertex: velocities, colours, curvatures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attribute {
    /// Of glTF without the underscore and in small letters: `velocity` of `_VELOCITY`, `color_0`; of PLY the property.
    pub name: String,
    /// Numbers a vertex, 1 to 4.
    pub width: usize,
    /// `width` numbers for each vertex, finite.
    pub values: Vec<f32>,
}

/// How a mesh is painted. Colours are linear, 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Colour and alpha, which the texture is multiplied by.
    pub base_color: [f32; 4],
    /// Texture of the colour.
    pub texture: Option<Texture>,
    /// What its alpha means.
    pub alpha: Alpha,
    /// Colour away from the light, of a toon material (MToon).
    pub shade_color: Option<[f32; 3]>,
    /// Texture that `shade_color` is multiplied by.
    pub shade_texture: Option<Texture>,
    /// Whether both sides of its triangles are seen.
    pub double_sided: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            texture: None,
            alpha: Alpha::Opaque,
            shade_color: None,
            shade_texture: None,
            double_sided: false,
        }
    }
}

/// What a material's alpha means.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Alpha {
    /// Nothing.
    #[default]
    Opaque,
    /// There is nothing where it is below this.
    Cutout(f32),
    /// How much of what lies behind is hidden.
    Blend,
}

/// A picture on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// Index of its picture.
    pub image: usize,
    /// What is left and right of the picture, and what above and below it.
    pub wrap: [Wrap; 2],
}

/// What is beside a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// Its border.
    Clamp,
    /// The picture, mirrored each other time.
    Mirror,
}

/// A picture, as its file has it: PNG or JPEG.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Its name.
    pub name: String,
    /// Where its bytes are.
    pub source: ImageSource,
}

/// Where a picture's bytes are.
#[derive(Clone, Debug, PartialEq)]
pub enum ImageSource {
    /// In a file in the folder of the model, or below. It was there when the model was read.
    File(PathBuf),
    /// In the model's own file.
    Bytes(Arc<[u8]>),
}

impl Image {
    /// The bytes of the picture's file.
    ///
    /// # Errors
    ///
    /// When the file can't be read.
    pub fn bytes(&self) -> Result<Arc<[u8]>, ReadError> {
        match &self.source {
            ImageSource::File(path) => Ok(read_bytes(path, MOST_OF_DATA)?.into()),
            ImageSource::Bytes(bytes) => Ok(bytes.clone()),
        }
    }
}

impl Mesh {
    /// The attribute of this name.
    #[must_use]
    pub fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|own| own.name == name)
    }

    /// The places of every triangle's corners.
    pub fn corners(&self) -> impl Iterator<Item = [Vec3; 3]> {
        let corner = |index: u32| self.positions[index as usize];
        self.triangles.iter().map(move |t| t.map(corner))
    }

    /// Puts the normals of the triangles around each place where the mesh has no unit normal.
    pub(crate) fn mend_normals(&mut self) {
        let is_good = |normal: &Vec3| normal.is_finite() && normal.length_squared() > 0.25;
        if self.normals.len() == self.positions.len() && self.normals.iter().all(is_good) {
            for normal in &mut self.normals {
                *normal = normal.normalize();
            }
            return;
        }
        let own = Welded::from_corners(self.corners()).normals_at();
        let mut given = self
            .normals
            .iter()
            .copied()
            .chain(std::iter::repeat(Vec3::ZERO));
        let mended = self.positions.iter().map(|place| {
            let given = given.next().filter(is_good).map(Vec3::normalize);
            // A triangle without area has no other.
            given.unwrap_or_else(|| own(place).unwrap_or(Vec3::Y))
        });
        self.normals = mended.collect();
    }
}

impl Attribute {
    /// The numbers of a vertex.
    ///
    /// # Panics
    ///
    /// When there is no such vertex.
    #[must_use]
    pub fn of(&self, vertex: usize) -> &[f32] {
        &self.values[vertex * self.width..][..self.width]
    }
}

impl Model {
    /// All its meshes at rest as one shape: corners at one place are one.
    #[must_use]
    pub fn welded(&self) -> Welded {
        Welded::from_corners(self.meshes.iter().flat_map(Mesh::corners))
    }
}
