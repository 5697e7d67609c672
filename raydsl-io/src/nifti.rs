//! NIfTI-1 and NIfTI-2, in one file.

use crate::payload::{Compression, Payload, place};
use crate::source::Source;
use crate::volume::{ByteOrder, VolumeFile, VoxelType};
use crate::{LoadError, Place};

const REMEDY: &str = "write it again, for example with nibabel";
/// Length of the header of version 1, which is its first number, and the same of version 2.
const LENGTHS: [usize; 2] = [348, 540];

pub(crate) fn read(mut source: Source, _: Option<&str>) -> Result<VolumeFile, LoadError> {
    let is_packed = source.starts_with(&[0x1f, 0x8b])?;
    let mut bytes = [0; LENGTHS[1]];
    let held = if is_packed {
        head(flate2::bufread::MultiGzDecoder::new(&mut source), &mut bytes)
    } else {
        head(&mut source, &mut bytes)
    };
    let held = held.map_err(|e| source.fault(e.into(), REMEDY))?;
    let bad = |(at, what): Wrong| source.corrupt(Place::Byte(at), what, REMEDY);
    let Some(number) = bytes.first_chunk::<4>().filter(|_| held >= 4) else {
        return Err(source.truncated("it ends within its header".into()));
    };
    let length = |number: i32| LENGTHS.iter().position(|l| i64::from(number) == *l as i64);
    let (version, order) =
        match (length(i32::from_le_bytes(*number)), length(i32::from_be_bytes(*number))) {
            (Some(version), _) => (version, ByteOrder::Little),
            (_, Some(version)) => (version, ByteOrder::Big),
            _ => {
                let what = "its first number is not 348 or 540, the length of a header".into();
                return Err(bad((0, what)));
            }
        };
    let length = LENGTHS[version];
    if held < length {
        return Err(source.truncated(format!("{held} of {length} bytes of its header are there")));
    }
    let header = Header::read(Numbers { bytes: &bytes, order }, version).map_err(bad)?;
    let (size, kind) = (header.size().map_err(bad)?, header.kind().map_err(bad)?);
    let payload = Payload::new(&source, size, kind, order)?;
    let to_world = header.to_world().map_err(bad)?;
    let start = header.start(length as u64).map_err(bad)?;
    let voxels = if is_packed {
        source.go_to(0)?;
        payload.read_packed(&mut source, Compression::Gzip, start, REMEDY)?
    } else {
        if !source.go_to(start)? {
            let what = format!("the voxels begin at byte {start} of {}", source.len);
            return Err(source.truncated(what));
        }
        payload.read_plain(&mut source, REMEDY)?
    };
    let mut volume = payload.volume(voxels, to_world);
    // A factor of 0 stands for none.
    if header.slope != 0.0 && header.slope.is_finite() && header.intercept.is_finite() {
        (volume.scale, volume.offset) = (header.slope as f32, header.intercept as f32);
    }
    Ok(volume)
}

/// Reads what is there of the longer header.
fn head(mut stream: impl std::io::Read, bytes: &mut [u8]) -> std::io::Result<usize> {
    let mut held = 0;
    while held < bytes.len() {
        match stream.read(&mut bytes[held..]) {
            Ok(0) => break,
            Ok(n) => held += n,
            Err(e) if e.kind() == std::io::ErrorKind::Interrupted => {}
            // It may be longer than the file.
            Err(e) if e.kind() == std::io::ErrorKind::UnexpectedEof && held > 0 => break,
            Err(e) => return Err(e),
        }
    }
    Ok(held)
}

/// A byte, and what is wrong there.
type Wrong = (u64, String);

/// Numbers of a header, by their places.
#[derive(Clone, Copy)]
struct Numbers<'a> {
    bytes: &'a [u8],
    order: ByteOrder,
}

