//! The exact geometry of a swept stroke: the union of the discs between two joints.
//!
//! Centre and radius run linearly from the *larger* disc (u = 0) to the *smaller* one (u = 1).
//! Everything is worked out in the segment's own frame: the origin at the larger disc's centre, x
//! along the axis, y across it, in pixels. With length L, radii r0 >= r1 and dr = r0 - r1, a point
//! (x, y) lies in the disc at u where
//!
//! `A u^2 + 2 B u + C <= 0`, `A = L^2 - dr^2`, `B = r0 dr - L x`, `C = x^2 + y^2 - r0^2`.
//!
//! The discriminant `B^2 - A C` is `R^2 - A y^2` with `R = L r0 - dr x`: in this form nothing cancels
//! far from the origin. Written in u rather than in arc length, nothing is divided by L, so that
//! strokes that point at the camera (one disc inside the other, down to L = 0) need no formula of
//! their own: then A <= 0, the discs shrink one inside the other, and only the root of `-C / (B +
//! sqrt(D))` is left.
//!
//! A [`Brush::Semicircle`] keeps of each disc the half behind its centre, seen along the path. So the
//! discs that cover a point are those of the interval at whose centres the path has come as far as the
//! point: u >= x / L where the path runs to the smaller disc, u <= x / L where it runs to the larger.
//! The union is still convex: of convex shapes whose place and size run linearly it is the hull of the
//! first and the last.
//!
//! Two names that are easy to mix up: a point's *interval* is all u whose discs cover it; its
//! *attribute point* is the single u where distance over radius is least, which colours it.

use glam::{DVec2, Vec2};
use std::hint::select_unpredictable; // an `if` may become a branch, which vectors don't have

/// Below this length and difference of radii, in pixels, two discs are one.
const SAME: f64 = 1e-6;
/// One disc lies inside the other where the length exceeds the difference of radii by less than
/// this part: by then the body between them is thinner than a rounding error.
const NESTED: f64 = 1e-6;
/// Keeps 0 / 0 from being one; far below every quantity it is added to.
const TINY: f32 = 1e-30;

/// A disc on the screen, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Centre.
    pub center: DVec2,
    /// Radius, 0 or more.
    pub radius: f64,
}

/// What is put down at each point of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Brush {
    /// A disc: strokes end round.
    #[default]
    Circle,
    /// The half of the disc behind its centre: strokes end flat (thesis, Figs 7.1 and 7.2).
    Semicircle,
}

/// The end of a sweep at which half discs leave it flat.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FlatEnd {
    /// Neither: whole discs.
    #[default]
    None,
    /// The smaller: the path runs there.
    Smaller,
    /// The larger: the path runs there.
    Larger,
}

/// The union of the discs between two circles. Positions `u` run from 0 at the larger to 1 at the
/// smaller. The default is a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sweep {
    origin: DVec2,
    axis: DVec2,
    length: f32,
    /// 1 / length, or 0 where the circles are concentric.
    inv_length: f32,
    radius: f32,
    smaller_radius: f32,
    /// `radius - smaller_radius`, 0 or more.
    shrink: f32,
    /// `length^2 - shrink^2`; 0 or less where one disc lies inside the other.
    a: f32,
    /// 1 / a, or the largest number where one disc lies inside the other.
    inv_a: f32,
    /// Arc length of the attribute point where R is not above 0.
    beyond_apex: f32,
    /// Largest -B of the body between the discs: a, or -1 where there is no body.
    body_end: f32,
    flat_end: FlatEnd,
    /// Least and greatest u of discs that cover a point at x, as slope and start.
    from: [f32; 2],
    to: [f32; 2],
}

/// Limits of u that are none.
const FROM_START: [f32; 2] = [0.0, -1.0];
const TO_END: [f32; 2] = [0.0, 2.0];

