//! Draws frames on a device, in somebody's command encoder.

use super::buffer::Growing;
use super::compose::{Composer, PassFormat};
use super::error::GpuError;
use super::layout::{CLUMP_BYTES, GpuFrame, STRAND_WORDS, TILE, WORKGROUP};
use super::pipelines::{self, Binding, layout, pipelines};
use super::program;
use super::scene::SceneWords;
use crate::check::{self, check_picture, check_surfaces};
use crate::drawing::{Brush, Drawing, Order};
use crate::frame::{Frame, Light};
use crate::samples::sample_positions;
use effects::ProgramSource;
use wgpu::{BindGroup, BindGroupLayout, BufferUsages, ComputePipeline, Device, Queue};

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
    /// Whether the tiles' lists had too little room in the last frame that was read back: it took longer, and was drawn as
    /// it should be. The next one has room.
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
    layouts: Layouts,
    bins: Vec<ComputePipeline>,
    tiles: Option<(Order, ComputePipeline)>,
    clump: Option<Program>,
    layers: Vec<LayerPrograms>,
    smooth: Option<Smooth>,
    groups: Option<Groups>,
    composer: Option<Composer>,
    /// Entries that the tiles' lists needed in the last frame that is known of: chunks, triangles.
    entries_needed: [u32; 2],
    /// Entries that there was room for in the frame that the report is of.
    room: [u32; 2],
    report: Report,
    stats: GpuStats,
}

/// A pipeline with what it was made from.
struct Program {
    made_from: ProgramKey,
    pipeline: ComputePipeline,
}

/// What a program's text hangs on.
#[derive(Clone, PartialEq)]
struct ProgramKey {
    wgsl: &'static str,
    varying: Vec<usize>,
    joint_constants: String,
}

/// A layer's shader, and the words that it reads.
struct LayerPrograms {
    program: Program,
    words: Growing,
}

/// The smoothing of all layers.
struct Smooth {
    joint_constants: String,
    pipelines: Vec<ComputePipeline>,
}

struct Layouts {
    clump: BindGroupLayout,
    strokes: BindGroupLayout,
    smooth: BindGroupLayout,
    bins: BindGroupLayout,
    tiles: BindGroupLayout,
}

/// What the passes bind. Made anew where a buffer is.
struct Groups {
    clump: BindGroup,
    layers: Vec<(BindGroup, Option<BindGroup>)>,
    bins: BindGroup,
    tiles: BindGroup,
}

struct Buffers {
    frame: Growing,
    sample_places: Growing,
    joints: Growing,
    strands: Growing,
    clump_words: Growing,
    clumps: Growing,
    discs: Growing,
    windows: Growing,
    chunks: Growing,
    tables: Growing,
    corners: Growing,
    triangles: Growing,
    counters: Growing,
    starts: Growing,
    entries: Growing,
    picture: Growing,
}

