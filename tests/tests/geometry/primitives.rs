//! Primitives of a user's own: with a record, by attribute, cut by planes.

use raydsl::assert_variants_agree;
use raydsl::geometry::{sphere, triangle};
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

/// What a painted ball gives.
#[derive(Clone, Copy, Debug, PartialEq, Type, HitRecord)]
struct PaintedHit {
    color: Vec3,
    hit: Hit,
    facing: f32,
}

#[primitive]
#[derive(Debug)]
struct PaintedBall {
    center: Vec3,
    radius: f32,
    color: Vec3,
}

#[primitive]
impl PaintedBall {
    fn intersect(&self, ray: Ray) -> PaintedHit {
        let hit = sphere::intersect(ray, self.center, self.radius);
        let n = sphere::normal(ray, hit, self.center, self.radius);
        PaintedHit { color: self.color, hit, facing: n.dot(ray.direction) }
    }

    fn get_bounds(&self) -> Aabb {
        sphere::get_bounds(self.center, self.radius)
    }
}

/// 16 bytes, as its members lie.
#[primitive(sphere(center, radius.to_f32()))]
#[derive(Debug)]
struct ColorSphere {
    center: Vec3,
    radius: Unorm8,
    color: [Unorm8; 3],
}

#[kernel]
impl ColorSphere {
    fn rgb(&self) -> Vec3 {
        vec3(self.color[0].to_f32(), self.color[1].to_f32(), self.color[2].to_f32())
    }
}

fn rays(rng: &mut Rng, count: usize) -> Vec<(Ray,)> {
    let ray = |rng: &mut Rng| (Ray::new(rng.point(4.0), rng.point(1.0)),);
    (0..count).map(|_| ray(rng)).collect()
}

fn balls(rng: &mut Rng) -> Vec<PaintedBall> {
    (0..40)
        .map(|_| PaintedBall {
            center: rng.point(3.0),
            radius: rng.range(0.05, 0.8),
            color: rng.point(1.0),
        })
        .collect()
}

/// The record is that of the closest hit, in every variant, with a tree or without.
#[test]
fn records_are_those_of_the_closest_hit() {
    let mut rng = Rng::of("records");
    let balls = balls(&mut rng);
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let rays = rays(&mut rng, 4000);
    let mut hits = 0;
    for (ray,) in &rays {
        let found = bvh.closest_hit(*ray);
        assert_eq!(found.hit, balls[..].closest_hit(*ray).hit);
        if found.hit.is_hit {
            hits += 1;
            let ball = &balls[found.hit.prim_id as usize];
            assert_eq!(found.color, ball.color);
            assert_eq!(found.hit.t, ball.intersect(*ray).hit.t);
        }
    }
    assert!(hits > 400, "{hits} hits of {}", rays.len());
    // Without a hit the other members mean nothing, so no variant may show them.
    let tree = kernel!(|ray: Ray| {
        let found = bvh.closest_hit(ray);
        if found.hit.is_hit {
            (found.color, found.facing, found.hit.prim_id)
        } else {
            (Vec3::ZERO, 0.0, 77)
        }
    });
    assert_variants_agree!(&tree, &rays);
    let prims = &balls[..];
    let slice = kernel!(|ray: Ray| {
        let found = prims.closest_hit(ray);
        if found.hit.is_hit { found.color.x + found.hit.t } else { -1.0 }
    });
    assert_variants_agree!(&slice, &rays);
}

/// Traversal carries the hit alone: the colour is read once, behind the loop.
#[test]
fn the_rest_of_a_record_is_computed_once() {
    let balls = balls(&mut Rng::of("once"));
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let text = kernel!(|ray: Ray| bvh.closest_hit(ray).color).wgsl();
    let walk = text.split("fn bvh_closest_hit").nth(1).expect("a traversal");
    let walk = &walk[..walk.find("\n}\n").expect("its end")];
    assert!(walk.contains("-> Hit {") && walk.contains(").hit;"), "{walk}");
}

