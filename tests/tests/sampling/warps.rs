//! Samples have the density that they say, and can be taken back.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use raydsl::prelude::*;
use raydsl::sampling::{
    CONCENTRIC_DISK_PDF, ONE_MINUS_EPSILON, TRIANGLE_PDF, UNIFORM_HEMISPHERE_PDF,
    UNIFORM_SPHERE_PDF, invert_bilinear, invert_concentric_disk, invert_cone,
    invert_cosine_hemisphere, invert_power_cosine, invert_triangle, invert_uniform_hemisphere,
    invert_uniform_sphere,
};
use raydsl_tests::rng::Rng as Source;
use raydsl_tests::scaled;

use crate::statistics::{assert_distributed, histogram, shares};

/// The share of a turn at which a point lies.
fn turn(x: f32, y: f32) -> f64 {
    f64::from(y).atan2(f64::from(x)).rem_euclid(TAU) / TAU
}

/// Directions, in bins of their height from `bottom` to 1 and of their turn.
#[track_caller]
fn directions(
    name: &str,
    bottom: f64,
    sample: impl Fn(Vec2) -> Vec3 + Sync,
    pdf: impl Fn(f64) -> f64,
) {
    let height = 1.0 - bottom;
    let counts = histogram(name, |rng| {
        let d = sample(rng.next_2d());
        let length = d.as_dvec3().length();
        assert!((length - 1.0).abs() < 4e-7, "{name}: {d} has the length {length}");
        [((f64::from(d.z) - bottom) / height).clamp(0.0, 1.0), turn(d.x, d.y)]
    });
    // An element of solid angle is one of height times one of angle.
    let expected = shares([64, 1], |z, _| pdf(bottom + z * height) * height * TAU);
    assert_distributed(name, &counts, &expected);
}

#[test]
fn spheres_and_hemispheres() {
    let hemisphere = f64::from(UNIFORM_HEMISPHERE_PDF);
    directions("hemisphere", 0.0, sample_uniform_hemisphere, |_| hemisphere);
    directions("sphere", -1.0, sample_uniform_sphere, |_| f64::from(UNIFORM_SPHERE_PDF));
    let cosine = |cos: f64| cosine_hemisphere_pdf(cos as f32).into();
    directions("cosine", 0.0, sample_cosine_hemisphere, cosine);
    assert_eq!(cosine_hemisphere_pdf(-0.5), 0.0);
}

#[test]
fn lobes() {
    for exponent in [0.0, 1.0, 7.5, 80.0] {
        let pdf = |cos: f64| f64::from(power_cosine_pdf(cos as f32, exponent));
        directions(&format!("cosine^{exponent}"), 0.0, |u| sample_power_cosine(u, exponent), pdf);
    }
    assert_eq!(power_cosine_pdf(-0.5, 2.0), 0.0);
}

#[test]
fn cones() {
    for sine in [1.0f32, 0.7, 0.1] {
        let height = one_minus_cos(sine);
        let bottom = 1.0 - f64::from(height);
        directions(
            &format!("cone {sine}"),
            bottom,
            |u| sample_cone(u, height),
            |_| cone_pdf(height).into(),
        );
    }
}

/// At small angles too: the height of the cap, and directions of so narrow a cone.
#[test]
fn narrow_cones() {
    for exponent in -60..=0 {
        let sine = 2f32.powi(exponent) * 0.9;
        let s = f64::from(sine);
        let exact = s * s / (1.0 + (1.0 - s * s).sqrt());
        let height = one_minus_cos(sine);
        assert!((f64::from(height) / exact - 1.0).abs() < 3e-7, "{sine}");
        let rim = sample_cone(vec2(ONE_MINUS_EPSILON, 0.0), height);
        assert!((f64::from(rim.x) / s - 1.0).abs() < 4e-7, "{sine}: {rim}");
    }
    assert_eq!([one_minus_cos(0.0), one_minus_cos(1.0), one_minus_cos(2.0)], [0.0, 1.0, 1.0]);
}

