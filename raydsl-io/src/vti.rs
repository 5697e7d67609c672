//! VTI: image data of VTK, in XML.

use crate::error::{one_line, word_text};
use crate::payload::{Payload, place};
use crate::source::Source;
use crate::volume::{VolumeFile, Voxels};
use crate::vtk::{Document, Of, REMEDY, VtkArray, document, with_data};
use crate::{LoadError, Place};

pub(crate) fn read(mut source: Source, wanted: Option<&str>) -> Result<VolumeFile, LoadError> {
    let document = document::read(&mut source, "ImageData")?;
    let array = choose(&source, &document, wanted)?;
    let (kind, is_cells) = (array.kind(&source)?, array.of == Of::CellData);
    let size = document.size(is_cells);
    let payload = Payload::new(&source, size, kind, document.order)?;
    let to_world = to_world(&source, &document, is_cells)?;
    let voxels = voxels(&mut source, &document, array, &payload)?;
    let mut volume = payload.volume(voxels, to_world);
    volume.is_cell_centred = is_cells;
    Ok(volume)
}

/// The array that is asked for, or else the active scalars, or else the only scalars.
fn choose<'a>(
    source: &Source,
    document: &'a Document,
    wanted: Option<&str>,
) -> Result<&'a VtkArray, LoadError> {
    let arrays = &document.arrays;
    if arrays.is_empty() {
        return Err(LoadError::Empty { path: source.path.clone(), what: "array of voxels" });
    }
    let refuse = |what: String| {
        let known = arrays.iter().map(|a| format!("'{}' ({})", a.name, a.components));
        let known = one_line(known.take(16).collect::<Vec<_>>().join(", "));
        LoadError::NoArray { path: source.path.clone(), what, known }
    };
    let named = |name: &str, is_cells: bool| {
        let of = if is_cells { Of::CellData } else { Of::PointData };
        arrays.iter().find(|a| a.name == name && a.of == of)
    };
    let active = || {
        let names = document.active.iter().zip([false, true]);
        names.filter_map(|(name, is_cells)| named(name.as_deref()?, is_cells)).next()
    };
    let only = || {
        let mut scalars = arrays.iter().filter(|a| a.components == 1);
        scalars.next().filter(|_| scalars.next().is_none())
    };
    let found = match wanted {
        Some(name) => named(name, false)
            .or_else(|| named(name, true))
            .ok_or_else(|| refuse(format!("has no array '{}'", word_text(name.as_bytes()))))?,
        None => active()
            .or_else(only)
            .ok_or_else(|| refuse("has no active scalars and no single array of them".into()))?,
    };
    if found.components != 1 {
        let name = word_text(found.name.as_bytes());
        let what = format!("has {} components in the array '{name}'", found.components);
        return Err(refuse(what));
    }
    Ok(found)
}

fn to_world(
    source: &Source,
    document: &Document,
    is_cells: bool,
) -> Result<glam::Affine3, LoadError> {
    let Document { spacing, direction: d, .. } = document;
    // The file has the matrix row by row.
    let axes = [0, 1, 2].map(|i| [d[i], d[3 + i], d[6 + i]].map(|c| c * spacing[i]));
    let half = if is_cells { 0.5 } else { 0.0 };
    // An extent need not begin at 0.
    let first = [0, 1, 2].map(|i| f64::from(document.extent[2 * i]) + half);
    let origin = [0, 1, 2].map(|c| {
        let steps = axes.iter().zip(first).map(|(axis, first)| axis[c] * first);
        document.origin[c] + steps.sum::<f64>()
    });
    place(axes, origin).ok_or_else(|| {
        let what = "its spacing, origin or direction is not finite, or has no inverse".into();
        source.corrupt(Place::Byte(document.at), what, REMEDY)
    })
}

fn voxels(
    source: &mut Source,
    document: &Document,
    array: &VtkArray,
    payload: &Payload,
) -> Result<Voxels, LoadError> {
    let text = |stream: &mut dyn std::io::BufRead| payload.read_text(stream);
    let binary = |stream: &mut dyn std::io::Read| payload.read(stream);
    with_data(source, document, array, &payload.claim(), text, binary)
}
