//! The pages for those who make looks, docs/styling.md, docs/gallery.md and docs/motion.md, work as they stand there: every snippet is
//! taken, every command done, every picture what its command draws. `cargo xtask pictures` draws the pictures again.

mod page;
mod pictures;
mod reference;
mod snippet;

use assert_cmd::Command;
use page::{Page, Step, root};
use pictures::Shown;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A folder in which a page is followed.
struct Folder {
    folder: TempDir,
    /// Files as they were before the snippets since the last command that was done: a refused one is taken out again.
    before: Vec<(String, String)>,
    /// The arguments of the command before, where it was refused, and what it said.
    refused: Option<(String, String)>,
    /// Pictures that the last block of commands has drawn.
    drawn: Vec<String>,
}

impl Folder {
    fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
            before: Vec::new(),
            refused: None,
            drawn: Vec::new(),
        }
    }

    fn path(&self, file: &str) -> std::path::PathBuf {
        self.folder.path().join(file)
    }

    fn snippet(&mut self, file: &str, is_new: bool, text: &str) {
        if is_new {
            assert!(!self.path(file).exists(), "{file} is there already");
            fs::write(self.path(file), text).unwrap();
            return;
        }
        let old = fs::read_to_string(self.path(file)).unwrap();
        let new = snippet::put(&old, text);
        assert_ne!(new, old, "the snippet changes nothing:\n{text}");
        fs::write(self.path(file), new).unwrap();
        self.before.push((file.to_owned(), old));
    }

    /// A line as one types it. Words are parted by spaces: the pages need no quotes.
    fn command(&mut self, line: &str) {
        assert_eq!(self.refused, None, "refused, and nothing is said of it");
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["cp", from, to] => drop(fs::copy(self.path(from), self.path(to)).unwrap()),
            ["inkstrand", ref arguments @ ..] => {
                let mut command = Command::cargo_bin("inkstrand").unwrap();
                command.current_dir(self.folder.path()).args(arguments);
                let output = command.output().unwrap();
                let said = String::from_utf8(output.stderr).unwrap();
                match output.status.code() {
                    Some(0) => self.before.clear(),
                    _ => self.refused = Some((line.to_owned(), said)),
                }
                let named = arguments.iter().position(|word| *word == "-o");
                self.drawn
                    .extend(named.map(|at| arguments[at + 1].to_owned()));
            }
            _ => panic!("no command of ours: {line}"),
        }
    }

    /// The last command was refused in these words; what led to it is taken back.
    fn refusal(&mut self, expected: &str) {
        let (_, said) = self.refused.take().expect("a command that is refused");
        assert_eq!(said.trim_end(), expected.trim_end());
        for (file, old) in self.before.drain(..).rev() {
            fs::write(self.folder.path().join(file), old).unwrap();
        }
    }

    /// Follows the whole page. Every picture that it shows is drawn by the block of commands above it: one that stands at the
    /// page's head is shown there again.
    fn follow(&mut self, page: &Page, images: &str) {
        let mut shown = Shown::new(root().join("docs").join(images));
        let mut ahead = BTreeSet::new();
        for step in page.steps() {
            match step {
                Step::Snippet { file, is_new, text } => {
                    self.drawn.clear();
                    self.snippet(file, is_new, text);
                }
                Step::Commands(lines) => {
                    self.drawn.clear();
                    lines.lines().for_each(|line| self.command(line));
                }
                Step::Refusal(text) => self.refusal(text),
                Step::Pictures(files) => {
                    for file in files {
                        let name = file.strip_prefix(&format!("{images}/"));
                        let name = name.unwrap_or_else(|| panic!("{file} is not in {images}"));
                        // Pages show what moves under the ending of all pictures, which every site serves as one.
                        let moving = name.replace(".png", ".apng");
                        let is_drawn = |drawn: &&String| *drawn == name || **drawn == moving;
                        if let Some(drawn) = self.drawn.iter().find(is_drawn) {
                            shown.hold(name, &self.path(drawn));
                            ahead.remove(name);
                        } else {
                            ahead.insert(name.to_owned());
                        }
                    }
                }
            }
        }
        assert_eq!(self.refused, None);
        assert!(ahead.is_empty(), "no command above draws {ahead:?}");
        shown.finish();
    }
}

#[test]
fn styling_is_followed_from_an_empty_folder() {
    let mut folder = Folder::new();
    folder.follow(&Page::read("styling.md"), "images/styling");
    let mut check = Command::cargo_bin("inkstrand").unwrap();
    check.current_dir(folder.folder.path()).args(["check", "."]);
    check.assert().success().stderr("");
}

#[test]
fn the_gallery_is_drawn_from_the_root_of_the_project() {
    let mut folder = Folder::new();
    copy(&root().join("presets"), &folder.path("presets"));
    folder.follow(&Page::read("gallery.md"), "images/gallery");
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let to = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &to);
        } else {
            fs::copy(entry.path(), to).unwrap();
        }
    }
}

#[test]
fn motion_is_drawn_from_the_root_of_the_project() {
    let mut folder = Folder::new();
    copy(&root().join("presets"), &folder.path("presets"));
    folder.follow(&Page::read("motion.md"), "images/motion");
}

/// Each preset, style and script that is shipped.
#[test]
fn the_gallery_shows_all_that_is_shipped() {
    let page = Page::read("gallery.md");
    let mut kinds = [0; 3];
    for (kind, folder) in ["presets", "presets/styles", "presets/motions"]
        .into_iter()
        .enumerate()
    {
        for entry in fs::read_dir(root().join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let is_shown = match folder {
                "presets" => name.ends_with(".ron"),
                "presets/styles" => name.ends_with(".style.ron"),
                // Key shapes lie beside the scripts that have them.
                _ => name.ends_with(".motion.ron"),
            };
            if is_shown {
                let is_named = |step: &Step| match step {
                    Step::Commands(lines) => lines.contains(&format!("{folder}/{name}")),
                    _ => false,
                };
                assert!(page.steps().iter().any(is_named), "{folder}/{name}");
                kinds[kind] += 1;
            }
        }
    }
    assert!(kinds.iter().all(|count| *count > 0), "{kinds:?}");
}
