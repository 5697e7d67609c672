//! Textures from image files.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use bytemuck::Pod;
use glam::{Vec2, Vec3, Vec4};
use image::{DynamicImage, ImageFormat, ImageReader, Limits};
use thiserror::Error;

use super::config::{ColorSpace, TextureConfig};
use super::error::TextureError;
use super::levels::room;
use super::texel::Texel;
use super::texture::{MAX_SIZE, Texture2};
use crate::math::{F16, Unorm8, Unorm16};

/// Memory limit of decoding an image, and of a decoded image with its texels: 1 GiB.
const MAX_BYTES: u64 = 1 << 30;

/// Number of texels converted at a time.
const PIECE: u32 = 1 << 16;

/// Error of loading a texture from an image.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    #[error("cannot read {}: check the path and its permissions", path.display())]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// Cause.
        source: std::io::Error,
    },
    /// The file is broken, truncated, of an unknown format or one whose feature is off, or too
    /// large.
    #[error(
        "the picture cannot be decoded: {source}; files may have PNG's format and those of the \
         features `jpeg`, `hdr` and `exr`, and take 1 GiB at most while they are decoded"
    )]
    Undecodable {
        /// Error of the decoder.
        source: image::ImageError,
    },
    /// The image would take too many bytes together with the texels it is converted to.
    #[error(
        "a picture of {} by {} takes {bytes} bytes with its texels, of at most {limit}: scale it \
         down, or load it with smaller texels or those of its own kind", size[0], size[1]
    )]
    TooLarge {
        /// Its width and height.
        size: [u32; 2],
        /// Bytes of the decoded image and its texels.
        bytes: u64,
        /// Maximum number of bytes of both.
        limit: u64,
    },
    /// The image has floats, and the texels have 8 or 16 bits for numbers from 0 to 1.
    #[error(
        "the picture has floats beyond what the texels hold: load it with texels of `f32`, `F16`, \
         `Vec2`, `Vec3` or `Vec4`"
    )]
    Floats,
    /// The image's size is not valid for a texture, or there is no memory for its texels.
    #[error(transparent)]
    Texture(#[from] TextureError),
}

/// Texel type that images can be loaded as: [`Unorm8`], [`Unorm16`], [`F16`], `f32` or an array of
/// one (grey), two (grey and opacity), three or four of them, and [`Vec2`], [`Vec3`] and [`Vec4`].
pub trait PictureTexel: Texel {
    /// Whether it holds numbers from 0 to 1 only.
    const IS_SMALL: bool;

    /// Returns the image's texels, converted from other types.
    #[doc(hidden)]
    fn of_picture(picture: DynamicImage) -> Result<Vec<Self>, LoadError>;
}

/// Implements it:
/// `texel: is it small, (the kind of image with such texels), conversion (and its map)`.
macro_rules! picture_texel {
    ($($t:ty: $is_small:literal ($($own:ident)?) $into:ident $($from:expr)?;)+) => {
        $(
            impl PictureTexel for $t {
                const IS_SMALL: bool = $is_small;

                fn of_picture(picture: DynamicImage) -> Result<Vec<Self>, LoadError> {
                    match picture {
                        $(DynamicImage::$own(own) => Ok(whole(own.into_raw())?),)?
                        other => converted(&other, |piece, texels| {
                            let piece = piece.$into();
                            let found = bytemuck::cast_slice(piece.as_raw());
                            picture_texel!(texels found $($from)?);
                        }),
                    }
                }
            }
        )+
    };
    ($texels:ident $found:ident) => { $texels.extend_from_slice($found) };
    ($texels:ident $found:ident $from:expr) => { $texels.extend($found.iter().map($from)) };
}

picture_texel! {
    Unorm8: true (ImageLuma8) into_luma8;
    [Unorm8; 1]: true (ImageLuma8) into_luma8;
    [Unorm8; 2]: true (ImageLumaA8) into_luma_alpha8;
    [Unorm8; 3]: true (ImageRgb8) into_rgb8;
    [Unorm8; 4]: true (ImageRgba8) into_rgba8;
    Unorm16: true (ImageLuma16) into_luma16;
    [Unorm16; 1]: true (ImageLuma16) into_luma16;
    [Unorm16; 2]: true (ImageLumaA16) into_luma_alpha16;
    [Unorm16; 3]: true (ImageRgb16) into_rgb16;
    [Unorm16; 4]: true (ImageRgba16) into_rgba16;
    F16: false () to_luma32f |v: &f32| F16::new(*v);
    [F16; 1]: false () to_luma32f |v: &[f32; 1]| v.map(F16::new);
    [F16; 2]: false () to_luma_alpha32f |v: &[f32; 2]| v.map(F16::new);
    [F16; 3]: false () into_rgb32f |v: &[f32; 3]| v.map(F16::new);
    [F16; 4]: false () into_rgba32f |v: &[f32; 4]| v.map(F16::new);
    f32: false () to_luma32f;
    [f32; 1]: false () to_luma32f;
    [f32; 2]: false () to_luma_alpha32f;
    [f32; 3]: false (ImageRgb32F) into_rgb32f;
    [f32; 4]: false (ImageRgba32F) into_rgba32f;
    Vec2: false () to_luma_alpha32f;
    Vec3: false (ImageRgb32F) into_rgb32f;
    // A list of floats may lack the alignment of glam's `Vec4`.
    Vec4: false () into_rgba32f |v: &[f32; 4]| Vec4::from(*v);
}

