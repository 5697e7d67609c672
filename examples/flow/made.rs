//! A flow that is made in code: that of Arnold, Beltrami and Childress.

use core::f32::consts::TAU;

use raydsl::flow::{FlowPoint, FlowState, trace};
use raydsl::kernel;
use raydsl::prelude::*;

use super::Failure;
use super::args::Args;
use super::lines::{self, Field, Shown};

// ANCHOR: field
/// Vortices along three axes, which solve Euler's equations; between them lines are chaotic.
/// (Dombre et al., "Chaotic streamlines in the ABC flows", Journal of Fluid Mechanics 1986.)
#[kernel]
pub(crate) fn vortices(p: Vec3) -> Vec3 {
    let (a, b, c) = (1.0, 0.816_496_6, 0.577_350_3);
    vec3(a * sin(p.z) + c * cos(p.y), b * sin(p.x) + a * cos(p.z), c * sin(p.y) + b * cos(p.x))
}
// ANCHOR_END: field

/// One period of the flow.
pub(crate) fn period() -> Aabb {
    Aabb::new(Vec3::ZERO, Vec3::splat(TAU))
}

/// Lines in one period of the flow.
pub(crate) fn shown(args: &Args) -> Result<Shown, Failure> {
    let settings = lines::settings(args, TAU)?;
    // ANCHOR: kernel
    let period = period();
    let kernel = kernel!(|state: FlowState| {
        let field = |p: Vec3| if period.contains(p) { Some(vortices(p)) } else { None };
        trace(field, state, settings)
    });
    // ANCHOR_END: kernel
    let by_time = match &args.color[..] {
        "time" => true,
        "speed" => false,
        other => {
            let message = format!("this flow has no array '{other}': --color speed or time");
            return Err(Failure::Usage(message));
        }
    };
    let value = |p: &FlowPoint| if by_time { p.time } else { p.velocity.length() };
    let velocity = |p: Vec3| period.contains(p).then(|| vortices(p));
    let title = if by_time { "time" } else { "speed" }.to_owned();
    let field = Field { bounds: period, velocity: &velocity, value: &value, title };
    lines::through(args, &field, &kernel)
}
