//! Meshes of numbered files, which take one form after the other.

use crate::bodies::forms::{End, between, mixed, mixed_normals};
use crate::painted::PaintedMesh;
use glam::{Vec2, Vec3};
use mesh_io::Sequence;
use std::path::PathBuf;

/// More files than this are no sequence that is read whole: so long do two minutes of 24 frames a second last.
pub(crate) const MOST_FILES: usize = 2880;

/// More vertices and triangles than this are too many, in all files together: somewhat more than a gigabyte.
pub(crate) const MOST_CORNERS: usize = 60_000_000;

/// All files that are read where this one is named: those of a sequence, where the name is one's.
pub(crate) fn all_files(path: PathBuf, is_sequence: bool) -> Vec<PathBuf> {
    match is_sequence.then(|| Sequence::find(&path)) {
        Some(Ok(sequence)) => sequence.files().values().cloned().collect(),
        _ => vec![path],
    }
}

/// That files of a sequence are missing, in the `section` that names it: one form comes after the other, whatever their numbers are.
pub(crate) fn gap_note(section: &str, sequence: &Sequence) -> Option<String> {
    let gap = sequence.gap()?;
    let [before, after] = gap.map(|number| {
        let name = sequence
            .files()
            .get(&number)
            .and_then(|file| file.file_name());
        name.unwrap_or_default().to_string_lossy()
    });
    Some(format!(
        "{section}: files are missing between `{before}` and `{after}`, and all that come after them come earlier"
    ))
}

/// The forms that a mesh takes in time.
pub(crate) struct Numbered {
    /// One or more.
    forms: Vec<Form>,
    /// Forms a second.
    rate: f64,
    /// What comes after the last one.
    end: End,
}

/// What a mesh is in one file.
struct Form {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    places: Vec<Vec2>,
    /// The first form that has these triangles.
    kind: usize,
}

/// What a mesh is at a time.
pub(crate) struct Formed<'n> {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub triangles: &'n [[u32; 3]],
    pub places: &'n [Vec2],
    /// Of all times with this number triangles and places are the same.
    pub kind: usize,
}

impl Numbered {
    /// The forms of one mesh, which it is in one file after the other; `None` where there is none.
    pub fn new(
        meshes: impl Iterator<Item = PaintedMesh>,
        rate: f32,
        repeats: bool,
    ) -> Option<Self> {
        let mut forms: Vec<Form> = Vec::new();
        for (number, mesh) in meshes.enumerate() {
            // Where triangles change they do so in each file, or seldom: what is asked first is the form before.
            let is_same = |form: &&Form| {
                form.positions.len() == mesh.positions.len()
                    && form.triangles == mesh.triangles
                    && form.places == mesh.places
            };
            let kind = forms
                .last()
                .filter(is_same)
                .map_or(number, |form| form.kind);
            forms.push(Form {
                positions: mesh.positions,
                normals: mesh.normals,
                triangles: mesh.triangles,
                places: mesh.places,
                kind,
            });
        }
        let rate = f64::from(rate);
        (!forms.is_empty()).then_some(Self {
            forms,
            rate,
            end: End::of_files(repeats),
        })
    }

    /// Where corners are in all of its forms.
    pub fn all_positions(&self) -> impl Iterator<Item = &Vec3> {
        self.forms.iter().flat_map(|form| &form.positions)
    }

    /// What it is at a time (seconds): between two files of one mesh it is in between, else as in the file before.
    pub fn at(&self, time: f64) -> Formed<'_> {
        let (from, to, share) = between(self.forms.len(), self.rate, self.end, time);
        let [from, to] = [from, to].map(|form| &self.forms[form]);
        let (positions, normals) = match share == 0.0 || from.kind != to.kind {
            true => (from.positions.clone(), from.normals.clone()),
            false => (
                mixed(&from.positions, &to.positions, share),
                mixed_normals(&from.normals, &to.normals, share),
            ),
        };
        Formed {
            positions,
            normals,
            triangles: &from.triangles,
            places: &from.places,
            kind: from.kind,
        }
    }

    /// What it is in its form of this kind, as the file has it.
    pub fn of_kind(&self, kind: usize) -> Formed<'_> {
        let form = &self.forms[kind];
        Formed {
            positions: form.positions.clone(),
            normals: form.normals.clone(),
            triangles: &form.triangles,
            places: &form.places,
            kind: form.kind,
        }
    }
}
