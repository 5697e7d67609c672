//! Two scenes as one: the view of a struct of scenes, in kernels.

use super::contract::is_before;
use super::query::{inserted, is_before_by};
use super::traverse::CostOn;
use super::{Cost, RayQueryOn, RecordQuery};
use crate::geometry::{Hit, HitOn, HitRecord, Ray, RayOn};
use crate::kernel;
use crate::machine::{
    A3, B, Branch, Cursor, F, HostFact, Leaves, Machine, On, Resource, Schema, Type, U, Value, Var,
    fill, op,
};

/// View of two scenes as one, which `#[derive(RayQuery)]` makes of a struct of scenes; more than
/// two are joined one after another.
///
/// The instance ids of the second scene follow those of the first, so that hits have one order, that
/// of `(t, inst_id, prim_id)`: of two hits at one distance that of the first scene comes first.
#[derive(Clone, Copy, Debug)]
pub struct Joined<S, T> {
    first: S,
    second: T,
}

/// Returns whether there is a hit, and it comes before `best`.
#[kernel]
#[inline(always)]
fn is_hit_before(hit: Hit, best: Hit) -> bool {
    hit.is_hit & is_before(true, hit, best)
}

type Record<S, M> = On<<S as RayQueryOn>::Hit, M>;

impl<S: RayQueryOn, T: RayQueryOn<Hit = S::Hit>> Joined<S, T> {
    /// Joins two scenes.
    #[inline(always)]
    pub fn new(first: S, second: T) -> Self {
        Self { first, second }
    }

    /// Returns the scene whose instance ids come first.
    #[inline(always)]
    pub fn first(self) -> S {
        self.first
    }

    /// Returns the other scene.
    #[inline(always)]
    pub fn second(self) -> T {
        self.second
    }

    /// Does one thing for hits of the first scene and another for those of the second, given the
    /// instance id in the scene that was hit.
    #[inline(always)]
    pub fn of_either<M: Machine, V: Value<M>>(
        self,
        m: &M,
        inst: U<M>,
        first: impl FnOnce(S, U<M>) -> V,
        second: impl FnOnce(T, U<M>) -> V,
    ) -> V {
        let before = m.u32(self.first.inst_count());
        let is_first = B(m.u32_compare(op::Lt, inst.0, before));
        let inst_of_second = U(m.u32_binary(op::WrappingSub, inst.0, before));
        m.choose(
            "of_part",
            true,
            is_first,
            #[inline(always)]
            || first(self.first, inst),
            #[inline(always)]
            || second(self.second, inst_of_second),
        )
    }

    /// Gives a hit of the second scene its instance id in both.
    #[inline(always)]
    fn placed<M: Machine>(self, m: &M, record: Record<S, M>) -> Record<S, M> {
        let hit = S::Hit::hit_on(record);
        let inst_id = m.u32_binary(op::WrappingAdd, hit.inst_id.0, m.u32(self.first.inst_count()));
        let inst_id = U(m.u32_select(hit.is_hit.0, inst_id, hit.inst_id.0));
        S::Hit::with_hit_on(record, HitOn { inst_id, ..hit })
    }

    /// Returns the earlier of a hit of the first scene and one of the second.
    #[inline(always)]
    fn earlier<M: Machine>(self, m: &M, a: Record<S, M>, b: Record<S, M>) -> Record<S, M> {
        let b = self.placed(m, b);
        let is_closer = is_hit_before::on(m, S::Hit::hit_on(b), S::Hit::hit_on(a));
        m.choose("closest", false, is_closer, || b, || a)
    }

    /// Returns the ray up to a hit.
    #[inline(always)]
    fn up_to<M: Machine>(m: &M, ray: RayOn<M>, record: Record<S, M>) -> RayOn<M> {
        let hit = S::Hit::hit_on(record);
        RayOn { t_max: F(m.f32_select(hit.is_hit.0, hit.t.0, ray.t_max.0)), ..ray }
    }

    /// Merges the hits of both scenes in some order.
    #[inline(always)]
    fn merged<M: Machine, const N: usize>(
        self,
        m: &M,
        mut hits: [Record<S, M>; N],
        others: [Record<S, M>; N],
        is_before: impl Fn(HitOn<M>, HitOn<M>) -> B<M>,
    ) -> [Record<S, M>; N] {
        let is_before = |a, b| is_before(S::Hit::hit_on(a), S::Hit::hit_on(b));
        for other in others {
            let other = self.placed(m, other);
            let select = |c: B<M>, a, b| m.choose("hit", false, c, || a, || b);
            let with = inserted(m, is_before, select, other, hits);
            let fits = is_before(other, hits[N - 1]);
            hits = fill(
                #[inline(always)]
                |i| select(fits, with[i], hits[i]),
            );
        }
        hits
    }

