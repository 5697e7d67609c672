//! TRI: triangles as they are in memory.

use glam::Vec3;

use crate::mesh::{Mesh, SPLIT};
use crate::source::Source;
use crate::{LoadError, Place};

/// Bytes of a triangle.
const SIZE: u64 = 36;
/// Each triangle has three vertices, which indices of 32 bits tell apart.
const MOST: u64 = u32::MAX as u64 / 3;

pub(crate) fn read(mut source: Source) -> Result<Mesh, LoadError> {
    let mut head = [0; 4];
    if !source.fill(&mut head)? {
        return Err(source.truncated("it is shorter than 4 bytes, the count of triangles".into()));
    }
    let count = u64::from(u32::from_le_bytes(head));
    let (expected, found) = (count * SIZE, source.remaining());
    let what = format!("{count} triangles take {expected} bytes, {found} follow the count");
    if found < expected {
        return Err(source.truncated(what));
    }
    if found > expected {
        return Err(source.corrupt(Place::Byte(4 + expected), what, "write it again"));
    }
    let path = || source.path.clone();
    if count > MOST {
        let (what, limit) = ("triangle", MOST);
        return Err(LoadError::TooMany { path: path(), what, count, limit, remedy: SPLIT });
    }
    let mut mesh = Mesh::default();
    let room = mesh.vertices.try_reserve_exact(3 * count as usize);
    room.and_then(|()| mesh.triangles.try_reserve_exact(count as usize)).map_err(|_| {
        LoadError::OutOfMemory { path: path(), what: "triangle", count, remedy: SPLIT }
    })?;
    let mut bytes = [0; SIZE as usize];
    for i in 0..count as u32 {
        if !source.fill(&mut bytes)? {
            return Err(source.truncated(format!("{i} of {count} triangles are there")));
        }
        let (numbers, _) = bytes.as_chunks::<4>();
        let number = |i: usize| f32::from_le_bytes(numbers[i]);
        let vertex = |v: usize| Vec3::new(number(3 * v), number(3 * v + 1), number(3 * v + 2));
        mesh.vertices.extend([0, 1, 2].map(vertex));
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    Ok(mesh)
}
