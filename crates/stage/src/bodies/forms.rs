//! The forms that a body's mesh takes in time, and their distances.

use super::{drawn::Surface, pieces::parted};
use crate::once::once;
use glam::{DVec3, Vec3};
use hair_sim::{GridError, SignedDistance};
use mesh_io::Welded;
use mesh_lines::{Beside, Topology};
use rayon::prelude::*;
use std::sync::OnceLock;

/// Cells on the longest side of a form: what is thinner than two of them is not felt.
const CELLS: f64 = 36.0;

/// A mesh, and the forms that it takes one after the other.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Forms {
    /// One or more.
    forms: Vec<Form>,
    /// Forms a second.
    rate: f64,
    /// What comes after the last one.
    end: End,
    /// The side of a cell of their distances, m.
    cell: f64,
    /// No place of a form is farther from its middle, m.
    radius: f64,
}

/// What comes after the last of some forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// It stays.
    Stays,
    /// The first one, as far from it as the others are from each other.
    First,
    /// What comes after the first one, which the last one is again.
    Round,
}

impl End {
    /// Of the numbered files of a mesh.
    pub fn of_files(repeats: bool) -> Self {
        if repeats { Self::First } else { Self::Stays }
    }

    /// Of an animation.
    pub fn of_animation(repeats: bool) -> Self {
        if repeats { Self::Round } else { Self::Stays }
    }
}

/// One form of a mesh, about the body's middle, m.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Form {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Where it has come to as a whole, of several that the mesh takes.
    middle: Vec3,
    /// Its distances about that, made when they are first needed.
    grid: OnceLock<SignedDistance>,
}

impl Form {
    pub fn new((positions, normals, triangles): Surface) -> Self {
        Self {
            positions,
            normals,
            triangles,
            middle: Vec3::ZERO,
            grid: OnceLock::new(),
        }
    }

    /// The corners of the box around it.
    pub fn bounds(&self) -> [Vec3; 2] {
        let positions = || self.positions.iter().copied();
        [
            positions().fold(Vec3::INFINITY, Vec3::min),
            positions().fold(Vec3::NEG_INFINITY, Vec3::max),
        ]
    }

    /// Whether it has holes that a point may be lost through: edges of one triangle alone, longer together than the form. Corners at one place are one.
    pub fn is_open(&self) -> bool {
        let welded = self.welded();
        let Ok(topology) = Topology::new(&welded.positions, &welded.triangles) else {
            return false;
        };
        let half_edges = 0..welded.triangles.len() as u32 * 3;
        let border = half_edges.filter(|&edge| topology.beside(edge) == Beside::Border);
        let length = |edge| {
            let [from, to] = topology
                .ends(edge)
                .map(|end| welded.positions[end as usize]);
            from.distance(to)
        };
        border.map(length).sum::<f32>() > self.longest_side()
    }

    /// Its surface with one corner at each place.
    fn welded(&self) -> Welded {
        let triangles = self.triangles.iter();
        Welded::from_corners(triangles.map(|t| t.map(|i| self.positions[i as usize])))
    }

    /// Distances about [its middle](Forms::middle).
    fn distances(&self, cell: f64) -> Result<SignedDistance, GridError> {
        let mut mesh = self.welded();
        if mesh.triangles.is_empty() {
            // All are without area.
            (mesh.positions, mesh.triangles) = (self.positions.clone(), self.triangles.clone());
        }
        let parts = parted(&mesh);
        for place in &mut mesh.positions {
            *place -= self.middle;
        }
        SignedDistance::of_union(&mesh.positions, &parts, cell)
    }

    fn longest_side(&self) -> f32 {
        let [low, high] = self.bounds();
        (high - low).max_element()
    }

    /// Moves its middle and makes it larger.
    pub fn put(&mut self, from_middle: DVec3, turn: glam::DQuat, size: f64) {
        for position in &mut self.positions {
            *position = (turn * (position.as_dvec3() - from_middle) * size).as_vec3();
        }
        for normal in &mut self.normals {
            *normal = turn.as_quat() * *normal;
        }
    }
}

