//! The rays of a query: groups of sixteen in structure-of-arrays layout, so that packets are stored
//! and loaded as registers, and the components of one ray are broadcast from memory.

use crate::bvh::contract::{Padding, ULP, finite_inverse, is_finite};
use crate::bvh::packet_slabs::{abs, add, and, max, mul, sub};
use crate::geometry::{Aabb, Hit, Ray, RayOn};
use crate::machine::{F, Lanes, Machine, Packet, V3, fill, op};

/// Rays per group.
pub(super) const GROUP: usize = 16;

/// The rows of a group, one for each component of its rays.
pub(super) mod row {
    use core::ops::Range;

    pub(in super::super) const ORIGIN: usize = 0;
    pub(in super::super) const DIRECTION: usize = 3;
    pub(in super::super) const T_MIN: usize = 6;
    pub(in super::super) const T_MAX: usize = 7;
    /// A ray hits a plane at `plane * inverse + first` at the earliest, and `+ last` at the latest.
    pub(in super::super) const INVERSE: usize = 8;
    pub(in super::super) const FIRST: usize = 11;
    pub(in super::super) const LAST: usize = 14;
    /// 1 where the direction is negative along an axis, so that upper planes are hit first.
    pub(in super::super) const SIDE: usize = 17;
    /// The distance beyond which nodes are culled.
    pub(in super::super) const LIMIT: usize = 20;
    /// The least hit so far; without one, infinity and the last id, which every hit precedes.
    pub(in super::super) const T: usize = 21;
    pub(in super::super) const U: usize = 22;
    pub(in super::super) const V: usize = 23;
    pub(in super::super) const ID: usize = 24;
    /// Not 0 if there is a hit.
    pub(in super::super) const FOUND: usize = 25;
    /// The current child of a ray in a stream, and the bottom and the top of its stack.
    pub(in super::super) const AT: usize = 26;
    pub(in super::super) const BOTTOM: usize = 27;
    pub(in super::super) const TOP: usize = 28;
    /// Set to 1 where a pair of the ray held a nearer hit.
    pub(in super::super) const NEARER: usize = 29;
    pub(in super::super) const COUNT: usize = 30;

    /// The rows of the ray itself.
    pub(in super::super) const RAY: Range<usize> = ORIGIN..T_MAX + 1;
    /// The rows of the least hit so far, and of the limit that follows from it.
    pub(in super::super) const RESULT: Range<usize> = LIMIT..FOUND + 1;
}

/// One word of each ray of a group.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub(super) struct Row(pub(super) [u32; GROUP]);

/// Masks of the rays of a group by their state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ActiveMasks {
    /// Rays of the query.
    pub(super) queried: u32,
    /// Rays of `queried` that are still to be traced in the current tree.
    pub(super) active: u32,
    /// Rays of `queried` whose box tests may overflow; they fall back to the binary tree.
    pub(super) degenerate: u32,
    /// Rays of `queried` that form no packet; they fall back to the ray stream.
    pub(super) stream_fallback: u32,
    /// Rays whose direction is negative along each axis.
    pub(super) sides: [u32; 3],
}

/// All rows of sixteen rays.
pub(super) type Group = [Row; row::COUNT];

/// Groups of rays.
#[derive(Debug, Default)]
pub(super) struct Rays {
    groups: Vec<Group>,
    pub(super) masks: Vec<ActiveMasks>,
    /// The number of lanes in use, with gaps between packets of different widths.
    count: usize,
}

/// Words from one row to the next of a ray.
const STRIDE: usize = GROUP;

/// The words of a ray, of which row `row` is at `STRIDE * row`.
pub(super) type Words = [u32; STRIDE * (row::COUNT - 1) + 1];

/// Shared access to the words of one ray.
#[derive(Clone, Copy)]
pub(super) struct RayWords<'a>(&'a Words);

