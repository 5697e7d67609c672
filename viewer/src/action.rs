//! Everything that a person can do, as values, and as lines of text.

mod read;

use std::fmt;
use std::path::PathBuf;

use raydsl::prelude::*;

use crate::look::{CutObject, Knot, Mode, Show};

/// Something that a person does. A line of a script is one: [`FromStr`](std::str::FromStr) reads
/// it, and [`Display`](fmt::Display) writes it.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// `open FILE`: opens a file, or data that are made in code: `landscape:POINTS`, `head:SIDE`.
    Open(PathBuf),
    /// `add FILE`: adds a file as the next time step.
    Add(PathBuf),
    /// `step N`: opens the time step of this number, from 0, and keeps the view.
    Step(usize),
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
    /// `cut ball X Y Z R` or `cut half X Y Z NX NY NZ`, in shares of the volume's box.
    AddCut(CutObject),
    /// `cut move I X Y Z`: moves cut object `I` by shares of the box.
    MoveCut(usize, Vec3),
    /// `cut remove I`.
    RemoveCut(usize),
    /// `pick X Y`: asks what is seen in a pixel, counted from the lower left.
    Pick(u32, u32),
    /// `wait SAMPLES`: waits until each pixel has that many samples.
    Wait(u32),
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

impl Action {
    /// Returns the action that does the same as this one and then another, if there is one.
    pub(crate) fn joined(&self, next: &Self) -> Option<Self> {
        Some(match (self, next) {
            (Self::Orbit(x, y), Self::Orbit(dx, dy)) => Self::Orbit(x + dx, y + dy),
            (Self::Turn(x, y), Self::Turn(dx, dy)) => Self::Turn(x + dx, y + dy),
            (Self::Fly(v), Self::Fly(by)) => Self::Fly(*v + *by),
            (Self::Zoom(factor), Self::Zoom(by)) => Self::Zoom(factor * by),
            (Self::Size(..), Self::Size(w, h)) => Self::Size(*w, *h),
            _ => return None,
        })
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let knot =
            |k: &Knot| format!("{} {} {} {} {}", k.at, k.opacity, k.color.x, k.color.y, k.color.z);
        match self {
            Self::Open(path) => write!(f, "open {}", path.display()),
            Self::Add(path) => write!(f, "add {}", path.display()),
            Self::Step(n) => write!(f, "step {n}"),
            Self::Cancel => f.write_str("cancel"),
            Self::Size(w, h) => write!(f, "size {w} {h}"),
            Self::Mode(mode) => write!(f, "mode {}", mode.name()),
            Self::Variant(variant) => write!(f, "variant {}", variant.name()),
            Self::Show(show) => write!(f, "show {show}"),
            Self::Exposure(stops) => write!(f, "exposure {stops}"),
            Self::Orbit(x, y) => write!(f, "orbit {x} {y}"),
            Self::Turn(x, y) => write!(f, "turn {x} {y}"),
            Self::Fly(v) => write!(f, "fly {} {} {}", v.x, v.y, v.z),
            Self::Zoom(factor) => write!(f, "zoom {factor}"),
            Self::Home => f.write_str("home"),
            Self::SaveView(name) => write!(f, "save-view {name}"),
            Self::View(name) => write!(f, "view {name}"),
            Self::DropView(name) => write!(f, "drop-view {name}"),
            Self::AddKnot(k) => write!(f, "knot add {}", knot(k)),
            Self::SetKnot(i, k) => write!(f, "knot set {i} {}", knot(k)),
            Self::RemoveKnot(i) => write!(f, "knot remove {i}"),
            Self::Preset(name) => write!(f, "preset {name}"),
            Self::AddCut(cut) => write!(f, "cut {cut}"),
            Self::MoveCut(i, v) => write!(f, "cut move {i} {} {} {}", v.x, v.y, v.z),
            Self::RemoveCut(i) => write!(f, "cut remove {i}"),
            Self::Pick(x, y) => write!(f, "pick {x} {y}"),
            Self::Wait(samples) => write!(f, "wait {samples}"),
            Self::Picture(name) => write!(f, "picture {name}"),
            Self::Screenshot(name) => write!(f, "screenshot {name}"),
            Self::Wgsl(name) => write!(f, "wgsl {name}"),
            Self::Panel(name, is_open) => {
                write!(f, "panel {name} {}", if *is_open { "on" } else { "off" })
            }
            Self::Quit => f.write_str("quit"),
        }
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
            "cut remove 0",
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
            ("cut cube 1", "write cut ball, cut half, cut move or cut remove"),
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
