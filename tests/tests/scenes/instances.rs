//! Trees that are placed many times, in every variant.

use raydsl::bvh::{Group, InstanceError, MAX_LEVELS, Object};
use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};
use raydsl_tests::placed::{brute_force, unfold};
use raydsl_tests::rng::Rng;

#[primitive(sphere(center, radius))]
#[derive(Debug, PartialEq)]
struct Ball {
    center: Vec3,
    radius: f32,
}

fn balls(rng: &mut Rng, count: usize) -> Vec<Ball> {
    (0..count).map(|_| Ball { center: rng.point(1.0), radius: rng.range(0.05, 0.3) }).collect()
}

fn triangles(rng: &mut Rng, count: usize) -> Vec<Triangle> {
    let mut one = || {
        let v0 = rng.point(1.0);
        Triangle { v0, v1: v0 + rng.point(0.5), v2: v0 + rng.point(0.5) }
    };
    (0..count).map(|_| one()).collect()
}

/// Any turn.
fn turn(rng: &mut Rng) -> Mat3 {
    let (x, y) = (rng.point(1.0).normalize(), rng.point(1.0));
    let z = x.cross(y).normalize();
    Mat3::from_cols(x, z.cross(x), z)
}

/// A map that stretches one direction `condition` times as much as another.
fn place(rng: &mut Rng, condition: f32, far: f32) -> Affine3 {
    let scale = rng.range(0.3, 2.0);
    let stretch =
        Mat3::from_diagonal(vec3(scale, scale * condition.sqrt(), scale / condition.sqrt()));
    let matrix3 = turn(rng) * stretch * turn(rng);
    Affine3 { matrix3, translation: rng.point(far) }
}

fn rays(rng: &mut Rng, count: usize, far: f32) -> Vec<(Ray,)> {
    let mut all: Vec<(Ray,)> = (0..count)
        .map(|_| {
            let (from, to) = (rng.point(1.5 * far), rng.point(far));
            (Ray::new(from, to - from),)
        })
        .collect();
    for (i, (ray,)) in all.iter_mut().enumerate() {
        match i % 7 {
            0 => ray.t_max = 0.8,
            1 => ray.t_min = 0.4,
            3 => ray.t_min = -0.5,
            4 => ray.t_max = f32::INFINITY,
            5 => {
                // From far away.
                ray.origin += ray.direction.normalize() * -1e4 * far;
                ray.t_max = f32::MAX;
            }
            2 => ray.direction = ray.direction.normalize(),
            _ => {}
        }
    }
    all[7].0.origin.x = f32::NAN;
    all[8].0.direction.z = f32::INFINITY;
    all
}

