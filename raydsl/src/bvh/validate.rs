//! Whether a tree is one.

use thiserror::Error;

use super::{Bvh, MAX_DEPTH, Node};
use crate::geometry::{Aabb, Primitive};

/// What is wrong with a tree; [`validate`] looks for it.
///
/// A tree that the library built has none of these, unless primitives whose boxes come from cells
/// or globals have changed since.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum TreeFault {
    /// The children of an inner node are not all among the nodes.
    #[error("node {node}: the children {first} and the one behind are not among {nodes} nodes")]
    ChildOutOfRange {
        /// The inner node.
        node: usize,
        /// Its left child.
        first: usize,
        /// How many nodes there are.
        nodes: usize,
    },
    /// A child does not come after its parent: it may be its own ancestor.
    #[error("node {node}: its child {child} does not come after it")]
    ChildBeforeParent {
        /// The inner node.
        node: usize,
        /// The child.
        child: usize,
    },
    /// A node is the child of two nodes.
    #[error("node {node}: its child {child} is another node's, too")]
    SharedChild {
        /// The second of the parents.
        node: usize,
        /// The child.
        child: usize,
    },
    /// A node is no one's child, and not the root.
    #[error("node {node} is not below the root")]
    Unreachable {
        /// The node.
        node: usize,
    },
    /// A node is too far from the root for the stack of a traversal.
    #[error("node {node} is {depth} steps from the root: {MAX_DEPTH} are allowed")]
    TooDeep {
        /// The node.
        node: usize,
        /// Its distance from the root.
        depth: usize,
    },
    /// A bound of a box is NaN, infinite, or the lower one is above the upper one.
    #[error("node {node}: its box is not finite, or min > max")]
    InvalidBox {
        /// The node.
        node: usize,
    },
    /// A box does not hold that of a child.
    #[error("node {node}: its box does not hold that of its child {child}")]
    ChildOutside {
        /// The inner node.
        node: usize,
        /// The child.
        child: usize,
    },
    /// A box does not hold that of a primitive.
    #[error("node {node}: its box does not hold that of primitive {primitive}")]
    PrimitiveOutside {
        /// The leaf.
        node: usize,
        /// The primitive.
        primitive: usize,
    },
    /// The entries of a leaf are not all in the index list.
    #[error("node {node}: {count} entries from {first} on are not all in the list of {entries}")]
    EntryOutOfRange {
        /// The leaf.
        node: usize,
        /// Its first entry.
        first: usize,
        /// How many entries it has.
        count: usize,
        /// How many entries the list has.
        entries: usize,
    },
    /// An entry of a leaf is no primitive.
    #[error("node {node}: there is no primitive {primitive}, only {primitives}")]
    NoSuchPrimitive {
        /// The leaf.
        node: usize,
        /// The number in the entry.
        primitive: usize,
        /// How many primitives there are.
        primitives: usize,
    },
    /// A primitive is in no leaf: no ray would meet it.
    #[error("primitive {primitive} is in no leaf")]
    Missing {
        /// The primitive.
        primitive: usize,
    },
}

/// Checks that a tree is one, for tests and for tracking down a fault: that every primitive is in a
/// leaf, every index in its range, every node but the root the child of one that comes before it, no
/// leaf deeper than [`MAX_DEPTH`], and that every box holds the boxes below it and those of its
/// primitives.
///
/// Takes one pass over the nodes, two bytes a node, and asks for the bounds of all primitives.
///
/// ```
/// use raydsl::prelude::*;
///
/// let triangle = |z| Triangle { v0: vec3(0.0, 0.0, z), v1: vec3(4.0, 0.0, z), v2: vec3(0.0, 4.0, z) };
/// let triangles: Vec<_> = (0..100).map(|z| triangle(z as f32)).collect();
/// raydsl::bvh::validate(&Bvh::build(&triangles)?)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// The first fault, in the order of the nodes.
pub fn validate<P: Primitive>(bvh: &Bvh<'_, P>) -> Result<(), TreeFault> {
    let (prims, shared) = (bvh.primitives(), bvh.shared());
    check(bvh.nodes(), bvh.indices(), prims.len(), |k| prims[k].get_bounds(shared))
}

