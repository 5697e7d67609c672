//! Kernels of one closure: which of them share a recording, and that what differs is not shared.
//!
//! In debug builds the library records a kernel that shares a recording all the same, and checks
//! that both are one program.

use raydsl::gpu::GpuScheduler;
use raydsl::kernel;
use raydsl::kernel::Kernel;
use raydsl::light::{AnyLight, DirectionalLight, Environment, Lights, PointLight};
use raydsl::prelude::*;
use raydsl::volume::{Grid, GridConfig, PreIntegrated, TransferFunction, Volume, VolumeLight};
use raydsl_tests::gpu::gpu;

type Error = Box<dyn std::error::Error>;

/// A device of its own, so that nobody else moves its counters.
fn own() -> Result<Option<GpuScheduler>, Error> {
    Ok(if gpu().is_some() { Some(GpuScheduler::new()?) } else { None })
}

/// Runs a kernel on a device, and asks for the scalar variant's bits.
#[track_caller]
fn assert_runs<R: Type + PartialEq + std::fmt::Debug + Default>(
    gpu: &GpuScheduler,
    kernel: &Kernel<'_, (f32,), R>,
) {
    let inputs: Vec<(f32,)> = (0..7u8).map(|i| (f32::from(i) - 2.0,)).collect();
    let expected: Vec<R> = inputs.iter().map(|x| kernel.call(*x)).collect();
    let mut found: Vec<R> = inputs.iter().map(|_| R::default()).collect();
    match gpu.batch(kernel, &inputs, &mut found) {
        Ok(_) => assert_eq!(found, expected),
        Err(e) => panic!("{e}"),
    }
}

#[test]
fn numbers_and_data_are_those_of_each_kernel() -> Result<(), Error> {
    let Some(gpu) = own()? else { return Ok(()) };
    for i in 0..20u16 {
        let (factor, shift) = (f32::from(i), vec2(0.5, f32::from(i) * 2.0));
        let list: Vec<f32> = (0..=i).map(f32::from).collect();
        let last = u32::from(i);
        let kernel = kernel!(|x: f32| {
            x * factor + shift.x + shift.y * list[last as usize] + list.len() as f32
        });
        assert_runs(&gpu, &kernel);
    }
    assert_eq!(gpu.context().recorded(), 1);
    Ok(())
}

#[derive(Clone, Copy, Type)]
enum Shape {
    Line(f32),
    Square { size: f32 },
}

#[derive(Clone, Copy, PartialEq, Type)]
#[repr(u32)]
enum Sign {
    Plus,
    Minus,
}

#[test]
fn values_of_the_host_are_part_of_a_recording() -> Result<(), Error> {
    let Some(gpu) = own()? else { return Ok(()) };
    for round in 0..3u16 {
        let k = f32::from(round);
        for is_odd in [false, true] {
            let kernel = kernel!(|x: f32| if is_odd { x * k } else { x + k });
            assert_runs(&gpu, &kernel);
        }
        for count in 1..4u32 {
            let kernel = kernel!(|x: f32| {
                let mut sum = k;
                for _ in 0..host(count) {
                    sum += x;
                }
                sum
            });
            assert_runs(&gpu, &kernel);
        }
        for shape in [Shape::Line(k), Shape::Square { size: 2.0 * k }] {
            let kernel = kernel!(|x: f32| match shape {
                Shape::Line(a) => a + x,
                Shape::Square { size } => size * x,
            });
            assert_runs(&gpu, &kernel);
        }
        for sign in [Sign::Plus, Sign::Minus] {
            let kernel = kernel!(|x: f32| match sign {
                Sign::Plus => x + k,
                Sign::Minus => x - k,
            });
            assert_runs(&gpu, &kernel);
        }
        assert_eq!(gpu.context().recorded(), 2 + 3 + 2 + 2, "round {round}");
    }
    Ok(())
}

#[kernel]
trait Rule {
    fn applied(x: f32) -> Self;
    fn result(&self) -> f32;
}

