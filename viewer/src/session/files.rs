//! Questions about the picture, and files that are written.

use std::thread::JoinHandle;

use super::Session;
use crate::frame::write_png;
use crate::link::Question;

impl Session {
    fn ask(&mut self, question: Question) -> Result<(), String> {
        let data = self.current.as_ref().ok_or("nothing is open")?;
        self.questions += 1;
        if self.number == 0 {
            return Err("nothing is open".to_owned());
        }
        data.link.ask(question);
        Ok(())
    }

    pub(super) fn ask_pick(&mut self, x: u32, y: u32) -> Result<(), String> {
        let (width, height) = self.look.size;
        if x >= width || y >= height {
            return Err(format!("the picture has {width} x {height} pixels"));
        }
        self.ask(Question::Pick(x, y))
    }

    /// Asks for the kernel's text, for a file or only to be shown.
    pub(super) fn ask_wgsl(&mut self, file: Option<&str>) -> Result<(), String> {
        self.ask(Question::Wgsl)?;
        self.wgsl_files.extend(file.map(str::to_owned));
        Ok(())
    }

    /// Asks for the kernel's text, which [`wgsl`](Self::wgsl) returns when it is there.
    ///
    /// # Errors
    ///
    /// If nothing is open, which is in the log too.
    pub fn apply_wgsl(&mut self) -> Result<(), String> {
        let end = self.ask_wgsl(None);
        if let Err(message) = &end {
            self.refuse(message);
        }
        end
    }

    /// Writes the newest picture, on a thread: it takes some time.
    pub(super) fn write_picture(&mut self, name: &str) -> Result<(), String> {
        let frame = self.frame.clone().ok_or("there is no picture yet")?;
        if frame.texture.is_some() {
            return Err("the picture is not sharp yet: hold still".to_owned());
        }
        let path = self.config.out.join(name);
        self.write(name, move || frame.write_png(&path));
        Ok(())
    }

    /// Writes pixels from the top, on a thread.
    pub fn write_pixels(&mut self, name: &str, rgba: Vec<u8>, size: (u32, u32)) {
        let path = self.config.out.join(name);
        self.write(name, move || write_png(&path, &rgba, size));
    }

    pub(super) fn write(
        &mut self,
        name: &str,
        run: impl FnOnce() -> Result<(), String> + Send + 'static,
    ) {
        let (name, folder) = (name.to_owned(), self.config.out.clone());
        let wake = self.wake.clone();
        self.writers.push(std::thread::spawn(move || {
            let made = std::fs::create_dir_all(&folder);
            let end = made.map_err(|e| format!("cannot make {}: {e}", folder.display()));
            let end = end.and_then(|()| run()).map(|()| format!("wrote {name}"));
            wake();
            end
        }));
    }

    /// Waits for files that are being written.
    pub fn finish_files(&mut self) {
        for writer in std::mem::take(&mut self.writers) {
            self.note_written(writer);
        }
    }

    /// Waits for files and for the end of the renderer, which takes no longer than a tile. Nothing
    /// is open then.
    pub fn close(&mut self) {
        self.finish_files();
        if let Some(data) = self.current.take() {
            data.end();
        }
    }

    pub(super) fn note_written(&mut self, writer: JoinHandle<Result<String, String>>) {
        match writer.join() {
            Ok(Ok(line)) => self.note(line),
            Ok(Err(line)) => self.refuse(&line),
            Err(_) => self.refuse("a picture was not written: the thread ended early"),
        }
    }
}