impl Forms {
    /// Forms of this many a second.
    ///
    /// # Errors
    ///
    /// The number of the first one, from 0, that has no distances, and why.
    pub fn new(mut forms: Vec<Form>, rate: f64, end: End) -> Result<Self, (usize, GridError)> {
        if forms.len() > 1 {
            find_middles(&mut forms);
        }
        // Of the largest form, so that none of them takes more cells.
        let sides = forms.iter().map(Form::longest_side);
        let longest = sides.map(f64::from).fold(1e-6, f64::max);
        let farthest = |form: &Form| {
            let squares = form
                .positions
                .iter()
                .map(|p| p.distance_squared(form.middle));
            f64::from(squares.fold(0.0, f32::max)).sqrt()
        };
        let forms = Self {
            cell: longest / CELLS,
            radius: forms.iter().map(farthest).fold(0.0, f64::max),
            forms,
            rate,
            end,
        };
        for (number, form) in forms.forms.iter().enumerate() {
            SignedDistance::check(&form.positions, &form.triangles, forms.cell)
                .map_err(|error| (number, error))?;
        }
        Ok(forms)
    }

    pub fn deforms(&self) -> bool {
        self.forms.len() > 1
    }

    /// The number of the first form, from 0, that [is open](Form::is_open).
    pub fn first_open(&self) -> Option<usize> {
        self.forms.par_iter().position_first(Form::is_open)
    }

    /// Where the mesh has come to as a whole at a time (seconds): its distances are those about this place. Mixed where they are, two forms that are farther apart
    /// than the mesh is thick would have hardly any inside between them.
    pub fn middle(&self, time: f64) -> DVec3 {
        let (from, to, share) = self.between(time);
        let [from, to] = [from, to].map(|form| self.forms[form].middle.as_dvec3());
        from.lerp(to, share)
    }

    /// A ball that the mesh is in at a time (seconds), be it mixed of two forms or still the form before: its middle and its radius, m.
    pub fn ball(&self, time: f64) -> (DVec3, f64) {
        let (from, to, _) = self.between(time);
        let [from, to] = [from, to].map(|form| self.forms[form].middle.as_dvec3());
        (self.middle(time), self.radius + from.distance(to))
    }

    /// The distances of a form about [its middle](Self::middle).
    pub fn grid(&self, form: usize) -> &SignedDistance {
        let form = &self.forms[form];
        once(&form.grid, || {
            let distances = form.distances(self.cell);
            distances.expect("forms are checked when they are read")
        })
    }

    /// The forms before and after a time (seconds), by their numbers, and the share of the way between them.
    pub fn between(&self, time: f64) -> (usize, usize, f64) {
        between(self.forms.len(), self.rate, self.end, time)
    }

    /// Whether the surfaces of two times (seconds) are alike, within a tenth of a cell of their distances.
    pub fn are_alike(&self, one: f64, other: f64) -> bool {
        let [(places, _, triangles), (other_places, _, other_triangles)] =
            [one, other].map(|time| self.shape(time));
        let far = 0.1 * self.cell as f32;
        triangles == other_triangles
            && places
                .iter()
                .zip(&other_places)
                .all(|(p, q)| p.distance(*q) <= far)
    }

    /// The surface that is drawn at a time (seconds): between two forms of one mesh it is in between, else the form before.
    pub fn shape(&self, time: f64) -> Surface {
        let (from, to, share) = self.between(time);
        let [from, to] = [from, to].map(|form| &self.forms[form]);
        let surface = |positions, normals| (positions, normals, from.triangles.clone());
        if share == 0.0 || from.triangles != to.triangles {
            return surface(from.positions.clone(), from.normals.clone());
        }
        surface(
            mixed(&from.positions, &to.positions, share),
            mixed_normals(&from.normals, &to.normals, share),
        )
    }
}

