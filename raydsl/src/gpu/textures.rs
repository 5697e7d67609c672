//! Sampled textures on the device, each uploaded once.

use std::borrow::Cow;
use std::collections::HashMap;

use super::buffers::{PIECE, Source};
use super::device::Gpu;
use super::error::GpuError;
use crate::machine::owner;
use crate::machine::wgsl::{TexelFormat, Texture, TextureLayout};
use crate::texture::Address;

/// A texture and its sampler, ready for binding.
pub(super) struct BoundTexture {
    pub(super) binding: u32,
    pub(super) view: wgpu::TextureView,
    pub(super) sampler: wgpu::Sampler,
}

/// One version of a texture's texels.
struct Upload {
    version: u32,
    view: wgpu::TextureView,
    bytes: u64,
}

/// The key of an owner's texture: the part, and how its texels are read. The same texels may be several
/// textures.
type Name = (u64, u32, Shape);
/// What a view of texels depends on: their format, their numbers, the levels, and whether it is a volume.
type Shape = (TexelFormat, [u32; 3], u32, bool);
/// The key of a sampler.
type Reading = ([Address; 3], bool);

/// All textures and samplers on the device.
#[derive(Default)]
pub(super) struct Textures {
    uploads: HashMap<Name, Upload>,
    samplers: HashMap<Reading, wgpu::Sampler>,
    uploaded: u64,
}

impl Textures {
    /// Returns the bytes uploaded so far.
    pub(super) fn uploaded(&self) -> u64 {
        self.uploaded
    }

    /// Returns the uploaded bytes that are still on the device.
    pub(super) fn kept(&self) -> u64 {
        self.uploads.values().map(|upload| upload.bytes).sum()
    }

    /// Drops the textures of dropped owners.
    pub(super) fn forget_gone(&mut self) {
        let gone = owner::gone(self.uploads.keys().map(|(id, ..)| *id));
        self.uploads.retain(|(id, ..), _| !gone.contains(id));
    }

    /// Drops all textures and samplers.
    pub(super) fn clear(&mut self) {
        self.uploads.clear();
        self.samplers.clear();
    }

    /// Drops the textures of one owner.
    pub(super) fn forget(&mut self, id: u64) {
        self.uploads.retain(|(owner, ..), _| *owner != id);
    }

    /// Returns a texture and its sampler, uploaded if the device does not have it.
    pub(super) fn bind(
        &mut self,
        gpu: &Gpu,
        texture: &Texture,
        source: Source<'_, '_>,
    ) -> Result<BoundTexture, GpuError> {
        let Texture { key, layout, .. } = texture;
        let shape = (layout.format, layout.size, layout.levels, layout.is_volume);
        let name = (key.id, key.part, shape);
        let known = self.uploads.get(&name).filter(|upload| upload.version == key.version);
        let view = match known {
            Some(upload) => upload.view.clone(),
            None => {
                // Frees the memory of what it was before first.
                let is_of_now = |upload: &Upload| upload.version == key.version;
                self.uploads.retain(|(id, part, _), upload| {
                    (*id, *part) != (key.id, key.part) || is_of_now(upload)
                });
                let bytes = texels(texture, source)?;
                let sent = bytes.len() as u64;
                let view = send(gpu, texture, &bytes)?;
                let upload = Upload { version: key.version, view: view.clone(), bytes: sent };
                self.uploads.insert(name, upload);
                self.uploaded += sent;
                view
            }
        };
        let sampler = self.sampler(gpu, layout)?;
        Ok(BoundTexture { binding: texture.binding, view, sampler })
    }

    fn sampler(&mut self, gpu: &Gpu, layout: &TextureLayout) -> Result<wgpu::Sampler, GpuError> {
        let reading = (layout.address, layout.blends_levels);
        if let Some(sampler) = self.samplers.get(&reading) {
            return Ok(sampler.clone());
        }
        let [u, v, w] = layout.address.map(address_mode);
        let descriptor = wgpu::SamplerDescriptor {
            label: Some("raydsl"),
            address_mode_u: u,
            address_mode_v: v,
            address_mode_w: w,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: if layout.blends_levels {
                wgpu::MipmapFilterMode::Linear
            } else {
                wgpu::MipmapFilterMode::Nearest
            },
            ..Default::default()
        };
        let sampler = gpu.guarded("a sampler", || gpu.device.create_sampler(&descriptor))?;
        self.samplers.insert(reading, sampler.clone());
        Ok(sampler)
    }
}

/// Returns the texels of all levels, one directly behind another.
fn texels<'d>(texture: &Texture, source: Source<'_, 'd>) -> Result<Cow<'d, [u8]>, GpuError> {
    let Texture { key, name, layout, .. } = texture;
    let bytes =
        source(*key).ok_or_else(|| GpuError::MissingData { name: name.clone(), key: *key })?;
    let (stride, size) = (layout.stride as usize, layout.format.bytes() as usize);
    let count: u64 = levels(layout).map(|level| texel_count(level.size)).sum();
    let needed = count.saturating_mul(stride as u64);
    if (bytes.len() as u64) < needed || stride < size {
        let what = format!("the texture {name}");
        return Err(GpuError::WrongLength { what, bytes: bytes.len() as u64, needed });
    }
    if stride == size {
        return Ok(bytes);
    }
    let padded = bytes.chunks_exact(stride).take(count as usize);
    Ok(padded.flat_map(|texel| &texel[..size]).copied().collect::<Vec<u8>>().into())
}

