//! What the XML says, all but the numbers of arrays.

use std::io::BufRead;

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use super::{Content, Of, REMEDY, VtkArray};
use crate::error::{one_line, word_text};
use crate::source::Source;
use crate::volume::ByteOrder;
use crate::{LoadError, Place};

/// Arrays of a file at most; simulations write a handful.
const MOST_ARRAYS: usize = 4096;

/// The file, all but its numbers.
pub(crate) struct Document {
    pub(crate) order: ByteOrder,
    /// Bytes of a length.
    pub(crate) width: usize,
    pub(crate) is_packed: bool,
    /// The first and the last point along each axis.
    pub(crate) extent: [i32; 6],
    pub(crate) origin: [f64; 3],
    pub(crate) spacing: [f64; 3],
    /// A matrix, row by row.
    pub(crate) direction: [f64; 9],
    /// Points and cells of the piece, for an unstructured grid.
    pub(crate) counts: [u64; 2],
    /// The byte behind the tag of the grid.
    pub(crate) at: u64,
    pub(crate) arrays: Vec<VtkArray>,
    /// The active scalars of points and of cells.
    pub(crate) active: [Option<String>; 2],
    /// Where appended data begin, and whether they are base64.
    pub(crate) appended: Option<(u64, bool)>,
}

impl Document {
    /// How many points or cells there are along each axis.
    pub(crate) fn size(&self, is_cells: bool) -> [u64; 3] {
        let [x0, x1, y0, y1, z0, z1] = self.extent;
        [(x0, x1), (y0, y1), (z0, z1)].map(|(first, last)| {
            let steps = u64::try_from(i64::from(last) - i64::from(first)).ok();
            // A flat axis has one layer of cells.
            steps.map_or(0, |n| if is_cells { n.max(1) } else { n + 1 })
        })
    }
}

/// Reads a file that holds a grid of this kind, `ImageData` or `UnstructuredGrid`, up to its
/// appended data.
pub(crate) fn read(source: &mut Source, kind: &'static str) -> Result<Document, LoadError> {
    let mut scan = Scan {
        kind,
        has_file: false,
        has_grid: false,
        pieces: 0,
        of: None,
        document: Document {
            order: ByteOrder::Little,
            width: 4,
            is_packed: false,
            extent: [0; 6],
            origin: [0.0; 3],
            spacing: [1.0; 3],
            direction: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            counts: [0; 2],
            at: 0,
            arrays: Vec::new(),
            active: [None, None],
            appended: None,
        },
    };
    let mut xml = Reader::from_reader(&mut *source);
    let (mut buffer, mut depth) = (Vec::new(), 0u64);
    let result = loop {
        buffer.clear();
        let event = match xml.read_event_into(&mut buffer) {
            Ok(event) => event,
            Err(quick_xml::Error::Io(e)) => {
                break Err(Wrong::Io(std::io::Error::new(e.kind(), one_line(&e))));
            }
            // A tag, a comment or the like has no end.
            Err(quick_xml::Error::Syntax(_)) if xml.get_ref().remaining() == 0 => {
                break Err(Wrong::End);
            }
            Err(e) => break Err(Wrong::Text(one_line(e))),
        };
        let (tag, is_empty) = match &event {
            Event::Start(tag) => (tag, false),
            Event::Empty(tag) => (tag, true),
            Event::End(tag) => {
                depth = depth.saturating_sub(1);
                if Of::named(tag.name().as_ref()).is_some() {
                    scan.of = None;
                }
                continue;
            }
            Event::Eof => break if depth > 0 { Err(Wrong::End) } else { Ok(()) },
            _ => continue,
        };
        depth += u64::from(!is_empty);
        let at = xml.get_ref().at;
        match scan.open(tag, is_empty, at) {
            Err(what) => break Err(Wrong::Text(what)),
            // Text may be long: it is not kept.
            Ok(Next::PassOver) => {
                if let Err(e) = pass_over(&mut xml.stream()) {
                    break Err(Wrong::Io(e));
                }
            }
            Ok(Next::Appended(is_base64)) => match appended(&mut xml.stream()) {
                Err(e) => break Err(Wrong::Io(e)),
                Ok(false) => break Err(Wrong::Text("its appended data begin without `_`".into())),
                Ok(true) => {
                    scan.document.appended = Some((xml.get_ref().at, is_base64));
                    break Ok(());
                }
            },
            Ok(Next::Nothing) => {}
        }
    };
    match result {
        Ok(()) => {}
        Err(Wrong::End) => return Err(source.truncated("it ends within an element".into())),
        Err(Wrong::Text(what)) => return Err(source.corrupt(Place::Byte(source.at), what, REMEDY)),
        Err(Wrong::Io(e)) => return Err(source.fault(e.into(), REMEDY)),
    }
    if source.len == 0 {
        return Err(source.truncated("it is empty".into()));
    }
    if !scan.has_grid {
        let what = format!("it has no element '{kind}' in a 'VTKFile'");
        return Err(source.corrupt(Place::Somewhere, what, REMEDY));
    }
    Ok(scan.document)
}

