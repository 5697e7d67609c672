//! Cameras: against `f64`, in every variant, and at the ends of what they take.

use std::fmt::Debug;

use glam::camera::rh::proj::{directx, opengl};
use glam::camera::rh::view::look_at_mat4;
use glam::{DMat4, DVec3, DVec4};
use raydsl::camera::{CameraError, MatrixRays, PinholeRays, ThinLensRays};
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::check::{Wgsl, wgsl_agrees};
use raydsl_tests::rng::Rng as Source;
use raydsl_tests::scaled;
use raydsl_tests::values::compare;

const EYE: Vec3 = Vec3::new(3.0, 2.0, 5.0);
const CENTER: Vec3 = Vec3::new(-1.0, 0.5, 0.25);

fn pinhole() -> Pinhole {
    Pinhole::new(EYE, CENTER, Vec3::Y, 0.8)
}

/// Points of the film, and of a lens.
fn points(width: u32, height: u32) -> Vec<(f32, f32, Vec2)> {
    let mut rng = Source::new(u64::from(width));
    let count = scaled(2000) | 1;
    let point = |_| {
        let (x, y) = (rng.unit() * width as f32, rng.unit() * height as f32);
        (x, y, vec2(rng.unit(), rng.unit()))
    };
    (0..count).map(point).collect()
}

/// Packets give the source's bits; WGSL numbers within so many ulp.
fn agree<C: CameraRays + Debug>(
    rays: C,
    size: (u32, u32),
    kernel: &Kernel<'_, (f32, f32, Vec2), (Ray, Ray)>,
) {
    let inputs = points(size.0, size.1);
    let expected: Vec<(Ray, Ray)> = inputs.iter().map(|a| kernel.call(*a)).collect();
    for (input, rays_of) in inputs.iter().zip(&expected) {
        let (x, y, u) = *input;
        assert_eq!(*rays_of, (rays.primary_ray(x, y), rays.lens_ray(x, y, u)));
        for ray in [rays_of.0, rays_of.1] {
            assert!(
                (ray.direction.length() - 1.0).abs() < 3e-7 && ray.origin.is_finite(),
                "{ray:?}"
            );
        }
    }
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        let found = raydsl::testing::run(kernel, variant, &inputs);
        compare(variant.name(), &expected, &found).assert_same(|i| format!("{:?}", inputs[i]));
    }
    // Next to 0 a coordinate of a unit vector is off by an ulp of 1.
    let Some(gpu) = raydsl_tests::gpu::gpu() else { return };
    let mut found = expected.clone();
    gpu.batch(kernel, &inputs, &mut found).unwrap_or_else(|e| panic!("{e}\n{}", kernel.wgsl()));
    for ((a, b), input) in expected.iter().zip(&found).zip(&inputs) {
        for (a, b) in [(a.0, b.0), (a.1, b.1)] {
            let size = 1.0 + a.origin.length();
            let off = (a.direction - b.direction).length() + (a.origin - b.origin).length() / size;
            assert!(off < 1e-6 && (a.t_max / b.t_max - 1.0).abs() < 1e-5, "{input:?} {a:?} {b:?}");
        }
    }
}

#[test]
fn variants_agree() -> Result<(), CameraError> {
    let view = look_at_mat4(EYE, CENTER, Vec3::Y);
    let proj = directx::perspective(0.8, 1.5, 0.1, 100.0);
    let lens = ThinLens::new(pinhole(), 0.25, 4.0);
    macro_rules! check {
        ($camera:expr) => {{
            let rays = $camera.begin_frame(96, 64);
            let kernel =
                kernel!(|x: f32, y: f32, u: Vec2| (rays.primary_ray(x, y), rays.lens_ray(x, y, u)));
            agree(rays, (96, 64), &kernel);
        }};
    }
    check!(pinhole());
    check!(lens);
    check!(Orthographic::new(EYE, CENTER, Vec3::Y, 3.0));
    check!(Matrix::new(view, proj, DepthRange::ZERO_TO_ONE)?);
    check!(Stereo::new(pinhole(), 0.06, 2.0).left());
    Ok(())
}

