//! The device with its caches, held by an application.

use std::fmt;
#[cfg(not(target_family = "wasm"))]
use std::path::Path;
use std::sync::Mutex;
#[cfg(not(target_family = "wasm"))]
use std::sync::OnceLock;
use std::time::Duration;

use super::buffers::Uploads;
use super::device::{Gpu, lock};
use super::error::{GpuError, one_line};
#[cfg(not(target_family = "wasm"))]
use super::exactness::Exactness;
use super::float_controls::FloatControls;
use super::pipeline::Checks;
#[cfg(not(target_family = "wasm"))]
use super::pipeline_file::PipelineFile;
use super::pipelines::Pipelines;
use super::slot::Slot;
use super::textures::Textures;
use crate::machine::Modules;
use crate::machine::wgsl::{BufferKey, Limits, Quotients};

/// A device, the scene buffers uploaded to it and the pipelines compiled for it.
///
/// Create one and keep it; it may be shared between threads. Dropping a context that owns its
/// device waits for the work still in flight.
pub struct Context {
    pub(super) gpu: Gpu,
    adapter: wgpu::AdapterInfo,
    /// Whether kernels reach the driver as SPIR-V, and what else it can be asked for then.
    pub(super) spirv: Option<FloatControls>,
    #[cfg(not(target_family = "wasm"))]
    exactness: OnceLock<Exactness>,
    pub(super) checks: Checks,
    pub(super) uploads: Mutex<Uploads>,
    pub(super) textures: Mutex<Textures>,
    pub(super) pipelines: Pipelines,
    pub(super) modules: Mutex<Modules>,
    /// Buffers of finished dispatches, reused by the next ones.
    pub(super) idle: Mutex<Vec<Slot>>,
}

impl Context {
    /// Opens the fastest adapter, or a software one if there is no other.
    ///
    /// The environment variables `WGPU_BACKEND` and `WGPU_VALIDATION` are honoured.
    #[cfg(not(target_family = "wasm"))]
    pub fn new() -> Result<Self, GpuError> {
        pollster::block_on(Self::open())
    }

    /// Opens an adapter like [`Context::new`]; in a browser, where nothing can wait, this is the
    /// way to do it.
    pub async fn open() -> Result<Self, GpuError> {
        let adapter = adapter().await?;
        let (device, queue) = device(&adapter).await?;
        let context = Self::from_wgpu(Some(adapter.get_info()), device, queue);
        context.gpu.watch();
        Ok(context)
    }

    /// Uses a device and a queue of the application, with that device's limits.
    ///
    /// Its callbacks for errors and for device loss are left alone. Request
    /// `Features::TIMESTAMP_QUERY` when creating the device to get device times,
    /// `Features::PASSTHROUGH_SHADERS`, with `experimental_features` enabled, to get [exact
    /// results](Self::is_exact) on Vulkan, and the adapter's storage limits to get large windows.
    /// Without `adapter_info` the device's own is used.
    pub fn from_wgpu(
        adapter_info: Option<wgpu::AdapterInfo>,
        device: wgpu::Device,
        queue: wgpu::Queue,
    ) -> Self {
        let adapter = adapter_info.unwrap_or_else(|| device.adapter_info());
        let takes_spirv = adapter.backend == wgpu::Backend::Vulkan
            && device.features().contains(wgpu::Features::PASSTHROUGH_SHADERS);
        let spirv = takes_spirv.then(|| FloatControls::of(&device));
        Self {
            gpu: Gpu::new(device, queue),
            adapter,
            spirv,
            #[cfg(not(target_family = "wasm"))]
            exactness: OnceLock::new(),
            checks: Checks::Full,
            uploads: Mutex::default(),
            textures: Mutex::default(),
            pipelines: Pipelines::default(),
            modules: Mutex::default(),
            idle: Mutex::default(),
        }
    }

    /// Lowers the limit on a binding's size, so that small data exercise windows and tiles. It is
    /// never below 256 bytes and never above the device's limit.
    pub fn with_max_binding_bytes(mut self, bytes: u64) -> Self {
        let caps = &mut self.gpu.caps;
        caps.max_binding = (bytes & !3).max(256).min(caps.max_binding);
        self
    }

