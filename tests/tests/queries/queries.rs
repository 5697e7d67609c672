//! Queries that ask the kernel about hits, and queries of several hits, in every variant.

use raydsl::assert_variants_agree;
use raydsl::geometry::sphere;
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;

#[primitive(sphere(center, radius))]
#[derive(Debug)]
struct Ball {
    center: Vec3,
    radius: f32,
}

fn balls(rng: &mut Rng, count: usize) -> Vec<Ball> {
    let mut balls: Vec<Ball> =
        (0..count).map(|_| Ball { center: rng.point(3.0), radius: rng.range(0.2, 0.9) }).collect();
    // Copies: of equal distances the smaller number comes first.
    balls.extend_from_within(..count / 4);
    balls
}

fn rays(rng: &mut Rng) -> Vec<(Ray,)> {
    let mut all: Vec<(Ray,)> =
        (0..3000).map(|_| (Ray::new(rng.point(4.0), rng.point(1.0)),)).collect();
    // Ranges that hold no hit, or a few.
    for (i, (ray,)) in all.iter_mut().enumerate() {
        match i % 5 {
            0 => ray.t_max = 2.0,
            1 => ray.t_min = 1.0,
            _ => {}
        }
    }
    all[7].0.origin.x = f32::NAN;
    all[8].0.direction.z = f32::INFINITY;
    all
}

/// All hits in order, by looking at every ball.
fn in_order(balls: &[Ball], ray: Ray, accept: impl Fn(Hit) -> bool) -> Vec<Hit> {
    let is_number = ray.origin.is_finite() && ray.direction.is_finite();
    let hit = |(id, b): (usize, &Ball)| Hit {
        prim_id: id as u32,
        ..sphere::intersect(ray, b.center, b.radius)
    };
    let mut all: Vec<Hit> = balls.iter().enumerate().map(hit).collect();
    all.retain(|h| is_number && h.is_hit && accept(*h));
    all.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.prim_id.cmp(&b.prim_id)));
    all
}

/// Two balls of three, and only beyond a distance.
fn is_kept(hit: Hit) -> bool {
    hit.prim_id % 3 != 1 && hit.t > 0.5
}

#[test]
fn several_hits_are_in_order() {
    let mut rng = Rng::of("several");
    let balls = balls(&mut rng, 60);
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let (rays, slice) = (rays(&mut rng), &balls[..]);
    let mut most = 0;
    for (ray,) in &rays {
        let mut expected = in_order(&balls, *ray, |_| true);
        most = most.max(expected.len());
        expected.resize(4, Hit::miss());
        assert_eq!(bvh.multi_hit::<4>(*ray)[..], expected);
        assert_eq!(slice.multi_hit::<4>(*ray)[..], expected);
        let mut kept = in_order(&balls, *ray, is_kept);
        kept.resize(2, Hit::miss());
        assert_eq!(bvh.multi_hit_where::<2>(*ray, is_kept)[..], kept);
    }
    assert!(most > 6, "no ray meets more than {most} balls");
    let tree = kernel!(|ray: Ray| {
        let hits = bvh.multi_hit::<4>(ray);
        (hits[0], hits[1], hits[2], hits[3])
    });
    assert_variants_agree!(&tree, &rays);
    let some = kernel!(|ray: Ray| {
        let hits = slice.multi_hit_where::<2>(ray, |hit: Hit| hit.prim_id % 3 != 1 && hit.t > 0.5);
        (hits[0], hits[1])
    });
    assert_variants_agree!(&some, &rays);
}

#[test]
fn conditions_choose_among_hits() {
    let mut rng = Rng::of("conditions");
    let balls = balls(&mut rng, 60);
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let (rays, slice) = (rays(&mut rng), &balls[..]);
    let mut left_out = 0;
    for (ray,) in &rays {
        let kept = in_order(&balls, *ray, is_kept);
        let expected = kept.first().copied().unwrap_or(Hit::miss());
        assert_eq!(bvh.closest_hit_where(*ray, is_kept), expected);
        assert_eq!(slice.closest_hit_where(*ray, is_kept), expected);
        assert_eq!(bvh.any_hit_where(*ray, is_kept), expected.is_hit);
        assert_eq!(slice.any_hit_where(*ray, is_kept), expected.is_hit);
        left_out += usize::from(bvh.closest_hit(*ray) != expected);
    }
    assert!(left_out > 100, "the condition chose {left_out} times");
    // The condition reads what stands around it, and the primitive itself.
    let least = 0.5;
    let of_tree = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit_where(ray, |hit: Hit| {
            let big = bvh.primitive(hit).radius > 0.3;
            hit.prim_id % 3 != 1 && hit.t > least && big
        });
        let any = bvh.any_hit_where(ray, |hit: Hit| hit.t > least + ray.t_min);
        (hit, any)
    });
    assert_variants_agree!(&of_tree, &rays);
    let of_slice = kernel!(|ray: Ray| {
        let hit = slice.closest_hit_where(ray, |hit: Hit| hit.prim_id % 3 != 1);
        let any = slice.any_hit_where(ray, |hit: Hit| hit.prim_id > 50 && hit.t > least);
        (hit, any)
    });
    assert_variants_agree!(&of_slice, &rays);
}

