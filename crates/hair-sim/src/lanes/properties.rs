//! Lanes against glam, whose arithmetic is another's.

use super::*;
use glam::{DMat3, DQuat, DVec3};
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = DVec3> {
    [-2.0..2.0_f64, -2.0..2.0, -2.0..2.0].prop_map(DVec3::from_array)
}

fn rotation() -> impl Strategy<Value = DQuat> {
    (vector(), -6.0..6.0_f64)
        .prop_map(|(axis, angle)| DQuat::from_axis_angle(axis.normalize_or(DVec3::X), angle))
}

/// In one lane; the others hold something else.
fn quat(q: DQuat) -> Quat {
    let mut lanes = Quat::IDENTITY;
    lanes.set(3, q);
    lanes
}

fn vec(v: DVec3) -> Vec3 {
    let mut lanes = Vec3::splat(DVec3::ONE);
    lanes.set(3, v);
    lanes
}

fn rows(m: Mat3) -> DMat3 {
    DMat3::from_cols(m.0.get(3), m.1.get(3), m.2.get(3)).transpose()
}

/// A symmetric matrix; positive definite where `more` is.
fn symmetric(a: DVec3, b: DVec3, c: DVec3, more: f64) -> (Sym3, DMat3) {
    let lanes = Sym3::outer(Lane::ZERO, vec(a), Lane::ONE)
        + Sym3::outer(Lane::ZERO, vec(b), Lane::ONE)
        + Sym3::outer(Lane::splat(more), vec(c), Lane::ONE);
    let outer = |v: DVec3| DMat3::from_cols(v * v.x, v * v.y, v * v.z);
    let plain = outer(a) + outer(b) + outer(c) + DMat3::from_diagonal(DVec3::splat(more));
    (lanes, plain)
}

fn apart(a: DMat3, b: DMat3) -> f64 {
    let off = a - b;
    off.x_axis.length() + off.y_axis.length() + off.z_axis.length()
}

proptest! {
    #[test]
    fn rotations_are_those_of_glam(p in rotation(), q in rotation(), v in vector()) {
        let (lp, lq) = (quat(p), quat(q));
        let product = lp.times(lq).get(3);
        prop_assert!((product.dot(p * q).abs() - 1.0).abs() < 1e-14);
        prop_assert!((lp.conjugate().get(3) * (p * v) - v).length() < 1e-13);
        let [x, y, z] = lq.axes().map(|axis| axis.get(3));
        for (axis, of) in [(x, DVec3::X), (y, DVec3::Y), (z, DVec3::Z)] {
            prop_assert!((axis - q * of).length() < 1e-14);
        }
        prop_assert!((lq.tangent().get(3) - z).length() < 1e-14);
    }

    #[test]
    fn a_turn_is_by_twice_the_arc_tangent_of_its_half(q in rotation(), turn in vector()) {
        let turned = quat(q).turned(vec(turn)).get(3);
        let angle = 2.0 * (0.5 * turn.length()).atan();
        let expected = DQuat::from_axis_angle(turn.normalize_or(DVec3::X), angle) * q;
        prop_assert!((turned.dot(expected).abs() - 1.0).abs() < 1e-13);
    }

    #[test]
    fn a_small_turn_moves_as_its_cross_product(q in rotation(), turn in vector(), v in vector()) {
        let h = 1e-5;
        let moved = |h: f64| quat(q).turned(vec(turn * h)).get(3) * v;
        let rate = (moved(h) - moved(-h)) / (2.0 * h);
        prop_assert!((rate - turn.cross(q * v)).length() < 1e-8);
    }

    #[test]
    fn products_of_matrices(a in vector(), b in vector(), c in vector(), v in vector(), more in 0.1..3.0_f64) {
        let m = Mat3(vec(a), vec(b), vec(c));
        let plain = rows(m);
        prop_assert!((m.apply(vec(v)).get(3) - plain * v).length() < 1e-13);
        prop_assert!(apart(rows(m.transpose()), plain.transpose()) < 1e-15);
        let cross = DMat3::from_cols(v.cross(DVec3::X), v.cross(DVec3::Y), v.cross(DVec3::Z));
        prop_assert!(apart(rows(m.times_cross(vec(v))), plain * cross) < 1e-13);
        let (s, s_plain) = symmetric(a, b, c, more);
        prop_assert!(apart(rows(m.times(s.rows())), plain * s_plain) < 1e-11);
        // M S M^T is symmetric.
        let both = Sym3::upper_of_product(m.times(s.rows()), m.transpose());
        prop_assert!(apart(rows(both.rows()), plain * s_plain * plain.transpose()) < 1e-10);
    }

    #[test]
    fn an_inverse_undoes_its_matrix(a in vector(), b in vector(), c in vector(), v in vector(), more in 0.1..3.0_f64) {
        let (s, plain) = symmetric(a, b, c, more);
        prop_assert!((s.apply(vec(v)).get(3) - plain * v).length() < 1e-12);
        let back = s.inverse().apply(s.apply(vec(v))).get(3);
        prop_assert!((back - v).length() < 1e-10, "{}", back - v);
    }

    #[test]
    fn masks_pick_any_bits(a in any::<f64>(), b in any::<f64>(), set in any::<[bool; LANES]>()) {
        let picked = Mask::new(set).pick(Lane::splat(a), Lane::splat(b));
        for lane in 0..LANES {
            let expected = if set[lane] { a } else { b };
            prop_assert_eq!(picked[lane].to_bits(), expected.to_bits());
        }
        prop_assert_eq!(Lane::splat(a).is_finite().get(0), a.is_finite());
    }
}
