//! FLIP: the perceived difference of two pictures.

use glam::{Vec3, Vec4};
use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8};

use super::curve::quantile;
use super::reference::Reference;
use super::run::Estimates;
use raydsl::render::{Display, Image, ToneMap};

/// The light that [`filmic`](raydsl::render::filmic()) shows as 0.85. Exposures map the reference's
/// brightest pixel to it, and its median one.
const SHOULDER: f32 = 1.271_321;

/// The maximum number of pixels in a picture.
const MAX_PIXELS: u64 = 1 << 28;

/// The FLIP difference of two pictures that a viewer alternates between, from 0 (equal) to 1 at
/// each pixel. (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A
/// Difference Evaluator for Alternating Images", HPG 2020, by its authors' program.)
///
/// The viewer sees 67 pixels per degree, which is a 4K screen, 0.7 m wide, from 0.7 m away. Alpha
/// is ignored; NaN is shown as magenta.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl_report::work_precision::Flip;
///
/// let grey = |light| Image::filled(32, 32, vec4(light, light, light, 1.0));
/// let (near, far) = (Flip::ldr(&grey(0.5), &grey(0.45))?, Flip::ldr(&grey(0.5), &grey(0.2))?);
/// assert!(0.0 < near.mean && near.mean < far.mean && far.mean < 1.0);
/// # Ok::<(), raydsl_report::work_precision::FlipError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flip {
    /// The mean of all pixels.
    pub mean: f64,
    /// The median of all pixels.
    pub median: f64,
    /// The 95 % quantile of all pixels.
    pub p95: f64,
}

/// The reason why two pictures cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FlipError {
    /// Their sizes differ.
    #[error(
        "a picture of {} by {} pixels against a reference of {} by {}; render both in one size",
        picture.0, picture.1, reference.0, reference.1
    )]
    Sizes {
        /// Columns and rows of the reference.
        reference: (u32, u32),
        /// Columns and rows of the picture.
        picture: (u32, u32),
    },
    /// They have no pixels, or more than 2^28.
    #[error("pictures of {width} by {height} pixels; give at least 1 and at most 2^28 pixels")]
    Pixels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
}

impl Flip {
    /// Compares linear light as shown on a screen: clamped to 1, in sRGB of 8 bits.
    ///
    /// # Errors
    ///
    /// If the sizes differ, or there are no pixels, or more than 2^28.
    pub fn ldr(reference: &Image<Vec4>, picture: &Image<Vec4>) -> Result<Self, FlipError> {
        check(reference, picture)?;
        Ok(Self::of(&differences(Display::new(), reference, picture)))
    }

    /// Compares unbounded linear light: the largest difference of each pixel over exposures about a
    /// stop apart, each tone mapped by [`filmic`](raydsl::render::filmic()). The first exposes for
    /// the reference's brightest pixel, the last for its median one. (Andersson, Nilsson, Shirley
    /// and Akenine-Möller, "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics
    /// 2021.)
    ///
    /// Pixels without light do not count in the median.
    ///
    /// # Errors
    ///
    /// If the sizes differ, or there are no pixels, or more than 2^28.
    pub fn hdr(reference: &Image<Vec4>, picture: &Image<Vec4>) -> Result<Self, FlipError> {
        check(reference, picture)?;
        let mut worst = vec![0.0f32; reference.pixels().len()];
        for stops in exposures(reference) {
            let display = Display::new().exposure(stops).tone_map(ToneMap::Filmic);
            let found = differences(display, reference, picture);
            worst.iter_mut().zip(found).for_each(|(worst, found)| *worst = worst.max(found));
        }
        Ok(Self::of(&worst))
    }

    fn of(differences: &[f32]) -> Self {
        let all = || differences.iter().map(|d| f64::from(*d));
        let mean = all().sum::<f64>() / differences.len() as f64;
        Self { mean, median: quantile(all(), 0.5), p95: quantile(all(), 0.95) }
    }
}

