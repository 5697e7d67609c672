//! Blocks that lie about.

use raydsl::prelude::*;

/// The triangles of a box with its middle at `at`, turned by `angle` about the vertical.
fn block(at: Vec3, half: Vec3, angle: f32) -> Vec<Triangle> {
    let (sin, cos) = angle.sin_cos();
    let corner = |i: usize| {
        let side = |bit: usize, h: f32| if i >> bit & 1 == 1 { h } else { -h };
        let (x, y, z) = (side(0, half.x), side(1, half.y), side(2, half.z));
        at + vec3(cos * x + sin * z, y, cos * z - sin * x)
    };
    // Four corners of each side, in order round it.
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = |[a, b, c, d]: [usize; 4]| {
        let [a, b, c, d] = [a, b, c, d].map(corner);
        [Triangle { v0: a, v1: b, v2: c }, Triangle { v0: a, v1: c, v2: d }]
    };
    sides.into_iter().flat_map(halves).collect()
}

/// Makes `count` blocks on a floor, higher towards the middle.
pub fn pile(count: u32) -> Vec<Triangle> {
    let mut rng = Rng::new(UVec2::ZERO, 0, 7);
    let blocks = (0..count).flat_map(|_| {
        let place = sample_concentric_disk(rng.next_2d()) * 5.0;
        let size = rng.next_3d();
        let tall = 0.2 + 1.6 * size.y * size.y * (1.0 - 0.17 * place.length());
        let half = vec3(0.1 + 0.3 * size.x, tall, 0.1 + 0.3 * size.z);
        block(vec3(place.x, half.y, place.y), half, 6.0 * rng.next_f32())
    });
    blocks.chain(block(vec3(0.0, -0.1, 0.0), vec3(6.0, 0.1, 6.0), 0.0)).collect()
}
