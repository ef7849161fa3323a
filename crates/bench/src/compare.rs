//! Two builds of inkstrand against each other: what the frames of looks take, stage by stage, in turns, so that whatever else the machine does meets both
//! alike; and whether the files of their pictures are the same.

use crate::BenchError;
use crate::frame::{LOOKS, presets};
use effects::preset::suggestion;
use indicatif::ProgressBar;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Stages of a frame that are compared, as the program's statistics name them.
const STAGES: [&str; 5] = ["simulate", "paths", "effects", "raster", "total"];
/// Frames that are not counted: there is no picture before the first one, and memory is new.
const WARM_UP: u64 = 2;
/// The last frame.
const LAST: u64 = 12;
/// What moves heads and hair.
const MOTION: &str = "presets/motions/walk-in-wind.motion.ron";

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The project's folder, for its looks.
    pub root: PathBuf,
    /// The two programs; times are the second's over the first's.
    pub programs: [PathBuf; 2],
    /// Looks by their names; all of them where none is named.
    pub looks: Vec<String>,
    /// How often each program draws each look.
    pub rounds: usize,
    /// Threads of the programs.
    pub threads: usize,
}

/// Milliseconds of each frame and stage, the least that was found.
type Times = BTreeMap<(u64, &'static str), f64>;

/// Draws the looks in turns; a table of each stage's time by the second program over that by the first, and whether all files of their pictures are the same.
///
/// # Errors
///
/// When there is no such look, or a program doesn't draw it.
pub fn run(options: &Options, progress: &ProgressBar) -> Result<String, BenchError> {
    let looks = looks(options)?;
    progress.set_length((looks.len() * options.rounds * 2) as u64);
    let mut table = format!("{:18}", "look");
    for stage in STAGES {
        let _ = write!(table, " {stage:>9}");
    }
    table += "  files\n";
    for (name, path) in &looks {
        progress.set_message(name.clone());
        let mut best = [Times::new(), Times::new()];
        let mut pictures = [Vec::new(), Vec::new()];
        for _ in 0..options.rounds.max(1) {
            let programs = options.programs.iter().zip(&mut best).zip(&mut pictures);
            for ((program, best), picture) in programs {
                *picture = draw(program, path, options, best)?;
                progress.inc(1);
            }
        }
        let [one, other] = &pictures;
        let _ = writeln!(
            table,
            "{name:18}{}  {}",
            ratios(&best),
            match one == other {
                true => "the same",
                false => "others",
            }
        );
    }
    Ok(table)
}

/// The presets that are asked for, by name.
fn looks(options: &Options) -> Result<Vec<(String, PathBuf)>, BenchError> {
    let all = presets(&options.root.join(LOOKS))?.into_iter().map(|path| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        (name.into_owned(), path.clone())
    });
    let all: Vec<_> = all.collect();
    if let Some(unknown) =
        (options.looks.iter()).find(|name| all.iter().all(|(own, _)| own != *name))
    {
        let hint = suggestion(unknown, all.iter().map(|(name, _)| name.as_str()));
        return Err(format!("there is no look `{unknown}`{hint}").into());
    }
    let is_meant =
        |(name, _): &(String, PathBuf)| options.looks.is_empty() || options.looks.contains(name);
    Ok(all.into_iter().filter(is_meant).collect())
}

