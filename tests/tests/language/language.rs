//! The tables of the book's chapter "The language", written from the sources that decide.
//!
//! `RAYDSL_BLESS=1` rewrites them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &str) -> io::Result<String> {
    fs::read_to_string(root().join(path))
}

/// What stands between quotes at the end of `before` and the first quote behind it.
fn quoted(line: &str) -> Vec<&str> {
    line.split('"').skip(1).step_by(2).collect()
}

/// For whom the methods are that a macro of the library writes, by the macro's name. `None`: those
/// that its own argument names.
const OWNERS: &[(&str, Option<&str>)] = &[
    ("of_f32", Some("`f32`")),
    ("of_integers", Some("`i32`, `u32`")),
    ("of_vectors", Some("vectors of integers")),
    ("each_pair", Some("vectors of integers")),
    ("of_matrices", None),
    ("each", Some("all vectors of numbers")),
    ("floats", Some("`Vec2`, `Vec3`, `Vec4`")),
    ("in_order", Some("`Vec2`, `Vec3`, vectors of integers")),
    ("floats_in_order", Some("`Vec2`, `Vec3`")),
    ("absolute", Some("`Vec2` to `Vec4`, `IVec2` to `IVec4`")),
    ("fused", Some("`Vec2`, `Vec3`, `Vec4`")),
    ("parts", Some("all vectors")),
    ("conversions", None),
    ("method", None),
    ("read_in_place", Some("slices and trees")),
    ("queries", Some("scenes")),
    ("primitives", Some("scenes of one type of primitives")),
    ("methods", Some("scenes that can be shaded")),
];

/// The type of the host that a receiver in the library's sources stands for.
fn owner(receiver: &str) -> Option<&'static str> {
    const RECEIVERS: &[(&str, &str)] = &[
        ("Usize<M>", "`usize`"),
        ("usize", "`usize`"),
        ("I<M>", "`i32`"),
        ("U<M>", "`u32`"),
        ("V2<M>", "`Vec2`"),
        ("V3<M>", "`Vec3`"),
        ("X2<E>", "vectors of two"),
        ("X3<E>", "vectors of three"),
        ("X4<E>", "vectors of four"),
        ("X2", "vectors of two"),
        ("X3", "vectors of three"),
        ("X4", "vectors of four"),
        ("M3", "`Mat3`"),
        ("M4", "`Mat4`"),
        ("A3", "`Affine3`"),
        ("[V; N]", "arrays"),
        ("$twin<M>", "`Unorm8` and its like"),
        ("F16On<M>", "`Unorm8` and its like"),
        ("V", "`BVec2`, `BVec3`, `BVec4`"),
    ];
    RECEIVERS.iter().find(|r| r.0 == receiver).map(|r| r.1)
}

/// The receiver that stands in front of a name in `method!(..)`, or in an impl for a name.
fn receiver(line: &str) -> Option<&str> {
    if let Some((_, after)) = line.split_once("method!(") {
        let (generics, after) = after.split_once("] ")?;
        let receiver = after.split_once(", \"")?.0;
        // A vector of anything with a bound: only the truth values have methods of this form.
        return (receiver != "V" || generics.contains("Component = B<M>")).then_some(receiver);
    }
    if let Some((_, after)) = line.split_once(" for ") {
        return Some(after.trim_end_matches(" {"));
    }
    let first = line.split_whitespace().next()?;
    Some(first.trim_end_matches(':'))
}

/// Every method, and what has it.
fn methods() -> io::Result<BTreeMap<&'static str, BTreeSet<String>>> {
    let mut found = BTreeMap::<_, BTreeSet<String>>::new();
    for file in [
        "methods.rs",
        "methods/float.rs",
        "methods/integer.rs",
        "methods/matrix.rs",
        "methods/vector.rs",
        "data.rs",
        "../bvh/methods.rs",
        "../shading/scene.rs",
        "../math/code.rs",
        "../math/half.rs",
        "../math/unorm.rs",
    ] {
        let text = read(&format!("raydsl/src/machine/{file}"))?;
        let mut inside = String::new();
        for line in text.lines().filter(|l| !l.trim_start().starts_with("//")) {
            if let Some(name) = line.strip_prefix("macro_rules! ") {
                inside = name.trim_end_matches(" {").to_owned();
            } else if let Some((name, _)) = line.split_once("! {")
                && !line.starts_with(' ')
            {
                inside = name.to_owned();
            }
            if line.starts_with('}') || inside == "denied" {
                if line.starts_with('}') {
                    inside.clear();
                }
                continue;
            }
            let names: Vec<&str> = quoted(line).into_iter().filter(|n| is_name(n)).collect();
            let is_method = OWNERS.iter().any(|o| o.0 == inside)
                || line.contains("method!(")
                || line.contains("Method<{");
            if names.is_empty() || !is_method || line.contains("$name") {
                continue;
            }
            let by_macro = OWNERS.iter().find(|o| o.0 == inside).and_then(|o| o.1);
            let by_itself = receiver(line).and_then(owner);
            let Some(owner) = by_macro.or(by_itself) else {
                panic!("{file}: whose method is it? name its macro in OWNERS: {line}");
            };
            for name in names {
                found.entry(owner).or_default().insert(name.to_owned());
            }
        }
    }
    Ok(found)
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_lowercase())
        && text.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

