//! Colours of samples by effects that paint: once it is decided what the samples of a tile show, those of a layer get their colours
//! together.

use super::segment::Segment;
use super::shown::{NOTHING, Planes, TRIANGLE};
use super::tile::Target;
use crate::check::DrawError;
use crate::drawing::Drawing;
use crate::features::{tangent, tube_normal};
use crate::frame::{FAR_LIGHT, Frame, Object};
use effects::wgsl::{Vec3 as WgslVec3, hash, vec3};
use effects::{LayerProgram, SampleInput, SampleSet, Samples, layer_seed};
use glam::Vec3;

/// The layers of a drawing that paint, and the frame that it was made of.
pub(super) struct Painting<'a> {
    frame: &'a Frame<'a>,
    drawing: &'a Drawing,
    /// For each layer of the drawing how it paints, if it does.
    layers: Vec<Option<LayerPaint<'a>>>,
}

struct LayerPaint<'a> {
    object: &'a Object<'a>,
    program: &'a dyn LayerProgram,
    reads: SampleSet,
    seed: u32,
}

/// A thread's own memory.
#[derive(Default)]
pub(super) struct PaintScratch {
    /// For each layer the cells and lanes of the samples that it shows and paints.
    places: Vec<Vec<[u16; 2]>>,
    samples: Samples,
    colors: Vec<WgslVec3<f32>>,
}

impl<'a> Painting<'a> {
    /// Nothing where no layer paints.
    pub(super) fn new(
        frame: &'a Frame<'a>,
        drawing: &'a Drawing,
    ) -> Result<Option<Self>, DrawError> {
        let of_object = |object: &'a Object<'a>| {
            object.layers.iter().map(move |layer| {
                Some(LayerPaint {
                    object,
                    program: &*layer.program,
                    reads: layer.program.paints()?,
                    seed: layer_seed(object.seed, &layer.name),
                })
            })
        };
        let layers: Vec<_> = frame.objects.iter().flat_map(of_object).collect();
        if layers.iter().all(Option::is_none) {
            return Ok(None);
        }
        let joints = frame.paths.len();
        let reads_normal = |layer: &LayerPaint| layer.reads.has(SampleInput::Normal);
        let needs_normals = layers.iter().flatten().any(reads_normal);
        let is_made_of_it = drawing.layers.len() == layers.len()
            && drawing.clump.len() == joints
            && drawing.runs.len() == frame.paths.runs.len()
            && (!needs_normals || drawing.features.normal.len() == joints);
        match is_made_of_it {
            true => Ok(Some(Self {
                frame,
                drawing,
                layers,
            })),
            false => Err(DrawError::OtherFrame),
        }
    }

    /// Gives the samples of a tile the colours of the layers that paint them.
    pub(super) fn paint(
        &self,
        scene: &super::Frame,
        shown: &Planes,
        target: &mut Target,
        scratch: &mut PaintScratch,
    ) {
        let PaintScratch {
            places,
            samples,
            colors,
        } = scratch;
        places.resize_with(self.layers.len(), Vec::new);
        places.iter_mut().for_each(Vec::clear);
        for (cell, whats) in shown.what.iter().enumerate() {
            for (lane, &what) in whats.iter().enumerate() {
                if what == NOTHING || what & TRIANGLE != 0 {
                    continue;
                }
                let segment = &scene.parts.segments.list()[what as usize];
                let layer = scene.layer_of(segment);
                if layer.is_some_and(|layer| self.layers[layer].is_some()) {
                    places[layer.unwrap_or_default()].push([cell as u16, lane as u16]);
                }
            }
        }
        for (layer, places) in self.layers.iter().zip(places) {
            let Some(layer) = layer.as_ref().filter(|_| !places.is_empty()) else {
                continue;
            };
            samples.clear();
            for &[cell, lane] in &*places {
                let [cell, lane] = [cell, lane].map(usize::from);
                let segment = &scene.parts.segments.list()[shown.what[cell][lane] as usize];
                let way = shown.way[cell][lane];
                let across = [&shown.v, &shown.w].map(|plane| plane[cell][lane]);
                let color = [0, 1, 2].map(|channel: usize| target.color[channel][cell][lane]);
                let run = scene.runs_of_joints[segment.joint as usize] as usize;
                self.push(layer, segment, run, way, across, color, samples);
            }
            colors.clear();
            let all = 0..places.len();
            layer.program.paint(samples, all, layer.seed, colors);
            for (&[cell, lane], color) in places.iter().zip(&*colors) {
                let [cell, lane] = [cell, lane].map(usize::from);
                let color = color.to_array();
                // Where an effect failed to work one out, the stroke's colour stays.
                if color.iter().all(|channel| channel.is_finite()) {
                    for (plane, channel) in target.color.iter_mut().zip(color) {
                        plane[cell][lane] = channel;
                    }
                }
            }
        }
    }

