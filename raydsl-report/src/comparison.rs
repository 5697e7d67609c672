//! Comparison of all variants of a kernel.

use std::time::Instant;

use super::{Accuracy, Times};
use raydsl::__private::report::{OutcomesOf, SAMPLES, causes, outcomes_of_frame, sampled, spread};
use raydsl::camera::Camera;
use raydsl::kernel::{Kernel, Variant, Variants};
use raydsl::machine::{Outcomes, Rounding, Type};
use raydsl::render::{Film, FilmArgs, Image, Radiance, Renderer, TiledScheduler};
use raydsl::testing::{
    Agreement, Cause, MeansAgreement, MeansTest, MeansVerdict, PairedMeans, Sample,
};

/// The settings of a comparison.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl_report::Compare;
///
/// let light = vec3(0.0, 1.0, 0.0);
/// let sky = kernel!(|ray: Ray| {
///     let up = ray.direction.dot(light);
///     Shaded { color: vec3(up, up, 1.0), depth: 0.0, id: 0 }
/// });
/// let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
/// let found = Compare::new().size(64, 48).variants(&Variants::cpu()).run(&sky, &camera);
/// assert!(found.agrees());
/// ```
pub struct Compare<'a> {
    width: u32,
    height: u32,
    runs: usize,
    tolerance: Option<u32>,
    samples: usize,
    rounding: Rounding,
    means: MeansTest,
    variants: Variants,
    #[cfg(feature = "gpu")]
    gpu: Option<&'a raydsl::gpu::GpuScheduler>,
    progress: Box<dyn FnMut(&str) + 'a>,
}

impl Default for Compare<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'a> Compare<'a> {
    /// Creates settings for every variant, 640 by 480 pixels, 5 rounds.
    pub fn new() -> Self {
        Self {
            width: 640,
            height: 480,
            runs: 5,
            tolerance: None,
            samples: SAMPLES,
            rounding: Rounding::WGSL,
            means: MeansTest::new(),
            variants: Variants::all(),
            #[cfg(feature = "gpu")]
            gpu: None,
            progress: Box::new(|_| {}),
        }
    }

    /// Sets the film's size in pixels.
    pub fn size(self, width: u32, height: u32) -> Self {
        Self { width, height, ..self }
    }

    /// Sets the number of timed rounds, after one that is not timed; at least 1.
    pub fn runs(self, runs: usize) -> Self {
        Self { runs: runs.max(1), ..self }
    }

    /// Sets a limit in ulp on the differences of the WGSL variant's numbers, in addition to the
    /// bounds on rounding; no limit unless set.
    pub fn tolerance(self, ulp: u32) -> Self {
        Self { tolerance: Some(ulp), ..self }
    }

    /// Sets the number of pixels computed in `f64`, spread evenly over the film: they give the
    /// share of uncertain ones and the error of every variant. 4096 unless set; a pixel takes some
    /// two hundred times as long as in the scalar variant. [`Compare::run_film`] explains a 64th as
    /// many differences, each of which may take 64 times as long, and counts the others as
    /// undecided.
    pub fn samples(self, samples: usize) -> Self {
        Self { samples, ..self }
    }

    /// Sets the device's rounding: [`Rounding::WGSL`] unless set.
    pub fn rounding(self, rounding: Rounding) -> Self {
        Self { rounding, ..self }
    }

    /// Sets the samples whose means [`Compare::run_film`] compares, and which bias it finds:
    /// [`MeansTest::new`] unless set.
    pub fn means(self, means: MeansTest) -> Self {
        Self { means, ..self }
    }

    /// Sets the variants to run; the scalar one always runs.
    pub fn variants(self, variants: &Variants) -> Self {
        Self { variants: variants.clone(), ..self }
    }

    /// Sets the device for the WGSL variant; the best of the machine unless set.
    #[cfg(feature = "gpu")]
    pub fn gpu(self, gpu: &'a raydsl::gpu::GpuScheduler) -> Self {
        Self { gpu: Some(gpu), ..self }
    }

