//! Bounding volume hierarchies over any primitive.
//!
//! **Closest hit is a function of the ray and the primitives, not of the tree**: of all primitives
//! whose `intersect` accepts, the one with the least `(t, id)`. Every traversal (one ray, packets,
//! WGSL, a plain loop over a slice) returns exactly that, bit for bit. What makes it so:
//!
//! * `intersect` sees the ray's own range, never the best `t` so far; the traversal alone
//!   compares, and of equal `t` keeps the smaller id.
//! * Boxes are widened, and nodes behind the best hit are culled, with an padding of
//!   [`Primitive::SLACK`]: what rounding may do to a hit, it does to no visit.
//! * Every layout runs the same arithmetic on the same members of a primitive.

// Where what is:
//
// | file | what it has |
// |---|---|
// | `view` | the scenes that kernels see: a slice, a tree, a list, instances, a foreign structure |
// | `ray_query`, `batch` | queries on the host: of one ray, of many in packets |
// | `contract` | which rays and hits count, which of two comes first, how far to look, what a box test is |
// | `methods`, `query` | queries in kernels: their names, and those that ask the kernel about each hit |
// | `hits` | every hit in order, for loops (after Amstutz et al., JCGT 2015) |
// | `on` | how each machine does a query; `on/wgsl` its text, `on/margin` its bounds of rounding |
// | `traverse` | one ray through the binary tree |
// | `traverse_packet`, `packet_slabs` | a packet through it, by one stack (Wald et al., "Interactive Rendering with Coherent Ray Tracing", 2001) |
// | `wide` | trees of eight children over blocks of eight primitives, and how rays go through them |
// | `instances`, `list`, `accelerator` | trees that are placed, lists of trees, structures of the application's |
// | `build` | builders: binned SAH, spatial splits, Morton order |
// | `refit`, `validate`, `coverage`, `stats` | moved primitives, whether a tree is one, what it is like |
// | `structure`, `node` | the trees that there are over some primitives, and a node |

mod accelerator;
mod batch;
pub mod build;
mod contract;
mod coverage;
mod hits;
mod instances;
mod list;
mod methods;
mod node;
mod on;
mod packet_slabs;
mod query;
mod ray_query;
mod refit;
mod stats;
mod structure;
pub mod traverse;
pub(crate) mod traverse_packet;
mod validate;
mod view;
pub(crate) mod wide;

#[cfg(test)]
mod tests;

use core::ops::ControlFlow;

pub use accelerator::{Accelerated, Accelerator};
use build::Settings;
pub use build::{BuildConfig, BuildError, BuildQuality, MAX_DEPTH, Traversal};
pub(crate) use contract::Padding;
pub use hits::Hits;
pub use instances::{Group, Instance, InstanceError, Instances, MAX_CONDITION, MAX_LEVELS, Object};
pub(crate) use instances::{IS_INSTANCE, PLACE_SCHEMA, Placed, Placing, STACK, Target};
pub use list::{BvhList, ListError};
pub use node::Node;
pub(crate) use on::RecordedWalks;
#[doc(hidden)]
pub use on::{AnyHits, ClosestHits};
pub(crate) use query::{RecordOn, any_where, closest_where, record_on};
pub use ray_query::RayQuery;
pub use refit::{DetachedBvh, RefitError};
pub use stats::Statistics;
use structure::Structure;
pub use traverse::Cost;
pub(crate) use traverse::nearest_counted;
#[doc(hidden)]
pub use traverse::{CountedHit, CountedHitOn};
pub use validate::{TreeFault, validate};
use view::Tree;
pub(crate) use view::{Branches, NODE_SCHEMA, Part, buffers};
pub use view::{SceneView, View};
use wide::Walks;
#[cfg(feature = "counts")]
pub use wide::counts::Counts;

use crate::geometry::{Aabb, Kinds, Primitive};
use crate::machine::{Capture, Machine, Owner, Parameter, Resource};

/// A binary tree over primitives that the application owns.
///
/// What rays may ask of it is in [`RayQuery`].
///
/// ```
/// use raydsl::prelude::*;
///
/// let triangles = [Triangle { v0: vec3(0.0, 0.0, 1.0), v1: vec3(4.0, 0.0, 1.0), v2: vec3(0.0, 4.0, 1.0) }];
/// let bvh = Bvh::build(&triangles)?;
/// let hit = bvh.closest_hit(Ray::new(vec3(1.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)));
/// assert!(hit.is_hit && hit.t == 1.0 && hit.prim_id == 0);
/// # Ok::<(), raydsl::bvh::BuildError>(())
/// ```
#[derive(Debug)]
pub struct Bvh<'a, P: Primitive> {
    tree: Tree<'a, P, P::Shared>,
}

/// What is a tree's own, and outlives the borrow of its primitives.
#[derive(Debug)]
struct Owned {
    structure: Structure,
    config: BuildConfig,
    owner: Owner,
    /// How often it has been refitted.
    version: u32,
    /// Its cost when it was built, if it has been refitted.
    built_cost: Option<f64>,
}

