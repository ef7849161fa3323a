//! A frame, or a drawing whose strokes are made already, as the words that a graphics card reads.

use super::atlas::images_of;
use super::layout::{CHUNK, DISC_BYTES, JointLayout, Needs};
use super::program::{LAYER_WORDS, PAINT_WORD};
use crate::brushwork::Brushwork;
use crate::drawing::{Coverage, Decal, Disc, Drawing, Surface};
use crate::features::{Feature, Features};
use crate::frame::{Frame, Head, Object, layer_bit};
use crate::mesh_paint::PaintedMeshes;
use crate::painting;
use effects::{
    CLUMP_DISCS, Image, Input, InputSet, Layer, PaintSource, Texture, Units, layer_seed,
};
use std::ops::Range;
use std::sync::Arc;

/// Words of a stroke's record in the tables.
const STROKE_WORDS: usize = 4;
/// Words of a surface's record in the tables, as `shaders/gpu/drawn.wgsl` has it.
const SURFACE_WORDS: usize = 13;
/// Words of a decal's record in the tables, as `shaders/gpu/decals.wgsl` has it.
const DECAL_WORDS: usize = 4;
/// Words that say where a list of strokes is, as `shaders/gpu/drawn.wgsl` reads them.
const LIST_WORDS: usize = 3;
/// Stands where a list has no stroke's record: the tables begin with the lists.
const NO_STROKE: u32 = 0;

/// A frame taken apart. Keeps its lists from frame to frame.
#[derive(Default)]
pub(super) struct SceneWords {
    pub(super) layout: JointLayout,
    pub(super) joints: Vec<u32>,
    pub(super) strands: Vec<u32>,
    pub(super) chunks: Vec<u32>,
    pub(super) tables: Vec<u32>,
    pub(super) surfaces_at: u32,
    /// Where those of strokes begin, after the clump's.
    strokes_at: usize,
    /// Where the tables tell which pieces are one strand, 0 where they don't.
    pub(super) same_strands_at: u32,
    /// How many strokes have a negative rank: they come first.
    pub(super) outlines: u32,
    pub(super) corners: Vec<u32>,
    pub(super) triangles: Vec<u32>,
    pub(super) clumps: Vec<ClumpScene>,
    /// Those of all objects, in their order.
    pub(super) layers: Vec<LayerScene>,
    /// The words of each layer for meshes; empty where there are none, and then so is what follows.
    pub(super) mesh_layers: Vec<Vec<u32>>,
    /// What they know of surfaces.
    pub(super) meshes: Vec<u32>,
    /// Discs of all strokes, the clump's first.
    pub(super) discs: usize,
    /// The discs themselves, of a drawing; empty for a frame, whose discs the card makes.
    pub(super) disc_words: Vec<u32>,
    /// The layers' brushes.
    pub(super) brushwork: Brushwork,
    seen_length: Vec<f32>,
}

/// An object's clump in a frame.
#[derive(Default)]
pub(super) struct ClumpScene {
    /// What it is, then its parameters.
    pub(super) words: Vec<u32>,
    /// Joints of the object.
    pub(super) joints: usize,
}

/// A layer in a frame.
#[derive(Default)]
pub(super) struct LayerScene {
    /// What it is, then its parameters.
    pub(super) words: Vec<u32>,
    /// The object that it is a layer of.
    pub(super) object: usize,
    /// The first of its discs.
    pub(super) first_disc: usize,
    /// The first joint that it draws on, and how many.
    pub(super) first_joint: usize,
    pub(super) joints: usize,
    pub(super) instances: u32,
    pub(super) is_smoothed: bool,
}

/// A layer's place among the strokes.
struct Placed {
    rank: i32,
    layer: usize,
    instances: u32,
    joints: Range<usize>,
    first_disc: usize,
    /// Its place among the decals, if it is one.
    decal: Option<usize>,
}

