//! Joints to strokes on the screen, by the layers' own WGSL in Rust.

use crate::drawing::{Brush, Disc, Drawing, LayerStrokes, Run};
use crate::frame::{FAR_LIGHT, Frame, FrameError, Head, NO_TAPER, Object, seen_lengths};
use effects::smooth::Smoother;
use effects::wgsl::{Clump, Stroke, clump_disc, hash, vec2, vec3};
use effects::{CLUMP_DISCS, Input, InputSet, Joints, Layer, Units, clump, layer_seed};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::ops::Range;
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
}

impl Evaluator {
    /// Makes all strokes of `frame`. Only what the active layers declare is worked out.
    ///
    /// # Errors
    ///
    /// When the frame is invalid ([`Frame::check`]); then the drawing is as it was.
    #[inline(never)] // a stage of a frame, which `cargo xtask bench count` finds by its name
    pub fn evaluate(&mut self, frame: &Frame, drawing: &mut Drawing) -> Result<(), FrameError> {
        frame.check()?;
        let read = inputs(frame);
        self.fill_inputs(frame, read);
        self.fill_clumps(frame, read);
        self.fill_seen_length(frame);

        drawing.size = frame.camera.size_px();
        drawing.background = frame.background;
        drawing.order = frame.order;
        drawing.edge_depth_m = frame.edge_depth_m;
        drawing.brush = frame.brush;
        drawing.surfaces.clone_from(&frame.surfaces);
        drawing.runs.clear();
        drawing.runs.extend(frame.paths.runs.iter().map(|run| Run {
            strand: run.piece as u32,
            joints: run.joints.clone(),
        }));
        self.fill_clump_discs(frame, &mut drawing.clump, &mut drawing.sides);

        let mut spare = std::mem::take(&mut drawing.layers).into_iter();
        for object in &frame.objects {
            for (layer, joints) in object.layers.iter().zip(object.layer_joints) {
                let lists = spare
                    .next()
                    .map(|l| (l.discs, l.colors))
                    .unwrap_or_default();
                let strokes = self.layer(frame, object, layer, joints, lists);
                if layer.program.has_own_paths() {
                    // No strand's clump holds them: they are their own.
                    let own = &strokes.discs[..joints.len()];
                    drawing.clump[joints.clone()].copy_from_slice(own);
                    for side in drawing.sides.chunks_mut(frame.paths.len().max(1)) {
                        side[joints.clone()].fill(NO_DISC);
                    }
                }
                drawing.layers.push(strokes);
            }
        }
        Ok(())
    }

    /// The discs of all clumps, and those at their sides if any is flat.
    fn fill_clump_discs(&self, frame: &Frame, clumps: &mut Vec<Disc>, sides: &mut Vec<Disc>) {
        let (radii, shifts) = (&self.joints.clump_radius, &self.joints.clump_shift);
        let fill = |discs: &mut Vec<Disc>, instance| {
            for object in &frame.objects {
                let joints = object.joints.clone().into_par_iter().with_min_len(CHUNK);
                discs.par_extend(joints.map(|i| {
                    let (radius, shift) = (radii[i], shifts[i]);
                    let [x, y, size] = clump_disc(instance, radius, shift).to_array();
                    let place = shift + vec2([x, y]);
                    let place = Vec2::new(place.x, place.y);
                    disc_at(frame, object.head, i, place, size, radius, 0.0)
                }));
            }
        };
        clumps.clear();
        fill(clumps, 0);
        sides.clear();
        if shifts.iter().any(|&shift| shift != vec2([0.0; 2])) {
            (1..CLUMP_DISCS).for_each(|instance| fill(sides, instance));
        }
    }

