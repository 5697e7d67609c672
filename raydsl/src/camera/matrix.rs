//! Cameras from the matrices of a rasteriser.

use glam::{DMat4, DVec3, DVec4, Mat4, Vec2, Vec3, Vec4, dvec4};

use super::{Camera, CameraRays};
use crate::geometry::Ray;
use crate::machine::generic::min;
use crate::{Type, kernel};

/// Depths of the near and the far plane in normalised device coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// Depth of the near plane.
    pub near: f32,
    /// Depth of the far plane.
    pub far: f32,
}

impl DepthRange {
    /// From 0 to 1: WebGPU, Direct3D, Metal and Vulkan; glam's `camera::rh::proj::directx`.
    pub const ZERO_TO_ONE: Self = Self { near: 0.0, far: 1.0 };
    /// From -1 to 1: OpenGL; glam's `camera::rh::proj::opengl`.
    pub const MINUS_ONE_TO_ONE: Self = Self { near: -1.0, far: 1.0 };
    /// From 1 to 0, with the near plane at 1; glam's `perspective_infinite_reverse`.
    pub const REVERSED: Self = Self { near: 1.0, far: 0.0 };
}

/// Error of creating a camera from matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// The product of projection and view cannot be inverted, or a number of it is not finite.
    #[error("the product of projection and view has no inverse")]
    Singular,
    /// The near and the far plane have the same depth.
    #[error("the near and the far plane have the same depth")]
    NoDepth,
    /// A corner of the near plane is behind the eye, or beside it.
    #[error(
        "the near plane is not in front of the eye: give the projection a near distance above 0, \
         and the depth range that it was made for"
    )]
    NearBehindEye,
}

/// Camera given by the matrices of a rasteriser, to combine both kinds of images: rays go from the
/// near plane to the far one, and [`MatrixRays::window_depth`] of a hit point is the value that the
/// rasteriser writes into its depth buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix {
    clip: DMat4,
    world: DMat4,
    depth: DepthRange,
}

impl Matrix {
    /// Creates a camera from the world-to-view and view-to-clip matrices. The near plane must lie
    /// in front of the eye.
    ///
    /// # Errors
    ///
    /// If the product has no inverse, the depths of the planes are equal, or the near plane is
    /// behind the eye.
    pub fn new(view: Mat4, proj: Mat4, depth: DepthRange) -> Result<Self, CameraError> {
        let clip = proj.as_dmat4() * view.as_dmat4();
        let world = clip.inverse();
        // The inverse of a singular matrix is not finite, or no inverse.
        let rest = (clip * world - DMat4::IDENTITY).to_cols_array();
        // False for a NaN, too.
        let is_inverse = rest.iter().all(|v| v.abs() < 1e-3);
        if clip.determinant() == 0.0 || !is_inverse {
            return Err(CameraError::Singular);
        }
        if !(depth.near - depth.far).is_normal() {
            return Err(CameraError::NoDepth);
        }
        // The last coordinate of a point is the reciprocal of that of its clip-space position.
        let in_front = |x: f64, y: f64| (world.row(3)).dot(dvec4(x, y, f64::from(depth.near), 1.0));
        let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        if !corners.iter().all(|&(x, y)| in_front(x, y) > 0.0) {
            return Err(CameraError::NearBehindEye);
        }
        Ok(Self { clip, world, depth })
    }
}

/// Ray generation of a [`Matrix`] camera for a film.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct MatrixRays {
    /// Point of the near plane behind the film's corner (0, 0), homogeneous.
    pub near_corner: Vec4,
    /// Its change per pixel to the right.
    pub near_right: Vec4,
    /// Its change per pixel up.
    pub near_up: Vec4,
    /// Direction from there to the far plane, scaled.
    pub way_corner: Vec3,
    /// Its change per pixel to the right.
    pub way_right: Vec3,
    /// Its change per pixel up.
    pub way_up: Vec3,
    /// Last coordinate of the point of the far plane, and its changes per pixel to the right and
    /// up.
    pub far_w: Vec3,
    /// The eye, or the middle of the near plane where rays are parallel.
    pub eye: Vec3,
    /// Linear map from a point, relative to `eye`, to its window depth times the last coordinate.
    pub depth: Vec4,
    /// Linear map from a point, relative to `eye`, to the last coordinate in clip space.
    pub clip_w: Vec4,
}

/// Converts a linear function of the film to its value at the corner, and its changes per pixel to
/// the right and up.
fn over_film<T: core::ops::Mul<f64, Output = T> + core::ops::Sub<Output = T> + Copy>(
    [middle, right, up]: [T; 3],
    width: u32,
    height: u32,
) -> [T; 3] {
    let pixel = |n: u32| 2.0 / f64::from(n.max(1));
    [middle - right - up, right * pixel(width), up * pixel(height)]
}

