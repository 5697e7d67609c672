//! Opens files in a window, or plays a script without one.

mod window;

use std::path::{Path, PathBuf};
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
    /// Folder of pictures, and of log.txt.
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Size of pictures without a window.
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

/// Returns the number of errors in the log.
fn run(args: &Args) -> Result<usize, String> {
    let player = args.script.as_deref().map(Player::open).transpose()?;
    let mut files = args.files.iter().cloned();
    let first = files.next().or_else(|| player.is_none().then(|| LANDSCAPE.into()));
    let mut actions: Vec<Action> = first.map(Action::Open).into_iter().collect();
    actions.extend(files.map(Action::Add));
    match player {
        Some(mut player) if !args.window => {
            let mut session = Session::new(Config::scripted(&args.out), Device::default(), || {});
            actions.insert(0, Action::Size(args.size.0, args.size.1));
            for action in &actions {
                // A refusal is in the log.
                let _ = session.apply(action);
            }
            player.play(&mut session);
            session.close();
            write_log(&args.out, session.log())?;
            Ok(session.errors())
        }
        player => {
            let out = args.out.clone();
            let end = window::run(window::Options { actions, player, out })?;
            let mut log = end.log;
            log.push(format!("longest turn {:.1} ms", end.longest.as_secs_f64() * 1e3));
            write_log(&args.out, &log)?;
            Ok(end.errors)
        }
    }
}

fn write_log(out: &Path, log: &[String]) -> Result<(), String> {
    let path = out.join("log.txt");
    let text: String = log.iter().map(|line| format!("{line}\n")).collect();
    print!("{text}");
    std::fs::create_dir_all(out)
        .and_then(|()| std::fs::write(&path, text))
        .map_err(|e| format!("cannot write {}: {e}; choose another --out", path.display()))
}
