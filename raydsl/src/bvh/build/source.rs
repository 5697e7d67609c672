//! What a tree is built from.

use crate::geometry::{Aabb, Primitive};

/// Primitives, as the builder sees them: boxes, and boxes of their parts.
///
/// Both functions must be pure. They are called in any order and from several threads. The builder
/// takes a trait object, so that it is compiled once, not for every kind of primitive.
pub(in crate::bvh) trait Source: Sync {
    /// A box around the whole primitive.
    fn bounds(&self, index: usize) -> Aabb;

    /// Boxes around the parts of the primitive below and above the plane `axis = at`, as of
    /// [`Primitive::split_primitive`].
    fn split(&self, index: usize, axis: usize, at: f32) -> (Aabb, Aabb);
}

/// Primitives of which only the boxes are known.
pub(in crate::bvh) struct Boxes<F>(pub(in crate::bvh) F);

impl<F: Fn(usize) -> Aabb + Sync> Source for Boxes<F> {
    fn bounds(&self, index: usize) -> Aabb {
        (self.0)(index)
    }

    fn split(&self, index: usize, axis: usize, at: f32) -> (Aabb, Aabb) {
        self.bounds(index).split(axis, at)
    }
}

/// A slice of primitives, and what they share.
pub(in crate::bvh) struct Primitives<'a, P: Primitive> {
    pub(in crate::bvh) prims: &'a [P],
    pub(in crate::bvh) shared: &'a [P::Shared],
}

impl<P: Primitive> Source for Primitives<'_, P> {
    fn bounds(&self, index: usize) -> Aabb {
        self.prims[index].get_bounds(self.shared)
    }

    fn split(&self, index: usize, axis: usize, at: f32) -> (Aabb, Aabb) {
        self.prims[index].split_primitive(axis, at, self.shared)
    }
}
