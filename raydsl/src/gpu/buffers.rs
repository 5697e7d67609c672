//! Storage buffers of scenes on the device, each uploaded once.

use std::borrow::Cow;
use std::collections::HashMap;

use super::chunks::{Span, plan};
use super::device::{Caps, Gpu};
use super::error::GpuError;
use super::window::{GpuWindow, WindowError};
use crate::machine::owner;
use crate::machine::wgsl::{Buffer, BufferKey, Window};

/// Bytes per transfer: wgpu stages each in a buffer of its own, so twice this bounds the extra
/// memory while a large scene is uploaded.
pub(super) const PIECE: usize = 64 << 20;

/// The function, given by the caller of a run, that returns the bytes of a scene buffer by its key.
pub(super) type Source<'s, 'd> = &'s dyn Fn(BufferKey) -> Option<Cow<'d, [u8]>>;

/// A window ready for binding.
pub(super) struct Bound {
    pub(super) binding: u32,
    pub(super) buffer: wgpu::Buffer,
    pub(super) offset: u64,
    pub(super) size: u64,
}

/// A part of a scene buffer in one wgpu buffer.
struct Chunk {
    span: Span,
    buffer: wgpu::Buffer,
    /// The start of the span in the buffer; not 0 only in buffers of the application.
    offset: u64,
}

/// One version of one part of a scene.
struct Upload {
    version: u32,
    external: bool,
    chunks: Vec<Chunk>,
}

/// The scene buffers on the device, by owner and part.
#[derive(Default)]
pub(super) struct Uploads {
    parts: HashMap<(u64, u32), Upload>,
    /// Slices in the application's buffers. A part of such a slice may have its address, so they
    /// are stored by the whole key.
    windows: HashMap<BufferKey, Upload>,
    uploaded: u64,
}

impl Uploads {
    /// Returns the bytes uploaded so far.
    pub(super) fn uploaded(&self) -> u64 {
        self.uploaded
    }

    /// Returns the uploaded bytes that are still on the device.
    pub(super) fn kept(&self) -> u64 {
        let own = self.parts.values().filter(|upload| !upload.external);
        own.flat_map(|upload| &upload.chunks).map(|chunk| chunk.span.len()).sum()
    }

    /// Drops the buffers of dropped trees and lists.
    pub(super) fn forget_gone(&mut self) {
        let own = self.parts.iter().filter(|(_, upload)| !upload.external);
        let gone = owner::gone(own.map(|((id, _), _)| *id));
        self.parts.retain(|(id, _), upload| upload.external || !gone.contains(id));
    }

    /// Drops all uploads; the application's buffers stay.
    pub(super) fn clear(&mut self) {
        self.parts.retain(|_, upload| upload.external);
    }

    /// Drops all parts of one owner.
    pub(super) fn forget(&mut self, id: u64) {
        self.parts.retain(|&(owner, _), _| owner != id);
    }

    /// Returns the bindings of `buffer`'s windows, uploading missing data.
    ///
    /// Kernels may split the same buffer differently. A window that no chunk holds adds chunks and
    /// leaves those of the other kernels in place.
    pub(super) fn bind(
        &mut self,
        gpu: &Gpu,
        buffer: &Buffer,
        source: Source<'_, '_>,
    ) -> Result<Vec<Bound>, GpuError> {
        let spans = spans(buffer, gpu.caps.max_binding)?;
        let alignment = gpu.caps.alignment;
        if let Some(window) = self.windows.get(&buffer.key) {
            return window
                .bound(buffer, &spans, alignment)
                .ok_or_else(|| too_small_or_crooked(buffer, alignment));
        }
        let upload = self.current(buffer.key);
        let missing: Vec<Span> = spans
            .iter()
            .copied()
            .filter(|&span| upload.locate(span, alignment).is_none())
            .collect();
        if !missing.is_empty() {
            if upload.external {
                return Err(too_small_or_crooked(buffer, alignment));
            }
            let chunks = send_all(gpu, buffer, &missing, source)?;
            let sent: u64 = chunks.iter().map(|chunk| chunk.span.len()).sum();
            upload.chunks.extend(chunks);
            self.uploaded += sent;
        }
        let upload = self.current(buffer.key);
        upload.bound(buffer, &spans, alignment).ok_or_else(|| GpuError::BadModule {
            reason: format!("the windows of {} cannot be bound", buffer.name),
        })
    }

