//! Cases to measure, and their methods and backends.

use std::time::Duration;

use super::reference::Reference;
use super::run::{Estimates, Run};
use super::work::Work;
use crate::Missing;
use raydsl::kernel::Variant;
use raydsl::sampling::SampleMethod;

/// A backend that runs a kernel: a [`Variant`], or the reference machine in `f64`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Backend {
    /// A variant.
    Variant(Variant),
    /// The same kernel in `f64`, one sample at a time: some two hundred times as slow as the scalar
    /// variant.
    F64,
}

impl Backend {
    /// Every backend: `scalar`, `packet4`, `packet8`, `packet16`, `wgsl`, `f64`.
    pub const ALL: [Self; 6] = [
        Self::Variant(Variant::Scalar),
        Self::Variant(Variant::Packet4),
        Self::Variant(Variant::Packet8),
        Self::Variant(Variant::Packet16),
        Self::Variant(Variant::Wgsl),
        Self::F64,
    ];

    /// Returns the variant's name, or `f64`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Variant(variant) => variant.name(),
            Self::F64 => "f64",
        }
    }

    /// Returns the backend of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|b| b.name() == name)
    }

    /// Returns the number of rays that run at once on this machine.
    pub fn lanes(self) -> usize {
        match self {
            Self::Variant(variant) => variant.isa().1,
            Self::F64 => 1,
        }
    }
}

/// One method to compute a case's result. Converted from a [`SampleMethod`] its name is `random`,
/// `stratified` or `sobol`; converted from a text it has that name, for methods of your own, such
/// as quadrature rules.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Method {
    pub(super) name: String,
    pub(super) sampling: SampleMethod,
}

impl Method {
    /// Returns the name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the sampling method; [`SampleMethod::Sobol`] for a method of your own.
    pub fn sampling(&self) -> SampleMethod {
        self.sampling
    }
}

impl From<SampleMethod> for Method {
    fn from(sampling: SampleMethod) -> Self {
        let name = match sampling {
            SampleMethod::Random => "random",
            SampleMethod::Stratified => "stratified",
            SampleMethod::Sobol => "sobol",
        };
        Self { name: name.to_owned(), sampling }
    }
}

impl From<&str> for Method {
    fn from(name: &str) -> Self {
        Self { name: name.to_owned(), sampling: SampleMethod::Sobol }
    }
}

/// The order of convergence: the range of the knob's exponents in the error, from `steepest` to
/// `flattest`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// The smallest exponent that theory allows.
    pub steepest: f64,
    /// The largest exponent that theory allows.
    pub flattest: f64,
}

impl Order {
    /// The order of independent samples: -0.5, to within 0.05.
    pub const RANDOM: Self = Self::near(-0.5, 0.05);

    /// Returns the order `order`, to within `slack`.
    pub const fn near(order: f64, slack: f64) -> Self {
        Self { steepest: order - slack, flattest: order + slack }
    }

    /// Returns the order `flattest`, or any below it.
    pub const fn at_most(flattest: f64) -> Self {
        Self { steepest: f64::NEG_INFINITY, flattest }
    }
}

/// The knob's values of cases that set none.
const VALUES: [u32; 5] = [16, 64, 256, 1024, 4096];

pub(super) type Estimate<'a> = dyn Fn(&Run<'_>) -> Result<Estimates, Missing> + 'a;
pub(super) type Count<'a> = dyn Fn(&Run<'_>) -> Work + 'a;

