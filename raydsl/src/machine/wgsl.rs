//! The result of recording a kernel: WGSL text and the data that it reads, independent of wgpu.

/// The arithmetic of generated code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Arithmetic {
    /// Like the other variants: elementary functions are the library's, and the numbers of the
    /// source are in the uniform buffer, where no driver can fold them into others. Where a device
    /// takes SPIR-V, no operation is fused with another or moved, and results have the bits of the
    /// other variants, except that denormals may be 0; the device's context says so.
    #[default]
    Strict,
    /// The fastest on the device, which may fuse and move operations: `sin`, `cos`, `tan`, `asin`, `acos`, `atan`, `atan2`, `exp`,
    /// `exp2`, `log`, `log2`, `pow` and `sincos_2pi` are those of WGSL, whose errors are the
    /// driver's (WGSL asks of `sin` no more than an absolute error of 2^-11 in [-pi, pi]), and
    /// numbers are literals.
    Fast,
}

/// A complete WGSL module with the entry point `main`.
///
/// All bindings are in bind group 0: the kernel's numbers at binding 0, the `Job` at 1, inputs at
/// 2, outputs at 3, windows of the scene's buffers from 4 on, then the textures.
#[derive(Clone, Debug, PartialEq)]
pub struct Module {
    /// The text.
    pub source: String,
    /// What the driver may do with it.
    pub arithmetic: Arithmetic,
    /// Threads per workgroup in x and y.
    pub workgroup: [u32; 2],
    /// Bytes of the uniform buffer of captured numbers; a multiple of 16, never empty.
    pub uniforms: Vec<u8>,
    /// Bytes that an invocation reads from the inputs; 0 if there are none.
    pub input_stride: u32,
    /// Bytes that an invocation writes to the outputs.
    pub output_stride: u32,
    /// Read-only buffers of the scene.
    pub buffers: Vec<Buffer>,
    /// Textures that the device's own sampler reads.
    pub textures: Vec<Texture>,
}

/// A buffer of the scene, split into as many windows as the size limit of a binding needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Buffer {
    /// The key of its data.
    pub key: BufferKey,
    /// The name in the text.
    pub name: String,
    /// Bytes per element.
    pub stride: u32,
    /// Number of elements.
    pub len: u64,
    /// The bindings that together hold it; for an empty buffer one binding without elements.
    pub windows: Vec<Window>,
}

/// A part of a buffer, bound as one binding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The binding's number.
    pub binding: u32,
    /// The first element.
    pub first: u64,
    /// The number of elements.
    pub count: u64,
}

/// A texture that the device's own sampler reads.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The key of its texels: those of all levels, one level after another.
    pub key: BufferKey,
    /// The name in the text.
    pub name: String,
    /// The binding's number; the next one is that of the sampler.
    pub binding: u32,
    /// The texel format and sampling.
    pub layout: TextureLayout,
}

/// The address mode: the texels outside of `[0, 1)` along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Address {
    /// Repeats the texture.
    #[default]
    Wrap,
    /// Repeats the texture, mirrored every second time: `GL_MIRRORED_REPEAT`.
    Mirror,
    /// Repeats the texel at the edge.
    Clamp,
    /// Gives the border's colour; filters blend with it. A texel that is outside along one axis is
    /// outside, whatever the other axes say.
    Border,
}

/// The layout of a texture and its sampling: linear between texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureLayout {
    /// Whether it is a volume; otherwise it is an image.
    pub is_volume: bool,
    /// Texels along each axis; 1 along the third axis of an image.
    pub size: [u32; 3],
    /// Levels of detail, at least 1.
    pub levels: u32,
    /// The texel format.
    pub format: TexelFormat,
    /// Bytes from one texel to the next, as [`BufferKey`] names them.
    pub stride: u32,
    /// The address mode along each axis: never the border.
    pub address: [Address; 3],
    /// Whether levels are blended.
    pub blends_levels: bool,
}

/// Texel formats that every WebGPU device filters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "they are named as WebGPU names them")]
pub enum TexelFormat {
    R8Unorm,
    Rg8Unorm,
    Rgba8Unorm,
    Rgba8UnormSrgb,
    R16Float,
    Rg16Float,
    Rgba16Float,
}

impl TexelFormat {
    /// Returns the bytes of a texel.
    pub fn bytes(self) -> u32 {
        match self {
            Self::R8Unorm => 1,
            Self::Rg8Unorm | Self::R16Float => 2,
            Self::Rgba8Unorm | Self::Rgba8UnormSrgb | Self::Rg16Float => 4,
            Self::Rgba16Float => 8,
        }
    }
}

/// Identifies data of the host: the same key means the same bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BufferKey {
    /// The owner, unique in the process.
    pub id: u64,
    /// The version, which grows when the owner's data change.
    pub version: u32,
    /// The index among the owner's arrays.
    pub part: u32,
}

/// How quotients and square roots are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quotients {
    /// By the device's own instructions. WGSL asks for 2.5 ulp of a quotient.
    #[default]
    Native,
    /// By functions in the text that round them to nearest, on a device whose `fma` is one
    /// operation: the device's results are moved by at most an ulp, after Markstein (1990).
    Corrected,
}

/// What a text depends on: the limits on the size and the number of bindings, which decide the
/// windows, and how quotients are computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Bytes of one binding.
    pub max_binding_bytes: u64,
    /// Storage buffers per shader stage.
    pub max_storage_buffers: u32,
    /// How strict kernels compute quotients and square roots.
    pub quotients: Quotients,
}

impl Default for Limits {
    /// Returns WebGPU's guaranteed limits: 128 MiB and 8 buffers, and native quotients.
    fn default() -> Self {
        Self { max_binding_bytes: 128 << 20, max_storage_buffers: 8, quotients: Quotients::Native }
    }
}
