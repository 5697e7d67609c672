//! What makes a type a primitive.

use super::{Aabb, HitRecord, Ray, RayOn};
pub use crate::machine::Kinds;
use crate::machine::{Machine, Slice, Type};

impl Kinds {
    /// Those of these primitives.
    pub fn of<P: Primitive>(prims: &[P]) -> Self {
        if P::KINDS == 1 {
            return Self::ALL;
        }
        prims.iter().fold(Self::NONE, |all, p| all.union(Self::one(p.kind())))
    }
}

/// Something that rays meet; `#[primitive]` writes this from one definition of `intersect`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a primitive",
    note = "write `#[primitive]` on the struct, and on an impl with `intersect` and `get_bounds`"
)]
pub trait Primitive: Type {
    /// What `intersect` gives: [`Hit`](super::Hit), or a struct of your own with a `Hit` in it.
    type Hit: HitRecord;

    /// What all primitives of a scene share: the elements of one slice beside theirs, such as the
    /// vertices of indexed triangles. `()` if they stand alone.
    type Shared: Type;

    /// How far an accepted hit may lie from the exact one, relative to the distance between the
    /// ray's origin and the farthest corner of the scene: the error of `t`, and by how much the
    /// ray may pass beside [`Primitive::get_bounds`].
    ///
    /// Traversal widens boxes and distances by it, so that hits never depend on the tree. The
    /// default suits a careful `intersect` of a few dozen operations.
    const SLACK: f32 = 1.0 / 65536.0;

    /// How often a ray crosses the primitive at most: once what is flat, twice what is convex, a torus
    /// four times. Of [`hits`](crate::bvh::RayQuery::hits) every crossing is one, up to this many:
    /// `intersect` is asked again for the ray from behind each crossing on. A shape that is crossed more
    /// than once must heed `t_min`, and find a crossing at the same distance whatever that is. In an
    /// `impl` under `#[primitive]` it is a constant of that name.
    const MAX_CROSSINGS: u32 = 8;

    /// Whether eight primitives of a block of a [wide tree](crate::bvh::Bvh::build_wide) are tested
    /// without the early exits of `intersect`: faster where it has a hundred operations or so and
    /// no loop. Hits are the same. In an `impl` under `#[primitive]` it is a constant of that name.
    const IS_SHORT: bool = false;

    /// Where `ray` meets the primitive. It sees the ray's own `t_min` and `t_max` and need not
    /// heed them: traversal compares.
    fn intersect(&self, ray: Ray, shared: &[Self::Shared]) -> Self::Hit;

    /// A box around the whole primitive.
    fn get_bounds(&self, shared: &[Self::Shared]) -> Aabb;

    /// Boxes around the parts of the primitive below and above the plane `axis = at`; a box that
    /// is not valid says that there is no such part. `axis` is 0, 1 or 2.
    ///
    /// [`BuildQuality::Best`](crate::bvh::BuildQuality::Best) asks for it. Together the boxes hold
    /// the whole primitive, rounded outwards, and a hit that `intersect` accepts lies within
    /// [`Primitive::SLACK`] of one of them: of the primitive itself, that is, where the boxes are
    /// tight. It must be a pure function. The default cuts the bounds, which is right for every
    /// shape and tight for boxes.
    fn split_primitive(&self, axis: usize, at: f32, shared: &[Self::Shared]) -> (Aabb, Aabb) {
        self.get_bounds(shared).split(axis, at)
    }

    /// `intersect`, lifted.
    #[doc(hidden)]
    fn intersect_on<M: Machine>(
        m: &M,
        prim: Self::On<M>,
        ray: RayOn<M>,
        shared: Slice<'_, Self::Shared>,
    ) -> <Self::Hit as Type>::On<M>;

    /// How many kinds the type has: more than one for an enum.
    #[doc(hidden)]
    const KINDS: u32 = 1;

    /// Which kind this one is.
    #[doc(hidden)]
    #[inline(always)]
    fn kind(&self) -> u32 {
        0
    }

    /// `intersect` of one primitive for all lanes, lifted.
    #[doc(hidden)]
    #[inline(always)]
    fn intersect_one_on<M: Machine>(
        m: &M,
        prim: &Self,
        ray: RayOn<M>,
        shared: Slice<'_, Self::Shared>,
    ) -> <Self::Hit as Type>::On<M> {
        Self::intersect_on(m, Self::splat(m, *prim), ray, shared)
    }

    /// `intersect`, lifted, for primitives of these kinds alone.
    #[doc(hidden)]
    #[inline(always)]
    fn intersect_among_on<M: Machine>(
        m: &M,
        _kinds: Kinds,
        prim: Self::On<M>,
        ray: RayOn<M>,
        shared: Slice<'_, Self::Shared>,
    ) -> <Self::Hit as Type>::On<M> {
        Self::intersect_on(m, prim, ray, shared)
    }
}
