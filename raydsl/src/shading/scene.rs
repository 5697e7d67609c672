//! The trait of scenes that integrators can shade.

use glam::{Vec2, Vec3, Vec4, vec4};

use super::Surface;
use super::placed::placed_point;
use crate::bvh::{
    Accelerated, Bvh, BvhList, Instances, Joined, PrimitiveScene, RayQuery, RayQueryOn,
    RecordQuery, SceneRef, SceneView, Tabled,
};
use crate::geometry::{Hit, HitOn, Primitive, Ray, RayOn, SurfacePoint, SurfacePointOn};
use crate::machine::functions::vec4;
use crate::machine::{Coerce, I, Machine, Method, Scalar, Slice, TableView, U, Value, name};

use crate::sampling::Frame;
use crate::{Type, kernel};

/// What is known of a point that a ray hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct ShadingPoint {
    /// The position in the scene, with a bound of its error, and the geometric normal: unit length,
    /// on either side.
    pub point: SurfacePoint,
    /// The normal for shading: that of a smooth surface which the geometry approximates; otherwise
    /// the geometric one. Unit length, on the side of the geometric normal.
    pub shading_normal: Vec3,
    /// A tangent: a unit vector perpendicular to the shading normal, in the direction in which the
    /// first surface coordinate grows where that is known, otherwise any. The last component is 1,
    /// or -1 where the bitangent is `-cross(shading_normal, tangent)`.
    pub tangent: Vec4,
    /// The surface coordinates, for textures.
    pub uv: Vec2,
    /// The number of the material, counted by the application.
    pub material: u32,
    /// The albedo: red, green and blue, each from 0 to 1.
    pub albedo: Vec3,
}

/// Returns some tangent.
#[kernel]
fn any_tangent(normal: Vec3) -> Vec4 {
    let x = Frame::around(normal).x;
    vec4(x.x, x.y, x.z, 1.0)
}

