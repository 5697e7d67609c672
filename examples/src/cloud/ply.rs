//! PLY, text and binary.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read};
use std::path::Path;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType,
    ScalarType,
};

use super::error::one_line;
use super::load::{Source, reserve};
use super::tint::{self, Gathered};
use super::xyz::next_line;
use super::{CloudError, PointCloud};

/// Points between two reports of progress.
const REPORT: u64 = 1 << 16;
/// Headers are far shorter; the limit keeps a file without line ends from being read whole.
const HEADER: u64 = 1 << 20;

pub(super) fn read(
    mut source: Source,
    path: &Path,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<PointCloud, CloudError> {
    let mut head = Reader::new((&mut source.file).take(HEADER));
    let header = Parser::<Vertex>::new().read_header(&mut head);
    let header = header.map_err(|e| parse_error(path, &e))?;
    let number = head.line() as u64;
    let vertex = header.elements.get("vertex");
    let vertex = vertex.ok_or_else(|| corrupt(path, "it has no element 'vertex'".into()))?;
    let color = check_properties(vertex).map_err(|what| corrupt(path, what))?;
    // A point takes three bytes at the very least.
    let mut cloud = reserve(path, vertex.count as u64, source.len / 3)?;
    let mut body = Body { file: source.file, path, line: Vec::new(), number };
    body.skip_to_vertices(&header)?;
    let bytes = color == Some(ScalarType::UChar);
    let mut rgb = Gathered::new(std::mem::take(&mut cloud.colors), bytes);
    let mut wide = Vec::new();
    let total = vertex.count as u64;
    progress(0, total);
    for i in 0..total {
        let v = body.vertex(vertex, header.encoding, i)?;
        cloud.positions.push(v.position);
        match color {
            Some(ScalarType::UShort) => wide.push(v.color.map(|c| c as u16)),
            Some(_) => rgb.push(v.color).map_err(|c| corrupt(path, bad_color(i, c)))?,
            None => {}
        }
        if (i + 1) % REPORT == 0 || i + 1 == total {
            progress(i + 1, total);
        }
    }
    cloud.colors = match color {
        Some(ScalarType::UShort) => tint::from_rgb16(&wide),
        Some(_) => rgb.finish(),
        None => tint::from_height(&cloud.positions),
    };
    Ok(cloud)
}

fn bad_color(point: u64, value: f64) -> String {
    format!("point {point} has the colour value {value}, outside 0 to 255")
}

/// The coordinates and colour of a vertex; its other properties are passed over.
struct Vertex {
    position: [f64; 3],
    color: [f64; 3],
}

impl Vertex {
    fn set(&mut self, name: &str, value: f64) {
        match name {
            "x" => self.position[0] = value,
            "y" => self.position[1] = value,
            "z" => self.position[2] = value,
            "red" | "r" | "diffuse_red" => self.color[0] = value,
            "green" | "g" | "diffuse_green" => self.color[1] = value,
            "blue" | "b" | "diffuse_blue" => self.color[2] = value,
            _ => {}
        }
    }
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self { position: [0.0; 3], color: [0.0; 3] }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let value = match property {
            Property::Char(v) => v.into(),
            Property::UChar(v) => v.into(),
            Property::Short(v) => v.into(),
            Property::UShort(v) => v.into(),
            Property::Int(v) => v.into(),
            Property::UInt(v) => v.into(),
            Property::Float(v) => v.into(),
            Property::Double(v) => v,
            _ => return PropertyAccessResult::Ignored,
        };
        self.set(name, value);
        PropertyAccessResult::Set
    }
}

fn scalar<'a>(vertex: &'a ElementDef, names: &[&str]) -> Option<&'a ScalarType> {
    names.iter().find_map(|name| match &vertex.properties.get(*name)?.data_type {
        PropertyType::Scalar(kind) => Some(kind),
        PropertyType::List(..) => None,
    })
}

