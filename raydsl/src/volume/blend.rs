//! Grids between two steps in time.

use std::borrow::Cow;

use glam::{UVec3, Vec2, vec2};

use super::error::GridError;
use super::grid::{Grid, GridConfig, GridView, NO_RANGE};
use super::voxel::{Corners, Voxel};
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    DescribedSlice, F, Machine, Method, Owner, Resource, Slice, Type as MachineType, U, X3, name,
    visit_value,
};
use crate::{Type, kernel};

/// The second of two steps, and its share.
#[derive(Debug)]
pub(super) struct Blend<'a, T: Voxel> {
    stored: &'a [T::Stored],
    key: BufferKey,
    /// From 0 to 1/2.
    share: f32,
}

/// What kernels read of it.
#[derive(Debug)]
pub(super) struct BlendView<'a, T: Voxel> {
    pub(super) stored: Slice<'a, T::Stored>,
    share: f32,
}

impl<T: Voxel> Clone for BlendView<'_, T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T: Voxel> Copy for BlendView<'_, T> {}

impl<T: Voxel> Blend<'_, T> {
    #[inline(always)]
    pub(super) fn view(&self, name: &'static str) -> BlendView<'_, T> {
        let stored = Slice::owned(self.stored, Some(self.key), name).suffixed("other_voxels");
        BlendView { stored, share: self.share }
    }
}

impl<T: Voxel> BlendView<'_, T> {
    /// Visits what kernels read of it, in the grid of this name.
    pub(super) fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&DescribedSlice(self.stored));
        visit_value(InUniforms { grid_share: self.share }, name, visit);
    }

    pub(super) fn is_same(&self, other: &Self) -> bool {
        core::ptr::eq(self.stored.elements(), other.stored.elements()) && self.share == other.share
    }
}

impl<'a, T: Voxel> Grid<'a, T> {
    /// Returns the grid between two steps in time: each voxel goes evenly from its value in
    /// `before` to that in `after`, and `share`, from 0 to 1, is how far it has come. A share
    /// outside of that is the nearest one inside; 0 and 1 have the steps' own values.
    ///
    /// A trilinear value between blended voxels is the blend of two trilinear values, so
    /// everything that a grid does, the exact cell and surfaces too, is that of a grid of blended
    /// voxels. No voxel is copied, which makes it quick: time is in proportion to the number of
    /// macro-cells. A device that has the voxels of both steps gets none again, and another share
    /// compiles nothing. Kernels fetch twice as many voxels.
    ///
    /// A voxel that is missing in one of the steps is missing. Labels have no mean: between organs
    /// 3 and 7 this gives organ 5, so show one step or the other of a grid of labels.
    ///
    /// ```
    /// use raydsl::prelude::*;
    /// use raydsl::volume::{Grid, GridConfig};
    ///
    /// let (cold, hot) = ([10i16; 8], [30i16; 8]);
    /// let grid = |voxels| Grid::new(voxels, uvec3(2, 2, 2), GridConfig::new());
    /// let (before, after) = (grid(&cold[..])?, grid(&hot[..])?);
    /// let now = Grid::between(&before, &after, 0.25)?;
    /// assert_eq!(now.value(vec3(0.3, 0.5, 0.9)), 15.0);
    /// # Ok::<(), raydsl::volume::GridError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If the steps have different sizes or configurations, one of them is itself between two, or
    /// the share is NaN.
    pub fn between(
        before: &'a Grid<'a, T>,
        after: &'a Grid<'a, T>,
        share: f32,
    ) -> Result<Self, GridError> {
        if share.is_nan() {
            return Err(GridError::Share);
        }
        if before.blend.is_some() || after.blend.is_some() {
            return Err(GridError::Nested);
        }
        if before.size != after.size {
            return Err(GridError::Sizes { before: before.size, after: after.size });
        }
        check_configs(&before.config, &after.config)?;
        let share = share.clamp(0.0, 1.0);
        // From the nearer step on, so that rounding leaves either end as it is.
        let (near, far, share) =
            if share > 0.5 { (after, before, 1.0 - share) } else { (before, after, share) };
        // Differences of such voxels may be infinite: then they are missing.
        let limit = f32::MAX * 0.25 * near.config.scale.abs();
        let is_small = |r: &Vec2| r.x > r.y || r.abs().max_element() < limit;
        let overflows = !near.ranges.iter().chain(&far.ranges).all(is_small);
        let ranges = near.ranges.iter().zip(&far.ranges);
        let offset = near.config.offset;
        Ok(Self {
            stored: Cow::Borrowed(&near.stored),
            stored_key: near.stored_key,
            blend: Some(Blend { stored: &far.stored, key: far.stored_key, share }),
            ranges: ranges.map(|(a, b)| range_between(*a, *b, share, offset)).collect(),
            size: near.size,
            config: near.config,
            layout: near.layout,
            has_gaps: near.has_gaps || far.has_gaps || overflows,
            owner: Owner::new(),
        })
    }
}

