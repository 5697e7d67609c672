//! Display transform: exposure, tone mapping and transfer function.

use glam::{Vec3, Vec4, vec3, vec4};

use super::Image;
use crate::kernel;
use crate::math::Unorm8;
use crate::texture::linear_to_srgb;

/// The brightest light that is distinguished: its square is still finite.
const BRIGHTEST: f32 = 1e9;

/// The mapping from unbounded light to a screen's range.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ToneMap {
    /// Clamps at 1.
    #[default]
    Clamp,
    /// Maps each channel by [`reinhard()`], with this white.
    Reinhard {
        /// The light that becomes 1; at least 1e-6.
        white: f32,
    },
    /// Maps each channel by [`filmic()`].
    Filmic,
}

/// The transfer function from light to picture values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transfer {
    /// Linear.
    Linear,
    /// The sRGB curve, as picture files and screens expect.
    #[default]
    Srgb,
}

/// A display transform from linear light to a picture of 8 bits: exposure, then tone map, then
/// transfer.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::render::{Display, ToneMap};
///
/// let light = Image::filled(2, 2, vec4(0.5, 1.0, 4.0, 1.0));
/// let shown = Display::new().exposure(-2.0).show(&light);
/// assert_eq!(shown.pixels()[0].map(|c| c.to_bits()), [99, 137, 255, 255]);
/// let shown = Display::new().tone_map(ToneMap::Filmic).show(&light);
/// assert!(shown.pixels()[0][2].to_bits() < 255);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Display {
    /// The exposure in stops: each doubles the light.
    pub exposure: f32,
    /// The tone mapping operator.
    pub tone_map: ToneMap,
    /// The transfer function.
    pub transfer: Transfer,
}

impl Display {
    /// Creates a transform with exposure 0, clamping, in sRGB.
    pub const fn new() -> Self {
        Self { exposure: 0.0, tone_map: ToneMap::Clamp, transfer: Transfer::Srgb }
    }

    /// Sets the exposure: doubles the light `stops` times; halves it where they are negative.
    #[must_use]
    pub const fn exposure(self, stops: f32) -> Self {
        Self { exposure: stops, ..self }
    }

    /// Sets the tone mapping operator.
    #[must_use]
    pub const fn tone_map(self, tone_map: ToneMap) -> Self {
        Self { tone_map, ..self }
    }

    /// Sets the transfer function.
    #[must_use]
    pub const fn transfer(self, transfer: Transfer) -> Self {
        Self { transfer, ..self }
    }

    /// Returns the colour on the screen, 0 to 1; alpha is only clamped. A NaN becomes magenta, to
    /// be noticed.
    pub fn color(&self, light: Vec4) -> Vec4 {
        if light.is_nan() {
            return vec4(1.0, 0.0, 1.0, 1.0);
        }
        let exposed = light.truncate() * self.exposure.exp2();
        let exposed = exposed.clamp(Vec3::ZERO, Vec3::splat(BRIGHTEST));
        let mapped = match self.tone_map {
            ToneMap::Clamp => exposed,
            // With a smaller white, its square would be 0.
            ToneMap::Reinhard { white } => reinhard(exposed, white.max(1e-6)),
            ToneMap::Filmic => filmic(exposed),
        };
        let shown = mapped.clamp(Vec3::ZERO, Vec3::ONE);
        let shown = match self.transfer {
            Transfer::Linear => shown,
            Transfer::Srgb => {
                vec3(linear_to_srgb(shown.x), linear_to_srgb(shown.y), linear_to_srgb(shown.z))
            }
        };
        shown.extend(light.w.clamp(0.0, 1.0))
    }

    /// Returns the picture with 8 bits per channel, rounded to nearest.
    pub fn show(&self, light: &Image<Vec4>) -> Image<[Unorm8; 4]> {
        light.map(|&p| self.color(p).to_array().map(Unorm8::new))
    }
}

/// Maps each channel by `x (1 + x / white^2) / (1 + x)`: `white` becomes 1. (Reinhard, Stark,
/// Shirley and Ferwerda, "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002,
/// equation 4.)
#[kernel]
#[inline]
pub fn reinhard(light: Vec3, white: f32) -> Vec3 {
    light * (light / (white * white) + 1.0) / (light + 1.0)
}

/// Maps each channel by a filmic curve, which compresses shadows and highlights. (Narkowicz, "ACES
/// Filmic Tone Mapping Curve", 2015: a fit of the reference of the Academy.) It is 1 and above from
/// about 7 on.
#[kernel]
#[inline]
pub fn filmic(light: Vec3) -> Vec3 {
    (light * (light * 2.51 + 0.03)) / (light * (light * 2.43 + 0.59) + 0.14)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tone_maps_grow_and_end_where_they_say() {
        let maps: [fn(Vec3) -> Vec3; 2] = [|light| reinhard(light, 4.0), filmic];
        for map in maps {
            assert_eq!(map(Vec3::ZERO), Vec3::ZERO);
            let shown: Vec<f32> = (0..1000).map(|i| map(Vec3::splat(i as f32 * 0.01)).x).collect();
            assert!(shown.windows(2).all(|w| w[0] <= w[1]));
        }
        assert!((reinhard(Vec3::splat(4.0), 4.0) - 1.0).abs().max_element() < 1e-6);
    }

    #[test]
    fn no_number_is_magenta_and_nothing_leaves_the_range() {
        let display = Display::new().tone_map(ToneMap::Filmic);
        let magenta = vec4(1.0, 0.0, 1.0, 1.0);
        assert_eq!(display.color(vec4(f32::NAN, 0.0, 0.0, 1.0)), magenta);
        for light in [-1.0, 0.0, 1e-30, 1.0, 1e18, f32::MAX, f32::INFINITY] {
            for map in [
                ToneMap::Clamp,
                ToneMap::Filmic,
                ToneMap::Reinhard { white: 2.0 },
                ToneMap::Reinhard { white: 0.0 },
            ] {
                let shown = display.tone_map(map).color(Vec4::splat(light));
                let range = Vec4::ZERO..=Vec4::ONE;
                assert!(
                    shown.cmpge(*range.start()).all() && shown.cmple(*range.end()).all(),
                    "{light} {map:?} {shown}"
                );
            }
        }
    }
}
