//! A page of what all suites found: targets, plots, rows.

use crate::BenchError;
use crate::results::{Row, summary};
use crate::targets::{Target, report};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// What a suite found.
pub struct Finished {
    /// Its name.
    pub suite: &'static str,
    /// What was measured.
    pub rows: Vec<Row>,
    /// What it is held to.
    pub targets: Vec<Target>,
    /// The files that it wrote.
    pub files: Vec<PathBuf>,
}

const STYLE: &str = "body { font: 14px sans-serif; margin: 2em; } pre { font-size: 12px; } svg, img { max-width: 100%; } \
    .missed { color: #a00; }";

/// The page, to be written into `folder`, in which the files are. Plots are in it, pictures beside it.
///
/// # Errors
///
/// When a plot cannot be read again.
pub fn page(suites: &[Finished], machine: &[String], folder: &Path) -> Result<String, BenchError> {
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>inkstrand: benchmarks</title>\n\
         <style>{STYLE}</style>\n<h1>Benchmarks</h1>\n"
    );
    for line in machine {
        let _ = writeln!(page, "<p>{}</p>", escape(line));
    }
    for done in suites {
        let missed = done
            .targets
            .iter()
            .filter(|target| !target.is_met())
            .count();
        let class = if missed == 0 { "met" } else { "missed" };
        let _ = writeln!(
            page,
            "<h2>{}</h2>\n<p class=\"{class}\">{} of {} targets met</p>\n<pre>{}</pre>",
            done.suite,
            done.targets.len() - missed,
            done.targets.len(),
            escape(&report(&done.targets))
        );
        for file in &done.files {
            let name = file
                .strip_prefix(folder)
                .unwrap_or(file)
                .display()
                .to_string();
            let name = escape(&name);
            match file.extension().and_then(|ending| ending.to_str()) {
                Some("svg") => {
                    let plot = std::fs::read_to_string(file);
                    page += &plot.map_err(|error| format!("{}: {error}", file.display()))?;
                }
                Some("png") => {
                    let _ = writeln!(page, "<p><img src=\"{name}\" alt=\"{name}\"></p>");
                }
                _ => {
                    let _ = writeln!(page, "<p><a href=\"{name}\">{name}</a></p>");
                }
            }
        }
        if !done.rows.is_empty() {
            let rows = escape(&summary(&done.rows));
            let _ = writeln!(
                page,
                "<details><summary>all rows</summary><pre>{rows}</pre></details>"
            );
        }
    }
    Ok(page)
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::targets::{Found, Limit};

    #[test]
    fn a_page_holds_targets_plots_and_rows() {
        let folder = tempfile::tempdir().unwrap();
        let plot = folder.path().join("strokes.svg");
        std::fs::write(&plot, "<svg>a plot</svg>").unwrap();
        let picture = folder.path().join("coherence/a.png");
        let target = |found| Target {
            text: "sweep < vello".to_owned(),
            found: Some(Found::Is(found)),
            limit: Limit::AtMost(0.5),
        };
        let done = Finished {
            suite: "strokes",
            rows: vec![Row {
                scene: "ponytails".to_owned(),
                method: "sweep".to_owned(),
                knob: 4,
                seconds: 0.0125,
                error: None,
            }],
            targets: vec![target(0.4), target(0.6)],
            files: vec![plot.clone(), picture],
        };
        let page = page(&[done], &["2 cores".to_owned()], folder.path()).unwrap();
        for text in [
            "1 of 2 targets met",
            "sweep &lt; vello",
            "<svg>a plot</svg>",
            "src=\"coherence/a.png\"",
            "ponytails",
            "2 cores",
        ] {
            assert!(page.contains(text), "{text} in {page}");
        }
        std::fs::remove_file(&plot).unwrap();
    }
}
