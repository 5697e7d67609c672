//! Traversal of wide trees by a single ray of the host.

use core::cell::Cell;

use super::beam::Beam;
use super::counts::{self, Event};
use super::node::{Child, WIDTH};
use super::step::{LeafIntersector, enter, ids, last_key, nearest, sorted, words};
use super::trace::leaf_intersector;
use crate::bvh::contract::{Padding, is_before, is_finite, limit_behind};
use crate::bvh::{Part, SceneView};
use crate::geometry::{Hit, Primitive, Ray};
use crate::machine::{Entered, Lanes, Packet, Type};
use crate::run::{LanesTask, with_wide_lanes};

/// Stack entries of a ray, enough for all but very deep trees. Fewer in unit tests, so that both
/// cases are tested.
const FEW: usize = if cfg!(test) { 24 } else { 96 };

thread_local! {
    /// Stacks for very deep trees, reused by the next ray.
    static DEEP: Cell<Vec<u32>> = const { Cell::new(Vec::new()) };
}

/// Finds the least `(t, id)` hit of a ray; none if the ray is degenerate.
pub(super) fn closest_hit<P: Primitive>(scene: &SceneView<'_, P>, ray: Ray) -> Option<Hit> {
    ask(scene, ray, Wanted::Closest, &mut |_, _| ray.t_max)
}

/// Finds whether a ray hits anything; none if the ray is degenerate.
pub(super) fn any_hit<P: Primitive>(scene: &SceneView<'_, P>, ray: Ray) -> Option<bool> {
    ask(scene, ray, Wanted::Any, &mut |_, _| ray.t_max).map(|hit| hit.is_hit)
}

/// Calls `visit` with each primitive that a ray hits up to the limit that the last call returned,
/// until that is negative infinity; none if the ray is degenerate.
pub(super) fn candidates<P: Primitive>(
    scene: &SceneView<'_, P>,
    ray: Ray,
    visit: &mut Visit<'_, P>,
) -> Option<()> {
    ask(scene, ray, Wanted::Each, visit).map(|_| ())
}

/// Callback with the id of a primitive in its part; returns the new limit.
type Visit<'m, P> = dyn FnMut(&Part<'_, P, <P as Primitive>::Shared>, u32) -> f32 + 'm;

/// The kind of a query: a value, not a type, since every copy of a traversal costs compile time.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Closest,
    Any,
    /// Every primitive that is hit.
    Each,
}

#[inline(never)]
fn ask<P: Primitive>(
    scene: &SceneView<'_, P>,
    ray: Ray,
    wanted: Wanted,
    visit: &mut Visit<'_, P>,
) -> Option<Hit> {
    struct Ask<'a, 's, 'm, P: Primitive> {
        scene: &'a SceneView<'s, P>,
        ray: Ray,
        wanted: Wanted,
        pending: Pending<'a>,
        visit: &'a mut Visit<'m, P>,
    }
    impl<P: Primitive> LanesTask for Ask<'_, '_, '_, P> {
        type Output = Option<Hit>;

        fn run<R: Lanes>(self, r: R) -> Option<Hit> {
            let (e, Self { scene, ray, wanted, pending, visit }) = (r.eight(), self);
            e.vectorize(
                #[inline(always)]
                || each_part(Entered::new(e), scene, ray, wanted, pending, visit),
            )
        }
    }
    let pending = scene.parts().filter_map(|part| part.wide()).map(|tree| tree.pending).max();
    let room = pending? + 1 + WIDTH;
    // Called in one place, since every copy of a traversal costs compile time.
    let mut traverse_with = |stacks: &mut [u32]| {
        let (children, enters) = stacks.split_at_mut(stacks.len() / 2);
        let pending = Pending { children, enters };
        with_wide_lanes(None, Ask { scene, ray, wanted, pending, visit: &mut *visit })?
    };
    if room <= FEW {
        return traverse_with(&mut [0; 2 * FEW]);
    }
    // A primitive may query another scene meanwhile, which allocates its own stacks then.
    let mut stacks = DEEP.take();
    if stacks.len() < 2 * room {
        stacks.resize(2 * room, 0);
    }
    let found = traverse_with(&mut stacks);
    DEEP.set(stacks);
    found
}

/// The stack of pending children, and their entry distances as the bits of floats above 0 with the
/// slot in the last three.
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
    visit: &mut Visit<'_, P>,
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
        let intersector = leaf_intersector(scene, part, tree);
        limit = traverse(e, &intersector, (&ray, wanted), beam, &mut pending, &mut best, visit);
        if wanted == Wanted::Any && best.is_hit || limit == f32::NEG_INFINITY {
            break;
        }
    }
    Some(best)
}

#[inline(always)]
fn traverse<E: Lanes, P: Primitive>(
    e: E,
    intersector: &LeafIntersector<'_, P>,
    (ray, wanted): (&Ray, Wanted),
    mut beam: Beam,
    pending: &mut Pending<'_>,
    best: &mut Hit,
    visit: &mut Visit<'_, P>,
) -> f32 {
    let tree = intersector.tree;
    let on = Ray::splat(&Packet::new(e), *ray);
    let Pending { children: stack, enters } = pending;
    let (mut at, mut top) = (Child::node(0), 0);
    loop {
        if at.is_block() {
            // Intersect a block.
            counts::one(Event::Block);
            let block = intersector.rows(at.index());
            let best_t = match wanted {
                Wanted::Each => beam.limit,
                _ if best.is_hit => best.t,
                _ => f32::INFINITY,
            };
            let (hit, mask) = intersector.intersect(e, at.index(), (on, &beam), best_t);
            let mut hits = e.bits(mask);
            let mut is_nearer = false;
            if wanted == Wanted::Any && hits != 0 {
                best.is_hit = true;
                return beam.limit;
            }
            // Report each hit, or keep the least.
            while hits != 0 {
                let i = hits.trailing_zeros() as usize;
                hits &= hits - 1;
                if wanted == Wanted::Each {
                    // A hit of this block may have lowered the limit.
                    if E::f32_lane(&hit.t.0, i) > beam.limit {
                        continue;
                    }
                    beam.limit = visit(&intersector.part, ids(block)[i]);
                    if beam.limit == f32::NEG_INFINITY {
                        return beam.limit;
                    }
                    continue;
                }
                let t = E::f32_lane(&hit.t.0, i);
                let prim_id = intersector.part.first + ids(block)[i];
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
            // Push the children that the ray enters; any-hit queries need no order.
            counts::one(Event::Node);
            let node = &tree.nodes[at.index()];
            let (near, mask) = enter(e, &node.planes, &beam);
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
                // The nearest child, or the last one, is visited next instead of being pushed.
                top += entered.count_ones() as usize - 1;
                at = Child(node.children[first]);
                continue;
            }
        }
        // Pop the next child within the limit.
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
