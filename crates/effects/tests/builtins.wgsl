//! inputs: u
// Every builtin and construct that effects may use, for `wgsl.rs`.

struct Params {
    /// A number.
    /// @unit metres @range -1..2.5 @default 0.5
    number: f32,
    /// A whole number.
    /// @range 1..9 @default 3
    count: u32,
    /// A choice.
    /// @choices first second @default second
    kind: u32,
    /// A colour.
    /// @default "FF0000"
    color: vec3<f32>,
    /// A colour or none.
    /// @default none
    other_color: vec4<f32>,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    return Stroke(vec2<f32>(joint.u), f32(instance), params.number, params.color);
}

fn t_smoothstep(low: f32, high: f32, x: f32) -> f32 { return smoothstep(low, high, x); }
fn t_smoothstep_vec(low: vec3<f32>, high: vec3<f32>, x: vec3<f32>) -> vec3<f32> { return smoothstep(low, high, x); }
fn t_sqrt(x: f32) -> f32 { return sqrt(x); }
fn t_clamp(x: f32, low: f32, high: f32) -> f32 { return clamp(x, low, high); }
fn t_saturate(x: f32) -> f32 { return saturate(x); }
fn t_abs(x: f32) -> f32 { return abs(x); }
fn t_sign(x: f32) -> f32 { return sign(x); }
fn t_floor(x: f32) -> f32 { return floor(x); }
fn t_ceil(x: f32) -> f32 { return ceil(x); }
fn t_trunc(x: f32) -> f32 { return trunc(x); }
fn t_min(a: f32, b: f32) -> f32 { return min(a, b); }
fn t_max(a: f32, b: f32) -> f32 { return max(a, b); }
fn t_mix(a: f32, b: f32, t: f32) -> f32 { return mix(a, b, t); }
fn t_mix_vec(a: vec3<f32>, b: vec3<f32>, t: f32) -> vec3<f32> { return mix(a, b, t); }
fn t_dot(a: vec3<f32>, b: vec3<f32>) -> f32 { return dot(a, b); }
fn t_cross(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> { return cross(a, b); }
fn t_length(a: vec3<f32>) -> f32 { return length(a); }
fn t_distance(a: vec2<f32>, b: vec2<f32>) -> f32 { return distance(a, b); }
fn t_normalize(a: vec3<f32>) -> vec3<f32> { return normalize(a); }
fn t_select(a: f32, b: f32, c: bool) -> f32 { return select(a, b, c); }
fn t_select_vec(a: vec3<f32>, b: vec3<f32>, c: bool) -> vec3<f32> { return select(a, b, vec3<bool>(c)); }

fn t_zeroed(assign: bool) -> f32 {
    var x: f32;
    if (assign) { x = 4.0; }
    return x;
}

fn t_loop_sum(n: u32) -> u32 {
    var sum: u32;
    for (var i = 0u; i < n; i++) {
        if (i == 3u) { continue; }
        if (i == 8u) { break; }
        sum += i;
    }
    return sum;
}

fn t_switch(x: u32) -> f32 {
    switch x {
        case 0u: { return 10.0; }
        case 1u, 2u: { return 20.0; }
        default: { return 30.0; }
    }
}

fn t_wrap(x: u32) -> u32 { return x * 0x7feb352du + 0xffffffffu; }
fn t_shift(x: u32) -> u32 { return (x << 3u) ^ (x >> 31u); }
fn t_to_u(x: f32) -> u32 { return u32(x); }
fn t_to_f(x: u32) -> f32 { return f32(x); }
fn t_swizzle(v: vec3<f32>) -> vec3<f32> { return v.zxy; }
fn t_component(v: vec3<f32>) -> vec3<f32> {
    var w = v;
    w.y = 9.0;
    return w;
}
