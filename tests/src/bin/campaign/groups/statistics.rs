//! Statistics of results: means beside exact ones, histograms, correlations.

use crate::gather::Gathered;

/// Standard errors that a mean may be off by chance: one in 150,000 is.
const BY_CHANCE: f64 = 4.5;

/// The mean of a figure of results, whose exact value is known.
#[derive(Clone)]
pub(super) struct Mean<F> {
    of: F,
    exact: f64,
    count: f64,
    sum: f64,
    squares: f64,
}

impl<F> Mean<F> {
    pub(super) fn new(exact: f64, of: F) -> Self {
        Self { of, exact, count: 0.0, sum: 0.0, squares: 0.0 }
    }
}

impl<A, R, F: Fn(&A, &R) -> f64 + Clone + Send + Sync> Gathered<A, R> for Mean<F> {
    fn add(&mut self, input: &A, result: &R) {
        // Around the exact mean, so that nothing cancels.
        let value = (self.of)(input, result) - self.exact;
        self.count += 1.0;
        self.sum += value;
        self.squares += value * value;
    }

    fn join(&mut self, other: Self) {
        self.count += other.count;
        self.sum += other.sum;
        self.squares += other.squares;
    }

    /// The relative error beyond that by chance.
    fn judge(&self) -> (f64, String) {
        let off = self.sum / self.count;
        let error = ((self.squares / self.count - off * off).max(0.0) / self.count).sqrt();
        let beyond = (off.abs() - BY_CHANCE * error) / self.exact.abs();
        let text = format!("{} +- {error:.1e}, exactly {}", self.exact + off, self.exact);
        // A NaN is not the lesser of two.
        (if beyond.is_nan() { f64::INFINITY } else { beyond.max(0.0) }, text)
    }
}

/// Counts of samples that are uniform in the unit square, if all is well.
#[derive(Clone)]
pub(super) struct Histogram<F> {
    /// Where a result is in the square.
    of: F,
    side: usize,
    counts: Vec<u64>,
    outside: u64,
}

impl<F> Histogram<F> {
    /// 64 by 64 bins, or 16 by 16 for few samples.
    pub(super) fn new(samples: u64, of: F) -> Self {
        let side = if samples >= 100_000 { 64 } else { 16 };
        Self { of, side, counts: vec![0; side * side], outside: 0 }
    }
}

impl<A, R, F: Fn(&A, &R) -> [f64; 2] + Clone + Send + Sync> Gathered<A, R> for Histogram<F> {
    fn add(&mut self, input: &A, result: &R) {
        let at = (self.of)(input, result);
        // Rounding may put a sample on the border.
        if !at.iter().all(|x| (-1e-5..=1.00001).contains(x)) {
            self.outside += 1;
            return;
        }
        let [x, y] = at.map(|x| ((x * self.side as f64) as usize).min(self.side - 1));
        self.counts[y * self.side + x] += 1;
    }

    fn join(&mut self, other: Self) {
        self.outside += other.outside;
        self.counts.iter_mut().zip(other.counts).for_each(|(mine, theirs)| *mine += theirs);
    }

    /// Pearson's test: how many standard deviations the sum is from that of a chi-square. (Wilson and
    /// Hilferty, "The Distribution of Chi-Square", 1931.)
    fn judge(&self) -> (f64, String) {
        let expected = self.counts.iter().sum::<u64>() as f64 / self.counts.len() as f64;
        let squares = self.counts.iter().map(|&count| (count as f64 - expected).powi(2));
        let sum = squares.sum::<f64>() / expected;
        let freedom = (self.counts.len() - 1) as f64;
        let spread = 2.0 / (9.0 * freedom);
        let z = ((sum / freedom).cbrt() - (1.0 - spread)) / spread.sqrt();
        let text = format!("chi-square {sum:.0} of {freedom}, {} outside", self.outside);
        (if self.outside > 0 { f64::INFINITY } else { z.abs() }, text)
    }
}

/// Correlations of `N` pairs of numbers.
#[derive(Clone)]
pub(super) struct Correlations<F, const N: usize> {
    of: F,
    count: f64,
    /// Of each pair both numbers, their squares and their product.
    sums: [[f64; 5]; N],
}

impl<F, const N: usize> Correlations<F, N> {
    pub(super) fn new(of: F) -> Self {
        Self { of, count: 0.0, sums: [[0.0; 5]; N] }
    }
}

impl<A, R, F, const N: usize> Gathered<A, R> for Correlations<F, N>
where
    F: Fn(&R) -> [(f32, f32); N] + Clone + Send + Sync,
{
    fn add(&mut self, _: &A, result: &R) {
        self.count += 1.0;
        for (sums, (a, b)) in self.sums.iter_mut().zip((self.of)(result)) {
            let (a, b) = (f64::from(a) - 0.5, f64::from(b) - 0.5);
            sums.iter_mut().zip([a, b, a * a, b * b, a * b]).for_each(|(sum, v)| *sum += v);
        }
    }

    fn join(&mut self, other: Self) {
        self.count += other.count;
        for (mine, theirs) in self.sums.iter_mut().flatten().zip(other.sums.iter().flatten()) {
            *mine += theirs;
        }
    }

    /// The greatest correlation, in `1 / sqrt(n)`.
    fn judge(&self) -> (f64, String) {
        let rho = self.sums.map(|sums| {
            let [a, b, aa, bb, ab] = sums.map(|sum| sum / self.count);
            (ab - a * b) / ((aa - a * a) * (bb - b * b)).sqrt()
        });
        let worst = rho.into_iter().map(f64::abs).max_by(f64::total_cmp).unwrap_or(f64::NAN);
        (worst * self.count.sqrt(), format!("correlations {rho:?}"))
    }
}

/// The share of results that are wrong.
#[derive(Clone)]
pub(super) struct Share<F> {
    is_wrong: F,
    count: u64,
    wrong: u64,
    example: Option<String>,
}

impl<F> Share<F> {
    pub(super) fn new(is_wrong: F) -> Self {
        Self { is_wrong, count: 0, wrong: 0, example: None }
    }
}

impl<A: core::fmt::Debug, R: core::fmt::Debug, F> Gathered<A, R> for Share<F>
where
    F: Fn(&A, &R) -> bool + Clone + Send + Sync,
{
    fn add(&mut self, input: &A, result: &R) {
        self.count += 1;
        if (self.is_wrong)(input, result) {
            self.wrong += 1;
            self.example.get_or_insert_with(|| format!("{result:?} of {input:?}"));
        }
    }

    fn join(&mut self, other: Self) {
        self.count += other.count;
        self.wrong += other.wrong;
        self.example = self.example.take().or(other.example);
    }

    fn judge(&self) -> (f64, String) {
        let share = self.wrong as f64 / self.count as f64;
        (share, self.example.clone().unwrap_or_else(|| "none".to_owned()))
    }
}
