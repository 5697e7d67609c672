//! Rays on their way through a wide tree: sixteen of them to a group, each number side by side, so
//! that packets are written and read as they are and one ray's numbers are broadcast from memory.

use crate::bvh::contract::{Padding, ULP, finite_inverse, is_finite};
use crate::bvh::packet_slabs::{abs, add, and, max, mul, sub};
use crate::geometry::{Aabb, Hit, Ray, RayOn};
use crate::machine::{F, Lanes, Machine, Packet, V3, fill, op};

/// How many rays a group has.
pub(super) const GROUP: usize = 16;

/// The rows of a group: what there is a number of for each ray.
pub(super) mod row {
    use core::ops::Range;

    pub(in super::super) const ORIGIN: usize = 0;
    pub(in super::super) const DIRECTION: usize = 3;
    pub(in super::super) const T_MIN: usize = 6;
    pub(in super::super) const T_MAX: usize = 7;
    /// A ray meets a plane at `plane * inverse + first` at the earliest, and `+ last` at the
    /// latest.
    pub(in super::super) const INVERSE: usize = 8;
    pub(in super::super) const FIRST: usize = 11;
    pub(in super::super) const LAST: usize = 14;
    /// 1 where the ray goes down along an axis, so that it meets upper planes first.
    pub(in super::super) const SIDE: usize = 17;
    /// No node beyond this distance is worth a visit.
    pub(in super::super) const LIMIT: usize = 20;
    /// The least hit so far: infinity and the last number, which every hit beats, where there is
    /// none.
    pub(in super::super) const T: usize = 21;
    pub(in super::super) const U: usize = 22;
    pub(in super::super) const V: usize = 23;
    pub(in super::super) const ID: usize = 24;
    /// Not 0 if there is a hit.
    pub(in super::super) const FOUND: usize = 25;
    /// Where a ray is on its own, and the bottom and the top of its stack.
    pub(in super::super) const AT: usize = 26;
    pub(in super::super) const BOTTOM: usize = 27;
    pub(in super::super) const TOP: usize = 28;
    pub(in super::super) const COUNT: usize = 29;

    /// The ray itself.
    pub(in super::super) const RAY: Range<usize> = ORIGIN..T_MAX + 1;
    /// The least hit so far, and how far it lets a ray go.
    pub(in super::super) const RESULT: Range<usize> = LIMIT..FOUND + 1;
}

/// A word of each ray of a group.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub(super) struct Row(pub(super) [u32; GROUP]);

/// Which of a group's rays there are.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Marks {
    /// The rays that are asked about.
    pub(super) asked: u32,
    /// Those of them that are on their way through a tree.
    pub(super) alive: u32,
    /// Those of them that are too odd for box tests.
    pub(super) odd: u32,
    /// Those of them that go their own ways.
    pub(super) alone: u32,
    /// The rays that go down along each axis.
    pub(super) sides: [u32; 3],
}

/// A word of each kind of sixteen rays.
pub(super) type Group = [Row; row::COUNT];

/// Groups of rays.
#[derive(Debug, Default)]
pub(super) struct Rays {
    groups: Vec<Group>,
    pub(super) marks: Vec<Marks>,
    /// How many there are, with gaps between those of packets of different widths.
    count: usize,
}

/// From one row to the next of a ray.
const STRIDE: usize = GROUP;

/// The words of a ray: word `STRIDE * row` is that of a row.
pub(super) type Words = [u32; STRIDE * (row::COUNT - 1) + 1];

/// The words of one ray.
#[derive(Clone, Copy)]
pub(super) struct RayWords<'a>(&'a Words);

