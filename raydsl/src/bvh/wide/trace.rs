//! Queries of SIMD packets, and of many rays of the host, in wide trees.

use core::cell::Cell;
use core::mem::{swap, take};

use fearless_simd::Level;

use super::blocks::has_boxes;
use super::entry;
use super::hybrid;
use super::order::{Portions, Sequence};
use super::packet::{self, PacketScratch};
use super::queries::WideQueries;
use super::rays::{GROUP, Rays, lanes_of, load_words, place, ray_at, ray_at_mut, row};
use super::step::LeafIntersector;
use super::stream::{self, RayStream};
use crate::bvh::contract::{Padding, is_finite};
use crate::bvh::packet_slabs::and;
use crate::bvh::{Part, SceneView, Traversal, View, traverse};
use crate::geometry::{Aabb, Hit, HitOn, Primitive, Ray, RayOn, Shared};
use crate::machine::{B, Entered, F, Lanes, Packet, U, op};
use crate::run::{self, LanesTask, Scratch as _, fibers, with_wide_lanes};

/// Scratch memory of a query, which a thread keeps for the next one.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub(super) rays: Rays,
    pub(super) stream: RayStream,
    pub(super) packet_scratch: PacketScratch,
    pub(super) portions: Portions,
}
impl run::Scratch for Scratch {
    fn clear(&mut self) {
        self.rays.clear();
    }
}

thread_local! {
    static SCRATCH: Cell<Option<Box<Scratch>>> = const { Cell::new(None) };
}

