//! Meshes of cells that fill a box, of all kinds and in any order.

use raydsl::prelude::*;
use raydsl::volume::cells::CellKind;
use raydsl_tests::rng::Rng;

/// Points, and cells over them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cells {
    pub(crate) points: Vec<Vec3>,
    pub(crate) vertices: Vec<u32>,
    pub(crate) kinds: Vec<CellKind>,
}

impl Cells {
    pub(crate) fn push(&mut self, kind: CellKind, vertices: &[u32]) {
        assert_eq!(kind.vertices(), vertices.len());
        self.vertices.extend(vertices);
        self.kinds.push(kind);
    }

    /// Adds another mesh that shares no point with this one.
    pub(crate) fn append(&mut self, other: &Self) {
        let first = self.points.len() as u32;
        self.points.extend(&other.points);
        self.vertices.extend(other.vertices.iter().map(|v| v + first));
        self.kinds.extend(&other.kinds);
    }

    pub(crate) fn moved(mut self, by: Vec3) -> Self {
        self.points.iter_mut().for_each(|p| *p += by);
        self
    }

    /// Gives points other indices.
    fn shuffled(mut self, rng: &mut Rng) -> Self {
        let order = rng.permutation(self.points.len());
        let mut points = vec![Vec3::ZERO; order.len()];
        for (from, to) in order.iter().enumerate() {
            points[*to] = self.points[from];
        }
        self.points = points;
        self.vertices.iter_mut().for_each(|v| *v = order[*v as usize] as u32);
        self
    }
}

/// Which cells fill a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fill {
    Hexahedra,
    /// All kinds, side by side.
    Mixed,
}

/// Cells that fill the box from 0 to `size`, whose inner points are moved by up to `jitter` of a
/// cell; those of its sides stay on them.
pub(crate) fn filled(size: UVec3, fill: Fill, jitter: f32, rng: &mut Rng) -> Cells {
    let count = size + 1;
    let mut cells = Cells::default();
    for i in 0..count.x * count.y * count.z {
        let at = uvec3(i % count.x, i / count.x % count.y, i / (count.x * count.y));
        let is_inner = Vec3::select(at.cmpgt(UVec3::ZERO) & at.cmplt(size), Vec3::ONE, Vec3::ZERO);
        cells.points.push(at.as_vec3() + rng.point(jitter) * is_inner);
    }
    let index = |x: u32, y: u32, z: u32| x + count.x * (y + count.y * z);
    for i in 0..size.x * size.y * size.z {
        let (x, y, z) = (i % size.x, i / size.x % size.y, i / (size.x * size.y));
        let ring =
            |z| [index(x, y, z), index(x + 1, y, z), index(x + 1, y + 1, z), index(x, y + 1, z)];
        let ([a, b, c, d], [e, f, g, h]) = (ring(z), ring(z + 1));
        let corners = [a, b, c, d, e, f, g, h];
        if fill == Fill::Hexahedra {
            cells.push(CellKind::Hexahedron, &corners);
        } else if (x + y) % 3 == 0 {
            // A column of wedges: all divide their ends alike.
            cells.push(CellKind::Wedge, &[a, b, c, e, f, g]);
            cells.push(CellKind::Wedge, &[a, c, d, e, g, h]);
        } else {
            match rng.below(3) {
                0 => cells.push(CellKind::Hexahedron, &corners),
                kind => pyramids(&mut cells, corners, kind == 1),
            }
        }
    }
    let cells = shuffled_whole(cells, rng);
    assert_eq!(cells.kinds.iter().map(|k| k.vertices()).sum::<usize>(), cells.vertices.len());
    cells
}

/// Shuffles points; tetrahedra that were made of pyramids before divide theirs by the new order.
fn shuffled_whole(cells: Cells, rng: &mut Rng) -> Cells {
    let mut cells = cells.shuffled(rng);
    let (mut vertices, mut kinds) = (Vec::new(), Vec::new());
    let mut rest = &cells.vertices[..];
    let mut is_whole = true;
    for kind in &cells.kinds {
        let (own, others) = rest.split_at(kind.vertices());
        rest = others;
        if *kind == CellKind::Pyramid && !is_whole {
            let low = (0..4).min_by_key(|i| own[*i]).expect("four");
            let at = |i: usize| own[(low + i) % 4];
            vertices.extend([at(0), at(1), at(2), own[4], at(2), at(3), at(0), own[4]]);
            kinds.extend([CellKind::Tetrahedron; 2]);
        } else {
            vertices.extend(own);
            kinds.push(*kind);
        }
        is_whole = *kind != CellKind::Pyramid || !is_whole;
    }
    (cells.vertices, cells.kinds) = (vertices, kinds);
    cells
}

/// Six pyramids from the middle of a hexahedron, some turned over: cells have no orientation.
fn pyramids(cells: &mut Cells, corners: [u32; 8], is_turned: bool) {
    let middle = corners.iter().map(|i| cells.points[*i as usize]).sum::<Vec3>() / 8.0;
    let apex = cells.points.len() as u32;
    cells.points.push(middle);
    let faces =
        [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    for face in faces {
        let [a, b, c, d] = face.map(|i: usize| corners[i]);
        let base = if is_turned { [d, c, b, a] } else { [a, b, c, d] };
        cells.push(CellKind::Pyramid, &[base[0], base[1], base[2], base[3], apex]);
    }
}

/// Rays at points, edges and faces of a mesh, from all sides, some along the axes.
pub(crate) fn rays(cells: &Cells, count: usize, rng: &mut Rng) -> Vec<Ray> {
    let mut rest = &cells.vertices[..];
    let mut all = Vec::new();
    for kind in &cells.kinds {
        let (own, others) = rest.split_at(kind.vertices());
        rest = others;
        all.push(own.iter().map(|i| cells.points[*i as usize]).collect::<Vec<_>>());
    }
    let far = cells.points.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max) * 2.0;
    (0..count)
        .map(|i| {
            let cell = &all[rng.below(all.len())];
            let mut corner = || cell[rng.below(cell.len())];
            let target = match i % 4 {
                0 => corner(),
                1 => (corner() + corner()) * 0.5,
                2 => (corner() + corner() + corner()) / 3.0,
                _ => corner().lerp(corner(), 0.3),
            };
            let direction = match i % 3 {
                0 => rng.pick(&[Vec3::X, Vec3::NEG_Y, Vec3::Z, vec3(1.0, 1.0, 0.0), Vec3::ONE]),
                1 => (target - corner_of(cell, rng)).normalize_or(Vec3::X),
                _ => rng.direction().normalize(),
            };
            Ray::new(target - direction * far, direction)
        })
        .collect()
}

fn corner_of(cell: &[Vec3], rng: &mut Rng) -> Vec3 {
    cell[rng.below(cell.len())]
}
