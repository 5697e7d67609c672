//! Host queries of scenes.

use glam::{Affine3, Vec3};

use super::traverse::CostOn;
use super::{Accelerated, Bvh, BvhList, Cost, Hits, Instances, RayQueryOn, SceneView, View};
use crate::geometry::{Hit, HitOn, HitRecord, Primitive, Ray, RayOn, transform_normal_back};
use crate::machine::{A3, B, Coerce, Const, Data, Machine, On, Scalar, Slice, Type, U, V3, fill};

/// A scene whose hits are [`Hit`]s: what a kernel that is generic over its scene asks for, by a
/// parameter `scene: &S` with `S: RayQuery + ?Sized`. Its queries are those of [`RecordQuery`], which
/// every scene has.
///
/// ```
/// use raydsl::kernel;
/// use raydsl::prelude::*;
///
/// /// Finds the distance to the surface, at most `far`.
/// #[kernel]
/// fn depth<S: RayQuery + ?Sized>(scene: &S, far: f32, ray: Ray) -> f32 {
///     let hit = scene.closest_hit(ray);
///     if hit.is_hit { min(hit.t, far) } else { far }
/// }
///
/// let (v1, v2) = (vec3(4.0, 0.0, 1.0), vec3(0.0, 4.0, 1.0));
/// let triangles = [Triangle { v0: Vec3::Z, v1, v2 }];
/// let bvh = Bvh::build(&triangles)?;
/// let seen = kernel!(|ray: Ray| depth(&bvh, 10.0, ray));
/// assert_eq!(seen.call((Ray::new(vec3(1.0, 1.0, 0.0), Vec3::Z),)), 1.0);
/// # Ok::<(), raydsl::bvh::BuildError>(())
/// ```
pub trait RayQuery: RecordQuery<Hit = Hit> {}

impl<S: RecordQuery<Hit = Hit> + ?Sized> RayQuery for S {}

/// Queries of a scene: a slice, a tree ([`Bvh`]), a list of trees ([`BvhList`]), trees placed many
/// times ([`Instances`]), or an application-defined acceleration structure ([`Accelerated`]). Its
/// hits have a record of any type: [`Hit`], or what the primitives' `intersect` returns.
///
/// A query of a slice tests every primitive: for a handful of them a tree gains little. The results
/// do not depend on the scene's structure, and are the same as in kernels.
pub trait RecordQuery: Sync {
    /// The record of a hit: [`Hit`], or what the primitives' `intersect` returns.
    type Hit: HitRecord;

    /// The view that kernels work on.
    type View<'a>: RayQueryOn<Hit = Self::Hit>
    where
        Self: 'a;

    /// Returns the view that kernels work on.
    fn view(&self) -> Self::View<'_>;

    /// Finds the least `(t, id)` hit of `ray`.
    fn closest_hit(&self, ray: Ray) -> Self::Hit {
        self.view().closest_hit_of(ray)
    }

    /// Finds whether `ray` hits anything.
    fn any_hit(&self, ray: Ray) -> bool {
        self.view().any_hit_of(ray)
    }