/// Finds where forms have come to: of one mesh the mean of its corners, of several that of the box around each.
fn find_middles(forms: &mut [Form]) {
    let is_one_mesh = forms.windows(2).all(|pair| {
        pair[0].triangles == pair[1].triangles && pair[0].positions.len() == pair[1].positions.len()
    });
    for form in forms {
        form.middle = if is_one_mesh {
            let sum: DVec3 = form.positions.iter().map(|p| p.as_dvec3()).sum();
            (sum / form.positions.len().max(1) as f64).as_vec3()
        } else {
            let [low, high] = form.bounds();
            low.midpoint(high)
        };
        // What isn't a number is told with the form's distances.
        if !form.middle.is_finite() {
            form.middle = Vec3::ZERO;
        }
    }
}

/// Of so many forms, `rate` a second, those before and after a time (seconds), by their numbers, and the share of the way between them.
pub(crate) fn between(count: usize, rate: f64, end: End, time: f64) -> (usize, usize, f64) {
    let last = count - 1;
    let place = time * rate;
    // A time in single precision that is a form's may be a little before it, and would show the one before.
    let slack = place.abs() * f64::from(f32::EPSILON) + 1e-6;
    let place = place.max((place + slack).floor());
    let place = match end {
        End::First => place.rem_euclid(count as f64),
        End::Round if last > 0 => place.rem_euclid(last as f64),
        End::Round | End::Stays => place.clamp(0.0, last as f64),
    };
    let from = (place.floor() as usize).min(last);
    let next = match end {
        End::First => (from + 1) % count,
        End::Round | End::Stays => (from + 1).min(last),
    };
    (from, next, (place - from as f64).clamp(0.0, 1.0))
}

/// Places a share of the way from one form to the next.
pub(crate) fn mixed(from: &[Vec3], to: &[Vec3], share: f64) -> Vec<Vec3> {
    let pairs = from.iter().zip(to);
    pairs
        .map(|(from, to)| from.lerp(*to, share as f32))
        .collect()
}

