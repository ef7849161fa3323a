//! What moved the hair of a bake: the comment that begins it.

use crate::bodies::BodySection;
use crate::dynamics::DynamicsSection;
use crate::files::{Files, StageError};
use crate::hair::HairModel;
use crate::load::chosen;
use crate::preset::{HeadShape, Preset};
use crate::script;
use effects::section::Section as _;
use effects::{Param, ParamKind, Value};
use hair_io::BoneMotion;
use std::fmt;
use std::fs::File;
use std::io::{self, BufRead as _, BufReader, Read as _};
use std::path::{Path, PathBuf};

/// How a bake begins.
const TITLE: &str = "// A bake by `inkstrand simulate`. What moved its hair, each with the value or hash that `render` compares:";
/// The longest comment that is read: other files may be one line of any length.
const LONGEST: u64 = 10_000;

/// All that the motion of hair depends on.
#[derive(Debug, PartialEq)]
pub(super) struct MovedBy(Vec<Cause>);

/// One thing that it depends on.
#[derive(Debug, PartialEq)]
struct Cause {
    name: String,
    /// Its value, or a hash where that is long: a word without spaces.
    value: String,
    /// What it is for people, where the value is a hash.
    words: String,
}

impl MovedBy {
    /// What moves `hair` in the scene of `preset` and `files`.
    pub fn of(preset: &Preset, files: &Files, hair: &HairModel) -> Result<Self, StageError> {
        let sections = &preset.sections;
        let plain = |name: &str, value: String| Cause {
            name: name.to_owned(),
            value,
            words: String::new(),
        };
        let dynamics = DynamicsSection::TABLE.iter().enumerate().map(|(i, param)| {
            let value = sections.dynamics.get(i);
            let text = value.map_or("default".to_owned(), |value| shown(param, &value));
            plain(&format!("dynamics.{}", param.name), text)
        });
        let mut causes = vec![
            hair_cause(preset, files, hair),
            head_cause(preset, files, hair)?,
            script_cause(preset, files, hair)?,
            gltf_cause(preset, files)?,
            bodies_cause(preset, files)?,
            plain("scene.fps", sections.scene.fps.to_string()),
            plain("seed", preset.seed.to_string()),
        ];
        causes.extend(buffers_cause(
            "gltf.buffers",
            &character_buffers(preset, files),
        ));
        let head = head_file(preset, files);
        causes.extend(buffers_cause("head.buffers", &mesh_buffers(head.iter())));
        let bodies = body_files(preset, files)?;
        causes.extend(buffers_cause("bodies.buffers", &mesh_buffers(&bodies)));
        causes.extend(dynamics);
        Ok(Self(causes))
    }

    /// What a bake says of itself; none where the file does not begin as one.
    pub fn read(path: &Path) -> io::Result<Option<Self>> {
        let mut lines = BufReader::new(File::open(path)?.take(LONGEST)).lines();
        if !matches!(lines.next(), Some(Ok(title)) if title.trim_end() == TITLE) {
            return Ok(None);
        }
        let mut causes = Vec::new();
        for line in lines {
            let line = line?;
            let Some((name, rest)) = line
                .strip_prefix("// ")
                .and_then(|line| line.split_once(": "))
            else {
                break;
            };
            let (value, words) = rest.split_once(' ').unwrap_or((rest, ""));
            causes.push(Cause {
                name: name.to_owned(),
                value: value.trim_end().to_owned(),
                words: words.trim_end().to_owned(),
            });
        }
        Ok(Some(Self(causes)))
    }

    /// In what the motion of a bake differs from this. What one of both does not know, as they are of different
    /// builds, is left out.
    pub fn difference(&self, baked: &Self) -> Option<String> {
        let differs = |own: &Cause| {
            let baked = baked.0.iter().find(|baked| baked.name == own.name)?;
            (baked.value != own.value).then(|| own.difference(baked))
        };
        let found: Vec<String> = self.0.iter().filter_map(differs).collect();
        (!found.is_empty()).then(|| found.join(", "))
    }
}

impl fmt::Display for MovedBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{TITLE}")?;
        for Cause { name, value, words } in &self.0 {
            writeln!(f, "{}", format!("// {name}: {value} {words}").trim_end())?;
        }
        Ok(())
    }
}

