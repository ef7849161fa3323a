//! Draws frames on a device, in somebody's command encoder.

use super::adapter::check_limits;
use super::buffer::{Buffers, Growing};
use super::compose::{Composer, PassFormat};
use super::error::GpuError;
use super::layout::{CLUMP_BYTES, GpuFrame, TILE, WORKGROUP};
use super::programs::Programs;
use super::report::Report;
use super::scene::SceneWords;
use crate::check;
use crate::drawing::Drawing;
use crate::frame::Frame;
use crate::samples::sample_positions;
use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, Device, Queue};

/// What a renderer has, and what its last frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GpuStats {
    /// Pipelines alive.
    pub pipelines: usize,
    /// Buffers alive.
    pub buffers: usize,
    /// Their bytes.
    pub bytes: u64,
    /// Buffers and pipelines that the last frame had to make: none once warm.
    pub made: usize,
    /// Whether the tiles' lists were too short in the last frame that was read back: it took longer, and was drawn as
    /// it should be. The next one's are longer.
    pub lists_were_short: bool,
    /// Milliseconds on the card of the last frame that was read back: strokes, sorting into tiles, tiles. Of devices with
    /// timestamps alone.
    pub milliseconds: Option<[f64; 3]>,
}

/// What is drawn.
#[derive(Clone, Copy)]
pub(super) enum Source<'a> {
    /// Joints, of which strokes are made.
    Frame(&'a Frame<'a>),
    /// Strokes.
    Drawing(&'a Drawing),
}

/// What is kept of a drawn frame.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Keeps {
    /// The mean of each pixel.
    Means,
    /// Every sample's colour and depth.
    Samples,
}

/// Draws frames on a device. Long-lived: it keeps pipelines and buffers from frame to frame.
pub struct Renderer {
    device: Device,
    queue: Queue,
    scene: SceneWords,
    buffers: Buffers,
    programs: Programs,
    groups: Option<Groups>,
    composer: Option<Composer>,
    /// Entries that the tiles' lists needed in the last frame that is known of: chunks, triangles.
    entries_needed: [u32; 2],
    /// Lengths of the tiles' lists in the frame that the report is of, in entries.
    list_capacity: [u32; 2],
    report: Report,
    stats: GpuStats,
}

/// Refuses what no compute shader draws yet.
fn check_supported(frame: &Frame) -> Result<(), GpuError> {
    let mut layers = frame.objects.iter().flat_map(|object| object.layers);
    if let Some(layer) = layers.find(|layer| layer.program.paints().is_some()) {
        let what = format!("the layer \"{}\", which paints samples,", layer.name);
        return Err(GpuError::Unsupported(what));
    }
    if !frame.passes.is_empty() {
        return Err(GpuError::Unsupported("the section `passes`".to_owned()));
    }
    Ok(())
}

/// What the passes bind. Made anew where a buffer is.
struct Groups {
    clumps: Vec<BindGroup>,
    layers: Vec<(BindGroup, Option<BindGroup>)>,
    bins: BindGroup,
    tiles: BindGroup,
}

