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
/// smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
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
mod tests {
    use super::*;
    use proptest::prelude::*;

    const STAMPS: usize = 4000;

    fn circle(x: f64, y: f64, radius: f64) -> Circle {
        Circle {
            center: DVec2::new(x, y),
            radius,
        }
    }

    fn lerp(a: Circle, b: Circle, u: f64) -> Circle {
        Circle {
            center: a.center.lerp(b.center, u),
            radius: a.radius + u * (b.radius - a.radius),
        }
    }

    /// What 4001 stamped discs say of a point: the least of (distance less radius), the covered
    /// interval, and the attribute point with its ratio.
    struct Stamped {
        gap: f64,
        interval: Option<(f64, f64)>,
        nearest: (f64, f64),
    }

    fn stamp(a: Circle, b: Circle, p: DVec2) -> Stamped {
        let mut stamped = Stamped {
            gap: f64::INFINITY,
            interval: None,
            nearest: (0.0, f64::INFINITY),
        };
        for i in 0..=STAMPS {
            let u = i as f64 / STAMPS as f64;
            let disc = lerp(a, b, u);
            let distance = disc.center.distance(p);
            stamped.gap = stamped.gap.min(distance - disc.radius);
            if distance <= disc.radius {
                let from = stamped.interval.map_or(u, |(from, _)| from);
                stamped.interval = Some((from, u));
            }
            let ratio = distance / disc.radius.max(1e-9);
            if ratio < stamped.nearest.1 {
                stamped.nearest = (u, ratio);
            }
        }
        stamped
    }

    /// Half discs: where the point is well within a stamp or well outside of all the answer is known.
    fn check_half(
        a: Circle,
        b: Circle,
        p: DVec2,
        runs_to_smaller: bool,
    ) -> Result<(), TestCaseError> {
        let sweep = Sweep::new(a, b).unwrap().with_semicircles(runs_to_smaller);
        let local = sweep.local(p).as_vec2();
        let way =
            (b.center - a.center).normalize_or_zero() * if runs_to_smaller { 1.0 } else { -1.0 };
        // For each half disc how far outside of it the point is.
        let stamps = (0..=STAMPS).map(|i| {
            let disc = lerp(a, b, i as f64 / STAMPS as f64);
            let from_center = p - disc.center;
            let outside = (from_center.length() - disc.radius).max(from_center.dot(way));
            (i as f64 / STAMPS as f64, outside)
        });
        let stamps: Vec<(f64, f64)> = stamps.collect();
        let gap = stamps.iter().map(|s| s.1).fold(f64::INFINITY, f64::min);
        let length = a.center.distance(b.center);
        let slack = 2e-6 * (1.0 + a.radius + length) + 2.0 * length / STAMPS as f64;
        let covers = sweep.covers(local.x, local.y);
        prop_assert!(covers || gap > -slack, "not covered, gap {gap}");
        prop_assert!(!covers || gap < slack, "covered, gap {gap}");
        if covers && gap < -slack {
            let (low, high) = sweep.interval(local.x, local.y);
            let covering: Vec<f64> = stamps.iter().filter(|s| s.1 <= 0.0).map(|s| s.0).collect();
            for (ours, stamped) in [(low, covering[0]), (high, covering[covering.len() - 1])] {
                let ours = f64::from(ours);
                let disc = lerp(a, b, ours);
                let from_center = p - disc.center;
                let outside = (from_center.length() - disc.radius).max(from_center.dot(way));
                let near = (ours - stamped).abs() < 2.0 / STAMPS as f64;
                prop_assert!(
                    near || outside.abs() < slack,
                    "ends {low} {high}, {outside}"
                );
            }
        }
        Ok(())
    }

