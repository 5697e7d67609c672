//! Queries of packets, and of many rays of the host, answered by wide trees.

use core::cell::Cell;
use core::mem::{swap, take};

use fearless_simd::Level;

use super::entry;
use super::hybrid;
use super::order::{Portions, Sequence};
use super::packet::{self, Together};
use super::rays::{GROUP, Rays, lanes_of, load_words, place, ray_at, ray_at_mut, row};
use super::step::Meeting;
use super::walks::Walks;
use super::wave::{self, Wave};
use crate::bvh::contract::{Padding, is_finite};
use crate::bvh::packet_slabs::and;
use crate::bvh::{Part, SceneView, Traversal, View, traverse};
use crate::geometry::{Aabb, Hit, HitOn, Primitive, Ray, RayOn};
use crate::machine::{B, Entered, F, Lanes, Packet, U, op};
use crate::run::{self, LanesTask, Scratch as _, fibers, with_wide_walks};

/// The memory of a query, which a thread keeps for the next one.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub(super) rays: Rays,
    pub(super) wave: Wave,
    pub(super) together: Together,
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

/// The least `(t, id)` hit of every running lane, for each of some rays of a packet.
#[inline(always)]
pub(crate) fn closest_hits<L: Lanes, T, S>(
    m: &Packet<L>,
    (scene, walks): (&View<'_, T, S>, &Walks<T, S>),
    rays: &[RayOn<Packet<L>>],
    hits: &mut [HitOn<Packet<L>>],
) {
    let l = m.lanes();
    let key = (walks.closest as *const () as usize, scene.address());
    let answer = |scratch: &mut Scratch| (walks.closest)(l.level(), scene, scratch);
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

/// Whether every running lane hits anything, for each of some rays of a packet.
#[inline(always)]
pub(crate) fn any_hits<L: Lanes, T, S>(
    m: &Packet<L>,
    (scene, walks): (&View<'_, T, S>, &Walks<T, S>),
    rays: &[RayOn<Packet<L>>],
    hits: &mut [B<Packet<L>>],
) {
    let l = m.lanes();
    let key = (walks.any as *const () as usize, scene.address());
    let answer = |scratch: &mut Scratch| (walks.any)(l.level(), scene, scratch);
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

/// Asks about the rays, together with other packets if there are any, and has each packet read what
/// its rays have found. One function for packets of one kind, whatever the primitives.
#[inline(never)]
fn ask<L: Lanes>(
    m: &Packet<L>,
    key: run::Key,
    rays: &[RayOn<Packet<L>>],
    answer: &dyn Fn(&mut Scratch),
    read: &mut dyn FnMut(&Scratch, usize),
) {
    let load = |scratch: &mut Scratch| {
        m.lanes().enter_again(
            #[inline(always)]
            || load(m, &mut scratch.rays, rays),
        )
    };
    if fibers::ask(key, load, answer, &mut *read) {
        return;
    }
    with_scratch(|scratch| {
        scratch.clear();
        let first = load(scratch);
        answer(scratch);
        read(scratch, first);
    });
}

/// How many rays of the host are asked about together.
const AT_ONCE: usize = 2048;

/// The least `(t, id)` hit of each ray.
pub(crate) fn each_closest<T, S>(
    (scene, walks): (&View<'_, T, S>, &Walks<T, S>),
    rays: &[Ray],
    mut found: impl FnMut(&Ray, Hit),
) {
    with_scratch(|scratch| {
        for rays in rays.chunks(AT_ONCE) {
            scratch.rays.load(rays);
            (walks.closest)(None, scene, scratch);
            for (i, ray) in rays.iter().enumerate() {
                found(ray, ray_at(scratch.rays.words(), place(i)).hit());
            }
        }
    });
}

/// Whether each ray hits anything.
pub(crate) fn each_any<T, S>(
    (scene, walks): (&View<'_, T, S>, &Walks<T, S>),
    rays: &[Ray],
    mut found: impl FnMut(bool),
) {
    with_scratch(|scratch| {
        for rays in rays.chunks(AT_ONCE) {
            scratch.rays.load(rays);
            (walks.any)(None, scene, scratch);
            for i in 0..rays.len() {
                found(ray_at(scratch.rays.words(), place(i)).word(row::FOUND) != 0);
            }
        }
    });
}

/// Lends a query the memory of the one before. A primitive may ask another scene meanwhile, which
/// has memory of its own then.
fn with_scratch(query: impl FnOnce(&mut Scratch)) {
    let mut scratch = SCRATCH.take().unwrap_or_default();
    query(&mut scratch);
    SCRATCH.set(Some(scratch));
}

/// What queries of this thread have done.
#[cfg(test)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ways {
    /// Whether any rays went together.
    pub(super) packets: bool,
    /// Whether any were put into order.
    pub(super) order: bool,
}

/// Which ways rays of this thread have gone.
#[cfg(test)]
pub(super) fn ways() -> Ways {
    let mut ways = Ways::default();
    with_scratch(|scratch| {
        ways.packets = !scratch.together.stack.is_empty();
        ways.order = scratch.portions.has_sorted();
    });
    ways
}

/// Finds what the rays meet: the least hits with `CLOSEST`, else whether there is any.
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
            if CLOSEST && scene.parts().any(is_sorted) && scratch.rays.all_alive() > hybrid::APART {
                closest_sorted(r, scene, scratch);
            } else {
                each_part::<CLOSEST, R, P>(r, scene, scratch);
            }
        }
    }
    let done = with_wide_walks(level, Answer::<CLOSEST, P> { scene, scratch: &mut *scratch });
    debug_assert!(done.is_some(), "wide trees are there where the machine goes through them");
    alone::<CLOSEST, P>(scene, &mut scratch.rays);
}

/// Finds the least hits of the rays that are alive, some at a time in the order of their directions.
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

/// In its own function, which packets of any width share.
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
                let (meeting, e) = (meeting(scene, part, tree), r.eight());
                if CLOSEST {
                    let Scratch { rays, wave, together, .. } = &mut *scratch;
                    rays.prepare(r, root, Padding::of::<P>());
                    if tree.traversal != Traversal::Waves {
                        let must = tree.traversal == Traversal::Packets;
                        packet::closest_hit(r, &meeting, rays, together, root, must);
                    }
                    wave::run::<true, _, _>(Entered::new(e), &meeting, None, rays, wave);
                    continue;
                }
                if const { P::IS_SHORT } {
                    any(r, Entered::straight(e), &meeting, root, scratch);
                } else {
                    any(r, Entered::new(e), &meeting, root, scratch);
                }
                if scene.part(next).is_some() {
                    scratch.rays.forget_found();
                }
            }
        },
    );
}

