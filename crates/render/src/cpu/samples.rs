//! What samples tell: a tile drawn four samples at a time, and for each of them the features that are declared.

use super::segment::{Segment, strokes_in_order};
use super::shown::{NOTHING, Planes, TRIANGLE};
use super::tile::{self, CELL_WIDTH, CELLS_ACROSS, STACK, Stack};
use super::{DrawError, Frame, Output, Rasterizer, Worker, empty_picture};
use crate::check;
use crate::drawing::Drawing;
use crate::features::{Feature, NO_ID, normal_of_triangle, object_of_hair, object_of_mesh};
use crate::picture::Picture;
use crate::planes::{BandPlanes, Sample, SamplePlanes};
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

impl Rasterizer {
    /// Draws the samples of a picture, each with the features that the drawing declares: up to four of every pixel at a time, which
    /// `take` is given, from the first to the last.
    ///
    /// They are those that [`Self::draw`] takes the means of. `planes` is working memory.
    ///
    /// # Errors
    ///
    /// When the drawing is invalid (see [`DrawError`]), or there isn't enough memory.
    pub fn draw_samples(
        &mut self,
        drawing: &Drawing,
        planes: &mut SamplePlanes,
        mut take: impl FnMut(&mut SamplePlanes) + Send,
    ) -> Result<(), DrawError> {
        let Self {
            pool,
            samples,
            stacks,
            parts,
            instructions,
            workers,
            planes: _,
        } = self;
        let mut draw = || {
            check::check(drawing)?;
            let strokes = strokes_in_order(drawing);
            let tile_height = tile::height(stacks);
            parts.collect(drawing, &strokes, stacks);
            let threads = rayon::current_num_threads();
            workers.resize_with(threads, || Mutex::new(Worker::new()));
            let runs_of_joints = runs_of_joints(drawing);
            let mut first = 0;
            for stack in stacks.iter() {
                let count = stack.samples / stack.height;
                let [width, height] = drawing.size;
                let declared = drawing.features.declared;
                planes
                    .reset(
                        drawing.size,
                        declared,
                        [first, count],
                        tile_height,
                        drawing.background,
                    )
                    .ok_or(DrawError::Memory(width, height))?;
                first += count;
                let frame = Frame {
                    drawing,
                    strokes: &strokes,
                    parts,
                    samples: *samples,
                    stacks: std::slice::from_ref(stack),
                    runs_of_joints: &runs_of_joints,
                };
                let declared = planes.declared;
                let [ids, numbers] = planes.of_band();
                let ids = planes.ids.par_chunks_mut(ids);
                let numbers = planes.numbers.par_chunks_mut(numbers);
                ids.zip(numbers)
                    .enumerate()
                    .for_each(|(band, (ids, numbers))| {
                        let thread = rayon::current_thread_index().unwrap_or(0);
                        let mut worker = workers[thread]
                            .lock()
                            .unwrap_or_else(PoisonError::into_inner);
                        let planes = BandPlanes {
                            width: width as usize,
                            declared,
                            band: tile_height,
                            ids,
                            numbers,
                        };
                        instructions.draw_band(&mut worker, &frame, band, Output::Samples(planes));
                    });
                take(planes);
            }
            Ok(())
        };
        match pool {
            Some(pool) => pool.install(draw),
            None => draw(),
        }
    }
}

impl Rasterizer {
    /// Draws a picture whose passes go over all its samples before their means are taken.
    pub(super) fn draw_with_passes(&mut self, drawing: &Drawing) -> Result<Picture, DrawError> {
        check::check(drawing)?;
        let samples = self.samples;
        let mut picture = empty_picture(drawing, samples)?;
        picture.pixels.fill([0.0; 4]);
        let mut planes = std::mem::take(&mut self.planes);
        let drawn = self.draw_samples(drawing, &mut planes, |planes| {
            for pass in &drawing.passes {
                pass.draw(planes, samples);
            }
            planes.add_to(&mut picture.pixels);
        });
        self.planes = planes;
        drawn?;
        let count = samples as f32;
        let pixels = picture.pixels.par_iter_mut().with_min_len(1024);
        pixels.for_each(|pixel| *pixel = pixel.map(|sum| sum / count));
        Ok(picture)
    }
}

/// For each joint of a checked drawing its run.
fn runs_of_joints(drawing: &Drawing) -> Vec<u32> {
    let mut runs_of_joints = vec![0; drawing.clump.len()];
    for (run, number) in drawing.runs.iter().zip(0..) {
        runs_of_joints[run.joints.clone()].fill(number);
    }
    runs_of_joints
}

impl Worker {
    /// Draws the samples of a band.
    #[inline(always)] // compiled for each set of `Instructions`
    pub(super) fn draw_samples(&mut self, frame: &Frame, band: usize, mut planes: BandPlanes) {
        let [width, height] = frame.drawing.size.map(|side| side as usize);
        let tiles = width.div_ceil(tile::WIDTH);
        let top = band * tile::height(frame.stacks);
        for tile in 0..tiles {
            let left = tile * tile::WIDTH;
            let triangles = frame.parts.triangles_of_tiles.bin(band * tiles + tile);
            let segments = self.segments_of_tiles.bin(tile);
            if triangles.is_empty() && segments.is_empty() {
                continue;
            }
            let scene = frame.tile_at([left, top]);
            scene.strands(segments, &mut self.parts);
            self.draw_stack::<true>(frame, &scene, tile, triangles);
            if !frame.drawing.painting.is_empty() {
                self.paint(frame);
            }
            let size = [(width - left).min(tile::WIDTH), height - top];
            self.tell(frame, size, left, &mut planes);
        }
    }

