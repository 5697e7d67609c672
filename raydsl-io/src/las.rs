//! LAS and LAZ points.

use std::io::{self, ErrorKind, Seek};
use std::path::Path;

use crate::cloud::{PointCloud, reserve};
use crate::error::one_line;
use crate::guard::guarded;
use crate::las_claim::{Claim, Masked, check_chunks, chunked};
use crate::source::Source;
use crate::stop::is_stopped;
use crate::{LoadError, Place, tint};

/// Points decoded at a time, and bytes of them before compression: a header may claim long points.
const BATCH: u64 = 1 << 15;
const BATCH_BYTES: u64 = 1 << 21;

pub(crate) fn read(
    mut source: Source,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<PointCloud, LoadError> {
    let (path, len) = (source.path.clone(), source.len);
    let file = File { path: &path, len };
    let claim = Claim::inspect(&mut source, file)?;
    let room = reserve(&source, claim.points, claim.credible)?;
    let mut masked = Masked::new(source, claim.record).map_err(|e| file.io_error(&e))?;
    if claim.compressed {
        let header = file.flatten(guarded(|| ::las::Header::new(&mut masked)))?;
        if chunked(&header) {
            masked.chunks = check_chunks(&mut masked.source, file, claim.start)?;
        }
        masked.rewind().map_err(|e| file.io_error(&e))?;
    }
    // `progress` is the caller's: a panic there must not pass for a damaged file.
    let mut reader = file.flatten(guarded(|| ::las::Reader::new(masked)))?;
    let mut columns = Columns { cloud: room, rgb: Vec::new(), intensity: Vec::new() };
    let mut points = ::las::PointDataBuilder::new().for_header(reader.header()).build();
    let batch = BATCH.min(BATCH_BYTES / claim.record.max(1)).max(1);
    let mut done = 0;
    progress(0, claim.points);
    while done < claim.points {
        let got = file.flatten(guarded(|| reader.fill_points(batch, &mut points)))?;
        if got == 0 {
            return Err(file.truncated(format!("{done} of {} points are there", claim.points)));
        }
        columns.append(&points);
        done += got;
        progress(done, claim.points);
    }
    Ok(columns.finish())
}

/// Points as they are in the file; colours are settled when all are known.
struct Columns {
    cloud: PointCloud,
    rgb: Vec<[u16; 3]>,
    intensity: Vec<u16>,
}

impl Columns {
    fn append(&mut self, batch: &::las::PointData) {
        let xyz = batch.x().zip(batch.y()).zip(batch.z());
        self.cloud.positions.extend(xyz.map(|((x, y), z)| [x, y, z]));
        match batch.rgb() {
            Some(rgb) => self.rgb.extend(rgb.map(|(r, g, b)| [r, g, b])),
            None => self.intensity.extend(batch.intensity()),
        }
    }

    fn finish(self) -> PointCloud {
        let Self { mut cloud, rgb, intensity } = self;
        let present = |c: &u16| *c != 0;
        cloud.colors = if rgb.iter().flatten().any(present) {
            tint::from_rgb16(&rgb)
        } else if intensity.iter().any(present) {
            tint::from_intensity(&intensity)
        } else {
            tint::from_height(&cloud.positions)
        };
        cloud
    }
}

/// The file, for errors.
#[derive(Clone, Copy)]
pub(crate) struct File<'a> {
    path: &'a Path,
    pub(crate) len: u64,
}

impl File<'_> {
    fn unless_stopped(self, error: LoadError) -> LoadError {
        if is_stopped() { LoadError::Stopped { path: self.path.into() } } else { error }
    }

    pub(crate) fn corrupt(self, place: Place, what: String) -> LoadError {
        let (path, remedy) =
            (self.path.into(), "write it again, for example with `pdal translate`");
        self.unless_stopped(LoadError::Corrupt { path, place, format: "LAS/LAZ", what, remedy })
    }

    pub(crate) fn truncated(self, what: String) -> LoadError {
        self.unless_stopped(LoadError::Truncated { path: self.path.into(), len: self.len, what })
    }

    fn flatten<T>(self, result: Result<::las::Result<T>, String>) -> Result<T, LoadError> {
        match result {
            Ok(inner) => inner.map_err(|e| self.las_error(e)),
            Err(panic) => Err(self.corrupt(Place::Somewhere, one_line(panic))),
        }
    }

    pub(crate) fn las_error(self, error: ::las::Error) -> LoadError {
        match error {
            ::las::Error::Io(e) => self.io_error(&e),
            other => self.corrupt(Place::Somewhere, one_line(other)),
        }
    }

    pub(crate) fn io_error(self, error: &io::Error) -> LoadError {
        match error.kind() {
            ErrorKind::UnexpectedEof => {
                self.truncated("it ends within its header or points".to_owned())
            }
            _ => self.corrupt(Place::Somewhere, one_line(error)),
        }
    }
}
