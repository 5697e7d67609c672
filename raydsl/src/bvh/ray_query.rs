//! Host queries of scenes.

use glam::{Affine3, Vec3};

use super::{
    Accelerated, Bvh, BvhList, Cost, Hits, Instances, SceneView, View, batch, query, traverse,
};
use crate::geometry::{Hit, HitOn, Primitive, Ray, transform_normal_back};
use crate::machine::{B, Data, Scalar, Slice, Type};

/// Queries of a scene: a slice, a tree ([`Bvh`]), a list of trees ([`BvhList`]), trees placed many
/// times ([`Instances`]), or an application-defined acceleration structure ([`Accelerated`]).
///
/// A query of a slice tests every primitive, and is faster than a tree for a few dozen of them. The
/// results do not depend on the scene's structure, and are the same as in kernels.
pub trait RayQuery {
    /// The type of primitives.
    type Primitive: Primitive;

    /// Returns the view that kernels work on.
    fn view(&self) -> SceneView<'_, Self::Primitive>;

    /// Finds the least `(t, id)` hit of `ray`.
    fn closest_hit(&self, ray: Ray) -> <Self::Primitive as Primitive>::Hit {
        traverse::closest_hit(&self.view(), ray)
    }

    /// Finds whether `ray` hits anything.
    fn any_hit(&self, ray: Ray) -> bool {
        traverse::any_hit(&self.view(), ray)
    }

    /// Finds the least `(t, id)` hit of each of `N` rays, `ray(0)` to `ray(N - 1)`.
    ///
    /// One query of many rays is faster than many queries of one; the results are those of
    /// [`RayQuery::closest_hit`]. Inside a kernel `ray` is a closure of the kernel.
    fn closest_hit_each<const N: usize>(
        &self,
        ray: impl Fn(u32) -> Ray,
    ) -> [<Self::Primitive as Primitive>::Hit; N] {
        core::array::from_fn(|i| self.closest_hit(ray(i as u32)))
    }

    /// Finds whether each of `N` rays, `ray(0)` to `ray(N - 1)`, hits anything.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let v = |x, y| vec3(x, y, 1.0);
    /// let triangles = [Triangle { v0: v(0.0, 0.0), v1: v(4.0, 0.0), v2: v(0.0, 4.0) }];
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

    /// Finds the least `(t, id)` hit of each ray, in packets, without a camera or a kernel. Runs on
    /// the calling thread; the results are those of [`RayQuery::closest_hit`].
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let (v1, v2) = (vec3(4.0, 0.0, 1.0), vec3(0.0, 4.0, 1.0));
    /// let triangles = [Triangle { v0: Vec3::Z, v1, v2 }];
    /// let bvh = Bvh::build(&triangles)?;
    /// let ray = |i| Ray::new(vec3(0.1 * i as f32, 0.5, 0.0), Vec3::Z);
    /// let rays: Vec<Ray> = (0..100).map(ray).collect();
    /// let hits = bvh.closest_hits(&rays);
    /// assert_eq!(hits.len(), 100);
    /// assert!(hits[35].is_hit && hits[35].t == 1.0 && !hits[36].is_hit);
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    fn closest_hits(&self, rays: &[Ray]) -> Vec<<Self::Primitive as Primitive>::Hit> {
        batch::closest_hits(&self.view(), rays)
    }

    /// Finds whether each ray hits anything, in packets, as [`RayQuery::closest_hits`]. Hundreds of
    /// rays are traced fastest if rays that begin near each other are consecutive.
    fn any_hits(&self, rays: &[Ray]) -> Vec<bool> {
        batch::any_hits(&self.view(), rays)
    }

