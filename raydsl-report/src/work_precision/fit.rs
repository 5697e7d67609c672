//! Least squares fits on log-log plots.

/// A power law `error = c knob^order` fitted to points, by least squares of the logarithms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The exponent.
    pub order: f64,
    /// The lower end of its 95 % interval, by Student's t of the residuals.
    pub low: f64,
    /// The upper end.
    pub high: f64,
    /// The number of points. Bit-identical repetitions of a point are not counted: a deterministic
    /// method learns nothing from a repetition.
    pub points: usize,
}

impl Fit {
    /// Fits points (knob, error), all positive. `None` if fewer than three are different, or all
    /// have one knob: two points leave no residual to judge them by.
    pub fn of(points: &[(f64, f64)]) -> Option<Self> {
        let is_positive = |v: f64| v > 0.0 && v.is_finite();
        let mut logs: Vec<(f64, f64)> = points
            .iter()
            .filter(|(x, y)| is_positive(*x) && is_positive(*y))
            .map(|(x, y)| (x.ln(), y.ln()))
            .collect();
        logs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        logs.dedup();
        let n = logs.len();
        if n < 3 || logs[0].0 == logs[n - 1].0 {
            return None;
        }
        let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n as f64;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let spread: f64 = logs.iter().map(|p| (p.0 - x).powi(2)).sum();
        let order = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / spread;
        let residual = |p: &(f64, f64)| p.1 - y - order * (p.0 - x);
        let squares: f64 = logs.iter().map(|p| residual(p).powi(2)).sum();
        let error = (squares / (n - 2) as f64 / spread).sqrt();
        let half = student_t(n - 2) * error;
        Some(Self { order, low: order - half, high: order + half, points: n })
    }
}

/// Returns the 97.5 % quantile of Student's t distribution with `freedom` degrees of freedom.
pub(super) fn student_t(freedom: usize) -> f64 {
    const TABLE: [f64; 12] =
        [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179];
    if let Some(t) = freedom.checked_sub(1).map_or(Some(&f64::INFINITY), |i| TABLE.get(i)) {
        return *t;
    }
    // Abramowitz and Stegun, 26.7.5, three terms: within 1e-3 from 13 on.
    let (z, v) = (1.959_964f64, freedom as f64);
    let (z3, z5, z7) = (z.powi(3), z.powi(5), z.powi(7));
    let first = (z3 + z) / 4.0;
    let second = (5.0 * z5 + 16.0 * z3 + 3.0 * z) / 96.0;
    let third = (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / 384.0;
    z + first / v + second / v.powi(2) + third / v.powi(3)
}

/// The point where a curve reaches a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reached {
    /// This value, interpolated between two points.
    At(f64),
    /// At most this value: the first point is already past the limit. For errors at a time, the
    /// last point took less time.
    AtMost(f64),
    /// The curve does not reach the limit. Curves are not extrapolated.
    Never,
}

/// Returns the least x at which y decreases to `limit`, by linear interpolation between points (x,
/// y) of a log-log plot ordered by x.
pub(super) fn first_below(points: &[(f64, f64)], limit: f64) -> Reached {
    match points.iter().position(|p| p.1 <= limit) {
        None => Reached::Never,
        Some(0) => Reached::AtMost(points[0].0),
        Some(i) => {
            let ((x0, y0), (x1, y1)) = (points[i - 1], points[i]);
            Reached::At(between((y0, x0), (y1, x1), limit))
        }
    }
}

/// Returns y at `x` on the same lines.
pub(super) fn value_at(points: &[(f64, f64)], x: f64) -> Reached {
    match points.iter().position(|p| p.0 >= x) {
        None => points.last().map_or(Reached::Never, |p| Reached::AtMost(p.1)),
        Some(0) if points[0].0 > x => Reached::Never,
        Some(0) => Reached::At(points[0].1),
        Some(i) => Reached::At(between(points[i - 1], points[i], x)),
    }
}

