//! Rays and an accelerator for tests that compare with a loop in plain Rust.

use raydsl::bvh::Accelerator;
use raydsl::prelude::{Ray, Vec3, vec3};

use crate::rng::Rng;

/// Rays from points of a lattice in few directions: every distance is exact.
pub fn lattice_rays(rng: &mut Rng, count: usize) -> Vec<(Ray,)> {
    let mut all: Vec<(Ray,)> = (0..count)
        .map(|_| {
            let at = |rng: &mut Rng| (rng.below(41) as f32 - 20.0) * 0.25;
            let origin = vec3(at(rng), at(rng), at(rng).floor());
            let aside = |rng: &mut Rng| rng.pick(&[0.0, 0.0, 0.5, -0.5, 1.0, -0.25]);
            let along = rng.pick(&[1.0, -1.0, 2.0, -0.5]);
            let direction = vec3(aside(rng), aside(rng), along);
            let t_min = rng.pick(&[0.0, 0.0, 1.0, 2.0, -3.0, -0.0, 0.5]);
            let t_max = rng.pick(&[f32::INFINITY, f32::MAX, 2.0, 3.0, 1.0, 0.0, -1.0, 100.0]);
            (Ray::new(origin, direction).with_range(t_min, t_max),)
        })
        .collect();
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    for (i, value) in odd.into_iter().enumerate() {
        all[10 * i].0.origin.x = value;
        all[10 * i + 1].0.direction.z = value;
        all[10 * i + 2].0.t_min = value;
        all[10 * i + 3].0.t_max = value;
    }
    // Along a card, and nowhere.
    all[40].0.direction = Vec3::X;
    all[41].0.direction = Vec3::ZERO;
    all
}

/// Names every primitive, the last one first.
#[derive(Debug)]
pub struct Backwards(pub u32);

impl Accelerator for Backwards {
    fn candidates(&self, _: &Ray, _: f32, meet: &mut dyn FnMut(u32) -> f32) {
        (0..self.0).rev().for_each(|id| _ = meet(id));
    }
}
