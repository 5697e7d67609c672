//! The frame of a surface, in which BSDFs are.

use glam::{Vec3, vec3};

use crate::machine::functions::vec3;
use crate::machine::generic::{max, normalize};
use crate::sampling::Frame;
use crate::shading::ShadingPoint;
use crate::{Type, kernel};

/// The frame of a surface seen from a direction: the shading normal and its tangents, and the
/// geometric normal, which decides on which side a direction is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct ShadingFrame {
    /// First tangent.
    pub x: Vec3,
    /// Second tangent.
    pub y: Vec3,
    /// The shading normal.
    pub z: Vec3,
    /// The geometric normal, on the side of the shading normal.
    pub normal: Vec3,
}

/// Least cosine between the shading normal and the direction to the viewer.
const MIN_COS: f32 = 1e-3;

#[kernel]
impl ShadingFrame {
    /// Creates the frame of a point that is seen from the direction `to_viewer`, of unit length,
    /// with a normal in the frame of the point's tangents: `(0, 0, 1)`, or one of a normal map, of
    /// any length.
    ///
    /// A shading normal that is turned away from the viewer, while the geometric one is not, is
    /// bent until it is not.
    #[inline]
    pub fn new(point: ShadingPoint, mapped: Vec3, to_viewer: Vec3) -> Self {
        let (ng, ns) = (point.point.normal, point.shading_normal);
        let t = point.tangent;
        let tangent = vec3(t.x, t.y, t.z);
        let bitangent = ns.cross(tangent) * t.w;
        let turned = tangent * mapped.x + bitangent * mapped.y + ns * mapped.z;
        let squared = turned.dot(turned);
        let has_length = squared > 0.0;
        let is_plain = mapped.x == 0.0 && mapped.y == 0.0 || !has_length;
        let n = if is_plain { ns } else { turned / max(squared, f32::MIN_POSITIVE).sqrt() };
        // On the side of the geometric normal, and not turned away from the viewer.
        let n = if n.dot(ng) < 0.0 { n - ng * (2.0 * n.dot(ng)) } else { n };
        let side = if ng.dot(to_viewer) < 0.0 { -1.0 } else { 1.0 };
        let cos = n.dot(to_viewer) * side;
        let bent = normalize(n + to_viewer * (side * (MIN_COS - cos)));
        let z = if cos < MIN_COS { bent } else { n };
        let along = tangent - z * z.dot(tangent);
        let length2 = along.dot(along);
        let other = Frame::around(z).x;
        let x = if length2 > 1e-12 { along / max(length2, 1e-12).sqrt() } else { other };
        let x = normalize(x - z * z.dot(x));
        Self { x, y: z.cross(x), z, normal: ng }
    }

    /// Transforms a direction from the frame to the world.
    #[inline]
    pub fn to_world(self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// Transforms a direction from the world to the frame.
    #[inline]
    pub fn to_local(self, v: Vec3) -> Vec3 {
        vec3(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }

    /// Returns whether a direction of the world, `local` in the frame, is on one side by both
    /// normals. Other light would leak through the surface.
    #[inline]
    pub fn is_consistent(self, world: Vec3, local: Vec3) -> bool {
        self.normal.dot(world) * local.z > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{Rng, sample_uniform_sphere};
    use glam::{Vec4, uvec2};

    fn random_point(rng: &mut Rng) -> ShadingPoint {
        let ng = sample_uniform_sphere(rng.next_2d());
        let w = sample_uniform_sphere(rng.next_2d());
        let ns = if w.dot(ng) < 0.0 { -w } else { w };
        let x = Frame::around(ns).x;
        let w = if rng.next_f32() < 0.5 { 1.0 } else { -1.0 };
        let point = crate::geometry::SurfacePoint { position: Vec3::ZERO, normal: ng, error: 0.0 };
        let tangent = Vec4::new(x.x, x.y, x.z, w);
        ShadingPoint { point, shading_normal: ns, tangent, ..Default::default() }
    }

    #[test]
    fn frames_are_orthonormal_and_seen() {
        let mut rng = Rng::new(uvec2(3, 4), 0, 0);
        for i in 0..20_000 {
            let point = random_point(&mut rng);
            let viewer = sample_uniform_sphere(rng.next_2d());
            let mapped = match i % 3 {
                0 => Vec3::Z,
                1 => sample_uniform_sphere(rng.next_2d()).with_z((i % 5) as f32 * 0.2),
                _ => Vec3::ZERO,
            };
            let frame = ShadingFrame::new(point, mapped, viewer);
            let [x, y, z] = [frame.x, frame.y, frame.z];
            for v in [x, y, z] {
                assert!((v.length() - 1.0).abs() < 1e-5, "{point:?} {viewer} {frame:?}");
            }
            let off = x.dot(y).abs().max(y.dot(z).abs()).max(z.dot(x).abs());
            assert!(off < 1e-5, "{point:?} {viewer} {frame:?}: {off}");
            // What is seen from the front of the surface is seen from the front of the frame.
            let side = point.point.normal.dot(viewer);
            assert!(side * frame.to_local(viewer).z > 0.0, "{point:?} {viewer} {frame:?}");
        }
    }

    /// A mapped normal leans along the tangent, and across it on the side that the tangent says.
    #[test]
    fn mapped_normals_lean_as_the_tangent_says() {
        let up =
            crate::geometry::SurfacePoint { position: Vec3::ZERO, normal: Vec3::Z, error: 0.0 };
        for side in [1.0, -1.0] {
            let tangent = Vec4::new(1.0, 0.0, 0.0, side);
            let point =
                ShadingPoint { point: up, shading_normal: Vec3::Z, tangent, ..Default::default() };
            let leaning = |mapped| ShadingFrame::new(point, mapped, Vec3::Z).z;
            let along = leaning(vec3(1.0, 0.0, 1.0));
            let across = leaning(vec3(0.0, 1.0, 1.0));
            assert!((along - vec3(1.0, 0.0, 1.0).normalize()).length() < 1e-6, "{along}");
            assert!((across - vec3(0.0, side, 1.0).normalize()).length() < 1e-6, "{across}");
        }
        // One that is all along a tangent: any frame will do, but not a NaN.
        let tangent = Vec4::new(0.0, 1.0, 0.0, 1.0);
        let point =
            ShadingPoint { point: up, shading_normal: Vec3::Z, tangent, ..Default::default() };
        let frame = ShadingFrame::new(point, Vec3::X, vec3(0.0, 0.6, 0.8));
        assert!(frame.x.is_finite() && frame.y.is_finite(), "{frame:?}");
    }

    /// A shading normal that leans over the edge sees a light below the surface; no ray may go there.
    #[test]
    fn light_does_not_leak() {
        let up =
            crate::geometry::SurfacePoint { position: Vec3::ZERO, normal: Vec3::Z, error: 0.0 };
        let leaning = vec3(0.995, 0.0, 0.1).normalize();
        let x = Frame::around(leaning).x;
        let tangent = Vec4::new(x.x, x.y, x.z, 1.0);
        let point =
            ShadingPoint { point: up, shading_normal: leaning, tangent, ..Default::default() };
        let frame = ShadingFrame::new(point, Vec3::Z, vec3(0.3, 0.0, 0.9).normalize());
        let below = vec3(0.9, 0.0, -0.3).normalize();
        let local = frame.to_local(below);
        assert!(local.z > 0.5 && !frame.is_consistent(below, local));
        let above = vec3(0.9, 0.0, 0.3).normalize();
        assert!(frame.is_consistent(above, frame.to_local(above)));
    }
}
