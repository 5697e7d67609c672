//! Regression tests of kernels whose bounds were once wrong.

use super::*;
use crate::math::elementary::sincos_2pi;
use crate::prelude::{Kernel, Vec3, Vec4, kernel, vec3};

/// Asserts that the kernel's result is within an outcome, and returns all outcomes.
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

/// Tests the sign of a zero that is the product of two known numbers: a device made 0 of `0 * x`,
/// whatever `x` was. Strict arithmetic has the sign.
#[test]
fn the_sign_of_a_product_that_is_zero_is_open() {
    let sign = kernel!(|x: f32, y: f32| (x * y).signum());
    let found = sign.outcomes((0.0, -2.0), Rounding::WGSL, 64);
    assert!(found.is_complete() && found.contains(1.0f32) && found.contains(-1.0f32));
    let found = held(&sign, (0.0, -2.0));
    assert!(found.contains(-1.0f32) && !found.contains(1.0f32));
    // So has that of a vector.
    let signs = kernel!(|x: f32, v: Vec3| (x * v).signum().y);
    let found = signs.outcomes((0.0, vec3(1.4e29, -1.5, 74.25)), Rounding::WGSL, 64);
    assert!(found.is_complete() && found.contains(1.0f32) && found.contains(-1.0f32));
    let signs = kernel!(|v: Vec3| {
        let x = Vec4::W;
        (x.y * v).signum()
    });
    let found = signs.outcomes((vec3(1.4e29, -1.5, 74.25),), Rounding::WGSL, 64);
    assert!(found.is_complete() && found.contains(vec3(1.0, 1.0, 1.0)), "{found:?}");
    // It is 0 all the same.
    let is_zero = kernel!(|x: f32, y: f32| x * y == 0.0 && x * y + 3.0 == 3.0);
    assert!(!is_zero.outcomes((0.0, -2.0), Rounding::WGSL, 64).is_uncertain());
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

/// Tests that a loop that never ends on a path other than that of `f64` is abandoned.
#[test]
fn loops_that_do_not_end_are_left_soon() {
    let falls = kernel!(|x: f32| {
        let mut t = x * 3.3;
        let mut rounds = 0u32;
        while t != 0.0 {
            t = (t - 1.0).floor();
            rounds += 1;
        }
        rounds
    });
    let found = falls.outcomes((0.303_030_3,), Rounding::IEEE, 64);
    let rounds: f64 = found.iter().map(|o| o[0].value()).sum();
    assert!(!found.is_complete() && rounds < 300e3, "{rounds}");
}

/// Returns the outcomes of a kernel on a device.
#[track_caller]
fn on_device<A: Type, R: Type>(kernel: &Kernel<'_, A, R>, args: A) -> Outcomes {
    kernel.outcomes(args, Rounding::WGSL, 64)
}

#[test]
fn a_device_need_not_be_exact() {
    let quotient = kernel!(|x: f32, y: f32| x / y);
    let found = on_device(&quotient, (41.0, 41.0));
    assert!(found.contains(41.0 * (1.0f32 / 41.0)) && found.contains(1.0f32));
    assert!(!found.contains(1.000_01f32));
    assert!(on_device(&quotient, (1.0, 1.8e38)).is_vague());
    let root = kernel!(|x: f32| x.sqrt());
    let found = on_device(&root, (49.0,));
    assert!(found.contains(7.0f32.next_down()) && !found.contains(6.999_9f32));
    let positive = kernel!(|x: f32| x > 0.0);
    assert!(on_device(&positive, (1e-40,)).is_uncertain());
    assert!(!on_device(&positive, (1e-30,)).is_uncertain());
}

#[test]
fn a_device_may_fuse_one_use_of_a_product() {
    let nothing = kernel!(|a: f32, b: f32| {
        let p = a * b;
        p - p
    });
    let fused = 1.1f32.mul_add(1.3, -(1.1 * 1.3));
    let found = on_device(&nothing, (1.1, 1.3));
    assert!(fused != 0.0 && found.contains(fused) && found.contains(0.0f32), "{found:?}");
    assert!(!found.contains(1e-6f32));
    // A product with 0 is 0 either way.
    let positive = kernel!(|x: f32, y: f32, z: f32| x * z.sqrt() + y * z > 0.0);
    assert!(!on_device(&positive, (0.0, 0.0, 0.3)).is_uncertain());
    assert!(on_device(&positive, (0.1, -0.1, 1.0)).is_uncertain());
}

#[test]
fn a_device_may_add_in_any_order() {
    let sum = kernel!(|a: f32, b: f32, c: f32| (a + b) + c);
    let found = on_device(&sum, (16_777_216.0, -16_777_216.0, 0.1));
    assert!(found.contains(16_777_216.0 + (-16_777_216.0f32 + 0.1)), "{found:?}");
    assert!(found.contains(0.1f32) && !found.contains(10.0f32), "{found:?}");
    let cancels = kernel!(|x: f32, y: f32, z: f32| (x * x + y * z) - 0.05);
    let found = on_device(&cancels, (187.5, 187.5, -187.5));
    assert!(found.contains(187.5f32 * 187.5 + (187.5 * -187.5 - 0.05)), "{found:?}");
    // The error of a long sum grows with its length, not with the square of it.
    let long = kernel!(|x: f32| {
        let mut sum = 0.0;
        for _ in 0..1000u32 {
            sum += x;
        }
        sum
    });
    let width = on_device(&long, (1.0,)).reference()[0].width();
    assert!(width < 2.1 * 1e6 * 2f64.powi(-23), "{width}");
}

/// Tests that classification by bits alone leaves no decision open.
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