    /// Lets the driver fuse and move operations, as WGSL allows it to: faster on some devices, and
    /// [no longer exact](Self::is_exact).
    #[must_use]
    pub fn with_operations_fused(mut self) -> Self {
        self.spirv = None;
        #[cfg(not(target_family = "wasm"))]
        {
            // What was found of exact operations holds no more.
            self.exactness = OnceLock::new();
        }
        self
    }

    /// Sets the timeout of one dispatch; 60 s unless set. A browser has its own.
    ///
    /// A timeout is returned as an error at once, but dropping the device afterwards still waits
    /// for the driver: wgpu has no way to cancel work.
    pub fn with_timeout(mut self, timeout: Duration) -> Self {
        self.gpu.timeout = timeout;
        self
    }

    /// Keeps compiled pipelines in a file of `folder` from one run of a program to the next.
    ///
    /// The file is read here. It is written when the context is dropped, and by
    /// [`Context::save_pipelines`], whole or not at all; of several programs the last one's stays. Its
    /// name is that of the adapter; one that is missing, damaged, or of another driver is as good as
    /// empty. It does not shrink: delete it once in a while.
    ///
    /// Only Vulkan has such caches, and a device of the application needs
    /// `Features::PIPELINE_CACHE`; elsewhere nothing is kept. Drivers of desktop cards keep files of
    /// their own as well.
    ///
    /// # Errors
    ///
    /// If the file exists and cannot be read.
    ///
    /// # Safety
    ///
    /// A file of that name in `folder`, if there is one, was written by this library, and nobody writes
    /// there who is not trusted: drivers believe what is in it. A checksum finds accidents only.
    #[cfg(not(target_family = "wasm"))]
    pub unsafe fn with_pipeline_cache(
        mut self,
        folder: impl AsRef<Path>,
    ) -> Result<Self, GpuError> {
        // SAFETY: the caller vouches for the file.
        let file = unsafe { PipelineFile::open(&self.gpu, &self.adapter, folder.as_ref()) }?;
        self.pipelines.reset();
        self.pipelines.file = file;
        Ok(self)
    }

    /// Writes the file of [`Context::with_pipeline_cache`] and returns the bytes of the driver's data,
    /// its header included; 0 if there is no file.
    ///
    /// # Errors
    ///
    /// If it cannot be written.
    #[cfg(not(target_family = "wasm"))]
    pub fn save_pipelines(&self) -> Result<u64, GpuError> {
        self.pipelines.file.as_ref().map_or(Ok(0), PipelineFile::write)
    }

    /// Chooses the runtime checks of the shaders compiled from now on.
    ///
    /// # Safety
    ///
    /// With [`Checks::Trusted`] every module given to [`Context::run`] must keep its array
    /// indices within bounds by itself, as the modules recorded by this crate do: they
    /// clamp. With [`Checks::Full`] there is no condition.
    pub unsafe fn with_checks(mut self, checks: Checks) -> Self {
        self.checks = checks;
        self.pipelines.reset();
        self
    }

    /// Returns the name of the adapter, with its driver.
    pub fn adapter_name(&self) -> String {
        let info = &self.adapter;
        if info.driver.is_empty() {
            return format!("{} ({:?})", info.name, info.backend);
        }
        format!("{} ({:?}, {})", info.name, info.backend, info.driver)
    }

    /// Returns wgpu's information about the adapter.
    pub fn adapter_info(&self) -> &wgpu::AdapterInfo {
        &self.adapter
    }

    /// Returns the device, for the application's own buffers.
    pub fn device(&self) -> &wgpu::Device {
        &self.gpu.device
    }

