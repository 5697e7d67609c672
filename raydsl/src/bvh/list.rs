//! Lists of trees queried as one scene.

use std::borrow::Cow;

use bytemuck::cast_slice;
use thiserror::Error;

use super::build::MAX_PRIMITIVES;
use super::view::{Branches, Part, Trees};
use super::{Bvh, Node, SceneView, View};
use crate::geometry::{Hit, Kinds, Primitive, Shared, SharedSlices, SharedStore};
use crate::machine::{Capture, Machine, Owner, Parameter, Resource};

/// List of trees over primitives of one type, queried as one scene: moving and static geometry, or
/// the parts of a model.
///
/// A query returns the result of one tree over all primitives, with those of the first tree first,
/// those of the second behind them, and so on: [`Hit::prim_id`] counts through the list. Rays are
/// tested against every tree's box, so a list is for a few trees; on a GPU its trees lie in one
/// buffer each for primitives, nodes and ids.
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
/// let ball = |z| Ball { center: vec3(0.0, 0.0, z), radius: 1.0 };
/// let (fixed, moved) = ([ball(9.0), ball(6.0)], [ball(3.0)]);
/// let trees = [Bvh::build(&fixed)?, Bvh::build(&moved)?];
/// let scene = BvhList::new(&trees)?;
/// let hit = scene.closest_hit(Ray::new(Vec3::ZERO, Vec3::Z));
/// assert_eq!((hit.prim_id, scene.tree_of(hit)), (2, Some(1)));
/// assert_eq!(scene.primitive(hit).center.z, 3.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Queries traverse the list as wide if all trees that have primitives [are](Bvh::is_wide). On a device
/// a [refitted](Bvh::refit) tree is binary, and so are the others of its list then.
#[derive(Debug)]
pub struct BvhList<'a, P: Primitive> {
    trees: Trees<'a, P, P::Shared>,
}

/// Error of joining trees in a list.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum ListError {
    /// There are more primitives than [`MAX_PRIMITIVES`] in all.
    #[error("{count} primitives are too many for one list of trees: {limit} can be numbered")]
    TooManyPrimitives {
        /// Number of primitives.
        count: usize,
        /// Maximum number of primitives.
        limit: usize,
    },
    /// The primitives of two trees share different slices.
    #[error(
        "tree {tree} shares another slice than tree {first}: put what the primitives of all trees \
         share into one, and build each tree with it, also one whose primitives do not read it"
    )]
    SharesAnother {
        /// The first tree with primitives.
        first: usize,
        /// The other tree.
        tree: usize,
    },
}

impl<'a, P: Primitive> BvhList<'a, P> {
    /// Creates a list of these trees. An empty list is a valid scene.
    ///
    /// # Errors
    ///
    /// If there are more than 2^30 primitives, or trees whose primitives share different slices.
    pub fn new(trees: &'a [Bvh<'a, P>]) -> Result<Self, ListError> {
        let count: usize = trees.iter().map(|tree| tree.primitives().len()).sum();
        if count > MAX_PRIMITIVES {
            return Err(ListError::TooManyPrimitives { count, limit: MAX_PRIMITIVES });
        }
        let shared = shared_by_all(trees)?;
        let mut first = 0;
        let part = |tree: &'a Bvh<'a, P>| {
            let part = Part { first, ..tree.tree.part() };
            first += part.prims.len() as u32;
            part
        };
        let parts = trees.iter().map(part).collect();
        let kinds = trees.iter().fold(Kinds::NONE, |all, tree| all.union(tree.tree.kinds));
        // A tree without primitives is neither wide nor binary.
        let mut filled = trees.iter().filter(|tree| !tree.primitives().is_empty());
        let is_wide = filled.clone().all(Bvh::is_wide);
        let queries = filled.find_map(|tree| tree.tree.queries).filter(|_| is_wide);
        Ok(Self { trees: Trees { parts, shared, owner: Owner::new(), kinds, queries } })
    }

    /// Returns the index of the tree that holds the hit primitive; `None` for a miss.
    pub fn tree_of(&self, hit: Hit) -> Option<usize> {
        hit.is_hit.then(|| tree_of(&self.trees.parts, hit.prim_id))
    }

    /// Returns the id of the first primitive of a tree.
    ///
    /// # Panics
    ///
    /// If the list has no such tree.
    pub fn first_of(&self, tree: usize) -> u32 {
        self.trees.parts[tree].first
    }

    /// Returns the number of trees.
    pub fn tree_count(&self) -> usize {
        self.trees.parts.len()
    }

    /// Returns the data that the primitives of all trees share.
    pub fn shared(&self) -> SharedSlices<'a, P> {
        self.trees.shared.slices()
    }

    pub(super) fn into_trees(self) -> Trees<'a, P, P::Shared> {
        self.trees
    }

    /// Returns the view that kernels query.
    pub fn view(&self) -> SceneView<'_, P> {
        View::list(&self.trees)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Capture<M> for BvhList<'_, P> {
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

