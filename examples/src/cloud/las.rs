//! LAS and LAZ points.

use std::io::{self, ErrorKind, Seek};
use std::path::Path;

use super::error::one_line;
use super::guard::guarded;
use super::las_claim::{Claim, Masked, check_chunks, chunked};
use super::load::{Source, reserve};
use super::{CloudError, PointCloud, tint};

/// Points decoded at a time.
const BATCH: u64 = 1 << 15;

pub(super) fn read(
    mut source: Source,
    path: &Path,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<PointCloud, CloudError> {
    let claim = Claim::inspect(&mut source, path)?;
    let room = reserve(path, claim.points, claim.credible)?;
    let mut masked = Masked::new(source, claim.record).map_err(|e| io_error(path, &e))?;
    if claim.compressed {
        let header = flatten(path, guarded(|| ::las::Header::new(&mut masked)))?;
        if chunked(&header) {
            masked.chunks = check_chunks(&mut masked.source, path, claim.start)?;
        }
        masked.rewind().map_err(|e| io_error(path, &e))?;
    }
    // `progress` is the caller's: a panic there must not pass for a damaged file.
    let mut file = flatten(path, guarded(|| ::las::Reader::new(masked)))?;
    let mut columns = Columns { cloud: room, rgb: Vec::new(), intensity: Vec::new() };
    let mut batch = ::las::PointDataBuilder::new().for_header(file.header()).build();
    let mut done = 0;
    progress(0, claim.points);
    while done < claim.points {
        let got = flatten(path, guarded(|| file.fill_points(BATCH, &mut batch)))?;
        if got == 0 {
            let what = format!("{done} of {} points are there", claim.points);
            return Err(CloudError::Truncated { path: path.into(), what });
        }
        columns.append(&batch);
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

pub(super) fn corrupt(path: &Path, what: String) -> CloudError {
    CloudError::Corrupt { path: path.into(), format: "LAS/LAZ", what, tool: "`pdal translate`" }
}

fn flatten<T>(path: &Path, result: Result<::las::Result<T>, String>) -> Result<T, CloudError> {
    match result {
        Ok(inner) => inner.map_err(|e| las_error(path, e)),
        Err(panic) => Err(corrupt(path, one_line(panic))),
    }
}

pub(super) fn las_error(path: &Path, error: ::las::Error) -> CloudError {
    match error {
        ::las::Error::Io(e) => io_error(path, &e),
        other => corrupt(path, one_line(other)),
    }
}

pub(super) fn io_error(path: &Path, error: &io::Error) -> CloudError {
    match error.kind() {
        ErrorKind::UnexpectedEof => {
            let what = "it ends within its header or points".to_owned();
            CloudError::Truncated { path: path.into(), what }
        }
        _ => corrupt(path, one_line(error)),
    }
}
