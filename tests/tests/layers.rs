//! The layers of the library: a module at the crate's root depends on those below it, not on those
//! above.
//!
//! The test reads every path of the sources: in `use` trees, in expressions and types, in the
//! bodies of macros. Unit tests may depend on anything.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// The layers, the top one first. A module may depend on those of lower layers, and on those of its
/// own that do not depend on it.
const LAYERS: [&[&str]; 14] = [
    &["__private", "error", "prelude"],
    &["gpu", "testing"],
    &["flow"],
    &["render"],
    &["integrators"],
    &["volume"],
    &["bsdf", "light"],
    &["shading"],
    &["bvh", "camera", "sampling", "texture"],
    &["geometry"],
    &["math"],
    &["kernel"],
    &["run"],
    &["machine"],
];

/// Which module depends on which, and the first file in which it does.
type Dependencies = BTreeMap<(String, String), String>;

fn layer(module: &str) -> usize {
    let found = LAYERS.iter().position(|modules| modules.contains(&module));
    found.unwrap_or_else(|| panic!("`{module}` has no layer: add it to LAYERS"))
}

/// Every source file below a folder.
fn sources(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder of sources can be read") {
        let path = entry.expect("so can its entries").path();
        if path.is_dir() {
            sources(&path, all);
        } else if path.extension().is_some_and(|e| e == "rs") {
            all.push(path);
        }
    }
}

/// The path of a file's module, from the crate's root.
fn module_path(file: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        file.with_extension("").iter().map(|name| name.to_string_lossy().into_owned()).collect();
    if names.last().is_some_and(|name| name == "mod" || name == "lib") {
        names.pop();
    }
    names
}

/// Tokens side by side, at one place in the tree of modules.
struct Reader<'a> {
    /// How many modules stand between these tokens and the crate's root.
    depth: usize,
    found: &'a mut dyn FnMut(&str),
}

impl Reader<'_> {
    fn read(&mut self, tokens: TokenStream) {
        let all: Vec<TokenTree> = tokens.into_iter().collect();
        let mut i = 0;
        while i < all.len() {
            if is_test_attribute(&all[i..])
                && let Some(n) = item_len(&all[i..])
            {
                i += n;
                continue;
            }
            let (supers, start) = self.start_of_path(&all, i);
            if supers == Some(self.depth) {
                self.first_names(&all[start..]);
                i = start;
                continue;
            }
            if let TokenTree::Group(group) = &all[i] {
                let is_module = i >= 2 && is_ident(&all[i - 2], "mod");
                let depth = self.depth + usize::from(is_module);
                Reader { depth, found: &mut *self.found }.read(group.stream());
            }
            i += 1;
        }
    }

    /// How many modules a path that begins here climbs, and where its names begin. `crate`, and the
    /// library's own name, climb all.
    fn start_of_path(&self, all: &[TokenTree], mut i: usize) -> (Option<usize>, usize) {
        let is_within = i >= 2 && is_colons(&all[i - 2..i]);
        if is_within {
            return (None, i);
        }
        let is_root = is_ident(&all[i], "crate") || is_ident(&all[i], "raydsl");
        if is_root && is_colons(&all[i + 1..]) {
            return (Some(self.depth), i + 3);
        }
        let mut supers = 0;
        while i < all.len() && is_ident(&all[i], "super") && is_colons(&all[i + 1..]) {
            (supers, i) = (supers + 1, i + 3);
        }
        ((supers > 0).then_some(supers), i)
    }

    /// Tells the names with which paths from the crate's root begin: one, or those of a group.
    fn first_names(&mut self, all: &[TokenTree]) {
        match all.first() {
            // `crate::kernel` alone is the attribute.
            Some(TokenTree::Ident(name)) if name != "kernel" || is_colons(&all[1..]) => {
                (self.found)(&name.to_string());
            }
            Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                inner
                    .split(|token| matches!(token, TokenTree::Punct(p) if p.as_char() == ','))
                    .for_each(|path| self.first_names(path));
            }
            _ => {}
        }
    }
}

fn is_ident(token: &TokenTree, name: &str) -> bool {
    matches!(token, TokenTree::Ident(ident) if ident == name)
}

fn is_colons(tokens: &[TokenTree]) -> bool {
    tokens.len() >= 2
        && tokens[..2].iter().all(|t| matches!(t, TokenTree::Punct(p) if p.as_char() == ':'))
}

/// Whether this is `#[cfg(test)]` or `#[cfg(all(test, ..))]`.
fn is_test_attribute(tokens: &[TokenTree]) -> bool {
    let [TokenTree::Punct(hash), TokenTree::Group(group), ..] = tokens else { return false };
    let text = group.stream().to_string().replace(' ', "");
    hash.as_char() == '#' && (text.starts_with("cfg(test)") || text.starts_with("cfg(all(test"))
}

/// How many tokens an item has with its attributes: up to `;` or a block.
fn item_len(tokens: &[TokenTree]) -> Option<usize> {
    tokens
        .iter()
        .position(|token| match token {
            TokenTree::Punct(p) => p.as_char() == ';',
            TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
            _ => false,
        })
        .map(|at| at + 1)
}

