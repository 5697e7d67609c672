//! Measures what this machine's driver makes of WGSL's arithmetic.
//!
//! `cargo run --release -p raydsl-tests --bin probe [-- --json FILE]`
//!
//! Two tables: the error of each builtin beside what WGSL asks for (gpuweb, "Floating Point
//! Evaluation"), and what the driver's compiler makes of expressions that it may rewrite: as wgpu
//! translates them, and as SPIR-V whose operations are decorated with `NoContraction`, as strict
//! kernels are where the device takes that. Texts are written by hand: the library only runs them.

mod builtins;
mod device;
mod rewrites;
mod sampler;

use std::process::ExitCode;

use device::{Device, Error};

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => {
            eprintln!("probe: a builtin is less accurate than WGSL asks for");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("probe: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Prints all tables and returns whether every bound holds.
fn run() -> Result<bool, Error> {
    let json = json_path()?;
    let device = Device::open()?;
    device.print_limits();
    let builtins = builtins::measure(&device)?;
    builtins::print(&builtins);
    let rewrites = rewrites::measure(&device)?;
    rewrites::print(&rewrites);
    let filters = sampler::measure(&device)?;
    sampler::print(&filters);
    if let Some(path) = json {
        let report = serde_json::json!({
            "adapter": device.name(),
            "builtins": builtins,
            "rewrites": rewrites,
            "filters": filters,
        });
        std::fs::write(&path, serde_json::to_vec_pretty(&report)?)?;
    }
    Ok(builtins.iter().all(|row| row.holds != Some(false)))
}

/// Returns the FILE of `--json FILE`.
fn json_path() -> Result<Option<String>, Error> {
    let mut args = std::env::args().skip(1);
    match (args.next().as_deref(), args.next(), args.next()) {
        (None, ..) => Ok(None),
        (Some("--json"), Some(file), None) => Ok(Some(file)),
        _ => Err("usage: probe [--json FILE]".into()),
    }
}
