//! Textures and light references to them.

use std::borrow::Cow;

use super::config::{Address, TextureConfig};
use super::error::TextureError;
use super::texel::Texel;
use super::view::Texels;
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    Capture, Leaves, Machine, Owner, Parameter, Resource, Schema, Table, TableView, Type, Value,
};

/// Maximum number of texels along an axis: up to here every whole number is an `f32`.
pub const MAX_SIZE: u32 = 1 << 24;

/// Maximum number of texels of a texture with all its levels: kernels index with 32 bits, and one
/// index is reserved for the border.
pub const MAX_TEXELS: u64 = u32::MAX as u64;

/// Texture of `D` dimensions, 1, 2 or 3. It borrows texels from the application or owns them.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::texture::{Address, Texture2, TextureConfig};
///
/// let texels = [0.0, 1.0, 2.0, 3.0];
/// let config = TextureConfig::new().address(Address::Clamp);
/// let texture = Texture2::new(&texels, [2, 2], config)?;
/// assert_eq!(tex2(&texture, vec2(0.5, 0.5)), 1.5);
///
/// let doubled = kernel!(|uv: Vec2| 2.0 * tex2(&texture, uv));
/// assert_eq!(doubled.call((vec2(0.5, 0.5),)), 3.0);
/// # Ok::<(), raydsl::texture::TextureError>(())
/// ```
#[derive(Debug)]
pub struct Texture<'a, T: Clone, const D: usize> {
    texels: Cow<'a, [T]>,
    size: [u32; D],
    levels: u32,
    config: TextureConfig,
    /// A device keeps the texels as long as the texture lives.
    owner: Owner,
}

/// 1-D texture.
pub type Texture1<'a, T> = Texture<'a, T, 1>;
/// 2-D texture.
pub type Texture2<'a, T> = Texture<'a, T, 2>;
/// 3-D texture.
pub type Texture3<'a, T> = Texture<'a, T, 3>;

impl<'a, T: Texel, const D: usize> Texture<'a, T, D> {
    /// Creates a texture over a slice of the application, or with a `Vec` of its own.
    ///
    /// The first axis runs fastest: texel `(x, y, z)` has the index
    /// `(z * size[1] + y) * size[0] + x`.
    ///
    /// # Errors
    ///
    /// If an axis has no texels or more than [`MAX_SIZE`], all together have more than
    /// [`MAX_TEXELS`], or the number of texels does not match the sizes.
    pub fn new(
        texels: impl Into<Cow<'a, [T]>>,
        size: [u32; D],
        config: TextureConfig,
    ) -> Result<Self, TextureError> {
        let texels = texels.into();
        check(&size, texels.len())?;
        Ok(Self::with_parts(texels, size, 1, config))
    }

    /// Creates a texture of validated texels.
    pub(super) fn with_parts(
        texels: Cow<'a, [T]>,
        size: [u32; D],
        levels: u32,
        config: TextureConfig,
    ) -> Self {
        Self { texels, size, levels, config, owner: Owner::new() }
    }

    /// Replaces the settings.
    #[must_use]
    pub fn with_config(self, config: TextureConfig) -> Self {
        Self { config, ..self }
    }

    /// Returns the number of texels along each axis.
    pub fn size(&self) -> [u32; D] {
        self.size
    }

    /// Returns the number of levels of detail, at least 1.
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Returns the settings.
    pub fn config(&self) -> &TextureConfig {
        &self.config
    }

    /// Returns the texels of all levels, one level after another.
    pub fn texels(&self) -> &[T] {
        &self.texels
    }
}

impl<T: Texel, const D: usize> Clone for Texture<'_, T, D> {
    fn clone(&self) -> Self {
        Self::with_parts(self.texels.clone(), self.size, self.levels, self.config)
    }
}

/// Validates the size of a texture with so many texels.
fn check(size: &[u32], found: usize) -> Result<(), TextureError> {
    for (axis, &size) in size.iter().enumerate() {
        if size == 0 {
            return Err(TextureError::NoTexels { axis });
        }
        if size > MAX_SIZE {
            return Err(TextureError::TooLong { axis, size, limit: MAX_SIZE });
        }
    }
    let expected = within_limit(count(size))?;
    if expected != found as u64 {
        return Err(TextureError::WrongLength { expected, found });
    }
    Ok(())
}

/// Returns the product of sizes of at most [`MAX_SIZE`].
pub(super) fn count(size: &[u32]) -> u128 {
    size.iter().map(|&n| u128::from(n)).product()
}

/// Returns a number of texels if kernels can index them.
pub(super) fn within_limit(count: u128) -> Result<u64, TextureError> {
    let too_many = TextureError::TooManyTexels { count, limit: MAX_TEXELS };
    u64::try_from(count).ok().filter(|n| *n <= MAX_TEXELS).ok_or(too_many)
}

/// Light reference to a texture, or a texture over a slice.
#[derive(Debug)]
pub struct TextureRef<'a, T, const D: usize> {
    pub(super) texels: Texels<'a, T>,
}

/// Reference to a 1-D texture.
pub type TextureRef1<'a, T> = TextureRef<'a, T, 1>;
/// Reference to a 2-D texture.
pub type TextureRef2<'a, T> = TextureRef<'a, T, 2>;
/// Reference to a 3-D texture.
pub type TextureRef3<'a, T> = TextureRef<'a, T, 3>;

