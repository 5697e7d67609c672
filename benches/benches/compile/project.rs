//! A user's package in a folder of its own, and what cargo and rustc make of it.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

use super::rustc::{self, Times};

/// The profile of `cargo build --release`, and the one that the book has for an edit loop.
const MANIFEST: &str = r#"[package]
name = "user"
version = "0.1.0"
edition = "2024"
publish = false

[workspace]

[dependencies]
raydsl = { path = RAYDSL }

[profile.edit]
inherits = "release"
incremental = true
lto = "off"
"#;

/// Compiled first, with all that the programs depend on.
const FIRST: &str = "dependencies";

/// A profile of cargo's, and what is asked of it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Profile {
    Check,
    Release,
    Edit,
}

impl Profile {
    /// The profile's name, and that of its folder.
    fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Check => ("dev", "debug"),
            Self::Release => ("release", "release"),
            Self::Edit => ("edit", "edit"),
        }
    }
}

/// What cargo is asked to do.
#[derive(Clone, Copy)]
pub(crate) struct Order<'a> {
    /// The program; a crate of one file.
    pub(crate) name: &'a str,
    /// Its text.
    pub(crate) source: &'a str,
    /// How it is compiled.
    pub(crate) profile: Profile,
    /// Options of rustc for this crate alone, with blanks between them.
    pub(crate) options: &'a str,
    /// The value of `RAYDSL_VARIANTS`, if it is set.
    pub(crate) variants: Option<&'a str>,
}

/// The package. Its folder is removed when it is dropped, unless it shall be kept.
pub(crate) struct Project {
    folder: PathBuf,
    is_kept: bool,
    /// Whether rustc's instructions are counted, of the programs.
    counts: bool,
    /// Those whose dependencies are there.
    ready: Vec<Profile>,
}

impl Project {
    /// A package that depends on the `raydsl` in the workspace `library`, and on the same versions
    /// of all else.
    pub(crate) fn new(library: &Path, is_kept: bool, counts: bool) -> Result<Self, String> {
        let at = |path: &Path, error: io::Error| format!("{}: {error}", path.display());
        let package = library.join("raydsl");
        let package = package.canonicalize().map_err(|error| at(&package, error))?;
        let folder = env::temp_dir().join(format!("raydsl-compile-{}", std::process::id()));
        // Fails if it is there: it would be somebody else's.
        fs::create_dir(&folder).map_err(|error| at(&folder, error))?;
        let project = Self { folder, is_kept, counts, ready: Vec::new() };
        let folder = &project.folder;
        let programs = folder.join("src/bin");
        fs::create_dir_all(&programs).map_err(|error| at(&programs, error))?;
        // As TOML, a string in Rust's own quotes is what it is in Rust.
        let manifest = MANIFEST.replace("RAYDSL", &format!("{:?}", package.to_string_lossy()));
        let path = folder.join("Cargo.toml");
        fs::write(&path, manifest).map_err(|error| at(&path, error))?;
        let lock = library.join("Cargo.lock");
        fs::copy(&lock, folder.join("Cargo.lock")).map_err(|error| at(&lock, error))?;
        Ok(project)
    }

    /// The folder.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Compiles what the programs depend on, if that is not done yet: the times of all of it.
    pub(crate) fn prepare(&mut self, profile: Profile) -> Result<Option<Times>, String> {
        if self.ready.contains(&profile) {
            return Ok(None);
        }
        let source = "use raydsl as _;\n\nfn main() {}\n";
        let order = Order { name: FIRST, source, profile, options: "", variants: None };
        let crates = self.run(order)?;
        self.ready.push(profile);
        let of_others = crates.iter().filter(|(name, _)| name != FIRST).map(|(_, times)| times);
        let sum = |sum: Times, t: &Times| Times {
            cpu: sum.cpu.zip(t.cpu).map(|(a, b)| a + b),
            wall: sum.wall + t.wall,
            instructions: None,
        };
        let cpu = rustc::HAS_CPU_TIME.then_some(0.0);
        let nothing = Times { cpu, wall: 0.0, instructions: None };
        Ok(Some(of_others.fold(nothing, sum)))
    }

