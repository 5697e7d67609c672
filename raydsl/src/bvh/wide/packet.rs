//! Rays that go the same way, through the tree together.

use super::Wide;
use super::beam::{Beam, extent};
use super::blocks::{self, Row};
use super::counts::{self, Event};
use super::node::{Child, WIDTH, WideNode};
use super::octant::{GROUPS, Octant};
use super::rays::{GROUP, Group, Marks, Rays, lanes_mask, load, load_words, row};
use super::step::{Meeting, count, enter, ids, last_key, nearest, sorted};
use crate::bvh::contract::{Padding, is_within, limit_behind, precedes};
use crate::bvh::packet_slabs::{and, max, min};
use crate::geometry::{Aabb, HitOn, HitRecord, Primitive, RayOn};
use crate::machine::{Entered, F, Lanes, Packet, U, V3, op};

/// Fewer rays of one octant than this go their own ways, unless they are most of those that there
/// are.
const FEWEST: u32 = 12;

/// The most that directions of a beam may differ along an axis, relative to the largest component:
/// rays that part further visit less on their own.
const SPREAD: f32 = 0.5;

/// What a packet needs, kept from one query to the next.
#[derive(Debug, Default)]
pub(super) struct Together {
    /// Slots that are to come: their number in their node, behind eight times the node's.
    pub(super) stack: Vec<u32>,
    /// Where the packet enters them, as the bits of numbers above 0, in whose last three the slot
    /// is.
    enters: Vec<u32>,
    /// The rays that go together.
    pub(super) octant: Octant,
}

impl Together {
    /// Stacks for a tree: all that may be pending, and eight more, which are written at once.
    pub(super) fn make_room(&mut self, tree: &Wide) {
        let room = 1 + tree.pending + WIDTH;
        for stack in [&mut self.stack, &mut self.enters] {
            if stack.len() < room {
                stack.resize(room, 0);
            }
        }
    }
}

/// Finds the least hits of rays that go the same way, which are alive no more then; of all that may
/// go together, however they part, if they must.
#[inline(always)]
pub(super) fn closest_hit<R: Lanes, P: Primitive>(
    r: R,
    meeting: &Meeting<'_, P>,
    rays: &mut Rays,
    together: &mut Together,
    root: &Aabb,
    they_must: bool,
) {
    let (at_least, spread) = if they_must { (2, f32::INFINITY) } else { (FEWEST, SPREAD) };
    for groups in Octant::ranges(rays.marks.len()) {
        let alive = |marks: &Marks| marks.alive.count_ones();
        let mut left: u32 = rays.marks[groups.clone()].iter().map(alive).sum();
        let fewest = at_least.min(left / 4 * 3).max(2);
        while left > 0 {
            let octant = &mut together.octant;
            let taken = octant.take(rays, groups.clone());
            left -= taken;
            let beam = if taken < fewest {
                None
            } else {
                Beam::of(r.eight(), rays, octant, spread, root, Padding::of::<P>())
            };
            if let Some(beam) = beam {
                counts::some(Event::BeamRay, taken);
                walk(r, meeting, rays, together, beam);
                continue;
            }
            for (group, members) in octant.groups() {
                rays.marks[group].alone |= members;
            }
        }
    }
    for marks in &mut rays.marks {
        marks.alive = core::mem::take(&mut marks.alone);
    }
}

/// Takes a packet through the tree.
#[inline(always)]
fn walk<R: Lanes, P: Primitive>(
    r: R,
    meeting: &Meeting<'_, P>,
    rays: &mut Rays,
    together: &mut Together,
    mut beam: Beam,
) {
    let (e, tree) = (r.eight(), meeting.tree);
    together.make_room(tree);
    let Together { stack, enters, octant } = together;
    counts::one(Event::Beam);
    let mut bundle = Bundle::new(r, rays, octant, beam.side);
    let (mut at, mut slot, mut top) = (Child::node(0), 0, 0);
    loop {
        if at.is_block() {
            counts::one(Event::BeamBlock);
            let node = &tree.nodes[slot / WIDTH];
            let is_nearer = bundle.meet(meeting, meeting.rows(at.index()), node, slot % WIDTH);
            if is_nearer {
                beam.limit = extent(e, bundle.rays, bundle.octant, row::LIMIT).greatest;
            }
        } else {
            counts::one(Event::BeamNode);
            let node = &tree.nodes[at.index()];
            let (near, mask) = enter(e, node, &beam);
            let entered = e.bits(mask).count_ones() as usize;
            let keys = sorted(e, near, mask);
            let below = e.u32_binary(op::And, keys, e.u32(7));
            let below = e.u32_binary(op::Or, below, e.u32(8 * at.0));
            e.u32_store(below, &mut stack[top..][..WIDTH]);
            e.u32_store(keys, &mut enters[top..][..WIDTH]);
            if entered > 0 {
                // What it enters first is the last of them, and no more to come.
                top += entered - 1;
                let first = nearest(e, near, mask);
                slot = WIDTH * at.index() + first;
                at = Child(node.children[first]);
                continue;
            }
        }
        let last = last_key(beam.limit);
        loop {
            if top == 0 {
                return;
            }
            top -= 1;
            if enters[top] & !7 <= last {
                break;
            }
        }
        slot = stack[top] as usize;
        at = Child(tree.nodes[slot / WIDTH].children[slot % WIDTH]);
    }
}

