//! Builds the page: its WebAssembly, the script that loads it, and the files beside them.

use std::path::{Path, PathBuf};
use std::process::Command;

use wasm_bindgen_cli_support::Bindgen;

/// The target of pages.
const TARGET: &str = "wasm32-unknown-unknown";
/// Packets need simd128, which every browser has. Relaxed SIMD, which not all have, would give
/// other numbers.
const FLAGS: &str = "-C target-feature=+simd128";

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BundleError {
    /// Cargo cannot be started.
    #[error("cannot start {program}: {source}")]
    NoCargo {
        /// The program.
        program: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// Cargo has written why.
    #[error("cargo did not build for {TARGET}: if it is missing, `rustup target add {TARGET}`")]
    Build,
    /// What cargo built cannot be bound.
    #[error("cannot bind {path}: {reason}")]
    Bind {
        /// The WebAssembly.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// A file cannot be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
}

/// The files of the page beside its WebAssembly.
const FILES: [(&str, &str); 4] = [
    ("index.html", include_str!("../www/index.html")),
    ("page.css", include_str!("../www/page.css")),
    ("page.js", include_str!("../www/page.js")),
    ("worker.js", include_str!("../www/worker.js")),
];

/// Builds the page and returns its folder, in cargo's target folder.
///
/// # Errors
///
/// If it cannot be built or written.
pub fn bundle() -> Result<PathBuf, BundleError> {
    let target = compile()?;
    let wasm = target.join(TARGET).join("web/raydsl_web.wasm");
    let folder = target.join("page");
    let mut bindgen = Bindgen::new();
    bindgen.input_path(&wasm).typescript(false).remove_name_section(true);
    let bound = bindgen.web(true);
    let bound = bound.and_then(|bindgen| bindgen.generate(&folder));
    bound.map_err(|e| BundleError::Bind { path: wasm, reason: format!("{e:#}") })?;
    for (name, text) in FILES {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|source| BundleError::Write { path, source })?;
    }
    Ok(folder)
}

/// Compiles the page and returns cargo's target folder.
fn compile() -> Result<PathBuf, BundleError> {
    let program = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let workspace = package.parent().unwrap_or(package);
    let target = std::env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| workspace.join("target"), |folder| workspace.join(folder));
    let status = Command::new(&program)
        .args(["build", "--profile", "web", "--lib", "-p", "raydsl-web", "--target", TARGET])
        .current_dir(workspace)
        .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", FLAGS)
        .env("CARGO_TARGET_DIR", &target)
        .status();
    match status {
        Ok(status) if status.success() => Ok(target),
        Ok(_) => Err(BundleError::Build),
        Err(source) => Err(BundleError::NoCargo { program, source }),
    }
}