    /// Calls `progress` with the name of every variant before it runs.
    pub fn progress(self, progress: impl FnMut(&str) + 'a) -> Self {
        Self { progress: Box::new(progress), ..self }
    }

    /// Runs the variants in turn, round by round, and compares frames: one ray through the centre of
    /// each pixel, and the first sample of a kernel's `Sampler`.
    ///
    /// A variant that cannot run (no device, no WGSL in this build) has a row with the reason.
    pub fn run<C: Camera, A: FilmArgs, R: Type>(
        self,
        kernel: &Kernel<'_, A, R>,
        camera: &C,
    ) -> Comparison<R> {
        self.run_and(kernel, camera, usize::MAX, |_, _, _| None)
    }

    /// Compares frames as [`Compare::run`] does, and the means of films besides: the films of CPU
    /// variants must have the same bits, and those of the WGSL variant agree by a [`MeansTest`].
    /// This decides where rounding leaves too many decisions open for a verdict on frames, as in a
    /// path tracer. Every variant takes [`MeansTest::replications`] times [`MeansTest::samples`]
    /// samples of each pixel.
    pub fn run_film<C: Camera, A: FilmArgs, R: Radiance>(
        self,
        kernel: &Kernel<'_, A, R>,
        camera: &C,
    ) -> Comparison<R> {
        let explained = self.samples.div_ceil(64);
        self.run_and(kernel, camera, explained, |settings, rows, gpu| {
            let test = settings.means;
            let new = || Film::new(settings.width, settings.height);
            let mut means = PairedMeans::new(&test, settings.width, settings.height);
            let (mut expected, mut found) = (new(), new());
            for sampling in test.replications() {
                let samples = sampling.planned;
                let cpu = |variant, film: &mut Film| {
                    film.clear();
                    let tiled = TiledScheduler::new().variant(variant);
                    tiled.accumulate(camera, kernel, &sampling, film, samples);
                };
                cpu(Variant::Scalar, &mut expected);
                for row in rows.iter_mut().filter(|r| r.unavailable.is_none()) {
                    match row.variant {
                        Variant::Scalar => {}
                        Variant::Wgsl => {
                            found.clear();
                            row.unavailable = gpu.film(camera, kernel, &sampling, &mut found).err();
                            if row.unavailable.is_none() {
                                means.add(&expected, &found);
                            }
                        }
                        variant => {
                            cpu(variant, &mut found);
                            row.differing_means += differing(&expected, &found);
                        }
                    }
                }
            }
            let ran = |r: &Row<R>| r.variant == Variant::Wgsl && r.unavailable.is_none();
            rows.iter().any(ran).then(|| means.agreement())
        })
    }

