//! NRRD, and NHDR with the voxels in a file beside it.

use crate::error::word_text;
use crate::fields::{Fields, Value, check_length};
use crate::payload::{Compression, Payload, open_beside, place};
use crate::source::Source;
use crate::volume::{ByteOrder, VolumeFile, VoxelType, Voxels};
use crate::{LoadError, Place};

const REMEDY: &str = "write it again, for example with `unu save -f nrrd -e gzip`";

/// How voxels are written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Raw,
    Gzip,
    Text,
}

pub(crate) fn read(mut source: Source, _: Option<&str>) -> Result<VolumeFile, LoadError> {
    let fields = header(&mut source)?;
    let axes = fields.required(&source, "dimension", REMEDY)?;
    let axes = match axes.numbers(&source, REMEDY)? {
        [n @ 1..=3] => n,
        [n] => {
            let what =
                format!("it has {n} axes, and three are read, with one number for each voxel");
            return Err(source.corrupt(Place::Line(axes.line), what, REMEDY));
        }
    };
    let size = fields.required(&source, "sizes", REMEDY)?;
    let size = spread(&source, size, axes, 1)?;
    let kind = fields.required(&source, "type", REMEDY)?;
    let kind = kind_of(kind.text).ok_or_else(|| kind.wrong(&source, REMEDY))?;
    let encoding = fields.required(&source, "encoding", REMEDY)?;
    let encoding = match &*encoding.text.to_ascii_lowercase() {
        "raw" => Encoding::Raw,
        "gzip" | "gz" => Encoding::Gzip,
        "ascii" | "text" | "txt" => Encoding::Text,
        _ => return Err(encoding.wrong(&source, REMEDY)),
    };
    let order = match fields.get(&["endian"]).map(|value| (value.text, value)) {
        Some(("little", _)) => ByteOrder::Little,
        Some(("big", _)) => ByteOrder::Big,
        Some((_, value)) => return Err(value.wrong(&source, REMEDY)),
        None if kind.size() == 1 || encoding == Encoding::Text => ByteOrder::Little,
        None => fields.required(&source, "endian", REMEDY).map(|_| ByteOrder::Little)?,
    };
    let payload = Payload::new(&source, size, kind, order)?;
    let to_world = to_world(&source, &fields, axes)?;
    let is_cell_centred = is_cell_centred(&source, &fields)?;
    let count = |names: &[&str]| match fields.get(names) {
        None => Ok(0),
        Some(value) => value.numbers(&source, REMEDY).map(|[n]: [i64; 1]| n),
    };
    let lines = count(&["line skip", "lineskip"])?;
    let bytes = count(&["byte skip", "byteskip"])?;
    let mut data = match fields.get(&["data file", "datafile"]) {
        None => source,
        Some(file) if file.text.starts_with("LIST") || file.text.contains('%') => {
            let what = "its voxels are in a list of files, and one file is read";
            return Err(source.corrupt(Place::Line(file.line), what.into(), REMEDY));
        }
        Some(file) => open_beside(&source, file.text)?,
    };
    let voxels = voxels(&mut data, &payload, encoding, lines, bytes)?;
    let mut volume = payload.volume(voxels, to_world);
    volume.is_cell_centred = is_cell_centred;
    Ok(volume)
}

fn voxels(
    data: &mut Source,
    payload: &Payload,
    encoding: Encoding,
    lines: i64,
    bytes: i64,
) -> Result<Voxels, LoadError> {
    let mut line = Vec::new();
    for i in 0..lines.max(0) {
        if !data.next_line(&mut line)? {
            return Err(data.truncated(format!("{i} of {lines} lines before the voxels are there")));
        }
    }
    let gap = match u64::try_from(bytes) {
        Ok(gap) => gap,
        // -1 says that the voxels are at the end.
        Err(_) if bytes == -1 && encoding == Encoding::Raw => {
            data.remaining().saturating_sub(payload.bytes())
        }
        Err(_) => {
            let what = format!("its voxels begin {bytes} bytes behind its header");
            return Err(data.corrupt(Place::Somewhere, what, REMEDY));
        }
    };
    if encoding == Encoding::Gzip {
        return payload.read_packed(data, Compression::Gzip, gap, REMEDY);
    }
    if !data.skip(gap)? {
        let what = format!("{gap} bytes come before the voxels, {} are there", data.remaining());
        return Err(data.truncated(what));
    }
    if encoding == Encoding::Raw {
        return payload.read_plain(data, REMEDY);
    }
    payload.claim().check_text(data, data.remaining())?;
    payload.read_text(data).map_err(|fault| data.fault(fault, REMEDY))
}

