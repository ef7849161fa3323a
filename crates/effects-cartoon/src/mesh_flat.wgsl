//! mesh: color, shade_color, normal, occlusion, light_direction

struct Params {
    /// The cosine between surface and light at which light turns to shade: below 0 shade is narrow, above 0 light is.
    /// @range -1..1 @default 0.1
    threshold: f32,
    /// How soft the edge between both is: the cosines over which one runs into the other. 0 is a hard edge.
    /// @range 0..2 @default 0
    softness: f32,
    /// Colour in the light, or the mesh's own.
    /// @default none
    light: vec4<f32>,
    /// Colour in the shade, or the mesh's own.
    /// @default none
    shade: vec4<f32>,
}

fn paint(at: Sample, params: Params) -> vec3<f32> {
    let lit = dot(at.normal, at.light_direction) - at.occlusion - params.threshold;
    var share = select(0.0, 1.0, lit >= 0.0);
    if (params.softness > 0.0) {
        share = saturate(0.5 + lit / params.softness);
    }
    return mix(color_or(params.shade, at.shade_color), color_or(params.light, at.color), vec3<f32>(share));
}