/// A scene that can be shaded: a slice, a tree, a list, instances or an accelerator of primitives
/// that are a [`Surface`], or a struct of several such scenes with `#[derive(Scene)]`.
///
/// A kernel is generic over its scene by a parameter `scene: &S` with `S: Scene + ?Sized`; one that
/// only queries asks for [`RayQuery`].
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::{Scene, kernel};
///
/// /// The cosine of the angle between a ray and the surface that it hits.
/// #[kernel]
/// fn facing_ratio<S: Scene + ?Sized>(scene: &S, ray: Ray) -> f32 {
///     let hit = scene.closest_hit(ray);
///     if hit.is_hit { scene.surface(ray, hit).normal.dot(ray.direction).abs() } else { 0.0 }
/// }
///
/// let v = |x, y, z| vec3(x, y, z);
/// let flat = [Triangle { v0: v(0.0, 0.0, 4.0), v1: v(4.0, 0.0, 4.0), v2: v(0.0, 4.0, 4.0) }];
/// let steep = [Triangle { v0: v(-4.0, 0.0, 1.0), v1: v(0.0, 0.0, 5.0), v2: v(0.0, 4.0, 5.0) }];
///
/// /// Two trees as one scene.
/// #[derive(Scene)]
/// struct Both<'a> {
///     flat: Bvh<'a, Triangle>,
///     steep: Bvh<'a, Triangle>,
/// }
///
/// let both = Both { flat: Bvh::build(&flat)?, steep: Bvh::build(&steep)? };
/// let shade = kernel!(|ray: Ray| facing_ratio(&both, ray));
/// let ray = |x| Ray::new(v(x, 1.0, 0.0), Vec3::Z);
/// assert_eq!(shade.call((ray(1.0),)), 1.0);
/// let ratio = shade.call((ray(-0.5),));
/// assert!(ratio > 0.5 && ratio < 0.8, "{ratio}");
/// # Ok::<(), raydsl::bvh::BuildError>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a scene that can be shaded",
    note = "its primitives need `#[kernel] impl Surface`, and a struct of scenes `#[derive(Scene)]`"
)]
pub trait Scene: RayQuery {
    /// Returns the point that `ray` hits, with its geometric normal, in the space of the scene.
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        let m = &Scalar::default();
        SurfacePoint::lane::<Scalar>(&Self::surface_on(m, self, ray_on(m, ray), hit_on(m, hit)), 0)
    }

    /// Returns all that is known of the point that `ray` hits.
    fn shading_point(&self, ray: Ray, hit: Hit) -> ShadingPoint {
        let m = &Scalar::default();
        let point = Self::shading_point_on(m, self, ray_on(m, ray), hit_on(m, hit));
        ShadingPoint::lane::<Scalar>(&point, 0)
    }

    #[doc(hidden)]
    #[inline(always)]
    fn surface_on<M: Machine>(
        m: &M,
        scene: &Self,
        ray: impl Coerce<M, RayOn<M>>,
        hit: impl Coerce<M, HitOn<M>>,
    ) -> SurfacePointOn<M> {
        Self::asked_on::<M, PointAlone>(m, scene, ray.coerce(m), hit.coerce(m))
    }

    #[doc(hidden)]
    #[inline(always)]
    fn shading_point_on<M: Machine>(
        m: &M,
        scene: &Self,
        ray: impl Coerce<M, RayOn<M>>,
        hit: impl Coerce<M, HitOn<M>>,
    ) -> ShadingPointOn<M> {
        Self::asked_on::<M, WholePoint>(m, scene, ray.coerce(m), hit.coerce(m))
    }

    /// Returns 1 where `ray` enters a closed object, -1 where it leaves it, and 0 where it passes
    /// through an edge or a vertex of a mesh and another triangle counts the crossing: the sum over
    /// [`hits`](crate::bvh::RecordQuery::hits) up to a distance is the number of objects entered
    /// and not left.
    fn crossing(&self, ray: Ray, hit: Hit) -> i32 {
        let m = &Scalar::default();
        i32::lane::<Scalar>(&Self::crossing_on(m, self, ray_on(m, ray), hit_on(m, hit)), 0)
    }

    #[doc(hidden)]
    #[inline(always)]
    fn crossing_on<M: Machine>(
        m: &M,
        scene: &Self,
        ray: impl Coerce<M, RayOn<M>>,
        hit: impl Coerce<M, HitOn<M>>,
    ) -> I<M> {
        Self::asked_on::<M, CrossingAlone>(m, scene, ray.coerce(m), hit.coerce(m))
    }

    /// Returns what is asked of the point that `ray` hits.
    #[doc(hidden)]
    fn asked_on<M: Machine, A: Asked>(
        m: &M,
        scene: &Self,
        ray: RayOn<M>,
        hit: HitOn<M>,
    ) -> A::On<M>;
}

/// How much is asked of a point, so that no variant computes more.
#[doc(hidden)]
pub trait Asked {
    /// What is returned.
    type On<M: Machine>: Value<M>;

    /// Returns it, given how to compute the point, all that is known of it, and the crossing.
    fn of<M: Machine>(
        point: impl FnOnce() -> SurfacePointOn<M>,
        whole: impl FnOnce() -> ShadingPointOn<M>,
        crossing: impl FnOnce() -> I<M>,
    ) -> Self::On<M>;
}

/// The position and the geometric normal.
#[doc(hidden)]
#[derive(Debug)]
pub enum PointAlone {}

impl Asked for PointAlone {
    type On<M: Machine> = SurfacePointOn<M>;

    #[inline(always)]
    fn of<M: Machine>(
        point: impl FnOnce() -> SurfacePointOn<M>,
        _: impl FnOnce() -> ShadingPointOn<M>,
        _: impl FnOnce() -> I<M>,
    ) -> SurfacePointOn<M> {
        point()
    }
}

/// All that is known.
#[doc(hidden)]
#[derive(Debug)]
pub enum WholePoint {}

