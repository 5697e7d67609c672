//! Trees, hedges and what stands on the fields.

use super::Scene;
use super::noise::{hash, range, unit};
use super::paint::Paint;
use super::shape::Shape;
use super::terrain::{Crop, HALF, Terrain, to_view, to_world};

/// Distance between places where a tree may stand.
const PITCH: f64 = 3.9;
const BARK: [u8; 3] = [96, 74, 56];
const SPRUCE: [[u8; 3]; 4] = [[42, 78, 50], [54, 92, 56], [36, 68, 54], [66, 98, 54]];
const LEAVES: [[u8; 3]; 6] =
    [[96, 138, 54], [78, 122, 50], [118, 150, 60], [142, 152, 58], [196, 138, 48], [188, 92, 44]];

fn color(colors: &[[u8; 3]], h: u64) -> Paint {
    Paint::Leaves(colors[(h % colors.len() as u64) as usize])
}

fn trunk(scene: &mut Scene, base: [f64; 3], radius: f64, height: f64) {
    let shape = Shape::Tube { base, radius, height, taper: 0.7 };
    scene.push(shape, Paint::Bark(BARK));
}

fn conifer(scene: &mut Scene, base: [f64; 3], seed: u64) {
    let height = range(seed, 1, 6.5, 12.5);
    let radius = height * range(seed, 2, 0.2, 0.26);
    trunk(scene, base, 0.22, 1.4);
    let base = [base[0], base[1], base[2] + 0.9];
    scene.push(Shape::Tiers { base, radius, height }, color(&SPRUCE, hash(seed, 3)));
}

fn broadleaf(scene: &mut Scene, base: [f64; 3], size: f64, seed: u64) {
    let paint = color(&LEAVES, hash(seed, 3));
    trunk(scene, base, 0.12 * size, 1.3 * size);
    let top = base[2] + 1.9 * size;
    let main = [size, size, size * 0.95];
    scene.push(Shape::Crown { center: [base[0], base[1], top], radii: main }, paint);
    for i in 0..3u64 {
        let (sin, cos) = (range(seed, 10 + i, 0.0, 1.6) + 2.1 * i as f64).sin_cos();
        let r = size * range(seed, 20 + i, 0.5, 0.72);
        let center = [
            base[0] + 0.62 * size * cos,
            base[1] + 0.62 * size * sin,
            top + size * range(seed, 30 + i, -0.35, 0.45),
        ];
        scene.push(Shape::Crown { center, radii: [r, r, r * 0.9] }, paint);
    }
}

fn poplar(scene: &mut Scene, base: [f64; 3], seed: u64) {
    let height = range(seed, 1, 8.5, 11.5);
    trunk(scene, base, 0.22, 2.0);
    let center = [base[0], base[1], base[2] + 1.0 + 0.5 * height];
    let radii = [1.15, 1.15, 0.5 * height];
    scene.push(Shape::Crown { center, radii }, color(&LEAVES[..3], hash(seed, 3)));
}

fn bush(scene: &mut Scene, base: [f64; 3], size: f64, seed: u64) {
    let center = [base[0], base[1], base[2] + 0.5 * size];
    let radii = [size, size, 0.85 * size];
    scene.push(Shape::Crown { center, radii }, color(&LEAVES[..3], hash(seed, 3)));
}

fn ground(terrain: &Terrain, x: f64, y: f64) -> [f64; 3] {
    [x, y, terrain.height(x, y) - 0.1]
}

/// Places in the square, jittered off a grid, with an id each.
fn places(seed: u64, pitch: f64) -> impl Iterator<Item = (f64, f64, u64)> {
    let n = (2.0 * (HALF - 2.0) / pitch) as u64;
    (0..n * n).map(move |i| {
        let id = hash(seed, i);
        let jitter = |k| (unit(id, k) - 0.5) * 0.85;
        let at = |c: u64, k| (c as f64 + 0.5 + jitter(k)) * pitch - HALF + 2.0;
        (at(i % n, 1), at(i / n, 2), id)
    })
}

