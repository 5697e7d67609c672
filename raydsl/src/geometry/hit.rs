//! Where a ray meets a primitive.

use crate::{Type, kernel};

/// What an intersection found; a miss is data too, with `is_hit == false`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Hit {
    /// Whether there is a hit; the other members mean nothing without one.
    pub is_hit: bool,
    /// Distance along the ray in lengths of its direction.
    pub t: f32,
    /// Which primitive: its index in the application's array. Traversal sets it.
    pub prim_id: u32,
    /// First surface coordinate: the barycentric weight of a triangle's second vertex.
    pub u: f32,
    /// Second surface coordinate: the barycentric weight of a triangle's third vertex.
    pub v: f32,
}

#[kernel]
impl Hit {
    /// A hit if `is_hit`, at distance `t`.
    pub const fn new(is_hit: bool, t: f32) -> Self {
        Self { is_hit, t, prim_id: 0, u: 0.0, v: 0.0 }
    }

    /// No hit.
    pub const fn miss() -> Self {
        Self::new(false, 0.0)
    }
}