impl RayWords<'_> {
    #[inline(always)]
    pub(super) fn word(self, row: usize) -> u32 {
        self.0[STRIDE * row]
    }

    #[inline(always)]
    pub(super) fn number(self, row: usize) -> f32 {
        f32::from_bits(self.0[STRIDE * row])
    }

    /// The ray, the same in all lanes.
    #[inline(always)]
    pub(super) fn ray_on<M: Machine>(self, m: &M) -> RayOn<M> {
        RayOn {
            origin: self.vector_on(m, row::ORIGIN),
            direction: self.vector_on(m, row::DIRECTION),
            t_min: F(m.f32(self.number(row::T_MIN))),
            t_max: F(m.f32(self.number(row::T_MAX))),
        }
    }

    #[inline(always)]
    fn vector_on<M: Machine>(self, m: &M, row: usize) -> V3<M> {
        V3 {
            x: F(m.f32(self.number(row))),
            y: F(m.f32(self.number(row + 1))),
            z: F(m.f32(self.number(row + 2))),
        }
    }

    /// The least hit so far.
    pub(super) fn hit(self) -> Hit {
        if self.word(row::FOUND) == 0 {
            return Hit::miss();
        }
        let (u, v) = (self.number(row::U), self.number(row::V));
        let (t, prim_id) = (self.number(row::T), self.word(row::ID));
        Hit { is_hit: true, t, prim_id, inst_id: 0, u, v }
    }

    pub(super) fn ray(self) -> Ray {
        let vector = |row| glam::vec3(self.number(row), self.number(row + 1), self.number(row + 2));
        Ray {
            t_min: self.number(row::T_MIN),
            t_max: self.number(row::T_MAX),
            ..Ray::new(vector(row::ORIGIN), vector(row::DIRECTION))
        }
    }
}

/// The words of one ray, to be written.
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
        self.set_number(row::T, hit.t);
        self.set_number(row::U, hit.u);
        self.set_number(row::V, hit.v);
        self.set(row::ID, hit.prim_id);
    }

    #[inline(always)]
    pub(super) fn set_number(&mut self, row: usize, number: f32) {
        self.set(row, number.to_bits());
    }
}

/// Where a ray's words begin.
#[inline(always)]
pub(super) const fn place(ray: usize) -> u32 {
    (ray / GROUP * GROUP * row::COUNT + ray % GROUP) as u32
}

/// The group and the lane of the ray at `place`.
const fn group_and_lane(place: u32) -> (usize, usize) {
    let words = GROUP * row::COUNT;
    (place as usize / words, place as usize % words)
}

impl Rays {
    /// Has no rays.
    pub(super) fn clear(&mut self) {
        self.marks.clear();
        self.count = 0;
    }

    /// Room for so many packets of `width` rays more, none of which is asked about; returns the number of
    /// the first. What the rows hold is not said.
    pub(super) fn add(&mut self, width: usize, packets: usize) -> usize {
        let first = self.count.next_multiple_of(width.min(GROUP));
        self.count = first + width * packets;
        let groups = self.count.div_ceil(GROUP);
        if self.groups.len() < groups {
            self.groups.resize(groups, [Row([0; GROUP]); row::COUNT]);
        }
        self.marks.resize(groups, Marks::default());
        first
    }

    /// The rays of the host, one behind the other.
    pub(super) fn load(&mut self, rays: &[Ray]) {
        self.clear();
        self.add(1, rays.len());
        for (group, rays) in rays.chunks(GROUP).enumerate() {
            let rows = &mut self.groups[group];
            for (lane, ray) in rays.iter().enumerate() {
                let mut set = |row: usize, number: f32| rows[row].0[lane] = number.to_bits();
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
                self.marks[group].asked |= u32::from(is_finite(*ray)) << lane;
            }
        }
    }

    /// All that are asked about are on their way, but for the odd ones; how many.
    pub(super) fn all_alive(&mut self) -> u32 {
        let mut count = 0;
        for marks in &mut self.marks {
            marks.alive = marks.asked & !marks.odd;
            count += marks.alive.count_ones();
        }
        count
    }

