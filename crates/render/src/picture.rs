//! A finished picture in linear light, and its way to 8 bits.

use effects::linear_from_srgb;
use rayon::prelude::*;
use std::sync::LazyLock;

/// A picture: linear light, premultiplied alpha, row by row from the upper left.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Red, green, blue, alpha of each pixel, 0 to 1.
    pub pixels: Vec<[f32; 4]>,
}

impl Picture {
    /// Straight-alpha 8-bit pixels, as PNG files hold them: red, green and blue in sRGB, alpha linear,
    /// each rounded to the nearest. A pixel without alpha is all 0.
    #[must_use]
    pub fn to_srgb8(&self) -> Vec<u8> {
        let encoder = &*ENCODER;
        let mut bytes = vec![[0; 4]; self.pixels.len()];
        bytes
            .par_chunks_mut(CHUNK)
            .zip(self.pixels.par_chunks(CHUNK))
            .for_each(|(bytes, pixels)| {
                // Flat colour comes many times in a row.
                let mut last = ([0.0; 4], [0; 4]);
                for (bytes, &pixel) in bytes.iter_mut().zip(pixels) {
                    if pixel != last.0 {
                        last = (pixel, encoder.encode_pixel(pixel));
                    }
                    *bytes = last.1;
                }
            });
        bytes.into_flattened()
    }
}

/// Pixels that one thread turns into bytes at a time.
const CHUNK: usize = 1024;

/// Buckets of the table that the search for a code starts from.
const BUCKETS: usize = 4096;

static ENCODER: LazyLock<SrgbEncoder> = LazyLock::new(SrgbEncoder::new);

/// Linear light to 8-bit sRGB by comparison with the 255 values where the code changes. No `powf`:
/// it has different bits on different machines.
struct SrgbEncoder {
    /// `thresholds[code]` is the least linear value of `code + 1`; infinite for 255.
    thresholds: [f64; 256],
    /// The code of each bucket's least value.
    first: [u8; BUCKETS],
}

impl SrgbEncoder {
    fn new() -> Self {
        let mut thresholds = [f64::INFINITY; 256];
        for code in 0..255 {
            thresholds[code] = linear_from_srgb((code as f64 + 0.5) / 255.0);
        }
        let mut first = [0; BUCKETS];
        for (bucket, code) in first.iter_mut().enumerate() {
            let least = bucket as f64 / BUCKETS as f64;
            *code = thresholds.partition_point(|&t| t <= least) as u8;
        }
        Self { thresholds, first }
    }

    /// Straight alpha of premultiplied.
    fn encode_pixel(&self, [red, green, blue, alpha]: [f32; 4]) -> [u8; 4] {
        // Also 0 for NaN, which no rasteriser makes.
        let alpha8 = (alpha.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        if alpha8 == 0 {
            return [0; 4];
        }
        let [red, green, blue] = [red, green, blue].map(|c| self.encode(c / alpha));
        [red, green, blue, alpha8]
    }

    fn encode(&self, linear: f32) -> u8 {
        let linear = f64::from(linear);
        if linear >= 1.0 {
            return 255;
        }
        // The cast sends NaN and negative numbers to 0.
        let bucket = (linear * BUCKETS as f64) as usize;
        let mut code = self.first[bucket];
        while linear >= self.thresholds[usize::from(code)] {
            code += 1;
        }
        code
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn encode(pixel: [f32; 4]) -> [u8; 4] {
        let picture = Picture {
            width: 1,
            height: 1,
            pixels: vec![pixel],
        };
        picture.to_srgb8().try_into().unwrap()
    }

    #[test]
    fn every_code_comes_back() {
        for code in 0..=255_u8 {
            let linear = linear_from_srgb(f64::from(code) / 255.0) as f32;
            assert_eq!(encode([linear, 0.0, 1.0, 1.0]), [code, 0, 255, 255]);
        }
    }

    #[test]
    fn pixels_are_each_by_itself() {
        let gray = |i: usize| (i / 3 % 7) as f32 / 7.0;
        let pixels: Vec<[f32; 4]> = (0..3000)
            .map(|i| [gray(i), 0.5 * gray(i), 0.0, gray(i + 5)])
            .collect();
        let each: Vec<u8> = pixels.iter().flat_map(|pixel| encode(*pixel)).collect();
        let picture = Picture {
            width: 3000,
            height: 1,
            pixels,
        };
        assert_eq!(picture.to_srgb8(), each);
    }

    #[test]
    fn alpha_is_linear_and_divided_out() {
        // Half covered by white is white at half alpha, not gray.
        assert_eq!(encode([0.5, 0.5, 0.5, 0.5]), [255, 255, 255, 128]);
        assert_eq!(encode([0.0, 0.0, 0.0, 0.0]), [0; 4]);
        assert_eq!(encode([0.001, 0.001, 0.001, 0.001]), [0; 4]);
    }

    #[test]
    fn numbers_out_of_range_are_clamped() {
        assert_eq!(encode([2.0, -1.0, f32::NAN, 1.0]), [255, 0, 0, 255]);
        assert_eq!(encode([f32::INFINITY, 0.0, 0.0, 7.0]), [255, 0, 0, 255]);
    }

    proptest! {
        #[test]
        fn is_the_nearest_code(linear in 0.0..=1.0_f32) {
            let encoded = if linear <= 0.003_130_8 {
                f64::from(linear) * 12.92
            } else {
                1.055 * f64::from(linear).powf(1.0 / 2.4) - 0.055
            };
            let [code, ..] = encode([linear, 0.0, 0.0, 1.0]);
            // The standard's two pieces meet to 8 digits only.
            prop_assert!((f64::from(code) - encoded * 255.0).abs() <= 0.5 + 1e-4);
        }
    }
}
