//! Lifted queries with a callback for each hit: those with a condition, and those for several hits.
//!
//! The machine visits the primitives; selecting the hits to keep is written here once, for all
//! machines.

use super::SceneView;
use super::contract::{is_before, limit_behind};
use super::on::{AllHits, ClosestHitWithCost, LocalRay, Slack};
use super::traverse::CostOn;
use crate::geometry::{Hit, HitOn, HitRecord, Kinds, Primitive, RayOn};
use crate::machine::{B, Branch, F, Machine, Type, U, Var, op};

/// The lifted result of `intersect` of a primitive.
pub(crate) type RecordOn<M, P> = <<P as Primitive>::Hit as Type>::On<M>;

/// Finds the least `(t, id)` hit, and counts the cost of each ray as if it were traced by itself.
#[inline(always)]
pub(super) fn closest_with_cost_on<M: Machine, P: Primitive>(
    m: &M,
    prims: &SceneView<'_, P>,
    ray: RayOn<M>,
) -> (RecordOn<M, P>, CostOn<M>) {
    let counted = m.perform(&ClosestHitWithCost(prims), ray);
    (record_on(m, prims, ray, counted.hit), counted.cost)
}

/// Completes the record of a hit: traversals keep only the hit itself, and the rest is computed
/// again for the primitive that was hit.
#[inline(always)]
pub(crate) fn record_on<M: Machine, P: Primitive>(
    m: &M,
    prims: &SceneView<'_, P>,
    ray: RayOn<M>,
    hit: HitOn<M>,
) -> RecordOn<M, P> {
    P::Hit::complete_on(
        m,
        hit,
        #[inline(always)]
        || {
            // A recorder omits the kinds that the scene does not have.
            let kinds = if M::RUNS { Kinds::ALL } else { prims.kinds() };
            let prim = m.fetch(prims, U(hit.prim_id.0));
            let ray = match prims.placed() {
                Some(_) => m.perform(&LocalRay(prims), (ray, hit.inst_id)),
                None => ray,
            };
            P::intersect_among_on(m, kinds, prim, ray, prims.shared())
        },
    )
}

/// Returns the distance beyond which no node can hold a hit before `worst`; the ray's end if there
/// is no such hit.
#[inline(always)]
pub(super) fn limit_of<M: Machine, P: Primitive>(
    m: &M,
    prims: &SceneView<'_, P>,
    worst: HitOn<M>,
    ray: RayOn<M>,
) -> F<M> {
    let limit = limit_behind::on(m, worst.t, m.perform(&Slack(prims), ()), ray.t_max);
    F(m.f32_select(worst.is_hit.0, limit.0, ray.t_max.0))
}

/// Returns whether the hits of a scene have instance ids.
#[inline(always)]
pub(super) fn is_placed<P: Primitive>(prims: &SceneView<'_, P>) -> bool {
    prims.placed().is_some()
}

/// Finds the least `(t, id)` hit of those that `accept` accepts.
#[inline(always)]
pub(crate) fn closest_where<M: Machine, P: Primitive>(
    m: &M,
    prims: &SceneView<'_, P>,
    ray: RayOn<M>,
    accept: &impl Fn(RecordOn<M, P>) -> B<M>,
) -> HitOn<M> {
    let best = Var::<HitOn<M>>::new(m, "best", Hit::splat(m, Hit::miss()));
    m.visit(
        &AllHits(prims),
        ray,
        #[inline(always)]
        || limit_of(m, prims, best.get(m), ray),
        #[inline(always)]
        |(hit, record)| {
            let is_closer = Branch::new(m, is_before::on(m, is_placed(prims), hit, best.get(m)));
            if is_closer.then(m) {
                let accepted = Branch::new(m, accept(record));
                if accepted.then(m) {
                    best.set(m, hit);
                }
                accepted.end(m);
            }
            is_closer.end(m);
            B(m.bool(true))
        },
    );
    best.get(m)
}

/// Finds whether there is a hit that `accept` accepts.
#[inline(always)]
pub(crate) fn any_where<M: Machine, P: Primitive>(
    m: &M,
    prims: &SceneView<'_, P>,
    ray: RayOn<M>,
    accept: &impl Fn(RecordOn<M, P>) -> B<M>,
) -> B<M> {
    let found = Var::<B<M>>::new(m, "found", B(m.bool(false)));
    m.visit(
        &AllHits(prims),
        ray,
        #[inline(always)]
        || ray.t_max,
        #[inline(always)]
        |(_, record)| {
            let accepted = accept(record);
            found.set(m, accepted);
            B(m.bool_not(accepted.0))
        },
    );
    found.get(m)
}

/// Finds the `N` least `(t, id)` hits of those that `accept` accepts, in order.
#[inline(always)]
pub(super) fn multi_where<M: Machine, P: Primitive, const N: usize>(
    m: &M,
    prims: &SceneView<'_, P>,
    ray: RayOn<M>,
    accept: &impl Fn(RecordOn<M, P>) -> B<M>,
) -> [RecordOn<M, P>; N] {
    first_hits(
        m,
        prims,
        ray,
        #[inline(always)]
        |last| limit_of(m, prims, last, ray),
        #[inline(always)]
        |a, b| is_before::on(m, is_placed(prims), a, b),
        accept,
    )
}

