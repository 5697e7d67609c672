//! The scenes of the examples `juggler`, `instances`, `leaves` and `until`, smaller, in every
//! variant, and what `until` says.

use std::ops::ControlFlow;
use std::time::Duration;

use raydsl::assert_variants_agree;
use raydsl::bvh::Object;
use raydsl::integrators::ambient_occlusion;
use raydsl::prelude::*;
use raydsl::render::{Budget, Estimate, Metric, Outcome, Progress, Reached, Target, Until};
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
#[path = "../../examples/until/sponge.rs"]
mod sponge;
#[path = "../../examples/until/words.rs"]
mod words;

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

#[test]
fn half_a_sponge_is_closed() {
    for levels in 1..=3 {
        let triangles = sponge::half(levels);
        // Of a closed surface that is seen anticlockwise from outside, the cones to the origin add
        // up to the volume, here in cells, and the areas with their normals to nothing.
        let volume: f32 = triangles.iter().map(|t| t.v0.dot(t.v1.cross(t.v2))).sum::<f32>() / 6.0;
        let areas: Vec3 = triangles.iter().map(|t| (t.v1 - t.v0).cross(t.v2 - t.v0)).sum();
        assert_eq!(areas, Vec3::ZERO);
        // A point and its mirror image in the middle are both in the sponge or not: the half has as
        // many cells as are beyond the cut, and those that are on it.
        let all = 20f32.powi(levels as i32);
        assert!(volume >= 0.5 * all && volume < 0.6 * all + 4.0, "{volume} cells of {all}");
        assert!((volume - volume.round()).abs() < 0.01, "{volume}");
    }
}

#[test]
fn a_sponge_agrees() {
    let triangles = sponge::half(2);
    let mesh = Bvh::build(&triangles).expect("finite bounds");
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        ambient_occlusion::<_, 1>(&mesh, 6.0, ray, sampler)
    });
    let eye = vec3(15.0, 16.0, 17.0);
    let rays = rays(&mut Rng::of("sponge"), 800, eye, Vec3::splat(4.5), Vec3::splat(3.5));
    let sampler = |i| Sampler::new(uvec2(i, 7), 3, 0, 1, SampleMethod::Sobol);
    let rays: Vec<_> = (0..).zip(rays).map(|(i, (ray,))| (ray, sampler(i))).collect();
    let lit: Vec<f32> = rays.iter().map(|&input| kernel.call(input)).map(|c| c.w - c.x).collect();
    let closed = lit.iter().filter(|l| **l == 1.0).count();
    assert!((100..700).contains(&closed), "{closed} of {} rays see what is closed", rays.len());
    assert_variants_agree!(&kernel, &rays);
}

#[test]
fn a_line_says_how_far_it_is_and_what_became_of_it() {
    let estimate = Estimate { error: 0.012345, low: 0.0119, high: 0.0128 };
    let (elapsed, time_left) = (Duration::from_millis(2345), Duration::from_millis(7655));
    let progress = Progress { estimate, samples: 64, spent: 200, elapsed, time_left };
    assert_eq!(
        words::progress(&progress),
        "error 1.23 % (1.19 % to 1.28 %), 64 samples a pixel, 200 taken, 8 s left"
    );
    let unknown = Estimate { error: f64::INFINITY, low: 0.0, high: f64::INFINITY };
    let line = words::progress(&Progress { estimate: unknown, ..progress });
    assert!(line.starts_with("error not known yet, 64 samples"), "{line}");
    let small = Estimate { error: 4.5e-7, low: 0.0, high: 12.0 };
    let line = words::progress(&Progress { estimate: small, ..progress });
    assert!(line.starts_with("error 0.0000450 % (0 % to 1200 %)"), "{line}");

    let outcome = Outcome::Stopped;
    let reached = Reached { outcome, estimate, samples: 64, spent: 200, elapsed, nan_pixels: 0 };
    assert_eq!(
        words::reached(&reached),
        "stopped after 2.3 s: error 1.23 % (1.19 % to 1.28 %), 64 samples a pixel, 200 taken"
    );
    let line = |outcome| words::reached(&Reached { outcome, ..reached });
    assert!(line(Outcome::Converged).starts_with("the error is reached after"));
    assert!(line(Outcome::OutOfTime).starts_with("the time is spent after"));
    assert!(line(Outcome::OutOfSamples).starts_with("the samples are spent after"));
    assert!(line(Outcome::Unresolvable { floor: 1e-6 }).starts_with("rounding leaves 0.000100 %;"));
    let line = words::reached(&Reached { nan_pixels: 3, ..reached });
    assert!(line.ends_with("; 3 pixels are no number and not in the error"), "{line}");
}

/// As the example does when Ctrl-C was pressed, here once there is a picture.
#[test]
fn what_is_stopped_has_the_best_picture_so_far() {
    let triangles = sponge::half(1);
    let mesh = Bvh::build(&triangles).expect("finite bounds");
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        ambient_occlusion::<_, 1>(&mesh, 2.0, ray, sampler)
    });
    let camera = Pinhole::new(Vec3::splat(6.0), Vec3::splat(1.5), Vec3::Y, 0.6);
    let target = Target::new(Metric::Rmse, 1e-4).pilot(128);
    let until = Until::new(target, Budget::of_samples(100_000));
    let mut film = Film::new(24, 18);
    let mut last = None;
    let reached = TiledScheduler::new().render_until_observed(
        &camera,
        &kernel,
        &Sampling::new(1),
        &mut film,
        &until,
        &mut |progress| {
            last = Some(*progress);
            if progress.samples < 64 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        },
    );
    let reached = reached.expect("it can be asked for");
    assert_eq!(reached.outcome, Outcome::Stopped);
    assert!(reached.samples >= 64 && reached.samples == film.samples());
    assert!(words::reached(&reached).starts_with("stopped after"));
    let told = last.expect("it was told").estimate;
    assert_eq!(told, reached.estimate, "what was told is what is there");
    assert!(film.image().pixels().iter().any(|p| p.w == 1.0 && p.x > 0.0 && p.x < 1.0));
}
