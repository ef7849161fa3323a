//! The source's own way: a stroke is stamped disc by disc, each tested for depth.

use super::contenders::Contender;
use render::cpu::Rasterizer;
use render::{Disc, Drawing, LayerStrokes, Order, Picture, Run};

/// Stamps every stroke, a number of discs to each interval between joints.
pub struct Stamping {
    per_interval: usize,
    rasterizer: Rasterizer,
    picture: Option<Picture>,
}

impl Stamping {
    /// With that many stamps an interval, samples a pixel and threads.
    ///
    /// # Errors
    ///
    /// When there are no such numbers.
    pub fn new(per_interval: usize, samples: u32, threads: usize) -> Result<Self, String> {
        Ok(Self {
            per_interval,
            rasterizer: Rasterizer::new(samples, Some(threads)).map_err(|e| e.to_string())?,
            picture: None,
        })
    }
}

impl Contender for Stamping {
    fn draw(&mut self, drawing: &Drawing) -> Result<(), String> {
        let stamped = stamped(drawing, self.per_interval);
        self.picture = Some(self.rasterizer.draw(&stamped).map_err(|e| e.to_string())?);
        Ok(())
    }

    fn picture(&self) -> Option<Picture> {
        self.picture.clone()
    }
}

/// The stamps of a drawing as a drawing: each is a strand of one joint, so that the disc in front
/// gives the colour. A stamp stands at each joint, the others at equal steps between two.
#[must_use]
pub fn stamped(drawing: &Drawing, per_interval: usize) -> Drawing {
    let per_interval = per_interval.max(1);
    // Pairs of joints, and how far from the first to the second.
    let mut places = Vec::new();
    for run in &drawing.runs {
        for joint in run.joints.start..run.joints.end - 1 {
            let steps = 0..per_interval;
            places.extend(steps.map(|step| (joint, step as f32 / per_interval as f32)));
        }
        places.push((run.joints.end - 1, 0.0));
    }
    let joints = drawing.clump.len();
    let disc = |discs: &[Disc], (joint, way): (usize, f32)| {
        let (a, b) = (discs[joint], discs[(joint + 1).min(joints - 1)]);
        let mix = |a: f32, b: f32| a + way * (b - a);
        Disc {
            center: a.center + way * (b.center - a.center),
            radius: mix(a.radius, b.radius).max(0.0),
            inv_depth: mix(a.inv_depth, b.inv_depth),
            inv_depth_biased: mix(a.inv_depth_biased, b.inv_depth_biased),
        }
    };
    let color = |colors: &[[f32; 3]], (joint, way): (usize, f32)| {
        let (a, b) = (colors[joint], colors[(joint + 1).min(joints - 1)]);
        [0, 1, 2].map(|i| a[i] + way * (b[i] - a[i]))
    };
    let layers = drawing.layers.iter().map(|layer| {
        let instances = || (0..layer.instances).map(|i| i * joints..(i + 1) * joints);
        let discs = instances().flat_map(|of| {
            let discs = &layer.discs[of];
            places.iter().map(move |place| disc(discs, *place))
        });
        let colors = instances().flat_map(|of| {
            let colors = &layer.colors[of];
            places.iter().map(move |place| color(colors, *place))
        });
        LayerStrokes {
            name: layer.name.clone(),
            rank: layer.rank,
            instances: layer.instances,
            discs: discs.collect(),
            colors: colors.collect(),
        }
    });
    Drawing {
        size: drawing.size,
        layers: layers.collect(),
        runs: (0..places.len())
            .map(|stamp| Run {
                strand: stamp as u32,
                joints: stamp..stamp + 1,
            })
            .collect(),
        clump: places
            .iter()
            .map(|place| disc(&drawing.clump, *place))
            .collect(),
        surfaces: drawing.surfaces.clone(),
        background: drawing.background,
        order: Order::Shifted,
    }
}
