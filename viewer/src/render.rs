//! Progressive rendering on the thread of the data: coarse while something changes, then sharp,
//! then better with every pass.

mod picture;

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use raydsl::prelude::*;

use crate::device::Device;
use crate::frame::{Frame, difference, shown};
use crate::link::{Event, Job, Link, Question, ray_of};
use crate::look::{Look, Mode, Show};
use crate::subject::{PictureKernel, Subject};
pub(crate) use picture::is_same_kernel;
use picture::{LONGEST_PASS, Picture, error};

/// Samples that the sequences are made for.
const PLANNED: u32 = 256;
/// The time between pictures of a film that already has some samples.
const BETWEEN: Duration = Duration::from_millis(150);
/// Pixels a second that are assumed before any were measured.
const FIRST_RATE: f64 = 3e5;
/// The least share of columns and rows of a coarse picture.
const COARSEST: f64 = 1.0 / 16.0;

/// Renders what the link asks for, until it is closed.
pub(crate) fn serve(subject: &mut dyn Subject, link: &Link, device: &Device) {
    let mut worker =
        Worker { link, device, rates: HashMap::new(), late: 0, picture: Picture::none() };
    loop {
        link.wait_while(|job| worker.is_idle(job));
        if link.is_closed() {
            return;
        }
        let Some(job) = link.job() else { continue };
        worker.answer(subject, &job);
        if worker.is_idle(&job) {
            continue;
        }
        let look = job.look.clone();
        let end = subject.with_kernel(&look, &mut |kernel| worker.run(kernel, &look));
        if let Err(message) = end {
            worker.fail(&job, Event::Failed(message));
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
        let Picture { number, is_failed, samples, .. } = self.picture;
        number == job.number && (is_failed || samples >= job.limit)
    }

    fn fail(&mut self, job: &Job, event: Event) {
        self.picture = Picture { number: job.number, is_failed: true, ..Picture::none() };
        self.link.send(event);
    }

    fn answer(&self, subject: &mut dyn Subject, job: &Job) {
        let look = &*job.look;
        for question in self.link.take_questions() {
            match question {
                Question::Pick(x, y) => {
                    let ray = ray_of(look, x, y);
                    self.link.send(Event::Picked(subject.pick(look, ray)));
                }
                Question::Wgsl => {
                    let link = self.link;
                    let end = subject.with_kernel(look, &mut |kernel| {
                        link.send(Event::Wgsl(kernel.wgsl()));
                    });
                    if let Err(message) = end {
                        link.send(Event::Failed(message));
                    }
                }
            }
        }
    }

    /// Renders with a kernel, as long as looks differ in nothing but the camera and the size: the
    /// kernel stays the same, and is recorded once.
    fn run(&mut self, kernel: &PictureKernel<'_>, look: &Look) {
        while let Some(job) = self.link.job() {
            if !is_same_kernel(&job.look, look) {
                return;
            }
            if let Err(message) = self.improve(kernel, &job) {
                self.device.forget();
                self.fail(&job, Event::DeviceFailed(message));
            }
            self.link.wait_while(|job| self.is_idle(job));
            if self.link.is_closed() || self.link.has_questions() {
                return;
            }
        }
    }

    /// Adds samples until there are enough, or something else is wanted.
    fn improve(&mut self, kernel: &PictureKernel<'_>, job: &Job) -> Result<(), String> {
        if self.picture.number != job.number {
            let is_coarse_due = job.coarse.is_some();
            self.picture = Picture { number: job.number, is_coarse_due, ..Picture::none() };
        }
        if let Some(budget) = job.coarse
            && self.picture.is_coarse_due
        {
            self.coarse(kernel, job, budget)?;
        }
        while self.picture.samples < job.limit && !self.is_interrupted(job) {
            self.pass(kernel, job)?;
        }
        Ok(())
    }

    fn is_interrupted(&self, job: &Job) -> bool {
        self.link.is_outdated(job.number) || self.link.has_questions()
    }

    /// Makes a picture of as many pixels as the time allows. While the camera moves, a change
    /// follows another faster than pictures: this one is shown even if it is outdated, unless it
    /// takes too long.
    fn coarse(
        &mut self,
        kernel: &PictureKernel<'_>,
        job: &Job,
        budget: Duration,
    ) -> Result<(), String> {
        let look = &*job.look;
        let speed = (look.mode, look.variant, look.show == Show::Picture);
        let rate = self.rates.get(&speed).copied().unwrap_or(FIRST_RATE);
        let pixels = f64::from(look.size.0) * f64::from(look.size.1);
        let scale = (rate * budget.as_secs_f64() / pixels).sqrt().clamp(COARSEST, 1.0);
        let side = |n: u32| ((f64::from(n) * scale).round() as u32).clamp(1, n);
        let (width, height) = (side(look.size.0), side(look.size.1));
        let start = Instant::now();
        let is_picture = look.show == Show::Picture;
        let share = if look.variant == Variant::Wgsl && is_picture && self.device.is_of_window() {
            let texture = self.device.frame(kernel, look, (width, height))?;
            self.show_on_device(texture, start.elapsed());
            1.0
        } else {
            self.coarse_on_host(kernel, job, (width, height), budget)?
        };
        self.picture.is_coarse_due = false;
        let done = share * f64::from(width) * f64::from(height);
        let done = done.max(1.0) / start.elapsed().as_secs_f64();
        let known = self.rates.entry(speed).or_insert(done);
        // Slower is believed at once, and faster by half: a picture that is late is not seen.
        *known = if done < *known { done } else { 0.5 * (*known + done) };
        Ok(())
    }

    /// Returns the share of the picture that was made; if it is not all, nothing is shown.
    fn coarse_on_host(
        &mut self,
        kernel: &PictureKernel<'_>,
        job: &Job,
        (width, height): (u32, u32),
        budget: Duration,
    ) -> Result<f64, String> {
        let (look, link, start) = (&*job.look, self.link, Instant::now());
        let other = matches!(look.show, Show::Difference(_)).then(|| Film::new(width, height));
        let mut films = (Film::new(width, height), other);
        let (mut share, patience) = (0.0, budget * (2 << self.late.min(5)));
        let is_complete = self.add(kernel, look, &mut films, 1, &mut |made| {
            share = made;
            let is_late = link.is_outdated(job.number) && start.elapsed() > patience;
            if is_late || link.is_closed() {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        })?;
        if is_complete {
            self.show(look, &films, true, 1, start.elapsed());
            share = 1.0;
        }
        self.late = if is_complete { 0 } else { self.late + 1 };
        Ok(share)
    }

    fn show_on_device(&mut self, texture: wgpu::Texture, took: Duration) {
        self.link.publish(Frame {
            number: self.picture.number,
            size: (texture.width(), texture.height()),
            is_coarse: true,
            samples: 0,
            rgba: Vec::new(),
            texture: Some(texture),
            ms: took.as_secs_f64() * 1e3,
            age_ms: self.picture.since.elapsed().as_secs_f64() * 1e3,
            error: None,
            difference: None,
        });
    }

    /// Adds a pass of samples to the film, unless it is interrupted.
    fn pass(&mut self, kernel: &PictureKernel<'_>, job: &Job) -> Result<(), String> {
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
        let is_complete = self.add(kernel, look, &mut films, count, &mut |_| {
            if link.is_outdated(job.number) || link.has_questions() {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        })?;
        if is_complete {
            let took = start.elapsed();
            self.picture.samples = films.0.samples();
            let samples = self.picture.samples;
            let is_due = self.picture.shown_at.is_none_or(|at| at.elapsed() > BETWEEN);
            if is_due || samples >= job.limit || samples <= 4 {
                self.show(look, &films, false, count, took);
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
        look: &Look,
        films: &mut (Film, Option<Film>),
        samples: u32,
        observer: raydsl::render::Observer<'_>,
    ) -> Result<bool, String> {
        let is_whole =
            self.add_with(kernel, look, look.variant, &mut films.0, samples, observer)?;
        let (Some(film), Show::Difference(other)) = (&mut films.1, look.show) else {
            return Ok(is_whole);
        };
        Ok(is_whole && self.add_with(kernel, look, other, film, samples, observer)?)
    }

    fn add_with(
        &self,
        kernel: &PictureKernel<'_>,
        look: &Look,
        variant: Variant,
        film: &mut Film,
        samples: u32,
        observer: raydsl::render::Observer<'_>,
    ) -> Result<bool, String> {
        let (camera, sampling) = (look.pose.camera(), Sampling::new(PLANNED));
        let end = if variant == Variant::Wgsl {
            let device = self.device.scheduler()?;
            device
                .accumulate_observed(&camera, kernel, &sampling, film, samples, observer)
                .map_err(|e| e.to_string())?
                .is_continue()
        } else {
            let scheduler = TiledScheduler::new().variant(variant);
            scheduler
                .accumulate_observed(&camera, kernel, &sampling, film, samples, observer)
                .is_continue()
        };
        Ok(end)
    }

    fn show(
        &mut self,
        look: &Look,
        films: &(Film, Option<Film>),
        is_coarse: bool,
        count: u32,
        took: Duration,
    ) {
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
            ms: took.as_secs_f64() * 1e3 / f64::from(count.max(1)),
            age_ms: (now - self.picture.since).as_secs_f64() * 1e3,
            error: (film.samples() > 1).then(|| error(film)),
            difference,
        });
    }
}
