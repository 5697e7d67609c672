//! Binned SAH split selection.
//!
//! After Wald 2007: one pass sorts the primitives into bins by centroid on all three axes. Then the
//! planes between the bins are compared by the expected cost of the two children: the number of
//! primitives in each, weighted by its surface area.

use glam::{Vec3, Vec4, Vec4Swizzles};

use super::config::{BuildConfig, MAX_BINS, Settings};
use super::reference::{Bounds, Reference, Span};
use super::tasks;

/// Nodes of at least this many references are binned in pieces.
const LARGE: usize = 1 << 16;
/// References per piece.
const PIECE: usize = 1 << 14;
/// From this size on, even and odd references have separate bins. Neighbours tend to fall into the
/// same bin and then wait for each other's stores: two sets of bins save a tenth of a whole build.
const TWO_SETS: usize = 1 << 10;

/// `2^-100`: centroids closer together than this count as coincident.
pub(super) const CLOSE: f32 = f32::from_bits((127 - 100) << 23);

/// `2^23`: adding it rounds a small number to an integer in the low mantissa bits, several times
/// cheaper than a saturating conversion on every target.
const ROUND: f32 = 8_388_608.0;

/// Maps the centroids of one node to bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid<'a> {
    origin: Vec4,
    /// Bins per unit of length; 0 on an axis along which the centroids do not differ.
    scale: Vec4,
    /// Number of bins per axis.
    len: usize,
    /// The unit of length for areas, see `scaling`: 1 / longest edge of the node.
    unit: f32,
    config: &'a Settings,
}

impl<'a> Grid<'a> {
    /// Creates the bins for `count` primitives within `span`; `None` when all centroids coincide.
    pub(super) fn new(span: &Span, count: usize, config: &'a Settings) -> Option<Self> {
        let extent = (span.centroids.hi - span.centroids.lo).xyz();
        if extent.max_element() < CLOSE {
            return None;
        }
        let len = (config.bins as usize).min(4 + count / 20);
        // Bin k holds positions that round to k; the first and the last are half as wide as the
        // others. The largest centroid falls on len - 1 up to rounding, so the index is never out
        // of range.
        let per_length = |extent: f32| if extent < CLOSE { 0.0 } else { (len - 1) as f32 / extent };
        let scale = Vec3::new(per_length(extent.x), per_length(extent.y), per_length(extent.z));
        // Distances over very many orders of magnitude would underflow when scaled, and denormal
        // results are as slow as denormal operands (see `Reference`). Moving the origin slightly
        // outwards, too little to matter to a bin, prevents that.
        let origin = span.centroids.lo - (extent * 2e-7).extend(0.0);
        let unit = 1.0 / (span.bounds.hi - span.bounds.lo).xyz().max_element();
        Some(Self { origin, scale: scale.extend(0.0), len, unit, config })
    }

    /// Returns the bins of a centroid, each plus [`ROUND`].
    #[inline]
    pub(super) fn position(&self, centroid: Vec4) -> Vec4 {
        (centroid - self.origin) * self.scale + Vec4::splat(ROUND)
    }

    /// Measures a box: half its surface area plus a little of its edge lengths.
    ///
    /// Boxes of points on a line have no area. The lengths, otherwise too small to matter, let them
    /// be compared as lines: without them all planes would tie with the first, and the tree would
    /// be as deep as there are points.
    #[inline]
    pub(super) fn measure(&self, bounds: Bounds) -> f32 {
        let size = (bounds.hi - bounds.lo) * self.unit;
        let terms = size * (size.yzxw() + Vec4::splat(1e-6));
        terms.x + terms.y + terms.z
    }

    /// Returns the cost of `count` primitives within a box, weighted by its measure.
    #[inline]
    pub(super) fn cost(&self, bounds: Bounds, count: usize) -> f32 {
        self.measure(bounds) * self.config.test_cost(count)
    }

    /// Returns whether splitting `count` primitives within `span`, with `cost` for both sides, is
    /// cheaper than testing them all.
    pub(super) fn pays(&self, cost: f32, span: &Span, count: usize) -> bool {
        let BuildConfig { traversal_cost, intersection_cost, .. } = **self.config;
        let split = traversal_cost * self.measure(span.bounds) + intersection_cost * cost;
        split < intersection_cost * self.cost(span.bounds, count)
    }
}

/// Bounds and reference counts of the bins.
pub(super) struct Bins {
    bounds: [[Bounds; MAX_BINS]; 3],
    counts: [[u32; MAX_BINS]; 3],
}

impl Bins {
    /// Creates empty bins.
    pub(super) fn new() -> Self {
        Self { bounds: [[Bounds::EMPTY; MAX_BINS]; 3], counts: [[0; MAX_BINS]; 3] }
    }