/// Where packets run a query under a mask, and in a loop.
#[test]
fn queries_within_control_flow() {
    let mut rng = Rng::of("within");
    let balls = balls(&mut rng, 40);
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let rays = rays(&mut rng);
    let walk = kernel!(|ray: Ray| {
        let mut sum = 0.0;
        let mut start = ray.t_min;
        for i in 0u32..3 {
            if ray.direction.x > 0.1 * i as f32 {
                let hit = bvh.closest_hit_where(ray.with_range(start, ray.t_max), |hit: Hit| {
                    hit.prim_id & 1 == i & 1
                });
                if !hit.is_hit {
                    break;
                }
                sum += hit.t;
                start = hit.t + 0.01;
            }
        }
        sum
    });
    assert_variants_agree!(&walk, &rays);
}

/// Names of generated code on types and functions of a user's.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Traversal {
    way: f32,
}

#[kernel]
fn bvh_next(walk: Traversal) -> f32 {
    walk.way * 2.0
}

#[test]
fn names_of_generated_code_are_the_users_too() {
    let mut rng = Rng::of("names");
    let balls = balls(&mut rng, 20);
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let kernel = kernel!(|ray: Ray| {
        let far = bvh_next(Traversal { way: ray.direction.x });
        let any = bvh.any_hit_where(ray, |hit: Hit| hit.t > far);
        if any { far } else { -1.0 }
    });
    assert_variants_agree!(&kernel, &rays(&mut rng));
}

/// A clock that never ends to turn if its period is 0.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Clock {
    at: u32,
    period: u32,
}

#[kernel]
impl core::ops::Add for Clock {
    type Output = Clock;

    fn add(self, other: Clock) -> Clock {
        let mut at = self.at + other.at;
        while at >= self.period {
            at -= self.period;
        }
        Clock { at, period: self.period }
    }
}

/// The right side of `&&` is evaluated for the lanes that ask for it, whatever it calls.
#[test]
fn operators_run_where_they_are_asked() {
    let inputs: Vec<(Clock,)> = (0..64).map(|i| (Clock { at: i, period: i % 5 },)).collect();
    let kernel = kernel!(|c: Clock| c.period > 0 && (c + c).at == 0);
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        let mut found = vec![false; inputs.len()];
        kernel.run(variant, &inputs, &mut found);
        assert!(inputs.iter().zip(&found).all(|(i, f)| kernel.call(*i) == *f));
    }
}

/// A shape whose distance may be infinite, in a tree that allows for no rounding.
#[primitive]
#[derive(Debug)]
struct Horizon {
    low: Vec3,
    high: Vec3,
    t: f32,
}

#[primitive]
impl Horizon {
    const SLACK: f32 = 0.0;

    fn intersect(&self, ray: Ray) -> Hit {
        Hit::new(ray.direction.z > 0.0, self.t)
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::new(self.low, self.high)
    }
}

#[test]
fn infinite_distances_hide_nothing() {
    let slab = |z: f32, t: f32| Horizon { low: vec3(-1.0, -1.0, z), high: vec3(1.0, 1.0, z), t };
    let prims: Vec<Horizon> = (0..40)
        .map(|i| slab(1.0 + i as f32, if i < 30 { f32::INFINITY } else { i as f32 }))
        .collect();
    let bvh = Bvh::build(&prims).expect("finite bounds");
    let ray = Ray::new(Vec3::ZERO, Vec3::Z).with_range(0.0, f32::INFINITY);
    let slice = prims[..].closest_hit(ray);
    assert_eq!((slice.t, slice.prim_id), (30.0, 30));
    assert_eq!(bvh.closest_hit(ray), slice);
    assert_eq!(bvh.multi_hit::<2>(ray)[0], slice);
    let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
    let mut found = [Hit::miss(); 20];
    kernel.run(Variant::Packet8, &[(ray,); 20], &mut found);
    assert!(found.iter().all(|h| *h == slice));
}