/// Refuses steps whose voxels do not lie at the same places, or mean other values.
fn check_configs(before: &GridConfig, after: &GridConfig) -> Result<(), GridError> {
    if before.to_world != after.to_world {
        let (before, after) = (before.to_world, after.to_world);
        return Err(GridError::Placements { before, after });
    }
    if before.centering != after.centering {
        let (before, after) = (before.centering, after.centering);
        return Err(GridError::Centerings { before, after });
    }
    let [before, after] = [before, after].map(|config| (config.scale, config.offset));
    if before == after { Ok(()) } else { Err(GridError::Units { before, after }) }
}

/// Returns a range that has all values between those of two.
fn range_between(a: Vec2, b: Vec2, share: f32, offset: f32) -> Vec2 {
    if a.x > a.y || b.x > b.y {
        return NO_RANGE;
    }
    // Equal voxels stay what they are: space that is empty in both steps is empty between them.
    if a == b && a.x == a.y {
        return a;
    }
    let most = a.abs().max(b.abs()).max_element() + offset.abs();
    // Each voxel is rounded before it is interpolated, which rounds again.
    let slack = 16.0 * f32::EPSILON * most;
    let range = a * (1.0 - share) + b * share;
    vec2(range.x - slack, range.y + slack)
}

/// What the kernels of this module read from a grid between two steps.
impl<T: Voxel> Grid<'_, T> {
    #[inline(always)]
    fn own_corners(&self, i: u32, steps: UVec3) -> Corners {
        T::corners(&self.stored, i, steps)
    }

    /// Corners in the other step; the grid's own where there is none.
    #[inline(always)]
    fn other_corners(&self, i: u32, steps: UVec3) -> Corners {
        T::corners(self.blend.as_ref().map_or(&self.stored, |blend| blend.stored), i, steps)
    }

    #[inline(always)]
    fn share(&self) -> f32 {
        self.blend.as_ref().map_or(0.0, |blend| blend.share)
    }
}

/// Layout in the uniform block: `head_grid_share`.
#[derive(Clone, Copy, Type)]
struct InUniforms {
    grid_share: f32,
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("own_corners") }, M, (U<M>, X3<U<M>>)>
    for GridView<'_, T>
{
    type Output = <Corners as MachineType>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (i, steps): (U<M>, X3<U<M>>)) -> Self::Output {
        T::corners_on(m, self.stored, i, steps)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("other_corners") }, M, (U<M>, X3<U<M>>)>
    for GridView<'_, T>
{
    type Output = <Corners as MachineType>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (i, steps): (U<M>, X3<U<M>>)) -> Self::Output {
        T::corners_on(m, self.blend.map_or(self.stored, |blend| blend.stored), i, steps)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("share") }, M, ()> for GridView<'_, T> {
    type Output = F<M>;

    #[inline(always)]
    fn call(self, m: &M, (): ()) -> F<M> {
        let grid_share = self.blend.map_or(0.0, |blend| blend.share);
        m.capture(self.name, InUniforms { grid_share }).grid_share
    }
}

