//! The view of a scene that kernels work on: a slice, a tree, a list of trees, or instances.

use std::borrow::Cow;

use glam::Affine3;

use super::contract::Padding;
use super::instances::Placed;
use super::structure::Structure;
use super::wide::{Wide, WideQueries};
use super::{Accelerator, Node, Owned, list};
use crate::geometry::{Kinds, Names, Primitive, Ray, Shared, SharedStore};
use crate::machine::{
    Data, Description, Field, Leaves, Machine, Owner, Resource, Schema, Slice, Type, Value,
    borrowed_key, bytes_of, read_in_place, wgsl::BufferKey,
};

/// The schema of a [`Node`].
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
    pub(crate) const ROOTS: u32 = 4;
    pub(crate) const PLACES: u32 = 5;
    pub(crate) const WIDE_NODES: u32 = 6;
    pub(crate) const LEAVES: u32 = 7;
    pub(crate) const LEAF_IDS: u32 = 8;
    pub(crate) const WIDE_ROOTS: u32 = 9;
    /// Of each slice of shared data, by its place.
    pub(crate) const SHARED: [u32; 3] = [3, 10, 11];
}

/// The nodes of a tree and its index list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Branches<'a> {
    pub(crate) nodes: &'a [Node],
    pub(crate) indices: &'a [u32],
}

/// The structure that finds the primitives that a ray may hit.
#[derive(Clone, Copy)]
pub(crate) enum Finder<'a> {
    /// No structure: all primitives are tested.
    Nothing,
    Trees(&'a Structure),
    Accelerator(&'a dyn Accelerator),
}

/// Primitives, their shared data, and the structure that finds them.
pub(crate) struct Part<'a, T, S: Shared> {
    pub(crate) prims: &'a [T],
    pub(crate) shared: SharedStore<'a, S>,
    pub(crate) finder: Finder<'a>,
    /// The id of its first primitive, among those of a list.
    pub(crate) first: u32,
}

impl<T, S: Shared> core::fmt::Debug for Part<'_, T, S> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let primitives = self.prims.len();
        f.debug_struct("Part").field("primitives", &primitives).finish_non_exhaustive()
    }
}

impl<T, S: Shared> Clone for Part<'_, T, S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, S: Shared> Copy for Part<'_, T, S> {}

impl<'a, T, S: Shared> Part<'a, T, S> {
    /// Returns the binary tree, if there are trees; expanded from the wide one if necessary.
    #[inline(always)]
    pub(crate) fn tree(&self) -> Option<Branches<'a>> {
        match self.finder {
            Finder::Trees(structure) => Some(structure.branches()),
            _ => None,
        }
    }

    /// Returns the number of nodes of the binary tree, and of its index list, if there are trees.
    fn binary_len(&self) -> Option<[usize; 2]> {
        match self.finder {
            Finder::Trees(structure) => Some(structure.binary_len()),
            _ => None,
        }
    }

    /// Returns the wide tree, if there is one.
    #[inline(always)]
    pub(crate) fn wide(&self) -> Option<&'a Wide> {
        match self.finder {
            Finder::Trees(structure) => structure.wide(),
            _ => None,
        }
    }
}

/// A tree, its primitives and their shared data.
#[derive(Debug)]
pub(crate) struct Tree<'a, T, S: Shared> {
    pub(crate) prims: &'a [T],
    pub(crate) shared: SharedStore<'a, S>,
    pub(super) own: Owned,
    pub(super) kinds: Kinds,
    /// The traversals of wide trees, if the tree is wide.
    pub(super) queries: Option<WideQueries<T, S>>,
}

impl<T, S: Shared> Tree<'_, T, S> {
    #[inline(always)]
    pub(super) fn part(&self) -> Part<'_, T, S> {
        let finder = Finder::Trees(&self.own.structure);
        Part { prims: self.prims, shared: self.shared, finder, first: 0 }
    }
}

