//! Errors of creating grids and transfer functions, and of meshes that cut.

use glam::{Affine3, UVec2, UVec3, Vec2, Vec3};

use super::grid::Centering;

/// Why a grid cannot be created.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// An axis has no voxels.
    #[error("axis {axis} of the grid has no voxels")]
    NoVoxels {
        /// The axis: 0, 1 or 2.
        axis: usize,
    },
    /// An axis has too many voxels.
    #[error("axis {axis} of the grid has {size} voxels: at most {limit}; split the grid")]
    TooLong {
        /// The axis: 0, 1 or 2.
        axis: usize,
        /// Number of voxels along it.
        size: u32,
        /// [`MAX_SIDE`](super::MAX_SIDE).
        limit: u32,
    },
    /// There are more voxels than a kernel can count.
    #[error("{count} voxels are too many: at most {limit}; split the grid")]
    TooManyVoxels {
        /// Number of voxels.
        count: u128,
        /// [`MAX_VOXELS`](super::MAX_VOXELS).
        limit: u64,
    },
    /// The number of voxels is not that of the sizes.
    #[error("{found} voxels for a grid of {expected}")]
    WrongLength {
        /// Product of the sizes.
        expected: u64,
        /// Number of voxels given.
        found: usize,
    },
    /// The placement is not finite, or flattens the grid.
    #[error("the placement of a grid is finite and has an inverse: check spacing and transform")]
    Placement,
    /// Scale or offset is not finite.
    #[error("values are rescaled by finite numbers, not by {scale} and {offset}")]
    Scale {
        /// Factor.
        scale: f32,
        /// Summand.
        offset: f32,
    },
    /// Two steps in time have different numbers of voxels.
    #[error("steps of {before} and {after} voxels: resample one to the size of the other")]
    Sizes {
        /// Number of voxels along each axis of the earlier step.
        before: UVec3,
        /// The same of the later step.
        after: UVec3,
    },
    /// Two steps in time are placed differently.
    #[error("steps placed by {before:?} and {after:?}: give both the same `GridConfig`")]
    Placements {
        /// Map from voxel coordinates of the earlier step to the world.
        before: Affine3,
        /// That of the later step.
        after: Affine3,
    },
    /// The samples of two steps in time lie differently.
    #[error("samples of steps lie as {before:?} and {after:?}: give both the same `GridConfig`")]
    Centerings {
        /// Where those of the earlier step lie.
        before: Centering,
        /// Where those of the later step lie.
        after: Centering,
    },
    /// The values of two steps in time have different units.
    #[error(
        "steps with values times {} plus {} and times {} plus {}: give both the same `GridConfig`",
        before.0, before.1, after.0, after.1
    )]
    Units {
        /// Factor and summand of the earlier step.
        before: (f32, f32),
        /// Those of the later step.
        after: (f32, f32),
    },
    /// The share of the later step is NaN.
    #[error("the share of the later step is a number from 0 to 1, not NaN")]
    Share,
    /// One of two steps in time is itself between two.
    #[error("a step is not itself between two: blend the two grids that its time lies between")]
    Nested,
}

/// Why a transfer function cannot be created.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TransferError {
    /// There are no knots of colour, or none of opacity.
    #[error("a transfer function needs a knot of {of}")]
    NoKnots {
        /// `colour`, `opacity`, `labels` or `samples`.
        of: &'static str,
    },
    /// The values of knots decrease.
    #[error("knot {index} of {of} does not lie above the one before it: sort them by value")]
    Unsorted {
        /// `colour`, `opacity`, `labels` or `samples`.
        of: &'static str,
        /// Index of the knot, from 0 on.
        index: usize,
    },
    /// A value, a colour or an extinction is negative, infinite or NaN; an opacity is not from 0
    /// to 1.
    #[error("knot {index} of {of} is out of range")]
    OutOfRange {
        /// `colour`, `opacity`, `labels` or `samples`.
        of: &'static str,
        /// Index of the knot, from 0 on.
        index: usize,
    },
    /// A 2-D function has too few samples along an axis, or too many, or another number of them.
    #[error("{found} samples for a function of {size}: from 2 to 4096 along each axis")]
    Samples {
        /// Samples along the values and along the gradients.
        size: UVec2,
        /// Number of samples given.
        found: usize,
    },
    /// A range of values or of gradients is empty, or not finite.
    #[error("values from {} to {}, gradients from {} to {}: both rise, and are finite",
        values.x, values.y, gradients.x, gradients.y)]
    Range {
        /// First and last value.
        values: Vec2,
        /// First and last length of a gradient.
        gradients: Vec2,
    },
    /// The unit distance of opacities is not positive and finite.
    #[error("the unit distance of opacities is positive and finite, not {0}")]
    UnitDistance(f32),
}

/// Why triangles have no inside.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// Edges have no neighbour that runs the other way.
    #[error(
        "the mesh is not closed: {edges} edges have no neighbour, the first from {from} to {to} of \
         triangle {triangle}; fill the holes, and turn all triangles the same way"
    )]
    Open {
        /// Number of such edges.
        edges: usize,
        /// Where the first of them begins.
        from: Vec3,
        /// Where it ends.
        to: Vec3,
        /// Index of a triangle that has it.
        triangle: usize,
    },
    /// A position is infinite or NaN.
    #[error("triangle {triangle} of the mesh has a position that is not finite")]
    NotFinite {
        /// Index of the triangle.
        triangle: usize,
    },
}
