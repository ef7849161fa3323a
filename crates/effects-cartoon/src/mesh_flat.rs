//! Two flat tones by light, with an edge that is exact in each sample.

effects::effect!("mesh_flat");

/// `mesh.flat`: paints meshes in their colours of light and shade, sample by sample.
pub struct MeshFlat;

impl effects::MeshEffect for MeshFlat {
    type Program = Program;
    const ID: &'static str = "mesh.flat";
    const DOC: &'static str =
        "meshes in two flat tones, light and shade, with a smooth edge between them";

    fn reads(params: &Params, input: effects::SampleInput) -> bool {
        match input {
            effects::SampleInput::Color => params.light.w <= 0.0,
            effects::SampleInput::ShadeColor => params.shade.w <= 0.0,
            _ => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::on_mesh::painted;

    #[test]
    fn it_conforms() {
        effects_testkit::assert_mesh_conforms::<MeshFlat>();
    }

    #[test]
    fn light_turns_to_shade_at_the_threshold() {
        for step in -20..=20 {
            let cosine = f64::from(step) / 20.0 + 0.01;
            let [red, _, blue] = painted::<MeshFlat>(cosine as f32, &[("threshold", "0.3")]);
            let is_lit = cosine >= 0.3;
            assert_eq!([red, blue], if is_lit { [1.0, 0.0] } else { [0.0, 1.0] });
        }
        // A soft edge, its middle at the threshold.
        let [red, ..] = painted::<MeshFlat>(0.35, &[("threshold", "0.3"), ("softness", "0.2")]);
        assert!((red - 0.75).abs() < 1e-5, "{red}");
    }

    #[test]
    fn colours_of_its_own_come_first() {
        let own = [("light", "\"FFFFFF\""), ("shade", "\"000000\"")];
        assert_eq!(painted::<MeshFlat>(1.0, &own), [1.0; 3]);
        assert_eq!(painted::<MeshFlat>(-1.0, &own), [0.0; 3]);
    }
}