/// Finds the least `(t, id)` hit of every active lane, for several rays of a packet.
#[inline(always)]
pub(crate) fn closest_hits<L: Lanes, T, S: Shared>(
    m: &Packet<L>,
    (scene, queries): (&View<'_, T, S>, &WideQueries<T, S>),
    rays: &[RayOn<Packet<L>>],
    hits: &mut [HitOn<Packet<L>>],
) {
    let l = m.lanes();
    let key = (queries.closest as *const () as usize, scene.address());
    let answer = |scratch: &mut Scratch| (queries.closest)(l.level(), scene, scratch);
    ask(m, key, rays, &answer, &mut |scratch, first| {
        l.enter_again(
            #[inline(always)]
            || {
                for (q, hit) in hits.iter_mut().enumerate() {
                    *hit = hit_at(l, &scratch.rays, first + q * L::N);
                }
            },
        );
    });
}

/// Finds whether every active lane hits anything, for several rays of a packet.
#[inline(always)]
pub(crate) fn any_hits<L: Lanes, T, S: Shared>(
    m: &Packet<L>,
    (scene, queries): (&View<'_, T, S>, &WideQueries<T, S>),
    rays: &[RayOn<Packet<L>>],
    hits: &mut [B<Packet<L>>],
) {
    let l = m.lanes();
    let key = (queries.any as *const () as usize, scene.address());
    let answer = |scratch: &mut Scratch| (queries.any)(l.level(), scene, scratch);
    ask(m, key, rays, &answer, &mut |scratch, first| {
        l.enter_again(
            #[inline(always)]
            || {
                for (q, hit) in hits.iter_mut().enumerate() {
                    *hit = B(found_at(l, &scratch.rays, first + q * L::N));
                }
            },
        );
    });
}

/// Answers a query of a packet, batched with those of other packets of its gang, and reads the
/// packet's results. One function for each kind of packet, whatever the primitives.
#[inline(never)]
fn ask<L: Lanes>(
    m: &Packet<L>,
    key: run::Key,
    rays: &[RayOn<Packet<L>>],
    answer: &dyn Fn(&mut Scratch),
    read: &mut dyn FnMut(&Scratch, usize),
) {
    let mut load = |scratch: &mut Scratch| {
        m.lanes().enter_again(
            #[inline(always)]
            || load(m, &mut scratch.rays, rays),
        )
    };
    ask_batched(key, &mut load, answer, read);
}

/// Does [`ask`]'s part that no kind of packet changes, compiled once.
fn ask_batched(
    key: run::Key,
    load: &mut dyn FnMut(&mut Scratch) -> usize,
    answer: &dyn Fn(&mut Scratch),
    read: &mut dyn FnMut(&Scratch, usize),
) {
    if fibers::ask(key, &mut *load, answer, &mut *read) {
        return;
    }
    with_scratch(|scratch| {
        scratch.clear();
        let first = load(scratch);
        answer(scratch);
        read(scratch, first);
    });
}

/// Rays of the host per batch.
const BATCH: usize = 2048;

/// Calls `found` with the least `(t, id)` hit of each ray.
pub(crate) fn each_closest<T, S: Shared>(
    (scene, queries): (&View<'_, T, S>, &WideQueries<T, S>),
    rays: &[Ray],
    mut found: impl FnMut(&Ray, Hit),
) {
    with_scratch(|scratch| {
        for rays in rays.chunks(BATCH) {
            scratch.rays.load(rays);
            (queries.closest)(None, scene, scratch);
            for (i, ray) in rays.iter().enumerate() {
                found(ray, ray_at(scratch.rays.words(), place(i)).hit());
            }
        }
    });
}

/// Calls `found` with whether each ray hits anything.
pub(crate) fn each_any<T, S: Shared>(
    (scene, queries): (&View<'_, T, S>, &WideQueries<T, S>),
    rays: &[Ray],
    mut found: impl FnMut(bool),
) {
    with_scratch(|scratch| {
        for rays in rays.chunks(BATCH) {
            scratch.rays.load(rays);
            (queries.any)(None, scene, scratch);
            for i in 0..rays.len() {
                found(ray_at(scratch.rays.words(), place(i)).word(row::FOUND) != 0);
            }
        }
    });
}

/// Lends a query this thread's scratch memory. A primitive may query another scene meanwhile, which
/// allocates its own then.
fn with_scratch(query: impl FnOnce(&mut Scratch)) {
    let mut scratch = SCRATCH.take().unwrap_or_default();
    query(&mut scratch);
    SCRATCH.set(Some(scratch));
}

/// Traversals that queries of this thread have used.
#[cfg(test)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Used {
    /// Whether any rays formed ray packets.
    pub(super) packets: bool,
    /// Whether any rays were sorted.
    pub(super) order: bool,
}

/// Returns the traversals that queries of this thread have used.
#[cfg(test)]
pub(super) fn used() -> Used {
    let mut used = Used::default();
    with_scratch(|scratch| {
        used.packets = !scratch.packet_scratch.stack.is_empty();
        used.order = scratch.portions.has_sorted();
    });
    used
}

/// Answers a query: finds the least hits with `CLOSEST`, else whether there is any.
pub(super) fn answer<const CLOSEST: bool, P: Primitive>(
    level: Option<Level>,
    scene: &SceneView<'_, P>,
    scratch: &mut Scratch,
) {
    struct Answer<'a, 's, const CLOSEST: bool, P: Primitive> {
        scene: &'a SceneView<'s, P>,
        scratch: &'a mut Scratch,
    }
    impl<const CLOSEST: bool, P: Primitive> LanesTask for Answer<'_, '_, CLOSEST, P> {
        type Output = ();

        fn run<R: Lanes>(self, r: R) {
            let Self { scene, scratch } = self;
            let is_sorted = |part: Part<'_, P, P::Shared>| {
                part.wide().is_some_and(|tree| tree.traversal == Traversal::Sorted)
            };
            if CLOSEST
                && scene.parts().any(is_sorted)
                && scratch.rays.activate_all() > hybrid::APART
            {
                closest_sorted(r, scene, scratch);
            } else {
                each_part::<CLOSEST, R, P>(r, scene, scratch);
            }
        }
    }
    let done = with_wide_lanes(level, Answer::<CLOSEST, P> { scene, scratch: &mut *scratch });
    debug_assert!(done.is_some(), "wide trees are built only where the machine can traverse them");
    fallback::<CLOSEST, P>(scene, &mut scratch.rays);
}

/// Finds the least hits of the active rays, in portions sorted by direction.
#[inline(never)]
fn closest_sorted<R: Lanes, P: Primitive>(r: R, scene: &SceneView<'_, P>, scratch: &mut Scratch) {
    r.vectorize(
        #[inline(always)]
        || {
            let (mut rays, mut portions) = (take(&mut scratch.rays), take(&mut scratch.portions));
            let find = |some: &mut Rays| {
                swap(&mut scratch.rays, some);
                each_part::<true, R, P>(r, scene, scratch);
                swap(&mut scratch.rays, some);
            };
            portions.each::<true, R>(r, &mut rays, Sequence::ByDirection, find);
            (scratch.rays, scratch.portions) = (rays, portions);
        },
    );
}

/// Traces the rays through each part of the scene. A function of its own, which packets of any
/// width share.
#[inline(never)]
fn each_part<const CLOSEST: bool, R: Lanes, P: Primitive>(
    r: R,
    scene: &SceneView<'_, P>,
    scratch: &mut Scratch,
) {
    r.vectorize(
        #[inline(always)]
        || {
            let mut next = 0;
            while let Some(part) = scene.part(next) {
                next += 1;
                let Some(tree) = part.wide().filter(|tree| !tree.is_empty()) else { continue };
                let root = &tree.bounds();
                let (intersector, e) = (leaf_intersector(scene, part, tree), r.eight());
                if CLOSEST {
                    // Closest hits: packets first, then the remaining rays as streams.
                    let Scratch { rays, stream, packet_scratch, .. } = &mut *scratch;
                    rays.prepare(r, root, Padding::of::<P>());
                    if tree.traversal != Traversal::Streams {
                        let is_forced = tree.traversal == Traversal::Packets;
                        packet::closest_hit(r, &intersector, rays, packet_scratch, root, is_forced);
                    }
                    stream::run::<true, _, _, _>(
                        r,
                        Entered::new(e),
                        &intersector,
                        None,
                        rays,
                        stream,
                    );
                    continue;
                }
                if const { P::IS_SHORT } {
                    any(r, Entered::straight(e), &intersector, root, scratch);
                } else {
                    any(r, Entered::new(e), &intersector, root, scratch);
                }
                if scene.part(next).is_some() {
                    scratch.rays.forget_found();
                }
            }
        },
    );
}

/// Finds whether the rays hit anything in a part of the scene. `e` are the lanes of streams.
#[inline(always)]
fn any<R: Lanes, E: Lanes, P: Primitive>(
    r: R,
    e: E,
    intersector: &LeafIntersector<'_, P>,
    root: &Aabb,
    scratch: &mut Scratch,
) {
    let padding = Padding::of::<P>();
    let Scratch { rays, stream, .. } = &mut *scratch;
    let count = rays.activate_all();
    let sequence = match intersector.tree.traversal {
        // Streams test pairs of rays and primitives, which fills registers.
        Traversal::Auto if const { has_boxes::<P>() } => None,
        // Most unbounded rays are occluded soon, by different primitives.
        Traversal::Auto => (count >= hybrid::FEWEST && entry::are_bounded(r.eight(), rays))
            .then_some(Sequence::ByDirection),
        Traversal::Streams => None,
        Traversal::Packets => (count > hybrid::APART).then_some(Sequence::AsTheyCome),
        Traversal::Sorted => (count > hybrid::APART).then_some(Sequence::ByDirection),
    };
    if let Some(sequence) = sequence {
        hybrid::any_hit(r, e, intersector, root, scratch, sequence);
    } else {
        rays.prepare(r, root, padding);
        let entry = entry::of(r.eight(), intersector.tree, rays, root, padding);
        stream::run::<false, _, _, _>(r, e, intersector, entry.as_ref(), rays, stream);
    }
}

/// Traces degenerate rays one by one through the binary tree.
fn fallback<const CLOSEST: bool, P: Primitive>(scene: &SceneView<'_, P>, rays: &mut Rays) {
    for group in 0..rays.masks.len() {
        for lane in lanes_of(rays.masks[group].degenerate) {
            let mut words = ray_at_mut(rays.words(), place(GROUP * group + lane));
            let ray = words.as_ref().ray();
            if CLOSEST {
                words.set_hit(traverse::nearest(scene, ray));
            } else {
                words.set(row::FOUND, traverse::any_hit(scene, ray).into());
            }
        }
    }
}

/// Returns the intersector of the leaves of a tree.
#[inline(always)]
pub(super) fn leaf_intersector<'a, P: Primitive>(
    scene: &SceneView<'a, P>,
    part: Part<'a, P, P::Shared>,
    tree: &'a super::Wide,
) -> LeafIntersector<'a, P> {
    let (shared, kinds) = (scene.stored().views(), scene.kinds());
    LeafIntersector { tree, part, shared, kinds }
}

