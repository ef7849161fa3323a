//! Numbered files: one for each frame.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::file::{MeshError, read_model};
use crate::model::Model;
use crate::read::shown;

/// Files whose names differ in a number: `splash.0000.glb`, `splash.0001.glb`. Their meshes need not have as many vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    files: BTreeMap<u64, PathBuf>,
}

/// Why there is no sequence, or no frame of it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SequenceError {
    /// A name without a number.
    #[error("{}: a file of a sequence has a number before its ending: `name.0001.glb`, or `name.####.glb` for all", .0.display())]
    NoNumber(PathBuf),
    /// The folder can't be read.
    #[error("{}: {source}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// No such files.
    #[error("{}: there is no file of this name with a number in place of `#`", .0.display())]
    Empty(PathBuf),
    /// Two files of one number.
    #[error("frame {frame} is in `{first}` and in `{second}`")]
    Twice {
        /// The number.
        frame: u64,
        /// A file's name.
        first: String,
        /// Another one's.
        second: String,
    },
    /// A number that no file has.
    #[error("there is no frame {frame}: the nearest is {nearest}")]
    NoFrame {
        /// The number that was asked for.
        frame: u64,
        /// The nearest that there is.
        nearest: u64,
    },
    /// The frame's file can't be read.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

impl Sequence {
    /// The files of a sequence, by the path of one of them (`splash.0000.glb`) or of all (`splash.####.glb`).
    ///
    /// # Errors
    ///
    /// When the name has no number, the folder can't be read, or has no such files or two of one number.
    pub fn find(path: &Path) -> Result<Self, SequenceError> {
        let no_number = || SequenceError::NoNumber(path.into());
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .ok_or_else(no_number)?;
        let (begin, end) = around_number(name).ok_or_else(no_number)?;
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let refused = |source| SequenceError::Folder {
            folder: folder.into(),
            source,
        };
        let mut files: BTreeMap<u64, PathBuf> = BTreeMap::new();
        for entry in fs::read_dir(folder).map_err(refused)? {
            let name = entry.map_err(refused)?.file_name();
            let number = name.to_str().and_then(|name| number_of(name, begin, end));
            let Some(frame) = number else { continue };
            if let Some(other) = files.insert(frame, folder.join(&name)) {
                let mut names = [name, other.file_name().unwrap_or_default().to_owned()]
                    .map(|name| shown(&name.to_string_lossy()));
                names.sort();
                let [first, second] = names;
                return Err(SequenceError::Twice {
                    frame,
                    first,
                    second,
                });
            }
        }
        if files.is_empty() {
            return Err(SequenceError::Empty(path.into()));
        }
        Ok(Self { files })
    }

    /// The files by their numbers.
    #[must_use]
    pub fn files(&self) -> &BTreeMap<u64, PathBuf> {
        &self.files
    }

    /// The first numbers beside each other between which files are missing: they are farther apart than others are.
    #[must_use]
    pub fn gap(&self) -> Option<[u64; 2]> {
        let numbers = self.files.keys().copied();
        let mut pairs = numbers.clone().zip(numbers.skip(1));
        let least = pairs.clone().map(|(one, next)| next - one).min()?;
        let gap = pairs.find(|(one, next)| next - one > least);
        gap.map(|(one, next)| [one, next])
    }

    /// The frame that is shown `time` seconds after the first one, of `fps` a second: the last one that there is until then. Before
    /// the first it is the first, after the last the last.
    #[must_use]
    pub fn frame_at(&self, time: f64, fps: f64) -> u64 {
        let first = self.files.keys().next().copied().unwrap_or_default();
        // A share of a step more, so that a time that is a frame's is not rounded to the one before.
        let steps = (time * fps + 1e-6).floor();
        let wanted = if steps > 0.0 {
            first.saturating_add(steps as u64)
        } else {
            first
        };
        let until = self.files.range(..=wanted).next_back();
        until.map_or(first, |(frame, _)| *frame)
    }

