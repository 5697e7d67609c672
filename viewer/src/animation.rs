//! Pictures that follow each other: what is done for each of them, as actions.

use std::fmt;

use raydsl_scenes::Pose;

use crate::action::Action;
use crate::session::Session;

/// What is animated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// The camera goes once around its target, in so many pictures.
    Turntable(u32),
    /// The camera goes along those that are kept, in the order of their names, in so many pictures.
    Views(u32),
    /// Each time step has a picture.
    Steps,
}

/// Pictures in a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// What is animated.
    pub way: Way,
    /// Samples of each pixel.
    pub samples: u32,
    /// Name of the files, without a number.
    pub name: String,
}

/// The most pictures of an animation.
const MOST_FRAMES: u32 = 10_000;
/// Pictures a second of cameras that move, and of time steps.
const RATES: (u16, u16) = (25, 8);

impl fmt::Display for Animation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { way, samples, name } = self;
        match way {
            Way::Turntable(frames) => write!(f, "turntable {frames} {samples} {name}"),
            Way::Views(frames) => write!(f, "views {frames} {samples} {name}"),
            Way::Steps => write!(f, "steps {samples} {name}"),
        }
    }
}

impl Animation {
    /// The number of actions at the end that one which is given up needs too: they write the film, and
    /// take the camera or the step of before.
    pub(crate) const END: usize = 2;

    /// Returns the animation, if it has pictures.
    pub(crate) fn checked(self) -> Result<Self, String> {
        let frames = match self.way {
            Way::Turntable(frames) | Way::Views(frames) => frames,
            Way::Steps => 1,
        };
        if (1..=MOST_FRAMES).contains(&frames) && self.samples > 0 {
            return Ok(self);
        }
        Err(format!("an animation has 1 to {MOST_FRAMES} frames of 1 sample or more"))
    }

    /// Returns what is done for it, with [`END`](Self::END) actions after its pictures; the camera or
    /// the step is at the end what it was.
    pub(crate) fn actions(&self, session: &Session) -> Result<Vec<Action>, String> {
        if session.info().is_none() {
            return Err("nothing is open".to_owned());
        }
        if session.recorded().is_some() {
            return Err("a film is recorded, which would get its pictures: record end".to_owned());
        }
        let now = session.look().pose;
        let (changes, last, rate) = match self.way {
            Way::Turntable(frames) => {
                let turned = |i: u32| {
                    let mut pose = now;
                    pose.orbit(360.0 * i as f32 / frames as f32, 0.0);
                    Action::Camera(pose)
                };
                ((0..frames).map(turned).collect(), Action::Camera(now), RATES.0)
            }
            Way::Views(frames) => {
                let kept: Vec<Pose> = session.views().values().copied().collect();
                if kept.len() < 2 {
                    return Err("keep two cameras or more".to_owned());
                }
                let share = |i: u32| f64::from(i) / f64::from((frames - 1).max(1));
                let poses = (0..frames).map(|i| Action::Camera(along(&kept, share(i))));
                (poses.collect(), Action::Camera(now), RATES.0)
            }
            Way::Steps => {
                let (files, step) = session.steps();
                let steps: Vec<Action> = (0..files.len()).map(Action::Step).collect();
                (steps, Action::Step(step), RATES.1)
            }
        };
        Ok(self.filmed(changes, last, rate))
    }

    /// A picture after each change.
    fn filmed(&self, changes: Vec<Action>, last: Action, rate: u16) -> Vec<Action> {
        let Self { samples, name, .. } = self;
        let mut actions = vec![Action::Record(Some((name.clone(), rate)))];
        for (i, change) in changes.into_iter().enumerate() {
            actions.push(change);
            actions.push(Action::Wait(*samples));
            actions.push(Action::Picture(format!("{name}-{i:04}.png")));
        }
        actions.push(Action::Record(None));
        actions.push(last);
        actions
    }
}

/// Returns the pose at a share of the way along others, which begins and ends gently at each of them.
/// Distances from the target are between those beside it, so that the camera goes around what it
/// looks at and not through it.
fn along(poses: &[Pose], share: f64) -> Pose {
    let place = share.clamp(0.0, 1.0) * (poses.len() - 1) as f64;
    let first = (place.floor() as usize).min(poses.len() - 2);
    let s = (place - first as f64) as f32;
    let s = s * s * (3.0 - 2.0 * s);
    let (a, b) = (poses[first], poses[first + 1]);
    let between = |x: f32, y: f32| x + (y - x) * s;
    let target = a.target.lerp(b.target, s);
    let (from, to) = (a.eye - a.target, b.eye - b.target);
    let way = from.normalize_or(to).slerp(to.normalize_or(from), s);
    let eye = target + way * between(from.length(), to.length());
    let up = a.up.lerp(b.up, s).normalize_or(a.up);
    let pose = Pose { eye, target, up, fov_y: between(a.fov_y, b.fov_y) };
    // Opposite directions have no middle.
    if pose.is_valid() { pose } else { if s < 0.5 { a } else { b } }
}

#[cfg(test)]
mod tests {
    use raydsl::prelude::*;

    use super::*;

    #[test]
    fn ways_go_through_all_cameras() {
        let pose = |x: f32, fov_y: f32| Pose { eye: vec3(x, -3.0, 1.0), fov_y, ..Pose::default() };
        let poses = [pose(0.0, 0.5), pose(2.0, 0.7), pose(-3.0, 0.9)];
        for (share, expected) in [(0.0, poses[0]), (0.5, poses[1]), (1.0, poses[2])] {
            let found = along(&poses, share);
            assert!(found.eye.distance(expected.eye) < 1e-5, "{found:?}");
            assert!((found.fov_y - expected.fov_y).abs() < 1e-6);
        }
        for i in 0..=100 {
            let found = along(&poses, f64::from(i) / 100.0);
            let [least, most] = [poses[0].distance(), poses[2].distance()];
            assert!(found.is_valid() && (least - 1e-4..most + 1e-4).contains(&found.distance()));
        }
    }
}
