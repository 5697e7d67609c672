//! Application-defined acceleration structures.

use super::view::Standing;
use super::{SceneView, View};
use crate::geometry::{IntoShared, Kinds, Primitive, Ray, Shared, SharedSlices};
use crate::machine::{Capture, Machine, Owner, Parameter, Resource};

/// Application-defined acceleration structure: a grid, the tree of another library, a closure.
///
/// It replaces the tree of a [`Bvh`](super::Bvh) in an [`Accelerated`] scene, whose queries have
/// the same results: hits are a function of the ray and the primitives, and the structure only
/// culls primitives.
pub trait Accelerator: Send + Sync {
    /// Calls `meet` with the id of every primitive that `ray` may hit at or before the distance
    /// `limit`. Ids may repeat, and come in any order, but nearer ones first makes for fewer calls.
    /// `meet` returns the new limit: smaller after a hit, and negative infinity when the query is
    /// done.
    ///
    /// A primitive whose id is not passed is not hit. Candidates need not be near; ids beyond the
    /// last primitive are ignored. The ray is finite; its range is `t_min` to `t_max`.
    fn candidates(&self, ray: &Ray, limit: f32, meet: &mut dyn FnMut(u32) -> f32);
}

impl<F: Fn(&Ray, f32, &mut dyn FnMut(u32) -> f32) + Send + Sync> Accelerator for F {
    fn candidates(&self, ray: &Ray, limit: f32, meet: &mut dyn FnMut(u32) -> f32) {
        self(ray, limit, meet);
    }
}

/// Primitives under an application-defined [`Accelerator`]; kernels take it like a
/// [`Bvh`](super::Bvh).
///
/// Packets query it one lane at a time. It does not run on a GPU, where every primitive is tested
/// instead, with the same results.
///
/// ```
/// use raydsl::bvh::Accelerated;
/// use raydsl::prelude::*;
///
/// #[primitive(sphere(center, radius))]
/// struct Ball {
///     center: Vec3,
///     radius: f32,
/// }
///
/// // A row along x with one ball in each cell: the cells that the ray passes, nearer ones first.
/// let ball = |x| Ball { center: vec3(x as f32, 0.0, 0.0), radius: 0.4 };
/// let row: Vec<_> = (0..100).map(ball).collect();
/// let cells = |ray: &Ray, mut limit: f32, meet: &mut dyn FnMut(u32) -> f32| {
///     let (o, d) = (ray.origin.x, ray.direction.x);
///     let mut cell = o.round().clamp(0.0, 99.0);
///     let is_near = |cell, limit| d == 0.0 || (cell - 0.5 * d.signum() - o) / d <= limit;
///     while (0.0..100.0).contains(&cell) && is_near(cell, limit) {
///         limit = meet(cell as u32);
///         cell += if d > 0.0 { 1.0 } else { -1.0 };
///     }
/// };
/// // It takes rays to begin in the row, and to ask for what is ahead.
/// let scene = Accelerated::new(&row, cells);
/// let hit = scene.closest_hit(Ray::new(vec3(9.5, 0.0, 0.0), Vec3::X));
/// assert!((hit.prim_id, scene.any_hit(Ray::new(Vec3::Y, Vec3::X))) == (10, false));
/// ```
pub struct Accelerated<'a, P: Primitive> {
    standing: Standing<'a, P, P::Shared>,
}

impl<'a, P: Primitive<Shared = ()>> Accelerated<'a, P> {
    /// Creates a scene of primitives culled by `accelerator`.
    pub fn new(prims: &'a [P], accelerator: impl Accelerator + 'a) -> Self {
        Self::sharing(prims, &[], accelerator)
    }
}

impl<'a, P: Primitive> Accelerated<'a, P> {
    /// Creates a scene of primitives with shared data, culled by `accelerator`.
    pub fn sharing(
        prims: &'a [P],
        shared: impl IntoShared<'a, P::Shared>,
        accelerator: impl Accelerator + 'a,
    ) -> Self {
        let (accelerator, owner) = (Box::new(accelerator), Owner::new());
        let shared = P::Shared::store(shared.into_shared());
        Self { standing: Standing { prims, shared, accelerator, owner, kinds: Kinds::of(prims) } }
    }

    /// Returns the application's primitives.
    pub fn primitives(&self) -> &'a [P] {
        self.standing.prims
    }

    /// Returns the data that the primitives share.
    pub fn shared(&self) -> SharedSlices<'a, P> {
        self.standing.shared.slices()
    }

    /// Returns the view that kernels query.
    pub fn view(&self) -> SceneView<'_, P> {
        View::standing(&self.standing)
    }
}

impl<P: Primitive> core::fmt::Debug for Accelerated<'_, P> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let primitives = self.standing.prims.len();
        f.debug_struct("Accelerated").field("primitives", &primitives).finish_non_exhaustive()
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Capture<M> for Accelerated<'_, P> {
    type On<'c>
        = SceneView<'c, P>
    where
        Self: 'c;

    #[inline(always)]
    fn capture<'c>(&'c self, _: &M, name: &'static str) -> SceneView<'c, P> {
        self.view().named(name)
    }

    #[inline(always)]
    fn constant<'c>(&'c self, _: &M) -> SceneView<'c, P> {
        self.view()
    }

    fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&self.view().named(name));
    }
}

impl<P: Primitive> Parameter for Accelerated<'_, P> {
    type On<'a, M: Machine> = SceneView<'a, P>;
}
