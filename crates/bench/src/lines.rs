//! Suite `lines`: how long it takes to find what an eye sees of a mesh's lines, against how much of their length is found wrong; beside an image of
//! triangles' numbers, as older systems have it, and Blender's Line Art; and the time of lines and tracking on meshes of known size.
//!
//! What is right is said by a ray for each place. An eye sees each mesh whole within 30 degrees.

pub mod id_image;
pub mod line_art;
pub mod subjects;

use crate::BenchError;
use crate::plot;
use crate::results::{self, Row};
use crate::targets::{Found, Limit, Target};
use glam::DVec3;
use id_image::IdImage;
use indicatif::ProgressBar;
use line_art::LineArt;
use mesh_lines::{Bvh, Frame, Line, MeshError, Span, Tracker, View, is_seen, visible};
use stage::ThingChoice;
use std::path::PathBuf;
use std::time::Instant;
use subjects::{Subject, dented, linked};

/// What is said where Line Art's rows are those that are stored.
const IS_STORED: &str =
    "line-art: Blender's, as it is stored, of another run; `--peers` asks Blender's Python module";

/// Lines of pictures, and of images of numbers.
const SIZES: [usize; 4] = [180, 360, 720, 1440];
/// That for which targets are.
const USUAL: usize = 720;
/// How much of the length may be wrong.
const WRONG: f64 = 1e-3;
/// Places at which a ray is asked are so far apart, of 720 lines, in pixels.
const APART_PX: f64 = 3.0;
/// Of Line Art's time lines and tracking may take this share.
const OF_LINE_ART: f64 = 0.05;
/// Lines, images and their errors are found by so many threads, that times can be compared.
const THREADS: usize = 1;
/// Seconds that lines and tracking may take, by triangles.
const SPEEDS: [(u32, f64); 2] = [(10_000, 2e-3), (120_000, 12e-3)];

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where the files go.
    pub out: PathBuf,
    /// Fewer eyes.
    pub quick: bool,
    /// Blender's Line Art, if it is to be asked.
    pub line_art: Option<LineArt>,
}

/// All that was measured.
pub struct Measured {
    /// A row a mesh, method and size.
    pub rows: Vec<Row>,
    /// Errors and times.
    pub targets: Vec<Target>,
    /// What is said of the machine.
    pub machine: Vec<String>,
}

/// How long a pixel is in the image where a picture has so many lines.
#[must_use]
pub fn pixel(lines: usize) -> f64 {
    2.0 * 0.267_949_192_431_122_7 / lines as f64
}

/// Measures, and writes `lines.csv` and `lines.svg`.
///
/// # Errors
///
/// When a mesh isn't one, or a file cannot be written.
pub fn run(options: &Options, progress: &ProgressBar) -> Result<Measured, BenchError> {
    let fault = |error: MeshError| error.to_string();
    let subjects = [
        Subject::thing(ThingChoice::Cup),
        Subject::thing(ThingChoice::Gear),
        Subject::thing(ThingChoice::Wings),
        Subject::bust(),
        Subject::new("linked", linked(), false),
        Subject::new("dented", dented(10_000), false),
    ];
    let eyes = if options.quick { 8 } else { 64 };
    progress.set_length((subjects.len() + SPEEDS.len()) as u64);
    let mut measured = Measured {
        rows: Vec::new(),
        targets: Vec::new(),
        machine: results::machine(THREADS, &["mesh-lines"]),
    };
    let alone = rayon::ThreadPoolBuilder::new().num_threads(THREADS).build();
    let alone = alone.map_err(|error| error.to_string())?;
    for subject in subjects {
        let subject = subject.map_err(fault)?;
        progress.set_message(subject.name.clone());
        let rows = alone.install(|| errors(&subject, eyes)).map_err(fault)?;
        let usual = rows
            .iter()
            .find(|row| row.method == "exact" && row.knob == USUAL);
        measured.targets.push(Target {
            text: format!(
                "{}: share of the length that is wrongly seen or hidden",
                subject.name
            ),
            found: usual.and_then(|row| row.error).map(Found::Is),
            limit: Limit::AtMost(WRONG),
        });
        measured.rows.extend(rows);
        if let Some(line_art) = &options.line_art {
            let eyes: Vec<DVec3> = subject.eyes(eyes).collect();
            let row = line_art.row(&subject, &eyes, true, &options.out)?;
            measured.rows.push(row);
        }
        progress.inc(1);
    }
    for (triangles, most) in SPEEDS {
        let name = format!("dented-{}k", triangles / 1000);
        progress.set_message(name.clone());
        let subject = Subject::new(&name, dented(triangles), false).map_err(fault)?;
        let frames = if options.quick { 15 } else { 61 };
        let rows = alone.install(|| speeds(&subject, frames)).map_err(fault)?;
        measured.targets.push(Target {
            text: format!("{name}: ms for lines and tracking"),
            found: rows.first().map(|row| Found::Is(1e3 * row.seconds)),
            limit: Limit::AtMost(1e3 * most),
        });
        if let Some(line_art) = &options.line_art {
            let eyes: Vec<DVec3> = (0..frames).map(|frame| eye_of(&subject, frame)).collect();
            let row = line_art.row(&subject, &eyes, false, &options.out)?;
            let own = rows.first().map(|own| own.seconds / row.seconds);
            measured.targets.push(Target {
                text: format!("{name}: lines and tracking / Blender's Line Art, seconds"),
                found: own.map(Found::Is),
                limit: Limit::AtMost(OF_LINE_ART),
            });
            measured.rows.push(row);
        }
        measured.rows.extend(rows);
        progress.inc(1);
    }
    let mut comments = vec![
        format!("{eyes} eyes around each mesh; medians of times, by one thread"),
        "error: the share of the length of all lines, as they are seen, that is wrongly seen or hidden, held against a ray each \
         3 pixels of 720 lines"
            .to_owned(),
        "exact: contours, creases, borders, what is seen of them, and tracking; knob: lines of the picture, of which pieces under a pixel \
         join a neighbour"
            .to_owned(),
        "id-image: the same lines, an image of numbers of triangles with so many lines drawn by one thread without a graphics card, and a \
         look-up each pixel; no tracking"
            .to_owned(),
        "line-art: Blender's, whose lines are edges of triangles, and are held against rays from these".to_owned(),
    ];
    if options.line_art.is_none() {
        comments.push(IS_STORED.to_owned());
        let rows = line_art::stored()?.into_iter();
        let its = rows.filter(|row| row.method == line_art::METHOD);
        measured.rows.extend(its);
    }
    comments.extend(measured.machine.iter().cloned());
    let csv = results::csv("lines", &comments, &measured.rows);
    results::save(&options.out, "lines.csv", &csv)?;
    let svg = plot::time_against_error(&measured.rows, "share of the length that is wrong")?;
    results::save(&options.out, "lines.svg", &svg)?;
    Ok(measured)
}

