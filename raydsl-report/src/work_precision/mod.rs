//! Error against run time: which method, on which variant, gives an error soonest?
//!
//! A [`Case`] computes something known by several [`Method`]s, each with a knob that makes it
//! better and slower. [`WorkPrecision`] runs all of them on each [`Backend`], in turn, and makes a
//! [`Report`]: a [`Curve`] for each method and backend with its [fitted order](Fit) and a
//! [`Verdict`] on it, as tables, as numbers for programs, and as a [`Drawing`]. What was left out
//! is listed with its reason.
//!
//! ```
//! use raydsl::prelude::*;
//! use raydsl_report::work_precision::*;
//!
//! let case = Case::new("x y", Reference::closed_form(0.25), |run: &Run| {
//!     let method = run.method().sampling();
//!     run.integral(&kernel!(|_ray: Ray, sampler: Sampler| {
//!         let mut sampler = sampler;
//!         let u = sampler.next_2d(host(method));
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
//! The rules of the form are those of work-precision diagrams as in Hairer, Nørsett and Wanner,
//! "Solving Ordinary Differential Equations I" (1993), section II.10.

mod case;
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

/// Settings of a measurement.
pub struct WorkPrecision<'a> {
    knobs: Vec<u32>,
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
    /// All methods on the scalar variant, packets of 8 and 16 and WGSL, with 16, 64, 256, 1024 and
    /// 4096 for the knob, 5 repetitions, 16 by 16 pixels and at most 30 seconds for each case.
    pub fn new() -> Self {
        let variants = [Variant::Scalar, Variant::Packet8, Variant::Packet16, Variant::Wgsl];
        Self {
            knobs: vec![16, 64, 256, 1024, 4096],
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

    /// The knob's values: rising, from 1 to [`MAX_KNOB`].
    pub fn knobs(self, knobs: &[u32]) -> Self {
        Self { knobs: knobs.to_vec(), ..self }
    }

    /// Only the methods of these names; a case's others are listed as left out.
    pub fn methods(self, names: &[&str]) -> Self {
        Self { methods: Some(names.iter().map(|n| (*n).to_owned()).collect()), ..self }
    }

    /// What runs the kernels. Speed-ups are those over the first one.
    pub fn backends(self, backends: &[Backend]) -> Self {
        Self { backends: backends.to_vec(), ..self }
    }

    /// How often each point is run, with another seed each time; at least once.
    pub fn repetitions(self, repetitions: u32) -> Self {
        Self { repetitions: repetitions.max(1), ..self }
    }

    /// How long the runs of one case may take; each curve has an equal share, and its first point
    /// is run in any case.
    pub fn time(self, time: Duration) -> Self {
        Self { time, ..self }
    }

    /// The film's size: of an integral, how many independent estimates a run has.
    pub fn size(self, width: u32, height: u32) -> Self {
        Self { size: (width, height), ..self }
    }

    /// The commit of the source that is measured, for the files; `unknown` unless this is called.
    /// Nothing here looks for it.
    pub fn commit(self, commit: impl Into<String>) -> Self {
        Self { commit: Some(commit.into()), ..self }
    }

    /// Notes a case that is not measured, and why: the files name it among what is left out.
    pub fn omit(mut self, case: impl Into<String>, why: impl Into<String>) -> Self {
        self.omitted.push(Omitted { case: case.into(), why: why.into() });
        self
    }

    /// The device for WGSL; without this the best of the machine.
    #[cfg(feature = "gpu")]
    pub fn gpu(self, gpu: &'a raydsl::gpu::GpuScheduler) -> Self {
        Self { gpu: Some(gpu), ..self }
    }

    /// Calls `progress` with the name of every case and the number of the repetition before it
    /// runs.
    pub fn progress(self, progress: impl FnMut(&str) + 'a) -> Self {
        Self { progress: Box::new(progress), ..self }
    }

    /// Measures: first every curve's first point once, which warms caches and compiles pipelines
    /// and is not timed; then all repetitions, methods and backends taking turns.
    ///
    /// A backend that cannot run has a curve that says why.
    ///
    /// # Errors
    ///
    /// Settings or references that make no measurement, and estimates that do not fit the
    /// reference.
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
        if self.knobs.is_empty() {
            return nothing("value of the knob");
        }
        if self.backends.is_empty() {
            return nothing("backend");
        }
        let out_of_order = |(i, k): (usize, &u32)| i > 0 && *k <= self.knobs[i - 1];
        let is_bad = |k: u32| !(1..=MAX_KNOB).contains(&k);
        let mut knobs = self.knobs.iter().enumerate();
        if let Some((_, value)) = knobs.find(|k| is_bad(*k.1) || out_of_order(*k)) {
            return Err(WorkPrecisionError::Knob { value: *value });
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

/// What [`WorkPrecision::run`] found.
#[must_use = "a report that nobody reads finds nothing"]
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// What it was measured on.
    pub environment: Environment,
    /// The film's size.
    pub size: (u32, u32),
    /// The cases in their order.
    pub cases: Vec<Measured>,
    /// Cases that were [left out](WorkPrecision::omit).
    pub omitted: Vec<Omitted>,
}

/// A case that was not measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Omitted {
    /// Its name.
    pub case: String,
    /// Why, in a line.
    pub why: String,
}

/// What was found of one case.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Its name.
    pub name: String,
    /// What its knob is called.
    pub knob: String,
    /// Where its reference comes from.
    pub kind: ReferenceKind,
    /// How far the reference may be off.
    pub uncertainty: f64,
    /// The error that rounding to `f32` leaves: two roundings of 2^-24 each of the root of the
    /// reference's mean square.
    pub rounding_floor: f64,
    /// Seconds that it took to build what its runs use, if the case says so.
    pub build: Option<f64>,
    /// A curve for each method and backend.
    pub curves: Vec<Curve>,
    /// Methods of the case that were not asked for.
    pub not_asked_for: Vec<String>,
}
