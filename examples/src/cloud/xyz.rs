//! Text with a point in every line.

use std::io::{BufRead, Read};
use std::path::Path;

use super::error::one_line;
use super::load::Source;
use super::tint::{self, Gathered};
use super::{CloudError, PointCloud};

/// Longer lines are a sign that the file is no text.
const LONGEST: u64 = 1 << 16;
/// Lines between two reports of progress.
const REPORT: u64 = 1 << 16;

pub(super) fn read(
    mut source: Source,
    path: &Path,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<PointCloud, CloudError> {
    let mut table =
        Table { positions: Vec::new(), rgb: Gathered::new(Vec::new(), false), columns: 0 };
    let (mut line, mut number, mut done) = (Vec::new(), 0, 0);
    progress(0, source.len);
    while next_line(&mut source.file, &mut line, path, number + 1)? {
        number += 1;
        done += line.len() as u64;
        let text = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&line);
        table.add(text).map_err(|what| CloudError::Line {
            path: path.into(),
            line: number,
            what,
        })?;
        if table.positions.len() > u32::MAX as usize {
            let points = table.positions.len() as u64;
            return Err(CloudError::TooManyPoints { path: path.into(), points });
        }
        if number % REPORT == 0 {
            progress(done, source.len);
        }
    }
    progress(source.len, source.len);
    let Table { positions, rgb, columns } = table;
    let colors = if columns == 6 { rgb.finish() } else { tint::from_height(&positions) };
    Ok(PointCloud { positions, colors })
}

/// Reads a line into `line`, with its end; false at the end of the file.
pub(super) fn next_line(
    file: &mut impl BufRead,
    line: &mut Vec<u8>,
    path: &Path,
    number: u64,
) -> Result<bool, CloudError> {
    line.clear();
    let read = file.take(LONGEST).read_until(b'\n', line);
    let n = read.map_err(|source| CloudError::Unreadable { path: path.into(), source })? as u64;
    if n == LONGEST && line.last() != Some(&b'\n') {
        let what = format!("is longer than {LONGEST} bytes; check that the file is text");
        return Err(CloudError::Line { path: path.into(), line: number, what });
    }
    Ok(n > 0)
}

/// The points read so far.
struct Table {
    positions: Vec<[f64; 3]>,
    rgb: Gathered,
    /// Columns of the first point, to which the others are held; 0 before it.
    columns: usize,
}

impl Table {
    fn add(&mut self, line: &[u8]) -> Result<(), String> {
        let line = line.trim_ascii();
        if line.is_empty() || line.starts_with(b"#") || line.starts_with(b"//") {
            return Ok(());
        }
        let mut row = [0.0; 6];
        let mut count = 0;
        let separator = |b: &u8| matches!(b, b' ' | b'\t' | b',' | b';');
        for word in line.split(separator).filter(|w| !w.is_empty()) {
            let value = str::from_utf8(word).ok().and_then(|w| w.parse::<f64>().ok());
            let Some(value) = value else {
                // Before the first point, words are a header.
                return if self.columns == 0 && count == 0 { Ok(()) } else { Err(no_number(word)) };
            };
            if let Some(cell) = row.get_mut(count) {
                *cell = value;
            }
            count += 1;
        }
        if self.columns == 0 && count == 1 {
            // A lone number ahead of the points is their count.
            return Ok(());
        }
        self.push(row, count)
    }

    fn push(&mut self, [x, y, z, r, g, b]: [f64; 6], count: usize) -> Result<(), String> {
        if self.columns == 0 {
            if count != 3 && count != 6 {
                return Err(format!("has {count} columns; write `x y z` or `x y z r g b`"));
            }
            self.columns = count;
        }
        if count != self.columns {
            let wanted = self.columns;
            return Err(format!(
                "has {count} columns where the first point has {wanted}; complete or remove the line"
            ));
        }
        self.positions.push([x, y, z]);
        if count == 3 {
            return Ok(());
        }
        let bad = |c| {
            format!(
                "the colour value {c} lies outside 0 to 255; scale the colours to 0 to 255, or all to 0 to 1"
            )
        };
        self.rgb.push([r, g, b]).map_err(bad)
    }
}

fn no_number(word: &[u8]) -> String {
    let word = one_line(String::from_utf8_lossy(word));
    format!("'{word}' is no number; correct or remove the line")
}
