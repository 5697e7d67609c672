//! A landscape of points: each rank has those between its planes, and the nearest hit wins.

use core::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{UVec2, Vec3};
use raydsl::error::BuildError;
use raydsl::geometry::sphere;
use raydsl::math::Unorm8;
use raydsl::prelude::*;
use raydsl_examples::cloud::Landscape;

use super::message::Fragments;
use super::{Divided, window};
use crate::args::Args;
use crate::divide::{Cut, DivideError, Division, Region};
use crate::run::Failure;

/// A point, as a sphere.
#[primitive]
#[derive(Debug)]
struct Point {
    center: Vec3,
    radius: f32,
    /// Red, green and blue.
    color: [Unorm8; 4],
}

#[primitive]
impl Point {
    const SLACK: f32 = sphere::SLACK;

    fn intersect(&self, ray: Ray) -> Hit {
        sphere::intersect(ray, self.center, self.radius)
    }

    fn get_bounds(&self) -> Aabb {
        sphere::get_bounds(self.center, self.radius)
    }
}

#[raydsl::kernel]
impl Point {
    fn rgb(&self) -> Vec3 {
        let color = self.color;
        vec3(color[0].to_f32(), color[1].to_f32(), color[2].to_f32())
    }
}

/// What a ray meets first among the points of a part.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Nearest {
    t: f32,
    /// The point's index among all points.
    id: u32,
    color: [f32; 3],
}

/// Which landscape.
const SEED: u64 = 7;
/// Points that are made together, of which a rank keeps its own.
const CHUNK: usize = 1 << 16;
/// Points by which planes are chosen.
const SAMPLE: usize = 1 << 14;
/// The area of all surfaces in square metres, over which points are spread.
const AREA: f64 = 8e4;
/// The radius of points over their spacing, with which surfaces look closed.
const CLOSED: f64 = 0.8;
const SKY: Vec3 = Vec3::new(0.62, 0.75, 0.9);

/// The points of a part, in the order of their indices: of two at one distance, the first one is
/// the same in every division.
struct Part {
    number: u32,
    points: Vec<Point>,
    indices: Vec<u32>,
}

/// Has a rank make its points, and runs `run` with them.
pub(super) fn with(
    args: &Args,
    parts: u32,
    own: Range<u32>,
    run: &mut dyn FnMut(&Cloud<'_>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let count = args.points as usize;
    let landscape = Landscape::new(count, SEED);
    let division = Division::new(sample(&landscape, count), parts)?;
    let parts = make(&landscape, count, own, division.regions());
    let built = parts.iter().filter(|part| !part.points.is_empty());
    let built = built.map(|part| Ok((part, Bvh::build(&part.points)?)));
    run(&Cloud { parts: built.collect::<Result<_, BuildError>>()? })
}

/// A sample of points, by which planes are chosen: the same on all ranks.
struct Sample(Vec<Vec3>);

fn sample(landscape: &Landscape, count: usize) -> Sample {
    let step = count.div_ceil(SAMPLE);
    let each = (0..count).step_by(step);
    Sample(each.flat_map(|i| landscape.part(i..i + 1).positions).map(in_f32).collect())
}

fn in_f32(p: [f64; 3]) -> Vec3 {
    Vec3::from_array(p.map(|c| c as f32))
}

impl Cut for Sample {
    /// Cuts the longest axis, so that as many points are on each side as parts are.
    fn cut(self, first: u32, parts: u32) -> Result<(usize, f32, [Self; 2]), DivideError> {
        let Self(mut points) = self;
        if points.len() < parts as usize {
            let items = points.len() as u64;
            return Err(DivideError::TooMany { parts, items, what: "sampled points" });
        }
        let low = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let axis = (high - low).max_position();
        points.sort_by(|a, b| a[axis].total_cmp(&b[axis]));
        let middle = points.len() * first as usize / parts as usize;
        let above = points.split_off(middle);
        Ok((axis, above[0][axis], [Self(points), Self(above)]))
    }
}

/// Makes all points chunk by chunk, and keeps those of own regions.
fn make(landscape: &Landscape, count: usize, own: Range<u32>, regions: &[Region]) -> Vec<Part> {
    let radius = (CLOSED * (AREA / count as f64).sqrt()) as f32;
    let mut parts: Vec<Part> =
        own.map(|number| Part { number, points: Vec::new(), indices: Vec::new() }).collect();
    for start in (0..count).step_by(CHUNK) {
        let chunk = landscape.part(start..(start + CHUNK).min(count));
        for (i, (position, color)) in chunk.positions.iter().zip(&chunk.colors).enumerate() {
            let center = in_f32(*position);
            let is_in = |part: &&mut Part| regions[part.number as usize].contains(center);
            let Some(part) = parts.iter_mut().find(is_in) else { continue };
            let [r, g, b] = color.map(Unorm8::from_bits);
            part.points.push(Point { center, radius, color: [r, g, b, Unorm8::from_bits(255)] });
            part.indices.push((start + i) as u32);
        }
    }
    parts
}

/// A rank's points.
pub(super) struct Cloud<'a> {
    parts: Vec<(&'a Part, Bvh<'a, Point>)>,
}

