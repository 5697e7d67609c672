//! Spatial splits (SBVH): [`BuildQuality::Best`](super::BuildQuality::Best).
//!
//! After Stich, Friedrich and Dietrich, *Spatial splits in bounding volume hierarchies* (High
//! Performance Graphics, 2009). A node is split between primitives, as in
//! [`subtree`](super::subtree), or at a plane that cuts the primitives on both sides: both children
//! then have a *reference* to the primitive, with the box of its part. This helps long and slanted
//! primitives, whose boxes overlap however they are grouped.
//!
//! Spatial splits are only tried where the children of the object split overlap by more than a
//! share of the root's surface area (section 4.5), and taken if they cost less. A reference stays
//! whole on one side where that is cheaper (section 4.4, *reference unsplitting*).
//!
//! # Room for references
//!
//! The references of a node lie at the front of a slice, and the rest of the slice is the node's
//! room for more. The root's slice has `max_duplication` times as many spare places as there are
//! primitives. Children share the slice: spare places are divided in proportion to their
//! references. No node can thus use more than its own share, whoever builds the other one and when;
//! the number of references never exceeds the sum; and nothing is allocated during the build.
//! Finally the gaps are closed (see `compact`).
//!
//! No node has two references to one primitive: a plane gives one to each child, and references
//! never move between subtrees.

use super::binned_sah::{Bins, Grid};
use super::chop::{Chopper, Parts};
use super::config::Settings;
use super::part::{PIECE, Part};
use super::reference::{Bounds, Reference, Span};
use super::spatial_bins::{Cut, Limits, Slabs};
use super::watch::Watch;
use super::{depth, partition, tasks};
use crate::bvh::Node;
use crate::geometry::Aabb;

/// `2^-103`: differences of numbers of this size are normal numbers.
const FINEST: f32 = f32::MIN_POSITIVE / f32::EPSILON;

/// Returns the number of spare places for the references of `count` primitives.
pub(super) fn spare(count: usize, config: &Settings) -> usize {
    let wanted = count as f64 * f64::from(config.max_duplication);
    // The sum of both has the same limit as the number of primitives.
    (wanted as usize).min(super::MAX_PRIMITIVES - count)
}

/// Builds the tree over the first `count` of `places`; leaves refer to places.
pub(super) fn grow<'a>(
    places: &mut [Reference],
    count: usize,
    span: Span,
    chopper: Chopper<'a>,
    (config, watch): (&'a Settings, &'a Watch<'_>),
) -> Part {
    let budget = depth::budget(count);
    let builder = Builder { chopper, config, watch, root: span.bounds };
    builder.grow_part(Range { places, count, first: 0, span, budget })
}

/// Range of references that becomes a subtree.
struct Range<'a> {
    /// References, and room for more.
    places: &'a mut [Reference],
    /// Number of references.
    count: usize,
    /// Position of the first reference among all places.
    first: u32,
    span: Span,
    /// Number of levels allowed below.
    budget: u32,
}

impl<'a> Range<'a> {
    fn references(&mut self) -> &mut [Reference] {
        &mut self.places[..self.count]
    }

    fn leaf(&self) -> Node {
        Node::leaf(self.span.bounds.to_aabb(), self.first, self.count as u32)
    }

    /// Splits into children: the first `left` references, and the `right` behind them.
    fn split(self, left: usize, right: usize, [left_span, right_span]: [Span; 2]) -> [Self; 2] {
        let Self { places, first, budget, .. } = self;
        let spare = places.len() - left - right;
        let middle = left + share(spare, left, right);
        if middle > left {
            places.copy_within(left..left + right, middle);
        }
        let (before, after) = places.split_at_mut(middle);
        let (budget, second) = (budget - 1, first + middle as u32);
        [
            Self { places: before, count: left, first, span: left_span, budget },
            Self { places: after, count: right, first: second, span: right_span, budget },
        ]
    }
}

/// Returns the part of `spare` that goes to `left`.
fn share(spare: usize, left: usize, right: usize) -> usize {
    (spare as u64 * left as u64 / (left + right) as u64) as usize
}

/// State common to all nodes.
struct Builder<'a, 'w> {
    chopper: Chopper<'a>,
    config: &'a Settings,
    watch: &'a Watch<'w>,
    /// Bounds of the whole scene.
    root: Bounds,
}

