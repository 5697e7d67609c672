//! Light transport whose results are known in closed form, in every variant.
//!
//! Means of random samples are within 4.5 standard errors of the exact value and 1e-5 of it. What
//! packets return has the bits of the scalar variant (other tests), so the widest packets take most
//! samples.

use std::error::Error;
use std::f32::consts::PI;

use raydsl::bsdf::{Bsdf, BsdfSample, Lambert, Material, ThinDielectric};
use raydsl::integrators::{
    LightSampling, PathLimits, PathOptions, next_3d, path, path_with, volume_path, whitted,
};
use raydsl::light::{
    AnyLight, DirectionalLight, DiskShape, Environment, Lights, PointLight, RectangleShape,
    SphereShape, SpotLight,
};
use raydsl::prelude::*;
use raydsl::testing::{FilmTest, can_run, run};
use raydsl::volume::{Collision, ExactCell, Volume, VolumeLight, collision, ratio_transmittance};
use raydsl::{Type, assert_variants_agree, kernel};
use raydsl_tests::scaled;
use raydsl_tests::transport::{
    BALL, Ball, Dome, FLOOR, Paint, Plate, area, cube, medium, murk, paint, shining_sphere,
};

/// A mean and its standard error.
fn mean(values: &[f32]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().map(|v| f64::from(*v)).sum::<f64>() / n;
    let squares = values.iter().map(|v| (f64::from(*v) - mean).powi(2)).sum::<f64>();
    (mean, (squares / n / n).sqrt())
}

/// Runs a kernel of a number and a seed, and compares its mean.
#[track_caller]
fn assert_mean(name: &str, kernel: &Kernel<'_, (u32, u32), f32>, exact: f64) {
    for (variant, count, seeds) in [
        (Variant::widest(), scaled(1 << 16), 4),
        (Variant::Scalar, scaled(1 << 14), 1),
        (Variant::Wgsl, scaled(1 << 14), 1),
    ] {
        if variant == Variant::Wgsl && !can_run(variant, name) {
            continue;
        }
        for seed in 0..seeds {
            let inputs: Vec<(u32, u32)> = (0..count as u32).map(|i| (i, seed)).collect();
            let (mean, error) = mean(&run(kernel, variant, &inputs));
            let allowed = 4.5 * error + 1e-5 * exact;
            let off = (mean - exact).abs();
            assert!(off <= allowed, "{name} {variant:?}: {mean} +- {error}, exactly {exact}");
        }
    }
}

#[kernel]
fn sampler_of(i: u32, seed: u32) -> Sampler {
    Sampler::new(uvec2(i, seed), 7, 0, 1, SampleMethod::Random)
}

/// Irradiance at the origin of a floor, by samples of all lights.
#[track_caller]
fn assert_irradiance(name: &str, lights: &Lights<'_, AnyLight>, exact: f64) {
    let kernel = kernel!(|i: u32, seed: u32| {
        let mut sampler = sampler_of(i, seed);
        let up = vec3(0.0, 0.0, 1.0);
        let floor = SurfacePoint { position: vec3(0.0, 0.0, 0.0), normal: up, error: 1e-6 };
        let s = lights.sample(floor, next_3d(&mut sampler));
        if s.pdf > 0.0 { s.light.x * max(s.wi.z, 0.0) / s.pdf } else { 0.0 }
    });
    assert_mean(name, &kernel, exact);
}

