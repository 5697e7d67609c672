//! The errors of builtins, beside what WGSL asks for.

use std::f64::consts::PI;

use raydsl_tests::rng::Rng;
use serde::Serialize;

use crate::device::{Device, Error, Input, Path};

/// Inputs of each builtin.
const COUNT: usize = 1 << 20;

/// WGSL's bound of an error, for an input and the exact result.
#[derive(Clone, Copy)]
enum Bound {
    /// The exact result.
    Exact,
    /// One of the two neighbours of the exact result.
    Rounded,
    /// So many ulp.
    Ulp(f64),
    /// 3 + 2 |a| ulp.
    Exponential,
    /// An absolute error of 2^-21 for `a` in [0.5, 2], 3 ulp elsewhere.
    Logarithm,
    /// An absolute error.
    Absolute(f64),
    /// As other expressions: no number.
    Inherited,
}

impl Bound {
    /// Returns the bound in ulp of the result.
    fn ulps(self, input: &Input, ulp: f64) -> f64 {
        let a = f64::from(input[0]);
        match self {
            Self::Exact => 0.0,
            // Either neighbour is less than one ulp away.
            Self::Rounded => 1.0,
            Self::Ulp(n) => n,
            Self::Exponential => 3.0 + 2.0 * a.abs(),
            Self::Logarithm if (0.5..=2.0).contains(&a) => (0.5f64.powi(21) / ulp).max(3.0),
            Self::Logarithm => 3.0,
            Self::Absolute(error) => error / ulp,
            Self::Inherited => f64::INFINITY,
        }
    }

    fn text(self) -> String {
        match self {
            Self::Exact => "exact".to_owned(),
            Self::Rounded => "a neighbour".to_owned(),
            Self::Ulp(n) => format!("{n} ulp"),
            Self::Exponential => "3 + 2|a| ulp".to_owned(),
            Self::Logarithm => "2^-21 or 3 ulp".to_owned(),
            Self::Absolute(error) => format!("{error:.1e} absolute"),
            Self::Inherited => "none".to_owned(),
        }
    }
}

/// Where inputs come from.
#[derive(Clone, Copy)]
enum Domain {
    /// Numbers whose exponents are evenly spread between two powers of two, of both signs.
    Magnitudes(i32, i32),
    /// The same, positive.
    Positive(i32, i32),
    /// Evenly spread.
    Interval(f64, f64),
}

impl Domain {
    fn draw(self, rng: &mut Rng) -> f32 {
        match self {
            Self::Magnitudes(low, high) => {
                let size = Self::Positive(low, high).draw(rng);
                if rng.below(2) == 0 { size } else { -size }
            }
            Self::Positive(low, high) => {
                let exponent = low + rng.below((high - low) as usize) as i32;
                (1.0 + rng.unit()) * (f64::from(exponent).exp2() as f32)
            }
            Self::Interval(low, high) => {
                let unit = rng.bits() as f64 / u64::MAX as f64;
                (low + (high - low) * unit) as f32
            }
        }
    }
}

struct Builtin {
    text: &'static str,
    domain: Domain,
    exact: fn([f64; 4]) -> f64,
    bound: Bound,
}

const fn builtin(
    text: &'static str,
    domain: Domain,
    exact: fn([f64; 4]) -> f64,
    bound: Bound,
) -> Builtin {
    Builtin { text, domain, exact, bound }
}

const ALL: Domain = Domain::Magnitudes(-40, 40);
const LARGE: Domain = Domain::Magnitudes(-24, 24);
const POSITIVE: Domain = Domain::Positive(-100, 100);
const TURN: Domain = Domain::Interval(-PI, PI);
const UNIT: Domain = Domain::Interval(-1.0, 1.0);
const NEAR_ONE: Domain = Domain::Interval(0.95, 1.05);

/// Of a matrix of these columns.
fn determinant([a, b, c, d]: [f64; 4]) -> f64 {
    a * d - b * c
}