impl Numbers<'_> {
    fn at<const N: usize>(self, at: usize) -> [u8; N] {
        let mut number: [u8; N] = std::array::from_fn(|i| self.bytes[at + i]);
        if self.order == ByteOrder::Big {
            number.reverse();
        }
        number
    }

    fn i16(self, at: usize) -> i64 {
        i16::from_le_bytes(self.at(at)).into()
    }

    fn i32(self, at: usize) -> i64 {
        i32::from_le_bytes(self.at(at)).into()
    }

    fn i64(self, at: usize) -> i64 {
        i64::from_le_bytes(self.at(at))
    }

    fn f32s<const N: usize>(self, at: usize) -> [f64; N] {
        std::array::from_fn(|i| f32::from_le_bytes(self.at(at + 4 * i)).into())
    }

    fn f64s<const N: usize>(self, at: usize) -> [f64; N] {
        std::array::from_fn(|i| f64::from_le_bytes(self.at(at + 8 * i)))
    }
}

/// What a header says, and where.
struct Header {
    /// Where the sizes are.
    sizes_at: u64,
    /// The number of axes, and the size along each.
    sizes: [i64; 8],
    kind_at: u64,
    kind: i64,
    spacings_at: u64,
    /// The sign of the third axis, and the spacing along each.
    spacings: [f64; 8],
    start_at: u64,
    start: f64,
    slope: f64,
    intercept: f64,
    has_rotation: bool,
    has_matrix: bool,
    rotation_at: u64,
    /// Three numbers of a quaternion.
    rotation: [f64; 3],
    origin: [f64; 3],
    matrix_at: u64,
    /// A matrix, row by row.
    matrix: [[f64; 4]; 3],
}

impl Header {
    fn read(n: Numbers<'_>, version: usize) -> Result<Self, Wrong> {
        let magic_at = if version == 0 { 344 } else { 4 };
        let magic: [u8; 3] = std::array::from_fn(|i| n.bytes[magic_at + i]);
        match &magic {
            b"n+1" | b"n+2" => {}
            b"ni1" | b"ni2" => {
                let what = "its voxels are in an .img beside it, not in the same file";
                return Err((magic_at as u64, what.into()));
            }
            _ => return Err((magic_at as u64, "it has no mark `n+1` or `n+2`".into())),
        }
        Ok(if version == 0 { Self::first(n) } else { Self::second(n) })
    }

    fn first(n: Numbers<'_>) -> Self {
        let [start, slope, intercept] = n.f32s(108);
        Self {
            sizes_at: 40,
            sizes: std::array::from_fn(|i| n.i16(40 + 2 * i)),
            kind_at: 70,
            kind: n.i16(70),
            spacings_at: 76,
            spacings: n.f32s(76),
            start_at: 108,
            start,
            slope,
            intercept,
            has_rotation: n.i16(252) > 0,
            has_matrix: n.i16(254) > 0,
            rotation_at: 256,
            rotation: n.f32s(256),
            origin: n.f32s(268),
            matrix_at: 280,
            matrix: [n.f32s(280), n.f32s(296), n.f32s(312)],
        }
    }

    fn second(n: Numbers<'_>) -> Self {
        let [slope, intercept] = n.f64s(176);
        Self {
            sizes_at: 16,
            sizes: std::array::from_fn(|i| n.i64(16 + 8 * i)),
            kind_at: 12,
            kind: n.i16(12),
            spacings_at: 104,
            spacings: n.f64s(104),
            start_at: 168,
            start: n.i64(168) as f64,
            slope,
            intercept,
            has_rotation: n.i32(344) > 0,
            has_matrix: n.i32(348) > 0,
            rotation_at: 352,
            rotation: n.f64s(352),
            origin: n.f64s(376),
            matrix_at: 400,
            matrix: [n.f64s(400), n.f64s(432), n.f64s(464)],
        }
    }

