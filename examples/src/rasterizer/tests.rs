use std::f32::consts::TAU;

use glam::camera::rh::{proj::directx, view::look_at_mat4};
use raydsl::kernel;
use raydsl::testing::can_run;

use super::*;

const SIZE: (u32, u32) = (237, 181);

/// A surface of waves, and a cone that stands in it; all is behind the near plane.
fn waves() -> Vec<[Corner; 3]> {
    let corner = |i: u32, j: u32| {
        let (x, z) = (i as f32 / 8.0 - 2.5, j as f32 / 8.0 - 2.5);
        let place = vec3(x, 0.4 * (2.0 * x).sin() * (1.5 * z).cos(), z);
        Corner { place, color: vec3(i as f32 / 40.0, j as f32 / 40.0, 0.5) }
    };
    let square = |(i, j)| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let squares = (0..40).flat_map(|j| (0..40).map(move |i| (i, j))).flat_map(square);
    let end = |i: u32, y| {
        let (sin, cos) = (i as f32 / 24.0 * TAU).sin_cos();
        Corner { place: vec3(0.5 * cos, y, 0.5 * sin), color: vec3(0.9, i as f32 / 24.0, 0.1) }
    };
    let cone = (0..24).map(|i| [end(i, -0.5), end(i + 1, -0.5), end(i, 1.6)]);
    squares.chain(cone).collect()
}

fn matrices() -> (Mat4, Mat4) {
    let view = look_at_mat4(vec3(1.3, 2.6, 4.1), vec3(0.1, 0.1, 0.0), Vec3::Y);
    (view, directx::perspective(0.8, SIZE.0 as f32 / SIZE.1 as f32, 0.5, 50.0))
}

/// The difference between the least and the greatest depth of a pixel and its neighbours.
fn slope(image: &Image<Fragment>, x: u32, y: u32) -> f32 {
    let near = |v: u32| v.saturating_sub(1)..=v + 1;
    let depths = near(y).flat_map(|y| near(x).map(move |x| (x, y)));
    let depths = depths.filter_map(|(x, y)| image.get(x, y)).map(|f| f.depth);
    let (low, high) = depths.fold((1f32, 0f32), |(l, h), d| (l.min(d), h.max(d)));
    high - low
}

/// Devices round corners to a grid. Vulkan asks for 16 places a pixel at least; most have 256.
const PLACES: f32 = 16.0;

/// That two pictures have the same depths, to within rounding and what rounded corners make of
/// them: what the depth changes by on the way to the next pixel, over `places`. Where an edge goes
/// through the middle of a pixel to within that, either may have it: 1 in 1000 may be different.
#[track_caller]
fn assert_same_depths(
    what: &str,
    found: &Image<Fragment>,
    expected: &Image<Fragment>,
    places: f32,
) {
    let (mut covered, mut others) = (0, 0);
    let mut largest = 0f32;
    for (x, y) in pixels() {
        let [a, b] = [found, expected].map(|image| image.get(x, y).map_or(f32::NAN, |f| f.depth));
        covered += u32::from(b < 1.0);
        let bound = 1e-6 + slope(expected, x, y) / places;
        // A NaN is not within it, either.
        if (a - b).abs() <= bound {
            largest = largest.max((a - b).abs());
        } else {
            others += 1;
        }
    }
    println!("{what}: {others} of {covered} pixels differ, the others by at most {largest:e}");
    assert!(covered > 20_000, "{what}: {covered} pixels are covered");
    assert!(others * 1000 <= covered, "{what}: {others} of {covered} pixels differ");
}

fn pixels() -> impl Iterator<Item = (u32, u32)> {
    (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)))
}

#[test]
fn a_device_draws_what_code_draws_and_rays_see() -> Result<(), RasterizerError> {
    let (view, proj) = matrices();
    let triangles = waves();
    let software = Rasterizer::Software.draw(&triangles, proj * view, SIZE)?;

    let places = |t: &[Corner; 3]| Triangle { v0: t[0].place, v1: t[1].place, v2: t[2].place };
    let places: Vec<Triangle> = triangles.iter().map(places).collect();
    let bvh = Bvh::build(&places).expect("finite triangles");
    let camera = Matrix::new(view, proj, DepthRange::ZERO_TO_ONE).expect("an inverse");
    let window = camera.begin_frame(SIZE.0, SIZE.1);
    let depth = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        if hit.is_hit { window.window_depth(ray.at(hit.t)) } else { 1.0 }
    });
    let mut seen = Image::filled(SIZE.0, SIZE.1, 1.0);
    SimpleScheduler::new().frame(&camera, &depth, &mut seen);
    let seen = seen.map(|d| Fragment { depth: *d, ..NOTHING });
    // Both have exact corners.
    assert_same_depths("software, rays", &software, &seen, f32::INFINITY);

    if !can_run(Variant::Wgsl, "a device draws what code draws and rays see") {
        return Ok(());
    }
    let wgpu = Rasterizer::wgpu()?.draw(&triangles, proj * view, SIZE)?;
    assert_same_depths("wgpu, rays", &wgpu, &seen, PLACES);
    assert_same_depths("wgpu, software", &wgpu, &software, PLACES);
    // Colours, too, and nothing where nothing is.
    let apart = |(a, b): (&Fragment, &Fragment)| (a.color - b.color).abs().max_element();
    let pairs = wgpu.pixels().iter().zip(software.pixels());
    let others = pairs.filter(|pair| apart(*pair) > 0.01 || pair.0.color.is_nan()).count();
    println!("the colours of {others} pixels differ");
    assert!(others <= 27, "the colours of {others} pixels differ");
    Ok(())
}

#[test]
fn what_cannot_be_drawn_is_said() -> Result<(), RasterizerError> {
    assert!(Rasterizer::named(Some("gl")).is_err_and(|e| e.to_string().contains("or software")));
    if !can_run(Variant::Wgsl, "what cannot be drawn is said") {
        return Ok(());
    }
    let wgpu = Rasterizer::wgpu()?;
    let triangles = waves();
    let wide = wgpu.draw(&triangles, Mat4::IDENTITY, (1 << 20, 1));
    assert!(matches!(wide, Err(RasterizerError::TooLarge { width: 1_048_576, .. })));
    // Nothing to draw, or to draw on, is no mistake, and neither are corners that are no numbers.
    assert_eq!(wgpu.draw(&[], Mat4::IDENTITY, (3, 2))?, Image::filled(3, 2, NOTHING));
    assert!(wgpu.draw(&triangles, Mat4::IDENTITY, (0, 5))?.pixels().is_empty());
    let nan = Mat4::from_cols_array(&[f32::NAN; 16]);
    assert_eq!(wgpu.draw(&triangles, nan, (9, 9))?, Image::filled(9, 9, NOTHING));
    Ok(())
}