/// Panics where the scene answers otherwise than brute force; how many rays hit.
fn assert_exact<P: Primitive<Hit = Hit, Shared = ()>>(
    scene: &Instances<'_, P>,
    trees: &[Bvh<'_, P>],
    top: &[Instance],
    rays: &[(Ray,)],
) -> usize {
    let placed = unfold(scene, trees, top);
    assert_eq!(scene.count() as usize, placed.len());
    let mut met = 0;
    for (k, (ray,)) in rays.iter().enumerate() {
        let expected = brute_force(&placed, *ray);
        let first = expected.first().copied().unwrap_or(Hit::miss());
        met += usize::from(first.is_hit);
        assert_eq!(scene.closest_hit(*ray), first, "ray {k}");
        assert_eq!(scene.any_hit(*ray), first.is_hit, "ray {k}");
        let several = scene.multi_hit::<3>(*ray);
        for (i, hit) in several.iter().enumerate() {
            assert_eq!(*hit, expected.get(i).copied().unwrap_or(Hit::miss()), "ray {k}, hit {i}");
        }
        let odd = expected.iter().find(|hit| hit.inst_id % 2 == 1).copied();
        let found = scene.closest_hit_where(*ray, |hit| hit.inst_id % 2 == 1);
        assert_eq!(found, odd.unwrap_or(Hit::miss()), "ray {k}");
    }
    met
}

#[test]
fn instances_are_met_as_copies_would_be() {
    let mut rng = Rng::of("instances");
    let models = [balls(&mut rng, 40), Vec::new(), balls(&mut rng, 1)];
    let trees = models.each_ref().map(|m| Bvh::build(m).expect("finite bounds"));
    for condition in [1.0, 1.0, 10.0, 1e3, 1e6] {
        let top: Vec<Instance> =
            (0..60).map(|i| Instance::new(i % 3, place(&mut rng, condition, 6.0))).collect();
        let scene = Instances::build(&trees, &top).expect("the maps can be inverted");
        let rays = rays(&mut rng, 1500, 6.0);
        let met = assert_exact(&scene, &trees, &top, &rays);
        assert!(met > 200, "{met} of 1500 at {condition}");
        let off = scene.amplification() / f64::from(condition);
        assert!((0.5..2.0).contains(&off), "{condition}: {}", scene.amplification());
    }
}

/// A scene of three levels, its trees, and what its last group was made of.
fn nested<'a>(
    rng: &mut Rng,
    trees: &'a [Bvh<'a, Triangle>],
) -> (Instances<'a, Triangle>, Group, Vec<Instance>) {
    let mut scene = Instances::new(trees).expect("few primitives");
    let inner: Vec<_> = (0..5).map(|i| Instance::new(i % 2, place(rng, 2.0, 2.0))).collect();
    let inner = scene.group(&inner).expect("the maps can be inverted");
    let middle: Vec<Instance> = (0..6)
        .map(|i| {
            let object = if i % 3 == 0 { Object::Tree(1) } else { inner.into() };
            Instance::new(object, place(rng, 3.0, 3.0))
        })
        .collect();
    let middle = scene.group(&middle).expect("the maps can be inverted");
    let top: Vec<Instance> = [middle, inner, middle]
        .map(|group| Instance::new(group, place(rng, 1.5, 4.0)))
        .into_iter()
        .chain([Instance::new(0, place(rng, 1.0, 4.0))])
        .collect();
    scene.group(&top).expect("the maps can be inverted");
    (scene, inner, top)
}

#[test]
fn groups_of_groups() {
    let mut rng = Rng::of("groups");
    let models = [triangles(&mut rng, 30), triangles(&mut rng, 5)];
    let trees = models.each_ref().map(|m| Bvh::build(m).expect("finite bounds"));
    let (mut scene, inner, top) = nested(&mut rng, &trees);
    assert_eq!((scene.count(), scene.group_count()), (2 * 22 + 5 + 1, 3));
    let rays = rays(&mut rng, 1500, 6.0);
    let met = assert_exact(&scene, &trees, &top, &rays);
    assert!(met > 300, "{met}");
    // One group moves, and with it all that contains it.
    let moved: Vec<_> = (0..9).map(|i| Instance::new(i % 2, place(&mut rng, 2.0, 2.0))).collect();
    scene.set_group(inner, &moved).expect("the maps can be inverted");
    assert_eq!(scene.count(), 2 * 38 + 9 + 1);
    assert_exact(&scene, &trees, &top, &rays);
    // What was hit is found again by its number.
    for (ray,) in &rays {
        let hit = scene.closest_hit(*ray);
        let path = scene.path_of(hit);
        assert_eq!(path.is_empty(), !hit.is_hit);
        if let Some((first, rest)) = path.split_first() {
            assert!(*first < 4 && rest.len() < 3);
            assert_eq!(rest.is_empty(), *first == 3);
            let again = scene.primitive(hit).intersect(scene.local_ray(*ray, hit));
            assert!(again.is_hit && again.t.to_bits() == hit.t.to_bits(), "{again:?} {hit:?}");
        }
    }
}

