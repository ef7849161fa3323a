//! How meshes are painted: by the materials and pictures of their files, and by pictures that presets name.

use super::Wanted;
use crate::files::StageError;
use crate::pictures::{self, Clear};
use crate::preset::AlphaChoice;
use effects::Image;
use mesh_io::{Alpha, Attribute, Material, Mesh, Model, Wrap};
use render::Coverage;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// How a file paints a mesh.
#[derive(Clone)]
pub(crate) struct MeshPaint {
    /// Linear; the picture is multiplied by it. None where the file says no colours.
    pub color: Option<[f32; 3]>,
    /// The same away from the light, where the file says it.
    pub shade: Option<[f32; 3]>,
    pub picture: Option<MeshPicture>,
    /// Whether triangles are seen from behind.
    pub both_sides: bool,
}

/// The picture on a mesh.
#[derive(Clone)]
pub(crate) struct MeshPicture {
    pub image: Arc<Image>,
    pub repeats: bool,
    pub coverage: Coverage,
}

impl MeshPaint {
    /// Without colours in the file.
    pub(super) const NONE: Self = Self {
        color: None,
        shade: None,
        picture: None,
        both_sides: false,
    };

    /// Whether lines are drawn around it: not around what is seen through.
    pub(crate) fn has_outline(&self) -> bool {
        let coverage = self.picture.as_ref().map(|picture| picture.coverage);
        coverage != Some(Coverage::Share)
    }
}

/// Whether nothing of a material shows, by the alpha of its colour, which its picture is multiplied by (glTF 2.0, 3.9.2 and 3.9.4).
pub(super) fn is_clear(material: &Material) -> bool {
    let [.., alpha] = material.base_color;
    match material.alpha {
        Alpha::Opaque => false,
        Alpha::Cutout(least) => alpha < least,
        Alpha::Blend => alpha <= 0.0,
    }
}

/// Colours of vertices, linear, which a material's colour is multiplied by (glTF 2.0, 3.9.2): `COLOR_0`.
const VERTEX_COLORS: &str = "color_0";
/// Colours that differ by no more than this are alike: two steps of 255.
const ALIKE: f32 = 2.0 / 255.0;

/// The colours of a mesh's vertices, where it has some and is painted so: toon materials (MToon) don't look at them.
pub(super) fn vertex_colors_of<'m>(mesh: &'m Mesh, paint: &MeshPaint) -> Option<&'m Attribute> {
    mesh.attribute(VERTEX_COLORS)
        .filter(|_| paint.shade.is_none())
}

/// The mean of the colours of vertices, and whether it is the colour of all.
pub(super) fn mean_color(colors: &Attribute) -> ([f32; 3], bool) {
    let all = || colors.values.chunks_exact(colors.width);
    let count = all().len().max(1) as f64;
    let channel = |i: usize| {
        let sum: f64 = all()
            .map(|own| f64::from(own.get(i).copied().unwrap_or(1.0)))
            .sum();
        ((sum / count) as f32).clamp(0.0, 1.0)
    };
    let mean = [0, 1, 2].map(channel);
    let is_mean = |own: &[f32]| {
        own.iter()
            .zip(mean)
            .all(|(x, mean)| (x - mean).abs() <= ALIKE)
    };
    (mean, all().all(is_mean))
}

/// What of a material's picture covers, as a preset has it or else the file.
fn coverage_of(material: &Material, chosen: AlphaChoice) -> Coverage {
    let [.., alpha] = material.base_color;
    match (chosen, material.alpha) {
        (AlphaChoice::Whole, _) | (AlphaChoice::File, Alpha::Opaque) => Coverage::Ignored,
        (AlphaChoice::Cut, _) => Coverage::Cut(0.5),
        // The picture's own alpha, which is multiplied by the colour's.
        (AlphaChoice::File, Alpha::Cutout(least)) => {
            Coverage::Cut((least / alpha.max(1e-6)).clamp(0.0, 1.0))
        }
        (AlphaChoice::Blend, _) | (AlphaChoice::File, Alpha::Blend) => Coverage::Share,
    }
}

/// What is clear in a picture that covers so, by a colour of such alpha.
pub(super) fn clear_of(coverage: Coverage, alpha: f32) -> Clear {
    match coverage {
        Coverage::Ignored => Clear::Nothing,
        Coverage::Cut(_) => Clear::By(1.0),
        Coverage::Share => Clear::By(alpha),
    }
}

