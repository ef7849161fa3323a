//! A picture on a surface, in double precision.

use glam::DVec2;
use render::{Coverage, SurfaceTexture};

/// A picture as a sample sees it that lies in one point: between the middles of the four nearest texels. Smaller copies are for those who look
/// it up once for several samples; here the mean of many samples blurs.
#[derive(Debug)]
pub struct Texture {
    size: [usize; 2],
    /// Row by row from the top, linear, colours multiplied by coverage.
    texels: Vec<[f64; 4]>,
    repeats: bool,
    /// There is nothing where coverage is below this. Where coverage is a share of samples all are there: which ones is the rasterisers' choice.
    pub cut: f64,
}

impl From<&SurfaceTexture> for Texture {
    fn from(texture: &SurfaceTexture) -> Self {
        let (size, texels) = texture.image.level(0);
        Self {
            size,
            texels: texels
                .iter()
                .map(|texel| texel.map(|x| x.to_f64()))
                .collect(),
            repeats: texture.repeats,
            cut: match texture.coverage {
                Coverage::Cut(share) => share.into(),
                Coverage::Ignored | Coverage::Share => f64::NEG_INFINITY,
            },
        }
    }
}

impl Texture {
    /// Colour and coverage at a place, 0 to 1 from left to right and from top to bottom.
    pub fn at(&self, place: DVec2) -> [f64; 4] {
        let mut sum = [0.0; 4];
        for (x, column_share) in self.neighbours(place.x, 0) {
            for (y, row_share) in self.neighbours(place.y, 1) {
                let texel = self.texels[y * self.size[0] + x];
                for (sum, number) in sum.iter_mut().zip(texel) {
                    *sum += column_share * row_share * number;
                }
            }
        }
        let [red, green, blue, alpha] = sum;
        match alpha > 0.0 {
            true => [red / alpha, green / alpha, blue / alpha, alpha],
            false => [0.0; 4],
        }
    }

    /// The two texels nearest along a side, with their shares.
    fn neighbours(&self, place: f64, side: usize) -> [(usize, f64); 2] {
        let count = self.size[side] as i64;
        let middle = match self.repeats {
            true => place * count as f64 - 0.5,
            false => place.clamp(0.0, 1.0) * count as f64 - 0.5,
        };
        let (first, share) = (middle.floor() as i64, middle - middle.floor());
        let index = |i: i64| match self.repeats {
            true => i.rem_euclid(count) as usize,
            false => i.clamp(0, count - 1) as usize,
        };
        [(index(first), 1.0 - share), (index(first + 1), share)]
    }
}
