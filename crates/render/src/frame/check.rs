//! What a frame must be before strokes are made of it.

use super::{Frame, Light, Object};
use crate::check::{DrawError, check_picture, check_surfaces};
use effects::{Input, Layer};
use std::ops::Range;

/// Why a frame can't be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameError {
    /// What a drawing must be too.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// A list of the paths has another length than the others.
    #[error("the paths have {joints} joints, but {length} in the list `{list}`")]
    Paths {
        /// Which list.
        list: &'static str,
        /// Its length.
        length: usize,
        /// How many joints there are.
        joints: usize,
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
    #[error("strand {strand}: its mean must be finite, and its size ({size}) finite and 0 or more")]
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
        check_surfaces(&self.surfaces)?;
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
            let is_last = index + 1 == self.objects.len();
            self.check_object(index, object, before, is_last)?;
            before = object.joints.end;
        }
        // A clump reads them where its parameters say so, and they alone know.
        let reads = |layer: &Layer| layer.program.inputs().has(Input::MaterialNormal);
        let mut layers = self.objects.iter().flat_map(|object| object.layers);
        let reads_normals = layers.any(reads);
        let (normals, joints) = (self.material_normals.len(), self.paths.len());
        if normals != joints && (normals > 0 || reads_normals) {
            return Err(FrameError::MaterialNormals { normals, joints });
        }
        Ok(())
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
        let (mut before, mut length_before) = (0, 0);
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
            (before, length_before) = (end, length);
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
            if !is_size || !strand.mean.is_finite() {
                return Err(FrameError::StrandNumbers {
                    strand: index,
                    size: strand.size,
                });
            }
        }
        Ok(())
    }

    fn check_object(
        &self,
        index: usize,
        object: &Object,
        before: usize,
        is_last: bool,
    ) -> Result<(), FrameError> {
        let Range { start, end } = object.joints;
        let joints = self.paths.len();
        let is_in_turn = start == before && start <= end && (!is_last || end == joints);
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
        Ok(())
    }

    /// Whether no run has joints in a range and others outside of it. Runs are in order, one after the other.
    fn is_whole(&self, joints: &Range<usize>) -> bool {
        let is_between = |joint: usize| {
            let runs = &self.paths.runs;
            let at = runs.partition_point(|run| run.joints.end <= joint);
            runs.get(at).is_none_or(|run| run.joints.start >= joint)
        };
        is_between(joints.start) && is_between(joints.end)
    }
}