static BUILTINS: [Builtin; 34] = [
    builtin("a + b", ALL, |[a, b, ..]| a + b, Bound::Rounded),
    builtin("a - b", ALL, |[a, b, ..]| a - b, Bound::Rounded),
    builtin("a * b", ALL, |[a, b, ..]| a * b, Bound::Rounded),
    builtin("a / b", ALL, |[a, b, ..]| a / b, Bound::Ulp(2.5)),
    builtin("1.0 / a", ALL, |[a, ..]| a.recip(), Bound::Ulp(2.5)),
    builtin("fma(a, b, c)", ALL, |[a, b, c, _]| a * b + c, Bound::Inherited),
    // 1 / inverseSqrt(a): 2 ulp, and 2.5 of the quotient.
    builtin("sqrt(a)", POSITIVE, |[a, ..]| a.sqrt(), Bound::Ulp(4.5)),
    builtin("inverseSqrt(a)", POSITIVE, |[a, ..]| a.sqrt().recip(), Bound::Ulp(2.0)),
    builtin("exp(a)", Domain::Interval(-80.0, 80.0), |[a, ..]| a.exp(), Bound::Exponential),
    builtin("exp(a)", UNIT, |[a, ..]| a.exp(), Bound::Exponential),
    builtin("exp2(a)", Domain::Interval(-120.0, 120.0), |[a, ..]| a.exp2(), Bound::Exponential),
    builtin("log(a)", POSITIVE, |[a, ..]| a.ln(), Bound::Logarithm),
    builtin("log(a)", Domain::Interval(0.5, 2.0), |[a, ..]| a.ln(), Bound::Logarithm),
    builtin("log2(a)", POSITIVE, |[a, ..]| a.log2(), Bound::Logarithm),
    builtin("log2(a)", Domain::Interval(0.5, 2.0), |[a, ..]| a.log2(), Bound::Logarithm),
    builtin(
        "pow(abs(a), b)",
        Domain::Magnitudes(-3, 3),
        |[a, b, ..]| a.abs().powf(b),
        Bound::Inherited,
    ),
    // exp2(b * log2(a)): not a number for a negative base, and inexact where the exponent is large.
    builtin("pow(a, 2.0)", Domain::Magnitudes(-3, 3), |[a, ..]| a * a, Bound::Inherited),
    builtin("pow(a, 1000.0)", NEAR_ONE, |[a, ..]| a.powf(1000.0), Bound::Inherited),
    builtin("sin(a)", TURN, |[a, ..]| a.sin(), Bound::Absolute(1.0 / 2048.0)),
    builtin("cos(a)", TURN, |[a, ..]| a.cos(), Bound::Absolute(1.0 / 2048.0)),
    builtin("sin(a)", Domain::Interval(-6e4, 6e4), |[a, ..]| a.sin(), Bound::Inherited),
    builtin("tan(a)", TURN, |[a, ..]| a.tan(), Bound::Inherited),
    builtin("asin(a)", UNIT, |[a, ..]| a.asin(), Bound::Inherited),
    builtin("acos(a)", UNIT, |[a, ..]| a.acos(), Bound::Inherited),
    builtin("atan(a)", LARGE, |[a, ..]| a.atan(), Bound::Ulp(4096.0)),
    builtin("atan2(a, b)", LARGE, |[a, b, ..]| a.atan2(b), Bound::Ulp(4096.0)),
    builtin("determinant(mat2x2(a,b,c,d))", UNIT, determinant, Bound::Inherited),
    // Columns that are nearly parallel.
    builtin("determinant(mat2x2(a,b,c,d))", NEAR_ONE, determinant, Bound::Inherited),
    builtin("floor(a)", LARGE, |[a, ..]| a.floor(), Bound::Exact),
    builtin("trunc(a)", LARGE, |[a, ..]| a.trunc(), Bound::Exact),
    builtin("round(a)", LARGE, |[a, ..]| a.round_ties_even(), Bound::Exact),
    builtin("fract(a)", LARGE, |[a, ..]| a - a.floor(), Bound::Rounded),
    builtin(
        "f32(bitcast<i32>(a))",
        ALL,
        |[a, ..]| f64::from((a as f32).to_bits() as i32),
        Bound::Rounded,
    ),
    builtin("f32(i32(a))", LARGE, |[a, ..]| f64::from(a as i32), Bound::Rounded),
];

