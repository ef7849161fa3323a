//! Tones by light from a ramp, sample by sample, with a second axis for detail (X-Toon).

use effects::SampleInput;

effects::effect!("toon");

/// `hair.toon`: draws the clump as `hair.base` does, and paints each sample by how light falls on it.
pub struct Toon;

impl effects::StrokeEffect for Toon {
    type Program = Program;
    const ID: &'static str = "hair.toon";
    const DOC: &'static str =
        "the hair itself, painted by light: two, three or more tones, gradients, rims, highlights";
    const RANK: i32 = 0;
    const IS_CLUMP: bool = true;

    fn instances(_: &Params) -> u32 {
        effects::CLUMP_DISCS
    }

    fn reach(_: &Params) -> effects::Reach {
        effects::Reach {
            clumps: 2.0,
            units: 0.0,
        }
    }

    fn reads(params: &Params, input: SampleInput) -> bool {
        let detail = |choices: &[u32]| choices.contains(&params.detail);
        let has_rim = params.rim.w > 0.0;
        let is_round = params.roundness != 0.0;
        match input {
            SampleInput::Forward => is_round || detail(&[Params::DETAIL_WEIGHTED]),
            SampleInput::Depth => detail(&[Params::DETAIL_DEPTH]),
            SampleInput::HeadDepth => {
                detail(&[Params::DETAIL_DEPTH]) && params.depth_from == Params::DEPTH_FROM_HEAD
            }
            SampleInput::ViewDirection => {
                is_round || detail(&[Params::DETAIL_FACING, Params::DETAIL_BLINN])
            }
            SampleInput::Tube => has_rim || is_round,
            SampleInput::W => has_rim || detail(&[Params::DETAIL_ACROSS]),
            _ => true,
        }
    }

