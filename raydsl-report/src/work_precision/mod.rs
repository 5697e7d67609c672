//! Work-precision diagrams: the error of methods and variants against run time.
//!
//! A [`Case`] computes a known quantity by several [`Method`]s, each with a knob that makes it more
//! accurate and slower. [`WorkPrecision`] runs all of them on each [`Backend`], in turn, and
//! returns a [`Report`]: a [`Curve`] for each method and backend with its [fitted order](Fit) and a
//! [`Verdict`] on it, as tables, as JSON and CSV, and as a [`Drawing`]. Omissions are listed with
//! their reasons.
//!
//! ```
//! use raydsl::prelude::*;
//! use raydsl_report::work_precision::*;
//!
//! let case = Case::new("x y", Reference::closed_form(0.25), |run: &Run| {
//!     run.integral(&kernel!(|_ray: Ray, sampler: Sampler| {
//!         let mut sampler = sampler;
//!         let u = sampler.next_2d();
//!         u.x * u.y
//!     }))
//! });
//! let case = case.method(SampleMethod::Random, Some(Order::RANDOM));
//! let report = WorkPrecision::new()
//!     .knobs(&[4, 16, 64])
//!     .backends(&[Backend::Variant(Variant::Scalar)])
//!     .run(&[case])?;
//! assert_eq!(report.cases[0].curves[0].verdict(), Verdict::AsExpected);
//! println!("{}", report.table());
//! # Ok::<(), WorkPrecisionError>(())
//! ```
//!
//! The form follows the work-precision diagrams in Hairer, Nørsett and Wanner, "Solving Ordinary
//! Differential Equations I" (1993), section II.10.

mod case;
mod choice;
mod cpu_clock;
mod csv;
mod curve;
mod drawing;
mod efficiency;
mod environment;
mod error;
mod errors;
mod files;
mod fit;
#[cfg(feature = "flip")]
mod flip;
mod json;
mod measure;
mod metrics;
mod omissions;
mod plot;
mod reference;
mod run;
mod table;
mod work;

use std::time::Duration;

pub use case::{Backend, Case, Method, Order};
pub use curve::{Curve, Point, Repetition, Speedup, Status, Verdict};
#[cfg(feature = "png")]
pub use drawing::PngError;
pub use drawing::{Anchor, Color, Drawing, Mark, Symbol};
pub use efficiency::Efficiency;
pub use environment::Environment;
pub use error::{MAX_KNOB, WorkPrecisionError};
pub use fit::{Fit, Reached};
#[cfg(feature = "flip")]
pub use flip::{Flip, FlipError};
pub use metrics::{FORMULAS, Metrics};
pub use reference::{Reference, ReferenceKind};
pub use run::{Estimates, Run};
pub use work::Work;

use raydsl::kernel::Variant;

/// The settings of a measurement.
pub struct WorkPrecision<'a> {
    knobs: Option<Vec<u32>>,
    methods: Option<Vec<String>>,
    backends: Vec<Backend>,
    repetitions: u32,
    time: Duration,
    size: (u32, u32),
    commit: Option<String>,
    omitted: Vec<Omitted>,
    #[cfg(feature = "gpu")]
    gpu: Option<&'a raydsl::gpu::GpuScheduler>,
    progress: Box<dyn FnMut(&str) + 'a>,
}

impl Default for WorkPrecision<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'a> WorkPrecision<'a> {
    /// Creates settings for all methods on the scalar variant, packets of 8 and 16 and WGSL, with
    /// each case's own values of the knob, 5 repetitions, 16 by 16 pixels and at most 30 seconds for
    /// each case.
    pub fn new() -> Self {
        let variants = [Variant::Scalar, Variant::Packet8, Variant::Packet16, Variant::Wgsl];
        Self {
            knobs: None,
            methods: None,
            backends: variants.map(Backend::Variant).to_vec(),
            repetitions: 5,
            time: Duration::from_secs(30),
            size: (16, 16),
            commit: None,
            omitted: Vec::new(),
            #[cfg(feature = "gpu")]
            gpu: None,
            progress: Box::new(|_| {}),
        }
    }

    /// Sets the knob's values for all cases: increasing, from 1 to [`MAX_KNOB`]. Without it each
    /// case has [its own](Case::values).
    pub fn knobs(self, knobs: &[u32]) -> Self {
        Self { knobs: Some(knobs.to_vec()), ..self }
    }

