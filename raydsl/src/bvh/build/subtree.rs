//! The recursion: from a range of references to nodes.
//!
//! # Depth
//!
//! A node's *budget* is the number of levels that may follow below it. The root of `n` references
//! has `2 ceil(log2 n) + 8` or [`MAX_DEPTH`], whichever is less. That is well above what any
//! ordinary scene needs (about `1.6 log2 n`), and since a level takes time proportional to the
//! number of references in it, it bounds the time for hostile inputs as well as the depth.
//!
//! Every node of `n` references has `ceil(log2 n) <= budget`:
//!
//! * the root, as `n <= 2^30` and `30 <= 62`;
//! * both children of a split of which the larger half `m` has `ceil(log2 m) <= budget - 1`; a
//!   split by a plane is only made when that holds;
//! * otherwise the range is halved, and `ceil(log2 ceil(n / 2)) = ceil(log2 n) - 1 <= budget - 1`
//!   for every `n >= 2`.
//!
//! A node with budget 0 thus has one reference and is a leaf. Hence no leaf is deeper than the
//! root's budget, and neither is the recursion.
//!
//! # Order
//!
//! Subtrees are built independently of each other into arrays of their own, in which indices of
//! nodes are relative to the array's beginning, and put together when all are done. Below a
//! certain size a subtree is one piece of work and one array; that size changes who does the work
//! but not the result.

use super::binned_sah::{Bins, Grid};
use super::config::BuildConfig;
use super::partition;
use super::reference::{Bounds, Reference, Span};
use super::{MAX_DEPTH, tasks};
use crate::bvh::Node;

/// Subtrees of at most this many references are one piece of work.
const PIECE: usize = 1 << 12;

/// A part of the finished tree.
pub(super) enum Part {
    /// A whole subtree: its root and the nodes below, relative to their own beginning.
    Whole { root: Node, below: Vec<Node> },
    /// An inner node and its children.
    Fork { bounds: Bounds, children: Box<[Part; 2]> },
}

/// Builds the tree over all `references`, which are put in the order of the leaves.
pub(super) fn grow(references: &mut [Reference], span: Span, config: &BuildConfig) -> Part {
    let budget = (2 * levels(references.len() as u32) + 8).min(MAX_DEPTH as u32);
    grow_part(Range { references, first: 0, span, budget }, config)
}

/// What becomes a subtree.
struct Range<'a> {
    references: &'a mut [Reference],
    /// The position of the first of them among all.
    first: u32,
    span: Span,
    /// How many levels there may be below.
    budget: u32,
}

fn grow_part(range: Range, config: &BuildConfig) -> Part {
    if range.references.len() <= PIECE {
        let mut subtree = Subtree { config, bins: Bins::new(), nodes: Vec::new() };
        subtree.nodes.reserve_exact(2 * range.references.len());
        let root = subtree.grow(range);
        subtree.nodes.shrink_to_fit();
        return Part::Whole { root, below: subtree.nodes };
    }
    let bounds = range.span.bounds;
    match split(range, &mut Bins::new(), config) {
        Ok([left, right]) => {
            let (left, right) =
                tasks::join(|| grow_part(left, config), || grow_part(right, config));
            Part::Fork { bounds, children: Box::new([left, right]) }
        }
        Err(leaf) => Part::Whole { root: leaf, below: Vec::new() },
    }
}

/// A subtree in the making.
struct Subtree<'a> {
    config: &'a BuildConfig,
    bins: Bins,
    nodes: Vec<Node>,
}

impl Subtree<'_> {
    /// Appends the nodes below the range's own, which is returned.
    fn grow(&mut self, range: Range) -> Node {
        let bounds = range.span.bounds.to_aabb();
        match split(range, &mut self.bins, self.config) {
            Ok(children) => {
                let first = self.nodes.len();
                // Room for the children: what is below them comes after both.
                self.nodes.extend([Node::inner(bounds, 0); 2]);
                for (k, child) in children.into_iter().enumerate() {
                    self.nodes[first + k] = self.grow(child);
                }
                Node::inner(bounds, first as u32)
            }
            Err(leaf) => leaf,
        }
    }
}

/// The two children of a node, or the leaf that it is.
fn split<'a>(
    range: Range<'a>,
    bins: &mut Bins,
    config: &BuildConfig,
) -> Result<[Range<'a>; 2], Node> {
    let Range { references, first, span, budget } = range;
    let Some((middle, [left, right])) = divide(references, &span, budget, bins, config) else {
        return Err(Node::leaf(span.bounds.to_aabb(), first, references.len() as u32));
    };
    let (before, after) = references.split_at_mut(middle);
    let budget = budget - 1;
    Ok([
        Range { references: before, first, span: left, budget },
        Range { references: after, first: first + middle as u32, span: right, budget },
    ])
}

/// Orders the references in two parts; returns the length of the first and the boxes of both,
/// or `None` when they are to be a leaf.
fn divide(
    references: &mut [Reference],
    span: &Span,
    budget: u32,
    bins: &mut Bins,
    config: &BuildConfig,
) -> Option<(usize, [Span; 2])> {
    let count = references.len();
    if count == 1 {
        return None;
    }
    let may_be_leaf = count <= config.max_leaf_size as usize;
    let Some(grid) = Grid::new(span, count, config.bins) else {
        return if may_be_leaf { None } else { Some(partition::by_order(references)) };
    };
    bins.fill(references, &grid);
    let Some(plane) = bins.best_plane(&grid) else {
        return Some(partition::by_order(references));
    };
    if may_be_leaf && !plane.pays(span, count, &grid, config) {
        return None;
    }
    let [(left, left_count), (right, right_count)] = bins.sides(&plane, &grid);
    if levels(left_count.max(right_count)) >= budget {
        return Some(partition::by_median(references, &span.centroids));
    }
    let (middle, [left_centroids, right_centroids]) =
        partition::by_plane(references, &grid, &plane);
    debug_assert_eq!(middle, left_count as usize);
    let left = Span { bounds: left, centroids: left_centroids };
    let right = Span { bounds: right, centroids: right_centroids };
    Some((middle, [left, right]))
}

/// `ceil(log2 count)`: the levels below a node of `count > 0` references that is halved until
/// there is one in each leaf.
fn levels(count: u32) -> u32 {
    u32::BITS - (count - 1).leading_zeros()
}

impl Part {
    /// All nodes in one array, the root first.
    pub(super) fn assemble(self) -> Vec<Node> {
        let mut nodes = Vec::with_capacity(1 + self.len_below());
        let blank = Node { min: glam::Vec3::ZERO, first: 0, max: glam::Vec3::ZERO, count: 0 };
        nodes.push(blank);
        self.place(0, &mut nodes);
        nodes
    }

    /// How many nodes there are below the part's root.
    fn len_below(&self) -> usize {
        match self {
            Self::Whole { below, .. } => below.len(),
            Self::Fork { children, .. } => children.iter().map(|child| 1 + child.len_below()).sum(),
        }
    }

    /// Writes the part's root to `nodes[slot]` and appends the rest; frees the part on the way.
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

/// The node with the indices of its children counted from `base`.
fn rebased(mut node: Node, base: u32) -> Node {
    if !node.is_leaf() {
        node.first += base;
    }
    node
}
