//! Opens files in a window, or plays a script without one.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use raydsl_viewer::{Action, Config, Device, Player, Session};

/// Explore points, surfaces and volumes.
#[derive(Debug, Parser)]
#[command(about)]
struct Args {
    /// Files: the first is opened, the others are time steps. Without one there is a landscape.
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Play the actions of this file without a window.
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Folder of pictures, and of the script's log.txt.
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(code) => code,
        Err(e) => {
            eprintln!("raydsl-viewer: {e}");
            ExitCode::from(2)
        }
    }
}

/// What is shown without a file.
const LANDSCAPE: &str = "landscape:2000000";

fn run(args: &Args) -> Result<ExitCode, String> {
    let mut actions: Vec<Action> = Vec::new();
    let mut files = args.files.iter().cloned();
    actions.extend(files.next().map(Action::Open));
    actions.extend(files.map(Action::Add));
    let Some(script) = &args.script else { return Err("no window yet".to_owned()) };
    let mut player = Player::open(script)?;
    let mut session = Session::new(Config::scripted(&args.out), Device::default(), || {});
    for action in &actions {
        let _ = session.apply(action);
    }
    player.play(&mut session);
    write_log(args, &session)?;
    Ok(if session.errors() == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn write_log(args: &Args, session: &Session) -> Result<(), String> {
    let path = args.out.join("log.txt");
    let text: String = session.log().iter().map(|line| format!("{line}\n")).collect();
    print!("{text}");
    std::fs::create_dir_all(&args.out)
        .and_then(|()| std::fs::write(&path, text))
        .map_err(|e| format!("cannot write {}: {e}", path.display()))
}
