//! Subtrees built separately, and their assembly into one tree.
//!
//! Subtrees are built independently into arrays of their own, with node indices relative to the
//! array, and assembled at the end. Below a certain size a subtree is one piece of work and one
//! array; that size changes the distribution of work but not the result.

use super::reference::Bounds;
use crate::bvh::Node;

/// Subtrees of at most this many references are one piece of work.
pub(super) const PIECE: usize = 1 << 12;

/// Part of the finished tree.
pub(super) enum Part {
    /// A whole subtree: its root and the nodes below, with indices relative to the latter.
    Whole { root: Node, below: Vec<Node> },
    /// An inner node and its children.
    Fork { bounds: Bounds, children: Box<[Part; 2]> },
}

impl Part {
    /// Assembles all nodes in one array, the root first.
    pub(super) fn assemble(self) -> Vec<Node> {
        let mut nodes = Vec::with_capacity(1 + self.len_below());
        let blank = Node { min: glam::Vec3::ZERO, first: 0, max: glam::Vec3::ZERO, count: 0 };
        nodes.push(blank);
        self.place(0, &mut nodes);
        nodes
    }

    /// Returns the bounds of the part's root.
    pub(super) fn bounds(&self) -> Bounds {
        match self {
            Self::Whole { root, .. } => Bounds::from_aabb(root.bounds()),
            Self::Fork { bounds, .. } => *bounds,
        }
    }

    /// Returns the number of nodes below the part's root.
    fn len_below(&self) -> usize {
        match self {
            Self::Whole { below, .. } => below.len(),
            Self::Fork { children, .. } => children.iter().map(|child| 1 + child.len_below()).sum(),
        }
    }

    /// Writes the part's root to `nodes[slot]` and appends the rest; frees the part meanwhile.
    fn place(self, slot: usize, nodes: &mut Vec<Node>) {
        let base = nodes.len() as u32;
        match self {
            Self::Whole { root, below } => {
                nodes[slot] = rebased(root, base);
                nodes.extend(below.into_iter().map(|node| rebased(node, base)));
            }
            Self::Fork { bounds, children } => {
                let bounds = bounds.to_aabb();
                nodes[slot] = Node::inner(bounds, base);
                nodes.extend([Node::inner(bounds, 0); 2]);
                for (slot, child) in (base as usize..).zip(*children) {
                    child.place(slot, nodes);
                }
            }
        }
    }
}

/// Offsets the child index of a node by `base`.
fn rebased(mut node: Node, base: u32) -> Node {
    if !node.is_leaf() {
        node.first += base;
    }
    node
}
