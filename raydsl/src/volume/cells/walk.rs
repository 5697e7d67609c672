//! Walks of a ray from cell to cell, by the faces that they share.

use glam::{UVec4, Vec3};

use super::CellGrid;
use super::frame::{Corner, Pierced, RayFrame, is_left, pierced};
use super::mesh::Tetrahedron;
use crate::geometry::Ray;
use crate::machine::generic::{clamp, length, max, min};
use crate::{Type, kernel};

/// A ray before it enters a mesh of cells: the hits of `entries` with its [`ray`](Self::ray) are
/// where it does.
#[derive(Clone, Copy, Debug, Type)]
pub struct CellLine {
    /// The whole line up to the ray's end, from the box around the mesh on.
    pub ray: Ray,
    frame: RayFrame,
    /// Distance of its origin along the ray that was given; distances in cells are behind it.
    pub start: f32,
    /// Distance at which the given ray begins.
    pub first: f32,
    /// Distance at which it ends.
    pub last: f32,
    /// Length in the world of a distance of 1.
    pub scale: f32,
}

/// Walk of a ray through the cells that are joined to one where it enters the mesh.
///
/// Of the four faces of a tetrahedron a ray passes through two or none, by exact signs, and each
/// face is that of two tetrahedra at most. So the faces that a ray passes through are chains: one
/// that begins at an outer face ends at another one, and has no tetrahedron twice. Beyond that no
/// walk takes more steps than there are tetrahedra, whatever a device's arithmetic is.
#[derive(Clone, Copy, Debug, Type)]
pub struct CellWalk {
    a: Corner,
    b: Corner,
    c: Corner,
    into: Pierced,
    out: Pierced,
    /// What is across the face where the ray leaves the cell.
    next: u32,
    /// Place of the cell's vertex that the face where the ray enters it lacks.
    pub(super) lacking: u32,
    /// The tetrahedron.
    pub tetrahedron: u32,
    /// Cells that may follow at most.
    left: u32,
    /// Whether all values of the cell are finite.
    pub is_whole: bool,
    /// Whether the ray is in a cell.
    pub is_inside: bool,
}

/// The part of a ray in a cell; the field is linear from its one end to the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct CellPart {
    /// Distance at which it begins, from the line's `start` on.
    pub enter: f32,
    /// Distance at which it ends; not behind `enter` if there is no such part.
    pub leave: f32,
    /// Value where it begins.
    pub from: f32,
    /// Value where it ends.
    pub to: f32,
}

#[kernel]
#[inline]
pub(super) fn line_of(grid: &CellGrid<'_>, ray: Ray) -> CellLine {
    let bounds = grid.layout().bounds;
    let (enter, leave) = bounds.span(ray.with_range(-f32::MAX, f32::MAX));
    let is_met = enter <= leave;
    let start = if is_met { enter } else { 0.0 };
    let line = Ray { origin: ray.at(start), ..ray };
    let last = ray.t_max - start;
    let line =
        line.with_range(if is_met { -f32::MAX } else { 1.0 }, if is_met { last } else { 0.0 });
    let frame = RayFrame::new(line);
    let scale = length(ray.direction);
    CellLine { ray: line, frame, start, first: ray.t_min - start, last, scale }
}

/// Returns a vertex of the mesh as the ray sees it.
#[kernel]
#[inline]
fn corner(grid: &CellGrid<'_>, line: CellLine, index: u32) -> Corner {
    let mut value = 0.0;
    if !grid.is_of_cells() {
        value = grid.number(index);
    }
    Corner { at: line.frame.seen(grid.point(index)), value, index }
}

/// Begins the walk behind the entry with this number.
#[kernel]
#[inline]
pub(super) fn enter(grid: &CellGrid<'_>, line: CellLine, entry: u32) -> CellWalk {
    let face = grid.face(entry);
    let [v0, v1, v2] = face.vertices;
    let (a, b, c) = (corner(grid, line, v0), corner(grid, line, v1), corner(grid, line, v2));
    let into = pierced(a, b, c);
    let walk = CellWalk {
        a,
        b,
        c,
        into,
        out: into,
        next: face.cell,
        lacking: 0u32,
        tetrahedron: 0u32,
        left: grid.layout().tetrahedra,
        is_whole: true,
        is_inside: true,
    };
    stepped(grid, line, walk)
}

/// Returns one of four.
#[kernel]
#[inline]
pub(super) fn pick(all: UVec4, i: u32) -> u32 {
    let low = if i == 0 { all.x } else { all.y };
    let high = if i == 2 { all.z } else { all.w };
    if i < 2 { low } else { high }
}

