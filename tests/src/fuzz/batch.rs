//! Compiles generated kernels in batches, runs them, and reports those that fail.
//!
//! A batch is one program: a module for each kernel, and a `main` that calls
//! [`run::main`](super::run::main). rustc is called directly, with the libraries that cargo has
//! built for the test itself, so nothing else is compiled.

use std::collections::HashMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, MutexGuard};
use std::time::{Duration, Instant};

use super::progress::Progress;
use super::run::{DONE, END, FAILED, RUNS};
use super::tree::Kernel;
use super::{generator, print, shrink};
use crate::in_parallel;

/// How many kernels one program has.
const BATCH: usize = 75;
/// How long a program may run.
const PATIENCE: Duration = Duration::from_secs(300);
/// How many smaller kernels are tried at once, and how often.
const CUTS: usize = 60;
const ROUNDS: usize = 25;

/// Where programs are made, and with what.
#[derive(Debug)]
pub struct Workshop {
    folder: PathBuf,
    /// The arguments of rustc that name the libraries.
    libraries: Vec<String>,
}

/// What came of running kernels.
#[derive(Debug, Default)]
pub struct Report {
    /// How many kernels ran.
    pub kernels: usize,
    /// How many of them were compared with WGSL for at least one input.
    pub on_wgsl: usize,
    /// For how many inputs in all.
    pub wgsl_inputs: usize,
    /// The kernels that failed, and how.
    pub failures: Vec<(Kernel, String)>,
}

impl Workshop {
    /// Asks cargo where the libraries of the test program `test` lie, in `target_folder`.
    ///
    /// All of them are linked to from `folder`, or copied, so that a build that happens during a long run
    /// does not change them: rustc looks for what they depend on in the same folder.
    ///
    /// # Panics
    ///
    /// If cargo fails, or a file cannot be copied.
    pub fn new(folder: &Path, target_folder: &Path, test: &str) -> Self {
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
        let mut command = Command::new(cargo);
        // The features of dependencies follow from the packages that are asked for: the default members, as
        // of `cargo test` in the root, which has built all of this.
        command.args(["test", "--no-run", "--message-format", "json"]);
        command.args(["--test", test, "--target-dir"]).arg(target_folder);
        // As they are here, or all of it is built again.
        if cfg!(all(feature = "flip", feature = "counts")) {
            command.arg("--all-features");
        } else if cfg!(feature = "counts") {
            command.args(["--features", "raydsl-tests/counts,raydsl-benches/counts"]);
        }
        if !cfg!(debug_assertions) {
            command.arg("--release");
        }
        command.current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
        // Cargo hands on what the build script sets; set for cargo, it would build all again. What the
        // environment itself has stays, or all would be built again too.
        if cfg!(chooses_variants) {
            command.env_remove("RAYDSL_VARIANTS");
        }
        let output = command.output().expect("cargo can be started");
        let messages = String::from_utf8_lossy(&output.stdout);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "cargo cannot build the libraries:\n{errors}\n{messages}");

