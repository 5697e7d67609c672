//! A ray through a grid of heights, cell by cell. (computed index, option, early return, bare
//! integers)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

/// A square grid of heights over the cells from (0, 0) to (size, size).
#[derive(Clone, Copy, Type)]
struct Grid {
    size: i32,
}

#[kernel]
impl Grid {
    fn height(&self, heights: &[f32], x: i32, y: i32) -> Option<f32> {
        if x < 0 || y < 0 || x >= self.size || y >= self.size {
            return None;
        }
        Some(heights[(y * self.size + x) as usize])
    }
}

/// The distance at which the ray comes below the height of its cell.
#[kernel]
fn ground(grid: Grid, heights: &[f32], ray: Ray) -> Option<f32> {
    let d = ray.direction;
    let step_x = if d.x < 0.0 { -1 } else { 1 };
    let step_y = if d.y < 0.0 { -1 } else { 1 };
    let mut x = ray.origin.x.floor() as i32;
    let mut y = ray.origin.y.floor() as i32;
    let edge = |cell: i32, step: i32| if step > 0 { (cell + 1) as f32 } else { cell as f32 };
    let mut t = 0.0;
    for _ in 0..64 {
        let tx = (edge(x, step_x) - ray.origin.x) / d.x;
        let ty = (edge(y, step_y) - ray.origin.y) / d.y;
        let next = min(tx, ty);
        let height = grid.height(heights, x, y)?;
        let z = min(ray.at(t).z, ray.at(next).z);
        if z <= height {
            let down = if d.z < 0.0 { (height - ray.origin.z) / d.z } else { t };
            return Some(max(t, down));
        }
        if tx < ty {
            x += step_x
        } else {
            y += step_y
        }
        t = next;
    }
    None
}

#[test]
fn rays_meet_the_ground() {
    let grid = Grid { size: 8 };
    let heights: Vec<f32> = (0..64).map(|i| ((i * 7) % 5) as f32 * 0.2).collect();
    let kernel = kernel!(|ray: Ray| ground(grid, &heights, ray).unwrap_or(-1.0));
    let rays: Vec<Ray> = (0..300)
        .map(|i| {
            let origin = vec3(0.3 + (i % 9) as f32 * 0.8, 0.4 + (i % 7) as f32, 2.0);
            Ray::new(origin, vec3(0.37, 0.21 - (i % 5) as f32 * 0.11, -0.3 - (i % 3) as f32 * 0.2))
        })
        .collect();
    assert_variants_agree!(&kernel, &rays);
    let down = kernel.call((Ray::new(vec3(1.5, 0.5, 2.0), vec3(1e-3, 1e-3, -1.0)),));
    assert!((down - (2.0 - heights[1])).abs() < 1e-3, "{down}");
}
