//! How fast errors fall.

use raydsl::prelude::*;
use raydsl_tests::scaled;

const METHODS: [SampleMethod; 3] =
    [SampleMethod::Random, SampleMethod::Stratified, SampleMethod::Sobol];

/// The integral of exp(-xy) over the unit square.
const SMOOTH: f64 = 0.796_599_599_297_053_1;

fn smooth(p: Vec2) -> f64 {
    (-f64::from(p.x) * f64::from(p.y)).exp()
}

/// Whether a point lies below a slanted line, as a shadow's edge.
fn edge(p: Vec2) -> f64 {
    f64::from(u8::from(f64::from(p.x) + 0.6 * f64::from(p.y) < 0.7))
}

/// The area below that line: a trapezoid of the heights 0.1 and 0.7 along y.
const EDGE: f64 = 0.4;

fn sample(method: SampleMethod, seed: u32, index: u32, count: u32) -> Vec2 {
    Sampler::new(uvec2(seed, seed / 7), 11, index, count, method).next_2d()
}

/// The root of the mean squared error of `count` samples, over `runs` pixels.
fn error(f: fn(Vec2) -> f64, exact: f64, method: SampleMethod, count: u32, runs: u32) -> f64 {
    let estimate =
        |run| (0..count).map(|i| f(sample(method, run, i, count))).sum::<f64>() / f64::from(count);
    let squares = (0..runs).map(|run| (estimate(run) - exact).powi(2));
    (squares.sum::<f64>() / f64::from(runs)).sqrt()
}

/// The slope of log error against log samples, by least squares.
fn order(f: fn(Vec2) -> f64, exact: f64, method: SampleMethod) -> f64 {
    let runs = scaled(400) as u32;
    let counts = [16u32, 64, 256, 1024, 4096];
    let points = counts.map(|n| (f64::from(n).ln(), error(f, exact, method, n, runs).ln()));
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    covariance / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

#[test]
fn orders() {
    let [random, stratified, sobol] = METHODS.map(|m| order(smooth, SMOOTH, m));
    println!("smooth: random {random:.2}, stratified {stratified:.2}, Sobol {sobol:.2}");
    assert!((random + 0.5).abs() < 0.05, "{random}");
    assert!((stratified + 1.0).abs() < 0.08, "{stratified}");
    assert!(sobol < -1.2, "{sobol}");
    let [random, stratified, sobol] = METHODS.map(|m| order(edge, EDGE, m));
    println!("edge: random {random:.2}, stratified {stratified:.2}, Sobol {sobol:.2}");
    assert!((random + 0.5).abs() < 0.05, "{random}");
    assert!(stratified < -0.7 && sobol < -0.7, "{stratified} {sobol}");
}

/// The mean of `f` over 2^20 samples is `exact`, to within 4.5 standard errors, for each of 8
/// seeds.
#[track_caller]
fn assert_mean(name: &str, exact: f64, method: SampleMethod, f: impl Fn(Vec2) -> f64) {
    let n = 1u32 << 20;
    for seed in 0..8 {
        let (mut sum, mut squares) = (0.0, 0.0);
        for i in 0..n {
            let v = f(sample(method, seed, i, n));
            (sum, squares) = (sum + v, squares + v * v);
        }
        let mean = sum / f64::from(n);
        let deviation = (squares / f64::from(n) - mean * mean).sqrt();
        let allowed = 4.5 * deviation / f64::from(n).sqrt() + 1e-5 * exact.abs();
        let off = (mean - exact).abs();
        assert!(off <= allowed, "{name}, {method:?}, seed {seed}: off by {off}, allowed {allowed}");
        if method == SampleMethod::Sobol {
            assert!(off < 1e-6 * exact.abs().max(1.0), "{name}, seed {seed}: off by {off}");
        }
    }
}

#[test]
fn means() {
    for method in METHODS {
        assert_mean("exp(-xy)", SMOOTH, method, smooth);
        let cos = |u: Vec2| f64::from(sample_cosine_hemisphere(u).z);
        assert_mean("cosine", 2.0 / 3.0, method, cos);
        assert_mean("squared cosine", 0.5, method, |u| cos(u).powi(2));
    }
}
