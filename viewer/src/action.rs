//! Everything that a person can do, as values, and as lines of text.

mod read;
mod write;

use std::path::PathBuf;

use raydsl::prelude::*;
use raydsl_scenes::Pose;

use crate::animation::Animation;
use crate::look::{CutObject, Knot, Mode, Show};
use crate::wand::Wand;

/// Something that a person does. A line of a script is one: [`FromStr`](std::str::FromStr) reads
/// it, and [`Display`](std::fmt::Display) writes it.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// `open FILE`: opens a file, or data that are made in code: `landscape:POINTS`, `head:SIDE`.
    Open(PathBuf),
    /// `add FILE`: adds a file as the next time step.
    Add(PathBuf),
    /// `step N`: opens the time step of this number, from 0, and keeps the view.
    Step(usize),
    /// `environment FILE` or `environment none`: lights surfaces by a picture of all directions.
    Environment(Option<PathBuf>),
    /// `cancel`: stops loading.
    Cancel,
    /// `size W H`: sets the size of the picture.
    Size(u32, u32),
    /// `mode NAME`: sets how data become light.
    Mode(Mode),
    /// `variant NAME`: sets what runs the kernel.
    Variant(Variant),
    /// `show picture`, `show cost` or `show difference VARIANT`.
    Show(Show),
    /// `exposure STOPS`.
    Exposure(f32),
    /// `orbit DX DY`: turns the camera around its target, by degrees.
    Orbit(f32, f32),
    /// `turn DX DY`: turns the line of sight, by degrees.
    Turn(f32, f32),
    /// `fly X Y Z`: moves right, up and ahead, by shares of the distance from the target.
    Fly(Vec3),
    /// `zoom FACTOR`: changes the distance from the target.
    Zoom(f32),
    /// `home`: looks at all of the data.
    Home,
    /// `camera EX EY EZ TX TY TZ UX UY UZ FOV`: sets the eye, the target, what is up, and the
    /// vertical field of view in degrees.
    Camera(Pose),
    /// `save-view NAME`: keeps the camera under a name.
    SaveView(String),
    /// `view NAME`: goes back to a kept camera.
    View(String),
    /// `drop-view NAME`: forgets a kept camera.
    DropView(String),
    /// `knot add AT OPACITY R G B`: adds a knot to the transfer function.
    AddKnot(Knot),
    /// `knot set I AT OPACITY R G B`: changes knot `I`, from 0.
    SetKnot(usize, Knot),
    /// `knot remove I`.
    RemoveKnot(usize),
    /// `preset NAME`: takes a ready-made transfer function.
    Preset(String),
    /// `transfer FILE`: takes the first transfer function of a file of ParaView.
    Transfer(PathBuf),
    /// `cut ball X Y Z R` or `cut half X Y Z NX NY NZ`, in shares of the volume's box.
    AddCut(CutObject),
    /// `cut move I X Y Z`: moves cut object `I` by shares of the box.
    MoveCut(usize, Vec3),
    /// `cut drag I X Y`: moves cut object `I` in the plane of the picture, until it is seen in this
    /// place, in pixels from the lower left.
    DragCut(usize, Vec2),
    /// `cut remove I`.
    RemoveCut(usize),
    /// `pick X Y`: asks what is seen in a pixel, counted from the lower left.
    Pick(u32, u32),
    /// `wait SAMPLES`: waits until each pixel has that many samples.
    Wait(u32),
    /// `until ERROR SECONDS`: renders until the root mean squared error is at most this, with a
    /// confidence of 95 %, or the time is spent; `until off` ends that.
    Until(Option<Goal>),
    /// `animate turntable FRAMES SAMPLES NAME`, `animate views FRAMES SAMPLES NAME` or `animate steps
    /// SAMPLES NAME`: writes numbered pictures, and all of them in one that moves.
    Animate(Animation),
    /// `record NAME RATE`: pictures that are written from now on are those of one that moves, so many
    /// a second; `record end` writes it.
    Record(Option<(String, u16)>),
    /// `lanes NAME`: writes how many lanes of packets run at each line of the kernel.
    Lanes(String),
    /// `menu on` or `menu off`: shows a menu before the camera.
    Menu(bool),
    /// `wand pixel X Y` or `wand matrix M ..`: points at the menu.
    Wand(Wand),
    /// `press`: chooses the item of the menu that the wand points at.
    Press,
    /// `picture NAME`: writes the picture as PNG.
    Picture(String),
    /// `screenshot NAME`: writes all of the window as PNG.
    Screenshot(String),
    /// `wgsl NAME`: writes the kernel as WGSL.
    Wgsl(String),
    /// `panel NAME on|off`: opens or closes a panel of the window.
    Panel(String, bool),
    /// `quit`.
    Quit,
}

/// An error that a picture is to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// The root mean squared error, above 0.
    pub error: f32,
    /// Seconds that may be spent on it, above 0.
    pub seconds: f32,
}

