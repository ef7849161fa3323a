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
/// 1, 2, 4 and 8 samples lie in Vulkan's standard positions, so that pictures can be compared with a graphics
/// card's. Its 16 lie 1/32 of a pixel beside the pixel's middle in the mean, and all edges with them: these ones don't, and are a
/// third nearer to how much of a pixel lies beyond an edge. Any other count up to [`MAX_SAMPLES`] is a lattice by the golden
/// section: even in both directions, and its mean close to the pixel's middle.
///
/// # Errors
///
/// When the count is 0 or above [`MAX_SAMPLES`].
pub fn sample_positions(samples: u32) -> Result<Vec<Vec2>, SampleCountError> {
    match samples {
        16 => Ok(even_16().to_vec()),
        1..=MAX_SAMPLES => {
            Ok(standard_positions(samples).unwrap_or_else(|| golden_lattice(samples)))
        }
        _ => Err(SampleCountError(samples)),
    }
}

/// Where the samples of a render pass with 1, 2, 4, 8 or 16 a pixel lie (Vulkan specification, "Multisampling", table of
/// standard sample locations); nothing for other counts.
pub(crate) fn standard_positions(samples: u32) -> Option<Vec<Vec2>> {
    let sixteenths: &[[u8; 2]] = match samples {
        1 => &[[8, 8]],
        2 => &[[12, 12], [4, 4]],
        4 => &[[6, 2], [14, 6], [2, 10], [10, 14]],
        8 => &STANDARD_8,
        16 => &STANDARD_16,
        _ => return None,
    };
    Some(sixteenths.iter().map(|at| place(*at, 16.0)).collect())
}

/// A place in a pixel, of which a side is so many parts long.
fn place([x, y]: [u8; 2], parts: f32) -> Vec2 {
    Vec2::new(f32::from(x), f32::from(y)) / parts
}

/// Sixteen places found by simulated annealing, so that they tell best how much of a pixel lies beyond a straight edge, in the mean
/// of all edges and at the worst angle. Each has its mirror image in the pixel's middle, which is thus their mean; each four after
/// the other are those of a quarter of the pixel, as some pictures are looked up once for four.
fn even_16() -> [Vec2; 16] {
    let upper = UPPER_OF_16.map(|at| place(at, 64.0));
    std::array::from_fn(|k| match upper.get(k) {
        Some(at) => *at,
        None => 1.0 - upper[15 - k],
    })
}

/// Those of the upper half, in 1/64 of a pixel.
const UPPER_OF_16: [[u8; 2]; 8] = [
    [9, 7],
    [29, 5],
    [5, 25],
    [21, 19],
    [39, 29],
    [41, 9],
    [53, 23],
    [57, 9],
];

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
            let mean = positions.iter().sum::<Vec2>() / samples as f32;
            // Lattices of odd counts are off most.
            let most = if standard_positions(samples).is_some() {
                0.0
            } else {
                0.06
            };
            assert!(
                mean.distance(Vec2::splat(0.5)) <= most,
                "{samples} samples: mean {mean}"
            );
        }
    }

    /// How much of a pixel lies before a straight edge, `at` from its middle along the edge's normal.
    fn share_before(normal: Vec2, at: f32) -> f32 {
        let [a, b] = normal.abs().to_array().map(f64::from);
        let t = f64::from(at) + (a + b) / 2.0;
        let square = |x: f64| x.max(0.0).powi(2);
        ((square(t) - square(t - a) - square(t - b) + square(t - a - b)) / (2.0 * a * b)) as f32
    }

    /// By how much samples are wrong in that, in the mean of edges all over the pixel, at all angles and at the worst one.
    fn wrong_beside_edges(positions: &[Vec2]) -> [f32; 2] {
        const ANGLES: usize = 90;
        const EDGES: usize = 41;
        let of_angle = |k: usize| {
            let normal = Vec2::from_angle((k as f32 + 0.5) / ANGLES as f32 * std::f32::consts::PI);
            // Edges farther off don't go through the pixel.
            let reach = (normal.x.abs() + normal.y.abs()) / 2.0;
            let wrong = (0..EDGES).map(|edge| {
                let at = reach * ((edge as f32 + 0.5) / EDGES as f32 * 2.0 - 1.0);
                let is_before = |p: &&Vec2| normal.dot(**p - 0.5) < at;
                let sampled = positions.iter().filter(is_before).count();
                (sampled as f32 / positions.len() as f32 - share_before(normal, at)).abs()
            });
            wrong.sum::<f32>() / EDGES as f32 * reach
        };
        let of_angles: [f32; ANGLES] = std::array::from_fn(of_angle);
        // How far edges of all angles reach in the mean.
        const REACH: f32 = 2.0 / std::f32::consts::PI;
        [
            of_angles.iter().sum::<f32>() / ANGLES as f32 / REACH,
            of_angles.into_iter().fold(0.0, f32::max) / REACH,
        ]
    }

    #[test]
    fn sixteen_are_a_third_nearer_than_the_standards() {
        let [mean, worst] = wrong_beside_edges(&sample_positions(16).unwrap());
        let [standard, standard_worst] = wrong_beside_edges(&standard_positions(16).unwrap());
        assert!(
            mean < 0.7 * standard && worst < 0.7 * standard_worst,
            "{mean} and {worst}; by the standard {standard} and {standard_worst}"
        );
        // What no sixteen samples can be below, as shares are sixteenths: 1/64.
        assert!(mean < 1.6 / 64.0, "{mean}");
    }

    #[test]
    fn each_four_of_sixteen_are_those_of_a_quarter() {
        let quarters: Vec<_> = sample_positions(16)
            .unwrap()
            .chunks(4)
            .map(|four| four.iter().sum::<Vec2>() / 4.0)
            .collect();
        let middles = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]].map(Vec2::from);
        for (quarter, middle) in quarters.iter().zip(middles) {
            assert!(quarter.distance(middle) < 0.05, "{quarter}");
        }
    }

    /// Every standard pattern but 2's has each sample in a column and a row of its own.
    #[test]
    fn standard_positions_share_no_row_or_column() {
        for samples in [4_u32, 8, 16] {
            for axis in 0..2 {
                let mut cells: Vec<u32> = standard_positions(samples)
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
