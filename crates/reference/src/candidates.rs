//! Which stroke or surface a sample shows.

use crate::segment::{Depth, Segment};
use crate::triangle::{Hit, Triangle};
use glam::DVec2;
use render::{Brush, Disc, Drawing, Order};
use std::cmp::Reverse;
use std::ops::Range;

/// What may cover the samples of one part of the screen.
#[derive(Debug)]
pub struct Candidates {
    /// By rising id.
    strands: Vec<Strand>,
    triangles: Vec<Triangle>,
    background: Option<[f64; 3]>,
    order: Order,
    /// [`Drawing::edge_depth_m`].
    edge_depth_m: f64,
}

#[derive(Debug)]
struct Strand {
    clump: Vec<Segment>,
    /// The one that hides the others first.
    strokes: Vec<Stroke>,
}

#[derive(Debug)]
struct Stroke {
    precedence: Precedence,
    /// Of all the strand's runs.
    segments: Vec<Segment>,
}

/// Which stroke of a strand hides which: the larger. Fields in order of weight.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Eq, Ord)]
struct Precedence {
    rank: i32,
    layer: usize,
    instance: usize,
}

impl Candidates {
    /// The whole drawing.
    pub fn new(drawing: &Drawing) -> Self {
        let strands = drawing.runs.chunk_by(|a, b| a.strand == b.strand);
        Self {
            strands: strands.map(|runs| Strand::new(drawing, runs)).collect(),
            triangles: drawing.surfaces.iter().flat_map(Triangle::of).collect(),
            background: drawing.background.map(|color| color.map(f64::from)),
            order: drawing.order,
            edge_depth_m: drawing.edge_depth_m.into(),
        }
    }

    /// What of it may touch the box from `min` to `max`.
    pub fn within(&self, min: DVec2, max: DVec2) -> Self {
        let strands = self.strands.iter().map(|strand| strand.within(min, max));
        let triangles = self.triangles.iter().copied();
        Self {
            strands: strands.filter(|s| !s.strokes.is_empty()).collect(),
            triangles: triangles.filter(|t| t.touches(min, max)).collect(),
            ..*self
        }
    }

    /// The colour at `point`, or nothing where the picture is transparent.
    pub fn color(&self, point: DVec2) -> Option<[f64; 3]> {
        let surface = self.nearest_surface(point);
        let stroke = match self.order {
            Order::Rounded | Order::StrandFirst => self.nearest_strand(point, surface.as_ref()),
            Order::Shifted => self.nearest_stroke(point, surface.as_ref()),
        };
        stroke
            .and_then(|stroke| stroke.color(point))
            .or(surface.map(|hit| hit.color))
            .or(self.background)
    }

    /// The nearest triangle, the first among equals.
    fn nearest_surface(&self, point: DVec2) -> Option<Hit> {
        let hits = self.triangles.iter().filter_map(|t| t.hit(point));
        hits.reduce(|best, next| {
            if next.inv_depth > best.inv_depth {
                next
            } else {
                best
            }
        })
    }

    /// All orders but [`Order::Shifted`]: each strand settles what it shows, then the nearest
    /// strand is seen, the lower id among equals. Strands that `surface` hides are not.
    fn nearest_strand(&self, point: DVec2, surface: Option<&Hit>) -> Option<&Stroke> {
        let shown = self.strands.iter().filter_map(|strand| {
            let (depth, part, stroke) = strand.shown(point)?;
            let part = match self.order {
                Order::Rounded => part,
                Order::StrandFirst | Order::Shifted => 0.0,
            };
            Some((depth.deeper(self.edge_depth_m * part), stroke))
        });
        shown
            .filter(|(depth, _)| is_seen(depth, surface))
            .reduce(|best, next| {
                if next.0.inv_depth > best.0.inv_depth {
                    next
                } else {
                    best
                }
            })
            .map(|(_, stroke)| stroke)
    }

    /// [`Order::Shifted`]: the nearest stroke; among equals the one with precedence, then of the
    /// lower id. Strokes that `surface` hides are not seen.
    fn nearest_stroke(&self, point: DVec2, surface: Option<&Hit>) -> Option<&Stroke> {
        let strokes = self.strands.iter().flat_map(|strand| &strand.strokes);
        strokes
            .filter_map(|stroke| Some((depth(&stroke.segments, point)?, stroke)))
            .filter(|(depth, _)| is_seen(depth, surface))
            .reduce(|best, next| {
                let key = |(depth, stroke): &(Depth, &Stroke)| (depth.inv_depth, stroke.precedence);
                if key(&next) > key(&best) { next } else { best }
            })
            .map(|(_, stroke)| stroke)
    }
}

