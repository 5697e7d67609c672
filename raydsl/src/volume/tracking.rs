//! Random estimates of what a ray meets: collisions and transmittance.

use super::exact::ExactCell;
use super::integrator::{Inside, inside, macro_walk, majorant_of};
use super::light::VolumeLight;
use super::march::extinction_at;
use super::volume::Volume;
use super::voxel::Voxel;
use crate::geometry::Ray;
use crate::kernel;
use crate::machine::generic::{clamp, max, min};
use crate::math::elementary::{cos, exp, log1p};
use crate::sampling::Rng;

/// Optical depth of the majorant in a macro-cell from which on its own depth is integrated: that is
/// quicker than so many tentative collisions, of which a wall behind clear air would need any
/// number.
const MOST_DEPTH: f32 = 256.0;

/// Returns an exponentially distributed depth.
#[kernel]
#[inline]
pub(super) fn free_depth(rng: &mut Rng) -> f32 {
    -log1p(-rng.next_f32())
}

/// Returns the optical depth between two distances of the ray.
#[kernel]
#[inline]
fn depth_between<T: Voxel>(volume: &Volume<'_, T>, ray: Ray, from: f32, to: f32) -> f32 {
    let exact = ExactCell::new().least(0.0);
    let light: VolumeLight = volume.integrate(&exact, ray.with_range(from, to), VolumeLight::new());
    light.depth
}

