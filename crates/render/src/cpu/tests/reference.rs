//! The rules of [`crate::drawing`] written down sample by sample, without tiles, planes or clipping.

use super::super::segment::{Kind, strokes_in_order};
use crate::drawing::{Brush, Disc, Drawing, Order, Run};
use crate::picture::Picture;
use crate::samples::sample_positions;
use glam::DVec2;
use std::ops::Range;
use stroke_path::sweep::{Circle, Sweep};

/// What a stroke is at a sample that it covers.
#[derive(Clone, Copy)]
struct Touch {
    ratio: f32,
    color: [f32; 3],
    inv_depth: f32,
    biased: f32,
}

impl Touch {
    fn nearest(self, new: Self) -> Self {
        Self {
            inv_depth: self.inv_depth.max(new.inv_depth),
            biased: self.biased.max(new.biased),
            ..if new.ratio < self.ratio { new } else { self }
        }
    }
}

/// Draws the strands of a drawing; surfaces are left out.
pub(super) fn draw(drawing: &Drawing, samples: u32) -> Picture {
    let [width, height] = drawing.size;
    let offsets = sample_positions(samples).unwrap();
    let mut pixels = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0.0_f32; 4];
            for offset in &offsets {
                let position = DVec2::new(f64::from(x), f64::from(y)) + offset.as_dvec2();
                if let Some([red, green, blue]) = sample(drawing, position) {
                    for (sum, value) in sum.iter_mut().zip([red, green, blue, 1.0]) {
                        *sum += value;
                    }
                }
            }
            pixels.push(sum.map(|value| value / samples as f32));
        }
    }
    Picture {
        width,
        height,
        pixels,
    }
}

fn sample(drawing: &Drawing, position: DVec2) -> Option<[f32; 3]> {
    let strokes = strokes_in_order(drawing, Kind::Ordered);
    let joints = drawing.clump.len();
    // (inverse depth, place of the stroke, colour)
    let mut best: Option<(f32, usize, [f32; 3])> = None;
    let mut offer = |depth: f32, place: usize, color: [f32; 3]| {
        if best.is_none_or(|(d, p, _)| depth > d || (depth == d && place > p)) {
            best = Some((depth, place, color));
        }
    };
    let strands = drawing.runs.chunk_by(|a, b| a.strand == b.strand);
    for runs in strands {
        let no_colors = vec![[0.0; 3]; joints];
        let sides = drawing.sides.chunks(joints);
        let clump = [&drawing.clump[..]]
            .into_iter()
            .chain(sides)
            .filter_map(|discs| touch(runs, discs, &no_colors, drawing.brush, position))
            .reduce(Touch::nearest);
        let touches: Vec<(usize, i32, Touch)> = strokes
            .iter()
            .enumerate()
            .filter_map(|(place, stroke)| {
                let layer = &drawing.layers[stroke.layer];
                let range: Range<usize> = stroke.instance * joints..(stroke.instance + 1) * joints;
                let (discs, colors) = (&layer.discs[range.clone()], &layer.colors[range]);
                Some((
                    place,
                    stroke.rank,
                    touch(runs, discs, colors, drawing.brush, position)?,
                ))
            })
            .collect();
        match drawing.order {
            Order::Shifted => {
                for (place, _, touch) in touches {
                    offer(touch.inv_depth, place, touch.color);
                }
            }
            Order::Rounded | Order::StrandFirst => {
                let top = touches
                    .iter()
                    .rfind(|(_, rank, _)| clump.is_some() || *rank < 0);
                if let Some((_, _, touch)) = top {
                    let (depth, part) = match clump {
                        Some(clump) => (clump.inv_depth, clump.ratio.min(1.0)),
                        None => (touch.inv_depth, touch.ratio.min(1.0).powi(4)),
                    };
                    let deeper_m = match drawing.order {
                        Order::Rounded => drawing.edge_depth_m * part,
                        Order::StrandFirst | Order::Shifted => 0.0,
                    };
                    offer(depth / (1.0 + deeper_m * depth.max(0.0)), 0, touch.color);
                }
            }
        }
    }
    best.map(|(_, _, color)| color)
}

fn touch(
    runs: &[Run],
    discs: &[Disc],
    colors: &[[f32; 3]],
    brush: Brush,
    position: DVec2,
) -> Option<Touch> {
    let mut best: Option<Touch> = None;
    for run in runs {
        let last = run.joints.end - 1;
        let pairs = run.joints.start..last.max(run.joints.start + 1);
        for (a, b) in pairs.map(|i| (i, (i + 1).min(last))) {
            let Some(new) = touch_segment(discs, colors, (a, b), brush, position) else {
                continue;
            };
            best = Some(best.map_or(new, |old| old.nearest(new)));
        }
    }
    best
}

fn touch_segment(
    discs: &[Disc],
    colors: &[[f32; 3]],
    (a, b): (usize, usize),
    brush: Brush,
    position: DVec2,
) -> Option<Touch> {
    let shrinks = discs[a].radius >= discs[b].radius;
    let (a, b) = if shrinks { (a, b) } else { (b, a) };
    let circle = |i: usize| Circle {
        center: discs[i].center.as_dvec2(),
        radius: f64::from(discs[i].radius),
    };
    let mut sweep = Sweep::new(circle(a), circle(b))?;
    if brush == Brush::Semicircle {
        sweep = sweep.with_semicircles(shrinks);
    }
    let local = sweep.local(position).as_vec2();
    if !sweep.covers(local.x, local.y) {
        return None;
    }
    let (low, high) = sweep.interval(local.x, local.y);
    let (u, ratio) = sweep.attribute_point(local.x, local.y);
    let mix = |a: f32, b: f32, u: f32| a + u * (b - a);
    let nearest = |a: f32, b: f32| mix(a, b, low).max(mix(a, b, high));
    Some(Touch {
        ratio,
        color: [0, 1, 2].map(|i| mix(colors[a][i], colors[b][i], u)),
        inv_depth: nearest(discs[a].inv_depth, discs[b].inv_depth),
        biased: nearest(discs[a].inv_depth_biased, discs[b].inv_depth_biased),
    })
}
