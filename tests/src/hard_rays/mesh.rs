//! A closed mesh whose triangles share vertices bit for bit.

use raydsl::prelude::*;

use crate::rng::Rng;

/// A sphere of triangles, outside where their vertices run anticlockwise; closed and, as far as the
/// numbers there allow, convex.
#[derive(Clone, Debug)]
pub struct Icosphere {
    /// The middle.
    pub center: Vec3,
    /// The distance of the vertices from it.
    pub radius: f32,
    /// Where the vertices are.
    pub vertices: Vec<Vec3>,
    /// Three vertices each.
    pub faces: Vec<[u32; 3]>,
}

/// The corners of an icosahedron: a golden rectangle across each axis.
fn corners() -> Vec<Vec3> {
    let golden = f32::midpoint(1.0, 5.0f32.sqrt());
    let signs = [(-1.0, 1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    let mut all = Vec::new();
    all.extend(signs.map(|(a, b)| vec3(a, b * golden, 0.0)));
    all.extend(signs.map(|(a, b)| vec3(0.0, a, b * golden)));
    all.extend(signs.map(|(a, b)| vec3(b * golden, 0.0, a)));
    all.into_iter().map(Vec3::normalize).collect()
}

/// All threes of corners that are neighbours of one another, seen from outside anticlockwise.
fn icosahedron(corners: &[Vec3]) -> Vec<[u32; 3]> {
    let near = |a: usize, b: usize| corners[a].distance(corners[b]) < 1.1;
    let mut faces = Vec::new();
    for a in 0..corners.len() {
        for b in a + 1..corners.len() {
            for c in b + 1..corners.len() {
                if near(a, b) && near(b, c) && near(c, a) {
                    let out = corners[a].dot(corners[b].cross(corners[c])) > 0.0;
                    faces.push(if out { [a, b, c] } else { [a, c, b] }.map(|i| i as u32));
                }
            }
        }
    }
    faces
}

/// Each triangle becomes four; new vertices are pushed out to the unit sphere.
fn divided(vertices: &mut Vec<Vec3>, faces: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = std::collections::HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
            vertices.len() as u32 - 1
        })
    };
    let mut out = Vec::new();
    for &[a, b, c] in faces {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        out.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    out
}

impl Icosphere {
    /// 320 triangles.
    pub fn new(center: Vec3, radius: f32) -> Self {
        let mut vertices = corners();
        let mut faces = icosahedron(&vertices);
        for _ in 0..2 {
            faces = divided(&mut vertices, &faces);
        }
        vertices.iter_mut().for_each(|v| *v = center + *v * radius);
        Self { center, radius, vertices, faces }
    }

    /// One whose edges are about this long.
    pub fn with_edges(center: Vec3, length: f32) -> Self {
        Self::new(center, length * 3.2)
    }

    /// The triangles.
    pub fn triangles(&self) -> Vec<Triangle> {
        let triangle = |f: &[u32; 3]| {
            let [v0, v1, v2] = f.map(|i| self.vertices[i as usize]);
            Triangle { v0, v1, v2 }
        };
        self.faces.iter().map(triangle).collect()
    }

    /// A vertex, or a point of an edge as near as it can be written; and a normal there.
    pub fn seam(&self, rng: &mut Rng) -> (Vec3, Vec3) {
        let face = self.faces[rng.below(self.faces.len())];
        let corner = rng.below(3);
        let [a, b] = [face[corner], face[(corner + 1) % 3]].map(|i| self.vertices[i as usize]);
        let at = if rng.below(4) == 0 { a } else { a + (b - a) * rng.unit() };
        (at, (at - self.center).normalize())
    }

    /// A point of a triangle.
    pub fn point(&self, rng: &mut Rng) -> Vec3 {
        let [a, b, c] = self.faces[rng.below(self.faces.len())].map(|i| self.vertices[i as usize]);
        let (s, t) = (rng.unit(), rng.unit());
        let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
        a + ((b - a) * s + (c - a) * t)
    }

    /// A point well inside.
    pub fn inside(&self, rng: &mut Rng) -> Vec3 {
        self.center + rng.direction() * (0.7 * self.radius)
    }
}