/// Why reading stops.
enum Wrong {
    End,
    Text(String),
    Io(std::io::Error),
}

/// What follows a tag.
enum Next {
    Nothing,
    PassOver,
    Appended(bool),
}

struct Scan {
    /// The kind of grid that is looked for.
    kind: &'static str,
    has_file: bool,
    has_grid: bool,
    pieces: u64,
    /// What arrays are of, within an element of arrays.
    of: Option<Of>,
    document: Document,
}

impl Scan {
    fn open(&mut self, tag: &BytesStart<'_>, is_empty: bool, at: u64) -> Result<Next, String> {
        match tag.name().as_ref() {
            "VTKFile" => self.file(tag)?,
            "ImageData" if self.has_file => self.image(tag, at)?,
            "UnstructuredGrid" if self.has_file => {
                self.document.at = at;
                self.has_grid = true;
            }
            "Piece" => {
                self.pieces += 1;
                if self.pieces > 1 {
                    return Err("it has several pieces, and one is read".into());
                }
                if let Some(extent) = list(tag, "Extent")? {
                    self.document.extent = extent;
                }
                for (i, name) in ["NumberOfPoints", "NumberOfCells"].into_iter().enumerate() {
                    let count = list::<u64, 1>(tag, name)?;
                    self.document.counts[i] = count.map_or(0, |[n]| n);
                }
            }
            "DataArray" => {
                if let Some(of) = self.of {
                    let array = array(tag, of, at)?;
                    if self.document.arrays.len() == MOST_ARRAYS {
                        return Err(format!("it has more than {MOST_ARRAYS} arrays"));
                    }
                    self.document.arrays.push(array);
                }
                return Ok(if is_empty { Next::Nothing } else { Next::PassOver });
            }
            "AppendedData" if !is_empty => {
                return match attribute(tag, "encoding")?.as_deref() {
                    Some("raw") => Ok(Next::Appended(false)),
                    Some("base64") | None => Ok(Next::Appended(true)),
                    Some(other) => Err(format!("'{}' is no encoding", short(other))),
                };
            }
            name => {
                if let Some(of) = Of::named(name) {
                    self.of = (!is_empty).then_some(of);
                    if let Of::PointData | Of::CellData = of {
                        let is_cells = usize::from(of == Of::CellData);
                        self.document.active[is_cells] = attribute(tag, "Scalars")?;
                    }
                }
            }
        }
        Ok(Next::Nothing)
    }