/// Returns the LDR and the HDR FLIP of estimates that are a picture; `None` if they are not, or
/// differ in number from its pixels.
pub(super) fn of_picture(estimates: &Estimates, reference: &Reference) -> Option<(Flip, Flip)> {
    let (width, height) = estimates.picture?;
    let is_whole = u64::from(width) * u64::from(height) == estimates.values.len() as u64;
    let grey = |of: &dyn Fn(usize) -> f64| {
        let light = |x, y| of(y as usize * width as usize + x as usize) as f32;
        Image::from_fn(width, height, |x, y| Vec3::splat(light(x, y)).extend(1.0))
    };
    let pictures = is_whole.then(|| (grey(&|i| reference.at(i).0), grey(&|i| estimates.values[i])));
    let (reference, picture) = pictures?;
    Flip::ldr(&reference, &picture).ok().zip(Flip::hdr(&reference, &picture).ok())
}

fn check(reference: &Image<Vec4>, picture: &Image<Vec4>) -> Result<(), FlipError> {
    let size = |image: &Image<Vec4>| (image.width(), image.height());
    let (width, height) = size(reference);
    if size(picture) != (width, height) {
        return Err(FlipError::Sizes { reference: (width, height), picture: size(picture) });
    }
    if !(1..=MAX_PIXELS).contains(&(u64::from(width) * u64::from(height))) {
        return Err(FlipError::Pixels { width, height });
    }
    Ok(())
}

/// Returns the difference of each pixel, as `display` shows it.
fn differences(display: Display, reference: &Image<Vec4>, picture: &Image<Vec4>) -> Vec<f32> {
    let shown = |image: &Image<Vec4>| {
        let pixels = display.show(image);
        let rows = pixels.rows().rev().flatten();
        let bytes: Vec<u8> = rows.flat_map(|p| [p[0], p[1], p[2]].map(|c| c.to_bits())).collect();
        FlipImageRgb8::with_data(image.width(), image.height(), &bytes)
    };
    nv_flip::flip(shown(reference), shown(picture), DEFAULT_PIXELS_PER_DEGREE).to_vec()
}

