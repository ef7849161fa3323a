//! Picture files: their names and their bytes.

use crate::animation::{Animation, color, pixels};
use crate::pass::PassPicture;
use crate::paths::place;
use hair_io::{folder_of, write_whole};
use render::Picture;
use std::collections::HashSet;
use std::ffi::{OsStr, OsString};
use std::fs::{self, DirEntry};
use std::io;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Weak};

/// Where pictures go.
pub(crate) struct Output {
    /// Any file in their folder.
    beside: PathBuf,
    name: Name,
    transparent: bool,
    /// All frames in one file, once there is a first.
    animation: Option<Animation>,
    /// How many frames there are, and how many are shown in a second.
    frames: u32,
    fps: f32,
    /// The last picture of several, and its bytes: it may come again. Others may have its memory once they are done with it.
    last: Option<(Weak<Picture>, Vec<u8>)>,
}

/// What pictures are called.
enum Name {
    One(OsString),
    /// One file for all frames.
    Moving(OsString),
    /// The frame's number, of at least so many digits, between two texts.
    Numbered(String, usize, String),
}

impl Output {
    /// Pictures at `given`, or named after the preset in the current folder. A sequence gets frame
    /// numbers, also where the name has no `#` for them; or it is one animated PNG, where the name ends in .apng.
    ///
    /// # Errors
    ///
    /// When the name promises another format than PNG.
    pub fn new(
        given: Option<&Path>,
        preset: &Path,
        frames: Option<(u32, u32)>,
        fps: f32,
        transparent: bool,
    ) -> Result<Self, String> {
        let sequence = frames.is_some();
        let (beside, name) = match given {
            Some(path) => (path.to_owned(), given_name(path, sequence)?),
            None => (PathBuf::new(), name_after(preset, sequence)?),
        };
        Ok(Self {
            beside,
            name,
            transparent,
            animation: None,
            frames: frames.map_or(1, |(first, last)| last - first + 1),
            fps,
            last: None,
        })
    }

    /// The file of a frame.
    pub fn path(&self, frame: u32) -> PathBuf {
        match &self.name {
            Name::One(name) | Name::Moving(name) => self.beside.with_file_name(name),
            Name::Numbered(before, width, after) => {
                let name = format!("{before}{frame:0width$}{after}");
                self.beside.with_file_name(name)
            }
        }
    }

