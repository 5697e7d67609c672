//! How fast errors fall with the number of samples.

use std::sync::{Mutex, PoisonError};

use raydsl::prelude::*;
use raydsl_tests::in_parallel;

use crate::measure::Run;
use crate::outcome::{Found, Outcome};
use crate::row::{Bound, Row, Unit};

/// The integral of exp(-xy) over the unit square.
const SMOOTH: f64 = 0.796_599_599_297_053_1;

fn smooth(p: Vec2) -> f64 {
    (-f64::from(p.x) * f64::from(p.y)).exp()
}

pub(super) fn rows() -> Vec<Row> {
    vec![
        row("order, random: -1/2", SampleMethod::Random, 0.05, |order| (order + 0.5).abs()),
        row("order, stratified: -1", SampleMethod::Stratified, 0.08, |order| (order + 1.0).abs()),
        // Above -3/2, the best that there is.
        row("order, Sobol: up to -3/2", SampleMethod::Sobol, 0.3, |order| (order + 1.5).max(0.0)),
    ]
}

fn row(name: &'static str, method: SampleMethod, bound: f64, off: fn(f64) -> f64) -> Row {
    Row::new(name, 7, Unit::Absolute, Bound::all(bound), move |run| {
        let (order, count) = order(run, method);
        let mut found = Found { count, ..Found::new("host") };
        found.worst = if order.is_nan() { f64::INFINITY } else { off(order) };
        found.example = Some(format!("{method:?}: order {order}"));
        Ok(Outcome::host(found))
    })
}

const COUNTS: [u32; 5] = [16, 64, 256, 1024, 4096];

/// The slope of log error against log samples, by least squares, and how many samples that took.
fn order(run: &Run, method: SampleMethod) -> (f64, u64) {
    let runs = (run.count / 50).clamp(200, 20_000) as u32;
    let points = COUNTS.map(|n| (f64::from(n).ln(), error(method, n, runs).ln()));
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let samples = u64::from(runs) * u64::from(COUNTS.iter().sum::<u32>());
    (covariance / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>(), samples)
}

/// The root of the mean squared error of `count` samples, over `runs` pixels.
fn error(method: SampleMethod, count: u32, runs: u32) -> f64 {
    let sum = Mutex::new(0.0);
    in_parallel(runs as usize, 16, |part| {
        let squares = part.map(|run| {
            let pixel = uvec2(run as u32, run as u32 / 7);
            let of = |i| smooth(Sampler::new(pixel, 11, i, count, method).next_2d());
            ((0..count).map(of).sum::<f64>() / f64::from(count) - SMOOTH).powi(2)
        });
        let squares = squares.sum::<f64>();
        *sum.lock().unwrap_or_else(PoisonError::into_inner) += squares;
    });
    let sum = sum.into_inner().unwrap_or_else(PoisonError::into_inner);
    (sum / f64::from(runs)).sqrt()
}
