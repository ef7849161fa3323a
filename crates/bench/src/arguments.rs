//! The command line of `bench`.

use bench::backends::Card;
use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::time::Duration;

/// Measures time against error. Build it in release.
#[derive(Parser)]
#[command(name = "bench")]
pub struct Arguments {
    #[command(subcommand)]
    pub suite: Suite,
}

#[derive(Subcommand)]
pub enum Suite {
    /// All: every suite, and a page of their plots and targets
    All(CardOptions),
    /// Strokes: the exact sweep, stamping, and libraries that fill outlines
    Strokes(RatioOptions),
    /// Dynamics: our strands, springs, XPBD, and other programs
    Dynamics(DynamicsOptions),
    /// Coherence: how continuous pictures are in time, in every order of strokes
    Coherence(CoherenceOptions),
    /// Frame: what a whole frame of each look takes, by stages, on both backends
    Frame(CardOptions),
    /// Looks: the same of each look that comes with inkstrand
    Looks(CardOptions),
    /// Scale: 72 to 100,000 strands, by stages, on both backends
    Scale(CardOptions),
    /// Cartoon: painted looks and lines of the whole picture, on scenes of two older systems
    Cartoon(CardOptions),
    /// Lines: what an eye sees of a mesh's lines, beside an image of numbers; lines and tracking by size
    Lines(LineOptions),
    /// Skip: what a scene doesn't need, and what it costs all the same
    Skip(RatioOptions),
    /// Rest: whether hair of looks comes back, and to rest, after turns and shakes of the head
    Rest(Options),
    /// Two builds of inkstrand against each other: what frames of looks take, in turns, and whether the files of their pictures are the same
    Compare(CompareOptions),
    /// No measure: random scenes with hostile numbers, in which strands must hold
    Stress(StressOptions),
    /// No measure: writes the character of suite frame, and presets with it and without, for `cargo xtask bench count --release`
    Character(CharacterOptions),
}

#[derive(clap::Args)]
pub struct CharacterOptions {
    /// Folder of the files
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

#[derive(clap::Args)]
pub struct CompareOptions {
    /// The program that the other one's times are divided by
    #[arg(value_name = "PROGRAM")]
    pub first: PathBuf,
    /// The other one
    #[arg(value_name = "OTHER")]
    pub second: PathBuf,
    /// Looks by their names [default: all]
    #[arg(value_name = "LOOK")]
    pub looks: Vec<String>,
    /// How often each draws each look
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub rounds: u16,
    /// Threads of the programs
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
}

#[derive(clap::Args)]
pub struct CardOptions {
    #[command(flatten)]
    pub common: Options,
    /// Without a graphics card a driver that draws in software: slow, and no measure of anything but itself
    #[arg(long)]
    pub software: bool,
}

impl CardOptions {
    pub fn card(&self) -> Card {
        if self.software {
            Card::Any
        } else {
            Card::Hardware
        }
    }
}

/// Of suites whose figures are ratios of times.
#[derive(clap::Args)]
pub struct RatioOptions {
    #[command(flatten)]
    pub common: Options,
    /// Stores our ratios as those that later ones are checked against
    #[arg(long, conflicts_with = "quick")]
    pub store: bool,
}

#[derive(clap::Args)]
pub struct LineOptions {
    #[command(flatten)]
    pub common: Options,
    /// Blender's Line Art too, by the Python that INKSTRAND_PYTHON names [default: python3]
    #[arg(long)]
    pub peers: bool,
    /// Stores Line Art's rows as those that are shown where it isn't asked
    #[arg(long, requires = "peers", conflicts_with = "quick")]
    pub store: bool,
}

#[derive(clap::Args)]
pub struct CoherenceOptions {
    #[command(flatten)]
    pub common: Options,
    /// Scenes whose names hold TEXT alone, such as twin-tails-orbit
    #[arg(
        long,
        value_name = "TEXT",
        default_value = "",
        hide_default_value = true
    )]
    pub only: String,
}

