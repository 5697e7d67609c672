//! Device timestamps around a dispatch.

use super::device::Gpu;
use super::error::GpuError;

/// Bytes of the two timestamps of a dispatch.
pub(super) const STAMPS: u64 = 16;

/// Two timestamp queries and the buffer they are resolved to.
pub(super) struct Clock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    /// Nanoseconds per tick.
    period: f64,
}

impl Clock {
    /// Creates the queries. The device must have `TIMESTAMP_QUERY`.
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        let queries = gpu.guarded("the timestamps", || {
            gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("raydsl"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            })
        })?;
        Ok(Self {
            queries,
            resolved: gpu.buffer("timestamps", STAMPS, usage)?,
            period: f64::from(gpu.queue.get_timestamp_period()),
        })
    }

    /// Returns the timestamp writes of a compute pass.
    pub(super) fn writes(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    /// Records the copy of both timestamps to `at` in `staging`.
    pub(super) fn copy(&self, encoder: &mut wgpu::CommandEncoder, staging: &wgpu::Buffer, at: u64) {
        encoder.resolve_query_set(&self.queries, 0..2, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, staging, at, STAMPS);
    }

    /// Returns the time between two timestamps. Some drivers let the clock run backwards at times.
    pub(super) fn milliseconds(&self, stamps: &[u8]) -> f64 {
        let ticks = |at: usize| bytemuck::pod_read_unaligned::<u64>(&stamps[at..at + 8]);
        ticks(8).saturating_sub(ticks(0)) as f64 * self.period * 1e-6
    }
}