impl Builder<'_, '_> {
    fn grow_part(&self, range: Range) -> Part {
        if self.watch.is_stopped() {
            return Part::Whole { root: range.leaf(), below: Vec::new() };
        }
        let (places, bounds) = (range.places.len(), range.span.bounds);
        if range.count <= PIECE {
            let mut subtree = Subtree { builder: self, bins: Bins::new(), nodes: Vec::new() };
            subtree.nodes.reserve_exact(2 * range.count);
            let root = subtree.grow(range);
            subtree.nodes.shrink_to_fit();
            self.watch.advance(places);
            return Part::Whole { root, below: subtree.nodes };
        }
        match self.split(range, &mut Bins::new()) {
            Ok([left, right]) => {
                let (left, right) = tasks::join(|| self.grow_part(left), || self.grow_part(right));
                Part::Fork { bounds, children: Box::new([left, right]) }
            }
            Err(leaf) => Part::Whole { root: leaf, below: Vec::new() },
        }
    }

    /// Splits a node into its two children; the error is a leaf, if it becomes one.
    fn split<'a>(&self, mut range: Range<'a>, bins: &mut Bins) -> Result<[Range<'a>; 2], Node> {
        let (count, span, budget) = (range.count, range.span, range.budget);
        if count == 1 {
            return Err(range.leaf());
        }
        let may_be_leaf = count <= self.config.leaf_size();
        let Some(grid) = Grid::new(&span, count, self.config) else {
            return if may_be_leaf { Err(range.leaf()) } else { Ok(halves(range)) };
        };
        // Find the cheapest object split, then a cheaper spatial one.
        bins.fill(range.references(), &grid);
        let Some(plane) = bins.best_plane(&grid) else { return Ok(halves(range)) };
        let sides = bins.sides(&plane, &grid);
        let overlap = sides[0].0.intersection(sides[1].0);
        let cut = self.best_cut(&mut range, overlap, &grid).filter(|cut| cut.cost < plane.cost());
        let cost = cut.map_or(plane.cost(), |cut| cut.cost);
        if may_be_leaf && !grid.pays(cost, &span, count) {
            return Err(range.leaf());
        }
        // Cut the references, unless that would leave a side empty.
        if let Some((left, right)) = cut.and_then(|cut| self.cut(&mut range, &cut, &grid)) {
            let spans = [0..left, left..left + right].map(|side| Span::of(&range.places[side]));
            return Ok(range.split(left, right, spans));
        }
        // Partition them at the plane, or by median where it would exceed the depth limit.
        let [(left, left_count), (right, right_count)] = sides;
        if !depth::allows(budget, left_count as usize, right_count as usize) {
            let (middle, spans) = partition::by_median(range.references(), &span.centroids);
            return Ok(range.split(middle, count - middle, spans));
        }
        let (middle, centroids) =
            partition::by_plane(range.references(), &grid, &plane, self.watch);
        if middle != left_count as usize {
            // Cancelled half way: the tree is thrown away.
            return Err(range.leaf());
        }
        let [left, right] = [(left, centroids[0]), (right, centroids[1])]
            .map(|(bounds, centroids)| Span { bounds, centroids });
        Ok(range.split(middle, count - middle, [left, right]))
    }

    /// Returns the best spatial split of a node whose object split overlaps by `overlap`.
    fn best_cut(&self, range: &mut Range, overlap: Bounds, grid: &Grid) -> Option<Cut> {
        let is_worth_it = || {
            let overlap = overlap.to_aabb();
            let least = f64::from(self.config.min_overlap) * self.root.to_aabb().half_area_f64();
            overlap.is_valid() && overlap.half_area_f64() > least && self.is_fine()
        };
        let limits = Limits { room: range.places.len(), budget: range.budget };
        // Every cut needs a spare place.
        if limits.room == range.count || !is_worth_it() {
            return None;
        }
        let bounds = range.span.bounds;
        let references = range.references();
        let mut slabs = Slabs::new(references, &bounds, limits, self.chopper.scale)?;
        slabs.fill(references, &self.chopper);
        slabs.best_cut(grid)
    }

    /// Returns whether primitives can be cut finely: next to the smallest numbers a cut has few
    /// bits, and computing it takes many times as long.
    fn is_fine(&self) -> bool {
        let Aabb { min, max } = self.root.to_aabb();
        self.chopper.scale.outside((max - min).max_element()) >= FINEST
    }

    /// Cuts the references; returns the numbers on the left, at the front, and on the right, behind
    /// them. `None`, with nothing changed, if a side would be empty.
    fn cut(&self, range: &mut Range, cut: &Cut, grid: &Grid) -> Option<(usize, usize)> {
        let fates = self.fates(range.references(), cut, grid)?;
        let mut fates = fates.into_iter();
        let (mut end, mut all) = (0, range.count);
        for k in 0..range.count {
            let mut reference = range.places[k];
            let is_left = match side(&reference, cut) {
                Side::Left => true,
                Side::Right => false,
                Side::Both => match fates.next() {
                    Some(Parts::Both(left, right)) => {
                        reference = left;
                        range.places[all] = right;
                        all += 1;
                        true
                    }
                    Some(Parts::Below) => true,
                    _ => false,
                },
            };
            range.places[k] = range.places[end];
            range.places[end] = reference;
            end += usize::from(is_left);
        }
        Some((end, all - end))
    }

    /// Returns the fates of the straddling references in order; `None` if a side would be empty.
    fn fates(&self, references: &[Reference], cut: &Cut, grid: &Grid) -> Option<Vec<Parts>> {
        let mut sides = cut.sides;
        let mut fates = Vec::new();
        for reference in references.iter().filter(|r| side(r, cut) == Side::Both) {
            let parts = match self.chopper.chop(reference, cut.axis, cut.at) {
                Parts::Both(left, right) => unsplit(reference, [left, right], &sides, grid),
                other => other,
            };
            match parts {
                Parts::Both(..) => {}
                Parts::Below => {
                    sides[0].0 = sides[0].0.union(reference.bounds());
                    sides[1].1 -= 1;
                }
                Parts::Above => {
                    sides[1].0 = sides[1].0.union(reference.bounds());
                    sides[0].1 -= 1;
                }
            }
            fates.push(parts);
        }
        (sides[0].1 > 0 && sides[1].1 > 0).then_some(fates)
    }
}

