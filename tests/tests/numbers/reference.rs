//! The reference of kernels against `f64` code written by hand.

use std::f64::consts::{PI, SQRT_2};

use raydsl::kernel;
use raydsl::machine::{Leaf, Rounding};
use raydsl::prelude::*;
use raydsl_tests::check::recorded;
use raydsl_tests::rng::Rng;
use raydsl_tests::scenes::{random_rays, spheres, triangles};

/// How far the two may be apart, relative to the larger one.
const TOLERANCE: f64 = 1e-14;

fn assert_near(found: &[f64], expected: &[f64], input: impl std::fmt::Debug) {
    assert_eq!(found.len(), expected.len());
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        let near = a == b || (a.is_nan() && b.is_nan());
        let error = (a - b).abs() / a.abs().max(b.abs());
        assert!(near || error <= TOLERANCE, "leaf {i} of {input:?}: {a:e} for {b:e}, {error:e}");
    }
}

type D3 = [f64; 3];

fn wide(v: Vec3) -> D3 {
    v.to_array().map(f64::from)
}

fn dot(a: D3, b: D3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: D3, b: D3) -> D3 {
    std::array::from_fn(|i| a[i] - b[i])
}

#[kernel]
fn sphere_hit(ray: Ray, center: Vec3, radius: f32) -> Hit {
    sphere::intersect(ray, center, radius * 1.1)
}

#[test]
fn a_sphere_by_hand() {
    let kernel = recorded::<sphere_hit>();
    let mut rng = Rng::of("a_sphere_by_hand");
    let mut hits = 0;
    for ray in random_rays(3, 2000) {
        let (center, radius) = (rng.point(5.0), rng.range(0.1, 3.0));
        let (o, d) = (wide(ray.origin), wide(ray.direction));
        let f = minus(wide(center), o);
        let per_d2 = 1.0 / dot(d, d);
        let closest = dot(f, d) * per_d2;
        let aside = minus(f, d.map(|c| c * closest));
        // The literal means its decimal text.
        let r = f64::from(radius) * 1.1;
        let distance = dot(aside, aside).sqrt();
        let radicand = (r - distance) * (r + distance);
        let half = (radicand * per_d2).sqrt();
        let (t_min, t_max) = (f64::from(ray.t_min), f64::from(ray.t_max));
        let near = closest - half;
        let t = if near < t_min { closest + half } else { near };
        let is_hit = radicand >= 0.0 && t >= t_min && t <= t_max;
        hits += u32::from(is_hit);
        let expected = [f64::from(is_hit), t, 0.0, 0.0, 0.0, 0.0];
        assert_near(&kernel.reference((ray, center, radius)), &expected, (ray, center, radius));
    }
    assert!(hits > 100, "{hits} hits");
}

#[kernel]
fn next(state: &mut u32) -> f32 {
    *state = state.wrapping_mul(747796405).wrapping_add(2891336453);
    let word = ((*state >> ((*state >> 28) + 4)) ^ *state).wrapping_mul(277803737);
    ((word >> 22) ^ word) as f32 * 2.3283064e-10
}

#[derive(Clone, Copy, Debug, Type)]
struct Rotated {
    v: Vec3,
    trace: f32,
    state: u32,
}

#[kernel]
fn random_matrix(seed: u32, v: Vec3) -> Rotated {
    let mut state = seed;
    let mut rows = [vec3(0.0, 0.0, 0.0); 3];
    let mut trace = 0.0;
    for i in 0..3u32 {
        let a = next(&mut state) - 0.3;
        let b = next(&mut state) / 3.0;
        let c = next(&mut state) * -0.7 + 0.1;
        rows[i as usize] = vec3(a, b, c);
        trace += if i == 0 {
            a
        } else if i == 1 {
            b
        } else {
            c
        };
    }
    let w = vec3(rows[0].dot(v), rows[1].dot(v), rows[2].dot(v));
    Rotated { v: w / (1.0 + w.length()), trace, state }
}

