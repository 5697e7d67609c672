//! What a driver's compiler makes of expressions that it may rewrite.

use raydsl_tests::rng::Rng;
use serde::Serialize;

use crate::device::{Device, Error, Input, Path};

/// Inputs of each expression.
const COUNT: usize = 1 << 16;

/// What an expression may become, and what that gives.
type Reading = (&'static str, fn(Input) -> f32);

struct Expression {
    /// Statements that leave a result in `r`.
    body: &'static str,
    /// What the table calls it.
    name: &'static str,
    draw: fn(&mut Rng) -> Input,
    /// The first is what stands there, in IEEE arithmetic.
    readings: &'static [Reading],
}

/// Numbers of about the size 1.
fn near_one(rng: &mut Rng) -> Input {
    std::array::from_fn(|_| rng.range(-2.0, 2.0))
}

/// `c` is nearly `-a * b`, and so `a * b + c` nearly all rounding.
fn cancelling(rng: &mut Rng) -> Input {
    let [a, b, ..] = near_one(rng);
    [a, b, -(a * b), 0.0]
}

/// The products `a * b` and `c * d` are nearly equal.
fn two_products(rng: &mut Rng) -> Input {
    let [a, b, c, _] = near_one(rng);
    [a, b, c, a * b / c]
}

/// `a` is much larger than `b` and `c`.
fn of_sizes(rng: &mut Rng) -> Input {
    let [a, b, c, d] = near_one(rng);
    [a * 1e4, b, c, d]
}

/// `a` is a denormal, `b` a large number.
fn denormal(rng: &mut Rng) -> Input {
    let bits = 1 + rng.below((1 << 23) - 1) as u32;
    [f32::from_bits(bits), 2f32.powi(40), 0.0, 1.0]
}

/// Normal numbers whose product is a denormal.
fn denormal_product(rng: &mut Rng) -> Input {
    [rng.range(1.0, 2.0) * 2f32.powi(-70), 2f32.powi(-62), 0.0, 1.0]
}

fn with_nan(rng: &mut Rng) -> Input {
    [f32::NAN, rng.range(1.0, 2.0), 0.0, 1.0]
}

fn with_zero(rng: &mut Rng) -> Input {
    [rng.range(1.0, 2.0), 0.0, -0.0, -1.0]
}

fn huge(rng: &mut Rng) -> Input {
    [rng.range(1.0, 2.0) * 1e12, 0.0, 0.0, 0.0]
}

static EXPRESSIONS: [Expression; 21] = [
    Expression {
        name: "a * b + c",
        body: "r = a * b + c;",
        draw: cancelling,
        readings: &[
            ("two roundings", |[a, b, c, _]| a * b + c),
            ("fused", |[a, b, c, _]| a.mul_add(b, c)),
        ],
    },
    Expression {
        name: "let p = a * b; p + c",
        body: "let p = a * b; r = p + c;",
        draw: cancelling,
        readings: &[
            ("two roundings", |[a, b, c, _]| a * b + c),
            ("fused", |[a, b, c, _]| a.mul_add(b, c)),
        ],
    },
    Expression {
        name: "a * b - c * d",
        body: "r = a * b - c * d;",
        draw: two_products,
        readings: &[
            ("as written", |[a, b, c, d]| a * b - c * d),
            ("left fused", |[a, b, c, d]| a.mul_add(b, -(c * d))),
            ("right fused", |[a, b, c, d]| (-c).mul_add(d, a * b)),
        ],
    },
    Expression {
        name: "dot(v, v), v = (a, b, c)",
        body: "r = dot(input.xyz, input.xyz);",
        draw: near_one,
        readings: &[
            ("left to right", |[a, b, c, _]| a * a + b * b + c * c),
            ("fused from a", |[a, b, c, _]| c.mul_add(c, b.mul_add(b, a * a))),
            ("fused from c", |[a, b, c, _]| a.mul_add(a, b.mul_add(b, c * c))),
        ],
    },
    Expression {
        name: "fma(a, b, c)",
        body: "r = fma(a, b, c);",
        draw: cancelling,
        readings: &[
            ("fused", |[a, b, c, _]| a.mul_add(b, c)),
            ("two roundings", |[a, b, c, _]| a * b + c),
        ],
    },
    Expression {
        name: "(a + b) - a",
        body: "r = (a + b) - a;",
        draw: of_sizes,
        readings: &[("as written", |[a, b, ..]| (a + b) - a), ("b", |[_, b, ..]| b)],
    },
    Expression {
        name: "a + b + c",
        body: "r = a + b + c;",
        draw: of_sizes,
        readings: &[
            ("left to right", |[a, b, c, _]| a + b + c),
            ("right to left", |[a, b, c, _]| a + (b + c)),
            ("a + c first", |[a, b, c, _]| a + c + b),
        ],
    },
    Expression {
        name: "(a * b) / b",
        body: "r = (a * b) / b;",
        draw: near_one,
        readings: &[("as written", |[a, b, ..]| a * b / b), ("a", |[a, ..]| a)],
    },
    Expression {
        name: "a / b",
        body: "r = a / b;",
        draw: near_one,
        readings: &[
            ("rounded once", |[a, b, ..]| a / b),
            ("a * (1 / b)", |[a, b, ..]| a * (1.0 / b)),
        ],
    },
    Expression {
        name: "a * 3.0 * 0.1",
        body: "r = a * 3.0 * 0.1;",
        draw: near_one,
        readings: &[
            ("as written", |[a, ..]| a * 3.0 * 0.1),
            ("constants first", |[a, ..]| a * (3.0 * 0.1)),
        ],
    },
    Expression {
        name: "a, a denormal",
        body: "r = a;",
        draw: denormal,
        readings: &[("kept", |[a, ..]| a), ("0", |_| 0.0)],
    },
    Expression {
        name: "a * b, a denormal",
        body: "r = a * b;",
        draw: denormal,
        readings: &[("kept", |[a, b, ..]| a * b), ("0", |_| 0.0)],
    },
    Expression {
        name: "a * b, a denormal product",
        body: "r = a * b;",
        draw: denormal_product,
        readings: &[("kept", |[a, b, ..]| a * b), ("0", |_| 0.0)],
    },
    Expression {
        name: "a != a, a NaN",
        body: "r = select(0.0, 1.0, a != a);",
        draw: with_nan,
        readings: &[("true", |_| 1.0), ("false", |_| 0.0)],
    },
    Expression {
        name: "!(a < b), a NaN",
        body: "r = select(0.0, 1.0, !(a < b));",
        draw: with_nan,
        readings: &[("true", |_| 1.0), ("false", |_| 0.0)],
    },
    Expression {
        name: "min(a, b), a NaN",
        body: "r = min(a, b);",
        draw: with_nan,
        readings: &[("b", |[_, b, ..]| b), ("NaN", |_| f32::NAN)],
    },
    Expression {
        name: "max(b, a), a NaN",
        body: "r = max(b, a);",
        draw: with_nan,
        readings: &[("b", |[_, b, ..]| b), ("NaN", |_| f32::NAN)],
    },
    Expression {
        name: "a / b, b = 0",
        body: "r = a / b;",
        draw: with_zero,
        readings: &[("infinity", |_| f32::INFINITY), ("NaN", |_| f32::NAN)],
    },
    Expression {
        name: "b * d = 0 * -1",
        body: "r = b * d;",
        draw: with_zero,
        readings: &[("-0", |_| -0.0), ("0", |_| 0.0)],
    },
    Expression {
        name: "i32(a), a = 1e12",
        body: "r = f32(i32(a));",
        draw: huge,
        readings: &[
            ("greatest i32", |_| i32::MAX as f32),
            // The greatest f32 that is an i32: what naga clamps to.
            ("greatest of both", |_| 2_147_483_520.0),
            ("least i32", |_| i32::MIN as f32),
        ],
    },
    Expression {
        name: "1,000,000 iterations",
        body: "var n = 0u; loop { if n >= u32(d) + 1000000u { break; } n += 1u; } r = f32(n);",
        draw: |_| [0.0; 4],
        readings: &[("all", |_| 1e6), ("65,535", |_| 65_535.0)],
    },
];

/// What an expression became, on one path.
#[derive(Serialize)]
pub(crate) struct Row {
    expression: &'static str,
    path: &'static str,
    /// Shares of the inputs that each reading explains, of those on which readings differ.
    shares: Vec<(&'static str, f64)>,
    /// The share that none does.
    other: f64,
}

pub(crate) fn measure(device: &Device) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for expression in &EXPRESSIONS {
        for path in device.paths() {
            rows.push(of(device, expression, path)?);
        }
    }
    Ok(rows)
}

fn of(device: &Device, expression: &Expression, path: Path) -> Result<Row, Error> {
    let mut rng = Rng::of(expression.name);
    let inputs: Vec<Input> = (0..COUNT).map(|_| (expression.draw)(&mut rng)).collect();
    let results = device.evaluate(path, expression.body, &inputs)?;
    let mut counts = vec![0u32; expression.readings.len()];
    let (mut counted, mut other) = (0u32, 0u32);
    for (input, result) in inputs.iter().zip(results) {
        let readings: Vec<f32> = expression.readings.iter().map(|(_, of)| of(*input)).collect();
        if readings.iter().all(|r| is_same(*r, readings[0])) {
            continue;
        }
        counted += 1;
        match readings.iter().position(|r| is_same(*r, result)) {
            Some(i) => counts[i] += 1,
            None => other += 1,
        }
    }
    let share = |count: u32| f64::from(count) / f64::from(counted.max(1));
    let names = expression.readings.iter().map(|(name, _)| *name);
    Ok(Row {
        expression: expression.name,
        path: if path == Path::Wgsl { "WGSL" } else { "NoContraction" },
        shares: names.zip(counts.into_iter().map(share)).collect(),
        other: share(other),
    })
}

/// Whether two results are the same: every NaN is like every other.
fn is_same(a: f32, b: f32) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

pub(crate) fn print(rows: &[Row]) {
    println!("\n{:<27}{:<15}becomes, % of inputs that tell", "expression", "path");
    for row in rows {
        let mut shares = row.shares.clone();
        shares.push(("other", row.other));
        let text: Vec<String> = shares
            .iter()
            .filter(|(_, share)| *share > 0.0)
            .map(|(name, share)| format!("{name} {:.1}", 100.0 * share))
            .collect();
        println!("{:<27}{:<15}{}", row.expression, row.path, text.join(", "));
    }
}