impl RayWords<'_> {
    #[inline(always)]
    pub(super) fn word(self, row: usize) -> u32 {
        self.0[STRIDE * row]
    }

    #[inline(always)]
    pub(super) fn float(self, row: usize) -> f32 {
        f32::from_bits(self.0[STRIDE * row])
    }

    /// Broadcasts the ray to all lanes.
    #[inline(always)]
    pub(super) fn ray_on<M: Machine>(self, m: &M) -> RayOn<M> {
        RayOn {
            origin: self.vector_on(m, row::ORIGIN),
            direction: self.vector_on(m, row::DIRECTION),
            t_min: F(m.f32(self.float(row::T_MIN))),
            t_max: F(m.f32(self.float(row::T_MAX))),
        }
    }

    #[inline(always)]
    fn vector_on<M: Machine>(self, m: &M, row: usize) -> V3<M> {
        V3 {
            x: F(m.f32(self.float(row))),
            y: F(m.f32(self.float(row + 1))),
            z: F(m.f32(self.float(row + 2))),
        }
    }

    /// Returns the least hit so far.
    pub(super) fn hit(self) -> Hit {
        if self.word(row::FOUND) == 0 {
            return Hit::miss();
        }
        let (u, v) = (self.float(row::U), self.float(row::V));
        let (t, prim_id) = (self.float(row::T), self.word(row::ID));
        Hit { is_hit: true, t, prim_id, inst_id: 0, u, v }
    }

    pub(super) fn ray(self) -> Ray {
        let vector = |row| glam::vec3(self.float(row), self.float(row + 1), self.float(row + 2));
        Ray {
            t_min: self.float(row::T_MIN),
            t_max: self.float(row::T_MAX),
            ..Ray::new(vector(row::ORIGIN), vector(row::DIRECTION))
        }
    }
}

/// Exclusive access to the words of one ray.
pub(super) struct RayWordsMut<'a>(&'a mut Words);

impl RayWordsMut<'_> {
    #[inline(always)]
    pub(super) fn as_ref(&self) -> RayWords<'_> {
        RayWords(self.0)
    }

    #[inline(always)]
    pub(super) fn set(&mut self, row: usize, word: u32) {
        self.0[STRIDE * row] = word;
    }

    pub(super) fn set_hit(&mut self, hit: Hit) {
        self.set(row::FOUND, hit.is_hit.into());
        self.set_float(row::T, hit.t);
        self.set_float(row::U, hit.u);
        self.set_float(row::V, hit.v);
        self.set(row::ID, hit.prim_id);
    }

    #[inline(always)]
    pub(super) fn set_float(&mut self, row: usize, value: f32) {
        self.set(row, value.to_bits());
    }
}

/// Returns the index of a ray's first word.
#[inline(always)]
pub(super) const fn place(ray: usize) -> u32 {
    (ray / GROUP * GROUP * row::COUNT + ray % GROUP) as u32
}

/// Returns the group and the lane of the ray at `place`.
const fn group_and_lane(place: u32) -> (usize, usize) {
    let words = GROUP * row::COUNT;
    (place as usize / words, place as usize % words)
}

impl Rays {
    /// Removes all rays.
    pub(super) fn clear(&mut self) {
        self.masks.clear();
        self.count = 0;
    }

    /// Adds lanes for packets of `width` rays, none of them queried; returns the index of the first
    /// ray. The rows are not initialised.
    pub(super) fn add(&mut self, width: usize, packets: usize) -> usize {
        let first = self.count.next_multiple_of(width.min(GROUP));
        self.count = first + width * packets;
        let groups = self.count.div_ceil(GROUP);
        if self.groups.len() < groups {
            self.groups.resize(groups, [Row([0; GROUP]); row::COUNT]);
        }
        self.masks.resize(groups, ActiveMasks::default());
        first
    }

    /// Replaces the rays with those of the host.
    pub(super) fn load(&mut self, rays: &[Ray]) {
        self.clear();
        self.add(1, rays.len());
        for (group, rays) in rays.chunks(GROUP).enumerate() {
            let rows = &mut self.groups[group];
            for (lane, ray) in rays.iter().enumerate() {
                let mut set = |row: usize, value: f32| rows[row].0[lane] = value.to_bits();
                for axis in 0..3 {
                    set(row::ORIGIN + axis, ray.origin[axis]);
                    set(row::DIRECTION + axis, ray.direction[axis]);
                }
                set(row::T_MIN, ray.t_min);
                set(row::T_MAX, ray.t_max);
                set(row::LIMIT, ray.t_max);
                set(row::T, f32::INFINITY);
                rows[row::U].0[lane] = 0;
                rows[row::V].0[lane] = 0;
                rows[row::ID].0[lane] = u32::MAX;
                rows[row::FOUND].0[lane] = 0;
                self.masks[group].queried |= u32::from(is_finite(*ray)) << lane;
            }
        }
    }

    /// Activates all queried rays except degenerate ones; returns their number.
    pub(super) fn activate_all(&mut self) -> u32 {
        let mut count = 0;
        for masks in &mut self.masks {
            masks.active = masks.queried & !masks.degenerate;
            count += masks.active.count_ones();
        }
        count
    }

