//! Two eyes.

use super::basis::Basis;
use super::{Camera, Pinhole, PinholeRays};

/// Two cameras, one for each eye, that look the same way.
///
/// Their films are moved against each other instead of turned towards each other, which would make
/// the two pictures differ in height too (off-axis projection; Bourke, "Calculating Stereo Pairs",
/// 1999). What is `zero_parallax` away is in the same place in both: it appears on the screen, what
/// is nearer in front of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stereo {
    /// The camera between the eyes.
    pub pinhole: Pinhole,
    /// How far apart the eyes are, in units of the scene.
    pub eye_separation: f32,
    /// How far away what both see in the same place is, along the view. Infinity is allowed; what
    /// is not positive counts as infinity.
    pub zero_parallax: f32,
}

impl Stereo {
    /// Two eyes beside a pinhole camera.
    pub const fn new(pinhole: Pinhole, eye_separation: f32, zero_parallax: f32) -> Self {
        Self { pinhole, eye_separation, zero_parallax }
    }

    /// The left eye.
    pub const fn left(&self) -> Eye {
        self.eye(-0.5 * self.eye_separation)
    }

    /// The right eye.
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
    /// The camera between the eyes.
    pub pinhole: Pinhole,
    /// How far to the right this eye is.
    pub aside: f32,
    /// The distance without parallax.
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