    /// Finds the least `(t, id)` hit of each of `N` rays, `ray(0)` to `ray(N - 1)`.
    ///
    /// One query of many rays is faster than many queries of one; the results are those of
    /// [`RecordQuery::closest_hit`]. Inside a kernel `ray` is a closure of the kernel.
    fn closest_hit_each<const N: usize>(&self, ray: impl Fn(u32) -> Ray) -> [Self::Hit; N] {
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
    /// the calling thread; the results are those of [`RecordQuery::closest_hit`].
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
    fn closest_hits(&self, rays: &[Ray]) -> Vec<Self::Hit> {
        self.view().closest_hits_of(rays)
    }

    /// Finds whether each ray hits anything, in packets, as [`RecordQuery::closest_hits`]. Hundreds of
    /// rays are traced fastest if rays that begin near each other are consecutive.
    fn any_hits(&self, rays: &[Ray]) -> Vec<bool> {
        self.view().any_hits_of(rays)
    }

    /// Finds the least `(t, id)` hit of `ray` that `accept` accepts, as for cut-out leaves and
    /// back-face culling. `accept` is called with some of the hits, in any order. Inside a kernel
    /// it is a closure of the kernel, which may capture variables.
    fn closest_hit_where(&self, ray: Ray, accept: impl Fn(Self::Hit) -> bool) -> Self::Hit {
        let m = &Scalar::default();
        let accept = |record| B(accept(Type::lane::<Scalar>(&record, 0)));
        let hit = self.view().closest_hit_where(m, Type::splat(m, ray), accept);
        Type::lane::<Scalar>(&hit, 0)
    }

    /// Finds whether `ray` has a hit that `accept` accepts.
    fn any_hit_where(&self, ray: Ray, accept: impl Fn(Self::Hit) -> bool) -> bool {
        let m = &Scalar::default();
        let accept = |record| B(accept(Type::lane::<Scalar>(&record, 0)));
        self.view().any_hit_where(m, Type::splat(m, ray), accept).0
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
    fn multi_hit<const N: usize>(&self, ray: Ray) -> [Self::Hit; N] {
        self.multi_hit_where(ray, |_| true)
    }

    /// Finds the `N` least `(t, id)` hits of `ray` that `accept` accepts, in order.
    fn multi_hit_where<const N: usize>(
        &self,
        ray: Ray,
        accept: impl Fn(Self::Hit) -> bool,
    ) -> [Self::Hit; N] {
        let m = &Scalar::default();
        let accept = |record| B(accept(Type::lane::<Scalar>(&record, 0)));
        let hits = self.view().multi_hit_where(m, Type::splat(m, ray), accept);
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
    ) -> [Self::Hit; N] {
        let m = &Scalar::default();
        let host = |hit: HitOn<Scalar>| Hit::lane::<Scalar>(&hit, 0);
        let is_closer = |a, b| B(is_closer(host(a), host(b)));
        let hits = self.view().multi_hit_by(m, Type::splat(m, ray), is_closer);
        hits.map(|hit| Type::lane::<Scalar>(&hit, 0))
    }

    /// Returns every hit within the ray's range, in the order of `(t, inst_id, prim_id)`: all
    /// crossings of a primitive, a sphere's entry and its exit, up to [`Primitive::MAX_CROSSINGS`]
    /// of each.
    ///
    /// They are found on demand, four at a time. So a loop that stops early costs little more than
    /// [`closest_hit`](RecordQuery::closest_hit), one over all hits a traversal for four of them. In
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
    fn hits(&self, ray: Ray) -> Hits<Self::View<'_>> {
        Hits::new(self.view(), ray)
    }

    /// Returns the ray in the space of the object that was hit: the ray itself in a scene without
    /// [instances](Instances). Primitives, and their methods for hits, are in the object's space.
    /// `t` is the same in both.
    fn local_ray(&self, ray: Ray, hit: Hit) -> Ray {
        let m = &Scalar::default();
        let ray = RayQueryOn::local_ray(self.view(), m, Type::splat(m, ray), U(hit.inst_id));
        Type::lane::<Scalar>(&ray, 0)
    }

    /// Returns the transform from the space of the scene to that of the object that was hit; the
    /// identity without instances. [`RecordQuery::local_ray`] transforms a ray to the same bits as the
    /// traversal does.
    fn to_object(&self, hit: Hit) -> Affine3 {
        let m = &Scalar::default();
        Type::lane::<Scalar>(&RayQueryOn::to_object(self.view(), m, U(hit.inst_id)), 0)
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
    /// variants count the nodes of a single ray's traversal of the binary tree, and a device tests
    /// every primitive of an [`Accelerated`].
    fn closest_hit_with_cost(&self, ray: Ray) -> (Self::Hit, Cost) {
        self.view().closest_hit_with_cost_of(ray)
    }

    /// Finds whether `ray` hits anything, and the cost of the traversal. On the host only.
    fn any_hit_with_cost(&self, ray: Ray) -> (bool, Cost) {
        self.view().any_hit_with_cost_of(ray)
    }

    // What kernels call that are generic over the scene.

    #[doc(hidden)]
    #[inline(always)]
    fn closest_hit_on<M: Machine>(
        m: &M,
        scene: &Self,
        ray: impl Coerce<M, RayOn<M>>,
    ) -> On<Self::Hit, M> {
        let [hit] = scene.view().closest_hits(m, [ray.coerce(m)]);
        hit
    }

    #[doc(hidden)]
    #[inline(always)]
    fn any_hit_on<M: Machine>(m: &M, scene: &Self, ray: impl Coerce<M, RayOn<M>>) -> B<M> {
        let [is_hit] = scene.view().any_hits(m, [ray.coerce(m)]);
        is_hit
    }

    #[doc(hidden)]
    #[inline(always)]
    fn closest_hit_each_on<M: Machine, R: Coerce<M, RayOn<M>>, const N: usize>(
        m: &M,
        scene: &Self,
        _: Const<N>,
        ray: impl Fn(&M, U<M>) -> R,
    ) -> [On<Self::Hit, M>; N] {
        closest_hit_each(m, scene.view(), ray)
    }

    #[doc(hidden)]
    #[inline(always)]
    fn any_hit_each_on<M: Machine, R: Coerce<M, RayOn<M>>, const N: usize>(
        m: &M,
        scene: &Self,
        _: Const<N>,
        ray: impl Fn(&M, U<M>) -> R,
    ) -> [B<M>; N] {
        any_hit_each(m, scene.view(), ray)
    }

    #[doc(hidden)]
    #[inline(always)]
    fn closest_hit_with_cost_on<M: Machine>(
        m: &M,
        scene: &Self,
        ray: impl Coerce<M, RayOn<M>>,
    ) -> (On<Self::Hit, M>, CostOn<M>) {
        scene.view().closest_hit_with_cost(m, ray.coerce(m))
    }

    #[doc(hidden)]
    #[inline(always)]
    fn closest_hit_where_on<M: Machine, R: Coerce<M, B<M>>>(
        m: &M,
        scene: &Self,
        ray: impl Coerce<M, RayOn<M>>,
        accept: impl Fn(&M, On<Self::Hit, M>) -> R,
    ) -> On<Self::Hit, M> {
        scene.view().closest_hit_where(m, ray.coerce(m), |hit| accept(m, hit).coerce(m))
    }

    #[doc(hidden)]
    #[inline(always)]
    fn any_hit_where_on<M: Machine, R: Coerce<M, B<M>>>(
        m: &M,
        scene: &Self,
        ray: impl Coerce<M, RayOn<M>>,
        accept: impl Fn(&M, On<Self::Hit, M>) -> R,
    ) -> B<M> {
        scene.view().any_hit_where(m, ray.coerce(m), |hit| accept(m, hit).coerce(m))
    }

    #[doc(hidden)]
    #[inline(always)]
    fn multi_hit_on<M: Machine, const N: usize>(
        m: &M,
        scene: &Self,
        _: Const<N>,
        ray: impl Coerce<M, RayOn<M>>,
    ) -> [On<Self::Hit, M>; N] {
        scene.view().multi_hit_where(m, ray.coerce(m), |_| B(m.bool(true)))
    }

    #[doc(hidden)]
    #[inline(always)]
    fn multi_hit_where_on<M: Machine, R: Coerce<M, B<M>>, const N: usize>(
        m: &M,
        scene: &Self,
        _: Const<N>,
        ray: impl Coerce<M, RayOn<M>>,
        accept: impl Fn(&M, On<Self::Hit, M>) -> R,
    ) -> [On<Self::Hit, M>; N] {
        scene.view().multi_hit_where(m, ray.coerce(m), |hit| accept(m, hit).coerce(m))
    }

    #[doc(hidden)]
    #[inline(always)]
    fn multi_hit_by_on<M: Machine, R: Coerce<M, B<M>>, const N: usize>(
        m: &M,
        scene: &Self,
        _: Const<N>,
        ray: impl Coerce<M, RayOn<M>>,
        is_closer: impl Fn(&M, HitOn<M>, HitOn<M>) -> R,
    ) -> [On<Self::Hit, M>; N] {
        scene.view().multi_hit_by(m, ray.coerce(m), |a, b| is_closer(m, a, b).coerce(m))
    }

    #[doc(hidden)]
    #[inline(always)]
    fn hits_on<'a, M: Machine>(
        m: &M,
        scene: &'a Self,
        ray: impl Coerce<M, RayOn<M>>,
    ) -> <Self::View<'a> as RayQueryOn>::Hits<M> {
        scene.view().hits(m, ray.coerce(m))
    }

