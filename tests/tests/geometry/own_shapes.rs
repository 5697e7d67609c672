//! The shapes of the examples `torus` and `hair` against `f64`, and the WGSL that the book shows.
//!
//! `RAYDSL_BLESS=1` rewrites `book/src/generated/torus.wgsl`.

use hair::Hair;
use raydsl::assert_variants_agree;
use raydsl::prelude::*;
use raydsl_tests::check::every_variant;
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;
use torus::Torus;

#[path = "../../../examples/hair/shape.rs"]
mod hair;
#[path = "../../../examples/torus/shape.rs"]
mod torus;

type D3 = [f64; 3];

fn wide(v: Vec3) -> D3 {
    v.to_array().map(f64::from)
}

fn dot(a: D3, b: D3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn plus(a: D3, b: D3, s: f64) -> D3 {
    std::array::from_fn(|i| a[i] + b[i] * s)
}

fn length(a: D3) -> f64 {
    dot(a, a).sqrt()
}

/// `ray` in `f64`, with a direction of length 1 and what that is multiplied by.
struct Wide {
    origin: D3,
    direction: D3,
    scale: f64,
}

impl Wide {
    fn new(ray: Ray) -> Self {
        let d = wide(ray.direction);
        let scale = length(d);
        Self { origin: wide(ray.origin), direction: d.map(|x| x / scale), scale }
    }

    fn at(&self, s: f64) -> D3 {
        plus(self.origin, self.direction, s)
    }
}

/// From the ray's origin to the farthest corner of the box: what `SLACK` is relative to.
fn farthest(ray: Ray, bounds: Aabb) -> f64 {
    let (o, low, high) = (wide(ray.origin), wide(bounds.min), wide(bounds.max));
    length(std::array::from_fn(|i| (low[i] - o[i]).abs().max((high[i] - o[i]).abs())))
}

/// How far a point is from a ring's surface; negative inside.
fn distance(ring: &Torus, p: D3) -> f64 {
    let axis = wide(ring.axis);
    let axis = axis.map(|x| x / length(axis));
    let p = plus(p, wide(ring.center), -1.0);
    let height = dot(p, axis);
    let aside = length(plus(p, axis, -height)) - f64::from(ring.major);
    aside.hypot(height) - f64::from(ring.minor)
}

fn random_ring(rng: &mut Rng, scale: f32) -> Torus {
    let major = scale * rng.range(0.2, 2.0);
    // From wires to what hardly has a hole.
    let minor = major * rng.pick(&[0.001, 0.02, 0.19, 0.6, 0.9, 0.999]);
    Torus { center: rng.point(3.0 * scale), major, axis: rng.direction().normalize(), minor }
}

/// A ray that comes near the ring, from inside or from far away.
fn random_ray(rng: &mut Rng, ring: &Torus) -> Ray {
    let reach = ring.major + ring.minor;
    let far = reach * rng.pick(&[0.3, 1.0, 4.0, 100.0, 1000.0]);
    let origin = ring.center + rng.direction().normalize() * far;
    let (x, y) = ring.axis.any_orthonormal_pair();
    let angle = rng.range(0.0, 7.0);
    let circle = ring.center + (x * angle.cos() + y * angle.sin()) * ring.major;
    let spread = rng.pick(&[1.2 * ring.minor, reach]);
    let aim = circle + rng.point(spread);
    let ray = Ray::new(origin, (aim - origin) * rng.pick(&[1e-4, 1.0, 300.0]));
    ray.with_range(rng.pick(&[0.0, 0.0, 0.9, 1.0]) * distance_to(origin, aim, ray), f32::MAX)
}

fn distance_to(origin: Vec3, aim: Vec3, ray: Ray) -> f32 {
    (aim - origin).length() / ray.direction.length()
}

/// The first place at or behind `from` where the ray is closer to the surface than `near`, up to
/// `to`. The distance is never larger than the way that is left, so no root is passed over.
fn first_root(ring: &Torus, ray: &Wide, from: f64, to: f64, near: f64) -> Option<f64> {
    let mut s = from;
    while s <= to {
        let d = distance(ring, ray.at(s)).abs();
        if d < near {
            return Some(s);
        }
        s += d;
    }
    None
}

#[test]
fn a_ring_is_hit_where_f64_says() {
    let mut rng = Rng::of("rings in f64");
    let (mut hits, mut worst) = (0, 0.0f64);
    for _ in 0..scaled(40_000) {
        let scale = 10f32.powi(rng.pick(&[-12, -3, 0, 0, 0, 3, 12]));
        let ring = random_ring(&mut rng, scale);
        let ray = random_ray(&mut rng, &ring);
        let line = Wide::new(ray);
        let bounds = ring.get_bounds();
        let slack = f64::from(Torus::SLACK) * farthest(ray, bounds);
        let hit = ring.intersect(ray);
        let from = f64::from(ray.t_min) * line.scale;
        let middle = dot(plus(wide(ring.center), line.origin, -1.0), line.direction);
        let reach = f64::from(ring.major) + f64::from(ring.minor);
        let mut to = middle + 1.01 * reach;
        if hit.is_hit {
            hits += 1;
            to = f64::from(hit.t) * line.scale;
            let error = distance(&ring, line.at(to)).abs() / farthest(ray, bounds);
            worst = worst.max(error);
            assert!(error < f64::from(Torus::SLACK), "{error:e}: {ring:?} {ray:?} {hit:?}");
        }
        // Before the hit the ray is on one side, but for as much as rounding hides.
        let start = from.max(middle - 1.01 * reach);
        let mut side = 0.0;
        for i in 0..400 {
            let d = distance(&ring, line.at(start + (to - start) * f64::from(i) / 400.0));
            if d.abs() > slack && start < to {
                let is_same = side * d >= 0.0;
                assert!(is_same, "passes {d:e} for {slack:e}: {ring:?} {ray:?} {hit:?}");
                side = d.signum();
            }
        }
        if !hit.is_hit
            && let Some(s) = first_root(&ring, &line, start, to, 0.01 * slack)
        {
            // What is missed is only touched.
            let place = |i: i32| s + (to - s) * f64::from(i) / 400.0;
            let depths = (0..400).map(|i| distance(&ring, line.at(place(i))));
            let deepest = depths.fold(f64::INFINITY, f64::min);
            assert!(deepest > -slack, "missed {s}: {ring:?} {ray:?}");
        }
    }
    println!("{hits} hits, off by up to {worst:e}, 2^{:.1}", worst.log2());
    assert!(hits > scaled(40_000) / 4, "{hits} hits");
}

#[test]
fn a_ring_has_up_to_four_roots() {
    let mut rng = Rng::of("four roots");
    let mut seen = [0; 5];
    for _ in 0..scaled(5000) {
        let ring = Torus {
            center: rng.point(1.0),
            major: 1.0,
            axis: rng.direction().normalize(),
            minor: 0.2,
        };
        let origin = rng.point(4.0);
        let ray = Ray::new(origin, ring.center + rng.point(1.0) - origin);
        let mut found = Vec::new();
        let mut from = -1e30;
        loop {
            let hit = ring.intersect(ray.with_range(from, f32::MAX));
            if !hit.is_hit {
                break;
            }
            // The same root for every range that holds it.
            for t_min in [from, 0.5 * (f32::max(from, hit.t - 1.0) + hit.t), hit.t] {
                assert_eq!(ring.intersect(ray.with_range(t_min, f32::MAX)), hit);
            }
            from = hit.t.next_up();
            found.push(hit.t);
        }
        assert!(found.len() <= 4, "{ring:?} {ray:?} {found:?}");
        seen[found.len()] += 1;
    }
    assert!(seen[0] > 100 && seen[2] > 100 && seen[4] > 100, "{seen:?}");
    // A line that begins outside leaves as often as it enters, unless it only touches.
    assert!(seen[1] + seen[3] < 5, "{seen:?}");
}

/// Both roots of a quartic that is known to 17 digits, in every variant.
#[test]
fn the_roots_of_a_known_quartic() {
    let rings = [Torus { center: Vec3::ZERO, major: 2.0, axis: Vec3::Z, minor: 0.5 }];
    let bvh = Bvh::build(&rings).expect("one ring");
    let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray).t);
    let ray = Ray::new(vec3(0.25, 0.125, 4.0), vec3(0.375, 0.0625, -1.0));
    let rays = [(ray,), (ray.with_range(4.0, f32::MAX),)];
    assert_variants_agree!(&kernel, &rays);
    for (args, root) in rays.into_iter().zip([3.639_993_730_335_53, 4.499_578_443_815_823]) {
        let off = |t: f64| (t / root - 1.0).abs();
        assert!(off(f64::from(kernel.call(args))) <= 2e-6, "{} {root}", kernel.call(args));
        let wide = kernel.reference(args);
        assert!(off(wide[0]) <= 1e-12, "{wide:?} {root}");
        println!(
            "{root}: off by {:e}, in f64 by {:e}",
            off(kernel.call(args).into()),
            off(wide[0])
        );
    }
}

