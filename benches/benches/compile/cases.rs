//! The programs that are compiled, and how.

use super::arithmetic;

/// A program, and what is measured of it.
pub(crate) struct Case {
    /// The name of the crate, too.
    pub(crate) name: String,
    /// Its `main.rs`.
    pub(crate) source: String,
    /// A piece with a number, and the same piece with another one.
    pub(crate) edit: Option<[&'static str; 2]>,
    /// What is measured, in this order.
    pub(crate) measures: Vec<Measure>,
    /// Whether each copy is measured alone, too.
    pub(crate) by_copy: bool,
}

/// How a program is compiled.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Measure {
    /// `cargo check`.
    Check,
    /// `cargo build --release`.
    Release,
    /// The same with an option of rustc for this crate.
    ReleaseWith(&'static str),
    /// With the profile for an edit loop: from scratch, and again with another number.
    Edit,
}

impl Measure {
    /// As the table says it.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Check => "check".to_owned(),
            Self::Release => "release".to_owned(),
            Self::ReleaseWith(option) => format!("release, {option}"),
            Self::Edit => "edit loop: one number".to_owned(),
        }
    }
}

/// What each of the copies is called in `RAYDSL_VARIANTS`.
pub(crate) const COPIES: [&str; 5] = ["packet4", "packet8", "packet16", "wgsl", "reference"];

/// None of them.
pub(crate) const SCALAR: &str = "scalar";

/// The copy that is left while one edits.
pub(crate) const WHILE_EDITING: &str = "packet8";

const SUNFLOWER: &str = include_str!("programs/sunflower.rs");

/// All of them.
pub(crate) fn all() -> Vec<Case> {
    use Measure::{Check, Edit, Release, ReleaseWith};

    let arithmetic = |lines, measures: &[Measure]| Case {
        by_copy: lines == 60,
        ..case(&format!("arithmetic_{lines}"), arithmetic::program(lines), measures)
    };
    let debug = ["-Cdebuginfo=line-tables-only", "-Cdebuginfo=full"].map(ReleaseWith);
    vec![
        case("empty", include_str!("programs/empty.rs"), &[Release]),
        case("plain", [SUNFLOWER, include_str!("programs/plain.rs")].join("\n"), &[Release]),
        arithmetic(1, &[Release]),
        arithmetic(7, &[Release, Check]),
        arithmetic(15, &[Release]),
        arithmetic(30, &[Release]),
        arithmetic(60, &[Release, Check]),
        Case {
            edit: Some(["let mut light = 0.25;", "let mut light = 0.26;"]),
            by_copy: true,
            ..case(
                "first_kernel",
                [SUNFLOWER, include_str!("programs/first_kernel.rs")].join("\n"),
                &[Release, debug[0], debug[1], Edit],
            )
        },
        // The same kernel in a program that names all of the library and uses no more of it.
        case(
            "every_name",
            [
                SUNFLOWER,
                include_str!("programs/first_kernel.rs"),
                include_str!("programs/every_name.rs"),
            ]
            .join("\n"),
            &[Release],
        ),
        case("triangles", include_str!("programs/triangles.rs"), &[Release]),
        case("lights", include_str!("programs/lights.rs"), &[Release]),
        Case {
            edit: Some(["throughput.max_element(), 0.95)", "throughput.max_element(), 0.96)"]),
            ..case("path_tracer", include_str!("programs/path_tracer.rs"), &[Release, Edit])
        },
        case("volume", include_str!("programs/volume.rs"), &[Release]),
    ]
}

/// One that is neither edited nor measured by copy.
fn case(name: &str, source: impl Into<String>, measures: &[Measure]) -> Case {
    Case {
        name: name.to_owned(),
        source: source.into(),
        edit: None,
        measures: measures.to_vec(),
        by_copy: false,
    }
}
