//! The instruction set that a picture is drawn with: the same source compiled for each of several.
//!
//! Only widths differ, never the arithmetic: additions and products are not contracted, roots and
//! quotients are rounded as IEEE 754 says. So every set draws the same bits.
//!
//! This needs the one `unsafe` block of the rasteriser: calling a function that is compiled for
//! instructions which not every machine has. Measured on the benchmark `raster`, 84 thick strands at
//! 16 samples, when cells were eight pixels of one sample: 96 ms as compiled (SSE2), 67 ms with AVX2, 55 ms with AVX-512.

/// Vector instructions that this machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Instructions {
    /// Those that the program was compiled for.
    Compiled,
    /// Eight numbers at once.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// Sixteen, and masks with a bit for each.
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
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
            {
                available.push(Self::Avx512);
            }
        }
        available
    }

    /// The best that this machine has.
    pub(crate) fn best() -> Self {
        Self::available().last().copied().unwrap_or(Self::Compiled)
    }

    /// Calls `work`, compiled for these instructions, as is all that it calls that is `inline(always)`, and no more.
    #[allow(unsafe_code, reason = "a third to a half of the time, see above")]
    #[inline]
    pub(crate) fn run<R>(self, work: impl FnOnce() -> R) -> R {
        match self {
            Self::Compiled => work(),
            // SAFETY: a value of this type is made by `available` only, which looked for each.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { avx2(work) },
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { avx512(work) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2<R>(work: impl FnOnce() -> R) -> R {
    work()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
fn avx512<R>(work: impl FnOnce() -> R) -> R {
    work()
}