impl<'a, P: Primitive<Shared = ()>> Bvh<'a, P> {
    /// Builds a tree with the default configuration. No primitive at all is a valid scene.
    ///
    /// # Errors
    ///
    /// A primitive whose bounds are not finite, or more primitives than 32-bit indices can name.
    pub fn build(prims: &'a [P]) -> Result<Self, BuildError> {
        Self::build_with(prims, &BuildConfig::default())
    }

    /// Builds a tree.
    ///
    /// # Errors
    ///
    /// As [`Bvh::build`]; also a configuration out of its ranges.
    pub fn build_with(prims: &'a [P], config: &BuildConfig) -> Result<Self, BuildError> {
        Self::build_sharing(prims, &[], config)
    }
}

impl<'a, P: Primitive> Bvh<'a, P> {
    /// Builds a tree over primitives that share data: indexed triangles and their vertices.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let vertices = [vec3(0.0, 0.0, 1.0), vec3(4.0, 0.0, 1.0), vec3(4.0, 4.0, 1.0), vec3(0.0, 4.0, 1.0)];
    /// let triangles = [[0, 1, 2], [2, 3, 0]].map(|vertices| IndexedTriangle { vertices });
    /// let bvh = Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?;
    /// let hit = bvh.closest_hit(Ray::new(vec3(1.0, 3.0, 0.0), Vec3::Z));
    /// assert!(hit.is_hit && hit.prim_id == 1);
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Bvh::build_with`]. An index that has no vertex makes bounds that are not finite.
    pub fn build_sharing(
        prims: &'a [P],
        shared: &'a [P::Shared],
        config: &BuildConfig,
    ) -> Result<Self, BuildError> {
        Self::build_told(prims, shared, config, None, None)
    }

    /// Builds a wide tree, with copies of the primitives in its leaves, for scenes that are asked
    /// often. A scene without shared data passes `&[]`.
    ///
    /// A copy of each primitive lies in blocks of eight, member by member, under nodes of eight
    /// children. One ray meets eight boxes or eight primitives at a time, and packets go through the
    /// tree together or part, whichever is quicker. Hits are those of any other tree.
    ///
    /// A device has no use for it. A machine without AVX2 and NEON makes no copy, and of fewer
    /// primitives than [`BuildConfig::min_wide_size`] none is made: then the tree is a binary one. The
    /// walks through wide trees are long, and a program that calls this takes rustc seconds more for
    /// each type of primitive.
    ///
    /// The binary tree is not kept, and made again when it is first asked for, by one thread while
    /// others wait for it: by a ray whose numbers are too large for the wide tree's boxes, a scene of
    /// instances, a device, the reference, refitting, or [`Bvh::nodes`], which may be called to have it
    /// in time.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let triangle = |z| Triangle { v0: vec3(0.0, 0.0, z), v1: vec3(4.0, 0.0, z), v2: vec3(0.0, 4.0, z) };
    /// let triangles: Vec<_> = (1..1000).map(|z| triangle(z as f32)).collect();
    /// let bvh = Bvh::build_wide(&triangles, &[], &BuildConfig::default())?;
    /// let hit = bvh.closest_hit(Ray::new(vec3(1.0, 1.0, 0.0), Vec3::Z));
    /// assert_eq!((hit.prim_id, hit.t), (0, 1.0));
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Bvh::build_sharing`].
    pub fn build_wide(
        prims: &'a [P],
        shared: &'a [P::Shared],
        config: &BuildConfig,
    ) -> Result<Self, BuildError> {
        Self::build_told(prims, shared, config, None, wide::walks())
    }

    /// [`Bvh::build_wide`] with an observer, as [`Bvh::build_observed`] has one.
    ///
    /// # Errors
    ///
    /// As [`Bvh::build_observed`].
    pub fn build_wide_observed(
        prims: &'a [P],
        shared: &'a [P::Shared],
        config: &BuildConfig,
        mut observer: impl FnMut(f64) -> ControlFlow<()> + Send,
    ) -> Result<Self, BuildError> {
        Self::build_told(prims, shared, config, Some(&mut observer), wide::walks())
    }

    /// [`Bvh::build_sharing`], of which `observer` is told how much is done, from 0 to 1, and says
    /// whether to go on. A scene without shared data passes `&[]`.
    ///
    /// It is told 0 before anything is done, never less than the last time, at most 200 steps
    /// between, and 1 at the end. The calls come from any of the threads that build, one at a time.
    /// The tree is the same as without an observer.
    ///
    /// ```
    /// use raydsl::prelude::*;
    /// use core::ops::ControlFlow;
    ///
    /// let triangle = |z| Triangle { v0: vec3(0.0, 0.0, z), v1: vec3(4.0, 0.0, z), v2: vec3(0.0, 4.0, z) };
    /// let triangles: Vec<_> = (0..1000).map(|z| triangle(z as f32)).collect();
    /// let mut percent = 0.0;
    /// let bvh = Bvh::build_observed(&triangles, &[], &BuildConfig::default(), |done| {
    ///     percent = 100.0 * done;
    ///     ControlFlow::Continue(())
    /// })?;
    /// assert_eq!(bvh.primitives().len(), 1000);
    /// assert_eq!(percent, 100.0);
    ///
    /// let stopped = Bvh::build_observed(&triangles, &[], &BuildConfig::default(), |_| ControlFlow::Break(()));
    /// assert!(matches!(stopped, Err(raydsl::bvh::BuildError::Cancelled)));
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Bvh::build_sharing`], and [`BuildError::Cancelled`] if the observer breaks off.
    pub fn build_observed(
        prims: &'a [P],
        shared: &'a [P::Shared],
        config: &BuildConfig,
        mut observer: impl FnMut(f64) -> ControlFlow<()> + Send,
    ) -> Result<Self, BuildError> {
        Self::build_told(prims, shared, config, Some(&mut observer), None)
    }

    fn build_told(
        prims: &'a [P],
        shared: &'a [P::Shared],
        config: &BuildConfig,
        observer: Option<&mut build::Observer>,
        walks: Option<Walks<P, P::Shared>>,
    ) -> Result<Self, BuildError> {
        const {
            assert!(
                P::SLACK >= 0.0 && P::SLACK < 1.0,
                "SLACK of a primitive is a number from 0 to 1"
            );
        }
        let source = build::Primitives { prims, shared };
        let walks = walks.filter(|_| prims.len() >= config.min_wide_size as usize);
        let settings = Settings { config: *config, is_wide: walks.is_some() };
        let tree = build::build_watched(&source, prims.len(), &settings, observer)?;
        let wide = walks.map(|walks| (walks.collapse)(&tree, prims, shared, config.traversal));
        let own = Owned {
            structure: Structure::of(tree, wide),
            config: *config,
            owner: Owner::new(),
            version: 0,
            built_cost: None,
        };
        Ok(Self { tree: Tree { prims, shared, own, kinds: Kinds::of(prims), walks } })
    }

    /// The primitives, as the application owns them.
    pub fn primitives(&self) -> &'a [P] {
        self.tree.prims
    }

    /// What the primitives share, as the application owns it.
    pub fn shared(&self) -> &'a [P::Shared] {
        self.tree.shared
    }

    /// Whether it is a wide tree: [`Bvh::build_wide`] was asked for one, and made it.
    pub fn is_wide(&self) -> bool {
        self.tree.walks.is_some()
    }

    /// The nodes of the binary tree; the root is the first, children are adjacent. Of a wide tree it is
    /// made, and kept, when it is first asked for.
    pub fn nodes(&self) -> &[Node] {
        &self.tree.own.structure.binary().nodes
    }

    /// The index list that the leaves of the binary tree refer to, as [`Bvh::nodes`].
    pub fn indices(&self) -> &[u32] {
        &self.tree.own.structure.binary().indices
    }

    /// What the tree was built with, and how rays go through it.
    pub fn config(&self) -> &BuildConfig {
        &self.tree.own.config
    }

    /// Says how rays go through the tree from now on; see [`Traversal`].
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let triangle = |z| Triangle { v0: vec3(0.0, 0.0, z), v1: vec3(4.0, 0.0, z), v2: vec3(0.0, 4.0, z) };
    /// let triangles: Vec<_> = (1..1000).map(|z| triangle(z as f32)).collect();
    /// let mut bvh = Bvh::build_wide(&triangles, &[], &BuildConfig::default())?;
    /// let rays = [Ray::new(vec3(1.0, 1.0, 0.0), Vec3::Z); 100];
    /// let hits = bvh.closest_hits(&rays);
    /// for traversal in Traversal::ALL {
    ///     bvh.set_traversal(traversal);
    ///     assert_eq!(bvh.closest_hits(&rays), hits);
    /// }
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    pub fn set_traversal(&mut self, traversal: Traversal) {
        self.tree.own.config.traversal = traversal;
        self.tree.own.structure.set_traversal(traversal);
    }

    /// A box around everything; empty without primitives.
    pub fn bounds(&self) -> Aabb {
        self.tree.own.structure.bounds()
    }

    /// Bytes of the tree itself, with the copies of primitives in a wide one, and with its binary tree
    /// if anything has asked for that, or it has been refitted; the primitives
    /// are the application's.
    pub fn bytes(&self) -> usize {
        self.tree.own.structure.bytes()
    }

    /// The view that kernels work on.
    pub fn view(&self) -> SceneView<'_, P> {
        View::tree(&self.tree)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Capture<M> for Bvh<'_, P> {
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

    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&self.view());
    }
}

impl<P: Primitive> Parameter for Bvh<'_, P> {
    type On<'a, M: Machine> = SceneView<'a, P>;
}
