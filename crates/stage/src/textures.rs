//! Files of textures: PNG pictures that layers' parameters name.

use crate::files::{Files, StageError};
use crate::kept::Kept;
use effects::preset::{LayerSpec, Place};
use effects::{BrushSection, BrushTexture, Image, Layer, Texture, Values};
use hair_io::read_bytes;
use std::collections::HashMap;
use std::fmt;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

/// Bytes of a file at most: more than any picture within [`Image::MOST_TEXELS`] has.
const MOST_BYTES: u64 = 256 << 20;

/// Pictures that were read, by path, read again where the file's size or date has changed; and brushes that were made. Copies share them.
#[derive(Clone, Default)]
pub struct Textures {
    known: Arc<Mutex<Known>>,
    brushes: Kept<BrushSection, Option<Arc<BrushTexture>>, 16>,
}

type Known = HashMap<PathBuf, (Stamp, Arc<Image>)>;

/// A file's size and date.
type Stamp = (u64, Option<SystemTime>);

impl fmt::Debug for Textures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Textures")
    }
}

impl Textures {
    fn read(&self, path: &Path) -> Result<Arc<Image>, String> {
        let data = std::fs::metadata(path);
        let stamp = data.map(|data| (data.len(), data.modified().ok()));
        // A panic elsewhere leaves whole entries.
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let (Some((old, image)), Ok(stamp)) = (known.get(path), &stamp)
            && old == stamp
        {
            return Ok(image.clone());
        }
        let image = Arc::new(read_png(path)?);
        if let Ok(stamp) = stamp {
            known.insert(path.to_owned(), (stamp, image.clone()));
        }
        Ok(image)
    }

    /// What the section's tool leaves, made once.
    fn tool(&self, section: &BrushSection) -> Option<Arc<BrushTexture>> {
        self.brushes.get(section.clone(), |section| {
            BrushTexture::of_tool(section).map(Arc::new)
        })
    }

    /// A layer's brush, if it has one.
    fn brush(
        &self,
        section: &BrushSection,
        files: &Files,
    ) -> Result<Option<Arc<BrushTexture>>, String> {
        let Some(file) = &section.texture else {
            return Ok(self.tool(section));
        };
        let picture = self.read(&files.preset_folder.join(file))?;
        let brush =
            BrushTexture::of_picture(section, &picture).map_err(|error| error.to_string())?;
        Ok(Some(Arc::new(brush)))
    }
}

/// A layer with these values, and pictures in place of their files' names.
pub(crate) fn with_textures(
    layer: &LayerSpec,
    values: &Values,
    files: &Files,
) -> Result<Layer, StageError> {
    let mut values = values.clone();
    let read = values.read_textures(|file| files.textures.read(&files.preset_folder.join(file)));
    read.and_then(|()| files.textures.brush(&layer.brush, files))
        .map(|brush| layer.build_with(&values, brush))
        .map_err(|message| StageError::Texture {
            layer: layer.name.clone(),
            message,
        })
}

/// The files that a layer's textures name: their parameters, where the preset names them, and their names.
pub(crate) fn textures_of<'l>(
    layer: &'l LayerSpec,
) -> impl Iterator<Item = (&'static str, Option<&'l Place>, &'l str)> {
    let of_params = layer.effect.params().iter().filter_map(|param| {
        let effects::Value::Texture(Texture::File(file)) = layer.values.value(param.name) else {
            return None;
        };
        let place = layer.textures.iter().find(|(name, _)| *name == param.name);
        Some((param.name, place.map(|(_, place)| place), file.as_str()))
    });
    let of_brush = layer.brush.texture.as_deref();
    let of_brush = of_brush.map(|file| ("texture", layer.brush_place.as_ref(), file));
    of_params.chain(of_brush)
}

/// The files that a layer's textures name, by their parameters, and where.
pub(crate) fn named<'l>(
    layer: &'l LayerSpec,
    files: &Files,
) -> impl Iterator<Item = (&'static str, Option<&'l Place>, PathBuf)> + use<'l> {
    let folder = files.preset_folder.clone();
    textures_of(layer).map(move |(param, place, file)| (param, place, folder.join(file)))
}

/// What is wrong with a texture's file.
pub(crate) fn fault(path: &Path, files: &Files) -> Option<String> {
    files.textures.read(path).err()
}

fn read_png(path: &Path) -> Result<Image, String> {
    let bytes = read_bytes(path, MOST_BYTES).map_err(|error| error.to_string())?;
    decode_png(bytes).map_err(|message| format!("{}: {message}", path.display()))
}

