//! Textures from picture files.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3, Vec4};
use image::{DynamicImage, ImageReader, Limits};
use thiserror::Error;

use super::config::{ColorSpace, TextureConfig};
use super::error::TextureError;
use super::texel::Texel;
use super::texture::{MAX_SIZE, Texture2};
use crate::math::{Unorm8, Unorm16};

/// The most bytes that decoding a picture may take: 1 GiB.
const MAX_BYTES: u64 = 1 << 30;

/// Why a picture gives no texture, and what to do about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    #[error("cannot read {}: check the path and its permissions", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file is broken, cut off, of a format that is not known or whose feature is off, or too
    /// large.
    #[error(
        "the picture cannot be decoded: {source}; files may have PNG's format and those of the \
         features `jpeg`, `hdr` and `exr`, and take 1 GiB at most when decoded"
    )]
    Undecodable {
        /// What the decoder says.
        source: image::ImageError,
    },
    /// Its texels would take too many bytes.
    #[error(
        "a picture of {} by {} takes {bytes} bytes as a texture, of at most {limit}: scale it down, \
         or load it with smaller texels", size[0], size[1]
    )]
    TooLarge {
        /// Its width and height.
        size: [u32; 2],
        /// What its texels take.
        bytes: u64,
        /// What they may take.
        limit: u64,
    },
    /// A picture of floats, and texels of 8 or 16 bits that hold numbers from 0 to 1.
    #[error(
        "the picture has floats beyond what the texels hold: load it with texels of `f32`, `Vec2`, \
         `Vec3` or `Vec4`"
    )]
    Floats,
    /// The picture's size is that of no texture.
    #[error(transparent)]
    Texture(#[from] TextureError),
}

/// A texel that pictures can be loaded as: of [`Unorm8`] and [`Unorm16`] with one (grey), two (grey
/// and opacity), three or four channels, and of `f32`, [`Vec2`], [`Vec3`] and [`Vec4`].
pub trait PictureTexel: Texel {
    /// Whether it holds numbers from 0 to 1 only.
    const IS_SMALL: bool;

    /// The picture's texels, converted where it has others.
    #[doc(hidden)]
    fn of_picture(picture: DynamicImage) -> Vec<Self>;
}

macro_rules! picture_texel {
    ($($t:ty: $is_small:literal $into:ident;)+) => {
        $(
            impl PictureTexel for $t {
                const IS_SMALL: bool = $is_small;

                fn of_picture(picture: DynamicImage) -> Vec<Self> {
                    bytemuck::cast_slice(&picture.$into().into_raw()).to_vec()
                }
            }
        )+
    };
}

picture_texel! {
    Unorm8: true into_luma8;
    [Unorm8; 1]: true into_luma8;
    [Unorm8; 2]: true into_luma_alpha8;
    [Unorm8; 3]: true into_rgb8;
    [Unorm8; 4]: true into_rgba8;
    Unorm16: true into_luma16;
    [Unorm16; 1]: true into_luma16;
    [Unorm16; 2]: true into_luma_alpha16;
    [Unorm16; 3]: true into_rgb16;
    [Unorm16; 4]: true into_rgba16;
    f32: false to_luma32f;
    Vec2: false to_luma_alpha32f;
    Vec3: false into_rgb32f;
}

impl PictureTexel for Vec4 {
    const IS_SMALL: bool = false;

    fn of_picture(picture: DynamicImage) -> Vec<Self> {
        // A list of floats may not lie where glam wants a `Vec4`.
        let texels = picture.into_rgba32f().into_raw();
        texels.chunks_exact(4).map(Self::from_slice).collect()
    }
}

impl<T: PictureTexel> Texture2<'static, T> {
    /// The picture in a file: PNG, and with the features of these names `jpeg`, `hdr` and `exr`.
    /// The format is found from the content.
    ///
    /// Texels of another kind than the picture's are converted. Of a picture with 8 or 16 bits the
    /// numbers are sRGB, of one with floats they are linear: the colour space of `config` is
    /// replaced. For data that is no colour, as in a normal map, see
    /// [`with_config`](Self::with_config).
    ///
    /// Row 0 is the top row of the picture, so `v` runs downwards, as in glTF. Of an OBJ file,
    /// where it runs upwards, take `1 - v`.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or decoded, would take more than 1 GiB decoded or as
    /// texels, or has floats and
    /// the texels hold numbers from 0 to 1.
    pub fn load(path: impl AsRef<Path>, config: TextureConfig) -> Result<Self, LoadError> {
        let path = path.as_ref();
        let unreadable = |source| LoadError::Unreadable { path: path.to_owned(), source };
        Self::from_picture(&std::fs::read(path).map_err(unreadable)?, config)
    }

    /// The picture in the bytes of a file; see [`load`](Self::load).
    ///
    /// # Errors
    ///
    /// As [`load`](Self::load).
    pub fn from_picture(bytes: &[u8], config: TextureConfig) -> Result<Self, LoadError> {
        let picture = decoded(bytes).map_err(|source| LoadError::Undecodable { source })?;
        let has_floats =
            matches!(picture, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
        if has_floats && T::IS_SMALL {
            return Err(LoadError::Floats);
        }
        let size = [picture.width(), picture.height()];
        let bytes = size.map(u64::from).iter().product::<u64>() * size_of::<T>() as u64;
        if bytes > MAX_BYTES {
            return Err(LoadError::TooLarge { size, bytes, limit: MAX_BYTES });
        }
        let color_space = if has_floats { ColorSpace::Linear } else { ColorSpace::Srgb };
        Ok(Self::new(T::of_picture(picture), size, config.color_space(color_space))?)
    }
}

fn decoded(bytes: &[u8]) -> image::ImageResult<DynamicImage> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIZE);
    limits.max_image_height = Some(MAX_SIZE);
    limits.max_alloc = Some(MAX_BYTES);
    reader.limits(limits);
    reader.decode()
}
