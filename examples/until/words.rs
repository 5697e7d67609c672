//! How far it is, and what became of it, as lines of text.

use raydsl::render::{Estimate, Outcome, Progress, Reached};

/// In percent, with three digits that count.
fn percent(share: f64) -> String {
    let value = 100.0 * share;
    if value == 0.0 || !value.is_finite() {
        return format!("{value} %");
    }
    let digits = (2.0 - value.abs().log10().floor()).clamp(0.0, 12.0);
    format!("{value:.*} %", digits as usize)
}

fn error(estimate: &Estimate) -> String {
    let Estimate { error, low, high } = *estimate;
    if !error.is_finite() {
        return "error not known yet".to_owned();
    }
    format!("error {} ({} to {})", percent(error), percent(low), percent(high))
}

/// One line, for as long as samples are taken.
pub(crate) fn progress(progress: &Progress) -> String {
    let Progress { estimate, samples, spent, time_left, .. } = progress;
    let left = time_left.as_secs_f64().ceil();
    format!("{}, {samples} samples a pixel, {spent} taken, {left} s left", error(estimate))
}

/// Why it ended, and with what.
pub(crate) fn reached(reached: &Reached) -> String {
    let why = match reached.outcome {
        Outcome::Converged => "the error is reached".to_owned(),
        Outcome::OutOfTime => "the time is spent".to_owned(),
        Outcome::OutOfSamples => "the samples are spent".to_owned(),
        Outcome::Unresolvable { floor } => {
            format!("rounding leaves {}; ask for more than twice that", percent(floor))
        }
        Outcome::Stopped => "stopped".to_owned(),
    };
    let Reached { estimate, samples, spent, elapsed, nan_pixels, .. } = reached;
    let seconds = elapsed.as_secs_f64();
    let error = error(estimate);
    let line =
        format!("{why} after {seconds:.1} s: {error}, {samples} samples a pixel, {spent} taken");
    match nan_pixels {
        0 => line,
        n => format!("{line}; {n} pixels are no number and not in the error"),
    }
}
