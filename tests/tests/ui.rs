//! What the compiler says about mistakes in kernels: `ui/*.rs`, with its answers in `ui/*.stderr`.
//!
//! `RAYDSL_BLESS=1` rewrites the answers; read the difference before committing it. The texts are
//! those of one version of rustc, in `ui/rustc-version`. With another one they are not compared,
//! but what makes a message a good one is checked all the same. A comment at the line of a mistake
//! says who sees it:
//!
//! * `//~ macro`: the macro. One error for each mistake, at its line, with what to write instead,
//!   and nothing else.
//! * `//~ lifted`: rustc, in lifted code. Plain Rust takes it. The first error is at its line, says
//!   what is wrong in the words of the kernel language, and what to do.
//! * `//~ rustc`: rustc, in plain Rust. Its own error comes first.
//!
//! A number behind it is how many errors there are, if not one: what could not be merged.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, io, thread};

/// Words of generated code and of the library's inside that no message may show.
const INNER_WORDS: [&str; 6] = ["__private", "__M", "__A0", "__INFO", "__Twin", "__host"];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("ui")
}

fn is_blessing() -> bool {
    env::var("RAYDSL_BLESS").is_ok_and(|v| v == "1")
}

/// The compiler, and the library that this test was linked with.
struct Compiler {
    rustc: String,
    library: PathBuf,
    scratch: PathBuf,
}

impl Compiler {
    fn new() -> io::Result<Self> {
        let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
        let program = env::current_exe()?;
        let deps = program.parent().ok_or(io::ErrorKind::NotFound)?;
        // Cargo has made the one that belongs to this test anew if any source is younger, so the
        // newest one is made of the same sources.
        let newest = fs::read_dir(deps)?
            .filter_map(Result::ok)
            .map(|entry| entry.path())
            .filter(|path| {
                let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
                name.starts_with("libraydsl-") && name.ends_with(".rlib")
            })
            .max_by_key(|path| path.metadata().and_then(|m| m.modified()).ok());
        let library = newest.ok_or_else(|| io::Error::other("no libraydsl-*.rlib to test"))?;
        let scratch = env::temp_dir().join(format!("raydsl-ui-{}", std::process::id()));
        fs::create_dir_all(&scratch)?;
        Ok(Self { rustc, library, scratch })
    }

    fn version(&self) -> io::Result<String> {
        let out = Command::new(&self.rustc).arg("--version").output()?;
        Ok(String::from_utf8_lossy(&out.stdout).trim().to_owned())
    }

    /// What the compiler says about a file; `None` if it takes it.
    fn check(&self, file: &str) -> io::Result<Option<String>> {
        let deps = self.library.parent().unwrap_or(Path::new(""));
        let out = Command::new(&self.rustc)
            .current_dir(folder())
            // All copies of a kernel: cargo hands on which of them the tests' own kernels have.
            .env_remove("RAYDSL_VARIANTS")
            .args([
                "--edition",
                "2024",
                "--emit",
                "metadata",
                "--crate-type",
                "bin",
                "-A",
                "warnings",
            ])
            .args(["--diagnostic-width", "140", "--color", "never", "--out-dir"])
            .arg(&self.scratch)
            .arg("--extern")
            .arg(format!("raydsl={}", self.library.display()))
            .arg("-L")
            .arg(format!("dependency={}", deps.display()))
            .arg(file)
            .output()?;
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        Ok((!out.status.success()).then(|| normalised(&said)))
    }
}

impl Drop for Compiler {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.scratch);
    }
}

