//! What holds for every shape.

use raydsl::machine::{Lanes, Packet, Type as _};
use raydsl::prelude::*;
use raydsl_tests::hard_rays::bounces::{from_frame, local};
use raydsl_tests::levels::{LevelTask, each_level};
use raydsl_tests::queries::hit_words;
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

use super::exact::{D3, Exact, Meeting, along, dot, length, minus, normal_of, unit};
use super::subject::{Subject, reach, wide};

/// A number of the unit square.
pub(crate) fn square(rng: &mut Rng) -> Vec2 {
    vec2(rng.unit(), rng.unit())
}

/// A ray at the shape: through it, past it, along it, from inside, from afar.
pub(crate) fn ray_at<P: Subject>(rng: &mut Rng, prim: &P, size: f32, far: f32) -> Ray {
    let target = prim.point(square(rng));
    let p = target.position;
    let unit = rng.direction().normalize();
    let away = size * rng.range(0.5, 4.0);
    let (d, away) = match rng.below(8) {
        // Along the surface, exactly or nearly so.
        0 => (unit.cross(target.normal), away),
        1 => (unit.cross(target.normal) + target.normal * rng.range(-1e-3, 1e-3), away),
        // From afar.
        2 => (unit, size * far),
        // Along an axis.
        3 => ([Vec3::X, -Vec3::Y, Vec3::Z][rng.below(3)], away),
        // From inside, or from the other side.
        4 => (unit, size * rng.range(0.0, 0.3)),
        // From a point of the surface to another one.
        5 => ((p - prim.point(square(rng)).position) / size + unit * 1e-3, 0.3 * away),
        _ => (unit, away),
    };
    let d = if d == Vec3::ZERO { unit } else { d };
    // Often the ray passes beside the point.
    let p = p + rng.point(size) * rng.pick(&[0.0, 0.0, 0.01, 1.0]);
    let scale = 10f32.powi(rng.below(9) as i32 - 4);
    let ray = Ray::new(p - d * away, d * scale);
    // What is behind, and what is beyond the first hit.
    let t = away / scale;
    match rng.below(8) {
        0 => ray.with_range(-4.0 * t, 4.0 * t),
        1 => ray.with_range(t * rng.range(0.5, 1.5), f32::MAX),
        2 => ray.with_range(0.0, t * rng.range(0.5, 1.5)),
        3 => ray.with_range(f32::MIN, 0.0),
        _ => ray,
    }
}

/// The nearest intersections of rays that pass within `ring` of `ray`.
fn nearby(exact: &Exact, ray: Ray, ring: f64) -> Vec<Option<Meeting>> {
    let (o, d) = (wide(ray.origin), wide(ray.direction));
    let range = [ray.t_min.into(), ray.t_max.into()];
    let corners = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9].map(|c| f64::from(c) - 1.0));
    let shifted = corners.map(|c| along(o, c, ring / length(c).max(1.0)));
    shifted.map(|o| exact.nearest(o, d, range)).collect()
}

/// A ray along a flat surface meets it for a shift so small that the others all miss it: the point
/// that it gives tells. A triangle or quad that is seen edge-on gives a point of its box.
fn is_along(exact: &Exact, ray: Ray, hit: Hit, ring: f64) -> bool {
    let d = wide(ray.direction);
    let at = along(wide(ray.origin), d, hit.t.into());
    let halves = match *exact {
        Exact::Triangle(v) => vec![v],
        Exact::Quad([a, b, c, e]) => vec![[a, b, e], [c, e, b]],
        _ => return exact.distance(at) <= ring,
    };
    let is_edge_on = |v: &[D3; 3]| dot(normal_of(*v), unit(d)).abs() < 2e-6;
    let is_in = |i: usize| {
        let [low, high] = exact.extent(i);
        low - ring <= at[i] && at[i] <= high + ring
    };
    halves.iter().any(is_edge_on) && (0..3).all(is_in)
}

