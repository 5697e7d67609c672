//! Grids of numbers, seen through a transfer function and cut open.

use std::path::{Path, PathBuf};

use glam::Affine3;
use raydsl::prelude::*;
use raydsl::volume::{
    Centering, Cut, ExactCell, Grid, GridConfig, Midpoint, PreIntegrated, ShadedCell, Volume,
    VolumeLight, Voxel,
};
use raydsl_io::volume::{ByteOrder, VolumeFile, VoxelType, Voxels, load, load_raw, load_stack};
use raydsl_scenes::Pose;
use raydsl_scenes::head::head as head_voxels;

use super::field::{BACKGROUND, Cuts, Field, bounds_of, histogram};
use super::{Failure, Serve, file_name, layers};
use crate::look::{Kind, Knot, Look, Mode, Show};
use crate::subject::{Info, Picked, Subject, SubjectKernel};

/// The integrators of the viewer: WGSL has the one that is captured.
#[derive(Clone, Copy, raydsl::Type)]
enum Method {
    Midpoint(Midpoint),
    PreIntegrated(PreIntegrated),
    ExactCell(ExactCell),
    ShadedCell(ShadedCell),
}

/// Loads a file and serves it.
pub(super) fn open(path: &Path, serve: Serve<'_>) -> Result<(), Failure> {
    show(file_name(path), load(path)?, serve)
}

/// Loads the pictures of a folder as layers and serves them.
pub(super) fn open_stack(path: &Path, serve: Serve<'_>) -> Result<(), Failure> {
    show(file_name(path), load_stack(&layers(path)?)?, serve)
}

/// Loads voxels without a header, whose size and type are in the name, and serves them.
pub(super) fn open_raw(path: &Path, serve: Serve<'_>) -> Result<(), Failure> {
    let Some((size, kind)) = raw_name(path) else {
        return Err(Failure::Other(format!(
            "{}: a raw file has its size and type in its name, as in tooth_103x94x161_uint8.raw",
            path.display()
        )));
    };
    show(file_name(path), load_raw(path, size, kind, ByteOrder::Little)?, serve)
}

fn raw_name(path: &Path) -> Option<(UVec3, VoxelType)> {
    let stem = PathBuf::from(path.file_stem()?).to_string_lossy().to_lowercase();
    let (rest, kind) = stem.rsplit_once('_')?;
    let kind = match kind {
        "uint8" => VoxelType::U8,
        "int8" => VoxelType::I8,
        "uint16" => VoxelType::U16,
        "int16" => VoxelType::I16,
        "uint32" => VoxelType::U32,
        "int32" => VoxelType::I32,
        "float32" => VoxelType::F32,
        "float64" => VoxelType::F64,
        _ => return None,
    };
    let sides = rest.rsplit_once('_').map_or(rest, |(_, sides)| sides);
    let sides: Vec<u32> = sides.split('x').map(|n| n.parse().ok()).collect::<Option<_>>()?;
    Some((UVec3::from_array(sides.try_into().ok()?), kind))
}

/// Makes a head and serves it.
pub(super) fn head(side: u32, serve: Serve<'_>) -> Result<(), Failure> {
    let scan = VolumeFile {
        size: UVec3::splat(side),
        to_world: Affine3::from_scale_rotation_translation(
            Vec3::splat(2.0 / side as f32),
            glam::Quat::IDENTITY,
            Vec3::splat(1.0 / side as f32 - 1.0),
        ),
        is_cell_centred: true,
        voxels: Voxels::U8(head_voxels(side)),
        scale: 1.0,
        offset: 0.0,
        no_data: None,
    };
    show("head".to_owned(), scan, serve)
}

fn numbers<T: Voxel>(all: &[T]) -> Vec<f32> {
    all.iter().map(|v| v.number()).collect()
}

fn show(name: String, scan: VolumeFile, serve: Serve<'_>) -> Result<(), Failure> {
    let centering = if scan.is_cell_centred { Centering::Cell } else { Centering::Vertex };
    let config = GridConfig::new()
        .to_world(scan.to_world)
        .centering(centering)
        .rescale(scan.scale, scan.offset);
    // One type of voxels is one kernel to compile; integers of 8 and 16 bits are exact.
    let voxels: Vec<f32> = match scan.voxels {
        Voxels::U8(all) => numbers(&all),
        Voxels::U16(all) => numbers(&all),
        Voxels::I16(all) => numbers(&all),
        Voxels::F32(all) => all,
    };
    let stored = bounds_of(voxels.iter().copied());
    let mut histogram = histogram(&voxels, stored);
    if scan.scale < 0.0 {
        // The least voxel has the greatest value.
        histogram.reverse();
    }
    let grid = Grid::new(voxels, scan.size, config)?;
    let range = grid.range();
    if range.x > range.y || !range.is_finite() {
        return Err(Failure::Other(format!("{name}: no voxel has a value; check what wrote it")));
    }
    let (bounds, voxel) = (bounds(&grid), thickness(&scan.to_world));
    let home = Pose::of_box(bounds, Vec3::Z, vec3(0.75, 1.15, 0.55));
    let [x, y, z] = scan.size.to_array();
    let size = format!("{x} x {y} x {z} voxels, values from {} to {}", range.x, range.y);
    let info = Info { kind: Kind::Volume, name, size, home, bounds, range, histogram };
    let (knots, volume) = (Vec::new(), None);
    let field = Field { range, bounds };
    serve(info, &mut Scan { grid: &grid, field, voxel, knots, volume });
    Ok(())
}

