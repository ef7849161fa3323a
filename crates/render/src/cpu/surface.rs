//! One triangle in one tile: both sides, edges included, the nearest first.

use super::bin::{Bounds, clip};
use super::tile::{
    CELL_WIDTH, CELLS_ACROSS, Cell, LANES, LaneMask, Slope, Stack, Target, WIDTH, any, greater,
    least, lesser, overwrite, select,
};
use crate::drawing::{Drawing, SurfaceVertex};
use glam::DVec2;
use rayon::prelude::*;
use std::ops::Range;

/// A triangle of a drawing that may be seen.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    pub(super) corners: [SurfaceVertex; 3],
    pub(super) surface: u32,
    pub(super) bounds: Bounds,
}

/// Replaces `triangles` by those of a checked drawing, in its order, that may be seen.
pub(super) fn collect(drawing: &Drawing, triangles: &mut Vec<Triangle>) {
    triangles.clear();
    for (surface, number) in drawing.surfaces.iter().zip(0..) {
        triangles.par_extend(surface.triangles.par_iter().with_min_len(1024).filter_map(
            |indices| {
                let corners = indices.map(|i| surface.vertices[i as usize]);
                let [a, b, c] = corners.map(|corner| corner.position);
                let bounds = Bounds::of_box(a.min(b).min(c), a.max(b).max(c), drawing.size)?;
                // Without area it would have no inside.
                (twice_area([a, b, c].map(|corner| corner.as_dvec2())) != 0.0).then_some(Triangle {
                    corners,
                    surface: number,
                    bounds,
                })
            },
        ));
    }
}

#[inline(always)]
fn twice_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

impl Triangle {
    /// Draws the triangle's part of the tile at `origin` into the target's samples. Gives the cells' samples where it shows.
    #[inline(always)]
    pub(super) fn draw(
        &self,
        drawing: &Drawing,
        origin: [usize; 2],
        stack: &Stack,
        target: &mut Target,
        mut shows: impl FnMut(usize, &LaneMask),
    ) {
        let rows = self.bounds.rows_in(origin[1], stack);
        let columns = clip(self.bounds.x, origin[0], WIDTH);
        let across = columns.start / CELL_WIDTH..columns.end.div_ceil(CELL_WIDTH);
        if self.is_hidden(&rows, &across, target) {
            return;
        }
        let surface = &drawing.surfaces[self.surface as usize];
        let corner = DVec2::new(origin[0] as f64, origin[1] as f64);
        // Without closures, which are not sure to be compiled for their caller's instruction set.
        let [a, b, c] = &self.corners;
        let seen = |vertex: &SurfaceVertex| vertex.position.as_dvec2() - corner;
        let points = [seen(a), seen(b), seen(c)];
        let area = twice_area(points);
        let edges = [
            Edge::new(points[1], points[2]),
            Edge::new(points[2], points[0]),
            Edge::new(points[0], points[1]),
        ];
        let side = area.signum();
        let inside = [
            edges[0].slope(side).at_samples(stack),
            edges[1].slope(side).at_samples(stack),
            edges[2].slope(side).at_samples(stack),
        ];
        let depths = Interpolated::new([a.inv_depth, b.inv_depth, c.inv_depth], &edges, area);
        let tones = Interpolated::new([a.tone, b.tone, c.tone], &edges, area);
        let depth_at = depths.slope.at_samples(stack);
        let tone_at = tones.slope.at_samples(stack);
        for row in rows {
            for cell in across.clone() {
                let cell = Cell::new(row, cell * CELL_WIDTH);
                if depths.greatest <= target.farthest_surface[cell.index] {
                    continue; // all of the cell shows what is nearer
                }
                let inside = [inside[0].of(cell), inside[1].of(cell), inside[2].of(cell)];
                let depth = depth_at.of(cell);
                let mut nearest = target.surface[cell.index];
                let mut wins = [0_u32; LANES];
                for k in 0..LANES {
                    let is_inside =
                        (inside[0][k] >= 0.0) & (inside[1][k] >= 0.0) & (inside[2][k] >= 0.0);
                    let depth = depths.clamp(depth[k]);
                    let is_first = is_inside & (depth > nearest[k]);
                    nearest[k] = select(is_first, depth, nearest[k]);
                    wins[k] = select(is_first, u32::MAX, 0);
                }
                if !any(&wins) {
                    continue;
                }
                shows(cell.index, &wins);
                target.surface[cell.index] = nearest;
                target.farthest_surface[cell.index] = least(&nearest);
                overwrite(
                    &mut target.margin[cell.index],
                    &[surface.margin_m; LANES],
                    &wins,
                );
                let tone = tone_at.of(cell);
                for (channel, plane) in target.color.iter_mut().enumerate() {
                    let (light, shadow) = (surface.light[channel], surface.shadow[channel]);
                    let mut color = [0.0; LANES];
                    for k in 0..LANES {
                        color[k] = select(tones.clamp(tone[k]) >= 0.0, light, shadow);
                    }
                    overwrite(&mut plane[cell.index], &color, &wins);
                }
            }
        }
    }

