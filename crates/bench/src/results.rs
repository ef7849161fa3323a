//! Rows of measurements, and the files they are written to.

use crate::BenchError;
use std::fmt::Write as _;
use std::io;
use std::path::Path;

/// The columns that every suite has.
pub const COLUMNS: &str = "suite,scene,method,knob,seconds,error";

/// One measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What was drawn.
    pub scene: String,
    /// By what.
    pub method: String,
    /// With which setting; what it means depends on the method.
    pub knob: usize,
    /// Median time.
    pub seconds: f64,
    /// Distance from the reference, in the suite's unit; nothing for a part of a method that makes no
    /// picture.
    pub error: Option<f64>,
}

/// A file of rows: `comments` on lines that begin with `#`, the columns, and a line a row.
#[must_use]
pub fn csv(suite: &str, comments: &[String], rows: &[Row]) -> String {
    let mut text = table(comments, COLUMNS, []);
    for row in rows {
        let error = row
            .error
            .map_or(String::new(), |error| format!("{error:.3e}"));
        let _ = writeln!(
            text,
            "{suite},{},{},{},{:.9},{error}",
            row.scene, row.method, row.knob, row.seconds
        );
    }
    text
}

/// Lines under their columns, after comments.
pub fn table(
    comments: &[String],
    columns: &str,
    lines: impl IntoIterator<Item = String>,
) -> String {
    let comments = comments.iter().map(|comment| format!("# {comment}"));
    let all = comments.chain([columns.to_owned()]).chain(lines);
    all.flat_map(|line| [line, "\n".to_owned()]).collect()
}

/// Writes a whole file beside `path`, then renames it, so that nobody sees half of one.
///
/// # Errors
///
/// When the folder cannot be made or written to.
pub fn write(path: &Path, text: &str) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let part = path.with_extension("part");
    std::fs::write(&part, text)?;
    std::fs::rename(&part, path)
}

/// Writes a file of a suite into the folder `out`.
///
/// # Errors
///
/// As [`write()`], in words.
pub fn save(out: &Path, name: &str, text: &str) -> Result<(), BenchError> {
    let path = out.join(name);
    write(&path, text).map_err(|error| format!("{}: {error}", path.display()).into())
}

/// The rows as a table to read.
#[must_use]
pub fn summary(rows: &[Row]) -> String {
    let width = |text: fn(&Row) -> &str| {
        let widths = rows.iter().map(|row| text(row).chars().count());
        widths.max().unwrap_or(0).max("method".len())
    };
    let (scenes, methods) = (width(|row| &row.scene), width(|row| &row.method));
    let mut text = format!(
        "{:scenes$} {:methods$} {:>5} {:>12} {:>10}\n",
        "scene", "method", "knob", "ms", "error"
    );
    for row in rows {
        let error = row
            .error
            .map_or(String::new(), |error| format!("{error:.5}"));
        let milliseconds = 1e3 * row.seconds;
        let _ = writeln!(
            text,
            "{:scenes$} {:methods$} {:5} {milliseconds:12.4} {error:>10}",
            row.scene, row.method, row.knob
        );
    }
    text
}

/// What a reader of any times must know: the machine, its threads, the versions of what was timed.
#[must_use]
pub fn machine(threads: usize, packages: &[&str]) -> Vec<String> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let versions: Vec<String> = packages
        .iter()
        .map(|package| format!("{package} {}", version_of(package)))
        .collect();
    vec![
        format!(
            "machine: {cores} cores, {} {}; {threads} threads",
            std::env::consts::ARCH,
            std::env::consts::OS
        ),
        format!("versions: {}", versions.join(", ")),
        "times of one run may be compared with each other, not with those of another".to_owned(),
    ]
}

/// The version of a package that this program was built with.
fn version_of(package: &str) -> &'static str {
    let lock = include_str!("../../../Cargo.lock");
    let name = format!("name = \"{package}\"\nversion = \"");
    let version = lock
        .split_once(&name)
        .and_then(|(_, rest)| rest.split('"').next());
    version.unwrap_or("unknown")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(error: Option<f64>) -> Row {
        Row {
            scene: "ponytails".to_owned(),
            method: "sweep".to_owned(),
            knob: 4,
            seconds: 0.0125,
            error,
        }
    }

    #[test]
    fn csv_has_the_columns_and_a_line_a_row() {
        let text = csv(
            "strokes",
            &["error: none".to_owned()],
            &[row(Some(0.5)), row(None)],
        );
        let expected = "# error: none\n\
            suite,scene,method,knob,seconds,error\n\
            strokes,ponytails,sweep,4,0.012500000,5.000e-1\n\
            strokes,ponytails,sweep,4,0.012500000,\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn the_table_to_read_is_as_wide_as_its_names() {
        let text = summary(&[row(Some(0.5)), row(None)]);
        let expected = "scene     method  knob           ms      error\n\
            ponytails sweep      4      12.5000    0.50000\n\
            ponytails sweep      4      12.5000           \n";
        assert_eq!(text, expected);
    }

    #[test]
    fn a_file_replaces_the_one_before() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/strokes.csv");
        write(&path, "a longer text").unwrap();
        write(&path, "text").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "text");
        assert_eq!(
            std::fs::read_dir(path.parent().unwrap()).unwrap().count(),
            1
        );
        assert!(write(&folder.path().join("new/strokes.csv/x"), "").is_err());
    }

    #[test]
    fn versions_come_from_the_lock_file() {
        let lines = machine(2, &["tiny-skia", "vello_cpu", "no-such-package"]);
        assert!(lines[0].contains("2 threads"));
        let versions = &lines[1];
        assert!(versions.contains("tiny-skia 0."), "{versions}");
        assert!(versions.contains("vello_cpu 0."), "{versions}");
        assert!(versions.contains("no-such-package unknown"));
    }
}
