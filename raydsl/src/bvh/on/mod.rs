//! Scene queries as operations, with their implementation on each machine.
//!
//! | machine | where |
//! |---|---|
//! | one lane | `bvh::traverse` |
//! | packets | `bvh::traverse_packet`, of wide trees `bvh::wide` |
//! | WGSL | [`wgsl`] |
//! | rounding bounds | [`margin`] |

mod beam;
mod margin;
mod wgsl;

use core::cell::Cell;

use glam::{Affine3, Vec3};

use super::contract::Padding;
use super::wide::trace;
use super::{
    CountedHit, CountedHitOn, RecordOn, SceneView, View, nearest_counted, traverse, traverse_packet,
};
use crate::geometry::{Hit, HitOn, HitRecord, Primitive, Ray, RayOn, Shared};
use crate::machine::{
    A3, B, F, Lanes, Machine, Margin, On, Operation, Packet, Recorder, Scalar, Type, U, Value,
    Visit, fill,
};

pub(crate) use wgsl::RecordedQueries;

/// Finds the least `(t, id)` hit of each of `N` rays.
pub struct ClosestHits<'s, 'a, P: Primitive, const N: usize>(pub &'s SceneView<'a, P>);

impl<P: Primitive, const N: usize> Operation for ClosestHits<'_, '_, P, N> {
    type Input = [Ray; N];
    type Output = [Hit; N];

    fn on_scalar(&self, m: &Scalar, rays: [RayOn<Scalar>; N]) -> [HitOn<Scalar>; N] {
        rays.map(|ray| Hit::splat(m, traverse::nearest(self.0, Ray::lane::<Scalar>(&ray, 0))))
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(
        &self,
        m: &Packet<L>,
        rays: [RayOn<Packet<L>>; N],
    ) -> [HitOn<Packet<L>>; N] {
        if let Some(queries) = self.0.queries() {
            let mut hits = [HitOn::zero(m); N];
            trace::closest_hits(m, (self.0, queries), &rays, &mut hits);
            return hits;
        }
        fill(
            #[inline(always)]
            |i| traverse_packet::closest_hit(m, self.0, rays[i]),
        )
    }

    fn on_recorder(&self, m: &Recorder, rays: [RayOn<Recorder>; N]) -> [HitOn<Recorder>; N] {
        rays.map(|ray| m.closest_hit(self.0, ray))
    }

    fn on_margin(&self, m: &Margin, rays: [RayOn<Margin>; N]) -> [HitOn<Margin>; N] {
        rays.map(|ray| margin::query(m, self.0, ray, |_| {}, margin::closest_hit))
    }
}

/// Finds whether each of `N` rays hits anything.
pub struct AnyHits<'s, 'a, P: Primitive, const N: usize>(pub &'s SceneView<'a, P>);

impl<P: Primitive, const N: usize> Operation for AnyHits<'_, '_, P, N> {
    type Input = [Ray; N];
    type Output = [bool; N];

    fn on_scalar(&self, _: &Scalar, rays: [RayOn<Scalar>; N]) -> [B<Scalar>; N] {
        rays.map(|ray| B(traverse::any_hit(self.0, Ray::lane::<Scalar>(&ray, 0))))
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(&self, m: &Packet<L>, rays: [RayOn<Packet<L>>; N]) -> [B<Packet<L>>; N] {
        if let Some(queries) = self.0.queries() {
            let mut hits = [B(m.lanes().mask(false)); N];
            trace::any_hits(m, (self.0, queries), &rays, &mut hits);
            return hits;
        }
        fill(
            #[inline(always)]
            |i| traverse_packet::any_hit(m, self.0, rays[i]),
        )
    }

    fn on_recorder(&self, m: &Recorder, rays: [RayOn<Recorder>; N]) -> [B<Recorder>; N] {
        rays.map(|ray| m.any_hit(self.0, ray))
    }

    fn on_margin(&self, m: &Margin, rays: [RayOn<Margin>; N]) -> [B<Margin>; N] {
        rays.map(|ray| B(margin::query(m, self.0, ray, |_| {}, margin::any_hit)))
    }
}

/// Finds the least `(t, id)` hit, with its cost in single-ray traversal.
pub(crate) struct ClosestHitWithCost<'s, 'a, P: Primitive>(pub(crate) &'s SceneView<'a, P>);

impl<P: Primitive> Operation for ClosestHitWithCost<'_, '_, P> {
    type Input = Ray;
    type Output = CountedHit;

