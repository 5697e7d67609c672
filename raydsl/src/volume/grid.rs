//! Grids: scalar fields sampled at regular places.

use std::borrow::Cow;

use glam::{Affine3, Mat3, UVec3, Vec2, Vec3, vec2};

use super::along::{self, SurfaceHit};
use super::blend::{self, Blend, BlendView};
use super::error::GridError;
use super::sample;
use super::voxel::{Corners, Voxel};
use crate::Type;
use crate::geometry::affine::inverted;
use crate::geometry::{Ray, RayOn};
use crate::machine::table_view;
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    B, Capture, DescribedSlice, F, HostFact, Leaves, Machine, Method, Owner, Parameter, Resource,
    Schema, Slice, Table, TableView, U, V3, Value, X3, name, visit_value,
};

/// Maximum number of voxels along an axis of a grid: up to here a place between two voxels has four
/// bits left in an `f32`.
pub const MAX_SIDE: u32 = 1 << 20;

/// Maximum number of voxels of a grid.
pub const MAX_VOXELS: u64 = 1 << 31;

/// Number of cells along each side of a macro-cell, the unit in which empty space is skipped.
pub const MACRO_CELL: u32 = 8;

/// Where the samples of a grid lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Centering {
    /// At the corners of cells: `n` samples span `n - 1` spacings. Values outside do not exist.
    #[default]
    Vertex,
    /// At the centres of voxels with an extent of their own, as those of a scanner: `n` samples
    /// span `n` spacings, and the outer half of the first and the last has the value of its centre.
    Cell,
}

/// Placement of a grid, and the unit of its values.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::{Centering, GridConfig};
///
/// let config = GridConfig::new().spacing(vec3(0.5, 0.5, 2.0)).centering(Centering::Cell);
/// assert_eq!(config.to_world.transform_point3(vec3(2.0, 0.0, 1.0)), vec3(1.0, 0.0, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridConfig {
    /// Map from voxel coordinates, in which sample `(i, j, k)` is at that point, to the world.
    pub to_world: Affine3,
    /// Where the samples lie. At the corners of cells unless set.
    pub centering: Centering,
    /// Factor of all values. 1 unless set.
    pub scale: f32,
    /// Summand of all values, added after the factor. 0 unless set.
    pub offset: f32,
}

impl Default for GridConfig {
    fn default() -> Self {
        Self::new()
    }
}

impl GridConfig {
    /// Creates the placement in voxel coordinates: samples at whole numbers.
    pub const fn new() -> Self {
        Self { to_world: Affine3::IDENTITY, centering: Centering::Vertex, scale: 1.0, offset: 0.0 }
    }

    /// Sets the distance between samples along each axis.
    #[must_use]
    pub fn spacing(self, spacing: Vec3) -> Self {
        let to_world = Affine3 { matrix3: Mat3::from_diagonal(spacing), ..self.to_world };
        Self { to_world, ..self }
    }

    /// Sets the position of the first sample.
    #[must_use]
    pub const fn origin(self, origin: Vec3) -> Self {
        let Affine3 { matrix3, .. } = self.to_world;
        Self { to_world: Affine3 { matrix3, translation: origin }, ..self }
    }

    /// Sets the whole map from voxel coordinates to the world.
    #[must_use]
    pub const fn to_world(self, to_world: Affine3) -> Self {
        Self { to_world, ..self }
    }

    /// Sets where the samples lie.
    #[must_use]
    pub const fn centering(self, centering: Centering) -> Self {
        Self { centering, ..self }
    }

    /// Sets the unit of values: `value = voxel * scale + offset`.
    #[must_use]
    pub const fn rescale(self, scale: f32, offset: f32) -> Self {
        Self { scale, offset, ..self }
    }
}

