//! Where the camera is, and how it moves.

use raydsl::prelude::*;

/// The camera: a pinhole that looks at a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Where it is.
    pub eye: Vec3,
    /// What is in the middle of the picture, and what it turns around.
    pub target: Vec3,
    /// The direction that is up in the world, of unit length.
    pub up: Vec3,
    /// Vertical field of view in radians.
    pub fov_y: f32,
}

impl Default for Pose {
    fn default() -> Self {
        Self { eye: vec3(0.0, -3.0, 1.0), target: Vec3::ZERO, up: Vec3::Z, fov_y: 0.7 }
    }
}

/// The least angle between the line of sight and the world's up, in radians: at the pole there is
/// no right and left.
const POLE: f32 = 0.02;

impl Pose {
    /// Returns a pose that sees all of a box, from above on one side.
    pub fn of_box(bounds: Aabb, up: Vec3, from: Vec3) -> Self {
        let radius = 0.5 * bounds.size().length();
        let radius = if radius.is_finite() && radius > 0.0 { radius } else { 1.0 };
        let (target, fov_y) = (bounds.center(), 0.7f32);
        let away = radius / (0.5 * fov_y).sin() * 0.7;
        Self { eye: target + from.normalize_or(Vec3::Y) * away, target, up, fov_y }
    }

    /// Returns the camera.
    pub fn camera(&self) -> Pinhole {
        Pinhole::new(self.eye, self.target, self.up, self.fov_y)
    }

    /// Returns the ray through the middle of a pixel of a picture of this size.
    pub fn ray(&self, size: (u32, u32), x: u32, y: u32) -> Ray {
        self.ray_through(size, vec2(x as f32, y as f32) + 0.5)
    }

    /// Returns the ray through a place of a picture of this size, in pixels from the lower left.
    pub fn ray_through(&self, (width, height): (u32, u32), at: Vec2) -> Ray {
        CameraRays::primary_ray(&self.camera().begin_frame(width, height), at.x, at.y)
    }

    /// Returns where a point is seen in a picture of this size, in pixels from the lower left;
    /// nothing of what is behind the camera.
    pub fn seen(&self, (width, height): (u32, u32), point: Vec3) -> Option<Vec2> {
        let (way, ahead, right) = (point - self.eye, self.ahead(), self.right());
        let depth = way.dot(ahead);
        let scale = 0.5 * height as f32 / (0.5 * self.fov_y).tan() / depth;
        let at = vec2(way.dot(right), way.dot(right.cross(ahead))) * scale
            + 0.5 * vec2(width as f32, height as f32);
        (depth > 0.0 && at.is_finite()).then_some(at)
    }

    /// Returns the point that is seen in this place of a picture, and as far along the line of sight
    /// as another point; nothing if that is behind the camera.
    pub fn beside(&self, size: (u32, u32), at: Vec2, point: Vec3) -> Option<Vec3> {
        let ray = self.ray_through(size, at);
        let ahead = self.ahead();
        let t = (point - ray.origin).dot(ahead) / ray.direction.dot(ahead);
        let place = ray.at(t);
        (t > 0.0 && place.is_finite()).then_some(place)
    }

    /// Returns the frame of the head, from its coordinates to the world: right, up, back, and the eye.
    pub fn head(&self) -> Mat4 {
        let (right, ahead) = (self.right(), self.ahead());
        let up = right.cross(ahead);
        Mat4::from_cols(
            right.extend(0.0),
            up.extend(0.0),
            (-ahead).extend(0.0),
            self.eye.extend(1.0),
        )
    }

    /// Returns the distance from the target.
    pub fn distance(&self) -> f32 {
        self.eye.distance(self.target)
    }

    fn ahead(&self) -> Vec3 {
        (self.target - self.eye).normalize_or(Vec3::Y)
    }

    fn right(&self) -> Vec3 {
        self.ahead().cross(self.up).normalize_or(Vec3::X)
    }

    /// Returns a vector turned around the world's up and then up or down, by degrees.
    fn turned(&self, v: Vec3, aside: f32, aloft: f32) -> Vec3 {
        let v = glam::Quat::from_axis_angle(self.up, aside.to_radians()) * v;
        let angle = v.angle_between(self.up);
        let after = (angle - aloft.to_radians()).clamp(POLE, core::f32::consts::PI - POLE);
        let axis = v.cross(self.up).normalize_or(Vec3::X);
        glam::Quat::from_axis_angle(axis, angle - after) * v
    }

