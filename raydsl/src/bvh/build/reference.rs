//! The builder's copy of a primitive's box and id.

use glam::{Vec3, Vec4};

use super::error::BuildError;
use super::source::Source;
use super::tasks;
use super::watch::Watch;
use crate::geometry::Aabb;

/// Set in every stored index, see [`Reference`]; the indices are below it.
const TAG: u32 = 0x4000_0000;

/// Boxes per piece of parallel work.
const PIECE: usize = 1 << 14;

/// Box in two vector registers; the fourth lanes are unused.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Lower corner.
    pub(super) lo: Vec4,
    /// Upper corner.
    pub(super) hi: Vec4,
}

impl Bounds {
    /// Empty box.
    pub(super) const EMPTY: Self = Self { lo: Vec4::INFINITY, hi: Vec4::NEG_INFINITY };

    /// Returns the smallest box around both.
    #[inline]
    pub(super) fn union(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Returns the intersection of two boxes; invalid when they are disjoint.
    pub(super) fn intersection(self, other: Self) -> Self {
        Self { lo: self.lo.max(other.lo), hi: self.hi.min(other.hi) }
    }

    /// Returns the smallest box around this one and a point.
    #[inline]
    pub(super) fn with(self, point: Vec4) -> Self {
        Self { lo: self.lo.min(point), hi: self.hi.max(point) }
    }

    /// Converts from the crate's box type.
    pub(super) fn from_aabb(bounds: Aabb) -> Self {
        Self { lo: bounds.min.extend(0.0), hi: bounds.max.extend(0.0) }
    }

    /// Converts to the crate's box type.
    pub(super) fn to_aabb(self) -> Aabb {
        Aabb::new(self.lo.truncate(), self.hi.truncate())
    }
}

/// A primitive's box and index, 32 bytes.
///
/// The index sits in the fourth lane of `lo`, where every vector instruction on the box carries it
/// along as an `f32`. A plain index would be denormal, which costs processors a microcode assist in
/// each addition and multiplication (a factor of 2.8 on a whole build). The bit [`TAG`] makes it a
/// normal number, or for some indices a NaN or infinity, which are as fast.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    bounds: Bounds,
}

impl Reference {
    /// Creates a reference to primitive `index` with a box. The index is below
    /// [`MAX_PRIMITIVES`](super::MAX_PRIMITIVES).
    pub(super) fn new(bounds: Aabb, index: usize) -> Self {
        let tag = f32::from_bits(TAG | index as u32);
        // Adding zero turns -0.0 into 0.0. The minimum of the two zeros depends on the order of the
        // operands, and so on the division of work; with one zero only it does not.
        let (lo, hi) = (bounds.min + Vec3::ZERO, bounds.max + Vec3::ZERO);
        Self { bounds: Bounds { lo: lo.extend(tag), hi: hi.extend(0.0) } }
    }

    /// Returns the primitive id.
    pub(super) fn index(&self) -> u32 {
        self.bounds.lo.w.to_bits() & !TAG
    }

    /// Returns the reference's box.
    #[inline]
    pub(super) fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns twice the center of the box: the builder only compares centroids, so the factor does
    /// not matter, and the sum needs no multiplication.
    #[inline]
    pub(super) fn centroid(&self) -> Vec4 {
        self.bounds.lo + self.bounds.hi
    }

    /// Scales the box.
    pub(super) fn scale(&mut self, factor: f32) {
        let factor = Vec3::splat(factor).extend(1.0);
        // Lane 4 of `lo` is multiplied by 1; only a NaN could change by that, so it is put back.
        let tag = self.bounds.lo.w;
        self.bounds.lo = (self.bounds.lo * factor).with_w(tag);
        self.bounds.hi *= factor;
    }
}

/// Bounds of a range of references.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// Bounds of the primitives.
    pub(super) bounds: Bounds,
    /// Bounds of their (doubled) centroids.
    pub(super) centroids: Bounds,
}

impl Span {
    /// Span of no references.
    pub(super) const EMPTY: Self = Self { bounds: Bounds::EMPTY, centroids: Bounds::EMPTY };

    /// Returns the span of both ranges.
    pub(super) fn union(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            centroids: self.centroids.union(other.centroids),
        }
    }

    /// Returns the span of all `references`.
    pub(super) fn of(references: &[Reference]) -> Self {
        references.iter().fold(Self::EMPTY, |span, reference| Self {
            bounds: span.bounds.union(reference.bounds()),
            centroids: span.centroids.with(reference.centroid()),
        })
    }
}

/// Reads and validates all boxes, with room for `spare` more references behind them.
pub(super) fn collect(
    source: &dyn Source,
    count: usize,
    spare: usize,
    watch: &Watch,
) -> Result<(Vec<Reference>, Span), BuildError> {
    let blank = Reference { bounds: Bounds { lo: Vec4::ZERO, hi: Vec4::ZERO } };
    let mut references = vec![blank; count + spare];
    let pieces = tasks::map_pieces_mut(&mut references[..count], PIECE, |start, piece| {
        watch.check()?;
        for (index, slot) in (start..).zip(piece.iter_mut()) {
            *slot = Reference::new(checked(source.bounds(index), index)?, index);
        }
        watch.advance(piece.len());
        Ok(Span::of(piece))
    });
    // The pieces are in order: the first error is the one of the smallest index.
    let span = pieces
        .into_iter()
        .try_fold(Span::EMPTY, |all, piece: Result<Span, BuildError>| Ok(all.union(piece?)))?;
    Ok((references, span))
}

/// Returns the box itself if it is valid and finite.
pub(super) fn checked(bounds: Aabb, index: usize) -> Result<Aabb, BuildError> {
    // One test for nearly all boxes; invalid ones are classified below.
    if bounds.is_valid() && bounds.is_finite() {
        return Ok(bounds);
    }
    if bounds.min.is_nan() || bounds.max.is_nan() {
        return Err(BuildError::NanBounds { index });
    }
    // An empty box has infinite bounds too, but the inversion says more.
    if !bounds.is_valid() {
        return Err(BuildError::InvertedBounds { index });
    }
    Err(BuildError::InfiniteBounds { index })
}
