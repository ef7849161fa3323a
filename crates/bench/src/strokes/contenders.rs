//! The ways to draw strokes that are compared: ours, and libraries that fill outlines.
//!
//! Each is timed from a drawing to its pixels. The libraries know no depth: they fill in
//! [`painters_order`], colours as they are, so that they too blend in linear light.

use super::order::painters_order;
use super::outline::{self, Pen};
use crate::BenchError;
use glam::DVec2;
use render::cpu::Rasterizer;
use render::gpu::{AdapterKind, GpuError, Offscreen};
use render::{Drawing, Order, Picture};
use std::cell::RefCell;
use std::rc::Rc;
use tiny_skia::PathBuilder;
use vello_cpu::color::{AlphaColor, Srgb};
use vello_cpu::kurbo::{BezPath, Point};
use vello_cpu::{RenderContext, RenderSettings, Resources};

/// A way to draw strokes. It may keep memory from picture to picture, no results.
pub trait Contender {
    /// Draws the whole picture: this is what is timed.
    ///
    /// # Errors
    ///
    /// When it cannot draw that.
    fn draw(&mut self, drawing: &Drawing) -> Result<(), BenchError>;

    /// What it drew last: linear, premultiplied. Not timed.
    fn picture(&self) -> Option<Picture>;

    /// What of the time it spent drawing, by a clock of its own, where it has one: without what went to and fro.
    fn seconds_within(&self) -> Option<f64> {
        None
    }
}

/// What is filled at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outlines {
    /// The outline of each segment, in the mean of its joints' colours.
    Segments,
    /// The outline of each stroke along a run, in its first colour.
    Strokes,
}

/// The exact sweep of this project.
pub struct Sweep {
    rasterizer: Rasterizer,
    picture: Option<Picture>,
}

impl Sweep {
    /// With that many samples a pixel and threads.
    ///
    /// # Errors
    ///
    /// When there are no such numbers.
    pub fn new(samples: u32, threads: usize) -> Result<Self, BenchError> {
        Ok(Self {
            rasterizer: Rasterizer::new(samples, Some(threads)).map_err(|e| e.to_string())?,
            picture: None,
        })
    }
}

impl Contender for Sweep {
    fn draw(&mut self, drawing: &Drawing) -> Result<(), BenchError> {
        self.picture = Some(self.rasterizer.draw(drawing).map_err(|e| e.to_string())?);
        Ok(())
    }

    fn picture(&self) -> Option<Picture> {
        self.picture.clone()
    }
}

/// The exact sweep on a graphics card, from a drawing in the CPU's memory to a picture there.
pub struct OnCard {
    /// Shared by all who draw on it: a device of each one's own would take the card's memory.
    card: Rc<RefCell<Offscreen>>,
    samples: u32,
    picture: Option<Picture>,
    seconds_within: Option<f64>,
}

impl OnCard {
    /// A real graphics card for several to draw on; nothing where there is none.
    ///
    /// # Errors
    ///
    /// When there is one that can't be used.
    pub fn card() -> Result<Option<Rc<RefCell<Offscreen>>>, BenchError> {
        match Offscreen::open(AdapterKind::Hardware) {
            Ok(card) => Ok(Some(Rc::new(RefCell::new(card)))),
            Err(GpuError::NoAdapter { .. }) => Ok(None),
            Err(error) => Err(error.to_string().into()),
        }
    }

    /// On that card, with that many samples a pixel.
    #[must_use]
    pub fn new(card: &Rc<RefCell<Offscreen>>, samples: u32) -> Self {
        Self {
            card: Rc::clone(card),
            samples,
            picture: None,
            seconds_within: None,
        }
    }
}

impl Contender for OnCard {
    fn draw(&mut self, drawing: &Drawing) -> Result<(), BenchError> {
        let mut card = self.card.borrow_mut();
        let drawn = card.draw_strokes(drawing, self.samples);
        self.picture = Some(drawn.map_err(|error| error.to_string())?);
        let parts = card.stats().milliseconds;
        self.seconds_within = parts.map(|parts| 1e-3 * parts.iter().sum::<f64>());
        Ok(())
    }

