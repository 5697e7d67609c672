//! Elementary functions over their whole domain.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::gpu::{gpu, keeps_denormals};
use raydsl_tests::rng::Rng;
use raydsl_tests::values::SPECIAL_F32;

use super::largest;
use crate::measure::Run;
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "elementary",
    title: "Elementary functions of any bits, and of numbers where they are hard",
    clauses: &[
        "Scalar code and packets are off by no more than the function's documentation says.",
        "WGSL is off by at most 4 ulp; denormals may be zeros where the device flushes them.",
    ],
    rows,
};

/// The function of a row: all lanes take the same arm.
#[kernel]
fn function(which: u32, x: f32, y: f32) -> f32 {
    match which {
        0 => exp(x),
        1 => exp2(x),
        2 => expm1(x),
        3 => log(x),
        4 => log2(x),
        5 => log1p(x),
        6 => sin(x),
        7 => cos(x),
        8 => tan(x),
        9 => sincos_2pi(x).sin,
        10 => sincos_2pi(x).cos,
        11 => asin(x),
        12 => acos(x),
        13 => atan(x),
        14 => atan2(x, y),
        _ => pow(x, y),
    }
}

/// Bound of WGSL, in ulp.
const OF_WGSL: f64 = 4.0;

/// What a row is about.
struct Case {
    name: &'static str,
    which: u32,
    /// What the documentation says, in ulp.
    bound: f64,
    exact: fn(f64, f64) -> f64,
    /// Draws the arguments; a function of one number ignores the second.
    draw: fn(&mut Rng) -> (f32, f32),
    /// The usual way in `f32`, where there is a worse one.
    textbook: Option<fn(f32, f32) -> f32>,
}

fn rows() -> Vec<Row> {
    let of_one = |name, which, bound, exact, textbook| {
        row(Case { name, which, bound, exact, draw: any_number, textbook })
    };
    let of_two = |name, which, bound, exact, draw| {
        row(Case { name, which, bound, exact, draw, textbook: None })
    };
    vec![
        of_one("exp", 0, 0.98, |x, _| x.exp(), None),
        of_one("exp2", 1, 1.09, |x, _| x.exp2(), None),
        of_one("expm1", 2, 1.45, |x, _| x.exp_m1(), Some(|x, _| x.exp() - 1.0)),
        of_one("log", 3, 0.82, |x, _| x.ln(), None),
        of_one("log2", 4, 0.87, |x, _| x.log2(), None),
        of_one("log1p", 5, 1.39, |x, _| x.ln_1p(), Some(|x, _| (1.0 + x).ln())),
        of_one("sin", 6, 1.64, |x, _| x.sin(), None),
        of_one("cos", 7, 1.71, |x, _| x.cos(), None),
        of_one("tan", 8, 2.54, |x, _| x.tan(), None),
        of_one("sincos_2pi, sine", 9, 1.60, sin_2pi, Some(|u, _| (TAU as f32 * u).sin())),
        of_one("sincos_2pi, cosine", 10, 1.60, cos_2pi, Some(|u, _| (TAU as f32 * u).cos())),
        of_one("asin", 11, 2.36, |x, _| x.asin(), None),
        of_one("acos", 12, 1.13, |x, _| x.acos(), None),
        of_one("atan", 13, 1.87, |x, _| x.atan(), None),
        of_two("atan2", 14, 2.0, f64::atan2, any_pair),
        of_two("atan2 of numbers of like size", 14, 2.0, f64::atan2, |rng| {
            let (x, _) = any_pair(rng);
            (x * rng.range(-2.0, 2.0), x)
        }),
        of_two("atan2 of denormals", 14, 2.0, f64::atan2, |rng| {
            let denormal = |n: usize| f32::from_bits(n as u32);
            (denormal(rng.below(400)), denormal(rng.below(400)))
        }),
        of_two("pow", 15, 1.26, f64::powf, any_pair),
        row(Case {
            name: "pow with a result in range",
            which: 15,
            bound: 1.26,
            exact: f64::powf,
            draw: |rng| {
                let x = any_pair(rng).0.abs();
                (x, exponent(rng, x))
            },
            textbook: Some(|x, y| (y * x.log2()).exp2()),
        }),
        of_two("pow near 1", 15, 1.26, f64::powf, |rng| {
            let x = rng.range(0.5, 2.0);
            (x, exponent(rng, x))
        }),
        of_two("pow with whole exponents", 15, 1.26, f64::powf, |rng| {
            (rng.range(-100.0, 100.0), rng.range(-100.0, 100.0).trunc())
        }),
    ]
}