    /// Turns the camera around its target, to the right and up, by degrees.
    pub fn orbit(&mut self, aside: f32, aloft: f32) {
        self.eye = self.target + self.turned(self.eye - self.target, aside, aloft);
    }

    /// Turns the line of sight to the left and up, by degrees.
    pub fn turn(&mut self, aside: f32, aloft: f32) {
        self.target = self.eye + self.turned(self.target - self.eye, aside, aloft);
    }

    /// Moves to the right, up and ahead, by shares of the distance from the target.
    pub fn fly(&mut self, by: Vec3) {
        let (right, ahead) = (self.right(), self.ahead());
        let way = (right * by.x + right.cross(ahead) * by.y + ahead * by.z) * self.distance();
        self.eye += way;
        self.target += way;
    }

    /// Changes the distance from the target by a factor above 0.
    pub fn zoom(&mut self, factor: f32) {
        let away = (self.eye - self.target) * factor;
        let length = away.length();
        if length.is_finite() && length > 1e-12 {
            self.eye = self.target + away;
        }
    }

    /// Returns whether all numbers are finite, and the eye is not the target.
    pub fn is_valid(&self) -> bool {
        let all = self.eye.is_finite() && self.target.is_finite();
        all && self.distance() > 0.0 && self.ahead().cross(self.up).length() > 1e-6
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orbits_keep_their_distance_and_never_pass_the_pole() {
        let mut pose = Pose::default();
        let before = pose.distance();
        for _ in 0..50 {
            pose.orbit(17.0, 23.0);
            assert!(pose.is_valid(), "{pose:?}");
            assert!((pose.distance() - before).abs() < 1e-4 * before);
        }
        assert!(pose.eye.z > 0.99 * before);
        pose.orbit(0.0, -90.0);
        assert!(pose.eye.z.abs() < 0.1 * before);
    }

    #[test]
    fn what_is_seen_in_a_place_is_there() {
        let pose =
            Pose { eye: vec3(1.0, -4.0, 2.0), target: vec3(0.0, 0.5, 0.2), ..Pose::default() };
        let size = (320, 180);
        for point in [pose.target, vec3(0.7, 0.1, -0.4), vec3(-1.0, 2.0, 0.3)] {
            let at = pose.seen(size, point).expect("it is before the camera");
            let there = pose.beside(size, at, point).expect("the same");
            assert!(there.distance(point) < 1e-4, "{point}: {there}");
            let other = pose.beside(size, at + 30.0, point).expect("beside it");
            let ahead = (pose.target - pose.eye).normalize();
            assert!((other - point).dot(ahead).abs() < 1e-4);
            assert!((pose.seen(size, other).expect("there") - at - 30.0).length() < 0.01);
        }
        let middle = pose.seen(size, pose.target).expect("it is the target");
        assert!((middle - vec2(160.0, 90.0)).length() < 1e-3);
        assert_eq!(pose.seen(size, pose.eye - pose.target + pose.eye), None);
        let head = pose.head();
        assert!(
            (head.transform_point3(vec3(0.0, 0.0, -pose.distance())) - pose.target).length() < 1e-5
        );
    }

    #[test]
    fn flights_are_as_the_picture_shows() {
        let mut pose = Pose { eye: vec3(0.0, -2.0, 0.0), ..Pose::default() };
        pose.fly(vec3(1.0, 0.0, 0.0));
        assert!((pose.eye - vec3(2.0, -2.0, 0.0)).length() < 1e-5, "{pose:?}");
        pose.fly(vec3(0.0, 0.5, 0.5));
        assert!((pose.eye - vec3(2.0, -1.0, 1.0)).length() < 1e-5, "{pose:?}");
        pose.turn(90.0, 0.0);
        assert!((pose.target - vec3(0.0, -1.0, 1.0)).length() < 1e-4, "{pose:?}");
        pose.zoom(0.5);
        assert!((pose.distance() - 1.0).abs() < 1e-5);
    }
}
