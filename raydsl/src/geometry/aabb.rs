//! Axis-aligned bounding boxes.

use glam::Vec3;

use super::Ray;
use super::slabs::span;
use crate::{Type, kernel};

/// Axis-aligned bounding box `[min, max]`, closed on all sides.
///
/// [`Aabb::EMPTY`] is the neutral element of [`Aabb::union`]; a box is *valid* when `min <= max`
/// on every axis and no bound is NaN.
///
/// Kernels capture boxes, take them as parameters, and have [`Aabb::new`], [`Aabb::size`],
/// [`Aabb::center`], [`Aabb::contains`] and [`Aabb::span`]; the rest is for the host.
///
/// ```
/// use raydsl::prelude::*;
///
/// let bounds = Aabb::new(Vec3::ZERO, Vec3::splat(2.0));
/// let depth = kernel!(|ray: Ray| {
///     let (enter, leave) = bounds.span(ray);
///     max(leave - enter, 0.0)
/// });
/// let along_x = |y: f32| Ray::new(vec3(-1.0, y, 1.0), Vec3::X);
/// assert_eq!(depth.call((along_x(0.5),)), 2.0);
/// assert_eq!(depth.call((along_x(2.5),)), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Aabb {
    /// Lower corner.
    pub min: Vec3,
    /// Upper corner.
    pub max: Vec3,
}

impl Aabb {
    /// Empty box.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// Returns the smallest box around `points`. A NaN in one makes both bounds of its axis NaN.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |all, p| all.union(Self::new(p, p)))
    }

    /// Returns the smallest `f32` box that contains the sphere around `center`: the faces are
    /// rounded outwards, so the box is never too small and at most one ulp too large.
    pub fn from_sphere(center: Vec3, radius: f32) -> Self {
        let down = |x: f32| (x - radius).next_down();
        let up = |x: f32| (x + radius).next_up();
        Self::new(
            Vec3::new(down(center.x), down(center.y), down(center.z)),
            Vec3::new(up(center.x), up(center.y), up(center.z)),
        )
    }

    /// Returns the smallest box around both. A NaN of either stays, so that the box is not valid.
    pub fn union(self, other: Self) -> Self {
        // `min` and `max` of glam would forget a NaN of one of the two.
        let nearer = |a: Vec3, b: Vec3, is_nearer| Vec3::select(is_nearer | a.is_nan_mask(), a, b);
        Self::new(
            nearer(self.min, other.min, self.min.cmplt(other.min)),
            nearer(self.max, other.max, self.max.cmpgt(other.max)),
        )
    }

    /// Returns the intersection of two boxes; not valid when they are disjoint.
    pub fn intersection(self, other: Self) -> Self {
        Self::new(self.min.max(other.min), self.max.min(other.max))
    }

    /// Splits the box into the parts below and above the plane `axis = at`, both closed; an empty
    /// part is not valid. A NaN in `at` returns the whole box twice. `axis` is 0, 1 or 2.
    pub fn split(self, axis: usize, at: f32) -> (Self, Self) {
        let (mut below, mut above) = (self, self);
        below.max[axis] = if at < self.max[axis] { at } else { self.max[axis] };
        above.min[axis] = if at > self.min[axis] { at } else { self.min[axis] };
        (below, above)
    }

    /// Returns whether `min <= max` on every axis (false when a bound is NaN).
    pub fn is_valid(self) -> bool {
        self.min.cmple(self.max).all()
    }

    /// Returns whether every bound is a finite number.
    pub fn is_finite(self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// Returns half the surface area; 0 for a box that is not valid.
    pub fn half_area(self) -> f32 {
        let d = self.size().max(Vec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// Returns [`Aabb::half_area`] of a valid box in `f64`, which is finite for every finite box.
    pub(crate) fn half_area_f64(self) -> f64 {
        let [x, y, z] = self.edges_f64();
        x * y + y * z + z * x
    }

    /// Returns [`Aabb::size`] in `f64`.
    pub(crate) fn edges_f64(self) -> [f64; 3] {
        core::array::from_fn(|axis| f64::from(self.max[axis]) - f64::from(self.min[axis]))
    }
}

#[kernel]
impl Aabb {
    /// Creates the box spanned by two corners, `min <= max`.
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Self { min, max }
    }

    /// Returns the edge lengths.
    pub fn size(self) -> Vec3 {
        self.max - self.min
    }

    /// Returns the center, computed without overflow.
    pub fn center(self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Returns whether `point` lies in the closed box.
    pub fn contains(self, point: Vec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// Returns the part of a ray in the closed box: the distances at which the ray enters and
    /// leaves it, within the ray's range. They are in lengths of the direction, as `hit.t` is.
    ///
    /// The part is empty if the first is greater than the second. Then they are `f32::MAX` and
    /// `-f32::MAX`: if the ray misses the box or its range is empty, if a component of the ray or a
    /// bound of the box is NaN, if the origin or the direction is infinite, and if the box is not
    /// valid.
    ///
    /// A ray in a face or along an edge is in the box. A component of the direction that is smaller
    /// than `2^-60` of the largest, or subnormal, counts as 0. A ray whose direction counts as 0 is
    /// in the box for its whole range, up to `f32::MAX`, or not at all.
    ///
    /// A distance that is no end of the range is off by at most `2^-22` of itself, in WGSL `2^-21`,
    /// for lengths from 1e-12 to 1e12; so a ray that only grazes an edge may be taken for one that
    /// misses it, and the reverse.
    #[inline]
    pub fn span(&self, ray: Ray) -> (f32, f32) {
        let ends = span(ray, self.min, self.max);
        (ends.x, ends.y)
    }
}