impl Buffers {
    fn new() -> Self {
        let storage = BufferUsages::STORAGE;
        let filled = |what| Growing::new(what, storage | BufferUsages::COPY_DST);
        let uniform = |what| Growing::new(what, BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        let made = |what| Growing::new(what, storage);
        let read = |what| Growing::new(what, storage | BufferUsages::COPY_SRC);
        Self {
            frame: uniform("settings"),
            sample_places: uniform("sample places"),
            joints: filled("joints"),
            strands: filled("strands"),
            clump_words: filled("clump's parameters"),
            clumps: made("clumps"),
            discs: filled("strokes' discs"),
            windows: made("smoothing windows"),
            chunks: filled("pieces of strands"),
            tables: filled("tables"),
            corners: filled("surfaces' corners"),
            triangles: filled("triangles"),
            counters: filled("tiles' counters"),
            starts: read("tiles' places"),
            entries: made("tiles' lists"),
            picture: read("samples"),
        }
    }

    fn all(&self) -> [&Growing; 16] {
        [
            &self.frame,
            &self.sample_places,
            &self.joints,
            &self.strands,
            &self.clump_words,
            &self.clumps,
            &self.discs,
            &self.windows,
            &self.chunks,
            &self.tables,
            &self.corners,
            &self.triangles,
            &self.counters,
            &self.starts,
            &self.entries,
            &self.picture,
        ]
    }
}

/// Passes whose time is taken.
const STAGES: usize = 3;
/// Bytes of the report: two totals, then as many timestamps as stages have beginnings and ends.
const TOTALS_BYTES: u64 = 8;
const TIMES_BYTES: u64 = 2 * STAGES as u64 * 8;

/// What the card tells of a frame, read back without waiting where nobody waits.
struct Report {
    read_back: wgpu::Buffer,
    times: Option<Times>,
    state: std::sync::Arc<std::sync::atomic::AtomicU8>,
}

struct Times {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    nanoseconds: f32,
}

/// States of the report's buffer: free for a frame; written by one; being mapped; mapped; not to be mapped.
const FREE: u8 = 0;
const WRITTEN: u8 = 1;
const MAPPING: u8 = 2;
const MAPPED: u8 = 3;
const FAILED: u8 = 4;

/// What every device must allow, as wgpu names it.
fn check_limits(device: &Device) -> Result<(), GpuError> {
    let limits = device.limits();
    let needed = [
        (
            "storage buffers in a shader",
            limits.max_storage_buffers_per_shader_stage,
            8,
        ),
        (
            "invocations in a workgroup",
            limits.max_compute_invocations_per_workgroup,
            256,
        ),
        (
            "bytes that a workgroup shares",
            limits.max_compute_workgroup_storage_size,
            7_680,
        ),
        (
            "workgroups in a row",
            limits.max_compute_workgroups_per_dimension,
            65_535,
        ),
    ];
    for (what, has, needs) in needed {
        if has < needs {
            return Err(GpuError::Limit {
                what,
                has: has.into(),
                needs: needs.into(),
            });
        }
    }
    Ok(())
}

impl Renderer {
    /// A renderer on a device.
    ///
    /// # Errors
    ///
    /// When the device's limits are too small, or its driver refuses a shader.
    pub fn new(device: &Device, queue: &Queue) -> Result<Self, GpuError> {
        check_limits(device)?;
        let of = |name, bindings: &[Binding]| layout(device, name, bindings);
        let layouts = Layouts {
            clump: of("clump", pipelines::CLUMP),
            strokes: of("strokes", pipelines::STROKES),
            smooth: of("smooth", pipelines::SMOOTH),
            bins: of("bins", pipelines::BINS),
            tiles: of("tiles", pipelines::TILES),
        };
        let entry_points = [
            "count_chunks",
            "count_triangles",
            "place_lists",
            "fill_chunks",
            "fill_triangles",
            "sort_chunks",
        ];
        let bins = pipelines(
            device,
            "bins",
            &program::bins(),
            &layouts.bins,
            &entry_points,
        )?;
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            scene: SceneWords::default(),
            buffers: Buffers::new(),
            layouts,
            bins,
            tiles: None,
            clump: None,
            layers: Vec::new(),
            smooth: None,
            groups: None,
            composer: None,
            entries_needed: [0; 2],
            room: [0; 2],
            report: Report::new(device, queue),
            stats: GpuStats::default(),
        })
    }

    /// What the renderer has, and what its last frame took.
    #[must_use]
    pub fn stats(&self) -> GpuStats {
        let buffers = self.buffers.all().into_iter();
        let buffers = buffers.chain(self.layers.iter().map(|layer| &layer.words));
        let alive = buffers.filter(|buffer| buffer.size() > 0);
        let smooth = self.smooth.as_ref().map_or(0, |s| s.pipelines.len());
        GpuStats {
            pipelines: self.bins.len()
                + usize::from(self.tiles.is_some())
                + usize::from(self.clump.is_some())
                + usize::from(self.composer.is_some())
                + self.layers.len()
                + smooth,
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
    /// When the frame is no frame, is larger than the device allows, or the driver refuses a shader; when the pass has
    /// neither one sample nor as many as are prepared. Then nothing was recorded, and [`Self::render`] draws nothing.
    pub fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame,
        samples: u32,
        pass: PassFormat,
    ) -> Result<(), GpuError> {
        let before = self.composer.take();
        if pass.samples != 1 && pass.samples != samples {
            return Err(GpuError::PassSamples {
                pass: pass.samples,
                prepared: samples,
            });
        }
        let is_new = self.draw(encoder, Source::Frame(frame), samples, Keeps::Samples)?;
        let mut composer = match before {
            Some(composer) if composer.fits(&pass) => composer,
            _ => Composer::new(&self.device, pass)?,
        };
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
                check_picture(size, frame.background, frame.edge_depth_m)?;
                check_surfaces(&frame.surfaces)?;
                self.scene.fill(frame);
                self.make_programs(frame)?;
                (size, frame.order, settings(frame))
            }
            Source::Drawing(drawing) => {
                check::check(drawing)?;
                self.scene.fill_drawing(drawing);
                self.layers.clear();
                self.groups = None;
                (drawing.size, drawing.order, settings_of_drawing(drawing))
            }
        };
        self.make_tiles(order)?;

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
        if self.report.state() == FREE {
            self.room = [chunk_capacity, triangle_capacity];
        }
        self.record(encoder, &groups, &settings);
        self.groups = Some(groups);
        Ok(is_new)
    }

    /// How many entries the tiles' lists have room for: what the last frame needed and half as much, or a
    /// guess. A tile whose list has no room looks at everything, so that a guess that is too low costs time alone.
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

    /// Makes the pipelines of layers that changed, and drops those of layers that are gone.
    fn make_programs(&mut self, frame: &Frame) -> Result<(), GpuError> {
        let joint_constants = self.scene.layout.constants();
        let key = |source: &ProgramSource| ProgramKey {
            wgsl: source.wgsl,
            varying: source.varying.to_vec(),
            joint_constants: joint_constants.clone(),
        };
        let clump = frame.clump.source();
        let made_from = key(&clump);
        if self
            .clump
            .as_ref()
            .is_none_or(|program| program.made_from != made_from)
        {
            let text = program::clump(&clump, &self.scene.layout);
            let pipeline = self.one_pipeline("the clump", &text, &self.layouts.clump)?;
            self.clump = Some(Program {
                made_from,
                pipeline,
            });
        }
        let mut before = std::mem::take(&mut self.layers);
        for layer in frame.layers {
            let source = layer.program.source();
            let made_from = key(&source);
            let is_it = |l: &LayerPrograms| l.program.made_from == made_from;
            let layer = match before.iter().position(is_it) {
                Some(place) => before.remove(place),
                None => {
                    let text = program::strokes(&source, &self.scene.layout);
                    let pipeline = self.one_pipeline(layer.effect, &text, &self.layouts.strokes)?;
                    self.groups = None;
                    LayerPrograms {
                        program: Program {
                            made_from,
                            pipeline,
                        },
                        words: Growing::new(
                            "a layer's parameters",
                            BufferUsages::STORAGE | BufferUsages::COPY_DST,
                        ),
                    }
                }
            };
            self.layers.push(layer);
        }
        let is_smoothed = self.scene.layers.iter().any(|layer| layer.is_smoothed);
        let groups_smooth = self.groups.as_ref().map_or(0, |groups| {
            groups
                .layers
                .iter()
                .filter(|(_, smooth)| smooth.is_some())
                .count()
        });
        let layers_smooth = self
            .scene
            .layers
            .iter()
            .filter(|layer| layer.is_smoothed)
            .count();
        if !before.is_empty() || groups_smooth != layers_smooth {
            self.groups = None;
        }
        if !is_smoothed {
            self.smooth = None;
            self.buffers.windows.drop_buffer();
        } else if self
            .smooth
            .as_ref()
            .is_none_or(|s| s.joint_constants != joint_constants)
        {
            let entry_points = ["find_gaps", "close_gaps", "find_specks", "open_specks"];
            let text = program::smooth(&self.scene.layout);
            let made = pipelines(
                &self.device,
                "smooth",
                &text,
                &self.layouts.smooth,
                &entry_points,
            )?;
            self.stats.made += made.len();
            self.smooth = Some(Smooth {
                joint_constants,
                pipelines: made,
            });
        }
        Ok(())
    }

    /// Makes the pipeline that draws tiles in that order.
    fn make_tiles(&mut self, order: Order) -> Result<(), GpuError> {
        if self.tiles.as_ref().is_none_or(|(made, _)| *made != order) {
            let number = match order {
                Order::Rounded => 0,
                Order::Scattered => 1,
                Order::StrandFirst => 2,
                Order::Shifted => 3,
            };
            let text = program::tiles(number);
            let made = pipelines(
                &self.device,
                "tiles",
                &text,
                &self.layouts.tiles,
                &["draw_tile"],
            )?;
            self.stats.made += made.len();
            self.tiles = made.into_iter().next().map(|pipeline| (order, pipeline));
        }
        Ok(())
    }

    fn one_pipeline(
        &self,
        name: &str,
        text: &str,
        layout: &BindGroupLayout,
    ) -> Result<ComputePipeline, GpuError> {
        let made = pipelines(&self.device, name, text, layout, &["gpu_main"])?;
        made.into_iter().next().ok_or(GpuError::Memory)
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
            layers,
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
        note(buffers.clump_words.write(device, queue, &scene.clump)?);
        note(buffers.chunks.write(device, queue, &scene.chunks)?);
        note(buffers.tables.write(device, queue, &scene.tables)?);
        note(buffers.corners.write(device, queue, &scene.corners)?);
        note(buffers.triangles.write(device, queue, &scene.triangles)?);
        let mut windows = 0;
        for (layer, programs) in scene.layers.iter().zip(layers) {
            note(programs.words.write(device, queue, &layer.words)?);
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
        let layers = self.scene.layers.iter().zip(&self.layers);
        let layers = layers.map(|(layer, programs)| {
            let mut bound = vec![
                &b.frame,
                &b.joints,
                &b.strands,
                &programs.words,
                &b.clumps,
                &b.discs,
            ];
            let strokes = group(&self.layouts.strokes, &bound)?;
            bound.push(&b.windows);
            let smooth = layer
                .is_smoothed
                .then(|| group(&self.layouts.smooth, &bound));
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
            clump: group(
                &self.layouts.clump,
                &[
                    &b.frame,
                    &b.joints,
                    &b.strands,
                    &b.clump_words,
                    &b.clumps,
                    &b.discs,
                ],
            )?,
            layers: layers.collect::<Result<_, GpuError>>()?,
            bins: group(&self.layouts.bins, &bins)?,
            tiles: group(&self.layouts.tiles, &tiles)?,
        })
    }

    fn record(&self, encoder: &mut wgpu::CommandEncoder, groups: &Groups, frame: &GpuFrame) {
        if let Some(counters) = self.buffers.counters.get() {
            encoder.clear_buffer(counters, 0, None);
        }
        let Some((_, tiles)) = &self.tiles else {
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
        // A drawing brings its strokes along.
        if let Some(clump) = self
            .clump
            .as_ref()
            .filter(|_| self.scene.disc_words.is_empty())
        {
            pass.set_bind_group(0, &groups.clump, &[]);
            run(&mut pass, &clump.pipeline, frame.joints, 1);
        }
        let layers = self
            .scene
            .layers
            .iter()
            .zip(&self.layers)
            .zip(&groups.layers);
        for ((layer, programs), (strokes, smooth)) in layers {
            let (joints, instances) = (layer.joints as u32, layer.instances);
            pass.set_bind_group(0, strokes, &[]);
            run(&mut pass, &programs.program.pipeline, joints, instances);
            if let (Some(group), Some(smooth)) = (smooth, &self.smooth) {
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
        ] = &self.bins[..]
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
            self.stats.lists_were_short = (0..2).any(|i| entries[i] > self.room[i]);
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

fn settings_of_drawing(drawing: &Drawing) -> GpuFrame {
    let [red, green, blue] = drawing.background.unwrap_or_default();
    let opaque = if drawing.background.is_some() {
        1.0
    } else {
        0.0
    };
    GpuFrame {
        background: [red, green, blue, opaque],
        edge_depth_m: drawing.edge_depth_m,
        is_semicircle: u32::from(drawing.brush == Brush::Semicircle),
        ..GpuFrame::default()
    }
}

fn settings(frame: &Frame) -> GpuFrame {
    let (light, is_point) = match frame.light {
        Light::Direction(direction) => (direction, 0),
        Light::Point(place) => (place, 1),
    };
    let [red, green, blue] = frame.background.unwrap_or_default();
    GpuFrame {
        joints: frame.paths.len() as u32,
        eye: frame.camera.eye().to_array(),
        near_m: frame.camera.near_m(),
        head_center: frame.head.center.to_array(),
        head_height_m: frame.head.height_m,
        light: light.to_array(),
        light_is_point: is_point,
        background: [
            red,
            green,
            blue,
            if frame.background.is_some() { 1.0 } else { 0.0 },
        ],
        unit_m: frame.head.unit_m(),
        pixel_px: frame.camera.size_px()[1] as f32 / 720.0,
        edge_depth_m: frame.edge_depth_m,
        is_semicircle: u32::from(frame.brush == Brush::Semicircle),
        ..GpuFrame::default()
    }
}

impl Report {
    fn new(device: &Device, queue: &Queue) -> Self {
        let buffer = |label, size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let has_times = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        Self {
            read_back: buffer(
                "report",
                TOTALS_BYTES + TIMES_BYTES,
                BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            ),
            times: has_times.then(|| Times {
                queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("stages"),
                    ty: wgpu::QueryType::Timestamp,
                    count: 2 * STAGES as u32,
                }),
                resolved: buffer(
                    "timestamps",
                    256,
                    BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
                ),
                nanoseconds: queue.get_timestamp_period(),
            }),
            state: std::sync::Arc::default(),
        }
    }

    fn state(&self) -> u8 {
        self.state.load(std::sync::atomic::Ordering::Acquire)
    }

    fn set_state(&self, state: u8) {
        self.state
            .store(state, std::sync::atomic::Ordering::Release);
    }

    fn timestamps(&self, stage: u32) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let times = self.times.as_ref()?;
        Some(wgpu::ComputePassTimestampWrites {
            query_set: &times.queries,
            beginning_of_pass_write_index: Some(2 * stage),
            end_of_pass_write_index: Some(2 * stage + 1),
        })
    }

    /// Records the report of a frame, unless one is still to be read.
    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        starts: &wgpu::Buffer,
        [columns, rows]: [u32; 2],
    ) {
        if self.state() != FREE {
            return;
        }
        let tiles = u64::from(columns) * u64::from(rows);
        encoder.copy_buffer_to_buffer(starts, tiles * 4, &self.read_back, 0, 4);
        encoder.copy_buffer_to_buffer(starts, (2 * tiles + 1) * 4, &self.read_back, 4, 4);
        if let Some(times) = &self.times {
            encoder.resolve_query_set(&times.queries, 0..2 * STAGES as u32, &times.resolved, 0);
            let to = &self.read_back;
            encoder.copy_buffer_to_buffer(&times.resolved, 0, to, TOTALS_BYTES, TIMES_BYTES);
        }
        self.set_state(WRITTEN);
    }

    /// Asks for a report that was written.
    fn map(&self) {
        if self.state() != WRITTEN {
            return;
        }
        self.set_state(MAPPING);
        let state = std::sync::Arc::clone(&self.state);
        self.read_back
            .map_async(wgpu::MapMode::Read, .., move |result| {
                let next = if result.is_ok() { MAPPED } else { FAILED };
                state.store(next, std::sync::atomic::Ordering::Release);
            });
    }

    /// The entries that the tiles' lists needed, and the stages' milliseconds, where they are there.
    fn read(&self, device: &Device) -> Option<([u32; 2], Option<[f64; 3]>)> {
        self.map();
        // Never waits. A device that is lost says so elsewhere.
        let _ = device.poll(wgpu::PollType::Poll);
        if self.state() == FAILED {
            self.set_state(FREE);
        }
        if self.state() != MAPPED {
            return None;
        }
        let report = {
            let view = self.read_back.get_mapped_range(..).ok()?;
            let totals: [u32; 2] = bytemuck::pod_read_unaligned(&view[..TOTALS_BYTES as usize]);
            let times: [u64; 2 * STAGES] =
                bytemuck::pod_read_unaligned(&view[TOTALS_BYTES as usize..]);
            let milliseconds = self.times.as_ref().map(|clock| {
                [0, 1, 2].map(|stage| {
                    let ticks = times[2 * stage + 1].saturating_sub(times[2 * stage]);
                    ticks as f64 * f64::from(clock.nanoseconds) * 1e-6
                })
            });
            (totals, milliseconds)
        };
        self.read_back.unmap();
        self.set_state(FREE);
        Some(report)
    }
}

const _: () = assert!(STRAND_WORDS == 5);