/// Has a program draw a look; takes in its times where they are less. The pictures' files, one after the other.
fn draw(
    program: &Path,
    look: &Path,
    options: &Options,
    best: &mut Times,
) -> Result<Vec<u8>, BenchError> {
    let folder = std::env::temp_dir().join(format!("inkstrand-compare-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let drawn = draw_in(&folder, program, look, options, best);
    let removed = fs::remove_dir_all(&folder);
    removed.map_err(|error| format!("{}: {error}", folder.display()))?;
    drawn
}

fn draw_in(
    folder: &Path,
    program: &Path,
    look: &Path,
    options: &Options,
    best: &mut Times,
) -> Result<Vec<u8>, BenchError> {
    let stats = folder.join("times.json");
    let done = Command::new(program)
        .arg("render")
        .arg(look)
        .args(["--size", "960x720", "--samples", "4", "--backend", "cpu"])
        .args(["--threads", &options.threads.to_string()])
        .arg("--motion")
        .arg(options.root.join(MOTION))
        .args(["--set", "scene.fps=60"])
        .args(["--frames", &format!("0-{LAST}")])
        .arg("-o")
        .arg(folder.join("####.png"))
        .arg("--stats")
        .arg(&stats)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .output();
    let said = |what: String| BenchError::from(format!("{}: {what}", program.display()));
    let done = done.map_err(|error| said(error.to_string()))?;
    if !done.status.success() {
        let told = String::from_utf8_lossy(&done.stderr);
        return Err(said(format!("{}\n{}", done.status, told.trim())));
    }
    let text = fs::read_to_string(&stats).map_err(|error| said(error.to_string()))?;
    take_in(&text, best).map_err(said)?;
    let files = (0..=LAST).map(|frame| fs::read(folder.join(format!("{frame:04}.png"))));
    let files = files.collect::<Result<Vec<_>, _>>();
    Ok(files.map_err(|error| said(error.to_string()))?.concat())
}

/// Takes in the times of statistics, a line a frame, where they are less than what was found.
fn take_in(statistics: &str, best: &mut Times) -> Result<(), String> {
    for line in statistics.lines() {
        let frame: serde_json::Value =
            serde_json::from_str(line).map_err(|error| format!("its statistics: {error}"))?;
        let Some(number) = frame["frame"].as_u64() else {
            return Err("its statistics name no frame".to_owned());
        };
        if number < WARM_UP {
            continue;
        }
        for stage in STAGES {
            let Some(time) = frame["milliseconds"][stage].as_f64() else {
                return Err(format!("its statistics have no stage {stage}"));
            };
            let least = best.entry((number, stage)).or_insert(time);
            *least = least.min(time);
        }
    }
    Ok(())
}

/// The second's time over the first's, of each stage: of the sums over all frames.
fn ratios(best: &[Times; 2]) -> String {
    let mut text = String::new();
    for stage in STAGES {
        let sum = |times: &Times| {
            let own = times.iter().filter(|((_, of), _)| *of == stage);
            own.map(|(_, time)| time).sum::<f64>()
        };
        let [first, second] = [sum(&best[0]), sum(&best[1])];
        // Frames in which nothing moves are not drawn.
        let _ = match first > 0.0 {
            true => write!(text, " {:9.3}", second / first),
            false => write!(text, " {:>9}", "-"),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(frame: u64, times: [f64; 5]) -> String {
        let times = STAGES
            .iter()
            .zip(times)
            .map(|(stage, time)| format!("\"{stage}\":{time}"));
        let times: Vec<String> = times.collect();
        format!(
            "{{\"frame\":{frame},\"milliseconds\":{{{}}}}}\n",
            times.join(",")
        )
    }

    #[test]
    fn the_least_of_each_frame_counts() {
        let mut best = [Times::new(), Times::new()];
        // The first frames are not counted.
        let first = line(0, [99.0; 5]) + &line(2, [1.0, 2.0, 3.0, 4.0, 10.0]);
        take_in(&first, &mut best[0]).unwrap();
        take_in(&line(2, [2.0, 1.0, 3.0, 8.0, 9.0]), &mut best[0]).unwrap();
        take_in(&line(2, [1.0, 2.0, 3.0, 2.0, 18.0]), &mut best[1]).unwrap();
        assert_eq!(
            ratios(&best).split_whitespace().collect::<Vec<_>>(),
            ["1.000", "2.000", "1.000", "0.500", "2.000"]
        );
        let mut none = [Times::new(), Times::new()];
        for times in &mut none {
            take_in(&line(2, [0.0, 0.0, 0.0, 0.0, 1.0]), times).unwrap();
        }
        assert!(ratios(&none).ends_with("-     1.000"), "{}", ratios(&none));
    }

    #[test]
    fn statistics_of_another_program_are_told() {
        let mut best = Times::new();
        for (text, told) in [
            ("{", "its statistics: "),
            ("{}", "name no frame"),
            (
                "{\"frame\":5,\"milliseconds\":{\"paths\":1}}",
                "no stage simulate",
            ),
        ] {
            let error = take_in(text, &mut best).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
    }
}
