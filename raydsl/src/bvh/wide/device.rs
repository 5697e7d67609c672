//! Wide trees as buffers of a device.

use std::borrow::Cow;

use bytemuck::cast_slice;

use super::compressed::{COMPRESSED_SCHEMA, Compressed, CompressedNode};
use crate::bvh::build::tasks;
use crate::bvh::{Part, View, buffers};
use crate::machine::{Data, Schema, Type, stride};

/// The buffers of wide trees as devices read them.
pub(crate) struct WideBuffers {
    /// Entries of a traversal's stack: one for each level but the last, rounded up, so that trees of
    /// about the same depth have the same text.
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
            if !wide.is_for_devices() {
                return None;
            }
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
            stack: levels.saturating_sub(1).next_multiple_of(8).max(8),
            nodes: buffer(buffers::WIDE_NODES, "wide_nodes", COMPRESSED_SCHEMA, nodes),
            leaves: buffer(buffers::LEAVES, "leaves", T::SCHEMA, entries),
            ids: buffer(buffers::LEAF_IDS, "leaf_ids", &Schema::U32, entries),
            roots: self.is_list().then(roots),
        })
    }

    /// Returns the bytes of a buffer of wide trees, if all trees are wide; none of another buffer.
    pub(crate) fn wide_bytes(&self, part: u32) -> Option<Cow<'a, [u8]>> {
        let compressed = self.queries()?.compressed;
        let of_part =
            |part: Part<'a, T, S>| Some(compressed(part.wide()?, part.prims, part.shared));
        if part != buffers::LEAVES {
            let first = |part: &Part<'a, T, S>| part.first;
            let trees = self.parts().filter_map(|part| Some((of_part(part)?, first(&part))));
            return bytes_in(&trees.collect::<Vec<_>>(), part);
        }
        let stride = stride(T::SCHEMA);
        let mut bytes = Vec::new();
        for (tree, prims) in self.parts().filter_map(|part| Some((of_part(part)?, part.prims))) {
            let write = |id: u32, out: &mut [u8]| prims[id as usize].write(out);
            append_leaves(&mut bytes, stride, &tree.ids, &write);
        }
        Some(Cow::Owned(bytes))
    }
}

/// Primitives per task.
const PIECE: usize = 4096;

/// Appends primitives in the order of their ids; `write` is a trait object, so that the tasks are compiled
/// once, not for every type of primitive.
fn append_leaves(
    bytes: &mut Vec<u8>,
    stride: usize,
    ids: &[u32],
    write: &(dyn Fn(u32, &mut [u8]) + Sync),
) {
    let before = bytes.len();
    bytes.resize(before + stride * ids.len(), 0);
    tasks::map_pieces_mut(&mut bytes[before..], PIECE * stride, |first, piece| {
        for (out, &id) in piece.chunks_exact_mut(stride).zip(&ids[first / stride..]) {
            write(id, out);
        }
    });
}

/// Returns the bytes of a buffer of trees, each with the id of its first primitive in the list.
fn bytes_in<'a>(trees: &[(&'a Compressed, u32)], part: u32) -> Option<Cow<'a, [u8]>> {
    if let (buffers::WIDE_NODES, [(only, _)]) = (part, trees) {
        return Some(Cow::Borrowed(cast_slice(&only.nodes)));
    }
    if let (buffers::LEAF_IDS, [(only, 0)]) = (part, trees) {
        return Some(Cow::Borrowed(cast_slice(&only.ids)));
    }
    // Nodes and primitives of the trees before.
    let len = |(tree, _): &(&Compressed, u32)| match part {
        buffers::WIDE_NODES => size_of_val(&tree.nodes[..]),
        buffers::LEAF_IDS => size_of_val(&tree.ids[..]),
        _ => size_of::<u32>(),
    };
    let mut bytes = Vec::with_capacity(trees.iter().map(len).sum());
    let (mut nodes, mut entries) = (0, 0);
    for (tree, first) in trees {
        match part {
            buffers::WIDE_NODES => tree.nodes.iter().for_each(|node| {
                let (first_node, first_leaf) = (node.first_node + nodes, node.first_leaf + entries);
                let node = CompressedNode { first_node, first_leaf, ..*node };
                bytes.extend_from_slice(bytemuck::bytes_of(&node));
            }),
            buffers::LEAF_IDS => {
                bytes.extend(tree.ids.iter().flat_map(|id| (id + first).to_le_bytes()))
            }
            buffers::WIDE_ROOTS if tree.nodes.is_empty() => {}
            buffers::WIDE_ROOTS => bytes.extend(nodes.to_le_bytes()),
            _ => return None,
        }
        nodes += tree.nodes.len() as u32;
        entries += tree.ids.len() as u32;
    }
    Some(Cow::Owned(bytes))
}
