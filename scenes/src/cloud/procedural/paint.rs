//! Surface colours before light.

use super::light::Grid;
use super::noise::{fractal, mix, noise2, smoothstep};
use super::shape::{Spot, V3};
use super::terrain::{Crop, Field, Terrain, WATER, to_view};

/// A surface's material; the colours are sRGB.
#[derive(Clone, Copy)]
pub(super) enum Paint {
    Ground,
    Wall([u8; 3]),
    Timbered([u8; 3]),
    Tiles([u8; 3]),
    Stone([u8; 3]),
    Road,
    Straw,
    Soil,
    Leaves([u8; 3]),
    Bark([u8; 3]),
}

const GLASS: [u8; 3] = [58, 70, 88];
const FRAME: [u8; 3] = [244, 240, 230];
const BEAM: [u8; 3] = [88, 58, 40];

/// sRGB to linear light, by the square that the encoder's square root undoes.
fn linear(c: [u8; 3]) -> V3 {
    c.map(|c| (f64::from(c) / 255.0).powi(2))
}

fn scale(c: V3, k: f64) -> V3 {
    c.map(|c| c * k)
}

fn blend(a: V3, b: V3, t: f64) -> V3 {
    std::array::from_fn(|i| mix(a[i], b[i], t))
}

impl Paint {
    /// Whether light shines through.
    pub(super) fn translucent(self) -> bool {
        matches!(self, Paint::Leaves(_))
    }

    /// Linear albedo at a spot; `grain` in `0.0..1.0` belongs to the point.
    pub(super) fn albedo(self, terrain: &Terrain, relief: &Grid, spot: &Spot, grain: f64) -> V3 {
        let [u, v] = spot.local;
        let speckle = 0.9 + 0.2 * grain;
        match self {
            Paint::Ground => ground(terrain, relief, spot, grain),
            Paint::Wall(c) => scale(linear(wall(c, u, v)), speckle),
            Paint::Timbered(c) => scale(linear(timbered(c, u, v)), speckle),
            Paint::Tiles(c) => {
                // Each row of tiles is darker at its upper edge, each tile has its own tone.
                let row = v / 0.42;
                let tone = noise2(terrain.seed ^ 0x61, (u / 0.7).floor() * 1.7, row.floor() * 1.3);
                let edge = 1.0 - 0.3 * smoothstep(0.55, 1.0, row.fract());
                scale(linear(c), edge * (1.0 + 0.22 * tone) * speckle)
            }
            Paint::Stone(c) => {
                let tone = noise2(
                    terrain.seed ^ 0x62,
                    (u / 0.9 + 0.5 * (v / 0.5).floor()).floor() * 1.9,
                    (v / 0.5).floor() * 1.7,
                );
                scale(linear(c), (1.0 + 0.25 * tone) * speckle)
            }
            Paint::Road => scale(linear([190, 174, 146]), speckle),
            Paint::Straw => scale(linear([220, 188, 112]), 0.8 + 0.3 * grain),
            Paint::Soil => scale(soil(terrain, spot), speckle),
            Paint::Bark(c) => scale(linear(c), 0.75 + 0.5 * grain),
            Paint::Leaves(c) => {
                // Low and inner leaves get less light from the leaves around them.
                let depth = (0.42 + 0.58 * smoothstep(0.0, 0.75, u)) * (0.5 + 0.62 * v);
                scale(linear(c), depth * (0.72 + 0.56 * grain))
            }
        }
    }
}

/// Plaster with windows in every storey.
fn wall(color: [u8; 3], u: f64, v: f64) -> [u8; 3] {
    let (across, up) = ((u / 2.3).fract() * 2.3 - 1.15, (v / 2.9).fract() * 2.9 - 1.65);
    if v < 0.7 {
        return color.map(|c| (f64::from(c) * 0.8) as u8);
    }
    match (across.abs(), up.abs()) {
        (x, y) if x < 0.42 && y < 0.62 => GLASS,
        (x, y) if x < 0.6 && y < 0.8 => FRAME,
        _ => color,
    }
}

fn timbered(color: [u8; 3], u: f64, v: f64) -> [u8; 3] {
    let plain = wall(color, u, v);
    let post = (u / 2.3).fract() * 2.3;
    let rail = (v / 2.9).fract() * 2.9;
    let brace = ((u - v) / 2.3).fract() * 2.3;
    let beam = post < 0.24 || rail < 0.26 || (brace < 0.22 && rail < 1.0);
    if beam { BEAM } else { plain }
}