/// A grid's numbers in kernels.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct GridLayout {
    /// Map from the world to voxel coordinates.
    pub to_voxels: Affine3,
    /// Least voxel coordinates of the domain.
    pub low: Vec3,
    /// Greatest voxel coordinates of the domain.
    pub high: Vec3,
    /// Number of the last cell along each axis.
    pub last_cell: Vec3,
    /// Number of the last macro-cell along each axis.
    pub last_macro: Vec3,
    /// Numbers of voxels between neighbours along each axis, 0 along an axis of one voxel.
    pub steps: UVec3,
    /// Numbers of macro-cells between neighbours along each axis.
    pub macro_steps: UVec3,
    /// Factor of all values.
    pub scale: f32,
    /// Summand of all values.
    pub offset: f32,
}

/// Scalar field sampled at a regular grid, over the application's voxels.
///
/// Between the samples it is trilinear. Kernels capture a grid or take it as `&Grid<'_, T>`:
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::{Grid, GridConfig};
///
/// let voxels: [u8; 8] = [0, 10, 20, 30, 40, 50, 60, 70];
/// let grid = Grid::new(&voxels[..], uvec3(2, 2, 2), GridConfig::new())?;
/// assert_eq!(grid.value(vec3(0.5, 0.5, 0.5)), 35.0);
///
/// let slope = kernel!(|p: Vec3| grid.gradient(p).z);
/// assert_eq!(slope.call((vec3(0.2, 0.3, 0.4),)), 40.0);
/// # Ok::<(), raydsl::volume::GridError>(())
/// ```
///
/// Voxels that are NaN or infinite are missing, and so is a cell with one at a corner: its value
/// and its gradient are 0, [`has_value`](Self::has_value) is false, and integrators pass it as if
/// it were empty.
#[derive(Debug)]
pub struct Grid<'a, T: Voxel> {
    pub(super) stored: Cow<'a, [T::Stored]>,
    /// Identity of what is stored: that of another grid if it is borrowed from one.
    pub(super) stored_key: BufferKey,
    /// Where values are between two steps in time.
    pub(super) blend: Option<Blend<'a, T>>,
    /// Least and greatest value of each macro-cell.
    pub(super) ranges: Vec<Vec2>,
    pub(super) size: UVec3,
    pub(super) config: GridConfig,
    pub(super) layout: GridLayout,
    pub(super) has_gaps: bool,
    pub(super) owner: Owner,
}

impl<'a, T: Voxel> Grid<'a, T> {
    /// Creates a grid of `size` voxels over a slice of the application, or with a `Vec` of its own.
    /// The first axis runs fastest: voxel `(x, y, z)` has the index
    /// `(z * size.y + y) * size.x + x`.
    ///
    /// # Errors
    ///
    /// If an axis has no voxels or more than [`MAX_SIDE`], all together have more than
    /// [`MAX_VOXELS`], their number does not match the sizes, or the placement is not finite or has
    /// no inverse.
    pub fn new(
        voxels: impl Into<Cow<'a, [T]>>,
        size: UVec3,
        config: GridConfig,
    ) -> Result<Self, GridError>
    where
        [T]: ToOwned<Owned = Vec<T>>,
    {
        let voxels = voxels.into();
        check(size, voxels.len())?;
        let layout = layout(size, &config)?;
        let (ranges, has_gaps) = ranges(&voxels, size, &config);
        let (stored, owner) = (T::stored(voxels, size), Owner::new());
        let stored_key = key(&owner, 0);
        let blend = None;
        Ok(Self { stored, stored_key, blend, ranges, size, config, layout, has_gaps, owner })
    }

    /// Returns the number of voxels along each axis.
    pub fn size(&self) -> UVec3 {
        self.size
    }

    /// Returns placement and unit.
    pub fn config(&self) -> &GridConfig {
        &self.config
    }

    /// Returns the least and the greatest value of each macro-cell of [`MACRO_CELL`]³ cells, the
    /// first axis fastest. Missing voxels do not count; a macro-cell without any other has
    /// `x > y`.
    pub fn ranges(&self) -> &[Vec2] {
        &self.ranges
    }

