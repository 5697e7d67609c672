//! Walks of a ray from cell to cell of a grid. (Amanatides and Woo, "A Fast Voxel Traversal
//! Algorithm for Ray Tracing", Eurographics 1987, with the distance of each plane computed from its
//! number, so that errors do not add up.)

use glam::{Vec3, vec3};

use crate::geometry::finite_inverse;
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max, min, select};
use crate::{Type, kernel};

/// A ray on its way through cells of one size, along each axis from a first to a last one. The
/// outermost cells reach as far as the ray.
///
/// No comparison is between numbers that are equal but for rounding: behind the last cell there is
/// no plane, and the walk ends at `end`.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct CellWalk {
    origin: Vec3,
    direction: Vec3,
    inverse: Vec3,
    /// 1 or -1 along each axis, 0 where the ray is parallel to the planes.
    step: Vec3,
    /// Cell behind which no plane is left.
    last: Vec3,
    /// Number of the plane where the ray leaves a cell, less the number of the cell.
    ahead: Vec3,
    /// Distances of the planes at which the ray leaves the cell.
    planes: Vec3,
    /// Edge of a cell.
    size: f32,
    /// Current cell.
    pub(super) cell: Vec3,
    /// Distance at which the ray enters it.
    pub(super) enter: f32,
    /// Distance at which it leaves it.
    pub(super) leave: f32,
    end: f32,
    /// Whether the cell is the last one that the ray enters.
    is_last: bool,
    /// Whether the ray is in a cell.
    pub(super) is_inside: bool,
}

#[kernel]
impl CellWalk {
    /// Begins a walk at the distance `start`, up to `end`.
    #[inline]
    pub(super) fn new(
        origin: Vec3,
        direction: Vec3,
        size: f32,
        first: Vec3,
        last: Vec3,
        start: f32,
        end: f32,
    ) -> CellWalk {
        let zero = vec3(0.0, 0.0, 0.0);
        let one = vec3(1.0, 1.0, 1.0);
        let is_up = direction.cmpgt(zero);
        let step = Vec3::select(is_up, one, Vec3::select(direction.cmplt(zero), -one, zero));
        let at = (origin + direction * start) / size;
        let walk = CellWalk {
            origin,
            direction,
            inverse: finite_inverse(direction),
            step,
            last: Vec3::select(is_up, last, first),
            ahead: Vec3::select(is_up, one, zero),
            planes: zero,
            size,
            cell: clamp(at, first, last + 0.5).floor(),
            enter: start,
            leave: start,
            end,
            is_last: false,
            is_inside: start < end,
        };
        walk.settled()
    }

    /// Returns the walk with the planes of its cell.
    #[inline(always)]
    fn settled(self) -> CellWalk {
        let distance = ((self.cell + self.ahead) * self.size - self.origin) * self.inverse;
        let is_none = self.cell.cmpeq(self.last) | self.step.cmpeq(vec3(0.0, 0.0, 0.0));
        let planes = Vec3::select(is_none, vec3(f32::MAX, f32::MAX, f32::MAX), distance);
        let nearest = min(min(planes.x, planes.y), planes.z);
        let is_last = nearest >= self.end;
        let leave = if is_last { self.end } else { max(nearest, self.enter) };
        CellWalk { planes, leave, is_last, ..self }
    }

    /// Goes on to the next cell.
    #[inline(always)]
    pub(super) fn advance(&mut self) {
        let planes = self.planes;
        let is_x = (planes.x <= planes.y) & (planes.x <= planes.z);
        let is_y = !is_x & (planes.y <= planes.z);
        let x = select(is_x, self.step.x, 0.0);
        let y = select(is_y, self.step.y, 0.0);
        let z = select(is_x | is_y, 0.0, self.step.z);
        self.cell += vec3(x, y, z);
        self.enter = self.leave;
        self.is_inside = !self.is_last;
        *self = self.settled();
    }

    /// Begins the walk through the cells of the current macro-cell. Those at the border of the grid
    /// have `outer` more outside, for the outer halves of voxels.
    #[inline]
    pub(super) fn cells_of(&self, last_macro: Vec3, last_cell: Vec3, outer: Vec3) -> CellWalk {
        let first = self.cell * self.size;
        let last = first + (self.size - 1.0);
        let begin = Vec3::select(self.cell.cmpeq(vec3(0.0, 0.0, 0.0)), first - outer, first);
        let end = Vec3::select(self.cell.cmpeq(last_macro), last_cell + outer, last);
        CellWalk::new(self.origin, self.direction, 1.0, begin, end, self.enter, self.leave)
    }
}
