//! The union of the discs between two joints: coverage, nearest depth, nearest axis point.

use glam::DVec2;
use render::{Brush, Disc};

/// The larger is nearer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depth {
    /// 1 / view depth (1/m), the order among strands.
    pub inv_depth: f64,
    /// 1 / biased view depth (1/m), the order against surfaces.
    pub biased: f64,
}

impl Depth {
    /// Both as many metres farther away.
    pub fn deeper(self, metres: f64) -> Self {
        let deeper = |inv_depth: f64| inv_depth / (1.0 + metres * inv_depth.max(0.0));
        Self {
            inv_depth: deeper(self.inv_depth),
            biased: deeper(self.biased),
        }
    }

    /// The nearer of both, each for itself.
    pub fn nearest(self, other: Self) -> Self {
        Self {
            inv_depth: self.inv_depth.max(other.inv_depth),
            biased: self.biased.max(other.biased),
        }
    }
}

/// The disc and colour at one joint.
#[derive(Clone, Copy, Debug)]
struct ColoredDisc {
    center: DVec2,
    radius: f64,
    depth: Depth,
    color: [f64; 3],
}

impl ColoredDisc {
    fn new(disc: &Disc, color: [f32; 3]) -> Self {
        Self {
            center: disc.center.as_dvec2(),
            radius: disc.radius.into(),
            depth: Depth {
                inv_depth: disc.inv_depth.into(),
                biased: disc.inv_depth_biased.into(),
            },
            color: color.map(f64::from),
        }
    }

    /// Whether the disc covers `point`, its border included. A radius of 0 covers nothing.
    fn covers(&self, point: DVec2) -> bool {
        self.radius > 0.0 && point.distance(self.center) <= self.radius
    }
}

/// The discs from one joint (t = 0) to the next (t = 1), everything linear in t.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    from: ColoredDisc,
    to: ColoredDisc,
    brush: Brush,
    /// The joints of the drawing that it runs between.
    pub joints: [usize; 2],
}

impl Segment {
    /// From one disc to the next. The same disc twice is that disc alone, whatever the brush: half a
    /// disc needs a direction.
    pub fn new(discs: [&Disc; 2], colors: [[f32; 3]; 2], joints: [usize; 2], brush: Brush) -> Self {
        let is_somewhere_else = discs[0].center != discs[1].center;
        Self {
            from: ColoredDisc::new(discs[0], colors[0]),
            to: ColoredDisc::new(discs[1], colors[1]),
            brush: if is_somewhere_else {
                brush
            } else {
                Brush::Circle
            },
            joints,
        }
    }

    /// Whether a disc may touch the box from `min` to `max`. The sweep lies in the convex hull of
    /// the discs at its ends, and so in the box around both.
    pub fn touches(&self, min: DVec2, max: DVec2) -> bool {
        let Self { from, to, .. } = self;
        let lower = (from.center - from.radius).min(to.center - to.radius);
        let upper = (from.center + from.radius).max(to.center + to.radius);
        lower.cmple(max).all() && upper.cmpge(min).all()
    }

    /// The nearest depth of the discs that cover `point`, or nothing where none does.
    ///
    /// Depth is linear in t, so over each interval of discs that cover the point it is largest at
    /// an end: at an end of the segment, or where the point lies on a disc's border. Of half discs also
    /// where it lies on the straight border, which is where its foot on the axis is.
    pub fn depth(&self, point: DVec2) -> Option<Depth> {
        let ends = [(0.0, self.from), (1.0, self.to)]
            .into_iter()
            .filter_map(|(t, end)| end.covers(point).then_some(t));
        let foot = self.foot(point).filter(|&t| 0.0 < t && t < 1.0);
        let beside = foot.filter(|&t| self.disc(t).covers(point));
        ends.chain(self.border_crossings(point))
            .filter(|&t| foot_is_behind(self.foot(point), t))
            .chain(beside)
            .map(|t| Depth {
                inv_depth: mix(self.from.depth.inv_depth, self.to.depth.inv_depth, t),
                biased: mix(self.from.depth.biased, self.to.depth.biased, t),
            })
            .reduce(Depth::nearest)
    }

    /// Of half discs: the t of the point's foot on the axis. Discs from there on have the point behind
    /// them.
    fn foot(&self, point: DVec2) -> Option<f64> {
        let (p, d, ..) = self.relative_to_start(point);
        (self.brush == Brush::Semicircle).then(|| p.dot(d) / d.length_squared())
    }

