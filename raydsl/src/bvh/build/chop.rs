//! Clipping references at a split plane.
//!
//! # Invariant of references
//!
//! The builder cuts space by planes, so each reference stands for a primitive within a cell, the
//! intersection of some half-spaces; the cells of all references to one primitive fill space. *The
//! box of a reference holds every point of the primitive in its cell.* This holds initially, with
//! all of space as the cell and the primitive's bounds as the box. A cut at a plane makes two cells
//! and two boxes: those that `split_primitive` returns for the whole primitive at that plane,
//! clipped to the reference's own box. Both hold the points of the primitive in their cells, since
//! `split_primitive` rounds outwards and the intersection of boxes does not round. Where one of the
//! two is empty, its cell has no points, and the reference stays whole. Hence the boxes of all
//! leaves with references to a primitive together hold it.
//!
//! # Why no hit is lost
//!
//! A hit that `intersect` accepts lies within [`Primitive::SLACK`] times the reach of the ray of
//! some point of the primitive. Traversal visits the leaf whose box holds that point: it widens the
//! box by the same amount, so the ray is in it at the hit's own `t`, and neither the range of the
//! ray nor a hit that is not nearer culls that `t`. The primitive is thus tested, by the same
//! `intersect` of the same members as in any other tree.
//!
//! For hits to lie near the *box* of the primitive, as trees without cuts require, is not enough:
//! the boxes of its parts leave out most of that box. [`Primitive::split_primitive`] documents this
//! for implementers. The default clips the primitive's box, so that hits anywhere in that box are
//! found.
//!
//! [`Primitive::SLACK`]: crate::geometry::Primitive::SLACK
//! [`Primitive::split_primitive`]: crate::geometry::Primitive::split_primitive

use super::reference::{Bounds, Reference};
use super::scaling::Scale;
use super::source::Source;
use crate::geometry::Aabb;

/// Result of cutting a reference that straddles a plane.
#[derive(Clone, Copy, Debug)]
pub(super) enum Parts {
    /// The primitive has no points above the plane: the whole reference goes below.
    Below,
    /// The primitive has no points below the plane.
    Above,
    /// The boxes of both parts.
    Both(Reference, Reference),
}

/// Cuts references at planes.
pub(super) struct Chopper<'a> {
    pub(super) source: &'a dyn Source,
    pub(super) scale: Scale,
}

impl Chopper<'_> {
    /// Cuts a reference that is partly below and partly above the plane `axis = at`.
    pub(super) fn chop(&self, reference: &Reference, axis: usize, at: f32) -> Parts {
        let own = reference.bounds().to_aabb();
        let index = reference.index() as usize;
        let (below, above) = self.source.split(index, axis, self.scale.outside(at));
        let (low, high) = own.split(axis, at);
        let below = common(low, self.scale.inside(below));
        let above = common(high, self.scale.inside(above));
        match (below.is_valid(), above.is_valid()) {
            (true, true) => Parts::Both(reference.with(below), reference.with(above)),
            (true, false) => Parts::Below,
            (false, true) => Parts::Above,
            // Both answers are empty: clip the box instead.
            (false, false) => Parts::Both(reference.with(low), reference.with(high)),
        }
    }
}

/// Clips `own` to `part`; a NaN bound clips nothing.
fn common(own: Aabb, part: Aabb) -> Aabb {
    let (mut min, mut max) = (own.min, own.max);
    for axis in 0..3 {
        if part.min[axis] > min[axis] {
            min[axis] = part.min[axis];
        }
        if part.max[axis] < max[axis] {
            max[axis] = part.max[axis];
        }
    }
    Aabb::new(min, max)
}

impl Reference {
    /// Returns a reference to the same primitive with another box.
    fn with(&self, bounds: Aabb) -> Self {
        Self::new(bounds, self.index() as usize)
    }

    /// Returns whether the plane `axis = at` passes through the interior of the box.
    #[inline]
    pub(super) fn straddles(&self, axis: usize, at: f32) -> bool {
        let Bounds { lo, hi } = self.bounds();
        lo[axis] < at && at < hi[axis]
    }
}
