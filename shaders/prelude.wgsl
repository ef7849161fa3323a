// What every effect can use: the stroke it returns, and functions whose answers are the same on every
// processor. WGSL's own sin and pow are good to 2^-11 only, and differ from driver to driver.

/// One disc of a stroke, at one joint of its path. All colours are linear light.
struct Stroke {
    /// Shift of the disc's centre on the screen (x right, y down), in 1/300 of the head's height.
    offset: vec2<f32>,
    /// Radius in 1/300 of the head's height. Below 0 counts as 0; 0 draws nothing.
    radius: f32,
    /// Added to the layer's own depth offset, in head heights; positive is farther.
    depth_offset: f32,
    /// Linear red, green and blue.
    color: vec3<f32>,
}

/// What the layers share of a strand's joint: the preset's `clump` section makes it.
struct Clump {
    /// Unit normal (5.4), in the world.
    normal: vec3<f32>,
    /// Radius in 1/300 of the head's height (5.3).
    radius: f32,
    /// Linear basic colour.
    color: vec3<f32>,
    /// How far from the strand its strokes are drawn on the screen, in the world, 1/300 of the head's height. Their depth
    /// stays the strand's.
    shift: vec3<f32>,
}

/// Where a painted sample looks a texture up.
struct Lookup {
    /// The parameter that is the texture.
    texture: u32,
    /// Place in it: 0 to 1 from left to right and from top to bottom; of a gradient the place of its stops, and of its rows.
    at: vec2<f32>,
    /// How much of a picture's width a pixel covers: what is smaller is blurred. 0 blurs nothing.
    size: f32,
}

const PI: f32 = 3.1415927;

/// A well mixed number from `value` (a 32-bit finaliser in the family of Murmur's).
fn hash(value: u32) -> u32 {
    var h = value;
    h = (h ^ (h >> 16u)) * 0x7feb352du;
    h = (h ^ (h >> 15u)) * 0x846ca68bu;
    return h ^ (h >> 16u);
}

/// A number from 0 (included) to 1 (excluded), the same for the same `seed` and `index`.
fn random(seed: u32, index: u32) -> f32 {
    return f32(hash(seed ^ hash(index + 0x9e3779b9u)) >> 8u) * 0.000000059604645;
}

/// A number from -1 to 1, the same for the same `seed` and `index`.
fn random_signed(seed: u32, index: u32) -> f32 {
    return random(seed, index) * 2.0 - 1.0;
}

/// The 32 bits of a number.
fn bits_of(x: f32) -> u32 {
    return bitcast<u32>(x);
}

/// The number that has these bits. Not every 32 bits are a finite one.
fn of_bits(bits: u32) -> f32 {
    return bitcast<f32>(bits);
}

/// sin(pi x) within 2e-7, for |x| up to 1e6. Exactly 0 at whole numbers.
fn sin_pi(x: f32) -> f32 {
    // Fold to r in [-1/2, 1/2], where a Taylor polynomial of degree 11 is enough.
    let turns = floor(x + 0.5);
    let r = x - turns;
    let odd = turns - 2.0 * floor(turns * 0.5);
    let z = r * r;
    let series = 3.1415927 + z * (-5.1677128 + z * (2.5501640
        + z * (-0.5992645 + z * (0.0821459 + z * -0.0073704))));
    return r * series * (1.0 - 2.0 * odd);
}

/// The power of two 2^x within 3e-7 of its size, from x = -126 to 127; beyond, as at these ends.
fn power_of_two(x: f32) -> f32 {
    let y = clamp(x, -126.0, 127.0);
    let whole = floor(y + 0.5);
    // e^(f ln 2) for f in [-1/2, 1/2], by its series.
    let f = (y - whole) * 0.6931472;
    let series = 1.0 + f * (1.0 + f * (0.5 + f * (0.16666667 + f * (0.041666668
        + f * (0.008333334 + f * 0.0013888889)))));
    return series * of_bits(u32(i32(whole) + 127) << 23u);
}

/// The logarithm of `x` to base 2, within 2e-6 or 3e-7 of its size, for x from 2^-126 on; below it
/// counts as 2^-126.
fn log_to_two(x: f32) -> f32 {
    // x = m 2^e with m in [1/sqrt(2), sqrt(2)), by the bits that x has more than 1/sqrt(2).
    let bits = bits_of(max(x, 1.1754944e-38));
    let more = bits - 0x3f3504f3u;
    let m = of_bits(bits - (more & 0xff800000u));
    let e = f32(i32(more) >> 23u);
    // 2 / ln 2 (z + z^3 / 3 + ...) with z = (m - 1) / (m + 1), |z| < 0.172.
    let z = (m - 1.0) / (m + 1.0);
    let w = z * z;
    return e + z * (2.8853901 + w * (0.9617967 + w * (0.5770780 + w * (0.4121986 + w * 0.3205989))));
}

/// `x` to the power `y` within 2e-5 of its size, for x and y of 0 or more; 0 to any power is 0.
fn power(x: f32, y: f32) -> f32 {
    return select(power_of_two(y * log_to_two(x)), 0.0, x <= 0.0);
}

/// Size of a stroke that shrinks to its tail from a point on (5.1), as a share of its full size.
///
/// `u` and `start` are places along the strand, 0 at the root and 1 at the tip; `start` = 1 never
/// shrinks. Erratum: the source prints (i - x) / (num - x), which would grow; its text and Fig 5.3a
/// shrink, so this is (num - i) / (num - x).
fn shrink_to_tail(u: f32, start: f32) -> f32 {
    if (u < start || start >= 1.0) {
        return 1.0;
    }
    return saturate((1.0 - u) / (1.0 - start));
}