    /// Finds the least `(t, id)` hit of `ray` that `accept` accepts, as for cut-out leaves and
    /// back-face culling. `accept` is called with some of the hits, in any order. Inside a kernel
    /// it is a closure of the kernel, which may capture variables.
    fn closest_hit_where(
        &self,
        ray: Ray,
        accept: impl Fn(<Self::Primitive as Primitive>::Hit) -> bool,
    ) -> <Self::Primitive as Primitive>::Hit {
        let (m, scene) = (&Scalar::default(), &self.view());
        let accept = |record| B(accept(Type::lane::<Scalar>(&record, 0)));
        let hit = query::closest_where(m, scene, Type::splat(m, ray), &accept);
        traverse::complete(scene, ray, Type::lane::<Scalar>(&hit, 0))
    }

    /// Finds whether `ray` has a hit that `accept` accepts.
    fn any_hit_where(
        &self,
        ray: Ray,
        accept: impl Fn(<Self::Primitive as Primitive>::Hit) -> bool,
    ) -> bool {
        let m = &Scalar::default();
        let accept = |record| B(accept(Type::lane::<Scalar>(&record, 0)));
        query::any_where(m, &self.view(), Type::splat(m, ray), &accept).0
    }

    /// Finds the `N` least `(t, id)` hits of `ray`, in order, followed by misses. Each primitive
    /// has one hit, that of its `intersect`, so a sphere is hit once.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let v = |x, y, z| vec3(x, y, z);
    /// let slab = |z| Triangle { v0: v(0.0, 0.0, z), v1: v(4.0, 0.0, z), v2: v(0.0, 4.0, z) };
    /// let slabs = [3.0, 1.0, 2.0].map(slab);
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

    /// Finds the `N` least `(t, id)` hits of `ray` that `accept` accepts, in order.
    fn multi_hit_where<const N: usize>(
        &self,
        ray: Ray,
        accept: impl Fn(<Self::Primitive as Primitive>::Hit) -> bool,
    ) -> [<Self::Primitive as Primitive>::Hit; N] {
        let m = &Scalar::default();
        let accept = |record| B(accept(Type::lane::<Scalar>(&record, 0)));
        let hits = query::multi_where(m, &self.view(), Type::splat(m, ray), &accept);
        hits.map(|hit| Type::lane::<Scalar>(&hit, 0))
    }

