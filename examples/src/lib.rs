//! Shared code of the example programs.

pub mod args;
pub mod batches;
pub mod blob;
pub mod blocks;
pub mod cells;
pub mod comparison;
pub mod everything;
pub mod explain;
pub mod heat_map;
pub mod lens;
pub mod mesh;
pub mod model;
pub mod picture;
pub mod rasterizer;
pub mod ropes;
pub mod sheet;
pub mod shown;

pub use raydsl_scenes::{cloud, cornell, head};
