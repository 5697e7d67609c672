//! Builder input: primitives as boxes.

use crate::geometry::{Aabb, Primitive, SharedSlices};

/// Primitives as seen by the builder: boxes, and boxes of their parts.
///
/// Both functions must be pure. They are called in any order and from several threads. The builder
/// takes a trait object so that it is compiled once, not per kind of primitive.
pub(in crate::bvh) trait Source: Sync {
    /// Returns a box around the whole primitive.
    fn bounds(&self, index: usize) -> Aabb;

    /// Returns boxes around the parts of the primitive below and above the plane `axis = at`, as
    /// [`Primitive::split_primitive`] does.
    fn split(&self, index: usize, axis: usize, at: f32) -> (Aabb, Aabb);
}

/// Primitives known only by their boxes.
pub(in crate::bvh) struct Boxes<F>(pub(in crate::bvh) F);

impl<F: Fn(usize) -> Aabb + Sync> Source for Boxes<F> {
    fn bounds(&self, index: usize) -> Aabb {
        (self.0)(index)
    }

    fn split(&self, index: usize, axis: usize, at: f32) -> (Aabb, Aabb) {
        self.bounds(index).split(axis, at)
    }
}

/// Slice of primitives and their shared data.
pub(in crate::bvh) struct Primitives<'a, P: Primitive> {
    pub(in crate::bvh) prims: &'a [P],
    pub(in crate::bvh) shared: SharedSlices<'a, P>,
}

impl<P: Primitive> Source for Primitives<'_, P> {
    fn bounds(&self, index: usize) -> Aabb {
        self.prims[index].get_bounds(self.shared)
    }

    fn split(&self, index: usize, axis: usize, at: f32) -> (Aabb, Aabb) {
        self.prims[index].split_primitive(axis, at, self.shared)
    }
}