/// Returns the corners of a cell between two steps. Not a part of its callers, whose code for a
/// grid of one step stays as small as it is.
#[kernel]
#[inline(never)]
pub(super) fn corners<T: Voxel>(grid: &Grid<'_, T>, i: u32, steps: UVec3) -> Corners {
    let own: Corners = grid.own_corners(i, steps);
    let other: Corners = grid.other_corners(i, steps);
    let share = grid.share();
    Corners {
        near: own.near + (other.near - own.near) * share,
        far: own.far + (other.far - own.far) * share,
    }
}

#[cfg(test)]
mod tests {
    use glam::{uvec3, vec3};

    use super::*;
    use crate::volume::Centering;

    fn grid(value: f32, size: UVec3, config: GridConfig) -> Grid<'static, f32> {
        Grid::new(vec![value; size.element_product() as usize], size, config).expect("a grid")
    }

    #[test]
    fn steps_that_differ_are_refused() {
        let size = uvec3(2, 3, 4);
        let (a, b) = (grid(1.0, size, GridConfig::new()), grid(2.0, size, GridConfig::new()));
        fn refused<'a>(a: &'a Grid<'a, f32>, b: &'a Grid<'a, f32>, share: f32) -> GridError {
            Grid::between(a, b, share).map(|_| ()).expect_err("an error")
        }
        assert_eq!(refused(&a, &b, f32::NAN), GridError::Share);
        let other = grid(2.0, uvec3(4, 3, 2), GridConfig::new());
        let error = refused(&a, &other, 0.5);
        assert_eq!(error, GridError::Sizes { before: size, after: uvec3(4, 3, 2) });
        assert!(error.to_string().contains("[2, 3, 4] and [4, 3, 2]"), "{error}");
        let plain = GridConfig::new();
        let place = plain.origin(vec3(0.0, 0.0, 1.0));
        let (vertex, cell) = (Centering::Vertex, Centering::Cell);
        let unit = (1.0, 0.0);
        let expected = [
            (place, GridError::Placements { before: plain.to_world, after: place.to_world }),
            (plain.centering(cell), GridError::Centerings { before: vertex, after: cell }),
            (plain.rescale(2.0, 0.0), GridError::Units { before: unit, after: (2.0, 0.0) }),
            (plain.rescale(1.0, 1.5), GridError::Units { before: unit, after: (1.0, 1.5) }),
        ];
        for (after, expected) in expected {
            let other = grid(2.0, size, after);
            let error = refused(&a, &other, 0.5);
            assert_eq!(error, expected);
            assert!(error.to_string().contains("GridConfig"), "{error}");
        }
        let now = Grid::between(&a, &b, 0.5).expect("a blend");
        assert_eq!(refused(&now, &b, 0.5), GridError::Nested);
        assert_eq!(refused(&a, &now, 0.5), GridError::Nested);
    }

    #[test]
    fn shares_are_clamped() {
        let size = uvec3(2, 2, 2);
        let (a, b) = (grid(1.0, size, GridConfig::new()), grid(2.0, size, GridConfig::new()));
        let value = |share| Grid::between(&a, &b, share).expect("a blend").value(vec3(0.5, 0., 0.));
        assert_eq!([-1.0, f32::NEG_INFINITY, 0.0].map(value), [1.0; 3]);
        assert_eq!([1.0, 1.5, f32::INFINITY].map(value), [2.0; 3]);
        assert_eq!([0.25, 0.75].map(value), [1.25, 1.75]);
    }

    #[test]
    fn ranges_are_between_those_of_the_steps() {
        let size = uvec3(2, 2, 2);
        let of = |a, b| {
            let (a, b) = (grid(a, size, GridConfig::new()), grid(b, size, GridConfig::new()));
            Grid::between(&a, &b, 0.25).expect("a blend").ranges()[0]
        };
        assert_eq!(of(-1000.0, -1000.0), Vec2::splat(-1000.0));
        assert_eq!(of(0.0, f32::NAN), NO_RANGE);
        let range = of(4.0, 8.0);
        assert!(range.x < 5.0 && 5.0 < range.y && range.y - range.x < 1e-4, "{range}");
    }
}
