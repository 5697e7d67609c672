//! Expansion of a wide tree back to the binary tree that it was collapsed from.

use super::Wide;
use super::node::Child;
use crate::bvh::Node;
use crate::bvh::build::Tree;
use crate::geometry::Aabb;

impl Wide {
    /// Expands the wide tree to the binary tree that it was collapsed from, with one leaf for each
    /// block.
    pub(in crate::bvh) fn binary(&self) -> Tree {
        let [nodes, entries] = self.binary_len();
        let made = Tree { nodes: Vec::with_capacity(nodes), indices: Vec::with_capacity(entries) };
        let mut expansion = Expansion { wide: self, made };
        if !self.is_empty() {
            expansion.reserve(1);
            expansion.node(0, 0);
        }
        expansion.made
    }
}

struct Expansion<'a> {
    wide: &'a Wide,
    made: Tree,
}

impl Expansion<'_> {
    /// Reserves nodes and returns the index of the first.
    fn reserve(&mut self, count: usize) -> usize {
        let first = self.made.nodes.len();
        self.made.nodes.resize(first + count, Node::inner(Aabb::EMPTY, 0));
        first
    }

    /// Expands a wide node into the binary node at `place`; returns its bounds.
    fn node(&mut self, node: usize, place: usize) -> Aabb {
        self.member(node, self.wide.nodes[node].top(), place)
    }

    /// Expands a member of a wide node into the binary node at `place`: a child, or a joint of
    /// children. Returns its bounds.
    fn member(&mut self, node: usize, member: usize, place: usize) -> Aabb {
        let wide = &self.wide.nodes[node];
        let Some([left, right]) = wide.joined(member) else {
            return self.child(Child(wide.children[member]), wide.bounds(member), place);
        };
        let first = self.reserve(2);
        let bounds = self.member(node, left, first).union(self.member(node, right, first + 1));
        self.made.nodes[place] = Node::inner(bounds, first as u32);
        bounds
    }

    fn child(&mut self, child: Child, bounds: Aabb, place: usize) -> Aabb {
        if !child.is_block() {
            return self.node(child.index(), place);
        }
        let indices = &mut self.made.indices;
        let (first, ids) = (indices.len(), self.wide.blocks.members(child.index()));
        indices.extend_from_slice(ids);
        self.made.nodes[place] = Node::leaf(bounds, first as u32, ids.len() as u32);
        bounds
    }
}
