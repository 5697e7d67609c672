//! A device and its queue, with every failure converted to a [`GpuError`].

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::Poll;
use std::time::Duration;

use super::answers::{Answers, poll_once};
use super::error::{GpuError, one_line};
use super::scopes::Scopes;

/// The relevant limits, read once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Caps {
    /// Largest storage binding, a multiple of 4; lowered by `with_max_binding_bytes`.
    pub(super) max_binding: u64,
    /// Largest buffer.
    pub(super) max_buffer: u64,
    /// Storage buffers in the compute stage.
    pub(super) max_storage_buffers: u32,
    /// Largest uniform binding.
    pub(super) max_uniform: u64,
    /// Alignment of a storage binding's offset.
    pub(super) alignment: u64,
    /// Workgroups per dispatch in x or y.
    pub(super) max_groups: u32,
    /// Whether compute passes can be timed by the device.
    pub(super) timestamps: bool,
}

/// Uniform bindings of every kernel: its parameters and the job.
const UNIFORM_BINDINGS: u32 = 2;

impl Caps {
    fn of(device: &wgpu::Device) -> Self {
        let limits = device.limits();
        // wgpu 30 also limits the sum of uniform and storage buffers, to 28 by default.
        let together = limits
            .max_buffers_and_acceleration_structures_per_shader_stage
            .saturating_sub(UNIFORM_BINDINGS);
        Self {
            max_binding: limits.max_storage_buffer_binding_size & !3,
            max_buffer: limits.max_buffer_size,
            max_storage_buffers: limits.max_storage_buffers_per_shader_stage.min(together),
            max_uniform: limits.max_uniform_buffer_binding_size,
            alignment: u64::from(limits.min_storage_buffer_offset_alignment).max(4),
            max_groups: limits.max_compute_workgroups_per_dimension,
            timestamps: device.features().contains(wgpu::Features::TIMESTAMP_QUERY),
        }
    }
}

/// Errors that the device reported outside any error scope.
#[derive(Default, Debug)]
struct Faults {
    /// The reason of a device loss, which is permanent.
    lost: Mutex<Option<String>>,
    /// The first uncaptured error, returned to the next caller.
    stray: Mutex<Option<GpuError>>,
}

/// A device, its queue, its limits and the record of its faults.
#[derive(Debug)]
pub(super) struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) caps: Caps,
    pub(super) timeout: Duration,
    faults: Arc<Faults>,
    pub(super) answers: Answers,
}

impl Gpu {
    /// Wraps a device without touching its callbacks, which may be the application's.
    ///
    /// All calls made here run inside error scopes, so that nothing reaches those callbacks.
    pub(super) fn new(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let caps = Caps::of(&device);
        let timeout = Duration::from_secs(60);
        Self { device, queue, caps, timeout, faults: Arc::default(), answers: Answers::default() }
    }

    /// Installs callbacks on a device created by this crate: wgpu's default one panics.
    pub(super) fn watch(&self) {
        let faults = Arc::clone(&self.faults);
        self.device.set_device_lost_callback(move |reason, text| {
            *lock(&faults.lost) = Some(format!("{reason:?} {text}").trim_end().to_owned());
        });
        let faults = Arc::clone(&self.faults);
        self.device.on_uncaptured_error(Arc::new(move |error| {
            let first = typed(error, "a call outside every error scope");
            lock(&faults.stray).get_or_insert(first);
        }));
    }