    /// Reads a frame by its number.
    ///
    /// # Errors
    ///
    /// When there is none of this number, or its file can't be read.
    pub fn read(&self, frame: u64) -> Result<Model, SequenceError> {
        match self.files.get(&frame) {
            Some(path) => Ok(read_model(path)?),
            None => {
                let before = self.files.range(..frame).next_back();
                let after = self.files.range(frame..).next();
                let near = before.into_iter().chain(after).map(|(number, _)| *number);
                Err(SequenceError::NoFrame {
                    frame,
                    nearest: near
                        .min_by_key(|number| number.abs_diff(frame))
                        .unwrap_or_default(),
                })
            }
        }
    }
}

/// What a name has before and after its number or its `#`: the last of them before the ending.
fn around_number(name: &str) -> Option<(&str, &str)> {
    let stem = name.rfind('.').unwrap_or(name.len());
    for is_part in [|c: char| c == '#', |c: char| c.is_ascii_digit()] {
        if let Some(last) = name[..stem].rfind(is_part) {
            let before = name[..=last].trim_end_matches(is_part).len();
            return Some((&name[..before], &name[last + 1..]));
        }
    }
    None
}

fn number_of(name: &str, begin: &str, end: &str) -> Option<u64> {
    let number = name.strip_prefix(begin)?.strip_suffix(end)?;
    let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    if is_number { number.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_found_by_one_of_them_or_by_a_pattern() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let obj = |x: f32| format!("v 0 0 0\nv {x} 0 0\nv 0 1 0\nf 1 2 3\n");
        for (name, x) in [
            ("a2.0008.obj", 8.0),
            ("a2.0009.obj", 9.0),
            ("a2.0012.obj", 12.0),
        ] {
            fs::write(path(name), obj(x)).unwrap();
        }
        for name in ["a2.x.obj", "a2..obj", "a2.0010.ply", "b.0010.obj"] {
            fs::write(path(name), "").unwrap();
        }
        let sequence = Sequence::find(&path("a2.0009.obj")).unwrap();
        assert_eq!(sequence, Sequence::find(&path("a2.####.obj")).unwrap());
        assert_eq!(
            sequence.files().keys().copied().collect::<Vec<_>>(),
            [8, 9, 12]
        );
        assert_eq!(sequence.read(12).unwrap().meshes[0].positions[1].x, 12.0);
        let message = sequence.read(11).unwrap_err().to_string();
        assert_eq!(message, "there is no frame 11: the nearest is 12");

        for (time, frame) in [
            (-1.0, 8),
            (0.0, 8),
            (1.0 / 24.0, 9),
            (3.9 / 24.0, 9),
            (4.0 / 24.0, 12),
            (1e30, 12),
            (f64::NAN, 8),
        ] {
            assert_eq!(sequence.frame_at(time, 24.0), frame, "{time}");
        }
    }

    #[test]
    fn a_gap_is_where_numbers_are_farther_apart_than_elsewhere() {
        let folder = tempfile::tempdir().unwrap();
        let gap = |name: &str, numbers: &[u64]| {
            for number in numbers {
                fs::write(folder.path().join(format!("{name}.{number}.obj")), "").unwrap();
            }
            let path = folder.path().join(format!("{name}.#.obj"));
            Sequence::find(&path).unwrap().gap()
        };
        assert_eq!(gap("one", &[7]), None);
        assert_eq!(gap("whole", &[3, 4, 5]), None);
        assert_eq!(gap("tens", &[0, 10, 20]), None);
        assert_eq!(gap("gap", &[5, 8, 9, 12]), Some([5, 8]));
    }

    #[test]
    fn what_is_no_sequence_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |name: &str| {
            Sequence::find(&folder.path().join(name))
                .unwrap_err()
                .to_string()
        };
        assert!(refused("a.obj").contains("has a number before its ending"));
        assert!(refused("a.##.obj").contains("there is no file of this name"));
        assert!(refused("none/a.1.obj").contains("none"));
        for name in ["a.1.obj", "a.01.obj"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        assert_eq!(
            refused("a.#.obj"),
            "frame 1 is in `a.01.obj` and in `a.1.obj`"
        );
    }
}
