//! Half of Menger's sponge.

use raydsl::prelude::*;

/// The faces of the sponge with this many levels, of cells of edge 1, that is cut through its
/// middle across the diagonal, where its holes are stars. The half with the origin is left.
pub(crate) fn half(levels: u32) -> Vec<Triangle> {
    let edge = 3i32.pow(levels);
    let is_solid = |cell: [i32; 3]| {
        let is_there = cell.iter().all(|c| (0..edge).contains(c));
        // Twice the sum of the middles of the cell's coordinates, and of the whole cube's.
        let is_kept = 2 * cell.iter().sum::<i32>() + 3 <= 3 * edge;
        // In no level are two coordinates in the middle third.
        let is_hole = |level| cell.iter().filter(|c| **c / 3i32.pow(level) % 3 == 1).count() > 1;
        is_there && is_kept && !(0..levels).any(is_hole)
    };
    let cells =
        (0..edge).flat_map(|z| (0..edge).flat_map(move |y| (0..edge).map(move |x| [x, y, z])));
    let mut triangles = Vec::new();
    for cell in cells.filter(|cell| is_solid(*cell)) {
        for axis in 0..3 {
            for step in [-1, 1] {
                let mut next = cell;
                next[axis] += step;
                if !is_solid(next) {
                    triangles.extend(face(cell, axis, step > 0));
                }
            }
        }
    }
    triangles
}

/// The side of a cell across `axis`, the one farther along it or the other. It is seen
/// anticlockwise from outside.
fn face(cell: [i32; 3], axis: usize, is_far: bool) -> [Triangle; 2] {
    let [u, v] = if is_far { [1, 2] } else { [2, 1] }.map(|i| (axis + i) % 3);
    let corner = |right: i32, up: i32| {
        let mut at = cell;
        at[axis] += i32::from(is_far);
        at[u] += right;
        at[v] += up;
        vec3(at[0] as f32, at[1] as f32, at[2] as f32)
    };
    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
    [Triangle { v0: a, v1: b, v2: c }, Triangle { v0: a, v1: c, v2: d }]
}
