//! Every light of the library through its check.

use std::f32::consts::FRAC_PI_2;

use raydsl::bsdf::{Bsdf, Conductor, F82, Lambert};
use raydsl::geometry::{Aabb, tube};
use raydsl::kernel;
use raydsl::light::{
    AnyLight, AreaLight, DirectionalLight, DiskShape, Environment, EnvironmentError, Light,
    LightExtent, LightShape, Lights, LightsError, PointLight, RectangleShape, ShapeSample,
    SphereShape, SpotLight, area_pdf, sample_by_area,
};
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::testing::check::{EstimatorsTest, LightTest};
use raydsl_tests::rng::Rng as Random;
use raydsl_tests::scaled;

/// A fifth of the usual samples, since numeric code is hardly optimised in tests: all of them with
/// `RAYDSL_TEST_SHARE=5`.
fn test() -> LightTest {
    LightTest::new().samples(scaled(200_000) as u32, 4).of(20).explained()
}

/// Shapes of lights as primitives, for rays to meet.
#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive(rectangle(corner, u_edge, v_edge))]
struct Panel {
    corner: Vec3,
    u_edge: Vec3,
    v_edge: Vec3,
}

#[primitive(disk(center, normal, radius))]
struct Plate {
    center: Vec3,
    normal: Vec3,
    radius: f32,
}

/// A shape of a user.
#[primitive(tube(p0, p1, radius))]
struct Neon {
    p0: Vec3,
    p1: Vec3,
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
                    Vec3::ZERO
                }
            }
        )+
    };
}

surfaces!(Ball, Panel, Plate, Neon);

#[kernel]
impl LightShape for Neon {
    fn sample_from(&self, from: Vec3, u: Vec2) -> ShapeSample {
        sample_by_area(tube::sample(u, self.p0, self.p1, self.radius), self.surface_area(), from)
    }

    fn pdf_from(&self, from: Vec3, at: SurfacePoint) -> f32 {
        area_pdf(at, self.surface_area(), from)
    }

    fn surface_area(&self) -> f32 {
        tube::area(self.p0, self.p1, self.radius)
    }

    fn shape_extent(&self) -> LightExtent {
        let r = Vec3::splat(self.radius);
        let (min, max) = (self.p0.min(self.p1) - r, self.p0.max(self.p1) + r);
        let axis = vec3(0.0, 0.0, 1.0);
        LightExtent { min, max, axis, cos_normals: -1.0, cos_emitted: 0.0 }
    }
}

const NOTHING: [Triangle; 0] = [];

#[track_caller]
fn assert_holds<L: Light + Type, S: Scene + ?Sized>(light: L, scene: &S) {
    if let Err(failure) = test().run(light, scene) {
        panic!("{failure}");
    }
}

fn shining<S: LightShape + Type>(shape: S, is_two_sided: bool) -> AreaLight<S> {
    AreaLight::<S> { shape, radiance: vec3(3.0, 2.0, 0.5), is_two_sided }
}

#[test]
fn punctual_lights() {
    let position = vec3(1.0, 2.0, 0.5);
    let intensity = vec3(10.0, 4.0, 0.0);
    assert_holds(PointLight { position, intensity }, &NOTHING[..]);
    let direction = vec3(0.6, 0.0, -0.8);
    let (cos_inner, cos_outer) = (0.9, 0.7);
    let spot = SpotLight { position, intensity, direction, cos_inner, cos_outer };
    assert_holds(spot, &NOTHING[..]);
    assert_holds(SpotLight { cos_outer: 0.9, ..spot }, &NOTHING[..]);
}

#[test]
fn directional_lights() {
    let direction = vec3(0.6, 0.0, 0.8);
    for sine in [0.0, 1e-3, 0.00465, 0.5, 1.0] {
        let sun = DirectionalLight { direction, irradiance: vec3(1.0, 0.5, 2.0), sine };
        assert_holds(sun, &NOTHING[..]);
    }
}

#[test]
fn spheres() {
    for (radius, center) in [(1.0, Vec3::ZERO), (1e-3, vec3(3.0, 0.0, 0.0))] {
        let ball = [Ball { center, radius }];
        assert_holds(shining(SphereShape { center, radius }, false), &ball[..]);
    }
}

/// Spheres that are small from far away shine as brightly as others.
#[test]
fn far_spheres() {
    let mut rng = Random::of("far spheres");
    let center = vec3(2.458_705, 614.6459, 788.7994);
    for radius in [1.0f32, 1e-3, 1e-4, 1e-5] {
        let lamp = shining(SphereShape { center, radius }, false);
        for _ in 0..2000 {
            let sample = lamp.sample(Vec3::ZERO, vec2(rng.unit(), rng.unit()));
            assert!(sample.pdf > 0.0, "{radius}: {sample:?}");
            assert_eq!(sample.light, lamp.radiance, "{radius}: {sample:?}");
        }
    }
}

