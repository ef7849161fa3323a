//! Pictures: reading PNG files and comparing them bit by bit.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

use png::{BitDepth, ColorType, Transformations};

use crate::Outcome;

/// A picture as four channels of 16 bits, whatever the file held; 8 bits are spread over all
/// 16, so that equal pictures are equal in any format and different ones never are.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    /// Red, green, blue, alpha; rows from the top.
    pub pixels: Vec<[u16; 4]>,
}

/// How two pictures of one size differ.
#[derive(Debug, PartialEq)]
pub struct Difference {
    /// Pixels that are not the same.
    pub pixels: usize,
    /// The largest difference of a channel, 1..=65535.
    pub largest: u16,
}

impl Picture {
    /// Reads a PNG file.
    ///
    /// # Errors
    /// The file can't be read, isn't a PNG, is cut short, or is of 4 GiB or more.
    pub fn load(path: &Path) -> Outcome<Self> {
        Self::read(path).map_err(|error| format!("{}: {error}", path.display()).into())
    }

    fn read(path: &Path) -> Outcome<Self> {
        let mut decoder = png::Decoder::new(BufReader::new(File::open(path)?));
        decoder.set_transformations(Transformations::EXPAND | Transformations::ALPHA);
        let mut reader = decoder.read_info()?;
        let size = reader.output_buffer_size().ok_or("too large")?;
        let mut bytes = vec![0; size];
        let info = reader.next_frame(&mut bytes)?;
        reader.finish()?;
        bytes.truncate(info.buffer_size());

        let channels: Vec<u16> = match info.bit_depth {
            BitDepth::Sixteen => bytes
                .chunks_exact(2)
                .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
                .collect(),
            _ => bytes.iter().map(|&byte| u16::from(byte) * 257).collect(),
        };
        let pixels = match info.color_type {
            ColorType::GrayscaleAlpha => channels
                .chunks_exact(2)
                .map(|pixel| [pixel[0], pixel[0], pixel[0], pixel[1]])
                .collect(),
            ColorType::Rgba => channels
                .chunks_exact(4)
                .map(|pixel| [pixel[0], pixel[1], pixel[2], pixel[3]])
                .collect(),
            other => return Err(format!("unexpected colours: {other:?}").into()),
        };
        Ok(Self {
            width: info.width,
            height: info.height,
            pixels,
        })
    }

