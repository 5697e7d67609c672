//! Arrows: glyphs of vectors.

use glam::Vec3;

use crate::geometry::{Aabb, Hit, Ray, cone, cylinder};
use crate::primitive;
use crate::{Type, kernel};

/// Radius of the head over that of the shaft.
const HEAD_RADIUS: f32 = 2.4;
/// Length of the head over the radius of the shaft.
const HEAD_LENGTH: f32 = 6.0;
/// Maximum share of the head.
const MAX_HEAD: f32 = 0.5;

/// An arrow: a cylinder with a cone at its tip, which takes at most half of the length.
#[primitive]
#[derive(Debug, PartialEq)]
pub struct Arrow {
    /// Where it begins.
    pub tail: Vec3,
    /// Radius of the shaft; the head is 2.4 times as wide.
    pub radius: f32,
    /// Where it points.
    pub tip: Vec3,
    /// Value, for a colour.
    pub value: f32,
}

/// Both parts of an arrow as a ray meets them.
#[derive(Clone, Copy, Debug, Type)]
struct Parts {
    shaft: Hit,
    head: Hit,
    /// Centre of the head's base.
    neck: Vec3,
}

#[kernel]
#[inline]
fn parts(ray: Ray, tail: Vec3, tip: Vec3, radius: f32) -> Parts {
    let neck = neck_of(tail, tip, radius);
    Parts {
        shaft: cylinder::intersect(ray, tail, neck, radius),
        head: cone::intersect(ray, neck, tip, radius * HEAD_RADIUS),
        neck,
    }
}

#[kernel]
#[inline]
fn neck_of(tail: Vec3, tip: Vec3, radius: f32) -> Vec3 {
    let axis = tip - tail;
    let share = HEAD_LENGTH * radius / axis.length();
    // A NaN is refused too.
    tip - axis * if share < MAX_HEAD { share } else { MAX_HEAD }
}

#[kernel]
#[inline]
fn is_head_first(parts: Parts) -> bool {
    parts.head.is_hit && !(parts.shaft.is_hit && parts.shaft.t <= parts.head.t)
}

#[primitive]
impl Arrow {
    const SLACK: f32 = cylinder::SLACK;
    const MAX_CROSSINGS: u32 = 4;

    /// Intersects a ray with both parts: the nearest of the intersections within the ray's range.
    /// An arrow without a length is never hit.
    #[inline]
    pub fn intersect(&self, ray: Ray) -> Hit {
        let parts = parts(ray, self.tail, self.tip, self.radius);
        if is_head_first(parts) { parts.head } else { parts.shaft }
    }

    /// Returns the box around both parts.
    pub fn get_bounds(&self) -> Aabb {
        let neck = neck_of(self.tail, self.tip, self.radius);
        let head = cone::get_bounds(neck, self.tip, self.radius * HEAD_RADIUS);
        head.union(cylinder::get_bounds(self.tail, neck, self.radius))
    }

    /// Returns the outward normal of a hit.
    #[inline]
    pub fn normal(&self, ray: Ray, hit: Hit) -> Vec3 {
        let parts = parts(ray, self.tail, self.tip, self.radius);
        if is_head_first(parts) {
            cone::normal(ray, hit, parts.neck, self.tip, self.radius * HEAD_RADIUS)
        } else {
            cylinder::normal(ray, hit, self.tail, parts.neck, self.radius)
        }
    }
}

impl Arrow {
    /// Creates the arrow of a vector at a place, which is in its middle. Its shaft is a
    /// sixteenth as thick as it is long.
    pub fn at(place: Vec3, vector: Vec3, value: f32) -> Self {
        let half = vector * 0.5;
        Self { tail: place - half, radius: vector.length() / 32.0, tip: place + half, value }
    }
}
