//! Single cases: values computed elsewhere to 40 digits, and what a shape promises beyond its hits.

use raydsl::assert_variants_agree;
use raydsl::bvh::BuildError;
use raydsl::camera::Camera;
use raydsl::geometry::{quad, triangle};
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

use super::exact::{along, length, minus};
use super::subject::{Ball, Disk, Leaf, Panel, Plane, Rod, Subject, wide};

fn assert_near(found: f32, expected: f64, tolerance: f64) {
    let error = (f64::from(found) - expected).abs();
    assert!(error <= tolerance * expected.abs(), "{found} for {expected}: {:e}", error / expected);
}

/// Half a unit inside of a planet: the squares of its radius would cancel.
#[test]
fn a_sphere_as_large_as_a_planet() {
    let (center, radius) = (vec3(0.0, -1_000_003.0, 0.0), 1_000_003.5);
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let hit = sphere::intersect(ray, center, radius);
    assert!(hit.is_hit);
    assert_near(hit.t, 1_000.001_624_998_679_7, 2e-6);
    let kernel =
        kernel!(|ray: Ray, center: Vec3, radius: f32| { sphere::intersect(ray, center, radius).t });
    assert_variants_agree!(&kernel, &[(ray, center, radius)]);
}

#[test]
fn a_sphere_and_a_direction_that_is_not_unit() {
    let ray = Ray::new(vec3(1.0, 2.0, 3.0), vec3(0.5, -0.25, -1.5));
    let (center, radius) = (vec3(2.0, 1.0, -3.0), 1.5);
    let (t0, t1) = (3.079_703_963_545_439, 4.530_052_134_015_537);
    assert_near(sphere::intersect(ray, center, radius).t, t0, 2e-6);
    let from_inside = ray.with_range(4.0, f32::MAX);
    assert_near(sphere::intersect(from_inside, center, radius).t, t1, 2e-6);
}

/// A ball of a thousandth, 65,536 away: its normal is formed from the offset of the centre.
#[test]
fn a_sphere_far_away() {
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    let (center, radius) = (vec3(3.0 / 4096.0, 0.0, 65536.0), 1.0 / 1024.0);
    let hit = sphere::intersect(ray, center, radius);
    assert!(hit.is_hit);
    assert_near(hit.t, 65536.0 - 0.000_645_935_378_677_878_6, 2.0_f64.powi(-24));
    let n = sphere::normal(ray, hit, center, radius);
    let error = (n - vec3(-0.75, 0.0, -0.661_437_8)).length();
    assert!(error < 1e-5, "{n}: {error:e}");
    let kernel = kernel!(|ray: Ray, center: Vec3, radius: f32| {
        let hit = sphere::intersect(ray, center, radius);
        (hit.is_hit, hit.t, sphere::normal(ray, hit, center, radius))
    });
    assert_variants_agree!(&kernel, &[(ray, center, radius)]);
}

/// The share of a square film that a ball covers, by the camera's rays.
#[test]
fn a_sphere_on_a_film() {
    let size = 1024u32;
    let camera = Pinhole::new(vec3(0.0, 0.0, 3.0), Vec3::ZERO, Vec3::Y, 60f32.to_radians());
    let rays = camera.begin_frame(size, size);
    let center = |i: u32| i as f32 + 0.5;
    let hits = (0..size * size).filter(|i| {
        let ray = rays.primary_ray(center(i % size), center(i / size));
        sphere::intersect(ray, Vec3::ZERO, 1.0).is_hit
    });
    let share = hits.count() as f64 / f64::from(size).powi(2);
    // Pixels on the edge count as whole or not at all.
    assert!((share - 0.294_524_311_274_043_1).abs() < 1e-4, "{share}");
}

/// How much of the light a cloud of balls stops: `1 - (1 - pi r²)^n`.
#[test]
fn the_coverage_of_clouds() {
    let mut rng = Rng::of("coverage");
    let count = scaled(1_000_000);
    // So that the share does not depend on how many there are.
    let radius = 0.5 / (count as f32).sqrt();
    let share = |rng: &mut Rng| {
        let ball = |_| Ball { center: vec3(rng.unit(), rng.unit(), rng.unit()), radius };
        let balls: Vec<Ball> = (0..count).map(ball).collect();
        let bvh = Bvh::build(&balls).expect("finite bounds");
        // Away from the faces, beyond which there are no balls.
        let hits = (0..10_000).filter(|_| {
            let at = vec3(rng.range(0.1, 0.9), rng.range(0.1, 0.9), -1.0);
            bvh.any_hit(Ray::new(at, Vec3::Z))
        });
        hits.count() as f64 / 10_000.0
    };
    let shares: Vec<f64> = (0..16).map(|_| share(&mut rng)).collect();
    let mean = shares.iter().sum::<f64>() / 16.0;
    let scatter = shares.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / 15.0;
    let r = f64::from(radius);
    let expected = 1.0 - (1.0 - std::f64::consts::PI * r * r).powf(count as f64);
    assert!((expected - 0.544_062_012_856_835_5).abs() < 1e-3, "{expected}");
    let error = (mean - expected).abs();
    assert!(
        error < 4.5 * (scatter / 16.0).sqrt(),
        "{mean} for {expected}, {error:e} of {scatter:e}"
    );
}

