//! Tests of the builder.

mod check;
mod degenerate;
mod errors;
mod random;
#[cfg(feature = "parallel")]
mod threads;
mod timing;

use glam::Vec3;

use super::{BuildConfig, BuildQuality, Tree, build};
use crate::geometry::Aabb;

/// Reproducible sequence of numbers in `0..1` (xorshift).
struct Numbers(u64);

impl Numbers {
    fn new() -> Self {
        Self(0x9E37_79B9_7F4A_7C15)
    }

    fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    /// Returns `count` boxes with edges up to `size` in the unit cube.
    fn boxes(count: usize, size: f32) -> Vec<Aabb> {
        let mut numbers = Self::new();
        let mut one = || {
            let corner = numbers.point();
            Aabb::new(corner, corner + size * numbers.point())
        };
        (0..count).map(|_| one()).collect()
    }
}

/// Builds and checks trees over `boxes` with the default configuration, one of each quality.
fn trees(boxes: &[Aabb]) -> [Tree; 3] {
    trees_with(boxes, &BuildConfig::default())
}

/// Builds and checks trees over `boxes`, one of each quality.
fn trees_with(boxes: &[Aabb], config: &BuildConfig) -> [Tree; 3] {
    BuildQuality::ALL.map(|quality| {
        let config = BuildConfig { quality, ..*config };
        let tree = build(|k| boxes[k], boxes.len(), &config).expect("the boxes are valid");
        check::check(&tree, boxes, &config);
        tree
    })
}
