//! Orthonormal frames.

use std::slice;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;

use super::largest;
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "frames",
    title: "Orthonormal frames around normals",
    clauses: &[
        "Dot products of axes and what their lengths differ from 1 are at most 4e-7; frames \
                are right-handed; the sign of a zero changes nothing.",
    ],
    rows,
};

#[kernel]
fn around(z: Vec3) -> Frame {
    Frame::around(z)
}

fn rows() -> Vec<Row> {
    vec![
        row("normals everywhere", |rng| rng.direction().normalize()),
        row("normals next to -z", |rng| {
            let size = 10f32.powf(rng.range(-20.0, -1.0));
            vec3(rng.range(-size, size), rng.range(-size, size), -1.0).normalize()
        }),
        row("normals next to the horizon", |rng| {
            let size = 10f32.powf(rng.range(-30.0, -1.0));
            vec3(rng.range(-1.0, 1.0), rng.range(-1.0, 1.0), rng.range(-size, size)).normalize()
        }),
        row("normals with zeros of both signs", |rng| {
            let flat = vec3(rng.range(-1.0, 1.0), rng.range(-1.0, 1.0), 0.0).normalize();
            let axis = rng.pick(&[Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z, flat]);
            let mut signed = |x: f32| if x == 0.0 { rng.pick(&[0.0, -0.0]) } else { x };
            vec3(signed(axis.x), signed(axis.y), signed(axis.z))
        }),
        row("zero normals: the axes x and y", |rng| {
            vec3(rng.pick(&[0.0, -0.0]), rng.pick(&[0.0, -0.0]), rng.pick(&[0.0, -0.0]))
        }),
    ]
}

/// The textbook is Frisvad ("Building an Orthonormal Basis from a 3D Unit Vector Without
/// Normalization", 2012).
fn row(name: &'static str, normal: fn(&mut Rng) -> Vec3) -> Row {
    Row::new(name, 1, Unit::Absolute, Bound::all(4e-7), move |run| {
        let kernel = Kernel::of::<around>();
        let make = |rng: &mut Rng| (normal(rng),);
        let outcome =
            run.measure(slice::from_ref(&kernel), make, |(z,), frame| Some(error(*z, frame)))?;
        let mut rng = Rng::new(run.seed);
        let errors = (0..run.count.clamp(1000, 1_000_000)).map(|_| {
            let z = normal(&mut rng);
            error(z, &frisvad(z))
        });
        Ok(outcome.beside(largest(errors)))
    })
}

fn error(normal: Vec3, frame: &Frame) -> f64 {
    if frame.z != normal || !(frame.x.is_finite() && frame.y.is_finite()) {
        return f64::INFINITY;
    }
    let [x, y, z] = [frame.x, frame.y, frame.z].map(Vec3::as_dvec3);
    let lengths = [x, y].map(|v| (v.length() - 1.0).abs());
    if normal == Vec3::ZERO {
        return lengths[0].max(lengths[1]).max(x.dot(y).abs());
    }
    let products = [x.dot(y), x.dot(z), y.dot(z)].map(f64::abs);
    let is_right_handed = x.cross(y).dot(z) > 0.999;
    let errors = lengths.into_iter().chain(products);
    if is_right_handed { largest(errors) } else { f64::INFINITY }
}

fn frisvad(n: Vec3) -> Frame {
    if n.z < -0.999_999_9 {
        return Frame { x: -Vec3::Y, y: -Vec3::X, z: n };
    }
    let a = 1.0 / (1.0 + n.z);
    let b = -n.x * n.y * a;
    let x = vec3(1.0 - n.x * n.x * a, b, -n.x);
    Frame { x, y: vec3(b, 1.0 - n.y * n.y * a, -n.y), z: n }
}