#[derive(Clone, Copy, Debug, Type)]
struct Twice {
    number: f32,
}

#[derive(Clone, Copy, Debug, Type)]
struct More {
    number: f32,
}

#[kernel]
impl Rule for Twice {
    fn applied(x: f32) -> Twice {
        Twice { number: 2.0 * x }
    }

    fn result(&self) -> f32 {
        self.number
    }
}

#[kernel]
impl Rule for More {
    fn applied(x: f32) -> More {
        More { number: x + 0.5 }
    }

    fn result(&self) -> f32 {
        self.number
    }
}

#[kernel]
fn by_rule<R: Rule>(x: f32) -> f32 {
    let applied: R = R::applied(x);
    applied.result()
}

/// One closure in the source, and another for each type.
fn assert_rule_runs<R: Rule + Type>(gpu: &GpuScheduler, by: f32) {
    let kernel = kernel!(|x: f32| by_rule::<R>(x) * by);
    assert_runs(gpu, &kernel);
}

#[test]
fn closures_of_other_types_are_other_code() -> Result<(), Error> {
    let Some(gpu) = own()? else { return Ok(()) };
    for i in 0..4u8 {
        assert_rule_runs::<Twice>(&gpu, f32::from(i));
        assert_rule_runs::<More>(&gpu, f32::from(i));
    }
    assert_eq!(gpu.context().recorded(), 2);
    Ok(())
}

#[test]
fn a_slice_that_is_captured_twice_is_one_buffer() -> Result<(), Error> {
    let Some(gpu) = own()? else { return Ok(()) };
    let (one, two) = ([1.0f32, 2.0], [3.0f32, 4.0]);
    for (a, b) in [(&one, &one), (&one, &two), (&two, &two), (&two, &one)] {
        let (a, b) = (&a[..], &b[..]);
        let kernel = kernel!(|x: f32| x + a[0] + 10.0 * b[1]);
        assert_runs(&gpu, &kernel);
    }
    assert_eq!(gpu.context().recorded(), 2);
    Ok(())
}

#[test]
fn names_that_meet_are_not_mistaken() -> Result<(), Error> {
    let Some(gpu) = own()? else { return Ok(()) };
    for i in 0..3u8 {
        // Members and names may become one name of a number.
        let (a_x, a) = (f32::from(i), vec2(f32::from(i) + 1.0, 7.0));
        let kernel = kernel!(|x: f32| if x > 0.0 { a_x } else { a.x * x + a.y });
        assert_runs(&gpu, &kernel);
        let (len_of_list, list) = (f32::from(i), [1.0f32; 3]);
        let list = &list[..];
        let kernel = kernel!(|x: f32| x + len_of_list + list.len() as f32 + list[0]);
        assert_runs(&gpu, &kernel);
    }
    Ok(())
}

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

