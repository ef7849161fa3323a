//! The signed distance of a closed mesh, on a grid.

use glam::{Affine3A, DMat3, DVec3, Vec3, Vec3A};

use crate::{
    hash::Hash,
    lanes::{LANES, Lane, Number, Vec3 as LaneVec3},
    pose::Pose,
};

mod build;

use build::{Inside, Points};

/// The largest number of grid points.
const MOST_POINTS: usize = 1 << 26;

/// Distances from a mesh at the points of a regular grid, negative inside.
///
/// Near the mesh they are exact; farther away the nearest triangle is passed on from point to point. A point is inside
/// where rays along two of the three axes cross the mesh an odd number of times, so that a small hole does not matter; or, of a mesh
/// [of pieces](Self::of_pieces), where four of the six rays along them leave more pieces than they enter.
#[derive(Clone, Debug, PartialEq)]
pub struct SignedDistance {
    origin: DVec3,
    cell: f64,
    size: [usize; 3],
    /// The number of cells along each axis.
    last: DVec3,
    values: Vec<f32>,
    /// A ball around the mesh.
    center: DVec3,
    radius: f64,
    /// A hash of the values.
    print: u64,
}

/// Why a mesh has no grid of distances.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// A mesh has triangles.
    #[error("the mesh has no triangles")]
    Empty,
    /// Triangles are of points that are there.
    #[error("triangle {triangle}: there is no point {point}")]
    Index {
        /// The triangle's index.
        triangle: usize,
        /// The point that it asks for.
        point: u32,
    },
    /// Positions are finite.
    #[error("point {0} is not finite")]
    NotFinite(usize),
    /// A cell has a size, and the grid has bounds.
    #[error("cells of {cell} m need a grid of {points} points; at most {MOST_POINTS} will do")]
    Size {
        /// In m.
        cell: f64,
        /// The number of points.
        points: f64,
    },
}

impl SignedDistance {
    /// The distances of a mesh in cells of `cell` metres. 1/60 of a head's height shows ears.
    ///
    /// # Errors
    ///
    /// When the mesh is empty or invalid, or the grid too large.
    pub fn new(points: &[Vec3], triangles: &[[u32; 3]], cell: f64) -> Result<Self, GridError> {
        Self::by(Inside::Odd, points, &[triangles], cell)
    }

    /// The same of a mesh of pieces, of which some may lie within others or cross them, as clothes and caps do, with holes and doubled walls: what is within
    /// any of them is inside. Triangles face outwards (counter-clockwise seen from outside).
    ///
    /// # Errors
    ///
    /// Those of [`Self::new`].
    pub fn of_pieces(
        points: &[Vec3],
        triangles: &[[u32; 3]],
        cell: f64,
    ) -> Result<Self, GridError> {
        Self::by(Inside::Wound, points, &[triangles], cell)
    }

    /// The same of several meshes that may overlap and lie in each other, as one body: the least of their distances, so that inside no wall of another is near. Where they
    /// overlap that is the depth in the one that it is deepest in, which is no more than that in all of them together.
    ///
    /// # Errors
    ///
    /// Those of [`Self::new`], with triangles numbered mesh after mesh.
    pub fn of_union(
        points: &[Vec3],
        meshes: &[Vec<[u32; 3]>],
        cell: f64,
    ) -> Result<Self, GridError> {
        Self::by(Inside::Odd, points, meshes, cell)
    }

    fn by(
        inside: Inside,
        points: &[Vec3],
        meshes: &[impl AsRef<[[u32; 3]]>],
        cell: f64,
    ) -> Result<Self, GridError> {
        let Extent {
            origin,
            size,
            center,
            radius,
        } = Extent::of(points, meshes, cell)?;
        let grid = Points { origin, cell, size };
        let corner = |i: u32| points[i as usize].as_dvec3();
        let mut values: Vec<f32> = Vec::new();
        for triangles in meshes.iter().map(AsRef::as_ref).filter(|m| !m.is_empty()) {
            let triangles: Vec<[DVec3; 3]> = triangles.iter().map(|t| t.map(corner)).collect();
            let own = grid.distances(&triangles, inside);
            if values.is_empty() {
                values = own;
            } else {
                let pairs = values.iter_mut().zip(own);
                pairs.for_each(|(value, own)| *value = value.min(own));
            }
        }
        Ok(Self {
            origin,
            cell,
            size,
            last: DVec3::from_array(size.map(|n| (n - 1) as f64)),
            print: Hash::of(&values),
            values,
            center,
            radius,
        })
    }

    /// Whether a mesh has distances in cells of `cell` metres, as [`Self::new`] says, which takes much longer.
    ///
    /// # Errors
    ///
    /// Those of [`Self::new`].
    pub fn check(points: &[Vec3], triangles: &[[u32; 3]], cell: f64) -> Result<(), GridError> {
        Extent::of(points, &[triangles], cell).map(drop)
    }

