//! How different two pictures look when one flips between them: LDR-FLIP, by P. Andersson et al., "FLIP: A Difference
//! Evaluator for Alternating Images" (Proc. ACM Comput. Graph. Interact. Tech. 3, 2, 2020), whose names and
//! constants these are. 0 is the same, 1 as different as can be.

use crate::picture::Picture;

/// Pixels in a degree of the eye's field: the paper's monitor, 0.7 m away.
const PIXELS_PER_DEGREE: f64 = 67.0;
/// White of the D65 illuminant in XYZ.
const WHITE: [f64; 3] = [0.950_428_545, 1.0, 1.088_900_371];
/// Contrast sensitivity of each opponent channel: sums of two Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), each as (a, b).
const SENSITIVITY: [[(f64, f64); 2]; 3] = [
    [(1.0, 0.0047), (0.0, 1e-5)],
    [(1.0, 0.0053), (0.0, 1e-5)],
    [(34.1, 0.04), (13.5, 0.025)],
];
/// Exponent of colour differences, and where and to what the lower part of their range is mapped.
const Q_COLOR: f64 = 0.7;
const P_COLOR: f64 = 0.4;
const P_TARGET: f64 = 0.95;
/// Exponent of feature differences, and the width of features in degrees.
const Q_FEATURE: f64 = 0.5;
const FEATURE_DEGREES: f64 = 0.082;

type Channel = Vec<f64>;

/// FLIP's difference of each pixel, rows from the top. Transparent pixels are seen on black.
///
/// # Panics
/// The pictures differ in size.
pub fn differences(reference: &Picture, test: &Picture) -> Vec<f64> {
    assert_eq!(
        (reference.width, reference.height),
        (test.width, test.height)
    );
    let size = (reference.width as usize, reference.height as usize);
    let opponents = [reference, test].map(opponent_channels);
    let seen = [0, 1].map(|i| perceived(&opponents[i], size));
    let features = [0, 1].map(|i| Features::of(&opponents[i][0], size));
    let largest = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(Q_COLOR);
    (0..size.0 * size.1)
        .map(|pixel| {
            let color = hyab(seen[0][pixel], seen[1][pixel]).powf(Q_COLOR);
            let knee = P_COLOR * largest;
            let color = if color < knee {
                color * P_TARGET / knee
            } else {
                P_TARGET + (color - knee) / (largest - knee) * (1.0 - P_TARGET)
            };
            let edges = (features[0].edges[pixel] - features[1].edges[pixel]).abs();
            let points = (features[0].points[pixel] - features[1].points[pixel]).abs();
            let feature = (edges.max(points) / 2.0_f64.sqrt()).powf(Q_FEATURE);
            color.powf(1.0 - feature)
        })
        .collect()
}

/// Luminance and two colour channels, linear in light (YCxCz).
fn opponent_channels(picture: &Picture) -> [Channel; 3] {
    let mut channels = [(); 3].map(|()| Vec::with_capacity(picture.pixels.len()));
    for &[red, green, blue, alpha] in &picture.pixels {
        let linear = [red, green, blue].map(|c| linear(f64::from(c) / 65535.0));
        let shown = linear.map(|c| c * f64::from(alpha) / 65535.0);
        let [x, y, z] = relative_xyz(shown);
        let opponent = [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)];
        for (channel, value) in channels.iter_mut().zip(opponent) {
            channel.push(value);
        }
    }
    channels
}

/// IEC 61966-2-1.
fn linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [0.412_391, 0.357_584, 0.180_481],
    [0.212_639, 0.715_169, 0.072_192],
    [0.019_331, 0.119_195, 0.950_532],
];
const RGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.240_970, -1.537_383, -0.498_611],
    [-0.969_244, 1.875_968, 0.041_555],
    [0.055_630, -0.203_977, 1.056_972],
];