/// Stores several rays of a packet's active lanes to groups; returns the index of the first ray.
#[inline(always)]
fn load<L: Lanes>(m: &Packet<L>, to: &mut Rays, rays: &[RayOn<Packet<L>>]) -> usize {
    let l = m.lanes();
    let begin = to.add(L::N, rays.len());
    for (q, ray) in rays.iter().enumerate() {
        let first = begin + q * L::N;
        let (o, d) = (ray.origin.array(), ray.direction.array());
        for axis in 0..3 {
            spread(l, o[axis], to, first, row::ORIGIN + axis);
            spread(l, d[axis], to, first, row::DIRECTION + axis);
        }
        spread(l, ray.t_min.0, to, first, row::T_MIN);
        spread(l, ray.t_max.0, to, first, row::T_MAX);
        spread(l, ray.t_max.0, to, first, row::LIMIT);
        spread(l, l.f32(f32::INFINITY), to, first, row::T);
        spread(l, l.f32(0.0), to, first, row::U);
        spread(l, l.f32(0.0), to, first, row::V);
        spread(l, l.f32_from_bits(l.u32(u32::MAX)), to, first, row::ID);
        spread(l, l.f32(0.0), to, first, row::FOUND);
        let active = l.bits(and(l, m.active(), is_finite::on(m, *ray).0));
        for from in (0..L::N).step_by(GROUP) {
            let (group, lane) = ((first + from) / GROUP, (first + from) % GROUP);
            let lanes = if L::N < GROUP { active } else { active >> from & 0xffff };
            to.masks[group].queried |= (lanes as u32) << lane;
        }
    }
    begin
}