    /// Replaces the rays with those at some places of `from`, including their hits so far with
    /// `CLOSEST`, else without any.
    pub(super) fn gather<const CLOSEST: bool>(&mut self, from: &Self, places: &[u32]) {
        self.clear();
        self.add(1, places.len());
        let words = bytemuck::cast_slice(from.groups.as_flattened());
        for (group, places) in places.chunks(GROUP).enumerate() {
            let rows = &mut self.groups[group];
            for (lane, &place) in places.iter().enumerate() {
                let ray = ray_at(words, place);
                for row in row::RAY {
                    rows[row].0[lane] = ray.word(row);
                }
                for row in if CLOSEST { row::RESULT } else { 0..0 } {
                    rows[row].0[lane] = ray.word(row);
                }
            }
            if !CLOSEST {
                rows[row::LIMIT] = rows[row::T_MAX];
                rows[row::T] = Row([f32::INFINITY.to_bits(); GROUP]);
                rows[row::FOUND] = Row([0; GROUP]);
            }
            self.masks[group].queried = (1 << places.len()) - 1;
        }
    }

    /// Copies results back to the places that the rays were gathered from, and marks degenerate
    /// rays there.
    pub(super) fn give_back<const CLOSEST: bool>(&self, to: &mut Self, places: &[u32]) {
        let groups = self.groups.iter().zip(&self.masks);
        for ((rows, masks), places) in groups.zip(places.chunks(GROUP)) {
            for (lane, &place) in places.iter().enumerate() {
                let mut ray = ray_at_mut(to.words(), place);
                for row in if CLOSEST { row::RESULT } else { row::FOUND..row::FOUND + 1 } {
                    ray.set(row, rows[row].0[lane]);
                }
            }
            for lane in lanes_of(masks.degenerate) {
                let (group, lane) = group_and_lane(places[lane]);
                to.masks[group].degenerate |= 1 << lane;
            }
        }
    }

    /// Removes the rays that have a hit from the query.
    pub(super) fn forget_found(&mut self) {
        for (masks, rows) in self.masks.iter_mut().zip(&self.groups) {
            for (lane, &found) in rows[row::FOUND].0.iter().enumerate() {
                masks.queried &= !(u32::from(found != 0) << lane);
            }
        }
    }

    /// Returns all words, indexed by [`place`].
    #[inline(always)]
    pub(super) fn words(&mut self) -> &mut [u32] {
        bytemuck::cast_slice_mut(self.groups.as_flattened_mut())
    }

    #[inline(always)]
    pub(super) fn group_mut(&mut self, group: usize) -> &mut Group {
        &mut self.groups[group]
    }

    #[inline(always)]
    pub(super) fn row(&self, group: usize, row: usize) -> &[u32; GROUP] {
        &self.groups[group][row].0
    }

    #[inline(always)]
    pub(super) fn row_mut(&mut self, group: usize, row: usize) -> &mut [u32; GROUP] {
        &mut self.groups[group][row].0
    }

    /// Prepares the box tests of the rays for the tree under `root`, as
    /// [`slabs`](crate::bvh::contract::slabs()) does, and activates the rays. A ray is degenerate,
    /// and not active, if its components are so large or so small that products may overflow.
    #[inline(always)]
    pub(super) fn prepare<L: Lanes>(&mut self, l: L, root: &Aabb, padding: Padding) {
        for group in 0..self.masks.len() {
            self.prepare_group(l, group, root, padding);
        }
    }

    #[inline(always)]
    fn prepare_group<L: Lanes>(&mut self, l: L, group: usize, root: &Aabb, padding: Padding) {
        let ActiveMasks { queried, degenerate, .. } = self.masks[group];
        let mut active = queried & !degenerate;
        for from in (0..GROUP).step_by(L::N) {
            if active >> from & lanes_mask::<L>() != 0 {
                let tame = self.prepare_lanes(l, group, from, root, padding);
                active &= !(!tame << from & lanes_mask::<L>() << from);
            }
        }
        let masks = &mut self.masks[group];
        masks.degenerate |= masks.queried & !active;
        masks.active = active;
    }