    /// Compiles a program, whose dependencies are there: the times of this crate alone.
    pub(crate) fn build(&self, order: Order<'_>) -> Result<Times, String> {
        let crates = self.run(order)?;
        let own = crates.into_iter().find(|(name, _)| name == order.name);
        own.map(|(_, times)| times).ok_or_else(|| format!("cargo did not compile {}", order.name))
    }

    /// Forgets what rustc has kept for the next build.
    pub(crate) fn forget(&self, profile: Profile) -> Result<(), String> {
        let folder = self.output(profile).join("incremental");
        match fs::remove_dir_all(&folder) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(format!("{}: {error}", folder.display()))
            }
            _ => Ok(()),
        }
    }

    /// The bytes of a program that was built.
    pub(crate) fn executable(&self, name: &str, profile: Profile) -> Result<Vec<u8>, String> {
        let path = self.output(profile).join(name).with_extension(env::consts::EXE_EXTENSION);
        fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))
    }

    fn output(&self, profile: Profile) -> PathBuf {
        self.folder.join("target").join(profile.names().1)
    }

    /// Runs cargo: the crates that rustc compiled.
    fn run(&self, order: Order<'_>) -> Result<Vec<(String, Times)>, String> {
        let Order { name, source, profile, options, variants } = order;
        let notes = self.folder.join("notes");
        let path = self.folder.join("src/bin").join(name).with_extension("rs");
        // Written anew, so that cargo compiles it, whether it is another one or not.
        let written = fs::write(&notes, "").and_then(|()| fs::write(path, source));
        written.map_err(|error| format!("{}: {error}", self.folder.display()))?;

        let mut cargo = cargo();
        cargo.current_dir(&self.folder).env("CARGO_TARGET_DIR", self.folder.join("target"));
        let itself = env::current_exe().map_err(|error| format!("this program: {error}"))?;
        cargo.env("RUSTC_WRAPPER", itself).env(rustc::NOTES, &notes);
        if self.counts && name != FIRST {
            cargo.env(rustc::COUNTED, name);
        }
        if let Some(variants) = variants {
            cargo.env("RAYDSL_VARIANTS", variants);
        }
        cargo.arg(if profile == Profile::Check { "check" } else { "rustc" });
        cargo.args(["--offline", "--profile", profile.names().0, "--bin", name]);
        if !options.is_empty() {
            cargo.arg("--").args(options.split(' '));
        }
        let output = cargo.output().map_err(|error| format!("cargo: {error}"))?;
        if !output.status.success() {
            let text = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{name} does not compile\n{}", text.trim_end()));
        }
        let mut crates = rustc::read(&notes)?;
        // Cargo asks rustc what it is.
        crates.retain(|(name, _)| name != "___");
        Ok(crates)
    }
}

impl Drop for Project {
    fn drop(&mut self) {
        if self.is_kept {
            println!("kept: {}", self.folder.display());
        } else if let Err(error) = fs::remove_dir_all(&self.folder) {
            eprintln!("{}: {error}", self.folder.display());
        }
    }
}

/// Cargo, without what the surroundings say of how crates are compiled.
fn cargo() -> Command {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or("cargo".into()));
    let is_setting = |name: &OsStr| {
        let name = name.to_string_lossy();
        let names = ["RUSTFLAGS", "RUSTC_WORKSPACE_WRAPPER", "RAYDSL_VARIANTS"];
        let of_cargo = ["CARGO_INCREMENTAL", "CARGO_ENCODED_RUSTFLAGS"];
        let of_parts = ["CARGO_PROFILE_", "CARGO_BUILD_", "CARGO_TARGET_"];
        let is_number = name == "CARGO_BUILD_JOBS";
        names.contains(&&*name)
            || of_cargo.contains(&&*name)
            || of_parts.iter().any(|part| name.starts_with(part)) && !is_number
    };
    for (name, _) in env::vars_os().filter(|(name, _)| is_setting(name)) {
        cargo.env_remove(name);
    }
    cargo
}