/// Where a layer draws, for a run.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Drawn {
    Here,
    /// On other runs of the strand alone. Strokes that go on from run to run have one place in all their lists, by which the card
    /// finds them where strokes are drawn one after the other ([`Order::Shifted`](crate::Order::Shifted)).
    Beside,
    Nowhere,
}

impl Drawn {
    /// Where a layer on whole runs, the joints `of_layer`, draws for the run `joints` of the strand `whole`.
    fn on(joints: &Range<usize>, whole: &Range<usize>, of_layer: &Range<usize>) -> Self {
        let shares =
            |joints: &Range<usize>| joints.start.max(of_layer.start) < joints.end.min(of_layer.end);
        if shares(joints) {
            Self::Here
        } else if shares(whole) {
            Self::Beside
        } else {
            Self::Nowhere
        }
    }
}

impl SceneWords {
    /// Takes the frame apart, in place of the one before, so that samples can tell these features.
    pub(super) fn fill(&mut self, frame: &Frame, tells: Features) {
        let is_smoothed = |layer: &Layer| layer.program.shortest() > 0.0;
        let mut layers = frame.objects.iter().flat_map(|object| object.layers);
        let needs = Needs {
            inputs: (frame.objects.iter())
                .map(|object| object.inputs().union(painting::inputs(object)))
                .fold(joint_inputs(tells), InputSet::union),
            has_material_normals: !frame.material_normals.is_empty(),
            is_smoothed: layers.any(is_smoothed),
            is_semicircle: frame.brush == crate::Brush::Semicircle,
            has_pieces: tells.has(Feature::Piece),
        };
        self.layout = JointLayout::new(needs);
        self.seen_length.clear();
        if needs.is_smoothed {
            crate::frame::seen_lengths(frame.paths, &mut self.seen_length);
        }
        self.layout.fill(frame, &self.seen_length, &mut self.joints);
        self.fill_strands(frame);
        self.fill_clumps(frame);
        let placed = self.fill_layers(frame);
        self.disc_words.clear();
        let runs = frame.paths.runs.iter();
        let runs = runs.map(|run| (run.piece as u32, run.joints.clone()));
        self.fill_chunks_and_tables(runs, &placed, frame.paths.len());
        let mut same_strands = Vec::new();
        crate::frame::fill_same_strands(frame, &mut same_strands);
        self.fill_decals(&frame.decals, &same_strands);
        self.brushwork.fill(frame);
        let images = self.fill_surfaces(&frame.surfaces);
        self.fill_brushes(&placed, &images);
        self.fill_meshes(frame);
    }

    /// Takes a checked drawing apart, in place of the frame before.
    pub(super) fn fill_drawing(&mut self, drawing: &Drawing) {
        self.clumps.clear();
        self.layers.clear();
        self.mesh_layers.clear();
        self.meshes.clear();
        self.disc_words.clear();
        let joints = drawing.clump.len();
        let black = [0.0; 3];
        let clumps = drawing.clump.iter();
        clumps.for_each(|disc| self.disc_words.extend(disc_words(disc, black)));
        for side in 0..CLUMP_DISCS as usize - 1 {
            self.begin_stroke(joints);
            for stretch in drawing.side_on(side, &(0..joints)) {
                let discs = &drawing.sides[stretch.places()];
                let discs = discs.iter().map(|disc| (disc, black));
                self.put_discs(joints - stretch.joints.start, discs);
            }
        }
        self.discs = joints * CLUMP_DISCS as usize;
        let mut placed = Vec::new();
        for (layer, strokes) in drawing.layers.iter().enumerate() {
            placed.push(Placed {
                rank: strokes.rank,
                layer,
                instances: strokes.instances as u32,
                joints: strokes.joints.clone(),
                first_disc: self.discs,
                decal: place_of(&drawing.decals, layer),
            });
            let count = strokes.joints.len();
            self.discs += count * strokes.instances;
            for instance in 0..strokes.instances {
                self.begin_stroke(count);
                for stretch in strokes.on(instance, &strokes.joints) {
                    let (places, first) = (stretch.places(), stretch.joints.start);
                    let discs = strokes.discs[places.clone()].iter();
                    let discs = discs.zip(strokes.colors[places].iter().copied());
                    self.put_discs(strokes.joints.end - first, discs);
                }
            }
        }
        placed.sort_by_key(|p| (p.rank, p.layer));
        let runs = drawing.runs.iter();
        let runs = runs.map(|run| (run.strand, run.joints.clone()));
        self.fill_chunks_and_tables(runs, &placed, joints);
        self.fill_decals(&drawing.decals, &drawing.same_strands);
        self.brushwork.clone_from(&drawing.brushwork);
        let images = self.fill_surfaces(&drawing.surfaces);
        self.fill_brushes(&placed, &images);
    }

