//! What frames have of the paths that effects make of hair: strands after those of the hair, each of one of them.

use super::{ObjectFrame, push_beside};
use crate::files::StageError;
use crate::hair::HairModel;
use crate::motion::ObjectMotion;
use crate::reach::Sight;
use effects::wgsl::hash;
use effects::{HairStrand, Layer, MadePath, MadePaths, layer_seed};
use glam::Vec3;
use rayon::prelude::*;
use render::{Light, StrandInfo};
use stroke_path::{Coarseness, Detail, PathKind, Paths};

/// The paths that an object's layers make.
#[derive(Default)]
pub(super) struct ObjectPaths {
    /// Of each layer that makes paths; where they have not been drawn yet there are none.
    layers: Vec<LayerPaths>,
    /// The strand of its hair that each path of the last frame belongs to.
    strands: Vec<usize>,
}

/// What is kept of a layer that makes paths.
struct LayerPaths {
    /// Those of the last frame.
    paths: MadePaths,
    /// Those that it makes of the hair at rest.
    at_rest: Vec<MadeAtRest>,
}

/// A path that a layer makes of the hair at rest.
struct MadeAtRest {
    /// Its strand, its number there, and how many points it has.
    name: (usize, u32, usize),
    detail: Detail,
}

impl ObjectPaths {
    /// Drops what was kept of another object.
    pub fn forget(&mut self) {
        self.layers.clear();
    }

    /// The strand of the object's hair that each path of the last frame belongs to.
    pub fn strands(&self) -> &[usize] {
        &self.strands
    }
}

impl ObjectFrame {
    /// Appends the paths that layers make in this light, and notes which joints each layer draws on; `parts` is working memory, and `weights` are those of all joints.
    pub(super) fn push_made_paths(
        &mut self,
        motion: &ObjectMotion,
        sight: &Sight,
        light: Light,
        strands: &mut Vec<StrandInfo>,
        (parts, paths): (&mut Vec<Paths>, &mut Paths),
        mut weights: Option<&mut Vec<f32>>,
    ) -> Result<(), StageError> {
        let (hair, look) = (self.of.hair(), self.of.look());
        self.layer_joints.clear();
        self.made.strands.clear();
        if self.unseen > 0 {
            let none = paths.len()..paths.len();
            self.layer_joints.resize(look.layers.len(), none);
            return Ok(());
        }
        let points = motion.points(&self.of);
        let of_hair = self.joints.clone();
        let first_above = self.strands.start + hair.undercoat;
        let runs = &paths.runs[paths
            .runs
            .partition_point(|run| run.joints.end <= of_hair.start)..];
        let of_undercoat = runs.iter().take_while(|run| run.strand < first_above);
        let above_undercoat = of_undercoat
            .last()
            .map_or(of_hair.start, |run| run.joints.end);
        let head = motion.head(&self.of);
        let mut making = 0;
        for (layer_number, layer) in look.layers.iter().enumerate() {
            if !layer.program.has_own_paths() {
                let start = match layer.program.is_on_undercoat() {
                    true => of_hair.start,
                    false => above_undercoat,
                };
                self.layer_joints.push(start..of_hair.end);
                continue;
            }
            let above = strands_above(hair, points, (&self.left_out_by, layer_number));
            let seed = layer_seed(look.seed, &layer.name);
            if self.made.layers.len() == making {
                let drawn_by = (&self.left_out_by[..], layer_number);
                let at_rest = LayerPaths::at_rest(hair, (layer, drawn_by), seed, look.path())?;
                self.made.layers.push(at_rest);
            }
            let LayerPaths {
                paths: made,
                at_rest,
            } = &mut self.made.layers[making];
            making += 1;
            let of_effects = effects::Hair {
                strands: &above,
                head_center: head.center,
                head_center_at_rest: hair.head.center,
                head_height_m: head.height_m,
                light: self.of.placement().own_light(light),
                eye: sight.camera().eye(),
            };
            made.clear();
            layer.program.make_paths(&of_effects, seed, made);
            let fault = |what: String| StageError::MadePaths {
                layer: layer.name.clone(),
                what,
            };
            if let Some(what) = made.fault() {
                return Err(fault(what.to_owned()));
            }
            let all: Vec<MadePath> = made.iter().collect();
            let first = strands.len();
            for made in &all {
                let (strand, number) = (made.strand, made.number);
                if strand >= above.len() {
                    let what = format!("a path of strand {strand}, and there are {}", above.len());
                    return Err(fault(what));
                }
                let parent = strands[first_above + strand];
                self.made.strands.push(hair.undercoat + strand);
                strands.push(StrandInfo {
                    id: made_id(parent.id, number),
                    // As large as it is where nothing is merged: the hair that came loose of it isn't.
                    size: hair.infos[hair.undercoat + strand].size,
                    ..parent
                });
            }
            let push = |part: &mut Paths, i: usize| {
                let (made, info) = (&all[i], &strands[first + i]);
                if !sight.may_see(made.points, info.size) || info.is_left_out_by(layer_number) {
                    return Ok(());
                }
                let name = (made.strand, made.number, made.points.len());
                let detail = at_rest.get(i).filter(|path| path.name == name);
                let detail = detail.map(|path| &path.detail);
                let (index, kind) = (first + i, look.path());
                part.push_pieces(index, made.points, &[], detail, kind, sight.camera())
            };
            let (start, first_run) = (paths.len(), paths.runs.len());
            push_beside(parts, all.len(), look.paints(), paths, push)?;
            if let Some(weights) = &mut weights {
                weights.resize(start, 1.0);
                for run in &paths.runs[first_run..] {
                    let made = &all[run.strand - first];
                    let along = paths.u[run.joints.clone()].iter();
                    weights.extend(along.map(|u| made.weight(*u)));
                }
            }
            self.layer_joints.push(start..paths.len());
        }
        self.joints.end = paths.len();
        Ok(())
    }
}

