//! Suite `rest`: whether the hair of the looks in `presets` comes back to where it was styled, and to rest, once the head is still: after turns,
//! on a head that stays turned, and after a violent shake.

use crate::BenchError;
use crate::frame::{LOOKS, preset, presets, registry};
use crate::results::{self, Row};
use crate::targets::{Found, Limit, Target};
use effects::Registry;
use glam::Vec3;
use indicatif::ProgressBar;
use rayon::prelude::*;
use stage::{Files, Motion, Preset, Scene};
use std::fmt;
use std::path::{Path, PathBuf};

/// Frames a second.
const RATES: [u16; 2] = [24, 60];
/// Degrees by which heads turn, to both sides.
const ANGLES: [i32; 8] = [50, 60, 66, 70, 75, 80, 90, 93];
/// The look whose locks are watched without recall, too, in turns by no less than so many degrees.
const FREE: (&str, i32) = ("twin-tails", 70);
/// Seconds for which hair is watched once the head is still.
const WATCHED_S: u16 = 40;
/// Of these the second after which hair should be back, and the one in which nothing should be seen to move.
const BACK_S: u16 = 8;
const STILL_S: u16 = 12;
/// What lies farther than this from its style isn't back, in head heights.
const LEFT: f64 = 0.05;
/// What goes faster than this is seen to move, mm/s: a tenth of a pixel in a frame at 24 of them, of a head 720 pixels high.
const MOVES_MM_S: f64 = 1.0;
/// Seconds within which hair should sleep after a turn, and after a shake.
const SLEEPS_S: [f64; 2] = [10.0, 25.0];

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The project's folder, for its looks.
    pub root: PathBuf,
    /// Where the files go.
    pub out: PathBuf,
    /// Two looks and one angle.
    pub quick: bool,
    /// Trials at once.
    pub threads: usize,
}

/// All that was measured.
pub struct Measured {
    /// What groups of trials come to, a line each.
    pub summary: String,
    /// How many trials may leave hair behind, move or stay awake.
    pub targets: Vec<Target>,
}

/// What the head does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Move {
    /// A quick turn, by which it stays.
    Turn,
    /// It turns by so many degrees and back.
    Back(i32),
    /// It turns by so many degrees and stays there.
    Held(i32),
    /// It is shaken violently.
    Shake,
}

impl Move {
    /// Each move of a script: when it begins, how long it is, and its degrees.
    fn turns(self) -> Vec<(f32, f32, i32)> {
        match self {
            Self::Turn => vec![(0.1, 0.3, 60)],
            Self::Back(angle) => vec![(0.1, 0.4, angle), (0.9, 0.4, -angle)],
            Self::Held(angle) => vec![(0.1, 0.4, angle)],
            Self::Shake => vec![(0.2, 0.2, 80), (1.0, 0.2, -150), (1.8, 0.25, 70)],
        }
    }

    /// The script of it.
    fn script(self) -> String {
        let turns = self.turns().into_iter().map(|(start, length, angle)| {
            format!("(move: turn, start: {start}, length: {length}, angle: {angle})")
        });
        let turns: Vec<String> = turns.collect();
        format!("(version: 1, moves: [{}])\n", turns.join(", "))
    }

    /// From when on the head is still, s.
    fn end_s(self) -> f32 {
        let turns = self.turns();
        turns
            .last()
            .map_or(0.0, |(start, length, _)| start + length)
    }
}

impl fmt::Display for Move {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Turn => f.write_str("turn"),
            Self::Back(angle) => write!(f, "back {angle}"),
            Self::Held(angle) => write!(f, "held {angle}"),
            Self::Shake => f.write_str("shake"),
        }
    }
}

/// What a look's `dynamics` are set to for a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Setting {
    /// As it has them itself.
    Own,
    /// Its locks keep out of each other.
    Locks,
    /// They do, and nothing is recalled.
    FreeLocks,
}

impl Setting {
    fn set(self, preset: &mut Preset) -> Result<(), BenchError> {
        let set: &[(&str, &str)] = match self {
            Self::Own => &[],
            Self::Locks => &[("dynamics.locks", "1")],
            Self::FreeLocks => &[("dynamics.locks", "1"), ("dynamics.recall", "0")],
        };
        for (name, value) in set {
            let done = preset.set(name, value);
            done.map_err(|error| format!("{name}: {error}"))?;
        }
        Ok(())
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Own => "as it is",
            Self::Locks => "locks",
            Self::FreeLocks => "locks without recall",
        })
    }
}

/// A look's hair, what is done to it, and what for.
struct Trial<'a> {
    group: &'static str,
    look: &'a Look,
    moves: Move,
    setting: Setting,
    fps: u16,
}

/// A preset of one object with hair.
struct Look {
    name: String,
    path: PathBuf,
    recalls: bool,
}

