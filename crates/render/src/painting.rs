//! Layers whose samples are painted: what is known at joints for that, and the programs that paint.

use crate::frame::{Frame, Object};
use effects::{Input, InputSet, Joints, LayerProgram, SampleInput, SampleSet, Samples, layer_seed};
use std::fmt;
use std::sync::Arc;

/// How samples of some layers get their colours, in place of their strokes' own. By default none does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Painting {
    /// The layers, by rising index.
    pub layers: Vec<PaintedLayer>,
    /// What samples are told of joints: the lists that the layers declare ([`Self::declared_lists`]) are parallel to
    /// [`Drawing::clump`](crate::Drawing::clump), the others empty.
    pub joints: Samples,
}

/// A layer that is painted.
#[derive(Clone)]
pub struct PaintedLayer {
    /// Its index in [`Drawing::layers`](crate::Drawing::layers).
    pub layer: usize,
    /// What paints it.
    pub program: Arc<dyn LayerProgram>,
    /// The layer's seed.
    pub seed: u32,
    /// Of what its program declares of samples that which it makes use of.
    pub(crate) read: SampleSet,
}

impl PartialEq for PaintedLayer {
    fn eq(&self, other: &Self) -> bool {
        let same = Arc::ptr_eq(&self.program, &other.program);
        same && (self.layer, self.seed) == (other.layer, other.seed)
    }
}

impl fmt::Debug for PaintedLayer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut structure = f.debug_struct("PaintedLayer");
        let structure = structure.field("layer", &self.layer);
        structure.field("seed", &self.seed).finish_non_exhaustive()
    }
}

impl PaintedLayer {
    /// One that this program paints.
    #[must_use]
    pub fn new(layer: usize, program: Arc<dyn LayerProgram>, seed: u32) -> Self {
        Self {
            layer,
            read: program.reads(),
            program,
            seed,
        }
    }

    /// What its program declares of samples.
    #[must_use]
    pub fn declares(&self) -> SampleSet {
        self.program.paints().unwrap_or_default()
    }
}

/// What of a sample comes from joints, so that a tube's normal or a place across can be worked out beside it.
fn of_joints(read: SampleSet) -> SampleSet {
    let across = SampleSet::of(&[
        SampleInput::Color,
        SampleInput::Tube,
        SampleInput::V,
        SampleInput::W,
    ]);
    let lists = read.without(across);
    if read.has(SampleInput::Tube) {
        return lists.union(SampleSet::of(&[
            SampleInput::Forward,
            SampleInput::ViewDirection,
        ]));
    }
    lists
}

/// What is read of joints so that samples can be told of them.
fn joint_inputs(lists: SampleSet) -> InputSet {
    let of = |input| match input {
        SampleInput::Position => Some(Input::Position),
        SampleInput::Forward => Some(Input::Forward),
        SampleInput::Normal => Some(Input::Normal),
        SampleInput::U => Some(Input::U),
        SampleInput::S => Some(Input::ArcLength),
        SampleInput::Strand => Some(Input::Strand),
        SampleInput::Seed => Some(Input::Seed),
        SampleInput::Depth => Some(Input::Depth),
        SampleInput::LightDirection => Some(Input::LightDirection),
        SampleInput::LightDistance => Some(Input::LightDistance),
        SampleInput::ViewDirection => Some(Input::ViewDirection),
        SampleInput::Time => Some(Input::Time),
        // Of the frame, or of the sample itself.
        SampleInput::Level
        | SampleInput::ShadeColor
        | SampleInput::Occlusion
        | SampleInput::HeadDepth
        | SampleInput::Pixels
        | SampleInput::Color
        | SampleInput::Tube
        | SampleInput::V
        | SampleInput::W => None,
    };
    let inputs: Vec<Input> = lists.iter().filter_map(of).collect();
    InputSet::of(&inputs)
}