#[test]
fn rings_that_are_none() {
    let ring = Torus { center: vec3(0.5, 1.0, -2.0), major: 1.0, axis: Vec3::Y, minor: 0.25 };
    let down = |x: f32| Ray::new(vec3(0.5 + x, 5.0, -2.0), -Vec3::Y);
    // Through the hole, along the axis; and along it into the tube, from above and from within.
    assert!(!ring.intersect(down(0.0)).is_hit && !ring.intersect(down(0.7)).is_hit);
    assert_eq!(ring.intersect(down(1.0)).t, 3.75);
    assert_eq!(ring.intersect(down(-1.0).with_range(4.0, 9.0)).t, 4.25);
    // In the plane of the circle, through all four sides.
    let across = Ray::new(vec3(-2.5, 1.0, -2.0), Vec3::X);
    for (after, t) in [(0.0, 1.75), (2.0, 2.25), (2.5, 3.75), (4.0, 4.25), (4.5, 0.0)] {
        let hit = ring.intersect(across.with_range(after, 100.0));
        assert!(hit.is_hit == (t > 0.0) && (hit.t - t).abs() < 1e-6, "{hit:?} for {t}");
    }
    // No tube, no hole, no number.
    let sizes = [(1.0, 0.0), (1.0, -0.25), (-1.0, 0.25), (0.0, 0.0), (0.0, 0.25), (1.0, 1.0)];
    for (major, minor) in sizes.into_iter().chain([(f32::NAN, 0.25), (1.0, f32::NAN)]) {
        let none = Torus { major, minor, ..ring };
        assert!(!none.intersect(down(1.0)).is_hit && !none.intersect(across).is_hit);
    }
}