impl Sweep {
    /// The sweep between two circles with finite numbers of at most about 1e9 pixels, the larger
    /// first. Nothing where both radii are 0: such a stroke covers no area.
    #[must_use]
    pub fn new(larger: Circle, smaller: Circle) -> Option<Self> {
        debug_assert!(larger.radius >= smaller.radius);
        if larger.radius <= 0.0 {
            return None;
        }
        let along = smaller.center - larger.center;
        let mut length = along.length();
        let mut shrink = larger.radius - smaller.radius;
        let mut axis = DVec2::X;
        if length < SAME {
            length = 0.0;
            shrink = if shrink < SAME { 0.0 } else { shrink };
        } else {
            axis = along / length;
        }
        let nested = length - shrink <= NESTED * length;
        let a = (length - shrink) * (length + shrink);
        Some(Self {
            origin: larger.center,
            axis,
            length: length as f32,
            inv_length: if length > 0.0 {
                (1.0 / length) as f32
            } else {
                0.0
            },
            radius: larger.radius as f32,
            smaller_radius: smaller.radius as f32,
            shrink: shrink as f32,
            a: a as f32,
            inv_a: if nested { f32::MAX } else { (1.0 / a) as f32 },
            beyond_apex: if nested { 0.0 } else { length as f32 },
            body_end: if nested { -1.0 } else { a as f32 },
            flat_end: FlatEnd::None,
            from: FROM_START,
            to: TO_END,
        })
    }

    /// The same between half discs, those behind a path that runs to the smaller circle or to the larger.
    /// A sweep without length has no direction, and stays whole.
    #[must_use]
    pub fn with_semicircles(self, runs_to_smaller: bool) -> Self {
        let limit = [self.inv_length, 0.0];
        if self.length <= 0.0 {
            self
        } else if runs_to_smaller {
            Self {
                flat_end: FlatEnd::Smaller,
                from: limit,
                ..self
            }
        } else {
            Self {
                flat_end: FlatEnd::Larger,
                to: limit,
                ..self
            }
        }
    }

    /// Where the sweep ends flat.
    #[inline(always)]
    #[must_use]
    pub fn flat_end(&self) -> FlatEnd {
        self.flat_end
    }

    /// Whether its circles are apart, so that it points somewhere.
    #[inline(always)]
    #[must_use]
    pub fn has_direction(&self) -> bool {
        self.length > 0.0
    }

    /// From the larger circle's centre to the smaller one's.
    #[inline(always)]
    #[must_use]
    pub fn length(&self) -> f32 {
        self.length
    }

    /// The larger circle's.
    #[inline(always)]
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// A screen position in the segment's frame.
    #[must_use]
    pub fn local(&self, position: DVec2) -> DVec2 {
        let from_origin = position - self.origin;
        DVec2::new(from_origin.dot(self.axis), self.axis.perp_dot(from_origin))
    }

    /// The frame's x axis on the screen: a unit vector. The y axis is its [`Vec2::perp`].
    #[must_use]
    pub fn axis(&self) -> Vec2 {
        self.axis.as_vec2()
    }

    /// Whether any disc covers the point (x, y) of the segment's frame; edges belong to the stroke.
    #[inline]
    #[must_use]
    pub fn covers(&self, x: f32, y: f32) -> bool {
        let beyond = x - self.length;
        let in_larger = x * x + y * y <= self.radius * self.radius;
        let in_smaller = beyond * beyond + y * y <= self.smaller_radius * self.smaller_radius;
        // Between the discs, the disc at u = -B / A reaches farthest.
        let to_vertex = self.length * x - self.radius * self.shrink;
        let r = self.length * self.radius - self.shrink * x;
        let in_body = (r * r >= self.a * y * y) & (to_vertex >= 0.0) & (to_vertex <= self.body_end);
        let in_disc = in_larger | in_smaller | in_body;
        match self.flat_end {
            FlatEnd::None => in_disc,
            // A disc farther back reaches as far ahead and is larger.
            FlatEnd::Larger => in_disc & (x >= 0.0),
            // A disc farther on is smaller than the one beside the point.
            FlatEnd::Smaller => {
                let beside = self.radius - self.shrink * (x * self.inv_length);
                let in_trapezoid = (x <= self.length) & (y.abs() <= beside);
                (in_larger & (x <= 0.0)) | (in_trapezoid & (x >= 0.0))
            }
        }
    }

    /// The least and the greatest u in 0..=1 whose discs cover a point that
    /// [is covered](Self::covers). Elsewhere some numbers in 0..=1 without meaning.
    #[inline(always)] // into kernels that are compiled for several instruction sets
    #[must_use]
    pub fn interval(&self, x: f32, y: f32) -> (f32, f32) {
        let b = self.radius * self.shrink - self.length * x;
        let c = x * x + y * y - self.radius * self.radius;
        let r = self.length * self.radius - self.shrink * x;
        let discriminant = r * r - self.a * y * y;
        // The numerically stable roots: q adds two numbers of one sign.
        let q = b.abs() + at_least_zero(discriminant).sqrt() + TINY;
        let by_c = c / q;
        let by_a = q * self.inv_a;
        let low = select_unpredictable(b > 0.0, -by_a, by_c);
        let high = select_unpredictable(b > 0.0, -by_c, by_a);
        let from = x * self.from[0] + self.from[1];
        let to = x * self.to[0] + self.to[1];
        let low = select_unpredictable(low > from, low, from);
        let high = select_unpredictable(high < to, high, to);
        (unit_clamp(low), unit_clamp(high))
    }