/// The box around all voxels.
fn bounds(grid: &Grid<'_, f32>) -> Aabb {
    let (size, config) = (grid.size().as_vec3(), grid.config());
    let corner = |i: u32| {
        let share = vec3((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
        config.to_world.transform_point3(share * size - 0.5)
    };
    Aabb::from_points((0..8).map(corner))
}

/// The shortest side of a voxel: steps that are as long as another side would pass over several.
fn thickness(to_world: &Affine3) -> f32 {
    let sides = &to_world.matrix3;
    sides.x_axis.length().min(sides.y_axis.length()).min(sides.z_axis.length())
}

struct Scan<'a> {
    grid: &'a Grid<'a, f32>,
    field: Field,
    /// The shortest side of a voxel.
    voxel: f32,
    /// Those of the volume.
    knots: Vec<Knot>,
    volume: Option<Volume<'a, f32>>,
}

impl<'a> Scan<'a> {
    /// Returns the volume with a transfer function, which is kept until that changes.
    fn volume(&mut self, knots: &[Knot]) -> Result<&Volume<'a, f32>, String> {
        if self.volume.is_none() || self.knots != knots {
            self.volume = Some(Volume::new(self.grid, self.field.transfer(knots)?));
            self.knots = knots.to_vec();
        }
        self.volume.as_ref().ok_or_else(|| "there is no volume".to_owned())
    }

    fn method(&self, look: &Look) -> Method {
        let step = 0.5 * self.voxel;
        match look.mode {
            Mode::Midpoint => Method::Midpoint(Midpoint::new(step)),
            Mode::PreIntegrated => Method::PreIntegrated(PreIntegrated::new(step)),
            Mode::ExactCell => Method::ExactCell(ExactCell::new()),
            _ => Method::ShadedCell(self.field.shaded(look, self.voxel)),
        }
    }
}

/// The most steps of a pick: more than the diagonal of a grid has, unless voxels are far longer than
/// they are thin.
const MOST_STEPS: f32 = 1e6;

impl Subject for Scan<'_> {
    fn with_kernel(
        &mut self,
        look: &Look,
        run: &mut dyn FnMut(&SubjectKernel<'_>),
    ) -> Result<(), String> {
        if look.show == Show::Cost {
            return Err("a volume has no tree whose tests are counted: show picture".to_owned());
        }
        let method = self.method(look);
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
                    Method::Midpoint(method) => volume.integrate(&method, part, light),
                    Method::PreIntegrated(method) => volume.integrate(&method, part, light),
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

    /// Finds where half of the light is absorbed, by steps of half a voxel.
    fn pick(&mut self, look: &Look, ray: Ray) -> Option<Picked> {
        let (enter, leave) = self.grid.span(ray);
        let cuts = Cuts::new(&look.cuts, self.field.bounds);
        let (grid, step) = (self.grid, 0.5 * self.voxel);
        // A volume that cannot be had shows nothing: the picture's error says why.
        let transfer = self.volume(&look.knots).ok()?.transfer();
        // Counted: far from the camera a step may be too short to change the distance.
        let steps = ((leave - enter) / step).ceil().clamp(0.0, MOST_STEPS) as u32;
        let mut depth = 0.0;
        for i in 0..steps {
            let position = ray.at(enter + (i as f32 + 0.5) * step);
            if cuts.has(position) {
                continue;
            }
            let value = grid.value(position);
            depth += transfer.at(value).extinction * step;
            if depth > core::f32::consts::LN_2 {
                return Some(self.picked(position, value));
            }
        }
        None
    }
}

impl Scan<'_> {
    fn picked(&self, position: Vec3, value: f32) -> Picked {
        let size = self.grid.size();
        let place = self.grid.config().to_world.inverse().transform_point3(position);
        let voxel = place.round().clamp(Vec3::ZERO, (size - 1).as_vec3()).as_uvec3();
        let [x, y, z] = voxel.to_array().map(u64::from);
        let id = (z * u64::from(size.y) + y) * u64::from(size.x) + x;
        Picked { id, position, value: format!("voxel ({x}, {y}, {z}), value {value}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of a volume of 4 by 3 by 2 voxels, most of which have small numbers.
    fn info(scale: f32) -> Info {
        let scan = VolumeFile {
            size: UVec3::new(4, 3, 2),
            to_world: Affine3::IDENTITY,
            is_cell_centred: false,
            voxels: Voxels::U16((0..24).map(|i| i * i).collect()),
            scale,
            offset: 0.0,
            no_data: None,
        };
        let mut found = None;
        show("a".to_owned(), scan, &mut |info, _| found = Some(info)).expect("a volume");
        found.expect("it is served")
    }

    #[test]
    fn histograms_are_of_values() {
        let (up, mut down) = (info(2.0), info(-2.0));
        assert_eq!((up.range.x, up.range.y), (-down.range.y, -down.range.x));
        let half = up.histogram.len() / 2;
        let low: u32 = up.histogram[..half].iter().sum();
        assert!(low > 12 && up.histogram.iter().sum::<u32>() == 24, "{:?}", up.histogram);
        assert_ne!(up.histogram, down.histogram);
        down.histogram.reverse();
        assert_eq!(up.histogram, down.histogram);
    }

    #[test]
    fn steps_are_as_short_as_the_shortest_side() {
        let turn = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.4, 1.1, -0.7);
        for sides in [vec3(0.1, 1.0, 5.0), vec3(3.0, 0.1, 3.0), vec3(1.0, -7.0, 0.1)] {
            let to_world = Affine3::from_scale_rotation_translation(sides, turn, Vec3::ONE);
            let found = thickness(&to_world);
            assert!((found - 0.1).abs() < 1e-6, "{sides}: {found}");
        }
    }
}
