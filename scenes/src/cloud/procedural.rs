//! A landscape made in code: what an aerial laser scan of a village might hold.

mod building;
mod facets;
mod landmarks;
mod light;
mod noise;
mod paint;
mod plants;
mod shape;
mod terrain;
mod village;

pub use self::facets::{Cover, Facets, facets};

use std::ops::Range;

use raydsl_io::cloud::PointCloud;
use rayon::prelude::*;

use self::light::{Grid, Light};
use self::noise::{hash, unit};
use self::paint::Paint;
use self::shape::{Shape, Spot, normalize};
use self::terrain::{HALF, Terrain, WATER};

/// Points that one task makes, and the step in which progress is told.
const CHUNK: usize = 1 << 15;
const REPORT: usize = 1 << 20;
/// Ground is divided into squares of this side.
const TILE: f64 = 10.0;

/// A surface, its material and its area in square metres.
struct Piece {
    shape: Shape,
    paint: Paint,
    area: f64,
}

/// Everything that points are spread over.
struct Scene {
    terrain: Terrain,
    pieces: Vec<Piece>,
    /// Discs of ground that belong to a building, in view coordinates.
    occupied: Vec<((f64, f64), f64)>,
}

/// A scene with what a point's colour depends on.
struct Studio {
    scene: Scene,
    relief: Grid,
    light: Light,
    /// `first[i]` is the index of piece `i`'s first point; one more entry ends the list.
    first: Vec<usize>,
}

/// Makes a cloud of exactly `points` points: fields, a river with a bridge, a village with
/// a church, wooded hills and a castle, about 200 m x 200 m with z up. Light and shadow are
/// baked into the colours.
///
/// The points are spread evenly, in proportion to the area of the surfaces. The same
/// `points` and `seed` give the same cloud, whatever the number of threads; each point is a
/// function of its index alone, so nothing but the result is held. `progress` is told the
/// number of points made.
///
/// # Examples
///
/// ```
/// # use raydsl_scenes::cloud::procedural;
/// let cloud = procedural(1000, 7, &mut |_| {});
/// assert_eq!(cloud.positions.len(), 1000);
/// assert_eq!(cloud.colors.len(), 1000);
/// ```
pub fn procedural(points: usize, seed: u64, progress: &mut dyn FnMut(u64)) -> PointCloud {
    let landscape = Landscape::new(points, seed);
    let mut cloud = PointCloud { positions: vec![[0.0; 3]; points], colors: vec![[0; 3]; points] };
    let blocks = cloud.positions.chunks_mut(REPORT).zip(cloud.colors.chunks_mut(REPORT));
    for (block, (positions, colors)) in blocks.enumerate() {
        landscape.fill(block * REPORT, positions, colors);
        progress((block * REPORT + positions.len()) as u64);
    }
    cloud
}

/// The cloud that [`procedural`] makes, point by point: for programs that keep only some of them.
pub struct Landscape {
    studio: Studio,
    points: usize,
}

impl std::fmt::Debug for Landscape {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Landscape").field("points", &self.points).finish_non_exhaustive()
    }
}

impl Landscape {
    /// Half the side of the square of land, in metres; its middle is the origin.
    pub const HALF: f64 = HALF;

    /// Creates what the points are spread over.
    pub fn new(points: usize, seed: u64) -> Self {
        Self { studio: Studio::new(points, hash(seed, 0x5eed)), points }
    }

    /// Returns the points of a range of indices; those that do not exist are left out.
    pub fn part(&self, indices: Range<usize>) -> PointCloud {
        let end = indices.end.min(self.points);
        let count = end.saturating_sub(indices.start);
        let mut cloud =
            PointCloud { positions: vec![[0.0; 3]; count], colors: vec![[0; 3]; count] };
        self.fill(indices.start, &mut cloud.positions, &mut cloud.colors);
        cloud
    }

    /// Makes the points from index `start` on.
    fn fill(&self, start: usize, positions: &mut [[f64; 3]], colors: &mut [[u8; 3]]) {
        positions
            .par_chunks_mut(CHUNK)
            .zip(colors.par_chunks_mut(CHUNK))
            .enumerate()
            .for_each(|(i, (p, c))| self.studio.fill(start + i * CHUNK, p, c));
    }
}

impl Scene {
    fn new(seed: u64, relief: &Grid) -> Self {
        let mut scene =
            Self { terrain: Terrain { seed }, pieces: Vec::new(), occupied: Vec::new() };
        scene.ground(relief);
        landmarks::cut(&mut scene);
        village::church(&mut scene);
        landmarks::castle(&mut scene);
        landmarks::bridge(&mut scene);
        village::houses(&mut scene);
        plants::avenue(&mut scene);
        plants::trees(&mut scene);
        plants::fields(&mut scene);
        scene
    }