/// Eye (0, 0, 5), a right angle, 2 by 2 pixels: row 0 is the bottom.
#[test]
fn the_first_pixel_is_below_on_the_left() {
    let eye = vec3(0.0, 0.0, 5.0);
    let rays = Pinhole::new(eye, Vec3::ZERO, Vec3::Y, 90f32.to_radians()).begin_frame(2, 2);
    let ray = rays.primary_ray(0.5, 0.5);
    let expected = vec3(-0.408_248_3, -0.408_248_3, -0.816_496_6);
    assert!((ray.direction - expected).length() < 1e-6 && ray.origin == eye, "{ray:?}");
}

/// A ball of radius 1 at the distance 3 covers a known share of a square film.
#[test]
fn perspective_covers_what_it_should() {
    let camera = Pinhole::new(vec3(0.0, 0.0, 3.0), Vec3::ZERO, Vec3::Y, 60f32.to_radians());
    let side = 1024u16;
    let rays = camera.begin_frame(side.into(), side.into());
    let is_hit = |x: u16, y: u16| {
        let ray = rays.primary_ray(f32::from(x) + 0.5, f32::from(y) + 0.5);
        usize::from(sphere::intersect(ray, Vec3::ZERO, 1.0).is_hit)
    };
    let hits: usize = (0..side).map(|y| (0..side).map(|x| is_hit(x, y)).sum::<usize>()).sum();
    let share = hits as f64 / f64::from(side).powi(2);
    assert!((share - 0.294_524_311_274_043_1).abs() < 1e-4, "{share}");
}

/// All rays of a pixel meet at the distance of focus, and there alone.
#[test]
fn lenses_focus() {
    let forward = (CENTER - EYE).normalize().as_dvec3();
    let depth_of = |p: DVec3| (p - EYE.as_dvec3()).dot(forward);
    let at_depth = |ray: Ray, depth: f64| {
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        o + d * ((depth - depth_of(o)) / d.dot(forward))
    };
    for (radius, focus) in [(0.25, 4.0), (1e-3, 0.1), (2.0, 1000.0)] {
        let rays: ThinLensRays = ThinLens::new(pinhole(), radius, focus).begin_frame(96, 64);
        for (x, y, u) in points(96, 64) {
            let (ray, middle) = (rays.lens_ray(x, y, u), rays.primary_ray(x, y));
            let focus = f64::from(focus);
            let apart = (at_depth(ray, focus) - at_depth(middle, focus)).length();
            assert!(apart < 2e-6 * (focus + 6.0), "{radius} {focus}: {apart}");
            let from_middle = (ray.origin - EYE).as_dvec3();
            assert!(from_middle.length() <= f64::from(radius) * 1.000_001 + 1e-6);
            assert!(from_middle.dot(forward).abs() < 1e-6, "the lens faces the view");
        }
    }
}

/// Without a lens, or with focus at infinity.
#[test]
fn lenses_at_their_ends() {
    let sharp = pinhole().begin_frame(96, 64);
    let without = ThinLens::new(pinhole(), 0.0, 4.0).begin_frame(96, 64);
    for focus in [f32::INFINITY, 0.0, -1.0, f32::NAN] {
        let rays = ThinLens::new(pinhole(), 0.5, focus).begin_frame(96, 64);
        for (x, y, u) in points(96, 64).into_iter().take(100) {
            assert_eq!(rays.lens_ray(x, y, u).direction, sharp.primary_ray(x, y).direction);
            assert_eq!(without.lens_ray(x, y, u), sharp.primary_ray(x, y));
        }
    }
}

