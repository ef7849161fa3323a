//! Joints to strokes on the screen, by the layers' own WGSL in Rust.

mod made;
mod part;

use self::made::{Made, put_together};
use self::part::{Part, Scratch, find_stretches, leave_out, leave_out_unneeded};
use super::instructions::Instructions;
use super::seen::{Needed, Seen};
use crate::drawing::{Disc, Drawing, LayerStrokes, Run, Stretches};
use crate::features::{DrawnFeatures, Feature};
use crate::frame::{FAR_LIGHT, Frame, FrameError, Head, NO_COLOR, NO_TAPER, Object, seen_lengths};
use crate::painting;
use crate::samples::sample_positions;
use effects::wgsl::{Clump, clump_disc, hash, vec2, vec3};
use effects::{CLUMP_DISCS, Input, InputSet, Joints, Layer, StrandJoints, Units, layer_seed};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Mutex;
use stroke_path::{PathRun, Paths};

/// Turns frames into drawings, on the threads of the rayon pool that it is called in. Keeps its lists
/// from frame to frame.
#[derive(Default)]
pub struct Evaluator {
    joints: Joints,
    clumps: Vec<Clump>,
    /// For each joint the length of its run up to there as it is seen, metres at its depth; empty where no
    /// layer has a shortest stroke.
    seen_length: Vec<f32>,
    needed: Needed,
    seen: Seen,
    /// How much nearer each joint is ordered among strands, head heights; empty where none is.
    lift: Vec<f32>,
    is_everywhere: bool,
    /// Those of each pixel, where they are known.
    samples: Vec<Vec2>,
    /// One for each thread.
    scratches: Vec<Mutex<Scratch>>,
}

impl Evaluator {
    /// One that works out strokes where no picture shows them, too: for those who read a drawing's discs.
    #[must_use]
    pub fn everywhere() -> Self {
        Self {
            is_everywhere: true,
            ..Self::default()
        }
    }

    /// One that works out what pictures with so many samples in each pixel show, and no others: of dense hair that is less than
    /// what any picture may show.
    #[must_use]
    pub fn of_samples(samples: u32) -> Self {
        let mut evaluator = Self::default();
        evaluator.set_samples(samples);
        evaluator
    }

    /// From now on it is as [`Self::of_samples`] has it; of a number of samples that there isn't, as at first.
    pub fn set_samples(&mut self, samples: u32) {
        self.samples = sample_positions(samples).unwrap_or_default();
    }

    /// Makes all strokes of `frame`. Only what the active layers declare is worked out.
    ///
    /// # Errors
    ///
    /// When the frame is invalid ([`Frame::check`]); then the drawing is as it was.
    #[inline(never)] // a stage of a frame, which `cargo xtask bench count` finds by its name
    pub fn evaluate(&mut self, frame: &Frame, drawing: &mut Drawing) -> Result<(), FrameError> {
        frame.check()?;
        let threads = rayon::current_num_threads();
        self.scratches.resize_with(threads, Mutex::default);
        let Drawing {
            clump,
            surfaces,
            mesh_painting,
            brushwork,
            same_strands,
            ..
        } = &mut *drawing;
        rayon::join(
            || {
                surfaces.clone_from(&frame.surfaces);
                mesh_painting.fill(frame);
                brushwork.fill(frame);
                crate::frame::fill_same_strands(frame, same_strands);
            },
            || self.fill_joints(frame, clump),
        );

        drawing.size = frame.camera.size_px();
        drawing.background = frame.background;
        drawing.order = frame.order;
        drawing.edge_depth_m = frame.edge_depth_m;
        drawing.brush = frame.brush;
        drawing.passes.clone_from(&frame.passes);
        drawing.runs.clear();
        drawing.runs.extend(frame.paths.runs.iter().map(|run| Run {
            strand: run.piece as u32,
            joints: run.joints.clone(),
        }));
        self.fill_sides(frame, drawing);

        self.fill_features(frame, &mut drawing.features);
        drawing.painting.fill(frame, &self.joints);
        drawing.decals.clone_from(&frame.decals);

        let mut spare = std::mem::take(&mut drawing.layers).into_iter();
        for object in &frame.objects {
            let layers = object.layers.iter().zip(object.layer_joints);
            for (number, (layer, joints)) in layers.enumerate() {
                let lists = spare
                    .next()
                    .map(|l| (l.discs, l.colors))
                    .unwrap_or_default();
                let strokes = self.layer(frame, object, number, joints, lists);
                if layer.program.has_own_paths() {
                    // No strand's clump holds them: they are their own.
                    drawing.clump[joints.clone()].fill(NO_DISC);
                    let own = (!layer.is_decal()).then(|| strokes.on(0, joints));
                    for stretch in own.into_iter().flatten() {
                        let own = &strokes.discs[stretch.places()];
                        drawing.clump[stretch.joints].copy_from_slice(own);
                    }
                }
                drawing.layers.push(strokes);
            }
        }
        if frame.paths.len() > MOST_KEPT {
            self.joints = Joints::default();
            self.clumps = Vec::new();
        }
        Ok(())
    }