/// Without what changes from one machine, or from one line of the library, to the next.
fn normalised(said: &str) -> String {
    let mut out = String::new();
    for line in said.lines() {
        let is_about_this_machine = line.contains("the full name for the type has been written to")
            || line.contains("consider using `--verbose` to print")
            || line.contains("= note: see issue #")
            || line.contains("= help: see issue #");
        if is_about_this_machine {
            continue;
        }
        // How many more implement a trait changes with every type of the library.
        if let Some((before, rest)) = line.split_once("and ")
            && before.trim().is_empty()
            && let Some(number) = rest.strip_suffix(" others")
            && number.parse::<u32>().is_ok()
        {
            out.push_str(&format!("{before}and N others\n"));
            continue;
        }
        match line.split_once("raydsl/src/") {
            Some((before, place)) => {
                let mark = before.trim_end_matches(|c: char| c != ' ');
                let file = place.split(':').next().unwrap_or(place);
                out.push_str(&format!("{mark}raydsl/src/{file}"));
            }
            None => match line.find("/library/") {
                Some(at) if line.contains("/rustc/") => {
                    let file = line[at + 1..].split(':').next().unwrap_or_default();
                    let mark = line.split('/').next().unwrap_or_default();
                    out.push_str(&format!("{mark}{file}"));
                }
                _ => out.push_str(line.trim_end()),
            },
        }
        out.push('\n');
    }
    out
}

/// A mistake in a source.
struct Mistake {
    line: usize,
    seen_by: String,
    errors: usize,
}

fn mistakes(source: &str) -> Vec<Mistake> {
    let marked = source.lines().enumerate().filter_map(|(i, l)| Some((i, l.split_once("//~ ")?.1)));
    marked
        .map(|(i, mark)| {
            let mut words = mark.split_whitespace();
            let seen_by = words.next().unwrap_or_default().to_owned();
            let errors = words.next().and_then(|n| n.parse().ok()).unwrap_or(1);
            Mistake { line: i + 1, seen_by, errors }
        })
        .collect()
}

/// One error of the compiler's.
struct Error<'a> {
    title: &'a str,
    text: &'a str,
    /// The line that it points at, in the file itself.
    line: Option<usize>,
}

fn errors<'a>(said: &'a str, file: &str) -> Vec<Error<'a>> {
    let starts: Vec<usize> = said
        .match_indices("error")
        .map(|(at, _)| at)
        .filter(|&at| at == 0 || said.as_bytes()[at - 1] == b'\n')
        .chain([said.len()])
        .collect();
    let texts = starts.windows(2).map(|w| &said[w[0]..w[1]]);
    texts
        .filter(|text| !text.starts_with("error: aborting"))
        .map(|text| {
            let title = text.lines().next().unwrap_or_default();
            let place = text.lines().find_map(|l| l.trim().strip_prefix("--> "));
            let line = place.and_then(|p| p.strip_prefix(file)?.split(':').nth(1)?.parse().ok());
            Error { title, text, line }
        })
        .collect()
}

/// What is wrong with what the compiler says.
fn complaints(file: &str, source: &str, said: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    let (mistakes, errors) = (mistakes(source), errors(said, file));
    let Some(first) = mistakes.first() else { return vec!["no mistake is marked".to_owned()] };
    for word in INNER_WORDS {
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if said.split(|c| !is_part(c)).any(|w| w == word) {
            wrong.push(format!("shows the word {word}"));
        }
    }
    let expected: usize = mistakes.iter().map(|m| m.errors).sum();
    if errors.len() != expected {
        wrong.push(format!("{} errors, not {expected}", errors.len()));
    }
    for m in &mistakes {
        let at = errors.iter().filter(|e| e.line == Some(m.line)).count();
        if at == 0 {
            wrong.push(format!("no error at line {}", m.line));
        }
    }
    let Some(error) = errors.first() else { return wrong };
    match first.seen_by.as_str() {
        "macro" => {
            for e in errors.iter().filter(|e| !e.text.contains("help: ")) {
                wrong.push(format!("no remedy: {}", e.title));
            }
        }
        "lifted" => {
            // What is no kernel has no type of its name: that is for rustc to say.
            let is_not_a_kernel = error.title.starts_with("error[E0433]");
            if !(is_not_a_kernel || error.text.contains("note: ")) {
                wrong.push(format!("no remedy: {}", error.title));
            }
        }
        "rustc" => {
            if error.title.contains("kernel") {
                wrong.push(format!("not rustc's own error: {}", error.title));
            }
        }
        other => wrong.push(format!("nobody is called {other}")),
    }
    if error.line != Some(first.line) {
        wrong.push(format!("the first error is at line {:?}, not {}", error.line, first.line));
    }
    wrong
}