#[test]
fn rings_are_in_their_boxes() {
    let mut rng = Rng::of("rings in boxes");
    for _ in 0..scaled(5000) {
        let scale = 10f32.powi(rng.below(8) as i32 - 4);
        let ring = random_ring(&mut rng, scale);
        let (bounds, axis) = (ring.get_bounds(), wide(ring.axis));
        let axis = axis.map(|x| x / length(axis));
        for i in 0..3 {
            // Where the ring reaches farthest along this axis.
            let mut aside: D3 = axis.map(|a| -a * axis[i]);
            aside[i] += 1.0;
            let size = f64::from(ring.major) * length(aside) + f64::from(ring.minor);
            for (face, sign) in [(bounds.min[i], -1.0), (bounds.max[i], 1.0)] {
                let exact = f64::from(ring.center[i]) + sign * size;
                let beyond = (f64::from(face) - exact) * sign;
                let ulp = f64::from(face.next_up() - face);
                assert!(beyond >= -1e-12 * size && beyond <= 2.5 * ulp, "{beyond:e} {ring:?}");
            }
        }
    }
}

#[test]
fn normals_of_rings() {
    let mut rng = Rng::of("normals of rings");
    let mut seen = 0;
    for _ in 0..scaled(5000) {
        let major = rng.range(0.5, 2.0);
        let axis = rng.direction().normalize();
        let ring = Torus { center: rng.point(1.0), major, axis, minor: 0.3 * major };
        let origin = rng.point(4.0);
        let ray = Ray::new(origin, ring.center + rng.point(1.0) - origin);
        let hit = ring.intersect(ray);
        if !hit.is_hit {
            continue;
        }
        seen += 1;
        let p = Wide::new(ray).at(f64::from(hit.t) * Wide::new(ray).scale);
        // The distance grows along it as fast as the way.
        let n = wide(ring.normal(ray, hit));
        let growth =
            (distance(&ring, plus(p, n, 1e-5)) - distance(&ring, plus(p, n, -1e-5))) / 2e-5;
        assert!((growth - 1.0).abs() < 1e-5 && (length(n) - 1.0).abs() < 1e-6, "{growth}");
    }
    assert!(seen > scaled(5000) / 4);
}

/// Rays towards the middle, from around and from within.
fn rays(rng: &mut Rng, count: usize, size: f32) -> Vec<(Ray,)> {
    let one = |i: usize| {
        let origin = rng.point(if i.is_multiple_of(5) { size } else { 3.0 * size });
        let ray = Ray::new(origin, rng.point(size) - origin);
        let ranges = [ray, ray.with_range(0.4, 1.1), ray.with_range(-1.0, 0.9)];
        (ranges[if i.is_multiple_of(7) { 1 + i % 2 } else { 0 }],)
    };
    (0..count).map(one).collect()
}

