//! Textures and light references to them.

use std::borrow::Cow;

use super::config::{Address, TextureConfig};
use super::error::TextureError;
use super::texel::Texel;
use super::view::Texels;
use crate::machine::wgsl::BufferKey;
use crate::machine::{Capture, Leaves, Machine, Owner, Parameter, Resource, Schema, Type, Value};

/// The most texels along an axis: up to here every whole number is an `f32`.
pub const MAX_SIZE: u32 = 1 << 24;

/// The most texels of a texture with all its levels: kernels index with 32 bits, and one number is
/// taken for the border.
pub const MAX_TEXELS: u64 = u32::MAX as u64;

/// A texture of `D` dimensions, 1, 2 or 3. It borrows texels from the application or owns them.
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

/// A 1-D texture.
pub type Texture1<'a, T> = Texture<'a, T, 1>;
/// A 2-D texture.
pub type Texture2<'a, T> = Texture<'a, T, 2>;
/// A 3-D texture.
pub type Texture3<'a, T> = Texture<'a, T, 3>;

impl<'a, T: Texel, const D: usize> Texture<'a, T, D> {
    /// A texture over a slice of the application's, or with a `Vec` of its own.
    ///
    /// The first axis runs fastest: texel `(x, y, z)` is number `(z * size[1] + y) * size[0] + x`.
    ///
    /// # Errors
    ///
    /// If an axis has no texels or more than [`MAX_SIZE`], all together have more than
    /// [`MAX_TEXELS`], or there are not as many texels as the sizes say.
    pub fn new(
        texels: impl Into<Cow<'a, [T]>>,
        size: [u32; D],
        config: TextureConfig,
    ) -> Result<Self, TextureError> {
        let texels = texels.into();
        check(&size, texels.len())?;
        Ok(Self::with_parts(texels, size, 1, config))
    }

    /// A texture of texels that are as many as they must be.
    pub(super) fn with_parts(
        texels: Cow<'a, [T]>,
        size: [u32; D],
        levels: u32,
        config: TextureConfig,
    ) -> Self {
        Self { texels, size, levels, config, owner: Owner::new() }
    }

    /// The texture, read in another way.
    #[must_use]
    pub fn with_config(self, config: TextureConfig) -> Self {
        Self { config, ..self }
    }

    /// How many texels each axis has.
    pub fn size(&self) -> [u32; D] {
        self.size
    }

    /// How many levels of detail there are, at least 1.
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// How it is read.
    pub fn config(&self) -> &TextureConfig {
        &self.config
    }

    /// The texels of all levels, one level behind the other.
    pub fn texels(&self) -> &[T] {
        &self.texels
    }
}

impl<T: Texel, const D: usize> Clone for Texture<'_, T, D> {
    fn clone(&self) -> Self {
        Self::with_parts(self.texels.clone(), self.size, self.levels, self.config)
    }
}

/// Whether so many texels are a texture of this size.
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

/// The product of sizes of at most [`MAX_SIZE`].
pub(super) fn count(size: &[u32]) -> u128 {
    size.iter().map(|&n| u128::from(n)).product()
}

/// A number of texels that kernels can index.
pub(super) fn within_limit(count: u128) -> Result<u64, TextureError> {
    let too_many = TextureError::TooManyTexels { count, limit: MAX_TEXELS };
    u64::try_from(count).ok().filter(|n| *n <= MAX_TEXELS).ok_or(too_many)
}

/// A light reference to a texture, or a texture over a slice.
#[derive(Debug)]
pub struct TextureRef<'a, T, const D: usize> {
    pub(super) texels: Texels<'a, T>,
}

/// A reference to a 1-D texture.
pub type TextureRef1<'a, T> = TextureRef<'a, T, 1>;
/// A reference to a 2-D texture.
pub type TextureRef2<'a, T> = TextureRef<'a, T, 2>;
/// A reference to a 3-D texture.
pub type TextureRef3<'a, T> = TextureRef<'a, T, 3>;

impl<T, const D: usize> Clone for TextureRef<'_, T, D> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, const D: usize> Copy for TextureRef<'_, T, D> {}

impl<'a, T: Texel, const D: usize> TextureRef<'a, T, D> {
    /// A texture over a slice. A device is sent the texels whenever a kernel runs that reads them;
    /// those of a [`Texture`] it keeps.
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
        // Whether code for borders is recorded depends on the axes that there are.
        let address =
            core::array::from_fn(|i| if i < D { config.address[i] } else { Address::Clamp });
        let config = TextureConfig { address, ..config };
        Self { texels: Texels { all, size, levels, config, key, name: "texture" } }
    }

    /// The same texels, read in another way.
    #[must_use]
    pub fn with_config(self, config: TextureConfig) -> Self {
        let Texels { all, levels, key, .. } = self.texels;
        Self::with_parts(all, self.size(), levels, config, key)
    }

    /// How many texels each axis has.
    pub fn size(&self) -> [u32; D] {
        core::array::from_fn(|i| self.texels.size[i])
    }

    /// How many levels of detail there are, at least 1.
    pub fn levels(&self) -> u32 {
        self.texels.levels
    }

    /// How it is read.
    pub fn config(&self) -> &TextureConfig {
        &self.texels.config
    }
}

/// A texture or a reference to one: what [`tex2()`](super::tex2()) and its like take.
pub trait AsTextureRef<const D: usize> {
    /// Its texels.
    type Texel: Texel;

    /// The reference.
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

            fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
                visit(&self.as_texture_ref().texels.slice());
            }
        }
    };
}

capture!(Texture);
capture!(TextureRef);