    /// Returns the queue, for the application's own buffers.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.gpu.queue
    }

    /// Returns the limits for recording kernels.
    pub fn limits(&self) -> Limits {
        Limits {
            max_binding_bytes: self.gpu.caps.max_binding,
            max_storage_buffers: self.gpu.caps.max_storage_buffers,
            quotients: self.quotients(),
        }
    }

    /// Returns whether kernels have the bits of the other variants on this device, unless their
    /// [`Arithmetic`](crate::machine::wgsl::Arithmetic) is `Fast`.
    ///
    /// NaNs are excepted, whose bits differ, and so are denormals where a device cannot be asked to
    /// keep them: it takes them for 0. It is so where the device takes SPIR-V, and where quotients and square roots are rounded to
    /// nearest, or can be corrected so that they are: a kernel of 65,536 of them, and of sums, is run
    /// to find out, once for a context, unless the device is a CPU.
    pub fn is_exact(&self) -> bool {
        self.obstacle().is_none()
    }

    /// Returns the context if kernels are [exact](Self::is_exact) on its device: for a program that
    /// would rather have no device than other bits.
    ///
    /// # Errors
    ///
    /// If they are not; the error says why.
    pub fn require_exact(self) -> Result<Self, GpuError> {
        match self.obstacle() {
            None => Ok(self),
            Some(reason) => Err(GpuError::NotExact { adapter: self.adapter_name(), reason }),
        }
    }

    fn obstacle(&self) -> Option<&'static str> {
        #[cfg(not(target_family = "wasm"))]
        return self.exactness().obstacle;
        #[cfg(target_family = "wasm")]
        Some("a browser takes no SPIR-V, so its driver may fuse and move operations")
    }

    fn quotients(&self) -> Quotients {
        #[cfg(not(target_family = "wasm"))]
        return self.exactness().quotients;
        #[cfg(target_family = "wasm")]
        Quotients::Native
    }

    /// Returns whether no kernel has to run to know whether the device is exact.
    #[cfg(not(target_family = "wasm"))]
    pub(super) fn exactness_is_at_hand(&self) -> bool {
        self.exactness.get().is_some() || !Exactness::takes_a_kernel(self)
    }

    #[cfg(not(target_family = "wasm"))]
    fn exactness(&self) -> Exactness {
        *self.exactness.get_or_init(|| Exactness::of(self))
    }

    /// Returns the bytes of scene data uploaded to the device so far.
    pub fn uploaded_bytes(&self) -> u64 {
        lock(&self.uploads).uploaded() + lock(&self.textures).uploaded()
    }

    /// Returns the bytes of scene data that the device keeps: those uploaded for trees that still
    /// exist.
    pub fn scene_bytes(&self) -> u64 {
        lock(&self.uploads).kept() + lock(&self.textures).kept()
    }

    /// Returns the number of kernels recorded so far. One that runs again is not recorded again, nor
    /// is another kernel of the same closure whose captures differ in numbers and data alone.
    pub fn recorded(&self) -> u64 {
        lock(&self.modules).recorded()
    }

    /// Returns the number of programs printed as WGSL so far: kernels with equal recordings share
    /// one text.
    pub fn printed(&self) -> u64 {
        lock(&self.modules).printed()
    }

    /// Returns the number of shaders compiled so far.
    pub fn compiled(&self) -> u64 {
        self.pipelines.compiled()
    }

    /// Returns the total compilation time: parsing, validating and translating the text, and the
    /// driver's immediate work on it. Work that the driver defers to the first dispatch is in that
    /// dispatch's time.
    pub fn compile_time(&self) -> Duration {
        self.pipelines.compile_time()
    }

    /// Frees the scene buffers of one owner; they are uploaded again when needed.
    pub fn forget(&self, id: u64) {
        lock(&self.uploads).forget(id);
        lock(&self.textures).forget(id);
    }

    /// Frees the scene buffers of dropped trees.
    pub(super) fn forget_gone(&self) {
        lock(&self.uploads).forget_gone();
        lock(&self.textures).forget_gone();
    }

    /// Waits until the device has answered every call so far and returns the first error, also that
    /// of a call of the application outside every error scope. A browser tells errors late; what
    /// runs is not waited for.
    ///
    /// # Errors
    ///
    /// The first error of a call, or the loss of the device.
    pub async fn settle(&self) -> Result<(), GpuError> {
        // Answers come in the order of calls: behind this one all others are there.
        self.gpu.guarded("a last call", || ())?;
        self.answered().await?;
        self.gpu.check()
    }

    /// Returns the error of earlier calls that the device told since, or that of the device.
    pub(super) fn check(&self) -> Result<(), GpuError> {
        match self.gpu.arrived() {
            Some(error) => Err(self.begin_again(error)),
            None => self.gpu.check(),
        }
    }

    /// Waits until every call so far is answered.
    pub(super) async fn answered(&self) -> Result<(), GpuError> {
        match self.gpu.answered().await {
            Some(error) => Err(self.begin_again(error)),
            None => Ok(()),
        }
    }

    /// Frees everything that was made before an error came late: some of it is invalid.
    fn begin_again(&self, error: GpuError) -> GpuError {
        lock(&self.uploads).clear();
        lock(&self.textures).clear();
        self.pipelines.clear();
        lock(&self.idle).clear();
        error
    }

    /// Uses a buffer of the application as the contents of `key`: `size` bytes from `offset`.
    /// Nothing is uploaded and nothing is copied.
    ///
    /// The buffer must belong to this context's device. It replaces an earlier version of
    /// the same part, and is itself dropped when a kernel asks for another version.
    pub fn with_external(
        &self,
        key: BufferKey,
        buffer: wgpu::Buffer,
        offset: u64,
        size: u64,
    ) -> Result<(), GpuError> {
        lock(&self.uploads).name_external(&self.gpu.caps, key, buffer, offset, size)
    }
}

