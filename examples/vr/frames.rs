//! The picture of an eye, and how long it takes.

use std::time::{Duration, Instant};

use raydsl::camera::CameraError;
use raydsl::kernel;
use raydsl::kernel::Variant;
use raydsl::prelude::*;
use raydsl::render::{Fragment, composite};
use raydsl_examples::rasterizer::{Corner, NOTHING, Rasterizer, RasterizerError};
use raydsl_report::{Compare, Comparison};

use crate::head::{BehindScreen, Eye};
use crate::light::{MIRROR, traced};
use crate::plant::{Part, plant};

/// Everything that is seen.
pub(crate) struct World {
    pub(crate) lamp: Vec3,
    pub(crate) parts: Vec<Part>,
    pub(crate) drawn: Vec<[Corner; 3]>,
}

impl World {
    pub(crate) fn new() -> Self {
        let lamp = vec3(2.0, 3.6, 3.4);
        let mut parts = plant(11);
        parts.extend(mirror());
        Self { lamp, parts, drawn: crate::drawn::triangles(lamp) }
    }

    /// Returns the rasterised triangles for rays, and the colour of each.
    pub(crate) fn for_rays(&self) -> (Vec<Triangle>, Vec<Vec3>) {
        let triangle =
            |t: &[Corner; 3]| Triangle { v0: t[0].place, v1: t[1].place, v2: t[2].place };
        let color = |t: &[Corner; 3]| (t[0].color + t[1].color + t[2].color) / 3.0;
        (self.drawn.iter().map(triangle).collect(), self.drawn.iter().map(color).collect())
    }
}

/// A mirror behind the plant.
fn mirror() -> [Part; 2] {
    let at = |x: f32, y: f32| vec3(x, y, -1.7 + 0.12 * x);
    let [a, b, c, d] = [at(-1.9, 0.02), at(1.9, 0.02), at(1.9, 2.9), at(-1.9, 2.9)];
    let part = |v0, v1, v2| Part { v0, v1, v2, st: [Vec2::ZERO; 3], kind: MIRROR };
    [part(a, b, c), part(a, c, d)]
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error(transparent)]
    Head(#[from] BehindScreen),
    #[error(transparent)]
    Camera(#[from] CameraError),
    #[error(transparent)]
    Rasterizer(#[from] RasterizerError),
}

/// Times of a picture: of the rasteriser, of rays, and of putting both together.
pub(crate) type Times = [Duration; 3];

/// Trees and what draws beside them.
pub(crate) struct Hybrid<'a> {
    pub(crate) world: &'a World,
    pub(crate) plant: &'a Bvh<'a, Part>,
    pub(crate) drawn: &'a Bvh<'a, Triangle>,
    pub(crate) colors: &'a [Vec3],
    pub(crate) rasterizer: &'a Rasterizer,
}

impl Hybrid<'_> {
    /// Renders what an eye sees.
    pub(crate) fn frame(
        &self,
        eye: &Eye,
        (width, height): (u32, u32),
        variant: Variant,
    ) -> Result<(Image<Fragment>, Times), Failure> {
        let Self { world, plant, drawn, colors, rasterizer } = *self;
        let start = Instant::now();
        // ANCHOR: frame
        let camera = eye.camera()?;
        let before = rasterizer.draw(&world.drawn, eye.clip(), (width, height))?;
        let drawn_in = start.elapsed();

        let (window, lamp) = (camera.begin_frame(width, height), world.lamp);
        let pixels = before.pixels();
        let kernel = kernel!(|ray: Ray, pixel: UVec2| {
            let before = pixels[(pixel.y * width + pixel.x) as usize];
            traced(plant, drawn, colors, lamp, window, before, ray)
        });
        let mut rays = Image::filled(width, height, NOTHING);
        TiledScheduler::new().variant(variant).frame(&camera, &kernel, &mut rays);
        let traced_in = start.elapsed();

        // What rays see hides the rasteriser's pixels, or is hidden by them.
        for (front, back) in rays.pixels_mut().iter_mut().zip(before.pixels()) {
            *front = composite(*front, *back);
        }
        // ANCHOR_END: frame
        let times = [drawn_in, traced_in - drawn_in, start.elapsed() - traced_in];
        Ok((rays, times))
    }

    /// Compares the variants of the rays' kernel for an eye.
    pub(crate) fn compare(
        &self,
        eye: &Eye,
        (width, height): (u32, u32),
        variants: &raydsl::kernel::Variants,
        runs: u16,
    ) -> Result<Comparison<Fragment>, Failure> {
        let Self { world, plant, drawn, colors, rasterizer } = *self;
        let camera = eye.camera()?;
        let before = rasterizer.draw(&world.drawn, eye.clip(), (width, height))?;
        let (window, lamp) = (camera.begin_frame(width, height), world.lamp);
        let pixels = before.pixels();
        let kernel = kernel!(|ray: Ray, pixel: UVec2| {
            let before = pixels[(pixel.y * width + pixel.x) as usize];
            traced(plant, drawn, colors, lamp, window, before, ray)
        });
        let compare = Compare::new().size(width, height).runs(runs.into()).variants(variants);
        Ok(compare.run(&kernel, &camera))
    }
}
