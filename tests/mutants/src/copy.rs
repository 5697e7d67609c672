//! The copy of the workspace with all mutants in it.
//!
//! Each mutated expression becomes `(mutant!(number, original, mutated))`, an `if` on a switch that the
//! environment sets. The macros of the copy know `mutant!` and write that same `if` into lifted code: a
//! branch of the host, so that one mutant is in the source, in all packets and in recorded WGSL alike.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::process::Command;

use crate::draw::Mutant;

const SWITCH: &str = include_str!("../switch.rs");
const PATCH: &str = include_str!("../macros.patch");
const MACRO: &str = "
macro_rules! mutant {
    ($number:literal, $original:expr, $mutated:expr) => {
        if crate::mutation::is_on($number) { $mutated } else { $original }
    };
}
#[doc(hidden)]
pub mod mutation;
";

/// A place of the copy: the mutant of this number is in these bytes.
pub(crate) struct Place {
    pub(crate) mutant: usize,
    pub(crate) bytes: Range<usize>,
}

/// Writes the copy, and returns where the mutants are, by the file below `raydsl/src`. Files that are
/// already as they should be stay untouched, so that cargo does not build them again.
pub(crate) fn write(root: &Path, copy: &Path, mutants: &[Mutant]) -> BTreeMap<String, Vec<Place>> {
    let listed = output(
        Command::new("git").args(["ls-files", "-co", "--exclude-standard"]).current_dir(root),
    );
    let mut places = BTreeMap::new();
    for name in listed.lines().filter(|n| root.join(n).is_file()) {
        let text = std::fs::read(root.join(name)).expect("a file of the workspace");
        let text = match name.strip_prefix("raydsl/src/") {
            Some(file) => {
                let mut text = String::from_utf8(text).expect("a source in UTF-8");
                let here: Vec<_> =
                    mutants.iter().enumerate().filter(|(_, m)| m.site.file == file).collect();
                if !here.is_empty() {
                    let (mutated, found) = mutate(&text, &here);
                    text = mutated;
                    places.insert(file.to_owned(), found);
                }
                if file == "lib.rs" {
                    text = text.replacen("pub mod bsdf;", &format!("{MACRO}pub mod bsdf;"), 1);
                }
                text.into_bytes()
            }
            None if name.ends_with("Cargo.toml") => {
                manifest(name, &String::from_utf8(text).expect("a manifest in UTF-8")).into_bytes()
            }
            None if name.starts_with("raydsl-macros/src/") && is_patched(name) => continue,
            None => text,
        };
        write_changed(&copy.join(name), &text);
    }
    write_changed(&copy.join("raydsl/src/mutation.rs"), SWITCH.as_bytes());
    patch_macros(root, copy);
    places
}

/// Returns the manifest such that cargo builds no more than is run: the library's unit tests, but not
/// those of the other packages, and no programs.
fn manifest(name: &str, text: &str) -> String {
    let package = name.trim_end_matches("/Cargo.toml");
    let members =
        ["raydsl-macros", "raydsl-io", "raydsl-report", "scenes", "examples", "tests", "benches"];
    if !members.contains(&package) {
        return text.to_owned();
    }
    let mut out = String::new();
    let (mut is_left_out, mut has_lib) = (false, false);
    for line in text.lines() {
        if line.starts_with('[') {
            is_left_out = line == "[[bin]]";
        }
        if !is_left_out {
            out += line;
            out.push('\n');
        }
        match line {
            "[package]" => out += "autobins = false\n",
            "[lib]" => (has_lib, out) = (true, out + "test = false\n"),
            _ => {}
        }
    }
    if has_lib { out } else { out + "\n[lib]\ntest = false\n" }
}

fn is_patched(name: &str) -> bool {
    PATCH.lines().any(|l| l.strip_prefix("+++ b/").is_some_and(|l| l.starts_with(name)))
}

