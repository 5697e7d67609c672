//! The words of the generator are random.

use raydsl::prelude::*;
use raydsl::sampling::pcg4d;
use raydsl_tests::scaled;

use crate::statistics::{assert_distributed, correlation, histogram, shares};

const METHODS: [SampleMethod; 3] =
    [SampleMethod::Random, SampleMethod::Stratified, SampleMethod::Sobol];

#[track_caller]
fn assert_uniform(name: &str, bin: impl Fn(&mut Rng) -> [f64; 2] + Sync) {
    assert_distributed(name, &histogram(name, bin), &shares([1, 1], |_, _| 1.0));
}

#[test]
fn draws_are_uniform() {
    assert_uniform("points", |rng| rng.next_2d().to_array().map(f64::from));
    assert_uniform("successive", |rng| [rng.next_f32(), rng.next_f32()].map(f64::from));
    assert_uniform("lower bits", |rng| {
        [rng.next_u32(), rng.next_u32()].map(|word| f64::from(word & 0xffff) / 65536.0)
    });
    assert_uniform("cubes", |rng| {
        let [_, y, z] = rng.next_3d().to_array();
        [y, z].map(f64::from)
    });
}

/// A hash as frames use it: neighbouring pixels, each one draw.
#[test]
fn pixels_are_uniform() {
    let uniform = shares([1, 1], |_, _| 1.0);
    let side = 1000u32;
    for sample in [0, 1, 65_536] {
        let mut counts = vec![0; uniform.len()];
        for y in 0..side {
            for x in 0..side {
                let p = Rng::new(uvec2(x, y), sample, 0).next_2d() * 64.0;
                counts[p.y as usize * 64 + p.x as usize] += 1;
            }
        }
        assert_distributed(&format!("sample {sample} of pixels"), &counts, &uniform);
    }
}

/// The lower 20 bits of each counter change half of the bits that floats are made of.
#[test]
fn every_bit_matters() {
    let rounds = scaled(200_000);
    let mut rng = raydsl_tests::rng::Rng::new(3);
    let mut changed = vec![[0u32; 128]; 128];
    for _ in 0..rounds {
        let input: [u32; 4] = std::array::from_fn(|_| rng.bits() as u32);
        let words = pcg4d(UVec4::from_array(input)).to_array();
        for (i, changed) in changed.iter_mut().enumerate().filter(|(i, _)| i % 32 < 20) {
            let mut other = input;
            other[i / 32] ^= 1 << (i % 32);
            let found = pcg4d(UVec4::from_array(other)).to_array();
            for (j, count) in changed.iter_mut().enumerate() {
                *count += (words[j / 32] ^ found[j / 32]) >> (j % 32) & 1;
            }
        }
    }
    let counters = changed.iter().enumerate().filter(|(i, _)| i % 32 < 20);
    let used = counters.flat_map(|(_, c)| c.iter().enumerate().filter(|(j, _)| j % 32 >= 8));
    let bias = used.map(|(_, n)| (f64::from(*n) / rounds as f64 - 0.5).abs());
    let worst = bias.fold(0.0, f64::max);
    println!("a flipped bit changes each bit used with probability 0.5 +- {worst:.4}");
    assert!(worst < 5.5 * 0.5 / (rounds as f64).sqrt(), "{worst}");
}

/// What a pixel gets says nothing of what its neighbours get, nor one dimension of another.
#[test]
fn neighbours_are_uncorrelated() {
    let side = 512u32;
    let n = f64::from(side * side);
    for method in METHODS {
        let of = |x: u32, y: u32, index: u32, dimension: u32| {
            let mut sampler = Sampler::new(uvec2(x, y), 9, index, 16, method);
            sampler.dimension = dimension;
            sampler.next_2d()
        };
        let every = |pair: &dyn Fn(u32, u32) -> (f32, f32)| {
            correlation((0..side * side).map(|i| pair(i % side, i / side)))
        };
        for index in [0, 1, 5, 15] {
            let found = [
                every(&|x, y| (of(x, y, index, 0).x, of(x + 1, y, index, 0).x)),
                every(&|x, y| (of(x, y, index, 0).y, of(x, y + 1, index, 0).y)),
                every(&|x, y| (of(x, y, index, 0).x, of(x + 1, y + 1, index, 0).y)),
                every(&|x, y| (of(x, y, index, 0).x, of(x, y, index, 0).y)),
                every(&|x, y| (of(x, y, index, 0).x, of(x, y, index, 2).x)),
                every(&|x, y| (of(x, y, index, 0).y, of(x, y, index, 4).x)),
            ];
            for (i, rho) in found.into_iter().enumerate() {
                assert!(rho.abs() < 4.0 / n.sqrt(), "{method:?}, pair {i}, sample {index}: {rho}");
            }
        }
        // Within a pixel, dimensions that are combined.
        let within = correlation((0..1 << 16).map(|i| (of(3, 4, i, 0).x, of(3, 4, i, 2).x)));
        assert!(within.abs() < 4.0 / 256.0, "{method:?}: {within}");
    }
}

/// Stratified samples of a pixel fill its grid, also those after the first `count`.
#[test]
fn samplers_fill_their_cells() {
    for set in 0..3 {
        let mut seen = [false; 64];
        for i in 0..64 {
            let mut sampler =
                Sampler::new(uvec2(5, 6), 1, set * 64 + i, 64, SampleMethod::Stratified);
            let p = sampler.next_2d() * 8.0;
            seen[p.y as usize * 8 + p.x as usize] = true;
        }
        assert!(seen.iter().all(|s| *s), "set {set}");
    }
}

/// Every number below 1, and as many samples as one likes, none included.
#[test]
fn samplers_have_no_bad_counts() {
    for method in METHODS {
        for count in [0, 1, 2, 3, 7, 1000, u32::MAX] {
            for index in [0, 1, 5, 1 << 20, u32::MAX] {
                let mut sampler = Sampler::new(uvec2(u32::MAX, 0), 1, index, count, method);
                let (p, x) = (sampler.next_2d(), sampler.next_1d());
                let unit = 0.0..1.0;
                let all = [p.x, p.y, x];
                assert!(all.iter().all(|x| unit.contains(x)), "{method:?} {index} {count} {all:?}");
            }
        }
    }
}