    fn on_scalar(&self, m: &Scalar, ray: RayOn<Scalar>) -> CountedHitOn<Scalar> {
        CountedHit::splat(m, nearest_counted(self.0, Ray::lane::<Scalar>(&ray, 0)))
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(&self, m: &Packet<L>, ray: RayOn<Packet<L>>) -> CountedHitOn<Packet<L>> {
        traverse_packet::closest_hit_with_cost(m, self.0, ray)
    }

    fn on_recorder(&self, m: &Recorder, ray: RayOn<Recorder>) -> CountedHitOn<Recorder> {
        m.closest_hit_with_cost(self.0, ray)
    }

    fn on_margin(&self, m: &Margin, ray: RayOn<Margin>) -> CountedHitOn<Margin> {
        let hit = margin::query(m, self.0, ray, |_| {}, margin::closest_hit);
        // Boxes are tested in `f32`, and each test may differ on a device.
        if m.is_running() {
            m.lose();
        }
        let cost = nearest_counted(self.0, margin::rounded(m, ray)).cost;
        CountedHitOn { hit, cost: Type::splat(m, cost) }
    }
}

/// Visits every primitive hit within a ray's range, with its hit and record, in any order. Nodes
/// beyond the limit are culled.
pub(crate) struct AllHits<'s, 'a, P: Primitive>(pub(crate) &'s SceneView<'a, P>);

impl<P: Primitive> Visit for AllHits<'_, '_, P> {
    type Input = Ray;
    type Item = (Hit, P::Hit);

    fn on_scalar(
        &self,
        m: &Scalar,
        ray: RayOn<Scalar>,
        limit: impl Fn() -> F<Scalar>,
        visit: impl Fn((HitOn<Scalar>, RecordOn<Scalar, P>)) -> B<Scalar>,
    ) {
        if !m.alive() {
            return;
        }
        let ray = Ray::lane::<Scalar>(&ray, 0);
        traverse::visit::<P>(self.0, ray, |hit, record, end| {
            let goes_on = visit((Hit::splat(m, hit), P::Hit::splat(m, record))).0;
            *end = limit().0;
            goes_on
        });
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(
        &self,
        m: &Packet<L>,
        ray: RayOn<Packet<L>>,
        limit: impl Fn() -> F<Packet<L>>,
        visit: impl Fn((HitOn<Packet<L>>, RecordOn<Packet<L>, P>)) -> B<Packet<L>>,
    ) {
        traverse_packet::visit(
            m,
            self.0,
            ray,
            limit,
            #[inline(always)]
            |hit, record| visit((hit, record)),
        );
    }

    fn on_recorder(
        &self,
        m: &Recorder,
        ray: RayOn<Recorder>,
        limit: impl Fn() -> F<Recorder>,
        visit: impl Fn((HitOn<Recorder>, RecordOn<Recorder, P>)) -> B<Recorder>,
    ) {
        m.visit_hits(self.0, ray, &limit, &|hit, record| visit((hit, record)));
    }

    fn on_margin(
        &self,
        m: &Margin,
        ray: RayOn<Margin>,
        limit: impl Fn() -> F<Margin>,
        visit: impl Fn((HitOn<Margin>, RecordOn<Margin, P>)) -> B<Margin>,
    ) {
        if !m.is_running() {
            return;
        }
        let found = Cell::new(None);
        let keep = |record| found.set(Some(record));
        margin::query(m, self.0, ray, keep, |m, scene| {
            let meets = |hit| {
                let record = found.get().unwrap_or_else(|| Value::zero(m));
                m.decided(visit((hit, P::Hit::with_hit_on(record, hit))).0)
            };
            margin::visit(m, scene, &|| m.get(limit().0).range.high, &meets);
        });
    }
}

/// Transforms a ray to the space of an instance's tree. The scene must have instances.
pub(crate) struct LocalRay<'s, 'a, T, S: Shared>(pub(crate) &'s View<'a, T, S>);

impl<T: Type, S: Shared> Operation for LocalRay<'_, '_, T, S> {
    type Input = (Ray, u32);
    type Output = Ray;

