//! Following many lines, on any renderer.

use glam::Vec3;

use super::follow::{FlowEnd, FlowState, FlowSteps};
use super::line::Streamline;
use crate::kernel::Kernel;
use crate::render::Renderer;

/// In which directions lines are followed from their seeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Ways {
    /// Along the field.
    Forwards,
    /// Against it.
    Backwards,
    /// Both, joined at the seed.
    #[default]
    Both,
}

/// Follows a line from each seed by a kernel that calls [`trace()`](super::trace()), until all have
/// come to their ends; lines are in the order of the seeds.
///
/// # Errors
///
/// On a device, if it refuses or is lost.
pub fn streamlines<R: Renderer>(
    renderer: &R,
    kernel: &Kernel<'_, (FlowState,), FlowSteps>,
    seeds: &[Vec3],
    ways: Ways,
) -> R::Outcome<Vec<Streamline>> {
    R::outcome(followed(renderer, kernel, seeds, ways))
}

fn followed<R: Renderer>(
    renderer: &R,
    kernel: &Kernel<'_, (FlowState,), FlowSteps>,
    seeds: &[Vec3],
    ways: Ways,
) -> Result<Vec<Streamline>, R::Error> {
    let all = |begin: fn(Vec3) -> FlowState| seeds.iter().map(|seed| begin(*seed)).collect();
    let run = |states: Vec<FlowState>| run(renderer, kernel, states);
    match ways {
        Ways::Forwards => run(all(FlowState::forwards)),
        Ways::Backwards => run(all(FlowState::backwards)),
        Ways::Both => {
            let mut states: Vec<FlowState> = all(FlowState::backwards);
            states.extend(seeds.iter().map(|seed| FlowState::forwards(*seed)));
            let mut back = run(states)?;
            let forth = back.split_off(seeds.len());
            Ok(back.into_iter().zip(forth).map(|(a, b)| Streamline::joined(a, b)).collect())
        }
    }
}

/// Calls the kernel for all lines that go on, until none does.
fn run<R: Renderer>(
    renderer: &R,
    kernel: &Kernel<'_, (FlowState,), FlowSteps>,
    mut states: Vec<FlowState>,
) -> Result<Vec<Streamline>, R::Error> {
    let mut lines = vec![Streamline::default(); states.len()];
    let mut going: Vec<usize> = (0..states.len()).collect();
    let nothing =
        FlowSteps { state: FlowState::forwards(Vec3::ZERO), count: 0, points: Default::default() };
    while !going.is_empty() {
        let inputs: Vec<(FlowState,)> = going.iter().map(|i| (states[*i],)).collect();
        let mut outputs = vec![nothing; inputs.len()];
        R::result(renderer.batch(kernel, &inputs, &mut outputs))?;
        for (i, steps) in going.iter().zip(&outputs) {
            states[*i] = steps.state;
            lines[*i].add(steps);
        }
        going.retain(|i| states[*i].end == FlowEnd::Going);
    }
    Ok(lines)
}