/// Stores one component of every lane's ray.
#[inline(always)]
fn spread<L: Lanes>(l: L, values: L::F32, to: &mut Rays, first: usize, row: usize) {
    let words = l.f32_to_bits(values);
    if L::N <= GROUP {
        l.u32_store(words, &mut to.row_mut(first / GROUP, row)[first % GROUP..]);
    } else {
        let mut all = [0; 64];
        l.u32_store(words, &mut all);
        for from in (0..L::N).step_by(GROUP) {
            let lanes = &all[from..from + GROUP];
            to.row_mut((first + from) / GROUP, row).copy_from_slice(lanes);
        }
    }
}

/// Loads one word of each lane, from ray `first` on.
#[inline(always)]
fn words_at<L: Lanes>(l: L, rays: &Rays, first: usize, row: usize) -> L::U32 {
    if L::N <= GROUP {
        return load_words(l, rays.row(first / GROUP, row), first % GROUP);
    }
    let mut all = [0; 64];
    for from in (0..L::N).step_by(GROUP) {
        all[from..from + GROUP].copy_from_slice(rays.row((first + from) / GROUP, row));
    }
    l.u32_from_fn(
        #[inline(always)]
        |lane| all[lane],
    )
}

/// Returns the mask of the lanes whose rays, from ray `first` on, have a hit.
#[inline(always)]
fn found_at<L: Lanes>(l: L, rays: &Rays, first: usize) -> L::Mask {
    l.u32_compare(op::Ne, words_at(l, rays, first, row::FOUND), l.u32(0))
}

#[inline(always)]
fn float_at<L: Lanes>(l: L, rays: &Rays, first: usize, row: usize) -> L::F32 {
    l.f32_from_bits(words_at(l, rays, first, row))
}

#[inline(always)]
fn hit_at<L: Lanes>(l: L, rays: &Rays, first: usize) -> HitOn<Packet<L>> {
    let found = found_at(l, rays, first);
    HitOn {
        is_hit: B(found),
        t: F(l.f32_select(found, float_at(l, rays, first, row::T), l.f32(0.0))),
        prim_id: U(l.u32_select(found, words_at(l, rays, first, row::ID), l.u32(0))),
        inst_id: U(l.u32(0)),
        u: F(float_at(l, rays, first, row::U)),
        v: F(float_at(l, rays, first, row::V)),
    }
}
