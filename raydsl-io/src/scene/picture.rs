//! Pictures of scenes.

use std::io::Cursor;

use image::{ImageFormat, ImageReader, Limits};

use super::Image;
use crate::error::one_line;

/// Texels of a side at most.
const LONGEST: u32 = 1 << 14;
/// Texels of all pictures of a scene at most.
const MOST: u64 = 1 << 28;
/// Texels for each byte: PNG's greatest compression, 1032, of texels of one bit.
const DENSEST: u64 = 8 * 1032;

const REMEDY: &str = "write the picture again as PNG or JPEG, no larger than 16384 texels a side";

/// What is left for pictures.
pub(super) struct Room {
    texels: u64,
    /// Bytes of files that are decoded.
    bytes: u64,
}

impl Room {
    /// For a scene of so many bytes. Pictures may share bytes, which takes time for each of them.
    pub(super) fn new(bytes: u64) -> Self {
        Self { texels: MOST, bytes: bytes.saturating_mul(8).saturating_add(1 << 22) }
    }

    /// Adds what is not in the scene's own file.
    pub(super) fn add(&mut self, bytes: u64) {
        self.bytes = self.bytes.saturating_add(bytes);
    }

    /// Decodes a PNG or JPEG picture; or what is wrong with it, and a remedy.
    pub(super) fn decode(
        &mut self,
        bytes: &[u8],
        name: String,
    ) -> Result<Image, (String, &'static str)> {
        let Some(left) = self.bytes.checked_sub(bytes.len() as u64) else {
            return Err(("its pictures share their bytes too often".into(), REMEDY));
        };
        self.bytes = left;
        let format = match bytes {
            [0x89, b'P', b'N', b'G', ..] => ImageFormat::Png,
            [0xff, 0xd8, ..] => ImageFormat::Jpeg,
            _ => return Err(("it is neither PNG nor JPEG".into(), REMEDY)),
        };
        let reader = || {
            let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
            let mut limits = Limits::default();
            (limits.max_image_width, limits.max_image_height) = (Some(LONGEST), Some(LONGEST));
            // Of 16 bits a channel, which is the most that a file has.
            limits.max_alloc = Some(8 * MOST);
            reader.limits(limits);
            reader
        };
        let wrong = |e: image::ImageError| (one_line(e), REMEDY);
        let (width, height) = reader().into_dimensions().map_err(wrong)?;
        let texels = u64::from(width) * u64::from(height);
        if texels == 0 {
            return Err(("it has no texel".into(), REMEDY));
        }
        if width > LONGEST || height > LONGEST || texels > DENSEST * bytes.len() as u64 {
            let what = format!("{} bytes claim {width} x {height} texels", bytes.len());
            return Err((what, REMEDY));
        }
        let Some(left) = self.texels.checked_sub(texels) else {
            let remedy = "make its pictures smaller";
            return Err((format!("all pictures have more than {MOST} texels"), remedy));
        };
        self.texels = left;
        let texels = reader().decode().map_err(wrong)?.into_rgba8().into_raw();
        let (texels, _) = texels.as_chunks();
        Ok(Image { name, width, height, texels: texels.to_vec() })
    }
}
