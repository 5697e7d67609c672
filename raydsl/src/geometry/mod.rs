//! Rays, hits, boxes and the shapes that rays meet.

mod aabb;
mod hit;
mod primitive;
mod ray;
pub mod sphere;
mod surface;
pub mod triangle;

pub use aabb::Aabb;
pub use hit::{Hit, HitOn, HitRecord};
pub use primitive::{Kinds, Primitive};
pub use ray::{Ray, RayOn};
pub use surface::{SurfacePoint, SurfacePointOn};
pub use triangle::Triangle;
