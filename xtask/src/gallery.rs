//! A contact sheet of each look: the result, its strands, other views and lights, and motion. Written to
//! `target/gallery` with a page that names the cells.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::Outcome;
use crate::html::{escape, head};
use crate::looks;
use crate::picture::Picture;
use crate::program::{self, Inkstrand, sum_up};
use crate::work;

/// A cell of every sheet: what it shows, and what `inkstrand render` gets beside the preset. A look that can't have it has
/// an empty place there.
struct Cell(&'static str, &'static [&'static str]);

/// What of an argument stands for the look's own hair, the layer that paints it.
const HAIR: &str = "HAIR";
/// Effects that paint the hair itself.
const PAINTS_HAIR: [&str; 2] = ["hair.base", "hair.toon"];
/// What a look of `objects` says in the presets of its heads alone.
const OF_ONE_HEAD: [&str; 3] = ["--only=", "--set=", "--motion="];

const TURN: &str = "--motion=presets/motions/head-turn.motion.ron";
const WALK: &str = "--motion=presets/motions/walk-in-wind.motion.ron";

const CELLS: &[Cell] = &[
    Cell("the result", &[]),
    // Thin strokes along the strands.
    Cell(
        "its strands",
        &[
            "--only=HAIR",
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
    let mut jobs = Vec::new();
    for look in &looks {
        let text = fs::read_to_string(program::root().join(preset(look)))?;
        jobs.extend(
            CELLS
                .iter()
                .map(|cell| (*look, cell, line(look, &text, cell))),
        );
    }
    let draw = |(look, Cell(what, _), line): &(&str, &Cell, Option<Vec<String>>)| {
        let path = scratch.path().join(format!("{look}, {what}.png"));
        line.as_ref().map(|line| picture(&program, line, &path))
    };
    let pictures = work::on_all_cores(&jobs, "pictures", draw);

    let mut failures = Vec::new();
    for (look, pictures) in looks.iter().zip(pictures.chunks(CELLS.len())) {
        for (Cell(what, _), picture) in CELLS.iter().zip(pictures) {
            if let Some(Err(error)) = picture {
                println!("  FAILED  {look}, {what}: {error}");
                failures.push(format!("{look}, {what}"));
            }
        }
        let path = folder.join(format!("{look}.png"));
        sheet(pictures).save(&path)?;
        println!("  {}", path.display());
    }
    let index = folder.join("index.html");
    fs::write(&index, page(&looks))?;
    println!("  page: {}", index.display());
    sum_up(pictures.iter().flatten().count(), &failures)
}

/// A look's file.
fn preset(look: &str) -> String {
    format!("presets/{look}.ron")
}

/// Draws a cell, at `path` for the time being.
fn picture(program: &Inkstrand, line: &[String], path: &Path) -> Result<Picture, String> {
    let drawn = program.render(line, path);
    let picture = drawn.and_then(|()| Picture::load(path));
    match picture {
        Ok(picture) if picture.is_blank() => Err("it is blank".to_owned()),
        other => other.map_err(|error| error.to_string()),
    }
}

/// What `inkstrand render` gets for a cell of a look whose preset says `text`; nothing where the look can't have the cell.
fn line(look: &str, text: &str, Cell(_, args): &Cell) -> Option<Vec<String>> {
    let text = without_comments(text);
    let is_of_one_head = |arg: &&str| OF_ONE_HEAD.iter().any(|start| arg.starts_with(start));
    if text.contains("objects:") && args.iter().any(is_of_one_head) {
        return None;
    }
    let mut line = vec![
        preset(look),
        format!("--size={WIDTH}x{HEIGHT}"),
        "--threads=1".to_owned(),
    ];
    for arg in *args {
        line.push(match arg.contains(HAIR) {
            true => arg.replace(HAIR, hair_layer(&text)?),
            false => (*arg).to_owned(),
        });
    }
    Some(line)
}

/// The name of the first layer that paints hair itself: its own, or its effect's.
fn hair_layer(text: &str) -> Option<&str> {
    let layers = text.split("effect: \"").skip(1);
    let mut named = layers.filter_map(|layer| {
        let (effect, rest) = layer.split_once('"')?;
        let name = rest.strip_prefix(", name: \"");
        let name = name.and_then(|name| name.split_once('"'));
        Some((effect, name.map_or(effect, |(name, _)| name)))
    });
    let layer = named.find(|(effect, _)| PAINTS_HAIR.contains(effect));
    layer.map(|(_, name)| name)
}

fn without_comments(preset: &str) -> String {
    let lines = preset.lines().filter_map(|line| line.split("//").next());
    lines.collect::<Vec<_>>().join("\n")
}

/// The pictures side by side; a place stays empty where there is none.
fn sheet(pictures: &[Option<Result<Picture, String>>]) -> Picture {
    let rows = (pictures.len() as u32).div_ceil(COLUMNS);
    let mut sheet = Picture::blank(COLUMNS * WIDTH, rows * HEIGHT);
    for (index, picture) in (0..).zip(pictures) {
        if let Some(Ok(picture)) = picture {
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
        let none = [vec![Some(Err("no".to_owned())); 4], vec![None]].concat();
        let sheet = sheet(&[none, vec![Some(Ok(red.clone()))]].concat());
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

    /// No look is asked for a layer that it hasn't, or, where it is of several heads, for what each of them has.
    #[test]
    fn looks_are_asked_for_what_they_have() {
        for look in looks::names().unwrap() {
            let text = fs::read_to_string(program::root().join(preset(&look))).unwrap();
            let is_of_objects = text.contains("\n    objects: [");
            let has_hair = text.contains("\n    hair: (");
            for cell in CELLS {
                let Some(line) = line(&look, &text, cell) else {
                    assert!(is_of_objects || !has_hair, "{look}, {}", cell.0);
                    continue;
                };
                for arg in &line {
                    let is_of_one_head = OF_ONE_HEAD.iter().any(|start| arg.starts_with(start));
                    assert!(!is_of_objects || !is_of_one_head, "{look}: {arg}");
                    if let Some(layer) = arg.strip_prefix("--only=") {
                        let effect = format!("effect: \"{layer}\"");
                        let mut unnamed = text.split(&effect).skip(1);
                        let layers = unnamed.any(|rest| !rest.starts_with(", name"))
                            || text.contains(&format!("name: \"{layer}\""));
                        assert!(layers, "{look}: {arg}");
                    }
                }
            }
        }
    }
}