    fn on_scalar(&self, m: &Scalar, (ray, inst): (RayOn<Scalar>, U<Scalar>)) -> RayOn<Scalar> {
        Ray::splat(m, self.0.local_ray(inst.0, Ray::lane::<Scalar>(&ray, 0)))
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(
        &self,
        m: &Packet<L>,
        (ray, inst): (RayOn<Packet<L>>, U<Packet<L>>),
    ) -> RayOn<Packet<L>> {
        let of_lane = |l| {
            let ray = Ray::lane::<Packet<L>>(&ray, l);
            self.0.local_ray(L::u32_lane(&inst.0, l), ray)
        };
        m.of_running(Ray::new(Vec3::ZERO, Vec3::ZERO), of_lane)
    }

    fn on_recorder(
        &self,
        m: &Recorder,
        (ray, inst): (RayOn<Recorder>, U<Recorder>),
    ) -> RayOn<Recorder> {
        m.local_ray_of(self.0, inst, ray)
    }

    fn on_margin(&self, m: &Margin, (ray, inst): (RayOn<Margin>, U<Margin>)) -> RayOn<Margin> {
        margin::local_ray(m, self.0, inst.0, ray)
    }
}

/// Returns the transform from the space of the scene to that of an instance's tree.
pub(crate) struct ToObject<'s, 'a, T, S: Shared>(pub(crate) &'s View<'a, T, S>);

impl<T: Type, S: Shared> Operation for ToObject<'_, '_, T, S> {
    type Input = u32;
    type Output = Affine3;

    fn on_scalar(&self, m: &Scalar, inst: U<Scalar>) -> A3<Scalar> {
        Affine3::splat(m, self.0.to_object(inst.0))
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(&self, m: &Packet<L>, inst: U<Packet<L>>) -> A3<Packet<L>> {
        m.of_running(Affine3::IDENTITY, |l| self.0.to_object(L::u32_lane(&inst.0, l)))
    }

    fn on_recorder(&self, m: &Recorder, inst: U<Recorder>) -> A3<Recorder> {
        m.to_object_of(self.0, inst)
    }

    fn on_margin(&self, m: &Margin, inst: U<Margin>) -> A3<Margin> {
        Affine3::splat(m, self.0.to_object(inst.0))
    }
}

/// Returns the distance behind a hit up to which nodes are still visited, relative to that of the
/// hit.
pub(crate) struct Slack<'s, 'a, P: Primitive>(pub(crate) &'s SceneView<'a, P>);

impl<P: Primitive> Slack<'_, '_, P> {
    #[inline(always)]
    fn on_host<M: Machine>(&self, m: &M) -> On<f32, M> {
        F(m.f32(self.0.padding().slack))
    }
}

impl<P: Primitive> Operation for Slack<'_, '_, P> {
    type Input = ();
    type Output = f32;

    fn on_scalar(&self, m: &Scalar, (): ()) -> F<Scalar> {
        self.on_host(m)
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(&self, m: &Packet<L>, (): ()) -> F<Packet<L>> {
        self.on_host(m)
    }

    fn on_recorder(&self, m: &Recorder, (): ()) -> F<Recorder> {
        match self.0.placed() {
            // A buffer value, since it changes when instances move.
            Some(_) => m.slack_of_places(self.0),
            None => F(m.f32(Padding::among::<P>(self.0.kinds()).slack)),
        }
    }

    fn on_margin(&self, m: &Margin, (): ()) -> F<Margin> {
        self.on_host(m)
    }
}
