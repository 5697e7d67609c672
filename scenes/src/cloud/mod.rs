//! Point clouds: a procedural landscape, as points and as triangles, and what it takes to render
//! points as spheres.

mod error;
mod procedural;
mod scale;
mod spacing;
mod view;

#[cfg(test)]
mod tests;

pub use error::ScaleError;
pub use procedural::{Cover, Facets, Landscape, facets, procedural};
pub use scale::{Scaled, scale};
pub use view::{View, suggested_view};
