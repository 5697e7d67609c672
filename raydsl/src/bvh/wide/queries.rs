//! Function pointers from a scene to the traversals of wide trees.

use core::fmt;

use fearless_simd::Level;

use super::trace::Scratch;
use super::{Compressed, Wide, single, trace};
use crate::bvh::build::Tree;
use crate::bvh::{Part, SceneView, Traversal, View};
use crate::geometry::{Hit, Primitive, Ray, Shared, SharedStore};
use crate::run::has_wide_lanes;

/// The builder and the traversals of wide trees over primitives of type `T`.
///
/// Traversals are most of the code of a program with queries. Only these pointers refer to them,
/// and only [`Bvh::build_wide`](crate::bvh::Bvh::build_wide) makes these pointers: a program that
/// does not call it is compiled without wide traversals.
pub(crate) struct WideQueries<T, S: Shared> {
    /// Collapses a binary tree.
    pub(in crate::bvh) collapse: fn(&Tree, &[T], SharedStore<'_, S>, Traversal) -> Wide,
    /// Returns a tree as devices read it.
    pub(super) compressed: for<'t> fn(&'t Wide, &[T], SharedStore<'_, S>) -> &'t Compressed,
    /// Finds the least `(t, id)` hits of rays.
    pub(super) closest: Answer<T, S>,
    /// Finds whether rays hit anything.
    pub(super) any: Answer<T, S>,
    /// Finds the least `(t, id)` hit of one ray; none if the ray is degenerate.
    pub(in crate::bvh) closest_of_one: fn(&View<'_, T, S>, Ray) -> Option<Hit>,
    /// Finds whether one ray hits anything; none if the ray is degenerate.
    pub(in crate::bvh) any_of_one: fn(&View<'_, T, S>, Ray) -> Option<bool>,
    /// Visits the primitives that one ray hits.
    pub(in crate::bvh) candidates: Candidates<T, S>,
}

/// Calls back with each primitive that a ray hits up to the limit that the last call returned,
/// until that is negative infinity; none if the ray is degenerate, which may be detected after some
/// calls.
pub(in crate::bvh) type Candidates<T, S> =
    fn(&View<'_, T, S>, Ray, &mut dyn FnMut(&Part<'_, T, S>, u32) -> f32) -> Option<()>;

/// Answers a query of the rays in scratch memory, with the lanes of a level.
pub(super) type Answer<T, S> = fn(Option<Level>, &View<'_, T, S>, &mut Scratch);

impl<T, S: Shared> Clone for WideQueries<T, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, S: Shared> Copy for WideQueries<T, S> {}

impl<T, S: Shared> fmt::Debug for WideQueries<T, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("WideQueries")
    }
}

/// Returns the traversals for a type of primitives; none if this machine has no lanes for them.
pub(crate) fn queries<P: Primitive>() -> Option<WideQueries<P, P::Shared>> {
    has_wide_lanes().then_some(WideQueries {
        collapse: Wide::of::<P>,
        compressed: Wide::compressed::<P>,
        closest: trace::answer::<true, P>,
        any: trace::answer::<false, P>,
        closest_of_one: |scene: &SceneView<'_, P>, ray| single::closest_hit(scene, ray),
        any_of_one: |scene: &SceneView<'_, P>, ray| single::any_hit(scene, ray),
        candidates: |scene: &SceneView<'_, P>, ray, visit| single::candidates(scene, ray, visit),
    })
}