    fn picture(&self) -> Option<Picture> {
        self.picture.clone()
    }

    fn seconds_within(&self) -> Option<f64> {
        self.seconds_within
    }
}

/// `vello_cpu`, by its faster pipeline of 8 bits a channel.
pub struct Vello {
    outlines: Outlines,
    context: RenderContext,
    resources: Resources,
    pixmap: vello_cpu::Pixmap,
    path: BezPath,
}

impl Vello {
    /// For pictures of that size (each side at most 65,535). With 0 workers the calling thread does
    /// all; else it records while they work.
    #[must_use]
    pub fn new([width, height]: [u16; 2], outlines: Outlines, workers: u16) -> Self {
        let settings = RenderSettings {
            num_threads: workers,
            ..RenderSettings::default()
        };
        Self {
            outlines,
            context: RenderContext::new_with(width, height, settings),
            resources: Resources::new(),
            pixmap: vello_cpu::Pixmap::new(width, height),
            path: BezPath::new(),
        }
    }
}

impl Contender for Vello {
    fn draw(&mut self, drawing: &Drawing) -> Result<(), BenchError> {
        let Self { context, path, .. } = self;
        context.reset();
        for_each_figure(drawing, self.outlines, path, |path, [r, g, b]| {
            context.set_paint(AlphaColor::<Srgb>::new([r, g, b, 1.0]));
            context.fill_path(path);
            path.truncate(0);
        });
        context.flush();
        context.render(&mut self.pixmap, &mut self.resources);
        Ok(())
    }

    fn picture(&self) -> Option<Picture> {
        let size = [self.pixmap.width().into(), self.pixmap.height().into()];
        Some(picture_of(size, self.pixmap.data_as_u8_slice()))
    }
}

/// `tiny-skia`, on one thread as it is.
pub struct TinySkia {
    outlines: Outlines,
    pixmap: tiny_skia::Pixmap,
    path: PathBuilder,
}

impl TinySkia {
    /// For pictures of that size.
    ///
    /// # Errors
    ///
    /// When there is no such size.
    pub fn new([width, height]: [u16; 2], outlines: Outlines) -> Result<Self, BenchError> {
        let pixmap = tiny_skia::Pixmap::new(width.into(), height.into());
        Ok(Self {
            outlines,
            pixmap: pixmap.ok_or_else(|| format!("no pixmap of {width} x {height}"))?,
            path: PathBuilder::new(),
        })
    }
}

impl Contender for TinySkia {
    fn draw(&mut self, drawing: &Drawing) -> Result<(), BenchError> {
        let Self { pixmap, path, .. } = self;
        pixmap.fill(tiny_skia::Color::TRANSPARENT);
        let mut paint = tiny_skia::Paint {
            anti_alias: true,
            ..tiny_skia::Paint::default()
        };
        let identity = tiny_skia::Transform::identity();
        for_each_figure(drawing, self.outlines, path, |path, color| {
            let Some(finished) = std::mem::take(path).finish() else {
                return; // degenerate: it covers nothing
            };
            let [r, g, b] = color.map(|channel| channel.clamp(0.0, 1.0));
            if let Some(color) = tiny_skia::Color::from_rgba(r, g, b, 1.0) {
                paint.set_color(color);
            }
            pixmap.fill_path(
                &finished,
                &paint,
                tiny_skia::FillRule::Winding,
                identity,
                None,
            );
            *path = finished.clear();
        });
        Ok(())
    }

    fn picture(&self) -> Option<Picture> {
        let size = [self.pixmap.width(), self.pixmap.height()];
        Some(picture_of(size, self.pixmap.data()))
    }
}

/// What a user of a library must prepare in every frame: the order and the paths, not filled.
pub struct PathsAlone {
    library: Library,
    outlines: Outlines,
}

