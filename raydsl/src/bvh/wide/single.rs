//! One ray through wide trees.

use core::cell::Cell;

use super::beam::Beam;
use super::counts::{self, Event};
use super::node::{Child, WIDTH};
use super::step::{Meeting, enter, ids, last_key, nearest, sorted, words};
use super::trace::meeting;
use crate::bvh::contract::{Padding, is_before, is_finite, limit_behind};
use crate::bvh::{Part, SceneView};
use crate::geometry::{Hit, Primitive, Ray};
use crate::machine::{Entered, Lanes, Packet, Type};
use crate::run::{LanesTask, with_wide_walks};

/// Entries of a stack that is made for each ray: what all but very deep trees need. Tests of the
/// library make do with less, so that both are tested.
const FEW: usize = if cfg!(test) { 24 } else { 96 };

thread_local! {
    /// Stacks for very deep trees, kept for the next ray.
    static DEEP: Cell<Vec<u32>> = const { Cell::new(Vec::new()) };
}

/// The least `(t, id)` hit of a ray; none if it is too odd for the boxes of wide trees.
pub(super) fn closest_hit<P: Primitive>(scene: &SceneView<'_, P>, ray: Ray) -> Option<Hit> {
    ask(scene, ray, Wanted::Closest, &mut |_, _| ray.t_max)
}

/// Whether a ray hits anything; none as of [`closest_hit`].
pub(super) fn any_hit<P: Primitive>(scene: &SceneView<'_, P>, ray: Ray) -> Option<bool> {
    ask(scene, ray, Wanted::Any, &mut |_, _| ray.t_max).map(|hit| hit.is_hit)
}

/// Names each primitive that a ray meets at or before the limit that `meet` gives back, until that is
/// less than any number; none as of [`closest_hit`].
pub(super) fn candidates<P: Primitive>(
    scene: &SceneView<'_, P>,
    ray: Ray,
    meet: &mut Meet<'_, P>,
) -> Option<()> {
    ask(scene, ray, Wanted::Each, meet).map(|_| ())
}

/// What is called with each primitive, and gives the limit.
type Meet<'m, P> = dyn FnMut(&Part<'_, P, <P as Primitive>::Shared>, u32) -> f32 + 'm;

/// What is asked: not a type, for every copy of a walk is time that a user waits for a compiler.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Closest,
    Any,
    /// Every primitive that is met.
    Each,
}

#[inline(never)]
fn ask<P: Primitive>(
    scene: &SceneView<'_, P>,
    ray: Ray,
    wanted: Wanted,
    meet: &mut Meet<'_, P>,
) -> Option<Hit> {
    struct Ask<'a, 's, 'm, P: Primitive> {
        scene: &'a SceneView<'s, P>,
        ray: Ray,
        wanted: Wanted,
        pending: Pending<'a>,
        meet: &'a mut Meet<'m, P>,
    }
    impl<P: Primitive> LanesTask for Ask<'_, '_, '_, P> {
        type Output = Option<Hit>;

        fn run<R: Lanes>(self, r: R) -> Option<Hit> {
            let (e, Self { scene, ray, wanted, pending, meet }) = (r.eight(), self);
            e.vectorize(
                #[inline(always)]
                || each_part(Entered::new(e), scene, ray, wanted, pending, meet),
            )
        }
    }
    let pending = scene.parts().filter_map(|part| part.wide()).map(|tree| tree.pending).max();
    let room = pending? + 1 + WIDTH;
    // In one place, for every copy of a walk is time that a user waits for a compiler.
    let mut walk = |stacks: &mut [u32]| {
        let (children, enters) = stacks.split_at_mut(stacks.len() / 2);
        let pending = Pending { children, enters };
        with_wide_walks(None, Ask { scene, ray, wanted, pending, meet: &mut *meet })?
    };
    if room <= FEW {
        return walk(&mut [0; 2 * FEW]);
    }
    // A primitive may ask another scene meanwhile, which has stacks of its own then.
    let mut stacks = DEEP.take();
    if stacks.len() < 2 * room {
        stacks.resize(2 * room, 0);
    }
    let found = walk(&mut stacks);
    DEEP.set(stacks);
    found
}

