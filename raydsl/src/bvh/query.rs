//! Lifted queries that ask the kernel about each hit: those with a condition, and of several hits.
//!
//! The machine visits the primitives; what is kept of them is said here once, for all machines.

use super::On;
use crate::geometry::{Hit, HitOn, HitRecord, Kinds, Primitive, RayOn};
use crate::machine::{
    B, BoolBinary, Branch, Coerce, Compare, Const, F, F32Binary, F32Unary, Machine, Method, Type,
    U, Var, name,
};

/// The record of the least `(t, id)` hit: traversal carries the hit alone, and the rest is computed
/// once more for the primitive that was hit.
#[inline(always)]
pub(crate) fn closest_on<M: Machine, P: Primitive>(
    m: &M,
    prims: &On<'_, P>,
    ray: RayOn<M>,
) -> <P::Hit as Type>::On<M> {
    let hit = m.closest_hit(prims, ray);
    record_on(m, prims, ray, hit)
}

#[inline(always)]
fn record_on<M: Machine, P: Primitive>(
    m: &M,
    prims: &On<'_, P>,
    ray: RayOn<M>,
    hit: HitOn<M>,
) -> <P::Hit as Type>::On<M> {
    P::Hit::complete_on(
        m,
        hit,
        #[inline(always)]
        || {
            // A recorder leaves out the kinds that the scene does not have.
            let kinds = if M::RUNS { Kinds::ALL } else { prims.kinds() };
            P::intersect_among_on(m, kinds, m.fetch(prims, U(hit.prim_id.0)), ray)
        },
    )
}

/// Whether `a` comes before `b` in the order of `(t, id)`; any hit comes before a miss.
#[inline(always)]
fn is_before<M: Machine>(m: &M, a: HitOn<M>, b: HitOn<M>) -> B<M> {
    let and = |x, y| m.bool_binary(BoolBinary::And, x, y);
    let or = |x, y| m.bool_binary(BoolBinary::Or, x, y);
    let nearer = m.f32_compare(Compare::Lt, a.t.0, b.t.0);
    let equal = m.f32_compare(Compare::Eq, a.t.0, b.t.0);
    let first = m.u32_compare(Compare::Lt, a.prim_id.0, b.prim_id.0);
    B(or(m.bool_not(b.is_hit.0), or(nearer, and(equal, first))))
}

/// No node beyond this distance can hold a hit before `worst`; the ray's end if there is none.
#[inline(always)]
fn limit_of<M: Machine, P: Primitive>(m: &M, worst: HitOn<M>, ray: RayOn<M>) -> F<M> {
    let slack = m.f32_unary(F32Unary::Abs, worst.t.0);
    let slack = m.f32_binary(F32Binary::Mul, slack, m.f32(P::SLACK));
    let limit = m.f32_binary(F32Binary::Add, worst.t.0, slack);
    // In this order what is no number becomes the ray's end.
    let limit = m.f32_binary(F32Binary::Min, ray.t_max.0, limit);
    F(m.f32_select(worst.is_hit.0, limit, ray.t_max.0))
}

