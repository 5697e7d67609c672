//! The hierarchy of the Morton order: [`BuildQuality::Fast`](super::BuildQuality::Fast).
//!
//! After Lauterbach, Garland, Sengupta, Luebke and Manocha, *Fast BVH construction on GPUs*
//! (Computer Graphics Forum 28(2), 2009), section 3: primitives sorted by their [Morton
//! codes](super::morton) are split where the highest bit changes that is not the same for all of
//! them, which a binary search finds, as in section 4 of Karras, *Maximizing parallelism in the
//! construction of BVHs, octrees, and k-d trees* (High Performance Graphics, 2012). Boxes are
//! taken on the way back up, and so is the decision of the surface area heuristic whether few
//! enough primitives are better off in one leaf.
//!
//! # What bits do not tell apart
//!
//! A primitive far away makes the cells so large that all others may fall into one. Primitives of
//! one code are therefore coded again, within the cube around themselves. That happens once on a
//! way from the root to a leaf, which gives 42 bits an axis and at most doubles the time. What has
//! one code after that is halved by index.
//!
//! # Depth
//!
//! 63 bits twice, and up to 30 halvings where the bits end, make up to 156 levels. The budget of
//! [`depth`] forbids that: a split that would leave the larger side too many primitives for the
//! levels that remain is a split in halves instead, in the order that the primitives have.

use super::config::BuildConfig;
use super::morton::{self, Key};
use super::part::{PIECE, Part};
use super::reference::{Bounds, Reference, Span};
use super::{depth, tasks};
use crate::bvh::Node;

/// Builds the tree over all `references`; also returns their indices in the order of the leaves.
pub(super) fn grow(
    references: &[Reference],
    span: &Span,
    config: &BuildConfig,
) -> (Part, Vec<u32>) {
    let mut keys = morton::keys(references, &span.centroids);
    let budget = depth::budget(references.len());
    let range = Range { keys: &mut keys, first: 0, budget, is_recoded: false };
    let part = grow_part(range, references, config);
    (part, keys.into_iter().map(|key| key.index).collect())
}

/// What becomes a subtree.
struct Range<'a> {
    /// In order.
    keys: &'a mut [Key],
    /// The position of the first of them among all.
    first: u32,
    /// How many levels there may be below.
    budget: u32,
    /// Whether their codes are those within a smaller cube.
    is_recoded: bool,
}

fn grow_part(range: Range, references: &[Reference], config: &BuildConfig) -> Part {
    if range.keys.len() <= PIECE {
        let nodes = Vec::with_capacity(2 * range.keys.len());
        let mut subtree = Subtree { references, config, nodes };
        let root = subtree.grow(range).node;
        subtree.nodes.shrink_to_fit();
        return Part::Whole { root, below: subtree.nodes };
    }
    let [left, right] = split(range, references, config);
    let (left, right) = tasks::join(
        || grow_part(left, references, config),
        || grow_part(right, references, config),
    );
    Part::Fork { bounds: left.bounds().union(right.bounds()), children: Box::new([left, right]) }
}

/// A subtree in the making.
struct Subtree<'a> {
    references: &'a [Reference],
    config: &'a BuildConfig,
    nodes: Vec<Node>,
}

/// The root of a subtree.
struct Grown {
    node: Node,
    bounds: Bounds,
    /// The expected cost of what is in it, as in `BuildConfig`, times its area.
    cost: f64,
}

impl Subtree<'_> {
    /// Appends the nodes below the range's own, which is returned.
    fn grow(&mut self, range: Range) -> Grown {
        let (first, count) = (range.first, range.keys.len() as u32);
        if let [key] = range.keys {
            let bounds = self.references[key.index as usize].bounds();
            return self.leaf(bounds, first, count);
        }
        let children = split(range, self.references, self.config);
        let below = self.nodes.len();
        // Room for the children: what is below them comes after both.
        self.nodes.extend([Node::inner(Bounds::EMPTY.to_aabb(), 0); 2]);
        let [left, right] = children.map(|child| self.grow(child));
        let bounds = left.bounds.union(right.bounds);
        let cost = f64::from(self.config.traversal_cost) * area(bounds) + left.cost + right.cost;
        if count <= self.config.max_leaf_size {
            let leaf = self.leaf(bounds, first, count);
            if leaf.cost <= cost {
                self.nodes.truncate(below);
                return leaf;
            }
        }
        self.nodes[below] = left.node;
        self.nodes[below + 1] = right.node;
        Grown { node: Node::inner(bounds.to_aabb(), below as u32), bounds, cost }
    }

    fn leaf(&self, bounds: Bounds, first: u32, count: u32) -> Grown {
        let cost = f64::from(self.config.intersection_cost) * f64::from(count) * area(bounds);
        Grown { node: Node::leaf(bounds.to_aabb(), first, count), bounds, cost }
    }
}

/// Half the area of a box.
fn area(bounds: Bounds) -> f64 {
    bounds.to_aabb().half_area_f64()
}

/// The two children of a range of at least two.
fn split<'a>(range: Range<'a>, references: &[Reference], config: &BuildConfig) -> [Range<'a>; 2] {
    let Range { keys, first, budget, mut is_recoded } = range;
    let count = keys.len();
    let mut middle = first_of_upper_half(keys);
    if middle.is_none() && !is_recoded && count > config.max_leaf_size as usize {
        morton::order(keys, references, &centroids(keys, references));
        is_recoded = true;
        middle = first_of_upper_half(keys);
    }
    let middle =
        middle.filter(|&middle| depth::allows(budget, middle, count - middle)).unwrap_or(count / 2);
    let (before, after) = keys.split_at_mut(middle);
    let budget = budget - 1;
    [
        Range { keys: before, first, budget, is_recoded },
        Range { keys: after, first: first + middle as u32, budget, is_recoded },
    ]
}

/// The first key that has the highest bit in which codes differ; `None` if they are all the same.
fn first_of_upper_half(keys: &[Key]) -> Option<usize> {
    let [first, .., last] = keys else { return None };
    let bit = (first.code ^ last.code).checked_ilog2()?;
    Some(keys.partition_point(|key| key.code >> bit & 1 == 0))
}

/// The box around the centroids.
fn centroids(keys: &[Key], references: &[Reference]) -> Bounds {
    let centroid = |key: &Key| references[key.index as usize].centroid();
    keys.iter().map(centroid).fold(Bounds::EMPTY, Bounds::with)
}