/// Rays that go through a tree together.
pub(super) struct Bundle<'a, R: Lanes> {
    r: R,
    m: Packet<Entered<R>>,
    pub(super) rays: &'a mut Rays,
    pub(super) octant: &'a mut Octant,
    side: [usize; 3],
}

impl<'a, R: Lanes> Bundle<'a, R> {
    #[inline(always)]
    pub(super) fn new(r: R, rays: &'a mut Rays, octant: &'a mut Octant, side: [usize; 3]) -> Self {
        Self { r, m: Packet::new(Entered::new(r)), rays, octant, side }
    }

    #[inline(always)]
    fn register(&mut self, group: usize, from: usize) -> Register<'_, R> {
        Register { r: self.r, m: &self.m, group: self.rays.group_mut(group), from }
    }

    /// Meets the primitives of a block, whose box is in a slot of a node; whether any ray has a
    /// nearer hit.
    #[inline(always)]
    fn meet<P: Primitive>(
        &mut self,
        meeting: &Meeting<'_, P>,
        block: &[Row],
        node: &WideNode,
        slot: usize,
    ) -> bool {
        let (r, side) = (self.r, self.side);
        let count = count(r.eight(), block);
        let mut is_nearer = false;
        for (group, members) in self.octant.groups() {
            for from in (0..GROUP).step_by(R::N) {
                let alive = members >> from & lanes_mask::<R>();
                if alive == 0 {
                    continue;
                }
                let lanes = self.register(group, from);
                let there = lanes.enter(node, slot, side);
                let there = and(r, there, r.mask_from_bits(alive.into()));
                if r.any(there) {
                    let met = lanes.meet(meeting, block, count, there);
                    counts::some(Event::Nearer, met.into());
                    is_nearer |= met;
                }
            }
        }
        is_nearer
    }

    /// The rays that enter the box in a slot of a node before their limits, a bit each group by
    /// group, and how many they are.
    #[inline(always)]
    pub(super) fn enter(&mut self, node: &WideNode, slot: usize) -> ([u32; GROUPS], u32) {
        let (r, side) = (self.r, self.side);
        let (mut entering, mut count) = ([0; GROUPS], 0);
        for (entering, (group, members)) in entering.iter_mut().zip(self.octant.groups()) {
            for from in (0..GROUP).step_by(R::N) {
                let alive = members >> from & lanes_mask::<R>();
                if alive != 0 {
                    let lanes = self.register(group, from);
                    let there = r.bits(lanes.enter(node, slot, side)) as u32 & alive;
                    *entering |= there << from;
                    count += there.count_ones();
                }
            }
        }
        (entering, count)
    }

    /// Meets the primitives of a block with some of the rays, and goes on without those that are
    /// stopped; whether any is left.
    #[inline(always)]
    pub(super) fn stop<P: Primitive>(
        &mut self,
        meeting: &Meeting<'_, P>,
        block: &[Row],
        entering: [u32; GROUPS],
    ) -> bool {
        let r = self.r;
        let count = count(r.eight(), block);
        let mut stopped = [0; GROUPS];
        for ((stopped, entering), (group, _)) in
            stopped.iter_mut().zip(entering).zip(self.octant.groups())
        {
            for from in (0..GROUP).step_by(R::N) {
                let there = entering >> from & lanes_mask::<R>();
                if there != 0 {
                    let there = r.mask_from_bits(there.into());
                    *stopped |=
                        self.register(group, from).stop(meeting, block, count, there) << from;
                }
            }
        }
        self.octant.leave(stopped)
    }
}

/// A register of rays.
struct Register<'a, R: Lanes> {
    r: R,
    m: &'a Packet<Entered<R>>,
    group: &'a mut Group,
    from: usize,
}

