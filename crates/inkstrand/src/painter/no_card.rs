//! Stands for `card` in builds without the feature `gpu`: a graphics card that nobody has.

use super::Lap;
use crate::Failure;
use crate::pass::Gathered;
use crate::stats::FrameStats;
use render::{Frame, Picture};
use std::convert::Infallible;

pub(super) enum Card {}

impl Card {
    pub fn any(_is_quiet: bool) -> Result<Self, Failure> {
        Err(Failure::Failed(
            "this program was built without graphics cards, which are its feature `gpu`\n\
             --backend cpu draws without one"
                .to_owned(),
        ))
    }

    pub fn hardware(_is_quiet: bool) -> Option<Self> {
        None
    }

    pub fn draw(
        &mut self,
        _frame: &Frame,
        _samples: u32,
        _stats: &mut FrameStats,
        _lap: &mut Lap,
    ) -> Result<Picture, Infallible> {
        match *self {}
    }

    pub fn draw_samples(
        &mut self,
        _frame: &Frame,
        _samples: u32,
        _gathered: &mut Gathered,
        _stats: &mut FrameStats,
        _lap: &mut Lap,
    ) -> Result<(), Infallible> {
        match *self {}
    }
}

pub(super) fn tell(_is_quiet: bool, error: &Infallible) {
    match *error {}
}

pub(super) fn explained(error: Infallible) -> Failure {
    match error {}
}
