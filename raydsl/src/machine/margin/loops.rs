//! Tests of values that outlive loop iterations, and of the number of floats stored.

use super::*;
use crate::kernel;
use crate::machine::KernelFn;
use crate::prelude::{Vec3, Vec4, vec3, vec4};

/// Returns the kernel's `f64` results and the greatest number of floats on the way.
fn followed<F: KernelFn>(args: F::Args) -> (Vec<f64>, usize) {
    counted(|m| F::lifted(m, Type::splat(m, args)))
}

fn counted<V: Value<Margin>>(f: impl Fn(&Margin) -> V) -> (Vec<f64>, usize) {
    let most = Cell::new(0);
    let outcomes = Outcomes::of(Rounding::IEEE, 1, |m| {
        let result = f(m);
        most.set(m.floats.most());
        result
    });
    (outcomes.reference().iter().map(|leaf| leaf.value()).collect(), most.get())
}

/// Asserts that the kernel returns these numbers in `f64`, and that its outcomes contain its `f32`
/// results.
#[track_caller]
fn gives<F: KernelFn>(args: F::Args, expected: &[f64]) {
    assert_eq!(followed::<F>(args).0, expected);
    for rounding in [Rounding::IEEE, Rounding::WGSL] {
        let outcomes =
            Outcomes::of(rounding, 64, |m| F::lifted(m, <F::Args as Type>::splat(m, args)));
        assert!(outcomes.is_complete() && outcomes.contains(F::scalar(args)), "{outcomes:?}");
        let values: Vec<f64> = outcomes.reference().iter().map(|leaf| leaf.value()).collect();
        assert_eq!(values, expected);
    }
}

#[kernel]
fn many_rounds(x: f32, rounds: u32) -> f32 {
    let mut a = x;
    let mut v = vec3(x, 0.5, 0.25);
    for _ in 0..rounds {
        let w = v * 0.5 + vec3(0.125, a, -0.25);
        v = w - vec3(w.y, w.z, w.x) * 0.25;
        a = (a * 0.5 + v.x * v.y - v.z) * 0.25;
    }
    a
}

#[test]
fn many_rounds_take_little_memory() {
    let (mut a, mut v) = (0.75f64, [0.75f64, 0.5, 0.25]);
    for _ in 0..200_000 {
        let w = [v[0] * 0.5 + 0.125, v[1] * 0.5 + a, v[2] * 0.5 + -0.25];
        v = [w[0] - w[1] * 0.25, w[1] - w[2] * 0.25, w[2] - w[0] * 0.25];
        a = (a * 0.5 + v[0] * v[1] - v[2]) * 0.25;
    }
    let (found, most) = followed::<many_rounds>((0.75, 200_000));
    assert_eq!(found, [a]);
    let (_, few) = followed::<many_rounds>((0.75, 3));
    assert_eq!(most, few);
    assert!(most < 200, "{most} floats");
}

#[kernel]
fn nested(x: f32, n: u32) -> f32 {
    let mut outer = x;
    let mut total = 0.0;
    for i in 0..n {
        let at_begin = outer;
        let mut inner = outer * 0.5;
        let mut j = 0u32;
        while j < i {
            let mut innermost = inner + 1.0;
            for _ in 0..2u32 {
                innermost = innermost * 0.25 + at_begin;
            }
            inner += innermost * 0.5;
            j += 1;
        }
        outer = inner - at_begin * 0.125;
        total += at_begin * inner;
    }
    total + outer
}

#[test]
fn loops_within_loops() {
    for (x, n) in [(0.5f32, 0), (0.5, 1), (0.5, 7), (-1.25, 5)] {
        let (mut outer, mut total) = (f64::from(x), 0.0);
        for i in 0..n {
            let at_begin = outer;
            let mut inner = outer * 0.5;
            for _ in 0..i {
                let mut innermost = inner + 1.0;
                for _ in 0..2 {
                    innermost = innermost * 0.25 + at_begin;
                }
                inner += innermost * 0.5;
            }
            outer = inner - at_begin * 0.125;
            total += at_begin * inner;
        }
        gives::<nested>((x, n), &[total + outer]);
    }
}

