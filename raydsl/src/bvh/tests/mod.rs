//! Tests of trees through the public API.

mod faults;
mod moving;
mod observers;
mod parts;
mod queries;
mod statistics;

use crate::prelude::*;
use crate::primitive;

#[primitive(sphere(center, radius))]
#[derive(Debug, PartialEq)]
struct Ball {
    center: Vec3,
    radius: f32,
}

/// Reproducible sequence of numbers (xorshift).
struct Numbers(u64);

impl Numbers {
    fn of(seed: u64) -> Self {
        Self(seed ^ 0x9E37_79B9_7F4A_7C15)
    }

    /// Returns a number in `-1..1`.
    fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    fn balls(&mut self, count: usize) -> Vec<Ball> {
        let mut one = || Ball { center: self.point(), radius: 0.1 + 0.05 * self.next() };
        (0..count).map(|_| one()).collect()
    }
}

/// Checks that rays have the same hits in the tree as among `all`, its primitives; returns the
/// number of rays with a hit.
fn assert_as_brute_force<P, A>(bvh: &Bvh<'_, P>, all: &[A]) -> usize
where
    P: Primitive<Hit = Hit>,
    A: Primitive<Hit = Hit, Shared = ()>,
{
    super::validate(bvh).expect("the tree is sound");
    let mut numbers = Numbers::of(3);
    let bounds = bvh.bounds();
    let mut around = || bounds.center() + numbers.point() * (0.75 * bounds.size());
    let mut hits = 0;
    for k in 0..400 {
        let (origin, target) = (around(), around());
        let mut ray = Ray::new(origin, target - origin);
        ray.t_max = if k % 4 == 0 { 0.5 } else { ray.t_max };
        let (found, expected) = (bvh.closest_hit(ray), all.closest_hit(ray));
        assert_eq!(found, expected);
        assert_eq!(found.t.to_bits(), expected.t.to_bits());
        assert_eq!(bvh.any_hit(ray), expected.is_hit);
        hits += usize::from(expected.is_hit);
    }
    hits
}
