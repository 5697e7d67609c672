//! A smooth shape with bumps and hollows, as triangles.

use raydsl::prelude::*;

/// A sphere of about radius 1, pushed in and out by waves, of `4 * rows * rows` triangles.
pub fn blob(rows: u32) -> Vec<Triangle> {
    let turn = std::f32::consts::TAU;
    let at = |i: u32, j: u32| {
        let (v, u) = (i as f32 / rows as f32, j as f32 / (2 * rows) as f32);
        let ((sv, cv), (su, cu)) = ((0.5 * turn * v).sin_cos(), (turn * u).sin_cos());
        let n = vec3(sv * su, cv, sv * cu);
        let waves = (5.0 * n.x + 1.0).sin() * (4.0 * n.y).sin() + (6.0 * n.z + 4.0 * n.y).cos();
        n * (1.0 + 0.12 * waves)
    };
    let cells = (0..rows).flat_map(|i| (0..2 * rows).map(move |j| (i, j)));
    let pair = |(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [Triangle { v0: a, v1: b, v2: c }, Triangle { v0: a, v1: c, v2: d }]
    };
    cells.flat_map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_triangle_is_of_a_moderate_size() {
        let all = blob(16);
        assert_eq!(all.len(), 1024);
        assert!(all.iter().all(|t| t.v0.length() < 1.5 && t.v0.is_finite()));
    }
}
