//! Bounds of elementary functions, from std's `f64` functions instead of their polynomials.

use core::f64::consts::{PI, TAU};

use super::function::Function;
use crate::machine::Margin;
use crate::machine::margin::{Interval, Known};

/// Returns the values and ranges of an elementary function for these floats.
pub(super) fn of(m: &Margin, function: Function, args: &[Known]) -> Vec<Known> {
    match (function, args) {
        (Function::SinCos2Pi, [u]) => {
            let waves = [
                (turn_sin as fn(f64) -> f64, wave(u.range, TAU, turn_sin)),
                (turn_cos, wave(u.range, TAU, turn_cos)),
            ];
            waves.map(|(f, range)| result(m, f(u.value), range)).to_vec()
        }
        (Function::Atan2, [y, x]) => {
            let range = angle(m, *y, *x);
            vec![result(m, y.value.atan2(x.value), range)]
        }
        (Function::Pow, [x, y]) => {
            vec![result(m, x.value.powf(y.value), power(x.range, y.range))]
        }
        (function, [x]) => {
            let (value, range) = of_one(function, x.value, x.range);
            vec![result(m, value, range)]
        }
        _ => Vec::new(),
    }
}

/// Adds the rounding error to a result. Exact zeros, infinities and NaNs are the same in every
/// variant.
fn result(m: &Margin, value: f64, range: Interval) -> Known {
    if range.is_nan() || range.as_point().is_some_and(|v| v == 0.0 || v.is_infinite()) {
        return m.bounded(value, range);
    }
    m.rounded(value, range, m.rounding().function())
}

/// Returns the range of angles of the points of a rectangle. They jump across the negative axis of
/// x: the side of the point is a decision.
fn angle(m: &Margin, y: Known, x: Known) -> Interval {
    let (up, across) = (y.range, x.range);
    if up.is_nan() || across.is_nan() {
        return Interval::NAN;
    }
    let nan = up.nan || across.nan;
    let crosses = up.is_negative().is_none() && across.low.is_sign_negative();
    if crosses && across.high >= 0.0 {
        return Interval::new(-PI, PI, nan);
    }
    let mut ends = [up.low, up.high];
    if crosses {
        let upper = y.value.is_sign_positive();
        let is_other = m.chooses_other();
        ends = if upper ^ is_other { [0.0, up.high] } else { [up.low, -0.0] };
    }
    let corner = |y: f64| [y.atan2(across.low), y.atan2(across.high)];
    Interval::around([corner(ends[0]), corner(ends[1])].concat(), nan)
}

/// Returns the value, and the interval of values over an interval.
fn of_one(function: Function, v: f64, x: Interval) -> (f64, Interval) {
    let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
    let steady = |domain: (f64, f64), f: fn(f64) -> f64| (f(v), x.monotone(domain, f));
    match function {
        Function::Sin => (v.sin(), wave(x, 1.0, f64::sin)),
        Function::Cos => (v.cos(), wave(x, 1.0, f64::cos)),
        Function::Tan => (v.tan(), tangent(x)),
        Function::Asin => steady((-1.0, 1.0), f64::asin),
        Function::Acos => steady((-1.0, 1.0), f64::acos),
        Function::Atan => steady(everywhere, f64::atan),
        Function::Exp => steady(everywhere, f64::exp),
        Function::Exp2 => steady(everywhere, f64::exp2),
        Function::Expm1 => steady(everywhere, f64::exp_m1),
        Function::Log => steady((0.0, f64::INFINITY), f64::ln),
        Function::Log2 => steady((0.0, f64::INFINITY), f64::log2),
        Function::Log1p => steady((-1.0, f64::INFINITY), f64::ln_1p),
        Function::Atan2 | Function::Pow | Function::SinCos2Pi => (f64::NAN, Interval::ALL),
    }
}

/// Bounds a function from -1 to 1 whose slope is at most `slope`; NaN at the infinities.
fn wave(x: Interval, slope: f64, f: fn(f64) -> f64) -> Interval {
    if x.is_nan() || x.as_point().is_some_and(f64::is_infinite) {
        return Interval::NAN;
    }
    let (middle, half) = (0.5 * (x.low + x.high), 0.5 * (x.high - x.low));
    let infinite = x.low.is_infinite() || x.high.is_infinite();
    // The middle, and `f` of it, are rounded themselves.
    let slop = 2f64.powi(-50) * (1.0 + slope * middle.abs());
    let (v, reach) = (f(middle), half * slope * (1.0 + 2f64.powi(-48)) + slop);
    if let Some(exact) = x.as_point() {
        return Interval::point(f(exact));
    }
    if infinite || reach >= 2.0 {
        return Interval::new(-1.0, 1.0, x.nan || infinite);
    }
    Interval::new((v - reach).max(-1.0), (v + reach).min(1.0), x.nan)
}

fn tangent(x: Interval) -> Interval {
    if x.as_point().is_some() {
        return Interval::point(x.low.tan());
    }
    // Index of the branch between two poles.
    let branch = |v: f64| (v / PI + 0.5).floor();
    if x.is_nan() {
        Interval::NAN
    } else if !x.may_break() && branch(x.low) == branch(x.high) && x.low.tan() <= x.high.tan() {
        Interval::new(x.low.tan(), x.high.tan(), false)
    } else {
        Interval { nan: x.may_break(), ..Interval::ALL }
    }
}

/// Bounds powers by their corners: powers of positive numbers are monotone in each argument, and so
/// are whole powers of negative ones.
fn power(x: Interval, y: Interval) -> Interval {
    if let (Some(x), Some(y)) = (x.as_point(), y.as_point()) {
        return Interval::point(x.powf(y));
    }
    // `pow(x, 0)` and `pow(1, y)` are 1, even for a NaN.
    if x.is_nan() || y.is_nan() {
        return Interval { nan: true, ..Interval::around([1.0], true) };
    }
    let whole = y.as_point().filter(|n| n.trunc() == *n);
    let is_fine = x.low > 0.0 || whole.is_some_and(|n| n > 0.0 || x.high < 0.0);
    if x.may_break() || y.may_break() || !is_fine {
        return Interval::ALL;
    }
    let mut corners = vec![x.low.powf(y.low), x.low.powf(y.high)];
    corners.extend([x.high.powf(y.low), x.high.powf(y.high)]);
    if x.contains(0.0) {
        corners.push(0.0);
    }
    Interval::around(corners, false)
}

/// Returns the sine of an angle in turns, exact at quarters.
fn turn_sin(u: f64) -> f64 {
    let r = u - u.round();
    match 4.0 * r {
        q if q == 0.0 || q.abs() == 2.0 => 0.0f64.copysign(u),
        q if q.abs() == 1.0 => q,
        _ => (r * TAU).sin(),
    }
}

/// Returns the cosine of an angle in turns, exact at quarters.
fn turn_cos(u: f64) -> f64 {
    let r = u - u.round();
    match (4.0 * r).abs() {
        0.0 => 1.0,
        1.0 => 0.0,
        2.0 => -1.0,
        _ => (r * TAU).cos(),
    }
}
