//! What volumes and cells share: a transfer function over the range of values, light, and cuts.

mod cuts;
mod histogram;

use raydsl::prelude::*;
use raydsl::volume::{ShadedCell, TransferFunction};

use crate::look::{Knot, Look};
pub(super) use cuts::Cuts;
pub(super) use histogram::{bounds_of, histogram};

/// What is behind a field.
pub(super) const BACKGROUND: Vec3 = vec3(0.015, 0.018, 0.026);

/// Values in a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    /// The least and the greatest value.
    pub(super) range: Vec2,
    pub(super) bounds: Aabb,
}

impl Field {
    /// Returns the transfer function of some knots. Opacities are those of a two-hundredth of the
    /// box's longest side.
    pub(super) fn transfer(&self, knots: &[Knot]) -> Result<TransferFunction, String> {
        let value = |k: &Knot| self.range.x + (self.range.y - self.range.x) * k.at;
        let colors: Vec<_> = knots.iter().map(|k| (value(k), k.color)).collect();
        let opacities: Vec<_> = knots.iter().map(|k| (value(k), k.opacity)).collect();
        let unit = self.bounds.size().max_element() / 200.0;
        TransferFunction::new(&colors, &opacities, unit).map_err(|e| e.to_string())
    }

    /// Returns the integrator that shades where values change as fast as at an edge of this width.
    pub(super) fn shaded(&self, look: &Look, edge: f32) -> ShadedCell {
        let slope = (self.range.y - self.range.x) / edge * 0.08;
        ShadedCell::new(to_light(look.pose.up), slope.max(1e-30))
    }
}

/// Direction to the light, fixed in the world: a kernel that follows the camera would be another
/// one for each picture.
fn to_light(up: Vec3) -> Vec3 {
    (up + vec3(0.4, 0.7, 0.3)).normalize_or(up)
}
