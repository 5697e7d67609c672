//! Primitives of meshes: triangles of one material.

use glam::{Vec2, Vec3, Vec4};
use gltf_json::Accessor;
use gltf_json::Index;
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;

use super::File;
use super::accessor::Elements;
use super::buffer::Buffers;
use crate::LoadError;
use crate::mesh::fan;
use crate::scene::{SceneMesh, check_finite};

/// Corners that any file may have, however small it is.
const FREE: u64 = 1 << 22;

/// What is left for corners. Primitives may share their data, so a small file may describe many.
pub(super) struct Room(u64);

impl Room {
    pub(super) fn new(buffers: &Buffers) -> Self {
        Self(buffers.total().saturating_mul(8).saturating_add(FREE))
    }

    fn take(&mut self, file: &File, count: usize) -> Result<(), LoadError> {
        let left = self.0.checked_sub(count as u64);
        self.0 = left.ok_or_else(|| {
            file.wrong("its primitives share their accessors so often that they do not fit")
        })?;
        Ok(())
    }
}

/// A primitive without name and material; none if it has no triangles.
pub(super) fn read(
    file: &File,
    buffers: &Buffers,
    primitive: &Primitive,
    room: &mut Room,
) -> Result<Option<SceneMesh>, LoadError> {
    let attribute = |semantic: Semantic| {
        let index = primitive.attributes.get(&Checked::Valid(semantic));
        index.map(|index| Elements::open(file, buffers, *index)).transpose()
    };
    let mode = match primitive.mode {
        Checked::Valid(mode) => mode,
        Checked::Invalid => return Err(file.wrong("the mode of a primitive is unknown")),
    };
    if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        return Ok(None);
    }
    let Some(positions) = attribute(Semantic::Positions)? else { return Ok(None) };
    let corners = corners(file, buffers, primitive.indices, positions.count(), room)?;
    let mut triangles = triangles(mode, &corners);
    if triangles.is_empty() {
        return Ok(None);
    }
    let kept = Kept::new(positions.count(), &corners);
    kept.renumber(&mut triangles);
    let read = |e: &Option<Elements>, what, components: &[usize]| {
        kept.vectors(file, e.as_ref(), what, components)
    };
    let vec3 =
        |list: Vec<[f32; 4]>| list.into_iter().map(|[x, y, z, _]| Vec3::new(x, y, z)).collect();
    let vec2 = |list: Vec<[f32; 4]>| list.into_iter().map(|[x, y, ..]| Vec2::new(x, y)).collect();
    let mut mesh = SceneMesh {
        normals: vec3(read(&attribute(Semantic::Normals)?, "normal", &[3])?),
        uvs: vec2(read(&attribute(Semantic::TexCoords(0))?, "texture coordinate", &[2])?),
        uvs1: vec2(read(&attribute(Semantic::TexCoords(1))?, "texture coordinate", &[2])?),
        positions: vec3(read(&Some(positions), "position", &[3])?),
        triangles,
        ..SceneMesh::default()
    };
    let tangents = read(&attribute(Semantic::Tangents)?, "tangent", &[4])?;
    mesh.tangents = tangents.into_iter().map(Vec4::from).collect();
    let colors = attribute(Semantic::Colors(0))?;
    let is_opaque = colors.as_ref().is_some_and(|colors| colors.components() == 3);
    let colors = read(&colors, "colour", &[3, 4])?.into_iter().map(Vec4::from);
    mesh.colors = colors.map(|c| if is_opaque { c.with_w(1.0) } else { c }).collect();
    Ok(Some(mesh))
}

/// The indices of corners, all of them below `count`.
fn corners(
    file: &File,
    buffers: &Buffers,
    indices: Option<Index<Accessor>>,
    count: usize,
    room: &mut Room,
) -> Result<Vec<u32>, LoadError> {
    let Some(index) = indices else {
        room.take(file, count)?;
        return Ok((0..count as u32).collect());
    };
    let elements = Elements::open(file, buffers, index)?;
    if !elements.are_indices() {
        let what = format!("accessors[{}]: it is not of indices", index.value());
        return Err(file.wrong(what));
    }
    room.take(file, elements.count())?;
    let corners: Vec<u32> = (0..elements.count()).map(|i| elements.index(i)).collect();
    match corners.iter().find(|corner| **corner as usize >= count) {
        Some(corner) => {
            let i = index.value();
            let what = format!("accessors[{i}]: {corner} is none of {count} vertices");
            Err(file.wrong(what))
        }
        None => Ok(corners),
    }
}

/// The triangles of corners. Those of strips and fans that stitch parts together are left out.
fn triangles(mode: Mode, corners: &[u32]) -> Vec<[u32; 3]> {
    let is_wide = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    match mode {
        Mode::TriangleStrip => {
            let turn = |(i, w): (usize, &[u32])| {
                if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] }
            };
            corners.windows(3).enumerate().map(turn).filter(is_wide).collect()
        }
        Mode::TriangleFan => fan(corners).filter(is_wide).collect(),
        _ => corners.as_chunks().0.to_vec(),
    }
}

/// Which vertices a primitive keeps: all, or those that it uses.
struct Kept {
    count: usize,
    used: Option<Vec<u32>>,
}

impl Kept {
    /// Primitives often share the vertices of a whole mesh.
    fn new(count: usize, corners: &[u32]) -> Self {
        let used = (count > corners.len()).then(|| {
            let mut used = corners.to_vec();
            used.sort_unstable();
            used.dedup();
            used
        });
        Self { count, used }
    }

    fn renumber(&self, triangles: &mut [[u32; 3]]) {
        let Some(used) = &self.used else { return };
        for corner in triangles.as_flattened_mut() {
            *corner = used.partition_point(|u| u < corner) as u32;
        }
    }

    fn vectors(
        &self,
        file: &File,
        elements: Option<&Elements>,
        what: &'static str,
        components: &[usize],
    ) -> Result<Vec<[f32; 4]>, LoadError> {
        let Some(elements) = elements else { return Ok(Vec::new()) };
        if elements.count() != self.count || !components.contains(&elements.components()) {
            let (count, n) = (elements.count(), elements.components());
            let wanted = self.count;
            let what = format!(
                "a primitive of {wanted} positions has {count} {what}s of {n} components each"
            );
            return Err(file.wrong(what));
        }
        let list: Vec<[f32; 4]> = match &self.used {
            Some(used) => used.iter().map(|i| elements.vector(*i as usize)).collect(),
            None => (0..self.count).map(|i| elements.vector(i)).collect(),
        };
        check_finite(&file.source.path, what, &list, |v| v.iter().all(|x| x.is_finite()))?;
        Ok(list)
    }
}