/// P-D1, P-D2, P-D3, P-D6: irradiance from a sphere, a square, a triangle, an overcast sky; and from
/// a sun with an angle, and from a spot light where its light falls off.
#[test]
fn irradiance_is_exact() -> Result<(), Box<dyn Error>> {
    let sphere = SphereShape { center: vec3(1.0, 0.0, 2.0), radius: 0.5 };
    let (corner, u_edge, v_edge) =
        (vec3(-1.0, -1.0, 1.0), vec3(0.0, 2.0, 0.0), vec3(2.0, 0.0, 0.0));
    let square = RectangleShape { corner, u_edge, v_edge };
    let (v0, v1, v2) = (vec3(1.0, 0.0, 1.0), vec3(0.0, 1.0, 2.0), vec3(-1.0, -0.5, 1.5));
    let triangle = area(Triangle { v0, v1, v2 }, 1.0, true);
    let direction = vec3(0.6, 0.0, 0.8);
    let sun = DirectionalLight { direction, irradiance: Vec3::splat(2.0), sine: 0.3 };
    // Where the cosine is half way between those of the cones, the square of a half is left.
    let (cos_inner, cos_outer) = (0.9, 0.7);
    let spot = SpotLight {
        position: vec3(0.0, 0.0, 2.0),
        intensity: Vec3::splat(3.0),
        direction: vec3(0.6, 0.0, -0.8),
        cos_inner,
        cos_outer,
    };
    let cases = [
        ("sphere", AnyLight::Sphere(area(sphere, 10.0, false)), 1.4049629462081453),
        ("square", AnyLight::Rectangle(area(square, 1.0, false)), 1.7408395027342064),
        ("triangle", AnyLight::Triangle(triangle), 0.452_401_900_028_853),
        ("sun", AnyLight::Directional(sun), 1.6),
        ("spot", AnyLight::Spot(spot), 3.0 / 4.0 * 0.25),
    ];
    for (name, light, exact) in cases {
        let list = [light];
        assert_irradiance(name, &Lights::new(&list, cube())?, exact);
    }
    let list = [AnyLight::Triangle(triangle)];
    let lights = Lights::new(&list, cube())?;
    let floor = SurfacePoint { position: Vec3::ZERO, normal: Vec3::Z, error: 1e-6 };
    let pdf = f64::from(lights.sample(floor, Vec3::splat(0.4)).pdf);
    assert!((1.0 / pdf - 0.47970788315405555).abs() < 1e-6, "solid angle {}", 1.0 / pdf);

    // Of a sky of rows, what is between two of them is linear, and the last row above the horizon
    // reaches half a row below: of so many rows 1e-5 of the whole.
    let rows = 2048;
    let sky: Vec<Vec3> = (0..rows)
        .map(|i| {
            let cos = (PI * (i as f32 + 0.5) / rows as f32).cos();
            Vec3::splat(if cos > 0.0 { (1.0 + 2.0 * cos) / 3.0 } else { 0.0 })
        })
        .collect();
    let sky = Environment::new(&sky, uvec2(1, rows))?
        .rotated(Mat3::from_rotation_x(std::f32::consts::FRAC_PI_2));
    let lights = Lights::new(&[], cube())?.with_environment(&sky);
    assert_irradiance("sky", &lights, 2.443_460_952_792_061);
    Ok(())
}

/// P-D4: the mean irradiance of a square under a point light.
#[test]
fn point_light_over_a_square() -> Result<(), Box<dyn Error>> {
    let lamp = [PointLight { position: vec3(0.0, 0.0, 1.5), intensity: Vec3::ONE }];
    let lights = Lights::new(&lamp, cube())?;
    let kernel = kernel!(|i: u32, seed: u32| {
        let mut sampler = sampler_of(i, seed);
        let u = sampler.next_2d();
        let position = vec3(2.0 * u.x - 1.0, 2.0 * u.y - 1.0, 0.0);
        let point = SurfacePoint { position, normal: vec3(0.0, 0.0, 1.0), error: 1e-6 };
        let light = lights.sample(point, next_3d(&mut sampler));
        light.light.x * light.wi.z
    });
    assert_mean("point over square", &kernel, 0.312_766_721_941_545);
    Ok(())
}

/// What is known of the light along a ray.
#[derive(Clone, Copy)]
struct Known<'a> {
    dome: &'a [Ball],
    floor: &'a [Plate],
    lights: &'a [AnyLight],
    sky: &'a Environment,
    /// Materials of the dome and of the floor.
    paints: [Paint; 2],
    bounces: u32,
    ray: Ray,
    exact: f64,
    options: PathOptions,
}