/// A level of detail.
struct Level {
    number: u32,
    size: [u32; 3],
}

fn levels(layout: &TextureLayout) -> impl Iterator<Item = Level> {
    let size = layout.size;
    (0..layout.levels).map(move |number| Level { number, size: size.map(|n| (n >> number).max(1)) })
}

fn texel_count(size: [u32; 3]) -> u64 {
    size.iter().map(|&n| u64::from(n)).product()
}

/// Uploads all levels in pieces, at most two of them in flight.
fn send(gpu: &Gpu, texture: &Texture, bytes: &[u8]) -> Result<wgpu::TextureView, GpuError> {
    let Texture { name, layout, .. } = texture;
    let limits = gpu.device.limits();
    let limit = if layout.is_volume {
        limits.max_texture_dimension_3d
    } else {
        limits.max_texture_dimension_2d
    };
    if layout.size.iter().any(|&n| n > limit) {
        let (name, size) = (name.clone(), layout.size);
        return Err(GpuError::TextureTooLarge { name, size, limit });
    }
    let what = format!("{name} ({} bytes)", bytes.len());
    let made = gpu.guarded(&what, || gpu.device.create_texture(&descriptor(texture)))?;
    let mut in_flight = None;
    let mut rest = bytes;
    for level in levels(layout) {
        let (image, after) =
            rest.split_at(texel_count(level.size) as usize * layout.format.bytes() as usize);
        rest = after;
        for piece in pieces(layout, &level, image) {
            let index = gpu.guarded(name, || {
                gpu.queue.write_texture(
                    piece.place(&made, level.number),
                    piece.bytes,
                    piece.rows,
                    piece.extent,
                );
                gpu.queue.submit([])
            })?;
            if let Some(earlier) = in_flight.replace(index) {
                gpu.wait(earlier)?;
            }
        }
    }
    Ok(made.create_view(&Default::default()))
}

fn descriptor(texture: &Texture) -> wgpu::TextureDescriptor<'_> {
    let Texture { name, layout, .. } = texture;
    wgpu::TextureDescriptor {
        label: Some(name),
        size: extent(layout.size),
        mip_level_count: layout.levels,
        sample_count: 1,
        dimension: if layout.is_volume {
            wgpu::TextureDimension::D3
        } else {
            wgpu::TextureDimension::D2
        },
        format: format(layout.format),
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    }
}

/// Rows of an image, or images of a volume, uploaded together.
struct Piece<'b> {
    bytes: &'b [u8],
    origin: wgpu::Origin3d,
    extent: wgpu::Extent3d,
    rows: wgpu::TexelCopyBufferLayout,
}

impl Piece<'_> {
    fn place<'t>(&self, texture: &'t wgpu::Texture, level: u32) -> wgpu::TexelCopyTextureInfo<'t> {
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: level,
            origin: self.origin,
            aspect: wgpu::TextureAspect::All,
        }
    }
}

/// Splits a level along its last axis.
fn pieces<'b>(
    layout: &TextureLayout,
    level: &Level,
    image: &'b [u8],
) -> impl Iterator<Item = Piece<'b>> {
    let [width, height, depth] = level.size;
    let row = width * layout.format.bytes();
    let is_volume = layout.is_volume;
    let one = row as usize * if is_volume { height as usize } else { 1 };
    let each = (PIECE / one).max(1);
    image.chunks(each * one).enumerate().map(move |(number, bytes)| {
        let (first, count) = ((number * each) as u32, (bytes.len() / one) as u32);
        let (origin, size) = if is_volume {
            (wgpu::Origin3d { x: 0, y: 0, z: first }, [width, height, count])
        } else {
            (wgpu::Origin3d { x: 0, y: first, z: 0 }, [width, count, depth])
        };
        let rows = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row),
            rows_per_image: Some(size[1]),
        };
        Piece { bytes, origin, extent: extent(size), rows }
    })
}

fn extent([width, height, depth_or_array_layers]: [u32; 3]) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers }
}

fn format(format: TexelFormat) -> wgpu::TextureFormat {
    match format {
        TexelFormat::R8Unorm => wgpu::TextureFormat::R8Unorm,
        TexelFormat::Rg8Unorm => wgpu::TextureFormat::Rg8Unorm,
        TexelFormat::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
        TexelFormat::Rgba8UnormSrgb => wgpu::TextureFormat::Rgba8UnormSrgb,
        TexelFormat::R16Float => wgpu::TextureFormat::R16Float,
        TexelFormat::Rg16Float => wgpu::TextureFormat::Rg16Float,
        TexelFormat::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
    }
}

fn address_mode(address: Address) -> wgpu::AddressMode {
    match address {
        Address::Wrap => wgpu::AddressMode::Repeat,
        Address::Mirror => wgpu::AddressMode::MirrorRepeat,
        // The recorder leaves textures with a border to the library's code.
        Address::Clamp | Address::Border => wgpu::AddressMode::ClampToEdge,
    }
}
