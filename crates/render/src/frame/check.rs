//! What a frame must be before strokes are made of it.

use super::{Frame, Light, Object};
use crate::check::{DrawError, check_picture, check_surfaces};
use crate::drawing::Decal;
use crate::mesh_paint::MeshLayer;
use effects::{Input, Layer, clump};
use std::ops::Range;
use stroke_path::PathRun;

/// Why a frame can't be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameError {
    /// What a drawing must be too.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// A list of the paths has another length than the others, or its runs have.
    #[error("the paths have {joints} joints, but {length} in the list `{list}`")]
    Paths {
        /// Which list.
        list: &'static str,
        /// Its length.
        length: usize,
        /// How many joints there are.
        joints: usize,
    },
    /// Runs are in the order of their pieces.
    #[error(
        "run {run} is of piece {piece}, and the run before is of piece {before}: pieces must not decrease"
    )]
    Piece {
        /// Index of the run.
        run: usize,
        /// Its piece.
        piece: usize,
        /// That of the run before.
        before: usize,
    },
    /// Two layers make paths on the same joints.
    #[error(
        "object {object}: the layers \"{layer}\" and \"{other}\" have the same joints for paths of their own"
    )]
    OwnPaths {
        /// Index of the object.
        object: usize,
        /// The later layer's name.
        layer: String,
        /// The earlier one's.
        other: String,
    },
    /// A run's joints don't follow those of the run before, are none, or share more than there are.
    #[error(
        "run {run}: its joints are {start}..{end}, after {before} joints of {joints}; {overlap} are shared"
    )]
    Run {
        /// Index of the run.
        run: usize,
        /// Its first joint.
        start: usize,
        /// One beyond its last.
        end: usize,
        /// One beyond the last of the run before.
        before: usize,
        /// How many joints the paths have.
        joints: usize,
        /// How many it shares with the run before.
        overlap: usize,
    },
    /// A run is of a strand that the frame knows nothing of.
    #[error("run {run} is of strand {strand}, and the frame has {strands}")]
    Strand {
        /// Index of the run.
        run: usize,
        /// Its strand.
        strand: usize,
        /// How many there are.
        strands: usize,
    },
    /// A strand's numbers make no stroke.
    #[error(
        "strand {strand}: its mean, taper, colours and lift must be finite, and its size ({size}) finite and 0 or more"
    )]
    StrandNumbers {
        /// Index of the strand.
        strand: usize,
        /// Its size, 1/300 of the head's height.
        size: f32,
    },
    /// The objects' joints don't follow each other, or split a run.
    #[error(
        "object {object}: its joints are {start}..{end}, which must be whole runs from {before} on, up to {joints} in the last object"
    )]
    ObjectJoints {
        /// Index of the object.
        object: usize,
        /// Its first joint.
        start: usize,
        /// One beyond its last.
        end: usize,
        /// One beyond the last of the object before.
        before: usize,
        /// How many joints the paths have.
        joints: usize,
    },
    /// A head is nowhere, or without height.
    #[error(
        "object {object}: its head's centre must be finite, and its height ({height_m} m) finite and above 0"
    )]
    Head {
        /// Index of the object.
        object: usize,
        /// Its head's height.
        height_m: f32,
    },
    /// There must be joints for each layer.
    #[error("object {object} has {layers} layers, and joints for {ranges}")]
    Layers {
        /// Index of the object.
        object: usize,
        /// How many layers it has.
        layers: usize,
        /// How many ranges of joints.
        ranges: usize,
    },
    /// A layer draws on joints of others, or on a part of a run.
    #[error(
        "object {object}, layer \"{layer}\": it draws on the joints {start}..{end}, which are no whole runs of the object's"
    )]
    LayerJoints {
        /// Index of the object.
        object: usize,
        /// The layer's name.
        layer: String,
        /// The first joint that it draws on.
        start: usize,
        /// One beyond the last.
        end: usize,
    },
    /// Material normals are read, and there is not one for each joint.
    #[error(
        "there are {normals} material normals for {joints} joints: one is needed for each, or none where nothing reads them"
    )]
    MaterialNormals {
        /// How many there are.
        normals: usize,
        /// How many joints the paths have.
        joints: usize,
    },
    /// The list is shorter or longer than the paths.
    #[error(
        "there are {positions} positions at rest for {joints} joints: one is needed for each, or none where nothing reads them"
    )]
    RestPositions {
        /// How many there are.
        positions: usize,
        /// How many joints the paths have.
        joints: usize,
    },
    /// The list is shorter or longer than the paths.
    #[error(
        "there are {forwards} directions at rest for {joints} joints: one is needed for each, or none where nothing reads them"
    )]
    RestForwards {
        /// How many there are.
        forwards: usize,
        /// How many joints the paths have.
        joints: usize,
    },
    /// The list is shorter or longer than the paths.
    #[error(
        "there are {ends} distances from ends for {joints} joints: one pair is needed for each, or none where nothing reads them"
    )]
    FromEnds {
        /// How many there are.
        ends: usize,
        /// How many joints the paths have.
        joints: usize,
    },
    /// The list is shorter or longer than the paths.
    #[error(
        "there are {weights} weights of paths for {joints} joints: one is needed for each, or none where nothing reads them"
    )]
    PathWeights {
        /// How many there are.
        weights: usize,
        /// How many joints the paths have.
        joints: usize,
    },
    /// The list is shorter or longer than the paths, or has a number that isn't finite.
    #[error(
        "there are {marks} places along marks for {joints} joints: one finite number is needed for each, or none at all"
    )]
    Marks {
        /// How many there are.
        marks: usize,
        /// How many joints the paths have.
        joints: usize,
    },
    /// What its strands count nearer by is no length.
    #[error("object {object}: surface_bias_m is {bias_m}, no number of metres from 0 on")]
    SurfaceBias {
        /// Index of the object.
        object: usize,
        /// What it is.
        bias_m: f32,
    },
    /// A layer for meshes doesn't paint, its head is nowhere or without height, or it is seen through hair by no share from 0 to 1.
    #[error(
        "mesh layer {index}, \"{layer}\": its effect must paint, its head be somewhere and have a height, and through_hair lie in 0 to 1"
    )]
    MeshLayer {
        /// Its place among the frame's.
        index: usize,
        /// Its name.
        layer: String,
    },
    /// What a frame says of decals is not of the layers that are some, one after the other, or a reach is no length, or a decal paints.
    #[error(
        "layer \"{layer}\": a layer with `clip`, and no other, has one decal in the frame, in the layers' order, its reach is finite and 0 or more, and its effect doesn't paint"
    )]
    Decal {
        /// The name of the first layer that is wrong; empty where there are decals of no layer.
        layer: String,
    },
    /// The light is nowhere.
    #[error("the light's numbers are not finite")]
    Light,
    /// It is no time.
    #[error("the time of {0} s is not finite")]
    Time(f32),
}