impl Strand {
    /// The strand that has `runs`.
    fn new(drawing: &Drawing, runs: &[render::Run]) -> Self {
        let mut strokes: Vec<Stroke> = Vec::new();
        for (layer, strokes_of_layer) in drawing.layers.iter().enumerate() {
            for instance in 0..strokes_of_layer.instances {
                let on = |run: &render::Run| strokes_of_layer.on(instance, &run.joints);
                let drawn: Vec<Range<usize>> =
                    runs.iter().flat_map(on).map(|s| s.places()).collect();
                strokes.push(Stroke {
                    precedence: Precedence {
                        rank: strokes_of_layer.rank,
                        layer,
                        instance,
                    },
                    segments: segments(
                        &drawn,
                        &strokes_of_layer.discs,
                        &strokes_of_layer.colors,
                        drawing.brush,
                    ),
                });
            }
        }
        strokes.sort_by_key(|stroke| Reverse(stroke.precedence));
        let no_colors = vec![[0.0; 3]; drawing.clump.len().max(drawing.sides.len())];
        let middles: Vec<Range<usize>> = runs.iter().map(|run| run.joints.clone()).collect();
        let mut clump = segments(&middles, &drawing.clump, &no_colors, drawing.brush);
        for side in 0..2 {
            let on = |run: &render::Run| drawing.side_on(side, &run.joints);
            let drawn: Vec<Range<usize>> = runs.iter().flat_map(on).map(|s| s.places()).collect();
            clump.extend(segments(&drawn, &drawing.sides, &no_colors, drawing.brush));
        }
        Self { clump, strokes }
    }

    /// What of it may touch the box from `min` to `max`.
    fn within(&self, min: DVec2, max: DVec2) -> Self {
        let touching = |segments: &[Segment]| -> Vec<Segment> {
            let segments = segments.iter().copied();
            segments.filter(|s| s.touches(min, max)).collect()
        };
        let strokes = self.strokes.iter().map(|stroke| Stroke {
            precedence: stroke.precedence,
            segments: touching(&stroke.segments),
        });
        Self {
            clump: touching(&self.clump),
            strokes: strokes.filter(|s| !s.segments.is_empty()).collect(),
        }
    }

    /// The stroke that the strand shows at `point`, and how deep: in the clump the highest at the
    /// clump's depth, outside it the highest below the base stroke at its own. Between them the part of
    /// the edge's depth that a round stroke has there: r^2 in the clump, r^8 outside it.
    fn shown(&self, point: DVec2) -> Option<(Depth, f64, &Stroke)> {
        let clump = depth(&self.clump, point);
        self.strokes
            .iter()
            .filter(|stroke| clump.is_some() || stroke.precedence.rank < 0)
            .find_map(|stroke| {
                let own = depth(&stroke.segments, point)?;
                Some(match clump {
                    Some(depth) => (depth, ratio(&self.clump, point).powi(2), stroke),
                    None => (own, ratio(&stroke.segments, point).powi(8), stroke),
                })
            })
    }
}

impl Stroke {
    /// The colour of the axis point nearest to `point`: least distance over radius, of the segments that
    /// cover it (with whole discs the least of all does).
    fn color(&self, point: DVec2) -> Option<[f64; 3]> {
        let covering = self.segments.iter().filter(|s| s.depth(point).is_some());
        let nearest = covering.map(|segment| {
            let (ratio, t) = segment.nearest_axis_point(point);
            (ratio, t, segment)
        });
        nearest
            .reduce(|best, next| if next.0 < best.0 { next } else { best })
            .map(|(_, t, segment)| segment.color(t))
    }
}

/// The segments of all `runs`, ranges of the discs, in order along the strand.
fn segments(
    runs: &[Range<usize>],
    discs: &[Disc],
    colors: &[[f32; 3]],
    brush: Brush,
) -> Vec<Segment> {
    let segment = |from, to| {
        Segment::new(
            [&discs[from], &discs[to]],
            [colors[from], colors[to]],
            brush,
        )
    };
    let mut segments = Vec::new();
    for run in runs {
        match run.len() {
            0 => {}
            1 => segments.push(segment(run.start, run.start)),
            _ => segments.extend((run.start + 1..run.end).map(|to| segment(to - 1, to))),
        }
    }
    segments
}

/// The nearest depth of the discs that cover `point`, or nothing where none does.
fn depth(segments: &[Segment], point: DVec2) -> Option<Depth> {
    let depths = segments.iter().filter_map(|segment| segment.depth(point));
    depths.reduce(Depth::nearest)
}

/// The least distance over radius of a point that the segments cover.
fn ratio(segments: &[Segment], point: DVec2) -> f64 {
    let covering = segments.iter().filter(|s| s.depth(point).is_some());
    covering
        .map(|segment| segment.nearest_axis_point(point).0)
        .fold(1.0, f64::min)
}

/// Whether a stroke of that depth is not hidden by the surface there.
fn is_seen(depth: &Depth, surface: Option<&Hit>) -> bool {
    surface.is_none_or(|hit| {
        if hit.margin_m != 0.0 {
            1.0 / depth.inv_depth + hit.margin_m <= 1.0 / hit.inv_depth
        } else {
            depth.biased >= hit.inv_depth
        }
    })
}
