//! Light transport whose results are known in closed form, in every variant.
//!
//! Means of random samples are within 4.5 standard errors of the exact value and 1e-5 of it. What
//! packets return has the bits of the scalar variant (other tests), so the widest packets take most
//! samples.

use std::error::Error;
use std::f32::consts::PI;

use raydsl::bsdf::{Bsdf, BsdfSample, Lambert, Luminous, Material, NO_LIGHT, ThinDielectric};
use raydsl::geometry::Aabb;
use raydsl::integrators::{PathLimits, path, whitted};
use raydsl::light::{
    AnyLight, AreaLight, DirectionalLight, DiskShape, Environment, Light, Lights, PointLight,
    RectangleShape, SphereShape,
};
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::testing::{FilmTest, can_run, run};
use raydsl::{Type, assert_variants_agree, kernel};
use raydsl_tests::scaled;

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive(disk(center, normal, radius))]
struct Plate {
    center: Vec3,
    normal: Vec3,
    radius: f32,
}

macro_rules! surfaces {
    ($($t:ident),+) => {
        $(
            #[kernel]
            impl Surface for $t {
                fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
                    self.surface_point(ray, hit)
                }

                fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
                    Vec3::ONE
                }
            }
        )+
    };
}

surfaces!(Ball, Plate);

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
        (Variant::widest(), scaled(1 << 18), 4),
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

#[kernel]
fn next_3d(sampler: &mut Sampler) -> Vec3 {
    let square = sampler.next_2d();
    vec3(square.x, square.y, sampler.next_1d())
}

/// Irradiance at the origin of a floor, by samples of all lights.
#[track_caller]
fn assert_irradiance<L: Light + Type>(name: &str, lights: &Lights<'_, L>, exact: f64) {
    // In a generic function a kernel cannot capture lights of any type, so the host draws.
    for seed in 0..8 {
        let floor = SurfacePoint { position: Vec3::ZERO, normal: Vec3::Z, error: 1e-6 };
        let values: Vec<f32> = (0..scaled(1 << 17) as u32)
            .map(|i| {
                let mut sampler = sampler_of(i, seed);
                let s = lights.sample(floor, next_3d(&mut sampler));
                if s.pdf > 0.0 { s.light.x * s.wi.z.max(0.0) / s.pdf } else { 0.0 }
            })
            .collect();
        let (mean, error) = mean(&values);
        let off = (mean - exact).abs();
        assert!(off <= 4.5 * error + 1e-5 * exact, "{name}: {mean} +- {error}, exactly {exact}");
    }
}

fn cube() -> Aabb {
    Aabb { min: Vec3::splat(-2.0), max: Vec3::splat(2.0) }
}

/// P-D1, P-D2, P-D3, P-D6: irradiance from a sphere, a square, a triangle, an overcast sky.
#[test]
fn irradiance_is_exact() -> Result<(), Box<dyn Error>> {
    let shape = SphereShape { center: vec3(1.0, 0.0, 2.0), radius: 0.5 };
    let ball =
        [AreaLight::<SphereShape> { shape, radiance: Vec3::splat(10.0), is_two_sided: false }];
    assert_irradiance("sphere", &Lights::new(&ball, cube())?, 1.4049629462081453);

    let (corner, u_edge, v_edge) =
        (vec3(-1.0, -1.0, 1.0), vec3(0.0, 2.0, 0.0), vec3(2.0, 0.0, 0.0));
    let shape = RectangleShape { corner, u_edge, v_edge };
    let square = [AreaLight::<RectangleShape> { shape, radiance: Vec3::ONE, is_two_sided: false }];
    assert_irradiance("square", &Lights::new(&square, cube())?, 1.7408395027342064);

    let (v0, v1, v2) = (vec3(1.0, 0.0, 1.0), vec3(0.0, 1.0, 2.0), vec3(-1.0, -0.5, 1.5));
    let shape = Triangle { v0, v1, v2 };
    let triangle = [AreaLight::<Triangle> { shape, radiance: Vec3::ONE, is_two_sided: true }];
    let lights = Lights::new(&triangle, cube())?;
    assert_irradiance("triangle", &lights, 0.452_401_900_028_853);
    let floor = SurfacePoint { position: Vec3::ZERO, normal: Vec3::Z, error: 1e-6 };
    let pdf = f64::from(lights.sample(floor, Vec3::splat(0.4)).pdf);
    assert!((1.0 / pdf - 0.47970788315405555).abs() < 1e-6, "solid angle {}", 1.0 / pdf);

    // Of a sky of rows, what is between two of them is linear.
    let rows = 256;
    let sky: Vec<Vec3> = (0..rows)
        .map(|i| {
            let cos = (PI * (i as f32 + 0.5) / rows as f32).cos();
            Vec3::splat(if cos > 0.0 { (1.0 + 2.0 * cos) / 3.0 } else { 0.0 })
        })
        .collect();
    let sky = Environment::new(&sky, uvec2(1, rows))?
        .rotated(Mat3::from_rotation_x(std::f32::consts::FRAC_PI_2));
    let none: [PointLight; 0] = [];
    let lights = Lights::new(&none, cube())?.with_environment(&sky);
    for seed in 0..4 {
        let values: Vec<f32> = (0..scaled(1 << 18) as u32)
            .map(|i| {
                let mut sampler = sampler_of(i, seed);
                let s = lights.sample(floor, next_3d(&mut sampler));
                s.light.x * s.wi.z.max(0.0) / s.pdf
            })
            .collect();
        let (mean, error) = mean(&values);
        // The last row above the horizon reaches half a row below.
        let off = (mean - 2.443_460_952_792_061).abs();
        assert!(off < 4.5 * error + 1e-4, "sky: {mean} +- {error}");
    }
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

/// A dome, and a floor under it.
#[derive(Scene)]
struct Dome<'a> {
    dome: &'a [Ball],
    floor: &'a [Plate],
}

