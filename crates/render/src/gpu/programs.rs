//! The pipelines of a renderer: for the layers that are on, and for the order in which they are drawn.

use super::buffer::Growing;
use super::error::GpuError;
use super::pipelines::{self, Binding, layout, pipelines};
use super::program;
use super::scene::SceneWords;
use crate::drawing::Order;
use crate::frame::Frame;
use effects::ProgramSource;
use wgpu::{BindGroupLayout, BufferUsages, ComputePipeline, Device};

/// All compute pipelines. They stay from frame to frame.
pub(super) struct Programs {
    pub(super) layouts: Layouts,
    /// In the order in which they run.
    pub(super) bins: Vec<ComputePipeline>,
    pub(super) tiles: Option<(Order, ComputePipeline)>,
    pub(super) clump: Option<Program>,
    pub(super) layers: Vec<LayerPrograms>,
    pub(super) smooth: Option<Smooth>,
}

/// What following a frame took.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Change {
    /// Pipelines made.
    pub(super) made: usize,
    /// Whether layers came, went or changed places: what they bind is to be made anew.
    pub(super) rebinds: bool,
}

/// A pipeline with what it was made from.
pub(super) struct Program {
    made_from: ProgramKey,
    pub(super) pipeline: ComputePipeline,
}

/// What a program's text hangs on.
#[derive(Clone, PartialEq)]
struct ProgramKey {
    wgsl: &'static str,
    varying: Vec<usize>,
    joint_constants: String,
}

/// A layer's shader, and the words that it reads.
pub(super) struct LayerPrograms {
    pub(super) program: Program,
    pub(super) words: Growing,
    is_smoothed: bool,
}

/// The smoothing of all layers.
pub(super) struct Smooth {
    joint_constants: String,
    pub(super) pipelines: Vec<ComputePipeline>,
}

/// What each kind of pass binds.
pub(super) struct Layouts {
    pub(super) clump: BindGroupLayout,
    pub(super) strokes: BindGroupLayout,
    pub(super) smooth: BindGroupLayout,
    pub(super) bins: BindGroupLayout,
    pub(super) tiles: BindGroupLayout,
}

impl Programs {
    /// What every frame needs.
    pub(super) fn new(device: &Device) -> Result<Self, GpuError> {
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
        let text = program::bins();
        Ok(Self {
            bins: pipelines(device, "bins", &text, &layouts.bins, &entry_points)?,
            layouts,
            tiles: None,
            clump: None,
            layers: Vec::new(),
            smooth: None,
        })
    }

    /// How many pipelines there are.
    pub(super) fn count(&self) -> usize {
        self.bins.len()
            + usize::from(self.tiles.is_some())
            + usize::from(self.clump.is_some())
            + self.layers.len()
            + self.smooth.as_ref().map_or(0, |s| s.pipelines.len())
    }

    /// Makes the pipelines of layers that are new, and drops those of layers that are gone.
    pub(super) fn follow(
        &mut self,
        device: &Device,
        frame: &Frame,
        scene: &SceneWords,
    ) -> Result<Change, GpuError> {
        let joint_constants = scene.layout.constants();
        let key = |source: &ProgramSource| ProgramKey {
            wgsl: source.wgsl,
            varying: source.varying.to_vec(),
            joint_constants: joint_constants.clone(),
        };
        let mut change = Change::default();
        let clump = frame.clump.source();
        let made_from = key(&clump);
        let is_it = |program: &Program| program.made_from == made_from;
        if !self.clump.as_ref().is_some_and(is_it) {
            let text = program::clump(&clump, &scene.layout);
            let pipeline = one_pipeline(device, "the clump", &text, &self.layouts.clump)?;
            self.clump = Some(Program {
                made_from,
                pipeline,
            });
            change.made += 1;
        }
        let mut before = std::mem::take(&mut self.layers);
        for (layer, words) in frame.layers.iter().zip(&scene.layers) {
            let source = layer.program.source();
            let made_from = key(&source);
            let is_it = |l: &LayerPrograms| {
                l.program.made_from == made_from && l.is_smoothed == words.is_smoothed
            };
            let place = before.iter().position(is_it);
            // In the same order each is the first of those that are left.
            change.rebinds |= place != Some(0);
            let programs = match place {
                Some(place) => before.remove(place),
                None => {
                    let text = program::strokes(&source, &scene.layout);
                    let layout = &self.layouts.strokes;
                    let pipeline = one_pipeline(device, layer.effect, &text, layout)?;
                    change.made += 1;
                    LayerPrograms {
                        program: Program {
                            made_from,
                            pipeline,
                        },
                        words: Growing::new(
                            "a layer's parameters",
                            BufferUsages::STORAGE | BufferUsages::COPY_DST,
                        ),
                        is_smoothed: words.is_smoothed,
                    }
                }
            };
            self.layers.push(programs);
        }
        change.rebinds |= !before.is_empty();
        let is_current = |s: &Smooth| s.joint_constants == joint_constants;
        if !scene.layers.iter().any(|layer| layer.is_smoothed) {
            self.smooth = None;
        } else if !self.smooth.as_ref().is_some_and(is_current) {
            let entry_points = ["find_gaps", "close_gaps", "find_specks", "open_specks"];
            let text = program::smooth(&scene.layout);
            let layout = &self.layouts.smooth;
            let made = pipelines(device, "smooth", &text, layout, &entry_points)?;
            change.made += made.len();
            self.smooth = Some(Smooth {
                joint_constants,
                pipelines: made,
            });
        }
        Ok(change)
    }

    /// Makes the pipeline that draws tiles in that order; says how many that took.
    pub(super) fn draw_in(&mut self, device: &Device, order: Order) -> Result<usize, GpuError> {
        if self.tiles.as_ref().is_some_and(|(made, _)| *made == order) {
            return Ok(0);
        }
        let number = match order {
            Order::Rounded => 0,
            Order::StrandFirst => 1,
            Order::Shifted => 2,
        };
        let text = program::tiles(number);
        let made = pipelines(device, "tiles", &text, &self.layouts.tiles, &["draw_tile"])?;
        self.tiles = made.into_iter().next().map(|pipeline| (order, pipeline));
        Ok(1)
    }
}

fn one_pipeline(
    device: &Device,
    name: &str,
    text: &str,
    layout: &BindGroupLayout,
) -> Result<ComputePipeline, GpuError> {
    let made = pipelines(device, name, text, layout, &["gpu_main"])?;
    made.into_iter().next().ok_or(GpuError::Memory)
}