        let copies = folder.join("libraries");
        let _ = fs::remove_dir_all(&copies);
        fs::create_dir_all(&copies).expect("a folder of the target folder can be made");
        let mut libraries = vec!["-L".to_owned(), format!("dependency={}", copies.display())];
        // The paths in cargo's messages are all that is wanted of them.
        for path in messages.split('"').map(Path::new) {
            let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
            let is_rlib = name.ends_with(".rlib");
            let is_library = is_rlib || name.ends_with(std::env::consts::DLL_SUFFIX);
            let copy = copies.join(name);
            if !(is_library && name.starts_with("lib") && path.is_absolute() && path.exists())
                || copy.exists()
            {
                continue;
            }
            // Cargo and rustc write another file in place of one, and leave this one as it is.
            if fs::hard_link(path, &copy).is_err() {
                fs::copy(path, &copy).expect("a library can be copied");
            }
            let krate = name.strip_prefix("lib").and_then(|n| n.split_once('-')).map(|n| n.0);
            if let Some(krate) = krate.filter(|krate| krate.starts_with("raydsl")) {
                libraries.extend(["--extern".to_owned(), format!("{krate}={}", copy.display())]);
            }
        }
        Self { folder: folder.to_owned(), libraries }
    }

    /// Runs the kernels of `count` seeds from `first` on, on all processors.
    ///
    /// With `resume`, batches that an earlier run has found right are not run again; a run that was
    /// ended goes on. The disk holds one program for each processor.
    pub fn run_seeds(&self, first: u64, count: usize, resume: bool) -> Report {
        let all = Mutex::new(Report::default());
        let progress = Mutex::new(Progress::open(&self.folder.join("progress"), resume));
        in_parallel(count, BATCH, |part| {
            let start = first.wrapping_add(part.start as u64);
            let known = lock(&progress).find(start, part.len());
            let name = format!("batch-{}", part.start / BATCH % crate::threads());
            let seeds = part.clone().map(|i| first.wrapping_add(i as u64));
            let report = known.unwrap_or_else(|| {
                let report = self.run(&name, seeds.map(generator::kernel).collect());
                lock(&progress).note(start, &report);
                report
            });
            let mut all = lock(&all);
            all.kernels += report.kernels;
            all.on_wgsl += report.on_wgsl;
            all.wgsl_inputs += report.wgsl_inputs;
            all.failures.extend(report.failures);
            println!("{} kernels, {} failed", all.kernels, all.failures.len());
        });
        all.into_inner().unwrap_or_else(|e| e.into_inner())
    }

    /// Runs these kernels as one program, which lies in the folder `name`.
    ///
    /// # Panics
    ///
    /// If files cannot be written or programs cannot be started.
    pub fn run(&self, name: &str, mut kernels: Vec<Kernel>) -> Report {
        let folder = self.folder.join(format!("{name}-{:?}", std::thread::current().id()));
        fs::create_dir_all(&folder).expect("a folder of the target folder can be made");
        let mut report = Report { kernels: kernels.len(), ..Report::default() };
        while !kernels.is_empty() {
            while let Err(errors) = self.compile(&folder, &kernels) {
                let bad = bad_modules(&errors);
                assert!(!bad.is_empty(), "rustc fails, for none of the kernels:\n{errors}");
                let mut good = Vec::new();
                for (i, kernel) in kernels.into_iter().enumerate() {
                    match bad.get(&i) {
                        Some(error) => {
                            let error = format!("does not compile: {error}");
                            report.failures.push((kernel, error));
                        }
                        None => good.push(kernel),
                    }
                }
                kernels = good;
            }
            let Some(last) = run_program(&folder, &kernels, &mut report) else { break };
            // Those behind the kernel that ended the program have not run.
            kernels.drain(..=last);
        }
        let _ = fs::remove_dir_all(&folder);
        report
    }

    /// Writes and compiles a program, or gives the compiler's messages.
    fn compile(&self, folder: &Path, kernels: &[Kernel]) -> Result<(), String> {
        let write = |name: &str, text: &str| {
            fs::write(folder.join(name), text).expect("a file of the target folder can be written");
        };
        let (mut modules, mut cases) = (String::new(), String::new());
        for (i, kernel) in kernels.iter().enumerate() {
            write(&format!("k{i}.rs"), &print::kernel(kernel));
            modules += &format!("mod k{i};\n");
            cases += &case(i, kernel);
        }
        let main = format!(
            "use raydsl_tests::fuzz::run::{{Case, main as run}};\n\n{modules}\nfn main() {{\n    run(&[\n{cases}    ]);\n}}\n"
        );
        write("main.rs", &main);
        let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
        let output = Command::new(rustc)
            .args(["--edition", "2024", "--crate-name", "batch", "--cap-lints", "allow"])
            .args(["-C", "opt-level=0", "-C", "overflow-checks=on", "-C", "debuginfo=0"])
            .args(["-C", "codegen-units=2"])
            .args(&self.libraries)
            .arg(folder.join("main.rs"))
            .arg("-o")
            .arg(program(folder))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .expect("rustc can be started");
        if output.status.success() {
            return Ok(());
        }
        Err(String::from_utf8_lossy(&output.stderr).into_owned())
    }

    /// The smallest kernel found that fails as `kernel` does, with what its failure says.
    ///
    /// A cut counts if the same variant fails: a smaller kernel may fail for another reason.
    pub fn shrunk(&self, kernel: &Kernel, text: &str) -> (Kernel, String) {
        let mut best = (kernel.clone(), text.to_owned());
        let kind = kind(text);
        for _ in 0..ROUNDS {
            let mut cuts = shrink::cuts(&best.0);
            // Large cuts first; those that were tried in vain come again, but seldom.
            cuts.sort_by_key(|k| print::kernel(k).len());
            let mut found = false;
            for chunk in cuts.chunks(CUTS) {
                let mut failures = self.run("cuts", chunk.to_vec()).failures;
                failures.retain(|(_, text)| self::kind(text) == kind);
                failures.sort_by_key(|(k, _)| print::kernel(k).len());
                if let Some(first) = failures.into_iter().next() {
                    best = first;
                    found = true;
                    break;
                }
            }
            if !found {
                break;
            }
        }
        best
    }
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(|e| e.into_inner())
}