    /// Centre and radius of a ball around the mesh.
    pub(crate) fn ball(&self) -> (DVec3, f64) {
        (self.center, self.radius)
    }

    pub(crate) fn numbers(&self) -> [DVec3; 3] {
        let size = self.size.map(|n| n as f64);
        // As much of it as a number holds.
        let print = (self.print >> 12) as f64;
        [
            self.origin,
            DVec3::from_array(size),
            DVec3::new(self.cell, print, 1.0),
        ]
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// The cell that holds `at`, the place in it from 0 to 1, and the square of how far outside of the grid `at` is.
    #[inline]
    fn locate(&self, at: DVec3) -> ([usize; 3], DVec3, f64) {
        let in_cells = (at - self.origin) / self.cell;
        let clamped = in_cells.max(DVec3::ZERO).min(self.last);
        // In 32 bits, which a size fits in: they turn into numbers and back faster.
        let cell = |place: f64, size: usize| (place as i32).min(size as i32 - 2);
        let cells = [
            cell(clamped.x, self.size[0]),
            cell(clamped.y, self.size[1]),
            cell(clamped.z, self.size[2]),
        ];
        let [x, y, z] = cells.map(f64::from);
        let outside = if clamped == in_cells {
            0.0
        } else {
            (in_cells - clamped).length_squared() * (self.cell * self.cell)
        };
        let part = clamped - DVec3::new(x, y, z);
        (cells.map(|cell| cell as usize), part, outside)
    }

    #[inline(always)]
    fn corners(&self, [x, y, z]: [usize; 3]) -> [f32; 8] {
        let i = self.index(x, y, z);
        let (row, layer) = (self.size[0], self.size[0] * self.size[1]);
        let pair = |i: usize| {
            let pair = &self.values[i..i + 2];
            [pair[0], pair[1]]
        };
        let [a, b] = pair(i);
        let [c, d] = pair(i + row);
        let [e, f] = pair(i + layer);
        let [g, h] = pair(i + layer + row);
        [a, b, c, d, e, f, g, h]
    }

    /// The distance at a place, in m: between grid points by all three coordinates; a lower bound outside of the
    /// grid.
    #[must_use]
    pub fn distance(&self, at: DVec3) -> f64 {
        let (cell, p, outside) = self.locate(at);
        let v = self.corners(cell).map(f64::from);
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let low = mix(mix(v[0], v[1], p.x), mix(v[2], v[3], p.x), p.y);
        let high = mix(mix(v[4], v[5], p.x), mix(v[6], v[7], p.x), p.y);
        let inner = mix(low, high, p.z);
        if outside == 0.0 {
            inner
        } else {
            // The mesh is in the box, whose nearest place lies at a right angle or more from all of it: no distance is less. What falls off outwards would
            // be a surface in the air.
            (inner * inner + outside).sqrt()
        }
    }

    /// As [`Self::distance`], to the bit, at a place in each lane.
    #[inline(always)]
    pub(crate) fn distances<T: Number>(&self, at: LaneVec3<T>) -> T {
        let (from, cell) = (at - LaneVec3::all(self.origin), T::splat(self.cell));
        let in_cells = LaneVec3::new(from.x / cell, from.y / cell, from.z / cell);
        let within = |place: T, last: f64| {
            let (zero, last) = (T::splat(0.0), T::splat(last));
            // NaN is the first.
            let place = T::choose(zero.less(place), place, zero);
            T::choose(place.less(last), place, last)
        };
        let clamped = LaneVec3::new(
            within(in_cells.x, self.last.x),
            within(in_cells.y, self.last.y),
            within(in_cells.z, self.last.z),
        );
        let places = [clamped.x, clamped.y, clamped.z].map(T::store);
        let (mut cells, mut corners) = ([Lane::ZERO; 3], [Lane::ZERO; 8]);
        for lane in 0..LANES {
            let cell: [usize; 3] =
                std::array::from_fn(|axis| (places[axis][lane] as usize).min(self.size[axis] - 2));
            for axis in 0..3 {
                cells[axis][lane] = cell[axis] as f64;
            }
            for (corner, value) in corners.iter_mut().zip(self.corners(cell)) {
                corner[lane] = f64::from(value);
            }
        }
        let [x, y, z] = cells.map(|cell| cell.load::<T>());
        let p = clamped - LaneVec3::new(x, y, z);
        let v = corners.map(|corner| corner.load::<T>());
        let mix = |a: T, b: T, t: T| a + (b - a) * t;
        let low = mix(mix(v[0], v[1], p.x), mix(v[2], v[3], p.x), p.y);
        let high = mix(mix(v[4], v[5], p.x), mix(v[6], v[7], p.x), p.y);
        let inner = mix(low, high, p.z);
        let outside = (in_cells - clamped).length_squared() * T::splat(self.cell * self.cell);
        let outer = (inner * inner + outside).sqrt();
        T::choose(T::splat(0.0).less(outside), outer, inner)
    }

    /// The gradient of the distance at a place.
    pub(crate) fn gradient(&self, at: DVec3) -> DVec3 {
        let h = self.cell * 0.5;
        let slope = |d: DVec3| self.distance(at + d) - self.distance(at - d);
        DVec3::new(
            slope(DVec3::X * h),
            slope(DVec3::Y * h),
            slope(DVec3::Z * h),
        )
    }
}

/// A grid in the world, made ready to be asked often.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed<'a> {
    grid: &'a SignedDistance,
    /// From the world to cells of the grid.
    to_cells: Affine3A,
    last: Vec3A,
    cell: f32,
}

