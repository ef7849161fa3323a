//! What a tile's pixels get of their samples.

use super::{STACK, Stack, Target, WIDTH};

/// A pixel of so many samples that nothing covers.
pub(in crate::cpu) fn empty_pixel(background: Option<[f32; 3]>, samples: usize) -> [f32; 4] {
    let Some([red, green, blue]) = background else {
        return [0.0; 4];
    };
    // As in `Sums`, so that a pixel is the same beside strokes and far from them.
    [red, green, blue, 1.0].map(|value| {
        let value = value.clamp(0.0, 1.0);
        (0..samples).fold(0.0, |sum, _| sum + value) / samples as f32
    })
}

/// The sums over the samples of a tile's pixels, row by row: of red, green, blue and alpha.
pub(in crate::cpu) struct Sums([Vec<[f32; WIDTH]>; 4]);

impl Sums {
    pub(in crate::cpu) fn new() -> Self {
        Self([const { Vec::new() }; 4])
    }

    /// Forgets them; a tile is then so many pixels high.
    #[inline(always)]
    pub(in crate::cpu) fn clear(&mut self, height: usize) {
        for rows in &mut self.0 {
            rows.clear();
            rows.resize(height, [0.0; WIDTH]);
        }
    }

    /// Adds the samples of the target, which are such stacks. Light beyond 0..1 counts as 0 or 1.
    #[inline(always)]
    pub(in crate::cpu) fn add(&mut self, target: &mut Target, stack: &Stack, is_opaque: bool) {
        target.finish(stack, is_opaque);
        match stack.height {
            1 => self.add_pixels::<1>(target),
            2 => self.add_pixels::<2>(target),
            4 => self.add_pixels::<4>(target),
            _ => self.add_pixels::<8>(target),
        }
    }

    /// The same, of finished stacks of that many pixels.
    #[inline(always)]
    fn add_pixels<const HEIGHT: usize>(&mut self, target: &Target) {
        let of_pixel = STACK / HEIGHT;
        let [red, green, blue] = &target.color;
        for (rows, light) in self.0.iter_mut().zip([red, green, blue, &target.surface]) {
            let (light, _) = light.as_flattened().as_chunks::<{ WIDTH * STACK }>();
            for (sums, light) in rows.chunks_exact_mut(HEIGHT).zip(light) {
                for (below, sums) in sums.iter_mut().enumerate() {
                    for column in 0..WIDTH {
                        let first = column * STACK + below * of_pixel;
                        let mut sum = sums[column];
                        for k in 0..of_pixel {
                            sum += light[first + k];
                        }
                        sums[column] = sum;
                    }
                }
            }
        }
    }

    /// The means, as the pixels of one row.
    #[inline(always)]
    pub(in crate::cpu) fn write(&self, row: usize, samples: usize, pixels: &mut [[f32; 4]]) {
        let count = samples as f32;
        let [red, green, blue, alpha] = self.0.each_ref().map(|rows| &rows[row]);
        for (column, pixel) in pixels.iter_mut().enumerate().take(WIDTH) {
            let sums = [red[column], green[column], blue[column], alpha[column]];
            for channel in 0..4 {
                pixel[channel] = sums[channel] / count;
            }
        }
    }
}
