//! Ranks on one machine, started by `mpirun`.

use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Read};
use std::num::NonZeroU32;
use std::process::{Command, ExitStatus, Stdio};

use super::args::Args;
use super::films::checkpoint::FILE;
use super::progress::{Event, Shown};
use super::run::TOLD;

/// Why ranks on this machine did not finish.
#[derive(Debug, thiserror::Error)]
pub enum LaunchError {
    /// This program does not know where it is.
    #[error("the ranks cannot be started, for this program does not find itself: {0}")]
    NoProgram(io::Error),
    /// There is no `mpirun`.
    #[error(
        "mpirun cannot be started ({0}): install Open MPI (Debian: apt-get install openmpi-bin), or \
         have the cluster's launcher start the ranks, without --ranks"
    )]
    NoMpirun(io::Error),
    /// What `mpirun` prints cannot be read.
    #[error("the ranks cannot be watched: {0}")]
    Watch(io::Error),
    /// A rank has told an error.
    #[error("the run ended by the error above")]
    Told,
    /// A rank ended before the picture was there.
    #[error(
        "a rank died ({status}), and the run with it. What is finished is in {}: the same command \
         with --resume goes on from there",
        place
    )]
    Died {
        /// How `mpirun` ended.
        status: ExitStatus,
        /// Where the films or the frames so far are.
        place: String,
    },
}

/// Starts ranks over the cores of this machine, shows their progress, and waits for their end.
///
/// # Errors
///
/// If `mpirun` cannot be started, or the ranks end by an error or a death.
pub fn launch(ranks: NonZeroU32, args: &Args) -> Result<(), LaunchError> {
    let program = std::env::current_exe().map_err(LaunchError::NoProgram)?;
    let threads = args.threads.map_or_else(|| threads_of(ranks), NonZeroU32::get);
    let mut command = Command::new("mpirun");
    command
        // In containers everyone is root; more ranks than cores are fine where nothing is timed.
        .args(["--allow-run-as-root", "--oversubscribe", "--bind-to", "none"])
        // Ranks that wait leave their cores to those that render.
        .args(["--mca", "mpi_yield_when_idle", "1"])
        // Copies between processes by the kernel are forbidden in most containers.
        .args(["--mca", "btl_vader_single_copy_mechanism", "none"])
        .args(["-n", &ranks.to_string()])
        .arg(program)
        .args(["--events", "--threads", &threads.to_string()])
        .args(without_ranks(std::env::args_os().skip(1)))
        // It reaches the root, which ends where it is closed: by the death of this process, if not by
        // its end.
        .stdin(Stdio::piped())
        .stdout(Stdio::piped());
    let mut child = command.spawn().map_err(LaunchError::NoMpirun)?;
    // Waiting for the child would close it.
    let open = child.stdin.take();
    let mut shown = Shown::new();
    let watched = child.stdout.take().map_or(Ok(()), |out| watch(out, &mut shown));
    if watched.is_err() {
        // Nobody reads what the ranks print, who may wait for it.
        let _ = child.kill();
    }
    let status = child.wait().map_err(LaunchError::Watch)?;
    drop(open);
    shown.end();
    watched.map_err(LaunchError::Watch)?;
    match status.code() {
        Some(0) => Ok(()),
        Some(TOLD) => Err(LaunchError::Told),
        _ => {
            let place = args.out.join(FILE);
            let place = if place.exists() { place } else { args.out.clone() };
            Err(LaunchError::Died { status, place: place.display().to_string() })
        }
    }
}

/// Shows what ranks print, until they have ended.
fn watch(out: impl Read, shown: &mut Shown) -> io::Result<()> {
    for line in BufReader::new(out).split(b'\n') {
        // Names of files need not be UTF-8.
        let line = String::from_utf8_lossy(&line?).into_owned();
        // Whatever else is printed is for people.
        let event = serde_json::from_str(&line).unwrap_or(Event::Line(line));
        shown.show(&event);
    }
    Ok(())
}

/// Returns the threads of each rank of a machine.
fn threads_of(ranks: NonZeroU32) -> u32 {
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get() as u32);
    (cores / ranks).max(1)
}

/// Returns arguments without `--ranks N` and `--threads N`, which are the launcher's.
fn without_ranks(args: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let (mut kept, mut is_value) = (Vec::new(), false);
    for arg in args {
        let text = arg.to_string_lossy();
        let is_own = |name: &str| {
            text.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('='))
        };
        if std::mem::take(&mut is_value) {
            continue;
        }
        if is_own("--ranks") || is_own("--threads") {
            is_value = !text.contains('=');
            continue;
        }
        kept.push(arg);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_get_all_other_arguments() {
        let args = ["--ranks", "3", "--size", "9x9", "--threads=4", "--resume", "--ranks=2"];
        let kept = without_ranks(args.iter().map(OsString::from));
        assert_eq!(kept, ["--size", "9x9", "--resume"]);
    }

    #[cfg(unix)]
    #[test]
    fn names_need_not_be_utf_8() {
        use std::os::unix::ffi::OsStringExt;

        let out = OsString::from_vec(b"--out=\xff".to_vec());
        let kept = without_ranks([OsString::from("--ranks=2"), out.clone()].into_iter());
        assert_eq!(kept, [out]);
        watch(&b"a folder \xff\n{\"Done\":0.5}\n"[..], &mut Shown::new()).expect("all is read");
    }
}
