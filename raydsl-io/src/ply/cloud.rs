//! Points of a PLY.

use super::body::{Body, Row};
use super::header::{self, Element, Kind, Scalar};
use super::{REMEDY, coordinates, numbers, required};
use crate::cloud::{PointCloud, reserve};
use crate::source::Source;
use crate::tint::{self, Gathered};
use crate::{LoadError, Place};

/// Points between two reports of progress.
const REPORT: u64 = 1 << 16;

pub(crate) fn read(
    mut source: Source,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<PointCloud, LoadError> {
    let header = header::read(&mut source)?;
    let vertex = required(&source, &header, "vertex", "")?;
    let places = coordinates(&source, vertex)?;
    let color = color(&source, vertex)?;
    let held = source.remaining() / vertex.least_size(header.encoding).max(1);
    let mut cloud = reserve(&source, vertex.count, held)?;
    let mut body = Body::new(source, &header);
    for element in header.elements.iter().take_while(|e| e.name != "vertex") {
        body.skip(element)?;
    }
    let kind = color.map(|(kind, _)| kind);
    let bytes = kind == Some(Scalar::U8);
    let mut rgb = Gathered::new(std::mem::take(&mut cloud.colors), bytes);
    let (mut wide, mut row) = (Vec::new(), Row::default());
    let total = vertex.count;
    progress(0, total);
    for i in 0..total {
        let start = body.source.at;
        body.read(vertex, i, None, &mut row)?;
        cloud.positions.push(places.map(|p| row.numbers[p]));
        let color = color.map(|(_, places)| places.map(|p| row.numbers[p]));
        match (kind, color) {
            (Some(Scalar::U16), Some(color)) => wide.push(color.map(|c| c as u16)),
            (_, Some(color)) => {
                rgb.push(color).map_err(|c| body.bad_row(start, bad_color(i, c)))?;
            }
            (_, None) => {}
        }
        if (i + 1) % REPORT == 0 || i + 1 == total {
            progress(i + 1, total);
        }
    }
    cloud.colors = match kind {
        Some(Scalar::U16) => tint::from_rgb16(&wide),
        Some(_) => rgb.finish(),
        None => tint::from_height(&cloud.positions),
    };
    Ok(cloud)
}

fn bad_color(point: u64, value: f64) -> String {
    format!("point {point} has the colour value {value}, outside 0 to 255")
}

/// What the channels of colours are called.
const NAMES: [[&str; 3]; 3] =
    [["red", "green", "blue"], ["r", "g", "b"], ["diffuse_red", "diffuse_green", "diffuse_blue"]];

/// The type and the places of the colours, if there are any.
fn color(source: &Source, vertex: &Element) -> Result<Option<(Scalar, [usize; 3])>, LoadError> {
    let Some(places) = NAMES.iter().find_map(|names| numbers(vertex, *names)) else {
        return Ok(None);
    };
    let [red, green, blue] = places.map(|p| vertex.properties[p].kind);
    match red {
        Kind::Scalar(kind) if red == green && red == blue => Ok(Some((kind, places))),
        _ => {
            let what = "its colour channels differ in type";
            Err(source.corrupt(Place::Somewhere, what.into(), REMEDY))
        }
    }
}