#[test]
fn all_variants_meet_instances_alike() {
    let mut rng = Rng::of("variants of instances");
    let models = [triangles(&mut rng, 30), triangles(&mut rng, 5)];
    let trees = models.each_ref().map(|m| Bvh::build(m).expect("finite bounds"));
    let (scene, ..) = nested(&mut rng, &trees);
    let rays = rays(&mut rng, 500, 6.0);
    let closest = kernel!(|ray: Ray| {
        let hit = scene.closest_hit(ray);
        (hit, scene.any_hit(ray))
    });
    assert_variants_agree!(&closest, &rays);
    // ANCHOR: shade
    let shaded = kernel!(|ray: Ray| {
        let hit = scene.closest_hit(ray);
        let mut facing = 0.0;
        if hit.is_hit {
            let normal = scene.primitive(hit).normal(scene.local_ray(ray, hit), hit);
            let normal = scene.normal_in_scene(hit, normal);
            facing = abs_dot(normal, ray.direction);
        }
        (hit.inst_id, facing)
    });
    // ANCHOR_END: shade
    assert_variants_agree!(&shaded, &rays);
    let several = kernel!(|ray: Ray| {
        let hits = scene.multi_hit::<3>(ray);
        let odd = scene.closest_hit_where(ray, |hit: Hit| hit.inst_id % 2u32 == 1);
        let late = scene.any_hit_where(ray, |hit: Hit| hit.inst_id > 30u32);
        let last = scene.multi_hit_by::<1>(ray, |a: Hit, b: Hit| a.t > b.t);
        (hits[0], hits[2], odd, late, last[0])
    });
    assert_variants_agree!(&several, &rays);
}

#[kernel]
fn abs_dot(a: Vec3, b: Vec3) -> f32 {
    a.dot(b).abs()
}

/// A record with more than a hit in it is computed from the ray as the object sees it.
#[derive(Clone, Copy, Debug, PartialEq, Type, HitRecord)]
struct Landing {
    hit: Hit,
    at: Vec3,
}

#[primitive]
#[derive(Debug)]
struct Tile {
    v0: Vec3,
    v1: Vec3,
    v2: Vec3,
}

#[primitive]
impl Tile {
    fn intersect(&self, ray: Ray) -> Landing {
        let hit = triangle::intersect(ray, self.v0, self.v1, self.v2);
        Landing { hit, at: ray.at(hit.t) }
    }
    fn get_bounds(&self) -> Aabb {
        Aabb::from_points([self.v0, self.v1, self.v2])
    }
}

#[test]
fn records_are_those_of_the_object() {
    let mut rng = Rng::of("records");
    let tiles: Vec<Tile> =
        triangles(&mut rng, 20).iter().map(|t| Tile { v0: t.v0, v1: t.v1, v2: t.v2 }).collect();
    let trees = [Bvh::build(&tiles).expect("finite bounds")];
    let top: Vec<_> = (0..20).map(|_| Instance::new(0, place(&mut rng, 2.0, 4.0))).collect();
    let scene = Instances::build(&trees, &top).expect("the maps can be inverted");
    let rays = rays(&mut rng, 1000, 4.0);
    let mut met = 0;
    for (ray,) in &rays {
        let found = scene.closest_hit(*ray);
        if found.hit.is_hit {
            met += 1;
            let in_scene = scene.to_object(found.hit).inverse().transform_point3(found.at);
            let near = 1e-3 + 1e-6 * ray.origin.length();
            assert!((in_scene - ray.at(found.hit.t)).length() < near);
        }
    }
    assert!(met > 300, "{met}");
    let kernel = kernel!(|ray: Ray| {
        let found = scene.closest_hit(ray);
        let seen = scene.closest_hit_where(ray, |landing: Landing| landing.at.x > 0.0);
        (found.hit, found.at, seen.at)
    });
    assert_variants_agree!(&kernel, &rays);
}