/// Reads a header, with the empty line that ends it. A header without voxels may end without one.
fn header(source: &mut Source) -> Result<Fields, LoadError> {
    let (mut fields, mut line) = (Fields::default(), Vec::new());
    loop {
        if !source.next_line(&mut line)? {
            if fields.get(&["data file", "datafile"]).is_some() {
                return Ok(fields);
            }
            return Err(source.truncated("it ends within its header".into()));
        }
        check_length(source, REMEDY)?;
        if source.line == 1 {
            if !line.starts_with(b"NRRD000") {
                let what = format!("it begins with '{}' instead of 'NRRD000'", word_text(&line));
                return Err(source.bad_line(what, "check that the file is a NRRD"));
            }
            continue;
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_end();
        if text.is_empty() {
            return Ok(fields);
        }
        // A comment, or a pair of a key and its value, which is the writer's own.
        let is_key = text.find(":=").is_some_and(|key| text.find(": ").is_none_or(|at| key < at));
        if text.starts_with('#') || is_key {
            continue;
        }
        let Some((name, value)) = text.split_once(':') else {
            let what = format!("'{}' is no line of a header", word_text(&line));
            return Err(source.bad_line(what, REMEDY));
        };
        fields.add(source, &name.to_ascii_lowercase(), value, REMEDY)?;
    }
}

/// A list of one to three numbers; those that it lacks are `rest`.
fn spread<T: std::str::FromStr + Copy>(
    source: &Source,
    value: Value<'_>,
    axes: usize,
    rest: T,
) -> Result<[T; 3], LoadError> {
    Ok(match axes {
        1 => value.numbers(source, REMEDY).map(|[x]| [x, rest, rest])?,
        2 => value.numbers(source, REMEDY).map(|[x, y]| [x, y, rest])?,
        _ => value.numbers(source, REMEDY)?,
    })
}

fn to_world(source: &Source, fields: &Fields, axes: usize) -> Result<glam::Affine3, LoadError> {
    let mut steps = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut line = None;
    if let Some(value) = fields.get(&["space directions"]) {
        line = Some(value.line);
        let vectors = vectors(source, value)?;
        if axes != 3 || vectors.len() != 3 {
            let what = format!("it has {} directions for {axes} axes, 3 are read", vectors.len());
            return Err(source.corrupt(Place::Line(value.line), what, REMEDY));
        }
        steps.copy_from_slice(&vectors);
    } else if let Some(value) = fields.get(&["spacings"]) {
        line = Some(value.line);
        for (i, d) in spread(source, value, axes, 1.0)?.into_iter().enumerate() {
            steps[i][i] = d;
        }
    }
    let origin = match fields.get(&["space origin"]) {
        None => [0.0; 3],
        Some(value) => match vectors(source, value)?[..] {
            [origin] => origin,
            _ => return Err(value.wrong(source, REMEDY)),
        },
    };
    place(steps, origin).ok_or_else(|| {
        let what = "its spacings, directions or origin are not finite, or have no inverse".into();
        source.corrupt(line.map_or(Place::Somewhere, Place::Line), what, REMEDY)
    })
}

/// Vectors of three numbers, `(x,y,z)` each.
fn vectors(source: &Source, value: Value<'_>) -> Result<Vec<[f64; 3]>, LoadError> {
    let mut vectors = Vec::new();
    let mut rest = value.text.trim();
    while !rest.is_empty() {
        let vector = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
        let numbers = vector.and_then(|(inner, _)| {
            let numbers = inner.split(',').map(|word| word.trim().parse().ok()).take(4);
            <[f64; 3]>::try_from(numbers.collect::<Option<Vec<f64>>>()?).ok()
        });
        let (Some((_, behind)), Some(numbers)) = (vector, numbers) else {
            return Err(value.wrong(source, REMEDY));
        };
        vectors.push(numbers);
        rest = behind.trim_start();
    }
    Ok(vectors)
}

/// Whether voxels are cells: unless all axes that say something say that they are nodes.
fn is_cell_centred(source: &Source, fields: &Fields) -> Result<bool, LoadError> {
    let Some(value) = fields.get(&["centers", "centerings"]) else { return Ok(true) };
    let (mut cells, mut nodes) = (false, false);
    for word in value.text.split_whitespace() {
        match word {
            "cell" => cells = true,
            "node" => nodes = true,
            "none" | "???" => {}
            _ => return Err(value.wrong(source, REMEDY)),
        }
    }
    Ok(cells || !nodes)
}

fn kind_of(name: &str) -> Option<VoxelType> {
    Some(match name {
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => VoxelType::U8,
        "signed char" | "int8" | "int8_t" => VoxelType::I8,
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => {
            VoxelType::U16
        }
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => {
            VoxelType::I16
        }
        "uint" | "unsigned int" | "uint32" | "uint32_t" => VoxelType::U32,
        "int" | "signed int" | "int32" | "int32_t" => VoxelType::I32,
        "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => {
            VoxelType::U64
        }
        "longlong"
        | "long long"
        | "long long int"
        | "signed long long"
        | "signed long long int"
        | "int64"
        | "int64_t" => VoxelType::I64,
        "float" => VoxelType::F32,
        "double" => VoxelType::F64,
        _ => return None,
    })
}
