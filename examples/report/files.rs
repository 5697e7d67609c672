//! Scenes from the files of the folder that `RAYDSL_DATA` names.

use core::error::Error;
use core::f32::consts::FRAC_PI_3;
use std::path::PathBuf;

use raydsl::prelude::*;
use raydsl_examples::{cloud, mesh};

use crate::open::Scene;
use crate::visibility::Ball;

/// A file of the folder, if it is there.
fn file(name: &str) -> Result<PathBuf, Box<dyn Error>> {
    let folder = std::env::var_os("RAYDSL_DATA")
        .ok_or_else(|| format!("`{name}` is not there: RAYDSL_DATA names no folder"))?;
    let path = PathBuf::from(folder).join(name);
    path.is_file().then_some(path).ok_or_else(|| format!("RAYDSL_DATA holds no `{name}`").into())
}

/// The nave of the Sibenik cathedral, 40 units long. (Marko Dabrovic's model, from the McGuire
/// Computer Graphics Archive.)
pub(crate) fn scene() -> Result<Scene<Triangle>, Box<dyn Error>> {
    let primitives = mesh::load(&file("sibenik.tri")?)?;
    let (eye, target) = (vec3(-17.5, -9.0, 0.5), vec3(5.0, -10.0, -0.5));
    Ok(Scene { primitives, camera: Pinhole::new(eye, target, Vec3::Y, FRAC_PI_3), radius: 4.0 })
}

/// A stone lion that was scanned by laser, of balls that close its surface. (The sample of the
/// Potree viewer.)
pub(crate) fn scan() -> Result<Scene<Ball>, Box<dyn Error>> {
    let points = raydsl_io::cloud::load(&file("lion_takanawa.copc.laz")?, &mut |_, _| {})?;
    let scaled = cloud::scale(&points, None)?;
    let radius = f32::from(scaled.radius_code) / 255.0;
    let ball = |center: &[f32; 3]| Ball { center: Vec3::from_array(*center), radius };
    let view = cloud::suggested_view(&points);
    let place = |p: [f64; 3]| {
        let axis = |i: usize| ((p[i] - scaled.offset[i]) * scaled.scale) as f32;
        vec3(axis(0), axis(1), axis(2))
    };
    let up = Vec3::from_array(view.up.map(|c| c as f32));
    let angle = view.fov_y_degrees.to_radians() as f32;
    Ok(Scene {
        primitives: scaled.centers.iter().map(ball).collect(),
        camera: Pinhole::new(place(view.eye), place(view.target), up, angle),
        // What is within some twenty points.
        radius: 20.0 * radius,
    })
}