/// The least `(t, id)` hit of those that `accept` accepts.
#[inline(always)]
fn closest_where<M: Machine, P: Primitive>(
    m: &M,
    prims: &On<'_, P>,
    ray: RayOn<M>,
    accept: &impl Fn(HitOn<M>) -> B<M>,
) -> HitOn<M> {
    let best = Var::<HitOn<M>>::new(m, "best", Hit::splat(m, Hit::miss()));
    m.visit(
        prims,
        ray,
        #[inline(always)]
        || limit_of::<M, P>(m, best.get(m), ray),
        #[inline(always)]
        |hit| {
            let is_closer = Branch::new(m, is_before(m, hit, best.get(m)));
            if is_closer.then(m) {
                let accepted = Branch::new(m, accept(hit));
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

/// Whether there is a hit that `accept` accepts.
#[inline(always)]
fn any_where<M: Machine, P: Primitive>(
    m: &M,
    prims: &On<'_, P>,
    ray: RayOn<M>,
    accept: &impl Fn(HitOn<M>) -> B<M>,
) -> B<M> {
    let found = Var::<B<M>>::new(m, "found", B(m.bool(false)));
    m.visit(
        prims,
        ray,
        #[inline(always)]
        || ray.t_max,
        #[inline(always)]
        |hit| {
            let accepted = accept(hit);
            found.set(m, accepted);
            B(m.bool_not(accepted.0))
        },
    );
    found.get(m)
}

/// The `N` least `(t, id)` hits of those that `accept` accepts, in order.
#[inline(always)]
fn multi_where<M: Machine, P: Primitive, const N: usize>(
    m: &M,
    prims: &On<'_, P>,
    ray: RayOn<M>,
    accept: &impl Fn(HitOn<M>) -> B<M>,
) -> [HitOn<M>; N] {
    const { assert!(N > 0, "a query of no hits has no result") };
    let all = Var::<[HitOn<M>; N]>::new(m, "hits", [Hit::splat(m, Hit::miss()); N]);
    m.visit(
        prims,
        ray,
        #[inline(always)]
        || limit_of::<M, P>(m, all.get(m)[N - 1], ray),
        #[inline(always)]
        |hit| {
            let hits = all.get(m);
            let fits = m.bool_binary(
                BoolBinary::And,
                is_before(m, hit, hits[N - 1]).0,
                m.bool_not(is_among(m, hit, &hits)),
            );
            let fits = Branch::new(m, B(fits));
            if fits.then(m) {
                let accepted = Branch::new(m, accept(hit));
                if accepted.then(m) {
                    all.set(m, inserted(m, hit, hits));
                }
                accepted.end(m);
            }
            fits.end(m);
            B(m.bool(true))
        },
    );
    all.get(m)
}

/// Whether the hit is there already: a tree with spatial splits holds a primitive more than once.
#[inline(always)]
fn is_among<M: Machine, const N: usize>(m: &M, hit: HitOn<M>, hits: &[HitOn<M>; N]) -> M::Bool {
    hits.iter().fold(m.bool(false), |any, h| {
        let same = m.u32_compare(Compare::Eq, h.prim_id.0, hit.prim_id.0);
        let same = m.bool_binary(BoolBinary::And, same, h.is_hit.0);
        m.bool_binary(BoolBinary::Or, any, same)
    })
}

/// The hits with one more in its place; the last one falls out.
#[inline(always)]
fn inserted<M: Machine, const N: usize>(
    m: &M,
    hit: HitOn<M>,
    mut hits: [HitOn<M>; N],
) -> [HitOn<M>; N] {
    let mut carried = hit;
    for slot in &mut hits {
        let takes = is_before(m, carried, *slot);
        let here = select(m, takes, carried, *slot);
        carried = select(m, takes, *slot, carried);
        *slot = here;
    }
    hits
}

#[inline(always)]
fn select<M: Machine>(m: &M, c: B<M>, a: HitOn<M>, b: HitOn<M>) -> HitOn<M> {
    HitOn {
        is_hit: B(m.bool_select(c.0, a.is_hit.0, b.is_hit.0)),
        t: F(m.f32_select(c.0, a.t.0, b.t.0)),
        prim_id: U(m.u32_select(c.0, a.prim_id.0, b.prim_id.0)),
        u: F(m.f32_select(c.0, a.u.0, b.u.0)),
        v: F(m.f32_select(c.0, a.v.0, b.v.0)),
    }
}

/// `accept`, a closure of the kernel, as a condition of the machine.
#[inline(always)]
fn condition<M: Machine, R: Coerce<M, B<M>>>(
    m: &M,
    accept: &impl Fn(&M, HitOn<M>) -> R,
    hit: HitOn<M>,
) -> B<M> {
    accept(m, hit).coerce(m)
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("closest_hit") }, M, (RayOn<M>,)> for On<'_, P> {
    type Output = <P::Hit as Type>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (ray,): (RayOn<M>,)) -> Self::Output {
        closest_on(m, &self, ray)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("any_hit") }, M, (RayOn<M>,)> for On<'_, P> {
    type Output = B<M>;

    #[inline(always)]
    fn call(self, m: &M, (ray,): (RayOn<M>,)) -> B<M> {
        m.any_hit(&self, ray)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive, const N: usize>
    Method<{ name("multi_hit") }, M, (Const<N>, RayOn<M>)> for On<'_, P>
{
    type Output = [HitOn<M>; N];

    #[inline(always)]
    fn call(self, m: &M, (_, ray): (Const<N>, RayOn<M>)) -> [HitOn<M>; N] {
        multi_where(m, &self, ray, &|_| B(m.bool(true)))
    }
}

#[diagnostic::do_not_recommend]
impl<M, P, R, G> Method<{ name("closest_hit_where") }, M, (RayOn<M>, G)> for On<'_, P>
where
    M: Machine,
    P: Primitive,
    R: Coerce<M, B<M>>,
    G: Fn(&M, HitOn<M>) -> R,
{
    type Output = <P::Hit as Type>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (ray, accept): (RayOn<M>, G)) -> Self::Output {
        let hit = closest_where(m, &self, ray, &|hit| condition(m, &accept, hit));
        record_on(m, &self, ray, hit)
    }
}

#[diagnostic::do_not_recommend]
impl<M, P, R, G> Method<{ name("any_hit_where") }, M, (RayOn<M>, G)> for On<'_, P>
where
    M: Machine,
    P: Primitive,
    R: Coerce<M, B<M>>,
    G: Fn(&M, HitOn<M>) -> R,
{
    type Output = B<M>;

    #[inline(always)]
    fn call(self, m: &M, (ray, accept): (RayOn<M>, G)) -> B<M> {
        any_where(m, &self, ray, &|hit| condition(m, &accept, hit))
    }
}

#[diagnostic::do_not_recommend]
impl<M, P, R, G, const N: usize> Method<{ name("multi_hit_where") }, M, (Const<N>, RayOn<M>, G)>
    for On<'_, P>
where
    M: Machine,
    P: Primitive,
    R: Coerce<M, B<M>>,
    G: Fn(&M, HitOn<M>) -> R,
{
    type Output = [HitOn<M>; N];

    #[inline(always)]
    fn call(self, m: &M, (_, ray, accept): (Const<N>, RayOn<M>, G)) -> [HitOn<M>; N] {
        multi_where(m, &self, ray, &|hit| condition(m, &accept, hit))
    }
}
