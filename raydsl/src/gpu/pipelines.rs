//! The pipelines of a device, each compiled once.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

use super::device::{Gpu, lock};
use super::error::GpuError;
use super::pipeline::{Bindings, Checks, Pipeline, compile};
#[cfg(not(target_family = "wasm"))]
use super::pipeline_file::PipelineFile;
use crate::run::clock::Instant;

/// What a pipeline is compiled from.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct PipelineSource<'a> {
    pub(super) text: Cow<'a, str>,
    /// The text nearly always determines them; if not, there is one pipeline for each.
    pub(super) bindings: Bindings,
}

impl PipelineSource<'_> {
    #[cfg(not(target_family = "wasm"))]
    pub(super) fn into_owned(self) -> PipelineSource<'static> {
        PipelineSource { text: Cow::Owned(self.text.into_owned()), bindings: self.bindings }
    }
}

/// A pipeline, once it is compiled.
struct Entry {
    bindings: Bindings,
    made: OnceLock<Pipeline>,
    /// Held by who compiles it: others wait for it, and for no other pipeline.
    compiling: Mutex<()>,
}

/// The pipelines compiled so far.
#[derive(Default)]
pub(super) struct Pipelines {
    by_text: Mutex<HashMap<String, Vec<Arc<Entry>>>>,
    compiled: AtomicU64,
    compile_ns: AtomicU64,
    /// Where they are kept for the next run of the program.
    #[cfg(not(target_family = "wasm"))]
    pub(super) file: Option<PipelineFile>,
}

impl Pipelines {
    /// Returns the number of shaders compiled so far.
    pub(super) fn compiled(&self) -> u64 {
        self.compiled.load(Ordering::Relaxed)
    }

    /// Returns the total compilation time.
    pub(super) fn compile_time(&self) -> Duration {
        Duration::from_nanos(self.compile_ns.load(Ordering::Relaxed))
    }

    /// Drops all pipelines: one of them may be invalid.
    pub(super) fn clear(&self) {
        lock(&self.by_text).clear();
    }

    /// Drops all pipelines, and forgets how many there were.
    pub(super) fn reset(&self) {
        self.clear();
        self.compiled.store(0, Ordering::Relaxed);
        self.compile_ns.store(0, Ordering::Relaxed);
    }

    /// Returns whether a pipeline is compiled.
    #[cfg(not(target_family = "wasm"))]
    pub(super) fn has(&self, source: &PipelineSource<'_>) -> bool {
        known(&lock(&self.by_text), source).is_some_and(|entry| entry.made.get().is_some())
    }

    /// Returns a pipeline, compiled if it is new.
    pub(super) fn get(
        &self,
        gpu: &Gpu,
        checks: Checks,
        source: &PipelineSource<'_>,
    ) -> Result<Pipeline, GpuError> {
        let entry = self.entry(source);
        if let Some(pipeline) = entry.made.get() {
            return Ok(pipeline.clone());
        }
        let _compiling = lock(&entry.compiling);
        if let Some(pipeline) = entry.made.get() {
            return Ok(pipeline.clone());
        }
        let start = Instant::now();
        let pipeline = compile(gpu, checks, &source.text, &source.bindings, self.cache())?;
        let took = u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.compile_ns.fetch_add(took, Ordering::Relaxed);
        self.compiled.fetch_add(1, Ordering::Relaxed);
        #[cfg(not(target_family = "wasm"))]
        if let Some(file) = &self.file {
            file.note_new();
        }
        Ok(entry.made.get_or_init(|| pipeline).clone())
    }

    fn cache(&self) -> Option<&wgpu::PipelineCache> {
        #[cfg(not(target_family = "wasm"))]
        return self.file.as_ref().map(PipelineFile::cache);
        #[cfg(target_family = "wasm")]
        None
    }

    fn entry(&self, source: &PipelineSource<'_>) -> Arc<Entry> {
        let mut by_text = lock(&self.by_text);
        if let Some(entry) = known(&by_text, source) {
            return entry;
        }
        let entry = Entry {
            bindings: source.bindings.clone(),
            made: OnceLock::new(),
            compiling: Mutex::default(),
        };
        let entry = Arc::new(entry);
        by_text.entry(source.text.to_string()).or_default().push(Arc::clone(&entry));
        entry
    }
}

fn known(
    by_text: &HashMap<String, Vec<Arc<Entry>>>,
    source: &PipelineSource<'_>,
) -> Option<Arc<Entry>> {
    let same_text = by_text.get(&*source.text)?;
    same_text.iter().find(|entry| entry.bindings == source.bindings).cloned()
}