/// The names in a list of exports of the prelude that begins with `start`.
fn exports(prelude: &str, start: &str) -> Vec<String> {
    let after = prelude.split_once(start).map(|p| p.1).unwrap_or_default();
    let list = after.split_once("};").map(|p| p.0).unwrap_or_default();
    let names = list.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    names.filter(|n| is_name(n)).map(str::to_owned).collect()
}

fn code(names: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    let all: Vec<String> = names.into_iter().map(|n| n.as_ref().to_owned()).collect();
    format!("`{}`", all.join(" "))
}

fn functions() -> io::Result<String> {
    let prelude = read("raydsl/src/prelude.rs")?;
    let rows = [
        ("making vectors and matrices", "pub use crate::machine::functions::{"),
        ("of numbers, vectors and matrices", "pub use crate::machine::generic::{"),
        ("elementary", "pub use crate::math::elementary::{"),
    ];
    let mut out = "| functions | names |\n|---|---|\n".to_owned();
    for (what, start) in rows {
        let names = exports(&prelude, start);
        assert!(names.len() > 5, "{what}: {names:?}");
        out += &format!("| {what} | {} |\n", code(names));
    }
    Ok(out)
}

/// The tables of refused methods and types of the macro.
fn refused() -> io::Result<String> {
    let ops = read("raydsl-macros/src/ops.rs")?;
    let table = |name: &str| -> Vec<(String, String)> {
        let after = ops.split_once(&format!("const {name}: ")).map(|p| p.1).unwrap_or_default();
        let list = after.split_once("];").map(|p| p.0).unwrap_or_default();
        let rows = list.lines().map(quoted).filter(|q| q.len() == 2);
        rows.map(|q| (q[0].to_owned(), q[1].to_owned())).collect()
    };
    let mut out = "| not in a kernel | write |\n|---|---|\n".to_owned();
    let (elementary, others) = (table("ELEMENTARY"), table("DENIED"));
    assert!(elementary.len() > 10 && others.len() > 3, "{elementary:?} {others:?}");
    for (name, ours) in elementary {
        let ours = match ours.as_str() {
            "" => "compute it outside and capture the result".to_owned(),
            ours => format!("`{ours}`"),
        };
        out += &format!("| `.{name}()` | {ours} |\n");
    }
    for (name, instead) in others {
        out += &format!("| `.{name}()` | {instead} |\n");
    }
    Ok(out)
}

fn tables() -> io::Result<Vec<(&'static str, String)>> {
    let mut methods_table = "| type | methods |\n|---|---|\n".to_owned();
    for (owner, names) in methods()? {
        methods_table += &format!("| {owner} | {} |\n", code(names));
    }
    Ok(vec![
        ("methods.md", methods_table),
        ("functions.md", functions()?),
        ("refused.md", refused()?),
    ])
}

#[test]
fn tables_of_the_book() -> io::Result<()> {
    for (name, table) in tables()? {
        let path = root().join("book/src/generated").join(name);
        if env::var("RAYDSL_BLESS").is_ok_and(|v| v == "1") {
            fs::write(path, table)?;
            continue;
        }
        let written = fs::read_to_string(&path)?;
        assert_eq!(written, table, "{name} is out of date; RAYDSL_BLESS=1 rewrites it");
    }
    Ok(())
}

/// The reader of sources finds what is known to be there.
#[test]
fn known_methods_are_found() -> io::Result<()> {
    let methods = methods()?;
    for (owner, name) in [
        ("`f32`", "mul_add"),
        ("`i32`, `u32`", "wrapping_mul"),
        ("`u32`", "is_power_of_two"),
        ("`Vec2`, `Vec3`", "reflect"),
        ("`Mat4`", "project_point3"),
        ("`BVec2`, `BVec3`, `BVec4`", "any"),
        ("scenes", "closest_hit"),
        ("scenes", "any_hit_each"),
        ("scenes of one type of primitives", "primitive"),
        ("scenes that can be shaded", "surface"),
        ("`Unorm8` and its like", "to_f32"),
        ("vectors of three", "cross"),
    ] {
        let names = methods.get(owner).unwrap_or_else(|| panic!("{owner}: {methods:#?}"));
        assert!(names.contains(name), "{owner} has {names:?}");
    }
    Ok(())
}
