//! Values of a grid along a ray: surfaces of one value, the greatest value, the mean.

use glam::{Vec2, Vec3, vec3};

use super::cubic::{Cubic, Extremes, next_extreme, place_of};
use super::grid::{Grid, GridLayout};
use super::integrator::{Inside, inside, macro_walk};
use super::sample::{InCell, cell_at, gradient_in, index_of};
use super::voxel::Voxel;
use crate::geometry::Ray;
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max, min};
use crate::{Type, kernel};

/// Point where a ray meets the surface of one value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct SurfaceHit {
    /// Distance along the ray.
    pub t: f32,
    /// Gradient of the value there, across the surface: change per length of the world.
    pub gradient: Vec3,
}

/// A ray in a cell of the grid.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Passed {
    pub(super) cubic: Cubic,
    pub(super) cell: InCell,
    from: Vec3,
    to: Vec3,
}

/// Returns the value along a ray through a cell, from one distance to another.
#[kernel]
#[inline]
pub(super) fn passed<T: Voxel>(
    grid: &Grid<'_, T>,
    part: Inside,
    at: Vec3,
    enter: f32,
    leave: f32,
) -> Passed {
    let layout: GridLayout = grid.layout();
    let (zero, one) = (vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0));
    let corner = clamp(at, zero, layout.last_cell);
    let cell = cell_at(grid, corner);
    let from = clamp(part.origin + part.direction * enter - corner, zero, one);
    let to = clamp(part.origin + part.direction * leave - corner, zero, one);
    let cubic = Cubic::through(cell.corners, from, to).rescaled(layout.scale, layout.offset);
    Passed { cubic, cell, from, to }
}

/// Returns the least and the greatest value of a macro-cell.
#[kernel]
#[inline]
fn range_of<T: Voxel>(grid: &Grid<'_, T>, cell: Vec3) -> Vec2 {
    grid.range_at(index_of(cell, grid.layout().macro_steps))
}

/// Walk along a ray from one surface of a value to the next.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::{Grid, GridConfig, SurfaceWalk, next_surface};
///
/// // 0, 1, 0, 1 along z.
/// let voxels: Vec<f32> = (0..16).map(|i| (i / 4 % 2) as f32).collect();
/// let grid = Grid::new(voxels, uvec3(2, 2, 4), GridConfig::new())?;
/// let last = kernel!(|ray: Ray| {
///     let mut walk = SurfaceWalk::new(ray, 0.5);
///     let mut last = -1.0;
///     while let Some(surface) = next_surface(&grid, &mut walk) {
///         last = surface.t;
///     }
///     last
/// });
/// assert_eq!(last.call((Ray::new(vec3(0.5, 0.5, 0.0), Vec3::Z),)), 2.5);
/// # Ok::<(), raydsl::volume::GridError>(())
/// ```
#[derive(Clone, Copy, Debug, Type)]
pub struct SurfaceWalk {
    /// What is left of the ray.
    pub rest: Ray,
    /// Value of the surfaces.
    pub value: f32,
    /// Whether values where the rest begins are above, if that is known.
    is_above: bool,
    is_known: bool,
}

#[kernel]
impl SurfaceWalk {
    /// Begins a walk at the ray's `t_min`, up to `t_max`.
    #[inline]
    pub fn new(ray: Ray, value: f32) -> Self {
        Self { rest: ray, value, is_above: false, is_known: false }
    }
}

