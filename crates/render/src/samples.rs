//! Where in a pixel the samples lie.

use glam::{DVec2, Vec2};

/// Most samples in a pixel.
pub const MAX_SAMPLES: u32 = 256;

/// A number of samples that no picture is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0} samples in a pixel: 1 to {MAX_SAMPLES} are possible")]
pub struct SampleCountError(pub u32);

/// The samples of a pixel, from its upper left corner, in pixels: each in 0..1 by 0..1.
///
/// 1, 2, 4, 8 and 16 samples lie in Vulkan's standard positions (Vulkan specification, "Multisampling",
/// table of standard sample locations), so that pictures can be compared with a graphics card's. Any
/// other count up to [`MAX_SAMPLES`] is a lattice by the golden section: even in both directions, and
/// its mean close to the pixel's middle.
///
/// # Errors
///
/// When the count is 0 or above [`MAX_SAMPLES`].
pub fn sample_positions(samples: u32) -> Result<Vec<Vec2>, SampleCountError> {
    if !(1..=MAX_SAMPLES).contains(&samples) {
        return Err(SampleCountError(samples));
    }
    let sixteenths: &[[u8; 2]] = match samples {
        1 => &[[8, 8]],
        2 => &[[12, 12], [4, 4]],
        4 => &[[6, 2], [14, 6], [2, 10], [10, 14]],
        8 => &STANDARD_8,
        16 => &STANDARD_16,
        _ => return Ok(golden_lattice(samples)),
    };
    Ok(sixteenths
        .iter()
        .map(|&[x, y]| Vec2::new(f32::from(x), f32::from(y)) / 16.0)
        .collect())
}

const STANDARD_8: [[u8; 2]; 8] = [
    [9, 5],
    [7, 11],
    [13, 9],
    [5, 3],
    [3, 13],
    [1, 7],
    [11, 15],
    [15, 1],
];

const STANDARD_16: [[u8; 2]; 16] = [
    [9, 9],
    [7, 5],
    [5, 10],
    [12, 7],
    [3, 6],
    [10, 13],
    [13, 11],
    [11, 3],
    [6, 14],
    [8, 1],
    [4, 2],
    [2, 12],
    [0, 8],
    [15, 4],
    [14, 15],
    [1, 0],
];

/// One sample in each of so many columns, each row the golden section of 1 from the one before.
fn golden_lattice(samples: u32) -> Vec<Vec2> {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    (0..samples)
        .map(|i| {
            let x = (f64::from(i) + 0.5) / f64::from(samples);
            let y = (0.5 + f64::from(i) * GOLDEN).fract();
            DVec2::new(x, y).as_vec2()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_counts_lie_in_the_pixel_and_apart() {
        for samples in 1..=MAX_SAMPLES {
            let positions = sample_positions(samples).unwrap();
            assert_eq!(positions.len(), samples as usize);
            for (i, p) in positions.iter().enumerate() {
                assert!(p.cmpge(Vec2::ZERO).all() && p.cmplt(Vec2::ONE).all());
                let apart = positions[..i]
                    .iter()
                    .all(|q| p.distance(*q) > 0.6 / (samples as f32).sqrt());
                assert!(apart, "{samples} samples: {p} lies on another");
            }
            // The standard pattern of 16 has a mean of 15 / 32.
            let mean = positions.iter().sum::<Vec2>() / samples as f32;
            assert!(
                mean.distance(Vec2::splat(0.5)) < 0.06,
                "{samples} samples: mean {mean}"
            );
        }
    }

    /// Every standard pattern but 2's has each sample in a column and a row of its own.
    #[test]
    fn standard_positions_share_no_row_or_column() {
        for samples in [4_u32, 8, 16] {
            for axis in 0..2 {
                let mut cells: Vec<u32> = sample_positions(samples)
                    .unwrap()
                    .iter()
                    .map(|p| (p[axis] * samples as f32) as u32)
                    .collect();
                cells.sort_unstable();
                assert_eq!(cells, (0..samples).collect::<Vec<_>>());
            }
        }
        assert_eq!(
            sample_positions(4).unwrap()[1],
            Vec2::new(0.875, 0.375),
            "the order is part of the standard"
        );
    }

    #[test]
    fn other_counts_are_errors() {
        assert_eq!(sample_positions(0), Err(SampleCountError(0)));
        let error = sample_positions(257).unwrap_err();
        assert_eq!(
            error.to_string(),
            "257 samples in a pixel: 1 to 256 are possible"
        );
    }
}