    /// Whether all that the triangle may reach in the tile shows a surface that is nearer, or as near and earlier.
    #[inline(always)]
    fn is_hidden(&self, rows: &Range<usize>, across: &Range<usize>, target: &Target) -> bool {
        let [a, b, c] = &self.corners;
        let greatest = greater(greater(a.inv_depth, b.inv_depth), c.inv_depth);
        for row in rows.clone() {
            let cells = row * CELLS_ACROSS + across.start..row * CELLS_ACROSS + across.end;
            for farthest in &target.farthest_surface[cells] {
                if greatest > *farthest {
                    return false;
                }
            }
        }
        true
    }
}

/// The signed, doubled area between an edge and a point: above 0 on the edge's one side. Worked out
/// from the same end for both triangles at an edge, so that their values are exactly opposite, and no
/// sample between them is lost.
#[derive(Clone, Copy)]
struct Edge {
    corner: f64,
    per_x: f64,
    per_y: f64,
}

impl Edge {
    /// Positions are seen from the tile's corner.
    #[inline(always)]
    fn new(from: DVec2, to: DVec2) -> Self {
        let is_turned = (to.x, to.y) < (from.x, from.y);
        let (low, high) = if is_turned { (to, from) } else { (from, to) };
        let along = high - low;
        let sign = if is_turned { -1.0 } else { 1.0 };
        Self {
            corner: sign * -along.perp_dot(low),
            per_x: sign * -along.y,
            per_y: sign * along.x,
        }
    }

    #[inline(always)]
    fn slope(&self, factor: f64) -> Slope {
        Slope {
            corner: (self.corner * factor) as f32,
            per_x: (self.per_x * factor) as f32,
            per_y: (self.per_y * factor) as f32,
        }
    }
}

/// A value of the corners that runs linearly on the screen, and never beyond them: a needle's slope
/// is too steep for single precision.
struct Interpolated {
    slope: Slope,
    least: f32,
    greatest: f32,
}

impl Interpolated {
    #[inline(always)]
    fn new(values: [f32; 3], edges: &[Edge; 3], area: f64) -> Self {
        let [e, f, g] = edges;
        let mean = |a: f64, b: f64, c: f64| {
            let [v, w, x] = values;
            ((a * f64::from(v) + b * f64::from(w) + c * f64::from(x)) / area) as f32
        };
        let [a, b, c] = values;
        Self {
            slope: Slope {
                corner: mean(e.corner, f.corner, g.corner),
                per_x: mean(e.per_x, f.per_x, g.per_x),
                per_y: mean(e.per_y, f.per_y, g.per_y),
            },
            least: lesser(lesser(a, b), c),
            greatest: greater(greater(a, b), c),
        }
    }

    #[inline(always)]
    fn clamp(&self, value: f32) -> f32 {
        lesser(greater(value, self.least), self.greatest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// What keeps a mesh without cracks: no sample is outside of both triangles at an edge.
        #[test]
        fn an_edge_seen_from_its_other_triangle_is_its_exact_opposite(
            (x0, y0, x1, y1) in (-1e9..1e9_f64, -1e9..1e9_f64, -50.0..50.0_f64, -50.0..50.0_f64),
            sign in prop::sample::select(vec![1.0, -1.0]),
        ) {
            let from = DVec2::new(x0, y0);
            let to = DVec2::new(x1, y1);
            let one = Edge::new(from, to).slope(sign);
            let other = Edge::new(to, from).slope(sign);
            prop_assert_eq!(one.corner, -other.corner);
            prop_assert_eq!(one.per_x, -other.per_x);
            prop_assert_eq!(one.per_y, -other.per_y);
        }
    }
}