    /// Returns the nearer of two hits of the host, the second with its instance id in both scenes.
    fn earlier_of(self, a: S::Hit, b: S::Hit) -> S::Hit {
        let hit = b.hit();
        let inst_id =
            hit.inst_id.wrapping_add(if hit.is_hit { self.first.inst_count() } else { 0 });
        let b = b.with_hit(Hit { inst_id, ..hit });
        if is_hit_before(b.hit(), a.hit()) { b } else { a }
    }

    /// Returns a ray of the host up to a hit.
    fn up_to_of(ray: Ray, hit: Hit) -> Ray {
        if hit.is_hit { Ray { t_max: hit.t, ..ray } } else { ray }
    }
}

impl<S: RayQueryOn, T: RayQueryOn<Hit = S::Hit>> RayQueryOn for Joined<S, T> {
    type Hit = S::Hit;
    type Hits<M: Machine> = JoinedHits<M, S, T>;

    fn inst_count(self) -> u32 {
        self.first.inst_count().saturating_add(self.second.inst_count())
    }

    /// The scenes keep their names, those of the struct's members.
    #[inline(always)]
    fn named(self, _: &'static str) -> Self {
        self
    }

    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        self.first.resources(visit);
        self.second.resources(visit);
        // Which scene an instance is in is written down.
        visit(&HostFact(self.first.inst_count().into()));
        visit(&HostFact(self.second.inst_count().into()));
    }

    #[inline(always)]
    fn closest_hits<M: Machine, const N: usize>(
        self,
        m: &M,
        rays: [RayOn<M>; N],
    ) -> [Record<S, M>; N] {
        let first = self.first.closest_hits(m, rays);
        let rays: [RayOn<M>; N] = fill(
            #[inline(always)]
            |i| Self::up_to(m, rays[i], first[i]),
        );
        let second = self.second.closest_hits(m, rays);
        fill(
            #[inline(always)]
            |i| self.earlier(m, first[i], second[i]),
        )
    }

    #[inline(always)]
    fn any_hits<M: Machine, const N: usize>(self, m: &M, rays: [RayOn<M>; N]) -> [B<M>; N] {
        let all = Var::<[B<M>; N]>::new(m, "found", self.first.any_hits(m, rays));
        let found = all.get(m);
        let open = found
            .iter()
            .fold(m.bool(false), |open, found| m.bool_binary(op::Or, open, m.bool_not(found.0)));
        let some_open = Branch::new(m, B(open));
        if some_open.then(m) {
            // A ray that has hit asks for nothing more.
            let rays: [RayOn<M>; N] = fill(
                #[inline(always)]
                |i| {
                    let end = m.f32_select(found[i].0, m.f32(f32::NEG_INFINITY), rays[i].t_max.0);
                    RayOn { t_max: F(end), ..rays[i] }
                },
            );
            let second = self.second.any_hits(m, rays);
            all.set(
                m,
                fill(
                    #[inline(always)]
                    |i| B(m.bool_binary(op::Or, found[i].0, second[i].0)),
                ),
            );
        }
        some_open.end(m);
        all.get(m)
    }

    #[inline(always)]
    fn closest_hit_with_cost<M: Machine>(self, m: &M, ray: RayOn<M>) -> (Record<S, M>, CostOn<M>) {
        let (first, a) = self.first.closest_hit_with_cost(m, ray);
        let (second, b) = self.second.closest_hit_with_cost(m, Self::up_to(m, ray, first));
        let sum = |a: U<M>, b: U<M>| U(m.u32_binary(op::WrappingAdd, a.0, b.0));
        let cost =
            CostOn { nodes: sum(a.nodes, b.nodes), primitives: sum(a.primitives, b.primitives) };
        (self.earlier(m, first, second), cost)
    }

    #[inline(always)]
    fn closest_hit_where<M: Machine>(
        self,
        m: &M,
        ray: RayOn<M>,
        accept: impl Fn(Record<S, M>) -> B<M>,
    ) -> Record<S, M> {
        let first = self.first.closest_hit_where(m, ray, &accept);
        let ray = Self::up_to(m, ray, first);
        let second = self.second.closest_hit_where(
            m,
            ray,
            #[inline(always)]
            |record| accept(self.placed(m, record)),
        );
        self.earlier(m, first, second)
    }

    #[inline(always)]
    fn any_hit_where<M: Machine>(
        self,
        m: &M,
        ray: RayOn<M>,
        accept: impl Fn(Record<S, M>) -> B<M>,
    ) -> B<M> {
        let found = Var::new(m, "found", self.first.any_hit_where(m, ray, &accept));
        let is_open = Branch::new(m, B(m.bool_not(found.get(m).0)));
        if is_open.then(m) {
            let second = self.second.any_hit_where(
                m,
                ray,
                #[inline(always)]
                |record| accept(self.placed(m, record)),
            );
            found.set(m, second);
        }
        is_open.end(m);
        found.get(m)
    }

    #[inline(always)]
    fn multi_hit_where<M: Machine, const N: usize>(
        self,
        m: &M,
        ray: RayOn<M>,
        accept: impl Fn(Record<S, M>) -> B<M>,
    ) -> [Record<S, M>; N] {
        let first = self.first.multi_hit_where(m, ray, &accept);
        let ray = Self::up_to(m, ray, first[N - 1]);
        let second = self.second.multi_hit_where(
            m,
            ray,
            #[inline(always)]
            |record| accept(self.placed(m, record)),
        );
        self.merged(m, first, second, |a, b| is_hit_before::on(m, a, b))
    }

    #[inline(always)]
    fn multi_hit_by<M: Machine, const N: usize>(
        self,
        m: &M,
        ray: RayOn<M>,
        is_closer: impl Fn(HitOn<M>, HitOn<M>) -> B<M>,
    ) -> [Record<S, M>; N] {
        let first = self.first.multi_hit_by(m, ray, &is_closer);
        let placed = |hit: HitOn<M>| {
            let before = m.u32(self.first.inst_count());
            let inst_id = U(m.u32_binary(op::WrappingAdd, hit.inst_id.0, before));
            HitOn { inst_id, ..hit }
        };
        let second = self.second.multi_hit_by(m, ray, |a, b| is_closer(placed(a), placed(b)));
        self.merged(m, first, second, |a, b| {
            let both =
                m.bool_binary(op::And, a.is_hit.0, is_before_by(m, true, &is_closer, a, b).0);
            B(both)
        })
    }

    #[inline(always)]
    fn hits<M: Machine>(self, m: &M, ray: RayOn<M>) -> JoinedHits<M, S, T> {
        JoinedHits {
            scenes: self,
            first: self.first.hits(m, ray),
            second: self.second.hits(m, ray),
        }
    }

    #[inline(always)]
    fn to_object<M: Machine>(self, m: &M, inst: U<M>) -> A3<M> {
        self.of_either(m, inst, |s, inst| s.to_object(m, inst), |s, inst| s.to_object(m, inst))
    }

    #[inline(always)]
    fn local_ray<M: Machine>(self, m: &M, ray: RayOn<M>, inst: U<M>) -> RayOn<M> {
        let (a, b) =
            (|s: S, inst| s.local_ray(m, ray, inst), |s: T, inst| s.local_ray(m, ray, inst));
        self.of_either(m, inst, a, b)
    }

    fn closest_hit_of(self, ray: Ray) -> S::Hit {
        let first = self.first.closest_hit_of(ray);
        let second = self.second.closest_hit_of(Self::up_to_of(ray, first.hit()));
        self.earlier_of(first, second)
    }

    fn any_hit_of(self, ray: Ray) -> bool {
        self.first.any_hit_of(ray) || self.second.any_hit_of(ray)
    }

    fn closest_hits_of(self, rays: &[Ray]) -> Vec<S::Hit> {
        let first = self.first.closest_hits_of(rays);
        let up_to = |(ray, hit): (&Ray, &S::Hit)| Self::up_to_of(*ray, hit.hit());
        let rays: Vec<Ray> = rays.iter().zip(&first).map(up_to).collect();
        let second = self.second.closest_hits_of(&rays);
        first.into_iter().zip(second).map(|(a, b)| self.earlier_of(a, b)).collect()
    }

    fn any_hits_of(self, rays: &[Ray]) -> Vec<bool> {
        let mut found = self.first.any_hits_of(rays);
        let open: Vec<Ray> =
            rays.iter().zip(&found).filter(|(_, found)| !**found).map(|(ray, _)| *ray).collect();
        let mut second = self.second.any_hits_of(&open).into_iter();
        for found in found.iter_mut().filter(|found| !**found) {
            *found = second.next().unwrap_or_default();
        }
        found
    }

    fn closest_hit_with_cost_of(self, ray: Ray) -> (S::Hit, Cost) {
        let (first, a) = self.first.closest_hit_with_cost_of(ray);
        let (second, b) = self.second.closest_hit_with_cost_of(Self::up_to_of(ray, first.hit()));
        (self.earlier_of(first, second), a + b)
    }

    fn any_hit_with_cost_of(self, ray: Ray) -> (bool, Cost) {
        let (found, a) = self.first.any_hit_with_cost_of(ray);
        if found {
            return (true, a);
        }
        let (found, b) = self.second.any_hit_with_cost_of(ray);
        (found, a + b)
    }
}

