//! `hits`: every crossing of a ray in order, against a loop in plain Rust.
//!
//! The oracle asks each shape for all of its crossings at once, sorts them, and has no part of the
//! library in it. Distances are computed without rounding, so copies and neighbours share them.

use raydsl::bvh::{Accelerated, BuildError};
use raydsl::prelude::*;
use raydsl_tests::check::every_variant;
use raydsl_tests::lattice::{Backwards, lattice_rays};
use raydsl_tests::rng::Rng;

/// Cards across the z axis, one unit behind another. It is crossed as often as it has cards.
#[primitive]
#[derive(Debug, PartialEq)]
struct Deck {
    low: Vec3,
    high: Vec3,
    cards: u32,
}

#[primitive]
impl Deck {
    const MAX_CROSSINGS: u32 = 6;

    fn intersect(&self, ray: Ray) -> Hit {
        let mut found = Hit::miss();
        for i in 0..self.cards {
            let z = self.low.z + i as f32;
            let t = (z - ray.origin.z) / ray.direction.z;
            let x = ray.origin.x + t * ray.direction.x;
            let y = ray.origin.y + t * ray.direction.y;
            let is_inside =
                x >= self.low.x && x <= self.high.x && y >= self.low.y && y <= self.high.y;
            let is_nearer = !found.is_hit || t < found.t;
            if is_inside && t >= ray.t_min && t <= ray.t_max && is_nearer {
                found = Hit { u: x, v: y, ..Hit::new(true, t) };
            }
        }
        found
    }

    fn get_bounds(&self) -> Aabb {
        Aabb { min: self.low, max: self.high }
    }
}

impl Deck {
    /// All crossings, whatever the range.
    fn crossings(&self, ray: Ray) -> Vec<Hit> {
        let card = |i: u32| {
            let t = (self.low.z + i as f32 - ray.origin.z) / ray.direction.z;
            let (x, y) = (ray.origin.x + t * ray.direction.x, ray.origin.y + t * ray.direction.y);
            let is_inside =
                (self.low.x..=self.high.x).contains(&x) && (self.low.y..=self.high.y).contains(&y);
            is_inside.then(|| Hit { u: x, v: y, ..Hit::new(true, t) })
        };
        (0..self.cards).filter_map(card).collect()
    }
}

/// Decks at whole places, a third of them copies, in an order of no meaning.
fn decks(rng: &mut Rng, count: usize) -> Vec<Deck> {
    let whole = |rng: &mut Rng, n: usize| rng.below(n) as f32;
    let mut all: Vec<Deck> = (0..count)
        .map(|_| {
            let cards = 1 + rng.below(6) as u32;
            let low = vec3(whole(rng, 9) - 5.0, whole(rng, 9) - 5.0, whole(rng, 9) - 4.0);
            let size = vec3(1.0 + whole(rng, 4), 1.0 + whole(rng, 4), (cards - 1) as f32);
            Deck { low, high: low + size, cards }
        })
        .collect();
    for _ in 0..count / 2 {
        let again = all[rng.below(count)];
        all.push(again);
    }
    let order = rng.permutation(all.len());
    order.into_iter().map(|i| all[i]).collect()
}

/// Decks where they stand in a scene.
struct Placed<'a> {
    decks: &'a [Deck],
    /// What the scene adds to their numbers.
    first: u32,
    moved: Vec3,
}