impl Renderer {
    /// A renderer on a device.
    ///
    /// # Errors
    ///
    /// When the device's limits are too small, or its driver refuses a shader.
    pub fn new(device: &Device, queue: &Queue) -> Result<Self, GpuError> {
        check_limits(device)?;
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            scene: SceneWords::default(),
            buffers: Buffers::new(),
            programs: Programs::new(device)?,
            groups: None,
            composer: None,
            entries_needed: [0; 2],
            list_capacity: [0; 2],
            report: Report::new(device, queue),
            stats: GpuStats::default(),
        })
    }

    /// What the renderer has, and what its last frame took.
    #[must_use]
    pub fn stats(&self) -> GpuStats {
        let buffers = self.buffers.all().into_iter();
        let programs = self.programs.clumps.iter().chain(&self.programs.layers);
        let buffers = buffers.chain(programs.map(|program| &program.words));
        let alive = buffers.filter(|buffer| buffer.size() > 0);
        GpuStats {
            pipelines: self.programs.count() + usize::from(self.composer.is_some()),
            buffers: alive.clone().count(),
            bytes: alive.map(Growing::size).sum(),
            ..self.stats
        }
    }

    /// Makes a frame ready for [`Self::render`] in a pass of that format, with `samples` a pixel: records compute passes in
    /// `encoder`, and writes the buffers that they read. `encoder` is to be submitted before, or as, that of
    /// the pass.
    ///
    /// # Errors
    ///
    /// When the frame is invalid, is larger than the device allows, or the driver refuses a shader; when there can be no such pass, or it
    /// has neither one sample nor as many as are prepared. Then nothing was recorded, and [`Self::render`] draws nothing.
    pub fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame,
        samples: u32,
        pass: PassFormat,
    ) -> Result<(), GpuError> {
        let before = self.composer.take();
        pass.check(self.device.features())?;
        if pass.samples != 1 && pass.samples != samples {
            return Err(GpuError::PassSamples {
                pass: pass.samples,
                prepared: samples,
            });
        }
        let mut composer = match before {
            Some(composer) if composer.fits(&pass) => composer,
            _ => Composer::new(&self.device, pass)?,
        };
        let is_new = self.draw(encoder, Source::Frame(frame), samples, Keeps::Samples)?;
        let buffers = &self.buffers;
        let (Some(frame), Some(drawn)) = (buffers.frame.get(), buffers.picture.get()) else {
            return Err(GpuError::Memory);
        };
        composer.prepare(&self.device, &self.queue, pass, [frame, drawn], is_new)?;
        self.composer = Some(composer);
        Ok(())
    }

    /// Puts the prepared frame into a pass of the format that it was prepared for, over the upper left part of it that is as
    /// large as the frame's picture: where hair and head are, in front of what is farther there and behind what is nearer.
    /// They leave their depth, for what is drawn after them.
    pub fn render(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(composer) = &self.composer {
            composer.render(pass);
        }
    }

    /// Records a picture: [`Self::picture`] holds its pixels once the encoder has been submitted.
    pub(super) fn draw_picture(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        source: Source,
        samples: u32,
    ) -> Result<(), GpuError> {
        self.draw(encoder, source, samples, Keeps::Means)
            .map(|_| ())
    }

    /// The drawn pixels: red, green, blue and alpha.
    pub(super) fn picture(&self) -> Option<&wgpu::Buffer> {
        self.buffers.picture.get()
    }

    /// Records all passes of a frame. Whether there are other buffers than before.
    fn draw(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        source: Source,
        samples: u32,
        keeps: Keeps,
    ) -> Result<bool, GpuError> {
        let places = sample_positions(samples)?;
        self.stats.made = 0;
        self.read_report();
        let (size, order, settings) = match source {
            Source::Frame(frame) => {
                let size = frame.camera.size_px();
                frame.check()?;
                check_supported(frame)?;
                self.scene.fill(frame);
                self.follow(frame)?;
                (size, frame.order, GpuFrame::of_frame(frame))
            }
            Source::Drawing(drawing) => {
                check::check(drawing)?;
                self.scene.fill_drawing(drawing);
                self.programs.clumps.clear();
                self.programs.layers.clear();
                self.groups = None;
                let settings = GpuFrame::of_drawing(drawing);
                (drawing.size, drawing.order, settings)
            }
        };
        self.stats.made += self.programs.draw_in(&self.device, order)?;

        let tiles = size.map(|side| side.div_ceil(TILE));
        let tile_count = u64::from(tiles[0]) * u64::from(tiles[1]);
        let [chunk_capacity, triangle_capacity] = self.capacities(tile_count);
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let values = match keeps {
            Keeps::Means => pixels,
            Keeps::Samples => pixels * u64::from(samples),
        };
        let settings = GpuFrame {
            size,
            tiles,
            chunks: self.scene.chunks.len() as u32 / 4,
            triangles: self.scene.triangles.len() as u32 / 4,
            samples,
            chunk_capacity,
            triangle_capacity,
            surfaces_at: self.scene.surfaces_at,
            writes_samples: u32::from(keeps == Keeps::Samples),
            ..settings
        };
        self.write_buffers(&settings, &places, tile_count, values * 16)?;
        let is_new = self.groups.is_none();
        let groups = match self.groups.take() {
            Some(groups) => groups,
            None => self.make_groups()?,
        };
        if self.report.is_free() {
            self.list_capacity = [chunk_capacity, triangle_capacity];
        }
        self.record(encoder, &groups, &settings);
        self.groups = Some(groups);
        Ok(is_new)
    }

    /// Capacities of the tiles' lists, in entries: what the last frame needed and half as much, or a
    /// guess. A tile whose list is full looks at everything, so that a guess that is too low costs time alone.
    fn capacities(&self, tiles: u64) -> [u32; 2] {
        let chunks = self.scene.chunks.len() as u64 / 4;
        let triangles = self.scene.triangles.len() as u64 / 4;
        let guess = [chunks * (8 + tiles / 128), triangles * 4 + 4 * tiles];
        let limits = self.device.limits();
        let most = limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size)
            / 4
            / 8;
        [0, 1].map(|i| {
            let needed = u64::from(self.entries_needed[i]);
            let wanted = if needed > 0 {
                (needed + needed / 2).max(guess[i].min(4096))
            } else {
                guess[i]
            };
            wanted.clamp(64, most.min(1 << 30)) as u32
        })
    }

    /// Makes and drops what other layers than before need.
    fn follow(&mut self, frame: &Frame) -> Result<(), GpuError> {
        // Should a shader be refused, what was bound is of layers that are gone.
        let groups = self.groups.take();
        let change = self.programs.follow(&self.device, frame, &self.scene)?;
        self.stats.made += change.made;
        self.groups = groups.filter(|_| !change.rebinds);
        if self.programs.smooth.is_none() {
            self.buffers.windows.drop_buffer();
        }
        Ok(())
    }

    fn write_buffers(
        &mut self,
        settings: &GpuFrame,
        places: &[glam::Vec2],
        tile_count: u64,
        picture_bytes: u64,
    ) -> Result<(), GpuError> {
        let Self {
            device,
            queue,
            scene,
            buffers,
            programs,
            ..
        } = self;
        let mut made = 0;
        let mut note = |is_new: bool| made += usize::from(is_new);
        let mut sample_words = [0.0_f32; 512];
        for (pair, place) in sample_words.chunks_exact_mut(2).zip(places) {
            pair.copy_from_slice(&place.to_array());
        }
        let settings: &[u32] = bytemuck::cast_slice(std::slice::from_ref(settings));
        note(buffers.frame.write(device, queue, settings)?);
        let sample_words = bytemuck::cast_slice(&sample_words);
        note(buffers.sample_places.write(device, queue, sample_words)?);
        note(buffers.joints.write(device, queue, &scene.joints)?);
        note(buffers.strands.write(device, queue, &scene.strands)?);
        note(buffers.chunks.write(device, queue, &scene.chunks)?);
        note(buffers.tables.write(device, queue, &scene.tables)?);
        note(buffers.corners.write(device, queue, &scene.corners)?);
        note(buffers.triangles.write(device, queue, &scene.triangles)?);
        for (clump, program) in scene.clumps.iter().zip(&mut programs.clumps) {
            note(program.words.write(device, queue, &clump.words)?);
        }
        let mut windows = 0;
        for (layer, program) in scene.layers.iter().zip(&mut programs.layers) {
            note(program.words.write(device, queue, &layer.words)?);
            if layer.is_smoothed {
                windows = windows.max(layer.joints as u64 * u64::from(layer.instances));
            }
        }
        if scene.layers.iter().any(|layer| layer.is_smoothed) {
            note(buffers.windows.reserve(device, windows * 8)?);
        }
        let joints = scene.discs.min(scene.joints.len()) as u64;
        note(buffers.clumps.reserve(device, joints * CLUMP_BYTES)?);
        if scene.disc_words.is_empty() {
            note(buffers.discs.reserve(device, scene.disc_bytes())?);
        } else {
            note(buffers.discs.write(device, queue, &scene.disc_words)?);
        }
        let chunks = scene.chunks.len() as u64 / 4;
        note(
            buffers
                .counters
                .reserve(device, (tile_count * 2 + chunks) * 4)?,
        );
        note(buffers.starts.reserve(device, (tile_count + 1) * 2 * 4)?);
        let frame: &GpuFrame = bytemuck::from_bytes(bytemuck::cast_slice(settings));
        // A chunk's entry has a second word.
        let entries = 2 * u64::from(frame.chunk_capacity) + u64::from(frame.triangle_capacity);
        note(buffers.entries.reserve(device, entries * 4)?);
        note(buffers.picture.reserve(device, picture_bytes)?);
        if made > 0 {
            self.groups = None;
            self.stats.made += made;
        }
        Ok(())
    }

    fn make_groups(&self) -> Result<Groups, GpuError> {
        let b = &self.buffers;
        let group = |layout: &BindGroupLayout, buffers: &[&Growing]| {
            let entries: Option<Vec<_>> = (buffers.iter().zip(0..))
                .map(|(buffer, binding)| {
                    let resource = buffer.get()?.as_entire_binding();
                    Some(wgpu::BindGroupEntry { binding, resource })
                })
                .collect();
            let entries = entries.ok_or(GpuError::Memory)?;
            Ok::<_, GpuError>(self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout,
                entries: &entries,
            }))
        };
        let bound = |program| {
            [
                &b.frame, &b.joints, &b.strands, program, &b.clumps, &b.discs,
            ]
        };
        let clumps = self.programs.clumps.iter();
        let clumps = clumps.map(|clump| group(&self.programs.layouts.clump, &bound(&clump.words)));
        let layers = self.scene.layers.iter().zip(&self.programs.layers);
        let layers = layers.map(|(layer, program)| {
            let mut bound = bound(&program.words).to_vec();
            let strokes = group(&self.programs.layouts.strokes, &bound)?;
            bound.push(&b.windows);
            let smooth = layer
                .is_smoothed
                .then(|| group(&self.programs.layouts.smooth, &bound));
            Ok((strokes, smooth.transpose()?))
        });
        let mut bins = vec![
            &b.frame,
            &b.chunks,
            &b.tables,
            &b.discs,
            &b.corners,
            &b.triangles,
        ];
        let mut tiles = bins.clone();
        bins.extend([&b.counters, &b.starts, &b.entries]);
        tiles.extend([&b.starts, &b.entries, &b.picture, &b.sample_places]);
        Ok(Groups {
            clumps: clumps.collect::<Result<_, GpuError>>()?,
            layers: layers.collect::<Result<_, GpuError>>()?,
            bins: group(&self.programs.layouts.bins, &bins)?,
            tiles: group(&self.programs.layouts.tiles, &tiles)?,
        })
    }

    fn record(&self, encoder: &mut wgpu::CommandEncoder, groups: &Groups, frame: &GpuFrame) {
        if let Some(counters) = self.buffers.counters.get() {
            encoder.clear_buffer(counters, 0, None);
        }
        let Some((_, tiles)) = &self.programs.tiles else {
            return;
        };
        let begin = |encoder: &mut wgpu::CommandEncoder, label, stage| {
            encoder
                .begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: Some(label),
                    timestamp_writes: self.report.timestamps(stage),
                })
                .forget_lifetime()
        };
        let run = |pass: &mut wgpu::ComputePass, pipeline: &ComputePipeline, items: u32, z: u32| {
            let groups = items.div_ceil(WORKGROUP);
            let columns = groups.clamp(1, 65_535);
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(columns, groups.div_ceil(columns), z);
        };

        let mut pass = begin(encoder, "strokes", 0);
        // A drawing brings its strokes along, and has no clumps here.
        let clumps = self.scene.clumps.iter().zip(&self.programs.clumps);
        for ((clump, program), group) in clumps.zip(&groups.clumps) {
            pass.set_bind_group(0, group, &[]);
            run(&mut pass, &program.pipeline, clump.joints as u32, 1);
        }
        let layers = self
            .scene
            .layers
            .iter()
            .zip(&self.programs.layers)
            .zip(&groups.layers);
        for ((layer, program), (strokes, smooth)) in layers {
            let (joints, instances) = (layer.joints as u32, layer.instances);
            pass.set_bind_group(0, strokes, &[]);
            run(&mut pass, &program.pipeline, joints, instances);
            if let (Some(group), Some(smooth)) = (smooth, &self.programs.smooth) {
                pass.set_bind_group(0, group, &[]);
                for pipeline in &smooth.pipelines {
                    run(&mut pass, pipeline, joints, instances);
                }
            }
        }
        drop(pass);

        let mut pass = begin(encoder, "bins", 1);
        pass.set_bind_group(0, &groups.bins, &[]);
        if let [
            count_chunks,
            count_triangles,
            place,
            fill_chunks,
            fill_triangles,
            sort,
        ] = &self.programs.bins[..]
        {
            run(&mut pass, count_chunks, frame.chunks, 1);
            run(&mut pass, count_triangles, frame.triangles, 1);
            pass.set_pipeline(place);
            pass.dispatch_workgroups(2, 1, 1);
            run(&mut pass, fill_chunks, frame.chunks, 1);
            run(&mut pass, fill_triangles, frame.triangles, 1);
            pass.set_pipeline(sort);
            pass.dispatch_workgroups(frame.tiles[0], frame.tiles[1], 1);
        }
        drop(pass);

        let mut pass = begin(encoder, "tiles", 2);
        pass.set_bind_group(0, &groups.tiles, &[]);
        pass.set_pipeline(tiles);
        pass.dispatch_workgroups(frame.tiles[0], frame.tiles[1], 1);
        drop(pass);

        if let Some(starts) = self.buffers.starts.get() {
            self.report.record(encoder, starts, frame.tiles);
        }
    }

    /// Takes in what the card tells of a frame before, if it is there.
    fn read_report(&mut self) {
        if let Some((entries, milliseconds)) = self.report.read(&self.device) {
            self.entries_needed = entries;
            self.stats.lists_were_short = (0..2).any(|i| entries[i] > self.list_capacity[i]);
            self.stats.milliseconds = milliseconds;
        }
    }

    /// Waits for the report of a frame that was submitted, and takes it in.
    pub(super) fn wait_for_report(&mut self) -> Result<(), GpuError> {
        self.report.map();
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| GpuError::Lost(error.to_string()))?;
        self.read_report();
        Ok(())
    }
}
