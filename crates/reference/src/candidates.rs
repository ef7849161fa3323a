//! Which stroke or surface a sample shows.

use crate::segment::{Depth, Segment};
use crate::triangle::{Hit, Triangle};
use glam::DVec2;
use render::{Brush, Decal, Disc, Drawing, Order, Stretch};
use std::cmp::Reverse;

/// What may cover the samples of one part of the screen.
#[derive(Debug)]
pub struct Candidates {
    /// By rising id.
    strands: Vec<Strand>,
    /// Those that hide others first.
    decals: Vec<DecalStroke>,
    triangles: Vec<Triangle>,
    background: Option<[f64; 3]>,
    order: Order,
    /// [`Drawing::edge_depth_m`].
    edge_depth_m: f64,
}

/// What a point shows.
pub enum Shown<'a> {
    Nothing,
    Mesh(Hit, &'a Triangle),
    Hair(Hair<'a>),
}

/// A stroke that a point shows.
pub struct Hair<'a> {
    /// Where it is ordered.
    pub depth: Depth,
    stroke: &'a Stroke,
    /// Its strand, whatever piece of it.
    strand: u32,
    /// The segments of its strand's clump; where there are no clumps its own.
    clump: &'a [Segment],
}

impl Hair<'_> {
    /// The index of its layer.
    pub fn layer(&self) -> usize {
        self.stroke.precedence.layer
    }

    /// The axis point that lends it its colour: joints, the way between them, the place across.
    pub fn place(&self, point: DVec2) -> ([usize; 2], f64, f64) {
        let (across, t, segment) =
            nearest(&self.stroke.segments, point).unwrap_or((0.0, 0.0, &self.stroke.segments[0]));
        (segment.joints, t, across)
    }

    /// The place across its clump: -1 or 1 outside of it, by `side`.
    pub fn across_clump(&self, point: DVec2, side: f64) -> f64 {
        nearest(self.clump, point).map_or(1.0_f64.copysign(side), |(across, ..)| across)
    }
}

/// The nearest axis point of the segments that cover `point`: distance over radius, at most 1 and below 0 to the left, the way along its
/// segment, and that.
fn nearest(segments: &[Segment], point: DVec2) -> Option<(f64, f64, &Segment)> {
    let covering = segments.iter().filter(|s| s.depth(point).is_some());
    let nearest = covering.map(|segment| {
        let (ratio, t) = segment.nearest_axis_point(point);
        (ratio, t, segment)
    });
    let first = nearest.reduce(|best, next| if next.0 < best.0 { next } else { best });
    first.map(|(ratio, t, segment)| (ratio.min(1.0) * segment.side(point), t, segment))
}

/// A strand's stroke that is drawn on what is seen without it.
#[derive(Clone, Debug)]
struct DecalStroke {
    decal: Decal,
    precedence: Precedence,
    /// Its strand, whatever piece of it.
    strand: u32,
    segments: Vec<Segment>,
}

