//! Closures of any length: lines of vector arithmetic, each made of those before it.

use std::fmt::Write;

/// What a line may be: `{v}` and `{w}` are vectors of earlier lines, `{s}` is a number of one and
/// `{c}` one of the source. Each has 10 to 30 operations on numbers.
const VECTORS: [&str; 8] = [
    "({v}.cross({w}) + {v} * {c}).normalize()",
    "{v}.lerp({w}, {s} * {c}).max({w} * {c})",
    "({v} * {v}.dot({w}) - {w} * {s}).abs().sqrt()",
    "({v} - {w}).min({v} * {c} + {w}) * ({s} + {c})",
    "{v}.normalize() * {w}.length() + {w} * {s}",
    "({v} + {w} * {c}) / (1.0 + {s} * {s})",
    "{v}.cross({w}).max(vec3({s}, {c}, {s})) - {v} * {w}",
    "({w} - {v} * (2.0 * {v}.dot({w}))).clamp({v}.min({w}), {v}.max({w}))",
];

/// Lines that give a number.
const NUMBERS: [&str; 4] = [
    "({v}.dot({w}) * {c} + {s}).abs().sqrt()",
    "({v} - {w} * {s}).length() * {c}",
    "clamp({v}.dot({w}), -{c}, {s} * {s}) + {v}.x * {w}.z",
    "max({v}.length_squared(), {s}) / ({w}.dot({w}) + {c})",
];

/// A program with one closure of `lines` lines; the same text for the same number.
pub(crate) fn program(lines: u32) -> String {
    let mut body = String::new();
    // The names of the last vectors, the latest in front, and of the last number.
    let mut vectors = ["a", "b", "a", "b"].map(str::to_owned);
    let mut number = "s".to_owned();
    for i in 0..lines as usize {
        // Every fourth line gives a number.
        let gives_number = i % 4 == 3;
        let form = if gives_number {
            NUMBERS[i / 4 % NUMBERS.len()]
        } else {
            VECTORS[(i - i / 4) % VECTORS.len()]
        };
        let line = form
            .replace("{v}", &vectors[0])
            .replace("{w}", &vectors[1 + i % 3])
            .replace("{s}", &number)
            .replace("{c}", &format!("0.{}", 11 + i * 37 % 89));
        let name = format!("{}{i}", if gives_number { 'n' } else { 'v' });
        writeln!(body, "        let {name} = {line};").expect("text has room");
        if gives_number {
            number = name;
        } else {
            vectors.rotate_right(1);
            vectors[0] = name;
        }
    }
    let vector = &vectors[0];
    format!(
        "//! One closure of {lines} lines of arithmetic.

use raydsl::prelude::*;

fn main() {{
    let kernel = kernel!(|a: Vec3, b: Vec3, s: f32| {{
{body}        {vector} * {number}
    }});
    let inputs = [(vec3(0.1, 0.2, 0.3), vec3(0.5, 0.4, 0.3), 0.7)];
    let mut outputs = [Vec3::ZERO];
    kernel.run(Variant::widest(), &inputs, &mut outputs);
    println!(\"{{}}\", outputs[0]);
}}
"
    )
}
