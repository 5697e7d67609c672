//! Questions about the picture, and files that are written.

use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;

use super::Session;
use crate::frame::{save, write_png};
use crate::link::Question;
use crate::paraview;

/// Returns the name of a picture, which says that it is PNG.
pub(super) fn png_name(name: &str) -> String {
    let is_png = Path::new(name).extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    if is_png { name.to_owned() } else { format!("{name}.png") }
}

impl Session {
    fn ask(&mut self, question: Question) -> Result<(), String> {
        let data = self.current.as_ref().ok_or("nothing is open")?;
        data.link.ask(question);
        self.questions += 1;
        Ok(())
    }

    pub(super) fn ask_pick(&mut self, x: u32, y: u32) -> Result<(), String> {
        let (width, height) = self.look.size;
        if x >= width || y >= height {
            return Err(format!("the picture has {width} x {height} pixels"));
        }
        let look = Arc::new(self.look.clone());
        self.ask(Question::Pick { x, y, look })
    }

    /// Asks for the kernel's text, for a file or only to be shown.
    pub(super) fn ask_wgsl(&mut self, file: Option<&str>) -> Result<(), String> {
        self.ask(Question::Wgsl(Arc::new(self.look.clone())))?;
        self.wgsl_files.push_back(file.map(str::to_owned));
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

    /// Asks how many lanes run, for a file or only to be shown.
    pub(super) fn ask_lanes(&mut self, file: Option<&str>) -> Result<(), String> {
        self.ask(Question::Lanes(Arc::new(self.look.clone())))?;
        self.lanes_files.push_back((file.map(str::to_owned), self.light));
        Ok(())
    }

    /// Asks how many lanes run, which [`lanes`](Self::lanes) returns when it is known.
    ///
    /// # Errors
    ///
    /// If nothing is open, which is in the log too.
    pub fn apply_lanes(&mut self) -> Result<(), String> {
        let end = self.ask_lanes(None);
        if let Err(message) = &end {
            self.refuse(message);
        }
        end
    }

    /// Takes the first transfer function of a file of ParaView, which is small.
    pub(super) fn load_transfer(&mut self, path: &Path) -> Result<(), String> {
        let info = self.info.as_ref().filter(|info| info.kind.is_field());
        let range = info.ok_or("only volumes and cells have a transfer function")?.range;
        let presets = raydsl_io::paraview::load(path).map_err(|e| e.to_string())?;
        let preset = presets.first().ok_or("the file has none")?;
        let knots = paraview::knots(preset, range)?;
        self.log.note(format!("transfer function {}: {} knots", preset.name, knots.len()));
        let look = crate::look::Look { knots, ..self.look.clone() };
        self.set_look(look);
        Ok(())
    }

    /// Writes the newest picture, on a thread: it takes some time.
    pub(super) fn write_picture(&mut self, name: &str) -> Result<(), String> {
        let frame = self.frame.clone().ok_or("there is no picture yet")?;
        if frame.number != self.number {
            return Err("the last change has no picture".to_owned());
        }
        if frame.is_coarse || frame.texture.is_some() {
            return Err("the picture is not sharp yet: hold still".to_owned());
        }
        let (rgba, size) = (self.with_menu(&frame), frame.size);
        let pixels = rgba.clone();
        self.write(&png_name(name), move |path| write_png(path, &pixels, size));
        // The picture is written, whether or not a film takes it.
        if let Err(message) = self.add_to_film(&rgba, size) {
            self.refuse(&format!("picture {name}: {message}"));
        }
        Ok(())
    }

    /// Writes pixels from the top, on a thread.
    pub fn write_pixels(&mut self, name: &str, rgba: Vec<u8>, size: (u32, u32)) {
        self.write(&png_name(name), move |path| write_png(path, &rgba, size));
    }

    pub(super) fn write_text(&mut self, name: &str, text: String) {
        self.write(name, move |path| save(path, |part| std::fs::write(part, text)));
    }

    pub(super) fn write(
        &mut self,
        name: &str,
        run: impl FnOnce(&Path) -> Result<(), String> + Send + 'static,
    ) {
        let (name, path) = (name.to_owned(), self.config.out.join(name));
        let wake = self.wake.clone();
        let thread = std::thread::Builder::new().name("writer".to_owned());
        let writer = thread.spawn(move || {
            let end = run(&path).map(|()| format!("wrote {name}"));
            wake();
            end
        });
        match writer {
            Ok(writer) => self.writers.push(writer),
            Err(e) => self.refuse(&format!("no thread to write a file: {e}")),
        }
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
        self.loading = None;
        self.progress = None;
        if let Some(data) = self.current.take() {
            data.end();
        }
    }

    pub(super) fn note_written(&mut self, writer: JoinHandle<Result<String, String>>) {
        match writer.join() {
            Ok(Ok(line)) => self.log.note(line),
            Ok(Err(line)) => self.refuse(&line),
            Err(_) => self.refuse("a picture was not written: the thread ended early"),
        }
    }
}
