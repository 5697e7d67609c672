//! Environments of files, each read by a thread of its own.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Session;
use crate::data::load_environment;
use crate::link::Event;
use crate::look::{Kind, Sky};

/// An environment that is being read.
#[derive(Debug)]
pub(super) struct PendingSky {
    id: u64,
    stop: Arc<AtomicBool>,
}

impl Drop for PendingSky {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

impl Session {
    /// Takes the light of a file, or none.
    pub(super) fn ask_sky(&mut self, path: Option<&PathBuf>) -> Result<(), String> {
        let kind = self.info.as_ref().ok_or("nothing is open")?.kind;
        if kind != Kind::Surface {
            return Err("only surfaces are lit by an environment".to_owned());
        }
        let Some(path) = path else {
            self.pending_sky = None;
            let look = crate::look::Look { sky: None, ..self.look.clone() };
            self.set_look(look);
            return Ok(());
        };
        self.next_id += 1;
        let (id, stop) = (self.next_id, Arc::new(AtomicBool::new(false)));
        let pending = PendingSky { id, stop: stop.clone() };
        let (path, sender, wake) = (path.clone(), self.events.0.clone(), self.wake.clone());
        let read = move || {
            let found = raydsl_io::stoppable(&stop, || read(&path));
            // A session that is gone needs none.
            let _ = sender.send((id, Event::Sky(found)));
            wake();
        };
        let thread = std::thread::Builder::new().name("environment".to_owned()).spawn(read);
        thread.map_err(|e| format!("no thread to read a file: {e}"))?;
        // Only now: nothing would ever answer without a thread.
        self.pending_sky = Some(pending);
        Ok(())
    }

    /// Takes what was read, unless another one was asked for meanwhile.
    pub(super) fn take_sky(&mut self, id: u64, sky: Result<Sky, String>) {
        if self.pending_sky.take_if(|pending| pending.id == id).is_none() {
            return;
        }
        match sky {
            Ok(sky) => {
                self.log.note(format!("lit by {}", sky.path().display()));
                let look = crate::look::Look { sky: Some(sky), ..self.look.clone() };
                self.set_look(look);
            }
            Err(message) => self.refuse(&message),
        }
    }
}

/// Reads a file; a panic is an error as any other.
fn read(path: &Path) -> Result<Sky, String> {
    let load = || load_environment(path).map(|light| Sky::new(path.to_owned(), light));
    match std::panic::catch_unwind(load) {
        Ok(end) => end.map_err(|e| e.to_string()),
        Err(_) => Err(format!("{}: the reader has failed", path.display())),
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;
    use crate::device::Device;
    use crate::session::Config;

    /// Applies a line, and waits until what it opens is there.
    fn apply(session: &mut Session, line: &str) {
        session.apply(&line.parse().expect(line)).expect(line);
        let start = Instant::now();
        while session.progress().is_some() {
            assert!(start.elapsed() < Duration::from_secs(60), "{:#?}", session.log());
            session.poll();
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_light_that_is_read_is_kept_with_the_view() {
        let room = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/room.obj");
        let mut session = Session::new(Config::scripted("out"), Device::default(), || {});
        apply(&mut session, &format!("open {room}"));
        apply(&mut session, &format!("add {room}"));
        // Of a thread that reads longer than the step takes.
        let stop = Arc::new(AtomicBool::new(false));
        session.pending_sky = Some(PendingSky { id: u64::MAX, stop: stop.clone() });
        apply(&mut session, "step 1");
        assert_eq!(session.steps().1, 1, "{:#?}", session.log());
        assert!(session.is_asking() && !stop.load(Ordering::Relaxed), "it is still read");
        let light = raydsl::light::Environment::constant(raydsl::prelude::Vec3::ONE);
        let sky = Sky::new("white.hdr".into(), light.expect("it is white"));
        session.take(u64::MAX, Event::Sky(Ok(sky.clone())));
        assert_eq!(session.look().sky, Some(sky), "and lights the step");
        // Other data are not lit by it.
        let stop = Arc::new(AtomicBool::new(false));
        session.pending_sky = Some(PendingSky { id: u64::MAX, stop: stop.clone() });
        apply(&mut session, &format!("open {room}"));
        assert!(!session.is_asking() && stop.load(Ordering::Relaxed));
        assert_eq!(session.look().sky, None);
        session.close();
    }
}