/// How the rays fared.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) hits: usize,
    pub(crate) misses: usize,
    /// In the ring of rounding: a hit or a miss.
    pub(crate) unclear: usize,
    /// Those whose normal was compared.
    pub(crate) normals: usize,
    /// What is wrong, the first of it.
    pub(crate) wrong: Vec<String>,
}

/// The hit is that of a ray that passes within `ring`, so `t` and the normal are those of such
/// rays.
fn judge<P: Subject>(prim: &P, ray: Ray, ring: f64, tally: &mut Tally) {
    let exact = prim.exact();
    let hit = prim.intersect(ray, &[]);
    let near = nearby(&exact, ray, ring);
    let hits: Vec<Meeting> = near.iter().flatten().copied().collect();
    let mut wrong = |what: String| tally.wrong.push(format!("{what}: {prim:?} {ray:?} {hit:?}"));
    if hits.len() < near.len() && !hits.is_empty() {
        tally.unclear += 1;
        return;
    }
    if hit.is_hit && hits.is_empty() && is_along(&exact, ray, hit, ring) {
        tally.unclear += 1;
        return;
    }
    if hit.is_hit == hits.is_empty() {
        wrong(format!("{hits:?}"));
        return;
    }
    if hits.is_empty() {
        tally.misses += 1;
        return;
    }
    tally.hits += 1;
    let t = f64::from(hit.t);
    let low = hits.iter().fold(f64::INFINITY, |m, h| m.min(h.0));
    let high = hits.iter().fold(f64::NEG_INFINITY, |m, h| m.max(h.0));
    // Where the surface curves away, other directions than those tried give a little more.
    let step = 4.0 * t.abs() * f64::from(f32::EPSILON) + 0.05 * (high - low);
    if !(low - step..=high + step).contains(&t) {
        wrong(format!(
            "t is not in {low:e} to {high:e}, in lengths {}",
            length(wide(ray.direction))
        ));
    }
    let n = wide(prim.normal_at(ray, hit));
    let apart = |n: D3| hits.iter().map(move |h| length(minus(h.1, n)));
    let spread = hits.iter().flat_map(|h| apart(h.1)).fold(0.0, f64::max);
    // Two faces or two sides: which of them is not clear.
    if spread < 0.1 {
        tally.normals += 1;
        let error = apart(n).fold(f64::INFINITY, f64::min);
        // That of a triangle is as good as the angle between its edges.
        let is_flat = matches!(exact, Exact::Triangle(_) | Exact::Quad(_));
        let own = if is_flat { 2e-5 } else { 1e-6 };
        if (dot(n, n).sqrt() - 1.0).abs() > 1e-6 || error > spread + own {
            wrong(format!("the normal {n:?} is {error:e} off, of {spread:e}"));
        }
    }
    let uv = prim.uv_at(ray, hit);
    let is_share = (0.0..=1.0).contains(&uv.x) && (0.0..=1.0).contains(&uv.y);
    let is_plane = matches!(exact, Exact::Plane { .. });
    if !(is_share || is_plane && uv.is_finite()) {
        wrong(format!("uv {uv}"));
    }
}

/// Rays at shapes of these sizes, with a ring of `share` of what `SLACK` allows.
pub(crate) fn tally<P: Subject>(name: &str, share: f64) -> Tally {
    let mut rng = Rng::of(name);
    let mut tally = Tally::default();
    for i in 0..scaled(150_000) {
        let size = 10f32.powi(if i % 2 == 0 { 0 } else { rng.below(25) as i32 - 12 });
        let far_off = rng.pick(&[0.0, 0.0, 3.0, 1000.0]);
        let offset = rng.point(size) * far_off;
        let prim = P::random(&mut rng, size, offset);
        let far = rng.pick(&[100.0, 1000.0]);
        let ray = ray_at(&mut rng, &prim, size, far);
        let (o, d) = (wide(ray.origin), wide(ray.direction));
        let exact = prim.exact();
        let range = [ray.t_min.into(), ray.t_max.into()];
        let t = exact.nearest(o, d, range).map_or(0.0, |m| m.0.abs());
        let hit = prim.intersect(ray, &[]);
        let t = if hit.is_hit { t.max(hit.t.abs().into()) } else { t };
        judge(&prim, ray, share * f64::from(P::SLACK) * reach(&exact, o, d, t), &mut tally);
    }
    tally
}

