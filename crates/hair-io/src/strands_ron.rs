//! Our own strands as text, `*.strands.ron`, to be written by hand or by a program.
//!
//! ```ron
//! (
//!     version: 1,
//!     strands: [
//!         (points: [(0.0, 1.7, 0.0), (0.0, 1.7, 0.1)]),
//!         (size: 14.0, mirror: true, points: [(0.05, 1.7, 0.0), (0.1, 1.6, 0.0)]),
//!     ],
//!     motion: [
//!         (time: 0.0, strands: [
//!             [(0.0, 1.7, 0.0), (0.0, 1.7, 0.1)],
//!             [(0.05, 1.7, 0.0), (0.1, 1.6, 0.0)],
//!         ]),
//!         (time: 0.5, strands: [
//!             [(0.0, 1.7, 0.0), (0.0, 1.75, 0.1)],
//!             [(0.05, 1.7, 0.0), (0.15, 1.65, 0.0)],
//!         ]),
//!     ],
//! )
//! ```
//!
//! Points go from root to tip, in metres, Y up, the face towards +Z. Of a strand all but `points` may
//! be left out:
//!
//! - `size`: its clump's radius at full size, in 1/300 of the head's height, 0 or more;
//! - `mirror: true`: adds its mirror image across x = 0;
//! - `id`: the number that its seeded variations hang on, in place of its index in the list. A mirror
//!   image has its original's id + 2^31 ([`MIRROR`]), so strands may be added, or mirrored, without
//!   changing the looks of the others. Ids must differ.
//!
//! `motion` may be left out too. Its times are in seconds and increase; each sample has all strands of
//! the list, with the same numbers of points, without mirror images (which move as mirror images).
//! Strands go straight from one time to the next, and stay where they are at the first before it, and
//! at the last behind it: with one time, as a bake of one frame has, they stand still.

use std::collections::HashSet;
use std::fmt::Write;

use glam::Vec3;
use hair_sim::{PointCache, StrandError, Strands};
use ron::extensions::Extensions;
use ron::value::RawValue;
use serde::Deserialize;

use mesh_io::{place_after, shown};

/// The version of the format that this build reads and writes.
pub const VERSION: u32 = 1;
/// The bit that tells a mirror image's id from its original's.
pub const MIRROR: u32 = 1 << 31;

/// Why a text is not a valid strands file. Lines and columns (in characters) count from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StrandsRonError {
    /// The file is of a later version than this build.
    #[error("version {found} is newer than this build, which reads up to version {VERSION}")]
    Newer {
        /// The file's version.
        found: u32,
    },
    /// Something in the file is wrong.
    #[error("line {line}, column {column}: {problem}")]
    At {
        /// The line.
        line: usize,
        /// The column.
        column: usize,
        /// What is wrong there.
        problem: Problem,
    },
}

