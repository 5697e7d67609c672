//! Compiled pipelines in a file, for the next run of a program.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

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
        let cache = gpu.guarded("the cache of pipelines", || {
            // SAFETY: the caller vouches for the file; what was cut short or damaged since has
            // another checksum. wgpu compares the bytes' header with the adapter and the driver.
            unsafe {
                gpu.device.create_pipeline_cache(&wgpu::PipelineCacheDescriptor {
                    label: Some("raydsl"),
                    data: content(&file),
                    fallback: true,
                })
            }
        })?;
        Ok(Some(Self { path, cache, has_more: AtomicBool::new(false) }))
    }

    /// Returns the driver's cache, for a new pipeline.
    pub(super) fn cache(&self) -> &wgpu::PipelineCache {
        self.has_more.store(true, Ordering::Relaxed);
        &self.cache
    }

    /// Writes the file, whole or not at all, and returns its bytes; 0 if the driver keeps nothing.
    pub(super) fn write(&self) -> Result<u64, GpuError> {
        self.has_more.store(false, Ordering::Relaxed);
        let Some(data) = self.cache.get_data() else { return Ok(0) };
        let written = || {
            if let Some(folder) = self.path.parent() {
                fs::create_dir_all(folder)?;
            }
            // Another process may write its own meanwhile.
            let unfinished = self.path.with_extension(std::process::id().to_string());
            fs::write(&unfinished, file_of(&data))?;
            fs::rename(&unfinished, &self.path)
        };
        written().map_err(|error| failed(&self.path, &error))?;
        Ok(data.len() as u64)
    }
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
