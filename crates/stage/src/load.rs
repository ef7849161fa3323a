//! The preset's files: hair and head in, strands with their sizes out.

use crate::files::{Files, StageError};
use crate::head::HeadModel;
use crate::motion::{self, MotionScript};
use crate::preset::Preset;
use crate::style;
use glam::Vec3;
use groom::Tie;
use hair_io::orient::Axes;
use hair_io::{HairFile, HairOptions, HeadFrame, Mesh};
use render::{Head, StrandInfo};
use std::path::{Path, PathBuf};

/// Radius of a clump in units of the spacing of the roots: neighbours overlap and hide the scalp.
const RADIUS_IN_SPACINGS: f32 = 0.75;
/// The largest radius that is taken from the spacing of roots, head heights.
const LARGEST_RADIUS: f32 = 0.12;

fn axes(choice: u32) -> Option<Axes> {
    [None, Some(Axes::Y), Some(Axes::Z)][choice as usize]
}

fn scale(number: f32) -> Option<f32> {
    (number > 0.0).then_some(number)
}

/// The caller's file, or the preset's beside the preset.
fn chosen(given: Option<&PathBuf>, own: Option<&str>, folder: &Path) -> Option<PathBuf> {
    given.cloned().or_else(|| own.map(|name| folder.join(name)))
}

/// The head that is drawn, if any.
pub(crate) fn head(
    preset: &Preset,
    files: &Files,
    notes: &mut Vec<String>,
) -> Result<Option<HeadModel>, StageError> {
    let values = &preset.head;
    let Some(path) = chosen(
        files.head.as_ref(),
        values.text("file"),
        &files.preset_folder,
    ) else {
        let is_bust = values.choice("shape") == 1;
        return Ok(is_bust.then(HeadModel::bust));
    };
    let file = hair_io::read_head(
        &path,
        axes(values.choice("up")),
        scale(values.number("scale")),
    )?;
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

/// Hair that was read or grown.
pub(crate) struct Hair {
    pub file: HairFile,
    /// How many points from its root each strand keeps on the head.
    pub held: Vec<u32>,
    /// The ties that gather it.
    pub ties: Vec<Tie>,
    /// The head that it stands on.
    pub head: Head,
}

impl Hair {
    /// Keeps these strands, in this order.
    pub fn keep(&mut self, indices: &[usize]) {
        self.file.keep(indices);
        self.held = indices.iter().map(|&i| self.held[i]).collect();
    }
}

/// All strands of the hair, sorted by id.
pub(crate) fn hair(
    preset: &Preset,
    files: &Files,
    head: Option<&Mesh>,
    notes: &mut Vec<String>,
) -> Result<Hair, StageError> {
    let values = &preset.hair;
    let path = chosen(
        files.hair.as_ref(),
        values.text("file"),
        &files.preset_folder,
    )
    .ok_or(StageError::NoHair)?;
    if path.to_string_lossy().ends_with(".style.ron") {
        let mut hair = grow(&path, head)?;
        notes.append(&mut hair.file.notes);
        return Ok(hair);
    }
    let given = hair_io::orient::Given {
        up: axes(values.choice("up")),
        scale: scale(values.number("scale")),
        offset: None,
    };
    let mut hair = hair_io::read_hair(&path, &HairOptions { given, head })?;
    notes.append(&mut hair.notes);
    let mut by_id: Vec<usize> = (0..hair.strands.len()).collect();
    by_id.sort_by_key(|&i| hair.strands.id(i));
    hair.keep(&by_id);
    // Before strands are chosen: how many are kept moves neither the camera nor any size.
    let roots: Vec<Vec3> = hair.strands.roots().collect();
    Ok(Hair {
        held: vec![1; hair.strands.len()],
        file: hair,
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

/// The motion script, if any.
pub(crate) fn motion(preset: &Preset, files: &Files) -> Result<MotionScript, StageError> {
    let own = preset.motion.text("file");
    let Some(path) = chosen(files.motion.as_ref(), own, &files.preset_folder) else {
        return Ok(MotionScript::default());
    };
    let text = std::fs::read_to_string(&path).map_err(|source| StageError::Read {
        path: path.clone(),
        source,
    })?;
    Ok(motion::parse(&path.display().to_string(), &text)?)
}

/// Keeps as many strands as the preset asks for, evenly over the scalp.
pub(crate) fn keep_guides(preset: &Preset, hair: &mut Hair) {
    let guides = preset.hair.integer("guides").unsigned_abs() as usize;
    if guides > 0 {
        let roots: Vec<Vec3> = hair.file.strands.roots().collect();
        hair.keep(&hair_io::guides::spread_evenly(&roots, guides));
    }
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
        ties: grown.ties,
        head,
    })
}

/// Each strand's id and size: its own, the preset's, or from the spacing of the roots.
pub(crate) fn strand_infos(preset: &Preset, hair: &HairFile, head: Head) -> Vec<StrandInfo> {
    let strands = &hair.strands;
    let set = preset.hair.number("size");
    let roots: Vec<Vec3> = strands.roots().collect();
    let needs_spacing = set <= 0.0 && (0..strands.len()).any(|i| strands.size(i).is_none());
    let spacing = if needs_spacing {
        hair_io::guides::spacing(&roots)
    } else {
        Vec::new()
    };
    let size = |i: usize| {
        let from_spacing = || size_from_spacing(spacing[i], strands.strand(i), strands.len(), head);
        let own = strands.size(i).or((set > 0.0).then_some(set));
        own.unwrap_or_else(from_spacing)
    };
    (0..strands.len())
        .map(|i| StrandInfo {
            id: strands.id(i),
            mean: Vec3::ZERO,
            size: size(i),
        })
        .collect()
}

/// A clump's size from how far its root is from its neighbours (0 where it has none), 1/300 of the
/// head's height.
fn size_from_spacing(spacing_m: f32, points: &[Vec3], strands: usize, head: Head) -> f32 {
    // A root on its own stands for its share of the scalp: half a ball of 0.4 head heights.
    let share_m = (std::f32::consts::TAU / strands as f32).sqrt() * 0.4 * head.height_m;
    let spacing_m = if spacing_m > 0.0 { spacing_m } else { share_m };
    let length_m: f32 = points
        .windows(2)
        .map(|pair| pair[0].distance(pair[1]))
        .sum();
    // A clump is longer than wide, and no ball the size of a head.
    let radius_m = (RADIUS_IN_SPACINGS * spacing_m).min(LARGEST_RADIUS * head.height_m);
    let radius_m = if length_m > 0.0 {
        radius_m.min(length_m / 4.0)
    } else {
        radius_m
    };
    radius_m / head.unit_m()
}