/// One kernel for all cases: each of its own takes rustc half a minute.
#[track_caller]
fn assert_known(name: &str, known: &Known<'_>) {
    let &Known { dome, floor, lights: list, sky, paints, bounces, ray, exact, options } = known;
    let scene = Dome { dome, floor };
    let lights = Lights::new(list, cube()).expect("finite powers").with_environment(sky);
    // Roulette from the first bounce on, the usual one, one that never begins, and none.
    let some: Vec<(u32, u32)> = (0..500).map(|i| (i, 9)).collect();
    let mut last = Vec::new();
    for (roulette, without_roulette) in [(0, false), (3, false), (u32::MAX, false), (0, true)] {
        let limits = PathLimits { bounces, roulette };
        let options = PathOptions { without_roulette, ..options };
        let kernel = kernel!(|i: u32, seed: u32| {
            let surface = |hit: Hit, _point: ShadingPoint| {
                if hit.inst_id == 0 { paints[0] } else { paints[1] }
            };
            let sampler = sampler_of(i, seed);
            path_with::<_, _, Paint>(&scene, surface, &lights, host(options), limits, ray, sampler)
                .color
                .x
        });
        if without_roulette {
            // Each path is that of roulette that never begins.
            assert_eq!(run(&kernel, Variant::widest(), &some), last, "{name}, {options:?}");
            continue;
        }
        last = run(&kernel, Variant::widest(), &some);
        assert_mean(&format!("{name}, roulette {roulette}, {options:?}"), &kernel, exact);
    }
}

/// P-GI1 to P-GI5: a convex body in a white furnace, of albedo 0.75, and of albedo 1, which is not
/// seen at all; inside a sphere that shines, up to a number of bounces; a point light in the middle of
/// a sphere; a floor that shines under a dome. Inside the sphere all BSDFs of an albedo are alike.
#[test]
fn light_that_is_scattered_many_times_is_exact() {
    let white = Environment::constant(Vec3::ONE).expect("radiance");
    let black = Environment::constant(Vec3::ZERO).expect("radiance");
    let outside = Ray::new(vec3(0.3, 0.2, 3.0), -Vec3::Z);
    let inside = Ray::new(vec3(0.1, 0.2, 0.0), vec3(0.0, 0.6, 0.8));
    let furnace = |albedo: f32, bounces| Known {
        dome: &BALL,
        floor: &[],
        lights: &[],
        sky: &white,
        paints: [paint(albedo); 2],
        bounces,
        ray: outside,
        exact: albedo.into(),
        options: PathOptions::new(),
    };
    assert_known("furnace", &furnace(0.75, 2));
    assert_known("furnace", &furnace(1.0, 64));
    let (lights_alone, hits_alone) = (LightSampling::LightsAlone, LightSampling::HitsAlone);
    for lights in [lights_alone, hits_alone] {
        let options = PathOptions { lights, ..PathOptions::new() };
        assert_known("furnace", &Known { options, ..furnace(0.75, 2) });
    }
    let cases = [
        (0.5, 0.5, 0.0, 64, 1.0),
        (0.5, 0.5, 0.4, 64, 1.0),
        (1.0, 0.8, 0.0, 0, 1.0),
        (1.0, 0.8, 0.0, 1, 1.8),
        (1.0, 0.8, 0.5, 2, 2.44),
        (1.0, 0.8, 0.0, 8, 4.32891136),
    ];
    for (emission, albedo, mirrored, bounces, exact) in cases {
        let paints = [Paint { mirrored, light: 0, ..paint(albedo) }; 2];
        let lights = &[shining_sphere(emission)];
        let known =
            Known { lights, paints, ray: inside, sky: &black, exact, ..furnace(albedo, bounces) };
        assert_known("inside a sphere", &known);
    }
    let lamp = PointLight { position: Vec3::ZERO, intensity: Vec3::splat(PI) };
    let lights = &[AnyLight::Point(lamp)];
    let known = Known { lights, ray: inside, sky: &black, exact: 1.0, ..furnace(0.5, 64) };
    assert_known("point in a sphere", &known);
    let shape = DiskShape { center: Vec3::ZERO, normal: Vec3::Z, radius: 1.0 };
    let shining = AnyLight::Disk(area(shape, 1.0, false));
    for (direction, exact) in [(-Vec3::Z, 1.1926605504587156), (Vec3::Z, 0.642_201_834_862_385_3)] {
        let known = Known {
            floor: &FLOOR,
            lights: &[shining],
            sky: &black,
            paints: [paint(0.7), Paint { light: 0, ..paint(0.3) }],
            ray: Ray::new(vec3(0.1, 0.2, 0.5), direction),
            exact,
            ..furnace(0.0, 64)
        };
        assert_known("dome", &known);
    }
}