    /// All that layers are told of joints, and the discs of all clumps, of those that make a difference.
    fn fill_joints(&mut self, frame: &Frame, clump: &mut Vec<Disc>) {
        let read = inputs(frame);
        self.fill_inputs(frame, read);
        self.fill_clumps(frame, read);
        self.fill_seen_length(frame);
        self.fill_lift(frame);
        self.needed.clear();
        self.fill_clump_discs(frame, clump);
        if !self.is_everywhere {
            let Self {
                seen,
                needed,
                samples,
                ..
            } = self;
            seen.find(frame, &self.joints, (clump, samples), needed);
            leave_out(&needed.all, clump);
        }
    }

    /// The discs of all clumps.
    fn fill_clump_discs(&self, frame: &Frame, clumps: &mut Vec<Disc>) {
        clumps.clear();
        for object in &frame.objects {
            let joints = object.joints.clone().into_par_iter().with_min_len(CHUNK);
            clumps.par_extend(joints.map(|i| self.clump_disc_at(frame, object, i, 0)));
        }
    }

    /// What samples are told of joints.
    fn fill_features(&self, frame: &Frame, features: &mut DrawnFeatures) {
        features.fill(frame);
        if features.declared.has(Feature::Normal) {
            let normals = self.clumps.iter().map(|clump| clump.normal.to_array());
            features.normal.extend(normals.map(Vec3::from));
        }
    }

    /// Those at their sides, where clumps are flat.
    fn fill_sides(&self, frame: &Frame, drawing: &mut Drawing) {
        let (radii, shifts) = (&self.joints.clump_radius, &self.joints.clump_shift);
        drawing.side_stretches = Stretches::default();
        if shifts.iter().all(|&shift| shift == vec2([0.0; 2])) {
            drawing.sides.clear();
            return;
        }
        let mut parts = Vec::new();
        for number in 1..CLUMP_DISCS {
            for object in &frame.objects {
                for joints in without_made_paths(object) {
                    let pieces = pieces(frame.paths, &joints);
                    parts.extend(pieces.map(|joints| (object, number, joints)));
                }
            }
        }
        let sides = |(object, number, joints): (&Object, u32, Range<usize>)| {
            let size = |i| clump_disc(number, radii[i], shifts[i]).z;
            let strand = StrandJoints {
                joints: &self.joints,
                range: joints.clone(),
                instance: number,
                seed: 0,
            };
            let extent = strand.clump_disc_extent();
            let mut made = Made::new(number - 1);
            self.with_scratch(|Scratch { radii, .. }| {
                radii.clear();
                radii.resize(extent.start - joints.start, 0.0);
                radii.extend(extent.map(size));
                radii.resize(joints.len(), 0.0);
                leave_out_unneeded(&self.needed.all, &joints, radii);
                let runs = runs_of(frame.paths, &joints);
                find_stretches(runs, joints.start, radii, &mut made.stretches);
                made.number_discs();
            });
            let drawn = made.stretches.iter().flat_map(|s| s.joints.clone());
            let discs = drawn.map(|i| self.clump_disc_at(frame, object, i, number));
            made.discs.extend(discs);
            made
        };
        // One by one, so that all threads end at one time; as those of layers.
        let made = parts.into_par_iter().with_max_len(1).map(sides);
        let made: Vec<Made> = made.collect();
        let mut stretches = vec![Vec::new(); CLUMP_DISCS as usize - 1];
        put_together(made, &mut stretches, &mut drawing.sides, &mut Vec::new());
        drawing.side_stretches = Stretches::Within(stretches);
    }

