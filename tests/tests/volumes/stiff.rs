//! Emission and absorption with known results, thin and thick.

use raydsl::prelude::*;
use raydsl::testing;
use raydsl::volume::{
    Adaptive, Euler, ExactCell, ExponentialLeft, MeanExtinction, Midpoint, PreIntegrated,
    ShadedCell, TransferFunction, VolumeLight,
};

use super::{along, column, linear, volume};

/// Relative difference.
fn off(found: f32, expected: f64) -> f64 {
    (f64::from(found) - expected).abs() / expected.abs()
}

/// One cell of any optical depth: opacity without loss.
#[test]
fn opacity_of_a_homogeneous_cell() {
    for depth in [1e-8f32, 1e-6, 1e-3, 1.0, 1e3, 1e6] {
        let grid = column(1, 1.0, |_| 1.0);
        let volume = volume(&grid, linear(depth, 1.0, 1.0));
        let expected = -(-f64::from(depth)).exp_m1();
        let exact = ExactCell::new().least(0.0);
        let light = volume.integrate(&exact, along(), VolumeLight::new());
        assert!(off(light.opacity(), expected) < 1e-6, "{depth}: {}", light.opacity());
        assert!(off(light.radiance.x, expected) < 1e-6, "{depth}: {}", light.radiance.x);
    }
}

/// Linear extinction and colour: `extinction = s t / D`, `color = t / D`, `D = 2`.
#[test]
fn linear_ramps() {
    for (scale, expected) in [
        (1e-6f32, 6.6666626666680952e-7),
        (4.0, 0.42272505649247666),
        (400.0, 0.044311346272637901),
        (4e4, 0.0044311346272637901),
        (4e6, 0.00044311346272637901),
    ] {
        for count in [1, 3, 64, 1024] {
            let grid = column(count, 2.0, |t| t);
            let volume = volume(&grid, linear(scale, 0.0, 1.0));
            let exact = ExactCell::new().least(0.0);
            let light = volume.integrate(&exact, along(), VolumeLight::new());
            let off = off(light.radiance.x, expected);
            assert!(off < 1e-5, "{scale}, {count} cells: {} off by {off}", light.radiance.x);
            let kernel =
                kernel!(|ray: Ray| volume.integrate(&exact, ray, VolumeLight::new()).radiance.x);
            let f64_off = (kernel.reference((along(),))[0] - expected).abs() / expected;
            // The rule of four points is right to so much whatever numbers compute it.
            assert!(f64_off < 4e-6, "{scale}, {count} cells, in f64: off by {f64_off}");
        }
    }
}

/// Asserts radiance and opacity of the exact cell, in every variant.
#[track_caller]
fn assert_near(name: &str, volume: &raydsl::volume::Volume<'_, f32>, ray: Ray, expected: [f64; 2]) {
    let exact = ExactCell::new().least(0.0);
    let kernel = kernel!(|ray: Ray| {
        let light = volume.integrate(&exact, ray, VolumeLight::new());
        (light.radiance.x, light.opacity())
    });
    // llvmpipe ends the loops of an invocation after 65535 iterations in all.
    let is_long = volume.grid().size().z > 4096;
    for variant in Variant::ALL {
        if variant == Variant::Wgsl && is_long || !testing::can_run(variant, name) {
            continue;
        }
        let bound = if variant == Variant::Wgsl { 1e-4 } else { 1e-5 };
        let found = testing::run(&kernel, variant, &[(ray,)])[0];
        for (found, expected) in [(found.0, expected[0]), (found.1, expected[1])] {
            let off = off(found, expected);
            let variant = variant.name();
            assert!(off <= bound, "{name}, {variant}: {found}, not {expected}: off by {off}");
        }
    }
    if !is_long {
        for (found, expected) in kernel.reference((ray,)).into_iter().zip(expected) {
            let off = (found - expected).abs() / expected.abs();
            // The rule of four points is right to so much whatever numbers compute it.
            assert!(off <= 6e-6, "{name}, f64: {found}, not {expected}: off by {off}");
        }
    }
}

/// A homogeneous slab in front of black.
#[test]
fn a_homogeneous_slab() {
    let grid = column(1, 1.0, |_| 1.0);
    let alpha = -(-2.5f64).exp_m1();
    assert_near("slab", &volume(&grid, linear(2.5, 0.8, 0.8)), along(), [0.8 * alpha, alpha]);
    let light = volume(&grid, linear(2.5, 0.8, 0.8)).integrate(
        &ExactCell::new(),
        along(),
        VolumeLight::new(),
    );
    assert!((light.over(Vec3::splat(0.1)).x - 0.74254050).abs() < 1e-6);
}

