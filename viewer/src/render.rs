//! Progressive rendering on the thread of the data: coarse while something changes, then sharp,
//! then better with every pass.

mod coarse;
mod goal;
mod lanes;
mod picture;

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use raydsl::gpu::GpuError;
use raydsl::prelude::*;

use crate::device::Device;
use crate::frame::{Frame, difference, shown};
use crate::link::{Event, Job, Link, Question};
use crate::look::{Look, Mode, Show};
use crate::subject::{PictureKernel, Subject, SubjectKernel};
pub(crate) use picture::is_same_kernel;
use picture::{LONGEST_PASS, Picture, error, milliseconds};

/// Samples that the sequences are made for.
const PLANNED: u32 = 256;
/// The time between pictures of a film that already has some samples.
const BETWEEN: Duration = Duration::from_millis(150);

/// Renders what the link asks for, until it is closed.
pub(crate) fn serve(subject: &mut dyn Subject, link: &Link, device: &Device) {
    let mut worker =
        Worker { link, device, rates: HashMap::new(), late: 0, picture: Picture::none() };
    loop {
        link.wait_while(|job| worker.is_idle(job));
        if link.is_closed() {
            return;
        }
        worker.answer(subject);
        let Some(job) = link.job() else { continue };
        if worker.is_idle(&job) {
            continue;
        }
        let look = job.look.clone();
        let end = subject.with_kernel(&look, &mut |kernel| worker.run(kernel, &look));
        if let Err(message) = end {
            worker.picture = Picture::failed(&job);
            link.send(Event::Failed { number: job.number, message });
        }
    }
}

/// What the speed of a picture depends on.
type Speed = (Mode, Variant, bool);

struct Worker<'a> {
    link: &'a Link,
    device: &'a Device,
    /// Pixels a second of coarse pictures.
    rates: HashMap<Speed, f64>,
    /// Coarse pictures, one after another, that were given up: the next one gets more time.
    late: u32,
    picture: Picture,
}

