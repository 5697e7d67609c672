//! Fields on unstructured grids, and fibre tracts, from files.

use std::path::Path;

use raydsl::flow::{Capsule, FlowPoint, FlowState, trace};
use raydsl::prelude::*;
use raydsl::volume::cells::{CellData, CellGrid, CellKind, CellMesh, CellVectors};
use raydsl_examples::cells::kind_of;
use raydsl_io::cells::{CellArray, CellFile};

use super::Failure;
use super::args::Args;
use super::lines::{self, Field, Shown};

/// An array of points with so many components, by its name or the first one.
fn array<'a>(
    file: &'a CellFile,
    name: Option<&str>,
    components: usize,
) -> Result<&'a CellArray, Failure> {
    let fits = |a: &&CellArray| a.components == components && name.is_none_or(|n| n == a.name);
    file.point_arrays.iter().find(fits).ok_or_else(|| {
        let known = file.point_arrays.iter().filter(|a| a.components == components);
        let known: Vec<String> = known.map(|a| format!("'{}'", a.name)).collect();
        let known = if known.is_empty() { "it has none".to_owned() } else { known.join(", ") };
        Failure::Usage(format!("name an array of points of {components} components: {known}"))
    })
}

/// Lines through a field on cells.
pub(crate) fn cells(args: &Args, path: &Path) -> Result<Shown, Failure> {
    let file = raydsl_io::cells::load(path)?;
    let vectors = array(&file, args.vectors.as_deref(), 3)?;
    // ANCHOR: cells
    let kinds: Vec<CellKind> = file.kinds.iter().map(|kind| kind_of(*kind)).collect();
    let velocities: Vec<Vec3> =
        vectors.values.as_chunks().0.iter().map(|v| Vec3::from_array(*v)).collect();
    let mesh = CellMesh::new(&file.points, &file.vertices, &kinds)?;
    let wind = CellVectors::new(&mesh, &velocities)?;
    let extent = wind.bounds().size().max_element();
    let settings = lines::settings(args, extent)?;
    let kernel = kernel!(|state: FlowState| trace(|p: Vec3| wind.value(p), state, settings));
    // ANCHOR_END: cells
    println!("{} cells, {} tetrahedra", mesh.cells(), mesh.tetrahedra().len());
    let velocity = |p: Vec3| wind.value(p);
    let show = |value: &dyn Fn(&FlowPoint) -> f32, title: &str| {
        let (bounds, title) = (wind.bounds(), title.to_owned());
        lines::through(args, &Field { bounds, velocity: &velocity, value, title }, &kernel)
    };
    match &args.color[..] {
        "speed" => show(&|p| p.velocity.length(), "speed"),
        "time" => show(&|p| p.time, "time"),
        name => {
            let numbers = array(&file, Some(name), 1)?;
            let grid = CellGrid::new(&mesh, CellData::Points(&numbers.values))?;
            // Rounding may put an end of a line outside.
            show(&|p| grid.value(p.at).unwrap_or(grid.range().x), name)
        }
    }
}

/// Fibre tracts as tubes, in the scanner's coordinates where the file has them.
pub(crate) fn tracts(args: &Args, path: &Path) -> Result<Shown, Failure> {
    // ANCHOR: tracts
    let file = raydsl_io::tracts::load(path)?;
    let to_world = file.to_world.unwrap_or(Affine3::IDENTITY);
    let place = |p: &Vec3| to_world.transform_point3(*p);
    let bounds = Aabb::from_points(file.points.iter().map(place));
    let radius = lines::radius(args, bounds.size().max_element());
    let tubes = |tract: &[Vec3]| Capsule::along(tract.iter().map(|p| (place(p), 0.0)), radius);
    let tubes: Vec<Capsule> = file.tracts().flat_map(tubes).collect();
    // ANCHOR_END: tracts
    if tubes.is_empty() {
        return Err(Failure::Usage("the file has no tracts".to_owned()));
    }
    println!(
        "{} tracts, {} points, {} parts of tubes",
        file.lengths.len(),
        file.points.len(),
        tubes.len()
    );
    Ok(Shown { tubes, arrows: Vec::new(), title: "direction".to_owned(), bounds })
}