    /// Adds a stroke without size on that many joints.
    fn begin_stroke(&mut self, joints: usize) {
        let words = self.disc_words.len() + joints * DISC_BYTES as usize / 4;
        self.disc_words.resize(words, 0);
    }

    /// Puts discs into the stroke that was added last, from its `behind`th joint from the end on.
    fn put_discs<'a>(&mut self, behind: usize, discs: impl Iterator<Item = (&'a Disc, [f32; 3])>) {
        const WORDS: usize = DISC_BYTES as usize / 4;
        let start = self.disc_words.len() - behind * WORDS;
        for (words, (disc, color)) in self.disc_words[start..].chunks_mut(WORDS).zip(discs) {
            words.copy_from_slice(&disc_words(disc, color));
        }
    }

    fn fill_strands(&mut self, frame: &Frame) {
        self.strands.clear();
        for strand in frame.strands {
            let [x, y, z] = strand.mean.to_array();
            let [root_size, shrink_start] = strand.taper.to_array();
            let numbers = [x, y, z, strand.size, root_size, shrink_start, strand.lift];
            let numbers = numbers.map(f32::to_bits);
            self.strands.push(strand.id);
            self.strands.extend(numbers);
            let colors = strand.colors.iter().flat_map(|color| color.to_array());
            self.strands.extend(colors.map(f32::to_bits));
            self.strands.push(strand.level);
            self.strands.push(strand.left_out_by);
        }
    }

    /// The clumps' own words.
    fn fill_clumps(&mut self, frame: &Frame) {
        self.clumps
            .resize_with(frame.objects.len(), Default::default);
        for (object, scene) in frame.objects.iter().zip(&mut self.clumps) {
            scene.joints = object.joints.len();
            scene.words.clear();
            let (seed, joints) = (layer_seed(object.seed, "clump"), &object.joints);
            let [first, count] = [joints.start, joints.len()].map(|number| number as u32);
            scene.words.extend([seed, 0, first, count, 0, 0, 0, 0]);
            push_head(&mut scene.words, object.head, 0, object.surface_bias_m);
            scene.words.extend(object.clump.source().words);
        }
    }

    /// The layers' own words, and their places in the order of strokes.
    fn fill_layers(&mut self, frame: &Frame) -> Vec<Placed> {
        let of_object = |object: &Object| object.layers.len();
        let count = frame.objects.iter().map(of_object).sum();
        self.discs = frame.paths.len() * CLUMP_DISCS as usize;
        self.layers.resize_with(count, Default::default);
        let mut placed = Vec::new();
        let objects = frame.objects.iter().enumerate();
        let layers = objects.flat_map(|(number, object)| {
            let layers = object.layers.iter().zip(object.layer_joints).enumerate();
            layers
                .map(move |(of_object, (layer, joints))| (number, object, of_object, layer, joints))
        });
        for (index, (number, object, of_object, layer, joints)) in layers.enumerate() {
            let scene = &mut self.layers[index];
            let shortest = layer.program.shortest();
            scene.joints = joints.len();
            scene.instances = layer.program.instances();
            scene.is_smoothed = shortest > 0.0;
            let first_disc = self.discs;
            (scene.object, scene.first_disc) = (number, first_disc);
            scene.first_joint = joints.start;
            let discs = scene.joints * scene.instances as usize;
            self.discs += discs;
            scene.words.clear();
            scene.words.extend([
                layer_seed(object.seed, &layer.name),
                // As if the frame's first joint had a disc: wrapping, as the shader's sums are.
                (first_disc as u32).wrapping_sub(joints.start as u32),
                joints.start as u32,
                scene.joints as u32,
                shortest.to_bits(),
                layer.depth_offset.to_bits(),
                u32::from(layer.units == Units::Pixels),
                u32::from(layer.program.has_own_paths()),
            ]);
            let bit = layer_bit(of_object);
            push_head(&mut scene.words, object.head, bit, object.surface_bias_m);
            let source = layer.program.source();
            scene.words.extend(source.words);
            if let Some(paint) = source.paint {
                let eye_to_head = frame.camera.view_from_world(object.head.center).z;
                let head_depth = eye_to_head / object.head.height_m;
                push_paint(&mut scene.words, discs as u32, head_depth, &paint);
            }
            placed.push(Placed {
                rank: layer.rank,
                layer: index,
                instances: scene.instances,
                joints: joints.clone(),
                first_disc,
                decal: place_of(&frame.decals, index),
            });
        }
        // As they lie, low first; instances of a layer follow each other.
        placed.sort_by_key(|p| (p.rank, p.layer));
        placed
    }

    /// Bytes of all discs.
    pub(super) fn disc_bytes(&self) -> u64 {
        self.discs as u64 * DISC_BYTES
    }

    /// Pieces of runs, and which strokes each has.
    fn fill_chunks_and_tables(
        &mut self,
        runs: impl Iterator<Item = (u32, Range<usize>)>,
        placed: &[Placed],
        joints: usize,
    ) {
        let clump_discs = CLUMP_DISCS as usize;
        // Runs that the same layers draw on share a list.
        let mut lists: Vec<Vec<Drawn>> = Vec::new();
        let mut last = None;
        self.chunks.clear();
        let mut runs = runs.peekable();
        let mut of_strand = Vec::new();
        while let Some((strand, first)) = runs.next() {
            of_strand.clear();
            of_strand.push(first);
            while let Some((_, joints)) = runs.next_if(|(next, _)| *next == strand) {
                of_strand.push(joints);
            }
            let whole = of_strand[0].start..of_strand[of_strand.len() - 1].end;
            for joints in &of_strand {
                let drawn = |p: &Placed| Drawn::on(joints, &whole, &p.joints);
                let is_as = |list: &Vec<Drawn>| placed.iter().map(drawn).eq(list.iter().copied());
                let list = match last {
                    Some(list) if is_as(&lists[list]) => list,
                    _ => lists.iter().position(is_as).unwrap_or_else(|| {
                        lists.push(placed.iter().map(drawn).collect());
                        lists.len() - 1
                    }),
                };
                last = Some(list);
                let segments = joints.len() - 1;
                for first in (0..segments.max(1)).step_by(CHUNK) {
                    self.chunks.extend([
                        strand,
                        (joints.start + first) as u32,
                        (segments - first).min(CHUNK) as u32,
                        list as u32,
                    ]);
                }
            }
        }

        // Of each list where it begins, how many strokes it has, and how many decals, which follow them.
        let records_of = |list: &[Drawn], decals: bool| -> Vec<Option<usize>> {
            let mut records: Vec<Option<usize>> = match decals {
                false => (0..clump_discs).map(Some).collect(),
                true => Vec::new(),
            };
            let mut number = clump_discs;
            for (p, drawn) in placed.iter().zip(list) {
                let numbers = number..number + p.instances as usize;
                number = numbers.end;
                if p.decal.is_some() != decals {
                    continue;
                }
                match drawn {
                    Drawn::Here => records.extend(numbers.map(Some)),
                    Drawn::Beside => records.extend(numbers.map(|_| None)),
                    Drawn::Nowhere => {}
                }
            }
            records
        };
        let lists = lists.iter();
        let lists = lists.map(|list| [false, true].map(|decals| records_of(list, decals)));
        let lists: Vec<[Vec<Option<usize>>; 2]> = lists.collect();
        let mut list_at = LIST_WORDS * lists.len();
        self.tables.clear();
        for [strokes, decals] in &lists {
            let words = [list_at, strokes.len(), decals.len()];
            self.tables.extend(words.map(|word| word as u32));
            list_at += strokes.len() + decals.len();
        }
        let record = |number: usize| (list_at + STROKE_WORDS * number) as u32;
        for records in lists.iter().flatten().flatten() {
            self.tables.push(records.map_or(NO_STROKE, record));
        }
        // The clump's discs begin at the buffer's start, those of one side after those of the other.
        for disc in 0..clump_discs {
            self.tables.extend([(disc * joints) as u32, 0, 0, 0]);
        }
        let strokes: usize = placed.iter().map(|p| p.instances as usize).sum();
        self.strokes_at = record(clump_discs) as usize;
        let outlines = placed.iter().filter(|p| p.rank < 0);
        self.outlines = outlines.map(|p| p.instances).sum();
        let decals_at = record(clump_discs + strokes);
        let mut number = 0;
        for p in placed {
            for instance in 0..p.instances as usize {
                number += 1;
                let first = (p.first_disc + instance * p.joints.len()) as u32;
                let first = first.wrapping_sub(p.joints.start as u32);
                let decal = p.decal.map_or(0, |p| decals_at + (DECAL_WORDS * p) as u32);
                let is_clipped = u32::from(p.rank >= 0);
                self.tables.extend([first, number, is_clipped, decal]);
            }
        }
    }

    /// The decals' records, which follow those of strokes, and which pieces are one strand.
    fn fill_decals(&mut self, decals: &[Decal], same_strands: &[u32]) {
        for decal in decals {
            let means = u32::from(decal.on_hair) | u32::from(decal.is_shadow) << 1;
            let words = [means, decal.reach_m.to_bits(), decal.marks, 0];
            self.tables.extend(words);
        }
        self.same_strands_at = 0;
        if !same_strands.is_empty() {
            self.same_strands_at = self.tables.len() as u32;
            self.tables.push(same_strands.len() as u32);
            self.tables.extend(same_strands);
        }
    }

    /// What `shaders/gpu/brushed.wgsl` knows of brushes and joints: their places go into the records of strokes and decals.
    fn fill_brushes(&mut self, placed: &[Placed], images: &[(Arc<Image>, u32)]) {
        let along = self.tables.len() as u32;
        for joint in &self.brushwork.joints {
            let numbers = [joint.s, joint.whole, joint.pixels].map(f32::to_bits);
            self.tables.extend(numbers);
            self.tables.push(joint.strand);
        }
        let mut stroke = self.strokes_at;
        let strokes: usize = placed.iter().map(|p| p.instances as usize).sum();
        let decals_at = stroke + STROKE_WORDS * strokes;
        for p in placed {
            let end = stroke + STROKE_WORDS * p.instances as usize;
            if let Some(layer) = self.brushwork.of_layer(p.layer) {
                let at = self.tables.len() as u32;
                let [first, count] = [p.joints.start, p.joints.len()].map(|joints| joints as u32);
                let length = layer.brush.length().unwrap_or(0.0).to_bits();
                let parts = layer.brush.parts().unwrap_or(0);
                let marks = layer.brush.marks();
                self.tables
                    .extend([layer.seed, p.first_disc as u32, first, count]);
                let is_outline = p.rank < 0 && p.decal.is_none();
                self.tables.extend([along, length, parts]);
                let is_shape = u32::from(layer.brush.is_shape());
                self.tables
                    .extend([u32::from(is_outline), is_shape, marks.len() as u32]);
                let place = |mark: &Arc<Image>| {
                    let image = images.iter().find(|(image, _)| Arc::ptr_eq(image, mark));
                    image.map_or(0, |(_, at)| *at)
                };
                self.tables.extend(marks.map(place));
                if let Some(decal) = p.decal {
                    self.tables[decals_at + DECAL_WORDS * (decal + 1) - 1] = at;
                } else {
                    for record in (stroke..end).step_by(STROKE_WORDS) {
                        self.tables[record + STROKE_WORDS - 1] = at;
                    }
                }
            }
            stroke = end;
        }
    }

    /// Says where the record of each picture begins.
    fn fill_surfaces(&mut self, surfaces: &[Surface]) -> Vec<(Arc<Image>, u32)> {
        self.surfaces_at = self.tables.len() as u32;
        self.corners.clear();
        self.triangles.clear();
        let records = self.tables.len();
        self.tables
            .resize(records + SURFACE_WORDS * surfaces.len(), 0);
        let images = self.push_images(surfaces);
        let records = (records..).step_by(SURFACE_WORDS);
        for ((surface, number), record) in surfaces.iter().zip(0..).zip(records) {
            let [[lr, lg, lb], [sr, sg, sb]] = surface.drawn_colors();
            let numbers = [lr, lg, lb, sr, sg, sb, surface.margin_m];
            self.tables[record..record + 7].copy_from_slice(&numbers.map(f32::to_bits));
            self.tables[record + SURFACE_WORDS - 1] = surface.marks;
            let first = self.corners.len() as u32 / 4;
            if let Some(texture) = &surface.texture {
                let image = images
                    .iter()
                    .find(|(image, _)| Arc::ptr_eq(image, &texture.image));
                let places = (self.tables.len() as u32).wrapping_sub(2 * first);
                let [means, cut] = match texture.coverage {
                    Coverage::Ignored => [0, 0],
                    Coverage::Cut(cut) => [1, cut.to_bits()],
                    Coverage::Share => [2, 0],
                };
                let image = image.map_or(0, |(_, at)| *at);
                let words = [image, places, u32::from(texture.repeats), means, cut];
                self.tables[record + 7..record + SURFACE_WORDS - 1].copy_from_slice(&words);
                let places = texture.places.iter().flat_map(|place| place.to_array());
                self.tables.extend(places.map(f32::to_bits));
            }
            for vertex in &surface.vertices {
                let [x, y] = vertex.position.to_array();
                let numbers = [x, y, vertex.inv_depth, vertex.tone];
                self.corners.extend(numbers.map(f32::to_bits));
            }
            for [a, b, c] in &surface.triangles {
                self.triangles
                    .extend([first + a, first + b, first + c, number]);
            }
        }
        images
    }

    /// What `shaders/gpu/mesh_main.wgsl` knows of layers and surfaces.
    fn fill_meshes(&mut self, frame: &Frame) {
        const RECORD: usize = 8;
        self.mesh_layers.clear();
        self.meshes.clear();
        if frame.mesh_layers.is_empty() {
            return;
        }
        let of_layers = frame.mesh_layers.iter().enumerate();
        self.mesh_layers.extend(of_layers.map(|(number, mesh)| {
            let painted = PaintedMeshes::new(mesh, frame.camera);
            let (number, through) = (number as u32 + 1, painted.through_hair.to_bits());
            let focal = frame.camera.focal_px().to_bits();
            let mut words = vec![painted.seed, number, through, focal, 0, 0, 0, 0];
            push_head(&mut words, mesh.head, 0, 0.0);
            let source = mesh.layer.program.source();
            words.extend(source.words);
            if let Some(paint) = source.paint {
                push_paint(&mut words, 0, painted.head_depth, &paint);
            }
            words
        }));
        let words = &mut self.meshes;
        words.resize(RECORD * frame.surfaces.len(), 0);
        let mut first_corner = 0;
        for (number, surface) in frame.surfaces.iter().enumerate() {
            if let Some(paint) = &surface.paint {
                let corners = (words.len() as u32).wrapping_sub(4 * first_corner);
                let colors = surface.light.iter().chain(&surface.shadow);
                let record = &mut words[RECORD * number..][..RECORD];
                record[0] = paint.layer + 1;
                for (word, color) in record[1..].iter_mut().zip(colors) {
                    *word = color.to_bits();
                }
                record[RECORD - 1] = corners;
                for (i, normal) in paint.normals.iter().enumerate() {
                    let occlusion = paint.occlusion.get(i).copied().unwrap_or(0.0);
                    words.extend(normal.extend(occlusion).to_array().map(f32::to_bits));
                }
            }
            first_corner += surface.vertices.len() as u32;
        }
    }

    /// Adds the records of the surfaces' and brushes' pictures to the tables, and says where each begins.
    fn push_images(&mut self, surfaces: &[Surface]) -> Vec<(Arc<Image>, u32)> {
        let mut next = 0;
        let push = |image: &Arc<Image>| {
            let at = self.tables.len() as u32;
            self.tables.push(image.levels() as u32);
            for level in 0..image.levels() {
                let ([width, height], texels) = image.level(level);
                self.tables.extend([width as u32, height as u32, next]);
                next += texels.len() as u32;
            }
            (image.clone(), at)
        };
        let images = images_of(surfaces, &self.brushwork);
        images.into_iter().map(push).collect()
    }
}

