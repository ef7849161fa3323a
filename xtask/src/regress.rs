//! Golden pictures: what the program draws now against what it drew when a person last looked.
//!
//! `tests/golden/cases.toml` lists the cases, `tests/golden/NAME.png` are the pictures. They must
//! be the same bit by bit; how they differ is shown in `target/regress/index.html`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::picture::{Difference, Picture};
use crate::program::{self, Inkstrand};
use crate::{Outcome, report};

/// The list of cases, as `cases.toml` holds it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Cases {
    case: Vec<Case>,
}

/// A picture that must stay as it is.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// The name of its file, without `.png`.
    pub name: String,
    /// What `inkstrand render` gets, the preset first.
    pub args: Vec<String>,
}

/// What came of a case. The pictures lie in the folder of the report as `NAME.expected.png`,
/// `NAME.actual.png` and `NAME.difference.png`.
#[derive(Debug, PartialEq)]
pub enum Verdict {
    Same,
    /// No golden picture yet.
    New,
    Differs(Difference),
    /// No picture, or one that can't be compared; the reason.
    Failed(String),
}

/// The folders that a run reads and writes.
struct Folders {
    golden: PathBuf,
    report: PathBuf,
}

/// Compares the cases whose name contains `filter`, or makes their pictures golden.
///
/// # Errors
/// A picture differs, is missing or can't be drawn; the list of cases is wrong; `bless` where
/// `CI=true`.
pub fn run(filter: &str, backend: &str, bless: bool) -> Outcome {
    if bless && program::on_ci() {
        return Err("--bless is for a person who has looked; not where CI=true".into());
    }
    let folders = Folders {
        golden: program::root().join("tests/golden"),
        report: program::root().join("target/regress"),
    };
    let mut cases = folders.cases()?;
    if filter.is_empty() {
        folders.find_strays(&cases)?;
    }
    cases.retain(|case| case.name.contains(filter));
    if cases.is_empty() {
        return Err(format!("no case has {filter:?} in its name").into());
    }

    let program = Inkstrand::build()?;
    let backend = format!("--backend={backend}");
    let draw = |case: &Case, picture: &Path| {
        let mut args = case.args.clone();
        args.push(backend.clone());
        program.render(&args, picture)
    };
    let verdicts = folders.judge(&cases, draw)?;
    let page = folders.report.join("index.html");
    fs::write(&page, report::page(cases.iter().zip(&verdicts)))?;
    println!("  report: {}", page.display());
    if bless {
        return folders.bless(&cases, &verdicts);
    }
    let failures: Vec<String> = cases
        .iter()
        .zip(&verdicts)
        .filter(|(_, verdict)| **verdict != Verdict::Same)
        .map(|(case, _)| case.name.clone())
        .collect();
    sum_up(cases.len(), &failures)
}

/// Ends a run over `total` things by naming those that failed.
///
/// # Errors
/// Some did.
pub fn sum_up(total: usize, failures: &[String]) -> Outcome {
    if failures.is_empty() {
        return Ok(());
    }
    Err(format!(
        "{} of {total} failed: {}",
        failures.len(),
        failures.join(", ")
    )
    .into())
}

impl Verdict {
    /// One line for the maintainer.
    pub fn sentence(&self) -> String {
        match self {
            Self::Same => "ok".to_owned(),
            Self::New => "NEW: look at it, then `cargo xtask regress --bless`".to_owned(),
            Self::Differs(Difference { pixels, largest }) => {
                let steps = f32::from(*largest) / 257.0;
                format!("DIFFERS: {pixels} pixels, by {steps:.3}/255 at most")
            }
            Self::Failed(reason) => format!("FAILED: {reason}"),
        }
    }
}

impl Folders {
    fn cases(&self) -> Outcome<Vec<Case>> {
        let path = self.golden.join("cases.toml");
        let text = fs::read_to_string(&path);
        let text = text.map_err(|error| format!("{}: {error}", path.display()))?;
        parse(&text).map_err(|error| format!("{}: {error}", path.display()).into())
    }

