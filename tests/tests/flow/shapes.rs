//! Tubes and arrows.

use raydsl::flow::{Arrow, Capsule, FlowPoint};
use raydsl::prelude::*;
use raydsl::testing;
use raydsl_tests::close::assert_close;
use raydsl_tests::rng::Rng;

/// The distance of a point from a segment.
fn distance_to(p: Vec3, a: Vec3, b: Vec3) -> f32 {
    let axis = b - a;
    let share = ((p - a).dot(axis) / axis.length_squared().max(1e-30)).clamp(0.0, 1.0);
    p.distance(a + axis * share)
}

fn ray(rng: &mut Rng, size: f32) -> Ray {
    let (from, to) = (rng.direction().normalize() * 5.0, rng.point(size));
    Ray::new(from, (to - from).normalize())
}

/// A bent tube, as a chain.
fn chain() -> Vec<Capsule> {
    let at = |i: i32| {
        let t = i as f32 * 0.35;
        FlowPoint { at: vec3(t.cos(), t.sin(), 0.12 * t - 0.8), time: t, ..FlowPoint::default() }
    };
    let points: Vec<FlowPoint> = (0..40).map(at).collect();
    Capsule::chain(&points, 0.08, |p| p.time)
}

/// A hit is on the surface of the whole chain, sphere tracing finds the same, and the normal is
/// that of the distance.
#[test]
fn chains_have_no_gaps() {
    let tube = chain();
    let bvh = Bvh::build(&tube).expect("a tree");
    let distance = |p: Vec3| {
        tube.iter().map(|c| distance_to(p, c.p0, c.p1)).fold(f32::INFINITY, f32::min) - 0.08
    };
    let mut rng = Rng::of("chains");
    let mut hits = 0;
    for _ in 0..1000 {
        let ray = ray(&mut rng, 1.2);
        let hit = bvh.closest_hit(ray);
        let along = (0..1600).map(|i| distance(ray.at(i as f32 * 0.005)));
        let least = along.fold(f32::INFINITY, f32::min);
        let first = (0..1600).find(|i| distance(ray.at(*i as f32 * 0.005)) < 0.0);
        // Between samples a ray may graze the tube.
        if !(-1e-4..=1e-2).contains(&least) {
            assert_eq!(hit.is_hit, least < 0.0, "{least}");
        }
        if hit.is_hit {
            hits += 1;
            let first = first.map_or(f32::INFINITY, |i| i as f32 * 0.005);
            assert!(hit.t <= first + 1e-4, "{} is behind {first}", hit.t);
            let p = ray.at(hit.t);
            assert!(distance(p).abs() < 1e-5, "{}", distance(p));
            let normal = bvh.primitive(hit).normal(ray, hit);
            assert!((normal.length() - 1.0).abs() < 1e-5);
            // Outwards, the distance grows.
            assert!(distance(p + normal * 0.01) > 0.0099, "{hit:?}");
            let value = bvh.primitive(hit).value(hit);
            assert!((0.0..=39.0 * 0.35).contains(&value));
        }
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn variants_of_tubes_and_arrows_agree() {
    let tube = chain();
    let bvh = Bvh::build(&tube).expect("a tree");
    let mut rng = Rng::of("tubes in all variants");
    let inputs: Vec<(Ray,)> = (0..400).map(|_| (ray(&mut rng, 1.2),)).collect();
    let kernel = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let mut found = vec4(0.0, 0.0, 0.0, 0.0);
        if hit.is_hit {
            let part = bvh.primitive(hit);
            found = part.normal(ray, hit).extend(part.value(hit));
        }
        found
    });
    assert_close(&kernel, &inputs, 1e-4);
    let arrows: Vec<Arrow> =
        (0..60).map(|i| Arrow::at(rng.point(1.0), rng.direction(), i as f32)).collect();
    let bvh = Bvh::build(&arrows).expect("a tree");
    let kernel = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let mut found = vec4(0.0, 0.0, 0.0, 0.0);
        if hit.is_hit {
            let arrow = bvh.primitive(hit);
            found = arrow.normal(ray, hit).extend(arrow.value + hit.t);
        }
        found
    });
    assert_close(&kernel, &inputs, 1e-4);
    let hits = testing::run(&kernel, raydsl::kernel::Variant::Scalar, &inputs);
    assert!(hits.iter().filter(|v| v.w != 0.0).count() > 40);
}

/// An arrow from all sides: silhouettes are a shaft and a head.
#[test]
fn arrows_are_a_shaft_and_a_head() {
    let arrow = Arrow { tail: Vec3::ZERO, radius: 0.1, tip: vec3(0.0, 0.0, 2.0), value: 1.0 };
    let width_at = |z: f32| {
        (0..1000)
            .filter(|i| {
                let x = (*i as f32 + 0.5) / 1000.0 - 0.5;
                arrow.intersect(Ray::new(vec3(x, -5.0, z), Vec3::Y)).is_hit
            })
            .count() as f32
            / 1000.0
    };
    // Six radii of head.
    assert!((width_at(0.7) - 0.2).abs() < 0.003);
    assert!((width_at(1.399) - 0.2).abs() < 0.003);
    assert!((width_at(1.405) - 0.476).abs() < 0.006);
    assert!((width_at(1.7) - 0.24).abs() < 0.003);
    assert_eq!((width_at(-0.01), width_at(2.01)), (0.0, 0.0));
    // Into the tip and the tail.
    let up = Ray::new(vec3(0.0, 0.01, -3.0), Vec3::Z);
    assert!((arrow.intersect(up).t - 3.0).abs() < 1e-5);
    assert!(arrow.normal(up, arrow.intersect(up)).distance(-Vec3::Z) < 1e-5);
    // A short one is half a head; one without a length is nothing.
    let short = Arrow { tip: vec3(0.0, 0.0, 0.2), ..arrow };
    assert!(short.intersect(Ray::new(vec3(0.2, -5.0, 0.105), Vec3::Y)).is_hit);
    let none = Arrow { tip: Vec3::ZERO, ..arrow };
    assert!(!none.intersect(Ray::new(vec3(0.0, -5.0, 0.0), Vec3::Y)).is_hit);
}

#[test]
fn values_are_linear_along_a_tube() {
    let tube = Capsule::along([(Vec3::ZERO, 1.0), (vec3(2.0, 0.0, 0.0), 3.0)], 0.1);
    let value_at = |x: f32| {
        let hit = tube[0].intersect(Ray::new(vec3(x, -3.0, 0.0), Vec3::Y));
        assert!(hit.is_hit, "{x}");
        tube[0].value(hit)
    };
    assert!((value_at(0.5) - 1.5).abs() < 1e-5);
    assert!((value_at(1.75) - 2.75).abs() < 1e-5);
    // On the balls at both ends.
    assert_eq!((value_at(-0.05), value_at(2.05)), (1.0, 3.0));
}

#[test]
fn chains_of_few_points() {
    assert!(Capsule::along([], 0.1).is_empty());
    let ball = Capsule::along([(Vec3::X, 2.0), (Vec3::X, 3.0)], 0.1);
    assert_eq!(ball.len(), 1);
    let hit = ball[0].intersect(Ray::new(vec3(1.0, -3.0, 0.0), Vec3::Y));
    assert!(hit.is_hit && (hit.t - 2.9).abs() < 1e-5);
    assert!(ball[0].normal(Ray::new(vec3(1.0, -3.0, 0.0), Vec3::Y), hit).distance(-Vec3::Y) < 1e-4);
}
