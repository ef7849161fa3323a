//! The translation of WGSL to Rust held against WGSL's definitions, and the prelude against the
//! functions it stands for.

use effects::Section as _;
use effects::rt::Scalar;
use effects::wgsl::{self, vec2, vec3};
use effects::{Input, ParamKind, Parameters, Value, Values};
use proptest::prelude::*;

mod built {
    effects::effect!("builtins");

    pub mod functions {
        pub use super::translated::*;
    }
}

use built::functions as t;

#[test]
fn builtins_are_wgsls() {
    // x is last in WGSL and first in the runtime.
    assert_eq!(t::t_smoothstep(1.0, 3.0, 0.0), 0.0);
    assert_eq!(t::t_smoothstep(1.0, 3.0, 2.0), 0.5);
    assert_eq!(t::t_smoothstep(1.0, 3.0, 1.5), 0.15625);
    assert_eq!(t::t_smoothstep(1.0, 3.0, 9.0), 1.0);
    let smooth = t::t_smoothstep_vec(vec3([0.0; 3]), vec3([2.0; 3]), vec3([1.0, 0.5, 4.0]));
    assert_eq!(smooth, vec3([0.5, 0.15625, 1.0]));
    assert_eq!(t::t_sqrt(2.25), 1.5);
    assert_eq!(
        [t::t_clamp(-1.0, 0.0, 2.0), t::t_clamp(3.0, 0.0, 2.0)],
        [0.0, 2.0]
    );
    assert_eq!(
        [t::t_saturate(-0.5), t::t_saturate(0.5), t::t_saturate(1.5)],
        [0.0, 0.5, 1.0]
    );
    assert_eq!(
        [
            t::t_abs(-2.0),
            t::t_sign(-2.0),
            t::t_sign(0.0),
            t::t_sign(7.0)
        ],
        [2.0, -1.0, 0.0, 1.0]
    );
    assert_eq!(
        [t::t_floor(-1.5), t::t_ceil(-1.5), t::t_trunc(-1.5)],
        [-2.0, -1.0, -1.0]
    );
    assert_eq!(
        [
            t::t_min(1.0, 2.0),
            t::t_max(1.0, 2.0),
            t::t_mix(1.0, 5.0, 0.25)
        ],
        [1.0, 2.0, 2.0]
    );
    assert_eq!(
        t::t_mix_vec(vec3([0.0; 3]), vec3([4.0; 3]), 0.5),
        vec3([2.0; 3])
    );
    assert_eq!(t::t_dot(vec3([1.0, 2.0, 3.0]), vec3([4.0, 5.0, 6.0])), 32.0);
    assert_eq!(
        t::t_cross(vec3([1.0, 0.0, 0.0]), vec3([0.0, 1.0, 0.0])),
        vec3([0.0, 0.0, 1.0])
    );
    assert_eq!(t::t_length(vec3([2.0, 3.0, 6.0])), 7.0);
    assert_eq!(t::t_distance(vec2([1.0, 1.0]), vec2([4.0, 5.0])), 5.0);
    assert_eq!(t::t_normalize(vec3([0.0, 8.0, 0.0])), vec3([0.0, 1.0, 0.0]));
    assert_eq!(
        [
            t::t_select(1.0, 2.0, Scalar(false)),
            t::t_select(1.0, 2.0, Scalar(true))
        ],
        [1.0, 2.0]
    );
    let (a, b) = (vec3([1.0, 2.0, 3.0]), vec3([4.0, 5.0, 6.0]));
    let selected = [false, true].map(|c| t::t_select_vec(a, b, Scalar(c)));
    assert_eq!(selected, [a, b]);
}

#[test]
fn constructs_are_wgsls() {
    assert_eq!(
        [t::t_zeroed(Scalar(false)), t::t_zeroed(Scalar(true))],
        [0.0, 4.0]
    );
    assert_eq!(t::t_loop_sum(5u32), 1 + 2 + 4);
    assert_eq!(t::t_loop_sum(50u32), 1 + 2 + 4 + 5 + 6 + 7);
    assert_eq!(
        [t::t_switch(0u32), t::t_switch(2u32), t::t_switch(9u32)],
        [10.0, 20.0, 30.0]
    );
    assert_eq!(
        t::t_wrap(5u32),
        5u32.wrapping_mul(0x7feb_352d).wrapping_sub(1)
    );
    assert_eq!(t::t_shift(0x8000_0001u32), 8 ^ 1);
    assert_eq!([t::t_to_u(3.9), t::t_to_u(-1.0)], [3, 0]);
    assert_eq!(t::t_to_f(16_777_217u32), 16_777_216.0);
    assert_eq!(t::t_swizzle(vec3([1.0, 2.0, 3.0])), vec3([3.0, 1.0, 2.0]));
    assert_eq!(t::t_component(vec3([1.0, 2.0, 3.0])), vec3([1.0, 9.0, 3.0]));
}

