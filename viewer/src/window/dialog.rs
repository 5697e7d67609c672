//! The system's dialog that chooses files.
//!
//! It runs beside the window, which goes on. On Linux that is the desktop's portal, or the program
//! `zenity` where there is none.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use eframe::egui;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Ask {
    /// Files: data, environments and transfer functions.
    Files,
    /// A folder of pictures.
    Folder,
}

/// A dialog, if one is open.
#[derive(Default)]
pub(crate) struct Dialog {
    answer: Option<Receiver<Vec<PathBuf>>>,
}

/// What can be opened.
const EXTENSIONS: [&str; 22] = [
    "exr", "glb", "gltf", "gz", "hdr", "json", "las", "laz", "mha", "mhd", "nhdr", "nii", "nrrd",
    "obj", "ply", "raw", "tri", "vti", "vtu", "xyz", "LAS", "LAZ",
];

impl Dialog {
    pub(crate) fn is_open(&self) -> bool {
        self.answer.is_some()
    }

    /// Opens a dialog, unless one is open.
    pub(crate) fn open(&mut self, ask: Ask, ctx: &egui::Context) {
        if self.is_open() {
            return;
        }
        let (sender, answer) = channel();
        self.answer = Some(answer);
        let dialog = rfd::AsyncFileDialog::new()
            .set_title("Open")
            .add_filter("data, environments and transfer functions", &EXTENSIONS)
            .add_filter("all files", &["*"]);
        // Made here, as some systems ask for the main thread; waited for elsewhere.
        let (files, folder) = match ask {
            Ask::Files => (Some(dialog.pick_files()), None),
            Ask::Folder => (None, Some(dialog.pick_folder())),
        };
        let ctx = ctx.clone();
        std::thread::spawn(move || {
            let files = files.and_then(pollster::block_on).unwrap_or_default();
            let folder = folder.and_then(pollster::block_on);
            let chosen = files.into_iter().chain(folder).map(|file| file.path().to_owned());
            // A window that is gone needs no answer.
            let _ = sender.send(chosen.collect());
            ctx.request_repaint();
        });
    }

    /// Takes the answer, once: what was chosen, or nothing.
    pub(crate) fn take(&mut self) -> Option<Vec<PathBuf>> {
        match self.answer.as_ref()?.try_recv() {
            Ok(chosen) => {
                self.answer = None;
                Some(chosen)
            }
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                self.answer = None;
                Some(Vec::new())
            }
        }
    }
}
