//! Opens files in a window, or plays a script without one.

mod window;

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use raydsl_examples::args::size;
use raydsl_viewer::{Action, Config, Device, Player, Session};

/// Explore points, surfaces and volumes.
#[derive(Debug, Parser)]
#[command(about)]
struct Args {
    /// Files: the first is opened, the others are time steps. Without one there is a landscape of 2
    /// million points; `landscape:POINTS` and `head:SIDE` are made in code too.
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Play the actions of this file without a window, and end.
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Play the script in a window.
    #[arg(long, requires = "script")]
    window: bool,
    /// Folder of pictures, and of log.txt, which has the lines of the last run.
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Size of a script's pictures, until it sets another.
    #[arg(long, value_name = "WxH", default_value = "960x540", value_parser = size)]
    size: (u32, u32),
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(e) => {
            eprintln!("raydsl-viewer: {e}");
            ExitCode::from(2)
        }
    }
}

/// What is shown without a file.
const LANDSCAPE: &str = "landscape:2000000";

/// What helps if the log cannot be written.
const OTHER: &str = "choose another --out";

/// Returns the number of errors in the log.
fn run(args: &Args) -> Result<usize, String> {
    let player = args.script.as_deref().map(Player::open).transpose()?;
    let mut files = args.files.iter().cloned();
    let first = files.next().or_else(|| player.is_none().then(|| LANDSCAPE.into()));
    let mut actions: Vec<Action> = first.map(Action::Open).into_iter().collect();
    actions.extend(files.map(Action::Add));
    if player.is_some() {
        actions.insert(0, Action::Size(args.size.0, args.size.1));
    }
    match player {
        Some(mut player) if !args.window => {
            let mut session = Session::new(Config::scripted(&args.out), Device::default(), || {});
            session.keep_log(&args.out.join("log.txt")).map_err(|e| format!("{e}: {OTHER}"))?;
            for action in &actions {
                // A refusal is in the log.
                let _ = session.apply(action);
            }
            player.play(&mut session);
            session.close();
            print(session.log());
            Ok(session.errors())
        }
        player => {
            let out = args.out.clone();
            let end = window::run(window::Options { actions, player, out })?;
            print(&end.log);
            Ok(end.errors)
        }
    }
}

/// Prints what was done; errors are on the terminal already.
fn print(log: &[String]) {
    let mut out = std::io::stdout().lock();
    for line in log.iter().filter(|line| !line.starts_with("error: ")) {
        // Whoever closed it does not want to know.
        let _ = writeln!(out, "{line}");
    }
}
