//! A page of the documentation as what its reader does and sees, one after the other.

use std::path::{Path, PathBuf};

/// The root of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A page of `docs`.
pub struct Page {
    /// Its name in `docs`.
    pub name: &'static str,
    text: String,
}

/// What the reader does or sees.
#[derive(Debug, PartialEq)]
pub enum Step<'p> {
    /// A file, new or changed: the block of RON under a line that names it as **`FILE`**.
    Snippet {
        file: &'p str,
        is_new: bool,
        text: &'p str,
    },
    /// The lines of a block of commands.
    Commands(&'p str),
    /// What the last command says when it refuses: a block of text.
    Refusal(&'p str),
    /// Pictures shown one after the other, as the page links them. Only blank lines part them from what stands before.
    Pictures(Vec<&'p str>),
}

impl Page {
    pub fn read(name: &'static str) -> Self {
        let path = root().join("docs").join(name);
        let text = std::fs::read_to_string(&path);
        let text = text.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        Self { name, text }
    }

    /// The text from a heading on, up to the next one of its level.
    pub fn part(&self, heading: &str) -> &str {
        let start = self.text.find(&format!("\n{heading}\n"));
        let start = start.unwrap_or_else(|| panic!("{}: no heading {heading:?}", self.name));
        let level = heading.split(' ').next().unwrap();
        let inside = &self.text[start + 1 + heading.len()..];
        let end = inside.find(&format!("\n{level} ")).unwrap_or(inside.len());
        &inside[..end]
    }

    /// All headings, with their marks.
    pub fn headings(&self) -> impl Iterator<Item = &str> {
        self.text.lines().filter(|line| line.starts_with('#'))
    }

    pub fn steps(&self) -> Vec<Step<'_>> {
        let mut steps = Vec::new();
        // The last line of words, and whether words stand between here and the step before.
        let (mut words, mut are_between) = ("", true);
        let mut rest = self.text.as_str();
        while !rest.is_empty() {
            let (line, after) = rest.split_once('\n').unwrap_or((rest, ""));
            rest = after;
            if let Some(language) = line.strip_prefix("```") {
                let end = rest.find("```\n");
                let end = end.unwrap_or_else(|| panic!("{}: a block without an end", self.name));
                let text = &rest[..end];
                rest = &rest[end + "```\n".len()..];
                steps.push(match language {
                    "ron" => self.snippet(words, text),
                    "sh" => Step::Commands(text),
                    "text" => Step::Refusal(text),
                    other => panic!("{}: a block of {other:?}", self.name),
                });
                are_between = false;
            } else if let Some(picture) = picture(line) {
                match steps.last_mut() {
                    Some(Step::Pictures(row)) if !are_between => row.push(picture),
                    _ => steps.push(Step::Pictures(vec![picture])),
                }
                if are_between {
                    // Nothing above that it could be of: an empty block tells.
                    let at = steps.len() - 1;
                    steps.insert(at, Step::Commands(""));
                }
                are_between = false;
            } else if !line.is_empty() {
                (words, are_between) = (line, true);
            }
        }
        steps
    }

    fn snippet<'p>(&self, words: &'p str, text: &'p str) -> Step<'p> {
        let named = words
            .split("**`")
            .nth(1)
            .and_then(|w| w.split("`**").next());
        let file = named.unwrap_or_else(|| panic!("{}: whose is this?\n{text}", self.name));
        Step::Snippet {
            file,
            is_new: words.contains("a new file"),
            text,
        }
    }
}

/// The file of a line that is a picture.
fn picture(line: &str) -> Option<&str> {
    let (words, file) = line.strip_prefix("![")?.split_once("](")?;
    assert!(
        !words.is_empty(),
        "{file} has no words for those who can't see it"
    );
    file.strip_suffix(')')
}

#[test]
fn a_page_is_read_in_order() {
    let text = "Hi.\n![a](x/a.png)\n\n**`look.ron`**, a new file:\n\n```ron\n(a: 1)\n```\n```sh\none\ntwo\n```\n\n![b](x/b.png)\n![c](x/c.png)\nWords.\n```text\nno\n```\n";
    let page = Page {
        name: "made",
        text: text.to_owned(),
    };
    let snippet = Step::Snippet {
        file: "look.ron",
        is_new: true,
        text: "(a: 1)\n",
    };
    let expected = [
        Step::Commands(""),
        Step::Pictures(vec!["x/a.png"]),
        snippet,
        Step::Commands("one\ntwo\n"),
        Step::Pictures(vec!["x/b.png", "x/c.png"]),
        Step::Refusal("no\n"),
    ];
    assert_eq!(page.steps(), expected);
}