    #[doc(hidden)]
    #[inline(always)]
    fn local_ray_on<M: Machine>(
        m: &M,
        scene: &Self,
        ray: impl Coerce<M, RayOn<M>>,
        hit: impl Coerce<M, HitOn<M>>,
    ) -> RayOn<M> {
        RayQueryOn::local_ray(scene.view(), m, ray.coerce(m), hit.coerce(m).inst_id)
    }

    #[doc(hidden)]
    #[inline(always)]
    fn to_object_on<M: Machine>(m: &M, scene: &Self, hit: impl Coerce<M, HitOn<M>>) -> A3<M> {
        RayQueryOn::to_object(scene.view(), m, hit.coerce(m).inst_id)
    }

    #[doc(hidden)]
    #[inline(always)]
    fn normal_in_scene_on<M: Machine>(
        m: &M,
        scene: &Self,
        hit: impl Coerce<M, HitOn<M>>,
        normal: impl Coerce<M, V3<M>>,
    ) -> V3<M> {
        let map = RayQueryOn::to_object(scene.view(), m, hit.coerce(m).inst_id);
        transform_normal_back::on(m, normal, map)
    }
}

/// Traces rays that a closure of the kernel makes.
#[inline(always)]
pub(crate) fn closest_hit_each<
    M: Machine,
    V: RayQueryOn,
    R: Coerce<M, RayOn<M>>,
    const N: usize,
