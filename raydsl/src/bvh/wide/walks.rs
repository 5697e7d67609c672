//! The way from a scene to the walks through wide trees.

use core::fmt;

use fearless_simd::Level;

use super::trace::Scratch;
use super::{Wide, single, trace};
use crate::bvh::build::Tree;
use crate::bvh::{Part, SceneView, Traversal, View};
use crate::geometry::{Hit, Primitive, Ray};
use crate::run::has_wide_walks;

/// What makes wide trees over primitives of type `T`, and goes through them.
///
/// The walks are most of what a program that asks trees is compiled from. So nothing refers to them
/// but these pointers, and nothing makes these but [`Bvh::build_wide`](crate::bvh::Bvh::build_wide):
/// what does not call that is compiled without them.
pub(crate) struct Walks<T, S> {
    /// Collapses a binary tree.
    pub(in crate::bvh) collapse: fn(&Tree, &[T], &[S], Traversal) -> Wide,
    /// Finds the least `(t, id)` hits of rays.
    pub(super) closest: Answer<T, S>,
    /// Finds whether rays hit anything.
    pub(super) any: Answer<T, S>,
    /// The least `(t, id)` hit of one ray; none if it is too odd for boxes.
    pub(in crate::bvh) closest_of_one: fn(&View<'_, T, S>, Ray) -> Option<Hit>,
    /// Whether one ray hits anything.
    pub(in crate::bvh) any_of_one: fn(&View<'_, T, S>, Ray) -> Option<bool>,
    /// Names the primitives that one ray meets.
    pub(in crate::bvh) candidates: Candidates<T, S>,
}

/// Names each primitive that a ray meets at or before the limit that it is given back, until that is
/// less than any number; none if the ray is too odd for boxes, of which it may be aware late.
pub(in crate::bvh) type Candidates<T, S> =
    fn(&View<'_, T, S>, Ray, &mut dyn FnMut(&Part<'_, T, S>, u32) -> f32) -> Option<()>;

/// Asks about the rays in memory, with lanes of a level.
pub(super) type Answer<T, S> = fn(Option<Level>, &View<'_, T, S>, &mut Scratch);

impl<T, S> Clone for Walks<T, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, S> Copy for Walks<T, S> {}

impl<T, S> fmt::Debug for Walks<T, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Walks")
    }
}

/// Those of primitives, if this machine goes through wide trees.
pub(crate) fn walks<P: Primitive>() -> Option<Walks<P, P::Shared>> {
    has_wide_walks().then_some(Walks {
        collapse: Wide::of::<P>,
        closest: trace::answer::<true, P>,
        any: trace::answer::<false, P>,
        closest_of_one: |scene: &SceneView<'_, P>, ray| single::closest_hit(scene, ray),
        any_of_one: |scene: &SceneView<'_, P>, ray| single::any_hit(scene, ray),
        candidates: |scene: &SceneView<'_, P>, ray, meet| single::candidates(scene, ray, meet),
    })
}