/// How a mesh of a model is painted, whose material that is.
pub(super) fn paint_of(
    mesh: &Mesh,
    material: Option<&Material>,
    wanted: &Wanted,
    pictures: &mut Pictures,
) -> Result<MeshPaint, StageError> {
    let mut paint = match material {
        None => MeshPaint::NONE,
        Some(material) => of_material(material, !mesh.uvs.is_empty(), wanted.alpha, pictures)?,
    };
    // A picture of the preset's own takes the place of all that the file paints with.
    let colors = vertex_colors_of(mesh, &paint).filter(|_| !wanted.has_picture);
    if let Some(colors) = colors {
        let (color, are_alike) = mean_color(colors);
        let own = paint.color.unwrap_or([1.0; 3]);
        paint.color = Some([0, 1, 2].map(|i| own[i] * color[i]));
        if !are_alike && paint.picture.is_some() {
            pictures.notes.push(format!(
                "{}: mesh `{}` has a picture and colours of its vertices, and is drawn in the mean of these",
                pictures.path.display(),
                mesh.name
            ));
        }
    }
    Ok(paint)
}

fn of_material(
    material: &Material,
    has_places: bool,
    chosen: AlphaChoice,
    pictures: &mut Pictures,
) -> Result<MeshPaint, StageError> {
    let [red, green, blue, alpha] = material.base_color;
    let coverage = coverage_of(material, chosen);
    let texture = material.texture.filter(|_| has_places);
    let picture = match texture {
        None => None,
        Some(texture) => {
            // Other formats' alphas are more often mistakes, and what is to be drawn all the same isn't clear.
            let counts = pictures.model.rig.is_some() && material.alpha != Alpha::Opaque;
            let share = if counts && alpha > 0.0 { alpha } else { 1.0 };
            let image = pictures.get(texture.image, clear_of(coverage, share))?;
            image.map(|image| MeshPicture {
                image,
                repeats: texture.wrap != [Wrap::Clamp; 2],
                coverage,
            })
        }
    };
    Ok(MeshPaint {
        color: Some([red, green, blue]),
        shade: material.shade_color,
        picture,
        both_sides: material.double_sided,
    })
}

/// The pictures of a model, each read once as each material has it.
pub(super) struct Pictures<'m> {
    model: &'m Model,
    path: &'m Path,
    /// By their index, and by how much their alpha counts: its bits, or none where it doesn't.
    read: HashMap<(usize, Option<u32>), Arc<Image>>,
    pub(super) notes: Vec<String>,
}

impl<'m> Pictures<'m> {
    pub(super) fn new(model: &'m Model, path: &'m Path) -> Self {
        Self {
            model,
            path,
            read: HashMap::new(),
            notes: Vec::new(),
        }
    }

    /// The picture of that index; none where the model has no such.
    fn get(&mut self, index: usize, clear: Clear) -> Result<Option<Arc<Image>>, StageError> {
        let Some(image) = self.model.images.get(index) else {
            return Ok(None);
        };
        let share = match clear {
            Clear::Nothing => None,
            Clear::By(share) => Some(share.to_bits()),
        };
        if let Some(known) = self.read.get(&(index, share)) {
            return Ok(Some(known.clone()));
        }
        let fault = |message: String| StageError::Picture {
            path: self.path.to_owned(),
            name: image.name.clone(),
            message,
        };
        let bytes = image.bytes().map_err(|error| fault(error.to_string()))?;
        let (picture, note) = pictures::decode(&bytes, clear).map_err(fault)?;
        if let Some(note) = note {
            let path = self.path.display();
            let note = format!("{path}: picture `{}` {note}", image.name);
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
        let picture = Arc::new(picture);
        self.read.insert((index, share), picture.clone());
        Ok(Some(picture))
    }
}

/// What is wrong with a picture that a preset names, if anything is.
pub(crate) fn check_picture(path: &Path) -> Result<(), StageError> {
    picture(path, Clear::Nothing).map(drop)
}

/// A picture that a preset names.
pub(super) fn picture(path: &Path, clear: Clear) -> Result<Arc<Image>, StageError> {
    let bytes = hair_io::read_bytes(path, hair_io::MOST_OF_DATA)?;
    let (image, _) =
        pictures::decode(&bytes, clear).map_err(|message| StageError::PictureFile {
            path: path.to_owned(),
            message,
        })?;
    Ok(Arc::new(image))
}