/// Optical depths from 1e-8 to 1e6 in one cell and in a million, rising and falling.
#[test]
fn thin_and_thick_ramps() {
    for depth in [1e-8f64, 1e-4, 1.0, 30.0, 1e4, 1e6] {
        for count in [1u32, 1000, 1_000_000] {
            // Extinction rises from 0 to `2 depth` over a length of 1; colour from 0 to 1 with it.
            let grid = column(count, 1.0, |t| t);
            let rising = volume(&grid, linear((2.0 * depth) as f32, 0.0, 1.0));
            let alpha = -(-depth).exp_m1();
            let expected = ramp(depth);
            assert_near(&format!("ramp {depth:e} in {count}"), &rising, along(), [expected, alpha]);
        }
    }
}

/// The integral from 0 to 1 of `t 2 d t exp(-d t²)`, by the rule of Simpson over what is not dark.
fn ramp(d: f64) -> f64 {
    let end = (40.0 / d).sqrt().min(1.0);
    let count = 200_000;
    let f = |t: f64| 2.0 * d * t * t * (-d * t * t).exp();
    let h = end / f64::from(count);
    let inner: f64 =
        (1..count).map(|i| f(f64::from(i) * h) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
    (f(0.0) + inner + f(end)) * h / 3.0
}

/// Two homogeneous layers, divided by a step of the transfer function.
#[test]
fn two_layers() {
    let grid = column(1, 2.0, |t| t);
    let colors = [(0.5, Vec3::splat(0.9)), (0.5, Vec3::splat(0.2))];
    let layers = TransferFunction::from_extinction(&colors, &[(0.5, 1.0), (0.5, 3.0)]);
    let volume = volume(&grid, layers.expect("a function"));
    let expected = 0.63973704534668025 - 0.05 * (-4.0f64).exp();
    assert_near("layers", &volume, along(), [expected, -(-4.0f64).exp_m1()]);
}

/// A value on a step is behind it, as for the function itself.
#[test]
fn values_on_a_step() {
    let step = |value: f32, before: f32| {
        let knots = [(value, before), (value, 2.0)];
        TransferFunction::from_extinction(&[(value, Vec3::ONE)], &knots).expect("a function")
    };
    let grid = column(2, 2.0, |_| 1.0);
    let flat = volume(&grid, step(1.0, 0.0));
    assert_eq!(flat.transfer().at(1.0).extinction, 2.0);
    let alpha = -(-4.0f64).exp_m1();
    assert_near("on a step", &flat, along(), [alpha, alpha]);
    let shaded = ShadedCell::new(Vec3::Z, 1.0).least(0.0);
    let light = flat.integrate(&shaded, along(), VolumeLight::new());
    assert!(off(light.opacity(), alpha) < 1e-6, "{light:?}");
    // Of many cells before some end beyond the step, by one rounding.
    for i in 0..200 {
        let grid = column(2, 2.0, |t| if t > 0.0 { 0.7 } else { -0.01 * i as f32 });
        let volume = volume(&grid, step(0.7, 0.5));
        let exact = ExactCell::new().least(0.0);
        let light = volume.integrate(&exact, along(), VolumeLight::new());
        assert!(off(light.depth, 2.5) < 1e-5, "{i}: {light:?}");
    }
}

/// A thick layer, thinner than any part into which a piece is divided.
#[test]
fn a_layer_thinner_than_all_parts() {
    let layer = [(0.0, 6e7), (1e-8, 6e7), (1e-8, 0.0)];
    let layer = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &layer).expect("sorted");
    let grid = column(1, 1.0, |t| t);
    let depth = 6e7 * f64::from(1e-8f32);
    let alpha = -(-depth).exp_m1();
    assert_near("thin layer", &volume(&grid, layer), along(), [alpha, alpha]);
}

/// Where nothing is to be left out, what is behind any depth counts.
#[test]
fn nothing_is_left_out() {
    let grid = column(64, 64.0, |_| 1.0);
    let volume = volume(&grid, linear(20.0, 1.0, 1.0));
    let none = VolumeLight::new();
    for light in [
        volume.integrate(&ExactCell::new().least(0.0), along(), none),
        volume.integrate(&ExponentialLeft::new(1.0).least(0.0), along(), none),
        volume.integrate(&Midpoint::new(1.0).least(0.0), along(), none),
        volume.integrate(&MeanExtinction::new(1.0).least(0.0), along(), none),
        volume.integrate(&PreIntegrated::new(1.0).least(0.0), along(), none),
    ] {
        assert!(off(light.depth, 1280.0) < 1e-5, "{light:?}");
    }
}

