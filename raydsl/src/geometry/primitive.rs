//! The primitive trait.

use super::shared::{Shared, SharedSlices, SharedViews};
use super::{Aabb, HitRecord, Ray, RayOn};
pub use crate::machine::Kinds;
use crate::machine::{Machine, Type};

impl Kinds {
    /// Returns the kinds of these primitives.
    pub fn of<P: Primitive>(prims: &[P]) -> Self {
        if P::KINDS == 1 {
            return Self::ALL;
        }
        prims.iter().fold(Self::NONE, |all, p| all.union(Self::one(p.kind())))
    }
}

/// Geometric primitive that rays intersect; `#[primitive]` implements it from one definition of
/// `intersect`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a primitive",
    note = "write `#[primitive]` on the struct, and on an impl with `intersect` and `get_bounds`"
)]
pub trait Primitive: Type {
    /// Result of `intersect`: [`Hit`](super::Hit), or a user-defined struct with a `Hit` in it.
    type Hit: HitRecord;

    /// Data shared by all primitives of a scene: the elements of a second slice, such as the
    /// vertices of indexed triangles. `()` if there is none; [`Several`](super::Several) for an enum
    /// whose kinds share different data.
    type Shared: Shared;

    /// `Self::Shared`, or `S` if there is none: what this kind and others, which share an `S`, share
    /// in an enum of both.
    #[doc(hidden)]
    type SharedOr<S: Shared>: Shared;

    /// Returns the data as those of an enum whose other kinds share a `U`; `other` converts theirs.
    #[doc(hidden)]
    fn map_shared<'a, S: Shared, U: Shared>(
        all: <Self::SharedOr<S> as Shared>::Views<'a>,
        other: impl FnOnce(S::Views<'a>) -> U::Views<'a>,
    ) -> <Self::SharedOr<U> as Shared>::Views<'a>;

    /// Error bound of accepted hits, relative to the distance between the ray's origin and the
    /// farthest corner of the scene: the error of `t`, and the distance at which the ray may pass
    /// beside [`Primitive::get_bounds`].
    ///
    /// Traversal widens boxes and distances by it, so that hits never depend on the tree. The
    /// default suits a careful `intersect` of a few dozen operations.
    const SLACK: f32 = 1.0 / 65536.0;

    /// Maximum number of crossings of a ray: 1 for flat shapes, 2 for convex ones, 4 for a torus.
    /// [`hits`](crate::bvh::RecordQuery::hits) returns every crossing, up to this many: it calls
    /// `intersect` again for the ray from behind each crossing on. A shape with several crossings
    /// must heed `t_min`, and find each crossing at the same distance whatever `t_min` is. In an
    /// `impl` under `#[primitive]` it is a constant of that name.
    const MAX_CROSSINGS: u32 = 8;

    /// Whether `intersect` has a hundred operations or so and no loop, as for triangles and spheres.
    /// [Wide trees](crate::bvh::Bvh::build_wide) test eight primitives of a block at once without
    /// the early exits of `intersect` then. Of others they keep the boxes too, 192 bytes for a block of up to eight, and
    /// test the primitives whose boxes a ray enters. Hits are the same. In an `impl` under
    /// `#[primitive]` it is a constant of that name.
    const IS_SHORT: bool = false;

    /// Intersects `ray` with the primitive. It sees the ray's own `t_min` and `t_max` and need not
    /// heed them: traversal compares.
    fn intersect(&self, ray: Ray, shared: SharedSlices<'_, Self>) -> Self::Hit;

    /// Returns a box around the whole primitive.
    fn get_bounds(&self, shared: SharedSlices<'_, Self>) -> Aabb;

    /// Returns boxes around the parts of the primitive below and above the plane `axis = at`; a box
    /// that is not valid means an empty part. `axis` is 0, 1 or 2.
    ///
    /// [`BuildQuality::Best`](crate::bvh::BuildQuality::Best) calls it. Together the boxes contain
    /// the whole primitive, rounded outwards, and a hit that `intersect` accepts lies within
    /// [`Primitive::SLACK`] of one of them: of the primitive itself, where the boxes are tight. It
    /// must be a pure function. The default cuts the bounds, which is correct for every shape and
    /// tight for boxes.
    fn split_primitive(
        &self,
        axis: usize,
        at: f32,
        shared: SharedSlices<'_, Self>,
    ) -> (Aabb, Aabb) {
        self.get_bounds(shared).split(axis, at)
    }

    /// Lifted form of `intersect`.
    #[doc(hidden)]
    fn intersect_on<M: Machine>(
        m: &M,
        prim: Self::On<M>,
        ray: RayOn<M>,
        shared: SharedViews<'_, Self>,
    ) -> <Self::Hit as Type>::On<M>;

    /// Number of kinds of the type: more than one for an enum.
    #[doc(hidden)]
    const KINDS: u32 = 1;

    /// Returns the kind of this primitive.
    #[doc(hidden)]
    #[inline(always)]
    fn kind(&self) -> u32 {
        0
    }

    /// Returns the `SLACK` and the `MAX_CROSSINGS` of primitives of these kinds alone.
    #[doc(hidden)]
    fn limits_of(_kinds: Kinds) -> (f32, u32) {
        (Self::SLACK, Self::MAX_CROSSINGS)
    }

    /// Lifted form of `intersect` for one primitive in all lanes.
    #[doc(hidden)]
    #[inline(always)]
    fn intersect_one_on<M: Machine>(
        m: &M,
        prim: &Self,
        ray: RayOn<M>,
        shared: SharedViews<'_, Self>,
    ) -> <Self::Hit as Type>::On<M> {
        Self::intersect_on(m, Self::splat(m, *prim), ray, shared)
    }

    /// Lifted form of `intersect` for primitives of these kinds alone.
    #[doc(hidden)]
    #[inline(always)]
    fn intersect_among_on<M: Machine>(
        m: &M,
        _kinds: Kinds,
        prim: Self::On<M>,
        ray: RayOn<M>,
        shared: SharedViews<'_, Self>,
    ) -> <Self::Hit as Type>::On<M> {
        Self::intersect_on(m, prim, ray, shared)
    }
}
