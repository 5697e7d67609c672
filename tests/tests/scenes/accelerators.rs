//! Structures of the application's own in the place of a tree: a grid, and ones that misbehave.

use raydsl::bvh::{Accelerated, Accelerator};
use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};
use raydsl_tests::rng::Rng;

#[primitive(sphere(center, radius))]
#[derive(Debug, PartialEq)]
struct Ball {
    center: Vec3,
    radius: f32,
}

/// Cells along each axis.
const CELLS: usize = 8;

/// A uniform grid over `-4..4`, walked from cell to cell (Amanatides and Woo, *A fast voxel
/// traversal algorithm for ray tracing*, Eurographics 1987).
struct Grid {
    cells: Vec<Vec<u32>>,
}

impl Grid {
    fn new(balls: &[Ball]) -> Self {
        let mut cells = vec![Vec::new(); CELLS * CELLS * CELLS];
        for (id, ball) in balls.iter().enumerate() {
            // Wider than the ball: rounding must not take a hit out of a cell.
            let reach = Vec3::splat(ball.radius + 1e-3);
            let (low, high) = (cell_of(ball.center - reach), cell_of(ball.center + reach));
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        cells[index([x, y, z])].push(id as u32);
                    }
                }
            }
        }
        Self { cells }
    }
}

fn cell_of(p: Vec3) -> [i32; 3] {
    (p + 4.0).floor().to_array().map(|x| (x as i32).clamp(0, CELLS as i32 - 1))
}

fn index([x, y, z]: [i32; 3]) -> usize {
    (x as usize * CELLS + y as usize) * CELLS + z as usize
}

// ANCHOR: grid
impl Accelerator for Grid {
    fn candidates(&self, ray: &Ray, mut limit: f32, meet: &mut dyn FnMut(u32) -> f32) {
        let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
        // Where the ray is in the grid.
        let (mut near, mut far) = (ray.t_min, limit);
        for axis in 0..3 {
            let [a, b] = [-4.0, 4.0].map(|at| (at - o[axis]) / d[axis]);
            if d[axis] != 0.0 {
                (near, far) = (near.max(a.min(b)), far.min(a.max(b)));
            } else if o[axis].abs() > 4.0 {
                return;
            }
        }
        if near > far * 1.001 + 1e-3 {
            return;
        }
        let mut cell = cell_of(ray.at(near));
        loop {
            for id in &self.cells[index(cell)] {
                limit = meet(*id);
            }
            // The axis whose next plane is the nearest.
            let next = |axis: usize| {
                let plane = cell[axis] as f32 - 4.0 + if d[axis] > 0.0 { 1.0 } else { 0.0 };
                if d[axis] == 0.0 { f32::INFINITY } else { (plane - o[axis]) / d[axis] }
            };
            let times = [next(0), next(1), next(2)];
            let axis = (0..3).min_by(|a, b| times[*a].total_cmp(&times[*b])).unwrap_or(0);
            if times[axis] > limit + 1e-3 {
                return;
            }
            cell[axis] += if d[axis] > 0.0 { 1 } else { -1 };
            if !(0..CELLS as i32).contains(&cell[axis]) {
                return;
            }
        }
    }
}
// ANCHOR_END: grid

fn balls(rng: &mut Rng, count: usize) -> Vec<Ball> {
    let mut balls: Vec<Ball> =
        (0..count).map(|_| Ball { center: rng.point(3.4), radius: rng.range(0.1, 0.6) }).collect();
    balls.extend_from_within(..count / 4);
    balls
}

/// Rays from the middle of the grid, whose steps are easy to follow.
fn rays(rng: &mut Rng, count: usize) -> Vec<(Ray,)> {
    let mut all: Vec<(Ray,)> =
        (0..count).map(|_| (Ray::new(rng.point(3.0), rng.point(1.0)),)).collect();
    for (i, (ray,)) in all.iter_mut().enumerate() {
        match i % 5 {
            0 => ray.t_max = 2.0,
            1 => ray.t_min = 1.0,
            2 => ray.direction.y = 0.0,
            _ => {}
        }
    }
    all[7].0.origin.x = f32::NAN;
    all
}