/// Returns the second coordinate on the line through `a` and `b`, in logarithms.
fn between(a: (f64, f64), b: (f64, f64), at: f64) -> f64 {
    // An error of 0 has no logarithm: the curve drops to it at its end.
    if at <= 0.0 || a.0 <= 0.0 || b.0 <= 0.0 || a.0 == b.0 {
        return b.1;
    }
    let share = (at.ln() - a.0.ln()) / (b.0.ln() - a.0.ln());
    (a.1.ln() + share * (b.1.ln() - a.1.ln())).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_of_known_laws() {
        for order in [-0.5, -0.75, -1.0, -1.5, -2.0] {
            let point = |i: i32| (4f64.powi(i), 0.3 * 4f64.powi(i).powf(order));
            let points: Vec<_> = (1..7).map(point).collect();
            let fit = Fit::of(&points).expect("six points");
            assert!((fit.order - order).abs() < 1e-12 && fit.high - fit.low < 1e-10, "{fit:?}");
            assert_eq!(fit.points, 6);
        }
    }

    /// Tests that of many noisy curves of one order, 95 % of the intervals contain it.
    #[test]
    fn intervals_cover() {
        let mut state = 1u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut normal = || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let runs = 2000;
        let covered = (0..runs).filter(|_| {
            let mut point = |i: i32| {
                let x = 2f64.powi(i);
                (x, x.powf(-0.5) * (0.1 * normal()).exp())
            };
            let points: Vec<_> = (2..9).map(&mut point).collect();
            Fit::of(&points).is_some_and(|f| f.low <= -0.5 && -0.5 <= f.high)
        });
        let share = covered.count() as f64 / f64::from(runs);
        assert!((share - 0.95).abs() < 0.02, "{share}");
    }

    #[test]
    fn too_little_gives_no_fit() {
        assert_eq!(Fit::of(&[]), None);
        assert_eq!(Fit::of(&[(1.0, 1.0), (2.0, 0.5)]), None);
        assert_eq!(Fit::of(&[(2.0, 1.0), (2.0, 0.5), (2.0, 0.7)]), None);
        // The second and third repeat the first, and the others have no logarithm.
        let same = [(1.0, 1.0); 3];
        let bad = [(2.0, 0.0), (4.0, f64::NAN), (8.0, f64::INFINITY), (16.0, -1.0)];
        assert_eq!(Fit::of(&[&same[..], &bad[..]].concat()), None);
    }

    #[test]
    fn quantiles_of_t() {
        let known =
            [(1, 12.706), (5, 2.571), (12, 2.179), (13, 2.1604), (23, 2.0687), (60, 2.0003)];
        for (freedom, t) in known {
            assert!((student_t(freedom) - t).abs() < 1e-3, "{freedom}");
        }
        assert_eq!(student_t(0), f64::INFINITY);
    }

    #[test]
    fn curves_meet_limits_or_do_not() {
        let points = [(1.0, 1e-1), (100.0, 1e-2), (1e4, 1e-3)];
        let near = |found: Reached, v: f64| match found {
            Reached::At(x) => assert!((x / v - 1.0).abs() < 1e-12, "{x} {v}"),
            other => panic!("{other:?}"),
        };
        near(first_below(&points, 1e-2), 100.0);
        near(first_below(&points, 10f64.powf(-1.5)), 10.0);
        assert_eq!(first_below(&points, 0.5), Reached::AtMost(1.0));
        assert_eq!(first_below(&points, 1e-4), Reached::Never);
        assert_eq!(first_below(&[], 1.0), Reached::Never);
        near(value_at(&points, 10.0), 10f64.powf(-1.5));
        near(value_at(&points, 1.0), 1e-1);
        assert_eq!(value_at(&points, 0.5), Reached::Never);
        assert_eq!(value_at(&points, 1e5), Reached::AtMost(1e-3));
        assert_eq!(first_below(&[(1.0, 0.1), (2.0, 0.0)], 0.0), Reached::At(2.0));
    }
}
