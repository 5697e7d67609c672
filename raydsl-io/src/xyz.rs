//! Text with a point in every line.

use crate::LoadError;
use crate::cloud::{PointCloud, check_count};
use crate::error::word_text;
use crate::source::Source;
use crate::tint::{self, Gathered};

/// Lines between two reports of progress.
const REPORT: u64 = 1 << 16;
const REMEDY: &str = "correct or remove the line";

pub(crate) fn read(
    mut source: Source,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<PointCloud, LoadError> {
    let mut table =
        Table { positions: Vec::new(), rgb: Gathered::new(Vec::new(), false), columns: 0 };
    let mut line = Vec::new();
    progress(0, source.len);
    while source.next_line(&mut line)? {
        let text = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&line);
        table.add(text).map_err(|(what, remedy)| source.bad_line(what, remedy))?;
        check_count(&source.path, table.positions.len() as u64)?;
        if source.line.is_multiple_of(REPORT) {
            progress(source.at, source.len);
        }
    }
    progress(source.len, source.len);
    let Table { positions, rgb, columns } = table;
    let colors = if columns == 6 { rgb.finish() } else { tint::from_height(&positions) };
    Ok(PointCloud { positions, colors })
}

/// What is wrong with a line, and what to do.
type Wrong = (String, &'static str);

/// The points read so far.
struct Table {
    positions: Vec<[f64; 3]>,
    rgb: Gathered,
    /// Columns of the first point, to which the others are held; 0 before it.
    columns: usize,
}

impl Table {
    fn add(&mut self, line: &[u8]) -> Result<(), Wrong> {
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

    fn push(&mut self, [x, y, z, r, g, b]: [f64; 6], count: usize) -> Result<(), Wrong> {
        if self.columns == 0 {
            if count != 3 && count != 6 {
                let what = format!("it has {count} columns");
                return Err((what, "write `x y z` or `x y z r g b`"));
            }
            self.columns = count;
        }
        if count != self.columns {
            let wanted = self.columns;
            let what = format!("it has {count} columns where the first point has {wanted}");
            return Err((what, "complete or remove the line"));
        }
        self.positions.push([x, y, z]);
        if count == 3 {
            return Ok(());
        }
        let remedy = "scale the colours to 0 to 255, or all to 0 to 1";
        let bad = |c| (format!("the colour value {c} lies outside 0 to 255"), remedy);
        self.rgb.push([r, g, b]).map_err(bad)
    }
}

fn no_number(word: &[u8]) -> Wrong {
    (format!("'{}' is no number", word_text(word)), REMEDY)
}