#[kernel]
fn returns_early(x: f32, n: u32) -> (f32, u32, Vec3) {
    let mut a = x;
    let mut v = vec3(a, 1.0, 2.0);
    for i in 0..n {
        let before = a;
        a = a * 1.5 + 0.25;
        for k in 0..3u32 {
            v = v * 0.5 + vec3(before, a, 0.0);
            if a > 6.0 && k == 1 {
                return (a - before, i, v + vec3(0.0, 0.0, before));
            }
        }
    }
    (a, n, v)
}

#[test]
fn a_return_within_a_loop() {
    'inputs: for (x, n) in [(0.5f32, 20), (0.5, 4), (-9.0, 4), (7.0, 1)] {
        let mut a = f64::from(x);
        let mut v = [a, 1.0, 2.0];
        for i in 0..n {
            let before = a;
            a = a * 1.5 + 0.25;
            for k in 0..3 {
                v = [v[0] * 0.5 + before, v[1] * 0.5 + a, v[2] * 0.5];
                if a > 6.0 && k == 1 {
                    let expected = [a - before, f64::from(i), v[0], v[1], v[2] + before];
                    gives::<returns_early>((x, n), &expected);
                    continue 'inputs;
                }
            }
        }
        gives::<returns_early>((x, n), &[a, f64::from(n), v[0], v[1], v[2]]);
    }
}

/// Reads the earlier values of variables into `old` and `whole`.
#[kernel]
fn read_before_assigned(x: f32, n: u32) -> Vec4 {
    let mut a = x;
    let mut list = [x, 1.0, 2.0];
    let mut last = 0.0;
    for i in 0..n {
        let old = a;
        let whole = list;
        a = old * 0.5 + 1.0;
        list[(i % 3) as usize] = a - old;
        list[0] += whole[2];
        a += old * whole[1];
        last = old;
    }
    vec4(a, list[0] + list[1], list[2], last)
}

#[test]
fn what_was_read_does_not_change() {
    for n in 0..9u32 {
        let x = 0.625f32;
        let mut a = f64::from(x);
        let (mut list, mut last) = ([a, 1.0, 2.0], 0.0);
        for i in 0..n as usize {
            let (old, whole) = (a, list);
            a = old * 0.5 + 1.0;
            list[i % 3] = a - old;
            list[0] += whole[2];
            a += old * whole[1];
            last = old;
        }
        gives::<read_before_assigned>((x, n), &[a, list[0] + list[1], list[2], last]);
    }
}

/// Declares `kept` anew in each iteration, without always assigning it again.
#[kernel]
fn declared_within(x: f32, n: u32) -> f32 {
    let mut sum = 0.0;
    for i in 0..n {
        let mut kept = x + i as f32;
        let later;
        if i % 2 == 0 {
            kept = sum * 0.5;
            later = kept - 1.0;
        } else {
            later = kept;
        }
        if later > 2.0 {
            continue;
        }
        sum += kept * 0.25 + later;
    }
    sum
}

#[test]
fn variables_of_a_round() {
    for n in 0..8u32 {
        let (x, mut sum) = (0.375f64, 0.0);
        for i in 0..n {
            let mut kept = x + f64::from(i);
            let later = if i % 2 == 0 {
                kept = sum * 0.5;
                kept - 1.0
            } else {
                kept
            };
            if later <= 2.0 {
                sum += kept * 0.25 + later;
            }
        }
        gives::<declared_within>((0.375, n), &[sum]);
    }
}

/// Breaks with a value, also from a block, and as an argument.
#[kernel]
fn broken_off(x: f32, n: u32) -> f32 {
    let mut a = x;
    let mut i = 0u32;
    let found = a * 2.0
        + loop {
            let old = a;
            a = a * 0.5 + 1.0;
            i += 1;
            let near = 'near: {
                if i > 3 {
                    break 'near old * 0.25;
                }
                a + old
            };
            if i >= n {
                break near - old;
            }
            if near > 5.0 {
                break old;
            }
        };
    found + a
}

