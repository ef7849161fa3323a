//! The instruction set that strands are stepped with: the same source compiled for each of several.
//!
//! Only widths differ, never the arithmetic: additions and products are not contracted, roots and quotients
//! are rounded as IEEE 754 says. So every set gives the same bits.
//!
//! This needs the one `unsafe` block of the crate: calling a function that is compiled for instructions which
//! not every machine has. Measured with 72 strands of 20 particles in wind, one thread, the best of many runs: 370 us a
//! step as compiled (SSE2), 172 us with AVX2. AVX-512 was slower than AVX2 (the compiler mixes widths), so it
//! is not here.

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
}

impl Instructions {
    /// The best that this machine has.
    pub(super) fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            return Self::Avx2;
        }
        Self::Compiled
    }

    /// [`integrate::step`] in these instructions.
    #[allow(unsafe_code, reason = "half of the time, see the module")]
    pub(super) fn step(
        self,
        batch: &Batch,
        state: &mut BatchState,
        scratch: &mut Scratch,
        drive: &Drive,
    ) -> BatchStats {
        match self {
            Self::Compiled => integrate::step(batch, state, scratch, drive),
            // SAFETY: a value of this kind is made by `best` only, which looked for it.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { avx2(batch, state, scratch, drive) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2(batch: &Batch, state: &mut BatchState, scratch: &mut Scratch, drive: &Drive) -> BatchStats {
    integrate::step(batch, state, scratch, drive)
}
