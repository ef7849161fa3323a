//! What was made before, for whoever needs the same again.

use std::sync::{Arc, Mutex, PoisonError};

/// What was made of what, what was asked for last at the end, so many at most: while something is edited, each edit makes another. Copies share them.
pub(crate) struct Kept<Of, Made, const MOST: usize> {
    made: Arc<Mutex<Vec<(Of, Made)>>>,
}

impl<Of, Made, const MOST: usize> Default for Kept<Of, Made, MOST> {
    fn default() -> Self {
        Self {
            made: Arc::default(),
        }
    }
}

impl<Of, Made, const MOST: usize> Clone for Kept<Of, Made, MOST> {
    fn clone(&self) -> Self {
        Self {
            made: self.made.clone(),
        }
    }
}

impl<Of: PartialEq, Made: Clone, const MOST: usize> Kept<Of, Made, MOST> {
    /// What was made of an equal one before, or else is made now. Nobody waits meanwhile ([`once`](crate::once::once) says why).
    pub fn get(&self, of: Of, make: impl FnOnce(&Of) -> Made) -> Made {
        let known = |all: &mut Vec<(Of, Made)>| {
            let place = all.iter().position(|(made_of, _)| *made_of == of)?;
            all[place..].rotate_left(1);
            Some(all.last()?.1.clone())
        };
        // A panic elsewhere leaves whole entries.
        let all = || self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(made) = known(&mut all()) {
            return made;
        }
        let made = make(&of);
        let mut all = all();
        if let Some(made) = known(&mut all) {
            return made;
        }
        if all.len() >= MOST {
            all.remove(0);
        }
        all.push((of, made.clone()));
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_made_lately_is_not_made_again() {
        let kept: Kept<u32, u32, 2> = Kept::default();
        let copy = kept.clone();
        let made = |of| {
            let mut is_made = false;
            let value = copy.get(of, |of| {
                is_made = true;
                10 * of
            });
            assert_eq!(value, 10 * of);
            is_made
        };
        assert_eq!(kept.get(1, |of| 10 * of), 10);
        assert_eq!([1, 2, 1, 2].map(made), [false, true, false, false]);
        assert_eq!([3, 2, 1].map(made), [true, false, true]);
        // What is used again and again stays, however often the other changes.
        assert_eq!([2, 4, 2, 5, 2].map(made), [false, true, false, true, false]);
    }
}
