//! Phase functions: where a medium scatters light to.

use core::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3, vec3};

use crate::kernel;
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max};
use crate::math::elementary::sincos_2pi;
use crate::sampling::Frame;

/// Greatest anisotropy, forwards or backwards: beyond it the lobe is narrower than a cosine in `f32`
/// resolves.
const MOST_ANISOTROPY: f32 = 0.99;

/// Returns the phase function of Henyey and Greenstein: the density per solid angle of light that goes
/// on at an angle of this cosine to its way before. `anisotropy` is the mean of that cosine: 0 for all
/// directions alike, positive forwards, negative backwards; beyond 0.99 it is taken as 0.99.
///
/// Henyey and Greenstein, "Diffuse Radiation in the Galaxy" (1941).
#[kernel]
#[inline]
pub fn henyey_greenstein(cos: f32, anisotropy: f32) -> f32 {
    let g = clamp(anisotropy, -MOST_ANISOTROPY, MOST_ANISOTROPY);
    // 1 + g^2 - 2 g cos, without a difference of numbers next to each other.
    let forwards = if g < 0.0 { -cos } else { cos };
    let narrow = 1.0 - g.abs();
    let squared = narrow * narrow + 2.0 * g.abs() * max(1.0 - forwards, 0.0);
    (0.25 * FRAC_1_PI) * (1.0 - g) * (1.0 + g) / (squared * squared.sqrt())
}

/// Samples a direction of [`henyey_greenstein()`] for light that came along `ahead`, of unit length.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::sample_henyey_greenstein;
///
/// // The mean of the cosine is the anisotropy.
/// let at = |i| vec2((i as f32 + 0.5) / 1000.0, 0.3);
/// let cosines = (0..1000).map(|i| sample_henyey_greenstein(Vec3::Z, at(i), 0.7).z);
/// assert!((cosines.sum::<f32>() / 1000.0 - 0.7).abs() < 1e-4);
/// ```
#[kernel]
#[inline]
pub fn sample_henyey_greenstein(ahead: Vec3, u: Vec2, anisotropy: f32) -> Vec3 {
    let g = clamp(anisotropy, -MOST_ANISOTROPY, MOST_ANISOTROPY);
    let (low, high) = (2.0 * u.x, 2.0 * (1.0 - u.x));
    // The inverse of the distribution, as what the cosine lacks to 1 and to -1: nothing cancels, and
    // nothing is divided by `g`.
    let stretch = (1.0 - g) + g * low;
    let squared = stretch * stretch;
    let to_front = (1.0 - g) * (1.0 - g) * high * (1.0 + 0.5 * g * low) / squared;
    let to_back = (1.0 + g) * (1.0 + g) * low * (1.0 - 0.5 * g * high) / squared;
    let sine = max(to_front * to_back, 0.0).sqrt();
    let around = sincos_2pi(u.y);
    let local = vec3(sine * around.cos, sine * around.sin, 0.5 * (to_back - to_front));
    Frame::around(ahead).to_world(local)
}
