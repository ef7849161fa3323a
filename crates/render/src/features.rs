//! What a sample shows beside its colour: features, declared by what a frame uses.
//!
//! A sample that shows hair shows one point of one stroke's axis, the one that lends it its colour. Its features are what the strand has
//! there, and where across stroke and clump the sample lies. Nothing is kept and nothing worked out of what is not declared.

use crate::frame::{Frame, Object};
use glam::{Vec2, Vec3};
use stroke_path::Camera;

/// Something that a sample can tell of what it shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Feature {
    /// Which thing it is: 0 nothing, else [`object_of_hair`] or [`object_of_mesh`].
    Object,
    /// The strand's stable id ([`RunInfo::strand`]); [`NO_ID`] where no hair is.
    Strand,
    /// What is ordered as one strand: of a strand that curls its piece ([`Run::strand`](crate::Run::strand)); or [`NO_ID`].
    Piece,
    /// The layer of the stroke, by its place in [`Drawing::layers`](crate::Drawing::layers); or [`NO_ID`].
    Layer,
    /// The strand's level, 0 the lowest; or [`NO_ID`].
    Level,
    /// 1 / view depth (1/m) by which the sample was ordered: depth offsets and round edges count. 0 where nothing is.
    InvDepth,
    /// Place along the strand, 0 at the root to 1 at the tip.
    U,
    /// Length of the strand up to there, head heights.
    S,
    /// Place across the stroke, -1 to 1: distance from the axis point over the radius there. Above 0 to the right of who walks from
    /// root to tip.
    V,
    /// The same across the clump: -1 or 1 outside of it. In [`Order::Shifted`](crate::Order::Shifted), where there is no clump, `V`.
    W,
    /// Pixels that a head's height takes at that depth.
    Pixels,
    /// The unit normal, in the world: of hair between the clump's and a round tube's ([`DrawnFeatures::roundness`]), of a mesh its
    /// triangle's. 0 where nothing is.
    Normal,
    /// Linear colour, each channel 0 to 1, and 1 where something is drawn or the picture has a background, else 0.
    Color,
}

impl Feature {
    /// All of them.
    pub const ALL: &[Self] = &[
        Self::Object,
        Self::Strand,
        Self::Piece,
        Self::Layer,
        Self::Level,
        Self::InvDepth,
        Self::U,
        Self::S,
        Self::V,
        Self::W,
        Self::Pixels,
        Self::Normal,
        Self::Color,
    ];

    /// Whether it is a whole number that stands for something, of which no mean makes sense.
    #[must_use]
    pub const fn is_id(self) -> bool {
        matches!(
            self,
            Self::Object | Self::Strand | Self::Piece | Self::Layer | Self::Level
        )
    }

    /// How many numbers it is.
    #[must_use]
    pub const fn components(self) -> usize {
        match self {
            Self::Normal => 3,
            Self::Color => 4,
            _ => 1,
        }
    }
}

effects::set! {
    /// A set of features. By default none.
    pub struct Features of Feature;
}

/// Stands for no strand, piece, layer or level.
pub const NO_ID: u32 = u32::MAX;

/// [`Feature::Object`] of the hair of a frame's object, by its index.
#[must_use]
pub const fn object_of_hair(object: u32) -> u32 {
    object.wrapping_mul(2).wrapping_add(1)
}

/// [`Feature::Object`] of a mesh, by [`Surface::mesh`](crate::Surface::mesh).
#[must_use]
pub const fn object_of_mesh(mesh: u32) -> u32 {
    mesh.wrapping_add(1).wrapping_mul(2)
}

/// What samples tell of a run's strand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunInfo {
    /// The object whose hair it is, by its index in the frame.
    pub object: u32,
    /// The strand's stable id.
    pub strand: u32,
    /// Its level, 0 the lowest.
    pub level: u32,
}