/// A ball of opacity 0.3 around a floor, between it, the sun and the eye; then two plates.
#[test]
fn masks_let_their_share_pass() {
    let black = Environment::constant(Vec3::ZERO).expect("radiance");
    let sun = DirectionalLight { direction: Vec3::Z, irradiance: Vec3::splat(PI), sine: 0.0 };
    let veil = Paint { opacity: 0.3, ..paint(0.0) };
    let known = Known {
        dome: &BALL,
        floor: &FLOOR,
        lights: &[AnyLight::Directional(sun)],
        sky: &black,
        paints: [veil, paint(0.5)],
        bounces: 1,
        ray: Ray::new(vec3(0.1, 0.2, 3.0), -Vec3::Z),
        exact: 0.5 * 0.7 * 0.7,
        options: PathOptions { masks: true, ..PathOptions::new() },
    };
    assert_known("veil", &known);
    // Light that the upper plate scatters comes directly; that of the lower one passes it twice.
    let above = Plate { center: Vec3::Z, ..FLOOR[0] };
    let (dome, floor) = (&[][..], &[above, FLOOR[0]]);
    let grey = [Paint { opacity: 0.3, ..paint(0.5) }; 2];
    let exact = 0.5 * (0.3 + 0.7 * 0.3 * 0.7);
    let plates = Known { dome, floor, paints: grey, exact, ..known };
    assert_known("grey veils", &plates);
    // Without the option they are opaque.
    let options = PathOptions::new();
    assert_known("no veils", &Known { exact: 0.5, options, ..plates });
}

/// A flat lamp that shines on both sides does not light itself, although its solid angle, seen from one
/// of its points, is a hemisphere.
#[test]
fn flat_lamps_do_not_light_themselves() {
    let black = Environment::constant(Vec3::ZERO).expect("radiance");
    for tilt in [Mat3::IDENTITY, Mat3::from_rotation_x(0.7) * Mat3::from_rotation_y(0.3)] {
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| tilt * axis);
        let plate = [Plate { center: Vec3::ZERO, normal: z, radius: 1.0 }];
        let rectangle = RectangleShape { corner: -x - y, u_edge: x * 2.0, v_edge: y * 2.0 };
        let triangle = Triangle { v0: -x * 4.0 - y, v1: x * 4.0 - y, v2: y * 3.0 };
        for lamp in [
            AnyLight::Rectangle(area(rectangle, 1.0, true)),
            AnyLight::Triangle(area(triangle, 1.0, true)),
        ] {
            let known = Known {
                dome: &[],
                floor: &plate,
                lights: &[lamp],
                sky: &black,
                paints: [Paint { light: 0, ..paint(0.5) }; 2],
                bounces: 1,
                ray: Ray::new(z * 3.0 + x * 0.1 + y * 0.2, -z),
                exact: 1.0,
                options: PathOptions::new(),
            };
            assert_known("a lamp alone", &known);
        }
    }
}

