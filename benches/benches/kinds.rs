//! An enum of primitives beside its kind, one thread: what it costs that a scene may have others.
//!
//! The same spheres, or triangles, are in trees as they are, as an enum that has no other kind, and as
//! an enum of three whose others the scene lacks. Hits are compared.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use raydsl::bvh::BuildError;
use raydsl::prelude::*;
use raydsl_benches::clock::{median, seconds, spread};
use raydsl_tests::rng::Rng;
use serde::Serialize;

/// Measures enums of primitives beside their kinds.
#[derive(Parser)]
struct Args {
    /// Writes the rows to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Only the scenes whose names contain one of these words.
    #[arg(long)]
    scene: Vec<String>,
    /// Primitives.
    #[arg(long, default_value_t = 100_000)]
    count: usize,
    /// Rounds; each measures every variant once.
    #[arg(long, default_value_t = 7)]
    rounds: usize,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

#[derive(Serialize)]
struct Row {
    scene: &'static str,
    variant: &'static str,
    /// Million rays a second to the primitives themselves.
    rate: f64,
    /// The time of the enum of one kind over theirs.
    alone: f64,
    /// The time of the enum of three over theirs.
    among: f64,
    spread: f64,
}

#[primitive(sphere(center, radius))]
#[derive(Clone, Copy)]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive(cylinder(p0, p1, radius))]
#[derive(Clone, Copy)]
struct Rod {
    p0: Vec3,
    p1: Vec3,
    radius: f32,
}

#[primitive]
#[derive(Clone, Copy)]
enum OnlyBalls {
    Ball(Ball),
}

#[primitive]
#[derive(Clone, Copy)]
enum OnlyFacets {
    Facet(Triangle),
}

#[primitive]
#[derive(Clone, Copy)]
enum Shape {
    Ball(Ball),
    Facet(Triangle),
    Rod(Rod),
}

const VARIANTS: [Variant; 4] =
    [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16];

/// The rays of a film, from outside of the cube of all primitives.
fn rays() -> Vec<(Ray,)> {
    const WIDTH: usize = 448;
    let eye = vec3(0.0, 0.0, -2.0);
    (0..WIDTH * WIDTH)
        .map(|i| {
            let [x, y] = [i % WIDTH, i / WIDTH].map(|k| k as f32 / WIDTH as f32 - 0.5);
            (Ray::new(eye, vec3(x, y, -0.5) - eye),)
        })
        .collect()
}

fn main() -> ExitCode {
    let args = Args::parse();
    match measured(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn measured(args: &Args) -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = Rng::of("kinds");
    let size = 0.4 / (args.count.max(1) as f32).cbrt();
    let balls: Vec<Ball> =
        (0..args.count).map(|_| Ball { center: rng.point(0.5), radius: 0.5 * size }).collect();
    let facets: Vec<Triangle> = (0..args.count)
        .map(|_| {
            let center = rng.point(0.5);
            let [v0, v1, v2] = [(); 3].map(|()| center + rng.point(size));
            Triangle { v0, v1, v2 }
        })
        .collect();
    let only_balls: Vec<_> = balls.iter().map(|b| OnlyBalls::Ball(*b)).collect();
    let only_facets: Vec<_> = facets.iter().map(|t| OnlyFacets::Facet(*t)).collect();
    let ball_shapes: Vec<_> = balls.iter().map(|b| Shape::Ball(*b)).collect();
    let facet_shapes: Vec<_> = facets.iter().map(|t| Shape::Facet(*t)).collect();
    let mut rows = Vec::new();
    println!("the time of an enum over that of its kind");
    println!(
        "{:<18}{:<10}{:>8}{:>14}{:>16}{:>9}",
        "scene", "variant", "M/s", "of one kind", "of three kinds", "spread"
    );
    // The kernels are closures, so each scene has its own.
    macro_rules! compare {
        ($scene:literal, $build:expr, $prims:expr, $alone:expr, $among:expr) => {
            if args.scene.is_empty() || args.scene.iter().any(|word| $scene.contains(word.as_str()))
            {
                let (prims, alone, among) = ($build($prims)?, $build($alone)?, $build($among)?);
                let (prims, alone, among) = (&prims, &alone, &among);
                rows.extend(compared(
                    args,
                    $scene,
                    [
                        &kernel!(|ray: Ray| prims.closest_hit(ray).t),
                        &kernel!(|ray: Ray| alone.closest_hit(ray).t),
                        &kernel!(|ray: Ray| among.closest_hit(ray).t),
                    ],
                ));
            }
        };
    }
    compare!("balls", Bvh::build, &balls, &only_balls, &ball_shapes);
    compare!("triangles", Bvh::build, &facets, &only_facets, &facet_shapes);
    compare!("balls, wide", wide, &balls, &only_balls, &ball_shapes);
    compare!("triangles, wide", wide, &facets, &only_facets, &facet_shapes);
    if let Some(path) = &args.json {
        std::fs::write(path, serde_json::to_string_pretty(&rows)?)?;
    }
    Ok(())
}

fn wide<P: Primitive<Shared = ()>>(prims: &[P]) -> Result<Bvh<'_, P>, BuildError> {
    Bvh::build_wide(prims, &[], &BuildConfig::default())
}

/// The kernels of one scene in every variant, interleaved.
fn compared(args: &Args, scene: &'static str, kernels: [&Kernel<'_, (Ray,), f32>; 3]) -> Vec<Row> {
    let rays = rays();
    let mut expected = vec![0.0f32; rays.len()];
    let mut found = expected.clone();
    kernels[0].run(Variant::Scalar, &rays, &mut expected);
    let measured = VARIANTS.map(|variant| {
        let mut times = [const { Vec::new() }; 3];
        // The first round warms up. The kernel that begins takes turns.
        for round in 0..=args.rounds {
            for k in (0..3).map(|k| (k + round) % 3) {
                let time = seconds(|| kernels[k].run(variant, &rays, &mut found));
                assert_eq!(found, expected, "{scene} on {} differs", variant.name());
                if round > 0 {
                    times[k].push(time);
                }
            }
        }
        let over_kind = |k: usize| -> Vec<f64> {
            times[k].iter().zip(&times[0]).map(|(time, kind)| time / kind).collect()
        };
        let alone = over_kind(1);
        let row = Row {
            scene,
            variant: variant.name(),
            rate: rays.len() as f64 / median(&times[0]) * 1e-6,
            alone: median(&alone),
            among: median(&over_kind(2)),
            spread: spread(&alone),
        };
        println!(
            "{:<18}{:<10}{:>8.2}{:>14.3}{:>16.3}{:>8.1}%",
            row.scene,
            row.variant,
            row.rate,
            row.alone,
            row.among,
            row.spread * 100.0
        );
        row
    });
    measured.into()
}
