//! Slab tests of a ray packet, faster where all directions lie in one octant; see
//! [`super::contract`].

use super::Node;
use super::contract::{Padding, overlap, slabs};
use crate::geometry::RayOn;
use crate::machine::{F, Lanes, Packet, Type, V3, op};

#[inline(always)]
pub(super) fn min<L: Lanes>(l: L, a: L::F32, b: L::F32) -> L::F32 {
    l.f32_binary(op::Min, a, b)
}

#[inline(always)]
pub(super) fn max<L: Lanes>(l: L, a: L::F32, b: L::F32) -> L::F32 {
    l.f32_binary(op::Max, a, b)
}

#[inline(always)]
pub(super) fn and<L: Lanes>(l: L, a: L::Mask, b: L::Mask) -> L::Mask {
    l.mask_binary(op::And, a, b)
}

#[inline(always)]
pub(super) fn or<L: Lanes>(l: L, a: L::Mask, b: L::Mask) -> L::Mask {
    l.mask_binary(op::Or, a, b)
}

#[inline(always)]
pub(super) fn sub<L: Lanes>(l: L, a: L::F32, b: L::F32) -> L::F32 {
    l.f32_binary(op::Sub, a, b)
}

#[inline(always)]
pub(super) fn add<L: Lanes>(l: L, a: L::F32, b: L::F32) -> L::F32 {
    l.f32_binary(op::Add, a, b)
}

#[inline(always)]
pub(super) fn mul<L: Lanes>(l: L, a: L::F32, b: L::F32) -> L::F32 {
    l.f32_binary(op::Mul, a, b)
}

#[inline(always)]
pub(super) fn abs<L: Lanes>(l: L, a: L::F32) -> L::F32 {
    l.f32_unary(op::Abs, a)
}

/// Returns `a` without the lanes of `b`.
#[inline(always)]
pub(super) fn without<L: Lanes>(l: L, a: L::Mask, b: L::Mask) -> L::Mask {
    and(l, a, l.mask_not(b))
}

/// Indices of a node's bounds among its eight members.
const MIN: [usize; 3] = [0, 1, 2];
const MAX: [usize; 3] = [4, 5, 6];

/// Rays of a packet, prepared for box tests; see [`super::contract`].
pub(super) struct PacketSlabs<L: Lanes> {
    /// The origins that each axis' near and far plane are measured from.
    near_origin: [L::F32; 3],
    far_origin: [L::F32; 3],
    inverse: [L::F32; 3],
    t_min: L::F32,
    /// The indices of each axis' near and far plane among a node's members.
    near_bound: [usize; 3],
    far_bound: [usize; 3],
    /// Whether all directions lie in one octant, so that the near planes are the same for all.
    is_aligned: bool,
}

impl<L: Lanes> PacketSlabs<L> {
    #[inline(always)]
    pub(super) fn new(
        l: L,
        ray: &RayOn<Packet<L>>,
        active: L::Mask,
        root: &Node,
        padding: Padding,
    ) -> Self {
        let m = &Packet::new(l);
        let s = slabs::on(
            m,
            padding.origin != 0.0,
            *ray,
            Type::splat(m, root.min),
            Type::splat(m, root.max),
            F(l.f32(padding.slack)),
            F(l.f32(padding.origin)),
        );
        let (lower, upper, inverse) = (s.lower.array(), s.upper.array(), s.inverse.array());
        let active = l.bits(active);
        let (mut near_origin, mut far_origin) = (lower, upper);
        let (mut near_bound, mut far_bound) = (MIN, MAX);
        let mut is_aligned = true;
        for i in 0..3 {
            let negative = l.bits(l.f32_compare(op::Lt, inverse[i], l.f32(0.0))) & active;
            is_aligned &= negative == 0 || negative == active;
            if negative != 0 {
                (near_bound[i], far_bound[i]) = (MAX[i], MIN[i]);
            }
        }
        for i in 0..3 {
            if is_aligned && near_bound[i] != MIN[i] {
                (near_origin[i], far_origin[i]) = (upper[i], lower[i]);
            }
        }
        Self {
            near_origin,
            far_origin,
            inverse,
            t_min: ray.t_min.0,
            near_bound,
            far_bound,
            is_aligned,
        }
    }

    /// Returns the distance of each lane to the plane at `bound` of axis `i`.
    #[inline(always)]
    fn plane(&self, l: L, bound: f32, origin: L::F32, i: usize) -> L::F32 {
        mul(l, sub(l, l.f32(bound), origin), self.inverse[i])
    }

    /// Returns where each lane enters the box, and the mask of those that do so within `limit`.
    #[inline(always)]
    pub(super) fn enter(&self, l: L, node: &Node, limit: L::F32) -> (L::F32, L::Mask) {
        // Read in place: a copy would go through the stack.
        let bounds: &[f32; 8] = bytemuck::cast_ref(node);
        let (mut near, mut far) = (self.near_origin, self.far_origin);
        if self.is_aligned {
            for i in 0..3 {
                near[i] = self.plane(l, bounds[self.near_bound[i] % 8], near[i], i);
                far[i] = self.plane(l, bounds[self.far_bound[i] % 8], far[i], i);
            }
        } else {
            for i in 0..3 {
                let low = self.plane(l, bounds[MIN[i]], near[i], i);
                let high = self.plane(l, bounds[MAX[i]], far[i], i);
                (near[i], far[i]) = (min(l, low, high), max(l, low, high));
            }
        }
        let (near, far) = (V3::from_array(near), V3::from_array(far));
        let span = overlap::on(&Packet::new(l), near, far, F(self.t_min), F(limit));
        (span.x.0, l.f32_compare(op::Le, span.x.0, span.y.0))
    }
}