#[test]
fn parameters_come_from_the_comments() {
    let params = built::Program::PARAMS;
    assert_eq!(params.len(), 5);
    assert_eq!(params[0].name, "number");
    assert_eq!(params[0].doc, "A number.");
    assert_eq!(params[0].unit, "metres");
    assert_eq!(
        params[0].kind,
        ParamKind::Number {
            min: -1.0,
            max: 2.5,
            default: 0.5,
            varies: true
        }
    );
    assert_eq!(
        params[1].kind,
        ParamKind::Integer {
            min: 1,
            max: 9,
            default: 3
        }
    );
    assert_eq!(
        params[2].kind,
        ParamKind::Choice {
            names: &["first", "second"],
            default: 1
        }
    );
    assert_eq!(params[3].kind, ParamKind::Color { default: "FF0000" });
    assert_eq!(params[4].kind, ParamKind::OptionalColor { default: None });

    let mut values = Values::defaults(params);
    values.set(0, Value::Number(2.0));
    let made = built::Program::params(&values);
    assert_eq!((made.number, made.count, made.kind), (2.0, 3, 1));
    assert_eq!(
        (built::Params::KIND_FIRST, built::Params::KIND_SECOND),
        (0, 1)
    );
    assert_eq!(made.color, vec3([1.0, 0.0, 0.0]));
    assert_eq!(made.other_color, wgsl::color_or_none(None));
    values.set(4, Value::Color(Some([0.0, 1.0, 0.0])));
    let given = built::Program::params(&values).other_color;
    assert_eq!([given.x, given.y, given.z, given.w], [0.0, 1.0, 0.0, 1.0]);
    assert_eq!(built::Program::INPUTS, [Input::U]);
    assert!(built::Program::WGSL.starts_with(include_str!("builtins.wgsl")));
}

#[test]
fn the_hash_is_that_of_all_crates() {
    for n in (0..1_000_000_u32).map(|n| n.wrapping_mul(4_294_967)) {
        assert_eq!(wgsl::hash(n), portable_math::hash(n), "{n}");
    }
}

#[test]
fn random_numbers_are_even_and_apart() {
    let n = 10_000;
    let draws: Vec<f32> = (0..n).map(|i| wgsl::random(7u32, i)).collect();
    assert!(draws.iter().all(|x| (0.0..1.0).contains(x)));
    for tenth in 0..10 {
        let share = draws
            .iter()
            .filter(|x| (**x * 10.0) as u32 == tenth)
            .count();
        assert!(
            (850..1150).contains(&share),
            "{share} of {n} in tenth {tenth}"
        );
    }
    let neighbours: f32 = draws
        .windows(2)
        .map(|w| (w[0] - 0.5) * (w[1] - 0.5))
        .sum::<f32>()
        / n as f32;
    assert!(neighbours.abs() < 0.003, "correlation {neighbours}");
    assert_ne!(wgsl::random(7u32, 1u32), wgsl::random(8u32, 1u32));
    assert_eq!(wgsl::random(7u32, 1u32), wgsl::random(7u32, 1u32));
}

#[test]
fn numbers_and_their_bits() {
    assert_eq!(wgsl::bits_of(1.0), 0x3f80_0000);
    assert_eq!(wgsl::of_bits(0xbf80_0000_u32), -1.0);
    for number in [0.0, -0.0, 1e-40, 0.1, f32::MAX, f32::INFINITY] {
        let bits: u32 = wgsl::bits_of(number);
        assert_eq!(bits, number.to_bits(), "{number}");
        assert_eq!(wgsl::of_bits(bits), number);
    }
}

#[test]
fn powers_at_their_ends() {
    let ends = [-1e9, -126.0, 0.0, 1.0, 127.0, 1e9].map(|x: f32| wgsl::power_of_two(x));
    let (least, most) = (2f32.powi(-126), 2f32.powi(127));
    assert_eq!(ends, [least, least, 1.0, 2.0, most, most]);
    assert_eq!(
        [wgsl::log_to_two(0.0), wgsl::log_to_two(8.0)],
        [-126.0, 3.0]
    );
    assert_eq!(
        [
            wgsl::power(0.0, 0.0),
            wgsl::power(-2.0, 3.0),
            wgsl::power(1.0, 1000.0)
        ],
        [0.0, 0.0, 1.0]
    );
}

