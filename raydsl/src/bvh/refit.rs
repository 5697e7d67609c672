//! Refitting of trees to moving primitives.
//!
//! A [`Bvh`] borrows its primitives, so nothing can move them while it lives. [`Bvh::detach`] ends
//! the borrow and keeps the tree; [`DetachedBvh::refit`] returns it over the moved primitives.

use thiserror::Error;

use super::view::Tree;
use super::wide::WideQueries;
use super::{BuildError, Bvh, Owned, stats};
use crate::geometry::{IntoShared, Kinds, Primitive, Shared};

/// Tree without its primitives, which the application may change meanwhile.
///
/// It cannot be queried before [`DetachedBvh::refit`] has computed its bounds from the primitives
/// again.
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
/// let mut balls = vec![Ball { center: vec3(0.0, 0.0, 5.0), radius: 1.0 }; 3];
/// let mut bvh = Bvh::build(&balls)?;
/// for frame in 0..10 {
///     let tree = bvh.detach();
///     balls[1].center.z -= 0.25;
///     bvh = tree.refit(&balls)?;
///     let hit = bvh.closest_hit(Ray::new(Vec3::ZERO, Vec3::Z));
///     assert_eq!((hit.prim_id, hit.t), (1, 3.75 - 0.25 * frame as f32));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
#[must_use = "without `refit` the tree is lost"]
pub struct DetachedBvh<P: Primitive> {
    own: Owned,
    /// Number of primitives of the tree.
    count: usize,
    queries: Option<WideQueries<P, P::Shared>>,
}

/// Error of refitting a tree. The tree is lost: build one.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RefitError {
    /// There are more primitives than before, or fewer.
    #[error("the tree is over {before} primitives, these are {now}: build a tree over them")]
    CountChanged {
        /// Number of primitives the tree was built over.
        before: usize,
        /// Number of primitives given.
        now: usize,
    },
    /// The bounds of a primitive are NaN, infinite or inverted; never another build error.
    #[error(transparent)]
    Bounds(#[from] BuildError),
}

impl<P: Primitive> Bvh<'_, P> {
    /// Detaches the tree from its primitives, so that they may be changed.
    pub fn detach(self) -> DetachedBvh<P> {
        let Tree { prims, own, queries, .. } = self.tree;
        DetachedBvh { own, count: prims.len(), queries }
    }

    /// Refits the tree to other primitives: [`Bvh::detach`] and [`DetachedBvh::refit`], for
    /// primitives that are written to another place when they move.
    ///
    /// # Errors
    ///
    /// As [`DetachedBvh::refit`].
    pub fn refit(self, prims: &[P]) -> Result<Bvh<'_, P>, RefitError>
    where
        P: Primitive<Shared = ()>,
    {
        self.detach().refit(prims)
    }

    /// Refits as [`Bvh::refit`] does, for primitives that share data.
    ///
    /// # Errors
    ///
    /// As [`DetachedBvh::refit`].
    pub fn refit_sharing<'b>(
        self,
        prims: &'b [P],
        shared: impl IntoShared<'b, P::Shared>,
    ) -> Result<Bvh<'b, P>, RefitError> {
        self.detach().refit_sharing(prims, shared)
    }

    /// Returns the growth of the expected ray cost since the tree was built:
    /// [`Statistics::sah_cost`](super::Statistics::sah_cost) now, divided by its value then. 1 if
    /// the tree has never been refitted, infinite if rays cost nothing then.
    ///
    /// Rebuild when the slowdown of rays exceeds the build time, often at 1.5 to 2. The cost is
    /// that of rays that hit the box of the tree: a single primitive that leaves all others far
    /// behind enlarges that box, and lowers it. Takes one pass over the nodes.
    pub fn cost_growth(&self) -> f64 {
        let Some(built) = self.tree.own.built_cost else { return 1.0 };
        let now = stats::sah_cost(self.nodes(), self.config());
        if built == now { 1.0 } else { now / built }
    }
}

impl<P: Primitive<Shared = ()>> DetachedBvh<P> {
    /// Refits node bounds to moved primitives; nothing else changes. `prims` holds them in the
    /// order in which the tree was built, in the same memory or not.
    ///
    /// Takes a fraction of the time of building. Hits are those of a new tree, but rays take longer
    /// the more primitives have left their neighbours: see [`Bvh::cost_growth`]. After Wald, Boulos
    /// and Shirley, *Ray tracing deformable scenes using dynamic bounding volume hierarchies* (ACM
    /// Transactions on Graphics 26(1), 2007), section 3.2. A device that has the tree gets its
    /// primitives, their shared data and the nodes anew, but not the index list; it traverses a
    /// refitted wide tree as a binary one.
    ///
    /// # Errors
    ///
    /// If the number of primitives has changed, or the bounds of one are not finite.
    pub fn refit(self, prims: &[P]) -> Result<Bvh<'_, P>, RefitError> {
        self.refit_sharing(prims, &[])
    }
}

impl<P: Primitive> DetachedBvh<P> {
    /// Refits as [`DetachedBvh::refit`] does, for primitives that share data, either or both of
    /// which have changed. The shared slice may have another length.
    ///
    /// # Errors
    ///
    /// As [`DetachedBvh::refit`].
    pub fn refit_sharing<'b>(
        self,
        prims: &'b [P],
        shared: impl IntoShared<'b, P::Shared>,
    ) -> Result<Bvh<'b, P>, RefitError> {
        let Self { own, count: before, queries } = self;
        let shared = shared.into_shared();
        let stored = P::Shared::store(shared);
        if prims.len() != before {
            return Err(RefitError::CountChanged { before, now: prims.len() });
        }
        let cost = || stats::sah_cost(&own.structure.binary().nodes, &own.config);
        let built_cost = own.built_cost.unwrap_or_else(cost);
        let traversal = own.config.traversal;
        let collapse = |tree: &_| Some((queries?.collapse)(tree, prims, stored, traversal));
        let own = Owned {
            structure: own.structure.refit(prims, shared, collapse)?,
            version: own.version.wrapping_add(1),
            built_cost: Some(built_cost),
            ..own
        };
        Ok(Bvh { tree: Tree { prims, shared: stored, own, kinds: Kinds::of(prims), queries } })
    }

    /// Returns the number of primitives of the tree.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Returns whether the tree has no primitives.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}