/// What one builtin did.
#[derive(Serialize)]
pub(crate) struct Row {
    builtin: &'static str,
    domain: String,
    /// Share of the results that are the nearest `f32` to the exact result.
    nearest: f64,
    /// Greatest error in ulp of the exact result, and where.
    worst_ulp: f64,
    worst_at: Input,
    /// Greatest absolute error.
    worst: f64,
    bound: String,
    /// Whether the bound holds, if there is one.
    pub(crate) holds: Option<bool>,
}

pub(crate) fn measure(device: &Device) -> Result<Vec<Row>, Error> {
    BUILTINS.iter().map(|builtin| of(device, builtin)).collect()
}

fn of(device: &Device, builtin: &Builtin) -> Result<Row, Error> {
    let mut rng = Rng::of(builtin.text);
    let draw = |_| std::array::from_fn(|_| builtin.domain.draw(&mut rng));
    let inputs: Vec<Input> = (0..COUNT).map(draw).collect();
    let body = format!("r = {};", builtin.text);
    let results = device.evaluate(Path::Wgsl, &body, &inputs)?;
    let mut row = Row {
        builtin: builtin.text,
        domain: match builtin.domain {
            Domain::Magnitudes(low, high) => format!("+-2^{low}..2^{high}"),
            Domain::Positive(low, high) => format!("2^{low}..2^{high}"),
            Domain::Interval(low, high) => format!("{}..{}", short(low), short(high)),
        },
        nearest: 0.0,
        worst_ulp: 0.0,
        worst_at: [0.0; 4],
        worst: 0.0,
        bound: builtin.bound.text(),
        holds: (!matches!(builtin.bound, Bound::Inherited)).then_some(true),
    };
    let (mut counted, mut nearest) = (0u32, 0u32);
    for (input, result) in inputs.iter().zip(results) {
        let exact = (builtin.exact)(input.map(f64::from));
        // Denormals and what is too large are the other table's.
        let is_normal = (f64::from(f32::MIN_POSITIVE)..f64::from(f32::MAX)).contains(&exact.abs());
        if !is_normal && exact != 0.0 {
            continue;
        }
        counted += 1;
        nearest += u32::from(result == exact as f32);
        let ulp = ulp_of(exact);
        let error = (f64::from(result) - exact).abs();
        // Not a number: no error of all is as large.
        let ulps = if error.is_nan() { f64::INFINITY } else { error / ulp };
        row.worst = row.worst.max(if error.is_nan() { f64::INFINITY } else { error });
        if ulps > row.worst_ulp {
            (row.worst_ulp, row.worst_at) = (ulps, *input);
        }
        // The reference is rounded, too, to 53 bits.
        if ulps > builtin.bound.ulps(input, ulp) + 1e-6 {
            row.holds = row.holds.map(|_| false);
        }
    }
    row.nearest = f64::from(nearest) / f64::from(counted.max(1));
    Ok(row)
}

/// Returns a number with four decimals, or none where it needs none.
fn short(x: f64) -> String {
    if x.fract() == 0.0 { format!("{x}") } else { format!("{x:.4}") }
}

/// Returns the distance between the `f32` around a number.
fn ulp_of(x: f64) -> f64 {
    let exponent = x.abs().max(f64::from(f32::MIN_POSITIVE)).log2().floor();
    (exponent - 23.0).exp2()
}

pub(crate) fn print(rows: &[Row]) {
    println!(
        "\n{:<29}{:<16}{:>9}{:>12}{:>10}  {:<16}verdict",
        "builtin", "inputs", "nearest %", "ulp", "absolute", "WGSL's bound"
    );
    for row in rows {
        let verdict = match row.holds {
            None => "",
            Some(true) => "holds",
            Some(false) => "BROKEN",
        };
        println!(
            "{:<29}{:<16}{:>9.2}{:>12.2}{:>10.2e}  {:<16}{verdict}",
            row.builtin,
            row.domain,
            100.0 * row.nearest,
            row.worst_ulp,
            row.worst,
            row.bound
        );
    }
}
