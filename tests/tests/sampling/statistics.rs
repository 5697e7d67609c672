//! Histograms, and whether they are what is expected.

use std::ops::Range;
use std::sync::Mutex;

use raydsl::prelude::*;
use raydsl_tests::{in_parallel, scaled};

/// Bins along each side.
pub(crate) const SIDE: usize = 64;

/// How many samples a histogram has.
pub(crate) const SAMPLES: usize = 10_000_000;

/// Counts `scaled(SAMPLES)` samples; `bin` gives the coordinates of one, from 0 to 1. Histograms of
/// other names have other random numbers.
pub(crate) fn histogram(name: &str, bin: impl Fn(&mut Rng) -> [f64; 2] + Sync) -> Vec<u64> {
    let seed = raydsl::__private::name(name) as u32;
    let all = Mutex::new(vec![0u64; SIDE * SIDE]);
    in_parallel(scaled(SAMPLES), 1 << 16, |part: Range<usize>| {
        let mut rng = Rng::new(uvec2(part.start as u32 >> 16, 0), 0, seed);
        let mut counts = vec![0u64; SIDE * SIDE];
        for _ in part {
            let [x, y] = bin(&mut rng).map(|c| ((c * SIDE as f64) as usize).min(SIDE - 1));
            counts[y * SIDE + x] += 1;
        }
        let mut all = all.lock().expect("no test panics here");
        all.iter_mut().zip(counts).for_each(|(a, c)| *a += c);
    });
    all.into_inner().expect("no test panics here")
}

/// The share of each bin: the integral of a density over the unit square, by midpoints, so many a
/// bin in each direction.
pub(crate) fn shares(points: [usize; 2], density: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let area = ((SIDE * points[0] * SIDE * points[1]) as f64).recip();
    let middle = |bin: usize, k: usize, n: usize| ((bin * n + k) as f64 + 0.5) / (SIDE * n) as f64;
    let share = |bin: usize| {
        let all = (0..points[0] * points[1]).map(|k| {
            let x = middle(bin % SIDE, k % points[0], points[0]);
            density(x, middle(bin / SIDE, k / points[0], points[1]))
        });
        all.sum::<f64>() * area
    };
    (0..SIDE * SIDE).map(share).collect()
}

/// Pearson's test: the sum is that of a chi-square, within 5 standard deviations, after Wilson and
/// Hilferty (1931). Bins that expect fewer than 5 samples count as one.
#[track_caller]
pub(crate) fn assert_distributed(name: &str, counts: &[u64], shares: &[f64]) {
    let total: f64 = shares.iter().sum();
    assert!((total - 1.0).abs() < 1e-4, "{name}: the density integrates to {total}");
    let samples = counts.iter().sum::<u64>() as f64;
    let (mut sum, mut bins, mut rest) = (0.0, 0.0, [0.0; 2]);
    let mut add = |count: f64, expected: f64| {
        sum += (count - expected).powi(2) / expected;
        bins += 1.0;
    };
    for (count, share) in counts.iter().zip(shares) {
        let (count, expected) = (*count as f64, samples * share);
        if expected < 5.0 {
            rest = [rest[0] + count, rest[1] + expected];
        } else {
            add(count, expected);
        }
    }
    if rest[1] >= 5.0 {
        add(rest[0], rest[1]);
    } else {
        assert!(rest[0] < 30.0, "{name}: {} samples where none is expected", rest[0]);
    }
    let freedom = bins - 1.0;
    let spread = 2.0 / (9.0 * freedom);
    let z = ((sum / freedom).cbrt() - (1.0 - spread)) / spread.sqrt();
    println!("{name}: chi-square {sum:.0} for {freedom} degrees of freedom, z = {z:.2}");
    assert!(z.abs() < 5.0, "{name}: z = {z}");
}

/// The correlation of pairs.
pub(crate) fn correlation(pairs: impl Iterator<Item = (f32, f32)>) -> f64 {
    let (mut n, mut s) = (0.0, [0.0; 5]);
    for (a, b) in pairs {
        let (a, b) = (f64::from(a), f64::from(b));
        n += 1.0;
        for (sum, v) in s.iter_mut().zip([a, b, a * a, b * b, a * b]) {
            *sum += v;
        }
    }
    let [a, b, aa, bb, ab] = s.map(|v| v / n);
    (ab - a * b) / ((aa - a * a) * (bb - b * b)).sqrt()
}