    /// Finds the first `N` hits of `ray` in an order of your own, followed by misses: `is_closer`
    /// returns whether its first hit precedes its second, and ties are broken by the least
    /// `(t, id)`. With an order that is not transitive the result depends on the tree. Every hit
    /// within the ray's range is compared.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let v = |x, y, z| vec3(x, y, z);
    /// let slab = |z| Triangle { v0: v(0.0, 0.0, z), v1: v(4.0, 0.0, z), v2: v(0.0, 4.0, z) };
    /// let slabs = [3.0, 1.0, 2.0].map(slab);
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
        let m = &Scalar::default();
        let host = |hit: HitOn<Scalar>| Hit::lane::<Scalar>(&hit, 0);
        let is_closer = |a, b| B(is_closer(host(a), host(b)));
        let hits = query::multi_by(m, &self.view(), Type::splat(m, ray), &is_closer);
        hits.map(|hit| Type::lane::<Scalar>(&hit, 0))
    }

    /// Returns every hit within the ray's range, in the order of `(t, inst_id, prim_id)`: all
    /// crossings of a primitive, a sphere's entry and its exit, up to [`Primitive::MAX_CROSSINGS`]
    /// of each.
    ///
    /// They are found on demand, four at a time. So a loop that stops early costs little more than
    /// [`closest_hit`](RayQuery::closest_hit), one over all hits a traversal for four of them. In
    /// kernels `for hit in scene.hits(ray)` is the same.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// #[primitive(sphere(center, radius))]
    /// struct Ball {
    ///     center: Vec3,
    ///     radius: f32,
    /// }
    ///
    /// let balls = [5.0, 8.0].map(|z| Ball { center: vec3(0.0, 0.0, z), radius: 1.0 });
    /// let bvh = Bvh::build(&balls)?;
    /// let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    /// let hits: Vec<(f32, u32)> = bvh.hits(ray).map(|hit| (hit.t, hit.prim_id)).collect();
    /// assert_eq!(hits, [(4.0, 0), (6.0, 0), (7.0, 1), (9.0, 1)]);
    ///
    /// // How far the ray goes through glass.
    /// let thickness = kernel!(|ray: Ray| {
    ///     let mut inside = 0.0;
    ///     for hit in bvh.hits(ray) {
    ///         inside = hit.t - inside;
    ///     }
    ///     inside
    /// });
    /// assert_eq!(thickness.call((ray,)), 4.0);
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    fn hits(&self, ray: Ray) -> Hits<'_, Self::Primitive> {
        Hits::new(self.view(), ray)
    }

    /// Returns the ray in the space of the object that was hit: the ray itself in a scene without
    /// [instances](Instances). Primitives, and their methods for hits, are in the object's space.
    /// `t` is the same in both.
    fn local_ray(&self, ray: Ray, hit: Hit) -> Ray {
        self.view().local_ray(hit.inst_id, ray)
    }

    /// Returns the transform from the space of the scene to that of the object that was hit; the
    /// identity without instances. [`RayQuery::local_ray`] transforms a ray to the same bits as the
    /// traversal does.
    fn to_object(&self, hit: Hit) -> Affine3 {
        self.view().to_object(hit.inst_id)
    }

    /// Transforms the unit normal of a hit from the space of its object to that of the scene.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let (v1, v2) = (vec3(4.0, 0.0, 4.0), vec3(0.0, 4.0, 0.0));
    /// let triangles = [Triangle { v0: Vec3::ZERO, v1, v2 }];
    /// let trees = [Bvh::build(&triangles)?];
    /// let flat = Affine3::from_scale(vec3(1.0, 1.0, 0.5));
    /// let scene = Instances::build(&trees, &[Instance::new(0, flat)])?;
    /// let ray = Ray::new(vec3(1.0, 1.0, 9.0), vec3(0.0, 0.0, -1.0));
    /// let hit = scene.closest_hit(ray);
    /// let normal = scene.primitive(hit).normal(scene.local_ray(ray, hit), hit);
    /// let normal = scene.normal_in_scene(hit, normal);
    /// // The slope is half of what it was: 1 in 2.
    /// assert!((normal - vec3(-1.0, 0.0, 2.0).normalize()).length() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn normal_in_scene(&self, hit: Hit, normal: Vec3) -> Vec3 {
        transform_normal_back(normal, self.to_object(hit))
    }

    /// Finds the least `(t, id)` hit of `ray`, and the cost of the traversal. In kernels all
    /// variants count the nodes of a single-ray traversal, and a device tests every primitive of an
    /// [`Accelerated`].
    fn closest_hit_with_cost(&self, ray: Ray) -> (<Self::Primitive as Primitive>::Hit, Cost) {
        traverse::closest_hit_with_cost(&self.view(), ray)
    }

    /// Finds whether `ray` hits anything, and the cost of the traversal. On the host only.
    fn any_hit_with_cost(&self, ray: Ray) -> (bool, Cost) {
        traverse::any_hit_with_cost(&self.view(), ray)
    }

    /// Returns the primitive that was hit; the first one for a miss, so that code need not branch.
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
        View::slice(Slice::new(self, "prims"))
    }
}

impl<P: Primitive> RayQuery for Bvh<'_, P> {
    type Primitive = P;

    fn view(&self) -> SceneView<'_, P> {
        Bvh::view(self)
    }
}

impl<P: Primitive> RayQuery for Accelerated<'_, P> {
    type Primitive = P;

    fn view(&self) -> SceneView<'_, P> {
        Accelerated::view(self)
    }
}

impl<P: Primitive> RayQuery for Instances<'_, P> {
    type Primitive = P;

    fn view(&self) -> SceneView<'_, P> {
        Instances::view(self)
    }
}

impl<P: Primitive> RayQuery for BvhList<'_, P> {
    type Primitive = P;

    fn view(&self) -> SceneView<'_, P> {
        BvhList::view(self)
    }
}
