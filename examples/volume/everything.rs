//! A renderer of volumes with every feature: what the program would have if it left nothing out.

use std::error::Error;

use raydsl::camera::PinholeRays;
use raydsl::kernel;
use raydsl::machine::Recording;
use raydsl::prelude::*;
use raydsl::volume::{
    Adaptive, Cut, Euler, ExactCell, ExponentialLeft, Labels, MeanExtinction, Midpoint,
    PreIntegrated, ShadedCell, Volume, VolumeLight,
};
use raydsl_examples::explain::{Explained, explain};
use raydsl_examples::recorded;

use super::args::Args;
use super::cuts::{Cuts, Tools};
use super::{Failure, Method, View};

/// All cuts, and all integrators of a list.
#[kernel]
fn everything(
    rays: PinholeRays,
    volume: &Volume<'_, f32>,
    kept: &Tools<'_>,
    away: &Tools<'_>,
    methods: &[Method],
    pixel: UVec2,
) -> Vec4 {
    let ray = rays.primary_ray(pixel.x as f32 + 0.5, pixel.y as f32 + 0.5);
    let method = methods[pixel.x as usize % methods.len()];
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

/// Returns the table of the program's size beside that of everything.
///
/// # Errors
///
/// If a text is not valid.
pub(crate) fn beside(
    args: &Args,
    volume: &Volume<'_, f32>,
    view: &View,
    edge: f32,
    recording: Recording,
) -> Result<String, Box<dyn Error>> {
    let all = [
        Method::Euler(Euler::new(0.5)),
        Method::ExponentialLeft(ExponentialLeft::new(0.5)),
        Method::Midpoint(Midpoint::new(0.5)),
        Method::MeanExtinction(MeanExtinction::new(0.5)),
        Method::PreIntegrated(PreIntegrated::new(0.5)),
        Method::Adaptive(Adaptive::new(1e-3)),
        Method::ExactCell(ExactCell::new()),
        Method::ShadedCell(ShadedCell::new(view.to_light(), edge)),
        Method::Labels(Labels::new(0.5).lit(view.to_light(), 0.35)),
    ];
    let methods = &all[..];
    let cuts = every_cut(view)?;
    let (kept, away) = (&cuts.kept.scene()?, &cuts.away.scene()?);
    let rays = view.camera().begin_frame(64, 64);
    let everything = recorded!(everything(rays, volume, kept, away, methods)(pixel: UVec2) -> Vec4);
    let integrator = format!("a grid, a transfer function, {:?}", args.integrator());
    let cut = if args.whole { "no cut" } else { "cuts" };
    let features = format!("{integrator}, {cut}, a camera");
    Ok(explain(&[
        Explained { name: "volume", features: &features, recording },
        Explained {
            name: "all features",
            features: "nine integrators; cuts by spheres, planes and meshes, of both kinds",
            recording: everything,
        },
    ])?)
}

/// Cuts of every kind.
fn every_cut(view: &View) -> Result<Cuts, Failure> {
    let mut cuts = Cuts::default();
    let [x, y, z] = view.middle.to_array();
    for inverse in ["", "!"] {
        cuts.add(&format!("{inverse}sphere:{x},{y},{z},{}", view.extent * 0.3))?;
        cuts.add(&format!("{inverse}plane:0,0,1,{z}"))?;
    }
    Ok(cuts)
}
