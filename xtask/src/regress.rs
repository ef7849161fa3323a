//! Golden pictures: what the program draws now against what it drew when a person last looked.
//!
//! `tests/golden/cases.toml` lists the cases, `tests/golden/NAME.png` are the pictures. They must
//! be the same bit by bit; how they differ is shown in `target/regress/index.html`. Beside the cases
//! of the list, which show the engine on `tests/yardsticks`, there is a contact sheet for each effect,
//! with a cell for each end of each parameter, and a picture of each look of `presets`.
//!
//! A graphics card draws the same cases, of the looks those whose samples are painted or have passes, and its pictures must agree with the golden ones but for
//! rounding (`agree`), on a sheet in each cell.

mod agree;
mod case;
mod extremes;
mod report;
mod sheet;
mod verdict;

use std::fs;
use std::path::{Path, PathBuf};

use crate::picture::Picture;
use crate::program::{self, Inkstrand, sum_up};
use crate::{Outcome, looks, setup, work};
use agree::Agreement;
use case::Case;
use verdict::Verdict;

/// What draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// The CPU: golden pictures are its own, bit by bit.
    Cpu,
    /// A graphics card, or a driver in software.
    Gpu,
}

/// The folders that a run reads and writes.
struct Folders {
    golden: PathBuf,
    report: PathBuf,
    backend: Backend,
}

