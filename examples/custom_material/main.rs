//! A material and a light of one's own. Learn here how to write both, and how the library checks
//! them.
//!
//! `cargo run --release --example custom_material -- [FOLDER]` writes `custom_material.png` to FOLDER
//! (`out` if none is given).

use std::error::Error;
use std::f32::consts::FRAC_1_PI;
use std::path::PathBuf;

use raydsl::bsdf::{Bsdf, BsdfSample, Material};
use raydsl::integrators::{PathLimits, path};
use raydsl::kernel;
use raydsl::light::{DistantLight, Light, LightExtent, LightSample, Lights};
use raydsl::prelude::*;
use raydsl::render::Display;
use raydsl::testing::check::{self, BsdfTest};

// ANCHOR: material
/// Velvet paint: Lambert's law, and a rim that depends on both directions.
#[derive(Clone, Copy, Debug, Type)]
struct Velvet {
    color: Vec3,
    rim: Vec3,
}

#[kernel]
impl Bsdf for Velvet {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let grazing = (1.0 - wo.z.abs()) * (1.0 - wi.z.abs());
        let brdf = (self.color * (1.0 - grazing) + self.rim * grazing) * FRAC_1_PI;
        if wo.z * wi.z > 0.0 { brdf * wi.z.abs() } else { Vec3::ZERO }
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let up = sample_cosine_hemisphere(vec2(u.x, u.y));
        let wi = vec3(up.x, up.y, if wo.z < 0.0 { -up.z } else { up.z });
        BsdfSample::of(wi, Velvet::eval(self, wo, wi), Velvet::pdf(self, wo, wi))
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z * wi.z > 0.0 { cosine_hemisphere_pdf(wi.z.abs()) } else { 0.0 }
    }
}

#[kernel]
impl Material for Velvet {}
// ANCHOR_END: material

// ANCHOR: light
/// A window in the sky: all directions around an axis, with one radiance.
#[derive(Clone, Copy, Debug, Type)]
struct Skylight {
    axis: Vec3,
    sine: f32,
    radiance: Vec3,
}

#[kernel]
impl Light for Skylight {
    fn sample(&self, _from: Vec3, u: Vec2) -> LightSample {
        let height = one_minus_cos(self.sine);
        let wi = Frame::around(self.axis).to_world(sample_cone(u, height));
        LightSample::distant(wi, self.radiance, cone_pdf(height), false)
    }

    fn distant(&self, direction: Vec3) -> DistantLight {
        let height = one_minus_cos(self.sine);
        let is_seen = self.axis.dot(direction) > 1.0 - height;
        let none = DistantLight { radiance: Vec3::ZERO, pdf: 0.0 };
        let seen = DistantLight { radiance: self.radiance, pdf: cone_pdf(height) };
        if is_seen { seen } else { none }
    }

    fn is_distant(&self) -> bool {
        true
    }

    fn power(&self, radius: f32) -> f32 {
        radius * radius * self.radiance.x
    }

    fn extent(&self) -> LightExtent {
        let (axis, zero) = (self.axis, Vec3::ZERO);
        LightExtent { min: zero, max: zero, axis, cos_normals: 1.0, cos_emitted: 1.0 }
    }
}
// ANCHOR_END: light

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    std::fs::create_dir_all(&folder)?;
    let velvet = Velvet { color: vec3(0.35, 0.02, 0.05), rim: vec3(0.9, 0.5, 0.5) };
    let axis = vec3(0.5, 0.8, 0.4).normalize();
    let sky = [Skylight { axis, sine: 0.6, radiance: Vec3::splat(4.0) }];
    // ANCHOR: check
    println!("{}", BsdfTest::new().run(velvet)?);
    let surfaces: [Triangle; 0] = [];
    check::light(sky[0], &surfaces[..])?;
    println!("{}", check::estimators(velvet, sky[0], &surfaces[..])?);
    // ANCHOR_END: check

    let shape = raydsl_examples::blob::blob(300);
    let scene = Bvh::build(&shape)?;
    let lights = Lights::new(&sky, scene.bounds())?;
    let limits = PathLimits::new(5);
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |_hit: Hit, _point: ShadingPoint| velvet;
        path::<_, _, Velvet>(&scene, surface, &lights, limits, ray, sampler).color
    });
    let camera = Pinhole::new(vec3(0.0, 1.5, 5.0), Vec3::ZERO, Vec3::Y, 0.6);
    let mut film = Film::new(480, 480);
    TiledScheduler::new().accumulate(&camera, &kernel, &Sampling::new(64), &mut film, 64);
    Display::new().show(&film.image()).write_png(folder.join("custom_material.png"))?;
    Ok(())
}