/// Compares with the answer on file, or writes it.
fn compare(file: &str, said: &str, is_same_version: bool) -> io::Result<Option<String>> {
    let path = folder().join(file).with_extension("stderr");
    if is_blessing() {
        fs::write(path, said)?;
        return Ok(None);
    }
    if !is_same_version {
        return Ok(None);
    }
    let expected = fs::read_to_string(path).unwrap_or_default();
    Ok((expected != said)
        .then(|| format!("says another thing; RAYDSL_BLESS=1 rewrites it\n{said}")))
}

fn examine(compiler: &Compiler, file: &str, is_same_version: bool) -> io::Result<Vec<String>> {
    let source = fs::read_to_string(folder().join(file))?;
    let Some(said) = compiler.check(file)? else {
        return Ok(vec!["the compiler takes it".to_owned()]);
    };
    let mut wrong = complaints(file, &source, &said);
    wrong.extend(compare(file, &said, is_same_version)?);
    Ok(wrong)
}

#[test]
fn mistakes_get_good_errors() -> io::Result<()> {
    let compiler = Compiler::new()?;
    let version = compiler.version()?;
    let version_file = folder().join("rustc-version");
    if is_blessing() {
        fs::write(&version_file, format!("{version}\n"))?;
    }
    let made_with = fs::read_to_string(version_file)?;
    let is_same_version = made_with.trim() == version;
    if !is_same_version {
        eprintln!(
            "NOT COMPARED: the texts of ui/*.stderr are those of {made_with}, this is {version}"
        );
    }
    let mut files: Vec<String> = fs::read_dir(folder())?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".rs"))
        .collect();
    files.sort();
    assert!(files.len() >= 40, "{} files", files.len());
    let (next, failed) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(2, |n| n.get().min(8)) {
            scope.spawn(|| {
                while let Some(file) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let wrong = examine(&compiler, file, is_same_version)
                        .unwrap_or_else(|e| vec![e.to_string()]);
                    let lines = wrong.iter().map(|w| format!("{file}: {w}"));
                    failed.lock().expect("no thread panics").extend(lines);
                }
            });
        }
    });
    let mut failed = failed.into_inner().expect("no thread panics");
    failed.sort();
    assert!(failed.is_empty(), "{} complaints\n{}", failed.len(), failed.join("\n"));
    Ok(())
}

/// The program is of no use if it does not notice.
#[test]
fn complaints_are_made() {
    let source = "f(x); //~ macro\n";
    let good = "error: no\n  help: write y\n --> a.rs:1:1\n\nerror: aborting due to 1 error\n";
    assert_eq!(complaints("a.rs", source, good), Vec::<String>::new());
    let twice = format!("{good}error: no\n  help: write y\n --> a.rs:1:1\n");
    assert_eq!(complaints("a.rs", source, &twice), ["2 errors, not 1"]);
    assert_eq!(complaints("a.rs", source, "error: no\n --> a.rs:1:1\n").len(), 1);
    assert_eq!(complaints("a.rs", source, "error: no\n  help: y\n --> a.rs:2:1\n").len(), 2);
    assert_eq!(complaints("a.rs", source, &good.replace("write y", "__M")).len(), 1);
    let ours = good.replace("error: no", "error: a kernel has no");
    assert_eq!(complaints("a.rs", "f(x); //~ rustc\n", &ours).len(), 1);
    assert_eq!(complaints("a.rs", "f(x);\n", good), ["no mistake is marked"]);
}
