//! Pictures that move: PNG with several frames (APNG), which browsers play.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::sync::Arc;

use png::{BitDepth, ColorType, Encoder, EncodingError};

/// Writes frames of four bytes a pixel, from the top; there is at least one. It begins again after the
/// last one.
pub(crate) fn write_film(
    path: &Path,
    frames: &[Arc<Vec<u8>>],
    (width, height): (u32, u32),
    rate: u16,
) -> Result<(), EncodingError> {
    let mut encoder = Encoder::new(BufWriter::new(File::create(path)?), width, height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_animated(frames.len() as u32, 0)?;
    encoder.set_frame_delay(1, rate)?;
    let mut writer = encoder.write_header()?;
    for frame in frames {
        writer.write_image_data(frame)?;
    }
    writer.finish()
}
