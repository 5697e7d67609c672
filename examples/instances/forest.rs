//! A forest: two trees of triangles, a hundred of them to a stand, a hundred stands on hills.

use std::f32::consts::TAU;

use raydsl::bvh::{Group, InstanceError};
use raydsl::prelude::*;

/// A triangle with a colour.
#[primitive(triangle(v0, v1, v2))]
#[derive(Debug)]
pub(crate) struct Facet {
    /// Its corners.
    pub(crate) v0: Vec3,
    /// Its corners.
    pub(crate) v1: Vec3,
    /// Its corners.
    pub(crate) v2: Vec3,
    /// Red, green, blue, and whether it is a leaf.
    pub(crate) color: [Unorm8; 4],
}

/// Numbers from 0 to 1 that look random.
pub(crate) struct Noise(pub(crate) u32);

impl Noise {
    /// The next one.
    pub(crate) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(0x915F_77F5).wrapping_add(0x3C6E_F372);
        let mixed = (self.0 ^ self.0 >> 15).wrapping_mul(0x846C_A68B);
        ((mixed ^ mixed >> 16) >> 8) as f32 / 16_777_216.0
    }

    /// A number around 0.
    fn around(&mut self, size: f32) -> f32 {
        (2.0 * self.next() - 1.0) * size
    }

    fn direction(&mut self) -> Vec3 {
        let (y, angle) = (self.around(1.0), self.next() * TAU);
        let aside = (1.0 - y * y).sqrt();
        vec3(aside * angle.cos(), y, aside * angle.sin())
    }
}

fn facet([v0, v1, v2]: [Vec3; 3], color: [f32; 3], leaf: f32) -> Facet {
    let [r, g, b] = color;
    Facet { v0, v1, v2, color: [r, g, b, leaf].map(Unorm8::new) }
}

/// A trunk from below the ground, six-sided.
fn trunk(height: f32, radius: f32, color: [f32; 3]) -> Vec<Facet> {
    let foot = |i: u32| {
        let (sin, cos) = (i as f32 * TAU / 6.0).sin_cos();
        vec3(radius * cos, -0.6, radius * sin)
    };
    let side = |i| facet([foot(i), foot(i + 1), vec3(0.0, height, 0.0)], color, 0.0);
    (0..6).map(side).collect()
}

/// A fir of height 2: whorls of branches that hang, each of four blades.
pub(crate) fn fir() -> Vec<Facet> {
    let mut noise = Noise(1);
    let mut all = trunk(1.9, 0.06, [0.3, 0.2, 0.13]);
    for whorl in 0..26 {
        let share = whorl as f32 / 26.0;
        let (height, reach) = (0.22 + 1.75 * share, 0.56 * (1.0 - share).powf(0.8) + 0.05);
        for branch in 0..9 {
            let angle = (branch as f32 + noise.next()) * TAU / 9.0;
            let out = vec3(angle.cos(), 0.0, angle.sin());
            let aside = out.cross(Vec3::Y);
            let long = reach * (0.8 + 0.3 * noise.next());
            let from = Vec3::Y * height;
            let tip = from + out * long - Vec3::Y * (0.42 * long);
            let middle = from.lerp(tip, 0.5) + Vec3::Y * (0.06 * long);
            let green = 0.75 + 0.35 * noise.next();
            let color = [0.1 * green, 0.3 * green, 0.15 * green];
            for side in [-1.0, 1.0] {
                let edge = middle + aside * (0.22 * long * side) - Vec3::Y * (0.1 * long);
                all.push(facet([from, edge, middle], color, 1.0));
                all.push(facet([middle, edge, tip], color, 1.0));
            }
        }
    }
    all
}

/// A round tree of height 2: leaves on the outside of a dozen clumps.
pub(crate) fn beech() -> Vec<Facet> {
    let mut noise = Noise(2);
    let mut all = trunk(1.1, 0.09, [0.36, 0.3, 0.24]);
    for _ in 0..14 {
        let middle = vec3(0.0, 1.25, 0.0) + noise.direction() * vec3(0.42, 0.4, 0.42);
        let radius = 0.3 + 0.1 * noise.next();
        for _ in 0..130 {
            let out = noise.direction();
            let at = middle + out * (radius * (0.75 + 0.25 * noise.next()));
            // Leaves lie on the clump, more or less.
            let normal = (out + noise.direction() * 0.7).normalize();
            let (x, y) = normal.any_orthonormal_pair();
            let green = 0.8 + 0.4 * noise.next();
            let color = [0.28 * green, 0.44 * green, 0.1 * green];
            let corners = [at - x * 0.05, at + x * 0.05 - y * 0.03, at + y * 0.085];
            all.push(facet(corners, color, 1.0));
        }
    }
    all
}

