//! A volume: each rank has a brick of cells with a layer of neighbours, and rays are integrated brick
//! by brick.
//!
//! The part of a ray in a brick is that between the planes of the division, computed from them alone:
//! neighbours compute the same place, so that no part of a ray is missed or counted twice. The layer
//! of cells around a brick has the values for rays whose places are rounded beyond a plane. Within a
//! brick the exact cell integrator goes from cell face to cell face, as it does in the whole volume.

use core::ops::Range;

use glam::{UVec2, UVec3, Vec3, Vec4};
use raydsl::camera::{Camera, CameraRays};
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::volume::{ExactCell, Grid, GridConfig, TransferFunction, Volume, VolumeLight, Voxel};
use raydsl_examples::head::head_part;

use super::message::Fragments;
use super::{Divided, window};
use crate::args::Args;
use crate::divide::{Cut, DivideError, Division, Region};
use crate::run::Failure;

/// A box of a grid's cells: from the indices `first` to those before `end`.
struct Cells {
    first: UVec3,
    end: UVec3,
    grid: Placement,
}

/// Where samples are in the world: in the cube from -1 to 1, as those of a head.
#[derive(Clone, Copy)]
struct Placement {
    side: u32,
}

impl Placement {
    fn spacing(self) -> f32 {
        2.0 / self.side as f32
    }

    /// Returns the coordinate of a sample along each axis.
    fn at(self, index: u32) -> f32 {
        ((f64::from(index) + 0.5) * 2.0 / f64::from(self.side) - 1.0) as f32
    }

    fn place(self, index: UVec3) -> Vec3 {
        Vec3::from_array(index.to_array().map(|i| self.at(i)))
    }
}

impl Cut for Cells {
    /// Cuts the longest axis at a face of cells, as evenly as it goes.
    fn cut(self, first: u32, parts: u32) -> Result<(usize, f32, [Self; 2]), DivideError> {
        let axis = (self.end - self.first).max_position();
        let length = u64::from(self.end[axis] - self.first[axis]);
        if length < 2 {
            return Err(DivideError::TooMany { parts, items: length, what: "cells" });
        }
        let half = u64::from(parts / 2);
        let below = ((length * u64::from(first) + half) / u64::from(parts)).clamp(1, length - 1);
        let at = self.first[axis] + below as u32;
        let (mut end, mut begin) = (self.end, self.first);
        (end[axis], begin[axis]) = (at, at);
        let grid = self.grid;
        let sides =
            [Self { first: self.first, end, grid }, Self { first: begin, end: self.end, grid }];
        Ok((axis, grid.at(at), sides))
    }
}

/// Values, and their colours: skin, brain, bone.
const COLORS: [(f32, Vec3); 5] = [
    (60.0, Vec3::new(0.9, 0.55, 0.36)),
    (95.0, Vec3::new(0.85, 0.4, 0.3)),
    (125.0, Vec3::new(0.7, 0.2, 0.22)),
    (170.0, Vec3::new(0.95, 0.55, 0.4)),
    (210.0, Vec3::new(0.9, 0.92, 1.0)),
];

/// Values, and their extinctions per length of the world: thin skin, a dense brain, thin bone.
const EXTINCTIONS: [(f32, f32); 8] = [
    (55.0, 0.0),
    (72.0, 1.6),
    (90.0, 0.7),
    (115.0, 0.9),
    (128.0, 14.0),
    (172.0, 14.0),
    (190.0, 0.8),
    (215.0, 1.0),
];

