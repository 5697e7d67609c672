//! Lines of text as actions.

use std::path::PathBuf;
use std::str::{FromStr, SplitWhitespace};

use raydsl::prelude::*;
use raydsl_scenes::Pose;

use super::{Action, Goal};
use crate::animation::{Animation, Way};
use crate::look::{CutObject, Knot, Show};
use crate::wand::Wand;

/// The first words of lines.
const VERBS: &str = "open, add, step, environment, cancel, size, mode, variant, show, exposure, \
    orbit, turn, fly, zoom, home, camera, save-view, view, drop-view, knot, preset, transfer, cut, \
    pick, wait, until, picture, animate, record, screenshot, wgsl, lanes, menu, wand, press, panel, \
    quit";

/// The words of a line behind the verb.
struct Words<'a>(SplitWhitespace<'a>);

impl<'a> Words<'a> {
    fn word(&mut self) -> Result<&'a str, String> {
        self.0.next().ok_or_else(|| "a word is missing at the end".to_owned())
    }

    fn read<T: FromStr>(&mut self) -> Result<T, String> {
        let word = self.word()?;
        word.parse().map_err(|_| format!("'{word}' is no number for this place"))
    }

    fn float(&mut self) -> Result<f32, String> {
        let number: f32 = self.read()?;
        if number.is_finite() { Ok(number) } else { Err("numbers are finite".to_owned()) }
    }

    fn three(&mut self) -> Result<Vec3, String> {
        Ok(vec3(self.float()?, self.float()?, self.float()?))
    }

    fn knot(&mut self) -> Result<Knot, String> {
        Ok(Knot { at: self.float()?, opacity: self.float()?, color: self.three()? })
    }

    fn variant(&mut self) -> Result<Variant, String> {
        let word = self.word()?;
        Variant::from_name(word).ok_or_else(|| {
            format!("choose a variant from {}", Variant::ALL.map(Variant::name).join(", "))
        })
    }

    fn show(&mut self) -> Result<Show, String> {
        match self.word()? {
            "picture" => Ok(Show::Picture),
            "cost" => Ok(Show::Cost),
            "difference" => Ok(Show::Difference(self.variant()?)),
            _ => Err("show picture, cost or difference VARIANT".to_owned()),
        }
    }

    fn is_on(&mut self) -> Result<bool, String> {
        match self.word()? {
            "on" => Ok(true),
            "off" => Ok(false),
            _ => Err("write on or off".to_owned()),
        }
    }

    fn of_knot(&mut self) -> Result<Action, String> {
        match self.word()? {
            "add" => Ok(Action::AddKnot(self.knot()?)),
            "set" => Ok(Action::SetKnot(self.read()?, self.knot()?)),
            "remove" => Ok(Action::RemoveKnot(self.read()?)),
            _ => Err("write knot add, knot set or knot remove".to_owned()),
        }
    }

    fn of_cut(&mut self) -> Result<Action, String> {
        match self.word()? {
            "ball" => {
                let (center, radius) = (self.three()?, self.float()?);
                Ok(Action::AddCut(CutObject::Ball { center, radius }))
            }
            "half" => {
                let (through, normal) = (self.three()?, self.three()?);
                Ok(Action::AddCut(CutObject::Half { through, normal }))
            }
            "move" => Ok(Action::MoveCut(self.read()?, self.three()?)),
            "drag" => Ok(Action::DragCut(self.read()?, vec2(self.float()?, self.float()?))),
            "remove" => Ok(Action::RemoveCut(self.read()?)),
            _ => Err("write cut ball, cut half, cut move, cut drag or cut remove".to_owned()),
        }
    }

    fn camera(&mut self) -> Result<Pose, String> {
        let (eye, target, up) = (self.three()?, self.three()?, self.three()?);
        let (up, fov_y) = (up.normalize_or_zero(), self.float()?.to_radians());
        crate::edit::camera(Pose { eye, target, up, fov_y })
    }

    fn until(&mut self) -> Result<Action, String> {
        if self.0.clone().next() == Some("off") {
            self.word()?;
            return Ok(Action::Until(None));
        }
        let goal = Goal { error: self.float()?, seconds: self.float()? };
        Ok(Action::Until(Some(goal.checked()?)))
    }

    fn animation(&mut self) -> Result<Animation, String> {
        let way = match self.word()? {
            "turntable" => Way::Turntable(self.read()?),
            "views" => Way::Views(self.read()?),
            "steps" => Way::Steps,
            _ => return Err("write animate turntable, animate views or animate steps".to_owned()),
        };
        let animation = Animation { way, samples: self.read()?, name: self.word()?.to_owned() };
        animation.checked()
    }

    fn record(&mut self) -> Result<Action, String> {
        let name = self.word()?;
        if name == "end" && self.0.clone().next().is_none() {
            return Ok(Action::Record(None));
        }
        match self.read()? {
            rate @ 1..=1000 => Ok(Action::Record(Some((name.to_owned(), rate)))),
            _ => Err("a film has 1 to 1000 pictures a second".to_owned()),
        }
    }

    fn wand(&mut self) -> Result<Wand, String> {
        match self.word()? {
            "pixel" => Ok(Wand::Pixel(vec2(self.float()?, self.float()?))),
            "matrix" => {
                let mut numbers = [0.0; 16];
                for number in &mut numbers {
                    *number = self.float()?;
                }
                Ok(Wand::Tracked(Mat4::from_cols_array(&numbers)))
            }
            _ => Err("write wand pixel or wand matrix".to_owned()),
        }
    }

    fn action(&mut self, verb: &str) -> Result<Action, String> {
        Ok(match verb {
            "step" => Action::Step(self.read()?),
            "cancel" => Action::Cancel,
            "size" => Action::Size(self.read()?, self.read()?),
            "mode" => Action::Mode(self.word()?.parse()?),
            "variant" => Action::Variant(self.variant()?),
            "show" => Action::Show(self.show()?),
            "exposure" => Action::Exposure(self.float()?),
            "orbit" => Action::Orbit(self.float()?, self.float()?),
            "turn" => Action::Turn(self.float()?, self.float()?),
            "fly" => Action::Fly(self.three()?),
            "zoom" => Action::Zoom(self.float()?),
            "home" => Action::Home,
            "camera" => Action::Camera(self.camera()?),
            "save-view" => Action::SaveView(self.word()?.to_owned()),
            "view" => Action::View(self.word()?.to_owned()),
            "drop-view" => Action::DropView(self.word()?.to_owned()),
            "knot" => self.of_knot()?,
            "preset" => Action::Preset(self.word()?.to_owned()),
            "cut" => self.of_cut()?,
            "pick" => Action::Pick(self.read()?, self.read()?),
            "wait" => match self.read()? {
                0 => return Err("wait for 1 sample or more".to_owned()),
                samples => Action::Wait(samples),
            },
            "until" => self.until()?,
            "animate" => Action::Animate(self.animation()?),
            "record" => self.record()?,
            "lanes" => Action::Lanes(self.word()?.to_owned()),
            "menu" => Action::Menu(self.is_on()?),
            "wand" => Action::Wand(self.wand()?),
            "press" => Action::Press,
            "picture" => Action::Picture(self.word()?.to_owned()),
            "screenshot" => Action::Screenshot(self.word()?.to_owned()),
            "wgsl" => Action::Wgsl(self.word()?.to_owned()),
            "panel" => Action::Panel(self.word()?.to_owned(), self.is_on()?),
            "quit" => Action::Quit,
            "" => return Err(format!("the verb is missing: choose from {VERBS}")),
            _ => return Err(format!("'{verb}' is no verb: choose from {VERBS}")),
        })
    }
}

impl FromStr for Action {
    type Err = String;

    fn from_str(line: &str) -> Result<Self, String> {
        let line = line.trim();
        let (verb, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        // The names of files may have spaces.
        let path = || match rest.trim() {
            "" => Err("the name of a file is missing".to_owned()),
            path => Ok(PathBuf::from(path)),
        };
        match verb {
            "open" => return Ok(Self::Open(path()?)),
            "add" => return Ok(Self::Add(path()?)),
            "transfer" => return Ok(Self::Transfer(path()?)),
            "environment" if rest.trim() == "none" => return Ok(Self::Environment(None)),
            "environment" => return Ok(Self::Environment(Some(path()?))),
            _ => {}
        }
        let mut words = Words(rest.split_whitespace());
        let action = words.action(verb)?;
        match words.0.next() {
            Some(word) => Err(format!("'{word}' is one word too many")),
            None => Ok(action),
        }
    }
}
