//! Volumes: scalar fields on grids, transfer functions, and integrals along rays.

mod along;
mod cubic;
mod cut;
mod error;
mod exact;
mod grid;
mod integrator;
mod light;
mod march;
mod sample;
mod transfer;
#[expect(clippy::module_inception, reason = "the volume itself, among what belongs to it")]
mod volume;
mod voxel;
mod walk;

pub use along::SurfaceHit;
pub use cut::{Cut, is_inside};
pub use error::{GridError, TransferError};
pub use exact::{ExactCell, ShadedCell};
pub use grid::{
    Centering, Grid, GridConfig, GridLayout, GridView, MACRO_CELL, MAX_SIDE, MAX_VOXELS,
};
pub use integrator::VolumeIntegrator;
pub use light::VolumeLight;
pub use march::{Euler, ExponentialLeft, MeanExtinction, Midpoint};
pub use transfer::{TransferFunction, TransferKnot, TransferLayout, TransferSample, TransferView};
pub use volume::{Volume, VolumeView};
pub use voxel::{Corners, Voxel};
