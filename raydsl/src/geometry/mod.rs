//! Rays, hits, boxes and shapes.

mod aabb;
pub(crate) mod affine;
mod axial;
pub mod cone;
pub mod cuboid;
pub mod cylinder;
pub mod disk;
mod edges;
mod hit;
mod lacking;
mod near;
mod origin;
mod outwards;
pub mod plane;
mod primitive;
pub mod quad;
mod ray;
#[doc(alias = "parallelogram")]
pub mod rectangle;
mod shared;
pub(crate) mod slabs;
pub mod sphere;
mod surface;
pub mod triangle;
pub mod tube;

pub use aabb::{Aabb, AabbOn};
pub(crate) use affine::transform_normal_back;
pub use affine::transform_ray;
pub use hit::{Hit, HitOn, HitRecord};
pub use lacking::Lacking;
pub use origin::offset_origin;
pub use primitive::{Kinds, Primitive};
pub use ray::{Ray, RayOn};
pub use shared::{
    IntoShared, Names, Several, Shared, SharedAmong, SharedAs, SharedSlices, SharedStore,
    SharedViews, shared_among, shared_of_kind, shared_views,
};
pub(crate) use slabs::finite_inverse;
pub use surface::{SurfacePoint, SurfacePointOn};
pub use triangle::{IndexedTriangle, Triangle};
