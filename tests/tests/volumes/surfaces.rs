//! Surfaces of one value, greatest and mean values along rays, against dense samples in `f64`.

use raydsl::prelude::*;
use raydsl::volume::{Centering, Grid, GridConfig, SurfaceHit, SurfaceWalk, next_surface};
use raydsl_tests::rng::Rng;

use super::agreement::assert_close;
use super::oracle::Field;

fn noise(size: UVec3) -> Vec<f32> {
    let mut rng = Rng::of("surfaces");
    (0..size.x * size.y * size.z).map(|_| rng.unit()).collect()
}

fn rays(size: UVec3, count: usize) -> Vec<(Ray,)> {
    let mut rng = Rng::of("rays");
    let ray = |_| {
        let target = size.as_vec3() * (rng.point(0.7) + 0.5);
        let direction = rng.direction().normalize();
        (Ray::new(target - direction * rng.range(5.0, 30.0), direction),)
    };
    (0..count).map(ray).collect()
}

#[test]
fn surfaces_and_values_along_rays() {
    for centering in [Centering::Vertex, Centering::Cell] {
        surfaces_and_values(GridConfig::new().centering(centering));
    }
}

fn surfaces_and_values(config: GridConfig) {
    let size = uvec3(21, 12, 9);
    let voxels = noise(size);
    let grid = Grid::new(&voxels[..], size, config).expect("a grid");
    let field = Field::new(&voxels, &grid);
    let level = 0.7;
    let inputs = rays(size, 200);
    let (mut met, mut missed) = (0, 0);
    for &(ray,) in &inputs {
        let (enter, leave) = grid.span(ray);
        if enter >= leave {
            missed += 1;
            assert_eq!(grid.first_surface(ray, level), None);
            assert_eq!((grid.greatest(ray), grid.mean(ray)), (-f32::MAX, 0.0));
            continue;
        }
        let at = |t: f64| field.value(ray.origin.as_dvec3() + ray.direction.as_dvec3() * t);
        let (enter, leave) = (f64::from(enter), f64::from(leave));
        let count = ((leave - enter) * 500.0) as usize + 2;
        let place = |i: usize| enter + (leave - enter) * (i as f64 + 0.5) / count as f64;
        let values: Vec<f64> = (0..count).map(|i| at(place(i))).collect();
        let most = values.iter().copied().fold(0.0, f64::max);
        let found = f64::from(grid.greatest(ray));
        assert!(found >= most - 1e-5 && found <= most + 1e-3, "{ray:?}: {found} and {most}");
        let mean = values.iter().sum::<f64>() / count as f64;
        assert!((f64::from(grid.mean(ray)) - mean).abs() < 2e-4, "{ray:?}: {mean}");
        // Every crossing, one behind the other.
        let mut walk = SurfaceWalk::new(ray, level);
        let mut crossings = Vec::new();
        while let Some(hit) = next_surface(&grid, &mut walk) {
            met += 1;
            let off = (at(f64::from(hit.t)) - f64::from(level)).abs();
            // The position has a rounding error of some ulps of 30.
            assert!(off < 2e-5, "{ray:?}: the value at {} is off by {off}", hit.t);
            // In the outer half of a voxel the gradient is that of the samples next to it.
            let place = ray.origin + ray.direction * hit.t;
            if place.cmpge(Vec3::ZERO).all() && place.cmple((size - 1).as_vec3()).all() {
                let slope = (at(f64::from(hit.t) + 1e-4) - at(f64::from(hit.t) - 1e-4)) / 2e-4;
                let along = f64::from(hit.gradient.dot(ray.direction));
                assert!((along - slope).abs() < 0.05 * (1.0 + slope.abs()), "{along} and {slope}");
            }
            assert!(crossings.last().is_none_or(|last| *last <= f64::from(hit.t)));
            crossings.push(f64::from(hit.t));
        }
        let signs: Vec<bool> = values.iter().map(|v| *v > f64::from(level)).collect();
        let changes: Vec<f64> =
            (1..count).filter(|i| signs[*i] != signs[*i - 1]).map(place).collect();
        for change in &changes {
            let nearest = crossings.iter().map(|t| (t - change).abs()).fold(f64::MAX, f64::min);
            assert!(nearest < 5e-3, "{ray:?}: no surface at {change}: {crossings:?}");
        }
        // One that two samples miss has another beside it.
        // Those before the first sample or behind the last change no sign.
        let (first, last) = (place(0), place(count - 1));
        let between = crossings.iter().filter(|t| (first..last).contains(*t)).count();
        let missed = between - changes.len();
        assert!(missed.is_multiple_of(2), "{ray:?}: {crossings:?} and {changes:?}");
    }
    assert!(met > 200 && missed > 0, "{met} surfaces, {missed} rays beside");
    let kernel = kernel!(|ray: Ray| {
        let (mut first, mut count, mut turn) = (0.0, 0.0, 0.0);
        let mut walk = SurfaceWalk::new(ray, level);
        while let Some(hit) = next_surface(&grid, &mut walk) {
            first = if count == 0.0 { hit.t } else { first };
            turn = hit.gradient.x;
            count += 1.0;
        }
        let greatest = grid.greatest(ray);
        let greatest = if greatest > 0.0 { greatest } else { 0.0 };
        vec4(first + count, turn, greatest, grid.mean(ray))
    });
    assert_close(&kernel, &inputs, 1e-4);
}

