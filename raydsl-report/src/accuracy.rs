//! Accuracy of results against the reference.

use raydsl::machine::{Leaf, Type, result_leaves};
use raydsl::testing::ulp;

/// The errors of results against the reference in `f64`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accuracy {
    /// The largest error of a number, in ulp of the reference as an `f32`.
    pub max_ulp: f64,
    /// The mean error of numbers in ulp. A difference of large numbers that is near 0 has many ulp,
    /// and dominates the mean; compare [`Self::median_ulp`].
    pub mean_ulp: f64,
    /// The median error in ulp.
    pub median_ulp: f64,
    /// The number of results with an integer that differs from the reference's: they followed
    /// another path, and their numbers do not count.
    pub other_paths: u64,
}

impl Accuracy {
    /// Computes the errors of results against their references, leaf by leaf.
    pub(super) fn of<'a, R: Type>(pairs: impl Iterator<Item = (R, &'a [Leaf])>) -> Self {
        let (mut errors, mut other_paths) = (Vec::new(), 0);
        for (result, reference) in pairs {
            match errors_of(&result_leaves(result), reference) {
                Some(found) => errors.extend(found),
                None => other_paths += 1,
            }
        }
        errors.sort_by(f64::total_cmp);
        let mean = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
        Self {
            max_ulp: errors.last().copied().unwrap_or_default(),
            mean_ulp: mean,
            median_ulp: errors.get(errors.len() / 2).copied().unwrap_or_default(),
            other_paths,
        }
    }
}

/// Returns the errors of a result's floats, if its integers are the reference's.
fn errors_of(result: &[Leaf], reference: &[Leaf]) -> Option<Vec<f64>> {
    let pairs = || result.iter().zip(reference);
    let is_float = |leaf: &Leaf| matches!(leaf, Leaf::Float { .. });
    let same_path = pairs().all(|(a, b)| is_float(a) || a == b);
    let floats = pairs().filter(|(a, _)| is_float(a));
    same_path.then(|| floats.map(|(a, b)| error(a.value(), b.value())).collect())
}

/// Returns the error of `found` in ulp of the reference.
fn error(found: f64, reference: f64) -> f64 {
    // A reference beyond the range of `f32` is infinity in `f32`.
    let overflows = found.is_infinite() && f64::from(reference as f32) == found;
    if found == reference || overflows || found.is_nan() && reference.is_nan() {
        return 0.0;
    }
    if !found.is_finite() || !reference.is_finite() {
        return f64::INFINITY;
    }
    (found - reference).abs() / ulp(reference)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_count_in_ulp() {
        assert_eq!(error(1.0, 1.0), 0.0);
        assert_eq!(error(f64::from(1.0f32.next_up()), 1.0), 1.0);
        assert_eq!(error(f64::from(f32::from_bits(3)), 0.0), 3.0);
        assert_eq!(error(f64::NAN, 1.0), f64::INFINITY);
        assert_eq!(error(f64::INFINITY, 1e39), 0.0);
        assert_eq!(error(f64::INFINITY, -1e39), f64::INFINITY);
        assert_eq!(error(f64::INFINITY, 1e38), f64::INFINITY);
    }

    #[test]
    fn other_paths_are_counted_apart() {
        let reference = result_leaves((1.0f32, 7u32));
        let results = [(1.0f32.next_up(), 7u32), (50.0, 8), (1.0, 7), (1.0, 7)];
        let found = Accuracy::of(results.into_iter().map(|r| (r, &reference[..])));
        assert_eq!((found.max_ulp, found.mean_ulp, found.other_paths), (1.0, 1.0 / 3.0, 1));
        assert_eq!(found.median_ulp, 0.0);
    }
}