/// A path whose light is not a number ends by roulette alone.
#[test]
fn paths_of_no_number_end() {
    let black = Environment::constant(Vec3::ZERO).expect("radiance");
    let list: [AnyLight; 0] = [];
    let lights = Lights::new(&list, cube()).expect("no lights").with_environment(&black);
    let scene = Dome { dome: &BALL, floor: &[] };
    let limits = PathLimits { bounces: u32::MAX, roulette: 0 };
    let paint = paint(f32::NAN);
    let surface = |_: Hit, _: ShadingPoint| paint;
    for seed in 0..100 {
        let ray = Ray::new(vec3(0.1, 0.2, 0.0), vec3(0.0, 0.6, 0.8));
        let sampler = sampler_of(seed, 1);
        let sample = path::<_, _, Paint>(&scene, surface, &lights, limits, ray, sampler);
        assert!(sample.color.w == 1.0);
    }
}

/// A medium in the dome, whose extinction differs from place to place.
struct InMedium<'a> {
    name: &'a str,
    lights: &'a [AnyLight],
    paint: Paint,
    /// Whether the medium emits its colour, or scatters it.
    emits: bool,
    albedo: f32,
    anisotropy: f32,
    limits: PathLimits,
    options: PathOptions,
    exact: f64,
}

/// Its direction is three units long.
const MEDIUM_RAY: Ray = Ray::new(vec3(0.1, 0.2, 0.0), vec3(0.0, 1.8, 2.4));

#[track_caller]
fn assert_in_medium(case: &InMedium<'_>, voxels: &[f32]) -> Result<(), Box<dyn Error>> {
    let &InMedium { lights: list, paint, emits, anisotropy, limits, options, .. } = case;
    let grid = medium(voxels)?;
    let murk = Volume::new(&grid, murk(case.albedo)?);
    let lights = Lights::new(list, cube())?;
    let dome = &BALL[..];
    let ray = MEDIUM_RAY;
    let some: Vec<(u32, u32)> = (0..300).map(|i| (i, 9)).collect();
    let mut last = Vec::new();
    // The roulette of the case, one that never begins, and none.
    for (roulette, without_roulette) in [(limits.roulette, false), (u32::MAX, false), (0, true)] {
        let limits = PathLimits { roulette, ..limits };
        let options = PathOptions { without_roulette, ..options };
        let kernel = kernel!(|i: u32, seed: u32| {
            volume_path::<_, _, Paint>(
                dome,
                |_hit: Hit, _point: ShadingPoint| paint,
                |ray: Ray, rng: Rng| {
                    let mut rng = rng;
                    let met = collision(&murk, anisotropy, ray, &mut rng);
                    let none = vec3(0.0, 0.0, 0.0);
                    let emission = if emits { met.albedo } else { none };
                    Collision { emission, albedo: if emits { none } else { met.albedo }, ..met }
                },
                |ray: Ray, rng: Rng| {
                    let mut rng = rng;
                    ratio_transmittance(&murk, ray, &mut rng)
                },
                &lights,
                host(options),
                limits,
                ray,
                sampler_of(i, seed),
            )
            .color
            .x
        });
        if without_roulette {
            // Each path is that of roulette that never begins.
            assert_eq!(run(&kernel, Variant::widest(), &some), last, "{}, {options:?}", case.name);
        } else if roulette == u32::MAX {
            last = run(&kernel, Variant::widest(), &some);
        } else {
            assert_mean(case.name, &kernel, case.exact);
        }
    }
    Ok(())
}

