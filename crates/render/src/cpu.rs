//! The exact rasteriser: no driver, any number of samples, the same bits on any machine.
//!
//! A drawing is checked ([`DrawError`]) and taken apart into segments, some strands at a time in parallel, which are
//! sorted into bands of tile rows and these into tiles. Bands are drawn in parallel; every band sees its segments in the
//! same order, so threads can't change a bit. In a tile (see `tile`) come first the surfaces, then
//! strand after strand from the nearest on. Where a strand may show, its segments get their shapes (`segment`) and what they
//! cover (`rows`); then comes the strand's own order (`strand`), and cell by cell, sixteen samples at once, its depth
//! (`stroke`) against what is there, and the colour of what shows.
//! Each stage of a tile is compiled for several instruction sets (`instructions`); what is called there is
//! `inline(always)`, or it would be compiled without them. Stage by stage, as one function of all takes a compiler twice as long.

mod bin;
mod brush;
mod context;
mod cover;
mod decals;
mod evaluate;
pub(crate) mod instructions;
mod light;
mod lines;
mod mixed;
mod offer;
mod outlines;
mod paint;
mod paint_mesh;
mod reached;
mod ribbon;
mod rows;
mod samples;
mod seen;
mod segment;
mod set_up;
mod shown;
mod spots;
mod square;
mod stamp;
mod strand;
mod stroke;
mod surface;
mod tell;
mod texels;
mod tile;

#[cfg(test)]
mod tests;

pub use crate::check::{DrawError, MAX_COORDINATE, MAX_SIZE};
pub use evaluate::Evaluator;
pub use stamp::Stamper;

use crate::check;
use crate::drawing::Drawing;
use crate::picture::Picture;
use crate::planes::{BandPlanes, SamplePlanes};
use crate::samples::{SampleCountError, sample_positions};
use bin::{Bins, cells};
use context::{Part, TileContext, TileLists};
use decals::{DecalParts, Decals};
use instructions::Instructions;
use light::Light;
use lines::BandUnderLines;
use mixed::JointRows;
use paint::Painter;
use paint_mesh::MeshPainter;
use rayon::prelude::*;
use ribbon::{Finder, Ribbon};
use segment::{Kind, Segment, Segments, Stroke};
use shown::Shown;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};
use strand::StrandMasks;
use surface::Triangle;
use texels::Pictures;
pub(crate) use tile::STACK;
use tile::{Stack, StoreMask, Sums, Target};

/// Most threads of a rasteriser.
pub const MAX_THREADS: usize = 1024;

