//! A texture that the application owns, and kernels that have a light reference to it.

use raydsl::kernel;
use raydsl::prelude::*;

/// How the texels lie; they themselves are a slice of the application's.
#[derive(Clone, Copy, Debug, Type)]
pub(crate) struct Grid {
    /// Texels in a row.
    pub(crate) width: u32,
    /// Rows.
    pub(crate) height: u32,
}

/// The nearest texel: `uv` from 0 to 1, repeated outside.
#[kernel]
pub(crate) fn tex2(texels: &[Vec3], grid: Grid, uv: Vec2) -> Vec3 {
    let (u, v) = (uv.x - uv.x.floor(), uv.y - uv.y.floor());
    let x = min((u * grid.width as f32) as u32, grid.width - 1);
    let y = min((v * grid.height as f32) as u32, grid.height - 1);
    texels[(y * grid.width + x) as usize]
}

/// A floor with the texture on it, seen along each ray.
#[kernel]
pub(crate) fn floor(texels: &[Vec3], grid: Grid, ray: Ray) -> Vec3 {
    let t = -ray.origin.y / ray.direction.y;
    let p = ray.at(t);
    let sky = vec3(0.6, 0.7, 0.9);
    if t > 0.0 && t < 100.0 { tex2(texels, grid, vec2(p.x, p.z) * 0.25) } else { sky }
}

/// Tiles of two colours.
pub(crate) fn tiles() -> (Vec<Vec3>, Grid) {
    let grid = Grid { width: 8, height: 8 };
    let tile = |i: u32| match (i % 8 / 4 + i / 8 / 4) % 2 {
        0 => vec3(0.9, 0.9, 0.8),
        _ => vec3(0.2, 0.3, 0.25),
    };
    ((0..grid.width * grid.height).map(tile).collect(), grid)
}
