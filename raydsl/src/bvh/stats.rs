//! Tree statistics: size, shape and expected cost of a ray.

use super::build::Tree;
use super::{BuildConfig, Bvh, Node};
use crate::geometry::{Aabb, Primitive};

/// Statistics of a tree, from [`Bvh::statistics`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Statistics {
    /// Expected cost of a ray through the box of the tree, by the surface area heuristic: every
    /// node and primitive that it may expect to visit, times [`BuildConfig::traversal_cost`] and
    /// [`BuildConfig::intersection_cost`] of the tree. The probability of a visit is the node's
    /// share of the root's surface area; if that is 0, of its length; if the root is a point, every
    /// node is visited. 0 for an empty tree. After Goldsmith and Salmon, *Automatic creation of
    /// object hierarchies for ray tracing* (IEEE CG&A 7(5), 1987).
    pub sah_cost: f64,
    /// Number of inner nodes and leaves.
    pub nodes: usize,
    /// Number of leaves.
    pub leaves: usize,
    /// Steps from the root to the deepest leaf, at most [`MAX_DEPTH`](super::MAX_DEPTH).
    pub depth: usize,
    /// Mean number of primitives per leaf; 0 for an empty tree.
    pub mean_leaf_size: f64,
    /// Number of primitives in the largest leaf.
    pub max_leaf_size: usize,
    /// Size of the existing trees in bytes, as [`Bvh::bytes`].
    pub bytes: usize,
    /// Leaf entries per primitive: 1 where every primitive is in one leaf, and for an empty tree.
    pub duplication: f64,
}

impl<P: Primitive> Bvh<'_, P> {
    /// Computes statistics of the binary tree in one pass over its nodes. For a wide tree it has a
    /// leaf per block, and is made for this and not kept, unless it already exists.
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
    /// let balls = [0.0, 10.0].map(|x| Ball { center: vec3(x, 0.0, 0.0), radius: 1.0 });
    /// let statistics = Bvh::build(&balls)?.statistics();
    /// assert_eq!((statistics.nodes, statistics.leaves, statistics.depth), (3, 2, 1));
    /// // A visit of the root, and each leaf for the rays that meet its box.
    /// assert!(statistics.sah_cost > 1.4 && statistics.sah_cost < 1.5);
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    pub fn statistics(&self) -> Statistics {
        let tree = self.tree.own.structure.peek();
        let (Tree { nodes, indices }, primitives) = (&*tree, self.primitives().len());
        let leaves = || nodes.iter().filter(|node| node.is_leaf());
        let ratio = |a: usize, b: usize, of_nothing: f64| match b {
            0 => of_nothing,
            _ => a as f64 / b as f64,
        };
        Statistics {
            sah_cost: sah_cost(nodes, self.config()),
            nodes: nodes.len(),
            leaves: leaves().count(),
            depth: depth(nodes),
            mean_leaf_size: ratio(indices.len(), leaves().count(), 0.0),
            max_leaf_size: leaves().map(|leaf| leaf.count as usize).max().unwrap_or(0),
            bytes: self.bytes(),
            duplication: ratio(indices.len(), primitives, 1.0),
        }
    }
}

/// Returns [`Statistics::sah_cost`].
pub(super) fn sah_cost(nodes: &[Node], config: &BuildConfig) -> f64 {
    let Some(root) = nodes.first() else { return 0.0 };
    let measure = measure(root.bounds());
    let cost = |node: &Node| {
        let visit = match node.count {
            0 => config.traversal_cost.into(),
            count => f64::from(config.intersection_cost) * f64::from(count),
        };
        visit * measure(node.bounds())
    };
    nodes.iter().map(cost).sum::<f64>() / measure(root.bounds())
}

/// Returns the measure proportional to the probability of a visit in a tree with this root.
fn measure(root: Aabb) -> fn(Aabb) -> f64 {
    fn length(bounds: Aabb) -> f64 {
        bounds.edges_f64().iter().sum()
    }
    if root.half_area_f64() > 0.0 {
        Aabb::half_area_f64
    } else if length(root) > 0.0 {
        length
    } else {
        |_| 1.0
    }
}

/// Returns [`Statistics::depth`].
pub(super) fn depth(nodes: &[Node]) -> usize {
    let mut depths = vec![0u8; nodes.len()];
    // Children come after their parents.
    for (k, node) in nodes.iter().enumerate().filter(|(_, node)| !node.is_leaf()) {
        let below = depths[k] + 1;
        depths[node.first as usize..][..2].fill(below);
    }
    depths.into_iter().max().unwrap_or(0).into()
}
