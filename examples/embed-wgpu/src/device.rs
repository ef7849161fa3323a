//! A device for a window or for pictures.

use crate::Outcome;
use render::gpu::Gpu;

/// A device that can draw to the surface, where there is one.
///
/// # Errors
///
/// When there is no driver, or it gives no device.
pub fn open(
    instance: &wgpu::Instance,
    surface: Option<&wgpu::Surface<'_>>,
) -> Outcome<(wgpu::Adapter, Gpu)> {
    let wanted = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        compatible_surface: surface,
        ..Default::default()
    };
    let adapter = pollster::block_on(instance.request_adapter(&wanted))?;
    // wgpu's default limits are enough for hair, but for large windows: there every sample takes 16 bytes, in one buffer.
    let most = adapter.limits();
    let wanted = wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits {
            max_buffer_size: most.max_buffer_size,
            max_storage_buffer_binding_size: most.max_storage_buffer_binding_size,
            max_texture_dimension_2d: most.max_texture_dimension_2d,
            ..Default::default()
        },
        ..Default::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&wanted))?;
    // A program with handlers of its own for errors and a lost device goes on using those in place of this.
    Ok((adapter, Gpu::with(device, queue)))
}
