//! A line of chalk, charcoal or pencil, as a sketcher draws it: broad, pressed and let go, blunt, and drawn beyond its ends.

effects::effect!("line_chalk");

/// `line.chalk`: lines of surfaces as sketched. Grain is the layer's brush (`charcoal`, `crayon`, `pencil`). Pressure goes to width and tone, and
/// strays are sideways, as offsets of W's strokes are (rows W3 and W5).
pub struct LineChalk;

impl effects::StrokeEffect for LineChalk {
    type Program = Program;
    const ID: &'static str = "line.chalk";
    const DOC: &'static str = "lines of surfaces by chalk or pencil: broad, pressed and let go, blunt, drawn beyond their ends";
    const RANK: i32 = -100;
    const IS_FOR_LINES: bool = true;

    fn follows_lines(params: &Params) -> bool {
        params.wobble > 0.0 || params.pressure > 0.0
    }

    fn reach(params: &Params) -> effects::Reach {
        if params.width == 0.0 {
            return effects::Reach::NOWHERE;
        }
        effects::Reach {
            clumps: 0.0,
            units: 0.5 * params.width + params.wobble + params.overshoot,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use effects::wgsl::{Stroke, vec2, vec3};
    use effects::{Joints, Registry, Strokes, Values};

    const HEAD_M: f32 = 0.3;
    const UNIT_M: f32 = HEAD_M / 300.0;

    /// A straight line to the right of so many joints, one unit apart, in this light.
    fn line(count: usize, cosine: f32) -> Joints {
        let whole = (count - 1) as f32;
        let at = |i: usize| i as f32 * UNIT_M;
        Joints {
            from_ends: (0..count)
                .map(|i| vec2([at(i), whole * UNIT_M - at(i)]))
                .collect(),
            rest_position: (0..count)
                .map(|i| vec3([i as f32 / 300.0, 0.2, -0.4]))
                .collect(),
            material_normal: vec![vec3([0.0, 0.0, 1.0]); count],
            light_direction: vec![vec3([0.0, (1.0 - cosine * cosine).sqrt(), cosine]); count],
            head_height: vec![HEAD_M; count],
            across: vec![vec2([0.0, 1.0]); count],
            ..Joints::default()
        }
    }

    fn drawn(joints: &Joints, set: &[(&str, &str)]) -> Vec<Stroke> {
        let mut registry = Registry::new();
        registry.register::<LineChalk>().unwrap();
        let effect = registry.get("line.chalk").unwrap();
        let mut values = Values::defaults(effect.params());
        for (name, text) in set {
            values.set_text("line.chalk", name, text).unwrap();
        }
        let mut strokes = Strokes::default();
        let all = 0..joints.from_ends.len();
        effect
            .program(&values)
            .evaluate(joints, all, 0, 1, &mut strokes);
        strokes.iter().collect()
    }

    const EVEN: [(&str, &str); 4] = [
        ("pressure", "0"),
        ("light", "0"),
        ("wobble", "0"),
        ("width", "6"),
    ];

    #[test]
    fn it_conforms() {
        effects_testkit::assert_conforms::<LineChalk>();
        effects_testkit::assert_steady::<LineChalk>(&[]);
    }

    #[test]
    fn lines_are_followed_where_the_hand_does_something() {
        let follows = |set: &[(&str, &str)]| {
            let mut registry = Registry::new();
            crate::register(&mut registry).unwrap();
            let ink = registry.get("line.ink").unwrap();
            let chalk = registry.get("line.chalk").unwrap();
            [ink, chalk].map(|effect| {
                let mut values = Values::defaults(effect.params());
                for (name, text) in set {
                    // Ink has no pressure.
                    if effect.params().iter().any(|param| param.name == *name) {
                        values.set_text(effect.id(), name, text).unwrap();
                    }
                }
                effect.program(&values).follows_lines()
            })
        };
        assert_eq!(follows(&[]), [true; 2]);
        assert_eq!(follows(&[("wobble", "0")]), [false, true]);
        let still = [("wobble", "0"), ("pressure", "0")];
        assert_eq!(follows(&still), [false; 2]);
    }

    #[test]
    fn ends_go_on_and_are_blunt() {
        let joints = line(201, 0.0);
        let discs = drawn(&joints, &EVEN);
        let places: Vec<f32> = (0..201).map(|i| i as f32 + discs[i].offset.x).collect();
        assert!((places[0] + 5.0).abs() < 1e-3, "{}", places[0]);
        assert!((places[200] - 205.0).abs() < 1e-3, "{}", places[200]);
        assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "no folds");
        assert_eq!(places[100], 100.0);
        assert!(discs.iter().all(|disc| disc.offset.y.abs() < 1e-6));
        assert!((discs[100].radius - 3.0).abs() < 1e-5);
        assert!(discs[0].radius > 2.0 && discs[0].radius < 2.2);
        // A line too short for that goes on by less, to both sides alike.
        let short = drawn(&line(7, 0.0), &EVEN);
        assert!(short[0].offset.x < -0.5 && short[0].offset.x > -5.0);
        assert!((short[0].offset.x + short[6].offset.x).abs() < 1e-5);
    }

    #[test]
    fn pressure_is_width_and_tone() {
        let set = [
            ("pressure", "1"),
            ("light", "0"),
            ("wobble", "0"),
            ("width", "6"),
            ("pressure_length", "0.05"),
            ("color", "\"000000\""),
            ("pale_color", "\"FFFFFF\""),
        ];
        let discs = drawn(&line(201, 0.0), &set);
        let inner = 20..180;
        let radii = discs[inner.clone()].iter().map(|disc| disc.radius);
        let [least, most] = [f32::min, f32::max].map(|of| radii.clone().reduce(of).unwrap());
        assert!(
            least >= 0.35 * 3.0 - 1e-4 && most <= 3.0 && most - least > 0.8,
            "{least} {most}"
        );
        for i in inner {
            let less = (3.0 - discs[i].radius) / (0.65 * 3.0);
            assert!(
                (discs[i].color.x - less).abs() < 1e-4,
                "{} {less}",
                discs[i].color.x
            );
        }
        // Light takes pressure away.
        let bright = drawn(
            &line(201, 1.0),
            &[("pressure", "0"), ("light", "1"), ("width", "6")],
        );
        assert!((bright[100].radius - 0.35 * 3.0).abs() < 1e-5);
    }

    #[test]
    fn hands_stray_within_their_limits() {
        let set = [("wobble", "3"), ("wobble_length", "0.05")];
        let discs = drawn(&line(401, 0.0), &set);
        let strays = discs[30..370].iter().map(|disc| disc.offset.y);
        let [least, most] = [f32::min, f32::max].map(|of| strays.clone().reduce(of).unwrap());
        assert!(
            least >= -3.0 && most <= 3.0 && most - least > 1.5,
            "{least} {most}"
        );
    }
}
