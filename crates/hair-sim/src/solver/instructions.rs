//! The instruction set that strands are stepped with: the same source compiled for each of several.
//!
//! Only widths differ, never the arithmetic: additions and products are not contracted, roots and quotients
//! are rounded as IEEE 754 says. So every set gives the same bits.
//!
//! This needs the one `unsafe` block of the crate: calling a function that is compiled for instructions which
//! not every machine has. See the crate's documentation for what it is worth.

use super::{
    batch::{Batch, BatchState, Scratch},
    drive::Drive,
    integrate::{self, BatchStats},
};

/// Vector instructions that this machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Instructions {
    /// Those that the program was compiled for.
    Compiled,
    /// Four numbers at once.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// Eight numbers at once.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Instructions {
    /// All that this machine has, the best last.
    pub(super) fn available() -> Vec<Self> {
        #[allow(unused_mut)]
        let mut available = vec![Self::Compiled];
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx2") {
                available.push(Self::Avx2);
            }
            if false
                && is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
            {
                available.push(Self::Avx512);
            }
        }
        available
    }

    /// [`integrate::step`] in these instructions.
    #[allow(unsafe_code, reason = "more than half of the time, see the module")]
    pub(super) fn step(
        self,
        batch: &Batch,
        state: &mut BatchState,
        scratch: &mut Scratch,
        drive: &Drive,
    ) -> BatchStats {
        match self {
            Self::Compiled => integrate::step(batch, state, scratch, drive),
            // SAFETY: a value of this type is made by `available` only, which looked for each.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { avx2(batch, state, scratch, drive) },
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { avx512(batch, state, scratch, drive) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2(batch: &Batch, state: &mut BatchState, scratch: &mut Scratch, drive: &Drive) -> BatchStats {
    integrate::step(batch, state, scratch, drive)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
fn avx512(
    batch: &Batch,
    state: &mut BatchState,
    scratch: &mut Scratch,
    drive: &Drive,
) -> BatchStats {
    integrate::step(batch, state, scratch, drive)
}