/// Has a rank make its bricks, and runs `run` with them.
pub(super) fn with(
    args: &Args,
    parts: u32,
    own: Range<u32>,
    run: &mut dyn FnMut(&Bricks<'_>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let grid = Placement { side: args.voxels };
    let last = UVec3::splat(args.voxels - 1);
    let division = Division::new(Cells { first: UVec3::ZERO, end: last, grid }, parts)?;
    let transfer = TransferFunction::from_extinction(&COLORS, &EXTINCTIONS)?;
    let stored = own.map(|number| {
        let region = division.regions()[number as usize];
        Ok((number, region, brick(grid, &region)?))
    });
    let stored: Vec<(u32, Region, Grid<'static, u8>)> = stored.collect::<Result<_, Failure>>()?;
    let brick = |(number, region, grid): &(u32, Region, Grid<'static, u8>)| Brick {
        number: *number,
        region: *region,
        size: grid.size(),
    };
    let bricks = stored.iter().map(|part| (brick(part), Volume::new(&part.2, transfer.clone())));
    let whole = Aabb { min: grid.place(UVec3::ZERO), max: grid.place(last) };
    let integrator = ExactCell::new().least(args.least);
    run(&Bricks { bricks: bricks.collect(), division, whole, integrator })
}

/// Makes the samples of a region, and those one cell beyond its planes.
fn brick(grid: Placement, region: &Region) -> Result<Grid<'static, u8>, Failure> {
    let (mut first, mut last) = (UVec3::ZERO, UVec3::splat(grid.side - 1));
    for axis in 0..3 {
        // A plane is at a sample, to within rounding.
        let sample = |plane: f32| ((plane + 1.0) / grid.spacing() - 0.5).round() as u32;
        if region.low[axis].is_finite() {
            first[axis] = sample(region.low[axis]).saturating_sub(1);
        }
        if region.high[axis].is_finite() {
            last[axis] = (sample(region.high[axis]) + 1).min(grid.side - 1);
        }
    }
    let size = last - first + UVec3::ONE;
    let spacing = Vec3::splat(grid.spacing());
    let config = GridConfig::new().spacing(spacing).origin(grid.place(first));
    Ok(Grid::new(head_part(grid.side, first, size), size, config)?)
}

/// A brick of the volume.
struct Brick {
    number: u32,
    region: Region,
    /// Samples along each axis, those of the layer around it too.
    size: UVec3,
}

/// A rank's bricks.
pub(super) struct Bricks<'a> {
    bricks: Vec<(Brick, Volume<'a, u8>)>,
    division: Division,
    /// The box of the whole volume.
    whole: Aabb,
    integrator: ExactCell,
}

/// Returns where a ray is between two planes of an axis. A ray along them is between them or not;
/// of two neighbours one has it.
#[kernel]
fn between(origin: f32, direction: f32, low: f32, high: f32) -> (f32, f32) {
    let (a, b) = ((low - origin) / direction, (high - origin) / direction);
    let mut span = (min(a, b), max(a, b));
    if direction == 0.0 {
        let is_in = (low <= origin) & (origin < high);
        span = if is_in { (-f32::MAX, f32::MAX) } else { (f32::MAX, -f32::MAX) };
    }
    span
}

/// Returns the part of a ray in a region.
#[kernel]
fn in_region(ray: Ray, low: Vec3, high: Vec3) -> Ray {
    let (o, d) = (ray.origin, ray.direction);
    let (x0, x1) = between(o.x, d.x, low.x, high.x);
    let (y0, y1) = between(o.y, d.y, low.y, high.y);
    let (z0, z1) = between(o.z, d.z, low.z, high.z);
    let enter = max(max(x0, y0), max(z0, ray.t_min));
    let leave = min(min(x1, y1), min(z1, ray.t_max));
    ray.with_range(enter, max(enter, leave))
}

impl Divided for Bricks<'_> {
    /// Radiance and optical depth of a brick.
    type Fragment = [f32; 4];

    fn camera(&self, share: f32) -> Pinhole {
        let (sin, cos) = (core::f32::consts::TAU * (share + 0.08)).sin_cos();
        let eye = vec3(3.4 * sin, 3.4 * cos, 0.9);
        Pinhole::new(eye, vec3(0.0, 0.0, -0.05), Vec3::Z, 0.62)
    }

    fn render(
        &self,
        camera: &Pinhole,
        size: UVec2,
        rays: &mut u64,
    ) -> Vec<(u32, Fragments<[f32; 4]>)> {
        let mut all = Vec::new();
        for (brick, volume) in &self.bricks {
            let (low, high) = (brick.region.low, brick.region.high);
            let bounds = Aabb { min: low.max(self.whole.min), max: high.min(self.whole.max) };
            let Some((origin, window)) = window::of_box(camera, size, &bounds) else { continue };
            let integrator = self.integrator;
            let integrate = kernel!(|ray: Ray| {
                let part = in_region(ray, low, high);
                let light = volume.integrate(&integrator, part, VolumeLight::new());
                light.radiance.extend(light.depth)
            });
            let mut image = Image::filled(window.x, window.y, Vec4::ZERO);
            TiledScheduler::new().frame_window(camera, &integrate, size, origin, &mut image);
            *rays += u64::from(window.x) * u64::from(window.y);
            let mut fragments = Fragments::new();
            for (y, row) in (origin.y..).zip(image.rows()) {
                for (x, light) in (origin.x..).zip(row) {
                    // What absorbs nothing emits nothing; a NaN is kept, so that it is seen.
                    if light.w != 0.0 {
                        fragments.push(y * size.x + x, light.to_array());
                    }
                }
            }
            all.push((brick.number, fragments));
        }
        all
    }

    fn composite(
        &self,
        camera: &Pinhole,
        size: UVec2,
        band: Range<u32>,
        mut fragments: Vec<(u32, u32, [f32; 4])>,
    ) -> Vec<Vec3> {
        let orders: [Vec<u32>; 8] = core::array::from_fn(|signs| {
            let sign = |axis: u32| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 };
            self.division.visibility(vec3(sign(0), sign(1), sign(2)))
        });
        let rays = camera.begin_frame(size.x, size.y);
        let place = |part: u32, pixel: u32| {
            let (x, y) = (pixel % size.x, pixel / size.x);
            let signs =
                rays.primary_ray(x as f32 + 0.5, y as f32 + 0.5).direction.is_negative_bitmask();
            orders[signs as usize][part as usize]
        };
        fragments.sort_by_cached_key(|(part, pixel, _)| (*pixel, place(*part, *pixel)));
        let mut colors = vec![Vec3::ZERO; band.len()];
        for of_pixel in fragments.chunk_by(|(_, a, _), (_, b, _)| a == b) {
            let light =
                of_pixel.iter().fold(VolumeLight::new(), |light, (_, _, [r, g, b, depth])| {
                    light.then(vec3(*r, *g, *b), *depth)
                });
            colors[(of_pixel[0].1 - band.start) as usize] = light.radiance;
        }
        colors
    }

    fn bytes(&self) -> u64 {
        let samples = |(brick, _): &(Brick, Volume<'_, u8>)| {
            brick.size.to_array().iter().map(|n| u64::from(*n)).product::<u64>()
        };
        let each = size_of::<<u8 as Voxel>::Stored>() as u64;
        self.bricks.iter().map(samples).sum::<u64>() * each
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn division(side: u32, parts: u32) -> Division {
        let cells =
            Cells { first: UVec3::ZERO, end: UVec3::splat(side - 1), grid: Placement { side } };
        Division::new(cells, parts).expect("there are more cells than parts")
    }

    /// The ends of one part of a ray are the beginnings of others, to the bit, also of rays in planes.
    #[test]
    fn parts_of_a_ray_fit_together() {
        let mut rng = Rng::new(UVec2::ZERO, 3, 8);
        for parts in [1, 2, 3, 7, 16] {
            let division = division(24, parts);
            let mut planes = division.regions().iter().flat_map(|r| r.low.to_array());
            let plane = planes.find(|c| c.is_finite()).unwrap_or(0.0);
            for i in 0..300 {
                let mut ray = Ray::new(rng.next_3d() * 6.0 - 3.0, rng.next_3d() - 0.5);
                for axis in 0..3 {
                    if i & 1 << axis != 0 {
                        (ray.direction[axis], ray.origin[axis]) = (0.0, plane);
                    }
                }
                if ray.direction == Vec3::ZERO {
                    continue;
                }
                let mut spans: Vec<(f32, f32)> = division
                    .regions()
                    .iter()
                    .map(|r| in_region(ray, r.low, r.high))
                    .map(|part| (part.t_min, part.t_max))
                    .filter(|(enter, leave)| enter < leave)
                    .collect();
                spans.sort_by(|a, b| a.0.total_cmp(&b.0));
                assert_eq!(spans.first().map(|s| s.0), Some(ray.t_min), "{ray:?}");
                assert_eq!(spans.last().map(|s| s.1), Some(ray.t_max), "{ray:?}");
                assert!(spans.windows(2).all(|pair| pair[0].1 == pair[1].0), "{ray:?} {spans:?}");
            }
        }
    }

    #[test]
    fn bricks_are_small_parts_of_the_volume() {
        let (side, parts) = (33, 8);
        let grid = Placement { side };
        let whole = head_part(side, UVec3::ZERO, UVec3::splat(side));
        for region in division(side, parts).regions() {
            let brick = brick(grid, region).expect("a brick");
            // Half of the cells along each axis, and a layer at one side.
            assert_eq!(brick.size(), UVec3::splat(18));
            let at = grid.at(16);
            assert!(region.low.x == at || region.high.x == at);
            let config = GridConfig::new()
                .spacing(Vec3::splat(grid.spacing()))
                .origin(grid.place(UVec3::ZERO));
            let whole = Grid::new(&whole[..], UVec3::splat(side), config).expect("a grid");
            let p =
                region.low.max(Vec3::splat(-0.9)) * 0.5 + region.high.min(Vec3::splat(0.9)) * 0.5;
            let apart = (brick.value(p) - whole.value(p)).abs();
            assert!(apart < 1e-2, "{apart} at {p}");
        }
    }

    #[test]
    fn more_parts_than_cells_are_refused() {
        let cells = Cells { first: UVec3::ZERO, end: UVec3::splat(2), grid: Placement { side: 3 } };
        let error = Division::new(cells, 9).expect_err("eight cells");
        assert!(error.to_string().contains("--parts"), "{error}");
    }
}