impl Divided for Cloud<'_> {
    type Fragment = Nearest;

    fn camera(&self, share: f32) -> Pinhole {
        let (sin, cos) = (core::f32::consts::TAU * (share + 0.14)).sin_cos();
        let half = Landscape::HALF as f32;
        let eye = vec3(-cos * 1.9 * half, -sin * 1.9 * half, 1.1 * half);
        Pinhole::new(eye, vec3(0.0, 0.0, -0.05 * half), Vec3::Z, 0.68)
    }

    fn render(
        &self,
        camera: &Pinhole,
        size: UVec2,
        rays: &mut u64,
    ) -> Vec<(u32, Fragments<Nearest>)> {
        let mut all = Vec::new();
        for (part, bvh) in &self.parts {
            let Some((origin, window)) = window::of_box(camera, size, &bvh.bounds()) else {
                continue;
            };
            let primary = kernel!(|ray: Ray| {
                let hit = bvh.closest_hit(ray);
                let color = if hit.is_hit { bvh.primitive(hit).rgb() } else { Vec3::ZERO };
                let id = if hit.is_hit { hit.prim_id } else { u32::MAX };
                Shaded { color, depth: hit.t, id }
            });
            let mut image = Image::new(window.x, window.y);
            TiledScheduler::new().frame_window(camera, &primary, size, origin, &mut image);
            *rays += u64::from(window.x) * u64::from(window.y);
            let mut fragments = Fragments::new();
            for (y, row) in (origin.y..).zip(image.rows()) {
                for (x, pixel) in (origin.x..).zip(row) {
                    // A miss has an id that no point has.
                    let Some(id) = part.indices.get(pixel.id as usize) else { continue };
                    let (t, color) = (pixel.depth, pixel.color.to_array());
                    fragments.push(y * size.x + x, Nearest { t, id: *id, color });
                }
            }
            all.push((part.number, fragments));
        }
        all
    }

    fn composite(
        &self,
        _camera: &Pinhole,
        _size: UVec2,
        band: Range<u32>,
        fragments: Vec<(u32, u32, Nearest)>,
    ) -> Vec<Vec3> {
        let mut nearest: Vec<Option<Nearest>> = vec![None; band.len()];
        for (_, pixel, found) in fragments {
            let best = &mut nearest[(pixel - band.start) as usize];
            let is_nearer = |best: &Nearest| (found.t, found.id) < (best.t, best.id);
            if best.as_ref().is_none_or(is_nearer) {
                *best = Some(found);
            }
        }
        let color = |found: Option<Nearest>| found.map_or(SKY, |found| found.color.into());
        nearest.into_iter().map(color).collect()
    }

    fn bytes(&self) -> u64 {
        let bytes = |(part, bvh): &(&Part, Bvh<'_, Point>)| {
            size_of_val(&part.points[..]) + size_of_val(&part.indices[..]) + bvh.bytes()
        };
        self.parts.iter().map(bytes).sum::<usize>() as u64
    }
}
