//! Multiple importance sampling: weights of samples from several strategies.

use crate::kernel;

/// Returns the balance heuristic: the weight of the first strategy, `n_f` samples of density `f`,
/// where the second has `n_g` of density `g`.
///
/// Veach and Guibas, "Optimally Combining Sampling Techniques" (1995). 0 if `f` is 0, 1 if `f`
/// alone is infinite; weights add up to 1 unless both are 0 or infinite, where they are 0 and NaN.
#[kernel]
#[inline]
pub fn balance_heuristic(n_f: f32, f: f32, n_g: f32, g: f32) -> f32 {
    let (a, b) = (n_f * f, n_g * g);
    if a > b { 1.0 / (1.0 + b / a) } else { share_of_less(a, b) }
}

/// Returns the power heuristic with exponent 2: as [`balance_heuristic()`], of the densities'
/// squares.
///
/// The ratio is squared, not the densities: those of small lights and of mirrors have squares
/// outside the range of `f32`.
#[kernel]
#[inline]
pub fn power_heuristic(n_f: f32, f: f32, n_g: f32, g: f32) -> f32 {
    let (a, b) = (n_f * f, n_g * g);
    if a > b {
        let ratio = b / a;
        1.0 / (1.0 + ratio * ratio)
    } else {
        let ratio = if a == 0.0 { 0.0 } else { a / b };
        ratio * ratio / (1.0 + ratio * ratio)
    }
}

#[kernel]
#[inline]
fn share_of_less(a: f32, b: f32) -> f32 {
    let ratio = if a == 0.0 { 0.0 } else { a / b };
    ratio / (1.0 + ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up() {
        let densities = [1e-38, 1e-20, 0.1, 1.0, 3.0, 1e20, 1e38];
        for f in densities {
            for g in densities {
                for heuristic in [balance_heuristic, power_heuristic] {
                    let sum = heuristic(2.0, f, 1.0, g) + heuristic(1.0, g, 2.0, f);
                    assert!((sum - 1.0).abs() < 2e-7, "{f} {g}: {sum}");
                }
            }
        }
        assert_eq!(balance_heuristic(1.0, 3.0, 1.0, 1.0), 0.75);
        assert_eq!(power_heuristic(1.0, 3.0, 1.0, 1.0), 0.9);
    }

    #[test]
    fn ends_are_defined() {
        for heuristic in [balance_heuristic, power_heuristic] {
            assert_eq!(heuristic(1.0, 0.0, 1.0, 0.0), 0.0);
            assert_eq!(heuristic(1.0, 0.0, 1.0, 2.0), 0.0);
            assert_eq!(heuristic(1.0, 2.0, 1.0, 0.0), 1.0);
            assert_eq!(heuristic(1.0, f32::INFINITY, 1.0, 2.0), 1.0);
            assert_eq!(heuristic(1.0, 2.0, 1.0, f32::INFINITY), 0.0);
        }
    }
}