#[test]
fn orthographic_rays_are_parallel() {
    let rays = Orthographic::new(EYE, CENTER, Vec3::Y, 3.0).begin_frame(96, 64);
    let middle = rays.primary_ray(48.0, 32.0);
    assert!((middle.origin - EYE).length() < 1e-6);
    assert!((middle.direction - (CENTER - EYE).normalize()).length() < 1e-6);
    let (low, high) = (rays.primary_ray(48.0, 0.0), rays.primary_ray(48.0, 64.0));
    assert!(
        ((high.origin - low.origin).length() - 3.0).abs() < 1e-5 && high.origin.y > low.origin.y
    );
    assert_eq!(low.direction, high.direction);
}

/// What is at the distance without parallax is in the same place for both eyes, at all others not.
#[test]
fn stereo_has_its_parallax() {
    let (separation, zero) = (0.065, 2.5);
    let pair = Stereo::new(pinhole(), separation, zero);
    let eyes: [PinholeRays; 2] = [pair.left(), pair.right()].map(|eye| eye.begin_frame(96, 64));
    let forward = (CENTER - EYE).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    assert!((eyes[1].origin - eyes[0].origin - right * separation).length() < 1e-6);
    for (x, y, _) in points(96, 64) {
        let at = |depth: f32| {
            let points = eyes.map(|e| {
                let ray = e.primary_ray(x, y);
                ray.at(depth / ray.direction.dot(forward))
            });
            (points[1] - points[0]).dot(right)
        };
        assert!(at(zero).abs() < 4e-6, "{}", at(zero));
        // What one pixel of both shows at other distances is as far apart as the triangles say.
        for depth in [1.0, 5.0, 100.0] {
            let expected = separation * (1.0 - depth / zero);
            assert!((at(depth) - expected).abs() < 2e-6 * depth.max(4.0), "{depth}: {}", at(depth));
        }
    }
    for zero in [f32::INFINITY, 0.0, f32::NAN] {
        let eye = Stereo::new(pinhole(), separation, zero).left().begin_frame(96, 64);
        assert_eq!(eye.corner, pinhole().begin_frame(96, 64).corner);
    }
}

/// Matrices, and where the planes are.
fn projections() -> Vec<(&'static str, Mat4, DepthRange)> {
    let oblique = {
        // A near plane that is tilted (Lengyel, 2005): the last row of the inverse depends on the
        // film.
        let mut m = directx::perspective(0.8, 1.5, 0.5, 50.0);
        m.x_axis.z = 0.05;
        m
    };
    vec![
        ("perspective", directx::perspective(0.8, 1.5, 0.1, 100.0), DepthRange::ZERO_TO_ONE),
        ("far", directx::perspective(0.8, 1.5, 0.01, 1e5), DepthRange::ZERO_TO_ONE),
        ("OpenGL", opengl::perspective(0.8, 1.5, 0.1, 100.0), DepthRange::MINUS_ONE_TO_ONE),
        ("infinite", directx::perspective_infinite_reverse(0.8, 1.5, 0.1), DepthRange::REVERSED),
        (
            "orthographic",
            directx::orthographic(-3.0, 3.0, -2.0, 2.0, 0.1, 50.0),
            DepthRange::ZERO_TO_ONE,
        ),
        ("off axis", directx::frustum(-0.02, 0.1, -0.05, 0.03, 0.1, 80.0), DepthRange::ZERO_TO_ONE),
        ("oblique", oblique, DepthRange::ZERO_TO_ONE),
    ]
}

/// Where the matrices put a point, in `f64`: film coordinates and window depth.
fn projected(clip: DMat4, depth: DepthRange, point: DVec3, size: (u32, u32)) -> DVec3 {
    let DVec4 { x, y, z, w } = clip * point.extend(1.0);
    let (near, far) = (f64::from(depth.near), f64::from(depth.far));
    let window = (z / w - near.min(far)) / (near - far).abs();
    let film = |v: f64, n: u32| (v / w + 1.0) * 0.5 * f64::from(n);
    DVec3::new(film(x, size.0), film(y, size.1), window)
}