    /// The attribute point of (x, y), and the square of its distance over radius there.
    ///
    /// Distance over radius falls and then rises along the axis, least at the arc length
    /// `x - dr y^2 / R` if R > 0; so the clamped value is the least of the segment. R <= 0 lies
    /// beyond the cone's apex: there the ratio only rises from the larger disc on where that holds the
    /// smaller one, and a stroke that ends in a point covers nothing but its tip.
    #[inline(always)]
    #[must_use]
    pub fn attribute_point(&self, x: f32, y: f32) -> (f32, f32) {
        let r = self.length * self.radius - self.shrink * x;
        let along = x - self.shrink * (y * y) / r;
        let along = select_unpredictable(r > 0.0, along, self.beyond_apex);
        let u = unit_clamp(along * self.inv_length);
        let radius = self.radius - self.shrink * u;
        let ahead = x - self.length * u;
        (u, (ahead * ahead + y * y) / (radius * radius + TINY))
    }

    /// The box around the stroke on the screen, as least and greatest corner.
    #[must_use]
    pub fn bounds(&self) -> (DVec2, DVec2) {
        let larger = DVec2::splat(f64::from(self.radius));
        let smaller = DVec2::splat(f64::from(self.smaller_radius));
        let end = self.origin + self.axis * f64::from(self.length);
        (
            (self.origin - larger).min(end - smaller),
            (self.origin + larger).max(end + smaller),
        )
    }

    /// Centre and radius of the larger and of the smaller disc.
    #[must_use]
    pub fn ends(&self) -> [(DVec2, f32); 2] {
        let end = self.origin + self.axis * f64::from(self.length);
        [(self.origin, self.radius), (end, self.smaller_radius)]
    }

    /// The outward unit normals of the two outer tangents, or nothing where one disc lies inside the
    /// other. A tangent touches each disc at its centre plus its radius times the normal.
    #[must_use]
    pub fn tangent_normals(&self) -> Option<[Vec2; 2]> {
        if self.body_end < 0.0 {
            return None;
        }
        let along = self.axis() * (self.shrink * self.inv_length);
        let across = self.axis().perp() * (self.a.sqrt() * self.inv_length);
        Some([along + across, along - across])
    }
}

/// The part `[from, to]` of 0..=1 from `first` (0) to `second` (1) whose discs can touch the box
/// between `min` and `max`, or nothing. The part is a sweep again, so that strokes may reach
/// thousands of pixels outside the screen and still be drawn in single precision.
#[must_use]
pub fn visible_part(first: Circle, second: Circle, min: DVec2, max: DVec2) -> Option<[f64; 2]> {
    let reaches = |c: Circle| {
        let (over, under) = (c.center - min + c.radius, max - c.center + c.radius);
        [over.x, over.y, under.x, under.y]
    };
    let (at_first, at_second) = (reaches(first), reaches(second));
    let least = |reaches: [f64; 4]| {
        reaches
            .into_iter()
            .fold(0.0, |a, b| if b < a { b } else { a })
    };
    if least(at_first) >= 0.0 && least(at_second) >= 0.0 {
        return Some([0.0, 1.0]); // most of them, in a few instructions
    }
    let [mut from, mut to] = [0.0_f64, 1.0];
    for (a, b) in at_first.into_iter().zip(at_second) {
        match (a < 0.0, b < 0.0) {
            (true, true) => return None,
            (true, false) => from = from.max(a / (a - b)),
            (false, true) => to = to.min(a / (a - b)),
            (false, false) => {}
        }
    }
    (from <= to).then_some([from, to])
}

/// Also 0 for NaN.
#[inline(always)]
fn at_least_zero(value: f32) -> f32 {
    select_unpredictable(value > 0.0, value, 0.0)
}

#[inline(always)]
fn unit_clamp(value: f32) -> f32 {
    let value = at_least_zero(value);
    select_unpredictable(value < 1.0, value, 1.0)
}

#[cfg(test)]
mod tests;