/// The tree, the slice and a plain loop give one hit; `hit` is that of a primitive's record.
fn assert_queries<P: Primitive<Shared = ()>>(prims: &[P], rays: &[(Ray,)]) -> usize {
    let bvh = Bvh::build(prims).expect("finite bounds");
    let mut hits = 0;
    for (ray,) in rays {
        let mut best = Hit::miss();
        for (id, prim) in prims.iter().enumerate() {
            let hit = raydsl::geometry::HitRecord::hit(&prim.intersect(*ray, &[]));
            let is_better = !best.is_hit || hit.t < best.t;
            if hit.is_hit && hit.t >= ray.t_min && hit.t <= ray.t_max && is_better {
                best = Hit { prim_id: id as u32, ..hit };
            }
        }
        let found = raydsl::geometry::HitRecord::hit(&bvh.closest_hit(*ray));
        let same = found.is_hit == best.is_hit
            && (!best.is_hit
                || (found.t.to_bits(), found.prim_id) == (best.t.to_bits(), best.prim_id));
        assert!(same, "{found:?} for {best:?} of {ray:?}");
        assert_eq!(bvh.any_hit(*ray), best.is_hit);
        assert_eq!(raydsl::geometry::HitRecord::hit(&prims.closest_hit(*ray)), found);
        hits += usize::from(best.is_hit);
    }
    hits
}

#[test]
fn rings_agree() {
    let mut rng = Rng::of("rings agree");
    let rings: Vec<Torus> = (0..200).map(|_| random_ring(&mut rng, 0.5)).collect();
    let rays = rays(&mut rng, scaled(4000), 2.0);
    let hits = assert_queries(&rings, &rays);
    assert!(hits > rays.len() / 4, "{hits} hits");
    let bvh = Bvh::build(&rings).expect("finite bounds");
    let kernel = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let normal = if hit.is_hit { bvh.primitive(hit).normal(ray, hit) } else { Vec3::ZERO };
        (hit, normal, bvh.any_hit(ray))
    });
    every_variant(&kernel, &rays);
}

/// The curve at `u`.
fn curve(hair: &Hair, u: f64) -> D3 {
    let mut p = hair.control.map(wide);
    for k in 0..3 {
        for j in 0..3 - k {
            p[j] = std::array::from_fn(|i| p[j][i] + (p[j + 1][i] - p[j][i]) * u);
        }
    }
    p[0]
}

fn radius(hair: &Hair, u: f64) -> f64 {
    f64::from(hair.root) * (1.0 - u) + f64::from(hair.tip) * u
}

/// The `u` of the least `f`: of many, and then closer and closer around that.
fn least(f: impl Fn(f64) -> f64) -> (f64, f64) {
    let (mut best, mut width) = ((0.5, f(0.5)), 0.5);
    for count in [2000, 40, 40, 40] {
        let middle = best.0;
        for i in 0..=count {
            let u = middle + width * (2.0 * f64::from(i) / f64::from(count) - 1.0);
            if (0.0..=1.0).contains(&u) && f(u) < best.1 {
                best = (u, f(u));
            }
        }
        width *= 3.0 / f64::from(count);
    }
    best
}

/// A hair that turns by up to about `bend` radians on its way.
fn random_hair(rng: &mut Rng, size: f32, bend: f32) -> Hair {
    let mut direction = rng.direction().normalize();
    let mut at = rng.point(size);
    let mut control = [at; 4];
    for p in &mut control[1..] {
        at += direction * (size * rng.range(0.3, 0.5));
        direction = (direction + rng.direction().normalize() * (0.5 * bend)).normalize();
        *p = at;
    }
    let root = size * rng.pick(&[0.002, 0.01, 0.03]);
    Hair { control, root, tip: root * rng.pick(&[0.1, 0.5, 1.0]) }
}

/// How a hair's answers compare with the least of all distances at which the ray enters a ball of
/// those along the curve.
#[derive(Debug, Default)]
struct Tally {
    hits: u32,
    /// Hits that are not there, or not on the hair, or beside its ends.
    wrong: u32,
    /// Rays that pass far through the hair, between its ends, without a hit.
    lost: u32,
    /// Hits behind the first place where the ray enters.
    late: u32,
}

