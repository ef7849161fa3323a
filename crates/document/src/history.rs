//! Steps of undo and redo: whole texts, within limits.

use std::collections::VecDeque;
use std::sync::Arc;

/// The most steps that are kept.
const MOST_STEPS: usize = 1000;
/// The most bytes that they have together.
const MOST_BYTES: usize = 64 << 20;

/// What an edit made of the steps that can be taken back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Nothing: the text is what it was.
    None,
    /// There is one more.
    New,
    /// It is a part of the last one.
    Same,
    /// The last one is gone, as its gesture came back to where it began.
    Gone,
}

#[derive(Default)]
pub(crate) struct History {
    /// Texts before the present one, the oldest first.
    undo: VecDeque<Arc<str>>,
    /// Texts after it, the next one last.
    redo: Vec<Arc<str>>,
    /// What all of them have together.
    bytes: usize,
    /// The gesture of the last edit, where the next may be of the same.
    gesture: Option<u64>,
}

impl History {
    /// A step from the present text to another one.
    pub fn edit(&mut self, now: &Arc<str>, next: &str, gesture: Option<u64>) -> Step {
        self.bytes -= self.redo.iter().map(|text| text.len()).sum::<usize>();
        self.redo.clear();
        if gesture.is_none() || gesture != self.gesture {
            self.gesture = gesture;
            self.push(now.clone());
            Step::New
        } else if let Some(begin) = self.undo.pop_back_if(|begin| **begin == *next) {
            // A drag back to where it began is no step, unless it goes on.
            self.bytes -= begin.len();
            self.gesture = None;
            Step::Gone
        } else {
            Step::Same
        }
    }

    /// The next edit is a step of its own.
    pub fn end_gesture(&mut self) {
        self.gesture = None;
    }

    pub fn undo(&mut self, now: &Arc<str>) -> Option<Arc<str>> {
        self.gesture = None;
        let text = self.undo.pop_back()?;
        self.bytes = self.bytes - text.len() + now.len();
        self.redo.push(now.clone());
        Some(text)
    }

    pub fn redo(&mut self, now: &Arc<str>) -> Option<Arc<str>> {
        self.gesture = None;
        let text = self.redo.pop()?;
        self.bytes -= text.len();
        self.push(now.clone());
        Some(text)
    }

    pub fn can_undo(&self) -> bool {
        !self.undo.is_empty()
    }

    pub fn can_redo(&self) -> bool {
        !self.redo.is_empty()
    }

    fn push(&mut self, text: Arc<str>) {
        self.bytes += text.len();
        self.undo.push_back(text);
        while self.undo.len() > MOST_STEPS || self.bytes > MOST_BYTES {
            let Some(oldest) = self.undo.pop_front() else {
                return;
            };
            self.bytes -= oldest.len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(history: &mut History, mut now: Arc<str>) -> usize {
        let mut count = 0;
        while let Some(text) = history.undo(&now) {
            now = text;
            count += 1;
        }
        count
    }

    #[test]
    fn the_oldest_steps_are_forgotten() {
        let mut history = History::default();
        let mut now: Arc<str> = "0".into();
        for i in 1..=MOST_STEPS + 5 {
            let next = i.to_string();
            history.edit(&now, &next, None);
            now = next.into();
        }
        assert_eq!(steps(&mut history, now), MOST_STEPS);

        let mut history = History::default();
        let mut now: Arc<str> = "a".repeat(MOST_BYTES / 3).into();
        for i in 0..5 {
            let next = i.to_string() + &now;
            history.edit(&now, &next, None);
            now = next.into();
        }
        assert_eq!(steps(&mut history, now), 2);

        // One that is larger than all may be.
        let mut history = History::default();
        history.edit(&"a".repeat(MOST_BYTES + 1).into(), "b", None);
        assert!(!history.can_undo());
        assert_eq!(history.bytes, 0);
    }
}
