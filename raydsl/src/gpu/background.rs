//! Compilation on threads of their own.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, OnceLock};
use std::thread::{Builder, JoinHandle};

use super::context::Context;
use super::device::lock;
use super::error::GpuError;
use super::pipelines::PipelineSource;
use crate::machine::wgsl::Module;

/// The most refusals that are remembered.
const REFUSALS: usize = 16;

/// The end of a compilation, which another thread waits for.
pub(super) type Outcome = Arc<OnceLock<Result<(), GpuError>>>;

/// Compilations on threads of their own. Dropping them waits for their ends: a driver that compiles
/// while the process exits may crash.
#[derive(Default)]
pub(super) struct Background {
    /// Those that run, and those whose error is still to be told.
    known: Mutex<Vec<Compilation>>,
}

/// What a thread does.
#[derive(Clone, PartialEq, Eq)]
enum Work {
    /// It finds out what the device's arithmetic is: texts depend on it.
    Exactness,
    Pipeline(PipelineSource<'static>),
}

struct Compilation {
    work: Work,
    outcome: Outcome,
    /// It is taken when the compilation is dropped.
    thread: Option<JoinHandle<()>>,
}

impl Background {
    /// Returns nothing if a module's pipeline is compiled, else what its end will be known by; begins to
    /// compile it if nobody does.
    ///
    /// A text that was refused stays refused; after other errors the next call tries again.
    pub(super) fn pending(
        &self,
        context: &Arc<Context>,
        module: &dyn Fn() -> Module,
    ) -> Result<Option<Outcome>, GpuError> {
        context.gpu.poll();
        context.check()?;
        if !context.exactness_is_at_hand() {
            self.of(context, Work::Exactness)?;
            // Whoever compiles for its kernel next has the pipeline still to do.
            return Ok(Some(Outcome::default()));
        }
        let module = module();
        let source = context.pipeline_source(&module)?;
        if context.pipelines.has(&source) {
            return Ok(None);
        }
        self.of(context, Work::Pipeline(source.into_owned()))
    }

    /// Returns the outcome of some work that goes on, or begins it; nothing if the caller may do it.
    fn of(&self, context: &Arc<Context>, work: Work) -> Result<Option<Outcome>, GpuError> {
        let mut known = lock(&self.known);
        known.retain(|other| other.outcome.get().is_none_or(Result::is_err));
        if let Some(at) = known.iter().position(|other| other.work == work) {
            return match known[at].outcome.get().cloned() {
                None => Ok(Some(Arc::clone(&known[at].outcome))),
                Some(Ok(())) => Ok(None),
                Some(Err(refusal)) if is_of_the_text(&refusal) => Err(refusal),
                Some(Err(error)) => {
                    known.remove(at);
                    Err(error)
                }
            };
        }
        let is_over = |other: &Compilation| other.outcome.get().is_some();
        if known.iter().filter(|other| is_over(other)).count() > REFUSALS
            && let Some(oldest) = known.iter().position(is_over)
        {
            known.remove(oldest);
        }
        let begun = Compilation::begin(Arc::clone(context), work);
        let outcome = begun.as_ref().map(|begun| Arc::clone(&begun.outcome));
        known.extend(begun);
        Ok(outcome)
    }
}

/// Whether an error is one of the program: it will not do another time.
fn is_of_the_text(error: &GpuError) -> bool {
    matches!(error, GpuError::ShaderInvalid { .. } | GpuError::PipelineFailed { .. })
}

impl Compilation {
    /// Returns nothing if the system gives no thread.
    fn begin(context: Arc<Context>, work: Work) -> Option<Self> {
        let outcome = Outcome::default();
        let of_thread = (work.clone(), Arc::clone(&outcome));
        let run = move || {
            let (work, outcome) = of_thread;
            let result = catch_unwind(AssertUnwindSafe(|| work.run(&context)));
            // Nothing of the context outlives the outcome: its last owner may be waiting for it.
            drop(context);
            let _ = outcome.set(result.unwrap_or_else(|_| {
                Err(GpuError::PipelineFailed { message: "the compiler panicked".to_owned() })
            }));
        };
        let thread = Builder::new().name("raydsl compiler".to_owned()).spawn(run).ok()?;
        Some(Self { work, outcome, thread: Some(thread) })
    }
}

impl Work {
    fn run(&self, context: &Context) -> Result<(), GpuError> {
        match self {
            Self::Exactness => {
                let _ = context.is_exact();
                Ok(())
            }
            Self::Pipeline(source) => {
                context.pipelines.get(&context.gpu, context.checks, source).map(drop)
            }
        }
    }
}

impl Drop for Compilation {
    fn drop(&mut self) {
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl fmt::Debug for Background {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Background").field("known", &lock(&self.known).len()).finish()
    }
}