    /// Returns the number of macro-cells along each axis.
    pub fn macro_cells(&self) -> UVec3 {
        macro_cells(self.size)
    }

    /// Returns the least and the greatest value of the whole grid; `x > y` if there is none.
    pub fn range(&self) -> Vec2 {
        self.ranges.iter().fold(NO_RANGE, |a, b| vec2(a.x.min(b.x), a.y.max(b.y)))
    }

    pub(super) fn named_view(&self, name: &'static str) -> GridView<'_, T> {
        GridView {
            stored: Slice::owned(&self.stored, Some(self.stored_key), name).suffixed("voxels"),
            blend: self.blend.as_ref().map(|blend| blend.view(name)),
            ranges: Slice::owned(&self.ranges, Some(key(&self.owner, 1)), name).suffixed("ranges"),
            layout: self.layout,
            has_gaps: self.has_gaps,
            name,
        }
    }
}

fn key(owner: &Owner, part: u32) -> BufferKey {
    BufferKey { id: owner.id(), version: 0, part }
}

/// The range of nothing.
pub(super) const NO_RANGE: Vec2 = vec2(f32::INFINITY, f32::NEG_INFINITY);

pub(super) fn check(size: UVec3, found: usize) -> Result<(), GridError> {
    for (axis, size) in size.to_array().into_iter().enumerate() {
        if size == 0 {
            return Err(GridError::NoVoxels { axis });
        }
        if size > MAX_SIDE {
            return Err(GridError::TooLong { axis, size, limit: MAX_SIDE });
        }
    }
    let count: u128 = size.to_array().iter().map(|n| u128::from(*n)).product();
    let expected = u64::try_from(count).ok().filter(|n| *n <= MAX_VOXELS);
    let expected = expected.ok_or(GridError::TooManyVoxels { count, limit: MAX_VOXELS })?;
    if expected != found as u64 {
        return Err(GridError::WrongLength { expected, found });
    }
    Ok(())
}

/// Returns the number of cells along each axis, at least 1.
fn cells(size: UVec3) -> UVec3 {
    size.saturating_sub(UVec3::ONE).max(UVec3::ONE)
}

fn macro_cells(size: UVec3) -> UVec3 {
    (cells(size) + UVec3::splat(MACRO_CELL - 1)) / MACRO_CELL
}

pub(super) fn layout(size: UVec3, config: &GridConfig) -> Result<GridLayout, GridError> {
    let GridConfig { to_world, centering, scale, offset } = *config;
    if !(scale.is_finite() && offset.is_finite()) {
        return Err(GridError::Scale { scale, offset });
    }
    let to_voxels = inverted(to_world).ok_or(GridError::Placement)?.to_object;
    let last = (size - UVec3::ONE).as_vec3();
    let half = if centering == Centering::Cell { Vec3::splat(0.5) } else { Vec3::ZERO };
    let macros = macro_cells(size);
    let step = |count: u32, step: u32| if count > 1 { step } else { 0 };
    Ok(GridLayout {
        to_voxels,
        low: -half,
        high: last + half,
        last_cell: (cells(size) - UVec3::ONE).as_vec3(),
        last_macro: (macros - UVec3::ONE).as_vec3(),
        steps: UVec3::new(step(size.x, 1), step(size.y, size.x), step(size.z, size.x * size.y)),
        macro_steps: UVec3::new(1, macros.x, macros.x * macros.y),
        scale,
        offset,
    })
}

/// Returns the range of each macro-cell, and whether voxels are missing.
fn ranges<T: Voxel>(voxels: &[T], size: UVec3, config: &GridConfig) -> (Vec<Vec2>, bool) {
    let (macros, last) = (macro_cells(size), size - UVec3::ONE);
    let range = |i: u32| {
        let at = UVec3::new(i % macros.x, i / macros.x % macros.y, i / (macros.x * macros.y));
        let first = at * MACRO_CELL;
        let end = (first + UVec3::splat(MACRO_CELL)).min(last);
        let (mut range, mut has_gaps) = (NO_RANGE, false);
        for z in first.z..=end.z {
            for y in first.y..=end.y {
                let row = (z as usize * size.y as usize + y as usize) * size.x as usize;
                for voxel in &voxels[row + first.x as usize..=row + end.x as usize] {
                    let v = voxel.number();
                    if v.is_finite() {
                        range = vec2(range.x.min(v), range.y.max(v));
                    } else {
                        has_gaps = true;
                    }
                }
            }
        }
        (rescaled(range, config), has_gaps)
    };
    let count = macros.x * macros.y * macros.z;
    #[cfg(feature = "parallel")]
    let all: Vec<(Vec2, bool)> = {
        use rayon::prelude::*;
        (0..count).into_par_iter().map(range).collect()
    };
    #[cfg(not(feature = "parallel"))]
    let all: Vec<(Vec2, bool)> = (0..count).map(range).collect();
    let has_gaps = all.iter().any(|(_, has_gaps)| *has_gaps);
    (all.into_iter().map(|(range, _)| range).collect(), has_gaps)
}

/// Returns the range of values with this range of voxels, widened by the rounding of interpolation.
fn rescaled(range: Vec2, config: &GridConfig) -> Vec2 {
    if range.x > range.y {
        return range;
    }
    let (a, b) = (range.x * config.scale, range.y * config.scale);
    // A value between two voxels may lie beyond both by its rounding.
    let slack = 8.0 * f32::EPSILON * a.abs().max(b.abs()).max(config.offset.abs());
    let (low, high) = (a.min(b) + config.offset, a.max(b) + config.offset);
    if range.x == range.y { vec2(low, high) } else { vec2(low - slack, high + slack) }
}

/// View of a [`Grid`] in kernels: a host value on every machine.
#[derive(Debug)]
pub struct GridView<'a, T: Voxel> {
    pub(super) stored: Slice<'a, T::Stored>,
    pub(super) blend: Option<BlendView<'a, T>>,
    ranges: Slice<'a, Vec2>,
    layout: GridLayout,
    has_gaps: bool,
    pub(super) name: &'static str,
}