fn multiply(matrix: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// XYZ over that of white.
fn relative_xyz(rgb: [f64; 3]) -> [f64; 3] {
    let xyz = multiply(XYZ_FROM_RGB, rgb);
    [0, 1, 2].map(|i| xyz[i] / WHITE[i])
}

/// CIELAB of linear light, its colours less where it is dark (Hunt).
fn hunt_lab(rgb: [f64; 3]) -> [f64; 3] {
    let f = |t: f64| {
        let delta = 6.0_f64 / 29.0;
        if t > delta.powi(3) {
            t.cbrt()
        } else {
            t / (3.0 * delta * delta) + 4.0 / 29.0
        }
    };
    let [x, y, z] = relative_xyz(rgb).map(f);
    let lightness = 116.0 * y - 16.0;
    [
        lightness,
        0.01 * lightness * 500.0 * (x - y),
        0.01 * lightness * 200.0 * (y - z),
    ]
}

fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// What the eye sees at that distance, as colours whose distance counts.
fn perceived(opponents: &[Channel; 3], size: (usize, usize)) -> Vec<[f64; 3]> {
    let blurred = [0, 1, 2].map(|i| {
        let (first, second) = (SENSITIVITY[i][0], SENSITIVITY[i][1]);
        let weight = |(a, b): (f64, f64)| {
            let height = a * (std::f64::consts::PI / b).sqrt();
            height * gaussian(b).iter().sum::<f64>().powi(2)
        };
        let whole = weight(first) + weight(second);
        let mut sum = vec![0.0; opponents[i].len()];
        for part in [first, second].into_iter().filter(|(a, _)| *a > 0.0) {
            let share = weight(part) / whole;
            let kernel = normalized(gaussian(part.1));
            let part = convolved(&opponents[i], size, &kernel, &kernel);
            for (sum, value) in sum.iter_mut().zip(part) {
                *sum += share * value;
            }
        }
        sum
    });
    (0..blurred[0].len())
        .map(|pixel| {
            let [y, cx, cz] = [0, 1, 2].map(|i| blurred[i][pixel]);
            let y = (y + 16.0) / 116.0;
            let xyz = [cx / 500.0 + y, y, y - cz / 200.0];
            let xyz = [0, 1, 2].map(|i| xyz[i] * WHITE[i]);
            hunt_lab(multiply(RGB_FROM_XYZ, xyz).map(|c| c.clamp(0.0, 1.0)))
        })
        .collect()
}

/// exp(-pi^2 x^2 / b) at whole pixels, over the same width for all channels.
fn gaussian(b: f64) -> Vec<f64> {
    let widest = SENSITIVITY
        .iter()
        .flatten()
        .map(|(_, b)| *b)
        .fold(0.0, f64::max);
    let pi_squared = std::f64::consts::PI.powi(2);
    let radius = (3.0 * (widest / (2.0 * pi_squared)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    (-radius..=radius)
        .map(|x| (-pi_squared * (f64::from(x) / PIXELS_PER_DEGREE).powi(2) / b).exp())
        .collect()
}

fn normalized(kernel: Vec<f64>) -> Vec<f64> {
    let sum: f64 = kernel.iter().sum();
    kernel.into_iter().map(|value| value / sum).collect()
}

/// How much of an edge and of a point each pixel is.
struct Features {
    edges: Channel,
    points: Channel,
}

impl Features {
    fn of(luminance: &Channel, size: (usize, usize)) -> Self {
        let luminance: Channel = luminance.iter().map(|y| (y + 16.0) / 116.0).collect();
        let deviation = 0.5 * FEATURE_DEGREES * PIXELS_PER_DEGREE;
        let radius = (3.0 * deviation).ceil() as i32;
        let bell = |x: f64| (-x * x / (2.0 * deviation * deviation)).exp();
        let places = || (-radius..=radius).map(f64::from);
        let flat = normalized(places().map(bell).collect());
        let slope = balanced(places().map(|x| -x * bell(x)).collect());
        let bend = |x: f64| (x * x / (deviation * deviation) - 1.0) * bell(x);
        let bend = balanced(places().map(bend).collect());
        let strength = |kernel: &[f64]| -> Channel {
            let across = convolved(&luminance, size, kernel, &flat);
            let down = convolved(&luminance, size, &flat, kernel);
            across.iter().zip(down).map(|(x, y)| x.hypot(y)).collect()
        };
        Self {
            edges: strength(&slope),
            points: strength(&bend),
        }
    }
}

/// A kernel whose positive parts sum up to 1, and its negative ones to -1.
fn balanced(kernel: Vec<f64>) -> Vec<f64> {
    let positive: f64 = kernel.iter().filter(|v| **v > 0.0).sum();
    let negative: f64 = -kernel.iter().filter(|v| **v < 0.0).sum::<f64>();
    let scale = |v: f64| if v > 0.0 { v / positive } else { v / negative };
    kernel.into_iter().map(scale).collect()
}

/// A channel under the kernel that is `across` in x and `down` in y; its border goes on beyond it.
fn convolved(
    channel: &[f64],
    (width, height): (usize, usize),
    across: &[f64],
    down: &[f64],
) -> Channel {
    let near = |i: usize, offset: usize, kernel: &[f64], length: usize| {
        (i + offset)
            .saturating_sub(kernel.len() / 2)
            .min(length - 1)
    };
    let mut rows = vec![0.0; channel.len()];
    for y in 0..height {
        for x in 0..width {
            let taps = across.iter().enumerate();
            let sum =
                taps.map(|(k, weight)| weight * channel[y * width + near(x, k, across, width)]);
            rows[y * width + x] = sum.sum();
        }
    }
    let mut whole = vec![0.0; channel.len()];
    for y in 0..height {
        for x in 0..width {
            let taps = down.iter().enumerate();
            let sum = taps.map(|(k, weight)| weight * rows[near(y, k, down, height) * width + x]);
            whole[y * width + x] = sum.sum();
        }
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(rgb: [u16; 3]) -> Picture {
        let [r, g, b] = rgb;
        Picture {
            width: 24,
            height: 20,
            pixels: vec![[r, g, b, 65535]; 480],
        }
    }

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    #[test]
    fn the_same_picture_is_0_and_green_for_blue_is_1() {
        let (green, blue) = (plain([0, 65535, 0]), plain([0, 0, 65535]));
        assert_eq!(mean(&differences(&green, &green)), 0.0);
        let most = mean(&differences(&green, &blue));
        assert!((most - 1.0).abs() < 1e-6, "{most}");
    }

    /// Between black and white HyAB is 100, so that the paper's mapping can be worked out by hand.
    #[test]
    fn black_for_white_is_as_the_paper_maps_it() {
        let largest = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(0.7);
        let knee = 0.4 * largest;
        let expected = 0.95 + (100.0_f64.powf(0.7) - knee) / (largest - knee) * 0.05;
        let found = mean(&differences(&plain([0; 3]), &plain([65535; 3])));
        assert!((found - expected).abs() < 1e-3, "{found} {expected}");
    }

    /// A thin line is an edge and a point: it counts for more than its colour alone, which the eye blurs.
    #[test]
    fn a_line_that_is_lost_is_found_where_it_was() {
        let gray = plain([30000; 3]);
        let mut lined = gray.clone();
        for y in 0..20 {
            lined.pixels[y * 24 + 12] = [20000, 20000, 20000, 65535];
        }
        let found = differences(&gray, &lined);
        let opponents = [&gray, &lined].map(opponent_channels);
        let [a, b] = [0, 1].map(|i| perceived(&opponents[i], (24, 20))[10 * 24 + 12]);
        let largest = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(Q_COLOR);
        let color = hyab(a, b).powf(Q_COLOR) * P_TARGET / (P_COLOR * largest);
        assert!(
            found[10 * 24 + 12] > 1.2 * color,
            "{} {color}",
            found[10 * 24 + 12]
        );
        assert!(found[10 * 24 + 12] > 3.0 * found[10 * 24 + 2]);
    }
}