    fn disc(&self, t: f64) -> ColoredDisc {
        ColoredDisc {
            center: self.from.center.lerp(self.to.center, t),
            radius: mix(self.from.radius, self.to.radius, t),
            ..self.from
        }
    }

    /// Each t inside (0, 1) whose disc has `point` on its border.
    ///
    /// With p from the first centre to the point, d from the first centre to the second and e the
    /// radius' growth, |p - t d|^2 = (r + t e)^2 is a t^2 - 2 b t + c = 0. Its discriminant
    /// b^2 - a c, multiplied out, is |r d + e p|^2 - (d x p)^2: in that form large terms do not
    /// cancel where the joints lie far outside the screen.
    fn border_crossings(&self, point: DVec2) -> impl Iterator<Item = f64> {
        let (p, d, r, e) = self.relative_to_start(point);
        let a = d.length_squared() - e * e;
        let b = d.dot(p) + r * e;
        let c = p.length_squared() - r * r;
        let discriminant = (r * d + e * p).length_squared() - d.perp_dot(p).powi(2);
        let larger = b + discriminant.sqrt().copysign(b); // NaN, and so no crossing, without a root
        [larger / a, c / larger]
            .into_iter()
            .filter(move |t| 0.0 < *t && *t < 1.0 && r + t * e > 0.0)
    }

    /// The least distance from `point` to an axis point over the radius there, and its t. Infinite
    /// where every radius is 0.
    ///
    /// With p, d, r, e as above, the derivative of |p - t d|^2 / (r + t e)^2 has the sign of
    /// t d.k - p.k with k = r d + e p. So the least is at t = p.k / d.k or at an end.
    pub fn nearest_axis_point(&self, point: DVec2) -> (f64, f64) {
        let (p, d, r, e) = self.relative_to_start(point);
        let k = r * d + e * p;
        let inner = p.dot(k) / d.dot(k);
        let inner = (0.0 < inner && inner < 1.0).then_some(inner);
        [Some(0.0), inner, Some(1.0)]
            .into_iter()
            .flatten()
            .map(|t| {
                let radius = mix(self.from.radius, self.to.radius, t);
                let distance = point.distance(self.from.center.lerp(self.to.center, t));
                (
                    if radius > 0.0 {
                        distance / radius
                    } else {
                        f64::INFINITY
                    },
                    t,
                )
            })
            .reduce(|best, next| if next.0 < best.0 { next } else { best })
            .unwrap_or((f64::INFINITY, 0.0))
    }

    /// 1 / view depth (1/m) of the axis at `t`.
    pub fn inv_depth(&self, t: f64) -> f64 {
        mix(self.from.depth.inv_depth, self.to.depth.inv_depth, t)
    }

    /// Which side of the axis `point` lies on: 1 to the right of who walks along the segment, on a screen whose y points down, or on
    /// the axis; else -1.
    pub fn side(&self, point: DVec2) -> f64 {
        let (p, d, ..) = self.relative_to_start(point);
        let d = if d == DVec2::ZERO { DVec2::X } else { d };
        if d.perp_dot(p) < 0.0 { -1.0 } else { 1.0 }
    }

    /// The colour of the axis at `t`.
    pub fn color(&self, t: f64) -> [f64; 3] {
        std::array::from_fn(|i| mix(self.from.color[i], self.to.color[i], t))
    }

    /// From the first centre to `point` and to the second centre, the first radius and its growth.
    fn relative_to_start(&self, point: DVec2) -> (DVec2, DVec2, f64, f64) {
        let Self { from, to, .. } = self;
        (
            point - from.center,
            to.center - from.center,
            from.radius,
            to.radius - from.radius,
        )
    }
}

fn foot_is_behind(foot: Option<f64>, t: f64) -> bool {
    foot.is_none_or(|foot| foot <= t)
}