/// A PNG of any kind, of 1 to 16 bits.
fn decode_png(bytes: Vec<u8>) -> Result<Image, String> {
    let fault = |error: png::DecodingError| match error {
        png::DecodingError::Format(_) => "it is no PNG file, or a broken one".to_owned(),
        png::DecodingError::IoError(_) => "the file ends too early".to_owned(),
        other => format!("it can't be read as a PNG file: {other}"),
    };
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    // Palettes and fewer than 8 bits as 8, a transparent colour as coverage.
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(fault)?;
    let size = [reader.info().width, reader.info().height].map(|side| side as usize);
    if size.iter().any(|side| *side > Image::MOST_TEXELS) {
        // As `Image` has it, before anything of that size is made.
        return Err(effects::ImageError::Size(size).to_string());
    }
    let (color, depth) = reader.output_color_type();
    let length = reader.output_buffer_size();
    let mut buffer = vec![0; length.ok_or("it is too large")?];
    reader.next_frame(&mut buffer).map_err(fault)?;
    let channels: Vec<u16> = match depth {
        png::BitDepth::Sixteen => buffer
            .chunks_exact(2)
            .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
            .collect(),
        _ => buffer.iter().map(|byte| u16::from(*byte) * 257).collect(),
    };
    let full = u16::MAX;
    let texels: Vec<u16> = match color {
        png::ColorType::Grayscale => (channels.iter().flat_map(|&g| [g, g, g, full])).collect(),
        png::ColorType::GrayscaleAlpha => {
            let (pairs, _) = channels.as_chunks::<2>();
            pairs.iter().flat_map(|&[g, a]| [g, g, g, a]).collect()
        }
        png::ColorType::Rgb => {
            let (triples, _) = channels.as_chunks::<3>();
            triples
                .iter()
                .flat_map(|&[r, g, b]| [r, g, b, full])
                .collect()
        }
        _ => channels,
    };
    Image::from_srgb(size, &texels).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(size: [u32; 2], color: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == png::ColorType::Indexed {
            encoder.set_palette(&[255, 0, 0, 0, 0, 255][..]);
        }
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(data).unwrap();
        writer.finish().unwrap();
        bytes
    }

    #[test]
    fn all_kinds_of_png_are_read() {
        use png::{BitDepth, ColorType};
        let middle = |bytes: Vec<u8>| decode_png(bytes).unwrap().at([0.25, 0.5], 0.0, false);
        let red = [1.0, 0.0, 0.0, 1.0];
        let white = [1.0; 4];
        for (color, depth, data, expected) in [
            (
                ColorType::Rgb,
                BitDepth::Eight,
                &[255, 0, 0, 0, 0, 0][..],
                red,
            ),
            (
                ColorType::Rgba,
                BitDepth::Eight,
                &[255, 0, 0, 255, 0, 0, 0, 0],
                red,
            ),
            (ColorType::Grayscale, BitDepth::Eight, &[255, 0], white),
            (ColorType::Grayscale, BitDepth::One, &[0b1000_0000], white),
            (
                ColorType::Grayscale,
                BitDepth::Sixteen,
                &[255, 255, 0, 0],
                white,
            ),
            (
                ColorType::GrayscaleAlpha,
                BitDepth::Eight,
                &[255, 255, 0, 0],
                white,
            ),
            (ColorType::Indexed, BitDepth::Eight, &[0, 1], red),
        ] {
            assert_eq!(
                middle(png([2, 1], color, depth, data)),
                expected,
                "{color:?} {depth:?}"
            );
        }
        // 16 bits are kept: half a step of 8 bits.
        let gray = png([1, 1], ColorType::Grayscale, BitDepth::Sixteen, &[0x80, 0]);
        let [light, ..] = decode_png(gray).unwrap().at([0.5; 2], 0.0, false);
        let expected = effects::linear_from_srgb(32768.0 / 65535.0) as f32;
        assert!((light - expected).abs() < 1e-4, "{light} {expected}");
    }

    #[test]
    fn hostile_files_are_told() {
        use png::{BitDepth, ColorType};
        let good = png([2, 1], ColorType::Grayscale, BitDepth::Eight, &[255, 0]);
        for end in 0..good.len() - 12 {
            assert!(decode_png(good[..end].to_vec()).is_err(), "{end}");
        }
        assert!(
            decode_png(b"GIF89a, not a PNG".to_vec())
                .unwrap_err()
                .contains("no PNG file")
        );
        let wide = png(
            [30_000, 1],
            ColorType::Grayscale,
            BitDepth::Eight,
            &vec![0; 30_000],
        );
        assert!(
            decode_png(wide)
                .unwrap_err()
                .contains("30000 x 1 texels; a texture has 1 to 4096")
        );
        // Width 0, with its checksum.
        let mut empty = good.clone();
        empty[16..20].fill(0);
        assert!(decode_png(empty).is_err());
    }

    #[test]
    fn a_file_is_read_again_when_it_changes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let write = |width: u32| {
            let data = vec![255; width as usize];
            let (color, depth) = (png::ColorType::Grayscale, png::BitDepth::Eight);
            std::fs::write(&path, png([width, 1], color, depth, &data)).unwrap();
        };
        let textures = Textures::default();
        write(3);
        let first = textures.read(&path).unwrap();
        assert!(Arc::ptr_eq(&first, &textures.clone().read(&path).unwrap()));
        write(4000);
        assert_eq!(textures.read(&path).unwrap().size(), [4000, 1]);
        std::fs::remove_file(&path).unwrap();
        assert!(textures.read(&path).unwrap_err().contains("a.png"));
    }
}