/// Compares the cases whose name contains `filter`, or makes their pictures golden.
///
/// # Errors
/// A picture differs, is missing or can't be drawn; the list of cases is wrong; `bless` where
/// `CI=true`.
pub fn run(filter: &str, backend: Backend, bless: bool) -> Outcome {
    if bless && program::on_ci() {
        return Err("--bless is for a person who has looked; not where CI=true".into());
    }
    let report = match backend {
        Backend::Cpu => "target/regress",
        Backend::Gpu => "target/regress-gpu",
    };
    if backend == Backend::Gpu {
        if bless {
            return Err("golden pictures are the CPU's: --bless goes without --backend gpu".into());
        }
        if !setup::has_vulkan_driver() && cfg!(target_os = "linux") {
            let message = "no Vulkan driver: `cargo xtask setup` installs one";
            if program::on_ci() {
                return Err(message.into());
            }
            println!("SKIPPED: {message}");
            return Ok(());
        }
    }
    let folders = Folders {
        golden: program::root().join("tests/golden"),
        report: program::root().join(report),
        backend,
    };
    let program = Inkstrand::build()?;
    let mut cases = folders.cases()?;
    cases.extend(extremes::cases(&folders.golden, &program.schema()?)?);
    let looks = case::looks(&looks::names()?);
    let all = [&cases[..], &looks].concat();
    if filter.is_empty() {
        folders.find_strays(&all)?;
    }
    if backend == Backend::Cpu {
        cases = all;
    } else {
        cases.extend(case::looks(&looks::of_samples()?));
    }
    cases.retain(|case| case.name.contains(filter));
    if cases.is_empty() {
        return Err(format!("no case has {filter:?} in its name").into());
    }

    // All cores draw, a picture each.
    let name = if backend == Backend::Cpu {
        "cpu"
    } else {
        "gpu"
    };
    let common = [format!("--backend={name}"), "--threads=1".to_owned()];
    let draw = |case: &Case, picture: &Path| {
        let args = [&case.args[..], &common].concat();
        if case.cells.is_empty() {
            program.render(&args, picture)
        } else {
            sheet::draw(&case.cells, picture, |sets, path| {
                let sets = sets.iter().map(|set| format!("--set={set}"));
                let args: Vec<String> = args.iter().cloned().chain(sets).collect();
                program.render(&args, path)
            })
        }
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
        .filter(|(_, verdict)| !verdict.is_good())
        .map(|(case, _)| case.name.clone())
        .collect();
    sum_up(cases.len(), &failures)
}

impl Folders {
    fn cases(&self) -> Outcome<Vec<Case>> {
        let path = self.golden.join("cases.toml");
        let text = fs::read_to_string(&path);
        let text = text.map_err(|error| format!("{}: {error}", path.display()))?;
        case::parse(&text).map_err(|error| format!("{}: {error}", path.display()).into())
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
        draw: impl Fn(&Case, &Path) -> Outcome + Sync,
    ) -> Outcome<Vec<Verdict>> {
        if self.report.exists() {
            fs::remove_dir_all(&self.report)?;
        }
        fs::create_dir_all(&self.report)?;
        let verdicts = work::on_all_cores(cases, "pictures", |case| {
            draw(case, &self.picture(case, "actual"))
                .and_then(|()| self.compare(case))
                .unwrap_or_else(|error| Verdict::Failed(error.to_string()))
        });
        for (case, verdict) in cases.iter().zip(&verdicts) {
            println!("  {}: {}", case.name, verdict.sentence());
        }
        Ok(verdicts)
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
        if self.backend == Backend::Gpu {
            let shown = expected.amplified_difference(&actual, difference.largest);
            shown.save(&self.picture(case, "difference"))?;
            return Ok(agreement(case, &expected, &actual));
        }
        let cells = sheet::cells_that_differ(&case.cells, &expected, &actual);
        let shown = expected.amplified_difference(&actual, difference.largest);
        shown.save(&self.picture(case, "difference"))?;
        Ok(Verdict::Differs { difference, cells })
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

/// How far a picture agrees with the golden one; a sheet as far as its worst cell.
fn agreement(case: &Case, expected: &Picture, actual: &Picture) -> Verdict {
    let mut whole = Agreement {
        within: 1.0,
        flip: 0.0,
    };
    if case.cells.is_empty() {
        whole = Agreement::of(expected, actual).unwrap_or(whole);
        return if whole.holds() {
            Verdict::Agrees(whole)
        } else {
            Verdict::Disagrees(whole, Vec::new())
        };
    }
    let mut wrong = Vec::new();
    for (index, cell) in case.cells.iter().enumerate() {
        let part =
            |picture: &Picture| picture.cut(sheet::corner(index), (sheet::CELL, sheet::CELL));
        let Some(found) = Agreement::of(&part(expected), &part(actual)) else {
            continue;
        };
        if !found.holds() {
            wrong.push(cell.name.clone());
        }
        whole = whole.worse(found);
    }
    if wrong.is_empty() {
        Verdict::Agrees(whole)
    } else {
        Verdict::Disagrees(whole, wrong)
    }
}

#[cfg(test)]
mod tests {
    use tempfile::TempDir;

    use super::*;
    use crate::picture::Difference;
    use crate::picture::tests::made;

    fn folders() -> (TempDir, Folders) {
        let root = tempfile::tempdir().unwrap();
        let folders = Folders {
            golden: root.path().join("golden"),
            report: root.path().join("report"),
            backend: Backend::Cpu,
        };
        fs::create_dir(&folders.golden).unwrap();
        (root, folders)
    }

    fn case(name: &str) -> Case {
        Case {
            name: name.to_owned(),
            args: vec!["presets/made.ron".to_owned()],
            cells: Vec::new(),
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
        let cells = Vec::new();
        assert_eq!(verdict, Verdict::Differs { difference, cells });
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
    fn the_cell_of_a_sheet_that_should_fail_is_named() {
        let (_root, folders) = folders();
        let mut case = case("sheet");
        case.cells = vec![
            sheet::tests::cell("a=1", None),
            sheet::tests::cell("a=2", None),
        ];
        let mut picture = Picture::blank(8 * sheet::CELL, sheet::CELL);
        picture.save(&folders.golden_picture(&case)).unwrap();
        picture.pixels[sheet::CELL as usize] = [0, 0, 0, 257];
        let draw = |_: &Case, path: &Path| picture.save(path);
        let verdicts = folders.judge(&[case], draw).unwrap();
        let sentence = verdicts[0].sentence();
        assert!(sentence.starts_with("DIFFERS: 1 pixels") && sentence.ends_with(", in a=2"));
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
        assert!(matches!(verdicts[1], Verdict::Differs { .. }));
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
}
