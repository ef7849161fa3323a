//! The pipelines of a renderer: for the layers that are on, and for the order in which they are drawn.

use super::buffer::Growing;
use super::error::GpuError;
use super::pipelines::{self, Binding, layout, pipelines, tiles_bindings};
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
    /// By what it is made for.
    pub(super) tiles: Option<(TilesKey, ComputePipeline)>,
    /// One for each object.
    pub(super) clumps: Vec<JointProgram>,
    /// One for each layer of each object.
    pub(super) layers: Vec<JointProgram>,
    pub(super) smooth: Option<Smooth>,
}

/// What the pipeline that draws tiles is made for.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct TilesKey {
    pub(super) order: Order,
    /// What samples are kept with.
    pub(super) tells: Tells,
    /// Whether there are pictures on surfaces.
    pub(super) textured: bool,
    /// Whether strokes have brushes.
    pub(super) brushed: bool,
    /// Whether strokes are drawn on what is seen.
    pub(super) decals: bool,
}

impl TilesKey {
    /// Whether it looks pictures up.
    pub(super) fn has_pictures(&self) -> bool {
        self.textured || self.brushed
    }
}

/// What tiles keep of samples beside their colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tells {
    Nothing,
    /// What they show.
    Shown,
    /// The same, and the surfaces that hair hides.
    Under,
}

impl Tells {
    const ALL: [Self; 3] = [Self::Nothing, Self::Shown, Self::Under];

    /// How many textures that takes.
    pub(super) fn textures(self) -> usize {
        self as usize
    }
}

/// What following a frame took.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Change {
    /// Pipelines made.
    pub(super) made: usize,
    /// Whether layers came, went or changed places: what they bind is to be made anew.
    pub(super) rebinds: bool,
}

/// A pipeline that works out something at each joint, and the words that it reads.
pub(super) struct JointProgram {
    made_from: ProgramKey,
    pub(super) pipeline: ComputePipeline,
    pub(super) words: Growing,
    is_smoothed: bool,
}

/// What a program's text hangs on.
#[derive(Clone, PartialEq)]
struct ProgramKey {
    wgsl: &'static str,
    varying: Vec<usize>,
    joint_constants: String,
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
    /// By what they tell, and whether there are pictures; none of what the device has too few textures for.
    tiles: Vec<[BindGroupLayout; 2]>,
}

impl Layouts {
    /// What the pipeline that draws tiles binds.
    ///
    /// # Errors
    ///
    /// Where the device has too few textures.
    pub(super) fn tiles(&self, tells: Tells, pictures: bool) -> Result<&BindGroupLayout, GpuError> {
        let layouts = self.tiles.get(tells.textures());
        let layout = layouts.map(|layouts| &layouts[usize::from(pictures)]);
        layout.ok_or(GpuError::Limit {
            what: "storage textures in a shader",
            has: self.tiles.len() as u64 - 1,
            needs: tells.textures() as u64,
        })
    }
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
            tiles: (Tells::ALL.into_iter())
                .filter(|tells| {
                    let most = device.limits().max_storage_textures_per_shader_stage;
                    tells.textures() <= most as usize
                })
                .map(|tells| {
                    [false, true].map(|pictures| of("tiles", &tiles_bindings(tells, pictures)))
                })
                .collect(),
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
            clumps: Vec::new(),
            layers: Vec::new(),
            smooth: None,
        })
    }

    /// How many pipelines there are.
    pub(super) fn count(&self) -> usize {
        self.bins.len()
            + usize::from(self.tiles.is_some())
            + distinct(&self.clumps)
            + distinct(&self.layers)
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
        let mut before = std::mem::take(&mut self.clumps);
        for object in &frame.objects {
            let source = object.clump.source();
            let make = || {
                let text = program::clump(&source, &scene.layout);
                one_pipeline(device, "the clump", &text, &self.layouts.clump)
            };
            let made_from = key(&source);
            let program = take(
                &mut before,
                &self.clumps,
                made_from,
                false,
                &mut change,
                make,
            )?;
            self.clumps.push(program);
        }
        change.rebinds |= !before.is_empty();
        let mut before = std::mem::take(&mut self.layers);
        let layers = frame.objects.iter().flat_map(|object| object.layers);
        for (layer, words) in layers.zip(&scene.layers) {
            let source = layer.program.source();
            let make = || {
                let text = program::strokes(&source, &scene.layout);
                one_pipeline(device, layer.effect, &text, &self.layouts.strokes)
            };
            let (made_from, is_smoothed) = (key(&source), words.is_smoothed);
            let program = take(
                &mut before,
                &self.layers,
                made_from,
                is_smoothed,
                &mut change,
                make,
            )?;
            self.layers.push(program);
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

    /// Makes the pipeline that draws tiles; says how many that took.
    pub(super) fn draw_in(&mut self, device: &Device, key: TilesKey) -> Result<usize, GpuError> {
        if self.tiles.as_ref().is_some_and(|(made, _)| *made == key) {
            return Ok(0);
        }
        let text = program::tiles(key);
        let layout = self.layouts.tiles(key.tells, key.has_pictures())?;
        let made = pipelines(device, "tiles", &text, layout, &["draw_tile"])?;
        let made = made.into_iter().next();
        self.tiles = made.map(|pipeline| (key, pipeline));
        Ok(1)
    }
}

/// How many different pipelines there are.
fn distinct(programs: &[JointProgram]) -> usize {
    let is_first = |i: &usize| {
        let made_from = &programs[*i].made_from;
        programs[..*i].iter().all(|p| p.made_from != *made_from)
    };
    (0..programs.len()).filter(is_first).count()
}

/// The next program: one of those that were there `before`, or a new one. Objects of one look share their pipelines.
fn take(
    before: &mut Vec<JointProgram>,
    others: &[JointProgram],
    made_from: ProgramKey,
    is_smoothed: bool,
    change: &mut Change,
    make: impl FnOnce() -> Result<ComputePipeline, GpuError>,
) -> Result<JointProgram, GpuError> {
    let is_it = |p: &JointProgram| p.made_from == made_from && p.is_smoothed == is_smoothed;
    let place = before.iter().position(is_it);
    // In the same order each is the first of those that are left.
    change.rebinds |= place != Some(0);
    if let Some(place) = place {
        return Ok(before.remove(place));
    }
    let shared = others.iter().find(|p| p.made_from == made_from);
    let pipeline = match shared {
        Some(program) => program.pipeline.clone(),
        None => {
            change.made += 1;
            make()?
        }
    };
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
    Ok(JointProgram {
        made_from,
        pipeline,
        words: Growing::new("parameters", usage),
        is_smoothed,
    })
}

pub(super) fn one_pipeline(
    device: &Device,
    name: &str,
    text: &str,
    layout: &BindGroupLayout,
) -> Result<ComputePipeline, GpuError> {
    let made = pipelines(device, name, text, layout, &["gpu_main"])?;
    made.into_iter().next().ok_or(GpuError::Memory)
}
