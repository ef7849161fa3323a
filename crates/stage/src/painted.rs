//! Meshes in colours of their own: a character as its file paints it, and eyes, lashes, clothes or glasses beside a head.

mod materials;
mod shells;
mod vertex_colors;

pub(crate) use materials::{MeshPaint, MeshPicture, check_picture};
pub(crate) use shells::shells;

use crate::files::StageError;
use crate::meant::meant;
use crate::names::Names;
use crate::numbered::{Formed, MOST_CORNERS, MOST_FILES, Numbered, gap_note};
use crate::preset::{AlphaChoice, MeshSection};
use crate::things::{Beating, Placed, Thing};
use glam::{Vec2, Vec3};
use hair_io::orient::Orientation;
use materials::{Pictures, clear_of, is_clear, paint_of, picture};
use mesh_io::{Mesh, Model, Sequence};
use render::{Coverage, Head};
use std::path::Path;
use std::sync::Arc;

/// A mesh in colours of its own, metres, Y up.
#[derive(Clone)]
pub(crate) struct PaintedMesh {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// For each position its place in the picture; empty without one.
    pub places: Vec<Vec2>,
    pub paint: MeshPaint,
    /// What layers may call it: the mesh's name, its material's, and that of its file beside a head.
    pub names: Vec<String>,
    /// Which of the preset's `meshes` it is of; none is the head's own file.
    pub section: Option<usize>,
    /// Which mesh of its file it is, and which of that mesh's vertices its own are, where triangles were taken away or have colours of their own: empty is all.
    pub index: usize,
    pub kept: Vec<usize>,
    /// Whether its outside is where its file has the inside: its normals and triangles are turned around.
    pub is_turned: bool,
    /// Whether it is a shell around others ([`shells`]): toon models have them as their outlines.
    pub is_shell: bool,
    /// Whether hair lies on it, and covers it where it is a little deeper.
    pub is_cap: bool,
    /// What it is, where it moves by itself.
    pub moving: Option<Moving>,
    /// Which of the meshes of its numbered files it is: as long as that stays its triangles do.
    pub form: usize,
}

/// What moves a mesh by itself.
#[derive(Clone)]
pub(crate) enum Moving {
    /// A thing.
    Beating(Beating),
    /// Numbered files.
    Numbered(Arc<Numbered>),
}

impl PaintedMesh {
    /// Moves what a file holds to where a preset wants it.
    fn put(&mut self, section: &MeshSection, head: Head, placed: &Placed) {
        if (section.at, section.turn, section.size) == ([0.0; 3], [0.0; 3], 1.0) {
            return;
        }
        for position in &mut self.positions {
            *position = placed.point((*position - head.center) / head.height_m);
        }
        for normal in &mut self.normals {
            *normal = placed.turn * *normal;
        }
    }

    /// Has the triangles of a form of its numbered files, and its corners, where the file has them.
    pub(crate) fn take_form(&mut self, formed: &Formed) {
        self.positions.clone_from(&formed.positions);
        self.normals.clone_from(&formed.normals);
        if self.form != formed.kind {
            self.triangles.clear();
            self.triangles.extend_from_slice(formed.triangles);
            self.places.clear();
            self.places.extend_from_slice(formed.places);
            self.form = formed.kind;
        }
    }

    /// The vertex of its file's mesh that one of its own is.
    pub(crate) fn vertex(&self, own: usize) -> usize {
        self.kept.get(own).copied().unwrap_or(own)
    }

    /// Takes triangles away; one a triangle tells which.
    pub(crate) fn take_away(&mut self, is_gone: &[bool]) {
        if !is_gone.contains(&true) {
            return;
        }
        let mut numbers = vec![None; self.positions.len()];
        let (mut kept, mut triangles) = (Vec::new(), Vec::new());
        for (triangle, _) in self
            .triangles
            .iter()
            .zip(is_gone)
            .filter(|(_, gone)| !**gone)
        {
            triangles.push(triangle.map(|corner| {
                *numbers[corner as usize].get_or_insert_with(|| {
                    kept.push(corner as usize);
                    kept.len() as u32 - 1
                })
            }));
        }
        self.triangles = triangles;
        self.kept = kept.iter().map(|i| self.vertex(*i)).collect();
        self.positions = kept.iter().map(|i| self.positions[*i]).collect();
        self.normals = kept.iter().map(|i| self.normals[*i]).collect();
        if !self.places.is_empty() {
            self.places = kept.iter().map(|i| self.places[*i]).collect();
        }
    }
}