/// What can be wrong at a place in a strands file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// Not RON, or not the fields of the format: what is wrong.
    #[error("{0}")]
    Syntax(String),
    /// There is no version 0.
    #[error("version 0 was found, versions start at 1")]
    Version,
    /// A file without strands.
    #[error("at least one strand was expected")]
    NoStrands,
    /// A strand without points, or with numbers out of range.
    #[error(transparent)]
    Strand(StrandError),
    /// Two strands, or a strand and a mirror image, have the same id.
    #[error("the id {id} is used twice")]
    SameId {
        /// The id.
        id: u32,
    },
    /// Times are finite and increase.
    #[error("the time {time} was found, a number above that of the sample before was expected")]
    Time {
        /// The time in seconds.
        time: f32,
    },
    /// A sample has other strands than the list.
    #[error("{found} strands were found in the sample, {expected} were expected")]
    StrandCount {
        /// The strands of the list.
        expected: usize,
        /// The strands of the sample.
        found: usize,
    },
    /// A strand of a sample has other points than in the list.
    #[error("{found} points were found in the sample, the strand has {expected}")]
    PointCount {
        /// The strand's points in the list.
        expected: usize,
        /// Its points in the sample.
        found: usize,
    },
    /// A sample's position that is not finite.
    #[error("the position {position} is not finite")]
    NotFinite {
        /// The position as the file gives it.
        position: Vec3,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Strands")]
struct Document<'a> {
    version: u32,
    #[serde(borrow)]
    strands: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    motion: Vec<&'a RawValue>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Strand {
    id: Option<u32>,
    size: Option<f32>,
    #[serde(default)]
    mirror: bool,
    points: Vec<[f32; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sample<'a> {
    time: f32,
    #[serde(borrow)]
    strands: Vec<&'a RawValue>,
}

/// Reads a strands file: the strands (each followed by its mirror image, where it has one), and
/// their motion where there is one.
///
/// # Errors
///
/// When the text is not of the format, or of a newer version. Errors know their line and column.
pub fn from_text(text: &str) -> Result<(Strands, Option<PointCache>), StrandsRonError> {
    if let Some(written) = written::read(text) {
        return Ok(written);
    }
    let source = Source { text };
    let document: Document = options()
        .from_str(text)
        .map_err(|e| source.syntax(text, e))?;
    let (strands, mirrored) = source.strands(document.version, &document.strands)?;
    let motion = source.motion(&document.motion, &strands, &mirrored)?;
    Ok((strands, motion))
}

/// The strands and their motion as the text of a strands file, one strand a line. Reading it gives
/// the same strands, ids, sizes and samples, to the bit (but for the sign of zeros in samples).
///
/// # Panics
///
/// When the motion is not of these strands' number of points.
#[must_use]
pub fn to_text(strands: &Strands, motion: Option<&PointCache>) -> String {
    let mut text = format!("(version: {VERSION}, strands: [\n");
    for (index, points) in strands.iter().enumerate() {
        text.push('(');
        if strands.id(index) as usize != index {
            write!(text, "id: {}, ", strands.id(index)).expect("a string takes all");
        }
        if let Some(size) = strands.size(index) {
            write!(text, "size: {size:?}, ").expect("a string takes all");
        }
        text.push_str("points: ");
        push_points(&mut text, points);
        text.push_str("),\n");
    }
    text.push(']');
    if let Some(motion) = motion {
        text.push_str(", motion: [\n");
        let mut positions = vec![Vec3::ZERO; strands.points().len()];
        for &time in motion.times() {
            motion.sample(time, &mut positions);
            writeln!(text, "(time: {time:?}, strands: [").expect("a string takes all");
            for index in 0..strands.len() {
                push_points(&mut text, &positions[strands.point_range(index)]);
                text.push_str(",\n");
            }
            text.push_str("]),\n");
        }
        text.push(']');
    }
    text.push_str(")\n");
    text
}

fn push_points(text: &mut String, points: &[Vec3]) {
    text.push('[');
    for (index, p) in points.iter().enumerate() {
        let comma = if index > 0 { "," } else { "" };
        write!(text, "{comma}({:?},{:?},{:?})", p.x, p.y, p.z).expect("a string takes all");
    }
    text.push(']');
}

fn options() -> ron::Options {
    // So that `size: 14.0` needs no `Some`.
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}

fn vectors(points: &[[f32; 3]]) -> Vec<Vec3> {
    points.iter().copied().map(Vec3::from).collect()
}

fn mirror(points: &[Vec3]) -> Vec<Vec3> {
    points.iter().map(|p| Vec3::new(-p.x, p.y, p.z)).collect()
}

/// What RON says, but for its advice to programmers and for long texts of the file.
fn syntax_message(error: &ron::Error) -> String {
    match error {
        ron::Error::ExceededRecursionLimit => "brackets are nested too deeply here".to_owned(),
        // Such as that of a preset, given in place of a strands file.
        ron::Error::NoSuchStructField {
            expected, found, ..
        } => format!(
            "strands have no {} here; there are: {}",
            shown(&format!("`{found}`")),
            expected.join(", ")
        ),
        other => shown(&other.to_string()),
    }
}

/// The text, to find places in it.
struct Source<'a> {
    text: &'a str,
}

impl<'a> Source<'a> {
    /// The line and column where `part`, a slice of the text, begins.
    fn place(&self, part: &str) -> (usize, usize) {
        let offset = part.as_ptr() as usize - self.text.as_ptr() as usize;
        place_after(&self.text[..offset])
    }

    fn at(&self, part: &str, problem: Problem) -> StrandsRonError {
        let (line, column) = self.place(part);
        StrandsRonError::At {
            line,
            column,
            problem,
        }
    }

    /// An error of parsing `part`. A file of a newer version may have fields that this build does
    /// not know: that it is newer is what its author has to hear.
    fn syntax(&self, part: &str, error: ron::error::SpannedError) -> StrandsRonError {
        #[derive(Deserialize)]
        #[serde(rename = "Strands")]
        struct Version {
            version: u32,
        }
        let version = options().from_str::<Version>(self.text).map(|v| v.version);
        if let Some(found) = version.ok().filter(|v| *v > VERSION) {
            return StrandsRonError::Newer { found };
        }
        let (first_line, first_column) = self.place(part);
        let start = error.span.start;
        let column = if start.line == 1 {
            first_column - 1 + start.col
        } else {
            start.col
        };
        let line = first_line - 1 + start.line;
        StrandsRonError::At {
            line,
            column,
            problem: Problem::Syntax(syntax_message(&error.code)),
        }
    }

