//! What triangles need to be drawn in a tile, worked out for some of them at once, as many as a cell has lanes: most have some pixels each, and would take less time to be
//! drawn than to be looked at one by one.

use super::surface::{Interpolated, Tile, Triangle};
use super::tile::{LANES, Lanes, Slope, greater, lesser, select};
use crate::drawing::Surface;

/// A number of each triangle, in double precision.
type Doubles = [f64; LANES];

/// Some triangles of a tile, up to a cell's lanes. What is behind the last one is anything.
pub(super) struct SetUp {
    /// Their numbers among all of a drawing.
    numbers: [u32; LANES],
    count: usize,
    /// Of each corner: its place, in pixels.
    x: [Lanes; 3],
    y: [Lanes; 3],
    inv_depth: [Lanes; 3],
    tone: [Lanes; 3],
    /// Across and down the picture; of triangles without one anything.
    places: [[Lanes; 3]; 2],
    pub(super) twice_area: Doubles,
    /// Above 0 inside of each edge.
    inside: [Slopes; 3],
    /// For each edge no less than what is inside of it at any sample of the tile's first cell.
    most_inside: [Lanes; 3],
    depth: Slopes,
    tones: Slopes,
    /// Places times inverse depth, which run linearly on the screen.
    textured: [Slopes; 2],
}

/// A [`Slope`] of each triangle.
struct Slopes {
    corner: Lanes,
    per_x: Lanes,
    per_y: Lanes,
}

/// An [`Edge`](super::surface::Edge) of each triangle.
struct Edges {
    corner: Doubles,
    per_x: Doubles,
    per_y: Doubles,
}

impl Slopes {
    const LEVEL: Self = Self {
        corner: [0.0; LANES],
        per_x: [0.0; LANES],
        per_y: [0.0; LANES],
    };

    #[inline(always)]
    fn of(&self, k: usize) -> Slope {
        Slope {
            corner: self.corner[k],
            per_x: self.per_x[k],
            per_y: self.per_y[k],
        }
    }

    /// As [`Interpolated::new`] has them.
    #[inline(always)]
    fn interpolate(&mut self, values: &[Lanes; 3], edges: &[Edges; 3], area: &Doubles) {
        let [e, f, g] = edges;
        for (mean, [e, f, g]) in [
            (&mut self.corner, [&e.corner, &f.corner, &g.corner]),
            (&mut self.per_x, [&e.per_x, &f.per_x, &g.per_x]),
            (&mut self.per_y, [&e.per_y, &f.per_y, &g.per_y]),
        ] {
            for k in 0..LANES {
                let [v, w, x] = [
                    f64::from(values[0][k]),
                    f64::from(values[1][k]),
                    f64::from(values[2][k]),
                ];
                mean[k] = ((e[k] * v + f[k] * w + g[k] * x) / area[k]) as f32;
            }
        }
    }
}

impl Edges {
    /// As [`Edge::new`](super::surface::Edge::new) has them.
    #[inline(always)]
    fn new(from: [&Doubles; 2], to: [&Doubles; 2]) -> Self {
        let mut edges = Self {
            corner: [0.0; LANES],
            per_x: [0.0; LANES],
            per_y: [0.0; LANES],
        };
        for k in 0..LANES {
            let ([x0, y0], [x1, y1]) = ([from[0][k], from[1][k]], [to[0][k], to[1][k]]);
            let is_turned = (x1 < x0) | ((x1 == x0) & (y1 < y0));
            let (low_x, high_x) = (select(is_turned, x1, x0), select(is_turned, x0, x1));
            let (low_y, high_y) = (select(is_turned, y1, y0), select(is_turned, y0, y1));
            let (along_x, along_y) = (high_x - low_x, high_y - low_y);
            let sign = select(is_turned, -1.0, 1.0);
            edges.corner[k] = sign * -(along_x * low_y - along_y * low_x);
            edges.per_x[k] = sign * -along_y;
            edges.per_y[k] = sign * along_x;
        }
        edges
    }
}

impl SetUp {
    pub(super) const NOTHING: Self = Self {
        numbers: [0; LANES],
        count: 0,
        x: [[0.0; LANES]; 3],
        y: [[0.0; LANES]; 3],
        inv_depth: [[0.0; LANES]; 3],
        tone: [[0.0; LANES]; 3],
        places: [[[0.0; LANES]; 3]; 2],
        twice_area: [0.0; LANES],
        inside: [Slopes::LEVEL; 3],
        most_inside: [[0.0; LANES]; 3],
        depth: Slopes::LEVEL,
        tones: Slopes::LEVEL,
        textured: [Slopes::LEVEL; 2],
    };

    /// The triangles' numbers.
    #[inline(always)]
    pub(super) fn numbers(&self) -> &[u32] {
        &self.numbers[..self.count]
    }

