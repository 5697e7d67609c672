//! The recursion of the surface area heuristic: from a range of references to nodes.

use super::binned_sah::{Bins, Grid};
use super::config::BuildConfig;
use super::part::{PIECE, Part};
use super::reference::{Reference, Span};
use super::{depth, partition, tasks};
use crate::bvh::Node;

/// Builds the tree over all `references`, which are put in the order of the leaves.
pub(super) fn grow(references: &mut [Reference], span: Span, config: &BuildConfig) -> Part {
    let budget = depth::budget(references.len());
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
    if !depth::allows(budget, left_count as usize, right_count as usize) {
        return Some(partition::by_median(references, &span.centroids));
    }
    let (middle, [left_centroids, right_centroids]) =
        partition::by_plane(references, &grid, &plane);
    debug_assert_eq!(middle, left_count as usize);
    let left = Span { bounds: left, centroids: left_centroids };
    let right = Span { bounds: right, centroids: right_centroids };
    Some((middle, [left, right]))
}