/// How far the forest goes from the middle.
const REACH: f32 = 60.0;

/// The height of the hills.
pub(crate) fn hill(x: f32, z: f32) -> f32 {
    let long = 3.4 * (0.062 * x + 0.5).sin() * (0.071 * z).cos();
    long + 1.3 * (0.13 * x - 0.11 * z).sin() + 0.0009 * (x * x + z * z)
}

/// The hills in `n` by `n` squares, farther than the forest.
pub(crate) fn ground(n: i32) -> Vec<Facet> {
    let size = 2.2 * REACH / n as f32;
    let at = |i: i32, j: i32| {
        let (x, z) = ((i - n / 2) as f32 * size, (j - n / 2) as f32 * size);
        vec3(x, hill(x, z), z)
    };
    let square = |i: i32, j: i32| {
        let dry = 0.5 + 0.5 * (0.4 * i as f32).sin() * (0.31 * j as f32 + 1.0).cos();
        let color = [0.3 + 0.14 * dry, 0.38 + 0.05 * dry, 0.15];
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        [facet([a, c, b], color, 0.0), facet([a, d, c], color, 0.0)]
    };
    (0..n).flat_map(|j| (0..n).flat_map(move |i| square(i, j))).collect()
}

// ANCHOR: forest
/// `n` by `n` stands of `m` by `m` trees, and the group of all: `trees[0]` is the ground, the
/// others are what grows there.
pub(crate) fn forest<'a>(
    trees: &'a [Bvh<'a, Facet>],
    n: i32,
    m: i32,
) -> Result<(Instances<'a, Facet>, Group), InstanceError> {
    let mut scene = Instances::new(trees)?;
    let size = 2.0 * REACH / n as f32;
    let stand = stand(&mut Noise(3), trees.len() - 1, size, m);
    let stand = scene.group(&stand)?;
    let mut top = vec![Instance::new(0, Affine3::IDENTITY)];
    for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let place = |i: i32| (i as f32 + 0.5) * size - REACH;
        top.push(Instance::new(stand, on_hill(place(i), place(j), i + 3 * j)));
    }
    let top = scene.group(&top)?;
    Ok((scene, top))
}

/// A square on the ground: it is turned by quarters, and sheared along the slope, so that trunks
/// stay upright.
fn on_hill(x: f32, z: f32, quarters: i32) -> Affine3 {
    let slope = |dx: f32, dz: f32| (hill(x + dx, z + dz) - hill(x - dx, z - dz)) / 2.0;
    let shear =
        Mat3::from_cols(vec3(1.0, slope(1.0, 0.0), 0.0), Vec3::Y, vec3(0.0, slope(0.0, 1.0), 1.0));
    let turn = Mat3::from_rotation_y(quarters as f32 * TAU / 4.0);
    Affine3 { matrix3: shear * turn, translation: vec3(x, hill(x, z), z) }
}
// ANCHOR_END: forest

/// Trees in a square of this size.
fn stand(noise: &mut Noise, kinds: usize, size: f32, m: i32) -> Vec<Instance> {
    let step = size / m as f32;
    let mut tree = |i: i32, j: i32| {
        let mut place = |i: i32| (i as f32 + 0.5 + noise.around(0.45)) * step - size / 2.0;
        let at = vec3(place(i), 0.0, place(j));
        // Kinds grow together.
        let chance = noise.next() * 0.7 + if (at.x + 0.5 * at.z).sin() > 0.0 { 0.3 } else { 0.0 };
        let kind = ((chance * kinds as f32) as usize).min(kinds - 1);
        let tall = 0.55 + 0.5 * noise.next();
        let wide = tall * (0.85 + 0.3 * noise.next());
        let turn = Mat3::from_rotation_y(noise.next() * TAU);
        let matrix3 = turn * Mat3::from_diagonal(vec3(wide, tall, wide));
        Instance::new(1 + kind, Affine3 { matrix3, translation: at })
    };
    (0..m).flat_map(|j| (0..m).map(move |i| (i, j))).map(|(i, j)| tree(i, j)).collect()
}
