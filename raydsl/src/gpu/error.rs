//! Errors of the GPU runtime, each with its remedy.

use super::window::WindowError;
use crate::machine::wgsl::BufferKey;

/// What to do where there is no adapter.
const ADAPTER: &str = if cfg!(target_family = "wasm") {
    "open the page in a browser with WebGPU, from https: or 127.0.0.1, and see that the browser may \
     use the graphics card"
} else {
    "install a Vulkan driver, on Debian mesa-vulkan-drivers and libvulkan1"
};

/// An error of the GPU runtime.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No driver offers an adapter.
    #[error("no GPU adapter: {} ({reason})", ADAPTER)]
    NoAdapter {
        /// The backends tried, in wgpu's words.
        reason: String,
    },
    /// The adapter did not create a device.
    #[error(
        "the adapter {adapter} refused to make a device ({reason}): update its driver, or pass \
         your own device to Context::from_wgpu"
    )]
    DeviceRequest {
        /// The adapter's name.
        adapter: String,
        /// wgpu's explanation.
        reason: String,
    },
    /// The device does not give kernels the bits of the other variants.
    #[error(
        "kernels on {adapter} do not have the bits of the other variants: {reason}; ask for \
         Arithmetic::Fast or the bounds of WGSL instead, or use a Vulkan driver that takes SPIR-V and \
         keeps the order of operations"
    )]
    NotExact {
        /// The adapter's name.
        adapter: String,
        /// What it does otherwise.
        reason: &'static str,
    },
    /// The WGSL does not parse or does not validate.
    #[error("the WGSL is invalid at line {line}, `{text}`: {message}")]
    ShaderInvalid {
        /// naga's message on one line.
        message: String,
        /// Line of the source, from 1; 0 where naga gives none.
        line: u32,
        /// That line of the source, trimmed.
        text: String,
    },
    /// The module is valid WGSL but no pipeline could be created from it.
    #[error("no pipeline could be made of the shader: {message}")]
    PipelineFailed {
        /// The message of wgpu or of the driver.
        message: String,
    },
    /// The file of compiled pipelines cannot be read or written.
    #[error(
        "the pipelines in {path} cannot be read or written ({reason}): give \
         Context::with_pipeline_cache a folder of the program's own"
    )]
    PipelineFile {
        /// The file.
        path: String,
        /// The system's words.
        reason: String,
    },
    /// One buffer would be larger than the device allows.
    #[error(
        "{name} needs a buffer of {bytes} bytes but max_buffer_size is {limit}: use smaller \
         windows (Context::with_max_binding_bytes) or a device with a higher limit"
    )]
    BufferTooLarge {
        /// The purpose of the buffer.
        name: String,
        /// The requested bytes.
        bytes: u64,
        /// The device's limit.
        limit: u64,
    },
    /// One binding would be larger than the device allows.
    #[error(
        "{name} needs a binding of {bytes} bytes but the limit is {limit}: record the kernel \
         with this context's limits()"
    )]
    BindingTooLarge {
        /// The bound resource.
        name: String,
        /// The requested bytes.
        bytes: u64,
        /// The limit of this context.
        limit: u64,
    },
    /// A texture for the device's sampler is too large for the device.
    #[error(
        "the texture {name} has {} x {} x {} texels but the device's limit is {limit} along an \
         axis: read it with Filtering::Exact", size[0], size[1], size[2]
    )]
    TextureTooLarge {
        /// The texture's name in the kernel.
        name: String,
        /// Texels along each axis.
        size: [u32; 3],
        /// The device's limit.
        limit: u32,
    },
    /// The kernel needs more storage buffers than a shader stage may have.
    #[error(
        "the kernel needs {needed} storage buffers but max_storage_buffers_per_shader_stage is \
         {limit}: use fewer scene buffers or larger windows"
    )]
    TooManyBuffers {
        /// The number of scene windows, inputs and outputs together.
        needed: u64,
        /// The device's limit.
        limit: u32,
    },
    /// The device has no memory left.
    #[error(
        "the device is out of memory while making {what}: forget scenes that are no longer \
         used (Context::forget) or split the data"
    )]
    OutOfMemory {
        /// The object being created.
        what: String,
    },
    /// The device was lost.
    #[error("the device was lost ({reason}): make a new Context and upload the scene again")]
    DeviceLost {
        /// The driver's reason, if it gave one.
        reason: String,
    },
    /// The device did not answer in time.
    #[error(
        "the device did not finish within {seconds} s: give it less work per pixel or raise \
         Context::with_timeout"
    )]
    Timeout {
        /// The time allowed.
        seconds: f64,
    },
    /// The caller gave no bytes for a buffer that the kernel reads.
    #[error("there is no data for the scene buffer {name} ({key:?}): is its owner still alive?")]
    MissingData {
        /// The buffer's name in the kernel.
        name: String,
        /// The buffer's key.
        key: BufferKey,
    },
    /// The given bytes have the wrong length.
    #[error("{what} has {bytes} bytes but {needed} are needed")]
    WrongLength {
        /// The name of the bytes.
        what: String,
        /// The number of bytes given.
        bytes: u64,
        /// The number of bytes needed.
        needed: u64,
    },
    /// A buffer of the application cannot serve as a scene buffer.
    #[error("the application's buffer for {key:?} cannot be used: {reason}")]
    ExternalBuffer {
        /// The key it was given for.
        key: BufferKey,
        /// The remedy.
        reason: String,
    },
    /// A window of the application's buffer cannot stand for a slice.
    #[error("the window for a slice of {element} cannot be used: {problem}")]
    Window {
        /// The type of the slice's elements.
        element: &'static str,
        /// The problem and its remedy.
        #[source]
        problem: WindowError,
    },
    /// The grid has more pixels than a 32-bit index can hold.
    #[error("a grid of {0} x {1} pixels has more than 2^32 - 1 of them: run it in parts", size[0], size[1])]
    GridTooLarge {
        /// The requested grid.
        size: [u32; 2],
    },
    /// A module violates the interface.
    #[error("the kernel module is malformed: {reason}")]
    BadModule {
        /// The violated rule.
        reason: String,
    },
    /// The requested error target is invalid.
    #[error(transparent)]
    Until(#[from] crate::render::UntilError),
    /// wgpu refused a call; a defect of this crate or of the driver.
    #[error("wgpu refused {what}: {message}")]
    Rejected {
        /// The operation being performed.
        what: String,
        /// wgpu's message on one line.
        message: String,
    },
}

/// Joins a message of several lines to one.
///
/// wgpu nests causes by lines and naga draws the source around its message; only the words are
/// kept, as the source line is quoted separately.
pub(super) fn one_line(message: &str) -> String {
    let words = message
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty() && !FRAMES.contains(line) && !is_drawing(line));
    words.collect::<Vec<_>>().join("; ")
}

/// Lines that wgpu prints before the causes.
const FRAMES: [&str; 3] = ["Validation Error", "Internal Error", "Caused by:"];

/// Returns whether a line of naga's report draws the source instead of a message.
fn is_drawing(line: &str) -> bool {
    let rest = line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ');
    rest.starts_with(['│', '┌', '╭', '╰', '|', '·'])
}
