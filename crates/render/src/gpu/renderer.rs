//! Draws frames on a device, in somebody's command encoder.

use super::adapter::check_limits;
use super::atlas::Atlas;
use super::buffer::{Buffers, Growing};
use super::compose::{Composer, PassFormat};
use super::error::GpuError;
use super::layout::{CLUMP_BYTES, GpuFrame, TILE, WORKGROUP};
use super::programs::{Programs, Tells, TilesKey};
use super::report::Report;
use super::samples::{self, SampleStage, Wanted, pixels, whole};
use super::scene::SceneWords;
use crate::check;
use crate::drawing::Drawing;
use crate::edges::Edges;
use crate::features::Features;
use crate::frame::Frame;
use crate::planes::ALWAYS;
use crate::samples::{SampleCountError, sample_positions, standard_positions};
use glam::Vec2;
use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, Device, Queue};

/// What a renderer has, and what its last frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GpuStats {
    /// Pipelines alive.
    pub pipelines: usize,
    /// Buffers and textures alive.
    pub buffers: usize,
    /// Their bytes.
    pub bytes: u64,
    /// Buffers, textures and pipelines that the last frame had to make: none once warm.
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
    /// The same, and what they show; as they are before passes.
    Features,
}

/// Draws frames on a device. Long-lived: it keeps pipelines and buffers from frame to frame.
pub struct Renderer {
    device: Device,
    queue: Queue,
    scene: SceneWords,
    buffers: Buffers,
    programs: Programs,
    /// Where samples are painted, drawn on, or tell what they show.
    samples: Option<SampleStage>,
    /// Pictures on surfaces and of brushes.
    atlas: Atlas,
    groups: Option<Groups>,
    composer: Option<Composer>,
    /// Entries that the tiles' lists needed in the last frame that is known of: chunks, triangles.
    entries_needed: [u32; 2],
    /// Lengths of the tiles' lists in the frame that the report is of, in entries.
    list_capacity: [u32; 2],
    report: Report,
    stats: GpuStats,
}

/// What is wanted of a frame's samples beside their colours; nothing where that is nothing.
fn wanted(frame: &Frame, samples: u32, keeps: Keeps) -> Option<Wanted> {
    let mut layers = frame.objects.iter().flat_map(|object| object.layers);
    let is_painted = layers.any(|layer| layer.program.paints().is_some());
    let of_passes = frame.passes.iter().map(Edges::features);
    let tells = match keeps {
        Keeps::Features => frame.all_features().union(ALWAYS),
        Keeps::Means | Keeps::Samples => of_passes.fold(Features::NONE, Features::union),
    };
    let through = frame.mesh_layers.iter();
    let mut through = through.filter(|mesh| mesh.layer.through_hair > 0.0);
    let is_painted = is_painted || !frame.mesh_layers.is_empty();
    (is_painted || !tells.is_empty()).then_some(Wanted {
        under: through.next().is_some(),
        size: frame.camera.size_px(),
        samples,
        tells,
        means: keeps == Keeps::Means,
    })
}