    /// Compares frames and explains at most `explained` differences of each variant; then compares
    /// by `means`.
    fn run_and<C: Camera, A: FilmArgs, R: Type>(
        mut self,
        kernel: &Kernel<'_, A, R>,
        camera: &C,
        explained: usize,
        means: impl FnOnce(&Self, &mut [Row<R>], &Device<'_>) -> Option<MeansAgreement>,
    ) -> Comparison<R> {
        #[cfg(feature = "gpu")]
        let own = self.own_gpu();
        #[cfg(feature = "gpu")]
        let device = Device(match (&own, self.gpu) {
            (_, Some(gpu)) => Ok(gpu),
            (Some(Ok(gpu)), None) => Ok(gpu),
            (Some(Err(e)), None) => Err(Missing::NoDevice(e.clone())),
            (None, None) => Err(Missing::NoDevice("not asked for".to_owned())),
        });
        #[cfg(not(feature = "gpu"))]
        let device = Device(core::marker::PhantomData);
        let mut rows: Vec<Row<R>> = self.variants.iter().map(|v| Row::new(v, &self)).collect();
        for round in 0..=self.runs {
            for row in rows.iter_mut().filter(|r| r.unavailable.is_none()) {
                (self.progress)(row.variant.name());
                let start = Instant::now();
                let outcome = match row.variant {
                    Variant::Wgsl => device.frame(camera, kernel, &mut row.image),
                    cpu => {
                        TiledScheduler::new().variant(cpu).frame(camera, kernel, &mut row.image);
                        Ok(())
                    }
                };
                // The first round warms caches and compiles pipelines.
                if round > 0 {
                    row.times.ms.push(start.elapsed().as_secs_f64() * 1e3);
                }
                row.unavailable = outcome.err();
            }
        }
        let means = means(&self, &mut rows, &device);
        let rays = camera.begin_frame(self.width, self.height);
        let (width, rounding) = (self.width, self.rounding);
        let pixel = |i: usize, limit| {
            let pixel = glam::uvec2(i as u32 % width, i as u32 / width);
            outcomes_of_frame(&rays, kernel, pixel, rounding, limit)
        };
        if let Some((scalar, others)) = rows.split_first_mut() {
            for row in others.iter_mut().filter(|r| r.unavailable.is_none()) {
                row.agreement = row.agreement_with(scalar, &pixel, explained);
            }
        }
        let indices = spread(self.width as usize * self.height as usize, self.samples);
        let sampled = sampled(&indices, &pixel);
        for row in &mut rows {
            row.accuracy = row.accuracy_at(&indices, &sampled);
        }
        let (sample, adapter) = (Sample::of(&sampled), device.adapter());
        Comparison { rows, adapter, tolerance: self.tolerance, rounding, sample, means }
    }

    #[cfg(feature = "gpu")]
    fn own_gpu(&self) -> Option<Result<raydsl::gpu::GpuScheduler, String>> {
        let wanted = self.variants.iter().any(|v| v == Variant::Wgsl) && self.gpu.is_none();
        wanted.then(|| raydsl::gpu::GpuScheduler::new().map_err(|e| e.to_string()))
    }
}

/// Returns the number of pixels whose means have other bits; NaN equals NaN.
fn differing(expected: &Film, found: &Film) -> u64 {
    let same = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan();
    let pairs = expected.means().zip(found.means());
    pairs.filter(|(a, b)| !(0..4).all(|i| same(a[i], b[i]))).count() as u64
}

/// The device of the WGSL variant, or why there is none.
#[cfg(feature = "gpu")]
struct Device<'g>(Result<&'g raydsl::gpu::GpuScheduler, Missing>);

#[cfg(feature = "gpu")]
impl Device<'_> {
    fn adapter(&self) -> Option<String> {
        self.0.as_ref().ok().map(|gpu| gpu.context().adapter_name())
    }

    fn frame<C: Camera, A: FilmArgs, R: Type>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        image: &mut Image<R>,
    ) -> Result<(), Missing> {
        let frame = self.0.clone()?.frame(camera, kernel, image);
        frame.map(drop).map_err(|e| Missing::Refused(e.to_string()))
    }

    fn film<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &raydsl::render::Sampling,
        film: &mut Film,
    ) -> Result<(), Missing> {
        let end = self.0.clone()?.accumulate(camera, kernel, sampling, film, sampling.planned);
        end.map(drop).map_err(|e| Missing::Refused(e.to_string()))
    }
}

#[cfg(not(feature = "gpu"))]
struct Device<'g>(core::marker::PhantomData<&'g ()>);

#[cfg(not(feature = "gpu"))]
impl Device<'_> {
    fn adapter(&self) -> Option<String> {
        None
    }

    fn none(&self) -> Result<(), Missing> {
        Err(Missing::NoDevice("raydsl-report was built without the feature `gpu`".to_owned()))
    }

    fn frame<C, A: Type, R: Type>(
        &self,
        _: &C,
        _: &Kernel<'_, A, R>,
        _: &mut Image<R>,
    ) -> Result<(), Missing> {
        self.none()
    }

    fn film<C, A: Type, R: Type>(
        &self,
        _: &C,
        _: &Kernel<'_, A, R>,
        _: &raydsl::render::Sampling,
        _: &mut Film,
    ) -> Result<(), Missing> {
        self.none()
    }
}

