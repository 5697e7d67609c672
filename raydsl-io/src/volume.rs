//! Volumes: grids of numbers in three dimensions, from NIfTI, VTI, MetaImage, NRRD and raw files,
//! and from stacks of pictures.

use std::path::Path;

use glam::{Affine3, UVec3};

use crate::LoadError;
use crate::error::word_text;
use crate::format::{self, Format, loader};
use crate::source::Source;

/// Holds a grid of voxels and where it lies.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeFile {
    /// How many voxels there are along each axis, at least 1.
    pub size: UVec3,
    /// Maps the indices of a voxel, counted from 0, to its place in the world, in units and axes of
    /// the file. The place of a voxel that is a cell is its centre. The map has an inverse.
    pub to_world: Affine3,
    /// Tells whether voxels are cells, so that the volume reaches from index -0.5 to `size` - 0.5,
    /// or vertices, so that it reaches from 0 to `size` - 1.
    pub is_cell_centred: bool,
    /// The stored numbers, `x` fastest, then `y`, then `z`. Floats may be NaN or infinite.
    pub voxels: Voxels,
    /// What a stored number is multiplied by to get its value; 1 where the file does not say.
    pub scale: f32,
    /// What is added to it then; 0 where the file does not say.
    pub offset: f32,
    /// The stored number that stands for a missing value. None of the formats has a place for it,
    /// so loaders leave it empty for the caller to set.
    pub no_data: Option<f64>,
}

impl VolumeFile {
    /// Gives the value of a voxel, `scale` and `offset` included; nothing outside the volume.
    pub fn value(&self, voxel: UVec3) -> Option<f32> {
        if voxel.cmpge(self.size).any() {
            return None;
        }
        let [x, y, z] = voxel.to_array().map(|i| i as usize);
        let index = (z * self.size.y as usize + y) * self.size.x as usize + x;
        self.voxels.get(index).map(|stored| stored * self.scale + self.offset)
    }
}

/// Holds the stored numbers of a volume.
///
/// Numbers of other types become the first of these that holds all of them exactly: `U8`, `U16`,
/// `I16`. Where none does they are `F32`, rounded, and infinite beyond its range.
#[derive(Clone, Debug, PartialEq)]
pub enum Voxels {
    /// Bytes.
    U8(Vec<u8>),
    /// Unsigned integers of 16 bits.
    U16(Vec<u16>),
    /// Signed integers of 16 bits.
    I16(Vec<i16>),
    /// Floats of 32 bits.
    F32(Vec<f32>),
}

impl Voxels {
    /// Gives the number of voxels.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(v) => v.len(),
            Self::U16(v) => v.len(),
            Self::I16(v) => v.len(),
            Self::F32(v) => v.len(),
        }
    }

    /// Tells whether there are none. A loaded volume has some.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Gives a stored number, which a float holds exactly; nothing past the last.
    pub fn get(&self, index: usize) -> Option<f32> {
        match self {
            Self::U8(v) => v.get(index).map(|n| f32::from(*n)),
            Self::U16(v) => v.get(index).map(|n| f32::from(*n)),
            Self::I16(v) => v.get(index).map(|n| f32::from(*n)),
            Self::F32(v) => v.get(index).copied(),
        }
    }
}

/// Names the type of the numbers in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum VoxelType {
    /// Bytes.
    U8,
    /// Signed integers of 8 bits.
    I8,
    /// Unsigned integers of 16 bits.
    U16,
    /// Signed integers of 16 bits.
    I16,
    /// Unsigned integers of 32 bits.
    U32,
    /// Signed integers of 32 bits.
    I32,
    /// Unsigned integers of 64 bits.
    U64,
    /// Signed integers of 64 bits.
    I64,
    /// Floats of 32 bits.
    F32,
    /// Floats of 64 bits.
    F64,
}

/// Tells which byte of a number comes first in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ByteOrder {
    /// The lowest byte comes first.
    Little,
    /// The highest byte comes first.
    Big,
}

type Reading = fn(Source, Option<&str>) -> Result<VolumeFile, LoadError>;

