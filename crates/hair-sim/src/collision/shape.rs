//! Bodies that hair cannot enter.

use glam::{DVec3, Vec3};

use crate::pose::Pose;

use super::grid::{self, SignedDistance};

/// A body in its own space.
#[derive(Clone, Copy, Debug)]
pub enum Shape<'a> {
    /// A ball.
    Sphere {
        /// In m.
        center: DVec3,
        /// In m, 0 or more.
        radius: f64,
    },
    /// All that is within `radius` of the line from one end to the other.
    Capsule {
        /// One end, in m.
        from: DVec3,
        /// The other end.
        to: DVec3,
        /// In m, 0 or more.
        radius: f64,
    },
    /// A closed mesh, by its distances on a grid.
    Grid(&'a SignedDistance),
    /// A closed mesh on its way from one form to another, `size` times as large: its distances are the mean of theirs.
    Form {
        /// The form that it leaves.
        from: &'a SignedDistance,
        /// The form that it comes to.
        to: &'a SignedDistance,
        /// How much of the way it has gone, 0 to 1.
        share: f64,
        /// Above 0.
        size: f64,
    },
}

/// A body and how it moves in a step.
///
/// ```
/// use glam::{DVec3, Vec3};
/// use hair_sim::{Collider, Params, Pose, Shape, Solver, Strands, Surroundings};
///
/// // A ball that grows under a strand.
/// let ball = |step: i32| Shape::Sphere { center: DVec3::ZERO, radius: 0.1 + 0.005 * f64::from(step) };
/// let mut rest = Strands::new();
/// let points: Vec<Vec3> = (0..=10).map(|i| Vec3::new(-0.05 + 0.01 * i as f32, 0.12, 0.0)).collect();
/// rest.push(0, &points, None).expect("finite points");
/// let (mut solver, mut state) = Solver::new(&rest, &Params::default())?;
/// for step in 1..=8 {
///     let bodies = [Collider { was: Some(ball(step - 1)), ..Collider::fixed(ball(step), Pose::IDENTITY) }];
///     let surroundings = Surroundings { colliders: &bodies, ..Surroundings::default() };
///     solver.step(&mut state, &surroundings, 1.0 / 60.0)?;
/// }
/// // It is lifted by the ball, whose radius is 0.14 m now.
/// assert!(solver.points(&state, 0).skip(2).all(|point: DVec3| point.length() > 0.139));
/// # Ok::<(), hair_sim::DynamicsError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Collider<'a> {
    /// In its own space.
    pub shape: Shape<'a>,
    /// Where it is in the world when the step starts.
    pub before: Pose,
    /// And when it ends.
    pub now: Pose,
    /// Its shape when the step starts, where it is another than at its end. What it presses on then moves as its surface does, along its normals.
    pub was: Option<Shape<'a>>,
}

impl<'a> Collider<'a> {
    /// A body that stays where it is.
    #[must_use]
    pub fn fixed(shape: Shape<'a>, pose: Pose) -> Self {
        Self {
            shape,
            before: pose,
            now: pose,
            was: None,
        }
    }

    /// The distance of a place in the world from its surface when the step ends, in m, negative inside; never more than the true one by
    /// more than a grid's error.
    #[must_use]
    pub fn distance(&self, at: DVec3) -> f64 {
        self.shape.distance(self.now.to_local(at))
    }

    /// The way out of it at a place in the world when the step ends, a unit vector.
    #[must_use]
    pub fn outwards(&self, at: DVec3) -> DVec3 {
        self.now.rotation * self.shape.normal(self.now.to_local(at))
    }