impl Frame<'_> {
    /// Looks at everything but the numbers of single joints, so that a frame that a program made itself is drawn as it is meant or
    /// not at all. Backends do it before they draw.
    ///
    /// # Errors
    ///
    /// The first thing that is wrong.
    pub fn check(&self) -> Result<(), FrameError> {
        check_picture(self.camera.size_px(), self.background, self.edge_depth_m)?;
        check_surfaces(&self.surfaces, self.mesh_layers.len())?;
        self.check_mesh_layers()?;
        self.check_decals()?;
        let (Light::Direction(light) | Light::Point(light)) = self.light;
        if !light.is_finite() {
            return Err(FrameError::Light);
        }
        if !self.time_s.is_finite() {
            return Err(FrameError::Time(self.time_s));
        }
        self.check_paths()?;
        self.check_strands()?;
        let mut before = 0;
        for (index, object) in self.objects.iter().enumerate() {
            self.check_object(index, object, before)?;
            before = object.joints.end;
        }
        let (normals, joints) = (self.material_normals.len(), self.paths.len());
        if before != joints {
            return Err(FrameError::ObjectJoints {
                object: self.objects.len(),
                start: before,
                end: before,
                before,
                joints,
            });
        }
        let reads_normals = self.objects.iter().any(Object::reads_material_normals);
        if normals != joints && (normals > 0 || reads_normals) {
            return Err(FrameError::MaterialNormals { normals, joints });
        }
        let positions = self.rest_positions.len();
        let reads_rest = |object: &Object| object.inputs().has(Input::RestPosition);
        if positions != joints && (positions > 0 || self.objects.iter().any(reads_rest)) {
            return Err(FrameError::RestPositions { positions, joints });
        }
        let forwards = self.rest_forwards.len();
        let reads_forward = |object: &Object| object.inputs().has(Input::RestForward);
        if forwards != joints && (forwards > 0 || self.objects.iter().any(reads_forward)) {
            return Err(FrameError::RestForwards { forwards, joints });
        }
        let ends = self.from_ends.len();
        let reads_ends = |object: &Object| object.inputs().has(Input::FromEnds);
        if ends != joints && (ends > 0 || self.objects.iter().any(reads_ends)) {
            return Err(FrameError::FromEnds { ends, joints });
        }
        let weights = self.path_weights.len();
        let reads_weights = |object: &Object| object.inputs().has(Input::PathWeight);
        if weights != joints && (weights > 0 || self.objects.iter().any(reads_weights)) {
            return Err(FrameError::PathWeights { weights, joints });
        }
        let marks = self.marks.len();
        if marks != 0 && marks != joints || !self.marks.iter().all(|mark| mark.is_finite()) {
            return Err(FrameError::Marks { marks, joints });
        }
        Ok(())
    }

    fn check_mesh_layers(&self) -> Result<(), FrameError> {
        for (index, MeshLayer { layer, head, .. }) in self.mesh_layers.iter().enumerate() {
            let is_head = head.height_m > 0.0 && head.height_m.is_finite();
            let is_share = (0.0..=1.0).contains(&layer.through_hair);
            if layer.program.paints().is_none() || !is_head || !head.center.is_finite() || !is_share
            {
                return Err(FrameError::MeshLayer {
                    index,
                    layer: layer.name.clone(),
                });
            }
        }
        Ok(())
    }

    fn check_decals(&self) -> Result<(), FrameError> {
        let layers = self.objects.iter().flat_map(|object| object.layers);
        let mut decals = self.decals.iter();
        for (index, layer) in layers.enumerate().filter(|(_, layer)| layer.is_decal()) {
            let is_right = |decal: &&Decal| {
                let is_shadow = decal.is_shadow == layer.program.casts();
                let is_length = (0.0..=f32::MAX).contains(&decal.reach_m);
                decal.layer == index && is_shadow && is_length && layer.program.paints().is_none()
            };
            if decals.next().filter(is_right).is_none() {
                let layer = layer.name.clone();
                return Err(FrameError::Decal { layer });
            }
        }
        match decals.next() {
            None => Ok(()),
            Some(_) => Err(FrameError::Decal {
                layer: String::new(),
            }),
        }
    }

    fn check_paths(&self) -> Result<(), FrameError> {
        let paths = self.paths;
        let joints = paths.len();
        let lists = [
            ("u", paths.u.len()),
            ("arc_length", paths.arc_length.len()),
            ("forward", paths.forward.len()),
            ("backward", paths.backward.len()),
            ("center", paths.center.len()),
            ("depth", paths.depth.len()),
            ("px_per_metre", paths.px_per_metre.len()),
            ("across", paths.across.len()),
        ];
        if let Some((list, length)) = lists.into_iter().find(|(_, length)| *length != joints) {
            return Err(FrameError::Paths {
                list,
                length,
                joints,
            });
        }
        let (mut before, mut length_before, mut piece_before) = (0, 0, 0);
        for (index, run) in paths.runs.iter().enumerate() {
            let Range { start, end } = run.joints;
            let length = end.saturating_sub(start);
            let has_overlap = run.overlap <= length.min(length_before);
            if start != before || length == 0 || end > joints || !has_overlap {
                return Err(FrameError::Run {
                    run: index,
                    start,
                    end,
                    before,
                    joints,
                    overlap: run.overlap,
                });
            }
            if run.piece < piece_before {
                return Err(FrameError::Piece {
                    run: index,
                    piece: run.piece,
                    before: piece_before,
                });
            }
            (before, length_before, piece_before) = (end, length, run.piece);
        }
        if before != joints {
            return Err(FrameError::Paths {
                list: "runs",
                length: before,
                joints,
            });
        }
        Ok(())
    }

    fn check_strands(&self) -> Result<(), FrameError> {
        let strands = self.strands.len();
        for (index, run) in self.paths.runs.iter().enumerate() {
            if run.strand >= strands {
                return Err(FrameError::Strand {
                    run: index,
                    strand: run.strand,
                    strands,
                });
            }
        }
        for (index, strand) in self.strands.iter().enumerate() {
            let is_size = (0.0..=f32::MAX).contains(&strand.size);
            let is_placed = strand.mean.is_finite() && strand.lift.is_finite();
            let is_colored = strand.colors.iter().all(|color| color.is_finite());
            if !is_size || !is_placed || !is_colored || !strand.taper.is_finite() {
                return Err(FrameError::StrandNumbers {
                    strand: index,
                    size: strand.size,
                });
            }
        }
        Ok(())
    }

    fn check_object(&self, index: usize, object: &Object, before: usize) -> Result<(), FrameError> {
        let Range { start, end } = object.joints;
        let joints = self.paths.len();
        let is_in_turn = start == before && start <= end;
        if !is_in_turn || !self.is_whole(&object.joints) {
            return Err(FrameError::ObjectJoints {
                object: index,
                start,
                end,
                before,
                joints,
            });
        }
        let head = object.head;
        let is_height = head.height_m > 0.0 && head.height_m.is_finite();
        if !is_height || !head.center.is_finite() {
            return Err(FrameError::Head {
                object: index,
                height_m: head.height_m,
            });
        }
        let bias_m = object.surface_bias_m;
        if !(bias_m.is_finite() && bias_m >= 0.0) {
            let object = index;
            return Err(FrameError::SurfaceBias { object, bias_m });
        }
        if object.layers.len() != object.layer_joints.len() {
            return Err(FrameError::Layers {
                object: index,
                layers: object.layers.len(),
                ranges: object.layer_joints.len(),
            });
        }
        for (layer, drawn) in object.layers.iter().zip(object.layer_joints) {
            let is_of_object = start <= drawn.start && drawn.start <= drawn.end && drawn.end <= end;
            if !is_of_object || !self.is_whole(drawn) {
                return Err(FrameError::LayerJoints {
                    object: index,
                    layer: layer.name.clone(),
                    start: drawn.start,
                    end: drawn.end,
                });
            }
        }
        self.check_own_paths(index, object)
    }

    fn check_own_paths(&self, index: usize, object: &Object) -> Result<(), FrameError> {
        let layers = object.layers.iter().zip(object.layer_joints);
        let own: Vec<_> = layers
            .filter(|(layer, _)| layer.program.has_own_paths())
            .collect();
        for (i, (layer, joints)) in own.iter().enumerate() {
            let shares = |(_, others): &&(&Layer, &Range<usize>)| {
                joints.start.max(others.start) < joints.end.min(others.end)
            };
            if let Some((other, _)) = own[..i].iter().find(shares) {
                return Err(FrameError::OwnPaths {
                    object: index,
                    layer: layer.name.clone(),
                    other: other.name.clone(),
                });
            }
        }
        Ok(())
    }

    /// Whether no strand has joints in a range and others outside of it. Runs are in order, one after the other.
    fn is_whole(&self, joints: &Range<usize>) -> bool {
        let is_between = |joint: usize| {
            let runs = &self.paths.runs;
            let at = runs.partition_point(|run| run.joints.end <= joint);
            let begins = |run: &PathRun| run.joints.start >= joint && run.overlap == 0;
            runs.get(at).is_none_or(begins)
        };
        is_between(joints.start) && is_between(joints.end)
    }
}

impl Object<'_> {
    fn reads_material_normals(&self) -> bool {
        let reads = |layer: &Layer| layer.program.inputs().has(Input::MaterialNormal);
        self.clump.base().normal == clump::Params::NORMAL_MATERIAL || self.layers.iter().any(reads)
    }
}