/// What a drawing's samples tell, and what is known of its joints for that. The default tells nothing.
///
/// Lists of joints are parallel to [`Drawing::clump`](crate::Drawing::clump), linear between joints, and empty where no declared
/// feature needs them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrawnFeatures {
    /// What samples tell.
    pub declared: Features,
    /// For each of [`Drawing::runs`](crate::Drawing::runs) whose it is; empty where nothing is declared.
    pub runs: Vec<RunInfo>,
    /// Places along the strands, 0 to 1: for [`Feature::U`].
    pub u: Vec<f32>,
    /// Lengths up to there, head heights: for [`Feature::S`].
    pub s: Vec<f32>,
    /// Pixels that a head's height takes there: for [`Feature::Pixels`].
    pub pixels: Vec<f32>,
    /// Places in the world, metres: for [`Feature::Normal`].
    pub position: Vec<Vec3>,
    /// Unit vectors along the strands, to their tips: for [`Feature::Normal`].
    pub forward: Vec<Vec3>,
    /// The clumps' unit normals: for [`Feature::Normal`].
    pub normal: Vec<Vec3>,
    /// How much normals of hair are those of a round tube: 0 the clump's, 1 the tube's.
    pub roundness: f32,
    /// What sees the drawing: for [`Feature::Normal`], which is 0 without it.
    pub camera: Option<Camera>,
}

impl DrawnFeatures {
    /// Forgets everything, and keeps the lists' memory.
    pub fn clear(&mut self) {
        self.declared = Features::NONE;
        self.runs.clear();
        for list in [&mut self.u, &mut self.s, &mut self.pixels] {
            list.clear();
        }
        for list in [&mut self.position, &mut self.forward, &mut self.normal] {
            list.clear();
        }
        self.camera = None;
    }

    /// Takes on what a checked frame declares, in place of what was there; but for the clumps' normals.
    pub(crate) fn fill(&mut self, frame: &Frame) {
        self.clear();
        self.declared = frame.all_features();
        if self.declared.is_empty() {
            return;
        }
        self.roundness = frame.roundness;
        self.camera = Some(*frame.camera);
        let paths = frame.paths;
        let mut object = 0;
        self.runs.extend(paths.runs.iter().map(|run| {
            while run.joints.end > frame.objects[object].joints.end {
                object += 1;
            }
            RunInfo {
                object: object as u32,
                strand: frame.strands[run.strand].id,
                level: frame.strands[run.strand].level,
            }
        }));
        if self.declared.has(Feature::U) {
            self.u.extend_from_slice(&paths.u);
        }
        for Object { head, joints, .. } in &frame.objects {
            if self.declared.has(Feature::S) {
                let lengths = paths.arc_length[joints.clone()].iter();
                self.s.extend(lengths.map(|length| length / head.height_m));
            }
            if self.declared.has(Feature::Pixels) {
                let scales = paths.px_per_metre[joints.clone()].iter();
                self.pixels
                    .extend(scales.map(|scale| scale * head.height_m));
            }
        }
        if self.declared.has(Feature::Normal) {
            self.position.extend_from_slice(&paths.position);
            let ways = paths.forward.iter().zip(&paths.backward);
            self.forward
                .extend(ways.map(|(ahead, back)| tangent(*ahead, *back)));
        }
    }

    /// The lists of joints that the declared features need, with their lengths.
    pub(crate) fn needed_lists(&self) -> impl Iterator<Item = (&'static str, usize)> {
        let lists = [
            (Feature::U, "u", self.u.len()),
            (Feature::S, "s", self.s.len()),
            (Feature::Pixels, "pixels", self.pixels.len()),
            (Feature::Normal, "position", self.position.len()),
            (Feature::Normal, "forward", self.forward.len()),
            (Feature::Normal, "normal", self.normal.len()),
        ];
        let needed = move |(feature, ..): &(Feature, &str, usize)| self.declared.has(*feature);
        lists
            .into_iter()
            .filter(needed)
            .map(|(_, name, length)| (name, length))
    }

    /// The normal of hair at the way `way` from a joint to the next, `w` across the clump.
    pub(crate) fn normal_of_hair(&self, joint: usize, next: usize, way: f32, w: f32) -> Vec3 {
        let Some(camera) = &self.camera else {
            return Vec3::ZERO;
        };
        let mixed = |list: &[Vec3]| list[joint].lerp(list[next], way);
        let clump = mixed(&self.normal);
        let to_eye = camera.eye() - mixed(&self.position);
        let tube = tube_normal(mixed(&self.forward), to_eye, w);
        let normal = clump.lerp(tube.unwrap_or(clump), self.roundness);
        normal.normalize_or(tube.unwrap_or(Vec3::Y))
    }
}