    #[inline(always)]
    pub(super) fn is_full(&self) -> bool {
        self.count == LANES
    }

    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds a triangle of a surface; there is room. With the picture on it, where there is one.
    #[inline(always)]
    pub(super) fn push(&mut self, number: u32, triangle: &Triangle, surface: &Surface) {
        let k = self.count % LANES; // one that compilers know to be there
        self.count += 1;
        self.numbers[k] = number;
        let corners = &surface.triangles[triangle.number as usize];
        for (corner, index) in corners.iter().enumerate() {
            let vertex = &surface.vertices[*index as usize];
            self.x[corner][k] = vertex.position.x;
            self.y[corner][k] = vertex.position.y;
            self.inv_depth[corner][k] = vertex.inv_depth;
            self.tone[corner][k] = vertex.tone;
        }
        if let Some(texture) = &surface.texture {
            for (corner, index) in corners.iter().enumerate() {
                let place = texture.places[*index as usize];
                self.places[0][corner][k] = place.x;
                self.places[1][corner][k] = place.y;
            }
        }
    }

    /// Works out what the triangles need in a tile, with a picture on them or without; and their tones, where light and shadow aren't the same.
    #[inline(always)]
    pub(super) fn work_out(&mut self, is_textured: bool, has_tones: bool, tile: &Tile) {
        let (x, y) = (from(&self.x, tile.origin[0]), from(&self.y, tile.origin[1]));
        let ([ax, bx, cx], [ay, by, cy]) = (&x, &y);
        let mut side = [0.0; LANES];
        for k in 0..LANES {
            let area = (bx[k] - ax[k]) * (cy[k] - ay[k]) - (by[k] - ay[k]) * (cx[k] - ax[k]);
            self.twice_area[k] = area;
            side[k] = select(area < 0.0, -1.0, 1.0);
        }
        let edges = [
            Edges::new([bx, by], [cx, cy]),
            Edges::new([cx, cy], [ax, ay]),
            Edges::new([ax, ay], [bx, by]),
        ];
        for (inside, edges) in self.inside.iter_mut().zip(&edges) {
            for k in 0..LANES {
                inside.corner[k] = (edges.corner[k] * side[k]) as f32;
                inside.per_x[k] = (edges.per_x[k] * side[k]) as f32;
                inside.per_y[k] = (edges.per_y[k] * side[k]) as f32;
            }
        }
        // Rounding keeps the order of numbers: what grows with the place is greatest at the greatest one.
        let [[left, right], [top, bottom]] = tile.stack.ends;
        for (most, inside) in self.most_inside.iter_mut().zip(&self.inside) {
            for k in 0..LANES {
                let (per_x, per_y) = (inside.per_x[k], inside.per_y[k]);
                let x = select(per_x > 0.0, right, left);
                let y = select(per_y > 0.0, bottom, top);
                most[k] = inside.corner[k] + (x * per_x + y * per_y);
            }
        }
        let area = &self.twice_area;
        self.depth.interpolate(&self.inv_depth, &edges, area);
        if has_tones {
            self.tones.interpolate(&self.tone, &edges, area);
        }
        if is_textured {
            for (slopes, places) in self.textured.iter_mut().zip(&self.places) {
                let mut values = *places;
                for corner in 0..3 {
                    for k in 0..LANES {
                        values[corner][k] *= self.inv_depth[corner][k];
                    }
                }
                slopes.interpolate(&values, &edges, area);
            }
        }
    }

    /// What is inside of a triangle's edges, where all three are 0 or more.
    #[inline(always)]
    pub(super) fn inside(&self, k: usize) -> [Slope; 3] {
        [
            self.inside[0].of(k),
            self.inside[1].of(k),
            self.inside[2].of(k),
        ]
    }

    /// For each edge no less than that is at any sample of the tile's first cell.
    #[inline(always)]
    pub(super) fn most_inside(&self, k: usize) -> [f32; 3] {
        let [a, b, c] = &self.most_inside;
        [a[k], b[k], c[k]]
    }

    #[inline(always)]
    pub(super) fn depths(&self, k: usize) -> Interpolated {
        of_corners(self.depth.of(k), &self.inv_depth, k)
    }

    #[inline(always)]
    pub(super) fn tones(&self, k: usize) -> Interpolated {
        of_corners(self.tones.of(k), &self.tone, k)
    }

    /// Places in the picture times inverse depth, and the least and the greatest places.
    #[inline(always)]
    pub(super) fn places(&self, k: usize) -> [(Slope, [f32; 2]); 2] {
        let [across, down] = [&self.places[0], &self.places[1]];
        [
            (self.textured[0].of(k), ends(across, k)),
            (self.textured[1].of(k), ends(down, k)),
        ]
    }

    /// Twice the area of the picture that is on a triangle, in its width and height.
    #[inline(always)]
    pub(super) fn twice_area_of_picture(&self, k: usize) -> f32 {
        let [x, y] = &self.places;
        (x[1][k] - x[0][k]) * (y[2][k] - y[0][k]) - (y[1][k] - y[0][k]) * (x[2][k] - x[0][k])
    }
}

