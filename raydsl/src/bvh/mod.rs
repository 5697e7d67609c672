//! Bounding volume hierarchies over any primitive.
//!
//! **Closest hit is a function of the ray and the primitives, not of the tree**: of all primitives
//! whose `intersect` accepts, the one with the least `(t, id)`. Every traversal (one ray, packets,
//! WGSL, a plain loop over a slice) returns exactly that, bit for bit. The reasons:
//!
//! * `intersect` sees the ray's own range, never the best `t` so far; the traversal alone
//!   compares, and of equal `t` keeps the smaller id.
//! * Boxes are widened, and nodes behind the best hit are culled, with a padding of
//!   [`Primitive::SLACK`]: rounding may change a hit, but never culls it.
//! * Every layout runs the same arithmetic on the same members of a primitive.

// The files:
//
// * `view`: scenes as kernels see them: a slice, a tree, a list, instances, a foreign structure.
// * `ray_query`: the traits of scenes: queries on the host, and in kernels that are generic over it.
// * `query_on`: the queries of a view on any machine; `joined`: two scenes as one; `carrier`: views
//   that carry more data, as those of meshes; `tabled`: scenes with tables; `scene_ref`: scenes whose
//   type is a parameter of the host.
// * `batch`: queries of many rays on the host, in packets.
// * `contract`: the valid rays and hits, the order of hits, culling distances, and the box test.
// * `methods`, `query`: queries in kernels: their names, and those with a callback for each hit.
// * `hits`: every hit in order, for loops (after Amstutz et al., JCGT 2015).
// * `on`: queries on each machine; `on/wgsl` has their text, `on/margin` their rounding bounds.
// * `traverse`: single-ray traversal of binary trees.
// * `traverse_packet`, `packet_slabs`: SIMD packet traversal of binary trees with one stack (Wald
//   et al., "Interactive Rendering with Coherent Ray Tracing", 2001).
// * `wide`: trees of eight children over blocks of eight primitives, and their traversals.
// * `instances`, `list`, `accelerator`: placed trees, lists of trees, the application's structures.
// * `build`: builders: binned SAH, spatial splits, Morton order.
// * `refit`, `validate`, `coverage`, `stats`: refitting, validation and statistics of trees.
// * `structure`, `node`: the trees over some primitives, and a node.

mod accelerator;
mod batch;
pub mod build;
pub(crate) mod carrier;
mod contract;
mod coverage;
mod hits;
mod instances;
mod joined;
mod list;
pub(crate) mod methods;
mod node;
mod on;
mod packet_slabs;
mod query;
pub(crate) mod query_on;
pub(crate) mod ray_query;
mod refit;
mod scene_ref;
mod stats;
mod structure;
mod tabled;
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
pub(crate) use contract::behind;
pub use hits::Hits;
pub use instances::{Group, Instance, InstanceError, Instances, MAX_CONDITION, MAX_LEVELS, Object};
pub(crate) use instances::{IS_INSTANCE, PLACE_SCHEMA, Placed, Placing, STACK, Target};
pub use joined::Joined;
pub use list::{BvhList, ListError};
pub use node::Node;
pub(crate) use on::RecordedQueries;
#[doc(hidden)]
pub use on::{AnyHits, ClosestHits};
pub(crate) use query::{RecordOn, any_where, closest_where, record_on};
pub use query_on::RayQueryOn;
#[doc(hidden)]
pub use query_on::SceneArgument;
pub use ray_query::{PrimitiveScene, RayQuery, RecordQuery};
pub use refit::{DetachedBvh, RefitError};
pub use scene_ref::SceneRef;
pub use stats::Statistics;
use structure::Structure;
pub use tabled::Tabled;
pub use traverse::Cost;
pub(crate) use traverse::nearest_counted;
#[doc(hidden)]
pub use traverse::{CountedHit, CountedHitOn};
pub use validate::{TreeFault, validate};
use view::Tree;
pub(crate) use view::{Branches, NODE_SCHEMA, Part, buffers};
pub use view::{SceneView, View};
use wide::WideQueries;
#[cfg(feature = "counts")]
pub use wide::counts::Counts;

use crate::geometry::{Aabb, IntoShared, Kinds, Primitive, Shared, SharedSlices};
use crate::machine::{Capture, Machine, Owner, Parameter, Resource};

/// Bounding volume hierarchy over primitives that the application owns.
///
/// [`RecordQuery`] has its queries.
///
/// ```
/// use raydsl::prelude::*;
///
/// let v = |x, y| vec3(x, y, 1.0);
/// let triangles = [Triangle { v0: v(0.0, 0.0), v1: v(4.0, 0.0), v2: v(0.0, 4.0) }];
/// let bvh = Bvh::build(&triangles)?;
/// let hit = bvh.closest_hit(Ray::new(vec3(1.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)));
/// assert!(hit.is_hit && hit.t == 1.0 && hit.prim_id == 0);
/// # Ok::<(), raydsl::bvh::BuildError>(())
/// ```
#[derive(Debug)]
pub struct Bvh<'a, P: Primitive> {
    tree: Tree<'a, P, P::Shared>,
}