impl<'a> Placed<'a> {
    pub(super) fn new(grid: &'a SignedDistance, pose: Pose) -> Self {
        let turn = DMat3::from_quat(pose.rotation.conjugate()) * (1.0 / grid.cell);
        let shift = turn * -pose.translation - grid.origin / grid.cell;
        Self {
            grid,
            to_cells: Affine3A {
                matrix3: turn.as_mat3().into(),
                translation: shift.as_vec3a(),
            },
            last: grid.last.as_vec3a(),
            cell: grid.cell as f32,
        }
    }

    /// As [`SignedDistance::distance`], in single precision, of a place in the world.
    pub(super) fn distance(&self, at: Vec3) -> f32 {
        let in_cells = self.to_cells.transform_point3a(at.into());
        let clamped = in_cells.max(Vec3A::ZERO).min(self.last);
        // A number that this is added to has no fraction left, and its last bits are those of a whole number: three coordinates at once. A grid has far
        // fewer cells along an axis.
        const WHOLE: f32 = (1 << 23) as f32;
        let near = (clamped + WHOLE) - WHOLE;
        let cell = near - Vec3A::select(near.cmpgt(clamped), Vec3A::ONE, Vec3A::ZERO);
        let cell = cell.min(self.last - 1.0);
        let p = clamped - cell;
        let cells = (cell + WHOLE).to_array().map(f32::to_bits);
        let cells = cells.map(|bits| (bits - WHOLE.to_bits()) as usize);
        let v = self.grid.corners(cells);
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let low = mix(mix(v[0], v[1], p.x), mix(v[2], v[3], p.x), p.y);
        let high = mix(mix(v[4], v[5], p.x), mix(v[6], v[7], p.x), p.y);
        let inner = mix(low, high, p.z);
        if clamped == in_cells {
            return inner;
        }
        let outside = (in_cells - clamped).length_squared() * (self.cell * self.cell);
        (inner * inner + outside).sqrt()
    }
}

/// How far a grid goes.
struct Extent {
    origin: DVec3,
    size: [usize; 3],
    /// A ball around the mesh.
    center: DVec3,
    radius: f64,
}

