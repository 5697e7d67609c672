//! The folder of a campaign: the copy, and what has been found out so far.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(path: &Path) -> Self {
        std::fs::create_dir_all(path).expect("a folder to write to");
        Self(path.canonicalize().expect("a folder that is there"))
    }

    /// The copy of the workspace.
    pub(crate) fn copy(&self) -> PathBuf {
        self.0.join("copy")
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(crate) fn read<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        let text = std::fs::read_to_string(self.path(name)).ok()?;
        Some(serde_json::from_str(&text).unwrap_or_else(|e| panic!("{name}: {e}")))
    }

    pub(crate) fn write(&self, name: &str, value: &impl Serialize) {
        let text = serde_json::to_string_pretty(value).expect("data without maps of odd keys");
        std::fs::write(self.path(name), text).expect("a file to write to");
    }

    /// Returns the values of a file of lines.
    pub(crate) fn lines<T: DeserializeOwned>(&self, name: &str) -> Vec<T> {
        let text = std::fs::read_to_string(self.path(name)).unwrap_or_default();
        text.lines()
            .map(|l| serde_json::from_str(l).unwrap_or_else(|e| panic!("{name}: {e}")))
            .collect()
    }

    /// Adds a line: what was found out stays, even if the program is ended.
    pub(crate) fn append(&self, name: &str, value: &impl Serialize) {
        let mut file = File::options()
            .append(true)
            .create(true)
            .open(self.path(name))
            .expect("a file to write to");
        let line = serde_json::to_string(value).expect("data without maps of odd keys") + "\n";
        file.write_all(line.as_bytes()).expect("a file to write to");
    }
}