#[test]
fn a_shape_by_attribute_is_that_of_the_library() {
    let mut rng = Rng::of("attribute");
    let spheres: Vec<ColorSphere> = (0..60)
        .map(|_| ColorSphere {
            center: rng.point(3.0),
            radius: Unorm8::new(rng.range(0.1, 1.0)),
            color: [0.2, 0.4, 0.6].map(Unorm8::new),
        })
        .collect();
    assert_eq!(size_of::<ColorSphere>(), 16);
    let rays = rays(&mut rng, 4000);
    let bvh = Bvh::build(&spheres).expect("finite bounds");
    for (ray,) in &rays {
        let hit = bvh.closest_hit(*ray);
        assert_eq!(hit, spheres[..].closest_hit(*ray));
        if hit.is_hit {
            let s = &spheres[hit.prim_id as usize];
            assert_eq!(hit.t, sphere::intersect(*ray, s.center, s.radius.to_f32()).t);
            assert_eq!(s.normal(*ray, hit), sphere::normal(*ray, hit, s.center, s.radius.to_f32()));
        }
    }
    let shaded = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        if hit.is_hit {
            let s = bvh.primitive(hit);
            s.rgb() * s.normal(ray, hit).dot(ray.direction).abs()
        } else {
            Vec3::ZERO
        }
    });
    assert_variants_agree!(&shaded, &rays);
}

/// Together the two boxes hold the shape, and each keeps to its side.
fn assert_split(
    (below, above): (Aabb, Aabb),
    whole: Aabb,
    axis: usize,
    at: f32,
    points: impl Iterator<Item = [f64; 3]>,
) {
    assert!(!below.is_valid() || below.max[axis] <= at);
    assert!(!above.is_valid() || above.min[axis] >= at);
    for part in [below, above] {
        assert!(!part.is_valid() || part == part.intersection(whole), "{part:?} in {whole:?}");
    }
    for p in points {
        let holds =
            |b: Aabb| (0..3).all(|i| f64::from(b.min[i]) <= p[i] && p[i] <= f64::from(b.max[i]));
        let at = f64::from(at);
        assert!(p[axis] > at || holds(below), "{p:?} at or below {at} is not in {below:?}");
        assert!(p[axis] < at || holds(above), "{p:?} at or above {at} is not in {above:?}");
    }
}

#[test]
fn cut_spheres_are_in_their_boxes() {
    let mut rng = Rng::of("cut spheres");
    for _ in 0..scaled(20_000) {
        let scale = 10f32.powi(rng.below(8) as i32 - 4);
        let (center, radius) = (rng.point(scale), scale * rng.range(0.0, 2.0));
        let whole = sphere::get_bounds(center, radius);
        let axis = rng.below(3);
        let planes =
            [rng.range(whole.min[axis], whole.max[axis]), center[axis], center[axis] + radius];
        for at in planes {
            let (c, r) = (center.to_array().map(f64::from), f64::from(radius));
            // The poles, the rim of the cut, and points anywhere.
            let mut points = Vec::new();
            for i in 0..6 {
                let mut p = c;
                p[i / 2] += if i % 2 == 0 { r } else { -r };
                points.push(p);
            }
            let d = f64::from(at) - c[axis];
            if d.abs() <= r {
                let rim = (r * r - d * d).sqrt();
                for i in 0..8 {
                    let angle = f64::from(i) * core::f64::consts::FRAC_PI_4;
                    let mut p = c;
                    p[axis] = f64::from(at);
                    p[(axis + 1) % 3] += rim * angle.cos() * (1.0 - 1e-15);
                    p[(axis + 2) % 3] += rim * angle.sin() * (1.0 - 1e-15);
                    points.push(p);
                }
            }
            let parts = sphere::split_primitive(axis, at, center, radius);
            assert_split(parts, whole, axis, at, points.into_iter());
        }
    }
}

#[test]
fn cut_triangles_are_in_their_boxes() {
    let mut rng = Rng::of("cut triangles");
    for _ in 0..scaled(20_000) {
        let far = rng.point(1.0) * 10f32.powi(rng.below(6) as i32 - 2);
        let v = [(); 3].map(|()| far + rng.point(1.0));
        let whole = triangle::get_bounds(v[0], v[1], v[2]);
        let axis = rng.below(3);
        for at in [rng.range(whole.min[axis], whole.max[axis]), v[0][axis]] {
            let vertices = v.map(|v| v.to_array().map(f64::from));
            let mut points = vertices.to_vec();
            // Where the edges cross the plane, in f64.
            for i in 0..3 {
                let (a, b) = (vertices[i], vertices[(i + 1) % 3]);
                let s = (f64::from(at) - a[axis]) / (b[axis] - a[axis]);
                if s > 0.0 && s < 1.0 {
                    let mut p = core::array::from_fn(|k| a[k] + (b[k] - a[k]) * s);
                    p[axis] = f64::from(at);
                    points.push(p);
                }
            }
            let parts = triangle::split_primitive(axis, at, v[0], v[1], v[2]);
            assert_split(parts, whole, axis, at, points.into_iter());
        }
    }
}