    /// Its shape when the step starts.
    pub(crate) fn at_start(&self) -> &Shape<'a> {
        self.was.as_ref().unwrap_or(&self.shape)
    }

    /// By how much its surface comes nearer in the step to a place in its own space, in m, as its shape changes.
    #[inline]
    pub(crate) fn grown(&self, at: DVec3) -> f64 {
        match &self.was {
            Some(was) => was.distance(at) - self.shape.distance(at),
            None => 0.0,
        }
    }

    /// How far its surface goes in the step as its shape changes, in m: the most that any of fourteen places around it sees it come or go.
    pub(crate) fn changed(&self) -> f64 {
        if self.was.is_none() {
            return 0.0;
        }
        let (center, radius) = self.shape.ball();
        // Faces and corners of a cube.
        let faces = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        let sign = |corner: u8, axis: u8| f64::from(corner >> axis & 1) * 2.0 - 1.0;
        let corners = (0..8).map(|i| DVec3::new(sign(i, 0), sign(i, 1), sign(i, 2)).normalize());
        faces
            .chain(corners)
            .map(|way| self.grown(center + way * radius).abs())
            .fold(0.0, f64::max)
    }

    /// Whether it moves in the step, as a whole or by its shape.
    pub(crate) fn moves(&self) -> bool {
        let deforms = |was: &Shape| was.numbers() != self.shape.numbers();
        self.before != self.now || self.was.as_ref().is_some_and(deforms)
    }

    /// Whether its numbers are finite, radii no less than 0, and its poses rigid.
    pub(crate) fn is_valid(&self) -> bool {
        let shapes = self.shape.is_finite() && self.at_start().is_finite();
        shapes && self.before.is_rigid() && self.now.is_rigid()
    }
}

/// Where the root of a strand is in a ball or a capsule, hair comes out of it by this share of its length: by all of it a strand would be pulled taut,
/// by more its links would be torn apart, and the way out may go along another body.
pub const LEADS_OUT: f64 = 0.5;

/// A body where it is when the step ends, made ready to be asked often and in single precision: for what is drawn.
///
/// ```
/// use glam::{DVec3, Vec3};
/// use hair_sim::{Collider, Placed, Pose, Shape};
///
/// let ball = Shape::Sphere { center: DVec3::X, radius: 0.5 };
/// let ball = Placed::new(&Collider::fixed(ball, Pose::IDENTITY));
/// assert_eq!(ball.distance(Vec3::X * 3.0), 1.5);
/// assert_eq!(ball.outwards(Vec3::X * 3.0), Vec3::X);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    collider: Collider<'a>,
    asked: Asked<'a>,
}

/// What tells the distance from a body in single precision.
#[derive(Clone, Copy, Debug)]
enum Asked<'a> {
    /// That from a line in the world, whose way has one over the square of its length beside it, 0 of a point.
    Line {
        from: Vec3,
        along: Vec3,
        per_square: f32,
        radius: f32,
    },
    Grid(grid::Placed<'a>),
    /// The body itself, in double precision.
    Body,
}

impl<'a> Placed<'a> {
    /// Whether it is a mesh, whose distances are known on a grid.
    #[must_use]
    pub fn is_sampled(&self) -> bool {
        self.collider.shape.is_sampled()
    }

    /// A body when its step ends.
    #[must_use]
    pub fn new(collider: &Collider<'a>) -> Self {
        let line = |from: DVec3, to: DVec3, radius: f64| {
            let [from, to] = [from, to].map(|end| collider.now.to_world(end));
            let square = (to - from).length_squared();
            Asked::Line {
                from: from.as_vec3(),
                along: (to - from).as_vec3(),
                per_square: if square > 0.0 {
                    (1.0 / square) as f32
                } else {
                    0.0
                },
                radius: radius as f32,
            }
        };
        let asked = match collider.shape {
            Shape::Sphere { center, radius } => line(center, center, radius),
            Shape::Capsule { from, to, radius } => line(from, to, radius),
            Shape::Grid(grid) => Asked::Grid(grid::Placed::new(grid, collider.now)),
            Shape::Form { .. } => Asked::Body,
        };
        Self {
            collider: *collider,
            asked,
        }
    }

    /// As [`Collider::distance`], in m, within a micrometre within metres of the origin.
    #[must_use]
    #[inline]
    pub fn distance(&self, at: Vec3) -> f32 {
        match &self.asked {
            Asked::Line {
                from,
                along,
                per_square,
                radius,
            } => {
                let way = at - *from;
                let share = (way.dot(*along) * per_square).clamp(0.0, 1.0);
                (way - *along * share).length() - radius
            }
            Asked::Grid(grid) => grid.distance(at),
            Asked::Body => self.collider.distance(at.as_dvec3()) as f32,
        }
    }