    /// Golden pictures that no case draws are dead weight, or a case lost by mistake.
    fn find_strays(&self, cases: &[Case]) -> Outcome {
        for entry in fs::read_dir(&self.golden)? {
            let path = entry?.path();
            let name = path.file_stem().unwrap_or_default();
            let is_picture = path.extension().is_some_and(|extension| extension == "png");
            if is_picture && !cases.iter().any(|case| name == case.name.as_str()) {
                return Err(format!("{} belongs to no case", path.display()).into());
            }
        }
        Ok(())
    }

    /// Draws all cases and compares; leaves the pictures in an emptied folder of the report.
    fn judge(
        &self,
        cases: &[Case],
        draw: impl Fn(&Case, &Path) -> Outcome,
    ) -> Outcome<Vec<Verdict>> {
        if self.report.exists() {
            fs::remove_dir_all(&self.report)?;
        }
        fs::create_dir_all(&self.report)?;
        let verdict = |case: &Case| {
            let verdict = draw(case, &self.picture(case, "actual"))
                .and_then(|()| self.compare(case))
                .unwrap_or_else(|error| Verdict::Failed(error.to_string()));
            println!("  {}: {}", case.name, verdict.sentence());
            verdict
        };
        Ok(cases.iter().map(verdict).collect())
    }

    fn compare(&self, case: &Case) -> Outcome<Verdict> {
        let actual = Picture::load(&self.picture(case, "actual"))?;
        let golden = self.golden_picture(case);
        if !golden.exists() {
            return Ok(Verdict::New);
        }
        fs::copy(&golden, self.picture(case, "expected"))?;
        let expected = Picture::load(&golden)?;
        let Some(difference) = expected.compare(&actual)? else {
            return Ok(Verdict::Same);
        };
        let shown = expected.amplified_difference(&actual, difference.largest);
        shown.save(&self.picture(case, "difference"))?;
        Ok(Verdict::Differs(difference))
    }

    /// Copies the pictures that aren't golden yet. Those that are stay untouched, whatever
    /// the encoder does now.
    fn bless(&self, cases: &[Case], verdicts: &[Verdict]) -> Outcome {
        let mut failures = Vec::new();
        for (case, verdict) in cases.iter().zip(verdicts) {
            let actual = self.picture(case, "actual");
            match verdict {
                Verdict::Same => {}
                // Another size, or a broken golden picture: there is something to bless.
                _ if Picture::load(&actual).is_ok() => {
                    let golden = self.golden_picture(case);
                    let beside = golden.with_extension("png.new");
                    fs::copy(&actual, &beside)?;
                    fs::rename(&beside, &golden)?;
                    println!("  blessed {}", case.name);
                }
                _ => failures.push(case.name.clone()),
            }
        }
        sum_up(cases.len(), &failures)
    }

    fn golden_picture(&self, case: &Case) -> PathBuf {
        self.golden.join(format!("{}.png", case.name))
    }

    fn picture(&self, case: &Case, what: &str) -> PathBuf {
        self.report.join(format!("{}.{what}.png", case.name))
    }
}