/// [`validate`], for the parts of a tree over `count` primitives with these bounds.
pub(super) fn check(
    nodes: &[Node],
    indices: &[u32],
    count: usize,
    bounds: impl Fn(usize) -> Aabb,
) -> Result<(), TreeFault> {
    let mut walk = Walk {
        nodes,
        indices,
        bounds,
        depths: vec![None; nodes.len()],
        is_in_leaf: vec![false; count],
    };
    if let Some(root) = walk.depths.first_mut() {
        *root = Some(0);
    }
    // No stack: whoever is visited has told its children, which come after it, how deep they are.
    for node in 0..nodes.len() {
        walk.visit(node)?;
    }
    match walk.is_in_leaf.iter().position(|is_in_leaf| !is_in_leaf) {
        Some(primitive) => Err(TreeFault::Missing { primitive }),
        None => Ok(()),
    }
}

/// A walk over all nodes, one after another.
struct Walk<'a, B> {
    nodes: &'a [Node],
    indices: &'a [u32],
    bounds: B,
    /// How deep those nodes are of which a parent has been visited.
    depths: Vec<Option<u8>>,
    is_in_leaf: Vec<bool>,
}

impl<B: Fn(usize) -> Aabb> Walk<'_, B> {
    fn visit(&mut self, node: usize) -> Result<(), TreeFault> {
        let depth = self.depths[node].ok_or(TreeFault::Unreachable { node })?;
        if usize::from(depth) > MAX_DEPTH {
            return Err(TreeFault::TooDeep { node, depth: depth.into() });
        }
        let bounds = self.nodes[node].bounds();
        if !bounds.is_valid() || !bounds.is_finite() {
            return Err(TreeFault::InvalidBox { node });
        }
        if self.nodes[node].is_leaf() {
            self.visit_primitives(node)
        } else {
            self.visit_children(node, depth + 1)
        }
    }

    fn visit_children(&mut self, node: usize, depth: u8) -> Result<(), TreeFault> {
        let (first, nodes) = (self.nodes[node].first as usize, self.nodes.len());
        if first >= nodes - 1 {
            return Err(TreeFault::ChildOutOfRange { node, first, nodes });
        }
        for child in [first, first + 1] {
            if child <= node {
                return Err(TreeFault::ChildBeforeParent { node, child });
            }
            if self.depths[child].replace(depth).is_some() {
                return Err(TreeFault::SharedChild { node, child });
            }
            if !holds(&self.nodes[node], self.nodes[child].bounds()) {
                return Err(TreeFault::ChildOutside { node, child });
            }
        }
        Ok(())
    }

    fn visit_primitives(&mut self, node: usize) -> Result<(), TreeFault> {
        let Node { first, count, .. } = self.nodes[node];
        let (first, count) = (first as usize, count as usize);
        let (entries, primitives) = (self.indices.len(), self.is_in_leaf.len());
        let Some(leaf) = self.indices.get(first..).and_then(|rest| rest.get(..count)) else {
            return Err(TreeFault::EntryOutOfRange { node, first, count, entries });
        };
        for primitive in leaf.iter().map(|&index| index as usize) {
            if primitive >= primitives {
                return Err(TreeFault::NoSuchPrimitive { node, primitive, primitives });
            }
            self.is_in_leaf[primitive] = true;
            if !holds(&self.nodes[node], (self.bounds)(primitive)) {
                return Err(TreeFault::PrimitiveOutside { node, primitive });
            }
        }
        Ok(())
    }
}

/// Whether a node's box holds another; none holds one with a NaN.
fn holds(node: &Node, inner: Aabb) -> bool {
    let outer = node.bounds();
    outer.min.cmple(inner.min).all() && inner.max.cmple(outer.max).all()
}
