//! Rays aimed at shared edges and vertices: the tree gives what a loop over all triangles gives.
//!
//! Such a ray meets several triangles at almost the same distance. Which of them is nearest is
//! decided by rounding; a traversal that culls a node a little too early gives another one.

use raydsl::bvh::BuildError;
use raydsl::prelude::*;
use raydsl_tests::queries::{
    Answers, closest_triangles, fill, hit_words, scalar_answers, slice_view,
};
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

/// Over all grids.
const RAYS: usize = 4_000_000;
const RAYS_OF_SCALAR_LOOPS: usize = 200_000;
const RAYS_OF_WGSL: usize = 400_000;
const RAYS_WITHOUT_SLACK: usize = 500_000;

/// Cells along an edge of a grid; 128 triangles, few enough for a loop over all of them.
const CELLS: usize = 8;

/// A flat grid of triangles that share vertices bit for bit.
struct Grid {
    name: &'static str,
    corner: Vec3,
    right: Vec3,
    up: Vec3,
}

impl Grid {
    fn vertex(&self, i: usize, j: usize) -> Vec3 {
        self.corner + self.right * i as f32 + self.up * j as f32
    }

    fn triangles(&self) -> Vec<Triangle> {
        let mut all = Vec::new();
        for j in 0..CELLS {
            for i in 0..CELLS {
                let [a, b] = [self.vertex(i, j), self.vertex(i + 1, j)];
                let [c, d] = [self.vertex(i, j + 1), self.vertex(i + 1, j + 1)];
                // Both diagonals occur.
                if (i + j) % 2 == 0 {
                    all.push(Triangle { v0: a, v1: b, v2: d });
                    all.push(Triangle { v0: a, v1: d, v2: c });
                } else {
                    all.push(Triangle { v0: a, v1: b, v2: c });
                    all.push(Triangle { v0: b, v1: d, v2: c });
                }
            }
        }
        all
    }

    fn size(&self) -> f32 {
        CELLS as f32 * self.right.length().max(self.up.length())
    }

    /// A vertex, or a point of an edge.
    fn target(&self, rng: &mut Rng) -> Vec3 {
        let [i, j] = [rng.below(CELLS), rng.below(CELLS)];
        let a = self.vertex(i, j);
        let b = match rng.below(4) {
            0 => return a,
            1 => self.vertex(i + 1, j),
            2 => self.vertex(i, j + 1),
            _ if (i + j) % 2 == 0 => self.vertex(i + 1, j + 1),
            _ => return a.midpoint(self.vertex(i, j + 1)),
        };
        a + (b - a) * rng.unit()
    }

    /// Whether a ray along the plane has coordinates without rounding.
    fn is_axis_aligned(&self) -> bool {
        let n = self.right.cross(self.up);
        [n.x, n.y, n.z].into_iter().filter(|c| *c != 0.0).count() == 1
    }

    fn ray(&self, rng: &mut Rng, kind: usize) -> Ray {
        let target = self.target(rng);
        let size = self.size();
        let axes = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
        match kind {
            // Parallel to an axis.
            0..3 => {
                let d = rng.pick(&axes);
                Ray::new(target - d * (size * rng.unit()), d)
            }
            // In the plane, along the grid's own directions or any other.
            3 => {
                let d = rng.pick(&[self.right, self.up, self.right + self.up, -self.right]);
                Ray::new(target - d * 3.0, d)
            }
            4 => {
                let d = self.right * rng.range(-1.0, 1.0) + self.up * rng.range(-1.0, 1.0);
                Ray::new(target - d * 2.5, d)
            }
            // Grazing.
            5 => {
                let along = self.right * rng.range(-4.0, 4.0) + self.up * rng.range(-4.0, 4.0);
                let d = along + self.right.cross(self.up) * rng.range(-0.01, 0.01);
                Ray::new(target - d, d)
            }
            // From far away.
            6 => {
                let origin = target + rng.direction() * (100.0 * size);
                Ray::new(origin, target - origin)
            }
            // From close by.
            7 => {
                let origin = target + rng.direction() * (0.01 * size);
                Ray::new(origin, target - origin)
            }
            // From anywhere, of unit length or not.
            n => {
                let origin = target + rng.direction() * (2.0 * size);
                let d = target - origin;
                Ray::new(origin, if n % 2 == 0 { d } else { d.normalize() })
            }
        }
    }

    /// Rays of every kind; of those in the plane only where that is exact, see
    /// `rays_in_a_tilted_plane`.
    fn rays(&self, count: usize) -> Vec<Ray> {
        let in_plane = self.is_axis_aligned();
        self.rays_of(count, |rng| match rng.below(16) {
            3 | 4 if !in_plane => 5,
            kind => kind,
        })
    }

    fn rays_of(&self, count: usize, kind: impl Fn(&mut Rng) -> usize + Sync) -> Vec<Ray> {
        let mut rays = vec![Ray::new(Vec3::ZERO, Vec3::Z); count];
        let seed = Rng::of(self.name).bits();
        fill(&mut rays, |first, part| {
            let mut rng = Rng::new(seed ^ first as u64);
            for ray in part {
                let kind = kind(&mut rng);
                *ray = self.ray(&mut rng, kind);
            }
        });
        rays
    }
}