/// As many levels as there may be, with two instances on each.
#[test]
fn as_deep_as_may_be() {
    let mut rng = Rng::of("levels");
    let model = triangles(&mut rng, 6);
    let trees = [Bvh::build(&model).expect("finite bounds")];
    let mut scene = Instances::new(&trees).expect("few primitives");
    let (mut object, mut top) = (Object::Tree(0), Vec::new());
    for level in 0..MAX_LEVELS {
        let apart = vec3(0.2, 0.3, 0.5) * (1.0 + level as f32);
        top = [apart, -apart]
            .map(|by| {
                Instance::new(object, Affine3 { translation: by, ..place(&mut rng, 1.1, 0.1) })
            })
            .to_vec();
        object = scene.group(&top).expect("few levels").into();
    }
    let rays = rays(&mut rng, 150, 4.0);
    assert!(assert_exact(&scene, &trees, &top, &rays) > 50);
    let kernel = kernel!(|ray: Ray| (scene.closest_hit(ray), scene.multi_hit::<2>(ray)[1]));
    assert_variants_agree!(&kernel, &rays);
}

/// What is met as far beside its box as the slack allows, along an axis, in either direction.
#[primitive]
#[derive(Debug)]
struct Beside {
    at: Vec3,
    side: Vec3,
}

#[primitive]
impl Beside {
    const SLACK: f32 = 1e-3;

    /// Met where the ray passes within a hundredth of the slack of a point beside the box.
    fn intersect(&self, ray: Ray) -> Hit {
        let reach = (self.at - ray.origin).abs();
        let reach = max(max(reach.x, reach.y), reach.z);
        let target = self.at + self.side * (0.99e-3 * reach) - ray.origin;
        let t = target.dot(ray.direction) / ray.direction.dot(ray.direction);
        let off = (ray.direction * t - target).length();
        Hit::new(t > 0.0 && off < 1e-5 * reach, t)
    }
    fn get_bounds(&self) -> Aabb {
        Aabb::new(self.at, self.at)
    }
}

/// The allowance is that of the shape whichever way it is turned.
#[test]
fn all_of_the_slack_holds_when_turned() {
    let mut rng = Rng::of("slack");
    let sign = |rng: &mut Rng| if rng.below(2) == 0 { 1.0 } else { -1.0 };
    let mut met = 0;
    for _ in 0..2000 {
        let side = vec3(sign(&mut rng), sign(&mut rng), sign(&mut rng));
        let all = [Beside { at: Vec3::ZERO, side }];
        let trees = [Bvh::build(&all).expect("finite bounds")];
        let map = Affine3 { matrix3: turn(&mut rng), translation: rng.point(1.0) };
        let scene = Instances::build(&trees, &[Instance::new(0, map)]).expect("a turn");
        // Seen from along an axis of the object, or from anywhere.
        let from = if rng.below(2) == 0 { Vec3::X * 3.0 } else { rng.point(3.0) };
        let reach = max(max(from.x.abs(), from.y.abs()), from.z.abs());
        let (from, to) =
            (map.transform_point3(from), map.transform_point3(side * (0.99e-3 * reach)));
        let rays = [(Ray::new(from, to - from),)];
        met += assert_exact(&scene, &trees, &[Instance::new(0, map)], &rays);
    }
    assert!(met > 1900, "{met} of 2000 rays aim well");
}