/// The row of one variant in a comparison.
#[derive(Clone, Debug)]
pub struct Row<R> {
    /// The variant.
    pub variant: Variant,
    /// The instruction set that ran it; `wgsl` for the device.
    pub isa: &'static str,
    /// The number of rays that run at once.
    pub lanes: usize,
    /// Run times of a frame.
    pub times: Times,
    /// The rendered image.
    pub image: Image<R>,
    /// The agreement with the scalar variant.
    pub agreement: Agreement,
    /// The means of pixels, over all replications, that differ from the scalar variant's in a bit;
    /// for variants of the CPU, and only by [`Compare::run_film`].
    pub differing_means: u64,
    /// The errors against the reference in `f64`, at the sampled pixels.
    pub accuracy: Accuracy,
    /// The reason why the variant did not run, if it did not.
    pub unavailable: Option<Missing>,
}

/// The reason why a variant did not run.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Missing {
    /// No device, or no GPU support in this build.
    NoDevice(String),
    /// The device refuses the kernel, or was lost. The comparison fails.
    Refused(String),
}

impl core::fmt::Display for Missing {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let (Self::NoDevice(why) | Self::Refused(why)) = self;
        f.write_str(why)
    }
}

impl<R: Type> Row<R> {
    fn new(variant: Variant, settings: &Compare<'_>) -> Self {
        let (isa, lanes) = variant.isa();
        let empty = R::read(&vec![0; R::SCHEMA.size()]);
        let image = Image::filled(settings.width, settings.height, empty);
        let agreement = Agreement::of(image.pixels(), image.pixels());
        Self {
            variant,
            isa,
            lanes,
            times: Times::default(),
            image,
            agreement,
            differing_means: 0,
            accuracy: Accuracy::default(),
            unavailable: None,
        }
    }

    /// Compares with the scalar variant. CPU variants must have the same bits, so nothing is
    /// explained there.
    fn agreement_with(&self, scalar: &Self, outcomes: OutcomesOf<'_>, explained: usize) -> Agreement
    where
        R: Sync,
    {
        let (expected, found) = (scalar.image.pixels(), self.image.pixels());
        if self.variant != Variant::Wgsl {
            return Agreement::judged(expected, found, |_, _| Cause::Unexplained);
        }
        let causes = causes(expected, found, outcomes, explained);
        let cause = |i: usize| causes.binary_search_by_key(&i, |(at, _)| *at);
        Agreement::judged(expected, found, |i, _| cause(i).map_or(Cause::Same, |at| causes[at].1))
    }

    fn accuracy_at(&self, indices: &[usize], sampled: &[Outcomes]) -> Accuracy {
        let pixel = |i: &usize| self.image.pixels()[*i];
        let references = sampled.iter().map(Outcomes::reference);
        Accuracy::of(indices.iter().map(pixel).zip(references))
    }

    /// Returns millions of camera rays per second.
    pub fn mrays_per_s(&self) -> f64 {
        let rays = f64::from(self.image.width()) * f64::from(self.image.height());
        let ms = self.times.median();
        if ms > 0.0 { rays / ms * 1e-3 } else { 0.0 }
    }
}

/// The result of [`Compare::run`] or [`Compare::run_film`].
#[must_use = "a comparison that nobody reads finds nothing"]
#[derive(Clone, Debug)]
pub struct Comparison<R> {
    /// A row for each variant, the scalar one first.
    pub rows: Vec<Row<R>>,
    /// The device that ran the WGSL variant.
    pub adapter: Option<String>,
    /// The limit in ulp on the WGSL variant's numbers, if there is one besides rounding's.
    pub tolerance: Option<u32>,
    /// The device's rounding.
    pub rounding: Rounding,
    /// The number of pixels computed in `f64`, and of uncertain ones among them.
    pub sample: Sample,
    /// The agreement of the WGSL variant's means, if [`Compare::run_film`] ran it.
    pub means: Option<MeansAgreement>,
}

/// The verdict of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// CPU variants have the same bits. Rounding explains every difference of WGSL, and numbers are
    /// within [`Compare::tolerance`] if it was set.
    Agree,
    /// CPU variants have the same bits. Rounding leaves too many decisions of WGSL open for a verdict
    /// on single samples, but the means agree, and nothing else is known to differ.
    MeansAgree,
    /// A variant differs by more than that.
    Differ,
    /// The variants that ran agree, but the device refuses the kernel, or was lost.
    Refused,
    /// Rounding explains the differences, but more than 1 % of the sampled pixels are uncertain or
    /// none was sampled, so this means little; and means were not compared, or from too few samples.
    NotMeaningful,
    /// No variant but the scalar one ran, or the film has no pixels.
    NothingCompared,
}