/// The trees of a list.
#[derive(Debug)]
pub(crate) struct Trees<'a, T, S: Shared> {
    pub(super) parts: Vec<Part<'a, T, S>>,
    pub(super) shared: SharedStore<'a, S>,
    pub(super) owner: Owner,
    pub(super) kinds: Kinds,
    /// The traversals of wide trees, if all trees are wide.
    pub(super) queries: Option<WideQueries<T, S>>,
}

/// Primitives under an application-defined acceleration structure.
pub(crate) struct Standing<'a, T, S: Shared> {
    pub(super) prims: &'a [T],
    pub(super) shared: SharedStore<'a, S>,
    pub(super) accelerator: Box<dyn Accelerator + 'a>,
    pub(super) owner: Owner,
    pub(super) kinds: Kinds,
}

impl<T, S: Shared> Standing<'_, T, S> {
    #[inline(always)]
    fn part(&self) -> Part<'_, T, S> {
        let finder = Finder::Accelerator(&*self.accelerator);
        Part { prims: self.prims, shared: self.shared, finder, first: 0 }
    }
}

/// The kind of a scene.
enum Scene<'a, T, S: Shared> {
    Slice(Slice<'a, T>),
    Tree(&'a Tree<'a, T, S>),
    List(&'a Trees<'a, T, S>),
    Instances(&'a Placed<'a, T, S>),
    Standing(&'a Standing<'a, T, S>),
}

/// View of a scene in kernels: a slice, a tree over one, a list of trees, instances, or an
/// application-defined structure. A host value on every machine.
///
/// `S` is the type of the shared data of primitives; see [`Primitive::Shared`].
pub struct View<'a, T, S: Shared = ()> {
    scene: Scene<'a, T, S>,
    name: &'static str,
}

/// The view of primitives and of their shared data.
pub type SceneView<'a, P> = View<'a, P, <P as Primitive>::Shared>;

impl<T, S: Shared> Clone for Scene<'_, T, S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, S: Shared> Copy for Scene<'_, T, S> {}

impl<T, S: Shared> core::fmt::Debug for View<'_, T, S> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("View").field("name", &self.name).field("len", &self.len()).finish()
    }
}

impl<T, S: Shared> Clone for View<'_, T, S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, S: Shared> Copy for View<'_, T, S> {}

impl<'a, T, S: Shared> View<'a, T, S> {
    #[inline(always)]
    pub(crate) fn slice(prims: Slice<'a, T>) -> Self {
        Self { name: prims.source_name(), scene: Scene::Slice(prims) }
    }

    #[inline(always)]
    pub(super) fn tree(tree: &'a Tree<'a, T, S>) -> Self {
        Self { scene: Scene::Tree(tree), name: "bvh" }
    }

    #[inline(always)]
    pub(super) fn list(trees: &'a Trees<'a, T, S>) -> Self {
        Self { scene: Scene::List(trees), name: "trees" }
    }

    #[inline(always)]
    pub(super) fn instances(placed: &'a Placed<'a, T, S>) -> Self {
        Self { scene: Scene::Instances(placed), name: "scene" }
    }

    #[inline(always)]
    pub(super) fn standing(standing: &'a Standing<'a, T, S>) -> Self {
        Self { scene: Scene::Standing(standing), name: "prims" }
    }

    /// Returns the address of the scene, which is the same for all views of it.
    pub(crate) fn address(&self) -> [usize; 3] {
        match self.scene {
            Scene::Slice(prims) => {
                let prims = prims.elements();
                [0, prims.as_ptr().addr(), prims.len()]
            }
            Scene::Tree(tree) => [1, core::ptr::from_ref(tree).addr(), 0],
            Scene::List(trees) => [2, core::ptr::from_ref(trees).addr(), 0],
            Scene::Instances(placed) => [3, core::ptr::from_ref(placed).addr(), 0],
            Scene::Standing(standing) => [4, core::ptr::from_ref(standing).addr(), 0],
        }
    }

    /// Returns whether an application-defined structure finds the primitives.
    #[inline(always)]
    pub(crate) fn is_standing(&self) -> bool {
        matches!(self.scene, Scene::Standing(_))
    }

