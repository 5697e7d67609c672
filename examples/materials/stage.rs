//! What the materials are shown on: a ball on a floor, under an environment.

use std::error::Error;
use std::path::PathBuf;

use raydsl::light::Environment;
use raydsl::prelude::*;
use raydsl_examples::model::Model;

/// Returns the file of this name in the folder of data, if there is one.
fn data(name: &str) -> Option<PathBuf> {
    let file = PathBuf::from(std::env::var_os("RAYDSL_DATA")?).join(name);
    file.exists().then_some(file)
}

/// The mesh of a file, or else a ball with a ring, made here.
pub(crate) fn model(file: Option<PathBuf>) -> Result<Model, Box<dyn Error>> {
    let Some(file) = file.or_else(|| data("shader_ball.glb")) else {
        println!("no FILE, and no shader_ball.glb in RAYDSL_DATA: a ball with a ring instead");
        return Ok(ball_with_ring());
    };
    Ok(Model::new(&raydsl_io::scene::load(&file)?))
}

/// A ball of radius 3 with its centre 4 above the floor, and a ring under it.
fn ball_with_ring() -> Model {
    let mut model = Model::default();
    let mut add = |rows: u32, columns: u32, at: &dyn Fn(f32, f32) -> (Vec3, Vec3)| {
        let first = model.positions.len() as u32;
        for i in 0..=rows {
            for j in 0..=columns {
                let (p, n) = at(i as f32 / rows as f32, j as f32 / columns as f32);
                model.positions.push(p);
                model.normals.push(n);
            }
        }
        let vertex = |i, j| first + i * (columns + 1) + j;
        for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
            let [a, b, c, d] =
                [vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j)];
            model
                .triangles
                .extend([[a, b, c], [a, c, d]].map(|vertices| IndexedTriangle { vertices }));
        }
    };
    let turn = std::f32::consts::TAU;
    add(96, 192, &|v, u| {
        let ((sv, cv), (su, cu)) = ((0.5 * turn * v).sin_cos(), (turn * u).sin_cos());
        let n = vec3(sv * su, cv, sv * cu);
        (vec3(0.0, 4.0, 0.0) + n * 3.0, n)
    });
    add(48, 192, &|v, u| {
        let ((sv, cv), (su, cu)) = ((turn * v).sin_cos(), (turn * u).sin_cos());
        let n = vec3(cv * su, sv, cv * cu);
        (vec3(2.4 * su, 0.6, 2.4 * cu) + n * 0.6, n)
    });
    model
}

/// The environment of a file, or else a sky with a sun, made here.
pub(crate) fn environment(file: Option<PathBuf>) -> Result<Environment, Box<dyn Error>> {
    if let Some(file) = file.or_else(|| data("chinese_garden_1k.hdr")) {
        let picture = raydsl_io::environment::load(&file)?;
        return Ok(Environment::new(&picture.texels, uvec2(picture.width, picture.height))?);
    }
    println!("no environment, and no chinese_garden_1k.hdr in RAYDSL_DATA: a plain sky instead");
    let size = uvec2(256, 128);
    let sun = vec3(0.5, 0.6, 0.6).normalize();
    let texel = |i: u32| {
        let down = std::f32::consts::PI * ((i / size.x) as f32 + 0.5) / size.y as f32;
        let turn = std::f32::consts::TAU * ((i % size.x) as f32 + 0.5) / size.x as f32;
        let up = down.cos();
        let direction = vec3(-turn.sin() * down.sin(), up, turn.cos() * down.sin());
        let sky = vec3(0.08, 0.15, 0.32).lerp(Vec3::splat(0.4), (1.0 - up.abs()).powi(3));
        let ground = Vec3::splat(0.06);
        let light = if direction.dot(sun) > 0.995 { Vec3::splat(80.0) } else { Vec3::ZERO };
        if up > 0.0 { sky + light } else { ground }
    };
    let texels: Vec<Vec3> = (0..size.x * size.y).map(texel).collect();
    Ok(Environment::new(&texels, size)?)
}
