//! A line of ink, as a pen draws it: tapered at both ends, bold in shadow, trembling.

effects::effect!("line_ink");

/// `line.ink`: lines of surfaces in ink. An end is a quarter of an ellipse, width `sqrt(1 - (1 - d / T)^2)` at `d` from it with the taper `T` (W, row W3).
pub struct LineInk;

impl effects::StrokeEffect for LineInk {
    type Program = Program;
    const ID: &'static str = "line.ink";
    const DOC: &'static str =
        "lines of surfaces by a pen: tapered ends, bold in shadow, thin in light, trembling";
    const RANK: i32 = -100;
    const IS_FOR_LINES: bool = true;

    fn follows_lines(params: &Params) -> bool {
        params.wobble > 0.0
    }

    fn reach(params: &Params) -> effects::Reach {
        effects::Reach {
            clumps: 0.0,
            units: 0.5 * params.width * params.light_width.max(1.0) * (1.0 + params.wobble),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use effects::wgsl::{vec2, vec3};
    use effects::{Joints, Registry, Values};

    /// Millimetres a unit.
    const HEAD_M: f32 = 0.3;

    /// The radii of strokes on joints at these distances from both ends (m), whose surface has light at this cosine.
    fn radii(ends: &[[f32; 2]], cosine: f32, set: &[(&str, &str)]) -> Vec<f32> {
        let count = ends.len();
        let joints = Joints {
            from_ends: ends.iter().map(|ends| vec2(*ends)).collect(),
            rest_position: (0..count)
                .map(|i| vec3([0.1 * i as f32, 0.2, -0.4]))
                .collect(),
            material_normal: vec![vec3([0.0, 0.0, 1.0]); count],
            light_direction: vec![vec3([0.0, (1.0 - cosine * cosine).sqrt(), cosine]); count],
            head_height: vec![HEAD_M; count],
            ..Joints::default()
        };
        let mut registry = Registry::new();
        registry.register::<LineInk>().unwrap();
        let effect = registry.get("line.ink").unwrap();
        let mut values = Values::defaults(effect.params());
        for (name, text) in set {
            values.set_text("line.ink", name, text).unwrap();
        }
        let mut radii = Vec::new();
        effect
            .program(&values)
            .radii(&joints, 0..count, 0, 1, &mut radii);
        radii
    }

    #[test]
    fn it_conforms() {
        effects_testkit::assert_conforms::<LineInk>();
        effects_testkit::assert_steady::<LineInk>(&[]);
    }

    /// W3's proof: the area that an end covers is pi/4 T w, within 0.5 %.
    #[test]
    fn a_tapers_area_is_that_of_an_ellipse() {
        let set = [("wobble", "0"), ("width", "4"), ("taper", "40")];
        let steps = 4000;
        let at = |i: usize| 0.04 * (i as f32 + 0.5) / steps as f32;
        let ends: Vec<[f32; 2]> = (0..steps).map(|i| [at(i), 0.2 - at(i)]).collect();
        let widths = radii(&ends, 0.0, &set);
        let area: f64 = widths
            .iter()
            .map(|r| 2.0 * f64::from(*r) * 40.0 / steps as f64)
            .sum();
        let expected = std::f64::consts::FRAC_PI_4 * 40.0 * 4.0;
        assert!((area / expected - 1.0).abs() < 5e-3, "{area} of {expected}");
        // Both ends alike, whole between them, and blunt where nothing tapers.
        let [start, middle, end] = radii(&[[0.01, 0.19], [0.1, 0.1], [0.19, 0.01]], 0.0, &set)[..]
        else {
            panic!("three joints")
        };
        assert!((start - end).abs() < 1e-6 && start < 2.0 && (middle - 2.0).abs() < 1e-6);
        let blunt = radii(
            &[[0.0, 0.2]],
            0.0,
            &[("wobble", "0"), ("width", "4"), ("taper", "0")],
        );
        assert!((blunt[0] - 2.0).abs() < 1e-6);
    }

    #[test]
    fn short_lines_are_whole_in_their_middle() {
        let set = [("wobble", "0"), ("width", "4"), ("taper", "40")];
        let [end, middle] = radii(&[[0.0, 0.01], [0.005, 0.005]], 0.0, &set)[..] else {
            panic!("two joints")
        };
        assert!(end == 0.0 && (middle - 2.0).abs() < 1e-6, "{end} {middle}");
    }

    #[test]
    fn light_thins_and_hands_tremble_within_their_limits() {
        let set = [("wobble", "0"), ("width", "4"), ("light_width", "0.5")];
        let far = [[1.0, 1.0]; 40];
        assert!((radii(&far, 1.0, &set)[0] - 1.0).abs() < 1e-6);
        assert!((radii(&far, -1.0, &set)[0] - 2.0).abs() < 1e-6);
        let trembling = radii(&far, -1.0, &[("wobble", "0.5"), ("width", "4")]);
        let [least, most] =
            [f32::min, f32::max].map(|of| trembling.iter().copied().reduce(of).unwrap());
        assert!(
            least > 1.0 && most < 3.0 && most - least > 0.5,
            "{least} to {most}"
        );
    }
}