    /// As [`Collider::outwards`].
    #[must_use]
    pub fn outwards(&self, at: Vec3) -> Vec3 {
        self.collider.outwards(at.as_dvec3()).as_vec3()
    }
}

impl Shape<'_> {
    fn is_finite(&self) -> bool {
        match self {
            Self::Sphere { center, radius } => {
                center.is_finite() && radius.is_finite() && *radius >= 0.0
            }
            Self::Capsule { from, to, radius } => {
                from.is_finite() && to.is_finite() && radius.is_finite() && *radius >= 0.0
            }
            Self::Grid(_) => true,
            Self::Form { share, size, .. } => {
                (0.0..=1.0).contains(share) && size.is_finite() && *size > 0.0
            }
        }
    }

    /// Whether it is known by distances on a grid, which aren't exact.
    pub(crate) fn is_sampled(&self) -> bool {
        matches!(self, Self::Grid(_) | Self::Form { .. })
    }

    /// Distance from the surface in m, negative inside; never more than the true one by more than a grid's error.
    #[inline]
    pub(crate) fn distance(&self, at: DVec3) -> f64 {
        match self {
            Self::Sphere { center, radius } => (at - *center).length() - radius,
            Self::Capsule { from, to, radius } => {
                (at - nearest_on_line(*from, *to, at)).length() - radius
            }
            Self::Grid(grid) => grid.distance(at),
            Self::Form {
                from,
                to,
                share,
                size,
            } => {
                let at = at / *size;
                size * mix(|form| form.distance(at), [from, to], *share)
            }
        }
    }

    /// Centre and radius of a ball around it.
    pub(crate) fn ball(&self) -> (DVec3, f64) {
        match self {
            Self::Sphere { center, radius } => (*center, *radius),
            Self::Capsule { from, to, radius } => {
                ((*from + *to) * 0.5, radius + 0.5 * (*to - *from).length())
            }
            Self::Grid(grid) => grid.ball(),
            Self::Form { from, to, size, .. } => {
                let [(center, radius), (other, other_radius)] = [from, to].map(|grid| grid.ball());
                let radius = radius.max(center.distance(other) + other_radius);
                (center * *size, radius * size)
            }
        }
    }

    /// Numbers that tell it from other shapes.
    pub(crate) fn numbers(&self) -> [DVec3; 3] {
        match self {
            Self::Sphere { center, radius } => [*center, DVec3::splat(*radius), DVec3::ZERO],
            Self::Capsule { from, to, radius } => [*from, *to, DVec3::splat(*radius)],
            Self::Grid(grid) => grid.numbers(),
            Self::Form {
                from,
                to,
                share,
                size,
            } => {
                let [from, to] = [from, to].map(|grid| grid.numbers());
                [
                    from[0] + to[0] * 3.0,
                    from[2] + to[2] * 3.0,
                    DVec3::new(*share, *size, 2.0),
                ]
            }
        }
    }

    /// The direction away from the surface, a unit vector.
    pub(crate) fn normal(&self, at: DVec3) -> DVec3 {
        let away = match self {
            Self::Sphere { center, .. } => at - *center,
            Self::Capsule { from, to, .. } => at - nearest_on_line(*from, *to, at),
            Self::Grid(grid) => grid.gradient(at),
            Self::Form {
                from,
                to,
                share,
                size,
            } => {
                let at = at / *size;
                mix(|form| form.gradient(at), [from, to], *share)
            }
        };
        away.normalize_or(DVec3::Y)
    }
}

/// What `of` says of two forms, mixed.
fn mix<T>(of: impl Fn(&SignedDistance) -> T, forms: [&SignedDistance; 2], share: f64) -> T
where
    T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
{
    match share {
        0.0 => of(forms[0]),
        1.0 => of(forms[1]),
        _ => of(forms[0]) * (1.0 - share) + of(forms[1]) * share,
    }
}