    /// Reads the slice of `key` from a window, already checked.
    pub(super) fn enter_window(
        &mut self,
        key: BufferKey,
        window: GpuWindow,
    ) -> Result<(), WindowError> {
        if self.windows.contains_key(&key) {
            return Err(WindowError::Taken);
        }
        let GpuWindow { buffer, offset, size } = window;
        let chunk = Chunk { span: Span { start: 0, end: size }, buffer, offset };
        let upload = Upload { version: key.version, external: true, chunks: vec![chunk] };
        self.windows.insert(key, upload);
        Ok(())
    }

    /// Reads the slice of `key` from an upload again.
    pub(super) fn leave_window(&mut self, key: BufferKey) {
        self.windows.remove(&key);
    }

    /// Returns the entry for a key; another version is dropped first, to free its memory.
    fn current(&mut self, key: BufferKey) -> &mut Upload {
        let fresh = || Upload { version: key.version, external: false, chunks: Vec::new() };
        let upload = self.parts.entry((key.id, key.part)).or_insert_with(fresh);
        if upload.version != key.version {
            *upload = fresh();
        }
        upload
    }

    /// Uses the application's buffer for `key` after checking that it can be bound.
    pub(super) fn name_external(
        &mut self,
        caps: &Caps,
        key: BufferKey,
        buffer: wgpu::Buffer,
        offset: u64,
        size: u64,
    ) -> Result<(), GpuError> {
        if let Some(reason) = unusable(caps, &buffer, offset, size) {
            return Err(GpuError::ExternalBuffer { key, reason });
        }
        let span = Span { start: 0, end: size };
        let upload = Upload {
            version: key.version,
            external: true,
            chunks: vec![Chunk { span, buffer, offset }],
        };
        self.parts.insert((key.id, key.part), upload);
        Ok(())
    }
}

impl Upload {
    /// Returns a binding for each window of `buffer`, if there are chunks that hold them.
    fn bound(&self, buffer: &Buffer, spans: &[Span], alignment: u64) -> Option<Vec<Bound>> {
        let bound = buffer.windows.iter().zip(spans).map(|(window, &span)| {
            let (chunk, offset) = self.locate(span, alignment)?;
            Some(Bound {
                binding: window.binding,
                buffer: chunk.buffer.clone(),
                offset,
                size: binding_bytes(span, buffer.stride),
            })
        });
        bound.collect()
    }

    /// Returns the chunk that holds a span, and the span's offset in its buffer.
    fn locate(&self, span: Span, alignment: u64) -> Option<(&Chunk, u64)> {
        self.chunks.iter().find_map(|chunk| {
            let holds = chunk.span.holds(span);
            let offset = chunk.offset + span.start.checked_sub(chunk.span.start)?;
            (holds && offset.is_multiple_of(alignment)).then_some((chunk, offset))
        })
    }
}