    fn size(&self) -> Result<[u64; 3], Wrong> {
        let [axes, sizes @ ..] = self.sizes;
        if !(1..=7).contains(&axes) {
            return Err((self.sizes_at, format!("it has {axes} axes, 1 to 7 are possible")));
        }
        let size = |i: usize| if (i as i64) < axes { sizes[i] } else { 1 };
        if let Some(i) = (0..7).find(|i| size(*i) < 0) {
            return Err((self.sizes_at, format!("its size along axis {i} is {}", size(i))));
        }
        if let Some(count) = (3..7).map(size).find(|n| *n != 1) {
            let what =
                format!("it has {count} volumes, or numbers for each voxel, and one is read");
            return Err((self.sizes_at, what));
        }
        Ok([0, 1, 2].map(|i| size(i) as u64))
    }

    fn kind(&self) -> Result<VoxelType, Wrong> {
        Ok(match self.kind {
            2 => VoxelType::U8,
            4 => VoxelType::I16,
            8 => VoxelType::I32,
            16 => VoxelType::F32,
            64 => VoxelType::F64,
            256 => VoxelType::I8,
            512 => VoxelType::U16,
            768 => VoxelType::U32,
            1024 => VoxelType::I64,
            1280 => VoxelType::U64,
            other => {
                let what = format!("the type {other} of its voxels is none of a single number");
                return Err((self.kind_at, what));
            }
        })
    }

    /// Where the voxels begin.
    fn start(&self, length: u64) -> Result<u64, Wrong> {
        // Some writers leave it 0 where the voxels follow the header and the four bytes behind it.
        let start = if self.start == 0.0 { (length + 4) as f64 } else { self.start };
        if start.fract() != 0.0 || !((length as f64)..1e18).contains(&start) {
            return Err((self.start_at, format!("its voxels begin at byte {start}")));
        }
        Ok(start as u64)
    }

    fn to_world(&self) -> Result<glam::Affine3, Wrong> {
        if self.has_matrix {
            let m = self.matrix;
            let column = |i: usize| [m[0][i], m[1][i], m[2][i]];
            let found = place([column(0), column(1), column(2)], column(3));
            return found.ok_or_else(|| {
                (self.matrix_at, "its matrix is not finite, or has no inverse".into())
            });
        }
        let [sign, spacings @ ..] = self.spacings;
        let mut spacing = [spacings[0], spacings[1], spacings[2]];
        // Axes that it lacks may have none.
        for (i, d) in spacing.iter_mut().enumerate() {
            if i as i64 >= self.sizes[0] && *d == 0.0 {
                *d = 1.0;
            }
        }
        if let Some(d) = spacing.iter().find(|d| !(**d > 0.0 && d.is_finite())) {
            return Err((
                self.spacings_at,
                format!("the spacing {d} of its voxels is not positive"),
            ));
        }
        let [x, y, z] = spacing;
        if !self.has_rotation {
            let axes = [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
            let found = place(axes, [0.0; 3]);
            return found.ok_or_else(|| (self.spacings_at, "its spacing has no inverse".into()));
        }
        let z = if sign < 0.0 { -z } else { z };
        let [i, j, k] = rotation(self.rotation);
        let axes = [i.map(|c| c * x), j.map(|c| c * y), k.map(|c| c * z)];
        place(axes, self.origin).ok_or_else(|| {
            let what = "its rotation, spacing or origin is not finite, or has no inverse";
            (self.rotation_at, what.into())
        })
    }
}

/// The columns of the rotation of a quaternion, of which three numbers are given.
fn rotation([b, c, d]: [f64; 3]) -> [[f64; 3]; 3] {
    let rest = 1.0 - (b * b + c * c + d * d);
    let (a, [b, c, d]) = if rest < 1e-7 {
        let length = (b * b + c * c + d * d).sqrt();
        (0.0, [b / length, c / length, d / length])
    } else {
        (rest.sqrt(), [b, c, d])
    };
    [
        [a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)],
        [2.0 * (b * c - a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d + a * b)],
        [2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a + d * d - b * b - c * c],
    ]
}
