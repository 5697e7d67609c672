//! Rays that leave surfaces, and rays between two: what they must not meet, and that all variants
//! make the same ones.

use raydsl::assert_variants_agree;
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::hard_rays::bounces::{Ball, from_frame, local};
use raydsl_tests::hard_rays::mesh::Icosphere;
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

/// Rays for comparing variants.
const RAYS: usize = 2000;
/// Pairs of points that rays run between.
const PAIRS: usize = 1_000_000;

/// The point of a triangle that a ray hits, its error, and where a ray begins that leaves it.
#[kernel]
fn leaving_triangle(ray: Ray, corner: Vec3, direction: Vec3) -> (Vec3, f32, Vec3) {
    let triangle = Triangle {
        v0: corner,
        v1: corner + vec3(1.0, 0.25, 0.0),
        v2: corner + vec3(0.0, 1.0, 0.5),
    };
    let point = triangle.surface_point(ray, triangle.intersect(ray));
    let next = point.ray(direction);
    (point.position, point.error, next.origin)
}

/// Where a ray begins that leaves a sphere, a ray from there to another sphere, and one to a point.
#[kernel]
fn leaving_sphere(ray: Ray, center: Vec3, direction: Vec3) -> (Vec3, Vec3, Vec3, f32) {
    let hit = sphere::intersect(ray, center, 0.75);
    let point = sphere::surface_point(ray, hit, center, 0.75);
    let light = sphere::sample(vec2(0.25, 0.625), center + direction, 0.25);
    let shadow = point.ray_between(light);
    let origin = offset_origin(point.position, point.normal, point.error, direction);
    (origin, shadow.origin, shadow.direction, point.ray_to(direction).t_max)
}

/// Rays at something of size 1 next to a point.
fn inputs(name: &str) -> Vec<(Ray, Vec3, Vec3)> {
    let mut rng = Rng::of(name);
    let input = |_| {
        let corner = rng.point(100.0);
        let origin = corner + rng.direction() * 4.0;
        let target = corner + vec3(0.3, 0.4, 0.2) + rng.point(0.4);
        (Ray::new(origin, target - origin), corner, rng.direction() * 3.0)
    };
    (0..scaled(RAYS) | 1).map(input).collect()
}

#[test]
fn variants_agree() {
    assert_variants_agree!(leaving_triangle, &inputs("triangles"));
    assert_variants_agree!(leaving_sphere, &inputs("spheres"));
}

/// Indexed triangles give the points of triangles, bit for bit.
#[test]
fn indexed_triangles_are_triangles() {
    let mesh = Icosphere::new(vec3(30.0, -7.0, 1.0), 2.0);
    let triangles = mesh.triangles();
    let indexed: Vec<IndexedTriangle> =
        mesh.faces.iter().map(|&vertices| IndexedTriangle { vertices }).collect();
    let mut rng = Rng::of("indexed");
    for (triangle, indexed) in triangles.iter().zip(&indexed) {
        let origin = mesh.inside(&mut rng);
        let ray = Ray::new(origin, (triangle.v0 + triangle.v1 + triangle.v2) / 3.0 - origin);
        let hit = triangle.intersect(ray);
        assert!(hit.is_hit);
        let point = indexed.surface_point(ray, hit, &mesh.vertices);
        assert_eq!(point, triangle.surface_point(ray, hit));
    }
}

/// Points of two surfaces see each other: neither stands in the way, however far and grazing.
#[test]
fn lights_do_not_shade_themselves() {
    let mut rng = Rng::of("lights");
    let (mut seen, mut shaded) = (0, 0);
    for _ in 0..scaled(PAIRS) {
        let size = rng.pick(&[0.0, 10.0, 1e4]);
        let offset = rng.point(size);
        let far = 10.0f32.powf(rng.range(0.5, 3.0));
        let corner = |rng: &mut Rng, at: Vec3| {
            let mut point = || at + rng.point(1.0);
            Triangle { v0: point(), v1: point(), v2: point() }
        };
        let way = rng.direction().normalize() * far;
        let (floor, lamp) = (corner(&mut rng, offset), corner(&mut rng, offset + way));
        let u = |rng: &mut Rng| vec2(rng.unit(), rng.unit());
        let (from, to) = (floor.sample(u(&mut rng)), lamp.sample(u(&mut rng)));
        if [&floor, &lamp].iter().any(|t| is_sliver(t)) {
            continue;
        }
        let ray = from.ray_between(to);
        let between = ray.at(0.5);
        let across = ray.direction.any_orthonormal_pair();
        let half = 0.01 * far;
        let wall = Triangle {
            v0: between - (across.0 + across.1) * half,
            v1: between + across.0 * half,
            v2: between + across.1 * half,
        };
        seen += 1;
        assert!(![floor, lamp][..].any_hit(ray), "{floor:?} {lamp:?} {from:?} {to:?} {ray:?}");
        shaded += usize::from([floor, lamp, wall][..].any_hit(ray));
    }
    assert!(seen > 0 && shaded == seen, "{shaded} of {seen} walls stand in the way");
}

/// Whether rounding says more about a triangle's plane than its vertices do.
fn is_sliver(t: &Triangle) -> bool {
    let (a, b) = (t.v1 - t.v0, t.v2 - t.v0);
    a.cross(b).length() < 0.05 * a.length() * b.length()
}

/// A ball that is a light; and one that stands in a point light's place.
#[test]
fn balls_do_not_shade_themselves() {
    let mut rng = Rng::of("balls");
    for _ in 0..scaled(PAIRS) {
        let far = 10.0f32.powf(rng.range(0.6, 3.0));
        let size = rng.pick(&[0.0, 100.0, 1e5]);
        let center = rng.point(size);
        let radius = 10.0f32.powf(rng.range(-1.0, 0.0));
        let other = center + rng.direction().normalize() * far;
        let balls = [Ball { center, radius }, Ball { center: other, radius: 0.5 }];
        let u = |rng: &mut Rng| vec2(rng.unit(), rng.unit());
        let (from, to) = (balls[0].sample(u(&mut rng)), balls[1].sample(u(&mut rng)));
        let way = to.position - from.position;
        // Sides that face away do not see each other.
        let cosines = [from.normal.dot(way), to.normal.dot(-way)].map(|c| c / way.length());
        if cosines[0] > 0.0 && cosines[1] > 0.0 {
            let ray = from.ray_between(to);
            assert!(!balls[..].any_hit(ray), "{balls:?} {from:?} {to:?} {ray:?}");
            let ray = from.ray_to(to.position);
            assert!(ray.t_max < 1.0 && ray.t_max > 0.999_99);
            assert!(!balls[..1].any_hit(ray), "{balls:?} {from:?} {ray:?}");
        }
    }
}

/// A ray that leaves a large ball far away does not come back, however grazing.
#[test]
fn directions_may_graze() {
    let mut rng = Rng::of("grazing");
    let ball = Ball { center: vec3(1e5, 2e4, -3e4), radius: 1e4 };
    for _ in 0..scaled(PAIRS) {
        let point = ball.sample(vec2(rng.unit(), rng.unit()));
        let outwards = local(&mut rng);
        let outwards = vec3(outwards.x, outwards.y, outwards.z.abs());
        let ray = point.ray(from_frame(point.normal, outwards));
        let cosine = ray.direction.dot(point.normal) / ray.direction.length();
        assert!(cosine < 1e-6 || ![ball][..].any_hit(ray), "{point:?} {ray:?}");
    }
}
