//! TRK: tracts as TrackVis stores them.

use std::collections::TryReserveError;

use glam::{Affine3, DAffine3, DMat3, DMat4, DVec3, Vec3};

use crate::error::word_text;
use crate::source::Source;
use crate::tracts::TractFile;
use crate::volume::ByteOrder;
use crate::{LoadError, Place};

/// Bytes of the header, which its last number says, too.
const HEADER: usize = 1000;
const REMEDY: &str = "write it again, for example with nibabel";
/// The remedy where it is too large.
const SPLIT: &str = "store fewer tracts in a file";
/// Names in the header, and bytes of each.
const NAMES: usize = 10;
const NAME: usize = 20;

/// Places of what is used of the header.
mod at {
    pub(super) const DIMENSIONS: usize = 6;
    pub(super) const SPACING: usize = 12;
    pub(super) const SCALARS: usize = 36;
    pub(super) const SCALAR_NAMES: usize = 38;
    pub(super) const PROPERTIES: usize = 238;
    pub(super) const PROPERTY_NAMES: usize = 240;
    pub(super) const MATRIX: usize = 440;
    pub(super) const AXES: usize = 948;
    pub(super) const COUNT: usize = 988;
    pub(super) const VERSION: usize = 992;
    pub(super) const LENGTH: usize = 996;
}

pub(crate) fn read(mut source: Source) -> Result<TractFile, LoadError> {
    let mut bytes = [0; HEADER];
    let len = source.len;
    if !source.fill(&mut bytes)? {
        return Err(source.truncated(format!("{len} of {HEADER} bytes of its header are there")));
    }
    let bad = |(at, what): Wrong| source.corrupt(Place::Byte(at as u64), what, REMEDY);
    let header = Header::new(&bytes).map_err(bad)?;
    let scalars = header.count_at(at::SCALARS, "scalars").map_err(bad)?;
    let properties = header.count_at(at::PROPERTIES, "properties").map_err(bad)?;
    let file = TractFile {
        scalar_names: header.names(at::SCALAR_NAMES, scalars),
        property_names: header.names(at::PROPERTY_NAMES, properties),
        to_world: header.to_world().map_err(bad)?,
        ..TractFile::default()
    };
    let count = header.i32(at::COUNT);
    // A count of 0 is one that is not known.
    let claim = match u32::try_from(count) {
        Ok(count) => Some(count).filter(|n| *n > 0),
        Err(_) => return Err(bad((at::COUNT, format!("it has {count} tracts")))),
    };
    let order = header.order;
    Body { source, order, scalars, properties, file }.read(claim)
}

/// A byte, and what is wrong there.
type Wrong = (usize, String);

/// The first bytes of a file.
struct Header<'a> {
    bytes: &'a [u8; HEADER],
    order: ByteOrder,
}

impl<'a> Header<'a> {
    fn new(bytes: &'a [u8; HEADER]) -> Result<Self, Wrong> {
        if !bytes.starts_with(b"TRACK") {
            return Err((0, "it does not begin with 'TRACK'".into()));
        }
        let is = |order| Self { bytes, order }.i32(at::LENGTH) == HEADER as i32;
        let Some(order) = [ByteOrder::Little, ByteOrder::Big].into_iter().find(|o| is(*o)) else {
            return Err((at::LENGTH, format!("the length of its header is not {HEADER}")));
        };
        let header = Self { bytes, order };
        let version = header.i32(at::VERSION);
        if !(1..=3).contains(&version) {
            return Err((at::VERSION, format!("its version is {version}, not 1, 2 or 3")));
        }
        Ok(header)
    }

    fn number<const N: usize>(&self, at: usize) -> [u8; N] {
        ordered(self.order, std::array::from_fn(|i| self.bytes[at + i]))
    }

    fn i16(&self, at: usize) -> i16 {
        i16::from_le_bytes(self.number(at))
    }

    fn i32(&self, at: usize) -> i32 {
        i32::from_le_bytes(self.number(at))
    }

    fn f32(&self, at: usize) -> f64 {
        f32::from_le_bytes(self.number(at)).into()
    }

    /// The number of scalars or of properties.
    fn count_at(&self, at: usize, what: &str) -> Result<usize, Wrong> {
        let count = self.i16(at);
        usize::try_from(count).map_err(|_| (at, format!("it has {count} {what}")))
    }

