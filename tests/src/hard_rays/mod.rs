//! Rays at what is hard: seams of closed meshes, boxes where a test is easily wrong, and surfaces
//! that a ray leaves. Tests trace some of them, the program `campaign` very many.

pub mod bounces;
pub mod boxes;
pub mod mesh;
pub mod seams;
pub mod wide;

/// `2^-24`, half an ulp of 1 in `f32`.
pub const EPS: f64 = 1.0 / 16_777_216.0;
