//! Device buffers of a scene of instances: its trees and groups in one array each.
//!
//! The nodes of the groups follow those of the trees. Leaves of a group hold indices into a table
//! of places instead of primitive ids, and mark them with the highest bit.

use crate::geometry::Shared;
use std::borrow::Cow;

use bytemuck::cast_slice;
use glam::Affine3;

use super::placed::{Placed, Placing, Target};
use crate::bvh::contract::Padding;
use crate::bvh::{Node, list};
use crate::machine::{Field, Schema, Type};

/// Bit that distinguishes the index of a place from a primitive id.
pub(crate) const IS_INSTANCE: u32 = 1 << 31;

/// Root index of an empty tree.
const NO_ROOT: u32 = u32::MAX;

/// Placed object: its transform, tree and padding. The first place is the scene's own.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Place {
    to_object: [f32; 12],
    /// Root of the placed tree, or [`NO_ROOT`].
    root: u32,
    /// Index of its first tree, among those of its group.
    first: u32,
    /// Padding of its boxes: see `Padding`.
    slack: f32,
    origin: f32,
    /// For a group, the places of its instances.
    items: u32,
    count: u32,
}

/// Schema of a place.
pub(crate) const PLACE_SCHEMA: &Schema = &Schema::Struct {
    name: "Place",
    fields: &[
        Field { name: "to_object", offset: 0, schema: <Affine3 as Type>::SCHEMA },
        Field { name: "root", offset: 48, schema: &Schema::U32 },
        Field { name: "first", offset: 52, schema: &Schema::U32 },
        Field { name: "slack", offset: 56, schema: &Schema::F32 },
        Field { name: "origin", offset: 60, schema: &Schema::F32 },
        Field { name: "items", offset: 64, schema: &Schema::U32 },
        Field { name: "count", offset: 68, schema: &Schema::U32 },
    ],
    size: 72,
};

impl<T, S: Shared> Placed<'_, T, S> {
    /// Returns the number of nodes and indices of the groups.
    pub(crate) fn group_len(&self) -> (u64, u64) {
        self.groups.iter().map(Placing::branches).fold((0, 0), |(nodes, indices), tree| {
            (nodes + tree.nodes.len() as u64, indices + tree.indices.len() as u64)
        })
    }

    /// Returns the number of places.
    pub(crate) fn place_count(&self) -> u64 {
        1 + self.groups.iter().map(|group| group.items.len() as u64).sum::<u64>()
    }

    /// Returns the number of nodes and indices before those of the groups.
    fn len_of_trees(&self) -> [u32; 2] {
        let trees = self.trees.parts.iter().filter_map(|part| part.tree());
        trees.fold([0, 0], |[nodes, indices], tree| {
            [nodes + tree.nodes.len() as u32, indices + tree.indices.len() as u32]
        })
    }

    /// Returns the nodes of all trees and groups.
    pub(crate) fn node_bytes(&self) -> Cow<'_, [u8]> {
        let mut bytes = list::nodes(&self.trees.parts).into_owned();
        let [mut nodes, mut indices] = self.len_of_trees();
        for tree in self.groups.iter().map(Placing::branches) {
            for node in tree.nodes {
                let by = if node.is_leaf() { indices } else { nodes };
                let node = Node { first: node.first + by, ..*node };
                bytes.extend_from_slice(bytemuck::bytes_of(&node));
            }
            nodes += tree.nodes.len() as u32;
            indices += tree.indices.len() as u32;
        }
        Cow::Owned(bytes)
    }

    /// Returns the index lists of all trees and groups.
    pub(crate) fn index_bytes(&self) -> Cow<'_, [u8]> {
        let mut bytes = list::indices(&self.trees.parts).into_owned();
        let mut first = IS_INSTANCE + 1;
        for group in &self.groups {
            let places: Vec<u32> = group.branches().indices.iter().map(|i| first + i).collect();
            bytes.extend_from_slice(cast_slice(&places));
            first += group.items.len() as u32;
        }
        Cow::Owned(bytes)
    }

    /// Returns the table of places.
    pub(crate) fn place_bytes(&self) -> Cow<'_, [u8]> {
        let tree_roots = self.tree_roots();
        let groups = self.group_places();
        let of_tree = |tree: u32| Place { root: tree_roots[tree as usize], ..self.of_nothing() };
        let scene = groups.last().copied().unwrap_or_else(|| self.of_nothing());
        let items = self.groups.iter().flat_map(|group| &group.items).map(|item| {
            let place = match item.target {
                Target::Tree(tree) => of_tree(tree),
                Target::Group(group) => groups[group as usize],
            };
            Place { to_object: item.to_object.to_cols_array(), first: item.first, ..place }
        });
        let places: Vec<Place> = core::iter::once(scene).chain(items).collect();
        Cow::Owned(cast_slice(&places).to_vec())
    }

    /// Returns the place of a tree without a root.
    fn of_nothing(&self) -> Place {
        Place {
            to_object: Affine3::IDENTITY.to_cols_array(),
            root: NO_ROOT,
            first: 0,
            slack: self.padding.slack,
            origin: self.padding.origin,
            items: 0,
            count: 0,
        }
    }

    /// Returns a template place of every group, without a transform.
    fn group_places(&self) -> Vec<Place> {
        let mut items = 1;
        let place = |(group, root): (&Placing, u32)| {
            let count = group.items.len() as u32;
            let Padding { slack, origin } = group.padding;
            let place = Place { root, slack, origin, items, count, ..self.of_nothing() };
            items += count;
            place
        };
        self.groups.iter().zip(self.group_roots()).map(place).collect()
    }

    /// Returns the root index of every tree in the node array.
    fn tree_roots(&self) -> Vec<u32> {
        let lens = self.trees.parts.iter().map(|part| part.tree().map_or(0, |t| t.nodes.len()));
        roots(0, lens)
    }

    /// Returns the root index of every group in the node array.
    fn group_roots(&self) -> Vec<u32> {
        let [first, _] = self.len_of_trees();
        roots(first, self.groups.iter().map(|group| group.branches().nodes.len()))
    }
}

/// Returns the root indices of trees with so many nodes each, from `first` on; [`NO_ROOT`] for
/// empty ones.
fn roots(first: u32, lens: impl Iterator<Item = usize>) -> Vec<u32> {
    let mut next = first;
    let root = |len: usize| {
        let root = if len > 0 { next } else { NO_ROOT };
        next += len as u32;
        root
    };
    lens.map(root).collect()
}
