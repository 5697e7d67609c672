//! Shared code of the example programs.

pub mod cloud;
pub mod heat_map;
