//! Splits of space: [`BuildQuality::Best`](super::BuildQuality::Best).
//!
//! After Stich, Friedrich and Dietrich, *Spatial splits in bounding volume hierarchies* (High
//! Performance Graphics, 2009). A node is split between primitives, as [`subtree`](super::subtree)
//! does, or at a plane, which cuts those that lie on both sides: both children then have a
//! *reference* to the primitive, with the box of its part. That is what long and slanted primitives
//! need, whose boxes overlap however they are grouped.
//!
//! A plane is only looked for where the children of the other split overlap by more than a share of
//! the root's surface (section 4.5), and taken if it costs less. A reference that is cheaper left
//! whole on one side is (section 4.4, *reference unsplitting*).
//!
//! # The room for references
//!
//! The references of a node lie at the front of a slice, and what is left of it is the node's room
//! for more. The root's slice has `max_duplication` times as many spare places as there are
//! primitives. Children share the slice: what is spare goes to them in proportion to how many
//! references they have. No node can thus use more than its own share, whoever builds the other one
//! and when; the number of references never exceeds the sum; and nothing is allocated on the way.
//! When all is done the gaps are closed (see `compact`).
//!
//! No node has two references to one primitive: a plane gives one to each child, and nothing is
//! ever moved from a subtree to another.

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

/// `2^-103`: differences of numbers of this size are ordinary ones.
const FINEST: f32 = f32::MIN_POSITIVE / f32::EPSILON;

/// How many spare places the references of `count` primitives have.
pub(super) fn spare(count: usize, config: &Settings) -> usize {
    let wanted = count as f64 * f64::from(config.max_duplication);
    // The sum of both is limited as the number of primitives is.
    (wanted as usize).min(super::MAX_PRIMITIVES - count)
}

/// Builds the tree over the first `count` of `places`. Leaves refer to places.
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

/// What becomes a subtree.
struct Range<'a> {
    /// The references, and room for more.
    places: &'a mut [Reference],
    /// How many references there are.
    count: usize,
    /// The position of the first of them among all places.
    first: u32,
    span: Span,
    /// How many levels there may be below.
    budget: u32,
}

impl<'a> Range<'a> {
    fn references(&mut self) -> &mut [Reference] {
        &mut self.places[..self.count]
    }

    fn leaf(&self) -> Node {
        Node::leaf(self.span.bounds.to_aabb(), self.first, self.count as u32)
    }

    /// The children: the first `left` references, and the `right` behind them.
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

/// What `left` gets of `spare`.
fn share(spare: usize, left: usize, right: usize) -> usize {
    (spare as u64 * left as u64 / (left + right) as u64) as usize
}

/// What all nodes have in common.
struct Builder<'a, 'w> {
    chopper: Chopper<'a>,
    config: &'a Settings,
    watch: &'a Watch<'w>,
    /// The box around everything.
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

    /// The two children of a node, or the leaf that it is.
    fn split<'a>(&self, mut range: Range<'a>, bins: &mut Bins) -> Result<[Range<'a>; 2], Node> {
        let (count, span, budget) = (range.count, range.span, range.budget);
        if count == 1 {
            return Err(range.leaf());
        }
        let may_be_leaf = count <= self.config.leaf_size();
        let Some(grid) = Grid::new(&span, count, self.config) else {
            return if may_be_leaf { Err(range.leaf()) } else { Ok(halves(range)) };
        };
        bins.fill(range.references(), &grid);
        let Some(plane) = bins.best_plane(&grid) else { return Ok(halves(range)) };
        let sides = bins.sides(&plane, &grid);
        let overlap = sides[0].0.intersection(sides[1].0);
        let cut = self.best_cut(&mut range, overlap, &grid).filter(|cut| cut.cost < plane.cost());
        let cost = cut.map_or(plane.cost(), |cut| cut.cost);
        if may_be_leaf && !grid.pays(cost, &span, count) {
            return Err(range.leaf());
        }
        if let Some((left, right)) = cut.and_then(|cut| self.cut(&mut range, &cut, &grid)) {
            let spans = [0..left, left..left + right].map(|side| Span::of(&range.places[side]));
            return Ok(range.split(left, right, spans));
        }
        let [(left, left_count), (right, right_count)] = sides;
        if !depth::allows(budget, left_count as usize, right_count as usize) {
            let (middle, spans) = partition::by_median(range.references(), &span.centroids);
            return Ok(range.split(middle, count - middle, spans));
        }
        let (middle, centroids) =
            partition::by_plane(range.references(), &grid, &plane, self.watch);
        if middle != left_count as usize {
            // Stopped in the middle: all of it is thrown away.
            return Err(range.leaf());
        }
        let [left, right] = [(left, centroids[0]), (right, centroids[1])]
            .map(|(bounds, centroids)| Span { bounds, centroids });
        Ok(range.split(middle, count - middle, [left, right]))
    }

    /// The best plane to cut at, where the children of the other split overlap by `overlap`.
    fn best_cut(&self, range: &mut Range, overlap: Bounds, grid: &Grid) -> Option<Cut> {
        let is_worth_it = || {
            let overlap = overlap.to_aabb();
            let least = f64::from(self.config.min_overlap) * self.root.to_aabb().half_area_f64();
            overlap.is_valid() && overlap.half_area_f64() > least && self.is_fine()
        };
        let limits = Limits { room: range.places.len(), budget: range.budget };
        // Every cut needs a place more.
        if limits.room == range.count || !is_worth_it() {
            return None;
        }
        let bounds = range.span.bounds;
        let references = range.references();
        let mut slabs = Slabs::new(references, &bounds, limits, self.chopper.scale)?;
        slabs.fill(references, &self.chopper);
        slabs.best_cut(grid)
    }

    /// Whether primitives can be cut finely: next to the smallest numbers a cut has few bits, and
    /// computing it takes many times as long.
    fn is_fine(&self) -> bool {
        let Aabb { min, max } = self.root.to_aabb();
        self.chopper.scale.outside((max - min).max_element()) >= FINEST
    }

    /// Cuts the references; returns how many are then on the left, at the front, and on the right,
    /// behind them. `None`, and nothing has changed, if there would be none on a side.
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

    /// What becomes of the references on both sides, in their order; `None` if a side would be left
    /// with nothing.
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

/// Whether a reference on both sides is better left whole on one of them.
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

/// On which side of a plane a box is; flat ones in the plane are on the right.
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

/// Halves a range as it is, for references that nothing tells apart.
fn halves(mut range: Range) -> [Range; 2] {
    let (middle, spans) = partition::by_order(range.references());
    let rest = range.count - middle;
    range.split(middle, rest, spans)
}

/// A subtree in the making.
struct Subtree<'a, 'w> {
    builder: &'a Builder<'a, 'w>,
    bins: Bins,
    nodes: Vec<Node>,
}

impl Subtree<'_, '_> {
    /// Appends the nodes below the range's own, which is returned.
    fn grow(&mut self, range: Range) -> Node {
        let bounds = range.span.bounds.to_aabb();
        match self.builder.split(range, &mut self.bins) {
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