    /// Calls `work` with this thread's working memory.
    fn with_scratch<R>(&self, work: impl FnOnce(&mut Scratch) -> R) -> R {
        let thread = rayon::current_thread_index().unwrap_or(0);
        match self.scratches[thread].try_lock() {
            Ok(mut scratch) => work(&mut scratch),
            // An effect that waits for other threads may be called in the midst of itself, and one may have panicked.
            Err(_) => work(&mut Scratch::default()),
        }
    }

    fn is_needed(&self, joint: usize) -> bool {
        self.needed.all.get(joint).is_none_or(|needed| *needed)
    }

    /// Disc `number` of the clump at a joint.
    fn clump_disc_at(&self, frame: &Frame, object: &Object, joint: usize, number: u32) -> Disc {
        let radius = self.joints.clump_radius[joint];
        let shift = self.joints.clump_shift[joint];
        let [x, y, size] = clump_disc(number, radius, shift).to_array();
        let size = if self.is_needed(joint) { size } else { 0.0 };
        let place = shift + vec2([x, y]);
        let place = Vec2::new(place.x, place.y);
        let depth_offset = -self.lift.get(joint).copied().unwrap_or(0.0);
        let paths = frame.paths;
        let seen = (
            paths.center[joint],
            paths.depth[joint],
            paths.px_per_metre[joint],
        );
        Sight::of(frame, object).disc(seen, place, size, radius, depth_offset)
    }

    /// The strokes of layer `number` of an object on the joints `drawn`; `lists` are reused.
    fn layer(
        &mut self,
        frame: &Frame,
        object: &Object,
        number: usize,
        drawn: &Range<usize>,
        (mut discs, mut colors): (Vec<Disc>, Vec<[f32; 3]>),
    ) -> LayerStrokes {
        let layer = &object.layers[number];
        self.fill_unit(frame, object.head, drawn, layer.units);
        let instances = layer.program.instances();
        let instructions = Instructions::best();
        let part = |joints| Part {
            instructions,
            frame,
            object,
            layer,
            layer_number: number,
            inputs: &self.joints,
            joints,
            seen_length: &self.seen_length,
            needed: self.needed.of(frame.order, layer),
            lift: &self.lift,
            seed: layer_seed(object.seed, &layer.name),
        };
        let of_stroke = |number| pieces(frame.paths, drawn).map(move |joints| (number, joints));
        let parts: Vec<(u32, Range<usize>)> = (0..instances).flat_map(of_stroke).collect();
        let made = parts
            .into_par_iter()
            .with_max_len(1)
            .map(|(number, joints)| {
                self.with_scratch(|scratch| part(joints).evaluate(number, scratch))
            });
        let made: Vec<Made> = made.collect();
        let mut stretches = vec![Vec::new(); instances as usize];
        put_together(made, &mut stretches, &mut discs, &mut colors);
        LayerStrokes {
            name: layer.name.clone(),
            joints: drawn.clone(),
            rank: layer.rank,
            instances: instances as usize,
            stretches: Stretches::Within(stretches),
            discs,
            colors,
        }
    }

    /// The lists of the inputs that are `read`, but for those that come from the clump or the layer.
    fn fill_inputs(&mut self, frame: &Frame, read: InputSet) {
        self.joints.clear();
        read.iter().for_each(|input| self.fill_input(frame, input));
    }