/// Names of meshes or materials.
#[derive(Clone, Copy)]
pub(crate) struct MeshNames<'a>(pub Names<'a>);

impl MeshNames<'_> {
    /// Whether a mesh is named, or its material.
    pub(crate) fn have(&self, model: &Model, mesh: &Mesh) -> bool {
        names_of(model, mesh).any(|own| self.0.have(own))
    }
}

/// The names of a mesh and of its material.
pub(crate) fn names_of<'m>(model: &'m Model, mesh: &'m Mesh) -> impl Iterator<Item = &'m str> {
    let material = mesh.material.and_then(|index| model.materials.get(index));
    let names = [
        Some(mesh.name.as_str()),
        material.map(|material| material.name.as_str()),
    ];
    names.into_iter().flatten().filter(|name| !name.is_empty())
}

/// Takes away the meshes of a character of whose material nothing shows, as files hide what isn't wanted at the time: `is_gone` tells of each mesh and each of
/// its triangles whether it is not drawn.
pub(crate) fn hide_clear(
    model: &Model,
    path: &Path,
    is_gone: &mut [Vec<bool>],
    notes: &mut Vec<String>,
) {
    if model.rig.is_none() {
        return; // in other formats such an alpha is more often a mistake
    }
    let clear = |index: usize| {
        let material = model.meshes[index].material;
        let material = material.and_then(|index| model.materials.get(index));
        material.filter(|own| is_clear(own))
    };
    let all: Vec<usize> = shown(is_gone).collect();
    if !all.is_empty() && all.iter().all(|index| clear(*index).is_some()) {
        notes.push(format!(
            "{}: all of its materials are clear by their alpha, and are drawn as if they weren't",
            path.display()
        ));
        return;
    }
    let mut hidden: Vec<&str> = Vec::new();
    for (index, material) in all.into_iter().filter_map(|i| Some((i, clear(i)?))) {
        is_gone[index].fill(true);
        if !hidden.contains(&material.name.as_str()) {
            hidden.push(&material.name);
        }
    }
    if !hidden.is_empty() {
        notes.push(format!(
            "{}: not drawn, as its alpha is less than what shows: `{}`",
            path.display(),
            hidden.join("`, `")
        ));
    }
}

/// What a preset says of the meshes of a file.
pub(crate) struct Wanted {
    /// Which of its `meshes` that is; none is the head's own file.
    section: Option<usize>,
    /// What is clear in their pictures.
    alpha: AlphaChoice,
    /// Whether it has a picture for them.
    has_picture: bool,
}

impl Wanted {
    /// All as the file has it.
    pub(crate) const OF_FILE: Self = Self {
        section: None,
        alpha: AlphaChoice::File,
        has_picture: false,
    };
}

/// The meshes of a model of which anything is left, whole, as they lie in our space: `is_gone` tells of each mesh and each of its triangles whether it is not.
pub(crate) fn of_model(
    model: &Model,
    path: &Path,
    orientation: &Orientation,
    wanted: &Wanted,
    is_gone: &[Vec<bool>],
    notes: &mut Vec<String>,
) -> Result<Vec<PaintedMesh>, StageError> {
    let mut pictures = Pictures::new(model, path);
    let mut painted = Vec::new();
    for index in shown(is_gone) {
        let mesh = &model.meshes[index];
        let material = mesh.material.and_then(|index| model.materials.get(index));
        let paint = paint_of(mesh, material, wanted, &mut pictures)?;
        let positions = mesh.positions.iter().map(|p| orientation.apply(*p));
        let normals = mesh.normals.iter().map(|n| orientation.up.to_y_up(*n));
        painted.push(PaintedMesh {
            positions: positions.collect(),
            normals: normals.collect(),
            triangles: mesh.triangles.clone(),
            places: match paint.picture {
                Some(_) => mesh.uvs.clone(),
                None => Vec::new(),
            },
            paint,
            names: names_of(model, mesh).map(str::to_owned).collect(),
            section: wanted.section,
            index,
            kept: Vec::new(),
            is_turned: false,
            is_shell: false,
            is_cap: false,
            moving: None,
            form: 0,
        });
    }
    notes.append(&mut pictures.notes);
    Ok(painted)
}

