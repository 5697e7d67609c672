//! Streamlines: their errors against closed forms and `f64`, why they end, fields on grids and
//! cells, and what all variants make of them.

mod accuracy;
mod agreement;
mod ends;
mod fields;
mod places;
mod shapes;

use raydsl::flow::{FlowSettings, FlowState, FlowSteps, Streamline, Ways, streamlines};
use raydsl::kernel::Kernel;
use raydsl::prelude::*;

/// Settings with this tolerance and greatest step.
fn settings(tolerance: f32, max_step: f32) -> FlowSettings {
    FlowSettings::new(tolerance, max_step).expect("settings")
}

/// The lines from some seeds, by packets on all threads.
fn follow(
    kernel: &Kernel<'_, (FlowState,), FlowSteps>,
    seeds: &[Vec3],
    ways: Ways,
) -> Vec<Streamline> {
    streamlines(&TiledScheduler::new(), kernel, seeds, ways)
}