>(
    m: &M,
    scene: V,
    ray: impl Fn(&M, U<M>) -> R,
) -> [On<V::Hit, M>; N] {
    if M::RUNS {
        return scene.closest_hits(m, rays(m, ray));
    }
    m.each(
        #[inline(always)]
        |i| {
            let [hit] = scene.closest_hits(m, [ray(m, i).coerce(m)]);
            hit
        },
    )
}

/// Traces rays that a closure of the kernel makes.
#[inline(always)]
pub(crate) fn any_hit_each<M: Machine, V: RayQueryOn, R: Coerce<M, RayOn<M>>, const N: usize>(
    m: &M,
    scene: V,
    ray: impl Fn(&M, U<M>) -> R,
) -> [B<M>; N] {
    if M::RUNS {
        return scene.any_hits(m, rays(m, ray));
    }
    m.each(
        #[inline(always)]
        |i| {
            let [is_hit] = scene.any_hits(m, [ray(m, i).coerce(m)]);
            is_hit
        },
    )
}

/// Evaluates all rays before the query.
#[inline(always)]
fn rays<M: Machine, R: Coerce<M, RayOn<M>>, const N: usize>(
    m: &M,
    ray: impl Fn(&M, U<M>) -> R,
) -> [RayOn<M>; N] {
    fill(
        #[inline(always)]
        |i| ray(m, U(m.u32(i as u32))).coerce(m),
    )
}

/// A scene of primitives of one type, which can be read by their hits.
pub trait PrimitiveScene: RecordQuery<Hit = <Self::Primitive as Primitive>::Hit> {
    /// The type of primitives.
    type Primitive: Primitive;

    /// Returns the view of the primitives.
    #[doc(hidden)]
    fn primitives_view(&self) -> SceneView<'_, Self::Primitive>;

    /// Returns the primitive that was hit; the first one for a miss, so that code need not branch.
    ///
    /// # Panics
    ///
    /// If there are no primitives.
    fn primitive(&self, hit: Hit) -> Self::Primitive {
        self.primitives_view().get(if hit.is_hit { hit.prim_id } else { 0 })
    }

    #[doc(hidden)]
    #[inline(always)]
    fn primitive_on<M: Machine>(
        m: &M,
        scene: &Self,
        hit: impl Coerce<M, HitOn<M>>,
    ) -> On<Self::Primitive, M> {
        primitive_at(m, &scene.primitives_view(), hit.coerce(m))
    }
}

/// Returns the primitive that was hit.
#[inline(always)]
pub(super) fn primitive_at<M: Machine, P: Primitive>(
    m: &M,
    scene: &SceneView<'_, P>,
    hit: HitOn<M>,
) -> P::On<M> {
    let id = m.u32_select(hit.is_hit.0, hit.prim_id.0, m.u32(0));
    // The hit may belong to another scene.
    m.element(scene, U(id))
}

macro_rules! scenes {
    ($([$($g:tt)*] $t:ty, |$scene:ident| $view:expr;)+) => {
        $(
            impl<$($g)*> RecordQuery for $t {
                type Hit = P::Hit;
                type View<'v>
                    = SceneView<'v, P>
                where
                    Self: 'v;

                #[inline(always)]
                fn view(&self) -> SceneView<'_, P> {
                    let $scene = self;
                    $view
                }
            }

            impl<$($g)*> PrimitiveScene for $t {
                type Primitive = P;

                #[inline(always)]
                fn primitives_view(&self) -> SceneView<'_, P> {
                    self.view()
                }
            }
        )+
    };
}

scenes! {
    [P: Primitive<Shared = ()>] [P], |prims| View::slice(Slice::new(prims, "prims"));
    [P: Primitive<Shared = ()>] Slice<'_, P>, |prims| View::slice(*prims);
    [P: Primitive] SceneView<'_, P>, |view| *view;
    [P: Primitive] Bvh<'_, P>, |bvh| Bvh::view(bvh);
    [P: Primitive] Accelerated<'_, P>, |scene| Accelerated::view(scene);
    [P: Primitive] Instances<'_, P>, |scene| Instances::view(scene);
    [P: Primitive] BvhList<'_, P>, |list| BvhList::view(list);
}

impl<S: RecordQuery + ?Sized> RecordQuery for &S {
    type Hit = S::Hit;
    type View<'v>
        = S::View<'v>
    where
        Self: 'v;

    #[inline(always)]
    fn view(&self) -> S::View<'_> {
        S::view(self)
    }
}