    /// Names, some of which the header may have no room for.
    fn names(&self, at: usize, count: usize) -> Vec<String> {
        let name = |i: usize| {
            if i >= NAMES {
                return String::new();
            }
            let bytes = &self.bytes[at + NAME * i..][..NAME];
            // A number may follow the end of the name.
            word_text(bytes.split(|b| *b == 0).next().unwrap_or_default())
        };
        (0..count).map(name).collect()
    }

    /// The map from the coordinates of points to those of the scanner.
    ///
    /// Points count from the corner of the first voxel, the matrix from its middle. The axes of the
    /// points may be those of the matrix in another order, or turned around.
    fn to_world(&self) -> Result<Option<Affine3>, Wrong> {
        let matrix = DMat4::from_cols_array(&std::array::from_fn(|i| self.f32(at::MATRIX + 4 * i)));
        // By rows in the file.
        let matrix = matrix.transpose();
        if self.i32(at::VERSION) == 1 || matrix.w_axis.w == 0.0 {
            return Ok(None);
        }
        let spacing = DVec3::from_array([0, 1, 2].map(|i| self.f32(at::SPACING + 4 * i)));
        if !(spacing.is_finite() && spacing.min_element() > 0.0) {
            return Err((at::SPACING, format!("its voxels have the size {spacing}")));
        }
        let no_map = || (at::MATRIX, "its matrix is not finite or has no inverse".to_owned());
        if !matrix.is_finite() {
            return Err(no_map());
        }
        let to_ras = DAffine3::from_mat4(matrix);
        let axes = main_axes(to_ras.matrix3).ok_or_else(no_map)?;
        let turned = self.turned(axes)?;
        let to_voxels = DAffine3::from_scale(spacing.recip());
        let to_middle = DAffine3::from_translation(DVec3::splat(-0.5));
        let map = (to_ras * turned * to_middle * to_voxels).as_affine3();
        let inverse = map.as_daffine3().inverse().as_affine3();
        if !(map.is_finite() && inverse.is_finite()) {
            return Err(no_map());
        }
        Ok(Some(map))
    }

    /// The map from the axes of points to those of the matrix, which run along `axes`.
    fn turned(&self, axes: [Axis; 3]) -> Result<DAffine3, Wrong> {
        let letters = &self.bytes[at::AXES..][..4];
        let letters = letters.split(|b| *b == 0).next().unwrap_or_default();
        // TrackVis takes these where there is none.
        let letters = if letters.is_empty() { b"LPS" } else { letters };
        let own: Option<Vec<Axis>> = letters.iter().map(|letter| Axis::of(*letter)).collect();
        let own = own.filter(|own| {
            own.len() == 3 && (0..3).all(|along| own.iter().any(|axis| axis.along == along))
        });
        let Some(own) = own else {
            let what = format!("its voxels have the order '{}'", word_text(letters));
            return Err((at::AXES, what));
        };
        let (mut matrix, mut translation) = (DMat3::ZERO, DVec3::ZERO);
        for (to, axis) in axes.into_iter().enumerate() {
            let from = own.iter().position(|own| own.along == axis.along).unwrap_or(to);
            if own[from].is_positive == axis.is_positive {
                matrix.col_mut(from)[to] = 1.0;
            } else {
                matrix.col_mut(from)[to] = -1.0;
                translation[to] = f64::from(self.i16(at::DIMENSIONS + 2 * from)) - 1.0;
            }
        }
        Ok(DAffine3 { matrix3: matrix, translation })
    }
}

/// Which of the scanner's axes an axis of voxels runs along, and in which sense.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    along: usize,
    is_positive: bool,
}

impl Axis {
    fn of(letter: u8) -> Option<Self> {
        let at = b"LRPAIS".iter().position(|l| *l == letter.to_ascii_uppercase())?;
        Some(Self { along: at / 2, is_positive: at % 2 == 1 })
    }
}

/// The axes that the columns of a matrix run along, the clearest one first; none if one is 0.
fn main_axes(matrix: DMat3) -> Option<[Axis; 3]> {
    let units = [0, 1, 2].map(|i| matrix.col(i).try_normalize());
    let mut found = [None; 3];
    for _ in 0..3 {
        let mut best = (0.0, 0, 0);
        for column in 0..3 {
            for along in 0..3 {
                let is_free = found[column].is_none()
                    && !found.iter().flatten().any(|axis: &Axis| axis.along == along);
                let size = units[column]?[along].abs();
                if is_free && size > best.0 {
                    best = (size, column, along);
                }
            }
        }
        let (size, column, along) = best;
        if size == 0.0 {
            return None;
        }
        found[column] = Some(Axis { along, is_positive: units[column]?[along] > 0.0 });
    }
    Some([found[0]?, found[1]?, found[2]?])
}

