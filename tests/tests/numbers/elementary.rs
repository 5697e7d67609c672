//! The elementary functions: how far they are off, what they give for special values, and that
//! every variant gives the same.

use std::sync::Mutex;

use raydsl::prelude::*;
use raydsl_tests::rng::Rng;
use raydsl_tests::values::SPECIAL_F32;
use raydsl_tests::{in_parallel, scaled};

/// What the functions promise, in ulp.
const BOUND: f64 = 4.0;

/// How many numbers or pairs a scan takes.
const SCANNED: usize = 4_000_000;

/// How far `found` is from `exact` in ulp of the result, denormal ones included.
///
/// Infinity stands for the number that would follow the largest one.
fn ulps(found: f32, exact: f64) -> f64 {
    let rounded = exact as f32;
    if found.is_nan() || exact.is_nan() {
        return if found.is_nan() && exact.is_nan() { 0.0 } else { f64::INFINITY };
    }
    if found == 0.0 && rounded == 0.0 {
        let same = found.is_sign_negative() == rounded.is_sign_negative();
        return if same { exact.abs() / 2f64.powi(-149) } else { f64::INFINITY };
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

/// The largest error in ulp, and where it is.
struct Worst<A>(Mutex<Option<(f64, A)>>);

impl<A: Copy + std::fmt::Debug> Worst<A> {
    const fn new() -> Self {
        Self(Mutex::new(None))
    }

    fn look(&self, inputs: impl Iterator<Item = A>, error: impl Fn(A) -> f64) {
        let worst = inputs.map(|a| (error(a), a)).max_by(|a, b| a.0.total_cmp(&b.0));
        let mut all = self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(worst) = worst
            && all.is_none_or(|a| worst.0 > a.0)
        {
            *all = Some(worst);
        }
    }

    #[track_caller]
    fn assert(self, name: &str) {
        let worst = self.0.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        let (error, input) = worst.unwrap_or_else(|| panic!("{name}: nothing was scanned"));
        println!("{name}: at most {error:.3} ulp, at {input:?}");
        assert!(error <= BOUND, "{name} is {error} ulp off at {input:?}");
    }
}

/// A function over an even share of all bit patterns, and over special ones.
#[track_caller]
fn scan(name: &str, f: impl Fn(f32) -> f32 + Sync, exact: impl Fn(f64) -> f64 + Sync) {
    let count = scaled(SCANNED);
    // A prime, so that every low bit is met; more numbers than that share no pattern.
    let stride = 1_073_741_789u32;
    let error = |x: f32| ulps(f(x), exact(x.into()));
    let worst = Worst::new();
    worst.look(specials(), error);
    in_parallel(count, 1 << 14, |part| {
        let numbers = part.map(|i| f32::from_bits((i as u32).wrapping_mul(stride)));
        worst.look(numbers, error);
    });
    worst.assert(name);
}

/// Special numbers, whole ones, multiples of an eighth turn, and the neighbours of all of them.
fn specials() -> impl Iterator<Item = f32> {
    let whole = (0..300).flat_map(|i| [i as f32, -i as f32, i as f32 * 0.5]);
    let turns = (1..3000).map(|i| (f64::from(i) * std::f64::consts::FRAC_PI_4) as f32);
    let powers = (-149..128).map(|n| 2f64.powi(n) as f32);
    let ends = [88.722_84, -87.336_55, -103.972_08, 128.0, -149.0, -150.0, 1.0, 8192.0];
    let all = SPECIAL_F32.iter().copied().chain(whole).chain(turns).chain(powers).chain(ends);
    all.flat_map(|x| [x.next_down(), x, x.next_up(), -x])
}

/// A function of two numbers over pairs that `pair` draws.
#[track_caller]
fn scan_pairs(
    name: &str,
    f: impl Fn(f32, f32) -> f32 + Sync,
    exact: impl Fn(f64, f64) -> f64 + Sync,
    pair: impl Fn(&mut Rng) -> (f32, f32) + Sync,
) {
    let error = |(a, b): (f32, f32)| ulps(f(a, b), exact(a.into(), b.into()));
    let worst = Worst::new();
    for a in SPECIAL_F32 {
        worst.look(SPECIAL_F32.iter().map(|b| (*a, *b)), error);
    }
    in_parallel(scaled(SCANNED), 1 << 14, |part| {
        let mut rng = Rng::new(part.start as u64);
        worst.look(part.map(|_| pair(&mut rng)), error);
    });
    worst.assert(name);
}

/// Two random bit patterns.
fn any_pair(rng: &mut Rng) -> (f32, f32) {
    let bits = rng.bits();
    (f32::from_bits(bits as u32), f32::from_bits((bits >> 32) as u32))
}

/// The sine of an angle in turns; the reduction is exact.
fn exact_sin_2pi(u: f64) -> f64 {
    let (r, quarter) = reduced_turns(u.abs());
    let v = [r.sin(), r.cos(), -r.sin(), -r.cos()][quarter];
    (v + 0.0) * 1f64.copysign(u)
}

fn exact_cos_2pi(u: f64) -> f64 {
    let (r, quarter) = reduced_turns(u.abs());
    [r.cos(), -r.sin(), -r.cos(), r.sin()][quarter] + 0.0
}

fn reduced_turns(u: f64) -> (f64, usize) {
    let turn = u.fract();
    let quarter = (4.0 * turn).round();
    ((turn - 0.25 * quarter) * std::f64::consts::TAU, quarter as usize % 4)
}

mod error {
    use super::*;

    macro_rules! functions {
        ($($name:ident: $exact:expr;)+) => {
            $(
                #[test]
                fn $name() {
                    scan(stringify!($name), raydsl::prelude::$name, $exact);
                }
            )+
        };
    }

    functions! {
        exp: f64::exp;
        exp2: f64::exp2;
        expm1: f64::exp_m1;
        log: f64::ln;
        log2: f64::log2;
        log1p: f64::ln_1p;
        sin: f64::sin;
        cos: f64::cos;
        tan: f64::tan;
        asin: f64::asin;
        acos: f64::acos;
        atan: f64::atan;
    }

    #[test]
    fn sincos_2pi() {
        scan("sincos_2pi.sin", |u| raydsl::prelude::sincos_2pi(u).sin, exact_sin_2pi);
        scan("sincos_2pi.cos", |u| raydsl::prelude::sincos_2pi(u).cos, exact_cos_2pi);
    }

    #[test]
    fn atan2() {
        scan_pairs("atan2", raydsl::prelude::atan2, f64::atan2, any_pair);
        scan_pairs("atan2 of like numbers", raydsl::prelude::atan2, f64::atan2, |rng| {
            let (x, _) = any_pair(rng);
            (x * rng.range(-2.0, 2.0), x)
        });
        scan_pairs("atan2 of denormals", raydsl::prelude::atan2, f64::atan2, |rng| {
            let denormal = |n: usize| f32::from_bits(n as u32);
            (denormal(rng.below(400)), denormal(rng.below(400)))
        });
    }

    #[test]
    fn pow() {
        let pow = raydsl::prelude::pow;
        scan_pairs("pow", pow, f64::powf, any_pair);
        // A result whose logarithm to base 2 is even over the range of `f32`.
        let exponent = |rng: &mut Rng, x: f32| {
            (f64::from(rng.range(-151.0, 129.0)) / f64::from(x).log2()) as f32
        };
        scan_pairs("pow with a result", pow, f64::powf, |rng| {
            let x = any_pair(rng).0.abs();
            (x, exponent(rng, x))
        });
        scan_pairs("pow near 1", pow, f64::powf, |rng| {
            let x = rng.range(0.5, 2.0);
            (x, exponent(rng, x))
        });
        scan_pairs("pow with whole exponents", pow, f64::powf, |rng| {
            (rng.range(-100.0, 100.0), rng.range(-100.0, 100.0).trunc())
        });
    }
}

/// Values that hold exactly, up to the sign of a zero.
mod special {
    use super::*;

    const INF: f32 = f32::INFINITY;
    const NAN: f32 = f32::NAN;
    const TINY: f32 = 1e-45;

    /// The same bits, or both NaN.
    #[track_caller]
    fn gives(found: f32, expected: f32) {
        let same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
        assert!(same, "{found:?} is not {expected:?}");
    }

    #[test]
    fn exponentials() {
        for f in [exp, exp2] {
            gives(f(0.0), 1.0);
            gives(f(-0.0), 1.0);
            gives(f(INF), INF);
            gives(f(-INF), 0.0);
            gives(f(NAN), NAN);
        }
        gives(exp(88.722_84), INF);
        assert!(exp(88.722_83).is_finite());
        gives(exp(-103.972_07), TINY);
        gives(exp(-103.972_09), 0.0);
        for n in -149..128 {
            gives(exp2(n as f32), 2f64.powi(n) as f32);
        }
        gives(exp2(128.0), INF);
        gives(exp2(-150.0), 0.0);
        gives(expm1(-INF), -1.0);
        gives(expm1(INF), INF);
        gives(expm1(NAN), NAN);
        for x in [0.0, -0.0, TINY, -TINY, f32::MIN_POSITIVE, 1e-30, -1e-30] {
            gives(expm1(x), x);
            gives(log1p(x), x);
        }
    }

    #[test]
    fn logarithms() {
        for f in [log, log2] {
            gives(f(0.0), -INF);
            gives(f(-0.0), -INF);
            gives(f(1.0), 0.0);
            gives(f(INF), INF);
            gives(f(-TINY), NAN);
            gives(f(-INF), NAN);
            gives(f(NAN), NAN);
        }
        for n in -149..128 {
            gives(log2(2f64.powi(n) as f32), n as f32);
        }
        gives(log1p(-1.0), -INF);
        gives(log1p(-1.000_000_1), NAN);
        gives(log1p(-INF), NAN);
        gives(log1p(INF), INF);
        gives(log1p(NAN), NAN);
    }

    #[test]
    fn waves() {
        for f in [sin, cos, tan] {
            gives(f(INF), NAN);
            gives(f(-INF), NAN);
            gives(f(NAN), NAN);
        }
        for x in [0.0, -0.0, TINY, -TINY, 1e-30] {
            gives(sin(x), x);
            gives(tan(x), x);
            gives(cos(x), 1.0);
        }
        for (u, s, c) in [
            (0.0, 0.0, 1.0),
            (-0.0, -0.0, 1.0),
            (0.25, 1.0, 0.0),
            (0.5, 0.0, -1.0),
            (-0.5, -0.0, -1.0),
            (0.75, -1.0, 0.0),
            (-0.75, 1.0, 0.0),
            (-3.0, -0.0, 1.0),
            (1e30, 0.0, 1.0),
            (INF, NAN, NAN),
            (NAN, NAN, NAN),
        ] {
            gives(sincos_2pi(u).sin, s);
            gives(sincos_2pi(u).cos, c);
        }
    }

    #[test]
    fn inverses() {
        use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
        for f in [asin, acos] {
            gives(f(1.000_000_1), NAN);
            gives(f(-INF), NAN);
            gives(f(NAN), NAN);
        }
        for x in [0.0, -0.0, TINY, -TINY, 1e-30] {
            gives(asin(x), x);
            gives(atan(x), x);
            gives(atan2(x, 1.0), x);
            gives(acos(x), FRAC_PI_2);
        }
        gives(asin(-1.0), -FRAC_PI_2);
        gives(acos(1.0), 0.0);
        gives(acos(-1.0), PI);
        gives(atan(INF), FRAC_PI_2);
        gives(atan(-INF), -FRAC_PI_2);
        gives(atan(1.0), FRAC_PI_4);
        gives(atan(NAN), NAN);
        for (y, x, angle) in [
            (0.0, 0.0, 0.0),
            (-0.0, 0.0, -0.0),
            (0.0, -0.0, PI),
            (-0.0, -0.0, -PI),
            (0.0, -3.0, PI),
            (-0.0, -INF, -PI),
            (1.0, 0.0, FRAC_PI_2),
            (-TINY, -0.0, -FRAC_PI_2),
            (1.0, INF, 0.0),
            (-1.0, INF, -0.0),
            (1.0, -INF, PI),
            (INF, 1.0, FRAC_PI_2),
            (-INF, f32::MIN, -FRAC_PI_2),
            (INF, INF, FRAC_PI_4),
            (-INF, -INF, -3.0 * FRAC_PI_4),
            (f32::MAX, f32::MAX, FRAC_PI_4),
            (TINY, TINY, FRAC_PI_4),
            (NAN, 1.0, NAN),
            (1.0, NAN, NAN),
            (NAN, INF, NAN),
            (0.0, NAN, NAN),
        ] {
            gives(atan2(y, x), angle);
        }
    }

    /// C17, F.10.4.4, line by line.
    #[test]
    fn powers() {
        for y in [1.0, 2.0, 3.0, 0.5, 1e10, INF] {
            let is_odd = y == 1.0 || y == 3.0;
            gives(pow(0.0, y), 0.0);
            gives(pow(-0.0, y), if is_odd { -0.0 } else { 0.0 });
            gives(pow(0.0, -y), INF);
            gives(pow(-0.0, -y), if is_odd { -INF } else { INF });
            gives(pow(INF, y), INF);
            gives(pow(INF, -y), 0.0);
            gives(pow(-INF, y), if is_odd { -INF } else { INF });
            gives(pow(-INF, -y), if is_odd { -0.0 } else { 0.0 });
        }
        for v in SPECIAL_F32.iter().copied() {
            gives(pow(1.0, v), 1.0);
            gives(pow(v, 0.0), 1.0);
            gives(pow(v, -0.0), 1.0);
            if v != 1.0 && v != 0.0 {
                gives(pow(NAN, v), NAN);
                gives(pow(v, NAN), NAN);
            }
        }
        gives(pow(-1.0, INF), 1.0);
        gives(pow(-1.0, -INF), 1.0);
        for x in [0.5, -0.5, TINY, 0.999_999_94] {
            gives(pow(x, INF), 0.0);
            gives(pow(x, -INF), INF);
        }
        for x in [2.0, -2.0, f32::MAX, 1.000_000_1] {
            gives(pow(x, INF), INF);
            gives(pow(x, -INF), 0.0);
        }
        gives(pow(-2.0, 0.5), NAN);
        gives(pow(-TINY, 1e-10), NAN);
        gives(pow(-2.0, 3.0), -8.0);
        gives(pow(-2.0, -2.0), 0.25);
        gives(pow(-1.0, 16_777_215.0), -1.0);
        gives(pow(-1.0, 16_777_216.0), 1.0);
        gives(pow(-1.000_000_1, f32::MAX), INF);
        for n in -149..128 {
            gives(pow(2.0, n as f32), 2f64.powi(n) as f32);
        }
    }
}

/// Every level gives the source's bits, and WGSL what is within the bound.
mod variants {
    use raydsl::prelude;
    use raydsl_tests::check::{Wgsl, check};
    use raydsl_tests::values::Numbers;

    macro_rules! functions {
        ($($name:ident)+) => {
            $(
                #[test]
                fn $name() {
                    check::<prelude::$name>(stringify!($name), Numbers::Any, Wgsl::Ulps(4));
                }
            )+
        };
    }

    functions! {
        exp exp2 expm1 log log2 log1p pow sin cos tan sincos_2pi asin acos atan atan2
    }
}
