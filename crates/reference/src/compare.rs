//! How far a picture is from the reference.

use render::Picture;

/// How far around strokes errors count, in pixels.
const DILATION: i64 = 2;

/// How far a picture is from the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Mean colour difference over the mask. A pixel's difference is the largest absolute one of
    /// its four channels: linear light, premultiplied, 0 to 1.
    pub mean: f64,
    /// What 99 of 100 pixels of the mask do not exceed (nearest rank).
    pub percentile_99: f64,
    /// The picture's coverage (sum of alpha) over the reference's; 1 is right. It says something of
    /// strokes only where nothing else was drawn.
    pub ink_ratio: f64,
}

/// Why two pictures can't be compared.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CompareError {
    /// The pictures or the mask differ in size, or have another number of pixels than their size says.
    #[error(
        "the picture, its reference and the mask have {0}, {1} and {2} pixels, or differ in shape"
    )]
    Size(usize, usize, usize),
    /// The mask or the reference is empty, so that no mean exists.
    #[error("the reference shows no stroke")]
    Empty,
    /// A picture holds a number that is not finite.
    #[error("the difference at pixel {x}, {y} is not a finite number")]
    NotFinite {
        /// Column from the left.
        x: usize,
        /// Row from the top.
        y: usize,
    },
}

/// The pixels within 2 pixels (centre to centre) of a pixel that `strokes` covers at all, row by row.
///
/// `strokes` is the reference picture of the strokes alone: no background, no surfaces.
pub fn mask(strokes: &Picture) -> Vec<bool> {
    let (width, height) = (i64::from(strokes.width), i64::from(strokes.height));
    let mut mask = vec![false; strokes.pixels.len()];
    let disc: Vec<(i64, i64)> = (-DILATION..=DILATION)
        .flat_map(|dy| (-DILATION..=DILATION).map(move |dx| (dx, dy)))
        .filter(|(dx, dy)| dx * dx + dy * dy <= DILATION * DILATION)
        .collect();
    for (index, _) in (0..)
        .zip(&strokes.pixels)
        .filter(|(_, pixel)| pixel[3] > 0.0)
    {
        for (dx, dy) in &disc {
            let (x, y) = (index % width + dx, index / width + dy);
            if (0..width).contains(&x) && (0..height).contains(&y) {
                mask[(y * width + x) as usize] = true;
            }
        }
    }
    mask
}

/// The difference of `picture` from `reference` over the pixels of `mask`.
///
/// # Errors
///
/// If sizes differ, the mask or the reference is empty, or a difference is not finite.
pub fn error(
    picture: &Picture,
    reference: &Picture,
    mask: &[bool],
) -> Result<Difference, CompareError> {
    let pixels = u64::from(reference.width) * u64::from(reference.height);
    let lengths = [picture.pixels.len(), reference.pixels.len(), mask.len()];
    let same_shape = (picture.width, picture.height) == (reference.width, reference.height);
    if !same_shape || lengths.iter().any(|length| *length as u64 != pixels) {
        return Err(CompareError::Size(lengths[0], lengths[1], lengths[2]));
    }

    let mut differences = Vec::new();
    for index in (0..mask.len()).filter(|index| mask[*index]) {
        let channels = picture.pixels[index].iter().zip(&reference.pixels[index]);
        let channels = channels.map(|(a, b)| (f64::from(*a) - f64::from(*b)).abs());
        if !channels.clone().all(f64::is_finite) {
            let width = reference.width as usize;
            let (x, y) = (index % width, index / width);
            return Err(CompareError::NotFinite { x, y });
        }
        differences.push(channels.fold(0.0, f64::max));
    }
    let ink = |picture: &Picture| -> f64 { picture.pixels.iter().map(|p| f64::from(p[3])).sum() };
    if differences.is_empty() || ink(reference) == 0.0 {
        return Err(CompareError::Empty);
    }
    differences.sort_by(f64::total_cmp);
    let rank = (differences.len() * 99).div_ceil(100);
    Ok(Difference {
        mean: differences.iter().sum::<f64>() / differences.len() as f64,
        percentile_99: differences[rank - 1],
        ink_ratio: ink(picture) / ink(reference),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: u32, alphas: &[f32]) -> Picture {
        Picture {
            width,
            height: alphas.len() as u32 / width,
            pixels: alphas.iter().map(|alpha| [0.0, 0.0, 0.0, *alpha]).collect(),
        }
    }

    #[test]
    fn mask_is_a_disc_of_two_pixels() {
        let mut alphas = [0.0; 49];
        alphas[3 * 7 + 3] = 0.01;
        let rows: Vec<String> = mask(&picture(7, &alphas))
            .chunks(7)
            .map(|row| row.iter().map(|m| if *m { '#' } else { '.' }).collect())
            .collect();
        let expected = [
            ".......", "...#...", "..###..", ".#####.", "..###..", "...#...", ".......",
        ];
        assert_eq!(rows, expected);
    }

    #[test]
    fn mask_ends_at_the_border() {
        let mut alphas = [0.0; 8];
        alphas[0] = 1.0;
        let expected = [true, true, true, false, true, true, false, false];
        assert_eq!(mask(&picture(4, &alphas)), expected);
    }

    #[test]
    fn known_differences() {
        let reference = picture(200, &[0.5; 200]);
        let mut other = reference.clone();
        other.pixels[7] = [0.0, 0.0, 0.0, 1.0]; // 0.5 by alpha
        other.pixels[8] = [0.25, 0.0, 0.0, 0.5]; // 0.25 by red
        other.pixels[9] = [0.125, 0.0, 0.0625, 0.5]; // 0.125 by red
        other.pixels[10] = [0.0, 0.0, 0.0, 0.0]; // outside the mask
        let mut mask = vec![true; 200];
        mask[10] = false;
        let difference = error(&other, &reference, &mask).unwrap();
        assert_eq!(difference.mean, 0.875 / 199.0);
        // 198 of 199 pixels are 99.5 %, 197 are 98.99 %: the 198th is the first that reaches 99 %.
        assert_eq!(difference.percentile_99, 0.25);
        assert_eq!(difference.ink_ratio, 1.0);

        let twice = picture(200, &[1.0; 200]);
        assert_eq!(error(&twice, &reference, &mask).unwrap().ink_ratio, 2.0);
        assert_eq!(error(&reference, &reference, &mask).unwrap().mean, 0.0);
    }

    #[test]
    fn what_cannot_be_compared_is_an_error() {
        let reference = picture(4, &[1.0; 8]);
        let size = |picture: &Picture, mask: &[bool]| error(picture, &reference, mask).unwrap_err();
        assert!(matches!(
            size(&picture(2, &[1.0; 8]), &[true; 8]),
            CompareError::Size(..)
        ));
        assert!(matches!(
            size(&picture(4, &[1.0; 4]), &[true; 8]),
            CompareError::Size(..)
        ));
        assert!(matches!(
            size(&reference, &[true; 7]),
            CompareError::Size(..)
        ));
        assert_eq!(size(&reference, &[false; 8]), CompareError::Empty);
        let nothing = picture(4, &[0.0; 8]);
        assert_eq!(
            error(&reference, &nothing, &[true; 8]),
            Err(CompareError::Empty)
        );
        let mut broken = reference.clone();
        broken.pixels[5][1] = f32::NAN;
        assert_eq!(
            size(&broken, &[true; 8]),
            CompareError::NotFinite { x: 1, y: 1 }
        );
    }
}