impl Goal {
    /// Returns the goal, if its numbers are above 0 and finite.
    pub(crate) fn checked(self) -> Result<Self, String> {
        let is_right = |number: f32| number > 0.0 && number.is_finite();
        if is_right(self.error) && is_right(self.seconds) {
            return Ok(self);
        }
        Err("errors and seconds are above 0 and finite".to_owned())
    }
}

impl Action {
    /// Returns the action that does the same as this one and then another, if there is one.
    pub(crate) fn joined(&self, next: &Self) -> Option<Self> {
        Some(match (self, next) {
            (Self::Orbit(x, y), Self::Orbit(dx, dy)) => Self::Orbit(x + dx, y + dy),
            (Self::Turn(x, y), Self::Turn(dx, dy)) => Self::Turn(x + dx, y + dy),
            (Self::Fly(v), Self::Fly(by)) => Self::Fly(*v + *by),
            (Self::Zoom(factor), Self::Zoom(by)) => Self::Zoom(factor * by),
            (Self::Size(..), Self::Size(..)) | (Self::Wand(_), Self::Wand(_)) => next.clone(),
            (Self::DragCut(i, _), Self::DragCut(j, _)) if i == j => next.clone(),
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_back_as_they_were() {
        for line in [
            "open a scan.laz",
            "add b.vti",
            "step 3",
            "cancel",
            "size 320 200",
            "mode path",
            "variant packet8",
            "show picture",
            "show cost",
            "show difference wgsl",
            "exposure -1.5",
            "orbit 10 -5",
            "turn 1 2",
            "fly 0 0.5 1",
            "zoom 0.9",
            "home",
            "save-view a",
            "view a",
            "drop-view a",
            "knot add 0.5 0.25 1 0 0",
            "knot set 2 0.5 0.25 1 0 0",
            "knot remove 1",
            "preset glass",
            "cut ball 0.5 0.5 0.5 0.25",
            "cut half 0.5 0.5 0.5 0 0 1",
            "cut move 0 0.1 0 0",
            "cut drag 0 120.5 80",
            "cut remove 0",
            "transfer a map.json",
            "environment a sky.hdr",
            "environment none",
            "camera 0 -3 1 0 0 0.5 0 0 1 40",
            "until 0.01 30",
            "until off",
            "animate turntable 36 4 turn",
            "animate views 48 16 flight",
            "animate steps 2 time",
            "record film 25",
            "record end",
            "lanes lanes.txt",
            "menu on",
            "menu off",
            "wand pixel 80 45.5",
            "wand matrix 1 0 0 0 0 1 0 0 0 0 1 0 0 0 5 1",
            "press",
            "pick 10 20",
            "wait 16",
            "picture a.png",
            "screenshot b.png",
            "wgsl a.wgsl",
            "panel keys on",
            "panel keys off",
            "quit",
        ] {
            let action: Action = line.parse().unwrap_or_else(|e| panic!("{line}: {e}"));
            assert_eq!(action.to_string(), line);
        }
    }

    #[test]
    fn wrong_lines_say_what_is_wrong() {
        for (line, expected) in [
            ("", "the verb is missing: choose from open, add, "),
            ("open", "the name of a file is missing"),
            ("fly 1 2", "a word is missing at the end"),
            ("fly 1 2 x", "'x' is no number for this place"),
            ("fly 1 2 inf", "numbers are finite"),
            ("mode none", "choose a mode from spheres, "),
            ("variant packet5", "choose a variant from scalar, packet4, "),
            ("show", "a word is missing at the end"),
            ("show light", "show picture, cost or difference VARIANT"),
            ("home now", "'now' is one word too many"),
            ("cut cube 1", "write cut ball, cut half, cut move, cut drag or cut remove"),
            ("until 0 5", "errors and seconds are above 0"),
            ("camera 0 0 0 0 0 0 0 0 1 40", "the camera has no direction"),
            ("camera 0 -3 1 0 0 0 0 0 1 180", "the field of view is from 0.1 to 170 degrees"),
            ("animate dance 5 5 a", "write animate turntable, animate views or animate steps"),
            ("animate turntable 0 4 a", "an animation has 1 to 10000 frames of 1 sample or more"),
            ("record film 0", "a film has 1 to 1000 pictures a second"),
            ("wand matrix 1 2 3", "a word is missing at the end"),
            ("wand ray 1 2 3", "write wand pixel or wand matrix"),
            ("knot turn 1", "write knot add, knot set or knot remove"),
            ("panel keys maybe", "write on or off"),
            ("step -1", "'-1' is no number for this place"),
            ("wait 0", "wait for 1 sample or more"),
            ("dance", "'dance' is no verb: choose from open, add, "),
        ] {
            let error = line.parse::<Action>().expect_err(line);
            assert!(error.starts_with(expected), "{line}: {error}");
        }
    }
}
