//! Samples of a mesh for tests of what paints it.

use effects::wgsl::vec3;
use effects::{MeshEffect, Registry, Samples, Values};

/// A sample of a mesh that is red in the light and blue in the shade and faces the eye, with light at this cosine.
pub(crate) fn sample(cosine: f32) -> Samples {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    Samples {
        color: vec![vec3([1.0, 0.0, 0.0])],
        shade_color: vec![vec3([0.0, 0.0, 1.0])],
        normal: vec![vec3([0.0, 0.0, 1.0])],
        occlusion: vec![0.0],
        depth: vec![4.0],
        head_depth: vec![5.0],
        light_direction: vec![vec3([0.0, sine, cosine])],
        view_direction: vec![vec3([0.0, 0.0, 1.0])],
        ..Samples::default()
    }
}

/// What an effect paints there, with these parameters.
pub(crate) fn painted<E: MeshEffect>(cosine: f32, settings: &[(&str, &str)]) -> [f32; 3] {
    painted_sample::<E>(&sample(cosine), settings)
}

/// What an effect paints of a sample.
pub(crate) fn painted_sample<E: MeshEffect>(
    samples: &Samples,
    settings: &[(&str, &str)],
) -> [f32; 3] {
    let mut registry = Registry::new();
    registry.register_mesh::<E>().unwrap();
    let effect = registry.get(E::ID).unwrap();
    let mut values = Values::defaults(effect.params());
    for (name, text) in settings {
        values.set_text(E::ID, name, text).unwrap();
    }
    let mut colors = Vec::new();
    effect.program(&values).paint(samples, 0..1, 0, &mut colors);
    colors[0].to_array()
}