/// Returns where the ray next meets an isosurface, from either side: the root of the cubic that the
/// value is along the ray, to within rounding. A ray that touches a surface meets it where its
/// value rises above, and where it falls back. Cells with missing voxels have no surfaces.
#[kernel]
#[inline(never)]
pub fn next_surface<T: Voxel>(grid: &Grid<'_, T>, walk: &mut SurfaceWalk) -> Option<SurfaceHit> {
    let layout: GridLayout = grid.layout();
    let value = walk.value;
    let part = inside(grid, walk.rest);
    let (start, _) = grid.span(walk.rest);
    let mut found = SurfaceHit { t: 0.0, gradient: vec3(0.0, 0.0, 0.0) };
    let mut is_hit = false;
    let mut macros = macro_walk(grid, part);
    while macros.is_inside && !is_hit {
        let range = range_of(grid, macros.cell);
        if range.x <= value && value <= range.y {
            let mut cells =
                macros.cells_of(layout.last_macro, layout.last_cell, -layout.low.floor());
            while cells.is_inside && !is_hit {
                let Passed { cubic, cell, from, to } =
                    passed(grid, part, cells.cell, cells.enter, cells.leave);
                if cell.is_whole {
                    let extremes = cubic.extremes();
                    if !walk.is_known {
                        walk.is_above = cubic.c0 > value;
                    }
                    let mut x = 0.0;
                    while x < 1.0 && !is_hit {
                        let stop = next_extreme(extremes, x);
                        if (cubic.at(stop) > value) != walk.is_above {
                            // From cell to cell the value may differ by rounding.
                            let begins = (cubic.at(x) > value) == walk.is_above;
                            let root = if begins { place_of(cubic, value, x, stop) } else { x };
                            let share = clamp(root, x, stop);
                            let place = from + (to - from) * share;
                            is_hit = true;
                            found = SurfaceHit {
                                t: start + (cells.enter + (cells.leave - cells.enter) * share),
                                gradient: gradient_in(grid, InCell { place, ..cell }),
                            };
                        }
                        x = stop;
                    }
                }
                walk.is_known = cell.is_whole;
                cells.advance();
            }
        } else {
            walk.is_known = false;
        }
        macros.advance();
    }
    walk.is_above = !walk.is_above;
    walk.is_known = is_hit;
    let rest = if is_hit { found.t } else { walk.rest.t_max };
    walk.rest = walk.rest.with_range(rest, walk.rest.t_max);
    if is_hit { Some(found) } else { None }
}

#[kernel]
#[inline(never)]
pub(super) fn first_surface<T: Voxel>(
    grid: &Grid<'_, T>,
    ray: Ray,
    value: f32,
) -> Option<SurfaceHit> {
    let mut walk = SurfaceWalk::new(ray, value);
    next_surface(grid, &mut walk)
}

#[kernel]
#[inline(never)]
pub(super) fn greatest<T: Voxel>(grid: &Grid<'_, T>, ray: Ray) -> f32 {
    let layout: GridLayout = grid.layout();
    let part = inside(grid, ray);
    let mut most = -f32::MAX;
    let mut walk = macro_walk(grid, part);
    while walk.is_inside {
        if range_of(grid, walk.cell).y > most {
            let mut cells = walk.cells_of(layout.last_macro, layout.last_cell, -layout.low.floor());
            while cells.is_inside {
                let Passed { cubic, cell, .. } =
                    passed(grid, part, cells.cell, cells.enter, cells.leave);
                if cell.is_whole {
                    let Extremes { first, second } = cubic.extremes();
                    let ends = max(cubic.c0, cubic.at(1.0));
                    let inner = max(cubic.at(min(first, 1.0)), cubic.at(min(second, 1.0)));
                    most = max(most, max(ends, inner));
                }
                cells.advance();
            }
        }
        walk.advance();
    }
    most
}

#[kernel]
#[inline(never)]
pub(super) fn mean<T: Voxel>(grid: &Grid<'_, T>, ray: Ray) -> f32 {
    let layout: GridLayout = grid.layout();
    let part = inside(grid, ray);
    let (mut sum, mut length) = (0.0, 0.0);
    let mut walk = macro_walk(grid, part);
    while walk.is_inside {
        let (mut inner, mut run) = (0.0, 0.0);
        let mut cells = walk.cells_of(layout.last_macro, layout.last_cell, -layout.low.floor());
        while cells.is_inside {
            let width = cells.leave - cells.enter;
            let Passed { cubic, cell, .. } =
                passed(grid, part, cells.cell, cells.enter, cells.leave);
            if cell.is_whole {
                let Cubic { c0, c1, c2, c3 } = cubic;
                inner += (c0 + (c1 * 0.5 + (c2 * (1.0 / 3.0) + c3 * 0.25))) * width;
                run += width;
            }
            cells.advance();
        }
        sum += inner;
        length += run;
        walk.advance();
    }
    if length > 0.0 { sum / length } else { 0.0 }
}