/// Which meshes have a triangle that is not gone.
pub(crate) fn shown(is_gone: &[Vec<bool>]) -> impl Iterator<Item = usize> {
    let meshes = is_gone.iter().enumerate();
    meshes
        .filter(|(_, gone)| gone.contains(&false))
        .map(|(index, _)| index)
}

/// The meshes that a preset lists, beside the head whose axes and unit they have.
pub(crate) fn of_sections(
    sections: &[&MeshSection],
    folder: &Path,
    orientation: &Orientation,
    head: Head,
    notes: &mut Vec<String>,
) -> Result<Vec<PaintedMesh>, StageError> {
    let mut painted = Vec::new();
    for (number, section) in sections.iter().enumerate() {
        let placed = Placed::new(head, section.at, section.turn, section.size);
        if let Some(thing) = Thing::new(section.shape) {
            painted.push(of_thing(thing, section, number, placed));
            continue;
        }
        let path = section.path(folder).unwrap_or_default();
        let of_file = OfFile {
            section,
            number,
            folder,
            path: &path,
            name: &name_of(section, &path),
            orientation,
            placed: &placed,
            head,
        };
        painted.extend(match section.is_sequence() {
            true => of_file.numbered(notes)?,
            false => of_file.read(&mesh_io::read_model(&path)?, notes)?,
        });
    }
    Ok(painted)
}

/// What layers may call the meshes of a file: its name without the ending, of numbered files without the number.
fn name_of(section: &MeshSection, path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    match section.is_sequence() {
        true => {
            let before = stem.split('#').next().unwrap_or_default();
            before.trim_end_matches(['.', '_', '-']).to_owned()
        }
        false => stem.into_owned(),
    }
}

/// A file, or numbered files, that a preset lists, and where they are to lie.
struct OfFile<'f> {
    section: &'f MeshSection,
    number: usize,
    folder: &'f Path,
    path: &'f Path,
    /// What layers may call its meshes.
    name: &'f str,
    orientation: &'f Orientation,
    placed: &'f Placed,
    head: Head,
}

