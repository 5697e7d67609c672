//! Shapes: their points, samples, coordinates and errors.

use glam::DVec3;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;

use super::Chest;

#[primitive(cylinder(p0, p1, radius))]
struct Rod {
    p0: Vec3,
    p1: Vec3,
    radius: f32,
}

#[primitive(tube(p0, p1, radius))]
struct Pipe {
    p0: Vec3,
    p1: Vec3,
    radius: f32,
}

#[primitive(plane(normal, offset))]
#[derive(Debug)]
struct Floor {
    normal: Vec3,
    offset: f32,
}

#[test]
fn half_areas_are_sums_of_three_faces() {
    let bounds = Aabb::new(vec3(1.0, 2.0, 3.0), vec3(3.0, 5.0, 8.0));
    assert_eq!(bounds.half_area(), 2.0 * 3.0 + 3.0 * 5.0 + 5.0 * 2.0);
    let flat = Aabb::new(Vec3::ZERO, vec3(4.0, 0.0, 0.5));
    assert_eq!(flat.half_area(), 2.0);
    assert_eq!(Aabb::EMPTY.half_area(), 0.0);
}

/// The second coordinate of a tube and of a cylinder is the height of the hit over the first end.
#[test]
fn heights_of_hits_are_coordinates() {
    let mut rng = Rng::of("heights");
    let mut hits = 0;
    for _ in 0..2000 {
        let (p0, p1) = (rng.point(2.0), rng.point(2.0));
        let axis = (p1 - p0).as_dvec3();
        if axis.length() < 0.3 {
            continue;
        }
        let (tube, rod) = (Pipe { p0, p1, radius: 0.5 }, Rod { p0, p1, radius: 0.5 });
        let origin = rng.direction() * 6.0;
        let ray = Ray::new(origin, (p0 + p1) * 0.5 + rng.point(0.6) - origin);
        let height = |t: f32| {
            let at: DVec3 = ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(t);
            (at - p0.as_dvec3()).dot(axis) / axis.length_squared()
        };
        let (of_tube, of_rod) = (tube.intersect(ray), rod.intersect(ray));
        let found = [(of_tube, tube.uv(ray, of_tube)), (of_rod, rod.uv(ray, of_rod))];
        for (i, (hit, uv)) in found.into_iter().enumerate() {
            // A cylinder's caps have coordinates of their own.
            let height = height(hit.t);
            if hit.is_hit && height > 1e-3 && height < 1.0 - 1e-3 {
                hits += 1;
                let off = (f64::from(uv.y) - height).abs();
                assert!(off < 2e-5, "{i}: {off} from {height} of {ray:?} at {p0} to {p1}");
            }
        }
    }
    assert!(hits > 1000, "{hits}");
}

/// The point of a plane lies on it to within its error, also far away and through the world's origin.
#[test]
fn points_of_planes_are_within_their_error() {
    let mut rng = Rng::of("planes");
    let (mut hits, mut worst): (u32, f64) = (0, 0.0);
    for _ in 0..5000 {
        let floor = Floor { normal: rng.direction(), offset: rng.pick(&[0.0, 0.3, -40.0, 1e4]) };
        let origin = rng.direction() * rng.pick(&[1.0, 50.0, 2e3]);
        let ray = Ray::new(origin, rng.direction());
        let hit = floor.intersect(ray);
        if !hit.is_hit || hit.t > 1e6 {
            continue;
        }
        hits += 1;
        let point = floor.surface_point(ray, hit);
        let normal = floor.normal.as_dvec3();
        let off = point.position.as_dvec3().dot(normal) - f64::from(floor.offset);
        let share = (off / normal.length()).abs() / f64::from(point.error);
        assert!(share <= 1.0, "{share} of the error: {floor:?} {ray:?} {point:?}");
        worst = worst.max(share);
    }
    assert!(hits > 1000, "{hits}");
    // A bound that is never approached would be of no use.
    assert!(worst > 0.01, "{worst}");
}

/// A triangle with collinear vertices has no inside, also where rounding lets a ray pass on one side of
/// all edges.
#[test]
fn lines_are_not_hit() {
    let mut rng = Rng::of("lines");
    let mut near = 0;
    for _ in 0..20_000 {
        // Exact: sums of small multiples of a short step.
        let whole = |v: Vec3| (v * 64.0).round();
        let (start, step) = (whole(rng.point(8.0)), whole(rng.point(1.0)));
        let [v0, v1, v2] = [0.0, 3.0, 7.0].map(|i| start + step * i);
        let origin = rng.point(1e3);
        let on_line = start + step * rng.range(0.0, 7.0);
        let ray = Ray::new(origin, (on_line - origin) * rng.range(0.3, 3.0));
        let line = Triangle { v0, v1, v2 };
        assert!(!line.intersect(ray).is_hit, "{line:?} {ray:?}");
        // One vertex moved aside by the least number makes it a sliver, which may be hit.
        let sliver = Triangle { v0, v1: v1 + vec3(0.0, 0.0, 1e-4 * (1.0 + v1.z.abs())), v2 };
        near += u32::from(sliver.intersect(ray).is_hit);
    }
    assert!(near > 100, "{near}");
}

/// The point of a long thin cylinder lies on it to within its error, also where the ends are opposite.
#[test]
fn points_of_cylinders_are_within_their_error() {
    let mut rng = Rng::of("cylinders");
    let (mut hits, mut worst): (u32, f64) = (0, 0.0);
    for _ in 0..5000 {
        let end = rng.direction() * rng.pick(&[1.0, 30.0, 1e3]);
        let rod = Rod { p0: -end, p1: end, radius: rng.pick(&[0.5, 0.01]) };
        let target = end * rng.range(-0.9, 0.9);
        let origin = target + rng.direction() * rng.pick(&[1.0, 10.0]);
        let ray = Ray::new(origin, target + rng.point(rod.radius) - origin);
        let hit = rod.intersect(ray);
        let axis = end.as_dvec3().normalize();
        let normal = rod.normal(ray, hit);
        // Its caps are planes.
        if !hit.is_hit || normal.as_dvec3().dot(axis).abs() > 0.5 {
            continue;
        }
        hits += 1;
        let point = rod.surface_point(ray, hit);
        let at = point.position.as_dvec3();
        let off = (at - axis * at.dot(axis)).length() - f64::from(rod.radius);
        let share = off.abs() / f64::from(point.error);
        assert!(share <= 1.0, "{share} of the error: {ray:?} {point:?} {end}");
        worst = worst.max(share);
    }
    assert!(hits > 1000, "{hits}");
    assert!(worst > 0.01, "{worst}");
}

/// A sampled point of a box is on a face, and says an error of few roundings.
#[test]
fn samples_of_boxes_are_on_their_faces() {
    let chest = Chest { min: vec3(-1.0, 2.0, 0.5), max: vec3(2.0, 2.5, 4.0) };
    let mut rng = Rng::of("boxes");
    for _ in 0..2000 {
        let point = chest.sample(vec2(rng.unit(), rng.unit()));
        let p = point.position;
        let to_face = (p - chest.min).abs().min((p - chest.max).abs()).min_element();
        assert!(to_face <= point.error && point.error < 1e-5, "{point:?}");
        assert!(p.cmpge(chest.min - 1e-6).all() && p.cmple(chest.max + 1e-6).all());
    }
}