/// Curved shapes have the normal of the ray that they see.
#[test]
fn normals_of_placed_spheres() {
    let ball = [Ball { center: Vec3::X, radius: 1.0 }];
    let trees = [Bvh::build(&ball).expect("finite bounds")];
    let map =
        Affine3 { translation: vec3(10.0, 5.0, 0.0), ..Affine3::from_scale(vec3(2.0, 2.0, 1.0)) };
    let scene = Instances::build(&trees, &[Instance::new(0, map)]).expect("it can be inverted");
    let rays: Vec<(Ray,)> =
        [0.0, 0.5, 1.5].map(|y| (Ray::new(vec3(0.0, 5.0 + y, 0.0), Vec3::X),)).to_vec();
    let normal = kernel!(|ray: Ray| {
        let hit = scene.closest_hit(ray);
        let local = scene.local_ray(ray, hit);
        (hit.is_hit, scene.normal_in_scene(hit, scene.primitive(hit).normal(local, hit)))
    });
    for (ray,) in &rays {
        // The circle of radius 2 around (12, 5).
        let y = ray.origin.y - 5.0;
        let expected = vec3(-(4.0 - y * y).sqrt(), y, 0.0) / 2.0;
        let (is_hit, found) = normal.call((*ray,));
        assert!(is_hit && (found - expected).length() < 1e-5, "{found} instead of {expected}");
    }
    assert_variants_agree!(&normal, &rays);
}

/// Copies of the same thing in the same place: the first instance is the one that is hit.
#[test]
fn coincident_instances_are_met_in_order() {
    let mut rng = Rng::of("coincident");
    let model = triangles(&mut rng, 20);
    let trees = [Bvh::build(&model).expect("finite bounds")];
    let here = place(&mut rng, 1.0, 1.0);
    let top = vec![Instance::new(0, here); 50];
    let scene = Instances::build(&trees, &top).expect("the map can be inverted");
    let rays = rays(&mut rng, 500, 2.0);
    let mut met = 0;
    for (ray,) in &rays {
        let hits = scene.multi_hit::<3>(*ray);
        for (i, hit) in hits.iter().enumerate().filter(|(_, hit)| hit.is_hit) {
            met += 1;
            assert_eq!(hit.inst_id, i as u32);
        }
    }
    assert!(met > 100, "{met}");
    let kernel = kernel!(|ray: Ray| (scene.closest_hit(ray), scene.multi_hit::<2>(ray)[1]));
    assert_variants_agree!(&kernel, &rays);
}

/// A group of two trees, placed often.
#[test]
fn a_grove() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = Rng::of("a grove");
    let (leaves, bark) = (triangles(&mut rng, 100), triangles(&mut rng, 20));
    let crown = Affine3::from_translation(vec3(0.0, 0.0, 2.0));
    let places: Vec<Affine3> = (0..30).map(|_| place(&mut rng, 1.0, 9.0)).collect();
    // ANCHOR: build
    let trees = [Bvh::build(&leaves)?, Bvh::build(&bark)?];
    let mut grove = Instances::new(&trees)?;
    let oak = grove.group(&[Instance::new(0, crown), Instance::new(1, Affine3::IDENTITY)])?;
    let oaks: Vec<_> = places.iter().map(|place| Instance::new(oak, *place)).collect();
    grove.group(&oaks)?;
    // ANCHOR_END: build
    let rays = rays(&mut rng, 1000, 9.0);
    assert_eq!((grove.count(), grove.first_of(1)), (60, 100));
    assert!(assert_exact(&grove, &trees, &oaks, &rays) > 50);
    for (ray,) in &rays {
        let hit = grove.closest_hit(*ray);
        assert_eq!(grove.tree_of(hit), hit.is_hit.then_some(hit.inst_id as usize % 2));
    }
    Ok(())
}

#[test]
fn scenes_of_nothing() {
    let model: [Ball; 0] = [];
    let trees = [Bvh::build(&model).expect("no primitives")];
    let mut rng = Rng::of("nothing");
    let rays = rays(&mut rng, 100, 1.0);
    let empty = Instances::<Ball>::new(&trees).expect("no primitives");
    let mut hollow = Instances::new(&trees).expect("no primitives");
    hollow.group(&[]).expect("no instances");
    let of_nothing = Instances::build(&trees, &[Instance::new(0, Affine3::IDENTITY); 3]);
    let of_nothing = of_nothing.expect("the identity can be inverted");
    assert_eq!((empty.count(), hollow.count(), of_nothing.count()), (0, 0, 3));
    for scene in [&empty, &hollow, &of_nothing] {
        assert!(!scene.bounds().is_valid());
        assert!(rays.iter().all(|(ray,)| !scene.closest_hit(*ray).is_hit && !scene.any_hit(*ray)));
        let kernel = kernel!(|ray: Ray| (scene.closest_hit(ray), scene.any_hit(ray)));
        assert_variants_agree!(&kernel, &rays);
    }
}