/// Why there is no rasteriser.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RasterizerError {
    /// No such number of samples.
    #[error(transparent)]
    Samples(#[from] SampleCountError),
    /// No such number of threads.
    #[error("{0} threads: 1 to {MAX_THREADS} are possible")]
    Threads(usize),
    /// The system gave no threads.
    #[error("threads could not be started")]
    Pool(#[from] rayon::ThreadPoolBuildError),
}

/// Draws [`Drawing`]s. Keeps its threads and its memory from picture to picture.
pub struct Rasterizer {
    frames: FrameMaker,
    /// Of the last picture with passes its samples, or their colours and the outermost rows of each band.
    planes: SamplePlanes,
    light: Light,
    rims: Vec<Ribbon>,
    /// The memory of a picture that was given back; else empty.
    spare: Vec<[f32; 4]>,
}

/// What frames are made in.
struct FrameMaker {
    /// Its own threads, or none where it draws on the caller's.
    pool: Option<rayon::ThreadPool>,
    /// In a pixel.
    samples: usize,
    stacks: Vec<Stack>,
    parts: Parts,
    instructions: Instructions,
    /// One for each thread, once it has drawn.
    workers: Vec<Mutex<Worker>>,
}

/// What the drawing is taken apart into.
#[derive(Default)]
struct Parts {
    segments: Segments,
    triangles: Vec<Triangle>,
    triangles_of_tiles: Bins,
    /// What painted samples are mixed of; empty where nothing is painted.
    joint_rows: JointRows,
    /// For each stroke of a strand, in their order, the place of its layer among the painted ones, if it is one.
    painted: Vec<Option<usize>>,
    decals: DecalParts,
}

impl Rasterizer {
    /// A rasteriser with that many samples in a pixel ([`sample_positions`]) and that many threads of its
    /// own. With `None` it draws on the caller's: those of the rayon pool that [`Self::draw`] is called
    /// in, so that a program needs one pool for all that it does.
    ///
    /// # Errors
    ///
    /// When there is no such number of samples or threads.
    pub fn new(samples: u32, threads: Option<usize>) -> Result<Self, RasterizerError> {
        let samples = sample_positions(samples)?;
        if let Some(threads) = threads.filter(|t| !(1..=MAX_THREADS).contains(t)) {
            return Err(RasterizerError::Threads(threads));
        }
        let own_pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = threads.map(own_pool).transpose()?;
        Ok(Self {
            frames: FrameMaker {
                pool,
                samples: samples.len(),
                stacks: Stack::of_pixel(&samples),
                instructions: Instructions::best(),
                parts: Parts::default(),
                workers: Vec::new(),
            },
            planes: SamplePlanes::default(),
            light: Light::default(),
            rims: Vec::new(),
            spare: Vec::new(),
        })
    }

    /// Draws a picture.
    ///
    /// A stroke of radius 0 covers nothing. Light beyond 0..1 is clamped for each sample.
    ///
    /// # Errors
    ///
    /// When the drawing is invalid (see [`DrawError`]); then nothing has been drawn.
    #[inline(never)] // a stage of a frame, which `cargo xtask bench count` finds by its name
    pub fn draw(&mut self, drawing: &Drawing) -> Result<Picture, DrawError> {
        match drawing.passes.is_empty() {
            true => self.draw_means(drawing),
            false => self.draw_with_passes(drawing),
        }
    }

    /// Takes a picture that nobody needs any more: the next one of its size is drawn in its memory, but where passes ask for colours. To get new memory and to fill it takes
    /// longer than many a picture's strokes.
    pub fn give_back(&mut self, picture: Picture) {
        self.spare = picture.pixels;
    }

    fn draw_means(&mut self, drawing: &Drawing) -> Result<Picture, DrawError> {
        let spare = &mut self.spare;
        self.frames.make(drawing, |frame, workers| {
            let (mut picture, to_fill) = picture_for(drawing, frame.samples, spare)?;
            let frame = Frame { to_fill, ..frame };
            let band_length = drawing.size[0] as usize * tile::height(frame.stacks);
            picture
                .pixels
                .par_chunks_mut(band_length)
                .enumerate()
                .with_max_len(1) // so that all threads end at one time
                .for_each(|(band, pixels)| {
                    let mut worker = own_worker(workers);
                    worker.draw_band(&frame, band, Output::Pixels(pixels));
                });
            Ok(picture)
        })
    }
}

impl FrameMaker {
    /// Takes a drawing apart, and calls `work` with what is needed to draw it, and with a worker for each thread, on these threads.
    fn make<R: Send>(
        &mut self,
        drawing: &Drawing,
        work: impl FnOnce(Frame, &[Mutex<Worker>]) -> Result<R, DrawError> + Send,
    ) -> Result<R, DrawError> {
        let Self {
            pool,
            samples,
            stacks,
            parts,
            instructions,
            workers,
        } = self;
        let make = || {
            check::check(drawing)?;
            let strokes = segment::strokes_in_order(drawing, Kind::Ordered);
            parts.collect(drawing, &strokes, stacks);
            workers.resize_with(rayon::current_num_threads(), || Mutex::new(Worker::new()));
            let frame = Frame {
                drawing,
                strokes: &strokes,
                parts,
                samples: *samples,
                stacks,
                instructions: *instructions,
                runs_of_joints: &[],
                to_fill: None,
            };
            work(frame, workers)
        };
        match pool {
            Some(pool) => pool.install(make),
            None => make(),
        }
    }
}

/// That of the thread.
fn own_worker(workers: &[Mutex<Worker>]) -> MutexGuard<'_, Worker> {
    let thread = rayon::current_thread_index().unwrap_or(0);
    // Its memory is cleared before use, so a panic elsewhere can't harm it.
    workers[thread]
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
}