fn tally(rng: &mut Rng, count: usize, bend: f32) -> Tally {
    let mut tally = Tally::default();
    for _ in 0..count {
        let size = 10f32.powi(rng.pick(&[-6, -2, 0, 0, 2, 6]));
        let hair = random_hair(rng, size, bend);
        let far = size * rng.pick(&[2.0, 20.0, 500.0]);
        let at = curve(&hair, f64::from(rng.range(0.02, 0.98))).map(|x| x as f32);
        let origin = Vec3::from(at) + rng.direction().normalize() * far;
        let aim = Vec3::from(at) + rng.point(1.2 * hair.root);
        let ray = Ray::new(origin, (aim - origin) * rng.pick(&[1e-3, 1.0, 50.0]));
        let (line, slack) =
            (Wide::new(ray), f64::from(Hair::SLACK) * farthest(ray, hair.get_bounds()));
        let beside = |u: f64| {
            let p = plus(curve(&hair, u), line.origin, -1.0);
            length(plus(p, line.direction, -dot(p, line.direction))) - radius(&hair, u)
        };
        let (_, depth) = least(beside);
        let entry = |u: f64| {
            let p = plus(curve(&hair, u), line.origin, -1.0);
            let z = dot(p, line.direction);
            let aside = length(plus(p, line.direction, -z));
            let square = radius(&hair, u).powi(2) - aside * aside;
            if square > 0.0 { z - square.sqrt() } else { f64::INFINITY }
        };
        let (u, z) = least(entry);
        let thick = f64::from(hair.root.min(hair.tip));
        let hit = hair.intersect(ray);
        if hit.hit.is_hit {
            tally.hits += 1;
            let found = f64::from(hit.hit.t) * line.scale;
            let p = line.at(found);
            let on = |u: f64| length(plus(p, curve(&hair, u), -1.0)) - radius(&hair, u);
            let distance = on(f64::from(hit.share)).abs();
            // A disc across the curve is not a ball where the hair gets thinner.
            let off = slack + 0.02 * f64::from(hair.root);
            tally.wrong += u32::from(distance > off || least(on).1.abs() > off || depth > slack);
            let is_clear = depth < -0.1 * thick - slack && (0.02..0.98).contains(&u);
            tally.late +=
                u32::from(is_clear && found > z + 2.0 * f64::from(hair.root) + 20.0 * slack);
        } else {
            let is_through = depth < -0.1 * thick - slack && (0.02..0.98).contains(&u);
            tally.lost += u32::from(is_through && z.is_finite());
        }
    }
    tally
}

/// Of hairs that bend gently hardly a hit is lost, of hairs that are curled a few are.
#[test]
fn a_hair_is_hit_where_f64_says() {
    let mut rng = Rng::of("hairs in f64");
    let count = scaled(4000);
    for (bend, lost) in [(0.1, 0.0005), (0.5, 0.0005), (1.0, 0.001), (2.0, 0.01)] {
        let tally = tally(&mut rng, count, bend);
        println!("bend {bend}: {tally:?} of {count}");
        assert!(tally.hits > count as u32 / 4 && tally.wrong == 0, "{tally:?}");
        assert!(f64::from(tally.lost + tally.late) < lost * count as f64 + 1.5, "{tally:?}");
    }
}

#[test]
fn hairs_that_are_none() {
    let points = [0.0, 1.0, 2.0, 3.0].map(|x| vec3(x, 0.0, 0.0));
    let hair = Hair { control: points, root: 0.1, tip: 0.1 };
    let across = Ray::new(vec3(1.5, 0.0, 2.0), -Vec3::Z);
    let hit = hair.intersect(across);
    assert!(hit.hit.is_hit && (hit.hit.t - 1.9).abs() < 1e-6 && (hit.share - 0.5).abs() < 1e-4);
    assert_eq!(hit.tangent, Vec3::X);
    // Behind the ray, before its range, and around its origin.
    assert!(!hair.intersect(Ray::new(vec3(1.5, 0.0, -2.0), -Vec3::Z)).hit.is_hit);
    assert!(!hair.intersect(across.with_range(1.95, 9.0)).hit.is_hit);
    assert!(!hair.intersect(Ray::new(vec3(1.5, 0.05, 0.0), -Vec3::Z)).hit.is_hit);
    // Along the axis: its ends are open.
    for y in [0.0, 0.05, 0.2] {
        assert!(!hair.intersect(Ray::new(vec3(-2.0, y, 0.0), Vec3::X)).hit.is_hit);
    }
    // But a hair that gets thicker is seen from its thin end.
    let horn = Hair { root: 0.01, ..hair };
    let hit = horn.intersect(Ray::new(vec3(-2.0, 0.055, 0.0), Vec3::X)).hit;
    assert!(hit.is_hit && (hit.t - 3.5).abs() < 1e-3, "{hit:?}");
    let none = [
        Hair { root: 0.0, tip: 0.0, ..hair },
        Hair { control: [points[1]; 4], ..hair },
        Hair { root: -1.0, tip: -1.0, ..hair },
        Hair { root: f32::NAN, tip: f32::NAN, ..hair },
        Hair { control: [Vec3::splat(f32::NAN); 4], ..hair },
    ];
    for hair in none {
        let ray = Ray::new(vec3(1.0, 0.0, 2.0), -Vec3::Z);
        assert!(!hair.intersect(ray).hit.is_hit, "{hair:?}");
    }
}

