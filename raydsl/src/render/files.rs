//! Picture files.
//!
//! 8-bit PNG is for viewing, PFM (and EXR, with the feature `exr`) for further processing of light
//! and distances.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use glam::Vec3;
#[cfg(feature = "exr")]
use glam::Vec4;

use super::Image;

impl Image<Vec3> {
    /// Writes a PFM of three channels: `f32` as they are, rows from the bottom, little-endian.
    /// (Paul Debevec's format, as netpbm documents it.)
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_pfm(&self, path: impl AsRef<Path>) -> io::Result<()> {
        write_pfm(path.as_ref(), "PF", self, |p| p.to_array())
    }
}

impl Image<f32> {
    /// Writes a PFM of one channel; see [`Image::<Vec3>::write_pfm`].
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_pfm(&self, path: impl AsRef<Path>) -> io::Result<()> {
        write_pfm(path.as_ref(), "Pf", self, |&p| [p])
    }
}

fn write_pfm<R: crate::Type, const N: usize>(
    path: &Path,
    magic: &str,
    image: &Image<R>,
    channels: impl Fn(&R) -> [f32; N],
) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    // A negative scale means little-endian.
    write!(file, "{magic}\n{} {}\n-1.0\n", image.width(), image.height())?;
    for value in image.pixels().iter().flat_map(channels) {
        file.write_all(&value.to_le_bytes())?;
    }
    file.flush()
}

#[cfg(feature = "image")]
impl Image<[crate::math::Unorm8; 4]> {
    /// Writes a PNG of 8 bits a channel, with alpha.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_png(&self, path: impl AsRef<Path>) -> Result<(), image::ImageError> {
        let bytes: Vec<u8> = from_the_top(self).flatten().map(|c| c.to_bits()).collect();
        let size = (self.width(), self.height());
        write_png(path.as_ref(), &bytes, size, image::ExtendedColorType::Rgba8)
    }
}

/// Writes a PNG. Generic over nothing, so that the encoder is compiled here and not by every crate
/// that writes a picture.
#[cfg(feature = "image")]
pub(super) fn write_png(
    path: &Path,
    bytes: &[u8],
    (width, height): (u32, u32),
    format: image::ExtendedColorType,
) -> Result<(), image::ImageError> {
    // Whatever the name ends with.
    image::save_buffer_with_format(path, bytes, width, height, format, image::ImageFormat::Png)
}

#[cfg(feature = "exr")]
impl Image<Vec4> {
    /// Writes an OpenEXR file of four channels of `f32`.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_exr(&self, path: impl AsRef<Path>) -> Result<(), image::ImageError> {
        let values = from_the_top(self).flat_map(|p| p.to_array()).collect();
        let (width, height) = (self.width(), self.height());
        let buffer = image::Rgba32FImage::from_raw(width, height, values).ok_or_else(|| {
            let kind = image::error::ParameterErrorKind::DimensionMismatch;
            image::ImageError::Parameter(image::error::ParameterError::from_kind(kind))
        })?;
        write_exr(path.as_ref(), &buffer)
    }
}

#[cfg(feature = "exr")]
fn write_exr(path: &Path, buffer: &image::Rgba32FImage) -> Result<(), image::ImageError> {
    buffer.save_with_format(path, image::ImageFormat::OpenExr)
}

/// Iterates over the rows of pixels from the topmost, as in files.
#[cfg(feature = "image")]
fn from_the_top<R: crate::Type>(image: &Image<R>) -> impl Iterator<Item = R> {
    image.rows().rev().flatten().copied()
}
