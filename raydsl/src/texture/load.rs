//! Textures from picture files.

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

/// The most bytes that decoding a picture may take, and a decoded picture with its texels: 1 GiB.
const MAX_BYTES: u64 = 1 << 30;

/// How many texels are converted at a time.
const PIECE: u32 = 1 << 16;

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
         features `jpeg`, `hdr` and `exr`, and take 1 GiB at most while they are decoded"
    )]
    Undecodable {
        /// What the decoder says.
        source: image::ImageError,
    },
    /// It would take too many bytes together with the texels that it is converted to.
    #[error(
        "a picture of {} by {} takes {bytes} bytes with its texels, of at most {limit}: scale it \
         down, or load it with smaller texels or those of its own kind", size[0], size[1]
    )]
    TooLarge {
        /// Its width and height.
        size: [u32; 2],
        /// What it takes decoded, and its texels.
        bytes: u64,
        /// What both may take.
        limit: u64,
    },
    /// A picture of floats, and texels of 8 or 16 bits that hold numbers from 0 to 1.
    #[error(
        "the picture has floats beyond what the texels hold: load it with texels of `f32`, `F16`, \
         `Vec2`, `Vec3` or `Vec4`"
    )]
    Floats,
    /// The picture's size is that of no texture, or there is no memory for its texels.
    #[error(transparent)]
    Texture(#[from] TextureError),
}

/// A texel that pictures can be loaded as: [`Unorm8`], [`Unorm16`], [`F16`], `f32` or an array of
/// one (grey), two (grey and opacity), three or four of them, and [`Vec2`], [`Vec3`] and [`Vec4`].
pub trait PictureTexel: Texel {
    /// Whether it holds numbers from 0 to 1 only.
    const IS_SMALL: bool;

    /// The picture's texels, converted where it has others.
    #[doc(hidden)]
    fn of_picture(picture: DynamicImage) -> Result<Vec<Self>, LoadError>;
}

/// `texel: is it small, (the kind of picture with such texels), conversion (and what it gives)`.
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
    // A list of floats may not lie where glam wants a `Vec4`.
    Vec4: false () into_rgba32f |v: &[f32; 4]| Vec4::from(*v);
}

/// The same numbers as texels: in the same place, unless it has room for a part of a texel.
fn whole<N: Pod, T: Pod>(numbers: Vec<N>) -> Result<Vec<T>, TextureError> {
    bytemuck::allocation::try_cast_vec(numbers).or_else(|(_, numbers)| {
        let texels = bytemuck::cast_slice(&numbers);
        let mut all = room(texels.len())?;
        all.extend_from_slice(texels);
        Ok(all)
    })
}

/// The texels of a picture that has others; `add` converts a piece of it.
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
    // The numbers that texels are made of lie in a list of their own: a short one.
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
    /// The picture in a file: PNG, and with the features of these names `jpeg`, `hdr` and `exr`.
    /// The format is found from the content.
    ///
    /// Texels of another kind than the picture's are converted; a float beyond what [`F16`] holds
    /// becomes infinite. Of a picture with 8 or 16 bits the numbers are sRGB, of one with floats
    /// they are linear: the colour space of `config` is replaced. For data that is no colour, as in
    /// a normal map, see [`load_as`](Self::load_as).
    ///
    /// Row 0 is the top row of the picture as it is stored, so `v` runs downwards, as in glTF. Of
    /// an OBJ file, where it runs upwards, take `1 - v`. The orientation that EXIF data of a camera
    /// says, colour profiles and gamma values are ignored.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or decoded, has floats and the texels hold numbers from 0 to 1,
    /// or would take more than 1 GiB besides the file: decoded (of OpenEXR twice) or, where texels
    /// are converted, the picture and its texels together.
    pub fn load(path: impl AsRef<Path>, config: TextureConfig) -> Result<Self, LoadError> {
        Self::from_picture(&file(path.as_ref())?, config)
    }

    /// The picture in a file, whose numbers mean what `color_space` says whatever their kind: for a
    /// normal map [`ColorSpace::Linear`]. See [`load`](Self::load).
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

    /// The picture in the bytes of a file; see [`load`](Self::load).
    ///
    /// # Errors
    ///
    /// As [`load`](Self::load).
    pub fn from_picture(bytes: &[u8], config: TextureConfig) -> Result<Self, LoadError> {
        let picture = decoded(bytes)?;
        let color_space = if has_floats(&picture) { ColorSpace::Linear } else { ColorSpace::Srgb };
        Self::of_picture(picture, config.color_space(color_space))
    }

    /// The picture in the bytes of a file, in a colour space; see [`load_as`](Self::load_as).
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
        // This decoder has a copy of the picture that it does not count.
        let copies = if reader.format() == Some(ImageFormat::OpenExr) { 2 } else { 1 };
        limits.max_alloc = Some(MAX_BYTES / copies);
        reader.limits(limits);
        reader.decode()
    };
    decoded().map_err(|source| LoadError::Undecodable { source })
}
