//! What checks find.

use core::fmt;

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fault {
    pub(super) what: &'static str,
    place: String,
    /// How often it was found.
    count: usize,
}

#[derive(Default)]
pub(super) struct Findings {
    pub(super) faults: Vec<Fault>,
}

impl Findings {
    /// Adds a fault: the first place of each is kept.
    pub(super) fn add(&mut self, what: &'static str, place: String) {
        match self.faults.iter_mut().find(|f| f.what == what) {
            Some(fault) => fault.count += 1,
            None => self.faults.push(Fault { what, place, count: 1 }),
        }
    }
}

/// Writes what is wrong, and where.
pub(super) fn write_faults(f: &mut fmt::Formatter<'_>, faults: &[Fault]) -> fmt::Result {
    for Fault { what, place, count } in faults {
        let times = if *count > 1 { format!(" ({count} times)") } else { String::new() };
        writeln!(f, "* {what}{times}\n  {place}")?;
    }
    Ok(())
}
