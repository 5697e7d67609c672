//! Frames.

use glam::DVec3;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng as Source;
use raydsl_tests::{in_parallel, scaled};

/// How many normals of each kind.
const NORMALS: usize = 4_000_000;

/// The bound of the frame's dot products and of what lengths differ from 1.
const BOUND: f64 = 4e-7;

fn error(frame: Frame) -> f64 {
    let [x, y, z] = [frame.x, frame.y, frame.z].map(Vec3::as_dvec3);
    let lengths = [x, y].map(|v: DVec3| (v.length() - 1.0).abs());
    let products = [x.dot(y), x.dot(z), y.dot(z)].map(f64::abs);
    assert!(x.cross(y).dot(z) > 0.999, "a left-handed frame around {z}");
    lengths.into_iter().chain(products).fold(0.0, f64::max)
}

fn check(name: &str, normal: impl Fn(&mut Source) -> Vec3 + Sync) {
    let worst = std::sync::Mutex::new(0.0f64);
    in_parallel(scaled(NORMALS), 1 << 14, |part| {
        let mut rng = Source::new(part.start as u64);
        let errors = part.map(|_| error(Frame::around(normal(&mut rng))));
        let most = errors.fold(0.0, f64::max);
        let mut worst = worst.lock().expect("no test panics here");
        *worst = worst.max(most);
    });
    let worst = worst.into_inner().expect("no test panics here");
    println!("frames {name}: off by {worst:e}");
    assert!(worst < BOUND, "{name}: {worst}");
}

#[test]
fn frames_are_orthonormal() {
    check("everywhere", |rng| sample_uniform_sphere(vec2(rng.unit(), rng.unit())));
    check("next to -z", |rng| {
        let size = 10f32.powf(rng.range(-20.0, -1.0));
        vec3(rng.range(-size, size), rng.range(-size, size), -1.0).normalize()
    });
    check("next to the horizon", |rng| {
        let size = 10f32.powf(rng.range(-30.0, -1.0));
        vec3(rng.range(-1.0, 1.0), rng.range(-1.0, 1.0), rng.range(-size, size)).normalize()
    });
}

#[test]
fn frames_take_vectors_there_and_back() {
    let mut rng = Source::new(4);
    for _ in 0..10_000 {
        let frame = Frame::around(rng.direction().normalize());
        let v = rng.point(10.0);
        assert!((frame.to_local(frame.to_world(v)) - v).length() < 1e-5);
        assert!((frame.to_world(Vec3::Z) - frame.z).length() < 1e-6);
    }
}