/// The files that `#[cfg(test)] mod name;` asks for, by name.
fn test_modules(tokens: &TokenStream) -> Vec<String> {
    let all: Vec<TokenTree> = tokens.clone().into_iter().collect();
    let names = (0..all.len()).filter(|i| is_test_attribute(&all[*i..])).filter_map(|i| {
        let item = &all[i..][..item_len(&all[i..])?];
        let at = item.iter().position(|token| is_ident(token, "mod"))?;
        Some(item.get(at + 1)?.to_string())
    });
    names.collect()
}

/// The dependencies in all sources of the library.
fn dependencies() -> Dependencies {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../raydsl/src");
    let mut paths = Vec::new();
    sources(&root, &mut paths);
    paths.sort();
    let read = |path: &PathBuf| {
        let file = path.strip_prefix(&root).expect("it was found below the root").to_owned();
        let text = std::fs::read_to_string(path).expect("a source file can be read");
        (module_path(&file), file, text.parse::<TokenStream>().expect("it compiles"))
    };
    let files: Vec<_> = paths.iter().map(read).collect();
    let tests: BTreeSet<Vec<String>> = files
        .iter()
        .flat_map(|(path, _, tokens)| {
            test_modules(tokens).into_iter().map(|name| [&path[..], &[name]].concat())
        })
        .collect();
    let mut all = Dependencies::new();
    for (path, file, tokens) in &files {
        let is_test = (1..=path.len()).any(|n| tests.contains(&path[..n]));
        let Some(from) = path.first().filter(|name| is_module(name) && !is_test) else { continue };
        let mut found = |to: &str| {
            if to != from && is_module(to) {
                let key = (from.clone(), to.to_owned());
                all.entry(key).or_insert_with(|| file.display().to_string());
            }
        };
        Reader { depth: path.len(), found: &mut found }.read(tokens.clone());
    }
    all
}

fn is_module(name: &str) -> bool {
    LAYERS.concat().contains(&name)
}

/// A module without a layer would escape the other tests.
#[test]
fn every_module_has_a_layer() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../raydsl/src");
    for entry in std::fs::read_dir(root).expect("the sources can be read") {
        let path = entry.expect("so can its entries").path();
        let name = path.file_stem().expect("it has a name").to_string_lossy().into_owned();
        assert!(name == "lib" || layer(&name) < LAYERS.len(), "{name}");
    }
}

#[test]
fn no_module_depends_on_a_higher_layer() {
    let all = dependencies();
    assert!(all.len() > 30, "the sources were not read: {all:?}");
    let up: Vec<String> = all
        .iter()
        .filter(|((from, to), _)| layer(from) > layer(to))
        .map(|((from, to), file)| {
            format!("`{from}` depends on `{to}`, which is above it, first in {file}")
        })
        .collect();
    assert!(up.is_empty(), "{}", up.join("\n"));
}

#[test]
fn no_layer_has_a_cycle() {
    let all = dependencies();
    let depends = |from: &str, to: &str| all.contains_key(&(from.to_owned(), to.to_owned()));
    for modules in LAYERS {
        for module in modules {
            let mut seen = BTreeSet::new();
            let mut next = vec![*module];
            while let Some(from) = next.pop() {
                for to in modules.iter().filter(|to| depends(from, to)) {
                    assert!(to != module, "`{module}` depends on itself by way of `{from}`");
                    if seen.insert(*to) {
                        next.push(to);
                    }
                }
            }
        }
    }
}

/// What the reader finds in a text, in a module so deep.
fn found(depth: usize, text: &str) -> Vec<String> {
    let mut all = Vec::new();
    let mut add = |name: &str| all.push(name.to_owned());
    Reader { depth, found: &mut add }.read(text.parse().expect("tokens"));
    all
}

#[test]
fn paths_of_every_kind_are_read() {
    assert_eq!(found(1, "use crate::bvh::View;"), ["bvh"]);
    assert_eq!(found(1, "use crate::{bvh::{View, Node}, math};"), ["bvh", "math"]);
    assert_eq!(
        found(1, "fn f(a: &crate::gpu::Context) { super::render::run(a) }"),
        ["gpu", "render"]
    );
    assert_eq!(found(2, "use super::super::camera; use super::own;"), ["camera"]);
    assert_eq!(
        found(1, "mod inner { use super::own; use super::super::render::Film; }"),
        ["render"]
    );
    assert_eq!(found(1, "macro_rules! m { () => { $crate::testing::check() } }"), ["testing"]);
    assert_eq!(
        found(1, "#[cfg(test)] mod tests { use crate::gpu::X; } use crate::math::Y;"),
        ["math"]
    );
    assert_eq!(
        found(1, "use crate::{kernel, math}; use crate::kernel::Kernel;"),
        ["math", "kernel"]
    );
    assert_eq!(found(1, "fn f() -> raydsl::render::Film { f() }"), ["render"]);
    assert_eq!(found(1, "other::crate_name::bvh(); self::bvh::f();"), Vec::<String>::new());
}