const BALL: [Ball; 1] = [Ball { center: Vec3::ZERO, radius: 1.0 }];
const FLOOR: [Plate; 1] = [Plate { center: Vec3::ZERO, normal: Vec3::Z, radius: 1.0 }];

/// What is known of the light along a ray.
struct Known<'a> {
    floor: &'a [Plate],
    lights: &'a [AnyLight],
    sky: &'a Environment,
    /// Albedos of the dome and of the floor.
    albedos: [f32; 2],
    /// The numbers of their lights.
    numbers: [u32; 2],
    bounces: u32,
    ray: Ray,
    exact: f64,
}

/// One kernel for all cases: each of its own takes rustc half a minute.
#[track_caller]
fn assert_known(name: &str, known: &Known<'_>) {
    let &Known { floor, lights: list, sky, albedos, numbers, bounces, ray, exact } = known;
    let scene = Dome { dome: &BALL, floor };
    let lights = Lights::new(list, cube()).expect("finite powers").with_environment(sky);
    let limits = PathLimits::new(bounces);
    let kernel = kernel!(|i: u32, seed: u32| {
        let surface = |hit: Hit, _point: ShadingPoint| {
            let is_dome = hit.inst_id == 0;
            let color = Vec3::splat(if is_dome { albedos[0] } else { albedos[1] });
            let light = if is_dome { numbers[0] } else { numbers[1] };
            Luminous::<Lambert> { bsdf: Lambert { color }, light }
        };
        let sampler = sampler_of(i, seed);
        path::<_, _, Luminous<Lambert>>(&scene, surface, &lights, limits, ray, sampler).color.x
    });
    assert_mean(name, &kernel, exact);
}

/// P-GI1 to P-GI5: a convex body in a white furnace, of albedo 0.75, and of albedo 1, which is not
/// seen at all; inside a sphere that shines, up to a number of bounces; a point light in the middle of
/// a sphere; a floor that shines under a dome.
#[test]
fn light_that_is_scattered_many_times_is_exact() {
    let white = Environment::constant(Vec3::ONE).expect("radiance");
    let black = Environment::constant(Vec3::ZERO).expect("radiance");
    let outside = Ray::new(vec3(0.3, 0.2, 3.0), -Vec3::Z);
    let inside = Ray::new(vec3(0.1, 0.2, 0.0), vec3(0.0, 0.6, 0.8));
    let sphere = |emission| {
        let shape = SphereShape { center: Vec3::ZERO, radius: 1.0 };
        let radiance = Vec3::splat(emission);
        AnyLight::Sphere(AreaLight::<SphereShape> { shape, radiance, is_two_sided: true })
    };
    let lamp = PointLight { position: Vec3::ZERO, intensity: Vec3::splat(PI) };
    let shape = DiskShape { center: Vec3::ZERO, normal: Vec3::Z, radius: 1.0 };
    let shining = AreaLight::<DiskShape> { shape, radiance: Vec3::ONE, is_two_sided: false };
    let dark = [NO_LIGHT; 2];
    let furnace = |albedo: f32, bounces| Known {
        floor: &[],
        lights: &[],
        sky: &white,
        albedos: [albedo; 2],
        numbers: dark,
        bounces,
        ray: outside,
        exact: albedo.into(),
    };
    assert_known("furnace", &furnace(0.75, 2));
    assert_known("furnace", &furnace(1.0, 64));
    let cases = [
        (0.5, 0.5, 64, 1.0),
        (1.0, 0.8, 0, 1.0),
        (1.0, 0.8, 1, 1.8),
        (1.0, 0.8, 2, 2.44),
        (1.0, 0.8, 8, 4.32891136),
    ];
    for (emission, albedo, bounces, exact) in cases {
        let (lights, numbers) = (&[sphere(emission)], [0, NO_LIGHT]);
        let known =
            Known { lights, numbers, ray: inside, sky: &black, exact, ..furnace(albedo, bounces) };
        assert_known("inside a sphere", &known);
    }
    let lights = &[AnyLight::Point(lamp)];
    let known = Known { lights, ray: inside, sky: &black, exact: 1.0, ..furnace(0.5, 64) };
    assert_known("point in a sphere", &known);
    for (direction, exact) in [(-Vec3::Z, 1.1926605504587156), (Vec3::Z, 0.642_201_834_862_385_3)] {
        let known = Known {
            floor: &FLOOR,
            lights: &[AnyLight::Disk(shining)],
            sky: &black,
            albedos: [0.7, 0.3],
            numbers: [NO_LIGHT, 0],
            bounces: 64,
            ray: Ray::new(vec3(0.1, 0.2, 0.5), direction),
            exact,
        };
        assert_known("dome", &known);
    }
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