    fn fill_input(&mut self, frame: &Frame, input: Input) {
        let (paths, joints) = (frame.paths, &mut self.joints);
        let world = |v: &Vec3| vec3(v.to_array());
        let runs = &paths.runs[..];
        let of = |run: &PathRun| &frame.strands[run.strand];
        let to_light = |point: &Vec3| frame.light.seen_from(*point);
        match input {
            Input::Position => of_each(&mut joints.position, &paths.position, world),
            Input::Forward => of_each(&mut joints.forward, &paths.forward, world),
            Input::Backward => of_each(&mut joints.backward, &paths.backward, world),
            Input::U => joints.u.extend_from_slice(&paths.u),
            Input::ArcLength => joints.arc_length.extend_from_slice(&paths.arc_length),
            Input::Across => {
                of_each(&mut joints.across, &paths.across, |v: &Vec2| {
                    vec2(v.to_array())
                });
            }
            Input::MaterialNormal => {
                of_each(&mut joints.material_normal, frame.material_normals, world);
            }
            Input::RestPosition => {
                of_each(&mut joints.rest_position, frame.rest_positions, world);
            }
            Input::RestForward => of_each(&mut joints.rest_forward, frame.rest_forwards, world),
            Input::FromEnds => {
                of_each(&mut joints.from_ends, frame.from_ends, |v: &Vec2| {
                    vec2(v.to_array())
                });
            }
            Input::PathWeight => joints.path_weight.extend_from_slice(frame.path_weights),
            Input::Strand => of_runs(&mut joints.strand, runs, |run| of(run).id),
            Input::Seed => of_runs(&mut joints.seed, runs, |run| hash(of(run).id)),
            Input::StrandMean => {
                of_runs(&mut joints.strand_mean, runs, |run| world(&of(run).mean));
            }
            Input::StrandSize => of_runs(&mut joints.strand_size, runs, |run| of(run).size),
            // Empty where no strand has one.
            Input::StrandTaper if frame.strands.iter().all(|s| s.taper == NO_TAPER) => {}
            Input::StrandTaper => {
                let taper = |run: &PathRun| vec2(of(run).taper.to_array());
                of_runs(&mut joints.strand_taper, runs, taper);
            }
            Input::StrandColor => {
                if frame.strands.iter().any(|s| s.colors[0] != NO_COLOR) {
                    of_runs(&mut joints.strand_color, runs, |run| {
                        world(&of(run).colors[0])
                    });
                }
            }
            Input::StrandTipColor => {
                if frame.strands.iter().any(|s| s.colors[1] != NO_COLOR) {
                    of_runs(&mut joints.strand_tip_color, runs, |run| {
                        world(&of(run).colors[1])
                    });
                }
            }
            Input::HeadCenter => {
                for Object {
                    head, joints: own, ..
                } in &frame.objects
                {
                    joints.head_center.resize(own.end, world(&head.center));
                }
            }
            Input::HeadHeight => {
                for Object {
                    head, joints: own, ..
                } in &frame.objects
                {
                    joints.head_height.resize(own.end, head.height_m);
                }
            }
            Input::LightDirection => {
                let direction = |p: &Vec3| world(&to_light(p).0);
                of_each(&mut joints.light_direction, &paths.position, direction);
            }
            Input::LightDistance => {
                for Object {
                    head, joints: own, ..
                } in &frame.objects
                {
                    let in_heads = |metres: f32| metres / head.height_m;
                    let distance = |p: &Vec3| to_light(p).1.map_or(FAR_LIGHT, in_heads);
                    let own = &paths.position[own.clone()];
                    of_each(&mut joints.light_distance, own, distance);
                }
            }
            Input::LightOnScreen => {
                let camera = frame.camera;
                let [right, up, ahead] =
                    [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| camera.world_from_view_direction(axis));
                let seen = |p: &Vec3| {
                    let light = to_light(p).0;
                    vec3([light.dot(right), -light.dot(up), -light.dot(ahead)])
                };
                of_each(&mut joints.light_on_screen, &paths.position, seen);
            }
            // Of the place: `paths.depth` is deeper where a piece goes on beyond its cut.
            Input::Depth => {
                for Object {
                    head, joints: own, ..
                } in &frame.objects
                {
                    let view = |p: &Vec3| frame.camera.view_from_world(*p);
                    let depth = |p: &Vec3| view(p).z / head.height_m;
                    of_each(&mut joints.depth, &paths.position[own.clone()], depth);
                }
            }
            Input::Time => joints.time.resize(paths.len(), frame.time_s),
            Input::ViewDirection => {
                let eye = frame.camera.eye();
                let to_eye = |p: &Vec3| world(&(eye - *p).normalize_or(Vec3::Z));
                of_each(&mut joints.view_direction, &paths.position, to_eye);
            }
            // From the clump: `fill_clumps`.
            Input::Normal
            | Input::ClumpRadius
            | Input::ClumpColor
            | Input::ClumpShift
            | Input::Gray => {}
            // From the layer: `fill_unit`.
            Input::Unit => {}
        }
    }

