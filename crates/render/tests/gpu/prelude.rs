//! Every function of the shared prelude gives the same on a graphics card as in Rust.

use crate::scene::{Numbers, driver_gpu};
use effects::wgsl::{self, Vec3, vec2, vec3};
use render::gpu::Gpu;

const PRELUDE: &str = include_str!("../../../../shaders/prelude.wgsl");

/// Joints that are tried at once.
const COUNT: usize = 4096;

type Four = [f32; 4];

/// A function: its WGSL on four numbers `v` from -1 to 1, the same in Rust, and how far they may be apart, as a share of
/// values above 1.
struct Case {
    name: &'static str,
    wgsl: &'static str,
    rust: fn(Four) -> Four,
    tolerance: f32,
}

fn one(value: f32) -> Four {
    [value, 0.0, 0.0, 0.0]
}

fn three(v: Vec3<f32>) -> Four {
    let [x, y, z] = v.to_array();
    [x, y, z, 0.0]
}

/// A whole number from one of `v`, alike on both sides: exactly representable.
fn whole(x: f32) -> u32 {
    (x.abs() * 65536.0) as u32
}

const CASES: &[Case] = &[
    Case {
        name: "hash",
        wgsl: "vec4<f32>(f32(hash(u32(abs(v.x) * 65536.0)) >> 8u), 0.0, 0.0, 0.0)",
        rust: |v| one((wgsl::hash(whole(v[0])) >> 8) as f32),
        tolerance: 0.0,
    },
    Case {
        name: "random",
        wgsl: "vec4<f32>(random(u32(abs(v.x) * 65536.0), u32(abs(v.y) * 65536.0)), 0.0, 0.0, 0.0)",
        rust: |v| one(wgsl::random(whole(v[0]), whole(v[1]))),
        tolerance: 0.0,
    },
    Case {
        name: "random_signed",
        wgsl: "vec4<f32>(random_signed(u32(abs(v.x) * 65536.0), 3u), 0.0, 0.0, 0.0)",
        rust: |v| one(wgsl::random_signed(whole(v[0]), 3)),
        tolerance: 1e-6,
    },
    Case {
        name: "bits_of",
        wgsl: "vec4<f32>(f32(bits_of(v.x) >> 16u), f32(bits_of(v.x) & 0xffffu), 0.0, 0.0)",
        rust: |v| {
            let bits: u32 = wgsl::bits_of(v[0]);
            [(bits >> 16) as f32, (bits & 0xffff) as f32, 0.0, 0.0]
        },
        tolerance: 0.0,
    },
    Case {
        name: "of_bits",
        wgsl: "vec4<f32>(of_bits(0x3f000000u + u32(abs(v.x) * 65536.0) * 256u), 0.0, 0.0, 0.0)",
        rust: |v| one(wgsl::of_bits(0x3f00_0000 + whole(v[0]) * 256)),
        tolerance: 0.0,
    },
    Case {
        name: "sin_pi",
        wgsl: "vec4<f32>(sin_pi(8.0 * v.x), 0.0, 0.0, 0.0)",
        rust: |v| one(wgsl::sin_pi(8.0 * v[0])),
        tolerance: 1e-6,
    },
    Case {
        name: "power_of_two",
        wgsl: "vec4<f32>(power_of_two(20.0 * v.x), power_of_two(126.0 * abs(v.y)), power_of_two(-1e9), 0.0)",
        rust: |v| {
            let large = wgsl::power_of_two(126.0 * v[1].abs());
            [
                wgsl::power_of_two(20.0 * v[0]),
                large,
                wgsl::power_of_two(-1e9),
                0.0,
            ]
        },
        tolerance: 1e-6,
    },
    Case {
        name: "log_to_two",
        wgsl: "vec4<f32>(log_to_two(abs(v.x) * 1000.0), log_to_two(power_of_two(126.0 * v.y)), 0.0, 0.0)",
        rust: |v| {
            [
                wgsl::log_to_two(v[0].abs() * 1000.0),
                wgsl::log_to_two(wgsl::power_of_two(126.0 * v[1])),
                0.0,
                0.0,
            ]
        },
        tolerance: 3e-6,
    },
    Case {
        name: "power",
        wgsl: "vec4<f32>(power(abs(v.x), 40.0 * abs(v.y)), power(0.0, v.z), 0.0, 0.0)",
        rust: |v| {
            [
                wgsl::power(v[0].abs(), 40.0 * v[1].abs()),
                wgsl::power(0.0, v[2]),
                0.0,
                0.0,
            ]
        },
        tolerance: 1e-5,
    },
    Case {
        name: "shrink_to_tail",
        wgsl: "vec4<f32>(shrink_to_tail(abs(v.x), abs(v.y)), shrink_to_tail(abs(v.x), 1.0), 0.0, 0.0)",
        rust: |v| {
            let u = v[0].abs();
            [
                wgsl::shrink_to_tail(u, v[1].abs()),
                wgsl::shrink_to_tail(u, 1.0),
                0.0,
                0.0,
            ]
        },
        tolerance: 1e-5,
    },
    Case {
        name: "swell",
        wgsl: "vec4<f32>(swell(abs(v.x), abs(v.y)), 0.0, 0.0, 0.0)",
        rust: |v| one(wgsl::swell(v[0].abs(), v[1].abs())),
        tolerance: 1e-6,
    },
    Case {
        name: "unit_or",
        wgsl: "vec4<f32>(unit_or(v.xyz, vec3<f32>(0.0, 1.0, 0.0)), unit_or(vec3<f32>(0.0), v.xyz).x)",
        rust: |v| {
            let own = vec3([v[0], v[1], v[2]]);
            let [x, y, z, _] = three(wgsl::unit_or(own, vec3([0.0, 1.0, 0.0])));
            [x, y, z, wgsl::unit_or(vec3([0.0; 3]), own).x]
        },
        tolerance: 1e-6,
    },
    Case {
        name: "perpendicular",
        wgsl: "vec4<f32>(perpendicular(unit_or(v.xyz, vec3<f32>(0.0, 0.0, -1.0))), 0.0)",
        rust: |v| {
            let down = vec3([0.0, 0.0, -1.0]);
            three(wgsl::perpendicular(wgsl::unit_or(
                vec3([v[0], v[1], v[2]]),
                down,
            )))
        },
        // Near the pole a rounding error of the direction turns it.
        tolerance: 1e-4,
    },
    Case {
        name: "rounded",
        wgsl: "vec4<f32>(rounded(unit_or(v.xyz, vec3<f32>(0.0, 1.0, 0.0)), unit_or(v.yzx, vec3<f32>(1.0, 0.0, 0.0)), abs(v.w)), 0.0)",
        rust: |v| {
            let normal = wgsl::unit_or(vec3([v[0], v[1], v[2]]), vec3([0.0, 1.0, 0.0]));
            let tube = wgsl::unit_or(vec3([v[1], v[2], v[0]]), vec3([1.0, 0.0, 0.0]));
            three(wgsl::rounded(normal, tube, v[3].abs()))
        },
        // Normals against each other leave little of their sum.
        tolerance: 1e-4,
    },
    Case {
        name: "feather_place",
        wgsl: "vec4<f32>(feather_place(u32(abs(v.x) * 32.0), 32u), 0.0, 0.0, 0.0)",
        rust: |v| one(wgsl::feather_place((v[0].abs() * 32.0) as u32, 32)),
        tolerance: 1e-6,
    },
    Case {
        name: "feather_share",
        wgsl: "vec4<f32>(feather_share(v.x, v.y, v.z), feather_share(v.x, v.y, v.y), 0.0, 0.0)",
        rust: |v| {
            let hard = wgsl::feather_share(v[0], v[1], v[1]);
            [wgsl::feather_share(v[0], v[1], v[2]), hard, 0.0, 0.0]
        },
        tolerance: 1e-4,
    },
    Case {
        name: "flat_end",
        wgsl: "vec4<f32>(flat_end(abs(v.x), v.yz), 0.0, 0.0, 0.0)",
        rust: |v| one(wgsl::flat_end(v[0].abs(), vec2([v[1], v[2]]))),
        tolerance: 1e-5,
    },
    Case {
        name: "at_flat_end",
        wgsl: "vec4<f32>(at_flat_end(v.x, v.y, v.yx, 1.0 + v.w, vec2<f32>(v.z, 1.0)), 0.0, 0.0)",
        rust: |v| {
            let shift = vec2([v[2], 1.0]);
            let across = vec2([v[1], v[0]]);
            let place = wgsl::at_flat_end(v[0], v[1], across, 1.0 + v[3], shift);
            [place.x, place.y, 0.0, 0.0]
        },
        tolerance: 1e-4,
    },
    Case {
        name: "clump_disc",
        wgsl: "vec4<f32>(clump_disc(u32(abs(v.x) * 3.0), 1.0 + v.y, vec2<f32>(v.z, 0.5)), 0.0)",
        rust: |v| {
            let instance = (v[0].abs() * 3.0) as u32;
            three(wgsl::clump_disc(instance, 1.0 + v[1], vec2([v[2], 0.5])))
        },
        tolerance: 1e-4,
    },
    Case {
        name: "color_or",
        wgsl: "vec4<f32>(color_or(v, vec3<f32>(0.5, 0.25, 0.125)), 0.0)",
        rust: |[x, y, z, w]| {
            three(wgsl::color_or(
                wgsl::Vec4 { x, y, z, w },
                vec3([0.5, 0.25, 0.125]),
            ))
        },
        tolerance: 0.0,
    },
    Case {
        name: "without_hairlines",
        wgsl: "vec4<f32>(without_hairlines(abs(v.x), abs(v.y), 0.6 * abs(v.z)), 0.0, 0.0, 0.0)",
        rust: |v| {
            one(wgsl::without_hairlines(
                v[0].abs(),
                v[1].abs(),
                0.6 * v[2].abs(),
            ))
        },
        tolerance: 1e-4,
    },
];