/// Casts numbers to texels: in place, unless the capacity is not a whole number of texels.
fn whole<N: Pod, T: Pod>(numbers: Vec<N>) -> Result<Vec<T>, TextureError> {
    bytemuck::allocation::try_cast_vec(numbers).or_else(|(_, numbers)| {
        let texels = bytemuck::cast_slice(&numbers);
        let mut all = room(texels.len())?;
        all.extend_from_slice(texels);
        Ok(all)
    })
}

/// Converts the texels of an image with others; `add` converts a piece of it.
fn converted<T>(
    picture: &DynamicImage,
    add: impl Fn(DynamicImage, &mut Vec<T>),
) -> Result<Vec<T>, LoadError> {
    let size @ [width, height] = [picture.width(), picture.height()];
    let count = u64::from(width) * u64::from(height);
    let bytes = picture.as_bytes().len() as u64 + count * size_of::<T>() as u64;
    if bytes > MAX_BYTES {
        return Err(LoadError::TooLarge { size, bytes, limit: MAX_BYTES });
    }
    let mut texels = room(count as usize)?;
    // Convert in pieces, since the numbers that texels are made of are in a list of their own.
    let columns = width.clamp(1, PIECE);
    let rows = PIECE / columns;
    for y in (0..height).step_by(rows as usize) {
        for x in (0..width).step_by(columns as usize) {
            add(picture.crop_imm(x, y, columns, rows), &mut texels);
        }
    }
    Ok(texels)
}

impl<T: PictureTexel> Texture2<'static, T> {
    /// Loads an image file: PNG, and with the features of these names `jpeg`, `hdr` and `exr`. The
    /// format is detected from the content.
    ///
    /// Texels of another type than the image's are converted; a float beyond the range of [`F16`]
    /// becomes infinite. The numbers of an image with 8 or 16 bits are sRGB, floats are linear: the
    /// colour space of `config` is replaced. For data that is no colour, as in a normal map, see
    /// [`load_as`](Self::load_as).
    ///
    /// Row 0 is the top row of the image as stored, so `v` runs downwards, as in glTF. For an OBJ
    /// file, where it runs upwards, take `1 - v`. EXIF orientation, colour profiles and gamma
    /// values are ignored.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or decoded, has floats for texels that hold numbers from 0 to 1,
    /// or would take more than 1 GiB besides the file: decoded (of OpenEXR twice) or, where texels
    /// are converted, the image and its texels together.
    pub fn load(path: impl AsRef<Path>, config: TextureConfig) -> Result<Self, LoadError> {
        Self::from_picture(&file(path.as_ref())?, config)
    }

    /// Loads an image file whose numbers are in `color_space`, whatever their type: for a normal
    /// map [`ColorSpace::Linear`]. See [`load`](Self::load).
    ///
    /// # Errors
    ///
    /// As [`load`](Self::load).
    pub fn load_as(
        path: impl AsRef<Path>,
        color_space: ColorSpace,
        config: TextureConfig,
    ) -> Result<Self, LoadError> {
        Self::from_picture_as(&file(path.as_ref())?, color_space, config)
    }

    /// Decodes an image from the bytes of a file; see [`load`](Self::load).
    ///
    /// # Errors
    ///
    /// As [`load`](Self::load).
    pub fn from_picture(bytes: &[u8], config: TextureConfig) -> Result<Self, LoadError> {
        let picture = decoded(bytes)?;
        let color_space = if has_floats(&picture) { ColorSpace::Linear } else { ColorSpace::Srgb };
        Self::of_picture(picture, config.color_space(color_space))
    }

    /// Decodes an image from the bytes of a file, in a colour space; see
    /// [`load_as`](Self::load_as).
    ///
    /// # Errors
    ///
    /// As [`load`](Self::load).
    pub fn from_picture_as(
        bytes: &[u8],
        color_space: ColorSpace,
        config: TextureConfig,
    ) -> Result<Self, LoadError> {
        Self::of_picture(decoded(bytes)?, config.color_space(color_space))
    }

    fn of_picture(picture: DynamicImage, config: TextureConfig) -> Result<Self, LoadError> {
        if has_floats(&picture) && T::IS_SMALL {
            return Err(LoadError::Floats);
        }
        let size = [picture.width(), picture.height()];
        Ok(Self::new(T::of_picture(picture)?, size, config)?)
    }
}

fn has_floats(picture: &DynamicImage) -> bool {
    matches!(picture, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_))
}

fn file(path: &Path) -> Result<Vec<u8>, LoadError> {
    std::fs::read(path).map_err(|source| LoadError::Unreadable { path: path.to_owned(), source })
}

fn decoded(bytes: &[u8]) -> Result<DynamicImage, LoadError> {
    let decoded = || {
        let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
        let mut limits = Limits::default();
        limits.max_image_width = Some(MAX_SIZE);
        limits.max_image_height = Some(MAX_SIZE);
        // This decoder keeps a copy of the image that it does not count.
        let copies = if reader.format() == Some(ImageFormat::OpenExr) { 2 } else { 1 };
        limits.max_alloc = Some(MAX_BYTES / copies);
        reader.limits(limits);
        reader.decode()
    };
    decoded().map_err(|source| LoadError::Undecodable { source })
}
