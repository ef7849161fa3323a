//! The source's own way: a stroke is stamped disc by disc, each tested for depth.

use super::contenders::Contender;
use crate::BenchError;
use render::cpu::Stamper;
use render::{Drawing, Picture};

/// Stamps every stroke, a number of discs to each interval between joints.
pub struct Stamping {
    per_interval: usize,
    stamper: Stamper,
    picture: Option<Picture>,
}

impl Stamping {
    /// With that many stamps an interval, samples a pixel and threads.
    ///
    /// # Errors
    ///
    /// When there are no such numbers.
    pub fn new(per_interval: usize, samples: u32, threads: usize) -> Result<Self, BenchError> {
        Ok(Self {
            per_interval,
            stamper: Stamper::new(samples, Some(threads)).map_err(|e| e.to_string())?,
            picture: None,
        })
    }
}

impl Contender for Stamping {
    fn draw(&mut self, drawing: &Drawing) -> Result<(), BenchError> {
        let picture = self.stamper.draw(drawing, self.per_interval);
        self.picture = Some(picture.map_err(|e| e.to_string())?);
        Ok(())
    }

    fn picture(&self) -> Option<Picture> {
        self.picture.clone()
    }
}
