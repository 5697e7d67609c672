//! Comparable run times.

/// Run times of one variant, from rounds in which every variant ran once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times {
    /// Milliseconds, in order of the rounds.
    pub ms: Vec<f64>,
}

impl Times {
    /// Returns the median run time; 0 without runs.
    pub fn median(&self) -> f64 {
        let mut sorted = self.ms.clone();
        sorted.sort_by(f64::total_cmp);
        match sorted.len() {
            0 => 0.0,
            n if n % 2 == 1 => sorted[n / 2],
            n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
        }
    }

    /// Returns the spread of the runs: (longest - shortest) / median.
    pub fn spread(&self) -> f64 {
        let longest = self.ms.iter().copied().fold(0.0, f64::max);
        let shortest = self.ms.iter().copied().fold(f64::INFINITY, f64::min);
        let median = self.median();
        if median > 0.0 { (longest - shortest) / median } else { 0.0 }
    }

    /// Returns the speed-up over `base`: the median of the ratios round by round, so that a machine
    /// that slows down meanwhile slows both.
    pub fn speedup_over(&self, base: &Self) -> f64 {
        let ratios = base.ms.iter().zip(&self.ms).map(|(b, t)| b / t).collect();
        Self { ms: ratios }.median()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_ratios() {
        let base = Times { ms: vec![10.0, 20.0, 12.0] };
        let fast = Times { ms: vec![5.0, 10.0, 4.0] };
        assert_eq!(base.median(), 12.0);
        assert_eq!(fast.speedup_over(&base), 2.0);
        assert_eq!(base.spread(), 10.0 / 12.0);
        assert_eq!(Times::default().median(), 0.0);
        assert_eq!(Times { ms: vec![1.0, 3.0] }.median(), 2.0);
    }
}
