//! The state of the viewer without a window: data, camera, look and pictures.

mod events;
mod files;
mod state;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use crate::action::Action;
use crate::data;
use crate::device::Device;
use crate::frame::Frame;
use crate::link::{Event, Job, Link, Report};
use crate::look::{Look, Mode};
use crate::pose::Pose;
use crate::render;
use crate::subject::{Info, Picked};

/// The most lines of a log.
const MOST_LINES: usize = 20_000;

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

/// Data on their thread.
struct Data {
    id: u64,
    link: Arc<Link>,
    thread: Option<JoinHandle<()>>,
    path: PathBuf,
    /// Whether the view is kept when these are there.
    keeps_view: bool,
}

impl Data {
    fn has_ended(&self) -> bool {
        self.thread.as_ref().is_some_and(JoinHandle::is_finished)
    }

    /// Ends the thread, and waits for that.
    fn end(mut self) {
        self.link.close();
        if let Some(thread) = self.thread.take() {
            // A panic is on the terminal.
            let _ = thread.join();
        }
    }
}

impl Drop for Data {
    fn drop(&mut self) {
        // The thread ends by itself, after the tile in hand; nobody waits for it.
        self.link.close();
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
    progress: Option<(&'static str, f32)>,
    device: Arc<Device>,
    events: (Sender<Report>, Receiver<Report>),
    wake: Arc<dyn Fn() + Send + Sync>,
    next_id: u64,
    number: u64,
    limit: u32,
    frame: Option<Arc<Frame>>,
    log: Vec<String>,
    errors: usize,
    picked: Option<Option<Picked>>,
    wgsl: Option<String>,
    /// Files that the kernel's text goes to when it is there.
    wgsl_files: Vec<String>,
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
            progress: None,
            device: Arc::new(device),
            events: channel(),
            wake: Arc::new(wake),
            next_id: 0,
            number: 0,
            frame: None,
            log: Vec::new(),
            errors: 0,
            picked: None,
            wgsl: None,
            wgsl_files: Vec::new(),
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
            Ok(()) => self.note(action.to_string()),
            Err(message) => self.refuse(&format!("{action}: {message}")),
        }
        end
    }

    fn try_apply(&mut self, action: &Action) -> Result<(), String> {
        match action {
            Action::Open(path) => {
                self.files = vec![path.clone()];
                self.step = 0;
                self.load(path, false);
            }
            Action::Add(path) => self.files.push(path.clone()),
            Action::Step(step) => self.go_to(*step)?,
            Action::Cancel => {
                let Some(loading) = self.loading.take() else {
                    return Err("nothing is loading".to_owned());
                };
                self.progress = None;
                self.note(format!("cancelled {}", loading.path.display()));
            }
            Action::Pick(x, y) => self.ask_pick(*x, *y)?,
            Action::Wait(samples) => self.want_samples(*samples),
            Action::Picture(name) => self.write_picture(name)?,
            Action::Wgsl(name) => self.ask_wgsl(Some(name))?,
            Action::SaveView(name) => {
                self.views.insert(name.clone(), self.look.pose);
            }
            Action::DropView(name) => {
                self.views.remove(name).ok_or("there is no view of this name")?;
            }
            Action::Screenshot(_) => {
                return Err("there is no window: use `picture`, or --window".to_owned());
            }
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
            Action::Show(show) => look.show = *show,
            Action::Exposure(stops) => look.exposure = stops.clamp(-20.0, 20.0),
            Action::Home => look.pose = self.info.as_ref().ok_or("nothing is open")?.home,
            Action::View(name) => {
                look.pose = *self.views.get(name).ok_or("there is no view of this name")?;
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

    /// Shows another look; the same one starts nothing again.
    fn set_look(&mut self, look: Look) {
        if look != self.look {
            if !render::is_same_kernel(&look, &self.look) {
                self.wgsl = None;
            }
            self.look = look;
            self.restart();
        }
    }

    fn restart(&mut self) {
        self.number += 1;
        self.limit = self.config.samples;
        self.submit();
    }

    fn submit(&self) {
        let Some(data) = &self.current else { return };
        let (look, coarse) = (Arc::new(self.look.clone()), self.config.coarse);
        data.link.want(Job { number: self.number, look, limit: self.limit, coarse });
    }

    pub(crate) fn want_samples(&mut self, samples: u32) {
        if samples > self.limit {
            self.limit = samples;
            self.submit();
        }
    }

    fn go_to(&mut self, step: usize) -> Result<(), String> {
        let path = self.files.get(step).cloned();
        let path = path.ok_or_else(|| format!("there are {} steps", self.files.len()))?;
        self.step = step;
        self.load(&path, true);
        Ok(())
    }

    /// Loads data on a thread of their own, which renders them then.
    fn load(&mut self, path: &Path, keeps_view: bool) {
        self.next_id += 1;
        let (id, path) = (self.next_id, path.to_owned());
        let link = Arc::new(Link::new(id, self.events.0.clone(), self.wake.clone()));
        let (of_thread, device, file) = (link.clone(), self.device.clone(), path.clone());
        let run = move || {
            let link = of_thread;
            let end = data::load(&file, &link, &mut |info, subject| {
                link.send(Event::Loaded(Box::new(info)));
                render::serve(subject, &link, &device);
            });
            if let Err(e) = end {
                link.send(Event::Refused(e.to_string()));
            }
        };
        let thread = std::thread::Builder::new().name("data".to_owned()).spawn(run);
        match thread {
            Ok(thread) => {
                let thread = Some(thread);
                self.progress = Some(("reading", 0.0));
                self.loading = Some(Data { id, link, thread, path, keeps_view });
            }
            Err(e) => self.refuse(&format!("no thread for {}: {e}", path.display())),
        }
    }

    /// Adds a line to the log, which forgets its oldest ones: a mouse makes many.
    fn note(&mut self, line: String) {
        if self.log.len() >= MOST_LINES {
            self.log.drain(..MOST_LINES / 2);
        }
        self.log.push(line);
    }

    /// Adds a line on something that does not work to the log.
    pub fn refuse(&mut self, message: &str) {
        self.errors += 1;
        self.note(format!("error: {message}"));
    }
}