/// Length in the image that is wrong, and all.
#[derive(Clone, Copy, Default)]
struct Tally {
    wrong: f64,
    all: f64,
}

/// A place along a line at which a ray was asked, how much length it stands for, and what the ray said.
struct Asked {
    line: usize,
    along: f64,
    length: f64,
    is_seen: bool,
}

fn ask(subject: &Subject, bvh: &Bvh, view: &View, lines: &[Line]) -> Result<Vec<Asked>, MeshError> {
    let surface = subject.surface(&subject.positions)?;
    let mut asked = Vec::new();
    for (number, line) in lines.iter().enumerate() {
        for (segment, length) in line.image_lengths(view).into_iter().enumerate() {
            let samples = (length / (APART_PX * pixel(USUAL))).ceil().max(1.0);
            asked.extend((0..samples as usize).map(|sample| {
                let along = segment as f64 + (sample as f64 + 0.5) / samples;
                Asked {
                    line: number,
                    along,
                    length: length / samples,
                    is_seen: is_seen(&surface, bvh, view, line, along),
                }
            }));
        }
    }
    Ok(asked)
}

fn tell(asked: &[Asked], tally: &mut Tally, sees: impl Fn(&Asked) -> bool) {
    for place in asked {
        tally.all += place.length;
        if sees(place) != place.is_seen {
            tally.wrong += place.length;
        }
    }
}

fn is_in(spans: &[Span], lines: &[Line], place: &Asked) -> bool {
    let line = &lines[place.line];
    let count = line.segments.len() as f64;
    let own = spans.iter().filter(|span| span.line == place.line);
    own.into_iter().any(|span| {
        let within = |along: f64| (span.start..span.end).contains(&along);
        within(place.along) || line.closed && within(place.along + count)
    })
}

