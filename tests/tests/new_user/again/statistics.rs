//! Mean and variance of the distances around a ray. (option, bare integers, generic scene, `&mut
//! self`)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

use crate::{balls, rays};

/// Welford's sums.
#[derive(Clone, Copy, Type)]
struct Sums {
    count: u32,
    mean: f32,
    squares: f32,
}

#[kernel]
impl Sums {
    fn new() -> Self {
        Sums { count: 0, mean: 0.0, squares: 0.0 }
    }

    fn add(&mut self, x: f32) {
        self.count += 1;
        let d = x - self.mean;
        self.mean += d / self.count as f32;
        self.squares += d * (x - self.mean);
    }

    fn variance(&self) -> Option<f32> {
        if self.count < 2 {
            return None;
        }
        Some(self.squares / (self.count - 1) as f32)
    }
}

#[kernel]
fn roughness<S: RayQuery + ?Sized>(scene: &S, ray: Ray) -> Option<f32> {
    let mut sums = Sums::new();
    for i in 0..3 {
        for j in 0..3 {
            if i == 1 && j == 1 {
                continue;
            }
            let offset = vec3(i as f32 - 1.0, j as f32 - 1.0, 0.0) * 0.03;
            let hit = scene.closest_hit(Ray::new(ray.origin, ray.direction + offset));
            if hit.is_hit {
                sums.add(hit.t);
            }
        }
    }
    let variance = sums.variance()?;
    Some(variance.sqrt())
}

#[test]
fn edges_are_rough() {
    let prims = balls();
    let bvh = Bvh::build(&prims).unwrap();
    let kernel = kernel!(|ray: Ray| roughness(&bvh, ray).unwrap_or(-1.0));
    assert_variants_agree!(&kernel, &rays(20));
    let found: Vec<f32> = rays(20).iter().map(|r| kernel.call((*r,))).collect();
    assert!(found.iter().any(|x| *x < 0.0) && found.iter().any(|x| *x > 0.3));
}