    fn check(a: Circle, b: Circle, p: DVec2) -> Result<(), TestCaseError> {
        let sweep = Sweep::new(a, b).unwrap();
        let local = sweep.local(p).as_vec2();
        let stamped = stamp(a, b, p);
        let scale = 1.0 + a.radius + a.center.distance(b.center);
        // Stamps leave scallops between them, and single precision rounds.
        let step = a.center.distance(b.center) / STAMPS as f64;
        let slack = 2e-6 * scale + step;
        let covers = sweep.covers(local.x, local.y);
        if stamped.gap < -slack {
            prop_assert!(covers, "not covered, gap {}", stamped.gap);
        }
        if stamped.gap > slack {
            prop_assert!(!covers, "covered, gap {}", stamped.gap);
        }
        if let Some((from, to)) = stamped.interval.filter(|_| covers) {
            let (low, high) = sweep.interval(local.x, local.y);
            prop_assert!((0.0..=1.0).contains(&low) && (0.0..=1.0).contains(&high));
            // An end's error is judged by how far outside its disc the point is: u itself is not
            // well-defined where the discs' edges graze the point.
            for (ours, stamped) in [(low, from), (high, to)] {
                let near = (f64::from(ours) - stamped).abs() < 2.0 / STAMPS as f64;
                let disc = lerp(a, b, f64::from(ours));
                let gap = (disc.center.distance(p) - disc.radius).abs();
                prop_assert!(
                    near || gap < slack,
                    "ends {low} {high}, stamped {from} {to}, gap {gap}"
                );
            }
            let (u, ratio) = sweep.attribute_point(local.x, local.y);
            let ratio = f64::from(ratio).sqrt();
            let (stamped_u, least) = stamped.nearest;
            prop_assert!(
                (u as f64 - stamped_u).abs() < 2e-3 || ratio <= least + 1e-4,
                "attribute {u} {ratio}, stamped {stamped_u} {least}"
            );
            prop_assert!((ratio - least).abs() < 2e-3 + slack / a.radius);
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn agrees_with_stamped_discs(
            (x, y) in (-50.0..50.0, -50.0..50.0),
            (dx, dy) in (-20.0..20.0, -20.0..20.0),
            r0 in 0.2..12.0_f64,
            part in 0.0..=1.0_f64,
            (px, py) in (-1.5..1.5, -1.5..1.5),
            along in -0.2..1.2_f64,
        ) {
            let a = circle(x, y, r0);
            let b = circle(x + dx, y + dy, r0 * part);
            // A point near the stroke, so that most cases test something.
            let p = a.center.lerp(b.center, along) + DVec2::new(px, py) * r0;
            check(a, b, p)?;
            if a.center.distance(b.center) > 0.01 {
                check_half(a, b, p, true)?;
                check_half(a, b, p, false)?;
            }
        }

        #[test]
        fn agrees_where_one_disc_nearly_holds_the_other(
            r0 in 0.5..12.0_f64,
            part in 0.0..1.0_f64,
            excess in prop_oneof![Just(0.0), -1e-5..1e-5, -1e-2..1e-2],
            angle in 0.0..std::f64::consts::TAU,
            (px, py) in (-1.1..1.1, -1.1..1.1),
        ) {
            let shrink = r0 * (1.0 - part);
            let length = (shrink * (1.0 + excess)).max(0.0);
            let a = circle(3.0, 4.0, r0);
            let b = Circle {
                center: a.center + DVec2::from_angle(angle) * length,
                radius: r0 * part,
            };
            check(a, b, a.center + DVec2::new(px, py) * r0)?;
        }

        #[test]
        fn holds_its_points(
            (dx, dy) in (-20.0..20.0, -20.0..20.0),
            r0 in 0.1..12.0_f64,
            part in 0.0..=1.0_f64,
            (px, py) in (-40.0..40.0, -40.0..40.0),
        ) {
            let (a, b) = (circle(1.0, 2.0, r0), circle(1.0 + dx, 2.0 + dy, r0 * part));
            let sweep = Sweep::new(a, b).unwrap();
            let p = DVec2::new(px, py);
            let local = sweep.local(p).as_vec2();
            if sweep.covers(local.x, local.y) {
                let (min, max) = sweep.bounds();
                prop_assert!(p.cmpge(min - 1e-4).all() && p.cmple(max + 1e-4).all());
                for normal in sweep.tangent_normals().into_iter().flatten() {
                    let [(center, radius), _] = sweep.ends();
                    let ahead = normal.as_dvec2().dot(p - center);
                    prop_assert!(ahead <= f64::from(radius) + 1e-4);
                }
            }
        }

        #[test]
        fn what_is_clipped_away_is_not_visible(
            (x0, y0, x1, y1) in (-100.0..100.0, -100.0..100.0, -100.0..100.0, -100.0..100.0),
            (r0, r1) in (0.0..30.0_f64, 0.0..30.0_f64),
        ) {
            let (a, b) = (circle(x0, y0, r0), circle(x1, y1, r1));
            let (min, max) = (DVec2::ZERO, DVec2::splat(20.0));
            let part = visible_part(a, b, min, max);
            for i in 0..=200 {
                let u = f64::from(i) / 200.0;
                let disc = lerp(a, b, u);
                let touches = disc.center.clamp(min, max).distance(disc.center) <= disc.radius;
                let kept = part.is_some_and(|[from, to]| from - 1e-9 <= u && u <= to + 1e-9);
                prop_assert!(kept || !touches, "disc at {u} lost from {part:?}");
            }
        }
    }

    #[test]
    fn clips_the_far_part_away() {
        let part = visible_part(
            circle(-1e6, 5.0, 1.0),
            circle(1e6, 5.0, 1.0),
            DVec2::ZERO,
            DVec2::splat(10.0),
        );
        let [from, to] = part.unwrap();
        assert!((from * 2e6 - 1e6 + 1.0).abs() < 1e-6 && (to * 2e6 - 1e6 - 11.0).abs() < 1e-6);
    }

    #[test]
    fn half_discs_end_flat_at_the_end_of_the_path() {
        let (large, small) = (circle(0.0, 0.0, 4.0), circle(8.0, 0.0, 2.0));
        let sweep = Sweep::new(large, small).unwrap();
        let on = sweep.with_semicircles(true);
        assert_eq!(on.flat_end(), FlatEnd::Smaller);
        // Round behind the larger, a trapezoid between both, nothing ahead of the smaller.
        assert!(on.covers(-3.9, 0.0) && on.covers(4.0, 2.99) && on.covers(8.0, 1.99));
        assert!(!on.covers(8.01, 0.0) && !on.covers(4.0, 3.01));
        let back = sweep.with_semicircles(false);
        assert_eq!(back.flat_end(), FlatEnd::Larger);
        assert!(!back.covers(-0.01, 0.0) && back.covers(0.0, 3.99) && back.covers(9.9, 0.0));
        // At (4, 0) whole discs of 0.0 to 0.8 cover; half of them lies behind the centre of one.
        let (low, high) = sweep.interval(4.0, 0.0);
        assert_eq!(
            (on.interval(4.0, 0.0), back.interval(4.0, 0.0)),
            ((0.5, high), (low, 0.5))
        );
        // Without a direction there are no halves.
        let point = Sweep::new(large, large).unwrap().with_semicircles(true);
        assert_eq!(point.flat_end(), FlatEnd::None);
    }

    #[test]
    fn radius_zero_covers_nothing() {
        assert_eq!(
            Sweep::new(circle(0.0, 0.0, 0.0), circle(9.0, 0.0, 0.0)),
            None
        );
    }

    #[test]
    fn a_tip_of_radius_zero_is_a_point() {
        let sweep = Sweep::new(circle(0.0, 0.0, 2.0), circle(10.0, 0.0, 0.0)).unwrap();
        assert!(sweep.covers(9.9, 0.01) && !sweep.covers(10.01, 0.0));
        assert_eq!(sweep.interval(10.0, 0.0), (1.0, 1.0));
        assert_eq!(sweep.attribute_point(10.0, 0.0).0, 1.0);
    }

    #[test]
    fn equal_discs_without_length_cover_for_all_u() {
        let sweep = Sweep::new(circle(0.0, 0.0, 2.0), circle(0.0, 0.0, 2.0)).unwrap();
        for (x, y) in [(0.0, 0.0), (1.0, -1.0), (2.0, 0.0)] {
            assert!(sweep.covers(x, y));
            assert_eq!(sweep.interval(x, y), (0.0, 1.0));
        }
        assert!(!sweep.covers(2.001, 0.0) && !sweep.covers(0.0, 7.0));
    }

    #[test]
    fn concentric_discs_cover_to_their_radius() {
        let sweep = Sweep::new(circle(0.0, 0.0, 4.0), circle(0.0, 0.0, 2.0)).unwrap();
        assert_eq!(sweep.interval(0.0, 3.0), (0.0, 0.5));
        assert_eq!(sweep.interval(1.0, 0.0), (0.0, 1.0));
        assert_eq!(sweep.attribute_point(3.0, 0.0), (0.0, 0.5625));
    }
}