/// A sphere of a thousandth, 65536 away: the distance cannot tell its front from its back, the
/// normal can.
#[test]
fn normals_of_far_spheres() {
    let (center, radius) = (vec3(3.0 / 4096.0, 0.0, 65536.0), 1.0 / 1024.0);
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    let hit = sphere::intersect(ray, center, radius);
    assert!(hit.is_hit);
    let n = sphere::normal(ray, hit, center, radius);
    assert!((n - vec3(-0.75, 0.0, -0.661_437_8)).length() < 1e-5, "{n}");
}

/// Points of a surface are where their parameters say, and fill it evenly.
#[test]
fn points_of_surfaces() {
    let mut rng = Rng::of("points of surfaces");
    let (v0, v1, v2) = (vec3(1.0, 0.0, 0.5), vec3(3.0, 1.0, 0.0), vec3(0.0, 2.0, 1.0));
    let (center, radius) = (vec3(1.0, -2.0, 0.5), 1.5);
    let count = 100_000;
    let (mut on_triangle, mut on_sphere) = (Vec3::ZERO, Vec3::ZERO);
    for _ in 0..count {
        let u = vec2(rng.range(0.0, 1.0), rng.range(0.0, 1.0));
        let p = triangle::sample(u, v0, v1, v2);
        assert!((p.position - v0).dot(p.normal).abs() < 1e-6);
        on_triangle += p.position / count as f32;
        let p = sphere::sample(u, center, radius);
        assert!(((p.position - center).length() - radius).abs() < 1e-6 * radius * 4.0);
        on_sphere += p.position / count as f32;
    }
    // Their means are the centres of gravity; 5 standard deviations.
    assert!((on_triangle - (v0 + v1 + v2) / 3.0).length() < 5.0 * 1.0 / (count as f32).sqrt());
    assert!((on_sphere - center).length() < 5.0 * radius / (count as f32).sqrt());
    assert_eq!(triangle::area(Vec3::ZERO, Vec3::X * 3.0, Vec3::Y * 4.0), 6.0);
    assert!((sphere::area(center, 1.0) - 12.566_371).abs() < 1e-5);
}

/// Any of three kinds.
#[primitive]
#[derive(Debug)]
enum Shape {
    Ball(Ball),
    Facet(Triangle),
    Color(ColorSphere),
}

#[primitive(sphere(center, radius))]
#[derive(Debug)]
struct Ball {
    radius: f32,
    center: Vec3,
}

fn shapes(rng: &mut Rng, kinds: &[usize]) -> Vec<Shape> {
    (0..90)
        .map(|i| match kinds[i % kinds.len()] {
            0 => Shape::Ball(Ball { center: rng.point(3.0), radius: rng.range(0.1, 0.6) }),
            1 => {
                let [v0, v1, v2] = [(); 3].map(|()| rng.point(3.0));
                Shape::Facet(Triangle { v0, v1, v2 })
            }
            _ => Shape::Color(ColorSphere {
                center: rng.point(3.0),
                radius: Unorm8::new(rng.range(0.1, 1.0)),
                color: [0.25; 3].map(Unorm8::new),
            }),
        })
        .collect()
}

#[test]
fn an_enum_of_primitives_is_a_primitive() {
    let mut rng = Rng::of("enum");
    let all = shapes(&mut rng, &[0, 1, 2]);
    let bvh = Bvh::build(&all).expect("finite bounds");
    let rays = rays(&mut rng, 4000);
    let mut hits = [0; 3];
    for (ray,) in &rays {
        let hit = bvh.closest_hit(*ray);
        let mut best = Hit::miss();
        for (id, shape) in all.iter().enumerate() {
            let own = match shape {
                Shape::Ball(b) => b.intersect(*ray),
                Shape::Facet(t) => t.intersect(*ray),
                Shape::Color(s) => s.intersect(*ray),
            };
            if own.is_hit && (!best.is_hit || own.t < best.t) {
                best = Hit { prim_id: id as u32, ..own };
            }
        }
        assert_eq!(hit, best);
        if hit.is_hit {
            hits[hit.prim_id as usize % 3] += 1;
        }
    }
    assert!(hits.iter().all(|n| *n > 100), "{hits:?}");
    let tree = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        (hit.is_hit, hit.t * hit.is_hit as u32 as f32, hit.prim_id, bvh.any_hit(ray))
    });
    assert_variants_agree!(&tree, &rays);
    let few = &all[..12];
    let slice = kernel!(|ray: Ray| {
        let hit = few.closest_hit(ray);
        if hit.is_hit { hit.prim_id + few.any_hit(ray) as u32 } else { 1000u32 }
    });
    assert_variants_agree!(&slice, &rays);
}

