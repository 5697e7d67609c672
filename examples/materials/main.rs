//! Every material of the library on one ball. Learn here how a kernel takes materials of several
//! kinds, an environment, and a mesh of a file.
//!
//! `cargo run --release --example materials -- --help` tells the rest.

use std::error::Error;
use std::path::PathBuf;

use clap::Parser;
use raydsl::bsdf::Lambert;
use raydsl::integrators::{PathLimits, path};
use raydsl::kernel;
use raydsl::light::{Lights, PointLight};
use raydsl::prelude::*;
use raydsl::render::{Display, ToneMap};
use raydsl::shading::{Mesh, MeshAttributes, Surface};
use raydsl_examples::args::{size, variant};
use raydsl_examples::sheet::Sheet;
use raydsl_examples::shown::{self, Shown};

mod stage;

/// Render the materials of the library.
#[derive(Debug, Parser)]
#[command(about)]
struct Args {
    /// Folder of the picture, materials.png.
    #[arg(value_name = "FOLDER", default_value = "out")]
    folder: PathBuf,
    /// The mesh, .gltf, .glb or .obj [default: shader_ball.glb in RAYDSL_DATA, or a ball].
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// The environment, .hdr or .exr [default: chinese_garden_1k.hdr in RAYDSL_DATA, or a sky].
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
    /// Samples of each pixel.
    #[arg(long, default_value = "64")]
    samples: u32,
    /// How often light is scattered at most.
    #[arg(long, default_value = "12")]
    bounces: u32,
    /// What runs the kernel: scalar, packet4, packet8, packet16 or wgsl.
    #[arg(long, default_value = Variant::widest().name(), value_parser = variant)]
    variant: Variant,
    /// Size of the picture of one material.
    #[arg(long, value_name = "WxH", default_value = "256x256", value_parser = size)]
    size: (u32, u32),
}

/// The floor.
#[primitive(disk(center, normal, radius))]
struct Floor {
    center: Vec3,
    normal: Vec3,
    radius: f32,
}

#[kernel]
impl Surface for Floor {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    /// Grey squares.
    fn albedo(&self, ray: Ray, hit: Hit) -> Vec3 {
        let p = self.surface_point(ray, hit).position;
        let is_odd = ((p.x * 0.5).floor() + (p.z * 0.5).floor()) * 0.5;
        Vec3::splat(if is_odd - is_odd.floor() > 0.25 { 0.5 } else { 0.2 })
    }
}

/// The ball and the floor.
#[derive(Scene)]
struct Stage<'a> {
    ball: Mesh<'a, Bvh<'a, IndexedTriangle>>,
    floor: &'a [Floor],
}

/// Materials side by side.
const COLUMNS: u32 = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let Args { folder, mesh, environment, samples, bounces, variant, size } = Args::parse();
    std::fs::create_dir_all(&folder)?;
    let model = stage::model(mesh)?;
    let environment = stage::environment(environment)?;
    let bounds = model.bounds();
    let (center, radius) = (bounds.center(), bounds.size().length() * 0.5);
    let floor = [Floor {
        center: vec3(center.x, bounds.min.y - 1e-3 * radius, center.z),
        normal: Vec3::Y,
        radius: radius * 30.0,
    }];
    let tree = Bvh::build_sharing(&model.triangles, &model.positions, &BuildConfig::default())?;
    let attributes = MeshAttributes { normals: &model.normals, ..Default::default() };
    let stage = Stage { ball: Mesh::new(&tree, attributes)?, floor: &floor };
    let none: [PointLight; 0] = [];
    let lights = Lights::new(&none, bounds)?.with_environment(&environment);
    let eye = center + vec3(0.0, 0.35, 1.0).normalize() * radius * 2.9;
    let camera = Pinhole::new(eye, center - Vec3::Y * 0.08 * radius, Vec3::Y, 0.62);
    let sampling = Sampling::new(samples);
    let limits = PathLimits::new(bounces);
    let gpu = if variant == Variant::Wgsl { Some(GpuScheduler::new()?) } else { None };

    let all = shown::all();
    let mut sheet = Sheet::new(size, COLUMNS, all.len() as u32);
    let display = Display::new().exposure(0.6).tone_map(ToneMap::Filmic);
    for (i, (name, shown)) in (0..).zip(all) {
        // ANCHOR: materials
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            let surface = |hit: Hit, point: ShadingPoint| {
                let floor = Shown::Lambert(Lambert { color: point.albedo });
                if hit.inst_id == 0 { shown } else { floor }
            };
            path::<_, _, Shown>(&stage, surface, &lights, limits, ray, sampler).color
        });
        // ANCHOR_END: materials
        let mut film = Film::new(size.0, size.1);
        match &gpu {
            Some(gpu) => {
                gpu.accumulate(&camera, &kernel, &sampling, &mut film, samples)?;
            }
            None => {
                let scheduler = TiledScheduler::new().variant(variant);
                scheduler.accumulate(&camera, &kernel, &sampling, &mut film, samples);
            }
        }
        sheet.put(i, name, &display.show(&film.image()));
        println!("{name}");
    }
    sheet.save(folder.join("materials.png"))?;
    Ok(())
}
