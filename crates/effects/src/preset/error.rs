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
    /// The line of the file.
    pub source_line: String,
}

/// A mistake in a preset, at its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PresetError {
    /// Where it is.
    pub place: Place,
    /// What is wrong, and what would be right.
    pub message: String,
}

impl fmt::Display for PresetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Place {
            file,
            line,
            column,
            source_line,
        } = &self.place;
        writeln!(f, "{file}:{line}:{column}: {}", self.message)?;
        // A window of the line, so that one very long line does not drown the message.
        let start = column.saturating_sub(60);
        let window: String = source_line
            .chars()
            .skip(start)
            .take(100)
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let number = line.to_string();
        writeln!(f, " {number} | {}", window.trim_end())?;
        let caret = " ".repeat(column.saturating_sub(1 + start));
        write!(f, " {} | {caret}^", " ".repeat(number.len()))
    }
}

/// All mistakes of a preset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PresetErrors(pub Vec<PresetError>);

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

/// The name most like `wrong` but for upper and lower case, where one is near enough to be meant.
pub fn nearest<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wrong = wrong.to_lowercase();
    names
        .into_iter()
        .map(|name| (strsim::jaro_winkler(&wrong, &name.to_lowercase()), name))
        .filter(|(likeness, _)| *likeness > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}

/// The end of a sentence about a wrong name: `, did you mean x?`, or the list of all names.
pub fn suggestion<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    match nearest(wrong, names.iter().copied()) {
        Some(name) => format!(", did you mean `{name}`?"),
        None => format!("; there are: {}", names.join(", ")),
    }
}
