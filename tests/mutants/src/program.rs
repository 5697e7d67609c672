//! Test programs of the copy, run with one mutant active.

use std::collections::BTreeMap;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::folder::Folder;

/// How test programs are started.
pub(crate) struct Runner {
    folder: PathBuf,
    programs: BTreeMap<String, PathBuf>,
    /// Words before each program.
    before: Vec<String>,
}

/// What became of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    Passed,
    Failed,
    /// It ran longer than its limit.
    Late,
    /// It ended without a result, as by a signal.
    Crashed,
}

pub(crate) struct Outcome {
    pub(crate) end: End,
    /// The tests that failed.
    pub(crate) failed: Vec<String>,
    /// As the test program says.
    pub(crate) seconds: f64,
}

impl Runner {
    pub(crate) fn new(folder: &Folder, before: &[String]) -> Self {
        let programs = folder.read("programs.json").expect("run `build` first");
        Self { folder: folder.copy(), programs, before: before.to_vec() }
    }

    pub(crate) fn programs(&self) -> impl Iterator<Item = &str> {
        self.programs.keys().map(String::as_str)
    }

    /// A program starts where cargo would start it. Memory is limited: a loop that never ends may fill it.
    fn command(&self, program: &str, limit: f64) -> Command {
        let package = if program == "raydsl" { "raydsl" } else { "tests" };
        let mut words = self.before.clone();
        words.extend(["sh", "-c", "ulimit -v 16777216; exec \"$@\"", "sh"].map(str::to_owned));
        words.extend(["timeout".to_owned(), "--signal=KILL".to_owned(), format!("{limit:.0}")]);
        let mut command = Command::new(&words[0]);
        command.args(&words[1..]).arg(&self.programs[program]);
        command.current_dir(self.folder.join(package)).env_remove("RAYDSL_MUTANT");
        command.env("CARGO_MANIFEST_DIR", self.folder.join(package)).env("RUST_BACKTRACE", "0");
        command
    }

    /// Returns the names of a program's tests.
    pub(crate) fn tests(&self, program: &str) -> Vec<String> {
        let out = self.command(program, 60.0).args(["--list", "--format", "terse"]).output();
        let out = out.unwrap_or_else(|e| panic!("{program}: {e}"));
        let text = String::from_utf8_lossy(&out.stdout);
        text.lines().filter_map(|l| l.strip_suffix(": test")).map(str::to_owned).collect()
    }

    /// Runs tests of one program, within so many seconds.
    pub(crate) fn run(&self, program: &str, tests: &[&str], mutant: &str, limit: f64) -> Outcome {
        let mut command = self.command(program, limit);
        command.args(["--exact", "--test-threads", "1"]).args(tests).env("RAYDSL_MUTANT", mutant);
        let out = command.output().unwrap_or_else(|e| panic!("{program}: {e}"));
        let text = String::from_utf8_lossy(&out.stdout);
        let failed =
            |l: &str| Some(l.strip_prefix("test ")?.strip_suffix(" ... FAILED")?.to_owned());
        let end = match out.status.code() {
            Some(0) => End::Passed,
            Some(101) => End::Failed,
            // `timeout` is killed by the signal that it sends.
            Some(124 | 137) => End::Late,
            None if out.status.signal() == Some(9) => End::Late,
            _ => End::Crashed,
        };
        let seconds =
            text.rsplit("finished in ").next().and_then(|t| t.split('s').next()?.parse().ok());
        Outcome {
            end,
            failed: text.lines().filter_map(failed).collect(),
            seconds: seconds.unwrap_or(limit),
        }
    }
}

/// Runs `work` on each item, so many at a time.
pub(crate) fn in_parallel<T: Sync>(items: &[T], jobs: usize, work: impl Fn(&T) + Sync) {
    let next = std::sync::atomic::AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                while let Some(item) =
                    items.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed))
                {
                    work(item);
                }
            });
        }
    });
}

/// Returns the numbers in a file of the switch.
pub(crate) fn numbers(path: &Path) -> Vec<usize> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let mut numbers: Vec<usize> = text.lines().filter_map(|l| l.parse().ok()).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}