    /// The first of `paths` that the picture of one of these frames would be written over.
    pub fn writes_over<'a>(
        &self,
        paths: &'a [PathBuf],
        frames: RangeInclusive<u32>,
    ) -> Option<&'a PathBuf> {
        // A picture is written where a link of its name leads.
        let links = self.links(&frames);
        let is_picture = |path: &&PathBuf| {
            let path = place(path);
            let frame = match self.name {
                Name::One(_) | Name::Moving(_) => Some(*frames.start()),
                Name::Numbered(..) => path.file_name().and_then(|name| self.frame(name)),
            };
            let is_named = frame
                .is_some_and(|frame| frames.contains(&frame) && place(&self.path(frame)) == path);
            is_named || links.contains(&path)
        };
        paths.iter().find(is_picture)
    }

    /// Where links of the names of these frames' pictures lead.
    fn links(&self, frames: &RangeInclusive<u32>) -> HashSet<PathBuf> {
        let entries = match self.name {
            Name::One(_) | Name::Moving(_) => None,
            Name::Numbered(..) => fs::read_dir(folder_of(&self.beside)).ok(),
        };
        // A folder that cannot be read is told where the first picture is tried.
        let entries = entries.into_iter().flatten().flatten();
        let is_link = |entry: &DirEntry| {
            let frame = self.frame(&entry.file_name());
            frame.is_some_and(|frame| frames.contains(&frame))
                && entry.file_type().is_ok_and(|kind| kind.is_symlink())
        };
        let links = entries.filter(is_link);
        links.map(|entry| place(&entry.path())).collect()
    }

    /// The frame whose picture has this name, where names are numbered.
    fn frame(&self, name: &OsStr) -> Option<u32> {
        let Name::Numbered(before, _, after) = &self.name else {
            return None;
        };
        let digits = name.to_str()?.strip_prefix(before)?.strip_suffix(after)?;
        let frame = digits.parse().ok()?;
        (self.path(frame).file_name() == Some(name)).then_some(frame)
    }

    /// Writes a picture as PNG: sRGB, straight alpha where it is transparent. Frames of one animated PNG are written with the
    /// last one, by [`Output::finish`].
    pub fn write(&mut self, picture: &Arc<Picture>, frame: u32) -> io::Result<()> {
        if let Name::Moving(_) = self.name {
            let animation = match &mut self.animation {
                Some(animation) => animation,
                none => none.insert(Animation::new(
                    [picture.width, picture.height],
                    self.frames,
                    self.fps,
                    self.transparent,
                )?),
            };
            return animation.push(picture);
        }
        let path = self.path(frame);
        match &self.last {
            Some((last, bytes)) if last.as_ptr() == Arc::as_ptr(picture) => {
                write_whole(&path, bytes)
            }
            _ => {
                let bytes = encode(picture, self.transparent)?;
                write_whole(&path, &bytes)?;
                self.last = (self.frames > 1).then(|| (Arc::downgrade(picture), bytes));
                Ok(())
            }
        }
    }

    /// Writes a picture of a pass, of which there is no animation.
    pub fn write_pass(&mut self, picture: &PassPicture, frame: u32) -> io::Result<()> {
        write_whole(&self.path(frame), &picture.encode()?)
    }

    /// Whether all frames go into one file.
    pub fn is_moving(&self) -> bool {
        matches!(self.name, Name::Moving(_))
    }

    /// Writes what is written when all frames are there.
    pub fn finish(&mut self) -> io::Result<()> {
        let path = self.path(0);
        match self.animation.take() {
            Some(animation) => animation.write(&path),
            None => Ok(()),
        }
    }
}

/// The name that the user gives: where a frame's number goes, the last run of `#` stands.
fn given_name(path: &Path, sequence: bool) -> Result<Name, String> {
    let shown = path.display();
    let ends_in = |wanted: &str| {
        let ending = path.extension();
        ending.is_some_and(|ending| ending.eq_ignore_ascii_case(wanted))
    };
    let Some(name) = path
        .file_name()
        .filter(|_| ends_in("png") || ends_in("apng"))
    else {
        return Err(format!(
            "-o {shown}: pictures are PNG, so the name must end in .png, or in .apng for one file that moves"
        ));
    };
    if ends_in("apng") {
        return Ok(Name::Moving(name.to_owned()));
    }
    let Some(text) = name.to_str() else {
        if sequence {
            return Err(format!(
                "-o {shown}: the name must be UTF-8 text, to put numbers into it"
            ));
        }
        return Ok(Name::One(name.to_owned()));
    };
    if let Some(last) = text.rfind('#') {
        let (marked, after) = text.split_at(last + 1);
        let before = marked.trim_end_matches('#');
        let width = marked.len() - before.len();
        return Ok(Name::Numbered(before.to_owned(), width, after.to_owned()));
    }
    let (stem, ending) = text.split_at(text.len() - ".png".len());
    Ok(match sequence {
        true => Name::Numbered(format!("{stem}."), DIGITS, ending.to_owned()),
        false => Name::One(name.to_owned()),
    })
}

/// The digits of frames where the user says nothing of them.
const DIGITS: usize = 4;

