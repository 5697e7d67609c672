//! Round values on a scale, and how they are written.

/// Values 1, 2 or 5 times a power of ten apart, which people read easily.
///
/// Heckbert, "Nice Numbers for Graph Labels", Graphics Gems (1990); these are all within the scale.
///
/// ```
/// use raydsl_report::Ticks;
///
/// let ticks = Ticks::new(0.13, 2.2, 6);
/// let labels: Vec<String> = ticks.iter().map(|v| ticks.label(v)).collect();
/// assert_eq!(labels, ["0.5", "1.0", "1.5", "2.0"]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ticks {
    step: f64,
    /// Number of steps from 0 to the first tick.
    first: f64,
    count: usize,
    /// Digits behind the point.
    digits: usize,
    /// Power of ten that is split off, where numbers are too long.
    exponent: i32,
}

/// Powers of ten that are written out.
const WRITTEN: core::ops::Range<i32> = -4..6;

/// Least power of ten that is split off: with all digits of an `f64`.
const LEAST: i32 = -307;

impl Ticks {
    /// Returns ticks from `low` to `high`, or from `high` to `low`: about `count` of them, at most
    /// half as many more. There is one on a scale of one value, or whose steps are not normal
    /// numbers, and none where a bound is not finite.
    pub fn new(low: f64, high: f64, count: usize) -> Self {
        if !(low.is_finite() && high.is_finite() && (high - low).is_finite()) {
            return Self { step: 1.0, first: 0.0, count: 0, digits: 0, exponent: 0 };
        }
        let (low, high) = (low.min(high), low.max(high));
        let largest = low.abs().max(high.abs());
        let step = round_step((high - low) / count.max(1) as f64);
        // Beyond the digits of an f64 a scale has one value; six digits of it are written.
        if high - low <= largest * 1e-12 || !step.is_normal() {
            let (digits, exponent) = format_of(largest, largest * 1e-5);
            return Self { step: low, first: 1.0, count: 1, digits, exponent };
        }
        // A bound that is a tick but for its rounding to f32 has one.
        let slack = 1e-6;
        let first = (low / step - slack).ceil();
        let count = ((high / step + slack).floor() - first + 1.0).max(0.0) as usize;
        let (digits, exponent) = format_of(largest, step);
        Self { step, first, count, digits, exponent }
    }

    /// Returns the values, the least first.
    pub fn iter(&self) -> impl Iterator<Item = f64> + use<> {
        let Self { step, first, count, .. } = *self;
        // Not `-0`.
        (0..count).map(move |i| (first + i as f64) * step + 0.0)
    }

    /// Returns the text of a value: all have the same number of digits.
    pub fn label(&self, value: f64) -> String {
        let Self { digits, exponent, .. } = *self;
        if exponent == 0 {
            return format!("{value:.digits$}");
        }
        format!("{:.digits$}e{exponent}", value / 10f64.powi(exponent))
    }
}

/// Returns how many digits behind the point numbers up to `largest` need if they differ by `step`, and
/// which power of ten is split off.
fn format_of(largest: f64, step: f64) -> (usize, i32) {
    let power = |v: f64| if v > 0.0 { v.log10().floor() as i32 } else { 0 };
    let exponent = if WRITTEN.contains(&power(largest)) { 0 } else { power(largest).max(LEAST) };
    // A step is a power of ten but for its rounding.
    let digits = exponent - power(step * (1.0 + 1e-9));
    (digits.clamp(0, 15) as usize, exponent)
}

/// Returns the least step of 1, 2 or 5 times a power of ten that is about as large.
fn round_step(rough: f64) -> f64 {
    let power = 10f64.powf(rough.log10().floor());
    let factor = match rough / power {
        f if f < 1.5 => 1.0,
        f if f < 3.0 => 2.0,
        f if f < 7.0 => 5.0,
        _ => 10.0,
    };
    factor * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, most: usize) -> Vec<String> {
        let ticks = Ticks::new(low, high, most);
        ticks.iter().map(|v| ticks.label(v)).collect()
    }

    #[test]
    fn labels_are_round() {
        assert_eq!(labels(0.0, 1.0, 5), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(-10.0, 10.0, 4), ["-10", "-5", "0", "5", "10"]);
        assert_eq!(labels(10.0, -10.0, 4), ["-10", "-5", "0", "5", "10"]);
        assert_eq!(labels(287.3, 301.9, 3), ["290", "295", "300"]);
        assert_eq!(labels(0.0, 3e-9, 3), ["0e-9", "1e-9", "2e-9", "3e-9"]);
        assert_eq!(labels(0.0, 2.5e8, 3), ["0e8", "1e8", "2e8"]);
        assert_eq!(labels(1e6, 1.1e6, 2), ["1.00e6", "1.05e6", "1.10e6"]);
        // The bounds are those of f32.
        assert_eq!(labels(f64::from(0.1f32), f64::from(0.3f32), 2), ["0.1", "0.2", "0.3"]);
    }

    #[test]
    fn every_scale_has_some() {
        assert_eq!(labels(2.5, 2.5, 5), ["2.50000"]);
        assert_eq!(labels(0.0, 0.0, 5).len(), 1);
        // Steps that underflow.
        let tiny = f64::from_bits(1);
        assert_eq!(labels(0.0, tiny, 3), ["0e-307"]);
        assert_eq!(labels(-1e-310, 1e-310, 5).len(), 1);
        assert_eq!(labels(0.0, 2e-307, 2), ["0e-307", "1e-307", "2e-307"]);
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(labels(0.0, bad, 5).is_empty());
        }
        let mut x = 0.37;
        for i in 0..2000 {
            x = (x * 12.9898 + 0.137) % 1.0;
            let scale = 10f64.powi(i % 60 - 30);
            let (low, high) = ((x - 0.5) * scale, (x + 0.1 * ((i % 7) as f64)) * scale);
            let most = 1 + i as usize % 9;
            let found = Ticks::new(low, high, most);
            let values: Vec<f64> = found.iter().collect();
            assert!(values.len() <= most * 3 / 2 + 2, "{low} {high} {most}: {values:?}");
            let slack = (high - low).abs() * 1e-5;
            let (low, high) = (low.min(high) - slack, low.max(high) + slack);
            assert!(values.iter().all(|v| (low..=high).contains(v)), "{low} {high}: {values:?}");
            let mut texts: Vec<String> = values.iter().map(|v| found.label(*v)).collect();
            for (value, text) in values.iter().zip(&texts) {
                let read: f64 = text.parse().expect("a number");
                assert!((read - value).abs() <= found.step * 1e-6, "{text} is {value}");
            }
            let count = texts.len();
            texts.dedup();
            assert_eq!(texts.len(), count, "labels differ");
        }
    }
}