/// Returns the distance up to which the optical depth is `depth`, between two distances: by
/// bisection.
#[kernel]
#[inline(never)]
fn place_of_depth<T: Voxel>(
    volume: &Volume<'_, T>,
    ray: Ray,
    from: f32,
    to: f32,
    depth: f32,
) -> f32 {
    let (mut low, mut high) = (from, to);
    for _step in 0..24 {
        let middle = 0.5 * (low + high);
        if depth_between(volume, ray, from, middle) > depth {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// Returns the distance of a random collision on the ray between `t_min` and `t_max`, or nothing if
/// it passes: with the probability of its transmittance.
///
/// Delta tracking: tentative collisions are as frequent as the greatest extinction of each
/// macro-cell, and each is one with the probability of the extinction there over that. (Woodcock et
/// al., "Techniques Used in the GEM Code for Monte Carlo Neutronics Calculations", 1965; majorants
/// on a grid: Szirmay-Kalos, Tóth and Magdics, "Free Path Sampling in High Resolution Inhomogeneous
/// Participating Media", 2011.) Where that would take hundreds of them, as with a wall behind clear
/// air, the collision is where the integral of extinction says: regular tracking.
///
/// It reads values between voxels, so it is not for grids of labels.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::{Grid, GridConfig, TransferFunction, Volume, delta_tracking};
///
/// let grid = Grid::new(&[1.0f32; 8][..], uvec3(2, 2, 2), GridConfig::new())?;
/// let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 2.0)])?;
/// let fog = Volume::new(&grid, function);
/// let passes = kernel!(|seed: u32| {
///     let mut rng = Rng::new(uvec2(seed, 0), 0, 1);
///     let ray = Ray::new(vec3(0.5, 0.5, -1.0), Vec3::Z);
///     delta_tracking(&fog, ray, &mut rng).is_none()
/// });
/// let count = (0..10_000).filter(|seed| passes.call((*seed,))).count();
/// assert!((count as f32 / 1e4 - (-2.0f32).exp()).abs() < 0.02);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[kernel]
#[inline(never)]
pub fn delta_tracking<T: Voxel>(volume: &Volume<'_, T>, ray: Ray, rng: &mut Rng) -> Option<f32> {
    let part: Inside = inside(volume.grid(), ray);
    let (start, _) = volume.grid().span(ray);
    let (mut is_found, mut at) = (false, 0.0);
    let mut left = free_depth(&mut *rng);
    let mut walk = macro_walk(volume.grid(), part);
    while walk.is_inside && !is_found {
        let (enter, width) = (walk.enter, walk.leave - walk.enter);
        let most = majorant_of(volume, walk.cell) * part.scale;
        if most * width > MOST_DEPTH {
            let (from, to) = (start + enter, start + walk.leave);
            let depth = depth_between(volume, ray, from, to);
            is_found = depth > left;
            if is_found {
                at = place_of_depth(volume, ray, from, to, left) - start;
            }
            left = max(left - depth, 0.0);
        } else if most > 0.0 {
            // Distances from the border of the macro-cell: sums of small steps to great ones stall.
            let mut s = left / most;
            while s < width && !is_found {
                at = enter + s;
                is_found = rng.next_f32() * most < extinction_at(volume, part, at) * part.scale;
                s += free_depth(&mut *rng) / most;
            }
            left = max((s - width) * most, 0.0);
        }
        walk.advance();
    }
    if is_found { Some(start + at) } else { None }
}

/// Estimates the transmittance of the ray between `t_min` and `t_max`, without bias.
///
/// Ratio tracking: the product, over the tentative collisions of [`delta_tracking()`], of the share
/// that is none. (Novák, Selle and Jarosz, "Residual Ratio Tracking for Estimating Attenuation in
/// Participating Media", 2014, section 3.2.) Its cost and its variance grow with the optical depth
/// of the majorants.
#[kernel]
#[inline(never)]
pub fn ratio_transmittance<T: Voxel>(volume: &Volume<'_, T>, ray: Ray, rng: &mut Rng) -> f32 {
    let part: Inside = inside(volume.grid(), ray);
    let (start, _) = volume.grid().span(ray);
    let mut transmittance = 1.0;
    let mut left = free_depth(&mut *rng);
    let mut walk = macro_walk(volume.grid(), part);
    while walk.is_inside && transmittance > 0.0 {
        let (enter, width) = (walk.enter, walk.leave - walk.enter);
        let most = majorant_of(volume, walk.cell) * part.scale;
        if most * width > MOST_DEPTH {
            let depth = depth_between(volume, ray, start + enter, start + walk.leave);
            transmittance *= exp(-depth);
        } else if most > 0.0 {
            let mut s = left / most;
            while s < width && transmittance > 0.0 {
                let share = extinction_at(volume, part, enter + s) * part.scale / most;
                transmittance *= 1.0 - min(share, 1.0);
                s += free_depth(&mut *rng) / most;
            }
            left = max((s - width) * most, 0.0);
        }
        walk.advance();
    }
    transmittance
}

/// Estimates the transmittance of the ray between `t_min` and `t_max` from two estimates of its
/// optical depth, at a cost that is not random: little bias, little variance.
///
/// Each optical depth is a sum over steps of at most `step` in the world, with one sample at a
/// random place of each; of two, `exp(-(a + b) / 2) cos((a - b) / 2)` is the estimate without bias
/// and with the least variance if they are normally distributed, as such sums nearly are. (Peters,
/// "Jackknife Transmittance and MIS Weight Estimation", 2025; without its importance sampling.) It
/// may be negative where both differ by more than π.
#[kernel]
#[inline(never)]
pub fn jackknife_transmittance<T: Voxel>(
    volume: &Volume<'_, T>,
    ray: Ray,
    step: f32,
    rng: &mut Rng,
) -> f32 {
    let part: Inside = inside(volume.grid(), ray);
    let count = clamp((part.end * part.scale / step).ceil(), 1.0, 16_777_216.0);
    let width = part.end / count;
    let (mut a, mut b) = (0.0, 0.0);
    let mut i = 0u32;
    let mut walk = macro_walk(volume.grid(), part);
    while walk.is_inside {
        if majorant_of(volume, walk.cell) > 0.0 {
            // All steps that touch the macro-cell, but those that the one before has had.
            i = max(i, (walk.enter / width) as u32);
            let end = min(walk.leave / width, count).ceil() as u32;
            let (mut first, mut second) = (0.0, 0.0);
            while i < end {
                let u = rng.next_2d();
                first += extinction_at(volume, part, (i as f32 + u.x) * width);
                second += extinction_at(volume, part, (i as f32 + u.y) * width);
                i += 1;
            }
            a += first;
            b += second;
        }
        walk.advance();
    }
    let per = 0.5 * (width * part.scale);
    exp(-((a + b) * per)) * cos(clamp((a - b) * per, -1e3, 1e3))
}