#[test]
fn a_triangle() {
    let ray = Ray::new(vec3(0.5, 0.25, -8.0), vec3(0.0625, 0.03125, 1.0));
    let hit = triangle::intersect(ray, Vec3::ZERO, vec3(4.0, 0.0, 1.0), vec3(0.0, 3.0, 2.0));
    assert!(hit.is_hit);
    assert_near(hit.t, 8.605_405_405_405_405, 2e-6);
    assert_near(hit.u, 0.259_459_459_459_459_5, 2e-6);
    assert_near(hit.v, 0.172_972_972_972_972_98, 2e-6);
}

/// Edges of 1e-12 have a normal and an area, though the square of their product is no `f32`.
#[test]
fn tiny_triangles_have_normals() {
    let (v0, v1, v2) = (Vec3::ZERO, Vec3::X * 1e-12, Vec3::Y * 2e-12);
    let ray = Ray::new(vec3(1e-13, 1e-13, -1.0), Vec3::Z);
    let hit = triangle::intersect(ray, v0, v1, v2);
    assert!(hit.is_hit);
    assert_eq!(triangle::normal(ray, hit, v0, v1, v2), Vec3::Z);
    assert_near(triangle::area(v0, v1, v2), 1e-24, 1e-6);
}

/// A thin triangle between neighbours that do not share a vertex: its area, as rounded, is often 0.
#[test]
fn slivers_close_gaps() {
    let mut rng = Rng::of("slivers");
    let (mut leaks, mut flat) = (0, 0);
    for _ in 0..scaled(200_000) {
        let (a, b) = (rng.point(1.0), rng.point(1.0));
        let m = a.lerp(b, rng.range(0.2, 0.8));
        let (p, q) = (rng.point(1.0), rng.point(1.0));
        // Three vertices exactly on a line fill nothing.
        let wide = |v: Vec3| v.as_dvec3();
        let area = (wide(m) - wide(a)).cross(wide(b) - wide(a)).length();
        if area == 0.0 || triangle::area(a, b, p) < 0.01 || triangle::area(a, b, q) < 0.01 {
            continue;
        }
        flat += usize::from((m - a).cross(b - a) == Vec3::ZERO);
        // Seen from the side where the two lie on either side of the edge.
        let d = (p - a).cross(b - a).normalize() + (b - a).cross(q - a).normalize();
        if d.length() < 0.5 || (p - m).normalize().dot((q - m).normalize()) > 0.0 {
            continue;
        }
        let target = a.lerp(b, rng.range(0.01, 0.99));
        let ray = Ray::new(target - d * 2.0, d);
        let is_met = |v: [Vec3; 3]| triangle::intersect(ray, v[0], v[1], v[2]).is_hit;
        leaks += usize::from(![[a, b, p], [a, m, q], [m, b, q], [a, m, b]].into_iter().any(is_met));
    }
    assert!(flat > scaled(200_000) / 100, "{flat} areas are rounded to nothing");
    assert_eq!(leaks, 0);
}

