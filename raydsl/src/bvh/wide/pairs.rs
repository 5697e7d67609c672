//! Pairs of a ray and a primitive whose box it enters, tested a register at a time.
//!
//! One ray against the eight primitives of a block would leave most lanes without work, where the
//! primitives [have boxes](super::blocks::has_boxes): a ray enters few of the boxes, and a test takes
//! long. So the pairs of all rays of a stream that are at blocks are collected, and each lane tests
//! one.

use super::blocks::{self, Row};
use super::counts::{self, Event};
use super::node::WIDTH;
use super::rays::{GROUP, RayWordsMut, lanes_mask, load, ray_at, ray_at_mut, row};
use super::step::{LeafIntersector, ids};
use crate::bvh::contract::{is_within, limit_behind, precedes};
use crate::bvh::packet_slabs::{and, min};
use crate::geometry::{Hit, HitOn, HitRecord, Primitive, RayOn};
use crate::machine::{B, Entered, F, Lanes, Packet, U, V3};

/// Room for pairs; a register is written at once.
pub(super) const ROOM: usize = 512 + GROUP;

/// Pairs that are still to be tested: scratch memory, reused by the next query.
#[derive(Debug)]
pub(super) struct Pairs {
    /// The places of the rays.
    places: [u32; ROOM],
    /// The block of each primitive and its slot there, as eight times the one plus the other.
    primitives: [u32; ROOM],
    count: usize,
}

impl Default for Pairs {
    fn default() -> Self {
        Self { places: [0; ROOM], primitives: [0; ROOM], count: 0 }
    }
}

impl Pairs {
    /// Returns whether there is no room for those of one more ray.
    #[inline(always)]
    pub(super) fn is_full(&self) -> bool {
        self.count > ROOM - GROUP
    }

    /// Adds the pairs of a ray and the primitives in some slots of a block.
    #[inline(always)]
    pub(super) fn add<E: Lanes>(&mut self, e: E, ray: u32, block: usize, slots: E::Mask) {
        let first = (WIDTH * block) as u32;
        let all = e.u32_from_fn(
            #[inline(always)]
            |i| first + i as u32,
        );
        e.u32_store(e.u32_compress(all, slots), &mut self.primitives[self.count..][..WIDTH]);
        self.places[self.count..][..WIDTH].fill(ray);
        self.count += e.bits(slots).count_ones() as usize;
    }

    /// Adds the pairs of a primitive and some rays of a register, which begins at the place `first`.
    #[inline(always)]
    pub(super) fn add_rays<R: Lanes>(&mut self, r: R, first: u32, primitive: u32, rays: R::Mask) {
        let all = r.u32_from_fn(
            #[inline(always)]
            |i| first + i as u32,
        );
        r.u32_store(r.u32_compress(all, rays), &mut self.places[self.count..][..R::N]);
        r.u32_store(r.u32(primitive), &mut self.primitives[self.count..][..R::N]);
        self.count += r.bits(rays).count_ones() as usize;
    }

    /// Tests pairs for the least hits as long as they fill registers, and keeps the rest; returns
    /// whether any ray has a nearer hit.
    #[inline(always)]
    pub(super) fn flush_full<R: Lanes, P: Primitive>(
        &mut self,
        r: R,
        intersector: &LeafIntersector<'_, P>,
        words: &mut [u32],
    ) -> bool {
        let (mut first, mut is_nearer) = (0, false);
        while self.count - first >= R::N {
            let range = first..first + R::N;
            let pairs = (&self.places[range.clone()], &self.primitives[range]);
            is_nearer |= test_register(r, intersector, words, pairs, true);
            first += R::N;
        }
        // The rest comes first the next time.
        if first > 0 {
            self.places.copy_within(first..self.count, 0);
            self.primitives.copy_within(first..self.count, 0);
            self.count -= first;
        }
        is_nearer
    }

    /// Tests all pairs and removes them. Keeps the least hit of each ray with `CLOSEST`, else whether
    /// there is any.
    #[inline(always)]
    pub(super) fn flush<const CLOSEST: bool, R: Lanes, P: Primitive>(
        &mut self,
        r: R,
        intersector: &LeafIntersector<'_, P>,
        words: &mut [u32],
    ) {
        let count = core::mem::take(&mut self.count);
        for first in (0..count).step_by(R::N) {
            let range = first..(first + R::N).min(count);
            let pairs = (&self.places[range.clone()], &self.primitives[range]);
            test_register(r, intersector, words, pairs, CLOSEST);
        }
    }
}

