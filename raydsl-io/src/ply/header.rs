//! What a header says of the elements that follow it.

use super::REMEDY;
use crate::LoadError;
use crate::error::word_text;
use crate::source::Source;

/// Headers are far shorter.
const LONGEST: u64 = 1 << 20;

/// How the elements are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// Bytes of a binary number.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number of little-endian bytes, of which the first [`size`](Self::size) count. A double
    /// holds every one.
    pub(super) fn decode(self, [a, b, c, d, e, f, g, h]: [u8; 8]) -> f64 {
        match self {
            Self::I8 => i8::from_le_bytes([a]).into(),
            Self::U8 => a.into(),
            Self::I16 => i16::from_le_bytes([a, b]).into(),
            Self::U16 => u16::from_le_bytes([a, b]).into(),
            Self::I32 => i32::from_le_bytes([a, b, c, d]).into(),
            Self::U32 => u32::from_le_bytes([a, b, c, d]).into(),
            Self::F32 => f32::from_le_bytes([a, b, c, d]).into(),
            Self::F64 => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        }
    }
}

/// The type of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Scalar),
    /// The types of the count and of the items.
    List(Scalar, Scalar),
}

#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// The place of a property that is a number.
    pub(super) fn scalar(&self, name: &str) -> Option<usize> {
        let found = |p: &Property| p.name == name && matches!(p.kind, Kind::Scalar(_));
        self.properties.iter().position(found)
    }

    /// The fewest bytes that a row takes.
    pub(super) fn least_size(&self, encoding: Encoding) -> u64 {
        let sizes = self.properties.iter().map(|p| match (encoding, p.kind) {
            // A digit, and what parts it from the next.
            (Encoding::Ascii, _) => 2,
            (_, Kind::Scalar(kind) | Kind::List(kind, _)) => kind.size() as u64,
        });
        sizes.sum()
    }

    /// The bytes of every row, where all are of one size.
    pub(super) fn size(&self) -> Option<u64> {
        let is_scalar = |p: &Property| matches!(p.kind, Kind::Scalar(_));
        let all = self.properties.iter().all(is_scalar);
        all.then(|| self.least_size(Encoding::LittleEndian))
    }
}

#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

/// Reads a header, with the line that ends it.
pub(super) fn read(source: &mut Source) -> Result<Header, LoadError> {
    let (mut encoding, mut elements, mut line) = (None, Vec::new(), Vec::new());
    loop {
        if !source.next_line(&mut line)? {
            return Err(source.truncated("it ends within its header".into()));
        }
        if source.at > LONGEST {
            let what = format!("its header is longer than {LONGEST} bytes");
            return Err(source.bad_line(what, REMEDY));
        }
        if source.line == 1 {
            if line.trim_ascii() != b"ply" {
                let what = format!("it begins with '{}' instead of 'ply'", word_text(&line));
                return Err(source.bad_line(what, "check that the file is a PLY"));
            }
            continue;
        }
        if line.trim_ascii() == b"end_header" {
            break;
        }
        let added = statement(&line, &mut encoding, &mut elements);
        added.map_err(|what| source.bad_line(what, REMEDY))?;
    }
    match encoding {
        Some(encoding) => Ok(Header { encoding, elements }),
        None => Err(source.bad_line("its header has no line 'format'".into(), REMEDY)),
    }
}

/// Elements of a header at most; scans and meshes have a handful.
const MOST_ELEMENTS: usize = 256;

fn statement(
    line: &[u8],
    encoding: &mut Option<Encoding>,
    elements: &mut Vec<Element>,
) -> Result<(), String> {
    let text = String::from_utf8_lossy(line);
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    match words[..] {
        [] | ["comment" | "obj_info", ..] => {}
        ["format", name, "1.0"] => *encoding = Some(encoding_of(name)?),
        ["format", ..] => return Err("it is not of version 1.0".into()),
        ["element", name, count] => {
            let count = count.parse();
            let count = count.map_err(|_| format!("element '{}' has no count", short(name)))?;
            if elements.len() == MOST_ELEMENTS {
                return Err(format!("it has more than {MOST_ELEMENTS} elements"));
            }
            if elements.iter().any(|e| e.name == name) {
                return Err(format!("it has two elements '{}'", short(name)));
            }
            elements.push(Element { name: name.into(), count, properties: Vec::new() });
        }
        ["property", ref rest @ ..] => {
            let element = elements.last_mut().ok_or("a property stands before all elements")?;
            element.properties.push(property(rest)?);
        }
        _ => return Err(format!("'{}' is no line of a header", word_text(line))),
    }
    Ok(())
}

fn encoding_of(name: &str) -> Result<Encoding, String> {
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(format!("'{}' is no format", short(name))),
    }
}

fn property(words: &[&str]) -> Result<Property, String> {
    let scalar =
        |name: &str| Scalar::named(name).ok_or_else(|| format!("'{}' is no type", short(name)));
    match words {
        ["list", count, item, name] => {
            let (count, item) = (scalar(count)?, scalar(item)?);
            if !count.is_integer() {
                return Err(format!("the count of the list '{}' is no integer", short(name)));
            }
            Ok(Property { name: (*name).into(), kind: Kind::List(count, item) })
        }
        [kind, name] => Ok(Property { name: (*name).into(), kind: Kind::Scalar(scalar(kind)?) }),
        _ => Err("a property has a type and a name, or is a list".into()),
    }
}

fn short(name: &str) -> String {
    word_text(name.as_bytes())
}
