//! Quantiles of Fisher's F distribution; Student's t squared is F with one degree of freedom.

use core::f64::consts::PI;

/// Returns the `p` quantile of F with `d1` and `d2` degrees of freedom, above 0.
pub(super) fn f_quantile(p: f64, d1: f64, d2: f64) -> f64 {
    // d1 F / (d1 F + d2) has a beta distribution. The search is for the side that is farther from
    // 1.
    let (a, b) = (0.5 * d1, 0.5 * d2);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        // The complement of the argument, so that large quantiles keep their digits.
        if beta(b, a, middle) > 1.0 - p {
            high = middle;
        } else {
            low = middle;
        }
        if high - low <= 1e-13 * high {
            break;
        }
    }
    let rest = 0.5 * (low + high);
    d2 * (1.0 - rest) / (d1 * rest)
}

/// Returns the regularised incomplete beta function.
fn beta(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return if x <= 0.0 { 0.0 } else { 1.0 };
    }
    let front = ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * (-x).ln_1p();
    if x < (a + 1.0) / (a + b + 2.0) {
        front.exp() * fraction(a, b, x) / a
    } else {
        1.0 - front.exp() * fraction(b, a, 1.0 - x) / b
    }
}

/// Returns its continued fraction, by Lentz's method. (Press and others, "Numerical Recipes", 3rd
/// edition, 2007, section 6.4.)
fn fraction(a: f64, b: f64, x: f64) -> f64 {
    let away = |v: f64| if v.abs() < 1e-300 { 1e-300 } else { v };
    let mut c = 1.0;
    let mut d = 1.0 / away(1.0 - (a + b) * x / (a + 1.0));
    let mut h = d;
    for m in 1..20_000 {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut step = 1.0;
        for term in [even, odd] {
            d = 1.0 / away(1.0 + term * d);
            c = away(1.0 + term / c);
            step = d * c;
            h *= step;
        }
        if (step - 1.0).abs() < 1e-15 {
            break;
        }
    }
    h
}

/// Returns the logarithm of the gamma function, for arguments above 0. (Lanczos 1964, with
/// Godfrey's coefficients for g = 7.)
fn ln_gamma(x: f64) -> f64 {
    const C: [f64; 8] = [
        676.520_368_121_885_1,
        -1_259.139_216_722_402_8,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507_343_278_686_905,
        -0.138_571_095_265_720_12,
        9.984_369_578_019_572e-6,
        1.505_632_735_149_311_6e-7,
    ];
    let x = x - 1.0;
    let series: f64 = C.iter().zip(1..).map(|(c, i)| c / (x + f64::from(i))).sum();
    let t = x + 7.5;
    0.5 * (2.0 * PI).ln() + (x + 0.5) * t.ln() - t + (0.999_999_999_999_809_9 + series).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests against tables of Student's t and of F (NIST/SEMATECH e-Handbook, 1.3.6.7), and closed
    /// forms.
    #[test]
    fn quantiles_of_tables() {
        let t = |p: f64, d: f64| f_quantile(p, 1.0, d).sqrt();
        let cases = [
            (t(0.95, 7.0), 2.364_624_251_592_785),
            (t(0.99, 7.0), 3.499_483_297_350_49),
            (t(0.95, 1.0), 12.706_204_736_174_7),
            (t(0.9999, 1.0), 6_366.197_671_226_33),
            (t(0.95, 1e7), 1.959_964_2),
            // With two degrees of freedom each: p / (1 - p).
            (f_quantile(0.95, 2.0, 2.0), 19.0),
            (f_quantile(0.05, 2.0, 2.0), 1.0 / 19.0),
            (f_quantile(0.95, 10.0, 70.0), 1.968_877),
        ];
        for (i, (found, expected)) in cases.into_iter().enumerate() {
            assert!((found / expected - 1.0).abs() < 2e-6, "{i}: {found} {expected}");
        }
    }

    #[test]
    fn many_degrees_of_freedom_leave_little_doubt() {
        for pixels in [1e4, 1e6, 1e8] {
            let wide = f_quantile(0.95, pixels, 7.0 * pixels);
            // The normal approximation: a variance of 2 / d1 + 2 / d2.
            let normal = 1.0 + 1.645 * (2.0 / pixels * (1.0 + 1.0 / 7.0)).sqrt();
            assert!((wide - normal).abs() < 0.2 * (normal - 1.0), "{pixels}: {wide} {normal}");
        }
    }
}
