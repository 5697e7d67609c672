//! Wavefront OBJ, with materials.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use glam::{Affine3A, Vec2, Vec3, Vec4};

use super::mtl::{self, Library};
use super::{Instance, Scene, SceneMesh, check_finite, name};
use crate::error::word_text;
use crate::mesh::{SPLIT, fan};
use crate::obj::{REMEDY, index, vector};
use crate::source::Source;
use crate::{LoadError, Place};

/// Stands for what a corner does not have.
const NONE: u32 = u32::MAX;
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

pub(super) fn read(mut source: Source) -> Result<Scene, LoadError> {
    let (mut obj, mut line) = (Obj::new(&source), Vec::new());
    while source.next_line(&mut line)? {
        obj.add(&source, &line)?;
    }
    obj.finish(&source)
}

/// A corner of a face: indices of its vertex, its texture coordinate and its normal.
type Corner = [u32; 3];

/// The triangles of one object, group and material.
struct Part {
    name: String,
    material: Option<usize>,
    triangles: Vec<[Corner; 3]>,
}

/// The statements so far.
struct Obj {
    positions: Vec<Vec3>,
    /// One for each position, once there is any.
    colors: Vec<Vec4>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    library: Library,
    object: String,
    group: String,
    material: Option<usize>,
    parts: Vec<Part>,
    known: HashMap<(String, String, Option<usize>), usize>,
    /// The part that faces are added to; none after a statement that changes it.
    part: Option<usize>,
    polygon: Vec<Corner>,
    /// The greatest index of each kind, which may come later, and its line.
    greatest: [Option<(u32, u64)>; 3],
}

impl Obj {
    fn new(source: &Source) -> Self {
        Self {
            positions: Vec::new(),
            colors: Vec::new(),
            uvs: Vec::new(),
            normals: Vec::new(),
            library: Library::new(source),
            object: String::new(),
            group: String::new(),
            material: None,
            parts: Vec::new(),
            known: HashMap::new(),
            part: None,
            polygon: Vec::new(),
            greatest: [None; 3],
        }
    }

    fn add(&mut self, source: &Source, line: &[u8]) -> Result<(), LoadError> {
        let line = mtl::without_comment(line);
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let rest = || mtl::rest(line);
        let wrong = |what: String| source.bad_line(what, REMEDY);
        match words.next() {
            Some(b"v") => self.add_vertex(words).map_err(wrong)?,
            Some(b"vt") => self.add_uv(words).map_err(wrong)?,
            Some(b"vn") => self.normals.push(vector(words).map_err(wrong)?),
            Some(b"f") => self.add_face(words, source.line).map_err(wrong)?,
            Some(b"o") => (self.object, self.part) = (name(Some(&rest())), None),
            Some(b"g") => (self.group, self.part) = (name(Some(&rest())), None),
            Some(b"mtllib") => self.library.load(source, &rest())?,
            Some(b"usemtl") => {
                let material = self.library.find(&rest());
                if material.is_none() {
                    let what = format!("'{}' is no material", word_text(rest().as_bytes()));
                    let remedy = "name the MTL file that has it in a line `mtllib` before this one";
                    return Err(source.bad_line(what, remedy));
                }
                (self.material, self.part) = (material, None);
            }
            _ => {}
        }
        Ok(())
    }