#[derive(Debug)]
struct Strand {
    /// Its number, that of all its pieces.
    number: u32,
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
            strands: strands
                .clone()
                .map(|runs| Strand::new(drawing, runs))
                .collect(),
            decals: DecalStroke::all(drawing, strands),
            triangles: drawing.surfaces.iter().flat_map(Triangle::of).collect(),
            background: drawing.background.map(|color| color.map(f64::from)),
            order: drawing.order,
            edge_depth_m: drawing.edge_depth_m.into(),
        }
    }

    /// What of it may touch the box from `min` to `max`.
    pub fn within(&self, min: DVec2, max: DVec2) -> Self {
        let strands = self.strands.iter().map(|strand| strand.within(min, max));
        let triangles = self.triangles.iter();
        let decals = self.decals.iter().map(|decal| DecalStroke {
            segments: touching(&decal.segments, min, max),
            ..decal.clone()
        });
        Self {
            decals: decals.filter(|d| !d.segments.is_empty()).collect(),
            strands: strands.filter(|s| !s.strokes.is_empty()).collect(),
            triangles: triangles.filter(|t| t.touches(min, max)).cloned().collect(),
            ..*self
        }
    }

    /// The colour at `point`, or nothing where the picture is transparent. `shown_reach` is the part of their reach in which its sample shows decals.
    pub fn color(&self, point: DVec2, shown_reach: f32) -> Option<[f64; 3]> {
        let shown = self.shown(point);
        let mut decals = self.decals.iter();
        if let Some(color) = decals.find_map(|decal| decal.on(&shown, point, shown_reach)) {
            return Some(color);
        }
        match shown {
            Shown::Hair(hair) => hair.stroke.color(point).or(self.background),
            Shown::Mesh(hit, _) => Some(hit.color),
            Shown::Nothing => self.background,
        }
    }

    /// What `point` shows.
    pub fn shown(&self, point: DVec2) -> Shown<'_> {
        let surface = self.nearest_surface(point);
        let hit = surface.as_ref().map(|(hit, _)| hit);
        let hair = match self.order {
            Order::Rounded | Order::StrandFirst => self.nearest_strand(point, hit),
            Order::Shifted => self.nearest_stroke(point, hit),
        };
        match (hair, surface) {
            (Some(hair), _) => Shown::Hair(hair),
            (None, Some((hit, triangle))) => Shown::Mesh(hit, triangle),
            (None, None) => Shown::Nothing,
        }
    }

    /// The nearest triangle, the first among equals.
    fn nearest_surface(&self, point: DVec2) -> Option<(Hit, &Triangle)> {
        let hits = self.triangles.iter();
        let hits = hits.filter_map(|triangle| Some((triangle.hit(point)?, triangle)));
        hits.reduce(|best, next| {
            if next.0.inv_depth > best.0.inv_depth {
                next
            } else {
                best
            }
        })
    }

    /// All orders but [`Order::Shifted`]: each strand settles what it shows, then the nearest
    /// strand is seen, the lower id among equals. Strands that `surface` hides are not.
    fn nearest_strand(&self, point: DVec2, surface: Option<&Hit>) -> Option<Hair<'_>> {
        let shown = self.strands.iter().filter_map(|strand| {
            let (depth, part, stroke) = strand.shown(point)?;
            let part = match self.order {
                Order::Rounded => part,
                Order::StrandFirst | Order::Shifted => 0.0,
            };
            Some(Hair {
                depth: depth.deeper(self.edge_depth_m * part),
                stroke,
                strand: strand.number,
                clump: &strand.clump,
            })
        });
        shown
            .filter(|hair| is_seen(&hair.depth, surface))
            .reduce(|best, next| {
                if next.depth.inv_depth > best.depth.inv_depth {
                    next
                } else {
                    best
                }
            })
    }

    /// [`Order::Shifted`]: the nearest stroke; among equals the one with precedence, then of the
    /// lower id. Strokes that `surface` hides are not seen.
    fn nearest_stroke(&self, point: DVec2, surface: Option<&Hit>) -> Option<Hair<'_>> {
        let strokes = (self.strands.iter())
            .flat_map(|strand| strand.strokes.iter().map(|stroke| (strand.number, stroke)));
        strokes
            .filter_map(|(strand, stroke)| {
                Some(Hair {
                    depth: depth(&stroke.segments, point)?,
                    stroke,
                    strand,
                    clump: &stroke.segments,
                })
            })
            .filter(|hair| is_seen(&hair.depth, surface))
            .reduce(|best, next| {
                let key = |hair: &Hair| (hair.depth.inv_depth, hair.stroke.precedence);
                if key(&next) > key(&best) { next } else { best }
            })
    }
}

