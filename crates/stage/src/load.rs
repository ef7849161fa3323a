//! The preset's files: hair and head in, strands with their sizes out.

use crate::bake;
use crate::files::{Files, StageError};
use crate::hair::Hair;
use crate::head::HeadModel;
use crate::preset::{HeadShape, Preset, UpAxis};
use crate::style;
use glam::Vec3;
use groom::Guides;
use hair_io::orient::Axes;
use hair_io::{HairFile, HairOptions, HeadFrame, Mesh};
use render::{Head, StrandInfo};
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
) -> Result<Hair, StageError> {
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
) -> Result<Hair, StageError> {
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
    let mut by_id: Vec<usize> = (0..hair.strands.len()).collect();
    by_id.sort_by_key(|&i| hair.strands.id(i));
    hair.keep(&by_id);
    // Before strands are chosen: how many are kept moves neither the camera nor any size.
    let roots: Vec<Vec3> = hair.strands.roots().collect();
    Ok(Hair {
        held: vec![1; hair.strands.len()],
        undercoat: 0,
        file: hair,
        shapes: None,
        ties: Vec::new(),
        head: head_of(HeadFrame::find(head, &roots)),
    })
}

fn head_of(frame: HeadFrame) -> Head {
    Head {
        center: frame.center,
        height_m: frame.height,
    }
}

/// Puts baked motion in place of the hair's own, where there is a bake.
pub(crate) fn bake(preset: &Preset, files: &Files, hair: &mut Hair) -> Result<(), StageError> {
    let own = preset.sections.hair.bake.as_ref();
    if let Some(path) = chosen(files.bake.as_ref(), own, &files.preset_folder) {
        hair.file.motion = Some(bake::read(&path, &hair.file.strands)?);
    }
    Ok(())
}

/// Keeps as many strands as the preset asks for, and says what size each is: its own, the preset's, or
/// from the strands it stands for.
pub(crate) fn keep_guides(preset: &Preset, hair: &mut Hair) -> Vec<StrandInfo> {
    let strands = &hair.file.strands;
    let section = &preset.sections.hair;
    let guides = match section.guides {
        0 => Guides::choose(strands, strands.len()),
        n => Guides::choose(strands, n as usize),
    };
    let set = Some(section.size).filter(|size| *size > 0.0);
    let given = |i: usize| strands.size(i).or(set);
    let sizes = if guides.kept.iter().all(|&i| given(i).is_some()) {
        vec![0.0; guides.kept.len()]
    } else {
        guides.sizes(strands, hair.head.height_m)
    };
    let infos = guides.kept.iter().zip(sizes).map(|(&i, size)| StrandInfo {
        id: strands.id(i),
        mean: Vec3::ZERO,
        size: given(i).unwrap_or(size),
    });
    let infos = infos.collect();
    hair.keep(&guides.kept);
    infos
}

/// The hair of a style, grown on the head.
fn grow(path: &Path, head: Option<&Mesh>) -> Result<Hair, StageError> {
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
    Ok(Hair {
        file: HairFile {
            strands: grown.strands,
            motion: None,
            notes,
        },
        held: grown.held,
        undercoat: grown.undercoat,
        shapes: None,
        ties: grown.ties,
        head,
    })
}