/// A point along a ray is projected to the pixel that the ray is of, and its depth is that of
/// `f64`.
#[test]
fn matrices_agree_with_rasterisers() -> Result<(), CameraError> {
    let view = look_at_mat4(EYE, CENTER, Vec3::Y);
    let size = (96, 64);
    for (name, proj, depth) in projections() {
        let clip = proj.as_dmat4() * view.as_dmat4();
        let rays: MatrixRays = Matrix::new(view, proj, depth)?.begin_frame(size.0, size.1);
        let mut worst = [0.0f64; 3];
        for (x, y, u) in points(size.0, size.1) {
            let ray = rays.primary_ray(x, y);
            let start = projected(clip, depth, ray.origin.as_dvec3(), size);
            let near_is_one = depth.near > depth.far;
            assert!((start.z - f64::from(u8::from(near_is_one))).abs() < 1e-4, "{name}: {start}");
            for t in [0.5, 1.0 + 8.0 * u.x, 20.0 * u.y + 3.0] {
                let point = ray.at(t);
                let expected = projected(clip, depth, point.as_dvec3(), size);
                let off_film =
                    (expected.x - f64::from(x)).abs().max((expected.y - f64::from(y)).abs());
                let off_depth = (f64::from(rays.window_depth(point)) - expected.z).abs();
                // The way back from a depth leads to a point of that depth.
                let found = rays.distance_at_depth(ray, expected.z as f32);
                let there = projected(clip, depth, ray.at(found).as_dvec3(), size).z;
                let off_way = (there - expected.z).abs();
                worst = [worst[0].max(off_film), worst[1].max(off_depth), worst[2].max(off_way)];
            }
            if ray.t_max < 1e30 {
                let end = projected(clip, depth, ray.at(ray.t_max).as_dvec3(), size);
                assert!((end.z - 1.0).abs() < 1e-5, "{name}: ends at {end}");
            } else {
                // A tilted far plane does not cross every ray.
                assert!(["infinite", "oblique"].contains(&name), "{name}: {ray:?}");
            }
        }
        let [film, depth, way] = worst;
        println!("{name}: off by {film:.1e} pixels, depth by {depth:.1e}, and back {way:.1e}");
        assert!(film < 1e-3 && depth < 1e-6 && way < 1e-6, "{name}: {worst:?}");
    }
    Ok(())
}

/// Depths are the same in every variant, to within rounding.
#[test]
fn depths_agree() -> Result<(), CameraError> {
    let view = look_at_mat4(EYE, CENTER, Vec3::Y);
    let proj = directx::perspective(0.8, 1.5, 0.1, 100.0);
    let rays = Matrix::new(view, proj, DepthRange::ZERO_TO_ONE)?.begin_frame(96, 64);
    let kernel = kernel!(|x: f32, y: f32, u: Vec2| {
        let ray = rays.primary_ray(x, y);
        rays.window_depth(ray.at(2.0 + 20.0 * u.x))
    });
    let inputs = points(96, 64);
    let expected: Vec<f32> = inputs.iter().map(|a| kernel.call(*a)).collect();
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        let found = raydsl::testing::run(&kernel, variant, &inputs);
        compare(variant.name(), &expected, &found).assert_same(|i| format!("{:?}", inputs[i]));
    }
    // 1e-6 of a depth between 0.5 and 1.
    wgsl_agrees("window depth", &kernel, &inputs, &expected, Wgsl::Ulps(16));
    Ok(())
}

#[test]
fn distances_at_depths_agree() -> Result<(), CameraError> {
    let view = look_at_mat4(EYE, CENTER, Vec3::Y);
    let proj = directx::perspective(0.8, 1.5, 0.1, 100.0);
    let rays = Matrix::new(view, proj, DepthRange::ZERO_TO_ONE)?.begin_frame(96, 64);
    let kernel = kernel!(|x: f32, y: f32, u: Vec2| {
        rays.distance_at_depth(rays.primary_ray(x, y), 0.9 * u.x)
    });
    let inputs = points(96, 64);
    let expected: Vec<f32> = inputs.iter().map(|a| kernel.call(*a)).collect();
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        let found = raydsl::testing::run(&kernel, variant, &inputs);
        compare(variant.name(), &expected, &found).assert_same(|i| format!("{:?}", inputs[i]));
    }
    // Two products cancel near the near plane, where distances are a small part of both.
    wgsl_agrees("distance at a depth", &kernel, &inputs, &expected, Wgsl::Ulps(4096));
    Ok(())
}

