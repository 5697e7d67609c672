//! The window of a picture that a box may be seen in.

use glam::{DVec3, UVec2, uvec2};
use raydsl::prelude::{Aabb, Pinhole};

/// The pixels around a window, for rounding.
const MARGIN: f64 = 1.0;

/// Returns the lower left pixel and the size of the window that has every pixel whose ray through
/// the centre may meet a box; `None` if there is none.
pub(super) fn of_box(camera: &Pinhole, picture: UVec2, bounds: &Aabb) -> Option<(UVec2, UVec2)> {
    let eye = camera.eye.as_dvec3();
    let forward = (camera.center.as_dvec3() - eye).normalize();
    let right = forward.cross(camera.up.as_dvec3()).normalize();
    let up = right.cross(forward);
    let pixel = 2.0 * (0.5 * f64::from(camera.fov_y)).tan() / f64::from(picture.y);
    let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for i in 0..8 {
        let side = |bit: u32, axis: usize| if i >> bit & 1 == 1 { high[axis] } else { low[axis] };
        let to_corner = DVec3::new(side(0, 0), side(1, 1), side(2, 2)) - eye;
        let distance = to_corner.dot(forward);
        // Behind the camera, or beside it: the projection is anywhere.
        if distance <= 1e-6 * to_corner.length() || distance.is_nan() {
            return Some((UVec2::ZERO, picture));
        }
        let place = [to_corner.dot(right), to_corner.dot(up)].map(|c| c / distance / pixel);
        for axis in 0..2 {
            least[axis] = least[axis].min(place[axis]);
            most[axis] = most[axis].max(place[axis]);
        }
    }
    let span = |axis: usize, count: u32| {
        let count_f = f64::from(count);
        let first = (least[axis] + 0.5 * count_f - MARGIN).floor().clamp(0.0, count_f) as u32;
        let end = (most[axis] + 0.5 * count_f + MARGIN).ceil().clamp(0.0, count_f) as u32;
        (first < end).then_some((first, end - first))
    };
    let ((x, width), (y, height)) = (span(0, picture.x)?, span(1, picture.y)?);
    Some((uvec2(x, y), uvec2(width, height)))
}

#[cfg(test)]
mod tests {
    use raydsl::camera::{Camera, CameraRays};
    use raydsl::prelude::*;

    use super::*;

    /// Every ray that passes a point of the box belongs to a pixel of the window.
    #[test]
    fn the_window_has_every_pixel_of_a_box() {
        let picture = uvec2(40, 30);
        let mut rng = Rng::new(UVec2::ZERO, 9, 1);
        for _ in 0..100 {
            let eye = (rng.next_3d() - 0.5) * 8.0;
            let camera = Pinhole::new(eye, rng.next_3d() - 0.5, Vec3::Y, 0.3 + rng.next_f32());
            let (a, b) = (rng.next_3d() * 2.0 - 1.0, rng.next_3d() * 2.0 - 1.0);
            let bounds = Aabb { min: a.min(b), max: a.max(b) };
            let window = of_box(&camera, picture, &bounds);
            let rays = camera.begin_frame(picture.x, picture.y);
            for (x, y) in (0..picture.y).flat_map(|y| (0..picture.x).map(move |x| (x, y))) {
                let ray = rays.primary_ray(x as f32 + 0.5, y as f32 + 0.5);
                let per = ray.direction.recip();
                let (t, u) = ((bounds.min - eye) * per, (bounds.max - eye) * per);
                let (enter, leave) = (t.min(u).max_element(), t.max(u).min_element());
                if enter.max(0.0) < leave {
                    let (origin, size) = window.expect("a ray meets the box");
                    let inside = uvec2(x, y).cmpge(origin) & uvec2(x, y).cmplt(origin + size);
                    assert!(inside.all(), "{x}, {y} is outside of {origin} {size}");
                }
            }
        }
    }

    #[test]
    fn a_small_box_has_a_small_window() {
        let camera = Pinhole::new(vec3(0.0, 0.0, 10.0), Vec3::ZERO, Vec3::Y, 0.5);
        let bounds = |at: Vec3| Aabb { min: at - 0.1, max: at + 0.1 };
        let picture = uvec2(400, 400);
        let (_, size) = of_box(&camera, picture, &bounds(Vec3::ZERO)).expect("in the middle");
        assert!(size.max_element() < 24, "{size}");
        assert_eq!(of_box(&camera, picture, &bounds(vec3(9.0, 0.0, 0.0))), None);
    }
}
