//! What the XML formats of VTK share: the document, and the numbers of its arrays.

mod base64;
mod blocks;
mod data;
pub(crate) mod document;

use crate::error::word_text;
use crate::source::Source;
use crate::volume::VoxelType;
use crate::{LoadError, Place};

pub(crate) use data::with_data;
pub(crate) use document::Document;

pub(crate) const REMEDY: &str = "write it again, for example with ParaView";

/// What an array is of: the element that it is in.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Of {
    PointData,
    CellData,
    /// Positions of points.
    Points,
    /// Which points are in cells.
    Cells,
}

impl Of {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "PointData" => Self::PointData,
            "CellData" => Self::CellData,
            "Points" => Self::Points,
            "Cells" => Self::Cells,
            _ => return None,
        })
    }
}

/// Where the numbers of an array are.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Content {
    /// As text in its element.
    Text,
    /// As base64 in its element.
    Inline,
    /// At a place of the appended data.
    Appended(u64),
}

/// An array of numbers.
pub(crate) struct VtkArray {
    pub(crate) name: String,
    pub(crate) kind: String,
    pub(crate) components: u64,
    pub(crate) content: Content,
    pub(crate) of: Of,
    /// The byte behind its tag.
    pub(crate) at: u64,
}

impl VtkArray {
    /// The type of its numbers.
    pub(crate) fn kind(&self, source: &Source) -> Result<VoxelType, LoadError> {
        kind_of(&self.kind).ok_or_else(|| {
            let what = format!("'{}' is no type of numbers", word_text(self.kind.as_bytes()));
            source.corrupt(Place::Byte(self.at), what, REMEDY)
        })
    }
}

fn kind_of(name: &str) -> Option<VoxelType> {
    Some(match name {
        "UInt8" => VoxelType::U8,
        "Int8" => VoxelType::I8,
        "UInt16" => VoxelType::U16,
        "Int16" => VoxelType::I16,
        "UInt32" => VoxelType::U32,
        "Int32" => VoxelType::I32,
        "UInt64" => VoxelType::U64,
        "Int64" => VoxelType::I64,
        "Float32" => VoxelType::F32,
        "Float64" => VoxelType::F64,
        _ => return None,
    })
}
