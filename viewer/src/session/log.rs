//! The log: a line for everything that happened.

use std::fs::File;
use std::io::{Seek, SeekFrom, Write, stderr};
use std::path::Path;

use super::Session;
use crate::action::Action;

/// The most lines that are kept; a file has all of them.
const MOST_LINES: usize = 20_000;

/// What the lines of errors begin with.
const ERROR: &str = "error: ";

/// The lines, and the file that they go to.
#[derive(Debug, Default)]
pub(super) struct Log {
    lines: Vec<String>,
    errors: usize,
    file: Option<File>,
    /// The action of the last line, and where that begins in the file: a mouse makes many.
    last: Option<Action>,
    begin: u64,
}

impl Log {
    pub(super) fn lines(&self) -> &[String] {
        &self.lines
    }

    pub(super) fn errors(&self) -> usize {
        self.errors
    }

    /// Adds a line.
    pub(super) fn note(&mut self, line: String) {
        self.last = None;
        if self.lines.len() >= MOST_LINES {
            self.forget();
        }
        self.write(&line);
        self.lines.push(line);
    }

    /// Adds an action, which is joined with the one before where both are the same as one.
    pub(super) fn act(&mut self, action: &Action) {
        let joined = self.last.as_ref().and_then(|last| last.joined(action));
        let Some(joined) = joined else {
            self.note(action.to_string());
            self.last = Some(action.clone());
            return;
        };
        self.lines.pop();
        if let Some(file) = &mut self.file {
            // What cannot be cut off is only a line too many.
            let _ = file.set_len(self.begin).and_then(|()| file.seek(SeekFrom::End(0)));
        }
        self.write(&joined.to_string());
        self.lines.push(joined.to_string());
        self.last = Some(joined);
    }

    /// Forgets the oldest lines, but no errors.
    fn forget(&mut self) {
        let mut i = 0;
        self.lines.retain(|line| {
            i += 1;
            i > MOST_LINES / 2 || line.starts_with(ERROR)
        });
    }

    fn write(&mut self, line: &str) {
        let Some(file) = &mut self.file else { return };
        let end = file.stream_position().and_then(|begin| {
            self.begin = begin;
            writeln!(file, "{line}")
        });
        if let Err(e) = end {
            self.file = None;
            self.fail(&format!("the log is no longer written: {e}"));
        }
    }

    /// Adds an error. With a file there is a terminal too, which shows it at once.
    pub(super) fn fail(&mut self, message: &str) {
        self.errors += 1;
        let line = format!("{ERROR}{message}");
        if self.file.is_some() {
            // Whoever closed it does not want to know.
            let _ = writeln!(stderr(), "{line}");
        }
        self.note(line);
    }
}

impl Session {
    /// Writes the log to a file from now on, line by line, and errors to the terminal too.
    ///
    /// # Errors
    ///
    /// If the file cannot be made: one line.
    pub fn keep_log(&mut self, path: &Path) -> Result<(), String> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let file = std::fs::create_dir_all(folder).and_then(|()| File::create(path));
        let file = file.map_err(|e| format!("cannot write {}: {e}", path.display()))?;
        self.log.file = Some(file);
        Ok(())
    }

    /// Adds a line to the log.
    pub fn note(&mut self, line: String) {
        self.log.note(line);
    }

    /// Adds a line on something that does not work to the log.
    pub fn refuse(&mut self, message: &str) {
        self.log.fail(message);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_mouse_does_is_one_line() {
        let mut log = Log::default();
        for line in ["orbit 1 2", "orbit 3 -1", "home", "size 5 6", "size 7 8", "orbit 1 0"] {
            log.act(&line.parse().expect(line));
        }
        log.fail("no");
        log.act(&Action::Orbit(1.0, 1.0));
        let lines = ["orbit 4 1", "home", "size 7 8", "orbit 1 0", "error: no", "orbit 1 1"];
        assert_eq!(log.lines(), lines);
    }

    #[test]
    fn errors_are_never_forgotten() {
        let mut log = Log::default();
        log.fail("first");
        for i in 0..3 * MOST_LINES {
            log.note(i.to_string());
        }
        assert!(log.lines().len() <= MOST_LINES);
        assert_eq!(log.lines()[0], "error: first");
        assert_eq!(log.lines().last(), Some(&(3 * MOST_LINES - 1).to_string()));
    }
}