impl<P: Primitive> Parameter for BvhList<'_, P> {
    type On<'a, M: Machine> = SceneView<'a, P>;
}

/// Returns the data that the primitives of these trees share; empty trees are compatible with any.
fn shared_by_all<'a, P: Primitive>(
    trees: &[Bvh<'a, P>],
) -> Result<SharedStore<'a, P::Shared>, ListError> {
    let mut found: Option<(usize, SharedStore<'a, P::Shared>)> = None;
    for (tree, bvh) in trees.iter().enumerate().filter(|(_, bvh)| !bvh.primitives().is_empty()) {
        let shared = bvh.tree.shared;
        let (first, before) = *found.get_or_insert((tree, shared));
        if !before.is_same(shared) {
            return Err(ListError::SharesAnother { first, tree });
        }
    }
    Ok(found.map_or(SharedStore::NONE, |(_, shared)| shared))
}

/// Returns the part that holds the primitive `index`; the first one if none does.
#[inline(always)]
pub(super) fn tree_of<T, S: Shared>(parts: &[Part<'_, T, S>], index: u32) -> usize {
    parts.partition_point(|part| part.first <= index).saturating_sub(1)
}

/// Iterates over the trees of a list, each with the number of nodes and indices before it.
fn trees<'p, 'a, T, S: Shared>(
    parts: &'p [Part<'a, T, S>],
) -> impl Iterator<Item = (&'p Part<'a, T, S>, Branches<'a>, [u32; 2])> {
    let mut before = [0; 2];
    parts.iter().filter_map(move |part| {
        let tree = part.tree()?;
        let begin = before;
        before = [begin[0] + tree.nodes.len() as u32, begin[1] + tree.indices.len() as u32];
        Some((part, tree, begin))
    })
}

/// Returns the root indices in the nodes of all trees.
pub(super) fn roots<T, S: Shared>(parts: &[Part<'_, T, S>]) -> impl Iterator<Item = u32> {
    trees(parts).filter(|(_, tree, _)| !tree.nodes.is_empty()).map(|(_, _, [root, _])| root)
}

/// Returns the nodes of all trees in one array.
pub(super) fn nodes<'a, T, S: Shared>(parts: &[Part<'a, T, S>]) -> Cow<'a, [u8]> {
    if let [part] = parts
        && let Some(tree) = part.tree()
    {
        return Cow::Borrowed(cast_slice(tree.nodes));
    }
    let moved = trees(parts).flat_map(|(_, tree, [nodes, indices])| {
        tree.nodes.iter().map(move |node| {
            let by = if node.is_leaf() { indices } else { nodes };
            Node { first: node.first + by, ..*node }
        })
    });
    Cow::Owned(cast_slice(&moved.collect::<Vec<Node>>()).to_vec())
}

/// Returns the index lists of all trees in one array, with ids that count through the list.
pub(super) fn indices<'a, T, S: Shared>(parts: &[Part<'a, T, S>]) -> Cow<'a, [u8]> {
    if let [part @ Part { first: 0, .. }] = parts
        && let Some(tree) = part.tree()
    {
        return Cow::Borrowed(cast_slice(tree.indices));
    }
    let moved = trees(parts)
        .flat_map(|(part, tree, _)| tree.indices.iter().map(|index| index + part.first));
    Cow::Owned(cast_slice(&moved.collect::<Vec<u32>>()).to_vec())
}