/// Beyond the far ends of a function it is constant.
#[test]
fn values_beyond_the_far_ends() {
    let constant = [(0.0, Vec3::ONE)];
    let constant = TransferFunction::from_extinction(&constant, &[(0.0, 2.0)]).expect("sorted");
    for most in [1.5e38, -1.5e38] {
        let grid = column(1, 1.0, |t| t * most);
        let volume = volume(&grid, constant.clone());
        let light = volume.integrate(&ExactCell::new(), along(), VolumeLight::new());
        assert!(off(light.depth, 2.0) < 1e-5, "{most:e}: {light:?}");
    }
}

/// Shading is of directions, also of gradients whose squares are infinite or vanish.
#[test]
fn gradients_of_any_length_shade() {
    let homogeneous = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 1.0)]);
    let homogeneous = homogeneous.expect("a function");
    let alpha = -(-1.0f64).exp_m1();
    let radiance = |grid: &raydsl::volume::Grid<'_, f32>, edge: f32| {
        let shaded = ShadedCell::new(vec3(0.6, 0.0, 0.8), edge).least(0.0);
        let volume = volume(grid, homogeneous.clone());
        volume.integrate(&shaded, along(), VolumeLight::new()).radiance.x
    };
    for scale in [2f32.powi(-90), 1.0, 2f32.powi(80)] {
        let grid = column(1, 1.0, |t| t * scale);
        for edge in [0.0, 0.5 * scale] {
            let found = radiance(&grid, edge);
            // 0.3 of ambient light, and a cosine of 0.8.
            let expected = (0.3 + 0.7 * 0.8) * alpha;
            assert!(off(found, expected) < 1e-5, "{scale:e}, {edge:e}: {found}, not {expected}");
        }
    }
    // Where nothing changes there is no border, whatever the edge.
    let found = radiance(&column(1, 1.0, |_| 1.0), 0.0);
    assert!(off(found, alpha) < 1e-5, "{found}");
}

/// Missing voxels have no colour, in steps that they end either.
#[test]
fn what_is_missing_has_no_color() {
    let colors = [(0.0, Vec3::Z), (1.0, Vec3::X)];
    let function = TransferFunction::from_extinction(&colors, &[(0.0, 1.0)]).expect("sorted");
    let grid = column(3, 3.0, |t| if t > 0.9 { f32::NAN } else { 1.0 });
    let volume = volume(&grid, function);
    let light = volume.integrate(&MeanExtinction::new(1.0), along(), VolumeLight::new());
    assert_eq!(light.radiance.z, 0.0, "{light:?}");
    // A whole step, and one whose end is missing.
    assert!(off(light.depth, 1.5) < 1e-6, "{light:?}");
    let back = Ray::new(vec3(0.5, 0.5, 4.0), -Vec3::Z);
    let light = volume.integrate(&MeanExtinction::new(1.0), back, VolumeLight::new());
    assert!(light.radiance.z == 0.0 && light.radiance.x > 0.5, "{light:?}");
}

/// A narrow peak of the transfer function, in any number of cells.
#[test]
fn a_narrow_peak() {
    let peak = [(0.5, 0.0), (0.5, 1e4), (0.501, 1e4), (0.501, 0.0)];
    let peak = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &peak).expect("a function");
    for count in [1, 2, 7, 64, 4096] {
        let grid = column(count, 1.0, |t| t);
        let volume = volume(&grid, peak.clone());
        // The peak is 0.001 wide but for the rounding of 0.501.
        let depth = 1e4 * (f64::from(0.501f32) - 0.5);
        let alpha = -(-depth).exp_m1();
        assert!((alpha - 0.99995460007023752).abs() < 1e-7);
        // Pre-integrated steps find it whatever their number.
        for steps in [1u16, 2, 3, 7, 64, 1000, 4096] {
            let rule = PreIntegrated::new(1.0 / f32::from(steps)).least(0.0);
            let light = volume.integrate(&rule, along(), VolumeLight::new());
            assert!(off(light.opacity(), alpha) < 1e-5, "{steps} steps: {}", light.opacity());
        }
        assert_near(&format!("peak in {count}"), &volume, along(), [alpha, alpha]);
    }
}

/// One cell with one corner of 1, along its diagonal: a cubic.
#[test]
fn a_diagonal() {
    let mut voxels = [0.0f32; 8];
    voxels[7] = 1.0;
    let grid = raydsl::volume::Grid::new(&voxels[..], uvec3(2, 2, 2), Default::default());
    let grid = grid.expect("a grid");
    let volume = volume(&grid, linear(6.0, 1.0, 1.0));
    let ray = Ray::new(Vec3::splat(-1.0), Vec3::ONE);
    let alpha = -(-2.5980762113533159f64).exp_m1();
    assert_near("diagonal", &volume, ray, [alpha, alpha]);
}