    fn parse<T: Deserialize<'a>>(&self, raw: &'a RawValue) -> Result<T, StrandsRonError> {
        options()
            .from_str(raw.get_ron())
            .map_err(|e| self.syntax(raw.get_ron(), e))
    }

    /// The strands of a list in a file of this version, each followed by its mirror image, and of each of the list whether it has one.
    fn strands(
        &self,
        version: u32,
        list: &[&'a RawValue],
    ) -> Result<(Strands, Vec<bool>), StrandsRonError> {
        match version {
            0 => return Err(self.at(self.text, Problem::Version)),
            1..=VERSION => {}
            found => return Err(StrandsRonError::Newer { found }),
        }
        if list.is_empty() {
            return Err(self.at(self.text, Problem::NoStrands));
        }

        let mut strands = Strands::new();
        let mut mirrored = Vec::with_capacity(list.len());
        let mut ids = HashSet::new();
        for (index, raw) in list.iter().enumerate() {
            let strand: Strand = self.parse(raw)?;
            let id = strand.id.unwrap_or(index as u32);
            let points = vectors(&strand.points);
            let mut push = |id: u32, points: &[Vec3]| {
                if !ids.insert(id) {
                    return Err(self.at(raw.trim().get_ron(), Problem::SameId { id }));
                }
                strands
                    .push(id, points, strand.size)
                    .map_err(|e| self.strand(raw, e))
            };
            push(id, &points)?;
            if strand.mirror {
                push(id | MIRROR, &mirror(&points))?;
            }
            mirrored.push(strand.mirror);
        }
        Ok((strands, mirrored))
    }

    /// The error of a strand, at the number it is about.
    fn strand(&self, raw: &'a RawValue, error: StrandError) -> StrandsRonError {
        #[derive(Deserialize)]
        struct Parts<'a> {
            #[serde(borrow)]
            points: Vec<&'a RawValue>,
            #[serde(borrow)]
            size: Option<&'a RawValue>,
        }
        let parts = self.parse::<Parts>(raw).ok();
        let part = match &error {
            StrandError::NotFinite { point, .. } => parts.map(|p| p.points[*point]),
            StrandError::Size { .. } => parts.and_then(|p| p.size),
            _ => None,
        };
        self.at(part.unwrap_or(raw).trim().get_ron(), Problem::Strand(error))
    }

    fn motion(
        &self,
        samples: &[&'a RawValue],
        strands: &Strands,
        mirrored: &[bool],
    ) -> Result<Option<PointCache>, StrandsRonError> {
        let mut read: Vec<(f32, Vec<Vec3>)> = Vec::with_capacity(samples.len());
        for raw in samples {
            let sample: Sample = self.parse(raw)?;
            let time = sample.time;
            let after = read.last().is_none_or(|(last, _)| time > *last);
            if !time.is_finite() || !after {
                return Err(self.at(raw.trim().get_ron(), Problem::Time { time }));
            }
            if sample.strands.len() != mirrored.len() {
                let (expected, found) = (mirrored.len(), sample.strands.len());
                let problem = Problem::StrandCount { expected, found };
                return Err(self.at(raw.trim().get_ron(), problem));
            }
            let mut positions = Vec::with_capacity(strands.points().len());
            let mut index = 0;
            for (raw, mirrored) in sample.strands.into_iter().zip(mirrored) {
                let points = self.sample_points(raw, strands.strand(index).len())?;
                index += 1;
                positions.extend_from_slice(&points);
                if *mirrored {
                    positions.extend(mirror(&points));
                    index += 1;
                }
            }
            read.push((time, positions));
        }
        let motion = (!read.is_empty()).then(|| PointCache::new(read).expect("checked above"));
        Ok(motion)
    }

    /// One strand's positions in a sample.
    fn sample_points(
        &self,
        raw: &'a RawValue,
        expected: usize,
    ) -> Result<Vec<Vec3>, StrandsRonError> {
        let points = vectors(&self.parse::<Vec<[f32; 3]>>(raw)?);
        let found = points.len();
        if found != expected {
            let problem = Problem::PointCount { expected, found };
            return Err(self.at(raw.trim().get_ron(), problem));
        }
        if let Some(point) = points.iter().position(|p| !p.is_finite()) {
            let part = self.parse::<Vec<&RawValue>>(raw)?[point];
            let position = points[point];
            return Err(self.at(part.trim().get_ron(), Problem::NotFinite { position }));
        }
        Ok(points)
    }
}

#[cfg(test)]
mod tests;
mod written;