    /// The strokes of one layer on the joints `drawn`; `lists` are reused.
    fn layer(
        &mut self,
        frame: &Frame,
        object: &Object,
        layer: &Layer,
        drawn: &Range<usize>,
        (mut discs, mut colors): (Vec<Disc>, Vec<[f32; 3]>),
    ) -> LayerStrokes {
        self.fill_unit(frame, object.head, drawn, layer.units);
        let joints = drawn.len();
        let instances = layer.program.instances();
        let length = joints * instances as usize;
        discs.resize(length, NO_DISC);
        colors.resize(length, [0.0; 3]);
        let seed = layer_seed(object.seed, &layer.name);
        let mut parts = Vec::new();
        let lists = discs
            .chunks_mut(joints.max(1))
            .zip(colors.chunks_mut(joints.max(1)));
        for ((mut discs, mut colors), number) in lists.zip(0..instances) {
            for joints in pieces(frame.paths, drawn) {
                let (these, others) = discs.split_at_mut(joints.len());
                let (their_colors, other_colors) = colors.split_at_mut(joints.len());
                (discs, colors) = (others, other_colors);
                let part = Part {
                    frame,
                    head: object.head,
                    layer,
                    inputs: &self.joints,
                    joints,
                    seen_length: &self.seen_length,
                    seed,
                };
                parts.push((part, number, these, their_colors));
            }
        }
        parts.into_par_iter().for_each_init(
            Scratch::default,
            |scratch, (part, number, discs, colors)| part.evaluate(number, scratch, discs, colors),
        );
        LayerStrokes {
            name: layer.name.clone(),
            joints: drawn.clone(),
            rank: layer.rank,
            instances: instances as usize,
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
        let strands = || {
            let runs = paths.runs.iter();
            runs.flat_map(|run| run.joints.clone().map(|_| &frame.strands[run.strand]))
        };
        let points = paths.position.iter();
        let to_light = |point: &Vec3| frame.light.seen_from(*point);
        match input {
            Input::Position => joints.position.extend(points.map(world)),
            Input::Forward => joints.forward.extend(paths.forward.iter().map(world)),
            Input::Backward => joints.backward.extend(paths.backward.iter().map(world)),
            Input::U => joints.u.extend(&paths.u),
            Input::ArcLength => joints.arc_length.extend(&paths.arc_length),
            Input::Across => {
                let across = paths.across.iter().map(|v| vec2(v.to_array()));
                joints.across.extend(across);
            }
            Input::MaterialNormal => {
                let normals = frame.material_normals.iter().map(world);
                joints.material_normal.extend(normals);
            }
            Input::Strand => joints.strand.extend(strands().map(|s| s.id)),
            Input::Seed => joints.seed.extend(strands().map(|s| hash(s.id))),
            Input::StrandMean => joints.strand_mean.extend(strands().map(|s| world(&s.mean))),
            Input::StrandSize => joints.strand_size.extend(strands().map(|s| s.size)),
            // Empty where no strand has one.
            Input::StrandTaper if frame.strands.iter().all(|s| s.taper == NO_TAPER) => {}
            Input::StrandTaper => {
                let tapers = strands().map(|s| vec2(s.taper.to_array()));
                joints.strand_taper.extend(tapers);
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
                let directions = points.map(|p| world(&to_light(p).0));
                joints.light_direction.extend(directions);
            }
            Input::LightDistance => {
                for Object {
                    head, joints: own, ..
                } in &frame.objects
                {
                    let in_heads = |metres: f32| metres / head.height_m;
                    let points = paths.position[own.clone()].iter();
                    let distances = points.map(|p| to_light(p).1.map_or(FAR_LIGHT, in_heads));
                    joints.light_distance.extend(distances);
                }
            }
            Input::Depth => {
                for Object {
                    head, joints: own, ..
                } in &frame.objects
                {
                    let depths = paths.depth[own.clone()].iter();
                    joints
                        .depth
                        .extend(depths.map(|depth| depth / head.height_m));
                }
            }
            Input::Time => joints.time.resize(paths.len(), frame.time_s),
            Input::ViewDirection => {
                let eye = frame.camera.eye();
                let to_eye = points.map(|p| world(&(eye - *p).normalize_or(Vec3::Z)));
                joints.view_direction.extend(to_eye);
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
            let starts: Vec<usize> = object.joints.clone().step_by(CHUNK).collect();
            let made = starts.into_par_iter().flat_map_iter(|start| {
                let range = start..(start + CHUNK).min(object.joints.end);
                let mut clumps = Vec::with_capacity(range.len());
                object.clump.for_each(joints, range, seed, |i, params| {
                    clumps.push(clump::Program::clump(joints, i, seed, params));
                });
                clumps
            });
            clumps.par_extend(made);
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
            let lit = clumps.iter().zip(light_direction);
            gray.extend(lit.map(|(clump, light)| clump.normal.dot(*light).0.max(0.0)));
        }
        if read.has(Input::Normal) {
            normal.extend(clumps.iter().map(|clump| clump.normal));
        }
        if read.has(Input::ClumpColor) {
            clump_color.extend(clumps.iter().map(|clump| clump.color));
        }
        clump_radius.extend(clumps.iter().map(|clump| clump.radius));
        let on_screen = |clump: &Clump| {
            let shift = Vec3::from(clump.shift.to_array());
            let view = frame.camera.view_from_world_direction(shift);
            vec2([view.x, -view.y])
        };
        clump_shift.extend(clumps.iter().map(on_screen));
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

/// What clumps and active layers read of joints.
fn inputs(frame: &Frame) -> InputSet {
    let read = (frame.objects.iter())
        .map(Object::inputs)
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
    radii: Vec<f32>,
    places: Vec<f32>,
    smoother: Smoother,
}

/// Some neighbouring joints of a layer.
struct Part<'a> {
    frame: &'a Frame<'a>,
    head: Head,
    layer: &'a Layer,
    inputs: &'a Joints,
    joints: Range<usize>,
    seen_length: &'a [f32],
    seed: u32,
}

impl Part<'_> {
    /// Makes stroke `number` of each run, a disc and a colour for every one of the joints.
    fn evaluate(
        &self,
        number: u32,
        scratch: &mut Scratch,
        discs: &mut [Disc],
        colors: &mut [[f32; 3]],
    ) {
        let (frame, layer, inputs) = (self.frame, self.layer, self.inputs);
        let (program, joints) = (&layer.program, self.joints.clone());
        scratch.strokes.clear();
        program.evaluate(
            inputs,
            joints.clone(),
            number,
            self.seed,
            &mut scratch.strokes,
        );
        scratch.strokes.iter_mut().for_each(drop_if_not_finite);
        self.smooth(scratch);
        let made = discs.iter_mut().zip(colors).zip(&scratch.strokes);
        for (i, ((disc, color), stroke)) in joints.zip(made) {
            let offset = inputs.clump_shift[i] + stroke.offset;
            let offset = Vec2::new(offset.x, offset.y);
            let depth_offset = layer.depth_offset + stroke.depth_offset;
            let (radius, clump_radius) = (stroke.radius, inputs.clump_radius[i]);
            *disc = disc_at(
                frame,
                self.head,
                i,
                offset,
                radius,
                clump_radius,
                depth_offset,
            );
            *color = stroke.color.to_array();
        }
        if frame.brush == Brush::Semicircle {
            self.go_around_flat_ends(&scratch.strokes, discs);
        }
    }

    /// Moves the tips of strokes that are wider than their clump on by what they are wider, or an outline
    /// would end where its clump does.
    fn go_around_flat_ends(&self, strokes: &[Stroke], discs: &mut [Disc]) {
        let paths = self.frame.paths;
        let tips = self.runs().iter().map(|run| run.joints.end - 1);
        for tip in tips.filter(|&tip| paths.u[tip] == 1.0) {
            let place = tip - self.joints.start;
            let wider = (strokes[place].radius - self.inputs.clump_radius[tip]).max(0.0);
            let unit_px = self.head.unit_m() * paths.px_per_metre[tip];
            // The path on the screen, of which `across` is a right angle to the right.
            let ahead = -paths.across[tip].perp();
            discs[place].center += ahead * (wider * unit_px).min(LARGEST_PX);
        }
    }

    /// Their runs.
    fn runs(&self) -> &[PathRun] {
        runs_of(self.frame.paths, &self.joints)
    }

    /// Takes stretches and gaps of the strokes that are too short away, as they are seen: hair that
    /// points at the eye would show long ones as dots.
    fn smooth(&self, scratch: &mut Scratch) {
        let length_m = self.layer.program.shortest() * self.head.height_m;
        if length_m <= 0.0 {
            return;
        }
        let Scratch {
            strokes,
            radii,
            places,
            smoother,
        } = scratch;
        let start = self.joints.start;
        // Pieces of one strand together, and what they share once.
        for pieces in self.runs().chunk_by(|_, next| next.overlap > 0) {
            let joints = || {
                let own = |run: &PathRun| run.joints.start + run.overlap..run.joints.end;
                pieces.iter().flat_map(own)
            };
            radii.clear();
            radii.extend(joints().map(|i| strokes[i - start].radius.max(0.0)));
            places.clear();
            places.extend(joints().map(|i| self.seen_length[i]));
            smoother.smooth(places, radii, length_m);
            for (i, radius) in joints().zip(radii.iter()) {
                strokes[i - start].radius = *radius;
            }
            for piece in pieces {
                let shared = piece.joints.start..piece.joints.start + piece.overlap;
                for i in shared {
                    strokes[i - start].radius = strokes[i - piece.overlap - start].radius;
                }
            }
        }
    }
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
/// depth offset orders strands, and must not push an outline into the face behind it.
fn disc_at(
    frame: &Frame,
    head: Head,
    joint: usize,
    offset: Vec2,
    radius: f32,
    clump_radius: f32,
    depth_offset: f32,
) -> Disc {
    let unit_m = head.unit_m();
    let unit_px = unit_m * frame.paths.px_per_metre[joint];
    // No depth is nearer than the near plane, whatever is taken from it.
    let nearest = frame.camera.near_m();
    let depth = frame.paths.depth[joint];
    let shifted = (depth + depth_offset * head.height_m).max(nearest);
    let biased = (depth - clump_radius * unit_m).max(nearest);
    Disc {
        center: frame.paths.center[joint] + offset * unit_px,
        radius: (radius.max(0.0) * unit_px).min(LARGEST_PX),
        inv_depth: 1.0 / shifted,
        inv_depth_biased: 1.0 / biased,
    }
}

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
        *stroke = Stroke {
            offset: vec2([0.0; 2]),
            radius: 0.0,
            depth_offset: 0.0,
            color: vec3([0.0; 3]),
        };
    }
}
