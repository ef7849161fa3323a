//! Devices that allow little: what doesn't fit is refused, and what is drawn after it is right.

use crate::agree::{on_cpu, share_beyond};
use crate::meshes;
use crate::scene::{Scene, camera, driver_gpu, noop};
use effects::{Image, Variation};
use glam::Vec2;
use render::gpu::{Gpu, GpuError, Offscreen, PassDepth, PassFormat, Renderer};
use render::{Coverage, EdgeChannel, Edges, SurfaceTexture, SurfaceVertex};
use std::sync::Arc;
use wgpu::CompareFunction::{Greater, GreaterEqual, Less, LessEqual};

/// A device that draws, with these limits. Nothing where there is no driver.
fn limited(required_limits: wgpu::Limits) -> Option<Offscreen> {
    driver_gpu()?;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let wanted = wgpu::DeviceDescriptor {
        required_limits,
        ..Default::default()
    };
    let device = pollster::block_on(adapters.first()?.request_device(&wanted));
    let (device, queue) = device.unwrap();
    Some(Offscreen::on(Gpu::with(device, queue)).unwrap())
}

/// Gives its surfaces a picture of such sides.
fn textured(mut scene: Scene, side: usize) -> Scene {
    let texels = vec![40_000_u16; 4 * side * side];
    let image = Arc::new(Image::from_srgb([side, side], &texels).unwrap());
    for surface in &mut scene.surfaces {
        surface.texture = Some(SurfaceTexture {
            image: image.clone(),
            repeats: false,
            places: vec![Vec2::ZERO; surface.vertices.len()],
            coverage: Coverage::Ignored,
        });
    }
    scene
}

/// Some buffers have been replaced by larger ones when another turns out to be too large.
#[test]
fn after_a_frame_that_does_not_fit_nothing_old_is_drawn() {
    let limits = wgpu::Limits {
        max_storage_buffer_binding_size: 1 << 20,
        ..Default::default()
    };
    let Some(mut card) = limited(limits) else {
        return;
    };
    let first = Scene::random(1);
    card.draw(&first.frame(), 1).unwrap();
    let mut large = Scene::random(1);
    let more = SurfaceVertex {
        position: Vec2::ZERO,
        inv_depth: 1.0,
        tone: 0.0,
    };
    large.surfaces[0].vertices.extend([more; 200]);
    large.camera = camera([400, 400]);
    let error = card.draw(&large.frame(), 1).unwrap_err();
    assert!(matches!(error, GpuError::TooLarge { .. }), "{error}");
    let mut moved = Scene::random(1);
    let [width, height] = moved.camera.size_px().map(|side| side as f32);
    for vertex in moved.surfaces.iter_mut().flat_map(|it| &mut it.vertices) {
        vertex.position = Vec2::new(width, height) - vertex.position;
    }
    let gpu = card.draw(&moved.frame(), 1).unwrap();
    assert!(share_beyond(&gpu, &on_cpu(&moved, 1), 0.01) < 0.003);
    assert!(share_beyond(&gpu, &on_cpu(&first, 1), 0.01) > 0.1);
}

#[test]
fn after_pictures_that_do_not_fit_a_frame_without_any_is_drawn() {
    let limits = wgpu::Limits {
        max_texture_dimension_2d: 4096,
        ..Default::default()
    };
    let Some(mut card) = limited(limits) else {
        return;
    };
    let plain = Scene::random(1);
    card.draw(&textured(Scene::random(1), 16).frame(), 1)
        .unwrap();
    let error = card.draw(&textured(Scene::random(1), 4096).frame(), 1);
    assert!(matches!(error, Err(GpuError::Limit { .. })), "{error:?}");
    let gpu = card.draw(&plain.frame(), 1).unwrap();
    assert!(share_beyond(&gpu, &on_cpu(&plain, 1), 0.01) < 0.003);
}

/// Textures that tiles write are needed only for what paints its samples.
#[test]
fn storage_textures_are_asked_for_where_samples_are_kept() {
    for most in [0, 1] {
        let limits = wgpu::Limits {
            max_storage_textures_per_shader_stage: most,
            ..Default::default()
        };
        let gpu = noop(limits);
        let mut renderer = Renderer::new(&gpu.device, &gpu.queue).unwrap();
        let pass = PassFormat {
            color: wgpu::TextureFormat::Rgba8Unorm,
            depth: None,
            samples: 1,
        };
        let mut prepare = |scene: &Scene| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            renderer.prepare(&mut encoder, &scene.frame(), 4, pass)
        };
        prepare(&Scene::random(1)).unwrap();
        let painted = |through: f32| {
            let mut scene = Scene::random(1);
            meshes::paint(&mut scene, &meshes::two("mesh.toon", "", through));
            scene
        };
        for (through, needs) in [(0.0, 1), (0.5, 2)] {
            let error = prepare(&painted(through)).err();
            let expected = (most < needs).then_some((most, needs));
            let found = error.map(|error| match error {
                GpuError::Limit { has, needs, .. } => (has as u32, needs as u32),
                other => panic!("{other}"),
            });
            assert_eq!(found, expected, "{most} textures, through hair {through}");
        }
        prepare(&Scene::random(1)).unwrap();
        gpu.check().unwrap();
    }
}

/// What clumps are is kept of each joint, once: no more than of discs, of which there are some a joint.
#[test]
fn clumps_take_no_more_than_their_joints() {
    let mut scene = Scene::random(1);
    scene.camera = camera([8, 8]);
    let limits = wgpu::Limits {
        max_storage_buffer_binding_size: 200 << 10,
        ..Default::default()
    };
    let mut card = Offscreen::on(noop(limits)).unwrap();
    card.draw(&scene.frame(), 1).unwrap();
}

