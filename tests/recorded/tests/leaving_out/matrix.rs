//! Features times scenes: the WGSL of a scene has what its features need, and nothing of any other.
//!
//! `RAYDSL_BLESS=1` writes the tables of the book.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::path::Path;

use raydsl::machine::wgsl::Limits;
use raydsl_report::Program;

use super::features::{CORE, FEATURES};
use super::scenes::{self, Scene};

/// What a scene's program has.
struct Found {
    scene: Scene,
    text: String,
    program: Program,
    /// The names that it declares, and the source files of its functions.
    traces: BTreeSet<String>,
    /// Those files alone.
    files: BTreeSet<String>,
}

impl Found {
    fn of(scene: Scene) -> Result<Self, Box<dyn Error>> {
        let recording = (scene.record)()?;
        let text = recording.module(&Limits::default()).source;
        let program = Program::read(&text)?;
        let sources: BTreeMap<&str, Option<&str>> = recording.functions().collect();
        let library = |file: &&str| file.contains("raydsl/src/");
        let file = |f: &String| sources.get(f.as_str()).copied().flatten().filter(library);
        let short = |file: &str| file.split("raydsl/src/").last().unwrap_or(file).to_owned();
        let files: BTreeSet<String> =
            program.functions.iter().filter_map(file).map(short).collect();
        let traces = program.names().map(str::to_owned).chain(files.iter().cloned()).collect();
        Ok(Self { scene, text, program, traces, files })
    }

    fn has(&self, trace: &str) -> bool {
        if trace.contains(' ') {
            return self.text.contains(trace);
        }
        self.traces.iter().any(|found| is_like(found, trace))
    }
}

/// Returns whether a name is that of a pattern, which may begin or end with `*`.
fn is_like(name: &str, pattern: &str) -> bool {
    match (pattern.strip_prefix('*'), pattern.strip_suffix('*')) {
        (Some(end), _) => name.ends_with(end),
        (_, Some(begin)) => name.starts_with(begin),
        _ => name == pattern,
    }
}

fn found() -> Result<Vec<Found>, Box<dyn Error>> {
    scenes::all().into_iter().map(Found::of).collect()
}

#[test]
fn scenes_have_their_features_alone() -> Result<(), Box<dyn Error>> {
    let all = found()?;
    let mut faults = Vec::new();
    for of in &all {
        let name = of.scene.name;
        for feature in FEATURES {
            let traces: Vec<&str> =
                feature.traces.iter().copied().filter(|trace| of.has(trace)).collect();
            match (of.scene.uses(feature.name), traces.is_empty()) {
                (true, true) => faults.push(format!("`{name}` has no {}", feature.name)),
                (false, false) => {
                    faults.push(format!("`{name}` has {traces:?} of {}", feature.name));
                }
                _ => {}
            }
        }
        for file in &of.files {
            let owns = |traces: &[&str]| traces.iter().any(|trace| is_like(file, trace));
            if !owns(CORE) && !FEATURES.iter().any(|feature| owns(feature.traces)) {
                faults.push(format!("{file}, in `{name}`, is of no feature"));
            }
        }
        for used in of.scene.features() {
            if !FEATURES.iter().any(|feature| feature.name == used) {
                faults.push(format!("`{name}` uses `{used}`, which is no feature"));
            }
        }
    }
    // A trace that no scene has proves nothing.
    for feature in FEATURES {
        for trace in feature.traces {
            if !all.iter().any(|of| of.has(trace)) {
                faults.push(format!("no scene has `{trace}` of {}", feature.name));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    Ok(())
}

/// The table of features and that of sizes.
fn tables(all: &[Found]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rule = |count: usize| format!("|{}\n", "---|".repeat(count));
    let heads = ["", "scene", "WGSL bytes", "functions", "SPIR-V instructions", "bindings"];
    let mut text = line(&heads.map(str::to_owned)) + &rule(heads.len());
    for (n, of) in all.iter().enumerate() {
        let size = of.program.size;
        let numbers = [size.wgsl_bytes, size.functions, size.instructions, size.bindings];
        let cells = [(n + 1).to_string(), of.scene.name.to_owned()];
        let cells = cells.into_iter().chain(numbers.map(|n| n.to_string()));
        text += &line(&cells.collect::<Vec<_>>());
    }
    text += "\nWhat each of them has, a column for each scene, by its number:\n\n";
    // A column is a character; above it are the tens of every tenth scene, and the fives between.
    let above = |n: usize| match n % 10 {
        0 => char::from_digit((n / 10) as u32, 10).unwrap_or('+'),
        5 => '5',
        _ => ' ',
    };
    let marks = |of: &mut dyn Iterator<Item = char>| format!("`{}`", of.collect::<String>());
    text += &line(&["feature".to_owned(), marks(&mut (1..=all.len()).map(above))]);
    text += &rule(2);
    for feature in FEATURES {
        let mark = |of: &Found| if of.scene.uses(feature.name) { '●' } else { '·' };
        text += &line(&[feature.name.to_owned(), marks(&mut all.iter().map(mark))]);
    }
    text
}

#[test]
fn the_book_has_the_tables() -> Result<(), Box<dyn Error>> {
    assert_in_book("left_out.md", &tables(&found()?))
}

/// Compares a generated file of the book, or writes it.
pub(crate) fn assert_in_book(name: &str, text: &str) -> Result<(), Box<dyn Error>> {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/generated").join(name);
    if std::env::var("RAYDSL_BLESS").is_ok_and(|v| v == "1") {
        std::fs::write(&book, text)?;
    }
    let known = std::fs::read_to_string(&book).unwrap_or_default();
    assert!(known == text, "{name} of the book is another; RAYDSL_BLESS=1 writes it:\n{text}");
    Ok(())
}

/// What a lookup would be by its pattern.
#[test]
fn patterns_are_names_or_their_ends() {
    assert!(is_like("bvh_nodes", "*_nodes") && is_like("Hit_new", "Hit*") && is_like("a", "a"));
    assert!(!is_like("nodes", "*_nodes") && !is_like("a", "b") && !is_like("_Hit", "Hit*"));
}
