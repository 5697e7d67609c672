//! How many times as long something takes as something else.

use std::time::Instant;

/// The median of the ratios of rounds in which the two take turns; the first round warms up.
pub(crate) fn ratio(rounds: usize, mut of: impl FnMut(), mut to: impl FnMut()) -> f64 {
    let seconds = |f: &mut dyn FnMut()| {
        let start = Instant::now();
        f();
        start.elapsed().as_secs_f64()
    };
    let mut ratios: Vec<f64> = (0..=rounds)
        .map(|_| {
            let below = seconds(&mut to);
            seconds(&mut of) / below.max(1e-9)
        })
        .skip(1)
        .collect();
    ratios.sort_by(f64::total_cmp);
    ratios[ratios.len() / 2]
}
