//! Tones of meshes by light from a ramp, sample by sample, with a second axis for detail (X-Toon).

use effects::SampleInput;

effects::effect!("mesh_toon");

/// `mesh.toon`: paints meshes by how light falls on them, sample by sample.
pub struct MeshToon;

impl effects::MeshEffect for MeshToon {
    type Program = Program;
    const ID: &'static str = "mesh.toon";
    const DOC: &'static str =
        "meshes painted by light: two, three or more tones, gradients, rims, highlights";

    fn reads(params: &Params, input: SampleInput) -> bool {
        let detail = |choices: &[u32]| choices.contains(&params.detail);
        let has_rim = params.rim.w > 0.0;
        match input {
            SampleInput::Depth => detail(&[Params::DETAIL_DEPTH]),
            SampleInput::HeadDepth => {
                detail(&[Params::DETAIL_DEPTH]) && params.depth_from == Params::DEPTH_FROM_HEAD
            }
            SampleInput::ViewDirection => {
                has_rim || detail(&[Params::DETAIL_FACING, Params::DETAIL_BLINN])
            }
            SampleInput::ShadeColor => params.mode == Params::MODE_BETWEEN,
            _ => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::on_mesh::{painted, painted_sample, sample};
    use effects::wgsl::vec3;

    #[test]
    fn it_conforms() {
        effects_testkit::assert_mesh_conforms::<MeshToon>();
    }

    /// A ramp whose red is the place of the stops and whose green is that of the rows.
    const PLACES: &str = r#"[(v: 0, stops: [(0, "000000"), (1, "FF0000")]), (v: 1, stops: [(0, "00FF00"), (1, "FFFF00")])]"#;

    fn places(cosine: f32, settings: &[(&str, &str)]) -> [f32; 2] {
        let mut all = vec![("tones", PLACES), ("mode", "replace")];
        all.extend(settings);
        let [red, green, _] = painted::<MeshToon>(cosine, &all);
        [red, green]
    }

    #[test]
    fn light_chooses_the_tone_to_a_255th() {
        // Row 11: x = max(N . L, 0), against double precision.
        for step in -20..=20 {
            let cosine = f64::from(step) / 20.0;
            let [x, y] = places(cosine as f32, &[]);
            assert!(
                (f64::from(x) - cosine.max(0.0)).abs() < 1.0 / 255.0,
                "{cosine}: {x}"
            );
            assert_eq!(y, 0.0);
        }
    }

    #[test]
    fn depth_is_1_near_and_0_far_on_a_logarithmic_scale() {
        // Row 13: y = 1 - log(z / near) / log(far / near), of a sample 4 head heights away, the head 5.
        let y = |near: &str, far: &str, from: &str| {
            let own = [("near", near), ("far", far), ("depth_from", from)];
            places(0.5, &[&[("detail", "depth")], &own[..]].concat())[1]
        };
        let expected = 1.0 - (4.0_f32 / 3.0).ln() / (8.0_f32 / 3.0).ln();
        assert!((y("3", "8", "eye") - expected).abs() < 1e-3);
        assert_eq!((y("4.5", "8", "eye"), y("1", "3.5", "eye")), (1.0, 0.0));
        let expected = 1.0 - (4.0_f32 / 3.5).ln() / (6.5_f32 / 3.5).ln();
        assert!((y("-1.5", "1.5", "head") - expected).abs() < 1e-3);
        // Where both are one it is a step.
        assert_eq!((y("3.9", "3.9", "eye"), y("4.1", "4.1", "eye")), (0.0, 1.0));
    }

    #[test]
    fn facing_is_a_power_of_the_cosine_to_the_eye() {
        // Row 14: y = |N . V|^r, with a normal 60 degrees off.
        let mut turned = sample(0.5);
        turned.normal = vec![vec3([0.75_f32.sqrt(), 0.0, 0.5])];
        for (exponent, expected) in [("0", 1.0), ("1", 0.5), ("2", 0.25)] {
            let settings = [
                ("tones", PLACES),
                ("mode", "replace"),
                ("detail", "facing"),
                ("exponent", exponent),
            ];
            let [_, y, _] = painted_sample::<MeshToon>(&turned, &settings);
            assert!((y - expected).abs() < 1e-4, "{exponent}: {y}");
        }
    }

    #[test]
    fn shine_is_brightest_half_way_between_light_and_eye() {
        // Row 15: (N . H)^c, of light 60 degrees off: the half way vector is 30 degrees off.
        let [_, y] = places(0.5, &[("detail", "blinn"), ("exponent", "4")]);
        assert!((y - 0.75_f32.powi(2)).abs() < 1e-4, "{y}");
        // Light from behind: there is no half way.
        let [_, y] = places(-1.0, &[("detail", "blinn"), ("exponent", "4")]);
        assert_eq!(y, 0.0);
    }

    #[test]
    fn tones_lie_between_shade_and_light_or_stand_alone() {
        let color = |mode, tone: &str| {
            let tones = format!("[(0, \"{tone}\")]");
            painted::<MeshToon>(1.0, &[("tones", &tones), ("mode", mode)])
        };
        assert_eq!(color("between", "000000"), [0.0, 0.0, 1.0], "shade");
        assert_eq!(color("between", "FFFFFF"), [1.0, 0.0, 0.0], "light");
        assert_eq!(color("multiply", "FF00FF"), [1.0, 0.0, 0.0]);
        assert_eq!(color("add", "0000FF"), [1.0, 0.0, 1.0]);
        assert_eq!(color("replace", "00FF00"), [0.0, 1.0, 0.0]);
        assert_eq!(
            painted::<MeshToon>(1.0, &[("tones", "none")]),
            [1.0, 0.0, 0.0]
        );
    }

    #[test]
    fn what_is_always_in_shadow_is_darker() {
        let mut hidden = sample(0.9);
        hidden.occlusion = vec![1.0];
        assert_eq!(painted_sample::<MeshToon>(&hidden, &[]), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_rim_lies_where_the_mesh_turns_away_at_the_side_of_the_light() {
        let shaded = |facing: f32, light: f32, occlusion: f32| {
            let mut turned = sample(0.5);
            turned.normal = vec![vec3([(1.0 - facing * facing).sqrt(), 0.0, facing])];
            turned.light_direction = vec![vec3([light, 0.0, 0.0])];
            turned.occlusion = vec![occlusion];
            let settings = [("rim", "\"00FF00\""), ("rim_width", "0.3")];
            painted_sample::<MeshToon>(&turned, &settings) == [0.0, 1.0, 0.0]
        };
        let rim = |facing, light| shaded(facing, light, 0.0);
        assert!(rim(0.2, 1.0));
        assert!(!rim(0.4, 1.0) && !rim(0.2, -1.0));
        // Not where no light comes: in the shadow of hair, or deep in a fold.
        assert!(shaded(0.2, 1.0, 0.5) && !shaded(0.2, 1.0, 1.0) && !shaded(0.2, 1.0, 3.0));
    }
}