    fn extent(_: &Params, strand: &effects::StrandJoints) -> std::ops::Range<usize> {
        strand.clump_disc_extent()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use effects::wgsl::{Vec3, vec3};
    use effects::{AnyEffect, Registry, Samples, Values};

    #[test]
    fn it_conforms() {
        effects_testkit::assert_conforms::<Toon>();
        effects_testkit::assert_steady::<Toon>(&[]);
    }

    /// A sample that looks at the eye, light at this cosine, half way along a white strand.
    fn sample(cosine: f32) -> Samples {
        let sine = (1.0 - cosine * cosine).sqrt();
        Samples {
            color: vec![vec3([1.0; 3])],
            forward: vec![vec3([0.0, -1.0, 0.0])],
            normal: vec![vec3([0.0, 0.0, 1.0])],
            tube: vec![vec3([0.0, 0.0, 1.0])],
            u: vec![0.5],
            w: vec![0.25],
            depth: vec![4.0],
            head_depth: vec![5.0],
            light_direction: vec![vec3([0.0, sine, cosine])],
            view_direction: vec![vec3([0.0, 0.0, 1.0])],
            ..Samples::default()
        }
    }

    fn painted(samples: &Samples, settings: &[(&str, &str)]) -> Vec3<f32> {
        let mut registry = Registry::new();
        registry.register::<Toon>().unwrap();
        let effect: &dyn AnyEffect = registry.get(<Toon as effects::StrokeEffect>::ID).unwrap();
        let mut values = Values::defaults(effect.params());
        for (name, text) in settings {
            values.set_text("hair.toon", name, text).unwrap();
        }
        let mut colors = Vec::new();
        effect.program(&values).paint(samples, 0..1, 0, &mut colors);
        colors[0]
    }

    /// A ramp whose red is the place of the stops and whose green is that of the rows.
    const PLACES: &str = r#"[(v: 0, stops: [(0, "000000"), (1, "FF0000")]), (v: 1, stops: [(0, "00FF00"), (1, "FFFF00")])]"#;

    fn places(cosine: f32, settings: &[(&str, &str)]) -> [f64; 2] {
        let mut all = vec![("tones", PLACES), ("rim_width", "0")];
        all.extend(settings);
        let color = painted(&sample(cosine), &all);
        [color.x, color.y].map(f64::from)
    }

    #[test]
    fn light_chooses_the_tone_to_a_255th() {
        // Row 11: x = max(N . L, 0), against double precision.
        for step in -20..=20 {
            let cosine = f64::from(step) / 20.0;
            let [x, y] = places(cosine as f32, &[]);
            assert!((x - cosine.max(0.0)).abs() < 1.0 / 255.0, "{cosine}: {x}");
            assert_eq!(y, 0.0);
        }
    }

    /// A lock that runs to the eye, light from one side: left and right of it a tube's normal would shade it in halves, and its rim is where it was.
    #[test]
    fn the_end_of_a_lock_has_one_light() {
        let seen = |side: f32, forward: [f32; 3]| {
            let samples = Samples {
                forward: vec![vec3(forward)],
                normal: vec![vec3([0.0, 1.0, 0.0])],
                tube: vec![vec3([side, 0.0, 0.0])],
                light_direction: vec![vec3([0.6, 0.0, 0.8])],
                ..sample(0.5)
            };
            let color = painted(&samples, &[("tones", PLACES), ("detail", "facing")]);
            [color.x, color.y]
        };
        let from_its_end = [-1.0, 1.0].map(|side| seen(side, [0.0, 0.0, 1.0]));
        assert_eq!(from_its_end[0], from_its_end[1]);
        // Half the light that falls on what faces the eye, as roundness is a half.
        let expected = 0.8 * 0.5_f32.sqrt();
        assert!(
            (from_its_end[0][0] - expected).abs() < 1e-4,
            "{from_its_end:?}"
        );
        assert_eq!(from_its_end[0][1], 0.0);
        let from_beside = [-1.0, 1.0].map(|side| seen(side, [0.0, -1.0, 0.0])[0]);
        assert!(
            from_beside[0] == 0.0 && from_beside[1] > 0.4,
            "{from_beside:?}"
        );
    }

    #[test]
    fn depth_is_1_near_and_0_far_on_a_logarithmic_scale() {
        // Row 13: y = 1 - log(z / near) / log(far / near).
        let y = |near: &str, far: &str, from: &str| {
            places(
                0.5,
                &[
                    ("detail", "depth"),
                    ("near", near),
                    ("far", far),
                    ("depth_from", from),
                ],
            )[1]
        };
        let expected = 1.0 - (4.0_f64 / 3.0).ln() / (8.0_f64 / 3.0).ln();
        assert!((y("3", "8", "eye") - expected).abs() < 1e-3);
        assert_eq!((y("4.5", "8", "eye"), y("1", "3.5", "eye")), (1.0, 0.0));
        // From the head: a head height nearer than its centre is 1 - 1.
        let expected = 1.0 - (4.0_f64 / 3.5).ln() / (6.5_f64 / 3.5).ln();
        assert!((y("-1.5", "1.5", "head") - expected).abs() < 1e-3);
        // Where both are one it is a step.
        assert_eq!((y("3.9", "3.9", "eye"), y("4.1", "4.1", "eye")), (0.0, 1.0));
    }

    #[test]
    fn facing_is_a_power_of_the_cosine_to_the_eye() {
        // Row 14: y = |N . V|^r, here with a normal 60 degrees off.
        let mut turned = sample(0.5);
        turned.normal = vec![vec3([0.75_f32.sqrt(), 0.0, 0.5])];
        let y = |exponent: &str| {
            let settings = [
                ("tones", PLACES),
                ("detail", "facing"),
                ("exponent", exponent),
                ("roundness", "0"),
                ("rim_width", "0"),
            ];
            painted(&turned, &settings).y
        };
        for (exponent, expected) in [("0", 1.0), ("1", 0.5), ("2", 0.25)] {
            assert!(
                (y(exponent) - expected).abs() < 1e-4,
                "{exponent}: {}",
                y(exponent)
            );
        }
    }

    #[test]
    fn shine_is_brightest_half_way_between_light_and_eye() {
        // Row 15: (N . H)^c, of light 60 degrees off: the half way vector is 30 degrees off.
        let [_, y] = places(0.5, &[("detail", "blinn"), ("exponent", "4")]);
        assert!((y - 0.75_f64.powi(2)).abs() < 1e-4, "{y}");
        // Row 17: with the whole weight on the normal it is light; with none, light along the strand to its root.
        let y = |weight| {
            places(
                0.5,
                &[
                    ("detail", "weighted"),
                    ("exponent", "1"),
                    ("weight", weight),
                ],
            )[1]
        };
        assert!((y("1") - 0.5).abs() < 1e-4, "{}", y("1"));
        assert!((y("0") - 0.75_f64.sqrt()).abs() < 1e-4, "{}", y("0"));
        // Between both the sum of normal and tangent is made a unit vector.
        let half = (0.5 + 0.75_f64.sqrt()) / 2.0_f64.sqrt();
        assert!((y("0.5") - half).abs() < 1e-4, "{}", y("0.5"));
    }

    #[test]
    fn gradients_run_along_and_across() {
        assert!((places(0.5, &[("detail", "along")])[1] - 0.5).abs() < 1e-6);
        assert!((places(0.5, &[("detail", "across")])[1] - 0.625).abs() < 1e-6);
    }

    #[test]
    fn colours_are_multiplied_added_or_taken() {
        let mut blue = sample(1.0);
        blue.color = vec![vec3([0.0, 0.0, 0.5])];
        let color = |mode| {
            let settings = [
                ("tones", r#"[(0, "FF00FF")]"#),
                ("mode", mode),
                ("rim_width", "0"),
            ];
            painted(&blue, &settings).to_array()
        };
        assert_eq!(color("multiply"), [0.0, 0.0, 0.5]);
        assert_eq!(color("add"), [1.0, 0.0, 1.5]);
        assert_eq!(color("replace"), [1.0, 0.0, 1.0]);
        // Without a ramp the hair is as it was.
        assert_eq!(
            painted(&blue, &[("tones", "none"), ("rim_width", "0")]).to_array(),
            [0.0, 0.0, 0.5]
        );
    }

    #[test]
    fn a_rim_lies_at_the_side_of_the_light() {
        let rim = |w: f32, side: f32| {
            let mut samples = sample(0.5);
            samples.w = vec![w];
            let facing = (1.0 - w * w).max(0.0).sqrt();
            samples.tube = vec![vec3([w, 0.0, facing])];
            samples.light_direction = vec![vec3([side, 0.0, 0.0])];
            painted(
                &samples,
                &[
                    ("tones", "none"),
                    ("rim", "\"00FF00\""),
                    ("rim_width", "0.3"),
                ],
            )
            .to_array()
                == [0.0, 1.0, 0.0]
        };
        assert!(rim(0.9, 1.0) && rim(-0.9, -1.0));
        assert!(!rim(0.5, 1.0) && !rim(-0.9, 1.0));
    }
}