impl<R: Type> Comparison<R> {
    /// Returns the row of the scalar variant.
    pub fn scalar(&self) -> &Row<R> {
        &self.rows[0]
    }

    /// Returns whether the verdict is [`Verdict::Agree`] or [`Verdict::MeansAgree`]. A variant
    /// without a device does not count.
    pub fn agrees(&self) -> bool {
        matches!(self.verdict(), Verdict::Agree | Verdict::MeansAgree)
    }

    /// Returns the verdict.
    pub fn verdict(&self) -> Verdict {
        let is_refused = |r: &Row<R>| matches!(r.unavailable, Some(Missing::Refused(_)));
        let ran = || self.rows.iter().filter(|r| r.unavailable.is_none());
        let means = self.means.as_ref().map(MeansAgreement::verdict);
        let undecided = ran().any(|r| r.agreement.undecided > 0);
        if !ran().all(|r| self.is_fine(r)) || means == Some(MeansVerdict::Differ) {
            return Verdict::Differ;
        }
        if undecided && means.is_none() {
            return Verdict::Differ;
        }
        if self.rows.iter().any(is_refused) {
            return Verdict::Refused;
        }
        let forgiven = ran().any(|r| !r.agreement.is_bit_identical());
        let is_open = undecided || forgiven && !self.sample.is_meaningful();
        match ran().count() {
            0 | 1 => Verdict::NothingCompared,
            _ if self.scalar().image.pixels().is_empty() => Verdict::NothingCompared,
            _ if is_open && means == Some(MeansVerdict::Agree) => Verdict::MeansAgree,
            _ if is_open => Verdict::NotMeaningful,
            _ => Verdict::Agree,
        }
    }

    /// Returns whether nothing is known to be wrong with a variant that ran.
    fn is_fine(&self, row: &Row<R>) -> bool {
        let found = &row.agreement;
        let within = self.tolerance.is_none_or(|most| found.max_ulp <= most);
        match row.variant {
            Variant::Wgsl => found.unexplained == 0 && within,
            _ => found.is_bit_identical() && row.differing_means == 0,
        }
    }

    /// Returns the table, at most 100 columns wide.
    pub fn table(&self) -> String {
        super::table::table(self)
    }

    /// Returns the figures and those of the scene, as JSON.
    pub fn json(&self, scene: &super::SceneInfo) -> serde_json::Value {
        super::json::json(self, scene)
    }
}

/// Runs a kernel in `variants` at 640 by 480 pixels and compares; see [`Compare`] for settings.
pub fn compare<C: Camera, A: FilmArgs, R: Type>(
    kernel: &Kernel<'_, A, R>,
    camera: &C,
    variants: Variants,
) -> Comparison<R> {
    Compare::new().variants(&variants).run(kernel, camera)
}
