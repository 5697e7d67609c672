//! The robust slab test for the rays of a packet; see [`super::slabs`].

use super::Node;
use super::slabs::{Allowance, LEAST, ULP};
use crate::geometry::RayOn;
use crate::machine::{Lanes, Packet, fill, op};

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

/// `a` without the lanes of `b`.
#[inline(always)]
pub(super) fn without<L: Lanes>(l: L, a: L::Mask, b: L::Mask) -> L::Mask {
    and(l, a, l.mask_not(b))
}

/// Where a node's bounds are among its eight members.
const MIN: [usize; 3] = [0, 1, 2];
const MAX: [usize; 3] = [4, 5, 6];

/// Rays of a packet, prepared for box tests; see [`super::slabs`].
pub(super) struct PacketSlabs<L: Lanes> {
    /// From where each axis' first and second plane are measured.
    near_origin: [L::F32; 3],
    far_origin: [L::F32; 3],
    inverse: [L::F32; 3],
    t_min: L::F32,
    /// Where, among a node's members, each axis' first and second plane are.
    near_bound: [usize; 3],
    far_bound: [usize; 3],
    /// All rays go the same way along every axis, so that the same planes come first for all.
    is_aligned: bool,
}

impl<L: Lanes> PacketSlabs<L> {
    #[inline(always)]
    pub(super) fn new(
        l: L,
        ray: &RayOn<Packet<L>>,
        alive: L::Mask,
        root: &Node,
        allowance: Allowance,
    ) -> Self {
        let o = ray.origin.array();
        let pad = pad(l, o, root, allowance);
        let inverse = finite_inverse(l, ray.direction.array());
        let alive = l.bits(alive);
        let (mut near_origin, mut far_origin) = (o, o);
        let (mut near_bound, mut far_bound) = (MIN, MAX);
        let mut is_aligned = true;
        for i in 0..3 {
            let negative = l.bits(l.f32_compare(op::Lt, inverse[i], l.f32(0.0))) & alive;
            is_aligned &= negative == 0 || negative == alive;
            if negative != 0 {
                (near_bound[i], far_bound[i]) = (MAX[i], MIN[i]);
            }
        }
        for i in 0..3 {
            let pad = add(l, pad, mul(l, abs(l, o[i]), l.f32(ULP)));
            let (lower, upper) = (add(l, o[i], pad), sub(l, o[i], pad));
            let is_reversed = is_aligned && near_bound[i] != MIN[i];
            (near_origin[i], far_origin[i]) =
                if is_reversed { (upper, lower) } else { (lower, upper) };
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

    /// When each lane meets the plane at `bound` of axis `i`.
    #[inline(always)]
    fn plane(&self, l: L, bound: f32, origin: L::F32, i: usize) -> L::F32 {
        mul(l, sub(l, l.f32(bound), origin), self.inverse[i])
    }

    /// Where each lane enters the box, and which do so at or before `limit`.
    #[inline(always)]
    pub(super) fn enter(&self, l: L, node: &Node, limit: L::F32) -> (L::F32, L::Mask) {
        // Read where it lies: a copy would go through the stack.
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
        let near = max(l, max(l, near[0], near[1]), max(l, near[2], self.t_min));
        let far = min(l, min(l, far[0], far[1]), min(l, far[2], limit));
        (near, l.f32_compare(op::Le, near, far))
    }
}

/// By how much every box is widened for each lane.
#[inline(always)]
fn pad<L: Lanes>(l: L, origin: [L::F32; 3], root: &Node, allowance: Allowance) -> L::F32 {
    let (low, high) = (root.min.to_array(), root.max.to_array());
    let mut farthest = l.f32(0.0);
    for i in 0..3 {
        farthest = max(l, farthest, abs(l, sub(l, l.f32(low[i]), origin[i])));
        farthest = max(l, farthest, abs(l, sub(l, l.f32(high[i]), origin[i])));
    }
    let pad = max(l, mul(l, l.f32(allowance.slack), farthest), l.f32(f32::MIN_POSITIVE));
    if allowance.origin == 0.0 {
        return pad;
    }
    let [x, y, z] = origin;
    let largest = max(l, max(l, abs(l, x), abs(l, y)), abs(l, z));
    add(l, pad, mul(l, largest, l.f32(allowance.origin)))
}

/// The reciprocal of every component, finite.
#[inline(always)]
pub(super) fn finite_inverse<L: Lanes>(l: L, d: [L::F32; 3]) -> [L::F32; 3] {
    let largest = max(l, max(l, abs(l, d[0]), abs(l, d[1])), abs(l, d[2]));
    let least = max(l, mul(l, largest, l.f32(LEAST)), l.f32(f32::MIN_POSITIVE));
    fill(
        #[inline(always)]
        |i| {
            let negative = l.f32_compare(op::Lt, d[i], l.f32(0.0));
            let tiny = l.f32_select(negative, l.f32_unary(op::Neg, least), least);
            let small = l.f32_compare(op::Lt, abs(l, d[i]), least);
            l.f32_binary(op::Div, l.f32(1.0), l.f32_select(small, tiny, d[i]))
        },
    )
}

/// The rays whose every component is a finite number; the others miss.
#[inline(always)]
pub(super) fn finite<L: Lanes>(l: L, ray: &RayOn<Packet<L>>) -> L::Mask {
    let (o, d) = (ray.origin, ray.direction);
    let mut all = l.mask(true);
    for c in [o.x, o.y, o.z, d.x, d.y, d.z] {
        all = and(l, all, l.f32_compare(op::Le, abs(l, c.0), l.f32(f32::MAX)));
    }
    all
}
