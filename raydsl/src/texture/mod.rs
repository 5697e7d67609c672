//! Textures of one, two and three dimensions.
//!
//! A [`Texture`] reads texels of the application in place, or owns them; [`TextureRef`] is a light
//! reference. Kernels capture either, take either as `&Texture2<T>` or `&TextureRef2<T>`, and read
//! them with [`tex1()`], [`tex2()`], [`tex3()`], or texel by texel with [`tex2_fetch()`] and its
//! like. [`TextureConfig`] sets filter, address modes, border and colour space.
//!
//! The filters are kernels of this library; packets have the same arithmetic in functions of their
//! own. So all variants on the CPU return the same bits, and WGSL reads texels from a buffer by the
//! same formulas. [`Filtering::Device`] uses the device's own sampler, whose weights have 8 bits.

mod color;
mod config;
mod device;
mod error;
mod filter;
mod functions;
mod levels;
#[cfg(feature = "image")]
mod load;
mod on;
mod packet;
mod prefilter;
mod sample;
mod taps;
mod texel;
#[expect(clippy::module_inception, reason = "the texture itself, among what belongs to it")]
mod texture;
mod view;

pub use color::{linear_to_srgb, srgb_to_linear};
pub use config::{Address, ColorSpace, Filter, Filtering, LevelFilter, TextureConfig};
pub use error::TextureError;
pub use functions::{
    tex1, tex1_fetch, tex1_level, tex1_texels, tex2, tex2_fetch, tex2_level, tex2_texels, tex3,
    tex3_fetch, tex3_level, tex3_texels,
};
#[cfg(feature = "image")]
pub use load::{LoadError, PictureTexel};
pub use texel::{Blend, Channel, Texel, TexelValue};
pub use texture::{
    AsTextureRef, MAX_SIZE, MAX_TEXELS, Texture, Texture1, Texture2, Texture3, TextureRef,
    TextureRef1, TextureRef2, TextureRef3,
};
pub use view::Texels;
