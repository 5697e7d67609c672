//! Sphere tracing of an implicit surface, refined by bisection. (closure, option, early return, bare
//! integers)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

/// A ball with dimples: below 0 inside.
#[kernel]
fn field(p: Vec3, dimples: f32) -> f32 {
    p.length() - 1.0 + 0.05 * sin(p.x * dimples) * sin(p.y * dimples) * sin(p.z * dimples)
}

/// The first root of `f` from `a` to `b`, found by `n` steps.
#[kernel]
fn first_root<F: Fn(f32) -> f32>(f: &F, a: f32, b: f32, n: u32) -> Option<f32> {
    let h = (b - a) / n as f32;
    let mut x = a;
    let mut y = f(x);
    for _ in 0..n {
        let next = x + h;
        let z = f(next);
        if y > 0.0 && z <= 0.0 {
            let (mut low, mut high) = (x, next);
            for _ in 0..12 {
                let middle = (low + high) * 0.5;
                if f(middle) > 0.0 { low = middle } else { high = middle }
            }
            return Some(high);
        }
        (x, y) = (next, z);
    }
    None
}

/// The distance of the surface, and the normal's share towards the eye.
#[kernel]
fn dimpled(ray: Ray, dimples: f32) -> Vec2 {
    let f = |t: f32| field(ray.at(t), dimples);
    if let Some(t) = first_root(&f, 1.0, 5.0, 40) {
        let p = ray.at(t);
        let e = 1e-3;
        let slope = |d: Vec3| field(p + d * e, dimples) - field(p - d * e, dimples);
        let normal = vec3(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)).normalize();
        return vec2(t, -normal.dot(ray.direction));
    }
    vec2(0.0, 0.0)
}

#[test]
fn dimples_are_found() {
    let kernel = kernel!(|ray: Ray| dimpled(ray, 8.0));
    let rays: Vec<Ray> = (0..400)
        .map(|i| {
            let at = |k: i32| (k as f32 - 9.5) * 0.07;
            Ray::new(vec3(at(i % 20), at(i / 20), -3.0), Vec3::Z)
        })
        .collect();
    assert_variants_agree!(&kernel, &rays);
    let seen = kernel.call((Ray::new(vec3(0.0, 0.0, -3.0), Vec3::Z),));
    assert!((seen.x - 2.0).abs() < 1e-3 && seen.y > 0.9, "{seen}");
}
