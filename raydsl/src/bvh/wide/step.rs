//! One ray, eight boxes or eight primitives.

use super::Wide;
use super::blocks::{self, Row};
use super::node::{WIDTH, WideNode};
use super::rays::{RayWords, row};
use crate::bvh::Part;
use crate::bvh::contract::is_within;
use crate::bvh::packet_slabs::{max, min};
use crate::geometry::{HitOn, HitRecord, Kinds, Primitive, RayOn};
use crate::machine::{F, Lanes, Packet, Slice, op};

/// What meets boxes: a ray, or a beam of them.
pub(super) trait Slabs: Copy {
    /// 1 where upper planes come first.
    fn side(self, axis: usize) -> usize;
    /// The first plane is met at itself times the first number plus the second one.
    fn near(self, axis: usize) -> [f32; 2];
    /// The last plane.
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
        [self.number(row::INVERSE + axis), self.number(row::FIRST + axis)]
    }
    #[inline(always)]
    fn far(self, axis: usize) -> [f32; 2] {
        [self.number(row::INVERSE + axis), self.number(row::LAST + axis)]
    }
    #[inline(always)]
    fn t_min(self) -> f32 {
        self.number(row::T_MIN)
    }
    #[inline(always)]
    fn limit(self) -> f32 {
        self.number(row::LIMIT)
    }
}

/// Where a ray enters the children of a node, and which it does at or before its limit.
#[inline(always)]
pub(super) fn enter<E: Lanes>(e: E, node: &WideNode, ray: impl Slabs) -> (E::F32, E::Mask) {
    let [near_x, far_x] = slab(e, node, ray, 0);
    let [near_y, far_y] = slab(e, node, ray, 1);
    let [near_z, far_z] = slab(e, node, ray, 2);
    let (t_min, limit) = (e.f32(ray.t_min()), e.f32(ray.limit()));
    let near = max(e, max(e, near_x, near_y), max(e, near_z, t_min));
    let far = min(e, min(e, far_x, far_y), min(e, far_z, limit));
    (near, e.f32_compare(op::Le, near, far))
}

/// When a ray meets the first and the last plane of each child along an axis.
#[inline(always)]
fn slab<E: Lanes>(e: E, node: &WideNode, ray: impl Slabs, axis: usize) -> [E::F32; 2] {
    let side = ray.side(axis) & 1;
    let near = numbers(e, &node.planes[2 * axis + side]);
    let far = numbers(e, &node.planes[2 * axis + 1 - side]);
    let ([scale, first], [last_scale, last]) = (ray.near(axis), ray.far(axis));
    [
        e.f32_mul_add_fast(near, e.f32(scale), e.f32(first)),
        e.f32_mul_add_fast(far, e.f32(last_scale), e.f32(last)),
    ]
}

/// The slots of the children that a ray enters, the farthest first, below the bits of the distance
/// at which it does.
#[inline(always)]
pub(super) fn sorted<E: Lanes>(e: E, near: E::F32, mask: E::Mask) -> E::U32 {
    e.u32_sort_descending(e.u32_select(mask, keys(e, near), e.u32(0)))
}

/// The slot of the child that a ray enters first, if it enters any.
///
/// It is there before all of them are sorted, and the next node can be fetched meanwhile.
#[inline(always)]
pub(super) fn nearest<E: Lanes>(e: E, near: E::F32, mask: E::Mask) -> usize {
    e.u32_least(e.u32_select(mask, keys(e, near), e.u32(u32::MAX))) as usize % WIDTH
}

/// Slots below the bits of distances.
#[inline(always)]
fn keys<E: Lanes>(e: E, near: E::F32) -> E::U32 {
    // In this order a zero has no sign.
    let near = e.f32_binary(op::Max, e.f32(0.0), near);
    let near = e.u32_binary(op::And, e.f32_to_bits(near), e.u32(!7));
    let slots = e.u32_from_fn(
        #[inline(always)]
        |i| i as u32,
    );
    e.u32_binary(op::Or, near, slots)
}

/// What is compared with the bits of a distance, without the slot below them, at which a box is
/// entered: no box with more may hold a hit before `limit`.
#[inline(always)]
pub(super) fn last_key(limit: f32) -> u32 {
    // Below the first distance above zero no bits are larger.
    if limit > 0.0 { limit.to_bits() } else { 7 }
}

/// Eight numbers from memory.
#[inline(always)]
fn numbers<E: Lanes>(e: E, numbers: &[f32; WIDTH]) -> E::F32 {
    e.f32_from_fn(
        #[inline(always)]
        |i| numbers[i],
    )
}

/// Eight words from memory.
#[inline(always)]
pub(super) fn words<E: Lanes>(e: E, words: &[u32; WIDTH]) -> E::U32 {
    e.u32_from_fn(
        #[inline(always)]
        |i| words[i],
    )
}

/// What rays meet the primitives of a wide tree with.
pub(super) struct Meeting<'a, P: Primitive> {
    pub(super) tree: &'a Wide,
    pub(super) part: Part<'a, P, P::Shared>,
    pub(super) shared: Slice<'a, P::Shared>,
    pub(super) kinds: Kinds,
}

impl<P: Primitive> Meeting<'_, P> {
    /// The rows of a block.
    #[inline(always)]
    pub(super) fn rows(&self, index: usize) -> &[Row] {
        self.tree.blocks.block::<P>(index)
    }

    /// Where a ray meets the primitives of a block, and where that is within the ray's range and
    /// not beyond `best`.
    #[inline(always)]
    pub(super) fn block<E: Lanes>(
        &self,
        e: E,
        block: &[Row],
        ray: RayOn<Packet<E>>,
        best: f32,
    ) -> (HitOn<Packet<E>>, E::Mask) {
        let m = &Packet::new(e);
        let prim = blocks::read::<_, P>(
            m,
            #[inline(always)]
            |word| words(e, &block[word].0),
        );
        let record = P::intersect_among_on(m, self.kinds, prim, ray, self.shared);
        let hit = P::Hit::hit_on(record);
        // In this order a range without an end that is a number holds nothing.
        let t_max = F(min(e, ray.t_max.0, e.f32(best)));
        (hit, is_within::on(m, hit, RayOn { t_max, ..ray }).0)
    }
}

/// How many primitives a block has: what is left has its first one again.
#[inline(always)]
pub(super) fn count<E: Lanes>(e: E, block: &[Row]) -> usize {
    let ids = ids(block);
    let again = e.bits(e.u32_compare(op::Eq, words(e, ids), e.u32(ids[0])));
    // The first one is itself.
    ((again & !1) | 1 << WIDTH).trailing_zeros() as usize % (WIDTH + 1)
}

/// The numbers of a block's primitives.
#[inline(always)]
pub(super) fn ids(block: &[Row]) -> &[u32; WIDTH] {
    &block[block.len() - 1].0
}
