//! The source's own way of drawing, to measure the exact one against: each stroke is stamped disc by
//! disc, and each disc is tested for depth. It shares the rasteriser's tiles, lanes and threads.

use super::bin::{Bins, Bounds, cells};
use super::instructions::Instructions;
use super::tile::{self, Cell, LANES, NOTHING, Stack, StoreMask, Sums, Target, any, select};
use super::{DrawError, RasterizerError, empty_picture, segment};
use crate::check;
use crate::drawing::{Brush, Drawing, LayerStrokes};
use crate::picture::Picture;
use crate::samples::sample_positions;
use glam::Vec2;
use rayon::prelude::*;
use segment::Stroke;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Stamps the strokes of [`Drawing`]s.
///
/// The order is the source's ([`Order::Shifted`](crate::Order::Shifted)) whatever the drawing says,
/// and the disc in front gives the colour. Surfaces are left out.
pub struct Stamper {
    pool: rayon::ThreadPool,
    /// In a pixel.
    samples: usize,
    stacks: Vec<Stack>,
    stamps: Vec<Stamp>,
    bands: Bins,
    instructions: Instructions,
    /// One for each thread.
    workers: Vec<Mutex<Worker>>,
}

/// A disc of one colour.
#[derive(Clone, Copy, Debug)]
struct Stamp {
    center: Vec2,
    radius_squared: f32,
    inv_depth: f32,
    color: [f32; 3],
    /// Where only half of the disc is put down: the direction of the path, of which that half lies behind.
    ahead: Vec2,
    /// The first and one beyond the last pixel that it may reach; pictures have at most
    /// [`MAX_SIZE`](super::MAX_SIZE).
    columns: [u16; 2],
    rows: [u16; 2],
}

/// What a row of tiles shows.
struct Band<'a> {
    drawing: &'a Drawing,
    samples: usize,
    stacks: &'a [Stack],
    stamps: &'a [Stamp],
    /// Indices of those stamps that reach it.
    in_band: &'a [u32],
    index: usize,
}

struct Worker {
    tiles: Bins,
    target: Target,
    sums: Sums,
}

impl Stamper {
    /// With that many samples in a pixel and threads, as a [`Rasterizer`](super::Rasterizer).
    ///
    /// # Errors
    ///
    /// When there is no such number of samples, or the system gives no threads.
    pub fn new(samples: u32, threads: Option<usize>) -> Result<Self, RasterizerError> {
        let samples = sample_positions(samples)?;
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.unwrap_or(0))
            .build()?;
        let worker = || Worker {
            tiles: Bins::default(),
            target: Target::new(),
            sums: Sums::new(),
        };
        Ok(Self {
            samples: samples.len(),
            stacks: Stack::of_pixel(&samples),
            stamps: Vec::new(),
            bands: Bins::default(),
            instructions: Instructions::best(),
            workers: (0..pool.current_num_threads())
                .map(|_| Mutex::new(worker()))
                .collect(),
            pool,
        })
    }

    /// Draws a picture with `per_interval` stamps (at least 1) from each joint on to the next, and
    /// one at the last.
    ///
    /// # Errors
    ///
    /// When the drawing is invalid.
    pub fn draw(&mut self, drawing: &Drawing, per_interval: usize) -> Result<Picture, DrawError> {
        let Self {
            pool,
            samples,
            stacks,
            stamps,
            bands,
            instructions,
            workers,
        } = self;
        pool.install(|| {
            check::check(drawing)?;
            let mut picture = empty_picture(drawing, *samples)?;
            collect(drawing, per_interval.max(1), stamps);
            let rows = stamps.iter().map(|stamp| stamp.rows).zip(0..);
            let height = tile::height(stacks);
            let count = (drawing.size[1] as usize).div_ceil(height);
            bands.fill(count, rows.map(|(rows, i)| (i, cells(rows, height))));
            let band_length = drawing.size[0] as usize * height;
            let chunks = picture.pixels.par_chunks_mut(band_length);
            chunks.enumerate().for_each(|(index, pixels)| {
                let band = Band {
                    drawing,
                    samples: *samples,
                    stacks,
                    stamps,
                    in_band: bands.bin(index),
                    index,
                };
                let thread = rayon::current_thread_index().unwrap_or(0);
                let mut worker = workers[thread]
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner);
                instructions.run(
                    #[inline(always)]
                    || worker.draw_band(&band, pixels),
                );
            });
            Ok(picture)
        })
    }
}

/// Replaces `stamps` by those of a checked drawing that may be seen: the highest stroke of all strands
/// first, in a stroke by strand. So the first is in front where depths are equal.
fn collect(drawing: &Drawing, per_interval: usize, stamps: &mut Vec<Stamp>) {
    let strokes = segment::strokes_in_order(drawing, segment::Kind::Ordered);
    let of_stroke = |stroke: &Stroke| {
        let (layer, instance) = (&drawing.layers[stroke.layer], stroke.instance);
        let runs = drawing.runs.iter();
        runs.flat_map(move |run| {
            layer
                .on(instance, &run.joints)
                .map(move |s| (layer, s.places()))
        })
    };
    let pieces: Vec<_> = strokes.iter().rev().flat_map(of_stroke).collect();
    stamps.clear();
    stamps.par_extend(
        pieces
            .into_par_iter()
            .flat_map_iter(|(layer, places)| of_stretch(drawing, layer, places, per_interval)),
    );
}