impl Strand {
    /// The strand that has `runs`.
    fn new(drawing: &Drawing, runs: &[render::Run]) -> Self {
        let mut strokes: Vec<Stroke> = Vec::new();
        for (layer, strokes_of_layer) in drawing.layers.iter().enumerate() {
            if drawing.decal(layer).is_some() {
                continue;
            }
            for instance in 0..strokes_of_layer.instances {
                let on = |run: &render::Run| strokes_of_layer.on(instance, &run.joints);
                let drawn: Vec<Stretch> = runs.iter().flat_map(on).collect();
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
        let middle = |run: &render::Run| Stretch {
            joints: run.joints.clone(),
            first: run.joints.start,
        };
        let middles: Vec<Stretch> = runs.iter().map(middle).collect();
        let mut clump = segments(&middles, &drawing.clump, &no_colors, drawing.brush);
        for side in 0..2 {
            let on = |run: &render::Run| drawing.side_on(side, &run.joints);
            let drawn: Vec<Stretch> = runs.iter().flat_map(on).collect();
            clump.extend(segments(&drawn, &drawing.sides, &no_colors, drawing.brush));
        }
        Self {
            number: drawing.whole_strand(runs[0].strand),
            clump,
            strokes,
        }
    }

    /// What of it may touch the box from `min` to `max`.
    fn within(&self, min: DVec2, max: DVec2) -> Self {
        let strokes = self.strokes.iter().map(|stroke| Stroke {
            precedence: stroke.precedence,
            segments: touching(&stroke.segments, min, max),
        });
        Self {
            number: self.number,
            clump: touching(&self.clump, min, max),
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
        nearest(&self.segments, point).map(|(_, t, segment)| segment.color(t))
    }
}

/// Those of some segments that may touch the box from `min` to `max`.
fn touching(segments: &[Segment], min: DVec2, max: DVec2) -> Vec<Segment> {
    let segments = segments.iter().copied();
    segments.filter(|s| s.touches(min, max)).collect()
}

impl DecalStroke {
    /// Those of a drawing whose strands have these runs: the highest first, and of one stroke the lowest strand's.
    fn all<'a>(drawing: &Drawing, strands: impl Iterator<Item = &'a [render::Run]>) -> Vec<Self> {
        let mut all = Vec::new();
        for runs in strands {
            for decal in &drawing.decals {
                let strokes = &drawing.layers[decal.layer];
                for instance in 0..strokes.instances {
                    let on = |run: &render::Run| strokes.on(instance, &run.joints);
                    let drawn: Vec<Stretch> = runs.iter().flat_map(on).collect();
                    all.push(Self {
                        decal: decal.clone(),
                        precedence: Precedence {
                            rank: strokes.rank,
                            layer: decal.layer,
                            instance,
                        },
                        strand: drawing.whole_strand(runs[0].strand),
                        segments: segments(&drawn, &strokes.discs, &strokes.colors, drawing.brush),
                    });
                }
            }
        }
        // Strands are in their order, and stay so.
        all.sort_by_key(|stroke| Reverse(stroke.precedence));
        all
    }

    /// The colour that it gives a point, if it fits what that shows.
    fn on(&self, shown: &Shown, point: DVec2, shown_reach: f32) -> Option<[f64; 3]> {
        let (depth, shadow) = match shown {
            Shown::Nothing => return None,
            Shown::Hair(hair) => {
                let is_outline = hair.stroke.precedence.rank < 0;
                let is_no_shadow = hair.strand == self.strand || is_outline;
                if !self.decal.on_hair || self.decal.is_shadow && is_no_shadow {
                    return None;
                }
                (hair.depth.inv_depth, None)
            }
            Shown::Mesh(hit, triangle) => {
                if triangle.marks & self.decal.marks == 0 {
                    return None;
                }
                (hit.inv_depth, Some(hit.shadow))
            }
        };
        let reach_m = f64::from(self.decal.reach_m);
        let fits = |inv_depth: f64| {
            let behind_m = 1.0 / depth - 1.0 / inv_depth;
            inv_depth > 0.0
                && match (self.decal.is_shadow, shadow.is_some()) {
                    (false, _) => behind_m.abs() <= f64::from(shown_reach) * reach_m,
                    (true, true) => behind_m >= -reach_m,
                    (true, false) => behind_m > reach_m,
                }
        };
        let covering = self.segments.iter().filter(|s| s.depth(point).is_some());
        let beside = covering.map(|segment| {
            let (ratio, t) = segment.nearest_axis_point(point);
            (ratio, segment.inv_depth(t), segment.color(t))
        });
        let fitting = beside.filter(|(_, inv_depth, _)| fits(*inv_depth));
        let (_, _, color) =
            fitting.reduce(|best, next| if next.0 < best.0 { next } else { best })?;
        let is_shade = self.decal.is_shadow;
        Some(shadow.filter(|_| is_shade).unwrap_or(color))
    }
}

/// The segments of all `runs`, stretches of the discs, in order along the strand.
fn segments(runs: &[Stretch], discs: &[Disc], colors: &[[f32; 3]], brush: Brush) -> Vec<Segment> {
    let mut segments = Vec::new();
    for run in runs {
        let last = run.joints.len().saturating_sub(1);
        // One joint alone is a segment from itself to itself.
        for from in 0..last.max(1) {
            let ends = [from, (from + 1).min(last)];
            let [a, b] = ends.map(|end| run.first + end);
            let joints = ends.map(|end| run.joints.start + end);
            segments.push(Segment::new(
                [&discs[a], &discs[b]],
                [colors[a], colors[b]],
                joints,
                brush,
            ));
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