fn ground(terrain: &Terrain, relief: &Grid, spot: &Spot, grain: f64) -> V3 {
    let [x, y, z] = spot.position;
    let (s, t) = to_view(x, y);
    let depth = WATER - relief.get(x, y);
    if depth > 0.0 {
        return water(terrain, x, y, depth, grain);
    }
    let mut c = grass(terrain, x, y);
    let forest = terrain.forest(x, y);
    c = blend(c, linear([92, 84, 56]), 0.7 * forest);
    if let Some(field) = terrain.field(s, t) {
        c = crop(c, &field);
    }
    let trodden = Terrain::village_cover(s, t)
        * smoothstep(-0.1, 0.5, fractal(terrain.seed ^ 0x63, x / 9.0, y / 9.0, 3));
    c = blend(c, linear([170, 148, 112]), 0.75 * trodden);
    let steep = smoothstep(
        0.80,
        0.66,
        spot.normal[2] + 0.05 * noise2(terrain.seed ^ 0x64, x / 2.0, y / 2.0),
    );
    let strata = 0.5 + 0.5 * noise2(terrain.seed ^ 0x65, x / 6.0 + y / 9.0, z / 1.1);
    c = blend(c, blend(linear([128, 120, 108]), linear([172, 162, 146]), strata), steep);
    c = blend(c, linear([198, 184, 146]), smoothstep(0.75, 0.25, z - WATER));
    let rut = 1.0 - 0.18 * smoothstep(0.35, 0.1, (Terrain::road_distance(s, t) - 0.8).abs());
    c = blend(c, scale(linear([200, 182, 150]), rut), Terrain::road_cover(s, t));
    scale(c, 0.84 + 0.32 * grain)
}

/// Layers of earth that sag with the ground above them.
fn soil(terrain: &Terrain, spot: &Spot) -> V3 {
    let [x, y, z] = spot.position;
    let depth = terrain.height(x, y).max(WATER) - z;
    let bend = 0.8 * noise2(terrain.seed ^ 0x69, (x + y) / 9.0, (x - y) / 9.0);
    if depth < 0.5 {
        return linear([84, 66, 48]);
    }
    let layer = 0.5 + 0.5 * noise2(terrain.seed ^ 0x6a, 0.0, (0.55 * z + bend) / 0.8);
    blend(linear([122, 92, 66]), linear([176, 142, 104]), layer)
}

/// Deep water is dark and reflects the sky; shallows show the bed.
fn water(terrain: &Terrain, x: f64, y: f64, depth: f64, grain: f64) -> V3 {
    let deep = smoothstep(0.0, 1.3, depth);
    let (s, t) = to_view(x, y);
    let ripple = noise2(terrain.seed ^ 0x66, s / 2.4, t / 0.9);
    let c = blend(linear([122, 158, 150]), linear([54, 112, 142]), deep);
    let glint = smoothstep(0.62, 0.9, ripple + 0.25 * grain) * 0.35;
    blend(scale(c, 1.0 + 0.18 * ripple), [0.75, 0.82, 0.88], glint * deep)
}

fn grass(terrain: &Terrain, x: f64, y: f64) -> V3 {
    let wide = 0.5 + 0.5 * fractal(terrain.seed ^ 0x67, x / 30.0, y / 30.0, 3);
    let fine = 0.5 + 0.5 * fractal(terrain.seed ^ 0x68, x / 2.6, y / 2.6, 2);
    let lush = blend(linear([92, 132, 58]), linear([124, 154, 66]), fine);
    let dry = blend(linear([150, 154, 80]), linear([172, 164, 92]), fine);
    blend(lush, dry, smoothstep(0.45, 0.85, wide))
}

fn crop(grass: V3, field: &Field) -> V3 {
    let wave = |pitch: f64| 0.5 + 0.5 * (field.across / pitch * std::f64::consts::TAU).sin();
    let c = match field.crop {
        Crop::Wheat => blend(linear([206, 172, 88]), linear([228, 198, 116]), wave(1.9)),
        Crop::Ploughed => blend(linear([112, 80, 58]), linear([154, 114, 84]), wave(1.3)),
        Crop::Cabbage => {
            blend(linear([118, 92, 64]), linear([104, 158, 72]), smoothstep(0.25, 0.7, wave(1.5)))
        }
        Crop::Lavender => {
            blend(linear([122, 128, 84]), linear([140, 104, 190]), smoothstep(0.2, 0.6, wave(1.7)))
        }
        Crop::Meadow => {
            let flower = noise2(7, field.across * 1.7, field.along * 1.7);
            let tint = if flower > 0.72 { linear([238, 216, 92]) } else { linear([132, 168, 74]) };
            blend(grass, tint, 0.8)
        }
        Crop::Orchard => scale(grass, 1.05),
    };
    blend(grass, c, smoothstep(0.7, 1.5, field.border))
}