/// A picture to draw in, and what pixels that nothing covers are to be, where they aren't: it takes the spare pixels, where there are as many.
fn picture_for(
    drawing: &Drawing,
    samples: usize,
    spare: &mut Vec<[f32; 4]>,
) -> Result<(Picture, Option<[f32; 4]>), DrawError> {
    let [width, height] = drawing.size;
    if spare.len() != width as usize * height as usize {
        return Ok((empty_picture(drawing, samples)?, None));
    }
    let picture = Picture {
        width,
        height,
        pixels: std::mem::take(spare),
    };
    let to_fill = tile::empty_pixel(drawing.background, samples);
    Ok((picture, Some(to_fill)))
}

/// A picture in which nothing has been drawn.
fn empty_picture(drawing: &Drawing, samples: usize) -> Result<Picture, DrawError> {
    let [width, height] = drawing.size;
    let length = width as usize * height as usize;
    // Some pixels at a time, which takes an eighth of the instructions.
    const SOME: usize = 16;
    let mut pixels = Vec::new();
    pixels
        .try_reserve_exact(length.div_ceil(SOME))
        .map_err(|_| DrawError::Memory(width, height))?;
    // In parallel, as most of the time goes by while the system gives the memory.
    let empty = [tile::empty_pixel(drawing.background, samples); SOME];
    pixels.par_extend(rayon::iter::repeat_n(empty, length.div_ceil(SOME)));
    let mut pixels = pixels.into_flattened();
    pixels.truncate(length);
    Ok(Picture {
        width,
        height,
        pixels,
    })
}

impl Parts {
    /// The painted layer that a segment shows, by its place among them.
    #[inline(always)]
    fn painted_layer_of(&self, segment: &Segment) -> Option<usize> {
        let stroke = segment.colored().checked_sub(1)?;
        self.painted[stroke as usize]
    }

    fn collect(&mut self, drawing: &Drawing, strokes: &[Stroke], stacks: &[Stack]) {
        let tile_height = tile::height(stacks);
        let Self {
            segments,
            triangles,
            triangles_of_tiles,
            joint_rows,
            painted,
            decals,
        } = self;
        let place_of = |stroke: &Stroke| {
            let layers = &drawing.painting.layers;
            layers.iter().position(|it| it.layer == stroke.layer)
        };
        painted.clear();
        painted.extend(strokes.iter().map(place_of));
        // Some of both goes on in one thread.
        rayon::join(
            || {
                segments.collect(drawing, strokes, Kind::Ordered, tile_height);
                decals.collect(drawing, tile_height);
                joint_rows.fill(&drawing.painting, drawing.clump.len());
            },
            || {
                surface::collect(drawing, stacks, Instructions::best(), triangles);
                let [width, height] = drawing.size.map(|side| side as usize);
                let (across, bands) = (width.div_ceil(tile::WIDTH), height.div_ceil(tile_height));
                let reached = triangles.iter().map(|triangle| {
                    let columns = cells(triangle.bounds.x(), tile::WIDTH);
                    [columns, cells(triangle.bounds.y(), tile_height)]
                });
                triangles_of_tiles.fill_rows([across, bands], reached);
            },
        );
    }
}

/// Everything that is needed to draw a part of a picture.
#[derive(Clone, Copy)]
struct Frame<'a> {
    drawing: &'a Drawing,
    strokes: &'a [Stroke],
    parts: &'a Parts,
    /// In a pixel.
    samples: usize,
    stacks: &'a [Stack],
    /// What its stages are compiled for.
    instructions: Instructions,
    /// For each joint its run, where samples tell what they show.
    runs_of_joints: &'a [u32],
    /// What pixels that nothing covers are to be, where they aren't.
    to_fill: Option<[f32; 4]>,
}

impl Frame<'_> {
    /// Makes of some columns of a band what pixels are that nothing covers.
    fn fill(&self, pixels: &mut [[f32; 4]], columns: Range<usize>) {
        if let Some(empty) = self.to_fill {
            for pixels in pixels.chunks_mut(self.drawing.size[0] as usize) {
                pixels[columns.clone()].fill(empty);
            }
        }
    }

    /// What strands of the tile at `origin` are drawn in.
    #[inline(always)]
    fn tile_at(&self, origin: [usize; 2]) -> TileContext<'_> {
        TileContext {
            drawing: self.drawing,
            strokes: self.strokes,
            segments: self.parts.segments.list(),
            origin,
            stack: &self.stacks[0],
            instructions: self.instructions,
        }
    }
}