/// A row for each method and size.
fn errors(subject: &Subject, eyes: usize) -> Result<Vec<Row>, MeshError> {
    let surface = subject.surface(&subject.positions)?;
    let bvh = Bvh::new(&surface);
    let mut exact = vec![(Tally::default(), Vec::new()); SIZES.len()];
    let mut images = vec![(Tally::default(), Vec::new()); SIZES.len()];
    for eye in subject.eyes(eyes) {
        let view = View::perspective(eye.as_vec3())?;
        let (lines, _) = subject.lines(&surface, &view)?;
        let asked = ask(subject, &bvh, &view, &lines)?;
        for (size, (tally, times)) in SIZES.iter().zip(&mut exact) {
            let start = Instant::now();
            let (lines, facing) = subject.lines(&surface, &view)?;
            let spans = visible(&surface, &bvh, &view, &lines, pixel(*size))?;
            let mut tracker = Tracker::default();
            tracker.step(&Frame {
                surface: &surface,
                view: &view,
                facing: &facing,
                lines: &lines,
                spans: &spans,
                pixel: pixel(*size),
                period_px: 100.0,
            })?;
            times.push(start.elapsed().as_secs_f64());
            tell(&asked, tally, |place| is_in(&spans, &lines, place));
        }
        for (size, (tally, times)) in SIZES.iter().zip(&mut images) {
            let start = Instant::now();
            let (lines, _) = subject.lines(&surface, &view)?;
            let mut image = IdImage::new(*size, eye, subject.middle);
            image.draw(&subject.positions, subject.topology.triangles());
            let mut seen = 0;
            for line in &lines {
                for (segment, length) in line.image_lengths(&view).into_iter().enumerate() {
                    let samples = (length / pixel(*size)).ceil().max(1.0);
                    for sample in 0..samples as usize {
                        let along = segment as f64 + (sample as f64 + 0.5) / samples;
                        seen += usize::from(image.sees(&surface, line, along));
                    }
                }
            }
            std::hint::black_box(seen);
            times.push(start.elapsed().as_secs_f64());
            tell(&asked, tally, |place| {
                image.sees(&surface, &lines[place.line], place.along)
            });
        }
    }
    let row = |method: &str, size: usize, (tally, times): (Tally, Vec<f64>)| Row {
        scene: subject.name.clone(),
        method: method.to_owned(),
        knob: size,
        seconds: median(times),
        error: Some(tally.wrong / tally.all.max(f64::MIN_POSITIVE)),
    };
    let methods = [("exact", exact), ("id-image", images)];
    let rows = methods.into_iter().flat_map(|(method, all)| {
        let of_sizes = SIZES.iter().zip(all);
        of_sizes.map(move |(size, of_size)| (method, *size, of_size))
    });
    Ok(rows
        .map(|(method, size, of_size)| row(method, size, of_size))
        .collect())
}

/// An eye that goes around a mesh.
fn eye_of(subject: &Subject, frame: usize) -> DVec3 {
    let (sin, cos) = (0.01 * frame as f64).sin_cos();
    subject.middle + 4.2 * subject.radius * DVec3::new(sin, 0.2, cos)
}

/// Lines and tracking while an eye goes around, and the parts of that time.
fn speeds(subject: &Subject, frames: usize) -> Result<Vec<Row>, MeshError> {
    let surface = subject.surface(&subject.positions)?;
    let bvh = Bvh::new(&surface);
    let mut tracker = Tracker::default();
    let mut times = [const { Vec::new() }; 4];
    for frame in 0..frames {
        let view = View::perspective(eye_of(subject, frame).as_vec3())?;
        let start = Instant::now();
        let (lines, facing) = subject.lines(&surface, &view)?;
        let found = start.elapsed().as_secs_f64();
        let spans = visible(&surface, &bvh, &view, &lines, pixel(USUAL))?;
        let seen = start.elapsed().as_secs_f64();
        tracker.step(&Frame {
            surface: &surface,
            view: &view,
            facing: &facing,
            lines: &lines,
            spans: &spans,
            pixel: pixel(USUAL),
            period_px: 100.0,
        })?;
        let all = start.elapsed().as_secs_f64();
        for (list, time) in times.iter_mut().zip([all, found, seen - found, all - seen]) {
            list.push(time);
        }
    }
    let names = ["all", "lines", "visible", "tracking"];
    let rows = names.into_iter().zip(times).map(|(name, times)| Row {
        scene: subject.name.clone(),
        method: name.to_owned(),
        knob: USUAL,
        seconds: median(times),
        error: None,
    });
    Ok(rows.collect())
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both answers and the oracle are told apart: an image of few lines is wrong far more often.
    #[test]
    fn rays_find_what_is_wrong() {
        let subject = Subject::new("linked", linked(), false).unwrap();
        let rows = errors(&subject, 3).unwrap();
        let error = |method: &str, knob: usize| {
            let row = rows
                .iter()
                .find(|row| row.method == method && row.knob == knob);
            row.and_then(|row| row.error).unwrap()
        };
        assert!(error("exact", 720) < 2e-3, "{}", error("exact", 720));
        let [coarse, fine] = [180, 1440].map(|knob| error("id-image", knob));
        assert!(coarse > 5e-3 && coarse < 0.7, "{coarse}");
        assert!(fine < coarse, "{fine} of {coarse}");
    }

    #[test]
    fn eyes_see_subjects_whole() {
        let subject = Subject::thing(ThingChoice::Gear).unwrap();
        for eye in subject.eyes(16) {
            let away = eye.distance(subject.middle);
            assert!(
                subject.radius / away < 0.25,
                "within 15 degrees to each side"
            );
        }
    }
}
