//! Wavefront OBJ.

use std::collections::HashMap;

use glam::Vec3;

use crate::error::word_text;
use crate::mesh::{Mesh, fan};
use crate::source::Source;
use crate::{LoadError, Place};

pub(crate) const REMEDY: &str =
    "correct the line, or write the file again, for example with Blender";
/// Stands for the normal of a corner that has none.
const NONE: u32 = u32::MAX;

pub(crate) fn read(mut source: Source) -> Result<Mesh, LoadError> {
    let (mut obj, mut line) = (Obj::default(), Vec::new());
    while source.next_line(&mut line)? {
        obj.add(&line, source.line).map_err(|what| source.bad_line(what, REMEDY))?;
    }
    obj.finish().map_err(|(line, what)| source.corrupt(Place::Line(line), what, REMEDY))
}

/// A corner of a face: indices of its vertex and its normal.
#[derive(Clone, Copy, Default)]
struct Corner {
    vertex: u32,
    normal: u32,
}

/// The statements so far.
#[derive(Default)]
struct Obj {
    vertices: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[Corner; 3]>,
    /// The corners of the face that is read.
    polygon: Vec<Corner>,
    /// The greatest index of a vertex and of a normal, which may come later, and its line.
    greatest: [Option<(u32, u64)>; 2],
}

impl Obj {
    fn add(&mut self, line: &[u8], number: u64) -> Result<(), String> {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next() {
            Some(b"v") => self.vertices.push(vector(words)?),
            Some(b"vn") => self.normals.push(vector(words)?),
            Some(b"f") => self.add_face(words, number)?,
            _ => {}
        }
        Ok(())
    }

    fn add_face<'a>(
        &mut self,
        words: impl Iterator<Item = &'a [u8]>,
        number: u64,
    ) -> Result<(), String> {
        self.polygon.clear();
        for word in words.take_while(|word| !word.starts_with(b"#")) {
            let corner = self.corner(word)?;
            self.polygon.push(corner);
            for (greatest, index) in self.greatest.iter_mut().zip([corner.vertex, corner.normal]) {
                if index != NONE && greatest.is_none_or(|(most, _)| index > most) {
                    *greatest = Some((index, number));
                }
            }
        }
        self.triangles.extend(fan(&self.polygon));
        Ok(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&self, word: &[u8]) -> Result<Corner, String> {
        let mut parts = word.split(|b| *b == b'/');
        let vertex = index(parts.next().unwrap_or_default(), self.vertices.len(), "vertex")?;
        let normal = match parts.nth(1) {
            Some(part) if !part.is_empty() => index(part, self.normals.len(), "normal")?,
            _ => NONE,
        };
        Ok(Corner { vertex, normal })
    }

    /// The mesh, or a line and what is wrong with it.
    fn finish(self) -> Result<Mesh, (u64, String)> {
        let Self { vertices, normals, triangles, greatest, .. } = self;
        let counts = [(vertices.len(), "vertices"), (normals.len(), "normals")];
        for (greatest, (count, what)) in greatest.into_iter().zip(counts) {
            if let Some((index, line)) = greatest.filter(|(index, _)| *index as usize >= count) {
                let number = u64::from(index) + 1;
                return Err((line, format!("{number} is none of the {count} {what}")));
            }
        }
        if normals.is_empty() || triangles.iter().flatten().any(|c| c.normal == NONE) {
            let triangles = triangles.iter().map(|t| t.map(|c| c.vertex)).collect();
            return Ok(Mesh { vertices, normals: Vec::new(), triangles });
        }
        Ok(joined(&vertices, &normals, &triangles))
    }
}

/// One vertex for each pair of a vertex and a normal, in order of first use.
fn joined(vertices: &[Vec3], normals: &[Vec3], triangles: &[[Corner; 3]]) -> Mesh {
    let mut mesh = Mesh::default();
    let mut known = HashMap::new();
    for triangle in triangles {
        let indices = triangle.map(|Corner { vertex, normal }| {
            *known.entry((vertex, normal)).or_insert_with(|| {
                mesh.vertices.push(vertices[vertex as usize]);
                mesh.normals.push(normals[normal as usize]);
                (mesh.vertices.len() - 1) as u32
            })
        });
        mesh.triangles.push(indices);
    }
    mesh
}

/// Three numbers; what follows them is passed over.
pub(crate) fn vector<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> Result<Vec3, String> {
    let mut number = || -> Result<f32, String> {
        let word = words.next().ok_or("it has fewer than three numbers")?;
        let value = str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        value.ok_or_else(|| format!("'{}' is no number", word_text(word)))
    };
    Ok(Vec3::new(number()?, number()?, number()?))
}

/// An index from 0. In the file it counts from 1, or back from the last that came before.
pub(crate) fn index(word: &[u8], count: usize, what: &str) -> Result<u32, String> {
    let number = str::from_utf8(word).ok().and_then(|word| word.parse::<i64>().ok());
    let Some(number) = number else {
        return Err(format!("'{}' is no index of a {what}", word_text(word)));
    };
    let index = if number < 0 { number.checked_add(count as i64) } else { Some(number - 1) };
    let index = index.and_then(|i| u32::try_from(i).ok()).filter(|i| *i != NONE);
    index.ok_or_else(|| format!("{number} is no {what}: {count} come before this line"))
}
