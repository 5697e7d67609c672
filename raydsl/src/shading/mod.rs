//! Shading: what is known of the point that a ray hits, in any scene.
//!
//! | file | question | source |
//! |---|---|---|
//! | `surface` | what a primitive says of a hit: the trait [`Surface`] | |
//! | `scene` | what a scene says of it, instances and several scenes included: the trait [`Scene`] | |
//! | `mesh` | what an indexed mesh says of it, from attributes of its vertices: [`Mesh`] | |
//! | `attributes` | what attributes say between the vertices of a triangle | |
//! | `placed` | where a point of an instance is, and how far off | Higham, *Accuracy and Stability of Numerical Algorithms*, 3.1 |

mod attributes;
mod mesh;
mod placed;
mod scene;
mod surface;

pub use mesh::{Mesh, MeshAttributes, MeshError, MeshView};
#[doc(hidden)]
pub use scene::{Asked, CrossingAlone, PointAlone, WholePoint};
pub use scene::{Scene, ShadingPoint, ShadingPointOn};
pub use surface::{Surface, facing};
