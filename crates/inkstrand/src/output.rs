//! Picture files: their names and their bytes.

use crate::whole_file::{file_name, write_whole};
use render::Picture;
use std::io;
use std::path::{Path, PathBuf};

/// Where pictures go.
pub(crate) struct Output {
    pattern: PathBuf,
    transparent: bool,
}

impl Output {
    /// Pictures at `given`, or named after the preset in the current folder. A sequence gets frame
    /// numbers, also where the name has no `#` for them.
    ///
    /// # Errors
    ///
    /// When the name promises another format than PNG.
    pub fn new(
        given: Option<&Path>,
        preset: &Path,
        sequence: bool,
        transparent: bool,
    ) -> Result<Self, String> {
        let mut pattern = match given {
            Some(path) => path.to_owned(),
            None => PathBuf::from(preset.file_stem().unwrap_or_default()).with_extension("png"),
        };
        let is_png = pattern
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
        if !is_png {
            let name = pattern.display();
            return Err(format!(
                "-o {name}: pictures are PNG, so the name must end in .png"
            ));
        }
        let numbered = |path: &Path| file_name(path).contains('#');
        if sequence && !numbered(&pattern) {
            pattern.set_extension("####.png");
        }
        Ok(Self {
            pattern,
            transparent,
        })
    }

    /// The file of a frame: its number stands where the last run of `#` is, padded with zeros.
    pub fn path(&self, frame: u32) -> PathBuf {
        let name = file_name(&self.pattern);
        let Some(end) = name.rfind('#').map(|i| i + 1) else {
            return self.pattern.clone();
        };
        let start = name[..end].trim_end_matches('#').len();
        let width = end - start;
        let name = format!("{}{frame:0width$}{}", &name[..start], &name[end..]);
        self.pattern.with_file_name(name)
    }

    /// Writes a picture as PNG: sRGB, straight alpha where it is transparent.
    pub fn write(&self, picture: &Picture, frame: u32) -> io::Result<PathBuf> {
        let path = self.path(frame);
        let bytes = encode(picture, self.transparent)?;
        write_whole(&path, &bytes)?;
        Ok(path)
    }
}

fn encode(picture: &Picture, transparent: bool) -> io::Result<Vec<u8>> {
    let rgba = picture.to_srgb8();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_color(if transparent {
        png::ColorType::Rgba
    } else {
        png::ColorType::Rgb
    });
    let mut writer = encoder.write_header()?;
    if transparent {
        writer.write_image_data(&rgba)?;
    } else {
        let rgb: Vec<u8> = rgba
            .chunks_exact(4)
            .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
            .collect();
        writer.write_image_data(&rgb)?;
    }
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(given: Option<&str>, sequence: bool, frame: u32) -> String {
        let output = Output::new(
            given.map(Path::new),
            Path::new("a/look.ron"),
            sequence,
            false,
        )
        .unwrap();
        output.path(frame).to_string_lossy().into_owned()
    }

    #[test]
    fn names() {
        assert_eq!(path(None, false, 0), "look.png");
        assert_eq!(path(None, true, 12), "look.0012.png");
        assert_eq!(path(Some("out/x.png"), false, 5), "out/x.png");
        assert_eq!(path(Some("out/x.png"), true, 5), "out/x.0005.png");
        assert_eq!(path(Some("out/x_##.png"), true, 123), "out/x_123.png");
        assert_eq!(path(Some("x#y###.png"), true, 7), "x#y007.png");
    }
}