/// What became of a trial's hair once the head was still.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Outcome {
    /// How far it lay at most from its style after [`BACK_S`], in head heights.
    left: f64,
    /// How fast its fastest point went in second [`STILL_S`], mm/s.
    speed_mm_s: f64,
    /// The second at whose end all of it slept, if it did within [`WATCHED_S`].
    asleep_s: Option<u16>,
}

/// Groups of trials.
const TURNED: &str = "turned";
const RECALLED: &str = "there and back, recalled";
const UNRECALLED: &str = "there and back, not recalled";
const HELD: &str = "held";
const SHAKEN: &str = "shaken";

/// Measures and writes `rest.csv`.
///
/// # Errors
///
/// When a preset cannot be read or moved, or a file cannot be written.
pub fn run(options: &Options, progress: &ProgressBar) -> Result<Measured, BenchError> {
    let registry = registry()?;
    let mut looks = looks(&options.root, &registry)?;
    if options.quick {
        looks.retain(|look| ["long-pink", "twin-tails"].contains(&look.name.as_str()));
    }
    let trials = trials(&looks, options.quick);
    progress.set_length(trials.len() as u64);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build();
    let pool = pool.map_err(|error| error.to_string())?;
    let folder = options.out.join("rest");
    for trial in &trials {
        results::save(&folder, &trial.script_name(), &trial.moves.script())?;
    }
    let outcomes: Result<Vec<Outcome>, BenchError> = pool.install(|| {
        let outcomes = trials.par_iter().map(|trial| {
            let outcome = trial.watch(&registry, &folder)?;
            progress.inc(1);
            Ok(outcome)
        });
        outcomes.collect()
    });
    let done: Vec<(&Trial, Outcome)> = trials.iter().zip(outcomes?).collect();
    let rows: Vec<Row> = done
        .iter()
        .flat_map(|(trial, it)| rows(trial, it))
        .collect();
    let comments = [
        "hair of looks once the head is still; method: what the head did, degrees, and what of `dynamics` was set; knob: frames a second".to_owned(),
        format!("seconds: simulated time until all sleeps, inf if it doesn't within {WATCHED_S}"),
        format!("error: how fast its fastest point goes in second {STILL_S}, mm/s; of left: how far it lies at most from its style after {BACK_S} s, head heights"),
    ];
    results::save(
        &options.out,
        "rest.csv",
        &results::csv("rest", &comments, &rows),
    )?;
    Ok(Measured {
        summary: summary(&done),
        targets: targets(&done),
    })
}

/// The looks whose hair moves, of one object each.
fn looks(root: &Path, registry: &Registry) -> Result<Vec<Look>, BenchError> {
    let mut looks = Vec::new();
    for path in presets(&root.join(LOOKS))? {
        let preset = preset(&path, registry)?;
        if !preset.objects.is_empty() {
            continue;
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let look = Look {
            name: name.into_owned(),
            recalls: preset.sections.dynamics.recall > 0.0,
            path,
        };
        let scene = look.scene(&preset, None)?;
        if scene.strand_count() > 0 {
            looks.push(look);
        }
    }
    Ok(looks)
}

impl Look {
    fn scene(&self, preset: &Preset, script: Option<PathBuf>) -> Result<Scene, BenchError> {
        let files = Files {
            preset_folder: self.path.parent().unwrap_or(Path::new("")).to_owned(),
            motion: script,
            ..Files::default()
        };
        let scene = Scene::load(preset, &files);
        scene.map_err(|error| format!("{}: {error}", self.name).into())
    }
}

/// All that are watched.
fn trials(looks: &[Look], quick: bool) -> Vec<Trial<'_>> {
    let angles: Vec<i32> = match quick {
        true => vec![90],
        false => ANGLES.iter().flat_map(|angle| [*angle, -*angle]).collect(),
    };
    let mut trials = Vec::new();
    for look in looks {
        for fps in RATES {
            let mut add = |group, moves, setting| {
                trials.push(Trial {
                    group,
                    look,
                    moves,
                    setting,
                    fps,
                });
            };
            add(TURNED, Move::Turn, Setting::Own);
            add(SHAKEN, Move::Shake, Setting::FreeLocks);
            for &angle in &angles {
                if look.recalls {
                    add(RECALLED, Move::Back(angle), Setting::Locks);
                    add(HELD, Move::Held(angle), Setting::Own);
                }
                if look.name == FREE.0 && angle.abs() >= FREE.1 {
                    add(UNRECALLED, Move::Back(angle), Setting::FreeLocks);
                }
            }
        }
    }
    trials
}

