//! Recursive binned-SAH build: from a range of references to nodes.

use super::binned_sah::{Bins, Grid};
use super::config::Settings;
use super::part::{PIECE, Part};
use super::reference::{Reference, Span};
use super::watch::Watch;
use super::{depth, partition, tasks};
use crate::bvh::Node;

/// Builds the tree over all `references`, and puts them in leaf order.
pub(super) fn grow(
    references: &mut [Reference],
    span: Span,
    config: &Settings,
    watch: &Watch,
) -> Part {
    let budget = depth::budget(references.len());
    grow_part(Range { references, first: 0, span, budget }, config, watch)
}

/// Range of references that becomes a subtree.
struct Range<'a> {
    references: &'a mut [Reference],
    /// Position of the first reference in the whole list.
    first: u32,
    span: Span,
    /// Number of levels allowed below.
    budget: u32,
}

fn grow_part(range: Range, config: &Settings, watch: &Watch) -> Part {
    let count = range.references.len();
    if watch.is_stopped() {
        let root = Node::leaf(range.span.bounds.to_aabb(), range.first, count as u32);
        return Part::Whole { root, below: Vec::new() };
    }
    if count <= PIECE {
        let mut subtree = Subtree { config, watch, bins: Bins::new(), nodes: Vec::new() };
        subtree.nodes.reserve_exact(2 * count);
        let root = subtree.grow(range);
        subtree.nodes.shrink_to_fit();
        watch.advance(count);
        return Part::Whole { root, below: subtree.nodes };
    }
    let bounds = range.span.bounds;
    match split(range, &mut Bins::new(), config, watch) {
        Ok([left, right]) => {
            let (left, right) =
                tasks::join(|| grow_part(left, config, watch), || grow_part(right, config, watch));
            Part::Fork { bounds, children: Box::new([left, right]) }
        }
        Err(leaf) => Part::Whole { root: leaf, below: Vec::new() },
    }
}

/// Subtree under construction.
struct Subtree<'a, 'w> {
    config: &'a Settings,
    watch: &'a Watch<'w>,
    bins: Bins,
    nodes: Vec<Node>,
}

impl Subtree<'_, '_> {
    /// Appends the nodes below the root of a range; returns the root.
    fn grow(&mut self, range: Range) -> Node {
        let bounds = range.span.bounds.to_aabb();
        match split(range, &mut self.bins, self.config, self.watch) {
            Ok(children) => {
                let first = self.nodes.len();
                // Reserve the children: their descendants come after both.
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

/// Splits a node into its two children; the error is a leaf, if it becomes one.
fn split<'a>(
    range: Range<'a>,
    bins: &mut Bins,
    config: &Settings,
    watch: &Watch,
) -> Result<[Range<'a>; 2], Node> {
    let Range { references, first, span, budget } = range;
    let Some((middle, [left, right])) = divide(references, &span, budget, bins, (config, watch))
    else {
        return Err(Node::leaf(span.bounds.to_aabb(), first, references.len() as u32));
    };
    let (before, after) = references.split_at_mut(middle);
    let budget = budget - 1;
    Ok([
        Range { references: before, first, span: left, budget },
        Range { references: after, first: first + middle as u32, span: right, budget },
    ])
}

/// Partitions the references in two; returns the length of the first part and the spans of both, or
/// `None` for a leaf.
fn divide(
    references: &mut [Reference],
    span: &Span,
    budget: u32,
    bins: &mut Bins,
    (config, watch): (&Settings, &Watch),
) -> Option<(usize, [Span; 2])> {
    let count = references.len();
    if count == 1 || config.is_block(count) {
        return None;
    }
    let may_be_leaf = count <= config.leaf_size();
    let Some(grid) = Grid::new(span, count, config) else {
        return if may_be_leaf { None } else { Some(partition::by_order(references)) };
    };
    bins.fill(references, &grid);
    let Some(plane) = bins.best_plane(&grid) else {
        return Some(partition::by_order(references));
    };
    if may_be_leaf && !grid.pays(plane.cost(), span, count) {
        return None;
    }
    let [(left, left_count), (right, right_count)] = bins.sides(&plane, &grid);
    if !depth::allows(budget, left_count as usize, right_count as usize) {
        return Some(partition::by_median(references, &span.centroids));
    }
    let (middle, [left_centroids, right_centroids]) =
        partition::by_plane(references, &grid, &plane, watch);
    if middle != left_count as usize {
        // Cancelled half way: the tree is thrown away.
        return None;
    }
    let left = Span { bounds: left, centroids: left_centroids };
    let right = Span { bounds: right, centroids: right_centroids };
    Some((middle, [left, right]))
}
