//! A point cloud of 16 bytes a point, with the colour in the hit record.

use raydsl::prelude::*;

/// A point with a colour, as it lies in memory and on a GPU.
#[primitive]
#[derive(Debug)]
pub(crate) struct ColorSphere {
    /// Where it is.
    pub(crate) center: Vec3,
    /// How large.
    pub(crate) radius: Unorm8,
    /// Red, green and blue.
    pub(crate) color: [Unorm8; 3],
}

// ANCHOR: record
/// What a ray finds.
#[derive(Clone, Copy, Debug, PartialEq, Type, HitRecord)]
pub(crate) struct ColorHit {
    /// Where.
    pub(crate) hit: Hit,
    /// In which colour.
    pub(crate) color: Vec3,
}
// ANCHOR_END: record

// ANCHOR: impl
#[primitive]
impl ColorSphere {
    const SLACK: f32 = sphere::SLACK;

    fn intersect(&self, ray: Ray) -> ColorHit {
        let hit = sphere::intersect(ray, self.center, self.radius.to_f32());
        let [r, g, b] = self.color;
        ColorHit { hit, color: vec3(r.to_f32(), g.to_f32(), b.to_f32()) }
    }

    fn get_bounds(&self) -> Aabb {
        sphere::get_bounds(self.center, self.radius.to_f32())
    }

    fn split_primitive(&self, axis: usize, at: f32) -> (Aabb, Aabb) {
        sphere::split_primitive(axis, at, self.center, self.radius.to_f32())
    }
}
// ANCHOR_END: impl

/// Points on a spiral.
pub(crate) fn spiral(count: u32) -> Vec<ColorSphere> {
    let point = |i: u32| {
        let share = i as f32 / count as f32;
        let (sin, cos) = (40.0 * share).sin_cos();
        ColorSphere {
            center: vec3((0.3 + share) * cos, 2.0 * share - 1.0, (0.3 + share) * sin),
            radius: Unorm8::new(0.04),
            color: [share, 0.6, 1.0 - share].map(Unorm8::new),
        }
    };
    (0..count).map(point).collect()
}
