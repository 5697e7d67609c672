//! The wide tree: nodes of eight children over blocks of eight primitives, and its traversals by single
//! rays, ray streams and ray packets.
//!
//! A ray tests a block's eight primitives at once, a register of rays tests one after another, and
//! primitives that are not short are tested as [pairs] of rays and primitives.

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
use crate::geometry::{Aabb, Primitive, SharedStore};
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
    /// Whether it was refitted. A device asks the binary tree then: it is at hand, its index list
    /// stays, and primitives that have moved are likely to move again.
    is_refitted: bool,
    bounds: Aabb,
    /// The traversal of queries of many rays.
    pub(super) traversal: Traversal,
}

impl Wide {
    /// Collapses a binary tree over `prims`.
    pub(super) fn of<P: Primitive>(
        tree: &Tree,
        prims: &[P],
        shared: SharedStore<'_, P::Shared>,
        traversal: Traversal,
    ) -> Self {
        let Tree { nodes, indices } = tree;
        let slices = shared.slices();
        let of = |range: collapse::Range| {
            let ids = &indices[range.first as usize..][..range.count as usize];
            ids.iter().map(|&id| &prims[id as usize])
        };
        let of_leaves = collapse::Primitives {
            solidity: &|range| of(range).map(|p| 0.5 * p.get_bounds(slices).half_area()).sum(),
            prefetch: &|range| of(range).for_each(prefetch),
        };
        let collapse::Collapsed { nodes, blocks, most } = collapse::collapse(nodes, &of_leaves);
        let collapse::Most { pending, levels } = most;
        let bounds = tree.nodes.first().map_or(Aabb::EMPTY, Node::bounds);
        let blocks = Blocks::of(prims, slices, indices, &blocks);
        let (entries, compressed) = (OnceLock::new(), OnceLock::new());
        Self {
            nodes,
            blocks,
            pending,
            levels,
            entries,
            compressed,
            is_refitted: false,
            bounds,
            traversal,
        }
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

    /// Notes that it was collapsed from a refitted tree.
    pub(super) fn set_refitted(&mut self) {
        self.is_refitted = true;
    }

    /// Returns whether devices ask it. Not where coordinates are so large that products with the cells
    /// of a grid overflow.
    pub(super) fn is_for_devices(&self) -> bool {
        const LARGEST: f32 = f32::MAX / 8.0;
        let Aabb { min, max } = self.bounds;
        let is_small = self.is_empty() || min.abs().max(max.abs()).max_element() < LARGEST;
        is_small && !self.is_refitted
    }

    /// Returns the tree over these primitives as devices read it, made on first use and kept.
    pub(super) fn compressed<P: Primitive>(
        &self,
        prims: &[P],
        shared: SharedStore<'_, P::Shared>,
    ) -> &Compressed {
        if let Some(made) = self.compressed.get() {
            return made;
        }
        // Outside of the lock, since the primitives' code may do anything; of two, one is kept.
        let shared = shared.slices();
        let made = Compressed::of(self, &|id| prims[id as usize].get_bounds(shared));
        self.compressed.get_or_init(|| made)
    }

    /// Returns the size of nodes and leaves in bytes.
    pub(super) fn bytes(&self) -> usize {
        let compressed = self.compressed.get().map_or(0, Compressed::bytes);
        size_of_val(&self.nodes[..]) + self.blocks.bytes() + compressed
    }
}
