//! Data of files: loading, on a thread of its own that then renders them.

mod cells;
mod field;
mod points;
mod surface;
mod volume;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use raydsl_io::LoadError;

use crate::link::{Event, Link};
use crate::subject::{Info, Subject};
pub(crate) use surface::load_environment;

/// Why data cannot be shown, in one line.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    Scale(#[from] raydsl_scenes::cloud::ScaleError),
    #[error(transparent)]
    Build(#[from] raydsl::bvh::BuildError),
    #[error(transparent)]
    Grid(#[from] raydsl::volume::GridError),
    #[error(transparent)]
    Mesh(#[from] raydsl::shading::MeshError),
    #[error(transparent)]
    Lights(#[from] raydsl::light::LightsError),
    #[error(transparent)]
    Environment(#[from] raydsl::light::EnvironmentError),
    #[error(transparent)]
    Cells(#[from] raydsl::volume::cells::CellError),
    #[error("{0}")]
    Other(String),
}

/// What a loader tells while it works.
pub(crate) struct Teller<'a> {
    link: &'a Arc<Link>,
}

impl Teller<'_> {
    /// Reports a completed share of a part of the work; breaks if nobody waits for it any more.
    pub(crate) fn tell(&self, what: &'static str, share: f64) -> ControlFlow<()> {
        self.link.send(Event::Progress { what, share: share as f32 });
        if self.is_over() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Returns whether nobody waits for the data any more.
    pub(crate) fn is_over(&self) -> bool {
        self.link.is_closed()
    }
}

/// Renders loaded data until they are replaced.
pub(crate) type Serve<'a> = &'a mut dyn FnMut(Info, &mut dyn Subject);

/// Loads data and serves them; returns when they are no longer wanted.
pub(crate) fn load(path: &Path, link: &Arc<Link>, serve: Serve<'_>) -> Result<(), Failure> {
    raydsl_io::stoppable(link.closing(), || load_and_serve(path, link, serve))
}

fn load_and_serve(path: &Path, link: &Arc<Link>, serve: Serve<'_>) -> Result<(), Failure> {
    let teller = Teller { link };
    if let Some((made, number)) = made_in_code(path)? {
        return match made {
            Made::Landscape => points::landscape(number, &teller, serve),
            Made::Head => volume::head(number, serve),
            Made::Ropes => cells::ropes(number, &teller, serve),
        };
    }
    match kind_of(path) {
        FileKind::Cloud => points::open(path, &teller, serve),
        FileKind::Mesh => surface::open_mesh(path, &teller, serve),
        FileKind::Scene => surface::open_scene(path, &teller, serve),
        FileKind::Ply => match surface::open_mesh(path, &teller, serve) {
            // A file of points without triangles.
            Err(Failure::Load(LoadError::Empty { .. })) => points::open(path, &teller, serve),
            end => end,
        },
        FileKind::Cells => cells::open(path, &teller, serve),
        FileKind::Environment => surface::open_environment(path, &teller, serve),
        FileKind::Transfer => Err(Failure::Other(format!(
            "{}: a transfer function has no data: open a volume or cells, and then `transfer FILE`",
            path.display()
        ))),
        FileKind::Volume => volume::open(path, serve),
        FileKind::Raw => volume::open_raw(path, serve),
        FileKind::Stack => volume::open_stack(path, serve),
        FileKind::Unknown => Err(Failure::Other(format!("{}: {FORMATS}", path.display()))),
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Made {
    Landscape,
    Head,
    Ropes,
}

/// The most points that a landscape is made of.
const MOST_POINTS: u32 = 200_000_000;
/// The most voxels along a side of a head.
const MOST_SIDE: u32 = 1024;

/// The most cells along the cylinder of ropes.
const MOST_CELLS: u32 = 200;

/// Reads `landscape:2000000`, `head:192` and `ropes:48`; other names are those of files.
fn made_in_code(path: &Path) -> Result<Option<(Made, u32)>, Failure> {
    let words = path.to_str().and_then(|text| text.split_once(':'));
    let (made, range, number) = match words {
        Some(("landscape", number)) => (Made::Landscape, 1..=MOST_POINTS, number),
        Some(("head", number)) => (Made::Head, 8..=MOST_SIDE, number),
        Some(("ropes", number)) => (Made::Ropes, 4..=MOST_CELLS, number),
        _ => return Ok(None),
    };
    match number.parse() {
        Ok(number) if range.contains(&number) => Ok(Some((made, number))),
        _ => Err(Failure::Other(format!(
            "{}: choose a number from {} to {}",
            path.display(),
            range.start(),
            range.end()
        ))),
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum FileKind {
    Cloud,
    Mesh,
    Scene,
    Ply,
    Cells,
    Environment,
    Transfer,
    Volume,
    Raw,
    Stack,
    Unknown,
}

/// What is said of a file whose name tells no format.
const FORMATS: &str = "unknown format; points are .las, .laz, .ply and .xyz, surfaces .glb, .gltf, \
    .obj, .ply and .tri, volumes .mha, .mhd, .nhdr, .nii, .nii.gz, .nrrd, .raw, .vti and folders \
    of .png, cells .vtu, environments .exr and .hdr";

/// Tells the kind of a file by its name.
fn kind_of(path: &Path) -> FileKind {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match extension.as_str() {
        "las" | "laz" | "xyz" => FileKind::Cloud,
        "tri" => FileKind::Mesh,
        "glb" | "gltf" | "obj" => FileKind::Scene,
        "ply" => FileKind::Ply,
        "vtu" => FileKind::Cells,
        "exr" | "hdr" => FileKind::Environment,
        "json" => FileKind::Transfer,
        "raw" => FileKind::Raw,
        "mha" | "mhd" | "nhdr" | "nii" | "nrrd" | "vti" => FileKind::Volume,
        "gz" if path.file_stem().is_some_and(|stem| has_extension(stem.as_ref(), "nii")) => {
            FileKind::Volume
        }
        _ if path.is_dir() => FileKind::Stack,
        _ => FileKind::Unknown,
    }
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// What names of numbered files are sorted by: the text, and the numbers in it as numbers.
fn order(name: &str) -> Vec<(String, u128, String)> {
    let mut parts = Vec::new();
    let mut rest = name;
    while !rest.is_empty() {
        let text = rest.find(|c: char| c.is_ascii_digit()).unwrap_or(rest.len());
        let (text, after) = rest.split_at(text);
        let digits = after.find(|c: char| !c.is_ascii_digit()).unwrap_or(after.len());
        let (digits, after) = after.split_at(digits);
        // A number that is too large for its type comes last, in the order of its digits.
        let number = if digits.is_empty() { 0 } else { digits.parse().unwrap_or(u128::MAX) };
        parts.push((text.to_owned(), number, digits.to_owned()));
        rest = after;
    }
    parts
}

/// Returns the pictures of a folder, in order of their names, where 2 comes before 10.
fn layers(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let fail = |e: std::io::Error| Failure::Other(format!("{}: {e}", folder.display()));
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(fail)? {
        let path = entry.map_err(fail)?.path();
        if has_extension(&path, "png") {
            found.push(path);
        }
    }
    found.sort_by_cached_key(|path| (order(&file_name(path)), path.clone()));
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_the_kind() {
        for (name, kind) in [
            ("a.laz", FileKind::Cloud),
            ("a.XYZ", FileKind::Cloud),
            ("a.tri", FileKind::Mesh),
            ("b/a.glb", FileKind::Scene),
            ("a.ply", FileKind::Ply),
            ("a.nii.gz", FileKind::Volume),
            ("a.vtu", FileKind::Cells),
            ("a.HDR", FileKind::Environment),
            ("a.json", FileKind::Transfer),
            ("tooth_103x94x161_uint8.raw", FileKind::Raw),
            ("a.txt", FileKind::Unknown),
        ] {
            assert_eq!(kind_of(Path::new(name)), kind, "{name}");
        }
        let made = |name: &str| made_in_code(Path::new(name)).map_err(|e| e.to_string());
        assert_eq!(made("landscape:500"), Ok(Some((Made::Landscape, 500))));
        assert_eq!(made("head:64"), Ok(Some((Made::Head, 64))));
        assert_eq!(made("ropes:48"), Ok(Some((Made::Ropes, 48))));
        for name in ["landscape", "c:5"] {
            assert_eq!(made(name), Ok(None), "{name}");
        }
        for (name, range) in [
            ("landscape:0", "from 1 to 200000000"),
            ("head:4", "from 8 to 1024"),
            ("head:x", "from 8 to 1024"),
        ] {
            assert_eq!(made(name), Err(format!("{name}: choose a number {range}")));
        }
    }

    #[test]
    fn layers_are_in_the_order_of_their_numbers() {
        let mut names = ["a100.png", "a2.png", "a10.png", "a1.png", "b1.png", "a.png", "a02.png"];
        names.sort_by_key(|name| order(name));
        let sorted = ["a1.png", "a02.png", "a2.png", "a10.png", "a100.png", "a.png", "b1.png"];
        assert_eq!(names, sorted);
        let mut numbers = ["1.png", "10.png", "100.png", "2.png"];
        numbers.sort_by_key(|name| order(name));
        assert_eq!(numbers, ["1.png", "2.png", "10.png", "100.png"]);
    }
}
