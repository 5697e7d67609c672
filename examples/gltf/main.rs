//! A scene of a file by path tracing. Learn here how meshes, materials with pictures, and lights of a
//! file get into a kernel.
//!
//! `cargo run --release --example gltf -- --help` tells the rest.

use std::error::Error;
use std::path::PathBuf;

use clap::Parser;
use raydsl::geometry::Aabb;
use raydsl::integrators::{PathLimits, PathOptions, PathSample, clamped, path_with};
use raydsl::light::{Environment, Lights, luminance};
use raydsl::prelude::*;
use raydsl::render::{Display, ToneMap};
use raydsl::shading::{Mesh, MeshAttributes};
use raydsl_examples::args::{size, variant};
use raydsl_examples::model::{Met, Model, met};
use raydsl_io::scene::{self, Projection};

/// Render a glTF or OBJ file by path tracing.
#[derive(Debug, Parser)]
#[command(about)]
struct Args {
    /// The scene: .gltf, .glb or .obj.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Folder of the pictures: gltf.png, and gltf.exr, gltf_albedo.exr and gltf_normal.exr.
    #[arg(value_name = "FOLDER", default_value = "out")]
    folder: PathBuf,
    /// The environment, .hdr or .exr [default: an even sky, if the file has no lights].
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
    /// Samples of each pixel.
    #[arg(long, default_value = "64")]
    samples: u32,
    /// How often light is scattered at most.
    #[arg(long, default_value = "8")]
    bounces: u32,
    /// The greatest radiance of a sample: fewer bright specks, and a picture that is too dark by what
    /// is printed.
    #[arg(long, value_name = "RADIANCE", default_value = "inf")]
    clamp: f32,
    /// Exposure in stops.
    #[arg(long, default_value = "0", allow_hyphen_values = true)]
    exposure: f32,
    /// What runs the kernel: scalar, packet4, packet8, packet16 or wgsl.
    #[arg(long, default_value = Variant::widest().name(), value_parser = variant)]
    variant: Variant,
    /// Picture size.
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = size)]
    size: (u32, u32),
}

/// The file's first camera that has a perspective, or one that sees all.
fn camera(file: &scene::Scene, bounds: Aabb) -> Pinhole {
    for c in &file.cameras {
        if let Projection::Perspective { vertical, .. } = c.projection {
            return Pinhole::new(c.position, c.position + c.forward, c.up, vertical);
        }
    }
    let (center, radius) = (bounds.center(), 0.5 * bounds.size().length());
    let eye = center + vec3(0.4, 0.3, 1.0).normalize() * radius * 2.6;
    Pinhole::new(eye, center, Vec3::Y, 0.8)
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse();
    std::fs::create_dir_all(&args.folder)?;
    let file = scene::load(&args.file)?;
    let model = Model::new(&file);
    let bounds = model.bounds();
    let sky = match &args.environment {
        Some(path) => {
            let picture = raydsl_io::environment::load(path)?;
            Environment::new(&picture.texels, uvec2(picture.width, picture.height))?
        }
        None => {
            Environment::constant(Vec3::splat(if model.lights.is_empty() { 1.0 } else { 0.0 }))?
        }
    };
    // ANCHOR: gltf
    let config = BuildConfig::default();
    let tree = Bvh::build_sharing(&model.triangles, &model.positions, &config)?;
    let attributes = MeshAttributes {
        normals: &model.normals,
        uvs: &model.uvs,
        colors: &model.colors,
        materials: &model.materials,
        ..Default::default()
    };
    let mesh = Mesh::new(&tree, attributes)?;
    let lights = Lights::new(&model.lights, bounds)?.with_tree()?.with_environment(&sky);
    let (looks, texels, light_of) = (&model.looks[..], &model.texels[..], &model.light_of[..]);
    let options = PathOptions { masks: model.has_masks, ..PathOptions::new() };
    let (limits, limit) = (PathLimits::new(args.bounces), args.clamp);
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |hit: Hit, point: ShadingPoint| {
            let look = looks[point.material as usize];
            met(texels, look, point, light_of[hit.prim_id as usize])
        };
        let sample: PathSample =
            path_with::<_, _, Met>(&mesh, surface, &lights, host(options), limits, ray, sampler);
        let (color, lost) = clamped(sample.color, limit);
        (PathSample { color, ..sample }, lost)
    });
    // ANCHOR_END: gltf
    // A film of channels: colour, albedo and normal for a denoiser, and what clamping took.
    let mut film = Film::<(PathSample, Vec3)>::of_channels(args.size.0, args.size.1);
    let (camera, sampling) = (camera(&file, bounds), Sampling::new(args.samples));
    if args.variant == Variant::Wgsl {
        GpuScheduler::new()?.accumulate(&camera, &kernel, &sampling, &mut film, args.samples)?;
    } else {
        let scheduler = TiledScheduler::new().variant(args.variant);
        scheduler.accumulate(&camera, &kernel, &sampling, &mut film, args.samples);
    }
    let display = Display::new().exposure(args.exposure).tone_map(ToneMap::Filmic);
    // What is behind the scene is seen, not transparent.
    let light = film.image().map(|color| color.with_w(1.0));
    display.show(&light).write_png(args.folder.join("gltf.png"))?;
    let channels = film.channels();
    if args.clamp.is_finite() {
        let kept: f64 = light.pixels().iter().map(|p| f64::from(luminance(p.truncate()))).sum();
        let lost: f64 = channels.pixels().iter().map(|(_, l)| f64::from(luminance(*l))).sum();
        println!("clamped: {:.2} % of the light is lost", 100.0 * lost / (kept + lost));
    }
    let albedo = channels.map(|(p, _)| p.albedo.extend(1.0));
    let normal = channels.map(|(p, _)| p.normal.extend(1.0));
    for (name, picture) in [("gltf", light), ("gltf_albedo", albedo), ("gltf_normal", normal)] {
        picture.write_exr(args.folder.join(format!("{name}.exr")))?;
    }
    Ok(())
}
