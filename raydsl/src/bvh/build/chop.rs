//! Cutting references at a plane, whatever a primitive answers.
//!
//! # What holds of every reference
//!
//! The builder cuts space by planes, and so each reference stands for a primitive within a cell,
//! the common part of some half-spaces; the cells of all references of one primitive fill space.
//! *The box of a reference holds every point of the primitive in its cell.* It does in the
//! beginning, when the cell is all of space and the box that of the primitive. A cut at a plane
//! makes two cells, and two boxes: those that `split_primitive` gives for the whole primitive at
//! that plane, cut to the reference's own box. Both hold the points of the primitive in their
//! cells, since `split_primitive` rounds outwards and the intersection of boxes does not round.
//! Where one of the two is empty there is no point in that cell, and the reference stays as it is.
//! Hence the boxes of all leaves that have a primitive together hold the primitive.
//!
//! # Why no hit is lost
//!
//! A hit that `intersect` accepts lies within [`Primitive::SLACK`] times the reach of the ray of
//! some point of the primitive. The leaf whose box holds that point is visited: traversal widens
//! its box by the same amount, so the ray is in it at the hit's own `t`, and neither the range of
//! the ray nor a hit that is not nearer cuts that `t` off. The primitive is thus tested, by the
//! same `intersect` of the same members as in any other tree.
//!
//! It is not enough that hits lie near the *box* of the primitive, which is all that trees without
//! cuts need: the boxes of its parts leave most of that box out. [`Primitive::split_primitive`]
//! says so to those who write their own. Where a primitive has none, the parts are those of its
//! box, and hits anywhere in that box are found.
//!
//! [`Primitive::SLACK`]: crate::geometry::Primitive::SLACK
//! [`Primitive::split_primitive`]: crate::geometry::Primitive::split_primitive

use super::reference::{Bounds, Reference};
use super::scaling::Scale;
use super::source::Source;
use crate::geometry::Aabb;

/// What a plane makes of a reference that lies on both of its sides.
#[derive(Clone, Copy, Debug)]
pub(super) enum Parts {
    /// The primitive has no points above: the whole reference counts as below.
    Below,
    /// It has none below.
    Above,
    /// The boxes of both parts.
    Both(Reference, Reference),
}

/// Cuts references.
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
            // No answer: what is known is the box.
            (false, false) => Parts::Both(reference.with(low), reference.with(high)),
        }
    }
}

/// The part of `own` that is in `part`; a bound that is no number bounds nothing.
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
    /// The same primitive in another box.
    fn with(&self, bounds: Aabb) -> Self {
        Self::new(bounds, self.index() as usize)
    }

    /// Whether a part of the box is below the plane `axis = at`, and a part above.
    #[inline]
    pub(super) fn straddles(&self, axis: usize, at: f32) -> bool {
        let Bounds { lo, hi } = self.bounds();
        lo[axis] < at && at < hi[axis]
    }
}
