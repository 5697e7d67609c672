//! A renderer of surfaces with every feature: what a program would have that leaves nothing out.

use std::error::Error;

use raydsl::camera::PinholeRays;
use raydsl::integrators::{PathLimits, PathOptions, path_with};
use raydsl::kernel;
use raydsl::light::{
    AnyLight, AreaLight, DirectionalLight, DiskShape, Environment, Lights, PointLight,
    RectangleShape, SphereShape, SpotLight,
};
use raydsl::machine::Recording;
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::texture::AsTextureRef;

use crate::explain::{Explained, explain};
use crate::recorded;
use crate::shown::{self, Shown};

/// Returns the table of a program beside the renderer of everything.
///
/// # Errors
///
/// If a text is not valid.
pub fn beside_all_surfaces(
    name: &str,
    features: &str,
    recording: Recording,
) -> Result<String, Box<dyn Error>> {
    let all = Explained { name: "all features", features: FEATURES, recording: surfaces()? };
    Ok(explain(&[Explained { name, features, recording }, all])?)
}

/// What the renderer has.
const FEATURES: &str = "spheres, disks, rectangles, cylinders, cuboids and triangles; \
    instances; 12 materials; 7 kinds of lights with an environment; a texture; masks; paths with \
    roulette; the three methods of samples";

/// Declares primitives of the library that are surfaces, and the enum of all of them.
macro_rules! shapes {
    ($($name:ident($make:ident($($member:ident: $t:ty),+));)+) => {
        $(
            #[primitive($make($($member),+))]
            struct $name {
                $($member: $t,)+
            }

            #[kernel]
            impl Surface for $name {
                fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
                    self.surface_point(ray, hit)
                }

                fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
                    Vec3::ONE
                }
            }
        )+

        /// Any of them.
        #[primitive(Surface)]
        enum Shape {
            $($name($name),)+
        }
    };
}

shapes! {
    Ball(sphere(center: Vec3, radius: f32));
    Plate(disk(center: Vec3, normal: Vec3, radius: f32));
    Panel(rectangle(corner: Vec3, u_edge: Vec3, v_edge: Vec3));
    Can(cylinder(p0: Vec3, p1: Vec3, radius: f32));
    Block(cuboid(min: Vec3, max: Vec3));
    Face(triangle(v0: Vec3, v1: Vec3, v2: Vec3));
}

#[kernel]
#[expect(clippy::too_many_arguments, reason = "a renderer of everything captures everything")]
fn everything(
    rays: PinholeRays,
    scene: &Instances<'_, Shape>,
    materials: &[Shown],
    paint: &TextureRef2<'_, [Unorm8; 4]>,
    lights: &Lights<'_, AnyLight>,
    limits: PathLimits,
    pixel: UVec2,
    sampler: Sampler,
) -> Vec4 {
    let ray = rays.primary_ray(pixel.x as f32 + 0.5, pixel.y as f32 + 0.5);
    let surface = |hit: Hit, point: ShadingPoint| {
        let painted = tex2(paint, point.uv);
        materials[(hit.prim_id + painted.x as u32) as usize % materials.len()]
    };
    path_with::<_, _, Shown>(scene, surface, lights, OPTIONS, limits, ray, sampler).color
}

const OPTIONS: PathOptions = PathOptions { masks: true, ..PathOptions::new() };

/// Records the renderer of everything.
///
/// # Errors
///
/// None that are known: its scene is made here.
fn surfaces() -> Result<Recording, Box<dyn Error>> {
    let (a, b, c) = (Vec3::X, Vec3::Y, Vec3::Z);
    let shapes = [
        Shape::Ball(Ball { center: a, radius: 1.0 }),
        Shape::Plate(Plate { center: a, normal: b, radius: 1.0 }),
        Shape::Panel(Panel { corner: a, u_edge: b, v_edge: c }),
        Shape::Can(Can { p0: a, p1: b, radius: 0.5 }),
        Shape::Block(Block { min: -a - b - c, max: a + b + c }),
        Shape::Face(Face { v0: a, v1: b, v2: c }),
    ];
    let trees = [Bvh::build(&shapes)?];
    let scene = &Instances::build(&trees, &[Instance::new(0, Affine3::IDENTITY)])?;
    let radiance = Vec3::ONE;
    let triangle = Triangle { v0: a, v1: b, v2: c };
    let of = |shape| AreaLight::<SphereShape> { shape, radiance, is_two_sided: true };
    let list = [
        AnyLight::Point(PointLight { position: a, intensity: b }),
        AnyLight::Spot(SpotLight {
            position: a,
            intensity: b,
            direction: c,
            cos_inner: 0.9,
            cos_outer: 0.8,
        }),
        AnyLight::Directional(DirectionalLight { direction: b, irradiance: a, sine: 0.1 }),
        AnyLight::Sphere(of(SphereShape { center: a, radius: 1.0 })),
        AnyLight::Rectangle(AreaLight {
            shape: RectangleShape { corner: a, u_edge: b, v_edge: c },
            radiance,
            is_two_sided: true,
        }),
        AnyLight::Triangle(AreaLight { shape: triangle, radiance, is_two_sided: true }),
        AnyLight::Disk(AreaLight {
            shape: DiskShape { center: a, normal: b, radius: 1.0 },
            radiance,
            is_two_sided: true,
        }),
    ];
    let sky = Environment::constant(radiance)?;
    let lights = &Lights::new(&list, scene.bounds())?.with_environment(&sky);
    let all: Vec<Shown> = shown::all().into_iter().map(|(_, shown)| shown).collect();
    let materials = &all[..];
    let texels = [[Unorm8::ONE; 4]; 4];
    let texture = Texture2::new(&texels, [2, 2], TextureConfig::new())?;
    let paint = &texture.as_texture_ref();
    let rays = Pinhole::new(c, Vec3::ZERO, b, 1.0).begin_frame(64, 64);
    let limits = PathLimits::new(8);
    Ok(recorded!(
        everything(rays, scene, materials, paint, lights, limits)(pixel: UVec2, sampler: Sampler) -> Vec4
    ))
}