fn grids() -> Vec<Grid> {
    let third = 1.0 / 3.0;
    let tilted = (vec3(0.31, 0.17, -0.23), vec3(-0.11, 0.37, 0.29));
    vec![
        grid("z = 0", vec3(-2.0, -2.0, 0.0), vec3(0.5, 0.0, 0.0), vec3(0.0, 0.5, 0.0)),
        grid("x = 2.7", vec3(2.7, -1.3, -0.9), vec3(0.0, third, 0.0), vec3(0.0, 0.0, third)),
        grid("y = -1.1", vec3(-0.7, -1.1, 0.3), vec3(0.37, 0.0, 0.0), vec3(0.0, 0.0, 0.41)),
        grid("tilted", vec3(-1.0, 0.5, 0.7), tilted.0, tilted.1),
        grid("tilted about one axis", vec3(-1.0, -1.0, 1.0), vec3(0.3, 0.0, 0.1), Vec3::Y * 0.3),
        grid("z = 0 at 1000", Vec3::splat(1000.1), vec3(0.37, 0.0, 0.0), vec3(0.0, 0.41, 0.0)),
        grid("tilted at 1000", vec3(1000.3, -999.7, 1001.1), tilted.0, tilted.1),
        grid("small at 1000", vec3(-1000.0, 1000.0, 1000.0), tilted.1 * 0.02, tilted.0 * 0.02),
    ]
}

const fn grid(name: &'static str, corner: Vec3, right: Vec3, up: Vec3) -> Grid {
    Grid { name, corner, right, up }
}

/// What a loop over all triangles gives, with the widest packets.
fn brute_force(triangles: &[Triangle], rays: Vec<Ray>) -> Answers {
    let closest = closest_triangles(slice_view(triangles), &rays);
    let any = closest.iter().map(|h| h.is_hit).collect();
    Answers { rays, closest, any }
}

#[test]
fn trees_give_what_loops_give_on_axes() -> Result<(), BuildError> {
    trees_give_what_loops_give(Grid::is_axis_aligned)
}

#[test]
fn trees_give_what_loops_give_tilted() -> Result<(), BuildError> {
    trees_give_what_loops_give(|grid| !grid.is_axis_aligned())
}

fn trees_give_what_loops_give(is_taken: fn(&Grid) -> bool) -> Result<(), BuildError> {
    let grids = grids();
    for grid in grids.iter().filter(|grid| is_taken(grid)) {
        let triangles = grid.triangles();
        let bvh = Bvh::build(&triangles)?;
        let truth = brute_force(&triangles, grid.rays(scaled(RAYS / grids.len())));
        assert!(truth.hits() * 2 > truth.rays.len(), "{}: {} hits", grid.name, truth.hits());
        truth.triangle_tree(grid.name, &bvh, RAYS_OF_WGSL / grids.len());
        let some = truth.first(scaled(RAYS_OF_SCALAR_LOOPS / grids.len()));
        // The loop of packets is itself checked against the scalar one.
        let scalar = scalar_answers(slice_view(&triangles), some.rays.clone());
        some.assert_closest("loop", &scalar.closest);
    }
    Ok(())
}

/// Rays within the plane of a tilted grid: whether they meet a triangle is decided by rounding
/// alone, and `Triangle::intersect` accepts some triangles far beside the ray.
#[test]
fn rays_in_a_tilted_plane() -> Result<(), BuildError> {
    for grid in grids().iter().filter(|g| !g.is_axis_aligned()) {
        let triangles = grid.triangles();
        let bvh = Bvh::build(&triangles)?;
        let truth = brute_force(&triangles, grid.rays_of(100_000, |rng| 3 + rng.below(2)));
        truth.triangle_tree(grid.name, &bvh, 1000);
    }
    Ok(())
}

/// A triangle for whose rounding nothing is allowed.
#[primitive]
struct Strict {
    v0: Vec3,
    v1: Vec3,
    v2: Vec3,
}

#[primitive]
impl Strict {
    const SLACK: f32 = 0.0;

    fn intersect(&self, ray: Ray) -> Hit {
        let t = Triangle { v0: self.v0, v1: self.v1, v2: self.v2 };
        t.intersect(ray)
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::from_points([self.v0, self.v1, self.v2])
    }
}

/// Without the allowance, trees do give something else: the test above can fail.
#[test]
fn without_slack_they_differ() -> Result<(), BuildError> {
    let grids = grids();
    let mut differing = 0;
    for grid in &grids {
        let triangles = grid.triangles();
        let strict: Vec<Strict> =
            triangles.iter().map(|t| Strict { v0: t.v0, v1: t.v1, v2: t.v2 }).collect();
        let bvh = Bvh::build(&strict)?;
        let truth = brute_force(&triangles, grid.rays(scaled(RAYS_WITHOUT_SLACK / grids.len())));
        let found = scalar_answers(bvh.view(), truth.rays.clone());
        let pairs = truth.closest.iter().zip(&found.closest);
        let here = pairs.filter(|(a, b)| hit_words(a) != hit_words(b)).count();
        println!("{}: {here} of {} rays differ without slack", grid.name, truth.rays.len());
        differing += here;
    }
    assert!(differing > 0, "slack makes no difference: these rays test nothing");
    Ok(())
}
