//! Values of a grid of cells at points and along rays.

use glam::{Vec3, vec3};

use super::CellGrid;
use super::walk::{CellWalk, pick, points_of};
use crate::bvh::RecordQuery;
use crate::geometry::Ray;
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, length, max};
use crate::volume::SurfaceHit;
use crate::{Type, kernel};

impl CellGrid<'_> {
    /// Returns the value at a point of the world, or `None` where there is no cell. It walks from
    /// the outside of the mesh to the point.
    #[inline]
    pub fn value(&self, p: Vec3) -> Option<f32> {
        value(self, p)
    }

    /// Returns the length of a ray's parts in cells, in the world.
    #[inline]
    pub fn length_inside(&self, ray: Ray) -> f32 {
        length_inside(self, ray)
    }

    /// Returns where a ray first meets the surface of one value, from either side, and the gradient
    /// of the value there, which is constant in a tetrahedron. A value for each cell has surfaces
    /// where it changes from above to below; there the gradient is the unit normal of the face,
    /// towards the greater values. The outside of the mesh is no surface.
    #[inline]
    pub fn first_surface(&self, ray: Ray, value: f32) -> Option<SurfaceHit> {
        first_surface(self, ray, value)
    }
}

#[kernel]
#[inline(never)]
pub(super) fn value(grid: &CellGrid<'_>, p: Vec3) -> Option<f32> {
    let ray = Ray::new(p, vec3(0.0, 0.0, 1.0));
    let line = grid.line(ray);
    let at = -line.start;
    let (mut found, mut is_found) = (0.0, false);
    for hit in grid.entries().hits(line.ray) {
        let mut walk = grid.enter(line, hit.prim_id);
        while walk.is_inside && !is_found && walk.enter() <= at {
            if at <= walk.leave() && walk.is_whole {
                is_found = true;
                found = walk.part(at, at).from;
            }
            walk.advance(grid, line);
        }
        if is_found || hit.t > at {
            break;
        }
    }
    if is_found { Some(found) } else { None }
}

#[kernel]
#[inline(never)]
pub(super) fn length_inside(grid: &CellGrid<'_>, ray: Ray) -> f32 {
    let line = grid.line(ray);
    let mut done = line.first;
    let mut sum = 0.0;
    for hit in grid.entries().hits(line.ray) {
        let mut walk = grid.enter(line, hit.prim_id);
        let mut own = 0.0;
        while walk.is_inside && walk.enter() < line.last {
            let part = walk.part(done, line.last);
            if walk.is_whole {
                own += max(part.leave - part.enter, 0.0);
            }
            done = max(done, walk.leave());
            walk.advance(grid, line);
        }
        sum += own;
    }
    sum * line.scale
}

/// Edges from the first vertex of a tetrahedron, in units of their largest coordinate.
#[derive(Clone, Copy, Debug, Type)]
struct Edges {
    u: Vec3,
    v: Vec3,
    w: Vec3,
    size: f32,
}

#[kernel]
#[inline]
fn edges_of(grid: &CellGrid<'_>, tetrahedron: u32) -> Edges {
    let (p0, p1, p2, p3) = points_of(grid, grid.tetrahedron(tetrahedron).vertices);
    let (u, v, w) = (p1 - p0, p2 - p0, p3 - p0);
    let most = u.abs().max(v.abs()).max(w.abs());
    let size = max(max(max(most.x, most.y), most.z), f32::MIN_POSITIVE);
    Edges { u: u / size, v: v / size, w: w / size, size }
}

/// Returns the gradient of the linear field in a tetrahedron; 0 where it is flat.
#[kernel]
#[inline]
pub(super) fn gradient_in(grid: &CellGrid<'_>, tetrahedron: u32) -> Vec3 {
    let mut gradient = vec3(0.0, 0.0, 0.0);
    if !grid.is_of_cells() {
        let at = grid.tetrahedron(tetrahedron).vertices;
        let Edges { u, v, w, size } = edges_of(grid, tetrahedron);
        let first = grid.number(at.x);
        let (du, dv) = (grid.number(at.y) - first, grid.number(at.z) - first);
        let dw = grid.number(at.w) - first;
        let volume = u.dot(v.cross(w)) * size;
        let sum = v.cross(w) * du + w.cross(u) * dv + u.cross(v) * dw;
        if volume != 0.0 {
            gradient = sum / volume;
        }
    }
    gradient
}

/// Returns the unit normal of the face by which a walk enters its cell, along the ray.
#[kernel]
#[inline]
fn normal_of_entry(grid: &CellGrid<'_>, walk: CellWalk, ray: Ray) -> Vec3 {
    let all = grid.tetrahedron(walk.tetrahedron).vertices;
    let i = walk.lacking;
    let p = grid.point(pick(all, (i + 1) & 3));
    let u = grid.point(pick(all, (i + 2) & 3)) - p;
    let v = grid.point(pick(all, (i + 3) & 3)) - p;
    let most = u.abs().max(v.abs());
    let size = max(max(max(most.x, most.y), most.z), f32::MIN_POSITIVE);
    let normal = (u / size).cross(v / size);
    let normal = normal / max(length(normal), f32::MIN_POSITIVE);
    if normal.dot(ray.direction) < 0.0 { -normal } else { normal }
}

#[kernel]
#[inline(never)]
pub(super) fn first_surface(grid: &CellGrid<'_>, ray: Ray, value: f32) -> Option<SurfaceHit> {
    let line = grid.line(ray);
    let mut done = line.first;
    let mut found = SurfaceHit { t: 0.0, gradient: vec3(0.0, 0.0, 0.0) };
    let mut is_hit = false;
    for hit in grid.entries().hits(line.ray) {
        let mut walk = grid.enter(line, hit.prim_id);
        let (mut is_above, mut is_known) = (false, false);
        while walk.is_inside && walk.enter() < line.last && !is_hit {
            let part = walk.part(done, line.last);
            if walk.is_whole && part.enter < part.leave {
                if !is_known {
                    is_above = part.from > value;
                }
                if (part.to > value) != is_above {
                    // From cell to cell the value may differ by rounding.
                    let begins = (part.from > value) == is_above;
                    let rise = part.to - part.from;
                    let share = (value - part.from) / if rise == 0.0 { 1.0 } else { rise };
                    let share = if begins { clamp(share, 0.0, 1.0) } else { 0.0 };
                    let t = line.start + (part.enter + (part.leave - part.enter) * share);
                    let mut gradient = gradient_in(grid, walk.tetrahedron);
                    if grid.is_of_cells() {
                        let along = normal_of_entry(grid, walk, ray);
                        gradient = if is_above { -along } else { along };
                    }
                    is_hit = true;
                    found = SurfaceHit { t, gradient };
                }
                is_known = true;
            }
            if !walk.is_whole {
                is_known = false;
            }
            done = max(done, walk.leave());
            walk.advance(grid, line);
        }
        if is_hit {
            break;
        }
    }
    if is_hit { Some(found) } else { None }
}
