//! Materials and textures of a glTF file.

use std::collections::HashMap;
use std::path::Path;

use glam::Vec2;
use portable_math::{linear_from_srgb, sin_cos_degrees};

use super::document::{AlphaMode, Document, MaterialProperties, TextureInfo, TextureTransform};
use super::error::PartError;
use super::numbers::{Buffers, part};
use crate::beside::file_of_uri;
use crate::model::{Alpha, Image, ImageSource, Material, Texture, Wrap};
use crate::read::shown;

/// All materials of a file. What is wrong with their textures is told in notes.
#[derive(Default)]
pub(super) struct Materials {
    pub materials: Vec<Material>,
    pub images: Vec<Image>,
    pub notes: Vec<String>,
    /// Where in its mesh's lists each material's base texture has its places.
    pub places: Vec<Places>,
    /// Of each of the file's images its index in `images`, where it can be had.
    read: HashMap<usize, Option<usize>>,
}

/// Which of a mesh's lists says where a texture lies, and how that is changed.
#[derive(Clone, Copy, Default)]
pub(super) struct Places {
    pub set: usize,
    transform: Option<TextureTransform>,
}

impl Places {
    fn of(info: Option<&TextureInfo>) -> Self {
        let transform = info.and_then(|info| info.extensions.transform);
        let own = info.map_or(0, |info| info.tex_coord);
        Self {
            set: transform
                .and_then(|transform| transform.tex_coord)
                .unwrap_or(own),
            transform,
        }
    }

    pub fn apply(&self, uv: Vec2) -> Vec2 {
        let Some(by) = &self.transform else { return uv };
        // In degrees, as there is a sine of them with the same bits everywhere.
        let degrees = f64::from(by.rotation).to_degrees();
        let (sine, cosine) = if degrees.is_finite() {
            sin_cos_degrees(degrees % 360.0)
        } else {
            (0.0, 1.0)
        };
        let (sine, cosine) = (sine as f32, cosine as f32);
        let Vec2 { x, y } = uv * Vec2::from(by.scale);
        Vec2::from(by.offset) + Vec2::new(cosine * x + sine * y, cosine * y - sine * x)
    }
}

impl Materials {
    pub fn read(&mut self, document: &Document, buffers: &mut Buffers, folder: &Path) {
        let properties = document
            .extensions
            .vrm0
            .as_ref()
            .map_or(&[][..], |vrm| &vrm.material_properties);
        for (number, own) in document.materials.iter().enumerate() {
            let name = own.name.clone().unwrap_or_default();
            let pbr = &own.pbr_metallic_roughness;
            let [red, green, blue, alpha] = pbr.base_color_factor.unwrap_or([1.0; 4]).map(share);
            let mut material = Material {
                base_color: [red, green, blue, alpha],
                alpha: match own.alpha_mode {
                    AlphaMode::Opaque => Alpha::Opaque,
                    AlphaMode::Mask => Alpha::Cutout(share(own.alpha_cutoff.unwrap_or(0.5))),
                    AlphaMode::Blend => Alpha::Blend,
                },
                double_sided: own.double_sided,
                ..Material::default()
            };
            let mut texture = |index: usize| {
                self.texture(document, buffers, folder, index)
                    .unwrap_or_else(|source| {
                        self.notes
                            .push(format!("material {number} `{}`: {source}", shown(&name)));
                        None
                    })
            };
            material.texture = pbr.base_color_texture.and_then(|info| texture(info.index));
            if let Some(mtoon) = &own.extensions.mtoon {
                material.shade_color =
                    Some(mtoon.shade_color_factor.unwrap_or([0.0; 3]).map(share));
                material.shade_texture = mtoon
                    .shade_multiply_texture
                    .and_then(|info| texture(info.index));
            } else if let Some(unity) = properties
                .get(number)
                .filter(|unity| unity.shader == "VRM/MToon")
            {
                material.shade_color = Some(shade_of(unity));
                let index = unity.texture_properties.get("_ShadeTexture");
                material.shade_texture =
                    index.and_then(|index| texture(usize::try_from(*index).ok()?));
            }
            material.name = name;
            self.materials.push(material);
            self.places
                .push(Places::of(pbr.base_color_texture.as_ref()));
        }
    }

    fn texture(
        &mut self,
        document: &Document,
        buffers: &mut Buffers,
        folder: &Path,
        index: usize,
    ) -> Result<Option<Texture>, PartError> {
        let texture = part(&document.textures, "texture", index)?;
        let source = texture.source.ok_or(PartError::Without(
            "picture in a format that is read (PNG, JPEG)",
        ))?;
        let wrap = match texture.sampler {
            None => [Wrap::Repeat; 2],
            Some(sampler) => {
                let sampler = part(&document.samplers, "sampler", sampler)?;
                [sampler.wrap_s, sampler.wrap_t].map(|wrap| match wrap {
                    Some(33071) => Wrap::Clamp,
                    Some(33648) => Wrap::Mirror,
                    _ => Wrap::Repeat,
                })
            }
        };
        let known = self.read.get(&source).copied();
        let image = match known {
            Some(image) => image,
            None => {
                // Whatever comes of it: it is told once.
                self.read.insert(source, None);
                let image = self.image(document, buffers, folder, source)?;
                self.images.push(image);
                self.read.insert(source, Some(self.images.len() - 1));
                Some(self.images.len() - 1)
            }
        };
        Ok(image.map(|image| Texture { image, wrap }))
    }

    fn image(
        &self,
        document: &Document,
        buffers: &mut Buffers,
        folder: &Path,
        index: usize,
    ) -> Result<Image, PartError> {
        let image = part(&document.images, "image", index)?;
        let refused = |why: String| PartError::Image { image: index, why };
        let source = match (&image.uri, image.buffer_view) {
            (_, Some(view)) => ImageSource::Bytes(buffers.picture(view)?.into()),
            (Some(uri), None) if uri.starts_with("data:") => {
                let bytes = super::numbers::decode_data(uri).map_err(refused)?;
                ImageSource::Bytes(bytes.into())
            }
            (Some(uri), None) => {
                let path = file_of_uri(folder, uri).filter(|path| path.is_file());
                let missing = || {
                    refused(format!(
                        "there is no file `{}` in the file's folder, or below",
                        shown(uri)
                    ))
                };
                ImageSource::File(path.ok_or_else(missing)?)
            }
            (None, None) => return Err(refused("it has neither a file nor bytes".to_owned())),
        };
        let named = image.name.clone().or_else(|| {
            image
                .uri
                .as_ref()
                .filter(|uri| !uri.starts_with("data:"))
                .cloned()
        });
        Ok(Image {
            name: named.unwrap_or_else(|| index.to_string()),
            source,
        })
    }
}

/// A part of a whole.
fn share(value: f32) -> f32 {
    if value.is_finite() {
        value.clamp(0.0, 1.0)
    } else {
        1.0
    }
}

/// The colour away from the light, which Unity's material has as screens show it.
fn shade_of(unity: &MaterialProperties) -> [f32; 3] {
    let color = unity.vector_properties.get("_ShadeColor");
    let channel = |i: usize| {
        color
            .and_then(|color| color.get(i))
            .map_or(1.0, |value| linear_from_srgb(value.clamp(0.0, 1.0)) as f32)
    };
    [channel(0), channel(1), channel(2)]
}