#[test]
fn random_matrices_by_hand() {
    let kernel = recorded::<random_matrix>();
    let mut rng = Rng::of("random_matrices_by_hand");
    for _ in 0..2000 {
        let (seed, v) = (rng.bits() as u32, rng.point(5.0));
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(747796405).wrapping_add(2891336453);
            let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277803737);
            f64::from((word >> 22) ^ word) * 2.3283064e-10
        };
        let rows: [D3; 3] = [(); 3].map(|()| [next() - 0.3, next() / 3.0, next() * -0.7 + 0.1]);
        let w = rows.map(|r| dot(r, wide(v)));
        let length = dot(w, w).sqrt();
        let [x, y, z] = w.map(|c| c / (1.0 + length));
        let trace = rows[0][0] + rows[1][1] + rows[2][2];
        let expected = [x, y, z, trace, f64::from(state)];
        assert_near(&kernel.reference((seed, v)), &expected, (seed, v));
    }
}

const STEP: f32 = 0.1;

#[kernel]
fn waves(x: f32, y: f32) -> Vec4 {
    let turn = sincos_2pi(x * 0.1);
    let a = sin(x) * exp(-0.1 * y) + atan2(y, x);
    let b = pow(x.abs(), 0.3) + log(1.5 + y * y) - turn.cos * turn.sin;
    let c = core::f32::consts::PI * x - std::f32::consts::SQRT_2 * y.copysign(x);
    vec4(a, b, c, tan(STEP * x) + acos(clamp(x, -1.0, 1.0)))
}

#[test]
fn elementary_functions_by_hand() {
    let kernel = recorded::<waves>();
    let mut rng = Rng::of("elementary_functions_by_hand");
    for _ in 0..2000 {
        let args = (rng.range(-8.0, 8.0), rng.range(-8.0, 8.0));
        let (x, y) = (f64::from(args.0), f64::from(args.1));
        let u = x * 0.1;
        let angle = (u - u.round()) * 2.0 * PI;
        let a = x.sin() * (-0.1 * y).exp() + y.atan2(x);
        let b = x.abs().powf(0.3) + (1.5 + y * y).ln() - angle.cos() * angle.sin();
        let c = PI * x - SQRT_2 * y.copysign(x);
        // A constant of the source is an `f32`.
        let d = (f64::from(0.1f32) * x).tan() + x.clamp(-1.0, 1.0).acos();
        assert_near(&kernel.reference(args), &[a, b, c, d], args);
    }
}

/// The least (t, id) over a tree is that over all primitives, and close to that of `f32`.
#[test]
fn trees_change_nothing() -> Result<(), raydsl::bvh::BuildError> {
    let (spheres, triangles) = (spheres(500), triangles(500));
    let tree = Bvh::build(&spheres)?;
    let mesh = Bvh::build(&triangles)?;
    let (all, faces) = (&spheres[..], &triangles[..]);
    let by_tree = kernel!(|ray: Ray| {
        let a = tree.closest_hit(ray);
        let b = mesh.closest_hit(ray);
        (a.is_hit, a.prim_id, a.t, b.is_hit, b.prim_id, b.t, tree.any_hit(ray), mesh.any_hit(ray))
    });
    let by_all = kernel!(|ray: Ray| {
        let a = all.closest_hit(ray);
        let b = faces.closest_hit(ray);
        (a.is_hit, a.prim_id, a.t, b.is_hit, b.prim_id, b.t, all.any_hit(ray), faces.any_hit(ray))
    });
    let (mut hits, mut uncertain) = (0, 0);
    for ray in random_rays(7, 600) {
        let found = by_tree.outcomes((ray,), Rounding::IEEE, 64);
        let reference: Vec<f64> = found.reference().iter().copied().map(Leaf::value).collect();
        assert_eq!(reference, by_all.reference((ray,)), "{ray:?}");
        hits += u32::from(reference[0] == 1.0) + u32::from(reference[3] == 1.0);
        uncertain += u32::from(found.is_uncertain());
        assert!(found.is_complete() && found.contains(by_tree.call((ray,))), "{ray:?} {found:#?}");
    }
    assert!(hits > 200, "{hits} hits");
    println!("{hits} hits, {uncertain} of 600 rays uncertain");
    Ok(())
}

/// A kernel of the same name as an elementary function is still one of the user's.
mod own {
    use raydsl::kernel;

    #[kernel]
    pub(crate) fn sin(x: f32) -> f32 {
        x + 1.0
    }
}

#[test]
fn a_kernel_called_sin_is_not_the_sine() {
    let kernel = recorded::<own::sin>();
    assert_eq!(kernel.reference((2.0,)), [3.0]);
}