/// Places as they are seen from where a tile begins.
#[inline(always)]
fn from(places: &[Lanes; 3], origin: usize) -> [Doubles; 3] {
    let origin = origin as f64;
    let mut seen = [[0.0; LANES]; 3];
    for (seen, places) in seen.iter_mut().zip(places) {
        for k in 0..LANES {
            seen[k] = f64::from(places[k]) - origin;
        }
    }
    seen
}

#[inline(always)]
fn of_corners(slope: Slope, values: &[Lanes; 3], k: usize) -> Interpolated {
    let [least, greatest] = ends(values, k);
    Interpolated {
        slope,
        least,
        greatest,
    }
}

/// The least and the greatest of the corners' values.
#[inline(always)]
fn ends([a, b, c]: &[Lanes; 3], k: usize) -> [f32; 2] {
    [
        lesser(lesser(a[k], b[k]), c[k]),
        greater(greater(a[k], b[k]), c[k]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::bin::Bounds;
    use crate::cpu::surface::Edge;
    use crate::cpu::tile::Stack;
    use crate::drawing::SurfaceVertex;
    use crate::samples::sample_positions;
    use glam::{DVec2, Vec2};
    use proptest::prelude::*;

    const ORIGIN: [usize; 2] = [64, 16];

    proptest! {
        /// What keeps a mesh without cracks: no sample is outside of both triangles at an edge.
        #[test]
        fn an_edge_seen_from_its_other_triangle_is_its_exact_opposite(
            ends in prop::array::uniform16((-1e9..1e9_f64, -1e9..1e9_f64, -50.0..50.0_f64, -50.0..50.0_f64)),
        ) {
            let numbers = |of: fn((f64, f64, f64, f64)) -> f64| ends.map(of);
            let (x0, y0) = (numbers(|it| it.0), numbers(|it| it.1));
            let (x1, y1) = (numbers(|it| it.2), numbers(|it| it.3));
            let one = Edges::new([&x0, &y0], [&x1, &y1]);
            let other = Edges::new([&x1, &y1], [&x0, &y0]);
            for k in 0..LANES {
                prop_assert_eq!(one.corner[k], -other.corner[k]);
                prop_assert_eq!(one.per_x[k], -other.per_x[k]);
                prop_assert_eq!(one.per_y[k], -other.per_y[k]);
            }
        }

        /// In lanes triangles are what each is by itself.
        #[test]
        fn lanes_are_as_single_triangles(
            corners in prop::array::uniform16(prop::array::uniform3(
                (-10.0..300.0_f32, -10.0..300.0_f32, 0.1..9.0_f32, -1.0..1.0_f32)
            )),
        ) {
            let mut surface = Surface::default();
            for (i, corners) in corners.iter().enumerate() {
                surface.triangles.push([0, 1, 2].map(|k| 3 * i as u32 + k));
                surface.vertices.extend(corners.map(|(x, y, inv_depth, tone)| SurfaceVertex {
                    position: Vec2::new(x, y),
                    inv_depth,
                    tone,
                }));
            }
            let mut set_up = SetUp::NOTHING;
            for number in 0..LANES as u32 {
                let triangle = Triangle { surface: 0, number, bounds: Bounds::default(), nearest: 0.0 };
                set_up.push(number, &triangle, &surface);
            }
            prop_assert!(set_up.is_full());
            let stack = &Stack::of_pixel(&sample_positions(4).unwrap())[0];
            set_up.work_out(false, true, &Tile { origin: ORIGIN, stack });
            for (k, corners) in corners.iter().enumerate() {
                let origin = DVec2::new(ORIGIN[0] as f64, ORIGIN[1] as f64);
                let [a, b, c] = corners.map(|(x, y, ..)| Vec2::new(x, y).as_dvec2() - origin);
                let area = (b - a).perp_dot(c - a);
                prop_assert_eq!(set_up.twice_area[k], area);
                let edges = [Edge::new(b, c), Edge::new(c, a), Edge::new(a, b)];
                for (edge, slope) in edges.iter().zip(set_up.inside(k)) {
                    let expected = [edge.corner, edge.per_x, edge.per_y].map(|x| (x * area.signum()) as f32);
                    prop_assert_eq!([slope.corner, slope.per_x, slope.per_y], expected);
                }
                for (slope, most) in set_up.inside(k).into_iter().zip(set_up.most_inside(k)) {
                    let first = slope.at_samples(stack).and(0.0);
                    prop_assert!(first.into_iter().all(|inside| inside <= most));
                }
                for (lanes, values) in [
                    (set_up.depths(k), corners.map(|it| it.2)),
                    (set_up.tones(k), corners.map(|it| it.3)),
                ] {
                    let [expected] = Interpolated::new(&[values], &edges, area);
                    prop_assert_eq!(lanes.slope, expected.slope);
                    prop_assert_eq!([lanes.least, lanes.greatest], [expected.least, expected.greatest]);
                }
            }
        }
    }
}
