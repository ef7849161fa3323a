//! The source's explanatory figures, drawn by the program, with what they claim measured on the
//! pictures: `target/figures/index.html`.
//!
//! The source is Chang, "Real-time Stylized Line-based Rendering of Animated Hairs" (2012); figures
//! keep its numbers. Two more have theirs behind a letter: S, Shin, Haller and Mukundan, "A Stylized Cartoon Hair Renderer" (2006), and D, a dissertation
//! on cartoon hair in Ogre. The presets are in `tests/figures`.

mod brushes;
mod feathers;
mod highlights;
mod measure;
mod normals;
mod page;
mod plot;
mod shin;
mod silhouettes;
mod sizes;
mod strips;
mod tones;

use std::fs;
use std::path::Path;

use crate::Outcome;
use crate::picture::Picture;
use crate::program::{self, Inkstrand, sum_up};
use crate::work;

/// A figure: pictures, and what they show.
pub struct Figure {
    /// The source's number.
    number: &'static str,
    title: &'static str,
    /// What there is to see, in our words.
    text: &'static str,
    shots: &'static [Shot],
    /// Holds what the text says against the pictures, which come in the order of `shots`.
    measure: fn(&[Picture]) -> Outcome<Finding>,
}

/// One picture of a figure.
struct Shot {
    /// What stands under it; a picture without a label is measured and not shown.
    label: &'static str,
    /// The preset, a file in `tests/figures` or with its folder.
    preset: &'static str,
    /// What else `inkstrand render` gets.
    args: &'static [&'static str],
}

/// What was measured on a figure's pictures.
struct Finding {
    sentence: String,
    /// An SVG element that shows it.
    drawing: Option<String>,
}

impl Finding {
    fn new(sentence: String) -> Self {
        Self {
            sentence,
            drawing: None,
        }
    }
}

impl Shot {
    const fn new(label: &'static str, preset: &'static str, args: &'static [&'static str]) -> Self {
        Self {
            label,
            preset,
            args,
        }
    }

    /// What `inkstrand render` gets.
    fn line(&self) -> Vec<String> {
        let preset = if self.preset.contains('/') {
            self.preset.to_owned()
        } else {
            format!("tests/figures/{}", self.preset)
        };
        let args = self.args.iter().map(|arg| (*arg).to_owned());
        [preset].into_iter().chain(args).collect()
    }
}

fn all() -> Vec<&'static Figure> {
    let subjects = [
        sizes::FIGURES,
        normals::FIGURES,
        silhouettes::FIGURES,
        feathers::FIGURES,
        highlights::FIGURES,
        brushes::FIGURES,
        shin::FIGURES,
        strips::FIGURES,
        tones::FIGURES,
    ];
    subjects.into_iter().flatten().collect()
}

/// The name of a picture's file.
fn file_name(figure: &Figure, shot: usize) -> String {
    format!("{}-{}.png", figure.number.replace(' ', ""), shot + 1)
}

/// Draws and measures all figures, and writes the page that shows them.
///
/// # Errors
/// A picture can't be drawn or is blank, or a figure doesn't show what it claims: all of them. The
/// page is written all the same.
pub fn run() -> Outcome {
    let folder = program::root().join("target/figures");
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    fs::create_dir_all(&folder)?;
    let program = Inkstrand::build()?;
    let figures = all();
    let shots: Vec<(&Figure, usize)> = figures
        .iter()
        .flat_map(|figure| (0..figure.shots.len()).map(|shot| (*figure, shot)))
        .collect();
    let mut pictures = work::on_all_cores(&shots, "pictures", |&(figure, shot)| {
        let path = folder.join(file_name(figure, shot));
        let mut line = figure.shots[shot].line();
        line.push("--threads=1".to_owned());
        program
            .render(&line, &path)
            .and_then(|()| load(&path))
            .map_err(|error| format!("picture {}: {error}", shot + 1))
    })
    .into_iter();

    let mut results = Vec::new();
    let mut failures = Vec::new();
    for figure in &figures {
        // Every picture is taken, or the next figure would get the rest.
        let drawn: Vec<Result<Picture, String>> =
            pictures.by_ref().take(figure.shots.len()).collect();
        let drawn: Result<Vec<Picture>, String> = drawn.into_iter().collect();
        let finding = drawn
            .map_err(Into::into)
            .and_then(|drawn| (figure.measure)(&drawn))
            .map_err(|error: Box<dyn std::error::Error>| error.to_string());
        match &finding {
            Ok(finding) => println!("  ok      {}: {}", figure.number, finding.sentence),
            Err(error) => {
                println!("  FAILED  {}: {error}", figure.number);
                failures.push(figure.number.to_owned());
            }
        }
        results.push((*figure, finding));
    }
    let index = folder.join("index.html");
    fs::write(&index, page::page(&results))?;
    println!("  page: {}", index.display());
    sum_up(figures.len(), &failures)
}

fn load(path: &Path) -> Outcome<Picture> {
    let picture = Picture::load(path)?;
    if picture.is_blank() {
        return Err("it is blank".into());
    }
    Ok(picture)
}

/// The finding, where `holds`.
fn claim(holds: bool, sentence: String) -> Outcome<Finding> {
    if holds {
        Ok(Finding::new(sentence))
    } else {
        Err(format!("the pictures show something else: {sentence}").into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sources_figures_are_all_there_in_order() {
        let numbers: Vec<&str> = all().iter().map(|figure| figure.number).collect();
        let expected = [
            "5.2", "5.3", "5.4", "5.5", "5.6", "5.7", "5.9", "5.10", "5.11", "5.12", "5.13", "7.1",
            "7.2", "S 8", "S 9", "S 12", "S 14", "D 4.17", "D 4.19", "D 4.8", "D 4.9", "D 4.10",
            "D 4.11", "D 4.12", "D 4.13",
        ];
        assert_eq!(numbers, expected);
    }

    #[test]
    fn every_preset_is_there() {
        for figure in all() {
            for shot in figure.shots {
                let line = shot.line();
                assert!(program::root().join(&line[0]).is_file(), "{}", line[0]);
            }
        }
    }

    #[test]
    fn a_claim_that_does_not_hold_is_an_error() {
        assert!(claim(true, "1 < 2".to_owned()).is_ok());
        let error = claim(false, "2 < 1".to_owned()).err().unwrap();
        assert!(error.to_string().ends_with("something else: 2 < 1"));
    }

    #[test]
    fn measures_of_wrong_pictures_fail() {
        for figure in all() {
            let blank = Picture {
                width: 640,
                height: 120,
                pixels: vec![[u16::MAX; 4]; 640 * 120],
            };
            let blanks = vec![blank; figure.shots.len()];
            assert!((figure.measure)(&blanks).is_err(), "{}", figure.number);
        }
    }
}