impl Worker<'_> {
    fn is_idle(&self, job: &Job) -> bool {
        let Picture { number, is_failed, is_settled, samples, .. } = self.picture;
        let has_all = if job.goal.is_some() { is_settled } else { samples >= job.limit };
        number == job.number && (is_failed || has_all)
    }

    /// Answers every question with one event: the session counts them.
    fn answer(&self, subject: &mut dyn Subject) {
        for question in self.link.take_questions() {
            let answer = match question {
                Question::Pick { x, y, look } => {
                    Event::Picked(subject.pick(&look, look.pose.ray(look.size, x, y)))
                }
                Question::Wgsl(look) => {
                    let mut text = String::new();
                    let end = subject.with_kernel(&look, &mut |kernel| text = kernel.wgsl());
                    Event::Wgsl(end.map(|()| text))
                }
                Question::Lanes(look) => {
                    let mut found = Err("there is no kernel".to_owned());
                    let end = subject
                        .with_kernel(&look, &mut |kernel| found = Ok(lanes::of(kernel, &look)));
                    Event::Lanes(end.and(found))
                }
            };
            self.link.send(answer);
        }
    }

    /// Renders with a kernel, as long as looks differ in nothing but the camera and the size: the
    /// kernel stays the same, and is recorded once.
    fn run(&mut self, kernel: &SubjectKernel<'_>, look: &Look) {
        while let Some(job) = self.link.job() {
            if !is_same_kernel(&job.look, look) {
                return;
            }
            if let Err(error) = self.improve(kernel, &job) {
                // One that only refuses this kernel serves others, and the window.
                if matches!(error, GpuError::DeviceLost { .. }) {
                    self.device.forget();
                }
                self.picture = Picture::failed(&job);
                let message = error.to_string();
                self.link.send(Event::DeviceFailed { number: job.number, message });
            }
            self.link.wait_while(|job| self.is_idle(job));
            if self.link.is_closed() || self.link.has_questions() {
                return;
            }
        }
    }

    /// Adds samples until there are enough, or something else is wanted.
    fn improve(&mut self, kernel: &PictureKernel<'_>, job: &Job) -> Result<(), GpuError> {
        self.begin(job);
        if let Some(budget) = job.coarse
            && self.picture.is_coarse_due
        {
            self.coarse(kernel, job, budget)?;
        }
        if let Some(goal) = job.goal {
            if self.is_idle(job) || self.is_interrupted(job) {
                return Ok(());
            }
            return self.reach(kernel, job, goal);
        }
        while self.picture.samples < job.limit && !self.is_interrupted(job) {
            self.pass(kernel, job)?;
        }
        Ok(())
    }

    /// Begins the picture of a job. The film of one that differs in nothing but the exposure is
    /// kept, and shown again.
    fn begin(&mut self, job: &Job) {
        if self.picture.number == job.number {
            return;
        }
        let is_coarse_due = job.coarse.is_some();
        let new =
            Picture { number: job.number, light: job.light, is_coarse_due, ..Picture::none() };
        let old = std::mem::replace(&mut self.picture, new);
        let Some(films) = old.films.filter(|_| old.light == job.light && old.samples > 0) else {
            return;
        };
        self.picture.is_settled = old.is_settled;
        self.picture.error = old.error;
        self.picture.is_coarse_due = false;
        self.picture.samples = old.samples;
        self.picture.next = old.next;
        self.picture.ms = old.ms;
        self.show(&job.look, &films, false, old.ms);
        self.picture.films = Some(films);
    }

    fn is_interrupted(&self, job: &Job) -> bool {
        self.link.is_outdated(job.number) || self.link.has_questions()
    }

    /// Adds a pass of samples to the film, unless it is interrupted.
    fn pass(&mut self, kernel: &PictureKernel<'_>, job: &Job) -> Result<(), GpuError> {
        let look = &*job.look;
        let (width, height) = look.size;
        let is_compared = matches!(look.show, Show::Difference(_));
        let mut films = self.picture.films.take().unwrap_or_else(|| {
            (Film::new(width, height), is_compared.then(|| Film::new(width, height)))
        });
        let left = job.limit - self.picture.samples;
        let count = if job.coarse.is_none() { LONGEST_PASS } else { self.picture.next }.min(left);
        let start = Instant::now();
        let link = self.link;
        let is_complete = self.add(kernel, job, &mut films, count, &mut |_| {
            // A question waits for the end of a pass of two films, which are compared sample by
            // sample.
            if link.is_outdated(job.number) || (link.has_questions() && !is_compared) {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        })?;
        let samples = films.0.samples();
        if films.1.as_ref().is_some_and(|other| other.samples() != samples) {
            // What was interrupted between both films cannot be compared: begin again.
            self.picture.samples = 0;
            return Ok(());
        }
        self.picture.samples = samples;
        if is_complete || samples >= job.limit {
            let took = start.elapsed();
            self.picture.ms = milliseconds(took, count);
            let is_due = self.picture.shown_at.is_none_or(|at| at.elapsed() > BETWEEN);
            if is_due || samples >= job.limit || samples <= 4 {
                self.show(look, &films, false, self.picture.ms);
            }
            self.picture.pace(count, took);
        }
        self.picture.films = Some(films);
        Ok(())
    }

    /// Adds samples to films; returns whether the pass is complete.
    fn add(
        &self,
        kernel: &PictureKernel<'_>,
        job: &Job,
        films: &mut (Film, Option<Film>),
        samples: u32,
        observer: raydsl::render::Observer<'_>,
    ) -> Result<bool, GpuError> {
        let look = &*job.look;
        let is_whole = self.add_with(kernel, job, look.variant, &mut films.0, samples, observer)?;
        let (Some(film), Show::Difference(other)) = (&mut films.1, look.show) else {
            return Ok(is_whole);
        };
        Ok(is_whole && self.add_with(kernel, job, other, film, samples, observer)?)
    }

    fn add_with(
        &self,
        kernel: &PictureKernel<'_>,
        job: &Job,
        variant: Variant,
        film: &mut Film,
        samples: u32,
        observer: raydsl::render::Observer<'_>,
    ) -> Result<bool, GpuError> {
        let look = &*job.look;
        let (camera, sampling) = (look.pose.camera(), Sampling::new(PLANNED));
        let end = if variant == Variant::Wgsl {
            // Whoever looks at a picture does not wait; variants that are compared, and scripts, do.
            let is_watched = job.coarse.is_some() && look.show == Show::Picture;
            let device = if is_watched {
                self.device.eager_scheduler()?
            } else {
                self.device.scheduler()?
            };
            device
                .accumulate_observed(&camera, kernel, &sampling, film, samples, observer)?
                .is_continue()
        } else {
            let scheduler = TiledScheduler::new().variant(variant);
            scheduler
                .accumulate_observed(&camera, kernel, &sampling, film, samples, observer)
                .is_continue()
        };
        Ok(end)
    }

    /// Publishes a picture, whose samples took so many milliseconds each.
    fn show(&mut self, look: &Look, films: &(Film, Option<Film>), is_coarse: bool, ms: f64) {
        let (film, other) = films;
        let light = film.image();
        let (rgba, difference) = match other {
            Some(other) => {
                let (rgba, found) = difference(&light, &other.image());
                (rgba, Some(found))
            }
            None => (shown(&light, look.exposure), None),
        };
        let now = Instant::now();
        self.picture.shown_at = Some(now);
        self.link.publish(Frame {
            number: self.picture.number,
            size: (film.width(), film.height()),
            is_coarse,
            samples: if is_coarse { 0 } else { film.samples() },
            rgba,
            texture: None,
            ms,
            age_ms: (now - self.picture.since).as_secs_f64() * 1e3,
            error: self.picture.error.or_else(|| (film.samples() > 1).then(|| error(film))),
            difference,
        });
    }
}
