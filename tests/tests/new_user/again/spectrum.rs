//! A reflected spectrum as a colour. (enum with fields, zip, bare integers, computed index)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

#[derive(Clone, Copy, Type)]
enum Light {
    Flat(f32),
    Line { bin: i32, power: f32 },
    Table { first: usize },
}

#[kernel]
fn power(light: Light, tables: &[f32], bin: i32) -> f32 {
    match light {
        Light::Flat(power) => power,
        Light::Line { bin: at, power } if at == bin => power,
        Light::Line { .. } => 0.0,
        Light::Table { first } => tables[first + bin as usize],
    }
}

#[kernel]
fn seen(light: Light, tables: &[f32], reflectance: [f32; 4]) -> Vec3 {
    let red = [0.0, 0.1, 0.4, 0.9];
    let green = [0.1, 0.8, 0.5, 0.1];
    let blue = [0.9, 0.3, 0.0, 0.0];
    let mut color = Vec3::ZERO;
    for (i, r) in reflectance.iter().enumerate() {
        let light = power(light, tables, i as i32) * *r;
        color += vec3(red[i], green[i], blue[i]) * light;
    }
    color
}

#[kernel]
fn weight(a: [f32; 4], b: [f32; 4]) -> f32 {
    let mut sum = 0.0;
    for (x, y) in a.iter().zip(b.iter()).rev() {
        sum += x * y;
    }
    sum
}

#[test]
fn spectra_become_colours() {
    let lights = vec![
        Light::Flat(1.0),
        Light::Line { bin: 2, power: 3.0 },
        Light::Table { first: 0 },
        Light::Table { first: 4 },
    ];
    let tables: Vec<f32> = (0..8).map(|i| 0.25 * i as f32).collect();
    let kernel = kernel!(|i: u32, r: [f32; 4]| {
        let color = seen(lights[i as usize], &tables, r);
        color.extend(weight(r, [1.0, 0.5, 0.25, 0.125]))
    });
    let inputs: Vec<(u32, [f32; 4])> = (0..200)
        .map(|i| (i % 4, [0.1 * (i % 10) as f32, 0.5, 0.05 * (i % 17) as f32, 1.0]))
        .collect();
    assert_variants_agree!(&kernel, &inputs);
    let color = kernel.call((1, [1.0; 4]));
    assert_eq!(color.truncate(), vec3(0.4, 0.5, 0.0) * 3.0);
}
