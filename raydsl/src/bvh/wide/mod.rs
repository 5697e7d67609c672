//! The wide tree: nodes of eight children over blocks of eight primitives, which are tested eight at
//! once by a ray, one by a register of rays, or as [pairs], and its traversals by single rays, ray streams and ray packets.

mod beam;
mod binary;
mod blocks;
mod collapse;
pub(super) mod counts;
mod entry;
mod hybrid;
mod node;
mod octant;
mod order;
mod packet;
mod pairs;
mod queries;
mod rays;
pub(crate) mod single;
mod step;
mod stream;
#[cfg(test)]
mod tests;
pub(crate) mod trace;

use super::build::Tree;
use super::{Node, Traversal};
use crate::geometry::{Aabb, Primitive};
use blocks::Blocks;
use node::WideNode;
pub(crate) use queries::{WideQueries, queries};

/// A wide tree with a copy of the primitives in its leaves; see
/// [`Bvh::build_wide`](super::Bvh::build_wide).
#[derive(Clone, Debug)]
pub(crate) struct Wide {
    nodes: Vec<WideNode>,
    blocks: Blocks,
    /// Upper bound of the children that are on a traversal stack at once.
    pending: usize,
    bounds: Aabb,
    /// The traversal of queries of many rays.
    pub(super) traversal: Traversal,
}

impl Wide {
    /// Collapses a binary tree over `prims`.
    pub(super) fn of<P: Primitive>(
        tree: &Tree,
        prims: &[P],
        shared: &[P::Shared],
        traversal: Traversal,
    ) -> Self {
        let Tree { nodes, indices } = tree;
        let solidity = |range: collapse::Range| {
            let ids = &indices[range.first as usize..][..range.count as usize];
            ids.iter().map(|&id| 0.5 * prims[id as usize].get_bounds(shared).half_area()).sum()
        };
        let collapse::Collapsed { nodes, blocks, pending } = collapse::collapse(nodes, &solidity);
        let bounds = tree.nodes.first().map_or(Aabb::EMPTY, Node::bounds);
        let blocks = Blocks::of(prims, shared, indices, &blocks);
        Self { nodes, blocks, pending, bounds, traversal }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Returns the bounds of all primitives.
    pub(super) fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Returns the size of nodes and leaves in bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + self.blocks.bytes()
    }
}
