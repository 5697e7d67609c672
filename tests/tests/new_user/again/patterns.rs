//! Procedural textures, some made of others. (enum with fields in enums, bare integers, closure)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

#[derive(Clone, Copy, PartialEq, Type)]
enum Axis {
    U,
    V,
}

#[derive(Clone, Copy, Type)]
enum Simple {
    Solid(Vec3),
    Ramp { from: Vec3, to: Vec3, along: Axis },
}

#[derive(Clone, Copy, Type)]
enum Pattern {
    Plain(Simple),
    Checker { a: Simple, b: Simple, count: i32 },
    Rings { color: Vec3, other: Simple, width: f32 },
}

#[kernel]
impl Simple {
    fn color(&self, uv: Vec2) -> Vec3 {
        match *self {
            Simple::Solid(color) => color,
            Simple::Ramp { from, to, along: Axis::U } => from.lerp(to, uv.x),
            Simple::Ramp { from, to, .. } => from.lerp(to, uv.y),
        }
    }
}

#[kernel]
fn color(pattern: Pattern, uv: Vec2) -> Vec3 {
    let cell = |x: f32, n: i32| (x * n as f32).floor() as i32;
    match pattern {
        Pattern::Plain(simple) => simple.color(uv),
        Pattern::Checker { a, b, count } => {
            let sum = cell(uv.x, count) + cell(uv.y, count);
            if sum % 2 == 0 { a.color(uv) } else { b.color(uv) }
        }
        Pattern::Rings { color, other, width } => {
            let r = (uv - Vec2::splat(0.5)).length() / width;
            if r.fract() < 0.5 { color } else { other.color(uv) }
        }
    }
}

#[test]
fn patterns_have_colours() {
    let ramp = Simple::Ramp { from: Vec3::X, to: Vec3::Y, along: Axis::V };
    let patterns = vec![
        Pattern::Plain(Simple::Solid(Vec3::Z)),
        Pattern::Checker { a: ramp, b: Simple::Solid(Vec3::ONE), count: 4 },
        Pattern::Rings { color: Vec3::ZERO, other: ramp, width: 0.1 },
    ];
    let kernel = kernel!(|i: u32, uv: Vec2| color(patterns[i as usize % patterns.len()], uv));
    let inputs: Vec<(u32, Vec2)> =
        (0..600).map(|i| (i % 3, vec2((i % 23) as f32 / 23.0, (i % 29) as f32 / 29.0))).collect();
    assert_variants_agree!(&kernel, &inputs);
    assert_eq!(kernel.call((0, Vec2::ZERO)), Vec3::Z);
    assert_eq!(kernel.call((1, vec2(0.3, 0.1))), Vec3::ONE);
}