/// Whether a point of one face may be within rounding of another one: rays inwards may begin beyond
/// that.
fn has_rims(exact: &Exact) -> bool {
    matches!(
        exact,
        Exact::Cylinder { has_caps: true, .. } | Exact::Cone { .. } | Exact::Cuboid { .. }
    )
}

/// A ray that leaves the point of a hit or of the surface does not hit at once: what it hits is
/// there in the closed form too.
pub(crate) fn bounces_leave<P: Subject>(name: &str) {
    let mut rng = Rng::of(name);
    let mut bounces = 0;
    for i in 0..scaled(60_000) {
        let size = 10f32.powi(rng.below(13) as i32 - 6);
        let far_off = rng.pick(&[0.0, 3.0, 1000.0]);
        let offset = rng.point(size) * far_off;
        let prim = P::random(&mut rng, size, offset);
        let ray = ray_at(&mut rng, &prim, size, 100.0);
        let hit = prim.intersect(ray, &[]);
        let point = match (i % 2, hit.is_hit) {
            (0, _) => prim.point(square(&mut rng)),
            (_, true) => prim.point_at(ray, hit),
            _ => continue,
        };
        bounces += 1;
        let mut to = local(&mut rng);
        if has_rims(&prim.exact()) {
            to.z = to.z.abs();
        }
        let next = point.ray(from_frame(point.normal, to));
        let again = prim.intersect(next, &[]);
        let (o, d) = (wide(next.origin), wide(next.direction));
        let exact = prim.exact().nearest(o, d, [0.0, f64::INFINITY]);
        let is_there = |t: f64| f64::from(again.t) >= 0.5 * t;
        assert!(
            !again.is_hit || exact.is_some_and(|m| is_there(m.0)),
            "{prim:?} {point:?} {next:?} {again:?} {exact:?}"
        );
    }
    assert!(bounces * 10 > scaled(60_000), "{bounces} bounces");
}

/// The hits are those of the closed form, but for rounding.
pub(crate) fn hits_are_exact<P: Subject>(name: &str) {
    let found = tally::<P>(name, 1.0);
    println!("{name}: {} hits, {} misses, {} unclear", found.hits, found.misses, found.unclear);
    assert!(found.wrong.is_empty(), "{} wrong, as {}", found.wrong.len(), found.wrong[0]);
    let all = found.hits + found.misses + found.unclear;
    assert!(
        found.hits * 5 > all && found.misses * 10 > all && found.unclear * 4 < all,
        "{found:?}"
    );
    assert!(found.normals * 2 > found.hits, "{found:?}");
}

/// An ulp of the largest coordinate.
fn ulp(bounds: Aabb) -> f64 {
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    f64::from(largest) * f64::from(f32::EPSILON)
}