/// Patches the macros beside the copy, and then moves them into it where they differ.
fn patch_macros(root: &Path, copy: &Path) {
    let beside = copy.with_extension("macros");
    let names: Vec<&str> =
        PATCH.lines().filter_map(|l| l.strip_prefix("+++ b/")?.split_whitespace().next()).collect();
    for name in &names {
        let text = std::fs::read(root.join(name)).expect("a source of the macros");
        write_changed(&beside.join(name), &text);
    }
    let patch = beside.join("macros.patch");
    write_changed(&patch, PATCH.as_bytes());
    output(
        Command::new("patch").args(["--quiet", "-p1", "-i", "macros.patch"]).current_dir(&beside),
    );
    for name in names {
        let text = std::fs::read(beside.join(name)).expect("a patched source");
        write_changed(&copy.join(name), &text);
    }
    std::fs::remove_dir_all(beside).expect("a folder of our own");
}

fn write_changed(path: &Path, text: &[u8]) {
    if std::fs::read(path).is_ok_and(|old| old == text) {
        return;
    }
    std::fs::create_dir_all(path.parent().expect("a file in a folder"))
        .expect("a folder to write to");
    std::fs::write(path, text).expect("a file to write to");
}

fn output(command: &mut Command) -> String {
    let out = command.output().unwrap_or_else(|e| panic!("{command:?}: {e}"));
    assert!(out.status.success(), "{command:?}: {}", String::from_utf8_lossy(&out.stdout));
    String::from_utf8_lossy(&out.stdout).into_owned()
}

/// Returns a file's text with these mutants, and where they are.
fn mutate(text: &str, mutants: &[(usize, &Mutant)]) -> (String, Vec<Place>) {
    let mut ordered = mutants.to_vec();
    // Outer ones first.
    ordered.sort_by_key(|(i, m)| (m.site.start, usize::MAX - m.site.end, *i));
    let mut writer = Writer { text, out: String::new(), places: Vec::new() };
    writer.range(0..text.len(), &ordered);
    (writer.out, writer.places)
}

struct Writer<'a> {
    text: &'a str,
    out: String,
    places: Vec<Place>,
}

impl Writer<'_> {
    fn range(&mut self, bytes: Range<usize>, mutants: &[(usize, &Mutant)]) {
        let (mut at, mut rest) = (bytes.start, mutants);
        while let Some(((number, mutant), others)) = rest.split_first() {
            let site = &mutant.site;
            let inner = others.iter().take_while(|(_, m)| m.site.start < site.end).count();
            self.out += &self.text[at..site.start];
            let start = self.out.len();
            let (open, close) = if site.is_body() { ("{ ", " }") } else { ("", "") };
            self.out += &format!("{open}(mutant!({number}, ");
            self.range(site.bytes(), &others[..inner]);
            self.out += &format!(", {})){close}", site.mutated);
            self.places.push(Place { mutant: *number, bytes: start..self.out.len() });
            (at, rest) = (site.end, &others[inner..]);
        }
        self.out += &self.text[at..bytes.end];
    }
}

#[cfg(test)]
mod tests {
    use super::{Command, Mutant, Path, mutate, output};
    use crate::site::sites;

    /// The macros change now and then: their patch must follow.
    #[test]
    fn the_patch_applies() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/macros.patch");
        output(Command::new("patch").args(["--dry-run", "-p1", "-i", file]).current_dir(root));
    }

    #[test]
    fn mutants_are_nested() {
        let text = "fn f(a: u32) -> bool { a + 2 < 3 }";
        let found = sites("f.rs", text).unwrap();
        let all: Vec<_> =
            found.into_iter().map(|site| Mutant { room: String::new(), site }).collect();
        let chosen = |change: &str| all.iter().find(|m| m.site.change == change).unwrap();
        let chosen = [(0, chosen("+ to -")), (1, chosen("< to <=")), (2, chosen("body to true"))];
        let (out, places) = mutate(text, &chosen);
        let expected = "fn f(a: u32) -> bool { (mutant!(2, { (mutant!(1, (mutant!(0, a + 2, (a) - (2))) < 3, \
                        (a + 2) <= (3))) }, true)) }";
        assert_eq!(out, expected);
        assert_eq!(places.len(), 3);
        assert_eq!(&out[places[0].bytes.clone()], "(mutant!(0, a + 2, (a) - (2)))");
    }
}