/// Returns the walk in the cell that is across its face, with the face where it leaves that.
#[kernel]
#[inline]
fn stepped(grid: &CellGrid<'_>, line: CellLine, walk: CellWalk) -> CellWalk {
    let tetrahedron = walk.next / 4;
    let lacking = walk.next & 3;
    let cell: Tetrahedron = grid.tetrahedron(tetrahedron);
    let d = corner(grid, line, pick(cell.vertices, lacking));
    // The ray leaves by the one of the other three faces within whose edges it is. The face behind
    // it runs anticlockwise, as seen by the ray, and so does the next.
    let (left_a, left_b, left_c) =
        (is_left(walk.a.at, d.at), is_left(walk.b.at, d.at), is_left(walk.c.at, d.at));
    let without_a = left_c && !left_b;
    let without_b = left_a && !left_c && !without_a;
    let without_c = !without_a && !without_b;
    let gone = if without_a {
        walk.a.index
    } else if without_b {
        walk.b.index
    } else {
        walk.c.index
    };
    let a = if without_a { d } else { walk.a };
    let b = if without_b { d } else { walk.b };
    let c = if without_c { d } else { walk.c };
    let v = cell.vertices;
    let place = if v.x == gone {
        0u32
    } else if v.y == gone {
        1u32
    } else if v.z == gone {
        2u32
    } else {
        3u32
    };
    let mut out = pierced(a, b, c);
    let mut into = walk.out;
    let mut is_whole = true;
    if grid.is_of_cells() {
        let value = grid.number(cell.cell);
        into = Pierced { t: into.t, value };
        out = Pierced { t: out.t, value };
        if grid.has_gaps() {
            is_whole = value.is_finite();
        }
    } else if grid.has_gaps() {
        let near = walk.a.value.is_finite() & walk.b.value.is_finite() & walk.c.value.is_finite();
        is_whole = near & d.value.is_finite();
    }
    CellWalk {
        a,
        b,
        c,
        into,
        out,
        next: pick(cell.across, place),
        lacking,
        tetrahedron,
        left: walk.left - 1,
        is_whole,
        is_inside: true,
    }
}

#[kernel]
impl CellWalk {
    /// Returns the distance at which the ray enters the cell, from the line's `start` on.
    #[inline]
    pub fn enter(&self) -> f32 {
        self.into.t
    }

    /// Returns the distance at which the ray leaves it; before the other one in a cell that is
    /// folded over its neighbours.
    #[inline]
    pub fn leave(&self) -> f32 {
        self.out.t
    }

    /// Returns the part of the ray in this cell between two distances.
    #[inline]
    pub fn part(&self, first: f32, last: f32) -> CellPart {
        let (begin, end) = (self.into, self.out);
        let (enter, leave) = (max(begin.t, first), min(end.t, last));
        let width = end.t - begin.t;
        let per = 1.0 / if width > 0.0 { width } else { 1.0 };
        let rise = end.value - begin.value;
        let at = clamp((enter - begin.t) * per, 0.0, 1.0);
        let left = clamp((end.t - leave) * per, 0.0, 1.0);
        // Each from the nearer end of the cell: a whole cell has the values of its faces.
        CellPart { enter, leave, from: begin.value + rise * at, to: end.value - rise * left }
    }

    /// Goes on to the next cell.
    #[inline]
    pub fn advance(&mut self, grid: &CellGrid<'_>, line: CellLine) {
        if self.next != u32::MAX && self.left > 0 {
            *self = stepped(grid, line, *self);
        } else {
            self.is_inside = false;
        }
    }
}

impl CellGrid<'_> {
    /// Returns a ray as it meets the mesh. With [`enter`](Self::enter) it makes walks of one's own,
    /// on the host and in kernels:
    ///
    /// ```
    /// use raydsl::prelude::*;
    /// use raydsl::volume::cells::{CellData, CellGrid, CellKind, CellMesh};
    ///
    /// let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// let mesh = CellMesh::new(&points, &[0, 1, 2, 3], &[CellKind::Tetrahedron])?;
    /// let grid = CellGrid::new(&mesh, CellData::Points(&[1.0, 1.0, 1.0, 3.0]))?;
    /// // The integral of the values along a ray.
    /// let kernel = kernel!(|ray: Ray| {
    ///     let line = grid.line(ray);
    ///     let mut sum = 0.0;
    ///     for hit in grid.entries().hits(line.ray) {
    ///         let mut walk = grid.enter(line, hit.prim_id);
    ///         while walk.is_inside {
    ///             let part = walk.part(line.first, line.last);
    ///             sum += max(part.leave - part.enter, 0.0) * (part.from + part.to) * 0.5;
    ///             walk.advance(&grid, line);
    ///         }
    ///     }
    ///     sum
    /// });
    /// assert_eq!(kernel.call((Ray::new(vec3(0.25, 0.25, -1.0), Vec3::Z),)), 0.75);
    /// # Ok::<(), raydsl::volume::cells::CellError>(())
    /// ```
    #[inline]
    pub fn line(&self, ray: Ray) -> CellLine {
        line_of(self, ray)
    }

    /// Returns the walk that begins at an outer face, given by its number as a hit of
    /// [`entries`](Self::entries) has it.
    #[inline]
    pub fn enter(&self, line: CellLine, entry: u32) -> CellWalk {
        enter(self, line, entry)
    }
}

/// Returns the points of a tetrahedron.
#[kernel]
#[inline]
pub(super) fn points_of(grid: &CellGrid<'_>, vertices: UVec4) -> (Vec3, Vec3, Vec3, Vec3) {
    (grid.point(vertices.x), grid.point(vertices.y), grid.point(vertices.z), grid.point(vertices.w))
}