/// The WGSL of a scene has the kinds that are in it.
#[test]
fn the_text_has_no_other_kind() {
    let mut rng = Rng::of("kinds");
    let text = |kinds: &[usize], rng: &mut Rng| {
        let shapes = shapes(rng, kinds);
        let bvh = Bvh::build(&shapes).expect("finite bounds");
        kernel!(|ray: Ray| bvh.closest_hit(ray)).wgsl()
    };
    let (spheres, triangles) = (text(&[0], &mut rng), text(&[1], &mut rng));
    let both = text(&[0, 1], &mut rng);
    assert!(spheres.contains("per_d2") && !spheres.contains("axis_last"), "{spheres}");
    assert!(!triangles.contains("per_d2") && triangles.contains("axis_last"), "{triangles}");
    assert!(both.contains("per_d2") && both.contains("axis_last"));
    // With one kind there is nothing to ask.
    assert!(!spheres.contains(".kind =="), "{spheres}");
    assert!(both.contains(".kind =="), "{both}");
}

/// So has that of a scene whose primitives give a record.
#[primitive]
enum Painted {
    Ball(PaintedBall),
    Facet(PaintedFacet),
}

#[primitive]
struct PaintedFacet {
    facet: [Vec3; 3],
}

#[primitive]
impl PaintedFacet {
    fn intersect(&self, ray: Ray) -> PaintedHit {
        let [v0, v1, v2] = self.facet;
        PaintedHit { color: v0, hit: triangle::intersect(ray, v0, v1, v2), facing: 1.0 }
    }

    fn get_bounds(&self) -> Aabb {
        triangle::get_bounds(self.facet[0], self.facet[1], self.facet[2])
    }
}

#[test]
fn the_text_of_records_has_no_other_kind() {
    let mut rng = Rng::of("kinds of records");
    let mut all: Vec<Painted> = balls(&mut rng).into_iter().map(Painted::Ball).collect();
    let text = |all: &[Painted]| {
        let bvh = Bvh::build(all).expect("finite bounds");
        kernel!(|ray: Ray| bvh.closest_hit(ray).color).wgsl()
    };
    assert!(!text(&all).contains("axis_last"));
    all.push(Painted::Facet(PaintedFacet { facet: [Vec3::X, Vec3::Y, Vec3::Z] }));
    assert!(text(&all).contains("axis_last"));
}

#[test]
fn words_come_back() {
    let mut rng = Rng::of("words");
    for shape in shapes(&mut rng, &[0, 1, 2]) {
        let mut bytes = vec![0; Shape::SCHEMA.size()];
        shape.write(&mut bytes);
        assert_eq!(format!("{shape:?}"), format!("{:?}", Shape::read(&bytes)));
    }
}

/// What a kernel does with a kind is chosen by `match`.
#[kernel]
fn paint(shape: Shape, ray: Ray, hit: Hit) -> Vec3 {
    match shape {
        Shape::Ball(ball) => ball.normal(ray, hit).abs(),
        Shape::Facet(facet) => vec3(hit.u, hit.v, facet.area()),
        Shape::Color(sphere) => sphere.rgb(),
    }
}

#[test]
fn kinds_are_matched() {
    let mut rng = Rng::of("kinds are matched");
    let all = shapes(&mut rng, &[0, 1, 2]);
    let bvh = Bvh::build(&all).expect("finite bounds");
    let rays = rays(&mut rng, 3000);
    let painted = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        if hit.is_hit { paint(bvh.primitive(hit), ray, hit) } else { Vec3::ZERO }
    });
    for (ray,) in &rays {
        let hit = bvh.closest_hit(*ray);
        if hit.is_hit && hit.prim_id % 3 == 2 {
            assert_eq!(
                painted.call((*ray,)),
                vec3(0.25, 0.25, 0.25).map(|x| Unorm8::new(x).to_f32())
            );
        }
    }
    assert_variants_agree!(&painted, &rays);
}
