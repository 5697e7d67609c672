//! Radical inverses.

use super::rng::ONE_MINUS_EPSILON;
use super::unit_f32;
use crate::kernel;
use crate::machine::generic::min;

/// Returns the van der Corput sequence: the bits of `i` mirrored at the radix point, of which 24
/// are kept.
#[kernel]
#[inline]
pub fn van_der_corput(i: u32) -> f32 {
    unit_f32(i.reverse_bits())
}

/// Returns the radical inverse: the digits of `i` in a base, mirrored at the radix point, from 0 to
/// below 1. A base below 2 returns 0.
///
/// Correctly rounded where the digits of `i` are a number up to 2^24, else at most 1.5 ulp off.
/// (van der Corput, 1935; Halton, 1960.)
#[kernel]
pub fn radical_inverse(base: u32, i: u32) -> f32 {
    if base < 2 {
        return 0.0;
    }
    // Collect as many digits as fit an exact `f32` in one integer.
    let mut mirrored = 0u32;
    let mut power = 1u32;
    let mut rest = i;
    while rest > 0 && power <= 0x0100_0000 / base {
        mirrored = mirrored * base + rest % base;
        power *= base;
        rest /= base;
    }
    min((mirrored as f32 + mirrored_digits(base, rest)) / power as f32, ONE_MINUS_EPSILON)
}

/// Returns the radical inverse, from the most significant digit on: each division shrinks earlier
/// errors.
#[kernel]
#[inline]
fn mirrored_digits(base: u32, i: u32) -> f32 {
    let mut power = 1u32;
    while power <= i / base {
        power *= base;
    }
    let mut rest = i;
    let mut sum = 0.0;
    while power > 0 {
        sum = (sum + (rest / power) as f32) / base as f32;
        rest %= power;
        power /= base;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(base: u32, i: u32) -> f64 {
        let (mut rest, mut digit, mut sum) = (i, 1.0, 0.0);
        while rest > 0 {
            digit /= f64::from(base);
            sum += f64::from(rest % base) * digit;
            rest /= base;
        }
        sum
    }

    #[test]
    fn known_numbers() {
        let twos = [1, 2, 4, 8].map(|i| radical_inverse(2, i));
        assert_eq!(twos, [0.5, 0.25, 0.125, 0.0625]);
        assert_eq!([1, 2, 4, 8].map(van_der_corput), twos);
        let tens = [1, 2, 23, 4711].map(|i| radical_inverse(10, i));
        assert_eq!(tens, [0.1, 0.2, 0.32, 0.1174]);
    }

    #[test]
    fn close_to_exact_in_every_base() {
        let numbers = (0..2000).chain((0..32).map(|k| u32::MAX >> k));
        for (k, i) in numbers.enumerate() {
            for base in [2, 3, 5, 7, 10, 97, 65_537, u32::MAX, 2 + k as u32] {
                let (found, expected) = (radical_inverse(base, i), exact(base, i));
                let error = (f64::from(found) - expected).abs();
                assert!(error <= 1.5 * 2f64.powi(-23) * expected, "{base} {i}: {found} {expected}");
                assert!(found < 1.0);
            }
        }
        assert_eq!([radical_inverse(0, 5), radical_inverse(1, 5)], [0.0; 2]);
    }
}