impl Trial<'_> {
    fn script_name(&self) -> String {
        format!("{}.motion.ron", self.moves).replace(' ', "-")
    }

    /// Moves the head and watches hair once it is still.
    fn watch(&self, registry: &Registry, scripts: &Path) -> Result<Outcome, BenchError> {
        let mut preset = preset(&self.look.path, registry)?;
        let rate = preset.set("scene.fps", &self.fps.to_string());
        rate.map_err(|error| format!("scene.fps: {error}"))?;
        self.setting.set(&mut preset)?;
        let scene = self
            .look
            .scene(&preset, Some(scripts.join(self.script_name())))?;
        let mut motion = Motion::new();
        let mut points_at = |time_s: f32| -> Result<(Vec<Vec3>, bool), BenchError> {
            let done = motion.advance_to(&scene, time_s);
            done.map_err(|error| format!("{}: {error}", self.look.name))?;
            let stats = motion.simulated();
            let is_asleep = stats.strands == 0 && stats.asleep > 0;
            Ok((motion.points(&scene, 0).to_vec(), is_asleep))
        };
        let end_s = self.moves.end_s();
        let (styled, _) = points_at(0.0)?;
        let (mut points, _) = points_at(end_s)?;
        let mut outcome = Outcome {
            left: 0.0,
            speed_mm_s: 0.0,
            asleep_s: None,
        };
        for second in 1..=WATCHED_S {
            let mut way_m = 0.0_f32;
            let mut sleeps = false;
            for frame in 1..=self.fps {
                let since_s = f32::from(second - 1) + f32::from(frame) / f32::from(self.fps);
                let (next, is_asleep) = points_at(end_s + since_s)?;
                way_m = way_m.max(farthest_m(&next, &points));
                (points, sleeps) = (next, is_asleep);
            }
            if second == BACK_S {
                outcome.left = f64::from(farthest_m(&points, &styled) / scene.head().height_m);
            }
            if second == STILL_S {
                outcome.speed_mm_s = 1e3 * f64::from(way_m) * f64::from(self.fps);
            }
            if sleeps && outcome.asleep_s.is_none() {
                outcome.asleep_s = Some(second);
            }
            if outcome.asleep_s.is_some() && second >= STILL_S {
                break;
            }
        }
        Ok(outcome)
    }
}

/// How far apart points are at most, m.
fn farthest_m(a: &[Vec3], b: &[Vec3]) -> f32 {
    let apart = a.iter().zip(b).map(|(a, b)| a.distance(*b));
    apart.fold(0.0, f32::max)
}

fn rows(trial: &Trial, outcome: &Outcome) -> Vec<Row> {
    let row = |what: &str, error: f64| Row {
        scene: trial.look.name.clone(),
        method: format!("{}; {}{what}", trial.moves, trial.setting),
        knob: trial.fps.into(),
        seconds: outcome.asleep_s.map_or(f64::INFINITY, f64::from),
        error: Some(error),
    };
    let mut rows = vec![row("", outcome.speed_mm_s)];
    if matches!(trial.moves, Move::Back(_)) {
        rows.push(row("; left", outcome.left));
    }
    rows
}

/// A group's outcomes.
fn of_group<'a>(
    done: &'a [(&Trial, Outcome)],
    group: &'a str,
) -> impl Iterator<Item = &'a Outcome> + Clone {
    let own = done.iter().filter(move |(trial, _)| trial.group == group);
    own.map(|(_, outcome)| outcome)
}

/// All groups, with their trials.
fn groups<'a>(done: &'a [(&Trial, Outcome)]) -> [(&'static str, Vec<&'a Outcome>); 5] {
    let groups = [TURNED, RECALLED, UNRECALLED, HELD, SHAKEN];
    groups.map(|group| (group, of_group(done, group).collect()))
}

fn summary(done: &[(&Trial, Outcome)]) -> String {
    let mut text = format!(
        "{:30} {:>6} {:>8} {:>10} {:>9} {:>14} {:>13}\n",
        "", "trials", "not back", "moves", "at most", "asleep after", "awake after"
    );
    for (group, own) in groups(done) {
        let count = |is_meant: &dyn Fn(&Outcome) -> bool| {
            own.iter().filter(|outcome| is_meant(outcome)).count()
        };
        let not_back = match [RECALLED, UNRECALLED].contains(&group) {
            true => count(&is_left).to_string(),
            false => String::new(),
        };
        let fastest = own.iter().map(|it| it.speed_mm_s).fold(0.0, f64::max);
        let seconds = own.iter().filter_map(|it| it.asleep_s);
        let asleep = match (seconds.clone().min(), seconds.max()) {
            (Some(first), Some(last)) => format!("{first} to {last} s"),
            _ => String::new(),
        };
        let awake = count(&|it| it.asleep_s.is_none());
        text += &format!(
            "{group:30} {:6} {not_back:>8} {:>10} {fastest:>4.1} mm/s {asleep:>14} {awake:>8} {WATCHED_S} s\n",
            own.len(),
            count(&moves),
        );
    }
    text
}