/// Samples beside black texels are directions too.
#[test]
fn environments_with_black_texels() {
    let sky = Environment::new(&[Vec3::ZERO, Vec3::ONE], uvec2(2, 1)).expect("radiance");
    for u in [vec2(0.0, 0.5), vec2(0.0, 0.0), vec2(0.5, 0.0)] {
        let sample = sky.sample(u);
        assert!((sample.wi.length() - 1.0).abs() < 1e-5 && sample.pdf >= 0.0, "{u}: {sample:?}");
    }
}

#[test]
fn triangles() {
    let (v0, v1, v2) = (vec3(1.0, 0.0, 1.0), vec3(0.0, 1.0, 2.0), vec3(-1.0, -0.5, 1.5));
    let large = Triangle { v0, v1, v2 };
    let small = Triangle { v0, v1: v0 + (v1 - v0) * 1e-3, v2: v0 + (v2 - v0) * 1e-3 };
    let thin = Triangle { v0, v1, v2: v0 + (v1 - v0) * 0.5 + vec3(0.1, 0.1, 0.0) };
    // Next to the point, which sees it nearly all around.
    let (v0, v1, v2) = (vec3(-8.0, -5.0, 1e-3), vec3(8.0, -5.0, 1e-3), vec3(0.0, 9.0, 1e-3));
    let near = Triangle { v0, v1, v2 };
    for shape in [large, small, thin, near] {
        for is_two_sided in [false, true] {
            assert_holds(shining(shape, is_two_sided), &[shape][..]);
        }
    }
}

#[test]
fn rectangles_and_disks() {
    let (corner, u_edge, v_edge) =
        (vec3(0.5, -1.0, 1.25), vec3(1.5, 0.0, 0.0), vec3(0.3, 2.5, 0.0));
    let panel = [Panel { corner, u_edge, v_edge }];
    assert_holds(shining(RectangleShape { corner, u_edge, v_edge }, true), &panel[..]);
    let (corner, u_edge, v_edge) =
        (vec3(-4.0, -6.0, -0.01), vec3(1.0, 9.0, 0.0), vec3(9.0, 0.5, 0.0));
    let near = [Panel { corner, u_edge, v_edge }];
    assert_holds(shining(RectangleShape { corner, u_edge, v_edge }, false), &near[..]);
    let (center, normal, radius) = (vec3(0.0, 0.0, 2.0), vec3(0.0, 0.5, -2.0), 0.75);
    let plate = [Plate { center, normal, radius }];
    assert_holds(shining(DiskShape { center, normal, radius }, false), &plate[..]);
}

/// Nothing shines from them, and all numbers are defined.
#[test]
fn lights_without_area() {
    let p = vec3(1.0, 0.0, 1.0);
    let point = Triangle { v0: p, v1: p, v2: p };
    let line = Triangle { v0: p, v1: p + Vec3::X, v2: p + Vec3::X * 0.5 };
    for shape in [point, line] {
        assert_holds(shining(shape, true), &[shape][..]);
        assert_eq!(shining(shape, true).power(1.0), 0.0);
    }
    assert_holds(shining(SphereShape { center: p, radius: 0.0 }, false), &NOTHING[..]);
    let flat = RectangleShape { corner: p, u_edge: Vec3::X, v_edge: Vec3::X };
    assert_holds(shining(flat, true), &NOTHING[..]);
    assert_holds(
        shining(DiskShape { center: p, normal: Vec3::ZERO, radius: 1.0 }, true),
        &NOTHING[..],
    );
}

/// Of any kind, and of a user's own.
#[test]
fn other_lights() {
    let (v0, v1, v2) = (vec3(1.0, 0.0, 1.0), vec3(0.0, 1.0, 2.0), vec3(-1.0, -0.5, 1.5));
    let shape = Triangle { v0, v1, v2 };
    assert_holds(AnyLight::Triangle(shining(shape, true)), &[shape][..]);
    let neon = Neon { p0: vec3(0.0, 0.0, 1.0), p1: vec3(1.0, 0.5, 1.5), radius: 0.1 };
    // Its front hides its back, which is sampled too: the test of densities takes it without.
    let light = shining(neon, false);
    let sample = light.sample(vec3(0.0, -1.0, 1.0), vec2(0.3, 0.6));
    assert_eq!(sample.pdf, light.pdf(vec3(0.0, -1.0, 1.0), sample.end));
}

