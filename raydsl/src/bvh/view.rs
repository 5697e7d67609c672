//! The light view of a slice, a tree or a list of trees, that kernels work on.

use core::slice;
use std::borrow::Cow;

use super::list;
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

/// The buffers of a scene, as [`BufferKey::part`] numbers them.
pub(crate) mod buffers {
    pub(crate) const PRIMITIVES: u32 = 0;
    pub(crate) const NODES: u32 = 1;
    pub(crate) const INDICES: u32 = 2;
    pub(crate) const SHARED: u32 = 3;
    pub(crate) const ROOTS: u32 = 4;
}

/// The nodes of a tree and its index list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Branches<'a> {
    pub(crate) nodes: &'a [Node],
    pub(crate) indices: &'a [u32],
}

/// Primitives, what they share, and the tree over them if there is one.
#[derive(Debug)]
pub(crate) struct Part<'a, T, S> {
    pub(crate) prims: &'a [T],
    pub(crate) shared: &'a [S],
    pub(crate) tree: Option<Branches<'a>>,
    /// The number of its first primitive, among those of a list.
    pub(crate) first: u32,
}

impl<T, S> Clone for Part<'_, T, S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, S> Copy for Part<'_, T, S> {}

/// A slice, a tree over one, or a list of trees: a value of the host on every machine.
///
/// `S` is the type of what the primitives share; see [`Primitive::Shared`].
#[derive(Debug)]
pub struct View<'a, T, S = ()> {
    own: Part<'a, T, S>,
    /// The trees of a list.
    list: Option<&'a [Part<'a, T, S>]>,
    /// The number of the tree or list; 0 for a plain slice.
    owner: u64,
    /// How often the tree has been refitted.
    version: u32,
    /// Which of the owner's buffers.
    buffer: u32,
    name: &'static str,
    /// The kinds of primitives under the tree.
    kinds: Kinds,
}

/// The view of primitives and of what they share.
pub type SceneView<'a, P> = View<'a, P, <P as Primitive>::Shared>;

impl<T, S> Clone for View<'_, T, S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, S> Copy for View<'_, T, S> {}

impl<'a, T, S> View<'a, T, S> {
    #[inline(always)]
    pub(crate) fn slice(prims: &'a [T]) -> Self {
        let own = Part { prims, shared: &[], tree: None, first: 0 };
        let buffer = buffers::PRIMITIVES;
        Self { own, list: None, owner: 0, version: 0, buffer, name: "prims", kinds: Kinds::ALL }
    }

    #[inline(always)]
    pub(crate) fn tree(own: Part<'a, T, S>, owner: u64, version: u32, kinds: Kinds) -> Self {
        Self { own, list: None, owner, version, buffer: buffers::PRIMITIVES, name: "bvh", kinds }
    }