/// Reads the list of cases. Names become names of files, so they are held to letters that are
/// the same everywhere.
fn parse(text: &str) -> Outcome<Vec<Case>> {
    let Cases { case: cases } = toml::from_str(text)?;
    if cases.is_empty() {
        return Err("there is no case".into());
    }
    let mut names = BTreeSet::new();
    for Case { name, args } in &cases {
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
    use tempfile::TempDir;

    use super::*;
    use crate::picture::tests::made;

    fn folders() -> (TempDir, Folders) {
        let root = tempfile::tempdir().unwrap();
        let folders = Folders {
            golden: root.path().join("golden"),
            report: root.path().join("report"),
        };
        fs::create_dir(&folders.golden).unwrap();
        (root, folders)
    }

    fn case(name: &str) -> Case {
        Case {
            name: name.to_owned(),
            args: vec!["presets/made.ron".to_owned()],
        }
    }

    fn draw_made(_: &Case, path: &Path) -> Outcome {
        made().save(path)
    }

    /// The verdict on one case whose golden picture is `golden`, drawn now as `actual`.
    fn verdict(golden: &Picture, actual: &Picture) -> Verdict {
        let (_root, folders) = folders();
        let case = case("made");
        golden.save(&folders.golden_picture(&case)).unwrap();
        let draw = |_: &Case, path: &Path| actual.save(path);
        let mut verdicts = folders.judge(&[case], draw).unwrap();
        verdicts.remove(0)
    }

    #[test]
    fn the_same_picture_passes() {
        assert_eq!(verdict(&made(), &made()), Verdict::Same);
    }

    #[test]
    fn a_picture_that_should_fail_does() {
        let mut actual = made();
        actual.pixels[5][2] += 257; // one step of 255 in one channel of one pixel
        let difference = Difference {
            pixels: 1,
            largest: 257,
        };
        let verdict = verdict(&made(), &actual);
        assert_eq!(verdict, Verdict::Differs(difference));
        assert_eq!(
            verdict.sentence(),
            "DIFFERS: 1 pixels, by 1.000/255 at most"
        );
    }

    #[test]
    fn another_size_fails() {
        let mut actual = made();
        actual.height -= 1;
        actual.pixels.truncate(40);
        let reason = "8x5 in place of 8x6".to_owned();
        assert_eq!(verdict(&made(), &actual), Verdict::Failed(reason));
    }

    #[test]
    fn blessing_makes_new_and_different_pictures_golden() {
        let (_root, folders) = folders();
        let cases = [case("new"), case("other"), case("same"), case("undrawn")];
        let mut other = made();
        other.pixels[0] = [0; 4];
        other.save(&folders.golden_picture(&cases[1])).unwrap();
        made().save(&folders.golden_picture(&cases[2])).unwrap();
        let draw = |case: &Case, path: &Path| match case.name.as_str() {
            "undrawn" => Err("line 3: no such effect".into()),
            _ => draw_made(case, path),
        };

        let verdicts = folders.judge(&cases, draw).unwrap();
        assert_eq!(verdicts[0], Verdict::New);
        assert!(matches!(verdicts[1], Verdict::Differs(_)));
        assert_eq!(verdicts[2], Verdict::Same);
        let reason = "line 3: no such effect".to_owned();
        assert_eq!(verdicts[3], Verdict::Failed(reason));

        let error = folders.bless(&cases, &verdicts).unwrap_err();
        assert_eq!(error.to_string(), "1 of 4 failed: undrawn");
        let verdicts = folders.judge(&cases[..3], draw_made).unwrap();
        assert_eq!(verdicts, [Verdict::Same, Verdict::Same, Verdict::Same]);
        assert!(!folders.golden_picture(&cases[3]).exists());
        folders.find_strays(&cases).unwrap();
    }

    #[test]
    fn a_golden_picture_without_a_case_is_found() {
        let (_root, folders) = folders();
        fs::write(folders.golden.join("cases.toml"), "").unwrap();
        made().save(&folders.golden.join("lost.png")).unwrap();
        let error = folders.find_strays(&[case("made")]).unwrap_err();
        assert!(error.to_string().ends_with("lost.png belongs to no case"));
        folders.find_strays(&[case("lost")]).unwrap();
    }

    #[test]
    fn a_broken_golden_picture_fails() {
        let (_root, folders) = folders();
        let case = case("made");
        fs::write(folders.golden_picture(&case), "no picture").unwrap();
        let verdicts = folders.judge(&[case], draw_made).unwrap();
        assert!(matches!(verdicts[0], Verdict::Failed(_)));
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