impl Extent {
    fn of(
        points: &[Vec3],
        meshes: &[impl AsRef<[[u32; 3]]>],
        cell: f64,
    ) -> Result<Self, GridError> {
        let triangles = || meshes.iter().flat_map(AsRef::as_ref);
        if triangles().next().is_none() {
            return Err(GridError::Empty);
        }
        if let Some(i) = points.iter().position(|p| !p.is_finite()) {
            return Err(GridError::NotFinite(i));
        }
        for (triangle, corners) in triangles().enumerate() {
            if let Some(&point) = corners.iter().find(|&&c| c as usize >= points.len()) {
                return Err(GridError::Index { triangle, point });
            }
        }
        let corner = |i: u32| points[i as usize].as_dvec3();
        let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
        for &i in triangles().flatten() {
            low = low.min(corner(i));
            high = high.max(corner(i));
        }
        let center = (low + high) * 0.5;
        let radius = (triangles().flatten())
            .map(|&i| (corner(i) - center).length())
            .fold(0.0, f64::max);
        let margin = 3.0 * cell;
        let extent = (high - low + 2.0 * margin) / cell;
        let count = (extent.x + 2.0).floor() * (extent.y + 2.0).floor() * (extent.z + 2.0).floor();
        if !(cell > 0.0 && count <= MOST_POINTS as f64) {
            return Err(GridError::Size {
                cell,
                points: count,
            });
        }
        Ok(Self {
            origin: low - margin,
            size: [
                extent.x as usize + 2,
                extent.y as usize + 2,
                extent.z as usize + 2,
            ],
            center,
            radius,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball of radius 0.1 made of triangles.
    fn ball() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let (rings, around) = (24_u32, 48_u32);
        let mut points = Vec::new();
        for i in 0..=rings {
            let polar = std::f32::consts::PI * i as f32 / rings as f32;
            for j in 0..around {
                let angle = std::f32::consts::TAU * j as f32 / around as f32;
                let level = polar.sin();
                points.push(Vec3::new(level * angle.cos(), polar.cos(), level * angle.sin()) * 0.1);
            }
        }
        let mut triangles = Vec::new();
        for i in 0..rings {
            for j in 0..around {
                let next = (j + 1) % around;
                let (a, b) = (i * around + j, i * around + next);
                triangles.push([a, b, b + around]);
                triangles.push([a, b + around, a + around]);
            }
        }
        (points, triangles)
    }

    #[test]
    fn the_grid_of_a_ball_has_the_ball_s_distances() {
        let (points, triangles) = ball();
        let grid = SignedDistance::new(&points, &triangles, 0.005).unwrap();
        for i in 0..2000 {
            let t = f64::from(i);
            let at = DVec3::new((t * 0.7).sin(), (t * 1.3).cos(), (t * 0.37).sin()).normalize()
                * (0.113 * (t * 0.11).sin().abs());
            let truth = at.length() - 0.1;
            let error = (grid.distance(at) - truth).abs();
            // Where many triangles are about as near, one of them is passed on.
            let most = if at.length() < 0.05 { 0.003 } else { 0.0015 };
            assert!(error < most, "{at}: {} {truth}", grid.distance(at));
            if at.length() > 0.03 && at.length() < 0.11 {
                let normal = grid.gradient(at).normalize();
                assert!(normal.dot(at.normalize()) > 0.98, "{at}");
            }
        }
        // Outside of the grid too.
        assert!((grid.distance(DVec3::X * 1.1) - 1.0).abs() < 0.05);
        assert!(grid.distance(DVec3::X * 1.1) <= 1.0 + 1e-3);
    }

    /// A ball in a larger one, without a lid, that has a wall of its own: all of it is inside, and nothing else.
    #[test]
    fn pieces_are_inside_wherever_one_is() {
        let (points, triangles) = ball();
        let mut all = (points.clone(), triangles.clone());
        let mut add = |size: f32, shift: Vec3, turned: bool, lid: f32| {
            let first = all.0.len() as u32;
            all.0.extend(points.iter().map(|p| *p * size + shift));
            let open = |t: &&[u32; 3]| t.iter().all(|i| points[*i as usize].y < lid);
            all.1.extend(triangles.iter().filter(open).map(|t| {
                let [a, b, c] = t.map(|i| first + i);
                if turned { [a, c, b] } else { [a, b, c] }
            }));
        };
        // Around it one with a hole, and an inner wall that is not open; through both a third.
        add(1.5, Vec3::ZERO, false, 0.09);
        add(1.2, Vec3::X * 0.1, false, 1.0);
        add(0.7, Vec3::X * 0.1, true, 1.0);
        let cell = 0.006;
        let grid = SignedDistance::of_pieces(&all.0, &all.1, cell).unwrap();
        let mut counts = [0; 2];
        for i in 0..4000 {
            let t = f64::from(i);
            let at = DVec3::new((t * 0.7).sin(), (t * 1.3).cos(), (t * 0.37).sin())
                * (0.24 * (t * 0.11).sin().abs());
            let (from_first, from_second) = (at.length(), (at - DVec3::X * 0.1).length());
            let depths = [0.15 - from_first, 0.12 - from_second];
            // Neither near a wall nor beside the hole.
            let is_clear = depths.iter().all(|depth| depth.abs() > 0.01);
            if !is_clear || (at.y > 0.12 && from_first < 0.18) {
                continue;
            }
            let is_inside = depths.iter().any(|depth| *depth > 0.0);
            // Within the wall that faces inwards is one piece less.
            let is_hollow = from_second < 0.08 && depths[0] < 0.0;
            if is_hollow {
                continue;
            }
            counts[usize::from(is_inside)] += 1;
            assert_eq!(grid.distance(at) < 0.0, is_inside, "{at}");
        }
        assert!(counts.iter().all(|count| *count > 300), "{counts:?}");
    }

    #[test]
    fn broken_meshes_are_refused() {
        let (points, triangles) = ball();
        assert_eq!(
            SignedDistance::new(&points, &[], 0.01),
            Err(GridError::Empty)
        );
        assert!(matches!(
            SignedDistance::new(&points, &[[0, 1, 1 << 20]], 0.01),
            Err(GridError::Index { .. })
        ));
        for cell in [0.0, -1.0, f64::NAN, 1e-9] {
            assert!(matches!(
                SignedDistance::new(&points, &triangles, cell),
                Err(GridError::Size { .. })
            ));
        }
        let mut points = points;
        points[3].x = f32::NAN;
        assert_eq!(
            SignedDistance::new(&points, &triangles, 0.01),
            Err(GridError::NotFinite(3))
        );
    }
}
