//! The elements that follow a header, row by row.

use super::REMEDY;
use super::header::{Element, Encoding, Header, Kind, Scalar};
use crate::error::word_text;
use crate::source::Source;
use crate::{LoadError, Place};

const LINE_REMEDY: &str = "correct the line, or write the file again";

/// The values of one row.
#[derive(Default)]
pub(super) struct Row {
    /// A number for each property; that of a list is the count of its items.
    pub(super) numbers: Vec<f64>,
    /// The items of the list that was asked for.
    pub(super) list: Vec<f64>,
}

/// What follows a header.
pub(super) struct Body {
    pub(super) source: Source,
    encoding: Encoding,
    line: Vec<u8>,
}

impl Body {
    pub(super) fn new(source: Source, header: &Header) -> Self {
        Self { source, encoding: header.encoding, line: Vec::new() }
    }

    /// An error at the row that was read last, which begins at byte `start` of a binary file.
    pub(super) fn bad_row(&self, start: u64, what: String) -> LoadError {
        match self.encoding {
            Encoding::Ascii => self.source.bad_line(what, LINE_REMEDY),
            _ => self.source.corrupt(Place::Byte(start), what, REMEDY),
        }
    }

    /// Reads past all rows of an element.
    pub(super) fn skip(&mut self, element: &Element) -> Result<(), LoadError> {
        // A row without properties takes no bytes, however many the header claims.
        if element.properties.is_empty() {
            return Ok(());
        }
        if let (Some(size), true) = (element.size(), self.encoding != Encoding::Ascii) {
            let held = self.source.remaining() / size;
            if held < element.count || !self.source.skip(element.count * size)? {
                return Err(self.cut(element, held));
            }
            return Ok(());
        }
        let mut row = Row::default();
        for i in 0..element.count {
            self.read(element, i, None, &mut row)?;
        }
        Ok(())
    }

    /// Reads row `i` of an element, with the items of the list at the place `wanted`.
    pub(super) fn read(
        &mut self,
        element: &Element,
        i: u64,
        wanted: Option<usize>,
        row: &mut Row,
    ) -> Result<(), LoadError> {
        row.numbers.clear();
        row.list.clear();
        match self.encoding {
            Encoding::Ascii => self.read_text(element, i, wanted, row),
            _ => self.read_binary(element, i, wanted, row),
        }
    }

    fn read_text(
        &mut self,
        element: &Element,
        i: u64,
        wanted: Option<usize>,
        row: &mut Row,
    ) -> Result<(), LoadError> {
        loop {
            if !self.source.next_line(&mut self.line)? {
                return Err(self.cut(element, i));
            }
            if !self.line.trim_ascii().is_empty() {
                break;
            }
        }
        let read = text_row(&self.line, element, wanted, row);
        read.map_err(|what| self.source.bad_line(what, LINE_REMEDY))
    }

    fn read_binary(
        &mut self,
        element: &Element,
        i: u64,
        wanted: Option<usize>,
        row: &mut Row,
    ) -> Result<(), LoadError> {
        let start = self.source.at;
        for (place, property) in element.properties.iter().enumerate() {
            let (Kind::Scalar(kind) | Kind::List(kind, _)) = property.kind;
            let number = self.number(kind)?;
            let number = number.ok_or_else(|| self.cut(element, i))?;
            row.numbers.push(number);
            let Kind::List(_, item) = property.kind else { continue };
            if number < 0.0 {
                let name = word_text(property.name.as_bytes());
                let what = format!("the list '{name}' has {number} items");
                return Err(self.bad_row(start, what));
            }
            let (count, size) = (number as u64, item.size() as u64);
            if self.source.remaining() / size < count {
                return Err(self.cut(element, i));
            }
            if wanted != Some(place) {
                self.source.skip(count * size)?;
                continue;
            }
            for _ in 0..count {
                let number = self.number(item)?;
                row.list.push(number.ok_or_else(|| self.cut(element, i))?);
            }
        }
        Ok(())
    }

    /// A binary number; none at the end of the file.
    fn number(&mut self, kind: Scalar) -> Result<Option<f64>, LoadError> {
        let mut bytes = [0; 8];
        let used = &mut bytes[..kind.size()];
        if !self.source.fill(used)? {
            return Ok(None);
        }
        if self.encoding == Encoding::BigEndian {
            used.reverse();
        }
        Ok(Some(kind.decode(bytes)))
    }

    fn cut(&self, element: &Element, held: u64) -> LoadError {
        let Element { name, count, .. } = element;
        let name = word_text(name.as_bytes());
        self.source.truncated(format!("{held} of {count} elements '{name}' are there"))
    }
}

fn text_row(
    line: &[u8],
    element: &Element,
    wanted: Option<usize>,
    row: &mut Row,
) -> Result<(), String> {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let mut number = |name: &str| {
        let word = words.next();
        let word = word.ok_or_else(|| format!("no value for '{}'", word_text(name.as_bytes())))?;
        let value = str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok());
        value.ok_or_else(|| format!("'{}' is no number", word_text(word)))
    };
    for (place, property) in element.properties.iter().enumerate() {
        let value = number(&property.name)?;
        row.numbers.push(value);
        if let Kind::List(..) = property.kind {
            if value < 0.0 || value.fract() != 0.0 {
                let name = word_text(property.name.as_bytes());
                return Err(format!("the list '{name}' has {value} items"));
            }
            // The line ends before a count that is too large.
            for _ in 0..value as u64 {
                let item = number(&property.name)?;
                if wanted == Some(place) {
                    row.list.push(item);
                }
            }
        }
    }
    Ok(())
}
