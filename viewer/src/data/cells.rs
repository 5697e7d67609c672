//! Fields on unstructured grids, seen through a transfer function and cut open.

use std::path::Path;

use raydsl::prelude::*;
use raydsl::volume::cells::{CellData, CellGrid, CellKind, CellMesh, CellVolume};
use raydsl::volume::{Cut, ExactCell, ShadedCell, VolumeLight};
use raydsl_examples::cells::kind_of;
use raydsl_io::cells::{CellFile, load};
use raydsl_scenes::Pose;

use super::field::{BACKGROUND, Cuts, Field, histogram};
use super::{Failure, Serve, Teller, file_name};
use crate::look::{Kind, Knot, Look, Mode, Show};
use crate::subject::{Info, Picked, Subject, SubjectKernel};

/// The integrators of cells: WGSL has the one that is captured.
#[derive(Clone, Copy, raydsl::Type)]
enum Method {
    ExactCell(ExactCell),
    ShadedCell(ShadedCell),
}

/// Loads a file and serves it.
pub(super) fn open(path: &Path, teller: &Teller<'_>, serve: Serve<'_>) -> Result<(), Failure> {
    show(file_name(path), &load(path)?, teller, serve)
}

/// Makes a field of two ropes around a cylinder and serves it.
pub(super) fn ropes(along: u32, teller: &Teller<'_>, serve: Serve<'_>) -> Result<(), Failure> {
    show("ropes".to_owned(), &raydsl_examples::ropes::ropes(along), teller, serve)
}

fn show(
    name: String,
    file: &CellFile,
    teller: &Teller<'_>,
    serve: Serve<'_>,
) -> Result<(), Failure> {
    let (values, is_of_cells, array) = values(&name, file)?;
    let kinds: Vec<CellKind> = file.kinds.iter().map(|kind| kind_of(*kind)).collect();
    if teller.tell("joining cells", 0.5).is_break() {
        return Ok(());
    }
    let mesh = CellMesh::new(&file.points, &file.vertices, &kinds)?;
    let data = if is_of_cells { CellData::Cells(&values) } else { CellData::Points(&values) };
    let grid = CellGrid::new(&mesh, data)?;
    let range = grid.range();
    if range.x > range.y {
        return Err(Failure::Other(format!("{name}: no {array} has a value; check what wrote it")));
    }
    let bounds = grid.bounds();
    let skipped = match file.skipped {
        0 => String::new(),
        n => format!(", {n} of other kinds left out"),
    };
    let size = format!("{} cells{skipped}; {array} from {} to {}", mesh.cells(), range.x, range.y);
    let home = Pose::of_box(bounds, Vec3::Z, vec3(0.55, 1.2, 0.5));
    let histogram = histogram(&values, range);
    let info = Info { kind: Kind::Cells, name, size, home, bounds, range, histogram };
    // The size of a cell, if all were alike.
    let cell = bounds.size().max_element() / (mesh.cells() as f32).cbrt();
    let field = Field { range, bounds };
    serve(info, &mut Cells { grid: &grid, field, cell, knots: Vec::new(), volume: None });
    Ok(())
}

/// Returns the active scalars, or the lengths of the first array of vectors, whether they are of cells,
/// and what they are called.
fn values(name: &str, file: &CellFile) -> Result<(Vec<f32>, bool, String), Failure> {
    if let Some((array, is_of_cells)) = file.scalars() {
        return Ok((array.values.clone(), is_of_cells, array.name.clone()));
    }
    let of_points = file.point_arrays.first().map(|array| (array, false));
    let first = of_points.or_else(|| file.cell_arrays.first().map(|array| (array, true)));
    let Some((array, is_of_cells)) = first else {
        return Err(Failure::Other(format!("{name}: has no values of points or cells")));
    };
    let tuples = array.values.chunks_exact(array.components.max(1));
    let lengths = tuples.map(|v| v.iter().map(|x| x * x).sum::<f32>().sqrt());
    Ok((lengths.collect(), is_of_cells, format!("length of {}", array.name)))
}

