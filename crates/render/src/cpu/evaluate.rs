//! Joints to strokes on the screen, by the layers' own WGSL in Rust.

use super::seen::{Needed, Seen};
use crate::drawing::{Brush, Disc, Drawing, LayerStrokes, Run, Stretch, Stretches};
use crate::features::{DrawnFeatures, Feature};
use crate::frame::{FAR_LIGHT, Frame, FrameError, Head, NO_COLOR, NO_TAPER, Object, seen_lengths};
use crate::painting;
use crate::samples::sample_positions;
use effects::smooth::{self, Smoother};
use effects::wgsl::{Clump, Stroke, clump_disc, hash, vec2, vec3};
use effects::{
    CLUMP_DISCS, Input, InputSet, Joints, Layer, StrandJoints, Units, clump, layer_seed,
};
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
        let read = inputs(frame);
        self.fill_inputs(frame, read);
        self.fill_clumps(frame, read);
        self.fill_seen_length(frame);
        self.fill_lift(frame);
        self.needed.clear();
        self.fill_clump_discs(frame, &mut drawing.clump);
        if !self.is_everywhere {
            let Self {
                seen,
                needed,
                samples,
                ..
            } = self;
            seen.find(frame, &self.joints, (&drawing.clump, samples), needed);
            leave_out(&needed.all, &mut drawing.clump);
        }

        drawing.size = frame.camera.size_px();
        drawing.background = frame.background;
        drawing.order = frame.order;
        drawing.edge_depth_m = frame.edge_depth_m;
        drawing.brush = frame.brush;
        drawing.passes.clone_from(&frame.passes);
        drawing.surfaces.clone_from(&frame.surfaces);
        drawing.runs.clear();
        drawing.runs.extend(frame.paths.runs.iter().map(|run| Run {
            strand: run.piece as u32,
            joints: run.joints.clone(),
        }));
        self.fill_sides(frame, drawing);

        self.fill_features(frame, &mut drawing.features);
        drawing.brushwork.fill(frame);
        drawing.painting.fill(frame, &self.joints);
        drawing.mesh_painting.fill(frame);
        drawing.decals.clone_from(&frame.decals);
        crate::frame::fill_same_strands(frame, &mut drawing.same_strands);

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
        disc_at(frame, object, joint, place, size, radius, depth_offset)
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
        let part = |joints| Part {
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
                let start = object.joints.start + number * CHUNK;
                let range = start..start + own.len();
                object.clump.for_each(joints, range, seed, |i, params| {
                    own[i - start] = clump::Program::clump(joints, i, seed, params);
                });
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

/// A thread's working memory.
#[derive(Default)]
struct Scratch {
    strokes: Vec<Stroke>,
    /// Of a strand's joints.
    radii: Vec<f32>,
    /// Where its stroke is drawn.
    drawn: Vec<Stretch>,
    /// The radii of the strand without what its pieces share, and where they are.
    whole: Vec<f32>,
    places: Vec<f32>,
    smoother: Smoother,
}

/// A stroke on some neighbouring joints.
struct Made {
    number: usize,
    /// Where it is drawn; their discs follow each other.
    stretches: Vec<Stretch>,
    discs: Vec<Disc>,
    colors: Vec<[f32; 3]>,
}

impl Made {
    fn new(number: u32) -> Self {
        Self {
            number: number as usize,
            stretches: Vec::new(),
            discs: Vec::new(),
            colors: Vec::new(),
        }
    }

    /// Numbers the discs of all stretches one behind the other.
    fn number_discs(&mut self) {
        let mut first = 0;
        for stretch in &mut self.stretches {
            stretch.first = first;
            first += stretch.joints.len();
        }
    }

    /// Adds where a strand's stroke is drawn, whose discs lie behind those so far.
    fn push_stretches(&mut self, drawn: &[Stretch]) {
        for stretch in drawn {
            match self.stretches.last_mut() {
                Some(last) if last.joints.end == stretch.joints.start => {
                    last.joints.end = stretch.joints.end;
                }
                _ => self.stretches.push(stretch.clone()),
            }
        }
    }

    /// Adds where it is drawn to what its stroke has on the joints before; its discs lie from place `first` on.
    fn add_stretches(&self, first: usize, all: &mut Vec<Stretch>) {
        for stretch in &self.stretches {
            let first = first + stretch.first;
            match all.last_mut() {
                Some(last)
                    if last.joints.end == stretch.joints.start && last.places().end == first =>
                {
                    last.joints.end = stretch.joints.end;
                }
                _ => all.push(Stretch {
                    joints: stretch.joints.clone(),
                    first,
                }),
            }
        }
    }
}

/// Puts strokes one behind the other, in all threads, in place of what the lists had: these are megabytes.
fn put_together(
    made: Vec<Made>,
    stretches: &mut [Vec<Stretch>],
    discs: &mut Vec<Disc>,
    colors: &mut Vec<[f32; 3]>,
) {
    let count = |of: fn(&Made) -> usize| -> usize { made.iter().map(of).sum() };
    set_length(discs, count(|made| made.discs.len()), NO_DISC);
    set_length(colors, count(|made| made.colors.len()), [0.0; 3]);
    let (mut discs, mut colors) = (&mut discs[..], &mut colors[..]);
    let mut first = 0;
    let with_places = made.into_iter().map(|made| {
        made.add_stretches(first, &mut stretches[made.number]);
        first += made.discs.len();
        let (own_discs, own_colors);
        (own_discs, discs) = std::mem::take(&mut discs).split_at_mut(made.discs.len());
        (own_colors, colors) = std::mem::take(&mut colors).split_at_mut(made.colors.len());
        (made, own_discs, own_colors)
    });
    let with_places: Vec<_> = with_places.collect();
    with_places
        .into_par_iter()
        .for_each(|(made, discs, colors)| {
            discs.copy_from_slice(&made.discs);
            colors.copy_from_slice(&made.colors);
        });
}

/// Gives a list a length without looking at what it has, which is to be written over. Dense hair has long ones: they don't grow by doubling.
fn set_length<T: Copy>(list: &mut Vec<T>, length: usize, anything: T) {
    list.reserve_exact(length.saturating_sub(list.len()));
    list.resize(length, anything);
}

/// Some neighbouring joints of a layer.
struct Part<'a> {
    frame: &'a Frame<'a>,
    object: &'a Object<'a>,
    layer: &'a Layer,
    layer_number: usize,
    inputs: &'a Joints,
    joints: Range<usize>,
    seen_length: &'a [f32],
    needed: &'a [bool],
    lift: &'a [f32],
    seed: u32,
}

