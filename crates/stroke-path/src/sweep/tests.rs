//! Sweeps held against stamped discs and closed forms.

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
fn check_half(a: Circle, b: Circle, p: DVec2, runs_to_smaller: bool) -> Result<(), TestCaseError> {
    let sweep = Sweep::new(a, b).unwrap().with_semicircles(runs_to_smaller);
    let local = sweep.local(p).as_vec2();
    let way = (b.center - a.center).normalize_or_zero() * if runs_to_smaller { 1.0 } else { -1.0 };
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
        // A distance's error is a larger part of a smaller disc.
        let radius = lerp(a, b, stamped_u).radius.min(a.radius);
        prop_assert!((ratio - least).abs() < 2e-3 + slack / radius.max(1e-12));
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

    /// Close to the point of a stroke that tapers to nothing, discs are small: what a random case found.
    #[test]
    fn agrees_close_to_a_point(along in 0.999..1.0_f64) {
        let a = circle(0.0, 0.0, 2.0629807172960564);
        let b = circle(-19.460561187326896, 5.15039840182429, 0.0);
        let found = a.center.lerp(b.center, 1.098282036851945) + DVec2::new(1.3663426891444206, -0.361796718397695) * a.radius;
        check(a, b, found)?;
        check(a, b, a.center.lerp(b.center, along))?;
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
