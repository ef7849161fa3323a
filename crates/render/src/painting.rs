//! Layers whose samples are painted: what is known at joints for that, and the programs that paint.

use crate::frame::{Frame, Object};
use effects::wgsl::vec3;
use effects::{Input, InputSet, Joints, LayerProgram, SampleInput, SampleSet, Samples, layer_seed};
use glam::Vec3;
use std::fmt;
use std::sync::Arc;

/// How samples of some layers get their colours, in place of their strokes' own. By default none does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Painting {
    /// The layers, by rising index.
    pub layers: Vec<PaintedLayer>,
    /// What samples are told of joints: the lists that the layers declare ([`Self::of_joints`]) are parallel to
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
    /// What its program reads of samples.
    #[must_use]
    pub fn reads(&self) -> SampleSet {
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

    /// The lists that the layers need.
    #[must_use]
    pub fn of_joints(&self) -> SampleSet {
        let reads = self.layers.iter().map(PaintedLayer::reads);
        of_joints(reads.fold(SampleSet::default(), SampleSet::union))
    }

    /// Takes on what a checked frame says, in place of what was there. `known` has the lists that [`inputs`] names.
    pub(crate) fn fill(&mut self, frame: &Frame, known: &Joints) {
        self.layers.clear();
        self.joints.clear();
        let mut index = 0;
        for object in &frame.objects {
            for layer in object.layers {
                if layer.program.paints().is_some() {
                    self.layers.push(PaintedLayer {
                        layer: index,
                        program: layer.program.clone(),
                        seed: layer_seed(object.seed, &layer.name),
                    });
                }
                index += 1;
            }
        }
        for input in self.of_joints().iter() {
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
        }
    }

    /// The lists that the layers need, with their lengths.
    pub(crate) fn needed_lists(&self) -> Vec<(&'static str, usize)> {
        let lists = self.of_joints().iter();
        lists
            .map(|input| (input.name(), self.joints.count(input)))
            .collect()
    }
}

/// A point between two joints, and where a sample lies beside it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beside {
    pub(crate) joint: usize,
    pub(crate) next: usize,
    /// The way from the first to the second.
    pub(crate) way: f32,
    /// Places across the stroke and across the clump.
    pub(crate) v: f32,
    pub(crate) w: f32,
    pub(crate) color: [f32; 3],
}

/// The samples beside these points, as a program that reads `read` has them.
pub(crate) fn gather(joints: &Samples, points: &[Beside], read: SampleSet, samples: &mut Samples) {
    let number = |list: &[f32], p: &Beside| list[p.joint] + p.way * (list[p.next] - list[p.joint]);
    let mixed = |list: &[effects::wgsl::Vec3<f32>], p: &Beside| {
        let [a, b] = [p.joint, p.next].map(|i| Vec3::from(list[i].to_array()));
        a.lerp(b, p.way)
    };
    let unit = |list: &[effects::wgsl::Vec3<f32>], p: &Beside| {
        let first = Vec3::from(list[p.joint].to_array());
        vec3(mixed(list, p).normalize_or(first).to_array())
    };
    samples.clear();
    for input in read.iter() {
        let points = points.iter();
        match input {
            SampleInput::Color => samples.color.extend(points.map(|p| vec3(p.color))),
            SampleInput::Position => {
                let places = points.map(|p| vec3(mixed(&joints.position, p).to_array()));
                samples.position.extend(places);
            }
            SampleInput::Forward => {
                samples
                    .forward
                    .extend(points.map(|p| unit(&joints.forward, p)));
            }
            SampleInput::Normal => samples
                .normal
                .extend(points.map(|p| unit(&joints.normal, p))),
            SampleInput::Tube => samples.tube.extend(points.map(|p| {
                let to_eye = mixed(&joints.view_direction, p);
                let tube = crate::features::tube_normal(mixed(&joints.forward, p), to_eye, p.w);
                vec3(tube.unwrap_or(to_eye.normalize_or(Vec3::Z)).to_array())
            })),
            SampleInput::U => samples.u.extend(points.map(|p| number(&joints.u, p))),
            SampleInput::S => samples.s.extend(points.map(|p| number(&joints.s, p))),
            SampleInput::V => samples.v.extend(points.map(|p| p.v)),
            SampleInput::W => samples.w.extend(points.map(|p| p.w)),
            SampleInput::Strand => samples
                .strand
                .extend(points.map(|p| joints.strand[p.joint])),
            SampleInput::Seed => samples.seed.extend(points.map(|p| joints.seed[p.joint])),
            SampleInput::Level => samples.level.extend(points.map(|p| joints.level[p.joint])),
            SampleInput::Depth => samples
                .depth
                .extend(points.map(|p| number(&joints.depth, p))),
            SampleInput::HeadDepth => {
                let depths = points.map(|p| number(&joints.head_depth, p));
                samples.head_depth.extend(depths);
            }
            SampleInput::LightDirection => {
                let directions = points.map(|p| unit(&joints.light_direction, p));
                samples.light_direction.extend(directions);
            }
            SampleInput::LightDistance => {
                let distances = points.map(|p| number(&joints.light_distance, p));
                samples.light_distance.extend(distances);
            }
            SampleInput::ViewDirection => {
                let directions = points.map(|p| unit(&joints.view_direction, p));
                samples.view_direction.extend(directions);
            }
            SampleInput::Pixels => samples
                .pixels
                .extend(points.map(|p| number(&joints.pixels, p))),
            SampleInput::Time => samples.time.extend(points.map(|p| joints.time[p.joint])),
        }
    }
}
