//! Unsigned normalised numbers.

use std::error::Error;

use raydsl::kernel;
use raydsl::machine::wgsl::{Arithmetic, Module};
use raydsl::prelude::*;
use raydsl_tests::gpu::gpu;
use raydsl_tests::rng::Rng;
use raydsl_tests::values::SPECIAL_F32;

use super::fault;
use crate::outcome::{Found, Outcome};
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "unorms",
    title: "Numbers from 0 to 1 in 8, 16 and 32 bits",
    clauses: &[
        "Every code of 8 and 16 bits is decoded to a number from 0 to 1 that is encoded as it.",
        "Every number is encoded as the nearest code, halfway upwards, and NaN as 0.",
        "WGSL's pack4x8unorm and pack2x16unorm give the same code of every decoded code.",
    ],
    rows,
};

#[kernel]
fn decoded(byte: Unorm8, word: Unorm16, long: Unorm32) -> (f32, f32, f32) {
    (byte.to_f32(), word.to_f32(), long.to_f32())
}

fn rows() -> Vec<Row> {
    let nearest = |name, bits: u32, encode: fn(f32) -> u32| {
        Row::new(name, 2, Unit::Faults, Bound::NONE, move |run| {
            let judge = |rng: &mut Rng| {
                let x = near_a_border(rng, bits);
                let (found, expected) = (encode(x), nearest_code(x, bits));
                (f64::from(u8::from(found != expected)), format!("{x:?}: {found}, not {expected}"))
            };
            let codes = 2f64.powi(bits as i32) - 1.0;
            let textbook = run.broken_by(run.count / 100, |rng| {
                let x = near_a_border(rng, bits);
                (x * codes as f32) as u32 != nearest_code(x, bits)
            });
            Ok(run.on_host(judge).beside(textbook))
        })
    };
    vec![
        Row::new("every 8-bit code", 1, Unit::Faults, Bound::NONE, |run| {
            let of = |code: u8| (Unorm8::from_bits(code), Unorm16::ZERO, Unorm32::ZERO);
            let inputs: Vec<_> = (0..=u8::MAX).map(of).collect();
            run.measure_each(&Kernel::of::<decoded>(), &inputs, |input, found| {
                fault(!(0.0..=1.0).contains(&found.0) || Unorm8::new(found.0) != input.0)
            })
        }),
        Row::new("every 16-bit code", 1, Unit::Faults, Bound::NONE, |run| {
            let of = |code: u16| (Unorm8::ONE, Unorm16::from_bits(code), Unorm32::ONE);
            let inputs: Vec<_> = (0..=u16::MAX).map(of).collect();
            run.measure_each(&Kernel::of::<decoded>(), &inputs, |input, found| {
                fault(!(0.0..=1.0).contains(&found.1) || Unorm16::new(found.1) != input.1)
            })
        }),
        Row::new("32-bit codes, to their precision", 1, Unit::Faults, Bound::NONE, |run| {
            let make = |rng: &mut Rng| {
                let near = rng.bits() as u32 >> rng.below(32);
                let code = if rng.below(2) == 0 { near } else { !near };
                (Unorm8::ZERO, Unorm16::ONE, Unorm32::from_bits(code))
            };
            run.measure(&[Kernel::of::<decoded>()], make, |input, found| {
                let exact = f64::from(input.2.to_bits()) / f64::from(u32::MAX);
                // Rounding of the code and of the quotient, which WGSL rounds to 2.5 ulp.
                let is_near = (f64::from(found.2) - exact).abs() <= exact * 3.5 * 2f64.powi(-23);
                fault(!(0.0..=1.0).contains(&found.2) || !is_near)
            })
        }),
        nearest("numbers next to borders, 8 bits", 8, |x| Unorm8::new(x).to_bits().into()),
        nearest("numbers next to borders, 16 bits", 16, |x| Unorm16::new(x).to_bits().into()),
        nearest("numbers next to borders, 32 bits", 32, |x| Unorm32::new(x).to_bits()),
        Row::new("pack4x8unorm, pack2x16unorm", 3, Unit::Faults, Bound::NONE, |run| {
            let Some(packed) = packed(run.wgsl)? else { return Ok(Outcome::default()) };
            let mut found = Found::new("wgsl");
            for (word, [bytes, words]) in (0..=u16::MAX).zip(packed) {
                let expected = [bytes_of(word), words_of(word)];
                let is_wrong = [bytes, words] != expected;
                found.add(run.unit, f64::from(u8::from(is_wrong)), || {
                    format!("{bytes:x} {words:x}, not {expected:x?}")
                });
            }
            Ok(Outcome { found: vec![found], ..Outcome::default() })
        }),
    ]
}