#[test]
fn what_cannot_be_placed() {
    let model = [Ball { center: Vec3::ZERO, radius: 1.0 }];
    let trees = [Bvh::build(&model).expect("finite bounds")];
    let one = |map| {
        Instances::build(&trees, &[Instance::new(0, Affine3::IDENTITY), Instance::new(0, map)])
            .err()
    };
    let scale = |x, y, z| Affine3::from_scale(vec3(x, y, z));
    assert_eq!(one(scale(1.0, 0.0, 1.0)), Some(InstanceError::NoInverse { instance: 1 }));
    assert_eq!(one(scale(1.0, f32::NAN, 1.0)), Some(InstanceError::NoInverse { instance: 1 }));
    assert!(matches!(
        one(scale(1.0, 1e-8, 1.0)),
        Some(InstanceError::IllConditioned { instance: 1, condition, .. }) if condition > 1e7
    ));
    assert_eq!(
        one(scale(1e38, 1e38, 1e38) * scale(10.0, 10.0, 10.0)),
        Some(InstanceError::NoInverse { instance: 1 })
    );
    let far = Affine3 { translation: Vec3::splat(3.4e38), ..scale(1e37, 1e37, 1e37) };
    assert_eq!(one(far), Some(InstanceError::TooLarge { instance: 1 }));
    let mut scene = Instances::build(&trees, &[]).expect("no instances");
    let unknown = Instance::new(1, Affine3::IDENTITY);
    assert_eq!(
        scene.group(&[unknown]),
        Err(InstanceError::NoSuchObject { instance: 0, object: Object::Tree(1) })
    );
    assert_eq!(scene.group_count(), 1, "the scene is as it was");
    let mut group = scene.group(&[Instance::new(0, Affine3::IDENTITY)]).expect("it is there");
    for _ in 1..MAX_LEVELS {
        group = scene.group(&[Instance::new(group, Affine3::IDENTITY)]).expect("few levels");
    }
    assert!(scene.closest_hit(Ray::new(vec3(0.0, 0.0, -3.0), Vec3::Z)).is_hit);
    let error = scene.group(&[Instance::new(group, Affine3::IDENTITY)]);
    assert!(matches!(error, Err(InstanceError::TooDeep { levels: 9, .. })), "{error:?}");
    // A group that would contain itself.
    let error = scene.set_group(group, &[Instance::new(group, Affine3::IDENTITY)]);
    assert!(matches!(error, Err(InstanceError::NoSuchObject { .. })), "{error:?}");
    let mut other = Instances::build(&trees, &[]).expect("no instances");
    assert_eq!(other.set_group(group, &[]), Err(InstanceError::ForeignGroup));
    let error = other.group(&[Instance::new(group, Affine3::IDENTITY)]);
    assert!(matches!(error, Err(InstanceError::NoSuchObject { instance: 0, .. })), "{error:?}");
    assert!(scene.closest_hit(Ray::new(vec3(0.0, 0.0, -3.0), Vec3::Z)).is_hit, "it is as it was");
    // Each level has two hundred of the one below.
    let mut scene = Instances::new(&trees).expect("few primitives");
    let mut object = Object::Tree(0);
    let error = loop {
        match scene.group(&[Instance::new(object, Affine3::IDENTITY); 200]) {
            Ok(group) => object = group.into(),
            Err(error) => break error,
        }
    };
    assert_eq!(error, InstanceError::TooMany { count: 200u64.pow(5), limit: u64::from(u32::MAX) });
}