    #[inline(always)]
    pub(crate) fn list(list: &'a [Part<'a, T, S>], owner: u64, kinds: Kinds) -> Self {
        Self { list: Some(list), owner, name: "trees", kinds, ..Self::slice(&[]) }
    }

    /// The view under the name that it has in the source.
    #[inline(always)]
    pub(crate) fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    /// What a query looks through, one after another.
    #[inline(always)]
    pub(crate) fn parts(&self) -> &[Part<'a, T, S>] {
        self.list.unwrap_or(slice::from_ref(&self.own))
    }

    /// What the primitives share.
    #[inline(always)]
    pub fn shared(&self) -> View<'a, S> {
        // The trees of a list share the same.
        let part = self.list.map_or(Some(&self.own), |list| list.first());
        let shared = part.map_or(&[][..], |part| part.shared);
        let view = View::slice(shared);
        let (owner, version) = (self.owner, self.version);
        View { owner, version, buffer: buffers::SHARED, name: self.name, ..view }
    }

    /// The elements of a slice.
    #[inline(always)]
    pub(crate) fn elements(&self) -> &'a [T] {
        self.own.prims
    }

    /// How many primitives.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.list.map_or(self.own.prims.len(), |list| list.iter().map(|p| p.prims.len()).sum())
    }

    /// Whether there are none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether trees stand over the primitives.
    #[inline(always)]
    pub(crate) fn has_tree(&self) -> bool {
        self.is_list() || self.own.tree.is_some()
    }

    /// Whether it is a list of trees.
    #[inline(always)]
    pub(crate) fn is_list(&self) -> bool {
        self.list.is_some()
    }

    pub(crate) fn name(&self) -> Cow<'static, str> {
        match self.buffer {
            buffers::SHARED => format!("{}_shared", self.name).into(),
            _ => self.name.into(),
        }
    }

    pub(crate) fn key(&self) -> BufferKey {
        if self.owner == 0 { slice_key(self.own.prims) } else { self.key_of(self.buffer) }
    }

    /// The key of another buffer of the same scene.
    pub(crate) fn key_of(&self, part: u32) -> BufferKey {
        // Refitting leaves the order of the primitives as it is.
        let version = if part == buffers::INDICES { 0 } else { self.version };
        BufferKey { id: self.owner, version, part }
    }

    /// How many nodes and how many indices.
    pub(crate) fn tree_len(&self) -> (u64, u64) {
        let trees = self.parts().iter().filter_map(|p| p.tree);
        trees.fold((0, 0), |(n, i), t| (n + t.nodes.len() as u64, i + t.indices.len() as u64))
    }

    /// How many trees have a root.
    pub(crate) fn root_len(&self) -> u64 {
        list::roots(self.parts()).count() as u64
    }
}

impl<T: Copy, S> View<'_, T, S> {
    /// The primitive `index`.
    ///
    /// # Panics
    ///
    /// If there is no such primitive.
    #[inline(always)]
    pub fn get(&self, index: u32) -> T {
        match self.list {
            None => self.own.prims[index as usize],
            Some(list) => {
                let part = &list[list::tree_of(list, index)];
                part.prims[(index - part.first) as usize]
            }
        }
    }
}

impl<P: Primitive> SceneView<'_, P> {
    /// The kinds of its primitives.
    pub(crate) fn kinds(&self) -> Kinds {
        if self.has_tree() { self.kinds } else { Kinds::of(self.elements()) }
    }
}

impl<T: Type, S: Type> Resource for View<'_, T, S> {
    fn bytes(&self, key: BufferKey) -> Option<Cow<'_, [u8]>> {
        let parts = self.parts();
        if key == self.key() {
            return Some(Cow::Owned(match parts {
                [part] => bytes_of(part.prims),
                _ => parts.iter().map(|part| bytes_of(part.prims)).collect::<Vec<_>>().concat(),
            }));
        }
        if key != self.key_of(key.part) {
            return None;
        }
        match key.part {
            buffers::NODES => Some(list::nodes(parts)),
            buffers::INDICES => Some(list::indices(parts)),
            buffers::SHARED => Some(Cow::Owned(bytes_of(self.shared().elements()))),
            buffers::ROOTS => {
                let roots: Vec<u32> = list::roots(parts).collect();
                Some(Cow::Owned(bytemuck::cast_slice(&roots).to_vec()))
            }
            _ => None,
        }
    }
}

impl<M: Machine, T, S> Value<M> for View<'_, T, S> {
    const SCHEMA: &'static Schema = &Schema::Host;

    #[inline(always)]
    fn zero(_: &M) -> Self {
        Self::slice(&[])
    }

    #[inline(always)]
    fn zip(_: &M, a: Self, b: Self, _: &mut impl Leaves<M>) -> Self {
        // Nothing yet: a variable that has been declared.
        let is_nothing = |v: &Self| v.owner == 0 && v.own.prims.is_empty();
        if is_nothing(&a) {
            return b;
        }
        assert!(
            is_nothing(&b) || (core::ptr::eq(a.own.prims, b.own.prims) && a.owner == b.owner),
            "a kernel cannot choose between two slices or trees by a value of its rays: choose \
             between what it reads from them, or by a captured `bool`"
        );
        a
    }
}
