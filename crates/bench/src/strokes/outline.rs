//! Strokes as outlines, for libraries that fill paths.

use glam::DVec2;
use render::Disc;

/// Beyond this cosine an arc is drawn as two cubic curves: at about 100 degrees the distance of one
/// curve from the circle is 5 parts in 10,000 of the radius.
const ONE_CURVE: f64 = -0.18;

/// What draws an outline: a library's builder of paths. Coordinates in pixels, y down.
pub trait Pen {
    /// Starts a closed figure.
    fn move_to(&mut self, point: DVec2);
    /// A straight line to `point`.
    fn line_to(&mut self, point: DVec2);
    /// A cubic Bezier curve.
    fn curve_to(&mut self, first: DVec2, second: DVec2, point: DVec2);
    /// Ends the figure.
    fn close(&mut self);
}

/// The two outer tangents of two circles, neither of which holds the other.
#[derive(Clone, Copy, Debug)]
struct Tangents {
    /// Unit vector from the first centre to the second.
    axis: DVec2,
    /// Unit vectors from both centres to the points of tangency, one a side of the axis.
    normals: [DVec2; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Circle {
    center: DVec2,
    radius: f64,
}

impl From<&Disc> for Circle {
    fn from(disc: &Disc) -> Self {
        Self {
            center: disc.center.as_dvec2(),
            radius: disc.radius.into(),
        }
    }
}

impl Circle {
    fn at(&self, normal: DVec2) -> DVec2 {
        self.center + self.radius * normal
    }

    fn holds(&self, other: &Self) -> bool {
        self.center.distance(other.center) <= self.radius - other.radius
    }
}

/// Draws the outline of the union of all discs between two: two arcs and the outer tangents, or the
/// larger disc where it holds the smaller one. Nothing where both radii are 0.
pub fn segment(from: &Disc, to: &Disc, pen: &mut impl Pen) {
    let (a, b) = (Circle::from(from), Circle::from(to));
    if a.radius <= 0.0 && b.radius <= 0.0 {
        return;
    }
    match tangents(&a, &b) {
        Some(tangents) => {
            let [one, other] = tangents.normals;
            pen.move_to(a.at(one));
            cap(&a, [one, -tangents.axis, other], pen);
            pen.line_to(b.at(other));
            cap(&b, [other, tangents.axis, one], pen);
            pen.close();
        }
        None => circle(if a.radius >= b.radius { &a } else { &b }, pen),
    }
}

/// Draws the outline of a whole stroke, to be filled by the nonzero rule: both sides, joined by
/// straight lines at the joints, and two round caps. What a joint turns by is cut off; at a degree
/// and a radius of 5 pixels that is 0.0002 pixels.
pub fn stroke(discs: &[Disc], pen: &mut impl Pen) {
    let circles = without_nested(discs);
    let ([first, ..], [.., last]) = (&circles[..], &circles[..]) else {
        return;
    };
    let tangents: Vec<Tangents> = circles
        .windows(2)
        .filter_map(|pair| tangents(&pair[0], &pair[1]))
        .collect();
    let (Some(start), Some(end)) = (tangents.first(), tangents.last()) else {
        return circle(first, pen);
    };
    pen.move_to(first.at(start.normals[0]));
    cap(
        first,
        [start.normals[0], -start.axis, start.normals[1]],
        pen,
    );
    for (index, (ends, tangent)) in circles.windows(2).zip(&tangents).enumerate() {
        if index > 0 {
            pen.line_to(ends[0].at(tangent.normals[1]));
        }
        pen.line_to(ends[1].at(tangent.normals[1]));
    }
    cap(last, [end.normals[1], end.axis, end.normals[0]], pen);
    for (index, (ends, tangent)) in circles.windows(2).zip(&tangents).enumerate().rev() {
        pen.line_to(ends[0].at(tangent.normals[0]));
        if index > 0 {
            pen.line_to(ends[0].at(tangents[index - 1].normals[0]));
        }
    }
    pen.close();
}

/// The circles of a stroke without those that a neighbour holds, so that all that follow each other
/// have tangents. Empty if all radii are 0.
fn without_nested(discs: &[Disc]) -> Vec<Circle> {
    let mut circles: Vec<Circle> = Vec::with_capacity(discs.len());
    if discs.iter().all(|disc| disc.radius <= 0.0) {
        return circles;
    }
    for next in discs.iter().map(Circle::from) {
        while circles.last().is_some_and(|last| next.holds(last)) {
            circles.pop();
        }
        if !circles.last().is_some_and(|last| last.holds(&next)) {
            circles.push(next);
        }
    }
    circles
}

fn tangents(a: &Circle, b: &Circle) -> Option<Tangents> {
    let between = b.center - a.center;
    let distance = between.length();
    let taper = a.radius - b.radius;
    if distance <= taper.abs() {
        return None;
    }
    let axis = between / distance;
    let cos = taper / distance;
    let across = axis.perp() * (1.0 - cos * cos).sqrt();
    Some(Tangents {
        axis,
        normals: [axis * cos + across, axis * cos - across],
    })
}

/// The arc from one unit vector by a second to a third, neither half more than half a circle.
fn cap(circle: &Circle, [from, by, to]: [DVec2; 3], pen: &mut impl Pen) {
    arc(circle, from, by, pen);
    arc(circle, by, to, pen);
}

/// The arc from the unit vector `from` to `to`, less than half a circle.
fn arc(circle: &Circle, from: DVec2, to: DVec2, pen: &mut impl Pen) {
    let cos = from.dot(to);
    if cos < ONE_CURVE {
        let middle = (from + to).try_normalize();
        let middle = middle.unwrap_or_else(|| from.perp());
        curve(circle, from, middle, pen);
        curve(circle, middle, to, pen);
    } else {
        curve(circle, from, to, pen);
    }
}

/// An arc as one curve: its handles are 4/3 tan(angle / 4) of the radius long.
fn curve(circle: &Circle, from: DVec2, to: DVec2, pen: &mut impl Pen) {
    let cos = from.dot(to).clamp(-1.0, 1.0);
    let turn = from.perp_dot(to).signum();
    let tan_half = ((1.0 - cos) / (1.0 + cos)).sqrt();
    let tan_quarter = tan_half / (1.0 + (1.0 + tan_half * tan_half).sqrt());
    let handle = turn * 4.0 / 3.0 * tan_quarter;
    pen.curve_to(
        circle.at(from + handle * from.perp()),
        circle.at(to - handle * to.perp()),
        circle.at(to),
    );
}

fn circle(circle: &Circle, pen: &mut impl Pen) {
    pen.move_to(circle.at(DVec2::X));
    for (from, to) in [
        (DVec2::X, DVec2::Y),
        (DVec2::Y, DVec2::NEG_X),
        (DVec2::NEG_X, DVec2::NEG_Y),
        (DVec2::NEG_Y, DVec2::X),
    ] {
        curve(circle, from, to, pen);
    }
    pen.close();
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    /// Sums up the area that an outline goes around, by Green's theorem.
    #[derive(Default)]
    struct Area {
        first: DVec2,
        at: DVec2,
        signed: f64,
        figures: usize,
    }

    impl Pen for Area {
        fn move_to(&mut self, point: DVec2) {
            (self.first, self.at) = (point, point);
        }

        fn line_to(&mut self, point: DVec2) {
            self.signed += 0.5 * self.at.perp_dot(point);
            self.at = point;
        }

        fn curve_to(&mut self, b: DVec2, c: DVec2, d: DVec2) {
            // The integral of x dy - y dx along a cubic Bezier curve.
            let a = self.at;
            self.signed += 3.0 / 20.0
                * (2.0 * a.perp_dot(b)
                    + a.perp_dot(c)
                    + b.perp_dot(c)
                    + b.perp_dot(d)
                    + 2.0 * c.perp_dot(d))
                + a.perp_dot(d) / 20.0;
            self.at = d;
        }

        fn close(&mut self) {
            self.line_to(self.first);
            self.figures += 1;
        }
    }

    fn disc(x: f64, y: f64, radius: f64) -> Disc {
        Disc {
            center: Vec2::new(x as f32, y as f32),
            radius: radius as f32,
            inv_depth: 1.0,
            inv_depth_biased: 1.0,
        }
    }

    /// Two sectors, and two trapezoids between the axis and a tangent.
    fn closed_form(a: &Disc, b: &Disc) -> f64 {
        let (ra, rb) = (f64::from(a.radius), f64::from(b.radius));
        let distance = a.center.as_dvec2().distance(b.center.as_dvec2());
        if distance <= (ra - rb).abs() {
            return PI * ra.max(rb).powi(2);
        }
        let angle = ((ra - rb) / distance).acos();
        let tangent = (distance * distance - (ra - rb).powi(2)).sqrt();
        ra * ra * (PI - angle) + rb * rb * angle + tangent * (ra + rb)
    }

    fn area(draw: impl Fn(&mut Area)) -> Area {
        let mut area = Area::default();
        draw(&mut area);
        area
    }

    #[test]
    fn known_areas() {
        let close = |a: &Disc, b: &Disc, expected: f64| {
            let area = area(|pen| segment(a, b, pen)).signed.abs();
            assert!(
                (area - expected).abs() < 1e-3 * expected,
                "{area}, not {expected}"
            );
        };
        close(&disc(0.0, 0.0, 1.0), &disc(5.0, 0.0, 1.0), PI + 10.0);
        close(&disc(3.0, 4.0, 2.0), &disc(3.0, 5.0, 0.5), 4.0 * PI);
        close(&disc(3.0, 4.0, 2.0), &disc(3.0, 4.0, 2.0), 4.0 * PI);
        // A drop: three quarters of a disc, and a square.
        close(
            &disc(0.0, 0.0, 1.0),
            &disc(2f64.sqrt(), 0.0, 0.0),
            1.0 + 0.75 * PI,
        );
    }

    #[test]
    fn nothing_is_no_figure() {
        let nothing = [disc(0.0, 0.0, 0.0), disc(5.0, 0.0, 0.0)];
        assert_eq!(
            area(|pen| segment(&nothing[0], &nothing[1], pen)).figures,
            0
        );
        assert_eq!(area(|pen| stroke(&nothing, pen)).figures, 0);
        assert_eq!(area(|pen| stroke(&[], pen)).figures, 0);
        assert_eq!(area(|pen| stroke(&[disc(1.0, 2.0, 3.0)], pen)).figures, 1);
    }

    #[test]
    fn a_straight_stroke_is_its_segments_in_one() {
        let discs = [
            disc(0.0, 0.0, 1.0),
            disc(10.0, 0.0, 2.0),
            disc(11.0, 0.0, 0.5), // inside the one before
            disc(30.0, 0.0, 1.0),
        ];
        let whole = area(|pen| stroke(&discs, pen));
        assert_eq!(whole.figures, 1);
        // The union: two pieces that share the disc in the middle, at whose joint the chord cuts
        // off what lies between the two directions.
        let pieces = closed_form(&discs[0], &discs[1]) + closed_form(&discs[1], &discs[3]);
        let union = pieces - 4.0 * PI;
        let difference = (whole.signed.abs() - union).abs();
        assert!(difference < 0.02 * union, "{} {union}", whole.signed);
    }

    proptest! {
        #[test]
        fn a_segments_outline_has_its_area(
            (x, y, u, v) in (-50.0..50.0f64, -50.0..50.0f64, -20.0..20.0f64, -20.0..20.0f64),
            (ra, rb) in (0.01..15.0f64, 0.0..15.0f64),
        ) {
            let (a, b) = (disc(x, y, ra), disc(x + u, y + v, rb));
            let outline = area(|pen| segment(&a, &b, pen));
            let expected = closed_form(&a, &b);
            prop_assert_eq!(outline.figures, 1);
            // Always the same way around, or a nonzero fill of several would have holes.
            prop_assert!((outline.signed - expected).abs() < 1e-3 * expected, "{} {}", outline.signed, expected);
        }
    }
}