/// Size of a stroke that swells and tapers as a sine (5.2), as a share of its full size.
///
/// `u` is the place along the strand, 0 at the root and 1 at the tip; `offset` is where in the
/// sine's half turn the root lies, 0 to 1.
fn swell(u: f32, offset: f32) -> f32 {
    return max(sin_pi(offset + u * (1.0 - offset)), 0.0);
}

/// A unit vector across unit vector `along`, which turns steadily with it but at one pole, -z:
/// no field of perpendiculars does without one, and few strands grow straight out of the face.
fn perpendicular(along: vec3<f32>) -> vec3<f32> {
    // Frisvad, "Building an Orthonormal Basis from a 3D Unit Vector Without Normalization" (2012).
    // 1 / (1 + z) would cancel near the pole; there it is (1 - z) / (x^2 + y^2).
    let sideways = along.x * along.x + along.y * along.y;
    if (sideways < 1e-20 && along.z < 0.0) {
        return vec3<f32>(1.0, 0.0, 0.0);
    }
    let a = select((1.0 - along.z) / max(sideways, 1e-20), 1.0 / (1.0 + abs(along.z)), along.z >= 0.0);
    return vec3<f32>(1.0 - along.x * along.x * a, -along.x * along.y * a, -along.x);
}

/// `v` at unit length, or `otherwise` where `v` has no length.
fn unit_or(v: vec3<f32>, otherwise: vec3<f32>) -> vec3<f32> {
    let squared = dot(v, v);
    if (squared > 1e-30) {
        return v / sqrt(squared);
    }
    return otherwise;
}

/// A normal between the clump's, at `roundness` 0, and that of the stroke as a round tube, at 1.
fn rounded(normal: vec3<f32>, tube: vec3<f32>, roundness: f32) -> vec3<f32> {
    return unit_or(mix(normal, tube, vec3<f32>(roundness)), normal);
}

/// Where stroke `instance` of `count` side by side lies across the clump, in its radius: from -1 to 1.
/// Strokes of radius 1 / `count` there span the clump's width (5.5).
fn feather_place(instance: u32, count: u32) -> f32 {
    return (2.0 * f32(instance) + 1.0) / f32(count) - 1.0;
}

/// Size of a feather (5.6), as a share of its basic size: 1 where `gray` is at most `full`, shrinking to
/// nothing at `edge`. A hard step at `edge` where that is not above `full`.
///
/// Erratum: the source prints (1 - |gray - full|) / |edge - full|, which is not 0 at the edge; this is
/// 1 - |gray - full| / |edge - full|. For a region of large grays, pass all three negated.
fn feather_share(gray: f32, full: f32, edge: f32) -> f32 {
    if (edge <= full) {
        return select(0.0, 1.0, gray <= edge);
    }
    if (gray <= full) {
        return 1.0;
    }
    if (gray >= edge) {
        return 0.0;
    }
    return saturate((edge - gray) / (edge - full));
}

/// How flat a clump of `radius` looks that is moved by `shift` (`clump_shift`): 0 where it is seen from beside, up to 1 where a flat one
/// is seen along the strand.
fn flat_end(radius: f32, shift: vec2<f32>) -> f32 {
    return saturate(length(shift) / max(radius, 1e-6));
}

/// Where a disc of radius `size` lies on the screen, against the clump's own, to touch the outer side of the ellipse that a flat
/// clump is at its end. `place` is that across the clump, from -1 to 1, along the unit vector `across`.
fn at_flat_end(place: f32, size: f32, across: vec2<f32>, radius: f32, shift: vec2<f32>) -> vec2<f32> {
    let flat = flat_end(radius, shift);
    let out = sqrt(max(1.0 - place * place, 0.0)) * (1.0 - flat) + flat;
    return place * radius * across - (out * radius - size) / max(length(shift), 1e-6) * shift;
}

/// Disc `instance` of the three that a clump is made of, as place on the screen and radius. Seen from beside it is the clump's own
/// alone. A flat clump that is seen along the strand is an ellipse, of which a wider one lies to the middle of the outer side, and
/// one to each side of it: so clumps in a row have an even outline.
fn clump_disc(instance: u32, radius: f32, shift: vec2<f32>) -> vec3<f32> {
    let end = smoothstep(0.2, 0.7, flat_end(radius, shift));
    var side = 0.0;
    var size = (1.0 + 0.5 * end) * radius;
    if (instance > 0u) {
        side = select(1.0, -1.0, instance == 1u);
        size = 0.5 * end * radius;
    }
    let across = vec2<f32>(-shift.y, shift.x) / max(length(shift), 1e-6);
    let place = at_flat_end(0.62 * side, size, across, radius, shift);
    return vec3<f32>(place.x, place.y, size);
}

/// The colour of a parameter that may be none, or `otherwise`.
fn color_or(color: vec4<f32>, otherwise: vec3<f32>) -> vec3<f32> {
    if (color.w > 0.0) {
        return vec3<f32>(color.x, color.y, color.z);
    }
    return otherwise;
}

/// A share of a radius `full` without hairlines: nothing where less than the radius `thinnest` would be
/// left, full where all is. A pen draws no thinner lines, and those thinner than a pixel would flicker.
fn without_hairlines(share: f32, full: f32, thinnest: f32) -> f32 {
    // Of what is thin itself, such as a clump's tip, at most the lesser half goes.
    let lost = select(0.5, thinnest / full, full > 2.0 * thinnest);
    return saturate((share - lost) / (1.0 - lost));
}
