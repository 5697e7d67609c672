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
    /// Whether there was no room for a picture: none after it is taken, however small it is.
    is_full: bool,
}

impl Session {
    /// Begins a film, or writes the one that was begun.
    pub(super) fn record(&mut self, film: Option<&(String, u16)>) -> Result<(), String> {
        match film {
            Some(_) if self.recording.is_some() => Err("a film is recorded already".to_owned()),
            Some((name, rate)) => {
                self.recording = Some(Recording {
                    name: name.clone(),
                    rate: *rate,
                    size: (0, 0),
                    frames: Vec::new(),
                    is_full: false,
                });
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

    /// Adds a picture to the film, if one is recorded. That a film has no room is said once: an
    /// animation may have thousands of pictures after that.
    pub(super) fn add_to_film(
        &mut self,
        rgba: &Arc<Vec<u8>>,
        size: (u32, u32),
    ) -> Result<(), String> {
        let Some(recording) = self.recording.as_mut().filter(|film| !film.is_full) else {
            return Ok(());
        };
        if recording.frames.is_empty() {
            recording.size = size;
        }
        if recording.size != size {
            let (width, height) = recording.size;
            return Err(format!("the pictures of the film have {width} x {height} pixels"));
        }
        if (recording.frames.len() + 1) * rgba.len() > MOST_BYTES {
            recording.is_full = true;
            let count = recording.frames.len();
            return Err(format!(
                "the film ends after {count} pictures, the most that fit into its 2 GiB: those that \
                 follow are only written one by one, until another film is begun"
            ));
        }
        recording.frames.push(rgba.clone());
        Ok(())
    }

    fn write_film(&mut self, recording: Recording) -> Result<(), String> {
        if recording.frames.is_empty() {
            return Err("the film has no picture".to_owned());
        }
        let Recording { name, rate, size, frames, .. } = recording;
        self.write(&super::files::png_name(&name), move |path: &Path| {
            save(path, |part| write_film(part, &frames, size, rate))
        });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::action::Action;
    use crate::device::Device;
    use crate::frame::Frame;
    use crate::session::Config;

    fn session(out: &Path) -> Session {
        Session::new(Config::scripted(out), Device::default(), || {})
    }

    fn apply(session: &mut Session, line: &str) {
        let action: Action = line.parse().expect(line);
        session.apply(&action).expect(line);
    }

    #[test]
    fn that_a_film_is_full_is_said_once() {
        let mut session = session(Path::new("out"));
        apply(&mut session, "record film 25");
        // Zeros that nobody reads take no memory, and the film shares them.
        let (rgba, size) = (Arc::new(vec![0; MOST_BYTES / 4]), (16384, 8192));
        for _ in 0..4 {
            session.add_to_film(&rgba, size).expect("there is room");
        }
        let error = session.add_to_film(&rgba, size).expect_err("there is none");
        assert!(error.starts_with("the film ends after 4 pictures"), "{error}");
        let small = Arc::new(vec![0; 4]);
        for (rgba, size) in [(&rgba, size), (&small, (1, 1))] {
            assert_eq!(session.add_to_film(rgba, size), Ok(()));
        }
        assert_eq!(session.recorded(), Some(4));
    }

    #[test]
    fn pictures_are_written_where_no_film_takes_them() {
        let name = format!("raydsl-viewer-record-{}", std::process::id());
        let out = std::env::temp_dir().join(name);
        let mut session = session(&out);
        apply(&mut session, "record film 25");
        for (name, size) in [("a", (2, 1)), ("b", (1, 2))] {
            session.frame = Some(Arc::new(Frame {
                number: session.number(),
                size,
                is_coarse: false,
                samples: 1,
                rgba: vec![9; 8],
                texture: None,
                ms: 1.0,
                age_ms: 1.0,
                error: None,
                difference: None,
            }));
            apply(&mut session, &format!("picture {name}"));
        }
        apply(&mut session, "record end");
        session.finish_files();
        let sizes = ["a.png", "b.png", "film.png"].map(|name| {
            image::image_dimensions(out.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
        });
        assert_eq!(sizes, [(2, 1), (1, 2), (2, 1)]);
        let line = "error: picture b: the pictures of the film have 2 x 1 pixels".to_owned();
        assert!(session.errors() == 1 && session.log().contains(&line), "{:#?}", session.log());
        std::fs::remove_dir_all(&out).expect("it is ours");
    }
}
