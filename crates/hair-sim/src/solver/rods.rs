//! The two kinds of strands: those that are straight by nature, and all others.
//!
//! Nothing else asks of which kind a batch is.

pub(crate) mod curled;
pub(crate) mod straight;

use crate::lanes::{Lane, Mask, Number, Quat, Vec3};

use super::{
    batch::{Batch, BatchState},
    chain::{Chain, ShapeEnergy, chord},
    stage::{FreeMotion, Model},
};

/// What the strands of a batch are by nature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rods {
    Curled,
    Straight,
}

/// Scratch of a Newton step.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    pub curled: curled::Scratch,
    pub straight: straight::Scratch,
}

impl Scratch {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            curled: curled::Scratch::new(count),
            straight: straight::Scratch::new(count),
        }
    }
}

impl Rods {
    pub(crate) fn of(batch: &Batch) -> Self {
        if batch.is_straight {
            Self::Straight
        } else {
            Self::Curled
        }
    }

    /// The material frames of the links of a state, in world axes, by the skin's frame, the particles, and those that the state
    /// holds; where it holds none, they are put into `scratch`.
    pub(crate) fn frames<'a, T: Number>(
        self,
        batch: &Batch,
        (base, y, held): (&Quat, &[Vec3], &'a [Quat]),
        scratch: &'a mut [Quat],
    ) -> &'a [Quat] {
        match self {
            Self::Curled => held,
            Self::Straight => {
                straight::frames::<T>(base, &batch.links, y, scratch);
                scratch
            }
        }
    }

    /// The same one link after the other.
    pub(crate) fn frames_one_by_one(batch: &Batch, state: &BatchState) -> impl FnMut() -> Quat {
        let mut links = 0..batch.count();
        let mut untwisted = straight::Frames::<Lane>::new(&state.base);
        let rods = Self::of(batch);
        move || {
            let k = links.next().expect("no more calls than links");
            match rods {
                Self::Curled => state.frames[k],
                Self::Straight => untwisted.go_on(&batch.links[k], chord(&state.y, k)),
            }
        }
    }

    /// The turn of every joint of a state, 2 tan(angle / 2) times its axis, in the frame of its link.
    pub(crate) fn turns_of<T: Number>(self, batch: &Batch, state: &BatchState, out: &mut [Vec3]) {
        match self {
            Self::Curled => curled::turns::<T>(&state.base, &state.frames, out),
            Self::Straight => straight::turns_of::<T>(&state.base, &batch.links, &state.y, out),
        }
    }

    /// The same of a chain, where the skin's frame is `base`.
    pub(crate) fn turns<T: Number>(
        self,
        batch: &Batch,
        base: &Quat,
        chain: &Chain,
        out: &mut [Vec3],
    ) {
        match self {
            Self::Curled => curled::turns::<T>(base, &chain.frames[..batch.count()], out),
            Self::Straight => straight::turns::<T>(base, &batch.links, &chain.tangents, out),
        }
    }

    /// Points every link along the free motion from where it was, particles and frames, which is carried along by `carry`.
    pub(crate) fn predict<T: Number>(
        self,
        batch: &Batch,
        free: FreeMotion,
        carry: Quat,
        (y, frames): (&[Vec3], &[Quat]),
        chain: &mut Chain,
    ) {
        match self {
            Self::Curled => curled::predict::<T>(batch, free, carry, frames, chain),
            Self::Straight => straight::predict::<T>(&batch.links, free, carry, y, chain),
        }
    }

    /// One step of Newton's method for the lanes in `which`, in which no link turns by more than `most` (radians). Returns the
    /// largest turn of a link that it asks for, in proportion to what the sharpest joint lets pass for small.
    #[inline(always)]
    pub(crate) fn newton<T: Number>(
        self,
        batch: &Batch,
        model: &Model,
        chain: &mut Chain,
        scratch: &mut Scratch,
        (most, which): (f64, Mask),
    ) -> Lane {
        let links = &batch.links;
        let (largest, sharpest) = match self {
            Self::Curled => {
                let scratch = &mut scratch.curled;
                let found = curled::find_turns::<T>(links, model, chain, scratch);
                let scale = (Lane::splat(most) / found.0).min(Lane::ONE);
                curled::turn_links::<T>(links, chain, &scratch.turns, scale, which);
                found
            }
            Self::Straight => {
                straight::newton::<T>(links, model, chain, &mut scratch.straight, most, which)
            }
        };
        largest * sharpest.sqrt()
    }

    /// The energy of a state's shape, where the skin's frame is `base`.
    pub(crate) fn energy_of<T: Number>(
        self,
        batch: &Batch,
        state: &BatchState,
        base: &Quat,
        pull: &Vec3,
    ) -> ShapeEnergy {
        match self {
            Self::Curled => curled::energy::<T>(batch, base, &state.frames, &state.y, pull),
            Self::Straight => straight::energy_of::<T>(batch, base, &state.y, pull),
        }
    }

    /// The energy of a chain's shape.
    pub(crate) fn energy<T: Number>(
        self,
        batch: &Batch,
        chain: &Chain,
        base: &Quat,
        pull: &Vec3,
    ) -> ShapeEnergy {
        match self {
            Self::Curled => curled::energy::<T>(batch, base, &chain.frames, &chain.y, pull),
            Self::Straight => straight::energy::<T>(batch, base, chain, pull),
        }
    }

    /// Takes the frames of a chain into a state, in the lanes of `which`.
    #[inline(always)]
    pub(crate) fn keep_frames(self, state: &mut BatchState, chain: &Chain, which: Mask) {
        match self {
            Self::Curled => {
                for (frame, new) in state.frames.iter_mut().zip(&chain.frames) {
                    *frame = Quat::pick(which, *new, *frame);
                }
            }
            Self::Straight => {}
        }
    }

    /// Carries the shape of the lanes in `which` along with the skin.
    pub(crate) fn carry(self, batch: &Batch, state: &mut BatchState, turn: Quat, which: Mask) {
        match self {
            Self::Curled => curled::carry(batch, state, turn, which),
            Self::Straight => straight::carry(batch, state, turn, which),
        }
    }
}
