//! Data on their threads: one that renders, and one at most that reads.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;

use super::Session;
use crate::data;
use crate::device::Device;
use crate::link::{Event, Link};
use crate::render;

/// Data on their thread.
pub(super) struct Data {
    pub(super) id: u64,
    pub(super) link: Arc<Link>,
    /// Nothing before the thread of other data has ended.
    thread: Option<JoinHandle<()>>,
    pub(super) path: PathBuf,
    /// The time steps that these data begin; nothing if they are a step of those that are open,
    /// whose view is kept.
    pub(super) series: Option<Vec<PathBuf>>,
    /// Their number among the time steps.
    pub(super) step: usize,
}

impl Data {
    /// Ends the thread, and waits for that.
    pub(super) fn end(mut self) {
        self.link.close();
        if let Some(thread) = self.thread.take() {
            // A panic is an event.
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

/// Returns what a panic said.
fn message_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no message").to_owned()
}

/// Loads data and renders them until the link is closed.
fn run(path: &Path, link: &Arc<Link>, device: &Device) {
    let work = || {
        data::load(path, link, &mut |info, subject| {
            link.send(Event::Loaded(Box::new(info)));
            render::serve(subject, link, device);
        })
    };
    // What a panic leaves is dropped here; the link has no half-done state.
    let panic = match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => None,
        Ok(Err(e)) => {
            link.send(Event::Refused(e.to_string()));
            None
        }
        Err(panic) => Some(message_of(&*panic)),
    };
    link.send(Event::Ended(panic));
}

impl Session {
    pub(super) fn go_to(&mut self, step: usize) -> Result<(), String> {
        let Some(last) = self.files.len().checked_sub(1) else {
            return Err("nothing is open".to_owned());
        };
        let path = self.files.get(step).cloned();
        let path = path.ok_or_else(|| format!("steps are from 0 to {last}"))?;
        let is_loading = |data: &Data| data.series.is_none() && data.step == step;
        if !self.loading.as_ref().is_some_and(is_loading) {
            self.load(&path, None, step);
        }
        Ok(())
    }

    /// Adds a time step to the data that are open, or will be.
    pub(super) fn add(&mut self, path: PathBuf) {
        let pending = self.loading.as_mut().and_then(|data| data.series.as_mut());
        pending.unwrap_or(&mut self.files).push(path);
    }

    pub(super) fn cancel(&mut self) -> Result<(), String> {
        let path = self.give_up().ok_or("nothing is loading")?;
        self.log.note(format!("cancelled {}", path.display()));
        Ok(())
    }

    /// Gives up what is loading. Its thread may go on until its file is read, but no other begins
    /// before it ends: two large files would need the memory of both.
    fn give_up(&mut self) -> Option<PathBuf> {
        let data = self.loading.take()?;
        self.progress = None;
        if data.thread.is_some() {
            self.leaving = Some(data.id);
        }
        Some(data.path.clone())
    }

    /// Loads data in place of what is loading; see [`Data`].
    pub(super) fn load(&mut self, path: &Path, series: Option<Vec<PathBuf>>, step: usize) {
        self.give_up();
        self.next_id += 1;
        let id = self.next_id;
        let link = Arc::new(Link::new(id, self.events.0.clone(), self.wake.clone()));
        self.loading = Some(Data { id, link, thread: None, path: path.to_owned(), series, step });
        self.progress = Some(("waiting for the file before", 0.0));
        self.begin_to_load();
    }

    /// Starts the thread of what is loading, unless another one still reads.
    pub(super) fn begin_to_load(&mut self) {
        let Some(data) = self.loading.as_mut().filter(|_| self.leaving.is_none()) else { return };
        let (path, link, device) = (data.path.clone(), data.link.clone(), self.device.clone());
        let thread = std::thread::Builder::new().name("data".to_owned());
        match thread.spawn(move || run(&path, &link, &device)) {
            Ok(thread) => {
                data.thread = Some(thread);
                self.progress = Some(("reading", 0.0));
            }
            Err(e) => {
                let message = format!("no thread for {}: {e}", data.path.display());
                self.loading = None;
                self.progress = None;
                self.refuse(&message);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_say_what_they_said() {
        let said = |work: fn()| catch_unwind(work).map_err(|panic| message_of(&*panic));
        assert_eq!(said(|| panic!("plain")), Err("plain".to_owned()));
        assert_eq!(said(|| panic!("{} of {}", 1, 2)), Err("1 of 2".to_owned()));
        assert_eq!(said(|| std::panic::panic_any(5)), Err("no message".to_owned()));
    }
}
