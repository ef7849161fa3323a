//! Lines of meshes as strands: which of them the eye sees, and where strokes are drawn along them (W, rows W3, W5, W7 and W8).
//!
//! Lines hang on nothing but the meshes and the eye, so that frames may be drawn in any order. A strand of theirs has no clump, and no number of
//! its own: what varies along it is fixed to the surface.

mod mesh;
mod strand;

pub(crate) use strand::LineStrand;

use crate::files::StageError;
use crate::head::HeadModel;
use crate::look::LineSet;
use crate::names::Names;
use crate::neck::Neck;
use crate::preset::NamedLines;
use effects::preset::{LayerSpec, PresetError, PresetErrors, suggestion};
use mesh::LineMesh;
use mesh_lines::{MeshError, View};
use render::Head;
use stroke_path::Camera;

/// The lines of a head that a look draws.
pub(crate) struct HeadLines {
    /// One for each angle of creases, as surfaces aren't smooth across a crease.
    meshes: Vec<LineMesh>,
    /// For each list of the look which of the meshes has them.
    mesh_of: Vec<usize>,
    /// For each list of the look what is seen of its lines.
    strands: Vec<Vec<LineStrand>>,
}

impl HeadLines {
    /// None has been looked for yet.
    pub fn new(neck: &Neck, sets: &[LineSet], head: Head) -> Result<Self, StageError> {
        let mut lines = Self {
            meshes: Vec::new(),
            mesh_of: Vec::new(),
            strands: vec![Vec::new(); sets.len()],
        };
        for set in sets {
            let crease = set.crease();
            let known = lines.meshes.iter().position(|mesh| mesh.crease() == crease);
            lines.mesh_of.push(known.unwrap_or(lines.meshes.len()));
            if known.is_none() {
                let mesh = LineMesh::new(neck.rest(), crease, head);
                lines.meshes.push(mesh.map_err(fault)?);
            }
        }
        Ok(lines)
    }

    /// Finds what the camera sees of the lines on the head in its pose: those of each list, in the look's order.
    pub fn find(
        &mut self,
        model: &HeadModel,
        sets: &[LineSet],
        camera: &Camera,
        unit_m: f32,
    ) -> Result<&[Vec<LineStrand>], StageError> {
        let view = View::perspective(camera.eye()).map_err(fault)?;
        let pixel = f64::from(camera.focal_px()).recip();
        for (number, mesh) in self.meshes.iter_mut().enumerate() {
            mesh.pose(model).map_err(fault)?;
            let mesh = &*mesh;
            let seen = mesh.seen(&view, pixel).map_err(fault)?;
            for (index, set) in sets.iter().enumerate() {
                if self.mesh_of[index] == number {
                    let [halo_m, shortest_m] = [set.section.halo, set.section.shortest]
                        .map(|units| f64::from(units * unit_m));
                    let is_meant = |triangle| mesh.is_called(triangle, set.section.meshes());
                    self.strands[index] = seen.strands(set.kinds, &is_meant, halo_m, shortest_m);
                }
            }
        }
        Ok(&self.strands)
    }
}

fn fault(error: MeshError) -> StageError {
    StageError::Lines(error.to_string())
}

/// That the meshes which lines are of are there, and the lines which layers draw. A head that the caller gave in place of the preset's may lack
/// meshes: that is noted.
///
/// # Errors
///
/// Names of which there is none.
pub(crate) fn check(
    lines: &[NamedLines],
    layers: &[LayerSpec],
    head: Option<&HeadModel>,
    wears_ties: bool,
    is_given: bool,
    notes: &mut Vec<String>,
) -> Result<(), StageError> {
    let mut mistakes = Vec::new();
    for named in lines {
        let known = head.map_or(Vec::new(), |head| mesh::names(head, wears_ties));
        let names = named.section.meshes();
        let may_lack = mesh::MAY_LACK;
        let all = || known.iter().copied().chain(may_lack);
        let message = match names.unknown(all) {
            _ if names.is_empty() => "of: it names no mesh".to_owned(),
            None => continue,
            Some(name) => {
                let hint = suggestion(name, known.iter().copied());
                format!("of: there is no mesh `{name:.40}` that has lines{hint}")
            }
        };
        match is_given {
            true => notes.push(format!("lines: {message}")),
            false => mistakes.push(named.mistake(message)),
        }
    }
    for layer in layers.iter().filter(|layer| layer.effect.is_for_lines()) {
        let names = Names(layer.on.as_deref().unwrap_or_default());
        let known = || {
            lines
                .iter()
                .filter_map(|lines| lines.section.name.as_deref())
        };
        let message = match names.unknown(known) {
            _ if names.is_empty() => "on: it names no lines".to_owned(),
            None => continue,
            Some(name) => {
                let hint = suggestion(name, known());
                format!("on: the preset has no lines called `{name:.40}`{hint}")
            }
        };
        let layer_name = layer.name.clone();
        match layer.on_place.clone() {
            Some(place) => mistakes.push(PresetError { place, message }),
            None => {
                let layer = layer_name;
                return Err(StageError::MeshLayer { layer, message });
            }
        }
    }
    Ok(PresetErrors::report(mistakes)?)
}