fn row(case: Case) -> Row {
    let bound = Bound { cpu: case.bound, wgsl: OF_WGSL, f64: 0.0 };
    Row::new(case.name, 1, Unit::Ulp, bound, move |run| {
        let kernels = [Kernel::of::<function>()];
        let make = |rng: &mut Rng| {
            let (x, y) = (case.draw)(rng);
            (case.which, x, y)
        };
        let exact = |&(_, x, y): &(u32, f32, f32)| (case.exact)(x.into(), y.into());
        let outcome = run
            .without_wgsl()
            .measure(&kernels, make, |input, found| Some(ulps(*found, exact(input), true)))?;
        let mut outcome = outcome;
        if run.wgsl {
            // Such a device has zeros of either sign for denormals, and what follows from them.
            let has_denormals = gpu().is_none_or(keeps_denormals);
            let is_open = |numbers: [f32; 3]| {
                let is_denormal = |x: &f32| *x != 0.0 && x.abs() < 2.0 * f32::MIN_POSITIVE;
                !has_denormals && numbers.iter().any(is_denormal)
            };
            let of_device = on_device(run).measure(&kernels, make, |input, found| {
                let exact = exact(input);
                let error = ulps(*found, exact, false);
                (!is_open([input.1, input.2, exact as f32])).then_some(error)
            })?;
            let of_device = of_device.found.into_iter().filter(|found| found.variant == "wgsl");
            outcome.found.extend(of_device);
        }
        if let Some(textbook) = case.textbook {
            let mut rng = Rng::new(run.seed);
            let errors = (0..run.count.clamp(1000, 1_000_000)).map(|_| {
                let (x, y) = (case.draw)(&mut rng);
                ulps(textbook(x, y), (case.exact)(x.into(), y.into()), false)
            });
            return Ok(outcome.beside(largest(errors)));
        }
        Ok(outcome)
    })
}

/// The same for WGSL alone.
fn on_device(run: &Run) -> Run {
    let count = run.count_in_wgsl();
    Run { count, scalar: false, packets: Vec::new(), ..*run }
}

/// How far `found` is from `exact` in ulp of the result, denormal ones included.
///
/// Infinity stands for the number that would follow the largest one. A zero of the wrong sign is
/// infinitely far off, if signs count.
fn ulps(found: f32, exact: f64, signs_count: bool) -> f64 {
    let rounded = exact as f32;
    if found.is_nan() || exact.is_nan() {
        return if found.is_nan() && exact.is_nan() { 0.0 } else { f64::INFINITY };
    }
    if found == 0.0 && rounded == 0.0 {
        let is_same = found.is_sign_negative() == rounded.is_sign_negative();
        return if is_same || !signs_count { exact.abs() / 2f64.powi(-149) } else { f64::INFINITY };
    }
    if found == rounded && found.is_infinite() {
        return 0.0;
    }
    let infinity = 2f64.powi(128);
    let exponent = (exact.abs().min(infinity).to_bits() >> 52) as i32 - 1023;
    let ulp = 2f64.powi(exponent.clamp(-126, 127) - 23);
    let number = |v: f64| v.clamp(-infinity, infinity);
    (number(found.into()) - number(exact)).abs() / ulp
}

/// Special numbers, whole ones, multiples of an eighth turn, and the neighbours of all of them.
static SPECIALS: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let whole = (0..300).flat_map(|i| [i as f32, -i as f32, i as f32 * 0.5]);
    let turns = (1..3000).map(|i| (f64::from(i) * std::f64::consts::FRAC_PI_4) as f32);
    let powers = (-149..128).map(|n| 2f64.powi(n) as f32);
    let ends = [88.722_84, -87.336_55, -103.972_08, 128.0, -149.0, -150.0, 1.0, 8192.0];
    let all = SPECIAL_F32.iter().copied().chain(whole).chain(turns).chain(powers).chain(ends);
    all.flat_map(|x| [x.next_down(), x, x.next_up(), -x]).collect()
});

/// Any bits, and every fourth time a special number.
fn any_number(rng: &mut Rng) -> (f32, f32) {
    let is_special = rng.below(4) == 0;
    let x = if is_special { rng.pick(&SPECIALS) } else { f32::from_bits(rng.bits() as u32) };
    (x, 0.0)
}

/// Any bits, and every fourth time two special numbers.
fn any_pair(rng: &mut Rng) -> (f32, f32) {
    if rng.below(4) == 0 {
        return (rng.pick(SPECIAL_F32), rng.pick(SPECIAL_F32));
    }
    let bits = rng.bits();
    (f32::from_bits(bits as u32), f32::from_bits((bits >> 32) as u32))
}

/// An exponent for which the logarithm of the power is even over the range of `f32`.
fn exponent(rng: &mut Rng, x: f32) -> f32 {
    (f64::from(rng.range(-151.0, 129.0)) / f64::from(x).log2()) as f32
}

/// The sine of an angle in turns; the reduction is exact.
fn sin_2pi(u: f64, _: f64) -> f64 {
    let (r, quarter) = reduced_turns(u.abs());
    let v = [r.sin(), r.cos(), -r.sin(), -r.cos()][quarter];
    (v + 0.0) * 1f64.copysign(u)
}

fn cos_2pi(u: f64, _: f64) -> f64 {
    let (r, quarter) = reduced_turns(u.abs());
    [r.cos(), -r.sin(), -r.cos(), r.sin()][quarter] + 0.0
}

fn reduced_turns(u: f64) -> (f64, usize) {
    let turn = u.fract();
    let quarter = (4.0 * turn).round();
    ((turn - 0.25 * quarter) * TAU, quarter as usize % 4)
}
