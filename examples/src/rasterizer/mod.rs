//! Triangles with a depth buffer, drawn by a device or by code.
//!
//! Both make a picture of [`Fragment`]s as rays do: rows from the bottom, transparent where nothing
//! is, and the depth of the window, from 0 (near) to 1.

mod device;
mod software;

use raydsl::gpu::{Context, GpuError};
use raydsl::prelude::*;
use raydsl::render::Fragment;

/// What a pixel has where nothing is drawn.
pub const NOTHING: Fragment = Fragment { color: Vec4::ZERO, depth: 1.0 };

/// A corner of a triangle: where it is, and its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// In the scene.
    pub place: Vec3,
    /// Red, green and blue.
    pub color: Vec3,
}

/// Why nothing was drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RasterizerError {
    /// wgpu was asked for and has no device.
    #[error(transparent)]
    NoDevice(#[from] GpuError),
    /// The device has no such textures.
    #[error(
        "a picture of {width}x{height} is too large for the device, whose textures have up to \
         {limit} pixels each way: make it smaller, or draw with `software`"
    )]
    TooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// The most of either.
        limit: u32,
    },
    /// The device did not do it.
    #[error("the device did not draw: {reason}")]
    Refused {
        /// In wgpu's words.
        reason: String,
    },
}

/// What draws triangles.
#[derive(Debug)]
pub enum Rasterizer {
    /// A render pass of wgpu.
    Wgpu(Box<Context>),
    /// A loop over pixels.
    Software,
}

impl Rasterizer {
    /// A render pass of wgpu on the fastest device.
    ///
    /// # Errors
    ///
    /// If there is no device.
    pub fn wgpu() -> Result<Self, RasterizerError> {
        Ok(Self::Wgpu(Box::new(Context::new()?)))
    }

    /// The rasteriser of this name, `wgpu` or `software`. Without a name it is wgpu's, or where
    /// there is no device, which is said, the software one.
    ///
    /// # Errors
    ///
    /// A name that is none, or `wgpu` without a device.
    pub fn named(name: Option<&str>) -> Result<Self, Box<dyn std::error::Error>> {
        match name {
            Some("software") => Ok(Self::Software),
            Some("wgpu") => Ok(Self::wgpu()?),
            Some(other) => {
                Err(format!("there is no rasterizer `{other}`: write wgpu or software").into())
            }
            None => Ok(Self::wgpu().unwrap_or_else(|error| {
                eprintln!("drawing with software: {error}");
                Self::Software
            })),
        }
    }

    /// What it runs on.
    pub fn place(&self) -> String {
        match self {
            Self::Wgpu(context) => context.adapter_name(),
            Self::Software => "software".to_owned(),
        }
    }

    /// Draws triangles seen through `clip`, the product of projection and view, whose near plane
    /// has depth 0. The software rasteriser leaves out those that reach in front of it, a device
    /// cuts them.
    ///
    /// # Errors
    ///
    /// If the picture is too large for the device, or that fails.
    pub fn draw(
        &self,
        triangles: &[[Corner; 3]],
        clip: Mat4,
        (width, height): (u32, u32),
    ) -> Result<Image<Fragment>, RasterizerError> {
        let mut image = Image::filled(width, height, NOTHING);
        match self {
            // wgpu refuses textures and buffers of nothing.
            Self::Wgpu(_) if triangles.is_empty() || image.pixels().is_empty() => {}
            Self::Wgpu(context) => device::draw(context, triangles, clip, &mut image)?,
            Self::Software => software::draw(triangles, clip, &mut image),
        }
        Ok(image)
    }
}

#[cfg(test)]
mod tests;
