//! Values of a grid along a ray: surfaces of one value, the greatest value, the mean.

use glam::{Vec2, Vec3, vec3};

use super::cubic::{Cubic, Extremes, place_of};
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
    /// Whether there is one. If not, the rest is 0.
    pub is_hit: bool,
    /// Distance along the ray.
    pub t: f32,
    /// Gradient of the value there, across the surface: change per length of the world.
    pub gradient: Vec3,
}

/// A ray in a cell of the grid.
#[derive(Clone, Copy, Debug, Type)]
struct Passed {
    cubic: Cubic,
    cell: InCell,
    from: Vec3,
    to: Vec3,
}

/// Returns the value along a ray through a cell, from one distance to another.
#[kernel]
#[inline]
fn passed<T: Voxel>(grid: &Grid<'_, T>, part: Inside, at: Vec3, enter: f32, leave: f32) -> Passed {
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

#[kernel]
#[inline(never)]
pub(super) fn first_surface<T: Voxel>(grid: &Grid<'_, T>, ray: Ray, value: f32) -> SurfaceHit {
    let layout: GridLayout = grid.layout();
    let part = inside(grid, ray);
    let (start, _) = grid.span(ray);
    let mut found = SurfaceHit { is_hit: false, t: 0.0, gradient: vec3(0.0, 0.0, 0.0) };
    // The side of the value where the ray comes from, if that is known.
    let (mut is_above, mut is_known) = (false, false);
    let mut walk = macro_walk(grid, part);
    while walk.is_inside && !found.is_hit {
        let range = range_of(grid, walk.cell);
        if range.x <= value && value <= range.y {
            let mut cells = walk.cells_of(layout.last_macro, layout.last_cell, -layout.low.floor());
            while cells.is_inside && !found.is_hit {
                let Passed { cubic, cell, from, to } =
                    passed(grid, part, cells.cell, cells.enter, cells.leave);
                if cell.is_whole {
                    let Extremes { first, second } = cubic.extremes();
                    if !is_known {
                        is_above = cubic.c0 > value;
                    }
                    let mut x = 0.0;
                    while x < 1.0 && !found.is_hit {
                        let stop = if x < first {
                            min(first, 1.0)
                        } else if x < second {
                            min(second, 1.0)
                        } else {
                            1.0
                        };
                        if (cubic.at(stop) > value) != is_above {
                            // From cell to cell the value may differ by rounding.
                            let begins = (cubic.at(x) > value) == is_above;
                            let place = if begins { place_of(cubic, value, x, stop) } else { x };
                            let share = clamp(place, x, stop);
                            let place = from + (to - from) * share;
                            found = SurfaceHit {
                                is_hit: true,
                                t: start + (cells.enter + (cells.leave - cells.enter) * share),
                                gradient: gradient_in(grid, InCell { place, ..cell }),
                            };
                        }
                        x = stop;
                    }
                }
                is_known = cell.is_whole;
                cells.advance();
            }
        } else {
            is_known = false;
        }
        walk.advance();
    }
    found
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
