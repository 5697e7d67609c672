//! What kernels ask a view of a scene, on any machine.

use glam::Affine3;

use super::hits::HitsOn;
use super::on::{AnyHits, ClosestHits, LocalRay, ToObject};
use super::query::{
    any_where, closest_where, closest_with_cost_on, multi_by, multi_where, record_on,
};
use super::traverse::CostOn;
use super::{Cost, Joined, Placed, RecordOn, RecordQuery, SceneView, batch, traverse};
use crate::geometry::{HitOn, HitRecord, Primitive, Ray, RayOn};
use crate::machine::{
    A3, B, Cursor, Leaves, Machine, On, Resource, Scalar, Schema, Slice, Type, U, Value, fill,
};

/// Queries of the view that kernels have of a scene: a [`SceneView`], or several joined. It is a
/// host value on every machine.
///
/// Each method is that of [`RecordQuery`](super::RecordQuery) with the same name, for one ray (or `N`) of
/// each lane.
pub trait RayQueryOn: Copy + Send + Sync {
    /// The record of a hit.
    type Hit: HitRecord;

    /// A loop over the hits of a ray.
    type Hits<M: Machine>: Cursor<M, Item = On<Self::Hit, M>>;

    /// Returns the number of instance ids: hits have those from 0 on. It is 1 without instances.
    fn inst_count(self) -> u32;

    /// Returns the view under a name of the source.
    #[must_use]
    fn named(self, name: &'static str) -> Self;

    /// Visits the buffers that recorded code may read.
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource));

    /// Finds the least `(t, id)` hit of each of `N` rays.
    fn closest_hits<M: Machine, const N: usize>(
        self,
        m: &M,
        rays: [RayOn<M>; N],
    ) -> [On<Self::Hit, M>; N];

    /// Finds whether each of `N` rays hits anything.
    fn any_hits<M: Machine, const N: usize>(self, m: &M, rays: [RayOn<M>; N]) -> [B<M>; N];

    /// Finds the least `(t, id)` hit, and the cost of finding it.
    fn closest_hit_with_cost<M: Machine>(
        self,
        m: &M,
        ray: RayOn<M>,
    ) -> (On<Self::Hit, M>, CostOn<M>);

    /// Finds the least `(t, id)` hit that `accept` accepts.
    fn closest_hit_where<M: Machine>(
        self,
        m: &M,
        ray: RayOn<M>,
        accept: impl Fn(On<Self::Hit, M>) -> B<M>,
    ) -> On<Self::Hit, M>;

    /// Finds whether there is a hit that `accept` accepts.
    fn any_hit_where<M: Machine>(
        self,
        m: &M,
        ray: RayOn<M>,
        accept: impl Fn(On<Self::Hit, M>) -> B<M>,
    ) -> B<M>;

    /// Finds the `N` least `(t, id)` hits that `accept` accepts, in order.
    fn multi_hit_where<M: Machine, const N: usize>(
        self,
        m: &M,
        ray: RayOn<M>,
        accept: impl Fn(On<Self::Hit, M>) -> B<M>,
    ) -> [On<Self::Hit, M>; N];

    /// Finds the first `N` hits in the order of `is_closer`.
    fn multi_hit_by<M: Machine, const N: usize>(
        self,
        m: &M,
        ray: RayOn<M>,
        is_closer: impl Fn(HitOn<M>, HitOn<M>) -> B<M>,
    ) -> [On<Self::Hit, M>; N];

    /// Returns a loop over all hits.
    fn hits<M: Machine>(self, m: &M, ray: RayOn<M>) -> Self::Hits<M>;

    /// Returns the transform from the space of the scene to that of an instance's tree.
    fn to_object<M: Machine>(self, m: &M, inst: U<M>) -> A3<M>;

    /// Returns the ray in the space of an instance's tree.
    fn local_ray<M: Machine>(self, m: &M, ray: RayOn<M>, inst: U<M>) -> RayOn<M>;

    /// Does [`Self::closest_hits`] for one ray of the host.
    fn closest_hit_of(self, ray: Ray) -> Self::Hit {
        let m = &Scalar::default();
        let [hit] = self.closest_hits(m, [Ray::splat(m, ray)]);
        Self::Hit::lane::<Scalar>(&hit, 0)
    }

    /// Does [`Self::any_hits`] for one ray of the host.
    fn any_hit_of(self, ray: Ray) -> bool {
        let m = &Scalar::default();
        let [is_hit] = self.any_hits(m, [Ray::splat(m, ray)]);
        is_hit.0
    }

    /// Does [`Self::closest_hits`] for many rays of the host, in packets.
    fn closest_hits_of(self, rays: &[Ray]) -> Vec<Self::Hit>;

    /// Does [`Self::any_hits`] for many rays of the host, in packets.
    fn any_hits_of(self, rays: &[Ray]) -> Vec<bool>;

    /// Does [`Self::closest_hit_with_cost`] for a ray of the host.
    fn closest_hit_with_cost_of(self, ray: Ray) -> (Self::Hit, Cost);

    /// Finds whether a ray of the host hits anything, and the cost of finding it.
    fn any_hit_with_cost_of(self, ray: Ray) -> (bool, Cost);
}

impl<'a, P: Primitive> RayQueryOn for SceneView<'a, P> {
    type Hit = P::Hit;
    type Hits<M: Machine> = HitsOn<'a, M, P>;

    fn inst_count(self) -> u32 {
        self.placed().and_then(Placed::top).map_or(1, |top| top.size)
    }