/// In a cavity whose walls shine, a medium that absorbs nothing is not seen; one that only absorbs, or
/// emits besides, is as the integrals along the ray say; and light of a lamp that is scattered once is
/// as a sum over the ray says.
#[test]
fn light_in_media_is_exact() -> Result<(), Box<dyn Error>> {
    let mut rng = Rng::new(uvec2(3, 5), 0, 1);
    let uneven: Vec<f32> = (0..27).map(|_| rng.next_f32()).collect();
    let walls = Paint { light: 0, ..paint(0.5) };
    let lights = &[shining_sphere(0.5)];
    let case = InMedium {
        name: "cavity",
        lights,
        paint: walls,
        emits: false,
        albedo: 1.0,
        anisotropy: 0.6,
        limits: PathLimits { bounces: 400, roulette: 3 },
        options: PathOptions::new(),
        exact: 1.0,
    };
    for lights in [LightSampling::Weighted, LightSampling::LightsAlone, LightSampling::HitsAlone] {
        let options = PathOptions { lights, ..PathOptions::new() };
        assert_in_medium(&InMedium { options, ..case }, &uneven)?;
    }

    // Black walls behind: the integral of what is absorbed and emitted.
    let grid = medium(&uneven)?;
    let to_wall = MEDIUM_RAY.with_range(0.0, 1.0);
    let hit = BALL[..].closest_hit(MEDIUM_RAY);
    let light = Volume::new(&grid, murk(0.4)?).integrate(
        &ExactCell::new(),
        to_wall.with_range(0.0, hit.t),
        VolumeLight::new(),
    );
    let black = Paint { light: 0, ..paint(0.0) };
    let exact = f64::from(light.over(Vec3::splat(0.5)).x);
    let limits = PathLimits::new(4);
    let glowing =
        InMedium { name: "glow", paint: black, emits: true, albedo: 0.4, limits, exact, ..case };
    assert_in_medium(&glowing, &uneven)?;

    // Scattered once, of a lamp in the middle, with the phase function of the angle.
    let even = [0.5; 27];
    let (extinction, albedo, g, steps) = (1.6, 0.7, 0.6, 20_000);
    let origin = MEDIUM_RAY.origin.as_dvec3();
    let way = MEDIUM_RAY.direction.as_dvec3().normalize();
    let length = 3.0 * f64::from(hit.t);
    let once = |k: i32| {
        let t = (f64::from(k) + 0.5) / f64::from(steps) * length;
        let p = origin + way * t;
        let cos = way.dot(-p) / p.length();
        let phase =
            (1.0 - g * g) / (4.0 * std::f64::consts::PI) / (1.0 + g * g - 2.0 * g * cos).powf(1.5);
        extinction * albedo * phase * (-extinction * (t + p.length())).exp() / p.length_squared()
    };
    let exact = (0..steps).map(once).sum::<f64>() * length / f64::from(steps);
    let lamp = PointLight { position: Vec3::ZERO, intensity: Vec3::ONE };
    let lit = InMedium {
        name: "lamp",
        lights: &[AnyLight::Point(lamp)],
        paint: paint(0.0),
        emits: false,
        albedo: 0.7,
        anisotropy: 0.6,
        limits: PathLimits::new(1),
        options: PathOptions::new(),
        exact,
    };
    assert_in_medium(&lit, &even)
}

/// Light passes a pane of glass twice: what both sides reflect does not arrive.
#[test]
fn whitted_sees_through_glass() -> Result<(), Box<dyn Error>> {
    let plates = [
        Plate { center: vec3(0.0, 0.0, 1.0), normal: Vec3::Z, radius: 1.0 },
        Plate { center: Vec3::ZERO, normal: Vec3::Z, radius: 1.0 },
    ];
    let scene = Bvh::build(&plates)?;
    let direction = Vec3::Z;
    let sun = DirectionalLight { direction, irradiance: Vec3::splat(PI), sine: 0.0 };
    let list = [AnyLight::Directional(sun)];
    let lights = Lights::new(&list, scene.bounds())?;
    let (shadows, bounces) = (false, 4);
    let kernel = kernel!(|i: u32, seed: u32| {
        let surface = |hit: Hit, _point: ShadingPoint| {
            let is_glass = hit.prim_id == 0;
            Pane { paint: Lambert { color: Vec3::splat(0.5) }, is_glass }
        };
        let ray = Ray::new(vec3(0.1, 0.2, 3.0), -Vec3::Z);
        let sampler = sampler_of(i, seed);
        whitted::<_, _, Pane>(&scene, surface, &lights, host(shadows), host(bounces), ray, sampler)
            .x
    });
    // 0.04 a side, and what is reflected between them: 2 F / (1 + F).
    assert_mean("pane", &kernel, 0.5 * (1.0 - 0.08 / 1.04));
    Ok(())
}