/// Finds the first `N` hits in the order of `is_closer`.
#[inline(always)]
pub(super) fn multi_by<M: Machine, P: Primitive, const N: usize>(
    m: &M,
    prims: &SceneView<'_, P>,
    ray: RayOn<M>,
    is_closer: &impl Fn(HitOn<M>, HitOn<M>) -> B<M>,
) -> [RecordOn<M, P>; N] {
    first_hits(
        m,
        prims,
        ray,
        #[inline(always)]
        |_| ray.t_max,
        #[inline(always)]
        |a, b| is_before_by(m, is_placed(prims), is_closer, a, b),
        &|_| B(m.bool(true)),
    )
}

/// Returns whether `a` precedes `b` in the order of `is_closer`, then of `(t, inst_id, prim_id)`.
/// `is_closer` is not called with a miss.
#[inline(always)]
pub(super) fn is_before_by<M: Machine>(
    m: &M,
    is_placed: bool,
    is_closer: &impl Fn(HitOn<M>, HitOn<M>) -> B<M>,
    a: HitOn<M>,
    b: HitOn<M>,
) -> B<M> {
    let first = Var::<B<M>>::new(m, "is_first", B(m.bool(true)));
    let both = Branch::new(m, b.is_hit);
    if both.then(m) {
        // Both (as with `<=`) or neither is a tie.
        let (closer, farther) = (is_closer(a, b).0, is_closer(b, a).0);
        let differ = m.bool_binary(op::Xor, closer, farther);
        first.set(m, B(m.bool_select(differ, closer, is_before::on(m, is_placed, a, b).0)));
    }
    both.end(m);
    first.get(m)
}

/// Finds the first `N` hits in some order of those that `accept` accepts. Nodes beyond `limit` of
/// the last of them are culled.
#[inline(always)]
fn first_hits<M: Machine, P: Primitive, const N: usize>(
    m: &M,
    prims: &SceneView<'_, P>,
    ray: RayOn<M>,
    limit: impl Fn(HitOn<M>) -> F<M>,
    is_before: impl Fn(HitOn<M>, HitOn<M>) -> B<M>,
    accept: &impl Fn(RecordOn<M, P>) -> B<M>,
) -> [RecordOn<M, P>; N] {
    const { assert!(N > 0, "a query of no hits has no result") };
    let all = Var::<[HitOn<M>; N]>::new(m, "hits", [Hit::splat(m, Hit::miss()); N]);
    m.visit(
        &AllHits(prims),
        ray,
        #[inline(always)]
        || limit(all.get(m)[N - 1]),
        #[inline(always)]
        |(hit, record)| {
            let hits = all.get(m);
            let fits = m.bool_binary(
                op::And,
                is_before(hit, hits[N - 1]).0,
                m.bool_not(is_among(m, is_placed(prims), hit, &hits)),
            );
            let fits = Branch::new(m, B(fits));
            if fits.then(m) {
                let accepted = Branch::new(m, accept(record));
                if accepted.then(m) {
                    all.set(m, inserted(m, &is_before, |c, a, b| select(m, c, a, b), hit, hits));
                }
                accepted.end(m);
            }
            fits.end(m);
            B(m.bool(true))
        },
    );
    all.get(m).map(
        #[inline(always)]
        |hit| record_on(m, prims, ray, hit),
    )
}

/// Returns whether the hit has been inserted already: trees with spatial splits hold a primitive
/// more than once.
#[inline(always)]
fn is_among<M: Machine, const N: usize>(
    m: &M,
    is_placed: bool,
    hit: HitOn<M>,
    hits: &[HitOn<M>; N],
) -> M::Bool {
    let and = |x, y| m.bool_binary(op::And, x, y);
    hits.iter().fold(m.bool(false), |any, h| {
        let mut same = m.u32_compare(op::Eq, h.prim_id.0, hit.prim_id.0);
        if is_placed {
            same = and(same, m.u32_compare(op::Eq, h.inst_id.0, hit.inst_id.0));
        }
        m.bool_binary(op::Or, any, and(same, h.is_hit.0))
    })
}

/// Inserts a hit at its place in the order; the last one is dropped.
#[inline(always)]
pub(super) fn inserted<M: Machine, V: Copy, const N: usize>(
    m: &M,
    is_before: impl Fn(V, V) -> B<M>,
    select: impl Fn(B<M>, V, V) -> V,
    hit: V,
    mut hits: [V; N],
) -> [V; N] {
    // All hits after the first later one are later; the last one is, or nothing would be inserted.
    let mut carried = hit;
    let mut found = B(m.bool(false));
    let (last, others) = match hits.split_last_mut() {
        Some(parts) => parts,
        None => return hits,
    };
    for slot in others {
        let before = is_before(hit, *slot);
        found = B(m.bool_binary(op::Or, found.0, before.0));
        let kept = select(found, carried, *slot);
        carried = select(found, *slot, carried);
        *slot = kept;
    }
    *last = carried;
    hits
}

#[inline(always)]
pub(super) fn select<M: Machine>(m: &M, c: B<M>, a: HitOn<M>, b: HitOn<M>) -> HitOn<M> {
    HitOn {
        is_hit: B(m.bool_select(c.0, a.is_hit.0, b.is_hit.0)),
        t: F(m.f32_select(c.0, a.t.0, b.t.0)),
        prim_id: U(m.u32_select(c.0, a.prim_id.0, b.prim_id.0)),
        inst_id: U(m.u32_select(c.0, a.inst_id.0, b.inst_id.0)),
        u: F(m.f32_select(c.0, a.u.0, b.u.0)),
        v: F(m.f32_select(c.0, a.v.0, b.v.0)),
    }
}
