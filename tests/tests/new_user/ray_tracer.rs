//! A small ray tracer: matte and mirroring balls over a matte floor, in the sun.

use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::testing::FilmTest;
use raydsl::{assert_variants_agree, kernel};

#[derive(Clone, Copy, Type)]
enum Material {
    Matte(Vec3),
    Mirror { tint: Vec3 },
}

#[primitive(sphere(center, radius))]
struct Globe {
    center: Vec3,
    radius: f32,
    material: u32,
}

#[primitive(rectangle(corner, u_edge, v_edge))]
struct Floor {
    corner: Vec3,
    u_edge: Vec3,
    v_edge: Vec3,
}

#[kernel]
impl Surface for Globe {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::ONE
    }

    fn material(&self, _ray: Ray, _hit: Hit) -> u32 {
        self.material
    }
}

#[kernel]
impl Surface for Floor {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::ONE
    }
}

#[derive(Scene)]
struct World<'a> {
    globes: Bvh<'a, Globe>,
    floor: &'a [Floor],
}

#[kernel]
fn sky(direction: Vec3) -> Vec3 {
    let up = 0.5 + 0.5 * direction.y;
    vec3(1.0, 1.0, 1.0).lerp(vec3(0.4, 0.6, 1.0), up)
}

/// The colour that a ray sees.
#[kernel]
fn seen<S: Scene + ?Sized>(scene: &S, materials: &[Material], sun: Vec3, ray: Ray) -> Vec3 {
    let mut ray = ray;
    let mut color = Vec3::ZERO;
    let mut throughput = Vec3::ONE;
    for _ in 0..5 {
        let hit = scene.closest_hit(ray);
        if !hit.is_hit {
            return color + throughput * sky(ray.direction);
        }
        let shading = scene.shading_point(ray, hit);
        let point = facing(shading.point, ray.direction);
        match materials[shading.material as usize] {
            Material::Matte(albedo) => {
                let cosine = max(point.normal.dot(sun), 0.0);
                let light = if scene.any_hit(point.ray(sun)) { 0.1 } else { 0.1 + cosine };
                return color + throughput * albedo * light;
            }
            Material::Mirror { tint } => {
                throughput *= tint;
                color += throughput * 0.02;
                ray = point.ray(ray.direction.reflect(point.normal));
            }
        }
    }
    color
}

#[test]
fn a_small_ray_tracer() {
    let globes = [
        Globe { center: vec3(-1.1, 1.0, 0.0), radius: 1.0, material: 1 },
        Globe { center: vec3(1.1, 1.0, 0.0), radius: 1.0, material: 2 },
        Globe { center: vec3(0.0, 0.5, -1.6), radius: 0.5, material: 1 },
    ];
    let floor = [Floor {
        corner: vec3(-5.0, 0.0, -5.0),
        u_edge: vec3(10.0, 0.0, 0.0),
        v_edge: vec3(0.0, 0.0, 10.0),
    }];
    let materials = vec![
        Material::Matte(vec3(0.7, 0.7, 0.6)),
        Material::Matte(vec3(0.8, 0.2, 0.1)),
        Material::Mirror { tint: vec3(0.9, 0.9, 0.95) },
    ];
    let world = World { globes: Bvh::build(&globes).unwrap(), floor: &floor };
    let sun = vec3(0.4, 0.8, -0.4).normalize();
    let kernel = kernel!(|ray: Ray| seen(&world, &materials, sun, ray).extend(1.0));
    let (width, height) = (96, 64);
    let camera = Pinhole::new(vec3(0.0, 2.0, -6.0), vec3(0.0, 0.8, 0.0), Vec3::Y, 0.7);
    let mut image = Image::filled(width, height, Vec4::ZERO);
    TiledScheduler::new().frame(&camera, &kernel, &mut image);
    let mut simple = Image::filled(width, height, Vec4::ZERO);
    SimpleScheduler::new().frame(&camera, &kernel, &mut simple);
    assert_eq!(image.pixels(), simple.pixels());
    let mean =
        image.pixels().iter().map(|p| p.truncate().length()).sum::<f32>() / (width * height) as f32;
    assert!(mean > 0.3 && mean < 1.7, "{mean}");
    assert_variants_agree!(&kernel, &FilmTest::new(&camera, 32, 24));
}
