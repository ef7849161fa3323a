//! Buffers that grow with what is put into them, and never shrink.

use super::error::GpuError;
use wgpu::BufferUsages;

/// A buffer, made when it is first needed.
pub(super) struct Growing {
    what: &'static str,
    usage: BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

/// Least size, so that no binding is empty.
const LEAST: u64 = 256;

impl Growing {
    /// `what` names its contents in messages.
    pub(super) fn new(what: &'static str, usage: BufferUsages) -> Self {
        Self {
            what,
            usage,
            buffer: None,
        }
    }

    /// Grows to at least so many bytes; true where that took a new buffer, whose contents are lost.
    pub(super) fn reserve(&mut self, device: &wgpu::Device, bytes: u64) -> Result<bool, GpuError> {
        if self.size() >= bytes.max(LEAST) {
            return Ok(false);
        }
        let limits = device.limits();
        let most = limits
            .max_buffer_size
            .min(limits.max_storage_buffer_binding_size);
        if bytes > most {
            return Err(GpuError::TooLarge {
                what: self.what,
                bytes,
                most,
            });
        }
        // Half as much again: what grows a little every frame isn't made anew every frame.
        let size = (bytes + bytes / 2).clamp(LEAST, most.max(LEAST)) / 16 * 16;
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        self.buffer = None;
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(self.what),
            size: size.max(bytes),
            usage: self.usage,
            mapped_at_creation: false,
        });
        if let Some(error) = pollster::block_on(memory.pop()) {
            return Err(error.into());
        }
        self.buffer = Some(buffer);
        Ok(true)
    }

    /// Puts words at its start, growing as in [`Self::reserve`].
    pub(super) fn write(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        words: &[u32],
    ) -> Result<bool, GpuError> {
        let grown = self.reserve(device, size_of_val(words) as u64)?;
        if let (Some(buffer), false) = (&self.buffer, words.is_empty()) {
            queue.write_buffer(buffer, 0, bytemuck::cast_slice(words));
        }
        Ok(grown)
    }

    /// Its size in bytes, 0 before it is made.
    pub(super) fn size(&self) -> u64 {
        self.buffer.as_ref().map_or(0, wgpu::Buffer::size)
    }

    /// The buffer, once it is made.
    pub(super) fn get(&self) -> Option<&wgpu::Buffer> {
        self.buffer.as_ref()
    }

    /// Gives its memory back.
    pub(super) fn drop_buffer(&mut self) {
        self.buffer = None;
    }
}

/// All buffers of a renderer but for those of its clumps and layers.
pub(super) struct Buffers {
    pub(super) frame: Growing,
    pub(super) sample_places: Growing,
    pub(super) joints: Growing,
    pub(super) strands: Growing,
    pub(super) clumps: Growing,
    pub(super) discs: Growing,
    pub(super) windows: Growing,
    pub(super) chunks: Growing,
    pub(super) tables: Growing,
    pub(super) corners: Growing,
    pub(super) triangles: Growing,
    pub(super) counters: Growing,
    pub(super) starts: Growing,
    pub(super) entries: Growing,
    pub(super) picture: Growing,
}

impl Buffers {
    pub(super) fn new() -> Self {
        let storage = BufferUsages::STORAGE;
        let filled = |what| Growing::new(what, storage | BufferUsages::COPY_DST);
        let uniform = |what| Growing::new(what, BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        let made = |what| Growing::new(what, storage);
        let read = |what| Growing::new(what, storage | BufferUsages::COPY_SRC);
        Self {
            frame: uniform("settings"),
            sample_places: uniform("sample places"),
            joints: filled("joints"),
            strands: filled("strands"),
            clumps: made("clumps"),
            discs: filled("strokes' discs"),
            windows: made("smoothing windows"),
            chunks: filled("pieces of strands"),
            tables: filled("tables"),
            corners: filled("surfaces' corners"),
            triangles: filled("triangles"),
            counters: filled("tiles' counters"),
            starts: read("tiles' places"),
            entries: made("tiles' lists"),
            picture: read("samples"),
        }
    }

    pub(super) fn all(&self) -> [&Growing; 15] {
        [
            &self.frame,
            &self.sample_places,
            &self.joints,
            &self.strands,
            &self.clumps,
            &self.discs,
            &self.windows,
            &self.chunks,
            &self.tables,
            &self.corners,
            &self.triangles,
            &self.counters,
            &self.starts,
            &self.entries,
            &self.picture,
        ]
    }
}