/// Decides whether a straddling reference is cheaper whole on one side.
fn unsplit(
    reference: &Reference,
    [left, right]: [Reference; 2],
    sides: &[(Bounds, usize); 2],
    grid: &Grid,
) -> Parts {
    let [(left_bounds, left_count), (right_bounds, right_count)] = *sides;
    let cost = |left: Bounds, left_count: usize, right: Bounds, right_count: usize| {
        grid.cost(left, left_count) + grid.cost(right, right_count)
    };
    let whole = reference.bounds();
    let both = cost(left_bounds, left_count, right_bounds, right_count);
    let below = cost(left_bounds.union(whole), left_count, right_bounds, right_count - 1);
    let above = cost(left_bounds, left_count - 1, right_bounds.union(whole), right_count);
    if below < both && below <= above && right_count > 1 {
        Parts::Below
    } else if above < both && left_count > 1 {
        Parts::Above
    } else {
        Parts::Both(left, right)
    }
}

/// Side of a split plane; flat boxes in the plane are on the right.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    Left,
    Right,
    Both,
}

#[inline]
fn side(reference: &Reference, cut: &Cut) -> Side {
    let bounds = reference.bounds();
    if bounds.lo[cut.axis] >= cut.at {
        Side::Right
    } else if bounds.hi[cut.axis] <= cut.at {
        Side::Left
    } else {
        Side::Both
    }
}

/// Halves a range in its current order, for coincident centroids.
fn halves(mut range: Range) -> [Range; 2] {
    let (middle, spans) = partition::by_order(range.references());
    let rest = range.count - middle;
    range.split(middle, rest, spans)
}

/// Subtree under construction.
struct Subtree<'a, 'w> {
    builder: &'a Builder<'a, 'w>,
    bins: Bins,
    nodes: Vec<Node>,
}

impl Subtree<'_, '_> {
    /// Appends the nodes below the root of a range; returns the root.
    fn grow(&mut self, range: Range) -> Node {
        let bounds = range.span.bounds.to_aabb();
        match self.builder.split(range, &mut self.bins) {
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
