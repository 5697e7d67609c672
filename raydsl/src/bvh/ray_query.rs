//! What rays may ask, on the host.

use super::{Bvh, BvhList, SceneView, View, traverse};
use crate::geometry::{Hit, Primitive, Ray};

/// What rays may ask of primitives: of a slice, a tree ([`Bvh`]) or a list of trees ([`BvhList`]).
///
/// A query of a slice tests every primitive, which with a few dozen of them is faster than a tree.
/// All answer alike, and as kernels do that ask the same.
pub trait RayQuery {
    /// What the rays meet.
    type Primitive: Primitive;

    /// The view that kernels work on.
    fn view(&self) -> SceneView<'_, Self::Primitive>;

    /// The least `(t, id)` hit of `ray`.
    fn closest_hit(&self, ray: Ray) -> <Self::Primitive as Primitive>::Hit {
        traverse::closest_hit(&self.view(), ray)
    }

    /// Whether `ray` hits anything.
    fn any_hit(&self, ray: Ray) -> bool {
        traverse::any_hit(&self.view(), ray)
    }

    /// The least `(t, id)` hit of each of `N` rays, `ray(0)` to `ray(N - 1)`.
    ///
    /// What one query sees at once it can trace better than one ray after another; the results
    /// are those of [`RayQuery::closest_hit`]. Inside a kernel `ray` is a closure of the kernel.
    fn closest_hit_each<const N: usize>(
        &self,
        ray: impl Fn(u32) -> Ray,
    ) -> [<Self::Primitive as Primitive>::Hit; N] {
        core::array::from_fn(|i| self.closest_hit(ray(i as u32)))
    }

    /// Whether each of `N` rays, `ray(0)` to `ray(N - 1)`, hits anything.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let triangles = [Triangle { v0: vec3(0.0, 0.0, 1.0), v1: vec3(4.0, 0.0, 1.0), v2: vec3(0.0, 4.0, 1.0) }];
    /// let bvh = Bvh::build(&triangles)?;
    /// let up = vec3(0.0, 0.0, 1.0);
    /// let visible = kernel!(|x: f32, y: f32| {
    ///     let hits = bvh.any_hit_each::<4>(|i: u32| Ray::new(vec3(x + i as f32, y, 0.0), up));
    ///     let mut count = 0u32;
    ///     for hit in 0..4usize {
    ///         count += hits[hit] as u32;
    ///     }
    ///     count
    /// });
    /// assert_eq!(visible.call((0.5, 0.5)), 4);
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    fn any_hit_each<const N: usize>(&self, ray: impl Fn(u32) -> Ray) -> [bool; N] {
        core::array::from_fn(|i| self.any_hit(ray(i as u32)))
    }

    /// The least `(t, id)` hit of `ray` that `accept` accepts: leaves with holes, sides that are not
    /// seen. `accept` is asked about some of the hits, in any order. Inside a kernel it is a closure of
    /// the kernel, which may read what stands around it.
    fn closest_hit_where(
        &self,
        ray: Ray,
        accept: impl Fn(<Self::Primitive as Primitive>::Hit) -> bool,
    ) -> <Self::Primitive as Primitive>::Hit {
        traverse::closest_hit_where(&self.view(), ray, accept)
    }

    /// Whether `ray` has a hit that `accept` accepts.
    fn any_hit_where(
        &self,
        ray: Ray,
        accept: impl Fn(<Self::Primitive as Primitive>::Hit) -> bool,
    ) -> bool {
        traverse::any_hit_where(&self.view(), ray, accept)
    }

    /// The `N` least `(t, id)` hits of `ray`, in order, with misses behind them. Each primitive gives
    /// the hit of its `intersect`, so a sphere is there once.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let v = |x, y, z| vec3(x, y, z);
    /// let slabs = [3.0, 1.0, 2.0].map(|z| Triangle { v0: v(0.0, 0.0, z), v1: v(4.0, 0.0, z), v2: v(0.0, 4.0, z) });
    /// let bvh = Bvh::build(&slabs)?;
    /// let depths = kernel!(|ray: Ray| {
    ///     let hits = bvh.multi_hit::<2>(ray);
    ///     (hits[0].t, hits[1].t, hits[1].prim_id)
    /// });
    /// assert_eq!(depths.call((Ray::new(v(1.0, 1.0, 0.0), Vec3::Z),)), (1.0, 2.0, 2));
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    fn multi_hit<const N: usize>(&self, ray: Ray) -> [<Self::Primitive as Primitive>::Hit; N] {
        self.multi_hit_where(ray, |_| true)
    }

    /// The `N` least `(t, id)` hits of `ray` that `accept` accepts, in order.
    fn multi_hit_where<const N: usize>(
        &self,
        ray: Ray,
        accept: impl Fn(<Self::Primitive as Primitive>::Hit) -> bool,
    ) -> [<Self::Primitive as Primitive>::Hit; N] {
        traverse::multi_hit_where(&self.view(), ray, accept)
    }

    /// The first `N` hits of `ray` in an order of your own, with misses behind them: `is_closer` says
    /// whether its first hit comes before its second; of two where both or neither does, the least
    /// `(t, id)` comes first. An order that runs in a circle has a result that depends on the tree.
    /// Every hit within the ray's range is looked at.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let v = |x, y, z| vec3(x, y, z);
    /// let slabs = [3.0, 1.0, 2.0].map(|z| Triangle { v0: v(0.0, 0.0, z), v1: v(4.0, 0.0, z), v2: v(0.0, 4.0, z) });
    /// let bvh = Bvh::build(&slabs)?;
    /// let farthest = kernel!(|ray: Ray| {
    ///     let hits = bvh.multi_hit_by::<2>(ray, |a: Hit, b: Hit| a.t > b.t);
    ///     (hits[0].t, hits[1].t)
    /// });
    /// assert_eq!(farthest.call((Ray::new(v(1.0, 1.0, 0.0), Vec3::Z),)), (3.0, 2.0));
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    fn multi_hit_by<const N: usize>(
        &self,
        ray: Ray,
        is_closer: impl Fn(Hit, Hit) -> bool,
    ) -> [<Self::Primitive as Primitive>::Hit; N] {
        traverse::multi_hit_by(&self.view(), ray, is_closer)
    }

    /// The primitive that was hit; the first one for a miss, so that code need not branch.
    ///
    /// # Panics
    ///
    /// If there are no primitives.
    fn primitive(&self, hit: Hit) -> Self::Primitive {
        self.view().get(if hit.is_hit { hit.prim_id } else { 0 })
    }
}

impl<P: Primitive<Shared = ()>> RayQuery for [P] {
    type Primitive = P;

    fn view(&self) -> SceneView<'_, P> {
        View::slice(self)
    }
}

impl<P: Primitive> RayQuery for Bvh<'_, P> {
    type Primitive = P;

    fn view(&self) -> SceneView<'_, P> {
        Bvh::view(self)
    }
}

impl<P: Primitive> RayQuery for BvhList<'_, P> {
    type Primitive = P;

    fn view(&self) -> SceneView<'_, P> {
        BvhList::view(self)
    }
}