#[derive(clap::Args)]
pub struct DynamicsOptions {
    #[command(flatten)]
    pub common: Options,
    /// Other programs too, MuJoCo and pyPBD, by the Python that INKSTRAND_PYTHON names [default: python3]
    #[arg(long)]
    pub peers: bool,
    /// Stores our figures as those that later ones are checked against
    #[arg(long, conflicts_with = "quick")]
    pub store: bool,
}

#[derive(clap::Args)]
pub struct StressOptions {
    /// One scene alone, that of this seed
    #[arg(long, value_name = "S", conflicts_with_all = ["hours", "from"])]
    pub seed: Option<u64>,
    /// For how long [default: a minute]
    #[arg(long, value_name = "N", value_parser = hours)]
    pub hours: Option<Duration>,
    /// The first seed of many [default: by the clock]
    #[arg(long, value_name = "S")]
    pub from: Option<u64>,
    /// Goes on after a scene that fails
    #[arg(long)]
    pub keep_going: bool,
}

fn hours(text: &str) -> Result<Duration, String> {
    let hours: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.0..=1e5).contains(&hours) {
        return Ok(Duration::from_secs_f64(3600.0 * hours));
    }
    Err("from 0 to 100000 hours".to_owned())
}

#[derive(Clone, clap::Args)]
pub struct Options {
    /// Fewer scenes, knobs and rounds: some two minutes a suite on two cores; `all` runs ten suites
    #[arg(long)]
    pub quick: bool,
    /// Exits 1 if a target is missed
    #[arg(long)]
    pub check: bool,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Folder of the files it writes
    #[arg(long, value_name = "DIR", default_value = "target/bench")]
    pub out: PathBuf,
}

impl Options {
    pub fn threads(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        self.threads.map_or_else(cores, usize::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory as _;
    use std::path::Path;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
        let line = ["bench", "strokes", "--quick", "--check", "--out", "x"];
        let Suite::Strokes(options) = Arguments::try_parse_from(line).unwrap().suite else {
            panic!("another suite");
        };
        let common = options.common;
        assert!(common.quick && common.check && common.out == Path::new("x"));
        let line = ["bench", "dynamics", "--peers", "--threads", "2"];
        let Suite::Dynamics(options) = Arguments::try_parse_from(line).unwrap().suite else {
            panic!("another suite");
        };
        assert!(options.peers && options.common.threads == Some(2));
        let line = [
            "bench",
            "coherence",
            "--quick",
            "--only",
            "twin-tails-orbit",
        ];
        let Suite::Coherence(options) = Arguments::try_parse_from(line).unwrap().suite else {
            panic!("another suite");
        };
        assert!(options.common.quick && options.only == "twin-tails-orbit");
        // As docs/order.md has it.
        let line = "bench coherence --quick --only dry-brush-wind".split(' ');
        assert!(Arguments::try_parse_from(line).is_ok());
        // What is stored is measured with care.
        let line = ["bench", "dynamics", "--quick", "--store"];
        assert!(Arguments::try_parse_from(line).is_err());
    }

    #[test]
    fn a_scene_is_asked_for_by_its_seed_or_many_by_their_time() {
        let parse = |line: &[&str]| {
            let line = ["bench", "stress"].iter().chain(line);
            let suite = Arguments::try_parse_from(line).ok()?.suite;
            let Suite::Stress(options) = suite else {
                panic!("another suite");
            };
            Some(options)
        };
        let options = parse(&["--hours", "0.5", "--from", "7"]).unwrap();
        assert_eq!(options.hours, Some(Duration::from_secs(1800)));
        assert!(options.from == Some(7) && !options.keep_going);
        assert!(parse(&["--seed", "18446744073709551615"]).is_some());
        for bad in ["-1", "NaN", "inf", "1e300", "soon"] {
            assert!(parse(&[&format!("--hours={bad}")]).is_none(), "{bad}");
        }
        assert!(parse(&["--seed", "1", "--hours", "1"]).is_none());
    }
}
