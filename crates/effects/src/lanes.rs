//! Loops over many samples in the widest instructions that the machine has.

/// Calls `work`, compiled for AVX2 where the machine has it: eight numbers at once in place of four, and `floor` as an instruction. Only
/// widths differ, never the arithmetic.
///
/// All that it calls is `inline(always)`, or it would be compiled without them.
#[inline]
pub(crate) fn widest<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    if let Some(avx2) = fearless_simd::Level::new().as_avx2() {
        return fearless_simd::Simd::vectorize(avx2, work);
    }
    work()
}
