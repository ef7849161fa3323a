//! Loops over many samples in the widest instructions that the machine has.

/// Calls `work`, compiled for AVX-512 or AVX2 where the machine has them: sixteen or eight numbers at once in place of four, and `floor` as an
/// instruction. Only widths differ, never the arithmetic.
///
/// All that it calls is `inline(always)`, or it would be compiled without them.
#[inline]
pub(crate) fn widest<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    {
        let level = fearless_simd::Level::new();
        if let Some(avx512) = level.as_avx512() {
            return fearless_simd::Simd::vectorize(avx512, work);
        }
        if let Some(avx2) = level.as_avx2() {
            return fearless_simd::Simd::vectorize(avx2, work);
        }
    }
    work()
}
