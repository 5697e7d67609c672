//! Transfer functions of the value and the length of its gradient.

use raydsl::prelude::*;
use raydsl::volume::{
    Grid, GridConfig, Midpoint, TransferError, TransferFunction, TransferFunction2d, Volume,
    Volume2d, VolumeLight,
};
use raydsl_tests::rng::Rng;

use super::agreement::assert_close;

const GRADIENTS: Vec2 = vec2(0.0, 0.5);

/// The same along the gradients as a 1-D function of three values.
fn of_value() -> (TransferFunction2d, TransferFunction) {
    let extinctions = [0.0f32, 0.25, 1.5];
    let colors = [Vec3::X, Vec3::Y, vec3(0.5, 0.5, 1.0)];
    let knots = [0, 1, 2].map(|i| (i as f32 * 0.5, extinctions[i]));
    let of_colors = [0, 1, 2].map(|i| (i as f32 * 0.5, colors[i]));
    let samples: Vec<(Vec3, f32)> =
        (0..12).map(|i| (colors[i % 3], 1.0 - (-extinctions[i % 3]).exp())).collect();
    let two = TransferFunction2d::new(&samples, uvec2(3, 4), vec2(0.0, 1.0), GRADIENTS, 1.0);
    let one = TransferFunction::from_extinction(&of_colors, &knots);
    (two.expect("twelve samples"), one.expect("sorted knots"))
}

/// Gradients from 0.2 on have opacities of any kind, shorter ones this one.
fn of_borders(rest: f32) -> TransferFunction2d {
    let mut rng = Rng::of("samples");
    let samples: Vec<(Vec3, f32)> = (0..8 * 11)
        .map(|i| (Vec3::splat(rng.unit()), if i / 8 < 4 { rest } else { rng.unit() }))
        .collect();
    let values = vec2(0.1, 0.9);
    TransferFunction2d::new(&samples, uvec2(8, 11), values, GRADIENTS, 0.7).expect("88 samples")
}

fn field() -> (Vec<f32>, UVec3, GridConfig) {
    let mut rng = Rng::of("field");
    let size = uvec3(37, 22, 29);
    let value = |i: u32| {
        let at = uvec3(i % size.x, i / size.x % size.y, i / (size.x * size.y)).as_vec3();
        (0.5 - (at.distance(size.as_vec3() * 0.4) - 8.0) * 0.2).clamp(0.0, 1.0)
    };
    let voxels = (0..size.element_product()).map(|i| value(i) * (0.9 + 0.1 * rng.unit())).collect();
    (voxels, size, GridConfig::new().spacing(vec3(0.5, 1.0, 0.75)))
}

fn rays(count: usize) -> Vec<(Ray,)> {
    let mut rng = Rng::of("rays");
    let ray = |_| {
        let target = vec3(18.0, 22.0, 21.0) * (rng.point(0.4) + 0.4);
        let direction = rng.direction();
        (Ray::new(target - direction * 40.0, direction),)
    };
    (0..count).map(ray).collect()
}

#[test]
fn a_function_of_the_value_alone_is_one_dimensional() {
    let (voxels, size, config) = field();
    let grid = Grid::new(&voxels[..], size, config).expect("a grid");
    let (two, one) = of_value();
    let (two, one) = (Volume2d::new(&grid, two), Volume::new(&grid, one));
    let mut seen = 0;
    for (ray,) in rays(200) {
        let rule = Midpoint::new(0.3);
        let expected = one.integrate(&rule, ray, VolumeLight::new()).rgba();
        let found = two.integrate(rule, ray, VolumeLight::new()).rgba();
        assert!((found - expected).abs().max_element() < 1e-5, "{ray:?}: {found}, not {expected}");
        seen += usize::from(found.w > 0.1);
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn variants_agree_and_skipping_changes_nothing() {
    let (voxels, size, config) = field();
    let grid = Grid::new(&voxels[..], size, config).expect("a grid");
    let mut volume = Volume2d::new(&grid, of_borders(0.0));
    let empty = volume.majorants().iter().filter(|m| **m == 0.0).count();
    assert!(empty > 3 && empty < volume.majorants().len() / 2, "{empty}");
    // No sample of a macro-cell is above its bound.
    let mut rng = Rng::of("points");
    let macros = grid.macro_cells();
    for _ in 0..5000 {
        let at = (rng.point(1.0) + 0.5) * (size - 1).as_vec3();
        let p = config.to_world.transform_point3(at);
        let found = volume.transfer().at(grid.value(p), grid.gradient(p).length()).extinction;
        let cell = (at.floor().as_uvec3().min(size - 2)) / 8;
        let most = volume.majorants()[(cell.x + macros.x * (cell.y + macros.y * cell.z)) as usize];
        assert!(found <= most, "{found} at {at} is above {most}");
    }
    let inputs = rays(150);
    let rule = Midpoint::new(0.2);
    {
        let (volume, rule) = (&volume, &rule);
        let kernel = kernel!(|ray: Ray| volume.integrate(*rule, ray, VolumeLight::new()).rgba());
        // Gradients differ from cell to cell.
        assert_close(&kernel, &inputs, 2e-2);
    }
    let before: Vec<Vec4> = inputs
        .iter()
        .map(|(ray,)| volume.integrate(rule, *ray, VolumeLight::new()).rgba())
        .collect();
    assert!(before.iter().filter(|v| v.w > 0.1).count() > 50);
    // The same function but for an opacity that no rounding keeps: no macro-cell is empty.
    volume.set_transfer(of_borders(1e-30));
    assert!(volume.majorants().iter().all(|m| *m > 0.0));
    for ((ray,), before) in inputs.iter().zip(before) {
        let found = volume.integrate(rule, *ray, VolumeLight::new()).rgba();
        assert!((found - before).abs().max_element() < 2e-6, "{ray:?}: {found}, not {before}");
    }
}

#[test]
fn functions_are_checked() {
    let good = [(Vec3::ONE, 0.5); 4];
    let new = |samples: &[(Vec3, f32)], size, values, gradients, unit| {
        TransferFunction2d::new(samples, size, values, gradients, unit).map(|_| ())
    };
    let (size, range) = (uvec2(2, 2), vec2(0.0, 1.0));
    assert_eq!(new(&good, size, range, range, 1.0), Ok(()));
    let samples = TransferError::Samples { size, found: 3 };
    assert_eq!(new(&good[..3], size, range, range, 1.0), Err(samples));
    for size in [uvec2(1, 4), uvec2(4, 1), uvec2(0, 0), uvec2(5000, 2)] {
        let samples = TransferError::Samples { size, found: 4 };
        assert_eq!(new(&good, size, range, range, 1.0), Err(samples));
    }
    for wrong in [vec2(1.0, 1.0), vec2(0.0, f32::INFINITY), vec2(f32::NAN, 1.0)] {
        assert!(matches!(new(&good, size, wrong, range, 1.0), Err(TransferError::Range { .. })));
        assert!(matches!(new(&good, size, range, wrong, 1.0), Err(TransferError::Range { .. })));
    }
    assert_eq!(new(&good, size, range, range, 0.0), Err(TransferError::UnitDistance(0.0)));
    for wrong in [(Vec3::ONE, 1.5), (Vec3::ONE, f32::NAN), (-Vec3::ONE, 0.5), (Vec3::NAN, 0.5)] {
        let samples = [good[0], good[1], wrong, good[3]];
        let error = TransferError::OutOfRange { of: "samples", index: 2 };
        assert_eq!(new(&samples, size, range, range, 1.0), Err(error));
    }
}
