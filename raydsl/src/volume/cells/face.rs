//! Outer faces of cells: the primitive by which a tree finds where rays enter.

use glam::Vec3;

use super::frame::{Corner, RayFrame, is_left, pierced};
use crate::geometry::{Aabb, Hit, Ray, triangle};
use crate::primitive;

/// Face of a tetrahedron that no other one shares, seen from outside: 16 bytes, with the mesh's
/// points as shared data. Rays hit it where they enter the mesh, and not where they leave it.
#[primitive]
#[derive(Debug, PartialEq, Eq)]
pub struct CellFace {
    /// Indices of its points. They run clockwise, seen from outside.
    pub vertices: [u32; 3],
    /// Four times the number of its tetrahedron, plus the place of the vertex that the face lacks.
    pub(super) cell: u32,
}

#[primitive]
impl CellFace {
    const SLACK: f32 = triangle::SLACK;
    const IS_SHORT: bool = true;
    const MAX_CROSSINGS: u32 = 1;

    /// Intersects `ray` with the face, if it enters there. Of all faces around an edge or a vertex
    /// that the ray passes through, those are hit that a ray beside it would hit.
    #[inline]
    pub fn intersect(&self, ray: Ray, points: &[Vec3]) -> Hit {
        let [v0, v1, v2] = self.vertices;
        let frame = RayFrame::new(ray);
        let a = frame.seen(points[v0 as usize]);
        let b = frame.seen(points[v1 as usize]);
        let c = frame.seen(points[v2 as usize]);
        if !(is_left(a, b) && is_left(b, c) && is_left(c, a)) {
            return Hit::miss();
        }
        let a = Corner { at: a, value: 0.0, index: v0 };
        let b = Corner { at: b, value: 0.0, index: v1 };
        let c = Corner { at: c, value: 0.0, index: v2 };
        let t = pierced(a, b, c).t;
        Hit::new(t >= ray.t_min && t <= ray.t_max, t)
    }

    /// Returns the bounds of its points.
    pub fn get_bounds(&self, points: &[Vec3]) -> Aabb {
        Aabb::from_points(
            self.vertices.map(|i| points.get(i as usize).copied().unwrap_or(Vec3::NAN)),
        )
    }
}
