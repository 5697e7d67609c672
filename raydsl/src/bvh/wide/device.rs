//! Wide trees as buffers of a device.

use std::borrow::Cow;

use bytemuck::cast_slice;

use super::compressed::{COMPRESSED_SCHEMA, Compressed, CompressedNode};
use crate::bvh::{Part, View, buffers};
use crate::machine::{Data, Schema, Type, bytes_of};

/// The buffers of wide trees as devices read them.
pub(crate) struct WideBuffers {
    /// Entries that a traversal's stack needs, rounded up: trees of about the same depth have the same
    /// text.
    pub(crate) stack: usize,
    pub(crate) nodes: WideBuffer,
    /// The primitives in leaves, in the order of the tree.
    pub(crate) leaves: WideBuffer,
    /// Their ids.
    pub(crate) ids: WideBuffer,
    /// The roots of a list.
    pub(crate) roots: Option<WideBuffer>,
}

/// A buffer of wide trees.
pub(crate) struct WideBuffer {
    pub(crate) part: u32,
    pub(crate) name: String,
    pub(crate) schema: &'static Schema,
    pub(crate) len: u64,
}

impl WideBuffers {
    pub(crate) fn all(&self) -> impl Iterator<Item = &WideBuffer> {
        [&self.nodes, &self.leaves, &self.ids].into_iter().chain(&self.roots)
    }
}

impl<'a, T: Type, S> View<'a, T, S> {
    /// Returns the buffers of wide trees as devices read them, if all trees are wide.
    pub(crate) fn wide_buffers(&self) -> Option<WideBuffers> {
        self.queries()?;
        let (mut nodes, mut entries, mut levels) = (0, 0, 0);
        for wide in self.parts().filter_map(|part| part.wide()) {
            nodes += wide.len() as u64;
            entries += wide.entries() as u64;
            levels = levels.max(wide.levels());
        }
        let name = Data::name(self);
        let buffer = |part, suffix, schema, len| WideBuffer {
            part,
            name: format!("{name}_{suffix}"),
            schema,
            len,
        };
        let roots = || buffer(buffers::WIDE_ROOTS, "wide_roots", &Schema::U32, self.root_len());
        Some(WideBuffers {
            stack: levels.next_multiple_of(8).max(8),
            nodes: buffer(buffers::WIDE_NODES, "wide_nodes", COMPRESSED_SCHEMA, nodes),
            leaves: buffer(buffers::LEAVES, "leaves", T::SCHEMA, entries),
            ids: buffer(buffers::LEAF_IDS, "leaf_ids", &Schema::U32, entries),
            roots: self.is_list().then(roots),
        })
    }

    /// Returns the bytes of a buffer of wide trees, if all trees are wide; none of another buffer.
    pub(crate) fn wide_bytes(&self, part: u32) -> Option<Cow<'_, [u8]>> {
        let trees = self.wide_trees()?;
        Some(match (part, &trees[..]) {
            (buffers::WIDE_NODES, [only]) => Cow::Borrowed(cast_slice(&only.tree.nodes)),
            (buffers::WIDE_NODES, _) => {
                let moved = trees.iter().flat_map(|placed| placed.nodes());
                Cow::Owned(cast_slice(&moved.collect::<Vec<CompressedNode>>()).to_vec())
            }
            (buffers::LEAVES, _) => {
                let leaves = trees.iter().flat_map(|placed| placed.leaves());
                Cow::Owned(bytes_of(&leaves.collect::<Vec<T>>()))
            }
            (buffers::LEAF_IDS, _) => {
                let ids = trees.iter().flat_map(|placed| placed.ids());
                Cow::Owned(cast_slice(&ids.collect::<Vec<u32>>()).to_vec())
            }
            (buffers::WIDE_ROOTS, _) => {
                let roots = trees.iter().filter(|placed| !placed.tree.nodes.is_empty());
                let roots: Vec<u32> = roots.map(|placed| placed.nodes).collect();
                Cow::Owned(cast_slice(&roots).to_vec())
            }
            _ => return None,
        })
    }

    /// Returns the wide trees of the scene, if all trees are wide.
    fn wide_trees(&self) -> Option<Vec<Placed<'a, T, S>>> {
        let compressed = self.queries()?.compressed;
        let (mut nodes, mut entries) = (0, 0);
        let place = |part: Part<'a, T, S>| {
            let tree = compressed(part.wide()?, part.prims, part.shared);
            let placed = Placed { part, tree, nodes, entries };
            (nodes, entries) = (nodes + tree.nodes.len() as u32, entries + tree.ids.len() as u32);
            Some(placed)
        };
        Some(self.parts().filter_map(place).collect())
    }
}

/// A wide tree behind others.
struct Placed<'a, T, S> {
    part: Part<'a, T, S>,
    tree: &'a Compressed,
    /// The number of nodes before it, and of primitives in leaves.
    nodes: u32,
    entries: u32,
}

impl<T: Type, S> Placed<'_, T, S> {
    fn nodes(&self) -> impl Iterator<Item = CompressedNode> {
        self.tree.nodes.iter().map(|node| CompressedNode {
            first_node: node.first_node + self.nodes,
            first_leaf: node.first_leaf + self.entries,
            ..*node
        })
    }

    fn leaves(&self) -> impl Iterator<Item = T> {
        self.tree.ids.iter().map(|&id| self.part.prims[id as usize])
    }

    /// Returns the ids of the primitives, which count through the list.
    fn ids(&self) -> impl Iterator<Item = u32> {
        self.tree.ids.iter().map(|id| id + self.part.first)
    }
}
