//! Traversal for one ray: the yardstick of every other.

use core::mem::MaybeUninit;

use super::slabs::Slabs;
use super::{MAX_DEPTH, Node, Part, SceneView};
use crate::geometry::{Hit, HitRecord, Primitive, Ray};

/// Entries of a traversal's stack: one a level.
pub(crate) const STACK: usize = MAX_DEPTH + 2;

/// Subtrees yet to be visited, and where the rays enter them.
///
/// Left uninitialised: its kilobytes would cost a packet as much as a dozen nodes.
pub(super) struct Stack<E> {
    top: usize,
    nodes: [MaybeUninit<u32>; STACK],
    enters: [MaybeUninit<E>; STACK],
}

impl<E: Copy> Stack<E> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        let (nodes, enters) = ([MaybeUninit::uninit(); STACK], [MaybeUninit::uninit(); STACK]);
        Self { top: 0, nodes, enters }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, node: u32, enter: E) {
        self.nodes[self.top].write(node);
        self.enters[self.top].write(enter);
        self.top += 1;
    }

    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<(u32, E)> {
        self.top = self.top.checked_sub(1)?;
        // SAFETY: `push` alone raises `top`, after it has written the entry below.
        Some(unsafe { (self.nodes[self.top].assume_init(), self.enters[self.top].assume_init()) })
    }
}

/// A ray with a NaN or an infinite component misses everything.
#[inline(always)]
fn is_finite(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.direction.is_finite()
}

/// Whether there is a hit, within the ray's range.
#[inline(always)]
fn is_met(hit: &Hit, ray: &Ray) -> bool {
    hit.is_hit && hit.t >= ray.t_min && hit.t <= ray.t_max
}

/// Whether a hit at `t` of the primitive `id` comes before `best` in the order of `(t, id)`; any hit
/// comes before a miss.
#[inline(always)]
fn is_before(t: f32, id: u32, best: &Hit) -> bool {
    !best.is_hit || t < best.t || (t == best.t && id < best.prim_id)
}

/// What a traversal did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Nodes whose box was tested.
    pub nodes: u32,
    /// Primitives that were intersected.
    pub primitives: u32,
}

/// Counts what a traversal does, or does not: [`Uncounted`] leaves no trace in the code.
trait Count {
    fn nodes(&mut self, _: u32) {}
    fn primitive(&mut self) {}
}

struct Uncounted;

impl Count for Uncounted {}

impl Count for Cost {
    fn nodes(&mut self, n: u32) {
        self.nodes += n;
    }

    fn primitive(&mut self) {
        self.primitives += 1;
    }
}

/// The least `(t, id)` hit of `ray` among `prims`.
pub fn closest_hit<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> P::Hit {
    complete(prims, ray, nearest(prims, ray))
}

/// [`closest_hit`] without the rest of the record.
#[inline(always)]
pub(crate) fn nearest<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> Hit {
    closest(prims, ray, &mut Uncounted)
}

/// The record of a hit: traversal carries the hit alone.
#[inline(always)]
fn complete<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray, hit: Hit) -> P::Hit {
    let again = || prims.get(hit.prim_id).intersect(ray, prims.shared().elements());
    P::Hit::complete(hit, again)
}

/// [`closest_hit`], and what it cost.
pub fn closest_hit_with_cost<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> (P::Hit, Cost) {
    let mut cost = Cost::default();
    let hit = closest(prims, ray, &mut cost);
    (complete(prims, ray, hit), cost)
}

#[inline(always)]
fn closest<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray, count: &mut impl Count) -> Hit {
    let mut best = Hit::miss();
    walk_all(prims, ray, count, |part, id, limit| {
        let hit = part.prims[id as usize].intersect(ray, part.shared).hit();
        let id = part.first + id;
        if is_met(&hit, &ray) && is_before(hit.t, id, &best) {
            best = Hit { prim_id: id, ..hit };
            *limit = beyond::<P>(&hit, &ray);
        }
        false
    });
    best
}

/// Whether `ray` hits any of `prims`.
pub fn any_hit<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> bool {
    walk_all(prims, ray, &mut Uncounted, |part, id, _| {
        is_met(&part.prims[id as usize].intersect(ray, part.shared).hit(), &ray)
    })
}

/// Calls `meet` for every hit within the ray's range until it returns false. It may lower the limit
/// of the distance. Farther hits may come before nearer ones.
#[inline(always)]
pub(crate) fn visit<P: Primitive>(
    prims: &SceneView<'_, P>,
    ray: Ray,
    mut meet: impl FnMut(Hit, P::Hit, &mut f32) -> bool,
) -> bool {
    !walk_all(prims, ray, &mut Uncounted, |part, id, limit| {
        let record = part.prims[id as usize].intersect(ray, part.shared);
        let hit = Hit { prim_id: part.first + id, ..record.hit() };
        is_met(&hit, &ray) && !meet(hit, record.with_hit(hit), limit)
    })
}

/// The least `(t, id)` hit of those that `accept` accepts.
pub fn closest_hit_where<P: Primitive>(
    prims: &SceneView<'_, P>,
    ray: Ray,
    accept: impl Fn(P::Hit) -> bool,
) -> P::Hit {
    let mut best = Hit::miss();
    visit::<P>(prims, ray, |hit, record, limit| {
        if is_before(hit.t, hit.prim_id, &best) && accept(record) {
            best = hit;
            *limit = beyond::<P>(&hit, &ray);
        }
        true
    });
    complete(prims, ray, best)
}

/// Whether there is a hit that `accept` accepts.
pub fn any_hit_where<P: Primitive>(
    prims: &SceneView<'_, P>,
    ray: Ray,
    accept: impl Fn(P::Hit) -> bool,
) -> bool {
    !visit::<P>(prims, ray, |_, record, _| !accept(record))
}