/// The box holds the shape and no more, and the boxes of its parts hold the parts.
pub(crate) fn bounds_are_tight<P: Subject>(name: &str) {
    let mut rng = Rng::of(name);
    for _ in 0..scaled(400) {
        let size = 10f32.powi(rng.below(13) as i32 - 6);
        let offset = rng.point(size) * rng.pick(&[0.0, 3.0, 1e4]);
        let prim = P::random(&mut rng, size, offset);
        let (whole, exact) = (prim.get_bounds(&[]), prim.exact());
        let ulp = ulp(whole);
        for axis in 0..3 {
            let [low, high] = exact.extent(axis);
            let (min, max) = (f64::from(whole.min[axis]), f64::from(whole.max[axis]));
            // The closed form has errors of its own.
            let own = 1e-6 * ulp;
            assert!(min <= low + own && high <= max + own, "{prim:?}: {whole:?} {low} {high}");
            assert!(low - min <= 4.0 * ulp && max - high <= 4.0 * ulp, "{prim:?}: {whole:?}");
        }
        let axis = rng.below(3);
        let (min, max) = (whole.min[axis], whole.max[axis]);
        let planes = [rng.range(min, max), min, max, min - size, max + size];
        let parts = planes.map(|at| (at, prim.split_primitive(axis, at, &[])));
        for (at, (below, above)) in parts {
            for part in [below, above] {
                assert!(!part.is_valid() || part == part.intersection(whole), "{prim:?}: {part:?}");
            }
            assert!(!below.is_valid() || below.max[axis] <= at);
            assert!(!above.is_valid() || above.min[axis] >= at);
        }
        for _ in 0..1000 {
            let p = wide(prim.point(square(&mut rng)).position);
            // The point is rounded too.
            let pad = 4.0 * ulp;
            let holds = |b: Aabb| {
                let (min, max) = (wide(b.min), wide(b.max));
                (0..3).all(|i| min[i] - pad <= p[i] && p[i] <= max[i] + pad)
            };
            assert!(holds(whole), "{prim:?}: {p:?} is not in {whole:?}");
            for (at, (below, above)) in parts {
                let over = p[axis] - f64::from(at);
                let is_held = over <= pad && holds(below) || over >= -pad && holds(above);
                assert!(is_held, "{prim:?}: {p:?} is not in {below:?} or {above:?}");
            }
        }
    }
}

/// Sampled points lie on the surface and fill it evenly; the area is that of the closed form.
pub(crate) fn samples_are_uniform<P: Subject>(name: &str) {
    let mut rng = Rng::of(name);
    for _ in 0..8 {
        let prim = P::random(&mut rng, 1.0, Vec3::ZERO);
        let (exact, count) = (prim.exact(), scaled(40_000));
        let (area, center) = exact.area();
        let found = f64::from(prim.whole_area());
        let error = (found - area).abs();
        assert!(found == area || error < 4e-6 * area, "{prim:?}: {found} for {area}");
        let (mut mean, mut square_sum) = ([0.0; 3], [0.0; 3]);
        for _ in 0..count {
            let p = prim.point(square(&mut rng));
            let (at, n) = (wide(p.position), wide(p.normal));
            assert!(exact.distance(at) < 4e-6, "{prim:?}: {at:?}");
            assert!((length(n) - 1.0).abs() < 1e-6, "{prim:?}: {n:?}");
            // A step along the normal leaves the surface, by its own length; next to an edge the
            // distance is known to a factor.
            let step = exact.distance(along(at, n, 1e-3));
            assert!((5e-4..1.01e-3).contains(&step), "{prim:?}: {at:?} {n:?} {step}");
            let is_outwards = dot(n, minus(at, center)) > -1e-6;
            assert!(is_outwards || !exact.is_body(), "{prim:?}: {at:?} {n:?}");
            mean = along(mean, at, 1.0 / count as f64);
            let off = minus(at, center);
            square_sum = std::array::from_fn(|i| square_sum[i] + off[i] * off[i]);
        }
        for i in 0..3 {
            let deviation = square_sum[i].sqrt() / count as f64;
            let error = (mean[i] - center[i]).abs();
            assert!(error < 5.0 * deviation + 1e-6, "{prim:?}: {mean:?} for {center:?}");
        }
    }
}

/// A tree changes nothing.
pub(crate) fn trees_change_nothing<P: Subject>(name: &str) {
    let mut rng = Rng::of(name);
    for size in [1.0, 1e-6, 1e6] {
        let prims: Vec<P> = (0..200)
            .map(|_| {
                let offset = rng.point(size * 6.0);
                P::random(&mut rng, size, offset)
            })
            .collect();
        let bvh = Bvh::build(&prims).expect("finite bounds");
        let mut hits = 0;
        for _ in 0..scaled(2000) {
            let prim = rng.pick(&prims);
            let ray = ray_at(&mut rng, &prim, size, 1000.0);
            let (hit, expected) = (bvh.closest_hit(ray), prims[..].closest_hit(ray));
            let same = hit.t.to_bits() == expected.t.to_bits() && hit == expected;
            assert!(same, "{ray:?}: {hit:?} for {expected:?}");
            assert_eq!(bvh.any_hit(ray), expected.is_hit, "{ray:?}");
            hits += usize::from(hit.is_hit);
        }
        assert!(hits * 3 > scaled(2000), "{hits} hits");
    }
}

