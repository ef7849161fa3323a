//! Measures on pictures: colours in linear light, how much of a column a colour fills.

use crate::picture::Picture;

/// Linear red, green and blue, 0 to 1.
pub type Rgb = [f64; 3];

pub const WHITE: Rgb = [1.0; 3];

/// The linear colour of a hex colour's six digits, `0x3FC1C0`.
pub fn rgb(hex: u32) -> Rgb {
    [16, 8, 0].map(|shift| linear(f64::from((hex >> shift) & 0xFF) / 255.0))
}

fn linear(srgb: f64) -> f64 {
    if srgb <= 0.04045 {
        srgb / 12.92
    } else {
        ((srgb + 0.055) / 1.055).powf(2.4)
    }
}

/// The linear colour of a pixel; what is transparent counts as it is stored.
pub fn color(pixel: [u16; 4]) -> Rgb {
    [0, 1, 2].map(|i| linear(f64::from(pixel[i]) / 65535.0))
}

/// How far a pixel is on the way between two colours, 0 to 1: what an antialiased edge is covered by.
pub fn way(pixel: [u16; 4], from: Rgb, to: Rgb) -> f64 {
    let here = color(pixel);
    let dot = |a: Rgb, b: Rgb| {
        (0..3)
            .map(|i| (a[i] - from[i]) * (b[i] - from[i]))
            .sum::<f64>()
    };
    (dot(here, to) / dot(to, to)).clamp(0.0, 1.0)
}

/// Whether a pixel has a colour, but for the rounding to 8 bits.
pub fn is(pixel: [u16; 4], wanted: Rgb) -> bool {
    let here = color(pixel);
    pixel[3] > 0 && (0..3).all(|i| (here[i] - wanted[i]).abs() < 0.02)
}

/// Pixels of a colour.
pub fn count(picture: &Picture, wanted: Rgb) -> usize {
    picture.pixels.iter().filter(|p| is(**p, wanted)).count()
}

/// For each column, how many pixels of it are on the way from one colour to the other, edges in part.
pub fn column_fill(picture: &Picture, from: Rgb, to: Rgb) -> Vec<f64> {
    (0..picture.width)
        .map(|x| picture.column(x).map(|p| way(p, from, to)).sum())
        .collect()
}

/// How often a colour begins on the way down a column.
pub fn runs_in_column(picture: &Picture, x: u32, wanted: Rgb) -> usize {
    let hits: Vec<bool> = picture.column(x).map(|p| is(p, wanted)).collect();
    hits.windows(2).filter(|pair| !pair[0] && pair[1]).count()
}

/// Neighbouring pixels, one of each colour: the length of the border between them, in pixels.
pub fn border(picture: &Picture, a: Rgb, b: Rgb) -> usize {
    let mut length = 0;
    for y in 0..picture.height {
        for x in 0..picture.width {
            let here = picture.pixel(x, y);
            let mut meets = |other: [u16; 4]| {
                let (here, other) = (way(here, a, b) < 0.5, way(other, a, b) < 0.5);
                length += usize::from(here != other);
            };
            let is_of_both = |p: [u16; 4]| on_the_way(p, a, b);
            if !is_of_both(here) {
                continue;
            }
            if x + 1 < picture.width && is_of_both(picture.pixel(x + 1, y)) {
                meets(picture.pixel(x + 1, y));
            }
            if y + 1 < picture.height && is_of_both(picture.pixel(x, y + 1)) {
                meets(picture.pixel(x, y + 1));
            }
        }
    }
    length
}

/// Whether a pixel is a mix of two colours, and of nothing else.
fn on_the_way(pixel: [u16; 4], a: Rgb, b: Rgb) -> bool {
    let here = color(pixel);
    let t = way(pixel, a, b);
    (0..3).all(|i| (a[i] + t * (b[i] - a[i]) - here[i]).abs() < 0.02)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three columns: white, half covered by black, black; two rows.
    fn ramp() -> Picture {
        // sRGB 188 is half of the light.
        let gray = |value: u16| [value * 257, value * 257, value * 257, u16::MAX];
        Picture {
            width: 3,
            height: 2,
            pixels: [gray(255), gray(188), gray(0)].repeat(2),
        }
    }

    #[test]
    fn coverage_is_measured_in_linear_light() {
        let black = rgb(0);
        let fill = column_fill(&ramp(), WHITE, black);
        assert!(fill[0].abs() < 1e-9);
        assert!((fill[1] - 1.0).abs() < 0.01, "{fill:?}");
        assert!((fill[2] - 2.0).abs() < 1e-9);
        assert_eq!(count(&ramp(), black), 2);
        assert_eq!(runs_in_column(&ramp(), 2, black), 0);
    }

    #[test]
    fn a_straight_border_is_as_long_as_it_is() {
        assert_eq!(border(&ramp(), WHITE, rgb(0)), 2);
        assert_eq!(border(&ramp(), WHITE, rgb(0xFF0000)), 0);
    }
}
