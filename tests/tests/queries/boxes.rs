//! Boxes in kernels: the part of a ray in a box against `f64`, and the same results in every
//! variant.

use raydsl::prelude::*;
use raydsl::testing::run;
use raydsl::{assert_variants_agree, kernel, variant_test};
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;
use raydsl_tests::scenes::broken_rays;

/// What [`Aabb::span`] gives for a ray that has no part in the box.
const EMPTY: (f32, f32) = (f32::MAX, -f32::MAX);

#[kernel]
fn span(bounds: Aabb, ray: Ray) -> (f32, f32) {
    bounds.span(ray)
}

/// The part of a ray in a box by its definition. It is empty if the first is greater.
fn exact(bounds: &Aabb, ray: &Ray) -> (f64, f64) {
    let (mut enter, mut leave) = (f64::from(ray.t_min), f64::from(ray.t_max));
    for axis in 0..3 {
        let [low, high, o, d] =
            [bounds.min[axis], bounds.max[axis], ray.origin[axis], ray.direction[axis]]
                .map(f64::from);
        if d == 0.0 {
            if o < low || o > high {
                return (f64::INFINITY, f64::NEG_INFINITY);
            }
            continue;
        }
        let (a, b) = ((low - o) / d, (high - o) / d);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    (enter, leave)
}

/// A coordinate of a small lattice: rays along faces and edges, and flat boxes, are frequent.
fn lattice(rng: &mut Rng) -> Vec3 {
    let mut one = || rng.below(5) as f32 - 2.0;
    vec3(one(), one(), one())
}

/// A box and a ray of one size, which meet often.
fn random(rng: &mut Rng) -> (Aabb, Ray) {
    let (a, b, origin, target) = match rng.below(2) {
        0 => (lattice(rng), lattice(rng), lattice(rng), lattice(rng)),
        _ => (rng.point(2.0), rng.point(2.0), rng.point(3.0), rng.point(2.0)),
    };
    let size = rng.pick(&[1.0, 1e-12, 1e12, 3e-5, 7e6]);
    let bounds = Aabb::from_points([a * size, b * size]);
    let way = if target == origin { Vec3::X } else { target - origin };
    let direction = way * rng.pick(&[1.0, size, 1e-6, 1e3]);
    let ray = Ray::new(origin * size, direction);
    let far = size / direction.abs().max_element();
    let t_max = rng.pick(&[f32::MAX, f32::INFINITY, far]);
    (bounds, ray.with_range(rng.pick(&[0.0, -f32::MAX, 0.3 * far, -far]), t_max))
}

fn inputs(name: &str, count: usize) -> Vec<(Aabb, Ray)> {
    let mut rng = Rng::of(name);
    (0..count).map(|_| random(&mut rng)).collect()
}

/// The bound that the documentation gives.
#[variant_test]
fn spans_are_those_of_real_numbers(variant: Variant) {
    let bound = if variant == Variant::Wgsl { 0.5f64.powi(21) } else { 0.5f64.powi(22) };
    let inputs = inputs("spans", scaled(2_000_000));
    let found = run(&Kernel::of::<span>(), variant, &inputs);
    let (mut met, mut missed, mut worst) = (0, 0, 0.0f64);
    for ((bounds, ray), found) in inputs.iter().zip(found) {
        let (enter, leave) = exact(bounds, ray);
        let apart = 2.0 * bound * enter.abs().max(leave.abs());
        if enter > leave {
            missed += 1;
            let is_close = enter - leave <= apart;
            assert!(found == EMPTY || is_close, "{bounds:?} {ray:?}: {found:?}, not empty");
            continue;
        }
        met += 1;
        if found == EMPTY && leave - enter <= apart {
            continue;
        }
        for (found, exact) in [(found.0, enter), (found.1, leave)] {
            let off = (f64::from(found) - exact).abs();
            // An end of the range is exact, be it infinite.
            let share = if f64::from(found) == exact { 0.0 } else { off / exact.abs() };
            worst = worst.max(share);
            assert!(share <= bound, "{bounds:?} {ray:?}: {found}, not {exact}");
        }
    }
    println!("{variant:?}: {met} met, {missed} missed, off by up to {worst:e}");
    assert!(met > inputs.len() / 10 && missed > inputs.len() / 10);
}

/// A box, a ray, and the part of the ray in the box.
fn known() -> Vec<(Aabb, Ray, (f32, f32))> {
    let unit = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let at = |x: f32, y: f32, z: f32| Ray::new(vec3(x, y, z), Vec3::X);
    let middle = at(-1.0, 0.5, 0.5);
    let inside = at(0.25, 0.5, 0.5);
    let negative_zeros = Ray { direction: vec3(1.0, -0.0, -0.0), ..middle };
    let still = Ray { direction: Vec3::ZERO, ..inside };
    let mut all = vec![
        (unit, middle, (1.0, 2.0)),
        (unit, inside, (0.0, 0.75)),
        (unit, inside.with_range(-f32::MAX, f32::MAX), (-0.25, 0.75)),
        (unit, inside.with_range(0.25, 0.5), (0.25, 0.5)),
        (unit, middle.with_range(0.0, 1.0), (1.0, 1.0)),
        (unit, middle.with_range(2.0, 9.0), (2.0, 2.0)),
        (unit, middle.with_range(0.0, 0.75), EMPTY),
        (unit, middle.with_range(2.25, 9.0), EMPTY),
        // Parallel to faces: in the box, in a face, along an edge, beside it.
        (unit, negative_zeros, (1.0, 2.0)),
        (unit, at(-1.0, 0.0, 0.5), (1.0, 2.0)),
        (unit, at(-1.0, 1.0, 0.5), (1.0, 2.0)),
        (unit, at(-1.0, 1.0, 0.0), (1.0, 2.0)),
        (unit, Ray { origin: vec3(-1.0, 1.0, 1.0), ..negative_zeros }, (1.0, 2.0)),
        (unit, at(-1.0, 1.0f32.next_up(), 0.5), EMPTY),
        (unit, at(-1.0, 0.5, -1e-30), EMPTY),
        // Too small to count.
        (unit, Ray { direction: vec3(1.0, 1e-20, -1e-30), ..middle }, (1.0, 2.0)),
        (unit, Ray { direction: vec3(1.0, 1e-20, 0.0), ..at(-1.0, -1e-25, 0.5) }, EMPTY),
        // Beside a box that is as long as a number goes.
        (Aabb::new(vec3(0.0, 1.0, 0.0), vec3(f32::MAX, 2.0, 1.0)), at(0.0, 0.0, 0.5), EMPTY),
        // No direction.
        (unit, still, (0.0, f32::MAX)),
        (unit, still.with_range(-2.0, 3.0), (-2.0, 3.0)),
        (unit, Ray { origin: vec3(0.5, 2.0, 0.5), ..still }, EMPTY),
        // A range that is none.
        (unit, middle.with_range(3.0, 0.0), EMPTY),
        (unit, middle.with_range(f32::NAN, 9.0), EMPTY),
        (unit, middle.with_range(0.0, f32::NAN), EMPTY),
        (unit, middle.with_range(f32::NEG_INFINITY, f32::INFINITY), (1.0, 2.0)),
        // Flat boxes, and boxes that are none.
        (Aabb::new(Vec3::ZERO, vec3(0.0, 1.0, 1.0)), middle, (1.0, 1.0)),
        (Aabb::new(Vec3::ZERO, vec3(1.0, 0.0, 1.0)), at(-1.0, 0.0, 0.5), (1.0, 2.0)),
        (Aabb::new(Vec3::ONE, Vec3::ONE), at(-1.0, 1.0, 1.0), (2.0, 2.0)),
        (Aabb::EMPTY, middle, EMPTY),
        (Aabb::new(Vec3::ZERO, vec3(1.0, -1.0, 1.0)), middle, EMPTY),
        (Aabb::new(Vec3::ZERO, vec3(-1.0, 1.0, 1.0)), middle, EMPTY),
        (Aabb::new(Vec3::ZERO, vec3(1.0, 1.0, f32::NAN)), middle, EMPTY),
        (Aabb::new(vec3(f32::NAN, 0.0, 0.0), Vec3::ONE), middle, EMPTY),
        (Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY), middle, (0.0, f32::MAX)),
        (Aabb::new(vec3(0.0, 0.0, f32::NEG_INFINITY), Vec3::INFINITY), middle, (1.0, f32::MAX)),
    ];
    // They begin in the box.
    let around = Aabb::new(Vec3::splat(-1.0), Vec3::ONE);
    all.extend(broken_rays().into_iter().map(|ray| (around, ray, EMPTY)));
    all
}