/// The part of a tree that outlives the borrow of its primitives.
#[derive(Debug)]
struct Owned {
    structure: Structure,
    config: BuildConfig,
    owner: Owner,
    /// The number of refits.
    version: u32,
    /// Cost when it was built, if it has been refitted.
    built_cost: Option<f64>,
}

impl<'a, P: Primitive<Shared = ()>> Bvh<'a, P> {
    /// Builds a tree with the default configuration. An empty slice is a valid scene.
    ///
    /// # Errors
    ///
    /// If the bounds of a primitive are not finite, or there are more than 2^30 primitives.
    pub fn build(prims: &'a [P]) -> Result<Self, BuildError> {
        Self::build_with(prims, &BuildConfig::default())
    }

    /// Builds a tree.
    ///
    /// # Errors
    ///
    /// As [`Bvh::build`]; also for a configuration out of its ranges.
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
    /// let v = |x, y| vec3(x, y, 1.0);
    /// let vertices = [v(0.0, 0.0), v(4.0, 0.0), v(4.0, 4.0), v(0.0, 4.0)];
    /// let triangles = [[0, 1, 2], [2, 3, 0]].map(|vertices| IndexedTriangle { vertices });
    /// let bvh = Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?;
    /// let hit = bvh.closest_hit(Ray::new(vec3(1.0, 3.0, 0.0), Vec3::Z));
    /// assert!(hit.is_hit && hit.prim_id == 1);
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Bvh::build_with`]. An index without a vertex makes bounds that are not finite.
    pub fn build_sharing(
        prims: &'a [P],
        shared: impl IntoShared<'a, P::Shared>,
        config: &BuildConfig,
    ) -> Result<Self, BuildError> {
        Self::build_told(prims, shared.into_shared(), config, None, None)
    }

    /// Builds a wide tree, with copies of the primitives in its leaves, for scenes with many
    /// queries. A scene without shared data passes `&[]`.
    ///
    /// Nodes have eight children, and leaves are blocks of eight primitives in structure-of-arrays
    /// layout. One ray tests eight boxes or eight primitives at a time, or a register of pairs of rays
    /// and primitives that are not [short](Primitive::IS_SHORT); the rays of a query are
    /// traced as ray packets or ray streams, whichever is faster. Hits are those of any other tree.
    ///
    /// On a device, closest-hit and any-hit queries of the tree, or of a list of such trees, read
    /// nodes of 80 bytes with boxes of eight bits a side, and copies of the primitives in the order of
    /// the leaves, unless it was refitted or a coordinate exceeds 4e37. One such tree makes a device
    /// read all trees of its list as binary ones.
    ///
    /// On a machine without AVX2, NEON and simd128, and for fewer primitives than
    /// [`BuildConfig::min_wide_size`], the tree is a binary one without copies. Traversals of wide
    /// trees are a lot of code: a program that calls this takes rustc some seconds more for each
    /// type of primitive.
    ///
    /// The binary tree is not kept. It is made again on first use, by one thread while others wait:
    /// for degenerate rays, whose components are too large or too small for the box tests of the
    /// wide tree, scenes of instances, other queries on a device, the reference, refitting, and
    /// [`Bvh::nodes`]. Call the latter to have it in time.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let v = vec3;
    /// let triangle = |z| Triangle { v0: v(0.0, 0.0, z), v1: v(4.0, 0.0, z), v2: v(0.0, 4.0, z) };
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
        shared: impl IntoShared<'a, P::Shared>,
        config: &BuildConfig,
    ) -> Result<Self, BuildError> {
        Self::build_told(prims, shared.into_shared(), config, None, wide::queries())
    }

    /// Builds a wide tree as [`Bvh::build_wide`], with an observer as [`Bvh::build_observed`]. It is
    /// told 1 before the primitives are copied to the leaves, which is then not interrupted.
    ///
    /// # Errors
    ///
    /// As [`Bvh::build_observed`].
    pub fn build_wide_observed(
        prims: &'a [P],
        shared: impl IntoShared<'a, P::Shared>,
        config: &BuildConfig,
        mut observer: impl FnMut(f64) -> ControlFlow<()> + Send,
    ) -> Result<Self, BuildError> {
        Self::build_told(prims, shared.into_shared(), config, Some(&mut observer), wide::queries())
    }

    /// Builds a tree as [`Bvh::build_sharing`] does, and reports progress to `observer`, from 0 to
    /// 1; its answer continues or cancels the build. A scene without shared data passes `&[]`.
    ///
    /// The observer gets 0 before anything is done, never less than the last time, at most 200
    /// steps between, and 1 at the end. The calls come from any of the threads that build, one at a
    /// time. The tree is the same as without an observer.
    ///
    /// ```
    /// use raydsl::prelude::*;
    /// use core::ops::ControlFlow;
    ///
    /// let v = vec3;
    /// let triangle = |z| Triangle { v0: v(0.0, 0.0, z), v1: v(4.0, 0.0, z), v2: v(0.0, 4.0, z) };
    /// let triangles: Vec<_> = (0..1000).map(|z| triangle(z as f32)).collect();
    /// let mut percent = 0.0;
    /// let bvh = Bvh::build_observed(&triangles, &[], &BuildConfig::default(), |done| {
    ///     percent = 100.0 * done;
    ///     ControlFlow::Continue(())
    /// })?;
    /// assert_eq!(bvh.primitives().len(), 1000);
    /// assert_eq!(percent, 100.0);
    ///
    /// let stop = |_| ControlFlow::Break(());
    /// let stopped = Bvh::build_observed(&triangles, &[], &BuildConfig::default(), stop);
    /// assert!(matches!(stopped, Err(raydsl::bvh::BuildError::Cancelled)));
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Bvh::build_sharing`], and [`BuildError::Cancelled`] if the observer breaks off.
    pub fn build_observed(
        prims: &'a [P],
        shared: impl IntoShared<'a, P::Shared>,
        config: &BuildConfig,
        mut observer: impl FnMut(f64) -> ControlFlow<()> + Send,
    ) -> Result<Self, BuildError> {
        Self::build_told(prims, shared.into_shared(), config, Some(&mut observer), None)
    }

    fn build_told(
        prims: &'a [P],
        shared: SharedSlices<'a, P>,
        config: &BuildConfig,
        observer: Option<&mut build::Observer>,
        queries: Option<WideQueries<P, P::Shared>>,
    ) -> Result<Self, BuildError> {
        const {
            assert!(
                P::SLACK >= 0.0 && P::SLACK < 1.0,
                "SLACK of a primitive is a number from 0 to 1"
            );
        }
        let source = build::Primitives { prims, shared };
        let stored = P::Shared::store(shared);
        let queries = queries.filter(|_| prims.len() >= config.min_wide_size as usize);
        let settings = Settings { config: *config, is_wide: queries.is_some() };
        let tree = build::build_watched(&source, prims.len(), &settings, observer)?;
        let wide =
            queries.map(|queries| (queries.collapse)(&tree, prims, stored, config.traversal));
        let own = Owned {
            structure: Structure::of(tree, wide),
            config: *config,
            owner: Owner::new(),
            version: 0,
            built_cost: None,
        };
        Ok(Self { tree: Tree { prims, shared: stored, own, kinds: Kinds::of(prims), queries } })
    }

    /// Returns the primitives, which the application owns.
    pub fn primitives(&self) -> &'a [P] {
        self.tree.prims
    }

    /// Returns the shared data of the primitives, which the application owns.
    pub fn shared(&self) -> SharedSlices<'a, P> {
        self.tree.shared.slices()
    }

    /// Returns whether the tree is wide, as [`Bvh::build_wide`] makes it.
    pub fn is_wide(&self) -> bool {
        self.tree.queries.is_some()
    }

    /// Returns the nodes of the binary tree, root first, with adjacent children. The binary tree of
    /// a wide one is made on first use, and kept.
    pub fn nodes(&self) -> &[Node] {
        &self.tree.own.structure.binary().nodes
    }

    /// Returns the index list that the leaves of the binary tree refer to, as [`Bvh::nodes`].
    pub fn indices(&self) -> &[u32] {
        &self.tree.own.structure.binary().indices
    }

    /// Returns the settings of the builder and of traversal.
    pub fn config(&self) -> &BuildConfig {
        &self.tree.own.config
    }

    /// Sets the traversal of the tree; see [`Traversal`].
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let v = vec3;
    /// let triangle = |z| Triangle { v0: v(0.0, 0.0, z), v1: v(4.0, 0.0, z), v2: v(0.0, 4.0, z) };
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

    /// Returns the bounds of all primitives; empty without primitives.
    pub fn bounds(&self) -> Aabb {
        self.tree.own.structure.bounds()
    }

    /// Returns the size of the tree in bytes, without the primitives, which the application owns. A
    /// wide tree includes its copies of primitives, and its binary tree and its nodes for a device if
    /// those have been made.
    pub fn bytes(&self) -> usize {
        self.tree.own.structure.bytes()
    }

    /// Returns the view that kernels work on.
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

    fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&self.view().named(name));
    }
}

impl<P: Primitive> Parameter for Bvh<'_, P> {
    type On<'a, M: Machine> = SceneView<'a, P>;
}
