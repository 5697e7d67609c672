//! What tests of whole runs have in common: the program, its folders, its processes.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Returns whether there is an `mpirun`. If not, a test is left out, loudly; where
/// `RAYDSL_REQUIRE_MPI` is 1 it fails.
pub(crate) fn has_mpirun() -> bool {
    let found = Command::new("mpirun").arg("--version").output().is_ok();
    if !found {
        let is_required = std::env::var("RAYDSL_REQUIRE_MPI").is_ok_and(|value| value == "1");
        assert!(!is_required, "mpirun is missing: apt-get install openmpi-bin");
        eprintln!("LEFT OUT: mpirun is missing");
    }
    found
}

/// One run at a time: their ranks would share the cores.
pub(crate) fn alone() -> MutexGuard<'static, ()> {
    static RUNS: Mutex<()> = Mutex::new(());
    RUNS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A folder of its own for each test, removed in the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let name = format!("raydsl-ranks-{name}-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("the folder for temporary files can be written");
        Self(path)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        let path = self.path(name);
        std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }

    /// Returns the figures of the run.
    pub(crate) fn report(&self) -> raydsl_ranks::report::Report {
        serde_json::from_slice(&self.read("report.json")).expect("a report")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Returns the command with these words, which writes to the folder.
pub(crate) fn command(out: &Folder, words: &str) -> Command {
    command_to(&out.path(""), words)
}

pub(crate) fn command_to(out: &Path, words: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_raydsl-ranks"));
    command.args(words.split_whitespace()).arg("--out").arg(out).stdin(Stdio::null());
    command
}

/// The longest that a run may take.
const MOST: Duration = Duration::from_secs(300);

/// Waits for the end of a run, which must come.
pub(crate) fn end_of(child: Child, what: &str) -> Output {
    let id = child.id();
    let (ended, end) = std::sync::mpsc::channel();
    std::thread::spawn(move || ended.send(child.wait_with_output()));
    match end.recv_timeout(MOST) {
        Ok(output) => output.expect("the run can be waited for"),
        Err(_) => {
            kill(id);
            panic!("{what}: the run hangs");
        }
    }
}

/// Runs the command to its end.
pub(crate) fn run(out: &Folder, words: &str) -> Output {
    let child = command(out, words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    end_of(child.expect("the program starts"), words)
}

/// Runs the command, which must succeed.
pub(crate) fn succeed(out: &Folder, words: &str) {
    let output = run(out, words);
    assert!(output.status.success(), "{words}: {}", said(&output));
}

/// Returns what a run printed.
pub(crate) fn said(output: &Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}

/// Kills a process as the kernel does that is out of memory.
pub(crate) fn kill(id: u32) {
    let killed = Command::new("kill").args(["-9", &id.to_string()]).status();
    assert!(killed.is_ok_and(|status| status.success()), "process {id} is there");
}

/// Waits until a file is there.
pub(crate) fn wait_for(path: &Path) {
    let begin = Instant::now();
    while !path.exists() {
        assert!(begin.elapsed() < MOST, "{} does not appear", path.display());
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Returns the `mpirun` of a run.
pub(crate) fn process_of_mpirun(out: &Folder) -> u32 {
    processes_of(out).into_iter().find(|id| has(*id, "cmdline", b"mpirun")).expect("it runs")
}

/// Returns the processes whose pictures are written to a folder: of ranks, `mpirun`, and the launcher.
fn processes_of(out: &Folder) -> Vec<u32> {
    let folder = out.path("");
    let processes = std::fs::read_dir("/proc").expect("Linux");
    let ids = processes.flatten().filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    ids.filter(|id: &u32| has(*id, "cmdline", folder.as_os_str().as_encoded_bytes())).collect()
}

/// Returns whether one of the texts in a file of a process is this one.
fn has(id: u32, file: &str, text: &[u8]) -> bool {
    let bytes = std::fs::read(format!("/proc/{id}/{file}")).unwrap_or_default();
    bytes.split(|byte| *byte == 0).any(|part| part == text)
}

/// Waits for the process that is a rank of the run whose pictures are written to a folder.
pub(crate) fn wait_for_rank(rank: u32, out: &Folder) -> u32 {
    let wanted = format!("OMPI_COMM_WORLD_RANK={rank}");
    let begin = Instant::now();
    loop {
        let mut ids = processes_of(out).into_iter();
        if let Some(id) = ids.find(|id| has(*id, "environ", wanted.as_bytes())) {
            return id;
        }
        assert!(begin.elapsed() < MOST, "rank {rank} does not run");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Waits until no process of a run is left, and kills those that are after `most`.
pub(crate) fn wait_for_the_end(out: &Folder, most: Duration) {
    let begin = Instant::now();
    while !processes_of(out).is_empty() {
        if begin.elapsed() > most {
            let left = processes_of(out);
            left.iter().for_each(|id| kill(*id));
            panic!("processes of the run are left: {left:?}");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}
