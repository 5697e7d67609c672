//! Voxels without a header.

use glam::{Affine3, UVec3};

use crate::payload::Payload;
use crate::source::Source;
use crate::volume::{ByteOrder, VolumeFile, VoxelType};
use crate::{LoadError, Place};

const REMEDY: &str = "check the size and the type";

pub(crate) fn read(
    mut source: Source,
    size: UVec3,
    kind: VoxelType,
    order: ByteOrder,
) -> Result<VolumeFile, LoadError> {
    let payload = Payload::new(&source, size.to_array().map(u64::from), kind, order)?;
    let (bytes, len) = (payload.bytes(), source.len);
    if bytes < len {
        let what = format!("{} take {bytes} bytes, {len} are there", payload.name());
        return Err(source.corrupt(Place::Byte(bytes), what, REMEDY));
    }
    let voxels = payload.read_plain(&mut source, REMEDY)?;
    Ok(payload.volume(voxels, Affine3::IDENTITY))
}
