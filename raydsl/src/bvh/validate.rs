//! Validation of tree structure.

use thiserror::Error;

use super::build::{Primitives, Source};
use super::coverage::is_covered;
use super::{Bvh, MAX_DEPTH, Node};
use crate::geometry::{Aabb, Primitive};

/// Fault in a tree, found by [`validate`].
///
/// A tree built by the library has none of these, unless primitives whose boxes come from cells or
/// globals have changed since.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum TreeFault {
    /// The children of an inner node are not all among the nodes.
    #[error("node {node}: the children {first} and the one behind are not among {nodes} nodes")]
    ChildOutOfRange {
        /// Index of the inner node.
        node: usize,
        /// Index of its left child.
        first: usize,
        /// Number of nodes.
        nodes: usize,
    },
    /// A child does not come after its parent: it may be its own ancestor.
    #[error("node {node}: its child {child} does not come after it")]
    ChildBeforeParent {
        /// Index of the inner node.
        node: usize,
        /// Index of the child.
        child: usize,
    },
    /// A node is the child of two nodes.
    #[error("node {node}: its child {child} is another node's, too")]
    SharedChild {
        /// Index of the second parent.
        node: usize,
        /// Index of the child.
        child: usize,
    },
    /// A node has no parent, and is not the root.
    #[error("node {node} is not below the root")]
    Unreachable {
        /// Index of the node.
        node: usize,
    },
    /// A node is too far from the root for the traversal stack.
    #[error("node {node} is {depth} steps from the root: {MAX_DEPTH} are allowed")]
    TooDeep {
        /// Index of the node.
        node: usize,
        /// Its distance from the root.
        depth: usize,
    },
    /// A bound of a box is NaN or infinite, or the lower one is above the upper one.
    #[error("node {node}: its box is not finite, or min > max")]
    InvalidBox {
        /// Index of the node.
        node: usize,
    },
    /// A node's box does not contain that of a child.
    #[error("node {node}: its box does not hold that of its child {child}")]
    ChildOutside {
        /// Index of the inner node.
        node: usize,
        /// Index of the child.
        child: usize,
    },
    /// A leaf's box does not contain that of a primitive.
    #[error("node {node}: its box does not hold that of primitive {primitive}")]
    PrimitiveOutside {
        /// Index of the leaf.
        node: usize,
        /// The primitive id.
        primitive: usize,
    },
    /// The entries of a leaf are not all in the index list.
    #[error("node {node}: {count} entries from {first} on are not all in the list of {entries}")]
    EntryOutOfRange {
        /// Index of the leaf.
        node: usize,
        /// Its first entry.
        first: usize,
        /// Number of its entries.
        count: usize,
        /// Number of entries in the list.
        entries: usize,
    },
    /// An entry of a leaf is not a valid primitive id.
    #[error("node {node}: there is no primitive {primitive}, only {primitives}")]
    NoSuchPrimitive {
        /// Index of the leaf.
        node: usize,
        /// The id in the entry.
        primitive: usize,
        /// Number of primitives.
        primitives: usize,
    },
    /// A primitive is in a leaf twice: it would be intersected twice.
    #[error("node {node}: primitive {primitive} is in it twice")]
    Repeated {
        /// Index of the leaf.
        node: usize,
        /// The primitive id.
        primitive: usize,
    },
    /// A primitive is in several leaves, as parts, and a part is in none.
    #[error(
        "the boxes of the leaves that hold parts of primitive {primitive} leave out some of it"
    )]
    PartMissing {
        /// The primitive id.
        primitive: usize,
    },
    /// A primitive is in no leaf: no ray would hit it.
    #[error("primitive {primitive} is in no leaf")]
    Missing {
        /// The primitive id.
        primitive: usize,
    },
}

