//! Wide trees as buffers of a device.

use crate::geometry::Shared;
use std::borrow::Cow;

use bytemuck::cast_slice;

use super::Wide;
use super::compressed::{COMPRESSED_SCHEMA, Compressed, CompressedNode};
use crate::bvh::build::tasks;
use crate::bvh::{View, buffers};
use crate::machine::wgsl::BufferKey;
use crate::machine::{Data, Description, Schema, Type, stride};

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
    /// Describes them; `key` returns the key of one by its part.
    pub(crate) fn describe(&self, out: &mut Description, key: &dyn Fn(u32) -> BufferKey) {
        out.fact(self.stack as u64);
        for buffer in [&self.nodes, &self.leaves, &self.ids].into_iter().chain(&self.roots) {
            out.buffer(key(buffer.part), &buffer.name, buffer.schema, buffer.len);
        }
    }
}

// What depends on the primitive is compiled in the user's crate, for each type: it gathers the trees, and
// functions that do not depend on it do the rest.
impl<'a, T: Type, S: Shared> View<'a, T, S> {
    /// Returns the buffers of wide trees as devices read them, if all trees are wide.
    pub(crate) fn wide_buffers(&self) -> Option<WideBuffers> {
        self.queries()?;
        let mut trees = Vec::new();
        for part in self.parts() {
            if let Some(wide) = part.wide() {
                trees.push(wide);
            }
        }
        let roots = self.is_list().then(|| self.root_len());
        buffers_of(&trees, &Data::name(self), T::SCHEMA, roots)
    }

    /// Returns the bytes of a buffer of wide trees, if all trees are wide; none of another buffer.
    pub(crate) fn wide_bytes(&self, part: u32) -> Option<Cow<'a, [u8]>> {
        let compressed = self.queries()?.compressed;
        let (mut trees, mut prims) = (Vec::new(), Vec::new());
        for part in self.parts() {
            if let Some(wide) = part.wide() {
                trees.push((compressed(wide, part.prims, part.shared), part.first));
                prims.push(part.prims);
            }
        }
        if part != buffers::LEAVES {
            return bytes_in(&trees, part);
        }
        let write = |tree: usize, id: u32, out: &mut [u8]| prims[tree][id as usize].write(out);
        Some(Cow::Owned(leaves_in(&trees, stride(T::SCHEMA), &write)))
    }
}

/// Returns the buffers of trees over `name`, whose elements have a schema; `roots` are those of a list.
fn buffers_of(
    trees: &[&Wide],
    name: &str,
    schema: &'static Schema,
    roots: Option<u64>,
) -> Option<WideBuffers> {
    if !trees.iter().all(|wide| wide.is_for_devices()) {
        return None;
    }
    let nodes = trees.iter().map(|wide| wide.len() as u64).sum();
    let entries = trees.iter().map(|wide| wide.entries() as u64).sum();
    let levels = trees.iter().map(|wide| wide.levels()).max().unwrap_or(0);
    let buffer = |part, suffix, schema, len| WideBuffer {
        part,
        name: format!("{name}_{suffix}"),
        schema,
        len,
    };
    Some(WideBuffers {
        stack: levels.saturating_sub(1).next_multiple_of(8).max(8),
        nodes: buffer(buffers::WIDE_NODES, "wide_nodes", COMPRESSED_SCHEMA, nodes),
        leaves: buffer(buffers::LEAVES, "leaves", schema, entries),
        ids: buffer(buffers::LEAF_IDS, "leaf_ids", &Schema::U32, entries),
        roots: roots.map(|len| buffer(buffers::WIDE_ROOTS, "wide_roots", &Schema::U32, len)),
    })
}

/// Primitives per task.
const PIECE: usize = 4096;

/// Returns the primitives in leaves, tree by tree; `write` is given the number of the tree, the id of the
/// primitive in it, and its place.
fn leaves_in(
    trees: &[(&Compressed, u32)],
    stride: usize,
    write: &(dyn Fn(usize, u32, &mut [u8]) + Sync),
) -> Vec<u8> {
    let entries: usize = trees.iter().map(|(tree, _)| tree.ids.len()).sum();
    // Zeros come from the system page by page, to the threads that write there.
    let mut bytes = vec![0; stride * entries];
    let mut rest = &mut bytes[..];
    for (i, (tree, _)) in trees.iter().enumerate() {
        let (leaves, after) = rest.split_at_mut(stride * tree.ids.len());
        tasks::map_pieces_mut(leaves, PIECE * stride, |first, piece| {
            for (out, &id) in piece.chunks_exact_mut(stride).zip(&tree.ids[first / stride..]) {
                write(i, id, out);
            }
        });
        rest = after;
    }
    bytes
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