    fn ground(&mut self, relief: &Grid) {
        let n = (2.0 * HALF / TILE) as usize;
        for i in 0..n * n {
            let corner = [(i % n) as f64 * TILE - HALF, (i / n) as f64 * TILE - HALF];
            let shape = Shape::Ground { corner, side: TILE };
            let area = shape.area() * mean_stretch(relief, corner);
            self.pieces.push(Piece { shape, paint: Paint::Ground, area });
        }
    }
}

/// How much larger a tile's surface is than its floor plan.
fn mean_stretch(relief: &Grid, corner: [f64; 2]) -> f64 {
    let n = 5;
    let at = |k: usize| (k as f64 + 0.5) * TILE / n as f64;
    let stretch = |k: usize| {
        let [a, b] = relief.gradient(corner[0] + at(k % n), corner[1] + at(k / n));
        (1.0 + a * a + b * b).sqrt()
    };
    (0..n * n).map(stretch).sum::<f64>() / (n * n) as f64
}

/// Point `j` of the additive sequence on the plastic number, which fills the unit square
/// evenly for every prefix, jittered a little so that no rows show.
fn even(j: usize, count: usize, seed: u64) -> (f64, f64) {
    let jitter = 0.5 / (count as f64).sqrt();
    let at = |step: f64, k: u64| {
        let offset = unit(seed, k) + jitter * unit(seed, 2 * j as u64 + k);
        (offset + j as f64 * step).fract()
    };
    (at(0.754_877_666_246_692_8, 1), at(0.569_840_290_998_053_3, 2))
}

impl Studio {
    fn new(points: usize, seed: u64) -> Self {
        let terrain = Terrain { seed };
        let relief = Grid::from_fn(|x, y| terrain.height(x, y));
        let scene = Scene::new(seed, &relief);
        let light = Light::bake(&surface(&scene, &relief));
        let total: f64 = scene.pieces.iter().map(|p| p.area).sum();
        let mut below = 0.0;
        let mut first = vec![0];
        for piece in &scene.pieces {
            below += piece.area;
            first.push(((below / total) * points as f64).round() as usize);
        }
        if let Some(last) = first.last_mut() {
            *last = points;
        }
        Self { scene, relief, light, first }
    }

    /// Makes the points from index `start` on.
    fn fill(&self, start: usize, positions: &mut [[f64; 3]], colors: &mut [[u8; 3]]) {
        // The last piece that begins at or before `start`: empty ones before it are passed.
        let mut piece = self.first.partition_point(|&f| f <= start) - 1;
        for (k, (p, c)) in positions.iter_mut().zip(colors).enumerate() {
            let index = start + k;
            while index >= self.first[piece + 1] {
                piece += 1;
            }
            (*p, *c) = self.point(piece, index);
        }
    }

    fn point(&self, piece: usize, index: usize) -> ([f64; 3], [u8; 3]) {
        let (terrain, first) = (&self.scene.terrain, self.first[piece]);
        let Piece { shape, paint, .. } = &self.scene.pieces[piece];
        let seed = hash(terrain.seed, piece as u64);
        let (a, b) = even(index - first, self.first[piece + 1] - first, seed);
        let mut spot = shape.spot(a, b, seed);
        if let Shape::Ground { .. } = shape {
            self.settle(&mut spot);
        }
        let albedo = paint.albedo(terrain, &self.relief, &spot, terrain.grain(index as u64));
        let color = self.light.shade(spot.position, spot.normal, albedo, paint.translucent());
        (spot.position, color)
    }

    /// Puts a ground point on the land, or on the water above it.
    fn settle(&self, spot: &mut Spot) {
        let [x, y, _] = spot.position;
        let z = self.scene.terrain.height(x, y);
        spot.position[2] = z.max(WATER);
        if z > WATER {
            let [a, b] = self.relief.gradient(x, y);
            spot.normal = normalize([-a, -b, 1.0]);
        }
    }
}

/// Height of the topmost surface. The pieces are splatted with samples of their own, four
/// to a node, which needs no second description of their geometry.
fn surface(scene: &Scene, relief: &Grid) -> Grid {
    let mut top = relief.clone();
    for (i, piece) in scene.pieces.iter().enumerate() {
        if let Shape::Ground { .. } = piece.shape {
            continue;
        }
        let count = (piece.area * 36.0) as usize + 1;
        let seed = hash(scene.terrain.seed ^ 0xd1, i as u64);
        for j in 0..count {
            let (a, b) = even(j, count, seed);
            top.raise(piece.shape.spot(a, b, hash(scene.terrain.seed, i as u64)).position);
        }
    }
    top
}
