//! Point sets of the unit square above, what warps make of one below.

use raydsl::prelude::*;
use raydsl::sampling::{radical_inverse, van_der_corput};

/// Edge of a panel in pixels, the margin around it included.
const PANEL: u32 = 200;
/// The margin.
const MARGIN: u32 = 8;
/// How many points a panel shows.
const COUNT: u32 = 256;

/// A square of the picture, with coordinates from 0 to 1.
struct Panel<'a> {
    image: &'a mut Image,
    left: f32,
    bottom: f32,
}

impl Panel<'_> {
    const SIZE: f32 = (PANEL - 2 * MARGIN) as f32;

    /// A lattice of `n` by `n` cells.
    fn lattice(&mut self, n: u32) {
        for line in 0..=n {
            for step in 0..=Self::SIZE as u32 {
                let (a, b) = (line as f32 / n as f32, step as f32 / Self::SIZE);
                self.paint(vec2(a, b), vec3(0.86, 0.88, 0.9), 0.5);
                self.paint(vec2(b, a), vec3(0.86, 0.88, 0.9), 0.5);
            }
        }
    }

    /// A disk of a radius in pixels.
    fn paint(&mut self, p: Vec2, color: Vec3, radius: f32) {
        let (x, y) = (self.left + p.x * Self::SIZE, self.bottom + p.y * Self::SIZE);
        let width = self.image.width();
        for j in (y - radius) as u32..=(y + radius) as u32 {
            for i in (x - radius) as u32..=(x + radius) as u32 {
                let distance = vec2(i as f32 + 0.5 - x, j as f32 + 0.5 - y).length();
                let cover = (radius + 0.5 - distance).clamp(0.0, 1.0);
                let pixel = &mut self.image.pixels_mut()[(j * width + i) as usize].color;
                *pixel = pixel.lerp(color, cover);
            }
        }
    }
}

// ANCHOR: sets
fn sampled(method: SampleMethod, i: u32) -> Vec2 {
    Sampler::new(uvec2(3, 5), 0, i, COUNT, method).next_2d()
}

/// Random, stratified, Halton's, scrambled Sobol.
const SETS: [fn(u32) -> Vec2; 4] = [
    |i| sampled(SampleMethod::Random, i),
    |i| sampled(SampleMethod::Stratified, i),
    |i| vec2(van_der_corput(i), radical_inverse(3, i)),
    |i| sampled(SampleMethod::Sobol, i),
];

/// A disk; the hemisphere from above, evenly and by the tenth power of the cosine; a triangle.
const WARPS: [fn(Vec2) -> Vec2; 4] = [
    |u| sample_concentric_disk(u) * 0.5 + 0.5,
    |u| sample_uniform_hemisphere(u).xy() * 0.5 + 0.5,
    |u| sample_power_cosine(u, 10.0).xy() * 0.5 + 0.5,
    sample_triangle,
];
// ANCHOR_END: sets

pub(crate) fn picture() -> Image {
    let white = Shaded { color: Vec3::ONE, ..Shaded::default() };
    let mut image = Image::filled(4 * PANEL, 2 * PANEL, white);
    for column in 0..4u32 {
        let left = (column * PANEL + MARGIN) as f32;
        let upper = (PANEL + MARGIN) as f32;
        let mut above = Panel { image: &mut image, left, bottom: upper };
        above.lattice(16);
        for i in 0..COUNT {
            above.paint(SETS[column as usize](i), vec3(0.05, 0.25, 0.5), 2.0);
        }
        let mut below = Panel { image: &mut image, left, bottom: MARGIN as f32 };
        below.lattice(1);
        for i in 0..4 * COUNT {
            let u = sampled(SampleMethod::Sobol, i);
            let color = vec3(u.x, 0.35, 1.0 - u.y) * 0.8;
            below.paint(WARPS[column as usize](u), color, 1.5);
        }
    }
    image
}
