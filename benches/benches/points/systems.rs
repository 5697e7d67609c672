//! Who builds trees over the points and asks them, and what that gave.

use raydsl::camera::Camera;
use raydsl::prelude::*;
use raydsl_benches::clock::seconds_on;
use raydsl_benches::contest::{Cost, Outcome, pixels};
use raydsl_benches::device::device_seconds;
use raydsl_benches::embree::{self, Embree, Mode, Quality, Question, Robustness, Shape};
use raydsl_benches::scenes::Point;

/// The library's trees, and whether they are wide. `Best` splits primitives, from which balls of
/// one size gain nothing.
const TREES: [(&str, BuildQuality, bool); 3] = [
    ("balanced", BuildQuality::Balanced, false),
    ("fast", BuildQuality::Fast, false),
    ("wide", BuildQuality::Balanced, true),
];

/// What all systems are asked.
pub(crate) struct Task<'a> {
    pub(crate) points: &'a [Point],
    camera: Pinhole,
    size: u32,
    /// The camera's rays, in blocks of pixels.
    pub(crate) primary: Vec<Ray>,
    pub(crate) threads: usize,
    device: Option<&'a GpuScheduler>,
    /// The points as Embree reads them.
    shape: Shape,
}

/// What the rounds gave for one mode.
pub(crate) struct Record {
    pub(crate) row: &'static str,
    pub(crate) system: &'static str,
    pub(crate) mode: String,
    pub(crate) isa: &'static str,
    pub(crate) lanes: usize,
    pub(crate) cost: Cost,
    pub(crate) seconds: Vec<f64>,
    pub(crate) outcome: Outcome,
}

/// Who runs, and in which way.
struct Who {
    system: &'static str,
    mode: String,
    isa: &'static str,
    lanes: usize,
}

/// Interleaved rounds.
pub(crate) struct Rounds<'a> {
    task: &'a Task<'a>,
    embree: Option<Embree>,
    /// The one that is running; the first warms up.
    round: usize,
    records: Vec<Record>,
}

impl<'a> Task<'a> {
    pub(crate) fn new(
        points: &'a [Point],
        camera: Pinhole,
        size: u32,
        threads: usize,
        device: Option<&'a GpuScheduler>,
    ) -> Self {
        let rays = camera.begin_frame(size, size);
        let ray = |(x, y)| rays.primary_ray(x as f32 + 0.5, y as f32 + 0.5);
        let primary = pixels(size).into_iter().map(ray).collect();
        let sphere = |p: &Point| [p.center.x, p.center.y, p.center.z, p.radius];
        let shape = Shape::Spheres(points.iter().map(sphere).collect());
        Self { points, camera, size, primary, threads, device, shape }
    }

    fn frame<R: Type>(
        &self,
        variant: Variant,
        kernel: &Kernel<'_, (Ray,), R>,
        blank: R,
    ) -> (Image<R>, f64) {
        let mut image = Image::filled(self.size, self.size, blank);
        if let (Variant::Wgsl, Some(gpu)) = (variant, self.device) {
            let seconds = device_seconds(|| gpu.frame(&self.camera, kernel, &mut image));
            return (image, seconds);
        }
        let scheduler = TiledScheduler::new().variant(variant);
        let run = || scheduler.frame(&self.camera, kernel, &mut image);
        let ((), seconds) = seconds_on(self.threads, run);
        (image, seconds)
    }

    /// How long the camera's rays take to make: kernels do that while they ask.
    fn generation(&self) -> f64 {
        let kernel = kernel!(|ray: Ray| {
            let sum = ray.origin + ray.direction;
            sum.x + sum.y + sum.z
        });
        self.frame(Variant::widest(), &kernel, 0.0).1
    }
}

impl<'a> Rounds<'a> {
    /// Loads Embree, if it is there.
    pub(crate) fn new(task: &'a Task<'a>) -> Self {
        let load = |path| {
            let loaded = Embree::load(path, task.threads);
            loaded.inspect_err(|error| eprintln!("skipped Embree: {error}")).ok()
        };
        let embree = embree::path().as_deref().and_then(load);
        Self { task, embree, round: 0, records: Vec::new() }
    }

    /// Runs them, row by row.
    pub(crate) fn run(mut self, rounds: usize) -> Vec<Record> {
        for round in 0..=rounds {
            self.round = round;
            for (name, quality, is_wide) in TREES {
                self.own(name, &quality.into(), is_wide);
            }
            for quality in [Quality::Low, Quality::Medium, Quality::High] {
                self.theirs(quality);
            }
        }
        self.records.sort_by_key(|record| record.row);
        self.records
    }

    fn own(&mut self, name: &str, config: &BuildConfig, is_wide: bool) {
        let task = self.task;
        let build = || match is_wide {
            true => Bvh::build_wide(task.points, &[], config),
            false => Bvh::build_with(task.points, config),
        };
        let (bvh, seconds) = seconds_on(task.threads, build);
        let bvh = bvh.expect("the points have finite bounds");
        let cost = Cost::new(seconds, bvh.bytes(), task.points.len());
        let who = |mode, (isa, lanes)| Who { system: "raydsl", mode, isa, lanes };
        let built = Outcome { seconds, ..Outcome::default() };
        self.note("build", who(name.to_owned(), ("", 0)), cost, built);
        let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
        let has_device = task.device.is_some();
        for variant in Variant::ALL.into_iter().filter(|v| v.is_native() || has_device) {
            let (image, seconds) = task.frame(variant, &kernel, Hit::miss());
            let hits = image.pixels().iter().filter(|hit| hit.is_hit);
            let distance = hits.clone().map(|hit| f64::from(hit.t)).sum();
            let outcome = Outcome { seconds, hits: hits.count(), distance };
            let mode = format!("{} {name}", variant.name());
            let isa = if variant.is_native() { variant.isa() } else { ("device", 0) };
            self.note("primary", who(mode, isa), cost, outcome);
        }
    }

    fn theirs(&mut self, quality: Quality) {
        let Some(embree) = self.embree.take() else {
            return;
        };
        let task = self.task;
        let scene = embree.build(&task.shape, quality, Robustness::Off);
        let cost = Cost::new(scene.seconds, scene.bytes, task.points.len());
        let who = |mode, lanes| Who { system: "embree", mode, isa: "embree", lanes };
        let built = Outcome { seconds: scene.seconds, ..Outcome::default() };
        self.note("build", who(quality.name().to_owned(), 0), cost, built);
        let rays = &task.primary[..];
        let question = Question { rays, is_closest: true, t_max: f32::MAX, threads: task.threads };
        let generation = task.generation();
        for mode in Mode::ALL {
            let mut outcome = question.ask(&scene, mode);
            outcome.seconds += generation;
            let name = format!("{} {}", mode.name(), quality.name());
            self.note("primary", who(name, mode.lanes), cost, outcome);
        }
        drop(scene);
        self.embree = Some(embree);
    }

    fn note(&mut self, row: &'static str, who: Who, cost: Cost, outcome: Outcome) {
        let is_same = |r: &Record| (r.row, r.system, &r.mode) == (row, who.system, &who.mode);
        let at = self.records.iter().position(is_same).unwrap_or_else(|| {
            let Who { system, mode, isa, lanes } = who;
            let seconds = Vec::new();
            self.records.push(Record { row, system, mode, isa, lanes, cost, seconds, outcome });
            self.records.len() - 1
        });
        let record = &mut self.records[at];
        (record.cost, record.outcome) = (cost, outcome);
        if self.round > 0 {
            record.seconds.push(outcome.seconds);
        }
    }
}
