//! Build times; prints figures, and fails where a hostile input takes too long.
//!
//! `cargo test --release -p raydsl --lib build::tests::timing -- --ignored --nocapture`

use std::time::Instant;

use glam::Vec3;

use super::super::super::stats;
use super::super::{BuildConfig, Tree, build, refit};
use super::{BuildQuality, Numbers};
use crate::geometry::Aabb;

const COUNT: usize = 1_000_000;

/// Returns the least seconds of a few tries, and the tree.
fn timed(boxes: &[Aabb], config: &BuildConfig) -> (f64, Tree) {
    let once = || {
        let start = Instant::now();
        let tree = build(|k| boxes[k], boxes.len(), config).expect("the boxes are valid");
        (start.elapsed().as_secs_f64(), tree)
    };
    let tries = (0..5).map(|_| once());
    tries.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there are tries")
}

/// Returns the boxes of a million triangles of a hilly surface, row by row.
fn mesh() -> Vec<Aabb> {
    let point = |x: usize, y: usize| {
        let (x, y) = (x as f32 / 1000.0, y as f32 / 500.0);
        let hills = (9.0 * x).sin() * (7.0 * y).cos() + 0.1 * (80.0 * x + 50.0 * y).sin();
        Vec3::new(x, y, 0.2 * hills)
    };
    let quad = |k: usize| {
        let (x, y) = (k % 1000, k / 1000);
        let [a, b, c, d] =
            [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)].map(|(x, y)| point(x, y));
        [Aabb::from_points([a, b, c]), Aabb::from_points([b, c, d])]
    };
    (0..COUNT / 2).flat_map(quad).collect()
}

fn spheres() -> Vec<Aabb> {
    let mut numbers = Numbers::new();
    let mut one = || Aabb::from_sphere(numbers.point(), 0.001 + 0.002 * numbers.next());
    (0..COUNT).map(|_| one()).collect()
}

/// Returns degenerate inputs.
fn hostile(spheres: &[Aabb]) -> Vec<(&'static str, Vec<Aabb>)> {
    let changed = |change: &dyn Fn(Aabb) -> Aabb| spheres.iter().map(|&b| change(b)).collect();
    let scaled = |by: f32| changed(&|b| Aabb::new(b.min * by, b.max * by));
    let mut giant = spheres.to_vec();
    giant[77] = Aabb::new(Vec3::splat(-1e30), Vec3::splat(1e30));
    let mut outlier = spheres.to_vec();
    outlier[77] = Aabb::new(Vec3::splat(1e12), Vec3::splat(1.1e12));
    vec![
        ("identical", vec![spheres[0]; COUNT]),
        ("concentric", changed(&|b| Aabb::new(-b.max.abs(), b.max.abs()))),
        ("on a line", changed(&|b| Aabb::new(b.min.x * Vec3::X, b.min.x * Vec3::X))),
        ("on a plane", changed(&|b| Aabb::new(b.min.with_z(0.0), b.max.with_z(0.0)))),
        ("one giant", giant),
        ("one far away", outlier),
        (
            "powers",
            changed(&|b| {
                let p = (b.min * 200.0 - 100.0).exp2();
                Aabb::new(p, p)
            }),
        ),
        ("1e-20", scaled(1e-20)),
        ("1e-40", scaled(1e-40)),
        ("1e30", scaled(1e30)),
    ]
}

#[test]
#[ignore = "takes a minute, and wants a quiet machine"]
fn hostile_inputs_take_three_times_as_long_at_most() {
    let spheres = spheres();
    for quality in BuildQuality::ALL {
        let config = BuildConfig::from(quality);
        let report = |name: &str, boxes: &[Aabb]| {
            let (seconds, mut tree) = timed(boxes, &config);
            let cost = stats::sah_cost(&tree.nodes, &config);
            let start = Instant::now();
            refit(&mut tree.nodes, &tree.indices, boxes.len(), &|k| boxes[k]).expect("valid");
            let refit = start.elapsed().as_secs_f64();
            let [build, refit] = [seconds, refit].map(|s| 1e3 * s);
            let nodes = tree.nodes.len();
            println!(
                "{quality:?}, {name}: {build:.0} ms, cost {cost:.2}, {nodes} nodes, refit {refit:.1} ms"
            );
            seconds
        };
        let random = report("random", &spheres);
        report("mesh", &mesh());
        for (name, boxes) in hostile(&spheres) {
            let seconds = report(name, &boxes);
            assert!(seconds < 3.0 * random, "{name}");
        }
    }
}