    #[inline(always)]
    fn named(self, name: &'static str) -> Self {
        Self::named(self, name)
    }

    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(self);
    }

    #[inline(always)]
    fn closest_hits<M: Machine, const N: usize>(
        self,
        m: &M,
        rays: [RayOn<M>; N],
    ) -> [RecordOn<M, P>; N] {
        let hits = m.perform(&ClosestHits(&self), rays);
        fill(
            #[inline(always)]
            |i| record_on(m, &self, rays[i], hits[i]),
        )
    }

    #[inline(always)]
    fn any_hits<M: Machine, const N: usize>(self, m: &M, rays: [RayOn<M>; N]) -> [B<M>; N] {
        m.perform(&AnyHits(&self), rays)
    }

    #[inline(always)]
    fn closest_hit_with_cost<M: Machine>(
        self,
        m: &M,
        ray: RayOn<M>,
    ) -> (RecordOn<M, P>, CostOn<M>) {
        closest_with_cost_on(m, &self, ray)
    }

    #[inline(always)]
    fn closest_hit_where<M: Machine>(
        self,
        m: &M,
        ray: RayOn<M>,
        accept: impl Fn(RecordOn<M, P>) -> B<M>,
    ) -> RecordOn<M, P> {
        let hit = closest_where(m, &self, ray, &accept);
        record_on(m, &self, ray, hit)
    }

    #[inline(always)]
    fn any_hit_where<M: Machine>(
        self,
        m: &M,
        ray: RayOn<M>,
        accept: impl Fn(RecordOn<M, P>) -> B<M>,
    ) -> B<M> {
        any_where(m, &self, ray, &accept)
    }

    #[inline(always)]
    fn multi_hit_where<M: Machine, const N: usize>(
        self,
        m: &M,
        ray: RayOn<M>,
        accept: impl Fn(RecordOn<M, P>) -> B<M>,
    ) -> [RecordOn<M, P>; N] {
        multi_where(m, &self, ray, &accept)
    }

    #[inline(always)]
    fn multi_hit_by<M: Machine, const N: usize>(
        self,
        m: &M,
        ray: RayOn<M>,
        is_closer: impl Fn(HitOn<M>, HitOn<M>) -> B<M>,
    ) -> [RecordOn<M, P>; N] {
        multi_by(m, &self, ray, &is_closer)
    }

    #[inline(always)]
    fn hits<M: Machine>(self, _: &M, ray: RayOn<M>) -> HitsOn<'a, M, P> {
        HitsOn { scene: self, ray }
    }

    #[inline(always)]
    fn to_object<M: Machine>(self, m: &M, inst: U<M>) -> A3<M> {
        match self.placed() {
            Some(_) => m.perform(&ToObject(&self), inst),
            None => Affine3::splat(m, Affine3::IDENTITY),
        }
    }

    #[inline(always)]
    fn local_ray<M: Machine>(self, m: &M, ray: RayOn<M>, inst: U<M>) -> RayOn<M> {
        match self.placed() {
            Some(_) => m.perform(&LocalRay(&self), (ray, inst)),
            None => ray,
        }
    }

    fn closest_hit_of(self, ray: Ray) -> P::Hit {
        traverse::closest_hit(&self, ray)
    }

    fn any_hit_of(self, ray: Ray) -> bool {
        traverse::any_hit(&self, ray)
    }

    fn closest_hits_of(self, rays: &[Ray]) -> Vec<P::Hit> {
        batch::closest_hits(&self, rays)
    }

    fn any_hits_of(self, rays: &[Ray]) -> Vec<bool> {
        batch::any_hits(&self, rays)
    }

    fn closest_hit_with_cost_of(self, ray: Ray) -> (P::Hit, Cost) {
        traverse::closest_hit_with_cost(&self, ray)
    }

    fn any_hit_with_cost_of(self, ray: Ray) -> (bool, Cost) {
        traverse::any_hit_with_cost(&self, ray)
    }
}

/// A scene as an argument of a kernel that is generic over it.
pub trait SceneArgument {
    /// The scene.
    type Scene: RecordQuery + ?Sized;

    /// Returns the scene.
    fn scene(&self) -> &Self::Scene;
}

macro_rules! argument_itself {
    ([$($g:tt)*] $t:ty) => {
        impl<$($g)*> $crate::bvh::SceneArgument for $t {
            type Scene = Self;

            #[inline(always)]
            fn scene(&self) -> &Self {
                self
            }
        }
    };
}

pub(crate) use argument_itself;

argument_itself!([P: Primitive] SceneView<'_, P>);
argument_itself!([P: Primitive<Shared = ()>] Slice<'_, P>);
argument_itself!([A: RayQueryOn, B: RayQueryOn<Hit = A::Hit>] Joined<A, B>);

impl<S: RecordQuery + ?Sized> SceneArgument for &S {
    type Scene = S;

    #[inline(always)]
    fn scene(&self) -> &S {
        self
    }
}

/// A scene that kernels are generic over is a value of the host.
impl<M: Machine, S: RecordQuery + ?Sized> Value<M> for &S {
    const SCHEMA: &'static Schema = &Schema::Host;

    fn zero(_: &M) -> Self {
        panic!("a kernel cannot choose between scenes: choose between what it reads from them")
    }

    #[inline(always)]
    fn zip(_: &M, a: Self, b: Self, _: &mut impl Leaves<M>) -> Self {
        assert!(
            core::ptr::addr_eq(a, b),
            "a kernel cannot choose between scenes: choose between what it reads from them"
        );
        a
    }
}