#[test]
fn size_functions_at_their_ends() {
    // 5.1: full before the start, half way down half way to the tip, a point at the tip.
    let shrink = [0.1, 0.35, 0.675, 1.0].map(|u: f32| wgsl::shrink_to_tail(u, 0.35));
    assert_eq!(shrink[0], 1.0);
    assert_eq!(shrink[1], 1.0);
    assert!((shrink[2] - 0.5).abs() < 1e-6);
    assert_eq!(shrink[3], 0.0);
    assert_eq!(
        wgsl::shrink_to_tail(1.0, 1.0),
        1.0,
        "a start at the tip never shrinks"
    );
    // 5.2: sin(offset pi) at the root, a point at the tip.
    assert!((wgsl::swell(0.0, 0.25) - std::f32::consts::FRAC_1_SQRT_2).abs() < 1e-6);
    assert!((wgsl::swell(0.5, 0.0) - 1.0).abs() < 1e-6);
    assert_eq!(
        wgsl::swell(1.0, 0.25),
        0.0,
        "sin(pi) is not 0 in f32, a tip is"
    );
    assert_eq!(wgsl::swell(0.5, 1.0), 0.0);
}

proptest! {
    #[test]
    fn sin_pi_is_the_sine(x in -1000.0f32..1000.0) {
        let exact = (f64::from(x) * std::f64::consts::PI).sin();
        let got = f64::from(wgsl::sin_pi(x));
        prop_assert!((got - exact).abs() < 3e-7, "sin_pi({x}) = {got}, not {exact}");
    }

    #[test]
    fn powers_and_logarithms(x in -125.0f32..127.0, y in 0.0f32..1000.0, part in 0.0f32..=1.0) {
        let exact = f64::from(x).exp2();
        let got = f64::from(wgsl::power_of_two(x));
        prop_assert!((got / exact - 1.0).abs() < 3e-7, "2^{x} = {got}, not {exact}");
        let number = exact as f32;
        let (exact, got) = (f64::from(number).log2(), f64::from(wgsl::log_to_two(number)));
        prop_assert!((got - exact).abs() < 2e-6 + 3e-7 * exact.abs(), "log {number} = {got}, not {exact}");
        let exact = f64::from(part).powf(y.into());
        let got = f64::from(wgsl::power(part, y));
        // The exponent, up to 126, carries the roundings of the logarithm and of the product.
        prop_assert!((got - exact).abs() <= 2e-5 * exact + 2e-38, "{part}^{y} = {got}, not {exact}");
    }

    #[test]
    fn feathers_stand_side_by_side(count in 1u32..100) {
        let place = |i: u32| f64::from(wgsl::feather_place(i, count));
        prop_assert!((place(0) - (1.0 / f64::from(count) - 1.0)).abs() < 1e-6);
        for i in 1..count {
            prop_assert!((place(i) - place(i - 1) - 2.0 / f64::from(count)).abs() < 1e-6);
        }
    }

    /// How far a clump's discs reach outwards, over its width, is as far as the ellipse does that they stand for.
    #[test]
    fn a_flat_clump_is_an_ellipse_outwards(flat in 0.0f32..=0.9, turn in 0.0f32..6.0, radius in 0.1f32..30.0) {
        let out = vec2([turn.cos(), turn.sin()]);
        let across = vec2([-out.y, out.x]);
        let shift = vec2([-flat * radius * out.x, -flat * radius * out.y]);
        let discs: Vec<_> = (0..effects::CLUMP_DISCS)
            .map(|i| wgsl::clump_disc(i, radius, shift).to_array())
            .map(|[x, y, size]| {
                let place = vec2([x, y]) + shift;
                [place.dot(across).0, place.dot(out).0, size].map(|v| v / radius)
            })
            .collect();
        let reach = |x: f32| {
            discs
                .iter()
                .filter(|[at, _, size]| (x - at).abs() <= *size)
                .map(|[at, up, size]| up + (size * size - (x - at) * (x - at)).sqrt())
                .fold(f32::NEG_INFINITY, f32::max)
        };
        // Where neighbours that overlap by a third hide the rest.
        for x in [-0.75f32, -0.5, -0.3, -0.1, 0.0, 0.2, 0.4, 0.6, 0.75] {
            let ellipse = (1.0 - flat) * (1.0 - x * x).sqrt();
            let error = reach(x) - ellipse;
            prop_assert!(error.abs() < 0.16, "{flat}, {x}: {error}");
            if flat >= 0.7 {
                prop_assert!(error.abs() < 0.05, "{flat}, {x}: {error}");
            }
        }
    }

    #[test]
    fn perpendicular_is_across_and_unit(v in prop::array::uniform3(-1.0f32..1.0)) {
        let along = wgsl::unit_or(vec3(v), vec3([0.0, 0.0, 1.0]));
        let across = wgsl::perpendicular(along);
        prop_assert!(across.dot(along).0.abs() < 1e-6);
        prop_assert!((across.length().0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn unit_or_never_fails(v in prop::array::uniform3(any::<f32>())) {
        let finite = v.map(|x| if x.is_finite() { x.clamp(-1e15, 1e15) } else { 0.0 });
        let unit = wgsl::unit_or(vec3(finite), vec3([0.0, 1.0, 0.0]));
        prop_assert!((unit.length().0 - 1.0).abs() < 1e-5, "{unit:?} of {finite:?}");
    }
}