/// A quantity computed by several methods, each with a knob that makes it more accurate and slower,
/// and its reference.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl_report::work_precision::{Case, Order, Reference, Run};
///
/// // The integral of x y over the unit square.
/// let case = Case::new("x y", Reference::closed_form(0.25), |run: &Run| {
///     run.integral(&kernel!(|_ray: Ray, sampler: Sampler| {
///         let mut sampler = sampler;
///         let u = sampler.next_2d();
///         u.x * u.y
///     }))
/// });
/// let case = case
///     .method(SampleMethod::Random, Some(Order::RANDOM))
///     .method(SampleMethod::Sobol, Some(Order::at_most(-1.2)));
/// assert_eq!(case.name(), "x y");
/// ```
pub struct Case<'a> {
    pub(super) name: String,
    pub(super) family: String,
    pub(super) knob: String,
    pub(super) values: Vec<u32>,
    pub(super) reference: Reference,
    pub(super) methods: Vec<(Method, Option<Order>)>,
    pub(super) estimate: Box<Estimate<'a>>,
    pub(super) count: Option<Box<Count<'a>>>,
    pub(super) build: Option<Duration>,
}

impl core::fmt::Debug for Case<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let methods: Vec<&str> = self.methods().map(Method::name).collect();
        f.debug_struct("Case")
            .field("name", &self.name)
            .field("knob", &self.knob)
            .field("reference", &self.reference)
            .field("methods", &methods)
            .finish_non_exhaustive()
    }
}

impl<'a> Case<'a> {
    /// Creates a case without methods. `estimate` computes it according to the [`Run`], and is the
    /// code that is timed.
    pub fn new(
        name: impl Into<String>,
        reference: Reference,
        estimate: impl Fn(&Run<'_>) -> Result<Estimates, Missing> + 'a,
    ) -> Self {
        Self {
            name: name.into(),
            family: String::new(),
            knob: "spp".to_owned(),
            values: VALUES.to_vec(),
            reference,
            methods: Vec::new(),
            estimate: Box::new(estimate),
            count: None,
            build: None,
        }
    }

    /// Sets the knob's name: `spp` (samples per pixel) unless set. A case whose knob is not a
    /// number of samples gives that number by [`Run::with_samples`].
    pub fn knob(self, name: impl Into<String>) -> Self {
        Self { knob: name.into(), ..self }
    }

    /// Sets the knob's values where [`WorkPrecision::knobs`](super::WorkPrecision::knobs) does not:
    /// increasing, from 1 to [`MAX_KNOB`](super::MAX_KNOB); 16, 64, 256, 1024 and 4096 unless set.
    pub fn values(self, values: &[u32]) -> Self {
        Self { values: values.to_vec(), ..self }
    }

    /// Sets the name of the cases that it is compared with, which have the same methods: see
    /// [`Report::choice`](super::Report::choice).
    pub fn family(self, name: impl Into<String>) -> Self {
        Self { family: name.into(), ..self }
    }

    /// Adds a method and its theoretical order, if there is one.
    pub fn method(mut self, method: impl Into<Method>, order: Option<Order>) -> Self {
        self.methods.push((method.into(), order));
        self
    }

    /// Counts the work of a run separately from the timed runs: `count` is called once for each
    /// method and value of the knob, with the first seed, after all of them. It replaces
    /// [`Estimates::work`](super::Estimates::work), and its time is no part of the case's.
    ///
    /// [`Run::film_work`] and [`Run::integral_work`] add up the costs that the queries
    /// `closest_hit_with_cost` and `any_hit_with_cost` return.
    pub fn counted(self, count: impl Fn(&Run<'_>) -> Work + 'a) -> Self {
        Self { count: Some(Box::new(count)), ..self }
    }

    /// Sets the build time of the data that runs use, such as a tree. It is written to the files,
    /// and is no part of a run's time.
    pub fn built_in(self, time: Duration) -> Self {
        Self { build: Some(time), ..self }
    }

    /// Returns the name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the knob's name.
    pub fn knob_name(&self) -> &str {
        &self.knob
    }

    /// Returns its methods in order.
    pub fn methods(&self) -> impl Iterator<Item = &Method> {
        self.methods.iter().map(|(method, _)| method)
    }

    /// Returns the reference.
    pub fn reference(&self) -> &Reference {
        &self.reference
    }

    /// Computes the case once.
    ///
    /// # Errors
    ///
    /// If the backend cannot run it.
    pub fn estimate(&self, run: &Run<'_>) -> Result<Estimates, Missing> {
        (self.estimate)(run)
    }
}