/// Numbers around borders between two codes, special ones, and any from 0 to 1.
fn near_a_border(rng: &mut Rng, bits: u32) -> f32 {
    let codes = 2f64.powi(bits as i32) - 1.0;
    let border = ((rng.below(codes as usize) as f64 + 0.5) / codes) as f32;
    match rng.below(8) {
        0 => rng.pick(SPECIAL_F32),
        1 => rng.unit(),
        2 => f32::from_bits(rng.bits() as u32),
        3 => border,
        4 => border.next_up(),
        5 => border.next_down(),
        6 => border.next_up().next_up(),
        _ => border.next_down().next_down(),
    }
}

/// WGSL, section "pack4x8unorm": `floor(0.5 + codes * clamp(x, 0, 1))`, in whole numbers.
fn nearest_code(x: f32, bits: u32) -> u32 {
    let codes = (1u128 << bits) - 1;
    if x.is_nan() || x <= 0.0 {
        return 0;
    }
    if x >= 1.0 {
        return codes as u32;
    }
    // The number is `mantissa * 2^-scale`.
    let exponent = x.to_bits() >> 23;
    let mantissa = u128::from(x.to_bits() & 0x7f_ffff | u32::from(exponent > 0) << 23);
    let scale = 150 - exponent.max(1);
    // Smaller ones are far below half a code.
    if scale > 120 { 0 } else { ((((mantissa * codes) << 1) + (1 << scale)) >> (scale + 1)) as u32 }
}

/// Four codes of 8 bits.
fn four_bytes(word: u16) -> [u8; 4] {
    let [low, high] = word.to_le_bytes();
    [low, high, !low, high.wrapping_add(low)]
}

fn bytes_of(word: u16) -> u32 {
    u32::from_le_bytes(four_bytes(word))
}

fn words_of(word: u16) -> u32 {
    u32::from(word) | u32::from(!word) << 16
}

/// Returns what a device packs of every code of 16 bits: its bytes, and itself with its complement.
fn packed(is_wanted: bool) -> Result<Option<Vec<[u32; 2]>>, Box<dyn Error>> {
    let Some(gpu) = gpu().filter(|_| is_wanted) else { return Ok(None) };
    let source = "struct Job {
    size: vec2<u32>,
    first: vec2<u32>,
    count: vec2<u32>,
    base: u32,
    pad: u32,
}
struct Input {
    bytes: vec4<f32>,
    words: vec2<f32>,
    pad: vec2<f32>,
}
@group(0) @binding(0) var<uniform> params: vec4<u32>;
@group(0) @binding(1) var<uniform> job: Job;
@group(0) @binding(2) var<storage, read> inputs: array<Input>;
@group(0) @binding(3) var<storage, read_write> outputs: array<vec2<u32>>;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let index = job.first.x + id.x - job.base;
    let input = inputs[index];
    outputs[index] = vec2<u32>(pack4x8unorm(input.bytes), pack2x16unorm(input.words));
}
";
    let module = Module {
        source: source.to_owned(),
        arithmetic: Arithmetic::Strict,
        workgroup: [64, 1],
        uniforms: vec![0; 16],
        input_stride: 32,
        output_stride: 8,
        buffers: Vec::new(),
        textures: Vec::new(),
    };
    let numbers = |word: u16| {
        let [a, b, c, d] = four_bytes(word).map(|code| Unorm8::from_bits(code).to_f32());
        let [e, f] = [word, !word].map(|code| Unorm16::from_bits(code).to_f32());
        [a, b, c, d, e, f, 0.0, 0.0]
    };
    let inputs: Vec<u8> = (0..=u16::MAX).flat_map(numbers).flat_map(|x| x.to_le_bytes()).collect();
    let count = 1 << 16;
    let mut outputs = vec![0; 8 * count as usize];
    gpu.context().run(&module, &|_| None, &inputs, [count, 1], &mut outputs)?;
    let word = |bytes: &[u8; 4]| u32::from_le_bytes(*bytes);
    let pair = |pair: &[u8; 8]| pair.as_chunks().0.iter().map(word).collect::<Vec<_>>();
    let pairs = outputs.as_chunks().0.iter().map(pair);
    Ok(Some(pairs.map(|pair| [pair[0], pair[1]]).collect()))
}