    fn add_vertex<'a>(
        &mut self,
        words: impl Iterator<Item = &'a [u8]> + Clone,
    ) -> Result<(), String> {
        self.positions.push(vector(words.clone())?);
        if words.clone().count() >= 6 {
            self.colors.resize(self.positions.len() - 1, Vec4::ONE);
            self.colors.push(vector(words.skip(3))?.extend(1.0));
        } else if !self.colors.is_empty() {
            self.colors.push(Vec4::ONE);
        }
        Ok(())
    }

    fn add_uv<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>) -> Result<(), String> {
        // The second number may be left out, which stands for 0.
        let Vec3 { x: u, y: v, .. } = vector(words.take(2).chain([&b"0"[..], b"0"]))?;
        self.uvs.push(Vec2::new(u, 1.0 - v));
        Ok(())
    }

    fn add_face<'a>(
        &mut self,
        words: impl Iterator<Item = &'a [u8]>,
        line: u64,
    ) -> Result<(), String> {
        self.polygon.clear();
        for word in words {
            let corner = self.corner(word)?;
            for (greatest, index) in self.greatest.iter_mut().zip(corner) {
                if index != NONE && greatest.is_none_or(|(most, _)| index > most) {
                    *greatest = Some((index, line));
                }
            }
            self.polygon.push(corner);
        }
        let part = self.part();
        self.parts[part].triangles.extend(fan(&self.polygon));
        Ok(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&self, word: &[u8]) -> Result<Corner, String> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let mut parts = word.split(|b| *b == b'/');
        let mut corner = [NONE; 3];
        for (i, corner) in corner.iter_mut().enumerate() {
            let part = parts.next().unwrap_or_default();
            // Each corner has a vertex.
            if i == 0 || !part.is_empty() {
                *corner = index(part, counts[i], KINDS[i])?;
            }
        }
        Ok(corner)
    }

    fn part(&mut self) -> usize {
        if let Some(part) = self.part {
            return part;
        }
        let key = (self.object.clone(), self.group.clone(), self.material);
        let part = match self.known.entry(key) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(new) => {
                let (object, group, material) = new.key();
                let name = if object.is_empty() { group } else { object }.clone();
                self.parts.push(Part { name, material: *material, triangles: Vec::new() });
                *new.insert(self.parts.len() - 1)
            }
        };
        self.part = Some(part);
        part
    }

    fn finish(mut self, source: &Source) -> Result<Scene, LoadError> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        for ((greatest, count), what) in self.greatest.into_iter().zip(counts).zip(KINDS) {
            let Some((index, line)) = greatest.filter(|(index, _)| *index as usize >= count) else {
                continue;
            };
            let what = format!("{} is no {what}: there are {count}", u64::from(index) + 1);
            return Err(source.corrupt(Place::Line(line), what, REMEDY));
        }
        let parts = std::mem::take(&mut self.parts);
        let (mut materials, images) = self.library.take();
        let mut scene = Scene { images, ..Scene::default() };
        for part in parts.into_iter().filter(|part| !part.triangles.is_empty()) {
            let mut mesh = self.mesh(&part);
            check(&mesh, source)?;
            // Only meshes before the first `usemtl` have no material.
            mesh.material = part.material.unwrap_or(materials.len());
            scene.meshes.push(mesh);
        }
        if scene.meshes.iter().any(|mesh| mesh.material == materials.len()) {
            materials.push(mtl::blank());
        }
        scene.materials = materials;
        let place = |(mesh, m): (usize, &SceneMesh)| Instance {
            name: m.name.clone(),
            mesh,
            transform: Affine3A::IDENTITY,
        };
        scene.instances = scene.meshes.iter().enumerate().map(place).collect();
        Ok(scene)
    }

    /// One vertex for each corner that differs, in order of first use. What not all corners have,
    /// none has.
    fn mesh(&self, part: &Part) -> SceneMesh {
        let all_have = |kind: usize| part.triangles.as_flattened().iter().all(|c| c[kind] != NONE);
        let (has_uvs, has_normals) = (all_have(1), all_have(2));
        let mut mesh = SceneMesh { name: part.name.clone(), ..SceneMesh::default() };
        let mut known = HashMap::new();
        for triangle in &part.triangles {
            let indices = triangle.map(|[v, t, n]| {
                let key = [v, if has_uvs { t } else { NONE }, if has_normals { n } else { NONE }];
                *known.entry(key).or_insert_with(|| {
                    mesh.positions.push(self.positions[v as usize]);
                    mesh.uvs.extend(has_uvs.then(|| self.uvs[t as usize]));
                    mesh.normals.extend(has_normals.then(|| self.normals[n as usize]));
                    mesh.colors.extend(self.colors.get(v as usize));
                    (mesh.positions.len() - 1) as u32
                })
            });
            mesh.triangles.push(indices);
        }
        mesh
    }
}

fn check(mesh: &SceneMesh, source: &Source) -> Result<(), LoadError> {
    let (path, limit) = (&source.path, u64::from(u32::MAX));
    let count = mesh.positions.len() as u64;
    if count > limit {
        let path = path.clone();
        return Err(LoadError::TooMany { path, what: "position", count, limit, remedy: SPLIT });
    }
    check_finite(path, "position", &mesh.positions, |v| v.is_finite())?;
    check_finite(path, "texture coordinate", &mesh.uvs, |v| v.is_finite())?;
    check_finite(path, "normal", &mesh.normals, |v| v.is_finite())?;
    check_finite(path, "colour", &mesh.colors, |v| v.is_finite())
}
