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
        let goal = goal.map(Goal::checked).transpose()?;
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

    /// Says in words what became of it.
    pub fn outcome(&self) -> Option<&'static str> {
        self.aim.reached.map(|reached| why(reached.outcome))
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

/// Says why rendering to an error has ended.
const fn why(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Converged => "reached",
        Outcome::OutOfTime => "out of time",
        Outcome::OutOfSamples => "out of samples",
        Outcome::Unresolvable { .. } => "rounding hides such an error",
        Outcome::Stopped => "stopped",
    }
}

/// What became of a goal, in a line. The time is not in it: a script's log is the same in every run.
fn words(reached: &Reached) -> String {
    let Reached { outcome, estimate, samples, .. } = reached;
    let why = why(*outcome);
    format!("{why}: error {:.5}, at most {:.5}, {samples} samples", estimate.error, estimate.high)
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use raydsl::prelude::*;
    use raydsl::render::Estimate;

    use super::*;
    use crate::action::Action;
    use crate::device::Device;
    use crate::session::Config;

    /// A session with a landscape, whose first picture nobody has asked for.
    fn opened() -> Session {
        let mut session = Session::new(Config::scripted("out"), Device::default(), || {});
        apply(&mut session, &["size 16 9", "open landscape:500"]);
        wait(&mut session, |session| session.poll() && session.info().is_some());
        apply(&mut session, &["mode occlusion"]);
        session
    }

    fn apply(session: &mut Session, lines: &[&str]) {
        for line in lines {
            let action: Action = line.parse().expect(line);
            session.apply(&action).expect(line);
        }
    }

    fn wait(session: &mut Session, mut is_there: impl FnMut(&mut Session) -> bool) {
        let start = Instant::now();
        while !is_there(session) {
            assert!(start.elapsed() < Duration::from_secs(60), "{:#?}", session.log());
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    /// Waits for the end of what is asked for, and returns its number of samples.
    fn end(session: &mut Session) -> u32 {
        wait(session, |session| {
            session.poll();
            !session.is_aiming()
        });
        let reached = session.reached().expect("it is known what became of it");
        assert_eq!(reached.outcome, Outcome::Converged);
        reached.samples
    }

    #[test]
    fn values_that_no_line_has_are_refused_too() {
        let mut session = Session::new(Config::scripted("out"), Device::default(), || {});
        let before = session.look().clone();
        let goal = |error, seconds| Action::Until(Some(Goal { error, seconds }));
        let nowhere = raydsl_scenes::Pose { eye: Vec3::NAN, ..before.pose };
        let (above, finite) =
            ("errors and seconds are above 0 and finite", "an exposure is finite");
        for (action, expected) in [
            (goal(0.0, 5.0), above),
            (goal(-0.1, 5.0), above),
            (goal(f32::NAN, 5.0), above),
            (goal(f32::INFINITY, 5.0), above),
            (goal(0.1, 0.0), above),
            (goal(0.1, f32::NAN), above),
            (goal(0.1, f32::INFINITY), above),
            (goal(0.1, 5.0), "nothing is open"),
            (Action::Exposure(f32::NAN), finite),
            (Action::Exposure(f32::INFINITY), finite),
            (Action::Camera(nowhere), "the camera has no direction"),
        ] {
            assert_eq!(session.apply(&action), Err(expected.to_owned()), "{action}");
        }
        assert_eq!((session.goal(), session.look()), (None, &before));
    }

    #[test]
    fn an_exposure_does_not_hide_that_an_error_is_reached() {
        let mut session = opened();
        apply(&mut session, &["until 0.05 60"]);
        // The picture is there, and what became of it is said of its number, before or after the
        // exposure is another.
        wait(&mut session, |session| {
            session.frame = session.current.as_ref().and_then(|data| data.link.take_frame());
            session.frame.is_some()
        });
        apply(&mut session, &["exposure 1"]);
        let samples = end(&mut session);
        wait(&mut session, |session| {
            session.poll();
            session.has(samples)
        });
        // What another light has reached is no news of this one.
        let before = session.number();
        apply(&mut session, &["orbit 5 0", "until 0.000001 3600"]);
        let id = session.current.as_ref().map_or(0, |data| data.id);
        let reached = Reached {
            outcome: Outcome::Converged,
            estimate: Estimate { error: 0.0, low: 0.0, high: 0.0 },
            samples: 1,
            spent: 1,
            elapsed: Duration::ZERO,
            nan_pixels: 0,
        };
        session.take(id, crate::link::Event::Reached { number: before, reached });
        assert!(session.is_aiming());
        session.close();
    }

    #[test]
    fn an_error_is_reached_without_the_device_too() {
        let mut session = opened();
        apply(&mut session, &["variant wgsl", "until 0.05 60"]);
        let goal = session.goal();
        session.leave_device("the device is gone");
        assert_eq!((session.goal(), session.look().variant), (goal, Variant::widest()));
        assert!(goal.is_some() && session.is_aiming());
        assert!(end(&mut session) > 1);
        session.close();
    }
}