/// The same of unit normals.
pub(crate) fn mixed_normals(from: &[Vec3], to: &[Vec3], share: f64) -> Vec<Vec3> {
    let normals = mixed(from, to, share).into_iter();
    normals.map(|normal| normal.normalize_or(Vec3::Y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A closed box of this half side.
    fn cube(half: f32) -> Form {
        let side = |corner: u32, bit: u32| if corner & bit == 0 { -half } else { half };
        let corner = |i: u32| Vec3::new(side(i, 1), side(i, 2), side(i, 4));
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let triangles = faces
            .iter()
            .flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]);
        let positions: Vec<Vec3> = (0..8).map(corner).collect();
        Form::new((positions.clone(), positions, triangles.collect()))
    }

    /// What is drawn of it is in its ball, mixed or the form before: what lies about it may be left out of a picture.
    #[test]
    fn a_mesh_is_in_its_ball() {
        let moved = |half: f32, by: Vec3| {
            let cube = cube(half);
            let positions = cube.positions.iter().map(|p| *p + by).collect();
            Form::new((positions, cube.normals, cube.triangles))
        };
        let mut other = moved(0.1, Vec3::X);
        other.triangles.rotate_left(1);
        let forms = [
            vec![moved(0.1, Vec3::ZERO), moved(0.3, Vec3::Y)],
            vec![moved(0.1, Vec3::ZERO), other],
        ];
        for forms in forms {
            let forms = Forms::new(forms, 1.0, End::Stays).unwrap();
            for time in (0..=20).map(|i| f64::from(i) / 10.0) {
                let (middle, radius) = forms.ball(time);
                let (positions, ..) = forms.shape(time);
                let away = positions.iter().map(|p| p.as_dvec3().distance(middle));
                let farthest = away.fold(0.0, f64::max);
                assert!(farthest < 1.0001 * radius, "{time}: {farthest} {radius}");
            }
        }
    }

    #[test]
    fn forms_follow_each_other_as_their_rate_says() {
        let forms = || vec![cube(0.1), cube(0.2), cube(0.4)];
        let once = Forms::new(forms(), 2.0, End::Stays).unwrap();
        let again = Forms::new(forms(), 2.0, End::First).unwrap();
        let round = Forms::new(forms(), 2.0, End::Round).unwrap();
        for (time, expected) in [
            (-1.0, [(0, 1, 0.0), (1, 2, 0.0), (0, 1, 0.0)]),
            (0.0, [(0, 1, 0.0); 3]),
            (0.25, [(0, 1, 0.5); 3]),
            (1.0, [(2, 2, 0.0), (2, 0, 0.0), (0, 1, 0.0)]),
            (1.25, [(2, 2, 0.0), (2, 0, 0.5), (0, 1, 0.5)]),
            (9.0, [(2, 2, 0.0), (0, 1, 0.0), (0, 1, 0.0)]),
        ] {
            let found = [&once, &again, &round].map(|forms| forms.between(time));
            assert_eq!(found, expected, "{time}");
        }
        // Each frame has its own form, whatever single precision makes of its time.
        for rate in [24.0f32, 30.0, 60.0] {
            for frame in 0..200 {
                let time = f64::from(frame as f32 / rate);
                for (end, expected) in [
                    (End::Stays, frame.min(99)),
                    (End::First, frame % 100),
                    (End::Round, frame % 99),
                ] {
                    let (from, ..) = between(100, f64::from(rate), end, time);
                    assert_eq!(from, expected, "{rate} {end:?} {frame}");
                }
            }
        }
        // One alone stays whatever comes.
        for end in [End::Stays, End::First, End::Round] {
            let (from, to, _) = between(1, 24.0, end, 7.3);
            assert_eq!((from, to), (0, 0), "{end:?}");
        }
        // Each form has its distances.
        for (form, half) in [(0, 0.1), (1, 0.2), (2, 0.4)] {
            let distance = once.grid(form).distance(DVec3::X * (half + 0.03));
            assert!((distance - 0.03).abs() < 1e-3, "{distance}");
        }
        let (positions, ..) = once.shape(0.25);
        assert!((positions[0].x + 0.15).abs() < 1e-6, "{}", positions[0]);
    }

    /// Half way between two forms that have nothing in common a mesh is as thick as they are.
    #[test]
    fn what_goes_by_more_than_its_thickness_keeps_its_inside() {
        let moved = |by: Vec3| {
            let mut cube = cube(0.1);
            for position in &mut cube.positions {
                *position += by;
            }
            cube
        };
        let one_mesh = vec![moved(Vec3::ZERO), moved(Vec3::X * 0.5)];
        let mut two_meshes = one_mesh.clone();
        two_meshes[1].triangles.rotate_left(1);
        for forms in [one_mesh, two_meshes] {
            let forms = Forms::new(forms, 1.0, End::Stays).unwrap();
            for (time, x) in [(0.0, 0.0), (0.5, 0.25), (1.0, 0.5)] {
                let middle = forms.middle(time);
                assert!((middle - DVec3::X * x).length() < 1e-6, "{middle}");
            }
            for form in [0, 1] {
                let inside = forms.grid(form).distance(DVec3::ZERO);
                assert!((inside + 0.1).abs() < 0.01, "{inside}");
            }
        }
    }

    #[test]
    fn what_lacks_a_side_is_open() {
        assert!(!cube(0.1).is_open());
        let mut open = cube(0.1);
        open.triangles.truncate(10);
        assert!(open.is_open());
        // Each side with corners of its own, as files have it.
        let apart = |cube: Form| {
            let corners = cube.triangles.iter().flatten();
            let positions: Vec<Vec3> = corners.map(|&i| cube.positions[i as usize]).collect();
            let triangles = (0..cube.triangles.len() as u32).map(|t| [0, 1, 2].map(|k| 3 * t + k));
            Form::new((positions.clone(), positions, triangles.collect()))
        };
        assert!(!apart(cube(0.1)).is_open());
        // A hole that is small beside it does not matter.
        let mut pricked = apart(cube(0.1));
        let [a, b, c] = pricked.triangles.pop().unwrap();
        let [a, b, c] = [a, b, c].map(|i| pricked.positions[i as usize]);
        let inner = [a, b, c].map(|p| p.lerp((a + b + c) / 3.0, 0.9));
        let first = pricked.positions.len() as u32;
        pricked.positions.extend([a, b, c].into_iter().chain(inner));
        for k in 0..3 {
            let (from, to) = (first + k, first + (k + 1) % 3);
            pricked
                .triangles
                .extend([[from, to, to + 3], [from, to + 3, from + 3]]);
        }
        assert!(!pricked.is_open());
    }

    #[test]
    fn a_surface_that_is_there_twice_is_felt_once() {
        let single = cube(0.1);
        let mut double = single.clone();
        // As a side of its own with corners of its own, which looks the other way.
        let first = double.positions.len() as u32;
        double.positions.extend_from_slice(&single.positions);
        double
            .normals
            .extend(single.normals.iter().map(|normal| -*normal));
        let other = single
            .triangles
            .iter()
            .map(|[a, b, c]| [first + a, first + c, first + b]);
        double.triangles.extend(other);
        let forms = [single, double].map(|form| Forms::new(vec![form], 1.0, End::Stays).unwrap());
        assert_eq!(forms[0].grid(0), forms[1].grid(0));
        assert!(forms[1].grid(0).distance(DVec3::ZERO) < -0.09);
    }

    #[test]
    fn pieces_that_overlap_are_one_body() {
        // A cube in another, one beside it into which it reaches, one that is wound inwards, and one without a side that reaches into that.
        let mut all = cube(0.1);
        for (half, by, is_inward, sides) in [
            (0.05, Vec3::ZERO, false, 12),
            (0.08, Vec3::X * 0.1, false, 12),
            (0.06, Vec3::X * -0.3, true, 12),
            (0.03, Vec3::X * -0.35, false, 10),
        ] {
            let first = all.positions.len() as u32;
            let other = cube(half);
            all.positions
                .extend(other.positions.iter().map(|p| *p + by));
            all.normals.extend(other.normals);
            let triangles = other.triangles.iter().take(sides);
            let triangles = triangles.map(|t| t.map(|i| first + i));
            all.triangles.extend(triangles.map(
                |[a, b, c]| {
                    if is_inward { [a, c, b] } else { [a, b, c] }
                },
            ));
        }
        let forms = Forms::new(vec![all], 1.0, End::Stays).unwrap();
        let distance = |x: f64| forms.grid(0).distance(DVec3::X * x);
        // How deep it is in that of them in which it is deepest: to no wall within.
        for (x, depth) in [
            (0.0, 0.1),
            (0.05, 0.05),
            (0.075, 0.055),
            (0.14, 0.04),
            (-0.3, 0.06),
            (-0.35, 0.03),
        ] {
            assert!((distance(x) + depth).abs() < 0.01, "{x}: {}", distance(x));
        }
        for (x, gap) in [(0.2, 0.02), (-0.15, 0.05), (-0.21, 0.03), (-0.4, 0.02)] {
            assert!((distance(x) - gap).abs() < 0.01, "{x}: {}", distance(x));
        }
    }

    #[test]
    fn a_form_without_distances_is_named() {
        let mut bad = cube(0.2);
        bad.triangles.push([0, 1, 99]);
        let error = Forms::new(vec![cube(0.1), bad], 1.0, End::Stays).unwrap_err();
        assert_eq!(
            error,
            (
                1,
                GridError::Index {
                    triangle: 12,
                    point: 99
                }
            )
        );
        let mut bad = cube(0.2);
        bad.positions[3].y = f32::NAN;
        let error = Forms::new(vec![cube(0.1), cube(0.1), bad], 1.0, End::Stays).unwrap_err();
        assert_eq!(error, (2, GridError::NotFinite(3)));
        // A later form that is a thousand times as large takes no more memory.
        let forms = Forms::new(vec![cube(0.001), cube(1.0)], 1.0, End::Stays).unwrap();
        assert!(forms.cell > 0.01);
    }
}
