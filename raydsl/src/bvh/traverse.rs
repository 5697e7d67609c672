//! Traversal for one ray: the yardstick of every other.

use core::mem::MaybeUninit;

use super::slabs::Slabs;
use super::{MAX_DEPTH, Node, On};
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
pub fn closest_hit<P: Primitive>(prims: &On<'_, P>, ray: Ray) -> P::Hit {
    complete(prims, ray, nearest(prims, ray))
}

/// [`closest_hit`] without the rest of the record.
#[inline(always)]
pub(crate) fn nearest<P: Primitive>(prims: &On<'_, P>, ray: Ray) -> Hit {
    closest(prims, ray, &mut Uncounted)
}

/// The record of a hit: traversal carries the hit alone.
#[inline(always)]
fn complete<P: Primitive>(prims: &On<'_, P>, ray: Ray, hit: Hit) -> P::Hit {
    P::Hit::complete(hit, || prims.get(hit.prim_id).intersect(ray))
}

/// [`closest_hit`], and what it cost.
pub fn closest_hit_with_cost<P: Primitive>(prims: &On<'_, P>, ray: Ray) -> (P::Hit, Cost) {
    let mut cost = Cost::default();
    let hit = closest(prims, ray, &mut cost);
    (complete(prims, ray, hit), cost)
}

#[inline(always)]
fn closest<P: Primitive>(prims: &On<'_, P>, ray: Ray, count: &mut impl Count) -> Hit {
    let mut best = Hit::miss();
    if !is_finite(&ray) {
        return best;
    }
    if !prims.has_tree() {
        for (id, p) in prims.prims.iter().enumerate() {
            count.primitive();
            let (hit, id) = (p.intersect(ray).hit(), id as u32);
            if is_met(&hit, &ray) && is_before(hit.t, id, &best) {
                best = Hit { prim_id: id, ..hit };
            }
        }
        return best;
    }
    walk(prims, ray, P::SLACK, count, |id, limit| {
        let hit = prims.prims[id as usize].intersect(ray).hit();
        if is_met(&hit, &ray) && is_before(hit.t, id, &best) {
            best = Hit { prim_id: id, ..hit };
            *limit = beyond::<P>(&hit, &ray);
        }
        false
    });
    best
}

/// Whether `ray` hits any of `prims`.
pub fn any_hit<P: Primitive>(prims: &On<'_, P>, ray: Ray) -> bool {
    let accepts = |p: &P| is_met(&p.intersect(ray).hit(), &ray);
    if !is_finite(&ray) {
        return false;
    }
    if !prims.has_tree() {
        return prims.prims.iter().any(accepts);
    }
    let mut found = false;
    walk(prims, ray, P::SLACK, &mut Uncounted, |id, _| {
        found = accepts(&prims.prims[id as usize]);
        found
    });
    found
}

/// Calls `meet` for every hit within the ray's range until it returns false. It may lower the limit
/// of the distance. Farther hits may come before nearer ones.
pub(crate) fn visit<P: Primitive>(
    prims: &On<'_, P>,
    ray: Ray,
    mut meet: impl FnMut(Hit, &mut f32) -> bool,
) {
    if !is_finite(&ray) {
        return;
    }
    let mut stops = |id: u32, limit: &mut f32| {
        let hit = prims.prims[id as usize].intersect(ray).hit();
        is_met(&hit, &ray) && !meet(Hit { prim_id: id, ..hit }, limit)
    };
    if prims.has_tree() {
        return walk(prims, ray, P::SLACK, &mut Uncounted, stops);
    }
    let mut limit = ray.t_max;
    let _ = (0..prims.prims.len() as u32).any(|id| stops(id, &mut limit));
}

/// The least `(t, id)` hit of those that `accept` accepts.
pub fn closest_hit_where<P: Primitive>(
    prims: &On<'_, P>,
    ray: Ray,
    accept: impl Fn(Hit) -> bool,
) -> P::Hit {
    let mut best = Hit::miss();
    visit(prims, ray, |hit, limit| {
        if is_before(hit.t, hit.prim_id, &best) && accept(hit) {
            best = hit;
            *limit = beyond::<P>(&hit, &ray);
        }
        true
    });
    complete(prims, ray, best)
}

/// Whether there is a hit that `accept` accepts.
pub fn any_hit_where<P: Primitive>(
    prims: &On<'_, P>,
    ray: Ray,
    accept: impl Fn(Hit) -> bool,
) -> bool {
    let mut found = false;
    visit(prims, ray, |hit, _| {
        found = accept(hit);
        !found
    });
    found
}

/// The `N` least `(t, id)` hits of those that `accept` accepts, in order; misses behind them.
pub fn multi_hit_where<P: Primitive, const N: usize>(
    prims: &On<'_, P>,
    ray: Ray,
    accept: impl Fn(Hit) -> bool,
) -> [Hit; N] {
    const { assert!(N > 0, "a query of no hits has no result") };
    let mut hits = [Hit::miss(); N];
    visit(prims, ray, |hit, limit| {
        // A tree with spatial splits holds a primitive more than once.
        let is_there = hits.iter().any(|h| h.is_hit && h.prim_id == hit.prim_id);
        if is_before(hit.t, hit.prim_id, &hits[N - 1]) && !is_there && accept(hit) {
            let is_place = |h: &Hit| is_before(hit.t, hit.prim_id, h);
            let at = hits.iter().position(is_place).unwrap_or(N - 1);
            hits[at..].rotate_right(1);
            hits[at] = hit;
            if hits[N - 1].is_hit {
                *limit = beyond::<P>(&hits[N - 1], &ray);
            }
        }
        true
    });
    hits
}

/// No node beyond this distance can hold a hit before `hit`; the ray's end if that is no number.
fn beyond<P: Primitive>(hit: &Hit, ray: &Ray) -> f32 {
    (hit.t + hit.t.abs() * P::SLACK).min(ray.t_max)
}

/// Visits the primitives of every leaf that the ray may meet, nearer ones first, until `visit`
/// returns true. `visit` may lower the limit of the distance.
#[inline(always)]
fn walk<P: Primitive>(
    prims: &On<'_, P>,
    ray: Ray,
    slack: f32,
    count: &mut impl Count,
    mut visit: impl FnMut(u32, &mut f32) -> bool,
) {
    let Some(root) = prims.nodes.first() else { return };
    let slabs = Slabs::new(&ray, root, slack);
    // No node beyond this distance is worth a visit.
    let mut limit = ray.t_max;
    count.nodes(1);
    if slabs.enter(root, limit).is_none() {
        return;
    }
    let mut stack = Stack::new();
    let mut node: &Node = root;
    loop {
        if node.is_leaf() {
            let (first, len) = (node.first as usize, node.count as usize);
            for &id in &prims.indices[first..first + len] {
                count.primitive();
                if visit(id, &mut limit) {
                    return;
                }
            }
        } else {
            let children = &prims.nodes[node.first as usize..node.first as usize + 2];
            count.nodes(2);
            match (slabs.enter(&children[0], limit), slabs.enter(&children[1], limit)) {
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
            let Some((index, enter)) = stack.pop() else { return };
            if enter <= limit {
                break &prims.nodes[index as usize];
            }
        };
    }
}