impl Cause {
    fn difference(&self, baked: &Self) -> String {
        let name = &self.name;
        match (self.words.as_str(), baked.words.as_str()) {
            ("", "") => format!("{name} was {} and is {}", baked.value, self.value),
            (own, other) if own == other => format!("{name} ({own}) has changed since"),
            (own, other) => format!("{name} was {other} and is {own}"),
        }
    }
}

fn hair_cause(preset: &Preset, files: &Files, hair: &HairModel) -> Cause {
    let strands = &hair.file.strands;
    let mut hash = Hash::new();
    for (i, info) in hair.infos.iter().enumerate() {
        hash.number(info.id);
        hash.number(info.size.to_bits());
        hash.number(hair.held(i) as u32);
        hash.number(strands.strand(i).len() as u32);
    }
    for point in strands.points() {
        hash.numbers(point.as_ref());
    }
    for (zone, dynamics) in hair.zone_dynamics.iter().enumerate() {
        if let Some(dynamics) = dynamics {
            hash.bytes(format!("{zone}: {dynamics:?}").as_bytes());
        }
    }
    let own = preset.sections.hair.file.as_ref();
    let file = match hair.own_colors.is_empty() {
        true => chosen(files.hair.as_ref(), own, &files.preset_folder),
        // A character's own, which is the head.
        false => head_file(preset, files),
    };
    let name = file.map_or_else(String::new, |path| format!(" of {}", file_name(&path)));
    hash.cause("hair", format!("{} strands{name}", strands.len()))
}

fn head_cause(preset: &Preset, files: &Files, hair: &HairModel) -> Result<Cause, StageError> {
    let section = &preset.sections.head;
    let mut hash = Hash::new();
    // Where the file's axes and unit, given or guessed, put it.
    hash.numbers(hair.head.center.as_ref());
    hash.numbers(&[hair.head.height_m]);
    let words = match head_file(preset, files) {
        Some(path) => {
            hash.file(&path)?;
            file_name(&path)
        }
        None => {
            if section.shape == HeadShape::Figure {
                hash.bytes(section.dress.name().as_bytes());
                hash.numbers(&[section.crop]);
            }
            section.shape.name().to_owned()
        }
    };
    hash.bytes(words.as_bytes());
    Ok(hash.cause("head", words))
}

fn head_file(preset: &Preset, files: &Files) -> Option<PathBuf> {
    let own = preset.sections.head.file.as_ref();
    chosen(files.head.as_ref(), own, &files.preset_folder)
}

fn script_cause(preset: &Preset, files: &Files, hair: &HairModel) -> Result<Cause, StageError> {
    let own = preset.sections.motion.file.as_ref();
    let mut hash = Hash::new();
    let Some(path) = chosen(files.motion.as_ref(), own, &files.preset_folder) else {
        return Ok(hash.cause("motion", "none".to_owned()));
    };
    hash.file(&path)?;
    if let Some(shapes) = &hair.shapes {
        let mut points = hair.file.strands.points().to_vec();
        for &time in shapes.times() {
            shapes.sample(time, &mut points);
            for point in &points {
                hash.numbers(point.as_ref());
            }
        }
    }
    Ok(hash.cause("motion", file_name(&path)))
}

fn gltf_cause(preset: &Preset, files: &Files) -> Result<Cause, StageError> {
    let section = &preset.sections.motion;
    let mut hash = Hash::new();
    if section.character {
        let animation = section.animation.as_deref().unwrap_or("0");
        let repeats = if section.repeat { ", repeated" } else { "" };
        let bone = section.bone.as_deref().unwrap_or("head");
        hash.bytes(
            format!("the head's own: bone {bone}, animation {animation}{repeats}").as_bytes(),
        );
        let words = in_comment(&format!("the head's own, animation {animation}{repeats}"));
        return Ok(hash.cause("gltf", words));
    }
    let Some(name) = &section.gltf else {
        return Ok(hash.cause("gltf", "none".to_owned()));
    };
    hash.file(&files.preset_folder.join(name))?;
    let bone = section.bone.as_deref().unwrap_or("head");
    let animation = section.animation.as_deref().unwrap_or("0");
    let repeats = if section.repeat { ", repeated" } else { "" };
    hash.bytes(format!("bone {bone}, animation {animation}{repeats}").as_bytes());
    let [bone, animation] = [bone, animation].map(in_comment);
    let words = format!("bone {bone}, animation {animation}{repeats}");
    Ok(hash.cause("gltf", format!("{}, {words}", file_name(Path::new(name)))))
}

