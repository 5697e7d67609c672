//! Generated kernels beside kernels of another hand, for four scenes: the same bits, and how many
//! instructions each has.
//!
//! What is written by hand has the buffers and the numbers of the generated text, and nothing else of
//! it. The kernel of ambient occlusion is not written: a program reduced it (`reduce.rs`). `RAYDSL_SPIRV=FOLDER` writes the SPIR-V of both there, for tools that optimise it.

use std::error::Error;
use std::path::Path;

use raydsl::integrators::PathLimits;
use raydsl::light::Lights;
use raydsl::prelude::*;
use raydsl::render::FilmArgs;
use raydsl::volume::{Euler, Volume};
use raydsl_report::Program;
use raydsl_tests::gpu::{gpu, keeps_denormals};
use raydsl_tests::scenes::spheres;

use super::matrix::assert_in_book;
use super::occlusion;
use super::scenes::{colors, diffuse_path, grid, lit_triangles, marched, open_sky, transfer};

/// How many instructions the functions of the generated text have, and those of the one by hand.
type Counts = Result<[usize; 2], Box<dyn Error>>;

/// The kernel that is not by hand; see `occlusion.rs`.
const REDUCED: &str = "occlusion";

/// Returns a text by hand with the declaration of the numbers that the generated one has.
pub(super) fn with_numbers(by_hand: &str, generated: &str) -> String {
    let numbers =
        generated.split_once("struct Params {").and_then(|(_, rest)| rest.split_once('}'));
    let (members, _) = numbers.expect("every generated text has numbers");
    format!("struct Params {{{members}}}\n{by_hand}")
}

/// Renders a frame by both texts, and compares the pictures.
fn compare<A: FilmArgs, R: Type + PartialEq + std::fmt::Debug>(
    name: &str,
    camera: &Pinhole,
    kernel: &Kernel<'_, A, R>,
    by_hand: &str,
) -> Counts {
    let (width, height) = (96, 64);
    let text = kernel.record_frame(camera, (width, height)).module(&Default::default()).source;
    let programs = [Program::read(&text)?, Program::read(&with_numbers(by_hand, &text))?];
    if let Some(folder) = std::env::var_os("RAYDSL_SPIRV") {
        for (program, origin) in programs.iter().zip(["generated", "by_hand"]) {
            let bytes: Vec<u8> = program.spirv.iter().flat_map(|word| word.to_le_bytes()).collect();
            std::fs::write(Path::new(&folder).join(format!("{name}_{origin}.spv")), bytes)?;
        }
    }
    let counts = programs.map(|program| program.size.code);
    // What a program reduced may differ where a driver has its own way with numbers that are not finite.
    let is_reduced = name == REDUCED;
    let Some(gpu) = gpu().filter(|gpu| !is_reduced || keeps_denormals(gpu)) else {
        return Ok(counts);
    };
    let zero = R::read(&vec![0; R::SCHEMA.size()]);
    let mut pictures = [(); 2].map(|()| Image::filled(width, height, zero));
    gpu.frame(camera, kernel, &mut pictures[0])?;
    gpu.frame_by_text(camera, kernel, &mut pictures[1], |text| with_numbers(by_hand, text))?;
    let [generated, by_hand] = pictures;
    let differ = generated.pixels().iter().zip(by_hand.pixels()).filter(|(a, b)| a != b);
    let count = differ.clone().count();
    assert!(count == 0, "{name}: {count} pixels differ, as {:?}", differ.clone().next());
    let kinds = generated.pixels().iter().filter(|p| **p != generated.pixels()[0]).count();
    assert!(kinds > 500, "{name}: the picture shows nothing: {kinds} pixels");
    Ok(counts)
}

fn points() -> Counts {
    let points = spheres(3000);
    let (bvh, background) = (Bvh::build(&points)?, vec3(0.1, 0.2, 0.3));
    let camera = Pinhole::new(vec3(0.0, 0.0, 12.0), Vec3::ZERO, Vec3::Y, 0.9);
    let kernel = kernel!(|ray: Ray| colors(&bvh, background, ray));
    compare("points", &camera, &kernel, include_str!("by_hand/points.wgsl"))
}

fn volume() -> Counts {
    let voxels: Vec<f32> = (0..64).map(|i| ((i * 37) % 64) as f32 / 64.0).collect();
    let grid = grid(&voxels)?;
    let (volume, euler) = (Volume::new(&grid, transfer()?), Euler::new(0.25));
    let camera = Pinhole::new(vec3(7.0, 6.0, 9.0), vec3(1.5, 1.5, 1.5), Vec3::Y, 0.4);
    let kernel = kernel!(|ray: Ray| marched(&volume, euler, ray));
    compare("volume", &camera, &kernel, include_str!("by_hand/volume.wgsl"))
}

fn paths() -> Counts {
    let (soup, lamps) = lit_triangles();
    let scene = Bvh::build(&soup)?;
    let (lights, limits) = (Lights::new(&lamps, scene.bounds())?, PathLimits::new(4));
    let camera = Pinhole::new(vec3(0.0, 7.0, 14.0), vec3(0.0, 1.5, 0.0), Vec3::Y, 0.9);
    let kernel =
        kernel!(|ray: Ray, pixel: UVec2| diffuse_path(&scene, &lights, limits, ray, pixel));
    compare("paths", &camera, &kernel, include_str!("by_hand/diffuse_path.wgsl"))
}

fn occluded() -> Counts {
    let case = occlusion::cases().remove(0);
    let bvh = Bvh::build(&case.soup)?;
    let kernel = kernel!(|ray: Ray, pixel: UVec2| open_sky(&bvh, ray, pixel));
    compare(REDUCED, &case.camera, &kernel, include_str!("by_hand/occlusion.wgsl"))
}

#[test]
fn they_give_the_same_bits() -> Result<(), Box<dyn Error>> {
    let rows = [
        ("coloured spheres, one ray for each pixel", points()?),
        ("a volume with a transfer function, by steps", volume()?),
        ("paths among diffuse triangles", paths()?),
        ("ambient occlusion of triangles, reduced by a program", occluded()?),
    ];
    let mut table = "| kernel | generated | by hand | ratio |\n|---|---|---|---|\n".to_owned();
    for (name, [own, by_hand]) in rows {
        let ratio = own as f64 / by_hand as f64;
        table += &format!("| {name} | {own} | {by_hand} | {ratio:.2} |\n");
    }
    assert_in_book("by_hand.md", &table)
}
