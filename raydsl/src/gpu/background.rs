//! Compilation on a thread of its own, and what the host does meanwhile.

use std::fmt;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use super::context::Context;
use super::device::lock;
use super::error::GpuError;
use super::pipelines::PipelineSource;
use crate::machine::wgsl::Module;

/// The host goes on with a picture that it ends within this time, rather than give it to the device.
const SOON: Duration = Duration::from_millis(50);

/// Compilations on threads of their own. Dropping them waits for their ends: a driver that compiles
/// while the process exits may crash.
#[derive(Default)]
pub(super) struct Background {
    running: Mutex<Vec<Compilation>>,
}

struct Compilation {
    source: PipelineSource<'static>,
    is_done: Arc<AtomicBool>,
    /// It is taken when the compilation is dropped.
    thread: Option<JoinHandle<Result<(), GpuError>>>,
}

/// The state of a pipeline.
pub(super) enum Compiled {
    /// It can be used at once.
    Ready,
    /// Another thread compiles it, and will set this.
    Running(Arc<AtomicBool>),
}

impl Background {
    /// Returns whether a module's pipeline is compiled, and begins to compile it if nobody does.
    ///
    /// The error of a compilation is returned once; the next call begins another one.
    pub(super) fn state(
        &self,
        context: &Arc<Context>,
        module: &Module,
    ) -> Result<Compiled, GpuError> {
        context.check()?;
        let source = context.pipeline_source(module)?;
        let mut running = lock(&self.running);
        running.retain(|other| !other.is_done() || other.source == source);
        if let Some(at) = running.iter().position(|known| known.source == source) {
            if !running[at].is_done() {
                return Ok(Compiled::Running(Arc::clone(&running[at].is_done)));
            }
            running.swap_remove(at).end()?;
        }
        if context.pipelines.has(&source) {
            return Ok(Compiled::Ready);
        }
        match Compilation::begin(Arc::clone(context), source.into_owned()) {
            Some(begun) => {
                let is_done = Arc::clone(&begun.is_done);
                running.push(begun);
                Ok(Compiled::Running(is_done))
            }
            // The system gives no thread: the caller's compiles.
            None => Ok(Compiled::Ready),
        }
    }
}

impl Compilation {
    fn begin(context: Arc<Context>, source: PipelineSource<'static>) -> Option<Self> {
        let is_done = Arc::new(AtomicBool::new(false));
        let work = {
            let (source, end) = (source.clone(), SetAtEnd(Arc::clone(&is_done)));
            move || {
                let _end = end;
                context.pipelines.get(&context.gpu, context.checks, &source).map(drop)
            }
        };
        let thread = Builder::new().name("raydsl compiler".to_owned()).spawn(work).ok()?;
        Some(Self { source, is_done, thread: Some(thread) })
    }

    fn is_done(&self) -> bool {
        self.is_done.load(Ordering::Acquire)
    }

    fn end(mut self) -> Result<(), GpuError> {
        let thread = self.thread.take().map(JoinHandle::join);
        thread.map_or(Ok(()), |end| end.unwrap_or_else(|panic| resume_unwind(panic)))
    }
}

impl Drop for Compilation {
    fn drop(&mut self) {
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Tells that a thread is done, also if it panics.
struct SetAtEnd(Arc<AtomicBool>);

impl Drop for SetAtEnd {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

impl fmt::Debug for Background {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Background").field("running", &lock(&self.running).len()).finish()
    }
}

/// Decides whether the host goes on with a picture.
pub(super) struct Handover {
    start: Instant,
    is_compiled: Arc<AtomicBool>,
}

impl Handover {
    pub(super) fn new(is_compiled: Arc<AtomicBool>) -> Self {
        Self { start: Instant::now(), is_compiled }
    }

    /// Returns whether the device takes over, when the host has completed a share of a picture.
    pub(super) fn is_due(&self, share: f64) -> bool {
        let left = self.start.elapsed().as_secs_f64() * (1.0 / share.max(1e-9) - 1.0);
        self.is_compiled.load(Ordering::Acquire) && left > SOON.as_secs_f64()
    }

    /// Returns the milliseconds since the host began.
    pub(super) fn wall_ms(&self) -> f64 {
        self.start.elapsed().as_secs_f64() * 1e3
    }
}