/// An extinction whose optical depth leaves the range of `f32`: an opaque layer.
#[test]
fn extinction_without_bound_is_opaque() {
    let grid = column(3, 1e6, |_| 0.5);
    let colors = [(0.0, Vec3::splat(0.25))];
    let black = TransferFunction::from_extinction(&colors, &[(0.0, 3e38)]).expect("a function");
    let volume = volume(&grid, black);
    assert_near("opaque", &volume, along(), [0.25, 1.0]);
    for light in [
        volume.integrate(&Midpoint::new(1e5).least(0.0), along(), VolumeLight::new()),
        volume.integrate(&Euler::new(1e5).least(0.0), along(), VolumeLight::new()),
        volume.integrate(&MeanExtinction::new(1e5).least(0.0), along(), VolumeLight::new()),
        volume.integrate(&PreIntegrated::new(1e5).least(0.0), along(), VolumeLight::new()),
        volume.integrate(&Adaptive::new(1e-4), along(), VolumeLight::new()),
        volume.integrate(&ExactCell::new().least(0.0), along(), VolumeLight::new()),
    ] {
        let light = volume.integrate(&ExactCell::new(), along(), light);
        assert!((light.rgba() - vec4(0.25, 0.25, 0.25, 1.0)).abs().max_element() < 1e-6);
        assert!(light.depth.is_finite());
    }
}

/// Peaks of any height and width, on grids of any size: numbers, and of the peak's colour.
#[test]
fn peaks_without_bound_are_numbers() {
    for (length, count) in [(1e6, 3), (1.0, 1), (1e-3, 50)] {
        let grid = column(count, length, |t| t);
        for width in [1e-6, 1e-3, 0.4] {
            for most in [1e6, 1e20, 3e38] {
                let peak = [(0.5, 0.0), (0.5 + width, most), (0.5 + 2.0 * width, 0.0)];
                let colors = [(0.0, Vec3::splat(0.5))];
                let peak = TransferFunction::from_extinction(&colors, &peak).expect("a function");
                let volume = volume(&grid, peak);
                let light = [
                    volume.integrate(&ExactCell::new().least(0.0), along(), VolumeLight::new()),
                    volume.integrate(&Adaptive::new(1e-4), along(), VolumeLight::new()),
                    volume.integrate(
                        &PreIntegrated::new(length / 7.0),
                        along(),
                        VolumeLight::new(),
                    ),
                ];
                for light in light {
                    let (found, half) = (light.radiance.x, 0.5 * light.opacity());
                    assert!((found - half).abs() < 1e-5, "{length}, {width}, {most}: {light:?}");
                    assert!(light.depth.is_finite() && light.opacity() > 1e-4, "{light:?}");
                }
            }
        }
    }
}

/// Extinction and colour rise and fall, with each other and against, over values from 0 to 1 and
/// back: against the rule of Simpson.
#[test]
fn all_orders_of_extinction_and_color() {
    for depth in [1e-3f64, 0.4, 0.99, 1.0, 3.0, 100.0] {
        for (extinctions, colors) in [
            ([0.0, 2.0], [1.0, 0.0]),
            ([2.0, 0.0], [0.0, 1.0]),
            ([2.0, 0.0], [1.0, 0.0]),
            ([1.5, 0.5], [0.0, 1.0]),
            ([0.5, 1.5], [1.0, 0.25]),
        ] {
            let [from, to] = extinctions.map(|e| e * depth);
            let knots = [(0.0, from as f32), (1.0, to as f32)];
            let shades = [0, 1].map(|i| (i as f32, Vec3::splat(colors[i])));
            let function = TransferFunction::from_extinction(&shades, &knots).expect("sorted");
            let [first, last] = colors.map(f64::from);
            let f = |t: f64| {
                let passed = (-(from * t + 0.5 * (to - from) * t * t)).exp();
                (from + (to - from) * t) * (first + (last - first) * t) * passed
            };
            let count = 100_000;
            let h = 1.0 / f64::from(count);
            let inner: f64 =
                (1..count).map(|i| f(f64::from(i) * h) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
            let expected = [(f(0.0) + inner + f(1.0)) * h / 3.0, -(-depth).exp_m1()];
            for cells in [1, 3, 40] {
                let grid = column(cells, 1.0, |t| t);
                let volume = volume(&grid, function.clone());
                let name = format!("{depth}, {extinctions:?}, {colors:?} in {cells}");
                assert_near(&name, &volume, along(), expected);
            }
        }
    }
}