/// Children that are to come, and where the ray enters them, as the bits of numbers above 0, in whose
/// last three the slot is.
struct Pending<'a> {
    children: &'a mut [u32],
    enters: &'a mut [u32],
}

#[inline(always)]
fn each_part<E: Lanes, P: Primitive>(
    e: E,
    scene: &SceneView<'_, P>,
    ray: Ray,
    wanted: Wanted,
    mut pending: Pending<'_>,
    meet: &mut Meet<'_, P>,
) -> Option<Hit> {
    let (mut best, mut limit) = (Hit::miss(), ray.t_max);
    if !is_finite(ray) {
        return Some(best);
    }
    let mut next = 0;
    while let Some(part) = scene.part(next) {
        next += 1;
        let Some(tree) = part.wide().filter(|tree| !tree.is_empty()) else { continue };
        let beam = Beam::of_one(&ray, limit, &tree.bounds(), Padding::of::<P>())?;
        let meeting = meeting(scene, part, tree);
        limit = walk(e, &meeting, &ray, (wanted, &mut *meet), beam, &mut pending, &mut best);
        if wanted == Wanted::Any && best.is_hit || limit == f32::NEG_INFINITY {
            break;
        }
    }
    Some(best)
}

#[inline(always)]
fn walk<E: Lanes, P: Primitive>(
    e: E,
    meeting: &Meeting<'_, P>,
    ray: &Ray,
    (wanted, meet): (Wanted, &mut Meet<'_, P>),
    mut beam: Beam,
    pending: &mut Pending<'_>,
    best: &mut Hit,
) -> f32 {
    let tree = meeting.tree;
    let on = Ray::splat(&Packet::new(e), *ray);
    let Pending { children: stack, enters } = pending;
    let (mut at, mut top) = (Child::node(0), 0);
    loop {
        if at.is_block() {
            counts::one(Event::Block);
            let block = meeting.rows(at.index());
            let best_t = match wanted {
                Wanted::Each => beam.limit,
                _ if best.is_hit => best.t,
                _ => f32::INFINITY,
            };
            let (hit, mask) = meeting.block(e, block, on, best_t);
            let mut met = e.bits(mask);
            let mut is_nearer = false;
            if wanted == Wanted::Any && met != 0 {
                best.is_hit = true;
                return beam.limit;
            }
            while met != 0 {
                let i = met.trailing_zeros() as usize;
                met &= met - 1;
                if wanted == Wanted::Each {
                    beam.limit = meet(&meeting.part, ids(block)[i]);
                    if beam.limit == f32::NEG_INFINITY {
                        return beam.limit;
                    }
                    continue;
                }
                let t = E::f32_lane(&hit.t.0, i);
                let prim_id = meeting.part.first + ids(block)[i];
                let (u, v) = (E::f32_lane(&hit.u.0, i), E::f32_lane(&hit.v.0, i));
                let hit = Hit { is_hit: true, t, prim_id, inst_id: 0, u, v };
                if is_before(false, hit, *best) {
                    *best = hit;
                    beam.limit = limit_behind(t, P::SLACK, ray.t_max);
                    is_nearer = true;
                }
            }
            counts::some(Event::Nearer, is_nearer.into());
        } else {
            counts::one(Event::Node);
            let node = &tree.nodes[at.index()];
            let (near, mask) = enter(e, node, &beam);
            let entered = e.bits(mask);
            if entered != 0 {
                let children = words(e, &node.children);
                let first;
                if wanted != Wanted::Any {
                    first = nearest(e, near, mask);
                    let keys = sorted(e, near, mask);
                    e.u32_store(e.u32_permute(children, keys), &mut stack[top..][..WIDTH]);
                    e.u32_store(keys, &mut enters[top..][..WIDTH]);
                } else {
                    first = entered.ilog2() as usize % WIDTH;
                    e.u32_store(e.u32_compress(children, mask), &mut stack[top..][..WIDTH]);
                }
                // What it enters first is the last of them, and no more to come.
                top += entered.count_ones() as usize - 1;
                at = Child(node.children[first]);
                continue;
            }
        }
        let last = last_key(beam.limit);
        at = loop {
            if top == 0 {
                return beam.limit;
            }
            top -= 1;
            if wanted == Wanted::Any || enters[top] & !7 <= last {
                break Child(stack[top]);
            }
        };
    }
}
