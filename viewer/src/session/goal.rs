//! Rendering until an error is reached.

use raydsl::render::{Outcome, Progress, Reached};

use super::Session;
use crate::action::Goal;
use crate::look::Show;

/// An error that is asked for, and how far away it is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Aim {
    pub(super) goal: Option<Goal>,
    progress: Option<Progress>,
    reached: Option<Reached>,
}

impl Session {
    /// Asks for an error, in place of a number of samples; nothing ends that.
    pub(super) fn aim(&mut self, goal: Option<Goal>) -> Result<(), String> {
        if goal.is_none() {
            self.aim.goal.ok_or("no error is asked for")?;
            self.restart();
            return Ok(());
        }
        if self.current.is_none() {
            return Err("nothing is open".to_owned());
        }
        if matches!(self.look.show, Show::Difference(_)) {
            return Err("a difference of two variants has no error: show picture".to_owned());
        }
        self.restart();
        self.aim.goal = goal;
        self.submit();
        Ok(())
    }

    /// Returns the error that is asked for.
    pub fn goal(&self) -> Option<Goal> {
        self.aim.goal
    }

    /// Returns how far the picture is from the error that is asked for.
    pub fn nearer(&self) -> Option<&Progress> {
        self.aim.progress.as_ref()
    }

    /// Returns what became of the error that was asked for last, until the next change.
    pub fn reached(&self) -> Option<&Reached> {
        self.aim.reached.as_ref()
    }

    /// Returns whether an error is asked for that is not reached yet.
    pub fn is_aiming(&self) -> bool {
        self.aim.goal.is_some() && self.aim.reached.is_none() && !self.is_stuck()
    }

    pub(super) fn note_nearer(&mut self, progress: Progress) {
        self.aim.progress = Some(progress);
    }

    pub(super) fn note_reached(&mut self, reached: Reached) {
        self.log.note(words(&reached));
        self.aim.reached = Some(reached);
        if reached.samples == 0 {
            // There is no picture at all: go on as if nothing had been asked for.
            self.aim.goal = None;
            self.submit();
        }
    }
}

/// What became of a goal, in a line. The time is not in it: a script's log is the same in every run.
fn words(reached: &Reached) -> String {
    let why = match reached.outcome {
        Outcome::Converged => "reached",
        Outcome::OutOfTime => "out of time",
        Outcome::OutOfSamples => "out of samples",
        Outcome::Unresolvable { .. } => "rounding hides such an error",
        Outcome::Stopped => "stopped",
    };
    let Reached { estimate, samples, .. } = reached;
    format!("{why}: error {:.5}, at most {:.5}, {samples} samples", estimate.error, estimate.high)
}
