//! What recording a kernel produces: WGSL text and the data that it reads. Knows nothing of wgpu.

/// How generated code computes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Arithmetic {
    /// As the other variants do: elementary functions are the library's, and the numbers of the
    /// source stand in the uniform block, where no driver can fold them into others.
    #[default]
    Strict,
    /// As the device likes it best: `sin`, `cos`, `tan`, `asin`, `acos`, `atan`, `atan2`, `exp`,
    /// `exp2`, `log`, `log2`, `pow` and `sincos_2pi` are those of WGSL, whose errors are the
    /// driver's (WGSL asks of `sin` no more than an absolute error of 2^-11 in [-pi, pi]), and
    /// numbers are written where they stand.
    Fast,
}

/// A complete WGSL module with the entry point `main`.
///
/// Everything lies in bind group 0: the kernel's numbers at binding 0, the `Job` at 1, inputs at
/// 2, outputs at 3, windows of the scene's buffers from 4 on, and then the textures.
#[derive(Clone, Debug, PartialEq)]
pub struct Module {
    /// The text.
    pub source: String,
    /// Threads of a workgroup in x and y.
    pub workgroup: [u32; 2],
    /// Bytes of the uniform block of captured numbers; a multiple of 16, never empty.
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

/// A buffer of the scene, in as many windows as bindings of limited size need.
#[derive(Clone, Debug, PartialEq)]
pub struct Buffer {
    /// Which data.
    pub key: BufferKey,
    /// The name in the text.
    pub name: String,
    /// Bytes of an element.
    pub stride: u32,
    /// Number of elements.
    pub len: u64,
    /// The bindings that together hold it; one, with no element, for an empty buffer.
    pub windows: Vec<Window>,
}

/// A part of a buffer that is one binding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The binding's number.
    pub binding: u32,
    /// The first element.
    pub first: u64,
    /// How many elements.
    pub count: u64,
}

/// A texture that the device's own sampler reads.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Which texels: those of all levels, one level behind the other.
    pub key: BufferKey,
    /// The name in the text.
    pub name: String,
    /// The binding's number; the next one is that of the sampler.
    pub binding: u32,
    /// What the texels are and how they are read.
    pub layout: TextureLayout,
}

/// What lies outside of `[0, 1)` along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Address {
    /// The texture again and again.
    #[default]
    Wrap,
    /// The texture again and again, every second time mirrored: `GL_MIRRORED_REPEAT`.
    Mirror,
    /// The texel at the edge.
    Clamp,
    /// The border's colour; filters blend with it. A texel that is outside along one axis is
    /// outside, whatever the others say.
    Border,
}

/// What the texels of a texture are, and how a sampler reads them: linearly between texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureLayout {
    /// Whether it is a volume; if not, an image.
    pub is_volume: bool,
    /// Texels along each axis; 1 along the third axis of an image.
    pub size: [u32; 3],
    /// Levels of detail, at least 1.
    pub levels: u32,
    /// What a texel is.
    pub format: TexelFormat,
    /// Bytes from one texel to the next, as [`BufferKey`] names them.
    pub stride: u32,
    /// What lies outside: never the border.
    pub address: [Address; 3],
    /// Whether levels are blended.
    pub blends_levels: bool,
}

/// Texels that every device of WebGPU filters.
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
    /// Bytes of a texel.
    pub fn bytes(self) -> u32 {
        match self {
            Self::R8Unorm => 1,
            Self::Rg8Unorm | Self::R16Float => 2,
            Self::Rgba8Unorm | Self::Rgba8UnormSrgb | Self::Rg16Float => 4,
            Self::Rgba16Float => 8,
        }
    }
}

/// Names data of the host: the same key means the same bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BufferKey {
    /// The owner, unique in the process.
    pub id: u64,
    /// Grows when the owner's data change.
    pub version: u32,
    /// Which of the owner's arrays.
    pub part: u32,
}

/// How large a binding may be and how many there may be: decides the windows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Bytes of one binding.
    pub max_binding_bytes: u64,
    /// Storage buffers of a shader stage.
    pub max_storage_buffers: u32,
}

impl Default for Limits {
    /// What WebGPU guarantees: 128 MiB and 8 buffers.
    fn default() -> Self {
        Self { max_binding_bytes: 128 << 20, max_storage_buffers: 8 }
    }
}
