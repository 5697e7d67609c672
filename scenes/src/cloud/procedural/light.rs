//! Baked light: cast shadows and sky occlusion from one height map of the whole scene.

use super::noise::smoothstep;
use super::shape::{V3, dot, normalize};
use super::terrain::HALF;

/// Nodes along a side of the maps; a node every third of a metre.
const SIDE: usize = 601;
const STEP: f64 = 2.0 * HALF / (SIDE - 1) as f64;
/// Direction to the sun: late afternoon, from the left of the suggested view.
const SUN: V3 = [-0.70, 0.10, 0.52];
const SUN_COLOR: [f64; 3] = [1.42, 1.24, 0.98];
const SKY_COLOR: [f64; 3] = [0.46, 0.53, 0.66];
const GROUND_COLOR: [f64; 3] = [0.20, 0.19, 0.14];

/// A square grid of values over the land.
#[derive(Clone)]
pub(super) struct Grid(Vec<f32>);

impl Grid {
    /// Evaluates `f` at every node.
    pub(super) fn from_fn(f: impl Fn(f64, f64) -> f64) -> Self {
        let at = |i: usize| i as f64 * STEP - HALF;
        let value = |k: usize| f(at(k % SIDE), at(k / SIDE)) as f32;
        Self((0..SIDE * SIDE).map(value).collect())
    }

    /// Bilinear interpolation, clamped at the border.
    pub(super) fn get(&self, x: f64, y: f64) -> f64 {
        let split = |c: f64| {
            let g = ((c + HALF) / STEP).clamp(0.0, (SIDE - 1) as f64 - 1e-6);
            (g as usize, g.fract())
        };
        let ((i, fx), (j, fy)) = (split(x), split(y));
        let row = |j: usize| {
            let (a, b) = (self.0[j * SIDE + i], self.0[j * SIDE + i + 1]);
            f64::from(a) + f64::from(b - a) * fx
        };
        let (a, b) = (row(j), row(j + 1));
        a + (b - a) * fy
    }

    /// Slope in x and y.
    pub(super) fn gradient(&self, x: f64, y: f64) -> [f64; 2] {
        let e = STEP;
        [
            (self.get(x + e, y) - self.get(x - e, y)) / (2.0 * e),
            (self.get(x, y + e) - self.get(x, y - e)) / (2.0 * e),
        ]
    }

    /// Raises the node nearest to a point to the point's height.
    pub(super) fn raise(&mut self, p: V3) {
        let node = |c: f64| ((c + HALF) / STEP).round();
        let (i, j) = (node(p[0]), node(p[1]));
        let inside = 0.0..SIDE as f64;
        if inside.contains(&i) && inside.contains(&j) {
            let cell = &mut self.0[j as usize * SIDE + i as usize];
            *cell = cell.max(p[2] as f32);
        }
    }

    /// Box blur with a radius in nodes.
    fn blurred(&self, radius: usize) -> Self {
        let pass = |from: &[f32], stride: usize, across: usize| {
            let mut out = vec![0.0; from.len()];
            for line in 0..SIDE {
                blur_line(from, &mut out, line * across, stride, radius);
            }
            out
        };
        Self(pass(&pass(&self.0, 1, SIDE), SIDE, 1))
    }
}

/// Running mean along one line of a grid, with its end values repeated.
fn blur_line(from: &[f32], out: &mut [f32], start: usize, stride: usize, radius: usize) {
    let at = |i: isize| {
        let i = i.clamp(0, SIDE as isize - 1) as usize;
        f64::from(from[start + i * stride])
    };
    let r = radius as isize;
    let mut sum: f64 = (-r..=r).map(at).sum();
    for i in 0..SIDE as isize {
        out[start + i as usize * stride] = (sum / (2 * radius + 1) as f64) as f32;
        sum += at(i + r + 1) - at(i - r);
    }
}

/// The light that reaches a point.
pub(super) struct Light {
    sun: V3,
    /// Height below which the sun is hidden, for every place.
    shadow: Grid,
    near: Grid,
    far: Grid,
}

impl Light {
    /// Bakes the maps from the height of the topmost surface.
    pub(super) fn bake(surface: &Grid) -> Self {
        let sun = normalize(SUN);
        Self {
            sun,
            shadow: shadow(surface, sun),
            near: surface.blurred(4),
            far: surface.blurred(17),
        }
    }

    /// Lit colour of a surface. `albedo` is linear; `translucent` surfaces (foliage) pass
    /// light on and have no hard dark side.
    pub(super) fn shade(&self, p: V3, n: V3, albedo: [f64; 3], translucent: bool) -> [u8; 3] {
        let z = p[2];
        // Maps are read in front of the surface: a wall's own node holds its roof.
        let shadow = self.shadow.get(p[0] + 0.75 * n[0], p[1] + 0.75 * n[1]);
        let (x, y) = (p[0] + 1.6 * n[0], p[1] + 1.6 * n[1]);
        let visible = smoothstep(-0.55, 0.25, z + 0.25 - shadow);
        let facing = dot(n, self.sun);
        let direct = if translucent { (0.35 + 0.65 * facing).max(0.08) } else { facing.max(0.0) };
        let buried =
            0.16 * (self.near.get(x, y) - z).max(0.0) + 0.07 * (self.far.get(x, y) - z).max(0.0);
        let open = 1.0 / (1.0 + buried);
        let up = 0.5 + 0.5 * n[2];
        std::array::from_fn(|c| {
            let sky = (SKY_COLOR[c] * up + GROUND_COLOR[c] * (1.0 - up)) * open;
            encode(albedo[c] * (SUN_COLOR[c] * direct * visible + sky))
        })
    }
}

/// Sweeps away from the sun: a node's shadow is what its neighbour towards the sun casts,
/// lowered by the sun's slope. The neighbour lies between two nodes of the next column;
/// interpolating there widens the shadow's edge with distance, as a penumbra does.
fn shadow(surface: &Grid, sun: V3) -> Grid {
    let mut out = surface.clone();
    let drift = sun[1] / sun[0].abs();
    let drop = (STEP * sun[2] / sun[0].abs()) as f32;
    for i in 0..SIDE {
        for j in 0..SIDE {
            let from = if sun[0] < 0.0 { i.checked_sub(1) } else { Some(i + 1) };
            let Some(column) = from.filter(|&c| c < SIDE) else {
                out.0[j * SIDE + i] = f32::MIN;
                continue;
            };
            let y = (j as f64 + drift).clamp(0.0, (SIDE - 1) as f64 - 1e-6);
            let (row, f) = (y as usize, y.fract() as f32);
            let top = |r: usize| surface.0[r * SIDE + column].max(out.0[r * SIDE + column]);
            let (a, b) = (top(row), top(row + 1));
            out.0[j * SIDE + i] = a + (b - a) * f - drop;
        }
    }
    out
}

/// Linear light to an 8-bit display value. A square root is close enough to sRGB's curve;
/// the shoulder keeps sunlit walls from clipping.
fn encode(linear: f64) -> u8 {
    let toned = linear * (1.0 + linear / 2.6) / (1.0 + linear);
    (toned.sqrt().min(1.0) * 255.0 + 0.5) as u8
}