impl Part<'_> {
    /// Makes stroke `number` of each run where it has a size.
    fn evaluate(&self, number: u32, scratch: &mut Scratch) -> Made {
        let mut made = Made::new(number);
        let is_unneeded = |joints: &Range<usize>| {
            let needed = self.needed.get(joints.clone());
            needed.is_some_and(|needed| !needed.contains(&true))
        };
        if is_unneeded(&self.joints) {
            return made;
        }
        let is_direct = self.is_mostly_there(number, scratch);
        for pieces in self.strands() {
            let joints = pieces[0].joints.start..pieces[pieces.len() - 1].joints.end;
            let strand = &self.frame.strands[pieces[0].strand];
            if !is_unneeded(&joints) && !strand.is_left_out_by(self.layer_number) {
                self.evaluate_strand(pieces, &joints, is_direct, scratch, &mut made);
            }
        }
        made.number_discs();
        made
    }

    /// Adds what the stroke has on a strand, of these pieces and joints.
    fn evaluate_strand(
        &self,
        pieces: &[PathRun],
        joints: &Range<usize>,
        is_direct: bool,
        scratch: &mut Scratch,
        made: &mut Made,
    ) {
        let (frame, layer, inputs) = (self.frame, self.layer, self.inputs);
        let program = &layer.program;
        let number = made.number as u32;
        let Scratch { radii, strokes, .. } = scratch;
        radii.clear();
        strokes.clear();
        let start = joints.start;
        for (i, run) in pieces.iter().enumerate() {
            let part = self.counted(pieces, i);
            if part.is_empty() {
                continue;
            }
            if is_direct {
                // Those beside, to which strokes taper, too.
                let part = part.start.saturating_sub(1).max(run.joints.start)
                    ..(part.end + 1).min(run.joints.end);
                strokes.resize(part.start - start, NO_STROKE);
                program.evaluate(inputs, part.clone(), number, self.seed, strokes);
                let own = &strokes[part.start - start..];
                radii.resize(part.start - start, 0.0);
                radii.extend(own.iter().map(|stroke| stroke.radius));
                continue;
            }
            let extent = program.extent(inputs, part, number, self.seed);
            radii.resize(extent.start - start, 0.0);
            program.radii(inputs, extent, number, self.seed, radii);
        }
        radii.resize(joints.len(), 0.0);
        // A stroke that an effect failed to work out is not drawn.
        let size = |radius: f32| {
            if radius.is_finite() {
                radius.max(0.0)
            } else {
                0.0
            }
        };
        radii.iter_mut().for_each(|radius| *radius = size(*radius));
        self.smooth(pieces, start, scratch);

        let Scratch {
            strokes,
            radii,
            drawn,
            ..
        } = scratch;
        leave_out_unneeded(self.needed, joints, radii);
        drawn.clear();
        find_stretches(pieces, start, radii, drawn);
        for stretch in drawn.iter_mut() {
            stretch.first = made.discs.len();
            let joints = stretch.joints.clone();
            let places = joints.start - start..joints.end - start;
            let strokes = match is_direct {
                true => &mut strokes[places.clone()],
                false => {
                    strokes.clear();
                    program.evaluate(inputs, joints.clone(), number, self.seed, strokes);
                    &mut strokes[..]
                }
            };
            for (stroke, radius) in strokes.iter_mut().zip(&radii[places]) {
                stroke.radius = *radius;
                drop_if_not_finite(stroke);
            }
            made.discs.extend(joints.zip(&*strokes).map(|(i, stroke)| {
                let offset = inputs.clump_shift[i] + stroke.offset;
                let offset = Vec2::new(offset.x, offset.y);
                let lift = self.lift.get(i).copied().unwrap_or(0.0);
                let depth_offset = layer.depth_offset + stroke.depth_offset - lift;
                let clump_radius = inputs.clump_radius[i];
                let radius = stroke.radius;
                disc_at(
                    frame,
                    self.object,
                    i,
                    offset,
                    radius,
                    clump_radius,
                    depth_offset,
                )
            }));
            let colors = strokes.iter().map(|stroke| stroke.color.to_array());
            made.colors.extend(colors);
        }
        if frame.brush == Brush::Semicircle {
            self.go_around_flat_ends(pieces, &radii[..], drawn, &mut made.discs);
        }
        made.push_stretches(drawn);
    }

    /// Moves the tips of strokes that are wider than their clump on by what they are wider, or an outline
    /// would end where its clump does. `drawn` are those of a strand of these pieces and radii.
    fn go_around_flat_ends(
        &self,
        pieces: &[PathRun],
        radii: &[f32],
        drawn: &[Stretch],
        discs: &mut [Disc],
    ) {
        let paths = self.frame.paths;
        let tips = pieces.iter().map(|run| run.joints.end - 1);
        for tip in tips.filter(|&tip| paths.u[tip] == 1.0) {
            let Some(stretch) = drawn.iter().find(|s| s.joints.contains(&tip)) else {
                continue;
            };
            let radius = radii[tip - pieces[0].joints.start];
            let wider = (radius - self.inputs.clump_radius[tip]).max(0.0);
            let unit_px = self.object.head.unit_m() * paths.px_per_metre[tip];
            // The path on the screen, of which `across` is a right angle to the right.
            let ahead = -paths.across[tip].perp();
            let disc = &mut discs[stretch.first + tip - stretch.joints.start];
            disc.center += ahead * (wider * unit_px).min(LARGEST_PX);
        }
    }

    /// Whether strokes are best worked out at once, as they have a size at most joints: else radii come first. The first strand tells.
    fn is_mostly_there(&self, number: u32, scratch: &mut Scratch) -> bool {
        if self.layer.program.shortest() > 0.0 {
            return false; // smoothing takes radii alone
        }
        let strands = self.strands();
        let mut parts = strands.flat_map(|pieces| (0..pieces.len()).map(move |i| (pieces, i)));
        let part = parts.find_map(|(pieces, i)| {
            let part = self.counted(pieces, i);
            let strand = &self.frame.strands[pieces[i].strand];
            let is_there = !part.is_empty() && !strand.is_left_out_by(self.layer_number);
            is_there.then_some(part)
        });
        let Some(part) = part else {
            return false;
        };
        let Self { inputs, seed, .. } = *self;
        let program = &self.layer.program;
        let extent = program.extent(inputs, part.clone(), number, seed);
        if 2 * extent.len() < part.len() {
            return false;
        }
        scratch.radii.clear();
        program.radii(inputs, extent, number, seed, &mut scratch.radii);
        let sizes = scratch.radii.iter().filter(|radius| **radius > 0.0);
        2 * sizes.count() > part.len()
    }

    /// Of the joints of piece `i` of a strand those whose radii are asked for: where strokes make a difference, and as far as smoothing
    /// looks from there.
    fn counted(&self, pieces: &[PathRun], i: usize) -> Range<usize> {
        let all = pieces[i].joints.clone();
        if self.needed.is_empty() {
            return all;
        }
        let is_needed = |joint: &usize| self.needed[*joint];
        let length_m = self.layer.program.shortest() * self.object.head.height_m;
        if length_m > 0.0 && pieces.len() > 1 {
            // It looks from piece to piece.
            let mut joints = pieces.iter().flat_map(|piece| piece.joints.clone());
            return match joints.any(|joint| is_needed(&joint)) {
                true => all,
                false => all.start..all.start,
            };
        }
        let Some(first) = all.clone().find(is_needed) else {
            return all.start..all.start;
        };
        let last = all.clone().rfind(is_needed).unwrap_or(first);
        if length_m <= 0.0 {
            return first..last + 1;
        }
        let places = &self.seen_length[all.clone()];
        let seen = smooth::seen_from(places, first - all.start..last + 1 - all.start, length_m);
        all.start + seen.start..all.start + seen.end
    }

    /// Their runs by strands, as far as smoothing knows: pieces of one, of which each overlaps the one before.
    fn strands(&self) -> impl Iterator<Item = &[PathRun]> {
        self.runs().chunk_by(|_, next| next.overlap > 0)
    }

    /// Their runs.
    fn runs(&self) -> &[PathRun] {
        runs_of(self.frame.paths, &self.joints)
    }

    /// Takes stretches and gaps of a strand's stroke that are too short away, as they are seen: hair that
    /// points at the eye would show long ones as dots. Its joints begin at `start`.
    fn smooth(&self, pieces: &[PathRun], start: usize, scratch: &mut Scratch) {
        let length_m = self.layer.program.shortest() * self.object.head.height_m;
        if length_m <= 0.0 {
            return;
        }
        let Scratch {
            radii,
            whole,
            places,
            smoother,
            ..
        } = scratch;
        // Pieces together, and what they share once.
        let joints = || {
            let own = |run: &PathRun| run.joints.start + run.overlap..run.joints.end;
            pieces.iter().flat_map(own)
        };
        whole.clear();
        whole.extend(joints().map(|i| radii[i - start]));
        if whole.iter().all(|radius| *radius == 0.0) {
            return;
        }
        places.clear();
        places.extend(joints().map(|i| self.seen_length[i]));
        smoother.smooth(places, whole, length_m);
        for (i, radius) in joints().zip(whole.iter()) {
            radii[i - start] = *radius;
        }
        for piece in pieces {
            let shared = piece.joints.start..piece.joints.start + piece.overlap;
            for i in shared {
                radii[i - start] = radii[i - piece.overlap - start];
            }
        }
    }
}

