//! VTU: unstructured grids of VTK, in XML.

mod numbers;
mod shape;

use glam::Vec3;

use crate::cells::{CellArray, CellFile};
use crate::source::Source;
use crate::vtk::{Document, Of, REMEDY, VtkArray, document};
use crate::{LoadError, Place};
use numbers::Reader;
use shape::Shape;

const SPLIT: &str = "split it into several files";

pub(crate) fn read(mut source: Source) -> Result<CellFile, LoadError> {
    let mut document = document::read(&mut source, "UnstructuredGrid")?;
    let arrays = std::mem::take(&mut document.arrays);
    check_counts(&source, &document)?;
    let [point_count, cell_count] = document.counts;
    let mut reader = Reader::new(&mut source, &document);
    let points = points(&mut reader, &arrays, point_count)?;
    let shape = Shape::read(&mut reader, &arrays, point_count, cell_count)?;
    let [mut point_arrays, mut cell_arrays] = [Vec::new(), Vec::new()];
    // Texts and single bits are no fields.
    for array in arrays.iter().filter(|a| !["String", "Bit"].contains(&a.kind.as_str())) {
        match array.of {
            Of::PointData => point_arrays.push(reader.array(array, point_count)?),
            Of::CellData => {
                let CellArray { name, components, values } = reader.array(array, cell_count)?;
                cell_arrays.push(CellArray {
                    name,
                    components,
                    values: shape.kept(&values, components),
                });
            }
            Of::Points | Of::Cells => {}
        }
    }
    if shape.kinds.is_empty() {
        let path = source.path.clone();
        return Err(LoadError::Empty { path, what: "cell with a volume" });
    }
    let Shape { kinds, vertices, skipped, .. } = shape;
    let active = document.active;
    Ok(CellFile { points, kinds, vertices, point_arrays, cell_arrays, active, skipped })
}

/// An error if there are too many points or cells for indices of 32 bits.
fn check_counts(source: &Source, document: &Document) -> Result<(), LoadError> {
    let limit = u64::from(u32::MAX);
    for (what, count) in ["point", "cell"].into_iter().zip(document.counts) {
        if count > limit {
            let path = source.path.clone();
            return Err(LoadError::TooMany { path, what, count, limit, remedy: SPLIT });
        }
    }
    Ok(())
}

fn points(
    reader: &mut Reader<'_>,
    arrays: &[VtkArray],
    count: u64,
) -> Result<Vec<Vec3>, LoadError> {
    let Some(array) = arrays.iter().find(|a| a.of == Of::Points) else {
        let what = "it has no array of points".into();
        return Err(reader.source.corrupt(Place::Byte(reader.document.at), what, REMEDY));
    };
    if array.components != 3 {
        let what = format!("its points have {} coordinates instead of 3", array.components);
        return Err(reader.source.corrupt(Place::Byte(array.at), what, REMEDY));
    }
    let numbers = reader.array(array, count)?.values;
    let points: Vec<Vec3> = numbers.as_chunks::<3>().0.iter().map(|p| Vec3::from(*p)).collect();
    let mut odd = points.iter().enumerate().filter(|(_, p)| !p.is_finite());
    if let Some((first, _)) = odd.next() {
        return Err(LoadError::NotFinite {
            path: reader.source.path.clone(),
            what: "point",
            count: odd.count() + 1,
            total: points.len(),
            first,
            remedy: "repair or remove the points",
        });
    }
    Ok(points)
}
