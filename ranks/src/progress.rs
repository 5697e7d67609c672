//! How far a run is: events of the root, and the bar that shows them.

use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use serde::{Deserialize, Serialize};

/// What the root of a run tells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Event {
    /// The completed share, from 0 to 1.
    Done(f64),
    /// A line for people.
    Line(String),
}

/// Shows events: as a bar on a terminal, else as a line now and then.
pub(crate) struct Shown {
    bar: ProgressBar,
    is_terminal: bool,
    last: Option<Instant>,
}

/// Steps of the bar.
const STEPS: u64 = 1000;
/// The time between lines where there is no terminal.
const PAUSE: Duration = Duration::from_secs(5);

impl Shown {
    pub(crate) fn new() -> Self {
        let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {elapsed}, {eta} left");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::new(STEPS).with_style(style);
        Self { bar, is_terminal: std::io::stderr().is_terminal(), last: None }
    }

    pub(crate) fn show(&mut self, event: &Event) {
        match event {
            Event::Line(line) => self.bar.suspend(|| {
                // Whoever closed it does not want to know.
                let _ = writeln!(std::io::stdout(), "{line}");
            }),
            Event::Done(share) if self.is_terminal => {
                self.bar.set_position((share * STEPS as f64) as u64);
            }
            Event::Done(share) => {
                if self.last.is_none_or(|last| last.elapsed() >= PAUSE) {
                    self.last = Some(Instant::now());
                    eprintln!("{:3.0} %", 100.0 * share);
                }
            }
        }
    }

    pub(crate) fn end(self) {
        self.bar.finish_and_clear();
    }
}

/// Tells events: to the process that started the ranks, or to people.
pub(crate) struct Teller {
    shown: Option<Shown>,
}

impl Teller {
    pub(crate) fn new(events: bool) -> Self {
        Self { shown: (!events).then(Shown::new) }
    }

    pub(crate) fn tell(&mut self, event: &Event) {
        if let Some(shown) = &mut self.shown {
            return shown.show(event);
        }
        if let Ok(line) = serde_json::to_string(event) {
            let mut out = std::io::stdout().lock();
            let _ = writeln!(out, "{line}").and_then(|()| out.flush());
        }
    }

    pub(crate) fn line(&mut self, line: impl Into<String>) {
        self.tell(&Event::Line(line.into()));
    }

    pub(crate) fn end(self) {
        if let Some(shown) = self.shown {
            shown.end();
        }
    }
}