/// All hits in order.
fn expected(scene: &[Placed<'_>], ray: Ray) -> Vec<Hit> {
    let mut all: Vec<Hit> = Vec::new();
    if !ray.origin.is_finite() || !ray.direction.is_finite() {
        return all;
    }
    for (inst, placed) in scene.iter().enumerate() {
        for (id, deck) in placed.decks.iter().enumerate() {
            let local = Ray { origin: ray.origin - placed.moved, ..ray };
            let (inst_id, prim_id) = (inst as u32, placed.first + id as u32);
            let hits = deck.crossings(local).into_iter();
            let hits = hits.filter(|hit| ray.t_min <= hit.t && hit.t <= ray.t_max);
            all.extend(hits.map(|hit| Hit { inst_id, prim_id, ..hit }));
        }
    }
    all.sort_by(|a, b| {
        let nearer = a.t.partial_cmp(&b.t).expect("a hit within a range has a distance");
        nearer.then((a.inst_id, a.prim_id).cmp(&(b.inst_id, b.prim_id)))
    });
    all
}

/// The results of a loop over all hits: their count, a number that depends on their order, and the
/// last; and the third hit, of a loop that stops there.
type Answer = (u32, u32, Hit, Hit);

fn word(sum: u32, hit: Hit) -> u32 {
    let place = (hit.t * 8.0) as i32 as u32;
    sum.wrapping_mul(31).wrapping_add(hit.prim_id + 977 * hit.inst_id).wrapping_add(place)
}

fn answer(hits: &[Hit]) -> Answer {
    let at = |i: usize| hits.get(i).copied().unwrap_or(Hit::miss());
    let sum = hits.iter().fold(1, |sum, hit| word(sum, *hit));
    (hits.len() as u32, sum, hits.last().copied().unwrap_or(Hit::miss()), at(2))
}

/// A kernel with two loops over the hits of a scene.
macro_rules! asked {
    ($scene:ident) => {
        kernel!(|ray: Ray| {
            let mut count = 0u32;
            let mut sum = 1u32;
            let mut last = Hit::miss();
            for hit in $scene.hits(ray) {
                count += 1;
                let place = (hit.t * 8.0) as i32 as u32;
                let name = hit.prim_id + 977 * hit.inst_id;
                sum = sum.wrapping_mul(31).wrapping_add(name).wrapping_add(place);
                last = hit;
            }
            let mut third = Hit::miss();
            let mut passed = 0u32;
            for hit in $scene.hits(ray) {
                passed += 1;
                if passed < 3 {
                    continue;
                }
                third = hit;
                break;
            }
            (count, sum, last, third)
        })
    };
}

#[track_caller]
fn assert_hits<S: PrimitiveScene<Primitive = Deck> + ?Sized>(
    who: &str,
    scene: &S,
    kernel: &Kernel<'_, (Ray,), Answer>,
    oracle: &[Placed<'_>],
    rays: &[(Ray,)],
) {
    let (mut tied, mut batches) = (0, 0);
    for (ray,) in rays {
        let hits = expected(oracle, *ray);
        let found: Vec<Hit> = scene.hits(*ray).collect();
        assert_eq!(found, hits, "{who}: {ray:?}");
        assert_eq!(kernel.call((*ray,)), answer(&hits), "{who}, the kernel: {ray:?}");
        tied += usize::from(hits.windows(2).any(|pair| pair[0].t == pair[1].t));
        batches += usize::from(hits.len() > 8);
    }
    assert!(tied * 4 > rays.len(), "{who}: {tied} of {} rays have a tie", rays.len());
    assert!(batches * 4 > rays.len(), "{who}: {batches} of {} have many hits", rays.len());
    every_variant(kernel, rays);
}

const RAYS: usize = 600;
const HERE: Vec3 = Vec3::ZERO;

#[test]
fn of_slices_and_trees() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = Rng::of("decks");
    let decks = decks(&mut rng, 120);
    let rays = lattice_rays(&mut rng, RAYS);
    let oracle = [Placed { decks: &decks, first: 0, moved: HERE }];
    let all = &decks[..];
    assert_hits("a slice", all, &asked!(all), &oracle, &rays);
    let check = |who: &str, tree: &Bvh<'_, Deck>| {
        assert_hits(who, tree, &asked!(tree), &oracle, &rays);
    };
    for quality in [BuildQuality::Fast, BuildQuality::Balanced, BuildQuality::Best] {
        let config = BuildConfig { quality, min_wide_size: 0, ..BuildConfig::default() };
        check(&format!("{quality:?}"), &Bvh::build_with(&decks, &config)?);
        let wide = Bvh::build_wide(&decks, &[], &config)?;
        let bytes = wide.bytes();
        let compare = |rays: &[(Ray,)]| {
            for (ray,) in rays {
                let found: Vec<Hit> = wide.hits(*ray).collect();
                assert_eq!(found, expected(&oracle, *ray), "{quality:?}, wide: {ray:?}");
            }
            // Not `every_variant`: WGSL has the binary tree.
            let listed = asked!(wide);
            let mut found = vec![(0, 0, Hit::miss(), Hit::miss()); rays.len()];
            for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
                listed.run(variant, rays, &mut found);
                for (ray, found) in rays.iter().zip(&found) {
                    assert_eq!(*found, listed.call(*ray), "{}: {ray:?}", variant.name());
                }
            }
        };
        let is_steep = |ray: &(Ray,)| ray.0.direction.z != 0.0;
        let (steep, flat): (Vec<_>, Vec<_>) = rays.iter().copied().partition(is_steep);
        compare(&steep);
        assert_eq!(wide.bytes(), bytes, "the binary tree was made");
        // Degenerate ones need it.
        compare(&flat);
    }
    Ok(())
}

