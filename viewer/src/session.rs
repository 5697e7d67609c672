//! The state of the viewer without a window: data, camera, look and pictures.

mod data;
mod events;
mod files;
mod goal;
mod log;
mod menu;
mod record;
mod sky;
mod state;

use std::collections::{BTreeMap, VecDeque};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use raydsl_scenes::Pose;

use crate::action::Action;
use crate::device::Device;
use crate::frame::Frame;
use crate::link::{Job, Report};
use crate::look::{Kind, Look, Mode, Show};
use crate::render;
use crate::subject::{Info, Picked};
use data::Data;
use goal::Aim;
use log::Log;
use menu::OpenMenu;
use raydsl_report::Utilisation;
use record::Recording;
use sky::PendingSky;

/// How a session renders.
#[derive(Clone, Debug)]
pub struct Config {
    /// The time that a coarse picture may take while something moves; none are made without it.
    pub coarse: Option<Duration>,
    /// Samples of each pixel that are taken without being asked for.
    pub samples: u32,
    /// Where pictures are written.
    pub out: PathBuf,
}

impl Config {
    /// Renders as a window needs it: at once, then better and better.
    pub fn interactive(out: impl Into<PathBuf>) -> Self {
        Self { coarse: Some(Duration::from_millis(80)), samples: 1024, out: out.into() }
    }

    /// Renders as a script needs it: what is asked for, the same in every run.
    pub fn scripted(out: impl Into<PathBuf>) -> Self {
        Self { coarse: None, samples: 0, out: out.into() }
    }
}

/// A viewer without a window. [`apply`](Self::apply) does what a person asks for and
/// [`poll`](Self::poll) takes what became of it; neither waits for rendering or loading.
pub struct Session {
    config: Config,
    look: Look,
    files: Vec<PathBuf>,
    step: usize,
    views: BTreeMap<String, Pose>,
    current: Option<Data>,
    info: Option<Info>,
    loading: Option<Data>,
    /// The thread of data that are no longer wanted, while it still reads them.
    leaving: Option<u64>,
    progress: Option<(&'static str, f32)>,
    device: Arc<Device>,
    events: (Sender<Report>, Receiver<Report>),
    wake: Arc<dyn Fn() + Send + Sync>,
    next_id: u64,
    number: u64,
    /// The number of the last change that is more than one of the exposure.
    light: u64,
    limit: u32,
    aim: Aim,
    frame: Option<Arc<Frame>>,
    log: Log,
    picked: Option<Option<Picked>>,
    wgsl: Option<String>,
    /// What the answers to questions for the kernel's text go to: a file, or only a panel.
    wgsl_files: VecDeque<Option<String>>,
    lanes: Option<Utilisation>,
    /// The same of questions for lanes, and the light that they were about.
    lanes_files: VecDeque<(Option<String>, u64)>,
    pending_sky: Option<PendingSky>,
    recording: Option<Recording>,
    open_menu: Option<OpenMenu>,
    questions: usize,
    failed: Option<u64>,
    writers: Vec<JoinHandle<Result<String, String>>>,
}

impl Session {
    /// Creates a session without data. `wake` is called from other threads when there is something
    /// to [`poll`](Self::poll).
    pub fn new(config: Config, device: Device, wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self {
            limit: config.samples,
            config,
            look: Look::default(),
            files: Vec::new(),
            step: 0,
            views: BTreeMap::new(),
            current: None,
            info: None,
            loading: None,
            leaving: None,
            progress: None,
            device: Arc::new(device),
            events: channel(),
            wake: Arc::new(wake),
            next_id: 0,
            number: 0,
            light: 0,
            aim: Aim::default(),
            frame: None,
            log: Log::default(),
            picked: None,
            wgsl: None,
            wgsl_files: VecDeque::new(),
            lanes: None,
            lanes_files: VecDeque::new(),
            pending_sky: None,
            recording: None,
            open_menu: None,
            questions: 0,
            failed: None,
            writers: Vec::new(),
        }
    }

    /// Does what an action asks for. A refusal is in the log, and changes nothing.
    ///
    /// # Errors
    ///
    /// If the action makes no sense here: one line.
    pub fn apply(&mut self, action: &Action) -> Result<(), String> {
        let end = self.try_apply(action);
        match &end {
            Ok(()) => self.log.act(action),
            Err(message) => self.refuse(&format!("{action}: {message}")),
        }
        end
    }

