//! Point clouds: a procedural landscape, readers for scanned files, and what it takes to
//! render points as spheres.

mod error;
mod guard;
mod las;
mod las_claim;
mod load;
mod ply;
mod procedural;
mod scale;
mod spacing;
mod tint;
mod view;
mod xyz;

#[cfg(test)]
mod tests;

pub use error::CloudError;
pub use load::load;
pub use procedural::procedural;
pub use scale::{Scaled, scale};
pub use view::{View, suggested_view};

/// Points with a colour each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// Coordinates in file units; z is up.
    pub positions: Vec<[f64; 3]>,
    /// sRGB colours, as many as positions.
    pub colors: Vec<[u8; 3]>,
}