/// The preset's name without `.ron`.
fn name_after(preset: &Path, sequence: bool) -> Result<Name, String> {
    let is_ron = preset.extension().is_some_and(|ending| ending == "ron");
    let stem = if is_ron {
        preset.file_stem()
    } else {
        preset.file_name()
    };
    let stem = stem.unwrap_or_default();
    if !sequence {
        let mut name = stem.to_owned();
        name.push(".png");
        return Ok(Name::One(name));
    }
    let stem = stem.to_str().ok_or_else(|| {
        let shown = preset.display();
        format!("{shown}: the name is not UTF-8 text: say with -o where the pictures go")
    })?;
    Ok(Name::Numbered(
        format!("{stem}."),
        DIGITS,
        ".png".to_owned(),
    ))
}

fn encode(picture: &Picture, transparent: bool) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_color(color(transparent));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixels(picture, transparent))?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(given: Option<&str>, preset: &str, sequence: bool) -> Output {
        let frames = sequence.then_some((0, 9));
        Output::new(given.map(Path::new), Path::new(preset), frames, 24.0, false).unwrap()
    }

    fn path(given: Option<&str>, sequence: bool, frame: u32) -> String {
        let path = output(given, "a/look.ron", sequence).path(frame);
        path.to_string_lossy().into_owned()
    }

    #[test]
    fn names() {
        assert_eq!(path(None, false, 0), "look.png");
        assert_eq!(path(None, true, 12), "look.0012.png");
        assert_eq!(path(Some("out/x.png"), false, 5), "out/x.png");
        assert_eq!(path(Some("out/x.png"), true, 5), "out/x.0005.png");
        assert_eq!(path(Some("out/x_##.png"), true, 123), "out/x_123.png");
        assert_eq!(path(Some("x#y###.png"), true, 7), "x#y007.png");
        assert_eq!(path(Some("x.v2.PNG"), true, 7), "x.v2.0007.PNG");
        assert_eq!(path(Some("out/x.apng"), true, 7), "out/x.apng");
    }

    #[test]
    fn names_after_presets() {
        for (preset, one, numbered) in [
            ("look.v2.ron", "look.v2.png", "look.v2.0007.png"),
            ("look", "look.png", "look.0007.png"),
            ("look.v2", "look.v2.png", "look.v2.0007.png"),
            ("no#1.ron", "no#1.png", "no#1.0007.png"),
        ] {
            let name = |sequence| output(None, preset, sequence).path(7);
            assert_eq!(name(false), Path::new(one));
            assert_eq!(name(true), Path::new(numbered));
        }
    }

    #[test]
    fn what_a_sequence_writes() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let pattern = path("a_##.png");
        let output = output(Some(pattern.to_str().unwrap()), "look.ron", true);
        for (name, is_written) in [
            ("a_07.png", true),
            ("./a_12.png", true),
            ("a_7.png", false),
            ("a_13.png", false),
            ("a_.png", false),
        ] {
            let paths = [path(name)];
            let found = output.writes_over(&paths, 5..=12);
            assert_eq!(found.is_some(), is_written, "{name}");
        }
    }

    #[test]
    #[cfg(unix)]
    fn a_sequence_writes_where_links_lead() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("sub")).unwrap();
        let read = [path("first.ron"), path("sub/second.ron")];
        for file in &read {
            fs::write(file, "read").unwrap();
        }
        let pattern = path("a_##.png");
        let output = output(Some(pattern.to_str().unwrap()), "look.ron", true);
        for beside in ["a_13.png", "a_007.png", "b_07.png"] {
            std::os::unix::fs::symlink(&read[0], path(beside)).unwrap();
        }
        assert_eq!(output.writes_over(&read, 5..=12), None);
        std::os::unix::fs::symlink("sub/second.ron", path("a_07.png")).unwrap();
        assert_eq!(output.writes_over(&read, 5..=12), Some(&read[1]));
        assert_eq!(output.writes_over(&read, 8..=12), None);
        // What is read may be named by the link itself.
        let link = [path("a_07.png")];
        assert_eq!(output.writes_over(&link, 5..=12), Some(&link[0]));
    }
}