/// The layers that leave each strand of a hair out, or none where none does, and the number of the one that draws.
type DrawnBy<'a> = (&'a [u32], usize);

/// The strands that a layer makes paths of: those above the undercoat.
fn strands_above<'a>(
    hair: &'a HairModel,
    points: &'a [Vec3],
    (left_out_by, layer): DrawnBy,
) -> Vec<HairStrand<'a>> {
    let of_strand = |(i, info): (usize, &StrandInfo)| HairStrand {
        id: info.id,
        particles: &points[hair.file.strands.point_range(i)],
        at_rest: hair.file.strands.strand(i),
        size: info.size,
        is_drawn: !StrandInfo {
            left_out_by: left_out_by.get(i).copied().unwrap_or(0),
            ..*info
        }
        .is_left_out_by(layer),
    };
    let above = hair.infos.iter().enumerate().skip(hair.undercoat);
    above.map(of_strand).collect()
}

impl LayerPaths {
    /// Those that a layer makes of hair at rest: as a path keeps its name, they tell which of its joints a picture needs.
    fn at_rest(
        hair: &HairModel,
        (layer, drawn_by): (&Layer, DrawnBy),
        seed: u32,
        path: PathKind,
    ) -> Result<Self, StageError> {
        let of_effects = effects::Hair {
            strands: &strands_above(hair, hair.file.strands.points(), drawn_by),
            head_center: hair.head.center,
            head_center_at_rest: hair.head.center,
            head_height_m: hair.head.height_m,
            light: Light::Direction(Vec3::Z),
            eye: hair.head.center + 10.0 * hair.head.height_m * Vec3::Z,
        };
        let mut paths = MadePaths::default();
        layer.program.make_paths(&of_effects, seed, &mut paths);
        let with_detail = |made: MadePath| {
            Ok(MadeAtRest {
                name: (made.strand, made.number, made.points.len()),
                detail: Detail::of(made.points, path, &[], Coarseness::FINE)?,
            })
        };
        let made: Vec<MadePath> = paths.iter().collect();
        let at_rest: Result<_, StageError> = made.into_par_iter().map(with_detail).collect();
        Ok(Self {
            at_rest: at_rest?,
            paths,
        })
    }
}

/// The number that the variations of path `number` of strand `id` hang on.
fn made_id(id: u32, number: u32) -> u32 {
    hash(id ^ hash(number + 1))
}
