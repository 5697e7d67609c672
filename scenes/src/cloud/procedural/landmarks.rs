//! The bridge, the castle and the cut around the land.

use super::Scene;
use super::building::{Frame, Gable, block, gabled, walls};
use super::paint::Paint;
use super::shape::{Shape, add, times};
use super::terrain::{CASTLE, CUT, HALF, Terrain, WATER, to_world};

/// The bridge's stone, in sRGB.
const STONE: [u8; 3] = [176, 166, 148];

/// A stone bridge where the road meets the river.
pub(super) fn bridge(scene: &mut Scene) {
    // The crossing solves river(road(t)) = t; the map contracts, a few rounds do.
    let t = (0..40).fold(-30.0, |t, _| 0.5 * (t + Terrain::river(Terrain::road(t))));
    let (x, y) = to_world(Terrain::road(t), t);
    let slope = Terrain::road(t + 0.5) - Terrain::road(t - 0.5);
    let turn = std::f64::consts::FRAC_PI_4 - slope.atan();
    let (sin, cos) = turn.sin_cos();
    let f = Frame { origin: [x, y, WATER], along: [cos, sin, 0.0], side: [-sin, cos, 0.0] };
    let paint = Paint::Stone(STONE);
    let deck = |a: f64| 3.1 + 1.3 * (1.0 - (a / 15.0).powi(2));
    let strips = 40;
    let width = 30.0 / f64::from(strips);
    for k in 0..strips {
        let a = -15.0 + width * f64::from(k);
        let (low, high) = (deck(a), deck(a + width));
        let surface = f.vector(width, 0.0, high - low);
        let origin = f.at(a, -2.4, low);
        scene.push(Shape::Quad { origin, u: surface, v: f.vector(0.0, 4.8, 0.0) }, Paint::Road);
        // Two arches of 11 m leave a pier in the middle.
        let from_pier = (a + 0.5 * width).abs() - 6.2;
        let arch = 3.0 * (1.0 - (from_pier / 5.0).powi(2)).max(0.0).sqrt() - 0.3;
        for (b, way) in [(-2.4, 1.0), (2.4, -1.0)] {
            let origin = f.at(if way > 0.0 { a } else { a + width }, b, arch);
            let v = [0.0, 0.0, low + 0.9 - arch];
            scene.push(Shape::Quad { origin, u: times(surface, way), v }, paint);
        }
    }
}

/// The cut faces around the land, as of a model on a table.
pub(super) fn cut(scene: &mut Scene) {
    let n = 80;
    let width = 2.0 * HALF / f64::from(n);
    let terrain = scene.terrain;
    let mut face = |from: (f64, f64), to: (f64, f64)| {
        let top = |(x, y): (f64, f64)| terrain.height(x, y).max(WATER) - CUT;
        let (low, high) = (top(from), top(to));
        // The two triangles of a face whose upper edge follows the ground.
        let corner = [from.0, from.1, CUT];
        let u = [to.0 - from.0, to.1 - from.1, 0.0];
        scene.push(Shape::Triangle { origin: corner, u, v: [0.0, 0.0, low] }, Paint::Soil);
        let up = [-u[0], -u[1], low - high];
        let origin = add(corner, [u[0], u[1], high]);
        scene.push(Shape::Triangle { origin, u: up, v: [0.0, 0.0, -high] }, Paint::Soil);
    };
    for i in 0..n {
        let (a, b) = (f64::from(i) * width - HALF, f64::from(i + 1) * width - HALF);
        face((a, -HALF), (b, -HALF));
        face((b, HALF), (a, HALF));
        face((-HALF, b), (-HALF, a));
        face((HALF, a), (HALF, b));
    }
}

/// A keep, a curtain wall and four round towers on the hill.
pub(super) fn castle(scene: &mut Scene) {
    let f = Frame::new(&scene.terrain, CASTLE, 0.35, 12.0);
    let stone = Paint::Stone([188, 176, 154]);
    let roof = Paint::Tiles([138, 62, 50]);
    let half = (12.0, 10.0);
    walls(scene, &f, half, (-2.0, 7.0), stone);
    merlons(scene, &f, half, 7.0, stone);
    for (a, b) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let base = f.at(a * half.0, b * half.1, -3.0);
        scene.push(Shape::Tube { base, radius: 2.6, height: 13.5, taper: 0.94 }, stone);
        let cap = add(base, [0.0, 0.0, 13.4]);
        scene.push(Shape::Tube { base: cap, radius: 3.1, height: 5.4, taper: 0.0 }, roof);
    }
    let keep = Frame { origin: f.at(2.5, 2.0, 0.0), ..f };
    block(scene, &keep, (4.6, 4.0), (0.0, 16.0), Paint::Wall([198, 186, 164]));
    merlons(scene, &keep, (4.6, 4.0), 16.0, stone);
    let hall = Frame { origin: f.at(-5.5, -3.5, 0.0), ..f };
    let wall = Paint::Wall([214, 202, 180]);
    gabled(scene, &hall, Gable { half: (4.6, 3.2), eaves: 6.0, ridge: 10.0, wall, roof });
    scene.keep_clear(CASTLE, 17.0);
}

fn merlons(scene: &mut Scene, f: &Frame, (a, b): (f64, f64), z: f64, paint: Paint) {
    let gap = 1.8;
    let along =
        |half: f64| (0..(2.0 * half / gap) as usize).map(move |i| gap * (i as f64 + 0.5) - half);
    let mut tooth = |p: f64, q: f64| {
        let at = Frame { origin: f.at(p, q, 0.0), ..*f };
        block(scene, &at, (0.45, 0.45), (z, z + 1.0), paint);
    };
    for p in along(a) {
        tooth(p, b);
        tooth(p, -b);
    }
    for q in along(b) {
        tooth(a, q);
        tooth(-a, q);
    }
}
