//! What becomes of what was asked for.

use std::thread::JoinHandle;

use raydsl::prelude::*;
use raydsl_report::Utilisation;

use super::Session;
use crate::link::Event;
use crate::look::{Mode, Show, preset};
use crate::subject::Info;

impl Session {
    /// Takes what other threads have done since the last call; returns whether there was anything.
    pub fn poll(&mut self) -> bool {
        let mut is_new = false;
        while let Ok((id, event)) = self.events.1.try_recv() {
            is_new = true;
            self.take(id, event);
        }
        if let Some(frame) = self.current.as_ref().and_then(|data| data.link.take_frame()) {
            is_new = true;
            self.frame = Some(frame);
        }
        let (done, going): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.writers).into_iter().partition(JoinHandle::is_finished);
        self.writers = going;
        is_new |= !done.is_empty();
        done.into_iter().for_each(|writer| self.note_written(writer));
        is_new
    }

    /// Notes the end of a thread: early if nobody has closed its data.
    fn note_ended(&mut self, id: u64, panic: Option<String>) {
        let loading = self.loading.take_if(|data| data.id == id);
        if loading.is_some() {
            self.progress = None;
        }
        if let Some(data) = loading.or_else(|| self.current.take_if(|data| data.id == id)) {
            let why = panic.map(|message| format!(": {message}")).unwrap_or_default();
            self.refuse(&format!("the thread of {} has ended early{why}", data.path.display()));
        }
        if self.leaving == Some(id) {
            self.leaving = None;
            self.begin_to_load();
        }
    }

    pub(super) fn take(&mut self, id: u64, event: Event) {
        let is_loading = self.loading.as_ref().is_some_and(|data| data.id == id);
        let is_current = self.current.as_ref().is_some_and(|data| data.id == id);
        match event {
            Event::Progress { what, share } if is_loading => self.progress = Some((what, share)),
            Event::Loaded(info) if is_loading => self.begin(*info),
            Event::Refused(message) if is_loading => {
                self.loading = None;
                self.progress = None;
                self.refuse(&message);
            }
            Event::Failed { number, message } if is_current && number == self.number => {
                self.failed = Some(number);
                self.refuse(&message);
            }
            Event::DeviceFailed { number, message } if is_current && number == self.number => {
                self.leave_device(&message);
            }
            Event::Picked(picked) if is_current => {
                self.questions = self.questions.saturating_sub(1);
                self.log.note(match &picked {
                    Some(picked) => format!("picked {picked}"),
                    None => "picked nothing".to_owned(),
                });
                self.picked = Some(picked);
            }
            Event::Wgsl(text) if is_current => {
                self.questions = self.questions.saturating_sub(1);
                self.take_wgsl(text);
            }
            Event::Lanes(found) if is_current => {
                self.questions = self.questions.saturating_sub(1);
                self.take_lanes(found);
            }
            // Of any picture of this light: another exposure goes on with the film, and nothing more
            // is said of it.
            Event::Nearer { number, progress } if is_current && number >= self.light => {
                self.note_nearer(progress);
            }
            Event::Reached { number, reached } if is_current && number >= self.light => {
                self.note_reached(reached);
            }
            Event::Sky(sky) => self.take_sky(id, sky),
            Event::Ended(panic) => self.note_ended(id, panic),
            // Of data, or of a picture, that nobody wants any more.
            _ => {}
        }
    }

    /// Takes the answer to the oldest question for the kernel's text.
    fn take_wgsl(&mut self, text: Result<String, String>) {
        let file = self.wgsl_files.pop_front().flatten();
        match text {
            Ok(text) => {
                if let Some(name) = file {
                    self.write_text(&name, text.clone());
                }
                self.wgsl = Some(text);
            }
            Err(message) => self.refuse(&format!("no kernel to print: {message}")),
        }
    }

    /// Takes the answer to the oldest question for lanes.
    fn take_lanes(&mut self, found: Result<Utilisation, String>) {
        let (file, light) = self.lanes_files.pop_front().unwrap_or_default();
        match found {
            Ok(found) => {
                if let Some(name) = file {
                    self.write_text(&name, found.to_string());
                }
                // The camera may have moved meanwhile.
                self.lanes = Some(found).filter(|_| light == self.light);
            }
            Err(message) => self.refuse(&format!("no lanes to count: {message}")),
        }
    }

    /// Goes on with packets when the device does not work.
    pub(super) fn leave_device(&mut self, message: &str) {
        let variant = Variant::widest();
        self.refuse(&format!("{message}; going on with {}", variant.name()));
        let mut look = self.look.clone();
        if look.variant == Variant::Wgsl {
            look.variant = variant;
        }
        if look.show == Show::Difference(Variant::Wgsl) {
            look.show = Show::Picture;
        }
        let (samples, goal) = (self.limit, self.aim.goal);
        self.set_look(look);
        // Who waits for samples, or for an error, still does.
        self.limit = self.limit.max(samples);
        self.aim.goal = goal;
        self.submit();
    }

    /// Shows data that have been loaded.
    fn begin(&mut self, info: Info) {
        let Some(mut data) = self.loading.take() else { return };
        self.progress = None;
        let keeps_view = data.series.is_none();
        if let Some(files) = data.series.take() {
            self.files = files;
        }
        self.step = data.step;
        self.log.note(format!("loaded {}: {}", info.name, info.size));
        let was = self.info.as_ref().map(|info| info.kind);
        if !(keeps_view && was == Some(info.kind)) {
            self.look.pose = info.home;
            self.look.cuts.clear();
            self.look.show = Show::Picture;
            self.look.knots = preset(info.kind.first_preset()).unwrap_or_default();
            self.look.mode = Mode::of(info.kind)[0];
            self.look.sky = None;
            // A light that is still read is for what was shown.
            self.pending_sky = None;
        }
        self.current = Some(data);
        self.questions = 0;
        self.wgsl_files.clear();
        self.lanes_files.clear();
        self.picked = None;
        self.wgsl = None;
        self.lanes = None;
        self.info = Some(info);
        self.restart();
    }
}