    /// Writes down what the samples of a tile at the column `left` show, of a tile as large as that.
    fn tell(
        &self,
        frame: &Frame,
        [width, height]: [usize; 2],
        left: usize,
        planes: &mut BandPlanes,
    ) {
        let Some(shown) = self.shown.planes() else {
            return;
        };
        let stack = &frame.stacks[0];
        let count = stack.samples / stack.height;
        for row in 0..height.min(tile::height(frame.stacks)) {
            for column in 0..width {
                for picture in 0..count {
                    let place = place_of(stack, row, column, picture, count);
                    if let Some(sample) = self.sample(frame, shown, place) {
                        planes.put(picture, left + column, row, &sample);
                    }
                }
            }
        }
    }

    /// What a sample of the tile shows, by its cell and lane; nothing where that is nothing.
    fn sample(&self, frame: &Frame, shown: &Planes, [cell, lane]: [usize; 2]) -> Option<Sample> {
        let what = shown.what[cell][lane];
        if what == NOTHING {
            return None;
        }
        let [red, green, blue] = &self.target.color;
        let color = [red, green, blue].map(|plane| plane[cell][lane].clamp(0.0, 1.0));
        let color = [color[0], color[1], color[2], 1.0];
        if what & TRIANGLE != 0 {
            let inv_depth = self.target.surface[cell][lane];
            return Some(frame.sample_of_triangle(what & !TRIANGLE, inv_depth, color));
        }
        let sample = Sample {
            inv_depth: self.target.strand[cell][lane],
            v: shown.v[cell][lane],
            w: shown.w[cell][lane],
            color,
            ..Sample::NOTHING
        };
        let segment = &frame.parts.segments.list()[what as usize];
        Some(frame.sample_of_strand(segment, shown.way[cell][lane], sample))
    }
}

/// Cell and lane of a sample of a pixel of a tile.
fn place_of(stack: &Stack, row: usize, column: usize, picture: usize, count: usize) -> [usize; 2] {
    let cell = row / stack.height * CELLS_ACROSS + column / CELL_WIDTH;
    let lane = column % CELL_WIDTH * STACK + row % stack.height * count + picture;
    [cell, lane]
}

impl Frame<'_> {
    /// The layer whose colour a segment has.
    pub(super) fn layer_of(&self, segment: &Segment) -> Option<usize> {
        let stroke = segment.colored().checked_sub(1)?;
        Some(self.strokes[stroke as usize].layer)
    }

    /// The painted layer that a segment shows, by its place among them.
    #[inline(always)]
    pub(super) fn painted_layer_of(&self, segment: &Segment) -> Option<usize> {
        let layer = self.layer_of(segment)?;
        let layers = &self.drawing.painting.layers;
        layers.iter().position(|painted| painted.layer == layer)
    }

    fn sample_of_triangle(&self, triangle: u32, inv_depth: f32, color: [f32; 4]) -> Sample {
        let triangle = &self.parts.triangles[triangle as usize];
        let features = &self.drawing.features;
        let surface = &self.drawing.surfaces[triangle.surface as usize];
        let corners = triangle.corners(self.drawing);
        let corners = corners.map(|corner| (corner.position, corner.inv_depth));
        let camera = features.camera.as_ref();
        let camera = camera.filter(|_| features.declared.has(Feature::Normal));
        Sample {
            object: object_of_mesh(surface.mesh),
            inv_depth,
            color,
            normal: camera.map_or(Sample::NOTHING.normal, |camera| {
                normal_of_triangle(camera, corners)
            }),
            ..Sample::NOTHING
        }
    }

    /// Adds to a sample what the axis of a stroke tells at the way `way` along a segment.
    fn sample_of_strand(&self, segment: &Segment, way: f32, sample: Sample) -> Sample {
        let (drawing, features) = (self.drawing, &self.drawing.features);
        let [joint, next] = segment.joints();
        let run = self.runs_of_joints[joint] as usize;
        let info = &features.runs[run];
        let layer = self.layer_of(segment).map_or(NO_ID, |layer| layer as u32);
        // Of what isn't declared the list is empty.
        let mixed = |list: &[f32]| match (list.get(joint), list.get(next)) {
            (Some(a), Some(b)) => a + way * (b - a),
            _ => 0.0,
        };
        let is_normal_told = features.declared.has(Feature::Normal);
        Sample {
            object: object_of_hair(info.object),
            strand: info.strand,
            piece: drawing.runs[run].strand,
            layer,
            level: info.level,
            u: mixed(&features.u),
            s: mixed(&features.s),
            pixels: mixed(&features.pixels),
            normal: match is_normal_told {
                true => features.normal_of_hair(joint, next, way, sample.w),
                false => sample.normal,
            },
            ..sample
        }
    }
}
