// Takes stretches and gaps of a layer's strokes away that are too short, as they are seen: closing and opening of
// grayscale morphology. What crates/effects/src/smooth.rs does, joint by joint: it says why.

@group(0) @binding(4) var<storage, read> gpu_clumps: array<GpuClump>;
@group(0) @binding(5) var<storage, read_write> gpu_discs: array<GpuDisc>;
/// For each disc the least size in the window that begins there, and in the one that ends there.
@group(0) @binding(6) var<storage, read_write> windows: array<vec2<f32>>;

/// The joints of a strand's pieces that follow each other, and its stroke's first disc as if joint 0 had one. Joints that two
/// pieces share count once, as those of the piece before.
struct Run {
    first: u32,
    last: u32,
    disc: u32,
    length: f32,
}

fn run_of(joint: u32, instance: u32) -> Run {
    let first = gpu_joints[joint * GPU_JOINT_WORDS + GPU_AT_RUN];
    let last = gpu_joints[joint * GPU_JOINT_WORDS + GPU_AT_RUN + 1u];
    let whole = seen(last) - seen(first);
    // Of a short strand no more than a third counts as short.
    let length = min(gpu_word(GPU_SHORTEST) * gpu_word(GPU_HEAD_HEIGHT), whole / 3.0);
    return Run(first, last, gpu_first_disc(instance), length);
}

fn window(run: Run, joint: u32) -> u32 {
    return run.disc + joint - gpu_first_disc(0u) - gpu_words[GPU_FIRST_JOINT];
}

fn before(joint: u32) -> u32 {
    return joint - gpu_joints[joint * GPU_JOINT_WORDS + GPU_AT_RUN + 2u];
}

fn after(joint: u32) -> u32 {
    return joint + gpu_joints[joint * GPU_JOINT_WORDS + GPU_AT_RUN + 3u];
}

/// The joint itself, or the same one of the piece before.
fn counted(joint: u32) -> u32 {
    return joint - gpu_joints[joint * GPU_JOINT_WORDS + GPU_AT_RUN + 4u];
}

fn seen(joint: u32) -> f32 {
    return gpu_scalar(joint, GPU_AT_SEEN_LENGTH);
}

/// The size at a joint; negated while gaps are closed.
fn size(run: Run, joint: u32, sign: f32) -> f32 {
    return sign * gpu_discs[run.disc + joint].radius;
}

fn between(run: Run, joint: u32, place: f32, sign: f32) -> f32 {
    let next = after(joint);
    let way = (place - seen(joint)) / (seen(next) - seen(joint));
    let start = size(run, joint, sign);
    let end = size(run, next, sign);
    // Rounding may reach beyond.
    return clamp(start + way * (end - start), min(start, end), max(start, end));
}

/// The least value from `joint` to the window's length after it. In a closed strand the windows at its end are its last
/// one, in an open one they reach beyond.
fn least_after(run: Run, joint: u32, sign: f32, is_closed: bool) -> f32 {
    let end = seen(joint) + run.length;
    var least = size(run, joint, sign);
    for (var j = after(joint); j <= run.last; j = after(j)) {
        if (seen(j) > end) {
            return min(least, between(run, before(j), end, sign));
        }
        least = min(least, size(run, j, sign));
    }
    if (is_closed) {
        return least_before(run, run.last, sign);
    }
    return least;
}

fn least_before(run: Run, joint: u32, sign: f32) -> f32 {
    let start = seen(joint) - run.length;
    var least = size(run, joint, sign);
    for (var j = joint; j > run.first; j = before(j)) {
        let earlier = before(j);
        if (seen(earlier) < start) {
            return min(least, between(run, earlier, start, sign));
        }
        least = min(least, size(run, earlier, sign));
    }
    return least;
}

fn least_before_in_closed(run: Run, joint: u32, sign: f32) -> f32 {
    if (seen(joint) - run.length < seen(run.first)) {
        // The first window, unless the strand begins just there.
        return least_after(run, run.first, sign, false);
    }
    return least_before(run, joint, sign);
}

/// The greatest of the windows that hold a joint.
fn opened(run: Run, joint: u32) -> f32 {
    let place = seen(joint);
    var greatest = windows[window(run, joint)].x;
    greatest = max(greatest, windows[window(run, joint)].y);
    for (var j = after(joint); j <= run.last; j = after(j)) {
        if (seen(j) > place + run.length) {
            break;
        }
        greatest = max(greatest, windows[window(run, j)].y);
    }
    for (var j = joint; j > run.first; j = before(j)) {
        let earlier = before(j);
        if (seen(earlier) < place - run.length) {
            break;
        }
        greatest = max(greatest, windows[window(run, earlier)].x);
    }
    return greatest;
}

@compute @workgroup_size(64)
fn find_gaps(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = gpu_index(group, groups, local);
    if (index >= gpu_words[GPU_JOINT_COUNT]) { return; }
    let joint = gpu_words[GPU_FIRST_JOINT] + index;
    let run = run_of(joint, group.z);
    windows[window(run, joint)] = vec2<f32>(least_after(run, joint, -1.0, false), least_before(run, joint, -1.0));
}

@compute @workgroup_size(64)
fn close_gaps(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = gpu_index(group, groups, local);
    if (index >= gpu_words[GPU_JOINT_COUNT]) { return; }
    let joint = gpu_words[GPU_FIRST_JOINT] + index;
    let run = run_of(joint, group.z);
    if (run.length > 0.0) {
        gpu_discs[run.disc + joint].radius = -opened(run, counted(joint));
    }
}

@compute @workgroup_size(64)
fn find_specks(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = gpu_index(group, groups, local);
    if (index >= gpu_words[GPU_JOINT_COUNT]) { return; }
    let joint = gpu_words[GPU_FIRST_JOINT] + index;
    let run = run_of(joint, group.z);
    windows[window(run, joint)] = vec2<f32>(least_after(run, joint, 1.0, true), least_before_in_closed(run, joint, 1.0));
}

/// Takes specks away, and turns sizes into pixels.
@compute @workgroup_size(64)
fn open_specks(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = gpu_index(group, groups, local);
    if (index >= gpu_words[GPU_JOINT_COUNT]) { return; }
    let joint = gpu_words[GPU_FIRST_JOINT] + index;
    let run = run_of(joint, group.z);
    let at = run.disc + joint;
    var radius = gpu_discs[at].radius;
    if (run.length > 0.0) {
        radius = opened(run, counted(joint));
    }
    if (gpu_frame.is_semicircle != 0u && joint == run.last && gpu_scalar(joint, GPU_AT_U) == 1.0) {
        gpu_discs[at].center += gpu_ahead(joint, radius, gpu_clumps[joint].radius);
    }
    gpu_discs[at].radius = min(radius * gpu_unit_px(joint), GPU_LARGEST_PX);
    if (gpu_words[GPU_HAS_OWN_PATHS] != 0u && group.z == 0u) {
        gpu_discs[joint] = gpu_discs[at];
        for (var k = 1u; k < GPU_CLUMP_DISCS; k++) {
            gpu_discs[k * gpu_frame.joints + joint].radius = 0.0;
        }
    }
}
