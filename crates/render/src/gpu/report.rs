//! What a graphics card tells of a frame, read back without waiting where nobody waits.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use wgpu::{BufferUsages, Device, Queue};

/// Passes whose time is taken.
const STAGES: usize = 3;
/// Bytes of the report: two totals, then as many timestamps as stages have beginnings and ends.
const TOTALS_BYTES: u64 = 8;
const TIMES_BYTES: u64 = 2 * STAGES as u64 * 8;

/// What the card tells of a frame: how many entries its tiles' lists needed, and the time of each stage.
pub(super) struct Report {
    read_back: wgpu::Buffer,
    times: Option<Times>,
    state: Arc<AtomicU8>,
}

struct Times {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    nanoseconds: f32,
}

/// States of the report's buffer: free for a frame; recorded for one, to be mapped once that is through; mapped.
const FREE: u8 = 0;
const RECORDED: u8 = 1;
const MAPPED: u8 = 2;

/// A report that is recorded. Where its commands are dropped without being submitted, it is free again.
struct Recorded(Option<Arc<AtomicU8>>);

impl Recorded {
    fn end_in(&mut self, state: u8) {
        if let Some(own) = self.0.take() {
            own.store(state, Ordering::Release);
        }
    }
}

impl Drop for Recorded {
    fn drop(&mut self) {
        self.end_in(FREE);
    }
}

impl Report {
    pub(super) fn new(device: &Device, queue: &Queue) -> Self {
        let buffer = |label, size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let has_times = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        Self {
            read_back: buffer(
                "report",
                TOTALS_BYTES + TIMES_BYTES,
                BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            ),
            times: has_times.then(|| Times {
                queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("stages"),
                    ty: wgpu::QueryType::Timestamp,
                    count: 2 * STAGES as u32,
                }),
                resolved: buffer(
                    "timestamps",
                    256,
                    BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
                ),
                nanoseconds: queue.get_timestamp_period(),
            }),
            state: Arc::default(),
        }
    }

    /// Whether the next frame's report can be recorded.
    pub(super) fn is_free(&self) -> bool {
        self.state() == FREE
    }

    fn state(&self) -> u8 {
        self.state.load(Ordering::Acquire)
    }

    fn set_state(&self, state: u8) {
        self.state.store(state, Ordering::Release);
    }

    pub(super) fn timestamps(&self, stage: u32) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let times = self.times.as_ref()?;
        Some(wgpu::ComputePassTimestampWrites {
            query_set: &times.queries,
            beginning_of_pass_write_index: Some(2 * stage),
            end_of_pass_write_index: Some(2 * stage + 1),
        })
    }

    /// Records the report of a frame, unless one is still to be read. It is mapped when these commands are through, whenever and in whatever order they
    /// are submitted.
    pub(super) fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        starts: &wgpu::Buffer,
        [columns, rows]: [u32; 2],
    ) {
        if !self.is_free() {
            return;
        }
        let tiles = u64::from(columns) * u64::from(rows);
        encoder.copy_buffer_to_buffer(starts, tiles * 4, &self.read_back, 0, 4);
        encoder.copy_buffer_to_buffer(starts, (2 * tiles + 1) * 4, &self.read_back, 4, 4);
        if let Some(times) = &self.times {
            encoder.resolve_query_set(&times.queries, 0..2 * STAGES as u32, &times.resolved, 0);
            let to = &self.read_back;
            encoder.copy_buffer_to_buffer(&times.resolved, 0, to, TOTALS_BYTES, TIMES_BYTES);
        }
        self.set_state(RECORDED);
        let mut recorded = Recorded(Some(Arc::clone(&self.state)));
        let read = wgpu::MapMode::Read;
        encoder.map_buffer_on_submit(&self.read_back, read, .., move |result| {
            recorded.end_in(if result.is_ok() { MAPPED } else { FREE });
        });
    }

    /// The entries that the tiles' lists needed, and the stages' milliseconds, where they are there.
    pub(super) fn read(&self, device: &Device) -> Option<([u32; 2], Option<[f64; 3]>)> {
        // Never waits. A device that is lost says so elsewhere.
        let _ = device.poll(wgpu::PollType::Poll);
        if self.state() != MAPPED {
            return None;
        }
        let report = {
            let view = self.read_back.get_mapped_range(..).ok()?;
            let totals: [u32; 2] = bytemuck::pod_read_unaligned(&view[..TOTALS_BYTES as usize]);
            let times: [u64; 2 * STAGES] =
                bytemuck::pod_read_unaligned(&view[TOTALS_BYTES as usize..]);
            let milliseconds = self.times.as_ref().map(|clock| {
                [0, 1, 2].map(|stage| {
                    let ticks = times[2 * stage + 1].saturating_sub(times[2 * stage]);
                    ticks as f64 * f64::from(clock.nanoseconds) * 1e-6
                })
            });
            (totals, milliseconds)
        };
        self.read_back.unmap();
        self.set_state(FREE);
        Some(report)
    }
}
