//! Steps of a traversal: one ray against eight boxes or eight primitives.

use super::Wide;
use super::blocks::{self, Row, has_boxes};
use super::node::{Planes, WIDTH};
use super::rays::{RayWords, row};
use crate::bvh::Part;
use crate::bvh::contract::is_within;
use crate::bvh::packet_slabs::{and, max, min};
use crate::geometry::{HitOn, HitRecord, Kinds, Primitive, RayOn, SharedViews};
use crate::machine::{F, Lanes, Packet, Value, op};

/// The slabs of box tests: of a ray, or of a beam.
pub(super) trait Slabs: Copy {
    /// Returns 1 if upper planes are hit first, else 0.
    fn side(self, axis: usize) -> usize;
    /// Returns the scale and the offset that map the near plane to its distance.
    fn near(self, axis: usize) -> [f32; 2];
    /// Returns the scale and the offset that map the far plane to its distance.
    fn far(self, axis: usize) -> [f32; 2];
    fn t_min(self) -> f32;
    fn limit(self) -> f32;
}

impl Slabs for RayWords<'_> {
    #[inline(always)]
    fn side(self, axis: usize) -> usize {
        self.word(row::SIDE + axis) as usize
    }
    #[inline(always)]
    fn near(self, axis: usize) -> [f32; 2] {
        [self.float(row::INVERSE + axis), self.float(row::FIRST + axis)]
    }
    #[inline(always)]
    fn far(self, axis: usize) -> [f32; 2] {
        [self.float(row::INVERSE + axis), self.float(row::LAST + axis)]
    }
    #[inline(always)]
    fn t_min(self) -> f32 {
        self.float(row::T_MIN)
    }
    #[inline(always)]
    fn limit(self) -> f32 {
        self.float(row::LIMIT)
    }
}

/// Returns the entry distances of eight boxes, and the mask of those that are entered within the
/// limit.
#[inline(always)]
pub(super) fn enter<E: Lanes>(e: E, planes: &Planes, ray: impl Slabs) -> (E::F32, E::Mask) {
    let [near_x, far_x] = slab(e, planes, ray, 0);
    let [near_y, far_y] = slab(e, planes, ray, 1);
    let [near_z, far_z] = slab(e, planes, ray, 2);
    let (t_min, limit) = (e.f32(ray.t_min()), e.f32(ray.limit()));
    let near = max(e, max(e, near_x, near_y), max(e, near_z, t_min));
    let far = min(e, min(e, far_x, far_y), min(e, far_z, limit));
    (near, e.f32_compare(op::Le, near, far))
}

/// Returns the distances of the near and the far plane of each box along an axis.
#[inline(always)]
fn slab<E: Lanes>(e: E, planes: &Planes, ray: impl Slabs, axis: usize) -> [E::F32; 2] {
    let side = ray.side(axis) & 1;
    let near = floats(e, &planes[2 * axis + side]);
    let far = floats(e, &planes[2 * axis + 1 - side]);
    let ([scale, first], [last_scale, last]) = (ray.near(axis), ray.far(axis));
    [
        e.f32_mul_add_fast(near, e.f32(scale), e.f32(first)),
        e.f32_mul_add_fast(far, e.f32(last_scale), e.f32(last)),
    ]
}

/// Sorts the slots of the children that a ray enters, farthest first, each below the bits of its
/// entry distance.
#[inline(always)]
pub(super) fn sorted<E: Lanes>(e: E, near: E::F32, mask: E::Mask) -> E::U32 {
    e.u32_sort_descending(e.u32_select(mask, keys(e, near), e.u32(0)))
}

/// Returns the slot of the child that a ray enters first, if it enters any.
///
/// The result is ready before all children are sorted, so the next node is fetched meanwhile.
#[inline(always)]
pub(super) fn nearest<E: Lanes>(e: E, near: E::F32, mask: E::Mask) -> usize {
    e.u32_least(e.u32_select(mask, keys(e, near), e.u32(u32::MAX))) as usize % WIDTH
}

