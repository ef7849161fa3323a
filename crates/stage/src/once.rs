//! What is made when somebody first asks for it, with all threads.

use std::sync::OnceLock;

/// What the lock holds, made first where it holds nothing. It isn't locked meanwhile, as [`OnceLock::get_or_init`] has it: where threads of a pool
/// make it, one that waits for the others takes up what else is to do in the pool, and may come upon somebody who asks for the same. So
/// several may make it, which must come to the same.
pub(crate) fn once<T>(lock: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    match lock.get() {
        Some(made) => made,
        None => {
            let made = make();
            lock.get_or_init(|| made)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread::sleep;
    use std::time::Duration;

    /// The one who makes it waits for a third thread when the second one's question lies ready: in about half of the trials.
    #[test]
    fn who_waits_in_a_pool_may_ask_as_well() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
        let pool = pool.unwrap();
        let wait = |millis| sleep(Duration::from_millis(millis));
        for trial in 0..16 {
            let lock = OnceLock::new();
            let ask = || {
                *once(&lock, || {
                    rayon::join(|| wait(2), || wait(8));
                    trial
                })
            };
            let asked = pool.install(|| rayon::join(ask, || rayon::join(|| wait(6), ask).1));
            assert_eq!(asked, (trial, trial));
        }
    }
}
