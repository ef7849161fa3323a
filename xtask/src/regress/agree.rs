//! Whether two backends drew the same picture, but for rounding.

use crate::flip;
use crate::picture::Picture;

/// Pixels that must differ by no more than [`STEPS`], as a share of those where something is drawn.
const LEAST_WITHIN: f64 = 0.999;
/// Of 255.
const STEPS: u16 = 2;
/// Most that FLIP may be, in the mean over the same pixels.
const MOST_FLIP: f64 = 0.005;
/// How far around what is drawn differences count, in pixels.
const DILATION: i32 = 2;

/// How far two pictures agree, over the pixels where something is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Share of pixels within 2 of 255 in every channel.
    pub within: f64,
    /// Mean FLIP.
    pub flip: f64,
}

impl Agreement {
    /// Compares two pictures of one size; nothing where nothing is drawn in either.
    pub fn of(expected: &Picture, actual: &Picture) -> Option<Self> {
        let mask = mask(expected, actual);
        let count = mask.iter().filter(|m| **m).count();
        if count == 0 {
            return None;
        }
        let pairs = expected.pixels.iter().zip(&actual.pixels);
        let is_within = |(a, b): (&[u16; 4], &[u16; 4])| {
            let channels = a.iter().zip(b);
            channels.clone().all(|(a, b)| a.abs_diff(*b) <= STEPS * 257)
        };
        let within = pairs
            .zip(&mask)
            .filter(|(pair, m)| **m && is_within(*pair))
            .count();
        let flip = if expected == actual {
            0.0
        } else {
            let differences = flip::differences(expected, actual);
            let seen = differences.iter().zip(&mask).filter(|(_, m)| **m);
            seen.map(|(difference, _)| difference).sum::<f64>() / count as f64
        };
        Some(Self {
            within: within as f64 / count as f64,
            flip,
        })
    }

    /// Whether that is agreement.
    pub fn holds(&self) -> bool {
        self.within >= LEAST_WITHIN && self.flip <= MOST_FLIP
    }

    /// The worse of two.
    pub fn worse(self, other: Self) -> Self {
        Self {
            within: self.within.min(other.within),
            flip: self.flip.max(other.flip),
        }
    }

    pub fn sentence(&self) -> String {
        format!(
            "{:.2} % of the pixels within {STEPS}/255 (at least {:.1} %), FLIP {:.4} (at most {MOST_FLIP})",
            100.0 * self.within,
            100.0 * LEAST_WITHIN,
            self.flip
        )
    }
}

/// The pixels near one that isn't background, in either picture. The background is the corner's colour: cases are framed
/// so that hair leaves a corner free, or fills all of it.
fn mask(expected: &Picture, actual: &Picture) -> Vec<bool> {
    let (width, height) = (expected.width as i32, expected.height as i32);
    let background = expected.pixels.first();
    let mut mask = vec![false; expected.pixels.len()];
    for (index, (a, b)) in (0..).zip(expected.pixels.iter().zip(&actual.pixels)) {
        if Some(a) == background && Some(b) == background {
            continue;
        }
        let (x, y) = (index % width, index / width);
        for row in (y - DILATION).max(0)..=(y + DILATION).min(height - 1) {
            for column in (x - DILATION).max(0)..=(x + DILATION).min(width - 1) {
                mask[(row * width + column) as usize] = true;
            }
        }
    }
    mask
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A dark line of some pixels' width across white, as a stroke is, `shift` pixels to the right.
    fn line(shift: u32) -> Picture {
        let pixel = |i: u32| {
            let x = (i % 64) as i32 - shift as i32;
            let gray = if (28..34).contains(&x) { 9000 } else { 65535 };
            [gray, gray, gray, 65535]
        };
        Picture {
            width: 64,
            height: 64,
            pixels: (0..4096).map(pixel).collect(),
        }
    }

    #[test]
    fn rounding_is_agreement() {
        let mut other = line(0);
        for pixel in other.pixels.iter_mut().step_by(97) {
            pixel[0] -= 2 * 257;
        }
        let found = Agreement::of(&line(0), &other).unwrap();
        assert!(found.holds(), "{}", found.sentence());
        let same = Agreement {
            within: 1.0,
            flip: 0.0,
        };
        assert_eq!(Agreement::of(&line(0), &line(0)), Some(same));
    }

    #[test]
    fn pictures_that_should_fail_do() {
        // Moved by a pixel; a stroke lost; another colour; a few pixels far off.
        let moved = Agreement::of(&line(0), &line(1)).unwrap();
        assert!(!moved.holds(), "{}", moved.sentence());
        let mut lost = line(0);
        lost.pixels.fill([65535; 4]);
        assert!(!Agreement::of(&line(0), &lost).unwrap().holds());
        let mut tinted = line(0);
        tinted.pixels.iter_mut().for_each(|p| p[1] -= 3 * 257);
        assert!(!Agreement::of(&line(0), &tinted).unwrap().holds());
        let mut specks = line(0);
        for pixel in [30, 900, 2000] {
            specks.pixels[pixel] = [0, 65535, 0, 65535];
        }
        assert!(!Agreement::of(&line(0), &specks).unwrap().holds());
    }

    #[test]
    fn an_empty_picture_says_nothing() {
        let mut empty = line(0);
        empty.pixels.fill([65535; 4]);
        assert_eq!(Agreement::of(&empty, &empty), None);
    }
}