impl OfFile<'_> {
    /// The meshes of one file.
    fn read(&self, model: &Model, notes: &mut Vec<String>) -> Result<Vec<PaintedMesh>, StageError> {
        let (section, path) = (self.section, self.path);
        let of_file = |note: &String| format!("{}: {note}", path.display());
        notes.extend(model.notes.iter().map(of_file));
        let [only, hide] =
            [&section.only, &section.hide].map(|names| Names(names.as_deref().unwrap_or_default()));
        let mut is_gone = meant(hide, model, path)?;
        if !only.is_empty() {
            let wanted = meant(only, model, path)?;
            let triangles = is_gone
                .iter_mut()
                .zip(&wanted)
                .flat_map(|(g, w)| g.iter_mut().zip(w));
            triangles.for_each(|(is_gone, wanted)| *is_gone |= !wanted);
        }
        let picture_path = section.texture_path(self.folder);
        let is_as_in_file = section.alpha == AlphaChoice::File && picture_path.is_none();
        // Of numbered files all have the same meshes, whatever fades.
        if is_as_in_file && !section.is_sequence() {
            hide_clear(model, path, &mut is_gone, notes);
        }
        let wanted = Wanted {
            section: Some(self.number),
            alpha: section.alpha,
            has_picture: picture_path.is_some(),
        };
        let mut meshes = of_model(model, path, self.orientation, &wanted, &is_gone, notes)?;
        if let Some(picture_path) = picture_path {
            let coverage = match section.alpha {
                AlphaChoice::Whole => Coverage::Ignored,
                AlphaChoice::Blend => Coverage::Share,
                AlphaChoice::File | AlphaChoice::Cut => Coverage::Cut(0.5),
            };
            let image = picture(&picture_path, clear_of(coverage, 1.0))?;
            for mesh in &mut meshes {
                let own = &model.meshes[mesh.index];
                if own.uvs.is_empty() {
                    return Err(StageError::NoPlaces(path.to_owned()));
                }
                mesh.places.clone_from(&own.uvs);
                mesh.paint.picture = Some(MeshPicture {
                    image: image.clone(),
                    repeats: true,
                    coverage,
                });
            }
        }
        if !(section.is_sequence() || wanted.has_picture) {
            // Numbered files have one picture in time.
            for mesh in &mut meshes {
                mesh.color_triangles(model);
            }
        }
        let is_shell = shells(model, &is_gone);
        for mesh in &mut meshes {
            mesh.is_shell = is_shell[mesh.index];
            mesh.take_away(&is_gone[mesh.index]);
            mesh.names.push(self.name.to_owned());
            mesh.names.extend(section.name.clone());
            mesh.put(section, self.head, self.placed);
        }
        Ok(meshes)
    }

    /// The meshes of numbered files, in their first forms; colours and names are those of the first file.
    fn numbered(&self, notes: &mut Vec<String>) -> Result<Vec<PaintedMesh>, StageError> {
        let wrong = |message: String| StageError::Numbered {
            path: self.path.to_owned(),
            message,
        };
        let sequence = Sequence::find(self.path)?;
        let files = sequence.files().len();
        if files > MOST_FILES {
            return Err(wrong(format!(
                "there are {files} numbered files, and a mesh takes {MOST_FILES} at most"
            )));
        }
        notes.extend(gap_note("meshes", &sequence));
        // For each mesh what it is in each file.
        let mut forms: Vec<Vec<PaintedMesh>> = Vec::new();
        let mut size = 0;
        for (index, (&frame, file)) in sequence.files().iter().enumerate() {
            let model = sequence.read(frame)?;
            let mut of_this = Vec::new();
            let of_file = OfFile {
                path: file,
                ..*self
            };
            let meshes = of_file.read(&model, &mut of_this)?;
            if index == 0 {
                notes.append(&mut of_this);
                forms.resize_with(meshes.len(), Vec::new);
            }
            if meshes.len() != forms.len() {
                return Err(wrong(format!(
                    "file {frame} has {} meshes, and the first one has {}: they are one mesh each in time",
                    meshes.len(),
                    forms.len()
                )));
            }
            for (mesh, forms) in meshes.into_iter().zip(&mut forms) {
                size += mesh.positions.len() + mesh.triangles.len();
                forms.push(mesh);
            }
            if size > MOST_CORNERS {
                return Err(wrong(format!(
                    "up to file {frame} there are more than {MOST_CORNERS} vertices and triangles: all files are held in memory"
                )));
            }
        }
        let (rate, repeat) = (self.section.rate, self.section.repeat);
        let meshes = forms.into_iter().filter_map(|forms| {
            let first = forms.first()?.clone();
            let numbered = Numbered::new(forms.into_iter(), rate, repeat)?;
            Some(PaintedMesh {
                moving: Some(Moving::Numbered(Arc::new(numbered))),
                ..first
            })
        });
        Ok(meshes.collect())
    }
}

/// What is wrong with the files of a mesh that a preset in `folder` lists, if it has any.
pub(crate) fn check(section: &MeshSection, folder: &Path) -> Result<(), StageError> {
    let Some(path) = section.path(folder) else {
        return Ok(());
    };
    if !section.is_sequence() {
        return match path.is_file() {
            true => Ok(mesh_io::read_model(&path).map(drop)?),
            false => Ok(()),
        };
    }
    let head = Head {
        center: Vec3::ZERO,
        height_m: 1.0,
    };
    let of_file = OfFile {
        // A picture that isn't there is told at its place.
        section: &MeshSection {
            texture: None,
            ..section.clone()
        },
        number: 0,
        folder,
        path: &path,
        name: "",
        orientation: &Orientation::OURS,
        placed: &Placed::new(head, section.at, section.turn, section.size),
        head,
    };
    of_file.numbered(&mut Vec::new()).map(drop)
}

/// A thing that a preset lists.
fn of_thing(thing: Thing, section: &MeshSection, number: usize, placed: Placed) -> PaintedMesh {
    let [positions, normals] = thing.in_place(&placed);
    let names = [Some(section.shape.name().to_owned()), section.name.clone()];
    PaintedMesh {
        positions,
        normals,
        triangles: thing.triangles.clone(),
        places: Vec::new(),
        paint: MeshPaint::NONE,
        names: names.into_iter().flatten().collect(),
        section: Some(number),
        index: 0,
        kept: Vec::new(),
        is_turned: false,
        is_shell: false,
        is_cap: false,
        moving: (thing.moves() && section.beat > 0.0).then(|| {
            Moving::Beating(Beating {
                thing: Arc::new(thing),
                placed,
                beat: section.beat,
            })
        }),
        form: 0,
    }
}