impl<T: Voxel> Clone for GridView<'_, T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T: Voxel> Copy for GridView<'_, T> {}

table_view!([T: Voxel] Grid<'_, T>, GridView, "grid", "grids");

impl<T: Voxel> TableView for GridView<'_, T> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&DescribedSlice(self.stored));
        visit(&DescribedSlice(self.ranges));
        visit_value(InUniforms { grid: self.layout }, self.name, visit);
        visit(&HostFact(self.has_gaps.into()));
        visit(&HostFact(self.blend.is_some().into()));
        if let Some(blend) = &self.blend {
            blend.resources(self.name, visit);
        }
    }

    fn is_same(&self, other: &Self) -> bool {
        let is_same_blend = match (&self.blend, &other.blend) {
            (Some(a), Some(b)) => a.is_same(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        is_same_blend
            && core::ptr::eq(self.stored.elements(), other.stored.elements())
            && self.layout == other.layout
    }
}

/// What the kernels of this module read from a grid.
impl<T: Voxel> Grid<'_, T> {
    #[inline(always)]
    pub(super) fn layout(&self) -> GridLayout {
        self.layout
    }

    #[inline(always)]
    pub(super) fn has_gaps(&self) -> bool {
        self.has_gaps
    }

    #[inline(always)]
    pub(super) fn range_at(&self, i: u32) -> Vec2 {
        self.ranges[i as usize]
    }

    #[inline(always)]
    pub(super) fn corners(&self, i: u32, steps: UVec3) -> Corners {
        match &self.blend {
            None => T::corners(&self.stored, i, steps),
            Some(_) => blend::corners(self, i, steps),
        }
    }
}

