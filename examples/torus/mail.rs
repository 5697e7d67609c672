//! Rings, woven into mail.

use raydsl::prelude::*;

use super::shape::Torus;

// ANCHOR: scene
/// Rows of rings that lean left and right in turn: each holds two of the row before and two of the
/// row behind. They lie on a floor, over something round.
pub(crate) fn mail(columns: i32, rows: i32) -> Vec<Torus> {
    let cloth = |x: f32, y: f32| {
        let fold = 0.5 * (0.35 * x + 0.2 * y).sin() * (0.3 * y - 0.1 * x).cos();
        let hill = 3.2 * (-(x * x + y * y) / 24.0).exp();
        vec3(x, 1.4 + hill + fold, -y)
    };
    let ring = |column: i32, row: i32| {
        let lean: f32 = if row % 2 == 0 { 0.64 } else { -0.64 };
        let x = 1.2 * (column as f32 - 0.5 * columns as f32 + 0.5) + 0.3 * lean.signum();
        let y = 1.2 * (row as f32 - 0.5 * rows as f32 + 0.5);
        let right = (cloth(x + 0.1, y) - cloth(x - 0.1, y)).normalize();
        let away = (cloth(x, y + 0.1) - cloth(x, y - 0.1)).normalize();
        let axis = (right.cross(away) * (1.0 - lean * lean).sqrt() + right * lean).normalize();
        Torus { center: cloth(x, y), major: 1.0, axis, minor: 0.19 }
    };
    (0..rows).flat_map(|row| (0..columns).map(move |column| ring(column, row))).collect()
}
// ANCHOR_END: scene
