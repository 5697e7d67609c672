//! Reading a cloud from a file.

use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read, Seek};
use std::path::Path;

use super::{CloudError, PointCloud, las, ply, xyz};

/// Reads a cloud by its file's extension, in any case: `.laz`, `.las`, `.ply` or `.xyz`.
///
/// A file without colours gets greys from its intensities, or else tints by height.
/// `progress` is told how much is done of how much; the unit is bytes or points, and the
/// last call reports all.
///
/// A file that is cut off is an error. One case cannot be seen: an `.xyz` file that ends
/// after a complete `x y z [r g b]` is shorter but valid.
///
/// # Errors
///
/// When the file is missing or of unknown extension, is cut off or corrupt, holds no point,
/// more than `u32::MAX` points, or a point that is not finite.
///
/// # Examples
///
/// ```no_run
/// # use raydsl_examples::cloud::load;
/// let cloud = load("scan.laz".as_ref(), &mut |done, total| println!("{done} of {total}"))?;
/// println!("{} points", cloud.positions.len());
/// # Ok::<(), raydsl_examples::cloud::CloudError>(())
/// ```
pub fn load(path: &Path, progress: &mut dyn FnMut(u64, u64)) -> Result<PointCloud, CloudError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let (read, remedy): (Reading, _) = match extension.as_str() {
        "laz" | "las" => (
            las::read,
            "its header's scale or offset is damaged, write it again, for example with `pdal translate`",
        ),
        "ply" => (ply::read, "remove them, for example with Open3D's `remove_non_finite_points`"),
        "xyz" => (xyz::read, "remove them, for example with `grep -viE 'nan|inf'`"),
        _ => {
            return Err(CloudError::UnknownExtension { path: path.into(), extension });
        }
    };
    let source = Source::open(path)?;
    let cloud = read(source, path, progress)?;
    if cloud.positions.is_empty() {
        return Err(CloudError::EmptyFile { path: path.into() });
    }
    check_finite(&cloud.positions, || path.display().to_string(), remedy)?;
    Ok(cloud)
}

type Reading = fn(Source, &Path, &mut dyn FnMut(u64, u64)) -> Result<PointCloud, CloudError>;

/// An open file and its length.
pub(super) struct Source {
    pub(super) file: BufReader<File>,
    pub(super) len: u64,
}

impl Source {
    fn open(path: &Path) -> Result<Self, CloudError> {
        let refuse = |source: io::Error| match source.kind() {
            ErrorKind::NotFound => CloudError::Missing { path: path.into() },
            _ => CloudError::Unreadable { path: path.into(), source },
        };
        let file = File::open(path).map_err(refuse)?;
        let meta = file.metadata().map_err(refuse)?;
        if meta.is_dir() {
            return Err(refuse(io::Error::from(ErrorKind::IsADirectory)));
        }
        Ok(Self { file: BufReader::with_capacity(1 << 18, file), len: meta.len() })
    }
}

impl Read for Source {
    fn read(&mut self, buf: &mut [u8]) -> io::Result<usize> {
        self.file.read(buf)
    }
}

impl Seek for Source {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// Refuses NaN and infinite coordinates.
pub(super) fn check_finite(
    positions: &[[f64; 3]],
    name: impl FnOnce() -> String,
    remedy: &'static str,
) -> Result<(), CloudError> {
    let bad = |p: &[f64; 3]| !p.iter().all(|c| c.is_finite());
    let Some(first) = positions.iter().position(bad) else {
        return Ok(());
    };
    let count = positions[first..].iter().filter(|p| bad(p)).count();
    Err(CloudError::NotFinite { name: name(), count, total: positions.len(), first, remedy })
}

/// Room for as many points as a header claims, as far as the file's length makes them
/// credible; a claim is not trusted with more.
pub(super) fn reserve(path: &Path, claim: u64, credible: u64) -> Result<PointCloud, CloudError> {
    if claim > u64::from(u32::MAX) {
        return Err(CloudError::TooManyPoints { path: path.into(), points: claim });
    }
    let count = claim.min(credible) as usize;
    let mut cloud = PointCloud::default();
    cloud
        .positions
        .try_reserve_exact(count)
        .and_then(|()| cloud.colors.try_reserve_exact(count))
        .map_err(|_| CloudError::OutOfMemory { path: path.into(), points: claim })?;
    Ok(cloud)
}
