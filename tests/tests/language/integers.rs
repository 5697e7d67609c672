//! Integers whose types the source leaves to inference: kernels mean by them what Rust means.
//!
//! The scalar variant is the user's own function, so every kernel here is compared with what rustc
//! inferred.

#![allow(
    clippy::needless_range_loop,
    clippy::never_loop,
    reason = "counters that index, and values of loops, are what is tested"
)]

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

/// Numbers of each type that a counter or a variable may take from what it meets.
fn inputs() -> Vec<(f32, u32, i32)> {
    (0..60).map(|i| (i as f32 * 0.1 - 2.0, i % 5, i as i32 - 20)).collect()
}

#[kernel]
fn counters(x: f32, n: u32, k: i32) -> f32 {
    let weights = [1.0, 2.0, 4.0, 8.0];
    let mut y = x;
    for i in 0..4 {
        y += i as f32;
    }
    for i in 0..4 {
        y += weights[i] * x;
    }
    for i in (0..4).rev() {
        y -= weights[i];
    }
    for i in 1..=3 {
        y += weights[i] * (i + 1) as f32;
    }
    for i in (0..9).step_by(2) {
        y += i as f32 + n as f32;
    }
    for i in 0..n {
        for j in i..5 {
            y += (i * j) as f32;
        }
    }
    for i in -3..3 {
        if i < k {
            y += i as f32;
        }
    }
    y
}

#[kernel]
fn variables(x: f32, n: u32, k: i32) -> f32 {
    let mut alone = 0;
    while alone < 5 {
        alone += 1;
    }
    let mut unsigned = 7;
    unsigned += n;
    let mut signed = 1;
    signed -= k;
    let mut compared = 0;
    while compared < n {
        compared += 1;
    }
    let mut assigned = 3;
    if x > 0.0 {
        assigned = n;
    }
    let mut shifted = 5;
    shifted = (shifted << 2) ^ 9;
    let mut backwards = 100;
    backwards = n + 3 - backwards % 2;
    let (mut low, mut high) = (0, 1);
    low += n;
    high += k;
    let first = 4;
    let mut later = first;
    later += n;
    let negative = -k;
    let mut turned = -1;
    turned *= negative;
    let sum = alone as f32 + unsigned as f32 + signed as f32 + compared as f32 + assigned as f32;
    let more = shifted as f32 + backwards as f32 + low as f32 + high as f32 + later as f32;
    sum + more + turned as f32
}

#[kernel]
fn outcomes(x: f32, n: u32, k: i32) -> f32 {
    let chosen = if x > 1.0 { 3 } else { 1 };
    let kind = match n {
        0 => 5,
        1 | 2 => 6,
        _ => -7,
    };
    let mixed = if x > 0.0 { n } else { 2 };
    let found = loop {
        if x > 0.5 {
            break 8;
        }
        break 9;
    };
    let at = if k > 0 { 2 } else { 0 };
    let list = [10.0, 20.0, 30.0];
    let mut count = 0;
    count += if n > 2 { 1 } else { 2 };
    let kind_of_kind = match chosen {
        1 => 100,
        3 => 300,
        _ => 0,
    };
    let sum = chosen as f32 + kind as f32 + mixed as f32 + found as f32 + list[at];
    sum + count as f32 + kind_of_kind as f32
}

#[kernel]
fn arrays(x: f32, n: u32, k: i32) -> f32 {
    let mut list = [0; 4];
    for i in 0..4 {
        list[i] = n + i as u32;
    }
    list[1] += 3;
    let mut signed = [1, 2, 3];
    signed[2] -= k;
    let primes = [2, 3, 5, 7];
    let mut at = 0;
    if x > 0.0 {
        at = 3;
    }
    let mut sum = 0;
    for p in primes {
        sum += p * n;
    }
    (list[0] + list[1] * list[3]) as f32 + signed[2] as f32 + primes[at] as f32 + sum as f32
}

#[derive(Clone, Copy, Debug, PartialEq, raydsl::Type)]
struct Step {
    index: u32,
    shift: i32,
}

#[kernel]
fn twice(n: u32) -> u32 {
    2 * n
}