/// What failures are grouped by: compiling, panicking, WGSL, or any other variant.
fn kind(text: &str) -> &'static str {
    let starts = ["does not compile", "the program"];
    let words = ["on WGSL: ", "on WGSL", "the source: ", "panic"];
    let start = starts.into_iter().find(|s| text.starts_with(s));
    start.or_else(|| words.into_iter().find(|w| text.contains(w))).unwrap_or("differs")
}

/// What runs the kernel of module `i`.
fn case(i: usize, kernel: &Kernel) -> String {
    let entry = if kernel.scene.is_some() { "Entry" } else { "entry" };
    let closure = if kernel.scene.is_some_and(|s| s.closure) {
        format!(".with(k{i}::closure)")
    } else {
        String::new()
    };
    format!("        Case::of::<k{i}::{entry}>(\"k{i}\"){closure},\n")
}

fn program(folder: &Path) -> PathBuf {
    folder.join(format!("batch{}", std::env::consts::EXE_SUFFIX))
}

/// The numbers of the modules that rustc complains about, with what it says first.
fn bad_modules(errors: &str) -> HashMap<usize, String> {
    let mut bad = HashMap::new();
    for message in errors.split("\n\n") {
        if !message.starts_with("error") {
            continue;
        }
        let modules = message.match_indices(".rs:").filter_map(|(end, _)| {
            let head = &message[..end];
            let start = head.rfind(['/', '\\'])?;
            head[start + 1..].strip_prefix('k')?.parse::<usize>().ok()
        });
        for i in modules {
            bad.entry(i).or_insert_with(|| message.to_owned());
        }
    }
    bad
}

/// Runs a program and reads what it prints. Returns the kernel that ended it, if it did not run to its
/// end.
fn run_program(folder: &Path, kernels: &[Kernel], report: &mut Report) -> Option<usize> {
    let printed = folder.join("printed");
    let file = File::create(&printed).expect("a file of the target folder can be written");
    let errors = file.try_clone().expect("a file can be shared");
    let mut child = Command::new(program(folder))
        .stdin(Stdio::null())
        .stdout(file)
        .stderr(errors)
        .spawn()
        .expect("a program that rustc made can be started");
    let start = Instant::now();
    let status = loop {
        match child.try_wait().expect("a child can be waited for") {
            Some(status) => break status.to_string(),
            None if start.elapsed() > PATIENCE => {
                let _ = child.kill();
                let _ = child.wait();
                break "it takes too long".to_owned();
            }
            None => std::thread::sleep(Duration::from_millis(20)),
        }
    };
    let text = fs::read_to_string(&printed).unwrap_or_default();
    let number = |name: &str| name.strip_prefix('k').and_then(|n| n.parse::<usize>().ok());
    let (mut last, mut done) = (None, false);
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some(name) = line.strip_prefix(RUNS) {
            last = number(name);
        } else if let Some(i) = line.strip_prefix(FAILED).and_then(number) {
            let text: Vec<&str> = lines.by_ref().take_while(|l| *l != END).collect();
            report.failures.push((kernels[i].clone(), text.join("\n")));
        } else if let Some(numbers) = line.strip_prefix(DONE) {
            let mut numbers = numbers.split(' ').skip(1).filter_map(|n| n.parse::<usize>().ok());
            report.on_wgsl += numbers.next().unwrap_or(0);
            report.wgsl_inputs += numbers.next().unwrap_or(0);
            done = true;
        }
    }
    if done {
        return None;
    }
    let last = last.unwrap_or(0);
    let tail: Vec<&str> = text.lines().rev().take(20).collect();
    let tail: Vec<&str> = tail.into_iter().rev().collect();
    let text = format!("the program ends at this kernel ({status}):\n{}", tail.join("\n"));
    report.failures.push((kernels[last].clone(), text));
    Some(last)
}
