//! Closures as arguments of kernels.

use raydsl::prelude::*;
use raydsl::{Type, assert_variants_agree, kernel};

use super::pairs;

#[kernel]
fn integrate(f: impl Fn(f32) -> f32, from: f32, to: f32, steps: u32) -> f32 {
    let width = (to - from) / steps as f32;
    let mut sum = 0.0;
    for i in 0..steps {
        sum += f(from + (i as f32 + 0.5) * width);
    }
    sum * width
}

/// The first root of `f` on a grid, with exits and a condition of the closure.
#[kernel]
fn first_root<F>(f: F, mut x: f32, step: f32) -> Option<f32>
where
    F: Fn(f32) -> f32 + Copy,
{
    let mut before = f(x);
    for _ in 0..20 {
        x += step;
        let now = f(x);
        if before * now < 0.0 {
            return Some(x - step * now / (now - before));
        }
        if now.abs() > 50.0 {
            return None;
        }
        before = now;
    }
    None
}

/// Passes its closure on, twice, and one of its own that calls it.
#[kernel]
fn mean(f: &impl Fn(f32) -> f32, x: f32) -> f32 {
    let whole = integrate(f, x, x + 1.0, 4);
    let squares = integrate(|t| f(t) * f(t), x, x + 1.0, 4);
    whole + squares + f(x)
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Wave {
    height: f32,
    length: f32,
}

#[kernel]
impl Wave {
    fn at(&self, x: f32) -> f32 {
        self.height * (1.0 - 0.25 * x * self.length)
    }

    fn mapped(&self, change: impl Fn(f32, &Wave) -> f32, x: f32) -> f32 {
        if x < -1.0 {
            return change(x, self);
        }
        change(self.at(x), self) + change(x, &Self { height: 2.0, length: x })
    }

    fn sum<F: Fn(u32) -> Wave>(x: f32, wave: F) -> f32 {
        let mut sum = 0.0;
        for i in 0..3u32 {
            sum += wave(i).at(x);
        }
        sum
    }
}

#[kernel]
trait Profile {
    fn height(&self, x: f32) -> f32;

    fn slope(&self, x: f32, smooth: impl Fn(f32) -> f32) -> f32;
}

#[kernel]
impl Profile for Wave {
    fn height(&self, x: f32) -> f32 {
        self.at(x)
    }

    fn slope(&self, x: f32, smooth: impl Fn(f32) -> f32) -> f32 {
        (smooth(self.at(x + 0.5)) - smooth(self.at(x))) * 2.0
    }
}

#[kernel]
fn sloping<P: Profile>(profile: P, bend: impl Fn(f32) -> f32, x: f32) -> f32 {
    let a = profile.slope(x, |y: f32| bend(y) + profile.height(x));
    a + bend(x)
}

/// Changes a variable, and returns from within loops.
#[kernel]
fn count_until(count: &mut u32, is_end: impl Fn(u32) -> bool) -> bool {
    for i in 0..10u32 {
        for k in 0..2u32 {
            *count += k;
            if is_end(i * 2 + k) {
                return true;
            }
        }
    }
    false
}

#[kernel]
fn roots(a: f32, b: f32) -> f32 {
    let first = first_root(|x| x * x - a - 0.00137, b, 0.251);
    let second = first_root(
        |x: f32| {
            if x > a {
                return x - b;
            }
            let y = x * 0.5;
            y - a
        },
        -2.003,
        0.3107,
    );
    first.unwrap_or(-1.0) + second.unwrap_or(-2.0)
}

#[kernel]
fn all(a: f32, b: f32) -> f32 {
    let mut scale = a;
    scale += 1.0;
    let wave = Wave { height: scale, length: 1.5 };
    let mut sum = integrate(|x| wave.at(x) * scale, a, b, 5);
    scale = 2.0;
    if b > 0.0 {
        sum += mean(&|x: f32| x * scale + a, b);
    }
    sum += integrate(|x| integrate(|y| x * y + a, 0.0, b, 3), 0.0, a, 3);
    sum += wave.mapped(|x: f32, w: &Wave| x * w.length + b, a);
    sum += Wave::sum(a, |i| Wave { height: i as f32, ..wave });
    sum += sloping(wave, |x| x.max(b), a);
    let mut count = 3;
    if count_until(&mut count, |i| i as f32 > a * 9.7 + 0.013) {
        sum += 100.0;
    }
    sum + count as f32
}

#[kernel]
fn folded<T: Profile>(start: T, next: impl Fn(T) -> T, x: f32) -> f32 {
    next(next(start)).height(x)
}

/// Closures with names, that call each other, are passed on, and return early.
#[kernel]
fn named(a: f32, b: f32) -> f32 {
    let mut k = a;
    k += 1.5;
    let bent = |x: f32| {
        if x < b {
            return x * k;
        }
        let y = x - k;
        y * 0.5
    };
    let count = |i: u32, by: u32| -> u32 { i * by + 1 };
    let both = |x: f32, i: u32| bent(x) + count(i, 2) as f32;
    let wave = |h: f32| Wave { height: h, length: a };
    let mut sum = integrate(bent, a * 1.013, b + 2.0017, 5) + integrate(|x| both(x, 3), 0.0, b, 2);
    for i in 0..3u32 {
        sum += both(sum, i);
    }
    sum + wave(b).at(bent(1.01)) + mean(&bent, a)
}

#[test]
fn with_names() {
    let inputs: Vec<(f32, f32)> =
        pairs().into_iter().map(|(x, y)| (x * 1.013 + 0.0021, y * 0.987 - 0.0047)).collect();
    assert_variants_agree!(named, &inputs);
    let factor = 0.75;
    let kernel = kernel!(|a: f32, b: f32| {
        let scaled = |x: f32| x * factor + b;
        scaled(a) + integrate(scaled, a, b, 3)
    });
    assert_variants_agree!(&kernel, &inputs);
}

#[test]
fn in_kernels() {
    assert_variants_agree!(all, &pairs());
    assert_variants_agree!(roots, &pairs());
}

#[test]
fn in_closures_with_captures() {
    let (factor, table) = (0.75f32, vec![0.5f32, -1.0, 2.0, 0.25]);
    let kernel = kernel!(|a: f32, b: f32| {
        let sum = integrate(|x| x * factor + table[1], a, b, 4);
        let of_table = integrate(|x| table[(x.abs() * 3.0) as usize % 4], a, b, 6);
        let wave = Wave { height: a, length: b };
        sum + of_table + folded(wave, |w| Wave { height: w.length, length: factor }, b)
    });
    assert_variants_agree!(&kernel, &pairs());
}

#[test]
fn the_source_is_an_ordinary_function() {
    let mut calls = 0;
    let squares = |x: f32| x * x;
    assert!((integrate(squares, 0.0, 1.0, 100) - 1.0 / 3.0).abs() < 1e-4);
    assert_eq!(first_root(|x| x - 1.1, 0.0, 0.25), Some(1.1));
    assert!(count_until(&mut calls, |i| i == 3));
    assert_eq!(calls, 2);
}
