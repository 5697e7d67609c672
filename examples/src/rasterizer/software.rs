//! A small rasteriser with a depth buffer, as graphics hardware has one.

use raydsl::prelude::*;
use raydsl::render::Fragment;

use super::Corner;

/// Draws triangles seen through `clip`, the product of projection and view. Those that reach in
/// front of the near plane are left out.
pub(super) fn draw(triangles: &[[Corner; 3]], clip: Mat4, image: &mut Image<Fragment>) {
    let (width, height) = (image.width(), image.height());
    for corners in triangles {
        let seen = corners.map(|c| clip * c.place.extend(1.0));
        if seen.iter().any(|v| v.z < 0.0) {
            continue;
        }
        let film = seen.map(|v| {
            let device = v.truncate() / v.w;
            vec3(
                (device.x + 1.0) * 0.5 * width as f32,
                (device.y + 1.0) * 0.5 * height as f32,
                device.z,
            )
        });
        let low = film[0].min(film[1]).min(film[2]).max(Vec3::ZERO).as_uvec3();
        let high = film[0].max(film[1]).max(film[2]).max(Vec3::ZERO).as_uvec3();
        for y in low.y..=high.y.min(height - 1) {
            for x in low.x..=high.x.min(width - 1) {
                let Some(share) = shares(film, vec2(x as f32 + 0.5, y as f32 + 0.5)) else {
                    continue;
                };
                // The depth in the window is linear on the film; colours are over their last
                // coordinate.
                let depth = share.dot(vec3(film[0].z, film[1].z, film[2].z));
                let pixel = &mut image.pixels_mut()[(y * width + x) as usize];
                if depth < pixel.depth {
                    let share = share / vec3(seen[0].w, seen[1].w, seen[2].w);
                    let sum = (0..3).map(|i| corners[i].color * share[i]).sum::<Vec3>();
                    let color = (sum / share.element_sum()).extend(1.0);
                    *pixel = Fragment { color, depth };
                }
            }
        }
    }
}

/// The weights of the corners at a point of the film, if it lies within the triangle.
fn shares(film: [Vec3; 3], at: Vec2) -> Option<Vec3> {
    let [a, b, c] = film.map(|v| vec2(v.x, v.y) - at);
    let weights = vec3(b.perp_dot(c), c.perp_dot(a), a.perp_dot(b));
    let shares = weights / weights.element_sum();
    (shares.is_finite() && shares.min_element() >= 0.0).then_some(shares)
}
