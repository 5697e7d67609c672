use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn many(
    a: [f32; 4],
    b: f32,
    c: f32,
    d: f32,
    e: f32,
    f: f32,
    g: f32,
    h: f32,
    i: f32,
    j: f32,
    k: f32,
    l: f32,
    n: f32,
    o: f32,
    p: f32,
    q: f32,
    r: f32, //~ macro
) -> f32 {
    a[0] + b + c + d + e + f + g + h + i + j + k + l + n + o + p + q + r
}

#[kernel]
fn shade(x: f32) -> f32 {
    many([x; 4], x, x, x, x, x, x, x, x, x, x, x, x, x, x, x, x)
}

fn main() {}