/// Bodies of the preset, and the files of all; what else a script says of its own is in its file.
fn bodies_cause(preset: &Preset, files: &Files) -> Result<Cause, StageError> {
    let mut hash = Hash::new();
    for section in preset.bodies.iter().map(|body| &body.section) {
        for (index, param) in BodySection::TABLE.iter().enumerate() {
            // A colour moves no hair.
            let value = section.get(index).filter(|_| param.name != "color");
            let text = value.map_or(String::new(), |value| shown(param, &value));
            hash.bytes(format!("{}: {text}", param.name).as_bytes());
        }
    }
    let all = body_files(preset, files)?;
    for path in &all {
        hash.file(path)?;
    }
    let words = match (preset.bodies.len(), all.len()) {
        (0, 0) => "none".to_owned(),
        (bodies, files) => format!("{bodies} of the preset, {files} files"),
    };
    Ok(hash.cause("bodies", words))
}

/// The files of all bodies, the preset's and its script's.
fn body_files(preset: &Preset, files: &Files) -> Result<Vec<PathBuf>, StageError> {
    let bodies = preset.bodies.iter();
    let mut all: Vec<PathBuf> = bodies
        .flat_map(|body| body.section.files(&files.preset_folder))
        .collect();
    let own = preset.sections.motion.file.as_ref();
    if let Some(path) = chosen(files.motion.as_ref(), own, &files.preset_folder) {
        let script = script::parse(&path.display().to_string(), &files.read_text(&path)?)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let bodies = script.named_bodies.iter();
        all.extend(bodies.flat_map(|body| body.section.files(folder)));
    }
    Ok(all)
}

/// The files that hold the numbers of the character's animations, where it has them beside it.
fn character_buffers(preset: &Preset, files: &Files) -> Vec<PathBuf> {
    let path = preset.character_path(files);
    let buffers = path.and_then(|path| BoneMotion::files(&path).ok());
    buffers.unwrap_or_default()
}

/// The files that hold the numbers of meshes, where these have them beside them.
fn mesh_buffers<'a>(meshes: impl IntoIterator<Item = &'a PathBuf>) -> Vec<PathBuf> {
    let meshes = meshes.into_iter();
    let named = meshes.filter_map(|path| mesh_io::named_files(path).ok());
    named.flat_map(|named| named.buffers).collect()
}

/// Such files; none where there are none.
fn buffers_cause(name: &str, buffers: &[PathBuf]) -> Option<Cause> {
    let mut hash = Hash::new();
    for buffer in buffers {
        // Who reads the meshes or the motion tells what is wrong with the files that they need.
        let _ = hash.file(buffer);
    }
    let names: Vec<String> = buffers.iter().map(|path| file_name(path)).collect();
    (!names.is_empty()).then(|| hash.cause(name, in_comment(&names.join(", "))))
}

/// A value as a preset writes it.
fn shown(param: &Param, value: &Value) -> String {
    match (param.kind, value) {
        (ParamKind::Choice { names, .. }, Value::Choice(index)) => {
            names[*index as usize].to_owned()
        }
        (_, Value::Number(number)) => number.to_string(),
        (_, Value::Integer(number)) => number.to_string(),
        (_, other) => format!("{other:?}").replace(' ', ""),
    }
}

fn file_name(path: &Path) -> String {
    in_comment(&path.file_name().unwrap_or_default().to_string_lossy())
}

/// A name on one line, and not too much of it: the values are what is compared.
fn in_comment(name: &str) -> String {
    let visible = |c: char| if c.is_control() { '_' } else { c };
    name.chars().take(200).map(visible).collect()
}

/// FNV-1a, which is the same in every build and on every machine.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x100_0000_01B3);
        }
    }

    fn number(&mut self, number: u32) {
        self.bytes(&number.to_le_bytes());
    }

    fn numbers(&mut self, numbers: &[f32]) {
        for number in numbers {
            self.number(number.to_bits());
        }
    }

    /// A file's bytes; ends of lines as any system writes them.
    fn file(&mut self, path: &Path) -> Result<(), StageError> {
        let mut bytes = hair_io::read_bytes(path, hair_io::MOST_OF_DATA)?;
        bytes.retain(|byte| *byte != b'\r');
        self.bytes(&bytes);
        Ok(())
    }

    fn cause(self, name: &str, words: String) -> Cause {
        Cause {
            name: name.to_owned(),
            value: format!("{:016x}", self.0),
            words,
        }
    }
}
