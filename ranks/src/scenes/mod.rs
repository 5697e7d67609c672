//! The scenes of films, which every rank has as a whole.

mod cornell;
mod occlusion;

use super::args::{Args, SceneName};
use super::films::Render;
use super::run::Failure;

/// What is done with a scene that is there.
type Run<'a> = &'a mut dyn FnMut(Render<'_>) -> Result<(), Failure>;

/// Builds the scene of a film, and runs `run` with what renders parts of it.
pub(crate) fn with_film(
    args: &Args,
    mut run: impl FnMut(Render<'_>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    match args.scene {
        SceneName::Ao => occlusion::with(args, &mut run),
        _ => cornell::with(args, &mut run),
    }
}
