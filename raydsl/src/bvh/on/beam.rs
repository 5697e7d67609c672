//! Box test for a ray with rounding bounds.

use crate::bvh::{Node, Padding};
use crate::geometry::RayOn;
use crate::machine::F;
use crate::machine::margin::{Interval, Margin};

/// Ray widened by its rounding bounds.
pub(super) struct Beam {
    /// Range of origins, moved apart by the padding.
    origin: [Interval; 3],
    direction: [f64; 3],
    t_min: f64,
}

impl Beam {
    /// Creates the beam of `ray`, for boxes widened by this padding.
    pub(super) fn new(m: &Margin, ray: RayOn<Margin>, root: &Node, padding: Padding) -> Self {
        let range = |c: F<Margin>| m.get(c.0).range;
        let origin = [ray.origin.x, ray.origin.y, ray.origin.z].map(range);
        let direction = [ray.direction.x, ray.direction.y, ray.direction.z].map(range);
        let (low, high) = (root.min.to_array().map(f64::from), root.max.to_array().map(f64::from));
        let mut reach = 0f64;
        for axis in 0..3 {
            let (near, far) = (low[axis] - origin[axis].high, high[axis] - origin[axis].low);
            reach = reach.max(near.abs()).max(far.abs());
        }
        // Distance by which the ray may lie aside at the far end of the scene.
        let width = direction.iter().map(|d| d.high - d.low).fold(0.0, f64::max);
        let length = direction.iter().map(|d| d.abs().low).fold(0.0, f64::max);
        let aside = width * 2.0 * reach / length;
        let slack = f64::from(padding.slack);
        let farthest = origin.iter().map(|o| o.abs().high).fold(0.0, f64::max);
        let aside = aside + 2.0 * farthest * f64::from(padding.origin);
        let ulp = f64::from(f32::EPSILON);
        let widest = origin.map(|o| {
            let pad = 2.0 * slack * reach + o.abs().high * 2.0 * ulp + aside;
            // Without a direction, or with an unknown one, the beam hits everything.
            let pad = if pad.is_nan() { f64::INFINITY } else { pad };
            Interval::new(o.low - pad, o.high + pad, false)
        });
        let middle = direction.map(|d| 0.5 * (d.low + d.high));
        Self { origin: widest, direction: middle, t_min: range(ray.t_min).low }
    }

    /// Returns the distances at which the beam enters and leaves a box.
    fn slab(&self, node: &Node) -> (f64, f64) {
        let (low, high) = (node.min.to_array().map(f64::from), node.max.to_array().map(f64::from));
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (o, d) = (self.origin[axis], self.direction[axis]);
            let (first, last) = (low[axis] - o.high, high[axis] - o.low);
            // Across the axis, within the padding, or without a limit: the axis does not constrain.
            if d == 0.0 || !(first / d).is_finite() || !(last / d).is_finite() {
                if first > 0.0 || last < 0.0 {
                    return (f64::INFINITY, f64::NEG_INFINITY);
                }
                continue;
            }
            near = near.max((first / d).min(last / d));
            far = far.min((first / d).max(last / d));
        }
        (near, far)
    }

    /// Returns the distance at which the beam enters a box.
    pub(super) fn enters(&self, node: &Node) -> f64 {
        self.slab(node).0
    }

    /// Returns whether the beam hits a box at or before `limit`.
    pub(super) fn meets(&self, node: &Node, limit: f64) -> bool {
        let (near, far) = self.slab(node);
        // Written so that a NaN means a visit.
        !(near > far || far < self.t_min || near > limit)
    }
}