impl fmt::Debug for Context {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Context")
            .field("adapter", &self.adapter_name())
            .field("limits", &self.limits())
            .field("checks", &self.checks)
            .finish_non_exhaustive()
    }
}

/// Returns the fastest adapter; wgpu sorts software adapters last.
async fn adapter() -> Result<wgpu::Adapter, GpuError> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    // Indirect calls, which are never made here, cost pipelines at start and, worse, limit
    // max_buffer_size to 4 GiB.
    descriptor.flags.remove(wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL);
    let instance = wgpu::Instance::new(descriptor.with_env());
    let mut options = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..Default::default()
    };
    if let Ok(adapter) = instance.request_adapter(&options).await {
        return Ok(adapter);
    }
    options.force_fallback_adapter = true;
    instance
        .request_adapter(&options)
        .await
        .map_err(|error| GpuError::NoAdapter { reason: one_line(&error.to_string()) })
}

/// Requests a device with all the storage that the adapter offers.
async fn device(adapter: &wgpu::Adapter) -> Result<(wgpu::Device, wgpu::Queue), GpuError> {
    let mut features = wgpu::Features::TIMESTAMP_QUERY;
    if adapter.get_info().backend == wgpu::Backend::Vulkan {
        features |= wgpu::Features::PASSTHROUGH_SHADERS | wgpu::Features::PIPELINE_CACHE;
    }
    let request = adapter.request_device(&wgpu::DeviceDescriptor {
        label: Some("raydsl"),
        required_features: adapter.features() & features,
        required_limits: wanted_limits(&adapter.limits()),
        // SAFETY: the one experimental feature that is asked for is that of passed shaders, which are
        // what naga writes.
        experimental_features: unsafe { wgpu::ExperimentalFeatures::enabled() },
        ..Default::default()
    });
    request.await.map_err(|error| GpuError::DeviceRequest {
        adapter: adapter.get_info().name,
        reason: one_line(&error.to_string()),
    })
}

/// Returns the default limits, with the adapter's own values where kernels need them.
fn wanted_limits(offered: &wgpu::Limits) -> wgpu::Limits {
    wgpu::Limits {
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        max_buffer_size: offered.max_buffer_size,
        max_storage_buffers_per_shader_stage: offered.max_storage_buffers_per_shader_stage,
        max_buffers_and_acceleration_structures_per_shader_stage: offered
            .max_buffers_and_acceleration_structures_per_shader_stage,
        max_uniform_buffer_binding_size: offered.max_uniform_buffer_binding_size,
        max_bindings_per_bind_group: offered.max_bindings_per_bind_group,
        min_storage_buffer_offset_alignment: offered.min_storage_buffer_offset_alignment,
        max_compute_workgroups_per_dimension: offered.max_compute_workgroups_per_dimension,
        max_compute_invocations_per_workgroup: offered.max_compute_invocations_per_workgroup,
        max_compute_workgroup_size_x: offered.max_compute_workgroup_size_x,
        max_compute_workgroup_size_y: offered.max_compute_workgroup_size_y,
        max_compute_workgroup_storage_size: offered.max_compute_workgroup_storage_size,
        ..wgpu::Limits::default().or_worse_values_from(offered)
    }
}