/// From `from` at t = 0 to `to` at t = 1; exact where both are equal.
fn mix(from: f64, to: f64, t: f64) -> f64 {
    from + t * (to - from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;
    use proptest::prelude::*;

    const STEPS: u32 = 4000;

    fn disc(x: f32, y: f32, radius: f32, inv_depth: f32) -> Disc {
        Disc {
            center: Vec2::new(x, y),
            radius,
            inv_depth,
            inv_depth_biased: 2.0 * inv_depth,
        }
    }

    fn segment(from: Disc, to: Disc) -> Segment {
        Segment::new(
            [&from, &to],
            [[0.0; 3], [1.0, 2.0, 4.0]],
            [0, 1],
            Brush::Circle,
        )
    }

    fn half(segment: Segment) -> Segment {
        let is_point = segment.from.center == segment.to.center;
        let brush = if is_point {
            Brush::Circle
        } else {
            Brush::Semicircle
        };
        Segment { brush, ..segment }
    }

    fn inv_depth(segment: &Segment, x: f64, y: f64) -> Option<f64> {
        segment.depth(DVec2::new(x, y)).map(|depth| depth.inv_depth)
    }

    #[test]
    fn capsule_depth_is_at_the_near_end_of_the_covering_interval() {
        // Discs of radius 5 from x = 0 to 100: (x, 3) is covered by the discs at x - 4 to x + 4.
        let rising = segment(disc(0.0, 0.0, 5.0, 1.0), disc(100.0, 0.0, 5.0, 2.0));
        let falling = segment(disc(0.0, 0.0, 5.0, 2.0), disc(100.0, 0.0, 5.0, 1.0));
        assert!((inv_depth(&rising, 50.0, 3.0).unwrap() - 1.54).abs() < 1e-12);
        assert!((inv_depth(&falling, 50.0, 3.0).unwrap() - 1.54).abs() < 1e-12);
        assert_eq!(inv_depth(&rising, 98.0, 3.0), Some(2.0));
        assert_eq!(inv_depth(&rising, 50.0, 5.001), None);
        assert_eq!(inv_depth(&rising, 104.9, 0.0), Some(2.0));
        assert_eq!(inv_depth(&rising, 105.1, 0.0), None);
    }

    #[test]
    fn half_discs_end_flat_and_are_no_nearer_than_their_foot() {
        // Discs of radius 5 from x = 0 to 100: (x, 3) is covered by the half discs at x to x + 4.
        let rising = half(segment(
            disc(0.0, 0.0, 5.0, 1.0),
            disc(100.0, 0.0, 5.0, 2.0),
        ));
        let falling = half(segment(
            disc(0.0, 0.0, 5.0, 2.0),
            disc(100.0, 0.0, 5.0, 1.0),
        ));
        assert!((inv_depth(&rising, 50.0, 3.0).unwrap() - 1.54).abs() < 1e-12);
        assert!((inv_depth(&falling, 50.0, 3.0).unwrap() - 1.5).abs() < 1e-12);
        assert_eq!(inv_depth(&rising, 100.001, 0.0), None);
        assert_eq!(inv_depth(&rising, 100.0, 4.9), Some(2.0));
        assert_eq!(inv_depth(&falling, -4.9, 0.0), Some(2.0));
        assert_eq!(inv_depth(&falling, -5.1, 0.0), None);
    }

    #[test]
    fn half_discs_taper_as_a_trapezoid() {
        let taper = half(segment(disc(0.0, 0.0, 10.0, 1.0), disc(8.0, 0.0, 2.0, 1.0)));
        assert_eq!(inv_depth(&taper, 4.0, 6.001), None);
        assert!(inv_depth(&taper, 4.0, 5.999).is_some());
        assert!(inv_depth(&taper, 7.999, 1.9).is_some());
        assert!(inv_depth(&taper, -6.0, 7.9).is_some());
    }

    #[test]
    fn both_depths_are_the_largest_each_for_itself() {
        let from = Disc {
            inv_depth_biased: 9.0,
            ..disc(0.0, 0.0, 5.0, 1.0)
        };
        let to = Disc {
            inv_depth_biased: 8.0,
            ..disc(100.0, 0.0, 5.0, 2.0)
        };
        let depth = segment(from, to).depth(DVec2::new(50.0, 3.0)).unwrap();
        assert!((depth.inv_depth - 1.54).abs() < 1e-12);
        assert!((depth.biased - 8.54).abs() < 1e-12);
    }

    #[test]
    fn nested_discs_are_the_larger_one() {
        // The discs grow about one centre: a point at distance 5 is covered from radius 5 on.
        let toward = segment(disc(7.0, 7.0, 2.0, 1.0), disc(7.0, 7.0, 8.0, 2.0));
        let away = segment(disc(7.0, 7.0, 2.0, 2.0), disc(7.0, 7.0, 8.0, 1.0));
        assert_eq!(inv_depth(&toward, 12.0, 7.0), Some(2.0));
        assert!((inv_depth(&away, 12.0, 7.0).unwrap() - 1.5).abs() < 1e-12);
        assert_eq!(inv_depth(&away, 7.0, 7.0), Some(2.0));
        assert_eq!(inv_depth(&away, 15.5, 7.0), None);
    }

    #[test]
    fn discs_that_touch_from_inside_meet_the_linear_equation() {
        // |d| = |e|: the covering condition is linear in t. All discs touch x = 0 from the right.
        let sweep = segment(disc(1.0, 0.0, 1.0, 2.0), disc(5.0, 0.0, 5.0, 1.0));
        // (x - r)^2 = r^2 - y^2 at (2, 1): r = 5/4, t = 1/16.
        assert!((inv_depth(&sweep, 2.0, 1.0).unwrap() - (2.0 - 0.0625)).abs() < 1e-12);
        assert_eq!(inv_depth(&sweep, -0.001, 0.0), None);
    }

    #[test]
    fn radius_zero_covers_nothing() {
        let thread = segment(disc(0.0, 0.0, 0.0, 1.0), disc(10.0, 0.0, 0.0, 1.0));
        for x in [0.0, 2.5, 5.0, 10.0] {
            assert_eq!(inv_depth(&thread, x, 0.0), None);
        }
        let point = segment(disc(3.0, 3.0, 0.0, 1.0), disc(3.0, 3.0, 0.0, 1.0));
        assert_eq!(inv_depth(&point, 3.0, 3.0), None);
    }

    #[test]
    fn taper_takes_its_colour_along_the_perpendicular_of_the_ray_from_its_tip() {
        // Scaled cones with a common tip: the disc that touches the cone through q has its centre
        // where the perpendicular to the ray from tip to q, raised at q, meets the axis.
        let taper = segment(disc(0.0, 0.0, 10.0, 1.0), disc(40.0, 0.0, 0.0, 1.0));
        let tip = DVec2::new(40.0, 0.0);
        for point in [
            DVec2::new(10.0, 4.0),
            DVec2::new(30.0, -1.0),
            DVec2::new(2.0, 7.5),
        ] {
            let from_tip = tip - point;
            let axis = tip.x - from_tip.length_squared() / from_tip.x;
            let (_, t) = taper.nearest_axis_point(point);
            assert!((t - axis / 40.0).abs() < 1e-12, "{t} at {point}");
        }
    }

    #[test]
    fn capsule_takes_its_colour_by_projection() {
        let capsule = segment(disc(10.0, 10.0, 3.0, 1.0), disc(10.0, 50.0, 3.0, 1.0));
        let (ratio, t) = capsule.nearest_axis_point(DVec2::new(11.5, 20.0));
        assert_eq!((ratio, t), (0.5, 0.25));
        assert_eq!(capsule.color(t), [0.25, 0.5, 1.0]);
        assert_eq!(
            capsule.nearest_axis_point(DVec2::new(10.0, 53.0)),
            (1.0, 1.0)
        );
    }

    /// [`stamps`] of a half brush: those whose discs have `q` behind them.
    fn half_stamps(s: &Segment, q: DVec2) -> impl Iterator<Item = (f64, f64, f64)> {
        let along = s.to.center - s.from.center;
        stamps(s, q).filter(move |(t, ..)| {
            let center = s.from.center * (1.0 - t) + s.to.center * *t;
            along.dot(q - center) <= 0.0
        })
    }

    /// Segments of every kind: nested, touching, tapering, zero long, zero wide, far away.
    fn any_segment() -> impl Strategy<Value = Segment> {
        let radius = || prop_oneof![1 => Just(0.0f32), 4 => 0.0..20.0f32, 1 => 0.0..0.3f32];
        let offset = prop_oneof![
            1 => Just([0.0, 0.0]),
            2 => prop::array::uniform2(-3.0..3.0f32),
            4 => prop::array::uniform2(-60.0..60.0f32),
            1 => prop::array::uniform2(-3e4..3e4f32),
        ];
        let start = prop::array::uniform2(-20.0..20.0f32);
        (start, offset, radius(), radius(), 0.1..3.0f32, 0.1..3.0f32).prop_map(
            |([x, y], [dx, dy], r0, r1, z0, z1)| {
                segment(disc(x, y, r0, z0), disc(x + dx, y + dy, r1, z1))
            },
        )
    }

    /// The discs at many t: t, |q - c(t)| and r(t).
    fn stamps(s: &Segment, q: DVec2) -> impl Iterator<Item = (f64, f64, f64)> {
        (0..=STEPS).map(move |i| {
            let t = f64::from(i) / f64::from(STEPS);
            let center = s.from.center * (1.0 - t) + s.to.center * t;
            (
                t,
                q.distance(center),
                s.from.radius * (1.0 - t) + s.to.radius * t,
            )
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn depth_is_that_of_many_stamped_discs(s in any_segment(), x in -30.0..30.0f64, y in -30.0..30.0f64) {
            let q = DVec2::new(x, y);
            let step = 1.0 / f64::from(STEPS);
            let slope = (s.to.depth.inv_depth - s.from.depth.inv_depth).abs();
            let stamped = stamps(&s, q)
                .filter(|(_, distance, radius)| *radius > 0.0 && distance <= radius)
                .map(|(t, ..)| s.from.depth.inv_depth * (1.0 - t) + s.to.depth.inv_depth * t)
                .reduce(f64::max);
            match (s.depth(q), stamped) {
                (None, None) => {}
                (Some(exact), Some(stamped)) => {
                    // The covering discs are one interval, whose end is within a step of a stamp.
                    prop_assert!(exact.inv_depth >= stamped - 1e-9);
                    prop_assert!(exact.inv_depth <= stamped + slope * step + 1e-9);
                    prop_assert!((exact.biased - 2.0 * exact.inv_depth).abs() < 1e-9);
                }
                (Some(_), None) => {
                    // Only discs between two stamps cover the point: it lies very near the border.
                    let gap = stamps(&s, q).map(|(_, distance, radius)| distance - radius);
                    let reach = (s.to.center - s.from.center).length() + (s.to.radius - s.from.radius).abs();
                    prop_assert!(gap.fold(f64::INFINITY, f64::min) <= reach * step);
                }
                (None, Some(_)) => prop_assert!(false, "a stamp covers the point"),
            }
        }

        #[test]
        fn half_discs_are_many_stamped_ones(s in any_segment(), x in -30.0..30.0f64, y in -30.0..30.0f64) {
            let (s, q) = (half(s), DVec2::new(x, y));
            let step = 1.0 / f64::from(STEPS);
            let slope = (s.to.depth.inv_depth - s.from.depth.inv_depth).abs();
            let reach = (s.to.center - s.from.center).length() + (s.to.radius - s.from.radius).abs();
            let covers = |gap: f64| {
                half_stamps(&s, q)
                    .filter(move |(_, distance, radius)| *radius > 0.0 && distance <= &(radius + gap))
                    .map(|(t, ..)| s.from.depth.inv_depth * (1.0 - t) + s.to.depth.inv_depth * t)
                    .reduce(f64::max)
            };
            match (s.depth(q), covers(0.0)) {
                (None, stamped) => prop_assert!(stamped.is_none(), "a stamp covers the point"),
                (Some(exact), Some(stamped)) => {
                    prop_assert!(exact.inv_depth >= stamped - 1e-9);
                    prop_assert!(exact.inv_depth <= stamped + slope * step + 1e-9);
                }
                // Between two stamps, or between the last stamp and the flat end.
                (Some(_), None) => {
                    let along = (s.to.center - s.from.center).normalize();
                    let is_near = covers(2.0 * reach * step).is_some();
                    prop_assert!(is_near || (q - s.to.center).dot(along) <= 1e-9);
                }
            }
        }

        #[test]
        fn no_stamp_has_a_smaller_ratio(s in any_segment(), x in -30.0..30.0f64, y in -30.0..30.0f64) {
            let q = DVec2::new(x, y);
            let (ratio, t) = s.nearest_axis_point(q);
            prop_assert!((0.0..=1.0).contains(&t));
            for (_, distance, radius) in stamps(&s, q) {
                prop_assert!(radius == 0.0 || distance / radius >= ratio * (1.0 - 1e-9) - 1e-9);
            }
            // Both calculations agree on what is covered, except at the very border.
            prop_assert!((ratio - 1.0).abs() < 1e-7 || s.depth(q).is_some() == (ratio < 1.0));
        }

        #[test]
        fn what_covers_a_point_touches_its_box(s in any_segment(), x in -30.0..30.0f64, y in -30.0..30.0f64) {
            let q = DVec2::new(x, y);
            prop_assert!(s.depth(q).is_none() || s.touches(q, q));
        }

        #[test]
        fn reversed_segment_is_the_same(s in any_segment(), x in -30.0..30.0f64, y in -30.0..30.0f64) {
            let q = DVec2::new(x, y);
            let reversed = Segment { from: s.to, to: s.from, ..s };
            let ratio = s.nearest_axis_point(q).0;
            match (s.depth(q), reversed.depth(q)) {
                (Some(a), Some(b)) => prop_assert!((a.inv_depth - b.inv_depth).abs() < 1e-6),
                (a, b) => prop_assert!(a == b || (ratio - 1.0).abs() < 1e-7),
            }
        }
    }
}
