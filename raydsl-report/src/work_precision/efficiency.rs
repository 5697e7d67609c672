//! Efficiency of a Monte Carlo method.

use super::fit::student_t;

/// The efficiency of a method: 1 / (variance x time), per second and squared unit of the estimates.
///
/// It is constant in the number of independent samples, and grows with it for better sample
/// placement. Of two unbiased methods, the one with twice the efficiency needs half the time for
/// the same error. (Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997,
/// section 2.4.2.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Efficiency {
    /// The efficiency.
    pub value: f64,
    /// The lower end of its 95 % interval, by Student's t of the jackknife on its logarithm. 0 if
    /// unknown.
    pub low: f64,
    /// The upper end, infinite if unknown.
    pub high: f64,
}

impl Efficiency {
    /// Computes the efficiency from runs with different seeds: the seconds of each, and its
    /// estimates. The variance is that of an estimate between runs, averaged over all estimates,
    /// and needs no reference; the time is the mean one.
    ///
    /// Returns `None` for fewer than three runs, for estimates that are not finite or differ in
    /// number between runs, and if runs do not differ: a deterministic method has no variance.
    pub fn of(runs: &[(f64, &[f64])]) -> Option<Self> {
        let n = runs.len();
        let width = runs.first().map_or(0, |r| r.1.len());
        let is_whole = runs.iter().all(|r| r.1.len() == width && r.0 > 0.0);
        if n < 3 || width == 0 || !is_whole {
            return None;
        }
        let shares = squares(runs, width);
        let (squares, seconds) = (shares.iter().sum::<f64>(), runs.iter().map(|r| r.0).sum());
        let log = |squares: f64, seconds: f64, n: usize| {
            -(squares / (n - 1) as f64).ln() - (seconds / n as f64).ln()
        };
        let found: f64 = log(squares, seconds, n);
        if !found.is_finite() {
            return None;
        }
        // The sum of squares around the mean without one run.
        let rest = |share: f64| (squares - share * n as f64 / (n - 1) as f64).max(0.0);
        let without = shares.iter().zip(runs).map(|(s, r)| log(rest(*s), seconds - r.0, n - 1));
        let half = student_t(n - 1) * jackknife(&without.collect::<Vec<_>>());
        let [value, low, high] = [found, found - half, found + half].map(f64::exp);
        Some(Self { value, low, high })
    }
}

/// Returns for each run the mean squared deviation of its estimates from their means over all runs.
fn squares(runs: &[(f64, &[f64])], width: usize) -> Vec<f64> {
    let mut shares = vec![0.0; runs.len()];
    for i in 0..width {
        let mean = runs.iter().map(|r| r.1[i]).sum::<f64>() / runs.len() as f64;
        for (share, run) in shares.iter_mut().zip(runs) {
            *share += (run.1[i] - mean).powi(2) / width as f64;
        }
    }
    shares
}

/// Returns the jackknife standard error from the values without each run. (Efron and Tibshirani,
/// "An Introduction to the Bootstrap", 1993, section 11.)
fn jackknife(without: &[f64]) -> f64 {
    let n = without.len() as f64;
    let mean = without.iter().sum::<f64>() / n;
    let squares: f64 = without.iter().map(|v| (v - mean).powi(2)).sum();
    let error = ((n - 1.0) / n * squares).sqrt();
    // Two equal remaining runs have no variance, and no logarithm of it.
    if error.is_nan() { f64::INFINITY } else { error }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(runs: &[(f64, &[f64])]) -> Efficiency {
        Efficiency::of(runs).expect("three runs that differ")
    }

    #[test]
    fn by_hand() {
        // Variances 1 and 4 of the two estimates; 2 seconds on average.
        let found = of(&[(1.0, &[1.0, 4.0]), (2.0, &[2.0, 6.0]), (3.0, &[3.0, 8.0])]);
        assert!((found.value - 1.0 / (2.5 * 2.0)).abs() < 1e-15, "{found:?}");
        // Without the first run the variances are 0.5 and 2, and 2.5 seconds; without the second 2
        // and 8, and 2 seconds.
        let logs = [-(1.25f64 * 2.5).ln(), -(5.0f64 * 2.0).ln(), -(1.25f64 * 1.5).ln()];
        let mean = logs.iter().sum::<f64>() / 3.0;
        let error = (2.0 / 3.0 * logs.iter().map(|l| (l - mean).powi(2)).sum::<f64>()).sqrt();
        let factor = (student_t(2) * error).exp();
        assert!((found.high / found.value / factor - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found.low * factor / found.value - 1.0).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn what_has_none() {
        assert_eq!(Efficiency::of(&[]), None);
        assert_eq!(Efficiency::of(&[(1.0, &[1.0]), (1.0, &[2.0])]), None, "two runs");
        assert_eq!(Efficiency::of(&[(1.0, &[2.0][..]); 5]), None, "no variance");
        assert_eq!(Efficiency::of(&[(1.0, &[][..]); 3]), None, "no estimates");
        let nan: [(f64, &[f64]); 3] = [(1.0, &[1.0]), (1.0, &[f64::NAN]), (1.0, &[2.0])];
        assert_eq!(Efficiency::of(&nan), None);
        let ragged: [(f64, &[f64]); 3] = [(1.0, &[1.0]), (1.0, &[1.0, 2.0]), (1.0, &[2.0])];
        assert_eq!(Efficiency::of(&ragged), None);
        // Without the first run the two others are equal.
        let open = of(&[(1.0, &[1.0]), (1.0, &[2.0]), (1.0, &[2.0])]);
        assert_eq!((open.low, open.high), (0.0, f64::INFINITY));
    }

    /// Tests that of many measurements of normal numbers with a known variance, 95 % of the
    /// intervals contain the efficiency; without Student's t, or without the time, it would be
    /// fewer.
    #[test]
    fn intervals_cover() {
        let mut state = 1u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut normal = || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        // Standard deviations 1, 2, 3, 1, 2, 3 ..; times around 1 with a standard deviation of 0.1.
        let exact = 3.0 / 14.0;
        let trials = 1500;
        let mut inside = 0;
        for _ in 0..trials {
            let mut values = || (0..24).map(|i| f64::from(1 + i % 3) * normal()).collect();
            let values: Vec<Vec<f64>> = (0..5).map(|_| values()).collect();
            let times: Vec<f64> = (0..5).map(|_| (1.0 + 0.1 * normal()).max(0.1)).collect();
            let runs: Vec<(f64, &[f64])> =
                times.iter().zip(&values).map(|(t, v)| (*t, &v[..])).collect();
            let found = of(&runs);
            inside += u32::from((found.low..=found.high).contains(&exact));
        }
        let share = f64::from(inside) / f64::from(trials);
        assert!((0.92..0.985).contains(&share), "{share}");
    }
}
