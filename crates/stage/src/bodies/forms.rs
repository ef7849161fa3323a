//! The forms that a body's mesh takes in time, and their distances.

use super::drawn::Surface;
use glam::{DVec3, Vec3};
use hair_sim::{GridError, SignedDistance};
use std::sync::OnceLock;

/// Cells on the longest side of a form: what is thinner than two of them is not felt.
const CELLS: f64 = 36.0;

/// A mesh, and the forms that it takes one after the other.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Forms {
    /// One or more.
    pub forms: Vec<Form>,
    /// Forms a second.
    pub rate: f64,
    /// Whether they start again after the last one.
    pub repeats: bool,
    /// The side of a cell of their distances, m.
    pub cell: f64,
}

/// One form of a mesh, about the body's middle, m.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Form {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Made when it is first needed.
    grid: OnceLock<Option<SignedDistance>>,
}

impl Form {
    pub fn new((positions, normals, triangles): Surface) -> Self {
        Self {
            positions,
            normals,
            triangles,
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
    /// When the first has no distances.
    pub fn new(forms: Vec<Form>, rate: f64, repeats: bool) -> Result<Self, GridError> {
        let [low, high] = forms.first().ok_or(GridError::Empty)?.bounds();
        let forms = Self {
            cell: f64::from((high - low).max_element()).max(1e-6) / CELLS,
            forms,
            rate,
            repeats,
        };
        let first = forms.distances(0)?;
        let _ = forms.forms[0].grid.set(Some(first));
        Ok(forms)
    }

    pub fn deforms(&self) -> bool {
        self.forms.len() > 1
    }

    fn distances(&self, form: usize) -> Result<SignedDistance, GridError> {
        let form = &self.forms[form];
        SignedDistance::new(&form.positions, &form.triangles, self.cell)
    }

    /// The distances of a form; none where it has none.
    pub fn grid(&self, form: usize) -> Option<&SignedDistance> {
        let grid = &self.forms.get(form)?.grid;
        grid.get_or_init(|| self.distances(form).ok()).as_ref()
    }

    /// The forms before and after a time (seconds), by their numbers, and the share of the way between them.
    pub fn between(&self, time: f64) -> [f64; 3] {
        let count = self.forms.len() as f64;
        let place = time * self.rate;
        let place = match self.repeats {
            true => place.rem_euclid(count),
            false => place.clamp(0.0, count - 1.0),
        };
        let from = place.floor().min(count - 1.0);
        let next = match self.repeats {
            true => (from + 1.0) % count,
            false => (from + 1.0).min(count - 1.0),
        };
        [from, next, (place - from).clamp(0.0, 1.0)]
    }

    /// The surface that is drawn at a time (seconds): between two forms of one mesh it is in between, else the form before.
    pub fn shape(&self, time: f64) -> Surface {
        let [from, to, share] = self.between(time);
        let [from, to] = [from, to].map(|form| &self.forms[form as usize]);
        let surface = |positions, normals| (positions, normals, from.triangles.clone());
        if share == 0.0 || from.triangles != to.triangles {
            return surface(from.positions.clone(), from.normals.clone());
        }
        let mixed = |from: &[Vec3], to: &[Vec3]| -> Vec<Vec3> {
            let pairs = from.iter().zip(to);
            pairs
                .map(|(from, to)| from.lerp(*to, share as f32))
                .collect()
        };
        let normals = mixed(&from.normals, &to.normals);
        let unit = |normal: Vec3| normal.normalize_or(Vec3::Y);
        surface(
            mixed(&from.positions, &to.positions),
            normals.into_iter().map(unit).collect(),
        )
    }
}