#[test]
fn every_function_of_the_prelude_is_tried() {
    let names = PRELUDE
        .lines()
        .filter_map(|line| line.strip_prefix("fn ")?.split('(').next());
    for name in names {
        assert!(
            CASES.iter().any(|case| case.name == name),
            "`{name}` has no case"
        );
    }
}

#[test]
fn functions_agree() {
    let Some(gpu) = driver_gpu() else { return };
    let mut numbers = Numbers::new(77);
    let mut inputs: Vec<Four> = (0..COUNT)
        .map(|_| [(); 4].map(|()| 2.0 * numbers.next() - 1.0))
        .collect();
    // Edges: zeros, ends, equal numbers, the pole of `perpendicular`.
    let edges = [
        [0.0; 4],
        [1.0; 4],
        [-1.0; 4],
        [0.0, 0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0, 1.0],
        [0.5, 0.5, 1.0, -1.0],
    ];
    inputs[..edges.len()].copy_from_slice(&edges);
    for case in CASES {
        let found = on_card(&gpu, case.wgsl, &inputs);
        for (input, found) in inputs.iter().zip(found) {
            let expected = (case.rust)(*input);
            for (a, b) in found.iter().zip(expected) {
                let allowed = case.tolerance * b.abs().max(1.0);
                assert!(
                    (a - b).abs() <= allowed,
                    "{}{input:?}: {found:?}, not {expected:?}",
                    case.name
                );
            }
        }
    }
    gpu.check().unwrap();
}

/// The expression's value for each input.
fn on_card(gpu: &Gpu, expression: &str, inputs: &[Four]) -> Vec<Four> {
    let text = format!(
        "{PRELUDE}
        @group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;
        @group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;
        @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
            let v = inputs[id.x];
            outputs[id.x] = {expression};
        }}"
    );
    let device = &gpu.device;
    let buffer = |usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: size_of_val(inputs) as u64,
            usage,
            mapped_at_creation: false,
        })
    };
    let input = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST);
    let output = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read_back = buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
    gpu.queue
        .write_buffer(&input, 0, bytemuck::cast_slice(inputs));
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: input.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: output.as_entire_binding(),
            },
        ],
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups((inputs.len() / 64) as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&output, 0, &read_back, 0, output.size());
    gpu.queue.submit([encoder.finish()]);
    read_back.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let view = read_back.get_mapped_range(..).unwrap();
    bytemuck::cast_slice(&view).to_vec()
}
