//! Volumes: scalar fields on grids, transfer functions, and integrals along rays.

mod adaptive;
mod along;
mod blend;
pub mod cells;
mod cubic;
mod cut;
mod error;
mod exact;
mod grid;
mod integral;
mod integrator;
mod labels;
mod light;
mod march;
mod medium;
mod phase;
mod sample;
mod tracking;
mod transfer;
mod transfer_2d;
mod vectors;
#[expect(clippy::module_inception, reason = "the volume itself, among what belongs to it")]
mod volume;
mod volume_2d;
mod voxel;
mod walk;

pub use adaptive::Adaptive;
pub use along::{SurfaceHit, SurfaceWalk, next_surface};
pub use cut::{Cut, check_closed, is_inside};
pub use error::{GridError, MeshError, TransferError};
pub use exact::{ExactCell, ShadedCell};
pub use grid::{
    Centering, Grid, GridConfig, GridLayout, GridView, MACRO_CELL, MAX_SIDE, MAX_VOXELS,
};
pub use integral::TransferIntegral;
pub use integrator::VolumeIntegrator;
pub use labels::Labels;
pub use light::VolumeLight;
pub use march::{Euler, ExponentialLeft, MeanExtinction, Midpoint, PreIntegrated};
pub use medium::{Collision, CollisionOn, Fog, FogOn, collision};
pub use phase::{henyey_greenstein, sample_henyey_greenstein};
pub use tracking::{delta_tracking, jackknife_transmittance, ratio_transmittance};
pub use transfer::{TransferFunction, TransferKnot, TransferLayout, TransferSample, TransferView};
pub use transfer_2d::{TransferFunction2d, TransferLayout2d};
pub use vectors::{VectorGrid, VectorGridView};
pub use volume::{Volume, VolumeView};
pub use volume_2d::{Volume2d, Volume2dView};
pub use voxel::{Corners, Voxel};