/// The unit vector along a strand at a joint, of those to its neighbours.
pub(crate) fn tangent(forward: Vec3, backward: Vec3) -> Vec3 {
    (forward - backward).normalize_or(forward)
}

/// The unit normal of a round tube along `forward` at the place `w` across it, from -1 to 1, that is seen from `to_eye`; none where
/// it is seen along its axis.
pub(crate) fn tube_normal(forward: Vec3, to_eye: Vec3, w: f32) -> Option<Vec3> {
    let across = forward.cross(to_eye).try_normalize()?;
    let facing = across.cross(forward).try_normalize()?;
    Some(w * across + (1.0 - w * w).max(0.0).sqrt() * facing)
}

/// The unit normal of a triangle on the screen towards the eye, in the world, by corners as place in pixels and inverse depth; 0 where it
/// has no area.
pub(crate) fn normal_of_triangle(camera: &Camera, corners: [(Vec2, f32); 3]) -> Vec3 {
    let [width, height] = camera.size_px().map(f64::from);
    let focal = f64::from(camera.focal_px());
    // As double precision, because thin triangles' planes come from small differences.
    let [a, b, c] = corners.map(|(place, inv_depth)| {
        let depth = 1.0 / f64::from(inv_depth);
        let x = (f64::from(place.x) - width / 2.0) * depth / focal;
        let y = (height / 2.0 - f64::from(place.y)) * depth / focal;
        glam::DVec3::new(x, y, depth)
    });
    let normal = (b - a).cross(c - a).normalize_or_zero();
    // Towards the eye, which is where view space begins.
    let facing = if normal.dot(a) > 0.0 { -normal } else { normal };
    camera.world_from_view_direction(facing.as_vec3())
}

#[cfg(test)]
mod tests {
    use super::*;
    use stroke_path::OrbitView;

    #[test]
    fn sets() {
        let set = Features::of(&[Feature::V, Feature::Object]);
        assert!(set.has(Feature::V) && !set.has(Feature::W) && !set.is_empty());
        let all: Vec<_> = set.union(Features::of(&[Feature::Color])).iter().collect();
        assert_eq!(all, [Feature::Object, Feature::V, Feature::Color]);
        assert!(Features::default().is_empty() && Features::NONE.iter().next().is_none());
    }

    #[test]
    fn objects_are_told_apart() {
        let ids = [
            object_of_hair(0),
            object_of_mesh(0),
            object_of_hair(1),
            object_of_mesh(1),
        ];
        assert_eq!(ids, [1, 2, 3, 4]);
    }

    #[test]
    fn a_tube_faces_the_eye_in_its_middle_and_away_at_its_edges() {
        let normal = |w| tube_normal(Vec3::NEG_Y, Vec3::Z, w).unwrap();
        assert_eq!(normal(0.0), Vec3::Z);
        // Hair that hangs down has the left of the screen to its right.
        assert_eq!(normal(1.0), Vec3::NEG_X);
        assert_eq!(normal(-1.0), Vec3::X);
        assert!((normal(0.6) - Vec3::new(-0.6, 0.0, 0.8)).length() < 1e-6);
        assert_eq!(tube_normal(Vec3::Z, Vec3::Z, 0.5), None);
    }

    #[test]
    fn triangles_face_the_eye() {
        let view = OrbitView {
            target: Vec3::ZERO,
            yaw_degrees: 30.0,
            pitch_degrees: 10.0,
            distance_m: 3.0,
            vertical_fov_degrees: 30.0,
        };
        let camera = Camera::orbit(view, [200, 100], 0.1).unwrap();
        let wanted = Vec3::new(0.4, 0.3, 0.9).normalize();
        let (across, up) = (wanted.any_orthonormal_vector(), Vec3::ZERO);
        let up = up + wanted.cross(across);
        for corners in [[across, up, -across], [up, across, -across]] {
            let corners = corners.map(|place| {
                let view = camera.view_from_world(0.2 * place);
                (camera.project(view), 1.0 / view.z)
            });
            let normal = normal_of_triangle(&camera, corners);
            assert!((normal - wanted).length() < 1e-4, "{normal}");
        }
    }
}
