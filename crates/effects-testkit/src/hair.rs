//! Joints to try effects on: a head of hair as any preset has it, and joints as they never should be.

use crate::joint::Joint;
use effects::wgsl::{hash, vec2, vec3};
use glam::{Vec2, Vec3};

/// Height of the head, metres; its centre is the origin.
pub(crate) const HEAD_M: f32 = 0.24;

const STRANDS: u32 = 24;
/// Joints of a strand.
const JOINTS: usize = 16;
const EYE: Vec3 = Vec3::new(0.3, 0.15, 1.5);
const LIGHT: Vec3 = Vec3::new(0.7, 0.9, 0.6);

/// The points of the strands, from root to tip, metres: they leave the top of the head on all sides,
/// run down over it and hang from there.
pub(crate) fn strands() -> Vec<Vec<Vec3>> {
    let strand = |number: u32| {
        // Neighbours in the list are far from each other on the head.
        let (sine, cosine) = (2.4 * number as f32).sin_cos();
        let out = Vec3::new(sine, 0.0, cosine);
        let root = 0.15 + 0.9 * number as f32 / STRANDS as f32;
        let point = |i: usize| {
            let way = 1.6 * i as f32 / (JOINTS - 1) as f32;
            let angle = (root + way).min(1.6);
            let over = 0.14 * (angle.cos() * Vec3::Y + angle.sin() * out);
            over - 0.2 * (root + way - angle) * Vec3::Y
        };
        (0..JOINTS).map(point).collect()
    };
    (0..STRANDS).map(strand).collect()
}

/// The joints of all strands, each strand's from root to tip.
pub(crate) fn joints() -> Vec<Joint> {
    let strands = strands();
    let of_strand = |(id, points): (u32, &Vec<Vec3>)| -> Vec<Joint> {
        (0..points.len()).map(|i| joint(id, points, i)).collect()
    };
    (0..).zip(&strands).flat_map(of_strand).collect()
}

fn joint(strand: u32, points: &[Vec3], i: usize) -> Joint {
    let last = points.len() - 1;
    let step = |i: usize| (points[i + 1] - points[i]).normalize();
    let (forward, backward) = (step(i.min(last - 1)), -step(i.max(1) - 1));
    let position = points[i];
    let u = i as f32 / last as f32;
    // 5.4, with all of the correction.
    let outward = position.normalize();
    let normal = (outward - outward.dot(backward) * backward).normalize();
    // Across the strand too, but turned about it.
    let material_normal = 0.8 * normal + 0.6 * backward.cross(normal);
    let mean = points.iter().sum::<Vec3>() / points.len() as f32;
    let to_light = LIGHT - position;
    let light = to_light.normalize();
    let view = (EYE - position).normalize();
    // As the eye sees it, near enough: x right, y down.
    let ahead = Vec2::new(forward.x, -forward.y).normalize_or(Vec2::Y);
    Joint {
        position: vec3(position.to_array()),
        forward: vec3(forward.to_array()),
        backward: vec3(backward.to_array()),
        u,
        arc_length: points[..=i]
            .windows(2)
            .map(|pair| pair[0].distance(pair[1]))
            .sum(),
        strand,
        seed: hash(strand),
        strand_mean: vec3(mean.to_array()),
        head_center: vec3([0.0; 3]),
        head_height: HEAD_M,
        strand_size: 18.0,
        strand_taper: vec2([0.3, -1.0]),
        strand_color: vec3([0.6, 0.3, 0.1]),
        strand_tip_color: vec3([-1.0; 3]),
        light_direction: vec3(light.to_array()),
        light_distance: to_light.length() / HEAD_M,
        // As the eye sees it, near enough.
        light_on_screen: vec3([light.x, -light.y, light.z]),
        view_direction: vec3(view.to_array()),
        depth: EYE.distance(position) / HEAD_M,
        time: 0.7,
        across: vec2([-ahead.y, ahead.x]),
        path_weight: 0.3 + 0.7 * u,
        from_ends: vec2([i, last - i].map(|links| 0.02 * links as f32)),
        rest_position: vec3((position / HEAD_M).to_array()),
        rest_forward: vec3(forward.to_array()),
        unit: 0.8,
        normal: vec3(normal.to_array()),
        material_normal: vec3(material_normal.to_array()),
        clump_radius: 18.0 * (1.0 - u) * (0.3 + u),
        clump_color: vec3([0.2, 0.4, 0.8]),
        clump_shift: vec2([3.0 * u, -2.0]),
        gray: light.dot(normal).max(0.0),
    }
}

