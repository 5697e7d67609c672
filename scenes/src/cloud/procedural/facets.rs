//! The landscape as triangles, for rays.

use raydsl::prelude::*;

use super::noise::{hash, unit};
use super::paint::Paint;
use super::shape::{Shape, V3, add, times};
use super::terrain::{Terrain, WATER};
use super::{Grid, Piece, Scene, even};

/// Squares along a side of a tile of ground.
const SQUARES: usize = 10;
/// Sides of a tube.
const SIDES: u32 = 8;
/// Leaves on a square metre of foliage, and their size in metres. A leaf stands for a tuft of small
/// ones.
const LEAVES: f64 = 6.0;
const LEAF: f64 = 0.4;

/// What a triangle of the landscape belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cover {
    /// Land, water and roads.
    Ground,
    /// Houses, bridges, and whatever else people made.
    Built,
    /// Trunks.
    Wood,
    /// Tufts of leaves.
    Leaves,
}

impl Cover {
    fn of(paint: Paint) -> Self {
        match paint {
            Paint::Ground | Paint::Soil | Paint::Road => Self::Ground,
            Paint::Bark(_) => Self::Wood,
            Paint::Leaves(_) => Self::Leaves,
            _ => Self::Built,
        }
    }
}

/// The landscape as triangles, in metres with z up, sorted by their [`Cover`].
#[derive(Clone, Debug)]
pub struct Facets {
    /// The triangles.
    pub triangles: Vec<Triangle>,
    /// The index of the first triangle that is built, that is wood, and that is leaves.
    first: [usize; 3],
}

impl Facets {
    /// Sorts triangles by their cover.
    pub fn new(mut covered: Vec<(Cover, Triangle)>) -> Self {
        covered.sort_by_key(|(cover, _)| *cover);
        let first = [Cover::Built, Cover::Wood, Cover::Leaves]
            .map(|cover| covered.partition_point(|(c, _)| *c < cover));
        Self { triangles: covered.into_iter().map(|(_, triangle)| triangle).collect(), first }
    }

    /// Returns what the triangle of this index belongs to.
    pub fn cover(&self, index: usize) -> Cover {
        let [built, wood, leaves] = self.first;
        match index {
            i if i < built => Cover::Ground,
            i if i < wood => Cover::Built,
            i if i < leaves => Cover::Wood,
            _ => Cover::Leaves,
        }
    }

    /// Returns the index of the first triangle that is leaves; all that follow are, too.
    pub fn first_leaf(&self) -> u32 {
        self.first[2] as u32
    }
}

/// Makes the landscape of [`procedural`](super::procedural) of the same `seed` as triangles: ground
/// in squares of a metre, houses as they are, and foliage as tufts of leaves that rays pass between.
///
/// # Examples
///
/// ```
/// # use raydsl_scenes::cloud::{Cover, facets};
/// let land = facets(7);
/// assert_eq!(land.cover(0), Cover::Ground);
/// assert!((land.first_leaf() as usize) < land.triangles.len());
/// ```
pub fn facets(seed: u64) -> Facets {
    let terrain = Terrain { seed: hash(seed, 0x5eed) };
    let relief = Grid::from_fn(|x, y| terrain.height(x, y));
    let scene = Scene::new(terrain.seed, &relief);
    let mut covered = Vec::new();
    for (i, piece) in scene.pieces.iter().enumerate() {
        let cover = Cover::of(piece.paint);
        let triangles = tessellated(&terrain, piece, hash(terrain.seed, i as u64));
        covered.extend(triangles.into_iter().map(|triangle| (cover, triangle)));
    }
    Facets::new(covered)
}

fn tessellated(terrain: &Terrain, piece: &Piece, seed: u64) -> Vec<Triangle> {
    match piece.shape {
        Shape::Ground { corner, side } => grid((SQUARES, SQUARES), |a, b| {
            let (x, y) = (corner[0] + a * side, corner[1] + b * side);
            [x, y, terrain.height(x, y).max(WATER)]
        }),
        Shape::Quad { origin, u, v } => {
            grid((1, 1), |a, b| add(origin, add(times(u, a), times(v, b))))
        }
        Shape::Triangle { origin, u, v } => {
            vec![triangle(origin, add(origin, u), add(origin, v))]
        }
        Shape::Tube { base, radius, height, taper } => grid((SIDES as usize, 1), |a, b| {
            let (sin, cos) = (a * std::f64::consts::TAU).sin_cos();
            let r = radius * (1.0 - b * (1.0 - taper));
            add(base, [r * cos, r * sin, b * height])
        }),
        Shape::Crown { .. } | Shape::Tiers { .. } => foliage(piece, seed),
    }
}

fn triangle(v0: V3, v1: V3, v2: V3) -> Triangle {
    let [v0, v1, v2] = [v0, v1, v2].map(|v| Vec3::from(v.map(|x| x as f32)));
    Triangle { v0, v1, v2 }
}

/// A surface over the unit square.
fn grid((m, n): (usize, usize), at: impl Fn(f64, f64) -> V3) -> Vec<Triangle> {
    let corner = |i: usize, j: usize| at(i as f64 / m as f64, j as f64 / n as f64);
    let squares = (0..n).flat_map(|j| (0..m).map(move |i| (i, j)));
    let halves = |(i, j): (usize, usize)| {
        let (low, high) = (corner(i, j), corner(i + 1, j + 1));
        [triangle(low, corner(i + 1, j), high), triangle(low, high, corner(i, j + 1))]
    };
    squares.flat_map(halves).collect()
}

/// Leaves on a piece's surface, turned at random.
fn foliage(piece: &Piece, seed: u64) -> Vec<Triangle> {
    let count = (piece.area * LEAVES).ceil() as usize;
    let leaf = |j: usize| {
        let (a, b) = even(j, count, seed);
        let center = piece.shape.spot(a, b, seed).position;
        let id = hash(seed ^ 0x1eaf, j as u64);
        // Corners at random around the centre; on average they are LEAF from each other.
        let corner = |k: u64| {
            let aside = |axis| (2.0 * unit(id, 3 * k + axis) - 1.0) * LEAF;
            add(center, [aside(0), aside(1), aside(2)])
        };
        triangle(corner(0), corner(1), corner(2))
    };
    (0..count).map(leaf).collect()
}
