//! Stacks of pictures: a PNG for each layer.

use std::path::Path;

use glam::Affine3;
use png::{BitDepth, ColorType, DecodingError};

use crate::error::one_line;
use crate::payload::Payload;
use crate::source::{Fault, Source};
use crate::volume::{ByteOrder, VolumeFile, VoxelType, Voxels};
use crate::{LoadError, Place};

const REMEDY: &str = "write it again, for example with ImageMagick";
const GREY: &str = "convert it to grey of 8 or 16 bits, for example with ImageMagick";

pub(crate) fn read(layers: &[&Path]) -> Result<VolumeFile, LoadError> {
    let [first, others @ ..] = layers else {
        return Err(LoadError::Empty { path: "a stack of pictures".into(), what: "picture" });
    };
    let (mut source, mut bytes) = (Source::open(first, "PNG")?, Vec::new());
    let depth = layers.len() as u64;
    let payload = decode(&mut source, &mut bytes, depth)?;
    // Room is made once one layer is there.
    let room = match payload.kind {
        VoxelType::U8 => payload.room().map(Voxels::U8),
        _ => payload.room().map(Voxels::U16),
    };
    let mut voxels = room.map_err(|fault| source.fault(fault, REMEDY))?;
    append(&mut voxels, &bytes);
    for layer in others {
        source = Source::open(layer, "PNG")?;
        let other = decode(&mut source, &mut bytes, depth)?;
        if (other.size, other.kind) != (payload.size, payload.kind) {
            let text = |p: &Payload| format!("{} x {} of {}", p.size.x, p.size.y, p.kind.name());
            let what = format!("it is {}, the first is {}", text(&other), text(&payload));
            let remedy = "write all pictures in one size and type";
            return Err(source.corrupt(Place::Somewhere, what, remedy));
        }
        append(&mut voxels, &bytes);
    }
    Ok(payload.volume(voxels, Affine3::IDENTITY))
}

/// Adds a layer.
fn append(voxels: &mut Voxels, bytes: &[u8]) {
    match voxels {
        Voxels::U8(voxels) => voxels.extend(bytes),
        Voxels::U16(voxels) => {
            voxels.extend(bytes.as_chunks().0.iter().map(|n| u16::from_be_bytes(*n)));
        }
        Voxels::I16(_) | Voxels::F32(_) => unreachable!("pixels are of no other type"),
    }
}

/// Decodes a picture into `bytes`, and tells what a stack of `depth` like it is.
fn decode(source: &mut Source, bytes: &mut Vec<u8>, depth: u64) -> Result<Payload, LoadError> {
    let head = reader(source).map(|reader| {
        let info = reader.info();
        (info.size(), info.color_type, info.bit_depth)
    });
    let ((width, height), color, bits) = head.map_err(|fault| source.fault(fault, REMEDY))?;
    let kind = match (color, bits) {
        (ColorType::Grayscale, BitDepth::Eight) => VoxelType::U8,
        (ColorType::Grayscale, BitDepth::Sixteen) => VoxelType::U16,
        _ => {
            let what = format!("its pixels are {color:?} of {} bits", bits as u8);
            return Err(source.corrupt(Place::Somewhere, what, GREY));
        }
    };
    let claim = |source: &Source, depth: u64| {
        Payload::new(source, [width.into(), height.into(), depth], kind, ByteOrder::Big)
    };
    let stack = claim(source, depth)?;
    let picture = claim(source, 1)?;
    picture.claim().check_packed(source, source.len)?;
    source.go_to(0)?;
    let decoded = pixels(source, bytes, picture.bytes() as usize);
    decoded.map_err(|fault| source.fault(fault, REMEDY))?;
    Ok(stack)
}

/// Reads what comes before the pixels.
fn reader(source: &mut Source) -> Result<png::Reader<&mut Source>, Fault> {
    let mut decoder = png::Decoder::new(source);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    decoder.read_info().map_err(fault)
}

fn pixels(source: &mut Source, bytes: &mut Vec<u8>, length: usize) -> Result<(), Fault> {
    let mut reader = reader(source)?;
    bytes.clear();
    bytes.try_reserve_exact(length).map_err(|_| Fault::NoRoom {
        what: "pixel",
        count: length as u64,
        remedy: "halve its resolution",
    })?;
    bytes.resize(length, 0);
    if reader.output_buffer_size() != Some(length) {
        return Err(Fault::Bad("its pixels are not those of its size".into()));
    }
    let frame = reader.next_frame(bytes).map_err(fault)?;
    // A first frame of an animation may be smaller.
    if frame.buffer_size() != length {
        return Err(Fault::Bad("its first frame is smaller than the picture".into()));
    }
    reader.finish().map_err(fault)
}

fn fault(e: DecodingError) -> Fault {
    match e {
        DecodingError::IoError(e) => Fault::Io(e),
        other => Fault::Bad(one_line(other)),
    }
}