#[variant_test]
fn spans_that_are_known(variant: Variant) {
    let known = known();
    let inputs: Vec<(Aabb, Ray)> = known.iter().map(|&(bounds, ray, _)| (bounds, ray)).collect();
    let found = run(&Kernel::of::<span>(), variant, &inputs);
    for ((bounds, ray, expected), found) in known.into_iter().zip(found) {
        assert_eq!(found, expected, "{bounds:?} {ray:?}");
    }
}

#[test]
fn variants_agree() {
    let mut all = inputs("variants", 3000);
    all.extend(known().iter().map(|&(bounds, ray, _)| (bounds, ray)));
    assert_variants_agree!(span, &all);
}

/// Boxes that kernels capture, make and keep in lists.
#[test]
fn boxes_are_values_of_kernels() {
    let grid = Aabb::new(vec3(-1.0, -2.0, -0.5), vec3(2.0, 1.0, 1.5));
    let parts = [grid, Aabb::new(Vec3::ZERO, Vec3::ONE), Aabb::EMPTY];
    let parts = &parts[..];
    let read = kernel!(|ray: Ray| {
        let mut nearest = f32::MAX;
        for part in parts {
            nearest = min(nearest, part.span(ray).0);
        }
        let around = Aabb::new(grid.min - 1.0, grid.max + 1.0);
        let (enter, leave) = around.span(ray);
        let is_in = grid.contains(ray.origin);
        (nearest, leave - enter, is_in, grid.size().dot(grid.center()))
    });
    let inputs: Vec<(Ray,)> = inputs("lists", 2000).iter().map(|&(_, ray)| (ray,)).collect();
    assert_variants_agree!(&read, &inputs);
    assert!(read.call((Ray::new(Vec3::ZERO, Vec3::X),)).2);
}
