//! How a response dies away.

/// The energy that is still to come at the beginning of each bin, in dB of all (Schroeder, "New
/// Method of Measuring Reverberation Time", JASA 37(3), 1965).
pub(crate) fn backward_integral(response: &[f64]) -> Vec<f64> {
    let mut rest: Vec<f64> = response
        .iter()
        .rev()
        .scan(0.0, |sum, energy| {
            *sum += energy;
            Some(*sum)
        })
        .collect();
    rest.reverse();
    let all = rest.first().copied().unwrap_or(0.0);
    rest.iter().map(|energy| 10.0 * (energy / all).log10()).collect()
}

/// The time to -60 dB in seconds, by the straight line of least squares through the decay from -5 dB
/// down to `low` dB, where bins last `step` seconds; `None` if the response is too short for it.
pub(crate) fn reverberation_time(response: &[f64], step: f64, low: f64) -> Option<f64> {
    let decay = backward_integral(response);
    // What comes after the last bin is missing in all sums. It is about as much as the last tenth,
    // which must not matter.
    let last_tenth = decay[decay.len() * 9 / 10..].first().copied()?;
    let points: Vec<(f64, f64)> = (0u32..)
        .zip(&decay)
        .map(|(i, level)| (f64::from(i) * step, *level))
        .filter(|(_, level)| (low..=-5.0).contains(level))
        .collect();
    if last_tenth > low - 10.0 || points.len() < 2 {
        return None;
    }
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (time, level) = (mean(|p| p.0), mean(|p| p.1));
    let slope = points.iter().map(|p| (p.0 - time) * (p.1 - level)).sum::<f64>()
        / points.iter().map(|p| (p.0 - time).powi(2)).sum::<f64>();
    Some(-60.0 / slope)
}

/// The root mean square of relative errors, in the bins from `first` on that have energy. Earlier ones hold few image
/// sources, and one that holds the edge of a single one has next to no energy to compare with.
pub(crate) fn relative_error(found: &[f64], truth: &[f64], first: usize) -> f64 {
    let late = found.iter().zip(truth).skip(first).filter(|(_, t)| **t > 0.0);
    let squares: Vec<f64> = late.map(|(f, t)| (f / t - 1.0).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}
