//! Environments: light from all around, from HDR and EXR pictures.

use std::io::Cursor;
use std::path::Path;

use exr::image::RgbChannels;
use exr::math::Vec2;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels as _, ReadLayers as _};
use glam::Vec3;
use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;

use crate::error::one_line;
use crate::format::{self, Format, loader};
use crate::source::Source;
use crate::{LoadError, Place};

/// Texels of a side at most.
const LONGEST: u64 = 1 << 15;
/// Texels at most.
const MOST: u64 = 1 << 28;
/// Texels for each byte of the file at most, as of deflate's best.
const DENSEST: u64 = 1032;
/// Bytes of a block of an EXR at most; a row of it, of many channels, may be 1 MiB.
const LARGEST_BLOCK: u64 = 1 << 28;

const REMEDY: &str = "write it again, as HDR or as EXR of 16 or 32 bits with channels R, G and B";

/// Holds the radiance of all directions, in latitudes and longitudes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Environment {
    /// Texels in a row, which is once around the horizon; from 1 to 32768.
    pub width: u32,
    /// Rows, from 1 to 32768: the first is at the top, where `y` is greatest.
    pub height: u32,
    /// Linear red, green and blue, row by row from the top, each finite and not negative. The unit
    /// is that of the file, mostly relative to some white.
    pub texels: Vec<Vec3>,
}

type Reading = fn(Source) -> Result<Environment, LoadError>;

const FORMATS: [Format<Reading>; 2] = [
    Format {
        extension: "hdr",
        name: "HDR",
        feature: "environment",
        read: loader!("environment", crate::environment::read_hdr),
    },
    Format {
        extension: "exr",
        name: "EXR",
        feature: "environment",
        read: loader!("environment", crate::environment::read_exr),
    },
];

/// Loads an environment by its file's extension, in any case: `.hdr` or `.exr`.
///
/// Of an EXR it is the first layer with channels `R`, `G` and `B`; alpha is passed over. It is
/// uncompressed, or compressed by RLE, ZIP, PIZ or PXR24. The primaries of the colours are not looked at, nor the exposure of an HDR.
///
/// # Errors
///
/// When the file is missing, unreadable, of unknown extension, cut off or corrupt, has a texel that
/// is negative or not finite, more than 32768 texels a side or 2^28 in all, or more than 1032 for
/// each of its bytes.
///
/// # Examples
///
/// ```no_run
/// let sky = raydsl_io::environment::load("garden.hdr")?;
/// println!("{} x {}, at the top left {}", sky.width, sky.height, sky.texels[0]);
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
pub fn load(path: impl AsRef<Path>) -> Result<Environment, LoadError> {
    let path = path.as_ref();
    let (format, read) = format::of(path, &FORMATS)?;
    read(Source::open(path, format.name)?)
}

fn read_hdr(mut source: Source) -> Result<Environment, LoadError> {
    let bytes = source.rest()?;
    let wrong = |e: image::ImageError| match e {
        image::ImageError::IoError(e) => io_error(&source, e),
        e => source.corrupt(Place::Somewhere, one_line(e), REMEDY),
    };
    // Some programs write another name into the first line.
    let decoder = HdrDecoder::new_nonstrict(Cursor::new(&bytes)).map_err(wrong)?;
    let (width, height) = decoder.dimensions();
    let count = size(&source, u64::from(width), u64::from(height))?;
    let (mut bytes, len) = (Vec::new(), count * size_of::<[f32; 3]>());
    if bytes.try_reserve_exact(len).is_err() {
        return Err(no_memory(&source, count));
    }
    bytes.resize(len, 0);
    decoder.read_image(&mut bytes).map_err(wrong)?;
    let float = |bytes: &[u8; 4]| f32::from_ne_bytes(*bytes);
    let channels = bytes.as_chunks().0.as_chunks().0.iter();
    let texels = channels.map(|c| Vec3::from(c.each_ref().map(float))).collect();
    checked(&source, Environment { width, height, texels })
}