    /// Prepares one register of rays; returns the mask of those whose products cannot overflow.
    #[inline(always)]
    fn prepare_lanes<L: Lanes>(
        &mut self,
        l: L,
        group: usize,
        from: usize,
        root: &Aabb,
        padding: Padding,
    ) -> u32 {
        let rows = &mut self.groups[group];
        let origin: [L::F32; 3] = fill(
            #[inline(always)]
            |axis| load(l, &rows[row::ORIGIN + axis].0, from),
        );
        let direction: [L::F32; 3] = fill(
            #[inline(always)]
            |axis| load(l, &rows[row::DIRECTION + axis].0, from),
        );
        let (low, high) = (root.min.to_array(), root.max.to_array());
        // Compute the reach of the box tests, and from it the padding.
        let mut reach = l.f32(0.0);
        let mut largest = l.f32(0.0);
        for axis in 0..3 {
            reach = max(l, reach, abs(l, sub(l, l.f32(low[axis]), origin[axis])));
            reach = max(l, reach, abs(l, sub(l, l.f32(high[axis]), origin[axis])));
            largest = max(l, largest, abs(l, origin[axis]));
        }
        // More padding than slabs have: planes are multiplied before the origin is subtracted.
        let part = l.f32(padding.slack + 2.0 * ULP);
        let pad = add(l, mul(l, part, reach), mul(l, l.f32(padding.origin), largest));
        let pad = max(l, pad, l.f32(f32::MIN_POSITIVE));
        let direction = V3::from_array(direction);
        let inverse = finite_inverse::on(&Packet::new(l), direction).array();
        let span = l.f32(root.min.abs().max(root.max.abs()).max_element());
        // Store the slabs of each axis.
        let mut tame = l.mask(true);
        for axis in 0..3 {
            let o = origin[axis];
            let pad = add(l, pad, mul(l, abs(l, o), l.f32(4.0 * ULP)));
            let (i, size) = (inverse[axis], abs(l, inverse[axis]));
            let (shift, width) = (mul(l, o, i), mul(l, pad, size));
            let first = sub(l, l.f32(0.0), add(l, shift, width));
            let last = sub(l, width, shift);
            let side = l.u32_binary(op::Shr, l.f32_to_bits(i), l.u32(31));
            let is_down = l.bits(l.u32_compare(op::Ne, side, l.u32(0))) as u32;
            let sides = &mut self.masks[group].sides[axis];
            *sides = *sides & !(lanes_mask::<L>() << from) | is_down << from;
            l.u32_store(l.f32_to_bits(i), &mut rows[row::INVERSE + axis].0[from..]);
            l.u32_store(l.f32_to_bits(first), &mut rows[row::FIRST + axis].0[from..]);
            l.u32_store(l.f32_to_bits(last), &mut rows[row::LAST + axis].0[from..]);
            l.u32_store(side, &mut rows[row::SIDE + axis].0[from..]);
            let product = mul(l, size, add(l, abs(l, o), span));
            tame = and(l, tame, l.f32_compare(op::Lt, product, l.f32(HUGE)));
        }
        l.bits(tame) as u32
    }
}

/// Returns the words of the ray at `place`.
#[inline(always)]
pub(super) fn ray_at(words: &[u32], place: u32) -> RayWords<'_> {
    match words[place as usize..].first_chunk() {
        Some(words) => RayWords(words),
        None => unreachable!("a ray has a word in each row of its group"),
    }
}

/// Returns the words of the ray at `place` for writing.
#[inline(always)]
pub(super) fn ray_at_mut(words: &mut [u32], place: u32) -> RayWordsMut<'_> {
    match words[place as usize..].first_chunk_mut() {
        Some(words) => RayWordsMut(words),
        None => unreachable!("a ray has a word in each row of its group"),
    }
}

/// Products below 2^120 count as safe from overflow.
pub(super) const HUGE: f32 = 1.329_228e36;

/// Iterates over the lanes whose bits are set.
#[inline(always)]
pub(super) fn lanes_of(mut bits: u32) -> impl Iterator<Item = usize> {
    core::iter::from_fn(
        #[inline(always)]
        move || {
            let lane = bits.trailing_zeros() as usize;
            (bits != 0).then(|| {
                bits &= bits - 1;
                lane
            })
        },
    )
}

#[inline(always)]
pub(super) const fn lanes_mask<L: Lanes>() -> u32 {
    const { assert!(L::N <= GROUP) };
    ((1u64 << L::N) - 1) as u32
}

#[inline(always)]
pub(super) fn load<L: Lanes>(l: L, words: &[u32], from: usize) -> L::F32 {
    l.f32_from_bits(load_words(l, words, from))
}

#[inline(always)]
pub(super) fn load_words<L: Lanes>(l: L, words: &[u32], from: usize) -> L::U32 {
    let words = &words[from..from + L::N];
    l.u32_from_fn(
        #[inline(always)]
        |lane| words[lane],
    )
}
