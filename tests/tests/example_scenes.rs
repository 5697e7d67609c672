//! The scenes of the examples `juggler`, `instances` and `leaves`, smaller, in every variant.

use raydsl::assert_variants_agree;
use raydsl::bvh::Object;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;

// Parts of one example call each other by the names of modules at the crate's root.
#[path = "../../examples/juggler/figure.rs"]
mod figure;
#[path = "../../examples/instances/forest.rs"]
mod forest;
#[path = "../../examples/instances/light.rs"]
mod instances;
#[path = "../../examples/juggler/light.rs"]
mod juggler;
#[path = "../../examples/leaves/light.rs"]
mod leaves;
#[path = "../../examples/leaves/plant.rs"]
mod plant;

/// Rays from `eye` to points around `center`.
fn rays(rng: &mut Rng, count: u32, eye: Vec3, center: Vec3, size: Vec3) -> Vec<(Ray,)> {
    let ray = |aim: Vec3| Ray::new(eye, (center + aim - eye).normalize());
    (0..count).map(|_| (ray(rng.point(1.0) * size),)).collect()
}

#[test]
fn a_juggler_moves_in_a_circle() {
    let (start, end) = (figure::figure(0.0), figure::figure(1.0));
    // Each ball is where the next one was, everything else where it was.
    let (body, balls) = start.split_at(start.len() - 3);
    for (a, b) in body.iter().zip(&end) {
        assert!(a.center.distance(b.center) < 1e-4, "{a:?} {b:?}");
    }
    for (i, ball) in end[body.len()..].iter().enumerate() {
        assert!(ball.center.distance(balls[(i + 1) % 3].center) < 1e-4, "{ball:?}");
    }
}

#[test]
fn a_juggler_agrees() {
    use juggler::shade;
    let sun = vec3(0.55, 0.75, 0.5).normalize();
    let rays =
        rays(&mut Rng::of("juggler"), 600, vec3(1.7, 2.0, 5.6), Vec3::Y * 1.6, Vec3::splat(1.6));
    let (before, after) = (figure::figure(0.0), figure::figure(0.4));
    let config = BuildConfig::from(BuildQuality::Fast);
    let built = Bvh::build_with(&before, &config).expect("finite bounds");
    let refitted = built.refit(&after).expect("as many spheres");
    let anew = Bvh::build_with(&after, &config).expect("finite bounds");
    let kernel = kernel!(|ray: Ray| shade(&refitted, sun, ray));
    assert_variants_agree!(&kernel, &rays);
    let of_new = kernel!(|ray: Ray| shade(&anew, sun, ray));
    assert!(rays.iter().all(|&ray| kernel.call(ray) == of_new.call(ray)));
}

#[test]
fn a_forest_agrees() {
    use instances::shade;
    let objects = [forest::ground(12), forest::fir(), forest::beech()];
    let trees = objects.each_ref().map(|o| Bvh::build(o).expect("finite bounds"));
    let (scene, top) = forest::forest(&trees, 3, 6).expect("trees that can be placed");
    assert_eq!(scene.count(), 325);
    let grows = |i: &Instance| matches!(i.object, Object::Group(_));
    assert_eq!(scene.instances_of(top).iter().filter(|i| grows(i)).count(), 9);
    let sun = vec3(-0.55, 0.42, -0.6).normalize();
    // Close to a stand, so that there is more than ground to be seen.
    let eye = vec3(-1.0, forest::hill(-1.0, 30.0) + 3.0, 30.0);
    let all = rays(&mut Rng::of("forest"), 1500, eye, Vec3::ZERO, vec3(20.0, 2.0, 20.0));
    let kernel = kernel!(|ray: Ray| shade(&scene, sun, ray));
    let trees = all.iter().map(|&ray| kernel.call(ray).id).filter(|id| (1..325).contains(id));
    let met = trees.count();
    assert!(met > 50, "{met} of {} rays meet a tree", all.len());
    assert_variants_agree!(&kernel, &all);
}

#[test]
fn leaves_agree() {
    use leaves::shade;
    let parts = plant::plant(5);
    let bvh = Bvh::build(&parts).expect("finite bounds");
    let lamp = vec3(2.2, 3.6, 3.4);
    let eye = vec3(0.0, 1.9, 6.2);
    let rays = rays(&mut Rng::of("leaves"), 800, eye, Vec3::Y * 1.2, Vec3::splat(1.3));
    let shown = [false, true].map(|masked| {
        let kernel = kernel!(|ray: Ray| shade(&bvh, masked, lamp, ray));
        assert_variants_agree!(&kernel, &rays);
        assert_eq!(kernel.wgsl().contains("fn mask("), masked);
        rays.iter().map(|&ray| kernel.call(ray)).collect::<Vec<_>>()
    });
    let differ = shown[0].iter().zip(&shown[1]).filter(|(a, b)| a.id != b.id).count();
    assert!(differ > 20, "{differ} of {} rays go through a hole", rays.len());
}