/// Whether the rays meet anything in a part of the scene. `e` is for those on their own ways.
#[inline(always)]
fn any<R: Lanes, E: Lanes, P: Primitive>(
    r: R,
    e: E,
    meeting: &Meeting<'_, P>,
    root: &Aabb,
    scratch: &mut Scratch,
) {
    let padding = Padding::of::<P>();
    let Scratch { rays, wave, .. } = &mut *scratch;
    let count = rays.all_alive();
    let sequence = match meeting.tree.traversal {
        // Rays without an end mostly meet something soon, each on its own way.
        Traversal::Auto => (count >= hybrid::FEWEST && entry::have_ends(r.eight(), rays))
            .then_some(Sequence::ByDirection),
        Traversal::Waves => None,
        Traversal::Packets => (count > hybrid::APART).then_some(Sequence::AsTheyCome),
        Traversal::Sorted => (count > hybrid::APART).then_some(Sequence::ByDirection),
    };
    if let Some(sequence) = sequence {
        hybrid::any_hit(r, e, meeting, root, scratch, sequence);
    } else {
        rays.prepare(r, root, padding);
        let entry = entry::of(r.eight(), meeting.tree, rays, root, padding);
        wave::run::<false, _, _>(e, meeting, entry.as_ref(), rays, wave);
    }
}

/// Asks about the rays that are too odd for boxes.
fn alone<const CLOSEST: bool, P: Primitive>(scene: &SceneView<'_, P>, rays: &mut Rays) {
    for group in 0..rays.marks.len() {
        for lane in lanes_of(rays.marks[group].odd) {
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

#[inline(always)]
pub(super) fn meeting<'a, P: Primitive>(
    scene: &SceneView<'a, P>,
    part: Part<'a, P, P::Shared>,
    tree: &'a super::Wide,
) -> Meeting<'a, P> {
    let (shared, kinds) = (scene.shared(), scene.kinds());
    Meeting { tree, part, shared, kinds }
}

/// Writes the rays of the running lanes to groups, one packet behind the other; returns the number of
/// the first.
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
        let alive = l.bits(and(l, m.active(), is_finite::on(m, *ray).0));
        for from in (0..L::N).step_by(GROUP) {
            let (group, lane) = ((first + from) / GROUP, (first + from) % GROUP);
            let lanes = if L::N < GROUP { alive } else { alive >> from & 0xffff };
            to.marks[group].asked |= (lanes as u32) << lane;
        }
    }
    begin
}

/// Writes a number of every lane to its place.
#[inline(always)]
fn spread<L: Lanes>(l: L, numbers: L::F32, to: &mut Rays, first: usize, row: usize) {
    let words = l.f32_to_bits(numbers);
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

/// A word of each lane, from that of the ray `first` on.
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

/// The lanes whose rays, from the number `first` on, have found anything.
#[inline(always)]
fn found_at<L: Lanes>(l: L, rays: &Rays, first: usize) -> L::Mask {
    l.u32_compare(op::Ne, words_at(l, rays, first, row::FOUND), l.u32(0))
}

#[inline(always)]
fn number_at<L: Lanes>(l: L, rays: &Rays, first: usize, row: usize) -> L::F32 {
    l.f32_from_bits(words_at(l, rays, first, row))
}

#[inline(always)]
fn hit_at<L: Lanes>(l: L, rays: &Rays, first: usize) -> HitOn<Packet<L>> {
    let found = found_at(l, rays, first);
    HitOn {
        is_hit: B(found),
        t: F(l.f32_select(found, number_at(l, rays, first, row::T), l.f32(0.0))),
        prim_id: U(l.u32_select(found, words_at(l, rays, first, row::ID), l.u32(0))),
        inst_id: U(l.u32(0)),
        u: F(number_at(l, rays, first, row::U)),
        v: F(number_at(l, rays, first, row::V)),
    }
}
