//! Which tetrahedra share a face, and which way round they are.

use glam::UVec4;

use super::face::CellFace;
use super::mesh::{NONE, Tetrahedron};

/// Places of the vertices of the face that lacks each vertex: with that vertex behind it, it is
/// oriented as the tetrahedron.
const FACES: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// Returns the vertices of a face.
fn face(vertices: UVec4, lacking: usize) -> [u32; 3] {
    FACES[lacking].map(|i| vertices[i])
}

/// Returns a face's vertices sorted, and whether they were an odd permutation of that.
fn sorted([mut a, mut b, mut c]: [u32; 3]) -> ([u32; 3], bool) {
    let mut is_odd = false;
    for _ in 0..2 {
        if a > b {
            (a, b, is_odd) = (b, a, !is_odd);
        }
        if b > c {
            (b, c, is_odd) = (c, b, !is_odd);
        }
    }
    ([a, b, c], is_odd)
}

/// Joins the tetrahedra that share a face; where more than two do, none.
pub(super) fn join(all: &mut [Tetrahedron]) {
    let mut faces = Vec::with_capacity(all.len() * 4);
    for (i, t) in all.iter().enumerate() {
        for lacking in 0..4 {
            faces.push((sorted(face(t.vertices, lacking)).0, (i * 4 + lacking) as u32));
        }
    }
    faces.sort_unstable();
    for same in faces.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, a), (_, b)] = same {
            *across(all, *a) = *b;
            *across(all, *b) = *a;
        }
    }
}

/// Returns what is across a face, which is told by four times its tetrahedron plus its place.
fn across(all: &mut [Tetrahedron], face: u32) -> &mut u32 {
    &mut all[(face / 4) as usize].across[(face % 4) as usize]
}

/// Turns tetrahedra so that all that are joined are oriented alike, and their volume is positive in
/// all. Where that contradicts itself, as around a ring with a twist, they are cut apart.
///
/// So a ray that passes through a face of two leaves the one and enters the other, whatever
/// rounding makes of their volumes.
pub(super) fn orient(all: &mut [Tetrahedron], volume: impl Fn(UVec4) -> f64) {
    let mut turned: Vec<Option<bool>> = vec![None; all.len()];
    let mut is_turned = vec![false; all.len()];
    for first in 0..all.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let (mut component, mut next) = (vec![first], 0);
        while let Some(&i) = component.get(next) {
            next += 1;
            for lacking in 0..4 {
                let there = all[i].across[lacking];
                if there == NONE {
                    continue;
                }
                let (j, other) = ((there / 4) as usize, (there % 4) as usize);
                let is_odd = |t: usize, lacking| sorted(face(all[t].vertices, lacking)).1;
                // Two that are oriented alike see their face from both sides.
                let differs = is_odd(i, lacking) == is_odd(j, other);
                let expected = (turned[i] == Some(true)) != differs;
                match turned[j] {
                    None => {
                        turned[j] = Some(expected);
                        component.push(j);
                    }
                    Some(found) if found != expected => {
                        all[i].across[lacking] = NONE;
                        all[j].across[other] = NONE;
                    }
                    Some(_) => {}
                }
            }
        }
        let signed = |i: &usize| {
            let v = volume(all[*i].vertices);
            if turned[*i] == Some(true) { -v } else { v }
        };
        let is_negative = component.iter().map(signed).sum::<f64>() < 0.0;
        for i in component {
            is_turned[i] = (turned[i] == Some(true)) != is_negative;
        }
    }
    turn(all, &is_turned);
}

/// Swaps the first two vertices of those that are to be turned.
fn turn(all: &mut [Tetrahedron], is_turned: &[bool]) {
    for (t, turns) in all.iter_mut().zip(is_turned) {
        let moved = |code: u32| match code {
            NONE => NONE,
            code if is_turned[(code / 4) as usize] && code % 4 < 2 => code ^ 1,
            code => code,
        };
        t.across = UVec4::from(t.across.to_array().map(moved));
        if *turns {
            t.vertices = UVec4::new(t.vertices.y, t.vertices.x, t.vertices.z, t.vertices.w);
            t.across = UVec4::new(t.across.y, t.across.x, t.across.z, t.across.w);
        }
    }
}

/// Returns the faces without a neighbour.
pub(super) fn outer_faces(all: &[Tetrahedron]) -> Vec<CellFace> {
    let mut faces = Vec::new();
    for (i, t) in all.iter().enumerate() {
        for lacking in 0..4 {
            if t.across[lacking] == NONE {
                let cell = (i * 4 + lacking) as u32;
                faces.push(CellFace { vertices: face(t.vertices, lacking), cell });
            }
        }
    }
    faces
}