struct Cells<'a> {
    grid: &'a CellGrid<'a>,
    field: Field,
    /// Size of a cell.
    cell: f32,
    /// Those of the volume.
    knots: Vec<Knot>,
    volume: Option<CellVolume<'a>>,
}

impl<'a> Cells<'a> {
    /// Returns the volume with a transfer function, which is kept until that changes.
    fn volume(&mut self, knots: &[Knot]) -> Result<&CellVolume<'a>, String> {
        if self.volume.is_none() || self.knots != knots {
            self.volume = Some(CellVolume::new(self.grid, self.field.transfer(knots)?));
            self.knots = knots.to_vec();
        }
        self.volume.as_ref().ok_or_else(|| "there is no volume".to_owned())
    }
}

impl Subject for Cells<'_> {
    fn with_kernel(
        &mut self,
        look: &Look,
        run: &mut dyn FnMut(&SubjectKernel<'_>),
    ) -> Result<(), String> {
        if look.show == Show::Cost {
            return Err("cells have no tree whose tests are counted: show picture".to_owned());
        }
        let method = match look.mode {
            Mode::ExactCell => Method::ExactCell(ExactCell::new()),
            _ => Method::ShadedCell(self.field.shaded(look, self.cell)),
        };
        let cuts = Cuts::new(&look.cuts, self.field.bounds);
        let tools = cuts.scene();
        let is_whole = look.cuts.is_empty();
        let background = BACKGROUND;
        let volume = self.volume(&look.knots)?;
        let kernel = kernel!(counted |ray: Ray, _sampler: Sampler| {
            let mut light = VolumeLight::new();
            let mut cut = Cut::new(&tools, ray);
            let mut rest = if is_whole { Some(ray) } else { cut.next_outside(&tools) };
            while let Some(part) = rest {
                light = match method {
                    Method::ExactCell(method) => volume.integrate(&method, part, light),
                    Method::ShadedCell(method) => volume.integrate(&method, part, light),
                };
                rest = if is_whole { None } else { cut.next_outside(&tools) };
            }
            let color = light.over(background);
            vec4(color.x, color.y, color.z, 1.0)
        });
        run(&kernel);
        Ok(())
    }

    /// Finds where half of the light is absorbed.
    fn pick(&mut self, look: &Look, ray: Ray) -> Option<Picked> {
        let (grid, field) = (self.grid, self.field);
        let cuts = Cuts::new(&look.cuts, field.bounds);
        let tools = cuts.scene();
        // A volume that cannot be had shows nothing: the picture's error says why.
        let volume = self.volume(&look.knots).ok()?;
        let depth = |part: Ray| volume.integrate(&ExactCell::new(), part, VolumeLight::new()).depth;
        let mut wanted = core::f32::consts::LN_2;
        let (enter, leave) = field.bounds.span(ray);
        if enter >= leave {
            return None;
        }
        let mut cut = Cut::new(&tools, ray.with_range(enter, leave));
        while let Some(part) = cut.next_outside(&tools) {
            let all = depth(part);
            if all < wanted {
                wanted -= all;
                continue;
            }
            let position = ray.at(reached(part, wanted, depth));
            // Between two cells there is no value, to within rounding.
            let value =
                grid.value(position).map_or("on a face".to_owned(), |v| format!("value {v}"));
            let id = nearest(grid.mesh().points(), position);
            return Some(Picked { id, position, value });
        }
        None
    }
}