#[test]
fn of_lists() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = Rng::of("lists of decks");
    let decks = decks(&mut rng, 120);
    let rays = lattice_rays(&mut rng, RAYS);
    let (front, back) = decks.split_at(50);
    // One number after the other, as of one slice.
    let oracle = [Placed { decks: &decks, first: 0, moved: HERE }];
    let config = BuildConfig { min_wide_size: 0, ..BuildConfig::default() };
    let binary = [Bvh::build(front)?, Bvh::build(back)?];
    let wide = [Bvh::build_wide(front, &[], &config)?, Bvh::build_wide(back, &[], &config)?];
    for (who, trees) in [("a list", &binary), ("a list of wide trees", &wide)] {
        let list = BvhList::new(trees)?;
        assert_hits(who, &list, &asked!(list), &oracle, &rays);
    }
    Ok(())
}

#[test]
fn of_instances() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = Rng::of("placed decks");
    let decks = decks(&mut rng, 60);
    let (one, two) = decks.split_at(40);
    let trees = [Bvh::build(one)?, Bvh::build(two)?];
    let places =
        [(0, HERE), (1, vec3(1.0, 0.0, -2.0)), (0, HERE), (0, vec3(0.0, -2.0, 1.0)), (1, HERE)];
    let placed = places.map(|(tree, moved)| Instance::new(tree, Affine3::from_translation(moved)));
    let scene = Instances::build(&trees, &placed)?;
    let firsts = [0, one.len() as u32];
    let oracle =
        places.map(|(tree, moved)| Placed { decks: [one, two][tree], first: firsts[tree], moved });
    assert_hits("instances", &scene, &asked!(scene), &oracle, &lattice_rays(&mut rng, RAYS));
    Ok(())
}

#[test]
fn of_accelerators() {
    let mut rng = Rng::of("decks of an application");
    let decks = decks(&mut rng, 120);
    let oracle = [Placed { decks: &decks, first: 0, moved: HERE }];
    let scene = Accelerated::new(&decks, Backwards(decks.len() as u32));
    assert_hits("an accelerator", &scene, &asked!(scene), &oracle, &lattice_rays(&mut rng, RAYS));
}

/// A deck of which the first two crossings count.
#[primitive]
struct FirstTwo {
    deck: Deck,
}

#[primitive]
impl FirstTwo {
    const MAX_CROSSINGS: u32 = 2;

    fn intersect(&self, ray: Ray) -> Hit {
        self.deck.intersect(ray)
    }

    fn get_bounds(&self) -> Aabb {
        self.deck.get_bounds()
    }
}

/// However many hits are found at a time.
#[test]
fn of_shapes_with_more_crossings_than_they_say() -> Result<(), BuildError> {
    let mut rng = Rng::of("first two");
    let decks = decks(&mut rng, 60);
    let shapes: Vec<FirstTwo> = decks.iter().map(|deck| FirstTwo { deck: *deck }).collect();
    let tree = Bvh::build(&shapes)?;
    let last = kernel!(|ray: Ray| {
        let mut count = 0u32;
        let mut last = Hit::miss();
        for hit in tree.hits(ray) {
            count += 1;
            last = hit;
        }
        (count, last)
    });
    let rays = lattice_rays(&mut rng, RAYS);
    for (ray,) in &rays {
        let all = expected(&[Placed { decks: &decks, first: 0, moved: HERE }], *ray);
        let mut seen = vec![0; decks.len()];
        let first_two = all.into_iter().filter(|hit| {
            seen[hit.prim_id as usize] += 1;
            seen[hit.prim_id as usize] <= 2
        });
        let first_two: Vec<Hit> = first_two.collect();
        let found: Vec<Hit> = tree.hits(*ray).collect();
        assert_eq!(found, first_two, "{ray:?}");
        let end = first_two.last().copied().unwrap_or(Hit::miss());
        assert_eq!(last.call((*ray,)), (found.len() as u32, end));
    }
    every_variant(&last, &rays);
    Ok(())
}

/// Which card of a deck was hit.
#[derive(Clone, Copy, Debug, Type, HitRecord)]
struct CardHit {
    hit: Hit,
    card: u32,
}

/// A deck whose cards are numbered, and that does not count a hit where the range begins.
#[primitive]
struct Numbered {
    deck: Deck,
}

#[primitive]
impl Numbered {
    const MAX_CROSSINGS: u32 = 6;