/// The stamps of one stretch of a stroke, whose places these are in the lists of its layer.
fn of_stretch<'a>(
    drawing: &Drawing,
    layer: &'a LayerStrokes,
    places: Range<usize>,
    per_interval: usize,
) -> impl Iterator<Item = Stamp> + use<'a> {
    let (start, last) = (places.start, places.end - 1);
    let size = drawing.size;
    let brush = drawing.brush;
    let between = (start..last).flat_map(move |i| {
        (0..per_interval).map(move |k| (i, i + 1, k as f32 / per_interval as f32))
    });
    between
        .chain([(last, last, 0.0)])
        .filter_map(move |(i, j, way)| {
            let (a, b) = (&layer.discs[i], &layer.discs[j]);
            let mix = |a: f32, b: f32| a + way * (b - a);
            let center = a.center + way * (b.center - a.center);
            let radius = mix(a.radius, b.radius).max(0.0);
            if radius <= 0.0 {
                return None;
            }
            let bounds = Bounds::of_box(center - radius, center + radius, size)?;
            let (from, to) = (layer.colors[i], layer.colors[j]);
            // At the last joint there is but the way to it.
            let (before, next) = if i == j {
                (i.max(start + 1) - 1, i)
            } else {
                (i, j)
            };
            let way = layer.discs[next].center - layer.discs[before].center;
            Some(Stamp {
                center,
                radius_squared: radius * radius,
                inv_depth: mix(a.inv_depth, b.inv_depth),
                color: [0, 1, 2].map(|channel| mix(from[channel], to[channel])),
                ahead: match brush {
                    Brush::Circle => Vec2::ZERO,
                    Brush::Semicircle => way,
                },
                columns: bounds.x(),
                rows: bounds.y(),
            })
        })
}

impl Worker {
    #[inline(always)] // compiled for each set of `Instructions`
    fn draw_band(&mut self, band: &Band, pixels: &mut [[f32; 4]]) {
        let Band {
            drawing,
            samples,
            stacks,
            stamps,
            in_band,
            index,
        } = *band;
        let width = drawing.size[0] as usize;
        let tiles = width.div_ceil(tile::WIDTH);
        let columns = in_band
            .iter()
            .map(|&i| (i, cells(stamps[i as usize].columns, tile::WIDTH)));
        self.tiles.fill(tiles, columns);
        for tile in 0..tiles {
            let origin = [tile * tile::WIDTH, index * tile::height(stacks)];
            self.sums.clear(tile::height(stacks));
            for stack in stacks {
                self.target.clear(drawing.background);
                for &stamp in self.tiles.bin(tile) {
                    stamps[stamp as usize].draw(origin, stack, &mut self.target);
                }
                let is_opaque = drawing.background.is_some();
                self.sums.add(&mut self.target, stack, is_opaque);
            }
            let end = (origin[0] + tile::WIDTH).min(width);
            for (row, pixels) in pixels.chunks_mut(width).enumerate() {
                self.sums.write(row, samples, &mut pixels[origin[0]..end]);
            }
        }
    }
}

impl Stamp {
    /// Where the stamp covers a sample and is nearer than what is there, it takes its place.
    #[inline(always)]
    fn draw(&self, origin: [usize; 2], stack: &Stack, target: &mut Target) {
        let clip = |[start, end]: [u16; 2], origin: usize, size: usize| {
            let (start, end) = (usize::from(start), usize::from(end));
            start.max(origin) - origin..end.min(origin + size) - origin
        };
        let columns = clip(self.columns, origin[0], tile::WIDTH);
        let across = columns.start / tile::CELL_WIDTH..columns.end.div_ceil(tile::CELL_WIDTH);
        let pixels = clip(self.rows, origin[1], tile::ROWS * stack.height);
        let center = self.center - Vec2::new(origin[0] as f32, origin[1] as f32);
        for row in stack.rows(pixels) {
            for cell in across.clone() {
                let cell = Cell::new(row, cell * tile::CELL_WIDTH);
                let corner = Vec2::new(cell.column as f32, (row * stack.height) as f32);
                self.draw_cell(corner - center, stack, cell.index, target);
            }
        }
    }

    /// `corner` is the cell's, from the disc's centre.
    #[inline(always)]
    fn draw_cell(&self, corner: Vec2, stack: &Stack, cell: usize, target: &mut Target) {
        let nearest = &mut target.strand[cell];
        let mut wins = [0; LANES];
        for k in 0..LANES {
            let (x, y) = (corner.x + stack.x[k], corner.y + stack.y[k]);
            let is_behind = x * self.ahead.x + y * self.ahead.y <= 0.0;
            let is_covered = (x * x + y * y <= self.radius_squared) & is_behind;
            let depth = select(is_covered, self.inv_depth, NOTHING);
            wins[k] = select(depth > nearest[k], u32::MAX, 0);
        }
        if !any(&wins) {
            return;
        }
        let wins = StoreMask::new(&wins);
        wins.store(&[self.inv_depth; LANES], nearest);
        for (plane, color) in target.color.iter_mut().zip(self.color) {
            wins.store(&[color; LANES], &mut plane[cell]);
        }
    }
}