/// Where an optical depth is reached in a part of a ray that has at least that, by halving.
fn reached(part: Ray, wanted: f32, depth: impl Fn(Ray) -> f32) -> f32 {
    let (mut low, mut high) = (part.t_min, part.t_max);
    for _ in 0..32 {
        let middle = 0.5 * (low + high);
        if depth(part.with_range(part.t_min, middle)) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// The number of the point that is nearest.
fn nearest(points: &[Vec3], position: Vec3) -> u64 {
    let distance = |i: &usize| points[*i].distance_squared(position);
    let found = (0..points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    found.unwrap_or(0) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_are_found() {
        let part = Ray::new(Vec3::ZERO, Vec3::X).with_range(1.0, 5.0);
        let square = |ray: Ray| ray.t_max.powi(2) - ray.t_min.powi(2);
        assert!((reached(part, 8.0, square) - 3.0).abs() < 1e-5);
        assert_eq!(nearest(&[Vec3::ZERO, Vec3::X, Vec3::Y], vec3(0.8, 0.1, 0.0)), 1);
    }

    /// Calls `test` with ropes, and what is first seen of them.
    fn with_ropes(test: impl FnOnce(&mut Cells<'_>, Look)) {
        let file = raydsl_examples::ropes::ropes(12);
        let kinds: Vec<CellKind> = file.kinds.iter().map(|kind| kind_of(*kind)).collect();
        let mesh = CellMesh::new(&file.points, &file.vertices, &kinds).expect("cells");
        let values = CellData::Points(&file.point_arrays[0].values);
        let grid = CellGrid::new(&mesh, values).expect("a value for each point");
        let field = Field { range: grid.range(), bounds: grid.bounds() };
        let mut cells = Cells { grid: &grid, field, cell: 1.0, knots: Vec::new(), volume: None };
        let knots = crate::look::preset(Kind::Cells.first_preset()).expect("it is one");
        let pose = Pose::of_box(field.bounds, Vec3::Z, vec3(0.55, 1.2, 0.5));
        test(&mut cells, Look { knots, pose, size: (12, 12), ..Look::default() });
    }

    /// The optical depth of a ray up to a distance, by a sum of points in `f64`, and how far that may be
    /// off: by what the extinction varies, over the width of a step.
    fn sum(ray: Ray, end: f32, extinction: impl Fn(Vec3) -> f64) -> (f64, f64) {
        const STEPS: u32 = 1000;
        let step = f64::from(end) / f64::from(STEPS);
        let (mut depth, mut varied, mut last) = (0.0, 0.0, 0.0);
        for i in 0..STEPS {
            let at = ray.at(((f64::from(i) + 0.5) * step) as f32);
            let now = extinction(at);
            depth += now * step;
            varied += (now - last).abs();
            last = now;
        }
        (depth, varied * step)
    }

    #[test]
    fn half_of_the_light_is_absorbed_where_cells_are_picked() {
        with_ropes(|cells, whole| {
            let (grid, bounds) = (cells.grid, cells.field.bounds);
            let function = cells.field.transfer(&whole.knots).expect("knots");
            let ball = crate::look::CutObject::Ball { center: vec3(0.6, 0.9, 0.6), radius: 0.3 };
            let cut = Look { cuts: vec![ball], ..whole.clone() };
            let (mut picked, mut moved) = (0, 0);
            for i in 0..12 * 12 {
                let ray = whole.pose.ray(whole.size, i % 12, i / 12);
                let found = [&whole, &cut].map(|look| {
                    let tools = Cuts::new(&look.cuts, bounds);
                    let extinction = |at: Vec3| {
                        // Outside of all cells there is nothing, as in the middle of the cylinder.
                        let value = grid.value(at).filter(|_| !tools.has(at));
                        value.map_or(0.0, |v| f64::from(function.at(v).extinction))
                    };
                    let found = cells.pick(look, ray);
                    let end = found.as_ref().map_or(bounds.span(ray).1, |found| {
                        (found.position - ray.origin).dot(ray.direction)
                    });
                    let (depth, error) = sum(ray, end.max(0.0), extinction);
                    match &found {
                        Some(found) => {
                            let apart = (depth - core::f64::consts::LN_2).abs();
                            assert!(apart <= error, "{i}: {depth}, not to within {error}");
                            assert!(!tools.has(found.position), "{i}: it is cut away");
                            picked += 1;
                        }
                        None => assert!(depth < core::f64::consts::LN_2 + error, "{i}: {depth}"),
                    }
                    found
                });
                moved += usize::from(found[0] != found[1]);
            }
            assert!(picked > 50 && moved > 5, "{picked} picked, {moved} others by the cut");
        });
    }
}