/// Returns exposures in stops, increasing, as many as in the authors' program: the range rounded
/// up, and at least two.
fn exposures(reference: &Image<Vec4>) -> impl Iterator<Item = f32> {
    let luminance = |p: &Vec4| p.truncate().dot(Vec3::new(0.2126, 0.7152, 0.0722));
    let lit = || reference.pixels().iter().map(luminance).filter(|l| *l > 0.0 && l.is_finite());
    // Without light, any exposure will do.
    let brightest = lit().fold(0.0, f32::max);
    let median = quantile(lit().map(f64::from), 0.5) as f32;
    let stops = |light: f32| if light > 0.0 { (SHOULDER / light).log2() } else { 0.0 };
    let (first, last) = (stops(brightest), stops(median));
    let count = ((last - first).ceil() as u32).max(2);
    (0..count).map(move |i| first + (last - first) * i as f32 / (count - 1) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use raydsl::render::filmic;

    fn grey(light: f32) -> Image<Vec4> {
        Image::filled(24, 16, Vec3::splat(light).extend(1.0))
    }

    /// Returns a smooth picture from 0 to `most`.
    fn ramp(most: f32) -> Image<Vec4> {
        let light = |x: u32, y: u32| most * (x + 24 * y) as f32 / 383.0;
        Image::from_fn(24, 16, |x, y| Vec3::splat(light(x, y)).extend(1.0))
    }

    fn both(a: &Image<Vec4>, b: &Image<Vec4>) -> [Flip; 2] {
        [Flip::ldr, Flip::hdr].map(|of| of(a, b).expect("two pictures of one size"))
    }

    #[test]
    fn equal_pictures_do_not_differ() {
        for picture in [grey(0.0), grey(0.5), grey(50.0), ramp(1.0), ramp(1e3)] {
            for found in both(&picture, &picture) {
                assert_eq!(found, Flip { mean: 0.0, median: 0.0, p95: 0.0 });
            }
        }
    }

    /// Tests the formulas of the paper: of distances to the power of 0.7, that of black and white
    /// is 100^0.7 = 25.12, and the largest, of green and blue, 41.28; the part above 0.4 of that
    /// maps to the last 0.05. Pictures without edges have no other difference.
    #[test]
    fn black_against_white_is_nearly_1() {
        let found = Flip::ldr(&grey(0.0), &grey(1.0)).expect("two pictures");
        let exact = 0.95 + 0.05 * (25.12 - 0.4 * 41.28) / (0.6 * 41.28);
        for number in [found.mean, found.median, found.p95] {
            assert!((number - exact).abs() < 1e-3, "{found:?}, not {exact}");
        }
    }

    #[test]
    fn what_is_farther_off_looks_more_different() {
        for (name, of) in [("LDR", Flip::ldr as fn(&_, &_) -> _), ("HDR", Flip::hdr)] {
            let means = [0.0f32, 0.02, 0.05, 0.1, 0.2, 0.4].map(|shift| {
                let off = ramp(0.6).map(|p| (p.truncate() + shift).extend(1.0));
                of(&ramp(0.6), &off).expect("two pictures").mean
            });
            assert!(means.windows(2).all(|m| m[0] < m[1]), "{name} {means:?}");
        }
    }

    /// Tests that a screen that clamps shows the same white for 10 and 20; a darker exposure does
    /// not.
    #[test]
    fn only_hdr_sees_what_is_clamped() {
        let [ldr, hdr] = both(&grey(10.0), &grey(20.0));
        assert_eq!(ldr.mean, 0.0);
        assert!(hdr.mean > 0.05, "{hdr:?}");
    }

    /// Tests that a white strip along a side looks different, and so do its neighbours, but not the
    /// rest.
    #[test]
    fn quantiles_are_of_pixels() {
        let strip = |end: u32| {
            let light = |x: u32| if x < end { 1.0 } else { 0.2 };
            Image::from_fn(96, 16, |x, _| Vec3::splat(light(x)).extend(1.0))
        };
        let found = Flip::ldr(&strip(0), &strip(8)).expect("two pictures");
        assert_eq!(found.median, 0.0);
        assert!(0.0 < found.mean && found.mean < found.p95, "{found:?}");
    }

    #[test]
    fn exposures_go_from_the_brightest_to_the_median() {
        assert!((filmic(Vec3::splat(SHOULDER)).x - 0.85).abs() < 1e-6);
        let all: Vec<f32> = exposures(&ramp(8.0)).collect();
        let (first, last) = ((SHOULDER / 8.0).log2(), (SHOULDER / 4.0).log2());
        assert_eq!(all.len(), 2);
        assert!((all[0] - first).abs() < 1e-6 && (all[1] - last).abs() < 0.01, "{all:?}");
        assert_eq!(exposures(&grey(0.0)).collect::<Vec<_>>(), [0.0, 0.0]);
        let mut lamp = grey(0.01);
        lamp.pixels_mut()[7] = Vec4::splat(100.0);
        let all: Vec<f32> = exposures(&lamp).collect();
        assert!(
            all.len() == 14 && all.windows(2).all(|s| (1.0..1.1).contains(&(s[1] - s[0]))),
            "{all:?}"
        );
    }

    #[test]
    fn sizes_that_differ_are_refused() {
        let (a, b) = (grey(0.5), Image::filled(16, 24, Vec4::ONE));
        let error = FlipError::Sizes { reference: (24, 16), picture: (16, 24) };
        assert_eq!((Flip::ldr(&a, &b), Flip::hdr(&a, &b)), (Err(error), Err(error)));
        let nothing = Image::filled(0, 5, Vec4::ONE);
        let error = FlipError::Pixels { width: 0, height: 5 };
        assert_eq!(Flip::ldr(&nothing, &nothing), Err(error));
    }
}