/// Requires coordinates and gives the type of the colours, if there are any.
fn check_properties(vertex: &ElementDef) -> Result<Option<ScalarType>, String> {
    for name in ["x", "y", "z"] {
        if scalar(vertex, &[name]).is_none() {
            return Err(format!("its vertices have no number '{name}'"));
        }
    }
    let red = scalar(vertex, &["red", "r", "diffuse_red"]);
    let green = scalar(vertex, &["green", "g", "diffuse_green"]);
    let blue = scalar(vertex, &["blue", "b", "diffuse_blue"]);
    match (red, green, blue) {
        (Some(r), Some(g), Some(b)) if r == g && g == b => Ok(Some(r.clone())),
        (Some(_), Some(_), Some(_)) => Err("its colour channels differ in type".into()),
        _ => Ok(None),
    }
}

/// What follows the header.
struct Body<'a> {
    file: BufReader<File>,
    path: &'a Path,
    line: Vec<u8>,
    number: u64,
}

impl Body<'_> {
    /// Reads past the elements that the header lists before the vertices.
    fn skip_to_vertices(&mut self, header: &Header) -> Result<(), CloudError> {
        let before = header.elements.iter().take_while(|(name, _)| *name != "vertex");
        for (name, element) in before {
            // An element without properties takes no bytes, however many the header claims.
            let empty = element.properties.is_empty() && header.encoding != Encoding::Ascii;
            let count = if empty { 0 } else { element.count };
            for i in 0..count {
                let what = || format!("{i} of {count} elements '{name}' are there");
                match header.encoding {
                    Encoding::Ascii => self.text_line(what).map(drop)?,
                    binary => self.binary(element, binary, what).map(drop)?,
                }
            }
        }
        Ok(())
    }

    fn vertex(
        &mut self,
        def: &ElementDef,
        encoding: Encoding,
        i: u64,
    ) -> Result<Vertex, CloudError> {
        let what = || format!("{i} of {} points are there", def.count);
        match encoding {
            Encoding::Ascii => {
                self.text_line(what)?;
                let line = String::from_utf8_lossy(&self.line);
                parse_vertex(&line, def).map_err(|what| CloudError::Line {
                    path: self.path.into(),
                    line: self.number,
                    what: format!("{what}; correct the line, or write the file again"),
                })
            }
            binary => self.binary(def, binary, what),
        }
    }

    fn binary(
        &mut self,
        def: &ElementDef,
        encoding: Encoding,
        what: impl Fn() -> String,
    ) -> Result<Vertex, CloudError> {
        let parser = Parser::<Vertex>::new();
        let result = match encoding {
            Encoding::BinaryBigEndian => parser.read_big_endian_element(&mut self.file, def),
            _ => parser.read_little_endian_element(&mut self.file, def),
        };
        result.map_err(|e| match e.kind() {
            ErrorKind::UnexpectedEof => truncated(self.path, what()),
            _ => parse_error(self.path, &e),
        })
    }

    /// The next line that is not blank.
    fn text_line(&mut self, what: impl Fn() -> String) -> Result<(), CloudError> {
        loop {
            self.number += 1;
            if !next_line(&mut self.file, &mut self.line, self.path, self.number)? {
                return Err(truncated(self.path, what()));
            }
            if !self.line.trim_ascii().is_empty() {
                return Ok(());
            }
        }
    }
}

/// The parser of the crate takes neither `nan`, which deserves a better message, nor `.5`.
fn parse_vertex(line: &str, def: &ElementDef) -> Result<Vertex, String> {
    let mut words = line.split_ascii_whitespace();
    let mut number = |name: &str| {
        let word = words.next().ok_or_else(|| format!("no value for '{name}'"))?;
        word.parse::<f64>().map_err(|_| format!("'{}' is no number", one_line(word)))
    };
    let mut vertex = Vertex::new();
    for (name, property) in &def.properties {
        let value = number(name)?;
        match property.data_type {
            PropertyType::Scalar(_) => vertex.set(name, value),
            PropertyType::List(..) => {
                for _ in 0..value as u64 {
                    number(name)?;
                }
            }
        }
    }
    Ok(vertex)
}

fn corrupt(path: &Path, what: String) -> CloudError {
    CloudError::Corrupt { path: path.into(), format: "PLY", what, tool: "MeshLab" }
}

fn truncated(path: &Path, what: String) -> CloudError {
    CloudError::Truncated { path: path.into(), what }
}

fn parse_error(path: &Path, error: &ParseError) -> CloudError {
    match error.kind() {
        ErrorKind::UnexpectedEof => truncated(path, "it ends within its header".into()),
        _ => corrupt(path, one_line(error)),
    }
}