#[test]
fn disks() {
    let counts = histogram("disk", |rng| {
        let p = sample_concentric_disk(rng.next_2d());
        let squared = p.as_dvec2().length_squared();
        assert!(squared <= 1.0 + 3e-7, "{p}");
        [squared.min(1.0), turn(p.x, p.y)]
    });
    // An element of area is half of one of the squared radius, times one of angle.
    let expected = shares([1, 1], |_, _| f64::from(CONCENTRIC_DISK_PDF) * 0.5 * TAU);
    assert_distributed("disk", &counts, &expected);
}

/// Shirley and Chiu's map, as they give it.
fn exact_disk(u: Vec2) -> [f64; 2] {
    let (a, b) = (2.0 * f64::from(u.x) - 1.0, 2.0 * f64::from(u.y) - 1.0);
    let (r, angle) = match (a, b) {
        (0.0, 0.0) => return [0.0, 0.0],
        _ if a.abs() > b.abs() => (a, FRAC_PI_4 * b / a),
        _ => (b, PI / 2.0 - FRAC_PI_4 * a / b),
    };
    [r * angle.cos(), r * angle.sin()]
}

#[test]
fn disks_keep_their_shape() {
    let near = |u: Vec2, expected: [f64; 2]| {
        let p = sample_concentric_disk(u);
        let error = [f64::from(p.x) - expected[0], f64::from(p.y) - expected[1]];
        assert!(error.iter().all(|e| e.abs() < 2.5e-7), "{u}: {p} {expected:?}");
    };
    assert_eq!(sample_concentric_disk(vec2(0.5, 0.5)), Vec2::ZERO);
    near(vec2(1.0, 0.5), [1.0, 0.0]);
    near(vec2(0.75, 0.75), [0.353_553_4, 0.353_553_4]);
    let mut rng = Source::new(1);
    for _ in 0..scaled(1_000_000) {
        let u = vec2(rng.unit(), rng.unit());
        near(u, exact_disk(u));
    }
}

#[test]
fn triangles() {
    // Sorted by the first weight, then by the share of the rest.
    let counts = histogram("triangle", |rng| {
        let w = sample_triangle(rng.next_2d()).as_dvec2();
        assert!(w.min_element() >= 0.0 && w.x + w.y <= 1.0);
        [1.0 - (1.0 - w.x).powi(2), w.y / (1.0 - w.x)]
    });
    let expected = shares([1, 1], |_, _| 0.5 * f64::from(TRIANGLE_PDF));
    assert_distributed("triangle", &counts, &expected);
}

/// A trapezoid with a known density, by its shape.
#[test]
fn quads() {
    let corners =
        [vec3(0.0, 0.0, 1.0), vec3(4.0, 0.0, 1.0), vec3(2.0, 2.0, 1.0), vec3(0.0, 2.0, 1.0)];
    let [v0, v1, v2, v3] = corners;
    let pdf = 1.0 / f64::from(quad::area(v0, v1, v2, v3));
    assert!((pdf - 1.0 / 6.0).abs() < 1e-7);
    let counts = histogram("quad", |rng| {
        let p = quad::sample(rng.next_2d(), v0, v1, v2, v3).position;
        let (width, y) = (4.0 - f64::from(p.y), f64::from(p.y));
        // The area below y is 4 y - y^2 / 2.
        [f64::from(p.x) / width, (4.0 * y - 0.5 * y * y) / 6.0]
    });
    assert_distributed("quad", &counts, &shares([1, 1], |_, _| pdf * 6.0));
}

/// The dark end of a density that rises from 0.
#[test]
fn bilinear_from_the_dark() {
    for (u, weights) in [
        (vec2(0.0, 0.5), vec4(0.0, 1.0, 0.0, 1.0)),
        (vec2(0.5, 0.0), vec4(0.0, 0.0, 1.0, 1.0)),
        (Vec2::ZERO, Vec4::W),
    ] {
        let p = sample_bilinear(u, weights);
        assert!(p.min_element() >= 0.0 && p.max_element() < 1.0, "{u} {weights}: {p}");
    }
}