/// Returns the span of each window, checked against the buffer and the limit of a binding.
fn spans(buffer: &Buffer, max_binding: u64) -> Result<Vec<Span>, GpuError> {
    let malformed = |what: &str| GpuError::BadModule {
        reason: format!("{what} of the scene buffer {}", buffer.name),
    };
    if buffer.stride == 0 || !buffer.stride.is_multiple_of(4) {
        return Err(malformed("a stride that is no multiple of 4"));
    }
    let span_of = |window: &Window| {
        let last = window.first.checked_add(window.count)?;
        let stride = u64::from(buffer.stride);
        let inside = last <= buffer.len;
        let end = last.checked_mul(stride)?;
        let start = window.first * stride;
        inside.then_some(Span { start, end })
    };
    let mut spans = Vec::with_capacity(buffer.windows.len());
    for window in &buffer.windows {
        let span = span_of(window).ok_or_else(|| malformed("a window past the end"))?;
        if span.len() > max_binding {
            return Err(GpuError::BindingTooLarge {
                name: buffer.name.clone(),
                bytes: span.len(),
                limit: max_binding,
            });
        }
        spans.push(span);
    }
    Ok(spans)
}

/// Returns the bytes to bind for a span: at least one element, since WebGPU has no empty bindings.
fn binding_bytes(span: Span, stride: u32) -> u64 {
    span.len().max(u64::from(stride))
}

/// Uploads the chunks that hold `missing`.
fn send_all(
    gpu: &Gpu,
    buffer: &Buffer,
    missing: &[Span],
    source: Source<'_, '_>,
) -> Result<Vec<Chunk>, GpuError> {
    let bytes = source(buffer.key)
        .ok_or_else(|| GpuError::MissingData { name: buffer.name.clone(), key: buffer.key })?;
    let needed = buffer.len.saturating_mul(u64::from(buffer.stride));
    if (bytes.len() as u64) < needed {
        return Err(GpuError::WrongLength {
            what: format!("the scene buffer {}", buffer.name),
            bytes: bytes.len() as u64,
            needed,
        });
    }
    let chunks = plan(missing, gpu.caps.max_buffer, gpu.caps.alignment);
    chunks.into_iter().map(|span| send(gpu, buffer, span, &bytes)).collect()
}

/// Uploads one chunk in pieces, two of them in flight at most.
fn send(gpu: &Gpu, scene: &Buffer, span: Span, bytes: &[u8]) -> Result<Chunk, GpuError> {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    let buffer = gpu.buffer(&scene.name, binding_bytes(span, scene.stride), usage)?;
    // In range: the span ends within `len * stride`, the length of `bytes`.
    let bytes = &bytes[span.start as usize..span.end as usize];
    let mut in_flight = None;
    for (number, piece) in bytes.chunks(PIECE).enumerate() {
        let at = (number * PIECE) as u64;
        let index = gpu.guarded(&scene.name, || {
            gpu.queue.write_buffer(&buffer, at, piece);
            gpu.queue.submit([])
        })?;
        if let Some(earlier) = in_flight.replace(index) {
            gpu.wait(earlier)?;
        }
    }
    Ok(Chunk { span, buffer, offset: 0 })
}

/// Returns why a buffer of the application cannot be bound, if it cannot.
fn unusable(caps: &Caps, buffer: &wgpu::Buffer, offset: u64, size: u64) -> Option<String> {
    if !buffer.usage().contains(wgpu::BufferUsages::STORAGE) {
        return Some("create it with BufferUsages::STORAGE".to_owned());
    }
    if !offset.is_multiple_of(caps.alignment) {
        let alignment = caps.alignment;
        return Some(format!("its offset {offset} must be a multiple of {alignment}"));
    }
    if size == 0 || !size.is_multiple_of(4) {
        return Some(format!("its size {size} must be a positive multiple of 4"));
    }
    match offset.checked_add(size) {
        Some(end) if end <= buffer.size() => None,
        _ => Some(format!("{size} bytes from {offset} run past its end at {}", buffer.size())),
    }
}

/// Returns the error for an application's buffer that the windows of this kernel do not fit.
fn too_small_or_crooked(buffer: &Buffer, alignment: u64) -> GpuError {
    let needed = buffer.len.saturating_mul(u64::from(buffer.stride));
    GpuError::ExternalBuffer {
        key: buffer.key,
        reason: format!(
            "{} needs {needed} bytes with each window at a multiple of {alignment}",
            buffer.name
        ),
    }
}