impl Asked for WholePoint {
    type On<M: Machine> = ShadingPointOn<M>;

    #[inline(always)]
    fn of<M: Machine>(
        _: impl FnOnce() -> SurfacePointOn<M>,
        whole: impl FnOnce() -> ShadingPointOn<M>,
        _: impl FnOnce() -> I<M>,
    ) -> ShadingPointOn<M> {
        whole()
    }
}

/// Whether the ray enters or leaves.
#[doc(hidden)]
#[derive(Debug)]
pub enum CrossingAlone {}

impl Asked for CrossingAlone {
    type On<M: Machine> = I<M>;

    #[inline(always)]
    fn of<M: Machine>(
        _: impl FnOnce() -> SurfacePointOn<M>,
        _: impl FnOnce() -> ShadingPointOn<M>,
        crossing: impl FnOnce() -> I<M>,
    ) -> I<M> {
        crossing()
    }
}

#[inline(always)]
fn ray_on(m: &Scalar, ray: Ray) -> RayOn<Scalar> {
    Ray::splat(m, ray)
}

#[inline(always)]
fn hit_on(m: &Scalar, hit: Hit) -> HitOn<Scalar> {
    Hit::splat(m, hit)
}

/// Returns a point of a primitive in the space of the scene.
#[inline(always)]
pub(super) fn in_scene<M: Machine, P: Primitive>(
    m: &M,
    scene: SceneView<'_, P>,
    ray: RayOn<M>,
    hit: HitOn<M>,
    point: SurfacePointOn<M>,
) -> SurfacePointOn<M> {
    if !scene.has_instances() {
        return point;
    }
    placed_point::on(m, RayQueryOn::to_object(scene, m, hit.inst_id), ray, hit, point)
}

macro_rules! scenes {
    ($([$($g:tt)*] $t:ty;)+) => {
        $(
            impl<$($g)*> Scene for $t {
                #[inline(always)]
                fn asked_on<M: Machine, A: Asked>(
                    m: &M,
                    scene: &Self,
                    ray: RayOn<M>,
                    hit: HitOn<M>,
                ) -> A::On<M> {
                    let (scene, prim) = (scene.view(), Self::primitive_on(m, scene, hit));
                    let local = RayQueryOn::local_ray(scene, m, ray, hit.inst_id);
                    let point =
                        || in_scene(m, scene, ray, hit, P::surface_on(m, prim, local, hit));
                    let whole = || {
                        let point = point();
                        ShadingPointOn {
                            point,
                            shading_normal: point.normal,
                            tangent: any_tangent::on(m, point.normal),
                            uv: P::uv_on(m, prim, local, hit),
                            material: P::material_on(m, prim, local, hit),
                            albedo: P::albedo_on(m, prim, local, hit),
                        }
                    };
                    A::of(point, whole, || P::crossing_on(m, prim, local, hit))
                }
            }
        )+
    };
}

scenes! {
    [P: Primitive<Hit = Hit, Shared = ()> + Surface] [P];
    [P: Primitive<Hit = Hit, Shared = ()> + Surface] Slice<'_, P>;
    [P: Primitive<Hit = Hit> + Surface] SceneView<'_, P>;
    [P: Primitive<Hit = Hit> + Surface] Bvh<'_, P>;
    [P: Primitive<Hit = Hit> + Surface] Accelerated<'_, P>;
    [P: Primitive<Hit = Hit> + Surface] Instances<'_, P>;
    [P: Primitive<Hit = Hit> + Surface] BvhList<'_, P>;
}

impl<S: Scene + ?Sized> Scene for &S {
    #[inline(always)]
    fn asked_on<M: Machine, A: Asked>(
        m: &M,
        scene: &Self,
        ray: RayOn<M>,
        hit: HitOn<M>,
    ) -> A::On<M> {
        S::asked_on::<M, A>(m, scene, ray, hit)
    }
}