#[test]
fn values_of_loops() {
    for (x, n) in [(0.5f32, 1), (0.5, 3), (0.5, 6), (20.0, 6)] {
        let mut a = f64::from(x);
        let twice = a * 2.0;
        let mut i = 0;
        let value = loop {
            let old = a;
            a = a * 0.5 + 1.0;
            i += 1;
            let near = if i > 3 { old * 0.25 } else { a + old };
            if i >= n {
                break near - old;
            }
            if near > 5.0 {
                break old;
            }
        };
        gives::<broken_off>((x, n), &[twice + value + a]);
    }
}

#[derive(Clone, Copy, Debug, PartialEq, crate::Type)]
struct State {
    at: Vec3,
    steps: u32,
    sizes: [f32; 4],
    is_odd: bool,
    sign: i32,
}

#[kernel]
fn mixed(x: f32, n: u32) -> State {
    let start = State { at: vec3(x, x, 1.0), steps: 0, sizes: [x; 4], is_odd: false, sign: 1 };
    let mut all = [start; 2];
    for i in 0..n {
        let before = all[0];
        all[0].at = all[1].at * 0.5 + vec3(1.0, before.at.z, before.sizes[3]);
        all[0].sizes[(i % 4) as usize] = before.at.x - before.sizes[1];
        all[0].steps += 1;
        if before.is_odd {
            all[1] = before;
            all[1].sign = -before.sign;
        }
        all[0].is_odd = !before.is_odd;
    }
    State { sign: all[1].sign + all[0].sign, ..all[0] }
}

#[test]
fn states_of_many_leaves() {
    #[derive(Clone, Copy)]
    struct Wide {
        at: [f64; 3],
        steps: u32,
        sizes: [f64; 4],
        is_odd: bool,
        sign: i32,
    }
    for n in 0..9u32 {
        let x = 0.375f64;
        let start = Wide { at: [x, x, 1.0], steps: 0, sizes: [x; 4], is_odd: false, sign: 1 };
        let mut all = [start; 2];
        for i in 0..n as usize {
            let before = all[0];
            let other = all[1].at.map(|c| c * 0.5);
            all[0].at = [other[0] + 1.0, other[1] + before.at[2], other[2] + before.sizes[3]];
            all[0].sizes[i % 4] = before.at[0] - before.sizes[1];
            all[0].steps += 1;
            if before.is_odd {
                all[1] = Wide { sign: -before.sign, ..before };
            }
            all[0].is_odd = !before.is_odd;
        }
        let [found, other] = all;
        let whole = [f64::from(u8::from(found.is_odd)), f64::from(other.sign + found.sign)];
        let expected = [&found.at[..], &[f64::from(found.steps)], &found.sizes, &whole].concat();
        gives::<mixed>((0.375, n), &expected);
    }
}

/// Leaves a comparison open in each iteration: every path has its own variables.
#[kernel]
fn open_rounds(x: f32) -> (f32, f32) {
    let mut up = 0.0;
    let mut last = x;
    for i in 0..4u32 {
        let third = x * (1.0 / 3.0) * 3.0;
        if third > x + i as f32 * 8.0 {
            up += last * 0.5;
        } else {
            last = last * 0.5 + up;
        }
    }
    (up, last)
}

#[test]
fn each_way_has_its_own_variables() {
    let outcomes = Outcomes::of(Rounding::IEEE, 64, |m| open_rounds::lifted(m, (F(m.f32(0.7)),)));
    assert!(outcomes.is_complete() && outcomes.is_uncertain());
    // The comparison of the first iteration is open, the others are not.
    let x = f64::from(0.7f32);
    let goes = |first: bool| {
        let (mut up, mut last) = (0.0, x);
        for i in 0..4 {
            if first && i == 0 {
                up += last * 0.5;
            } else {
                last = last * 0.5 + up;
            }
        }
        [up, last]
    };
    let mut found: Vec<Vec<f64>> =
        outcomes.iter().map(|leaves| leaves.iter().map(|l| l.value()).collect()).collect();
    found.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert_eq!(found, [goes(false), goes(true)]);
}