/// A cloud of balls inside a volume: what moves is numbers and buffers.
#[test]
fn scenes_and_volumes_are_switched_without_recording() -> Result<(), Error> {
    let Some(gpu) = own()? else { return Ok(()) };
    let camera = Pinhole::new(vec3(0.5, 0.5, -3.0), vec3(0.5, 0.5, 0.5), Vec3::Y, 0.6);
    let voxels: Vec<f32> = (0..64u8).map(|i| f32::from(i) / 64.0).collect();
    let grid = Grid::new(voxels, uvec3(4, 4, 4), GridConfig::new())?;
    let ball = |i: u16, k: u16| {
        let center = vec3(f32::from(i % 10), f32::from(i / 10), f32::from(k)) * 0.1;
        Ball { center, radius: 0.03 }
    };
    let steps: Vec<Vec<_>> = (0..5).map(|k| (0..100).map(|i| ball(i, k)).collect()).collect();
    let trees = steps.iter().map(|balls| Bvh::build(balls)).collect::<Result<Vec<_>, _>>()?;
    for i in 0..20u8 {
        let extinction = 2.0 + f32::from(i);
        let colors = [(0.0, Vec3::ONE)];
        let function =
            TransferFunction::from_extinction(&colors, &[(0.0, extinction), (1.0, 3.0)])?;
        let volume = Volume::new(&grid, function);
        let rule = PreIntegrated::new(0.1 + 0.01 * f32::from(i));
        let balls = &trees[usize::from(i % 5)];
        let kernel = kernel!(|ray: Ray| {
            let hit = balls.closest_hit(ray);
            let end = if hit.is_hit { hit.t } else { ray.t_max };
            volume.integrate(&rule, ray.with_range(ray.t_min, end), VolumeLight::new()).opacity()
        });
        let (mut found, mut expected) = (Image::filled(16, 16, 0.0), Image::filled(16, 16, 0.0));
        gpu.frame(&camera, &kernel, &mut found)?;
        SimpleScheduler::new().frame(&camera, &kernel, &mut expected);
        for (a, b) in found.pixels().iter().zip(expected.pixels()) {
            assert!((a - b).abs() < 1e-3, "{i}: {a} for {b}");
        }
    }
    let context = gpu.context();
    assert_eq!((context.recorded(), context.printed(), context.compiled()), (1, 1, 1));
    Ok(())
}

/// Paths under other lights, over a list of trees and an enum of lights.
#[test]
fn lights_and_lists_are_switched_without_recording() -> Result<(), Error> {
    let Some(gpu) = own()? else { return Ok(()) };
    let ball = |x: f32| Ball { center: vec3(x, 0.0, 0.0), radius: 0.5 };
    let (left, right) = ([ball(-1.0)], [ball(1.0), ball(0.2)]);
    let trees = [Bvh::build(&left)?, Bvh::build(&right)?];
    let list = BvhList::new(&trees)?;
    let bounds = raydsl::geometry::Aabb::from_points([Vec3::splat(-2.0), Vec3::splat(2.0)]);
    let sky = Environment::constant(Vec3::splat(0.2))?;
    let sun = |i: u8| DirectionalLight {
        direction: vec3(0.6, 0.8, 0.1 * f32::from(i)).normalize(),
        irradiance: Vec3::splat(f32::from(i)),
        sine: 0.0,
    };
    let point = |i: u8| PointLight { position: vec3(0.0, f32::from(i), 2.0), intensity: Vec3::ONE };
    for i in 0..6u8 {
        // Of both kinds in every second list.
        let other =
            if i % 2 == 0 { AnyLight::Directional(sun(i)) } else { AnyLight::Point(point(2)) };
        let all = [AnyLight::Point(point(i)), other];
        let mut lights = Lights::new(&all, bounds)?;
        if i >= 4 {
            lights = lights.with_environment(&sky);
        }
        let kernel = kernel!(|x: f32| {
            let ray = Ray::new(vec3(x, 0.1, 3.0), vec3(0.0, 0.0, -1.0));
            let hit = list.closest_hit(ray);
            let (position, normal) = (ray.at(hit.t), vec3(0.0, 0.0, 1.0));
            let at = SurfacePoint { position, normal, error: 0.0 };
            let sample = lights.sample(at, vec3(0.4, 0.6, 0.1));
            if hit.is_hit { sample.light.x + sample.pdf + sample.wi.y } else { -1.0 }
        });
        let inputs: Vec<(f32,)> = (0..9u8).map(|k| (f32::from(k) * 0.4 - 1.6,)).collect();
        let (mut found, mut expected) = (vec![0.0; 9], vec![0.0; 9]);
        gpu.batch(&kernel, &inputs, &mut found)?;
        kernel.run(Variant::Scalar, &inputs, &mut expected);
        for (a, b) in found.iter().zip(&expected) {
            assert!((a - b).abs() <= 1e-5 * b.abs().max(1.0), "{i}: {a} for {b}");
        }
    }
    // One for each set of kinds, with a sky and without.
    assert_eq!(gpu.context().recorded(), 4);
    Ok(())
}

