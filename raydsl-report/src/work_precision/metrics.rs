//! Error metrics of estimates against a reference.

use super::reference::Reference;

/// Added to the reference, or to its square, in relative errors.
const EPSILON: f64 = 1e-2;

/// The names of metrics and their formulas: n finite estimates x of references r, d = x - r.
pub const FORMULAS: &[(&str, &str)] = &[
    ("bias", "mean of d"),
    ("bias_z", "bias / (standard deviation of d / sqrt(n)), pixels being independent"),
    ("mse", "mean of d^2; of two halves a, b: mean of (x-a)(x-b), which noise may make negative"),
    ("rmse", "sqrt(max(0, mse)); of several runs: sqrt(max(0, mean of their mse))"),
    ("mae", "mean of |d|"),
    ("max", "largest |d|"),
    ("p99", "the |d| that 99 % of the estimates do not exceed"),
    ("rel_mse", "mean of d^2 / (r^2 + 0.01)"),
    ("rel_mse_trimmed", "the same without the worst 0.1 % of the estimates, at least one"),
    ("mrse", "mean of (d / (|r| + 0.01))^2: pbrt's relative error"),
    ("nan, inf", "estimates that are NaN, or infinite: they count in nothing else"),
    ("negative", "estimates below 0"),
    (
        "efficiency",
        "1 / (v t): v is the variance of an estimate between runs, in the mean of all estimates, \
         t the mean seconds of a run",
    ),
    #[cfg(feature = "flip")]
    (
        "flip",
        "mean, median and 95th percentile over pixels of LDR-FLIP (Andersson et al. 2020) of x and \
         r as grey light, clamped to 1, in sRGB, 67 pixels per degree: 0 (the same) to 1",
    ),
    #[cfg(feature = "flip")]
    (
        "hdr_flip",
        "the same of HDR-FLIP (Andersson et al. 2021): of each pixel the largest LDR-FLIP over \
         exposures of r, tone mapped by ACES' curve",
    ),
];

/// The errors of a run, by each of [`FORMULAS`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Metrics {
    /// The mean error.
    pub bias: f64,
    /// The standard error of [`Self::bias`]; 0 for fewer than two estimates.
    pub bias_error: f64,
    /// The mean square error: with two halves of a reference an unbiased estimate, negative if the
    /// halves lie on either side. The mean over runs uses it.
    pub mse: f64,
    /// The root of [`Self::mse`], 0 if that is negative.
    pub rmse: f64,
    /// The mean absolute error.
    pub mae: f64,
    /// The largest absolute error.
    pub max: f64,
    /// The 99 % quantile of the absolute errors.
    pub p99: f64,
    /// The mean of the squared error over the squared reference plus 0.01.
    pub rel_mse: f64,
    /// [`Self::rel_mse`] without the worst 0.1 %.
    pub rel_mse_trimmed: f64,
    /// The mean of the squared ratio of the error to the size of the reference plus 0.01: the
    /// relative error of pbrt-v4's `Image::MRSE`, which weights dark pixels more than
    /// [`Self::rel_mse`].
    pub mrse: f64,
    /// Estimates that are NaN.
    pub nan: u64,
    /// Estimates that are infinite.
    pub inf: u64,
    /// Estimates below 0.
    pub negative: u64,
}

