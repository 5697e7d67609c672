//! Packets that wait for each other, in delicate cases: a query within a query, trees that are gone
//! when a packet resumes, kernels that panic, and threads that end.

use std::panic::{AssertUnwindSafe, catch_unwind};

use raydsl::bvh::{Accelerated, Accelerator, BuildError};
use raydsl::kernel::GANG;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;

fn triangles(rng: &mut Rng, count: usize) -> Vec<Triangle> {
    let corner = |rng: &mut Rng| rng.point(2.0);
    (0..count)
        .map(|_| {
            let v0 = corner(rng);
            let (a, b) = (0.3 * corner(rng), 0.3 * corner(rng));
            Triangle { v0, v1: v0 + a, v2: v0 + b }
        })
        .collect()
}

fn rays(rng: &mut Rng, count: usize) -> Vec<(Ray,)> {
    (0..count)
        .map(|_| {
            let origin = rng.point(4.0);
            (Ray::new(origin, rng.point(1.0) - origin),)
        })
        .collect()
}

fn wide() -> BuildConfig {
    BuildConfig { min_wide_size: 0, ..BuildConfig::default() }
}

/// Builds a tree for every ray, asks it for many at once, and drops it.
struct TreeOfItsOwn<'a>(&'a [Triangle]);

impl Accelerator for TreeOfItsOwn<'_> {
    fn candidates(&self, ray: &Ray, _: f32, meet: &mut dyn FnMut(u32) -> f32) {
        let tree = Bvh::build_wide(self.0, &[], &wide()).expect("these triangles have boxes");
        let (near, again) = (kernel!(|ray: Ray| tree.closest_hit(ray)), [(*ray,); 40]);
        let mut found = [Hit::miss(); 40];
        near.run_in_gangs(Variant::widest(), GANG, &again, &mut found);
        for hit in found {
            assert_eq!(hit, found[0]);
            if hit.is_hit {
                meet(hit.prim_id);
            }
        }
    }
}

#[test]
fn a_query_within_a_query_and_trees_that_are_gone() -> Result<(), BuildError> {
    let mut rng = Rng::of("gangs");
    let (near, far) = (triangles(&mut rng, 40), triangles(&mut rng, 300));
    let tree = Bvh::build_wide(&far, &[], &wide())?;
    let nested = Accelerated::new(&near, TreeOfItsOwn(&near));
    let kernel = kernel!(|ray: Ray| {
        let a = tree.closest_hit(ray);
        let b = nested.closest_hit(ray);
        let c = tree.any_hit(Ray::new(ray.origin + ray.direction * b.t, ray.direction));
        (a, b, c)
    });
    let rays = rays(&mut rng, 200);
    let expected: Vec<(Hit, Hit, bool)> = rays.iter().map(|ray| kernel.call(*ray)).collect();
    assert!(expected.iter().filter(|hits| hits.1.is_hit).count() > 20);
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        let mut found = vec![(Hit::miss(), Hit::miss(), false); rays.len()];
        kernel.run_in_gangs(variant, GANG, &rays, &mut found);
        assert_eq!(found, expected, "{}", variant.name());
    }
    Ok(())
}

/// Panics for the rays that begin where it is told.
struct Broken {
    count: u32,
    at: f32,
}

impl Accelerator for Broken {
    fn candidates(&self, ray: &Ray, _: f32, meet: &mut dyn FnMut(u32) -> f32) {
        assert!(ray.origin.x != self.at, "no ray begins at {}", self.at);
        (0..self.count).for_each(|id| _ = meet(id));
    }
}

#[test]
fn kernels_that_panic() -> Result<(), BuildError> {
    let mut rng = Rng::of("panics");
    let (near, far) = (triangles(&mut rng, 30), triangles(&mut rng, 300));
    let tree = Bvh::build_wide(&far, &[], &wide())?;
    let mut rays = rays(&mut rng, 300);
    let whole = Accelerated::new(&near, Broken { count: near.len() as u32, at: f32::NAN });
    let broken = Accelerated::new(&near, Broken { count: near.len() as u32, at: 1.5 });
    let kernel = kernel!(|ray: Ray| (tree.closest_hit(ray), whole.any_hit(ray)));
    let panics = kernel!(|ray: Ray| (tree.closest_hit(ray), broken.any_hit(ray)));
    rays[150].0.origin.x = 1.5;
    let expected: Vec<(Hit, bool)> = rays.iter().map(|ray| kernel.call(*ray)).collect();
    let mut found = vec![(Hit::miss(), false); rays.len()];
    for _ in 0..3 {
        let run = AssertUnwindSafe(|| {
            panics.run_in_gangs(Variant::widest(), GANG, &rays, &mut found);
        });
        assert!(catch_unwind(run).is_err(), "a ray begins there");
        // The thread is as good as before.
        kernel.run_in_gangs(Variant::widest(), GANG, &rays, &mut found);
        assert_eq!(found, expected);
    }
    Ok(())
}

#[test]
fn threads_that_end() -> Result<(), BuildError> {
    let mut rng = Rng::of("threads");
    let all = triangles(&mut rng, 300);
    let tree = Bvh::build_wide(&all, &[], &wide())?;
    let kernel = kernel!(|ray: Ray| tree.closest_hit(ray));
    let rays = rays(&mut rng, 300);
    let expected: Vec<Hit> = rays.iter().map(|ray| kernel.call(*ray)).collect();
    for _ in 0..20 {
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    let mut found = vec![Hit::miss(); rays.len()];
                    kernel.run_in_gangs(Variant::widest(), GANG, &rays, &mut found);
                    assert_eq!(found, expected);
                });
            }
        });
    }
    Ok(())
}