#[test]
#[expect(non_snake_case, reason = "a local that is spelled like a constant is taken for one")]
fn constants_are_part_of_a_recording() -> Result<(), Error> {
    let Some(gpu) = own()? else { return Ok(()) };
    const TABLE: [f32; 3] = [1.0, 4.0, 9.0];
    for i in 0..3u8 {
        let (R, FLAG) = (f32::from(i), i == 1);
        let kernel = kernel!(|x: f32| if FLAG { x * R } else { x + R + TABLE[2] });
        assert_runs(&gpu, &kernel);
    }
    for k in 0..3u8 {
        let k = f32::from(k);
        let kernel = kernel!(|x: f32| x * TABLE[1] + k);
        assert_runs(&gpu, &kernel);
    }
    assert_eq!(gpu.context().recorded(), 3 + 1);
    Ok(())
}

/// Facts of data by which the library branches while it records.
#[test]
fn facts_of_data_are_part_of_a_recording() -> Result<(), Error> {
    let Some(gpu) = own()? else { return Ok(()) };
    let grid = |first: f32| {
        let voxels: Vec<f32> = (0..8u8).map(|i| f32::from(i) + first).collect();
        Grid::new(voxels, uvec3(2, 2, 2), GridConfig::new())
    };
    let (whole, other, gap) = (grid(1.0)?, grid(3.0)?, grid(f32::NAN)?);
    let (half, third) = (Grid::between(&whole, &other, 0.5)?, Grid::between(&other, &whole, 0.3)?);
    for grid in [&whole, &gap, &other, &half, &whole, &third, &gap] {
        let kernel = kernel!(|x: f32| grid.value(vec3(x * 0.1 + 0.5, 0.5, 0.5)));
        assert_runs(&gpu, &kernel);
    }
    assert_eq!(gpu.context().recorded(), 3, "whole, with gaps, between two steps");
    let colors = [(0.0, Vec3::ONE)];
    let soft = TransferFunction::from_extinction(&colors, &[(0.0, 1.0), (4.0, 2.0)])?;
    let hard = TransferFunction::from_extinction(&colors, &[(0.0, 5.0)])?;
    for (a, b) in [(&soft, &hard), (&soft, &soft), (&hard, &soft), (&hard, &hard)] {
        let (a, b) = (a.clone(), b.clone());
        let kernel = kernel!(|x: f32| b.at(x).extinction * 10.0 + a.at(x).extinction);
        assert_runs(&gpu, &kernel);
    }
    Ok(())
}

/// A scene of the application with a table, over scenes that differ in kind.
#[derive(Scene)]
struct Room<'a> {
    walls: Bvh<'a, Triangle>,
    #[table]
    colors: &'a [f32],
}

#[test]
fn scenes_with_tables_share_a_recording() -> Result<(), Error> {
    let Some(gpu) = own()? else { return Ok(()) };
    let wall = |x: f32| Triangle {
        v0: vec3(x - 1.0, -1.0, 0.0),
        v1: vec3(x + 1.0, -1.0, 0.0),
        v2: vec3(x, 1.0, 0.0),
    };
    let (one, two) = ([wall(0.0)], [wall(1.0), wall(-1.0)]);
    for (walls, colors) in [(&one[..], &[2.0f32][..]), (&two[..], &[3.0, 5.0][..])] {
        let room = Room { walls: Bvh::build(walls)?, colors };
        let kernel = kernel!(|x: f32| {
            let hit = room.closest_hit(Ray::new(vec3(x, 0.0, 3.0), vec3(0.0, 0.0, -1.0)));
            if hit.is_hit { room.colors[hit.prim_id as usize] * hit.t } else { 0.0 }
        });
        assert_runs(&gpu, &kernel);
    }
    assert_eq!(gpu.context().recorded(), 1);
    Ok(())
}