    /// Replaces the contents with `references`.
    pub(super) fn fill(&mut self, references: &[Reference], grid: &Grid) {
        if references.len() < LARGE {
            self.fill_piece(references, grid);
            return;
        }
        self.clear(grid.len);
        let pieces = tasks::map_pieces(references, PIECE, |_, piece| {
            let mut bins = Self::new();
            bins.fill_piece(piece, grid);
            bins
        });
        // Minima, maxima and counts do not depend on the order of the pieces.
        for piece in &pieces {
            self.merge(piece, grid.len);
        }
    }

    fn clear(&mut self, len: usize) {
        for axis in 0..3 {
            self.bounds[axis][..len].fill(Bounds::EMPTY);
            self.counts[axis][..len].fill(0);
        }
    }

    fn fill_piece(&mut self, references: &[Reference], grid: &Grid) {
        self.clear(grid.len);
        if references.len() < TWO_SETS {
            references.iter().for_each(|reference| self.add(reference, grid));
            return;
        }
        let mut odd_bins = Self::new();
        let (pairs, rest) = references.as_chunks::<2>();
        for [even, odd] in pairs {
            self.add(even, grid);
            odd_bins.add(odd, grid);
        }
        rest.iter().for_each(|reference| self.add(reference, grid));
        self.merge(&odd_bins, grid.len);
    }

    #[inline]
    fn add(&mut self, reference: &Reference, grid: &Grid) {
        let bounds = reference.bounds();
        let position = grid.position(reference.centroid()).to_array();
        for (axis, position) in position.into_iter().take(3).enumerate() {
            // Always in range; the remainder lets the compiler see it.
            let k = position.to_bits() as usize % MAX_BINS;
            self.bounds[axis][k] = self.bounds[axis][k].union(bounds);
            self.counts[axis][k] += 1;
        }
    }

    fn merge(&mut self, other: &Self, len: usize) {
        for axis in 0..3 {
            for k in 0..len {
                self.bounds[axis][k] = self.bounds[axis][k].union(other.bounds[axis][k]);
                self.counts[axis][k] += other.counts[axis][k];
            }
        }
    }

    /// Returns the cheapest split plane; there is one whenever there is a grid.
    pub(super) fn best_plane(&self, grid: &Grid) -> Option<Plane> {
        // Sweep the planes from the left, with the costs of the right sides at hand.
        let mut best: Option<Plane> = None;
        for axis in (0..3).filter(|&axis| grid.scale[axis] > 0.0) {
            let right = self.costs_right_of(axis, grid);
            let (mut bounds, mut count) = (Bounds::EMPTY, 0);
            for (bin, right) in (0..grid.len).zip(right).skip(1) {
                bounds = bounds.union(self.bounds[axis][bin - 1]);
                count += self.counts[axis][bin - 1];
                // Neither side is empty (the first and the last bin are not), so this is finite.
                let cost = grid.cost(bounds, count as usize) + right;
                // Ties go to the first axis and the lowest plane.
                if best.is_none_or(|best| cost < best.cost) {
                    best = Some(Plane { axis, bin, cost });
                }
            }
        }
        best
    }

    /// Returns the cost of the right side for each plane of an axis.
    fn costs_right_of(&self, axis: usize, grid: &Grid) -> [f32; MAX_BINS] {
        let mut costs = [0.0; MAX_BINS];
        let (mut bounds, mut count) = (Bounds::EMPTY, 0);
        for k in (1..grid.len).rev() {
            bounds = bounds.union(self.bounds[axis][k]);
            count += self.counts[axis][k];
            costs[k] = grid.cost(bounds, count as usize);
        }
        costs
    }

    /// Returns the bounds and primitive count of both sides of a plane.
    pub(super) fn sides(&self, plane: &Plane, grid: &Grid) -> [(Bounds, u32); 2] {
        let side = |range: std::ops::Range<usize>| {
            let bounds = &self.bounds[plane.axis][range.clone()];
            let counts = &self.counts[plane.axis][range];
            let bounds = bounds.iter().copied().fold(Bounds::EMPTY, Bounds::union);
            (bounds, counts.iter().sum())
        };
        [side(0..plane.bin), side(plane.bin..grid.len)]
    }
}

/// Split plane between two bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Axis perpendicular to the plane.
    pub(super) axis: usize,
    /// First bin on its right.
    bin: usize,
    /// Cost of both sides.
    cost: f32,
}

impl Plane {
    /// Returns the cost of both sides.
    pub(super) fn cost(&self) -> f32 {
        self.cost
    }

    /// Returns the plane as a [`Grid::position`]: centroids on the left are below it on this axis.
    pub(super) fn position(&self) -> f32 {
        ROUND + self.bin as f32
    }
}
