//! The build of the copy. Mutants that rustc refuses are left out, and others drawn for them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::copy::{self, Place};
use crate::draw::{Mutant, draw};
use crate::folder::Folder;
use crate::rooms::PROGRAMS;
use crate::site::Site;

/// Builds the tests with all mutants, and writes down the mutants and the programs.
pub(crate) fn build(root: &Path, folder: &Folder, seed: u64, count: usize) {
    let mut refused: BTreeSet<Site> = folder.read("refused.json").unwrap_or_default();
    loop {
        let mutants = draw(&root.join("raydsl/src"), seed, count, &refused);
        let places = copy::write(root, &folder.copy(), &mutants);
        let (programs, errors) = cargo(root, folder);
        if errors.is_empty() {
            folder.write("mutants.json", &mutants);
            folder.write("programs.json", &programs);
            println!("seed {seed}: {} mutants, {} refused by rustc", mutants.len(), refused.len());
            return;
        }
        let before = refused.len();
        for error in &errors {
            refused.extend(blamed(error, &places).map(|i| mutants[i].site.clone()));
        }
        if refused.len() == before {
            let shown = errors.iter().filter_map(|e| e["rendered"].as_str());
            panic!("the copy does not compile:\n{}", shown.collect::<String>());
        }
        println!("{} errors: {} mutants refused", errors.len(), refused.len() - before);
        folder.write("refused.json", &refused);
    }
}

/// The mutants whose code an error is in: the innermost around each of its spans.
fn blamed(error: &Value, places: &BTreeMap<String, Vec<Place>>) -> impl Iterator<Item = usize> {
    let mut found = BTreeSet::new();
    let mut spans: Vec<&Value> = error["spans"].as_array().into_iter().flatten().collect();
    while let Some(span) = spans.pop() {
        let file = span["file_name"].as_str().and_then(|f| f.strip_prefix("raydsl/src/"));
        let at = |name: &str| span[name].as_u64().unwrap_or_default() as usize;
        let (start, end) = (at("byte_start"), at("byte_end"));
        let around = file.and_then(|f| places.get(f)).into_iter().flatten();
        let around = around.filter(|p| p.bytes.start <= start && end <= p.bytes.end);
        found.extend(around.min_by_key(|p| p.bytes.len()).map(|p| p.mutant));
        if span["expansion"].is_object() {
            spans.push(&span["expansion"]["span"]);
        }
    }
    found.into_iter()
}

/// Returns the test programs by name, and the errors.
fn cargo(root: &Path, folder: &Folder) -> (BTreeMap<String, PathBuf>, Vec<Value>) {
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let mut command = Command::new("cargo");
    command.args(["test", "--no-run", "--all-features", "--message-format=json", "--lib"]);
    command.args(PROGRAMS.iter().flat_map(|p| ["--test", p]));
    command.env("CARGO_TARGET_DIR", target).env_remove("RAYDSL_MUTANT").current_dir(folder.copy());
    let out = command.stderr(Stdio::inherit()).output().expect("cargo");
    let text = String::from_utf8_lossy(&out.stdout);
    let (mut programs, mut errors) = (BTreeMap::new(), Vec::new());
    for message in text.lines().filter_map(|l| serde_json::from_str::<Value>(l).ok()) {
        let executable = message["executable"].as_str();
        // Another package has a test of one of these names too.
        let manifest = message["manifest_path"].as_str().map(Path::new);
        let is_ours = ["raydsl/Cargo.toml", "copy/tests/Cargo.toml"]
            .iter()
            .any(|end| manifest.is_some_and(|path| path.ends_with(end)));
        if let (Some(path), true) = (executable, is_ours && message["profile"]["test"] == true) {
            let name = message["target"]["name"].as_str().unwrap_or_default();
            programs.insert(name.to_owned(), PathBuf::from(path));
        }
        let error = &message["message"];
        if message["reason"] == "compiler-message" && error["level"] == "error" {
            errors.push(error.clone());
        }
    }
    errors.retain(|e| e["spans"].as_array().is_some_and(|s| !s.is_empty()));
    assert!(out.status.success() || !errors.is_empty(), "cargo failed");
    (programs, errors)
}

/// Returns the mutants of the last build.
pub(crate) fn mutants(folder: &Folder) -> Vec<Mutant> {
    folder.read("mutants.json").expect("run `build` first")
}
