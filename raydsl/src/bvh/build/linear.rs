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

use super::config::Settings;
use super::morton::{self, Key};
use super::part::{PIECE, Part};
use super::reference::{Bounds, Reference, Span};
use super::watch::Watch;
use super::{depth, tasks};
use crate::bvh::Node;

/// Builds the tree over all `references`; also returns their indices in the order of the leaves.
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

impl Range<'_> {
    /// Gives primitives of one code codes within their own cube; returns whether it did, and so may
    /// have moved them.
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

    /// The two children of a range of at least two.
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

/// A subtree in the making.
struct Subtree<'a> {
    references: &'a [Reference],
    config: &'a Settings,
    /// The position of its first key among all.
    first: u32,
    /// The boxes of its primitives, in the order of the keys. They may be anywhere in memory: one
    /// loop that gets them all waits for several at a time, the recursion for one after another.
    boxes: Vec<Bounds>,
    nodes: Vec<Node>,
}

/// The root of a subtree.
struct Grown {
    node: Node,
    bounds: Bounds,
    /// The expected cost of what is in it, as in `BuildConfig`, times its area.
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

    /// Gets the boxes of a range.
    fn gather(&mut self, range: &Range) {
        let boxes = &mut self.boxes[(range.first - self.first) as usize..];
        for (bounds, key) in boxes.iter_mut().zip(&*range.keys) {
            *bounds = self.references[key.index() as usize].bounds();
        }
    }

    /// Appends the nodes below the range's own, which is returned.
    fn grow(&mut self, mut range: Range) -> Grown {
        let (first, count) = (range.first, range.keys.len() as u32);
        if count == 1 {
            let bounds = self.boxes[(first - self.first) as usize];
            let cost = self.leaf_cost(count, area(bounds));
            return Grown { node: Node::leaf(bounds.to_aabb(), first, count), bounds, cost };
        }
        if range.tell_apart(self.references, self.config) {
            self.gather(&range);
        }
        let below = self.nodes.len();
        // Room for the children: what is below them comes after both.
        self.nodes.extend([Node::inner(Bounds::EMPTY.to_aabb(), 0); 2]);
        let [left, right] = range.split().map(|child| self.grow(child));
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

/// Half the area of a box.
fn area(bounds: Bounds) -> f64 {
    bounds.to_aabb().half_area_f64()
}

/// The first key that has the highest bit in which codes differ; `None` if they are all the same.
fn first_of_upper_half(keys: &[Key]) -> Option<usize> {
    let [first, .., last] = keys else { return None };
    let bit = (first.code() ^ last.code()).checked_ilog2()?;
    Some(keys.partition_point(|key| key.code() >> bit & 1 == 0))
}
