//! Ten thousand trees that are in memory twice. Learn here how groups of instances are placed in
//! groups, what they take, and how normals come from an object to the scene.
//!
//! `cargo run --release --example instances -- FOLDER` writes `instances.png` to FOLDER (`out` if
//! none is given); `--mesh FILE` plants an OBJ, PLY or TRI instead, `--variant wgsl` renders on a
//! device.

mod forest;
mod light;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use forest::{Facet, beech, fir, forest, ground, hill};
use light::shade;
use raydsl::bvh::{Group, Object};
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_examples::args::{size, variant};
use raydsl_examples::mesh;
use raydsl_examples::picture::smooth_frame;
use raydsl_io::LoadError;

/// Ten thousand trees, in memory twice.
#[derive(Parser)]
struct Args {
    /// Folder of the picture.
    #[arg(default_value = "out")]
    folder: PathBuf,
    /// What is planted [default: two kinds of trees]; .obj, .ply or .tri, with y upwards.
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Which variant renders [default: the widest packets].
    #[arg(long, value_name = "NAME", value_parser = variant)]
    variant: Option<Variant>,
    /// Picture size.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = size)]
    size: (u32, u32),
}

/// A file's triangles, two units tall, standing on the ground.
fn planted(path: &Path) -> Result<Vec<Facet>, LoadError> {
    let triangles = mesh::load(path)?;
    let all = triangles.iter().map(|t| t.get_bounds()).fold(Aabb::EMPTY, Aabb::union);
    let foot = vec3(0.5, 0.0, 0.5) * all.size() + all.min;
    let scale = 2.0 / all.size().max_element().max(f32::MIN_POSITIVE);
    let place = |v: Vec3| (v - foot) * scale;
    let color = [0.55, 0.5, 0.42, 0.0].map(Unorm8::new);
    let facet = |t: &Triangle| Facet { v0: place(t.v0), v1: place(t.v1), v2: place(t.v2), color };
    Ok(triangles.iter().map(facet).collect())
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("instances: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(&args.folder)?;

    // ANCHOR: objects
    let mut objects = vec![ground(150)];
    match &args.mesh {
        Some(path) => objects.push(planted(path)?),
        None => objects.extend([fir(), beech()]),
    }
    let trees = objects.iter().map(|o| Bvh::build(o)).collect::<Result<Vec<_>, _>>()?;
    let (scene, top) = forest(&trees, 10, 10)?;
    // ANCHOR_END: objects
    report(&scene, &trees, top);

    let sun = vec3(-0.75, 0.5, -0.15).normalize();
    let eye = vec3(-4.0, hill(-4.0, 52.0) + 7.5, 52.0);
    let camera = Pinhole::new(eye, vec3(1.0, 1.0, 0.0), Vec3::Y, 0.62);
    let primary = kernel!(|ray: Ray| shade(&scene, sun, ray));
    let start = Instant::now();
    let variant = args.variant.unwrap_or(Variant::widest());
    let image = smooth_frame(variant, &camera, &primary, args.size)?;
    println!("{}: {:.2} s", variant.name(), start.elapsed().as_secs_f64());
    image.write_png(args.folder.join("instances.png"))?;
    Ok(())
}

// ANCHOR: count
/// What a tree takes: its primitives, and what stands over them.
fn bytes(tree: &Bvh<'_, Facet>) -> usize {
    size_of_val(tree.primitives()) + tree.bytes()
}

/// Triangles and bytes, if each of these instances were a copy.
fn copies(
    scene: &Instances<'_, Facet>,
    trees: &[Bvh<'_, Facet>],
    group: &[Instance],
) -> (usize, usize) {
    let of = |instance: &Instance| match instance.object {
        Object::Tree(i) => (trees[i].primitives().len(), bytes(&trees[i])),
        Object::Group(group) => copies(scene, trees, scene.instances_of(group)),
    };
    group.iter().map(of).fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1))
}
// ANCHOR_END: count

fn report(scene: &Instances<'_, Facet>, trees: &[Bvh<'_, Facet>], top: Group) {
    let (triangles, copied) = copies(scene, trees, scene.instances_of(top));
    let objects: usize = trees.iter().map(bytes).sum();
    let mega = |bytes: usize| bytes as f64 / 1e6;
    println!("placed:   {} objects, {triangles} triangles as if copied", scene.count());
    println!("objects:  {:7.2} MB, triangles and trees over them", mega(objects));
    println!("places:   {:7.2} MB, instances and trees over them", mega(scene.bytes()));
    println!("copies:   {:7.0} MB, if each were one", mega(copied));
    println!("rounding: {:7.1} times as large as without shears", scene.amplification());
}
