//! Trees: what they say of themselves, and hits at places where only a mistake would lose them.

use std::error::Error;

use raydsl::bvh::{BuildQuality, Instance, Instances};
use raydsl::geometry::cuboid;
use raydsl::kernel;
use raydsl::machine::{Leaf, Rounding};
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;

use super::{Ball, Chest};

#[test]
fn trees_say_what_they_are() -> Result<(), Box<dyn Error>> {
    let ball = |i: u16| Ball { center: Vec3::X * f32::from(i), radius: 0.4 };
    let balls: Vec<Ball> = (0..20).map(ball).collect();
    let binary = Bvh::build(&balls)?;
    let wide = |min_wide_size| {
        Bvh::build_wide(&balls, &[], &BuildConfig { min_wide_size, ..BuildConfig::default() })
    };
    let (small, wide) = (wide(21)?, wide(20)?);
    assert!(!binary.is_wide() && !small.is_wide());
    assert_eq!(wide.is_wide(), raydsl::testing::can_run(Variant::Packet8, "wide trees"));
    let none = Bvh::build(&balls[..0])?;
    for (tree, count) in [(binary, 20), (wide, 20), (none, 0)] {
        let detached = tree.detach();
        assert_eq!((detached.len(), detached.is_empty()), (count, count == 0));
    }
    Ok(())
}

/// Scenes of sizes at which the builder scales coordinates are cut like others: a tree with parts of
/// primitives finds what the list of all finds.
#[test]
fn tiny_and_huge_primitives_are_cut() -> Result<(), Box<dyn Error>> {
    let mut rng = Rng::of("cut at all sizes");
    // Long sticks through the origin's neighbourhood, so that parts lie on both sides of 0.
    let stick = |rng: &mut Rng| {
        let (center, mut half) = (rng.point(1.0), Vec3::splat(0.02));
        half[rng.below(3)] = 1.5;
        (center - half, center + half)
    };
    let sticks: Vec<(Vec3, Vec3)> = (0..200).map(|_| stick(&mut rng)).collect();
    for exponent in [-70, 122] {
        let size = 2f32.powi(exponent);
        let chests = sticks.iter().map(|&(min, max)| Chest { min: min * size, max: max * size });
        let chests: Vec<Chest> = chests.collect();
        let config = BuildConfig { quality: BuildQuality::Best, ..BuildConfig::default() };
        let tree = Bvh::build_with(&chests, &config)?;
        assert!(tree.statistics().duplication > 1.1, "2^{exponent}: nothing is cut");
        let mut hits = 0;
        for _ in 0..2000 {
            let origin = rng.direction() * 4.0;
            let ray = Ray::new(origin * size, rng.point(1.5) - origin);
            let expected = chests[..].closest_hit(ray);
            hits += u32::from(expected.is_hit);
            assert_eq!(tree.closest_hit(ray), expected, "2^{exponent}: {ray:?}");
        }
        assert!(hits > 500, "2^{exponent}: {hits}");
    }
    Ok(())
}

/// A box whose bounds reach beyond it, as those of a shape may that is hard to bound.
#[primitive]
#[derive(Debug)]
struct Wrapped {
    min: Vec3,
    max: Vec3,
    reach: Vec3,
}

#[primitive]
impl Wrapped {
    const SLACK: f32 = cuboid::SLACK;

    fn intersect(&self, ray: Ray) -> Hit {
        cuboid::intersect(ray, self.min, self.max)
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::new(self.min.min(-self.reach), self.max.max(self.reach))
    }

    fn split_primitive(&self, axis: usize, at: f32) -> (Aabb, Aabb) {
        Aabb::new(self.min, self.max).split(axis, at)
    }
}

/// The cheapest cut is at x = 0. The first box begins just below it, and is cheaper whole above; the
/// bounds of the others begin far below it, but nothing of them does. So no part is left below.
#[test]
fn a_cut_with_an_empty_side_is_none() -> Result<(), Box<dyn Error>> {
    let reach = vec3(10.0, 100.0, 100.0);
    let chests = [
        Wrapped { min: vec3(-0.1, 0.0, 0.0), max: vec3(10.0, 8.0, 8.0), reach: Vec3::ZERO },
        Wrapped { min: vec3(1.0, 1.0, 1.0), max: vec3(9.0, 10.0, 10.0), reach },
        Wrapped { min: vec3(2.0, 1.0, 1.0), max: vec3(10.0, 10.0, 10.0), reach },
    ];
    let config = BuildConfig {
        quality: BuildQuality::Best,
        max_leaf_size: 1,
        max_duplication: 1.0,
        ..BuildConfig::default()
    };
    let tree = Bvh::build_with(&chests, &config)?;
    let statistics = tree.statistics();
    assert_eq!((statistics.leaves, statistics.duplication), (3, 1.0));
    let mut rng = Rng::of("an empty side");
    for _ in 0..500 {
        let origin = rng.direction() * 30.0;
        let ray = Ray::new(origin, rng.point(10.0) - origin);
        assert_eq!(tree.closest_hit(ray), chests[..].closest_hit(ray), "{ray:?}");
    }
    Ok(())
}