impl<S: RayQueryOn, T: RayQueryOn<Hit = S::Hit>> RecordQuery for Joined<S, T> {
    type Hit = S::Hit;
    type View<'a>
        = Self
    where
        Self: 'a;

    #[inline(always)]
    fn view(&self) -> Self {
        *self
    }
}

/// A host value on every machine.
impl<M: Machine, S: Value<M>, T: Value<M>> Value<M> for Joined<S, T> {
    const SCHEMA: &'static Schema = &Schema::Host;

    fn zero(m: &M) -> Self {
        Self { first: S::zero(m), second: T::zero(m) }
    }

    #[inline(always)]
    fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
        Self { first: S::zip(m, a.first, b.first, f), second: T::zip(m, a.second, b.second, f) }
    }
}

/// Loop over the hits of two scenes, in one order.
pub struct JoinedHits<M: Machine, S: RayQueryOn, T: RayQueryOn> {
    scenes: Joined<S, T>,
    first: S::Hits<M>,
    second: T::Hits<M>,
}

/// State of a loop over the hits of two scenes.
pub struct State<M: Machine, S: RayQueryOn, T: RayQueryOn> {
    first: <S::Hits<M> as Cursor<M>>::State,
    second: <T::Hits<M> as Cursor<M>>::State,
    /// The next hit of each scene; a miss where it has no more.
    next: [Var<Record<S, M>>; 2],
    /// Whether the next hit of each scene has been taken, and another is due.
    is_due: [Var<B<M>>; 2],
    /// The current hit.
    last: Var<Record<S, M>>,
}