    /// Names the view as in the source.
    #[inline(always)]
    pub(crate) fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    /// Returns the traversals of wide trees, if all trees of the scene are wide.
    #[inline(always)]
    pub(crate) fn queries(&self) -> Option<&'a WideQueries<T, S>> {
        match self.scene {
            Scene::Tree(tree) => tree.queries.as_ref(),
            Scene::List(trees) => trees.queries.as_ref(),
            Scene::Slice(_) | Scene::Instances(_) | Scene::Standing(_) => None,
        }
    }

    /// Returns the trees of a list, or of a scene of instances.
    #[inline(always)]
    fn trees(&self) -> Option<&'a Trees<'a, T, S>> {
        match self.scene {
            Scene::Slice(_) | Scene::Tree(_) | Scene::Standing(_) => None,
            Scene::List(trees) => Some(trees),
            Scene::Instances(placed) => Some(&placed.trees),
        }
    }

    /// Returns the instances, if it is a scene of instances, whose parts are placed by transforms.
    #[inline(always)]
    pub(crate) fn placed(&self) -> Option<&'a Placed<'a, T, S>> {
        match self.scene {
            Scene::Instances(placed) => Some(placed),
            _ => None,
        }
    }

    /// Iterates over the parts of the scene, which a query without instances traverses one after
    /// another.
    #[inline(always)]
    pub(crate) fn parts(&self) -> impl Iterator<Item = Part<'a, T, S>> + use<'a, T, S> {
        let view = *self;
        (0..).map_while(
            #[inline(always)]
            move |i| view.part(i),
        )
    }

    /// Returns part `i` of the scene.
    #[inline(always)]
    pub(crate) fn part(&self, i: usize) -> Option<Part<'a, T, S>> {
        match self.scene {
            Scene::Slice(prims) => (i == 0).then_some(Part {
                prims: prims.elements(),
                shared: SharedStore::NONE,
                finder: Finder::Nothing,
                first: 0,
            }),
            Scene::Standing(standing) => (i == 0).then(|| standing.part()),
            Scene::Tree(tree) => (i == 0).then(|| tree.part()),
            Scene::List(trees) => trees.parts.get(i).copied(),
            Scene::Instances(placed) => placed.trees.parts.get(i).copied(),
        }
    }

    /// Returns the shared data of the primitives: a slice, or a tuple of slices of an enum whose
    /// kinds share [several](crate::geometry::Several).
    #[inline(always)]
    pub fn shared(&self) -> S::Views<'a> {
        S::views(self.stored(), self.shared_names())
    }

    /// Returns the shared data as the scene has them.
    #[inline(always)]
    pub(crate) fn stored(&self) -> SharedStore<'a, S> {
        match self.scene {
            Scene::Slice(_) => SharedStore::NONE,
            Scene::Tree(tree) => tree.shared,
            Scene::List(trees) => trees.shared,
            Scene::Instances(placed) => placed.trees.shared,
            Scene::Standing(standing) => standing.shared,
        }
    }

    /// Returns the names of the slices of shared data, and the keys of their buffers.
    #[inline(always)]
    fn shared_names(&self) -> Names {
        let key = (!self.is_slice()).then(|| self.key_of(buffers::SHARED[0]));
        Names::new(self.name, key, buffers::SHARED)
    }

    /// Returns the elements of a slice, or of the slice under a tree.
    #[inline(always)]
    pub(crate) fn elements(&self) -> &'a [T] {
        match self.scene {
            Scene::Slice(prims) => prims.elements(),
            Scene::Tree(tree) => tree.prims,
            Scene::Standing(standing) => standing.prims,
            Scene::List(_) | Scene::Instances(_) => &[],
        }
    }

    /// Returns the number of primitives.
    #[inline(always)]
    pub fn len(&self) -> usize {
        match self.trees() {
            Some(trees) => trees.parts.iter().map(|part| part.prims.len()).sum(),
            None => self.elements().len(),
        }
    }

    /// Returns whether there are no primitives.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn is_slice(&self) -> bool {
        matches!(self.scene, Scene::Slice(_))
    }

    /// Returns whether there are trees over the primitives.
    pub(crate) fn has_tree(&self) -> bool {
        !self.is_slice() && !self.is_standing()
    }

    /// Returns whether it is a scene of instances, whose primitives are in spaces of their own.
    #[inline(always)]
    pub(crate) fn has_instances(&self) -> bool {
        self.placed().is_some()
    }

    /// Returns whether it is a list of trees.
    pub(crate) fn is_list(&self) -> bool {
        matches!(self.scene, Scene::List(_))
    }

    /// Returns the key of another buffer of the same scene.
    pub(crate) fn key_of(&self, part: u32) -> BufferKey {
        let (id, version) = match self.scene {
            Scene::Slice(_) => (0, 0),
            Scene::Tree(tree) => (tree.own.owner.id(), tree.own.version),
            Scene::List(trees) => (trees.owner.id(), 0),
            Scene::Instances(placed) => (placed.trees.owner.id(), placed.version),
            Scene::Standing(standing) => (standing.owner.id(), 0),
        };
        // Refitting keeps the order of the primitives, and moved instances keep the primitives.
        let stays = match self.scene {
            Scene::Instances(_) => part == buffers::PRIMITIVES || buffers::SHARED.contains(&part),
            _ => part == buffers::INDICES,
        };
        let version = if stays { 0 } else { version };
        BufferKey { id, version, part }
    }

    /// Returns the ray in the space of an instance's tree; the ray itself without instances.
    pub(crate) fn local_ray(&self, inst: u32, ray: Ray) -> Ray {
        self.placed().map_or(ray, |placed| placed.local_ray(inst, ray))
    }

    /// Returns the transform from the space of the scene to that of an instance's tree.
    pub(crate) fn to_object(self, inst: u32) -> Affine3 {
        self.placed().map_or(Affine3::IDENTITY, |placed| placed.to_object(inst))
    }

    /// Returns the number of nodes and of indices.
    pub(crate) fn tree_len(&self) -> (u64, u64) {
        let (mut nodes, mut ids) = self.placed().map_or((0, 0), Placed::group_len);
        for part in self.parts() {
            let [of_part, ids_of_part] = part.binary_len().unwrap_or_default();
            nodes += of_part as u64;
            ids += ids_of_part as u64;
        }
        (nodes, ids)
    }

    /// Returns the number of trees with a root.
    pub(crate) fn root_len(&self) -> u64 {
        let mut roots = 0;
        for part in self.parts() {
            let [nodes, _] = part.binary_len().unwrap_or_default();
            roots += u64::from(nodes > 0);
        }
        roots
    }
}