/// The `N` least `(t, id)` hits of those that `accept` accepts, in order; misses behind them.
pub fn multi_hit_where<P: Primitive, const N: usize>(
    prims: &SceneView<'_, P>,
    ray: Ray,
    accept: impl Fn(P::Hit) -> bool,
) -> [P::Hit; N] {
    let mut hits = FirstHits::<N>::new();
    visit::<P>(prims, ray, |hit, record, limit| {
        let place = hits.place(hit, |h| is_before(hit.t, hit.prim_id, h));
        if let Some(place) = place
            && accept(record)
        {
            hits.insert(place, hit);
            if hits.last().is_hit {
                *limit = beyond::<P>(hits.last(), &ray);
            }
        }
        true
    });
    hits.0.map(|hit| complete(prims, ray, hit))
}

/// The first `N` hits in the order of `is_closer`; misses behind them.
pub fn multi_hit_by<P: Primitive, const N: usize>(
    prims: &SceneView<'_, P>,
    ray: Ray,
    is_closer: impl Fn(Hit, Hit) -> bool,
) -> [P::Hit; N] {
    let mut hits = FirstHits::<N>::new();
    visit::<P>(prims, ray, |hit, _, _| {
        let is_first = |h: &Hit| {
            if !h.is_hit {
                return true;
            }
            // Where both hold, as with `<=`, or neither, it is a tie.
            let (closer, farther) = (is_closer(hit, *h), is_closer(*h, hit));
            if closer != farther { closer } else { is_before(hit.t, hit.prim_id, h) }
        };
        if let Some(place) = hits.place(hit, is_first) {
            hits.insert(place, hit);
        }
        true
    });
    hits.0.map(|hit| complete(prims, ray, hit))
}

/// The first hits in some order, with misses behind them.
struct FirstHits<const N: usize>([Hit; N]);

impl<const N: usize> FirstHits<N> {
    fn new() -> Self {
        const { assert!(N > 0, "a query of no hits has no result") };
        Self([Hit::miss(); N])
    }

    /// Where a hit belongs, if it is among the first. `is_first` says whether it comes before one.
    fn place(&self, hit: Hit, is_first: impl Fn(&Hit) -> bool) -> Option<usize> {
        // A tree with spatial splits holds a primitive more than once.
        let is_there = || self.0.iter().any(|h| h.is_hit && h.prim_id == hit.prim_id);
        if !is_first(self.last()) || is_there() {
            return None;
        }
        self.0.iter().position(is_first)
    }

    fn insert(&mut self, place: usize, hit: Hit) {
        self.0[place..].rotate_right(1);
        self.0[place] = hit;
    }

    fn last(&self) -> &Hit {
        &self.0[N - 1]
    }
}

/// No node beyond this distance can hold a hit before `hit`; the ray's end if that is no number.
fn beyond<P: Primitive>(hit: &Hit, ray: &Ray) -> f32 {
    (hit.t + hit.t.abs() * P::SLACK).min(ray.t_max)
}

/// [`walk`] through one part after another. A ray with a component that is no finite number meets
/// nothing.
#[inline(always)]
fn walk_all<P: Primitive>(
    prims: &SceneView<'_, P>,
    ray: Ray,
    count: &mut impl Count,
    mut visit: impl FnMut(&Part<'_, P, P::Shared>, u32, &mut f32) -> bool,
) -> bool {
    if !is_finite(&ray) {
        return false;
    }
    // No node beyond this distance is worth a visit.
    let mut limit = ray.t_max;
    prims.parts().any(|part| walk(&part, ray, &mut limit, count, &mut visit))
}

/// Visits the primitives that the ray may meet, those of nearer leaves first, until `visit` returns
/// true; whether it did. `visit` may lower the limit of the distance.
#[inline(always)]
fn walk<P: Primitive>(
    part: &Part<'_, P, P::Shared>,
    ray: Ray,
    limit: &mut f32,
    count: &mut impl Count,
    visit: &mut impl FnMut(&Part<'_, P, P::Shared>, u32, &mut f32) -> bool,
) -> bool {
    let Some(tree) = part.tree else {
        return (0..part.prims.len() as u32).any(|id| {
            count.primitive();
            visit(part, id, limit)
        });
    };
    let Some(root) = tree.nodes.first() else { return false };
    let slabs = Slabs::new(&ray, root, P::SLACK);
    count.nodes(1);
    if slabs.enter(root, *limit).is_none() {
        return false;
    }
    let mut stack = Stack::new();
    let mut node: &Node = root;
    loop {
        if node.is_leaf() {
            let (first, len) = (node.first as usize, node.count as usize);
            for &id in &tree.indices[first..first + len] {
                count.primitive();
                if visit(part, id, limit) {
                    return true;
                }
            }
        } else {
            let children = &tree.nodes[node.first as usize..node.first as usize + 2];
            count.nodes(2);
            match (slabs.enter(&children[0], *limit), slabs.enter(&children[1], *limit)) {
                (Some(left), Some(right)) => {
                    let near = usize::from(right < left);
                    stack.push(node.first + 1 - near as u32, left.max(right));
                    node = &children[near];
                    continue;
                }
                (Some(_), None) => {
                    node = &children[0];
                    continue;
                }
                (None, Some(_)) => {
                    node = &children[1];
                    continue;
                }
                (None, None) => {}
            }
        }
        node = loop {
            let Some((index, enter)) = stack.pop() else { return false };
            if enter <= *limit {
                break &tree.nodes[index as usize];
            }
        };
    }
}
