//! Parts of tubes: cylinders with round ends.

use glam::Vec3;

use crate::geometry::{Aabb, Hit, Ray, sphere, tube};
use crate::machine::generic::{max, min};
use crate::primitive;

use super::follow::FlowPoint;

/// A part of a tube: all points of a segment's distance. Neighbours in a chain share a ball, so a
/// chain is a tube without gaps at its bends.
///
/// A hit's `u` is the share of the segment.
#[primitive]
#[derive(Debug, PartialEq)]
pub struct Capsule {
    /// First end of the axis.
    pub p0: Vec3,
    /// Radius.
    pub radius: f32,
    /// Second end of the axis.
    pub p1: Vec3,
    /// Value at the first end, for colours.
    pub value0: f32,
    /// Value at the second end.
    pub value1: f32,
}

#[primitive]
impl Capsule {
    const SLACK: f32 = tube::SLACK;
    const MAX_CROSSINGS: u32 = 6;

    /// Intersects a ray with the tube and its two balls: the nearest of the intersections within
    /// the ray's range.
    #[inline]
    pub fn intersect(&self, ray: Ray) -> Hit {
        let side = tube::intersect(ray, self.p0, self.p1, self.radius);
        let first = sphere::intersect(ray, self.p0, self.radius);
        let second = sphere::intersect(ray, self.p1, self.radius);
        let mut nearest = side;
        if first.is_hit && !(nearest.is_hit && nearest.t <= first.t) {
            nearest = first;
        }
        if second.is_hit && !(nearest.is_hit && nearest.t <= second.t) {
            nearest = second;
        }
        let axis = self.p1 - self.p0;
        let share = (ray.at(nearest.t) - self.p0).dot(axis) / axis.dot(axis);
        // A NaN, of a segment of no length, is 0.
        Hit { u: min(max(0.0, share), 1.0), ..nearest }
    }

    /// Returns the smallest box around the balls.
    pub fn get_bounds(&self) -> Aabb {
        sphere::get_bounds(self.p0, self.radius).union(sphere::get_bounds(self.p1, self.radius))
    }

    /// Returns the normal of a hit, away from the axis.
    #[inline]
    pub fn normal(&self, ray: Ray, hit: Hit) -> Vec3 {
        if hit.u <= 0.0 {
            sphere::normal(ray, hit, self.p0, self.radius)
        } else if hit.u >= 1.0 {
            sphere::normal(ray, hit, self.p1, self.radius)
        } else {
            tube::normal(ray, hit, self.p0, self.p1, self.radius)
        }
    }

    /// Returns the value at a hit, linear along the segment.
    #[inline]
    pub fn value(&self, hit: Hit) -> f32 {
        self.value0 + (self.value1 - self.value0) * hit.u
    }
}

impl Capsule {
    /// Returns the tube along points, whose colours are those of `value`. Points that coincide with
    /// the one before are left out; a line of one point is a ball.
    pub fn chain(
        points: &[FlowPoint],
        radius: f32,
        value: impl Fn(&FlowPoint) -> f32,
    ) -> Vec<Self> {
        let places = points.iter().map(|point| (point.at, value(point)));
        Self::along(places, radius)
    }

    /// Returns the tube along places, each with a value.
    pub fn along(places: impl IntoIterator<Item = (Vec3, f32)>, radius: f32) -> Vec<Self> {
        let mut places = places.into_iter();
        let Some((mut p0, mut value0)) = places.next() else { return Vec::new() };
        let mut all = Vec::new();
        for (p1, value1) in places {
            if p1 != p0 {
                all.push(Self { p0, radius, p1, value0, value1 });
                (p0, value0) = (p1, value1);
            }
        }
        if all.is_empty() {
            all.push(Self { p0, radius, p1: p0, value0, value1: value0 });
        }
        all
    }
}
