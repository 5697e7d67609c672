//! Fibre tracts: lines through a brain, from TRK files.

use std::path::Path;

use glam::{Affine3, Vec3};

use crate::LoadError;
use crate::format::{self, Format, loader};
use crate::source::Source;

/// Holds lines with numbers for each point and for each line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TractFile {
    /// The points of all tracts, one tract after another, in the file's own coordinates: of a TRK
    /// in millimetres along the axes of voxels, from the corner of the first one. They are finite.
    pub points: Vec<Vec3>,
    /// The number of points of each tract; it may be 0.
    pub lengths: Vec<u32>,
    /// The names of the numbers of points; empty where the file has none.
    pub scalar_names: Vec<String>,
    /// The numbers of points, so many for each as there are names, all of the first point first.
    /// They may be NaN.
    pub scalars: Vec<f32>,
    /// The names of the numbers of tracts.
    pub property_names: Vec<String>,
    /// The numbers of tracts, as those of points.
    pub properties: Vec<f32>,
    /// The map from the file's coordinates to those of the scanner, in millimetres towards a
    /// patient's right, front and top, if the file has it.
    pub to_world: Option<Affine3>,
}

impl TractFile {
    /// Gives the points of each tract.
    pub fn tracts(&self) -> impl Iterator<Item = &[Vec3]> {
        let mut rest = &self.points[..];
        self.lengths.iter().map(move |length| {
            let (own, others) = rest.split_at((*length as usize).min(rest.len()));
            rest = others;
            own
        })
    }
}

type Reading = fn(Source) -> Result<TractFile, LoadError>;

const FORMATS: [Format<Reading>; 1] = [Format {
    extension: "trk",
    name: "TRK",
    feature: "trk",
    read: loader!("trk", crate::trk::read),
}];

/// Loads tracts by their file's extension, in any case: `.trk`.
///
/// # Errors
///
/// When the file is missing, unreadable or of unknown extension, is cut off or corrupt, has more
/// than `u32::MAX` points, or a point that is not finite. A file without tracts is none.
///
/// # Examples
///
/// ```no_run
/// let file = raydsl_io::tracts::load("fibres.trk")?;
/// for tract in file.tracts() {
///     println!("{} points", tract.len());
/// }
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
pub fn load(path: impl AsRef<Path>) -> Result<TractFile, LoadError> {
    let path = path.as_ref();
    let (format, read) = format::of(path, &FORMATS)?;
    read(Source::open(path, format.name)?)
}
