//! The light view of a slice, or of primitives and their tree, that kernels work on.

use std::borrow::Cow;

use super::{Node, bytes_of, slice_key};
use crate::geometry::{Kinds, Primitive};
use crate::machine::{Field, Leaves, Machine, Resource, Schema, Type, Value, wgsl::BufferKey};

/// The structure of a [`Node`].
pub(crate) const NODE_SCHEMA: &Schema = &Schema::Struct {
    name: "Node",
    fields: &[
        Field { name: "min", offset: 0, schema: &Schema::Vector(&Schema::F32, 3) },
        Field { name: "first", offset: 12, schema: &Schema::U32 },
        Field { name: "max", offset: 16, schema: &Schema::Vector(&Schema::F32, 3) },
        Field { name: "count", offset: 28, schema: &Schema::U32 },
    ],
    size: 32,
};

/// A slice, with a tree over it or without: a value of the host on every machine.
#[derive(Debug)]
pub struct On<'a, P> {
    pub(crate) prims: &'a [P],
    pub(crate) nodes: &'a [Node],
    pub(crate) indices: &'a [u32],
    /// The tree's number; 0 for a plain slice.
    id: u64,
    name: &'static str,
    /// The kinds of primitives under the tree.
    kinds: Kinds,
}

impl<P> Clone for On<'_, P> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<P> Copy for On<'_, P> {}

impl<'a, P: Type> On<'a, P> {
    #[inline(always)]
    pub(crate) fn tree(
        prims: &'a [P],
        nodes: &'a [Node],
        indices: &'a [u32],
        id: u64,
        kinds: Kinds,
    ) -> Self {
        Self { prims, nodes, indices, id, name: "bvh", kinds }
    }

    #[inline(always)]
    pub(crate) fn slice(prims: &'a [P]) -> Self {
        Self { prims, nodes: &[], indices: &[], id: 0, name: "prims", kinds: Kinds::ALL }
    }

    /// The view under the name that it has in the source.
    #[inline(always)]
    pub(crate) fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    /// How many primitives.
    pub fn len(&self) -> usize {
        self.prims.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.prims.is_empty()
    }

    /// Whether a tree stands over the primitives.
    #[inline(always)]
    pub(crate) fn has_tree(&self) -> bool {
        self.id != 0
    }

    /// The primitive `index`.
    ///
    /// # Panics
    ///
    /// If there is no such primitive.
    #[inline(always)]
    pub fn get(&self, index: u32) -> P {
        self.prims[index as usize]
    }

    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    pub(crate) fn prims_key(&self) -> BufferKey {
        if self.has_tree() {
            BufferKey { id: self.id, version: 0, part: 0 }
        } else {
            slice_key(self.prims)
        }
    }

    /// Keys of the nodes and of the index list.
    pub(crate) fn tree_keys(&self) -> Option<(BufferKey, BufferKey)> {
        let part = |part| BufferKey { id: self.id, version: 0, part };
        self.has_tree().then(|| (part(1), part(2)))
    }

    pub(crate) fn tree_len(&self) -> (u64, u64) {
        (self.nodes.len() as u64, self.indices.len() as u64)
    }
}

impl<P: Primitive> On<'_, P> {
    /// The kinds of its primitives.
    pub(crate) fn kinds(&self) -> Kinds {
        if self.has_tree() { self.kinds } else { Kinds::of(self.prims) }
    }
}

impl<P: Type> Resource for On<'_, P> {
    fn bytes(&self, key: BufferKey) -> Option<Cow<'_, [u8]>> {
        if key == self.prims_key() {
            return Some(Cow::Owned(bytes_of(self.prims)));
        }
        let (nodes, indices) = self.tree_keys()?;
        if key == nodes {
            Some(Cow::Borrowed(bytemuck::cast_slice(self.nodes)))
        } else if key == indices {
            Some(Cow::Borrowed(bytemuck::cast_slice(self.indices)))
        } else {
            None
        }
    }
}

impl<M: Machine, P: Type> Value<M> for On<'_, P> {
    const SCHEMA: &'static Schema = &Schema::Host;

    #[inline(always)]
    fn zero(_: &M) -> Self {
        Self::slice(&[])
    }

    #[inline(always)]
    fn zip(_: &M, a: Self, b: Self, _: &mut impl Leaves<M>) -> Self {
        // Nothing yet: a variable that has been declared.
        if a.prims.is_empty() {
            return b;
        }
        assert!(
            b.prims.is_empty() || (core::ptr::eq(a.prims, b.prims) && a.id == b.id),
            "a kernel cannot choose between two slices or trees by a value of its rays: choose \
             between what it reads from them, or by a captured `bool`"
        );
        a
    }
}
