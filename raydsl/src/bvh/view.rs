//! The light view of a slice, a tree or a list of trees, that kernels work on.

use std::borrow::Cow;

use super::owner::Owner;
use super::{Node, Owned, bytes_of, list, slice_key};
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

/// A tree: its primitives, what they share, and what is its own.
#[derive(Debug)]
pub(crate) struct Tree<'a, T, S> {
    pub(crate) prims: &'a [T],
    pub(crate) shared: &'a [S],
    pub(super) own: Owned,
    pub(super) kinds: Kinds,
}

impl<T, S> Tree<'_, T, S> {
    #[inline(always)]
    pub(super) fn part(&self) -> Part<'_, T, S> {
        let tree = Some(Branches { nodes: &self.own.nodes, indices: &self.own.indices });
        Part { prims: self.prims, shared: self.shared, tree, first: 0 }
    }
}

/// The trees of a list.
#[derive(Debug)]
pub(crate) struct Trees<'a, T, S> {
    pub(super) parts: Vec<Part<'a, T, S>>,
    pub(super) shared: &'a [S],
    pub(super) owner: Owner,
    pub(super) kinds: Kinds,
}

/// What a view is of. Small, since kernels hand views to each other.
#[derive(Debug)]
enum Scene<'a, T, S> {
    Slice(&'a [T]),
    Tree(&'a Tree<'a, T, S>),
    List(&'a Trees<'a, T, S>),
}

/// A slice, a tree over one, or a list of trees: a value of the host on every machine.
///
/// `S` is the type of what the primitives share; see [`Primitive::Shared`].
#[derive(Debug)]
pub struct View<'a, T, S = ()> {
    scene: Scene<'a, T, S>,
    /// Of what primitives share, the name that a device has for it.
    key: Option<BufferKey>,
    name: &'static str,
}

/// The view of primitives and of what they share.
pub type SceneView<'a, P> = View<'a, P, <P as Primitive>::Shared>;

impl<T, S> Clone for Scene<'_, T, S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, S> Copy for Scene<'_, T, S> {}

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
        Self { scene: Scene::Slice(prims), key: None, name: "prims" }
    }

    #[inline(always)]
    pub(super) fn tree(tree: &'a Tree<'a, T, S>) -> Self {
        Self { scene: Scene::Tree(tree), key: None, name: "bvh" }
    }

    #[inline(always)]
    pub(super) fn list(trees: &'a Trees<'a, T, S>) -> Self {
        Self { scene: Scene::List(trees), key: None, name: "trees" }
    }

    /// The view under the name that it has in the source.
    #[inline(always)]
    pub(crate) fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    /// What a query looks through, one after another.
    #[inline(always)]
    pub(crate) fn parts(&self) -> impl Iterator<Item = Part<'a, T, S>> + use<'a, T, S> {
        let scene = self.scene;
        let count = match scene {
            Scene::Slice(_) | Scene::Tree(_) => 1,
            Scene::List(trees) => trees.parts.len(),
        };
        (0..count).map(
            #[inline(always)]
            move |i| match scene {
                Scene::Slice(prims) => Part { prims, shared: &[], tree: None, first: 0 },
                Scene::Tree(tree) => tree.part(),
                Scene::List(trees) => trees.parts[i],
            },
        )
    }

    /// What the primitives share.
    #[inline(always)]
    pub fn shared(&self) -> View<'a, S> {
        let shared = match self.scene {
            Scene::Slice(_) => &[],
            Scene::Tree(tree) => tree.shared,
            Scene::List(trees) => trees.shared,
        };
        let key = (!self.is_slice()).then(|| self.key_of(buffers::SHARED));
        View { key, name: self.name, ..View::slice(shared) }
    }

    /// The elements of a slice, or of the slice under a tree.
    #[inline(always)]
    pub(crate) fn elements(&self) -> &'a [T] {
        match self.scene {
            Scene::Slice(prims) => prims,
            Scene::Tree(tree) => tree.prims,
            Scene::List(_) => &[],
        }
    }

    /// How many primitives.
    #[inline(always)]
    pub fn len(&self) -> usize {
        match self.scene {
            Scene::List(trees) => trees.parts.iter().map(|part| part.prims.len()).sum(),
            _ => self.elements().len(),
        }
    }

    /// Whether there are none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn is_slice(&self) -> bool {
        matches!(self.scene, Scene::Slice(_))
    }

    /// Whether trees stand over the primitives.
    pub(crate) fn has_tree(&self) -> bool {
        !self.is_slice()
    }

    /// Whether it is a list of trees.
    pub(crate) fn is_list(&self) -> bool {
        matches!(self.scene, Scene::List(_))
    }

    pub(crate) fn name(&self) -> Cow<'static, str> {
        match self.key {
            Some(_) => format!("{}_shared", self.name).into(),
            None => self.name.into(),
        }
    }

    /// The key of the primitives, or of what they share.
    pub(crate) fn key(&self) -> BufferKey {
        match (self.key, self.scene) {
            (Some(key), _) => key,
            (None, Scene::Slice(prims)) => slice_key(prims),
            (None, _) => self.key_of(buffers::PRIMITIVES),
        }
    }

    /// The key of another buffer of the same scene.
    pub(crate) fn key_of(&self, part: u32) -> BufferKey {
        let (id, version) = match self.scene {
            Scene::Slice(_) => (0, 0),
            Scene::Tree(tree) => (tree.own.owner.id(), tree.own.version),
            Scene::List(trees) => (trees.owner.id(), 0),
        };
        // Refitting leaves the order of the primitives as it is.
        let version = if part == buffers::INDICES { 0 } else { version };
        BufferKey { id, version, part }
    }

    /// How many nodes and how many indices.
    pub(crate) fn tree_len(&self) -> (u64, u64) {
        let trees = self.parts().filter_map(|part| part.tree);
        trees.fold((0, 0), |(n, i), t| (n + t.nodes.len() as u64, i + t.indices.len() as u64))
    }

    /// How many trees have a root.
    pub(crate) fn root_len(&self) -> u64 {
        let parts: Vec<_> = self.parts().collect();
        list::roots(&parts).count() as u64
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
        match self.scene {
            Scene::List(trees) => {
                let part = &trees.parts[list::tree_of(&trees.parts, index)];
                part.prims[(index - part.first) as usize]
            }
            _ => self.elements()[index as usize],
        }
    }
}

