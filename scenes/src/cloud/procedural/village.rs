//! Houses and the church.

use super::Scene;
use super::building::{Frame, Gable, block, gabled, pyramid};
use super::noise::{hash, range, unit};
use super::paint::Paint;
use super::shape::{Shape, add};
use super::terrain::{Terrain, VILLAGE};

/// Wall and roof colours that houses draw from, in sRGB.
const WALLS: [[u8; 3]; 6] = [
    [236, 226, 205],
    [228, 203, 160],
    [240, 234, 224],
    [214, 172, 128],
    [225, 190, 172],
    [199, 205, 202],
];
const ROOFS: [[u8; 3]; 5] =
    [[178, 76, 48], [160, 62, 44], [192, 96, 58], [146, 70, 56], [120, 84, 72]];
const SLATE: [u8; 3] = [92, 98, 112];
const STONE: [u8; 3] = [176, 166, 148];
const WHITE: [u8; 3] = [240, 236, 226];

fn pick<const N: usize>(colors: [[u8; 3]; N], h: u64) -> [u8; 3] {
    colors[(h % N as u64) as usize]
}

fn house(scene: &mut Scene, place: (f64, f64), angle: f64, seed: u64) {
    let half = (range(seed, 1, 4.2, 6.4), range(seed, 2, 3.2, 4.2));
    let eaves = if unit(seed, 3) < 0.45 { 5.4 } else { 3.4 };
    let ridge = eaves + half.1 * range(seed, 4, 0.95, 1.25);
    let f = Frame::new(&scene.terrain, place, angle, 5.0);
    let wall = pick(WALLS, hash(seed, 5));
    let timbered = unit(seed, 6) < 0.4;
    let wall = if timbered { Paint::Timbered(WALLS[2]) } else { Paint::Wall(wall) };
    let roof = Paint::Tiles(pick(ROOFS, hash(seed, 7)));
    gabled(scene, &f, Gable { half, eaves, ridge, wall, roof });
    let chimney = Frame { origin: f.at(half.0 * 0.5, half.1 * 0.3, 0.0), ..f };
    let brick = Paint::Stone([150, 84, 66]);
    block(scene, &chimney, (0.45, 0.45), (ridge - 2.2, ridge + 0.9), brick);
    scene.keep_clear(place, half.0 + 3.0);
}

/// Houses on both sides of the road and around the church's green.
pub(super) fn houses(scene: &mut Scene) {
    let seed = scene.terrain.seed ^ 0x71;
    for lane in 0..9u64 {
        let t = -19.0 + 8.4 * lane as f64;
        for side in [-1.0, 1.0] {
            let id = hash(seed, lane * 2 + u64::from(side > 0.0));
            let s = Terrain::road(t) + side * range(id, 11, 9.0, 10.5);
            let clear_of_river = Terrain::river_distance(s, t) > 14.0;
            if clear_of_river && scene.is_clear((s, t), 4.5) {
                house(
                    scene,
                    (s, t),
                    range(id, 12, -0.18, 0.18) + 1.57 * f64::from(lane % 3 == 1),
                    id,
                );
            }
        }
    }
    // A sunflower's spiral covers the rest of the village evenly.
    for i in 0..110u64 {
        let id = hash(seed, 100 + i);
        let (sin, cos) = (i as f64 * 2.4).sin_cos();
        let d = 62.0 * ((i as f64 + 4.0) / 114.0).sqrt();
        let place = (VILLAGE.0 + d * cos, VILLAGE.1 + 0.62 * d * sin);
        let free = Terrain::river_distance(place.0, place.1) > 15.0
            && Terrain::road_distance(place.0, place.1) > 8.0
            && unit(id, 13) < 0.6
            && scene.terrain.field(place.0, place.1).is_none()
            && scene.is_clear(place, 4.6);
        if free {
            let quarter = std::f64::consts::FRAC_PI_2 * (id % 2) as f64;
            house(scene, place, range(id, 12, -0.5, 0.5) + quarter, id);
        }
    }
}

/// A nave with a slate roof and a tower with a spire.
pub(super) fn church(scene: &mut Scene) {
    let place = (VILLAGE.0 + 25.0, VILLAGE.1 + 5.0);
    let f = Frame::new(&scene.terrain, place, -0.32, 9.0);
    let (wall, roof) = (Paint::Wall(WHITE), Paint::Tiles(SLATE));
    gabled(scene, &f, Gable { half: (9.5, 4.8), eaves: 7.0, ridge: 12.6, wall, roof });
    let tower = Frame { origin: f.at(-11.4, 0.0, 0.0), ..f };
    block(scene, &tower, (2.9, 2.9), (0.0, 18.0), Paint::Wall(WHITE));
    block(scene, &tower, (3.2, 3.2), (17.6, 18.4), Paint::Stone(STONE));
    pyramid(scene, &tower, 3.2, (18.4, 32.0), Paint::Tiles([74, 112, 104]));
    let apse = f.at(9.5, 0.0, 0.0);
    scene.push(Shape::Tube { base: apse, radius: 3.6, height: 5.6, taper: 1.0 }, wall);
    let cap = add(apse, [0.0, 0.0, 5.6]);
    scene.push(Shape::Tube { base: cap, radius: 4.1, height: 3.4, taper: 0.0 }, roof);
    scene.keep_clear(place, 17.0);
}
