//! Ordinary Rust that kernels take: loops over several lists, functions of types, parts of variables
//! by reference, and traits on enums with fields.

mod calls;
mod closures;
mod conditions;
mod loops;

use raydsl::prelude::*;
use raydsl::{Type, assert_variants_agree, kernel};

#[kernel]
fn over_lists(weights: &[f32], places: &[Vec3], x: f32) -> f32 {
    let mut sum = x;
    for (weight, place) in weights.iter().zip(places.iter()) {
        sum += weight * place.x;
    }
    for weight in weights.iter().rev() {
        sum = sum * 0.5 + weight;
    }
    for (i, weight) in weights.iter().rev().enumerate() {
        sum += i as f32 * weight;
    }
    for (i, weight) in weights.iter().enumerate().rev() {
        sum = sum * 0.9 - i as f32 * weight;
    }
    for (i, (weight, place)) in weights.iter().zip(places).enumerate() {
        sum += i as f32 * weight * place.y;
    }
    for (a, b) in [1.0, 2.0, 3.0].iter().zip([4.0, 5.0].iter().rev()) {
        sum += a * b;
    }
    sum
}

#[kernel]
fn functions_of_types(x: f32, y: f32, n: u32, k: i32) -> f32 {
    let low = f32::min(x, y);
    let high = f32::max(x, y).abs();
    let inside = f32::clamp(x, -0.5, 0.5);
    let larger = u32::max(n, 7);
    let size = i32::abs(k);
    low + high + inside + f32::abs(y) + larger as f32 + size as f32
}

#[kernel]
fn add(to: &mut f32, x: f32) {
    *to += x;
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Cell {
    sum: f32,
    count: u32,
}

#[kernel]
fn count(cell: &mut Cell, x: f32) {
    cell.sum += x;
    cell.count += 1;
}

#[kernel]
fn histogram(x: f32, y: f32) -> [Cell; 4] {
    let mut cells = [Cell { sum: 0.0, count: 0 }; 4];
    let values = [x, y, x + y, x - y];
    for v in values {
        let i = (v * 2.0 + 2.0).clamp(0.0, 3.0) as usize;
        count(&mut cells[i], v);
        add(&mut cells[(i + 1) % 4].sum, 0.25);
    }
    cells
}

#[kernel]
trait Light {
    fn shine(&self, at: Vec3) -> f32;

    fn twice(&self, at: Vec3) -> f32 {
        2.0 * self.shine(at)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Lamp {
    place: Vec3,
    power: f32,
}

#[kernel]
impl Light for Lamp {
    fn shine(&self, at: Vec3) -> f32 {
        self.power / (1.0 + (self.place - at).length_squared())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
enum AnyLight {
    Lamp(Lamp),
    Sky { up: Vec3, strength: f32 },
    Off,
}

#[kernel]
impl Light for AnyLight {
    fn shine(&self, at: Vec3) -> f32 {
        match *self {
            Self::Lamp(lamp) => lamp.shine(at),
            Self::Sky { up, strength } => {
                if strength <= 0.0 {
                    return 0.0;
                }
                at.dot(up).max(0.0) * strength
            }
            Self::Off => 0.0,
        }
    }
}

#[kernel]
fn lit<L: Light>(light: L, at: Vec3) -> f32 {
    light.shine(at) + L::twice(&light, at)
}

#[kernel]
fn made(x: f32, y: f32) -> AnyLight {
    if x < 0.0 {
        return AnyLight::Off;
    }
    if y > 0.5 {
        AnyLight::Sky { up: vec3(0.0, 1.0, 0.0), strength: y }
    } else {
        AnyLight::Lamp(Lamp { place: vec3(x, y, 0.0), power: 2.0 })
    }
}

#[kernel]
fn all_light(x: f32, y: f32) -> f32 {
    let at = vec3(x, y, 1.0);
    let light = made(x, y);
    lit::<AnyLight>(light, at) + lit::<Lamp>(Lamp { place: at, power: x }, at)
}

fn pairs() -> Vec<(f32, f32)> {
    (0..70).map(|i| (i as f32 * 0.05 - 1.2, (i * 7 % 40) as f32 * 0.06 - 1.0)).collect()
}

#[test]
fn lists() {
    let weights: Vec<f32> = (0..7).map(|i| i as f32 * 0.3).collect();
    let places: Vec<Vec3> = (0..5).map(|i| vec3(i as f32, 1.0, 0.5)).collect();
    let kernel = kernel!(|x: f32| over_lists(&weights, &places, x));
    let inputs: Vec<(f32,)> = (0..50).map(|i| (i as f32 * 0.1 - 2.0,)).collect();
    assert_variants_agree!(&kernel, &inputs);
    let none: &[f32] = &[];
    let empty = kernel!(|x: f32| over_lists(none, &places, x));
    assert_variants_agree!(&empty, &inputs);
}

#[test]
fn calls() {
    let inputs: Vec<(f32, f32, u32, i32)> = pairs()
        .into_iter()
        .enumerate()
        .map(|(i, (x, y))| (x, y, i as u32, i as i32 - 30))
        .collect();
    assert_variants_agree!(functions_of_types, &inputs);
    assert_variants_agree!(histogram, &pairs());
}

#[test]
fn traits_on_enums() {
    assert_variants_agree!(made, &pairs());
    assert_variants_agree!(all_light, &pairs());
    let lights = [
        AnyLight::Off,
        AnyLight::Sky { up: Vec3::Y, strength: 0.7 },
        AnyLight::Lamp(Lamp { place: Vec3::ONE, power: 3.0 }),
    ];
    let kernel = kernel!(|x: f32, y: f32| {
        let mut sum = 0.0;
        for light in &lights {
            sum += light.shine(vec3(x, y, 0.5));
        }
        sum
    });
    assert_variants_agree!(&kernel, &pairs());
}
