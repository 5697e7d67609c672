//! The wide tree: nodes of eight children over blocks of eight primitives, which are tested eight at
//! once by a ray, one by a register of rays, or as [pairs], and its traversals by single rays, ray streams and ray packets.

mod beam;
mod binary;
mod blocks;
mod collapse;
mod compressed;
pub(super) mod counts;
pub(super) mod device;
mod entry;
mod hybrid;
mod node;
mod octant;
mod order;
mod packet;
mod pairs;
mod prefetch;
mod queries;
mod rays;
pub(crate) mod single;
mod step;
mod stream;
#[cfg(test)]
mod tests;
pub(crate) mod trace;

use std::sync::OnceLock;

use super::build::Tree;
use super::{Node, Traversal};
use crate::geometry::{Aabb, Primitive};
use blocks::Blocks;
use compressed::Compressed;
pub(crate) use compressed::{COMPRESSED_SCHEMA, cell_sizes};
use node::WideNode;
use prefetch::prefetch;
pub(crate) use queries::{WideQueries, queries};

/// A wide tree with a copy of the primitives in its leaves; see
/// [`Bvh::build_wide`](super::Bvh::build_wide).
#[derive(Clone, Debug)]
pub(crate) struct Wide {
    nodes: Vec<WideNode>,
    blocks: Blocks,
    /// Upper bound of the children that are on a traversal stack at once.
    pending: usize,
    /// Number of nodes of the longest path from the root.
    levels: usize,
    /// The number of primitives in all blocks, counted on first use.
    entries: OnceLock<usize>,
    /// The nodes as devices read them, made on first use.
    compressed: OnceLock<Compressed>,
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
        let of = |range: collapse::Range| {
            let ids = &indices[range.first as usize..][..range.count as usize];
            ids.iter().map(|&id| &prims[id as usize])
        };
        let leaves = collapse::Leaves {
            solidity: &|range| of(range).map(|p| 0.5 * p.get_bounds(shared).half_area()).sum(),
            prefetch: &|range| of(range).for_each(prefetch),
        };
        let collapse::Collapsed { nodes, blocks, most } = collapse::collapse(nodes, &leaves);
        let collapse::Most { pending, levels } = most;
        let bounds = tree.nodes.first().map_or(Aabb::EMPTY, Node::bounds);
        let blocks = Blocks::of(prims, shared, indices, &blocks);
        let (entries, compressed) = (OnceLock::new(), OnceLock::new());
        Self { nodes, blocks, pending, levels, entries, compressed, bounds, traversal }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Returns the bounds of all primitives.
    pub(super) fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Returns the number of nodes.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Returns the number of nodes of the longest path from the root.
    pub(super) fn levels(&self) -> usize {
        self.levels
    }

    /// Returns the number of primitives in all blocks; one that spatial splits cut counts in each.
    pub(super) fn entries(&self) -> usize {
        let members = |block| self.blocks.members(block).len();
        *self.entries.get_or_init(|| (0..self.blocks.len()).map(members).sum())
    }

    /// Returns the number of nodes of the binary tree that it expands to, and of its entries.
    pub(super) fn binary_len(&self) -> [usize; 2] {
        [(2 * self.blocks.len()).saturating_sub(1), self.entries()]
    }

    /// Returns the tree over these primitives as devices read it, made on first use and kept.
    pub(super) fn compressed<P: Primitive>(
        &self,
        prims: &[P],
        shared: &[P::Shared],
    ) -> &Compressed {
        let bounds = |id: u32| prims[id as usize].get_bounds(shared);
        self.compressed.get_or_init(|| Compressed::of(self, &bounds))
    }

    /// Returns the size of nodes and leaves in bytes.
    pub(super) fn bytes(&self) -> usize {
        let compressed = self.compressed.get().map_or(0, Compressed::bytes);
        size_of_val(&self.nodes[..]) + self.blocks.bytes() + compressed
    }
}