/// Values whose squares are infinite, or vanish, turn along a ray as all others do.
#[test]
fn values_of_any_size_have_turns() {
    let ray = Ray::new(Vec3::splat(-1.0), Vec3::ONE);
    for most in [1.0f32, 1e20, 1e-24] {
        let mut voxels = [most; 8];
        (voxels[0], voxels[7]) = (0.0, 0.0);
        let grid = Grid::new(&voxels[..], uvec3(2, 2, 2), GridConfig::new()).expect("a grid");
        // Along the diagonal the value is `3 t (1 - t)` of that.
        let greatest = grid.greatest(ray) / most;
        assert!((greatest - 0.75).abs() < 1e-6, "{most:e}: {greatest}");
        let hit = grid.first_surface(ray, 0.5 * most).expect("a surface");
        let place = 0.5 - (1.0f32 / 12.0).sqrt();
        assert!((hit.t - (1.0 + place)).abs() < 1e-5, "{most:e}: {hit:?}");
    }
}

/// Flat cells, cells at the value itself, and a grid of one voxel.
#[test]
fn surfaces_of_flat_fields() {
    let ray = Ray::new(vec3(0.25, 0.25, -2.0), Vec3::Z);
    let flat = Grid::new(&[1.0f32; 27][..], uvec3(3, 3, 3), GridConfig::new()).expect("a grid");
    assert_eq!(flat.first_surface(ray, 1.0), None);
    assert_eq!(flat.first_surface(ray, 0.5), None);
    assert_eq!((flat.greatest(ray), flat.mean(ray)), (1.0, 1.0));
    let one = Grid::new(&[3.0f32][..], UVec3::ONE, GridConfig::new()).expect("a grid");
    assert_eq!(one.first_surface(ray, 3.0), None);
    let ramp: Vec<f32> = (0..12).map(|i| (i / 4) as f32).collect();
    let ramp = Grid::new(ramp, uvec3(2, 2, 3), GridConfig::new()).expect("a grid");
    // The value is met in the plane of samples, and once.
    let hit = ramp.first_surface(ray, 1.0);
    assert_eq!(hit, Some(SurfaceHit { t: 3.0, gradient: Vec3::Z }));
    let mut walk = SurfaceWalk::new(ray, 1.0);
    assert_eq!(next_surface(&ramp, &mut walk), hit);
    assert_eq!(next_surface(&ramp, &mut walk), None);
}