/// Paint, or glass: a material of a user, of two kinds.
#[derive(Clone, Copy, Type)]
struct Pane {
    paint: Lambert,
    is_glass: bool,
}

#[kernel]
impl Bsdf for Pane {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        if self.is_glass { Vec3::ZERO } else { Lambert::eval(&self.paint, wo, wi) }
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let glass = ThinDielectric { ior: 1.5, alpha: 0.0, tint: Vec3::ONE };
        if self.is_glass {
            ThinDielectric::sample(&glass, wo, u)
        } else {
            Lambert::sample(&self.paint, wo, u)
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if self.is_glass { 0.0 } else { Lambert::pdf(&self.paint, wo, wi) }
    }
}

#[kernel]
impl Material for Pane {}

/// WGSL has no trace of kinds of lights and of materials that do not occur, nor of an environment.
#[test]
fn what_does_not_occur_leaves_no_trace() -> Result<(), Box<dyn Error>> {
    let balls = [Ball { center: Vec3::ZERO, radius: 1.0 }];
    let scene = Bvh::build(&balls)?;
    let point = PointLight { position: Vec3::Z * 3.0, intensity: Vec3::ONE };
    let sun = DirectionalLight { direction: Vec3::Z, irradiance: Vec3::ONE, sine: 0.1 };
    let text = |list: &[AnyLight], sky: Option<&Environment>| -> Result<String, Box<dyn Error>> {
        let lights = Lights::new(list, scene.bounds())?;
        let lights = match sky {
            Some(sky) => lights.with_environment(sky),
            None => lights,
        };
        let limits = PathLimits::new(2);
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            let surface = |_hit: Hit, _point: ShadingPoint| Lambert { color: Vec3::ONE };
            path::<_, _, Lambert>(&scene, surface, &lights, limits, ray, sampler).color
        });
        // Pictures have the same bytes for any number of threads, and the same means on a device.
        let camera = Pinhole::new(vec3(0.0, 1.0, 4.0), Vec3::ZERO, Vec3::Y, 0.7);
        assert_variants_agree!(&kernel, &FilmTest::new(&camera, 16, 16));
        let mut films = Vec::new();
        for threads in [1, 2, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
            let mut film = Film::new(33, 17);
            let scheduler = TiledScheduler::new();
            pool.install(|| {
                scheduler.accumulate(&camera, &kernel, &Sampling::new(4), &mut film, 4);
            });
            films.push(film);
        }
        assert!(films[0] == films[1] && films[0] == films[2]);
        Ok(kernel.wgsl())
    };
    let plain = text(&[AnyLight::Point(point)], None)?;
    let sunny = text(&[AnyLight::Point(point), AnyLight::Directional(sun)], None)?;
    let sky = Environment::new(&[Vec3::ONE, Vec3::ZERO], uvec2(1, 2))?;
    let bright = text(&[AnyLight::Point(point)], Some(&sky))?;
    for word in ["sample_cone", "spherical_triangle", "texels"] {
        assert!(!plain.contains(word), "{word}: {plain}");
    }
    assert!(sunny.contains("sample_cone") && !sunny.contains("spherical_triangle"), "{sunny}");
    assert!(bright.contains("texels"), "{bright}");
    // Another light of a kind that occurs is the same program.
    assert_eq!(plain, text(&[AnyLight::Point(point); 3], None)?);
    Ok(())
}
