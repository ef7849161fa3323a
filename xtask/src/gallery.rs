//! A contact sheet of each look: the result, its strands, other views and lights, and motion. Written to
//! `target/gallery` with a page that names the cells.

use std::fmt::Write as _;
use std::fs;

use crate::Outcome;
use crate::html::{escape, head};
use crate::looks;
use crate::picture::Picture;
use crate::program::{self, Inkstrand, sum_up};
use crate::work;

/// A cell of every sheet: what it shows, and what `inkstrand render` gets beside the preset.
struct Cell(&'static str, &'static [&'static str]);

const TURN: &str = "--motion=presets/motions/head-turn.motion.ron";
const WALK: &str = "--motion=presets/motions/walk-in-wind.motion.ron";

const CELLS: &[Cell] = &[
    Cell("the result", &[]),
    // Thin strokes of one colour along the strands.
    Cell(
        "its strands",
        &[
            "--only=hair.base",
            "--set=clump.size=0.1",
            "--set=clump.mix=1",
            "--set=clump.shrink_start=1",
            "--set=path.brush=circle",
        ],
    ),
    Cell("three-quarter view", &["--camera=-40,8"]),
    Cell("profile", &["--camera=90,4"]),
    Cell("from behind", &["--camera=180,6"]),
    Cell("from above", &["--camera=30,45"]),
    Cell("light from the left", &["--light=-70,25"]),
    Cell("light from the right", &["--light=70,25"]),
    Cell("light from above", &["--light=0,80"]),
    Cell("light from behind", &["--light=160,35"]),
    Cell("the head turns, 0.5 s", &[TURN, "--time=0.5"]),
    Cell("the head turns, 0.9 s", &[TURN, "--time=0.9"]),
    Cell("the hair settles, 4.5 s", &[TURN, "--time=4.5"]),
    Cell("walking in wind, 1 s", &[WALK, "--time=1"]),
    Cell("walking in wind, 1.75 s", &[WALK, "--time=1.75"]),
    Cell("walking in wind, 2.5 s", &[WALK, "--time=2.5"]),
];

const COLUMNS: u32 = 4;
/// Size of a cell, pixels.
const WIDTH: u32 = 320;
const HEIGHT: u32 = 300;

/// Draws the sheets of all presets whose name contains `filter`, and the page.
///
/// # Errors
/// A cell can't be drawn or is blank; the sheets of the other looks are written all the same.
pub fn run(filter: &str) -> Outcome {
    let folder = program::root().join("target/gallery");
    let all = looks::names()?;
    let names = all.iter().map(String::as_str);
    let looks: Vec<&str> = names.filter(|name| name.contains(filter)).collect();
    if looks.is_empty() {
        return Err(format!("no preset has {filter:?} in its name").into());
    }
    fs::create_dir_all(&folder)?;
    let program = Inkstrand::build()?;
    let scratch = tempfile::tempdir()?;
    let jobs: Vec<(&str, usize)> = looks
        .iter()
        .flat_map(|look| (0..CELLS.len()).map(|cell| (*look, cell)))
        .collect();
    let draw = |&(look, cell): &(&str, usize)| -> Result<Picture, String> {
        let path = scratch.path().join(format!("{look}-{cell}.png"));
        let line = line(look, &CELLS[cell]);
        let drawn = program
            .render(&line, &path)
            .and_then(|()| Picture::load(&path));
        match drawn {
            Ok(picture) if picture.is_blank() => Err("it is blank".to_owned()),
            other => other.map_err(|error| error.to_string()),
        }
    };
    let pictures = work::on_all_cores(&jobs, "pictures", draw);

    let mut failures = Vec::new();
    for (look, pictures) in looks.iter().zip(pictures.chunks(CELLS.len())) {
        for (Cell(what, _), error) in CELLS
            .iter()
            .zip(pictures)
            .filter_map(|(c, p)| Some((c, p.as_ref().err()?)))
        {
            println!("  FAILED  {look}, {what}: {error}");
            failures.push(format!("{look}, {what}"));
        }
        let path = folder.join(format!("{look}.png"));
        sheet(pictures).save(&path)?;
        println!("  {}", path.display());
    }
    let index = folder.join("index.html");
    fs::write(&index, page(&looks))?;
    println!("  page: {}", index.display());
    sum_up(jobs.len(), &failures)
}

/// What `inkstrand render` gets for a cell.
fn line(look: &str, Cell(_, args): &Cell) -> Vec<String> {
    let preset = format!("presets/{look}.ron");
    let common = [format!("--size={WIDTH}x{HEIGHT}"), "--threads=1".to_owned()];
    let args = args.iter().map(|arg| (*arg).to_owned());
    [preset].into_iter().chain(common).chain(args).collect()
}

/// The pictures side by side; a place stays empty where there is none.
fn sheet(pictures: &[Result<Picture, String>]) -> Picture {
    let rows = (pictures.len() as u32).div_ceil(COLUMNS);
    let mut sheet = Picture::blank(COLUMNS * WIDTH, rows * HEIGHT);
    for (index, picture) in (0..).zip(pictures) {
        if let Ok(picture) = picture {
            sheet.paste(picture, (index % COLUMNS * WIDTH, index / COLUMNS * HEIGHT));
        }
    }
    sheet
}

fn page(looks: &[&str]) -> String {
    let mut page = head(
        "Looks of inkstrand",
        "img { max-width: 100%; } td { width: 25%; padding: 2px 12px; } table { width: 100%; max-width: 1280px; }",
    );
    page += "<h1>Looks</h1>\n<p>The cells of each sheet:</p>\n<table>\n";
    for row in CELLS.chunks(COLUMNS as usize) {
        let cells: String = row
            .iter()
            .map(|Cell(what, _)| format!("<td>{}</td>", escape(what)))
            .collect();
        // Writing to a String cannot fail.
        let _ = writeln!(page, "<tr>{cells}</tr>");
    }
    page += "</table>\n";
    for look in looks {
        let _ = writeln!(
            page,
            "<h2>{look}</h2>\n<img src=\"{look}.png\" alt=\"none\">"
        );
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_has_a_place_for_every_cell() {
        let mut red = Picture::blank(WIDTH, HEIGHT);
        red.pixels.fill([u16::MAX, 0, 0, u16::MAX]);
        let sheet = sheet(&[vec![Err("no".to_owned()); 5], vec![Ok(red.clone())]].concat());
        assert_eq!((sheet.width, sheet.height), (4 * WIDTH, 2 * HEIGHT));
        assert_eq!(sheet.cut((WIDTH, HEIGHT), (WIDTH, HEIGHT)), red);
        assert!(sheet.cut((0, 0), (4 * WIDTH, HEIGHT)).is_blank());
    }

    #[test]
    fn the_page_names_cells_and_shows_looks() {
        let page = page(&["long-pink", "manga-ink"]);
        assert!(page.contains("src=\"manga-ink.png\"") && page.contains("<td>from behind</td>"));
    }

    #[test]
    fn files_that_cells_name_are_there() {
        for Cell(what, args) in CELLS {
            for file in args.iter().filter_map(|arg| arg.strip_prefix("--motion=")) {
                assert!(program::root().join(file).is_file(), "{what}: {file}");
            }
        }
    }
}
