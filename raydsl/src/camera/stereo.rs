//! Stereo cameras.

use super::basis::Basis;
use super::{Camera, Pinhole, PinholeRays};

/// Pair of cameras, one for each eye, with parallel views.
///
/// Their films are shifted against each other (off-axis projection; Bourke, "Calculating Stereo
/// Pairs", 1999): turning them towards each other would make the two images differ in height too.
/// Objects `zero_parallax` away are in the same place in both: they appear on the screen, nearer
/// ones in front of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stereo {
    /// Camera between the eyes.
    pub pinhole: Pinhole,
    /// Distance between the eyes, in units of the scene.
    pub eye_separation: f32,
    /// Distance along the view at which both eyes see a point in the same place. Infinity is
    /// allowed; values that are not positive count as infinity.
    pub zero_parallax: f32,
}

impl Stereo {
    /// Creates the two eyes beside a pinhole camera.
    pub const fn new(pinhole: Pinhole, eye_separation: f32, zero_parallax: f32) -> Self {
        Self { pinhole, eye_separation, zero_parallax }
    }

    /// Returns the left eye.
    pub const fn left(&self) -> Eye {
        self.eye(-0.5 * self.eye_separation)
    }

    /// Returns the right eye.
    pub const fn right(&self) -> Eye {
        self.eye(0.5 * self.eye_separation)
    }

    const fn eye(&self, aside: f32) -> Eye {
        Eye { pinhole: self.pinhole, aside, zero_parallax: self.zero_parallax }
    }
}

/// One of the two cameras of a [`Stereo`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    /// Camera between the eyes.
    pub pinhole: Pinhole,
    /// Offset of this eye to the right.
    pub aside: f32,
    /// Distance without parallax.
    pub zero_parallax: f32,
}

impl Camera for Eye {
    type Rays = PinholeRays;

    fn begin_frame(&self, width: u32, height: u32) -> PinholeRays {
        let Basis { right, .. } = self.pinhole.basis();
        let rays = self.pinhole.begin_frame(width, height);
        let nearness = if self.zero_parallax > 0.0 { self.zero_parallax.recip() } else { 0.0 };
        PinholeRays {
            origin: rays.origin + right * self.aside,
            corner: rays.corner - right * (self.aside * nearness),
            ..rays
        }
    }
}
