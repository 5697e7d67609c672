//! MetaImage: MHA, and MHD with the voxels in a file beside it.

use crate::error::word_text;
use crate::fields::{Fields, Value, check_length};
use crate::payload::{Compression, Payload, open_beside, place};
use crate::source::Source;
use crate::volume::{ByteOrder, VolumeFile, VoxelType, Voxels};
use crate::{LoadError, Place};

const REMEDY: &str = "write it again, for example with SimpleITK";

pub(crate) fn read(mut source: Source, _: Option<&str>) -> Result<VolumeFile, LoadError> {
    let fields = header(&mut source)?;
    let axes = match fields.required(&source, "NDims", REMEDY)? {
        Value { text: "2", .. } => 2,
        Value { text: "3", .. } => 3,
        other => return Err(other.wrong(&source, REMEDY)),
    };
    let size = fields.required(&source, "DimSize", REMEDY)?;
    let size = spread(&source, size, axes, 1)?;
    let kind = fields.required(&source, "ElementType", REMEDY)?;
    let kind = kind_of(kind.text).ok_or_else(|| kind.wrong(&source, REMEDY))?;
    if let Some(channels) = fields.get(&["ElementNumberOfChannels"])
        && channels.numbers::<u64, 1>(&source, REMEDY)? != [1]
    {
        let what = format!("it has {} numbers for each voxel, and one is read", channels.text);
        return Err(source.corrupt(Place::Line(channels.line), what, REMEDY));
    }
    let flag = |names: &[&str], default: bool| match fields.get(names) {
        None => Ok(default),
        Some(value) => match value.text.as_bytes().first() {
            Some(b'T' | b't' | b'1') => Ok(true),
            Some(b'F' | b'f' | b'0') => Ok(false),
            _ => Err(value.wrong(&source, REMEDY)),
        },
    };
    let is_binary = flag(&["BinaryData"], true)?;
    let is_packed = flag(&["CompressedData"], false)?;
    let order = match flag(&["BinaryDataByteOrderMSB", "ElementByteOrderMSB"], false)? {
        true => ByteOrder::Big,
        false => ByteOrder::Little,
    };
    let payload = Payload::new(&source, size, kind, order)?;
    let to_world = to_world(&source, &fields, axes)?;
    let factor = |name: &str, default: f32| match fields.get(&[name]) {
        None => Ok(default),
        Some(value) => match value.numbers(&source, REMEDY)? {
            [factor] if f32::is_finite(factor) => Ok(factor),
            _ => Err(value.wrong(&source, REMEDY)),
        },
    };
    let scale = factor("ElementToIntensityFunctionSlope", 1.0)?;
    let offset = factor("ElementToIntensityFunctionOffset", 0.0)?;
    let skipped = match fields.get(&["HeaderSize"]) {
        None => [0],
        Some(value) => value.numbers::<i64, 1>(&source, REMEDY)?,
    };
    let file = fields.required(&source, "ElementDataFile", REMEDY)?;
    let mut data = match file.text {
        "LOCAL" => source,
        "LIST" => {
            let what = "its voxels are in a list of files, and one file is read";
            return Err(source.corrupt(Place::Line(file.line), what.into(), REMEDY));
        }
        name => {
            let mut data = open_beside(&source, name)?;
            // -1 says that the voxels are at the end.
            let skipped = u64::try_from(skipped[0])
                .unwrap_or_else(|_| data.len.saturating_sub(payload.bytes()));
            if !data.skip(skipped)? {
                let what = format!("the voxels begin at byte {skipped} of {}", data.len);
                return Err(data.truncated(what));
            }
            data
        }
    };
    let voxels = voxels(&mut data, &payload, is_binary, is_packed)?;
    let mut volume = payload.volume(voxels, to_world);
    (volume.scale, volume.offset) = (scale, offset);
    Ok(volume)
}