#[test]
fn hairs_are_in_their_boxes() {
    let mut rng = Rng::of("hairs in boxes");
    for _ in 0..scaled(500) {
        let size = 10f32.powi(rng.below(8) as i32 - 4);
        let hair = random_hair(&mut rng, size, 1.0);
        let whole = hair.get_bounds();
        let axis = rng.below(3);
        let at = rng.range(whole.min[axis], whole.max[axis]);
        let (below, above) = hair.split_primitive(axis, at);
        let holds = |b: Aabb, p: D3| {
            (0..3).all(|i| f64::from(b.min[i]) <= p[i] && p[i] <= f64::from(b.max[i]))
        };
        let mut seen = Aabb::EMPTY;
        for i in 0..=400 {
            let u = f64::from(i) / 400.0;
            let (c, r) = (curve(&hair, u), radius(&hair, u) * (1.0 - 1e-12));
            for side in 0..6 {
                let mut p = c;
                p[side / 2] += if side % 2 == 0 { r } else { -r };
                assert!(holds(whole, p), "{p:?} is not in {whole:?}");
                let part = if p[axis] <= f64::from(at) { below } else { above };
                assert!(holds(part, p), "{p:?} is not in {part:?}, cut at {at}");
                let p = Vec3::from(p.map(|x| x as f32));
                seen = seen.union(Aabb::new(p, p));
            }
        }
        // They are tight.
        let spare = (whole.size() - seen.size()).max_element();
        assert!(spare < 0.02 * size, "{spare} of {size}");
        assert!(below.max[axis] <= at && above.min[axis] >= at);
    }
}

#[test]
fn hairs_agree() {
    let mut rng = Rng::of("hairs agree");
    let hairs: Vec<Hair> = (0..300).map(|_| random_hair(&mut rng, 1.0, 1.0)).collect();
    let rays = rays(&mut rng, scaled(4000), 2.0);
    let hits = assert_queries(&hairs, &rays);
    assert!(hits > rays.len() / 10, "{hits} hits");
    let bvh = Bvh::build(&hairs).expect("finite bounds");
    let kernel = kernel!(|ray: Ray| (bvh.closest_hit(ray), bvh.any_hit(ray)));
    every_variant(&kernel, &rays);
}

/// The functions of these names, as they stand in the text.
fn functions(wgsl: &str, names: &[&str]) -> String {
    let function = |name: &&str| {
        let start = wgsl.find(&format!("fn {name}(")).expect("the function is in the text");
        let end = start + wgsl[start..].find("\n}\n").expect("the function ends") + 3;
        &wgsl[start..end]
    };
    names.iter().map(function).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_book_shows_this_text() {
    let ring = [Torus { center: Vec3::ZERO, major: 1.0, axis: Vec3::Y, minor: 0.25 }];
    let bvh = Bvh::build(&ring).expect("finite bounds");
    let text = kernel!(|ray: Ray| bvh.closest_hit(ray).t).wgsl();
    let shown = functions(&text, &["gap", "root", "Torus_intersect"]);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../book/src/generated/torus.wgsl");
    if std::env::var("RAYDSL_BLESS").is_ok_and(|v| v == "1") {
        std::fs::write(path, &shown).expect("the book's folder can be written");
    }
    let written = std::fs::read_to_string(path).unwrap_or_default();
    assert!(written == shown, "torus.wgsl is out of date; RAYDSL_BLESS=1 rewrites it");
}
