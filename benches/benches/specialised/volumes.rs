//! A volume, and the generic kernel that has every integrator and cuts.

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::volume::{
    Adaptive, Cut, Euler, ExactCell, ExponentialLeft, Grid, GridConfig, Labels, MeanExtinction,
    Midpoint, PreIntegrated, ShadedCell, TransferFunction, Volume, VolumeLight,
};
use raydsl_examples::head::head;

use super::surfaces::{Ball, Block, Shape};
use super::{Bench, Error, Row};

/// Any of the integrators.
#[derive(Clone, Copy, Type)]
enum Method {
    Euler(Euler),
    ExponentialLeft(ExponentialLeft),
    Midpoint(Midpoint),
    MeanExtinction(MeanExtinction),
    PreIntegrated(PreIntegrated),
    Adaptive(Adaptive),
    ExactCell(ExactCell),
    ShadedCell(ShadedCell),
    Labels(Labels),
}

#[kernel]
fn every_volume(
    volume: &Volume<'_, u8>,
    kept: &[Shape],
    away: &[Shape],
    methods: &[Method],
    which: u32,
    ray: Ray,
) -> Vec4 {
    let method = methods[which as usize % methods.len()];
    let mut light = VolumeLight::new();
    let mut inner = Cut::new(kept, ray);
    while let Some(whole) = inner.next_inside(kept) {
        let mut outer = Cut::new(away, whole);
        while let Some(part) = outer.next_outside(away) {
            light = match method {
                Method::Euler(method) => volume.integrate(&method, part, light),
                Method::ExponentialLeft(method) => volume.integrate(&method, part, light),
                Method::Midpoint(method) => volume.integrate(&method, part, light),
                Method::MeanExtinction(method) => volume.integrate(&method, part, light),
                Method::PreIntegrated(method) => volume.integrate(&method, part, light),
                Method::Adaptive(method) => volume.integrate(&method, part, light),
                Method::ExactCell(method) => volume.integrate(&method, part, light),
                Method::ShadedCell(method) => volume.integrate(&method, part, light),
                Method::Labels(method) => volume.integrate(&method, part, light),
            };
        }
    }
    light.rgba()
}

/// A head; the generic kernel keeps what is in a ball around it, and takes away a ball and a cuboid
/// outside of it.
pub(super) fn volume(bench: &Bench<'_>) -> Result<Vec<Row>, Error> {
    let (voxels, side) = (head(64), 64u32);
    let grid = Grid::new(&voxels[..], UVec3::splat(side), GridConfig::new())?;
    let colors = [(60.0, vec3(0.9, 0.6, 0.5)), (125.0, vec3(0.8, 0.8, 0.7)), (255.0, Vec3::ONE)];
    let opacities = [(60.0, 0.0), (125.0, 0.1), (255.0, 0.4)];
    let volume = Volume::new(&grid, TransferFunction::new(&colors, &opacities, 1.0)?);
    let exact = ExactCell::new();
    let kernel = kernel!(|ray: Ray, _sampler: Sampler| {
        volume.integrate(&exact, ray, VolumeLight::new()).rgba()
    });
    let (middle, color) = (Vec3::splat(0.5 * side as f32), Vec3::ONE);
    let ball = |center, radius| Shape::Ball(Ball { center, radius, color });
    let block = |min: Vec3| Shape::Block(Block { min, max: min + Vec3::ONE, color });
    let kept = [ball(middle, 1000.0), block(middle)];
    let away = [ball(vec3(500.0, 0.0, 0.0), 1.0), block(vec3(-500.0, 0.0, 0.0))];
    let to_light = Vec3::Z;
    let methods = [
        Method::ExactCell(exact),
        Method::Euler(Euler::new(0.5)),
        Method::ExponentialLeft(ExponentialLeft::new(0.5)),
        Method::Midpoint(Midpoint::new(0.5)),
        Method::MeanExtinction(MeanExtinction::new(0.5)),
        Method::PreIntegrated(PreIntegrated::new(0.5)),
        Method::Adaptive(Adaptive::new(1e-3)),
        Method::ShadedCell(ShadedCell::new(to_light, 60.0)),
        Method::Labels(Labels::new(0.5).lit(to_light, 0.35)),
    ];
    let (kept, away, methods, which) = (&kept[..], &away[..], &methods[..], 0u32);
    let generic = kernel!(|ray: Ray, _sampler: Sampler| {
        every_volume(&volume, kept, away, methods, which, ray)
    });
    let camera = Pinhole::new(middle + vec3(70.0, 95.0, 45.0), middle, Vec3::Z, 0.6);
    bench.measure((camera, 1), &kernel, &generic)
}