    /// The clump of every joint, once for all layers: where it is, and what of it is `read`.
    fn fill_clumps(&mut self, frame: &Frame, read: InputSet) {
        let mut clumps = std::mem::take(&mut self.clumps);
        let joints = &self.joints;
        clumps.clear();
        for object in &frame.objects {
            let seed = layer_seed(object.seed, "clump");
            clumps.resize(object.joints.end, NO_CLUMP);
            let own = clumps[object.joints.clone()].par_chunks_mut(CHUNK);
            own.enumerate().for_each(|(number, own)| {
                let first = object.joints.start + number * CHUNK;
                object.clump.clumps(joints, first, seed, own);
            });
        }
        let Joints {
            light_direction,
            gray,
            normal,
            clump_radius,
            clump_color,
            clump_shift,
            ..
        } = &mut self.joints;
        if read.has(Input::Gray) {
            let lit = clumps.par_iter().zip(light_direction).with_min_len(CHUNK);
            gray.par_extend(lit.map(|(clump, light)| clump.normal.dot(*light).0.max(0.0)));
        }
        if read.has(Input::Normal) {
            of_each(normal, &clumps, |clump| clump.normal);
        }
        if read.has(Input::ClumpColor) {
            of_each(clump_color, &clumps, |clump| clump.color);
        }
        of_each(clump_radius, &clumps, |clump| clump.radius);
        of_each(clump_shift, &clumps, |clump: &Clump| {
            let shift = Vec3::from(clump.shift.to_array());
            let view = frame.camera.view_from_world_direction(shift);
            vec2([view.x, -view.y])
        });
        self.clumps = clumps;
    }

    fn fill_seen_length(&mut self, frame: &Frame) {
        self.seen_length.clear();
        let is_read = |layer: &Layer| layer.program.shortest() > 0.0;
        let mut layers = frame.objects.iter().flat_map(|object| object.layers);
        if !layers.any(is_read) {
            return;
        }
        seen_lengths(frame.paths, &mut self.seen_length);
    }

    fn fill_lift(&mut self, frame: &Frame) {
        self.lift.clear();
        if frame.strands.iter().any(|strand| strand.lift != 0.0) {
            let runs = frame.paths.runs.iter();
            let lifts = runs.flat_map(|run| {
                let lift = frame.strands[run.strand].lift;
                run.joints.clone().map(move |_| lift)
            });
            self.lift.extend(lifts);
        }
    }

    /// The size of a pixel at 720 lines, for layers whose widths are pixels, on the joints `drawn`.
    fn fill_unit(&mut self, frame: &Frame, head: Head, drawn: &Range<usize>, units: Units) {
        let unit = &mut self.joints.unit;
        unit.clear();
        if units == Units::Pixels {
            let pixel_px = frame.camera.size_px()[1] as f32 / 720.0;
            let unit_m = head.unit_m();
            let scales = frame.paths.px_per_metre[drawn.clone()].iter();
            unit.resize(drawn.start, 1.0); // which nobody reads
            unit.extend(scales.map(|scale| pixel_px / (scale * unit_m)));
        }
    }
}

/// Appends what is made of each item, in all threads.
fn of_each<T: Sync, R: Send>(list: &mut Vec<R>, items: &[T], make: impl Fn(&T) -> R + Send + Sync) {
    list.par_extend(items.par_iter().with_min_len(CHUNK).map(make));
}

/// Appends what each joint of some runs has of its strand.
fn of_runs<R: Clone>(list: &mut Vec<R>, runs: &[PathRun], of: impl Fn(&PathRun) -> R) {
    for run in runs {
        list.resize(run.joints.end, of(run));
    }
}

/// What clumps and active layers read of joints.
fn inputs(frame: &Frame) -> InputSet {
    let read = (frame.objects.iter())
        .map(|object| object.inputs().union(painting::inputs(object)))
        .fold(InputSet::default(), InputSet::union);
    if read.has(Input::Gray) {
        // It is made of that.
        return read.union(InputSet::of(&[Input::LightDirection]));
    }
    read
}