/// Tests up to a register of pairs, each in a lane, and keeps the least hit of each ray if
/// `is_closest`, else whether there is any; returns whether any ray has a nearer hit. A function of
/// its own, since every copy of `intersect` costs compile time.
#[inline(never)]
fn test_register<R: Lanes, P: Primitive>(
    r: R,
    intersector: &LeafIntersector<'_, P>,
    words: &mut [u32],
    pairs: (&[u32], &[u32]),
    is_closest: bool,
) -> bool {
    counts::some(Event::Pair, pairs.0.len() as u32);
    r.vectorize(
        #[inline(always)]
        || {
            let hit = intersect(r, intersector, words, pairs);
            let mut bits = r.bits(hit.is_hit.0);
            let mut is_nearer = false;
            while bits != 0 {
                let lane = bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let mut ray = ray_at_mut(words, pairs.0[lane]);
                if is_closest {
                    is_nearer |= keep_nearer::<R, P>(ray, &hit, lane);
                } else {
                    ray.set(row::FOUND, 1);
                }
            }
            is_nearer
        },
    )
}

/// Intersects pairs; returns the hits that are within the range of their ray and not beyond the
/// least one so far.
#[inline(always)]
fn intersect<R: Lanes, P: Primitive>(
    r: R,
    intersector: &LeafIntersector<'_, P>,
    words: &[u32],
    pairs: (&[u32], &[u32]),
) -> HitOn<Packet<Entered<R>>> {
    let m = &Packet::new(Entered::new(r));
    // Gather rays and primitives; lanes without a pair repeat the first one.
    let mut rays = [[0; GROUP]; row::RAY.end + 1];
    let mut members: [(&[Row], usize); GROUP] = [(&[], 0); GROUP];
    for lane in 0..R::N {
        let at = if lane < pairs.0.len() { lane } else { 0 };
        let (ray, primitive) = (ray_at(words, pairs.0[at]), pairs.1[at] as usize);
        for (row, gathered) in rays[row::RAY].iter_mut().enumerate() {
            gathered[lane] = ray.word(row);
        }
        rays[row::RAY.end][lane] = ray.word(row::T);
        members[lane] = (intersector.rows(primitive / WIDTH), primitive % WIDTH);
    }
    let ray = RayOn {
        origin: vector(r, &rays, row::ORIGIN),
        direction: vector(r, &rays, row::DIRECTION),
        t_min: F(load(r, &rays[row::T_MIN], 0)),
        t_max: F(load(r, &rays[row::T_MAX], 0)),
    };
    let prim = blocks::read::<_, P>(
        m,
        #[inline(always)]
        |word| {
            r.u32_from_fn(
                #[inline(always)]
                |lane| {
                    let (block, slot) = members[lane % GROUP];
                    block[word].0[slot % WIDTH]
                },
            )
        },
    );
    // Intersect, each lane its primitive.
    let active = r.mask_from_bits(u64::from(lanes_mask::<R>() >> (R::N - pairs.0.len())));
    let record = m.with_active(
        active,
        #[inline(always)]
        || P::intersect_among_on(m, intersector.kinds, prim, ray, intersector.shared),
    );
    let hit = P::Hit::hit_on(record);
    // In this order of operands a range with a NaN limit is empty.
    let t_max = F(min(r, ray.t_max.0, load(r, &rays[row::RAY.end], 0)));
    let hits = and(r, active, is_within::on(m, hit, RayOn { t_max, ..ray }).0);
    let prim_id = r.u32_from_fn(
        #[inline(always)]
        |lane| {
            let (block, slot) = members[lane % GROUP];
            intersector.part.first + ids(block)[slot % WIDTH]
        },
    );
    HitOn { is_hit: B(hits), prim_id: U(prim_id), ..hit }
}

#[inline(always)]
fn vector<R: Lanes>(r: R, rays: &[[u32; GROUP]], row: usize) -> V3<Packet<Entered<R>>> {
    V3 {
        x: F(load(r, &rays[row], 0)),
        y: F(load(r, &rays[row + 1], 0)),
        z: F(load(r, &rays[row + 2], 0)),
    }
}

/// Keeps a lane's hit if it precedes the one that its ray has; returns whether it does.
#[inline(always)]
fn keep_nearer<R: Lanes, P: Primitive>(
    mut ray: RayWordsMut<'_>,
    hit: &HitOn<Packet<Entered<R>>>,
    lane: usize,
) -> bool {
    let id = R::u32_lane(&hit.prim_id.0, lane);
    let of = |t, prim_id| Hit { is_hit: true, t, prim_id, ..Hit::miss() };
    let found = of(R::f32_lane(&hit.t.0, lane), id);
    let best = of(ray.as_ref().float(row::T), ray.as_ref().word(row::ID));
    let is_nearer = precedes(false, found, best);
    if is_nearer {
        ray.set_float(row::T, found.t);
        ray.set_float(row::U, R::f32_lane(&hit.u.0, lane));
        ray.set_float(row::V, R::f32_lane(&hit.v.0, lane));
        ray.set(row::ID, id);
        ray.set(row::FOUND, 1);
        ray.set(row::NEARER, 1);
        counts::one(Event::Nearer);
        let end = ray.as_ref().float(row::T_MAX);
        ray.set_float(row::LIMIT, limit_behind(found.t, P::SLACK, end));
    }
    is_nearer
}