    /// Returns the recorded error of the device, if any.
    pub(super) fn check(&self) -> Result<(), GpuError> {
        if let Some(reason) = lock(&self.faults.lost).clone() {
            return Err(GpuError::DeviceLost { reason });
        }
        match lock(&self.faults.stray).take() {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    /// Returns the first error of earlier calls whose answer came since: in a browser only, where
    /// no call can wait for its own.
    pub(super) fn arrived(&self) -> Option<GpuError> {
        self.answers.arrived().map(|error| self.cause(error))
    }

    /// Waits until every call so far is answered and returns the first error.
    pub(super) async fn answered(&self) -> Option<GpuError> {
        self.answers.all().await.map(|error| self.cause(error))
    }

    /// Runs `work` inside error scopes and returns the errors caught. A browser tells them later:
    /// then [`Gpu::arrived`] or [`Gpu::answered`] returns them.
    ///
    /// Scopes belong to a thread, so `work` must stay on this one.
    pub(super) fn guarded<T>(&self, what: &str, work: impl FnOnce() -> T) -> Result<T, GpuError> {
        let what = what.to_owned();
        self.explained(|| (work(), move |error| std::future::ready(typed(error, &what))))
    }

    /// Does the same for `work` that returns, beside what it makes, a function that converts an
    /// error.
    pub(super) fn explained<T, F, E>(&self, work: impl FnOnce() -> (T, F)) -> Result<T, GpuError>
    where
        F: FnOnce(wgpu::Error) -> E + wgpu::WasmNotSend + 'static,
        E: Future<Output = GpuError> + wgpu::WasmNotSend,
    {
        let scopes = Scopes::open(&self.device);
        let (made, explain) = work();
        let caught = scopes.close();
        let answer = async {
            match caught.await {
                Some(error) => Some(explain(error).await),
                None => None,
            }
        };
        match self.answers.now(answer) {
            Some(error) => Err(self.cause(error)),
            None => Ok(made),
        }
    }

    /// Replaces an error by the loss of the device, if that is why a call was refused.
    ///
    /// A lost device creates invalid objects silently, and only their use is an error.
    fn cause(&self, error: GpuError) -> GpuError {
        if !matches!(error, GpuError::Rejected { .. }) || self.responds() {
            return error;
        }
        self.poll();
        match self.check() {
            Err(known @ GpuError::DeviceLost { .. }) => known,
            _ => lost("it refuses every call"),
        }
    }

    /// Lets the device call back, as it does with the reason of its loss.
    pub(super) fn poll(&self) {
        let _ = catch_unwind(AssertUnwindSafe(|| self.device.poll(wgpu::PollType::Poll)));
    }

    /// Returns whether the device still creates a small buffer. A browser tells of a lost one by
    /// its callback.
    fn responds(&self) -> bool {
        let scopes = Scopes::open(&self.device);
        let probe = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("probe"),
            size: 4,
            usage: wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&probe, 0, &[0; 4]);
        match poll_once(&mut Box::pin(scopes.close())) {
            Poll::Ready(refused) => refused.is_none(),
            Poll::Pending => lock(&self.faults.lost).is_none(),
        }
    }

    /// Creates a buffer of at least `bytes` bytes, rounded up to a multiple of 4 and never empty.
    pub(super) fn buffer(
        &self,
        name: &str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let size = bytes.max(4).next_multiple_of(4);
        if size > self.caps.max_buffer {
            return Err(GpuError::BufferTooLarge {
                name: name.to_owned(),
                bytes: size,
                limit: self.caps.max_buffer,
            });
        }
        let descriptor =
            wgpu::BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false };
        let what = format!("{name} ({size} bytes)");
        self.guarded(&what, || self.device.create_buffer(&descriptor))
    }

    /// Waits for a submission, at most the context's timeout.
    pub(super) fn wait(&self, index: wgpu::SubmissionIndex) -> Result<(), GpuError> {
        let poll =
            wgpu::PollType::Wait { submission_index: Some(index), timeout: Some(self.timeout) };
        // wgpu panics in `poll` when the driver reports a lost device during the wait; it has
        // recorded the loss before and its state is consistent, so the panic can be treated as a
        // report.
        let polled = catch_unwind(AssertUnwindSafe(|| self.device.poll(poll)));
        self.check()?;
        match polled {
            Ok(Ok(_)) => Ok(()),
            Ok(Err(wgpu::PollError::Timeout)) => {
                Err(GpuError::Timeout { seconds: self.timeout.as_secs_f64() })
            }
            // The submission was never accepted, without an error in a scope: wgpu ignores calls on
            // a lost device.
            Ok(Err(error)) => Err(lost(&error.to_string())),
            Err(_) => Err(lost("the driver failed while waiting")),
        }
    }
}

/// Returns the error for the loss of the device without a reason from a callback.
pub(super) fn lost(reason: &str) -> GpuError {
    GpuError::DeviceLost { reason: reason.to_owned() }
}

/// Converts wgpu's error to a [`GpuError`].
pub(super) fn typed(error: wgpu::Error, what: &str) -> GpuError {
    let what = what.to_owned();
    match error {
        wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory { what },
        wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => {
            GpuError::Rejected { what, message: one_line(&description) }
        }
    }
}

/// Locks a mutex; a panic elsewhere has not left a cache inconsistent.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
