//! Slices that the application owns, read by kernels in every variant.

#![allow(clippy::needless_range_loop, reason = "what kernels are written in")]

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::check::{every_variant, inputs};
use raydsl_tests::kernels::{Matter, Surface};
use raydsl_tests::rng::Rng;
use raydsl_tests::values::{Numbers, random};

#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Ball {
    center: Vec3,
    radius: f32,
    id: u32,
}

#[test]
fn numbers() {
    let weights: Vec<f32> = (0..37).map(|i| (i as f32 * 0.7).fract()).collect();
    let kernel = kernel!(|x: f32, n: u32| {
        let mut sum = weights[n as usize % weights.len()];
        for i in 0..weights.len() {
            if weights[i] > 0.8 {
                continue;
            }
            sum += weights[i] * x;
        }
        sum
    });
    every_variant(&kernel, &inputs(1));
}

#[kernel]
fn nearest(balls: &[Ball], at: Vec3, limit: u32) -> u32 {
    let mut best = 1e30;
    let mut id = 0xffff_ffffu32;
    for i in 0..balls.len() {
        let ball = balls[i];
        if ball.id > limit {
            continue;
        }
        let d = (ball.center - at).length() - ball.radius;
        if d < best {
            best = d;
            id = ball.id;
        }
    }
    id
}

#[test]
fn structs_by_reference() {
    let mut rng = Rng::new(3);
    let mut number = || random::<f32>(&mut rng, Numbers::Tame);
    let balls: Vec<Ball> = (0..23)
        .map(|i| Ball {
            center: vec3(number(), number(), number()),
            radius: number().abs(),
            id: i * 2,
        })
        .collect();
    let kernel = kernel!(|x: f32, y: f32, n: u32| nearest(&balls, vec3(x, y, 0.5), n));
    every_variant(&kernel, &inputs(2));
    let none: &[Ball] = &[];
    let kernel = kernel!(|x: f32, n: u32| nearest(none, vec3(x, x, x), n));
    every_variant(&kernel, &inputs(2));
}

#[test]
fn many_types() {
    let points: Vec<Vec3> = (0..9).map(|i| vec3(i as f32, 0.5, -1.0)).collect();
    let pairs: Vec<(i32, f32)> = (0..5).map(|i| (3 - i, i as f32)).collect();
    let matters = [Matter::Glass, Matter::Matte, Matter::Mirror];
    let surfaces: Vec<Surface> =
        (0..4).map(|i| Surface { roughness: i as f32, matter: matters[i % 3] }).collect();
    let (matters, flags) = (&matters[..], &[true, false, true][..]);
    let kernel = kernel!(|x: f32, n: u32| {
        let p = points[n as usize % points.len()];
        let (i, f) = pairs[n as usize % 5];
        let matter = matters[n as usize % matters.len()];
        let mut sum = p.x * x + f + i as f32 + matters[1].albedo();
        if matter == Matter::Glass || flags[n as usize % 3] {
            sum += surfaces[n as usize % surfaces.len()].matter.albedo();
        }
        if flags.is_empty() { 0.0 } else { sum }
    });
    every_variant(&kernel, &inputs(4));
}

/// A captured variant decides a `match` while the kernel is recorded.
#[test]
fn captured_enums_prune() {
    for matter in [Matter::Matte, Matter::Mirror, Matter::Glass] {
        let kernel = kernel!(|x: f32, n: u32| match matter {
            Matter::Matte => x * 123.0,
            Matter::Mirror => x + n as f32,
            Matter::Glass => -x,
        });
        every_variant(&kernel, &inputs(5));
        let wgsl = kernel.wgsl();
        assert_eq!(wgsl.contains("123"), matter == Matter::Matte, "{wgsl}");
        // The one test is whether the invocation has an input.
        assert_eq!(wgsl.matches("if (").count(), 1, "{wgsl}");
    }
}

/// Every way to go through the elements.
#[test]
fn loops_over_elements() {
    let balls: Vec<Ball> = (0..11)
        .map(|i| Ball { center: vec3(i as f32 - 5.0, 0.5, 1.0), radius: 0.25, id: i * 3 })
        .collect();
    let weights = [0.5, -1.5, 2.0];
    let kernel = kernel!(|x: f32, n: u32| {
        let mut sum = 0.0;
        for ball in balls.iter() {
            if ball.center.x > x {
                continue;
            }
            sum += ball.radius;
        }
        for (i, ball) in balls.iter().enumerate() {
            if i as u32 > n {
                break;
            }
            sum += (ball.id + i as u32) as f32;
        }
        let table = [x, 2.0, n as f32];
        for (i, t) in table.iter().enumerate() {
            sum += t * weights[i];
        }
        for &Ball { radius, id, .. } in &balls {
            if id == 9 {
                sum -= radius;
            }
        }
        for w in weights {
            sum += w * w;
        }
        'outer: for a in &balls {
            for w in weights.iter() {
                if a.center.x * w > x {
                    continue 'outer;
                }
                if a.id > n {
                    break 'outer;
                }
                sum += 1.0;
            }
        }
        sum
    });
    every_variant(&kernel, &inputs(8));
}

/// What a condition guards is not read.
#[test]
fn guarded_elements() {
    let none: &[f32] = &[];
    let one = &[3.0f32][..];
    let has = false;
    let kernel = kernel!(|x: f32, n: u32| {
        let mut sum = x;
        if none.len() > 3 && none[3] > 1.0 {
            sum = 2.0;
        }
        if one.len() > 3 && one[3] > 1.0 {
            sum += 2.0;
        }
        if host(has) && none[0] > 1.0 {
            sum = 4.0;
        }
        let k = if none.len() > n as usize { none[n as usize] } else { x };
        let last = if one.len() > 2 { one[2] } else { one[0] };
        sum + k + last
    });
    every_variant(&kernel, &inputs(9));
}