impl<M: Machine, S: RayQueryOn, T: RayQueryOn<Hit = S::Hit>> Cursor<M> for JoinedHits<M, S, T> {
    type Item = Record<S, M>;
    type State = State<M, S, T>;

    #[inline(always)]
    fn begin(&self, m: &M) -> State<M, S, T> {
        let miss =
            || Var::new(m, "next", S::Hit::with_hit_on(Value::zero(m), Hit::splat(m, Hit::miss())));
        let is_due = || Var::new(m, "is_due", B(m.bool(true)));
        State {
            first: self.first.begin(m),
            second: self.second.begin(m),
            next: [miss(), miss()],
            is_due: [is_due(), is_due()],
            last: miss(),
        }
    }

    #[inline(always)]
    fn advance(&self, m: &M, state: &State<M, S, T>) -> B<M> {
        let [(next, due), (next_of_second, due_of_second)] =
            [0, 1].map(|i| (&state.next[i], &state.is_due[i]));
        advance::<M, _, S::Hit>(m, &self.first, &state.first, (next, due), |record| record);
        let placed = |record| self.scenes.placed(m, record);
        let of_second = (next_of_second, due_of_second);
        advance::<M, _, S::Hit>(m, &self.second, &state.second, of_second, placed);
        let [a, b] = [0, 1].map(|i| state.next[i].get(m));
        let (of_a, of_b) = (S::Hit::hit_on(a), S::Hit::hit_on(b));
        let is_second = is_hit_before::on(m, of_b, of_a);
        let last = m.choose("hit", false, is_second, || b, || a);
        state.last.set(m, last);
        state.is_due[0].set(m, B(m.bool_not(is_second.0)));
        state.is_due[1].set(m, is_second);
        S::Hit::hit_on(last).is_hit
    }

    #[inline(always)]
    fn item(&self, m: &M, state: &State<M, S, T>) -> Record<S, M> {
        state.last.get(m)
    }
}

/// Goes to the next hit of one scene in the lanes where it is due.
#[inline(always)]
fn advance<M: Machine, C, R: HitRecord>(
    m: &M,
    hits: &C,
    state: &C::State,
    (next, is_due): (&Var<On<R, M>>, &Var<B<M>>),
    placed: impl Fn(On<R, M>) -> On<R, M>,
) where
    C: Cursor<M, Item = On<R, M>>,
{
    let due = Branch::new(m, is_due.get(m));
    if due.then(m) {
        let is_there = hits.advance(m, state);
        let record = placed(hits.item(m, state));
        let hit = R::hit_on(record);
        next.set(m, R::with_hit_on(record, HitOn { is_hit: is_there, ..hit }));
    }
    due.end(m);
}
