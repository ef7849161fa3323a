// The exact geometry of a swept stroke, for the samples of a pixel four at a time. The formulae, and why they are
// written so, stand in crates/stroke-path/src/sweep.rs; names are the same.

/// A segment seen from a tile: positions count from the tile's upper left corner, in pixels.
struct Sweep {
    origin: vec2<f32>,
    axis: vec2<f32>,
    length: f32,
    inv_length: f32,
    radius: f32,
    smaller_radius: f32,
    shrink: f32,
    a: f32,
    inv_a: f32,
    beyond_apex: f32,
    body_end: f32,
    /// 0 for round ends, 1 where the path ends flat at the smaller disc, 2 at the larger.
    flat_end: f32,
}

/// Below this length and difference of radii, in pixels, two discs are one.
const SAME: f32 = 1e-6;
const NESTED: f32 = 1e-6;
const TINY: f32 = 1e-30;
/// Stands for 1 / 0, and is far from the largest number when multiplied.
const HUGE: f32 = 1e25;

/// The sweep from the larger circle, of a radius above 0, to a smaller radius. `along` is the way between their centres: not
/// worked out from places in the tile, which rounding has moved, as of discs that nearly coincide it tells the direction.
fn sweep(larger: vec3<f32>, smaller_radius: f32, along: vec2<f32>, flat_end: f32) -> Sweep {
    var span = length(along);
    var shrink = larger.z - smaller_radius;
    var axis = vec2<f32>(1.0, 0.0);
    var inverse = 0.0;
    if (span < SAME) {
        span = 0.0;
        shrink = select(shrink, 0.0, shrink < SAME);
    } else {
        axis = along / span;
        inverse = 1.0 / span;
    }
    let is_nested = span - shrink <= NESTED * span;
    let a = (span - shrink) * (span + shrink);
    return Sweep(
        larger.xy,
        axis,
        span,
        inverse,
        larger.z,
        smaller_radius,
        shrink,
        a,
        select(1.0 / max(a, TINY), HUGE, is_nested),
        select(span, 0.0, is_nested),
        select(a, -1.0, is_nested),
        // A sweep without length has no direction, and stays whole.
        select(flat_end, 0.0, span == 0.0),
    );
}

/// Samples in the segment's frame.
struct Local {
    x: vec4<f32>,
    y: vec4<f32>,
}

fn local_of(s: Sweep, x: vec4<f32>, y: vec4<f32>) -> Local {
    let dx = x - s.origin.x;
    let dy = y - s.origin.y;
    return Local(dx * s.axis.x + dy * s.axis.y, dy * s.axis.x - dx * s.axis.y);
}

/// Whether any disc covers the points; edges belong to the stroke.
fn covers(s: Sweep, p: Local) -> vec4<bool> {
    let beyond = p.x - s.length;
    let yy = p.y * p.y;
    let in_larger = p.x * p.x + yy <= vec4<f32>(s.radius * s.radius);
    if (s.flat_end == 1.0) {
        // A disc farther on is smaller than the one beside the point.
        let beside = s.radius - s.shrink * (p.x * s.inv_length);
        let in_trapezoid = (p.x <= vec4<f32>(s.length)) & (abs(p.y) <= beside);
        return (in_larger & (p.x <= vec4<f32>(0.0))) | (in_trapezoid & (p.x >= vec4<f32>(0.0)));
    }
    let in_smaller = beyond * beyond + yy <= vec4<f32>(s.smaller_radius * s.smaller_radius);
    let to_vertex = s.length * p.x - s.radius * s.shrink;
    let r = s.length * s.radius - s.shrink * p.x;
    let in_body = (r * r >= s.a * yy) & (to_vertex >= vec4<f32>(0.0)) & (to_vertex <= vec4<f32>(s.body_end));
    let in_disc = in_larger | in_smaller | in_body;
    // A disc farther back reaches as far ahead and is larger.
    return in_disc & ((p.x >= vec4<f32>(0.0)) | vec4<bool>(s.flat_end != 2.0));
}

/// The least and the greatest u whose discs cover the points, which are covered.
struct Interval {
    low: vec4<f32>,
    high: vec4<f32>,
}

fn interval(s: Sweep, p: Local) -> Interval {
    let b = s.radius * s.shrink - s.length * p.x;
    let yy = p.y * p.y;
    let c = p.x * p.x + yy - s.radius * s.radius;
    let r = s.length * s.radius - s.shrink * p.x;
    let q = abs(b) + sqrt(max(r * r - s.a * yy, vec4<f32>(0.0))) + TINY;
    let by_c = c / q;
    let by_a = q * s.inv_a;
    let is_positive = b > vec4<f32>(0.0);
    var low = select(by_c, -by_a, is_positive);
    var high = select(by_a, -by_c, is_positive);
    if (s.flat_end == 1.0) {
        low = max(low, p.x * s.inv_length);
    } else if (s.flat_end == 2.0) {
        high = min(high, p.x * s.inv_length);
    }
    return Interval(saturate(low), saturate(high));
}

/// For each point the u where distance over radius is least, and the square of that.
struct Nearest {
    u: vec4<f32>,
    ratio: vec4<f32>,
}

fn nearest(s: Sweep, p: Local) -> Nearest {
    let r = s.length * s.radius - s.shrink * p.x;
    let yy = p.y * p.y;
    let along = p.x - s.shrink * yy / select(vec4<f32>(1.0), r, r > vec4<f32>(0.0));
    let u = saturate(select(vec4<f32>(s.beyond_apex), along, r > vec4<f32>(0.0)) * s.inv_length);
    let radius = s.radius - s.shrink * u;
    let ahead = p.x - s.length * u;
    return Nearest(u, (ahead * ahead + yy) / (radius * radius + TINY));
}
