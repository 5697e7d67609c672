//! The part of a ray within a convex cell of planes. (option of a tuple, early return, slices, bare
//! integers)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

/// The half-space on the side that the normal points away from.
#[derive(Clone, Copy, Type)]
struct Half {
    normal: Vec3,
    offset: f32,
}

#[kernel]
fn clipped(halves: &[Half], first: u32, count: u32, ray: Ray) -> Option<(f32, f32)> {
    let mut enter = ray.t_min;
    let mut leave = ray.t_max;
    for half in &halves[first as usize..(first + count) as usize] {
        let speed = half.normal.dot(ray.direction);
        let height = half.offset - half.normal.dot(ray.origin);
        if speed == 0.0 {
            if height < 0.0 {
                return None;
            }
            continue;
        }
        let t = height / speed;
        if speed < 0.0 {
            enter = max(enter, t)
        } else {
            leave = min(leave, t)
        }
        if enter > leave {
            return None;
        }
    }
    Some((enter, leave))
}

#[kernel]
fn longest(halves: &[Half], ray: Ray) -> (i32, f32) {
    let mut best = (-1, 0.0);
    for cell in 0..2 {
        if let Some((enter, leave)) = clipped(halves, cell as u32 * 6, 6, ray)
            && leave - enter > best.1
        {
            best = (cell, leave - enter);
        }
    }
    best
}

#[test]
fn cells_clip_rays() {
    let cell = |low: Vec3, high: Vec3| {
        [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(move |n| {
            [Half { normal: n, offset: high.dot(n) }, Half { normal: -n, offset: -low.dot(n) }]
        })
    };
    let halves: Vec<Half> = cell(vec3(-1.0, -1.0, 2.0), vec3(1.0, 1.0, 3.0))
        .chain(cell(vec3(0.0, 0.0, 4.0), vec3(3.0, 3.0, 7.0)))
        .collect();
    let kernel = kernel!(|ray: Ray| longest(&halves, ray));
    let rays: Vec<Ray> = (0..400)
        .map(|i| {
            Ray::new(
                Vec3::ZERO,
                vec3((i % 20) as f32 * 0.1 - 0.95, (i / 20) as f32 * 0.1 - 0.95, 1.0),
            )
        })
        .collect();
    assert_variants_agree!(&kernel, &rays);
    assert_eq!(kernel.call((Ray::new(vec3(-0.5, -0.5, 0.0), Vec3::Z),)), (0, 1.0));
    assert_eq!(kernel.call((Ray::new(vec3(0.5, 0.5, 0.0), Vec3::Z),)), (1, 3.0));
}