impl<T: Type, S: Shared> Data for View<'_, T, S> {
    type Element = T;

    #[inline(always)]
    fn count(&self) -> usize {
        self.len()
    }

    #[inline(always)]
    fn get(&self, index: u32) -> T {
        match self.trees() {
            Some(trees) => {
                let part = &trees.parts[list::tree_of(&trees.parts, index)];
                part.prims[(index - part.first) as usize]
            }
            None => self.elements()[index as usize],
        }
    }

    fn kinds(&self) -> Option<Kinds> {
        match self.scene {
            Scene::Slice(prims) => prims.kinds(),
            Scene::Tree(tree) => Some(tree.kinds),
            Scene::List(trees) => Some(trees.kinds),
            Scene::Instances(placed) => Some(placed.trees.kinds),
            Scene::Standing(standing) => Some(standing.kinds),
        }
    }

    fn key(&self) -> BufferKey {
        match self.scene {
            Scene::Slice(prims) => prims.key(),
            Scene::Standing(standing) => borrowed_key(standing.prims),
            _ => self.key_of(buffers::PRIMITIVES),
        }
    }

    fn name(&self) -> Cow<'static, str> {
        match self.scene {
            Scene::Slice(prims) => Data::name(&prims),
            _ => self.name.into(),
        }
    }
}

