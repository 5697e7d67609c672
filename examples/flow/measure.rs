//! What lines cost in each variant, and their errors over tolerances.

use std::time::Instant;

use raydsl::flow::trace;
use raydsl::flow::{FlowError, FlowSettings, FlowState, FlowSteps, Streamline, Ways, streamlines};
use raydsl::kernel::Kernel;
use raydsl::prelude::*;

use super::args::Args;
use super::lines::place;
use super::made::{period, vortices};

/// Time that lines are followed for.
const TIME: f32 = 8.0;

/// The flow in `f64`.
fn exact_velocity([x, y, z]: [f64; 3]) -> [f64; 3] {
    let (a, b, c) = (1.0, f64::from(0.816_496_6f32), f64::from(0.577_350_3f32));
    [a * z.sin() + c * y.cos(), b * x.sin() + a * z.cos(), c * y.sin() + b * x.cos()]
}

/// Where a seed is in the end, by so many steps of Runge and Kutta's classical rule in `f64`.
fn exact_end(seed: Vec3, steps: u32) -> [f64; 3] {
    let h = f64::from(TIME) / f64::from(steps);
    let moved = |p: [f64; 3], v: [f64; 3], by: f64| [0, 1, 2].map(|i| p[i] + v[i] * by);
    let mut p = seed.to_array().map(f64::from);
    for _ in 0..steps {
        let a = exact_velocity(p);
        let b = exact_velocity(moved(p, a, 0.5 * h));
        let c = exact_velocity(moved(p, b, 0.5 * h));
        let d = exact_velocity(moved(p, c, h));
        let sum = [0, 1, 2].map(|i| a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
        p = moved(p, sum, h / 6.0);
    }
    p
}

fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt()
}

/// How long all lines take on one thread, in seconds: the least of some runs, which other programs
/// disturb least.
fn seconds(
    runs: u16,
    variant: Variant,
    kernel: &Kernel<'_, (FlowState,), FlowSteps>,
    seeds: &[Vec3],
) -> (f64, Vec<Streamline>) {
    let mut least = f64::INFINITY;
    let mut lines = Vec::new();
    for _ in 0..runs {
        let start = Instant::now();
        let scheduler = SimpleScheduler::new().variant(variant);
        lines = streamlines(&scheduler, kernel, seeds, Ways::Forwards);
        least = least.min(start.elapsed().as_secs_f64());
    }
    (least, lines)
}

/// Prints both tables.
pub(crate) fn run(args: &Args) -> Result<(), FlowError> {
    let seeds: Vec<Vec3> = (0..args.lines).map(|i| place(i, period())).collect();
    let exact: Vec<[f64; 3]> = seeds.iter().map(|seed| exact_end(*seed, 8000)).collect();
    let mut coarse = Vec::new();
    let mut plain = f64::INFINITY;
    for _ in 0..args.runs {
        let start = Instant::now();
        coarse = seeds.iter().map(|seed| exact_end(*seed, 400)).collect();
        plain = plain.min(start.elapsed().as_secs_f64());
    }
    let off = coarse.iter().zip(&exact).map(|(p, q)| distance(*p, *q)).fold(0.0, f64::max);
    println!(
        "{} lines over a time of {TIME}, on one thread, the best of {} runs.\n\
         For comparison: 400 steps of RK4 in f64: {:.0} lines/s, off by {off:.1e} at most.\n",
        seeds.len(),
        args.runs,
        seeds.len() as f64 / plain
    );
    println!(
        "tolerance  steps  largest error  median error    lines/s: scalar  packet4  packet8 packet16"
    );
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let settings = FlowSettings::new(tolerance, 1.0)?.max_time(TIME)?;
        let kernel =
            kernel!(|state: FlowState| { trace(|p: Vec3| Some(vortices(p)), state, settings) });
        let mut row = String::new();
        let mut errors = Vec::new();
        let mut attempts = 0;
        for variant in [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16] {
            let (time, lines) = seconds(args.runs, variant, &kernel, &seeds);
            row += &format!(" {:8.0}", seeds.len() as f64 / time);
            errors = lines
                .iter()
                .zip(&exact)
                .filter_map(|(line, exact)| Some((line.points().last()?, exact)))
                .map(|(last, exact)| distance(last.at.to_array().map(f64::from), *exact))
                .collect();
            attempts = lines.iter().map(Streamline::attempts).sum();
        }
        errors.sort_by(f64::total_cmp);
        let most = errors.last().copied().unwrap_or(f64::NAN);
        let median = errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN);
        let steps = f64::from(attempts) / seeds.len() as f64;
        println!("{tolerance:9.0e} {steps:6.1} {most:14.1e} {median:13.1e} {:15}{row}", "");
    }
    Ok(())
}
