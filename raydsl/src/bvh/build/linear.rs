//! Linear BVH over the Morton order: [`BuildQuality::Fast`](super::BuildQuality::Fast).
//!
//! After Lauterbach, Garland, Sengupta, Luebke and Manocha, *Fast BVH construction on GPUs*
//! (Computer Graphics Forum 28(2), 2009), section 3: primitives sorted by their [Morton
//! codes](super::morton) are split at the highest bit in which the codes differ. A binary search
//! finds it, as in section 4 of Karras, *Maximizing parallelism in the construction of BVHs,
//! octrees, and k-d trees* (High Performance Graphics, 2012). Bounds are computed bottom-up,
//! together with the SAH decision whether few enough primitives are cheaper in one leaf.
//!
//! # Equal codes
//!
//! A distant primitive makes the cells so large that all others may fall into one. Primitives with
//! equal codes are therefore coded again, within their own bounding cube. That happens once on a
//! path from the root to a leaf, which gives 42 bits an axis and at most doubles the time. Ranges
//! with equal codes after that are halved by index.
//!
//! # Depth
//!
//! 63 bits twice, and up to 30 halvings where the bits end, make up to 156 levels. The budget of
//! [`depth`] forbids that: a split that would leave the larger side too many primitives for the
//! remaining levels is replaced by a split in halves, in the current order.

use super::config::Settings;
use super::morton::{self, Key};
use super::part::{PIECE, Part};
use super::reference::{Bounds, Reference, Span};
use super::watch::Watch;
use super::{depth, tasks};
use crate::bvh::Node;

/// Builds the tree over all `references`; also returns their indices in leaf order.
pub(super) fn grow(
    references: &[Reference],
    span: &Span,
    config: &Settings,
    watch: &Watch,
) -> (Part, Vec<u32>) {
    let mut keys = morton::keys(references, &span.centroids);
    let budget = depth::budget(references.len());
    let range = Range { keys: &mut keys, first: 0, budget, is_recoded: false };
    let part = grow_part(range, references, config, watch);
    (part, keys.into_iter().map(Key::index).collect())
}

/// Range of keys that becomes a subtree.
struct Range<'a> {
    /// The keys, sorted.
    keys: &'a mut [Key],
    /// Position of the first key in the whole list.
    first: u32,
    /// Number of levels allowed below.
    budget: u32,
    /// Whether the codes are relative to a smaller cube.
    is_recoded: bool,
}

impl Range<'_> {
    /// Recodes a range of equal codes within its own bounding cube; returns whether it did, since
    /// keys may then have moved.
    fn tell_apart(&mut self, references: &[Reference], config: &Settings) -> bool {
        let is_needed = !self.is_recoded
            && self.keys.len() > config.leaf_size()
            && first_of_upper_half(self.keys).is_none();
        if is_needed {
            morton::order_again(self.keys, references);
            self.is_recoded = true;
        }
        is_needed
    }

    /// Splits a range of at least two keys into the two children.
    fn split(self) -> [Self; 2] {
        let Self { keys, first, budget, is_recoded } = self;
        let count = keys.len();
        let middle = first_of_upper_half(keys)
            .filter(|&middle| depth::allows(budget, middle, count - middle))
            .unwrap_or(count / 2);
        let (before, after) = keys.split_at_mut(middle);
        let budget = budget - 1;
        [
            Self { keys: before, first, budget, is_recoded },
            Self { keys: after, first: first + middle as u32, budget, is_recoded },
        ]
    }
}

fn grow_part(mut range: Range, references: &[Reference], config: &Settings, watch: &Watch) -> Part {
    let count = range.keys.len();
    if watch.is_stopped() {
        let root = Node::leaf(Bounds::EMPTY.to_aabb(), range.first, count as u32);
        return Part::Whole { root, below: Vec::new() };
    }
    if count <= PIECE {
        let mut subtree = Subtree::new(&range, references, config);
        let root = subtree.grow(range).node;
        subtree.nodes.shrink_to_fit();
        watch.advance(count);
        return Part::Whole { root, below: subtree.nodes };
    }
    range.tell_apart(references, config);
    let [left, right] = range.split();
    let (left, right) = tasks::join(
        || grow_part(left, references, config, watch),
        || grow_part(right, references, config, watch),
    );
    Part::Fork { bounds: left.bounds().union(right.bounds()), children: Box::new([left, right]) }
}