/// An object that lies far from its own origin is placed at the scene's. Its rays are rounded by 1/32
/// there, which is 2 in the scene: they hit or miss as the object's own primitive says.
#[test]
fn instances_hold_the_hits_of_their_rounded_rays() -> Result<(), Box<dyn Error>> {
    const FAR: f32 = 1e6;
    const SCALE: f32 = 64.0;
    let corner = |x: f32, y: f32| vec3(FAR + x, y, 0.0);
    let face = Triangle { v0: corner(0.0, -4.0), v1: corner(4.0, 0.0), v2: corner(0.0, 4.0) };
    let (faces, to_object) = ([face], vec3(FAR, 0.0, 0.0));
    let trees = [Bvh::build(&faces)?];
    let to_outer =
        Affine3 { translation: to_object * -SCALE, ..Affine3::from_scale(Vec3::splat(SCALE)) };
    let scene = Instances::build(&trees, &[Instance::new(0, to_outer)])?;
    let mut rng = Rng::of("far objects");
    let (mut outside, mut misses) = (0, 0);
    for _ in 0..2000 {
        // Aimed at the edge at x = 0.
        let target = vec3(rng.range(-2.0, 2.0), rng.range(-200.0, 200.0), 0.0);
        let origin = target + vec3(rng.range(-300.0, 300.0), 0.0, -300.0);
        let ray = Ray::new(origin, target - origin);
        let within = Ray::new(origin / SCALE + to_object, ray.direction / SCALE);
        let expected = face.intersect(within);
        let found = scene.closest_hit(ray);
        assert_eq!((found.is_hit, found.t), (expected.is_hit, expected.t), "{ray:?}");
        outside += u32::from(expected.is_hit && target.x < -0.5);
        misses += u32::from(!expected.is_hit);
    }
    // Hits beside the exact triangle are what this is about.
    assert!(outside > 100 && misses > 100, "{outside} {misses}");
    Ok(())
}

/// The reference in `f64` finds what is far from the world's origin and near the ray's, alone and
/// placed.
#[test]
fn the_reference_finds_what_is_far_away() -> Result<(), Box<dyn Error>> {
    let far = Vec3::splat(1e6);
    let face = |at: Vec3| Triangle { v0: at, v1: at + Vec3::X * 3.0, v2: at + Vec3::Y * 3.0 };
    let step = |i: u16| Vec3::X * (4.0 * f32::from(i));
    let faces: Vec<Triangle> = (0..16).map(|i| face(far + step(i))).collect();
    let tree = Bvh::build(&faces)?;
    let near = [face(Vec3::ZERO)];
    let trees = [Bvh::build(&near)?];
    let place = |i: u16| Instance::new(0, Affine3::from_translation(far + step(i)));
    let placed: Vec<Instance> = (0..16).map(place).collect();
    let scene = Instances::build(&trees, &placed)?;
    let kernel = kernel!(|ray: Ray| {
        let (own, placed) = (tree.closest_hit(ray), scene.closest_hit(ray));
        (own.is_hit, own.prim_id, own.t, placed.is_hit, placed.inst_id, placed.t)
    });
    for i in 0..16 {
        // Next to the edge of a box.
        let ray = Ray::new(far + step(i) + vec3(1.0, 0.125, -8.0), Vec3::Z);
        let outcomes = kernel.outcomes((ray,), Rounding::IEEE, 64);
        let found: Vec<f64> = outcomes.reference().iter().copied().map(Leaf::value).collect();
        let expected = [1.0, f64::from(i), 8.0, 1.0, f64::from(i), 8.0];
        let is_near = found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-9);
        assert!(is_near && found.len() == 6, "{found:?}, not {expected:?}: {ray:?}");
    }
    Ok(())
}
