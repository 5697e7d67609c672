//! The robust slab test, for one ray.
//!
//! A box test must never lose a hit that `intersect` accepts. The ray's origin is moved apart by
//! an allowance, once a ray: lower faces are measured from the upper origin and the other way
//! round, which widens every box by `SLACK` times the distance to the farthest corner of the
//! scene and absorbs all rounding, at no cost in the loop. A direction component that is 0, or
//! 2^60 times smaller than the largest, is replaced by one of that size: its reciprocal is finite,
//! so no product is NaN, and the widened slab decides alone. (After Ize, "Robust BVH Ray
//! Traversal", JCGT 2013.)

use glam::Vec3;

use super::Node;
use crate::geometry::{Primitive, Ray};

/// By how much boxes are widened, so that they hold what rounding makes of the primitives in them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowance {
    /// Relative to the distance from the ray's origin to the farthest corner of the scene: see
    /// [`Primitive::SLACK`].
    pub(crate) slack: f32,
    /// Relative to the coordinates of the ray's origin.
    pub(crate) origin: f32,
}

impl Allowance {
    /// That of a tree over these primitives.
    #[inline(always)]
    pub(crate) const fn of<P: Primitive>() -> Self {
        Self { slack: P::SLACK, origin: 0.0 }
    }
}

/// A ray, prepared for box tests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slabs {
    lower: Vec3,
    upper: Vec3,
    inverse: Vec3,
    t_min: f32,
}

/// 2^-23: an ulp of a number is at most this part of it.
pub(crate) const ULP: f32 = f32::EPSILON;

/// 2^-60.
pub(crate) const LEAST: f32 = 8.673_617_4e-19;

/// The reciprocal of every component, finite.
pub(super) fn finite_inverse(d: Vec3) -> Vec3 {
    let largest = d.abs().max_element();
    let least = (largest * LEAST).max(f32::MIN_POSITIVE);
    let safe = |x: f32| {
        if x.abs() < least { if x < 0.0 { -least } else { least } } else { x }
    };
    Vec3::new(1.0 / safe(d.x), 1.0 / safe(d.y), 1.0 / safe(d.z))
}

impl Slabs {
    /// Prepares `ray` for the tree under `root`.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray, root: &Node, allowance: Allowance) -> Self {
        let reach = (root.min - ray.origin).abs().max((root.max - ray.origin).abs());
        // Where the origin is large against the scene the allowance must still move it.
        let distant = ray.origin.abs();
        let pad = (allowance.slack * reach.max_element()).max(f32::MIN_POSITIVE)
            + distant.max_element() * allowance.origin;
        let pad = distant * ULP + pad;
        Self {
            lower: ray.origin + pad,
            upper: ray.origin - pad,
            inverse: finite_inverse(ray.direction),
            t_min: ray.t_min,
        }
    }

    /// Where the ray enters the node's box, if it does so at or before `limit`.
    #[inline(always)]
    pub(crate) fn enter(&self, node: &Node, limit: f32) -> Option<f32> {
        let less = |a: f32, b: f32| if a < b { a } else { b };
        let more = |a: f32, b: f32| if a > b { a } else { b };
        let t0 = (node.min - self.lower) * self.inverse;
        let t1 = (node.max - self.upper) * self.inverse;
        let near =
            more(more(less(t0.x, t1.x), less(t0.y, t1.y)), more(less(t0.z, t1.z), self.t_min));
        let far = less(less(more(t0.x, t1.x), more(t0.y, t1.y)), less(more(t0.z, t1.z), limit));
        (near <= far).then_some(near)
    }
}