fn is_left(outcome: &Outcome) -> bool {
    outcome.left > LEFT
}

fn moves(outcome: &Outcome) -> bool {
    outcome.speed_mm_s > MOVES_MM_S
}

fn targets(done: &[(&Trial, Outcome)]) -> Vec<Target> {
    let mut targets = Vec::new();
    for (group, own) in groups(done) {
        let mut none = |what: String, is_meant: &dyn Fn(&Outcome) -> bool| {
            let count = own.iter().filter(|outcome| is_meant(outcome)).count();
            targets.push(Target {
                text: format!("{group}: trials, of {}, {what}", own.len()),
                // Where nothing was tried, nothing was found to hold.
                found: (!own.is_empty()).then_some(Found::Is(count as f64)),
                limit: Limit::AtMost(0.0),
            });
        };
        if [RECALLED, UNRECALLED].contains(&group) {
            none(
                format!("farther than {LEFT} head heights from the style after {BACK_S} s"),
                &is_left,
            );
        }
        none(
            format!("faster than {MOVES_MM_S} mm/s in second {STILL_S}"),
            &moves,
        );
        let within_s = match group {
            TURNED => SLEEPS_S[0],
            SHAKEN => SLEEPS_S[1],
            _ => f64::from(WATCHED_S),
        };
        none(format!("awake after {within_s} s"), &|outcome| {
            (outcome.asleep_s).is_none_or(|second| f64::from(second) > within_s)
        });
    }
    targets
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_turns_and_ends_where_it_says() {
        assert_eq!(
            Move::Back(-70).script(),
            "(version: 1, moves: [(move: turn, start: 0.1, length: 0.4, angle: -70), (move: turn, start: 0.9, length: 0.4, angle: 70)])\n"
        );
        assert!((Move::Back(-70).end_s() - 1.3).abs() < 1e-6);
    }

    /// What a lock does that stays on a shoulder and trembles is counted, and what is at rest isn't.
    #[test]
    fn what_is_left_moves_or_stays_awake_misses_its_target() {
        let look = Look {
            name: "a".to_owned(),
            path: PathBuf::new(),
            recalls: true,
        };
        let trial = Trial {
            group: RECALLED,
            look: &look,
            moves: Move::Back(70),
            setting: Setting::Locks,
            fps: 24,
        };
        let rests = Outcome {
            left: 0.01,
            speed_mm_s: 0.1,
            asleep_s: Some(9),
        };
        let trembles = Outcome {
            left: 0.2,
            speed_mm_s: 30.0,
            asleep_s: None,
        };
        let own = |done: &[(&Trial, Outcome)]| {
            let mut targets = targets(done);
            targets.retain(|target| target.text.starts_with(RECALLED));
            targets
        };
        assert!(own(&[(&trial, rests)]).iter().all(Target::is_met));
        let done = [(&trial, rests), (&trial, trembles)];
        let targets = own(&done);
        assert_eq!(targets.len(), 3);
        for target in &targets {
            assert_eq!(target.found, Some(Found::Is(1.0)), "{}", target.text);
        }
        let text = summary(&done);
        assert!(
            text.contains("30.0 mm/s") && text.contains("9 to 9 s"),
            "{text}"
        );
        let rows = rows(&trial, &trembles);
        assert_eq!(rows[1].method, "back 70; locks; left");
        assert!(rows[0].seconds.is_infinite());
    }

    #[test]
    fn groups_without_trials_miss_their_targets() {
        let targets = targets(&[]);
        for group in [TURNED, RECALLED, UNRECALLED, HELD, SHAKEN] {
            let mut own = targets.iter().filter(|it| it.text.starts_with(group));
            assert!(own.clone().count() >= 2, "{group}");
            assert!(own.all(|target| target.found.is_none()), "{group}");
        }
    }

    /// A look that recalls its hair gets it back, and sleeps.
    #[test]
    fn hair_of_a_look_comes_back_and_sleeps() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let registry = registry().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let look = Look {
            name: "blond-fantasy".to_owned(),
            path: root.join("presets/blond-fantasy.ron"),
            recalls: true,
        };
        let watch = |moves: Move| {
            let trial = Trial {
                group: RECALLED,
                look: &look,
                moves,
                setting: Setting::Own,
                fps: 24,
            };
            results::save(folder.path(), &trial.script_name(), &moves.script()).unwrap();
            trial.watch(&registry, folder.path()).unwrap()
        };
        let back = watch(Move::Back(70));
        assert!(
            !is_left(&back) && !moves(&back) && back.asleep_s.is_some(),
            "{back:?}"
        );
        // On a head that stays turned it is elsewhere than it was styled.
        let held = watch(Move::Held(70));
        assert!(is_left(&held) && held.asleep_s.is_some(), "{held:?}");
    }
}
