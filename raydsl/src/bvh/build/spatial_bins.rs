//! Selection of spatial splits: binned SAH over slabs.
//!
//! After Stich, Friedrich and Dietrich 2009, section 4.3: the box of a node is cut into slabs of
//! equal width along each axis, references are cut at the planes between the slabs, and each slab
//! grows around the parts in it. A reference counts on the left of a plane if it enters in a slab
//! on the left, and on the right if it leaves on the right.
//!
//! Cutting dominates the time, and a plane that cuts more references than there is room for is
//! infeasible. So references are first counted, without a cut, and then cut only at feasible
//! planes. Large references that all overlap, which would be cut at every plane of every level, are
//! hardly cut at all.

use super::binned_sah::Grid;
use super::chop::{Chopper, Parts};
use super::reference::{Bounds, Reference};
use super::scaling::Scale;
use super::{depth, tasks};

/// Maximum number of slabs along an axis.
const MAX_SLABS: usize = 16;
/// Nodes of at least this many references are binned in pieces.
const LARGE: usize = 1 << 14;
/// References per piece.
const PIECE: usize = 1 << 12;

/// Planes along one axis.
#[derive(Clone, Copy, Debug)]
struct Planes {
    /// Plane `k` is between the slabs `k - 1` and `k`; the first is not used.
    at: [f32; MAX_SLABS],
    /// Slabs per unit of length; 0 along an axis that is not cut.
    scale: f32,
    lo: f32,
    len: usize,
}

impl Planes {
    fn new(bounds: &Bounds, axis: usize, len: usize, scale: Scale) -> Self {
        let (lo, hi) = (bounds.lo[axis], bounds.hi[axis]);
        let at = |k: usize| scale.plane(lo + (hi - lo) * (k as f32 / len as f32));
        let at: [f32; MAX_SLABS] = core::array::from_fn(at);
        // Do not cut an axis where planes round to each other or to the faces.
        let inner = &at[1..len];
        let is_apart = inner.is_sorted_by(|a, b| a < b) && lo < inner[0] && inner[len - 2] < hi;
        let per_length = len as f32 / (hi - lo);
        let is_cut = is_apart && per_length.is_finite();
        Self { at, scale: if is_cut { per_length } else { 0.0 }, lo, len }
    }

    /// Returns the slabs in which the box begins and ends: it straddles the planes after the first
    /// up to the second.
    #[inline]
    fn slabs(&self, bounds: &Bounds, axis: usize) -> (usize, usize) {
        let guess = |x: f32| (((x - self.lo) * self.scale) as usize).min(self.len - 1);
        let (lo, hi) = (bounds.lo[axis], bounds.hi[axis]);
        let (mut first, mut last) = (guess(lo), guess(hi));
        // Rounding may be off by a slab; the planes decide.
        while first > 0 && self.at[first] > lo {
            first -= 1;
        }
        while first + 1 < self.len && self.at[first + 1] <= lo {
            first += 1;
        }
        while last > 0 && self.at[last] >= hi {
            last -= 1;
        }
        while last + 1 < self.len && self.at[last + 1] < hi {
            last += 1;
        }
        // A flat box in a plane counts as above it.
        (first, last.max(first))
    }
}

/// Limits on the references of the two sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Total number of places.
    pub(super) room: usize,
    /// Budget of levels of the node.
    pub(super) budget: u32,
}

/// Candidate spatial split.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// Axis perpendicular to the plane.
    pub(super) axis: usize,
    /// Position along the axis.
    pub(super) at: f32,
    /// Cost: the references of both sides, weighted by the measure of the side.
    pub(super) cost: f32,
    /// Bounds and reference count of both sides.
    pub(super) sides: [(Bounds, usize); 2],
}

/// Number of references that begin and end in each slab.
type Counts = [[(u32, u32); MAX_SLABS]; 3];

/// Slabs of one node.
pub(super) struct Slabs {
    planes: [Planes; 3],
    /// Number of references below and above each feasible plane.
    counts: [[Option<[usize; 2]>; MAX_SLABS]; 3],
    bounds: [[Bounds; MAX_SLABS]; 3],
}

impl Slabs {
    /// Creates the slabs of a node and counts the references; `None` if no plane is feasible.
    pub(super) fn new(
        references: &[Reference],
        bounds: &Bounds,
        limits: Limits,
        scale: Scale,
    ) -> Option<Self> {
        let count = references.len();
        let len = MAX_SLABS.min(4 + count / 8);
        let planes = core::array::from_fn(|axis| Planes::new(bounds, axis, len, scale));
        let counted = counted(references, &planes);
        let mut counts = [[None; MAX_SLABS]; 3];
        for axis in (0..3).filter(|&axis| planes[axis].scale > 0.0) {
            let (mut below, mut above) = (0, count);
            for k in 1..len {
                let (begin, end) = (counted[axis][k - 1].0, counted[axis][k - 1].1);
                below += begin as usize;
                above -= end as usize;
                let can_be_taken = below > 0
                    && above > 0
                    && below + above <= limits.room
                    && depth::allows(limits.budget, below, above);
                counts[axis][k] = can_be_taken.then_some([below, above]);
            }
        }
        let is_any = counts.as_flattened().iter().any(Option::is_some);
        is_any.then_some(Self { planes, counts, bounds: [[Bounds::EMPTY; MAX_SLABS]; 3] })
    }

