//! The list of golden pictures, `tests/golden/cases.toml`.

use std::collections::BTreeSet;

use serde::Deserialize;

use crate::Outcome;

/// The list of cases, as `cases.toml` holds it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Cases {
    case: Vec<Case>,
}

/// A picture that must stay as it is.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// The name of its file, without `.png`.
    pub name: String,
    /// What `inkstrand render` gets, the preset first.
    pub args: Vec<String>,
    /// The cells of a contact sheet; none for a single picture.
    #[serde(skip)]
    pub cells: Vec<Cell>,
}

/// A small picture of a contact sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// What it shows, such as `hair.cel.threshold=1`.
    pub name: String,
    /// What it changes: `hair.cel.threshold=1`, the argument of `--set`; several in order.
    pub sets: Vec<String>,
    /// The cell that it must differ from, unless another one with the same `shows` does.
    pub beside: Option<usize>,
    /// The parameter that it shows; empty for a cell that others are compared with.
    pub shows: String,
}

/// A case for each look of `presets`: whoever changes one sees what became of it.
pub fn looks(names: &[String]) -> Vec<Case> {
    let case = |look: &String| Case {
        name: format!("look-{look}"),
        args: vec![
            format!("presets/{look}.ron"),
            "--size=240x180".to_owned(),
            "--samples=4".to_owned(),
        ],
        cells: Vec::new(),
    };
    names.iter().map(case).collect()
}

/// Reads the list of cases. Names become names of files, so they are held to letters that are
/// the same everywhere.
pub fn parse(text: &str) -> Outcome<Vec<Case>> {
    let Cases { case: cases } = toml::from_str(text)?;
    if cases.is_empty() {
        return Err("there is no case".into());
    }
    let mut names = BTreeSet::new();
    for Case { name, args, .. } in &cases {
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        if name.is_empty() || !name.chars().all(plain) {
            return Err(format!("case {name:?}: a name is of a-z, 0-9 and -").into());
        }
        if !names.insert(name) {
            return Err(format!("case {name:?} is there twice").into());
        }
        if args.is_empty() {
            return Err(format!("case {name:?} has no preset in its args").into());
        }
    }
    Ok(cases)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_look_has_a_case() {
        let cases = looks(&["manga-ink".to_owned(), "b".to_owned()]);
        assert_eq!(cases[0].name, "look-manga-ink");
        assert_eq!(cases[1].args[0], "presets/b.ron");
    }

    #[test]
    fn lists_of_cases_are_checked() {
        let good = "[[case]]\nname = 'a-1'\nargs = ['presets/a.ron', '--size', '8x6']\n";
        assert_eq!(parse(good).unwrap()[0].args.len(), 3);
        for (text, complaint) in [
            ("case = []", "no case"),
            ("", "missing field"),
            ("[[case]]\nname = '../a'\nargs = ['p']", "a name is of"),
            ("[[case]]\nname = ''\nargs = ['p']", "a name is of"),
            ("[[case]]\nname = 'a'\nargs = []", "no preset"),
            ("[[case]]\nname = 'a'\narg = ['p']", "unknown field"),
            (&[good, good].concat(), "twice"),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.contains(complaint), "{text:?}: {error}");
        }
    }
}
