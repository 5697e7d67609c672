//! Pictures that become one that moves.

use std::path::Path;
use std::sync::Arc;

use super::Session;
use crate::film::write_film;
use crate::frame::save;

/// The most bytes of the pictures of a film, which are kept until it is written.
const MOST_BYTES: usize = 2 << 30;

/// What has been recorded so far.
#[derive(Debug)]
pub(super) struct Recording {
    name: String,
    /// Pictures a second.
    rate: u16,
    size: (u32, u32),
    frames: Vec<Arc<Vec<u8>>>,
}

impl Session {
    /// Begins a film, or writes the one that was begun.
    pub(super) fn record(&mut self, film: Option<&(String, u16)>) -> Result<(), String> {
        match film {
            Some(_) if self.recording.is_some() => Err("a film is recorded already".to_owned()),
            Some((name, rate)) => {
                let (name, size) = (name.clone(), (0, 0));
                self.recording = Some(Recording { name, rate: *rate, size, frames: Vec::new() });
                Ok(())
            }
            None => {
                let recording = self.recording.take().ok_or("no film is recorded")?;
                self.write_film(recording)
            }
        }
    }

    /// Returns how many pictures have been recorded, if a film is.
    pub fn recorded(&self) -> Option<usize> {
        self.recording.as_ref().map(|recording| recording.frames.len())
    }

    /// Adds a picture to the film, if one is recorded.
    pub(super) fn add_to_film(
        &mut self,
        rgba: &Arc<Vec<u8>>,
        size: (u32, u32),
    ) -> Result<(), String> {
        let Some(recording) = &mut self.recording else { return Ok(()) };
        if recording.frames.is_empty() {
            recording.size = size;
        }
        if recording.size != size {
            let (width, height) = recording.size;
            return Err(format!("the pictures of the film have {width} x {height} pixels"));
        }
        if (recording.frames.len() + 1) * rgba.len() > MOST_BYTES {
            return Err("the film has 2 GiB: record end, and begin another one".to_owned());
        }
        recording.frames.push(rgba.clone());
        Ok(())
    }

    fn write_film(&mut self, recording: Recording) -> Result<(), String> {
        if recording.frames.is_empty() {
            return Err("the film has no picture".to_owned());
        }
        let Recording { name, rate, size, frames } = recording;
        self.write(&super::files::png_name(&name), move |path: &Path| {
            save(path, |part| write_film(part, &frames, size, rate))
        });
        Ok(())
    }
}