/// No ray passes between quads that share their vertices: eight corners, six skew faces.
#[test]
fn quads_are_watertight() {
    let mut rng = Rng::of("watertight");
    let mut leaks = 0;
    for i in 0..scaled(20_000) {
        let scale = 10f32.powi(rng.below(25) as i32 - 12);
        let center = rng.point(scale) * rng.pick(&[0.0, 10.0, 1000.0]);
        let corner: Vec<Vec3> = (0..8)
            .map(|k| {
                let sign = |bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
                let jitter = rng.point(0.2);
                center + (vec3(sign(0), sign(1), sign(2)) + jitter) * scale
            })
            .collect();
        let faces =
            [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        // At a vertex, at an edge, at a diagonal.
        let face = rng.pick(&faces);
        let (a, b) = rng.pick(&[(0, 1), (1, 2), (1, 3), (0, 0)]);
        let target = corner[face[a]].lerp(corner[face[b]], rng.unit());
        let origin = center + rng.point(0.3 * scale);
        let ray = Ray::new(origin, (target - origin) * if i % 2 == 0 { 1.0 } else { 1.0 / scale });
        let is_met = |f: &[usize; 4]| {
            let v = f.map(|k| corner[k]);
            quad::intersect(ray, v[0], v[1], v[2], v[3]).is_hit
        };
        leaks += usize::from(!faces.iter().any(is_met));
    }
    assert_eq!(leaks, 0);
}

/// `u` and `v` run over both halves of a quad.
#[test]
fn coordinates_of_quads() {
    let quad = Leaf {
        v0: vec3(-1.0, -2.0, 0.0),
        v1: vec3(3.0, -2.0, 0.0),
        v2: vec3(3.0, 4.0, 0.0),
        v3: vec3(-1.0, 4.0, 0.0),
    };
    let mut rng = Rng::of("coordinates of quads");
    for _ in 0..1000 {
        let (u, v) = (rng.unit(), rng.unit());
        let at = vec3(-1.0 + 4.0 * u, -2.0 + 6.0 * v, 0.0);
        let ray = Ray::new(at - vec3(0.5, 0.25, 2.0), vec3(0.5, 0.25, 2.0));
        let hit = quad.intersect(ray);
        let is_near = (hit.u - u).abs() < 2e-6 && (hit.v - v).abs() < 2e-6;
        assert!(hit.is_hit && is_near, "{hit:?} for {u} {v}");
        assert_eq!(quad.normal(ray, hit), Vec3::Z);
    }
}

/// The shares of a rectangle's edges lead to where the ray is, however far from the world's origin.
#[test]
fn coordinates_of_rectangles() {
    let mut rng = Rng::of("coordinates of rectangles");
    for _ in 0..1000 {
        let offset = rng.point(1e5);
        let panel = Panel::random(&mut rng, 1.0, offset);
        let p = panel.sample(vec2(rng.unit(), rng.unit()));
        let d = p.normal + rng.point(0.3);
        let ray = Ray::new(p.position - d * 2.0, d);
        let hit = panel.intersect(ray);
        if hit.is_hit {
            let u = along(wide(panel.corner), wide(panel.u_edge), hit.u.into());
            let found = along(u, wide(panel.v_edge), hit.v.into());
            let at = along(wide(ray.origin), wide(ray.direction), hit.t.into());
            // Far below an ulp of the offset, which is 0.008.
            assert!(length(minus(found, at)) < 1e-5, "{panel:?} {ray:?} {hit:?}");
        }
    }
}

#[test]
fn coordinates_of_disks_and_cylinders() {
    let disk = Disk { center: vec3(1.0, 2.0, 3.0), normal: Vec3::Z * 3.0, radius: 2.0 };
    let (x, y) = Vec3::Z.any_orthonormal_pair();
    for i in 0..16 {
        let angle = (f64::from(i) + 0.5) / 16.0;
        let (sin, cos) = (angle * std::f64::consts::TAU).sin_cos();
        let to = x * (1.5 * cos as f32) + y * (1.5 * sin as f32);
        let ray = Ray::new(disk.center + to + vec3(0.0, 0.0, 7.0), -Vec3::Z);
        let hit = disk.intersect(ray);
        assert!(hit.is_hit);
        let uv = disk.uv(ray, hit);
        assert_near(hit.u, 0.75, 1e-6);
        assert_near(uv.x, 0.75, 1e-6);
        assert_near(uv.y, angle, 4e-6);
        let rod = Rod { p0: disk.center, p1: disk.center + Vec3::Z * 4.0, radius: 1.0 };
        let side = Ray::new(rod.p0 + to * 4.0 + Vec3::Z, -to);
        let uv = rod.uv(side, rod.intersect(side));
        assert_near(uv.x, angle, 4e-6);
        assert_near(uv.y, 0.25, 2e-6);
    }
}

/// From inside, the far end is hit; through a cap, its normal is that of the axis.
#[test]
fn caps_of_cylinders() {
    let rod = Rod { p0: Vec3::ZERO, p1: Vec3::Z * 2.0, radius: 1.0 };
    for (z, d, t, n) in [
        (-3.0, Vec3::Z, 3.0, -Vec3::Z),
        (0.5, Vec3::Z, 1.5, Vec3::Z),
        (0.5, -Vec3::Z, 0.5, -Vec3::Z),
        (0.5, Vec3::X, 1.0, Vec3::X),
    ] {
        let ray = Ray::new(Vec3::Z * z, d);
        let hit = rod.intersect(ray);
        assert_eq!((hit.is_hit, hit.t, rod.normal(ray, hit)), (true, t, n), "{z} {d}");
    }
}

/// No tree can hold what has no end; slices can.
#[test]
fn planes_are_for_slices() {
    let floor = Plane { normal: Vec3::Y * 2.0, offset: -3.0 };
    let bounds = floor.get_bounds();
    assert_eq!((bounds.min.y, bounds.max.y), (-1.5, -1.5));
    assert_eq!((bounds.min.x, bounds.max.z), (f32::NEG_INFINITY, f32::INFINITY));
    let tilted = Plane { normal: vec3(1.0, 1.0, 0.0), offset: 0.0 };
    assert_eq!(tilted.get_bounds(), Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY));
    let planes = [floor, tilted];
    assert_eq!(Bvh::build(&planes).err(), Some(BuildError::InfiniteBounds { index: 0 }));
    assert_eq!(floor.area(), f32::INFINITY);
    let ray = Ray::new(vec3(5.0, 1.0, 0.0), vec3(0.0, -0.5, 0.0));
    let hit = planes[..].closest_hit(ray);
    assert_eq!((hit.is_hit, hit.t, hit.prim_id), (true, 5.0, 0));
}
