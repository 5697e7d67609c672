//! Kernels whose bounds were wrong once.

use super::*;
use crate::kernel::Kernel;
use crate::math::elementary::sincos_2pi;
use crate::prelude::kernel;

/// Asserts that what the kernel gives is within an outcome, and returns all.
#[track_caller]
fn held<A: Type + core::fmt::Debug, R: Type>(kernel: &Kernel<'_, A, R>, args: A) -> Outcomes {
    let outcomes = kernel.outcomes(args, Rounding::IEEE, 64);
    assert!(outcomes.contains(kernel.call(args)), "{args:?}: {outcomes:?}");
    outcomes
}

#[test]
fn quotients_by_zeros_have_their_sign() {
    let product = kernel!(|x: f32, y: f32, z: f32| 8.0 / ((x * y) * z));
    assert!(held(&product, (1.1, -1.3, 0.0)).iter().all(|o| o[0].value() == f64::NEG_INFINITY));
    let size = kernel!(|x: f32| 1.0 / x.abs());
    assert_eq!(held(&size, (-0.0,)).reference()[0].value(), f64::INFINITY);
    let signed = kernel!(|x: f32| 1.0 / x.copysign(1.0));
    assert_eq!(held(&signed, (-0.0,)).reference()[0].value(), f64::INFINITY);
}

#[test]
fn zeros_of_either_sign_have_bits() {
    let bits = kernel!(|x: f32, y: f32| (if x / y > -0.0 { -0.0 } else { x / y }).to_bits());
    assert!(held(&bits, (1e-45, 5.769085)).is_complete());
    let bits = kernel!(|x: f32, y: f32| (x / y).min(-0.0).to_bits());
    assert!(held(&bits, (1e-45, 5.769085)).is_complete());
    let sign = kernel!(|x: f32, y: f32| (x / y).min(-0.0).signum());
    assert!(held(&sign, (1e-45, 5.769085)).is_complete());
}

#[test]
fn the_sign_of_a_nan_is_open() {
    let sign = kernel!(|x: f32| 1.0f32.copysign(x / x));
    let found = held(&sign, (0.0,));
    assert!(found.is_uncertain() && found.contains(1.0f32) && found.contains(-1.0f32));
}

#[test]
fn waves_reach_their_zeros() {
    let wave = kernel!(|x: f32, y: f32| sincos_2pi((x * y).min(0.5)).sin);
    for args in [(0.7, 0.71428573), (0.3, 1.6666667), (0.1, 5.0), (1.1, 0.45454547)] {
        held(&wave, args);
    }
}

/// What is asked of the bits alone does not leave the path open.
#[test]
fn classes_and_signs_come_of_the_range() {
    let finite = kernel!(|x: f32| (x * 1.7 + 0.3).is_finite());
    assert!(!held(&finite, (2.0,)).is_uncertain());
    let nan = kernel!(|x: f32| (x * 1.7 + 0.3).is_nan());
    assert!(!held(&nan, (2.0,)).is_uncertain());
    let sign = kernel!(|x: f32| (x * 1.7 + 0.3).signum());
    assert!(!held(&sign, (2.0,)).is_uncertain());
    let negative = kernel!(|x: f32| (x * 1.7 + 0.3).is_sign_negative());
    assert!(!held(&negative, (2.0,)).is_uncertain());
    let overflows = kernel!(|x: f32, y: f32| (x + y).is_finite());
    assert!(held(&overflows, (f32::MAX, 1e31)).is_uncertain());
}