#[kernel]
fn bump(n: &mut i32, by: i32) {
    *n += by;
}

#[kernel]
fn passed_on(x: f32, n: u32, k: i32) -> Step {
    let mut argument = 1;
    if x > 0.0 {
        argument = 2;
    }
    let mut changed = 0;
    bump(&mut changed, k);
    let mut by = 3;
    if x < 1.0 {
        by = 4;
    }
    bump(&mut changed, by);
    let mut member = 0;
    if n > 1 {
        member = 5;
    }
    Step { index: twice(argument) + member, shift: changed }
}

#[kernel]
fn early(x: f32, n: u32, k: i32) -> i32 {
    let mut count = 0;
    for i in 0..8 {
        if i * 2 > n {
            return count;
        }
        count += k;
        if x > 1.0 {
            continue;
        }
        count += 1;
    }
    count
}

#[test]
fn functions() {
    let inputs = inputs();
    assert_variants_agree!(counters, &inputs);
    assert_variants_agree!(variables, &inputs);
    assert_variants_agree!(outcomes, &inputs);
    assert_variants_agree!(arrays, &inputs);
    assert_variants_agree!(passed_on, &inputs);
    assert_variants_agree!(early, &inputs);
}

#[test]
fn results_of_closures() {
    let inputs: Vec<(f32, u32)> = (0..60).map(|i| (i as f32 * 0.1 - 2.0, i)).collect();
    let counted = kernel!(|x: f32, _n: u32| {
        let mut n = 0;
        for i in 0..3 {
            if x > i as f32 {
                n += 1;
            }
        }
        n
    });
    assert_variants_agree!(&counted, &inputs);
    let several = kernel!(|x: f32, c: u32| {
        let mut n = 7;
        n = (n << 2) ^ 5;
        let m = if x > 0.0 { 2 } else { -3 };
        let mut z = 0;
        z += c;
        (n, m, min(z, 3), c << n, 1 - n, [0, 1])
    });
    assert_variants_agree!(&several, &inputs);
    assert_variants_agree!(&kernel!(|_x: f32, _n: u32| 3), &inputs);
    let returned = kernel!(|x: f32, n: u32| {
        if x > 1.0 {
            return 9;
        }
        let mut m = 2;
        m += n;
        m
    });
    assert_variants_agree!(&returned, &inputs);
}

#[test]
fn closures_within() {
    let triangles = raydsl_tests::scenes::triangles(40);
    let bvh = Bvh::build(&triangles).expect("a tree");
    let inputs: Vec<(Ray,)> =
        raydsl_tests::scenes::random_rays(5, 60).into_iter().map(|r| (r,)).collect();
    let kernel = kernel!(|ray: Ray| {
        let mut wanted = 1;
        if ray.direction.x > 0.0 {
            wanted = 0;
        }
        let hit = bvh.closest_hit_where(ray, |hit: Hit| hit.prim_id % 2 == wanted);
        let mut count = 0;
        let met = bvh.any_hit_each::<3>(|i: u32| {
            let mut far = ray;
            far.t_max = 0.5 * (i + 1) as f32;
            far
        });
        for i in 0..3 {
            if met[i] {
                count += 1;
            }
        }
        (hit.prim_id, count)
    });
    assert_variants_agree!(&kernel, &inputs);
}

#[kernel]
fn of_pair((x, n): (f32, u32), k: (i32, i32)) -> f32 {
    x * n as f32 + (k.0 - k.1) as f32
}

/// Tuples with integers whose types the function, or the result, says.
#[kernel]
fn pairs(x: f32, n: u32, k: i32) -> (i32, f32) {
    let mut best = (-1, 0.0);
    for i in 0..4 {
        let y = of_pair((x, 2), (3, k)) * i as f32;
        if y > best.1 {
            best = (i, y);
        }
    }
    let other = (1.5, 7);
    best.1 += of_pair(other, (k, 1)) + of_pair((x, n), (1, 2));
    best
}

#[test]
fn tuples_of_integers_take_their_types_from_what_they_are_for() {
    assert_variants_agree!(pairs, &inputs());
}