/// Whose paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Library {
    /// `vello_cpu`.
    Vello,
    /// `tiny-skia`.
    TinySkia,
}

impl PathsAlone {
    /// The paths of one library.
    #[must_use]
    pub fn new(library: Library, outlines: Outlines) -> Self {
        Self { library, outlines }
    }
}

impl Contender for PathsAlone {
    fn draw(&mut self, drawing: &Drawing) -> Result<(), BenchError> {
        match self.library {
            Library::Vello => {
                for_each_figure(drawing, self.outlines, &mut BezPath::new(), |path, _| {
                    std::hint::black_box(&*path);
                    path.truncate(0);
                });
            }
            Library::TinySkia => {
                for_each_figure(
                    drawing,
                    self.outlines,
                    &mut PathBuilder::new(),
                    |path, _| {
                        if let Some(finished) = std::mem::take(path).finish() {
                            *path = std::hint::black_box(finished).clear();
                        }
                    },
                );
            }
        }
        Ok(())
    }

    fn picture(&self) -> Option<Picture> {
        None
    }
}

/// Draws outline after outline with `pen` and calls `fill` with the colour after each.
fn for_each_figure<P: Pen>(
    drawing: &Drawing,
    outlines: Outlines,
    pen: &mut P,
    mut fill: impl FnMut(&mut P, [f32; 3]),
) {
    for piece in painters_order(drawing) {
        let layer = &drawing.layers[piece.layer];
        let places = piece.places;
        let (discs, colors) = (&layer.discs[places.clone()], &layer.colors[places]);
        match outlines {
            Outlines::Strokes => {
                outline::stroke(discs, pen);
                fill(pen, colors[0]);
            }
            Outlines::Segments => {
                // One joint alone is a segment from itself to itself.
                for from in 0..(discs.len() - 1).max(1) {
                    let to = (from + 1).min(discs.len() - 1);
                    if discs[from].radius > 0.0 || discs[to].radius > 0.0 {
                        outline::segment(&discs[from], &discs[to], pen);
                        let mean = |i: usize| 0.5 * (colors[from][i] + colors[to][i]);
                        fill(pen, [mean(0), mean(1), mean(2)]);
                    }
                }
            }
        }
    }
}

/// A picture of bytes: premultiplied red, green, blue, alpha.
fn picture_of([width, height]: [u32; 2], bytes: &[u8]) -> Picture {
    let (pixels, _) = bytes.as_chunks::<4>();
    Picture {
        width,
        height,
        pixels: pixels
            .iter()
            .map(|pixel| pixel.map(|channel| f32::from(channel) / 255.0))
            .collect(),
    }
}

fn point(point: DVec2) -> Point {
    Point::new(point.x, point.y)
}

impl Pen for BezPath {
    fn move_to(&mut self, to: DVec2) {
        BezPath::move_to(self, point(to));
    }

    fn line_to(&mut self, to: DVec2) {
        BezPath::line_to(self, point(to));
    }

    fn curve_to(&mut self, first: DVec2, second: DVec2, to: DVec2) {
        BezPath::curve_to(self, point(first), point(second), point(to));
    }

    fn close(&mut self) {
        self.close_path();
    }
}

impl Pen for PathBuilder {
    fn move_to(&mut self, to: DVec2) {
        PathBuilder::move_to(self, to.x as f32, to.y as f32);
    }

    fn line_to(&mut self, to: DVec2) {
        PathBuilder::line_to(self, to.x as f32, to.y as f32);
    }

    fn curve_to(&mut self, first: DVec2, second: DVec2, to: DVec2) {
        let [first, second, to] = [first, second, to].map(|point| point.as_vec2());
        self.cubic_to(first.x, first.y, second.x, second.y, to.x, to.y);
    }

    fn close(&mut self) {
        PathBuilder::close(self);
    }
}

/// The drawing in another order.
#[must_use]
pub fn in_order(drawing: &Drawing, order: Order) -> Drawing {
    Drawing {
        order,
        ..drawing.clone()
    }
}