#[test]
fn a_grid_stands_in_for_a_tree() {
    let mut rng = Rng::of("a grid");
    let balls = balls(&mut rng, 200);
    let rays = rays(&mut rng, 3000);
    let (grid, tree) =
        (Accelerated::new(&balls, Grid::new(&balls)), Bvh::build(&balls).expect("finite bounds"));
    let mut hits = 0;
    let mut cost = [0u64; 2];
    for (ray,) in &rays {
        let (hit, of_grid) = grid.closest_hit_with_cost(*ray);
        let (expected, of_tree) = tree.closest_hit_with_cost(*ray);
        assert_eq!(hit, expected);
        hits += usize::from(hit.is_hit);
        cost[0] += u64::from(of_grid.primitives);
        cost[1] += u64::from(of_tree.primitives);
        assert_eq!(grid.any_hit(*ray), hit.is_hit);
        assert_eq!(grid.multi_hit::<4>(*ray), tree.multi_hit::<4>(*ray));
        assert_eq!(grid.primitive(hit), tree.primitive(hit));
    }
    assert!(hits > 1500, "{hits} hits");
    // Nearer cells come first, and the walk ends behind a hit.
    assert!(cost[0] < 60 * rays.len() as u64, "the grid asks {cost:?} balls");
    let kernel = kernel!(|ray: Ray| {
        let hit = grid.closest_hit(ray);
        let hits = grid.multi_hit::<3>(ray);
        let kept = grid.closest_hit_where(ray, |hit: Hit| hit.prim_id % 3 != 1);
        let late = grid.any_hit_where(ray, |hit: Hit| hit.t > 1.0);
        let each = grid.any_hit_each::<2>(|i: u32| ray.with_range(i as f32, ray.t_max));
        (hit, grid.any_hit(ray), hits[2], kept, late, each[1], grid.primitive(hit).radius)
    });
    // On a GPU, and where it is explained, every ball is asked.
    assert_variants_agree!(&kernel, &rays[..500]);
}

/// A closure that names everything twice, numbers that are not there, and never stops.
#[test]
fn what_is_named_too_much_does_no_harm() {
    let mut rng = Rng::of("a closure");
    let balls = balls(&mut rng, 40);
    let len = balls.len() as u32;
    let careless = Accelerated::new(&balls, |_: &Ray, _: f32, meet: &mut dyn FnMut(u32) -> f32| {
        for id in (0..len + 3).rev().chain(0..len).chain([u32::MAX]) {
            meet(id);
        }
    });
    let rays = rays(&mut rng, 500);
    for (ray,) in &rays {
        assert_eq!(careless.closest_hit(*ray), balls[..].closest_hit(*ray));
        assert_eq!(careless.any_hit(*ray), balls[..].any_hit(*ray));
        assert_eq!(careless.multi_hit::<3>(*ray), balls[..].multi_hit::<3>(*ray));
    }
    let kernel = kernel!(|ray: Ray| (careless.closest_hit(ray), careless.multi_hit::<2>(ray)[1]));
    assert_variants_agree!(&kernel, &rays);
}

/// One that names nothing hides everything, on the host. What the structure leaves out is not hit.
#[test]
fn what_is_not_named_is_not_met() {
    let balls = [Ball { center: Vec3::ZERO, radius: 1.0 }];
    let blind = Accelerated::new(&balls, |_: &Ray, _: f32, _: &mut dyn FnMut(u32) -> f32| {});
    let ray = Ray::new(vec3(0.0, 0.0, -3.0), Vec3::Z);
    assert!(!blind.closest_hit(ray).is_hit && !blind.any_hit(ray));
    assert_eq!(blind.primitives().len(), 1);
}

/// What was found stays found: indexed triangles under a structure.
#[test]
fn primitives_that_share() {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1]].map(|vertices| IndexedTriangle { vertices });
    let all = Accelerated::sharing(
        &faces,
        &vertices,
        |_: &Ray, _: f32, meet: &mut dyn FnMut(u32) -> f32| {
            for id in 0..3 {
                meet(id);
            }
        },
    );
    let config = BuildConfig::default();
    let tree = Bvh::build_sharing(&faces, &vertices, &config).expect("finite bounds");
    let mut rng = Rng::of("sharing");
    let rays: Vec<(Ray,)> = (0..500)
        .map(|_| {
            let (from, to) = (rng.point(2.0), rng.point(0.5).abs());
            (Ray::new(from, to - from),)
        })
        .collect();
    for (ray,) in &rays {
        assert_eq!(all.closest_hit(*ray), tree.closest_hit(*ray));
    }
    let kernel = kernel!(|ray: Ray| all.closest_hit(ray));
    assert_variants_agree!(&kernel, &rays);
}