/// Returns the slots below the bits of their distances.
#[inline(always)]
fn keys<E: Lanes>(e: E, near: E::F32) -> E::U32 {
    // In this order of operands a zero has no sign.
    let near = e.f32_binary(op::Max, e.f32(0.0), near);
    let near = e.u32_binary(op::And, e.f32_to_bits(near), e.u32(!7));
    let slots = e.u32_from_fn(
        #[inline(always)]
        |i| i as u32,
    );
    e.u32_binary(op::Or, near, slots)
}

/// Returns the last key within `limit`: a box whose entry distance has more bits, without the slot
/// below them, is culled.
#[inline(always)]
pub(super) fn last_key(limit: f32) -> u32 {
    // All distances up to zero have the bits of zero.
    if limit > 0.0 { limit.to_bits() } else { 7 }
}

/// Loads eight floats.
#[inline(always)]
fn floats<E: Lanes>(e: E, floats: &[f32; WIDTH]) -> E::F32 {
    e.f32_from_fn(
        #[inline(always)]
        |i| floats[i],
    )
}

/// Loads eight words.
#[inline(always)]
pub(super) fn words<E: Lanes>(e: E, words: &[u32; WIDTH]) -> E::U32 {
    e.u32_from_fn(
        #[inline(always)]
        |i| words[i],
    )
}

/// Intersects rays with the primitives in the leaves of a wide tree.
pub(super) struct LeafIntersector<'a, P: Primitive> {
    pub(super) tree: &'a Wide,
    pub(super) part: Part<'a, P, P::Shared>,
    pub(super) shared: SharedViews<'a, P>,
    pub(super) kinds: Kinds,
}

impl<P: Primitive> LeafIntersector<'_, P> {
    /// Returns the rows of a block.
    #[inline(always)]
    pub(super) fn rows(&self, index: usize) -> &[Row] {
        self.tree.blocks.block::<P>(index)
    }

    /// Intersects a ray with the primitives of a block; returns the hits, and the mask of those
    /// that are within the ray's range and not beyond `best`. `slabs` are those of the ray.
    #[inline(always)]
    pub(super) fn intersect<E: Lanes>(
        &self,
        e: E,
        block: usize,
        (ray, slabs): (RayOn<Packet<E>>, impl Slabs),
        best: f32,
    ) -> (HitOn<Packet<E>>, E::Mask) {
        let m = &Packet::new(e);
        let entered = if const { has_boxes::<P>() } {
            let (_, entered) = enter(e, self.tree.blocks.boxes(block), slabs);
            if !e.any(entered) {
                return (HitOn::zero(m), entered);
            }
            Some(entered)
        } else {
            None
        };
        let block = self.rows(block);
        let prim = blocks::read::<_, P>(
            m,
            #[inline(always)]
            |word| words(e, &block[word].0),
        );
        let record = m.with_active(
            entered.unwrap_or_else(|| m.active()),
            #[inline(always)]
            || P::intersect_among_on(m, self.kinds, prim, ray, self.shared),
        );
        let hit = P::Hit::hit_on(record);
        // In this order of operands a range with a NaN limit is empty.
        let t_max = F(min(e, ray.t_max.0, e.f32(best)));
        let within = is_within::on(m, hit, RayOn { t_max, ..ray }).0;
        (hit, entered.map_or(within, |entered| and(e, within, entered)))
    }
}

/// Counts the primitives of a block, whose unused lanes repeat the first one.
#[inline(always)]
pub(super) fn count<E: Lanes>(e: E, block: &[Row]) -> usize {
    let ids = ids(block);
    let again = e.bits(e.u32_compare(op::Eq, words(e, ids), e.u32(ids[0])));
    // The first lane equals itself.
    ((again & !1) | 1 << WIDTH).trailing_zeros() as usize % (WIDTH + 1)
}

/// Returns the ids of a block's primitives.
#[inline(always)]
pub(super) fn ids(block: &[Row]) -> &[u32; WIDTH] {
    &block[block.len() - 1].0
}
