//! Contact sheets: many small pictures in one.

use std::path::Path;

use super::case::Cell;
use crate::Outcome;
use crate::picture::Picture;

/// Width and height of a cell in pixels, which `--size` sets.
pub const CELL: u32 = 96;
const COLUMNS: u32 = 8;

/// The upper left corner of a cell in its sheet, pixels.
pub fn corner(index: usize) -> (u32, u32) {
    let index = index as u32;
    (index % COLUMNS * CELL, index / COLUMNS * CELL)
}

/// Draws the cells, each with what it sets, and writes them as one picture.
///
/// # Errors
/// A cell can't be drawn or has another size, or a parameter is there whose cells all look as if it
/// were not set.
pub fn draw(cells: &[Cell], path: &Path, render: impl Fn(&[String], &Path) -> Outcome) -> Outcome {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("cell.png");
    let mut pictures = Vec::new();
    for cell in cells {
        let named = |error| format!("cell {}: {error}", cell.name);
        render(&cell.sets, &file).map_err(named)?;
        let picture = Picture::load(&file).map_err(named)?;
        if (picture.width, picture.height) != (CELL, CELL) {
            return Err(format!("cell {}: not {CELL}x{CELL}", cell.name).into());
        }
        pictures.push(picture);
    }
    let unseen = parameters_unseen(cells, &pictures);
    if !unseen.is_empty() {
        return Err(format!(
            "at neither end does one see {}: say in extremes.toml what it needs to show",
            unseen.join(", ")
        )
        .into());
    }
    let rows = (cells.len() as u32).div_ceil(COLUMNS);
    let mut sheet = Picture::blank(COLUMNS * CELL, rows * CELL);
    for (index, picture) in pictures.iter().enumerate() {
        sheet.paste(picture, corner(index));
    }
    sheet.save(path)
}

/// The parameters whose cells all look like those they stand beside.
fn parameters_unseen<'a>(cells: &'a [Cell], pictures: &[Picture]) -> Vec<&'a str> {
    let mut unseen: Vec<&str> = Vec::new();
    let mut seen: Vec<&str> = Vec::new();
    for (cell, picture) in cells.iter().zip(pictures) {
        let Some(beside) = cell.beside else { continue };
        if *picture == pictures[beside] {
            unseen.push(&cell.shows);
        } else {
            seen.push(&cell.shows);
        }
    }
    unseen.retain(|name| !seen.contains(name));
    unseen.dedup();
    unseen
}

/// The names of the cells in which two sheets of one size differ.
pub fn cells_that_differ(cells: &[Cell], expected: &Picture, actual: &Picture) -> Vec<String> {
    let differs = |index: usize| {
        let corner = corner(index);
        expected.cut(corner, (CELL, CELL)) != actual.cut(corner, (CELL, CELL))
    };
    let named = cells.iter().enumerate();
    named
        .filter(|(index, _)| differs(*index))
        .map(|(_, cell)| cell.name.clone())
        .collect()
}

#[cfg(test)]
pub mod tests {
    use super::*;

    pub fn cell(name: &str, beside: Option<usize>) -> Cell {
        Cell {
            name: name.to_owned(),
            sets: vec![name.to_owned()],
            beside,
            shows: name.split('=').next().unwrap_or_default().to_owned(),
        }
    }

    /// A cell whose gray is the number after the `=`.
    fn render(sets: &[String], path: &Path) -> Outcome {
        let gray: u16 = sets[0].split('=').nth(1).unwrap().parse().unwrap();
        let mut picture = Picture::blank(CELL, CELL);
        picture.pixels.fill([gray * 257, 0, 0, u16::MAX]);
        picture.save(path)
    }

    #[test]
    fn a_cell_that_differs_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let sheet = |numbers: [u16; 10]| {
            let cells: Vec<Cell> = numbers
                .iter()
                .map(|n| cell(&format!("a={n}"), None))
                .collect();
            let path = folder.path().join("sheet.png");
            draw(&cells, &path, render).unwrap();
            (cells, Picture::load(&path).unwrap())
        };
        let (cells, golden) = sheet([0, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
        assert_eq!((golden.width, golden.height), (8 * CELL, 2 * CELL));
        assert!(cells_that_differ(&cells, &golden, &golden).is_empty());

        // One pixel of one cell, by one step.
        let mut actual = golden.clone();
        let (x, y) = corner(9);
        actual.pixels[((y + 5) * actual.width + x + 95) as usize][0] += 257;
        assert_eq!(cells_that_differ(&cells, &golden, &actual), ["a=9"]);
    }

    #[test]
    fn a_parameter_that_shows_nowhere_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sheet.png");
        let cells = [
            cell("base=7", None),
            cell("size=7", Some(0)),
            cell("size=8", Some(0)),
            cell("idle=7", Some(0)),
        ];
        let error = draw(&cells, &path, render).unwrap_err().to_string();
        assert!(error.contains("one see idle:"), "{error}");
        assert!(!path.exists());
        draw(&cells[..3], &path, render).unwrap();
    }
}
