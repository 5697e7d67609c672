//! The inverse and the determinant of a `Mat4`, in one order: glam's order depends on the platform.
//!
//! After Lengyel, "Foundations of Game Engine Development", volume 1 (2016), section 1.7: the
//! minors of two columns each are cross products.

use glam::{Mat4, vec4};

use super::functions::vec4;
use crate::kernel;

/// Returns the determinant.
#[kernel]
#[inline]
pub(crate) fn determinant_mat4(m: Mat4) -> f32 {
    let (a, b) = (m.x_axis.truncate(), m.y_axis.truncate());
    let (c, d) = (m.z_axis.truncate(), m.w_axis.truncate());
    let u = a * m.y_axis.w - b * m.x_axis.w;
    let v = c * m.w_axis.w - d * m.z_axis.w;
    a.cross(b).dot(v) + c.cross(d).dot(u)
}

/// Returns the inverse; not finite if there is none.
#[kernel]
#[inline]
pub(crate) fn inverse_mat4(m: Mat4) -> Mat4 {
    let (a, b) = (m.x_axis.truncate(), m.y_axis.truncate());
    let (c, d) = (m.z_axis.truncate(), m.w_axis.truncate());
    let (x, y, z, w) = (m.x_axis.w, m.y_axis.w, m.z_axis.w, m.w_axis.w);
    let (s, t) = (a.cross(b), c.cross(d));
    let (u, v) = (a * y - b * x, c * w - d * z);
    let scale = 1.0 / (s.dot(v) + t.dot(u));
    let (s, t, u, v) = (s * scale, t * scale, u * scale, v * scale);
    let first = b.cross(v) + t * y;
    let second = v.cross(a) - t * x;
    let third = d.cross(u) + s * w;
    let fourth = u.cross(c) - s * z;
    Mat4::from_cols(
        vec4(first.x, second.x, third.x, fourth.x),
        vec4(first.y, second.y, third.y, fourth.y),
        vec4(first.z, second.z, third.z, fourth.z),
        vec4(-b.dot(t), a.dot(t), -d.dot(s), c.dot(s)),
    )
}
