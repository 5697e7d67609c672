//! Variants of kernels whose decisions are too many to be followed.

use raydsl::kernel::{Kernel, Variant};
use raydsl::machine::Type;
use raydsl::prelude::*;
use raydsl::testing;
use raydsl::volume::TransferFunction;

/// Asserts that all variants on the CPU have the same bits, and that WGSL is within `bound` of
/// them.
///
/// A march along a ray takes hundreds of decisions whose sides meet: which cell a sample on a
/// border is in, between which knots a value on a knot is. Too many are open for each to be
/// followed, and none makes a difference beyond rounding: that is what this bound tests.
///
/// # Panics
///
/// If they differ.
#[track_caller]
pub fn assert_close<A: Type + Copy + core::fmt::Debug>(
    kernel: &Kernel<'_, A, Vec4>,
    inputs: &[A],
    bound: f32,
) {
    let expected = testing::run(kernel, Variant::Scalar, inputs);
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        if testing::can_run(variant, "volumes") {
            let found = testing::run(kernel, variant, inputs);
            let bits = |all: &[Vec4]| all.iter().map(|v| v.to_array().map(f32::to_bits)).collect();
            let (a, b): (Vec<[u32; 4]>, Vec<[u32; 4]>) = (bits(&expected), bits(&found));
            assert_eq!(a, b, "{}", variant.name());
        }
    }
    if testing::can_run(Variant::Wgsl, "volumes") {
        let found = testing::run(kernel, Variant::Wgsl, inputs);
        for (i, (a, b)) in expected.iter().zip(&found).enumerate() {
            let off = (*a - *b).abs().max_element();
            assert!(off <= bound, "WGSL: {:?}: {b}, not {a}, off by {off}", inputs[i]);
        }
    }
}

/// Functions with soft and narrow peaks, steps, and opaque layers, of values from 0 to 1.
pub fn functions() -> [TransferFunction; 4] {
    let colors =
        [(0.0, vec3(0.1, 0.0, 0.8)), (0.4, vec3(1.0, 0.5, 0.1)), (1.0, vec3(0.3, 0.9, 0.2))];
    let soft = [(0.2, 0.0), (0.5, 0.3), (0.9, 0.8)];
    let spike = [(0.5, 0.0), (0.505, 400.0), (0.51, 0.0)];
    let step = [(0.45, 0.0), (0.45, 3.0), (0.7, 3.0), (0.7, 0.1)];
    [
        TransferFunction::new(&colors, &soft, 1.0),
        TransferFunction::from_extinction(&colors, &spike),
        TransferFunction::from_extinction(&colors, &step),
        TransferFunction::new(&colors, &[(0.3, 0.0), (0.6, 1.0)], 0.1),
    ]
    .map(|f| f.expect("a function"))
}
