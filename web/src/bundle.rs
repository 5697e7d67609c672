//! Builds the page: its WebAssembly, the script that loads it, and the files beside them.

use std::path::{Path, PathBuf};
use std::process::Command;

use wasm_bindgen_cli_support::Bindgen;

/// The target of pages.
const TARGET: &str = "wasm32-unknown-unknown";
/// Packets need simd128, which every browser has. Relaxed SIMD, which not all have, would give
/// other numbers.
const SIMD: &str = "target-feature=+simd128";

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
const FILES: [(&str, &str); 5] = [
    ("detail.js", include_str!("../www/detail.js")),
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
    let mut command = Command::new(&program);
    command
        .args(["build", "--profile", "web", "--lib", "-p", "raydsl-web", "--target", TARGET])
        .current_dir(workspace)
        .env("CARGO_TARGET_DIR", &target);
    add_simd(&mut command, |name| std::env::var(name).ok());
    match command.status() {
        Ok(status) if status.success() => Ok(target),
        Ok(_) => Err(BundleError::Build),
        Err(source) => Err(BundleError::NoCargo { program, source }),
    }
}

/// Adds [`SIMD`] to the compiler's flags, and keeps those of the environment: cargo takes the flags
/// of the first of these variables that is set, and those of the target only without any.
fn add_simd(command: &mut Command, variable: impl Fn(&str) -> Option<String>) {
    for (name, separator) in [("CARGO_ENCODED_RUSTFLAGS", "\x1f"), ("RUSTFLAGS", " ")] {
        if let Some(flags) = variable(name) {
            let begin = if flags.is_empty() { "" } else { separator };
            command.env(name, format!("{flags}{begin}-C{separator}{SIMD}"));
            return;
        }
    }
    // Cargo adds flags of a condition to those of the target itself, be they of
    // CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS or of a file.
    let flags = format!("target.'cfg(target_family = \"wasm\")'.rustflags=[\"-C\", \"{SIMD}\"]");
    command.args(["--config", &flags]);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the variables and the arguments that are added in an environment.
    fn added(environment: &[(&str, &str)]) -> (Vec<(String, String)>, Vec<String>) {
        let mut command = Command::new("cargo");
        add_simd(&mut command, |name| {
            let found = environment.iter().find(|(known, _)| *known == name);
            found.map(|(_, value)| (*value).to_owned())
        });
        let text = |text: &std::ffi::OsStr| text.to_string_lossy().into_owned();
        let variables = command.get_envs();
        let variables = variables.filter_map(|(name, value)| Some((text(name), text(value?))));
        (variables.collect(), command.get_args().map(text).collect())
    }

    #[test]
    fn flags_of_the_environment_are_kept() {
        let target = ("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", "-g");
        for (environment, name, flags) in [
            (
                &[("RUSTFLAGS", "-D warnings"), target][..],
                "RUSTFLAGS",
                "-D warnings -C target-feature=+simd128",
            ),
            (&[("RUSTFLAGS", "")], "RUSTFLAGS", "-C target-feature=+simd128"),
            (
                &[("RUSTFLAGS", "-g"), ("CARGO_ENCODED_RUSTFLAGS", "--cfg\x1fa b")],
                "CARGO_ENCODED_RUSTFLAGS",
                "--cfg\x1fa b\x1f-C\x1ftarget-feature=+simd128",
            ),
            (
                &[("CARGO_ENCODED_RUSTFLAGS", "")],
                "CARGO_ENCODED_RUSTFLAGS",
                "-C\x1ftarget-feature=+simd128",
            ),
        ] {
            let expected = vec![(name.to_owned(), flags.to_owned())];
            assert_eq!(added(environment), (expected, Vec::new()), "{environment:?}");
        }
        for environment in [&[][..], &[target]] {
            let (variables, arguments) = added(environment);
            assert_eq!(variables, [], "the flags of the target are replaced");
            assert_eq!(arguments.len(), 2, "{arguments:?}");
            assert!(
                arguments[1].ends_with(r#"["-C", "target-feature=+simd128"]"#),
                "{arguments:?}"
            );
        }
    }
}