/// Validates the structure of a tree, for tests and for tracking down a fault: every primitive is
/// in a leaf, every index in its range, every node but the root the child of one that comes before
/// it, no leaf deeper than [`MAX_DEPTH`], no primitive twice in a leaf, and every box contains the
/// boxes below it and those of its primitives.
///
/// Where a primitive is in several leaves ([`BuildQuality::Best`](super::BuildQuality::Best)), each
/// may hold a part of it. Then each axis is checked for missing parts, as far as
/// [`Primitive::split_primitive`] tells.
///
/// Takes one pass over the nodes, two bytes a node, and computes the bounds of all primitives. For
/// a wide tree the binary one is made, as for [`Bvh::statistics`].
///
/// ```
/// use raydsl::prelude::*;
///
/// let v = vec3;
/// let triangle = |z| Triangle { v0: v(0.0, 0.0, z), v1: v(4.0, 0.0, z), v2: v(0.0, 4.0, z) };
/// let triangles: Vec<_> = (0..100).map(|z| triangle(z as f32)).collect();
/// raydsl::bvh::validate(&Bvh::build(&triangles)?)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// The first fault, in the order of the nodes; primitives missing from leaves, in whole or in part,
/// come last.
pub fn validate<P: Primitive>(bvh: &Bvh<'_, P>) -> Result<(), TreeFault> {
    let source = Primitives { prims: bvh.primitives(), shared: bvh.shared() };
    let tree = bvh.tree.own.structure.peek();
    check(&tree.nodes, &tree.indices, bvh.primitives().len(), &source)
}

/// Validates the arrays of a tree over `count` primitives, as [`validate`] does.
pub(super) fn check(
    nodes: &[Node],
    indices: &[u32],
    count: usize,
    source: &dyn Source,
) -> Result<(), TreeFault> {
    let mut walk = Walk {
        nodes,
        indices,
        source,
        depths: vec![None; nodes.len()],
        found: vec![Found::default(); count],
        parts: Vec::new(),
    };
    if let Some(root) = walk.depths.first_mut() {
        *root = Some(0);
    }
    // No stack: a visited node has set the depth of its children, which come after it.
    for node in 0..nodes.len() {
        walk.visit(node)?;
    }
    if let Some(primitive) = walk.found.iter().position(|found| found.leaf.is_none()) {
        return Err(TreeFault::Missing { primitive });
    }
    walk.visit_parts()
}

/// Leaves in which a primitive was found.
#[derive(Clone, Copy, Default)]
struct Found {
    /// The last leaf with the primitive.
    leaf: Option<u32>,
    /// Whether another leaf has it, too.
    is_in_others: bool,
    /// Whether a leaf's box contains all of it.
    is_whole: bool,
}

/// Pass over all nodes in order.
struct Walk<'a> {
    nodes: &'a [Node],
    indices: &'a [u32],
    source: &'a dyn Source,
    /// Depths of the nodes with a visited parent.
    depths: Vec<Option<u8>>,
    found: Vec<Found>,
    /// Primitives, each with a leaf that does not contain all of it.
    parts: Vec<(u32, u32)>,
}

impl Walk<'_> {
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
        let (entries, primitives) = (self.indices.len(), self.found.len());
        let Some(leaf) = self.indices.get(first..).and_then(|rest| rest.get(..count)) else {
            return Err(TreeFault::EntryOutOfRange { node, first, count, entries });
        };
        for &index in leaf {
            let primitive = index as usize;
            if primitive >= primitives {
                return Err(TreeFault::NoSuchPrimitive { node, primitive, primitives });
            }
            let found = &mut self.found[primitive];
            let before = found.leaf.replace(node as u32);
            if before == found.leaf {
                return Err(TreeFault::Repeated { node, primitive });
            }
            found.is_in_others |= before.is_some();
            if holds(&self.nodes[node], self.source.bounds(primitive)) {
                found.is_whole = true;
            } else {
                self.parts.push((index, node as u32));
            }
        }
        Ok(())
    }

    /// Checks the primitives that some leaf does not wholly contain. With a single leaf that is a
    /// fault; several may contain a part each.
    fn visit_parts(&mut self) -> Result<(), TreeFault> {
        self.parts.sort_unstable();
        for parts in self.parts.chunk_by(|a, b| a.0 == b.0) {
            let (primitive, node) = (parts[0].0 as usize, parts[0].1 as usize);
            let found = self.found[primitive];
            if found.is_whole {
                continue;
            }
            if !found.is_in_others || !self.source.bounds(primitive).is_finite() {
                return Err(TreeFault::PrimitiveOutside { node, primitive });
            }
            let boxes = parts.iter().map(|part| self.nodes[part.1 as usize].bounds());
            if !is_covered(self.source, primitive, &mut boxes.collect::<Vec<_>>()) {
                return Err(TreeFault::PartMissing { primitive });
            }
        }
        Ok(())
    }
}

/// Returns whether a node's box contains another; none contains one with a NaN.
fn holds(node: &Node, inner: Aabb) -> bool {
    let outer = node.bounds();
    outer.min.cmple(inner.min).all() && inner.max.cmple(outer.max).all()
}