/// Subtree under construction.
struct Subtree<'a> {
    references: &'a [Reference],
    config: &'a Settings,
    /// Position of its first key in the whole list.
    first: u32,
    /// Boxes of its primitives, in key order. They may be anywhere in memory: one loop over all of
    /// them overlaps several cache misses, the recursion would wait for each.
    boxes: Vec<Bounds>,
    nodes: Vec<Node>,
}

/// Root of a finished subtree.
struct Grown {
    node: Node,
    bounds: Bounds,
    /// Expected cost of the subtree as in `BuildConfig`, times its area.
    cost: f64,
}

impl<'a> Subtree<'a> {
    fn new(range: &Range, references: &'a [Reference], config: &'a Settings) -> Self {
        let count = range.keys.len();
        let boxes = vec![Bounds::EMPTY; count];
        let nodes = Vec::with_capacity(2 * count);
        let mut subtree = Self { references, config, first: range.first, boxes, nodes };
        subtree.gather(range);
        subtree
    }

    /// Loads the boxes of a range.
    fn gather(&mut self, range: &Range) {
        let boxes = &mut self.boxes[(range.first - self.first) as usize..];
        for (bounds, key) in boxes.iter_mut().zip(&*range.keys) {
            *bounds = self.references[key.index() as usize].bounds();
        }
    }

    /// Appends the nodes below the root of a range; returns the root.
    fn grow(&mut self, mut range: Range) -> Grown {
        let (first, count) = (range.first, range.keys.len() as u32);
        // Make a leaf of a single key.
        if count == 1 {
            let bounds = self.boxes[(first - self.first) as usize];
            let cost = self.leaf_cost(count, area(bounds));
            return Grown { node: Node::leaf(bounds.to_aabb(), first, count), bounds, cost };
        }
        if range.tell_apart(self.references, self.config) {
            self.gather(&range);
        }
        let below = self.nodes.len();
        // Reserve the children: their descendants come after both.
        self.nodes.extend([Node::inner(Bounds::EMPTY.to_aabb(), 0); 2]);
        let [left, right] = range.split().map(|child| self.grow(child));
        // Collapse the subtree into a leaf where that is cheaper.
        let bounds = left.bounds.union(right.bounds);
        let area = area(bounds);
        let split_cost = f64::from(self.config.traversal_cost) * area + left.cost + right.cost;
        let cost = self.leaf_cost(count, area);
        let is_block = self.config.is_block(count as usize);
        if is_block || (count as usize <= self.config.leaf_size() && cost <= split_cost) {
            self.nodes.truncate(below);
            return Grown { node: Node::leaf(bounds.to_aabb(), first, count), bounds, cost };
        }
        self.nodes[below] = left.node;
        self.nodes[below + 1] = right.node;
        Grown { node: Node::inner(bounds.to_aabb(), below as u32), bounds, cost: split_cost }
    }

    fn leaf_cost(&self, count: u32, area: f64) -> f64 {
        f64::from(self.config.intersection_cost) * f64::from(count) * area
    }
}

/// Returns half the surface area of a box.
fn area(bounds: Bounds) -> f64 {
    bounds.to_aabb().half_area_f64()
}

/// Returns the position of the first key with the highest differing bit set; `None` if all codes
/// are equal.
fn first_of_upper_half(keys: &[Key]) -> Option<usize> {
    let [first, .., last] = keys else { return None };
    let bit = (first.code() ^ last.code()).checked_ilog2()?;
    Some(keys.partition_point(|key| key.code() >> bit & 1 == 0))
}
