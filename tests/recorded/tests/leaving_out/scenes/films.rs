//! Pictures of a kernel: a frame, and passes over films.

use raydsl::kernel;
use raydsl::prelude::*;

use super::Made;

const SIZE: (u32, u32) = (64, 48);

fn camera() -> Pinhole {
    Pinhole::new(Vec3::Z, Vec3::ZERO, Vec3::Y, 1.0)
}

#[kernel]
fn sky(ray: Ray) -> Vec4 {
    vec4(ray.direction.y, 0.5, 1.0, 1.0)
}

/// One ray for each pixel.
pub(super) fn frame() -> Made {
    Ok(kernel!(|ray: Ray| sky(ray)).record_frame(&camera(), SIZE))
}

fn sampling() -> Sampling {
    Sampling::new(16).method(SampleMethod::Random)
}

/// As many samples for each pixel.
pub(super) fn film() -> Made {
    Ok(kernel!(|ray: Ray| sky(ray)).record_pass(&camera(), &sampling(), SIZE))
}

/// Samples where they are needed.
pub(super) fn adaptive() -> Made {
    Ok(kernel!(|ray: Ray| sky(ray)).record_adaptive_pass(&camera(), &sampling(), SIZE))
}
