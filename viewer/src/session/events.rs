//! What becomes of what was asked for.

use raydsl::prelude::*;
use std::thread::JoinHandle;

use super::Session;
use crate::link::Event;
use crate::look::{Mode, Show, preset};
use crate::subject::Info;

impl Session {
    /// Takes what other threads have done since the last call; returns whether there was anything.
    pub fn poll(&mut self) -> bool {
        let before = self.log.len();
        let mut is_new = false;
        // Looked at first: what a thread reported before its end is taken below.
        let data = [&self.loading, &self.current].into_iter().flatten();
        let ended: Vec<u64> = data.filter(|data| data.has_ended()).map(|data| data.id).collect();
        while let Ok((id, event)) = self.events.1.try_recv() {
            is_new = true;
            self.take(id, event);
        }
        if let Some(frame) = self.current.as_ref().and_then(|data| data.link.take_frame()) {
            is_new = true;
            self.frame = Some(frame);
        }
        self.note_ended(&ended);
        let (done, going): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.writers).into_iter().partition(JoinHandle::is_finished);
        self.writers = going;
        done.into_iter().for_each(|writer| self.note_written(writer));
        is_new || self.log.len() != before
    }

    /// Notes threads that have ended although nobody closed them: by a panic, whose message is on
    /// the terminal.
    fn note_ended(&mut self, ended: &[u64]) {
        let has_ended = |data: &mut super::Data| ended.contains(&data.id);
        let lost = [self.loading.take_if(has_ended), self.current.take_if(has_ended)];
        for data in lost.into_iter().flatten() {
            self.progress = None;
            self.refuse(&format!("the thread of {} has ended early", data.path.display()));
        }
    }

    fn take(&mut self, id: u64, event: Event) {
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
            Event::Failed(message) if is_current => {
                self.failed = Some(self.number);
                self.refuse(&message);
            }
            Event::DeviceFailed(message) if is_current => self.leave_device(&message),
            Event::Picked(picked) if is_current => {
                self.questions = self.questions.saturating_sub(1);
                self.note(crate::edit::line_of_pick(picked.as_ref()));
                self.picked = Some(picked);
            }
            Event::Wgsl(text) if is_current => {
                self.questions = self.questions.saturating_sub(1);
                for name in std::mem::take(&mut self.wgsl_files) {
                    let (path, text) = (self.config.out.join(&name), text.clone());
                    self.write(&name, move || {
                        std::fs::write(&path, text)
                            .map_err(|e| format!("cannot write {}: {e}", path.display()))
                    });
                }
                self.wgsl = Some(text);
            }
            // Of data that nobody wants any more.
            _ => {}
        }
    }

    /// Goes on with packets when the device does not work.
    fn leave_device(&mut self, message: &str) {
        let variant = Variant::widest();
        self.refuse(&format!("{message}; going on with {}", variant.name()));
        let mut look = self.look.clone();
        if look.variant == Variant::Wgsl {
            look.variant = variant;
        }
        if look.show == Show::Difference(Variant::Wgsl) {
            look.show = Show::Picture;
        }
        let samples = self.limit;
        self.set_look(look);
        // Who waits for samples still does.
        self.want_samples(samples);
    }

    /// Shows data that have been loaded.
    fn begin(&mut self, info: Info) {
        let Some(data) = self.loading.take() else { return };
        self.progress = None;
        self.note(format!("loaded {}: {}", info.name, info.size));
        let was = self.info.as_ref().map(|info| info.kind);
        if !(data.keeps_view && was == Some(info.kind)) {
            self.look.pose = info.home;
            self.look.cuts.clear();
            self.look.show = Show::Picture;
            self.look.knots = preset("tissue").unwrap_or_default();
            self.look.mode = Mode::of(info.kind)[0];
        }
        self.current = Some(data);
        self.questions = 0;
        self.wgsl_files.clear();
        self.picked = None;
        self.wgsl = None;
        self.info = Some(info);
        self.restart();
    }
}
