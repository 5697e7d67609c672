//! Pearson's test.

/// What a histogram says of a density.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pearson {
    /// How many standard deviations the sum is above what is expected.
    pub(super) z: f64,
    /// The bin that contributes most.
    pub(super) worst: usize,
}

/// Least expected number of samples of a bin that stands alone.
const ALONE: f64 = 5.0;

/// Compares counts with what is expected. Bins that expect few samples count as one.
///
/// The normal approximation is that of Wilson and Hilferty, "The Distribution of Chi-Square" (1931).
pub(super) fn pearson(counts: &[u64], expected: &[f64]) -> Pearson {
    let (mut sum, mut bins, mut few) = (0.0, 0.0, [0.0; 2]);
    let (mut worst, mut most) = (0, 0.0);
    for (i, (count, expected)) in counts.iter().zip(expected).enumerate() {
        let count = *count as f64;
        if *expected < ALONE {
            few = [few[0] + count, few[1] + expected];
            continue;
        }
        let part = (count - expected).powi(2) / expected;
        (sum, bins) = (sum + part, bins + 1.0);
        if part > most {
            (most, worst) = (part, i);
        }
    }
    // The integrals of bins at an edge of the density are the least exact ones.
    let [count, expected] = few;
    let all: f64 = counts.iter().map(|c| *c as f64).sum();
    let beyond = (count - expected).abs() - 1e-3 * all;
    if beyond > 0.0 {
        (sum, bins) = (sum + beyond * beyond / expected.max(ALONE), bins + 1.0);
    }
    let freedom: f64 = (bins - 1.0f64).max(1.0);
    let spread = 2.0 / (9.0 * freedom);
    let z = ((sum / freedom).cbrt() - (1.0 - spread)) / spread.sqrt();
    Pearson { z, worst }
}

/// Returns how many standard deviations a normal number exceeds with the probability `p`, at most
/// 1/2. (Abramowitz and Stegun, "Handbook of Mathematical Functions", 26.2.23: off by 5e-4.)
pub(super) fn normal_quantile(p: f64) -> f64 {
    let t = (-2.0 * p.ln()).sqrt();
    let above = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let below = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    t - above / below
}

/// Returns the level of one of `tests` independent tests of which any fails with the probability
/// `level` though nothing is wrong. (Sidak 1967.)
pub(super) fn sidak(level: f64, tests: usize) -> f64 {
    -((-level).ln_1p() / tests.max(1) as f64).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_known() {
        for (p, z) in [(0.5, 0.0), (0.158_655, 1.0), (0.001_349_9, 3.0), (2.866_5e-7, 5.0)] {
            assert!((normal_quantile(p) - z).abs() < 1e-3, "{p}");
        }
        assert!((sidak(0.01, 1) - 0.01).abs() < 1e-15);
        assert!((1.0 - (1.0 - sidak(0.01, 100)).powi(100) - 0.01).abs() < 1e-12);
    }

    #[test]
    fn wrong_counts_are_found() {
        let expected = [1000.0; 50];
        let right: Vec<u64> = (0..50).map(|i| if i % 2 == 0 { 1030 } else { 970 }).collect();
        assert!(pearson(&right, &expected).z.abs() < 3.0);
        let mut wrong = right.clone();
        wrong[7] += 300;
        let found = pearson(&wrong, &expected);
        assert!(found.z > 5.0 && found.worst == 7);
        assert!(pearson(&[100, 50], &[100.0, 0.0]).z > 5.0);
    }
}