/// Layout in the uniform block: `head_grid`.
#[derive(Clone, Copy, Type)]
struct InUniforms {
    grid: GridLayout,
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("layout") }, M, ()> for GridView<'_, T> {
    type Output = <GridLayout as Type>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (): ()) -> Self::Output {
        m.capture(self.name, InUniforms { grid: self.layout }).grid
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("has_gaps") }, M, ()> for GridView<'_, T> {
    type Output = bool;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> bool {
        self.has_gaps
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("corners") }, M, (U<M>, X3<U<M>>)> for GridView<'_, T> {
    type Output = <Corners as Type>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (i, steps): (U<M>, X3<U<M>>)) -> Self::Output {
        match self.blend {
            None => T::corners_on(m, self.stored, i, steps),
            Some(_) => blend::corners::on(m, self, i, steps),
        }
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("range_at") }, M, (U<M>,)> for GridView<'_, T> {
    type Output = <Vec2 as Type>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (i,): (U<M>,)) -> Self::Output {
        m.element(&self.ranges, i)
    }
}

/// Methods of a grid on the host and in kernels, by kernels of a module.
macro_rules! methods {
    ($(
        $(#[$doc:meta])*
        $module:ident::$name:ident($($at:ident: $host:ty, $twin:ty);+) -> $result:ty, $out:ty;
    )+) => {
        impl<T: Voxel> Grid<'_, T> {
            $(
                $(#[$doc])*
                #[inline]
                pub fn $name(&self, $($at: $host),+) -> $result {
                    $module::$name(self, $($at),+)
                }
            )+
        }

        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine, T: Voxel> Method<{ name(stringify!($name)) }, M, ($($twin,)+)>
                for GridView<'_, T>
            {
                type Output = $out;

                #[inline(always)]
                fn call(self, m: &M, ($($at,)+): ($($twin,)+)) -> $out {
                    $module::$name::on(m, self, $($at),+)
                }
            }
        )+
    };
}

methods! {
    /// Returns the trilinear value at a point of the world; outside of the grid that of the nearest
    /// point inside, and 0 in a cell with a missing voxel.
    sample::value(p: Vec3, V3<M>) -> f32, F<M>;
    /// Returns the value of the nearest voxel, as for labels; 0 if it is missing.
    sample::nearest(p: Vec3, V3<M>) -> f32, F<M>;
    /// Returns the value of the cubic B-spline with the voxels as control points: twice
    /// continuously differentiable, but it smooths, so it does not pass through them. 0 where one
    /// of the 64 voxels around is missing.
    sample::b_spline(p: Vec3, V3<M>) -> f32, F<M>;
    /// Returns the gradient of the trilinear value itself, not a difference over some distance:
    /// change of the value per length in the world. Within a cell of the border it is that of the
    /// outermost cell, also outside.
    sample::gradient(p: Vec3, V3<M>) -> Vec3, V3<M>;
    /// Returns whether the cell at a point has no missing voxel.
    sample::has_value(p: Vec3, V3<M>) -> bool, B<M>;
    /// Returns the part of a ray in the grid, as [`Aabb::span`](crate::geometry::Aabb::span): the
    /// distances at which it enters and leaves; the first is greater if it misses.
    sample::span(ray: Ray, RayOn<M>) -> (f32, f32), (F<M>, F<M>);
    /// Returns where a ray first meets the isosurface of a value, from either side, between its
    /// `t_min` and `t_max`; [`next_surface`](super::next_surface()) goes on to those behind it.
    along::first_surface(ray: Ray, RayOn<M>; value: f32, F<M>)
        -> Option<SurfaceHit>, <Option<SurfaceHit> as Type>::On<M>;
    /// Returns the greatest value along a ray, in the middle of cells too, as for a maximum
    /// intensity projection; `-f32::MAX` if it misses the grid or all voxels on its way are
    /// missing.
    along::greatest(ray: Ray, RayOn<M>) -> f32, F<M>;
    /// Returns the mean value along the part of a ray in the grid; 0 if it misses, or all voxels on
    /// its way are missing.
    along::mean(ray: Ray, RayOn<M>) -> f32, F<M>;
}