    fn file(&mut self, tag: &BytesStart<'_>) -> Result<(), String> {
        let kind = attribute(tag, "type")?.unwrap_or_default();
        if kind != self.kind {
            return Err(format!("it holds '{}' instead of '{}'", short(&kind), self.kind));
        }
        self.has_file = true;
        self.document.order = match attribute(tag, "byte_order")?.as_deref() {
            None | Some("LittleEndian") => ByteOrder::Little,
            Some("BigEndian") => ByteOrder::Big,
            Some(other) => return Err(format!("'{}' is no byte order", short(other))),
        };
        self.document.width = match attribute(tag, "header_type")?.as_deref() {
            None | Some("UInt32") => 4,
            Some("UInt64") => 8,
            Some(other) => return Err(format!("'{}' is no type of lengths", short(other))),
        };
        self.document.is_packed = match attribute(tag, "compressor")?.as_deref() {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                let read = "`vtkZLibDataCompressor`";
                return Err(format!("it is compressed by '{}', and {read} is read", short(other)));
            }
        };
        Ok(())
    }

    fn image(&mut self, tag: &BytesStart<'_>, at: u64) -> Result<(), String> {
        let document = &mut self.document;
        let extent = list(tag, "WholeExtent")?;
        document.extent = extent.ok_or("its element 'ImageData' has no 'WholeExtent'")?;
        document.origin = list(tag, "Origin")?.unwrap_or(document.origin);
        document.spacing = list(tag, "Spacing")?.unwrap_or(document.spacing);
        document.direction = list(tag, "Direction")?.unwrap_or(document.direction);
        document.at = at;
        self.has_grid = true;
        Ok(())
    }
}

fn array(tag: &BytesStart<'_>, of: Of, at: u64) -> Result<VtkArray, String> {
    let name = attribute(tag, "Name")?.unwrap_or_default();
    let number = |attribute: &str, text: String| {
        text.trim().parse().map_err(|_| {
            let (text, name) = (short(&text), short(&name));
            format!("'{text}', '{attribute}' of the array '{name}', is no number that it can be")
        })
    };
    let components = match attribute(tag, "NumberOfComponents")? {
        None => 1,
        Some(text) => number("NumberOfComponents", text)?,
    };
    let content = match attribute(tag, "format")?.as_deref() {
        Some("appended") => {
            let offset = attribute(tag, "offset")?.unwrap_or_default();
            Content::Appended(number("offset", offset)?)
        }
        Some("binary") => Content::Inline,
        None | Some("ascii") => Content::Text,
        Some(other) => return Err(format!("'{}' is no format of an array", short(other))),
    };
    let kind = attribute(tag, "type")?.unwrap_or_default();
    Ok(VtkArray { name, kind, components, content, of, at })
}

/// The value of an attribute.
fn attribute(tag: &BytesStart<'_>, name: &str) -> Result<Option<String>, String> {
    let mut attributes = tag.attributes();
    // Comparing all names with each other takes long where there are many.
    attributes.with_checks(false);
    for attribute in attributes {
        let attribute = attribute.map_err(one_line)?;
        if attribute.key.as_ref() == name {
            let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(one_line)?;
            return Ok(Some(value.into_owned()));
        }
    }
    Ok(None)
}

/// The numbers of an attribute.
fn list<T: std::str::FromStr, const N: usize>(
    tag: &BytesStart<'_>,
    name: &str,
) -> Result<Option<[T; N]>, String> {
    let Some(text) = attribute(tag, name)? else { return Ok(None) };
    let numbers = text.split_ascii_whitespace().map(|word| word.parse().ok()).take(N + 1);
    let numbers = numbers.collect::<Option<Vec<T>>>().and_then(|n| <[T; N]>::try_from(n).ok());
    let text = short(&text);
    numbers.map(Some).ok_or_else(|| format!("'{name}' has '{text}' instead of {N} numbers"))
}

fn short(text: &str) -> String {
    word_text(text.as_bytes())
}

/// Passes over a text, up to the next tag.
fn pass_over(stream: &mut dyn BufRead) -> std::io::Result<()> {
    loop {
        let bytes = stream.fill_buf()?;
        let (count, tag) = (bytes.len(), bytes.iter().position(|b| *b == b'<'));
        stream.consume(tag.unwrap_or(count));
        if tag.is_some() || count == 0 {
            return Ok(());
        }
    }
}

/// Passes over what comes before appended data; false where that is something else than space.
fn appended(stream: &mut dyn BufRead) -> std::io::Result<bool> {
    loop {
        let next = stream.fill_buf()?.first().copied();
        let Some(next) = next else { return Err(std::io::ErrorKind::UnexpectedEof.into()) };
        if next == b'<' {
            return Ok(false);
        }
        stream.consume(1);
        match next {
            b'_' => return Ok(true),
            _ if next.is_ascii_whitespace() => {}
            _ => return Ok(false),
        }
    }
}