    fn intersect(&self, ray: Ray) -> CardHit {
        let mut found = CardHit { hit: Hit::miss(), card: 0 };
        for i in 0..self.deck.cards {
            let z = self.deck.low.z + i as f32;
            let t = (z - ray.origin.z) / ray.direction.z;
            let at = ray.origin + ray.direction * t;
            let (low, high) = (self.deck.low, self.deck.high);
            let is_inside = at.x >= low.x && at.x <= high.x && at.y >= low.y && at.y <= high.y;
            let is_nearer = !found.hit.is_hit || t < found.hit.t;
            if is_inside && t > ray.t_min && t <= ray.t_max && is_nearer {
                found = CardHit { hit: Hit::new(true, t), card: i };
            }
        }
        found
    }

    fn get_bounds(&self) -> Aabb {
        self.deck.get_bounds()
    }
}

/// The record is that of the crossing, not of the primitive's first one.
#[test]
fn records_of_each_crossing() -> Result<(), BuildError> {
    let mut rng = Rng::of("numbered");
    let decks = decks(&mut rng, 60);
    let shapes: Vec<Numbered> = decks.iter().map(|deck| Numbered { deck: *deck }).collect();
    let tree = Bvh::build(&shapes)?;
    let sum = kernel!(|ray: Ray| {
        let mut sum = 0u32;
        for found in tree.hits(ray) {
            sum = sum.wrapping_mul(7).wrapping_add(found.card);
        }
        sum
    });
    let rays: Vec<(Ray,)> =
        lattice_rays(&mut rng, RAYS).into_iter().filter(|ray| ray.0.origin.is_finite()).collect();
    let mut later = 0;
    for (ray,) in &rays {
        let mut number = 0u32;
        for found in tree.hits(*ray) {
            let deck = decks[found.hit.prim_id as usize];
            let z = ray.origin.z + found.hit.t * ray.direction.z;
            assert_eq!(found.card as f32, z - deck.low.z, "{ray:?}: {found:?}");
            later += usize::from(found.card > 0);
            number = number.wrapping_mul(7).wrapping_add(found.card);
        }
        let all = expected(&[Placed { decks: &decks, first: 0, moved: HERE }], *ray);
        let inside = all.iter().filter(|hit| hit.t > ray.t_min).count();
        assert_eq!(tree.hits(*ray).count(), inside, "{ray:?}");
        assert_eq!(sum.call((*ray,)), number);
    }
    assert!(later > 500, "{later} hits of later cards");
    every_variant(&sum, &rays);
    Ok(())
}

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

/// How far a ray goes through balls that overlap, in a loop over hits: their entries and exits.
#[test]
fn lengths_within_spheres() -> Result<(), BuildError> {
    let mut rng = Rng::of("balls");
    let at = |rng: &mut Rng| 2.0 * rng.unit() - 1.0;
    let balls: Vec<Ball> = (0..60)
        .map(|_| Ball {
            center: vec3(at(&mut rng), at(&mut rng), at(&mut rng)),
            radius: 0.1 + 0.2 * rng.unit(),
        })
        .collect();
    let tree = Bvh::build(&balls)?;
    let length = kernel!(|ray: Ray| {
        let mut depth = 0i32;
        let mut from = 0.0;
        let mut sum = 0.0;
        for hit in tree.hits(ray) {
            let ball = tree.primitive(hit);
            let is_entry = ball.normal(ray, hit).dot(ray.direction) < 0.0;
            if is_entry {
                if depth == 0 {
                    from = hit.t;
                }
                depth += 1;
            } else {
                depth -= 1;
                if depth == 0 {
                    sum += hit.t - from;
                }
            }
        }
        (sum, depth)
    });
    let rays: Vec<(Ray,)> = (0..500)
        .map(|_| {
            let origin = vec3(2.0 * at(&mut rng), 2.0 * at(&mut rng), -3.0);
            let to = vec3(at(&mut rng), at(&mut rng), at(&mut rng));
            (Ray::new(origin, (to - origin).normalize()),)
        })
        .collect();
    let mut long = 0;
    for (ray,) in &rays {
        // The union of intervals, in f64.
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let mut spans: Vec<(f64, f64)> = balls
            .iter()
            .filter_map(|ball| {
                let (f, r) = (ball.center.as_dvec3() - o, f64::from(ball.radius));
                let middle = f.dot(d) / d.dot(d);
                let aside = (f - d * middle).length_squared();
                let half = ((r * r - aside) / d.dot(d)).max(0.0).sqrt();
                (r * r > aside).then_some((middle - half, middle + half))
            })
            .collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut sum, mut end) = (0.0, f64::NEG_INFINITY);
        for (enter, leave) in spans {
            sum += (leave - enter.max(end)).max(0.0);
            end = end.max(leave);
        }
        let (found, depth) = length.call((*ray,));
        assert_eq!(depth, 0, "{ray:?}: every entry has an exit");
        assert!((f64::from(found) - sum).abs() < 1e-5, "{ray:?}: {found}, not {sum}");
        long += usize::from(sum > 0.5);
    }
    assert!(long > 50, "{long} rays go through balls");
    every_variant(&length, &rays);
    Ok(())
}

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