/// Another primitive and another ray in every lane, at every level; then several primitives and one
/// ray.
pub(crate) fn lanes_agree<P: Subject>(name: &str) {
    let mut rng = Rng::of(name);
    let mut task = Lanewise { prims: Vec::new(), rays: Vec::new() };
    for i in 0..scaled(8000) {
        let prim = P::random(&mut rng, 1.0, Vec3::ZERO);
        let ray = match task.rays.last() {
            Some(ray) if i % 32 > 16 => *ray,
            _ => ray_at(&mut rng, &prim, 1.0, 100.0),
        };
        task.prims.push(prim);
        task.rays.push(ray);
    }
    task.prims.extend(P::degenerate());
    task.rays.resize(task.prims.len(), Ray::new(Vec3::NEG_ONE, Vec3::ONE));
    each_level(&mut task);
}

struct Lanewise<P> {
    prims: Vec<P>,
    rays: Vec<Ray>,
}

impl<P: Subject> LevelTask for Lanewise<P> {
    fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
        let mut hits = 0;
        lanes.vectorize(|| {
            for (prims, rays) in self.prims.chunks(L::N).zip(self.rays.chunks(L::N)) {
                let m = Packet::with_count(lanes, rays.len());
                let last = rays.len() - 1;
                let prim = P::from_lanes(&m, |l| prims[l.min(last)]);
                let ray = Ray::from_lanes(&m, |l| rays[l.min(last)]);
                let found = P::intersect_on(&m, prim, ray, prims.view().shared());
                for (l, (prim, ray)) in prims.iter().zip(rays).enumerate() {
                    let hit = Hit::lane::<Packet<L>>(&found, l);
                    let expected = prim.intersect(*ray, &[]);
                    let same = hit.is_hit == expected.is_hit
                        && (!hit.is_hit || hit_words(&hit) == hit_words(&expected));
                    assert!(same, "{name}: {prim:?} {ray:?}: {hit:?} for {expected:?}");
                    hits += usize::from(hit.is_hit);
                }
            }
        });
        assert!(hits * 8 > self.rays.len(), "{hits} hits of {}", self.rays.len());
    }
}

/// What is no surface, no number or no ray is not hit.
pub(crate) fn nothing_is_missed<P: Subject>(name: &str) {
    let mut rng = Rng::of(name);
    for prim in P::degenerate() {
        for i in 0..2000 {
            let p = if i % 2 == 0 { rng.point(1.0) } else { Vec3::X * rng.range(0.0, 1.0) };
            let d = if i % 8 == 0 { Vec3::X } else { rng.direction() };
            let hit = prim.intersect(Ray::new(p - d * 2.0, d), &[]);
            assert!(!hit.is_hit, "{prim:?}: {hit:?}");
        }
    }
    let words = P::SCHEMA.size() / 4;
    for _ in 0..200 {
        let prim = P::random(&mut rng, 1.0, Vec3::ZERO);
        let target = prim.point(square(&mut rng)).position;
        let d = rng.direction();
        let ray = Ray::new(target - d * 3.0, d);
        for word in 0..words {
            let mut bytes = vec![0; P::SCHEMA.size()];
            prim.write(&mut bytes);
            bytes[word * 4..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
            let broken = P::read(&bytes);
            assert!(!broken.intersect(ray, &[]).is_hit, "{broken:?}");
        }
        for i in 0..8 {
            let mut broken = ray;
            match i {
                0..3 => broken.origin[i] = f32::NAN,
                3..6 => broken.direction[i - 3] = f32::NAN,
                6 => broken.t_min = f32::NAN,
                _ => broken.t_max = f32::NAN,
            }
            assert!(!prim.intersect(broken, &[]).is_hit, "{prim:?}: {broken:?}");
        }
        let still = Ray { direction: Vec3::ZERO, ..ray };
        assert!(!prim.intersect(still, &[]).is_hit, "{prim:?}");
    }
}
