//! A march through a grid of bits. (computed index, option of a tuple, early return, bare integers)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

const SIDE: i32 = 8;

/// Whether a cell is full; outside nothing is.
#[kernel]
fn is_full(bits: &[u32], cell: IVec3) -> bool {
    if cell.min_element() < 0 || cell.max_element() >= SIDE {
        return false;
    }
    let index = (cell.z * SIDE + cell.y) * SIDE + cell.x;
    let word = bits[(index / 32) as usize];
    (word >> (index % 32) as u32) & 1 == 1
}

/// The number and the distance of the first full cell.
#[kernel]
fn first_full(bits: &[u32], ray: Ray) -> Option<(i32, f32)> {
    let mut t = 0.0;
    for _ in 0..200 {
        let p = ray.at(t);
        let cell = ivec3(p.x.floor() as i32, p.y.floor() as i32, p.z.floor() as i32);
        if is_full(bits, cell) {
            return Some(((cell.z * SIDE + cell.y) * SIDE + cell.x, t));
        }
        t += 0.0625;
        if t > 16.0 {
            break;
        }
    }
    None
}

#[test]
fn full_cells_are_found() {
    let mut bits = vec![0u32; 16];
    for index in [9, 77, 200, 300, 301, 444, 511] {
        bits[index / 32] |= 1 << (index % 32);
    }
    let kernel = kernel!(|ray: Ray| match first_full(&bits, ray) {
        Some((index, t)) => vec2(index as f32, t),
        None => vec2(-1.0, 0.0),
    });
    let rays: Vec<Ray> = (0..256)
        .map(|i| {
            Ray::new(
                vec3((i % 16) as f32 * 0.5 + 0.25, (i / 16) as f32 * 0.5 + 0.25, -1.0),
                Vec3::Z,
            )
        })
        .collect();
    assert_variants_agree!(&kernel, &rays);
    let found = rays.iter().filter(|r| kernel.call((**r,)).x >= 0.0).count();
    assert_eq!(found, 7 * 4);
}
