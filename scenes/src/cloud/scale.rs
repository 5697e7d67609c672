//! From the coordinates of a file to spheres in single precision.

use raydsl_io::cloud::PointCloud;
use rayon::prelude::*;

use super::ScaleError;
use super::spacing::spacing;

/// The radius over the spacing. On a square grid of step `d`, spheres close the surface
/// from `d / sqrt(2) = 0.71 d` on. Points strewn at random over a surface, with as large
/// a [`Scaled::spacing`], cover 90 % of it at 0.8 (their density is `3.67 / (pi d^2)`, a
/// share of `exp(-3.67 * 0.8^2)` stays bare); what is left shows the surface behind. More
/// would swell thin parts.
const CLOSED: f64 = 0.8;
/// The code of every radius that is chosen freely: the middle of 0 to 255, where a step is
/// below 1 % of the radius.
const CODE: u8 = 128;
/// Rounding a coordinate to f32 may move a centre by this part of the radius.
const TOLERANCE: f64 = 1.0 / 16.0;
/// Intersection in f32 loses details below about this part of the radius, as squares of
/// the radius are subtracted; a smaller cloud would be one ball.
const DETAIL: f64 = 1.0 / 1024.0;

/// Centres ready for 16-byte spheres. The radius of all is `radius_code / 255`, in scaled
/// units.
#[derive(Clone, Debug, PartialEq)]
pub struct Scaled {
    /// `(position - offset) * scale`.
    pub centers: Vec<[f32; 3]>,
    /// The radius as a normalised byte.
    pub radius_code: u8,
    /// Scaled units per unit of the file.
    pub scale: f64,
    /// The place in the file that became the origin: the middle of the bounding box.
    pub offset: [f64; 3],
    /// Typical distance of neighbouring points, in units of the file. 1 for a single place.
    pub spacing: f64,
}

impl Scaled {
    /// Returns the indices of the points to draw: of those at one centre the first.
    ///
    /// The others cannot be seen, but every ray at them would test them all: a file that says one
    /// place a million times would take a million tests a pixel.
    pub fn distinct(&self) -> Vec<usize> {
        // Adding 0 gives both zeros the same bits.
        let place = |i: usize| self.centers[i].map(|c| (c + 0.0).to_bits());
        let mut order: Vec<usize> = (0..self.centers.len()).collect();
        order.par_sort_unstable_by_key(|&i| (place(i), i));
        order.dedup_by_key(|i| place(*i));
        order.par_sort_unstable();
        order
    }
}

/// Brings a cloud to a scale at which the radius of its spheres is a normalised byte.
///
/// The radius, in units of the file, is the given one or 0.8 times the spacing, with which
/// scanned surfaces look closed. The scale makes its code 128. Subtracting the middle of
/// the box happens in f64, so that geographic coordinates keep their digits.
///
/// # Errors
///
/// When the cloud is empty or has a point that is not finite; when the radius is not
/// positive and finite; when centres in f32 would be off by more than a sixteenth of the
/// radius (the cloud spans more than 2^21 radii); or when the radius exceeds 1024 times
/// the cloud's extent.
///
/// # Examples
///
/// ```
/// # use raydsl_scenes::cloud::scale;
/// # use raydsl_io::cloud::PointCloud;
/// let positions = vec![[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
/// let cloud = PointCloud { positions, colors: vec![[255; 3]; 2] };
/// let scaled = scale(&cloud, Some(0.5))?;
/// assert_eq!(scaled.radius_code, 128);
/// assert_eq!(scaled.offset, [1.5, 0.0, 0.0]);
/// # Ok::<(), raydsl_scenes::cloud::ScaleError>(())
/// ```
pub fn scale(cloud: &PointCloud, radius: Option<f64>) -> Result<Scaled, ScaleError> {
    check(cloud, radius)?;
    let [low, high] = bounds(&cloud.positions);
    let extent = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    // Halving first keeps the sum from overflowing.
    let offset: [f64; 3] = std::array::from_fn(|i| 0.5 * low[i] + 0.5 * high[i]);
    // Beyond these, squares of distances leave the range of f64.
    if extent > 0.0 && !(1e-150..=1e150).contains(&extent) {
        return Err(ScaleError::BadExtent { extent });
    }
    let spacing = spacing(&cloud.positions).unwrap_or(1.0);
    let radius = radius.unwrap_or(CLOSED * spacing);
    check_radius(radius, extent)?;
    let scale = f64::from(CODE) / 255.0 / radius;
    if !scale.is_normal() {
        return Err(ScaleError::BadRadius { radius });
    }
    let center = |p: &[f64; 3]| std::array::from_fn(|i| ((p[i] - offset[i]) * scale) as f32);
    let centers = cloud.positions.par_iter().map(center).collect();
    Ok(Scaled { centers, radius_code: CODE, scale, offset, spacing })
}

fn check(cloud: &PointCloud, radius: Option<f64>) -> Result<(), ScaleError> {
    let (positions, colors) = (cloud.positions.len(), cloud.colors.len());
    if positions != colors {
        return Err(ScaleError::LengthMismatch { positions, colors });
    }
    if positions == 0 {
        return Err(ScaleError::Empty);
    }
    if let Some(radius) = radius.filter(|r| !(r.is_finite() && *r > 0.0)) {
        return Err(ScaleError::BadRadius { radius });
    }
    let is_bad = |p: &&[f64; 3]| !p.iter().all(|c| c.is_finite());
    let Some(first) = cloud.positions.iter().position(|p| is_bad(&p)) else { return Ok(()) };
    let count = cloud.positions[first..].iter().filter(is_bad).count();
    Err(ScaleError::NotFinite { count, total: positions, first })
}

/// The two limits do not depend on the scale: rounding to f32 is relative to the distance
/// from the origin, at most half the extent.
fn check_radius(radius: f64, extent: f64) -> Result<(), ScaleError> {
    let rounding = 0.5 * extent / f64::from(1 << f32::MANTISSA_DIGITS);
    let minimum = rounding / TOLERANCE;
    if radius < minimum {
        return Err(ScaleError::RadiusTooSmall { radius, extent, minimum });
    }
    let maximum = extent / DETAIL;
    if extent > 0.0 && radius > maximum {
        return Err(ScaleError::RadiusTooLarge { radius, extent, maximum });
    }
    Ok(())
}

/// Lowest and highest coordinates.
fn bounds(positions: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let empty = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    positions.iter().fold(empty, |[low, high], p| {
        [std::array::from_fn(|i| low[i].min(p[i])), std::array::from_fn(|i| high[i].max(p[i]))]
    })
}