fn voxels(
    data: &mut Source,
    payload: &Payload,
    is_binary: bool,
    is_packed: bool,
) -> Result<Voxels, LoadError> {
    if is_packed {
        let compression =
            if data.starts_with(&[0x1f])? { Compression::Gzip } else { Compression::Zlib };
        return payload.read_packed(data, compression, 0, REMEDY);
    }
    if is_binary {
        return payload.read_plain(data, REMEDY);
    }
    payload.claim().check_text(data, data.remaining())?;
    payload.read_text(data).map_err(|fault| data.fault(fault, REMEDY))
}

/// Reads a header; its last line names the file with the voxels.
fn header(source: &mut Source) -> Result<Fields, LoadError> {
    let (mut fields, mut line) = (Fields::default(), Vec::new());
    loop {
        if !source.next_line(&mut line)? {
            return Err(source.truncated("it ends within its header".into()));
        }
        let text = String::from_utf8_lossy(&line);
        let Some((name, value)) = text.split_once('=') else {
            check_length(source, REMEDY)?;
            if text.trim().is_empty() {
                continue;
            }
            let what = format!("'{}' is no line of a header", word_text(&line));
            return Err(source.bad_line(what, REMEDY));
        };
        fields.add(source, name, value, REMEDY)?;
        if name.trim() == "ElementDataFile" {
            return Ok(fields);
        }
    }
}

/// A list of two or three numbers; a third that it lacks is `third`.
fn spread<T: std::str::FromStr>(
    source: &Source,
    value: Value<'_>,
    axes: usize,
    third: T,
) -> Result<[T; 3], LoadError> {
    if axes == 3 {
        return value.numbers(source, REMEDY);
    }
    let [x, y] = value.numbers(source, REMEDY)?;
    Ok([x, y, third])
}

fn to_world(source: &Source, fields: &Fields, axes: usize) -> Result<glam::Affine3, LoadError> {
    let spacing_line = fields.get(&["ElementSpacing", "ElementSize"]);
    let spacing = match spacing_line {
        Some(value) => spread(source, value, axes, 1.0)?,
        None => [1.0; 3],
    };
    let origin = match fields.get(&["Offset", "Position", "Origin"]) {
        Some(value) => spread(source, value, axes, 0.0)?,
        None => [0.0; 3],
    };
    // The direction of each axis in turn.
    let matrix = match fields.get(&["TransformMatrix", "Rotation", "Orientation"]) {
        None => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        Some(value) if axes == 2 => {
            let [a, b, c, d] = value.numbers(source, REMEDY)?;
            [[a, b, 0.0], [c, d, 0.0], [0.0, 0.0, 1.0]]
        }
        Some(value) => {
            let [a, b, c, d, e, f, g, h, i] = value.numbers(source, REMEDY)?;
            [[a, b, c], [d, e, f], [g, h, i]]
        }
    };
    let steps = [0, 1, 2].map(|i| matrix[i].map(|c: f64| c * spacing[i]));
    place(steps, origin).ok_or_else(|| {
        let what = "its spacing, offset or matrix is not finite, or has no inverse".into();
        let place = spacing_line.map_or(Place::Somewhere, |value| Place::Line(value.line));
        source.corrupt(place, what, REMEDY)
    })
}

fn kind_of(name: &str) -> Option<VoxelType> {
    Some(match name {
        "MET_UCHAR" => VoxelType::U8,
        "MET_CHAR" => VoxelType::I8,
        "MET_USHORT" => VoxelType::U16,
        "MET_SHORT" => VoxelType::I16,
        // In files a long has 32 bits.
        "MET_UINT" | "MET_ULONG" => VoxelType::U32,
        "MET_INT" | "MET_LONG" => VoxelType::I32,
        "MET_ULONG_LONG" => VoxelType::U64,
        "MET_LONG_LONG" => VoxelType::I64,
        "MET_FLOAT" => VoxelType::F32,
        "MET_DOUBLE" => VoxelType::F64,
        _ => return None,
    })
}
