//! Grids of labels.

use raydsl::prelude::*;
use raydsl::volume::{
    Grid, GridConfig, Labels, Midpoint, TransferError, TransferFunction, Volume, VolumeLight,
};
use raydsl_tests::rng::Rng;

use super::agreement::assert_close;

/// Red 2, blue 5, and green 3 and 4, which lie between but nowhere in the grid.
fn organs() -> TransferFunction {
    let organs = [
        (2, vec3(1.0, 0.0, 0.0), 0.3),
        (3, vec3(0.0, 1.0, 0.0), 0.9),
        (4, vec3(0.0, 1.0, 0.0), 0.9),
        (5, vec3(0.0, 0.0, 1.0), 0.7),
    ];
    TransferFunction::labels(&organs, 1.0).expect("sorted labels")
}

#[test]
fn no_label_is_between_two_others() {
    let mut rng = Rng::of("labels");
    let size = uvec3(11, 9, 12);
    let voxels: Vec<f32> =
        (0..size.x * size.y * size.z).map(|_| rng.pick(&[0.0, 2.0, 5.0])).collect();
    let grid = Grid::new(&voxels[..], size, GridConfig::new()).expect("a grid");
    let volume = Volume::new(&grid, organs());
    let labels = Labels::new(0.2).lit(vec3(0.0, 0.6, 0.8), 0.4);
    let inputs: Vec<(Ray,)> = (0..150)
        .map(|_| {
            let direction = rng.direction();
            let target = size.as_vec3() * (rng.point(0.5) + 0.5);
            (Ray::new(target - direction * 20.0, direction),)
        })
        .collect();
    let mut bled = 0;
    for &(ray,) in &inputs {
        let light = volume.integrate(&labels, ray, VolumeLight::new());
        assert_eq!(light.radiance.y, 0.0, "{ray:?}");
        let plain = volume.integrate(&Labels::new(0.2), ray, VolumeLight::new());
        let sum = plain.radiance.element_sum();
        assert!((sum - plain.opacity()).abs() < 1e-5, "{ray:?}: {plain:?}");
        assert!(light.radiance.element_sum() <= sum * (1.0 + 1e-6));
        let mean = volume.integrate(&Midpoint::new(0.2), ray, VolumeLight::new());
        bled += usize::from(mean.radiance.y > 0.1);
    }
    assert!(bled > 50, "a mean of two labels is a third one: {bled}");
    let kernel = kernel!(|ray: Ray| volume.integrate(&labels, ray, VolumeLight::new()).rgba());
    // The gradient, and with it the shading, differs from cell to cell.
    assert_close(&kernel, &inputs, 2e-2);
}

/// Within a label nothing has a gradient, so nothing is shaded.
#[test]
fn only_borders_are_shaded() {
    let size = uvec3(6, 6, 6);
    let voxels = vec![2.0; 216];
    let grid = Grid::new(&voxels[..], size, GridConfig::new()).expect("a grid");
    let volume = Volume::new(&grid, organs());
    let plain = Labels::new(0.2);
    let lit = plain.lit(vec3(0.0, 0.6, 0.8), 0.25);
    let ray = Ray::new(vec3(3.2, 2.9, -4.0), Vec3::Z);
    let kernel = kernel!(|ray: Ray| volume.integrate(&lit, ray, VolumeLight::new()).rgba());
    let found = kernel.call((ray,));
    assert!(found.x > 0.3, "{found}");
    assert_eq!(found, volume.integrate(&plain, ray, VolumeLight::new()).rgba());
    assert_close(&kernel, &[(ray,)], 1e-4);
}

#[test]
fn labels_are_values_within_a_half() {
    let organs = organs();
    for (value, color, transmittance) in [
        (1.4, Vec3::X, 1.0f32),
        (1.6, Vec3::X, 0.7),
        (2.4, Vec3::X, 0.7),
        (2.6, Vec3::Y, 0.1),
        (4.4, Vec3::Y, 0.1),
        (5.4, Vec3::Z, 0.3),
        (5.6, Vec3::Z, 1.0),
    ] {
        let found = organs.at(value);
        let off = ((-found.extinction).exp() - transmittance).abs();
        assert!(off < 1e-6, "{value}: {found:?}");
        assert!(found.extinction == 0.0 || found.color == color, "{value}: {found:?}");
    }
    let wrong = |labels: &[(u32, Vec3, f32)]| TransferFunction::labels(labels, 1.0).map(|_| ());
    assert_eq!(wrong(&[]), Err(TransferError::NoKnots { of: "labels" }));
    for bad in [(4, Vec3::ONE, 1.5), (4, Vec3::NAN, 0.5), (4, -Vec3::X, 0.5)] {
        let error = TransferError::OutOfRange { of: "labels", index: 1 };
        assert_eq!(wrong(&[(3, Vec3::ONE, 0.5), bad]), Err(error));
    }
    let one = (3, Vec3::ONE, 0.5);
    assert_eq!(wrong(&[one, one]), Err(TransferError::Unsorted { of: "labels", index: 1 }));
    let far = (u32::MAX, Vec3::ONE, 0.5);
    assert_eq!(wrong(&[one, far]), Err(TransferError::OutOfRange { of: "labels", index: 1 }));
}