fn nearest_on_line(from: DVec3, to: DVec3, at: DVec3) -> DVec3 {
    let along = to - from;
    let squared = along.length_squared();
    if squared == 0.0 {
        return from;
    }
    from + along * ((at - from).dot(along) / squared).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision::blocks::blocks;

    #[test]
    fn distances_of_balls_and_capsules() {
        let ball = Shape::Sphere {
            center: DVec3::X,
            radius: 0.5,
        };
        assert!((ball.distance(DVec3::X * 3.0) - 1.5).abs() < 1e-15);
        assert!((ball.distance(DVec3::X) + 0.5).abs() < 1e-15);
        assert_eq!(ball.normal(DVec3::X * 3.0), DVec3::X);
        assert!(ball.normal(DVec3::X).is_normalized());
        let capsule = Shape::Capsule {
            from: DVec3::ZERO,
            to: DVec3::Y,
            radius: 0.1,
        };
        assert!((capsule.distance(DVec3::new(0.3, 0.5, 0.0)) - 0.2).abs() < 1e-15);
        assert!((capsule.distance(DVec3::new(0.0, 1.5, 0.0)) - 0.4).abs() < 1e-15);
    }

    #[test]
    fn a_placed_body_is_as_far_in_single_precision() {
        // A tetrahedron.
        let points = [Vec3::ZERO, Vec3::X * 0.2, Vec3::Y * 0.3, Vec3::Z * 0.2];
        let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let [one, two] = [0.01, 0.02].map(|cell| {
            let grid = SignedDistance::new(&points, &triangles, cell);
            grid.expect("a mesh")
        });
        let (center, radius) = (DVec3::new(0.1, -0.2, 0.05), 0.07);
        let shapes = [
            Shape::Sphere { center, radius },
            Shape::Capsule {
                from: center,
                to: DVec3::X,
                radius,
            },
            Shape::Capsule {
                from: center,
                to: center,
                radius,
            },
            Shape::Grid(&one),
            Shape::Form {
                from: &one,
                to: &two,
                share: 0.3,
                size: 1.1,
            },
        ];
        let pose = Pose {
            rotation: glam::DQuat::from_rotation_z(0.7) * glam::DQuat::from_rotation_x(-2.0),
            translation: DVec3::new(-0.3, 1.4, 0.6),
        };
        for shape in shapes {
            let collider = Collider::fixed(shape, pose);
            let placed = Placed::new(&collider);
            for i in 0..3000 {
                let t = f64::from(i);
                let way = DVec3::new((t * 0.7).sin(), (t * 1.3).cos(), (t * 0.37).sin());
                let at = (pose.translation + way * (0.5 * (t * 0.011).sin())).as_vec3();
                let [single, double] = [
                    f64::from(placed.distance(at)),
                    collider.distance(at.as_dvec3()),
                ];
                assert!(
                    (single - double).abs() < 1e-6,
                    "{shape:?} {at}: {single} {double}"
                );
            }
        }
    }

    #[test]
    fn a_form_changes_by_as_much_as_its_surface_moves() {
        let [small, large] = [0.1, 0.13].map(|side: f32| {
            let (points, triangles) = blocks(&[[Vec3::splat(-side), Vec3::splat(side)]]);
            SignedDistance::new(&points, &triangles, 0.01).expect("a cube")
        });
        let changed = |before, share| {
            let form = |share| Shape::Form {
                from: &small,
                to: &large,
                share,
                size: 1.0,
            };
            let collider = Collider {
                was: Some(form(before)),
                ..Collider::fixed(form(share), Pose::IDENTITY)
            };
            collider.changed()
        };
        assert_eq!(changed(0.4, 0.4), 0.0);
        // Its sides go 3 cm, its corners 5.2.
        let whole = changed(0.0, 1.0);
        assert!((0.03..0.055).contains(&whole), "{whole}");
        assert!((changed(0.7, 0.2) - whole / 2.0).abs() < 1e-9);
    }
}