/// What an object's layers that paint read of joints.
pub(crate) fn inputs(object: &Object) -> InputSet {
    let reads = object
        .layers
        .iter()
        .filter_map(|layer| layer.program.paints());
    joint_inputs(of_joints(
        reads.fold(SampleSet::default(), SampleSet::union),
    ))
}

impl Painting {
    /// Whether a layer is painted.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.layers.is_empty()
    }

    /// The lists that the layers declare.
    #[must_use]
    pub fn declared_lists(&self) -> SampleSet {
        let declared = self.layers.iter().map(PaintedLayer::declares);
        of_joints(declared.fold(SampleSet::default(), SampleSet::union))
    }

    /// Those of them that painting makes use of.
    pub(crate) fn read_lists(&self) -> SampleSet {
        let read = self.layers.iter().map(|layer| layer.read);
        of_joints(read.fold(SampleSet::default(), SampleSet::union))
    }

    /// Takes on what a checked frame says, in place of what was there. `known` has the lists that [`inputs`] names.
    pub(crate) fn fill(&mut self, frame: &Frame, known: &Joints) {
        self.layers.clear();
        self.joints.clear();
        let mut index = 0;
        for object in &frame.objects {
            for layer in object.layers {
                if layer.program.paints().is_some() {
                    let seed = layer_seed(object.seed, &layer.name);
                    let painted = PaintedLayer::new(index, layer.program.clone(), seed);
                    self.layers.push(painted);
                }
                index += 1;
            }
        }
        for input in self.declared_lists().iter() {
            self.fill_list(frame, known, input);
        }
    }

    fn fill_list(&mut self, frame: &Frame, known: &Joints, input: SampleInput) {
        let lists = &mut self.joints;
        let paths = frame.paths;
        match input {
            SampleInput::Position => lists.position.clone_from(&known.position),
            SampleInput::Forward => lists.forward.clone_from(&known.forward),
            SampleInput::Normal => lists.normal.clone_from(&known.normal),
            SampleInput::U => lists.u.clone_from(&known.u),
            SampleInput::Strand => lists.strand.clone_from(&known.strand),
            SampleInput::Seed => lists.seed.clone_from(&known.seed),
            SampleInput::Depth => lists.depth.clone_from(&known.depth),
            SampleInput::LightDirection => {
                lists.light_direction.clone_from(&known.light_direction);
            }
            SampleInput::LightDistance => lists.light_distance.clone_from(&known.light_distance),
            SampleInput::ViewDirection => lists.view_direction.clone_from(&known.view_direction),
            SampleInput::Time => lists.time.clone_from(&known.time),
            SampleInput::Level => {
                let runs = paths.runs.iter();
                let levels = runs.flat_map(|run| {
                    let level = frame.strands[run.strand].level;
                    run.joints.clone().map(move |_| level)
                });
                lists.level.extend(levels);
            }
            SampleInput::S => {
                for Object { head, joints, .. } in &frame.objects {
                    let lengths = paths.arc_length[joints.clone()].iter();
                    lists.s.extend(lengths.map(|length| length / head.height_m));
                }
            }
            SampleInput::Pixels => {
                for Object { head, joints, .. } in &frame.objects {
                    let scales = paths.px_per_metre[joints.clone()].iter();
                    let pixels = scales.map(|scale| scale * head.height_m);
                    lists.pixels.extend(pixels);
                }
            }
            SampleInput::HeadDepth => {
                for Object { head, joints, .. } in &frame.objects {
                    let depth = frame.camera.view_from_world(head.center).z / head.height_m;
                    lists.head_depth.resize(joints.end, depth);
                }
            }
            // Of the sample itself.
            SampleInput::Color | SampleInput::Tube | SampleInput::V | SampleInput::W => {}
            // Of meshes.
            SampleInput::ShadeColor | SampleInput::Occlusion => {}
        }
    }

    /// The lists that the layers need, with their lengths.
    pub(crate) fn needed_lists(&self) -> Vec<(&'static str, usize)> {
        let lists = self.declared_lists().iter();
        lists
            .map(|input| (input.name(), self.joints.count(input)))
            .collect()
    }
}