    /// Returns whether any plane perpendicular to this axis is feasible.
    fn has_planes(&self, axis: usize) -> bool {
        self.counts[axis].iter().any(Option::is_some)
    }

    /// Cuts all references at the feasible planes.
    pub(super) fn fill(&mut self, references: &[Reference], chopper: &Chopper) {
        if references.len() < LARGE {
            self.bounds = self.filled(references, chopper);
            return;
        }
        let pieces = tasks::map_pieces(references, PIECE, |_, piece| self.filled(piece, chopper));
        // Minima and maxima do not depend on the order of the pieces.
        for piece in &pieces {
            for (all, of_piece) in self.bounds.iter_mut().flatten().zip(piece.iter().flatten()) {
                *all = all.union(*of_piece);
            }
        }
    }

    fn filled(&self, references: &[Reference], chopper: &Chopper) -> [[Bounds; MAX_SLABS]; 3] {
        let mut bounds = [[Bounds::EMPTY; MAX_SLABS]; 3];
        for axis in (0..3).filter(|&axis| self.has_planes(axis)) {
            for reference in references {
                self.add(reference, axis, chopper, &mut bounds[axis]);
            }
        }
        bounds
    }

    /// Adds a reference to the slabs of an axis: its part below a plane goes to the slab before it.
    #[inline]
    fn add(
        &self,
        reference: &Reference,
        axis: usize,
        chopper: &Chopper,
        bounds: &mut [Bounds; MAX_SLABS],
    ) {
        let (first, last) = self.planes[axis].slabs(&reference.bounds(), axis);
        let mut rest = *reference;
        for k in first + 1..=last {
            if self.counts[axis][k].is_none() {
                continue;
            }
            let at = self.planes[axis].at[k];
            if !rest.straddles(axis, at) {
                // The rest begins or ends within the slab.
                if rest.bounds().hi[axis] <= at {
                    bounds[k - 1] = bounds[k - 1].union(rest.bounds());
                    return;
                }
                continue;
            }
            match chopper.chop(&rest, axis, at) {
                Parts::Below => {
                    bounds[k - 1] = bounds[k - 1].union(rest.bounds());
                    return;
                }
                Parts::Above => {}
                Parts::Both(below, above) => {
                    bounds[k - 1] = bounds[k - 1].union(below.bounds());
                    rest = above;
                }
            }
        }
        bounds[last] = bounds[last].union(rest.bounds());
    }

    /// Returns the cheapest feasible plane.
    pub(super) fn best_cut(&self, grid: &Grid) -> Option<Cut> {
        let mut best: Option<Cut> = None;
        for axis in (0..3).filter(|&axis| self.has_planes(axis)) {
            let above = self.bounds_above(axis);
            let mut below = Bounds::EMPTY;
            for (k, &above) in above.iter().enumerate().take(self.planes[axis].len).skip(1) {
                below = below.union(self.bounds[axis][k - 1]);
                let Some(counts) = self.counts[axis][k] else { continue };
                let sides = [(below, counts[0]), (above, counts[1])];
                // The parts of a primitive without points in its box may leave a side empty.
                if sides.iter().any(|(bounds, _)| !bounds.to_aabb().is_valid()) {
                    continue;
                }
                let cost = sides.map(|(bounds, count)| grid.cost(bounds, count));
                let cost = cost[0] + cost[1];
                // Ties go to the first axis and the lowest plane.
                if best.is_none_or(|best| cost < best.cost) {
                    best = Some(Cut { axis, at: self.planes[axis].at[k], cost, sides });
                }
            }
        }
        best
    }

    /// Returns the bounds above each plane of an axis.
    fn bounds_above(&self, axis: usize) -> [Bounds; MAX_SLABS] {
        let mut above = self.bounds[axis];
        for k in (0..MAX_SLABS - 1).rev() {
            above[k] = above[k].union(above[k + 1]);
        }
        above
    }
}

/// Counts the references that begin and end in each slab.
fn counted(references: &[Reference], planes: &[Planes; 3]) -> Counts {
    let of = |references: &[Reference]| {
        let mut counts = [[(0, 0); MAX_SLABS]; 3];
        for axis in (0..3).filter(|&axis| planes[axis].scale > 0.0) {
            for reference in references {
                let (first, last) = planes[axis].slabs(&reference.bounds(), axis);
                counts[axis][first].0 += 1;
                counts[axis][last].1 += 1;
            }
        }
        counts
    };
    if references.len() < LARGE {
        return of(references);
    }
    let mut all = [[(0, 0); MAX_SLABS]; 3];
    for piece in tasks::map_pieces(references, PIECE, |_, piece| of(piece)) {
        for (all, of_piece) in all.iter_mut().flatten().zip(piece.iter().flatten()) {
            *all = (all.0 + of_piece.0, all.1 + of_piece.1);
        }
    }
    all
}