    /// Writes the picture as an 8-bit PNG.
    ///
    /// # Errors
    /// The file can't be written.
    pub fn save(&self, path: &Path) -> Outcome {
        let file = BufWriter::new(File::create(path)?);
        let mut encoder = png::Encoder::new(file, self.width, self.height);
        encoder.set_color(ColorType::Rgba);
        encoder.set_depth(BitDepth::Eight);
        let bytes: Vec<u8> = self
            .pixels
            .iter()
            .flatten()
            .map(|c| (c >> 8) as u8)
            .collect();
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&bytes)?;
        Ok(writer.finish()?)
    }

    /// A transparent picture.
    pub fn blank(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            pixels: vec![[0; 4]; (width * height) as usize],
        }
    }

    /// Puts `other` into this picture, its upper left corner at `(x, y)`.
    ///
    /// # Panics
    /// It doesn't fit.
    pub fn paste(&mut self, other: &Self, (x, y): (u32, u32)) {
        let rows = other.pixels.chunks_exact(other.width as usize);
        for (row, pixels) in rows.enumerate() {
            let start = ((y + row as u32) * self.width + x) as usize;
            self.pixels[start..start + pixels.len()].copy_from_slice(pixels);
        }
    }

    /// The part of this picture whose upper left corner is at `(x, y)`.
    ///
    /// # Panics
    /// It reaches out of the picture.
    pub fn cut(&self, (x, y): (u32, u32), (width, height): (u32, u32)) -> Self {
        let row = |row: u32| {
            let start = ((y + row) * self.width + x) as usize;
            &self.pixels[start..start + width as usize]
        };
        Self {
            width,
            height,
            pixels: (0..height).flat_map(row).copied().collect(),
        }
    }

    /// The pixel in column `x` and row `y`.
    ///
    /// # Panics
    /// Outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> [u16; 4] {
        self.pixels[(y * self.width + x) as usize]
    }

    /// The pixels of column `x`, from the top.
    pub fn column(&self, x: u32) -> impl Iterator<Item = [u16; 4]> {
        (0..self.height).map(move |y| self.pixel(x, y))
    }

    /// True if all pixels are the same: nothing was drawn.
    pub fn is_blank(&self) -> bool {
        self.pixels.windows(2).all(|pair| pair[0] == pair[1])
    }

    /// Compares bit by bit; `None` where the pictures are the same.
    ///
    /// # Errors
    /// The sizes differ.
    pub fn compare(&self, other: &Self) -> Result<Option<Difference>, String> {
        if (self.width, self.height) != (other.width, other.height) {
            return Err(format!(
                "{}x{} in place of {}x{}",
                other.width, other.height, self.width, self.height
            ));
        }
        let mut difference = Difference {
            pixels: 0,
            largest: 0,
        };
        for (a, b) in self.pixels.iter().zip(&other.pixels) {
            difference.pixels += usize::from(a != b);
            for (a, b) in a.iter().zip(b) {
                difference.largest = difference.largest.max(a.abs_diff(*b));
            }
        }
        Ok((difference.pixels > 0).then_some(difference))
    }

    /// The difference to `other`, a picture of the same size: `largest` is white, nothing is
    /// black, and the least one a quarter, so that it can be seen. A difference in alpha shows in
    /// all colours.
    pub fn amplified_difference(&self, other: &Self, largest: u16) -> Self {
        let amplify = |difference: u16| match difference {
            0 => 0,
            _ => {
                let scaled = f32::from(difference) / f32::from(largest);
                ((0.25 + 0.75 * scaled) * f32::from(u16::MAX)) as u16
            }
        };
        let pixels = self.pixels.iter().zip(&other.pixels);
        Self {
            width: self.width,
            height: self.height,
            pixels: pixels
                .map(|(a, b)| {
                    let alpha = a[3].abs_diff(b[3]);
                    let channel = |i: usize| amplify(a[i].abs_diff(b[i]).max(alpha));
                    [channel(0), channel(1), channel(2), u16::MAX]
                })
                .collect(),
        }
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A small picture whose pixels all differ.
    pub fn made() -> Picture {
        let pixel = |i: u16| [i * 257, (255 - i) * 257, 40 * 257, (128 + i) * 257];
        Picture {
            width: 8,
            height: 6,
            pixels: (0..48).map(pixel).collect(),
        }
    }

    #[test]
    fn a_picture_survives_its_file() {
        let path = tempfile::tempdir().unwrap();
        let path = path.path().join("made.png");
        made().save(&path).unwrap();
        assert_eq!(Picture::load(&path).unwrap(), made());
    }

    #[test]
    fn sixteen_bits_are_not_cut_to_eight() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gray.png");
        let mut encoder = png::Encoder::new(File::create(&path).unwrap(), 2, 1);
        encoder.set_color(ColorType::Grayscale);
        encoder.set_depth(BitDepth::Sixteen);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&[1, 2, 1, 3]).unwrap();
        writer.finish().unwrap();
        let gray = |value| [value, value, value, u16::MAX];
        let picture = Picture::load(&path).unwrap();
        assert_eq!(picture.pixels, [gray(0x0102), gray(0x0103)]);
    }

    #[test]
    fn files_that_are_no_pictures_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("broken.png");
        assert!(Picture::load(&path).is_err());
        std::fs::write(&path, "no picture").unwrap();
        assert!(Picture::load(&path).is_err());

        made().save(&path).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() - 20]).unwrap();
        let error = Picture::load(&path).unwrap_err().to_string();
        assert!(error.contains("broken.png"), "{error}");
    }

    #[test]
    fn one_step_in_one_channel_is_a_difference() {
        let golden = made();
        assert_eq!(golden.compare(&golden), Ok(None));
        for channel in 0..4 {
            let mut actual = golden.clone();
            actual.pixels[17][channel] += 257;
            let difference = Difference {
                pixels: 1,
                largest: 257,
            };
            assert_eq!(golden.compare(&actual), Ok(Some(difference)));

            let shown = golden.amplified_difference(&actual, 257);
            for (i, pixel) in shown.pixels.iter().enumerate() {
                let shows = pixel[..3].contains(&u16::MAX);
                assert_eq!(shows, i == 17, "channel {channel}, pixel {i}: {pixel:?}");
            }
        }
    }

    #[test]
    fn what_is_pasted_can_be_cut_out_again() {
        let mut sheet = Picture::blank(20, 9);
        sheet.paste(&made(), (11, 2));
        assert_eq!(sheet.cut((11, 2), (8, 6)), made());
        assert_eq!(sheet.cut((3, 2), (8, 6)), Picture::blank(8, 6));
        assert_eq!(sheet.pixel(11 + 3, 2 + 4), made().pixel(3, 4));
    }

    #[test]
    fn another_size_is_an_error() {
        let mut actual = made();
        actual.width = 6;
        actual.height = 8;
        let error = made().compare(&actual).unwrap_err();
        assert_eq!(error, "6x8 in place of 8x6");
    }

    #[test]
    fn only_a_picture_of_one_colour_is_blank() {
        let mut picture = made();
        assert!(!picture.is_blank());
        picture.pixels.fill([9, 9, 9, 9]);
        assert!(picture.is_blank());
        picture.pixels[47][2] = 8;
        assert!(!picture.is_blank());
    }
}
