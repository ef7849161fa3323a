//! Work in several threads, where the crate's feature `threads` is on.

/// Runs both, side by side if there is a thread for it in the pool that this is called in; without the feature `threads` one after
/// the other.
#[cfg(feature = "threads")]
pub(crate) fn join<A: Send, B: Send>(
    one: impl FnOnce() -> A + Send,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    rayon::join(one, other)
}

#[cfg(not(feature = "threads"))]
pub(crate) fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}
