// What a hand does that draws a line: it doesn't keep still.

/// A random number from -1 to 1 of a corner of a lattice.
fn corner(at: vec3<f32>) -> f32 {
    // Beyond 32,768 steps from the head all are alike.
    let index = clamp(at + vec3<f32>(32768.0), vec3<f32>(0.0), vec3<f32>(65535.0));
    return random_signed(hash(u32(index.x)) ^ u32(index.y), u32(index.z));
}

/// A steady number from -1 to 1 that runs smoothly through space, from random one to random one.
fn tremble(place: vec3<f32>) -> f32 {
    let low = floor(place);
    let way = place - low;
    let t = way * way * (3.0 - 2.0 * way);
    let y = vec3<f32>(0.0, 1.0, 0.0);
    let z = vec3<f32>(0.0, 0.0, 1.0);
    let right = low + vec3<f32>(1.0, 0.0, 0.0);
    let near = mix(mix(corner(low), corner(right), t.x), mix(corner(low + y), corner(right + y), t.x), t.y);
    let far = mix(mix(corner(low + z), corner(right + z), t.x), mix(corner(low + y + z), corner(right + y + z), t.x), t.y);
    return mix(near, far, t.z);
}
