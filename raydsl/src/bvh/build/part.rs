//! Subtrees built separately, and their assembly into one tree.
//!
//! Subtrees are built independently into arrays of their own, with node indices relative to the
//! array, and assembled at the end. Below a certain size a subtree is one piece of work and one
//! array; that size changes the distribution of work but not the result.

use super::reference::Bounds;
use super::tasks;
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
        // Zeros come from the system page by page, to the threads that write there.
        let mut nodes: Vec<Node> = bytemuck::zeroed_vec(1 + self.len_below());
        let (root, below) = nodes.split_at_mut(1);
        root[0] = self.place(1, below);
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

    /// Writes the nodes below the part's root, the first of which has the number `base`, to `nodes`;
    /// returns the root. Frees the part meanwhile.
    fn place(self, base: u32, nodes: &mut [Node]) -> Node {
        match self {
            Self::Whole { root, below } => {
                for (place, node) in nodes.iter_mut().zip(below) {
                    *place = rebased(node, base);
                }
                rebased(root, base)
            }
            Self::Fork { bounds, children } => {
                let [left, right] = *children;
                let (pair, below) = nodes.split_at_mut(2);
                let (of_left, of_right) = below.split_at_mut(left.len_below());
                let first = base + 2;
                let second = first + of_left.len() as u32;
                (pair[0], pair[1]) =
                    tasks::join(|| left.place(first, of_left), || right.place(second, of_right));
                Node::inner(bounds.to_aabb(), base)
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
