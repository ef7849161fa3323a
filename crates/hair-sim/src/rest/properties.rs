use super::*;
use glam::Vec3;
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = DVec3> {
    [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array)
}

/// A strand of links that turn by less than a right angle.
fn crooked() -> impl Strategy<Value = Vec<Vec3>> {
    (
        vector(),
        proptest::collection::vec((vector(), 0.005..0.03_f64), 2..12),
    )
        .prop_map(|(first, turns)| {
            let mut along = first.normalize_or(DVec3::X);
            let mut at = DVec3::new(0.1, 0.2, 0.3);
            let mut points = vec![at.as_vec3()];
            for (aside, length) in turns {
                along = (along + 0.5 * aside).normalize_or(along);
                at += along * length;
                points.push(at.as_vec3());
            }
            points
        })
}

/// Energy over mass per length of a strand whose link `turned` is turned by `by`: weight, bending and twist.
fn energy(strand: &RestStrand, turned: usize, by: DVec3) -> f64 {
    let (mut y, mut before, mut sum) = (DVec3::ZERO, strand.base, 0.0);
    for (k, link) in strand.links.iter().enumerate() {
        let frame = if k == turned {
            DQuat::from_scaled_axis(by) * link.frame
        } else {
            link.frame
        };
        y += frame * DVec3::Z * link.length;
        let e = turn(before, frame) - link.natural;
        sum += link.mass * GRAVITY * y.y;
        sum += 0.5 * (link.bend * (e.x * e.x + e.y * e.y) + link.twist * e.z * e.z);
        before = frame;
    }
    sum
}

proptest! {
    #[test]
    fn a_turn_is_twice_the_tangent_of_half_its_angle(axis in vector(), angle in -3.0..3.0_f64, at in vector()) {
        let axis = axis.normalize_or(DVec3::Y);
        let before = DQuat::from_scaled_axis(at);
        let after = before * DQuat::from_axis_angle(axis, angle);
        let expected = axis * (2.0 * (0.5 * angle).tan());
        prop_assert!((turn(before, after) - expected).length() < 1e-11 * (1.0 + expected.length_squared()));
    }

    #[test]
    fn the_turn_s_derivative_is_what_the_moments_are_made_with(u in vector(), by in vector()) {
        // With c = u / 2: du = (1 + [c] + c c^T) df for a turn df of the link, in its frame.
        let (c, before) = (u * 0.5, DQuat::IDENTITY);
        let after = DQuat::from_xyzw(c.x, c.y, c.z, 1.0).normalize();
        let h = 1e-6;
        let at = |h: f64| turn(before, after * DQuat::from_scaled_axis(by * h));
        let rate = (at(h) - at(-h)) / (2.0 * h);
        let expected = by + c.cross(by) + c * c.dot(by);
        prop_assert!((rate - expected).length() < 1e-8);
    }

    #[test]
    fn an_arc_turns_evenly_and_by_half_at_the_root(count in 3..20_usize, angle in 0.01..0.6_f64, radius in 0.02..0.5_f64) {
        let points: Vec<Vec3> = (0..=count)
            .map(|i| {
                let a = angle * i as f64;
                (DVec3::new(a.cos(), a.sin(), 0.0) * radius).as_vec3()
            })
            .collect();
        let params = Params { natural: Natural::Styled, ..Params::default() };
        let strand = RestStrand::new(&points, &params).unwrap();
        for (k, link) in strand.links.iter().enumerate() {
            let part = if k == 0 { 0.25 } else { 0.5 };
            let expected = 2.0 * (part * angle).tan();
            // Points of single precision.
            let off = (link.natural.length() - expected).abs();
            prop_assert!(off < 1e-5 / angle, "{k}: {off}");
            prop_assert!(link.natural.z.abs() < 1e-5 / angle);
        }
    }

    #[test]
    fn a_balanced_strand_is_where_its_energy_is_least(points in crooked(), gamma in 0.1..30.0_f64) {
        let params = Params {
            material: crate::Material::from_gamma(gamma, 0.2),
            ..Params::default()
        };
        let strand = RestStrand::new(&points, &params).unwrap();
        let length: f64 = strand.links.iter().map(|l| l.length).sum();
        let h = 1e-5;
        for k in 0..strand.links.len() {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let slope = (energy(&strand, k, axis * h) - energy(&strand, k, -axis * h)) / (2.0 * h);
                prop_assert!(slope.abs() < 1e-6 * GRAVITY * length * length, "{k}: {slope}");
            }
        }
    }
}