/// Commands may be recorded ahead, submitted in any order, or dropped.
#[test]
fn prepared_frames_may_be_submitted_in_any_order() {
    let Some(gpu) = driver_gpu() else { return };
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).unwrap();
    let scene = Scene::random(2);
    let pass = PassFormat {
        color: wgpu::TextureFormat::Rgba8Unorm,
        depth: None,
        samples: 1,
    };
    let mut prepare = || {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let prepared = renderer.prepare(&mut encoder, &scene.frame(), 4, pass);
        prepared.unwrap();
        encoder.finish()
    };
    let wait = || {
        gpu.device
            .poll(wgpu::PollType::wait_indefinitely())
            .unwrap()
    };
    drop(prepare());
    for _ in 0..2 {
        let [a, b] = [prepare(), prepare()];
        gpu.queue.submit([b]);
        let c = prepare();
        gpu.queue.submit([a]);
        gpu.queue.submit([c]);
        wait();
        drop(prepare());
        let [a, b] = [prepare(), prepare()];
        gpu.queue.submit([a]);
        drop(b);
        wait();
        gpu.check().unwrap();
    }
    gpu.queue.submit([prepare()]);
    wait();
    drop(prepare());
    // Reports come all the same.
    if gpu
        .device
        .features()
        .contains(wgpu::Features::TIMESTAMP_QUERY)
    {
        assert!(renderer.stats().milliseconds.is_some());
    }
    gpu.check().unwrap();
}

#[test]
fn one_pixel_of_one_sample_shows_what_is_under_hair() {
    let Some(gpu) = driver_gpu() else { return };
    let mut card = Offscreen::on(gpu).unwrap();
    let mut scene = Scene::random(0);
    meshes::paint(&mut scene, &meshes::two("mesh.flat", "", 0.8));
    // All of the picture is hair before a wall.
    scene.camera = camera([1, 1]);
    scene.turn_by(0.0);
    for strand in &mut scene.strands {
        strand.size = 60.0;
    }
    for vertex in &mut scene.surfaces[0].vertices {
        vertex.position = Vec2::splat(500.0);
    }
    let corners = [(-9.0, -9.0), (0.0, 0.0), (20.0, -9.0), (-9.0, 20.0)];
    for (vertex, corner) in scene.surfaces[1].vertices.iter_mut().zip(corners) {
        (vertex.position, vertex.inv_depth) = (corner.into(), 0.2);
    }
    let (cpu, gpu) = (on_cpu(&scene, 1), card.draw(&scene.frame(), 1).unwrap());
    assert!(
        share_beyond(&cpu, &gpu, 2.0 / 255.0) == 0.0,
        "{cpu:?} {gpu:?}"
    );
    meshes::paint(&mut scene, &meshes::two("mesh.flat", "", 0.0));
    let without = on_cpu(&scene, 1);
    assert!(
        share_beyond(&cpu, &without, 2.0 / 255.0) == 1.0,
        "it is seen through hair"
    );
}

/// Lines are half on nothing: they are seen before what a pass is cleared to by every comparison.
#[test]
fn lines_over_nothing_are_drawn_in_every_pass() {
    let Some(gpu) = driver_gpu() else { return };
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).unwrap();
    let mut scene = Scene::random(2);
    scene.surfaces.clear();
    scene.background = None;
    scene.passes = vec![Edges {
        channel: EdgeChannel::Object,
        threshold: 1.0,
        step_m: 0.1,
        width_px: Variation::constant(7.0),
        seed: 1,
        fade_to: 0.0,
        color: [1.0, 0.0, 0.0],
    }];
    let [width, height] = scene.camera.size_px();
    let extent = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let mut drawn = |format: wgpu::TextureFormat, compare: wgpu::CompareFunction| {
        let is_reversed = matches!(compare, Greater | GreaterEqual);
        let pass = PassFormat {
            color: wgpu::TextureFormat::Rgba8Unorm,
            depth: Some(PassDepth {
                format,
                compare,
                mapping: if is_reversed {
                    [0.0, 0.05]
                } else {
                    [1.0, -0.05]
                },
            }),
            samples: 1,
        };
        let target = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: extent,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let color = target(pass.color, wgpu::TextureUsages::COPY_SRC);
        let depth = target(format, wgpu::TextureUsages::empty());
        let [color_view, depth_view] =
            [&color, &depth].map(|texture| texture.create_view(&Default::default()));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let prepared = renderer.prepare(&mut encoder, &scene.frame(), 4, pass);
        prepared.unwrap();
        let cleared = if is_reversed { 0.0 } else { 1.0 };
        let mut render_pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color_view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth_view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(cleared),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        renderer.render(&mut render_pass);
        drop(render_pass);
        let row = (4 * width).next_multiple_of(256);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row),
            rows_per_image: None,
        };
        let to = wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout,
        };
        encoder.copy_texture_to_buffer(color.as_image_copy(), to, extent);
        gpu.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |_| ());
        gpu.device
            .poll(wgpu::PollType::wait_indefinitely())
            .unwrap();
        gpu.check().unwrap();
        let bytes = buffer.get_mapped_range(..).unwrap();
        let rows = bytes.chunks_exact(row as usize);
        rows.flat_map(|row| row[..4 * width as usize].chunks_exact(4))
            .filter(|pixel| pixel[3] > 0)
            .count()
    };
    let whole = drawn(wgpu::TextureFormat::Depth32Float, LessEqual);
    assert!(whole > 500, "{whole}");
    for format in [
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureFormat::Depth24Plus,
    ] {
        for compare in [Less, LessEqual, Greater, GreaterEqual] {
            assert_eq!(drawn(format, compare), whole, "{format:?} {compare:?}");
        }
    }
}
