//! `render --pass`: what samples tell, as pictures.

use clap::ValueEnum;
use hair_io::strands_ron::MIRROR;
use render::{Feature, Features, SamplePlanes};
use std::io;

/// A picture of one feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Pass {
    /// How near: 50 % gray at the camera's distance, white 2 head heights nearer, black 2 farther; 16 bits
    Depth,
    /// The normal as the eye has it: red to the right, green up, blue to the eye, 50 % is 0; 16 bits
    Normal,
    /// A colour for each thing: the hair of each object, heads, clothes, ornaments; colours don't mix
    Object,
    /// A colour for each strand
    Strand,
    /// A colour for each piece of strands that curl over themselves
    Piece,
    /// A colour for each layer
    Layer,
    /// A colour for each of the clump's levels
    Level,
    /// Place along the strand, black at the root and white at the tip; 16 bits
    U,
    /// Length of hair from the root, white at 4 head heights; 16 bits
    S,
    /// Place across the stroke, from black on the left to white on the right of who looks from root to tip; 16 bits
    V,
    /// The same across the clump; 16 bits
    W,
    /// How large hair is drawn: the pixels of a head height there, white at 4096; 16 bits
    Pixels,
}

/// Head heights before and behind the camera's distance that `depth` shows, the length that is white in `s`, and the height of a head that is
/// white in `pixels`.
const DEPTH_REACH: f32 = 2.0;
const LONGEST: f32 = 4.0;
const LARGEST: f32 = 4096.0;

impl Pass {
    /// What is asked of samples.
    pub fn feature(self) -> Feature {
        match self {
            Self::Depth => Feature::InvDepth,
            Self::Normal => Feature::Normal,
            Self::Object => Feature::Object,
            Self::Strand => Feature::Strand,
            Self::Piece => Feature::Piece,
            Self::Layer => Feature::Layer,
            Self::Level => Feature::Level,
            Self::U => Feature::U,
            Self::S => Feature::S,
            Self::V => Feature::V,
            Self::W => Feature::W,
            Self::Pixels => Feature::Pixels,
        }
    }

    /// What a frame is to declare. Ids and places along and across hair are told apart from nothing by the strand.
    pub fn features(self) -> Features {
        Features::of(&[self.feature(), Feature::Strand])
    }

    /// How many samples a pixel it takes, of those of the picture: ids don't mix, and take the one in the pixel's middle.
    pub fn samples(self, of_picture: u32) -> u32 {
        if self.feature().is_id() {
            1
        } else {
            of_picture
        }
    }

    /// Whether only hair has it.
    fn is_of_hair(self) -> bool {
        !matches!(self, Self::Depth | Self::Normal | Self::Object)
    }
}

/// What numbers of a scene become in a picture.
#[derive(Clone, Copy)]
pub(crate) struct Scale {
    /// The head's height, metres.
    pub head_m: f32,
    /// From the eye to what it looks at, metres.
    pub distance_m: f32,
    /// The camera's axes in the world: right, up, to the eye.
    pub axes: [glam::Vec3; 3],
}

/// A picture of a pass, as a PNG file holds it.
pub(crate) struct PassPicture {
    pub size: [u32; 2],
    pub channels: Channels,
}

/// Its pixels: the last channel is alpha.
pub(crate) enum Channels {
    Ids(Vec<[u8; 4]>),
    Gray(Vec<[u16; 2]>),
    Vectors(Vec<[u16; 4]>),
}

/// Gathers the samples of a pass.
pub(crate) struct Gathered {
    pass: Pass,
    scale: Scale,
    size: [u32; 2],
    samples: u32,
    /// Of each pixel the sum of up to three numbers, and how many samples there are.
    sums: Vec<[f32; 4]>,
    ids: Vec<[u8; 4]>,
}