impl<R: Lanes> Register<'_, R> {
    #[inline(always)]
    fn number(&self, row: usize) -> R::F32 {
        load(self.r, &self.group[row].0, self.from)
    }

    #[inline(always)]
    fn set(&mut self, row: usize, word: R::U32) {
        self.r.u32_store(word, &mut self.group[row].0[self.from..]);
    }

    #[inline(always)]
    fn set_number(&mut self, row: usize, number: R::F32) {
        self.set(row, self.r.f32_to_bits(number));
    }

    #[inline(always)]
    fn vector(&self, row: usize) -> V3<Packet<Entered<R>>> {
        V3 { x: F(self.number(row)), y: F(self.number(row + 1)), z: F(self.number(row + 2)) }
    }

    /// The rays that enter a box before their limits.
    #[inline(always)]
    fn enter(&self, node: &WideNode, slot: usize, side: [usize; 3]) -> R::Mask {
        counts::one(Event::RegisterBox);
        let r = self.r;
        let mut near = self.number(row::T_MIN);
        let mut far = self.number(row::LIMIT);
        for (axis, side) in side.into_iter().enumerate() {
            let first = r.f32(node.planes[2 * axis + (side & 1)][slot % WIDTH]);
            let last = r.f32(node.planes[2 * axis + 1 - (side & 1)][slot % WIDTH]);
            let inverse = self.number(row::INVERSE + axis);
            near = max(r, near, r.f32_mul_add_fast(first, inverse, self.number(row::FIRST + axis)));
            far = min(r, far, r.f32_mul_add_fast(last, inverse, self.number(row::LAST + axis)));
        }
        r.f32_compare(op::Le, near, far)
    }

    /// The rays themselves.
    #[inline(always)]
    fn ray(&self) -> RayOn<Packet<Entered<R>>> {
        RayOn {
            origin: self.vector(row::ORIGIN),
            direction: self.vector(row::DIRECTION),
            t_min: F(self.number(row::T_MIN)),
            t_max: F(self.number(row::T_MAX)),
        }
    }

    /// Meets the first primitives of a block; the rays, of those of `there`, that are stopped.
    #[inline(always)]
    fn stop<P: Primitive>(
        mut self,
        meeting: &Meeting<'_, P>,
        block: &[Row],
        count: usize,
        mut there: R::Mask,
    ) -> u32 {
        let (r, m) = (self.r, self.m);
        let (ray, asked) = (self.ray(), there);
        counts::one(Event::RegisterBlock);
        for i in 0..count {
            counts::one(Event::RegisterPrimitive);
            let prim = blocks::read::<_, P>(
                m,
                #[inline(always)]
                |word| r.u32(block[word].0[i % WIDTH]),
            );
            let record = m.with_active(
                there,
                #[inline(always)]
                || P::intersect_among_on(m, meeting.kinds, prim, ray, meeting.shared),
            );
            let hit = P::Hit::hit_on(record);
            let met = and(r, there, is_within::on(m, hit, ray).0);
            if r.any(met) {
                there = and(r, there, r.mask_not(met));
                if !r.any(there) {
                    break;
                }
            }
        }
        let stopped = and(r, asked, r.mask_not(there));
        let found = load_words(r, &self.group[row::FOUND].0, self.from);
        self.set(row::FOUND, r.u32_select(stopped, r.u32(1), found));
        r.bits(stopped) as u32
    }

    /// Meets the first primitives of a block; whether any ray has a nearer hit.
    #[inline(always)]
    fn meet<P: Primitive>(
        mut self,
        meeting: &Meeting<'_, P>,
        block: &[Row],
        count: usize,
        there: R::Mask,
    ) -> bool {
        let (r, m) = (self.r, self.m);
        let (ray, numbers) = (self.ray(), ids(block));
        let mut is_nearer = false;
        counts::one(Event::RegisterBlock);
        // In a function that `stop` shares these tests are up to a tenth slower. Without a check of
        // bounds on the way, what depends on the rays alone is done once.
        for i in 0..count {
            counts::one(Event::RegisterPrimitive);
            let prim = blocks::read::<_, P>(
                m,
                #[inline(always)]
                |word| r.u32(block[word].0[i % WIDTH]),
            );
            let record = m.with_active(
                there,
                #[inline(always)]
                || P::intersect_among_on(m, meeting.kinds, prim, ray, meeting.shared),
            );
            let hit = P::Hit::hit_on(record);
            let best = self.number(row::T);
            let t_max = F(min(r, ray.t_max.0, best));
            let met = and(r, there, is_within::on(m, hit, RayOn { t_max, ..ray }).0);
            if !r.any(met) {
                continue;
            }
            let id = r.u32(meeting.part.first + numbers[i % WIDTH]);
            let ids = load_words(r, &self.group[row::ID].0, self.from);
            let hit = HitOn { prim_id: U(id), ..hit };
            let before = HitOn { t: F(best), prim_id: U(ids), ..hit };
            let take = and(r, met, precedes::on(m, false, hit, before).0);
            let best = r.f32_select(take, hit.t.0, best);
            let (u, v) = (self.number(row::U), self.number(row::V));
            let found = load_words(r, &self.group[row::FOUND].0, self.from);
            self.set_number(row::T, best);
            self.set_number(row::U, r.f32_select(take, hit.u.0, u));
            self.set_number(row::V, r.f32_select(take, hit.v.0, v));
            self.set(row::ID, r.u32_select(take, id, ids));
            self.set(row::FOUND, r.u32_select(take, r.u32(1), found));
            let limit = limit_behind::on(m, F(best), F(r.f32(P::SLACK)), ray.t_max);
            self.set_number(row::LIMIT, limit.0);
            is_nearer = true;
        }
        is_nearer
    }
}