/// The joints of an object's hair alone: the clumps of made paths are their strokes.
fn without_made_paths(object: &Object) -> Vec<Range<usize>> {
    let layers = object.layers.iter().zip(object.layer_joints);
    let made = layers.filter(|(layer, _)| layer.program.has_own_paths());
    let mut made: Vec<&Range<usize>> = made.map(|(_, joints)| joints).collect();
    made.sort_by_key(|joints| joints.start);
    let mut hair = Vec::new();
    let mut start = object.joints.start;
    for joints in made {
        hair.push(start..joints.start.max(start));
        start = start.max(joints.end);
    }
    hair.push(start..object.joints.end);
    hair
}

/// The runs whose joints are in a range, which is one of whole runs.
fn runs_of<'a>(paths: &'a Paths, joints: &Range<usize>) -> &'a [PathRun] {
    let runs = &paths.runs;
    let first = runs.partition_point(|run| run.joints.start < joints.start);
    let end = runs.partition_point(|run| run.joints.end <= joints.end);
    &runs[first..end.max(first)]
}

/// A range of joints in pieces that a thread works on at a time: whole strands, as smoothing looks along them.
fn pieces(paths: &Paths, joints: &Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let mut runs = runs_of(paths, joints).iter();
    let Range { mut start, end } = *joints;
    std::iter::from_fn(move || {
        if start == end {
            return None;
        }
        let is_next = |run: &&PathRun| run.overlap == 0 && run.joints.start >= start + CHUNK;
        let next = runs.find(is_next).map_or(end, |run| run.joints.start);
        Some(std::mem::replace(&mut start, next)..next)
    })
}

const NO_CLUMP: Clump = Clump {
    normal: NOWHERE,
    radius: 0.0,
    color: NOWHERE,
    shift: NOWHERE,
};

const NOWHERE: effects::wgsl::Vec3<f32> = effects::wgsl::Vec3 {
    x: 0.0,
    y: 0.0,
    z: 0.0,
};

const NO_DISC: Disc = Disc {
    center: Vec2::ZERO,
    radius: 0.0,
    inv_depth: 0.0,
    inv_depth_biased: 0.0,
};

/// How discs of an object's strokes come to be on the screen.
#[derive(Clone, Copy)]
struct Sight {
    /// A unit of size, 1/300 of the head's height, and the head's height, metres.
    unit_m: f32,
    height_m: f32,
    surface_bias_m: f32,
    /// No depth is nearer than the near plane, whatever is taken from it.
    nearest_m: f32,
}

impl Sight {
    fn of(frame: &Frame, object: &Object) -> Self {
        Self {
            unit_m: object.head.unit_m(),
            height_m: object.head.height_m,
            surface_bias_m: object.surface_bias_m,
            nearest_m: frame.camera.near_m(),
        }
    }

    /// A stroke's disc at a joint that is seen at `center` and has `depth`, of as many pixels a metre there. Sizes in 1/300 of the head's height, the
    /// depth offset in head heights.
    ///
    /// Against surfaces a stroke stands where its strand stands, less the radius of the clump there: the
    /// depth offset orders strands, and must not push an outline into the face behind it. Lines on surfaces are before all of them.
    #[inline(always)] // into loops that are compiled for other instructions
    fn disc(
        &self,
        (center, depth, px_per_metre): (Vec2, f32, f32),
        offset: Vec2,
        radius: f32,
        clump_radius: f32,
        depth_offset: f32,
    ) -> Disc {
        let unit_px = self.unit_m * px_per_metre;
        let shifted = (depth + depth_offset * self.height_m).max(self.nearest_m);
        let biased = (depth - clump_radius * self.unit_m - self.surface_bias_m).max(self.nearest_m);
        Disc {
            center: center + offset * unit_px,
            radius: (radius.max(0.0) * unit_px).min(LARGEST_PX),
            inv_depth: 1.0 / shifted,
            inv_depth_biased: 1.0 / biased,
        }
    }
}

/// Of more joints what effects read is not kept from frame to frame, so that the rasteriser has that room: some 200 bytes a joint.
const MOST_KEPT: usize = 1 << 17;

/// Joints that a thread works on at a time, at least.
const CHUNK: usize = 1024;

/// No disc is larger, in pixels: it already covers any picture.
const LARGEST_PX: f32 = 1e8;
