//! Which batches of a long run are done, so that it can be taken up again.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::Path;

use super::batch::Report;

/// A file with a line for each batch of which no kernel failed: its first seed, how many kernels it
/// had, for how many WGSL was compared, and for how many inputs.
///
/// A batch with failures has no line: it runs again, and fails again.
#[derive(Debug)]
pub struct Progress {
    done: HashMap<(u64, usize), [usize; 2]>,
    file: File,
}

impl Progress {
    /// Goes on with what the file at `path` says, or begins anew.
    ///
    /// # Panics
    ///
    /// If the file cannot be written.
    pub fn open(path: &Path, resume: bool) -> Self {
        let old = if resume { fs::read_to_string(path).unwrap_or_default() } else { String::new() };
        let done = old.lines().filter_map(line).collect();
        let mut options = OpenOptions::new();
        options.create(true).write(true).append(resume).truncate(!resume);
        let file = options.open(path).expect("a file of the target folder can be written");
        Self { done, file }
    }

    /// What came of the batch, if it is done.
    pub fn find(&self, first: u64, count: usize) -> Option<Report> {
        let [on_wgsl, wgsl_inputs] = *self.done.get(&(first, count))?;
        Some(Report { kernels: count, on_wgsl, wgsl_inputs, failures: vec![] })
    }

    /// Notes a batch.
    ///
    /// # Panics
    ///
    /// If the file cannot be written.
    pub fn note(&mut self, first: u64, report: &Report) {
        if report.failures.is_empty() {
            let Report { kernels, on_wgsl, wgsl_inputs, .. } = report;
            writeln!(self.file, "{first} {kernels} {on_wgsl} {wgsl_inputs}")
                .expect("a file of the target folder can be written");
        }
    }
}

/// A line that was written to its end.
fn line(text: &str) -> Option<((u64, usize), [usize; 2])> {
    let mut words = text.split(' ');
    let first = words.next()?.parse().ok()?;
    let mut next = || words.next()?.parse::<usize>().ok();
    Some(((first, next()?), [next()?, next()?]))
}