/// Returns a hit as the part of a scene sees it.
#[inline(always)]
fn in_part<M: Machine>(hit: HitOn<M>, inst_id: U<M>) -> HitOn<M> {
    HitOn { inst_id, ..hit }
}

impl<S, T> Scene for Joined<S, T>
where
    S: RayQueryOn<Hit = Hit> + Scene,
    T: RayQueryOn<Hit = Hit> + Scene,
{
    #[inline(always)]
    fn asked_on<M: Machine, A: Asked>(
        m: &M,
        scene: &Self,
        ray: RayOn<M>,
        hit: HitOn<M>,
    ) -> A::On<M> {
        scene.of_either(
            m,
            hit.inst_id,
            #[inline(always)]
            |scene, inst_id| S::asked_on::<M, A>(m, &scene, ray, in_part(hit, inst_id)),
            #[inline(always)]
            |scene, inst_id| T::asked_on::<M, A>(m, &scene, ray, in_part(hit, inst_id)),
        )
    }
}

impl<S: RayQueryOn<Hit = Hit> + Scene, T: TableView> Scene for Tabled<S, T> {
    #[inline(always)]
    fn asked_on<M: Machine, A: Asked>(
        m: &M,
        scene: &Self,
        ray: RayOn<M>,
        hit: HitOn<M>,
    ) -> A::On<M> {
        S::asked_on::<M, A>(m, &scene.scene(), ray, hit)
    }
}

impl<S: Scene + ?Sized> Scene for SceneRef<'_, S> {
    #[inline(always)]
    fn asked_on<M: Machine, A: Asked>(
        m: &M,
        scene: &Self,
        ray: RayOn<M>,
        hit: HitOn<M>,
    ) -> A::On<M> {
        S::asked_on::<M, A>(m, SceneRef::scene(*scene), ray, hit)
    }
}

/// Implements the methods in kernels for a scene whose type is known.
macro_rules! methods {
    ($([$($g:tt)*] $t:ty, $s:ty, |$this:ident| $scene:expr;)+) => {
        $(
            methods! { @one [$($g)*] $t, $s, |$this| $scene; "surface", surface_on, SurfacePointOn }
            methods! {
                @one [$($g)*] $t, $s, |$this| $scene;
                "shading_point", shading_point_on, ShadingPointOn
            }
            methods! { @one [$($g)*] $t, $s, |$this| $scene; "crossing", crossing_on, I }
        )+
    };
    (
        @one [$($g:tt)*] $t:ty, $s:ty, |$this:ident| $scene:expr;
        $name:literal, $function:ident, $out:ident
    ) => {
        #[diagnostic::do_not_recommend]
        impl<$($g)*, M: Machine> Method<{ name($name) }, M, (RayOn<M>, HitOn<M>)> for $t {
            type Output = $out<M>;

            #[inline(always)]
            fn call(self, m: &M, (ray, hit): (RayOn<M>, HitOn<M>)) -> $out<M> {
                let $this = self;
                <$s as Scene>::$function(m, $scene, ray, hit)
            }
        }
    };
}

methods! {
    ['a] super::MeshView<'a>, super::MeshView<'a>, |view| &view;
    ['a, P: Primitive<Hit = Hit> + Surface] SceneView<'a, P>, SceneView<'a, P>, |view| &view;
    ['a, P: Primitive<Hit = Hit, Shared = ()> + Surface] Slice<'a, P>, Slice<'a, P>, |prims| &prims;
    [
        S: RayQueryOn<Hit = Hit> + Scene, T: RayQueryOn<Hit = Hit> + Scene
    ] Joined<S, T>, Joined<S, T>, |scenes| &scenes;
    [
        S: RayQueryOn<Hit = Hit> + Scene, T: TableView
    ] Tabled<S, T>, Tabled<S, T>, |scene| &scene;
    ['s, S: Scene + ?Sized] &'s S, S, |scene| scene;
}