const FORMATS: [Format<Reading>; 7] = [
    Format {
        extension: "mha",
        name: "MetaImage",
        feature: "metaimage",
        read: loader!("metaimage", crate::metaimage::read),
    },
    Format {
        extension: "mhd",
        name: "MetaImage",
        feature: "metaimage",
        read: loader!("metaimage", crate::metaimage::read),
    },
    Format {
        extension: "nhdr",
        name: "NRRD",
        feature: "nrrd",
        read: loader!("nrrd", crate::nrrd::read),
    },
    Format {
        extension: "nii",
        name: "NIfTI",
        feature: "nifti",
        read: loader!("nifti", crate::nifti::read),
    },
    Format {
        extension: "nii.gz",
        name: "NIfTI",
        feature: "nifti",
        read: loader!("nifti", crate::nifti::read),
    },
    Format {
        extension: "nrrd",
        name: "NRRD",
        feature: "nrrd",
        read: loader!("nrrd", crate::nrrd::read),
    },
    Format {
        extension: "vti",
        name: "VTI",
        feature: "vti",
        read: loader!("vti", crate::vti::read),
    },
];

/// Loads a volume by its file's extension, in any case: `.mha`, `.mhd`, `.nhdr`, `.nii`, `.nii.gz`,
/// `.nrrd` or `.vti`. Whether a `.nii` is compressed is told by its first bytes.
///
/// A `.vti` may have several arrays. The active scalars of its points are loaded, or else those of
/// its cells, or else the only array of one component.
///
/// # Errors
///
/// When the file is missing, unreadable or of unknown extension, is cut off or corrupt, has no
/// voxel or more than 2^31, several numbers for each voxel, several volumes, or a place in the
/// world that is not finite or has no inverse, as with a spacing of 0.
///
/// # Examples
///
/// ```no_run
/// let volume = raydsl_io::volume::load("head.nii.gz")?;
/// println!("{} voxels", volume.size);
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
pub fn load(path: impl AsRef<Path>) -> Result<VolumeFile, LoadError> {
    load_from(path.as_ref(), None)
}

/// Loads the array `name` of a file that may have several, a `.vti`: of its points, or else of its
/// cells.
///
/// # Errors
///
/// As [`load`] does, and when the file has no such array.
///
/// # Examples
///
/// ```no_run
/// let volume = raydsl_io::volume::load_array("fire.vti", "temperature")?;
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
pub fn load_array(path: impl AsRef<Path>, name: &str) -> Result<VolumeFile, LoadError> {
    load_from(path.as_ref(), Some(name))
}

fn load_from(path: &Path, array: Option<&str>) -> Result<VolumeFile, LoadError> {
    let (format, read) = format::of(path, &FORMATS)?;
    if let (Some(name), false) = (array, format.name == "VTI") {
        let what = format!("has no array '{}'", word_text(name.as_bytes()));
        return Err(LoadError::NoArray {
            path: path.into(),
            what,
            known: "none has a name".into(),
        });
    }
    read(Source::open(path, format.name)?, array)
}

/// Loads a file of voxels without a header. They are cells of size 1, and `to_world` is the
/// identity.
///
/// # Errors
///
/// When the file is missing or unreadable, its length is not that of `size` voxels of the type
/// `kind`, or `size` has no voxel or more than 2^31.
///
/// # Examples
///
/// ```no_run
/// use glam::uvec3;
/// use raydsl_io::volume::{ByteOrder, VoxelType, load_raw};
/// let volume = load_raw("tooth.raw", uvec3(103, 94, 161), VoxelType::U8, ByteOrder::Little)?;
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
#[cfg(feature = "raw")]
pub fn load_raw(
    path: impl AsRef<Path>,
    size: UVec3,
    kind: VoxelType,
    order: ByteOrder,
) -> Result<VolumeFile, LoadError> {
    crate::raw::read(Source::open(path.as_ref(), "raw volume")?, size, kind, order)
}

/// Loads a stack of grey PNG pictures of 8 or 16 bits, the layers in order of `z`. Voxels are cells
/// of size 1, and `to_world` is the identity.
///
/// # Errors
///
/// When there is no picture, one is missing, unreadable, cut off or corrupt, has colours or fewer
/// bits, or differs from the first in size or type, and when there are more than 2^31 voxels.
///
/// # Examples
///
/// ```no_run
/// let layers: Vec<String> = (0..300).map(|z| format!("tooth/{z:03}.png")).collect();
/// let volume = raydsl_io::volume::load_stack(&layers)?;
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
#[cfg(feature = "stack")]
pub fn load_stack<P: AsRef<Path>>(layers: &[P]) -> Result<VolumeFile, LoadError> {
    let layers: Vec<&Path> = layers.iter().map(AsRef::as_ref).collect();
    crate::stack::read(&layers)
}
