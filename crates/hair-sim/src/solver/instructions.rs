//! The instruction set that strands are stepped with: the same source compiled for each of several.
//!
//! Only widths differ, never the arithmetic: additions and products are not contracted, roots and quotients
//! are rounded as IEEE 754 says. So every set gives the same bits.
//!
//! This needs `unsafe`: here to call a function that is compiled for instructions which not every machine has, and in
//! [`crate::lanes::avx2`] for the instructions themselves. Measured, with 72 strands of 20 points in wind on one thread: 360 us
//! a step for SSE2, 170 us for AVX2, as
//! `cargo test --release -p hair-sim --lib every_instruction_set -- --nocapture` prints them.

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
}

/// Calls a function that is generic in its [`Number`](crate::lanes::Number) in the given instructions. It, and all that it calls, must be
/// `#[inline(always)]`: what is not inlined is compiled for the program's own instructions.
macro_rules! run {
    ($instructions:expr, $kernel:ident($($argument:expr),* $(,)?)) => {
        match $instructions {
            $crate::solver::instructions::Instructions::Compiled => {
                $kernel::<$crate::lanes::Lane>($($argument),*)
            }
            #[cfg(target_arch = "x86_64")]
            $crate::solver::instructions::Instructions::Avx2 => {
                $crate::solver::instructions::avx2(
                    #[inline(always)]
                    || $kernel::<$crate::lanes::avx2::Avx2>($($argument),*),
                )
            }
        }
    };
}
pub(super) use run;

/// `work`, compiled for AVX2.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code, reason = "it saves time, see the module")]
#[inline(always)]
pub(super) fn avx2<R>(work: impl FnOnce() -> R) -> R {
    #[target_feature(enable = "avx2")]
    #[inline(never)]
    fn compiled<R>(work: impl FnOnce() -> R) -> R {
        work()
    }
    // SAFETY: `run` calls this for a value that is made by `Instructions::best` only, which looked for AVX2.
    unsafe { compiled(work) }
}