/// Bytes in the order of this format's little-endian form.
fn ordered<const N: usize>(order: ByteOrder, mut bytes: [u8; N]) -> [u8; N] {
    if order == ByteOrder::Big {
        bytes.reverse();
    }
    bytes
}

/// What follows the header.
struct Body {
    source: Source,
    order: ByteOrder,
    scalars: usize,
    properties: usize,
    file: TractFile,
}

impl Body {
    fn read(mut self, claim: Option<u32>) -> Result<TractFile, LoadError> {
        loop {
            let found = self.file.lengths.len() as u32;
            if Some(found) == claim || claim.is_none() && self.source.remaining() == 0 {
                break;
            }
            self.tract(claim)?;
        }
        if self.source.remaining() > 0 {
            let what = format!("{} bytes follow its last tract", self.source.remaining());
            return Err(self.source.corrupt(Place::Byte(self.source.at), what, REMEDY));
        }
        self.check_finite()?;
        Ok(self.file)
    }

    fn tract(&mut self, claim: Option<u32>) -> Result<(), LoadError> {
        let (tract, begin) = (self.file.lengths.len(), self.source.at);
        let of = claim.map_or(String::new(), |all| format!(" of {all}"));
        let cut = |source: &Source| {
            source.truncated(format!("tract {tract}{of}, counted from 0, is not all there"))
        };
        let mut count = [0; 4];
        if !self.source.fill(&mut count)? {
            return Err(cut(&self.source));
        }
        let count = i32::from_le_bytes(ordered(self.order, count));
        let Ok(count) = u32::try_from(count) else {
            let what = format!("tract {tract}, counted from 0, has {count} points");
            return Err(self.source.corrupt(Place::Byte(begin), what, REMEDY));
        };
        let of_points = u64::from(count) * (3 + self.scalars as u64);
        let numbers = of_points + self.properties as u64;
        if numbers * 4 > self.source.remaining() {
            return Err(cut(&self.source));
        }
        let total = self.file.points.len() as u64 + u64::from(count);
        let limit = u64::from(u32::MAX);
        if total > limit {
            let path = self.source.path.clone();
            return Err(LoadError::TooMany {
                path,
                what: "point",
                count: total,
                limit,
                remedy: SPLIT,
            });
        }
        if self.reserve(count as usize).is_err() {
            let path = self.source.path.clone();
            return Err(LoadError::OutOfMemory {
                path,
                what: "point",
                count: total,
                remedy: SPLIT,
            });
        }
        for _ in 0..count {
            let point = [self.number()?, self.number()?, self.number()?];
            self.file.points.push(Vec3::from(point));
            for _ in 0..self.scalars {
                let number = self.number()?;
                self.file.scalars.push(number);
            }
        }
        for _ in 0..self.properties {
            let number = self.number()?;
            self.file.properties.push(number);
        }
        self.file.lengths.push(count);
        Ok(())
    }

    /// Makes room for a tract of so many points, which the rest of the file has.
    fn reserve(&mut self, count: usize) -> Result<(), TryReserveError> {
        self.file.points.try_reserve(count)?;
        self.file.scalars.try_reserve(count * self.scalars)?;
        self.file.properties.try_reserve(self.properties)?;
        self.file.lengths.try_reserve(1)
    }

    fn number(&mut self) -> Result<f32, LoadError> {
        let mut bytes = [0; 4];
        if !self.source.fill(&mut bytes)? {
            return Err(self.source.truncated("it got shorter while it was read".into()));
        }
        Ok(f32::from_le_bytes(ordered(self.order, bytes)))
    }

    fn check_finite(&self) -> Result<(), LoadError> {
        let points = &self.file.points;
        let Some(first) = points.iter().position(|p| !p.is_finite()) else { return Ok(()) };
        Err(LoadError::NotFinite {
            path: self.source.path.clone(),
            what: "point",
            count: points[first..].iter().filter(|p| !p.is_finite()).count(),
            total: points.len(),
            first,
            remedy: "remove their tracts, for example with nibabel",
        })
    }
}