impl Gathered {
    pub fn new(pass: Pass, scale: Scale, size: [u32; 2], samples: u32) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        let (sums, ids) = match pass.feature().is_id() {
            true => (0, pixels),
            false => (pixels, 0),
        };
        Self {
            pass,
            scale,
            size,
            samples,
            sums: vec![[0.0; 4]; sums],
            ids: vec![[0; 4]; ids],
        }
    }

    /// Adds some samples of all pixels.
    pub fn add(&mut self, planes: &SamplePlanes) {
        let [width, height] = self.size.map(|side| side as usize);
        for picture in 0..planes.samples().len() {
            for y in 0..height {
                let row = y * width..(y + 1) * width;
                if self.pass.feature().is_id() {
                    self.add_ids(planes, picture, y, row);
                } else {
                    self.add_numbers(planes, picture, y, row);
                }
            }
        }
    }

    fn add_ids(
        &mut self,
        planes: &SamplePlanes,
        picture: usize,
        y: usize,
        row: std::ops::Range<usize>,
    ) {
        let ids = planes.ids(picture, self.pass.feature(), y);
        let objects = planes.ids(picture, Feature::Object, y);
        for ((pixel, id), object) in self.ids[row].iter_mut().zip(ids).zip(objects) {
            let is_hair = object % 2 == 1;
            if *object != 0 && (is_hair || !self.pass.is_of_hair()) {
                // Strands have their numbers within an object; pieces, layers and levels in the whole frame.
                *pixel = match self.pass {
                    Pass::Strand => color_of(low_id(*id, object / 2)),
                    _ => color_of(*id),
                };
            }
        }
    }

    fn add_numbers(
        &mut self,
        planes: &SamplePlanes,
        picture: usize,
        y: usize,
        row: std::ops::Range<usize>,
    ) {
        let feature = self.pass.feature();
        let components = feature.components();
        let objects = planes.ids(picture, Feature::Object, y);
        let numbers =
            [0, 1, 2].map(|i: usize| planes.numbers(picture, feature, i.min(components - 1), y));
        for (x, sum) in self.sums[row].iter_mut().enumerate() {
            let object = objects[x];
            if object == 0 || (object.is_multiple_of(2) && self.pass.is_of_hair()) {
                continue;
            }
            let sample = match self.pass {
                // The mean is of depths, not of what they are kept as.
                Pass::Depth => [1.0 / numbers[0][x], 0.0, 0.0],
                _ => numbers.map(|row| row[x]),
            };
            for (sum, number) in sum.iter_mut().zip(sample.into_iter().chain([1.0])) {
                *sum += number;
            }
        }
    }

    /// The picture of all samples that were added.
    pub fn finish(self) -> PassPicture {
        let Self {
            pass,
            scale,
            size,
            samples,
            sums,
            ids,
        } = self;
        let coverage = |count: f32| bits(count / samples as f32);
        let gray = |value: &dyn Fn(f32) -> f32| {
            let pixel = |[sum, _, _, count]: &[f32; 4]| match *count > 0.0 {
                true => [bits(value(sum / count)), coverage(*count)],
                false => [0; 2],
            };
            Channels::Gray(sums.iter().map(pixel).collect())
        };
        let channels = match pass {
            Pass::Depth => gray(&|depth| {
                let nearer = (scale.distance_m - depth) / scale.head_m;
                0.5 + 0.5 * nearer / DEPTH_REACH
            }),
            Pass::U => gray(&|u| u),
            Pass::S => gray(&|s| s / LONGEST),
            Pass::Pixels => gray(&|pixels| pixels / LARGEST),
            Pass::V | Pass::W => gray(&|place| 0.5 + 0.5 * place),
            Pass::Normal => {
                let pixel = |[x, y, z, count]: &[f32; 4]| {
                    let normal = glam::Vec3::new(*x, *y, *z).normalize_or_zero();
                    let [x, y, z] = scale.axes.map(|axis| bits(0.5 + 0.5 * axis.dot(normal)));
                    match *count > 0.0 {
                        true => [x, y, z, coverage(*count)],
                        false => [0; 4],
                    }
                };
                Channels::Vectors(sums.iter().map(pixel).collect())
            }
            Pass::Object | Pass::Strand | Pass::Piece | Pass::Layer | Pass::Level => {
                Channels::Ids(ids)
            }
        };
        PassPicture { size, channels }
    }
}

/// A number from 0 to 1 in 16 bits.
fn bits(value: f32) -> u16 {
    (value.clamp(0.0, 1.0) * 65_535.0 + 0.5) as u16
}

/// A strand's id in 24 bits: the id of its original where it is a mirror image, with the bit of these at the top, and from there down the number of
/// its object, the last bit first. So strands share one only where there are millions of them, or thousands in each of hundreds of objects.
fn low_id(strand: u32, object: u32) -> u32 {
    let mirrored = (strand & MIRROR) >> 8;
    let of_object = object.reverse_bits() >> 9;
    (strand ^ mirrored ^ of_object) & 0xFF_FFFF
}

/// The colour of an id: another one for each below 2^24, far from its neighbours'.
fn color_of(id: u32) -> [u8; 4] {
    let low = id & 0xFF_FFFF;
    // Steps that undo one by one, so that no two ids meet: products with odd numbers, and sums with what is shifted down.
    let mixed = low.wrapping_add(1).wrapping_mul(0x9E_3779) & 0xFF_FFFF;
    let mixed = (mixed ^ (mixed >> 12)).wrapping_mul(0xC2_B2AF) & 0xFF_FFFF;
    let [red, green, blue, _] = (mixed ^ (mixed >> 11)).to_le_bytes();
    [red, green, blue, 255]
}

impl PassPicture {
    /// The picture as a PNG file: numbers, not colours of light.
    pub fn encode(&self) -> io::Result<Vec<u8>> {
        let (color, depth, bytes): (_, _, Vec<u8>) = match &self.channels {
            Channels::Ids(pixels) => (
                png::ColorType::Rgba,
                png::BitDepth::Eight,
                pixels.as_flattened().to_vec(),
            ),
            Channels::Gray(pixels) => (
                png::ColorType::GrayscaleAlpha,
                png::BitDepth::Sixteen,
                big_endian(pixels.as_flattened()),
            ),
            Channels::Vectors(pixels) => (
                png::ColorType::Rgba,
                png::BitDepth::Sixteen,
                big_endian(pixels.as_flattened()),
            ),
        };
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.size[0], self.size[1]);
        encoder.set_depth(depth);
        encoder.set_color(color);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&bytes)?;
        writer.finish()?;
        Ok(file)
    }
}

fn big_endian(numbers: &[u16]) -> Vec<u8> {
    numbers
        .iter()
        .flat_map(|number| number.to_be_bytes())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn strands_of_all_objects_and_mirror_images_are_told_apart() {
        let strands = (0..500).flat_map(|id| [id, id | MIRROR]);
        let low: HashSet<u32> = strands
            .flat_map(|id| (0..1000).map(move |object| low_id(id, object)))
            .collect();
        assert_eq!(low.len(), 1_000_000);
        // Those of one object are as they are.
        assert!((0..10_000).all(|id| low_id(id, 0) == id));
    }

    #[test]
    fn ids_have_colors_of_their_own() {
        let colors: HashSet<[u8; 4]> = (0..1 << 24).step_by(17).map(color_of).collect();
        assert_eq!(colors.len(), (1_usize << 24).div_ceil(17));
        let neighbours = (0..1000).map(|id| {
            let (a, b) = (color_of(id), color_of(id + 1));
            a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max()
        });
        let far = neighbours
            .filter(|difference| *difference > Some(40))
            .count();
        assert!(far > 950, "{far} of 1000 neighbours are told apart");
    }
}