impl Metrics {
    /// Computes the errors of estimates, one for each value of the reference or any number for a
    /// single value. Without a finite estimate all errors are NaN.
    pub fn of(estimates: &[f64], reference: &Reference) -> Self {
        let mut found = Self {
            nan: count(estimates, |x| x.is_nan()),
            inf: count(estimates, |x| x.is_infinite()),
            negative: count(estimates, |x| x < 0.0),
            ..Self::default()
        };
        let errors: Vec<Error> = estimates
            .iter()
            .enumerate()
            .filter(|(_, x)| x.is_finite())
            .map(|(i, x)| Error::of(*x, reference.at(i)))
            .collect();
        let mean = |of: fn(&Error) -> f64| mean(errors.iter().map(of));
        found.bias = mean(|e| e.d);
        found.mae = mean(|e| e.d.abs());
        found.mse = mean(|e| e.square);
        found.rmse = root(found.mse);
        found.bias_error = standard_error(errors.iter().map(|e| e.d), found.bias);
        let mut sizes: Vec<f64> = errors.iter().map(|e| e.d.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        found.max = sizes.last().copied().unwrap_or(f64::NAN);
        let last = (0.99 * sizes.len() as f64).ceil() as usize;
        found.p99 = sizes.get(last.saturating_sub(1)).copied().unwrap_or(f64::NAN);
        found.rel_mse = mean(|e| e.relative);
        found.mrse = mean(|e| e.ratio * e.ratio);
        found.rel_mse_trimmed = trimmed(errors.iter().map(|e| e.relative).collect());
        found
    }

    /// Returns the mean error in standard errors; 0 if there is no error at all.
    pub fn bias_z(&self) -> f64 {
        if self.bias == 0.0 { 0.0 } else { self.bias / self.bias_error }
    }

    /// Returns whether any estimate was not finite, or there was none.
    pub fn is_diverged(&self) -> bool {
        self.nan + self.inf > 0 || !self.rmse.is_finite()
    }
}

/// The errors of one estimate.
struct Error {
    d: f64,
    square: f64,
    relative: f64,
    /// The error over the reference, kept away from 0.
    ratio: f64,
}

impl Error {
    fn of(x: f64, (r, [a, b]): (f64, [f64; 2])) -> Self {
        let d = x - r;
        let (square, ratio) = ((x - a) * (x - b), d / (r.abs() + EPSILON));
        Self { d, square, relative: d * d / (r * r + EPSILON), ratio }
    }
}

/// Returns the root of a mean square, which may be negative; NaN of NaN.
pub(super) fn root(square: f64) -> f64 {
    if square < 0.0 { 0.0 } else { square.sqrt() }
}

fn count(estimates: &[f64], is: impl Fn(f64) -> bool) -> u64 {
    estimates.iter().filter(|x| is(**x)).count() as u64
}

/// Returns the mean; NaN of an empty set.
fn mean(numbers: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = numbers.fold((0.0, 0u64), |(sum, n), x| (sum + x, n + 1));
    sum / n as f64
}

fn standard_error(numbers: impl ExactSizeIterator<Item = f64>, mean: f64) -> f64 {
    let n = numbers.len();
    if n < 2 {
        return 0.0;
    }
    let squares: f64 = numbers.map(|x| (x - mean).powi(2)).sum();
    (squares / (n - 1) as f64 / n as f64).sqrt()
}

/// Returns the mean without the worst 0.1 %, at least one; of a single number, that number.
fn trimmed(mut errors: Vec<f64>) -> f64 {
    errors.sort_by(f64::total_cmp);
    let worst = errors.len().div_ceil(1000);
    let kept = errors.len().saturating_sub(worst).max(1).min(errors.len());
    mean(errors[..kept].iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_by_hand() {
        let found = Metrics::of(&[1.5, 0.5, 1.0, 2.0], &Reference::closed_form(1.0));
        assert_eq!((found.bias, found.mae, found.max, found.p99), (0.25, 0.5, 1.0, 1.0));
        assert_eq!(found.rmse, (1.5f64 / 4.0).sqrt());
        assert!((found.rel_mse - 1.5 / 4.0 / 1.01).abs() < 1e-15);
        assert!((found.rel_mse_trimmed - 0.5 / 3.0 / 1.01).abs() < 1e-15);
        // The squares of d - 0.25 are 1/16, 9/16, 1/16 and 9/16.
        let error = (1.25f64 / 3.0 / 4.0).sqrt();
        assert!((found.bias_z() - 0.25 / error).abs() < 1e-12);
    }

    /// Tests pixels half dark, half bright, each off by a tenth of itself: relative errors of other
    /// forms differ by their offsets from 0.
    #[test]
    fn relative_errors_are_of_their_own_forms() {
        let exact = [1e-3, 1.0, -1e-3, -1.0];
        let off = exact.map(|r| 1.1 * r);
        let found = Metrics::of(&off, &Reference::quadrature(exact, 0.0));
        let bright = 0.1f64 / 1.01;
        let mrse = 0.5 * (bright.powi(2) + (1e-4f64 / 1.1e-2).powi(2));
        assert!((found.mrse / mrse - 1.0).abs() < 1e-12, "{found:?}");
        let rel_mse = 0.5 * (0.01 / 1.01 + 1e-8 / (1e-6 + 1e-2));
        assert!((found.rel_mse / rel_mse - 1.0).abs() < 1e-12, "{found:?}");
    }

    /// Tests the figures of one firefly among a hundred thousand pixels.
    #[test]
    fn a_firefly_rules_the_mean_and_not_the_trimmed_one() {
        let mut estimates = vec![1.01; 100_000];
        estimates[77] = 1000.0;
        let found = Metrics::of(&estimates, &Reference::closed_form(1.0));
        assert!(found.rel_mse > 9.0 && found.rel_mse_trimmed < 1.1e-4, "{found:?}");
        assert!((found.p99 - 0.01).abs() < 1e-12 && found.max == 999.0);
    }

    /// Tests that the square counts on one side of both halves, and is subtracted again between
    /// them.
    #[test]
    fn a_mean_square_keeps_its_sign() {
        let halves = Reference::halves([1.0], [3.0]);
        let of = |x| Metrics::of(&[x], &halves);
        assert_eq!((of(4.0).mse, of(4.0).rmse), (3.0, 3.0f64.sqrt()));
        assert_eq!((of(2.0).mse, of(2.0).rmse), (-1.0, 0.0));
    }

    #[test]
    fn what_is_no_number_is_counted_and_nothing_else() {
        let estimates = [f64::NAN, f64::INFINITY, -1.0, 1.0];
        let found = Metrics::of(&estimates, &Reference::closed_form(1.0));
        assert_eq!((found.nan, found.inf, found.negative, found.bias), (1, 1, 1, -1.0));
        assert!(found.is_diverged());
        let none = Metrics::of(&[f64::NAN], &Reference::closed_form(1.0));
        assert!(none.rmse.is_nan() && none.max.is_nan() && none.is_diverged());
        assert!(Metrics::of(&[], &Reference::closed_form(1.0)).is_diverged());
    }

    /// Tests that one noisy reference adds its variance to the error, and two halves do not.
    #[test]
    fn halves_take_their_noise_out() {
        let noise = |i: u32, k: u32| f64::from((i * k + 7) % 1009) / 1009.0 - 0.5;
        let list = |k: u32, size: f64| -> Vec<f64> {
            (0..1009).map(|i| 2.0 + size * noise(i, k)).collect()
        };
        let (x, a, b) = (list(31, 0.1), list(97, 0.1), list(411, 0.1));
        let exact = Metrics::of(&x, &Reference::closed_form(2.0)).rmse;
        let one = Metrics::of(&x, &Reference::quadrature(a.clone(), 0.0)).rmse;
        let both = Metrics::of(&x, &Reference::halves(a, b)).rmse;
        assert!(one > 1.35 * exact && (both / exact - 1.0).abs() < 0.05, "{exact} {one} {both}");
    }
}