    /// The rays at some places of others, one behind the other: with `CLOSEST` and what they have
    /// found so far, else as if that were nothing.
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
            self.marks[group].asked = (1 << places.len()) - 1;
        }
    }

    /// Tells others what the rays have found that were gathered from these places, and which are odd.
    pub(super) fn give_back<const CLOSEST: bool>(&self, to: &mut Self, places: &[u32]) {
        let groups = self.groups.iter().zip(&self.marks);
        for ((rows, marks), places) in groups.zip(places.chunks(GROUP)) {
            for (lane, &place) in places.iter().enumerate() {
                let mut ray = ray_at_mut(to.words(), place);
                for row in if CLOSEST { row::RESULT } else { row::FOUND..row::FOUND + 1 } {
                    ray.set(row, rows[row].0[lane]);
                }
            }
            for lane in lanes_of(marks.odd) {
                let (group, lane) = group_and_lane(places[lane]);
                to.marks[group].odd |= 1 << lane;
            }
        }
    }

    /// Asks no more about the rays that have found something.
    pub(super) fn forget_found(&mut self) {
        for (marks, rows) in self.marks.iter_mut().zip(&self.groups) {
            for (lane, &found) in rows[row::FOUND].0.iter().enumerate() {
                marks.asked &= !(u32::from(found != 0) << lane);
            }
        }
    }

    /// All words, as [`place`] finds a ray's.
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

    /// Prepares the rays for the tree under `root`, as [`slabs`](crate::bvh::contract::slabs()) does.
    /// Those whose numbers are so large or so small that products may overflow are odd, and not
    /// alive.
    #[inline(always)]
    pub(super) fn prepare<L: Lanes>(&mut self, l: L, root: &Aabb, padding: Padding) {
        for group in 0..self.marks.len() {
            self.prepare_group(l, group, root, padding);
        }
    }

    #[inline(always)]
    fn prepare_group<L: Lanes>(&mut self, l: L, group: usize, root: &Aabb, padding: Padding) {
        let Marks { asked, odd, .. } = self.marks[group];
        let mut alive = asked & !odd;
        for from in (0..GROUP).step_by(L::N) {
            if alive >> from & lanes_mask::<L>() != 0 {
                let tame = self.prepare_lanes(l, group, from, root, padding);
                alive &= !(!tame << from & lanes_mask::<L>() << from);
            }
        }
        let marks = &mut self.marks[group];
        marks.odd |= marks.asked & !alive;
        marks.alive = alive;
    }

    /// The lanes whose numbers are none too large.
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
        let mut reach = l.f32(0.0);
        let mut largest = l.f32(0.0);
        for axis in 0..3 {
            reach = max(l, reach, abs(l, sub(l, l.f32(low[axis]), origin[axis])));
            reach = max(l, reach, abs(l, sub(l, l.f32(high[axis]), origin[axis])));
            largest = max(l, largest, abs(l, origin[axis]));
        }
        // Besides what slabs take: planes are multiplied before anything is taken from them.
        let part = l.f32(padding.slack + 2.0 * ULP);
        let pad = add(l, mul(l, part, reach), mul(l, l.f32(padding.origin), largest));
        let pad = max(l, pad, l.f32(f32::MIN_POSITIVE));
        let direction = V3::from_array(direction);
        let inverse = finite_inverse::on(&Packet::new(l), direction).array();
        let span = l.f32(root.min.abs().max(root.max.abs()).max_element());
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
            let sides = &mut self.marks[group].sides[axis];
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

/// The words of the ray at `place`.
#[inline(always)]
pub(super) fn ray_at(words: &[u32], place: u32) -> RayWords<'_> {
    match words[place as usize..].first_chunk() {
        Some(words) => RayWords(words),
        None => unreachable!("a ray has a word in each row of its group"),
    }
}

/// The words of the ray at `place`, to be written.
#[inline(always)]
pub(super) fn ray_at_mut(words: &mut [u32], place: u32) -> RayWordsMut<'_> {
    match words[place as usize..].first_chunk_mut() {
        Some(words) => RayWordsMut(words),
        None => unreachable!("a ray has a word in each row of its group"),
    }
}

/// 2^120.
pub(super) const HUGE: f32 = 1.329_228e36;

/// The lanes whose bits are set.
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