#[test]
fn environments() {
    let gradient: Vec<Vec3> =
        (0..32 * 16).map(|i| vec3((i % 32) as f32, (i / 32) as f32 * 0.5, 1.0)).collect();
    let mut spot = vec![Vec3::splat(1e-4); 64 * 32];
    spot[9 * 64 + 63] = Vec3::splat(5000.0);
    let pole = [vec3(1.0, 2.0, 3.0), vec3(0.1, 0.1, 0.1), vec3(0.0, 0.0, 0.0)];
    let turned = Mat3::from_rotation_x(FRAC_PI_2);
    for (texels, size) in
        [(&gradient[..], uvec2(32, 16)), (&spot, uvec2(64, 32)), (&pole, uvec2(1, 3))]
    {
        let environment = Environment::new(texels, size).expect("radiance").rotated(turned);
        if let Err(failure) = test().run_environment(&environment) {
            panic!("{size}: {failure}");
        }
    }
    let one = Environment::constant(Vec3::ONE).expect("radiance");
    assert!(test().run_environment(&one).is_ok());
}

/// A row of texels above is at `+y`; the middle of a row is at `-z`, and what is right of it at `+x`.
#[test]
fn environments_are_turned_as_documented() {
    let texels: Vec<Vec3> = (0..8 * 4).map(|i| vec3((i % 8) as f32, (i / 8) as f32, 0.0)).collect();
    let sky = Environment::new(&texels, uvec2(8, 4)).expect("radiance");
    assert_eq!(sky.radiance(Vec3::Y).y, 0.0);
    assert_eq!(sky.radiance(-Vec3::Y).y, 3.0);
    assert!((sky.radiance(-Vec3::Z).x - 3.5).abs() < 1e-5);
    assert!((sky.radiance(Vec3::X).x - 5.5).abs() < 1e-5);
    assert!((sky.radiance(-Vec3::X).x - 1.5).abs() < 1e-5);
    let up = sky.rotated(Mat3::from_rotation_x(FRAC_PI_2));
    assert!(up.radiance(Vec3::Z).y < 1e-5);
}

#[test]
fn wrong_environments_are_refused() {
    let size = uvec2(2, 1);
    let error = |texels: &[Vec3]| Environment::new(texels, size).expect_err("they are wrong");
    assert_eq!(error(&[Vec3::ONE]), EnvironmentError::Size { size, found: 1 });
    let nan = error(&[Vec3::ONE, vec3(0.0, f32::NAN, 0.0)]);
    assert!(nan.to_string().starts_with("texel (1, 0) is"), "{nan}");
    assert!(Environment::new(&[], uvec2(0, 1)).is_err());
    // A black one is no error.
    let black = Environment::new(&[Vec3::ZERO; 2], size).expect("radiance");
    assert_eq!(black.sample(vec2(0.3, 0.7)).light, Vec3::ZERO);
}

#[test]
fn wrong_lights_are_refused() {
    let lamp = |intensity| PointLight { position: Vec3::ZERO, intensity };
    let bounds = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
    let list = [lamp(Vec3::ONE), lamp(Vec3::splat(f32::NAN))];
    assert_eq!(Lights::new(&list, bounds).err(), Some(LightsError::NotPower(1)));
    let none: [PointLight; 0] = [];
    let lights = Lights::new(&none, bounds).expect("no lights");
    let at = SurfacePoint { position: Vec3::ZERO, normal: Vec3::Z, error: 0.0 };
    assert_eq!(lights.sample(at, Vec3::splat(0.5)).light, Vec3::ZERO);
    let black = [lamp(Vec3::ZERO); 3];
    let lights = Lights::new(&black, bounds).expect("black lights");
    assert_eq!(lights.sample(at, Vec3::splat(0.5)).light, Vec3::ZERO);
}

#[test]
fn estimators_have_one_mean() {
    let (v0, v1, v2) = (vec3(1.0, 0.0, 1.0), vec3(0.0, 1.0, 2.0), vec3(-1.0, -0.5, 1.5));
    let shape = Triangle { v0, v1, v2 };
    let fresnel = F82 { normal: vec3(1.0, 0.8, 0.4), tint: Vec3::ONE };
    fn assert_one<B: Bsdf, L: Light, S: Scene + ?Sized>(bsdf: B, light: L, scene: &S) {
        let test = EstimatorsTest { samples: 200_000, ..EstimatorsTest::new() };
        if let Err(failure) = test.run(bsdf, light, scene) {
            panic!("{failure}");
        }
    }
    let lambert = Lambert { color: vec3(0.9, 0.5, 0.1) };
    assert_one(lambert, shining(shape, true), &[shape][..]);
    let metal = Conductor::<F82> { fresnel, alpha: 0.2 };
    assert_one(metal, shining(shape, true), &[shape][..]);
    let sun = DirectionalLight { direction: vec3(0.6, 0.0, 0.8), irradiance: Vec3::ONE, sine: 0.3 };
    assert_one(metal, sun, &NOTHING[..]);
    let (center, radius) = (vec3(1.0, 0.0, 2.0), 0.5);
    assert_one(
        lambert,
        shining(SphereShape { center, radius }, false),
        &[Ball { center, radius }][..],
    );
}
