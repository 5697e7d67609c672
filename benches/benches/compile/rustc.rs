//! What stands between cargo and rustc: it runs rustc, and notes how long that took.

use std::ffi::{OsStr, OsString};
use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, ExitCode, ExitStatus};
use std::time::Instant;

/// Names the file for the notes. Where it is set, this program is a wrapper of rustc.
pub(crate) const NOTES: &str = "RAYDSL_BENCH_RUSTC_NOTES";

/// Names the crate whose instructions of rustc are counted instead.
pub(crate) const COUNTED: &str = "RAYDSL_BENCH_RUSTC_COUNTED";

/// The program that counts them.
pub(crate) const VALGRIND: &str = "valgrind";

/// Whether this system says how long other processes were running.
pub(crate) const HAS_CPU_TIME: bool = cfg!(unix);

/// How long it took to compile a crate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Times {
    /// Seconds that rustc and its linker were running, as user and as system.
    pub(crate) cpu: Option<f64>,
    /// Seconds of the day.
    pub(crate) wall: f64,
    /// Thousand millions of instructions of rustc, where they are counted: without its linker.
    pub(crate) instructions: Option<f64>,
}

/// Runs rustc, whose path and arguments are those of this program, and appends a line to the
/// notes. Ends as rustc ended.
pub(crate) fn run(notes: &Path) -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().skip(1).collect();
    match run_noted(notes, &arguments) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("{}: {error}", notes.display());
            ExitCode::FAILURE
        }
    }
}

fn run_noted(notes: &Path, arguments: &[OsString]) -> io::Result<ExitCode> {
    let (rustc, rest) = arguments.split_first().ok_or(io::ErrorKind::InvalidInput)?;
    let name = rest.iter().skip_while(|word| *word != "--crate-name").nth(1);
    let is_counted = name.is_some() && std::env::var_os(COUNTED).as_ref() == name;
    let start = Instant::now();
    let (status, instructions) = if is_counted {
        counted(rustc, rest, &notes.with_extension("valgrind"))?
    } else {
        (Command::new(rustc).args(rest).status()?, None)
    };
    let wall = start.elapsed().as_secs_f64();
    if let Some(name) = name {
        let cpu = cpu_of_children()?.map_or("-".to_owned(), |seconds| seconds.to_string());
        // In one piece: several may write at once.
        let instructions = instructions.map_or("-".to_owned(), |n: f64| n.to_string());
        let line = format!("{} {cpu} {wall} {instructions}\n", name.to_string_lossy());
        OpenOptions::new().create(true).append(true).open(notes)?.write_all(line.as_bytes())?;
    }
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}

/// Runs rustc in cachegrind, which simulates no caches: how it ended, and its instructions.
fn counted(
    rustc: &OsStr,
    arguments: &[OsString],
    log: &Path,
) -> io::Result<(ExitStatus, Option<f64>)> {
    // What cargo calls may be rustup's, which starts another one.
    let sysroot = Command::new(rustc).args(["--print", "sysroot"]).output()?.stdout;
    let own = Path::new(String::from_utf8_lossy(&sysroot).trim()).join("bin/rustc");
    let mut valgrind = Command::new(VALGRIND);
    valgrind.args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]);
    let mut to_log = OsString::from("--log-file=");
    to_log.push(log);
    let status = valgrind.arg(to_log).arg(own).args(arguments).status()?;
    let text = std::fs::read_to_string(log)?;
    let line = text.lines().find_map(|line| line.split_once("refs:"));
    let number = line.and_then(|(_, number)| number.trim().replace(',', "").parse::<f64>().ok());
    Ok((status, number.map(|number| 1e-9 * number)))
}

/// What processes were running that this one has waited for, and those that they waited for.
#[cfg(unix)]
fn cpu_of_children() -> io::Result<Option<f64>> {
    use nix::sys::resource::{UsageWho, getrusage};
    use nix::sys::time::TimeVal;

    let usage = getrusage(UsageWho::RUSAGE_CHILDREN)?;
    let seconds = |time: TimeVal| time.tv_sec() as f64 + 1e-6 * time.tv_usec() as f64;
    Ok(Some(seconds(usage.user_time()) + seconds(usage.system_time())))
}

#[cfg(not(unix))]
fn cpu_of_children() -> io::Result<Option<f64>> {
    Ok(None)
}

/// The crates of the notes, and their times.
pub(crate) fn read(notes: &Path) -> Result<Vec<(String, Times)>, String> {
    let text = std::fs::read_to_string(notes);
    let text =
        text.map_err(|error| format!("rustc left no notes: {}: {error}", notes.display()))?;
    let line = |line: &str| {
        let mut words = line.split(' ');
        let (name, cpu, wall) = (words.next()?, words.next()?, words.next()?);
        let cpu = if HAS_CPU_TIME { Some(cpu.parse().ok()?) } else { None };
        let instructions = words.next()?.parse().ok();
        Some((name.to_owned(), Times { cpu, wall: wall.parse().ok()?, instructions }))
    };
    let read = |l| line(l).ok_or_else(|| format!("these are no times of rustc: {l}"));
    text.lines().map(read).collect()
}
