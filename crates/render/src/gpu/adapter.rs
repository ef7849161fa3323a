//! Graphics cards, and a device of our own on one.

use super::error::GpuError;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Which drivers may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AdapterKind {
    /// Graphics cards alone.
    Hardware,
    /// Graphics cards, or where there is none a driver that draws on the CPU.
    Any,
}

/// A device of our own.
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Name, driver and kind.
    pub info: wgpu::AdapterInfo,
    faults: Arc<Faults>,
}

/// What the device reported outside of any call.
#[derive(Default)]
struct Faults {
    first: Mutex<Option<GpuError>>,
}

impl Faults {
    fn first(&self) -> MutexGuard<'_, Option<GpuError>> {
        self.first.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, error: GpuError) {
        // What comes after follows from it.
        self.first().get_or_insert(error);
    }
}

impl Gpu {
    /// A device on the best graphics card that there is: discrete before integrated before virtual before software;
    /// among equals the one that the system names first.
    ///
    /// # Errors
    ///
    /// When there is none, or it gives no device.
    pub fn open(kind: AdapterKind) -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::PRIMARY,
            flags: flags(),
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        let best = adapters
            .into_iter()
            .filter(|adapter| {
                let is_software = adapter.get_info().device_type == wgpu::DeviceType::Cpu;
                !is_software || kind == AdapterKind::Any
            })
            .min_by_key(|adapter| preference(adapter.get_info().device_type));
        let Some(adapter) = best else {
            let software = kind == AdapterKind::Any;
            return Err(GpuError::NoAdapter { software });
        };
        Self::on(&adapter)
    }

    /// A device on that graphics card, with all that it can do.
    ///
    /// # Errors
    ///
    /// When it gives none.
    pub fn on(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let wanted = wgpu::DeviceDescriptor {
            label: Some("inkstrand"),
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&wanted)).map_err(|error| {
                GpuError::NoDevice {
                    adapter: info.name.clone(),
                    message: error.to_string(),
                }
            })?;
        Ok(Self::with(device, queue))
    }

    /// A device that is already there. Its errors and its loss are reported here from now on.
    #[must_use]
    pub fn with(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let faults = Arc::new(Faults::default());
        let noted = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| noted.note(error.into())));
        let noted = Arc::clone(&faults);
        device.set_device_lost_callback(move |reason, message| {
            let reason = match (reason, message.as_str()) {
                (wgpu::DeviceLostReason::Destroyed, _) => "it was given back".to_owned(),
                (_, "") => "its driver gives no reason".to_owned(),
                (_, message) => message.to_owned(),
            };
            noted.note(GpuError::Lost(reason));
        });
        Self {
            info: device.adapter_info(),
            device,
            queue,
            faults,
        }
    }

    /// The first thing that went wrong since the last call, if any.
    ///
    /// # Errors
    ///
    /// What the device reported.
    pub fn check(&self) -> Result<(), GpuError> {
        self.faults.first().take().map_or(Ok(()), Err)
    }
}

/// wgpu's own, but without names and lines in shaders unless `WGPU_DEBUG=1` asks for them: in a developer's build, to find the line of each
/// expression takes longer than all else that is done with a shader.
fn flags() -> wgpu::InstanceFlags {
    (wgpu::InstanceFlags::from_build_config() - wgpu::InstanceFlags::DEBUG).with_env()
}

fn preference(kind: wgpu::DeviceType) -> u32 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

/// What every device must allow, as wgpu names it.
pub(super) fn check_limits(device: &wgpu::Device) -> Result<(), GpuError> {
    let limits = device.limits();
    let needed = [
        (
            "storage buffers in a shader",
            limits.max_storage_buffers_per_shader_stage,
            8,
        ),
        (
            "invocations in a workgroup",
            limits.max_compute_invocations_per_workgroup,
            256,
        ),
        (
            "bytes that a workgroup shares",
            limits.max_compute_workgroup_storage_size,
            7_680,
        ),
        (
            "workgroups in a row",
            limits.max_compute_workgroups_per_dimension,
            65_535,
        ),
    ];
    for (what, has, needs) in needed {
        if has < needs {
            return Err(GpuError::Limit {
                what,
                has: has.into(),
                needs: needs.into(),
            });
        }
    }
    Ok(())
}