fn read_exr(mut source: Source) -> Result<Environment, LoadError> {
    let bytes = source.rest()?;
    let wrong = |e| match e {
        exr::error::Error::Io(e) => io_error(&source, e),
        e => source.corrupt(Place::Somewhere, one_line(e), REMEDY),
    };
    let chunks = exr::block::read(Cursor::new(&bytes), false).map_err(wrong)?;
    for header in chunks.headers() {
        check_exr(&source, header)?;
    }
    let picture = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size: Vec2<usize>, _: &RgbChannels| (size.width(), vec![Vec3::ZERO; size.area()]),
            |(width, texels), at: Vec2<usize>, (red, green, blue): (f32, f32, f32)| {
                if let Some(texel) = texels.get_mut(at.y() * *width + at.x()) {
                    *texel = Vec3::new(red, green, blue);
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_chunks(chunks)
        .map_err(wrong)?;
    let (layer, whole) = (picture.layer_data, picture.attributes.display_window);
    if layer.size != whole.size || layer.attributes.layer_position != whole.position {
        let what = "its data window is not its display window".into();
        return Err(source.corrupt(Place::Somewhere, what, "write it again without a crop"));
    }
    let (width, height) = (layer.size.width() as u32, layer.size.height() as u32);
    checked(&source, Environment { width, height, texels: layer.channel_data.pixels.1 })
}

/// Checks what decides how much memory the decoder takes.
fn check_exr(source: &Source, header: &Header) -> Result<(), LoadError> {
    let whole = header.layer_size;
    size(source, whole.width() as u64, whole.height() as u64)?;
    // The decoder of the others panics on damaged blocks, or does not exist.
    use exr::compression::Compression::{PIZ, PXR24, RLE, Uncompressed, ZIP1, ZIP16};
    if !matches!(header.compression, Uncompressed | RLE | ZIP1 | ZIP16 | PIZ | PXR24) {
        let what = format!("its compression, {}, is not supported", header.compression);
        return Err(source.corrupt(Place::Somewhere, what, "write it again, compressed by ZIP"));
    }
    let block = header.max_block_pixel_size();
    let texel = header.channels.bytes_per_pixel as u64;
    let texels = (block.width() as u64).checked_mul(block.height() as u64);
    let bytes = texels.and_then(|n| n.checked_mul(texel));
    if bytes.is_none_or(|bytes| bytes > LARGEST_BLOCK) {
        let what = format!(
            "blocks of {} x {} texels of {texel} bytes are larger than {LARGEST_BLOCK} bytes",
            block.width(),
            block.height()
        );
        return Err(source.corrupt(Place::Somewhere, what, REMEDY));
    }
    Ok(())
}

/// What the operating system, or the end of the file, tells a decoder.
fn io_error(source: &Source, e: std::io::Error) -> LoadError {
    match e.kind() {
        std::io::ErrorKind::UnexpectedEof => {
            source.truncated("it ends within its header or its texels".into())
        }
        _ => source.corrupt(Place::Somewhere, one_line(e), REMEDY),
    }
}

/// The number of texels, unless they are too many, or too many for the bytes of the file.
fn size(source: &Source, width: u64, height: u64) -> Result<usize, LoadError> {
    let count = width.saturating_mul(height);
    if width.max(height) > LONGEST || count > MOST {
        let (path, what, limit) = (source.path.clone(), "texel", MOST);
        let remedy = "make it smaller, at most 32768 texels a side";
        return Err(LoadError::TooMany { path, what, count, limit, remedy });
    }
    if count == 0 || count > DENSEST.saturating_mul(source.len) {
        let what = format!("{} bytes claim {width} x {height} texels", source.len);
        return Err(source.corrupt(Place::Somewhere, what, REMEDY));
    }
    usize::try_from(count).map_err(|_| no_memory(source, usize::MAX))
}

fn no_memory(source: &Source, count: usize) -> LoadError {
    let (path, remedy) = (source.path.clone(), "make it smaller");
    LoadError::OutOfMemory { path, what: "texel", count: count as u64, remedy }
}

/// The environment, if all texels are light.
fn checked(source: &Source, sky: Environment) -> Result<Environment, LoadError> {
    let is_light = |c: &Vec3| c.is_finite() && c.min_element() >= 0.0;
    let Some(first) = sky.texels.iter().position(|c| !is_light(c)) else { return Ok(sky) };
    let (row, column) = (first / sky.width as usize, first % sky.width as usize);
    let what = format!(
        "its texel in row {row} and column {column}, counted from 0, is {}",
        sky.texels[first]
    );
    let remedy = "replace its texels that are negative, infinite or no number";
    Err(source.corrupt(Place::Somewhere, what, remedy))
}