impl<P: Primitive> SceneView<'_, P> {
    /// The kinds of its primitives.
    pub(crate) fn kinds(&self) -> Kinds {
        match self.scene {
            Scene::Slice(prims) => Kinds::of(prims),
            Scene::Tree(tree) => tree.kinds,
            Scene::List(trees) => trees.kinds,
        }
    }
}

impl<T: Type, S: Type> Resource for View<'_, T, S> {
    fn bytes(&self, key: BufferKey) -> Option<Cow<'_, [u8]>> {
        let parts: Vec<_> = self.parts().collect();
        if key == self.key() {
            return Some(Cow::Owned(match &parts[..] {
                [part] => bytes_of(part.prims),
                _ => parts.iter().map(|part| bytes_of(part.prims)).collect::<Vec<_>>().concat(),
            }));
        }
        if self.is_slice() || key != self.key_of(key.part) {
            return None;
        }
        match key.part {
            buffers::NODES => Some(list::nodes(&parts)),
            buffers::INDICES => Some(list::indices(&parts)),
            buffers::SHARED => Some(Cow::Owned(bytes_of(self.shared().elements()))),
            buffers::ROOTS => {
                let roots: Vec<u32> = list::roots(&parts).collect();
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
        let is_nothing = |v: &Self| v.is_slice() && v.elements().is_empty();
        if is_nothing(&a) {
            return b;
        }
        let is_same = || match (a.scene, b.scene) {
            (Scene::Slice(a), Scene::Slice(b)) => core::ptr::eq(a, b),
            (Scene::Tree(a), Scene::Tree(b)) => core::ptr::eq(a, b),
            (Scene::List(a), Scene::List(b)) => core::ptr::eq(a, b),
            _ => false,
        };
        assert!(
            is_nothing(&b) || is_same(),
            "a kernel cannot choose between two slices or trees by a value of its rays: choose \
             between what it reads from them, or by a captured `bool`"
        );
        a
    }
}
