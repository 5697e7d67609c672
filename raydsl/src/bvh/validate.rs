//! Whether a tree is one.

use thiserror::Error;

use super::build::{Primitives, Source};
use super::coverage::is_covered;
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
    /// A primitive is in a leaf twice: rays would be tested twice.
    #[error("node {node}: primitive {primitive} is in it twice")]
    Repeated {
        /// The leaf.
        node: usize,
        /// The primitive.
        primitive: usize,
    },
    /// A primitive is in several leaves, as parts, and a part is in none.
    #[error(
        "the boxes of the leaves that hold parts of primitive {primitive} leave out some of it"
    )]
    PartMissing {
        /// The primitive.
        primitive: usize,
    },
    /// A primitive is in no leaf: no ray would meet it.
    #[error("primitive {primitive} is in no leaf")]
    Missing {
        /// The primitive.
        primitive: usize,
    },
}

/// Checks that a tree is one, for tests and for tracking down a fault: that every primitive is in a
/// leaf, every index in its range, every node but the root the child of one that comes before it,
/// no leaf deeper than [`MAX_DEPTH`], no primitive twice in a leaf, and that every box holds the
/// boxes below it and those of its primitives.
///
/// Where a primitive is in several leaves ([`BuildQuality::Best`](super::BuildQuality::Best)), each
/// may hold a part of it. Then it is checked along each axis that no part is left out, as far as
/// [`Primitive::split_primitive`] tells.
///
/// Takes one pass over the nodes, two bytes a node, and asks for the bounds of all primitives. Of a
/// wide tree the binary one is made for it, as for [`Bvh::statistics`].
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
/// The first fault, in the order of the nodes; primitives that are not, or not all, in leaves come
/// last.
pub fn validate<P: Primitive>(bvh: &Bvh<'_, P>) -> Result<(), TreeFault> {
    let source = Primitives { prims: bvh.primitives(), shared: bvh.shared() };
    let tree = bvh.tree.own.structure.peek();
    check(&tree.nodes, &tree.indices, bvh.primitives().len(), &source)
}

/// [`validate`], for the parts of a tree over `count` primitives.
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
    // No stack: whoever is visited has told its children, which come after it, how deep they are.
    for node in 0..nodes.len() {
        walk.visit(node)?;
    }
    if let Some(primitive) = walk.found.iter().position(|found| found.leaf.is_none()) {
        return Err(TreeFault::Missing { primitive });
    }
    walk.visit_parts()
}

/// Where a primitive was found.
#[derive(Clone, Copy, Default)]
struct Found {
    /// The last leaf that has it.
    leaf: Option<u32>,
    /// Whether another one has it, too.
    is_in_others: bool,
    /// Whether a leaf's box holds all of it.
    is_whole: bool,
}

/// A walk over all nodes, one after another.
struct Walk<'a> {
    nodes: &'a [Node],
    indices: &'a [u32],
    source: &'a dyn Source,
    /// How deep those nodes are of which a parent has been visited.
    depths: Vec<Option<u8>>,
    found: Vec<Found>,
    /// Primitives, and leaves that do not hold all of them.
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

    /// Looks at the primitives of which a leaf does not hold all. With one leaf alone that is a
    /// fault; several may have a part each.
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

/// Whether a node's box holds another; none holds one with a NaN.
fn holds(node: &Node, inner: Aabb) -> bool {
    let outer = node.bounds();
    outer.min.cmple(inner.min).all() && inner.max.cmple(outer.max).all()
}