    /// Returns the knob's values for a case.
    fn knobs_of<'v>(&'v self, case: &'v Case<'_>) -> &'v [u32] {
        self.knobs.as_ref().unwrap_or(&case.values)
    }

    /// Selects the methods of these names; a case's others are listed as omitted.
    pub fn methods(self, names: &[&str]) -> Self {
        Self { methods: Some(names.iter().map(|n| (*n).to_owned()).collect()), ..self }
    }

    /// Sets the backends. Speed-ups are over the first one.
    pub fn backends(self, backends: &[Backend]) -> Self {
        Self { backends: backends.to_vec(), ..self }
    }

    /// Sets the number of runs of each point, each with another seed; at least one.
    pub fn repetitions(self, repetitions: u32) -> Self {
        Self { repetitions: repetitions.max(1), ..self }
    }

    /// Sets the time budget of a case; each curve has an equal share, and its first point is run in
    /// any case.
    pub fn time(self, time: Duration) -> Self {
        Self { time, ..self }
    }

    /// Sets the film's size: for an integral, the number of independent estimates in a run.
    pub fn size(self, width: u32, height: u32) -> Self {
        Self { size: (width, height), ..self }
    }

    /// Sets the commit of the measured source, for the files; `unknown` unless set. It is not
    /// detected.
    pub fn commit(self, commit: impl Into<String>) -> Self {
        Self { commit: Some(commit.into()), ..self }
    }

    /// Records a case that is not measured, and why: the files list it as omitted.
    pub fn omit(mut self, case: impl Into<String>, why: impl Into<String>) -> Self {
        self.omitted.push(Omitted { case: case.into(), why: why.into() });
        self
    }

    /// Sets the device for WGSL; the best of the machine unless set.
    #[cfg(feature = "gpu")]
    pub fn gpu(self, gpu: &'a raydsl::gpu::GpuScheduler) -> Self {
        Self { gpu: Some(gpu), ..self }
    }

    /// Calls `progress` with the name of every case and the index of the repetition before it runs.
    pub fn progress(self, progress: impl FnMut(&str) + 'a) -> Self {
        Self { progress: Box::new(progress), ..self }
    }

    /// Measures the cases: first every curve's first point once, which warms caches and compiles
    /// pipelines and is not timed; then all repetitions, with methods and backends in turn.
    ///
    /// A backend that cannot run has a curve with the reason.
    ///
    /// # Errors
    ///
    /// If settings or references are invalid, or estimates do not fit the reference.
    pub fn run(mut self, cases: &[Case<'_>]) -> Result<Report, WorkPrecisionError> {
        self.check(cases)?;
        #[cfg(feature = "gpu")]
        let own = self.own_gpu();
        #[cfg(feature = "gpu")]
        let gpu = self.gpu.or(own.as_ref());
        let environment = Environment::of(
            &self.backends,
            self.commit.clone(),
            #[cfg(feature = "gpu")]
            gpu,
        );
        let mut measured = Vec::new();
        for case in cases {
            measured.push(self.measure(
                case,
                #[cfg(feature = "gpu")]
                gpu,
            )?);
        }
        Ok(Report { environment, size: self.size, cases: measured, omitted: self.omitted })
    }

    #[cfg(feature = "gpu")]
    fn own_gpu(&self) -> Option<raydsl::gpu::GpuScheduler> {
        let is_wanted = self.backends.contains(&Backend::Variant(Variant::Wgsl));
        let is_missing = is_wanted && self.gpu.is_none();
        is_missing.then(raydsl::gpu::GpuScheduler::new).and_then(Result::ok)
    }

    fn check(&self, cases: &[Case<'_>]) -> Result<(), WorkPrecisionError> {
        let nothing = |what| Err(WorkPrecisionError::Nothing { what });
        if cases.is_empty() {
            return nothing("case");
        }
        if self.backends.is_empty() {
            return nothing("backend");
        }
        let (width, height) = self.size;
        if !(1..=1u64 << 24).contains(&(u64::from(width) * u64::from(height))) {
            return Err(WorkPrecisionError::Size { width, height });
        }
        for (i, case) in cases.iter().enumerate() {
            if case.name.is_empty() || cases[..i].iter().any(|c| c.name == case.name) {
                return Err(WorkPrecisionError::Name { case: case.name.clone() });
            }
            case.reference.check(&case.name)?;
            let knobs = self.knobs_of(case);
            if knobs.is_empty() {
                return nothing("value of the knob");
            }
            let out_of_order = |(i, k): (usize, &u32)| i > 0 && *k <= knobs[i - 1];
            let is_bad = |k: u32| !(1..=MAX_KNOB).contains(&k);
            if let Some((_, value)) =
                knobs.iter().enumerate().find(|k| is_bad(*k.1) || out_of_order(*k))
            {
                return Err(WorkPrecisionError::Knob { value: *value });
            }
            if !case.methods.iter().any(|(m, _)| self.is_chosen(m)) {
                return nothing("method of a case");
            }
        }
        Ok(())
    }

    fn is_chosen(&self, method: &Method) -> bool {
        self.methods.as_ref().is_none_or(|names| names.contains(&method.name))
    }
}

/// The result of [`WorkPrecision::run`].
#[must_use = "a report that nobody reads finds nothing"]
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The environment.
    pub environment: Environment,
    /// The film's size.
    pub size: (u32, u32),
    /// The cases in order.
    pub cases: Vec<Measured>,
    /// The [omitted](WorkPrecision::omit) cases.
    pub omitted: Vec<Omitted>,
}

/// A case that was not measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Omitted {
    /// Its name.
    pub case: String,
    /// The reason, in a line.
    pub why: String,
}

/// The results of one case.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Its name.
    pub name: String,
    /// The name of the cases that it is compared with; may be empty.
    pub family: String,
    /// The knob's name.
    pub knob: String,
    /// The kind of its reference.
    pub kind: ReferenceKind,
    /// The uncertainty of the reference.
    pub uncertainty: f64,
    /// The rounding error of `f32`: two roundings of 2^-24 each of the root of the reference's mean
    /// square.
    pub rounding_floor: f64,
    /// The build time in seconds of the data that runs use, if the case gives it.
    pub build: Option<f64>,
    /// A curve for each method and backend.
    pub curves: Vec<Curve>,
    /// Methods of the case that were not selected.
    pub not_asked_for: Vec<String>,
}
