//! Means of a transfer function between two values.

use raydsl::prelude::*;
use raydsl::testing;
use raydsl::volume::TransferFunction;
use raydsl_tests::rng::Rng;

use super::agreement::assert_close;

/// Extinction and colour times extinction, by the rule of the midpoint between all knots.
fn mean(function: &TransferFunction, a: f64, b: f64) -> (f64, f64) {
    let (low, high) = (a.min(b), a.max(b));
    let knots = function.knots();
    let mut ends = vec![low, high];
    ends.extend(knots.iter().map(|k| f64::from(k.value)).filter(|v| *v > low && *v < high));
    ends.sort_by(f64::total_cmp);
    let (mut extinction, mut emission) = (0.0, 0.0);
    for part in ends.windows(2) {
        let width = (part[1] - part[0]) / 256.0;
        for i in 0..256 {
            let value = part[0] + (f64::from(i) + 0.5) * width;
            let next = knots.partition_point(|k| f64::from(k.value) <= value);
            let (before, after) = (&knots[next.max(1) - 1], &knots[next.min(knots.len() - 1)]);
            let (from, to) = (f64::from(before.value), f64::from(after.value));
            let share = if to > from { (value - from) / (to - from) } else { 0.0 };
            let mix = |a: f32, b: f32| f64::from(a) + (f64::from(b) - f64::from(a)) * share;
            let e = mix(before.extinction, after.extinction);
            extinction += e * width;
            emission += e * mix(before.color.x, after.color.x) * width;
        }
    }
    (extinction / (high - low), emission / extinction)
}

#[test]
fn means_are_right_to_rounding() {
    let mut rng = Rng::of("means");
    for round in 0..40 {
        let count = rng.below(12) + 1;
        let mut values: Vec<f32> = (0..count).map(|_| rng.range(-3.0, 3.0)).collect();
        if round % 3 == 0 {
            // Steps, and peaks that are narrow.
            values.extend([0.5, 0.5, 0.500_01, 1.25, 1.25]);
        }
        values.sort_by(f32::total_cmp);
        let scale = rng.pick(&[1e-3, 1.0, 1e4]);
        let extinctions: Vec<(f32, f32)> = values
            .iter()
            .map(|v| (*v, if rng.below(3) == 0 { 0.0 } else { rng.unit() * scale }))
            .collect();
        let colors: Vec<(f32, Vec3)> =
            (0..3).map(|i| (i as f32 - 1.3, Vec3::splat(rng.unit()))).collect();
        let function = TransferFunction::from_extinction(&colors, &extinctions).expect("sorted");
        let inputs: Vec<(f32, f32)> = (0..100)
            .map(|i| {
                let a = rng.range(-4.0, 4.0);
                (a, if i % 2 == 0 { rng.range(-4.0, 4.0) } else { a + rng.range(-1e-3, 1e-3) })
            })
            .collect();
        for &(a, b) in &inputs {
            let found = function.between(a, b);
            let (extinction, color) = mean(&function, f64::from(a), f64::from(b));
            let most = f64::from(function.greatest_extinction(vec2(a.min(b), a.max(b))));
            let off = (f64::from(found.extinction) - extinction).abs();
            // Of the values' width some bits are lost where both are near.
            let width = f64::from((a - b).abs());
            let bound = most * (2e-6 + 1e-6 / width.max(1e-6) * 1e-1);
            assert!(off <= bound, "{a} to {b}: {found:?}, not {extinction}, {off} above {bound}");
            if extinction > 1e-2 * most {
                let off = (f64::from(found.color.x) - color).abs();
                assert!(off <= 1e-4, "{a} to {b}: {found:?}, not of {color}");
            }
            assert_eq!(function.between(b, a), found);
        }
        let kernel = kernel!(|a: f32, b: f32| {
            let mean = function.between(a, b);
            vec4(mean.color.x, mean.color.y, mean.color.z, mean.extinction / scale)
        });
        if round < 6 {
            assert_close(&kernel, &inputs, 1e-5);
        }
    }
}

#[test]
fn the_mean_of_one_value_is_it() {
    let ramp = [(0.0, 0.0), (1.0, 2.0), (1.0, 3.0)];
    let ramp = TransferFunction::from_extinction(&[(0.0, Vec3::X)], &ramp).expect("a function");
    for value in [-1.0, 0.25, 0.5, 1.0, 7.0] {
        assert_eq!(ramp.between(value, value).extinction, ramp.at(value).extinction);
    }
    assert_eq!(ramp.between(0.0, 1.0).extinction, 1.0);
    assert_eq!(ramp.between(0.0, 2.0).extinction, 2.0);
}

/// Beyond its knots a function has the values of its ends, however far.
#[test]
fn far_values_are_those_of_the_ends() {
    let ramp = [(0.0, 0.5), (1.0, 2.0), (1.0, 3.0)];
    let ramp = TransferFunction::from_extinction(&[(0.0, Vec3::X)], &ramp).expect("a function");
    for far in [7.0, 1e30, f32::MAX, f32::INFINITY] {
        assert_eq!((ramp.at(far).extinction, ramp.at(-far).extinction), (3.0, 0.5), "{far}");
    }
    let kernel = kernel!(|value: f32| {
        let sample = ramp.at(value);
        vec4(sample.color.x, sample.color.y, sample.color.z, sample.extinction)
    });
    assert_close(&kernel, &[(7.0,), (-7.0,), (1e30,), (-1e30,)], 1e-6);
    // A NaN is the least value.
    assert_eq!(ramp.at(f32::NAN), ramp.at(-7.0));
    for variant in [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        if testing::can_run(variant, "a NaN") {
            let found = testing::run(&kernel, variant, &[(f32::NAN,)])[0];
            assert_eq!(found, vec4(1.0, 0.0, 0.0, 0.5), "{}", variant.name());
        }
    }
}

/// Between two knots opacity is off by less than 0.0005, also next to opacity 1, where extinction
/// rises by a million.
#[test]
fn extinction_follows_opacity() {
    for [from, to] in [[0.99f32, 1.0], [1.0, 0.99], [0.0, 1.0], [0.3, 0.7], [0.999_966, 0.4517]] {
        let ends = [(0.0, from), (1.0, to)];
        let function = TransferFunction::new(&[(0.0, Vec3::ONE)], &ends, 1.0).expect("sorted");
        for i in 0..=20_000 {
            let value = i as f32 / 20_000.0;
            let opacity = -(-f64::from(function.at(value).extinction)).exp_m1();
            let expected = f64::from(from) + f64::from(to - from) * f64::from(value);
            let off = (opacity - expected).abs();
            assert!(off < 5e-4, "{from} to {to}, at {value}: {opacity}, off by {off}");
        }
    }
}