impl Grid<'static, f32> {
    /// Creates a grid of `f32` from voxels among which `missing` marks those without a value.
    ///
    /// # Errors
    ///
    /// As [`Grid::new`].
    pub fn without<T: Voxel + PartialEq>(
        voxels: &[T],
        missing: T,
        size: UVec3,
        config: GridConfig,
    ) -> Result<Self, GridError> {
        let number = |v: &T| if *v == missing { f32::NAN } else { v.number() };
        Self::new(voxels.iter().map(number).collect::<Vec<f32>>(), size, config)
    }
}

#[cfg(test)]
mod tests {
    use glam::vec3;

    use super::*;

    #[test]
    fn sizes_are_checked() {
        let grid = |size| Grid::new(&[0u8; 6][..], size, GridConfig::new()).map(|_| ());
        assert_eq!(grid(UVec3::new(1, 2, 3)), Ok(()));
        assert_eq!(grid(UVec3::new(1, 0, 3)), Err(GridError::NoVoxels { axis: 1 }));
        assert_eq!(
            grid(UVec3::new(1, 2, 2)),
            Err(GridError::WrongLength { expected: 4, found: 6 })
        );
        let long = UVec3::new(1, 1, MAX_SIDE + 1);
        let limit = MAX_SIDE;
        assert_eq!(grid(long), Err(GridError::TooLong { axis: 2, size: long.z, limit }));
        let count = u128::from(MAX_SIDE).pow(3);
        let limit = MAX_VOXELS;
        assert_eq!(grid(UVec3::splat(MAX_SIDE)), Err(GridError::TooManyVoxels { count, limit }));
    }

    #[test]
    fn placements_have_an_inverse() {
        let grid = |config| Grid::new(&[0u8; 1][..], UVec3::ONE, config).map(|_| ());
        let flat = GridConfig::new().spacing(vec3(1.0, 0.0, 1.0));
        assert_eq!(grid(flat), Err(GridError::Placement));
        let nan = GridConfig::new().origin(vec3(f32::NAN, 0.0, 0.0));
        assert_eq!(grid(nan), Err(GridError::Placement));
        let scaled = GridConfig::new().rescale(f32::INFINITY, 0.0);
        assert!(matches!(grid(scaled), Err(GridError::Scale { .. })));
    }

    #[test]
    fn layouts_are_told_apart() -> Result<(), GridError> {
        let values = [0.0f32, 1.0, 2.0, 3.0];
        let [a, b, c] =
            [([4, 1, 1], 1.0), ([2, 2, 1], 1.0), ([4, 1, 1], 2.0)].map(|(size, scale)| {
                let config = GridConfig::new().rescale(scale, 0.0);
                Grid::new(&values[..], UVec3::from(size), config)
            });
        let (a, b, c) = (a?, b?, c?);
        let [a, b, c] = [&a, &b, &c].map(|grid| grid.named_view("grid"));
        assert!(a.is_same(&a) && !a.is_same(&b) && !a.is_same(&c));
        // Nor do equal layouts make one grid of two.
        let other = Grid::new(vec![4.0f32; 4], UVec3::new(4, 1, 1), GridConfig::new())?;
        let other = other.named_view("grid");
        assert!(a.layout == other.layout && !a.is_same(&other) && other.is_same(&other));
        Ok(())
    }

    #[test]
    fn macro_cells_share_the_voxels_between_them() {
        let size = UVec3::new(18, 1, 2);
        let voxels: Vec<f32> = (0..36).map(|i| (i % 18) as f32).collect();
        let grid = Grid::new(voxels, size, GridConfig::new()).expect("a grid");
        assert_eq!(grid.macro_cells(), UVec3::new(3, 1, 1));
        let whole = |v: &Vec2| (v.x.round(), v.y.round());
        let found: Vec<_> = grid.ranges().iter().map(whole).collect();
        assert_eq!(found, [(0.0, 8.0), (8.0, 16.0), (16.0, 17.0)]);
    }
}
