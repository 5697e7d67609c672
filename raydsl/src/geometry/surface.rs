//! Points of surfaces.

use glam::Vec3;

use crate::Type;

/// A point of a surface, and which way the surface faces there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct SurfacePoint {
    /// Where it is.
    pub position: Vec3,
    /// The normal, with unit length.
    pub normal: Vec3,
}