impl Camera for Matrix {
    type Rays = MatrixRays;

    fn begin_frame(&self, width: u32, height: u32) -> MatrixRays {
        let DepthRange { near, far } = self.depth;
        let (near, far) = (f64::from(near), f64::from(far));
        let plane = |z: f64| self.world.z_axis * z + self.world.w_axis;
        // All lines of sight meet in this point: the eye, or the direction of parallel ones.
        let eye = self.world.z_axis * (far - near);
        let seen_from = |h: DVec4| (h.truncate() / h.w).as_vec3();
        let position = Some(seen_from(eye)).filter(|p| p.is_finite());
        let position = position.unwrap_or_else(|| seen_from(plane(near)));
        let axes = [plane(near), self.world.x_axis, self.world.y_axis];
        // From `near` to `near + eye`: the difference of the points times both last coordinates,
        // where the products of the coordinates of `near` cancel. So it is as linear as `near`.
        let way = axes.map(|n: DVec4| eye.truncate() * n.w - n.truncate() * eye.w);
        let far_w = [plane(far).w, self.world.x_axis.w, self.world.y_axis.w];
        let [near_corner, near_right, near_up] =
            over_film(axes, width, height).map(|v| v.as_vec4());
        let [way_corner, way_right, way_up] = over_film(way, width, height).map(|v| v.as_vec3());
        let (lowest, span) = (near.min(far), (near - far).abs());
        let depth = (self.clip.row(2) - self.clip.row(3) * lowest) / span;
        // Express a row as a function of the vector from `position`.
        let from_there =
            |row: DVec4| row.truncate().extend(row.dot(position.as_dvec3().extend(1.0))).as_vec4();
        MatrixRays {
            near_corner,
            near_right,
            near_up,
            way_corner,
            way_right,
            way_up,
            far_w: DVec3::from_array(over_film(far_w, width, height)).as_vec3(),
            eye: position,
            depth: from_there(depth),
            clip_w: from_there(self.clip.row(3)),
        }
    }
}

#[kernel]
impl CameraRays for MatrixRays {
    /// Returns the ray from the near plane to the far one; its direction has unit length.
    fn primary_ray(&self, x: f32, y: f32) -> Ray {
        let near = self.near_corner + self.near_right * x + self.near_up * y;
        let way = self.way_corner + self.way_right * x + self.way_up * y;
        let far_w = self.far_w.x + self.far_w.y * x + self.far_w.z * y;
        let length = way.length();
        // A far plane at infinity has a last coordinate of 0.
        let t_max = if far_w > 0.0 { min(length / (near.w * far_w), f32::MAX) } else { f32::MAX };
        Ray { origin: near.truncate() / near.w, direction: way / length, t_min: 0.0, t_max }
    }

    /// Returns the primary ray: there is no lens.
    fn lens_ray(&self, x: f32, y: f32, _u: Vec2) -> Ray {
        self.primary_ray(x, y)
    }
}

#[kernel]
impl MatrixRays {
    /// Returns the window depth of a point, from 0 to 1: the value that a rasteriser writes, with
    /// the usual depth range of its viewport. For a hit it is `window_depth(ray.at(hit.t))`.
    #[inline]
    pub fn window_depth(&self, point: Vec3) -> f32 {
        // Large coordinates cancel here, where the difference is exact.
        let way = point - self.eye;
        let depth = self.depth.truncate().dot(way) + self.depth.w;
        depth / (self.clip_w.truncate().dot(way) + self.clip_w.w)
    }

    /// Returns the distance along `ray`, in units of its direction, at which the window depth is `depth`:
    /// where a pixel's ray meets what a rasteriser drew there, or reaches the far plane for a depth of 1.
    ///
    /// It is `t` of the point whose [`window_depth`](Self::window_depth) that is, to within rounding of
    /// the depth, which is coarse far from the near plane. Not finite for a ray along which the depth
    /// stays the same.
    #[inline]
    pub fn distance_at_depth(&self, ray: Ray, depth: f32) -> f32 {
        let way = ray.origin - self.eye;
        let (z, w) = (self.depth.truncate(), self.clip_w.truncate());
        // Both coordinates are linear along the ray.
        let begin = z.dot(way) + self.depth.w - depth * (w.dot(way) + self.clip_w.w);
        begin / (depth * w.dot(ray.direction) - z.dot(ray.direction))
    }
}
