//! Words of generators, and numbers made of them.

use std::slice;
use std::sync::atomic::{AtomicU32, Ordering};

use raydsl::prelude::*;
use raydsl::sampling::{owen_scramble, pcg4d, philox4x32, sobol_2d, unit_f32};
use raydsl::{Type, kernel};
use raydsl_tests::rng::Rng as Source;

use super::super::fault;
use super::super::statistics::Correlations;
use crate::row::{Bound, Row, Unit};

pub(super) fn rows() -> Vec<Row> {
    let methods = [SampleMethod::Random, SampleMethod::Stratified, SampleMethod::Sobol];
    let correlations = methods.into_iter().map(neighbours);
    [units(), words()].into_iter().chain(correlations).collect()
}

#[kernel]
fn unit(bits: u32) -> (f32, f32) {
    let u = unit_f32(bits);
    (u, log(1.0 - u))
}

/// The textbook takes the word times 2^-32.
fn units() -> Row {
    Row::new("u and log(1 - u) of all words", 1, Unit::Faults, Bound::NONE, |run| {
        let next = AtomicU32::new(0);
        let make = |_: &mut Source| {
            let i = next.fetch_add(1, Ordering::Relaxed);
            // An odd factor: no word comes twice.
            (if i < 1000 { u32::MAX - i } else { i.wrapping_mul(0x9e37_79b9) },)
        };
        let outcome = run.measure(&[Kernel::of::<unit>()], make, |(bits,), &(u, log)| {
            let exact = f64::from(bits >> 8) / f64::from(1 << 24);
            fault(!((0.0..1.0).contains(&u) && f64::from(u) == exact && log.is_finite()))
        })?;
        let mut next = 0u32;
        Ok(outcome.beside(run.broken_by(run.count, |_| {
            next = next.wrapping_add(1);
            (!next) as f32 * 2f32.powi(-32) >= 1.0
        })))
    })
}

#[derive(Clone, Copy, Debug, Type)]
struct Words {
    pcg: UVec4,
    philox: UVec4,
    sobol: UVec2,
    /// An index scrambled, and one that differs in lower bits only.
    scrambled: UVec2,
    drawn: UVec2,
    sampled: UVec2,
}

#[kernel]
fn words_of(a: u32, b: u32, c: u32, d: u32) -> Words {
    let mut rng = Rng::new(uvec2(a, b), c, d);
    let first = rng.next_u32();
    let mut sampler = Sampler::new(uvec2(a, b), c, d % 1000, 64, SampleMethod::Sobol);
    let point = sampler.next_2d();
    Words {
        pcg: pcg4d(uvec4(a, b, c, d)),
        philox: philox4x32(uvec4(a, b, c, d), uvec2(d, a)),
        sobol: sobol_2d(a),
        scrambled: uvec2(owen_scramble(a, b), owen_scramble(a ^ (c >> (d % 31 + 1)), b)),
        drawn: uvec2(first, rng.next_u32()),
        sampled: uvec2(point.x.to_bits(), point.y.to_bits()),
    }
}

fn words() -> Row {
    Row::new("words of generators, points' bits", 2, Unit::Faults, Bound::NONE, |run| {
        let kernel = Kernel::of::<words_of>();
        let ends = [0, 1, 2, 0x7fff_ffff, 0x8000_0000, 0xffff_00ff, u32::MAX - 1, u32::MAX];
        let make = |rng: &mut Source| {
            let is_end = rng.below(8) == 0;
            let mut word = || if is_end { rng.pick(&ends) } else { rng.bits() as u32 };
            (word(), word(), word(), word())
        };
        run.measure(slice::from_ref(&kernel), make, |input, found| {
            let &(a, b, c, d) = input;
            let of_papers = found.pcg.to_array() == pcg([a, b, c, d])
                && found.philox.to_array() == philox([a, b, c, d], [d, a])
                && found.sobol.to_array() == [a.reverse_bits(), second_dimension(a)];
            // Bits above the first that differs say nothing of it: a net stays a net.
            let differs = found.scrambled.x ^ found.scrambled.y;
            let is_nested = differs.leading_zeros() == (c >> (d % 31 + 1)).leading_zeros();
            let source = kernel.call(*input);
            let is_same = [
                found.drawn == source.drawn,
                found.sampled == source.sampled,
                found.scrambled == source.scrambled,
            ];
            fault(!(of_papers && is_nested && is_same == [true; 3]))
        })
    })
}

/// Jarzynski and Olano, "Hash Functions for GPU Rendering" (JCGT 2020), listing 3.16.
fn pcg(v: [u32; 4]) -> [u32; 4] {
    let [mut x, mut y, mut z, mut w] =
        v.map(|x| x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    for round in 0..2 {
        x = x.wrapping_add(y.wrapping_mul(w));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
        w = w.wrapping_add(y.wrapping_mul(z));
        if round == 0 {
            [x, y, z, w] = [x, y, z, w].map(|v| v ^ v >> 16);
        }
    }
    [x, y, z, w]
}

/// Salmon, Moraes, Dror and Shaw, "Parallel Random Numbers: As Easy as 1, 2, 3" (SC 2011).
fn philox(mut words: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for _ in 0..10 {
        let [x, y, z, w] = words;
        let first = u64::from(x) * 0xd251_1f53;
        let second = u64::from(z) * 0xcd9e_8d57;
        words = [
            (second >> 32) as u32 ^ y ^ key[0],
            second as u32,
            (first >> 32) as u32 ^ w ^ key[1],
            first as u32,
        ];
        key = [key[0].wrapping_add(0x9e37_79b9), key[1].wrapping_add(0xbb67_ae85)];
    }
    words
}

/// Sobol's second dimension by its direction numbers, of the polynomial `x + 1`.
fn second_dimension(i: u32) -> u32 {
    let (mut direction, mut word) = (1u32 << 31, 0);
    for bit in 0..32 {
        if i >> bit & 1 == 1 {
            word ^= direction;
        }
        direction ^= direction >> 1;
    }
    word
}

/// First points of a pixel, of the one beside and of the one above.
#[derive(Clone, Copy, Debug, Type)]
struct Points {
    here: Vec2,
    beside: Vec2,
    above: Vec2,
    /// The pixel's next point.
    next: Vec2,
}

/// The figure is the greatest correlation of five pairs.
fn neighbours(method: SampleMethod) -> Row {
    let name = format!("neighbouring pixels, {method:?}");
    Row::new(name, 3, Unit::Times, Bound::all(4.0), move |run| {
        let kernel = kernel!(|x: u32, y: u32, index: u32| {
            let mut here = Sampler::new(uvec2(x, y), 9, index, 16, method);
            let mut beside = Sampler::new(uvec2(x + 1, y), 9, index, 16, method);
            let mut above = Sampler::new(uvec2(x, y + 1), 9, index, 16, method);
            let first = here.next_2d();
            Points {
                here: first,
                beside: beside.next_2d(),
                above: above.next_2d(),
                next: here.next_2d(),
            }
        });
        let none = Correlations::new(|p: &Points| {
            [
                (p.here.x, p.beside.x),
                (p.here.y, p.above.y),
                (p.here.x, p.above.y),
                (p.here.x, p.here.y),
                (p.here.x, p.next.x),
            ]
        });
        run.gather(&kernel, &none, |rng| {
            (rng.below(1 << 16) as u32, rng.below(1 << 16) as u32, rng.below(16) as u32)
        })
    })
}