#[test]
fn bilinear() {
    for weights in [vec4(1.0, 1.0, 1.0, 1.0), vec4(0.0, 1.0, 3.0, 0.5), Vec4::ZERO, Vec4::Z] {
        let name = format!("bilinear {weights}");
        let counts = histogram(&name, |rng| {
            let p = sample_bilinear(rng.next_2d(), weights);
            [p.x, p.y].map(f64::from)
        });
        let density = |x: f64, y: f64| bilinear_pdf(vec2(x as f32, y as f32), weights).into();
        assert_distributed(&name, &counts, &shares([8, 8], density));
    }
}

/// What goes there comes back. `tolerance` is that of both coordinates; the second may be a turn
/// off.
#[track_caller]
fn comes_back(name: &str, tolerance: f32, there_and_back: impl Fn(Vec2) -> Vec2) {
    let mut rng = Source::of(name);
    let mut worst = 0.0f32;
    let ends = [0.0, 6e-8, 1e-4, 0.25, 0.5, 0.75, ONE_MINUS_EPSILON];
    let count = scaled(1_000_000);
    for i in 0..count {
        let mut unit = || if i < 200 { rng.pick(&ends) } else { rng.unit() };
        let u = vec2(unit(), unit());
        let back = there_and_back(u);
        assert!(back.min_element() >= 0.0 && back.max_element() < 1.0, "{name}: {u} {back}");
        let apart = (back - u).abs();
        worst = worst.max(apart.x).max(apart.y.min((1.0 - apart.y).abs()));
        assert!(worst < tolerance, "{name}: {u} comes back as {back}");
    }
    println!("{name}: comes back to within {worst:e}");
}

#[test]
fn inverses() {
    // The turn means nothing at the pole.
    let off_pole = |u: Vec2, back: Vec2| if u.x == 0.0 { vec2(back.x, u.y) } else { back };
    comes_back("disk", 5e-7, |u| invert_concentric_disk(sample_concentric_disk(u)));
    comes_back("cosine", 5e-7, |u| invert_cosine_hemisphere(sample_cosine_hemisphere(u)));
    comes_back("hemisphere", 5e-7, |u| {
        off_pole(u, invert_uniform_hemisphere(sample_uniform_hemisphere(u)))
    });
    comes_back("sphere", 5e-7, |u| off_pole(u, invert_uniform_sphere(sample_uniform_sphere(u))));
    for sine in [1.0, 0.3, 1e-3, 1e-10] {
        let height = one_minus_cos(sine);
        comes_back("cone", 5e-7, |u| off_pole(u, invert_cone(sample_cone(u, height), height)));
    }
    for exponent in [0.0, 1.0, 50.0, 1e6] {
        comes_back("lobe", 1e-6, |u| {
            off_pole(u, invert_power_cosine(sample_power_cosine(u, exponent), exponent))
        });
    }
    comes_back("triangle", 5e-7, |u| invert_triangle(sample_triangle(u)));
    for weights in [vec4(1.0, 2.0, 3.0, 0.5), Vec4::ONE, Vec4::ZERO] {
        comes_back("bilinear", 1e-6, |u| invert_bilinear(sample_bilinear(u, weights), weights));
    }
}

/// A square seen from its axis: densities per solid angle add up to the known angle.
#[test]
fn densities_of_surfaces() {
    let (v0, v1, v2, v3) =
        (vec3(-1.0, -1.0, 1.0), vec3(1.0, -1.0, 1.0), vec3(1.0, 1.0, 1.0), vec3(-1.0, 1.0, 1.0));
    let pdf = 1.0 / quad::area(v0, v1, v2, v3);
    let mut rng = Rng::new(uvec2(0, 0), 0, 1);
    let n = 1 << 18;
    let mean = (0..n)
        .map(|_| {
            let point = quad::sample(rng.next_2d(), v0, v1, v2, v3);
            1.0 / f64::from(solid_angle_pdf(pdf, point.position, point.normal))
        })
        .sum::<f64>()
        / f64::from(n);
    // A face of a cube, seen from its middle.
    assert!((mean / (TAU * 2.0 / 6.0) - 1.0).abs() < 5e-3, "{mean}");
}
