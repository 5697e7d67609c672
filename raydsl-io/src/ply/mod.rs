//! PLY, text and binary.

mod body;
pub(crate) mod cloud;
mod header;
pub(crate) mod mesh;

use crate::source::Source;
use crate::{LoadError, Place};
use header::{Element, Header};

const REMEDY: &str = "write it again, for example with MeshLab";

/// An element that must be there.
fn required<'a>(
    source: &Source,
    header: &'a Header,
    name: &str,
    help: &str,
) -> Result<&'a Element, LoadError> {
    let element = header.elements.iter().find(|e| e.name == name);
    element.ok_or_else(|| {
        source.corrupt(Place::Somewhere, format!("it has no element '{name}'{help}"), REMEDY)
    })
}

/// The places of the numbers `names` among the properties of the vertices, if all are there.
fn numbers<const N: usize>(vertex: &Element, names: [&str; N]) -> Option<[usize; N]> {
    let mut places = [0; N];
    for (place, name) in places.iter_mut().zip(names) {
        *place = vertex.scalar(name)?;
    }
    Some(places)
}

/// The places of the coordinates.
fn coordinates(source: &Source, vertex: &Element) -> Result<[usize; 3], LoadError> {
    let names = ["x", "y", "z"];
    numbers(vertex, names).ok_or_else(|| {
        let missing = names.iter().find(|name| vertex.scalar(name).is_none());
        let what = format!("its vertices have no number '{}'", missing.unwrap_or(&""));
        source.corrupt(Place::Somewhere, what, REMEDY)
    })
}
