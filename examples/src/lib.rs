//! Shared code of the example programs.

pub mod args;
pub mod batches;
pub mod blob;
pub mod blocks;
pub mod cloud;
pub mod comparison;
pub mod cornell;
pub mod head;
pub mod heat_map;
pub mod lens;
pub mod mesh;
pub mod model;
pub mod picture;
pub mod raster;
pub mod rasterizer;
pub mod ropes;
pub mod sheet;