/// Forests on the hills, trees along the river and in the gardens.
pub(super) fn trees(scene: &mut Scene) {
    let terrain = scene.terrain;
    for (x, y, id) in places(terrain.seed ^ 0x81, PITCH) {
        let (s, t) = to_view(x, y);
        let river = Terrain::river_distance(s, t).abs();
        let free = scene.is_clear((s, t), 2.2) && Terrain::road_distance(s, t) > 4.0;
        if !free || river < 10.0 || terrain.field(s, t).is_some() {
            continue;
        }
        let base = ground(&terrain, x, y);
        let forest = terrain.forest(x, y);
        let chance = unit(id, 5);
        let garden = 0.10 * Terrain::village_cover(s, t);
        let bank = if river < 14.5 { 0.26 } else { 0.015 };
        if chance < 0.93 * forest {
            if unit(id, 6) < 0.8 {
                conifer(scene, base, id);
            } else {
                broadleaf(scene, base, range(id, 7, 1.6, 2.6), id);
            }
        } else if chance < garden + bank {
            broadleaf(scene, base, range(id, 7, 1.3, 2.5), id);
        }
    }
}

/// Poplars along the road in front of the bridge.
pub(super) fn avenue(scene: &mut Scene) {
    let terrain = scene.terrain;
    for i in 0..16u64 {
        let t = -126.0 + 9.5 * (i / 2) as f64;
        let s = Terrain::road(t) + if i % 2 == 0 { 4.0 } else { -4.0 };
        let (x, y) = to_world(s, t);
        let inside = x.abs().max(y.abs()) < HALF - 2.0;
        if inside && Terrain::river_distance(s, t) < -13.0 {
            let base = ground(&terrain, x, y);
            poplar(scene, base, hash(terrain.seed ^ 0x91, i));
        }
    }
}

/// Hedges on field borders, orchard trees in rows, bales on the stubble.
pub(super) fn fields(scene: &mut Scene) {
    let terrain = scene.terrain;
    for (x, y, id) in places(terrain.seed ^ 0xa1, 1.5) {
        let (s, t) = to_view(x, y);
        let Some(field) = terrain.field(s, t) else {
            continue;
        };
        let base = ground(&terrain, x, y);
        // Stretches of hedge: present or not by blocks of about 20 m.
        let stretch = hash(
            terrain.seed ^ 0xb1,
            ((x / 19.0).floor() as i64 as u64) << 20 ^ ((y / 19.0).floor() as i64 as u64),
        );
        if field.border < 0.8 && stretch % 5 < 3 {
            bush(scene, base, range(id, 7, 0.7, 1.15), id);
            if id.is_multiple_of(17) {
                broadleaf(scene, base, range(id, 8, 1.5, 2.3), id);
            }
        } else if field.crop == Crop::Wheat && field.border > 3.0 && id % 97 < 1 {
            let base = [x, y, base[2]];
            let bale = Shape::Tube { base, radius: 0.8, height: 1.2, taper: 1.0 };
            scene.push(bale, Paint::Straw);
            let lid =
                Shape::Tube { base: [x, y, base[2] + 1.2], radius: 0.8, height: 0.1, taper: 0.0 };
            scene.push(lid, Paint::Straw);
        }
    }
    orchards(scene);
}

fn orchards(scene: &mut Scene) {
    let terrain = scene.terrain;
    let pitch = 4.6;
    let n = (2.0 * HALF / pitch) as u64;
    for i in 0..n * n {
        let x = (i % n) as f64 * pitch - HALF + 2.0;
        let y = (i / n) as f64 * pitch - HALF + 2.0;
        let (s, t) = to_view(x, y);
        let planted =
            terrain.field(s, t).is_some_and(|f| f.crop == Crop::Orchard && f.border > 2.0);
        if planted {
            let id = hash(terrain.seed ^ 0xc1, i);
            broadleaf(scene, ground(&terrain, x, y), range(id, 7, 1.05, 1.35), id);
        }
    }
}
