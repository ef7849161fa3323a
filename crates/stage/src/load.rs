//! The preset's files: hair and head in, strands with their sizes out.

use crate::files::{Files, StageError};
use crate::hair::{HairModel, head_of};
use crate::head::HeadModel;
use crate::preset::{HeadShape, Preset, UpAxis};
use crate::style;
use glam::Vec3;
use hair_io::orient::Axes;
use hair_io::{HairFile, HairOptions, HeadFrame, Mesh};
use std::path::{Path, PathBuf};

fn axes(up: UpAxis) -> Option<Axes> {
    match up {
        UpAxis::Guess => None,
        UpAxis::Y => Some(Axes::Y),
        UpAxis::Z => Some(Axes::Z),
    }
}

fn scale(number: f32) -> Option<f32> {
    (number > 0.0).then_some(number)
}

/// Whether a file is hair that grows.
pub(crate) fn is_style(path: &Path) -> bool {
    path.to_string_lossy().ends_with(".style.ron")
}

/// The caller's file, or the preset's beside the preset.
pub(crate) fn chosen(
    given: Option<&PathBuf>,
    own: Option<&String>,
    folder: &Path,
) -> Option<PathBuf> {
    given.cloned().or_else(|| own.map(|name| folder.join(name)))
}

/// The head that is drawn, if any.
pub(crate) fn head(
    preset: &Preset,
    files: &Files,
    notes: &mut Vec<String>,
) -> Result<Option<HeadModel>, StageError> {
    let section = &preset.sections.head;
    let own = section.file.as_ref();
    let Some(path) = chosen(files.head.as_ref(), own, &files.preset_folder) else {
        return Ok(match section.shape {
            HeadShape::None => None,
            HeadShape::Bust => Some(HeadModel::bust()),
        });
    };
    let file = hair_io::read_head(&path, axes(section.up), scale(section.scale))?;
    notes.extend(file.notes);
    let mut mesh = file.mesh;
    if is_inside_out(&mesh) {
        notes.push("head: its triangles face inwards and are turned around".to_owned());
        mesh.triangles
            .iter_mut()
            .for_each(|triangle| triangle.swap(1, 2));
        mesh.normals
            .iter_mut()
            .for_each(|normal| *normal = -*normal);
    }
    Ok(Some(mesh.into()))
}

/// Whether most of a mesh faces inwards: its signed volume, seen from its middle, is below 0.
fn is_inside_out(mesh: &Mesh) -> bool {
    let middle = mesh.positions.iter().sum::<Vec3>() / mesh.positions.len().max(1) as f32;
    let volume: f64 = mesh
        .triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|i| (mesh.positions[i as usize] - middle).as_dvec3());
            a.dot(b.cross(c))
        })
        .sum();
    volume < 0.0
}

/// All strands of the hair, sorted by id.
pub(crate) fn hair(
    preset: &Preset,
    files: &Files,
    head: Option<&Mesh>,
    notes: &mut Vec<String>,
) -> Result<HairModel, StageError> {
    let own = preset.sections.hair.file.as_ref();
    let path = chosen(files.hair.as_ref(), own, &files.preset_folder).ok_or(StageError::NoHair)?;
    strands(preset, &path, head, notes)
}

/// All strands of a file or style as the preset reads hair, sorted by id.
pub(crate) fn strands(
    preset: &Preset,
    path: &Path,
    head: Option<&Mesh>,
    notes: &mut Vec<String>,
) -> Result<HairModel, StageError> {
    let section = &preset.sections.hair;
    if is_style(path) {
        let mut hair = grow(path, head)?;
        notes.append(&mut hair.file.notes);
        return Ok(hair);
    }
    let given = hair_io::orient::Given {
        up: axes(section.up),
        scale: scale(section.scale),
        offset: None,
    };
    let mut hair = hair_io::read_hair(path, &HairOptions { given, head })?;
    notes.append(&mut hair.notes);
    Ok(HairModel::read(hair, head))
}

/// The hair of a style, grown on the head.
fn grow(path: &Path, head: Option<&Mesh>) -> Result<HairModel, StageError> {
    let mesh = head.ok_or_else(|| StageError::NoHead(path.to_owned()))?;
    let text = std::fs::read_to_string(path).map_err(|source| StageError::Read {
        path: path.to_owned(),
        source,
    })?;
    let style = style::parse(&path.display().to_string(), &text)?;
    // The mesh alone: the hair that grows on a head must not change its size.
    let head = head_of(HeadFrame::find(Some(mesh), &[]));
    let shell = groom::Shell::new(
        &mesh.positions,
        &mesh.normals,
        &mesh.triangles,
        head.center,
        head.height_m,
    );
    let grown = groom::grow(&style, &shell);
    let notes = vec![format!(
        "hair: {} clumps, grown from the style",
        grown.strands.len()
    )];
    Ok(HairModel {
        infos: Vec::new(),
        all_roots: grown.strands.roots().collect(),
        reach_m: 0.0,
        file: HairFile {
            strands: grown.strands,
            motion: None,
            notes,
        },
        held: grown.held,
        undercoat: grown.undercoat,
        shapes: None,
        bake: None,
        ties: grown.ties,
        head,
    })
}
