//! What points at the menu.

use std::fmt;

use raydsl::prelude::*;

/// What points at the menu: a ray in either case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wand {
    /// A hand beside the camera, which points at what is seen in a place of the picture, in pixels
    /// from the lower left: a mouse.
    Pixel(Vec2),
    /// A tracked device: its frame in the world, whose z axis points at whoever holds it.
    Tracked(Mat4),
}

impl Wand {
    /// Returns the wand, if it points anywhere.
    pub(crate) fn checked(self) -> Result<Self, String> {
        let is_right = match self {
            Self::Pixel(at) => at.is_finite(),
            Self::Tracked(pose) => {
                let affine = pose.row(3) == Vec4::W;
                affine && pose.is_finite() && pose.z_axis.truncate().length() > 1e-12
            }
        };
        if is_right {
            return Ok(self);
        }
        Err("a tracked wand has 16 numbers, column by column, the last of each 0 0 0 1, and a z axis"
            .to_owned())
    }
}

impl fmt::Display for Wand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pixel(at) => write!(f, "pixel {} {}", at.x, at.y),
            Self::Tracked(pose) => {
                f.write_str("matrix")?;
                pose.to_cols_array().iter().try_for_each(|number| write!(f, " {number}"))
            }
        }
    }
}