    /// Adds what the layer reads of a sample.
    #[allow(clippy::too_many_arguments, reason = "what is known of one sample")]
    fn push(
        &self,
        layer: &LayerPaint,
        segment: &Segment,
        run: usize,
        way: f32,
        [v, w]: [f32; 2],
        color: [f32; 3],
        samples: &mut Samples,
    ) {
        let (frame, head) = (self.frame, layer.object.head);
        let paths = frame.paths;
        let joints = segment.joints();
        let [joint, next] = joints;
        let mixed = |list: &[f32]| list[joint] + way * (list[next] - list[joint]);
        let mixed_way = |list: &[Vec3]| list[joint].lerp(list[next], way);
        let position = mixed_way(&paths.position);
        let to_eye = frame.camera.eye() - position;
        let forward = || {
            let [a, b] = joints.map(|i| tangent(paths.forward[i], paths.backward[i]));
            a.lerp(b, way).normalize_or(a)
        };
        let normal = || {
            let normal = mixed_way(&self.drawing.features.normal);
            normal.normalize_or(self.drawing.features.normal[joint])
        };
        let world = |v: Vec3| vec3(v.to_array());
        let info = &frame.strands[paths.runs[run].strand];
        for input in layer.reads.iter() {
            match input {
                SampleInput::Color => samples.color.push(vec3(color)),
                SampleInput::Position => samples.position.push(world(position)),
                SampleInput::Forward => samples.forward.push(world(forward())),
                SampleInput::Normal => samples.normal.push(world(normal())),
                SampleInput::Tube => {
                    let tube = tube_normal(forward(), to_eye, w);
                    let tube = tube.unwrap_or_else(|| to_eye.normalize_or(Vec3::Z));
                    samples.tube.push(world(tube));
                }
                SampleInput::U => samples.u.push(mixed(&paths.u)),
                SampleInput::S => samples.s.push(mixed(&paths.arc_length) / head.height_m),
                SampleInput::V => samples.v.push(v),
                SampleInput::W => samples.w.push(w),
                SampleInput::Strand => samples.strand.push(info.id),
                SampleInput::Seed => samples.seed.push(hash(info.id)),
                SampleInput::Level => samples.level.push(info.level),
                SampleInput::Depth => {
                    let depth = frame.camera.depth(position);
                    samples.depth.push(depth / head.height_m);
                }
                SampleInput::HeadDepth => {
                    let depth = frame.camera.depth(head.center);
                    samples.head_depth.push(depth / head.height_m);
                }
                SampleInput::LightDirection => {
                    let (direction, _) = frame.light.seen_from(position);
                    samples.light_direction.push(world(direction));
                }
                SampleInput::LightDistance => {
                    let (_, distance) = frame.light.seen_from(position);
                    let in_heads = distance.map_or(FAR_LIGHT, |metres| metres / head.height_m);
                    samples.light_distance.push(in_heads);
                }
                SampleInput::ViewDirection => {
                    let direction = to_eye.normalize_or(Vec3::Z);
                    samples.view_direction.push(world(direction));
                }
                SampleInput::Pixels => {
                    let pixels = mixed(&paths.px_per_metre) * head.height_m;
                    samples.pixels.push(pixels);
                }
                SampleInput::Time => samples.time.push(frame.time_s),
            }
        }
    }
}