/// Adds where a stroke with these radii on neighbouring runs, from joint `start` on, is drawn: where it has a size, and at the joints beside, to
/// which it tapers.
fn find_stretches(runs: &[PathRun], start: usize, radii: &[f32], stretches: &mut Vec<Stretch>) {
    for run in runs {
        let has_size = |&joint: &usize| radii[joint - start] > 0.0;
        let mut rest = run.joints.clone();
        while let Some(first) = rest.find(has_size) {
            let end = rest.find(|joint| !has_size(joint));
            let end = end.map_or(run.joints.end, |end| end + 1);
            let first = first.saturating_sub(1).max(run.joints.start);
            match stretches.last_mut() {
                // There is no gap but what tapers.
                Some(last) if last.joints.end >= first => last.joints.end = end,
                _ => stretches.push(Stretch {
                    joints: first..end,
                    first: 0,
                }),
            }
        }
    }
}

/// Takes their sizes from discs of all joints where strokes make no difference.
fn leave_out(needed: &[bool], discs: &mut [Disc]) {
    for (disc, is_needed) in discs.iter_mut().zip(needed) {
        disc.radius = if *is_needed { disc.radius } else { 0.0 };
    }
}

/// Takes their sizes from joints at which strokes make no difference.
fn leave_out_unneeded(needed: &[bool], joints: &Range<usize>, radii: &mut [f32]) {
    let needed = needed.get(joints.clone()).unwrap_or_default();
    for (radius, is_needed) in radii.iter_mut().zip(needed) {
        *radius = if *is_needed { *radius } else { 0.0 };
    }
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

const NO_STROKE: Stroke = Stroke {
    offset: effects::wgsl::Vec2 { x: 0.0, y: 0.0 },
    radius: 0.0,
    depth_offset: 0.0,
    color: NOWHERE,
};

const NO_DISC: Disc = Disc {
    center: Vec2::ZERO,
    radius: 0.0,
    inv_depth: 0.0,
    inv_depth_biased: 0.0,
};

/// A stroke's disc on the screen. Sizes in 1/300 of the head's height, the depth offset in head
/// heights.
///
/// Against surfaces a stroke stands where its strand stands, less the radius of the clump there: the
/// depth offset orders strands, and must not push an outline into the face behind it. Lines on surfaces are before all of them.
fn disc_at(
    frame: &Frame,
    object: &Object,
    joint: usize,
    offset: Vec2,
    radius: f32,
    clump_radius: f32,
    depth_offset: f32,
) -> Disc {
    let head = object.head;
    let unit_m = head.unit_m();
    let unit_px = unit_m * frame.paths.px_per_metre[joint];
    // No depth is nearer than the near plane, whatever is taken from it.
    let nearest = frame.camera.near_m();
    let depth = frame.paths.depth[joint];
    let shifted = (depth + depth_offset * head.height_m).max(nearest);
    let biased = (depth - clump_radius * unit_m - object.surface_bias_m).max(nearest);
    Disc {
        center: frame.paths.center[joint] + offset * unit_px,
        radius: (radius.max(0.0) * unit_px).min(LARGEST_PX),
        inv_depth: 1.0 / shifted,
        inv_depth_biased: 1.0 / biased,
    }
}

/// Of more joints what effects read is not kept from frame to frame, so that the rasteriser has that room: some 200 bytes a joint.
const MOST_KEPT: usize = 1 << 17;

/// Joints that a thread works on at a time, at least.
const CHUNK: usize = 1024;

/// No disc is larger, in pixels: it already covers any picture.
const LARGEST_PX: f32 = 1e8;

/// A stroke that an effect failed to work out is not drawn.
fn drop_if_not_finite(stroke: &mut Stroke) {
    let numbers = [
        stroke.offset.x,
        stroke.offset.y,
        stroke.radius,
        stroke.depth_offset,
    ];
    let all = numbers
        .iter()
        .chain(&stroke.color.to_array())
        .all(|x| x.is_finite());
    if !all {
        *stroke = NO_STROKE;
    }
}