#[test]
fn matrices_that_make_no_camera() {
    let (view, proj) = (Mat4::IDENTITY, directx::perspective(0.8, 1.5, 0.1, 100.0));
    let of = |view, proj, depth| Matrix::new(view, proj, depth).map(|_| ());
    let depth = DepthRange::ZERO_TO_ONE;
    assert_eq!(of(view, proj, depth), Ok(()));
    for bad in [Mat4::ZERO, Mat4::from_scale(vec3(1.0, 0.0, 1.0)), Mat4::from_scale(Vec3::NAN)] {
        assert_eq!(of(bad, proj, depth), Err(CameraError::Singular));
    }
    let flat = DepthRange { near: 0.5, far: 0.5 };
    assert_eq!(of(view, proj, flat), Err(CameraError::NoDepth));
    let nan = DepthRange { near: 0.5, far: f32::NAN };
    assert_eq!(of(view, proj, nan), Err(CameraError::NoDepth));
    // A near plane behind the eye, or a range that does not match the matrix: the planes are mixed
    // up.
    let behind = Mat4::from_cols(proj.x_axis, proj.y_axis, proj.z_axis, -proj.w_axis);
    assert_eq!(of(view, behind, depth), Err(CameraError::NearBehindEye));
}

/// Rays of unit length and no NaN, whatever the view, the film and the field of view.
#[test]
fn input_at_the_ends() {
    let eyes =
        [(EYE, EYE), (EYE, EYE + Vec3::Y), (Vec3::ZERO, vec3(0.0, -2.0, 0.0)), (EYE, CENTER)];
    let films = [(1, 1), (65_535, 1), (1, 65_535), (0, 0), (2, 2)];
    let fields = [179.9f32.to_radians(), 1e-4, 0.0, -1.0, core::f32::consts::PI, 9.0];
    for (eye, center) in eyes {
        for fov in fields {
            for (width, height) in films {
                let pinhole = Pinhole::new(eye, center, Vec3::Y, fov);
                let middle = (width as f32 * 0.5, height as f32 * 0.5);
                let corners = [(0.5, 0.5), middle, (width as f32 - 0.5, height as f32 - 0.5)];
                let sharp = pinhole.begin_frame(width, height);
                let lens = ThinLens::new(pinhole, 0.1, 2.0).begin_frame(width, height);
                let stereo = Stereo::new(pinhole, 0.1, 2.0).right().begin_frame(width, height);
                let flat = Orthographic::new(eye, center, Vec3::Y, 2.0).begin_frame(width, height);
                for (x, y) in corners {
                    let u = vec2(0.2, 0.9);
                    let rays = [
                        sharp.primary_ray(x, y),
                        lens.lens_ray(x, y, u),
                        stereo.primary_ray(x, y),
                        flat.primary_ray(x, y),
                    ];
                    for ray in rays {
                        let length = ray.direction.length();
                        assert!(
                            (length - 1.0).abs() < 3e-7 && ray.origin.is_finite(),
                            "{pinhole:?} {width} {height} {ray:?}"
                        );
                    }
                }
            }
        }
    }
    // At 179.9 degrees the edge is that far from the middle.
    let rays =
        Pinhole::new(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 179.9f32.to_radians()).begin_frame(3, 3);
    let angle = f64::from(rays.primary_ray(1.5, 3.0).direction.y)
        .atan2(f64::from(-rays.primary_ray(1.5, 3.0).direction.z));
    assert!((angle.to_degrees() - 89.95).abs() < 1e-4, "{}", angle.to_degrees());
}