/// Refuses what is drawn of frames alone.
fn check_supported(drawing: &Drawing) -> Result<(), GpuError> {
    let is_painted = !(drawing.painting.is_empty() && drawing.mesh_painting.is_empty());
    if is_painted || !drawing.passes.is_empty() {
        let what = "a drawing of strokes with painted layers or passes".to_owned();
        return Err(GpuError::Unsupported(what));
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
            samples: None,
            atlas: Atlas::default(),
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
        let of_samples = self.samples.iter().flat_map(SampleStage::bytes);
        let pipelines = self.samples.as_ref().map_or(0, SampleStage::pipelines);
        GpuStats {
            pipelines: self.programs.count() + pipelines + usize::from(self.composer.is_some()),
            buffers: alive.clone().count() + of_samples.clone().count(),
            bytes: alive.map(Growing::size).chain(of_samples).sum::<u64>() + self.atlas.bytes(),
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
        let places = places_in_pass(pass.samples, samples)?;
        let is_new = self.draw(encoder, Source::Frame(frame), &places, Keeps::Samples)?;
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
        self.draw(encoder, source, &sample_positions(samples)?, Keeps::Means)
            .map(|_| ())
    }

    /// The drawn pixels: red, green, blue and alpha.
    pub(super) fn picture(&self) -> Option<&wgpu::Buffer> {
        let means = self.samples.as_ref().and_then(SampleStage::means);
        means.or(self.buffers.picture.get())
    }

    /// Records the samples of a frame, which [`Self::tell`] tells of.
    pub(super) fn draw_samples(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame,
        samples: u32,
    ) -> Result<(), GpuError> {
        let places = sample_positions(samples)?;
        self.draw(encoder, Source::Frame(frame), &places, Keeps::Features)
            .map(|_| ())
    }

    /// Records the features of one of the samples that were drawn, which the buffer holds once the encoder has been submitted: plane after
    /// plane, ids first.
    pub(super) fn tell(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        size: [u32; 2],
        sample: u32,
    ) -> Result<&wgpu::Buffer, GpuError> {
        let stage = self.samples.as_ref().ok_or(GpuError::Memory)?;
        let group = stage.tell_group(&self.device, &self.buffers)?;
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("features"),
            timestamp_writes: None,
        });
        stage.tell(&mut pass, &group, size, sample);
        drop(pass);
        stage.planes().ok_or(GpuError::Memory)
    }

    /// Records all passes of a frame. Whether there are other buffers than before.
    fn draw(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        source: Source,
        places: &[Vec2],
        keeps: Keeps,
    ) -> Result<bool, GpuError> {
        let samples = places.len() as u32;
        self.stats.made = 0;
        self.read_report();
        let (size, order, settings) = match source {
            Source::Frame(frame) => {
                let size = frame.camera.size_px();
                frame.check()?;
                let wanted = wanted(frame, samples, keeps);
                let tells = wanted.map_or(Features::NONE, |wanted| wanted.tells);
                self.scene.fill(frame, tells);
                self.follow(frame)?;
                self.follow_samples(frame, wanted, keeps)?;
                (size, frame.order, GpuFrame::of_frame(frame))
            }
            Source::Drawing(drawing) => {
                check::check(drawing)?;
                check_supported(drawing)?;
                self.samples = None;
                self.scene.fill_drawing(drawing);
                self.programs.clumps.clear();
                self.programs.layers.clear();
                self.groups = None;
                let settings = GpuFrame::of_drawing(drawing);
                (drawing.size, drawing.order, settings)
            }
        };
        let (surfaces, decals) = match source {
            Source::Frame(frame) => (&frame.surfaces, !frame.decals.is_empty()),
            Source::Drawing(drawing) => (&drawing.surfaces, !drawing.decals.is_empty()),
        };
        // Should something not fit, what was bound is of buffers and pictures that are gone.
        let groups = self.groups.take();
        let (device, queue) = (&self.device, &self.queue);
        let has_other_pictures =
            (self.atlas).follow(device, queue, surfaces, &self.scene.brushwork)?;
        self.stats.made += usize::from(has_other_pictures);
        let tells = self.tells();
        let key = TilesKey {
            order,
            tells,
            textured: surfaces.iter().any(|surface| surface.texture.is_some()),
            brushed: !self.scene.brushwork.is_empty(),
            decals,
        };
        self.stats.made += self.programs.draw_in(&self.device, key)?;

        let tiles = size.map(|side| side.div_ceil(TILE));
        let tile_count = u64::from(tiles[0]) * u64::from(tiles[1]);
        let [chunk_capacity, triangle_capacity] = self.capacities(tile_count);
        let has_samples = tells != Tells::Nothing || keeps != Keeps::Means;
        let in_pixel = if has_samples { samples } else { 1 };
        let values = pixels(size) * u64::from(in_pixel);
        let settings = GpuFrame {
            size,
            tiles,
            chunks: self.scene.chunks.len() as u32 / 4,
            triangles: self.scene.triangles.len() as u32 / 4,
            samples,
            chunk_capacity,
            triangle_capacity,
            surfaces_at: self.scene.surfaces_at,
            same_strands_at: self.scene.same_strands_at,
            outlines: self.scene.outlines,
            writes_samples: u32::from(has_samples),
            ..settings
        };
        let made = self.write_buffers(&settings, places, tile_count, values * 16)?;
        self.stats.made += made;
        let groups = groups.filter(|_| !has_other_pictures && made == 0);
        let is_new = groups.is_none();
        let groups = match groups {
            Some(groups) => groups,
            None => self.make_groups()?,
        };
        if self.report.is_free() {
            self.list_capacity = [chunk_capacity, triangle_capacity];
        }
        self.record(encoder, &groups, &settings)?;
        self.groups = Some(groups);
        Ok(is_new)
    }

    /// What tiles keep of samples.
    fn tells(&self) -> Tells {
        let samples = self.samples.as_ref();
        samples.map_or(Tells::Nothing, SampleStage::tells)
    }

    /// Capacities of the tiles' lists, in entries: what the last frame needed and half as much, or a
    /// guess. A tile whose list is full looks at everything, so that a guess that is too low costs time alone,
    /// but for drivers in software that break off loops which go on for too long: tiles are spoilt then.
    fn capacities(&self, tiles: u64) -> [u32; 2] {
        let chunks = self.scene.chunks.len() as u64 / 4;
        let triangles = self.scene.triangles.len() as u64 / 4;
        // Few chunks may each reach many tiles: a wide lock, and one seen from near.
        let of_chunks = (chunks * (32 + tiles / 32)).min(1 << 20);
        let guess = [
            of_chunks.max(chunks * (8 + tiles / 128)),
            triangles * 4 + 4 * tiles,
        ];
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

    /// Makes and drops what samples need beside their colours.
    fn follow_samples(
        &mut self,
        frame: &Frame,
        wanted: Option<Wanted>,
        keeps: Keeps,
    ) -> Result<(), GpuError> {
        // What the tiles bind is another with and without samples that are kept; should those not fit, it is made anew.
        let (before, groups) = (self.samples.take(), self.groups.take());
        let had_samples = before.is_some();
        let Some(wanted) = wanted else {
            self.groups = groups.filter(|_| !had_samples);
            return Ok(());
        };
        let mut stage = match before {
            Some(stage) => stage,
            None => SampleStage::new(&self.device, wanted)?,
        };
        let passes = match keeps {
            Keeps::Features => &[][..],
            Keeps::Means | Keeps::Samples => &frame.passes,
        };
        let was_told = stage.told();
        let (device, queue) = (&self.device, &self.queue);
        let made = stage.follow(device, queue, frame, passes, &self.scene, wanted)?;
        let is_same = had_samples && stage.told() == was_told;
        self.groups = groups.filter(|_| is_same);
        self.stats.made += made + usize::from(!had_samples);
        self.samples = Some(stage);
        Ok(())
    }

    /// Writes and reserves all that a frame needs; says how many buffers are others than before.
    fn write_buffers(
        &mut self,
        settings: &GpuFrame,
        places: &[Vec2],
        tile_count: u64,
        picture_bytes: u64,
    ) -> Result<usize, GpuError> {
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
        let frame: &GpuFrame = bytemuck::from_bytes(bytemuck::cast_slice(settings));
        let joints = u64::from(frame.joints);
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
        // A chunk's entry has a second word.
        let entries = 2 * u64::from(frame.chunk_capacity) + u64::from(frame.triangle_capacity);
        note(buffers.entries.reserve(device, entries * 4)?);
        note(buffers.picture.reserve(device, picture_bytes)?);
        Ok(made)
    }

    fn make_groups(&self) -> Result<Groups, GpuError> {
        let b = &self.buffers;
        let group = |layout: &BindGroupLayout, buffers: &[&Growing]| {
            let bound = buffers.iter().copied().map(whole);
            let bound = bound.collect::<Result<Vec<_>, GpuError>>()?;
            Ok::<_, GpuError>(samples::group(&self.device, layout, bound))
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
        let mut tiles = tiles
            .into_iter()
            .map(whole)
            .collect::<Result<Vec<_>, _>>()?;
        let layouts = &self.programs.layouts;
        let told = self.samples.as_ref().map(SampleStage::told);
        let told = told.unwrap_or_default();
        let textures = told.iter().chain(self.atlas.view());
        tiles.extend(textures.map(wgpu::BindingResource::TextureView));
        let tiles_layout = layouts.tiles(self.tells(), self.atlas.view().is_some())?;
        Ok(Groups {
            clumps: clumps.collect::<Result<_, GpuError>>()?,
            layers: layers.collect::<Result<_, GpuError>>()?,
            bins: group(&self.programs.layouts.bins, &bins)?,
            tiles: samples::group(&self.device, tiles_layout, tiles),
        })
    }

    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        groups: &Groups,
        frame: &GpuFrame,
    ) -> Result<(), GpuError> {
        if let Some(counters) = self.buffers.counters.get() {
            encoder.clear_buffer(counters, 0, None);
        }
        let Some((_, tiles)) = &self.programs.tiles else {
            return Ok(());
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
        if let Some(stage) = &self.samples {
            let (buffers, programs) = (&self.buffers, &self.programs);
            stage.record(&self.device, &mut pass, buffers, programs, frame)?;
        }
        drop(pass);

        if let Some(starts) = self.buffers.starts.get() {
            self.report.record(encoder, starts, frame.tiles);
        }
        Ok(())
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
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| GpuError::Lost(error.to_string()))?;
        self.read_report();
        Ok(())
    }
}

/// Where the samples lie that are prepared for a pass: those of a pass with several where the card has them.
fn places_in_pass(of_pass: u32, prepared: u32) -> Result<Vec<Vec2>, SampleCountError> {
    match of_pass {
        1 => sample_positions(prepared),
        several => standard_positions(several).ok_or(SampleCountError(several)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pass_with_sixteen_samples_has_the_cards() {
        let mean = |places: Vec<Vec2>| places.iter().sum::<Vec2>() / places.len() as f32;
        assert_eq!(mean(places_in_pass(1, 16).unwrap()), Vec2::splat(0.5));
        assert_eq!(
            mean(places_in_pass(16, 16).unwrap()),
            Vec2::splat(15.0 / 32.0)
        );
        assert_eq!(places_in_pass(3, 3), Err(SampleCountError(3)));
    }
}
