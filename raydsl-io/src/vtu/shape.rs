//! The cells of a VTU: kinds, and which points they have.

use super::numbers::Reader;
use crate::cells::CellKind;
use crate::vtk::{Of, REMEDY, VtkArray};
use crate::{LoadError, Place};

/// Cells that have a volume, and which of all they are.
#[derive(Default)]
pub(super) struct Shape {
    pub(super) kinds: Vec<CellKind>,
    pub(super) vertices: Vec<u32>,
    pub(super) skipped: usize,
    /// Whether each cell of the file is kept.
    is_kept: Vec<bool>,
}

/// The kind of a type of VTK, and the order of its vertices.
fn kind_of(code: f64) -> Option<(CellKind, &'static [usize])> {
    const ORDER: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
    // A voxel's vertices run along x, then y, then z.
    const VOXEL: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];
    if code.fract() != 0.0 {
        return None;
    }
    Some(match code as u8 {
        10 => (CellKind::Tetrahedron, &ORDER[..4]),
        11 => (CellKind::Hexahedron, &VOXEL),
        12 => (CellKind::Hexahedron, &ORDER),
        13 => (CellKind::Wedge, &ORDER[..6]),
        14 => (CellKind::Pyramid, &ORDER[..5]),
        _ => return None,
    })
}

impl Shape {
    pub(super) fn read(
        reader: &mut Reader<'_>,
        arrays: &[VtkArray],
        points: u64,
        cells: u64,
    ) -> Result<Self, LoadError> {
        let (offsets_at, offsets) = numbers(reader, arrays, "offsets", cells)?;
        let (_, types) = numbers(reader, arrays, "types", cells)?;
        let count = offsets.last().copied().unwrap_or(0.0);
        if !(0.0..=u32::MAX as f64).contains(&count) {
            let what = format!("its cells have {count} vertices, at most {} are read", u32::MAX);
            return Err(reader.source.corrupt(Place::Byte(offsets_at), what, REMEDY));
        }
        let (at, connectivity) = numbers(reader, arrays, "connectivity", count as u64)?;
        let mut shape = Self::default();
        let mut first = 0;
        for (cell, (end, code)) in offsets.iter().zip(types).enumerate() {
            let whole = (end.fract() == 0.0).then_some(*end as i64);
            let place = whole.and_then(|end| usize::try_from(end).ok());
            let Some(own) = place.and_then(|end| connectivity.get(first..end)) else {
                let what = format!(
                    "the offset of cell {cell}, {end}, is no whole number from the one before, \
                     {first}, to the number of vertices, {}",
                    connectivity.len()
                );
                return Err(reader.source.corrupt(Place::Byte(offsets_at), what, REMEDY));
            };
            first += own.len();
            if let Err(what) = shape.push(own, code, points) {
                let what = format!("cell {cell} {what}");
                return Err(reader.source.corrupt(Place::Byte(at), what, REMEDY));
            }
        }
        Ok(shape)
    }

    /// Adds a cell, if it has a volume.
    fn push(&mut self, own: &[f64], code: f64, points: u64) -> Result<(), String> {
        let kind = kind_of(code);
        self.is_kept.push(kind.is_some());
        let Some((kind, order)) = kind else {
            self.skipped += 1;
            return Ok(());
        };
        if own.len() != order.len() {
            let expected = order.len();
            return Err(format!("of type {code} has {} vertices, not {expected}", own.len()));
        }
        for i in order {
            let index = own[*i];
            if !(index >= 0.0 && index < points as f64 && index.fract() == 0.0) {
                return Err(format!("has point {index}, and there are {points}"));
            }
            self.vertices.push(index as u32);
        }
        self.kinds.push(kind);
        Ok(())
    }

    /// Keeps the numbers of the cells that are kept.
    pub(super) fn kept(&self, values: &[f32], components: usize) -> Vec<f32> {
        let of_cells = values.chunks_exact(components).zip(&self.is_kept);
        of_cells.filter(|(_, is_kept)| **is_kept).flat_map(|(own, _)| own).copied().collect()
    }
}

/// Reads an array of the cells by its name; whole numbers up to 2^53 are exact.
fn numbers(
    reader: &mut Reader<'_>,
    arrays: &[VtkArray],
    name: &str,
    count: u64,
) -> Result<(u64, Vec<f64>), LoadError> {
    let found = arrays.iter().find(|a| a.of == Of::Cells && a.name == name);
    let Some(array) = found.filter(|a| a.components == 1) else {
        let what = format!("its cells have no array '{name}' of one component");
        return Err(reader.source.corrupt(Place::Byte(reader.document.at), what, REMEDY));
    };
    Ok((array.at, reader.numbers(array, count, |n| n)?))
}