/// The place of a layer among the decals.
fn place_of(decals: &[Decal], layer: usize) -> Option<usize> {
    decals.iter().position(|decal| decal.layer == layer)
}

/// What `shaders/gpu/joint.wgsl` knows of an object's head, behind the words of a layer.
fn push_head(words: &mut Vec<u32>, head: Head, layer_bit: u32, surface_bias_m: f32) {
    let [x, y, z] = head.center.to_array();
    words.extend([x, y, z, head.height_m, head.unit_m()].map(f32::to_bits));
    words.extend([0, layer_bit, surface_bias_m.to_bits()]);
    debug_assert_eq!(words.len(), LAYER_WORDS as usize);
}

/// Adds what `shaders/gpu/lookup.wgsl` knows of a layer and its textures, and notes where that begins.
fn push_paint(words: &mut Vec<u32>, discs: u32, head_depth: f32, paint: &PaintSource) {
    const TEXTURE_WORDS: usize = 3;
    words[PAINT_WORD] = words.len() as u32;
    words.extend([discs, head_depth.to_bits()]);
    let table = words.len();
    words.resize(table + TEXTURE_WORDS * paint.textures.len(), 0);
    for (place, (texture, repeats)) in (table..).step_by(TEXTURE_WORDS).zip(paint.textures) {
        let [kind, gradient] = match texture {
            Texture::None | Texture::File(_) => [0, 0],
            Texture::Ramp(ramp) => {
                let start = words.len() as u32;
                words.extend(ramp.words());
                [1, start]
            }
            Texture::Image { .. } => [2, 0],
        };
        words[place..place + TEXTURE_WORDS].copy_from_slice(&[kind, gradient, (*repeats).into()]);
    }
}

/// What is read of joints so that samples can tell these features.
fn joint_inputs(tells: Features) -> InputSet {
    let inputs: &[(Feature, &[Input])] = &[
        (Feature::U, &[Input::U]),
        (Feature::S, &[Input::ArcLength]),
        (Feature::Normal, &[Input::Forward, Input::Backward]),
    ];
    let needed = inputs.iter().filter(|(feature, _)| tells.has(*feature));
    needed.fold(InputSet::default(), |all, (_, inputs)| {
        all.union(InputSet::of(inputs))
    })
}

/// A `GpuDisc`.
fn disc_words(disc: &Disc, [red, green, blue]: [f32; 3]) -> [u32; DISC_BYTES as usize / 4] {
    let Disc {
        center,
        radius,
        inv_depth,
        inv_depth_biased,
    } = *disc;
    let numbers = [
        center.x,
        center.y,
        radius,
        inv_depth,
        red,
        green,
        blue,
        inv_depth_biased,
    ];
    numbers.map(f32::to_bits)
}
