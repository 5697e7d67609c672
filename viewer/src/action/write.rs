//! Actions as lines of text.

use std::fmt;

use raydsl::prelude::*;

use super::Action;
use crate::look::Knot;

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let three = |v: Vec3| format!("{} {} {}", v.x, v.y, v.z);
        let knot = |k: &Knot| format!("{} {} {}", k.at, k.opacity, three(k.color));
        let switch = |is_on: bool| if is_on { "on" } else { "off" };
        match self {
            Self::Open(path) => write!(f, "open {}", path.display()),
            Self::Add(path) => write!(f, "add {}", path.display()),
            Self::Step(n) => write!(f, "step {n}"),
            Self::Environment(Some(path)) => write!(f, "environment {}", path.display()),
            Self::Environment(None) => f.write_str("environment none"),
            Self::Cancel => f.write_str("cancel"),
            Self::Size(w, h) => write!(f, "size {w} {h}"),
            Self::Mode(mode) => write!(f, "mode {}", mode.name()),
            Self::Variant(variant) => write!(f, "variant {}", variant.name()),
            Self::Show(show) => write!(f, "show {show}"),
            Self::Exposure(stops) => write!(f, "exposure {stops}"),
            Self::Orbit(x, y) => write!(f, "orbit {x} {y}"),
            Self::Turn(x, y) => write!(f, "turn {x} {y}"),
            Self::Fly(v) => write!(f, "fly {}", three(*v)),
            Self::Zoom(factor) => write!(f, "zoom {factor}"),
            Self::Home => f.write_str("home"),
            Self::Camera(pose) => {
                // Radians are no round numbers.
                let fov = (pose.fov_y.to_degrees() * 1e4).round() / 1e4;
                let [eye, target, up] = [pose.eye, pose.target, pose.up].map(three);
                write!(f, "camera {eye} {target} {up} {fov}")
            }
            Self::SaveView(name) => write!(f, "save-view {name}"),
            Self::View(name) => write!(f, "view {name}"),
            Self::DropView(name) => write!(f, "drop-view {name}"),
            Self::AddKnot(k) => write!(f, "knot add {}", knot(k)),
            Self::SetKnot(i, k) => write!(f, "knot set {i} {}", knot(k)),
            Self::RemoveKnot(i) => write!(f, "knot remove {i}"),
            Self::Preset(name) => write!(f, "preset {name}"),
            Self::Transfer(path) => write!(f, "transfer {}", path.display()),
            Self::AddCut(cut) => write!(f, "cut {cut}"),
            Self::MoveCut(i, v) => write!(f, "cut move {i} {}", three(*v)),
            Self::DragCut(i, to) => write!(f, "cut drag {i} {} {}", to.x, to.y),
            Self::RemoveCut(i) => write!(f, "cut remove {i}"),
            Self::Pick(x, y) => write!(f, "pick {x} {y}"),
            Self::Wait(samples) => write!(f, "wait {samples}"),
            Self::Until(Some(goal)) => write!(f, "until {} {}", goal.error, goal.seconds),
            Self::Until(None) => f.write_str("until off"),
            Self::Animate(animation) => write!(f, "animate {animation}"),
            Self::Record(Some((name, rate))) => write!(f, "record {name} {rate}"),
            Self::Record(None) => f.write_str("record end"),
            Self::Lanes(name) => write!(f, "lanes {name}"),
            Self::Menu(is_open) => write!(f, "menu {}", switch(*is_open)),
            Self::Wand(wand) => write!(f, "wand {wand}"),
            Self::Press => f.write_str("press"),
            Self::Picture(name) => write!(f, "picture {name}"),
            Self::Screenshot(name) => write!(f, "screenshot {name}"),
            Self::Wgsl(name) => write!(f, "wgsl {name}"),
            Self::Panel(name, is_open) => write!(f, "panel {name} {}", switch(*is_open)),
            Self::Quit => f.write_str("quit"),
        }
    }
}
