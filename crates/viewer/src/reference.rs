//! A picture to draw after, under or over the hair.

use eframe::egui::{ColorImage, Context, TextureHandle, TextureOptions};
use std::path::{Path, PathBuf};

/// The most bytes of a picture's file.
const MOST_BYTES: u64 = 256 << 20;
/// The most pixels of a side: larger ones are made smaller.
const MOST_PIXELS: u32 = 4096;

/// A picture to draw after.
pub struct Reference {
    /// Its file.
    pub path: PathBuf,
    /// Its pixels.
    pub texture: TextureHandle,
    /// How much of it is seen, 0 to 1.
    pub opacity: f32,
    /// Whether it lies over the hair, or under it.
    pub is_over: bool,
}

impl Reference {
    /// Reads a PNG or JPEG file.
    ///
    /// # Errors
    ///
    /// Why it cannot be read, with its name.
    pub fn open(path: &Path, ctx: &Context) -> Result<Self, String> {
        let named = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let bytes = hair_io::read_bytes(path, MOST_BYTES).map_err(|error| error.to_string())?;
        let mut reader = image::ImageReader::new(std::io::Cursor::new(bytes))
            .with_guessed_format()
            .map_err(|error| named(&error))?;
        reader.limits(image::Limits::default());
        let mut picture = reader.decode().map_err(|error| named(&error))?;
        let most = ctx
            .input(|input| input.max_texture_side)
            .min(MOST_PIXELS as usize) as u32;
        if picture.width().max(picture.height()) > most {
            picture = picture.thumbnail(most, most);
        }
        let pixels = picture.to_rgba8();
        let size = [pixels.width() as usize, pixels.height() as usize];
        let image = ColorImage::from_rgba_unmultiplied(size, &pixels);
        Ok(Self {
            path: path.to_owned(),
            texture: ctx.load_texture("reference", image, TextureOptions::LINEAR),
            opacity: 0.5,
            is_over: true,
        })
    }
}
