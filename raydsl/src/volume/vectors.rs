//! Vector fields sampled at regular grids.

use std::borrow::Cow;

use glam::{UVec3, Vec3, vec3};

use super::error::GridError;
use super::grid::{GridConfig, GridLayout, check, layout};
use super::sample::index_of;
use crate::machine::functions::vec3;
use crate::machine::generic::{max, min, transform_point};
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    Capture, DescribedSlice, Leaves, Machine, Method, On, Owner, Parameter, Resource, Schema,
    Slice, Table, TableView, U, V3, Value, name, table_view, visit_value,
};
use crate::{Type, kernel};

/// Vector field sampled at a regular grid, over the application's vectors; trilinear between them.
///
/// Vectors are in the axes of the world, whatever the placement. Where one of the eight around is
/// NaN or infinite there is no value.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::{GridConfig, VectorGrid};
///
/// // Of a vortex around the z axis.
/// let vectors = [(-1, -1), (1, -1), (-1, 1), (1, 1)].map(|(x, y)| ivec3(-y, x, 0).as_vec3());
/// let config = GridConfig::new().origin(vec3(-1.0, -1.0, 0.0)).spacing(vec3(2.0, 2.0, 1.0));
/// let grid = VectorGrid::new(&vectors[..], uvec3(2, 2, 1), config)?;
/// let kernel = kernel!(|p: Vec3| grid.value(p).unwrap_or(Vec3::ZERO));
/// assert_eq!(kernel.call((vec3(0.5, 0.25, 0.0),)), vec3(-0.25, 0.5, 0.0));
/// assert_eq!(grid.value(vec3(1.5, 0.0, 0.0)), None);
/// # Ok::<(), raydsl::volume::GridError>(())
/// ```
#[derive(Debug)]
pub struct VectorGrid<'a> {
    vectors: Cow<'a, [Vec3]>,
    size: UVec3,
    config: GridConfig,
    layout: GridLayout,
    owner: Owner,
}

impl<'a> VectorGrid<'a> {
    /// Creates a grid of `size` vectors over a slice of the application, or with a `Vec` of its
    /// own; the first axis runs fastest, as in a [`Grid`](super::Grid). `scale` and `offset` of the
    /// placement count for each component.
    ///
    /// # Errors
    ///
    /// As [`Grid::new`](super::Grid::new).
    pub fn new(
        vectors: impl Into<Cow<'a, [Vec3]>>,
        size: UVec3,
        config: GridConfig,
    ) -> Result<Self, GridError> {
        let vectors = vectors.into();
        check(size, vectors.len())?;
        let layout = layout(size, &config)?;
        Ok(Self { vectors, size, config, layout, owner: Owner::new() })
    }

    /// Returns the number of vectors along each axis.
    pub fn size(&self) -> UVec3 {
        self.size
    }

    /// Returns placement and unit.
    pub fn config(&self) -> &GridConfig {
        &self.config
    }

    /// Returns the vectors.
    pub fn vectors(&self) -> &[Vec3] {
        &self.vectors
    }

    /// Returns the trilinear vector at a point of the world, or `None` outside of the grid and
    /// where a vector around it is not finite.
    #[inline]
    pub fn value(&self, p: Vec3) -> Option<Vec3> {
        value(self, p)
    }

    #[inline(always)]
    fn layout(&self) -> GridLayout {
        self.layout
    }

    #[inline(always)]
    fn vector(&self, i: u32) -> Vec3 {
        self.vectors[i as usize]
    }

    fn named_view(&self, name: &'static str) -> VectorGridView<'_> {
        let key = BufferKey { id: self.owner.id(), version: 0, part: 0 };
        let vectors = Slice::owned(&self.vectors, Some(key), name).suffixed("vectors");
        VectorGridView { vectors, layout: self.layout, name }
    }
}

/// View of a [`VectorGrid`] in kernels: a host value on every machine.
#[derive(Clone, Copy, Debug)]
pub struct VectorGridView<'a> {
    vectors: Slice<'a, Vec3>,
    layout: GridLayout,
    name: &'static str,
}

table_view!([] VectorGrid<'_>, VectorGridView, "vectors", "grids of vectors");

impl TableView for VectorGridView<'_> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&DescribedSlice(self.vectors));
        visit_value(InUniforms { grid: self.layout }, self.name, visit);
    }

    fn is_same(&self, other: &Self) -> bool {
        core::ptr::eq(self.vectors.elements(), other.vectors.elements())
            && self.layout == other.layout
    }
}

/// Layout in the uniform block: `wind_grid`.
#[derive(Clone, Copy, Type)]
struct InUniforms {
    grid: GridLayout,
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("layout") }, M, ()> for VectorGridView<'_> {
    type Output = On<GridLayout, M>;

    #[inline(always)]
    fn call(self, m: &M, (): ()) -> Self::Output {
        m.capture(self.name, InUniforms { grid: self.layout }).grid
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("vector") }, M, (U<M>,)> for VectorGridView<'_> {
    type Output = V3<M>;

    #[inline(always)]
    fn call(self, m: &M, (i,): (U<M>,)) -> V3<M> {
        m.element(&self.vectors, i)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("value") }, M, (V3<M>,)> for VectorGridView<'_> {
    type Output = On<Option<Vec3>, M>;

    #[inline(always)]
    fn call(self, m: &M, (p,): (V3<M>,)) -> Self::Output {
        value::on(m, self, p)
    }
}

#[kernel]
#[inline(never)]
fn value(grid: &VectorGrid<'_>, p: Vec3) -> Option<Vec3> {
    let layout = grid.layout();
    let at = transform_point(layout.to_voxels, p);
    let (low, high) = (layout.low, layout.high);
    let is_inside = at.x >= low.x
        && at.y >= low.y
        && at.z >= low.z
        && at.x <= high.x
        && at.y <= high.y
        && at.z <= high.z;
    // A NaN becomes 0.
    let cell = min(max(vec3(0.0, 0.0, 0.0), at), layout.last_cell + 0.5).floor();
    let place = min(max(vec3(0.0, 0.0, 0.0), at - cell), vec3(1.0, 1.0, 1.0));
    let steps = layout.steps;
    let first = index_of(cell, steps);
    let near = face(grid, first, steps, place);
    let far = face(grid, first + steps.z, steps, place);
    let vector = (near + (far - near) * place.z) * layout.scale + layout.offset;
    if is_inside && vector.is_finite() { Some(vector) } else { None }
}

/// Returns the bilinear vector in a face across the last axis.
#[kernel]
#[inline]
fn face(grid: &VectorGrid<'_>, first: u32, steps: UVec3, place: Vec3) -> Vec3 {
    let (a, b) = (grid.vector(first), grid.vector(first + steps.x));
    let (c, d) = (grid.vector(first + steps.y), grid.vector(first + steps.y + steps.x));
    let ab = a + (b - a) * place.x;
    let cd = c + (d - c) * place.x;
    ab + (cd - ab) * place.y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layouts_are_told_apart() -> Result<(), GridError> {
        let vectors = [Vec3::X; 4];
        let [a, b, c] =
            [([4, 1, 1], 1.0), ([2, 2, 1], 1.0), ([4, 1, 1], 2.0)].map(|(size, spacing)| {
                let config = GridConfig::new().spacing(Vec3::splat(spacing));
                VectorGrid::new(&vectors[..], UVec3::from(size), config)
            });
        let (a, b, c) = (a?, b?, c?);
        let [a, b, c] = [&a, &b, &c].map(|grid| grid.named_view("grid"));
        assert!(a.is_same(&a) && !a.is_same(&b) && !a.is_same(&c));
        Ok(())
    }
}
