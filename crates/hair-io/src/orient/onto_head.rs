//! Matching a groom's roots with the head they belong to.

use glam::{DVec3, Vec3};

use super::axes::{Axes, Given, Orientation};
use super::cloud::Cloud;
use super::unit::{UNITS, as_scale, scale_to};
use crate::Mesh;
use crate::head::HeadFrame;
use crate::nearest::Nearest;
use crate::sphere::{Sphere, without_outliers};

/// Scalp radii in a head's height.
const RADII_IN_HEIGHT: f64 = 2.6;
/// Of a mesh that far from a head's middle is the head, in head heights: what of a body lies below is none, and hair would fit it as well in another unit.
const REACH: f32 = 0.8;
/// And the middle of a scalp is no farther from the head's.
const MIDDLE: f32 = 0.3;
/// Roots lie on a head where their mean distance from it is below this, in radii of the scalp. Coarse
/// meshes and lifted roots stay below, hair beside the head or of another size doesn't.
const ON_HEAD: f64 = 0.2;

/// Axes, scale and offset under which the roots lie on the head: those the file has, in some unit,
/// else those of its size moved onto the head.
pub(super) fn place(
    cloud: &Cloud,
    sphere: &Sphere,
    head: &Mesh,
    likes_y: f64,
    given: &Given,
) -> Orientation {
    let frame = HeadFrame::find(Some(head), &[]);
    let surface = Surface::of_head(head, &frame);
    let scalp = f64::from(frame.height) / RADII_IN_HEIGHT;
    let fitting = as_scale(scalp / sphere.radius);
    let unit = scale_to(sphere.radius, scalp, 1.0);
    // Heads and scalps differ by so much; what a usual unit makes as large as that isn't stretched to fit.
    let fits = (0.7..1.4).contains(&(unit / fitting));

    // Where the file has it, in any unit.
    let ups = given.up.map_or(vec![Axes::Y, Axes::Z], |up| vec![up]);
    let units = UNITS.iter().map(|unit| unit.1 as f32);
    let units = units.chain((!fits).then_some(fitting));
    let scales = given.scale.map_or(units.collect(), |scale| vec![scale]);
    let offset = given.offset.unwrap_or(Vec3::ZERO);
    let tries = ups.iter().flat_map(|&up| {
        scales
            .iter()
            .map(move |&scale| Orientation { up, scale, offset })
    });
    let misfit = |o: &Orientation| {
        let away = surface.away(&cloud.roots, o);
        away.iter().map(|(distance, _)| distance).sum::<f64>()
            / (away.len() as f64 * sphere.radius * f64::from(o.scale))
    };
    // A head in the middle of the axes fits its hair almost as well when that is turned.
    let turned = |o: &Orientation| {
        if o.up == Axes::Y {
            -0.1 * likes_y
        } else {
            0.1 * likes_y
        }
    };
    // All of a scalp lies around the head's middle.
    let is_around = |o: &Orientation| {
        let middle = o.apply(sphere.center.as_vec3());
        given.offset.is_some()
            || !cloud.is_scalp
            || middle.distance(frame.center) < MIDDLE * frame.height
    };
    let best = tries
        .filter(is_around)
        .map(|o| (misfit(&o), o))
        .min_by(|a, b| (a.0 + turned(&a.1)).total_cmp(&(b.0 + turned(&b.1))));
    if let Some((misfit, orientation)) = best
        && (misfit < ON_HEAD || given.offset.is_some())
    {
        return orientation;
    }

    // Beside the head: the unit by size, then moved onto it.
    let up = given.up.unwrap_or(Axes::liked(likes_y));
    let scale = given.scale.unwrap_or(match fits || !cloud.is_scalp {
        true => unit,
        false => fitting,
    });
    let mut orientation = Orientation { up, scale, offset };
    orientation.offset = settle(cloud, sphere, &orientation, &frame, &surface);
    orientation
}

/// The translation that brings roots of the right size onto the head: their top to its top first,
/// then by the mean way to the nearest surface, repeated (iterative closest points).
fn settle(
    cloud: &Cloud,
    sphere: &Sphere,
    turned: &Orientation,
    frame: &HeadFrame,
    surface: &Surface,
) -> Vec3 {
    let mut placed = Orientation {
        offset: Vec3::ZERO,
        ..*turned
    };
    let roots: Vec<DVec3> = cloud
        .roots
        .iter()
        .map(|r| placed.apply(*r).as_dvec3())
        .collect();
    let top = without_outliers(&roots)
        .iter()
        .map(|r| r.y)
        .fold(f64::NEG_INFINITY, f64::max);
    let middle = placed.apply(sphere.center.as_vec3());
    let head_top = frame.center + Vec3::Y * (frame.height * 0.5);
    placed.offset = head_top - middle.with_y(top as f32);
    for _ in 0..40 {
        let away = surface.away(&cloud.roots, &placed);
        let mean = away.iter().map(|(_, way)| *way).sum::<DVec3>() / away.len().max(1) as f64;
        placed.offset += mean.as_vec3();
    }
    placed.offset
}

/// A head's surface as its vertices and the centres of its triangles.
struct Surface {
    points: Vec<Vec3>,
    tree: Nearest,
}

impl Surface {
    fn of_head(mesh: &Mesh, frame: &HeadFrame) -> Self {
        let centers = mesh.corners().map(|[a, b, c]| a / 3.0 + b / 3.0 + c / 3.0);
        let is_head = |point: &Vec3| point.distance(frame.center) < REACH * frame.height;
        let all = mesh.positions.iter().copied().chain(centers);
        let points: Vec<Vec3> = all.filter(is_head).collect();
        Self {
            tree: Nearest::new(points.iter().copied()),
            points,
        }
    }

    /// Each root's distance from the surface and the way there, nearest first, without the farthest
    /// fifth: loose strands, or hair that the head is not made for.
    fn away(&self, roots: &[Vec3], placed: &Orientation) -> Vec<(f64, DVec3)> {
        let way = |root: &Vec3| {
            let root = placed.apply(*root);
            let (distance, index) = *self.tree.find(root, 1).first()?;
            Some((distance, self.points[index].as_dvec3() - root.as_dvec3()))
        };
        let mut away: Vec<_> = roots.iter().filter_map(way).collect();
        away.sort_by(|a, b| a.0.total_cmp(&b.0));
        away.truncate((away.len() * 4).div_ceil(5));
        away
    }
}
