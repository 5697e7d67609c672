//! Clouds of points with colours, from LAS, LAZ, PLY and XYZ files.

use std::path::Path;

use crate::LoadError;
use crate::format::{self, Format, loader};
use crate::source::Source;

/// What to do with a cloud that is too large.
const THIN: &str = "thin or tile it, for example with `pdal translate -f filters.decimation`";

/// Holds points with a colour each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// Coordinates in units of the file. In scans z is up, as a rule.
    pub positions: Vec<[f64; 3]>,
    /// sRGB colours, as many as positions.
    pub colors: Vec<[u8; 3]>,
}

type Reading = fn(Source, &mut dyn FnMut(u64, u64)) -> Result<PointCloud, LoadError>;

const FORMATS: [Format<Reading>; 4] = [
    Format {
        extension: "laz",
        name: "LAS/LAZ",
        feature: "las",
        read: loader!("las", crate::las::read),
    },
    Format {
        extension: "las",
        name: "LAS/LAZ",
        feature: "las",
        read: loader!("las", crate::las::read),
    },
    Format {
        extension: "ply",
        name: "PLY",
        feature: "ply",
        read: loader!("ply", crate::ply::cloud::read),
    },
    Format {
        extension: "xyz",
        name: "XYZ",
        feature: "xyz",
        read: loader!("xyz", crate::xyz::read),
    },
];

/// What to do with coordinates that are not finite.
fn remedy(format: &str) -> &'static str {
    match format {
        "PLY" => "remove them, for example with Open3D's `remove_non_finite_points`",
        "XYZ" => "remove them, for example with `grep -viE 'nan|inf'`",
        _ => {
            "its header's scale or offset is damaged, write it again, for example with `pdal translate`"
        }
    }
}

/// Loads a cloud by its file's extension, in any case: `.laz`, `.las`, `.ply` or `.xyz`.
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
/// When the file is missing, unreadable or of unknown extension, is cut off or corrupt, holds no
/// point, more than `u32::MAX` points, or a point that is not finite.
///
/// # Examples
///
/// ```no_run
/// # use raydsl_io::cloud::load;
/// let cloud = load("scan.laz", &mut |done, total| println!("{done} of {total}"))?;
/// println!("{} points", cloud.positions.len());
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
pub fn load(
    path: impl AsRef<Path>,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<PointCloud, LoadError> {
    let path = path.as_ref();
    let (format, read) = format::of(path, &FORMATS)?;
    let cloud = read(Source::open(path, format.name)?, progress)?;
    if cloud.positions.is_empty() {
        return Err(LoadError::Empty { path: path.into(), what: "point" });
    }
    let is_bad = |p: &&[f64; 3]| !p.iter().all(|c| c.is_finite());
    let Some(first) = cloud.positions.iter().position(|p| is_bad(&p)) else {
        return Ok(cloud);
    };
    Err(LoadError::NotFinite {
        path: path.into(),
        what: "point",
        count: cloud.positions[first..].iter().filter(is_bad).count(),
        total: cloud.positions.len(),
        first,
        remedy: remedy(format.name),
    })
}

/// An error if there are more points than indices of 32 bits.
pub(crate) fn check_count(path: &Path, count: u64) -> Result<(), LoadError> {
    let limit = u64::from(u32::MAX);
    if count <= limit {
        return Ok(());
    }
    Err(LoadError::TooMany { path: path.into(), what: "point", count, limit, remedy: THIN })
}

/// Room for as many points as a header claims, as far as the file's length makes them
/// credible; a claim is not trusted with more.
pub(crate) fn reserve(source: &Source, claim: u64, credible: u64) -> Result<PointCloud, LoadError> {
    check_count(&source.path, claim)?;
    let count = claim.min(credible) as usize;
    let mut cloud = PointCloud::default();
    let positions = cloud.positions.try_reserve_exact(count);
    positions.and_then(|()| cloud.colors.try_reserve_exact(count)).map_err(|_| {
        let path = source.path.clone();
        LoadError::OutOfMemory { path, what: "point", count: claim, remedy: THIN }
    })?;
    Ok(cloud)
}