/// Joints that break what counts on good ones, each with what is bad about it.
pub(crate) fn hostile_joints() -> Vec<(&'static str, Joint)> {
    let good = joints()[5];
    let (to_eye, up) = (good.view_direction, vec3([0.0, 1.0, 0.0]));
    let across_the_view = vec3([to_eye.z, 0.0, -to_eye.x]);
    vec![
        ("an ordinary joint", good),
        (
            "a clump of no size",
            Joint {
                clump_radius: 0.0,
                ..good
            },
        ),
        (
            "a tiny clump",
            Joint {
                clump_radius: 1e-30,
                ..good
            },
        ),
        (
            "a huge clump",
            Joint {
                clump_radius: 1e6,
                ..good
            },
        ),
        (
            "a root",
            Joint {
                u: 0.0,
                arc_length: 0.0,
                ..good
            },
        ),
        ("a tip", Joint { u: 1.0, ..good }),
        (
            "a strand of no length",
            Joint {
                u: 0.0,
                arc_length: 0.0,
                from_ends: vec2([0.0; 2]),
                forward: up,
                backward: up,
                ..good
            },
        ),
        (
            "a strand 1000 km long",
            Joint {
                arc_length: 1e6,
                from_ends: vec2([1e6; 2]),
                ..good
            },
        ),
        (
            "a joint 1000 km away",
            Joint {
                position: vec3([1e6, -1e6, 1e6]),
                ..good
            },
        ),
        (
            "a grazing normal",
            Joint {
                normal: across_the_view,
                ..good
            },
        ),
        (
            "a normal that points at the eye",
            Joint {
                normal: to_eye,
                ..good
            },
        ),
        (
            "a normal that points away from the eye",
            Joint {
                normal: -to_eye,
                ..good
            },
        ),
        (
            "a normal along the strand",
            Joint {
                normal: good.forward,
                ..good
            },
        ),
        (
            "a strand that points at the eye",
            Joint {
                forward: to_eye,
                backward: -to_eye,
                ..good
            },
        ),
        (
            "a strand that turns back",
            Joint {
                backward: good.forward,
                ..good
            },
        ),
        (
            "light at the eye",
            Joint {
                light_direction: to_eye,
                ..good
            },
        ),
        (
            "light from behind the hair",
            Joint {
                light_direction: -to_eye,
                gray: 0.0,
                ..good
            },
        ),
        (
            "light along the normal",
            Joint {
                light_direction: good.normal,
                gray: 1.0,
                ..good
            },
        ),
        (
            "light against the normal",
            Joint {
                light_direction: -good.normal,
                light_on_screen: vec3([-good.normal.x, good.normal.y, -good.normal.z]),
                gray: 0.0,
                ..good
            },
        ),
        (
            "light inside the hair",
            Joint {
                light_distance: 0.0,
                ..good
            },
        ),
        (
            "light without a place",
            Joint {
                light_distance: 1e6,
                ..good
            },
        ),
        (
            "black hair",
            Joint {
                clump_color: vec3([0.0; 3]),
                ..good
            },
        ),
        (
            "hair that glows",
            Joint {
                clump_color: vec3([100.0; 3]),
                ..good
            },
        ),
        ("hair at the eye", Joint { depth: 0.0, ..good }),
        ("hair far away", Joint { depth: 1e6, ..good }),
        ("the last day of a long show", Joint { time: 1e6, ..good }),
        ("a picture of a speck of hair", Joint { unit: 1e4, ..good }),
        ("a picture of a hair's width", Joint { unit: 1e-4, ..good }),
        (
            "the last strand there can be",
            Joint {
                strand: u32::MAX,
                seed: hash(u32::MAX),
                ..good
            },
        ),
    ]
}
