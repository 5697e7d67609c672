//! Compiled pipelines in a file, for the next run of a program.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::SystemTime;

use super::device::Gpu;
use super::error::{GpuError, one_line};

/// What a file begins with, before its checksum of eight bytes and the driver's own bytes.
const MAGIC: [u8; 8] = *b"raydsl 1";

/// A cache of the driver and the file that it is read from and written to.
pub(super) struct PipelineFile {
    path: PathBuf,
    cache: wgpu::PipelineCache,
    /// Whether the cache may have what the file has not.
    has_more: AtomicBool,
}

impl PipelineFile {
    /// Reads the file of an adapter in `folder`; one that is missing or damaged is as good as empty.
    ///
    /// Returns `None` where the device has no cache of pipelines.
    ///
    /// # Safety
    ///
    /// The file is one that [`PipelineFile::write`] wrote, or does not pass for one: the driver
    /// believes what is in it.
    pub(super) unsafe fn open(
        gpu: &Gpu,
        adapter: &wgpu::AdapterInfo,
        folder: &Path,
    ) -> Result<Option<Self>, GpuError> {
        if !gpu.device.features().contains(wgpu::Features::PIPELINE_CACHE) {
            return Ok(None);
        }
        let Some(name) = wgpu::util::pipeline_cache_key(adapter) else { return Ok(None) };
        let path = folder.join(name);
        let file = match fs::read(&path) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(failed(&path, &error)),
        };
        let make = |data: Option<&[u8]>| {
            gpu.guarded("the cache of pipelines", || {
                // SAFETY: the caller vouches for the file; what was cut short or damaged since has
                // another checksum. wgpu compares the data's header with the adapter and the driver.
                unsafe {
                    gpu.device.create_pipeline_cache(&wgpu::PipelineCacheDescriptor {
                        label: Some("raydsl"),
                        data,
                        fallback: true,
                    })
                }
            })
        };
        // One of another adapter is refused, whatever the name of the file.
        let cache = make(content(&file)).or_else(|_| make(None))?;
        Ok(Some(Self { path, cache, has_more: AtomicBool::new(false) }))
    }

    /// Returns the driver's cache.
    pub(super) fn cache(&self) -> &wgpu::PipelineCache {
        &self.cache
    }

    /// Notes that the cache has a new pipeline.
    pub(super) fn note_new(&self) {
        self.has_more.store(true, Ordering::Relaxed);
    }

    /// Writes the file, whole or not at all, and returns the bytes of what it keeps.
    pub(super) fn write(&self) -> Result<u64, GpuError> {
        self.has_more.store(false, Ordering::Relaxed);
        let Some(data) = self.cache.get_data() else { return Ok(0) };
        replace(&self.path, &file_of(&data)).map_err(|error| {
            self.has_more.store(true, Ordering::Relaxed);
            failed(&self.path, &error)
        })?;
        Ok(data.len() as u64)
    }
}

/// Writes a file beside another and puts it in its place.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    // Another thread, process or machine may write its own meanwhile.
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    let name = format!("{}-{number}-{}.unfinished", std::process::id(), since.as_nanos());
    let unfinished = path.with_extension(name);
    let mut file = fs::OpenOptions::new().write(true).create_new(true).open(&unfinished)?;
    let written = file.write_all(bytes).and_then(|()| fs::rename(&unfinished, path));
    if written.is_err() {
        let _ = fs::remove_file(&unfinished);
    }
    written
}

impl Drop for PipelineFile {
    fn drop(&mut self) {
        if self.has_more.load(Ordering::Relaxed) {
            // Nobody is left to be told; the next run compiles again.
            let _ = self.write();
        }
    }
}

fn failed(path: &Path, error: &io::Error) -> GpuError {
    GpuError::PipelineFile {
        path: path.display().to_string(),
        reason: one_line(&error.to_string()),
    }
}

/// Returns the bytes of a file with this content.
fn file_of(content: &[u8]) -> Vec<u8> {
    [&MAGIC[..], &checksum(content).to_le_bytes(), content].concat()
}

/// Returns the content of a file, if it is one and is whole.
fn content(file: &[u8]) -> Option<&[u8]> {
    let (sum, content) = file.strip_prefix(&MAGIC)?.split_first_chunk()?;
    (u64::from_le_bytes(*sum) == checksum(content)).then_some(content)
}

/// FNV-1a (Fowler, Noll and Vo), and the length.
fn checksum(bytes: &[u8]) -> u64 {
    let start = 0xcbf2_9ce4_8422_2325 ^ bytes.len() as u64;
    bytes.iter().fold(start, |sum, &byte| (sum ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_cut_short_or_damaged_has_no_content() {
        let bytes: Vec<u8> = (0..200).map(|i| (i * 37 % 251) as u8).collect();
        let file = file_of(&bytes);
        assert_eq!(content(&file), Some(&bytes[..]));
        for end in 0..file.len() {
            assert_eq!(content(&file[..end]), None, "the first {end} bytes");
        }
        for at in 0..file.len() {
            let mut damaged = file.clone();
            damaged[at] ^= 0x10;
            assert_eq!(content(&damaged), None, "byte {at}");
        }
        assert_eq!(content(&file_of(&[])), Some(&[][..]));
        assert_eq!(content(&[&file[..], &[0]].concat()), None, "a byte more");
    }
}
