#![doc = include_str!("../README.md")]
// On docs.rs, whose compiler is a nightly, items tell the feature that they need.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(
    not(all(
        feature = "environment",
        feature = "gltf",
        feature = "las",
        feature = "metaimage",
        feature = "mtl",
        feature = "nifti",
        feature = "nrrd",
        feature = "obj",
        feature = "paraview",
        feature = "ply",
        feature = "raw",
        feature = "stack",
        feature = "tri",
        feature = "trk",
        feature = "vti",
        feature = "vtu",
        feature = "xyz"
    )),
    allow(dead_code, unused_imports, reason = "formats share code")
)]

mod error;
#[cfg(any(feature = "metaimage", feature = "nrrd"))]
mod fields;
mod format;
#[cfg(feature = "las")]
mod guard;
#[cfg(feature = "las")]
mod las;
#[cfg(feature = "las")]
mod las_claim;
#[cfg(feature = "metaimage")]
mod metaimage;
#[cfg(feature = "nifti")]
mod nifti;
#[cfg(feature = "nrrd")]
mod nrrd;
#[cfg(feature = "obj")]
mod obj;
mod payload;
#[cfg(feature = "ply")]
mod ply;
#[cfg(feature = "raw")]
mod raw;
mod source;
#[cfg(feature = "stack")]
mod stack;
mod stop;
#[cfg(all(
    test,
    feature = "environment",
    feature = "gltf",
    feature = "las",
    feature = "metaimage",
    feature = "mtl",
    feature = "nifti",
    feature = "nrrd",
    feature = "obj",
    feature = "paraview",
    feature = "ply",
    feature = "raw",
    feature = "stack",
    feature = "tri",
    feature = "trk",
    feature = "vti",
    feature = "vtu",
    feature = "xyz"
))]
mod tests;
mod tint;
#[cfg(feature = "tri")]
mod tri;
#[cfg(feature = "trk")]
mod trk;
#[cfg(feature = "vti")]
mod vti;
#[cfg(any(feature = "vti", feature = "vtu"))]
mod vtk;
#[cfg(feature = "vtu")]
mod vtu;
#[cfg(feature = "xyz")]
mod xyz;

pub mod cells;
pub mod cloud;
#[cfg(feature = "environment")]
pub mod environment;
pub mod mesh;
#[cfg(feature = "paraview")]
pub mod paraview;
pub mod scene;
pub mod tracts;
pub mod volume;

pub use error::{LoadError, Place};
pub use stop::stoppable;