/// Where a band's samples go.
enum Output<'a> {
    /// Their means, as the band's pixels.
    Pixels(&'a mut [[f32; 4]]),
    /// What the samples of one stack tell.
    Samples(BandPlanes<'a>),
    /// Their means, and what lines over them need.
    UnderLines(BandUnderLines<'a>),
}

/// A thread's own memory.
struct Worker {
    /// The segments that reach each of a band's tiles.
    segments_of_tiles: TileLists,
    target: Target,
    parts: Vec<Part>,
    strand: StrandMasks,
    sums: Sums,
    /// What samples show; empty where nothing is declared or painted.
    shown: Shown,
    /// Which pictures on triangles they show.
    pictures: tile::IdPlane,
    painter: Painter,
    meshes: MeshPainter,
    decals: Decals,
    /// Where lines of the whole picture are found; empty where there are none.
    ribbon: Ribbon,
    finder: Finder,
}

impl Worker {
    fn new() -> Self {
        Self {
            segments_of_tiles: TileLists::default(),
            target: Target::new(),
            parts: Vec::new(),
            strand: StrandMasks::new(),
            sums: Sums::new(),
            shown: Shown::default(),
            pictures: tile::id_plane(),
            painter: Painter::default(),
            meshes: MeshPainter::default(),
            decals: Decals::default(),
            ribbon: Ribbon::default(),
            finder: Finder::default(),
        }
    }

    /// Draws a row of tiles into its pixels, or into planes of its samples.
    fn draw_band(&mut self, frame: &Frame, band: usize, output: Output) {
        frame.instructions.run(
            #[inline(always)]
            || self.sort_into_tiles(frame, band),
        );
        match output {
            Output::Pixels(pixels) => self.draw_pixels(frame, band, pixels),
            Output::Samples(planes) => self.draw_samples(frame, band, planes),
            Output::UnderLines(output) => self.draw_under_lines(frame, band, output),
        }
    }

    /// Finds the segments of each of the band's tiles.
    #[inline(always)]
    fn sort_into_tiles(&mut self, frame: &Frame, band: usize) {
        let tiles = (frame.drawing.size[0] as usize).div_ceil(tile::WIDTH);
        let segments = &frame.parts.segments;
        self.segments_of_tiles.fill(tiles, segments, band);
        if !frame.parts.decals.is_empty() {
            self.sort_decals_into_tiles(frame, band);
        }
    }

    fn draw_pixels(&mut self, frame: &Frame, band: usize, pixels: &mut [[f32; 4]]) {
        let width = frame.drawing.size[0] as usize;
        let tiles = width.div_ceil(tile::WIDTH);
        for tile in 0..tiles {
            let x = tile * tile::WIDTH;
            let end = (x + tile::WIDTH).min(width);
            let triangles = frame.parts.triangles_of_tiles.bin(band * tiles + tile);
            if triangles.is_empty() && self.segments_of_tiles.segments(tile).is_empty() {
                frame.fill(pixels, x..end);
                continue;
            }
            self.draw_tile(
                frame,
                tile,
                triangles,
                [x, band * tile::height(frame.stacks)],
            );
            self.write_means(frame, pixels, x..end);
        }
    }

    /// Writes the means of a tile's samples into some columns of its band.
    fn write_means(&self, frame: &Frame, pixels: &mut [[f32; 4]], columns: Range<usize>) {
        let width = frame.drawing.size[0] as usize;
        frame.instructions.run(
            #[inline(always)]
            || {
                for (row, pixels) in pixels.chunks_mut(width).enumerate() {
                    let pixels = &mut pixels[columns.start..columns.end];
                    self.sums.write(row, frame.samples, pixels);
                }
            },
        );
    }

    /// Sums up the samples of the tile at `origin`.
    fn draw_tile(&mut self, frame: &Frame, tile: usize, triangles: &[u32], origin: [usize; 2]) {
        self.sums.clear(tile::height(frame.stacks));
        let mut scene = frame.tile_at(origin);
        self.find_strands(frame, &scene, tile);
        for stack in frame.stacks {
            scene.stack = stack;
            if paint_mesh::tells(frame) {
                self.draw_stack::<true>(frame, &scene, tile, triangles);
            } else {
                self.draw_stack::<false>(frame, &scene, tile, triangles);
            }
            self.color_stack(frame, &scene, tile);
            self.add_up(frame, stack);
        }
    }

    /// Draws the samples of the tile at `origin`, where one stack holds all of a pixel, or all that are asked for; what they show is noted.
    fn draw_samples_of_tile(
        &mut self,
        frame: &Frame,
        tile: usize,
        triangles: &[u32],
        origin: [usize; 2],
    ) {
        let scene = frame.tile_at(origin);
        self.find_strands(frame, &scene, tile);
        self.draw_stack::<true>(frame, &scene, tile, triangles);
        self.color_stack(frame, &scene, tile);
    }

    /// Adds the samples that are drawn, of such a stack, to the sums of their pixels.
    fn add_up(&mut self, frame: &Frame, stack: &Stack) {
        let is_opaque = frame.drawing.background.is_some();
        frame.instructions.run(
            #[inline(always)]
            || self.sums.add(&mut self.target, stack, is_opaque),
        );
    }

    /// Finds the strands of a tile.
    fn find_strands(&mut self, frame: &Frame, scene: &TileContext, tile: usize) {
        frame.instructions.run(
            #[inline(always)]
            || scene.strands(&self.segments_of_tiles, tile, &mut self.parts),
        );
    }

    /// Gives samples that are drawn the colours that are painted, or are those of decals.
    fn color_stack(&mut self, frame: &Frame, scene: &TileContext, tile: usize) {
        let has_decals = !frame.parts.decals.is_empty();
        let instructions = frame.instructions;
        if has_decals {
            instructions.run(
                #[inline(always)]
                || self.decide_decals(frame, scene, tile),
            );
        }
        if paint_mesh::tells(frame) {
            instructions.run(
                #[inline(always)]
                || self.paint(frame),
            );
        }
        if has_decals {
            instructions.run(
                #[inline(always)]
                || self.apply_decals(frame, scene.origin, scene.stack),
            );
        }
        if paint_mesh::tells(frame) {
            instructions.run(
                #[inline(always)]
                || self.paint_meshes(frame, scene.origin, scene.stack),
            );
        }
    }

    /// Draws the samples of all pixels of a tile that a stack holds into the target. Where it `TELLS`, what they show is noted.
    fn draw_stack<const TELLS: bool>(
        &mut self,
        frame: &Frame,
        scene: &TileContext,
        tile: usize,
        triangles: &[u32],
    ) {
        let instructions = frame.instructions;
        let keeps_triangles = TELLS || frame.parts.decals.on_surfaces;
        instructions.run(
            #[inline(always)]
            || {
                self.target
                    .keep_outlines(frame.parts.decals.asks_for_outlines);
                self.target.clear(frame.drawing.background);
                if keeps_triangles {
                    self.shown.clear();
                }
            },
        );
        let mut pictures = Pictures::new(&mut self.pictures);
        if !triangles.is_empty() {
            let (target, shown) = (&mut self.target, &mut self.shown);
            let pictures = &mut pictures;
            instructions.run(
                #[inline(always)]
                || {
                    let shows = |cell, index, lanes: &StoreMask| {
                        if keeps_triangles {
                            shown.put_triangle(cell, index, lanes);
                        }
                    };
                    surface::draw_all(
                        &frame.parts.triangles,
                        triangles,
                        frame.drawing,
                        &surface::Tile {
                            origin: scene.origin,
                            stack: scene.stack,
                        },
                        (target, pictures),
                        shows,
                    );
                    target.finish_surfaces();
                },
            );
        }
        let sees_through = TELLS && frame.drawing.mesh_painting.sees_through();
        if sees_through {
            instructions.run(
                #[inline(always)]
                || {
                    pictures.look_up(scene.stack, &mut self.target);
                    self.meshes.keep_under(frame, &self.shown, &self.target);
                },
            );
        }
        let segments_of_tile = self.segments_of_tiles.segments(tile);
        instructions.run(
            #[inline(always)]
            || {
                for part in &self.parts {
                    self.strand.draw::<TELLS>(
                        scene,
                        segments_of_tile,
                        part,
                        &mut self.target,
                        &mut self.shown,
                    );
                }
                self.strand.draw_outlines::<TELLS>(
                    scene,
                    segments_of_tile,
                    &mut self.target,
                    &mut self.shown,
                );
            },
        );
        if !sees_through {
            instructions.run(
                #[inline(always)]
                || pictures.look_up(scene.stack, &mut self.target),
            );
        }
    }
}