    fn try_apply(&mut self, action: &Action) -> Result<(), String> {
        match action {
            Action::Open(path) => self.load(path, Some(vec![path.clone()]), 0),
            Action::Add(path) => self.add(path.clone()),
            Action::Step(step) => self.go_to(*step)?,
            Action::Cancel => self.cancel()?,
            Action::Pick(x, y) => self.ask_pick(*x, *y)?,
            Action::Wait(0) => return Err("wait for 1 sample or more".to_owned()),
            Action::Wait(samples) => self.want_samples(*samples),
            Action::Picture(name) => self.write_picture(name)?,
            Action::Wgsl(name) => self.ask_wgsl(Some(name))?,
            Action::Lanes(name) => self.ask_lanes(Some(name))?,
            Action::Environment(path) => self.ask_sky(path.as_ref())?,
            Action::Transfer(path) => self.load_transfer(path)?,
            Action::Until(goal) => self.aim(*goal)?,
            Action::Record(film) => self.record(film.as_ref())?,
            Action::Menu(is_open) => self.show_menu(*is_open)?,
            Action::Wand(wand) => self.point(*wand)?,
            Action::Press => self.press()?,
            Action::SaveView(name) => {
                self.views.insert(name.clone(), self.look.pose);
            }
            Action::DropView(name) => {
                self.views.remove(name).ok_or("there is no view of this name")?;
            }
            Action::Screenshot(_) => {
                return Err("there is no window: use `picture`, or --window".to_owned());
            }
            Action::Animate(_) => return Err("only a script or a window plays it".to_owned()),
            Action::Panel(..) | Action::Quit => {}
            change => {
                let mut look = self.look.clone();
                self.change(&mut look, change)?;
                self.set_look(look);
            }
        }
        Ok(())
    }

    /// Changes what is visible.
    fn change(&self, look: &mut Look, action: &Action) -> Result<(), String> {
        match action {
            Action::Size(w, h) => look.size = crate::edit::size(*w, *h)?,
            Action::Mode(mode) => look.mode = self.checked_mode(*mode)?,
            Action::Variant(variant) => look.variant = *variant,
            Action::Show(show) => look.show = self.checked_show(*show)?,
            Action::Exposure(stops) => look.exposure = crate::edit::exposure(*stops)?,
            Action::Home => look.pose = self.info.as_ref().ok_or("nothing is open")?.home,
            Action::Camera(pose) => look.pose = crate::edit::camera(*pose)?,
            Action::View(name) => {
                look.pose = *self.views.get(name).ok_or("there is no view of this name")?;
            }
            Action::DragCut(i, to) => {
                let bounds = self.info.as_ref().ok_or("nothing is open")?.bounds;
                crate::edit::drag_cut(look, *i, *to, bounds)?;
            }
            other => crate::edit::edit(look, other)?,
        }
        Ok(())
    }

    fn checked_mode(&self, mode: Mode) -> Result<Mode, String> {
        let Some(info) = &self.info else { return Err("nothing is open".to_owned()) };
        let modes = Mode::of(info.kind);
        if modes.contains(&mode) {
            return Ok(mode);
        }
        let names: Vec<&str> = modes.iter().map(|m| m.name()).collect();
        Err(format!("choose from {} for these data", names.join(", ")))
    }

    fn checked_show(&self, show: Show) -> Result<Show, String> {
        let kind = self.info.as_ref().map(|info| info.kind);
        if show == Show::Cost && kind.is_some_and(Kind::is_field) {
            let what = if kind == Some(Kind::Cells) { "cells have" } else { "a volume has" };
            return Err(format!("{what} no tree whose tests are counted"));
        }
        Ok(show)
    }

    /// Shows another look; the same one starts nothing again.
    fn set_look(&mut self, look: Look) {
        if look == self.look {
            return;
        }
        if !render::is_same_kernel(&look, &self.look) {
            self.wgsl = None;
        }
        let exposure = look.exposure;
        let is_same_light = look == Look { exposure, ..self.look.clone() };
        self.look = look;
        if is_same_light {
            // The film is shown again, and goes on to as many samples.
            self.number += 1;
            self.submit();
        } else {
            // Other rays run in other lanes.
            self.lanes = None;
            self.restart();
        }
    }

    fn restart(&mut self) {
        self.number += 1;
        self.aim = Aim::default();
        self.light = self.number;
        self.limit = self.config.samples;
        self.submit();
    }

    fn submit(&self) {
        let Some(data) = &self.current else { return };
        let (look, coarse) = (Arc::new(self.look.clone()), self.config.coarse);
        let (number, light, limit) = (self.number, self.light, self.limit);
        let goal = self.aim.goal;
        data.link.want(Job { number, light, look, limit, goal, coarse });
    }

    /// Asks for samples, in place of an error whose picture has fewer.
    pub(crate) fn want_samples(&mut self, samples: u32) {
        if self.aim.goal.is_some() && !self.is_aiming() && !self.has(samples) {
            self.restart();
        }
        if samples > self.limit {
            self.limit = samples;
            self.submit();
        }
    }
}
