//! The instruction set that strands are stepped with: the same source compiled for each of several.
//!
//! Only widths differ, never the arithmetic: additions and products are not contracted, roots and quotients
//! are rounded as IEEE 754 says. So every set gives the same bits.
//!
//! A step is compiled phase by phase, each a function by [`Number::run`](super::Number::run): all of it in one would be
//! compiled for minutes, and would not be faster.
//!
//! This needs `unsafe`: [`super::avx2`] calls functions that are compiled for instructions which not every machine has, and the
//! instructions themselves. Measured, with 72 strands of 20 points in wind on one thread: 360 us
//! a step for SSE2, 170 us for AVX2, as
//! `cargo test --release -p hair-sim --lib every_instruction_set -- --nocapture` prints them.

/// Vector instructions that this machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Instructions {
    /// Those that the program was compiled for.
    Compiled,
    /// Four numbers at once.
    #[cfg(target_arch = "x86_64")]
    Avx2,
}

impl Instructions {
    /// The best that this machine has.
    pub(crate) fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            return Self::Avx2;
        }
        Self::Compiled
    }
}
