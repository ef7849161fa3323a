//! Work in several threads, where the crate's feature `threads` is on.

/// What comes of each of some things, by its place among them: in the threads of the rayon pool that it is called in, or without the feature
/// `threads` one after the other.
#[cfg(feature = "threads")]
pub(crate) fn map<T: Sync, R: Send>(of: &[T], one: impl Fn(usize, &T) -> R + Sync) -> Vec<R> {
    use rayon::prelude::*;
    let all = of.par_iter().enumerate();
    all.map(|(place, own)| one(place, own)).collect()
}

#[cfg(not(feature = "threads"))]
pub(crate) fn map<T, R>(of: &[T], one: impl Fn(usize, &T) -> R) -> Vec<R> {
    let all = of.iter().enumerate();
    all.map(|(place, own)| one(place, own)).collect()
}

/// What comes of two things, each in a thread of that pool where one is free; without the feature the second after the first.
#[cfg(feature = "threads")]
pub(crate) use rayon::join;

#[cfg(not(feature = "threads"))]
pub(crate) fn join<A, B>(first: impl FnOnce() -> A, second: impl FnOnce() -> B) -> (A, B) {
    let first = first();
    (first, second())
}