#[primitive(cone(p0, p1, radius))]
struct Hat {
    p0: Vec3,
    p1: Vec3,
    radius: f32,
}

#[primitive(cuboid(min, max))]
struct Chest {
    min: Vec3,
    max: Vec3,
}

/// Returns for each hit of a shape whether its normal points along the ray, and whether the surface
/// point lies on the ray at that distance.
macro_rules! outwards {
    ($scene:ident) => {
        kernel!(|ray: Ray| {
            let mut count = 0u32;
            let mut leaving = 0u32;
            let mut error = 0.0;
            for hit in $scene.hits(ray) {
                let shape = $scene.primitive(hit);
                if shape.normal(ray, hit).dot(ray.direction) > 0.0 {
                    leaving += 1u32 << count;
                }
                let at = ray.origin + ray.direction * hit.t;
                error = max(error, (shape.surface_point(ray, hit).position - at).length());
                count += 1;
            }
            (count, leaving, error)
        })
    };
}

/// Shapes answer for the hit that they are given: at an exit the normal points with the ray.
#[test]
fn normals_at_entries_and_exits() {
    let mut rng = Rng::of("exits");
    let point = |rng: &mut Rng| rng.point(1.0);
    let (p0, p1, radius) = (vec3(-0.5, -0.25, 0.25), vec3(0.5, 0.5, -0.25), 0.5);
    let (balls, rods) = ([Ball { center: p0, radius }], [Rod { p0, p1, radius }]);
    let (pipes, hats) = ([Pipe { p0, p1, radius }], [Hat { p0, p1, radius }]);
    let chests = [Chest { min: p0 - 0.5, max: p0 + 0.5 }];
    let rays: Vec<(Ray,)> = (0..600)
        .map(|_| {
            let origin = 4.0 * point(&mut rng).normalize();
            (Ray::new(origin, point(&mut rng) - origin),)
        })
        .collect();
    macro_rules! check {
        ($($shapes:ident)+) => {
            $({
                let scene = &$shapes[..];
                let kernel = outwards!(scene);
                let mut both = 0;
                for (ray,) in &rays {
                    let (count, leaving, error) = kernel.call((*ray,));
                    assert!(error < 1e-5, "{}: {ray:?}: {error}", stringify!($shapes));
                    match count {
                        0 => assert_eq!(leaving, 0),
                        // Into an open end, or out of one.
                        1 => assert_eq!(stringify!($shapes), "pipes", "{ray:?}"),
                        _ => {
                            assert_eq!((count, leaving), (2, 2), "{}: {ray:?}", stringify!($shapes));
                            both += 1;
                        }
                    }
                }
                assert!(both > 100, "{}: {both}", stringify!($shapes));
                let parts = kernel!(|ray: Ray| {
                    let mut count = 0u32;
                    let mut leaving = 0u32;
                    for hit in scene.hits(ray) {
                        if scene.primitive(hit).normal(ray, hit).dot(ray.direction) > 0.0 {
                            leaving += 1u32 << count;
                        }
                        count += 1;
                    }
                    (count, leaving)
                });
                every_variant(&parts, &rays);
            })+
        };
    }
    check!(balls rods pipes hats chests);
}

/// Loops within loops, `return` out of one, and two rays of which each has its own hits.
#[test]
fn within_control_flow() -> Result<(), BuildError> {
    let mut rng = Rng::of("control");
    let decks = decks(&mut rng, 40);
    let tree = Bvh::build(&decks)?;
    let pairs = kernel!(|ray: Ray, other: Ray| {
        let mut pairs = 0u32;
        'all: for a in tree.hits(ray) {
            if a.prim_id % 5 == 4 {
                continue;
            }
            for b in tree.hits(other) {
                if b.prim_id == a.prim_id {
                    continue 'all;
                }
                if pairs > 40 {
                    return (pairs, a.prim_id);
                }
                pairs += 1;
            }
        }
        (pairs, 0u32)
    });
    let all = lattice_rays(&mut rng, RAYS);
    let inputs: Vec<(Ray, Ray)> =
        all.iter().zip(all.iter().rev()).map(|(a, b)| (a.0, b.0)).collect();
    let busy = inputs.iter().filter(|input| pairs.call(**input).0 > 0).count();
    assert!(busy > 100, "{busy}");
    every_variant(&pairs, &inputs);
    Ok(())
}
