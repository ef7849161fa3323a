//! Errors at a place of a preset.

use std::fmt;

/// A place in a preset, kept for errors that show only when its files are read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file as the user named it.
    pub file: String,
    /// Line, 1 first.
    pub line: usize,
    /// Column in characters, 1 first.
    pub column: usize,
    /// What a message shows of the line: at most 100 characters of it, from 59 before the column on.
    pub source_line: String,
}

/// How many mistakes of a file are told: a file that is no preset at all has any number.
pub(super) const MOST_ERRORS: usize = 100;
/// How many characters of a line are shown before the column.
const SHOWN_BEFORE: usize = 59;
/// How many are shown at most.
const SHOWN_OF_LINE: usize = 100;
/// How many characters a message has at most: it may repeat names of the file, of any length.
const MOST_OF_MESSAGE: usize = 1000;

impl Place {
    /// The place at byte `offset` of `text`, in the line that begins at byte `line_start`.
    pub(super) fn new(
        file: &str,
        text: &str,
        offset: usize,
        line_start: usize,
        [line, column]: [usize; 2],
    ) -> Self {
        let before = text[line_start..offset].char_indices();
        let window = before.rev().take(SHOWN_BEFORE).last();
        let shown = text[window.map_or(offset, |(i, _)| line_start + i)..].lines();
        let shown = shown.map(|line| line.chars().take(SHOWN_OF_LINE)).next();
        Self {
            file: file.to_owned(),
            line,
            column,
            source_line: shown.map_or(String::new(), Iterator::collect),
        }
    }
}

/// A mistake in a preset, at its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PresetError {
    /// Where it is.
    pub place: Place,
    /// What is wrong, and what would be right.
    pub message: String,
}

impl PresetError {
    /// Stands at the first mistake that is not told, behind those that are.
    pub(super) fn untold(place: Place, told: usize, all: usize) -> Self {
        let message = format!("{told} of {all} mistakes are shown, not this one");
        Self { place, message }
    }
}

impl fmt::Display for PresetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Place {
            file,
            line,
            column,
            source_line,
        } = &self.place;
        // Files may have characters in them that would change the terminal.
        let visible = |c: char| if c.is_control() { ' ' } else { c };
        let message = self.message.chars().take(MOST_OF_MESSAGE).map(visible);
        let message: String = message.collect();
        writeln!(f, "{file}:{line}:{column}: {message}")?;
        let shown: String = source_line.chars().map(visible).collect();
        let number = line.to_string();
        writeln!(f, " {number} | {}", shown.trim_end())?;
        let caret = " ".repeat(column.saturating_sub(1).min(SHOWN_BEFORE));
        write!(f, " {} | {caret}^", " ".repeat(number.len()))
    }
}

/// All mistakes of a preset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PresetErrors(pub Vec<PresetError>);

impl PresetErrors {
    /// Mistakes that were found beside a [`Reader`](super::Reader), as it would report them: by their places; of more than a
    /// hundred the first, and how many there are. None where there are none.
    ///
    /// # Errors
    ///
    /// These mistakes.
    pub fn report(mut errors: Vec<PresetError>) -> Result<(), Self> {
        errors.sort_by_key(|e| (e.place.line, e.place.column));
        let all = errors.len();
        let untold = errors.get(MOST_ERRORS).map(|error| error.place.clone());
        errors.truncate(MOST_ERRORS);
        errors.extend(untold.map(|place| PresetError::untold(place, MOST_ERRORS, all)));
        if errors.is_empty() {
            Ok(())
        } else {
            Err(Self(errors))
        }
    }
}

impl fmt::Display for PresetErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, error) in self.0.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            write!(f, "{error}")?;
        }
        Ok(())
    }
}

impl std::error::Error for PresetErrors {}

/// Characters of a wrong name that are looked at: what is longer is hardly a slip, and takes as long to compare as it and all names are.
const MOST_COMPARED: usize = 100;

/// The name most like `wrong` but for upper and lower case, where one is near enough to be meant.
pub fn nearest<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wrong: String = wrong.chars().take(MOST_COMPARED).collect();
    let wrong = wrong.to_lowercase();
    names
        .into_iter()
        .map(|name| (strsim::jaro_winkler(&wrong, &name.to_lowercase()), name))
        .filter(|(likeness, _)| *likeness > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}

/// The end of a sentence about a wrong name: `, did you mean x?`, or the list of all names, or that there are none.
pub fn suggestion<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    match nearest(wrong, names.iter().copied()) {
        Some(name) => format!(", did you mean `{name:.60}`?"),
        None if names.is_empty() => "; there are none".to_owned(),
        None => format!("; there are: {}", names.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_name_is_told_the_nearest_or_all_or_that_there_are_none() {
        let names = ["walk", "nod"];
        assert_eq!(suggestion("wlak", names), ", did you mean `walk`?");
        assert_eq!(suggestion("qqq", names), "; there are: walk, nod");
        assert_eq!(suggestion("qqq", []), "; there are none");
    }

    #[test]
    fn names_of_megabytes_are_answered_at_once() {
        let long = "walk".repeat(1_000_000);
        let start = std::time::Instant::now();
        for _ in 0..100 {
            assert_eq!(nearest(&long, ["stride", "walk"]), None);
        }
        assert!(start.elapsed().as_secs() < 5);
    }
}