impl<P: Primitive> SceneView<'_, P> {
    /// Returns the kinds of its primitives.
    pub(crate) fn kinds(&self) -> Kinds {
        match self.scene {
            Scene::Slice(prims) => Kinds::of(prims.elements()),
            Scene::Tree(tree) => tree.kinds,
            Scene::List(trees) => trees.kinds,
            Scene::Instances(placed) => placed.trees.kinds,
            Scene::Standing(standing) => standing.kinds,
        }
    }

    /// Returns the padding of boxes, and of the culling distance behind a hit.
    #[inline(always)]
    pub(crate) fn padding(&self) -> Padding {
        let top = self.placed().and_then(Placed::top);
        top.map_or(Padding::of::<P>(), |top| top.padding)
    }
}

impl<T: Type, S: Shared> Resource for View<'_, T, S> {
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
            buffers::NODES => Some(match self.placed() {
                Some(placed) => placed.node_bytes(),
                None => list::nodes(&parts),
            }),
            buffers::INDICES => Some(match self.placed() {
                Some(placed) => placed.index_bytes(),
                None => list::indices(&parts),
            }),
            buffers::PLACES => self.placed().map(Placed::place_bytes),
            buffers::ROOTS => {
                let roots: Vec<u32> = list::roots(&parts).collect();
                Some(Cow::Owned(bytemuck::cast_slice(&roots).to_vec()))
            }
            part => match buffers::SHARED.iter().position(|shared| *shared == part) {
                Some(place) => self.stored().bytes(place as u32).map(Cow::Owned),
                None => self.wide_bytes(part),
            },
        }
    }

    fn describe(&self, out: &mut Description) {
        match self.scene {
            Scene::Slice(prims) => {
                out.fact(0);
                out.data(&prims);
            }
            Scene::Tree(_) | Scene::List(_) => {
                let is_list = self.is_list();
                out.fact(1 + u64::from(is_list));
                out.data(self);
                self.stored().describe(self.shared_names(), out);
                let name = Data::name(self);
                let (nodes, indices) = self.tree_len();
                let (of_nodes, of_indices) = (buffers::NODES, buffers::INDICES);
                let key = |part| self.key_of(part);
                out.buffer(key(of_nodes), &format!("{name}_nodes"), NODE_SCHEMA, nodes);
                out.buffer(key(of_indices), &format!("{name}_ids"), &Schema::U32, indices);
                if is_list {
                    let roots = self.root_len();
                    out.buffer(key(buffers::ROOTS), &format!("{name}_roots"), &Schema::U32, roots);
                }
                match self.wide_buffers() {
                    Some(wide) => wide.describe(out, &key),
                    None => out.fact(0),
                }
            }
            // Their text depends on how deep they are nested, among others.
            Scene::Instances(_) | Scene::Standing(_) => out.leave_open(),
        }
    }
}

impl<M: Machine, T, S: Shared> Value<M> for View<'_, T, S> {
    const SCHEMA: &'static Schema = &Schema::Host;

    #[inline(always)]
    fn zero(_: &M) -> Self {
        Self::slice(Slice::new(&[], "prims"))
    }

    #[inline(always)]
    fn zip(_: &M, a: Self, b: Self, _: &mut impl Leaves<M>) -> Self {
        // An empty slice is the zero value of a declared variable.
        let is_nothing = |v: &Self| v.is_slice() && v.elements().is_empty();
        if is_nothing(&a) {
            return b;
        }
        let is_same = || match (a.scene, b.scene) {
            (Scene::Slice(a), Scene::Slice(b)) => core::ptr::eq(a.elements(), b.elements()),
            (Scene::Tree(a), Scene::Tree(b)) => core::ptr::eq(a, b),
            (Scene::List(a), Scene::List(b)) => core::ptr::eq(a, b),
            (Scene::Instances(a), Scene::Instances(b)) => core::ptr::eq(a, b),
            (Scene::Standing(a), Scene::Standing(b)) => core::ptr::eq(a, b),
            _ => false,
        };
        assert!(
            is_nothing(&b) || is_same(),
            "a kernel cannot choose between two scenes by a value of its rays: choose \
             between what it reads from them, or by a captured `bool`"
        );
        a
    }
}

read_in_place!([T: Type, S: Shared] View<'_, T, S>);
