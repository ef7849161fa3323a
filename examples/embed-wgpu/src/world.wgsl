// The program's own meshes: flat facets, in light or in shadow.

struct World {
    clip_from_world: mat4x4<f32>,
    eye: vec3<f32>,
    /// The unit vector to the light.
    to_light: vec3<f32>,
}

@group(0) @binding(0) var<uniform> world: World;

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) @interpolate(flat) color: vec4<f32>,
}

@vertex
fn place(
    @location(0) position: vec3<f32>,
    @location(1) x: vec4<f32>,
    @location(2) y: vec4<f32>,
    @location(3) z: vec4<f32>,
    @location(4) origin: vec4<f32>,
    @location(5) color: vec4<f32>,
) -> Vertex {
    let placed = mat4x4<f32>(x, y, z, origin) * vec4<f32>(position, 1.0);
    return Vertex(world.clip_from_world * placed, placed.xyz, color);
}

@fragment
fn light(vertex: Vertex) -> @location(0) vec4<f32> {
    // A facet's normal, towards the eye.
    let across = normalize(cross(dpdx(vertex.position), dpdy(vertex.position)));
    let to_eye = world.eye - vertex.position;
    let normal = across * sign(dot(across, to_eye));
    let facing = dot(normal, world.to_light);
    let bright = 0.45 + 0.3 * smoothstep(0.18, 0.22, facing) + 0.25 * max(facing, 0.0);
    return vec4<f32>(vertex.color.rgb * bright, vertex.color.a);
}
