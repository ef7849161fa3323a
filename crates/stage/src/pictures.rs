//! Pictures on meshes: PNG or JPEG, from files or from the bytes of a character.

use effects::Image;
use image::{ImageError, ImageReader, Limits};
use std::io::Cursor;

/// The longest side that is kept: on a screen a mesh shows no more, and with its smaller copies such a picture takes 45 MB.
const LONGEST_SIDE: u32 = 2048;
/// Pictures with a longer side are refused.
const LARGEST_SIDE: u32 = 16384;
/// Bytes that reading one may take.
const MOST_MEMORY: u64 = 1 << 30;

/// What is clear in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Clear {
    /// Nothing, whatever its alpha: colours are shown where that is 0, too.
    Nothing,
    /// What its alpha says, which counts for so much.
    By(f32),
}

/// A picture, and what was done to it, for those who read notes.
pub(crate) fn decode(bytes: &[u8], clear: Clear) -> Result<(Image, Option<String>), String> {
    let told = |error: ImageError| match error {
        ImageError::Limits(_) => format!("is larger than {LARGEST_SIDE} x {LARGEST_SIDE}"),
        ImageError::Unsupported(_) => "is neither PNG nor JPEG".to_owned(),
        _ => "is broken, or ends too early".to_owned(),
    };
    let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
    let mut reader = reader.map_err(|_| "can't be read".to_owned())?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_SIDE);
    limits.max_image_height = Some(LARGEST_SIDE);
    limits.max_alloc = Some(MOST_MEMORY);
    reader.limits(limits);
    let whole = reader.decode().map_err(told)?;
    let (width, height) = (whole.width(), whole.height());
    let is_long = width.max(height) > LONGEST_SIDE;
    let kept = match is_long {
        true => whole.thumbnail(LONGEST_SIDE, LONGEST_SIDE),
        false => whole,
    };
    let mut texels = kept.to_rgba16();
    for texel in texels.pixels_mut() {
        let [.., alpha] = &mut texel.0;
        *alpha = match clear {
            Clear::Nothing => u16::MAX,
            Clear::By(share) => (f32::from(*alpha) * share).round() as u16,
        };
    }
    let size = [texels.width(), texels.height()].map(|side| side as usize);
    let image = Image::from_srgb(size, texels.as_raw()).map_err(|error| error.to_string())?;
    let note = is_long.then(|| {
        let [across, down] = size;
        format!("of {width} x {height} is drawn as {across} x {down}")
    });
    Ok((image, note))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, ImageFormat, RgbaImage};

    const ALL: Clear = Clear::By(1.0);

    fn file(width: u32, height: u32, format: ImageFormat) -> Vec<u8> {
        let picture = RgbaImage::from_pixel(width, height, image::Rgba([255, 128, 0, 255]));
        let mut bytes = Cursor::new(Vec::new());
        let picture = DynamicImage::from(picture).to_rgb8();
        picture.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn png_and_jpeg_are_read_alike() {
        for format in [ImageFormat::Png, ImageFormat::Jpeg] {
            let (image, note) = decode(&file(8, 4, format), ALL).unwrap();
            assert_eq!((image.size(), note), ([8, 4], None));
            let [red, green, blue, alpha] = image.at([0.5; 2], 0.0, false);
            let expected = effects::linear_from_srgb(128.0 / 255.0) as f32;
            assert!(red > 0.98 && (green - expected).abs() < 0.01 && blue < 0.01);
            assert_eq!(alpha, 1.0);
        }
    }

    #[test]
    fn a_large_picture_is_made_smaller_and_that_is_told() {
        let (image, note) = decode(&file(4096, 8, ImageFormat::Png), ALL).unwrap();
        assert_eq!(image.size(), [2048, 4]);
        assert!(note.unwrap().contains("4096 x 8"));
    }

    #[test]
    fn alpha_counts_for_as_much_as_is_said() {
        let picture = RgbaImage::from_fn(2, 1, |x, _| image::Rgba([255, 0, 0, 255 * x as u8]));
        let mut bytes = Cursor::new(Vec::new());
        DynamicImage::from(picture)
            .write_to(&mut bytes, ImageFormat::Png)
            .unwrap();
        let texels = |clear| {
            let (image, _) = decode(bytes.get_ref(), clear).unwrap();
            [0.25, 0.75].map(|x| image.at([x, 0.5], 0.0, false))
        };
        let red = |alpha: f32| [1.0, 0.0, 0.0, alpha];
        assert_eq!(texels(ALL), [[0.0; 4], red(1.0)]);
        // Whole, it has its colour where its alpha is 0.
        assert_eq!(texels(Clear::Nothing), [red(1.0); 2]);
        let [clear, half] = texels(Clear::By(0.5));
        assert!(
            clear == [0.0; 4] && (half[3] - 0.5).abs() < 1e-3,
            "{half:?}"
        );
    }

    #[test]
    fn hostile_bytes_are_told() {
        let good = file(8, 8, ImageFormat::Png);
        for end in [0, 1, 8, 20, good.len() - 20] {
            assert!(decode(&good[..end], ALL).is_err(), "{end}");
        }
        let mut wide = good.clone();
        wide[16..20].copy_from_slice(&60_000_u32.to_be_bytes());
        assert!(decode(&wide, ALL).is_err());
        assert!(
            decode(b"GIF89a", ALL)
                .unwrap_err()
                .contains("neither PNG nor JPEG")
        );
    }
}