impl<T, const D: usize> Clone for TextureRef<'_, T, D> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, const D: usize> Copy for TextureRef<'_, T, D> {}

impl<'a, T: Texel, const D: usize> TextureRef<'a, T, D> {
    /// Creates a texture over a slice. A device is sent the texels whenever a kernel that reads
    /// them runs; it keeps those of a [`Texture`].
    ///
    /// # Errors
    ///
    /// As [`Texture::new`].
    pub fn new(
        texels: &'a [T],
        size: [u32; D],
        config: TextureConfig,
    ) -> Result<Self, TextureError> {
        check(&size, texels.len())?;
        Ok(Self::with_parts(texels, size, 1, config, None))
    }

    #[inline(always)]
    fn with_parts(
        all: &'a [T],
        size: [u32; D],
        levels: u32,
        config: TextureConfig,
        key: Option<BufferKey>,
    ) -> Self {
        const { assert!(D >= 1 && D <= 3, "a texture has 1, 2 or 3 dimensions") };
        let size = core::array::from_fn(|i| size.get(i).copied().unwrap_or(1));
        // Code for borders is recorded only for existing axes.
        let address =
            core::array::from_fn(|i| if i < D { config.address[i] } else { Address::Clamp });
        let config = TextureConfig { address, ..config };
        Self { texels: Texels { all, size, levels, config, key, name: "texture" } }
    }

    /// Replaces the settings.
    #[must_use]
    pub fn with_config(self, config: TextureConfig) -> Self {
        let Texels { all, levels, key, .. } = self.texels;
        Self::with_parts(all, self.size(), levels, config, key)
    }

    /// Returns the number of texels along each axis.
    pub fn size(&self) -> [u32; D] {
        core::array::from_fn(|i| self.texels.size[i])
    }

    /// Returns the number of levels of detail, at least 1.
    pub fn levels(&self) -> u32 {
        self.texels.levels
    }

    /// Returns the settings.
    pub fn config(&self) -> &TextureConfig {
        &self.texels.config
    }
}

/// A texture or a reference to one, as accepted by [`tex2()`](super::tex2()) and its like.
pub trait AsTextureRef<const D: usize> {
    /// Type of its texels.
    type Texel: Texel;

    /// Returns the reference.
    fn as_texture_ref(&self) -> TextureRef<'_, Self::Texel, D>;
}

impl<T: Texel, const D: usize> AsTextureRef<D> for Texture<'_, T, D> {
    type Texel = T;

    #[inline]
    fn as_texture_ref(&self) -> TextureRef<'_, T, D> {
        let key = BufferKey { id: self.owner.id(), version: 0, part: 0 };
        TextureRef::with_parts(&self.texels, self.size, self.levels, self.config, Some(key))
    }
}

impl<T: Texel, const D: usize> AsTextureRef<D> for TextureRef<'_, T, D> {
    type Texel = T;

    #[inline(always)]
    fn as_texture_ref(&self) -> TextureRef<'_, T, D> {
        *self
    }
}

impl<T: Texel, const D: usize> Parameter for TextureRef<'_, T, D> {
    type On<'a, M: Machine> = TextureRef<'a, T, D>;
}

impl<T: Texel, const D: usize> Parameter for Texture<'_, T, D> {
    type On<'a, M: Machine> = TextureRef<'a, T, D>;
}

impl<M: Machine, T: Type, const D: usize> Value<M> for TextureRef<'_, T, D> {
    const SCHEMA: &'static Schema = &Schema::Host;

    #[inline(always)]
    fn zero(m: &M) -> Self {
        Self { texels: Texels::zero(m) }
    }

    #[inline(always)]
    fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
        Self { texels: Texels::zip(m, a.texels, b.texels, f) }
    }
}

macro_rules! capture {
    ($t:ident) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, T: Texel, const D: usize> Capture<M> for $t<'_, T, D> {
            type On<'c>
                = TextureRef<'c, T, D>
            where
                Self: 'c;

            #[inline(always)]
            fn capture<'c>(&'c self, _: &M, name: &'static str) -> TextureRef<'c, T, D> {
                let texels = self.as_texture_ref().texels;
                TextureRef { texels: Texels { name, ..texels } }
            }

            #[inline(always)]
            fn constant<'c>(&'c self, _: &M) -> TextureRef<'c, T, D> {
                self.as_texture_ref()
            }

            fn resources(&self, _: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
                visit(&self.as_texture_ref().texels.slice());
            }
        }
    };
}

macro_rules! table {
    ($t:ident) => {
        impl<T: Texel, const D: usize> Table for $t<'_, T, D> {
            type View<'v>
                = TextureRef<'v, T, D>
            where
                Self: 'v;

            #[inline(always)]
            fn view(&self, name: &'static str) -> TextureRef<'_, T, D> {
                let texels = self.as_texture_ref().texels;
                TextureRef { texels: Texels { name, ..texels } }
            }
        }
    };
}

table!(Texture);
table!(TextureRef);

impl<T: Texel, const D: usize> TableView for TextureRef<'_, T, D> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&self.texels.slice());
    }

    fn is_same(&self, other: &Self) -> bool {
        self.texels.slice().is_same(&other.texels.slice())
    }
}

capture!(Texture);
capture!(TextureRef);
